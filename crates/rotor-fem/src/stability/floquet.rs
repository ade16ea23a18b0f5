//! Stability of a periodic orbit: monodromy matrix and Floquet exponents of its linearisation.

use std::f64::consts::TAU;

use faer::Mat;
use nalgebra::{Complex, DMatrix};
use rotor_base::{LagrangeBasis, gauss_legendre};

use crate::{FemError, LocalTangent, TimeElements};

/// Stages of the Gauss collocation that carries a motion over a step (order eight).
pub(crate) const STAGES: usize = 4;
/// Largest angle, rad, that the fastest motion of the linearisation turns in one step.
const LARGEST_ANGLE_PER_STEP: f64 = 0.7;
/// A multiplier smaller than this fraction of the largest is lost in its round-off.
const ROUND_OFF: f64 = 1e-13;

/// One motion `e^(s psi) p(psi)` of the linearised system, `p` with period 2 pi.
///
/// Conjugate pairs appear once, with a frequency that is not negative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FloquetMode {
    /// Factor by which the motion grows and turns in one revolution.
    pub multiplier: Complex<f64>,
    /// Real part of the exponent `s`, per rad of azimuth: negative when the motion dies out.
    pub growth_per_rad: f64,
    /// Imaginary part of `s`, per rev, 0 to 0.5: a frequency is known up to whole numbers and sign,
    /// because the periodic part can carry any of them.
    pub frequency_per_rev: f64,
    /// Degree of freedom with the largest part of the motion (by kinetic energy scale) at azimuth 0.
    pub leading_dof: usize,
}

/// Monodromy matrix of a linearised periodic system and its motions.
#[derive(Debug, Clone, PartialEq)]
pub struct Floquet {
    monodromy: DMatrix<f64>,
    modes: Vec<FloquetMode>,
}

impl Floquet {
    /// Stability of `M q'' + f(q, q', q'', psi) = 0` about the orbit at which the tangents of `f` were
    /// taken.
    ///
    /// ```text
    /// (M + f_q'') x'' + f_q' x' + f_q x = 0,   [x; x'](2 pi) = monodromy [x; x'](0)
    /// ```
    /// The tangents at the Gauss points of the mesh are interpolated inside each time element and the
    /// equation is integrated by four-stage Gauss collocation, in steps in which the fastest motion
    /// turns at most 0.7 rad. The growth of undamped motions is exact by construction.
    ///
    /// | argument | shape | unit |
    /// |---|---|---|
    /// | `mass` | `dof x dof` | rotor units |
    /// | `tangents` | one per Gauss point | rotor units, per rad |
    ///
    /// Not modelled: whatever the tangents leave out.
    ///
    /// Source: Hairer and Wanner, Solving Ordinary Differential Equations II, section IV.5 (Gauss
    /// methods); Johnson, Helicopter Theory (1980), section 8-6 (Floquet theory).
    ///
    /// # Errors
    /// [`FemError::Tangents`] when number or shape of the tangents does not fit or a number is not
    /// finite, [`FemError::MassSingular`], [`FemError::Eigen`].
    pub fn of(
        time: &TimeElements,
        mass: &DMatrix<f64>,
        tangents: &[LocalTangent],
    ) -> Result<Self, FemError> {
        let dof = mass.nrows();
        check(time, dof, tangents)?;
        let rule = gauss_legendre(time.gauss_per_element());
        let basis = LagrangeBasis::new(rule.nodes);
        let stepper = Stepper::new();
        let length = TAU / time.elements() as f64;
        let mut monodromy = DMatrix::identity(2 * dof, 2 * dof);
        for (e, element) in tangents.chunks_exact(time.gauss_per_element()).enumerate() {
            let steps = steps_of(mass, element, length)
                .ok_or(FemError::MassSingular { azimuth_rad: e as f64 * length })?;
            for step in 0..steps {
                let from = step as f64 / steps as f64;
                let equations = stepper.nodes.map(|c| {
                    let place = 2.0 * (from + c / steps as f64) - 1.0;
                    Coefficients::interpolate(mass, element, &basis.evaluate(place))
                });
                monodromy = stepper
                    .carry(&equations, length / steps as f64, &monodromy)
                    .ok_or(FemError::MassSingular { azimuth_rad: (e as f64 + from) * length })?;
            }
        }
        let modes = motions(&monodromy, mass, 2 * dof)?;
        Ok(Self { monodromy, modes })
    }

