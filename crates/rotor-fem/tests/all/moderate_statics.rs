//! Static deflection of the moderately deflected blade: straight-beam theory, the same energy solved
//! elsewhere, exact rods, and failures.
#![expect(clippy::unwrap_used, reason = "a test may fail by unwrapping")]

use crate::blades;

use blades::{number, princeton_blade, table};
use nalgebra::DVector;
use rotor_fem::{
    BladeSpec, Distribution, FemError, Joint, ModerateBlade, ModerateModel, ModerateSpec,
    NodalMotion, RootSupport, StaticSettings, StaticState, Twist,
};

fn model(spec: ModerateSpec, elements: usize) -> ModerateModel {
    ModerateModel::new(ModerateBlade::new(spec).unwrap(), elements).unwrap()
}

fn solve(model: &ModerateModel, load: &DVector<f64>) -> StaticState {
    model.static_state(load, &StaticSettings::default()).unwrap()
}

/// Tip `[u, v, w, phi]`.
fn tip(model: &ModerateModel, state: &StaticState) -> [f64; 4] {
    let s = model.section(&state.dof, 1.0).unwrap();
    [s.axial[0], s.lag[0], s.flap[0], s.twist[0]]
}

/// A beam of length and bending stiffness 1 at rest.
fn unit_beam(axial_stiffness: f64) -> ModerateSpec {
    BladeSpec { rotor_speed: 0.0, ..BladeSpec::uniform(1.0, 3.0, 1.0, axial_stiffness) }.into()
}

/// The unit beam with another root.
fn held_by(root: RootSupport) -> ModerateSpec {
    let spec = unit_beam(1e4);
    ModerateSpec { blade: BladeSpec { root, ..spec.blade.clone() }, ..spec }
}

/// In a plane the energy is linear but for the foreshortening: P L^3 / 3 EI whatever the load, and a
/// shortening by its slopes alone.
#[test]
fn planar_dead_load_is_linear_and_the_gap_to_the_elastica_is_known() {
    let model = model(unit_beam(1e6), 4);
    println!("P L^2 / EI   w/L here     exact        gap %     shortening here, exact");
    for row in table("elastica_exact.csv") {
        let [load, exact, short] = [1, 2, 3].map(|k| number(&row, k));
        // far beyond the theory: the two formulas are all there is to say
        if row[0] != "dead" || load > 3.0 {
            continue;
        }
        let state = solve(&model, &model.tip_load([0.0, 0.0, load], 0.0));
        let [u, _, w, _] = tip(&model, &state);
        println!(
            "{load:6.2}  {w:12.8} {exact:12.8} {:8.2}   {:.6} {short:.6}",
            100.0 * (w / exact - 1.0),
            -u
        );
        assert!((w / (load / 3.0) - 1.0).abs() < 1e-9, "{load}: {w}");
        // integral of s^2 / 2 + s^4 / 8 with s = P (x - x^2 / 2)
        let shortening = load.powi(2) / 15.0 + load.powi(4) / 315.0;
        assert!((-u / shortening - 1.0).abs() < 1e-5, "{load}: {u}");
        // the theory leaves the exact rod with the square of the deflection
        assert!(w > exact && (load > 1.0 || (w / exact - 1.0) < 0.12 * load * load), "{load}");
    }
}

/// The stretch must not lock the bending: thin beams, one element.
#[test]
fn bending_does_not_lock() {
    for axial in [1e3, 1e6, 1e8] {
        let model = model(unit_beam(axial), 1);
        let settings = StaticSettings { tolerance: 1e-7, ..StaticSettings::default() };
        let state = model.static_state(&model.tip_load([0.0, 0.0, 0.6], 0.0), &settings).unwrap();
        let [_, _, w, _] = tip(&model, &state);
        assert!((w - 0.2).abs() < 1e-6, "{axial:e}: {w}");
    }
}

