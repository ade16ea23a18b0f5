//! From voltage harmonics to flap motion: the ideal actuator and the identified one.

use crate::flaps::error::PlantError;
use crate::flaps::full_scale::FullScale;
use crate::flaps::motion::FlapMotion;
use hhc_control::{BiasSolver, ControlError, RunError};
use preisach_dyn::{
    ActuatorModel, InverseSettings, LinkageStage, PeriodicResponse, PeriodicSettings,
    PreisachError, VoltageRange,
};
use rayon::prelude::*;
use rotor_base::series::{only, place, scaled, times};
use rotor_base::{Harmonic, HarmonicSeries, uniform_azimuths_rad};
use rotor_case::Bias;
use std::sync::Arc;

/// Largest mean flap angle the bias solution leaves, deg.
pub const MEAN_FLAP_TOLERANCE_DEG: f64 = 0.005;

/// What the search for the bias leaves of the mean flap angle where the range has room for it, deg. The bias is then a
/// smooth function of the voltages: one accepted as soon as the mean is small stays where the search set out, jumps
/// where the mean has become too large, and the loads with it.
const BIAS_TOLERANCE_DEG: f64 = 1e-6;

/// Largest change of the mean flap angle that a load leaves after the bias has met it, deg: tighter, so
/// that motion and hinge moment can settle on each other.
const LOADED_MEAN_TOLERANCE_DEG: f64 = 1e-8;

/// What turns a voltage into a flap angle.
#[derive(Debug, Clone)]
pub enum FlapDrive {
    /// Quasi-static gain, no hysteresis, no lag.
    Ideal {
        /// Flap angle per voltage, deg/V.
        gain_deg_per_volt: f64,
        /// Bias, V.
        bias_volt: f64,
        /// Voltages it may see, V.
        range_volt: VoltageRange,
    },
    /// An actuator model with memory.
    Model {
        /// The model.
        model: Arc<ActuatorModel>,
        /// Voltages it may see, V: within the range of the model.
        range_volt: VoltageRange,
        /// Revolutions per second in the actuator's time.
        rev_hz: f64,
        /// How its bias is set.
        bias: Bias,
    },
}

impl FlapDrive {
    /// Steady flap motion for voltage harmonics. The bias is solved so that the mean angle vanishes
    /// (paper equation 6), or held, and the mean angle follows.
    ///
    /// # Errors
    /// The actuator's errors: voltage out of range, no bias in the range, orbit not closed.
    pub fn motion(&self, voltages: &[(usize, Harmonic)]) -> Result<FlapMotion, PlantError> {
        let mut voltage_volt = series_of(voltages);
        let (swing_volt, span_volt) = self.swing_and_room(alternating_volt(&voltage_volt));
        if swing_volt > span_volt * (1.0 + 1e-9) {
            return Err(PlantError::VoltageSwing { swing_volt, span_volt });
        }
        match self {
            Self::Ideal { gain_deg_per_volt, bias_volt, .. } => {
                let flap_deg = scaled(&voltage_volt, *gain_deg_per_volt);
                voltage_volt.mean = *bias_volt;
                Ok(FlapMotion { voltage_volt, flap_deg })
            }
            Self::Model { model, range_volt, rev_hz, bias } => {
                voltage_volt.mean = bias.volt();
                let drive = PeriodicDrive { model, range_volt, rev_hz: *rev_hz, load: None };
                match bias {
                    Bias::Centred { .. } => drive.biased(voltage_volt, 0.0, BIAS_TOLERANCE_DEG),
                    Bias::Fixed { .. } => Ok(drive.response(&voltage_volt)?.into()),
                }
            }
        }
    }

    /// The same motion under a hinge moment (N m, positive in the sense of the flap angle, against
    /// azimuth), the bias moved so that the mean angle stays that of the `free` motion; of a bias that is held the mean angle
    /// gives way as well.
    ///
    /// # Errors
    /// As [`Self::motion`].
    pub fn loaded_motion(
        &self,
        free: &FlapMotion,
        hinge_moment_newton_metre: &HarmonicSeries,
    ) -> Result<FlapMotion, PlantError> {
        let Self::Model { model, range_volt, rev_hz, bias } = self else {
            return Ok(free.clone());
        };
        if self.compliance_deg_per_newton_metre() == 0.0 {
            return Ok(free.clone());
        }
        // what pushes the flap down helps it on: the actuator counts what stands against it
        let newton = model.calibration.load_newton(-1.0);
        let load = Some(scaled(hinge_moment_newton_metre, newton));
        let drive = PeriodicDrive { model, range_volt, rev_hz: *rev_hz, load };
        if bias.is_fixed() {
            return Ok(drive.response(&free.voltage_volt)?.into());
        }
        drive.biased(free.voltage_volt.clone(), free.flap_deg.mean, LOADED_MEAN_TOLERANCE_DEG)
    }

