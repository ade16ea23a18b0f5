//! The voltage for a wanted history of the flap: sample by sample, then by learning.

use preisach_dyn::{
    ActuatorLaw, ActuatorModel, AmplifierStage, HystereticOscillator, LinkageStage, PreisachError,
    Resonance, StartState,
};
use serde::{Deserialize, Serialize};
use std::f64::consts::TAU;

/// Settings of the inverse of a history.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct HistoryInverseSettings {
    /// Rms error at which it ends, as a fraction of half of the peak to peak of the wanted motion.
    pub tolerance: f64,
    /// Simulations to try.
    pub largest_iterations: usize,
}

impl Default for HistoryInverseSettings {
    /// 1e-5 of the amplitude, within 400 simulations.
    fn default() -> Self {
        Self { tolerance: 1e-5, largest_iterations: 400 }
    }
}

/// A voltage history and what the flap does under it.
#[derive(Debug, Clone, PartialEq)]
pub struct HistoryInverse {
    /// Voltage at every sample, V, within the range of the actuator.
    pub voltage_volt: Vec<f64>,
    /// Flap angle at every sample, deg.
    pub output_deg: Vec<f64>,
    /// Largest error left, deg.
    pub largest_error_deg: f64,
    /// Rms error left, deg.
    pub rms_error_deg: f64,
    /// Half of the peak to peak of the wanted motion, deg.
    pub amplitude_deg: f64,
    /// Samples whose voltage is an end of the range.
    pub at_limit: usize,
    /// Simulations made.
    pub iterations: usize,
    /// Whether the tolerance was met.
    pub is_met: bool,
}

/// Errors must fall by this part for the iteration to be worth going on, over [`PATIENCE`] of them.
const WORTH: f64 = 1e-3;
/// Iterations without a worthy fall before the end.
const PATIENCE: usize = 12;
/// Smallest step of learning, over that of the linear gain.
const SMALLEST: f64 = 1e-3;

/// The voltage under which the flap follows a wanted history, from rest at its first sample, and the error that is left.
///
/// It starts from the better of two voltages: what the linear gain asks for, and what brings the flap to the wanted angle
/// sample by sample with the memory at hand (of laws with rate too, but not behind a delay or a mode). Then it learns:
///
/// ```text
/// u_(k+1) = clamp(u_k + s L^-1 (wanted - flap[u_k]) / gain)
/// ```
/// `gain` is the rise of the flap over the whole voltage range, `L` what lags, delays and modes do to it, that of an oscillator with them. The
/// step `s` is 1; it is halved where the error grows. What cannot be had (a motion beyond the range, a corner behind a lag) stays as error: it is reported, no failure.
///
/// | argument | meaning | unit |
/// |---|---|---|
/// | `wanted_deg` | flap angle at every sample, two or more | deg |
/// | `time_step_s` | time between two samples, above 0 | s |
///
/// # Errors
/// [`PreisachError::OutOfRange`] for fewer than two samples, a time step or settings not above 0, an actuator that does not
/// move; [`PreisachError::NotFinite`]; the errors of [`ActuatorModel::simulate`].
pub fn history_inverse(
    model: &ActuatorModel,
    wanted_deg: &[f64],
    time_step_s: f64,
    settings: &HistoryInverseSettings,
) -> Result<HistoryInverse, PreisachError> {
    check_count("wanted samples", wanted_deg.len(), 2)?;
    check_finite("wanted output (deg)", wanted_deg)?;
    check_positive("tolerance", settings.tolerance)?;
    check_count("largest_iterations", settings.largest_iterations, 1)?;
    let (low, high) = (model.range_volt.lowest_volt(), model.range_volt.highest_volt());
    let [low_deg, high_deg] = ends_deg(model, time_step_s)?;
    let gain = (high_deg - low_deg) / (high - low);
    check_positive("rise of the flap over the voltage range (deg)", gain)?;
    let (smallest, largest) = wanted_deg
        .iter()
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(a, b), w| (a.min(*w), b.max(*w)));
    let amplitude_deg = 0.5 * (largest - smallest);
    let within = |volt: f64| volt.clamp(low, high);
    let first: Vec<f64> = wanted_deg.iter().map(|w| within(low + (w - low_deg) / gain)).collect();
    let tried = |voltage_volt: Vec<f64>| -> Result<Tried, PreisachError> {
        let output_deg = model.simulate(&voltage_volt, time_step_s)?.output_deg;
        let error: Vec<f64> = wanted_deg.iter().zip(&output_deg).map(|(w, y)| w - y).collect();
        let rms_deg = rotor_base::mean_square(&error).sqrt();
        Ok(Tried { voltage_volt, output_deg, error, rms_deg })
    };
    let goal_deg = settings.tolerance * amplitude_deg;
    let mut best = tried(first)?;
    let mut iterations = 1;
    if best.rms_deg > goal_deg && settings.largest_iterations > 1 {
        let by_sample = tried(sample_by_sample(model, wanted_deg, time_step_s)?)?;
        iterations += 1;
        if by_sample.rms_deg < best.rms_deg {
            best = by_sample;
        }
    }
    let (mut step, mut idle, mut mark) = (1.0, 0, best.rms_deg);
    while best.rms_deg > goal_deg && iterations < settings.largest_iterations {
        let asked = ahead_of_stages(model, &best.error, time_step_s);
        let next = best.voltage_volt.iter().zip(&asked);
        let next = tried(next.map(|(u, e)| within(u + step * e / gain)).collect())?;
        iterations += 1;
        if next.rms_deg < best.rms_deg {
            best = next;
        } else {
            step *= 0.5;
        }
        idle += 1;
        if best.rms_deg < (1.0 - WORTH) * mark {
            (idle, mark) = (0, best.rms_deg);
        }
        if idle >= PATIENCE || step < SMALLEST {
            break;
        }
    }
    let Tried { voltage_volt, output_deg, error, rms_deg } = best;
    Ok(HistoryInverse {
        largest_error_deg: error.iter().fold(0.0, |most: f64, own| most.max(own.abs())),
        rms_error_deg: rms_deg,
        amplitude_deg,
        at_limit: voltage_volt.iter().filter(|u| **u <= low || **u >= high).count(),
        iterations,
        is_met: rms_deg <= goal_deg,
        voltage_volt,
        output_deg,
    })
}

