//! The ranges of every value of a case, and the rules between values.

use super::checker::{Checker, Number};
use super::ranges_blade::check_blade;
use super::{
    ActuatorChoice, CaseFile, CirculationChoice, CompressibilityChoice, ControlActuator,
    ControllerChoice, EffortChoice, FreeWakeFile, HorizontalTailFile, InflowChoice,
    SectionModelChoice, StrokeChoice, SymmetryChoice, TInflowChoice, TrimFile, WakeMethodChoice,
};
use crate::problem::Fault;
use std::f64::consts::TAU;

/// Checks every value of a case.
pub(super) fn check_case(check: &mut Checker<'_>, file: &CaseFile) {
    check_flight(check, file);
    check_rotor(check, file);
    check_flaps(check, file);
    check_section(check, file);
    check_trim(check, &file.trim);
    check_actuator(check, file);
    check_control(check, file);
    check_numerics(check, file);
}

pub(super) fn number<'a>(
    field: &'a str,
    value: f64,
    unit: &'static str,
    remedy: &'static str,
) -> Number<'a> {
    Number { field, value, unit, remedy }
}

fn check_flight(check: &mut Checker<'_>, file: &CaseFile) {
    if file.title.trim().is_empty() {
        check.fault("title", Fault::EmptyText { of: "one line about the case" });
    }
    let remedy = "the attached-flow rotor model ends at 0.5; 0 is hover";
    check.within(number("advance_ratio", file.advance_ratio, "", remedy), 0.0, 0.5);
    if let InflowChoice::Prescribed { lambda_i } = file.inflow.model {
        let remedy = "give the induced inflow over the tip speed, down positive (0.01 is usual)";
        check.within(number("inflow.model.lambda_i", lambda_i, "", remedy), -0.2, 0.2);
    }
    if let InflowChoice::FreeWake(wake) = &file.inflow.model {
        check_wake(check, wake, file.rotor.blades);
        check_axial(check, wake, file.advance_ratio);
        check_circulation(check, wake);
    }
}

fn check_wake(check: &mut Checker<'_>, wake: &FreeWakeFile, blades: usize) {
    let at = |key: &str| format!("inflow.model.{key}");
    let azimuths = wake.azimuths_for(blades);
    check.count(&at("azimuths"), azimuths, (8, 144), "36 are steps of 10 deg");
    if !azimuths.is_multiple_of(blades.max(1)) {
        let (below, above) = (azimuths - azimuths % blades, azimuths.next_multiple_of(blades));
        let message = format!(
            "{azimuths} steps per revolution do not give each of {blades} blades a whole number of them; give {below} or {above}, or leave it out"
        );
        check.fault(&at("azimuths"), Fault::Refused { message });
    }
    check.count(&at("turns"), wake.turns, (1, 12), "4 are usual in forward flight");
    let far_turns = wake.far_turns.unwrap_or_default();
    check.count(&at("far_turns"), far_turns, (0, 20), "2 are usual, 6 in hover");
    check.count(&at("panels"), wake.panels, (6, 60), "20 are usual");
    check.count(&at("updates"), wake.updates, (1, 200), "30 are usual");
    check.count(&at("velocity_stride"), wake.velocity_stride, (1, 3), "1 computes every age");
    if wake.velocity_stride > 1 && wake.method == WakeMethodChoice::Marched {
        let message = "a march in time computes every age: leave it out, or give method: Relaxed";
        check.fault(&at("velocity_stride"), Fault::Refused { message: message.to_owned() });
    }
    for (key, value, low, high, unit, remedy) in [
        ("near_wake_deg", wake.near_wake_deg, 1.0, 1440.0, "deg", "360 is one revolution"),
        ("core_r", wake.core_r, 1e-3, 0.2, "R", "about a third of the chord is usual"),
        (
            "near_core_r",
            wake.near_core_r.unwrap_or(0.05),
            1e-3,
            0.2,
            "R",
            "leave it out for the chord of the blade",
        ),
        ("mutual_core_r", wake.mutual_core_r, 0.0, 0.2, "R", "0.05 is usual, 0.1 at low speed"),
        (
            "panel_share",
            wake.panel_share,
            0.01,
            1e6,
            "",
            "0.3 is usual; a large number is no limit",
        ),
        ("tolerance", wake.tolerance, 1e-8, 1e-2, "", "2e-4 of the tip speed is usual"),
        (
            "displacement_tolerance_r",
            wake.displacement_tolerance_r,
            1e-8,
            0.5,
            "R",
            "0.002 R is usual",
        ),
    ] {
        check.within(number(&at(key), value, unit, remedy), low, high);
    }
}