    /// Whether the bias is held, so that the mean flap angle of an actuator with memory is not.
    pub fn holds_bias(&self) -> bool {
        matches!(self, Self::Model { bias, .. } if bias.is_fixed())
    }

    /// How far a steady hinge moment turns the flap, deg per N m in its own sense; 0 without a load
    /// stage that gives. Stages behind the load stage are taken as they are at rest.
    pub fn compliance_deg_per_newton_metre(&self) -> f64 {
        let Self::Model { model, .. } = self else { return 0.0 };
        let newton = model.calibration.load_newton(1.0);
        model.linkage.iter().fold(0.0, |give, stage| match stage {
            LinkageStage::LoadStiffness(stage) => {
                let own = model.calibration.deg_per_um * stage.compliance_um_per_newton * newton;
                (give + own) / (1.0 + stage.stiffness_ratio)
            }
            _ => give,
        })
    }

    /// Change of voltage (V/V, its mean the bias) and flap angle (deg/V) with each control of the flap (cosine, then sine
    /// voltage of every harmonic), the bias following: central differences of the closed orbit, one-sided where
    /// the range of voltages ends.
    ///
    /// # Errors
    /// As [`Self::motion`].
    pub fn tangent(
        &self,
        voltages: &[(usize, Harmonic)],
        step_volt: f64,
    ) -> Result<Vec<FlapMotion>, PlantError> {
        if let Self::Ideal { gain_deg_per_volt, .. } = self {
            let along = |k| {
                let voltage_volt = only(k, 1.0);
                let flap_deg = scaled(&voltage_volt, *gain_deg_per_volt);
                FlapMotion { voltage_volt, flap_deg }
            };
            let places = voltages.iter().flat_map(|&(n, _)| [place(n, false), place(n, true)]);
            return Ok(places.map(along).collect());
        }
        // at the edge of the range no control may be free to move: a little inside they are
        let mut result = Err(PlantError::BiasSearch);
        for part in TANGENT_PARTS {
            let inside: Vec<_> = voltages.iter().map(|&(n, h)| (n, times(h, part))).collect();
            result = self.tangent_at(&inside, step_volt);
            if result.is_ok() {
                break;
            }
        }
        result
    }

    /// [`Self::tangent`] of a model at exactly these voltages.
    fn tangent_at(
        &self,
        voltages: &[(usize, Harmonic)],
        step_volt: f64,
    ) -> Result<Vec<FlapMotion>, PlantError> {
        let here = self.motion(voltages)?;
        (0..2 * voltages.len())
            .into_par_iter()
            .map(|control| {
                let moved = |by_volt: f64| {
                    let mut voltages = voltages.to_vec();
                    let harmonic = &mut voltages[control / 2].1;
                    if control % 2 == 0 {
                        harmonic.cosine += by_volt;
                    } else {
                        harmonic.sine += by_volt;
                    }
                    self.motion(&voltages)
                };
                match (moved(step_volt), moved(-step_volt)) {
                    (Ok(up), Ok(down)) => Ok(up.less(&down, 0.5 / step_volt)),
                    (Ok(up), Err(_)) => Ok(up.less(&here, 1.0 / step_volt)),
                    (Err(_), Ok(down)) => Ok(here.less(&down, 1.0 / step_volt)),
                    (Err(error), Err(_)) => Err(error),
                }
            })
            .collect()
    }

