//! Static Preisach: the properties that define it, and agreement of its three forms.
#![expect(clippy::float_cmp, reason = "results are claimed to be equal to the last bit")]

use crate::common;
use crate::oracles;

use common::Wavy;
use oracles::everett::EverettStaircase;
use oracles::relays::RelayGrid;
use preisach_dyn::{
    ActuatorLaw, HysteresisLaw, PlayMap, PlayMemory, PreisachGrid, StartState, StaticPreisach,
    VoltageRange,
};
use proptest::prelude::*;

const LOW: f64 = -20.0;
const HIGH: f64 = 150.0;

/// A density with structure: larger near the centre of the triangle, uneven along it.
fn model(levels: usize) -> StaticPreisach {
    Wavy::WIDE.law(levels)
}

fn driven(model: &StaticPreisach, history: &[f64]) -> PlayMemory {
    let mut memory = PlayMemory::new(model.grid(), 65.0, StartState::Rest);
    for &u in history {
        model.apply(&mut memory, u);
    }
    memory
}

fn history(most: usize) -> impl Strategy<Value = Vec<f64>> {
    prop::collection::vec(LOW..HIGH, 0..most)
}

/// Two voltages, the lower first.
fn loop_ends() -> impl Strategy<Value = (f64, f64)> {
    (LOW..HIGH, LOW..HIGH).prop_map(|(a, b)| (a.min(b), a.max(b)))
}

const STATES: [StartState; 3] =
    [StartState::Rest, StartState::RisingFromLowest, StartState::FallingFromHighest];

proptest! {
    #[test]
    fn wiping_out(past in history(30), other in history(30)) {
        // an excursion over both ends erases any past: the states are equal to the last bit
        let model = model(17);
        let ends = [HIGH, LOW, 100.0];
        let a = driven(&model, &[past, ends.to_vec()].concat());
        let b = driven(&model, &[other, ends.to_vec()].concat());
        prop_assert_eq!(a, b);
    }

    #[test]
    fn a_larger_excursion_wipes_out_the_smaller_ones_inside(
        past in history(20),
        inside in prop::collection::vec(0.0..1.0_f64, 0..20),
        (low, high) in loop_ends(),
    ) {
        let model = model(17);
        let outer = [past, vec![low, high, low]].concat();
        let inner: Vec<f64> = inside.iter().map(|t| low + t * (high - low)).collect();
        let direct = driven(&model, &outer);
        let detour = driven(&model, &[outer, inner, vec![high, low]].concat());
        prop_assert_eq!(direct, detour);
    }

    #[test]
    fn return_point_memory(past in history(20), (low, high) in loop_ends()) {
        // a closed minor loop leads back to the state it left, to the last bit
        let model = model(17);
        let start = driven(&model, &[past, vec![low, high]].concat());
        let mut memory = start.clone();
        let before = model.output_deg(&memory);
        model.apply(&mut memory, low);
        let after = model.apply(&mut memory, high);
        prop_assert_eq!(&memory, &start);
        prop_assert!((after - before).abs() < 1e-12);
    }

    #[test]
    fn congruency(one in history(20), two in history(20), (low, high) in loop_ends()) {
        // minor loops between the same ends have the same shape, whatever came before
        let model = model(17);
        let shape = |past: Vec<f64>| -> Vec<f64> {
            let mut memory = driven(&model, &[past, vec![low, high]].concat());
            let top = model.output_deg(&memory);
            let steps = 40;
            let ramp = (0..=steps).map(|i| high - (high - low) * f64::from(i) / f64::from(steps));
            let back = (0..=steps).map(|i| low + (high - low) * f64::from(i) / f64::from(steps));
            ramp.chain(back).map(|u| model.apply(&mut memory, u) - top).collect()
        };
        for (a, b) in shape(one).iter().zip(shape(two)) {
            prop_assert!((a - b).abs() < 1e-12);
        }
    }

    #[test]
    fn the_output_is_continuous_and_rises_with_the_voltage(past in history(20), u in LOW..HIGH) {
        let model = model(17);
        let memory = driven(&model, &[past, vec![u]].concat());
        let here = model.output_deg(&memory);
        // steepest slope: every play at its largest density
        let steepest: f64 = model
            .map()
            .rises()
            .iter()
            .map(|row| row.iter().fold(0.0_f64, |m, r| m.max(*r)))
            .sum::<f64>()
            / model.grid().cell_volt();
        for step in [1e-9, 1e-5, 1e-2, 1.0, 30.0] {
            let up = model.apply(&mut memory.clone(), (u + step).min(HIGH));
            let down = model.apply(&mut memory.clone(), (u - step).max(LOW));
            prop_assert!(up >= here - 1e-12 && down <= here + 1e-12);
            prop_assert!(up - here <= steepest * step + 1e-12);
            prop_assert!(here - down <= steepest * step + 1e-12);
        }
    }

    #[test]
    fn the_classical_form_gives_the_same_output(
        past in prop::collection::vec(LOW..HIGH, 1..40),
        start_volt in LOW..HIGH,
        snap in any::<bool>(),
    ) {
        let model = model(17);
        let classical = EverettStaircase::of(&model);
        let cell = model.grid().cell_volt();
        // voltages on the nodes of the grid are where extremes coincide
        let node = |u: f64| if snap { LOW + ((u - LOW) / cell).round() * cell } else { u };
        for state in STATES {
            let (mut plays, a) = model.start(node(start_volt), state);
            let (mut turns, b) = classical.start(node(start_volt), state);
            prop_assert!((a - b).abs() < 1e-12, "{state:?} {a} {b}");
            for &u in &past {
                let play_form = model.step(&mut plays, node(u), 1e-3);
                let staircase = classical.step(&mut turns, node(u));
                prop_assert!((play_form - staircase).abs() < 1e-12);
            }
            prop_assert!(turns.turns() <= past.len() + 40);
        }
    }

    #[test]
    fn the_relay_grid_is_the_sum_of_its_relays(past in prop::collection::vec(LOW..HIGH, 1..40)) {
        let model = model(9);
        let grid = RelayGrid::of(&model, 3);
        prop_assert_eq!(grid.relays(), 3 * 45);
        let (mut relays, _) = grid.start(LOW, StartState::RisingFromLowest);
        for (u, one_by_one) in past.iter().zip(relay_sum(&model, &past, 3)) {
            prop_assert!((grid.step(&mut relays, *u) - one_by_one).abs() < 1e-12);
        }
    }

    #[test]
    fn a_stored_memory_continues_where_it_stopped(past in history(20), u in LOW..HIGH) {
        let model = model(17);
        let memory = driven(&model, &past);
        let stored: Vec<f64> = memory.clone().into();
        let mut restored = PlayMemory::try_from(stored).unwrap();
        prop_assert_eq!(model.apply(&mut memory.clone(), u), model.apply(&mut restored, u));
    }
}

