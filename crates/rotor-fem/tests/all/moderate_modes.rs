//! Modes about the deflected rotating blade: closed forms, published frequencies, condensation.
#![expect(clippy::unwrap_used, reason = "a test may fail by unwrapping")]

use crate::blades;

use std::f64::consts::FRAC_PI_2;

use blades::{TM_4760_RPM, number, table, tm_4760_blade};
use nalgebra::{DMatrix, DVector};
use rotor_fem::{
    AxialMotion, BladeSpec, CoupledMode, FemError, GyroscopicTerms, ModalBlade, ModalMotion,
    ModalShape, ModeCount, ModeKind, ModerateBlade, ModerateModel, ModerateSpec, NodalMotion,
    SectionShape, StaticSettings, StaticState, Twist, deflected_modes,
};

fn at_rest(spec: ModerateSpec, elements: usize) -> (ModerateModel, StaticState) {
    let model = ModerateModel::new(ModerateBlade::new(spec).unwrap(), elements).unwrap();
    let none = DVector::zeros(model.size());
    let state = model.static_state(&none, &StaticSettings::default()).unwrap();
    (model, state)
}

fn frequencies(spec: ModerateSpec, elements: usize, kind: ModeKind, count: usize) -> Vec<f64> {
    let (model, state) = at_rest(spec, elements);
    let mut wanted = ModeCount { flap: 0, lag: 0, torsion: 0, axial: 0 };
    match kind {
        ModeKind::Flap => wanted.flap = count,
        ModeKind::Lag => wanted.lag = count,
        ModeKind::Torsion => wanted.torsion = count,
        ModeKind::Axial => wanted.axial = count,
    }
    let terms = GyroscopicTerms::Neglected;
    let modes = deflected_modes(&model, &state, terms, AxialMotion::Free, wanted).unwrap();
    modes.iter().map(|mode| mode.per_rev).collect()
}

fn table_1() -> BladeSpec {
    BladeSpec::uniform(0.0108, 0.0268, 0.006_15, 1e6)
}

#[test]
fn torsion_meets_its_closed_form() {
    for (k1, k2) in [(0.0132_f64, 0.0247_f64), (0.025, 0.025)] {
        let spec = BladeSpec {
            thickness_gyration_radius: k1.into(),
            chord_gyration_radius: k2.into(),
            area_gyration_radius: 0.0.into(),
            ..table_1()
        };
        let found = frequencies(spec.into(), 40, ModeKind::Torsion, 2);
        let polar = k1 * k1 + k2 * k2;
        for (n, got) in found.iter().enumerate() {
            let wave = (2.0 * n as f64 + 1.0) * FRAC_PI_2;
            let exact = (wave * wave * 0.006_15 / polar + (k2 * k2 - k1 * k1) / polar).sqrt();
            println!("T{} {got:.9} {exact:.9} {:.2e}", n + 1, got / exact - 1.0);
            assert!((got / exact - 1.0).abs() < 1e-6);
        }
    }
    let table = frequencies(table_1().into(), 20, ModeKind::Torsion, 2);
    println!("Table 1: {table:?}");
    assert!((table[0] / 4.588 - 1.0).abs() < 1e-4 && (table[1] / 13.522 - 1.0).abs() < 1e-4);
}

/// The tangent about the deflected state against the same blade's linear frequencies with pitch and
/// twist, where the propeller moment does not deflect it.
#[test]
fn pitch_and_twist_couple_flap_and_lag_as_in_the_table() {
    let rows = table("bo105_pitch_coupled_frequencies.csv");
    for row in &rows {
        let (pitch, rate): (f64, f64) = match row[0].as_str() {
            "pitch_0deg" => (0.0, 0.0),
            "pitch_5deg" => (5.0, 0.0),
            "pitch_10deg" => (10.0, 0.0),
            "pitch_15deg" => (15.0, 0.0),
            _ => (8.0, -8.0),
        };
        let spec = BladeSpec {
            pitch_rad: pitch.to_radians(),
            twist: Twist::Linear { rate_rad: rate.to_radians() },
            thickness_gyration_radius: 0.02.into(),
            chord_gyration_radius: 0.02.into(),
            area_gyration_radius: 0.0.into(),
            ..table_1()
        };
        let lag = frequencies(spec.clone().into(), 20, ModeKind::Lag, 2);
        let flap = frequencies(spec.into(), 20, ModeKind::Flap, 3);
        for (got, k) in [(lag[0], 1), (flap[0], 2), (flap[1], 3), (lag[1], 4), (flap[2], 5)] {
            assert!((got / number(row, k) - 1.0).abs() < 3e-6, "{} {k}: {got}", row[0]);
        }
    }
}

