//! What the linearised rotor says of a set of harmonics before any control.

use crate::control::drives::Drives;
use crate::control::set::{ControlSet, least_effort};
use crate::error::StudyError;
use crate::flaps::{FlapDrive, PlantError};
use crate::loads::Setting;
use crate::plant::{HUB_OUTPUTS, RotorPlant, output_weights};
use crate::rotor::{FlapAuthority, TrimmedRotor};
use hhc_control::{FeedbackLaw, LoadWeights, Plant, RunError, TMatrix, lag_deg, lag_loss};
use rayon::prelude::*;
use rotor_base::series::{only, place, weighted};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_case::{Case, ControlActuator, TInflowChoice};
use rotor_response::{InflowState, ResponseError};
use serde::{Deserialize, Serialize};

/// What the linearised rotor says of one set of harmonics before any control: what a lag that is ignored
/// costs, what clipping to the stroke costs, and what a harmonic gain in place of the actuator misses.
#[derive(Debug, Clone, PartialEq, Default, Serialize)]
pub struct Forecast {
    /// Harmonics per rev.
    pub harmonics: Vec<usize>,
    /// Lag of the actuator at the stroke limit of each harmonic, deg.
    pub lag_deg: Vec<f64>,
    /// Part of the attainable fall of `J` that is lost where these lags are ignored, limits lifted, percent:
    /// `|T (R - I) u*|^2 / |T u*|^2`.
    pub lag_loss_percent: f64,
    /// `4 sin^2(lag/2)` of the largest lag, percent: the same if T acts alike on all controls.
    pub isotropic_loss_percent: f64,
    /// `J/J0` of the cone program's optimum within the limits, ideal actuator.
    pub cone: f64,
    /// `J/J0` of the free optimum with every harmonic clipped to its stroke circle.
    pub clipped: f64,
    /// `J/J0` of the free optimum, no limits.
    pub free: f64,
    /// Distance of T with the actuator as a harmonic gain from T with the full dynamic model, both at the step
    /// of T, over the latter, percent: what the harmonics that the actuator adds do to the hub.
    pub gain_at_step_percent: f64,
    /// The same with the gain at the stroke limit: what amplitude does to gain and lag.
    pub gain_at_stroke_percent: f64,
    /// Distance of T with the wake frozen from T with the inflow settled on the moved loading, over the latter,
    /// percent.
    pub frozen_percent: f64,
    /// The same of T with the geometry of the free wake converged anew; where the case asks for it.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub reconverged_percent: Option<f64>,
}

/// What a forecast of one set of harmonics is computed from.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ForecastLine {
    /// Harmonics per rev.
    pub harmonics: Vec<usize>,
    /// Matrices and controls.
    #[serde(default)]
    pub record: ForecastRecord,
}

/// What a forecast is computed from, beside the loads without control.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct ForecastRecord {
    /// T of the linearised rotor with the ideal actuator, column by column, load per V.
    #[serde(rename = "t_per_V")]
    pub t_per_volt: Vec<Vec<f64>>,
    /// The same with the inflow settled on the moved loading, the geometry of a free wake held.
    #[serde(rename = "settled_t_per_V", default)]
    pub settled_t_per_volt: Vec<Vec<f64>>,
    /// The same with the inflow as in trim.
    #[serde(rename = "frozen_t_per_V", default)]
    pub frozen_t_per_volt: Vec<Vec<f64>>,
    /// The same with the geometry of the free wake converged anew; empty unless asked for.
    #[serde(rename = "reconverged_t_per_V", default, skip_serializing_if = "Vec::is_empty")]
    pub reconverged_t_per_volt: Vec<Vec<f64>>,
    /// Updates of the wake that the slowest of its differences took.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wake_updates: Option<usize>,
    /// Largest change of one of them in its last update, over its size.
    #[serde(default, skip_serializing_if = "Option::is_none")]
    pub wake_change: Option<f64>,
    /// Control weight that picks the least voltage among equals, 1/V^2.
    #[serde(rename = "rho_per_V2")]
    pub rho_per_volt2: f64,
    /// The optimum within the limits, V.
    #[serde(rename = "cone_V")]
    pub cone_volt: Vec<f64>,
    /// Stroke circle of each harmonic in volts of the ideal actuator.
    #[serde(rename = "stroke_V")]
    pub stroke_volt: Vec<f64>,
    /// Flap motion at each harmonic for a cosine of the voltage of its stroke limit, `[cosine, sine]`, deg.
    pub at_stroke_deg: Vec<[f64; 2]>,
    /// T with the full actuator model, both flaps alike, column by column, load per V.
    #[serde(rename = "dynamic_t_per_V")]
    pub dynamic_t_per_volt: Vec<Vec<f64>>,
    /// The same with a harmonic gain at the step of T.
    #[serde(rename = "gain_t_at_step_per_V")]
    pub gain_t_at_step_per_volt: Vec<Vec<f64>>,
    /// The same with a harmonic gain at the stroke limit.
    #[serde(rename = "gain_t_at_stroke_per_V")]
    pub gain_t_at_stroke_per_volt: Vec<Vec<f64>>,
}

