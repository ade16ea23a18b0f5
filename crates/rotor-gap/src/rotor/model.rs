//! A rotor with its drives and the way its loads are read: what a cause changes.

use crate::properties::OfCase;
use rotor_base::Harmonic;
use rotor_case::{Case, TrimValues};
use std::collections::BTreeMap;
use std::f64::consts::{PI, TAU};

/// A rotor as simulated.
#[derive(Debug, Clone, PartialEq)]
pub struct RotorModel {
    /// The rotor, its flaps and its trim.
    pub case: Case,
    /// True rotor speed over the stated one.
    pub speed: f64,
    /// True air density over the stated one.
    pub density: f64,
    /// Lift slope of the sections over that of the case.
    pub lift_slope: f64,
    /// From voltages to the motion of the flaps.
    pub drive: FlapDriveModel,
    /// From loads to readings.
    pub path: LoadPath,
}

/// From voltages to the motion of the flaps, beside the drive of the case.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlapDriveModel {
    /// Motion over that of the drive of the case.
    pub gain: f64,
    /// Part of the difference between an actuator with hysteresis and an ideal one that the motion has.
    pub hysteresis: f64,
    /// Lag of an actuator at the middle drive, deg.
    pub lag_deg: f64,
    /// The part of it that is a relaxation, which grows with frequency and loses stroke by it, deg; the rest grows with the
    /// amplitude, and the stroke with it.
    pub relaxation_deg: f64,
    /// Harmonic and amplitude, V, of the middle drive: the gain is that there.
    pub middle: (usize, f64),
}

impl FlapDriveModel {
    /// What the motion of a harmonic is times and how much later it comes, rad, at an amplitude of the voltage.
    ///
    /// ```text
    /// g h(A) / h(A_m) q(n) / q(n_m),   q = 1 / (1 + i (n / n_m) tan r),   h = 1 - b + b (A / A_m) (1 - 4 i / (3 pi))
    /// ```
    /// `l` the lag, `r` the relaxation in it, at harmonic `n_m` and amplitude `A_m`; `h` is the first harmonic of Rayleigh's law,
    /// `b` so that it lags `l - r` there. What it cannot lag, 23 deg at most, lags at every amplitude alike.
    pub fn lagging(&self, harmonic: usize, amplitude_volt: f64) -> (f64, f64) {
        let (middle, volt) = (self.middle.0.max(1) as f64, self.middle.1);
        let relaxation_rad = self.relaxation_deg.to_radians();
        let slow = harmonic as f64 / middle * relaxation_rad.tan();
        let over = if volt > 0.0 { amplitude_volt / volt } else { 1.0 };
        let play_rad = (self.lag_deg - self.relaxation_deg).to_radians();
        let most_rad = RAYLEIGH.atan();
        let of_play_rad = play_rad.clamp(-most_rad, most_rad);
        let share = of_play_rad.tan() / RAYLEIGH;
        let (in_phase, behind) = (share.mul_add(over - 1.0, 1.0), RAYLEIGH * share * over);
        let stroke = self.gain * in_phase.hypot(behind) * of_play_rad.cos();
        let late_rad = slow.atan() + behind.atan2(in_phase) + play_rad - of_play_rad;
        (stroke / (relaxation_rad.cos() * slow.hypot(1.0)), late_rad)
    }
}

/// Quadrature over the growth of the stroke in Rayleigh's law of hysteresis, `4 / (3 pi)`.
const RAYLEIGH: f64 = 4.0 / (3.0 * PI);

/// From loads to readings.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadPath {
    /// Turn of the hub loads against the drive, deg of azimuth, late positive.
    pub azimuth_deg: f64,
    /// Delay of the hub loads, s.
    pub delay_s: f64,
    /// Reciprocal of the square of the frequency of the hub on its support, s^2; 0 of a rigid one.
    pub compliance_s2: f64,
    /// Damping of that support over critical.
    pub damping: f64,
    /// Collective read less the true one, deg.
    pub collective_deg: f64,
    /// Gains of instruments that are off, by their names.
    pub gains: BTreeMap<String, f64>,
}

impl OfCase for RotorModel {
    fn case(&self) -> &Case {
        &self.case
    }

    fn case_mut(&mut self) -> &mut Case {
        &mut self.case
    }
}

impl RotorModel {
    /// The rotor of a case, driven and read as stated.
    pub fn of(case: Case) -> Self {
        Self {
            case,
            speed: 1.0,
            density: 1.0,
            lift_slope: 1.0,
            drive: FlapDriveModel {
                gain: 1.0,
                hysteresis: 0.0,
                lag_deg: 0.0,
                relaxation_deg: 0.0,
                middle: (1, 0.0),
            },
            path: LoadPath::default(),
        }
    }

    /// Whether another one flies alike: it differs in the way loads are read alone.
    pub fn flies_as(&self, other: &Self) -> bool {
        self.drive == other.drive && self.is_trimmed_as(other)
    }

