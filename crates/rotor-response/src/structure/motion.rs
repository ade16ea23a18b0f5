//! Deflections, rates and accelerations of the blade: at all stations at one azimuth, or at one station at all
//! azimuth points of a revolution.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use crate::Couplings;
use crate::structure::blade::{ResponseBlade, Shapes};
use pulp::{Arch, Simd, WithSimd};
use rotor_base::{LANES, Lanes, Number};
use rotor_fem::OrbitSamples;
use std::ops::Range;

/// Displacement family in lanes, stations or azimuth points: value, slope, curvature; rates of value and slope;
/// accelerations of value and slope. Radius R and rad; time is azimuth. Of twist neither curvature nor acceleration of
/// the slope, for which nothing asks.
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

/// `out = sum_j factor_j row_j`, lane by lane.
#[inline(always)]
fn combine<'a>(out: &mut Vec<f64>, lanes: usize, terms: impl Iterator<Item = (f64, &'a [f64])>) {
    out.clear();
    out.resize(lanes, 0.0);
    for (factor, row) in terms {
        for (sum, value) in out.iter_mut().zip(row) {
            *sum += factor * value;
        }
    }
}

/// A field at a lane, or at a block of lanes.
macro_rules! fields_in_lanes {
    ($($field:ident)*) => {
        impl Deflection {$(
            #[inline(always)]
            pub(crate) fn $field<T: Number>(&self, lane: usize) -> T {
                T::read(&self.$field, lane)
            }
        )*}
    };
}

fields_in_lanes!(value slope curvature rate slope_rate acceleration);

impl Deflection {
    /// Every field with the shapes it is made of, and which of coordinates, rates and accelerations go with them.
    #[inline(always)]
    fn fields<'a>(&'a mut self, shapes: &'a Shapes) -> [Field<'a>; 7] {
        let Shapes { value, slope, curvature, bend } = shapes;
        let bent = |of: &'a Vec<Vec<f64>>| if *bend { of.as_slice() } else { &[] };
        [
            (&mut self.value, value, 0),
            (&mut self.slope, slope, 0),
            (&mut self.rate, value, 1),
            (&mut self.acceleration, value, 2),
            (&mut self.curvature, bent(curvature), 0),
            (&mut self.slope_rate, slope, 1),
            (&mut self.slope_acceleration, bent(slope), 2),
        ]
    }
}

/// A field, the shapes it is made of, and which of coordinates, rates and accelerations go with them.
type Field<'a> = (&'a mut Vec<f64>, &'a [Vec<f64>], usize);

/// Modal motion over a revolution, mode by mode in the order flap, lag, torsion: a lane for every azimuth point, and lanes
/// at rest that fill the last block.
#[derive(Debug, Clone, Default)]
pub(crate) struct ModalRows {
    lanes: usize,
    /// Coordinates, rates, accelerations.
    parts: [Vec<f64>; 3],
}

impl ModalRows {
    /// Those of an orbit at all its points.
    pub(crate) fn fill(&mut self, samples: &OrbitSamples) {
        let (dof, points) = samples.q.shape();
        let lanes = points.next_multiple_of(LANES);
        self.lanes = lanes;
        for (part, of) in self.parts.iter_mut().zip([&samples.q, &samples.qd, &samples.qdd]) {
            part.clear();
            part.resize(dof * lanes, 0.0);
            for (p, column) in of.as_slice().chunks_exact(dof).enumerate() {
                for (j, value) in column.iter().enumerate() {
                    part[j * lanes + p] = *value;
                }
            }
        }
    }

    /// Those of one state, in the first lane.
    pub(crate) fn fill_state(&mut self, coordinates: [&[f64]; 3]) {
        self.lanes = LANES;
        for (part, of) in self.parts.iter_mut().zip(coordinates) {
            part.clear();
            for value in of {
                part.push(*value);
                part.resize(part.len() + LANES - 1, 0.0);
            }
        }
    }

    /// Points, and what fills the last block of them.
    pub(crate) fn lanes(&self) -> usize {
        self.lanes
    }

