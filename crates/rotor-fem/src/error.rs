//! What can go wrong in building and solving the blade and its orbit.

use crate::{ModeKind, StaticState};

/// Failures of the blade finite elements.
///
/// Solver failures of the periodic orbit carry the caller's own error and live in
/// [`PeriodicError`](crate::PeriodicError).
#[derive(Debug, Clone, PartialEq, thiserror::Error)]
#[non_exhaustive]
pub enum FemError {
    /// A blade property has a forbidden value.
    #[error(
        "blade property {field} is {value} at station {station} (r/R): expected {expected}; correct \
         the value of {field} at that station"
    )]
    Property {
        /// Name of the field.
        field: &'static str,
        /// Radial station r/R of the value.
        station: f64,
        /// The value found, in rotor units.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// A number that describes the whole blade, a mesh or a solver is out of range.
    #[error("{field} is {value}: expected {expected}")]
    Parameter {
        /// Name of the field.
        field: &'static str,
        /// The value found; of a blade in rotor units or rad.
        value: f64,
        /// What was expected.
        expected: &'static str,
    },
    /// The stations of a table do not grow.
    #[error(
        "stations of {field} do not grow: station {index} is at {station} (r/R) after {previous}; \
         sort the table and remove repeated stations"
    )]
    StationOrder {
        /// Name of the table's field.
        field: &'static str,
        /// Index of the offending station, from 0.
        index: usize,
        /// Its position r/R.
        station: f64,
        /// The position before it.
        previous: f64,
    },
    /// A table does not cover the blade.
    #[error(
        "table of {field} covers {from} to {to} (r/R) and the blade reaches from {root} to 1: extend \
         the table to both ends"
    )]
    TableGap {
        /// Name of the table's field.
        field: &'static str,
        /// First station r/R.
        from: f64,
        /// Last station r/R.
        to: f64,
        /// Blade root r/R.
        root: f64,
    },
    /// Stations and values of a table do not match in number.
    #[error(
        "table of {field} has {stations} stations and {values} values: expected {expected} values"
    )]
    TableLength {
        /// Name of the table's field.
        field: &'static str,
        /// Number of stations.
        stations: usize,
        /// Number of values.
        values: usize,
        /// Number of values expected.
        expected: usize,
    },
    /// A station lies off the blade.
    #[error("station {station} (r/R) lies outside the rotor radius: expected 0 to 1")]
    Station {
        /// The station r/R.
        station: f64,
    },
    /// More modes asked for than the mesh has.
    #[error("{wanted} {kind} modes asked for, {available} found: use more blade elements")]
    TooFewModes {
        /// Kind of mode.
        kind: ModeKind,
        /// Number asked for.
        wanted: usize,
        /// Number found.
        available: usize,
    },
    /// The blade diverges statically: a stiffness eigenvalue is not positive.
    #[error(
        "the rotating blade is not statically stable: its lowest squared frequency is \
         {squared_frequency:e} (nominal rotor speed squared); check the precone of a hinged \
         blade, k_m1 against k_m2, and the stiffnesses"
    )]
    NotStable {
        /// Lowest squared frequency in units of the nominal rotor speed squared.
        squared_frequency: f64,
    },
    /// The static deflection was not found.
    #[error(
        "no static deflection beyond {load_factor} of the load after {iterations} Newton steps: force out \
         of balance {residual:e} of the largest, allowed {tolerance:e}; look for a hinge without \
         spring on a blade at rest, a load beyond moderate deflection, or a blade that diverges"
    )]
    NoStaticState {
        /// Newton steps done.
        iterations: usize,
        /// Force out of balance over the largest force, at the last try.
        residual: f64,
        /// Largest allowed.
        tolerance: f64,
        /// Part of load and squared rotor speed that could be carried.
        load_factor: f64,
        /// The state at that part.
        last: Box<StaticState>,
    },
    /// A vector is not over the blade's degrees of freedom.
    #[error(
        "{field} has {found} entries, the blade {expected} degrees of freedom: build it with the same model"
    )]
    DofCount {
        /// Name of the argument.
        field: &'static str,
        /// Number of entries.
        found: usize,
        /// Number of degrees of freedom.
        expected: usize,
    },
    /// Shapes and stations of a modal blade do not match in number.
    #[error("mode {mode} has {found} section shapes, the blade {expected} stations")]
    ShapeCount {
        /// Index of the mode, from 0.
        mode: usize,
        /// Number of shapes.
        found: usize,
        /// Number of stations.
        expected: usize,
    },
    /// The tangents of a periodic system do not fit its mesh.
    #[error(
        "tangents of the revolution: {what} at point {point} is {found}, expected {expected}; take them \
         at every Gauss point of the same time elements"
    )]
    Tangents {
        /// What was counted.
        what: &'static str,
        /// Index of the Gauss point, from 0.
        point: usize,
        /// Number found.
        found: usize,
        /// Number expected.
        expected: usize,
    },
    /// The mass matrix with apparent mass cannot be inverted.
    #[error(
        "the mass matrix with the apparent mass of the air is singular at azimuth {azimuth_rad} rad: \
         check the mass distribution and the Lock number"
    )]
    MassSingular {
        /// Azimuth, rad.
        azimuth_rad: f64,
    },
    /// An eigenvalue solution did not converge.
    #[error(
        "the eigenvalue solution of size {size} did not converge: check the blade's properties"
    )]
    Eigen {
        /// Order of the eigenproblem.
        size: usize,
    },
}

/// Refuses the first parameter that is not good; each with its value, whether it is good, and what was expected.
pub(crate) fn check_parameters<const N: usize>(
    parameters: [(&'static str, f64, bool, &'static str); N],
) -> Result<(), FemError> {
    match parameters.into_iter().find(|(_, _, good, _)| !good) {
        Some((field, value, _, expected)) => Err(FemError::Parameter { field, value, expected }),
        None => Ok(()),
    }
}
