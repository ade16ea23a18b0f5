//! The errors of this crate.

use rotor_response::ResponseError;
use rotor_wake::WakeError;

/// All residuals, for a message: a search has few, and where it got stuck is seen from its beginning.
fn show(history: &[f64]) -> String {
    history.iter().map(|r| format!("{r:.1e}")).collect::<Vec<_>>().join(" ")
}

/// The most thrust of a search, for a message.
fn most(reached: f64, theta0_deg: f64) -> String {
    if reached > 0.0 {
        format!(
            "the most that was met on the way, trimmed or not, is {reached:.4} at theta0 {theta0_deg:.2} deg"
        )
    } else {
        "and not one periodic response was found on the way".to_owned()
    }
}

/// Residuals of a search, or of the response where the search did not come to one.
fn show_or(history: &[f64], cause: &TrimError) -> String {
    if history.is_empty() { format!("none: {cause}") } else { show(history) }
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
    /// The sections stall before they give the thrust asked for.
    #[error(
        "the sections stall: C_T/sigma {wanted:.4} is asked for, {}; residuals so far {}. Remedy: lower the thrust, the drag area or the advance ratio",
        most(*.reached, *.theta0_deg),
        show_or(.history, .cause)
    )]
    Stalled {
        /// Thrust asked for, `C_T / sigma`.
        wanted: f64,
        /// Largest thrust of the search; 0 if not one response was found.
        reached: f64,
        /// Collective there, degrees.
        theta0_deg: f64,
        /// Residuals of all iterations, relative to the weight.
        history: Vec<f64>,
        /// How the search ended.
        #[source]
        cause: Box<Self>,
    },
    /// The sections stall at the controls that are given.
    #[error("the sections stall at the controls given, theta0 {theta0_deg:.2} deg: {cause}")]
    StalledControls {
        /// Collective given, degrees.
        theta0_deg: f64,
        /// How the response ended, its residual history included.
        #[source]
        cause: Box<ResponseError>,
    },
    /// Sections that never stall give a thrust that no aerofoil gives.
    #[error(
        "C_T/sigma {wanted:.4} asks a mean lift coefficient of {lift_coefficient:.2} of the sections, which stall near {largest}: what was found with attached flow (residuals {}) is no flight. Remedy: lower the thrust (with prescribed controls the collective), or give aerofoil tables, which stall",
        show(.history)
    )]
    BeyondStall {
        /// Thrust asked for, or reached with prescribed controls, `C_T / sigma`.
        wanted: f64,
        /// Mean lift coefficient it takes.
        lift_coefficient: f64,
        /// The largest of an aerofoil.
        largest: f64,
        /// Residuals of all iterations, relative to the weight.
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
    Response(#[from] ResponseError),
}

impl From<WakeError> for TrimError {
    fn from(error: WakeError) -> Self {
        Self::Response(error.into())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A search that fails at its first response has no residual of its own: it tells that of the response.
    #[test]
    fn a_stall_at_the_first_response_shows_its_residuals() {
        let cause = Box::new(TrimError::Response(ResponseError::InflowNotConverged {
            iterations: 60,
            change: 2.5e-3,
            tolerance: 1e-10,
            thrust_coefficient: 0.011,
        }));
        let stalled = |history: Vec<f64>| {
            let (wanted, reached, theta0_deg) = (0.13, 0.0, 14.0);
            let cause = cause.clone();
            TrimError::Stalled { wanted, reached, theta0_deg, history, cause }.to_string()
        };
        let text = stalled(vec![]);
        assert!(text.contains("residuals so far none: rotor response"), "{text}");
        assert!(text.contains("change 2.500e-3") && text.contains("not one periodic"), "{text}");
        assert!(stalled(vec![0.1, 0.02]).contains("residuals so far 1.0e-1 2.0e-2. Remedy"));
    }
}
