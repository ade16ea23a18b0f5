//! Periodic voltage for a wanted periodic flap history.

use super::joints::LastJoint;
use super::newton::Search;
use super::{InverseSettings, PeriodicInverse};
use crate::{ActuatorModel, AmplifierStage, PreisachError, VoltageRange};
use rotor_base::HarmonicSeries;

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
