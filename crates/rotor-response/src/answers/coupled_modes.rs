//! Coupled modes of the blade in the coordinates of the response, and the search for a resonance among them.

use crate::structure::equations::Equations;
use crate::{ResponseError, Rotor, RotorSolution};
use nalgebra::{Complex, DMatrix, DVector};
use rotor_fem::{EnergyShares, ModeKind, PitchMotion, oscillations};

/// Distance of an undamped frequency from a harmonic below which the response is none, per rev.
///
/// Its answer is then fifty times that of a still blade or more, and the collective, the twist under air loads
/// and the terms of the couplings carry the frequency as far.
pub const RESONANCE_PER_REV: f64 = 1e-2;
/// Damping over critical below which a response within [`RESONANCE_PER_REV`] of a harmonic is that of its
/// damping, not of its stiffness.
pub const LOW_DAMPING_RATIO: f64 = 1e-3;
/// The same where the response was not found: what is likely to be the reason.
const NEAR_RESONANCE_PER_REV: f64 = 5e-2;
/// Distance over which the collective of a trim may carry a frequency.
const NEARLY_RESONANT_PER_REV: f64 = 0.1;
/// Step of the central differences of the structural equations.
const STEP: f64 = 1e-6;
/// Newton steps to the steady state.
const STEADY_STEPS: usize = 30;
/// Generalised force at which the steady state is found.
const STEADY_FORCE: f64 = 1e-12;

/// A coupled mode of the rotating blade without air: a small motion about the state into which rotation
/// bends it at its pitch, in the coordinates and with the couplings of the response.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct CoupledBladeMode {
    /// Family with most of the kinetic energy.
    pub kind: ModeKind,
    /// Its number in the family, from 1.
    pub number: usize,
    /// Frequency per rev.
    pub frequency_per_rev: f64,
}

/// The steady blade without air at one pitch.
struct Still<'a> {
    rotor: &'a Rotor,
    pitch: PitchMotion,
}

impl<'a> Still<'a> {
    fn new(rotor: &'a Rotor, pitch_rad: f64) -> Self {
        Self { rotor, pitch: PitchMotion::steady(pitch_rad) }
    }

    fn residual(&self, coordinates: [&[f64]; 3]) -> DVector<f64> {
        let mut out = DVector::zeros(coordinates[0].len());
        let (couplings, mass) = (self.rotor.model().couplings, &self.rotor.mass);
        let equations = Equations { blade: self.rotor.blade(), couplings, mass };
        equations.still_residual(coordinates, self.pitch, out.as_mut_slice());
        out
    }

    /// Derivative with respect to displacements (0), rates (1) or accelerations (2) at a steady state.
    fn tangent(&self, q: &DVector<f64>, which: usize) -> DMatrix<f64> {
        let n = q.len();
        let columns: Vec<DVector<f64>> = (0..n)
            .map(|j| {
                let [ahead, behind] = [STEP, -STEP].map(|step| {
                    let mut at = [q.clone(), DVector::zeros(n), DVector::zeros(n)];
                    at[which][j] += step;
                    self.residual(at.each_ref().map(DVector::as_slice))
                });
                (ahead - behind) / (2.0 * STEP)
            })
            .collect();
        DMatrix::from_columns(&columns)
    }

    /// The state into which rotation bends the blade; the straight blade if there is none.
    fn steady(&self) -> DVector<f64> {
        let n = self.rotor.mass.nrows();
        let rest = vec![0.0; n];
        let mut q = DVector::zeros(n);
        for _ in 0..STEADY_STEPS {
            let force = self.residual([q.as_slice(), &rest, &rest]);
            if force.amax() <= STEADY_FORCE {
                return q;
            }
            match self.tangent(&q, 0).lu().solve(&force) {
                Some(step) if step.iter().all(|s| s.is_finite()) => q -= step,
                _ => break,
            }
        }
        if q.amax() < 1.0 { q } else { DVector::zeros(n) }
    }
}

