//! The blades and beams of the references of moderate deflection, in rotor units.

use std::f64::consts::{PI, TAU};

use rotor_fem::{BladeSpec, Distribution, ModerateSpec, RootSupport};
use validation::{Failure, Table, TableRow};

/// Length of the Princeton beam.
pub(crate) const PRINCETON_LENGTH_M: f64 = 0.508;

/// The Princeton beam at rest; length in 0.508 m, force in newton. Torsional stiffness as in the
/// reference: 0.198 of the shear modulus times the polar moment of area.
pub(crate) fn princeton_beam() -> ModerateSpec {
    let (height, width) = (12.3777e-3_f64, 3.2024e-3_f64);
    let (young, poisson) = (71.7e9, 0.31);
    let square = PRINCETON_LENGTH_M.powi(2);
    let soft = young * height * width.powi(3) / 12.0 / square;
    let stiff = young * width * height.powi(3) / 12.0 / square;
    let torsion = 0.198 * (soft + stiff) / (2.0 * (1.0 + poisson));
    let axial = young * height * width;
    BladeSpec { rotor_speed: 0.0, ..BladeSpec::uniform(soft, stiff, torsion, axial) }.into()
}

/// A property of a section from its row.
type Value<'a> = &'a dyn Fn(TableRow<'_>) -> Result<f64, Failure>;

/// Rotor speed that the units of [`tm_4760_blade`] refer to, rpm.
pub(crate) const TM_4760_RPM: f64 = 660.0;

/// The hinged nonuniform model blade of NASA TM 4760.
///
/// Polar inertia is taken about the mass centre and divided between chord and thickness as the moments
/// of area are; the area radius follows from them.
pub(crate) fn tm_4760_blade() -> Result<ModerateSpec, Failure> {
    let (radius, gravity, young) = (55.0, 386.088, 1.0e7);
    let shear = young / 2.6;
    let table = Table::read("rotor/tm4760_blade_structure.csv")?;
    let omega = TM_4760_RPM * TAU / 60.0;
    let force = 0.04 / gravity * (omega * radius).powi(2);
    let mut edges = Vec::new();
    for row in table.rows() {
        edges.push(row.number("r_in")? / radius);
    }
    edges.push(1.0);
    let steps = |value: Value<'_>| -> Result<Distribution, Failure> {
        let values = table.rows().map(value).collect::<Result<_, _>>()?;
        Ok(Distribution::PiecewiseConstant { edges: edges.clone(), values })
    };
    let stiffness = |modulus: f64, column: &str| {
        steps(&|row| Ok(modulus * row.number(column)? / (force * radius * radius)))
    };
    let areas = |row: TableRow<'_>| -> Result<[f64; 2], Failure> {
        Ok([row.number("I_flap_in4")?, row.number("I_chord_in4")?])
    };
    // squares of the radii of gyration about the mass centre
    let radii = |row: TableRow<'_>| -> Result<[f64; 2], Failure> {
        let polar = row.number("Ipolar_lb_in2_per_in")? / row.number("m_lb_per_in")?;
        let [flap, chord] = areas(row)?;
        Ok([flap, chord].map(|part| polar * part / (flap + chord) / (radius * radius)))
    };
    let offset = |row: TableRow<'_>| Ok(row.number("cm_offset_fwd_in")? / radius);
    let blade = BladeSpec {
        flap_stiffness: stiffness(young, "I_flap_in4")?,
        lag_stiffness: stiffness(young, "I_chord_in4")?,
        torsion_stiffness: stiffness(shear, "J_tors_in4")?,
        axial_stiffness: steps(&|row| Ok(young * row.number("A_in2")? / force))?,
        mass: steps(&|row| Ok(row.number("m_lb_per_in")? / 0.04))?,
        thickness_gyration_radius: steps(&|row| Ok(radii(row)?[0].sqrt()))?,
        chord_gyration_radius: steps(&|row| {
            let from_axis: Result<f64, Failure> = offset(row);
            Ok((radii(row)?[1] + from_axis?.powi(2)).sqrt())
        })?,
        area_gyration_radius: steps(&|row| {
            let [flap, chord] = areas(row)?;
            Ok(((flap + chord) / row.number("A_in2")?).sqrt() / radius)
        })?,
        root_offset: 3.0 / radius,
        root: RootSupport::HINGED,
        ..BladeSpec::uniform(1.0, 1.0, 1.0, 1.0)
    };
    Ok(ModerateSpec { mass_centre: steps(&offset)?, ..blade.into() })
}

/// Rotor speed that the units of [`epps_chandra_strip`] refer to, rpm.
pub(crate) const EPPS_CHANDRA_RPM: f64 = 750.0;

/// The straight strip of Epps and Chandra, clamped 2.5 in from the axis, flat in the plane of rotation.
pub(crate) fn epps_chandra_strip() -> ModerateSpec {
    let (radius, width, thickness) = (40.0_f64, 1.0, 0.063_f64);
    let (young, poisson, density) = (1.06e7, 0.325, 2.51e-4);
    let omega = EPPS_CHANDRA_RPM * TAU / 60.0;
    let force = density * width * thickness * (omega * radius).powi(2);
    let unit = force * radius * radius;
    let soft = young * width * thickness.powi(3) / 12.0 / unit;
    let stiff = young * thickness * width.powi(3) / 12.0 / unit;
    let shear = young / (2.0 * (1.0 + poisson));
    // Saint-Venant, the first term of the series for a narrow rectangle
    let narrow = 1.0 - 192.0 * thickness / (PI.powi(5) * width);
    let torsion = shear * width * thickness.powi(3) / 3.0 * narrow / unit;
    let gyration = |length: f64| length / 12.0_f64.sqrt() / radius;
    BladeSpec {
        thickness_gyration_radius: gyration(thickness).into(),
        chord_gyration_radius: gyration(width).into(),
        area_gyration_radius: gyration(width.hypot(thickness)).into(),
        root_offset: 2.5 / radius,
        ..BladeSpec::uniform(soft, stiff, torsion, young * width * thickness / force)
    }
    .into()
}