    /// The motion whose harmonics up to the highest wanted one are the wanted ones, mean included: by
    /// the periodic inverse of the model, with as many voltage harmonics.
    ///
    /// # Errors
    /// As [`ActuatorModel::periodic_inverse`]; [`PlantError::HeldBias`] where the bias is held, which the inverse sets.
    pub fn inverse(&self, wanted_deg: &HarmonicSeries) -> Result<FlapMotion, PlantError> {
        let count = wanted_deg.harmonics.len();
        match self {
            Self::Ideal { gain_deg_per_volt: gain, .. } => {
                let voltage = |n| {
                    let Harmonic { cosine, sine } = wanted_deg.harmonic(n);
                    (n, Harmonic { cosine: cosine / gain, sine: sine / gain })
                };
                self.motion(&(1..=count).map(voltage).collect::<Vec<_>>())
            }
            Self::Model { bias, .. } if bias.is_fixed() => Err(PlantError::HeldBias),
            Self::Model { model, rev_hz, .. } => {
                let settings =
                    InverseSettings { voltage_harmonics: count, ..InverseSettings::default() };
                Ok(model.periodic_inverse(wanted_deg, *rev_hz, &settings)?.response.into())
            }
        }
    }

    /// The same under a hinge moment (N m, positive in the sense of the flap angle, against azimuth):
    /// what the load takes from the motion is asked for beforehand.
    ///
    /// # Errors
    /// As [`Self::inverse`] and [`Self::loaded_motion`].
    pub fn loaded_inverse(
        &self,
        wanted_deg: &HarmonicSeries,
        hinge_moment_newton_metre: &HarmonicSeries,
    ) -> Result<FlapMotion, PlantError> {
        let mut made = self.inverse(wanted_deg)?;
        if self.compliance_deg_per_newton_metre() == 0.0 {
            return Ok(made);
        }
        let mut asked = wanted_deg.clone();
        for _ in 0..LOADED_INVERSE_ROUNDS {
            made = self.loaded_motion(&made, hinge_moment_newton_metre)?;
            let mut largest = 0.0_f64;
            for (k, asked) in asked.harmonics.iter_mut().enumerate() {
                let (want, got) = (wanted_deg.harmonics[k], made.flap_deg.harmonic(k + 1));
                let (cosine, sine) = (want.cosine - got.cosine, want.sine - got.sine);
                largest = largest.max(cosine.hypot(sine));
                *asked = Harmonic { cosine: asked.cosine + cosine, sine: asked.sine + sine };
            }
            if largest <= LOADED_INVERSE_TOLERANCE_DEG {
                return Ok(made);
            }
            made = self.inverse(&asked)?;
        }
        self.loaded_motion(&made, hinge_moment_newton_metre)
    }

    /// The range of voltages.
    pub fn range_volt(&self) -> VoltageRange {
        match self {
            Self::Ideal { range_volt, .. } | Self::Model { range_volt, .. } => *range_volt,
        }
    }

    /// The swing of the voltage over what the range leaves it: above 1 it cannot be asked for.
    pub fn range_ratio(&self, voltages: &[(usize, Harmonic)]) -> f64 {
        let (swing_volt, room_volt) = self.swing_and_room(alternating_volt(&series_of(voltages)));
        swing_volt / room_volt
    }

    /// Swing of a voltage with these extremes and the room the range leaves it, V: from its fixed bias
    /// to the tighter side for the ideal actuator and where the bias is held, over the whole range where it is free.
    fn swing_and_room(&self, (low, high): (f64, f64)) -> (f64, f64) {
        let (bias_volt, range_volt) = match self {
            Self::Ideal { bias_volt, range_volt, .. } => (*bias_volt, range_volt),
            Self::Model { bias: Bias::Fixed { volt }, range_volt, .. } => (*volt, range_volt),
            Self::Model { range_volt, .. } => return (high - low, range_volt.span_volt()),
        };
        let below = bias_volt - range_volt.lowest_volt();
        let above = range_volt.highest_volt() - bias_volt;
        if -low / below > high / above { (-low, below) } else { (high, above) }
    }

