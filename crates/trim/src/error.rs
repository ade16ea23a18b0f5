//! The errors of this crate.

/// The last few residuals, for a message.
fn show(history: &[f64]) -> String {
    let tail = &history[history.len().saturating_sub(6)..];
    let shown: Vec<String> = tail.iter().map(|r| format!("{r:.1e}")).collect();
    shown.join(" ")
}

/// Why a rotor could not be trimmed.
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum TrimError {
    /// A parameter is out of its range.
    #[error("{field} is {value}, expected {expected}")]
    Parameter {
        /// Name of the parameter, unit included.
        field: &'static str,
        /// The value found.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// A trim variable left the range in which the model means anything.
    #[error(
        "trim is out of reach: {variable} went to {value_deg:.2} deg (limit {limit_deg} deg) in iteration {iteration} at residual {residual:.3e}; residuals so far {}. Remedy: lower the thrust, the drag area or the advance ratio",
        show(.history)
    )]
    OutOfReach {
        /// Name of the variable.
        variable: &'static str,
        /// Its value, degrees.
        value_deg: f64,
        /// Its limit, degrees.
        limit_deg: f64,
        /// Newton iteration.
        iteration: usize,
        /// Residual before the step, relative to the weight.
        residual: f64,
        /// Residuals of all iterations.
        history: Vec<f64>,
    },
    /// No change of the trim variables lowers the residual any more.
    #[error(
        "trim is out of reach: near theta0 {theta0_deg:.2} deg no change of the controls brings the residual below {residual:.2e} of the weight (iteration {iteration}); residuals so far {}. Remedy: lower the thrust, the drag area or the advance ratio; with aerofoil tables or dynamic stall the sections may have stalled there",
        show(.history)
    )]
    NoDescent {
        /// Newton iteration.
        iteration: usize,
        /// Residual there, relative to the weight.
        residual: f64,
        /// Residuals of all iterations.
        history: Vec<f64>,
        /// Collective there, degrees.
        theta0_deg: f64,
    },
    /// Newton's method did not converge.
    #[error(
        "trim stopped after {iterations} iterations at residual {residual:.3e} of the weight (wanted {tolerance:.1e}); residuals {}, last theta0 {theta0_deg:.3} deg. Remedy: start from a nearby trimmed case or relax the tolerance",
        show(.history)
    )]
    NotConverged {
        /// Iterations spent.
        iterations: usize,
        /// Last residual, relative to the weight.
        residual: f64,
        /// Residual wanted.
        tolerance: f64,
        /// Residuals of all iterations.
        history: Vec<f64>,
        /// Collective of the last iterate, degrees.
        theta0_deg: f64,
    },
    /// The trim variables do not control the trim equations.
    #[error(
        "trim Jacobian is singular in iteration {iteration} (residual {residual:.3e}): the variables do not control the loads at this condition"
    )]
    Singular {
        /// Newton iteration.
        iteration: usize,
        /// Residual there.
        residual: f64,
    },
    /// The rotor could not be solved.
    #[error("rotor response inside the trim: {0}")]
    Response(#[from] rotor_response::ResponseError),
}
