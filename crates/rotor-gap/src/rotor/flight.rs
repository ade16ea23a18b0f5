//! A rotor at a point of test: trimmed, its flaps driven, its channels read.

use crate::error::RotorGapError;
use crate::rotor::columns::{Load, PartOf, Reading};
use crate::rotor::model::{RotorModel, later};
use crate::rotor::sweep::{Sweep, SweepChannel, SweepPoint, instrumented};
use model_gap::points::{Channel, Grid};
use preisach_dyn::{ActuatorModel, VoltageRange};
use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries, RotorScales};
use rotor_case::{Case, PitchHarmonic, TrimValues};
use rotor_response::RotorSolution;
use rotor_study::{
    FlapDrive, PlantError, StudyError, TrimmedRotor, WakeStatus, scaled, wake_status,
};
use std::f64::consts::{PI, TAU};
use std::sync::Arc;

/// Tolerances of a point: effects are a part in a hundred of the loads.
const TRIM_TOLERANCE: f64 = 1e-6;
const PERIODICITY_TOLERANCE: f64 = 1e-8;
const INFLOW_TOLERANCE: f64 = 1e-7;
/// Why a rotor is not flown.
const NO_SOLUTION: &str = "wake and trim found no solution; `hhc run` says why and what may help";
/// Azimuths of airloads and tip motion.
const AZIMUTHS: usize = 72;
/// Lift slope that the Lock number of a case is defined with.
const LIFT_SLOPE: f64 = TAU;

/// What turns voltages into flap motion: of the case, and of an actuator with hysteresis beside it.
#[derive(Debug, Clone)]
pub(crate) struct Actuators {
    /// The drive of the case.
    pub(crate) own: FlapDrive,
    /// An actuator with hysteresis of the same stroke; none where the drive of the case has it already.
    pub(crate) hysteretic: Option<FlapDrive>,
}

impl Actuators {
    /// Of a case; `model` is its own actuator, `hysteretic` one that it may lack.
    pub(crate) fn of(
        case: &Case,
        model: Option<Arc<ActuatorModel>>,
        hysteretic: Option<Arc<ActuatorModel>>,
    ) -> Result<Self, StudyError> {
        let (low, high) = case.actuator.range_volt;
        let range_volt = VoltageRange::new(low, high).map_err(StudyError::Range)?;
        let (rev_hz, bias) = (case.actuator.bench_rev_hz, case.control.drive_bias());
        let bias_volt = bias.volt();
        let with = |model| FlapDrive::Model { model, range_volt, rev_hz, bias };
        let gain = case.actuator.ideal_amplitude_deg / case.control.amplitude_volt;
        let ideal = FlapDrive::Ideal { gain_deg_per_volt: gain, bias_volt, range_volt };
        let hysteretic = hysteretic.filter(|_| model.is_none()).map(with);
        Ok(Self { own: model.map_or(ideal, with), hysteretic })
    }

    /// Motion of a flap, deg.
    pub(crate) fn motion_deg(
        &self,
        model: &RotorModel,
        voltages: &[(usize, Harmonic)],
    ) -> Result<HarmonicSeries, PlantError> {
        let own = self.own.motion(voltages)?.flap_deg;
        let drive = model.drive;
        let mixed = match &self.hysteretic {
            Some(other) if drive.hysteresis != 0.0 => {
                let other = other.motion(voltages)?.flap_deg;
                let count = own.harmonics.len().max(other.harmonics.len());
                let one = |n: usize| {
                    let (a, b) = (own.harmonic(n), other.harmonic(n));
                    Harmonic {
                        cosine: drive.hysteresis.mul_add(b.cosine - a.cosine, a.cosine),
                        sine: drive.hysteresis.mul_add(b.sine - a.sine, a.sine),
                    }
                };
                HarmonicSeries { mean: own.mean, harmonics: (1..=count).map(one).collect() }
            }
            _ => own,
        };
        let volt = voltages.iter().map(|(_, own)| amplitude(*own).powi(2)).sum::<f64>().sqrt();
        let moved = |(k, own): (usize, &Harmonic)| {
            let (gain, late_rad) = drive.lagging(k + 1, volt);
            let own = later(*own, late_rad);
            Harmonic { cosine: gain * own.cosine, sine: gain * own.sine }
        };
        let harmonics = mixed.harmonics.iter().enumerate().map(moved).collect();
        Ok(HarmonicSeries { mean: drive.gain * mixed.mean, harmonics })
    }
}