/// Published frequencies of the hinged nonuniform model blade.
#[test]
fn hinged_nonuniform_blade_meets_its_published_frequencies() {
    let rows = table("tm4760_mbdyn_frequencies_hz.csv");
    let speeds: Vec<f64> = rows.iter().map(|row| number(row, 0) / TM_4760_RPM).collect();
    let spec = tm_4760_blade();
    let count = ModeCount { flap: 4, lag: 2, torsion: 1, axial: 0 };
    let terms = GyroscopicTerms::Included;
    let at_speed = |speed: &f64| {
        let blade = BladeSpec { rotor_speed: *speed, ..spec.blade.clone() };
        let (model, state) = at_rest(ModerateSpec { blade, ..spec.clone() }, 30);
        deflected_modes(&model, &state, terms, AxialMotion::Free, count).unwrap()
    };
    let hz = TM_4760_RPM / 60.0;
    println!(" rpm   mode   here    published   gap %");
    for (row, modes) in rows.iter().zip(speeds.iter().map(at_speed)) {
        let of = |kind: ModeKind, number: usize| {
            let same = |mode: &&CoupledMode| mode.kind == kind && mode.number == number;
            modes.iter().find(same).unwrap().frequency * hz
        };
        // the hinged blade's first flap and lag modes are its rigid ones
        for (name, got, column, bound) in [
            ("rigid flap", of(ModeKind::Flap, 1), 2, 0.5),
            ("F1", of(ModeKind::Flap, 2), 3, 0.5),
            ("F2", of(ModeKind::Flap, 3), 4, 0.5),
            ("L1", of(ModeKind::Lag, 2), 5, 0.5),
            ("F3", of(ModeKind::Flap, 4), 6, 1.0),
            ("T1", of(ModeKind::Torsion, 1), 7, 1.0),
        ] {
            let published = number(row, column);
            if published == 0.0 {
                assert!(got < 1e-3, "{name}");
                continue;
            }
            let gap = 100.0 * (got / published - 1.0);
            println!("{:4} {name:>10} {got:8.3} {published:8.2} {gap:7.2}", row[0]);
            assert!(gap.abs() <= bound, "{name} at {} rpm: {gap} %", row[0]);
        }
    }
}

/// A blade bent by a lift-like load, with every property that couples motions.
fn bent() -> (ModerateModel, StaticState) {
    let spec = ModerateSpec {
        mass_centre: (-0.004).into(),
        tension_centre: 0.003.into(),
        ..BladeSpec {
            twist: Twist::Linear { rate_rad: -0.14 },
            pitch_rad: 0.14,
            axial_stiffness: 200.0.into(),
            ..table_1()
        }
        .into()
    };
    let model = ModerateModel::new(ModerateBlade::new(spec).unwrap(), 10).unwrap();
    let load = model.distributed_load(|x| [0.0, -2e-3 * x, 0.03 * x * x, 0.0]);
    let state = model.static_state(&load, &StaticSettings::default()).unwrap();
    (model, state)
}

/// Condensing keeps the frequencies that leaving the axial motion out destroys.
#[test]
fn condensed_axial_motion_keeps_the_frequencies() {
    let (model, state) = bent();
    let count = ModeCount::default();
    let terms = GyroscopicTerms::Included;
    let solve = |axial| deflected_modes(&model, &state, terms, axial, count).unwrap();
    let (free, condensed) = (solve(AxialMotion::Free), solve(AxialMotion::Condensed));
    for (a, b) in free.iter().zip(&condensed) {
        let gap = b.frequency / a.frequency - 1.0;
        println!("{} {}: {:.6} {:.6} {gap:.1e}", a.kind, a.number, a.frequency, b.frequency);
        let bound = if a.frequency < 5.0 { 2e-4 } else { 2e-2 };
        assert_eq!((a.kind, a.number), (b.kind, b.number));
        assert!(gap.abs() < bound, "{} {}: {gap}", a.kind, a.number);
        let shape = (&a.in_phase - &b.in_phase).norm() / a.in_phase.norm();
        assert!(shape < 0.1, "{} {}: {shape}", a.kind, a.number);
    }
    // leaving u out, by its indices 0, 6, 7 of every element
    let kept: Vec<usize> =
        model.free().iter().copied().filter(|i| ![0, 6, 7].contains(&(i % 9))).collect();
    let about = model.tangents(&NodalMotion::steady(state.dof), model.own_pitch());
    let part =
        |m: &DMatrix<f64>| DMatrix::from_fn(kept.len(), kept.len(), |i, j| m[(kept[i], kept[j])]);
    let inverse = part(&about.mass).cholesky().unwrap().l().try_inverse().unwrap();
    let reduced = &inverse * part(&about.stiffness) * inverse.transpose();
    let lowest = reduced.symmetric_eigen().eigenvalues.min().sqrt();
    println!("lowest with u left out {lowest:.4}");
    assert!(lowest > 1.02 * free.iter().map(|m| m.frequency).fold(f64::INFINITY, f64::min));
}

