//! Bouc-Wen elements of several widths beside bent plays.
//!
//! ```text
//! dz/du = (1 - |z| (beta sgn(z du) + 1 - beta))/w        |z| -> 1 along a long way
//! H = sum_k c_k (v - w_k z_k)/85 V + sum_j d_j tanh(p_j/s_j),   p = play of v = u - bias
//! ```
//! `z` turns at once with the voltage, so that `v - w z` lags behind it.
//!
//! With `q = z sgn(du)` and `X = |du|/w` an element is exact on a straight run: `dq/dX = 1 - q` for `q > 0`,
//! `dq/dX = 1 + (1 - 2 beta) q` below. For `beta` = 1/2 and from `z` = 0 that is Duhem's and Dahl's limit.
//!
//! Source: Y. K. Wen, J. Eng. Mech. 102 (1976) 249; B. D. Coleman, M. L. Hodgdon, Int. J. Eng. Sci. 24 (1986) 897.

use crate::draw::Draw;
use crate::runs::{BIAS_VOLT, FULL_VOLT};

/// A Bouc-Wen element.
#[derive(Debug, Clone, Copy)]
struct Element {
    width_volt: f64,
    beta: f64,
    weight: f64,
    z: f64,
}

impl Element {
    fn run(&mut self, travel_volt: f64) {
        if travel_volt.abs() > 0.0 {
            let sign = travel_volt.signum();
            self.z = sign * along(sign * self.z, travel_volt.abs() / self.width_volt, self.beta);
        }
    }
}

/// `q` after a way `x` (in widths) from `q`.
fn along(q: f64, x: f64, beta: f64) -> f64 {
    if q >= 0.0 {
        return 1.0 - (1.0 - q) * (-x).exp();
    }
    // q' = 1 + r q with q < 0; zero is reached at X = -ln(1 + r q)/r
    let r = 1.0 - 2.0 * beta;
    if r.abs() < 1e-9 {
        let over = q + x;
        return if over < 0.0 { over } else { 1.0 - (-over).exp() };
    }
    let to_zero = -(r * q).ln_1p() / r;
    if x < to_zero { ((1.0 + r * q) * (r * x).exp() - 1.0) / r } else { 1.0 - (to_zero - x).exp() }
}

/// A play whose output is bent.
#[derive(Debug, Clone, Copy)]
struct BentPlay {
    half_width_volt: f64,
    scale_volt: f64,
    weight: f64,
    play_volt: f64,
}

/// Elements and plays with their state.
#[derive(Debug, Clone)]
pub(crate) struct Duhem {
    elements: Vec<Element>,
    plays: Vec<BentPlay>,
    volt: f64,
}

impl Duhem {
    /// Those of a seed, at rest at the bias.
    pub(super) fn of_seed(seed: u64) -> Self {
        let mut draw = Draw::new("duhem", &[seed]);
        let count = 3 + draw.below(2);
        let widths = [9.0, 24.0, 55.0, 110.0];
        let elements = widths[4 - count..].iter().map(|width| Element {
            width_volt: width * draw.uniform(0.8, 1.25),
            beta: draw.uniform(0.5, 0.62),
            weight: draw.uniform(0.5, 1.5) / count as f64,
            z: 0.0,
        });
        let elements = elements.collect();
        let plays = [6.0, 16.0, 34.0].map(|half_width| BentPlay {
            half_width_volt: half_width * draw.uniform(0.75, 1.3),
            scale_volt: draw.uniform(60.0, 110.0),
            weight: draw.uniform(0.4, 0.9),
            play_volt: 0.0,
        });
        Self { elements, plays: plays.to_vec(), volt: BIAS_VOLT }
    }

    /// The output after a straight run to `volt`.
    pub(super) fn run_to(&mut self, volt: f64) -> f64 {
        let travel = volt - self.volt;
        self.volt = volt;
        let deviation = volt - BIAS_VOLT;
        let mut output = 0.0;
        for element in &mut self.elements {
            element.run(travel);
            output += element.weight * (deviation - element.width_volt * element.z) / FULL_VOLT;
        }
        for play in &mut self.plays {
            let half = play.half_width_volt;
            play.play_volt = play.play_volt.clamp(deviation - half, deviation + half);
            output += play.weight * (play.play_volt / play.scale_volt).tanh();
        }
        output
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn an_element_without_asymmetry_is_the_exponential_of_duhem() {
        // beta = 1/2: from the lower end, q = -1 + X to zero, then 1 - exp(-(X - 1))
        let formula = |x: f64| if x < 1.0 { -1.0 + x } else { 1.0 - (1.0 - x).exp() };
        // beta = 1: 1 - |z| sgn(z du): q = 1 - 2 exp(-X) throughout, the model of Dahl
        let dahl = |x: f64| 1.0 - 2.0 * (-x).exp();
        for i in 1..40 {
            let x = 0.1 * f64::from(i);
            assert!((along(-1.0, x, 0.5) - formula(x)).abs() < 1e-12);
            assert!((along(-1.0 + 1e-12, x, 1.0) - dahl(x)).abs() < 1e-9);
        }
    }

    #[test]
    fn an_element_follows_its_differential_equation() {
        for beta in [0.3, 0.5, 0.55, 0.8] {
            let (mut q, steps) = (-0.9_f64, 200_000);
            let h = 2.5 / f64::from(steps);
            for _ in 0..steps {
                q += h * (1.0 - q.abs() * (beta * q.signum() + 1.0 - beta));
            }
            assert!((q - along(-0.9, 2.5, beta)).abs() < 1e-4, "{beta}");
        }
    }
}
