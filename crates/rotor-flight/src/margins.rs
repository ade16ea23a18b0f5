//! How wrong T may be along the speeds of a flight: phase, gain, one load, and the speed itself.

use crate::flying_case::FlyingCase;
use crate::{FlightError, FlightState};
use hhc_control::{FeedbackLaw, RelaxedStep, TMatrix};
use rayon::prelude::*;
use rotor_base::limit;
use rotor_study::HubLoads;
use serde::Serialize;

/// Steps between two knots at which the reach of a T is looked for, and bisections of the first that diverges.
const STEPS_PER_KNOT: usize = 4;
const BISECTIONS: u32 = 20;

/// How wrong T may be in the flights of a case, before the step of the thrust.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MarginStudy {
    /// Part of the way that a step of the loop goes.
    pub gain: f64,
    /// Advance ratios of the rotor.
    pub advance_ratios: Vec<f64>,
    /// Every harmonic of the flight alone, then all at once.
    pub sets: Vec<MarginSet>,
}

/// Margins of one set of harmonics.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MarginSet {
    /// The harmonics under control, per rev.
    pub harmonics: Vec<usize>,
    /// At every advance ratio.
    pub points: Vec<MarginPoint>,
}

/// How wrong the T of one advance ratio may be. Each error is alone; it multiplies the rotor's own T and comes on top of what a T
/// that is handed in errs by. A loop that diverges without one has phases of 0 deg and gains of 1.
///
/// Serialised, a limit that does not exist is the word `unbounded` in the place of its number.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct MarginPoint {
    /// Where T is right.
    pub advance_ratio: f64,
    /// Largest singular value of the weighted T over the smallest; infinity for a T that cannot move a combination of loads.
    #[serde(serialize_with = "limit::gain")]
    pub condition: f64,
    /// Phase error of all flaps at which the loop diverges, deg; 180 for none.
    #[serde(serialize_with = "limit::phase")]
    pub common_phase_deg: f64,
    /// Gain of the rotor over that of T at which it does; infinity for none.
    #[serde(serialize_with = "limit::gain")]
    pub common_gain: f64,
    /// Phase error of all flaps from which `J` rises above `J0` on the way, deg; 180 for none.
    #[serde(serialize_with = "limit::phase")]
    pub common_overshoot_deg: f64,
    /// The same of one flap alone, flap by flap: the largest difference between flaps.
    #[serde(serialize_with = "limit::phases")]
    pub flap_overshoot_deg: Vec<f64>,
    /// Phase error of one load alone at which the loop diverges, deg, load by load; 180 for none.
    #[serde(serialize_with = "limit::phases")]
    pub load_phase_deg: Vec<f64>,
    /// Gain of one load over that in T at which it does, load by load; infinity for none.
    #[serde(serialize_with = "limit::gains")]
    pub load_gain: Vec<f64>,
    /// Spectral radius of the loop with this T at every advance ratio, in steps of the loop's gain; 1 and more diverges.
    pub radius: Vec<f64>,
    /// The same in whole steps.
    pub whole_step_radius: Vec<f64>,
    /// Lowest and highest advance ratio between which whole steps with this T converge; none at an end that the speeds of the
    /// flight do not reach, `advance_ratio` itself at both where they diverge there.
    #[serde(serialize_with = "limit::reach")]
    pub holds_within: [Option<f64>; 2],
}