/// The forecasts of every set of the case; none where no identified actuator is controlled.
///
/// # Errors
/// [`StudyError`] of the first set that fails.
pub fn forecasts(
    case: &Case,
    rotor: &TrimmedRotor,
    drives: &Drives,
) -> Result<Vec<ForecastLine>, StudyError> {
    if drives.hysteretic.is_none() || case.control.harmonics.is_empty() {
        return Ok(Vec::new());
    }
    // made once, before the sets that share it run side by side; a rotor without authority has no forecast either
    let states = [InflowState::Settled, InflowState::Frozen];
    if states.iter().any(|&state| rotor.linearised(state).is_err()) {
        return Ok(Vec::new());
    }
    let sets = case.control.harmonics.par_iter();
    sets.map(|harmonics| ControlSet::new(case, rotor, drives, harmonics)?.forecast()).collect()
}

/// A small motion of a flap per V: voltage, gain in deg/V and lag in rad.
struct HarmonicGain {
    /// Motion for a cosine of the voltage.
    flap_deg: Harmonic,
    gain_deg_per_volt: f64,
    lag_rad: f64,
}

impl HarmonicGain {
    /// Of a drive at one harmonic and amplitude.
    fn of(drive: &FlapDrive, harmonic: usize, amplitude_volt: f64) -> Result<Self, PlantError> {
        let voltage = Harmonic { cosine: amplitude_volt, sine: 0.0 };
        let motion = drive.motion(&[(harmonic, voltage)])?;
        let flap = motion.flap_deg.harmonic(harmonic);
        Ok(Self {
            flap_deg: flap,
            gain_deg_per_volt: flap.amplitude() / amplitude_volt,
            lag_rad: lag_deg(voltage, flap).to_radians(),
        })
    }
}

