//! Segments as the kernel wants them, and the part of the corrected model that adjacent segments lack.

use super::core::CoreModel;
use super::prepared::{Prepared, PreparedSingle};
use crate::vector::{Vec3, add, cross, norm, scale, sub};
use std::f64::consts::PI;

/// Straight vortex segments under one core model.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct SegmentSet {
    core: CoreModel,
    prepared: Vec<Prepared>,
    single: Vec<PreparedSingle>,
}

impl SegmentSet {
    /// No segments.
    pub fn new(core: CoreModel) -> Self {
        Self { core, prepared: Vec::new(), single: Vec::new() }
    }

    /// No segments yet, with room for so many.
    pub(crate) fn with_room(core: CoreModel, segments: usize) -> Self {
        Self { prepared: Vec::with_capacity(segments), ..Self::new(core) }
    }

    /// Adds a segment from `start` to `end` with a circulation in the right-hand sense about that
    /// direction and the core radius there.
    pub fn push(&mut self, start: Vec3, end: Vec3, circulation: f64, core_radius: f64) {
        self.prepared.push(Prepared::new(self.core, [start, end], circulation, core_radius));
    }

    /// The same for a segment whose velocity is computed in single precision, with coordinates of seven
    /// digits: some 1e-5 of the velocity next to the core. [`induced_velocities`](super::induced_velocities) adds it to that of the others.
    pub fn push_single(&mut self, start: Vec3, end: Vec3, circulation: f64, core_radius: f64) {
        let segment = Prepared::new(self.core, [start, end], circulation, core_radius);
        self.single.push(PreparedSingle::from(&segment));
    }

    /// The core model.
    pub fn core(&self) -> CoreModel {
        self.core
    }

    /// Number of segments.
    pub fn len(&self) -> usize {
        self.prepared.len() + self.single.len()
    }

    /// Whether there are none.
    pub fn is_empty(&self) -> bool {
        self.prepared.is_empty() && self.single.is_empty()
    }

    pub(super) fn single(&self) -> &[PreparedSingle] {
        &self.single
    }

    pub(super) fn prepared(&self) -> &[Prepared] {
        &self.prepared
    }
}

/// Euler's constant.
const EULER: f64 = 0.577_215_664_901_532_9;

/// Velocity at the middle one of three points on a filament by the arcs to its neighbours, which straight
/// segments cannot give: on their own line they induce nothing.
///
/// ```text
/// v = Gamma kappa / 8pi  b  sum over both arcs of
///     [asinh(L/delta) - L / sqrt(L^2 + delta^2) - (C - 1/2) / (1 + delta^2/L^2)^2]
/// ```
/// with the curvature `kappa` and the binormal `b` of the circle through the points, arc lengths `L`
/// taken as chords, and `delta = r_c e^(-3/4)`. Zero where the points are in line. The last term, with Euler's
/// constant `C`, is what the chords beyond the neighbours induce too much: of chord `n` the excess over its
/// arc is `(1/n + 1/(n+1))/2 - ln((n+1)/n)` whatever the length of the chords, and the sum over them is
/// `C - 1/2`; where the chords resolve the core it fades (fitted factor).
///
/// Source: the Rosenhead-Moore integral of a circular arc to first order in its curvature.
pub fn arc_velocity(points: [Vec3; 3], circulation: f64, core_radius: f64) -> Vec3 {
    let [before, at, after] = points;
    let (a, b) = (sub(at, before), sub(after, at));
    let chord = norm(add(a, b));
    let (la, lb) = (norm(a), norm(b));
    let normal = cross(a, b);
    let product = la * lb * chord;
    if !(product > 0.0 && core_radius > 0.0) {
        return [0.0; 3];
    }
    let delta = core_radius * CoreModel::cut_off_ratio();
    let arc = |l: f64| {
        let fade = (1.0 + (delta / l).powi(2)).powi(2);
        (l / delta).asinh() - l / l.hypot(delta) - (EULER - 0.5) / fade
    };
    // curvature times binormal: 2 a x b / (|a| |b| |a + b|)
    scale(normal, 2.0 / product * circulation / (8.0 * PI) * (arc(la) + arc(lb)))
}
