//! What is asked of a case and what is found, the same for blades and sections.

use model_gap::points::{PointFinding, PointTable};
use rotor_case::{Case, UncertainField};

/// What is asked of the simulation of a case.
pub struct CaseQuestion<'a> {
    /// The simulation.
    pub case: &'a Case,
    /// Inputs of the case that are not known well.
    pub uncertain: &'a [UncertainField],
    /// Causes to fit, nothing refused; all are looked for where there is none.
    pub only: &'a [String],
    /// Hears what is begun, and the percent of the work done by then.
    pub begun: &'a (dyn Fn(usize, &str) + Sync),
}

/// What was found of it.
#[derive(Debug, Clone)]
pub struct CaseDiagnosis {
    /// The points with what the simulation says of them.
    pub table: PointTable,
    /// What was found there.
    pub found: PointFinding,
    /// Names of the other levels of fidelity.
    pub alternatives: Vec<&'static str>,
    /// What uncertain inputs were moved by to explain the points, in words; none where they were not.
    pub moved: Option<String>,
    /// The case with what was found, if any of it is in a case.
    pub extended: Option<Case>,
}