impl Rotor {
    /// Coupled modes of the blade without air at a root pitch, lowest frequency first: what the response
    /// oscillates in, apart from air and damping; about the mean deflection in flight, or in still air.
    fn coupled_modes(
        &self,
        pitch_rad: f64,
        flight: Option<&RotorSolution>,
    ) -> Result<Vec<CoupledBladeMode>, ResponseError> {
        let still = Still::new(self, pitch_rad);
        let state = match flight {
            None => still.steady(),
            Some(found) => {
                DVector::from_iterator(found.modal.len(), found.modal.iter().map(|q| q.mean))
            }
        };
        let [stiffness, damping, apparent] = [0, 1, 2].map(|k| still.tangent(&state, k));
        let mass = &self.mass + apparent;
        let mut found: Vec<CoupledBladeMode> = Vec::new();
        for oscillation in oscillations(&mass, &damping, &stiffness)? {
            let kind = self.leading_family(&mass, &oscillation.shape);
            let number = 1 + found.iter().filter(|mode| mode.kind == kind).count();
            let frequency_per_rev = oscillation.exponent.im;
            found.push(CoupledBladeMode { kind, number, frequency_per_rev });
        }
        Ok(found)
    }

    /// The family with most of the kinetic energy of a shape.
    fn leading_family(&self, mass: &DMatrix<f64>, shape: &[Complex<f64>]) -> ModeKind {
        let moved = mass.map(Complex::from) * DVector::from_column_slice(shape);
        let energy = |kind: ModeKind| -> f64 {
            let parts = shape.iter().zip(moved.iter()).enumerate();
            let own = parts.filter(|(i, _)| self.blade().mode(*i).0 == kind);
            own.map(|(_, (a, b))| (a.conj() * b).re).sum()
        };
        let [flap, lag, torsion, axial] = ModeKind::ALL.map(energy);
        EnergyShares { flap, lag, torsion, axial }.leader()
    }

    /// Whether nothing but the air damps the lag modes, or a mode has no frequency.
    fn may_resonate(&self) -> bool {
        let uncoupled = self.blade().frequencies_per_rev();
        let free = [ModeKind::Flap, ModeKind::Lag].map(|kind| self.blade().turns_freely((kind, 1)));
        self.model().modal_damping == 0.0
            || free.contains(&true)
            || uncoupled.iter().any(|f| *f < RESONANCE_PER_REV)
    }

    /// The mode within a distance of a harmonic that nothing damps, about the mean deflection in flight or in
    /// still air.
    fn resonance(
        &self,
        pitch_rad: f64,
        flight: Option<&RotorSolution>,
        within_per_rev: f64,
    ) -> Result<Option<ResponseError>, ResponseError> {
        if !self.may_resonate() {
            return Ok(None);
        }
        let model = self.model();
        let modes = self.coupled_modes(pitch_rad, flight)?;
        Ok(modes.into_iter().find_map(|CoupledBladeMode { kind, number, frequency_per_rev }| {
            let harmonic = frequency_per_rev.round();
            // damping is a share of the frequency; flap and torsion are damped by the air
            let free = harmonic == 0.0
                || ((model.modal_damping == 0.0 || self.blade().turns_freely((kind, number)))
                    && (kind == ModeKind::Lag || model.lock_number == 0.0)
                    && !(kind == ModeKind::Lag && model.lag_damper > 0.0));
            let near = (frequency_per_rev - harmonic).abs() < within_per_rev;
            (free && near).then_some(ResponseError::Resonance {
                kind,
                number,
                frequency_per_rev,
                pitch_deg: pitch_rad.to_degrees(),
            })
        }))
    }

    /// Refuses a blade with a coupled mode at a harmonic of the rotor speed, the steady one included, that
    /// nothing damps: its response has no bound. Lag modes without modal damping, which the air hardly
    /// damps; any mode without air and modal damping, or without a frequency.
    ///
    /// # Errors
    /// [`ResponseError::Resonance`] with mode, frequency and pitch, [`ResponseError::Fem`] if the equations of
    /// small motion have no solution.
    pub fn refuse_resonance(&self, pitch_rad: f64) -> Result<(), ResponseError> {
        self.resonance(pitch_rad, None, RESONANCE_PER_REV)?.map_or(Ok(()), Err)
    }

