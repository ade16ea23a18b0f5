//! Stability of a periodic orbit of a system with first-order lags: structure and lags carried together.
//!
//! ```text
//! (M + f_q'') q'' + f_q' q' + f_q q + sum load gain (x - input . [q; q']) = 0,   x' = a(psi) (input . [q; q'] - x)
//! ```
//! The tangents `f` are those with settled lags, `x = input . [q; q']`. A step of Gauss collocation solves the lags
//! in closed form for the motion at its stages, `X = alpha x0 + B In`, so that the system to be solved has the
//! size of the structure alone.
//!
//! There are many more lags than degrees of freedom. Of the motions of the whole system those are kept in which the
//! structure participates most (left times right eigenvector over its states, which add up to their number), as many
//! as the structure has; the rest are lags that die out by themselves.

use std::f64::consts::TAU;

use nalgebra::{DMatrix, Matrix4, RowVector4, Vector4};
use rotor_base::{LagrangeBasis, gauss_legendre};

use crate::stability::floquet::{Coefficients, STAGES, Stepper, check, motions};
use crate::{FemError, Floquet, LocalTangent, TimeElements};

/// Largest step, rad.
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

/// State of all columns: displacements over rates, and lags.
struct State {
    motion: DMatrix<f64>,
    lags: DMatrix<f64>,
}

impl Floquet {
    /// Stability of a system with lags about the orbit at which tangents, inputs and loads were taken; without
    /// places what [`Floquet::of`] finds.
    ///
    /// # Errors
    /// As [`Floquet::of`], and [`FemError::Tangents`] for places whose tables do not fit the mesh.
    pub fn with_lags(
        time: &TimeElements,
        mass: &DMatrix<f64>,
        tangents: &[LocalTangent],
        places: &[LagPlace],
    ) -> Result<Self, FemError> {
        if places.is_empty() {
            return Self::of(time, mass, tangents);
        }
        let dof = mass.nrows();
        check(time, dof, tangents)?;
        check_places(time, dof, places)?;
        let lags = places.iter().map(|place| place.channels.len()).sum();
        let size = 2 * dof + lags;
        let start = State {
            motion: DMatrix::identity(2 * dof, size),
            lags: DMatrix::from_fn(lags, size, |i, j| f64::from(u8::from(2 * dof + i == j))),
        };
        let end = revolved(time, mass, tangents, places, start)?;
        let monodromy = stacked(&end.motion, &end.lags);
        let modes = motions(&monodromy, mass, 2 * dof)?;
        Ok(Self::from_parts(monodromy, modes))
    }
}

fn check_places(time: &TimeElements, dof: usize, places: &[LagPlace]) -> Result<(), FemError> {
    let expected = time.points().len();
    let wrong = |found| Err(FemError::Tangents { what: "lag tables", point: 0, found, expected });
    for place in places {
        let shaped = place.inputs.iter().all(|m| m.shape() == (2, 2 * dof))
            && place.loads.iter().all(|m| m.shape() == (dof, 2));
        for found in [place.inputs.len(), place.loads.len()] {
            if found != expected || !shaped {
                return wrong(found);
            }
        }
        for channel in &place.channels {
            let finite = channel.rates.iter().filter(|a| a.is_finite() && **a >= 0.0).count();
            if finite != expected || channel.gains.len() != expected {
                return wrong(finite.min(channel.gains.len()));
            }
        }
    }
    Ok(())
}

fn stacked(above: &DMatrix<f64>, below: &DMatrix<f64>) -> DMatrix<f64> {
    let mut out = DMatrix::zeros(above.nrows() + below.nrows(), above.ncols());
    out.rows_mut(0, above.nrows()).copy_from(above);
    out.rows_mut(above.nrows(), below.nrows()).copy_from(below);
    out
}

