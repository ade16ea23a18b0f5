//! The control study of the paper's case: what must hold whatever the numbers are.

use std::sync::LazyLock;

use hhc_control::{ControlLayout, ControlLimits, FeedbackLaw, LoadWeights, TMatrix};
use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_response::InflowState;
use rotor_study::{FlapAuthority, HubLoads, Setting, TrimmedRotor, control_status};
use sim_driver::SimError;
use sim_driver::actuator::{CaseActuators, case_actuators};
use sim_driver::case::{
    CONTROLLERS_CASE, ControlActuator, ControlValues, ControllerChoice, EffortChoice,
    FreeWakeValues, InflowChoice, LoadScaleChoice, LoadedCase, PAPER_CASE, StrokeChoice,
    TInflowChoice, shipped_case,
};
use sim_driver::progress::Progress;
use sim_driver::results::ControlLine;
use sim_driver::run::{RunOutcome, run_case, run_trimmed};
use sim_driver::sweep::continued_trim;
use validation::{Check, Failure, row, shared, too_few, worst};

const SELF: &str = "the study itself, Drees inflow, advance ratio 0.30";

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-STUDY-01",
        "T of the linearised rotor, 2 flaps at 2 to 5/rev, inflow settled: distance \
         from central differences of 0.5 deg over their norm",
        "-",
    )
    .against("converged solutions with moved flaps")
    .at_most(1e-4, linearised_error),
    row(
        "V-STUDY-02",
        "feedback on the hysteretic actuator, 2, 3, 4/rev: J over that of \
         hysteresis ignored, worst",
        "-",
    )
    .against(SELF)
    .at_most(1.0, over_ignored),
    row("V-STUDY-03", "the same: halved steps at 3/rev", "-")
        .against(SELF)
        .at_most(0.0, || Ok(f64::from(line(&[3], "hysteretic")?.head.backtracks))),
    row(
        "V-STUDY-04",
        "inverse of the actuator, every set of harmonics: error of the wanted flap \
         motion, worst; wanted is the ideal actuator's motion, but for 2 to 5/rev \
         together, where the range of voltages does not hold that, the motion of \
         least J within it",
        "%",
    )
    .against(SELF)
    .at_most(1.0, inverse_error),
    row("V-STUDY-05", "mean flap angle, every actuator and control step: largest", "deg")
        .against("the bias is solved for, paper equation (6)")
        .at_most(0.01, || {
            let lines = study()?;
            worst("lines", lines.len(), lines.iter().map(|l| Ok(l.largest_mean_flap_deg)))
        }),
    row(
        "V-STUDY-06",
        "feedback on the hysteretic actuator from zero, 2, 3, 4, 5/rev and all \
         together with local T and limits, 2, 3, 4/rev with constant T and tuned \
         weight: loops that did not converge",
        "-",
    )
    .against(SELF)
    .at_most(0.0, not_converged),
    row("V-STUDY-07", "constant T, tuned weight: halved steps at 3/rev", "-")
        .against(SELF)
        .at_most(0.0, || {
            let three = fed_back(paper_study()?).find(|l| l.head.harmonics == [3]);
            let found = three.map(|l| f64::from(l.head.backtracks));
            found.ok_or(too_few("lines of the study", 0, 1))
        }),
    row(
        "V-STUDY-08",
        "T of the paper's rotor at 4/rev, every load weighted by its own baseline, \
         limits of .03 and .11 of what the flaps would take, so that both bind: J \
         of the cone optimum over the best of 10000 random controls that keep the \
         limits",
        "-",
    )
    .against("enumeration")
    .at_most(1.0, || Ok(binding(BOTH_BIND)?.random)),
    row(
        "V-STUDY-09",
        "the same over the optimum of the weight tuned to the limit: 1 if the cone \
         program were that",
        "-",
    )
    .against("bisection on the weight")
    .at_most(0.95, || Ok(binding(BOTH_BIND)?.weighted)),
    row(
        "V-STUDY-10",
        "the same with equal weights and limits of .5 and .2, over the \
         unconstrained step clipped flap by flap",
        "-",
    )
    .against("the trap, shown beside it")
    .at_most(0.8, || Ok(binding(CLIPPED)?.clipped)),
    row(
        "V-STUDY-11",
        "actuation power limited to .01, .1 and 1 W, 2, 3, 4/rev and all together, \
         ideal and hysteretic: power over the limit, largest; a loop that does not \
         converge counts as infinite",
        "-",
    )
    .against("mean of the positive part of hinge moment times rate, controlled response")
    .at_most(1.0, power_over_limit),
    row(
        "V-STUDY-12",
        "constant T and tuned weight from zero at advance ratios 0.05, 0.10, 0.15 \
         and 0.25, 2, 3, 4/rev: loops that did not converge",
        "-",
    )
    .against(SLOWER)
    .at_most(0.0, || {
        let all: Vec<_> = slower()?.iter().filter(|l| l.head.actuator == "hysteretic").collect();
        // as many loops as were asked for
        worst("loops", 12, all.iter().map(|_| Ok(0.0)))?;
        Ok(all.iter().filter(|l| l.head.status != "converged").count() as f64)
    }),
    row("V-STUDY-13", "the same: J over that of hysteresis ignored, worst", "-")
        .against(SLOWER)
        .at_most(1.0, || {
            let fed_back: Vec<_> =
                slower()?.iter().filter(|l| l.head.actuator == "hysteretic").collect();
            let ignored = slower()?.iter().filter(|l| l.head.actuator == "ignored");
            let ratios = fed_back.iter().zip(ignored).map(|(a, b)| Ok(a.j_after / b.j_after));
            worst("loops", 12, ratios)
        }),
    row(
        "V-STUDY-14",
        "stroke limit given, 1 deg, feedback within limits, 2, 3, 4, 5/rev and all \
         together: largest flap harmonic over the limit",
        "-",
    )
    .against("the motion of the hysteretic actuator itself")
    .at_most(1.0, || Ok(given_stroke()?.0)),
    row(
        "V-STUDY-15",
        "the same: how far the largest flap harmonic of a set stays below the \
         limit, worst",
        "-",
    )
    .against("all sets bind at 1 deg")
    .at_most(0.005, || Ok(given_stroke()?.1)),
    row(
        "V-STUDY-16",
        "T in a free wake by differences with its geometry held, 2, 3, 4, 5/rev: \
         distance from T of the linearised rotor over its norm, largest",
        "-",
    )
    .against("two ways to the same matrix")
    .at_most(1e-3, || Ok(in_free_wake()?.held)),
    row(
        "V-STUDY-17",
        "the same differences with the geometry converged anew: change in the last \
         update of the wake, over the difference, largest",
        "-",
    )
    .against("the sequence of updates")
    .at_most(1e-3, || Ok(in_free_wake()?.change)),
    row(
        "V-STUDY-18",
        "what the geometry does to T: distance of the one converged anew from the \
         one held over its norm",
        "-",
    )
    .against("shown, not zero: the geometry has moved")
    .at_least(0.005, || Ok(in_free_wake()?.moved)),
    row(
        "V-STUDY-22",
        "T of the linearised rotor with the whole answer of its free wake, 2, 3, 4, \
         5/rev: distance from that by differences over its norm, largest",
        "-",
    )
    .against("two ways to the same matrix")
    .at_most(0.02, || Ok(in_free_wake()?.linearised)),
    row("V-STUDY-23", "the same with the geometry held: what leaving its answer out costs", "-")
        .against("shown, not within the bound of the row before")
        .at_least(0.04, || Ok(in_free_wake()?.left_out)),
    row(
        "V-STUDY-19",
        "inverse of 2 to 5/rev together, planned within the range of voltages, \
         advance ratios .30 and .15: J over that of no control, less the same of \
         feedback; largest",
        "-",
    )
    .against(SELF)
    .at_most(0.005, inverse_over_feedback)
    .long(),
    row(
        "V-STUDY-20",
        "loops called converged, all controllers, with and without limits, power \
         limited to .3 W: largest voltage harmonic still asked for over the largest \
         there is, in units of the tolerance, whole steps",
        "-",
    )
    .against("formed anew from T, loads and control of the record")
    .at_most(10.0, still_asked)
    .long(),
];

