//! What the stall makes of a measured motion, and how far it is off.

use super::loops::MeasuredLoop;
use flap_aero::{
    AeroError, AttachedFlowModel, FlapChord, Mach, MarchingSection, SectionInputs, SectionState,
    StallParameters, StallSection, StallState, StepFactors,
};
use std::f64::consts::TAU;

/// Steps of a cycle.
const STEPS: usize = 180;
/// Cycles before the one that counts.
const SETTLING: usize = 2;

/// Constants, and the camber that they count from.
#[derive(Debug, Clone, Copy)]
pub struct Stalling {
    /// The constants.
    pub parameters: StallParameters,
    /// Incidence of zero lift, rad.
    pub zero_lift_rad: f64,
    /// Moment there.
    pub zero_lift_moment: f64,
}

/// Lift, pressure drag and moment of a cycle, from the mean incidence on.
pub struct Cycle(Vec<[f64; 3]>);

impl Cycle {
    /// The cycle of a motion.
    ///
    /// # Errors
    /// Those of the section.
    pub fn of(measured: &MeasuredLoop, stalling: &Stalling) -> Result<Self, AeroError> {
        let mach = Mach::new(measured.mach)?;
        let model = AttachedFlowModel::Calibrated.coefficients(mach, FlapChord::NONE)?;
        let attached = MarchingSection::new(&model);
        let section = StallSection::new(mach, FlapChord::NONE, stalling.parameters)?;
        let k = measured.reduced_frequency;
        let step = TAU / k / STEPS as f64;
        let factors = StepFactors::new(&attached, step)?;
        let (mean, amplitude) =
            (measured.mean_deg.to_radians(), measured.amplitude_deg.to_radians());
        let at = |n: usize| {
            let (sin, cos) = (TAU * n as f64 / STEPS as f64).sin_cos();
            let alpha = mean + amplitude * sin - stalling.zero_lift_rad;
            SectionInputs { modes: [alpha, 2.0 * k * amplitude * cos, 0.0, 0.0], rates: [0.0; 4] }
        };
        let mut state = SectionState::settled(&attached, &at(0).modes);
        let [normal, ..] = state.loads(&attached, &at(0))?;
        let mut stall = StallState::settled(&section, normal, &at(0).modes);
        let mut values = vec![[0.0; 3]; STEPS];
        for n in 1..=(SETTLING + 1) * STEPS {
            let inputs = at(n);
            let loads = state.step_with(&attached, &inputs, &factors)?;
            let found = stall.step(&section, loads, &inputs.modes, step)?;
            let (sin, cos) = (inputs.modes[0] + stalling.zero_lift_rad).sin_cos();
            values[n % STEPS] = [
                found.normal * cos + found.chord * sin,
                found.normal * sin - found.chord * cos,
                found.moment + stalling.zero_lift_moment,
            ];
        }
        Ok(Self(values))
    }

    /// A coefficient at a phase, between the steps.
    pub fn at(&self, which: usize, phase_deg: f64) -> f64 {
        let place = (phase_deg / 360.0).rem_euclid(1.0) * STEPS as f64;
        #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "0 to STEPS")]
        let before = place as usize % STEPS;
        let (from, to) = (self.0[before][which], self.0[(before + 1) % STEPS][which]);
        from + (place - place.floor()) * (to - from)
    }

    /// Highest lift and drag, lowest moment.
    pub fn extreme(&self, which: usize) -> f64 {
        extreme(self.0.iter().map(|values| values[which]), which)
    }
}

/// Highest lift or drag, lowest moment of some values.
pub fn extreme(values: impl Iterator<Item = f64>, which: usize) -> f64 {
    if which == 2 { values.fold(f64::INFINITY, f64::min) } else { values.fold(f64::MIN, f64::max) }
}

/// How far a cycle is off a loop, per coefficient; NaN where it was not measured.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Errors {
    /// Of the extreme, over its size, per cent.
    pub extreme_percent: [f64; 3],
    /// Root mean square over the measured points.
    pub rms: [f64; 3],
}

/// Points that make a loop.
pub const FEWEST_POINTS: usize = 8;

impl Errors {
    /// Of a cycle.
    pub fn of(measured: &MeasuredLoop, cycle: &Cycle) -> Self {
        let mut found = Self { extreme_percent: [f64::NAN; 3], rms: [f64::NAN; 3] };
        for (which, points) in measured.values.iter().enumerate() {
            if points.len() < FEWEST_POINTS {
                continue;
            }
            let real = extreme(points.iter().map(|[_, value]| *value), which);
            found.extreme_percent[which] = 100.0 * (cycle.extreme(which) - real) / real.abs();
            let squares =
                points.iter().map(|[phase, value]| (cycle.at(which, *phase) - value).powi(2));
            found.rms[which] = (squares.sum::<f64>() / points.len() as f64).sqrt();
        }
        found
    }
}
