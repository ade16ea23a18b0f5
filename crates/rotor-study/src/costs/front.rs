//! What a fall of `J` costs: fronts of `J` against actuation power and against loads of the blade.
//!
//! ```text
//! Z(u) = Z0 + T u,    J = Z'WZ;      P = sum over the pairs c_p |g_p u_p|^2 (C.13);      S = sum_n |m_n + M_n u|^2
//! min J + w P,  or  J + w S,   |u_p| <= U_p, voltage within its range           w from 0 to infinity
//! ```
//! `u` are the voltages, and every actuator is its harmonic gain `g_p` at full scale. `m_n` is the load of the blade at n per
//! rev, so that `S` is twice its mean square about the mean. Rotor and blade are linearised about the trim.

use crate::control::{ControlSet, Drives};
use crate::error::StudyError;
use crate::flaps::PlantError;
use crate::loads::{is_still, loads_cost};
use crate::plant::{HUB_OUTPUTS, RotorPlant, output_weights, watt_per_deg2};
use crate::rotor::{HARMONICS, TrimmedRotor};
use hhc_control::{
    ControlError, ControlLimits, FeedbackLaw, FrontPoint, Plant, RunError, SecondCost, TMatrix,
};
use rayon::prelude::*;
use rotor_base::series::{added, coefficients, scaled};
use rotor_base::{Harmonic, HarmonicSeries, uniform_azimuths_rad};
use rotor_case::{Case, ControlActuator};
use serde::{Deserialize, Serialize};

/// What `J` is traded against.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Serialize, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FrontAgainst {
    /// Power that the actuators of one blade give.
    #[default]
    Power,
    /// Torsion at the root of the blade, which the pitch link holds.
    RootTorsion,
    /// Flap bending moment at the root of the blade.
    RootFlap,
}

impl FrontAgainst {
    /// All of them.
    pub const ALL: [Self; 3] = [Self::Power, Self::RootTorsion, Self::RootFlap];

    /// In words.
    pub fn name(self) -> &'static str {
        match self {
            Self::Power => "actuation power",
            Self::RootTorsion => "torsion at the root",
            Self::RootFlap => "flap moment at the root",
        }
    }

    /// Among the moments of the blade: flap, lag, torsion.
    fn moment(self) -> Option<usize> {
        match self {
            Self::Power => None,
            Self::RootTorsion => Some(TORSION),
            Self::RootFlap => Some(FLAP),
        }
    }
}

const FLAP: usize = 0;
const TORSION: usize = 2;
/// Rounding of a ratio that is 1.
const AS_WITHOUT_CONTROL: f64 = 1e-9;
/// Azimuths of the peak-to-peak loads of a point.
const AZIMUTHS: usize = 360;

/// The front of one set of harmonics against one cost.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct FrontLine {
    /// Harmonics per rev.
    pub harmonics: Vec<usize>,
    /// The cost.
    pub against: FrontAgainst,
    /// Without control.
    pub at_rest: FrontState,
    /// From the least cost to the least `J`; empty where it failed.
    pub points: Vec<FrontState>,
    /// Why there is none.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub failure: Option<String>,
}

/// One point of a front, of the linearised rotor.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct FrontState {
    /// Voltages, flap by flap, harmonic by harmonic, cosine then sine, V.
    #[serde(rename = "control_V")]
    pub control_volt: Vec<f64>,
    /// `J / J0`.
    pub cost_ratio: f64,
    /// The cost: power by (C.13), W, or root mean square about the mean of the load, N m.
    pub second: f64,
    /// Power that the actuators of one blade give to the whole motion, none taken back, W.
    #[serde(rename = "given_W")]
    pub given_watt: f64,
    /// Half the peak-to-peak flap moment and torsion at the root of the blade, N m.
    #[serde(rename = "half_peak_to_peak_N_m")]
    pub half_peak_to_peak_newton_metre: [f64; 2],
    /// Largest KKT residual of the cone program behind it; 0 without control.
    pub kkt: f64,
}

impl FrontLine {
    /// The points that leave no more vibration than no control does.
    pub fn useful(&self) -> impl Iterator<Item = &FrontState> {
        self.points.iter().filter(|state| state.cost_ratio <= 1.0 + AS_WITHOUT_CONTROL)
    }
}

