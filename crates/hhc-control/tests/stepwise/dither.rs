//! A control that is turned to and fro so that T is learnt where limits hold it, and one that counts on flaps that fail.

use crate::rotor::SPEEDS;
use chacha20::ChaCha8Rng;
use hhc_control::{
    ControlLayout, CycleController, EstimatorSettings, RelaxedController, RelaxedSettings, TMatrix,
};
use nalgebra::{DMatrix, DVector};
use rand::SeedableRng;
use rand_distr::{Distribution, StandardNormal};

/// Draws of the noise. No setting was chosen on these.
const SEEDS: std::ops::Range<u64> = 88_000..88_020;
/// Largest amplitude, V: a limit that binds at 3/rev.
const LIMIT_VOLT: f64 = 30.0;
const RATE_VOLT: f64 = 10.0;
const CYCLES: usize = 120;

fn controller(limit_volt: f64, rate_limit_volt: f64) -> RelaxedController {
    let layout = ControlLayout::new(2, vec![3]).unwrap();
    let settings = RelaxedSettings {
        gain: 0.5,
        amplitude_limit_volt: vec![limit_volt; 2],
        rate_limit_volt,
        ..RelaxedSettings::of_layout(&layout)
    };
    RelaxedController::new(&layout, 12, settings).unwrap()
}

fn settings(dither_deg: f64) -> EstimatorSettings {
    EstimatorSettings {
        uncertainty: 0.5,
        drift: 0.25,
        dither_rad: f64::to_radians(dither_deg),
        ..EstimatorSettings::in_flight(LIMIT_VOLT)
    }
}

fn cost(loads: &[f64]) -> f64 {
    loads.iter().map(|z| z * z).sum()
}

fn loads(z0: &[f64], t: &TMatrix, u: &[f64]) -> Vec<f64> {
    z0.iter().zip(t.loads_for(u).unwrap()).map(|(z, dz)| z + dz).collect()
}

/// Least `J` within the limits.
fn least(z0: &[f64], t: &TMatrix) -> f64 {
    let mut exact = controller(LIMIT_VOLT, RATE_VOLT);
    for _ in 0..200 {
        let here = loads(z0, t, exact.control_volt());
        exact.step(t, &here).unwrap();
    }
    cost(&loads(z0, t, exact.control_volt()))
}

/// T of the rotor, which turns by 80 deg in the flight.
fn turning(cycle: usize) -> TMatrix {
    let phase_deg = 80.0 * cycle as f64 / CYCLES as f64;
    SPEEDS[1].t(3).turned(1.0, phase_deg.to_radians()).unwrap()
}

/// `J` of the last twenty cycles over the least, T turning, 3 % noise.
fn at_the_end(dither_deg: f64, seed: u64) -> f64 {
    let z0 = SPEEDS[1].z0.to_vec();
    let noise = 0.03 * (cost(&z0) / 12.0).sqrt();
    let mut random = ChaCha8Rng::seed_from_u64(seed);
    let mut flying = CycleController::new(
        controller(LIMIT_VOLT, RATE_VOLT),
        &settings(dither_deg),
        &turning(0),
        &z0,
    )
    .unwrap();
    let mut over = Vec::new();
    for cycle in 0..CYCLES {
        let t = turning(cycle);
        let mut here = loads(&z0, &t, flying.control_volt());
        if cycle + 20 >= CYCLES {
            over.push(cost(&here) / least(&z0, &t));
        }
        for load in &mut here {
            let draw: f64 = StandardNormal.sample(&mut random);
            *load += noise * draw;
        }
        flying.step(&here).unwrap();
        assert!(cycle < 10 || flying.controller().is_limited(), "the limit binds");
    }
    over.iter().sum::<f64>() / over.len() as f64
}

/// T turns by 80 deg while the limits hold both amplitudes: turned to and fro by 3 deg, the control is within 10 % of the least
/// `J` in every draw. At rest on its limits it learns nothing and is far off.
#[test]
fn t_is_learnt_where_limits_hold_the_control() {
    let worst = |dither_deg| SEEDS.map(|seed| at_the_end(dither_deg, seed)).fold(0.0, f64::max);
    let best = |dither_deg| SEEDS.map(|seed| at_the_end(dither_deg, seed)).fold(9.0, f64::min);
    let (with, without) = (worst(3.0), best(0.0));
    println!("J over the least: {with:.3} at worst with the turn, {without:.3} at best without");
    assert!(with < 1.10 && without > 1.10, "{with} {without}");
}

