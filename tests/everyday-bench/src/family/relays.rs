//! Relays with random thresholds (Preisach).
//!
//! ```text
//! H = sum_k w_k s_k,   s_k = 1 from u >= a_k on, 0 from u <= b_k on
//! (a, b) Gaussian about (m + h, m - h), correlated, drawn anew where a <= b
//! ```
//! Source: F. Preisach, Z. Phys. 94 (1935) 277.

use crate::draw::Draw;

/// Number of relays.
const RELAYS: usize = 3000;

/// The relays with their state.
#[derive(Debug, Clone)]
pub(crate) struct Relays {
    /// Thresholds upward, ascending, V, each with its relay.
    upward: Vec<(f64, usize)>,
    /// Thresholds downward, ascending, V, each with its relay.
    downward: Vec<(f64, usize)>,
    weight: Vec<f64>,
    is_up: Vec<bool>,
    volt: f64,
    output: f64,
}

impl Relays {
    /// The relays of a seed, all down, at a voltage below all thresholds.
    pub(super) fn of_seed(seed: u64) -> Self {
        let mut draw = Draw::new("relays", &[seed]);
        let middle_volt = draw.uniform(55.0, 80.0);
        let half_width_volt = draw.uniform(16.0, 28.0);
        let deviation_volt = draw.uniform(38.0, 60.0);
        let correlation = draw.uniform(0.55, 0.8);
        let (mut upward, mut downward) = (Vec::new(), Vec::new());
        while upward.len() < RELAYS {
            let (p, q) = (draw.normal(), draw.normal());
            let other = correlation * p + (1.0 - correlation * correlation).sqrt() * q;
            let a = middle_volt + half_width_volt + deviation_volt * p;
            let b = middle_volt - half_width_volt + deviation_volt * other;
            if a > b {
                let relay = upward.len();
                upward.push((a, relay));
                downward.push((b, relay));
            }
        }
        upward.sort_by(|x, y| x.0.total_cmp(&y.0));
        downward.sort_by(|x, y| x.0.total_cmp(&y.0));
        let weight = (0..RELAYS).map(|_| draw.uniform(0.5, 1.5) / RELAYS as f64).collect();
        let is_up = vec![false; RELAYS];
        Self { upward, downward, weight, is_up, volt: -1000.0, output: 0.0 }
    }

    /// Passes over the thresholds between the last voltage and `volt`.
    pub(super) fn run_to(&mut self, volt: f64) -> f64 {
        if volt > self.volt {
            let first = self.upward.partition_point(|(a, _)| *a <= self.volt);
            for (_, k) in self.upward[first..].iter().take_while(|(a, _)| *a <= volt) {
                self.output += if self.is_up[*k] { 0.0 } else { self.weight[*k] };
                self.is_up[*k] = true;
            }
        } else {
            let end = self.downward.partition_point(|(b, _)| *b < self.volt);
            for (_, k) in self.downward[..end].iter().rev().take_while(|(b, _)| *b >= volt) {
                self.output -= if self.is_up[*k] { self.weight[*k] } else { 0.0 };
                self.is_up[*k] = false;
            }
        }
        self.volt = volt;
        self.output
    }
}