    /// The same about the mean deflection of a blade in flight, air loads included.
    ///
    /// # Errors
    /// As [`Self::refuse_resonance`].
    pub fn refuse_resonance_in_flight(
        &self,
        pitch_rad: f64,
        flight: &RotorSolution,
    ) -> Result<(), ResponseError> {
        self.resonance(pitch_rad, Some(flight), RESONANCE_PER_REV)?.map_or(Ok(()), Err)
    }

    /// Whether an undamped mode is so near a harmonic that the collective of a trim decides: a trim with
    /// damping finds it first.
    pub fn nearly_resonates(&self, pitch_rad: f64) -> bool {
        matches!(self.resonance(pitch_rad, None, NEARLY_RESONANT_PER_REV), Ok(Some(_)))
    }

    /// A lag mode within [`RESONANCE_PER_REV`] of a harmonic that next to nothing damps ([`LOW_DAMPING_RATIO`]),
    /// about the mean deflection in flight, or in still air: its response is bounded, but by that damping
    /// alone. None with no damping at all, which is refused.
    ///
    /// # Errors
    /// [`ResponseError::Fem`] if the equations of small motion have no solution.
    pub fn lightly_damped_at_a_harmonic(
        &self,
        pitch_rad: f64,
        flight: Option<&RotorSolution>,
    ) -> Result<Option<CoupledBladeMode>, ResponseError> {
        let damping = self.model().modal_damping;
        if damping == 0.0 || damping >= LOW_DAMPING_RATIO || self.model().lag_damper > 0.0 {
            return Ok(None);
        }
        let modes = self.coupled_modes(pitch_rad, flight)?;
        let airless = self.model().lock_number == 0.0;
        Ok(modes.into_iter().find(|mode| {
            let frequency = mode.frequency_per_rev;
            (mode.kind == ModeKind::Lag || airless)
                && frequency.round() > 0.0
                && (frequency - frequency.round()).abs() < RESONANCE_PER_REV
        }))
    }

    /// Why a response was not found: an undamped mode near a harmonic in place of a failure to converge.
    #[must_use]
    pub fn blame_resonance(&self, pitch_rad: f64, error: ResponseError) -> ResponseError {
        if matches!(error, ResponseError::Periodic(_) | ResponseError::InflowNotConverged { .. }) {
            self.likely_resonance(pitch_rad).unwrap_or(error)
        } else {
            error
        }
    }

    /// An undamped mode near enough to a harmonic to be the reason of a search that failed, within 0.05 per
    /// rev: [`ResponseError::Resonance`].
    pub fn likely_resonance(&self, pitch_rad: f64) -> Option<ResponseError> {
        self.resonance(pitch_rad, None, NEAR_RESONANCE_PER_REV).ok().flatten()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Couplings, Discretisation, RotorModel};
    use approx::assert_abs_diff_eq;
    use rotor_fem::{
        BladeProperties, BladeSpec, GyroscopicTerms, ModeCount, ModerateBlade, ModerateModel,
        ModerateSpec, StaticSettings, TorsionTerms, deflected_modes,
    };

    fn rotor(couplings: Couplings, ei_lag: f64, modal_damping: f64) -> Rotor {
        let spec = BladeSpec { lag_stiffness: ei_lag.into(), ..BladeSpec::table_1() };
        let model = RotorModel { modal_damping, ..RotorModel::table_1(couplings) };
        let blade = BladeProperties::new(spec).unwrap();
        let few = Discretisation { modes: [5, 2, 2], ..Discretisation::default() };
        Rotor::new(model, &blade, few).unwrap()
    }

    /// The lag stiffness with which a frequency that grows with it is 1 per rev.
    fn tuned(frequency: impl Fn(f64) -> f64) -> f64 {
        let (mut low, mut high) = (0.03, 0.12);
        assert!(frequency(low) < 1.0 && frequency(high) > 1.0);
        for _ in 0..30 {
            let middle = 0.5 * (low + high);
            *if frequency(middle) < 1.0 { &mut low } else { &mut high } = middle;
        }
        low
    }

    fn moderate(ei_lag: f64, modal_damping: f64) -> Rotor {
        rotor(Couplings::Moderate(TorsionTerms::default()), ei_lag, modal_damping)
    }

