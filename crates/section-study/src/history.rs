//! Histories of a section: after a step, along a ramp, round a cycle.

use super::{
    FASTEST, MOST_POINTS, Moved, SectionChoice, SectionTable, stall_remark, within, within_points,
};
use flap_aero::{
    AeroError, CycleStep, MarchingSection, Motion, SectionInputs, SectionState, StallAirfoil,
    StallSection, StallState, periodic_state,
};
use std::f64::consts::TAU;

/// Lowest reduced frequency of a loop, and shortest rise of a ramp, semichords: below, it is a static
/// curve or a step.
const SLOWEST: f64 = 1e-6;
/// Longest history, semichords.
const LONGEST: f64 = 1e6;
/// Largest incidence or flap angle of a loop, rad.
const HALF_TURN: f64 = std::f64::consts::PI;

/// Fewest points of a cycle, and fewest steps a cycle is marched in.
const FEWEST_POINTS: usize = 3;
const FEWEST_STEPS: usize = 720;
/// Cycles marched for a stalled loop to repeat, and the distance added to them, semichords: some
/// twenty-five decays of the slowest lag or the vortex make a difference of 1 to one of 1e-11.
const MOST_CYCLES: usize = 60;
const SETTLING_DISTANCE: f64 = 400.0;
/// Change of the normal force from cycle to cycle that counts as none.
const REPEATED: f64 = 1e-10;

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
    /// Rows per cycle, 3 or more; the cycle is marched in a multiple of them, 720 steps or more.
    pub points: usize,
    /// How the section stalls; `None` is attached flow.
    pub stall: Option<StallAirfoil>,
    /// Incidence by which it stalls later than its constants say, rad.
    pub stalls_later_rad: f64,
}

/// Columns every loop has.
const LOOP: [&str; 6] = ["phase_deg", "incidence_deg", "flap_deg", "cn", "cm", "ch"];
/// Columns a stalled loop has beside them.
const STALLED: [&str; 4] = ["cc", "cd_pressure", "f", "cn_vortex"];

/// A cycle of a motion, marched finer than it is shown.
struct Cycle {
    inputs: Vec<SectionInputs>,
    /// Length of a step, semichords.
    ds: f64,
    /// Steps to a row.
    every: usize,
    /// Incidence from which the inputs count, rad.
    zero_lift_rad: f64,
}

impl Cycle {
    fn new(question: &LoopQuestion) -> Self {
        let LoopQuestion { motion, mean_rad, amplitude_rad, reduced_frequency: k, points, .. } =
            *question;
        let every = FEWEST_STEPS.div_ceil(points);
        let steps = points * every;
        let zero_lift_rad = question.stall.map_or(0.0, StallAirfoil::zero_lift_rad);
        let inputs = (1..=steps)
            .map(|n| {
                let (sin, cos) = (TAU * n as f64 / steps as f64).sin_cos();
                let swing = [sin, k * cos, -k * k * sin].map(|part| amplitude_rad * part);
                let mut inputs = inputs(motion, swing);
                inputs.modes[0] += mean_rad - zero_lift_rad;
                inputs
            })
            .collect();
        Self { inputs, ds: TAU / k / steps as f64, every, zero_lift_rad }
    }

    /// The rows of a march, one load or more per step.
    fn rows(&self, loads: &[Vec<f64>]) -> Vec<Vec<f64>> {
        let steps = self.inputs.len() as f64;
        let ends = (self.every..=self.inputs.len()).step_by(self.every);
        ends.map(|n| {
            let modes = &self.inputs[n - 1].modes;
            let incidence_deg = (modes[0] + self.zero_lift_rad).to_degrees();
            let place = [360.0 * n as f64 / steps, incidence_deg, modes[2].to_degrees()];
            place.into_iter().chain(loads[n - 1].iter().copied()).collect()
        })
        .collect()
    }
}

/// Inputs of a motion at a value, with its first and second derivative by semichords.
fn inputs(motion: Motion, [value, rate, bend]: [f64; 3]) -> SectionInputs {
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
        inputs.rates[turning] = 2.0 * bend;
    }
    inputs
}

