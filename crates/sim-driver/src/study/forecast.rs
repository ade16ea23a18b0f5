//! What the linearised rotor says of a set of harmonics before any control.

use super::run::{ControlSet, LEAST_EFFORT};
use super::{Drives, FlapAuthority, FlapDrive, PlantError, StudyError, TrimmedRotor};
use crate::case::{Case, ControlActuator, TInflowChoice};
use crate::raw::{ForecastRecord, Setting};
use crate::results::{Forecast, HubLoads};
use hhc_control::{FeedbackLaw, LoadWeights, Plant, PlantCall, RunError, TMatrix, lag_deg};
use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_response::{InflowState, ResponseError};

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
        let t = ideal.t_about_trim(&zero).map_err(plant_failed)?;
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
        let limits = ideal.limits(&zero).map_err(plant_failed)?;
        let cone = law.optimum_within(rho, &zero, &baseline, &limits).map_err(control_failed)?;

        let responded = |source: ResponseError| plant_failed(source.into());
        let settled = self.rotor.linearised(InflowState::Settled).map_err(responded)?;
        let frozen = self.rotor.linearised(InflowState::Frozen).map_err(responded)?;
        let reconverged = match self.case.control.t_inflow {
            TInflowChoice::Reconverged => self.rotor.reconverged().map_err(responded)?,
            _ => None,
        };
        let drive = self.drives.hysteretic.as_ref().unwrap_or(&self.drives.ideal);
        let gains = |amplitude: &dyn Fn(usize) -> f64| {
            let each = self.harmonics.iter().enumerate();
            each.map(|(k, &n)| HarmonicGain::of(drive, n, amplitude(k)))
                .collect::<Result<Vec<_>, PlantError>>()
        };
        let at_stroke = gains(&|k| self.limits[k].amplitude_volt).map_err(plant_failed)?;
        let at_step = gains(&|_| self.step_volt()).map_err(plant_failed)?;
        let dynamic = self.dynamic_t(drive).map_err(plant_failed)?;
        let per_deg = self.case.control.amplitude_volt / self.case.actuator.ideal_amplitude_deg;
        let forecast = Forecast {
            harmonics: self.harmonics.to_vec(),
            record: ForecastRecord {
                t_per_volt: columns,
                settled_t_per_volt: self.ideal_t(&settled),
                frozen_t_per_volt: self.ideal_t(&frozen),
                reconverged_t_per_volt: reconverged
                    .map(|found| self.ideal_t(&found.authority))
                    .unwrap_or_default(),
                wake_updates: reconverged.map(|found| found.updates),
                wake_change: reconverged.map(|found| found.change),
                rho_per_volt2: rho,
                cone_volt: cone.control_volt,
                stroke_volt: self.limits.iter().map(|l| l.stroke_deg * per_deg).collect(),
                at_stroke_deg: at_stroke
                    .iter()
                    .map(|gain| [gain.flap_deg.cosine, gain.flap_deg.sine])
                    .collect(),
                dynamic_t_per_volt: dynamic.columns(),
                gain_t_at_step_per_volt: self.gain_t(&at_step).map_err(plant_failed)?.columns(),
                gain_t_at_stroke_per_volt: self.gain_t(&at_stroke).map_err(plant_failed)?.columns(),
            },
            ..Forecast::default()
        };
        Ok(forecast.refigured(&Setting::of_case(self.case, &HubLoads::from_parts(baseline))))
    }

    /// T of the ideal actuator from what the flaps do to the hub, column by column, load per V.
    fn ideal_t(&self, authority: &FlapAuthority) -> Vec<Vec<f64>> {
        let gain = self.case.actuator.ideal_amplitude_deg / self.case.control.amplitude_volt;
        let flaps = self.rotor.rotor().model().flaps.len();
        let pairs = (0..flaps).flat_map(|flap| self.harmonics.iter().map(move |&n| (flap, n)));
        pairs
            .flat_map(|(flap, n)| [(flap, n, gain, 0.0), (flap, n, 0.0, gain)])
            .map(|(flap, n, cosine, sine)| {
                let mut motion = HarmonicSeries::zero(n);
                motion.set_harmonic(n, Harmonic { cosine, sine });
                authority.loads(flap, &motion).to_vec()
            })
            .collect()
    }

    /// T of the linearised rotor with a harmonic gain for the actuator, load per V.
    fn gain_t(&self, gains: &[HarmonicGain]) -> Result<TMatrix, PlantError> {
        self.t_of(|n, quadrature, k| {
            let HarmonicGain { gain_deg_per_volt, lag_rad, .. } = gains[k];
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