    /// The lowest coupled modes are those of the finite elements about the deflected blade.
    #[test]
    fn reduced_modes_are_those_of_the_elements() {
        let pitch = 8.0_f64.to_radians();
        let blade = BladeProperties::new(BladeSpec::table_1()).unwrap();
        let couplings = Couplings::Moderate(TorsionTerms::default());
        let rotor =
            Rotor::new(RotorModel::table_1(couplings), &blade, Discretisation::default()).unwrap();
        let found = rotor.coupled_modes(pitch, None).unwrap();
        let spec = ModerateSpec::from(blade.with_pitch_rad(pitch).unwrap().spec().clone());
        let model = ModerateModel::new(ModerateBlade::new(spec).unwrap(), 10).unwrap();
        let none = DVector::zeros(model.size());
        let state = model.static_state(&none, &StaticSettings::default()).unwrap();
        let count = ModeCount { flap: 3, lag: 2, torsion: 1, axial: 0 };
        let (terms, axial) = (GyroscopicTerms::default(), rotor_fem::AxialMotion::Condensed);
        for mode in deflected_modes(&model, &state, terms, axial, count).unwrap() {
            let nearest = found
                .iter()
                .filter(|m| m.kind == mode.kind)
                .map(|m| (m.frequency_per_rev / mode.per_rev - 1.0).abs())
                .fold(f64::INFINITY, f64::min);
            assert!(nearest < 2e-3, "{:?} {}: {nearest:e}", mode.kind, mode.per_rev);
        }
    }

    /// At pitch the coupled lag mode is elsewhere than the uncoupled one: the coupled one counts.
    #[test]
    fn the_coupled_mode_is_refused_and_not_the_uncoupled_one() {
        let pitch = 8.0_f64.to_radians();
        let ei_lag = tuned(|ei_lag| {
            let modes = moderate(ei_lag, 0.0).coupled_modes(pitch, None).unwrap();
            let lag = modes.iter().find(|m| (m.kind, m.number) == (ModeKind::Lag, 1));
            lag.unwrap().frequency_per_rev
        });
        let coupled = moderate(ei_lag, 0.0);
        let error = coupled.refuse_resonance(pitch).unwrap_err().to_string();
        assert!(error.starts_with("lag 1 at 8.00 deg has 1.0000 per rev"), "{error}");
        // the same blade at another pitch is off the harmonic, and so is its uncoupled mode
        coupled.refuse_resonance(0.0).unwrap();
        let uncoupled = coupled.blade().frequencies_per_rev()[5];
        assert!((uncoupled - 1.0).abs() > 2e-2, "{uncoupled}");
        moderate(ei_lag, 0.005).refuse_resonance(pitch).unwrap();
        // the blade whose uncoupled mode is at the harmonic
        let full = |ei_lag| rotor(Couplings::Full, ei_lag, 0.0);
        let by_itself = full(tuned(|ei_lag| full(ei_lag).blade().frequencies_per_rev()[5]));
        by_itself.refuse_resonance(pitch).unwrap();
    }

    /// Flap 1 of a hinged blade is at one per rev, and the air damps it; without air nothing does.
    #[test]
    fn a_flap_hinge_at_the_centre_needs_its_air() {
        let root = rotor_fem::RootSupport {
            flap: rotor_fem::Joint::Free,
            ..rotor_fem::RootSupport::CLAMPED
        };
        let blade = BladeProperties::new(BladeSpec { root, ..BladeSpec::table_1() }).unwrap();
        let refused = |lock_number: f64| {
            let model = RotorModel {
                lock_number,
                modal_damping: 0.0,
                ..RotorModel::table_1(Couplings::Linear)
            };
            let rotor = Rotor::new(model, &blade, Discretisation::default()).unwrap();
            rotor.refuse_resonance(0.0)
        };
        refused(5.2).unwrap();
        let error = refused(0.0).unwrap_err();
        assert!(matches!(error, ResponseError::Resonance { kind: ModeKind::Flap, number: 1, .. }));
        let uncoupled = rotor(Couplings::Linear, 0.0268, 0.0).coupled_modes(0.0, None).unwrap();
        assert_abs_diff_eq!(uncoupled[0].frequency_per_rev, 0.7014, epsilon = 1e-4);
    }
}