/// The fronts of every set of a case: against power, torsion and flap moment at the root; none without flaps.
///
/// A front that cannot be had, as of a rotor that stalls and has no linear answer, says why.
pub fn fronts(case: &Case, rotor: &TrimmedRotor, drives: &Drives) -> Vec<FrontLine> {
    let sets = &case.control.harmonics;
    let baseline = rotor.trim().rotor.hub.harmonic(case.rotor.blades);
    if case.flaps.is_empty() || rotor.wake_diverged() || is_still(&baseline) {
        return Vec::new();
    }
    // made once, before the sets that share it run side by side; a failure is that of every set
    let _ = rotor.authority();
    let of = |harmonics: &Vec<usize>| {
        let found = ControlSet::new(case, rotor, drives, harmonics).and_then(|set| set.fronts());
        found.unwrap_or_else(|error| {
            let failed = |against| FrontLine {
                harmonics: harmonics.clone(),
                against,
                failure: Some(error.to_string()),
                ..FrontLine::default()
            };
            FrontAgainst::ALL.map(failed).into()
        })
    };
    sets.par_iter().map(of).collect::<Vec<_>>().concat()
}

/// The linear model of one set behind its fronts.
struct Linear<'a> {
    rotor: &'a TrimmedRotor,
    plant: RotorPlant,
    law: FeedbackLaw,
    limits: ControlLimits,
    load_weights: [f64; 6],
    baseline: [f64; HUB_OUTPUTS],
    /// Flap and motion per V of every control, deg.
    motions: Vec<(usize, HarmonicSeries)>,
    /// Moments at the root without control, and their change with every control; N m.
    rest: [HarmonicSeries; 3],
    along: Vec<[HarmonicSeries; 3]>,
    /// Power of every pair, W per `V^2`.
    watt_per_volt2: Vec<f64>,
}

impl ControlSet<'_> {
    fn fronts(&self) -> Result<Vec<FrontLine>, StudyError> {
        let actuator = match self.drives.hysteretic {
            Some(_) => ControlActuator::Hysteretic,
            None => ControlActuator::Ideal,
        };
        if self.harmonics.iter().any(|n| *n > HARMONICS) {
            let failure = format!("the rotor is linearised for flaps up to {HARMONICS} per rev");
            let line = |against| FrontLine {
                harmonics: self.harmonics.to_vec(),
                against,
                failure: Some(failure.clone()),
                ..FrontLine::default()
            };
            return Ok(FrontAgainst::ALL.into_iter().map(line).collect());
        }
        let failed = |error| self.failed(actuator, error);
        let linear = self.linear(self.plant(actuator)?).map_err(failed)?;
        FrontAgainst::ALL
            .into_iter()
            .map(|against| linear.front(self.harmonics, against).map_err(failed))
            .collect()
    }

    fn linear(&self, mut plant: RotorPlant) -> Result<Linear<'_>, RunError<PlantError>> {
        let failed = |source: PlantError| RunError::plant("linearised", &[])(source);
        let authority = self.rotor.authority().map_err(|e| failed(e.into()))?;
        let zero = plant.layout().zero();
        let limits = plant.limits(&zero).map_err(failed)?;
        let layout = plant.layout().clone();
        let unit = self.rotor.scales().moment_newton_metre();
        let station = self.case.rotor.root_offset_r;
        let pairs: Vec<(usize, usize, [f64; 2])> = (0..layout.pairs())
            .filter_map(|pair| layout.flap_and_harmonic(pair))
            .enumerate()
            .map(|(pair, (flap, n))| {
                let full = &self.limits[pair % self.limits.len()];
                (flap, n as usize, full.motion_deg.map(|deg| deg / full.amplitude_volt))
            })
            .collect();
        // the answer to a sine is that to a cosine a quarter later
        let motions: Vec<(usize, HarmonicSeries)> = pairs
            .iter()
            .flat_map(|&(flap, n, [c, s])| {
                [[c, s], [-s, c]].map(|[cosine, sine]| {
                    let mut motion = HarmonicSeries::zero(0);
                    motion.set_harmonic(n, Harmonic { cosine, sine });
                    (flap, motion)
                })
            })
            .collect();
        let columns: Vec<Vec<f64>> =
            motions.iter().map(|(flap, along)| authority.loads(*flap, along).to_vec()).collect();
        let t = TMatrix::from_columns(&columns)?;
        let load_weights = self.load_weights();
        let law = FeedbackLaw::new(&t, &output_weights(&load_weights, HUB_OUTPUTS))?;
        let in_units =
            |[a, b, c]: [HarmonicSeries; 3]| [a, b, c].map(|series| scaled(&series, unit));
        let along = motions
            .par_iter()
            .map(|(flap, motion)| {
                let found = self.rotor.moments_along((*flap, motion), station);
                found.map(in_units).map_err(|e| failed(e.into()))
            })
            .collect::<Result<Vec<_>, _>>()?;
        let rest = self.rotor.station_loads(&[station]).map_err(|e| failed(e.into()))?;
        let rest = rest.into_iter().next().map(|at| at.moments.harmonics);
        let watts = watt_per_deg2(&layout, authority, self.rotor.scales());
        Ok(Linear {
            rotor: self.rotor,
            law,
            limits,
            load_weights,
            baseline: self.rotor.trim().rotor.hub.harmonic(self.case.rotor.blades),
            rest: in_units(
                rest.unwrap_or_else(|| std::array::from_fn(|_| HarmonicSeries::zero(0))),
            ),
            along,
            watt_per_volt2: watts
                .iter()
                .zip(&pairs)
                .map(|(watt, (_, _, [c, s]))| watt * (c * c + s * s))
                .collect(),
            motions,
            plant,
        })
    }
}

