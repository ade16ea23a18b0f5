//! Reversal curves: exact recovery on synthetic ones.
#![expect(clippy::unwrap_used, reason = "a test stops at what it does not expect")]

use crate::oracles;

use approx::assert_abs_diff_eq;
use oracles::everett::EverettStaircase;
use preisach_dyn::forc::{CalibrationPoint, ForcCurve, ForcData, ForcSettings, fit};
use preisach_dyn::{
    PlayMap, PlayMemory, PreisachError, PreisachGrid, StartState, StaticPreisach, VoltageRange,
};

fn truth(levels: usize) -> StaticPreisach {
    let grid = PreisachGrid::new(VoltageRange::new(-4.0, 6.0).unwrap(), levels).unwrap();
    let n = levels as f64;
    let rises: Vec<Vec<f64>> = (0..levels)
        .map(|j| {
            (0..levels - j)
                .map(|k| {
                    let (s, r) = ((2 * k + j) as f64 / n - 1.0, j as f64 / n);
                    (1.2 + (3.0 * s).sin()) * (-4.0 * (r - 0.3) * (r - 0.3)).exp() / (n * n)
                })
                .collect()
        })
        .collect();
    StaticPreisach::new(grid, PlayMap::from_rises(&grid, 0.3, &rises).unwrap()).unwrap()
}

/// Curves of a model from saturation; reversals `step` apart.
fn family(model: &StaticPreisach, step: f64) -> ForcData {
    let range = model.grid().range();
    let (low, high) = (range.lowest_volt(), range.highest_volt());
    let mut curves = Vec::new();
    let mut reversal = high - 2.0 * step;
    while reversal >= low - 1e-9 {
        let mut memory = PlayMemory::new(model.grid(), high, StartState::FallingFromHighest);
        let mut curve = ForcCurve { input: Vec::new(), output: Vec::new() };
        let mut input = reversal;
        while input <= high + 1e-9 {
            curve.input.push(input);
            curve.output.push(model.apply(&mut memory, input));
            input += step;
        }
        curves.push(curve);
        reversal -= step;
    }
    ForcData { curves, calibration: Vec::new() }
}

#[test]
fn a_density_on_the_grid_is_found_from_its_curves() {
    let truth = truth(12);
    // points between the nodes too
    let data = family(&truth, 10.0 / 36.0);
    let settings =
        ForcSettings { levels: 12, smoothness: 1e-12, range: Some(truth.grid().range()) };
    let found = fit(&data, &settings).unwrap();
    // the solver stops at a gap of 1e-8 in squared errors relative to the range: 1e-4 in errors
    let (ours, theirs) = (found.model.map().rises(), truth.map().rises());
    for (a, b) in ours.iter().flatten().zip(theirs.iter().flatten()) {
        assert!((a - b).abs() < 1e-4 * data.output_span(), "{a} {b}");
    }
    for curve in &found.curves {
        assert!(curve.largest_percent < 1e-2, "{curve:?}");
    }
    // the Everett values are those of the classical form, at nodes and between them
    let (classical, ours) = (EverettStaircase::of(&truth), EverettStaircase::of(&found.model));
    let span = data.output_span();
    for i in 0..40 {
        let (upper, lower) = (-4.0 + 0.26 * f64::from(i), -4.0 + 0.17 * f64::from(i));
        let want = classical.everett(upper, lower);
        assert_abs_diff_eq!(ours.everett(upper, lower), want, epsilon = 1e-4 * span);
    }
}

#[test]
fn unusable_families_are_refused() {
    let good = family(&truth(6), 0.5);
    let few = ForcData { curves: good.curves[..2].to_vec(), calibration: Vec::new() };
    assert!(matches!(few.check(), Err(PreisachError::OutOfRange { value: 2.0, .. })));
    let mut nan = good.clone();
    nan.curves[1].output[0] = f64::NAN;
    assert!(matches!(nan.check(), Err(PreisachError::BadRecord { index: 0, .. })));
    let mut backwards = good.clone();
    backwards.curves.iter_mut().for_each(|c| c.input.reverse());
    assert!(matches!(backwards.check(), Err(PreisachError::BadRecord { .. })));
    let mut calibration = good.clone();
    calibration.calibration = vec![CalibrationPoint { input: 6.0, output: 1.0 }];
    assert!(matches!(calibration.check(), Err(PreisachError::OutOfRange { value: 1.0, .. })));
    let mut short = good.clone();
    short.curves[0].output.pop();
    assert!(matches!(short.check(), Err(PreisachError::BadRecord { .. })));
    let mut flat = good.clone();
    flat.curves.iter_mut().for_each(|c| c.output.iter_mut().for_each(|y| *y = 1.0));
    assert!(matches!(fit(&flat, &ForcSettings::default()), Err(PreisachError::OutOfRange { .. })));
    let levels = ForcSettings { levels: 1, ..ForcSettings::default() };
    assert!(fit(&good, &levels).is_err());
}
