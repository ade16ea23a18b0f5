//! Response to a periodic command: closed orbits, the bias of zero mean, the stroke limit.

use crate::actuator::check_positive;
use crate::{ActuatorModel, PreisachError, StartState, StepCounts};
use rotor_base::{Harmonic, HarmonicSeries, uniform_azimuths_rad};
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
    /// Largest mean flap angle that counts as zero when the bias is solved for, deg.
    pub mean_deg: f64,
}

impl Default for PeriodicSettings {
    /// 720 steps, 24 harmonics, closed to 1e-9 deg within 100 revolutions, mean within 0.001 deg.
    fn default() -> Self {
        Self {
            steps_per_rev: 720,
            harmonics: 24,
            closure_deg: 1e-9,
            largest_revolutions: 100,
            mean_deg: 1e-3,
        }
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

/// How often the bias search may evaluate the orbit.
const BIAS_ITERATIONS: usize = 60;

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
    /// # Errors
    /// [`PreisachError::CommandOutOfRange`] names the azimuth of the largest excess;
    /// [`PreisachError::OrbitNotClosed`], [`PreisachError::Diverged`], or refused settings.
    pub fn periodic_response(
        &self,
        voltage_volt: &HarmonicSeries,
        rev_hz: f64,
        settings: &PeriodicSettings,
    ) -> Result<PeriodicResponse, PreisachError> {
        check_positive("rev_hz", rev_hz)?;
        let least = 2 * settings.harmonics + 2;
        if settings.steps_per_rev < least {
            let value = settings.steps_per_rev;
            return Err(PreisachError::TooFew {
                quantity: "steps_per_rev",
                value,
                least,
            });
        }
        let commands = self.sampled_command(voltage_volt, settings.steps_per_rev)?;
        let time_step_s = 1.0 / (rev_hz * settings.steps_per_rev as f64);
        let mut memory = self.start(voltage_volt.mean, StartState::Rest)?;
        let mut orbit = self.continue_from(&mut memory, &commands, time_step_s)?;
        let mut closure_deg = f64::INFINITY;
        for revolutions_used in 2..=settings.largest_revolutions.max(2) {
            let counts_before = memory.counts();
            let next = self.continue_from(&mut memory, &commands, time_step_s)?;
            closure_deg = orbit
                .iter()
                .zip(&next)
                .fold(0.0, |m, (a, b)| f64::max(m, (a - b).abs()));
            orbit = next;
            if closure_deg <= settings.closure_deg {
                let flap_deg = HarmonicSeries::from_uniform_samples(&orbit, settings.harmonics)?;
                return Ok(PeriodicResponse {
                    voltage_volt: voltage_volt.clone(),
                    flap_deg,
                    samples_deg: orbit,
                    revolutions_used,
                    closure_deg,
                    counts: memory.counts().since(counts_before),
                });
            }
        }
        Err(PreisachError::OrbitNotClosed {
            revolutions: settings.largest_revolutions,
            closure_deg,
            allowed_deg: settings.closure_deg,
        })
    }

    /// The mean voltage that makes the mean flap angle zero, and the orbit there.
    ///
    /// The mean of `voltage_volt` is where the search starts; its harmonics are kept. Paper
    /// equation (6): the bias is not a control, it follows from the harmonics.
    ///
    /// # Errors
    /// [`PreisachError::CommandOutOfRange`] if the harmonics alone do not fit into the range,
    /// [`PreisachError::BiasOutsideRange`] if no mean inside it will do,
    /// [`PreisachError::BiasNotConverged`], and those of [`Self::periodic_response`].
    pub fn bias_for_zero_mean(
        &self,
        voltage_volt: &HarmonicSeries,
        rev_hz: f64,
        settings: &PeriodicSettings,
    ) -> Result<(f64, PeriodicResponse), PreisachError> {
        check_positive("mean_deg", settings.mean_deg)?;
        let mut command = voltage_volt.clone();
        command.mean = 0.0;
        let (least, most) = extremes(&command, settings.steps_per_rev.max(1));
        let (mut lowest_volt, mut highest_volt) = (
            self.range_volt.lowest_volt() - least,
            self.range_volt.highest_volt() - most,
        );
        // wider than the range, or NaN
        let fits = lowest_volt <= highest_volt;
        if !fits {
            command.mean = self.range_volt.middle_volt() - 0.5 * (least + most);
            self.sampled_command(&command, settings.steps_per_rev)?;
            // full scale up to rounding: there is one mean it fits with
            (lowest_volt, highest_volt) = (command.mean, command.mean);
        }
        let mut evaluate = |mean: f64| -> Result<PeriodicResponse, PreisachError> {
            command.mean = mean;
            self.periodic_response(&command, rev_hz, settings)
        };
        let closed = |orbit: &PeriodicResponse| orbit.flap_deg.mean.abs() <= settings.mean_deg;

        let mut near_volt = voltage_volt.mean.clamp(lowest_volt, highest_volt);
        let orbit = evaluate(near_volt)?;
        if closed(&orbit) {
            return Ok((near_volt, orbit));
        }
        let mut near_deg = orbit.flap_deg.mean;
        let mut far_volt = if near_deg < 0.0 {
            highest_volt
        } else {
            lowest_volt
        };
        let orbit = evaluate(far_volt)?;
        if closed(&orbit) {
            return Ok((far_volt, orbit));
        }
        let mut far_deg = orbit.flap_deg.mean;
        if far_deg * near_deg > 0.0 {
            return Err(PreisachError::BiasOutsideRange {
                limit_volt: far_volt,
                mean_at_limit_deg: far_deg,
            });
        }
        // Illinois variant of false position: the mean flap angle grows with the bias
        for _ in 0..BIAS_ITERATIONS {
            let bias_volt = near_volt - near_deg * (far_volt - near_volt) / (far_deg - near_deg);
            let orbit = evaluate(bias_volt)?;
            if closed(&orbit) {
                return Ok((bias_volt, orbit));
            }
            let mean_deg = orbit.flap_deg.mean;
            if mean_deg * near_deg < 0.0 {
                (far_volt, far_deg) = (near_volt, near_deg);
            } else {
                far_deg *= 0.5;
            }
            (near_volt, near_deg) = (bias_volt, mean_deg);
        }
        Err(PreisachError::BiasNotConverged {
            iterations: BIAS_ITERATIONS,
            bias_volt: near_volt,
            mean_deg: near_deg,
            allowed_deg: settings.mean_deg,
        })
    }

    /// The flap amplitude reached by one harmonic at full scale, deg: its first harmonic of the
    /// drive, about the bias of zero mean.
    ///
    /// | argument | unit |
    /// |---|---|
    /// | `amplitude_volt` | V, half the peak-to-peak voltage |
    /// | `harmonic_per_rev` | 1, 2, 3... |
    /// | `rev_hz` | revolutions per second |
    ///
    /// An amplitude of half the range leaves no room to move the bias; the orbit is then taken
    /// about the middle of the range, whatever mean it has. The same is done if the room does not
    /// suffice.
    ///
    /// # Errors
    /// Those of [`Self::periodic_response`].
    pub fn stroke_limit_deg(
        &self,
        amplitude_volt: f64,
        harmonic_per_rev: usize,
        rev_hz: f64,
        settings: &PeriodicSettings,
    ) -> Result<f64, PreisachError> {
        check_positive("amplitude_volt", amplitude_volt)?;
        let mut command = HarmonicSeries::zero(harmonic_per_rev);
        command.mean = self.range_volt.middle_volt();
        command.set_harmonic(
            harmonic_per_rev,
            Harmonic {
                cosine: amplitude_volt,
                sine: 0.0,
            },
        );
        let orbit = match self.bias_for_zero_mean(&command, rev_hz, settings) {
            Ok((_, orbit)) => orbit,
            Err(PreisachError::BiasOutsideRange { .. }) => {
                self.periodic_response(&command, rev_hz, settings)?
            }
            Err(error) => return Err(error),
        };
        Ok(orbit.flap_deg.harmonic(harmonic_per_rev).amplitude())
    }

    /// The command at every step of a revolution, refused where it leaves the range.
    fn sampled_command(
        &self,
        voltage_volt: &HarmonicSeries,
        steps_per_rev: usize,
    ) -> Result<Vec<f64>, PreisachError> {
        let range = self.range_volt;
        let azimuths = uniform_azimuths_rad(steps_per_rev);
        let commands: Vec<f64> = azimuths
            .iter()
            .map(|&psi| voltage_volt.value(psi))
            .collect();
        let mut worst = (0.0, 0);
        for (index, &value) in commands.iter().enumerate() {
            let excess = range.excess_volt(value);
            if excess.is_nan() {
                return Err(PreisachError::NotFinite {
                    quantity: "voltage_volt",
                    index,
                    value,
                });
            }
            if excess > worst.0 {
                worst = (excess, index);
            }
        }
        if worst.0 > COMMAND_TOLERANCE * range.span_volt() {
            return Err(PreisachError::CommandOutOfRange {
                azimuth_deg: azimuths[worst.1].to_degrees(),
                voltage_volt: commands[worst.1],
                lowest_volt: range.lowest_volt(),
                highest_volt: range.highest_volt(),
            });
        }
        Ok(commands)
    }
}

/// Rounding allowed to a command, as a fraction of the range.
const COMMAND_TOLERANCE: f64 = 1e-9;

/// Smallest and largest value over a revolution.
fn extremes(series: &HarmonicSeries, steps: usize) -> (f64, f64) {
    uniform_azimuths_rad(steps)
        .iter()
        .map(|&psi| series.value(psi))
        .fold((f64::INFINITY, f64::NEG_INFINITY), |(low, high), value| {
            (low.min(value), high.max(value))
        })
}