/// Two-position relays, the definition itself: every play's density between two knots is carried
/// by `per_cell` relays in the middles of equal parts.
fn relay_sum(model: &StaticPreisach, history: &[f64], per_cell: usize) -> Vec<f64> {
    struct Relay {
        alpha: f64,
        beta: f64,
        weight: f64,
        up: f64,
    }
    let grid = model.grid();
    let mut relays = Vec::new();
    let mut base = model.map().constant;
    for (j, row) in model.map().nodes.iter().enumerate() {
        base += 0.5 * (row[0] + row[row.len() - 1]);
        for (k, pair) in row.windows(2).enumerate() {
            for part in 0..per_cell {
                let middle = (part as f64 + 0.5) / per_cell as f64;
                let s = grid.knot_volt(j, k) + middle * grid.cell_volt();
                let r = grid.half_width_volt(j);
                let weight = 0.5 * (pair[1] - pair[0]) / per_cell as f64;
                relays.push(Relay { alpha: s + r, beta: s - r, weight, up: -1.0 });
            }
        }
    }
    let mut now = LOW;
    history
        .iter()
        .map(|&u| {
            for relay in &mut relays {
                if u > now && u >= relay.alpha {
                    relay.up = 1.0;
                } else if u < now && u <= relay.beta {
                    relay.up = -1.0;
                }
            }
            now = u;
            base + relays.iter().map(|relay| relay.weight * relay.up).sum::<f64>()
        })
        .collect()
}