/// The history of a motion that moves by 1 rad (plunge: to a velocity of 1 `U`), from rest.
///
/// `rise`: distance over which it moves, semichords; 0 is a step, whose rate acts for no time.
/// `distance`: what is shown, semichords, in `points` rows after the first.
///
/// # Errors
/// [`AeroError`] for a section outside its model, a distance that is not positive, or no
/// points.
pub fn transient_history(
    choice: &SectionChoice,
    motion: Motion,
    rise: f64,
    distance: f64,
    points: usize,
) -> Result<SectionTable, AeroError> {
    let fits = distance > 0.0 && distance <= LONGEST;
    within("distance, semichords", distance, fits, "above 0, to 1e6")?;
    let fits = rise == 0.0 || (SLOWEST..=LONGEST).contains(&rise);
    within("rise, semichords", rise, fits, "0 (a step), or 1e-6 to 1e6")?;
    within_points(points)?;
    let (section, ..) = choice.coefficients()?;
    let moved = Moved { motion, reduced_frequency: None };
    let remarks = choice.remarks(&section.remarks, Some(moved));
    let section = MarchingSection::new(&section);
    let mut state = SectionState::at_rest(&section);
    // on the way up the rate is there at once, at the top it is gone at once
    let going = |s: f64| inputs(motion, [s / rise, 1.0 / rise, 0.0]);
    let arrived = inputs(motion, [1.0, 0.0, 0.0]);
    let start = if rise > 0.0 { going(0.0) } else { arrived };
    state.jump(&section, &start.modes)?;
    let row = |s: f64, loads: [f64; 3]| -> Vec<f64> {
        let value = if s < rise { s / rise } else { 1.0 };
        [s, value].into_iter().chain(loads).collect()
    };
    let mut loads = state.loads(&section, &start)?;
    let mut rows = vec![row(0.0, loads)];
    let mut at = 0.0;
    for n in 1..=points {
        let end = distance * n as f64 / points as f64;
        if at < rise {
            let stop = end.min(rise);
            loads = state.step(&section, &going(stop), stop - at)?;
            at = stop;
            if at >= rise {
                state.jump(&section, &arrived.modes)?;
            }
        }
        if at >= rise {
            loads = state.step(&section, &arrived, end - at)?;
        }
        at = end;
        rows.push(row(end, loads));
    }
    let name = choice.model.name();
    let what = if rise > 0.0 { format!("ramp over {rise} semichords") } else { "step".to_owned() };
    Ok(SectionTable {
        title: format!("unit {what} of {motion:?}, {name}, Mach {}", choice.mach),
        remarks,
        columns: match motion {
            Motion::Flap | Motion::Pitch => {
                vec!["s_semichords", "input_rad", "cn_per_rad", "cm_per_rad", "ch_per_rad"]
            }
            Motion::Plunge => vec![
                "s_semichords",
                "input_hdot_over_u",
                "cn_per_hdot_over_u",
                "cm_per_hdot_over_u",
                "ch_per_hdot_over_u",
            ],
        },
        rows,
    })
}

/// A section driven by histories of incidence and flap angle.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DrivenQuestion<'a> {
    /// The section.
    pub section: SectionChoice,
    /// Distance between two samples, semichords, above 0.
    pub step_semichords: f64,
    /// Incidence at the quarter chord at every sample, rad, nose up.
    pub incidence_rad: &'a [f64],
    /// Flap angle at every sample, rad, trailing edge down.
    pub flap_rad: &'a [f64],
    /// Whether the incidence changes by pitching about the quarter chord; else by plunging.
    pub pitches: bool,
}

/// Fewest samples of a driven section: what the rates at the ends are taken from.
const FEWEST_SAMPLES: usize = 3;

/// `[Cn, Cm, Ch]` at every sample of histories of incidence and flap angle, attached flow. Before the first sample both were
/// held for ever.
///
/// ```text
/// q = 2 d(alpha)/dS,   q_delta = 2 d(delta)/dS,     rates by differences of second order, inputs straight in between
/// ```
/// The error falls with the square of the step.
///
/// # Errors
/// [`AeroError`] for a section outside its model, a step that is not positive, fewer than three samples, histories of unequal
/// length, a number that is not finite.
pub fn driven_history(question: &DrivenQuestion<'_>) -> Result<Vec<[f64; 3]>, AeroError> {
    let DrivenQuestion { section, step_semichords: ds, incidence_rad, flap_rad, pitches } =
        *question;
    within("step, semichords", ds, ds > 0.0 && ds <= LONGEST, "above 0, to 1e6")?;
    let (samples, flaps) = (incidence_rad.len(), flap_rad.len());
    let fits = (FEWEST_SAMPLES..=MOST_POINTS).contains(&samples);
    within("number of samples of the incidence", samples as f64, fits, "3 to 1000000")?;
    let expected = "as many as of the incidence";
    within("number of samples of the flap angle", flaps as f64, flaps == samples, expected)?;
    let (coefficients, ..) = section.coefficients()?;
    let marching = MarchingSection::new(&coefficients);
    let columns = [incidence_rad, flap_rad].map(|angle| {
        let rates = slopes(angle, ds);
        let bends = slopes(&rates, ds);
        (angle, rates, bends)
    });
    let at = |n: usize| {
        let [(incidence, rise, bend), (flap, turn, turned)] = &columns;
        let pitching = if pitches { 2.0 } else { 0.0 };
        SectionInputs {
            modes: [incidence[n], pitching * rise[n], flap[n], 2.0 * turn[n]],
            rates: [rise[n], pitching * bend[n], turn[n], 2.0 * turned[n]],
        }
    };
    let first = at(0);
    let mut state = SectionState::settled(&marching, &[first.modes[0], 0.0, first.modes[2], 0.0]);
    state.jump(&marching, &first.modes)?;
    let begun = state.loads(&marching, &first);
    let rest = (1..samples).map(|n| state.step(&marching, &at(n), ds));
    std::iter::once(begun).chain(rest).collect()
}

