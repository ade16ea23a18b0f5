//! How the sensitivity T of the outputs to the controls is held: constant, identified again, or filtered.

mod filtered;
mod linearised;

use crate::identify::differences;
use crate::{ControlError, ControlStep, FeedbackLaw, OperatingPoint, Plant, RunError, TMatrix};
pub use filtered::AdaptiveSettings;
use filtered::Filtered;
use linearised::Linearised;
use nalgebra::DVector;

/// How a controller holds the sensitivity `T` of the loads to its voltages. Everything else is one method for
/// all: the target of a step, the line search, the tests of convergence and the record
/// ([`crate::FeedbackController`]).
///
/// Source: `Global` is the feedback form of the global controller, eq. (8)-(10); names and the other
/// two after W. Johnson, *Self-tuning regulators for multicyclic control of helicopter vibration*, NASA
/// TP-1996 (1982).
#[derive(Debug, Clone, PartialEq, Default)]
pub enum Controller {
    /// T0 identified about zero control and held constant.
    #[default]
    Global,
    /// T held constant until no part of a step lowers the cost and full steps do not settle either; it is
    /// then identified again about the present control, by differences, and held on.
    Renewed {
        /// Voltage step of each control for the differences, V.
        step_volt: Vec<f64>,
        /// Renewals at most.
        renewals: u32,
    },
    /// T identified again about the present control before every step: from the plant's linearised
    /// solution if it has one, else by differences. If no part of a step lowers the cost all the same,
    /// T is corrected along that step by what was measured there, and the next step asked for; once as many
    /// corrections as controls have led nowhere, T is found by differences from there on. Where the plant
    /// admits neither side of a control, at the edge of its range, the T known so far stays.
    Local {
        /// Voltage step of each control for the differences, V.
        step_volt: Vec<f64>,
    },
    /// T and the uncontrolled loads Z0 followed by a Kalman filter on every measured pair (u, Z), those
    /// of rejected steps included; T0 is where it starts.
    Adaptive(AdaptiveSettings),
}

impl Controller {
    /// Name for reports.
    pub fn name(&self) -> &'static str {
        match self {
            Self::Global => "global",
            Self::Renewed { .. } => "renewed",
            Self::Local { .. } => "local",
            Self::Adaptive(_) => "adaptive",
        }
    }
}

/// The law as it stands during a run, and how its T is renewed.
pub(crate) struct Sensitivity<'a> {
    pub(crate) law: FeedbackLaw,
    policy: Policy<'a>,
    pub(crate) counts: Counts,
}

/// What learning T took.
#[derive(Debug, Clone, Copy, Default)]
pub(crate) struct Counts {
    /// Measurements beyond those of the steps.
    pub(crate) measurements: usize,
    /// Times that T was identified again or probed.
    pub(crate) identifications: usize,
}

enum Policy<'a> {
    /// Constant, with a number of renewals.
    Held {
        step_volt: &'a [f64],
        renewals_left: u32,
    },
    Linearised(Linearised<'a>),
    Filtered(Box<Filtered>),
}

/// T identified about a control, and the measurements it took.
type Identified = (TMatrix, usize);

/// T by differences about a state; none where the range leaves no room.
fn by_differences<P: Plant>(
    plant: &mut P,
    at: OperatingPoint<'_>,
    step_volt: &[f64],
) -> Result<Option<Identified>, RunError<P::Error>> {
    match differences(plant, at, step_volt, P::admits) {
        Err(RunError::Control(ControlError::NoRoomToIdentify { .. })) => Ok(None),
        found => found.map(Some),
    }
}

/// Whether the T of a converged loop can be trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verified {
    /// It can.
    Yes,
    /// T has been probed anew: the target is to be computed again.
    Anew,
    /// No probe is left.
    Cannot,
}

impl<'a> Sensitivity<'a> {
    pub(crate) fn new(
        controller: &'a Controller,
        law: &FeedbackLaw,
        start: &ControlStep,
    ) -> Result<Self, ControlError> {
        let policy = match controller {
            Controller::Global => Policy::Held { step_volt: &[], renewals_left: 0 },
            Controller::Renewed { step_volt, renewals } => {
                Policy::Held { step_volt, renewals_left: *renewals }
            }
            Controller::Local { step_volt } => {
                Policy::Linearised(Linearised::new(step_volt, start.control_volt.len()))
            }
            Controller::Adaptive(settings) => {
                Policy::Filtered(Box::new(Filtered::new(settings, law, start)?))
            }
        };
        Ok(Self { law: law.clone(), policy, counts: Counts::default() })
    }

