//! Response to a periodic command: closed orbits, the bias of zero mean, the stroke limit.

use crate::check::{check_count, check_finite, check_positive, largest_above};
use crate::{ActuatorModel, Drive, PreisachError, StartState, StepCounts};
use rotor_base::{HarmonicSeries, uniform_azimuths_rad};
use serde::{Deserialize, Serialize};

/// Settings of a periodic response.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(default, deny_unknown_fields)]
pub struct PeriodicSettings {
    /// Time steps per revolution.
    pub steps_per_rev: usize,
    /// Harmonics of the flap angle to return.
    pub harmonics: usize,
    /// Largest change from one revolution to the next of a closed orbit, deg.
    pub closure_deg: f64,
    /// Revolutions to try.
    pub largest_revolutions: usize,
}

impl Default for PeriodicSettings {
    /// 720 steps, 24 harmonics, closed to 1e-9 deg within 100 revolutions, mean within 0.001 deg.
    fn default() -> Self {
        Self { steps_per_rev: 720, harmonics: 24, closure_deg: 1e-9, largest_revolutions: 100 }
    }
}

/// A closed orbit.
#[derive(Debug, Clone, PartialEq)]
pub struct PeriodicResponse {
    /// The command the actuator saw.
    pub voltage_volt: HarmonicSeries,
    /// Flap angle about azimuth, deg.
    pub flap_deg: HarmonicSeries,
    /// Flap angle at `steps_per_rev` equally spaced azimuths from zero, deg.
    pub samples_deg: Vec<f64>,
    /// Revolutions marched until the orbit closed.
    pub revolutions_used: usize,
    /// Largest change over the last revolution, deg.
    pub closure_deg: f64,
    /// What happened to the steps of the last revolution.
    pub counts: StepCounts,
}

impl ActuatorModel {
    /// The closed orbit under a periodic voltage.
    ///
    /// ```text
    /// u(psi) = mean + sum_n (u_nc cos n psi + u_ns sin n psi),   psi = 2 pi rev_hz t
    /// ```
    /// Starts at rest at the mean voltage, the flap settled, and marches revolutions until two of
    /// them agree. Wide plays that the command never reaches therefore stay where the mean voltage
    /// left them: the orbit belongs to an actuator brought to its bias and then driven.
    ///
    /// Slow linear states of the stages (creep, heat) are not waited for: after each revolution they
    /// are taken to the values that the revolution just marched would leave unchanged. The sensor
    /// stages have no part in it.
    ///
    /// # Errors
    /// [`PreisachError::CommandOutOfRange`] names the azimuth of the largest excess;
    /// [`PreisachError::OrbitNotClosed`], [`PreisachError::Diverged`], or refused settings.
    pub fn periodic_response(
        &self,
        voltage_volt: &HarmonicSeries,
        rev_hz: f64,
        settings: &PeriodicSettings,
    ) -> Result<PeriodicResponse, PreisachError> {
        self.periodic_response_loaded(voltage_volt, &HarmonicSeries::zero(0), rev_hz, settings)
    }

    /// The closed orbit under a periodic voltage and a periodic external load, N, both against
    /// azimuth; see [`crate::LoadStiffness`] and [`crate::Calibration::load_newton`].
    ///
    /// # Errors
    /// As [`Self::periodic_response`]; [`PreisachError::NoLoadStage`].
    pub fn periodic_response_loaded(
        &self,
        voltage_volt: &HarmonicSeries,
        load_newton: &HarmonicSeries,
        rev_hz: f64,
        settings: &PeriodicSettings,
    ) -> Result<PeriodicResponse, PreisachError> {
        check_positive("rev_hz", rev_hz)?;
        check_count("steps_per_rev", settings.steps_per_rev, 2 * settings.harmonics + 2)?;
        let commands = self.sampled_command(voltage_volt, settings.steps_per_rev)?;
        let azimuths = uniform_azimuths_rad(settings.steps_per_rev);
        let loads: Vec<f64> = azimuths.iter().map(|&psi| load_newton.value(psi)).collect();
        let time_step_s = 1.0 / (rev_hz * settings.steps_per_rev as f64);
        let revolution = Drive { voltages_volt: &commands, loads_newton: &loads, time_step_s };
        let chain = self.chain(time_step_s)?;
        let mut memory =
            self.start_loaded(voltage_volt.mean, load_newton.mean, StartState::Rest)?;
        let mut orbit = self.continue_drive(&mut memory, &revolution)?;
        let mut closure_deg = f64::INFINITY;
        for revolutions_used in 2..=settings.largest_revolutions.max(2) {
            let before = memory.clone();
            let next = self.continue_drive(&mut memory, &revolution)?;
            closure_deg = orbit.iter().zip(&next).fold(0.0, |m, (a, b)| f64::max(m, (a - b).abs()));
            orbit = next;
            if closure_deg <= settings.closure_deg {
                let flap_deg = HarmonicSeries::from_uniform_samples(&orbit, settings.harmonics)?;
                return Ok(PeriodicResponse {
                    voltage_volt: voltage_volt.clone(),
                    flap_deg,
                    samples_deg: orbit,
                    revolutions_used,
                    closure_deg,
                    counts: memory.counts().since(before.counts()),
                });
            }
            memory.settle(&chain, &before, 1.0 / rev_hz);
        }
        Err(PreisachError::OrbitNotClosed {
            revolutions: settings.largest_revolutions,
            closure_deg,
            allowed_deg: settings.closure_deg,
        })
    }

    /// The command at every step of a revolution, refused where it leaves the range.
    fn sampled_command(
        &self,
        voltage_volt: &HarmonicSeries,
        steps_per_rev: usize,
    ) -> Result<Vec<f64>, PreisachError> {
        let range = self.range_volt;
        let azimuths = uniform_azimuths_rad(steps_per_rev);
        let commands: Vec<f64> = azimuths.iter().map(|&psi| voltage_volt.value(psi)).collect();
        check_finite("voltage_volt", commands.iter().copied())?;
        let (worst, excess) =
            largest_above(0.0, commands.iter().map(|&volt| range.excess_volt(volt)));
        if excess > COMMAND_TOLERANCE * range.span_volt() {
            return Err(PreisachError::CommandOutOfRange {
                azimuth_deg: azimuths[worst].to_degrees(),
                voltage_volt: commands[worst],
                range,
            });
        }
        Ok(commands)
    }
}

/// Rounding of a command at the very end of its range, as a fraction of the span.
const COMMAND_TOLERANCE: f64 = 1e-9;
