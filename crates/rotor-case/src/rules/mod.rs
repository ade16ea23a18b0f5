//! Rules between the fields of a case, and of values that a plain range cannot say.

mod blade;
mod checker;

use crate::{
    ActuatorChoice, AirfoilStation, AttachedFlowModel, BiasChoice, Case, CaseFault, CaseFaults,
    CompressibilityChoice, ControlActuator, ControlValues, ControllerChoice, EffortChoice,
    FlapActuator, FlightValues, FreeWakeValues, InflowChoice, StrokeChoice, TInflowChoice,
    WakeMethod, WakeSymmetry,
};
use blade::check_blade;
use checker::Checker;

// rules between fields
const INCOMPRESSIBLE: &str = "Incompressible holds at Mach 0 only; set aerodynamics.compressibility: None, or choose Calibrated or HariharanLeishman";
const NEEDS_ACTUATOR: &str = "Ignored and Hysteretic need an identified actuator; set actuator.model to Bench(...) or File(...)";
const INVERSE_SETS_BIAS: &str = "Inverse gives the whole voltage, bias included, which bias: Fixed holds; write bias: Centred, or leave Inverse out";
const NEEDS_LIMITS: &str =
    "a limit of the power is kept by the cone program alone; set control.effort to Limits";
const NEEDS_CONSTANT_T: &str = "a weight tuned to the stroke (effort: MeetStroke) is a root find over whole loops with one T; with a T that is learnt their ends scatter; write controller: Global, or effort: Limits, which keeps the stroke of each flap exactly";
const HELD_T: &str = "controller: Local takes T from the rotor at every step and has no use for one that is handed in; write controller: Global, or leave t_file out";
const NEEDS_FREE_WAKE: &str =
    "there is no free wake to converge anew; write t_inflow: Settled, or inflow: FreeWake()";
const NO_LOAD_WEIGHTED: &str =
    "every load weight is 0, so there is nothing to reduce; 1 is the paper's identity weight";
const NEEDS_FLAPS: &str =
    "the blade has no flap to control with; give flaps, or write harmonics: []";
const FLIES_NONE_OR_TWICE: &str =
    "give each controller once, at least one of them: controllers: [Fixed, Scheduled, Adaptive]";
const FLIES_WITHOUT_FLAPS: &str =
    "the blade has no flap to control with; give flaps, or leave the flight out";
const TWO_ACTUATORS: &str = "this flap has an actuator in the list already; give each once";
const NEEDS_THRUST: &str = "controls that are given have no thrust to step; trim: Propulsive or WindTunnel, or leave thrust_step out";
/// Highest harmonic of the flaps that the linearised rotor of a flight knows, per rev.
const HIGHEST_FLOWN: usize = 10;

impl Case {
    /// Checks every value and the rules between them.
    ///
    /// # Errors
    /// Every value out of range and every rule broken, each with its field.
    pub fn check(&self) -> Result<(), CaseFaults> {
        let mut check = Checker::of_values(self);
        check_inflow(&mut check, self);
        check_blade(&mut check, self);
        check_structure(&mut check, self);
        check_flaps(&mut check, self);
        check_section(&mut check, self);
        check_voltage(&mut check, self);
        check_harmonics(&mut check, self);
        check_control(&mut check, self);
        check_response(&mut check, self);
        if let Some(flight) = &self.flight {
            check_flight(&mut check, self, flight);
        }
        check.finish()
    }
}

fn check_inflow(check: &mut Checker, case: &Case) {
    if let InflowChoice::Prescribed { lambda_i } = case.inflow.model {
        let remedy = "give the induced inflow over the tip speed, down positive (0.01 is usual)";
        check.within("inflow.model.lambda_i", lambda_i, (-0.2, 0.2), "", remedy);
    }
    if let InflowChoice::FreeWake(wake) = &case.inflow.model {
        check_wake(check, wake, case.rotor.blades);
        if wake.choices().symmetry == WakeSymmetry::Axial {
            let remedy = "a wake turns with its blades in hover only; leave inflow.model.symmetry and the preset Hover out";
            check.within("advance_ratio", case.advance_ratio, (0.0, 0.0), "", remedy);
        }
    }
}

