//! Lift and moment of a section with thickness in potential flow, by panels of sources and one circulation.
//!
//! ```text
//! u - iw = (q - i gamma)/2pi  ln(z / (z - l))             a panel of length l along the real axis, at z
//! ```
//! Nothing passes the middles of the panels; the speeds on both sides of the trailing edge are alike (Kutta).
//!
//! Source: J. L. Hess, A. M. O. Smith, Progress in Aeronautical Sciences 8 (1967).

use crate::ExactError;
use nalgebra::{DMatrix, DVector};
use num_complex::Complex64;
use std::f64::consts::{FRAC_PI_2, PI};

/// A closed outline from the trailing edge along the lower side to the nose and back along the upper side, chord 1.
#[derive(Debug, Clone, PartialEq)]
pub struct Outline(Vec<Complex64>);

/// Mean line of the NACA five-digit sections of the form 230: place of the end of the curve and its strength.
///
/// Source: E. N. Jacobs, R. M. Pinkerton, NACA Report 537 (1935).
const MEAN_LINE_230: (f64, f64) = (0.2025, 15.957);

impl Outline {
    /// An outline of given points, the trailing edge first and last.
    pub fn new(points: Vec<Complex64>) -> Self {
        Self(points)
    }

    /// NACA 23012, closed at the trailing edge, with that many panels on each side.
    pub fn naca_23012(panels_a_side: usize) -> Self {
        Self::five_digit(MEAN_LINE_230, 0.12, panels_a_side)
    }

    /// A section of a mean line `(m, k_1)` and a thickness over the chord.
    fn five_digit((m, k): (f64, f64), thickness: f64, panels_a_side: usize) -> Self {
        let side = |x: f64, sense: f64| {
            let (camber, slope) = if x < m {
                let camber = x * (x * x - 3.0 * m * x + m * m * (3.0 - m));
                (camber, 3.0 * x * x - 6.0 * m * x + m * m * (3.0 - m))
            } else {
                (m.powi(3) * (1.0 - x), -m.powi(3))
            };
            let (camber, slope) = (camber * k / 6.0, slope * k / 6.0);
            let half = 5.0
                * thickness
                * (0.2969 * x.sqrt() + x * (-0.126 + x * (-0.3516 + x * (0.2843 - 0.1036 * x))));
            let normal = Complex64::new(-slope, 1.0) / slope.hypot(1.0);
            Complex64::new(x, camber) + normal * (sense * half)
        };
        let count = panels_a_side as f64;
        let at = |k: usize| (FRAC_PI_2 * (1.0 - k as f64 / count)).sin().powi(2);
        let lower = (0..=panels_a_side).map(|k| side(at(k), -1.0));
        let upper = (0..panels_a_side).rev().map(|k| side(at(k), 1.0));
        Self(lower.chain(upper).collect())
    }

    /// Lift coefficient and moment coefficient about the quarter chord, nose up, at an incidence (rad).
    ///
    /// # Errors
    /// [`ExactError::Singular`] where the panels have no solution.
    pub fn loads(&self, incidence_rad: f64) -> Result<[f64; 2], ExactError> {
        let panels: Vec<[Complex64; 2]> = self.0.windows(2).map(|w| [w[0], w[1]]).collect();
        let count = panels.len();
        let along = |of: &[Complex64; 2]| (of[1] - of[0]) / (of[1] - of[0]).norm();
        let middle = |of: &[Complex64; 2]| 0.5 * (of[0] + of[1]);
        let stream = Complex64::from_polar(1.0, -incidence_rad);
        // u - iw at the middle of a panel by another one's source of unit strength
        let induced = |i: usize, j: usize| {
            if i == j {
                return Complex64::new(0.0, -0.5) / along(&panels[j]);
            }
            let [from, to] = panels[j].map(|end| middle(&panels[i]) - end);
            (from / to).ln() / (2.0 * PI) / along(&panels[j])
        };
        let vortex = Complex64::new(0.0, -1.0);
        let normal = |i: usize| along(&panels[i]) * Complex64::i();
        let mut matrix = DMatrix::zeros(count + 1, count + 1);
        let mut right = DVector::zeros(count + 1);
        for i in 0..count {
            for j in 0..count {
                let velocity = induced(i, j);
                matrix[(i, j)] = (velocity * normal(i)).re;
                matrix[(i, count)] += (velocity * vortex * normal(i)).re;
            }
            right[i] = -(stream * normal(i)).re;
        }
        for i in [0, count - 1] {
            for j in 0..count {
                let velocity = induced(i, j);
                matrix[(count, j)] += (velocity * along(&panels[i])).re;
                matrix[(count, count)] += (velocity * vortex * along(&panels[i])).re;
            }
            right[count] -= (stream * along(&panels[i])).re;
        }
        let singular = ExactError::Singular { mach: 0.0, k: 0.0 };
        let found = matrix.lu().solve(&right).ok_or(singular)?;
        let (mut force, mut moment) = (Complex64::ZERO, 0.0);
        for (i, panel) in panels.iter().enumerate() {
            let strengths = (0..count).map(|j| induced(i, j) * (found[j] + vortex * found[count]));
            let speed = ((stream + strengths.sum::<Complex64>()) * along(panel)).re;
            let pressure = 1.0 - speed * speed;
            let length = (panel[1] - panel[0]).norm();
            let own = -normal(i) * (pressure * length);
            force += own;
            moment -= ((middle(panel) - 0.25).conj() * own).im;
        }
        Ok([(force * stream).im, moment])
    }
}

/// Slope of the lift (per rad), incidence of zero lift (rad) and moment about the quarter chord there, of an outline.
///
/// # Errors
/// As [`Outline::loads`].
pub fn linear_section(outline: &Outline) -> Result<[f64; 3], ExactError> {
    let step = 0.01;
    let at = |incidence: f64| outline.loads(incidence);
    let ([below, _], [above, _]) = (at(-step)?, at(step)?);
    let slope = (above - below) / (2.0 * step);
    let mut zero = -0.5 * (above + below) / slope;
    zero -= at(zero)?[0] / slope;
    Ok([slope, zero, at(zero)?[1]])
}

/// Incidence of zero lift (rad) and moment about the quarter chord of the mean line 230 alone, by the integrals of
/// thin-aerofoil theory with that many steps.
///
/// ```text
/// alpha_0 = 1/pi int z' (1 - cos t) dt,    c_m = 1/2 int z' (cos 2t - cos t) dt,    x = (1 - cos t)/2
/// ```
pub fn thin_mean_line_230(steps: usize) -> [f64; 2] {
    let (m, k) = MEAN_LINE_230;
    let width = PI / steps as f64;
    let (mut zero, mut moment) = (0.0, 0.0);
    for n in 0..steps {
        let t = (n as f64 + 0.5) * width;
        let x = 0.5 * (1.0 - t.cos());
        let polynomial = 3.0 * x * x - 6.0 * m * x + m * m * (3.0 - m);
        let slope = k / 6.0 * if x < m { polynomial } else { -m.powi(3) };
        zero += slope * (1.0 - t.cos()) * width / PI;
        moment += 0.5 * slope * ((2.0 * t).cos() - t.cos()) * width;
    }
    [zero, moment]
}