fn check_circulation(check: &mut Checker<'_>, wake: &FreeWakeFile) {
    let CirculationChoice::Prescribed(given) = wake.circulation else { return };
    let at = |key: &str| format!("inflow.model.circulation.{key}");
    for (key, value, low, high, unit, remedy) in [
        ("ct_sigma", given.ct_sigma, 1e-4, 0.3, "", "0.07 is usual"),
        (
            "shaft_tilt_deg",
            given.shaft_tilt_deg,
            -85.0,
            85.0,
            "deg",
            "5 is usual, forward positive",
        ),
    ] {
        check.within(number(&at(key), value, unit, remedy), low, high);
    }
}

/// Refuses an axial wake in forward flight.
fn check_axial(check: &mut Checker<'_>, wake: &FreeWakeFile, advance_ratio: f64) {
    if wake.symmetry == SymmetryChoice::Axial {
        let remedy = "a wake turns with its blades in hover only; leave inflow.model.symmetry out";
        check.within(number("advance_ratio", advance_ratio, "", remedy), 0.0, 0.0);
    }
}

/// Largest bending and torsion stiffness, over `m0 Omega^2 R^4`: beyond it the frequencies of a blade leave no
/// digits for those of the others.
pub(super) const RIGID: f64 = 1e6;
/// Largest axial stiffness, over `m0 Omega^2 R^2`.
pub(super) const RIGID_ALONG: f64 = 1e9;
/// Largest radius (m), speed (rpm), mass (kg/m) and radius of gyration (R): beyond that of anything that turns.
const LARGEST: f64 = 1e6;

fn check_rotor(check: &mut Checker<'_>, file: &CaseFile) {
    let r = &file.rotor;
    check.count("rotor.blades", r.blades, (1, 16), "the paper's rotor has 4");
    for (field, value, unit, remedy) in [
        ("rotor.radius_m", r.radius_m, "m", "the paper's rotor has 4.94 m"),
        ("rotor.omega_rpm", r.omega_rpm, "rpm", "the paper's rotor turns at 383 rpm"),
        ("rotor.mass_kg_m", r.mass_kg_m, "kg/m", "the paper's blade has 6.46 kg/m"),
        ("rotor.km1_r", r.km1_r, "R", "a radius of gyration is positive (0.0132 R is usual)"),
        ("rotor.km2_r", r.km2_r, "R", "a radius of gyration is positive (0.0247 R is usual)"),
    ] {
        check.positive(number(field, value, unit, remedy));
        check.no_more(number(field, value, unit, remedy), LARGEST);
    }
    for (field, value, most, remedy) in [
        (
            "rotor.ei_flap",
            r.ei_flap,
            RIGID,
            "a stiffness is positive and over m0 Omega^2 R^4, not in N m^2 (paper: 0.0108)",
        ),
        (
            "rotor.ei_lag",
            r.ei_lag,
            RIGID,
            "a stiffness is positive and over m0 Omega^2 R^4, not in N m^2 (paper: 0.0268)",
        ),
        (
            "rotor.gj",
            r.gj,
            RIGID,
            "a stiffness is positive and over m0 Omega^2 R^4, not in N m^2 (paper: 0.00615)",
        ),
        (
            "rotor.ea",
            r.ea,
            RIGID_ALONG,
            "a stiffness is positive and over m0 Omega^2 R^2, not in N (1000 is usual)",
        ),
    ] {
        check.positive(number(field, value, "", remedy));
        check.no_more(number(field, value, "", remedy), most);
    }
    check_rotor_ranges(check, file);
    check_blade(check, file);
    check_structure(check, file);
}

