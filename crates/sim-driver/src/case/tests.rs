//! What is accepted and what is reported, by the text of a case.

use super::{
    ActuatorSource, ActuatorValues, AerodynamicsValues, AttachedFlowModel, CompressibilityChoice,
    CouplingsChoice, InflowChoice, LoadedCase, PAPER_CASE, StructureValues, TrimValues, load_case,
    read_case, shipped_case,
};
use crate::files::{Source, ron_text, shipped};
use approx::assert_relative_eq;
use rotor_wake::{
    ControlPoint, CoreModel, FarField, FarTrailers, ReleasePoint, ShedVorticity, WakeMethod,
    WakeSymmetry,
};
use std::path::Path;

fn read(text: &str) -> Result<LoadedCase, String> {
    let source = Source { name: "case.ron".into(), text: text.into() };
    read_case(&source, &shipped("fixtures/cases")).map_err(|p| p.to_string())
}

#[test]
fn shipped_cases_are_valid_and_complete() {
    let paper = shipped_case(PAPER_CASE).unwrap();
    // the shipped text leaves nothing to a default, and the defaults are the paper's
    let short = read("()").unwrap();
    assert_eq!(short.case.structure.modes.as_array(), [5, 4, 2]);
    let modes = paper.case.structure.modes.clone();
    let structure = StructureValues { modes, ..short.case.structure.clone() };
    assert_eq!(structure, paper.case.structure);
    assert_eq!(short.case.rotor, paper.case.rotor);
    assert_eq!(short.case.trim, paper.case.trim);
    assert_eq!(short.case.control, paper.case.control);
    assert_eq!(short.case.flaps, paper.case.flaps);
    let model = paper.case.aerodynamics.model;
    let sections = AerodynamicsValues { model, ..short.case.aerodynamics.clone() };
    assert_eq!(sections, paper.case.aerodynamics);
    assert_eq!(short.actuator_source(), paper.actuator_source());
    let model = paper.case.actuator.model.clone();
    assert_eq!(ActuatorValues { model, ..short.case.actuator.clone() }, paper.case.actuator);
    assert_eq!(short.case.response, paper.case.response);
    assert_eq!(short.case.tolerances, paper.case.tolerances);
    for field in ["rotor.ka_r", "flaps[1].cg_fraction", "trim.tail_rotor_arm_r", "control.effort"] {
        assert!(paper.index.contains(field), "{field}");
    }
    let case = &paper.case;
    assert_relative_eq!(case.tip_mach(), 0.582_227, max_relative = 1e-6);
    assert_relative_eq!(case.bench_frequency_hz(4), 20.0);
    assert_eq!(
        paper.actuator_source(),
        ActuatorSource::Bench(shipped("fixtures/bench/apa500l_synthetic"))
    );
    let physical = shipped_case("paper_mu030_6p383hz.ron").unwrap().case;
    assert_relative_eq!(physical.bench_frequency_hz(4), 25.533_333, max_relative = 1e-7);
    assert_relative_eq!(
        physical.actuator.bench_rev_hz,
        physical.scales().rev_hz(),
        max_relative = 1e-14
    );
    let stalled = shipped_case("stalled_mu030.ron").unwrap().case.rotor_model();
    assert!(stalled.nonlinear.airfoils.is_some());
    assert_eq!(
        stalled.nonlinear.dynamic_stall,
        Some(rotor_response::DynamicStall::Of(flap_aero::StallAirfoil::Naca0012))
    );
    assert!(paper.case.rotor_model().nonlinear.is_linear());
    let s1 = shipped_case("crosscheck_s1.ron").unwrap().case;
    assert_eq!(s1.structure.couplings, CouplingsChoice::Linear);
    assert_eq!(s1.aerodynamics.model, AttachedFlowModel::QuasiSteady);
    assert_eq!(s1.aerodynamics.compressibility, CompressibilityChoice::None);
    assert_eq!(s1.inflow.model, InflowChoice::Prescribed { lambda_i: 0.008 });
    let TrimValues::Prescribed(given) = &s1.trim else { panic!("{:?}", s1.trim) };
    assert_relative_eq!(given.shaft_tilt_deg, 5.0);
}

