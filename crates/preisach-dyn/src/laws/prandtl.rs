//! The rate-dependent Prandtl-Ishlinskii model.

use crate::check::check_not_negative;
use crate::{Envelope, HysteresisLaw, PreisachError, StartState, VoltageRange, WidthsMemory};
use serde::{Deserialize, Serialize};

/// One weighted play.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WeightedPlay {
    /// Half-width `r_i` at vanishing rate, V, `>= 0`.
    pub threshold_volt: f64,
    /// Weight `p_i`, deg/V, `>= 0`.
    pub weight_deg_per_volt: f64,
}

/// The numbers of a [`PrandtlIshlinskii`] model, as they are written to files.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct PrandtlParameters {
    /// Voltages it may see, V.
    pub range_volt: VoltageRange,
    /// Slope `q` of the reversible part, deg/V, `>= 0`.
    pub gain_deg_per_volt: f64,
    /// The plays.
    pub plays: Vec<WeightedPlay>,
    /// Growth `b` of every half-width with the rate of the voltage, s, `>= 0`; 0: no rate
    /// dependence.
    #[serde(default)]
    pub threshold_growth_s: f64,
    /// The output curve.
    #[serde(default)]
    pub envelope: Envelope,
}

/// A rate-dependent Prandtl-Ishlinskii model: plays whose half-widths grow with the voltage rate.
///
/// ```text
/// z = q (u - u_mid) + sum_i p_i (w_i - u_mid),   w_i <- max(u - R_i, min(u + R_i, w_i))
/// R_i = r_i + b |du/dt|,   delta = envelope(z)
/// ```
/// The voltage is taken as straight between two samples, so its rate is constant there. All
/// numbers `>= 0`, so the output never falls with the voltage at constant rate.
///
/// Not modelled: relaxation. With the voltage held, the half-widths return to `r_i` at once, and the
/// output jumps. Bounded, rate-dependent loops only.
/// Source: M. Al Janaideh, S. Rakheja, C.-Y. Su, *An analytical generalized Prandtl-Ishlinskii
/// model inversion for hysteresis compensation in micropositioning control*, IEEE/ASME
/// Transactions on Mechatronics 16 (2011), and M. Al Janaideh, P. Krejci, *Inverse rate-dependent
/// Prandtl-Ishlinskii model*, same journal 18 (2013), with the threshold `alpha i + beta |du/dt|`.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "PrandtlParameters", into = "PrandtlParameters")]
pub struct PrandtlIshlinskii {
    parameters: PrandtlParameters,
    /// Largest value of `z`, deg.
    reference_deg: f64,
}

stored_as_parameters!(PrandtlIshlinskii, PrandtlParameters);

impl PrandtlIshlinskii {
    /// The model of the given numbers.
    ///
    /// # Errors
    /// [`PreisachError::OutOfRange`] or [`PreisachError::NotFinite`].
    pub fn new(parameters: PrandtlParameters) -> Result<Self, PreisachError> {
        let p = &parameters;
        check_not_negative("gain_deg_per_volt", p.gain_deg_per_volt)?;
        check_not_negative("threshold_growth_s", p.threshold_growth_s)?;
        for play in &p.plays {
            check_not_negative("threshold_volt", play.threshold_volt)?;
            check_not_negative("weight_deg_per_volt", play.weight_deg_per_volt)?;
        }
        p.envelope.check()?;
        let slope =
            p.plays.iter().fold(p.gain_deg_per_volt, |sum, play| sum + play.weight_deg_per_volt);
        let reference_deg = 0.5 * slope * p.range_volt.span_volt();
        Ok(Self { parameters, reference_deg })
    }

    /// Its numbers.
    pub fn parameters(&self) -> &PrandtlParameters {
        &self.parameters
    }

    fn moved(&self, memory: &mut WidthsMemory, voltage_volt: f64, growth_volt: f64) -> f64 {
        let p = &self.parameters;
        let middle = p.range_volt.middle_volt();
        let mut z = p.gain_deg_per_volt * (voltage_volt - middle);
        for (w, play) in memory.plays_volt.iter_mut().zip(&p.plays) {
            let half_width = play.threshold_volt + growth_volt;
            *w = w.min(voltage_volt + half_width).max(voltage_volt - half_width);
            z += play.weight_deg_per_volt * (*w - middle);
        }
        memory.voltage_volt = voltage_volt;
        p.envelope.output_deg(z, self.reference_deg)
    }
}

impl HysteresisLaw for PrandtlIshlinskii {
    type Memory = WidthsMemory;

    fn start(&self, voltage_volt: f64, state: StartState) -> (WidthsMemory, f64) {
        let p = &self.parameters;
        let memory = WidthsMemory::at(p.plays.len(), voltage_volt);
        state.led(memory, p.range_volt, voltage_volt, |m, volt| self.moved(m, volt, 0.0))
    }

    fn step(&self, memory: &mut WidthsMemory, voltage_volt: f64, time_step_s: f64) -> f64 {
        let rate = (voltage_volt - memory.voltage_volt).abs() / time_step_s;
        self.moved(memory, voltage_volt, self.parameters.threshold_growth_s * rate)
    }

    fn check_memory(&self, memory: &WidthsMemory) -> Result<(), PreisachError> {
        memory.check(self.parameters.plays.len())
    }

    fn shifted(mut self, shift_deg: f64) -> Self {
        self.parameters.envelope.offset_deg += shift_deg;
        self
    }
}
