//! Attached-flow loads of a section with a trailing-edge flap.

use exact_section::incompressible_loads;
use flap_aero::{
    AttachedFlowModel, FlapChord, HingePosition, Load, Mach, MarchingSection, Mode, Motion,
    SectionCoefficients, SectionInputs, SectionState, TheodorsenFunctions, harmonic_response,
};
use num_complex::Complex64;
use validation::{Check, Failure, Table, TableRow, row, worst};

const THEODORSEN: &str = "Theodorsen, NACA Report 496, theodorsen_flap_E020.csv, E = 0.20";

pub(crate) const ROWS: &[Check] = &[
    row("V-AERO-01", "flap lift, incompressible, k up to 1: largest error of its magnitude", "%")
        .against(THEODORSEN)
        .at_most(2.5, || flap_error(Load::Lift, 100.0)),
    row("V-AERO-02", "flap pitching moment, the same", "-")
        .against(THEODORSEN)
        .at_most(1e-6, || flap_error(Load::Moment, 1.0)),
    row("V-AERO-03", "flap hinge moment, the same, E 0.20 only (V-AERO-46 has the others)", "%")
        .against(THEODORSEN)
        .at_most(0.6, || flap_error(Load::Hinge, 100.0)),
    row(
        "V-AERO-46",
        "flap hinge moment, incompressible, E 0.1 to 0.4, k up to 1: largest error \
         of its magnitude, at E 0.4",
        "%",
    )
    .against("Theodorsen, pressure series of Küssner and Schwarz")
    .between(0.8, 0.9, hinge_error_of_flaps),
    row("V-AERO-04", "Theodorsen functions T1 to T19, all hinge positions: largest error", "-")
        .against("T_coeffs.csv")
        .at_most(1e-11, theodorsen_functions),
    row("V-AERO-05", "lag recurrence on a ramp: largest error", "-")
        .against("closed form of a first-order lag")
        .at_most(1e-12, ramp_error),
    row("V-AERO-06", "lag recurrence on a sine, order from 80 to 160 steps per cycle", "-")
        .against("theory: second order")
        .between(1.95, 2.05, recurrence_order),
];

/// Flap chord over chord of the reference tables.
const FLAP_CHORD: f64 = 0.2;

fn incompressible() -> Result<SectionCoefficients, Failure> {
    let flap = FlapChord::new(FLAP_CHORD)?;
    Ok(AttachedFlowModel::Incompressible.coefficients(Mach::ZERO, flap)?)
}

fn complex(row: &TableRow<'_>, name: &str) -> Result<Complex64, Failure> {
    Ok(Complex64::new(row.number(&format!("{name}_re"))?, row.number(&format!("{name}_im"))?))
}

/// Largest error of one load over the table's reduced frequencies up to 1, over the load's magnitude.
fn flap_error(load: Load, scale: f64) -> Result<f64, Failure> {
    let section = incompressible()?;
    let table = Table::read("aero/theodorsen_flap_E020.csv")?;
    let column = ["cn", "cm25", "ch"][load.index()];
    let mut errors = Vec::new();
    for row in table.rows() {
        let k = row.number("k")?;
        if k > 1.0 {
            continue;
        }
        let got = harmonic_response(&section, k, Motion::Flap)[load.index()];
        let exact = complex(&row, column)?;
        errors.push(Ok(scale * (got - exact).norm() / exact.norm()));
    }
    worst("reduced frequencies", 10, errors)
}

/// Largest error of the hinge moment over flap chords and reduced frequencies, per cent.
fn hinge_error_of_flaps() -> Result<f64, Failure> {
    let mut errors = Vec::new();
    for ratio in [0.1, 0.15, 0.2, 0.25, 0.3, 0.35, 0.4] {
        let section =
            AttachedFlowModel::Incompressible.coefficients(Mach::ZERO, FlapChord::new(ratio)?)?;
        for step in 1..=50 {
            let k = 0.02 * f64::from(step);
            let exact = exact_section::Motion::Flap.of(&incompressible_loads(k, ratio)?, k)[2];
            let got = harmonic_response(&section, k, Motion::Flap)[2];
            errors.push(Ok(100.0 * (got - exact).norm() / exact.norm()));
        }
    }
    worst("conditions", 350, errors)
}

fn theodorsen_functions() -> Result<f64, Failure> {
    let table = Table::read("aero/T_coeffs.csv")?;
    let mut errors = Vec::new();
    for row in table.rows() {
        let functions = TheodorsenFunctions::new(HingePosition::new(row.number("e")?)?);
        for (index, value) in functions.all().iter().enumerate() {
            let exact = row.number(&format!("T{}", index + 1))?;
            errors.push(Ok((value - exact).abs()));
        }
    }
    worst("Theodorsen functions", 19, errors)
}

/// The exact state of `x' = p (u - x)`, `x(0) = 0`, for the ramp `u = r S`.
fn lag_on_a_ramp(pole: f64, rate: f64, semichords: f64) -> f64 {
    rate * (semichords + (-pole * semichords).exp_m1() / pole)
}

/// Largest error of a lag state while the flap angle ramps by 0.01 rad per semichord, in steps from
/// short to very long.
fn ramp_error() -> Result<f64, Failure> {
    let section = incompressible()?;
    let marching = MarchingSection::new(&section);
    let mut state = SectionState::at_rest(&marching);
    let rate = 0.01;
    let mut travelled = 0.0;
    let mut errors = Vec::new();
    for step in [1e-3, 0.1, 0.7, 2.0, 11.0, 40.0] {
        travelled += step;
        let mut inputs = SectionInputs::default();
        inputs.modes[Mode::Flap.index()] = rate * travelled;
        inputs.rates[Mode::Flap.index()] = rate;
        state.step(&marching, &inputs, step)?;
        for (lag, got) in section.lags.iter().zip(state.states()) {
            let drive = lag.input[Mode::Flap.index()] * rate;
            errors.push(Ok((got - lag_on_a_ramp(lag.pole, drive, travelled)).abs()));
        }
    }
    worst("lag states", 6, errors)
}

/// Largest error of the lift in the tenth cycle of a flap oscillation, over the lift's amplitude.
fn sine_error(steps_per_cycle: u32) -> Result<f64, Failure> {
    let section = incompressible()?;
    let k = 0.2;
    let exact = harmonic_response(&section, k, Motion::Flap)[Load::Lift.index()];
    let motion = Motion::Flap.inputs(k);
    let ik = Complex64::new(0.0, k);
    let at = |turn: Complex64| SectionInputs {
        modes: motion.map(|m| (m * turn).re),
        rates: motion.map(|m| (m * ik * turn).re),
    };
    let step = std::f64::consts::TAU / (k * f64::from(steps_per_cycle));
    let marching = MarchingSection::new(&section);
    let mut state = SectionState::at_rest(&marching);
    let mut errors = Vec::new();
    // the slowest lag, 0.0455 per semichord, has forgotten the start after thirty cycles
    for i in 1..=31 * steps_per_cycle {
        let turn = Complex64::cis(k * step * f64::from(i));
        let got = state.step(&marching, &at(turn), step)?[Load::Lift.index()];
        if i > 30 * steps_per_cycle {
            errors.push(Ok((got - (exact * turn).re).abs() / exact.norm()));
        }
    }
    worst("steps", 10, errors)
}

fn recurrence_order() -> Result<f64, Failure> {
    Ok((sine_error(80)? / sine_error(160)?).log2())
}
