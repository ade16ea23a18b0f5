//! What the amplifier and the ceramic do to the voltage: slew, limits, heat, depolarisation.

use crate::StageError;
use crate::check::{check_finite, check_not_negative, check_positive, check_that, check_within};
use crate::lag_step::LagStep;
use crate::{Curve, Step};
use serde::{Deserialize, Serialize};

/// An amplifier whose current is limited, into a capacitance: a slew limit.
///
/// ```text
/// |dV/dt| <= slew_rate = I_max / C;   V follows u as fast as it may and then stays with it
/// ```
/// Exact for an input straight between samples. A slew rate above that of the input is the identity.
/// Source: elementary; 0.5 to 500 V/ms for piezo stacks (80 mA into 40 uF: 2 V/ms).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct CurrentLimit {
    /// Largest rate of the voltage, V/s, `> 0`.
    pub slew_rate_volt_per_s: f64,
}

/// A [`CurrentLimit`] made ready for one time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CurrentStep {
    /// Largest change over a step, V.
    pub(crate) most_volt: f64,
}

/// Input and output of a [`CurrentLimit`] at the last sample.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LimitMemory {
    input: f64,
    output: f64,
}

impl Step for CurrentStep {
    type Memory = LimitMemory;

    fn start(&self, input: f64) -> (LimitMemory, f64) {
        (LimitMemory { input, output: input }, input)
    }

    #[inline]
    fn advance(&self, memory: &mut LimitMemory, input: f64) -> f64 {
        let most = self.most_volt;
        let (gap, change) = (memory.input - memory.output, input - memory.input);
        // the input may run through the output within the step, faster than the output can turn
        let toward = most.copysign(gap);
        let met = gap / (toward - change);
        let crosses = gap * change < 0.0 && change.abs() > most && met < 1.0;
        memory.output = if crosses {
            memory.output + toward * (2.0 * met - 1.0)
        } else if (input - memory.output).abs() <= most {
            input
        } else {
            memory.output + most.copysign(input - memory.output)
        };
        memory.input = input;
        memory.output
    }
}

/// Voltage limits of the amplifier.
///
/// ```text
/// V = max(v_min, min(v_max, u)),   within a knee w of a limit
/// V = u - (u - (v_max - w))^2 / 4w  at the upper one, likewise at the lower one
/// ```
/// An output stage runs out of gain before it runs out of supply: over the knee the slope `dV/du` falls
/// from 1 to 0 on a straight line, and the limit is reached at `u = v_max + w`. With `w = 0` it is a
/// sharp corner. Limits beyond the command's by the knee are the identity. Source: elementary.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Saturation {
    /// Lowest voltage, V.
    pub v_min_volt: f64,
    /// Highest voltage, V, above the lowest.
    pub v_max_volt: f64,
    /// Half-width of the knee at both limits in the command, V: `>= 0`, at most half the distance
    /// between the limits; 0 if left out.
    #[serde(default)]
    pub knee_volt: f64,
}

impl Saturation {
    /// Limits with sharp corners, V.
    pub fn sharp(v_min_volt: f64, v_max_volt: f64) -> Self {
        Self { v_min_volt, v_max_volt, knee_volt: 0.0 }
    }

    pub(crate) fn check(&self) -> Result<(), StageError> {
        let span = self.v_max_volt - self.v_min_volt;
        let expected =
            format!("above its lower end {}: the range is empty or not finite", self.v_min_volt);
        check_that(span.is_finite() && span > 0.0, "end of a range", self.v_max_volt, expected)?;
        let most = 0.5 * span;
        check_within("knee_volt", self.knee_volt, 0.0..=most)
    }

    /// The commands beyond which nothing changes any more, V.
    pub fn reached_volt(&self) -> (f64, f64) {
        (self.v_min_volt - self.knee_volt, self.v_max_volt + self.knee_volt)
    }

