//! What a controller knows of T, and how it learns.

use crate::adaptive::Kalman;
use crate::{
    AdaptiveSettings, ControlError, ControlStep, FeedbackLaw, Plant, PlantCall, RunError, TMatrix,
    identify_t_about,
};
use nalgebra::{DMatrix, DVector};

/// How a controller knows the sensitivity `T` of the loads to its voltages. Everything else, the aim
/// of a step, its halving, the test of convergence and the record, is one loop for all:
/// [`crate::FeedbackController`].
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
    /// corrections as controls have led nowhere, T is found by differences from there on. Where the plant admits neither side of a control, at the edge of its range, the T known so far stays.
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

/// The law as it stands during a run, and the means to learn.
pub(crate) struct Knowledge<'a> {
    pub(crate) law: FeedbackLaw,
    how: How<'a>,
    /// Measurements made to learn, beyond those of the steps.
    pub(crate) measurements: usize,
    /// Steps taken by each time that T was identified again or probed.
    pub(crate) identified_after: Vec<usize>,
    /// Steps taken so far.
    pub(crate) steps_taken: usize,
}

enum How<'a> {
    Global,
    Renewed {
        step_volt: &'a [f64],
        left: u32,
    },
    Local {
        step_volt: &'a [f64],
        /// None where T has to be found anew.
        known_at: Option<Vec<f64>>,
        tried: Vec<Tried>,
        corrections_left: usize,
        source: Source,
    },
    Adaptive {
        filter: Kalman,
        probes_left: u32,
        rejected_volt: Option<Vec<f64>>,
        /// Where the controls were probed last.
        probed_at: Option<Vec<f64>>,
        /// Times that the end may still be looked at.
        looks_left: u32,
    },
}

/// Where a local T comes from.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Source {
    /// The plant's linearised solution, if it has one.
    Offered,
    /// Differences, as that one led nowhere or there is none.
    Differences,
}

/// Times that an adaptive loop may look at T where it would end.
const LOOKS: u32 = 10;

/// Whether what T asks for at the end of a loop can be trusted.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Verified {
    /// It can.
    Yes,
    /// T has been looked at anew: ask again.
    Anew,
    /// Nothing is left to look with.
    Cannot,
}

/// A pair measured since T was last identified.
struct Tried {
    control_volt: Vec<f64>,
    hub_loads: Vec<f64>,
}

impl<'a> Knowledge<'a> {
    pub(crate) fn new(controller: &'a Controller, law: &FeedbackLaw, start: &ControlStep) -> Self {
        let how = match controller {
            Controller::Global => How::Global,
            Controller::Renewed { step_volt, renewals } => {
                How::Renewed { step_volt, left: *renewals }
            }
            Controller::Local { step_volt } => {
                // T0 is what would be found about zero control
                let controls = start.control_volt.len();
                How::Local {
                    step_volt,
                    known_at: Some(vec![0.0; controls]),
                    tried: Vec::new(),
                    corrections_left: controls,
                    source: Source::Offered,
                }
            }
            Controller::Adaptive(settings) => How::Adaptive {
                filter: Kalman::new(settings, law, start),
                probes_left: settings.probes,
                rejected_volt: None,
                probed_at: None,
                looks_left: LOOKS,
            },
        };
        Self {
            law: law.clone(),
            how,
            measurements: 0,
            identified_after: Vec::new(),
            steps_taken: 0,
        }
    }

    /// Brings T up to date before a step from a measured state.
    pub(crate) fn refresh<P: Plant>(
        &mut self,
        plant: &mut P,
        here: &ControlStep,
    ) -> Result<(), RunError<P::Error>> {
        match &mut self.how {
            How::Global | How::Renewed { .. } => {}
            How::Local { step_volt, known_at, tried, corrections_left, source } => {
                let control = &here.control_volt;
                if known_at.as_ref() != Some(control) {
                    tried.clear();
                    *corrections_left = control.len();
                    let offered = match source {
                        Source::Differences => None,
                        Source::Offered => {
                            plant.linearised_t(control).map_err(|source| RunError::Plant {
                                call: PlantCall::Linearise { control_volt: control.clone() },
                                history: Vec::new(),
                                source,
                            })?
                        }
                    };
                    *known_at = Some(control.clone());
                    let loads = &here.measurement.hub_loads;
                    let t = if let Some(t) = offered {
                        t
                    } else {
                        *source = Source::Differences;
                        match identify_t_about(plant, (control, loads), step_volt) {
                            Ok((t, measurements)) => {
                                self.measurements += measurements;
                                t
                            }
                            // at the edge of the range the T of the last control is the best there is
                            Err(RunError::Control(ControlError::NoRoomToIdentify { .. })) => {
                                return Ok(());
                            }
                            Err(error) => return Err(error),
                        }
                    };
                    self.law = self.law.with_t(&t)?;
                    self.identified_after.push(self.steps_taken);
                }
            }
            How::Adaptive { filter, .. } => self.law = self.law.with_t(&filter.t()?)?,
        }
        Ok(())
    }