fn check_wake(check: &mut Checker, wake: &FreeWakeValues, blades: usize) {
    let field = "inflow.model.azimuths";
    let azimuths = wake.azimuths_for(blades);
    check.count(field, azimuths, (8, 144), "36 are steps of 10 deg");
    if !azimuths.is_multiple_of(blades.max(1)) {
        let (below, above) = (azimuths - azimuths % blades, azimuths.next_multiple_of(blades));
        let message = format!(
            "{azimuths} steps per revolution do not give each of {blades} blades a whole number of them; give {below} or {above}, or leave it out"
        );
        check.refuse(field, message);
    }
    if let Some(sections) = wake.section_azimuths.filter(|_| (8..=144).contains(&azimuths)) {
        let is_multiple = sections.is_multiple_of(azimuths) && (azimuths..=360).contains(&sections);
        if !is_multiple || wake.choices().symmetry == WakeSymmetry::Axial {
            let message = format!(
                "{sections} is no multiple of the {azimuths} azimuth steps of a periodic wake up to 360; give {}, or leave it out",
                azimuths * (sections / azimuths).clamp(1, 360 / azimuths)
            );
            check.refuse("inflow.model.section_azimuths", message);
        }
    }
    if let Some(Err(source)) = wake.body.body().map(|body| body.validate()) {
        check.refuse("inflow.model.body", format!("{source}; 0 for length_r is no body"));
    }
    if wake.choices().velocity_stride > 1 && wake.method == WakeMethod::Marched {
        let message = "a march in time computes every age: leave it out, or give method: Relaxed";
        check.refuse("inflow.model.velocity_stride", message);
    }
}

fn check_structure(check: &mut Checker, case: &Case) {
    let remedy = "as many as the elements resolve: the paper keeps 4, 4 and 2";
    let modes = case.structure.modes.as_array();
    for (kind, count) in ["flap", "lag", "torsion"].into_iter().zip(modes) {
        let field = format!("structure.modes.{kind}");
        check.count(&field, count, (1, 2 * case.structure.elements), remedy);
    }
}

/// Slowest tip for which the sections take a Mach number.
const LEAST_TIP_MACH: f64 = 1e-3;

fn check_flaps(check: &mut Checker, case: &Case) {
    let mut from_r = case.rotor.root_cutout_r.max(case.rotor.root_offset_r);
    for (i, flap) in case.flaps.iter().enumerate() {
        let (start_r, end_r) = (flap.start_r, flap.end_r);
        if start_r >= from_r && end_r > start_r && end_r <= 1.0 {
            from_r = end_r;
        } else {
            let end = start_r >= from_r && start_r < 1.0;
            let field = if end { "end_r" } else { "start_r" };
            let message = format!(
                "the flap spans {start_r} R to {end_r} R, expected {from_r} R (cut-out or the flap before) <= start_r < end_r <= 1 R; keep it on the blade, and list flaps from root to tip without overlap"
            );
            check.broken(&format!("flaps[{i}].{field}"), message);
        }
        if let Some(gyration) = flap.gyration_fraction {
            let remedy = "it is about the hinge: at least the distance of the centre of gravity; leave it out for a thin rod";
            let field = format!("flaps[{i}].gyration_fraction");
            check.within(&field, gyration, (flap.cg_fraction.abs().min(1.0), 1.0), "", remedy);
        }
    }
}