    /// Largest amplitude of one harmonic that stays inside the range of voltages with the bias that
    /// centres the flap, and the stroke it gives.
    ///
    /// The bias of an asymmetric actuator is not the middle of its range, so the full range is never
    /// quite there: the amplitude is `min(V_max - u_st, u_st - V_min)`, found by iteration because
    /// `u_st` depends on the amplitude.
    ///
    /// # Errors
    /// As [`Self::motion`].
    pub fn full_scale(
        &self,
        harmonic: usize,
        amplitude_volt: f64,
    ) -> Result<FullScale, PlantError> {
        let Self::Model { range_volt: range, bias, .. } = self else {
            let motion = self.motion(&[(harmonic, cosine(amplitude_volt))])?;
            return Ok(FullScale::of(&motion, harmonic, amplitude_volt));
        };
        if let Bias::Fixed { volt } = bias {
            let room = (range.highest_volt() - volt).min(volt - range.lowest_volt());
            let amplitude = amplitude_volt.min(room);
            let motion = self.motion(&[(harmonic, cosine(amplitude))])?;
            return Ok(FullScale::of(&motion, harmonic, amplitude));
        }
        let mut amplitude = (0.9 * amplitude_volt).min(0.45 * range.span_volt());
        let margin_volt = FULL_SCALE_MARGIN * range.span_volt();
        for _ in 0..FULL_SCALE_PASSES {
            let motion = match self.motion(&[(harmonic, cosine(amplitude))]) {
                // no room for the bias that centres the flap: a smaller amplitude leaves more
                Err(PlantError::Bias(_)) => {
                    amplitude *= 0.8;
                    continue;
                }
                motion => motion?,
            };
            let bias = motion.voltage_volt.mean;
            let room = (range.highest_volt() - bias).min(bias - range.lowest_volt());
            let next = amplitude_volt.min(room - margin_volt);
            if (next - amplitude).abs() <= 0.1 * margin_volt {
                break;
            }
            amplitude = next;
        }
        let motion = self.motion(&[(harmonic, cosine(amplitude))])?;
        Ok(FullScale::of(&motion, harmonic, amplitude))
    }

    /// Amplitude of one harmonic that gives a stroke below full scale, V, and the flap motion for a cosine of it,
    /// `[cosine, sine]`, deg: solved on the model, because the
    /// gain of an actuator with memory grows with its amplitude.
    ///
    /// # Errors
    /// As [`Self::motion`].
    pub fn voltage_of_stroke(
        &self,
        harmonic: usize,
        stroke_deg: f64,
        full: FullScale,
    ) -> Result<(f64, [f64; 2]), PlantError> {
        let mut reached_deg = [0.0, 0.0];
        let (mut low, mut high) = ([0.0, 0.0], [full.amplitude_volt, full.stroke_deg]);
        for pass in 0..STROKE_PASSES {
            // a little below the chord, and the middle by turns, so that neither end can stay
            let aim = stroke_deg * (1.0 - 0.5 * STROKE_TOLERANCE);
            let part = if pass % 3 == 2 { 0.5 } else { (aim - low[1]) / (high[1] - low[1]) };
            let volt = low[0] + part * (high[0] - low[0]);
            let motion = self.motion(&[(harmonic, cosine(volt))])?;
            let Harmonic { cosine, sine } = motion.flap_deg.harmonic(harmonic);
            let found = cosine.hypot(sine);
            if found <= stroke_deg {
                (low, reached_deg) = ([volt, found], [cosine, sine]);
            } else {
                high = [volt, found];
            }
            let reached = low[1] >= stroke_deg * (1.0 - STROKE_TOLERANCE);
            if reached || high[0] - low[0] <= SMALLEST_STROKE_VOLT {
                break;
            }
        }
        Ok((low[0], reached_deg))
    }
}

/// How far below a given stroke the voltage that belongs to it may stay, relative.
const STROKE_TOLERANCE: f64 = 1e-4;
/// Voltage below which that is not distinguished, V.
const SMALLEST_STROKE_VOLT: f64 = 1e-6;
/// Trials of that voltage.
const STROKE_PASSES: usize = 60;

/// Rounds of the inverse under load: the load takes nearly the same whatever the voltage.
const LOADED_INVERSE_ROUNDS: usize = 6;
/// Miss of a wanted harmonic at which these rounds end, deg.
const LOADED_INVERSE_TOLERANCE_DEG: f64 = 1e-4;

/// An actuator model in the time of the rotor, with its range of voltages and the load on it, N.
struct PeriodicDrive<'a> {
    model: &'a ActuatorModel,
    range_volt: &'a VoltageRange,
    rev_hz: f64,
    load: Option<HarmonicSeries>,
}