    /// Coordinates (0), rates (1) or accelerations (2) of the modes from one on.
    #[inline(always)]
    fn from(&self, part: usize, mode: usize) -> impl Iterator<Item = &[f64]> {
        self.parts[part].chunks_exact(self.lanes).skip(mode)
    }

    /// Coordinates, rates and accelerations of all modes in a block of lanes.
    pub(crate) fn block(&self, block: usize) -> [Vec<Lanes>; 3] {
        let of = |part: usize| self.from(part, 0).map(|row| Lanes::read(row, block)).collect();
        [of(0), of(1), of(2)]
    }

    /// Sum of the rows of a family, each times what `factor` says of its number in the family.
    #[inline(always)]
    pub(crate) fn sum(
        &self,
        out: &mut Vec<f64>,
        (part, first): (usize, usize),
        factors: impl Iterator<Item = f64>,
    ) {
        combine(out, self.lanes, factors.zip(self.from(part, first)));
    }
}

/// The whole elastic motion in lanes: flap `w` (up), lag `v` (toward the leading edge), elastic twist `phi` (nose up).
#[derive(Debug, Clone, Default)]
pub(crate) struct Motion {
    pub(crate) w: Deflection,
    pub(crate) v: Deflection,
    pub(crate) phi: Deflection,
    /// Axial displacement by foreshortening with two rates; none of an inextensional blade.
    shortening: [Vec<f64>; 3],
}

impl Motion {
    /// Fills the motion at all stations from modal coordinates in the order flap, lag, torsion.
    pub(crate) fn fill(&mut self, blade: &ResponseBlade, coordinates: [&[f64]; 3]) {
        let stations = blade.grid.len();
        for (deflection, shapes, first) in self.families(blade) {
            for (out, shapes, part) in deflection.fields(shapes) {
                let factors = coordinates[part][first..].iter().copied();
                combine(out, stations, factors.zip(shapes.iter().map(Vec::as_slice)));
            }
        }
        if blade.modal.is_some() {
            let mut integrand = vec![0.0; stations];
            for k in 0..3 {
                for (i, value) in integrand.iter_mut().enumerate() {
                    *value = -self.shortening_slope(k, i);
                }
                self.shortening[k].resize(stations, 0.0);
                blade.grid.integral_from_root(&integrand, &mut self.shortening[k]);
            }
        }
    }

    /// Fills the motion of station `i` at all lanes of modal rows.
    pub(crate) fn fill_station(
        &mut self,
        blade: &ResponseBlade,
        i: usize,
        rows: &ModalRows,
        foreshortening: &Foreshortening,
    ) {
        Arch::new().dispatch(Filling { motion: self, blade, i, rows });
        if blade.modal.is_some() {
            for (k, out) in self.shortening.iter_mut().enumerate() {
                out.clear();
                out.extend(foreshortening.at(k, i).iter().map(|u| -u));
            }
        }
    }

    #[inline(always)]
    fn families<'a>(
        &'a mut self,
        blade: &'a ResponseBlade,
    ) -> [(&'a mut Deflection, &'a Shapes, usize); 3] {
        let (flap, lag) = (blade.flap.count(), blade.lag.count());
        [
            (&mut self.w, &blade.flap, 0),
            (&mut self.v, &blade.lag, flap),
            (&mut self.phi, &blade.torsion, flap + lag),
        ]
    }

    /// `(v_x^2 + w_x^2) / 2` or one of its rates.
    #[inline(always)]
    fn shortening_slope(&self, rate: usize, lane: usize) -> f64 {
        let of = |d: &Deflection| match rate {
            0 => 0.5 * d.slope[lane] * d.slope[lane],
            1 => d.slope[lane] * d.slope_rate[lane],
            _ => d.slope_rate[lane].powi(2) + d.slope[lane] * d.slope_acceleration[lane],
        };
        of(&self.v) + of(&self.w)
    }

    /// Axial displacement by foreshortening (0) and its rates (1, 2), R; none but with `Moderate`.
    pub(crate) fn shortening_mut(&mut self, rate: usize) -> &mut Vec<f64> {
        &mut self.shortening[rate]
    }

    /// Axial displacement in a lane, or a block of lanes, by foreshortening with two rates, R; nothing unless the couplings
    /// are `Moderate`.
    #[inline(always)]
    pub(crate) fn shortening<T: Number>(&self, lane: usize) -> [T; 3] {
        let [u, rate, acceleration] = &self.shortening;
        if u.is_empty() {
            [T::default(); 3]
        } else {
            [T::read(u, lane), T::read(rate, lane), T::read(acceleration, lane)]
        }
    }
}

