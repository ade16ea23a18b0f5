//! The trimmed rotor with its driven flaps as the plant of the controller.

mod hinge;
mod power;
mod sensitivity;

use self::power::PlantPower;
use super::authority::HARMONICS;
use super::drive::scaled;
use super::recent::Recent;
use super::reconverged::{ReconvergedAuthority, Reconverging};
use super::{
    CouplingResidual, FlapAuthority, FlapDrive, FlapMotion, FullScale, HingeCoupling, PlantError,
};
use crate::SimError;
use crate::case::{Case, LoadedCase, TInflowChoice};
use crate::inflow::{SettledInflow, SettledTrim, settled_trim};
use crate::problem::Place;
use hhc_control::{
    ControlLayout, ControlLimits, FlapCircle, Measurement, Plant, PlantCall, RunError, TMatrix,
};
use nalgebra::DMatrix;
use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries, RotorScales};
use rotor_response::{
    Condition, InflowState, OtherBlade, ResponseError, Rotor, RotorSolution, RotorSolver,
    SectionLift, SixLoads, Stability, StationLoads, dissimilar_hub_loads,
};
use std::sync::{Arc, OnceLock};
use trim::{TrimError, TrimSolution, TrimTarget, WakeTrim, imbalance};

/// A rotor in trim, flaps at rest: where every control run starts.
#[derive(Debug, Clone)]
pub struct TrimmedRotor {
    solver: RotorSolver,
    inflow: SettledInflow,
    trim: TrimSolution,
    scales: RotorScales,
    /// Inflow in the T of the linearised rotor.
    t_inflow: TInflowChoice,
    /// What a wake converged anew takes: controlled harmonics, steps and settings.
    reconverging: Reconverging,
    /// Made when first asked for.
    reconverged: Arc<OnceLock<ReconvergedAuthority>>,
    /// Change of the hinge moments with the flap motions, found when first asked for.
    hinge_response: Arc<OnceLock<DMatrix<f64>>>,
    /// Made when first asked for, the same whoever asks.
    authority: Arc<OnceLock<FlapAuthority>>,
    wake: Option<Arc<WakeTrim>>,
}

impl TrimmedRotor {
    /// Builds the rotor of a case and trims it with its flaps at rest, from a nearby trim if there
    /// is one.
    ///
    /// # Errors
    /// [`SimError::Blade`], [`SimError::Response`] and [`SimError::Trim`], at the line of the case
    /// that asked for it.
    pub fn new(loaded: &LoadedCase, start: Option<&TrimSolution>) -> Result<Self, SimError> {
        let case = &loaded.case;
        loaded.refuse_prescribed_circulation()?;
        let at_rotor = |source| SimError::Response { place: loaded.index.place("rotor"), source };
        let blade = case.blade_properties()?;
        let rotor =
            Rotor::new(case.rotor_model(), &blade, case.discretisation()).map_err(at_rotor)?;
        loaded.refuse_resonance_of(&rotor)?;
        let mu = case.advance_ratio;
        let tolerances = case.response_tolerances();
        let mut solver = RotorSolver::new(Arc::new(rotor), mu, tolerances).map_err(at_rotor)?;
        let settled = settled_trim(loaded, &mut solver, start);
        let settled = settled.map_err(|source| loaded.trim_error(source))?;
        let scales = case.scales;
        let hinge_response = Arc::default();
        let authority = Arc::default();
        let SettledTrim { trim, inflow, wake } = settled;
        let t_inflow = case.control.t_inflow;
        let (reconverging, reconverged) = (Reconverging::of(case), Arc::default());
        Ok(Self {
            solver,
            inflow,
            trim,
            scales,
            t_inflow,
            reconverging,
            reconverged,
            hinge_response,
            authority,
            wake,
        })
    }

    /// Moment unit `m0 Omega^2 R^3`, N m.
    fn moment_newton_metre(&self) -> f64 {
        self.scales.moment_newton_metre()
    }

    /// The trim.
    pub fn trim(&self) -> &TrimSolution {
        &self.trim
    }