impl Linear<'_> {
    fn front(
        &self,
        harmonics: &[usize],
        against: FrontAgainst,
    ) -> Result<FrontLine, RunError<PlantError>> {
        let zero = self.plant.layout().zero();
        let second = self.second(against)?;
        let rest = FrontPoint {
            loads_cost: loads_cost(&self.load_weights, &self.baseline),
            second_cost: second.at(&zero)?,
            weight: 0.0,
            kkt: 0.0,
            control_volt: zero,
        };
        let found = self.law.front(&self.baseline, &second, &self.limits);
        let (points, failure) = match found {
            Ok(points) => (points, None),
            Err(error) => (Vec::new(), Some(error.to_string())),
        };
        let state = |point: &FrontPoint| self.state(point, against, rest.loads_cost);
        Ok(FrontLine {
            harmonics: harmonics.to_vec(),
            against,
            at_rest: state(&rest)?,
            points: points.iter().map(state).collect::<Result<_, RunError<PlantError>>>()?,
            failure,
        })
    }

    /// The second cost: weighted harmonics of the voltage, or harmonics of a load.
    fn second(&self, against: FrontAgainst) -> Result<SecondCost, ControlError> {
        let controls = self.motions.len();
        let Some(moment) = against.moment() else {
            let column = |control: usize| {
                let mut column = vec![0.0; controls];
                column[control] = self.watt_per_volt2[control / 2].sqrt();
                column
            };
            let columns: Vec<Vec<f64>> = (0..controls).map(column).collect();
            return Ok(SecondCost {
                at_rest: vec![0.0; controls],
                t: TMatrix::from_columns(&columns)?,
            });
        };
        let count = self.rest[moment].harmonics.len();
        let parts = |series: &HarmonicSeries| coefficients(series, count).skip(1).collect();
        let columns: Vec<Vec<f64>> = self.along.iter().map(|along| parts(&along[moment])).collect();
        Ok(SecondCost { at_rest: parts(&self.rest[moment]), t: TMatrix::from_columns(&columns)? })
    }

    fn state(
        &self,
        point: &FrontPoint,
        against: FrontAgainst,
        before: f64,
    ) -> Result<FrontState, RunError<PlantError>> {
        let mut flaps = vec![HarmonicSeries::zero(0); self.plant.layout().flaps()];
        let mut moments = self.rest.clone();
        let each = point.control_volt.iter().zip(self.motions.iter().zip(&self.along));
        for (volt, ((flap, motion), along)) in each {
            flaps[*flap] = added(&flaps[*flap], motion, *volt);
            for (moment, part) in moments.iter_mut().zip(along) {
                *moment = added(moment, part, *volt);
            }
        }
        let motions: Vec<&HarmonicSeries> = flaps.iter().collect();
        let given_watt = self.rotor.linear_power_watt(&motions);
        let half = |k: usize| half_peak_to_peak(&moments[k]);
        Ok(FrontState {
            control_volt: point.control_volt.clone(),
            cost_ratio: point.loads_cost / before,
            second: match against {
                FrontAgainst::Power => point.second_cost,
                FrontAgainst::RootTorsion | FrontAgainst::RootFlap => {
                    (0.5 * point.second_cost).sqrt()
                }
            },
            given_watt: given_watt
                .map_err(|e| RunError::plant("linearised", &point.control_volt)(e.into()))?,
            half_peak_to_peak_newton_metre: [half(FLAP), half(TORSION)],
            kkt: point.kkt,
        })
    }
}

fn half_peak_to_peak(series: &HarmonicSeries) -> f64 {
    let values = uniform_azimuths_rad(AZIMUTHS).into_iter().map(|psi| series.value(psi));
    let [low, high] = values.fold([f64::INFINITY, f64::NEG_INFINITY], |[low, high], value| {
        [low.min(value), high.max(value)]
    });
    0.5 * (high - low)
}