/// A motion over all degrees of freedom at the stations of a modal blade.
fn shape(model: &ModerateModel, dof: &DVector<f64>, stations: &[f64]) -> ModalShape {
    let at = |x: f64| {
        let s = model.section(dof, x).unwrap();
        SectionShape { lag: s.lag, flap: s.flap, twist: s.twist }
    };
    ModalShape { root: at(model.edges()[0]), sections: stations.iter().map(|x| at(*x)).collect() }
}

/// The reduced blade stands in balance where the elements do and vibrates at their frequencies: the static
/// state is its first shape, modes about it are the others.
#[test]
fn the_modal_blade_has_the_balance_and_the_frequencies_of_its_elements() {
    let (model, state) = bent();
    let (terms, count) = (GyroscopicTerms::Neglected, ModeCount::default());
    let modes = deflected_modes(&model, &state, terms, AxialMotion::Condensed, count).unwrap();
    let stations = ModalBlade::stations_of(model.edges(), 6).unwrap();
    let dofs = [&state.dof].into_iter().chain(modes.iter().map(|mode| &mode.in_phase));
    let shapes = dofs.map(|dof| shape(&model, dof, &stations)).collect();
    let blade = ModalBlade::new(model.blade(), model.edges(), 6, shapes).unwrap();
    let pitch = model.own_pitch();
    let mut still = vec![0.0; 1 + modes.len()];
    still[0] = 1.0;
    let rest = vec![0.0; still.len()];
    let force = |value: &[f64], acceleration: &[f64]| {
        blade.force(ModalMotion { value, rate: &rest, acceleration }, pitch)
    };
    let balance = force(&still, &rest);
    let loads: Vec<[f64; 4]> =
        blade.stations().iter().map(|x| [0.0, -2e-3 * x, 0.03 * x * x, 0.0]).collect();
    let at_rest = ModalMotion { value: &still, rate: &rest, acceleration: &rest };
    let left = blade.unbalanced(at_rest, pitch, &loads);
    for (mode, k) in modes.iter().zip(1..) {
        let moved = |from: &[f64], by: f64| {
            let mut out = from.to_vec();
            out[k] += by;
            out
        };
        let [ahead, behind] = [1e-5, -1e-5].map(|by| force(&moved(&still, by), &rest)[k]);
        let stiffness = (ahead - behind) / 2e-5;
        let mass = force(&still, &moved(&rest, 1.0))[k] - balance[k];
        let gap = left[k].abs();
        let square = mode.frequency.powi(2);
        let frequency = (stiffness / mass).sqrt() / mode.frequency - 1.0;
        println!(
            "{} {}: out of balance {gap:.1e}, mass {mass:.6}, frequency {frequency:.1e}",
            mode.kind, mode.number,
        );
        assert!(gap < 2e-4 * square.max(1.0), "{gap:e}");
        assert!((left[k] - balance[k]).abs() > 1e-6);
        assert!((mass - 1.0).abs() < 2e-3);
        assert!(frequency.abs() < 2e-3, "{frequency}");
    }
}

#[test]
fn as_many_modes_as_asked_and_a_named_refusal_beyond() {
    let (model, state) = bent();
    let ask = |flap| {
        let count = ModeCount { flap, lag: 6, torsion: 4, axial: 0 };
        let terms = GyroscopicTerms::Neglected;
        deflected_modes(&model, &state, terms, AxialMotion::Condensed, count)
    };
    let found = ask(6).unwrap();
    assert_eq!(found.len(), 16);
    for mode in &found {
        let about = model.tangents(&NodalMotion::steady(state.dof.clone()), model.own_pitch());
        assert!((mode.in_phase.dot(&(&about.mass * &mode.in_phase)) - 1.0).abs() < 1e-6);
    }
    assert!(matches!(ask(60), Err(FemError::TooFewModes { kind: ModeKind::Flap, .. })));
}