/// T in a free wake: largest distance at 2 to 5/rev.
struct InFreeWake {
    held: f64,
    change: f64,
    moved: f64,
    linearised: f64,
    left_out: f64,
}

/// Distance of the loads that a flap harmonic makes in one T from those in another, over the latter.
fn distance_at(harmonic: usize, a: &FlapAuthority, b: &FlapAuthority) -> f64 {
    let mut sums = [0.0, 0.0];
    for (flap, sine) in [(0, false), (0, true), (1, false), (1, true)] {
        let mut unit = HarmonicSeries::zero(harmonic);
        let (cosine, sine) = if sine { (0.0, 1.0) } else { (1.0, 0.0) };
        unit.set_harmonic(harmonic, Harmonic { cosine, sine });
        for (x, y) in a.loads(flap, &unit).into_iter().zip(b.loads(flap, &unit)) {
            sums[0] += (x - y).powi(2);
            sums[1] += y * y;
        }
    }
    (sums[0] / sums[1]).sqrt()
}

fn in_free_wake() -> Result<&'static InFreeWake, Failure> {
    static FOUND: LazyLock<Result<InFreeWake, Failure>> = LazyLock::new(|| {
        let mut loaded = controllers_case()?;
        loaded.case.inflow.model = InflowChoice::FreeWake(FreeWakeValues::default());
        loaded.case.control.harmonics = vec![vec![2], vec![3], vec![4], vec![5]];
        loaded.case.control.t_inflow = TInflowChoice::Reconverged;
        let rotor = TrimmedRotor::new(&loaded.case, None).map_err(SimError::from)?;
        let settled = rotor.linearised(InflowState::Settled)?;
        let none = || too_few("free wakes", 0, 1);
        let linearised = rotor.reconverged()?.ok_or_else(none)?;
        let anew = rotor.reconverged_by_differences()?.ok_or_else(none)?;
        let largest = |a: &FlapAuthority, b: &FlapAuthority| {
            (2..=5).map(|n| distance_at(n, a, b)).fold(0.0, f64::max)
        };
        Ok(InFreeWake {
            held: largest(&anew.held, settled),
            change: anew.change,
            moved: distance_at(3, &anew.authority, settled),
            linearised: largest(&linearised.authority, &anew.authority),
            left_out: largest(settled, &anew.authority),
        })
    });
    shared(&FOUND)
}

