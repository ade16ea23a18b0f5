//! Uncoupled rotating modes of a uniform blade at zero pitch, by Rayleigh and Ritz.
//!
//! ```text
//! flap     int EI_y w'' dw'' + N w' dw'                           = om^2 int w dw
//! lag      int EI_z v'' dv'' + N v' dv' - v dv                    = om^2 int v dv
//! torsion  int (GJ + k_A^2 N) p' dp' + (k_2^2 - k_1^2) p dp + k p(0) dp(0) = om^2 int k_m^2 p dp,   N = (1 - x^2)/2
//! ```
//! with `x^2 P_k(2x - 1)` for bending, `x P_k` for torsion of a held root and `P_k` for one on a spring. A dozen and a half
//! Legendre polynomials give the frequencies of the modes kept to rounding.

use super::blade::Blade;
use super::span::{Span, gauss, legendre};
use crate::error::RotorTruthError;
use nalgebra::{DMatrix, DVector};

/// Polynomials of the trial space.
const TRIALS: usize = 18;

/// A mode with its shape at stations; the tip has 1.
#[derive(Debug, Clone)]
pub struct Mode {
    /// Frequency over the rotor speed.
    pub frequency: f64,
    /// Modal mass.
    pub mass: f64,
    /// Shape by station.
    pub shape: Vec<f64>,
    /// Its slope.
    pub slope: Vec<f64>,
    /// Its second derivative.
    pub curvature: Vec<f64>,
    /// Shape at the root.
    pub root: f64,
    /// Shape at the station of the lag damper.
    pub at_damper: f64,
}

/// Modes of the three families.
#[derive(Debug, Clone)]
pub struct Modes {
    /// Flap.
    pub flap: Vec<Mode>,
    /// Lag.
    pub lag: Vec<Mode>,
    /// Torsion.
    pub torsion: Vec<Mode>,
}

/// Value, slope and second derivative of `x^power P_k(2x - 1)` for every `k`.
fn trials(x: f64, power: i32) -> Vec<[f64; 3]> {
    let p = legendre(2.0 * x - 1.0, TRIALS);
    let (mut first, mut second) = (vec![0.0; TRIALS], vec![0.0; TRIALS]);
    for k in 1..TRIALS {
        // P'_k = P'_(k-2) + (2k - 1) P_(k-1)
        let below = |of: &[f64]| if k >= 2 { of[k - 2] } else { 0.0 };
        let rate = 2.0 * k as f64 - 1.0;
        (first[k], second[k]) =
            (below(&first) + rate * p[k - 1], below(&second) + rate * first[k - 1]);
    }
    let e = f64::from(power);
    let monomial = |n: i32| if n < 0 { 0.0 } else { x.powi(n) };
    (0..TRIALS)
        .map(|k| {
            let [value, slope, bend] = [p[k], 2.0 * first[k], 4.0 * second[k]];
            let (m0, m1) = (monomial(power), e * monomial(power - 1));
            let m2 = e * (e - 1.0) * monomial(power - 2);
            [m0 * value, m1 * value + m0 * slope, m2 * value + 2.0 * m1 * slope + m0 * bend]
        })
        .collect()
}

/// What one family of modes is made of.
struct Family {
    name: &'static str,
    power: i32,
    count: usize,
    /// Factor of the mass.
    inertia: f64,
    /// Stiffness of value, slope, its tension share, and curvature.
    of_value: f64,
    of_slope: f64,
    of_tension: f64,
    of_curvature: f64,
    root_spring: f64,
}