    /// Whether another one is trimmed alike, flaps at rest: it differs in drives and the way loads are read alone.
    pub fn is_trimmed_as(&self, other: &Self) -> bool {
        let trimmed = |own: &Self| {
            // a collective that is set by a reading that is off is not the true one
            let is_set = matches!(own.case.trim, TrimValues::Prescribed(_));
            let collective_deg = if is_set { own.path.collective_deg } else { 0.0 };
            let path = LoadPath { collective_deg, ..LoadPath::default() };
            Self { drive: other.drive, path, ..own.clone() }
        };
        trimmed(self) == trimmed(other)
    }
}

impl Default for LoadPath {
    fn default() -> Self {
        Self {
            azimuth_deg: 0.0,
            delay_s: 0.0,
            compliance_s2: 0.0,
            damping: 0.05,
            collective_deg: 0.0,
            gains: BTreeMap::new(),
        }
    }
}

impl LoadPath {
    /// A hub load as read, at a frequency of `n` times the rotor speed.
    ///
    /// ```text
    /// F_read = F / (1 - r^2 + 2 i zeta r) e^(-i n (dpsi + Omega tau)),   r = n Omega / omega_hub
    /// ```
    /// with `F = F_c - i F_s` of `F_c cos n psi + F_s sin n psi`.
    pub fn read(&self, harmonic: usize, rev_hz: f64, load: Harmonic) -> Harmonic {
        let n = harmonic as f64;
        let late = n * (self.azimuth_deg.to_radians() + TAU * rev_hz * self.delay_s);
        let ratio = n * rev_hz * self.compliance_s2.max(0.0).sqrt();
        let (real, imaginary) = (1.0 - ratio * ratio, 2.0 * self.damping * ratio);
        let size = real.hypot(imaginary);
        let read = later(load, late + imaginary.atan2(real));
        Harmonic { cosine: read.cosine / size, sine: read.sine / size }
    }

    /// The gain of an instrument.
    pub fn gain(&self, instrument: &str) -> f64 {
        self.gains.get(instrument).copied().unwrap_or(1.0)
    }
}

/// A harmonic that comes later by an angle of its own.
pub(crate) fn later(own: Harmonic, angle_rad: f64) -> Harmonic {
    let (sin, cos) = angle_rad.sin_cos();
    Harmonic { cosine: own.cosine * cos - own.sine * sin, sine: own.sine * cos + own.cosine * sin }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// At the middle drive the lag is that stated and the gain too; a relaxation lags more and moves less at higher harmonics, and
    /// what remains more at larger amplitudes, where it moves more.
    #[test]
    fn a_flap_lags_by_amplitude_and_frequency() {
        let mut drive = RotorModel::of(Case::default()).drive;
        (drive.lag_deg, drive.relaxation_deg, drive.gain) = (30.0, 15.0, 0.8);
        drive.middle = (3, 20.0);
        let at = |n, volt| drive.lagging(n, volt);
        let (gain, late) = at(3, 20.0);
        assert!((gain - 0.8).abs() < 1e-12 && (late.to_degrees() - 30.0).abs() < 1e-9);
        let high = at(6, 20.0);
        assert!(high.0 < gain && high.1 > late);
        let large = at(3, 80.0);
        assert!(large.0 > gain && large.1 > late);
        // Rayleigh's law: a loop of amplitude A lags by atan(4/(3 pi)) where nothing of its stroke is there at once
        assert!(at(3, 1e9).1.to_degrees() < 15.0 + RAYLEIGH.atan().to_degrees() + 1e-6);
        let more = FlapDriveModel { lag_deg: 60.0, ..drive };
        assert!((more.lagging(3, 20.0).1.to_degrees() - 60.0).abs() < 1e-9);
    }

    /// A delay of a time turns a harmonic by its frequency times that; a support far above passes all, one far below turns
    /// the sign.
    #[test]
    fn a_load_is_read_late_and_through_the_support() {
        let load = Harmonic { cosine: 3.0, sine: -1.0 };
        let at = |path: &LoadPath, psi: f64| {
            let read = path.read(4, 6.0, load);
            read.cosine * (4.0 * psi).cos() + read.sine * (4.0 * psi).sin()
        };
        let still = |psi: f64| load.cosine * (4.0 * psi).cos() + load.sine * (4.0 * psi).sin();
        let late = LoadPath { delay_s: 0.002, azimuth_deg: 3.0, ..LoadPath::default() };
        let by = 3.0_f64.to_radians() + TAU * 6.0 * 0.002;
        for psi in [0.1, 1.0, 2.5] {
            assert!((at(&late, psi) - still(psi - by)).abs() < 1e-12);
        }
        let soft = LoadPath { compliance_s2: 1.0, damping: 0.0, ..LoadPath::default() };
        // r = 24: 1 / (1 - 576)
        assert!((at(&soft, 0.7) + still(0.7) / 575.0).abs() < 1e-12);
        let stiff = LoadPath { compliance_s2: 1e-12, ..LoadPath::default() };
        assert!((at(&stiff, 0.7) - still(0.7)).abs() < 1e-4);
    }
}
