//! A cause of two parameters that do together more than the sum of each, and causes that are taken for true.

use crate::toy::noise;
use model_gap::GapError;
use model_gap::discovery::{Confidence, Reason};
use model_gap::points::{
    CauseParameter, Grid, Instrument, KindFinding, KindQuestion, Point, PointCause, PointKind,
    Shown, channels_of,
};

/// An actuator that lags, deg, at a stroke.
#[derive(Debug, Clone, Copy)]
struct Actuator {
    lag_deg: f64,
    stroke: f64,
}

const DEVIATION: f64 = 0.002;

/// Cosine and sine of the motion under commands of some amplitudes and phases.
struct Driven(Vec<(f64, f64)>);

impl PointKind for Driven {
    type Model = Actuator;
    type Error = GapError;

    fn read(&self, own: &Actuator) -> Result<Grid, GapError> {
        let at = |&(amplitude, phase): &(f64, f64)| {
            let (sin, cos) = (phase + own.lag_deg.to_radians()).sin_cos();
            vec![own.stroke * amplitude * cos, own.stroke * amplitude * sin]
        };
        Ok(self.0.iter().map(at).collect())
    }
}

fn asked(truth: Actuator, only: &[String]) -> KindFinding<Actuator> {
    let drive = |k: u32| (0.5 + 0.1 * f64::from(k % 4), 0.9 * f64::from(k));
    let kind = Driven((0..16).map(drive).collect());
    let mut state = 3;
    let read = kind.read(&truth).unwrap();
    let points: Vec<Point> = (read.iter().zip(&kind.0).enumerate())
        .map(|(p, (row, drive))| Point {
            id: p.to_string(),
            group: p,
            is_reference: false,
            conditions: vec![drive.0, drive.1],
            measured: row.iter().map(|v| Some(v + DEVIATION * noise(&mut state))).collect(),
            deviation: vec![DEVIATION; 2],
        })
        .collect();
    let lag = CauseParameter {
        name: "lag_deg",
        unit: "deg",
        none: 0.0,
        range: (0.0, 80.0),
        amounts: vec![20.0, 45.0],
        shown: Shown::Itself,
    };
    let stroke = || CauseParameter::ratio(&[0.9, 0.7], (0.2, 2.5)).named("stroke");
    let causes = [
        PointCause::new("lag", "it lags", vec![lag, stroke()], |m: &mut Actuator, v| {
            m.lag_deg += v[0];
            m.stroke *= v[1];
        }),
        PointCause::new("gain", "it moves less", vec![stroke()], |m: &mut Actuator, v| {
            m.stroke *= v[0];
        }),
    ];
    let (channels, instruments) = channels_of(&["x_cos_deg", "x_sin_deg"]);
    let instrument = |name| Instrument { name, gain: 0.005, zero: 0.0 };
    let own = Actuator { lag_deg: 0.0, stroke: 1.0 };
    let question = KindQuestion {
        kind: &kind,
        model: &own,
        causes: &causes,
        alternatives: vec![],
        uncertain: 0,
        with_inputs: &|_: &[f64]| Ok(own),
        channels,
        instruments: instruments.into_iter().map(instrument).collect(),
        conditions: vec!["amplitude".to_owned(), "phase".to_owned()],
        points: &|_| points.clone(),
        knows_deviations: true,
        only,
        begun: &|_, _| {},
    };
    question.answer().unwrap()
}

/// A lag that is large beside a stroke that hardly changes: both are reported as they are.
#[test]
fn a_parameter_that_hardly_moves_does_not_stand_for_the_others() {
    for (lag_deg, stroke) in [(33.0, 1.03), (30.0, 1.08), (26.0, 0.98), (50.0, 1.1)] {
        let answer = asked(Actuator { lag_deg, stroke }, &[]);
        let found = &answer.found.finding.causes[0];
        assert_eq!(answer.found.candidates[found.candidate].id, "lag");
        let [lag, ratio] = &found.parameters[..] else { panic!("{found:?}") };
        assert!((lag.value - lag_deg).abs() < 1.5, "{lag_deg} {stroke}: {lag:?} {ratio:?}");
        assert!((ratio.value - stroke).abs() < 0.02, "{lag_deg} {stroke}: {ratio:?}");
    }
}

/// A cause that is taken for true is fitted, not found.
#[test]
fn what_is_taken_for_true_is_tentative() {
    let answer = asked(Actuator { lag_deg: 25.0, stroke: 1.0 }, &["gain".to_owned()]);
    let finding = &answer.found.finding;
    assert_eq!(finding.confidence, Confidence::Tentative);
    assert!(finding.reasons.contains(&Reason::TakenForTrue), "{:?}", finding.reasons);
    let is_of_records =
        |own: &Reason| matches!(own, Reason::BandsLeft { .. } | Reason::CalibrationOff { .. });
    assert!(!finding.reasons.iter().any(is_of_records), "{:?}", finding.reasons);
}