    /// Brings T up to date before a step from a measured state.
    pub(crate) fn refresh<P: Plant>(
        &mut self,
        plant: &mut P,
        here: &ControlStep,
    ) -> Result<(), RunError<P::Error>> {
        match &mut self.policy {
            Policy::Held { .. } => {}
            Policy::Linearised(policy) => {
                let found = policy.identify(plant, here)?;
                self.take_up(found)?;
            }
            Policy::Filtered(policy) => self.law = self.law.with_t(policy.filter.t())?,
        }
        Ok(())
    }

    /// Takes up a T; whether there is one.
    fn take_up(&mut self, found: Option<Identified>) -> Result<bool, ControlError> {
        let Some((t, measurements)) = found else { return Ok(false) };
        self.law = self.law.with_t(&t)?;
        self.counts.measurements += measurements;
        self.counts.identifications += 1;
        Ok(true)
    }

    /// Whether T stays as it is from step to step.
    pub(crate) fn is_constant(&self) -> bool {
        matches!(self.policy, Policy::Held { .. })
    }

    /// Whether T is that of the present control, found anew at every step.
    pub(crate) fn is_local(&self) -> bool {
        matches!(self.policy, Policy::Linearised(_))
    }

    /// Identifies a constant T again about a state that it does not lead away from; false where it may not, or
    /// where the range leaves no room.
    pub(crate) fn renew<P: Plant>(
        &mut self,
        plant: &mut P,
        here: &ControlStep,
    ) -> Result<bool, RunError<P::Error>> {
        let Policy::Held { step_volt, renewals_left: left @ 1.. } = &mut self.policy else {
            return Ok(false);
        };
        *left -= 1;
        let found = by_differences(plant, here.point(), step_volt)?;
        Ok(self.take_up(found)?)
    }

    /// Takes note of a measured pair.
    pub(crate) fn observe(&mut self, at: OperatingPoint<'_>) -> Result<(), ControlError> {
        match &mut self.policy {
            Policy::Held { .. } => {}
            Policy::Linearised(policy) => policy.observe(at),
            Policy::Filtered(policy) => {
                policy.filter.observe(at)?;
            }
        }
        Ok(())
    }

    /// Right-hand side of the law at a state, from the outputs that it aims from.
    pub(crate) fn modal_target(
        &self,
        at: OperatingPoint<'_>,
    ) -> Result<DVector<f64>, ControlError> {
        let outputs = self.seen_outputs(at);
        self.law.modal_target(OperatingPoint { outputs: &outputs, ..at })
    }

    /// The outputs that the law aims from: those measured, or the filter's estimate.
    pub(crate) fn seen_outputs(&self, at: OperatingPoint<'_>) -> Vec<f64> {
        match &self.policy {
            Policy::Filtered(policy) => {
                let mut loads = at.outputs.to_vec();
                policy.filter.loads_at(at.control_volt, &mut loads);
                loads
            }
            _ => at.outputs.to_vec(),
        }
    }

    /// Decrease of the cost that the law predicts from a state to a target.
    pub(crate) fn predicted_decrease(
        &self,
        rho: f64,
        here: &ControlStep,
        target_volt: &[f64],
    ) -> Result<f64, ControlError> {
        let outputs = self.seen_outputs(here.point());
        self.law.promise(rho, OperatingPoint { outputs: &outputs, ..here.point() }, target_volt)
    }

    /// After a step that was rejected in full: whether T has changed, so that another step is worth computing. A
    /// local T is corrected along the step by the rejected measurements; an adaptive one has learnt from them
    /// already, and each control is probed where the target is still much the same.
    pub(crate) fn learn<P: Plant>(
        &mut self,
        plant: &mut P,
        here: &ControlStep,
        target_volt: &[f64],
    ) -> Result<bool, RunError<P::Error>> {
        match &mut self.policy {
            Policy::Held { .. } => Ok(false),
            Policy::Linearised(policy) => {
                let t = self.law.t().as_matrix();
                let (is_learnt, corrected) = policy.correct(t, here, target_volt)?;
                self.take_up(corrected.map(|t| (t, 0)))?;
                Ok(is_learnt)
            }
            Policy::Filtered(policy) => policy.learn(plant, here, target_volt, &mut self.counts),
        }
    }

    /// Before a loop ends as converged: whether its T is that of the present control. A filtered T is probed there.
    pub(crate) fn verify<P: Plant>(
        &mut self,
        plant: &mut P,
        here: &ControlStep,
        target_volt: &[f64],
    ) -> Result<Verified, RunError<P::Error>> {
        match &mut self.policy {
            Policy::Filtered(policy) => policy.verify(plant, here, target_volt, &mut self.counts),
            _ => Ok(Verified::Yes),
        }
    }
}
