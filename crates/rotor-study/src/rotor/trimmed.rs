//! A rotor in trim with its flaps at rest.

use crate::error::StudyError;
use crate::rotor::authority::{FlapAuthority, HARMONICS};
use crate::rotor::inflow::{SettledTrim, refuse_prescribed_circulation, settled_trim};
use crate::rotor::reconverged::{ReconvergedAuthority, Reconverging};
use crate::rotor::resonance::{dissimilar_rotors, refuse_resonance_of, trim_error};
use nalgebra::DMatrix;
use rotor_base::once::{Once, found};
use rotor_base::series::scaled;
use rotor_base::{HarmonicSeries, RotorScales};
use rotor_case::{Case, TInflowChoice};
use rotor_response::{
    BladeStateSpace, Condition, FlapDirection, InflowState, OtherBlade, ResponseError,
    ResponseTolerances, Rotor, RotorSolution, RotorSolver, SectionLift, SixLoads, Stability,
    StationAirloads, StationLoads, TipMotion, dissimilar_hub_loads,
};
use rotor_wake::InflowModel;
use std::collections::BTreeSet;
use std::sync::Arc;
use trim::{TrimError, TrimSolution, TrimTarget, WakeTrim, WakeTrimSettings, imbalance};

/// Residual of the linear equations of a rotor that is linearised roughly.
const ROUGHLY_LINEAR: f64 = 3e-4;

/// A rotor in trim, flaps at rest: where every control run starts.
#[derive(Debug, Clone)]
pub struct TrimmedRotor {
    pub(super) solver: RotorSolver,
    pub(super) inflow: Arc<dyn InflowModel>,
    pub(super) trim: TrimSolution,
    scales: RotorScales,
    /// Inflow in the T of the linearised rotor.
    t_inflow: TInflowChoice,
    /// What a wake converged anew takes: controlled harmonics, steps and settings.
    reconverging: Reconverging,
    reconverged: Once<ReconvergedAuthority>,
    /// Change of the hinge moments with the flap motions.
    pub(super) hinge_response: Once<DMatrix<f64>>,
    /// Harmonics of the flaps in the linearised rotor, 0 for the mean.
    harmonics: Vec<usize>,
    /// Linearised with the inflow settled, and with the wake frozen.
    linearised: Once<[FlapAuthority; 2]>,
    stability: Once<Stability>,
    wake: Option<Arc<WakeTrim>>,
}

impl TrimmedRotor {
    /// Builds the rotor of a case and trims it with its flaps at rest, from a nearby trim if there
    /// is one. Only [`Case::of_rotor`] enters.
    ///
    /// # Errors
    /// [`StudyError::Blade`], [`StudyError::Response`] and [`StudyError::Trim`], with the field of the case
    /// that asked for it.
    pub fn new(case: &Case, start: Option<&TrimSolution>) -> Result<Self, StudyError> {
        // so that nothing else can enter
        let case = &case.of_rotor();
        let solver = Self::solver_of(case, case.response_tolerances())?;
        Self::trimmed(case, solver, start, None, (0..=HARMONICS).collect())
    }

    /// The rotor of a case that differs a little from that of another one at its advance ratio, trimmed from there: the
    /// free wake starts with that of the other one. It is linearised roughly, to a part in a hundred, and for the
    /// harmonics that the case controls, which is all that ideal actuators move.
    ///
    /// # Errors
    /// As [`Self::new`].
    pub fn near(case: &Case, other: &Self) -> Result<Self, StudyError> {
        let case = &case.of_rotor();
        let mut tolerances = case.response_tolerances();
        tolerances.linear = ROUGHLY_LINEAR;
        let wanted = case.control.harmonics.iter().flatten().copied().collect::<BTreeSet<_>>();
        let solver = Self::solver_of(case, tolerances)?.with_matrix_of(&other.solver);
        Self::trimmed(case, solver, Some(other.trim()), other.wake(), wanted.into_iter().collect())
    }

    /// The solver of a case's rotor.
    fn solver_of(case: &Case, tolerances: ResponseTolerances) -> Result<RotorSolver, StudyError> {
        refuse_prescribed_circulation(case)?;
        let at_rotor = |source| StudyError::Response { field: "rotor".to_owned(), source };
        let rotor = case.rotor_of(&case.blade_properties()?, "rotor")?;
        refuse_resonance_of(case, &rotor)?;
        let solver = RotorSolver::new(Arc::new(rotor), case.advance_ratio, tolerances);
        Ok(solver.map_err(at_rotor)?.with_root_pitch(case.root_pitch_rad()))
    }