impl ControlSet<'_> {
    /// See [`Forecast`].
    fn forecast(&self) -> Result<ForecastLine, StudyError> {
        let ideal = self.plant(ControlActuator::Ideal)?;
        let record = self.record(ideal).map_err(|e| self.failed(ControlActuator::Ideal, e))?;
        Ok(ForecastLine { harmonics: self.harmonics.to_vec(), record })
    }

    fn record(&self, mut ideal: RotorPlant) -> Result<ForecastRecord, RunError<PlantError>> {
        let failed = |source: PlantError| RunError::plant("linearised", &[])(source);
        let responded = |source: ResponseError| failed(source.into());
        let zero = ideal.layout().zero();
        let t = ideal.t_about_trim(&zero).map_err(failed)?;
        // the loads alone: what weighs the power beside them is no load
        let columns: Vec<Vec<f64>> =
            t.columns().into_iter().map(|column| column[..HUB_OUTPUTS].to_vec()).collect();
        let t = TMatrix::from_columns(&columns)?;
        let law = FeedbackLaw::new(&t, &output_weights(&self.load_weights(), HUB_OUTPUTS))?;
        let rho = least_effort(&law);
        let limits = ideal.limits(&zero).map_err(failed)?;
        let baseline = self.rotor.trim().rotor.hub.harmonic(self.case.rotor.blades);
        let cone = law.optimum_within(rho, &zero, &baseline, &limits)?;

        let settled = self.rotor.linearised(InflowState::Settled).map_err(responded)?;
        let frozen = self.rotor.linearised(InflowState::Frozen).map_err(responded)?;
        let reconverged = match self.case.control.t_inflow {
            TInflowChoice::Reconverged => self.rotor.reconverged().map_err(responded)?,
            _ => None,
        };
        let ideal_t = |authority: &FlapAuthority| {
            let gain = self.case.actuator.ideal_amplitude_deg / self.case.control.amplitude_volt;
            let found = self.t_of(authority, |n, sine, _| Ok(only(place(n, sine), gain)));
            found.map_err(failed)
        };
        let drive = self.drives.hysteretic.as_ref().unwrap_or(&self.drives.ideal);
        let gains = |amplitude: &dyn Fn(usize) -> f64| {
            let each = self.harmonics.iter().enumerate();
            each.map(|(k, &n)| HarmonicGain::of(drive, n, amplitude(k)))
                .collect::<Result<Vec<_>, PlantError>>()
        };
        let at_stroke = gains(&|k| self.limits[k].amplitude_volt).map_err(failed)?;
        let at_step = gains(&|_| self.step_volt()).map_err(failed)?;
        let per_deg = self.case.control.amplitude_volt / self.case.actuator.ideal_amplitude_deg;
        Ok(ForecastRecord {
            t_per_volt: columns,
            settled_t_per_volt: ideal_t(settled)?,
            frozen_t_per_volt: ideal_t(frozen)?,
            reconverged_t_per_volt: match reconverged {
                Some(found) => ideal_t(&found.authority)?,
                None => Vec::new(),
            },
            wake_updates: reconverged.map(|found| found.updates),
            wake_change: reconverged.map(|found| found.change),
            rho_per_volt2: rho,
            cone_volt: cone.control_volt,
            stroke_volt: self.limits.iter().map(|l| l.stroke_deg * per_deg).collect(),
            at_stroke_deg: at_stroke
                .iter()
                .map(|gain| [gain.flap_deg.cosine, gain.flap_deg.sine])
                .collect(),
            dynamic_t_per_volt: self.dynamic_t(drive).map_err(failed)?,
            gain_t_at_step_per_volt: self.gain_t(&at_step).map_err(failed)?,
            gain_t_at_stroke_per_volt: self.gain_t(&at_stroke).map_err(failed)?,
        })
    }

    /// T of the linearised rotor with a harmonic gain for the actuator, load per V.
    fn gain_t(&self, gains: &[HarmonicGain]) -> Result<Vec<Vec<f64>>, PlantError> {
        self.t_of(self.rotor.authority()?, |n, sine, k| {
            let HarmonicGain { gain_deg_per_volt, lag_rad, .. } = gains[k];
            let phase = if sine { std::f64::consts::FRAC_PI_2 } else { 0.0 };
            let harmonic = Harmonic::from_amplitude_phase(gain_deg_per_volt, phase + lag_rad);
            let mut motion = HarmonicSeries::zero(n);
            motion.set_harmonic(n, harmonic);
            Ok(motion)
        })
    }

    /// The same with the full model of the actuator, every harmonic that it makes, by central differences of
    /// the step of T.
    fn dynamic_t(&self, drive: &FlapDrive) -> Result<Vec<Vec<f64>>, PlantError> {
        let step_volt = self.step_volt();
        self.t_of(self.rotor.authority()?, |n, sine, _| {
            let moved = |volt: f64| {
                let voltage = only(place(n, sine), volt).harmonic(n);
                drive.motion(&[(n, voltage)]).map(|motion| motion.flap_deg)
            };
            Ok(weighted(&moved(step_volt)?, &moved(-step_volt)?, 0.5 / step_volt))
        })
    }

    /// T from what the flaps do to the hub and the flap motion per V of a harmonic's cosine and sine, the flaps
    /// alike, column by column, load per V; the harmonic is given with its place in the set.
    fn t_of(
        &self,
        authority: &FlapAuthority,
        motion: impl Fn(usize, bool, usize) -> Result<HarmonicSeries, PlantError>,
    ) -> Result<Vec<Vec<f64>>, PlantError> {
        let each = self.harmonics.iter().enumerate();
        let motions = each
            .flat_map(|(k, &n)| [false, true].map(|sine| motion(n, sine, k)))
            .collect::<Result<Vec<_>, PlantError>>()?;
        let columns: Vec<Vec<f64>> = (0..self.rotor.rotor().model().flaps.len())
            .flat_map(|flap| motions.iter().map(move |along| authority.loads(flap, along).to_vec()))
            .collect();
        Ok(TMatrix::from_columns(&columns).map_err(PlantError::Bias)?.columns())
    }
}