impl PeriodicDrive<'_> {
    fn response(&self, voltage: &HarmonicSeries) -> Result<PeriodicResponse, PreisachError> {
        let settings = PeriodicSettings::default();
        match &self.load {
            None => self.model.periodic_response(voltage, self.rev_hz, &settings),
            Some(load) => {
                self.model.periodic_response_loaded(voltage, load, self.rev_hz, &settings)
            }
        }
    }

    /// The motion whose mean is `mean_deg`, by the bias, from that of the voltage on.
    fn biased(
        &self,
        mut voltage: HarmonicSeries,
        mean_deg: f64,
        tolerance_deg: f64,
    ) -> Result<FlapMotion, PlantError> {
        let (low, high) = alternating_volt(&voltage);
        let (lowest, highest) = (self.range_volt.lowest_volt(), self.range_volt.highest_volt());
        let solver = BiasSolver {
            range_volt: [lowest - low, highest - high],
            guess_volt: voltage.mean,
            slope_deg_per_volt: QUASI_STATIC_SLOPE_DEG_PER_VOLT,
            tolerance_deg,
        };
        let mut orbit = None;
        let solution = solver.solve(|bias_volt| {
            voltage.mean = bias_volt;
            let response = self.response(&voltage)?;
            let gap_deg = response.flap_deg.mean - mean_deg;
            orbit = Some((bias_volt, response));
            Ok::<_, PreisachError>(gap_deg)
        });
        let bias_volt = match solution {
            Ok(solution) => solution.bias_volt,
            Err(RunError::Plant { source, .. }) => return Err(source.into()),
            Err(RunError::Control(error)) => {
                nearly_centred(&error).ok_or(PlantError::Bias(error))?
            }
            Err(_) => return Err(PlantError::BiasSearch),
        };
        // the search may have ended on another trial than its last one
        match orbit {
            Some((at, response)) if at.to_bits() == bias_volt.to_bits() => Ok(response.into()),
            _ => {
                voltage.mean = bias_volt;
                Ok(self.response(&voltage)?.into())
            }
        }
    }
}

/// The bias at the end of its range, or beside a jump of the mean, where the mean flap angle is small all the same.
fn nearly_centred(error: &ControlError) -> Option<f64> {
    let sides = match *error {
        ControlError::BiasOutOfRange { low_volt, high_volt, low_deg, high_deg } => {
            [(low_volt, low_deg), (high_volt, high_deg)]
        }
        ControlError::BiasJump { bias_volt, below_deg, above_deg, .. } => {
            [(bias_volt, below_deg), (bias_volt, above_deg)]
        }
        _ => return None,
    };
    let [first, second] = sides;
    let (bias_volt, mean_deg) = if second.1.abs() < first.1.abs() { second } else { first };
    (mean_deg.abs() <= MEAN_FLAP_TOLERANCE_DEG).then_some(bias_volt)
}

/// Change of the mean flap angle with the bias of a bench that makes +-10 deg over 170 V, deg/V: the
/// bias search's first guess only.
const QUASI_STATIC_SLOPE_DEG_PER_VOLT: f64 = 20.0 / 170.0;
/// Parts of a voltage at which its tangent is sought, the first that has one.
const TANGENT_PARTS: [f64; 4] = [1.0, 0.97, 0.93, 0.85];
/// Room left to the bias at full scale, as a part of the range of voltages: 0.1 V of 170 V.
const FULL_SCALE_MARGIN: f64 = 0.1 / 170.0;
const FULL_SCALE_PASSES: usize = 12;

fn cosine(amplitude: f64) -> Harmonic {
    Harmonic { cosine: amplitude, sine: 0.0 }
}

fn series_of(voltages: &[(usize, Harmonic)]) -> HarmonicSeries {
    let mut series = HarmonicSeries::zero(0);
    for &(n, harmonic) in voltages {
        series.set_harmonic(n, harmonic);
    }
    series
}

/// Lowest and highest value of the voltage's harmonics over a revolution, bias apart.
fn alternating_volt(voltage: &HarmonicSeries) -> (f64, f64) {
    let alternating = HarmonicSeries { mean: 0.0, ..voltage.clone() };
    uniform_azimuths_rad(PeriodicSettings::default().steps_per_rev)
        .into_iter()
        .map(|azimuth| alternating.value(azimuth))
        .fold((0.0, 0.0), |(low, high): (f64, f64), v| (low.min(v), high.max(v)))
}

#[cfg(test)]
mod tests {
    use super::*;
    use preisach_dyn::{ActuatorLaw, PrandtlIshlinskii, PrandtlParameters, WeightedPlay};