#[test]
fn a_written_case_reads_back() {
    let paper = shipped_case(PAPER_CASE).unwrap();
    let text = ron_text(&paper.case).unwrap();
    assert_eq!(read(&text).unwrap().case, paper.case);
}

#[test]
fn a_field_under_its_old_name_is_read_with_a_warning() {
    let loaded = read("(\n  rotor: (unlike_blades: [(blade: 2, mass: 1.01)]),\n)").unwrap();
    assert_eq!(loaded.case.rotor.dissimilar_blades.len(), 1);
    let expected = "case.ron:2:11: rotor.unlike_blades: is named rotor.dissimilar_blades now";
    assert!(loaded.warnings[0].starts_with(expected), "{:?}", loaded.warnings);
    let said = read("(\n  rotor: (unlike_blades: [(blade: 9)]),\n)").unwrap_err();
    let expected = "case.ron:2:28: rotor.dissimilar_blades[0].blade: is 9, expected 1 to 4";
    assert!(said.starts_with(expected), "{said}");
    assert!(read("(rotor: (dissimilar_blades: []))").unwrap().warnings.is_empty());
}

#[test]
fn every_problem_is_reported_with_its_line() {
    let text = read(
        "(\n  advance_ratio: 0.6,\n  rotor: (\n    ei_flap: -0.0108,\n    radius: 5.0,\n    blades: 0,\n    gj: NaN,\n  ),\n  flaps: [(start_r: 0.7, end_r: 0.8), (start_r: 0.75, end_r: 0.85)],\n  inflow: (model: Dress),\n)",
    )
    .unwrap_err();
    let (unknown, lines): (Vec<&str>, Vec<&str>) =
        text.lines().partition(|line| line.contains("rotor.radius"));
    let known = "unknown key `radius`, did you mean `radius_m`?; known here: blades, radius_m, ";
    assert!(unknown[0].starts_with(&format!("case.ron:5:5: rotor.radius: {known}")), "{text}");
    assert_eq!(
        lines,
        [
            "case.ron:2:3: advance_ratio: is 0.6, expected 0 to 0.5; the attached-flow rotor model ends at 0.5; 0 is hover",
            "case.ron:4:5: rotor.ei_flap: is -0.0108 m0 Omega^2 R^4, expected a positive finite number; a stiffness is positive and over m0 Omega^2 R^4, not in N m^2 (paper: 0.0108)",
            "case.ron:6:5: rotor.blades: is 0, expected 1 to 16; the paper's rotor has 4",
            "case.ron:7:5: rotor.gj: is NaN m0 Omega^2 R^4, expected a positive finite number; a stiffness is positive and over m0 Omega^2 R^4, not in N m^2 (paper: 0.00615)",
            "case.ron:9:40: flaps[1].start_r: the flap spans 0.75 R to 0.85 R, expected 0.8 R (cut-out or the flap before) <= start_r < end_r <= 1 R; keep it on the blade, and list flaps from root to tip without overlap",
            "case.ron:10:12: inflow.model: unknown choice `Dress`, did you mean `Drees`?; known here: Uniform, Drees, Prescribed, PittPeters, FreeWake",
            "7 problems",
        ],
        "{text}"
    );
}

