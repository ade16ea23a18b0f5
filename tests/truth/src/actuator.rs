//! The bench actuator: which stages it has, and their parameters.

use crate::creep::{Creep, CreepParameters};
use crate::error::TruthError;
use crate::hysteresis::{DomainWallHysteresis, DomainWallParameters, WallPopulation};
use crate::lvdt::LvdtParameters;
use crate::relaxation::{Relaxation, RelaxationChannel, RelaxationParameters};
use crate::stage::Chain;

/// An amplified piezo actuator with its displacement sensor.
///
/// command (V) -> domain-wall hysteresis -> relaxation -> creep -> LVDT (um)
#[derive(Debug, Clone, PartialEq)]
pub struct ActuatorParameters {
    /// Lowest permitted voltage, V.
    pub low_volt: f64,
    /// Highest permitted voltage, V.
    pub high_volt: f64,
    /// Bias: voltage of the initial rest and zero of the displacement, V.
    pub bias_volt: f64,
    /// Rate-independent hysteresis.
    pub hysteresis: DomainWallParameters,
    /// Rate-dependent relaxation.
    pub relaxation: RelaxationParameters,
    /// Creep.
    pub creep: CreepParameters,
    /// Displacement sensor.
    pub lvdt: LvdtParameters,
}

impl ActuatorParameters {
    /// An actuator like the CEDRAT APA500L: about 500 um between -20 and 150 V.
    ///
    /// The stroke is from memory and unverified; all else is chosen, none of it measured. The
    /// relaxation times are what turns 10 deg of flap at 0.2 Hz into 4 deg at 15 Hz.
    pub fn apa500l() -> Self {
        let walls = |weight, pinning_volt| WallPopulation { weight, pinning_volt };
        let bias_volt = 65.0;
        Self {
            low_volt: -20.0,
            high_volt: 150.0,
            bias_volt,
            hysteresis: DomainWallParameters {
                intrinsic_um_per_volt: 2.05,
                polarisation_stroke_um: 216.0,
                reversible_share: 0.20,
                langevin_centre_volt: 30.0,
                langevin_width_volt: 48.0,
                pinning_imprint: 0.06,
                populations: vec![
                    walls(0.10, 6.0),
                    walls(0.15, 12.0),
                    walls(0.25, 24.0),
                    walls(0.50, 48.0),
                ],
                bias_volt,
            },
            relaxation: RelaxationParameters {
                channels: vec![
                    RelaxationChannel { weight: 0.97, time_constant_s: 0.027 },
                    RelaxationChannel { weight: 0.03, time_constant_s: 0.005 },
                ],
                reference_um: 250.0,
                position_sensitivity: 0.10,
                deviation_sensitivity: 0.10,
            },
            creep: CreepParameters {
                growth_per_decade: 0.014,
                first_time_s: 0.1,
                elements_per_decade: 2,
                elements: 7,
            },
            lvdt: LvdtParameters { range_um: 500.0, noise_um: 0.25, bits: 16 },
        }
    }

    /// The rate-independent hysteresis alone.
    ///
    /// # Errors
    /// [`TruthError::Parameter`] for a parameter out of range.
    pub fn hysteresis_chain(&self) -> Result<Chain, TruthError> {
        Ok(Chain::new().then(DomainWallHysteresis::new(self.hysteresis.clone())?))
    }

    /// The whole actuator without the sensor.
    ///
    /// # Errors
    /// [`TruthError::Parameter`] for a parameter out of range.
    pub fn chain(&self) -> Result<Chain, TruthError> {
        let chain = self.hysteresis_chain()?;
        let chain = chain.then(Relaxation::new(self.relaxation.clone())?);
        Ok(chain.then(Creep::new(self.creep)?))
    }
}