/// The voltage at every sample that brings the flap to the wanted angle, or as near as the range allows.
fn sample_by_sample(
    model: &ActuatorModel,
    wanted_deg: &[f64],
    time_step_s: f64,
) -> Result<Vec<f64>, PreisachError> {
    let stepper = model.stepper(time_step_s)?;
    let range = [model.range_volt.lowest_volt(), model.range_volt.highest_volt()];
    let at_rest = |volt: f64| model.start(volt, StartState::Rest);
    // what cannot be simulated is no crossing
    let off = |volt: f64| at_rest(volt).map_or(f64::NAN, |m| m.output_deg() - wanted_deg[0]);
    let mut voltages = vec![crossing(range, off)];
    let mut memory = at_rest(voltages[0])?;
    for wanted in &wanted_deg[1..] {
        let volt = crossing(range, |volt| {
            stepper.step(&mut memory.clone(), volt, 0.0).map_or(f64::NAN, |y| y - wanted)
        });
        stepper.step(&mut memory, volt, 0.0)?;
        voltages.push(volt);
    }
    Ok(voltages)
}

/// What lags, delays and modes, of the stages and of an oscillator, would make a signal of, by central differences.
fn ahead_of_stages(model: &ActuatorModel, signal: &[f64], time_step_s: f64) -> Vec<f64> {
    let mut own = signal.to_vec();
    let around = match &model.law {
        ActuatorLaw::HystereticOscillator(law) => Some(mode_of(law)),
        _ => None,
    };
    let behind = model.linkage.iter().filter_map(|stage| match stage {
        LinkageStage::Resonance(mode) => Some(*mode),
        _ => None,
    });
    for mode in around.into_iter().chain(behind) {
        let omega = TAU * mode.frequency_hz;
        own = with_rates(&own, [mode.lead_s(), omega.powi(-2)], time_step_s);
    }
    for stage in &model.amplifier {
        match stage {
            AmplifierStage::Lag(lag) => own = with_rates(&own, [lag.tau_s, 0.0], time_step_s),
            AmplifierStage::Delay(delay) => own = earlier(&own, delay.delay_s / time_step_s),
            _ => {}
        }
    }
    own
}