    pub(crate) fn from_parts(monodromy: DMatrix<f64>, modes: Vec<FloquetMode>) -> Self {
        Self { monodromy, modes }
    }

    /// The matrix that carries displacements and rates over one revolution from azimuth 0, shape
    /// `2 dof x 2 dof`; of a system with lags these follow as further states.
    pub fn monodromy(&self) -> &DMatrix<f64> {
        &self.monodromy
    }

    /// The motions, fastest growing (least damped) first.
    pub fn modes(&self) -> &[FloquetMode] {
        &self.modes
    }

    /// The largest real part of the exponents, per rad: negative when the orbit is stable.
    pub fn largest_growth_per_rad(&self) -> f64 {
        self.modes.first().map_or(f64::NEG_INFINITY, |mode| mode.growth_per_rad)
    }
}

/// Refuses tangents of the wrong number, shape or value.
pub(crate) fn check(
    time: &TimeElements,
    dof: usize,
    tangents: &[LocalTangent],
) -> Result<(), FemError> {
    let (found, expected) = (tangents.len(), time.points().len());
    if found != expected {
        return Err(FemError::Tangents { what: "number", point: 0, found, expected });
    }
    for (point, tangent) in tangents.iter().enumerate() {
        for matrix in [&tangent.dq, &tangent.dqd, &tangent.dqdd] {
            let (found, expected) = (matrix.len(), dof * dof);
            if matrix.shape() != (dof, dof) {
                return Err(FemError::Tangents { what: "entries", point, found, expected });
            }
            let found = matrix.iter().filter(|v| v.is_finite()).count();
            if found != expected {
                return Err(FemError::Tangents { what: "finite entries", point, found, expected });
            }
        }
    }
    Ok(())
}

/// Steps in which the fastest motion of an element's mean equation turns little; none if the mass
/// matrix is singular.
fn steps_of(mass: &DMatrix<f64>, element: &[LocalTangent], length: f64) -> Option<usize> {
    let share = 1.0 / element.len() as f64;
    let mean = element.iter().map(|t| (share, t));
    let c = Coefficients::sum(mass, mean);
    let lu = c.mass.lu();
    let (stiffness, damping) = (lu.solve(&c.stiffness)?, lu.solve(&c.damping)?);
    // a bound on the moduli of the eigenvalues of [0 1; -K -C]: Frobenius norms of the blocks
    let fastest = damping.norm() + stiffness.norm().sqrt();
    let steps = (fastest * length / LARGEST_ANGLE_PER_STEP).ceil().clamp(1.0, 1e5);
    #[expect(
        clippy::cast_possible_truncation,
        clippy::cast_sign_loss,
        reason = "clamped to 1..=1e5 and finite because the tangents are"
    )]
    Some(steps as usize)
}

/// `mass x'' + damping x' + stiffness x = 0` at one azimuth.
pub(crate) struct Coefficients {
    pub(crate) mass: DMatrix<f64>,
    pub(crate) damping: DMatrix<f64>,
    pub(crate) stiffness: DMatrix<f64>,
}