    /// What is lost of a command that goes beyond the start of a knee.
    #[inline]
    fn lost(&self, beyond: f64) -> f64 {
        if beyond > 0.0 { beyond * beyond / (4.0 * self.knee_volt) } else { 0.0 }
    }
}

impl Curve for Saturation {
    #[inline]
    fn value(&self, input: f64) -> f64 {
        let Self { v_min_volt: low, v_max_volt: high, knee_volt: knee } = *self;
        let (above, below) = (input - (high - knee), (low + knee) - input);
        if above >= 2.0 * knee {
            high
        } else if below >= 2.0 * knee {
            low
        } else {
            input - self.lost(above) + self.lost(below)
        }
    }
}

/// Warming of the ceramic by dielectric loss, and the gain it adds.
///
/// ```text
/// T_c dT/dt + T = (rise / 4) |dV/dt| |V - V_turn|        gain = 1 + coefficient T
/// ```
/// `T` is the temperature above the start, `V_turn` the voltage of the last reversal. Over one cycle
/// of a sine of amplitude `A` about any bias the right side has the mean `rise f A^2`, the law of
/// the loss tangent, `P = pi f C tan(d) A^2` times a thermal resistance; every smaller swing adds
/// its own part. The voltage passes unchanged; the gain acts on the law's output, about that at
/// 0 V. `coefficient_per_k = 0` is the identity.
///
/// Assumes: one lumped temperature, constant loss tangent. Not modelled: thermal expansion.
/// Source: J. Zheng, S. Takahashi, S. Yoshikawa, K. Uchino, *Heat generation in multilayer
/// piezoelectric actuators*, Journal of the American Ceramic Society 79 (1996); the form in time is
/// this project's.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct DielectricHeating {
    /// Thermal time constant `T_c`, s, `> 0`; 30 to 600 s is usual.
    pub time_constant_s: f64,
    /// Relative gain per temperature, 1/K; 0.0005 to 0.003 is usual.
    pub coefficient_per_k: f64,
    /// Steady temperature rise per squared amplitude and frequency, K/(V^2 Hz), `>= 0`. The default
    /// 6e-5 is 40 uF, a loss tangent of 0.05 and 10 K/W.
    #[serde(default = "usual_rise")]
    pub rise_k_per_volt2_hz: f64,
}

fn usual_rise() -> f64 {
    6e-5
}

impl DielectricHeating {
    /// Heating with the usual temperature rise.
    pub fn new(time_constant_s: f64, coefficient_per_k: f64) -> Self {
        Self { time_constant_s, coefficient_per_k, rise_k_per_volt2_hz: usual_rise() }
    }

    pub(crate) fn check(&self) -> Result<(), StageError> {
        check_positive("time_constant_s", self.time_constant_s)?;
        check_not_negative("rise_k_per_volt2_hz", self.rise_k_per_volt2_hz)?;
        check_within("coefficient_per_k", self.coefficient_per_k, -1.0..=1.0)
    }

    pub(crate) fn prepared(&self, step_s: f64) -> HeatStep {
        HeatStep {
            lag: LagStep::new(self.time_constant_s, step_s),
            coefficient_per_k: self.coefficient_per_k,
            rate_k: 0.25 * self.rise_k_per_volt2_hz / step_s,
        }
    }
}

/// A [`DielectricHeating`] made ready for one time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct HeatStep {
    lag: LagStep,
    coefficient_per_k: f64,
    /// Forcing per change over the step and distance from the turn, K/V^2.
    rate_k: f64,
}

/// Temperature of a [`DielectricHeating`], and the motion of the voltage that heats it.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct HeatMemory {
    temperature_k: f64,
    voltage: f64,
    turn: f64,
    /// Sign of the last change, 0 before the first.
    direction: f64,
}

impl HeatMemory {
    /// Temperature above the start, K.
    pub fn temperature_k(&self) -> f64 {
        self.temperature_k
    }
}

impl Step for HeatStep {
    type Memory = HeatMemory;

