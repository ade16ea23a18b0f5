//! What steers a flight: a controller with what it knows of T.

use crate::{Flight, FlightError, FlightState, RotorPath};
use hhc_control::{CycleController, EstimatorSettings, RelaxedController, TMatrix};

/// How T is known in flight.
#[derive(Debug, Clone, PartialEq)]
pub enum Guidance {
    /// T of the start, held.
    Fixed,
    /// T of the knots before a step of the thrust, interpolated over the advance ratio.
    Scheduled,
    /// T of the start, then estimated with Z0 and the noise.
    Adaptive(EstimatorSettings),
}

/// The controller of a flight.
pub(crate) enum Pilot {
    /// T of the start.
    Fixed(Box<RelaxedController>, TMatrix),
    /// Columns of T at every knot.
    Scheduled(Box<RelaxedController>, Vec<Vec<Vec<f64>>>),
    Adaptive(Box<CycleController>),
}

impl Pilot {
    /// Takes over at zero control; `start` are the loads there.
    pub(crate) fn new(
        flight: &Flight<'_>,
        guidance: &Guidance,
        start: &[f64],
    ) -> Result<Self, FlightError> {
        let relaxed = RelaxedController::new(&flight.layout, start.len(), flight.settings.clone())?;
        let first = || flight.identify(flight.state_at(0.0));
        Ok(match guidance {
            Guidance::Fixed => Self::Fixed(Box::new(relaxed), first()?),
            Guidance::Scheduled => {
                let steps = flight.steps()?;
                let columns = flight.path.advance_ratios().iter().map(|&advance_ratio| {
                    let state = FlightState { advance_ratio, thrust_share: 0.0 };
                    Ok(flight.t_in(state, &steps)?.columns())
                });
                let columns = columns.collect::<Result<Vec<_>, FlightError>>()?;
                Self::Scheduled(Box::new(relaxed), columns)
            }
            Guidance::Adaptive(settings) => {
                let cycle = CycleController::new(relaxed, settings, &first()?, start)?;
                Self::Adaptive(Box::new(cycle))
            }
        })
    }

    fn controller(&self) -> &RelaxedController {
        match self {
            Self::Fixed(relaxed, _) | Self::Scheduled(relaxed, _) => relaxed,
            Self::Adaptive(cycle) => cycle.controller(),
        }
    }

    /// The control that acts, V.
    pub(crate) fn control_volt(&self) -> &[f64] {
        match self {
            Self::Fixed(relaxed, _) | Self::Scheduled(relaxed, _) => relaxed.control_volt(),
            Self::Adaptive(cycle) => cycle.control_volt(),
        }
    }

    /// Whether a limit of an amplitude bound in the last step.
    pub(crate) fn is_limited(&self) -> bool {
        self.controller().is_limited()
    }

    /// The next control from the loads of a cycle that ended at an advance ratio.
    pub(crate) fn step(
        &mut self,
        path: &RotorPath,
        advance_ratio: f64,
        outputs: &[f64],
    ) -> Result<(), FlightError> {
        match self {
            Self::Fixed(relaxed, t) => relaxed.step(t, outputs).map(|_| ())?,
            Self::Scheduled(relaxed, knots) => {
                let [(low, share), (high, rest)] = path.weights(advance_ratio);
                let pairs = knots[low].iter().zip(&knots[high]);
                let columns: Vec<Vec<f64>> = pairs
                    .map(|(a, b)| a.iter().zip(b).map(|(a, b)| share * a + rest * b).collect())
                    .collect();
                relaxed.step(&TMatrix::from_columns(&columns)?, outputs).map(|_| ())?;
            }
            Self::Adaptive(cycle) => cycle.step(outputs).map(|_| ())?,
        }
        Ok(())
    }

    /// Leaves a flap (from 0) out.
    pub(crate) fn lose_flap(&mut self, flap: usize) -> Result<(), FlightError> {
        match self {
            Self::Fixed(relaxed, _) | Self::Scheduled(relaxed, _) => {
                relaxed.set_flap_lost(flap, true)?;
            }
            Self::Adaptive(cycle) => cycle.lose_flap(flap)?,
        }
        Ok(())
    }
}