impl Coefficients {
    fn sum<'a>(mass: &DMatrix<f64>, parts: impl Iterator<Item = (f64, &'a LocalTangent)>) -> Self {
        let zero = DMatrix::zeros(mass.nrows(), mass.ncols());
        let mut out = Self { mass: mass.clone(), damping: zero.clone(), stiffness: zero };
        for (weight, tangent) in parts {
            out.mass += &tangent.dqdd * weight;
            out.damping += &tangent.dqd * weight;
            out.stiffness += &tangent.dq * weight;
        }
        out
    }

    pub(crate) fn interpolate(
        mass: &DMatrix<f64>,
        element: &[LocalTangent],
        shapes: &[[f64; 3]],
    ) -> Self {
        Self::sum(mass, shapes.iter().map(|s| s[0]).zip(element))
    }
}

/// Gauss collocation of a second-order equation on the unit step.
pub(crate) struct Stepper {
    pub(crate) nodes: [f64; STAGES],
    pub(crate) weights: [f64; STAGES],
    /// Integrals of the stage polynomials up to each node.
    pub(crate) once: [[f64; STAGES]; STAGES],
    /// The same integrated twice.
    pub(crate) twice: [[f64; STAGES]; STAGES],
    /// Integrals of `once` over the whole step.
    pub(crate) end_twice: [f64; STAGES],
}

impl Stepper {
    pub(crate) fn new() -> Self {
        let rule = gauss_legendre(STAGES);
        let rows = LagrangeBasis::new(rule.nodes.clone()).integration_matrix();
        let array = |f: &dyn Fn(usize) -> f64| std::array::from_fn::<f64, STAGES, _>(f);
        let nodes = array(&|i| 0.5 * (rule.nodes[i] + 1.0));
        let weights = array(&|i| 0.5 * rule.weights[i]);
        let once: [[f64; STAGES]; STAGES] = std::array::from_fn(|i| array(&|j| 0.5 * rows[i][j]));
        let twice =
            std::array::from_fn(|i| array(&|j| (0..STAGES).map(|k| once[i][k] * once[k][j]).sum()));
        let end_twice = array(&|j| (0..STAGES).map(|k| weights[k] * once[k][j]).sum());
        Self { nodes, weights, once, twice, end_twice }
    }

    /// The columns of `state` (displacements over rates) a step later; none if a stage cannot be solved.
    fn carry(
        &self,
        equations: &[Coefficients; STAGES],
        step: f64,
        state: &DMatrix<f64>,
    ) -> Option<DMatrix<f64>> {
        let (dof, columns) = (state.nrows() / 2, state.ncols());
        let (x, v) = (state.rows(0, dof), state.rows(dof, dof));
        let mut matrix = DMatrix::zeros(STAGES * dof, STAGES * dof);
        let mut right = DMatrix::zeros(STAGES * dof, columns);
        for (i, c) in equations.iter().enumerate() {
            for j in 0..STAGES {
                let mut block = &c.damping * (step * self.once[i][j])
                    + &c.stiffness * (step * step * self.twice[i][j]);
                if i == j {
                    block += &c.mass;
                }
                matrix.view_mut((i * dof, j * dof), (dof, dof)).copy_from(&block);
            }
            let load = &c.damping * v + &c.stiffness * (x + v * (step * self.nodes[i]));
            right.rows_mut(i * dof, dof).copy_from(&-load);
        }
        let stages = matrix.lu().solve(&right)?;
        let mut next = state.clone();
        let mut moved = x + v * step;
        let mut rates = v.into_owned();
        for j in 0..STAGES {
            let stage = stages.rows(j * dof, dof);
            moved += stage * (step * step * self.end_twice[j]);
            rates += stage * (step * self.weights[j]);
        }
        next.rows_mut(0, dof).copy_from(&moved);
        next.rows_mut(dof, dof).copy_from(&rates);
        Some(next)
    }
}

