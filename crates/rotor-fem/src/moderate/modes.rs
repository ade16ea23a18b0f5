//! Modes about the deflected rotating blade.

use nalgebra::{Complex, DMatrix, DVector};

use super::{ModerateModel, NodalMotion, PitchMotion, StaticState};
use crate::beam::assembly::{dof_kind, restrict};
use crate::modes::coupled::ModeProblem;
use crate::modes::mode_set::shift;
use crate::{CoupledMode, FemError, GyroscopicTerms, ModeCount, ModeKind};

/// What becomes of the axial motion in the modes.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AxialMotion {
    /// It is free: axial modes exist.
    #[default]
    Free,
    /// It follows bending and twist without inertia of its own: foreshortening, and the stretch under
    /// the Coriolis force. There are no axial modes.
    Condensed,
}

/// Modes of small motion about a static state: those wanted of each family, in the order flap, lag,
/// torsion, axial, each lowest frequency first.
///
/// The state need not be that of the model's own pitch; its pitch is used.
///
/// # Errors
/// [`FemError::NotStable`] when the stiffness about the state has a negative direction,
/// [`FemError::TooFewModes`], [`FemError::Eigen`], [`FemError::DofCount`] for the state of another
/// model.
pub fn deflected_modes(
    model: &ModerateModel,
    state: &StaticState,
    terms: GyroscopicTerms,
    axial: AxialMotion,
    count: ModeCount,
) -> Result<Vec<CoupledMode>, FemError> {
    if state.dof.len() != model.size() {
        let (found, expected) = (state.dof.len(), model.size());
        return Err(FemError::DofCount { field: "state", found, expected });
    }
    let pitch = PitchMotion::steady(state.pitch_rad);
    let about = model.tangents(&NodalMotion::steady(state.dof.clone()), pitch);
    let free = model.free();
    let whole = ModeProblem {
        size: model.size(),
        free: free.to_vec(),
        mass: restrict(&about.mass, free),
        stiffness: restrict(&about.stiffness, free),
        gyroscopic: restrict(&about.damping, free),
        shift: shift(model.blade().properties()),
        rotor_speed: model.blade().properties().spec().rotor_speed,
    };
    match axial {
        AxialMotion::Free => whole.solve(terms, count),
        AxialMotion::Condensed => {
            let condensed = Condensed::new(&whole, terms)?;
            let mut found = condensed.problem.solve(terms, count)?;
            for mode in &mut found {
                condensed.add_axial(mode, terms);
            }
            Ok(found)
        }
    }
}

/// The problem without axial degrees of freedom.
///
/// ```text
/// u = -K_uu^-1 (K_ub b + G_ub b')
/// M = T^T M T + G_ub^T K_uu^-1 G_ub,  G = T^T G T,  K = T^T K T,   T = [1; -K_uu^-1 K_ub]
/// ```
/// The second part of the mass is the stretch under the Coriolis force: without it a blade of finite
/// axial stiffness has its lag frequencies too high.
struct Condensed {
    problem: ModeProblem,
    /// Axial degrees of freedom.
    axial: Vec<usize>,
    /// `K_uu^-1 K_ub` and `K_uu^-1 G_ub`.
    follows: [DMatrix<f64>; 2],
}

impl Condensed {
    fn new(whole: &ModeProblem, terms: GyroscopicTerms) -> Result<Self, FemError> {
        let places = |axial: bool| -> Vec<usize> {
            let is_axial = |i: &usize| (dof_kind(whole.free[*i]) == ModeKind::Axial) == axial;
            (0..whole.free.len()).filter(is_axial).collect()
        };
        let (u, b) = (places(true), places(false));
        let part = |matrix: &DMatrix<f64>, rows: &[usize], columns: &[usize]| {
            DMatrix::from_fn(rows.len(), columns.len(), |i, j| matrix[(rows[i], columns[j])])
        };
        let factor = part(&whole.stiffness, &u, &u)
            .cholesky()
            .ok_or(FemError::NotStable { squared_frequency: 0.0 })?;
        let coriolis = part(&whole.gyroscopic, &u, &b);
        let bending = factor.solve(&part(&whole.stiffness, &u, &b));
        let stretch = factor.solve(&coriolis);
        let congruence = |matrix: &DMatrix<f64>| {
            let (ub, bu) = (part(matrix, &u, &b), part(matrix, &b, &u));
            part(matrix, &b, &b) - bending.transpose() * &ub - &bu * &bending
                + bending.transpose() * part(matrix, &u, &u) * &bending
        };
        let mut mass = congruence(&whole.mass);
        if terms == GyroscopicTerms::Included {
            mass += coriolis.transpose() * &stretch;
        }
        let of = |list: &[usize]| list.iter().map(|i| whole.free[*i]).collect();
        let problem = ModeProblem {
            size: whole.size,
            free: of(&b),
            mass,
            stiffness: congruence(&whole.stiffness),
            gyroscopic: congruence(&whole.gyroscopic),
            shift: whole.shift,
            rotor_speed: whole.rotor_speed,
        };
        Ok(Self { problem, axial: of(&u), follows: [bending, stretch] })
    }

    /// Gives a mode the axial motion that follows its bending.
    fn add_axial(&self, mode: &mut CoupledMode, terms: GyroscopicTerms) {
        let shape: DVector<Complex<f64>> = DVector::from_iterator(
            self.problem.free.len(),
            self.problem.free.iter().map(|&i| Complex::new(mode.in_phase[i], mode.quadrature[i])),
        );
        let [bending, stretch] = &self.follows;
        let rate = match terms {
            GyroscopicTerms::Neglected => 0.0,
            GyroscopicTerms::Included => mode.frequency,
        };
        for (k, &i) in self.axial.iter().enumerate() {
            let mut u = Complex::new(0.0, 0.0);
            for (j, b) in shape.iter().enumerate() {
                u -= b * Complex::new(bending[(k, j)], rate * stretch[(k, j)]);
            }
            mode.in_phase[i] = u.re;
            mode.quadrature[i] = u.im;
        }
    }
}