    /// The free wake the trim settled with, if the case asks for one.
    pub fn wake(&self) -> Option<&WakeTrim> {
        self.wake.as_deref()
    }

    /// Whether a free wake has parted from the rotor: this is a state on the way to a trim, none.
    pub fn wake_parted(&self) -> bool {
        self.wake().is_some_and(|wake| wake.outcome.ran_away())
    }

    /// The rotor.
    pub fn rotor(&self) -> &Rotor {
        self.solver.rotor()
    }

    /// What the flaps do to the hub, linearised about the trimmed orbit with the inflow as the case has it in T.
    ///
    /// # Errors
    /// The errors of the linearised response.
    pub fn authority(&self) -> Result<&FlapAuthority, ResponseError> {
        if let Some(known) = self.authority.get() {
            return Ok(known);
        }
        let found = self.linearised(self.state_in_t())?;
        Ok(self.authority.get_or_init(|| found))
    }

    /// The same with the geometry of the free wake converged anew at the harmonics that the case controls; none
    /// without a free wake.
    ///
    /// # Errors
    /// The errors of the response and of the wake.
    pub fn reconverged(&self) -> Result<Option<&ReconvergedAuthority>, ResponseError> {
        let Some(wake) = &self.wake else { return Ok(None) };
        let Some(coupling) = &self.reconverging.coupling else { return Ok(None) };
        if let Some(known) = self.reconverged.get() {
            return Ok(Some(known));
        }
        let settled = self.linearised(InflowState::Settled)?;
        let about = (wake.as_ref(), &self.solver, coupling);
        let found = self.reconverging.authority(about, &self.flaps_at_rest(), settled)?;
        Ok(Some(self.reconverged.get_or_init(|| found)))
    }

    /// The same with the inflow as asked for, made anew.
    ///
    /// # Errors
    /// The errors of the linearised response.
    pub fn linearised(&self, state: InflowState) -> Result<FlapAuthority, ResponseError> {
        self.linearised_to(state, HARMONICS)
    }

    fn linearised_to(
        &self,
        state: InflowState,
        highest: usize,
    ) -> Result<FlapAuthority, ResponseError> {
        let condition = self.flaps_at_rest();
        let about = (&condition, &self.trim.rotor);
        FlapAuthority::about(&mut self.solver.clone(), about, &self.inflow, (state, highest))
    }

    /// What the inflow does in T. A loop measures responses with the geometry of the wake held: the T that
    /// converges it anew is a forecast of what the hub would feel, not of what the loop measures.
    fn state_in_t(&self) -> InflowState {
        match self.t_inflow {
            TInflowChoice::Settled | TInflowChoice::Reconverged => InflowState::Settled,
            TInflowChoice::Frozen => InflowState::Frozen,
        }
    }

    /// What another response leaves unbalanced at the controls and attitude of this trim, over the
    /// weight.
    ///
    /// # Errors
    /// As [`trim::imbalance`].
    pub fn imbalance(
        &self,
        target: &TrimTarget,
        response: &RotorSolution,
    ) -> Result<f64, TrimError> {
        imbalance(&self.solver, target, &self.trim, response)
    }

    /// Stability of the trimmed blade, flaps at rest.
    ///
    /// # Errors
    /// As [`RotorSolver::stability`].
    pub fn stability(&self) -> Result<Stability, ResponseError> {
        self.solver.stability(&self.flaps_at_rest(), &self.trim.rotor)
    }

    /// The section of the trimmed rotor that lifts hardest.
    pub fn largest_section_lift(&self) -> Option<SectionLift> {
        self.solver.largest_section_lift(&self.trim.rotor)
    }

    /// Stability of an unlike blade, and its loads at stations of its span (R), flaps at rest.
    ///
    /// # Errors
    /// The errors of the response.
    pub fn unlike_blade(
        &self,
        unlike: &UnlikeSolver,
        stations: &[f64],
    ) -> Result<(Stability, Vec<StationLoads>), ResponseError> {
        let mut solver = unlike.solver.clone();
        let condition = self.flaps_at_rest();
        let found = solver.blade_response(&condition, &self.trim.rotor)?;
        let loads = solver.station_loads(&condition, &found, stations)?;
        Ok((solver.stability(&condition, &found)?, loads))
    }