fn check_section(check: &mut Checker, case: &Case) {
    let a = &case.aerodynamics;
    check_airfoils(check, &a.airfoils);
    let remedy = "the tables of airfoils hold the camber: leave it out";
    let camber = [("zero_lift_deg", a.zero_lift_deg), ("zero_lift_moment", a.zero_lift_moment)];
    for (field, _) in camber.iter().filter(|given| given.1 != 0.0 && !a.airfoils.is_empty()) {
        check.refuse(&format!("aerodynamics.{field}"), remedy);
    }
    let remedy = "1 is no loss, 0.97 is usual; outboard of the root cut-out";
    let least = case.rotor.root_cutout_r.max(0.5);
    check.within("aerodynamics.tip_loss", a.tip_loss, (least, 1.0), "R", remedy);
    let field = "aerodynamics.speed_of_sound_m_s";
    let remedy = "340.3 m/s is the standard atmosphere at sea level; the tip must stay subsonic";
    let tip_speed = case.scales().tip_speed_m_s();
    let lowest = if tip_speed.is_finite() { (tip_speed / 0.95).max(1.0) } else { 1.0 };
    check.within(field, a.speed_of_sound_m_s, (lowest, 2000.0), "m/s", remedy);
    let is_slow = tip_speed > 0.0 && tip_speed < LEAST_TIP_MACH * a.speed_of_sound_m_s;
    if is_slow && a.compressibility == CompressibilityChoice::LocalMach {
        let message = format!(
            "the tip moves at {tip_speed:.3e} m/s, Mach {:.1e}: below Mach {LEAST_TIP_MACH} compressibility means nothing; give the speed in rpm (the paper's rotor turns at 383), or set aerodynamics.compressibility: None",
            tip_speed / a.speed_of_sound_m_s
        );
        check.refuse("rotor.omega_rpm", message);
    }
    if a.model == AttachedFlowModel::Incompressible
        && a.compressibility != CompressibilityChoice::None
    {
        check.broken("aerodynamics.model", INCOMPRESSIBLE);
    }
    if a.model == AttachedFlowModel::Calibrated {
        let remedy = "the calibrated section model holds for these; or choose another model";
        for (i, flap) in case.flaps.iter().enumerate() {
            let field = format!("flaps[{i}].chord_fraction");
            check.within(&field, flap.chord_fraction, (0.1, 0.4), "", remedy);
        }
    }
}

/// Stations of aerofoil tables: the first may lie at the rotor centre, each further one beyond the one before.
fn check_airfoils(check: &mut Checker, airfoils: &[AirfoilStation]) {
    let mut inboard = 0.0;
    for (i, airfoil) in airfoils.iter().enumerate() {
        let value = airfoil.station_r;
        let beyond = if i == 0 { value >= 0.0 } else { value > inboard };
        if beyond && value <= 1.0 {
            inboard = value;
        } else {
            let remedy = "list the tables from root to tip, each station once";
            let fault = CaseFault::OutOfRange { value, low: inboard, high: 1.0, unit: "R", remedy };
            check.found(&format!("aerodynamics.airfoils[{i}].station_r"), Some(fault));
        }
    }
}

/// The range of voltages, and the control voltage in it.
fn check_voltage(check: &mut Checker, case: &Case) {
    let (low_volt, high_volt) = case.actuator.range_volt;
    if !(low_volt < high_volt && low_volt.is_finite() && high_volt.is_finite()) {
        let message = format!(
            "({low_volt}, {high_volt}) is no range; give the lower limit first, both finite"
        );
        check.broken("actuator.range_V", message);
    }
    let control = &case.control;
    let (bias_volt, amplitude_volt) = (control.drive_bias().volt(), control.amplitude_volt);
    let field = if let BiasChoice::Fixed(volt) = control.bias {
        let is_given = control.bias_volt.to_bits() != ControlValues::default().bias_volt.to_bits();
        if is_given && (control.bias_volt - volt).abs() > 0.0 {
            let message = format!(
                "{} V is of no use beside bias: Fixed({volt}), which holds the bias of every actuator; leave bias_V out",
                control.bias_volt
            );
            check.broken("control.bias_V", message);
        }
        "control.bias"
    } else {
        "control.bias_V"
    };
    let inverse = control.actuators.iter().position(|a| *a == ControlActuator::Inverse);
    if let (BiasChoice::Fixed(_), Some(i)) = (control.bias, inverse) {
        check.broken(&format!("control.actuators[{i}]"), INVERSE_SETS_BIAS);
    }
    let room_volt = (high_volt - bias_volt).min(bias_volt - low_volt);
    let slack = 1e-9 * (high_volt - low_volt).abs();
    // a range that is no range and an amplitude that is none are reported on their own
    let fits = amplitude_volt <= room_volt + slack;
    if low_volt < high_volt && amplitude_volt > 0.0 && !fits {
        let message = format!(
            "the voltage {bias_volt} V +- {amplitude_volt} V leaves the actuator's range {low_volt} V to {high_volt} V; lower control.amplitude_V to {} V or move {field}",
            room_volt.max(0.0)
        );
        check.broken("control.amplitude_V", message);
    }
}