    fn start(&self, input: f64) -> (HeatMemory, f64) {
        (HeatMemory { temperature_k: 0.0, voltage: input, turn: input, direction: 0.0 }, input)
    }

    fn advance(&self, memory: &mut HeatMemory, input: f64) -> f64 {
        let change = input - memory.voltage;
        if change * memory.direction < 0.0 {
            memory.turn = memory.voltage;
        }
        if change != 0.0 {
            memory.direction = change.signum();
        }
        // the forcing is straight over the step, from the old voltage's value to the new one's
        let forcing = self.rate_k * change.abs();
        let first = forcing * (memory.voltage - memory.turn).abs();
        let last = forcing * (input - memory.turn).abs();
        memory.temperature_k =
            last + self.lag.deviation(memory.temperature_k - first, last - first);
        memory.voltage = input;
        input
    }

    #[inline]
    fn gain(&self, memory: &HeatMemory) -> f64 {
        1.0 + self.coefficient_per_k * memory.temperature_k
    }

    fn settle(&self, before: &HeatMemory, now: &mut HeatMemory, period_s: f64) {
        now.temperature_k = self.lag.settled(before.temperature_k, now.temperature_k, period_s);
    }
}

/// Polarisation lost under reverse voltage, and the gain lost with it.
///
/// ```text
/// q <- max( loss (threshold - V), min( loss (repoling - V), q ) ),   each term held inside 0 .. 1
/// p' = rate (threshold - V) below the threshold,   p <= (repoling - V) / (repoling - threshold)
/// gain = 1 - min(1, q + p)
/// ```
/// Below the threshold domains turn against the poling direction, more of them the deeper the
/// voltage goes (`q`, at once) and the longer it stays there (`p`, nothing at the start); they stay
/// turned until a voltage above the threshold turns them back, those that turned last coming back
/// first, all of them by `repoling_volt`. The small-signal coefficient is proportional to the
/// polarisation left (`d33 = 2 Q33 eps33 P3`), so the law's output shrinks by the share lost, about
/// that at 0 V. The voltage passes unchanged; `p` is exact for a voltage straight between samples.
///
/// `loss_per_volt = loss_per_volt_second = 0`, or a threshold never reached, is the identity.
/// A periodic orbit is that of the loss `p` it began with: ageing is slow against a period.
/// Assumes: a uniform strip of switching voltages, a rate of switching proportional to the overdrive.
/// Not modelled: the butterfly loop beyond the coercive field, the strain of the turning domains
/// themselves, ageing without voltage.
/// Source: D. Damjanovic, *Ferroelectric, dielectric and piezoelectric properties of ferroelectric
/// thin films and ceramics*, Reports on Progress in Physics 61 (1998), sections 2 and 6: `d33`
/// from the polarisation, domain switching under reverse field. The play form is this project's, and
/// the rate its first term in the overdrive.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Depolarisation {
    /// Voltage below which polarisation is lost, V; some -0.2 to -0.3 of the highest voltage.
    pub threshold_volt: f64,
    /// Share of the polarisation lost at once per volt below the threshold, 1/V, 0 to 1.
    #[serde(default = "usual_loss")]
    pub loss_per_volt: f64,
    /// Share lost per volt below the threshold and second spent there, 1/(V s), `>= 0`.
    #[serde(default)]
    pub loss_per_volt_second: f64,
    /// Voltage at which all of it has come back, V, above the threshold; none: it never does.
    #[serde(default)]
    pub repoling_volt: Option<f64>,
}

fn usual_loss() -> f64 {
    0.005
}

impl Depolarisation {
    /// Depolarisation below a threshold with the usual loss at once, none with time, no repoling.
    pub fn new(threshold_volt: f64) -> Self {
        let loss_per_volt = usual_loss();
        Self { threshold_volt, loss_per_volt, loss_per_volt_second: 0.0, repoling_volt: None }
    }

