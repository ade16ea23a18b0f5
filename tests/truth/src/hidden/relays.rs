//! Rate-independent hysteresis of many relays (Preisach) with a two-sided Gaussian density.
//!
//! ```text
//! h(u) = sum_k w_k s_k[u],   s_k = +1 once u >= alpha_k, -1 once u <= beta_k
//! w_k ~ exp(-r^2/(2 sigma_r^2)) (left: sigma_l, right: sigma_h of the centre c),
//! r = (alpha - beta)/2 > 0,  c = (alpha + beta)/2,   (r, c) quasi-random, R2 sequence
//! ```
//! The thresholds are sorted once; a step passes over the relays between the old and the new voltage
//! and no others, so that its cost is that of the relays that can switch.
//!
//! Source: F. Preisach, Z. Phys. 94 (1935) 277; the R2 sequence after M. Roberts (2018): multiples of
//! the inverse powers of the plastic number.

use crate::stage::Stage;

/// Parameters of [`Relays`].
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct RelayParameters {
    /// Number of relays.
    pub relays: u32,
    /// Output between all relays down and all up, um.
    pub stroke_um: f64,
    /// Deviation of the half-width `r`, V.
    pub half_width_volt: f64,
    /// Centre of the density, V.
    pub centre_volt: f64,
    /// Deviation of the centre below and above, V.
    pub spread_volt: (f64, f64),
    /// Centres and half-widths reach to that many volts from the centre of the density.
    pub reach_volt: f64,
}

/// The relays with their state.
#[derive(Debug, Clone)]
pub struct Relays {
    weight_um: Vec<f64>,
    centre_volt: Vec<f64>,
    up: Vec<bool>,
    /// Thresholds in ascending order, each with its relay.
    rising: Vec<(f64, u32)>,
    falling: Vec<(f64, u32)>,
    /// Number of rising thresholds at or below the voltage, of falling thresholds below it.
    risen: usize,
    fallen: usize,
    voltage_volt: f64,
    output_um: f64,
}

impl Relays {
    /// Relays at rest at a voltage.
    pub fn new(parameters: &RelayParameters, rest_volt: f64) -> Self {
        let p = parameters;
        // The plastic number, root of x^3 = x + 1.
        let plastic = 1.324_717_957_244_746_f64;
        let (mut weight_um, mut centre_volt) = (Vec::new(), Vec::new());
        let (mut rising, mut falling) = (Vec::new(), Vec::new());
        for k in 0..p.relays {
            let n = f64::from(k) + 0.5;
            let half_width = p.reach_volt * (n / plastic).fract();
            let offset = p.reach_volt * (2.0 * (n / (plastic * plastic)).fract() - 1.0);
            let spread = if offset < 0.0 { p.spread_volt.0 } else { p.spread_volt.1 };
            let square = (half_width / p.half_width_volt).powi(2) + (offset / spread).powi(2);
            weight_um.push((-0.5 * square).exp());
            centre_volt.push(p.centre_volt + offset);
            rising.push((p.centre_volt + offset + half_width, k));
            falling.push((p.centre_volt + offset - half_width, k));
        }
        let total: f64 = weight_um.iter().sum();
        for w in &mut weight_um {
            *w *= 0.5 * p.stroke_um / total;
        }
        rising.sort_by(|a, b| a.0.total_cmp(&b.0));
        falling.sort_by(|a, b| a.0.total_cmp(&b.0));
        let up = vec![false; weight_um.len()];
        let mut relays = Self {
            weight_um,
            centre_volt,
            up,
            rising,
            falling,
            risen: 0,
            fallen: 0,
            voltage_volt: rest_volt,
            output_um: 0.0,
        };
        relays.settle(rest_volt);
        relays
    }
}

impl Stage for Relays {
    /// After loops of slowly shrinking amplitude about the input: a relay is up if its centre lies
    /// below.
    fn settle(&mut self, input: f64) -> f64 {
        self.voltage_volt = input;
        self.output_um = 0.0;
        for ((up, centre), weight) in self.up.iter_mut().zip(&self.centre_volt).zip(&self.weight_um)
        {
            *up = *centre < input;
            self.output_um += if *up { *weight } else { -*weight };
        }
        self.risen = self.rising.partition_point(|(threshold, _)| *threshold <= input);
        self.fallen = self.falling.partition_point(|(threshold, _)| *threshold < input);
        self.output_um
    }

    fn step(&mut self, input: f64, _dt_s: f64) -> f64 {
        if input > self.voltage_volt {
            while let Some(&(threshold, k)) = self.rising.get(self.risen)
                && threshold <= input
            {
                let k = k as usize;
                if !self.up[k] {
                    self.up[k] = true;
                    self.output_um += 2.0 * self.weight_um[k];
                }
                self.risen += 1;
            }
            while self.falling.get(self.fallen).is_some_and(|(threshold, _)| *threshold < input) {
                self.fallen += 1;
            }
        } else {
            while self.fallen > 0 && self.falling[self.fallen - 1].0 >= input {
                let k = self.falling[self.fallen - 1].1 as usize;
                if self.up[k] {
                    self.up[k] = false;
                    self.output_um -= 2.0 * self.weight_um[k];
                }
                self.fallen -= 1;
            }
            while self.risen > 0 && self.rising[self.risen - 1].0 > input {
                self.risen -= 1;
            }
        }
        self.voltage_volt = input;
        self.output_um
    }
}
