//! Reversal curves: drift taken off, the FORC diagram, and a measured family.
#![expect(clippy::unwrap_used, reason = "a test stops at what it does not expect")]
#![expect(clippy::disallowed_methods, reason = "tests read fixtures")]

use approx::assert_abs_diff_eq;
use bench_study::diagram::diagram;
use bench_study::drift::{DriftKind, without_drift};
use preisach_dyn::forc::{CalibrationPoint, ForcCurve, ForcData, ForcSettings, held_out};
use std::path::PathBuf;

/// Curves from -4 to 6, reversals and inputs `step` apart, the output a surface over reversal and input.
fn family(step: f64, surface: impl Fn(f64, f64) -> f64) -> ForcData {
    let (low, high) = (-4.0, 6.0);
    let mut curves = Vec::new();
    let mut reversal = high - 2.0 * step;
    while reversal >= low - 1e-9 {
        let mut curve = ForcCurve { input: Vec::new(), output: Vec::new() };
        let mut input = reversal;
        while input <= high + 1e-9 {
            curve.input.push(input);
            curve.output.push(surface(reversal, input));
            input += step;
        }
        curves.push(curve);
        reversal -= step;
    }
    ForcData { curves, calibration: Vec::new() }
}

/// The measured family: field in oersted, moment in emu.
fn measured() -> ForcData {
    let path =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/measured/forc/hchb_forc");
    let text = std::fs::read_to_string(path).unwrap();
    let mut data = ForcData::default();
    let mut block: Vec<[f64; 2]> = Vec::new();
    for line in text.lines().skip_while(|line| !line.starts_with("NData")).skip(1) {
        let numbers: Vec<f64> = line.split(',').filter_map(|n| n.trim().parse().ok()).collect();
        if let [field, moment] = numbers.as_slice() {
            block.push([*field, *moment]);
            continue;
        }
        match block.as_slice() {
            [] => {}
            [[input, output]] => {
                data.calibration.push(CalibrationPoint { input: *input, output: *output });
            }
            points => data.curves.push(ForcCurve {
                input: points.iter().map(|p| p[0]).collect(),
                output: points.iter().map(|p| p[1]).collect(),
            }),
        }
        block.clear();
    }
    data
}

#[test]
fn drift_of_gain_and_of_zero_is_taken_off() {
    let clean = family(0.4, |a, h| 2.0 + a - 0.3 * (h - a).powi(2));
    let span = clean.output_span();
    for kind in [DriftKind::Gain, DriftKind::Offset] {
        // a steady drift over the whole measurement, every point taking equal time
        let mut drifting = clean.clone();
        let points: usize = clean.curves.iter().map(|c| c.input.len() + 1).sum();
        let saturated = 2.0 * span;
        let mut time = 0;
        let mut read = |value: f64| {
            let share = 0.02 * (f64::from(time) / points as f64 - 0.5);
            time += 1;
            if kind == DriftKind::Gain { value * (1.0 + share) } else { value + share * span }
        };
        for curve in &mut drifting.curves {
            drifting.calibration.push(CalibrationPoint { input: 6.0, output: read(saturated) });
            curve.output.iter_mut().for_each(|y| *y = read(*y));
        }
        // what remains of the drift is the mean reading, one scale (or shift) for the whole family
        let mean = drifting.calibration.iter().map(|c| c.output).sum::<f64>()
            / drifting.calibration.len() as f64;
        let expected = |y: f64| match kind {
            DriftKind::Gain => y * mean / saturated,
            DriftKind::Offset => y + mean - saturated,
        };
        // the last curve has no reading after it
        let worst = |data: &ForcData| {
            let pairs = data.curves.iter().zip(&clean.curves).take(clean.curves.len() - 1);
            let off = |(x, y): (&f64, &f64)| (x - expected(*y)).abs() / span;
            pairs.flat_map(|(a, b)| a.output.iter().zip(&b.output).map(off)).fold(0.0, f64::max)
        };
        assert!(worst(&drifting) > 5e-3, "{}", worst(&drifting));
        let unsmoothed = without_drift(&drifting, kind, 0).unwrap();
        assert!(worst(&unsmoothed) < 1e-12, "{kind:?} {}", worst(&unsmoothed));
        // curves grow longer one by one, so a moving average is a little off
        let smoothed = without_drift(&drifting, kind, 2).unwrap();
        assert!(worst(&smoothed) < 1e-4, "{kind:?} {}", worst(&smoothed));
    }
}

#[test]
fn the_diagram_of_a_quadratic_surface_is_exact() {
    // y = 2 + 0.3 a - 0.7 h + 0.05 a^2 + 0.02 h^2 - 0.4 a h: rho = 0.2 everywhere
    let surface =
        |a: f64, h: f64| 2.0 + 0.3 * a - 0.7 * h + 0.05 * a * a + 0.02 * h * h - 0.4 * a * h;
    let data = family(0.25, surface);
    let points = diagram(&data, 3).unwrap();
    assert!(points.len() > 200, "{}", points.len());
    assert!(diagram(&data, 0).is_err() && diagram(&data, 50).is_err());
    for point in &points {
        assert_abs_diff_eq!(point.density, 0.2, epsilon = 1e-9);
        assert_abs_diff_eq!(point.half_width + point.centre, point.input, epsilon = 1e-12);
    }
}

#[test]
fn the_diagram_converges_to_the_second_derivative_at_second_order() {
    // y = sin(a) cos(h / 2): d2y/dadh = -cos(a) sin(h / 2) / 2
    let error = |step: f64| {
        let data = family(step, |a, h| a.sin() * (0.5 * h).cos());
        let points = diagram(&data, 2).unwrap();
        let off = points.iter().map(|p| {
            let exact = 0.25 * p.reversal_input.cos() * (0.5 * p.input).sin();
            (p.density - exact).abs()
        });
        off.fold(0.0, f64::max)
    };
    let (coarse, fine) = (error(0.2), error(0.1));
    let order = (coarse / fine).log2();
    assert!((1.7..2.3).contains(&order), "{coarse} {fine} {order}");
}

#[test]
fn measured_curves_held_out_are_reproduced_within_2_percent() {
    let data = measured();
    assert_eq!((data.curves.len(), data.calibration.len()), (152, 152));
    let points: usize = data.curves.iter().map(|c| c.input.len()).sum();
    assert_eq!(points, 30_476);
    let data = without_drift(&data, DriftKind::Gain, 2).unwrap();
    let settings = ForcSettings { levels: 40, ..ForcSettings::default() };
    let judged = held_out(&data, &settings, 4, 2).unwrap();
    println!(
        "40 levels, every 4th of 152 held out: rms {:.3} %, worst curve {:.3} % of range",
        judged.rms_percent, judged.worst_curve_percent
    );
    assert_eq!(judged.curves.len(), 38);
    assert!(judged.worst_curve_percent <= 2.0, "{judged:?}");
    // a grid that is too coarse does not do it
    let coarse = ForcSettings { levels: 6, ..settings };
    assert!(held_out(&data, &coarse, 4, 2).unwrap().worst_curve_percent > 2.0);
    // the diagram has its ridge at positive half-widths and next to no weight elsewhere
    let points = diagram(&data, 4).unwrap();
    let peak = points.iter().max_by(|a, b| a.density.total_cmp(&b.density)).unwrap();
    println!(
        "diagram: {} points, peak at half-width {:.0} Oe, centre {:.0} Oe",
        points.len(),
        peak.half_width,
        peak.centre
    );
    assert!(peak.half_width > 0.0 && peak.density > 0.0, "{peak:?}");
}
