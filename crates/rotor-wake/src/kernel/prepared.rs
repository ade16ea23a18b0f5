//! One segment with what does not depend on the target, in both precisions.

#![expect(clippy::cast_possible_truncation, reason = "single precision is what is asked for")]

use super::core::CoreModel;
use crate::vector::{Vec3, dot, sub};
use std::f64::consts::PI;

/// One segment with what does not depend on the target.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct Prepared {
    pub(super) start: Vec3,
    pub(super) along: Vec3,
    /// Circulation over 4 pi.
    pub(super) strength: f64,
    /// `r_c^4 |l|^4` (Vatistas) or `delta^2 |l|^2`.
    pub(super) core: f64,
    /// `delta^2`.
    pub(super) cut_off: f64,
}

impl Prepared {
    pub(super) fn new(
        core: CoreModel,
        [start, end]: [Vec3; 2],
        circulation: f64,
        core_radius: f64,
    ) -> Self {
        let along = sub(end, start);
        let square = dot(along, along);
        let (core, cut_off) = match core {
            CoreModel::Vatistas => {
                let product = core_radius * core_radius * square;
                (product * product, 0.0)
            }
            CoreModel::RosenheadMoore => {
                let delta = core_radius * CoreModel::cut_off_ratio();
                (delta * delta * square, delta * delta)
            }
        };
        Self { start, along, strength: circulation / (4.0 * PI), core, cut_off }
    }
}

/// The same in single precision.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(super) struct PreparedSingle {
    pub(super) start: [f32; 3],
    pub(super) along: [f32; 3],
    pub(super) strength: f32,
    /// `r_c^4 |l|^4` (Vatistas) or `delta^2 |l|^2`.
    pub(super) core: f32,
    /// `delta^2`, 0 with Vatistas's cores.
    pub(super) cut_off: f32,
}

impl From<&Prepared> for PreparedSingle {
    fn from(segment: &Prepared) -> Self {
        Self {
            start: segment.start.map(|x| x as f32),
            along: segment.along.map(|x| x as f32),
            strength: segment.strength as f32,
            core: segment.core as f32,
            cut_off: segment.cut_off as f32,
        }
    }
}