impl ForecastLine {
    /// What the linearised rotor says; numbers that do not fit together give NaN.
    pub fn figures(&self, setting: &Setting) -> Forecast {
        self.computed(setting).unwrap_or_else(|| Forecast {
            harmonics: self.harmonics.clone(),
            lag_loss_percent: f64::NAN,
            cone: f64::NAN,
            clipped: f64::NAN,
            free: f64::NAN,
            ..Forecast::default()
        })
    }

    fn computed(&self, setting: &Setting) -> Option<Forecast> {
        let record = &self.record;
        if record.t_per_volt.is_empty() {
            return Some(Forecast { harmonics: self.harmonics.clone(), ..Forecast::default() });
        }
        let t = TMatrix::from_columns(&record.t_per_volt).ok()?;
        let weights: Vec<f64> = setting.load_weights().into_iter().flat_map(|w| [w, w]).collect();
        let load_weights = LoadWeights::Diagonal(weights.clone());
        let law = FeedbackLaw::new(&t, &load_weights).ok()?;
        let zero = vec![0.0; t.controls()];
        let baseline = &setting.baseline;
        let free = law.optimum_volt(record.rho_per_volt2, &zero, baseline).ok()?;
        let clipped = clipped(&free, &record.stroke_volt);
        let cost = |u: &[f64]| -> Option<f64> {
            let change = t.loads_for(u).ok()?;
            let pairs = weights.iter().zip(baseline.iter().zip(change));
            Some(pairs.map(|(w, (z, dz))| w * (z + dz) * (z + dz)).sum())
        };
        let before = cost(&zero)?;
        let lags_rad: Vec<f64> = record
            .at_stroke_deg
            .iter()
            .map(|&[cosine, sine]| {
                let voltage = Harmonic { cosine: 1.0, sine: 0.0 };
                lag_deg(voltage, Harmonic { cosine, sine }).to_radians()
            })
            .collect();
        let of_pairs: Vec<f64> = lags_rad.iter().copied().cycle().take(t.controls() / 2).collect();
        let (dynamic, settled) = (&record.dynamic_t_per_volt, &record.settled_t_per_volt);
        let loss = lag_loss(&t, &load_weights, &free, &of_pairs).ok()?;
        Some(Forecast {
            harmonics: self.harmonics.clone(),
            lag_deg: lags_rad.iter().map(|lag| lag.to_degrees()).collect(),
            lag_loss_percent: 100.0 * loss.part,
            isotropic_loss_percent: 100.0 * loss.isotropic,
            cone: cost(&record.cone_volt)? / before,
            clipped: cost(&clipped)? / before,
            free: cost(&free)? / before,
            gain_at_step_percent: apart(dynamic, &record.gain_t_at_step_per_volt)?,
            gain_at_stroke_percent: apart(dynamic, &record.gain_t_at_stroke_per_volt)?,
            frozen_percent: apart(settled, &record.frozen_t_per_volt)?,
            reconverged_percent: match record.reconverged_t_per_volt.as_slice() {
                [] => None,
                reconverged => Some(apart(settled, reconverged)?),
            },
        })
    }
}

/// Distance of one T from another, over the latter, percent.
fn apart(from: &[Vec<f64>], other: &[Vec<f64>]) -> Option<f64> {
    let from = TMatrix::from_columns(from).ok()?;
    let other = TMatrix::from_columns(other).ok()?;
    Some(100.0 * other.relative_difference(&from).ok()?)
}

/// Every harmonic cut to its stroke, its phase kept: what is not done.
fn clipped(control_volt: &[f64], stroke_volt: &[f64]) -> Vec<f64> {
    let pairs = control_volt.chunks_exact(2).zip(stroke_volt.iter().cycle());
    pairs
        .flat_map(|(u, limit)| {
            let part = (limit / u[0].hypot(u[1])).min(1.0);
            [part * u[0], part * u[1]]
        })
        .collect()
}