    /// Loads of one blade at stations of its span (R), flaps at rest.
    ///
    /// # Errors
    /// As [`RotorSolver::station_loads`].
    pub fn station_loads(&self, stations: &[f64]) -> Result<Vec<StationLoads>, ResponseError> {
        self.solver.station_loads(&self.flaps_at_rest(), &self.trim.rotor, stations)
    }

    fn flaps_at_rest(&self) -> Condition {
        Condition {
            bank_rad: self.trim.attitude.roll_rad,
            flight: self.trim.flight,
            controls: self.trim.controls,
            flap_angles_rad: vec![HarmonicSeries::zero(0); self.rotor().model().flaps.len()],
        }
    }

    /// A solver for every unlike blade of a case, at the advance ratio of this trim.
    ///
    /// # Errors
    /// [`SimError::Blade`] and [`SimError::Response`].
    pub fn unlike_solvers(&self, case: &Case) -> Result<Vec<UnlikeSolver>, SimError> {
        let unlike = case.blade.unlike.iter().enumerate();
        unlike
            .map(|(i, unlike)| {
                let field = format!("rotor.unlike_blades[{i}]");
                let place = || Place::file("case").field(&field);
                let failed = |source| SimError::Response { place: place(), source };
                let blade = case.unlike_blade(unlike)?;
                let rotor = Rotor::new(case.rotor_model(), &blade, case.discretisation())
                    .map_err(failed)?;
                rotor.refuse_resonance(self.trim.controls.theta0_rad).map_err(failed)?;
                let mu = self.trim.flight.advance_ratio;
                let solver = RotorSolver::new(Arc::new(rotor), mu, case.response_tolerances())
                    .map_err(failed)?;
                let (position, flap_motion) = (unlike.blade - 1, unlike.flap_motion);
                Ok(UnlikeSolver { position, flap_motion, solver })
            })
            .collect()
    }

    /// Hub loads with unlike blades in the inflow of a response, for given flap motions of the others.
    ///
    /// # Errors
    /// The errors of the response.
    pub fn unlike_hub_loads(
        &self,
        unlike: &mut [UnlikeSolver],
        flap_angles_rad: &[HarmonicSeries],
        about: &RotorSolution,
    ) -> Result<SixLoads, ResponseError> {
        let condition = |factor: f64| Condition {
            bank_rad: self.trim.attitude.roll_rad,
            flight: self.trim.flight,
            controls: self.trim.controls,
            flap_angles_rad: flap_angles_rad.iter().map(|angle| scaled(angle, factor)).collect(),
        };
        let mut others: Vec<OtherBlade> = unlike
            .iter()
            .map(|one| OtherBlade {
                position: one.position,
                solver: one.solver.clone(),
                condition: condition(one.flap_motion),
            })
            .collect();
        let mut alike = self.solver.clone();
        dissimilar_hub_loads(&mut alike, (&condition(1.0), about), &mut others)
    }

    /// Response with moving flaps: pilot controls and attitude as trimmed, inflow settled anew.
    ///
    /// Starts from the trimmed orbit with the trim's factorisation, whatever was solved before.
    ///
    /// # Errors
    /// The errors of the response.
    pub fn with_flaps(
        &self,
        flap_angles_rad: Vec<HarmonicSeries>,
    ) -> Result<RotorSolution, ResponseError> {
        self.with_flaps_from(flap_angles_rad, &self.trim.rotor)
    }

    /// The same, started from a response of one's own.
    ///
    /// # Errors
    /// The errors of the response.
    pub fn with_flaps_from(
        &self,
        flap_angles_rad: Vec<HarmonicSeries>,
        start: &RotorSolution,
    ) -> Result<RotorSolution, ResponseError> {
        let condition = Condition {
            bank_rad: self.trim.attitude.roll_rad,
            flight: self.trim.flight,
            controls: self.trim.controls,
            flap_angles_rad,
        };
        self.solver.clone().solve(&condition, &self.inflow, Some(start))
    }
}

