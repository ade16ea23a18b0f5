//! Possio's integral equation: a thin section in harmonic motion in a compressible stream.
//!
//! ```text
//! w(x)/U = integral over the chord of c_p(xi) K(x - xi) d xi,       x, xi in semichords
//! K(z) = -(k/8 beta) { e^(i M^2 s) [ i M sgn(s) H1(M|s|) - H0(M|s|) ]
//!        + i beta^2 e^(-ikz) [ (2/(pi beta)) ln((1 + beta)/M) + integral_0^s e^(iu) H0(M|u|) du ] }
//! s = k z / beta^2,     H0, H1 Hankel functions of the second kind
//! ```
//! The kernel is `A/z + B(z) ln|z| + C(z)` with `A` constant and `B`, `C` entire. All three act on a
//! cosine series without quadrature over singularities:
//!
//! - `A/z` by Glauert's integral;
//! - `ln|cos(phi) - cos(theta)|` is diagonal in cosines;
//! - `B` and `C` are Chebyshev series in `x` and `xi`, which multiply cosines by cosines.
//!
//! A downwash with a step or a kink has a slowly falling cosine series. Of the loading, lift and
//! moment need three coefficients only, and these converge faster than any power. The hinge moment
//! needs them all: its steady part is summed to the end, and what is left falls with the fourth
//! power.
//!
//! Source: C. Possio, L'Aerotecnica 18 (1938); kernel as in R. L. Bisplinghoff, H. Ashley and
//! R. L. Halfman, Aeroelasticity (1955), chapter 6. The method of solution is this project's.

use crate::ExactError;
use crate::bessel::Entire;
use crate::chebyshev::{Series, nodes, transform};
use crate::downwash::{
    downwash, hinge_angle, hinge_weight, loads, start_loads, steady_coefficient, steady_loads,
};
use nalgebra::{DMatrix, Dyn, LU};
use num_complex::Complex64;
use std::f64::consts::PI;

/// Number of coefficients of the loading that is ample for every use in this project.
pub const TERMS: usize = 96;

/// Largest `k / beta^2` the series of the kernel keep their digits for.
const LARGEST_FREQUENCY: f64 = 12.0;

/// The integral equation at one Mach number and reduced frequency, factored.
#[derive(Debug, Clone)]
pub struct Possio {
    beta: f64,
    terms: usize,
    factors: LU<Complex64, Dyn, Dyn>,
}

impl Possio {
    /// The equation with [`TERMS`] coefficients.
    ///
    /// # Errors
    /// [`ExactError::OutOfRange`] unless `0 < mach < 1`, `0 < k` and `k / beta^2 <= 12`.
    pub fn new(mach: f64, k: f64) -> Result<Self, ExactError> {
        Self::with_terms(mach, k, TERMS)
    }

    /// The equation with a number of coefficients, for studies of convergence.
    ///
    /// # Errors
    /// As [`Possio::new`]; [`ExactError::Singular`] if the equations have no solution.
    pub fn with_terms(mach: f64, k: f64, terms: usize) -> Result<Self, ExactError> {
        if !(mach > 0.0 && mach < 1.0) {
            return Err(ExactError::OutOfRange { quantity: "Mach number", value: mach });
        }
        let beta2 = (1.0 - mach) * (1.0 + mach);
        if !(k > 0.0 && k / beta2 <= LARGEST_FREQUENCY) {
            return Err(ExactError::OutOfRange { quantity: "reduced frequency", value: k });
        }
        let beta = beta2.sqrt();
        let kernel = Kernel::new(mach, k);
        let factors = kernel.matrix(beta, terms.max(4)).lu();
        if !factors.is_invertible() {
            return Err(ExactError::Singular { mach, k });
        }
        Ok(Self { beta, terms: terms.max(4), factors })
    }

