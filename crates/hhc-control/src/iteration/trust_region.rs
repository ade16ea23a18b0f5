//! The damping of steps, after Levenberg and Marquardt.

/// The weight of a proximal term that holds a step near the state it sets out from.
///
/// ```text
/// kappa |u - u_here|^2 beside the predicted cost
/// ```
/// Where the loads bend and do not vanish, the quadratic that T predicts is too flat, its optimum too far away, and
/// every line search would backtrack anew. A step that backtracked `h` times has measured the bend along it:
/// `kappa` grows by `2^h - 1` times the curvature predicted there, so that the next step has the length that was
/// taken. A step that keeps its prediction makes it smaller again.
///
/// Source: J. More, *The Levenberg-Marquardt algorithm*, Lecture Notes in Mathematics 630 (1978).
#[derive(Debug, Clone, Copy, Default)]
pub(super) struct TrustRegion {
    /// `kappa`, 1/V^2.
    pub(super) weight: f64,
}

/// What a step taken says of the prediction.
pub(super) struct Experience {
    pub(super) backtracks: u32,
    /// Measured over predicted decrease of the cost.
    pub(super) gain_ratio: f64,
    /// Predicted curvature along the step, damping included, 1/V^2.
    pub(super) curvature: f64,
    /// Square of the largest singular value of T, 1/V^2.
    pub(super) authority: f64,
}

/// Gain ratio above which the next step is damped less.
const GOOD_GAIN_RATIO: f64 = 0.75;
/// Factor by which the damping then falls.
const REDUCTION: f64 = 4.0;
/// Damping over the largest singular value squared below which it is none.
const NO_DAMPING: f64 = 1e-8;

impl TrustRegion {
    pub(super) fn update(&mut self, step: &Experience) {
        if step.backtracks > 0 {
            self.weight += (2.0_f64.powi(step.backtracks.cast_signed()) - 1.0) * step.curvature;
        } else if step.gain_ratio < 1.0 - GOOD_GAIN_RATIO {
            self.weight += step.curvature;
        } else if step.gain_ratio > GOOD_GAIN_RATIO {
            self.weight /= REDUCTION;
            if self.weight < NO_DAMPING * step.authority {
                self.weight = 0.0;
            }
        }
    }
}