/// Motion of one station: a type of its own, for a closure would be called, not inlined, by the function that is
/// compiled for the vector unit.
struct Filling<'a> {
    motion: &'a mut Motion,
    blade: &'a ResponseBlade,
    i: usize,
    rows: &'a ModalRows,
}

impl WithSimd for Filling<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        for (deflection, shapes, first) in self.motion.families(self.blade) {
            for (out, shapes, part) in deflection.fields(shapes) {
                self.rows.sum(out, (part, first), shapes.iter().map(|shape| shape[self.i]));
            }
        }
    }
}

/// Foreshortening of the blade at all stations and lanes, `int_0^x (v_x^2 + w_x^2) / 2`, with its rates.
#[derive(Debug, Clone, Default)]
pub(crate) struct Foreshortening {
    lanes: usize,
    /// Shape stations x lanes, as far as the couplings ask for it.
    parts: [Vec<f64>; 3],
    motion: Motion,
    integrand: Vec<f64>,
    total: Vec<f64>,
}

impl Foreshortening {
    /// What the couplings ask for: all of it with `Moderate`, the rate with `Full`, nothing with `Linear`.
    pub(crate) fn fill(&mut self, blade: &ResponseBlade, couplings: Couplings, rows: &ModalRows) {
        self.lanes = rows.lanes();
        let wanted = match couplings {
            Couplings::Linear => 0..0,
            Couplings::Full => 1..2,
            Couplings::Moderate(_) => 0..3,
        };
        Arch::new().dispatch(Shortening { of: self, blade, rows, wanted });
    }

    /// Of a station in all lanes; empty where the couplings do not ask for it.
    pub(crate) fn at(&self, rate: usize, station: usize) -> &[f64] {
        let from = station * self.lanes;
        self.parts[rate].get(from..from + self.lanes).unwrap_or_default()
    }
}

/// Foreshortening at all stations: a type of its own as [`Filling`] is.
struct Shortening<'a> {
    of: &'a mut Foreshortening,
    blade: &'a ResponseBlade,
    rows: &'a ModalRows,
    /// The displacement (0) and its rates (1, 2) that are asked for.
    wanted: Range<usize>,
}

impl WithSimd for Shortening<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        let Self { of, blade, rows, wanted } = self;
        let Foreshortening { lanes, parts, motion, integrand, total } = of;
        let (stations, lanes) = (blade.grid.len(), *lanes);
        for k in wanted {
            integrand.resize(stations * lanes, 0.0);
            for (i, integrand) in integrand.chunks_exact_mut(lanes).enumerate() {
                for (d, shapes, first) in motion.families(blade).into_iter().take(2) {
                    let slopes = || shapes.slope.iter().map(|shape| shape[i]);
                    let fields = [&mut d.slope, &mut d.slope_rate, &mut d.slope_acceleration];
                    for (part, field) in fields.into_iter().enumerate().take(k + 1) {
                        rows.sum(field, (part, first), slopes());
                    }
                }
                for (lane, value) in integrand.iter_mut().enumerate() {
                    *value = motion.shortening_slope(k, lane);
                }
            }
            parts[k].resize(stations * lanes, 0.0);
            total.resize(lanes, 0.0);
            blade.grid.integrals_from_root(integrand, &mut parts[k], total);
        }
    }
}
