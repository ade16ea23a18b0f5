//! Rotating frequencies of the blade.

use rotor_fem::{
    BladeModel, BladeProperties, BladeSpec, GyroscopicTerms, ModalBasis, ModeCount, ModeKind,
    RootSupport, modes, uncoupled_modes,
};
use validation::{Check, Failure, Table, row, too_few, worst};

pub(crate) const ROWS: &[Check] = &[
    row("V-FEM-01", "Table 1 blade, 4 flap and 4 lag frequencies, 10 elements: largest error", "%")
        .against("60-digit power series, bo105_uniform_frequencies.csv")
        .at_most(0.1, || table_1_error(10)),
    row("V-FEM-02", "the same with 20 elements", "%")
        .against("60-digit power series, bo105_uniform_frequencies.csv")
        .at_most(0.006, || table_1_error(20)),
    row("V-FEM-03", "error with 20 over error with 40 elements, the mode farthest from 16", "-")
        .against("order of the element, h^4")
        .between(15.0, 17.0, table_1_order),
    row("V-FEM-04", "Table 1 blade, first torsion frequency, 10 elements", "per rev")
        .against("independent finite elements, 40 of them; k_m1 .0132, k_m2 .0247, k_A .029")
        .near(4.588_073, 4.6e-5, first_torsion),
    row(
        "V-FEM-05",
        "clamped rotating beams, 2 offsets, 15 speeds, 5 modes, 20 elements: \
         largest error",
        "%",
    )
    .against("exact series, rotating_beam_exact.csv")
    .at_most(0.05, || rotating_beams("clamped", RootSupport::CLAMPED)),
    row(
        "V-FEM-06",
        "hinged rotating beams, 2 offsets, 15 speeds, 5 modes, 20 elements: largest \
         error",
        "%",
    )
    .against("exact series, rotating_beam_exact.csv")
    .at_most(0.05, || rotating_beams("hinged", RootSupport::HINGED)),
    row(
        "V-FEM-07",
        "first lag frequency with lag-axial Coriolis coupling, slenderness 70, 5 \
         speeds: largest error",
        "%",
    )
    .against("Hamza Cherif and Houmat, as kept in mboct-fem-pkg fem_tests_060.tst")
    .at_most(0.1, || lag_axial(GyroscopicTerms::Included)),
    row("V-FEM-08", "the same without gyroscopic terms: what the bound must see", "%")
        .against("Hamza Cherif and Houmat, as kept in mboct-fem-pkg fem_tests_060.tst")
        .at_least(1.0, || lag_axial(GyroscopicTerms::Neglected)),
];

/// The blade of the paper's Table 1, practically inextensible.
fn table_1_blade() -> Result<BladeProperties, Failure> {
    Ok(BladeProperties::new(BladeSpec::uniform(0.0108, 0.0268, 0.006_15, 1e6))?)
}

/// Relative errors of the eight bending frequencies, coupled modes without gyroscopic terms.
fn table_1_errors(elements: usize) -> Result<Vec<f64>, Failure> {
    let table = Table::read("rotor/bo105_uniform_frequencies.csv")?;
    let count = ModeCount { flap: 4, lag: 4, torsion: 0, axial: 0 };
    let model = BladeModel::new(table_1_blade()?, elements)?;
    let found = modes(&model, GyroscopicTerms::Neglected, count)?;
    let mut errors = Vec::new();
    for mode in &found {
        let family = mode.kind.to_string();
        let row = table.row(["family", "method"], [&family, "exact"])?;
        let column =
            if mode.number == 1 { "w1_per_rev".into() } else { format!("w{}", mode.number) };
        let exact = row.number(&column)?;
        errors.push((mode.per_rev - exact).abs() / exact);
    }
    Ok(errors)
}

fn table_1_error(elements: usize) -> Result<f64, Failure> {
    let errors = table_1_errors(elements)?;
    worst("frequencies", 8, errors.into_iter().map(|error| Ok(100.0 * error)))
}

fn table_1_order() -> Result<f64, Failure> {
    let (coarse, fine) = (table_1_errors(20)?, table_1_errors(40)?);
    let ratios = coarse.iter().zip(&fine).map(|(c, f)| c / f);
    let farthest = ratios.max_by(|a, b| (a - 16.0).abs().total_cmp(&(b - 16.0).abs()));
    farthest.ok_or(too_few("frequencies", 0, 8))
}

fn first_torsion() -> Result<f64, Failure> {
    let count = ModeCount { flap: 0, lag: 0, torsion: 1, axial: 0 };
    let set = uncoupled_modes(&table_1_blade()?, 10, count, ModalBasis::Natural)?;
    let first = set.of(ModeKind::Torsion).first().map(|mode| mode.per_rev);
    first.ok_or(too_few("torsion modes", 0, 1))
}

/// Largest error over the rows of one root condition, %. The table's unit of length is the length L of
/// the beam, the crate's the tip radius R = L + e.
fn rotating_beams(name: &str, root: RootSupport) -> Result<f64, Failure> {
    let table = Table::read("rotor/rotating_beam_exact.csv")?;
    let mut errors = Vec::new();
    for row in table.rows() {
        if row.text("root_bc")? != name {
            continue;
        }
        let (offset, eta) = (row.number("offset_e_over_L")?, row.number("eta")?);
        let radius = 1.0 + offset;
        let stiffness = radius.powi(-4);
        let blade = BladeProperties::new(BladeSpec {
            root_offset: offset / radius,
            root,
            rotor_speed: eta,
            ..BladeSpec::uniform(stiffness, stiffness, 1.0, 1e4)
        })?;
        // the rigid motion of a hinged beam at rest is not in the table
        let rigid = usize::from(root == RootSupport::HINGED && eta == 0.0);
        let count = ModeCount { flap: 5 + rigid, lag: 0, torsion: 0, axial: 0 };
        let set = uncoupled_modes(&blade, 20, count, ModalBasis::Natural)?;
        for (number, mode) in set.modes().iter().skip(rigid).enumerate() {
            let exact = row.number(&format!("mu{}", number + 1))?;
            errors.push(Ok(100.0 * (mode.frequency - exact).abs() / exact));
        }
    }
    worst("frequencies", 150, errors)
}

/// Largest error of the first lag frequency over the rotor speeds eta, %.
fn lag_axial(terms: GyroscopicTerms) -> Result<f64, Failure> {
    let published = [(2.0, 3.6195), (4.0, 3.888), (6.0, 4.2393), (8.0, 4.6105), (10.0, 4.97)];
    let count = ModeCount { flap: 0, lag: 1, torsion: 0, axial: 0 };
    let errors = published.into_iter().map(|(eta, exact): (f64, f64)| {
        // slenderness 70: EA L^2 / EI = 4900
        let spec = BladeSpec { rotor_speed: eta, ..BladeSpec::uniform(1.0, 1.0, 1.0, 4900.0) };
        let model = BladeModel::new(BladeProperties::new(spec)?, 20)?;
        let found = modes(&model, terms, count)?;
        let lag = found.iter().find(|mode| mode.kind == ModeKind::Lag);
        let lag = lag.ok_or(too_few("lag modes", 0, 1))?;
        Ok(100.0 * (lag.frequency - exact).abs() / exact)
    });
    worst("rotor speeds", 5, errors)
}