fn check_harmonics(check: &mut Checker, case: &Case) {
    for (i, set) in case.control.harmonics.iter().enumerate() {
        check_set(check, &format!("control.harmonics[{i}]"), set, 12);
    }
}

/// Harmonics that are controlled together, up to a highest one, each once.
fn check_set(check: &mut Checker, list: &str, set: &[usize], highest: usize) {
    if set.is_empty() {
        check.broken(list, "is empty; give at least one harmonic");
    }
    for (j, &harmonic) in set.iter().enumerate() {
        let field = format!("{list}[{j}]");
        let remedy = "the paper controls 2, 3, 4 (and 5) per rev";
        check.count(&field, harmonic, (1, highest), remedy);
        if set[..j].contains(&harmonic) {
            let message = format!(
                "`{harmonic}` is used already at {list}; give every harmonic of a set once"
            );
            check.broken(&field, message);
        }
    }
}

/// A flight whose flaps, controllers and times are there.
fn check_flight(check: &mut Checker, case: &Case, flight: &FlightValues) {
    check_set(check, "flight.harmonics", &flight.harmonics, HIGHEST_FLOWN);
    let controllers = &flight.controllers;
    let is_twice = |i: usize| controllers[..i].contains(&controllers[i]);
    if controllers.is_empty() || (1..controllers.len()).any(is_twice) {
        check.broken("flight.controllers", FLIES_NONE_OR_TWICE);
    }
    if case.flaps.is_empty() {
        check.broken("flight", FLIES_WITHOUT_FLAPS);
    }
    let times = (0.0, flight.duration_s);
    let remedy = "within the flight, whose length is flight.duration_s";
    if let Some(step) = &flight.thrust_step {
        check.within("flight.thrust_step.at_s", step.at_s, times, "s", remedy);
        if case.trim.ct_sigma().is_none() {
            check.broken("flight.thrust_step", NEEDS_THRUST);
        }
    }
    let flaps = ((1, case.flaps.len().max(1)), "flaps are counted from the root");
    if let Some(failed) = &flight.failed_flap {
        check.within("flight.failed_flap.at_s", failed.at_s, times, "s", remedy);
        check.count("flight.failed_flap.flap", failed.flap, flaps.0, flaps.1);
    }
    for (i, own) in flight.flap_actuators.iter().enumerate() {
        let list = format!("flight.flap_actuators[{i}]");
        check.count(&format!("{list}.flap"), own.flap, flaps.0, flaps.1);
        let (blade, blades) = (own.blade.unwrap_or(1), (1, case.rotor.blades));
        check.count(&format!("{list}.blade"), blade, blades, "or leave it out for every blade");
        let is_same = |before: &FlapActuator| (before.flap, before.blade) == (own.flap, own.blade);
        if flight.flap_actuators[..i].iter().any(is_same) {
            check.broken(&list, TWO_ACTUATORS);
        }
    }
}

