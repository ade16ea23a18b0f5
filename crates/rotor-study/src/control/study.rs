//! What a control run leaves behind.

use crate::plant::{PlantState, PowerOutputs};
use hhc_control::{ControlRun, StopReason, TMatrix, reduction_percent};
use rotor_base::HarmonicSeries;
use rotor_case::ControlActuator;

/// What the controller did with one set of harmonics and one actuator.
#[derive(Debug, Clone)]
pub struct ControlStudy {
    /// Harmonics per rev.
    pub harmonics: Vec<usize>,
    /// The actuator.
    pub actuator: ControlActuator,
    /// Voltages at the end, layout of the plant, V.
    pub control_volt: Vec<f64>,
    /// The recorded run; none where voltages were taken over from another actuator.
    pub run: Option<ControlRun>,
    /// The T matrix, load per V; of the run whose voltages are used.
    pub t: Option<TMatrix>,
    /// Control weight `W_u = rho I` of that run, 1/V^2.
    pub rho: f64,
    /// T about the control at the end, load per V; of a loop with a constant T and a control weight.
    pub t_at_end: Option<TMatrix>,
    /// Tolerance of the step of the loop, relative.
    pub step_tolerance: f64,
    /// Tolerance of the cost of the loop, over that at the start; 0 for the test of the step alone.
    pub cost_tolerance: f64,
    /// Motion asked of the inverse, flap by flap, deg; empty but for the inverse.
    pub wanted_deg: Vec<HarmonicSeries>,
    /// Its size over that of the ideal motion: below 1 where the range of voltages ends first.
    pub motion_share: Option<f64>,
    /// Part of the motion that the identified actuator makes within its range of voltages; of the ideal one.
    pub reach_share: Option<f64>,
    /// Part of the voltages that were taken over: below 1 where they leave no room for the bias.
    pub voltage_share: Option<f64>,
    /// Stroke limit of each controlled harmonic, deg.
    pub stroke_limit_deg: Vec<f64>,
    /// Flap motion at each harmonic for a cosine of the voltage of its stroke limit, `[cosine, sine]`, deg.
    pub at_stroke_deg: Vec<[f64; 2]>,
    /// Weight of each load in `J_Z`, order `FX FY FZ MX MY MZ`.
    pub load_weights: [f64; 6],
    /// `J_Z` without control.
    pub j_before: f64,
    /// `J_Z` with control.
    pub j_after: f64,
    /// The weighted power among the outputs.
    pub power: PowerOutputs,
    /// Rotor and flaps at the end.
    pub state: PlantState,
    /// Force (moment) the moving flaps leave unbalanced at the trimmed controls, over the weight.
    pub trim_imbalance: f64,
}

impl ControlStudy {
    /// `100 (1 - J_Z / J_Z0)`.
    pub fn reduction_percent(&self) -> f64 {
        reduction_percent(self.j_before, self.j_after)
    }

    /// Control steps measured.
    pub fn steps(&self) -> usize {
        self.run.as_ref().map_or(0, |run| run.steps.len())
    }

    /// Steps that were halved because they raised the cost.
    pub fn backtracks(&self) -> u32 {
        self.run.as_ref().map_or(0, |run| run.backtracks)
    }

    /// Frobenius norm of the T matrix, load per V; 0 without one.
    pub fn t_norm(&self) -> f64 {
        self.t.as_ref().map_or(0.0, TMatrix::frobenius_norm)
    }

    /// How the loop ended; converged where voltages were taken over.
    pub fn outcome(&self) -> Option<StopReason> {
        self.run.as_ref().map(|run| run.stop)
    }
}