#[test]
fn the_choices_of_a_free_wake_are_read_and_checked() {
    let of = |fields: &str| read(&format!("(inflow: (model: FreeWake({fields})))"));
    let loaded =
        of("rolled_up: TipRootAndSheet, release: Centroid, control_point: ThreeQuarterChord, \
            method: Marched, panel_share: 0.3, far_turns: 6, mutual_core_r: 0.1, far_field: Single")
        .unwrap();
    let InflowChoice::FreeWake(file) = loaded.case.inflow.model else { unreachable!() };
    let settings = loaded.case.wake_trim_settings(&file);
    assert_eq!(settings.method, WakeMethod::Marched);
    let wake = settings.wake;
    assert_eq!((wake.core.panel_share, wake.far_turns), (0.3, 6));
    assert_eq!((wake.core.mutual_radius, wake.far_field), (0.1, FarField::Single));
    assert_eq!(wake.symmetry, WakeSymmetry::Periodic);
    let strided = of("velocity_stride: 2").unwrap().case;
    let InflowChoice::FreeWake(file) = strided.inflow.model else { unreachable!() };
    assert_eq!(strided.wake_trim_settings(&file).wake.velocity_stride, 2);
    // the vorticity that sections shed is in their lags, or in the wake
    assert_eq!(wake.shed, ShedVorticity::InSections);
    let steady = "(inflow: (model: FreeWake()), aerodynamics: (model: QuasiSteady))";
    let steady = read(steady).unwrap().case;
    let InflowChoice::FreeWake(file) = steady.inflow.model else { unreachable!() };
    assert_eq!(steady.wake_trim_settings(&file).wake.shed, ShedVorticity::InWake);
    let hover = "(advance_ratio: 0.0, inflow: (model: FreeWake(symmetry: Axial)))";
    let hover = read(hover).unwrap().case;
    let InflowChoice::FreeWake(axial) = hover.inflow.model else { unreachable!() };
    let axial = hover.wake_trim_settings(&axial).wake;
    assert_eq!((axial.symmetry, axial.far_turns), (WakeSymmetry::Axial, 6));
    let preset =
        "(advance_ratio: 0.0, inflow: (model: FreeWake(preset: Hover, near_wake_deg: 60)))";
    let preset = read(preset).unwrap().case;
    let InflowChoice::FreeWake(file) = preset.inflow.model else { unreachable!() };
    let hover = preset.wake_trim_settings(&file).wake;
    assert_eq!(
        (hover.symmetry, hover.core.model),
        (WakeSymmetry::Axial, CoreModel::RosenheadMoore)
    );
    assert_eq!(hover.far, FarTrailers::Stations(vec![0.35, 0.5, 0.65, 0.78]));
    assert!(
        (hover.near_wake_rad - 60.0_f64.to_radians()).abs() < 1e-12,
        "a field given comes first"
    );
    let fast = of("preset: Fast").unwrap().case;
    let InflowChoice::FreeWake(file) = fast.inflow.model else { unreachable!() };
    let fast = fast.wake_trim_settings(&file).wake;
    assert_eq!((fast.turns, fast.azimuths, fast.velocity_stride), (2, 24, 2));
    assert_eq!(wake.far, FarTrailers::Stations(vec![0.35, 0.5, 0.65, 0.78]));
    assert_eq!(wake.release, ReleasePoint::Centroid);
    assert_eq!(wake.control_point, ControlPoint::ThreeQuarterChord);
    for (fields, expected) in [
        ("control_point: QuarterChord", "inflow.model.control_point: unknown choice"),
        ("release: Tip", "inflow.model.release: unknown choice"),
        (
            "azimuths: 22",
            "inflow.model.azimuths: is refused: 22 steps per revolution do not give each of 4 blades a whole number of them; give 20 or 24",
        ),
        (
            "section_azimuths: 100",
            "inflow.model.section_azimuths: is refused: 100 is no multiple of the 36 azimuth steps of a periodic wake up to 360; give 72, or leave it out",
        ),
        ("section_azimuths: 720", "give 360, or leave it out"),
        // no multiple of what is refused itself is proposed
        (
            "azimuths: 400, section_azimuths: 400",
            "inflow.model.azimuths: is 400, expected 8 to 144",
        ),
        ("azimuths: 0, section_azimuths: 36", "inflow.model.azimuths: is 0, expected 8 to 144"),
        ("turns: 0", "inflow.model.turns: is 0"),
        ("near_wake_deg: 0.0", "inflow.model.near_wake_deg: is 0"),
        ("core_r: NaN", "inflow.model.core_r: is NaN"),
        ("mutual_core_r: -0.01", "inflow.model.mutual_core_r: is -0.01"),
        ("far_field: Float", "inflow.model.far_field: unknown choice"),
        ("velocity_stride: 4", "inflow.model.velocity_stride: is 4"),
        (
            "velocity_stride: 2, method: Marched",
            "inflow.model.velocity_stride: is refused: a march in time computes every age",
        ),
        ("symmetry: Axial", "a wake turns with its blades in hover only"),
        ("method: PC2B", "inflow.model.method: unknown choice"),
        ("panel_share: 0.0", "inflow.model.panel_share: is 0"),
        ("far_turns: 21", "inflow.model.far_turns: is 21"),
        ("tolerance: 1.0", "inflow.model.tolerance: is 1"),
    ] {
        let text = of(fields).unwrap_err();
        assert!(text.contains(expected), "{fields}: {text}");
    }
}

