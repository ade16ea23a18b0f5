//! A case marched in time with its free wake, where none is periodic: means, and how sure they are.

pub(crate) mod text;

use crate::leaving::dissimilar_note;
use rotor_case::{Case, CirculationChoice, DynamicStallChoice, InflowChoice, InflowValues};
use rotor_study::{HubLoads, StudyError, TrimmedRotor, wake_warnings};
use rotor_wake::{FlightState, WakeSymmetry, momentum_inflow};
use serde::Serialize;
use trim::{Interval, RevolutionInTime, SteadyInTime, SteadySettings, WakeOutcome, steady_in_time};

/// How a case is marched.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct InTimeQuestion {
    /// Revolutions that the wake is given to forget how it began.
    pub settling: usize,
    /// Revolutions that are measured.
    pub revolutions: usize,
}

/// A mean with its interval.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MeanLine {
    /// What it is, with its unit.
    pub name: String,
    /// The mean.
    pub mean: f64,
    /// Half of the interval that holds the true mean with 95 % probability; none from a single revolution.
    pub half_width_95: Option<f64>,
    /// Root mean square of the differences from revolution to revolution.
    pub rms: f64,
    /// The value of the periodic wake that the march began with, settled or not.
    pub periodic: Option<f64>,
}

impl MeanLine {
    fn new(name: impl Into<String>, of: &Interval, scale: f64, periodic: Option<f64>) -> Self {
        let half = of.half_width_95;
        Self {
            name: name.into(),
            mean: scale * of.mean,
            half_width_95: half.is_finite().then_some(scale.abs() * half),
            rms: scale.abs() * of.rms,
            periodic,
        }
    }
}

/// Difference from the periodic wake up to which the march agrees with it, percent.
pub(crate) const AGREES_PERCENT: f64 = 1.0;

/// How a march compares with the periodic wake that it began with.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Serialize)]
#[serde(rename_all = "snake_case")]
pub enum Verdict {
    /// Loads and mean inflow are within 1 %.
    Agrees,
    /// They are not, by more than the interval.
    Differs,
    /// The interval holds both.
    Open,
}

/// How far the means are from the periodic wake that the march began with.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct Agreement {
    /// Mean vector of the hub loads at the blade number per rev off that of the periodic wake, over its length, percent.
    pub loads_off_percent: f64,
    /// Half of its 95 % interval, percent; none from a single revolution.
    pub loads_half_width_95_percent: Option<f64>,
    /// Mean inflow off that of the periodic wake, percent.
    pub inflow_off_percent: f64,
    /// What follows.
    pub verdict: Verdict,
}

impl Agreement {
    /// Of the means of loads and inflow with those of the periodic wake.
    fn of(loads: &[Interval], inflow: &Interval, periodic: (&[f64], f64)) -> Option<Self> {
        let length = |of: &mut dyn Iterator<Item = f64>| of.map(|v| v * v).sum::<f64>().sqrt();
        let whole = length(&mut periodic.0.iter().copied());
        if !(whole > 0.0 && periodic.1 != 0.0) {
            return None;
        }
        let apart = length(&mut loads.iter().zip(periodic.0).map(|(of, value)| of.mean - value));
        let half = length(&mut loads.iter().map(|of| of.half_width_95));
        let [off, half] = [apart, half].map(|of| 100.0 * of / whole);
        let inflow_off_percent = 100.0 * (inflow.mean / periodic.1 - 1.0).abs();
        let inflow_half = 100.0 * (inflow.half_width_95 / periodic.1).abs();
        let within = |off: f64, half: f64| {
            if off + half <= AGREES_PERCENT {
                Verdict::Agrees
            } else if off - half > AGREES_PERCENT {
                Verdict::Differs
            } else {
                Verdict::Open
            }
        };
        let verdict = match (within(off, half), within(inflow_off_percent, inflow_half)) {
            (Verdict::Differs, _) | (_, Verdict::Differs) => Verdict::Differs,
            (Verdict::Agrees, Verdict::Agrees) => Verdict::Agrees,
            _ => Verdict::Open,
        };
        Some(Self {
            loads_off_percent: off,
            loads_half_width_95_percent: half.is_finite().then_some(half),
            inflow_off_percent,
            verdict,
        })
    }
}

