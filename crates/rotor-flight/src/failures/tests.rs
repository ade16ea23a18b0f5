//! Single blades against the whole rotor; what control reaches under each failure.

use super::*;
use FailureControl::{AlikeNotTold, AlikeTold, EachTold};
use rotor_case::{AttachedFlowModel, InflowChoice};
use rotor_response::InflowState;

fn case() -> Case {
    let mut case = Case { advance_ratio: 0.3, ..Case::default() };
    case.structure.elements = 4;
    case.aerodynamics.model = AttachedFlowModel::QuasiSteady;
    case.inflow.model = InflowChoice::Drees;
    case
}

fn study_of(found: &FailureStudy, failure: Failure, control: FailureControl) -> &FailureLine {
    let mut lines = found.lines.iter();
    lines.find(|line| line.failure == failure && line.control == control).unwrap()
}

/// The slopes of single blades against the nonlinear rotor: another motion on every blade.
#[test]
fn what_each_blade_does_adds_up() {
    let rotor = TrimmedRotor::new(&case(), None).unwrap();
    let blades = BladeByBlade::new(&rotor, &[2, 3, 4, 5]).unwrap();
    let still: Motions = vec![vec![HarmonicSeries::zero(0); 2]; 4];
    let base = blades.loads(&still).unwrap();
    // blades that are alike leave nothing but multiples of their number
    let alone = |n: usize| base[of_order(n)].iter().map(|z| z * z).sum::<f64>().sqrt();
    for n in [1, 2, 3, 5, 6, 7] {
        assert!(alone(n) < 1e-9 * alone(4), "{n}/rev: {:e} {:e}", alone(n), alone(4));
    }
    // together they are the linearised rotor, found in another way, with its inflow held
    let whole = rotor.linearised(InflowState::Frozen).unwrap();
    for (flap, h) in [(0, 0), (0, 3), (1, 1), (1, 2)] {
        let mut motion = HarmonicSeries::zero(h + 2);
        motion.set_harmonic(h + 2, Harmonic { cosine: 0.0, sine: 1.0 });
        let expected = whole.loads(flap, &motion);
        let mut sum = [0.0; HUB_OUTPUTS];
        for blade in 0..4 {
            let own = &blades.slope(blade, flap, h)[1][of_order(4)];
            for (sum, own) in sum.iter_mut().zip(own) {
                *sum += own;
            }
        }
        let size = expected.iter().map(|z| z * z).sum::<f64>().sqrt();
        let apart = sum.iter().zip(expected).map(|(a, b)| (a - b).powi(2)).sum::<f64>().sqrt();
        println!("flap {flap}, {}/rev: {:.1e}", h + 2, apart / size);
        assert!(apart < 1e-3 * size, "flap {flap}, {}/rev: {apart:e} of {size:e}", h + 2);
    }
    let (mut moved, mut linear) = (still, base.clone());
    for (blade, own) in moved.iter_mut().enumerate() {
        for (flap, own) in own.iter_mut().enumerate() {
            let (h, cosine, sine) =
                ((blade + flap) % 4, 0.3 - 0.1 * blade as f64, 0.2 * flap as f64 - 0.1);
            *own = HarmonicSeries::zero(5);
            own.set_harmonic(h + 2, Harmonic { cosine, sine });
            let [c, s] = blades.slope(blade, flap, h);
            for (sum, (c, s)) in linear.iter_mut().zip(c.iter().zip(s)) {
                *sum += c * cosine + s * sine;
            }
        }
    }
    let loads = blades.loads(&moved).unwrap();
    for n in 1..=highest(4) {
        let of = |a: &[f64], b: &[f64]| {
            a[of_order(n)]
                .iter()
                .zip(&b[of_order(n)])
                .map(|(a, b)| (a - b).powi(2))
                .sum::<f64>()
                .sqrt()
        };
        let (left, change) = (of(&loads, &linear), of(&loads, &base));
        println!("{n}/rev: {left:.2e} of {change:.2e}");
        assert!(left < 0.02 * change, "{n}/rev: {left:e} of {change:e}");
    }
}

#[test]
fn what_is_left_is_used_and_what_is_told_helps() {
    let found = failures_of_case(&case(), &FlightValues::default()).unwrap();
    for line in &found.lines {
        println!(
            "{:28} {:24} J {:.3} worst {:.3} 1/rev {:.4} others {:.4} {:.1} V",
            line.failure.name(),
            line.control.name(),
            line.cost_ratio,
            line.worst_ratio.unwrap_or(f64::NAN),
            line.once_per_rev_ratio,
            line.other_ratio,
            line.largest_volt
        );
    }
    let of = |failure, control| study_of(&found, failure, control);
    let sound = of(Failure::Nothing, FailureControl::None);
    assert!((sound.cost_ratio - 1.0).abs() < 1e-9 && sound.other_ratio < 1e-12);
    assert!(of(Failure::Nothing, AlikeNotTold).other_ratio < 1e-12);
    let all = |line: &FailureLine| line.cost_ratio + line.once_per_rev_ratio + line.other_ratio;
    for failure in found.lines.iter().map(|line| line.failure) {
        let [told, each] = [AlikeTold, EachTold].map(|control| of(failure, control));
        assert!(told.cost_ratio < 1.0, "{failure:?}");
        // each blade has every motion of blades that are alike, and more
        assert!(all(each) <= all(told) + 1e-3, "{failure:?}: {} {}", all(each), all(told));
    }
    // a flap that stands leaves what blades under one control cannot cancel
    let stuck = Failure::Stuck { deg: 0.0 };
    assert!(of(stuck, AlikeTold).other_ratio > 0.5 && of(stuck, EachTold).other_ratio < 0.05);
    assert!(of(Failure::Stuck { deg: 3.0 }, FailureControl::None).once_per_rev_ratio > 0.01);
    let weak = of(Failure::Weak { share: WEAK_SHARE }, AlikeTold).other_ratio;
    assert!((0.01..0.2).contains(&weak), "{weak}");
    // who is told stays where nothing is cut off, on all blades
    let cut = |control| of(Failure::CutOff { share: RANGE_SHARE }, control);
    assert!(cut(AlikeNotTold).other_ratio > 1e-3 && cut(AlikeTold).other_ratio < 1e-12);
    assert!(cut(AlikeTold).cost_ratio > cut(AlikeNotTold).cost_ratio);
    // a load cell that reads zero: who is told leaves it out
    let is_lost = |line: &&FailureLine| matches!(line.failure, Failure::LoadLost { .. });
    let lost = found.lines.iter().find(is_lost).unwrap().failure;
    assert_eq!(lost.name(), format!("{} not measured", found.load));
    assert!(of(lost, AlikeTold).cost_ratio < of(lost, AlikeNotTold).cost_ratio);
}

/// Loads cut off at the blade number would make what failures add look small.
#[test]
fn too_few_load_harmonics_are_refused() {
    let mut case = case();
    case.response.load_harmonics = 6;
    let error = failures_of_case(&case, &FlightValues::default()).unwrap_err();
    assert!(error.to_string().contains("load_harmonics") && error.field() == "flight", "{error}");
}
