//! Joints that stick, undone exactly, the one nearest to the flap first.

use super::newton::{REACH_RESOLUTION, Search};
use super::{InverseSettings, PeriodicInverse};
use crate::{
    ActuatorLaw, ActuatorModel, Backlash, CoulombFriction, LinearGain, LinkageStage,
    PeriodicSettings, PreisachError, VoltageRange,
};
use actuator_stages::FrictionStep;
use rotor_base::{Harmonic, HarmonicSeries, uniform_azimuths_rad};

/// A joint that sticks, its half-width in deg.
#[derive(Debug, Clone, Copy, PartialEq)]
enum Joint {
    Gap { half_width_deg: f64 },
    Friction(FrictionStep),
}

/// The joint nearest to the flap and its place in the linkage.
#[derive(Debug, Clone, Copy)]
pub(super) struct LastJoint {
    joint: Joint,
    index: usize,
}

impl LastJoint {
    pub(super) fn of(model: &ActuatorModel) -> Option<Self> {
        let half_deg = |width_um: f64| 0.5 * width_um * model.calibration.deg_per_um.abs();
        model.linkage.iter().enumerate().rev().find_map(|(index, stage)| {
            let joint = match *stage {
                LinkageStage::Backlash(Backlash { width_um }) if width_um > 0.0 => {
                    Joint::Gap { half_width_deg: half_deg(width_um) }
                }
                LinkageStage::CoulombFriction(CoulombFriction { width_um }) if width_um > 0.0 => {
                    Joint::Friction(FrictionStep::new(half_deg(width_um)))
                }
                _ => return None,
            };
            Some(Self { joint, index })
        })
    }

    /// The periodic inverse of an actuator with this joint.
    pub(super) fn inverse(
        &self,
        model: &ActuatorModel,
        wanted_deg: &HarmonicSeries,
        rev_hz: f64,
        settings: &InverseSettings,
    ) -> Result<PeriodicInverse, PreisachError> {
        let attempt =
            |share: f64| self.attempt(model, &scaled(wanted_deg, share), rev_hz, settings);
        let mut refused = match attempt(1.0) {
            Err(error @ PreisachError::MotionOutOfReach { .. }) => error,
            done => return done,
        };
        // the reach of the joint's input is not that of the flap: it is sought again
        let (mut within, mut step) = (0.0, 0.5);
        while step >= REACH_RESOLUTION {
            match attempt(within + step) {
                Ok(_) => within += step,
                Err(error @ PreisachError::MotionOutOfReach { .. }) => refused = error,
                Err(other) => return Err(other),
            }
            step *= 0.5;
        }
        if let PreisachError::MotionOutOfReach { wanted_deg: wanted, reachable_deg, .. } =
            &mut refused
        {
            *wanted = Search::new(model, wanted_deg, rev_hz, settings)?.amplitude_deg();
            *reachable_deg = within * *wanted;
        }
        Err(refused)
    }

    fn attempt(
        &self,
        model: &ActuatorModel,
        wanted_deg: &HarmonicSeries,
        rev_hz: f64,
        settings: &InverseSettings,
    ) -> Result<PeriodicInverse, PreisachError> {
        let behind_deg = self.behind(model, wanted_deg, rev_hz, settings)?;
        let steps = settings.periodic.steps_per_rev.max(4 * LEAST_HARMONICS);
        let output_deg: Vec<f64> =
            uniform_azimuths_rad(steps).iter().map(|&psi| behind_deg.value(psi)).collect();
        // the way through the gap is short: few harmonics would spread it beyond the motion
        let voltage_harmonics = settings.voltage_harmonics.max(LEAST_HARMONICS);
        let periodic = PeriodicSettings { steps_per_rev: steps, ..settings.periodic };
        let fine = InverseSettings { periodic, voltage_harmonics, ..*settings };
        let count = fine.voltage_harmonics;
        let input_deg = match self.joint {
            Joint::Gap { half_width_deg } => {
                gap_input(&output_deg, half_width_deg, output_deg.len() / count)
            }
            Joint::Friction(step) => friction_input(&output_deg, step),
        };
        let input_deg = HarmonicSeries::from_uniform_samples(&input_deg, count)?;
        let linkage = model.linkage[..self.index].to_vec();
        let before = ActuatorModel { linkage, ..model.clone() };
        let before = match Self::of(&before) {
            Some(joint) => joint.attempt(&before, &input_deg, rev_hz, &fine)?,
            None => Search::new(&before, &input_deg, rev_hz, &fine)?.start_at_rest()?,
        };
        let whole = Search::new(model, wanted_deg, rev_hz, settings)?;
        let solved = wanted_deg.harmonics.len();
        let polished = whole.start_at(&before.response.voltage_volt, solved)?;
        let iterations = before.iterations + polished.iterations;
        Ok(PeriodicInverse { iterations, ..polished })
    }

