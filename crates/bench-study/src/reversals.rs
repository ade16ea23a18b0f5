//! First-order reversal curves within records, and their diagram.

use crate::diagram::{DiagramPoint, diagram};
use preisach_dyn::forc::{ForcCurve, ForcData};
use preisach_dyn::identify::BenchRecord;

/// Part of the span of the command within which two turning points are one, and an end of it is reached.
const NEAR: f64 = 0.02;
/// Part of the span by which a command turns back at a turning point.
const TURN: f64 = 0.01;
/// Fewest reversal curves of a diagram.
pub(crate) const FEWEST: usize = 5;
/// Largest smoothing factor, curves that each step of it asks for, and steps of the input between two reversals.
const SMOOTHING: usize = 3;
const CURVES: usize = 8;
const STEPS: f64 = 2.0;

/// A FORC diagram and what it is of.
#[derive(Debug, Clone, PartialEq)]
pub struct ForcDiagram {
    /// The data.
    pub id: String,
    /// Number of curves.
    pub curves: usize,
    /// Smoothing factor.
    pub smoothing: usize,
    /// Its points.
    pub points: Vec<DiagramPoint>,
}

/// The diagrams of the records that hold reversal curves: falls from one end of the command to ever other
/// turning points, each followed by the way back. Falls from the lower end count too, with both signs turned.
pub fn of_records(records: &[BenchRecord]) -> Vec<ForcDiagram> {
    records.iter().filter_map(of_record).collect()
}

fn of_record(record: &BenchRecord) -> Option<ForcDiagram> {
    let window = record.judged_samples();
    let (input, output) = (&record.voltage_volt[window.clone()], &record.output_deg[window]);
    let turned = |values: &[f64]| values.iter().map(|value| -value).collect::<Vec<_>>();
    let own = |curves: ForcData, sign: f64| {
        let smoothing = ((curves.curves.len() - 1) / CURVES).clamp(1, SMOOTHING);
        let mut points = diagram(&curves, smoothing).ok().filter(|points| !points.is_empty())?;
        for point in &mut points {
            point.reversal_input *= sign;
            point.input *= sign;
            point.centre *= sign;
        }
        let curves = curves.curves.len();
        Some(ForcDiagram { id: record.id.clone(), curves, smoothing, points })
    };
    let from_above = curves(input, output).and_then(|curves| own(curves, 1.0));
    from_above.or_else(|| own(curves(&turned(input), &turned(output))?, -1.0))
}

/// Places at which a signal turns, by more than `band`, its first and its last one.
fn turning_points(signal: &[f64], band: f64) -> Vec<usize> {
    let (mut all, mut extreme, mut rises) = (vec![0], 0, None);
    for (i, value) in signal.iter().enumerate() {
        let ahead = value - signal[extreme];
        match rises {
            None if ahead.abs() > band => (rises, extreme) = (Some(ahead > 0.0), i),
            Some(up) if (ahead > 0.0) == up => extreme = i,
            Some(up) if ahead.abs() > band => {
                all.push(extreme);
                (rises, extreme) = (Some(!up), i);
            }
            _ => {}
        }
    }
    all.push(extreme);
    all
}

/// The reversal curves of a command that falls from its upper end, by falling reversal, made of as many steps
/// as their distances ask for; none if there are too few.
fn curves(input: &[f64], output: &[f64]) -> Option<ForcData> {
    let [low, high] = input.iter().fold([f64::INFINITY, f64::NEG_INFINITY], |own, value| {
        [own[0].min(*value), own[1].max(*value)]
    });
    let span = high - low;
    let turns = turning_points(input, TURN * span);
    let is_top = |i: usize| input[i] >= high - NEAR * span;
    let rises = turns.windows(3).filter(|own| is_top(own[0]) && is_top(own[2]) && !is_top(own[1]));
    let mut rises: Vec<[usize; 2]> = rises.map(|own| [own[1], own[2]]).collect();
    rises.sort_by(|a, b| input[b[0]].total_cmp(&input[a[0]]));
    rises.dedup_by(|b, a| input[a[0]] - input[b[0]] <= NEAR * span);
    if rises.len() < FEWEST {
        return None;
    }
    let reach = input[rises[0][0]] - input[rises[rises.len() - 1][0]];
    let step = reach / (STEPS * (rises.len() - 1) as f64);
    let curves = rises.iter().map(|&[from, to]| {
        let place = |u: f64| ((u - input[from]) / step + 0.5).floor();
        let mut curve = ForcCurve { input: Vec::new(), output: Vec::new() };
        let samples: Vec<usize> = (from..=to).collect();
        for part in samples.chunk_by(|a, b| place(input[*a]) >= place(input[*b])) {
            let mean = |of: &[f64]| part.iter().map(|&i| of[i]).sum::<f64>() / part.len() as f64;
            curve.input.push(mean(input));
            curve.output.push(mean(output));
        }
        curve
    });
    Some(ForcData { curves: curves.collect(), calibration: Vec::new() })
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A triangle from one end to ever deeper turning points.
    fn reversals(sign: f64, deeper: f64) -> BenchRecord {
        let triangle = |phase: f64| 1.0 - (2.0 * phase.fract() - 1.0).abs();
        let command = |i: u32| {
            let time = 0.01 * f64::from(i);
            sign * (10.0 - (2.0 + deeper * time.floor()) * triangle(time))
        };
        let voltage_volt: Vec<f64> = (0..=1000).map(command).collect();
        // product of the last turning point and the input: the mixed derivative is one everywhere
        let mut turn = 10.0 * sign;
        let mut output_deg = Vec::new();
        for (i, &u) in voltage_volt.iter().enumerate() {
            if i > 0 && sign * (u - voltage_volt[i - 1]) < 0.0 {
                turn = u;
            }
            output_deg.push(sign * -2.0 * turn * u);
        }
        BenchRecord {
            id: "r".into(),
            time_step_s: 0.01,
            voltage_volt,
            output_deg,
            ..BenchRecord::default()
        }
    }

    #[test]
    fn curves_are_found_from_either_end() {
        for sign in [1.0, -1.0] {
            let found = of_records(&[reversals(sign, 1.5)]);
            let [own] = &found[..] else { panic!("{found:?}") };
            assert_eq!((own.curves, own.smoothing), (10, 1));
            // -1/2 d2y / (dHa dH) of -2 Ha H
            assert!(own.points.iter().all(|point| (point.density - 1.0).abs() < 0.05), "{own:?}");
            assert!(own.points.iter().all(|point| point.half_width > 0.0));
            assert!(own.points.iter().any(|point| sign * point.centre > 3.0), "{own:?}");
        }
        // the same loop again and again is one curve
        assert_eq!(of_records(&[reversals(1.0, 0.0)]), []);
    }
}