/// The motions of a monodromy matrix, one of each conjugate pair, fastest growing first: the `kept` ones in which
/// displacements and rates, which come before other states, participate most.
pub(crate) fn motions(
    monodromy: &DMatrix<f64>,
    mass: &DMatrix<f64>,
    kept: usize,
) -> Result<Vec<FloquetMode>, FemError> {
    let (size, dof) = (monodromy.nrows(), mass.nrows());
    let matrix = Mat::from_fn(size, size, |i, j| monodromy[(i, j)]);
    let eigen = matrix.eigen().map_err(|_| FemError::Eigen { size })?;
    let (values, vectors) = (eigen.S().column_vector(), eigen.U());
    let largest = (0..size).map(|k| values[k].norm()).fold(0.0, f64::max);
    let mut order: Vec<(usize, f64)> = (0..size).map(|k| (k, 1.0)).collect();
    if kept < size {
        // how much of a motion is motion of the blade: left times right eigenvector over its states
        let right = DMatrix::from_fn(size, size, |i, k| {
            Complex::new(vectors[(i, k)].re, vectors[(i, k)].im)
        });
        let states = DMatrix::<Complex<f64>>::identity(size, 2 * dof);
        let left = right.clone().lu().solve(&states).ok_or(FemError::Eigen { size })?;
        for (k, share) in &mut order {
            let of = |i: usize| left[(*k, i)] * right[(i, *k)];
            *share = (0..2 * dof).map(of).sum::<Complex<f64>>().norm();
        }
        order.sort_by(|a, b| b.1.total_cmp(&a.1));
    }
    let kept: Vec<usize> =
        order.into_iter().take(kept).map(|(k, _)| k).filter(|&k| values[k].im >= 0.0).collect();
    let energies: Vec<Vec<f64>> = kept
        .iter()
        .map(|&k| {
            let energy: Vec<f64> =
                (0..dof).map(|i| vectors[(i, k)].norm_sqr() * mass[(i, i)]).collect();
            let whole = energy.iter().sum::<f64>().max(f64::MIN_POSITIVE);
            energy.into_iter().map(|part| part / whole).collect()
        })
        .collect();
    let pairs: Vec<bool> = kept.iter().map(|&k| values[k].im > 0.0).collect();
    let leaders = leaders(&energies, &pairs);
    let mut modes: Vec<FloquetMode> = kept
        .iter()
        .zip(leaders)
        .map(|(&k, leading_dof)| {
            let multiplier = Complex::new(values[k].re, values[k].im);
            let size = multiplier.norm().max(ROUND_OFF * largest);
            FloquetMode {
                multiplier,
                growth_per_rad: size.ln() / TAU,
                frequency_per_rev: multiplier.arg().abs() / TAU,
                leading_dof,
            }
        })
        .collect();
    modes.sort_by(|a, b| b.growth_per_rad.total_cmp(&a.growth_per_rad));
    Ok(modes)
}

/// Which degree of freedom leads each motion: the largest share of energy first, no degree of freedom more than
/// one conjugate pair, or two real motions.
fn leaders(shares: &[Vec<f64>], pairs: &[bool]) -> Vec<usize> {
    let dof = shares.first().map_or(0, Vec::len);
    let mut claims: Vec<(usize, usize)> =
        (0..shares.len()).flat_map(|k| (0..dof).map(move |i| (k, i))).collect();
    claims.sort_by(|&(k, i), &(l, j)| shares[l][j].total_cmp(&shares[k][i]));
    let mut room = vec![2_u8; dof];
    let mut found: Vec<Option<usize>> = vec![None; shares.len()];
    for (k, i) in claims {
        let needed = if pairs[k] { 2 } else { 1 };
        if found[k].is_none() && room[i] >= needed {
            (found[k], room[i]) = (Some(i), room[i] - needed);
        }
    }
    // one that found no room keeps its largest share
    let largest = |k: usize| {
        (0..dof).max_by(|&i, &j| shares[k][i].total_cmp(&shares[k][j])).unwrap_or_default()
    };
    found.iter().enumerate().map(|(k, leader)| leader.unwrap_or_else(|| largest(k))).collect()
}
