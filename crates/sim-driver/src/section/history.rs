//! Histories of a section: after a step, along a ramp, round a cycle.

use super::{FASTEST, SectionChoice, SectionTable, within};
use crate::SimError;
use flap_aero::{
    CycleStep, MarchingSection, Motion, SectionInputs, SectionState, StallParameters, StallSection,
    StallState, periodic_state,
};
use std::f64::consts::TAU;

/// Lowest reduced frequency of a loop, and shortest rise of a ramp, semichords: below, it is a static
/// curve or a step.
const SLOWEST: f64 = 1e-6;
/// Longest history, semichords.
const LONGEST: f64 = 1e6;
/// Largest incidence or flap angle of a loop, rad.
const HALF_TURN: f64 = std::f64::consts::PI;

/// Most rows of a history.
const MOST_POINTS: usize = 1_000_000;
/// Cycles marched for a stalled loop to repeat, and the distance added to them, semichords: some
/// twenty-five decays of the slowest lag or the vortex make a difference of 1 to one of 1e-11.
const MOST_CYCLES: usize = 60;
const SETTLING_DISTANCE: f64 = 400.0;
/// Change of the normal force from cycle to cycle that counts as none.
const REPEATED: f64 = 1e-10;

/// A unit step or ramp of a motion.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct TransientQuestion {
    /// The section.
    pub section: SectionChoice,
    /// What moves by 1 rad (plunge: a velocity of 1 `U`), from rest.
    pub motion: Motion,
    /// Distance over which it moves, semichords; 0 is a step, whose rate acts for no time.
    pub rise: f64,
    /// Distance shown, semichords.
    pub distance: f64,
    /// Number of rows after the first.
    pub points: usize,
}

/// One cycle of a motion `mean + amplitude sin(k S)`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct LoopQuestion {
    /// The section.
    pub section: SectionChoice,
    /// What moves.
    pub motion: Motion,
    /// Mean incidence, rad; of the flap's motion too.
    pub mean_rad: f64,
    /// Amplitude of the motion, rad.
    pub amplitude_rad: f64,
    /// Reduced frequency, above 0.
    pub reduced_frequency: f64,
    /// Steps per cycle.
    pub points: usize,
    /// How the section stalls; `None` is attached flow.
    pub stall: Option<StallParameters>,
}

fn check_points(points: usize) -> Result<(), SimError> {
    let fits = (1..=MOST_POINTS).contains(&points);
    within("number of points", points as f64, fits, "1 to 1000000")
}

/// Inputs of a motion at a value and a rate per semichord.
fn inputs(motion: Motion, value: f64, rate: f64) -> SectionInputs {
    let mut inputs = SectionInputs::default();
    let (angle, turning) = match motion {
        Motion::Flap => (2, Some(3)),
        Motion::Pitch => (0, Some(1)),
        Motion::Plunge => (0, None),
    };
    inputs.modes[angle] = value;
    inputs.rates[angle] = rate;
    if let Some(turning) = turning {
        // q = d(angle)/dt c/U = 2 d(angle)/dS
        inputs.modes[turning] = 2.0 * rate;
    }
    inputs
}

/// The history of a step or a ramp.
///
/// # Errors
/// [`SimError::Section`] for a section outside its model, a distance that is not positive, or no
/// points.
pub fn transient_history(question: &TransientQuestion) -> Result<SectionTable, SimError> {
    let TransientQuestion { motion, rise, distance, points, .. } = *question;
    let fits = distance > 0.0 && distance <= LONGEST;
    within("distance, semichords", distance, fits, "above 0, to 1e6")?;
    let fits = rise == 0.0 || (SLOWEST..=LONGEST).contains(&rise);
    within("rise, semichords", rise, fits, "0 (a step), or 1e-6 to 1e6")?;
    check_points(points)?;
    let (section, ..) = question.section.coefficients()?;
    let remarks = question.section.remarks(&section.remarks, motion, None);
    let section = MarchingSection::new(&section);
    let mut state = SectionState::at_rest(&section);
    // on the way up the rate is there at once, at the top it is gone at once
    let going = |s: f64| inputs(motion, s / rise, 1.0 / rise);
    let arrived = inputs(motion, 1.0, 0.0);
    let start = if rise > 0.0 { going(0.0) } else { arrived };
    state.jump(&section, &start.modes)?;
    let [cn, cm, ch] = state.loads(&section, &start)?;
    let value = |s: f64| if s < rise { s / rise } else { 1.0 };
    let mut rows = vec![vec![0.0, value(0.0), cn, cm, ch]];
    let mut at = 0.0;
    for n in 1..=points {
        let end = distance * n as f64 / points as f64;
        if at < rise {
            let stop = end.min(rise);
            let loads = state.step(&section, &going(stop), stop - at)?;
            at = stop;
            if at < rise {
                rows.push([end, value(end)].into_iter().chain(loads).collect());
                continue;
            }
            state.jump(&section, &arrived.modes)?;
        }
        let loads = state.step(&section, &arrived, end - at)?;
        at = end;
        rows.push([end, 1.0].into_iter().chain(loads).collect());
    }
    let name = question.section.model.name();
    let what = if rise > 0.0 { format!("ramp over {rise} semichords") } else { "step".to_owned() };
    Ok(SectionTable {
        title: format!("unit {what} of {motion:?}, {name}, Mach {}", question.section.mach),
        remarks,
        columns: vec!["S", "input", "cn", "cm", "ch"],
        rows,
    })
}

