//! Stability of a periodic orbit: monodromy matrix and Floquet exponents of its linearisation.

use std::f64::consts::TAU;

use faer::Mat;
use nalgebra::{Complex, DMatrix};

use crate::stability::monodromy::monodromy;
use crate::{FemError, LagPlace, LocalTangent, TimeElements};

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
    /// The matrix that carries displacements and rates over one revolution from azimuth 0, shape
    /// `2 dof x 2 dof`; of a system with lags these follow as further states.
    pub monodromy: DMatrix<f64>,
    /// The motions, fastest growing (least damped) first.
    pub modes: Vec<FloquetMode>,
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
    /// turns at most 0.7 rad; with lags, which die out faster, in steps of at most 0.1 rad. The growth of
    /// undamped motions is exact by construction.
    ///
    /// | argument | shape | unit |
    /// |---|---|---|
    /// | `mass` | `dof x dof` | rotor units |
    /// | `tangents` | one per Gauss point, with settled lags | rotor units, per rad |
    /// | `places` | where the system has lags | rotor units, per rad |
    ///
    /// There are many more lags than degrees of freedom. Of the motions of the whole system those are kept in
    /// which the structure participates most (left times right eigenvector over its states, which add up to their
    /// number), as many as the structure has; the rest are lags that die out by themselves.
    ///
    /// Not modelled: whatever tangents and lags leave out.
    ///
    /// Source: Hairer and Wanner, Solving Ordinary Differential Equations II, section IV.5 (Gauss
    /// methods); Johnson, Helicopter Theory (1980), section 8-6 (Floquet theory).
    ///
    /// # Errors
    /// [`FemError::Tangents`] when number or shape of tangents or tables of the lags does not fit or a number
    /// is not finite, [`FemError::MassSingular`], [`FemError::Eigen`].
    pub fn of(
        time: &TimeElements,
        mass: &DMatrix<f64>,
        tangents: &[LocalTangent],
        places: &[LagPlace],
    ) -> Result<Self, FemError> {
        let dof = mass.nrows();
        check(time, dof, tangents)?;
        check_places(time, dof, places)?;
        let monodromy = monodromy(time, mass, tangents, places)?;
        let modes = motions(&monodromy, mass, 2 * dof)?;
        Ok(Self { monodromy, modes })
    }
}

/// Refuses tangents of the wrong number, shape or value.
fn check(time: &TimeElements, dof: usize, tangents: &[LocalTangent]) -> Result<(), FemError> {
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

/// Refuses tables of lags that do not fit the mesh.
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

/// The motions of a monodromy matrix, one of each conjugate pair, fastest growing first: the `kept` ones in which
/// displacements and rates, which come before other states, participate most.
fn motions(
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::LagChannel;
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
        let found = Floquet::of(&time, &mass, &tangents, &[place]).unwrap();
        let settled = Floquet::of(&time, &mass, &tangents, &[]).unwrap();
        let exact = integrated();
        let nearest =
            |m: Complex<f64>| exact.iter().map(|e| (e - m).norm()).fold(f64::INFINITY, f64::min);
        // the slow motion, and by how much settled lags miss it
        let (gap, missed) =
            (nearest(found.modes[0].multiplier), nearest(settled.modes[0].multiplier));
        assert!(gap < 1e-6 && missed > 1e-2, "{gap:e} {missed:e}");
    }
}
