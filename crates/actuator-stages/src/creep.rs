//! Creep: the slow part of the response to a step.

use crate::StageError;
use crate::Step;
use crate::check::{check_not_negative, check_positive, check_that, check_within};
use crate::lag_step::LagStep;
use serde::{Deserialize, Serialize};

/// Creep that grows with the logarithm of time.
///
/// ```text
/// after a step of the input by U:   y = U [ 1 + rate log10(t / from) ],   from << t << to
/// realised as                       y = u + sum_i (rate / n) (lag_i[u] - u_start)
/// ```
/// with `n = 2` lags per decade. Their time constants are spaced evenly in `log t`; the shortest are
/// placed such that the mean line passes through `U` at `t = from`. The whole creep to be had is
/// `rate log10(to / from)` of a step; a record begins with none.
///
/// `rate_per_decade = 0` is the identity. Exact for an input straight between samples.
/// Not modelled: dependence of the rate on the level, and creep that a move before the record left.
/// Source: H. Jung, D.-G. Gweon, *Creep characteristics of piezoelectric actuators*, Review of
/// Scientific Instruments 71 (2000): `L = L0 [1 + gamma log10(t / 0.1 s)]`, gamma 0.01 to 0.02;
/// lags in place of the logarithm: K. Kuhnen, H. Janocha, *Inverse feedforward controller for
/// complex hysteretic nonlinearities in smart-material systems*, Control and Intelligent Systems 29
/// (2001).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct LogCreep {
    /// Creep per decade of time, as a fraction of the step, 0 to 1; 0.01 to 0.02 is usual.
    pub rate_per_decade: f64,
    /// Time after a step at which creep is counted zero, s.
    #[serde(default = "usual_start_s")]
    pub from_s: f64,
    /// Time after a step at which creep ends, s, at least ten times the first.
    #[serde(default = "usual_end_s")]
    pub to_s: f64,
}

fn usual_start_s() -> f64 {
    0.1
}

fn usual_end_s() -> f64 {
    1000.0
}

impl LogCreep {
    /// Creep of a given rate from 0.1 s to 1000 s.
    pub fn new(rate_per_decade: f64) -> Self {
        Self { rate_per_decade, from_s: usual_start_s(), to_s: usual_end_s() }
    }

    pub(crate) fn check(&self) -> Result<(), StageError> {
        check_positive("from_s", self.from_s)?;
        check_positive("to_s", self.to_s)?;
        check_within("rate_per_decade", self.rate_per_decade, 0.0..=1.0)?;
        let least = self.from_s * 10.0;
        let expected = format!("a finite number at least ten times from_s ({least})");
        check_that(self.to_s >= least, "to_s", self.to_s, expected)
    }

    /// The lags that stand for the logarithm: weight, as a fraction of the input, and time constant (s) of each.
    pub fn lags(&self) -> Vec<(f64, f64)> {
        let decades = (self.to_s / self.from_s).log10();
        let count = (LAGS_PER_DECADE * decades).ceil();
        let spacing = decades / count;
        let weight = self.rate_per_decade * spacing;
        // 1 - exp(-t/tau) over an even spread of log tau from tau_0 up is log10(t/tau_0) plus
        // gamma / ln 10, gamma being Euler's constant
        let first_s = self.from_s * EULER_GAMMA.exp();
        let places = (0..).map(|i| f64::from(i) + 0.5).take_while(|place| *place < count);
        places.map(|place| (weight, first_s * 10.0_f64.powf(place * spacing))).collect()
    }

    pub(crate) fn prepared(&self, step_s: f64) -> CreepStep {
        CreepStep::creeping(self.lags(), step_s)
    }
}

const LAGS_PER_DECADE: f64 = 2.0;
const EULER_GAMMA: f64 = 0.577_215_664_901_532_9;

/// One element of a Kelvin-Voigt chain.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KelvinVoigtElement {
    /// Final creep of the element as a fraction of the step, `>= 0`.
    pub compliance_ratio: f64,
    /// Time constant, damping over stiffness, s, `> 0`.
    pub time_constant_s: f64,
}

/// Creep as springs and dampers in parallel, strung in series behind the stiff part.
///
/// ```text
/// y = u + sum_i c_i (x_i - u_start),   T_i dx_i/dt + x_i = u
/// ```
/// All `c_i = 0`, or no element, is the identity. Exact for an input straight between samples.
/// Source: D. Croft, G. Shed, S. Devasia, *Creep, hysteresis, and vibration compensation for
/// piezoactuators*, Journal of Dynamic Systems, Measurement, and Control 123 (2001), equation (2).
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct KelvinVoigt {
    /// The elements.
    pub elements: Vec<KelvinVoigtElement>,
}