    pub(crate) fn check(&self) -> Result<(), StageError> {
        let threshold = self.threshold_volt;
        check_finite("threshold_volt", threshold)?;
        check_within("loss_per_volt", self.loss_per_volt, 0.0..=1.0)?;
        check_not_negative("loss_per_volt_second", self.loss_per_volt_second)?;
        self.repoling_volt.map_or(Ok(()), |above| {
            let expected = format!("a finite number above threshold_volt ({threshold})");
            check_that(above.is_finite() && above > threshold, "repoling_volt", above, expected)
        })
    }

    /// Gain of the law's output at every sample of a terminal voltage, settled at the first.
    pub fn gains(&self, terminal_volt: &[f64], step_s: f64) -> Vec<f64> {
        let step = self.prepared(step_s);
        let Some((&first, rest)) = terminal_volt.split_first() else { return Vec::new() };
        let (mut memory, _) = step.start(first);
        let at_start = step.gain(&memory);
        let later = rest.iter().map(|&volt| {
            step.advance(&mut memory, volt);
            step.gain(&memory)
        });
        std::iter::once(at_start).chain(later).collect()
    }

    pub(crate) fn prepared(&self, step_s: f64) -> DepolarisationStep {
        DepolarisationStep { stage: *self, step_s }
    }
}

/// A [`Depolarisation`] made ready for one time step.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct DepolarisationStep {
    stage: Depolarisation,
    step_s: f64,
}

/// Shares of the polarisation lost, and the last voltage.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
pub struct LossMemory {
    at_once: f64,
    with_time: f64,
    voltage: f64,
}

impl DepolarisationStep {
    /// Volt below the threshold times seconds spent there, over a step straight in the voltage.
    fn overdrive_volt_s(&self, from_volt: f64, to_volt: f64) -> f64 {
        let threshold = self.stage.threshold_volt;
        let (a, b) = (threshold - from_volt, threshold - to_volt);
        let mean = match (a > 0.0, b > 0.0) {
            (true, true) => 0.5 * (a + b),
            (false, false) => 0.0,
            // a triangle over the part of the step spent below
            _ => 0.5 * a.max(b).powi(2) / (a - b).abs(),
        };
        mean * self.step_s
    }

    #[inline]
    fn at_once(&self, lost: f64, input: f64) -> f64 {
        let Depolarisation { threshold_volt, loss_per_volt, repoling_volt, .. } = self.stage;
        let share = |depth_volt: f64| (loss_per_volt * depth_volt).clamp(0.0, 1.0);
        let most = repoling_volt.map_or(1.0, |volt| share(volt - input));
        lost.min(most).max(share(threshold_volt - input))
    }
}

impl Step for DepolarisationStep {
    type Memory = LossMemory;

    fn start(&self, input: f64) -> (LossMemory, f64) {
        let mut memory = LossMemory { at_once: 0.0, with_time: 0.0, voltage: input };
        memory.at_once = self.at_once(0.0, input);
        (memory, input)
    }

    #[inline]
    fn advance(&self, memory: &mut LossMemory, input: f64) -> f64 {
        let Depolarisation { threshold_volt, loss_per_volt_second, repoling_volt, .. } = self.stage;
        memory.at_once = self.at_once(memory.at_once, input);
        if loss_per_volt_second > 0.0 {
            let added = loss_per_volt_second * self.overdrive_volt_s(memory.voltage, input);
            let most = repoling_volt
                .map_or(1.0, |volt| ((volt - input) / (volt - threshold_volt)).clamp(0.0, 1.0));
            memory.with_time = (memory.with_time + added).min(most);
        }
        memory.voltage = input;
        input
    }

    #[inline]
    fn gain(&self, memory: &LossMemory) -> f64 {
        1.0 - (memory.at_once + memory.with_time).min(1.0)
    }

    /// A closed orbit is that of the loss it began with.
    fn settle(&self, before: &LossMemory, now: &mut LossMemory, _: f64) {
        now.with_time = before.with_time;
    }
}
