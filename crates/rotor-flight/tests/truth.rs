//! The rotor of a flight against the nonlinear rotor, with 2 to 5/rev through one hysteresis.
#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]

mod common;

use common::actuator;
use hhc_control::{ControlLayout, RelaxedSettings};
use preisach_dyn::ActuatorModel;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_case::Bias;
use rotor_case::Case;
use rotor_flight::{FlapMarch, Flight, FlightState, Guidance, RotorPath, fly};
use rotor_response::{Condition, InstantDrive, RotorInTime};
use rotor_study::{HUB_OUTPUTS, TrimmedRotor, scaled, weighted};

/// The knots of a flight section by default: 0.15 to 0.30 in twenty parts.
const PARTS: u32 = 20;
const PART: f64 = 0.0075;
/// Half way between knots, where interpolation errs most.
const CONDITIONS: [f64; 2] = [0.15 + 8.5 * PART, 0.15 + 18.5 * PART];
/// Cycles of a flight: the loop closes from zero control.
const CYCLES: usize = 16;
const CYCLE_REV: [usize; 2] = [1, 2];
const ROTOR_REV_HZ: f64 = 383.0 / 60.0;

fn size(loads: &[f64; HUB_OUTPUTS]) -> f64 {
    loads.iter().map(|z| z * z).sum()
}

fn layout() -> ControlLayout {
    ControlLayout::new(2, vec![2, 3, 4, 5]).unwrap()
}

/// The control of every cycle of a closed loop at one speed, V.
fn flown(path: &RotorPath, model: &ActuatorModel, advance_ratio: f64) -> Vec<Vec<f64>> {
    let layout = layout();
    let settings = RelaxedSettings {
        gain: 0.5,
        effort_weight: 1e-13,
        amplitude_limit_volt: vec![20.0; layout.pairs()],
        rate_limit_volt: 10.0,
        ..RelaxedSettings::of_layout(&layout)
    };
    let flight = Flight {
        path,
        model,
        layout: layout.clone(),
        actuator_rev_hz: 5.0,
        bias: Bias::Centred { guess_volt: 65.0 },
        handed_t: None,
        own_actuators: vec![],
        rotor_rev_hz: ROTOR_REV_HZ,
        advance_ratio: vec![(0.0, advance_ratio)],
        thrust_share: vec![],
        duration_s: (CYCLES * CYCLE_REV.iter().sum::<usize>()) as f64 / ROTOR_REV_HZ,
        noise_share: 0.0,
        seed: 1,
        failure: None,
        cycle_rev: CYCLE_REV,
        step_volt: 4.25,
        settings,
    };
    let points = fly(&flight, &Guidance::Scheduled).unwrap();
    points.into_iter().map(|point| point.control_volt).collect()
}

/// Motions of the flaps, deg, in every revolution under the control of each cycle, through one hysteresis.
fn moved(model: &ActuatorModel, controls: &[Vec<f64>]) -> Vec<Vec<HarmonicSeries>> {
    let bias = Bias::Centred { guess_volt: 65.0 };
    let mut flaps = FlapMarch::new(model, &layout(), 5.0, bias).unwrap();
    let rev = |control_volt: &Vec<f64>| {
        let turns = flaps.revolve(control_volt).unwrap();
        turns.into_iter().map(|turn| turn.flap_deg).collect()
    };
    let cycle: usize = CYCLE_REV.iter().sum();
    controls.iter().flat_map(|control| std::iter::repeat_n(control, cycle)).map(rev).collect()
}

/// The same with every harmonic through a hysteresis of its own, the motions added: no intermodulation.
fn moved_apart(model: &ActuatorModel, controls: &[Vec<f64>]) -> Vec<Vec<HarmonicSeries>> {
    let count = layout().harmonics().len();
    let alone = |harmonic: usize| {
        let only = |control: &Vec<f64>| {
            let each = control.iter().enumerate();
            each.map(|(k, volt)| if (k / 2) % count == harmonic { *volt } else { 0.0 }).collect()
        };
        moved(model, &controls.iter().map(only).collect::<Vec<Vec<f64>>>())
    };
    let mut sum = alone(0);
    for harmonic in 1..count {
        for (sum, own) in sum.iter_mut().zip(alone(harmonic)) {
            for (sum, own) in sum.iter_mut().zip(&own) {
                // less the one less its negative
                *sum = weighted(sum, &scaled(own, -1.0), 1.0);
            }
        }
    }
    sum
}

/// The motions with one harmonic left out.
fn without(motions: &[HarmonicSeries], harmonic: usize) -> Vec<HarmonicSeries> {
    let mut motions = motions.to_vec();
    for motion in &mut motions {
        motion.set_harmonic(harmonic, Harmonic::default());
    }
    motions
}