/// Largest errors of displacement and twist over the table, relative to the row's largest displacement
/// and twist.
fn princeton_errors(elements: usize, file: &str, columns: [usize; 3]) -> Vec<[f64; 3]> {
    let rows = table(file);
    rows.iter()
        .map(|row| {
            let (load, angle) = (number(row, 0), number(row, 1).to_radians());
            let model = model(princeton_blade(), elements);
            let force = [0.0, -load * angle.cos(), load * angle.sin()];
            let state = solve(&model, &model.tip_load(force, 0.0));
            let [_, v, w, phi] = tip(&model, &state);
            let [uy, uz, twist] = columns.map(|k| number(row, k));
            let length = blades::PRINCETON_LENGTH_M;
            let size = uy.hypot(uz) / length;
            let gap = (v - uy / length).hypot(w - uz / length) / size;
            let turn = if twist == 0.0 { phi.abs() } else { phi.to_degrees() / twist - 1.0 };
            [size, gap, turn]
        })
        .collect()
}

/// What the moderate-deflection energy itself misses: small below w/L 0.1, large beyond 0.2.
#[test]
fn distance_to_the_exact_rod_grows_with_the_square_of_the_deflection() {
    let errors = princeton_errors(10, "princeton_exact_kirchhoff.csv", [3, 4, 5]);
    println!("  w/L     displacement %   twist %");
    for [size, gap, turn] in &errors {
        println!("{size:6.4}  {:10.2} {:14.2}", 100.0 * gap, 100.0 * turn);
        if *size > 0.05 {
            let scaled = gap / size.powi(2);
            assert!((0.9..2.2).contains(&scaled), "{size}: {scaled}");
        } else {
            assert!(*gap < 4e-3);
        }
    }
}

fn rotating() -> BladeSpec {
    BladeSpec {
        twist: Twist::Linear { rate_rad: -0.14 },
        pitch_rad: 0.14,
        precone_rad: 0.03,
        root_offset: 0.04,
        mass: Distribution::PiecewiseConstant {
            edges: vec![0.0, 0.43, 1.0],
            values: vec![1.3, 1.0],
        },
        ..BladeSpec::uniform(0.0108, 0.0268, 0.006_15, 200.0)
    }
}

/// At rest in the rotating frame the forces have a potential: symmetric stiffness, skew gyroscopic
/// matrix, positive symmetric mass; and the tension carries the centrifugal force.
#[test]
fn the_deflected_rotating_blade_is_in_balance() {
    let spec = ModerateSpec {
        mass_centre: (-0.004).into(),
        tension_centre: 0.003.into(),
        ..BladeSpec {
            root: RootSupport {
                flap: Joint::Spring { stiffness: 0.05 },
                lag: Joint::Spring { stiffness: 0.1 },
                feather: Joint::Spring { stiffness: 0.01 },
            },
            ..rotating()
        }
        .into()
    };
    let model = model(spec, 10);
    let load = model.distributed_load(|x| [0.0, -1e-3 * x, 8e-3 * x * x, -2e-6]);
    let state = solve(&model, &load);
    println!("tip {:?}, {} steps, {:e}", tip(&model, &state), state.iterations, state.residual);
    assert!(state.load_factor >= 1.0 && state.residual < 1e-9);
    let about = model.tangents(&NodalMotion::steady(state.dof.clone()), model.own_pitch());
    let gap = |m: &nalgebra::DMatrix<f64>, sign: f64| (m - m.transpose() * sign).amax() / m.amax();
    assert!(gap(&about.stiffness, 1.0) < 1e-13);
    assert!(gap(&about.mass, 1.0) < 1e-14);
    assert!(gap(&about.damping, -1.0) < 1e-14);
    assert!(about.mass.cholesky().is_some());
    let centrifugal = |x: f64| {
        let inner = if x < 0.43 { 1.3 * (0.43_f64.powi(2) - x * x) } else { 0.0 };
        0.5 * (inner + 1.0 - x.max(0.43).powi(2)) * 0.03_f64.cos().powi(2)
    };
    for [x, tension] in model.tension(&state.dof, model.own_pitch()) {
        // foreshortening, stretch and the slope take a little away
        assert!((tension - centrifugal(x)).abs() < 4e-3, "{x}: {tension}");
    }
    // the reactions of the held root balance the whole: vertical force against load and precone
    let mut motion = NodalMotion::steady(state.dof.clone());
    motion.rate.fill(0.0);
    let reaction = model.force(&motion, model.own_pitch());
    let lift: f64 = 8e-3 * (1.0 - 0.04_f64.powi(3)) / 3.0;
    let u: f64 = model.distributed_load(|_| [1.0, 0.0, 0.0, 0.0]).dot(&state.dof);
    let mass_moment = 0.5 * (1.3 * (0.43_f64.powi(2) - 0.0016) + 1.0 - 0.43_f64.powi(2));
    let (s, c) = 0.03_f64.sin_cos();
    let w: f64 = model.distributed_load(|_| [0.0, 0.0, 1.0, 0.0]).dot(&state.dof);
    let up = s * c * (mass_moment + u) - s * s * w;
    assert!((reaction[3] - (up - lift)).abs() < 2e-4, "{} {}", reaction[3], up - lift);
}