impl KelvinVoigt {
    pub(crate) fn check(&self) -> Result<(), StageError> {
        self.elements.iter().try_for_each(|element| {
            check_not_negative("compliance_ratio", element.compliance_ratio)?;
            check_positive("time_constant_s", element.time_constant_s)
        })
    }

    pub(crate) fn prepared(&self, step_s: f64) -> CreepStep {
        let lag = |e: &KelvinVoigtElement| (e.compliance_ratio, e.time_constant_s);
        CreepStep::creeping(self.elements.iter().map(lag), step_s)
    }
}

/// Lags in parallel made ready for one time step: creep, relaxation, a lag alone.
///
/// `y = u + sum_i w_i (u + d_i - u_start)`, `d_i` the deviation of lag `i` from its input.
#[derive(Debug, Clone, PartialEq)]
pub struct CreepStep {
    terms: Vec<(f64, LagStep)>,
    total: f64,
}

/// First and last input of lags in parallel, and how far each lag is from its input.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
pub struct CreepMemory {
    start: f64,
    input: f64,
    deviations: Vec<f64>,
}

impl CreepStep {
    /// From weight and time constant (s) of each lag.
    fn creeping(lags: impl IntoIterator<Item = (f64, f64)>, step_s: f64) -> Self {
        let relaxing = Self::relaxing(lags, step_s);
        Self { total: relaxing.terms.iter().map(|(weight, _)| weight).sum(), ..relaxing }
    }

    /// `y = u + sum_i w_i d_i`: lags whose gain at rest is 1.
    pub(crate) fn relaxing(lags: impl IntoIterator<Item = (f64, f64)>, step_s: f64) -> Self {
        let term = |(weight, tau_s)| (weight, LagStep::new(tau_s, step_s));
        Self { terms: lags.into_iter().map(term).collect(), total: 0.0 }
    }
}

impl Step for CreepStep {
    type Memory = CreepMemory;

    fn start(&self, input: f64) -> (CreepMemory, f64) {
        (CreepMemory { start: input, input, deviations: vec![0.0; self.terms.len()] }, input)
    }

    fn advance(&self, memory: &mut CreepMemory, input: f64) -> f64 {
        let change = input - memory.input;
        memory.input = input;
        let mut creep = self.total * (input - memory.start);
        for (deviation, (weight, lag)) in memory.deviations.iter_mut().zip(&self.terms) {
            *deviation = lag.deviation(*deviation, change);
            creep += weight * *deviation;
        }
        input + creep
    }

    fn pass(&self, signal: &mut [f64]) {
        let Some(&start) = signal.first() else {
            return;
        };
        let mut creep: Vec<f64> = signal.iter().map(|input| self.total * (input - start)).collect();
        let (fours, rest) = self.terms.as_chunks::<4>();
        for terms in fours {
            add_lags(terms, signal, &mut creep);
        }
        for &term in rest {
            add_lags(&[term], signal, &mut creep);
        }
        for (value, creep) in signal.iter_mut().zip(creep) {
            *value += creep;
        }
    }

    fn owns(&self, memory: &CreepMemory) -> bool {
        memory.deviations.len() == self.terms.len()
    }

    fn settle(&self, before: &CreepMemory, now: &mut CreepMemory, period_s: f64) {
        let deviations = before.deviations.iter().zip(&mut now.deviations);
        for ((_, lag), (before, now)) in self.terms.iter().zip(deviations) {
            *now = lag.settled(*before, *now, period_s);
        }
    }
}

/// Adds the weighted deviations of lags, side by side, from a signal they are settled at the first
/// sample of.
fn add_lags<const N: usize>(terms: &[(f64, LagStep); N], signal: &[f64], sums: &mut [f64]) {
    let terms = *terms;
    let mut deviations = [0.0; N];
    let mut last = signal[0];
    for (sum, &input) in sums.iter_mut().zip(signal) {
        let change = input - last;
        last = input;
        for (deviation, (_, lag)) in deviations.iter_mut().zip(&terms) {
            *deviation = lag.deviation(*deviation, change);
        }
        for (deviation, (weight, _)) in deviations.iter().zip(&terms) {
            *sum += weight * deviation;
        }
    }
}
