//! The stop-type Prandtl-Ishlinskii model: an output that leads its input, as friction does.

use crate::check::check_not_negative;
use crate::laws::memory::approach;
use crate::{HysteresisLaw, PreisachError, StartState, VoltageRange};
use serde::{Deserialize, Serialize};

/// One weighted stop: a spring that slips at its threshold.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct WeightedStop {
    /// Input travel from rest to slip, `r_i`, V, `>= 0`.
    pub threshold_volt: f64,
    /// Stiffness `w_i` before it slips, deg/V, `>= 0`.
    pub stiffness_deg_per_volt: f64,
}

/// The numbers of a [`PrandtlStop`] model, as they are written to files.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StopParameters {
    /// Inputs it may see, V.
    pub range_volt: VoltageRange,
    /// Stiffness `k` of the elastic part, deg/V, `>= 0`.
    pub stiffness_deg_per_volt: f64,
    /// The stops.
    pub stops: Vec<WeightedStop>,
    /// Viscosity `c`, output per rate of the input, deg s/V, `>= 0`.
    #[serde(default)]
    pub viscosity_deg_s_per_volt: f64,
    /// Output at the middle of the range with every stop relaxed, deg.
    #[serde(default)]
    pub offset_deg: f64,
}

/// A Prandtl-Ishlinskii model of stops, for systems whose output leads the input: friction dampers,
/// elastic-plastic links, metals under imposed strain.
///
/// ```text
/// y = offset + k (u - u_mid) + sum_i w_i s_i + c du/dt
/// s_i = u - p_i,   p_i <- max(u - r_i, min(u + r_i, p_i))
/// ```
/// `p_i` is the play of half-width `r_i`, `s_i` its stop: `|s_i| <= r_i`, and the two add up to the
/// input. Stiff after every turning point, softer the further the input goes. All numbers `>= 0`, so
/// every closed path of the input takes energy, `integral y du >= 0`. Input and output stand here in
/// the units of an actuator; of other data they are in the units of their channels.
///
/// The voltage is taken as straight between two samples, so its rate is constant there.
///
/// Not modelled: backlash, stick-slip, a yield force that differs with the direction.
/// Source: M. Brokate, J. Sprekels, *Hysteresis and Phase Transitions* (1996), chapter 2; the sum of
/// springs that slip: W. D. Iwan, *On a class of models for the yielding behavior of continuous and
/// composite systems*, Journal of Applied Mechanics 34 (1967).
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "StopParameters", into = "StopParameters")]
pub struct PrandtlStop {
    parameters: StopParameters,
}

impl TryFrom<StopParameters> for PrandtlStop {
    type Error = PreisachError;

    fn try_from(parameters: StopParameters) -> Result<Self, PreisachError> {
        Self::new(parameters)
    }
}

impl From<PrandtlStop> for StopParameters {
    fn from(model: PrandtlStop) -> Self {
        model.parameters
    }
}

/// Outputs of the plays and the voltage they belong to, V.
#[derive(Debug, Clone, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct StopMemory {
    plays_volt: Vec<f64>,
    voltage_volt: f64,
}

impl StopMemory {
    /// Outputs of the stops, V: what the input leaves of the plays.
    pub fn stops_volt(&self) -> impl Iterator<Item = f64> {
        self.plays_volt.iter().map(|play| self.voltage_volt - play)
    }
}

impl PrandtlStop {
    /// The model of the given numbers.
    ///
    /// # Errors
    /// [`PreisachError::Negative`], or [`PreisachError::NotPositive`] for an offset that is no
    /// number.
    pub fn new(parameters: StopParameters) -> Result<Self, PreisachError> {
        let p = &parameters;
        check_not_negative("stiffness_deg_per_volt", p.stiffness_deg_per_volt)?;
        check_not_negative("viscosity_deg_s_per_volt", p.viscosity_deg_s_per_volt)?;
        for stop in &p.stops {
            check_not_negative("threshold_volt", stop.threshold_volt)?;
            check_not_negative("stiffness_deg_per_volt", stop.stiffness_deg_per_volt)?;
        }
        check_not_negative("size of offset_deg", p.offset_deg.abs())?;
        Ok(Self { parameters })
    }

    /// Its numbers.
    pub fn parameters(&self) -> &StopParameters {
        &self.parameters
    }

    /// Area of the steady loop between `-A` and `A` about any middle, deg V, run slowly: the energy
    /// one cycle takes.
    ///
    /// ```text
    /// area = sum_i 4 w_i r_i max(0, A - r_i)
    /// ```
    /// Each stop runs round a parallelogram. Source: G. Masing's rule for springs that slip.
    pub fn loop_area_deg_volt(&self, amplitude_volt: f64) -> f64 {
        let area = |stop: &WeightedStop| {
            let r = stop.threshold_volt;
            4.0 * stop.stiffness_deg_per_volt * r * (amplitude_volt - r).max(0.0)
        };
        self.parameters.stops.iter().map(area).sum()
    }

    fn moved(&self, memory: &mut StopMemory, voltage_volt: f64, rate_volt_per_s: f64) -> f64 {
        let p = &self.parameters;
        let elastic = p.stiffness_deg_per_volt * (voltage_volt - p.range_volt.middle_volt());
        let mut output = p.offset_deg + elastic + p.viscosity_deg_s_per_volt * rate_volt_per_s;
        for (w, stop) in memory.plays_volt.iter_mut().zip(&p.stops) {
            *w = w.min(voltage_volt + stop.threshold_volt).max(voltage_volt - stop.threshold_volt);
            output += stop.stiffness_deg_per_volt * (voltage_volt - *w);
        }
        memory.voltage_volt = voltage_volt;
        output
    }
}

impl HysteresisLaw for PrandtlStop {
    type Memory = StopMemory;

    fn start(&self, voltage_volt: f64, state: StartState) -> (StopMemory, f64) {
        let range = self.parameters.range_volt;
        let plays_volt = vec![voltage_volt; self.parameters.stops.len()];
        let mut memory = StopMemory { plays_volt, voltage_volt };
        for fraction in approach(state) {
            self.moved(&mut memory, range.lowest_volt() + fraction * range.span_volt(), 0.0);
        }
        let output_deg = self.moved(&mut memory, voltage_volt, 0.0);
        (memory, output_deg)
    }

    fn step(&self, memory: &mut StopMemory, voltage_volt: f64, time_step_s: f64) -> f64 {
        let rate = (voltage_volt - memory.voltage_volt) / time_step_s;
        self.moved(memory, voltage_volt, rate)
    }

    fn check_memory(&self, memory: &StopMemory) -> Result<(), PreisachError> {
        let (found, expected) = (memory.plays_volt.len(), self.parameters.stops.len());
        if found == expected {
            Ok(())
        } else {
            Err(PreisachError::MemoryMismatch { found, expected })
        }
    }

    fn shifted(mut self, shift_deg: f64) -> Self {
        self.parameters.offset_deg += shift_deg;
        self
    }
}