fn check_rotor_ranges(check: &mut Checker<'_>, file: &CaseFile) {
    let r = &file.rotor;
    for (field, value, low, high, unit, remedy) in [
        ("rotor.chord_r", r.chord_r, 1e-3, 0.5, "R", "the paper's blade has 0.055 R"),
        ("rotor.lock_number", r.lock_number, 1e-2, 50.0, "", "the paper's rotor has 5.20"),
        ("rotor.ka_r", r.ka_r, 0.0, 0.5, "R", "0.029 R is usual"),
        ("rotor.twist_deg", r.twist_deg, -45.0, 45.0, "deg", "nose-down twist is negative"),
        ("rotor.precone_deg", r.precone_deg, -10.0, 10.0, "deg", "up is positive"),
        ("rotor.root_cutout_r", r.root_cutout_r, 0.0, 0.9, "R", "0.2 R is usual"),
        ("rotor.modal_damping", r.modal_damping, 0.0, 0.5, "", "give a fraction: 0.005 is 0.5 %"),
    ] {
        check.within(number(field, value, unit, remedy), low, high);
    }
}

fn check_structure(check: &mut Checker<'_>, file: &CaseFile) {
    let s = &file.structure;
    check.count("structure.elements", s.elements, (2, 200), "the paper uses 10");
    let most = 2 * s.elements;
    let remedy = "as many as the elements resolve: the paper keeps 4, 4 and 2";
    check.count("structure.modes.flap", s.modes.flap, (1, most), remedy);
    check.count("structure.modes.lag", s.modes.lag, (1, most), remedy);
    check.count("structure.modes.torsion", s.modes.torsion, (1, most), remedy);
}

/// Slowest tip for which the sections take a Mach number.
const LEAST_TIP_MACH: f64 = 1e-3;

/// What a flap effectiveness is.
const EFFECTIVE: &str = "1 is thin-aerofoil theory; a real flap makes about 0.8 of its lift";

fn check_flaps(check: &mut Checker<'_>, file: &CaseFile) {
    let mut from_r = file.rotor.root_cutout_r.max(file.rotor.root_offset_r);
    for (i, flap) in file.flaps.iter().enumerate() {
        let (start_r, end_r) = (flap.start_r, flap.end_r);
        if start_r >= from_r && end_r > start_r && end_r <= 1.0 {
            from_r = end_r;
        } else {
            let end = start_r >= from_r && start_r < 1.0;
            let field = if end { "end_r" } else { "start_r" };
            check.fault(&format!("flaps[{i}].{field}"), Fault::FlapSpan { start_r, end_r, from_r });
        }
        for (key, value, low, high, remedy) in [
            ("chord_fraction", flap.chord_fraction, 0.05, 0.5, "the paper's flap has 0.20 chord"),
            (
                "mass_fraction",
                flap.mass_fraction,
                0.0,
                1.0,
                "the flap's mass is part of the blade's",
            ),
            (
                "cg_fraction",
                flap.cg_fraction,
                -1.0,
                1.0,
                "behind the hinge is positive, 1 is the trailing edge",
            ),
            ("effectiveness.lift", flap.effectiveness.lift, 0.0, 2.0, EFFECTIVE),
            ("effectiveness.moment", flap.effectiveness.moment, 0.0, 2.0, EFFECTIVE),
            ("effectiveness.hinge", flap.effectiveness.hinge, 0.0, 2.0, EFFECTIVE),
        ] {
            check.within(number(&format!("flaps[{i}].{key}"), value, "", remedy), low, high);
        }
        if let Some(gyration) = flap.gyration_fraction {
            let remedy = "it is about the hinge: at least the distance of the centre of gravity; leave it out for a thin rod";
            let field = format!("flaps[{i}].gyration_fraction");
            check.within(
                number(&field, gyration, "", remedy),
                flap.cg_fraction.abs().min(1.0),
                1.0,
            );
        }
    }
}

