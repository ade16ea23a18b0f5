//! Blades of the reference tables, and the tables.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use std::f64::consts::TAU;
use std::path::Path;

use rotor_fem::{BladeSpec, Distribution, ModerateSpec, RootSupport};

/// Rows of a reference table without its head.
pub(crate) fn table(name: &str) -> Vec<Vec<String>> {
    let path =
        Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/reference/rotor").join(name);
    let mut reader =
        csv::ReaderBuilder::new().flexible(true).comment(Some(b'#')).from_path(path).unwrap();
    reader.records().map(|row| row.unwrap().iter().map(String::from).collect()).collect()
}

/// A number of a row.
pub(crate) fn number(row: &[String], column: usize) -> f64 {
    row[column].trim().parse().unwrap()
}

/// Length of the Princeton beam.
pub(crate) const PRINCETON_LENGTH_M: f64 = 0.508;

/// The Princeton beam at rest; length in 0.508 m, force in newton.
pub(crate) fn princeton_blade() -> ModerateSpec {
    let (height, width) = (12.3777e-3_f64, 3.2024e-3_f64);
    let (young, poisson) = (71.7e9, 0.31);
    let shear = young / (2.0 * (1.0 + poisson));
    let square = PRINCETON_LENGTH_M.powi(2);
    let soft = young * height * width.powi(3) / 12.0 / square;
    let stiff = young * width * height.powi(3) / 12.0 / square;
    // the torsional stiffness of the reference: 0.198 of the polar moment of area
    let polar = height * width * (height * height + width * width) / 12.0;
    let torsion = 0.198 * shear * polar / square;
    let axial = young * height * width;
    BladeSpec { rotor_speed: 0.0, ..BladeSpec::uniform(soft, stiff, torsion, axial) }.into()
}

/// Rotor speed that the units of [`tm_4760_blade`] refer to, rpm.
pub(crate) const TM_4760_RPM: f64 = 660.0;

/// The hinged nonuniform model blade of NASA TM 4760.
///
/// Polar inertia is about the mass centre and divided between chord and thickness as the moments of
/// area are; the area radius follows from them.
pub(crate) fn tm_4760_blade() -> ModerateSpec {
    let (radius, gravity, young) = (55.0, 386.088, 1.0e7);
    let shear = young / 2.6;
    let rows = table("tm4760_blade_structure.csv");
    let edges: Vec<f64> = rows.iter().map(|row| number(row, 0) / radius).chain([1.0]).collect();
    let mass_unit = 0.04 / gravity;
    let omega = TM_4760_RPM * TAU / 60.0;
    let force = mass_unit * omega * omega * radius * radius;
    let column = |value: &dyn Fn(&[String]) -> f64| Distribution::PiecewiseConstant {
        edges: edges.clone(),
        values: rows.iter().map(|row| value(row)).collect(),
    };
    let stiffness = |modulus: f64, k: usize| {
        column(&|row| modulus * number(row, k) / (force * radius * radius))
    };
    let share = |row: &[String], k: usize| number(row, k) / (number(row, 2) + number(row, 3));
    let polar = |row: &[String]| number(row, 6) / number(row, 5) / (radius * radius);
    let blade = BladeSpec {
        flap_stiffness: stiffness(young, 3),
        lag_stiffness: stiffness(young, 2),
        torsion_stiffness: stiffness(shear, 4),
        axial_stiffness: column(&|row| young * number(row, 1) / force),
        mass: column(&|row| number(row, 5) / 0.04),
        thickness_gyration_radius: column(&|row| (polar(row) * share(row, 3)).sqrt()),
        chord_gyration_radius: column(&|row| {
            (polar(row) * share(row, 2) + (number(row, 7) / radius).powi(2)).sqrt()
        }),
        area_gyration_radius: column(&|row| {
            ((number(row, 2) + number(row, 3)) / number(row, 1)).sqrt() / radius
        }),
        root_offset: 3.0 / radius,
        root: RootSupport::HINGED,
        ..BladeSpec::uniform(1.0, 1.0, 1.0, 1.0)
    };
    ModerateSpec { mass_centre: column(&|row| number(row, 7) / radius), ..blade.into() }
}
