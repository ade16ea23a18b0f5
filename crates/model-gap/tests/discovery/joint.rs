//! A cause of two parameters that do together more than the sum of each, and causes that are taken for true.

use crate::toy::noise;
use model_gap::GapError;
use model_gap::discovery::{Confidence, Reason};
use model_gap::points::{
    CauseParameter, Grid, Instrument, KindFinding, KindQuestion, Point, PointCause, PointKind,
    Shown, channels_of,
};
use std::f64::consts::PI;

/// An actuator: the lag at its middle drive, deg, the part of it that is a relaxation, a stroke. The rest of the lag is that of
/// Rayleigh's law, which grows with the amplitude.
#[derive(Debug, Clone, Copy)]
struct Actuator {
    lag_deg: f64,
    relaxation_deg: f64,
    stroke: f64,
}

const DEVIATION: f64 = 0.02;
/// Harmonic and amplitude of the middle drive.
const MIDDLE: (f64, f64) = (4.0, 18.0);

/// Cosine and sine of the motion under commands of some harmonics, amplitudes and phases.
struct Driven(Vec<(f64, f64, f64)>);

impl PointKind for Driven {
    type Model = Actuator;
    type Error = GapError;

    fn read(&self, own: &Actuator) -> Result<Grid, GapError> {
        let rayleigh = 4.0 / (3.0 * PI);
        let share = (own.lag_deg - own.relaxation_deg).to_radians().tan() / rayleigh;
        let play = |over: f64| ((over - 1.0).mul_add(share, 1.0), rayleigh * share * over);
        let at = |&(harmonic, amplitude, phase): &(f64, f64, f64)| {
            let slow = harmonic / MIDDLE.0 * own.relaxation_deg.to_radians().tan();
            let (along, behind) = play(amplitude / MIDDLE.1);
            let (full_along, full_behind) = play(1.0);
            let size = own.stroke * amplitude * along.hypot(behind) / slow.hypot(1.0)
                * own.relaxation_deg.to_radians().cos().recip()
                / full_along.hypot(full_behind);
            let (sin, cos) = (phase + slow.atan() + behind.atan2(along)).sin_cos();
            vec![size * cos, size * sin]
        };
        Ok(self.0.iter().map(at).collect())
    }
}

fn asked(truth: Actuator, only: &[String]) -> KindFinding<Actuator> {
    let drive = |k: u32| {
        let harmonic = if k.is_multiple_of(3) { 2.0 } else { 4.0 };
        (harmonic, 6.0 + 6.0 * f64::from(k % 5), 0.9 * f64::from(k))
    };
    let kind = Driven((0..16).map(drive).collect());
    let mut state = 3;
    let read = kind.read(&truth).unwrap();
    let points: Vec<Point> = (read.iter().zip(&kind.0).enumerate())
        .map(|(p, (row, drive))| Point {
            id: p.to_string(),
            group: p,
            is_reference: false,
            conditions: vec![drive.0, drive.1, drive.2],
            measured: row.iter().map(|v| Some(v + DEVIATION * noise(&mut state))).collect(),
            deviation: vec![DEVIATION; 2],
        })
        .collect();
    let degrees = |name, range, amounts: [f64; 2]| CauseParameter {
        name,
        unit: "deg",
        none: 0.0,
        range,
        amounts: amounts.to_vec(),
        shown: Shown::Itself,
    };
    let lags = vec![
        degrees("lag_deg", (0.0, 80.0), [20.0, 45.0]),
        degrees("relaxation_deg", (-20.0, 60.0), [15.0, -10.0]),
        CauseParameter::ratio(&[0.9, 0.7], (0.2, 2.5)).named("stroke"),
    ];
    let stroke = || CauseParameter::ratio(&[0.9, 0.7], (0.2, 2.5)).named("stroke");
    let causes = [
        PointCause::new("lag", "it lags", lags, |m: &mut Actuator, v| {
            m.lag_deg += v[0];
            m.relaxation_deg += v[1];
            m.stroke *= v[2];
        }),
        PointCause::new("gain", "it moves less", vec![stroke()], |m: &mut Actuator, v| {
            m.stroke *= v[0];
        }),
    ];
    let (channels, instruments) = channels_of(&["x_cos_deg", "x_sin_deg"]);
    let instrument = |name| Instrument { name, gain: 0.005, zero: 0.0 };
    let own = Actuator { lag_deg: 0.0, relaxation_deg: 0.0, stroke: 1.0 };
    let question = KindQuestion {
        kind: &kind,
        model: &own,
        causes: &causes,
        alternatives: vec![],
        uncertain: 0,
        with_inputs: &|_: &[f64]| Ok(own),
        channels,
        instruments: instruments.into_iter().map(instrument).collect(),
        conditions: ["harmonic", "amplitude", "phase"].map(str::to_owned).to_vec(),
        points: &|_| points.clone(),
        knows_deviations: true,
        only,
        begun: &|_, _| {},
    };
    question.answer().unwrap()
}

/// A lag that is large beside a stroke that hardly changes: the stroke does not take its place.
#[test]
fn a_parameter_that_hardly_moves_does_not_stand_for_the_others() {
    for (lag_deg, relaxation_deg, stroke) in
        [(33.0, 17.0, 1.03), (28.0, 12.0, 1.06), (24.0, 9.0, 0.96)]
    {
        let answer = asked(Actuator { lag_deg, relaxation_deg, stroke }, &[]);
        let found = &answer.found.finding.causes[0];
        assert_eq!(answer.found.candidates[found.candidate].id, "lag");
        let [lag, relaxation, ratio] = &found.parameters[..] else { panic!("{found:?}") };
        let told = format!("{lag_deg} {relaxation_deg} {stroke}: {lag:?} {relaxation:?} {ratio:?}");
        assert!((lag.value - lag_deg).abs() < 2.0, "{told}");
        assert!((relaxation.value - relaxation_deg).abs() < 4.0, "{told}");
        let [low, high] = ratio.ci95;
        assert!(low < stroke && stroke < high, "{told}");
    }
}

/// A cause that is taken for true is fitted, not found.
#[test]
fn what_is_taken_for_true_is_tentative() {
    let answer =
        asked(Actuator { lag_deg: 25.0, relaxation_deg: 10.0, stroke: 1.0 }, &["gain".to_owned()]);
    let finding = &answer.found.finding;
    assert_eq!(finding.confidence, Confidence::Tentative);
    assert!(finding.reasons.contains(&Reason::TakenForTrue), "{:?}", finding.reasons);
    let is_of_records =
        |own: &Reason| matches!(own, Reason::BandsLeft { .. } | Reason::CalibrationOff { .. });
    assert!(!finding.reasons.iter().any(is_of_records), "{:?}", finding.reasons);
}