/// The solver of a blade unlike the rest.
#[derive(Debug, Clone)]
pub struct UnlikeSolver {
    position: usize,
    flap_motion: f64,
    solver: RotorSolver,
}

/// Azimuths at which the range of the voltage is held: a peak of the fifth harmonic between two of them may lie beyond by
/// 2e-4 of its amplitude.
const LIMIT_AZIMUTHS: usize = 720;
/// Part of full scale from which the gain of an actuator is read off its motion.
const LEAST_GAIN_PART: f64 = 0.2;
/// Part of a given stroke limit that a cone program aims at: the gain moves with the control, and no end of a
/// loop is to lie above the limit.
const STROKE_AIMED_AT: f64 = 0.9985;

/// Everything about one control vector.
#[derive(Debug, Clone)]
pub struct PlantState {
    /// Motion of each flap, root to tip.
    pub flaps: Vec<FlapMotion>,
    /// Response of the rotor.
    pub rotor: RotorSolution,
    /// How well flap motion and hinge moment agree; none where no actuator gives way to it.
    pub coupling: Option<CouplingResidual>,
}

/// The plant: voltages in, hub loads out.
#[derive(Debug, Clone)]
pub struct RotorPlant {
    layout: ControlLayout,
    rotor: TrimmedRotor,
    drive: FlapDrive,
    /// None where the actuator does not give way to the hinge moment.
    coupling: Option<HingeCoupling>,
    /// One per pair of the layout.
    stroke_limits_deg: Vec<f64>,
    /// What a cone program aims at, one per pair.
    stroke_aims_deg: Vec<f64>,
    /// Amplitude at which each pair, alone on its flap, reaches its limit, V.
    full_scale_volt: Vec<f64>,
    /// Amplitude at which each pair, alone on its flap, ends the range of voltages, V.
    reach_volt: Vec<f64>,
    power: Option<PlantPower>,
    /// The control measured last and what was found there: T is mostly asked for about it.
    measured: Option<(Vec<f64>, Arc<PlantState>)>,
    /// Motions of one flap without hinge moment, and of all flaps under it.
    free: Recent<FlapMotion>,
    /// Their changes with the controls of the flap.
    tangents: Recent<Vec<FlapMotion>>,
    coupled: Recent<Vec<FlapMotion>>,
}

impl RotorPlant {
    /// A plant with the same drive at every flap.
    ///
    /// `full_scale` holds the limit at each controlled harmonic. A drive that gives way to a load is
    /// coupled with the hinge moment of its flap in every answer.
    ///
    /// # Errors
    /// [`RunError::Control`] for a layout without flaps or harmonics.
    pub fn new(
        rotor: TrimmedRotor,
        drive: FlapDrive,
        harmonics: &[usize],
        full_scale: &[FullScale],
    ) -> Result<Self, RunError<PlantError>> {
        let flaps = rotor.rotor().model().flaps.len();
        let numbers = harmonics.iter().map(|&n| u32::try_from(n).unwrap_or(u32::MAX)).collect();
        let layout = ControlLayout::new(flaps, numbers)?;
        let coupling = rotor.coupling(drive.give_deg_per_newton_metre()).map_err(|source| {
            let call = PlantCall::Measure { control_volt: layout.zero() };
            RunError::Plant { call, history: Vec::new(), source: source.into() }
        })?;
        let per_pair = |pick: &dyn Fn(&FullScale) -> f64| -> Vec<f64> {
            (0..layout.pairs()).map(|p| pick(&full_scale[p % full_scale.len()])).collect()
        };
        Ok(Self {
            full_scale_volt: per_pair(&|f| f.amplitude_volt),
            stroke_limits_deg: per_pair(&|f| f.stroke_deg),
            reach_volt: per_pair(&|f| f.reach_volt),
            // where the range of voltages is the limit, its circle holds the stroke
            stroke_aims_deg: per_pair(&|f| {
                let given = f.amplitude_volt < f.reach_volt;
                if given { STROKE_AIMED_AT * f.stroke_deg } else { f.stroke_deg }
            }),
            layout,
            rotor,
            drive,
            coupling,
            power: None,
            measured: None,
            free: Recent::default(),
            tangents: Recent::default(),
            coupled: Recent::default(),
        })
    }