/// What a march found.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct WakeInTimeResult {
    /// Advance ratio.
    pub advance_ratio: f64,
    /// Steps per revolution of the wake and of the blades.
    pub steps: [usize; 2],
    /// Revolutions in all, and of them those measured.
    pub revolutions: [usize; 2],
    /// Whether the means are in trim, to two thousandths of the weight or as well as can be told.
    pub balanced: bool,
    /// Largest residual of the trim of the means over the weight; none for prescribed controls.
    pub residual: Option<f64>,
    /// Whether the periodic wake that it began with had settled.
    pub periodic_settled: bool,
    /// How the means compare with it; none of one that had not settled.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub agreement: Option<Agreement>,
    /// Controls and attitude that the means ask for, deg; none for prescribed controls.
    pub controls_deg: Vec<MeanLine>,
    /// Mean inflow over the disk, tip speed, and over Glauert's.
    pub inflow: Vec<MeanLine>,
    /// Amplitude of the hub loads at the blade number per rev, revolution by revolution: rotor units.
    pub amplitudes: Vec<MeanLine>,
    /// Amplitude of what of them repeats from revolution to revolution.
    pub repeating: [f64; 6],
    /// What a user should know.
    pub warnings: Vec<String>,
}

/// A march with all its revolutions.
#[derive(Debug, Clone)]
pub struct FoundInTime {
    /// The numbers.
    pub result: WakeInTimeResult,
    /// Every revolution, those of settling first.
    pub history: Vec<RevolutionInTime>,
}

/// Names of the unknowns of a trim that are angles, in its order.
const ANGLES: [&str; 5] = ["theta0", "theta1c", "theta1s", "shaft tilt", "bank"];

/// Amplitude of a load, of itself, below which what its mean vector holds is no repeating part.
const SCATTER: f64 = 0.5;
/// Amplitude of a load over the largest force, or moment, below which nothing is said of it.
const LEAST_LOAD: f64 = 1e-3;

/// Trims a case in its periodic free wake as far as that goes, then marches rotor and wake in time and measures them; a case with
/// another inflow gets the default wake. `watch` is told the revolutions done, and those there are to be.
///
/// # Errors
/// [`StudyError::Refused`] for a wake of prescribed circulation; the errors of the rotor, of the trim and of the march.
pub fn wake_in_time(
    case: &Case,
    question: InTimeQuestion,
    watch: &mut dyn FnMut(usize, usize),
) -> Result<FoundInTime, StudyError> {
    let file = case.inflow.model.free_wake().unwrap_or_default();
    if matches!(file.circulation, CirculationChoice::Prescribed(_)) {
        return Err(refused(
            "inflow.model",
            "a wake of prescribed circulation is not marched with the blades: expected `circulation: Trimmed`",
        ));
    }
    if file.choices().symmetry == WakeSymmetry::Axial {
        return Err(refused(
            "inflow.model.symmetry",
            "an axial wake, whose blades are alike, is not marched: expected Periodic",
        ));
    }
    if case.aerodynamics.dynamic_stall != DynamicStallChoice::Off {
        return Err(refused(
            "aerodynamics.dynamic_stall",
            "sections that stall dynamically are not marched with the blades: expected Off",
        ));
    }
    let model = InflowChoice::FreeWake(file);
    let case = Case { inflow: InflowValues { model }, ..case.clone() };
    let trimmed = TrimmedRotor::new(&case, None)?;
    let begun = trimmed
        .wake()
        .ok_or_else(|| refused("inflow.model", "the rotor was trimmed without a free wake"))?;
    let settings = SteadySettings {
        settling: question.settling,
        revolutions: question.revolutions,
        ..SteadySettings::default()
    };
    let still = vec![[0.0; 3]; case.flaps.len()];
    let mut done = 0;
    let found = steady_in_time(
        trimmed.solver(),
        begun,
        &case.trim_target(),
        &settings,
        &|_, _, _| still.clone(),
        &mut |_, least| {
            done += 1;
            watch(done, least);
        },
    );
    let found =
        found.map_err(|source| StudyError::Trim { field: "inflow.model".to_owned(), source })?;
    Ok(FoundInTime { result: result_of(&case, &trimmed, &found), history: found.history })
}