fn check_section(check: &mut Checker<'_>, file: &CaseFile) {
    let a = &file.aerodynamics;
    let remedy = "0.01 is usual";
    let drag = number("aerodynamics.drag_coefficient", a.drag_coefficient, "", remedy);
    check.within(drag, 0.0, 1.0);
    let remedy = "1 is no loss, 0.97 is usual; outboard of the root cut-out";
    let least = file.rotor.root_cutout_r.max(0.5);
    check.within(number("aerodynamics.tip_loss", a.tip_loss, "R", remedy), least, 1.0);
    let field = "aerodynamics.speed_of_sound_m_s";
    let remedy = "340.3 m/s is the standard atmosphere at sea level; the tip must stay subsonic";
    let tip_speed = file.rotor.omega_rpm * TAU / 60.0 * file.rotor.radius_m;
    let lowest = if tip_speed.is_finite() { (tip_speed / 0.95).max(1.0) } else { 1.0 };
    check.within(number(field, a.speed_of_sound_m_s, "m/s", remedy), lowest, 2000.0);
    let is_slow = tip_speed > 0.0 && tip_speed < LEAST_TIP_MACH * a.speed_of_sound_m_s;
    if is_slow && a.compressibility == CompressibilityChoice::LocalMach {
        let message = format!(
            "the tip moves at {tip_speed:.3e} m/s, Mach {:.1e}: below Mach {LEAST_TIP_MACH} compressibility means nothing; give the speed in rpm (the paper's rotor turns at 383), or set aerodynamics.compressibility: None",
            tip_speed / a.speed_of_sound_m_s
        );
        check.fault("rotor.omega_rpm", Fault::Refused { message });
    }
    if a.model == SectionModelChoice::Incompressible
        && a.compressibility != CompressibilityChoice::None
    {
        check.fault("aerodynamics.model", Fault::IncompressibleWithMach);
    }
    if a.model == SectionModelChoice::Calibrated {
        let remedy = "the calibrated section model holds for these; or choose another model";
        for (i, flap) in file.flaps.iter().enumerate() {
            let field = format!("flaps[{i}].chord_fraction");
            check.within(number(&field, flap.chord_fraction, "", remedy), 0.1, 0.4);
        }
    }
}

fn check_trim(check: &mut Checker<'_>, trim: &TrimFile) {
    let loading = "the paper's rotor has 0.07; beyond 0.5 no blade lifts";
    let tilt = "forward tilt is positive; 5 deg is usual at mu 0.3";
    match trim {
        TrimFile::Propulsive(p) => {
            check.within(number("trim.ct_sigma", p.ct_sigma, "", loading), 1e-3, 0.5);
            for (field, value, low, high, unit, remedy) in [
                ("trim.drag_area", p.drag_area, 0.0, 1.0, "", "0.01 disk areas is usual"),
                ("trim.cg_below_hub_r", p.cg_below_hub_r, 0.0, 2.0, "R", "0.2 R is usual"),
                ("trim.hub_aft_of_cg_r", p.hub_aft_of_cg_r, -1.0, 1.0, "R", "aft is positive"),
                (
                    "trim.hub_starboard_of_cg_r",
                    p.hub_starboard_of_cg_r,
                    -1.0,
                    1.0,
                    "R",
                    "starboard is positive",
                ),
                ("trim.tail_rotor_arm_r", p.tail_rotor_arm_r, 0.1, 5.0, "R", "1.2 R is usual"),
                (
                    "trim.tail_rotor_height_r",
                    p.tail_rotor_height_r,
                    -2.0,
                    2.0,
                    "R",
                    "above the centre of gravity is positive",
                ),
            ]
            .into_iter()
            .chain(horizontal_tail_ranges(&p.horizontal_tail))
            {
                check.within(number(field, value, unit, remedy), low, high);
            }
        }
        TrimFile::WindTunnel(w) => {
            check.within(number("trim.ct_sigma", w.ct_sigma, "", loading), 1e-3, 0.5);
            check.within(number("trim.shaft_tilt_deg", w.shaft_tilt_deg, "deg", tilt), -45.0, 45.0);
        }
        TrimFile::Prescribed(p) => {
            for (field, value) in [
                ("trim.theta0_deg", p.theta0_deg),
                ("trim.theta1c_deg", p.theta1c_deg),
                ("trim.theta1s_deg", p.theta1s_deg),
            ] {
                let remedy = "the linear section models mean nothing beyond";
                check.within(number(field, value, "deg", remedy), -34.0, 34.0);
            }
            check.within(number("trim.shaft_tilt_deg", p.shaft_tilt_deg, "deg", tilt), -45.0, 45.0);
        }
    }
}