fn inverse_over_feedback() -> Result<f64, Failure> {
    let mut excess = Vec::new();
    for mu in [0.30, 0.15] {
        let (mut loaded, actuators, _) = ground()?;
        loaded.case.advance_ratio = mu;
        loaded.case.control.harmonics = vec![vec![2, 3, 4, 5]];
        loaded.case.control.actuators =
            vec![ControlActuator::Ideal, ControlActuator::Hysteretic, ControlActuator::Inverse];
        let trimmed = continued_trim(&loaded, None)?;
        let run = run_trimmed(&loaded, actuators, trimmed, &Progress::hidden())?;
        let lines = run.figures().control;
        let [_, fed_back, inverse] = lines.as_slice() else {
            return Err(too_few("lines", lines.len(), 3));
        };
        excess.push((inverse.j_after - fed_back.j_after) / inverse.j_before);
    }
    worst("advance ratios", 2, excess.into_iter().map(Ok))
}

fn still_asked() -> Result<f64, Failure> {
    let ways = [
        (ControllerChoice::Local, EffortChoice::Limits, Some(0.3)),
        (ControllerChoice::Global, EffortChoice::Limits, None),
        (ControllerChoice::Adaptive, EffortChoice::Limits, None),
        (ControllerChoice::Global, EffortChoice::MeetStroke, None),
    ];
    let mut asked = Vec::new();
    for (controller, effort, power_limit_watt) in ways {
        let outcome = controlled(|control| {
            control.harmonics = vec![vec![2], vec![3], vec![4], vec![2, 3, 4, 5]];
            control.actuators = vec![ControlActuator::Ideal, ControlActuator::Hysteretic];
            (control.controller, control.effort) = (controller, effort);
            control.power_limit_watt = power_limit_watt;
        })?;
        for study in outcome.studies {
            if let Some(run) = &study.run
                && control_status(&study) == "converged"
            {
                asked.push(Ok(run.end.asked_volt / run.end.size_volt / study.step_tolerance));
            }
        }
    }
    worst("converged loops", 12, asked)
}