/// Left out, the azimuth steps of both grids are the usual ones or the next multiples of the blades above.
#[test]
fn a_free_wake_has_whole_steps_for_any_number_of_blades() {
    let of = |blades: usize| {
        let text = format!("(rotor: (blades: {blades}), inflow: (model: FreeWake()))");
        let loaded = read(&text).unwrap();
        let InflowChoice::FreeWake(file) = loaded.case.inflow.model else { unreachable!() };
        loaded.case.wake_trim_settings(&file)
    };
    for (blades, fine, coarse) in
        [(1, 36, 12), (2, 36, 12), (3, 36, 12), (4, 36, 12), (5, 40, 15), (7, 42, 14), (8, 40, 16)]
    {
        let settings = of(blades);
        assert_eq!((settings.wake.azimuths, settings.stages), (fine, vec![coarse]), "{blades}");
        assert!(settings.wake.validate(blades).is_ok());
    }
    let asked = "(rotor: (blades: 5), inflow: (model: FreeWake(azimuths: 36)))";
    let text = read(asked).unwrap_err();
    assert!(text.contains("azimuths: is refused: 36 steps per revolution do not give each of 5 blades a whole number of them; give 35 or 40"), "{text}");
}

/// One wrong value and a part of its message.
#[test]
fn single_problems_name_the_remedy() {
    for (text, expected) in [
        ("(advance_ratio: -0.1)", "case.ron:1:2: advance_ratio: is -0.1, expected 0 to 0.5"),
        ("(advance_ratio: NaN)", "advance_ratio: is NaN, expected 0 to 0.5"),
        (
            "(control: (amplitude_V: 90))",
            "control.amplitude_V: the voltage 65 V +- 90 V leaves the actuator's range -20 V to 150 V; lower control.amplitude_V to 85 V",
        ),
        ("(control: (bias_V: 200))", "leaves the actuator's range"),
        (
            "(actuator: (range_V: (150, -20)))",
            "actuator.range_V: (150, -20) is no range; give the lower limit first",
        ),
        (
            "(actuator: (model: Ideal), control: (actuators: [Ideal, Hysteretic]))",
            "control.actuators[1]: Ignored and Hysteretic need an identified actuator",
        ),
        (
            "(aerodynamics: (model: Incompressible))",
            "aerodynamics.model: Incompressible holds at Mach 0 only",
        ),
        (
            "(aerodynamics: (speed_of_sound_m_s: 150))",
            "aerodynamics.speed_of_sound_m_s: is 150 m/s, expected 208",
        ),
        ("(trim: Propulsive(ct_sigma: 0.9))", "trim.ct_sigma: is 0.9, expected 0.001 to 0.5"),
        (
            "(trim: WindTunnel(shaft_tilt_deg: 80))",
            "trim.shaft_tilt_deg: is 80 deg, expected -45 to 45 deg",
        ),
        ("(trim: Propulsive(ct: 0.07))", "unknown key `ct`"),
        ("(trim: Free)", "unknown choice `Free`"),
        ("(control: (harmonics: [[2, 2]]))", "`2` is used already"),
        (
            "(rotor: (root_pitch: [(harmonic: 3, amplitude_deg: 1, phase_deg: 0), (harmonic: 3, amplitude_deg: 1, phase_deg: 9)]))",
            "rotor.root_pitch[1].harmonic: `3` is given twice",
        ),
        (
            "(rotor: (root_pitch: [(harmonic: 2, amplitude_deg: 1, phase_deg: 0)], root_pitch_by: Swashplate))",
            "a swashplate of 4 blades gives 3 to 5 per rev",
        ),
        ("(flaps: [])", "control.harmonics: the blade has no flap to control with"),
        ("(response: (time_order: 1))", "response.time_order: is 1"),
        ("(rotor: (lock_number: 0))", "rotor.lock_number: is 0"),
        (
            "(control: (harmonics: [[]]))",
            "control.harmonics[0]: is empty; give at least one harmonic",
        ),
        ("(control: (harmonics: [[0]]))", "control.harmonics[0][0]: is 0, expected 1 to 12"),
        ("(structure: (modes: (flap: 40)))", "structure.modes.flap: is 40, expected 1 to 20"),
        (
            "(response: (time_gauss_points: 3))",
            "response.time_gauss_points: is 3, expected 5 to 32",
        ),
        ("(tolerances: (trim: 0))", "tolerances.trim: is 0, expected"),
        (
            "(inflow: (model: Prescribed(lambda_i: 3)))",
            "inflow.model.lambda_i: is 3, expected -0.2 to 0.2",
        ),
        ("(rotor: (blades: \"four\"))", "rotor.blades: has the wrong type"),
        (
            "(rotor: (omega_rpm: inf))",
            "rotor.omega_rpm: is inf rpm, expected a positive finite number",
        ),
        (
            "(flaps: [(start_r: 0.7, end_r: 0.8, cg_fraction: 1.3)])",
            "flaps[0].cg_fraction: is 1.3, expected -1 to 1",
        ),
        (
            "(flaps: [(start_r: 0.7, end_r: 0.8, gyration_fraction: 0.1)])",
            "flaps[0].gyration_fraction: is 0.1, expected 0.2 to 1",
        ),
        ("(flaps: [(start_r: 0.7, end_r: 0.8, mass: Twice)])", "unknown choice `Twice`"),
        ("(title: \"\")", "title: is empty; give one line about the case"),
        ("(rotor: (blades: 4)", "is not valid RON"),
        ("", "is not valid RON"),
    ] {
        says(text, expected);
    }
}