/// Field, value, lowest and highest value, unit and remedy of a number.
type FieldRange = (&'static str, f64, f64, f64, &'static str, &'static str);

/// Every number of a horizontal tail.
fn horizontal_tail_ranges(tail: &HorizontalTailFile) -> [FieldRange; 5] {
    let height = "above the centre of gravity is positive";
    [
        (
            "trim.horizontal_tail.area",
            tail.area,
            0.0,
            0.2,
            "",
            "0.01 disk areas is usual; 0 is none",
        ),
        ("trim.horizontal_tail.arm_r", tail.arm_r, -5.0, 5.0, "R", "1.2 R is usual"),
        ("trim.horizontal_tail.height_r", tail.height_r, -2.0, 2.0, "R", height),
        (
            "trim.horizontal_tail.incidence_deg",
            tail.incidence_deg,
            -28.0,
            28.0,
            "deg",
            "nose up is positive; the tail does not stall in this model",
        ),
        ("trim.horizontal_tail.lift_slope", tail.lift_slope, 0.0, 10.0, "1/rad", "4 is usual"),
    ]
}

fn check_actuator(check: &mut Checker<'_>, file: &CaseFile) {
    let a = &file.actuator;
    let remedy = "the paper's figures use 5 rev/s, its rotor turns 6.383 rev/s";
    check.within(number("actuator.bench_rev_hz", a.bench_rev_hz, "rev/s", remedy), 1e-3, 1e3);
    let remedy = "flap amplitude at full-scale voltage; the paper's gain gives 10 deg";
    let ideal = a.ideal_amplitude_deg;
    check.within(number("actuator.ideal_amplitude_deg", ideal, "deg", remedy), 1e-3, 45.0);
    match &a.model {
        ActuatorChoice::Bench(bench) if bench.dataset.trim().is_empty() => {
            let of = "the folder of dataset.ron, relative to the case file";
            check.fault("actuator.model.dataset", Fault::EmptyText { of });
        }
        ActuatorChoice::File(stored) if stored.path.trim().is_empty() => {
            let of = "a file written by `hhc identify`, relative to the case file";
            check.fault("actuator.model.path", Fault::EmptyText { of });
        }
        _ => {}
    }
    let (low, high) = a.range_volt;
    if !(low < high && low.is_finite() && high.is_finite()) {
        check.fault("actuator.range_V", Fault::EmptyRange { low, high });
    }
}

fn check_control(check: &mut Checker<'_>, file: &CaseFile) {
    let c = &file.control;
    check.positive(number(
        "control.amplitude_V",
        c.amplitude_volt,
        "V",
        "full scale is 85 V about 65 V",
    ));
    let (low_volt, high_volt) = file.actuator.range_volt;
    let (bias_volt, amplitude_volt) = (c.bias_volt, c.amplitude_volt);
    let room_volt = (high_volt - bias_volt).min(bias_volt - low_volt);
    let slack = 1e-9 * (high_volt - low_volt).abs();
    // a range that is no range and an amplitude that is none are reported on their own
    let fits = amplitude_volt <= room_volt + slack;
    if low_volt < high_volt && amplitude_volt > 0.0 && !fits {
        let fault = Fault::VoltageOutsideRange {
            bias_volt,
            amplitude_volt,
            low_volt,
            high_volt,
            room_volt: room_volt.max(0.0),
        };
        check.fault("control.amplitude_V", fault);
    }
    if file.flaps.is_empty() && !c.harmonics.is_empty() {
        check.fault("control.harmonics", Fault::ControlWithoutFlaps);
    }
    for (i, set) in c.harmonics.iter().enumerate() {
        if set.is_empty() {
            check.fault(&format!("control.harmonics[{i}]"), Fault::EmptyList { of: "harmonic" });
        }
        for (j, &harmonic) in set.iter().enumerate() {
            let field = format!("control.harmonics[{i}][{j}]");
            let remedy = "the paper controls 2, 3, 4 (and 5) per rev";
            check.count(&field, harmonic, (1, 12), remedy);
            if set[..j].contains(&harmonic) {
                let name = harmonic.to_string();
                let first_line = check.line(&format!("control.harmonics[{i}]"));
                check.fault(&field, Fault::Repeated { name, of: "harmonic of a set", first_line });
            }
        }
    }
    let ideal = file.actuator.model == ActuatorChoice::Ideal;
    for (i, actuator) in c.actuators.iter().enumerate() {
        if ideal && !c.harmonics.is_empty() && *actuator != ControlActuator::Ideal {
            check.fault(&format!("control.actuators[{i}]"), Fault::NeedsIdentifiedActuator);
        }
    }
    let remedy = "0.5 deg is usual";
    check.within(number("control.t_step_deg", c.t_step_deg, "deg", remedy), 1e-3, 10.0);
    if let StrokeChoice::Given { amplitude_deg } = c.stroke_limit {
        let remedy = "or write FromActuator";
        let field = "control.stroke_limit.amplitude_deg";
        check.within(number(field, amplitude_deg, "deg", remedy), 1e-3, 45.0);
    }
    if c.effort == EffortChoice::MeetStroke && c.controller != ControllerChoice::Global {
        check.fault("control.controller", Fault::NeedsConstantT);
    }
    let has_wake = matches!(file.inflow.model, InflowChoice::FreeWake(_));
    if c.t_inflow == TInflowChoice::Reconverged && !has_wake {
        check.fault("control.t_inflow", Fault::NeedsFreeWake);
    }
    if let EffortChoice::Given { rho } = c.effort {
        let remedy = "or write MeetStroke";
        check.within(number("control.effort.rho", rho, "1/V^2", remedy), 0.0, 1e6);
    }
    let w = &c.load_weights;
    for (key, value) in
        [("fx", w.fx), ("fy", w.fy), ("fz", w.fz), ("mx", w.mx), ("my", w.my), ("mz", w.mz)]
    {
        let field = format!("control.load_weights.{key}");
        check.within(number(&field, value, "", "1 is the paper's identity weight"), 0.0, 1e12);
    }
    if [w.fx, w.fy, w.fz, w.mx, w.my, w.mz].iter().all(|weight| *weight == 0.0) {
        check.fault("control.load_weights", Fault::NoLoadWeighted);
    }
    if let Some(limit) = c.power_limit_watt {
        let remedy = "a few W is usual; leave it out for no limit";
        check.within(number("control.power_limit_W", limit, "W", remedy), 1e-6, 1e6);
        if c.effort != EffortChoice::Limits {
            check.fault("control.power_limit_W", Fault::NeedsLimits);
        }
    }
    let remedy = "0 for no weight; 1e-8 is where it shows on nondimensional loads";
    let field = "control.power_weight_per_W";
    check.within(number(field, c.power_weight_per_watt, "1/W", remedy), 0.0, 1e6);
    check.count("control.max_steps", c.max_steps, (1, 10_000), "40 is usual");
    let remedy = "1e-4 is usual";
    check.within(number("control.step_tolerance", c.step_tolerance, "", remedy), 1e-12, 0.1);
}

/// Stations on the blade, each once.
fn check_load_stations(check: &mut Checker<'_>, file: &CaseFile) {
    let root = file.rotor.root_offset_r;
    let stations = file.response.load_stations_r.as_deref().unwrap_or_default();
    for (i, &station) in stations.iter().enumerate() {
        let field = format!("response.load_stations_r[{i}]");
        let remedy = "a station of the blade: the root is rotor.root_offset_r, the tip is 1";
        check.within(number(&field, station, "R", remedy), root, 1.0);
        if let Some(first) = stations[..i].iter().position(|s| (s - station).abs() < 1e-9) {
            let message = format!(
                "the station {station} R is in the list already (number {}); name each station once",
                first + 1
            );
            check.fault(&field, Fault::Refused { message });
        }
    }
}

fn check_numerics(check: &mut Checker<'_>, file: &CaseFile) {
    let r = &file.response;
    let remedy = "the paper uses 8 elements of order 5";
    check.count("response.time_elements", r.time_elements, (4, 200), remedy);
    check.count("response.time_order", r.time_order, (2, 12), remedy);
    let remedy = "8 is usual; at least the order of the elements";
    check.count("response.time_gauss_points", r.time_gauss_points, (r.time_order, 32), remedy);
    check.count("response.span_points_per_piece", r.span_points_per_piece, (1, 16), "4 is usual");
    let least = file.rotor.blades.min(64);
    let remedy = "12 is usual; at least the blade number, whose harmonic reaches the hub";
    check.count("response.load_harmonics", r.load_harmonics, (least, 64), remedy);
    check_load_stations(check, file);
    let t = &file.tolerances;
    for (field, value, high) in [
        ("tolerances.trim", t.trim, 1e-3),
        ("tolerances.periodicity", t.periodicity, 1e-3),
        ("tolerances.inflow", t.inflow, 1e-3),
    ] {
        let remedy = "tight enough to trust, loose enough for rounding: 1e-10 is usual";
        check.within(number(field, value, "", remedy), 1e-14, high);
    }
    for (field, value) in [
        ("tolerances.trim_iterations", t.trim_iterations),
        ("tolerances.inflow_iterations", t.inflow_iterations),
    ] {
        check.count(field, value, (1, 10_000), "40 to 60 is usual");
    }
}