#[test]
fn relays_converge_to_both_continuous_forms_at_first_order() {
    let model = model(8);
    let history: Vec<f64> =
        (0..400_u32).map(|i| 65.0 + 84.0 * (f64::from(i) * 0.7391).sin()).collect();
    let output =
        |law: &dyn Fn(f64) -> f64| -> Vec<f64> { history.iter().map(|&u| law(u)).collect() };
    let memory = std::cell::RefCell::new(model.start(65.0, StartState::Rest).0);
    let plays = output(&|u| model.step(&mut memory.borrow_mut(), u, 1e-3));
    let classical = EverettStaircase::of(&model);
    let memory = std::cell::RefCell::new(classical.start(65.0, StartState::Rest).0);
    let staircase = output(&|u| classical.step(&mut memory.borrow_mut(), u));
    // a play is off by half a relay at most
    let rises = model.map().rises();
    let half_relays: f64 =
        rises.iter().map(|row| 0.5 * row.iter().fold(0.0_f64, |m, r| m.max(*r))).sum();
    for exact in [plays, staircase] {
        let errors = [2, 8, 32, 128].map(|per_cell| {
            let relays = RelayGrid::of(&model, per_cell);
            let memory = std::cell::RefCell::new(relays.start(65.0, StartState::Rest).0);
            let grainy = output(&|u| relays.step(&mut memory.borrow_mut(), u));
            let squares: f64 = grainy.iter().zip(&exact).map(|(a, b)| (a - b).powi(2)).sum();
            let error = (squares / exact.len() as f64).sqrt();
            assert!(error <= half_relays / f64::from(per_cell), "{per_cell} relays: {error}");
            error
        });
        println!("rms error of 2, 8, 32, 128 relays per cell: {errors:?} deg");
        for pair in errors.windows(2) {
            let ratio = pair[0] / pair[1];
            assert!((3.0..5.5).contains(&ratio), "four times the relays: {ratio} ({errors:?})");
        }
    }
}

#[test]
fn the_starting_states_are_what_they_say() {
    let model = model(17);
    let start = |u, state| PlayMemory::new(model.grid(), u, state);
    // coming up from the lower limit, down from the upper one
    assert_eq!(start(70.0, StartState::RisingFromLowest), driven(&model, &[LOW, 70.0]));
    assert_eq!(start(70.0, StartState::FallingFromHighest), driven(&model, &[HIGH, 70.0]));
    // demagnetised: an alternating voltage dying away about 70 V leads close to rest at 70 V
    let swings = 4000;
    let dying: Vec<f64> = (0..swings)
        .map(|i| {
            let sign = if i % 2 == 0 { 1.0 } else { -1.0 };
            (70.0 + sign * 90.0 * (1.0 - f64::from(i) / f64::from(swings))).clamp(LOW, HIGH)
        })
        .chain([70.0])
        .collect();
    let rested = model.output_deg(&start(70.0, StartState::Rest));
    let demagnetised = model.output_deg(&driven(&model, &dying));
    assert!((rested - demagnetised).abs() < 5e-3, "{rested} {demagnetised}");
}

#[test]
fn a_falling_map_is_refused() {
    let grid = PreisachGrid::new(VoltageRange::amplified_stack(), 4).unwrap();
    let mut map = PlayMap::constant(&grid, 0.0);
    map.nodes[2][1] = -0.1;
    assert!(StaticPreisach::new(grid, map.clone()).is_err());
    map.nodes[2][1] = f64::NAN;
    assert!(StaticPreisach::new(grid, map).is_err());
    let other = PreisachGrid::new(VoltageRange::amplified_stack(), 5).unwrap();
    assert!(StaticPreisach::new(other, PlayMap::constant(&grid, 0.0)).is_err());
}

/// Files of the two forms that are no laws any more: the first is the same model, the second is not.
#[test]
fn files_of_the_other_forms_are_read_or_refused() {
    let law = ActuatorLaw::StaticPreisach(model(5));
    let file = serde_json::to_string(&law).unwrap();
    let everett = file.replace("StaticPreisach", "Everett");
    assert_eq!(serde_json::from_str::<ActuatorLaw>(&everett).unwrap(), law);
    let relays = file
        .replace("StaticPreisach", "RelayGrid")
        .replace("\"g0_deg\"", "\"relays_per_cell\":3,\"g0_deg\"");
    let error = serde_json::from_str::<ActuatorLaw>(&relays).unwrap_err().to_string();
    assert!(error.contains("name the law StaticPreisach"), "{error}");
}
