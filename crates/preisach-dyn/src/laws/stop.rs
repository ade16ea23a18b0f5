//! The stop-type Prandtl-Ishlinskii model: an output that leads its input, as friction does.

use crate::check::check_not_negative;
use crate::{HysteresisLaw, PreisachError, StartState, VoltageRange, WidthsMemory};
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

stored_as_parameters!(PrandtlStop, StopParameters);

impl PrandtlStop {
    /// The model of the given numbers.
    ///
    /// # Errors
    /// [`PreisachError::OutOfRange`].
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

    fn moved(&self, memory: &mut WidthsMemory, voltage_volt: f64, rate_volt_per_s: f64) -> f64 {
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
    type Memory = WidthsMemory;

    fn start(&self, voltage_volt: f64, state: StartState) -> (WidthsMemory, f64) {
        let p = &self.parameters;
        let memory = WidthsMemory::at(p.stops.len(), voltage_volt);
        state.led(memory, p.range_volt, voltage_volt, |m, volt| self.moved(m, volt, 0.0))
    }

    fn step(&self, memory: &mut WidthsMemory, voltage_volt: f64, time_step_s: f64) -> f64 {
        let rate = (voltage_volt - memory.voltage_volt) / time_step_s;
        self.moved(memory, voltage_volt, rate)
    }

    fn check_memory(&self, memory: &WidthsMemory) -> Result<(), PreisachError> {
        memory.check(self.parameters.stops.len())
    }

    fn shifted(mut self, shift_deg: f64) -> Self {
        self.parameters.offset_deg += shift_deg;
        self
    }
}