const SLOWER: &str = "the study itself, Drees inflow";

/// The paper's case at other advance ratios, one after another.
fn slower() -> Result<&'static [ControlLine], Failure> {
    static LINES: LazyLock<Result<Vec<ControlLine>, Failure>> = LazyLock::new(|| {
        let loaded = shipped_case(PAPER_CASE).map_err(SimError::from)?;
        let actuators = case_actuators(&loaded)?;
        let mut lines = Vec::new();
        for mu in [0.05, 0.10, 0.15, 0.25] {
            let mut here = loaded.clone();
            here.case.advance_ratio = mu;
            let rotor = TrimmedRotor::new(&here.case, None).map_err(SimError::from)?;
            let run = run_trimmed(&here, actuators.clone(), rotor, &Progress::hidden())?;
            lines.extend(run.figures().control);
        }
        Ok(lines)
    });
    Ok(shared(&LINES)?)
}

/// Largest flap harmonic over a limit of 1 deg, and how far the largest of a set stays below it.
fn given_stroke() -> Result<(f64, f64), Failure> {
    static FOUND: LazyLock<Result<(f64, f64), Failure>> = LazyLock::new(|| {
        let outcome = controlled(|control| {
            control.stroke_limit = StrokeChoice::Given { amplitude_deg: 1.0 };
            control.actuators = vec![ControlActuator::Hysteretic];
        })?;
        let lines = outcome.figures().control;
        let largest = lines.iter().map(|line| {
            let flaps = line.flaps.iter().map(|flap| flap.flap_amplitude_deg);
            flaps.fold(0.0, f64::max)
        });
        let (over, under) =
            largest.fold((0.0_f64, 0.0_f64), |(o, u), a| (o.max(a), u.max(1.0 - a)));
        Ok((over, under))
    });
    shared(&FOUND).copied()
}

/// The paper's case: constant T, weight tuned to the stroke.
fn paper_study() -> Result<&'static [ControlLine], Failure> {
    static LINES: LazyLock<Result<Vec<ControlLine>, Failure>> = LazyLock::new(|| {
        let outcome =
            run_case(&shipped_case(PAPER_CASE).map_err(SimError::from)?, &Progress::hidden())?;
        Ok(outcome.figures().control)
    });
    Ok(shared(&LINES)?)
}

