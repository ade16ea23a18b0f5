//! The arithmetic of the kernel over a block of targets, written so that the compiler makes vector
//! instructions of it.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use super::segment::Prepared;
use crate::vector::Vec3;

/// Targets in a block.
pub(crate) const LANES: usize = 8;

/// Three components at every target of a block.
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct Lanes {
    x: [f64; LANES],
    y: [f64; LANES],
    z: [f64; LANES],
}

impl Lanes {
    /// A block of at most [`LANES`] points; the last one fills the rest.
    pub(super) fn gather(points: &[Vec3]) -> Self {
        let mut out = Self::default();
        for k in 0..LANES {
            let [x, y, z] = points.get(k).or(points.last()).copied().unwrap_or_default();
            (out.x[k], out.y[k], out.z[k]) = (x, y, z);
        }
        out
    }

    pub(super) fn scatter(&self, out: &mut [Vec3]) {
        for (k, o) in out.iter_mut().enumerate().take(LANES) {
            *o = [self.x[k], self.y[k], self.z[k]];
        }
    }

    pub(super) fn components(&self) -> [&[f64; LANES]; 3] {
        [&self.x, &self.y, &self.z]
    }
}

/// Makes the quotient 0/0 of a target at the end of a segment zero; far below any `|r1| |r2| D`.
const GUARD: f64 = 1e-60;

/// How the core enters.
pub(super) trait Law {
    /// `1/|r1|`, `1/|r2|` and `1/D` in one quotient: `(l.r1 |r2| - l.r2 |r1|) / (|r1| |r2| D)`.
    fn factor(lr: [f64; 2], squares: [f64; 2], cross: f64, segment: &Prepared) -> f64;
}

/// Vatistas's profile with n = 2.
pub(super) struct Vatistas;

impl Law for Vatistas {
    #[inline(always)]
    fn factor(lr: [f64; 2], squares: [f64; 2], cross: f64, segment: &Prepared) -> f64 {
        let (a, b) = (squares[0].sqrt(), squares[1].sqrt());
        let d = (cross * cross + segment.core).sqrt();
        (lr[0] * b - lr[1] * a) / (a * b * d + GUARD)
    }
}

/// Rosenhead and Moore's cut-off.
pub(super) struct RosenheadMoore;

impl Law for RosenheadMoore {
    #[inline(always)]
    fn factor(lr: [f64; 2], squares: [f64; 2], cross: f64, segment: &Prepared) -> f64 {
        let (a, b) = ((squares[0] + segment.cut_off).sqrt(), (squares[1] + segment.cut_off).sqrt());
        (lr[0] * b - lr[1] * a) / (a * b * (cross + segment.core) + GUARD)
    }
}

/// Adds the velocity by one segment to every target's sum.
#[inline(always)]
pub(super) fn add_velocity<L: Law>(at: &Lanes, segment: &Prepared, sum: &mut Lanes) {
    let ([sx, sy, sz], [lx, ly, lz]) = (segment.start, segment.along);
    for k in 0..LANES {
        let (x, y, z) = (at.x[k] - sx, at.y[k] - sy, at.z[k] - sz);
        let (x2, y2, z2) = (x - lx, y - ly, z - lz);
        let (cx, cy, cz) = (ly * z - lz * y, lz * x - lx * z, lx * y - ly * x);
        let lr = [lx * x + ly * y + lz * z, lx * x2 + ly * y2 + lz * z2];
        let squares = [x * x + y * y + z * z, x2 * x2 + y2 * y2 + z2 * z2];
        let cross = cx * cx + cy * cy + cz * cz;
        let factor = segment.strength * L::factor(lr, squares, cross, segment);
        sum.x[k] += factor * cx;
        sum.y[k] += factor * cy;
        sum.z[k] += factor * cz;
    }
}