/// Feathering against a soft pitch link: a tip moment turns the whole blade by M (1/k + L/GJ).
#[test]
fn pitch_link_and_hinge_springs_carry_their_moments() {
    let spec = held_by(RootSupport {
        flap: Joint::Spring { stiffness: 2.0 },
        lag: Joint::Locked,
        feather: Joint::Spring { stiffness: 0.5 },
    });
    let beam = model(spec, 3);
    let twisted = solve(&beam, &beam.tip_load([0.0; 3], 1e-3));
    assert!((tip(&beam, &twisted)[3] - 3e-3).abs() < 1e-9);
    let bent = solve(&beam, &beam.tip_load([0.0, 0.0, 1e-3], 0.0));
    assert!((tip(&beam, &bent)[2] - 1e-3 * (1.0 / 2.0 + 1.0 / 3.0)).abs() < 1e-9);
    assert_eq!(beam.free().len(), 9 * 3 + 2);
}

/// A pull along the elastic axis bends a beam whose tension centre lies off it: `v_xx = N e_A / EI_z`.
#[test]
fn an_offset_tension_centre_bends_under_tension() {
    let spec = ModerateSpec { tension_centre: 0.01.into(), ..unit_beam(1e4) };
    let beam = model(spec, 4);
    let pull = 1e-3;
    let state = solve(&beam, &beam.tip_load([pull, 0.0, 0.0], 0.0));
    let [u, v, w, _] = tip(&beam, &state);
    assert!((v / (pull * 0.01 / (2.0 * 3.0)) - 1.0).abs() < 1e-3, "{v}");
    assert!(w.abs() < 1e-12 && (u - pull / 1e4).abs() < 1e-6);
}

/// Closed equilibria of a stiff rotating blade: its hinges and bearing turn until nothing is out of balance.
#[test]
fn hinges_and_bearing_turn_to_their_closed_equilibria() {
    let stiff = |root: RootSupport, offset: f64, precone_rad: f64, pitch_rad: f64| {
        let blade = BladeSpec {
            root_offset: 0.1,
            precone_rad,
            pitch_rad,
            root,
            ..BladeSpec::uniform(50.0, 50.0, 50.0, 1e5)
        };
        let model = model(ModerateSpec { mass_centre: offset.into(), ..blade.into() }, 6);
        let state = solve(&model, &DVector::zeros(model.size()));
        let s = model.section(&state.dof, 0.1).unwrap();
        [s.lag[1], s.flap[1], s.twist[0]]
    };
    let held = RootSupport::CLAMPED;
    // lag hinge: the mass centre of the whole blade lies on the radius through the hinge
    let [lag, _, _] = stiff(RootSupport { lag: Joint::Free, ..held }, 0.004, 0.0, 0.0);
    assert!((lag / (-2.0 * 0.004 / 0.9) - 1.0).abs() < 3e-3, "{lag}");
    // flap hinge: a preconed blade returns to the plane of rotation
    let [_, flap, _] = stiff(RootSupport { flap: Joint::Free, ..held }, 0.0, 0.03, 0.0);
    assert!((flap / -0.03 - 1.0).abs() < 2e-3, "{flap}");
    // bearing: the propeller moment against the pitch link
    let link = RootSupport { feather: Joint::Spring { stiffness: 0.02 }, ..held };
    let [_, _, turn] = stiff(link, 0.0, 0.0, 0.2);
    let moment = 0.9 * (0.0247_f64.powi(2) - 0.0132_f64.powi(2));
    let closed = |turn: f64| -moment * (0.2 + turn).sin() * (0.2 + turn).cos() / 0.02;
    assert!((turn / closed(turn) - 1.0).abs() < 2e-3, "{turn} {}", closed(turn));
}