/// The turn keeps limits and rate, has no mean, tells flaps apart, and costs what it says: about an optimum that is free
/// `J` rises by `sin^2 a` times the loads that the control makes, flap by flap; at the centre the control is that without it.
#[test]
fn the_turn_keeps_limits_and_costs_its_square() {
    let (z0, t) = (SPEEDS[1].z0.to_vec(), SPEEDS[1].t(3));
    for (limit_volt, rate_volt) in [(LIMIT_VOLT, RATE_VOLT), (f64::INFINITY, 1e3)] {
        let turn_rad = 3.0_f64.to_radians();
        let settings = EstimatorSettings { noise_share: Some(1e-3), ..settings(3.0) };
        let mut flying =
            CycleController::new(controller(limit_volt, rate_volt), &settings, &t, &z0).unwrap();
        let mut last = vec![0.0; 4];
        let (mut turns, mut costs) = (Vec::new(), Vec::new());
        for cycle in 0..200 {
            let here = loads(&z0, &t, flying.control_volt());
            if cycle >= 196 {
                costs.push(cost(&here));
            }
            flying.step(&here).unwrap();
            let acting = flying.control_volt().to_vec();
            for (pair, from) in acting.chunks_exact(2).zip(last.chunks_exact(2)) {
                let moved = (pair[0] - from[0]).hypot(pair[1] - from[1]);
                assert!(moved <= rate_volt * (1.0 + 1e-12), "{moved}");
                assert!(pair[0].hypot(pair[1]) <= limit_volt * (1.0 + 1e-12));
            }
            if cycle >= 196 {
                let centre = flying.controller().control_volt();
                let turned = acting.chunks_exact(2).zip(centre.chunks_exact(2)).map(|(a, c)| {
                    (c[0] * a[1] - c[1] * a[0]).atan2(c[0] * a[0] + c[1] * a[1]) / turn_rad
                });
                turns.push(turned.collect::<Vec<f64>>());
            }
            last = acting;
        }
        let sum = |of: &dyn Fn(&[f64]) -> f64| turns.iter().map(|turn| of(turn)).sum::<f64>();
        assert!(turns.iter().flatten().all(|turn| (turn.abs() - 1.0).abs() < 1e-9), "{turns:?}");
        for sum in [sum(&|turn| turn[0]), sum(&|turn| turn[1]), sum(&|turn| turn[0] * turn[1])] {
            assert!(sum.abs() < 1e-9, "{turns:?}");
        }
        if limit_volt.is_infinite() {
            let centre = flying.controller().control_volt();
            let best = cost(&loads(&z0, &t, centre));
            let made = |flap: usize| {
                let mut own = [0.0; 4];
                own[2 * flap..][..2].copy_from_slice(&centre[2 * flap..][..2]);
                cost(&t.loads_for(&own).unwrap())
            };
            let told = turn_rad.sin().powi(2) * (made(0) + made(1));
            let found = costs.iter().sum::<f64>() / 4.0 - best;
            println!("the turn costs {found:.4e}, told {told:.4e}, of {best:.4e}");
            assert!((found / told - 1.0).abs() < 0.02, "{found} {told}");
        }
    }
    for wrong in [-0.1, 0.6, f64::NAN] {
        let settings = EstimatorSettings { dither_rad: wrong, ..settings(0.0) };
        assert!(
            CycleController::new(controller(LIMIT_VOLT, RATE_VOLT), &settings, &t, &z0).is_err()
        );
    }
}