fn refused(field: &str, message: &str) -> StudyError {
    StudyError::Refused { field: field.to_owned(), message: message.to_owned() }
}

fn result_of(case: &Case, trimmed: &TrimmedRotor, found: &SteadyInTime) -> WakeInTimeResult {
    let periodic = trimmed.trim();
    // a state that diverged is none to compare with
    let diverged = trimmed.wake().is_some_and(|wake| wake.outcome.is_diverged());
    let shown = |value: f64| (!diverged).then_some(value);
    let (c, a) = (&periodic.controls, &periodic.attitude);
    let angles = [c.theta0_rad, c.theta1c_rad, c.theta1s_rad, a.shaft_tilt_rad, a.roll_rad];
    let deg = 1.0_f64.to_degrees();
    let asked = found.asked_for.iter().zip(ANGLES).zip(angles);
    let controls_deg = asked
        .map(|((of, name), periodic)| {
            MeanLine::new(format!("{name}, deg"), of, deg, shown(periodic.to_degrees()))
        })
        .collect();
    let mean = periodic.rotor.inflow.mean();
    let glauert = |flight: &FlightState, ct: f64| {
        momentum_inflow(flight, ct).ok().filter(|induced| *induced > 0.0)
    };
    let of_periodic = glauert(&periodic.flight, periodic.rotor.thrust_coefficient);
    let mut inflow =
        vec![MeanLine::new("mean inflow, tip speed", &found.mean_inflow, 1.0, shown(mean))];
    if let Some(g) = glauert(&found.flight, thrust_coefficient(trimmed, found)) {
        let name = "mean inflow over Glauert's";
        let before = of_periodic.and_then(|g| shown(mean / g));
        inflow.push(MeanLine::new(name, &found.mean_inflow, 1.0 / g, before));
    }
    let at_blade_number = periodic.rotor.hub.harmonic(case.rotor.blades);
    let hub = HubLoads::from_parts(at_blade_number).amplitudes();
    let loads = found.amplitudes.iter().zip(HubLoads::NAMES).zip(hub);
    let amplitudes: Vec<MeanLine> = loads
        .map(|((of, name), periodic)| MeanLine::new(name.to_uppercase(), of, 1.0, shown(periodic)))
        .collect();
    // a mean of vectors of any phase has a length by chance, which is taken off
    let repeating = std::array::from_fn(|k| {
        let parts = &found.at_blade_number[2 * k..2 * k + 2];
        let squares = |part: &Interval| part.mean * part.mean - by_chance(part);
        parts.iter().map(squares).sum::<f64>().max(0.0).sqrt()
    });
    let residual = found.residuals.iter().map(|r| r.mean.abs()).reduce(f64::max);
    let periodic_settled = trimmed.wake().is_some_and(|wake| wake.outcome == WakeOutcome::Settled);
    WakeInTimeResult {
        advance_ratio: case.advance_ratio,
        steps: [found.end.steps_per_revolution(), found.end.blade_steps_per_revolution()],
        revolutions: [found.history.len(), found.measured],
        balanced: found.balanced,
        residual,
        periodic_settled,
        agreement: periodic_settled
            .then(|| {
                let of_periodic = (&at_blade_number[..], mean);
                Agreement::of(&found.at_blade_number, &found.mean_inflow, of_periodic)
            })
            .flatten(),
        warnings: warnings(case, trimmed, found, (&amplitudes, &repeating), periodic_settled),
        controls_deg,
        inflow,
        amplitudes,
        repeating,
    }
}

/// What the square of a mean is by chance: half an interval is some two standard errors.
fn by_chance(of: &Interval) -> f64 {
    if of.half_width_95.is_finite() { 0.25 * of.half_width_95 * of.half_width_95 } else { 0.0 }
}

