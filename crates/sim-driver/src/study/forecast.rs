//! What the linearised rotor says of a set of harmonics before any control.

use super::run::{ControlSet, LEAST_EFFORT};
use super::{Drives, FlapDrive, PlantError, StudyError, TrimmedRotor};
use crate::case::{Case, ControlActuator};
use crate::results::Forecast;
use hhc_control::{
    FeedbackLaw, LoadWeights, Plant, PlantCall, RunError, TMatrix, lag_deg, lag_loss,
};
use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries};

/// The forecasts of every set of the case; none where no identified actuator is controlled.
///
/// # Errors
/// [`StudyError`] of the first set that fails.
pub fn forecasts(
    case: &Case,
    rotor: &TrimmedRotor,
    drives: &Drives,
) -> Result<Vec<Forecast>, StudyError> {
    if drives.hysteretic.is_none() || case.control.harmonics.is_empty() {
        return Ok(Vec::new());
    }
    // made once before the sets run side by side; a rotor that has none has no forecast either
    if rotor.authority().is_err() {
        return Ok(Vec::new());
    }
    let sets = case.control.harmonics.par_iter();
    sets.map(|harmonics| ControlSet::new(case, rotor, drives, harmonics)?.forecast()).collect()
}

/// A small motion of a flap per V: voltage, gain in deg/V and lag in rad.
struct HarmonicGain {
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
            gain_deg_per_volt: flap.amplitude() / amplitude_volt,
            lag_rad: lag_deg(voltage, flap).to_radians(),
        })
    }
}

