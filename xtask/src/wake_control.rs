//! What the choices of the free wake do to the control of the paper's rotor: reduction of J, flap motion and T.

use std::fmt::Write as _;
use std::sync::Arc;

use crate::regress::SweepError;
use crate::wake_refinement::PAPER_CHORD;
use preisach_dyn::ActuatorModel;
use rotor_base::wrap_degrees;
use rotor_study::{Drives, TrimmedRotor, control_set};
use sim_driver::SimError;
use sim_driver::actuator::case_actuators;
use sim_driver::case::{
    ControlActuator, FreeWakeValues, InflowChoice, LoadedCase, PAPER_CASE, RolledUpChoice,
    shipped_case,
};

/// A change of the wake, and the points of a time element if others are asked for.
type Row = (&'static str, fn(&mut FreeWakeValues), Option<usize>);

/// What is changed, and how, from the defaults of a case.
const ROWS: [Row; 20] = [
    ("none", |_| (), None),
    ("16 panels", |w| w.panels = 16, None),
    ("28 panels", |w| w.panels = 28, None),
    ("40 panels", |w| w.panels = 40, None),
    ("60 panels", |w| w.panels = 60, None),
    ("steps of 15 deg", |w| w.azimuths = Some(24), None),
    ("steps of 7.5 deg", |w| w.azimuths = Some(48), None),
    ("steps of 5 deg, 12 time points", |w| w.azimuths = Some(72), Some(12)),
    ("near core x 0.5", |w| w.near_core_r = Some(0.5 * PAPER_CHORD), None),
    ("near core x 2", |w| w.near_core_r = Some(2.0 * PAPER_CHORD), None),
    ("near wake 30 deg", |w| w.near_wake_deg = Some(30.0), None),
    ("near wake 60 deg", |w| w.near_wake_deg = Some(60.0), None),
    ("near wake 90 deg", |w| w.near_wake_deg = Some(90.0), None),
    ("near wake 120 deg", |w| w.near_wake_deg = Some(120.0), None),
    ("near wake 180 deg", |w| w.near_wake_deg = Some(180.0), None),
    ("near wake 270 deg", |w| w.near_wake_deg = Some(270.0), None),
    ("near wake 720 deg", |w| w.near_wake_deg = Some(720.0), None),
    ("root vortex", |w| w.rolled_up = Some(RolledUpChoice::TipAndRoot), None),
    ("near wake 90 deg, root vortex and sheet", |w| sheet_after(w, 90.0), None),
    ("near wake 180 deg, root vortex and sheet", |w| sheet_after(w, 180.0), None),
];

fn sheet_after(wake: &mut FreeWakeValues, near_wake_deg: f64) {
    wake.near_wake_deg = Some(near_wake_deg);
    wake.rolled_up = Some(RolledUpChoice::TipRootAndSheet);
}

/// The paper's case with an ideal actuator, whose stroke is that of the identified one, in a changed free wake.
fn case_of(paper: &LoadedCase, (_, change, points): Row) -> LoadedCase {
    let mut loaded = paper.clone();
    let mut wake = FreeWakeValues::default();
    change(&mut wake);
    loaded.case.inflow.model = InflowChoice::FreeWake(wake);
    loaded.case.control.actuators = vec![ControlActuator::Ideal];
    if let Some(points) = points {
        loaded.case.response.time_gauss_points = points;
    }
    loaded
}

/// Of every harmonic: reduction of J, size of T, and the motion of the two flaps.
fn cells(loaded: &LoadedCase, actuator: &Arc<ActuatorModel>) -> Result<String, SweepError> {
    let case = &loaded.case;
    let rotor = TrimmedRotor::new(case, None)?;
    let drives = Drives::new(case, Some(Arc::clone(actuator)))?;
    let mut line = String::new();
    for harmonics in &case.control.harmonics {
        let n = harmonics.first().copied().unwrap_or_default();
        for study in control_set(case, &rotor, &drives, harmonics, &|| ())? {
            let flaps = study.state.flaps.iter().map(|flap| flap.flap_deg.harmonic(n));
            let flaps: Vec<_> = flaps.collect();
            let lead = match flaps.as_slice() {
                [inboard, outboard] => wrap_degrees(inboard.phase_deg() - outboard.phase_deg()),
                _ => f64::NAN,
            };
            let amplitudes: Vec<String> =
                flaps.iter().map(|flap| format!("{:.1}", flap.amplitude())).collect();
            let _ = write!(
                line,
                " {:.1} | {:.2} | {}; {lead:.0} |",
                study.reduction_percent(),
                1e5 * study.t_norm(),
                amplitudes.join(", "),
            );
        }
    }
    Ok(line)
}

/// The table, row by row to `say`.
///
/// # Errors
/// [`SimError`] of the shipped case.
pub fn table(say: impl Fn(&str)) -> Result<(), SimError> {
    let paper = shipped_case(PAPER_CASE)?;
    let Some(actuator) = case_actuators(&paper)?.real.map(Arc::new) else { return Ok(()) };
    let harmonics = [2, 3, 4];
    let titles: Vec<String> = harmonics
        .iter()
        .map(|n| format!(" {n}/rev: J, % | T, 1e-5 per V | flaps, deg; outboard leads, deg |"))
        .collect();
    say(&format!("| change |{}\n|---|{}\n", titles.concat(), "---|".repeat(9)));
    for row in ROWS {
        let line =
            cells(&case_of(&paper, row), &actuator).unwrap_or_else(|error| format!(" {error} |"));
        say(&format!("| {} |{line}\n", row.0));
    }
    Ok(())
}