    /// The rotor in trim.
    pub fn rotor(&self) -> &TrimmedRotor {
        &self.rotor
    }

    /// The same plant with the inflow settled in the T of its linearised rotor, as in its answers.
    pub(super) fn settled(&self) -> Self {
        let rotor = match self.rotor.t_inflow {
            TInflowChoice::Settled => self.rotor.clone(),
            _ => TrimmedRotor {
                t_inflow: TInflowChoice::Settled,
                authority: Arc::default(),
                ..self.rotor.clone()
            },
        };
        Self { rotor, ..self.clone() }
    }

    /// What drives its flaps.
    pub fn drive(&self) -> &FlapDrive {
        &self.drive
    }

    /// Harmonics of the voltage of every flap.
    fn voltages(&self, control_volt: &[f64]) -> Result<Vec<Vec<(usize, Harmonic)>>, PlantError> {
        let pairs = self.layout.voltages_volt(control_volt).map_err(PlantError::Bias)?;
        let mut flaps = vec![Vec::new(); self.layout.flaps()];
        for (pair, voltage) in pairs.into_iter().enumerate() {
            if let Some((flap, harmonic)) = self.layout.flap_and_harmonic(pair) {
                flaps[flap].push((harmonic as usize, voltage));
            }
        }
        Ok(flaps)
    }

    /// Motion of every flap for a control vector, without hinge moment.
    fn free_motion(&self, control_volt: &[f64]) -> Result<Vec<FlapMotion>, PlantError> {
        self.voltages(control_volt)?
            .into_par_iter()
            .map(|voltages| self.free.answer(bits(&voltages), || self.drive.motion(&voltages)))
            .collect()
    }

    /// The free motions under hinge moments, N m.
    fn loaded(
        &self,
        free: &[FlapMotion],
        moments: &[HarmonicSeries],
    ) -> Result<Vec<FlapMotion>, PlantError> {
        free.par_iter()
            .zip(moments)
            .map(|(free, moment)| self.drive.loaded_motion(free, moment))
            .collect()
    }

    /// Motion of every flap for a control vector, without a response of the rotor: under a hinge moment
    /// it is that of the rotor's linear answer ([`HingeCoupling::predict`]).
    ///
    /// # Errors
    /// The actuator's errors; [`PlantError::Coupling`].
    pub fn flap_motion(&self, control_volt: &[f64]) -> Result<Vec<FlapMotion>, PlantError> {
        let free = self.free_motion(control_volt)?;
        match &self.coupling {
            None => Ok(free),
            Some(coupling) => {
                let bits = control_volt.iter().copied().enumerate();
                self.coupled
                    .answer(bits, || coupling.predict(|moments| self.loaded(&free, moments)))
            }
        }
    }

    /// Flap motion and rotor response for a control vector, settled on each other where the actuator
    /// gives way to the hinge moment. Depends on the control vector alone.
    ///
    /// # Errors
    /// The errors of actuator and rotor; [`PlantError::Coupling`].
    pub fn state(&self, control_volt: &[f64]) -> Result<PlantState, PlantError> {
        let free = self.free_motion(control_volt)?;
        let Some(coupling) = &self.coupling else {
            let rotor = self.rotor.with_flaps(angles_rad(&free))?;
            return Ok(PlantState { rotor, flaps: free, coupling: None });
        };
        let unit = self.rotor.moment_newton_metre();
        let actuate = |moments: &[HarmonicSeries]| self.loaded(&free, moments);
        let respond = |flaps: &[FlapMotion], last: Option<&RotorSolution>| {
            let start = last.unwrap_or(&self.rotor.trim.rotor);
            let rotor = self.rotor.with_flaps_from(angles_rad(flaps), start)?;
            let moments = rotor.hinge.iter().map(|h| scaled(&h.total(), unit)).collect();
            Ok((rotor, moments))
        };
        let (flaps, rotor, residual) = coupling.settle(actuate, respond)?;
        Ok(PlantState { rotor, flaps, coupling: Some(residual) })
    }

