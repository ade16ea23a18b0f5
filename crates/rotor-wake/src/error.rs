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
}

/// Refuses an input that does not fit.
pub(crate) fn ensure(
    fits: bool,
    quantity: &'static str,
    value: f64,
    expected: &'static str,
) -> Result<(), WakeError> {
    if fits { Ok(()) } else { Err(WakeError::BadInput { quantity, value, expected }) }
}

/// Refuses the first of some numbers that is not finite.
pub(crate) fn ensure_finite(quantity: &'static str, values: &[f64]) -> Result<(), WakeError> {
    let bad = values.iter().find(|v| !v.is_finite());
    bad.map_or(Ok(()), |&value| ensure(false, quantity, value, "a finite number"))
}