fn check_control(check: &mut Checker, case: &Case) {
    let c = &case.control;
    let ideal = case.actuator.model == ActuatorChoice::Ideal;
    for (i, actuator) in c.actuators.iter().enumerate() {
        if ideal && !c.harmonics.is_empty() && *actuator != ControlActuator::Ideal {
            check.broken(&format!("control.actuators[{i}]"), NEEDS_ACTUATOR);
        }
    }
    if let StrokeChoice::Given { amplitude_deg } = c.stroke_limit {
        let (field, remedy) = ("control.stroke_limit.amplitude_deg", "or write FromActuator");
        check.within(field, amplitude_deg, (1e-3, 45.0), "deg", remedy);
    }
    if let EffortChoice::Given { rho } = c.effort {
        check.within("control.effort.rho", rho, (0.0, 1e6), "1/V^2", "or write MeetStroke");
    }
    let has_wake = matches!(case.inflow.model, InflowChoice::FreeWake(_));
    let w = &c.load_weights;
    let tuned = c.effort == EffortChoice::MeetStroke;
    let limited = c.effort == EffortChoice::Limits;
    let weighs_none = [w.fx, w.fy, w.fz, w.mx, w.my, w.mz].iter().all(|weight| *weight == 0.0);
    for (field, is_broken, rule) in [
        ("harmonics", case.flaps.is_empty() && !c.harmonics.is_empty(), NEEDS_FLAPS),
        ("controller", tuned && c.controller != ControllerChoice::Global, NEEDS_CONSTANT_T),
        ("t_inflow", c.t_inflow == TInflowChoice::Reconverged && !has_wake, NEEDS_FREE_WAKE),
        ("t_file", c.t_file.is_some() && c.controller == ControllerChoice::Local, HELD_T),
        ("load_weights", weighs_none, NO_LOAD_WEIGHTED),
        ("power_limit_W", c.power_limit_watt.is_some() && !limited, NEEDS_LIMITS),
    ] {
        if is_broken {
            check.broken(&format!("control.{field}"), rule);
        }
    }
}

/// Counts of the response, and stations on the blade, each once.
fn check_response(check: &mut Checker, case: &Case) {
    let r = &case.response;
    let remedy = "8 is usual; at least the order of the elements";
    check.count("response.time_gauss_points", r.time_gauss_points, (r.time_order, 32), remedy);
    let least = case.rotor.blades.min(64);
    let remedy = "12 is usual; at least the blade number, whose harmonic reaches the hub";
    check.count("response.load_harmonics", r.load_harmonics, (least, 64), remedy);
    for (i, section) in case.measured.airloads.iter().enumerate() {
        let field = format!("measured.airloads[{i}].station_r");
        let remedy = "a station that carries air, from rotor.root_cutout_r to 1";
        let range = (case.rotor.root_cutout_r, 1.0);
        check.within(&field, section.station_r, range, "R", remedy);
    }
    let root = case.rotor.root_offset_r;
    let remedy = "a station of the blade: the root is rotor.root_offset_r, the tip is 1";
    let stations = r.load_stations_r.as_deref();
    check_places(check, ("load_stations_r", "station"), stations, (root, 1.0), remedy);
    let remedy = "a plane that vortices cut: starboard of the hub positive, the tip at 1";
    let planes = r.vortex_planes_y_r.as_deref();
    check_places(check, ("vortex_planes_y_r", "plane"), planes, (-1.5, 1.5), remedy);
}

/// A list of stations or planes of the response in a range, R, each once.
fn check_places(
    check: &mut Checker,
    (field, kind): (&str, &str),
    places: Option<&[f64]>,
    range: (f64, f64),
    remedy: &'static str,
) {
    let places = places.unwrap_or_default();
    for (i, &place) in places.iter().enumerate() {
        let field = format!("response.{field}[{i}]");
        check.within(&field, place, range, "R", remedy);
        if let Some(first) = places[..i].iter().position(|s| (s - place).abs() < 1e-9) {
            let message = format!(
                "the {kind} {place} R is in the list already (number {}); name each {kind} once",
                first + 1
            );
            check.refuse(&field, message);
        }
    }
}
