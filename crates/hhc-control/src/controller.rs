//! What a controller knows of T, and how it learns.

use crate::adaptive::Kalman;
use crate::{
    AdaptiveSettings, ControlError, ControlStep, FeedbackLaw, Plant, PlantCall, RunError, TMatrix,
    identify_t_about,
};
use nalgebra::DVector;

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
    /// T identified again about the present control before every step: from the plant's linearised
    /// solution if it has one, else by differences.
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
    /// Times T was identified again or probed.
    pub(crate) identifications: usize,
}

enum How<'a> {
    Global,
    Local { step_volt: &'a [f64], known_at: Vec<f64> },
    Adaptive { filter: Kalman, probes_left: u32, rejected_volt: Option<Vec<f64>> },
}

impl<'a> Knowledge<'a> {
    pub(crate) fn new(controller: &'a Controller, law: &FeedbackLaw, start: &ControlStep) -> Self {
        let how = match controller {
            Controller::Global => How::Global,
            Controller::Local { step_volt } => {
                // T0 is what would be found about zero control
                How::Local { step_volt, known_at: vec![0.0; start.control_volt.len()] }
            }
            Controller::Adaptive(settings) => How::Adaptive {
                filter: Kalman::new(settings, law, start),
                probes_left: settings.probes,
                rejected_volt: None,
            },
        };
        Self { law: law.clone(), how, measurements: 0, identifications: 0 }
    }

    /// Brings T up to date before a step from a measured state.
    pub(crate) fn refresh<P: Plant>(
        &mut self,
        plant: &mut P,
        here: &ControlStep,
    ) -> Result<(), RunError<P::Error>> {
        match &mut self.how {
            How::Global => {}
            How::Local { step_volt, known_at } => {
                let control = &here.control_volt;
                if known_at != control {
                    let offered =
                        plant.linearised_t(control).map_err(|source| RunError::Plant {
                            call: PlantCall::Linearise { control_volt: control.clone() },
                            history: Vec::new(),
                            source,
                        })?;
                    let t = if let Some(t) = offered {
                        t
                    } else {
                        let loads = &here.measurement.hub_loads;
                        let found = identify_t_about(plant, (control, loads), step_volt)?;
                        self.measurements += found.1;
                        found.0
                    };
                    self.law = self.law.with_t(&t)?;
                    self.identifications += 1;
                    known_at.clone_from(control);
                }
            }
            How::Adaptive { filter, .. } => self.law = self.law.with_t(&filter.t()?)?,
        }
        Ok(())
    }

    /// Takes note of a measured pair.
    pub(crate) fn observe(&mut self, control_volt: &[f64], hub_loads: &[f64]) {
        if let How::Adaptive { filter, .. } = &mut self.how {
            filter.observe(control_volt, hub_loads);
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
        let target = self.target(&here.control_volt, &here.measurement.hub_loads)?;
        let (hessian, linear) = self.law.quadratic(rho, &target);
        let twice = |u: &[f64]| -> f64 {
            let u = DVector::from_column_slice(u);
            u.dot(&(&hessian * &u)) + 2.0 * linear.dot(&u)
        };
        Ok(twice(&here.control_volt) - twice(aim_volt))
    }

    /// After a step that no part of which was taken: whether something was learnt that makes another
    /// step worth asking for. The rejected measurements may have changed T already; if the step asked
    /// for is still much the same, each control is probed.
    pub(crate) fn learn<P: Plant>(
        &mut self,
        plant: &mut P,
        here: &ControlStep,
        aim_volt: &[f64],
    ) -> Result<bool, RunError<P::Error>> {
        let How::Adaptive { filter, probes_left, rejected_volt } = &mut self.how else {
            return Ok(false);
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
        self.identifications += 1;
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
        Ok(true)
    }

    /// The T matrix as known now.
    pub(crate) fn t(&self) -> Result<TMatrix, ControlError> {
        self.law.t()
    }
}