/// Derivatives of evenly spaced values, three or more: central differences, one-sided ones of second order at the ends.
fn slopes(values: &[f64], step: f64) -> Vec<f64> {
    let last = values.len() - 1;
    let slope = |n: usize| {
        let difference = match n {
            0 => 4.0 * values[1] - 3.0 * values[0] - values[2],
            n if n == last => 3.0 * values[n] - 4.0 * values[n - 1] + values[n - 2],
            n => values[n + 1] - values[n - 1],
        };
        difference / (2.0 * step)
    };
    (0..values.len()).map(slope).collect()
}

/// One cycle of a motion that has repeated for ever.
///
/// # Errors
/// [`AeroError`] for a section outside its model or a number outside its range; also if a
/// stalled loop does not repeat within sixty cycles.
pub fn loop_history(question: &LoopQuestion) -> Result<SectionTable, AeroError> {
    let LoopQuestion { motion, mean_rad, amplitude_rad, reduced_frequency: k, points, .. } =
        *question;
    within("reduced frequency", k, (SLOWEST..=FASTEST).contains(&k), "1e-6 to 1000")?;
    for (quantity, angle_rad) in [("mean, deg", mean_rad), ("amplitude, deg", amplitude_rad)] {
        within(quantity, angle_rad.to_degrees(), angle_rad.abs() <= HALF_TURN, "-180 to 180")?;
    }
    let fits = (FEWEST_POINTS..=MOST_POINTS).contains(&points);
    within("number of points of a cycle", points as f64, fits, "3 to 1000000")?;
    let (coefficients, mach, flap) = question.section.coefficients()?;
    let moved = Moved { motion, reduced_frequency: Some(k) };
    let mut remarks = question.section.remarks(&coefficients.remarks, Some(moved));
    let section = MarchingSection::new(&coefficients);
    let cycle = Cycle::new(question);
    let steps: Vec<CycleStep<'_>> = cycle
        .inputs
        .iter()
        .map(|inputs| CycleStep { section: &section, inputs: *inputs, semichords: cycle.ds })
        .collect();
    let mut state = periodic_state(&steps)?;
    let Some(airfoil) = question.stall else {
        let march = |step: &SectionInputs| Ok(state.step(&section, step, cycle.ds)?.to_vec());
        let loads: Vec<Vec<f64>> =
            cycle.inputs.iter().map(march).collect::<Result<_, AeroError>>()?;
        return Ok(SectionTable {
            title: title(question, "attached flow"),
            remarks,
            columns: LOOP.to_vec(),
            rows: cycle.rows(&loads),
        });
    };
    remarks.extend(stall_remark(airfoil, mach.value()));
    let stalling =
        StallSection::new(mach, flap, airfoil.parameters(mach).later(question.stalls_later_rad))?
            .with_flap_effectiveness(&question.section.effectiveness);
    let last = &cycle.inputs[cycle.inputs.len() - 1];
    let [cn, ..] = state.loads(&section, last)?;
    let mut stall = StallState::settled(&stalling, cn, &last.modes);
    let mut loads: Vec<Vec<f64>> = Vec::new();
    let cycles = MOST_CYCLES + whole(SETTLING_DISTANCE * k / TAU);
    for _ in 0..cycles {
        let mut next = Vec::with_capacity(cycle.inputs.len());
        for inputs in &cycle.inputs {
            let attached = state.step(&section, inputs, cycle.ds)?;
            let l = stall.step(&stalling, attached, &inputs.modes, cycle.ds)?;
            let drag = l.pressure_drag(inputs.modes[0] + cycle.zero_lift_rad);
            let moment = l.moment + airfoil.zero_lift_moment();
            next.push(vec![l.normal, moment, l.hinge, l.chord, drag, l.separation, l.vortex]);
        }
        let change = loads.iter().zip(&next).map(|(a, b)| (a[0] - b[0]).abs()).fold(0.0, f64::max);
        let settled = loads.len() == next.len() && change <= REPEATED;
        loads = next;
        if settled {
            return Ok(SectionTable {
                title: title(question, &format!("dynamic stall, repeats to {change:.1e}")),
                remarks,
                columns: [&LOOP[..], &STALLED].concat(),
                rows: cycle.rows(&loads),
            });
        }
    }
    let quantity = "number of cycles without repetition of the stalled loop";
    let (value, expected) = (cycles as f64, "a loop that repeats; choose another frequency");
    Err(AeroError::BadInput { quantity, value, expected })
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
