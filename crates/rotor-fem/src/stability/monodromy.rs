//! The linearised system carried over one revolution: structure and first-order lags together.
//!
//! ```text
//! (M + f_q'') q'' + f_q' q' + f_q q + sum load gain (x - input . [q; q']) = 0,   x' = a(psi) (input . [q; q'] - x)
//! ```
//! The tangents `f` are those with settled lags, `x = input . [q; q']`. A step of Gauss collocation solves the lags
//! in closed form for the motion at its stages, `X = alpha x0 + B In`, so that the system to be solved has the
//! size of the structure alone.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, Matrix4, RowVector4, Vector4};
use rotor_base::{LagrangeBasis, gauss_legendre};

use crate::{FemError, LocalTangent, TimeElements};

/// Stages of the Gauss collocation that carries a motion over a step (order eight).
const STAGES: usize = 4;
/// Largest angle, rad, that the fastest motion of the linearisation turns in one step.
const LARGEST_ANGLE_PER_STEP: f64 = 0.7;
/// Largest step of a system with lags, rad.
const LARGEST_STEP: f64 = 0.1;

/// One lag: its rate, share of the two inputs of its place, and gain on the two loads there.
#[derive(Debug, Clone, PartialEq)]
pub struct LagChannel {
    /// `a`, per rad of azimuth, at every Gauss point of the mesh.
    pub rates: Vec<f64>,
    /// Share of each input.
    pub input: [f64; 2],
    /// Gain on each load at every Gauss point.
    pub gains: Vec<[f64; 2]>,
}

/// The lags of one place: two inputs made of displacements and rates, two loads on the motion.
#[derive(Debug, Clone, PartialEq)]
pub struct LagPlace {
    /// `2 x 2 dof` at every Gauss point: inputs from displacements, then rates.
    pub inputs: Vec<DMatrix<f64>>,
    /// `dof x 2` at every Gauss point: what the loads do in the residual.
    pub loads: Vec<DMatrix<f64>>,
    /// The lags.
    pub channels: Vec<LagChannel>,
}

/// A lag over one step: at the stages and at the end, from its start and from its input at the stages.
struct LagStep {
    alpha: Vector4<f64>,
    drive: Matrix4<f64>,
    end_start: f64,
    end_drive: RowVector4<f64>,
    input: [f64; 2],
    gains: [[f64; 2]; STAGES],
}

/// The lags of a place over one step.
struct PlaceStep {
    inputs: Vec<DMatrix<f64>>,
    loads: Vec<DMatrix<f64>>,
    lags: Vec<LagStep>,
}

/// States of all solutions, one a row: displacements beside rates, and lags. There are many solutions, as many as lags, so that a
/// column, one unknown of them all, is what is worked on.
struct State {
    motion: DMatrix<f64>,
    lags: DMatrix<f64>,
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
struct Coefficients {
    mass: DMatrix<f64>,
    damping: DMatrix<f64>,
    stiffness: DMatrix<f64>,
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

