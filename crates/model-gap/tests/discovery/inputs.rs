//! Inputs that are not known well and do not act in proportion: a mass on a spring near its resonance.

use crate::toy::noise;
use model_gap::GapError;
use model_gap::discovery::{Confidence, Verdict};
use model_gap::points::{
    CauseParameter, Grid, Instrument, KindFinding, KindQuestion, Point, PointCause, PointKind,
    channels_of,
};

/// Spring, N/m, mass, kg, damper, N s/m.
#[derive(Debug, Clone, Copy)]
struct Oscillator {
    spring: f64,
    mass: f64,
    damper: f64,
}

const OWN: Oscillator = Oscillator { spring: 100.0, mass: 1.0, damper: 1.0 };
/// Standard deviations of spring and mass.
const SPRING: f64 = 0.03;
const MASS: f64 = 0.02;
const DEVIATION_M: f64 = 1e-3;

/// Cosine and sine under a force of 1 N at some frequencies, rad/s.
struct Shaken(Vec<f64>);

impl PointKind for Shaken {
    type Model = Oscillator;
    type Error = GapError;

    fn read(&self, own: &Oscillator) -> Result<Grid, GapError> {
        if own.spring.min(own.damper) < 0.0 {
            let (what, value, expected) = ("a spring or a damper", own.spring, "more than 0");
            return Err(GapError::OutOfRange { what, value, expected });
        }
        let at = |w: &f64| {
            let (real, imaginary) = (own.spring - own.mass * w * w, own.damper * w);
            let square = real * real + imaginary * imaginary;
            vec![real / square, imaginary / square]
        };
        Ok(self.0.iter().map(at).collect())
    }
}

fn asked(truth: Oscillator) -> KindFinding<Oscillator> {
    let kind = Shaken((0..30).map(|k| 7.0 + 0.2 * f64::from(k)).collect());
    let mut state = 11;
    let read = kind.read(&truth).unwrap();
    let points: Vec<Point> = (read.iter().zip(&kind.0).enumerate())
        .map(|(p, (row, frequency))| Point {
            id: format!("{frequency:.2} rad/s"),
            group: p,
            is_reference: false,
            conditions: vec![*frequency],
            measured: row.iter().map(|v| Some(v + DEVIATION_M * noise(&mut state))).collect(),
            deviation: vec![DEVIATION_M; 2],
        })
        .collect();
    // no oscillator has a negative spring: that amount is left out
    let ratio = || vec![CauseParameter::ratio(&[0.97, 1.1, -1.0], (0.3, 3.0))];
    let causes = [
        PointCause::new("spring", "it is softer", ratio(), |m: &mut Oscillator, v| {
            m.spring *= v[0];
        }),
        PointCause::new("damper", "it damps more", ratio(), |m: &mut Oscillator, v| {
            m.damper *= v[0];
        }),
    ];
    let (channels, instruments) = channels_of(&["x_cos_m", "x_sin_m"]);
    let instrument = |name| Instrument { name, gain: 0.005, zero: 0.0 };
    let with_inputs = |by: &[f64]| {
        let [spring, mass] = [1.0 + SPRING * by[0], 1.0 + MASS * by[1]];
        Ok(Oscillator { spring: OWN.spring * spring, mass: OWN.mass * mass, ..OWN })
    };
    let question = KindQuestion {
        kind: &kind,
        model: &OWN,
        causes: &causes,
        alternatives: vec![],
        uncertain: 2,
        with_inputs: &with_inputs,
        channels,
        instruments: instruments.into_iter().map(instrument).collect(),
        conditions: vec!["frequency".to_owned()],
        points: &|_| points.clone(),
        knows_deviations: true,
        only: &[],
        begun: &|_, _| {},
    };
    question.answer().unwrap()
}

fn names(answer: &KindFinding<Oscillator>) -> Vec<&'static str> {
    let found = &answer.found;
    found.finding.causes.iter().map(|own| found.candidates[own.candidate].id).collect()
}

/// A spring and a mass off by what they may be off by shift the resonance by its width: that is no discovery. In proportion
/// they do not explain it.
#[test]
fn what_uncertain_inputs_do_at_a_resonance_is_no_discovery() {
    for (spring, mass) in [(-1.5, 1.2), (1.6, -1.0), (-1.0, -1.5)] {
        let truth = Oscillator {
            spring: OWN.spring * (1.0 + SPRING * spring),
            mass: OWN.mass * (1.0 + MASS * mass),
            ..OWN
        };
        let answer = asked(truth);
        assert!(names(&answer).is_empty(), "{spring} {mass}: {:?}", names(&answer));
        assert_eq!(answer.found.finding.verdict, Verdict::NothingMissing);
    }
}

/// What they cannot be off by is one, and its amount is about the inputs as stated.
#[test]
fn what_no_uncertain_input_does_is_named() {
    let soft = asked(Oscillator { spring: 0.85 * OWN.spring, ..OWN });
    assert_eq!(names(&soft), ["spring"]);
    assert_eq!(soft.inputs, [0.0; 2]);
    let found = soft.found.finding.causes[0].parameters[0];
    assert!((found.value - 0.85).abs() < 0.02, "{found:?}");
    let damped = asked(Oscillator { damper: 1.8 * OWN.damper, ..OWN });
    assert_eq!(names(&damped), ["damper"]);
    assert_eq!(damped.found.finding.confidence, Confidence::Confident);
    assert!((damped.found.finding.causes[0].parameters[0].value - 1.8).abs() < 0.1);
}