#[track_caller]
fn says(text: &str, expected: &str) {
    let message = read(text).expect_err(text);
    assert!(message.contains(expected), "{text}\n  gave {message}\n  wanted {expected}");
    assert!(message.starts_with("case.ron"), "{message}");
}

#[test]
fn problems_of_the_blade_name_the_remedy() {
    for (text, expected) in [
        ("(rotor: (root_offset_r: 0.6))", "rotor.root_offset_r: is 0.6 R, expected 0 to 0.5 R"),
        (
            "(rotor: (root: (flap: Spring(stiffness: -0.1))))",
            "rotor.root.flap.stiffness: is -0.1, expected 0.000001 to 10000; moment per rad",
        ),
        (
            "(rotor: (root: (pitch: Spring(stiffness: 1e-4))))",
            "rotor.root.pitch.stiffness: is 0.0001, expected 0.001 to 10000; moment per rad",
        ),
        (
            "(rotor: (root: (lag: Free)))",
            "rotor.root.lag: is refused: a lag hinge at the rotor centre has no stiffness",
        ),
        ("(response: (time_elements: 2))", "response.time_elements: is 2, expected 4 to 200"),
        (
            "(rotor: (root: (pitch: Free)))",
            "rotor.root.pitch: is refused: a blade without pitch link",
        ),
        ("(rotor: (root: (flap: Loose)))", "unknown choice `Loose`"),
        (
            "(rotor: (torque_offset_r: 0.2))",
            "rotor.torque_offset_r: is 0.2 R, expected -0.1 to 0.1",
        ),
        (
            "(rotor: (torque_offset_r: 0.01), structure: (couplings: Moderate))",
            "rotor.torque_offset_r: is refused: Moderate knows no torque offset",
        ),
        ("(rotor: (mass_centre_r: 0.2))", "rotor.mass_centre_r: is 0.2 R, expected -0.05 to 0.05"),
        (
            "(rotor: (mass_centre_r: 0.005))",
            "rotor.mass_centre_r: is refused: Linear and Full know no offsets: choose structure.couplings: Moderate",
        ),
        (
            "(structure: (untwist: Neglected))",
            "structure.untwist: is refused: Linear and Full have no such term: choose structure.couplings: Moderate",
        ),
        (
            "(structure: (couplings: Linear, twist_angle: Elastic))",
            "structure.twist_angle: is refused: Linear and Full have no such term",
        ),
        (
            "(rotor: (ei_flap: 1e300))",
            "rotor.ei_flap: is 1e300 m0 Omega^2 R^4, expected at most 1e6; a stiffness is positive",
        ),
        (
            "(rotor: (tables: (gj: [(0, 1e7), (1, 0.006)])))",
            "rotor.tables.gj[0]: is 1e7 m0 Omega^2 R^4, expected at most 1e6",
        ),
        ("(rotor: (gravity: Moon))", "unknown choice `Moon`"),
        ("(aerodynamics: (tip_loss: 1.2))", "aerodynamics.tip_loss: is 1.2 R, expected 0.5"),
        (
            "(aerodynamics: (zero_lift_deg: -20))",
            "aerodynamics.zero_lift_deg: is -20 deg, expected",
        ),
        (
            "(aerodynamics: (zero_lift_moment: -0.01, airfoils: [(station_r: 0.0, table: \"none.c81\")]))",
            "aerodynamics.zero_lift_moment: is refused: the tables of airfoils hold the camber",
        ),
        (
            "(rotor: (ei_flap: 0))",
            "rotor.ei_flap: is 0 m0 Omega^2 R^4, expected a positive finite number",
        ),
        ("(rotor: (gj: -1))", "rotor.gj: is -1 m0 Omega^2 R^4, expected a positive finite number"),
        (
            "(rotor: (tables: (mass: [(0, 1), (0.5, 1), (0.4, 1), (1, 1)])))",
            "rotor.tables.mass[2]: is 0.4 R, expected 0.5 to 1 R; list the stations from root to tip",
        ),
        (
            "(rotor: (tables: (mass: [(0, 1), (0.5, 1), (0.5, 2), (1, 1)])))",
            "rotor.tables.mass[2]: is refused: the station 0.5 R is given twice, as number 2 and number 3",
        ),
        (
            "(rotor: (tables: (mass: [(0, 1), (0.9, 1)])))",
            "rotor.tables.mass: is refused: the table reaches from 0 R to 0.9 R, the blade from 0 R to 1 R",
        ),
        (
            "(rotor: (tables: (ei_lag: [(0, 0.03), (0.3, -0.01), (1, 0.02)])))",
            "rotor.tables.ei_lag[1]: is -0.01 m0 Omega^2 R^4, expected a positive finite number",
        ),
        (
            "(flaps: [(start_r: 0.9, end_r: 1.1)])",
            "flaps[0].end_r: the flap spans 0.9 R to 1.1 R, expected",
        ),
        (
            "(rotor: (dissimilar_blades: [(blade: 5, mass: 1.01)]))",
            "rotor.dissimilar_blades[0].blade: is 5, expected 1 to 4",
        ),
        (
            "(rotor: (dissimilar_blades: [(blade: 2, mass: 3)]))",
            "rotor.dissimilar_blades[0].mass: is 3, expected 0.5 to 2",
        ),
    ] {
        says(text, expected);
    }
}