    /// Hinge moment of every flap under given flap motions, N m, positive in the sense of the angle.
    ///
    /// # Errors
    /// The errors of the rotor.
    pub fn hinge_moments_newton_metre(
        &self,
        flaps: Vec<FlapMotion>,
    ) -> Result<Vec<HarmonicSeries>, PlantError> {
        let unit = self.rotor.moment_newton_metre();
        let state = self.state_of(flaps)?;
        Ok(state.rotor.hinge.iter().map(|h| scaled(&h.total(), unit)).collect())
    }

    /// Rotor response for given flap motions, whatever the actuator makes of the hinge moment.
    ///
    /// # Errors
    /// The errors of the rotor.
    pub fn state_of(&self, flaps: Vec<FlapMotion>) -> Result<PlantState, PlantError> {
        let rotor = self.rotor.with_flaps(angles_rad(&flaps))?;
        Ok(PlantState { rotor, flaps, coupling: None })
    }

    /// Motion of each pair of the layout at its own harmonic, deg.
    fn pair_motion(&self, flaps: &[FlapMotion]) -> Vec<Harmonic> {
        (0..self.layout.pairs())
            .filter_map(|pair| self.layout.flap_and_harmonic(pair))
            .map(|(flap, n)| flaps[flap].flap_deg.harmonic(n as usize))
            .collect()
    }

    /// What is measured of given hub loads and flap motions.
    pub(super) fn measurement(
        &self,
        control_volt: &[f64],
        hub_loads: &[f64; 12],
        flaps: &[FlapMotion],
    ) -> Measurement {
        let mut hub_loads = hub_loads.to_vec();
        for (u, gain) in control_volt.chunks_exact(2).zip(self.power_gains()) {
            hub_loads.extend([gain * u[0], gain * u[1]]);
        }
        Measurement {
            hub_loads,
            flap_motion_deg: self.pair_motion(flaps),
            mean_flap_deg: flaps.iter().map(|f| f.flap_deg.mean).collect(),
        }
    }

    /// What is measured of a state.
    fn seen(&self, control_volt: &[f64], state: &PlantState) -> Measurement {
        let loads = state.rotor.hub.harmonic(self.rotor.rotor().model().blades);
        self.measurement(control_volt, &loads, &state.flaps)
    }
}

/// Voltages with their harmonics, as answers are remembered by.
fn bits(voltages: &[(usize, Harmonic)]) -> impl Iterator<Item = (usize, f64)> + '_ {
    voltages.iter().flat_map(|&(n, h)| [(n, h.cosine), (n, h.sine)])
}

/// Flap angles as the rotor takes them, rad.
fn angles_rad(flaps: &[FlapMotion]) -> Vec<HarmonicSeries> {
    flaps.iter().map(|f| scaled(&f.flap_deg, std::f64::consts::PI / 180.0)).collect()
}

impl Plant for RotorPlant {
    type Error = PlantError;

    fn layout(&self) -> &ControlLayout {
        &self.layout
    }

    fn measure(&mut self, control_volt: &[f64]) -> Result<Measurement, PlantError> {
        let state = self.state(control_volt)?;
        let measurement = self.seen(control_volt, &state);
        self.measured = Some((control_volt.to_vec(), Arc::new(state)));
        Ok(measurement)
    }

    fn measure_many(&mut self, controls_volt: &[Vec<f64>]) -> Result<Vec<Measurement>, PlantError> {
        let plant = &*self;
        let answer = |u: &Vec<f64>| plant.state(u).map(|state| plant.seen(u, &state));
        controls_volt.par_iter().map(answer).collect()
    }

