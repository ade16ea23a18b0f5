//! The actuators without hidden effect: twelve bases of three families of hysteresis.
//!
//! ```text
//! h = H[V] + d (V - bias) + q (V - bias)^2 - H(rest),   x = (1 - s) h + s R[h],   y = creep of x
//! ```
//! `R` is the state-dependent relaxation of [`crate::relaxation`], creep has five Kelvin-Voigt elements.

use super::bouc_wen::{BoucWen, BoucWenParameters};
use super::design::{BASES, BIAS_VOLT};
use super::draw::{Draw, Purpose};
use super::effect::Element;
use super::relays::{RelayParameters, Relays};
use crate::creep::CreepParameters;
use crate::error::TruthError;
use crate::hysteresis::{DomainWallHysteresis, DomainWallParameters, WallPopulation};
use crate::relaxation::{Relaxation, RelaxationChannel, RelaxationParameters};
use crate::stage::{HeldLag, Stage};

/// The hysteresis of a base.
#[derive(Debug, Clone)]
pub enum Family {
    /// Nine thousand relays.
    Relays(RelayParameters),
    /// Bouc-Wen elements.
    BoucWen(BoucWenParameters),
    /// Pinned domain walls.
    DomainWalls(DomainWallParameters),
}

/// An actuator without hidden effect.
#[derive(Debug, Clone)]
pub struct BaseActuator {
    /// Its hysteresis.
    pub family: Family,
    /// Reversible gain `d`, um/V, and its change `q`, um/V^2.
    pub reversible: (f64, f64),
    /// Share `s` of the motion that relaxes.
    pub relaxing_share: f64,
    /// The ordinary relaxation.
    pub relaxation: RelaxationParameters,
    /// The ordinary creep.
    pub creep: CreepParameters,
}

impl BaseActuator {
    /// The actuator of a base; `base` counts modulo [`BASES`].
    pub fn new(base: u64) -> Self {
        let base = base % BASES;
        let mut draw = Draw::new(Purpose::Base, &[base]);
        let family = match base % 4 {
            0 | 2 => Family::Relays(RelayParameters {
                relays: 9000,
                stroke_um: draw.uniform(150.0, 220.0),
                half_width_volt: draw.uniform(16.0, 24.0),
                centre_volt: draw.uniform(60.0, 80.0),
                spread_volt: (draw.uniform(40.0, 55.0), draw.uniform(45.0, 65.0)),
                reach_volt: 110.0,
            }),
            1 => Family::BoucWen(BoucWenParameters {
                stroke_um: draw.uniform(22.0, 30.0),
                elements: vec![(0.2, 6.0), (0.3, 16.0), (0.3, 36.0), (0.2, 70.0)],
                shape: draw.uniform(0.5, 0.6),
                asymmetry: draw.uniform(-0.05, 0.05),
            }),
            _ => Family::DomainWalls(DomainWallParameters {
                intrinsic_um_per_volt: 0.1,
                polarisation_stroke_um: draw.uniform(190.0, 220.0),
                reversible_share: draw.uniform(0.2, 0.3),
                langevin_centre_volt: draw.uniform(30.0, 60.0),
                langevin_width_volt: draw.uniform(45.0, 55.0),
                pinning_imprint: draw.uniform(-0.06, 0.06),
                populations: [(0.1, 6.0), (0.15, 12.0), (0.25, 24.0), (0.5, 48.0)]
                    .map(|(weight, pinning_volt)| WallPopulation { weight, pinning_volt })
                    .to_vec(),
                bias_volt: BIAS_VOLT,
            }),
        };
        // Bouc-Wen elements only take away: their base begins with a larger gain.
        let extra = if matches!(family, Family::BoucWen(_)) { 0.9 } else { 0.0 };
        let channel = |weight, time_constant_s| RelaxationChannel { weight, time_constant_s };
        Self {
            family,
            reversible: (extra + draw.uniform(1.9, 2.2), draw.uniform(-1.2e-3, 1.2e-3)),
            relaxing_share: draw.uniform(0.03, 0.06),
            relaxation: RelaxationParameters {
                channels: vec![
                    channel(0.6, draw.uniform(0.002, 0.004)),
                    channel(0.4, draw.uniform(0.008, 0.014)),
                ],
                reference_um: 250.0,
                position_sensitivity: 0.1,
                deviation_sensitivity: 0.1,
            },
            creep: CreepParameters {
                growth_per_decade: draw.uniform(0.010, 0.016),
                first_time_s: 0.08,
                elements_per_decade: 2,
                elements: 5,
            },
        }
    }

    /// Turns the terminal voltage (V) into rate-independent motion (um), zero at the rest.
    ///
    /// # Errors
    /// [`TruthError::Parameter`] for parameters out of range.
    pub fn hysteresis(&self, voltage_volt: &[f64]) -> Result<Vec<f64>, TruthError> {
        let (gain, curvature) = self.reversible;
        let mut motion = match &self.family {
            Family::Relays(p) => through(&mut Relays::new(p, BIAS_VOLT), voltage_volt),
            Family::BoucWen(p) => through(&mut BoucWen::new(p.clone(), BIAS_VOLT), voltage_volt),
            Family::DomainWalls(p) => {
                through(&mut DomainWallHysteresis::new(p.clone())?, voltage_volt)
            }
        };
        let rest = motion[0];
        for (h, v) in motion.iter_mut().zip(voltage_volt) {
            let deviation = v - BIAS_VOLT;
            *h += deviation * (gain + curvature * deviation) - rest;
        }
        Ok(motion)
    }

    /// The ordinary relaxation, in place.
    ///
    /// # Errors
    /// [`TruthError::Parameter`] for parameters out of range.
    pub fn relax(&self, dt_s: f64, signal: &mut [f64]) -> Result<(), TruthError> {
        let mut stage = Relaxation::new(self.relaxation.clone())?;
        let share = self.relaxing_share;
        stage.settle(signal[0]);
        for x in signal {
            *x += share * (stage.step(*x, dt_s) - *x);
        }
        Ok(())
    }

    /// The ordinary creep, in place.
    pub fn creep(&self, dt_s: f64, signal: &mut [f64]) {
        let compliance = self.creep.element_compliance();
        let times = self.creep.retardation_times_s();
        let elements: Vec<Element> = times.into_iter().map(|time_s| (compliance, time_s)).collect();
        creep(&elements, dt_s, signal);
    }
}

/// Adds the creep of Kelvin-Voigt elements to a motion that begins at rest.
pub fn creep(elements: &[Element], dt_s: f64, signal: &mut [f64]) {
    let start = signal[0];
    let mut states: Vec<(HeldLag, f64, f64)> =
        elements.iter().map(|(c, time_s)| (HeldLag::new(dt_s, *time_s), *c, start)).collect();
    let mut from = start;
    for x in signal {
        let input = *x;
        for (lag, compliance, z) in &mut states {
            *z = lag.step(*z, from, input);
            *x += *compliance * *z;
        }
        from = input;
    }
}

fn through(stage: &mut impl Stage, voltage_volt: &[f64]) -> Vec<f64> {
    let Some(first) = voltage_volt.first() else { return Vec::new() };
    stage.settle(*first);
    voltage_volt.iter().map(|v| stage.step(*v, 0.0)).collect()
}