    /// Whether T stays as it is from step to step.
    pub(crate) fn is_constant(&self) -> bool {
        matches!(self.how, How::Global | How::Renewed { .. })
    }

    /// Whether T is that of the present control, found anew at every step.
    pub(crate) fn is_local(&self) -> bool {
        matches!(self.how, How::Local { .. })
    }

    /// Identifies a constant T again about a state that it does not lead away from; false where it may not, or
    /// where the range leaves no room.
    pub(crate) fn renew<P: Plant>(
        &mut self,
        plant: &mut P,
        here: &ControlStep,
    ) -> Result<bool, RunError<P::Error>> {
        let How::Renewed { step_volt, left } = &mut self.how else { return Ok(false) };
        if *left == 0 {
            return Ok(false);
        }
        *left -= 1;
        let about = (here.control_volt.as_slice(), here.measurement.hub_loads.as_slice());
        match identify_t_about(plant, about, step_volt) {
            Ok((t, measurements)) => {
                self.measurements += measurements;
                self.identified_after.push(self.steps_taken);
                self.law = self.law.with_t(&t)?;
                Ok(true)
            }
            Err(RunError::Control(ControlError::NoRoomToIdentify { .. })) => Ok(false),
            Err(error) => Err(error),
        }
    }

    /// Takes note of a measured pair.
    pub(crate) fn observe(&mut self, control_volt: &[f64], hub_loads: &[f64]) {
        match &mut self.how {
            How::Global | How::Renewed { .. } => {}
            How::Local { tried, .. } => tried
                .push(Tried { control_volt: control_volt.to_vec(), hub_loads: hub_loads.to_vec() }),
            How::Adaptive { filter, .. } => filter.observe(control_volt, hub_loads),
        }
    }

    /// What the law aims at, seen from a state: the measured loads, or what the filter makes of them.
    pub(crate) fn target(
        &self,
        control_volt: &[f64],
        hub_loads: &[f64],
    ) -> Result<DVector<f64>, ControlError> {
        match &self.how {
            How::Adaptive { filter, .. } => {
                self.law.modal_target(control_volt, &filter.loads_at(control_volt))
            }
            _ => self.law.modal_target(control_volt, hub_loads),
        }
    }

    /// The fall of the cost that the law sees between a state and its aim.
    pub(crate) fn promise(
        &self,
        rho: f64,
        here: &ControlStep,
        aim_volt: &[f64],
    ) -> Result<f64, ControlError> {
        self.law.promise(rho, (&here.control_volt, &self.seen_loads(here)), aim_volt)
    }

    /// After a step that no part of which was taken: whether something was learnt that makes another
    /// step worth asking for. A local T is corrected along the step by the rejected measurements. Those
    /// may have changed an adaptive T already; if the step asked for is still much the same, each control
    /// is probed.
    pub(crate) fn learn<P: Plant>(
        &mut self,
        plant: &mut P,
        here: &ControlStep,
        aim_volt: &[f64],
    ) -> Result<bool, RunError<P::Error>> {
        let (probes_left, rejected_volt) = match &mut self.how {
            How::Global | How::Renewed { .. } => return Ok(false),
            How::Local { tried, corrections_left, source, known_at, .. } => {
                if *corrections_left == 0 {
                    // what is offered leads nowhere, corrected or not: from here on by differences
                    let offered = *source == Source::Offered;
                    (*source, *known_at) = (Source::Differences, None);
                    return Ok(offered);
                }
                *corrections_left -= 1;
                let corrected = corrected(&self.law.matrix(), here, aim_volt, tried);
                tried.clear();
                let Some(t) = corrected else { return Ok(false) };
                self.law = self.law.with_t(&t?)?;
                self.identified_after.push(self.steps_taken);
                return Ok(true);
            }
            How::Adaptive { probes_left, rejected_volt, .. } => (probes_left, rejected_volt),
        };
        if *probes_left == 0 {
            return Ok(false);
        }
        *probes_left -= 1;
        let away = |other: &[f64]| -> f64 {
            let pairs = aim_volt.iter().zip(other);
            pairs.map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt()
        };
        let again = rejected_volt
            .replace(aim_volt.to_vec())
            .is_some_and(|before| away(&before) < 0.5 * away(&here.control_volt));
        if !again {
            return Ok(true);
        }
        self.probe(plant, here, aim_volt)?;
        Ok(true)
    }