    /// Complex amplitudes `[load][downwash]`: `Cn`, `Cm` about the quarter chord and `Ch` per unit of
    /// `alpha`, `q`, `delta`, `q_delta`, each downwash apart.
    ///
    /// `flap_chord` is `E`, from 0 (no flap: `Ch` and the flap's columns are 0) to below 1.
    ///
    /// # Errors
    /// [`ExactError::OutOfRange`] for a flap chord outside `0 <= E < 1`;
    /// [`ExactError::Singular`] never, after a successful [`Possio::new`].
    pub fn loads(&self, flap_chord: f64) -> Result<[[Complex64; 4]; 3], ExactError> {
        self.loads_with(flap_chord, &steady_loads(0.0, flap_chord))
    }

    /// [`loads`](Self::loads) with the steady loads at Mach 0 known beforehand: their hinge moment
    /// is a long sum.
    ///
    /// # Errors
    /// As [`loads`](Self::loads).
    pub fn loads_with(
        &self,
        flap_chord: f64,
        still: &[[f64; 4]; 3],
    ) -> Result<[[Complex64; 4]; 3], ExactError> {
        if !(0.0..1.0).contains(&flap_chord) {
            return Err(ExactError::OutOfRange { quantity: "flap chord ratio", value: flap_chord });
        }
        let hinge = hinge_angle(flap_chord);
        let right = DMatrix::from_fn(self.terms, 4, |n, j| Complex64::from(downwash(n, hinge)[j]));
        let Some(solution) = self.factors.solve(&right) else {
            return Err(ExactError::Singular { mach: f64::NAN, k: f64::NAN });
        };
        let mut out = [[Complex64::ZERO; 4]; 3];
        for j in 0..4 {
            let a: Vec<Complex64> = solution.column(j).iter().copied().collect();
            let unsteady: Complex64 = (0..self.terms)
                .map(|n| {
                    let steady = steady_coefficient(n, right[(n, j)].re, self.beta);
                    (a[n] - steady) * hinge_weight(n, hinge)
                })
                .sum();
            let moment =
                if flap_chord > 0.0 { unsteady + still[2][j] / self.beta } else { Complex64::ZERO };
            for (row, load) in out.iter_mut().zip(loads(&a, moment)) {
                row[j] = load;
            }
        }
        Ok(out)
    }

    /// Loads at the start of a step, for the fits: see [`start_loads`].
    pub fn start(mach: f64, flap_chord: f64) -> [[f64; 4]; 3] {
        start_loads(mach, flap_chord)
    }
}

/// The entire parts of the kernel as Chebyshev series in `u = cos(theta)` and `v = cos(phi)`, where
/// `x - xi = v - u`.
struct Kernel {
    degree: usize,
    /// Coefficients `[i][j]` of `T_i(u) T_j(v)`.
    log: DMatrix<Complex64>,
    smooth: DMatrix<Complex64>,
}

impl Kernel {
    fn new(mach: f64, k: f64) -> Self {
        let (log, smooth) = entire_parts(mach, k);
        let bandwidth = k / (1.0 - mach * mach) * (1.0 + mach);
        #[expect(clippy::cast_possible_truncation, reason = "a few tens")]
        #[expect(clippy::cast_sign_loss, reason = "positive")]
        let degree = 24 + (1.3 * bandwidth).ceil() as usize;
        let points = nodes(degree);
        let double = |series: &Series| {
            // first along v for every u, then along u
            let mut c = DMatrix::from_fn(degree, degree, |i, j| series.at(points[j] - points[i]));
            for mut row in c.row_iter_mut() {
                let values: Vec<Complex64> = row.iter().copied().collect();
                for (slot, value) in row.iter_mut().zip(transform(&values)) {
                    *slot = value;
                }
            }
            for mut column in c.column_iter_mut() {
                let values: Vec<Complex64> = column.iter().copied().collect();
                column.copy_from_slice(&transform(&values));
            }
            c
        };
        Self { degree, log: double(&log), smooth: double(&smooth) }
    }