    fn strokes_deg(&mut self, control_volt: &[f64]) -> Result<Vec<f64>, PlantError> {
        let amplitudes = self.layout.amplitudes_volt(control_volt).map_err(PlantError::Bias)?;
        let by_voltage: Vec<f64> = amplitudes
            .iter()
            .zip(&self.full_scale_volt)
            .zip(&self.stroke_limits_deg)
            .map(|((volt, full), limit)| limit * volt / full)
            .collect();
        // beyond the range the actuator cannot be asked: the stroke grows with the voltage there
        if amplitudes.iter().zip(&self.reach_volt).any(|(volt, reach)| volt > reach) {
            return Ok(by_voltage);
        }
        // harmonics that share a flap share its range of voltages
        let ratios: Vec<f64> =
            self.voltages(control_volt)?.iter().map(|v| self.drive.range_ratio(v)).collect();
        let in_range = |strokes: Vec<f64>| {
            let pairs = strokes.into_iter().zip(&self.stroke_limits_deg).enumerate();
            pairs
                .map(|(pair, (stroke, limit))| {
                    let flap = self.layout.flap_and_harmonic(pair).map_or(0, |(flap, _)| flap);
                    stroke.max(limit * ratios[flap])
                })
                .collect()
        };
        match self.flap_motion(control_volt) {
            Ok(flaps) => {
                let motion = self.pair_motion(&flaps);
                Ok(in_range(motion.iter().map(Harmonic::amplitude).collect()))
            }
            Err(PlantError::VoltageSwing { .. }) => Ok(in_range(by_voltage)),
            // no bias centres the flap inside the range, though the swing alone fits
            Err(PlantError::Bias(_)) => {
                let excess = amplitudes.len() as f64;
                Ok(by_voltage.iter().map(|s| s * excess).collect())
            }
            Err(error) => Err(error),
        }
    }

    fn stroke_limits_deg(&self) -> Vec<f64> {
        self.stroke_limits_deg.clone()
    }

    fn admits(&self, control_volt: &[f64]) -> bool {
        self.flap_motion(control_volt).is_ok()
    }

    fn limits(&mut self, control_volt: &[f64]) -> Result<ControlLimits, PlantError> {
        let flaps = self.flap_motion(control_volt)?;
        let voltage = self.voltage_range(control_volt, &flaps)?;
        let voltages = self.layout.voltages_volt(control_volt).map_err(PlantError::Bias)?;
        // the gain of a small motion says nothing about a large one: its amplitude is bounded in volt
        let known: Vec<bool> = voltages
            .iter()
            .zip(&self.full_scale_volt)
            .map(|(voltage, full)| voltage.amplitude() > LEAST_GAIN_PART * full)
            .collect();
        let volts = self.full_scale_volt.iter().zip(&self.reach_volt).zip(&known);
        let largest_volt = volts.map(|((full, reach), known)| if *known { *reach } else { *full });
        let mut limits = ControlLimits::none(&self.layout)
            .with_amplitudes_volt(largest_volt.collect())
            .and_then(|limits| limits.with_voltage_range(voltage))
            .map_err(PlantError::Bias)?;
        for (pair, (voltage, motion)) in voltages.iter().zip(self.pair_motion(&flaps)).enumerate() {
            if known[pair] {
                let gain = motion.amplitude() / voltage.amplitude();
                let (sin, cos) = (motion.phase_rad() - voltage.phase_rad()).sin_cos();
                let circle = FlapCircle {
                    gain_deg_per_volt: [[gain * cos, -gain * sin], [gain * sin, gain * cos]],
                    limit_deg: self.stroke_aims_deg[pair],
                };
                limits = limits.with_flap_circle(pair, circle).map_err(PlantError::Bias)?;
            }
        }
        if let Some(power) = self.power_limit(control_volt, &flaps)? {
            limits = limits.with_power(power).map_err(PlantError::Bias)?;
        }
        Ok(limits)
    }

    fn linearised_t(&mut self, control_volt: &[f64]) -> Result<Option<TMatrix>, PlantError> {
        self.t_about(control_volt).map(Some)
    }
}
