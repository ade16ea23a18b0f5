//! A simulator of one's own, asked what it lacks: a mass on a spring, shaken, read as amplitudes over the frequency.
//! The kind says what is read of a model, a cause is where it enters. What was "measured" has a spring 10 % softer.
#![expect(clippy::print_stdout, reason = "the example prints what it finds")]

use model_gap::points::{
    CauseParameter, Grid, Instrument, KindQuestion, Point, PointCause, PointKind, channels_of,
};
use model_gap::{GapError, SplitMix};

/// A mass of 1 kg: spring, N/m, damper, N s/m.
#[derive(Clone, Copy)]
struct Oscillator {
    spring: f64,
    damper: f64,
}

/// Cosine and sine under a force of 1 N at some frequencies, rad/s.
struct Shaken(Vec<f64>);
type Cause = PointCause<Oscillator>;

impl PointKind for Shaken {
    type Model = Oscillator;
    type Error = GapError;

    fn read(&self, own: &Oscillator) -> Result<Grid, GapError> {
        let at = |w: &f64| {
            let (real, imaginary) = (own.spring - w * w, own.damper * w);
            let square = real * real + imaginary * imaginary;
            vec![real / square, imaginary / square]
        };
        Ok(self.0.iter().map(at).collect())
    }
}

fn main() -> Result<(), GapError> {
    let kind = Shaken((0..20).map(|k| 4.0 + 0.6 * f64::from(k)).collect());
    let model = Oscillator { spring: 100.0, damper: 0.8 };
    let truth = kind.read(&Oscillator { spring: 90.0, ..model })?;
    let (deviation, mut random) = (2e-4, SplitMix(1));
    let read = |(group, (row, frequency)): (usize, (&Vec<f64>, &f64))| Point {
        id: format!("{frequency:.1} rad/s"),
        group,
        is_reference: false,
        conditions: vec![*frequency],
        measured: row.iter().map(|v| Some(v + deviation * random.normal())).collect(),
        deviation: vec![deviation; 2],
    };
    let points: Vec<Point> = truth.iter().zip(&kind.0).enumerate().map(read).collect();
    let ratio = || vec![CauseParameter::ratio(&[0.95, 1.1], (0.3, 3.0))];
    let causes = [
        Cause::new("spring", "the spring is softer", ratio(), |m, v| m.spring *= v[0]),
        Cause::new("damper", "the damper damps more", ratio(), |m, v| m.damper *= v[0]),
    ];
    let (channels, instruments) = channels_of(&["x_cos_m", "x_sin_m"]);
    let instrument = |name| Instrument { name, gain: 0.005, zero: 0.0 };
    let asked = KindQuestion {
        kind: &kind,
        model: &model,
        causes: &causes,
        alternatives: vec![],
        uncertain: 0,
        with_inputs: &|_| Ok(model),
        channels,
        instruments: instruments.into_iter().map(instrument).collect(),
        conditions: vec!["frequency".to_owned()],
        points: &|_| points.clone(),
        knows_deviations: true,
        only: &[],
        begun: &|_, _| {},
    };
    let answer = asked.answer()?;
    for found in &answer.found.finding.causes {
        let [low, high] = found.parameters[0].ci95;
        let (id, value) = (causes[found.candidate].id, found.parameters[0].value);
        println!("missing: {id}, ratio {value:.3} ({low:.3} to {high:.3}); planted 0.900");
    }
    println!("spring of the extended model: {:.1} N/m", answer.extended.spring);
    Ok(())
}
