//! Periodic voltage for a wanted periodic flap history.

use super::joints::LastJoint;
use super::newton::Search;
use crate::{
    ActuatorLaw, ActuatorModel, AmplifierStage, PeriodicResponse, PeriodicSettings, PreisachError,
    StaticPreisach, VoltageRange,
};
use rotor_base::HarmonicSeries;
use serde::{Deserialize, Serialize};

/// Settings of a periodic inverse.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct InverseSettings {
    /// How orbits are simulated.
    pub periodic: PeriodicSettings,
    /// Harmonics of the voltage: as many harmonics of the flap are made right.
    pub voltage_harmonics: usize,
    /// Largest error of the mean and of every coefficient of these harmonics, deg.
    pub tolerance_deg: f64,
    /// Newton steps to try at one amplitude.
    pub largest_iterations: usize,
}

impl Default for InverseSettings {
    /// 48 harmonics to 1e-4 deg, within 25 steps: the corners that plays make at reversals need many.
    fn default() -> Self {
        Self {
            periodic: PeriodicSettings::default(),
            voltage_harmonics: 48,
            tolerance_deg: 1e-4,
            largest_iterations: 25,
        }
    }
}

/// A voltage and what it does.
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodicInverse {
    /// The closed orbit of the voltage found: voltage, flap, steps.
    pub response: PeriodicResponse,
    /// Largest error of the flap over the revolution, deg: what the harmonics beyond
    /// [`InverseSettings::voltage_harmonics`] leave.
    pub largest_error_deg: f64,
    /// Root mean square error over the revolution, deg.
    pub rms_error_deg: f64,
    /// Half peak to peak of the wanted motion, deg.
    pub amplitude_deg: f64,
    /// Newton steps in all.
    pub iterations: usize,
}

impl ActuatorModel {
    /// The periodic voltage under which the flap moves as wanted.
    ///
    /// ```text
    /// harmonics of flap[ u_0 + sum_n (u_nc cos n psi + u_ns sin n psi) ] = wanted harmonics,
    /// n = 1 .. voltage_harmonics, and the mean
    /// ```
    /// Newton's method with a difference Jacobian on the simulated closed orbit; the voltage stays
    /// inside [`ActuatorModel::range_volt`] at every step. The orbit starts from rest at its mean
    /// voltage, as in [`ActuatorModel::periodic_response`]. If the wanted motion is not found at once,
    /// it is approached through smaller amplitudes of the same shape.
    ///
    /// Behind a joint that sticks ([`crate::Backlash`], [`crate::CoulombFriction`]) no small change of
    /// the voltage moves the flap from rest, and none moves it while the gap is taken up. There the
    /// joint is undone exactly, what is asked of its input is found as above with 48 harmonics or more,
    /// and Newton's method ends with the harmonics that `wanted_deg` has. The jumps that a gap asks for at
    /// reversals are spread over one period of the highest voltage harmonic; what that leaves is in
    /// [`PeriodicInverse::largest_error_deg`]. It falls with the square of that period, and grows with the
    /// number of joints and with modes behind them.
    ///
    /// Commands beyond a saturation at the amplifier's input are not tried.
    ///
    /// A [`crate::RelayGrid`] moves in steps, which have no inverse: the voltage is that of the plays
    /// with the same density, the motion and its error those of the relays.
    ///
    /// # Errors
    /// [`PreisachError::MotionOutOfReach`] if the voltage range ends before the motion is reached: it
    /// says what amplitude of the same shape is within reach. [`PreisachError::InverseNotConverged`] if
    /// Newton's method stops for another reason. Refused settings, and the errors of
    /// [`ActuatorModel::periodic_response`].
    pub fn periodic_inverse(
        &self,
        wanted_deg: &HarmonicSeries,
        rev_hz: f64,
        settings: &InverseSettings,
    ) -> Result<PeriodicInverse, PreisachError> {
        let search = Search::new(self, wanted_deg, rev_hz, settings)?;
        if let ActuatorLaw::RelayGrid(relays) = &self.law {
            let plays = StaticPreisach::new(*relays.grid(), relays.map().clone())?;
            let law = ActuatorLaw::StaticPreisach(plays);
            let smooth = Self { law, ..self.clone() };
            let found = smooth.periodic_inverse(wanted_deg, rev_hz, settings)?;
            return search.evaluated(&found.response.voltage_volt, found.iterations);
        }
        if let Some(limited) = self.limited() {
            return limited.periodic_inverse(wanted_deg, rev_hz, settings);
        }
        match LastJoint::of(self) {
            Some(joint) => joint.inverse(self, wanted_deg, rev_hz, settings),
            None => search.start_at_rest(),
        }
    }

    /// The same actuator commanded only as far as its amplifier goes: a command beyond a saturation at
    /// the input does nothing more. None where it goes as far as the range.
    fn limited(&self) -> Option<Self> {
        let Some(AmplifierStage::Saturation(limits)) = self.amplifier.first() else {
            return None;
        };
        let range = self.range_volt;
        let (low, high) = limits.reached_volt();
        let low = range.lowest_volt().max(low);
        let high = range.highest_volt().min(high);
        if low <= range.lowest_volt() && high >= range.highest_volt() {
            return None;
        }
        let range_volt = VoltageRange::new(low, high).ok()?;
        Some(Self { range_volt, ..self.clone() })
    }
}