/// Flap angles at the ends of the voltage range, after a slow way up.
fn ends_deg(model: &ActuatorModel, time_step_s: f64) -> Result<[f64; 2], PreisachError> {
    let (low, high) = (model.range_volt.lowest_volt(), model.range_volt.highest_volt());
    let up = (0..=WAY).map(|k| low + (high - low) * k as f64 / WAY as f64);
    let output = model.simulate(&up.collect::<Vec<f64>>(), time_step_s.max(SLOW_STEP_S))?;
    Ok([output.output_deg[0], output.output_deg[WAY]])
}

/// The linear mode that an oscillator is at small amplitude.
fn mode_of(law: &HystereticOscillator) -> Resonance {
    let p = law.parameters();
    Resonance { frequency_hz: p.frequency_hz, damping_ratio: p.damping_ratio }
}

/// Refuses a count that is too small to mean anything.
fn check_count(quantity: &'static str, count: usize, least: usize) -> Result<(), PreisachError> {
    let refused = || out_of_range(quantity, count as f64, format!("at least {least}"));
    if count >= least { Ok(()) } else { Err(refused()) }
}

/// Refuses what is not a positive finite number.
fn check_positive(quantity: &'static str, value: f64) -> Result<(), PreisachError> {
    let refused = || out_of_range(quantity, value, "a positive finite number".into());
    if value.is_finite() && value > 0.0 { Ok(()) } else { Err(refused()) }
}

fn out_of_range(quantity: &'static str, value: f64, expected: String) -> PreisachError {
    PreisachError::OutOfRange { quantity, value, expected: expected.into() }
}

/// Refuses numbers of which one is NaN or infinite, and names the first.
fn check_finite(quantity: &'static str, values: &[f64]) -> Result<(), PreisachError> {
    match values.iter().position(|value| !value.is_finite()) {
        Some(index) => Err(PreisachError::NotFinite { quantity, index, value: values[index] }),
        None => Ok(()),
    }
}

/// Samples of the way from one end of the range to the other, and their least distance, s.
const WAY: usize = 200;
const SLOW_STEP_S: f64 = 0.01;

/// A signal with parts of its first and second derivative, `x + a dx/dt + b d2x/dt2`; it is held at both ends.
fn with_rates(signal: &[f64], [a, b]: [f64; 2], time_step_s: f64) -> Vec<f64> {
    let last = signal.len() - 1;
    let of = |k: usize| {
        let (before, now, after) =
            (signal[k.saturating_sub(1)], signal[k], signal[(k + 1).min(last)]);
        let rate = (after - before) / (2.0 * time_step_s);
        now + a * rate + b * (after - 2.0 * now + before) / time_step_s.powi(2)
    };
    (0..=last).map(of).collect()
}

/// A signal earlier by a number of samples, straight between them; it is held at the end.
fn earlier(signal: &[f64], samples: f64) -> Vec<f64> {
    let last = signal.len() - 1;
    let whole = (1..=last).take_while(|k| *k as f64 <= samples).count();
    let part = samples.fract();
    let at = |k: usize| signal[k.min(last)];
    (0..=last).map(|k| at(k + whole) + part * (at(k + whole + 1) - at(k + whole))).collect()
}

/// Where a function that rises crosses zero, by false position, the weight of an end that stays halved (Illinois); the nearer end where it does
/// not.
fn crossing([mut low, mut high]: [f64; 2], function: impl Fn(f64) -> f64) -> f64 {
    let (mut at_low, mut at_high) = (function(low), function(high));
    if at_low >= 0.0 {
        return low;
    }
    if at_high <= 0.0 {
        return high;
    }
    let least = 1e-13 * (at_high - at_low);
    let mut was_low = None;
    for _ in 0..CROSSINGS {
        let middle = low + (high - low) * at_low / (at_low - at_high);
        let value = function(middle);
        if value.abs() <= least || !value.is_finite() {
            return middle;
        }
        let is_low = value < 0.0;
        if is_low {
            (low, at_low) = (middle, value);
            at_high *= if was_low == Some(true) { 0.5 } else { 1.0 };
        } else {
            (high, at_high) = (middle, value);
            at_low *= if was_low == Some(false) { 0.5 } else { 1.0 };
        }
        was_low = Some(is_low);
    }
    f64::midpoint(low, high)
}

