//! Electrical power of a piezo over a revolution.
//!
//! ```text
//! apparent   S = V_rms I_rms = (Omega C / 2) sqrt( sum_n U_n^2  sum_n n^2 U_n^2 )     U_n: amplitude of the voltage at n per rev
//! current    I = C dV/dt
//! loss       P = (Omega / 2 pi) (C / g) loop integral of V d(delta) = (Omega C / 2 g) sum_n n (V_nc delta_ns - V_ns delta_nc)
//!            g = sum_n (V_nc delta_nc + V_ns delta_ns) / sum_n U_n^2
//! ```
//! `delta` is the output of the law of the actuator alone, cycled slowly: its static loop, whose energy is the same at any
//! frequency. Creep and lags are left out, since the model does not say how much of them is electrical. The charge is taken in
//! proportion to `delta`, `q = (C / g) delta`, so that its part in phase with the voltage is that of the capacitance. At one
//! harmonic this is `P = pi f C U^2 tan(loss angle)`.
//!
//! Source: charge and displacement of piezoceramics in proportion, C. V. Newcomb, I. Flinn, Electronics Letters 18 (1982) 442;
//! the integral is elementary.

use rotor_base::{HarmonicSeries, uniform_azimuths_rad};
use serde::{Deserialize, Serialize};

/// Azimuths of the peak of the current: enough for 12 harmonics.
const AZIMUTHS: usize = 720;

/// Electrical power of one piezo.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize, Deserialize)]
pub struct ElectricalPower {
    /// Apparent power of the alternating part, which the amplifier gives and takes back, VA: root mean squares of voltage about its
    /// mean and of current. The mean voltage adds to what the amplifier has to hold, not to this.
    #[serde(rename = "apparent_VA")]
    pub apparent_voltampere: f64,
    /// Largest size of the current, A.
    #[serde(rename = "peak_current_A")]
    pub peak_current_ampere: f64,
    /// Mean power lost in the static hysteresis, W, 0 or more; none of an actuator without a loop, or one whose output does not
    /// follow its voltage or leads it.
    #[serde(rename = "loss_W")]
    pub loss_watt: Option<f64>,
}

