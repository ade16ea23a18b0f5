//! The controller on a plant whose optimum is known.

use hhc_control::{
    ControlLayout, ControlLimits, FeedbackController, FeedbackLaw, FeedbackSettings, LinearPlant,
    LoadWeights, Plant, TMatrix, VoltageRange, identify_t, lag_loss,
};
use nalgebra::{DMatrix, DVector};
use validation::{Check, Failure, row, too_few, worst};

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-CTRL-01",
        "linear plant, 12 loads, 4 controls, free and weighted: controls off the \
         optimum",
        "-",
    )
    .against("normal equations (T'T + rho I) u = -T'Z0, solved by Cholesky")
    .at_most(1e-8, || worst("weights", 3, [0.0, 0.3, 3.0].map(|rho| off_optimum(rho, 1.0)))),
    row("V-CTRL-02", "the same with a T matrix 10 % too large, free: feedback corrects it", "-")
        .against("normal equations, free optimum")
        .at_most(1e-8, || off_optimum(0.0, 1.1)),
    row("V-CTRL-03", "T matrix of the linear plant by central differences: largest error", "1/V")
        .against("the plant's own T")
        .at_most(1e-12, t_matrix_error),
    row(
        "V-CTRL-04",
        "optimum within two circles and a voltage range, both flaps: worst KKT \
         residual of 50 problems",
        "-",
    )
    .against("conditions of Karush, Kuhn and Tucker, formed anew")
    .at_most(1e-6, || worst("problems", 50, (0..50).map(|k| constrained(k).map(|found| found[0])))),
    row(
        "V-CTRL-05",
        "the same: cost over the best of 2000 random controls that keep the limits, \
         worst of 50",
        "-",
    )
    .against("enumeration")
    .at_most(1.0, || worst("problems", 50, (0..50).map(|k| constrained(k).map(|found| found[1])))),
    row(
        "V-CTRL-06",
        "part of the reduction lost to an ignored lag of 41 and 36 deg: error of \
         the closed form",
        "-",
    )
    .against("costs of the linear plant itself")
    .at_most(1e-8, lag_loss_error),
];

const LOADS: usize = 12;
const CONTROLS: usize = 4;

/// A full, well-conditioned matrix without structure.
fn sensitivity(row: usize, column: usize) -> f64 {
    let (i, j) = (row as f64, column as f64);
    (1.3 * i + 2.1 * j + 0.4 * i * j).sin() + if row == column { 1.5 } else { 0.0 }
}

fn baseline(row: usize) -> f64 {
    (0.7 * row as f64 + 0.2).cos()
}

fn plant() -> Result<LinearPlant, Failure> {
    let layout = ControlLayout::new(2, vec![3])?;
    let loads = (0..LOADS).map(baseline).collect();
    Ok(LinearPlant::new(layout, loads, t_matrix(1.0)?)?)
}

fn t_matrix(scale: f64) -> Result<TMatrix, Failure> {
    let column = |j| (0..LOADS).map(|i| scale * sensitivity(i, j)).collect();
    let columns: Vec<Vec<f64>> = (0..CONTROLS).map(column).collect();
    Ok(TMatrix::from_columns(&columns)?)
}

/// Distance of the controls found from the optimum, over the optimum. The controller knows the plant's
/// T times `scale`.
fn off_optimum(rho: f64, scale: f64) -> Result<f64, Failure> {
    let settings = FeedbackSettings { step_tolerance: 1e-12, ..FeedbackSettings::default() };
    let controller = FeedbackController::new(&t_matrix(scale)?, &LoadWeights::Identity, settings)?;
    let run = controller.run(&mut plant()?, rho)?;
    let found = DVector::from_column_slice(&run.last().control_volt);
    let t = DMatrix::from_fn(LOADS, CONTROLS, sensitivity);
    let z = DVector::from_fn(LOADS, |i, _| baseline(i));
    let normal = t.tr_mul(&t) + DMatrix::identity(CONTROLS, CONTROLS) * rho;
    let factor = normal.cholesky().ok_or(too_few("independent controls", 0, CONTROLS))?;
    let optimum = factor.solve(&(-t.tr_mul(&z)));
    Ok((found - &optimum).norm() / optimum.norm())
}

/// KKT residual of one problem, and its cost over that of the best random control.
fn constrained(problem: u32) -> Result<[f64; 2], Failure> {
    // loads and limits vary from problem to problem, always the same
    let mut state = u64::from(problem) + 1;
    let mut random = || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    };
    let loads: Vec<f64> = (0..LOADS).map(|_| 5.0 * random()).collect();
    let limit = 0.2 + 0.1 * random();
    let layout = ControlLayout::new(2, vec![3])?;
    let limits = ControlLimits::none(&layout)
        .with_amplitudes_volt(vec![limit, 0.6 * limit])?
        .with_voltage_range(VoltageRange {
            range_volt: [-0.9 * limit, 1.5 * limit],
            bias_volt: vec![0.1 * limit * random(); 2],
            bias_slope: Vec::new(),
            azimuths: 360,
        })?;
    let t = t_matrix(1.0)?;
    let law = FeedbackLaw::new(&t, &LoadWeights::Identity)?;
    let found = law.optimum_within(0.0, &[0.0; CONTROLS], &loads, &limits)?;
    let cost = |u: &[f64]| -> Result<f64, Failure> {
        Ok(t.loads_for(u)?.iter().zip(&loads).map(|(a, b)| (a + b).powi(2)).sum())
    };
    let mut best = f64::INFINITY;
    for _ in 0..2000 {
        let u: Vec<f64> = (0..CONTROLS).map(|_| random()).collect();
        let usage = limits.usage(&u)?;
        let u: Vec<f64> = u.iter().map(|v| v / usage).collect();
        best = best.min(cost(&u)?);
    }
    Ok([found.kkt.largest(), cost(&found.control_volt)? / best])
}

fn lag_loss_error() -> Result<f64, Failure> {
    let law = FeedbackLaw::new(&t_matrix(1.0)?, &LoadWeights::Identity)?;
    let z: Vec<f64> = (0..LOADS).map(baseline).collect();
    let best = law.optimum_volt(0.0, &[0.0; CONTROLS], &z)?;
    let lags = [41.0_f64, 36.0].map(f64::to_radians);
    let late: Vec<f64> = best
        .chunks_exact(2)
        .zip(lags)
        .flat_map(|(u, lag)| {
            let (s, c) = lag.sin_cos();
            [c * u[0] - s * u[1], s * u[0] + c * u[1]]
        })
        .collect();
    let mut plant = plant()?;
    let mut cost = |u: &[f64]| -> Result<f64, Failure> {
        let Ok(measured) = plant.measure(u);
        Ok(measured.outputs.iter().map(|z| z * z).sum())
    };
    let (before, least, ignored) = (cost(&[0.0; CONTROLS])?, cost(&best)?, cost(&late)?);
    let closed = lag_loss(&t_matrix(1.0)?, &LoadWeights::Identity, &best, &lags)?.part;
    Ok((closed - (ignored - least) / (before - least)).abs())
}

fn t_matrix_error() -> Result<f64, Failure> {
    let mut plant = plant()?;
    let steps = vec![0.5; plant.layout().len()];
    let found = identify_t(&mut plant, &steps)?;
    let entries = (0..LOADS).flat_map(|i| (0..CONTROLS).map(move |j| (i, j)));
    let errors = entries.map(|(i, j)| {
        let got = found.at(i, j).unwrap_or(f64::NAN);
        Ok((got - sensitivity(i, j)).abs())
    });
    worst("entries", LOADS * CONTROLS, errors)
}