/// Steps towards a crossing.
const CROSSINGS: usize = 60;

/// A voltage with what the flap does.
struct Tried {
    voltage_volt: Vec<f64>,
    output_deg: Vec<f64>,
    /// Wanted less simulated, deg.
    error: Vec<f64>,
    rms_deg: f64,
}

#[cfg(test)]
mod tests {
    use super::*;
    use preisach_dyn::{
        Calibration, Delay, DynamicParameters, DynamicPreisach, OscillatorParameters, PlayMap,
        PlayMemory, PreisachGrid, RateForm, StaticPreisach, TimeOrder, VoltageRange,
    };

    /// A density with structure.
    fn static_model(levels: usize) -> StaticPreisach {
        let grid = PreisachGrid::new(VoltageRange::amplified_stack(), levels).unwrap();
        let n = levels as f64;
        let rise = |j: usize, k: usize| {
            let (s, r) = ((2 * k + j) as f64 / n - 1.0, j as f64 / n);
            60.0 / (n * n) * (-3.0 * r).exp() * (1.0 + 0.5 * (2.0 * s).sin())
        };
        let rises: Vec<Vec<f64>> =
            (0..levels).map(|j| (0..levels - j).map(|k| rise(j, k)).collect()).collect();
        let map = PlayMap::from_rises(&grid, 0.0, &rises).unwrap();
        StaticPreisach::new(grid, map).unwrap()
    }

    fn actuator(law: ActuatorLaw) -> ActuatorModel {
        let calibration = Calibration { deg_per_um: 0.04, zero_um: 0.0 };
        ActuatorModel::new(law, VoltageRange::amplified_stack(), calibration)
    }

    fn dynamic() -> ActuatorModel {
        let statics = static_model(24);
        let grid = *statics.grid();
        let law = DynamicPreisach::new(DynamicParameters {
            grid,
            g0_deg: statics.map().clone(),
            g1_s: PlayMap::constant(&grid, -0.012),
            g2_s2_per_deg: PlayMap::constant(&grid, 2e-6),
            form: RateForm::WellPosed,
            unfolded_rate_deg_s: 600.0,
            time_order: TimeOrder::Second,
        });
        actuator(ActuatorLaw::DynamicPreisach(law.unwrap()))
    }

    /// Two tones that start at rest, with a hold: deg.
    fn wanted_history(size: f64, step_s: f64, samples: usize) -> Vec<f64> {
        let tone = |t: f64, hz: f64| (std::f64::consts::TAU * hz * t).sin();
        (0..samples)
            .map(|k| {
                let t = k as f64 * step_s;
                let fade = (t / 0.2).min(1.0) * if t > 0.7 { 0.5 } else { 1.0 };
                size * fade * (0.7 * tone(t, 10.0) + 0.3 * tone(t, 23.0))
            })
            .collect()
    }

    #[test]
    fn a_history_that_does_not_repeat_is_followed() {
        let step_s = 1e-3;
        let settings = HistoryInverseSettings::default();
        let models = [
            ("static", actuator(ActuatorLaw::StaticPreisach(static_model(24))), 5.0),
            ("dynamic", dynamic(), 2.5),
            ("linear", ActuatorModel::linear(VoltageRange::amplified_stack(), 4.0, 0.04), 3.0),
        ];
        for (name, model, size) in models {
            let wanted = wanted_history(size, step_s, 1000);
            let found = history_inverse(&model, &wanted, step_s, &settings).unwrap();
            // forward again, on its own
            let again = model.simulate(&found.voltage_volt, step_s).unwrap().output_deg;
            let worst = again.iter().zip(&wanted).fold(0.0_f64, |m, (y, w)| m.max((y - w).abs()));
            let percent = 100.0 * worst / found.amplitude_deg;
            println!("{name}: {percent:.4} % of amplitude after {} simulations", found.iterations);
            assert!(percent < 0.1 && found.at_limit == 0, "{name}: {percent}");
            assert!((worst - found.largest_error_deg).abs() < 1e-12, "{name}");
            // one simulation, the linear gain, would not do
            let once = HistoryInverseSettings { largest_iterations: 1, ..settings };
            let naive = history_inverse(&model, &wanted, step_s, &once).unwrap();
            assert!(name == "linear" || naive.largest_error_deg > 20.0 * worst, "{name}");
        }
    }

