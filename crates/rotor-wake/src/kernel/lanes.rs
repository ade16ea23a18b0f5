//! The arithmetic of the kernel over a block of targets, written so that the compiler makes vector
//! instructions of it.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use super::prepared::Prepared;
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

/// `a b + c`, rounded once where the vector unit does so (`FUSED`).
#[inline(always)]
fn fused<const FUSED: bool>(a: f64, b: f64, c: f64) -> f64 {
    if FUSED { a.mul_add(b, c) } else { a * b + c }
}

#[inline(always)]
fn inner<const FUSED: bool>(a: Vec3, b: Vec3) -> f64 {
    fused::<FUSED>(a[0], b[0], fused::<FUSED>(a[1], b[1], a[2] * b[2]))
}

/// How the core enters, for a target at `r1` and `r2` from the ends of a segment and `cross = |l x r1|^2`:
/// `(l.r1 / |r1| - l.r2 / |r2|) / D`.
///
/// Rosenhead and Moore's cut-off (`MOORE`): `1/|r1|`, `1/|r2|` and `1/D` in one quotient,
///
/// ```text
/// (l.r1 |r2| - l.r2 |r1|) / (|r1| |r2| D)
/// ```
/// Vatistas's profile with n = 2: with `p = |r1| |r2|` and `q = r1.r2` two roots and a quotient,
///
/// ```text
/// (l.r1 / |r1| - l.r2 / |r2|) / D = (p - q) sqrt( (r1^2 + r2^2 + 2 p) / (r1^2 r2^2 D^2) ),   l = r1 - r2
/// ```
/// where `p - q = |l x r1|^2 / (p + q)` keeps the digits of a segment seen under a sharp angle.
#[inline(always)]
fn factor<const MOORE: bool, const FUSED: bool>(
    [r1, r2]: [Vec3; 2],
    cross: f64,
    segment: &Prepared,
) -> f64 {
    let inner = inner::<FUSED>;
    if MOORE {
        let (lr1, lr2) = (inner(segment.along, r1), inner(segment.along, r2));
        let a = (inner(r1, r1) + segment.cut_off).sqrt();
        let b = (inner(r2, r2) + segment.cut_off).sqrt();
        return (lr1 * b - lr2 * a) / (a * b * (cross + segment.core) + GUARD);
    }
    let (s1, s2, q) = (inner(r1, r1), inner(r2, r2), inner(r1, r2));
    let product = s1 * s2;
    let p = product.sqrt();
    let sharp = q > 0.0;
    let above = if sharp { cross } else { p - q };
    let below = if sharp { p + q } else { 1.0 };
    let fused = fused::<FUSED>;
    let d = fused(cross, cross, segment.core);
    let denominator = fused(product * d, below * below, GUARD * GUARD);
    above * (fused(2.0, p, s1 + s2) / denominator).sqrt()
}

/// Adds the velocity by one segment to every target's sum.
///
/// The vector product is not fused: at the ends of a segment its terms have to cancel without a rest.
#[inline(always)]
pub(super) fn add_velocity<const MOORE: bool, const FUSED: bool>(
    at: &Lanes,
    segment: &Prepared,
    sum: &mut Lanes,
) {
    let fused = fused::<FUSED>;
    let ([sx, sy, sz], [lx, ly, lz]) = (segment.start, segment.along);
    for k in 0..LANES {
        let (x, y, z) = (at.x[k] - sx, at.y[k] - sy, at.z[k] - sz);
        let (cx, cy, cz) = (ly * z - lz * y, lz * x - lx * z, lx * y - ly * x);
        let product = [cx, cy, cz];
        let cross = inner::<FUSED>(product, product);
        let ends = [[x, y, z], [x - lx, y - ly, z - lz]];
        let factor = segment.strength * factor::<MOORE, FUSED>(ends, cross, segment);
        sum.x[k] = fused(factor, cx, sum.x[k]);
        sum.y[k] = fused(factor, cy, sum.y[k]);
        sum.z[k] = fused(factor, cz, sum.z[k]);
    }
}