/// The electrical power of a piezo.
///
/// | argument | symbol | unit | range |
/// |---|---|---|---|
/// | `voltage_volt` | `V` | V | its mean has no part in mean power and current |
/// | `law_deg` | `delta` | deg, or any unit of displacement | none of an actuator without hysteresis |
/// | `capacitance_farad` | `C` | F | > 0 |
/// | `omega_rad_s` | `Omega` | rad/s | > 0 |
pub fn electrical_power(
    voltage_volt: &HarmonicSeries,
    law_deg: Option<&HarmonicSeries>,
    capacitance_farad: f64,
    omega_rad_s: f64,
) -> ElectricalPower {
    let count = voltage_volt.harmonics.len();
    let harmonics = || (1..=count).map(|n| (n, n as f64, voltage_volt.harmonic(n)));
    let squares = |power: i32| -> f64 {
        harmonics().map(|(_, n, u)| n.powi(power) * u.amplitude() * u.amplitude()).sum()
    };
    let rate = voltage_volt.derivative();
    let largest = uniform_azimuths_rad(AZIMUTHS)
        .into_iter()
        .map(|azimuth| rate.value(azimuth).abs())
        .fold(0.0, f64::max);
    let loss_watt = law_deg.and_then(|law| {
        let (mut area, mut in_phase, mut square) = (0.0, 0.0, 0.0);
        for (place, n, u) in harmonics() {
            let delta = law.harmonic(place);
            area += n * (u.cosine * delta.sine - u.sine * delta.cosine);
            in_phase += u.cosine * delta.cosine + u.sine * delta.sine;
            square += u.cosine * u.cosine + u.sine * u.sine;
        }
        // rounding aside, a loop that loses nothing has no area
        let follows = in_phase > 0.0 && square > 0.0 && area >= -1e-12 * in_phase;
        let scale = 0.5 * omega_rad_s * capacitance_farad;
        follows.then(|| scale * area.max(0.0) * square / in_phase)
    });
    ElectricalPower {
        apparent_voltampere: 0.5
            * omega_rad_s
            * capacitance_farad
            * (squares(0) * squares(2)).sqrt(),
        peak_current_ampere: capacitance_farad * omega_rad_s * largest,
        loss_watt,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use preisach_dyn::{
        ActuatorLaw, ActuatorModel, PeriodicSettings, PrandtlIshlinskii, PrandtlParameters,
        VoltageRange, WeightedPlay,
    };
    use rotor_base::Harmonic;
    use std::f64::consts::{PI, TAU};

    const CAPACITANCE: f64 = 40e-6;
    const OMEGA: f64 = 40.0;

    fn wave(parts: &[(usize, f64, f64)]) -> HarmonicSeries {
        let mut series = HarmonicSeries { mean: 65.0, ..HarmonicSeries::zero(0) };
        for &(n, cosine, sine) in parts {
            series.set_harmonic(n, Harmonic { cosine, sine });
        }
        series
    }

    /// A capacitor takes and gives back: no loss, and the product of the root mean squares of voltage and current, sample by sample.
    #[test]
    fn a_capacitor_has_apparent_power_and_no_loss() {
        let voltage = wave(&[(3, 30.0, -40.0), (5, 0.0, 10.0)]);
        let charge = HarmonicSeries { mean: 0.0, ..voltage.clone() };
        let found = electrical_power(&voltage, Some(&charge), CAPACITANCE, OMEGA);
        let rate = voltage.derivative();
        let rms = |of: &dyn Fn(f64) -> f64| {
            let squares = uniform_azimuths_rad(360).into_iter().map(|psi| of(psi).powi(2));
            (squares.sum::<f64>() / 360.0).sqrt()
        };
        let exact = rms(&|psi| voltage.value(psi) - voltage.mean)
            * rms(&|psi| CAPACITANCE * OMEGA * rate.value(psi));
        assert!((found.apparent_voltampere / exact - 1.0).abs() < 1e-12);
        assert!(found.loss_watt.unwrap().abs() < 1e-14 * exact, "{found:?}");
        let alone = electrical_power(&wave(&[(3, 30.0, -40.0)]), None, CAPACITANCE, OMEGA);
        let peak = CAPACITANCE * 3.0 * OMEGA * 50.0;
        assert!((alone.peak_current_ampere / peak - 1.0).abs() < 1e-4, "{alone:?}");
        assert_eq!(alone.loss_watt, None);
        // mean power of V I over a revolution, sample by sample
        let power = |psi: f64| voltage.value(psi) * CAPACITANCE * OMEGA * rate.value(psi);
        let mean = uniform_azimuths_rad(360).into_iter().map(power).sum::<f64>() / 360.0;
        assert!(mean.abs() < 1e-12 * exact, "{mean}");
    }

    /// A lag of the charge by a loss angle: `pi f C U^2 tan(angle)`.
    #[test]
    fn a_loss_angle_gives_its_tangent() {
        for (n, angle) in [(2, 0.02_f64), (4, 0.3)] {
            let voltage = wave(&[(n, 36.0, 48.0)]);
            let of_lag = Harmonic::from_amplitude_phase(7.0, f64::atan2(48.0, 36.0) + angle);
            let law = wave(&[(n, of_lag.cosine, of_lag.sine)]);
            let found = electrical_power(&voltage, Some(&law), CAPACITANCE, OMEGA);
            let frequency = n as f64 * OMEGA / TAU;
            let exact = PI * frequency * CAPACITANCE * 60.0 * 60.0 * angle.tan();
            let loss = found.loss_watt.unwrap();
            assert!((loss / exact - 1.0).abs() < 1e-13, "{loss} {exact}");
        }
        // a charge that leads its voltage, or goes against it, is none
        let leading = wave(&[(2, 7.0, -0.7)]);
        let found = electrical_power(&wave(&[(2, 1.0, 0.0)]), Some(&leading), 1e-6, OMEGA);
        assert_eq!(found.loss_watt, None);
        let found =
            electrical_power(&wave(&[(2, 1.0, 0.0)]), Some(&wave(&[(2, -1.0, 0.1)])), 1e-6, OMEGA);
        assert_eq!(found.loss_watt, None);
    }

    /// One play of half-width `r` and weight `p` in a wave of amplitude `A`: a parallelogram of area `4 p r (A - r)`, at
    /// any frequency, so that the power grows with the frequency and the energy of a cycle does not.
    #[test]
    fn the_loss_of_a_play_is_its_parallelogram_at_any_frequency() {
        let range_volt = VoltageRange::new(-20.0, 150.0).unwrap();
        let (width, weight, gain, amplitude) = (12.0, 0.03, 0.02, 60.0);
        let play = WeightedPlay { threshold_volt: width, weight_deg_per_volt: weight };
        let law = PrandtlIshlinskii::new(PrandtlParameters {
            range_volt,
            gain_deg_per_volt: gain,
            plays: vec![play],
            threshold_growth_s: 0.0,
            envelope: preisach_dyn::Envelope::default(),
        });
        let law = ActuatorLaw::PrandtlIshlinskii(law.unwrap());
        let model = ActuatorModel { law, ..ActuatorModel::linear(range_volt, 8.5, 0.04) };
        let voltage = wave(&[(3, amplitude, 0.0)]);
        let mut energies = Vec::new();
        for rev_hz in [0.5, 5.0, 50.0] {
            let settings = PeriodicSettings { steps_per_rev: 7200, ..PeriodicSettings::default() };
            let response = model.periodic_response(&voltage, rev_hz, &settings).unwrap();
            let omega = TAU * rev_hz;
            let law_deg = Some(&response.flap_deg);
            let found = electrical_power(&voltage, law_deg, CAPACITANCE, omega);
            // the play alone in phase: of a gain, its whole
            let of_wave = response.flap_deg.harmonic(3).cosine / amplitude;
            let area = 4.0 * weight * width * (amplitude - width);
            let exact = CAPACITANCE / of_wave * area;
            let energy = found.loss_watt.unwrap() / (3.0 * rev_hz);
            assert!((energy / exact - 1.0).abs() < 2e-4, "{energy} {exact}");
            energies.push(energy);
        }
        for energy in &energies[1..] {
            assert!((energy / energies[0] - 1.0).abs() < 1e-12, "{energies:?}");
        }
    }
}