impl Family {
    fn solve(&self, stations: &[f64], damper: f64) -> Result<Vec<Mode>, RotorTruthError> {
        let refused = || RotorTruthError::Modes { family: self.name };
        let (node, weight) = gauss(TRIALS + 6);
        let mut stiffness = DMatrix::<f64>::zeros(TRIALS, TRIALS);
        let mut mass = DMatrix::<f64>::zeros(TRIALS, TRIALS);
        let mut add = |x: f64, w: f64, k: [f64; 4]| {
            let t = trials(x, self.power);
            for i in 0..TRIALS {
                for j in 0..TRIALS {
                    let product = |d: usize| t[i][d] * t[j][d];
                    stiffness[(i, j)] +=
                        w * (k[0] * product(0) + k[1] * product(1) + k[2] * product(2));
                    mass[(i, j)] += w * k[3] * product(0);
                }
            }
        };
        for (x, w) in node.iter().zip(&weight) {
            let tension = 0.5 * (1.0 - x * x);
            let slope = self.of_slope + self.of_tension * tension;
            add(*x, *w, [self.of_value, slope, self.of_curvature, self.inertia]);
        }
        add(0.0, self.root_spring, [1.0, 0.0, 0.0, 0.0]);
        let lower = mass.cholesky().ok_or_else(refused)?.l();
        let half = lower.solve_lower_triangular(&stiffness).ok_or_else(refused)?;
        let whole = lower.solve_lower_triangular(&half.transpose()).ok_or_else(refused)?;
        let eigen = (0.5 * (&whole + whole.transpose())).symmetric_eigen();
        let mut order: Vec<usize> = (0..TRIALS).collect();
        order.sort_by(|a, b| eigen.eigenvalues[*a].total_cmp(&eigen.eigenvalues[*b]));
        order[..self.count]
            .iter()
            .map(|k| {
                let square = eigen.eigenvalues[*k];
                let own = DVector::from_column_slice(eigen.eigenvectors.column(*k).as_slice());
                let shape = lower.tr_solve_lower_triangular(&own).ok_or_else(refused)?;
                let at = |x: f64, d: usize| -> f64 {
                    trials(x, self.power).iter().zip(shape.iter()).map(|(t, a)| t[d] * a).sum()
                };
                let tip = at(1.0, 0);
                let along = |d| stations.iter().map(|x| at(*x, d) / tip).collect();
                if square <= 0.0 {
                    return Err(refused());
                }
                Ok(Mode {
                    frequency: square.sqrt(),
                    mass: 1.0 / (tip * tip),
                    shape: along(0),
                    slope: along(1),
                    curvature: along(2),
                    root: at(0.0, 0) / tip,
                    at_damper: at(damper, 0) / tip,
                })
            })
            .collect()
    }
}

impl Modes {
    /// The modes of a blade at stations.
    ///
    /// # Errors
    /// [`RotorTruthError::Modes`] of a blade without mass or stiffness.
    pub fn of(blade: &Blade, span: &Span) -> Result<Self, RotorTruthError> {
        let [km1, km2, ka] = blade.gyration.map(|own| own * own);
        let damper = blade.lag_damper.map_or(0.0, |own| own.0);
        let bending = |name, count, of_curvature, of_value| Family {
            name,
            power: 2,
            count,
            inertia: 1.0,
            of_value,
            of_slope: 0.0,
            of_tension: 1.0,
            of_curvature,
            root_spring: 0.0,
        };
        let torsion = Family {
            name: "torsion",
            power: i32::from(blade.pitch_spring.is_none()),
            count: blade.modes[2],
            inertia: km1 + km2,
            of_value: km2 - km1,
            of_slope: blade.gj,
            of_tension: ka,
            of_curvature: 0.0,
            root_spring: blade.pitch_spring.unwrap_or(0.0),
        };
        Ok(Self {
            flap: bending("flap", blade.modes[0], blade.ei_flap, 0.0).solve(&span.x, damper)?,
            lag: bending("lag", blade.modes[1], blade.ei_lag, -1.0).solve(&span.x, damper)?,
            torsion: torsion.solve(&span.x, damper)?,
        })
    }

    /// Number of modes.
    pub fn len(&self) -> usize {
        self.flap.len() + self.lag.len() + self.torsion.len()
    }

    /// Whether there is none.
    pub fn is_empty(&self) -> bool {
        self.len() == 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Exact values of a 60-digit power series.
    #[test]
    fn frequencies_are_exact() -> Result<(), RotorTruthError> {
        let modes = Modes::of(&Blade::default(), &Span::new(&[], 4, 0.2))?;
        let compare = |found: &[Mode], exact: &[f64]| {
            for (own, exact) in found.iter().zip(exact) {
                assert!((own.frequency / exact - 1.0).abs() < 2e-8, "{} {exact}", own.frequency);
            }
        };
        compare(&modes.flap, &[1.125_789_21, 3.421_609_80, 7.667_070_82, 13.915_885_0]);
        compare(&modes.lag, &[0.701_362_786, 4.299_964_31, 10.899_359_4, 20.656_413_3]);
        assert!((modes.torsion[0].frequency - 4.588_073).abs() < 1e-6);
        assert!((modes.torsion[1].frequency - 13.521_86).abs() < 1e-5);
        Ok(())
    }

    /// A stiff spring of the root is a held root.
    #[test]
    fn a_stiff_pitch_link_is_none() -> Result<(), RotorTruthError> {
        let span = Span::new(&[], 4, 0.2);
        let held = Modes::of(&Blade::default(), &span)?;
        let sprung = Blade { pitch_spring: Some(1e4), ..Blade::default() };
        let sprung = Modes::of(&sprung, &span)?;
        assert!((sprung.torsion[0].frequency / held.torsion[0].frequency - 1.0).abs() < 1e-5);
        Ok(())
    }
}
