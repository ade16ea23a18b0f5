//! Margins of T, predicted from the spectral radius and flown.

use crate::rotor::SPEEDS;
use hhc_control::{
    ControlError, ControlLayout, FeedbackLaw, LoadWeights, RelaxedController, RelaxedSettings,
    RelaxedStep, TMatrix,
};

const GAIN: f64 = 0.5;

fn layout() -> ControlLayout {
    ControlLayout::new(2, vec![3]).unwrap()
}

fn law(t: &TMatrix) -> FeedbackLaw {
    FeedbackLaw::new(t, &LoadWeights::Identity).unwrap()
}

/// Part of the way of a step, and the chance that a flap acts.
type Loop = (f64, f64);

/// `J / J0` after every cycle of a flight with `t0` on a linear rotor with `t`.
fn flown(
    t0: &TMatrix,
    t: &TMatrix,
    z0: &[f64],
    (gain, flap_survival): Loop,
    cycles: usize,
) -> (Vec<f64>, Vec<f64>) {
    let settings = RelaxedSettings { gain, flap_survival, ..RelaxedSettings::of_layout(&layout()) };
    let mut relaxed = RelaxedController::new(&layout(), z0.len(), settings).unwrap();
    let cost = |z: &[f64]| z.iter().map(|z| z * z).sum::<f64>();
    let (mut ratios, mut moves) = (Vec::new(), Vec::new());
    for _ in 0..cycles {
        let before = relaxed.control_volt().to_vec();
        let change = t.loads_for(&before).unwrap();
        let z: Vec<f64> = z0.iter().zip(change).map(|(z, dz)| z + dz).collect();
        ratios.push(cost(&z) / cost(z0));
        let after = relaxed.step(t0, &z).unwrap();
        let moved = after.iter().zip(&before).map(|(a, b)| (a - b).powi(2)).sum::<f64>();
        moves.push(moved.sqrt());
    }
    (ratios, moves)
}

/// The least error from which the steps of a flight grow, by bisection.
fn flown_margin(
    (mut low, mut high): (f64, f64),
    z0: &[f64],
    flown_loop: Loop,
    pair: impl Fn(f64) -> Result<[TMatrix; 2], ControlError>,
) -> f64 {
    for _ in 0..12 {
        let middle = f64::midpoint(low, high);
        let [t0, t] = pair(middle).unwrap();
        let (_, moves) = flown(&t0, &t, z0, flown_loop, 800);
        // what has settled moves by rounding alone
        let rests = 1e-9 * moves[0];
        let grows = !moves[799].is_finite() || moves[799] > moves[399].max(rests);
        *(if grows { &mut high } else { &mut low }) = middle;
    }
    high
}

fn step(flap_survival: f64) -> RelaxedStep {
    let settings =
        RelaxedSettings { gain: GAIN, flap_survival, ..RelaxedSettings::of_layout(&layout()) };
    settings.step(&layout())
}