    /// Plays whose gain grows with the amplitude: half of full voltage gives far less than half of the stroke.
    fn hysteretic() -> FlapDrive {
        let range = VoltageRange::new(-20.0, 150.0).unwrap();
        let play = |threshold_volt| WeightedPlay { threshold_volt, weight_deg_per_volt: 0.02 };
        let parameters = PrandtlParameters {
            range_volt: range,
            gain_deg_per_volt: 0.01,
            plays: [10.0, 20.0, 30.0, 40.0].map(play).to_vec(),
            threshold_growth_s: 0.0,
            envelope: preisach_dyn::Envelope::default(),
        };
        let law = ActuatorLaw::PrandtlIshlinskii(PrandtlIshlinskii::new(parameters).unwrap());
        let model = ActuatorModel { law, ..ActuatorModel::linear(range, 8.5, 0.04) };
        centred(model)
    }

    fn centred(model: ActuatorModel) -> FlapDrive {
        let (range_volt, bias) = (model.range_volt, Bias::Centred { guess_volt: 65.0 });
        FlapDrive::Model { model: Arc::new(model), range_volt, rev_hz: 5.0, bias }
    }

    /// The same actuator with its bias held.
    fn held(drive: &FlapDrive, volt: f64) -> FlapDrive {
        let mut held = drive.clone();
        if let FlapDrive::Model { bias, .. } = &mut held {
            *bias = Bias::Fixed { volt };
        }
        held
    }

    #[test]
    fn a_given_stroke_is_reached_and_never_exceeded() {
        let drive = hysteretic();
        let full = drive.full_scale(3, 85.0).unwrap();
        for stroke_deg in [0.1, 0.5, 1.0, 2.0, 0.999 * full.stroke_deg] {
            let (volt, _) = drive.voltage_of_stroke(3, stroke_deg, full).unwrap();
            // at any phase
            let (sin, cos) = 0.7_f64.sin_cos();
            let turned = Harmonic { cosine: volt * cos, sine: volt * sin };
            let motion = drive.motion(&[(3, turned)]).unwrap();
            let found = motion.flap_deg.harmonic(3).amplitude();
            assert!(found <= stroke_deg * (1.0 + 1e-5), "{found} of {stroke_deg}");
            assert!(found >= stroke_deg * (1.0 - 2e-4), "{found} of {stroke_deg}");
            // the voltage in proportion would fall short
            let linear = full.amplitude_volt * stroke_deg / full.stroke_deg;
            assert!(volt > linear, "{volt} {linear}");
        }
        let short = drive.motion(&[(3, cosine(0.3 * full.amplitude_volt))]).unwrap();
        let part = short.flap_deg.harmonic(3).amplitude() / full.stroke_deg;
        assert!(part < 0.25, "the actuator of this test is too straight: {part}");
    }

    /// No hysteresis, a curve that bends: `delta = r (zeta + q zeta^2)`, `zeta = (V - 65 V) / 85 V`.
    fn bent(quadratic: f64) -> FlapDrive {
        let range = VoltageRange::new(-20.0, 150.0).unwrap();
        let parameters = PrandtlParameters {
            range_volt: range,
            gain_deg_per_volt: 0.1,
            plays: Vec::new(),
            threshold_growth_s: 0.0,
            envelope: preisach_dyn::Envelope { quadratic, ..preisach_dyn::Envelope::default() },
        };
        let law = ActuatorLaw::PrandtlIshlinskii(PrandtlIshlinskii::new(parameters).unwrap());
        let model = ActuatorModel { law, ..ActuatorModel::linear(range, 8.5, 0.04) };
        centred(model)
    }

    /// The mean of `r (zeta + q zeta^2)` over a swing of `a` about `z` is `r (z + q z^2 + q a^2 / 2)`: it vanishes at
    /// `z = (sqrt(1 - 2 q^2 a^2) - 1) / (2 q)`, whose slope is `dz/da = -q a / sqrt(1 - 2 q^2 a^2)`.
    #[test]
    fn the_bias_and_its_slope_are_those_of_a_bent_curve() {
        let q = 0.05;
        let drive = bent(q);
        for (volt, phase) in [(10.0, 0.3), (40.0, 2.0), (78.0, -1.1)] {
            let (sin, cos) = f64::sin_cos(phase);
            let a = volt / 85.0;
            let root = f64::sqrt(1.0 - 2.0 * q * q * a * a);
            let voltages = [(3, Harmonic { cosine: volt * cos, sine: volt * sin })];
            let motion = drive.motion(&voltages).unwrap();
            let bias = 65.0 + 85.0 * (root - 1.0) / (2.0 * q);
            assert!((motion.voltage_volt.mean - bias).abs() <= 2e-5, "{volt} V: {motion:?}");
            assert!(motion.flap_deg.mean.abs() <= BIAS_TOLERANCE_DEG);
            let slope = -q * a / root;
            let tangent = drive.tangent(&voltages, 1.0).unwrap();
            for (along, exact) in tangent.iter().zip([slope * cos, slope * sin]) {
                let found = along.voltage_volt.mean;
                assert!((found - exact).abs() <= 5e-5, "{volt} V: {found} {exact}");
            }
        }
    }