    /// Cosine coefficients of the downwash per coefficient of the loading.
    fn matrix(&self, beta: f64, terms: usize) -> DMatrix<Complex64> {
        // per coefficient p of c_p sin(phi) = sum g_p cos(p phi)
        let g = self.of_cosines(terms, terms + 1);
        DMatrix::from_fn(terms, terms, |m, n| {
            let coupled =
                if n == 0 { g[(m, 0)] + g[(m, 1)] } else { 0.5 * (g[(m, n - 1)] - g[(m, n + 1)]) };
            let glauert = match (m == n, n) {
                (true, 0) => 0.25 * beta,
                (true, _) => -0.25 * beta,
                _ => 0.0,
            };
            coupled + glauert
        })
    }

    /// Cosine coefficients `0..rows` of the logarithmic and the smooth part acting on
    /// `cos(p phi)`, `p` up to and with `last`.
    fn of_cosines(&self, rows: usize, last: usize) -> DMatrix<Complex64> {
        let mut g = DMatrix::zeros(rows, last + 1);
        for p in 0..=last {
            // L[T_j cos p], per j: two diagonal entries
            for j in 0..self.degree {
                for q in [p + j, p.abs_diff(j)] {
                    let diagonal = if q == 0 { -PI * 2.0_f64.ln() } else { -PI / q as f64 };
                    for i in 0..self.degree {
                        let value = self.log[(i, j)] * (0.25 * diagonal);
                        for m in [q + i, q.abs_diff(i)] {
                            if m < rows {
                                g[(m, p)] += value;
                            }
                        }
                    }
                }
            }
            if p < self.degree {
                let weight = if p == 0 { PI } else { 0.5 * PI };
                for i in 0..self.degree.min(rows) {
                    g[(i, p)] += weight * self.smooth[(i, p)];
                }
            }
        }
        g
    }
}