    fn trimmed(
        case: &Case,
        mut solver: RotorSolver,
        start: Option<&TrimSolution>,
        wake: Option<&WakeTrim>,
        harmonics: Vec<usize>,
    ) -> Result<Self, StudyError> {
        let settled = settled_trim(case, &mut solver, start, wake);
        let SettledTrim { trim, inflow, wake } =
            settled.map_err(|source| trim_error(case, source))?;
        Ok(Self {
            solver,
            inflow,
            trim,
            scales: case.scales(),
            t_inflow: case.control.t_inflow,
            reconverging: Reconverging::of(case),
            reconverged: Once::default(),
            hinge_response: Once::default(),
            harmonics,
            linearised: Once::default(),
            stability: Once::default(),
            wake,
        })
    }

    /// The same rotor with the inflow settled in its T, as in its responses.
    pub(crate) fn with_settled_t(&self) -> Self {
        Self { t_inflow: TInflowChoice::Settled, ..self.clone() }
    }

    /// Units of the rotor.
    pub fn scales(&self) -> &RotorScales {
        &self.scales
    }

    /// The solver of its responses.
    pub fn solver(&self) -> &RotorSolver {
        &self.solver
    }

    /// The trim.
    pub fn trim(&self) -> &TrimSolution {
        &self.trim
    }

    /// The free wake the trim settled with, if the case asks for one.
    pub fn wake(&self) -> Option<&WakeTrim> {
        self.wake.as_deref()
    }

    /// Whether the iteration of free wake and trim diverged, or settled on too little inflow: this is no solution.
    pub fn wake_diverged(&self) -> bool {
        self.wake().is_some_and(|wake| wake.outcome.is_diverged())
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
        self.linearised(self.state_in_t())
    }

    /// The same with the geometry of the free wake converged anew at the harmonics that the case controls; none
    /// without a free wake.
    ///
    /// # Errors
    /// The errors of the linearised response and of the wake.
    pub fn reconverged(&self) -> Result<Option<&ReconvergedAuthority>, ResponseError> {
        let Some((wake, coupling)) = self.coupled_wake() else { return Ok(None) };
        let found = found(&self.reconverged, || {
            let settled = self.linearised(InflowState::Settled)?.clone();
            let rest = self.flaps_at_rest();
            self.reconverging.linearised((wake, coupling), &self.solver, &rest, settled)
        })?;
        Ok(Some(found))
    }

    /// The same by central differences of converged responses, many times as dear: a check on it.
    ///
    /// # Errors
    /// The errors of the response and of the wake.
    pub fn reconverged_by_differences(
        &self,
    ) -> Result<Option<ReconvergedAuthority>, ResponseError> {
        let Some((wake, coupling)) = self.coupled_wake() else { return Ok(None) };
        let settled = self.linearised(InflowState::Settled)?.clone();
        let rest = self.flaps_at_rest();
        self.reconverging.by_differences((wake, coupling), &self.solver, &rest, settled).map(Some)
    }

    /// The free wake and its coupling.
    fn coupled_wake(&self) -> Option<(&WakeTrim, &WakeTrimSettings)> {
        self.wake.as_deref().zip(self.reconverging.coupling.as_ref())
    }

    /// The same with the inflow as asked for.
    ///
    /// # Errors
    /// The errors of the linearised response.
    pub fn linearised(&self, state: InflowState) -> Result<&FlapAuthority, ResponseError> {
        let [settled, frozen] = found(&self.linearised, || self.linearised_for(&self.harmonics))?;
        Ok(if state == InflowState::Settled { settled } else { frozen })
    }

    /// Linearised for other harmonics, the inflow settled and held.
    pub(crate) fn linearised_for(
        &self,
        harmonics: &[usize],
    ) -> Result<[FlapAuthority; 2], ResponseError> {
        let mut solver = self.solver.clone();
        let (rest, about) = (self.flaps_at_rest(), &self.trim.rotor);
        FlapAuthority::about(&mut solver, &rest, about, self.inflow.as_ref(), harmonics)
    }