    /// A bias that is held leaves the mean `r (z + q z^2 + q a^2 / 2)` of the same curve, and the swing the room to the nearer
    /// end of the range.
    #[test]
    fn a_bias_that_is_held_leaves_the_mean_angle_to_the_actuator() {
        let (q, r) = (0.05, 8.5);
        for (volt, swing) in [(65.0, 40.0), (50.0, 60.0), (90.0, 55.0)] {
            let drive = held(&bent(q), volt);
            let voltages = [(3, Harmonic { cosine: 0.6 * swing, sine: -0.8 * swing })];
            let motion = drive.motion(&voltages).unwrap();
            assert_eq!(motion.voltage_volt.mean.to_bits(), f64::to_bits(volt));
            let (z, a) = ((volt - 65.0) / 85.0, swing / 85.0);
            let mean_deg = r * (z + q * z * z + 0.5 * q * a * a);
            assert!((motion.flap_deg.mean - mean_deg).abs() < 1e-4, "{motion:?} {mean_deg}");
            assert!(mean_deg.abs() > 0.04, "the mean of this test is to be seen");
            // the bias does not move with the control
            for along in drive.tangent(&voltages, 1.0).unwrap() {
                assert_eq!(along.voltage_volt.mean.to_bits(), 0);
            }
        }
        let full = held(&bent(q), 50.0).full_scale(3, 85.0).unwrap();
        assert!((full.amplitude_volt - 70.0).abs() < 1e-12, "{full:?}");
        let beyond = held(&bent(q), 50.0).motion(&[(3, cosine(71.0))]);
        assert!(matches!(beyond, Err(PlantError::VoltageSwing { .. })), "{beyond:?}");
        let refused = held(&bent(q), 65.0).inverse(&HarmonicSeries::zero(3));
        assert_eq!(refused, Err(PlantError::HeldBias));
    }

    /// A steady hinge moment turns a soft flap whose bias is held; one that is centred gets a bias against it.
    #[test]
    fn a_steady_moment_turns_the_flap_whose_bias_is_held() {
        let range = VoltageRange::new(-20.0, 150.0).unwrap();
        let mut model = ActuatorModel::linear(range, 8.5, 0.04);
        let load =
            preisach_dyn::LoadStiffness { stiffness_ratio: 0.0, compliance_um_per_newton: 0.1 };
        model.linkage.push(LinkageStage::LoadStiffness(load));
        let drive = centred(model);
        let give = drive.compliance_deg_per_newton_metre();
        let moment = HarmonicSeries { mean: -0.5, ..HarmonicSeries::zero(1) };
        let voltages = [(2, cosine(30.0))];
        for (drive, mean_deg) in [(drive.clone(), 0.0), (held(&drive, 65.0), -0.5 * give)] {
            let free = drive.motion(&voltages).unwrap();
            let loaded = drive.loaded_motion(&free, &moment).unwrap();
            assert!(
                (loaded.flap_deg.mean - mean_deg).abs() < 1e-7,
                "{} {mean_deg}",
                loaded.flap_deg.mean
            );
        }
        assert!(give > 1e-3, "{give}");
    }

    /// Where the centring bias lies beyond the range by a trifle, the end of the range leaves a small mean.
    #[test]
    fn at_the_end_of_the_range_the_bias_is_that_end() {
        let drive = bent(1e-3);
        let wave = |volt: f64| drive.motion(&[(2, cosine(volt))]);
        // the bias wanted is 0.042 V below the middle
        let held = wave(84.97).unwrap();
        assert!((held.voltage_volt.mean - 64.97).abs() <= 1e-9, "{held:?}");
        assert!((1e-4..MEAN_FLAP_TOLERANCE_DEG).contains(&held.flap_deg.mean), "{held:?}");
        assert!(matches!(bent(0.05).motion(&[(2, cosine(84.9))]), Err(PlantError::Bias(_))));
    }
}