    /// Behind a mode or a delay no single sample can be put right: there it learns from run to run.
    #[test]
    fn a_history_behind_a_mode_or_a_delay_is_learnt() {
        let with = |stage: LinkageStage| {
            let mut model = actuator(ActuatorLaw::StaticPreisach(static_model(24)));
            model.linkage.push(stage);
            model
        };
        let mode = LinkageStage::Resonance(Resonance { frequency_hz: 150.0, damping_ratio: 0.05 });
        let mut late = actuator(ActuatorLaw::StaticPreisach(static_model(24)));
        late.amplifier.push(AmplifierStage::Delay(Delay { delay_s: 0.002 }));
        for (name, model, most_percent) in [("mode", with(mode), 0.2), ("delay", late, 0.2)] {
            let wanted = wanted_history(4.0, 5e-4, 2000);
            let settings = HistoryInverseSettings::default();
            let found = history_inverse(&model, &wanted, 5e-4, &settings).unwrap();
            let percent = 100.0 * found.rms_error_deg / found.amplitude_deg;
            println!("{name}: rms {percent:.4} %, {} simulations", found.iterations);
            assert!(percent < most_percent, "{name}: {percent}");
            let two = HistoryInverseSettings { largest_iterations: 2, ..settings };
            let start = history_inverse(&model, &wanted, 5e-4, &two).unwrap();
            assert!(start.rms_error_deg > 5.0 * found.rms_error_deg, "{name}");
        }
    }

    /// The exact inverse of a static model, sample by sample, is the same voltage.
    #[test]
    fn a_learnt_history_is_that_of_the_exact_inverse() {
        let law = static_model(12);
        let model = actuator(ActuatorLaw::StaticPreisach(law.clone()));
        let wanted = wanted_history(4.0, 1e-3, 600);
        let settings = HistoryInverseSettings { tolerance: 1e-9, largest_iterations: 2000 };
        let found = history_inverse(&model, &wanted, 1e-3, &settings).unwrap();
        let first = found.voltage_volt[0];
        let mut memory = PlayMemory::new(law.grid(), first, StartState::Rest);
        for (wanted, learnt) in wanted.iter().zip(&found.voltage_volt).skip(1) {
            let exact = law.inverse(&mut memory, *wanted).unwrap();
            assert!((exact - learnt).abs() < 1e-4, "{exact} V, learnt {learnt} V");
        }
    }

    #[test]
    fn what_is_out_of_reach_is_left_as_error() {
        let model = ActuatorModel::linear(VoltageRange::amplified_stack(), 4.0, 0.04);
        let wanted = [0.0, 3.0, 6.0, 3.0, 0.0];
        let found =
            history_inverse(&model, &wanted, 1e-3, &HistoryInverseSettings::default()).unwrap();
        assert!(
            !found.is_met && found.at_limit == 1 && (found.largest_error_deg - 2.0).abs() < 1e-9
        );
        let text = |wanted: &[f64]| {
            let settings = HistoryInverseSettings::default();
            history_inverse(&model, wanted, 1e-3, &settings).unwrap_err().to_string()
        };
        assert!(text(&[1.0]).contains("wanted samples"));
        assert!(text(&[1.0, f64::NAN]).contains("index 1"));
    }

    /// Around a mode it learns too, by the linear mode of small motion.
    #[test]
    fn a_history_of_an_oscillator_is_learnt() {
        let law = HystereticOscillator::new(OscillatorParameters {
            range_volt: VoltageRange::amplified_stack(),
            gain_deg_per_volt: 0.1,
            frequency_hz: 150.0,
            damping_ratio: 0.05,
            hysteretic_share: 0.3,
            loading_per_deg: 0.1,
            unloading_per_deg: 0.1,
            offset_deg: 0.0,
        });
        let model = actuator(ActuatorLaw::HystereticOscillator(law.unwrap()));
        let wanted = wanted_history(3.0, 5e-4, 2000);
        let found =
            history_inverse(&model, &wanted, 5e-4, &HistoryInverseSettings::default()).unwrap();
        let percent = 100.0 * found.rms_error_deg / found.amplitude_deg;
        println!("oscillator: rms {percent:.4} %, {} simulations", found.iterations);
        assert!(percent < 0.2, "{percent}");
    }
}