/// Amplitude of a harmonic.
pub(crate) fn amplitude(own: Harmonic) -> f64 {
    own.cosine.hypot(own.sine)
}

/// The series of equal samples over the revolution.
fn resolved(values: &[f64]) -> HarmonicSeries {
    HarmonicSeries::from_uniform_samples(values, AZIMUTHS / 2 - 1).unwrap_or_default()
}

/// A rotor trimmed at a point, with its case there.
#[derive(Debug)]
struct Trimmed {
    case: Case,
    rotor: TrimmedRotor,
}

/// A rotor as flown at a point.
#[derive(Debug, Clone)]
pub(crate) struct Flown {
    trimmed: Arc<Trimmed>,
    /// The response with the flaps driven.
    response: RotorSolution,
    /// Motion of the flaps, deg.
    motions_deg: Vec<HarmonicSeries>,
    /// Hub loads, N and N m.
    hub: [HarmonicSeries; 6],
    scales: RotorScales,
}

/// The density that the Lock number of a case stands for, kg/m^3.
fn density_of(case: &Case) -> f64 {
    let r = &case.rotor;
    r.lock_number * r.mass_kg_m / (3.0 * LIFT_SLOPE * r.chord_r * r.radius_m * r.radius_m)
}

impl RotorModel {
    /// The case of a point: its condition with the true rotor speed and density.
    ///
    /// A thrust that was measured is a force: with another density or speed it is another coefficient. Stiffnesses of a case
    /// are over its own rotor speed.
    pub(crate) fn case_at(&self, point: &SweepPoint) -> Case {
        let mut case = self.case.clone();
        let stated_rpm = point.omega_rpm.unwrap_or(case.rotor.omega_rpm);
        let slower = case.rotor.omega_rpm / (stated_rpm * self.speed);
        let r = &mut case.rotor;
        r.stiffen(slower * slower);
        r.lag_damper *= slower;
        r.omega_rpm = stated_rpm * self.speed;
        let nominal = density_of(&self.case);
        let density = point.air_density.unwrap_or(nominal) * self.density;
        // the Lock number carries the lift slope too; drag and thrust are over the density alone
        r.lock_number *= self.lift_slope * density / nominal;
        case.aerodynamics.drag_coefficient /= self.lift_slope;
        case.advance_ratio = point.advance_ratio / self.speed;
        let force = |case: &Case, density: f64, rpm: f64| {
            let tip_m_s = rpm * TAU / 60.0 * case.rotor.radius_m;
            let solidity = case.rotor_model().solidity();
            solidity * density * PI * (case.rotor.radius_m * tip_m_s).powi(2)
        };
        let thrust = point
            .thrust_newton
            .map(|newton| newton / force(&case, density, stated_rpm * self.speed));
        let stated = point.ct_sigma.map(|own| own / (self.density * self.speed * self.speed));
        let loading = stated.or(thrust).map(|own| own / self.lift_slope);
        match &mut case.trim {
            TrimValues::Propulsive(own) => own.ct_sigma = loading.unwrap_or(own.ct_sigma),
            TrimValues::WindTunnel(own) => {
                own.ct_sigma = loading.unwrap_or(own.ct_sigma);
                own.shaft_tilt_deg = point.shaft_tilt_deg.unwrap_or(own.shaft_tilt_deg);
            }
            TrimValues::Prescribed(own) => {
                if let Some(controls) = point.controls_deg {
                    [own.theta0_deg, own.theta1c_deg, own.theta1s_deg] = controls;
                }
                // what is read is off: the true collective is less
                own.theta0_deg -= self.path.collective_deg;
                own.shaft_tilt_deg = point.shaft_tilt_deg.unwrap_or(own.shaft_tilt_deg);
            }
        }
        case.rotor.root_pitch.extend(point.root_pitch_deg.iter().map(|(harmonic, own)| {
            PitchHarmonic {
                harmonic: *harmonic,
                amplitude_deg: own.cosine.hypot(own.sine),
                phase_deg: own.sine.atan2(own.cosine).to_degrees(),
            }
        }));
        let t = &mut case.tolerances;
        t.trim = t.trim.max(TRIM_TOLERANCE);
        t.periodicity = t.periodicity.max(PERIODICITY_TOLERANCE);
        t.inflow = t.inflow.max(INFLOW_TOLERANCE);
        case
    }

