//! One actuator: hysteresis, a smooth reversible part, ordinary relaxations.
//!
//! ```text
//! x = a (H[V] - H(rest)) + b (R(V) - R(bias)),   R(V) = v + p v^2 + k tanh(3 v),   v = (V - bias)/85 V
//! y = (1 - s) x + sum_k s_k L_k[x]               L_k: first-order lag of 2 ms .. 30 s
//! ```
//! `a` and `b` give the drawn stroke and loop width over -20..150 V.

use crate::draw::Draw;
use crate::family::{Family, Law};
use crate::filters::Lag;
use crate::runs::{BIAS_VOLT, FULL_VOLT, RANGE_VOLT};

/// An actuator, all of it drawn from its seed.
#[derive(Debug, Clone)]
pub struct Actuator {
    virgin: Law,
    at_rest: f64,
    hysteretic_um: f64,
    reversible_um: f64,
    square: f64,
    bend: f64,
    relaxations: [Relaxation; 5],
    /// Output between the ends of the range, um.
    pub stroke_um: f64,
    /// Largest width of the loop over the range, as a share of the stroke.
    pub loop_width: f64,
    /// Motion from the rest at the bias to the upper end of the range, um.
    pub top_um: f64,
    /// Stiffness, N/um.
    pub stiffness_newton_per_um: f64,
}

/// An ordinary relaxation.
#[derive(Debug, Clone, Copy)]
struct Relaxation {
    share: f64,
    tau_s: f64,
    /// Relative change of `tau_s` over 200 um.
    sensitivity: f64,
}

impl Actuator {
    /// The actuator of a seed.
    pub fn new(family: Family, seed: u64) -> Self {
        let mut draw = Draw::new("actuator", &[seed, family as u64]);
        let virgin = Law::new(family, seed);
        let stroke_um = draw.uniform(300.0, 500.0);
        let loop_width = draw.uniform(0.08, 0.20);
        let (square, bend) = (draw.uniform(-0.10, 0.10), draw.uniform(-0.05, 0.12));
        let (span, width) = major_loop(virgin.clone());
        let mut rested = virgin.clone();
        rested.condition(BIAS_VOLT);
        let hysteretic_um = loop_width * stroke_um / width;
        let reversible = |v: f64| v + square * v * v + bend * (3.0 * v).tanh();
        let mut own = Self {
            virgin,
            at_rest: rested.run_to(BIAS_VOLT),
            hysteretic_um,
            reversible_um: (stroke_um - hysteretic_um * span)
                / (reversible(1.0) - reversible(-1.0)),
            square,
            bend,
            relaxations: [Relaxation { share: 0.0, tau_s: 1.0, sensitivity: 0.0 }; 5],
            stroke_um,
            loop_width,
            top_um: 0.0,
            stiffness_newton_per_um: draw.uniform(0.8, 1.4),
        };
        own.draw_relaxations(&mut draw);
        own.top_um = own.motion_um(&[BIAS_VOLT, RANGE_VOLT.1])[1];
        own
    }

    fn draw_relaxations(&mut self, draw: &mut Draw) {
        let total = draw.uniform(0.02, 0.05);
        let shares = [0; 5].map(|_| draw.uniform(0.4, 1.6));
        let sum: f64 = shares.iter().sum();
        let dependent = draw.below(10);
        for (k, relaxation) in self.relaxations.iter_mut().enumerate() {
            relaxation.share = total * shares[k] / sum;
            // 2 ms to 30 s in four equal steps of the logarithm
            relaxation.tau_s = 0.002 * 15_000.0_f64.powf(k as f64 / 4.0) * draw.uniform(0.8, 1.25);
            relaxation.sensitivity = if k == dependent { 0.2 } else { 0.0 };
        }
    }

    /// Motion from the rest at the bias under terminal voltages (V) without relaxation, after conditioning at
    /// the first of them; um.
    pub(crate) fn motion_um(&self, terminal_volt: &[f64]) -> Vec<f64> {
        let mut law = self.virgin.clone();
        law.condition(terminal_volt[0]);
        let one = |volt: &f64| {
            let v = (volt - BIAS_VOLT) / FULL_VOLT;
            let reversible = v + self.square * v * v + self.bend * (3.0 * v).tanh();
            self.hysteretic_um * (law.run_to(*volt) - self.at_rest)
                + self.reversible_um * reversible
        };
        terminal_volt.iter().map(one).collect()
    }

    /// Puts the ordinary relaxations behind a motion (um) that has been at rest at its first value.
    pub(crate) fn relax(&self, dt_s: f64, motion_um: &mut [f64]) {
        let rest = motion_um[0];
        let mut lags = self.relaxations.map(|r| (r, Lag::new(r.tau_s, dt_s, rest)));
        for x in motion_um {
            let mut relaxed = *x;
            for (r, lag) in &mut lags {
                if r.sensitivity > 0.0 {
                    let tau_s = r.tau_s * (1.0 + r.sensitivity * lag.output() / 200.0).max(0.2);
                    *lag = lag.retuned(tau_s, dt_s);
                }
                relaxed += r.share * (lag.step(*x) - *x);
            }
            *x = relaxed;
        }
    }
}

/// Output between the ends of the range and largest width of the loop between them.
fn major_loop(mut law: Law) -> (f64, f64) {
    let (low, high) = RANGE_VOLT;
    let points: Vec<f64> = (0..=340).map(|i| low + (high - low) * f64::from(i) / 340.0).collect();
    for volt in [high, low, high, low, high] {
        law.run_to(volt);
    }
    let down: Vec<f64> = points.iter().rev().map(|volt| law.run_to(*volt)).collect();
    let up: Vec<f64> = points.iter().map(|volt| law.run_to(*volt)).collect();
    let width = up.iter().zip(down.iter().rev()).map(|(u, d)| d - u).fold(0.0, f64::max);
    (up[340] - up[0], width)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn actuators_have_the_stroke_and_loop_drawn_and_are_monotone() {
        for family in [Family::Relays, Family::Duhem] {
            for seed in 0..40 {
                let own = Actuator::new(family, seed);
                assert!(own.reversible_um > 0.1 * own.stroke_um, "{family:?} {seed}: {own:?}");
                let (span, width) = major_loop(own.virgin.clone());
                assert!(width > 0.2 * span, "{family:?} {seed}: {span} {width}");
                let up: Vec<f64> = (0..=170).map(|i| -20.0 + f64::from(i)).collect();
                let path = [vec![65.0, 150.0, -20.0, 150.0, -20.0], up].concat();
                let motion = own.motion_um(&path);
                let stroke = motion[motion.len() - 1] - motion[4];
                assert!((stroke - own.stroke_um).abs() < 0.02 * stroke, "{stroke}");
                let rising = motion[5..].windows(2).all(|pair| pair[1] > pair[0]);
                assert!(rising, "{family:?} {seed}");
                assert!(motion[0].abs() < 1e-9);
            }
        }
    }
}