fn fed_back(lines: &'static [ControlLine]) -> impl Iterator<Item = &'static ControlLine> {
    lines.iter().filter(|l| l.head.actuator == "hysteretic")
}

fn not_converged() -> Result<f64, Failure> {
    let all: Vec<&ControlLine> = fed_back(study()?).chain(fed_back(paper_study()?)).collect();
    if all.len() < 8 {
        return Err(too_few("feedback loops", all.len(), 8));
    }
    Ok(all.iter().filter(|l| l.head.status != "converged").count() as f64)
}

fn power_over_limit() -> Result<f64, Failure> {
    let mut shares = Vec::new();
    for limit_watt in [0.01, 0.1, 1.0] {
        let outcome = controlled(|control| {
            control.harmonics = vec![vec![2], vec![3], vec![4], vec![2, 3, 4, 5]];
            control.actuators = vec![ControlActuator::Ideal, ControlActuator::Hysteretic];
            control.power_limit_watt = Some(limit_watt);
        })?;
        let lines = outcome.figures().control;
        shares.extend(lines.iter().map(|line| match line.head.status.as_str() {
            "converged" => line.actuation_power_watt / limit_watt,
            _ => f64::INFINITY,
        }));
    }
    worst("lines", 24, shares.into_iter().map(Ok))
}

/// Cost of the cone optimum over that of what else can be done.
struct Binding {
    random: f64,
    weighted: f64,
    clipped: f64,
}

/// Limits of the two flaps as shares of what each would take without, and the scale of the load weights.
type Binds = ([f64; 2], LoadScaleChoice);

/// Both limits bind, and one weight for both flaps holds the larger one back.
const BOTH_BIND: Binds = ([0.03, 0.11], LoadScaleChoice::Baseline);
/// A clipped step turns away from the optimum.
const CLIPPED: Binds = ([0.5, 0.2], LoadScaleChoice::Nondimensional);

/// The flaps at 4/rev within limits, linear in the flap angle, deg.
fn binding((shares, scale): Binds) -> Result<Binding, Failure> {
    let mut loaded = controllers_case()?;
    loaded.case.control.load_scale = scale;
    let rotor = TrimmedRotor::new(&loaded.case, None).map_err(SimError::from)?;
    let authority = rotor.linearised(InflowState::Settled)?;
    let columns: Vec<Vec<f64>> = [(0, false), (0, true), (1, false), (1, true)]
        .into_iter()
        .map(|(flap, sine)| {
            let mut unit = HarmonicSeries::zero(4);
            let (cosine, sine) = if sine { (0.0, 1.0) } else { (1.0, 0.0) };
            unit.set_harmonic(4, Harmonic { cosine, sine });
            authority.loads(flap, &unit).to_vec()
        })
        .collect();
    let t = TMatrix::from_columns(&columns)?;
    let loads = rotor.trim().rotor.hub.harmonic(4);
    let setting = Setting::of_case(&loaded.case, &HubLoads::from_parts(loads));
    let weights: Vec<f64> = setting.load_weights().into_iter().flat_map(|w| [w, w]).collect();
    let law = FeedbackLaw::new(&t, &LoadWeights::Diagonal(weights.clone()))?;
    let cost = |u: &[f64]| -> Result<f64, Failure> {
        let pairs = t.loads_for(u)?.into_iter().zip(loads).zip(&weights);
        Ok(pairs.map(|((a, b), w)| w * (a + b).powi(2)).sum())
    };
    let free = law.optimum_volt(0.0, &[0.0; 4], &loads)?;
    let size = |u: &[f64]| [u[0].hypot(u[1]), u[2].hypot(u[3])];
    let own = size(&free);
    let limit = [shares[0] * own[0], shares[1] * own[1]];
    let layout = ControlLayout::new(2, vec![4])?;
    let limits = ControlLimits::none(&layout).with_amplitudes_volt(limit.to_vec())?;
    let cone = law.optimum_within(0.0, &[0.0; 4], &loads, &limits)?;
    let best = cost(&cone.control_volt)?;
    let used = size(&cone.control_volt);
    if scale == LoadScaleChoice::Baseline && (0..2).any(|k| used[k] < 0.999 * limit[k]) {
        return Err(too_few("limits that bind", 1, 2));
    }
    let mut random = uniform();
    let mut enumerated = f64::INFINITY;
    for k in 0..10_000 {
        let u: Vec<f64> = (0..4).map(|i| limit[i / 2] * random()).collect();
        // one half anywhere inside, one half at the limits
        let usage = limits.usage(&u)?;
        let part = if k % 2 == 0 { usage.max(1.0) } else { usage };
        let u: Vec<f64> = u.iter().map(|v| v / part).collect();
        enumerated = enumerated.min(cost(&u)?);
    }
    let authority_scale = law.singular_values().first().map_or(1.0, |s| s * s);
    let (mut low, mut high) = (-40.0_f64, 40.0_f64);
    for _ in 0..100 {
        let middle = f64::midpoint(low, high);
        let u = law.optimum_volt(authority_scale * middle.exp(), &[0.0; 4], &loads)?;
        if limits.usage(&u)? > 1.0 { low = middle } else { high = middle }
    }
    let weighted = law.optimum_volt(authority_scale * high.exp(), &[0.0; 4], &loads)?;
    let clipped: Vec<f64> = free
        .chunks_exact(2)
        .zip(limit.iter().zip(size(&free)))
        .flat_map(|(u, (limit, size))| [u[0], u[1]].map(|v| v * (limit / size).min(1.0)))
        .collect();
    Ok(Binding {
        random: best / enumerated,
        weighted: best / cost(&weighted)?,
        clipped: best / cost(&clipped)?,
    })
}

/// Numbers in -1..1, uniform and always the same.
fn uniform() -> impl FnMut() -> f64 {
    let mut state = 7_u64;
    move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

fn controllers_case() -> Result<LoadedCase, SimError> {
    Ok(shipped_case(CONTROLLERS_CASE)?)
}

/// The case with all controllers, its actuators and its trim.
type Ground = (LoadedCase, CaseActuators, TrimmedRotor);

/// Found once: what does not depend on the control.
fn ground() -> Result<Ground, Failure> {
    static GROUND: LazyLock<Result<Ground, Failure>> = LazyLock::new(|| {
        let loaded = controllers_case()?;
        let actuators = case_actuators(&loaded)?;
        let trimmed = continued_trim(&loaded, None)?;
        Ok((loaded, actuators, trimmed))
    });
    Ok(shared(&GROUND)?.clone())
}

/// That case with its control changed.
fn controlled(change: impl FnOnce(&mut ControlValues)) -> Result<RunOutcome, Failure> {
    let (mut loaded, actuators, trimmed) = ground()?;
    change(&mut loaded.case.control);
    Ok(run_trimmed(&loaded, actuators, trimmed, &Progress::hidden())?)
}

/// Every control of the case with all controllers, computed once.
fn study() -> Result<&'static [ControlLine], Failure> {
    static LINES: LazyLock<Result<Vec<ControlLine>, Failure>> =
        LazyLock::new(|| Ok(controlled(|_| {})?.figures().control));
    Ok(shared(&LINES)?)
}

fn line(harmonics: &[usize], actuator: &str) -> Result<&'static ControlLine, Failure> {
    let found =
        study()?.iter().find(|l| l.head.harmonics == harmonics && l.head.actuator == actuator);
    found.ok_or(too_few("lines of the study", 0, 1))
}