    fn interpolate(mass: &DMatrix<f64>, element: &[LocalTangent], shapes: &[[f64; 3]]) -> Self {
        Self::sum(mass, shapes.iter().map(|s| s[0]).zip(element))
    }
}

/// Gauss collocation of a second-order equation on the unit step.
struct Stepper {
    nodes: [f64; STAGES],
    weights: [f64; STAGES],
    /// Integrals of the stage polynomials up to each node.
    once: [[f64; STAGES]; STAGES],
    /// The same integrated twice.
    twice: [[f64; STAGES]; STAGES],
    /// Integrals of `once` over the whole step.
    end_twice: [f64; STAGES],
}

impl Stepper {
    fn new() -> Self {
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
}

/// The matrix that carries displacements, rates and lags over one revolution from azimuth 0.
///
/// # Errors
/// [`FemError::MassSingular`].
pub(crate) fn monodromy(
    time: &TimeElements,
    mass: &DMatrix<f64>,
    tangents: &[LocalTangent],
    places: &[LagPlace],
) -> Result<DMatrix<f64>, FemError> {
    let dof = mass.nrows();
    let lags = places.iter().map(|place| place.channels.len()).sum();
    let size = 2 * dof + lags;
    let mut state = State {
        motion: DMatrix::identity(size, 2 * dof),
        lags: DMatrix::from_fn(size, lags, |j, i| f64::from(u8::from(2 * dof + i == j))),
    };
    let gauss = time.gauss_per_element();
    let basis = LagrangeBasis::new(gauss_legendre(gauss).nodes);
    let stepper = Stepper::new();
    let length = TAU / time.elements() as f64;
    let mut lag_steps = 1;
    while length / lag_steps as f64 > LARGEST_STEP {
        lag_steps += 1;
    }
    for (e, element) in tangents.chunks_exact(gauss).enumerate() {
        let steps = if places.is_empty() {
            steps_of(mass, element, length)
                .ok_or(FemError::MassSingular { azimuth_rad: e as f64 * length })?
        } else {
            lag_steps
        };
        let step = length / steps as f64;
        for k in 0..steps {
            let from = k as f64 / steps as f64;
            let singular = FemError::MassSingular { azimuth_rad: (e as f64 + from) * length };
            let shapes =
                stepper.nodes.map(|c| basis.evaluate(2.0 * (from + c / steps as f64) - 1.0));
            let equations = shapes.each_ref().map(|s| Coefficients::interpolate(mass, element, s));
            let at: Vec<PlaceStep> = places
                .iter()
                .map(|place| PlaceStep::new(place, e * gauss, &shapes, &stepper, step))
                .collect::<Option<_>>()
                .ok_or(singular.clone())?;
            state = carry(&stepper, &equations, &at, step, &state).ok_or(singular)?;
        }
    }
    let mut whole = DMatrix::zeros(size, size);
    whole.rows_mut(0, 2 * dof).tr_copy_from(&state.motion);
    whole.rows_mut(2 * dof, lags).tr_copy_from(&state.lags);
    Ok(whole)
}

impl PlaceStep {
    fn new(
        place: &LagPlace,
        first: usize,
        shapes: &[Vec<[f64; 3]>; STAGES],
        stepper: &Stepper,
        step: f64,
    ) -> Option<Self> {
        let matrix = |table: &[DMatrix<f64>], shape: &[[f64; 3]]| {
            let (rows, columns) = table[first].shape();
            shape
                .iter()
                .zip(&table[first..])
                .fold(DMatrix::zeros(rows, columns), |sum: DMatrix<f64>, ([n, ..], m)| sum + m * *n)
        };
        let lags = place
            .channels
            .iter()
            .map(|channel| {
                let sum = |shape: &[[f64; 3]], of: &dyn Fn(usize) -> f64| -> f64 {
                    shape.iter().enumerate().map(|(p, [n, ..])| n * of(first + p)).sum()
                };
                let rates: [f64; STAGES] =
                    std::array::from_fn(|i| sum(&shapes[i], &|p| channel.rates[p]));
                let gains = std::array::from_fn(|i| {
                    [0, 1].map(|o| sum(&shapes[i], &|p| channel.gains[p][o]))
                });
                LagStep::new(stepper, step, rates, channel.input, gains)
            })
            .collect::<Option<_>>()?;
        Some(Self {
            inputs: shapes.iter().map(|s| matrix(&place.inputs, s)).collect(),
            loads: shapes.iter().map(|s| matrix(&place.loads, s)).collect(),
            lags,
        })
    }