impl ControlSet<'_> {
    /// See [`Forecast`].
    fn forecast(&self) -> Result<Forecast, StudyError> {
        let plant_failed = |source: PlantError| {
            let call = PlantCall::Linearise { control_volt: Vec::new() };
            self.failed(
                ControlActuator::Ideal,
                RunError::Plant { call, history: Vec::new(), source },
            )
        };
        let control_failed = |error| self.failed(ControlActuator::Ideal, RunError::Control(error));
        let mut ideal = self.plant(ControlActuator::Ideal)?;
        let zero = ideal.layout().zero();
        let Some(t) = ideal.linearised_t(&zero).map_err(plant_failed)? else {
            return Ok(Forecast { harmonics: self.harmonics.to_vec(), ..Forecast::default() });
        };
        let baseline = self.rotor.trim().rotor.hub.harmonic(self.case.blades);
        let weights: Vec<f64> = self.load_weights().into_iter().flat_map(|w| [w, w]).collect();
        // the loads alone: what weighs the power beside them is no load
        let columns: Vec<Vec<f64>> =
            t.columns().into_iter().map(|column| column[..baseline.len()].to_vec()).collect();
        let t = TMatrix::from_columns(&columns).map_err(control_failed)?;
        let weights = LoadWeights::Diagonal(weights);
        let law = FeedbackLaw::new(&t, &weights).map_err(control_failed)?;
        let surplus = t.controls() > t.loads();
        let scale = law.singular_values().first().map_or(0.0, |s| s * s);
        let rho = if surplus { LEAST_EFFORT * scale } else { 0.0 };
        let free = law.optimum_volt(rho, &zero, &baseline).map_err(control_failed)?;
        let limits = ideal.limits(&zero).map_err(plant_failed)?;
        let cone = law.optimum_within(rho, &zero, &baseline, &limits).map_err(control_failed)?;
        let clipped = self.clipped(&free);
        let cost = |u: &[f64]| -> Result<f64, StudyError> {
            let change = t.loads_for(u).map_err(control_failed)?;
            let pairs = law.load_weights().iter().zip(baseline.iter().zip(change));
            Ok(pairs.map(|(w, (z, dz))| w * (z + dz) * (z + dz)).sum())
        };
        let before = cost(&zero)?;

        let drive = self.drives.hysteretic.as_ref().unwrap_or(&self.drives.ideal);
        let gains = |amplitude: &dyn Fn(usize) -> f64| {
            let each = self.harmonics.iter().enumerate();
            each.map(|(k, &n)| HarmonicGain::of(drive, n, amplitude(k)))
                .collect::<Result<Vec<_>, PlantError>>()
        };
        let at_stroke = gains(&|k| self.limits[k].amplitude_volt).map_err(plant_failed)?;
        let at_step = gains(&|_| self.step_volt()).map_err(plant_failed)?;
        let pairs = ideal.layout().pairs();
        let lags: Vec<f64> =
            (0..pairs).map(|pair| at_stroke[pair % at_stroke.len()].lag_rad).collect();
        let loss = lag_loss(&t, &weights, &free, &lags).map_err(control_failed)?;
        let dynamic = self.dynamic_t(drive).map_err(plant_failed)?;
        let apart = |gains: &[HarmonicGain]| -> Result<f64, StudyError> {
            let simple = self.gain_t(gains).map_err(plant_failed)?;
            Ok(100.0 * simple.relative_difference(&dynamic).map_err(control_failed)?)
        };
        Ok(Forecast {
            harmonics: self.harmonics.to_vec(),
            lag_deg: at_stroke.iter().map(|gain| gain.lag_rad.to_degrees()).collect(),
            lag_loss_percent: 100.0 * loss.part,
            isotropic_loss_percent: 100.0 * loss.isotropic,
            cone: cost(&cone.control_volt)? / before,
            clipped: cost(&clipped)? / before,
            free: cost(&free)? / before,
            gain_at_step_percent: apart(&at_step)?,
            gain_at_stroke_percent: apart(&at_stroke)?,
        })
    }

    /// Every harmonic cut to its stroke, its phase kept: what is not done.
    fn clipped(&self, control_volt: &[f64]) -> Vec<f64> {
        let per_deg = self.case.control.amplitude_volt / self.case.actuator.ideal_amplitude_deg;
        let pairs = control_volt.chunks_exact(2).enumerate();
        pairs
            .flat_map(|(pair, u)| {
                let limit = self.limits[pair % self.limits.len()].stroke_deg * per_deg;
                let part = (limit / u[0].hypot(u[1])).min(1.0);
                [part * u[0], part * u[1]]
            })
            .collect()
    }

    /// T of the linearised rotor with a harmonic gain for the actuator, load per V.
    fn gain_t(&self, gains: &[HarmonicGain]) -> Result<TMatrix, PlantError> {
        self.t_of(|n, quadrature, k| {
            let HarmonicGain { gain_deg_per_volt, lag_rad } = gains[k];
            let phase = if quadrature { std::f64::consts::FRAC_PI_2 } else { 0.0 };
            let mut motion = HarmonicSeries::zero(n);
            motion.set_harmonic(
                n,
                Harmonic::from_amplitude_phase(gain_deg_per_volt, phase + lag_rad),
            );
            Ok(motion)
        })
    }

    /// The same with the full model of the actuator, every harmonic that it makes, by central differences of
    /// the step of T.
    fn dynamic_t(&self, drive: &FlapDrive) -> Result<TMatrix, PlantError> {
        let step_volt = self.step_volt();
        self.t_of(|n, quadrature, _| {
            let moved = |volt: f64| {
                let (cosine, sine) = if quadrature { (0.0, volt) } else { (volt, 0.0) };
                drive.motion(&[(n, Harmonic { cosine, sine })]).map(|motion| motion.flap_deg)
            };
            let (up, down) = (moved(step_volt)?, moved(-step_volt)?);
            Ok(super::drive::weighted(&up, &down, 0.5 / step_volt))
        })
    }

    /// T from the flap motion per V of a harmonic's cosine and sine, the flaps alike; the harmonic is given
    /// with its place in the set.
    fn t_of(
        &self,
        motion: impl Fn(usize, bool, usize) -> Result<HarmonicSeries, PlantError>,
    ) -> Result<TMatrix, PlantError> {
        let authority = self.rotor.authority()?;
        let mut motions = Vec::with_capacity(2 * self.harmonics.len());
        for (k, &n) in self.harmonics.iter().enumerate() {
            motions.extend([motion(n, false, k)?, motion(n, true, k)?]);
        }
        let flaps = self.rotor.rotor().model().flaps.len();
        let columns: Vec<Vec<f64>> = (0..flaps)
            .flat_map(|flap| motions.iter().map(move |along| (flap, along)))
            .map(|(flap, along)| authority.loads(flap, along).to_vec())
            .collect();
        TMatrix::from_columns(&columns).map_err(PlantError::Bias)
    }
}