#[test]
fn places_of_results_are_in_range_each_once() {
    for (text, expected) in [
        (
            "(response: (load_stations_r: [0.5, 1.2]))",
            "response.load_stations_r[1]: is 1.2 R, expected 0 to 1 R",
        ),
        (
            "(rotor: (root_offset_r: 0.05), response: (load_stations_r: [0.01]))",
            "response.load_stations_r[0]: is 0.01 R, expected 0.05 to 1 R",
        ),
        (
            "(response: (load_stations_r: [0.5, 0.25, 0.5]))",
            "response.load_stations_r[2]: is refused: the station 0.5 R is in the list already (number 1)",
        ),
        (
            "(response: (vortex_planes_y_r: [0.4, -1.6]))",
            "response.vortex_planes_y_r[1]: is -1.6 R, expected -1.5 to 1.5 R",
        ),
        (
            "(response: (vortex_planes_y_r: [0.4, 0.4]))",
            "response.vortex_planes_y_r[1]: is refused: the plane 0.4 R is in the list already (number 1)",
        ),
    ] {
        says(text, expected);
    }
}

/// Blades with a coupled mode at a harmonic are read, for their modes, and refused before they are trimmed.
#[test]
fn an_undamped_mode_at_a_harmonic_is_refused_at_its_field() {
    // a rigid blade on a lag spring of exactly once per revolution: nu^2 = 3 k
    let rigid = "modal_damping: 0, ei_flap: 1e3, ei_lag: 1e5";
    let spring = |k: f64| format!("root: (lag: Spring(stiffness: {k}))");
    let alike = format!("(rotor: ({rigid}, {}))", spring(1.0 / 3.0));
    let unlike =
        format!("(rotor: ({rigid}, {}, unlike_blades: [(blade: 2, mass: 1.2)]))", spring(0.4));
    for (text, field) in [(alike, "rotor.modal_damping"), (unlike, "rotor.dissimilar_blades[0]")] {
        let loaded = read(&text).unwrap();
        let message = rotor_study::refuse_resonance(&loaded.case)
            .map_err(|error| loaded.located(error))
            .unwrap_err()
            .to_string();
        let place = format!(
            "{field}: lag 1 at 0.00 deg has 1.0000 per rev, near the harmonic 1 of the loads, and no damping: nothing bounds its response. Remedy: modal_damping above 0"
        );
        assert!(message.contains(&place), "{message}");
    }
    let damped = format!("(rotor: ({}, {}))", rigid.replace(": 0,", ": 0.005,"), spring(1.0 / 3.0));
    rotor_study::refuse_resonance(&read(&damped).unwrap().case).unwrap();
    // the uncoupled mode of the twisted blade is at 5 per rev, the coupled one beside it
    let twisted = "(rotor: (modal_damping: 0, ei_lag: EI), structure: (couplings: Full))";
    rotor_study::refuse_resonance(&read(&twisted.replace("EI", "0.0376")).unwrap().case).unwrap();
}

