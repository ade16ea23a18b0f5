//! Velocity induced by straight vortex segments with a viscous core.
//!
//! ```text
//! v = Gamma/4pi (l.r1/|r1| - l.r2/|r2|) (l x r1) / D,      r1, r2 from the ends of l to the target
//! Vatistas, n = 2:   D = sqrt(|l x r1|^4 + r_c^4 |l|^4)
//! Rosenhead-Moore:   D = |l x r1|^2 + delta^2 |l|^2,   |r|^2 -> |r|^2 + delta^2,   delta = r_c e^(-3/4)
//! ```
//! The targets lie in the lanes of the vector unit and the segments are summed one after the other,
//! so that a result has the same bits whatever the number of threads and the width of the vectors. In double precision products
//! are fused with sums on every vector unit; on a processor without one they are not.
//!
//! Segments pushed as single-precision ones are summed in that precision, sixteen at a time, and these sums in double.
//!
//! Source: the Biot-Savart integral over a straight segment; Vatistas, Kozel and Mih, Exp. Fluids 11
//! (1991) 73, for the profile; Moore, Proc. R. Soc. A 345 (1975), and Saffman, Vortex Dynamics (1992),
//! section 11.2, for the cut-off.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

mod core;
mod lanes;
mod prepared;
mod segment;
mod single;

pub use core::CoreModel;
pub use segment::{SegmentSet, arc_velocity};

use crate::vector::Vec3;
use lanes::{LANES, Lanes};
use pulp::{Arch, Simd, WithSimd};
use rayon::prelude::*;
use single::{SINGLE_LANES, add_single};

/// Targets that one task of the thread pool works on.
const TASK_TARGETS: usize = 8 * LANES;

/// Velocity induced by all segments at every target, tip speed.
///
/// Unit of the result: circulation over length; with circulations in `Omega R^2` and lengths in `R`, the
/// tip speed. Zero at a target on the line of a segment. Never NaN for finite input.
///
/// Cost: targets x segments evaluations, in parallel over targets.
pub fn induced_velocities(targets: &[Vec3], segments: &SegmentSet) -> Vec<Vec3> {
    let mut out = vec![[0.0; 3]; targets.len()];
    out.par_chunks_mut(TASK_TARGETS).zip(targets.par_chunks(TASK_TARGETS)).for_each(|(out, at)| {
        induced_velocities_serial(at, segments, out);
    });
    out
}

/// [`induced_velocities`] on the calling thread, into `out` (as long as `targets`; what is longer is
/// left alone).
pub fn induced_velocities_serial(targets: &[Vec3], segments: &SegmentSet, out: &mut [Vec3]) {
    Arch::new().dispatch(Sums { targets, segments, out });
}

/// What takes the velocities by single segments. Its function is to be `inline(always)`: only then is it compiled for
/// the vector unit.
pub(crate) trait TakeVelocity {
    /// Velocity by the segment of a number at the targets of a block, component by component.
    fn take(&mut self, segment: usize, velocity: [&[f64; BLOCK]; 3]);
}

/// Velocity at up to [`LANES`] targets by each segment in turn, handed to `take`.
pub(crate) fn for_each_velocity(
    targets: &[Vec3],
    segments: &SegmentSet,
    take: &mut impl TakeVelocity,
) {
    Arch::new().dispatch(Each { block: Lanes::gather(targets), segments, take });
}

/// Sums of the segments in double precision, and of those in single precision added to them. A type of its own: a
/// closure would be called, not inlined, by the function that is compiled for the vector unit, and be compiled for none.
struct Sums<'a> {
    targets: &'a [Vec3],
    segments: &'a SegmentSet,
    out: &'a mut [Vec3],
}

impl Sums<'_> {
    #[inline(always)]
    fn form<const MOORE: bool, const FUSED: bool>(self) {
        for (out, at) in self.out.chunks_mut(LANES).zip(self.targets.chunks(LANES)) {
            let block = Lanes::gather(at);
            let mut sum = Lanes::default();
            for segment in self.segments.prepared() {
                lanes::add_velocity::<MOORE, FUSED>(&block, segment, &mut sum);
            }
            sum.scatter(out);
        }
        let single = self.segments.single();
        if single.is_empty() {
            return;
        }
        for (out, at) in self.out.chunks_mut(SINGLE_LANES).zip(self.targets.chunks(SINGLE_LANES)) {
            add_single::<MOORE>(at, single, out);
        }
    }
}

impl WithSimd for Sums<'_> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        match (self.segments.core(), S::IS_SCALAR) {
            (CoreModel::Vatistas, false) => self.form::<false, true>(),
            (CoreModel::Vatistas, true) => self.form::<false, false>(),
            (CoreModel::RosenheadMoore, false) => self.form::<true, true>(),
            (CoreModel::RosenheadMoore, true) => self.form::<true, false>(),
        }
    }
}

/// The velocities by every segment, one after the other.
struct Each<'a, T> {
    block: Lanes,
    segments: &'a SegmentSet,
    take: &'a mut T,
}

impl<T: TakeVelocity> Each<'_, T> {
    #[inline(always)]
    fn velocities<const MOORE: bool, const FUSED: bool>(self) {
        for (index, segment) in self.segments.prepared().iter().enumerate() {
            let mut one = Lanes::default();
            lanes::add_velocity::<MOORE, FUSED>(&self.block, segment, &mut one);
            self.take.take(index, one.components());
        }
    }
}

impl<T: TakeVelocity> WithSimd for Each<'_, T> {
    type Output = ();

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) {
        match (self.segments.core(), S::IS_SCALAR) {
            (CoreModel::Vatistas, false) => self.velocities::<false, true>(),
            (CoreModel::Vatistas, true) => self.velocities::<false, false>(),
            (CoreModel::RosenheadMoore, false) => self.velocities::<true, true>(),
            (CoreModel::RosenheadMoore, true) => self.velocities::<true, false>(),
        }
    }
}

/// Width of a block of targets of [`for_each_velocity`].
pub(crate) const BLOCK: usize = LANES;