    /// Change of the hub loads at the blade number per rev with small motions of one flap each (number and deg),
    /// about a response with moved flaps of one's own: inflow as the case has it in T. Load per unit of motion.
    ///
    /// # Errors
    /// The errors of the linearised response.
    pub(crate) fn loads_along<'a>(
        &self,
        flap_angles_rad: Vec<HarmonicSeries>,
        about: &RotorSolution,
        motions_deg: impl Iterator<Item = (usize, &'a HarmonicSeries)>,
    ) -> Result<Vec<[f64; 12]>, ResponseError> {
        let model = self.rotor().model();
        let directions: Vec<FlapDirection> = motions_deg
            .map(|(flap, motion)| {
                let mut direction = vec![HarmonicSeries::zero(0); model.flaps.len()];
                direction[flap] = scaled(motion, 1.0_f64.to_radians());
                direction
            })
            .collect();
        let mut solver = self.solver.clone();
        let at = (&self.condition(flap_angles_rad), about);
        let found = solver.linearised(at, self.inflow.as_ref(), &directions, self.state_in_t())?;
        Ok(found.sensitivities.iter().map(|s| s.hub.harmonic(model.blades)).collect())
    }

    /// What the inflow does in T. A loop measures responses with the geometry of the wake held: the T that
    /// converges it anew is a forecast of what the hub would feel, not of what the loop measures.
    pub(super) fn state_in_t(&self) -> InflowState {
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
    pub fn stability(&self) -> Result<&Stability, ResponseError> {
        found(&self.stability, || self.solver.stability(&self.flaps_at_rest(), &self.trim.rotor))
    }

    /// State space of one blade about the trim, flaps at rest, the inflow held.
    ///
    /// # Errors
    /// As [`RotorSolver::state_space`].
    pub fn state_space(&self) -> Result<BladeStateSpace, ResponseError> {
        self.solver.state_space(&self.flaps_at_rest(), &self.trim.rotor)
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
        let mut condition = self.flaps_at_rest();
        condition.controls.theta0_rad += unlike.pitch_rad;
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

    /// The same of a response to flap motions of its own, rad.
    ///
    /// # Errors
    /// As [`RotorSolver::station_loads`].
    pub fn station_loads_with(
        &self,
        flap_angles_rad: Vec<HarmonicSeries>,
        response: &RotorSolution,
        stations: &[f64],
    ) -> Result<Vec<StationLoads>, ResponseError> {
        self.solver.station_loads(&self.condition(flap_angles_rad), response, stations)
    }

    /// Airloads at stations (R) of the lifting part of the blade, and the motion of its tip, flaps at rest, at so many equal
    /// azimuths.
    ///
    /// # Errors
    /// As [`RotorSolver::airloads`].
    pub fn airloads(
        &self,
        stations: &[f64],
        tip_mach: f64,
        azimuths: usize,
    ) -> Result<(Vec<StationAirloads>, Vec<TipMotion>), ResponseError> {
        let still = vec![HarmonicSeries::zero(0); self.rotor().model().flaps.len()];
        self.airloads_with((still, &self.trim.rotor), stations, tip_mach, azimuths)
    }

    /// The same of a response to flap motions of its own, rad.
    ///
    /// # Errors
    /// As [`RotorSolver::airloads`].
    pub fn airloads_with(
        &self,
        (flap_angles_rad, response): (Vec<HarmonicSeries>, &RotorSolution),
        stations: &[f64],
        tip_mach: f64,
        azimuths: usize,
    ) -> Result<(Vec<StationAirloads>, Vec<TipMotion>), ResponseError> {
        let condition = self.condition(flap_angles_rad);
        let loads = self.solver.airloads(&condition, response, stations, (tip_mach, azimuths))?;
        Ok((loads, self.solver.tip_motion(response, azimuths)))
    }

    /// Motion of the blade tip of a response, at so many equal azimuths.
    pub fn tip_motion(&self, response: &RotorSolution, azimuths: usize) -> Vec<TipMotion> {
        self.solver.tip_motion(response, azimuths)
    }

    pub(super) fn flaps_at_rest(&self) -> Condition {
        self.condition(vec![HarmonicSeries::zero(0); self.rotor().model().flaps.len()])
    }

    /// Controls and attitude of the trim with flaps that move.
    pub(super) fn condition(&self, flap_angles_rad: Vec<HarmonicSeries>) -> Condition {
        Condition {
            bank_rad: self.trim.attitude.roll_rad,
            flight: self.trim.flight,
            controls: self.trim.controls,
            flap_angles_rad,
        }
    }

    /// A solver for every unlike blade of a case, at the advance ratio of this trim.
    ///
    /// # Errors
    /// [`StudyError::Blade`] and [`StudyError::Response`].
    pub fn unlike_solvers(&self, case: &Case) -> Result<Vec<UnlikeSolver>, StudyError> {
        let (mu, tolerances) = (self.trim.flight.advance_ratio, case.response_tolerances());
        let rotors = dissimilar_rotors(case, self.trim.controls.theta0_rad)?;
        let each = rotors.into_iter().zip(&case.rotor.dissimilar_blades);
        each.map(|((field, rotor), own)| {
            let (position, flap_motion) = (own.blade - 1, own.flap_motion);
            let pitch_rad = own.pitch_deg.to_radians();
            let solver = RotorSolver::new(Arc::new(rotor), mu, tolerances)
                .map_err(|source| StudyError::Response { field, source })?
                .with_root_pitch(case.root_pitch_rad());
            Ok(UnlikeSolver { position, flap_motion, pitch_rad, solver })
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
        let condition = |factor: f64, pitch_rad: f64| {
            let angles = flap_angles_rad.iter().map(|angle| scaled(angle, factor)).collect();
            let mut own = self.condition(angles);
            own.controls.theta0_rad += pitch_rad;
            own
        };
        let mut others: Vec<OtherBlade> = unlike
            .iter()
            .map(|one| OtherBlade {
                position: one.position,
                solver: one.solver.clone(),
                condition: condition(one.flap_motion, one.pitch_rad),
            })
            .collect();
        let mut alike = self.solver.clone();
        dissimilar_hub_loads(&mut alike, (&condition(1.0, 0.0), about), &mut others)
    }

    /// Root loads of one blade, its flaps moving (rad), controls, attitude and inflow as trimmed.
    ///
    /// # Errors
    /// The errors of the response.
    pub fn blade_root_loads(
        &self,
        flap_angles_rad: Vec<HarmonicSeries>,
    ) -> Result<SixLoads, ResponseError> {
        self.solver.clone().blade_loads(&self.condition(flap_angles_rad), &self.trim.rotor)
    }

    /// Root loads of a blade unlike the rest, its flaps moving (rad), controls, attitude and inflow as trimmed.
    ///
    /// # Errors
    /// The errors of the response.
    pub fn unlike_root_loads(
        &self,
        unlike: &UnlikeSolver,
        flap_angles_rad: Vec<HarmonicSeries>,
    ) -> Result<SixLoads, ResponseError> {
        let mut condition = self.condition(flap_angles_rad);
        condition.controls.theta0_rad += unlike.pitch_rad;
        unlike.solver.clone().blade_loads(&condition, &self.trim.rotor)
    }

    /// Response with moving flaps: pilot controls and attitude as trimmed, inflow settled anew.
    ///
    /// Starts from what the linearised rotor makes of the trimmed orbit and its inflow, where sections may stall from these
    /// themselves, with the trim's factorisation: whatever was solved before.
    ///
    /// # Errors
    /// The errors of the response.
    pub fn with_flaps(
        &self,
        flap_angles_rad: Vec<HarmonicSeries>,
    ) -> Result<RotorSolution, ResponseError> {
        let trimmed = &self.trim.rotor;
        if !self.rotor().model().nonlinear.is_linear() {
            // sections that stall may have more than one orbit: their way is left alone
            return self.with_flaps_from(flap_angles_rad, trimmed);
        }
        let start = self.linearised(InflowState::Settled)?.start(trimmed, &flap_angles_rad)?;
        self.with_flaps_from(flap_angles_rad, &start)
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
        self.solver.clone().solve(
            &self.condition(flap_angles_rad),
            self.inflow.as_ref(),
            Some(start),
        )
    }
}

/// The solver of a blade unlike the rest.
#[derive(Debug, Clone)]
pub struct UnlikeSolver {
    position: usize,
    flap_motion: f64,
    /// Pitch beyond that of the others.
    pitch_rad: f64,
    solver: RotorSolver,
}
