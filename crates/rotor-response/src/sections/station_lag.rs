//! One lag channel of a station, and its states over a revolution.

use crate::ResponseError;
use crate::sections::lag::{Collocation, PeriodicLag};
use flap_aero::SectionCoefficients;

/// Place of the part of the rigid section in the lift, behind lift, moment and hinge moment.
pub(crate) const RIGID_LIFT: usize = 3;
/// Place of the circulatory part of the lift.
pub(crate) const CIRCULATORY_LIFT: usize = 4;

/// Slowest reduced-time rate, in semichords per rad, so that a lag state crossing the reverse-flow
/// boundary still has an equation.
const SLOWEST_RATE: f64 = 1e-3;

/// One lag channel of a station. Its input does not depend on the Mach number, its outputs do.
#[derive(Debug, Clone)]
pub(crate) struct SectionChannel {
    pub(crate) input: [f64; 4],
    /// Output and its gain at every point, for the outputs the channel has.
    pub(crate) gains: Vec<(usize, Vec<f64>)>,
    /// Whether the flap has no part in it; only of sections beyond linear theory.
    pub(crate) rigid: bool,
    /// Whether it is circulatory; only of sections whose lift holds pressure waves too.
    pub(crate) circulatory: bool,
    /// Rate at every point, per rad.
    pub(crate) rates: Vec<f64>,
}

/// A channel and its states over a revolution.
#[derive(Debug, Clone)]
pub(crate) struct StationLag {
    pub(crate) channel: SectionChannel,
    pub(crate) lag: PeriodicLag,
}

impl StationLag {
    /// The periodic states of a channel.
    ///
    /// # Errors
    /// [`ResponseError`] of a rate that no element can follow.
    pub(crate) fn new(
        collocation: &Collocation,
        channel: SectionChannel,
    ) -> Result<Self, ResponseError> {
        let lag = PeriodicLag::new(collocation, &channel.rates)?;
        Ok(Self { channel, lag })
    }
}

impl SectionChannel {
    /// Its gain at every point in an output of [`StationLags`], if it has one.
    pub(crate) fn gain(&self, output: usize) -> Option<&[f64]> {
        let of = match output {
            RIGID_LIFT => self.rigid.then_some(0)?,
            CIRCULATORY_LIFT => self.circulatory.then_some(0)?,
            _ => output,
        };
        self.gains.iter().find(|(place, _)| *place == of).map(|(_, gain)| gain.as_slice())
    }

    /// Channel number `channel` of sections of some coefficients at the points, from their speeds, tip speed, and chord, R.
    pub(crate) fn new(
        speeds: &[f64],
        coefficients: &[SectionCoefficients],
        channel: usize,
        chord: f64,
    ) -> Self {
        let semichord = 0.5 * chord;
        let of = |k: &SectionCoefficients| k.lags[channel];
        let rates: Vec<f64> = speeds
            .iter()
            .zip(coefficients)
            .map(|(speed, k)| of(k).pole * (speed / semichord).max(SLOWEST_RATE))
            .collect();
        let gains = (0..3)
            .map(|output| {
                let along: Vec<f64> = coefficients.iter().map(|k| of(k).output[output]).collect();
                (output, along)
            })
            .filter(|(_, along)| along.iter().any(|gain| *gain != 0.0))
            .collect();
        let input = coefficients.first().map_or([0.0; 4], |k| of(k).input);
        let circulatory =
            coefficients.first().is_some_and(|k| k.has_waves() && of(k).is_circulatory);
        let rigid = input[2] == 0.0 && input[3] == 0.0;
        Self { input, gains, rigid, circulatory, rates }
    }
}