/// One cycle of a motion that has repeated for ever.
///
/// # Errors
/// [`SimError::Section`] for a section outside its model or a number outside its range; also if a
/// stalled loop does not repeat within sixty cycles.
pub fn loop_history(question: &LoopQuestion) -> Result<SectionTable, SimError> {
    let LoopQuestion { motion, mean_rad, amplitude_rad, reduced_frequency: k, points, .. } =
        *question;
    within("reduced frequency", k, (SLOWEST..=FASTEST).contains(&k), "1e-6 to 1000")?;
    for (quantity, angle_rad) in [("mean, deg", mean_rad), ("amplitude, deg", amplitude_rad)] {
        within(quantity, angle_rad.to_degrees(), angle_rad.abs() <= HALF_TURN, "-180 to 180")?;
    }
    check_points(points)?;
    let (coefficients, mach, flap) = question.section.coefficients()?;
    let remarks = question.section.remarks(&coefficients.remarks, motion, Some(k));
    let section = MarchingSection::new(&coefficients);
    let ds = TAU / k / points as f64;
    let cycle: Vec<CycleStep<'_>> = (1..=points)
        .map(|n| {
            let (sin, cos) = (TAU * n as f64 / points as f64).sin_cos();
            let mut inputs = inputs(motion, amplitude_rad * sin, amplitude_rad * k * cos);
            inputs.modes[0] += mean_rad;
            CycleStep { section: &section, inputs, semichords: ds }
        })
        .collect();
    let moving = if motion == Motion::Flap { 2 } else { 0 };
    let mut state = periodic_state(&cycle)?;
    let Some(parameters) = question.stall else {
        let mut rows = Vec::with_capacity(points);
        for step in &cycle {
            let loads = state.step(step.section, &step.inputs, ds)?;
            let angle = step.inputs.modes[moving].to_degrees();
            rows.push([angle].into_iter().chain(loads).collect());
        }
        return Ok(SectionTable {
            title: title(question, "attached flow"),
            remarks,
            columns: vec!["angle_deg", "cn", "cm", "ch"],
            rows,
        });
    };
    let stalling = StallSection::new(mach, flap, parameters)?;
    let last = &cycle[points - 1].inputs;
    let [cn, ..] = state.loads(&section, last)?;
    let mut stall = StallState::settled(&stalling, cn, &last.modes);
    let mut rows: Vec<Vec<f64>> = Vec::new();
    let cycles = MOST_CYCLES + whole(SETTLING_DISTANCE * k / TAU);
    for _ in 0..cycles {
        let mut next = Vec::with_capacity(points);
        for step in &cycle {
            let attached = state.step(step.section, &step.inputs, ds)?;
            let loads = stall.step(&stalling, attached, &step.inputs.modes, ds)?;
            let angle = step.inputs.modes[moving].to_degrees();
            let incidence = step.inputs.modes[0];
            next.push(vec![
                angle,
                loads.normal,
                loads.moment,
                loads.hinge,
                loads.chord,
                loads.pressure_drag(incidence),
                loads.separation,
                loads.vortex,
            ]);
        }
        let change = rows.iter().zip(&next).map(|(a, b)| (a[1] - b[1]).abs()).fold(0.0, f64::max);
        let settled = rows.len() == next.len() && change <= REPEATED;
        rows = next;
        if settled {
            return Ok(SectionTable {
                title: title(question, &format!("dynamic stall, repeats to {change:.1e}")),
                remarks,
                columns: vec!["angle_deg", "cn", "cm", "ch", "cc", "cd_pressure", "f", "cn_vortex"],
                rows,
            });
        }
    }
    let quantity = "number of cycles without repetition of the stalled loop";
    let (value, expected) = (cycles as f64, "a loop that repeats; choose another frequency");
    Err(flap_aero::AeroError::BadInput { quantity, value, expected }.into())
}

/// The whole part of a number of cycles.
#[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "at most 1e5")]
fn whole(cycles: f64) -> usize {
    cycles as usize
}

fn title(question: &LoopQuestion, flow: &str) -> String {
    format!(
        "cycle of {:?}, k {}, {}, Mach {}, {flow}",
        question.motion,
        question.reduced_frequency,
        question.section.model.name(),
        question.section.mach
    )
}
