//! Separation from the trailing edge that follows with a lag, and a vortex that leaves the leading edge.
//!
//! ```text
//! t_1 dx/dS + x = x_0(a - t_2 da/dS),      x_0 = (1 - tanh((|a| - a_s)/w)) / 2                  Goman and Khrabrov
//! cn = cn_att ((1 + sqrt x)/2)^2 + v       cm = cm_att + cn_att (m (1 - x)) - p v
//! t_v dv/dS + v = t_v d/dS [cn_att (1 - ((1 + sqrt x)/2)^2)]   while it grows
//! ```
//! `S` is travel in semichords, `x` the part of the chord with attached flow on the upper side.

/// Constants of the separation of a section.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Stall {
    /// Incidence at which half of the upper side is separated at rest, rad.
    pub angle_rad: f64,
    /// Width of that transition, rad.
    pub width_rad: f64,
    /// Relaxation of the separation, semichords.
    pub relaxation: f64,
    /// Delay of the incidence that it follows, semichords.
    pub delay: f64,
    /// Decay of the vortex, semichords.
    pub vortex_decay: f64,
    /// Moment of the shifted centre of pressure over the attached normal force.
    pub shift: f64,
    /// Moment of the vortex over its normal force.
    pub vortex_arm: f64,
}

impl Stall {
    /// A section that stalls at some incidence, rad.
    pub fn at(angle_rad: f64) -> Self {
        Self {
            angle_rad,
            width_rad: 2.0_f64.to_radians(),
            relaxation: 3.0,
            delay: 4.5,
            vortex_decay: 5.0,
            shift: -0.10,
            vortex_arm: 0.2,
        }
    }

    /// Attached part at rest.
    pub fn attached(&self, incidence_rad: f64) -> f64 {
        0.5 * (1.0 - ((incidence_rad.abs() - self.angle_rad) / self.width_rad).tanh())
    }

    /// Loads of a cycle in place of the attached ones, `[cn, cm, ch]` by uniform phase; `incidence_rad` likewise.
    pub fn cycle(&self, k: f64, incidence_rad: &[f64], attached: &[[f64; 3]]) -> Vec<[f64; 3]> {
        let count = attached.len();
        let step = std::f64::consts::TAU / (k * count as f64);
        let rate = |n: usize| {
            let (before, after) = ((n + count - 1) % count, (n + 1) % count);
            (incidence_rad[after] - incidence_rad[before]) / (2.0 * step)
        };
        let mut x = self.attached(incidence_rad[0]);
        let (mut vortex, mut lost_before) = (0.0, None);
        let mut out = attached.to_vec();
        // the last of five cycles repeats
        for n in (0..5).flat_map(|_| 0..count) {
            let goal = self.attached(incidence_rad[n] - self.delay * rate(n));
            x += (goal - x) * (1.0 - (-step / self.relaxation).exp());
            let [cn, cm, ch] = attached[n];
            let kept = (0.5 * (1.0 + x.max(0.0).sqrt())).powi(2);
            let lost = cn * (1.0 - kept);
            let grown = lost_before.map_or(0.0, |before: f64| (lost - before).max(0.0));
            let grown = if rate(n) > 0.0 { grown } else { 0.0 };
            lost_before = Some(lost);
            vortex = vortex * (-step / self.vortex_decay).exp() + grown;
            let moment = cm + cn * self.shift * (1.0 - x) - self.vortex_arm * vortex;
            out[n] = [cn * kept + vortex, moment, ch * kept + 0.1 * self.shift * (1.0 - x)];
        }
        out
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::f64::consts::TAU;

    fn pitching(mean_deg: f64, k: f64) -> (Vec<f64>, Vec<[f64; 3]>) {
        let incidence: Vec<f64> = (0..720)
            .map(|n| (mean_deg + 5.0 * (TAU * f64::from(n) / 720.0).sin()).to_radians())
            .collect();
        let attached = incidence.iter().map(|own| [TAU * own, 0.0, 0.0]).collect::<Vec<_>>();
        let own = Stall::at(14.0_f64.to_radians()).cycle(k, &incidence, &attached);
        (incidence, own)
    }

    #[test]
    fn far_below_stall_nothing_separates() {
        let (incidence, own) = pitching(0.0, 0.1);
        for (incidence, own) in incidence.iter().zip(&own) {
            assert!((own[0] - TAU * incidence).abs() < 2e-3, "{own:?}");
        }
    }

    #[test]
    fn a_fast_loop_overshoots_and_breaks_in_moment() {
        let highest = |own: &[[f64; 3]]| own.iter().map(|own| own[0]).fold(f64::MIN, f64::max);
        let (_, slow) = pitching(12.0, 0.002);
        let (_, fast) = pitching(12.0, 0.1);
        assert!(highest(&fast) > 1.15 * highest(&slow), "{} {}", highest(&fast), highest(&slow));
        let lowest = fast.iter().map(|own| own[1]).fold(f64::MAX, f64::min);
        assert!(lowest < -0.05, "{lowest}");
        // more lift on the way up than on the way down at the same incidence
        assert!(fast[0][0] > fast[360][0] + 0.1);
    }
}
