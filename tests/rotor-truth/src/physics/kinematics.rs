//! Motion of the elastic axis at one azimuth.

use super::modes::{Mode, Modes};
use super::span::Span;

/// Bending in one plane, by station.
#[derive(Debug, Clone, Default)]
pub struct Bend {
    /// Displacement.
    pub value: Vec<f64>,
    /// Its slope.
    pub slope: Vec<f64>,
    /// Its second derivative along the span.
    pub curvature: Vec<f64>,
    /// Velocity.
    pub rate: Vec<f64>,
    /// Slope of the velocity.
    pub slope_rate: Vec<f64>,
    /// Acceleration.
    pub acceleration: Vec<f64>,
    /// Slope of the acceleration.
    pub slope_acceleration: Vec<f64>,
}

/// Elastic twist, by station.
#[derive(Debug, Clone, Default)]
pub struct Twist {
    /// Angle.
    pub value: Vec<f64>,
    /// Its slope.
    pub slope: Vec<f64>,
    /// Rate.
    pub rate: Vec<f64>,
    /// Acceleration.
    pub acceleration: Vec<f64>,
}

/// Motion of a blade at an azimuth.
#[derive(Debug, Clone, Default)]
pub struct Snapshot {
    /// Flap.
    pub w: Bend,
    /// Lag, toward the leading edge.
    pub v: Bend,
    /// Torsion, nose up.
    pub phi: Twist,
    /// `u = -1/2 int_0^x (v'^2 + w'^2)`, its rate and acceleration.
    pub u: [Vec<f64>; 3],
}

fn accumulate(out: &mut Vec<f64>, stations: usize, terms: &[(f64, &[f64])]) {
    out.clear();
    out.resize(stations, 0.0);
    for (factor, shape) in terms {
        for (own, value) in out.iter_mut().zip(*shape) {
            *own += factor * value;
        }
    }
}

/// Sums modes; `order` is that of the derivative in time, `of` gives a shape.
fn sum<'a>(
    out: &mut Vec<f64>,
    modes: &'a [Mode],
    q: &[[f64; 3]],
    order: usize,
    of: fn(&'a Mode) -> &'a [f64],
) {
    let stations = modes.first().map_or(0, |own| own.shape.len());
    let terms: Vec<(f64, &[f64])> =
        modes.iter().zip(q).map(|(mode, own)| (own[order], of(mode))).collect();
    accumulate(out, stations, &terms);
}

fn shape(mode: &Mode) -> &[f64] {
    &mode.shape
}

fn slope(mode: &Mode) -> &[f64] {
    &mode.slope
}

fn curvature(mode: &Mode) -> &[f64] {
    &mode.curvature
}

impl Bend {
    fn set(&mut self, modes: &[Mode], q: &[[f64; 3]]) {
        sum(&mut self.value, modes, q, 0, shape);
        sum(&mut self.slope, modes, q, 0, slope);
        sum(&mut self.curvature, modes, q, 0, curvature);
        sum(&mut self.rate, modes, q, 1, shape);
        sum(&mut self.slope_rate, modes, q, 1, slope);
        sum(&mut self.acceleration, modes, q, 2, shape);
        sum(&mut self.slope_acceleration, modes, q, 2, slope);
    }
}

impl Snapshot {
    /// From modal coordinates with two derivatives, in the order flap, lag, torsion.
    pub fn new(modes: &Modes, span: &Span, q: &[[f64; 3]]) -> Self {
        let mut own = Self::default();
        let (flap, rest) = q.split_at(modes.flap.len());
        let (lag, torsion) = rest.split_at(modes.lag.len());
        own.w.set(&modes.flap, flap);
        own.v.set(&modes.lag, lag);
        sum(&mut own.phi.value, &modes.torsion, torsion, 0, shape);
        sum(&mut own.phi.slope, &modes.torsion, torsion, 0, slope);
        sum(&mut own.phi.rate, &modes.torsion, torsion, 1, shape);
        sum(&mut own.phi.acceleration, &modes.torsion, torsion, 2, shape);
        let (w, v) = (&own.w, &own.v);
        let mut integrand = vec![[0.0; 3]; span.len()];
        for (k, out) in integrand.iter_mut().enumerate() {
            for b in [w, v] {
                let (s, sd, sdd) = (b.slope[k], b.slope_rate[k], b.slope_acceleration[k]);
                out[0] -= 0.5 * s * s;
                out[1] -= s * sd;
                out[2] -= sd * sd + s * sdd;
            }
        }
        own.u = std::array::from_fn(|order| {
            let f: Vec<f64> = integrand.iter().map(|own| own[order]).collect();
            let mut out = vec![0.0; span.len()];
            span.from_root(&f, &mut out);
            out
        });
        own
    }
}