    /// Trims a point without its drives; `near` is another rotor nearly like it there.
    fn trim(&self, point: &SweepPoint, near: Option<&Trimmed>) -> Result<Trimmed, StudyError> {
        let case = self.case_at(point);
        let rotor = match near {
            Some(near) => TrimmedRotor::near(&case, &near.rotor)?,
            None => TrimmedRotor::new(&case, None)?,
        };
        // the state that a diverged wake leaves is no rotor in flight: what differs there is no effect
        if rotor.wake().is_some_and(|wake| wake_status(wake) == WakeStatus::Diverged) {
            let (field, message) = ("inflow.model".to_owned(), NO_SOLUTION.to_owned());
            return Err(StudyError::Refused { field, message });
        }
        Ok(Trimmed { case, rotor })
    }

    /// Drives the flaps of a trimmed point; `near` is another rotor nearly like it there.
    fn drive(
        &self,
        point: &SweepPoint,
        actuators: &Actuators,
        trimmed: &Arc<Trimmed>,
        near: Option<&Flown>,
    ) -> Result<Flown, StudyError> {
        let at_drive = |source: PlantError| StudyError::Refused {
            field: "actuator".to_owned(),
            message: source.to_string(),
        };
        let motions_deg: Vec<HarmonicSeries> = point
            .flaps_volt
            .iter()
            .map(|own| actuators.motion_deg(self, own).map_err(at_drive))
            .collect::<Result<_, _>>()?;
        let angles: Vec<HarmonicSeries> =
            motions_deg.iter().map(|own| scaled(own, 1.0_f64.to_radians())).collect();
        let at_flaps = |source| StudyError::Response { field: "flaps".to_owned(), source };
        let Trimmed { case, rotor } = &**trimmed;
        let response = if point.is_driven() {
            let start = near.map_or(&rotor.trim().rotor, |near| &near.response);
            rotor.with_flaps_from(angles.clone(), start).map_err(at_flaps)?
        } else {
            rotor.trim().rotor.clone()
        };
        let loads = if case.rotor.dissimilar_blades.is_empty() {
            response.hub.clone()
        } else {
            let mut solvers = rotor.unlike_solvers(case)?;
            rotor.unlike_hub_loads(&mut solvers, &angles, &response).map_err(at_flaps)?
        };
        let scales = case.scales();
        let unit =
            |k: usize| if k < 3 { scales.force_newton() } else { scales.moment_newton_metre() };
        let hub = std::array::from_fn(|k| scaled(&loads.components[k], unit(k)));
        Ok(Flown { trimmed: Arc::clone(trimmed), response, motions_deg, hub, scales })
    }

    /// Flies points, `near` a rotor nearly like this one at each of them, and whether it is trimmed as this one. Points that differ
    /// in their drives alone share their trim.
    pub(crate) fn fly(
        &self,
        points: &[&SweepPoint],
        actuators: &Actuators,
        near: Option<(&[&Flown], bool)>,
    ) -> Vec<Result<Flown, StudyError>> {
        let (near, is_trimmed_alike) =
            near.map_or((None, false), |(own, alike)| (Some(own), alike));
        let mut first: Vec<usize> = Vec::new();
        let mut of_point = Vec::with_capacity(points.len());
        for (p, point) in points.iter().enumerate() {
            let place = first.iter().position(|&other| points[other].is_trimmed_as(point));
            of_point.push(place.unwrap_or_else(|| {
                first.push(p);
                first.len() - 1
            }));
        }
        let trim = |p: usize| match near {
            Some(near) if is_trimmed_alike => Ok(Arc::clone(&near[p].trimmed)),
            near => self.trim(points[p], near.map(|near| &*near[p].trimmed)).map(Arc::new),
        };
        let trims: Vec<Option<Arc<Trimmed>>> = first.par_iter().map(|&p| trim(p).ok()).collect();
        let one = |(p, &point): (usize, &&SweepPoint)| {
            // one that failed fails again, and says why
            let trimmed = trims[of_point[p]].clone().map_or_else(|| trim(p), Ok)?;
            self.drive(point, actuators, &trimmed, near.map(|near| near[p]))
        };
        points.par_iter().enumerate().map(one).collect()
    }
}