/// Largest of `|J - J_true| / J0` and of `|Z - Z_true|^2 / J0` over the revolutions.
fn worst(pairs: &[([f64; HUB_OUTPUTS], [f64; HUB_OUTPUTS])], j0: f64) -> [f64; 2] {
    pairs.iter().fold([0.0_f64; 2], |worst, (found, truth)| {
        let off = std::array::from_fn(|k| found[k] - truth[k]);
        let cost = (size(found) - size(truth)).abs() / j0;
        [worst[0].max(cost), worst[1].max(size(&off) / j0)]
    })
}

/// A closed loop at one of the speeds, and the rotor in trim there.
struct Flown {
    advance_ratio: f64,
    controls: Vec<Vec<f64>>,
    motions: Vec<Vec<HarmonicSeries>>,
    /// Without intermodulation.
    apart: Vec<Vec<HarmonicSeries>>,
    rotor: TrimmedRotor,
    blades: usize,
    j0: f64,
}

/// The rotor of a flight, and what was flown with it.
fn all_flown() -> (RotorPath, Vec<Flown>) {
    let case = Case::default();
    let knots: Vec<f64> = (0..=PARTS).map(|k| 0.15 + PART * f64::from(k)).collect();
    let path = RotorPath::new(&case, &knots).unwrap();
    let model = actuator();
    let blades = case.rotor.blades;
    let at = |advance_ratio: f64| {
        let controls = flown(&path, &model, advance_ratio);
        let (motions, apart) = (moved(&model, &controls), moved_apart(&model, &controls));
        let rotor = TrimmedRotor::new(&Case { advance_ratio, ..case.clone() }, None).unwrap();
        let j0 = size(&rotor.trim().rotor.hub.harmonic(blades));
        Flown { advance_ratio, controls, motions, apart, rotor, blades, j0 }
    };
    let each = CONDITIONS.map(at).into();
    (path, each)
}

/// `J` in time, and the loads behind it, are those of the nonlinear rotor in trim at that speed to 2 % of `J0`. Without a
/// harmonic of the flaps, or with the nearest knot alone, they are not.
#[test]
fn loads_in_time_are_those_of_the_nonlinear_rotor() {
    let (path, each) = all_flown();
    for Flown { advance_ratio, motions, rotor, blades: nb, j0, .. } in each {
        let truth: Vec<[f64; HUB_OUTPUTS]> = motions
            .iter()
            .map(|own| {
                let rad = own.iter().map(|m| scaled(m, 1.0_f64.to_radians())).collect();
                rotor.with_flaps(rad).unwrap().hub.harmonic(nb)
            })
            .collect();
        let against =
            |advance_ratio: f64, of: &dyn Fn(&[HarmonicSeries]) -> Vec<HarmonicSeries>| {
                let state = FlightState { advance_ratio, thrust_share: 0.0 };
                let found = motions.iter().map(|own| path.loads(state, &of(own)).unwrap());
                worst(&found.zip(truth.iter().copied()).collect::<Vec<_>>(), j0)
            };
        let whole = against(advance_ratio, &<[HarmonicSeries]>::to_vec);
        let largest = truth.iter().map(size).fold(0.0, f64::max) / j0;
        let last = size(&truth[truth.len() - 1]) / j0;
        println!("{advance_ratio}: end {last:.4}, J up to {largest:.2} J0, off {whole:.5?}");
        assert!(whole[0] < 0.02 && whole[1] < 0.02, "{advance_ratio}: {whole:?}");
        let nearest = against(advance_ratio + 0.5 * PART, &<[HarmonicSeries]>::to_vec);
        println!("nearest knot: {nearest:.4?}");
        assert!(nearest[0] > 0.02, "{nearest:?}");
        for n in 2..=5 {
            let left_out = against(advance_ratio, &|own| without(own, n));
            println!("without {n}/rev: {left_out:.4?}");
            assert!(left_out[0] > 0.02, "{n}: {left_out:?}");
        }
    }
}

/// Steps of the march in a revolution.
const STEPS: usize = 288;

/// Loads at the blade number of every revolution, of the nonlinear rotor marched in time, its inflow that of the trim, every blade
/// following at its own azimuth what the flaps do in that revolution.
fn marched(
    rotor: &TrimmedRotor,
    blades: usize,
    motions: &[Vec<HarmonicSeries>],
) -> Vec<[f64; HUB_OUTPUTS]> {
    let (trim, flaps) = (rotor.trim(), motions[0].len());
    let march = RotorInTime::new(rotor.solver(), STEPS).unwrap();
    let condition = Condition {
        flight: trim.flight,
        bank_rad: trim.attitude.roll_rad,
        controls: trim.controls,
        flap_angles_rad: vec![HarmonicSeries::zero(0); flaps],
    };
    let mut now = march.start(&trim.rotor, &condition).unwrap();
    let of_turn = |turn: usize, own: &[HarmonicSeries]| {
        let mut loads = [0.0; HUB_OUTPUTS];
        let rad: Vec<_> = own.iter().map(|m| scaled(m, 1.0_f64.to_radians())).collect();
        for step in turn * STEPS + 1..=(turn + 1) * STEPS {
            let azimuth = |blade: usize| march.azimuth_rad(step, blade);
            let stations = march.lifting_stations();
            let induced = |blade: usize| trim.rotor.inflow.velocities(azimuth(blade), stations);
            let flap_rad =
                |blade: usize| rad.iter().map(|m| m.value_and_rates(azimuth(blade))).collect();
            let drive =
                InstantDrive { condition: &condition, induced: &induced, flap_rad: &flap_rad };
            now = march.step(&now, &drive, None).unwrap();
            let (sin, cos) = (blades as f64 * azimuth(0)).sin_cos();
            for (pair, load) in loads.chunks_exact_mut(2).zip(now.instant().hub) {
                pair[0] += 2.0 * load * cos / STEPS as f64;
                pair[1] += 2.0 * load * sin / STEPS as f64;
            }
        }
        loads
    };
    let mut of_turn = of_turn;
    motions.iter().enumerate().map(|(turn, own)| of_turn(turn, own)).collect()
}

