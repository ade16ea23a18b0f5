//! The kernel in single precision, for segments far from most targets.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]
#![expect(clippy::cast_possible_truncation, reason = "single precision is what is asked for")]

use super::prepared::PreparedSingle;
use crate::vector::Vec3;

/// Targets in a block.
pub(super) const SINGLE_LANES: usize = 16;

/// Segments whose velocities are added in single precision before they go to the sum in double.
const RUN: usize = 16;

/// Makes 0/0 at the end of a segment zero; far below any `|r1| |r2| D`.
const GUARD: f32 = 1e-30;
/// The same below the root of Vatistas's profile.
const GUARD_SQUARED: f32 = 1e-36;

type Lanes = [[f32; SINGLE_LANES]; 3];

/// Adds the velocities by all segments at the targets of a block (at most [`SINGLE_LANES`]).
#[inline(always)]
pub(super) fn add_single<const MOORE: bool>(
    targets: &[Vec3],
    segments: &[PreparedSingle],
    out: &mut [Vec3],
) {
    let mut at: Lanes = [[0.0; SINGLE_LANES]; 3];
    let filled = targets.iter().chain(targets.last().into_iter().cycle()).take(SINGLE_LANES);
    for (k, p) in filled.enumerate() {
        for (row, x) in at.iter_mut().zip(p) {
            row[k] = *x as f32;
        }
    }
    for run in segments.chunks(RUN) {
        let mut sum: Lanes = [[0.0; SINGLE_LANES]; 3];
        for segment in run {
            add_one::<MOORE>(&at, segment, &mut sum);
        }
        for (k, o) in out.iter_mut().enumerate().take(SINGLE_LANES) {
            for c in 0..3 {
                o[c] += f64::from(sum[c][k]);
            }
        }
    }
}

/// In the forms of the kernel in double precision.
#[inline(always)]
fn add_one<const MOORE: bool>(at: &Lanes, segment: &PreparedSingle, sum: &mut Lanes) {
    let ([sx, sy, sz], [lx, ly, lz]) = (segment.start, segment.along);
    for k in 0..SINGLE_LANES {
        let (x, y, z) = (at[0][k] - sx, at[1][k] - sy, at[2][k] - sz);
        let (x2, y2, z2) = (x - lx, y - ly, z - lz);
        let (cx, cy, cz) = (ly * z - lz * y, lz * x - lx * z, lx * y - ly * x);
        let cross = cx * cx + cy * cy + cz * cz;
        let (s1, s2) = (x * x + y * y + z * z, x2 * x2 + y2 * y2 + z2 * z2);
        let factor = if MOORE {
            let (lr1, lr2) = (lx * x + ly * y + lz * z, lx * x2 + ly * y2 + lz * z2);
            let (a, b) = ((s1 + segment.cut_off).sqrt(), (s2 + segment.cut_off).sqrt());
            (lr1 * b - lr2 * a) / (a * b * (cross + segment.core) + GUARD)
        } else {
            let q = x * x2 + y * y2 + z * z2;
            let product = s1 * s2;
            let p = product.sqrt();
            let sharp = q > 0.0;
            let above = if sharp { cross } else { p - q };
            let below = if sharp { p + q } else { 1.0 };
            let denominator =
                product * (cross * cross + segment.core) * (below * below) + GUARD_SQUARED;
            above * ((s1 + s2 + 2.0 * p) / denominator).sqrt()
        };
        let factor = segment.strength * factor;
        sum[0][k] += factor * cx;
        sum[1][k] += factor * cy;
        sum[2][k] += factor * cz;
    }
}