/// The state one revolution later.
fn revolved(
    time: &TimeElements,
    mass: &DMatrix<f64>,
    tangents: &[LocalTangent],
    places: &[LagPlace],
    mut state: State,
) -> Result<State, FemError> {
    let gauss = time.gauss_per_element();
    let basis = LagrangeBasis::new(gauss_legendre(gauss).nodes);
    let stepper = Stepper::new();
    let length = TAU / time.elements() as f64;
    let mut steps = 1;
    while length / f64::from(steps) > LARGEST_STEP {
        steps += 1;
    }
    let step = length / f64::from(steps);
    for (e, element) in tangents.chunks_exact(gauss).enumerate() {
        for k in 0..steps {
            let from = f64::from(k) / f64::from(steps);
            let singular = FemError::MassSingular { azimuth_rad: (e as f64 + from) * length };
            let shapes =
                stepper.nodes.map(|c| basis.evaluate(2.0 * (from + c / f64::from(steps)) - 1.0));
            let equations = shapes.each_ref().map(|s| Coefficients::interpolate(mass, element, s));
            let at: Vec<PlaceStep> = places
                .iter()
                .map(|place| PlaceStep::new(place, e * gauss, &shapes, &stepper, step))
                .collect::<Option<_>>()
                .ok_or(singular.clone())?;
            state = carry(&stepper, &equations, &at, step, &state).ok_or(singular)?;
        }
    }
    Ok(state)
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

/// All columns a step later; none if a stage cannot be solved.
fn carry(
    stepper: &Stepper,
    equations: &[Coefficients; STAGES],
    places: &[PlaceStep],
    step: f64,
    state: &State,
) -> Option<State> {
    let (dof, columns) = (state.motion.nrows() / 2, state.motion.ncols());
    let (x, v) = (state.motion.rows(0, dof), state.motion.rows(dof, dof));
    // what motion and rate at stage j do at stage i
    let mut coupling: Vec<Vec<DMatrix<f64>>> = (0..STAGES)
        .map(|i| {
            (0..STAGES)
                .map(|j| {
                    let mut whole = DMatrix::zeros(dof, 2 * dof);
                    if i == j {
                        whole.columns_mut(0, dof).copy_from(&equations[i].stiffness);
                        whole.columns_mut(dof, dof).copy_from(&equations[i].damping);
                    }
                    whole
                })
                .collect()
        })
        .collect();
    let mut right = DMatrix::zeros(STAGES * dof, columns);
    let mut first = 0;
    for place in places {
        for (i, row) in coupling.iter_mut().enumerate() {
            for (j, whole) in row.iter_mut().enumerate() {
                let kernel = place.kernel(i, j) * &place.inputs[j];
                whole.gemm(1.0, &place.loads[i], &kernel, 1.0);
            }
            let mut loads = DMatrix::zeros(2, columns);
            for (k, lag) in place.lags.iter().enumerate() {
                let start = state.lags.row(first + k);
                for o in 0..2 {
                    let mut load = loads.row_mut(o);
                    load += start * (lag.gains[i][o] * lag.alpha[i]);
                }
            }
            let mut rows = right.rows_mut(i * dof, dof);
            rows.gemm(-1.0, &place.loads[i], &loads, 1.0);
        }
        first += place.lags.len();
    }
    let mut matrix = DMatrix::zeros(STAGES * dof, STAGES * dof);
    for (i, row) in coupling.iter().enumerate() {
        for (j, whole) in row.iter().enumerate() {
            let (stiffness, damping) = (whole.columns(0, dof), whole.columns(dof, dof));
            let mut rows = right.rows_mut(i * dof, dof);
            rows -= stiffness * (x + v * (step * stepper.nodes[j])) + damping * v;
            for k in 0..STAGES {
                let mut block = matrix.view_mut((i * dof, k * dof), (dof, dof));
                block += stiffness * (step * step * stepper.twice[j][k])
                    + damping * (step * stepper.once[j][k]);
            }
        }
        let mut block = matrix.view_mut((i * dof, i * dof), (dof, dof));
        block += &equations[i].mass;
    }
    let stages = matrix.lu().solve(&right)?;
    let stage = |k: usize| stages.rows(k * dof, dof);
    let at_stage: Vec<DMatrix<f64>> = (0..STAGES)
        .map(|j| {
            let (mut moved, mut rates) = (x + v * (step * stepper.nodes[j]), v.into_owned());
            for k in 0..STAGES {
                moved += stage(k) * (step * step * stepper.twice[j][k]);
                rates += stage(k) * (step * stepper.once[j][k]);
            }
            stacked(&moved, &rates)
        })
        .collect();
    let (mut moved, mut rates) = (x + v * step, v.into_owned());
    for k in 0..STAGES {
        moved += stage(k) * (step * step * stepper.end_twice[k]);
        rates += stage(k) * (step * stepper.weights[k]);
    }
    let mut lags = state.lags.clone();
    let mut first = 0;
    for place in places {
        let inputs: Vec<DMatrix<f64>> =
            place.inputs.iter().zip(&at_stage).map(|(c, motion)| c * motion).collect();
        for (k, lag) in place.lags.iter().enumerate() {
            let mut row = lags.row_mut(first + k);
            row *= lag.end_start;
            for (j, input) in inputs.iter().enumerate() {
                for (c, share) in lag.input.iter().enumerate() {
                    row += input.row(c) * (lag.end_drive[j] * share);
                }
            }
        }
        first += place.lags.len();
    }
    Some(State { motion: stacked(&moved, &rates), lags })
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Complex;

    type Square = [[f64; 2]; 2];

    /// Two degrees of freedom whose load of the air lags behind, coefficients periodic.
    fn coefficients(psi: f64) -> (Square, Square, [f64; 2], [f64; 4], f64) {
        let (sin, cos) = psi.sin_cos();
        let damping = [[0.3 + 0.1 * sin, 0.05], [-0.05, 0.04]];
        let stiffness = [[1.3 + 0.2 * cos, 0.1], [0.05, 5.0]];
        let load = [-0.5 - 0.2 * sin, 0.1];
        let input = [0.2 * cos, 0.6 + 0.3 * sin, -0.8, 0.1];
        (damping, stiffness, load, input, 0.4 + 0.3 * sin)
    }

    /// Growth and frequency of the motions by direct integration of all five states.
    fn integrated() -> Vec<Complex<f64>> {
        let rate = |psi: f64, s: &[f64; 5]| -> [f64; 5] {
            let (c, k, load, input, a) = coefficients(psi);
            let [q0, q1, v0, v1, lag] = *s;
            let drive = input[0] * q0 + input[1] * q1 + input[2] * v0 + input[3] * v1;
            let acceleration = |i: usize| {
                -(c[i][0] * v0 + c[i][1] * v1 + k[i][0] * q0 + k[i][1] * q1)
                    - load[i] * (lag - drive)
            };
            [v0, v1, acceleration(0), acceleration(1), a * (drive - lag)]
        };
        let steps = 8000;
        let h = TAU / f64::from(steps);
        let mut monodromy = DMatrix::zeros(5, 5);
        for column in 0..5 {
            let mut s = [0.0; 5];
            s[column] = 1.0;
            for k in 0..steps {
                let psi = h * f64::from(k);
                let moved = |by: f64, r: &[f64; 5]| std::array::from_fn(|i| s[i] + by * r[i]);
                let k1 = rate(psi, &s);
                let k2 = rate(psi + 0.5 * h, &moved(0.5 * h, &k1));
                let k3 = rate(psi + 0.5 * h, &moved(0.5 * h, &k2));
                let k4 = rate(psi + h, &moved(h, &k3));
                s = std::array::from_fn(|i| {
                    s[i] + h / 6.0 * (k1[i] + 2.0 * k2[i] + 2.0 * k3[i] + k4[i])
                });
            }
            for (i, value) in s.iter().enumerate() {
                monodromy[(i, column)] = *value;
            }
        }
        monodromy.complex_eigenvalues().iter().copied().collect()
    }

    #[test]
    fn lags_and_structure_together_are_what_direct_integration_finds() {
        let time = TimeElements::new(8, 5, 8).unwrap();
        let of = |psi: &f64| {
            let (c, k, ..) = coefficients(*psi);
            LocalTangent {
                dq: DMatrix::from_fn(2, 2, |i, j| k[i][j]),
                dqd: DMatrix::from_fn(2, 2, |i, j| c[i][j]),
                dqdd: DMatrix::zeros(2, 2),
            }
        };
        let tangents: Vec<LocalTangent> = time.points().iter().map(of).collect();
        let at = |psi: &f64| coefficients(*psi);
        let place = LagPlace {
            inputs: (time.points().iter())
                .map(|p| DMatrix::from_fn(2, 4, |i, j| if i == 0 { at(p).3[j] } else { 0.0 }))
                .collect(),
            loads: (time.points().iter())
                .map(|p| DMatrix::from_fn(2, 2, |i, j| if j == 0 { at(p).2[i] } else { 0.0 }))
                .collect(),
            channels: vec![LagChannel {
                rates: time.points().iter().map(|p| at(p).4).collect(),
                input: [1.0, 0.0],
                gains: vec![[1.0, 0.0]; time.points().len()],
            }],
        };
        let mass = DMatrix::identity(2, 2);
        let found = Floquet::with_lags(&time, &mass, &tangents, &[place]).unwrap();
        let settled = Floquet::of(&time, &mass, &tangents).unwrap();
        let exact = integrated();
        let nearest =
            |m: Complex<f64>| exact.iter().map(|e| (e - m).norm()).fold(f64::INFINITY, f64::min);
        // the slow motion, and by how much settled lags miss it
        let (gap, missed) =
            (nearest(found.modes()[0].multiplier), nearest(settled.modes()[0].multiplier));
        assert!(gap < 1e-6 && missed > 1e-2, "{gap:e} {missed:e}");
    }
}