/// Thrust coefficient of the means: what the hub carries besides the weight of the blades.
fn thrust_coefficient(trimmed: &TrimmedRotor, found: &SteadyInTime) -> f64 {
    let rotor = trimmed.solver().rotor();
    let up = found.flight.shaft_tilt_rad.cos() * found.attitude.roll_rad.cos();
    rotor.model().thrust_coefficient(found.mean[2].mean + rotor.blades_weight() * up)
}

fn warnings(
    case: &Case,
    trimmed: &TrimmedRotor,
    found: &SteadyInTime,
    (amplitudes, repeating): (&[MeanLine], &[f64; 6]),
    periodic_settled: bool,
) -> Vec<String> {
    // how the start ended matters only where it is compared with
    let begun = trimmed.wake().filter(|wake| wake.outcome.is_diverged());
    let mut out: Vec<String> = begun.map(wake_warnings).unwrap_or_default();
    out.extend(dissimilar_note(case));
    let wanted = case.inflow.model.free_wake().map(|file| case.wake_trim_settings(&file).wake);
    if let Some(wanted) = wanted.filter(|w| w.azimuths != found.end.steps_per_revolution()) {
        out.push(format!(
            "the wake was marched on the grid that the trim had reached, of {} steps, not of {}",
            found.end.steps_per_revolution(),
            wanted.azimuths
        ));
    }
    if !found.balanced {
        out.push(
            "the means are not in trim, beyond their own intervals. Remedy: more revolutions of settling"
                .to_owned(),
        );
    }
    let wanders = |(line, repeating): (&MeanLine, &f64)| *repeating < SCATTER * line.mean;
    let largest =
        |from: usize| amplitudes[from..from + 3].iter().map(|l| l.mean).fold(0.0, f64::max);
    // loads at the level of rounding wander always
    let counts = |k: usize| amplitudes[k].mean > LEAST_LOAD * largest(k / 3 * 3);
    if amplitudes.iter().zip(repeating).enumerate().any(|(k, load)| counts(k) && wanders(load)) {
        out.push(
            "phases at the blade number per rev wander from revolution to revolution: less than half of an amplitude repeats, and no control at a fixed phase takes away more than that"
                .to_owned(),
        );
    }
    if !periodic_settled {
        out.push(
            "no periodic wake was found, and intervals are those of one grid: compare `azimuths` of 36 and 72 before you use an amplitude"
                .to_owned(),
        );
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_march_agrees_differs_or_cannot_tell() {
        let of = |mean: f64, half_width_95: f64| Interval { mean, half_width_95, rms: 0.0 };
        let verdict = |loads: [Interval; 2], inflow: Interval| {
            let found = Agreement::of(&loads, &inflow, (&[3.0, 4.0], 0.02)).unwrap();
            (found.verdict, found.loads_off_percent)
        };
        let calm = of(0.0201, 0.0);
        // 0.8 % of the length 5, and 2 % of it
        let (said, off) = verdict([of(3.04, 0.001), of(4.0, 0.001)], calm);
        assert!(said == Verdict::Agrees && (off - 0.8).abs() < 1e-9, "{said:?} {off}");
        // near, but an interval that reaches far is no agreement
        assert_eq!(verdict([of(3.04, 0.01), of(4.0, 0.01)], calm).0, Verdict::Open);
        assert_eq!(verdict([of(3.1, 0.01), of(4.0, 0.01)], calm).0, Verdict::Differs);
        assert_eq!(verdict([of(3.1, 0.1), of(4.0, 0.1)], calm).0, Verdict::Open);
        assert_eq!(verdict([of(3.0, 0.0), of(4.0, 0.0)], of(0.021, 0.0)).0, Verdict::Differs);
        assert_eq!(verdict([of(3.0, 0.0), of(4.0, 0.0)], of(0.021, 0.001)).0, Verdict::Open);
        // one revolution has no interval
        assert_eq!(
            verdict([of(3.1, f64::INFINITY), of(4.0, f64::INFINITY)], calm).0,
            Verdict::Open
        );
        assert_eq!(Agreement::of(&[of(0.0, 0.0)], &calm, (&[0.0], 0.02)), None);
    }
}
