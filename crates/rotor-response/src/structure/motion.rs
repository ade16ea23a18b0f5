//! Deflections, rates and accelerations of the blade at the stations, at one azimuth.

use crate::structure::blade::{ResponseBlade, Shapes};

/// Displacement family at the stations: value, slope, curvature; rates of value and slope;
/// accelerations of value and slope. Radius R and rad; time is azimuth.
#[derive(Debug, Clone, Default)]
pub(crate) struct Deflection {
    pub(crate) value: Vec<f64>,
    pub(crate) slope: Vec<f64>,
    pub(crate) curvature: Vec<f64>,
    pub(crate) rate: Vec<f64>,
    pub(crate) slope_rate: Vec<f64>,
    pub(crate) acceleration: Vec<f64>,
    pub(crate) slope_acceleration: Vec<f64>,
}

/// `out = sum_j coefficient_j shape_j`.
fn combine(out: &mut Vec<f64>, shapes: &[Vec<f64>], coefficients: &[f64], stations: usize) {
    out.clear();
    out.resize(stations, 0.0);
    for (shape, &c) in shapes.iter().zip(coefficients) {
        for (o, s) in out.iter_mut().zip(shape) {
            *o += c * s;
        }
    }
}

impl Deflection {
    fn fill(&mut self, shapes: &Shapes, [q, qd, qdd]: [&[f64]; 3], stations: usize) {
        combine(&mut self.value, &shapes.value, q, stations);
        combine(&mut self.slope, &shapes.slope, q, stations);
        combine(&mut self.curvature, &shapes.curvature, q, stations);
        combine(&mut self.rate, &shapes.value, qd, stations);
        combine(&mut self.slope_rate, &shapes.slope, qd, stations);
        combine(&mut self.acceleration, &shapes.value, qdd, stations);
        combine(&mut self.slope_acceleration, &shapes.slope, qdd, stations);
    }
}

/// The whole elastic motion at one azimuth: flap `w` (up), lag `v` (toward the leading edge), elastic
/// twist `phi` (nose up).
#[derive(Debug, Clone, Default)]
pub(crate) struct Motion {
    pub(crate) w: Deflection,
    pub(crate) v: Deflection,
    pub(crate) phi: Deflection,
    /// Axial displacement by foreshortening with two rates; none of an inextensional blade.
    shortening: [Vec<f64>; 3],
}

impl Motion {
    /// Fills the motion from modal coordinates in the order flap, lag, torsion.
    pub(crate) fn fill(&mut self, blade: &ResponseBlade, coordinates: [&[f64]; 3]) {
        let stations = blade.grid.len();
        let (nf, nl) = (blade.flap.count(), blade.lag.count());
        let part = |from: usize, to: usize| coordinates.map(|of| &of[from..to]);
        self.w.fill(&blade.flap, part(0, nf), stations);
        self.v.fill(&blade.lag, part(nf, nf + nl), stations);
        self.phi.fill(&blade.torsion, part(nf + nl, coordinates[0].len()), stations);
        if blade.modal.is_some() {
            self.shorten(blade);
        }
    }

    /// `u = -int_0^x (v_x^2 + w_x^2) / 2` with its rates.
    fn shorten(&mut self, blade: &ResponseBlade) {
        let stations = blade.grid.len();
        let mut integrand = vec![0.0; stations];
        for (k, out) in self.shortening.iter_mut().enumerate() {
            for (i, value) in integrand.iter_mut().enumerate() {
                let of = |d: &Deflection| match k {
                    0 => 0.5 * d.slope[i] * d.slope[i],
                    1 => d.slope[i] * d.slope_rate[i],
                    _ => d.slope_rate[i].powi(2) + d.slope[i] * d.slope_acceleration[i],
                };
                *value = -(of(&self.v) + of(&self.w));
            }
            out.resize(stations, 0.0);
            blade.grid.integral_from_root(&integrand, out);
        }
    }

    /// Axial displacement of a station by foreshortening with two rates, R; nothing unless the couplings are
    /// `Moderate`.
    pub(crate) fn shortening(&self, station: usize) -> [f64; 3] {
        self.shortening.each_ref().map(|of| of.get(station).copied().unwrap_or(0.0))
    }
}