fn over_ignored() -> Result<f64, Failure> {
    let ratio = |n: usize| {
        let (fed_back, ignored) = (line(&[n], "hysteretic")?, line(&[n], "ignored")?);
        Ok(fed_back.j_after / ignored.j_after)
    };
    worst("harmonics", 3, [2, 3, 4].map(ratio))
}

fn inverse_error() -> Result<f64, Failure> {
    let inverse: Vec<&ControlLine> =
        study()?.iter().filter(|l| l.head.actuator == "inverse").collect();
    let errors = inverse.iter().map(|l| Ok(l.motion_error_percent.unwrap_or(f64::NAN)));
    worst("sets", 5, errors)
}

fn linearised_error() -> Result<f64, Failure> {
    let loaded = controllers_case()?;
    let rotor = TrimmedRotor::new(&loaded.case, None).map_err(SimError::from)?;
    let linear = rotor.linearised(InflowState::Settled)?;
    let controls: Vec<(usize, usize, bool)> = (0..2)
        .flat_map(|flap| (2..=5).flat_map(move |n| [(flap, n, false), (flap, n, true)]))
        .collect();
    let columns = controls
        .into_par_iter()
        .map(|(flap, n, sine)| {
            let moved = |deg: f64| {
                let mut angles = vec![HarmonicSeries::zero(n); 2];
                let (cosine, sine) = if sine { (0.0, deg) } else { (deg, 0.0) };
                angles[flap].set_harmonic(n, Harmonic { cosine, sine });
                angles
            };
            let loads = |deg: f64| -> Result<[f64; 12], Failure> {
                Ok(rotor.with_flaps(moved(deg.to_radians()))?.hub.harmonic(4))
            };
            let (plus, minus) = (loads(0.5)?, loads(-0.5)?);
            let along = linear.loads(flap, &moved(1.0)[flap]);
            let exact: [f64; 12] = std::array::from_fn(|k| plus[k] - minus[k]);
            Ok((0..12).fold([0.0, 0.0], |[off, whole], k| {
                [off + (along[k] - exact[k]).powi(2), whole + exact[k].powi(2)]
            }))
        })
        .collect::<Result<Vec<[f64; 2]>, Failure>>()?;
    let sum = |which: usize| columns.iter().map(|c| c[which]).sum::<f64>();
    Ok((sum(0) / sum(1)).sqrt())
}