#[test]
fn weights_limits_and_harmonics_that_cannot_be_are_named_with_a_remedy() {
    for (control, field, remedy) in [
        ("power_limit_W: 2.0", "control.power_limit_W", "set control.effort to Limits"),
        ("effort: Limits, power_limit_W: -1.0", "control.power_limit_W", "no limit"),
        ("power_weight_per_W: -1e-8", "control.power_weight_per_W", "0 for no weight"),
        (
            "load_weights: (fx: 0.0, fy: 0.0, fz: 0.0, mx: 0.0, my: 0.0, mz: 0.0)",
            "control.load_weights",
            "nothing to reduce",
        ),
        ("load_weights: (fz: -1.0)", "control.load_weights.fz", "identity weight"),
        ("harmonics: [[2], [0]]", "control.harmonics[1][0]", "the paper controls"),
        ("amplitude_V: 90.0", "control.amplitude_V", "V"),
        ("effort: Given(rho: -1.0)", "control.effort.rho", "MeetStroke"),
    ] {
        let text = format!("#![enable(implicit_some)]\n(control: ({control}))");
        let problem = read(&text).unwrap_err();
        assert!(problem.contains(field) && problem.contains(remedy), "{control}: {problem}");
    }
    let text = "#![enable(implicit_some)]\n(control: (effort: Limits, power_limit_W: 2.0, power_weight_per_W: 1e-8))";
    let control = read(text).unwrap().case.control;
    assert_eq!((control.power_limit_watt, control.power_weight_per_watt), (Some(2.0), 1e-8));
}

/// A case inside the program runs without its measured files, and says so; from its file it has them.
#[test]
fn measured_files_are_read_from_disk_and_noted_where_they_are_not_shipped() {
    let inside = shipped_case("hart_ii_mn.ron").unwrap();
    assert_eq!(inside.measured.curves.len() + inside.measured.vortex_centres.len(), 0);
    assert_eq!(inside.warnings.len(), 4, "{:?}", inside.warnings);
    let note = &inside.warnings[0];
    assert!(note.contains("measured.airloads[0].file") && note.contains("run the case"), "{note}");
    let root = Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/cases");
    let on_disk = load_case(&root.join("hart_ii_mn.ron")).unwrap();
    assert!(on_disk.warnings.is_empty(), "{:?}", on_disk.warnings);
    assert_eq!(on_disk.case, inside.case);
    let names: Vec<&str> = on_disk.measured.curves.iter().map(|c| c.quantity.name()).collect();
    assert_eq!(names, ["cn_m2", "cm_m2", "flap_percent_r", "elastic_twist_deg"]);
    // the rows of this flight alone: those of the baseline begin with 0.09019
    let series = on_disk.measured.curves[0].measured.series();
    assert!((series.mean - 0.100_807).abs() < 1e-3, "{}", series.mean);
    assert_eq!((series.harmonics.len(), on_disk.measured.vortex_centres.len()), (10, 43));
    assert_eq!(on_disk.measured.inputs.len(), 4);
}