#[test]
fn a_static_state_that_is_not_found_is_reported_with_the_last_good_one() {
    // a free hinge without rotation carries no load
    let spec = held_by(RootSupport { flap: Joint::Free, ..RootSupport::CLAMPED });
    let beam = model(spec, 3);
    let failed = beam
        .static_state(&beam.tip_load([0.0, 0.0, 0.1], 0.0), &StaticSettings::default())
        .unwrap_err();
    let FemError::NoStaticState { iterations, residual, load_factor, last, .. } = &failed else {
        panic!("{failed}");
    };
    println!("{failed}");
    assert!(*iterations > 0 && *residual > 1e-6 && *load_factor < 1.0);
    assert!(
        last.dof.iter().all(|x| x.is_finite()) && (last.load_factor - load_factor).abs() < 1e-15
    );
}

#[test]
fn bad_blades_and_settings_are_named_with_the_remedy() {
    let good = || ModerateSpec::from(rotating());
    let message = |spec: ModerateSpec| ModerateBlade::new(spec).unwrap_err().to_string();
    let blade = |blade: BladeSpec| ModerateSpec { blade, ..good() };
    let gap = Distribution::PiecewiseConstant { edges: vec![0.04, 0.8], values: vec![1.0] };
    let disorder =
        Distribution::PiecewiseLinear { stations: vec![0.0, 0.6, 0.5, 1.0], values: vec![0.01; 4] };
    let cases: [(ModerateSpec, &[&str]); 9] = [
        (
            blade(BladeSpec { flap_stiffness: 0.0.into(), ..rotating() }),
            &["flap_stiffness", "correct"],
        ),
        (
            blade(BladeSpec { torsion_stiffness: (-0.1).into(), ..rotating() }),
            &["torsion_stiffness"],
        ),
        (blade(BladeSpec { axial_stiffness: f64::NAN.into(), ..rotating() }), &["axial_stiffness"]),
        (blade(BladeSpec { mass: gap.clone(), ..rotating() }), &["mass", "0.8", "extend"]),
        (
            blade(BladeSpec { flap_stiffness: disorder.clone(), ..rotating() }),
            &["index 2", "0.5", "sort"],
        ),
        (ModerateSpec { mass_centre: gap, ..good() }, &["mass_centre", "extend"]),
        (ModerateSpec { tension_centre: disorder, ..good() }, &["tension_centre", "sort"]),
        (ModerateSpec { mass_centre: 0.03.into(), ..good() }, &["chord_gyration_radius", "square"]),
        (
            blade(BladeSpec {
                root: RootSupport {
                    feather: Joint::Spring { stiffness: -1.0 },
                    ..RootSupport::CLAMPED
                },
                ..rotating()
            }),
            &["root.feather.stiffness", "below zero"],
        ),
    ];
    for (spec, words) in cases {
        let text = message(spec);
        for word in words {
            let word = word.replace("index 2", "station 2");
            assert!(text.contains(&word), "{word}: {text}");
        }
    }
    let beam = model(good(), 2);
    let mut load = DVector::zeros(beam.size());
    for (settings, field) in [
        (StaticSettings { tolerance: 0.0, ..StaticSettings::default() }, "tolerance"),
        (StaticSettings { iterations: 1, ..StaticSettings::default() }, "iterations"),
        (StaticSettings { smallest_step: f64::NAN, ..StaticSettings::default() }, "smallest_step"),
    ] {
        let text = beam.static_state(&load, &settings).unwrap_err().to_string();
        assert!(text.contains(field), "{text}");
    }
    let short = DVector::zeros(5);
    let text = beam.static_state(&short, &StaticSettings::default()).unwrap_err().to_string();
    assert!(text.contains("load has 5 entries"), "{text}");
    load[9] = f64::NAN;
    let text = beam.static_state(&load, &StaticSettings::default()).unwrap_err().to_string();
    assert!(text.contains("load"), "{text}");
    assert!(ModerateModel::new(ModerateBlade::new(good()).unwrap(), 0).is_err());
}