impl FlyingCase<'_> {
    /// How wrong T may be at every advance ratio of the rotor: a T that is held, the limits of the voltage left out. Where T is
    /// handed in, it is that of the loop; the rotor answers as it does.
    ///
    /// # Errors
    /// [`FlightError`] of actuators, rotor and control.
    pub fn margins(&self) -> Result<MarginStudy, FlightError> {
        let all = &self.values().harmonics;
        let alone = all.iter().map(|&n| vec![n]);
        let together = (all.len() > 1).then(|| all.clone());
        let known = alone.chain(together).filter(|harmonics| self.knows_t_of(harmonics));
        let sets = known.map(|harmonics| self.margin_set(harmonics));
        Ok(MarginStudy {
            gain: self.values().gain,
            advance_ratios: self.path().advance_ratios().to_vec(),
            sets: sets.collect::<Result<_, _>>()?,
        })
    }

    fn margin_set(&self, harmonics: Vec<usize>) -> Result<MarginSet, FlightError> {
        let flight = self.flight_at(&harmonics)?;
        let (known, steps) = (flight.steps()?, flight.own_steps()?);
        let at = |advance_ratio: f64| FlightState { advance_ratio, thrust_share: 0.0 };
        let t_at = |mu: f64| flight.own_t_in(at(mu), &steps);
        let knots = self.path().advance_ratios();
        let each = knots.iter().map(|&mu| t_at(mu)).collect::<Result<Vec<TMatrix>, _>>()?;
        let (weights, step) = (&flight.settings.load_weights, flight.settings.step(&flight.layout));
        let point = |(k, &advance_ratio): (usize, &f64)| -> Result<MarginPoint, FlightError> {
            let state = at(advance_ratio);
            let law = FeedbackLaw::new(&flight.t_in(state, &known)?, weights)?;
            let baseline = flight.path.loads(state, &[])?;
            let found = law.margins(&flight.layout, &each[k], step, &baseline)?;
            let loads = (0..HubLoads::NAMES.len())
                .map(|load| law.load_margin(&each[k], step, load))
                .collect::<Result<Vec<_>, _>>()?;
            let radii = |step: RelaxedStep| -> Result<Vec<f64>, FlightError> {
                each.iter().map(|there| Ok(law.relaxed_spectral_radius(step, there)?)).collect()
            };
            let whole_step = RelaxedStep { gain: 1.0, ..step };
            let whole = |mu: f64| Ok(law.relaxed_spectral_radius(whole_step, &t_at(mu)?)?);
            Ok(MarginPoint {
                advance_ratio,
                condition: law.condition(),
                common_phase_deg: found.common_phase_deg,
                common_gain: found.common_gain,
                common_overshoot_deg: found.common_overshoot_deg,
                flap_overshoot_deg: found.flap_overshoot_deg,
                load_phase_deg: loads.iter().map(|margin| margin.phase_deg).collect(),
                load_gain: loads.iter().map(|margin| margin.gain).collect(),
                radius: radii(step)?,
                whole_step_radius: radii(whole_step)?,
                holds_within: [
                    reach(&knots[..=k], true, whole)?,
                    reach(&knots[k..], false, whole)?,
                ],
            })
        };
        let points = knots.par_iter().enumerate().map(point).collect::<Result<_, _>>()?;
        Ok(MarginSet { harmonics, points })
    }
}

/// Where a radius first reaches 1 from the one end of rising knots to the other; none if nowhere.
fn reach(
    knots: &[f64],
    downward: bool,
    radius: impl Fn(f64) -> Result<f64, FlightError>,
) -> Result<Option<f64>, FlightError> {
    let mut places: Vec<f64> = knots
        .windows(2)
        .flat_map(|pair| {
            let step = (pair[1] - pair[0]) / STEPS_PER_KNOT as f64;
            (0..STEPS_PER_KNOT).map(move |k| pair[0] + step * k as f64)
        })
        .chain(knots.last().copied())
        .collect();
    if downward {
        places.reverse();
    }
    if let Some(&own) = places.first()
        && radius(own)? >= 1.0
    {
        return Ok(Some(own));
    }
    for pair in places.windows(2) {
        let (mut inside, mut outside) = (pair[0], pair[1]);
        if radius(outside)? < 1.0 {
            continue;
        }
        for _ in 0..BISECTIONS {
            let middle = f64::midpoint(inside, outside);
            *(if radius(middle)? < 1.0 { &mut inside } else { &mut outside }) = middle;
        }
        return Ok(Some(outside));
    }
    Ok(None)
}