/// The logarithm's factor `B` and the rest `C` of the kernel, on `[-2, 2]`.
fn entire_parts(mach: f64, k: f64) -> (Series, Series) {
    const HALF: f64 = 2.0;
    let i = Complex64::I;
    let beta2 = (1.0 - mach) * (1.0 + mach);
    let beta = beta2.sqrt();
    let scale = k / beta2;
    #[expect(clippy::cast_possible_truncation, reason = "below two hundred")]
    #[expect(clippy::cast_sign_loss, reason = "positive")]
    let count = 2 * (18 + (1.3 * scale * (1.0 + mach)).ceil() as usize);
    let points: Vec<f64> = nodes(count).iter().map(|t| t * HALF).collect();
    let series = |f: &dyn Fn(f64) -> Complex64| {
        Series::through(HALF, &points.iter().map(|z| f(*z)).collect::<Vec<_>>())
    };
    let bessel = |z: f64| Entire::at(mach * scale * z);
    let turn = |z: f64| Complex64::cis(scale * z);
    // integrals from 0 to s of e^(iu) J0(Mu), of that over u, and of e^(iu) y0(Mu)
    let of_j = series(&|z| scale * turn(z) * bessel(z).j0).integral();
    let of_log = series(&|z| of_j.at(z) / z).integral();
    let of_y = series(&|z| scale * turn(z) * bessel(z).y0).integral();
    let level = (0.5 * mach * scale).ln();
    let far = 2.0 / (PI * beta) * ((1.0 + beta) / mach).ln();
    let prefactor = -k / (8.0 * beta);
    let per = 2.0 / PI;

    let log = series(&|z| {
        let e = bessel(z);
        let near = Complex64::cis(mach * mach * scale * z) * (mach * e.j1 + i * e.j0);
        prefactor * per * (near + beta2 * Complex64::cis(-k * z) * of_j.at(z))
    });
    let smooth = series(&|z| {
        let e = bessel(z);
        let phase = mach * mach * scale * z;
        let h1 = e.j1 - i * (per * level * e.j1 + e.y1);
        let h0 = e.j0 - i * (per * level * e.j0 + e.y0);
        // (e^(i phase) - 1) / s
        let half = 0.5 * phase;
        let sinc = if half.abs() < 1e-8 { 1.0 } else { half.sin() / half };
        let cauchy = i * Complex64::cis(half) * sinc * mach * mach;
        let near = Complex64::cis(phase) * (i * mach * h1 - h0) - per * cauchy;
        let wake = far + of_j.at(z) - i * (per * (level * of_j.at(z) - of_log.at(z)) + of_y.at(z));
        prefactor * (near + i * beta2 * Complex64::cis(-k * z) * wake)
    });
    (log, smooth)
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Integral over `[from, to]` of a function that may be singular at its ends, by the
    /// double-exponential rule.
    fn integrate(from: f64, to: f64, f: impl Fn(f64) -> Complex64) -> Complex64 {
        let (half, step) = (0.5 * (to - from), 1.0 / 32.0);
        (-110..=110)
            .map(|i| {
                let t = f64::from(i) * step;
                let inner = 0.5 * PI * t.sinh();
                // distance from the nearer end, without cancellation
                let gap = half * (-inner.abs()).exp() / inner.cosh();
                let at = if i < 0 { from + gap } else { to - gap };
                f(at) * (half * step * 0.5 * PI * t.cosh() / inner.cosh().powi(2))
            })
            .sum()
    }

    /// The kernel as it is printed, less its Cauchy part.
    fn kernel_without_cauchy(m: f64, k: f64, z: f64) -> Complex64 {
        let i = Complex64::I;
        let beta2 = 1.0 - m * m;
        let beta = beta2.sqrt();
        // nearer than rounding: the logarithm's share of an interval of this length is none
        let z = if z.abs() < 1e-13 { 1e-13_f64.copysign(z) } else { z };
        let hankel = |s: f64| {
            let e = Entire::at(s);
            let log = 2.0 / PI * (0.5 * s).ln();
            let h0 = Complex64::new(e.j0, -(log * e.j0 + e.y0));
            (h0, Complex64::new(e.j1, -(log * e.j1 - 2.0 / (PI * s) + e.y1)))
        };
        let s = k * z / beta2;
        let (h0, h1) = hankel(m * s.abs());
        let wake = integrate(0.0, 1.0, |v| {
            let u = s * v;
            Complex64::cis(u) * hankel(m * u.abs()).0 * s
        });
        let far = 2.0 / (PI * beta) * ((1.0 + beta) / m).ln();
        let value = Complex64::cis(m * m * s) * (i * m * s.signum() * h1 - h0)
            + i * beta2 * Complex64::cis(-k * z) * (far + wake);
        -k / (8.0 * beta) * value - beta / (4.0 * PI * z)
    }

    /// Lift and moment of the flap by another way, the theorem of reverse flow: the loading `g` of the
    /// adjoint equation, singular at the trailing edge, for the smooth weights of lift and moment, by
    /// collocation with every integral by brute force; the flap's downwash is then integrated against it.
    ///
    /// ```text
    /// integral g(x) K(x - xi) dx = h(xi):    (1/2) integral c_p h d xi = (1/2) integral w g dx
    /// ```
    fn by_reverse_flow(m: f64, k: f64, flap_chord: f64, points: usize) -> [Complex64; 2] {
        let beta = (1.0 - m * m).sqrt();
        let shape = |n: usize, theta: f64| match n {
            0 => 1.0 - theta.cos(),
            _ => (n as f64 * theta).sin() * theta.sin(),
        };
        let mut matrix = DMatrix::zeros(points, points);
        let mut right = DMatrix::zeros(points, 2);
        for j in 0..points {
            let phi = PI * (j as f64 + 0.5) / points as f64;
            right[(j, 0)] = Complex64::from(1.0);
            right[(j, 1)] = Complex64::from(-0.5 * (0.5 - phi.cos()));
            for n in 0..points {
                let inside = |theta: f64| {
                    shape(n, theta) * kernel_without_cauchy(m, k, phi.cos() - theta.cos())
                };
                matrix[(j, n)] = integrate(0.0, phi, inside)
                    + integrate(phi, PI, inside)
                    + 0.25 * beta * (n as f64 * phi).cos();
            }
        }
        let g = matrix.lu().solve(&right).unwrap();
        let hinge = hinge_angle(flap_chord);
        [0, 1].map(|load| {
            integrate(hinge, PI, |theta| {
                let loading: Complex64 = (0..points).map(|n| g[(n, load)] * shape(n, theta)).sum();
                let behind = hinge.cos() - theta.cos();
                0.5 * loading * Complex64::new(1.0, k * behind)
            })
        })
    }

    /// The rows of `possio_flap.csv` at `k = 2` are good to some 3e-4: here this solver and the other
    /// method agree far closer, and the table stands apart from both.
    #[test]
    fn reverse_flow_gives_the_same_loads_at_high_frequency() {
        let tabulated = [
            Complex64::new(1.041_789_98, -0.100_772_775),
            Complex64::new(1.357_101_80, 0.356_920_528),
        ];
        for ((m, e, points), table) in
            [(0.6, 0.2, [10, 13]), (0.8, 0.25, [16, 20])].into_iter().zip(tabulated)
        {
            let k = 2.0;
            let loads = Possio::new(m, k).unwrap().loads(e).unwrap();
            let others = points.map(|points| by_reverse_flow(m, k, e, points));
            for o in 0..2 {
                let flap = loads[o][2] + Complex64::new(0.0, 2.0 * k) * loads[o][3];
                let apart = others.map(|other| (other[o] - flap).norm() / flap.norm());
                println!(
                    "M {m} k {k} E {e} load {o}: {flap:.9}, apart {apart:?} with {points:?} points"
                );
                assert!(apart[1] < 1e-8 && apart[1] < 0.01 * apart[0], "{m} {o}: {apart:?}");
            }
            let off = (table - others[1][0]).norm() / table.norm();
            println!("M {m} k {k} E {e}: the table's lift is {off:.1e} off");
            assert!((1e-4..3e-4).contains(&off), "{off:e}");
        }
    }

    /// The loading put into the equation as it is printed, every integral by brute force.
    #[test]
    fn the_loading_satisfies_the_equation() {
        for (m, k) in [(0.6, 2.0), (0.8, 1.0), (0.3, 0.1)] {
            let possio = Possio::with_terms(m, k, 48).unwrap();
            let hinge = hinge_angle(0.2);
            let right = DMatrix::from_fn(48, 1, |n, _| Complex64::from(downwash(n, hinge)[1]));
            let a = possio.factors.solve(&right).unwrap();
            for theta in [0.4_f64, 1.3, 2.2] {
                let loading = |phi: f64| -> Complex64 {
                    a.iter()
                        .enumerate()
                        .map(|(n, a)| match n {
                            0 => a * (1.0 + phi.cos()),
                            _ => a * (n as f64 * phi).sin() * phi.sin(),
                        })
                        .sum()
                };
                let inside =
                    |phi: f64| loading(phi) * kernel_without_cauchy(m, k, phi.cos() - theta.cos());
                let cauchy: Complex64 = a
                    .iter()
                    .enumerate()
                    .map(|(n, a)| {
                        let sign = if n == 0 { 1.0 } else { -1.0 };
                        0.25 * possio.beta * sign * a * (n as f64 * theta).cos()
                    })
                    .sum();
                let w = cauchy + integrate(0.0, theta, inside) + integrate(theta, PI, inside);
                let exact = 0.5 * (0.5 - theta.cos());
                assert!((w - exact).norm() < 1e-9, "M {m} k {k} theta {theta}: {w} {exact}");
            }
        }
    }
}