    /// Before a loop calls itself converged: whether its T is that of the present control. A filter that has
    /// followed a path knows T along it; each control is moved once where it ends.
    pub(crate) fn verify<P: Plant>(
        &mut self,
        plant: &mut P,
        here: &ControlStep,
        aim_volt: &[f64],
    ) -> Result<Verified, RunError<P::Error>> {
        let How::Adaptive { looks_left, probed_at, .. } = &mut self.how else {
            return Ok(Verified::Yes);
        };
        if probed_at.as_ref() == Some(&here.control_volt) {
            return Ok(Verified::Yes);
        }
        if *looks_left == 0 {
            return Ok(Verified::Cannot);
        }
        *looks_left -= 1;
        *probed_at = Some(here.control_volt.clone());
        self.probe(plant, here, aim_volt)?;
        Ok(Verified::Anew)
    }

    /// Moves every control once and lets the filter see what it does.
    fn probe<P: Plant>(
        &mut self,
        plant: &mut P,
        here: &ControlStep,
        aim_volt: &[f64],
    ) -> Result<(), RunError<P::Error>> {
        let How::Adaptive { filter, .. } = &mut self.how else { return Ok(()) };
        self.identified_after.push(self.steps_taken);
        let probe_volt = filter.probe_volt();
        for control in 0..aim_volt.len() {
            let mut moved = here.control_volt.clone();
            // toward the aim, where the knowledge is needed
            let side = if aim_volt[control] < moved[control] { -1.0 } else { 1.0 };
            moved[control] += side * probe_volt;
            if !plant.admits(&moved) {
                moved[control] -= 2.0 * side * probe_volt;
                if !plant.admits(&moved) {
                    continue;
                }
            }
            let measurement = plant.measure(&moved).map_err(|source| RunError::Plant {
                call: PlantCall::Measure { control_volt: moved.clone() },
                history: Vec::new(),
                source,
            })?;
            self.measurements += 1;
            filter.observe(&moved, &measurement.hub_loads);
        }
        // the last word is that of the state itself
        filter.observe(&here.control_volt, &here.measurement.hub_loads);
        Ok(())
    }

    /// The loads that the law aims from: those measured, or what the filter makes of them.
    pub(crate) fn seen_loads(&self, here: &ControlStep) -> Vec<f64> {
        match &self.how {
            How::Adaptive { filter, .. } => filter.loads_at(&here.control_volt),
            _ => here.measurement.hub_loads.clone(),
        }
    }

    /// The T matrix as known now.
    pub(crate) fn t(&self) -> Result<TMatrix, ControlError> {
        self.law.t()
    }
}

/// T with the derivative of the loads along a rejected step put right.
///
/// ```text
/// Z(u + a s) - Z(u) = a z_1 + a^2 z_2  by least squares over the parts a that were measured
/// T += (z_1 - T s) s' / (s' s)
/// ```
/// None where nothing was measured along the step.
///
/// Source: the rank-one form is Broyden's: *A class of methods for solving nonlinear simultaneous
/// equations*, Math. Comp. 19 (1965); the parabola instead of a chord is ours.
fn corrected(
    t: &DMatrix<f64>,
    here: &ControlStep,
    aim_volt: &[f64],
    tried: &[Tried],
) -> Option<Result<TMatrix, ControlError>> {
    let from = DVector::from_column_slice(&here.control_volt);
    let loads = DVector::from_column_slice(&here.measurement.hub_loads);
    let step = DVector::from_column_slice(aim_volt) - &from;
    let square = step.norm_squared();
    let (mut moments, mut sums) = ([0.0; 3], [loads.clone() * 0.0, loads.clone() * 0.0]);
    for pair in tried {
        let part = (DVector::from_column_slice(&pair.control_volt) - &from).dot(&step) / square;
        let change = DVector::from_column_slice(&pair.hub_loads) - &loads;
        for (k, moment) in moments.iter_mut().enumerate() {
            *moment += part.powi(2 + i32::try_from(k).unwrap_or(0));
        }
        sums[0].axpy(part, &change, 1.0);
        sums[1].axpy(part * part, &change, 1.0);
    }
    let [m2, m3, m4] = moments;
    let determinant = m2 * m4 - m3 * m3;
    let slope = if tried.len() > 1 && determinant > 1e-9 * m2 * m4 {
        (&sums[0] * m4 - &sums[1] * m3) / determinant
    } else if m2 > 0.0 {
        &sums[0] / m2
    } else {
        return None;
    };
    let corrected = t + (slope - t * &step) * step.transpose() / square;
    let columns: Vec<Vec<f64>> =
        corrected.column_iter().map(|c| c.iter().copied().collect()).collect();
    Some(TMatrix::from_columns(&columns))
}
