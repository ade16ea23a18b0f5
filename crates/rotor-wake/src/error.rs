//! Errors of the inflow models.

/// What can be wrong with a question to an inflow model, or with its answer.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum WakeError {
    /// An input lies outside what it can mean.
    #[error("{quantity} is {value}: expected {expected}; correct the flight state or the loading")]
    BadInput {
        /// Name of the quantity.
        quantity: &'static str,
        /// The value found.
        value: f64,
        /// What it should have been.
        expected: &'static str,
    },
    /// A list of inflow parameters has the wrong length.
    #[error(
        "this inflow is made of {expected} numbers, got {got}; pass what `parameters` returned"
    )]
    ParameterCount {
        /// Numbers this kind of inflow is made of.
        expected: usize,
        /// Numbers given.
        got: usize,
    },
    /// The rotor descends into its own wake, where momentum theory has no answer.
    #[error(
        "vortex-ring state: advance ratio {advance_ratio}, normal inflow {normal_inflow}, C_T \
         {thrust_coefficient} give a wake transport speed of {transport_ratio:.3} of the hover \
         induced velocity (momentum theory asks for {limit} or more in descent); fly faster, \
         descend more slowly, or prescribe the inflow"
    )]
    VortexRingState {
        /// Advance ratio `mu`.
        advance_ratio: f64,
        /// Free stream normal to the disk, `mu tan(alpha_s)`; negative in descent.
        normal_inflow: f64,
        /// Thrust coefficient.
        thrust_coefficient: f64,
        /// Wake transport speed over the hover induced velocity.
        transport_ratio: f64,
        /// Smallest ratio accepted in descent.
        limit: f64,
    },
    /// The wake leaves the disk upward and forward, where a model has no answer.
    #[error(
        "the wake skew angle is {skew_deg:.1} deg, the {model} inflow is defined up to {limit_deg} \
         deg; use uniform inflow in this windmill-brake descent"
    )]
    WakeAboveDisk {
        /// Name of the model.
        model: &'static str,
        /// Wake skew angle, deg.
        skew_deg: f64,
        /// Largest angle accepted, deg.
        limit_deg: f64,
    },
    /// The momentum equation was not solved to its tolerance.
    #[error(
        "momentum inflow not converged after {iterations} iterations: residual {residual:e} at \
         lambda_i = {last_inflow}; check that the thrust coefficient is of a rotor's size"
    )]
    NotConverged {
        /// Iterations done.
        iterations: usize,
        /// Residual of the momentum equation at the last iterate.
        residual: f64,
        /// The last iterate of the induced inflow.
        last_inflow: f64,
    },
    /// A node of the free wake is no number any more.
    #[error(
        "the free wake was lost: RMS displacement {displacement} R in one step; the geometry before it \
         is kept; use a finer azimuth step or a larger core"
    )]
    WakeLost {
        /// RMS displacement of the step, unit `R`.
        displacement: f64,
    },
    /// The sweeps of the free wake run away from each other.
    #[error(
        "the free wake diverges: RMS displacement {displacement:.3e} R in sweep {iteration}, at best \
         {least:.3e} R; the best geometry is kept; use more relaxation, a larger core or a march in time"
    )]
    WakeDiverged {
        /// Sweep that was given up.
        iteration: usize,
        /// Its RMS displacement, unit `R`.
        displacement: f64,
        /// Smallest RMS displacement met, unit `R`.
        least: f64,
    },
    /// Inflow and circulation drive each other beyond what a rotor's wake induces.
    #[error(
        "wake and blades run away from each other: the inflow changes by {change:.2} of the tip speed in update {update} (at \
         most {largest} is of a rotor's size); vortices meet the blades: use a larger core or fewer rolled-up vortices"
    )]
    InflowRunsAway {
        /// Update of the coupling.
        update: usize,
        /// Largest change of the inflow, tip speed.
        change: f64,
        /// The largest that is accepted.
        largest: f64,
    },
    /// The sweeps of the free wake do not settle.
    #[error(
        "the free wake has not settled after {iterations} sweeps: RMS displacement {displacement:.3e} R, \
         asked {tolerance:.1e} R; the best geometry is kept; allow more sweeps or march in time"
    )]
    WakeNotSettled {
        /// Sweeps done.
        iterations: usize,
        /// Smallest RMS displacement met, unit `R`.
        displacement: f64,
        /// Displacement asked for, unit `R`.
        tolerance: f64,
    },
    /// The circulation of the blades and the inflow of the wake do not agree.
    #[error(
        "circulation and inflow do not agree after {iterations} iterations: largest change {change:.3e} of \
         the tip speed, asked {tolerance:.1e}"
    )]
    CirculationNotConverged {
        /// Iterations done.
        iterations: usize,
        /// Largest change of the inflow in the last one, tip speed.
        change: f64,
        /// Change asked for, tip speed.
        tolerance: f64,
    },
}