/// With a chance `q` that a flap acts the step is the least of the expected `J`: the sum over which flaps act, each weighted by
/// its chance.
#[test]
fn a_flap_that_may_fail_is_leant_on_less() {
    let (z0, t) = (SPEEDS[1].z0.to_vec(), SPEEDS[1].t(3));
    let (layout, survival) = (ControlLayout::new(2, vec![3]).unwrap(), 0.8_f64);
    let of = |flap_survival| {
        let settings = RelaxedSettings { flap_survival, ..RelaxedSettings::of_layout(&layout) };
        let mut relaxed = RelaxedController::new(&layout, 12, settings).unwrap();
        relaxed.step(&t, &z0).unwrap().to_vec()
    };
    let (mut normal, mut linear) = (DMatrix::<f64>::zeros(4, 4), DVector::<f64>::zeros(4));
    for acting in 0..4_u32 {
        let acts = |flap: usize| (acting >> flap) & 1 == 1;
        let chance: f64 =
            [0, 1].map(|flap| if acts(flap) { survival } else { 1.0 - survival }).iter().product();
        let mut part = t.as_matrix().clone();
        for (k, mut column) in part.column_iter_mut().enumerate() {
            column *= if acts(k / 2) { 1.0 } else { 0.0 };
        }
        normal += part.tr_mul(&part) * chance;
        linear += part.tr_mul(&DVector::from_vec(z0.clone())) * chance;
    }
    let exact = -normal.lu().solve(&linear).unwrap();
    let (found, sure) = (of(survival), of(1.0));
    for (found, exact) in found.iter().zip(exact.iter()) {
        assert!((found - exact).abs() < 1e-9 * exact.abs().max(1.0), "{found} {exact}");
    }
    let ratio = |u: &[f64]| cost(&loads(&z0, &t, u)) / cost(&z0);
    let without = |u: &[f64], flap: usize| {
        let mut left = u.to_vec();
        left[2 * flap..][..2].fill(0.0);
        ratio(&left)
    };
    let worst = |u: &[f64]| without(u, 0).max(without(u, 1));
    println!(
        "J/J0 {:.3} and {:.3} with one flap dead; {:.3} and {:.3} where each may fail",
        ratio(&sure),
        worst(&sure),
        ratio(&found),
        worst(&found)
    );
    assert!(worst(&found) < 0.6 * worst(&sure) && ratio(&found) < 0.33);
}

/// Whichever flap stops, it leaves no more than the limit, and not less than it where the limit binds: at once, when the loop has
/// settled, with a load lost, and on the way there.
#[test]
fn a_flap_that_stops_leaves_no_more_than_the_limit() {
    let (z0, t) = (SPEEDS[1].z0.to_vec(), SPEEDS[1].t(3));
    let layout = ControlLayout::new(2, vec![3]).unwrap();
    let of = |dead_flap_cost: f64, gain: f64, lost_load: Option<usize>| {
        let base = RelaxedSettings::of_layout(&layout);
        let settings = RelaxedSettings { dead_flap_cost, gain, ..base };
        let mut relaxed = RelaxedController::new(&layout, 12, settings).unwrap();
        let weighed = |z: &[f64]| {
            let kept = z.iter().enumerate().filter(|(i, _)| Some(*i) != lost_load);
            kept.map(|(_, z)| z * z).sum::<f64>()
        };
        if let Some(load) = lost_load {
            relaxed.set_load_lost(load, true).unwrap();
        }
        let mut worst = Vec::new();
        for _ in 0..20 {
            let z = loads(&z0, &t, relaxed.control_volt());
            relaxed.step(&t, &z).unwrap();
            let without = |flap: usize| {
                let mut left = relaxed.control_volt().to_vec();
                left[2 * flap..][..2].fill(0.0);
                weighed(&loads(&z0, &t, &left)) / weighed(&z0)
            };
            worst.push(without(0).max(without(1)));
        }
        (worst, relaxed.is_held_back())
    };
    for lost_load in [None, Some(4)] {
        let (sure, is_held_back) = of(f64::INFINITY, 1.0, lost_load);
        assert!(sure[0] > 1.5 && !is_held_back, "{sure:?}");
        for limit in [1.0, 1.15, 1.4] {
            let (worst, is_held_back) = of(limit, 1.0, lost_load);
            println!("limit {limit}: {:.4} at once, {:.4} settled", worst[0], worst[19]);
            assert!(is_held_back);
            for found in [worst[0], worst[19]] {
                assert!((found - limit).abs() < 1e-9, "{limit}: {found}");
            }
            let (slow, _) = of(limit, 0.2, lost_load);
            assert!(slow.iter().all(|found| *found < limit + 1e-9), "{limit}: {slow:?}");
        }
    }
}