    /// Loads at stage `i` from the inputs at stage `j`, beyond those of settled lags.
    fn kernel(&self, i: usize, j: usize) -> DMatrix<f64> {
        let mut kernel = DMatrix::zeros(2, 2);
        for lag in &self.lags {
            let beyond = lag.drive[(i, j)] - f64::from(u8::from(i == j));
            for o in 0..2 {
                for c in 0..2 {
                    kernel[(o, c)] += lag.gains[i][o] * beyond * lag.input[c];
                }
            }
        }
        kernel
    }
}

impl LagStep {
    fn new(
        stepper: &Stepper,
        step: f64,
        rates: [f64; STAGES],
        input: [f64; 2],
        gains: [[f64; 2]; STAGES],
    ) -> Option<Self> {
        let scaled = Matrix4::from_fn(|i, j| step * stepper.once[i][j] * rates[j]);
        let inverse = (Matrix4::identity() + scaled).try_inverse()?;
        let (alpha, drive) = (inverse * Vector4::repeat(1.0), inverse * scaled);
        let weights = RowVector4::from_fn(|_, i| step * stepper.weights[i] * rates[i]);
        let end_start = 1.0 - (weights * alpha)[0];
        Some(Self { alpha, end_start, end_drive: weights - weights * drive, drive, input, gains })
    }
}

/// All solutions a step later; none if a stage cannot be solved.
fn carry(
    stepper: &Stepper,
    equations: &[Coefficients; STAGES],
    places: &[PlaceStep],
    step: f64,
    state: &State,
) -> Option<State> {
    let dof = state.motion.ncols() / 2;
    let stages = stage_accelerations(stepper, equations, places, step, state)?;
    let rates = state.motion.columns(dof, dof);
    // motion beside rates, moved by the accelerations at the stages
    let moved = |after: f64, twice: &[f64; STAGES], once: &[f64; STAGES]| {
        let mut motion = state.motion.clone();
        for c in 0..dof {
            let mut place = motion.column_mut(c);
            place.axpy(after, &rates.column(c), 1.0);
            for (k, share) in twice.iter().enumerate() {
                place.axpy(step * step * share, &stages.column(k * dof + c), 1.0);
            }
            let mut rate = motion.column_mut(dof + c);
            for (k, share) in once.iter().enumerate() {
                rate.axpy(step * share, &stages.column(k * dof + c), 1.0);
            }
        }
        motion
    };
    let at_stage: [DMatrix<f64>; STAGES] = std::array::from_fn(|j| {
        moved(step * stepper.nodes[j], &stepper.twice[j], &stepper.once[j])
    });
    let mut lags = state.lags.clone();
    let mut first = 0;
    for place in places {
        let inputs: Vec<DMatrix<f64>> =
            place.inputs.iter().zip(&at_stage).map(|(c, motion)| motion * c.transpose()).collect();
        for (k, lag) in place.lags.iter().enumerate() {
            let mut own = lags.column_mut(first + k);
            own *= lag.end_start;
            for (j, input) in inputs.iter().enumerate() {
                for (c, share) in lag.input.iter().enumerate() {
                    own.axpy(lag.end_drive[j] * share, &input.column(c), 1.0);
                }
            }
        }
        first += place.lags.len();
    }
    Some(State { motion: moved(step, &stepper.end_twice, &stepper.weights), lags })
}

/// Accelerations at the stages, one after the other, of every solution; none if they cannot be solved for.
fn stage_accelerations(
    stepper: &Stepper,
    equations: &[Coefficients; STAGES],
    places: &[PlaceStep],
    step: f64,
    state: &State,
) -> Option<DMatrix<f64>> {
    let dof = state.motion.ncols() / 2;
    let solutions = state.motion.nrows();
    // what motion and rate at stage j do at stage i
    let mut coupling: [[DMatrix<f64>; STAGES]; STAGES] =
        std::array::from_fn(|_| std::array::from_fn(|_| DMatrix::zeros(dof, 2 * dof)));
    for (i, equation) in equations.iter().enumerate() {
        coupling[i][i].columns_mut(0, dof).copy_from(&equation.stiffness);
        coupling[i][i].columns_mut(dof, dof).copy_from(&equation.damping);
    }
    let mut right = DMatrix::zeros(solutions, STAGES * dof);
    let mut loads = DMatrix::zeros(solutions, 2);
    let mut first = 0;
    for place in places {
        for (i, row) in coupling.iter_mut().enumerate() {
            for (j, whole) in row.iter_mut().enumerate() {
                let kernel = place.kernel(i, j) * &place.inputs[j];
                whole.gemm(1.0, &place.loads[i], &kernel, 1.0);
            }
            loads.fill(0.0);
            for (k, lag) in place.lags.iter().enumerate() {
                let start = state.lags.column(first + k);
                for o in 0..2 {
                    loads.column_mut(o).axpy(lag.gains[i][o] * lag.alpha[i], &start, 1.0);
                }
            }
            right.columns_mut(i * dof, dof).gemm(-1.0, &loads, &place.loads[i].transpose(), 1.0);
        }
        first += place.lags.len();
    }
    let mut matrix = DMatrix::zeros(STAGES * dof, STAGES * dof);
    // what displacements and rates at the start do at the stages
    let mut from_start = DMatrix::zeros(2 * dof, STAGES * dof);
    for (i, row) in coupling.iter().enumerate() {
        let mut of_start = from_start.columns_mut(i * dof, dof);
        for (j, whole) in row.iter().enumerate() {
            let (stiffness, damping) = (whole.columns(0, dof), whole.columns(dof, dof));
            let mut on_rates = of_start.rows_mut(dof, dof);
            on_rates += (stiffness * (step * stepper.nodes[j]) + damping).transpose();
            let mut on_places = of_start.rows_mut(0, dof);
            on_places += stiffness.transpose();
            for k in 0..STAGES {
                let mut block = matrix.view_mut((i * dof, k * dof), (dof, dof));
                block += stiffness * (step * step * stepper.twice[j][k])
                    + damping * (step * stepper.once[j][k]);
            }
        }
        let mut block = matrix.view_mut((i * dof, i * dof), (dof, dof));
        block += &equations[i].mass;
    }
    right.gemm(-1.0, &state.motion, &from_start, 1.0);
    Some(matrix.lu().solve(&right.transpose())?.transpose())
}