/// Part of the control by which it changes in a cycle from which on `J` is not asked for: of the mean of a window, and of each of
/// its revolutions.
const SETTLING: [f64; 2] = [0.25, 0.05];

/// The same against the nonlinear rotor marched in time, in every cycle: the loads of each revolution of the window and `J` of
/// their mean, which closes the loop. Loads of a window are those of the flight to 2 % of `J0` as squares throughout, those of a
/// revolution to 3 %. `J` is in every cycle but those whose control has changed by more than a quarter: blades still ring from it.
/// Through a hysteresis for each harmonic, with the flaps of the cycle before, or without one of their harmonics, it is not.
#[test]
fn loads_in_time_are_those_of_the_rotor_marched_in_time() {
    let (path, each) = all_flown();
    for Flown { advance_ratio, controls, motions, apart, rotor, blades: nb, j0 } in each {
        let truth = marched(&rotor, nb, &motions);
        let state = FlightState { advance_ratio, thrust_share: 0.0 };
        let [settling, window] = CYCLE_REV;
        let cycle = settling + window;
        let turns = |k: usize| k * cycle + settling..(k + 1) * cycle;
        let mean = |loads: &[[f64; HUB_OUTPUTS]]| -> [f64; HUB_OUTPUTS] {
            std::array::from_fn(|i| loads.iter().map(|z| z[i]).sum::<f64>() / loads.len() as f64)
        };
        let found = |k: usize, of: &dyn Fn(usize) -> Vec<HarmonicSeries>| -> Vec<_> {
            turns(k).map(|turn| path.loads(state, &of(turn)).unwrap()).collect()
        };
        // errors of J and of Z, of the mean of a window
        let of_mean = |k: usize, of: &dyn Fn(usize) -> Vec<HarmonicSeries>| {
            worst(&[(mean(&found(k, of)), mean(&truth[turns(k)]))], j0)
        };
        let own = |turn: usize| motions[turn].clone();
        let length = |volt: &[f64]| volt.iter().map(|v| v * v).sum::<f64>().sqrt();
        let change = |k: usize| {
            let before = controls[k.saturating_sub(1)].iter();
            let moved: Vec<f64> = controls[k].iter().zip(before).map(|(a, b)| a - b).collect();
            if k == 0 { 0.0 } else { length(&moved) / length(&controls[k]) }
        };
        for k in 0..CYCLES {
            let (whole, changed) = (of_mean(k, &own), change(k));
            let pairs = found(k, &own).into_iter().zip(truth[turns(k)].iter().copied());
            let each = worst(&pairs.collect::<Vec<_>>(), j0);
            println!(
                "{advance_ratio}, cycle {k}, changed by {changed:.3}: {whole:.4?}, {each:.4?}"
            );
            assert!(whole[1] < 0.02 && each[1] < 0.03, "{advance_ratio} {k}: {whole:?} {each:?}");
            assert!(whole[0] < 0.02 || changed > SETTLING[0], "{advance_ratio} {k}: {whole:?}");
            assert!(each[0] < 0.02 || changed > SETTLING[1], "{advance_ratio} {k}: {each:?}");
        }
        let asked: Vec<usize> = (0..CYCLES).filter(|&k| change(k) <= SETTLING[0]).collect();
        assert!(asked.len() + 2 >= CYCLES, "{asked:?}");
        let most = |of: &dyn Fn(usize) -> Vec<HarmonicSeries>| {
            asked.iter().map(|&k| of_mean(k, of)[0]).fold(0.0, f64::max)
        };
        let alone = most(&|turn| apart[turn].clone());
        let before = most(&|turn| motions[turn.saturating_sub(cycle)].clone());
        println!("each harmonic alone: {alone:.4}; flaps of the cycle before: {before:.4}");
        assert!(alone > 0.02 && before > 0.02, "{alone} {before}");
        for n in 2..=5 {
            let left_out = most(&|turn| without(&motions[turn], n));
            assert!(left_out > 0.02, "{n}: {left_out:?}");
        }
    }
}