    /// What is wanted right behind the joint: the stages that follow it are smooth, and undone on
    /// their own.
    fn behind(
        &self,
        model: &ActuatorModel,
        wanted_deg: &HarmonicSeries,
        rev_hz: f64,
        settings: &InverseSettings,
    ) -> Result<HarmonicSeries, PreisachError> {
        let linkage = model.linkage[self.index + 1..].to_vec();
        if linkage.is_empty() {
            return Ok(wanted_deg.clone());
        }
        let sizes = wanted_deg.harmonics.iter().map(Harmonic::amplitude);
        let limit = AMPLE * (wanted_deg.mean.abs() + sizes.sum::<f64>()).max(1.0);
        let law = ActuatorLaw::Linear(LinearGain { gain_deg_per_volt: 1.0, bias_volt: 0.0 });
        let range = VoltageRange::new(-limit, limit)?;
        let stages = ActuatorModel { linkage, ..ActuatorModel::new(law, range, model.calibration) };
        Ok(stages.periodic_inverse(wanted_deg, rev_hz, settings)?.response.voltage_volt)
    }
}

/// Harmonics with which what is asked of a joint's input is sought, at least.
const LEAST_HARMONICS: usize = 48;

/// How much more than the flap's motion the input of the stages behind a joint may be: a mode
/// driven above its frequency asks for more.
const AMPLE: f64 = 100.0;

/// The periodic input of a gap for which the output is as given, both deg: `x = y + r sgn(dy)`, the sign
/// averaged over `spread` samples about each, over which jumps are spread.
fn gap_input(output_deg: &[f64], half_width_deg: f64, spread: usize) -> Vec<f64> {
    let count = output_deg.len();
    let before = |i: usize| output_deg[(i + count - 1) % count];
    let signs: Vec<f64> = (0..count)
        .map(|i| (output_deg[i] - before(i)).total_cmp(&0.0) as i32)
        .map(f64::from)
        .collect();
    let reach = spread / 2;
    let mean = |i: usize| {
        let window = (0..=2 * reach).map(|k| signs[(i + count + k - reach) % count]);
        window.sum::<f64>() / (2 * reach + 1) as f64
    };
    (0..count).map(|i| output_deg[i] + half_width_deg * mean(i)).collect()
}

/// The same of friction, sample by sample, each from the stretch that the last one left, until it closes.
fn friction_input(output_deg: &[f64], step: FrictionStep) -> Vec<f64> {
    let mut input_deg = output_deg.to_vec();
    let (mut stretch, mut last) = (0.0, output_deg.last().copied().unwrap_or(0.0));
    for _ in 0..MOST_ROUNDS {
        let mut change = 0.0_f64;
        for (input, &output) in input_deg.iter_mut().zip(output_deg) {
            stretch = step.stretched(stretch, output - last);
            last = output;
            change = change.max((output + stretch - *input).abs());
            *input = output + stretch;
        }
        if change <= CLOSURE_DEG {
            break;
        }
    }
    input_deg
}

/// Rounds of a friction joint's input: the stretch of the start fades with the way.
const MOST_ROUNDS: usize = 50;
/// Largest change of that input over its last round, deg.
const CLOSURE_DEG: f64 = 1e-10;

/// The series with its harmonics scaled, its mean kept.
fn scaled(series: &HarmonicSeries, share: f64) -> HarmonicSeries {
    let harmonics = series.harmonics.iter();
    let harmonics =
        harmonics.map(|h| Harmonic { cosine: share * h.cosine, sine: share * h.sine }).collect();
    HarmonicSeries { mean: series.mean, harmonics }
}
