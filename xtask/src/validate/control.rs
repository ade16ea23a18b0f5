//! The controller on a plant whose optimum is known.

use hhc_control::{
    ControlLayout, FeedbackController, FeedbackSettings, LinearPlant, LoadWeights, Plant, TMatrix,
    identify_t,
};
use nalgebra::{DMatrix, DVector};

use super::CheckError;
use super::check::{Area, Check, Criterion, Repeatability};
use super::reference::worst;

pub(super) const AREA: Area = Area {
    heading: "Control (`hhc-control`)",
    checks: &[
        Check {
            id: "V-CTRL-01",
            quantity: "linear plant, 12 loads, 4 controls, free and weighted: controls off the optimum",
            unit: "-",
            source: "normal equations (T'T + rho I) u = -T'Z0, solved by Cholesky",
            criterion: Criterion::AtMost(1e-8),
            repeatability: Repeatability::Everywhere,
            measure: || worst("weights", 3, [0.0, 0.3, 3.0].map(|rho| off_optimum(rho, 1.0))),
        },
        Check {
            id: "V-CTRL-02",
            quantity: "the same with a T matrix 10 % too large, free: feedback corrects it",
            unit: "-",
            source: "normal equations, free optimum",
            criterion: Criterion::AtMost(1e-8),
            repeatability: Repeatability::Everywhere,
            measure: || off_optimum(0.0, 1.1),
        },
        Check {
            id: "V-CTRL-03",
            quantity: "T matrix of the linear plant by central differences: largest error",
            unit: "1/V",
            source: "the plant's own T",
            criterion: Criterion::AtMost(1e-12),
            repeatability: Repeatability::Everywhere,
            measure: t_matrix_error,
        },
    ],
};

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

fn plant() -> Result<LinearPlant, CheckError> {
    let layout = ControlLayout::new(2, vec![3])?;
    let loads = (0..LOADS).map(baseline).collect();
    Ok(LinearPlant::new(layout, loads, t_matrix(1.0)?)?)
}

fn t_matrix(scale: f64) -> Result<TMatrix, CheckError> {
    let column = |j| (0..LOADS).map(|i| scale * sensitivity(i, j)).collect();
    let columns: Vec<Vec<f64>> = (0..CONTROLS).map(column).collect();
    Ok(TMatrix::from_columns(&columns)?)
}

/// Distance of the controls found from the optimum, over the optimum. The controller knows the plant's
/// T times `scale`.
fn off_optimum(rho: f64, scale: f64) -> Result<f64, CheckError> {
    let settings = FeedbackSettings { step_tolerance: 1e-12, ..FeedbackSettings::default() };
    let controller = FeedbackController::new(&t_matrix(scale)?, &LoadWeights::Identity, settings)?;
    let run = controller.run(&mut plant()?, rho)?;
    let found = DVector::from_column_slice(&run.last().control_volt);
    let t = DMatrix::from_fn(LOADS, CONTROLS, sensitivity);
    let z = DVector::from_fn(LOADS, |i, _| baseline(i));
    let normal = t.tr_mul(&t) + DMatrix::identity(CONTROLS, CONTROLS) * rho;
    let factor = normal.cholesky().ok_or(CheckError::TooFew {
        what: "independent controls",
        found: 0,
        needed: CONTROLS,
    })?;
    let optimum = factor.solve(&(-t.tr_mul(&z)));
    Ok((found - &optimum).norm() / optimum.norm())
}

fn t_matrix_error() -> Result<f64, CheckError> {
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