impl Flown {
    /// What every channel reads.
    pub(crate) fn read(
        &self,
        model: &RotorModel,
        channels: &[SweepChannel],
        named: &[Channel],
        instruments: &[String],
    ) -> Result<Vec<f64>, StudyError> {
        let path = &model.path;
        let Trimmed { case, rotor } = &*self.trimmed;
        channels
            .iter()
            .zip(named)
            .map(|(channel, named)| {
                let value = match channel.reading {
                    Reading::ControlDeg(k) => {
                        let c = &rotor.trim().controls;
                        let own = [c.theta0_rad, c.theta1c_rad, c.theta1s_rad][k].to_degrees();
                        own + if k == 0 { path.collective_deg } else { 0.0 }
                    }
                    Reading::PowerWatt => {
                        let unit = self.scales.moment_newton_metre() * self.scales.omega_rad_s();
                        self.response.power.shaft * case.rotor.blades as f64 * unit
                    }
                    Reading::Harmonic { of, harmonic, part } => {
                        let series = self.series(of)?;
                        let own = series.harmonic(harmonic);
                        let own = match of {
                            Load::Hub(_) => path.read(harmonic, self.scales.rev_hz(), own),
                            _ => own,
                        };
                        match part {
                            PartOf::Mean => series.mean,
                            PartOf::Cosine => own.cosine,
                            PartOf::Sine => own.sine,
                        }
                    }
                };
                Ok(value * path.gain(&instruments[named.instrument]))
            })
            .collect()
    }

    /// The series of a load or motion.
    fn series(&self, of: Load) -> Result<HarmonicSeries, StudyError> {
        let at_flaps = |source| StudyError::Response { field: "flaps".to_owned(), source };
        let angles =
            || self.motions_deg.iter().map(|own| scaled(own, 1.0_f64.to_radians())).collect();
        let Trimmed { case, rotor } = &*self.trimmed;
        Ok(match of {
            Load::Hub(k) => self.hub[k].clone(),
            Load::FlapDeg(flap) => self.motions_deg[flap].clone(),
            Load::Moment { axis, station_r } => {
                let found = rotor.station_loads_with(angles(), &self.response, &[station_r]);
                let found = found.map_err(at_flaps)?;
                scaled(&found[0].moments.harmonics[axis], self.scales.moment_newton_metre())
            }
            Load::Airload { is_moment, station_r } => {
                let about = (angles(), &self.response);
                let found = rotor.airloads_with(about, &[station_r], case.tip_mach(), AZIMUTHS);
                let (loads, _) = found.map_err(at_flaps)?;
                let value = loads[0].loads.iter();
                let values: Vec<f64> =
                    value.map(|at| if is_moment { at.moment_m2 } else { at.normal_m2 }).collect();
                resolved(&values)
            }
            Load::TipTwistDeg | Load::TipFlap => {
                let tip = rotor.tip_motion(&self.response, AZIMUTHS);
                let is_twist = matches!(of, Load::TipTwistDeg);
                let value = |at: &rotor_response::TipMotion| {
                    if is_twist { at.twist_rad.to_degrees() } else { at.flap }
                };
                resolved(&tip.iter().map(value).collect::<Vec<_>>())
            }
        })
    }
}

/// What a model reads at every point of a sweep; `actuator` is that of its case, none of an ideal one, `hysteretic` one with
/// hysteresis that [`crate::FlapDriveModel::hysteresis`] mixes in.
///
/// # Errors
/// [`RotorGapError::Study`] of a point that cannot be flown.
pub fn predict(
    model: &RotorModel,
    sweep: &Sweep,
    actuator: Option<Arc<ActuatorModel>>,
    hysteretic: Option<Arc<ActuatorModel>>,
) -> Result<Grid, RotorGapError> {
    let at = |point: &str| {
        let point = point.to_owned();
        move |source| RotorGapError::Study { point, source: Box::new(source) }
    };
    let actuators = Actuators::of(&model.case, actuator, hysteretic).map_err(at("-"))?;
    let (named, instruments) = instrumented(&sweep.channels);
    let points: Vec<&SweepPoint> = sweep.points.iter().collect();
    let flown = model.fly(&points, &actuators, None);
    let read = |(point, own): (&SweepPoint, Result<Flown, StudyError>)| {
        let own = own.map_err(at(&point.id))?;
        own.read(model, &sweep.channels, &named, &instruments).map_err(at(&point.id))
    };
    sweep.points.iter().zip(flown).map(read).collect()
}