/// Every margin that the radius predicts is met by flights within 5 %, whether the control counts on all flaps or not, and where it
/// does a common error has that of theory.
#[test]
fn flights_diverge_where_the_radius_says() {
    for (harmonic, survival) in [(3, 1.0), (4, 1.0), (3, 0.9), (4, 0.9)] {
        let (t, z0) = (SPEEDS[1].t(harmonic), SPEEDS[1].z0);
        let (own, step) = ((GAIN, survival), step(survival));
        let margins = law(&t).margins(&layout(), &t, step, &z0).unwrap();
        let theory = (GAIN / 2.0).acos().to_degrees();
        if survival > 0.95 {
            assert!((margins.common_phase_deg - theory).abs() < 1.0, "{margins:?}");
            assert!((margins.common_gain - 2.0 / GAIN).abs() < 1e-3, "{margins:?}");
        } else {
            // flaps in unison weigh less beside each other than they act: by up to 2 / (1 + q)
            assert!(margins.common_phase_deg < theory - 1.0, "{margins:?}");
            assert!(margins.common_gain < 2.0 / GAIN, "{margins:?}");
        }
        println!("{harmonic}/rev, q {survival}: {margins:?}");
        let parts = [0..4, 0..2, 2..4];
        let phases =
            [margins.common_phase_deg, margins.flap_phase_deg[0], margins.flap_phase_deg[1]];
        let gains = [margins.common_gain, margins.flap_gain[0], margins.flap_gain[1]];
        for ((part, phase), gain) in parts.into_iter().zip(phases).zip(gains) {
            // the side of the phase that diverges first
            let found = [1.0, -1.0].map(|side| {
                flown_margin((0.5 * phase, (1.5 * phase).min(180.0)), &z0, own, |deg| {
                    let turn = side * deg.to_radians();
                    Ok([t.clone(), t.turned_within(part.clone(), 1.0, turn)?])
                })
            });
            let found = found[0].min(found[1]);
            assert!((found / phase - 1.0).abs() < 0.05, "{harmonic} {part:?}: {found} {phase} deg");
            let found = flown_margin((0.5 * gain, 1.5 * gain), &z0, own, |gain| {
                Ok([t.clone(), t.turned_within(part.clone(), gain, 0.0)?])
            });
            assert!((found / gain - 1.0).abs() < 0.05, "{harmonic} {part:?}: {found} {gain}");
        }
        // one load alone
        for load in [0, 2, 5] {
            let margin = law(&t).load_margin(&t, step, load).unwrap();
            let sides = [1.0, -1.0].map(|side| {
                flown_margin((0.5 * margin.phase_deg, 180.0), &z0, own, |deg| {
                    Ok([t.clone(), t.with_load_turned(load, 1.0, side * deg.to_radians())?])
                })
            });
            let found = sides[0].min(sides[1]);
            println!("{harmonic}/rev, load {load}: {margin:?}, flown {found:.1} deg");
            assert!((found / margin.phase_deg - 1.0).abs() < 0.05, "{load}: {found} {margin:?}");
            if margin.gain.is_finite() {
                let found =
                    flown_margin((0.5 * margin.gain, 1.5 * margin.gain), &z0, own, |gain| {
                        Ok([t.clone(), t.with_load_turned(load, gain, 0.0)?])
                    });
                assert!((found / margin.gain - 1.0).abs() < 0.05, "{load}: {found} {margin:?}");
            }
        }
        // J rises above J0 on the way from there on, and not before
        let parts = [0..4, 0..2, 2..4];
        let overshoots = [
            margins.common_overshoot_deg,
            margins.flap_overshoot_deg[0],
            margins.flap_overshoot_deg[1],
        ];
        for (part, deg) in parts.into_iter().zip(overshoots) {
            let highest = |deg: f64| {
                let peaks = [deg, -deg].map(|deg| {
                    let turned = t.turned_within(part.clone(), 1.0, deg.to_radians()).unwrap();
                    let (ratios, _) = flown(&t, &turned, &z0, own, 40);
                    ratios.into_iter().fold(0.0, f64::max)
                });
                peaks[0].max(peaks[1])
            };
            assert!(highest(0.99 * deg) <= 1.0 + 1e-12, "{harmonic} {part:?}: {deg}");
            assert!(deg > 179.0 || highest(1.02 * deg) > 1.0, "{harmonic} {part:?}: {deg}");
        }
    }
}

/// T of one advance ratio used at another: the flown growth per cycle is the radius, and T of 0.15 diverges at 0.35 at 4/rev.
#[test]
fn t_of_another_speed_contracts_as_the_radius_says() {
    for harmonic in [3, 4] {
        for of in &SPEEDS {
            let mut row = Vec::new();
            for at in &SPEEDS {
                let (t0, t) = (of.t(harmonic), at.t(harmonic));
                let radius = law(&t0).iteration_spectral_radius(0.0, &t).unwrap();
                if radius > 0.3 {
                    let (_, moves) = flown(&t0, &t, &at.z0, (1.0, 1.0), 61);
                    let growth = (moves[30] / moves[10]).powf(1.0 / 20.0);
                    assert!((growth / radius - 1.0).abs() < 0.05, "{harmonic}: {growth} {radius}");
                }
                row.push(radius);
            }
            println!("{harmonic}/rev: {row:.2?}");
        }
    }
    let radius = law(&SPEEDS[0].t(4)).iteration_spectral_radius(0.0, &SPEEDS[2].t(4)).unwrap();
    assert!(radius > 1.0, "{radius}");
}

/// (C.6) is sufficient, not sharp: a common phase far beyond it still lowers `J`, a phase of one flap far below the margin
/// raises it on the way.
#[test]
fn the_condition_number_tells_little_of_a_common_phase() {
    let (t, z0) = (SPEEDS[1].t(4), SPEEDS[1].z0);
    let singular = law(&t).singular_values().to_vec();
    let condition = singular[0] / singular[3];
    let bound_deg = 2.0 * (1.0 / condition).atan().to_degrees();
    let after = |part: std::ops::Range<usize>, deg: f64, gain: f64| {
        let wrong = t.turned_within(part, 1.0, f64::to_radians(deg)).unwrap();
        let (ratios, _) = flown(&t, &wrong, &z0, (gain, 1.0), 60);
        (ratios[1], ratios.iter().copied().fold(0.0, f64::max))
    };
    let common = [45.0, 75.0, 85.0].map(|deg| after(0..4, deg, 0.05).0);
    let one_flap = after(2..4, 20.0, 1.0);
    println!(
        "condition {condition:.1}, bound {bound_deg:.1} deg, common {common:?}, one {one_flap:?}"
    );
    assert!(bound_deg < 5.0 && common.iter().all(|ratio| *ratio < 1.0), "{common:?}");
    assert!(one_flap.1 > 1.5, "{one_flap:?}");
}
