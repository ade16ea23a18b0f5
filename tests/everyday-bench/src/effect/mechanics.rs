//! Errors between ceramic and sensor target.

use crate::filters::{SecondOrder, each};

/// What the motion meets on its way.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum Mechanics {
    /// A mode that carries 97 % of the motion.
    Resonance { frequency_hz: f64, damping_ratio: f64 },
    /// Five plays side by side, 0.7 to 1.3 of the width; um.
    Backlash { width_um: f64 },
    /// Bristles that bend over the way `w` and slip more easily in motion, `w` the width in fast motion:
    /// `y = x - z`, `dz = sgn(dx) (g - sgn(dx) z)/(2 g) |dx|`, `g = w/2 (1 + 0.2 exp(-|x'|/(1500 um/s)))`.
    Friction { width_um: f64 },
    /// A spring, a little stiffer when pushed: `y + r (y + y^2/(6000 um)) = x`.
    Spring { ratio: f64 },
    /// A spring that is met above the middle, softly over 5 um.
    OneSidedSpring { ratio: f64 },
    /// A soft stop at a displacement, um.
    Stop { at_um: f64 },
}

/// Softness of springs and stops that are met, um.
const SOFT_UM: f64 = 5.0;

impl Mechanics {
    /// Turns free motion into that of the target, um.
    pub(crate) fn apply(self, dt_s: f64, motion_um: &mut [f64]) {
        match self {
            Self::Resonance { frequency_hz, damping_ratio } => {
                let mut mode = SecondOrder::new(frequency_hz, damping_ratio, dt_s, motion_um[0]);
                each(motion_um, |x| *x = 0.03 * *x + 0.97 * mode.step(*x));
            }
            Self::Backlash { width_um } => {
                let mut plays =
                    [0.7, 0.85, 1.0, 1.15, 1.3].map(|f| (0.5 * f * width_um, motion_um[0]));
                for x in motion_um {
                    for (half, y) in &mut plays {
                        *y = y.clamp(*x - *half, *x + *half);
                    }
                    *x = plays.iter().map(|(_, y)| y).sum::<f64>() / 5.0;
                }
            }
            Self::Friction { width_um } => {
                let (mut z, mut from) = (0.0, motion_um[0]);
                for x in motion_um {
                    let way = *x - from;
                    from = *x;
                    let speed = way.abs() / dt_s / 1500.0;
                    let limit = 0.5 * width_um * (1.0 + 0.2 * (-speed).exp());
                    if way.abs() > 0.0 {
                        let goal = way.signum() * limit;
                        z = goal + (z - goal) * (-way.abs() / (2.0 * limit)).exp();
                    }
                    *x -= z;
                }
            }
            Self::Spring { ratio } => {
                for x in motion_um {
                    *x = solved(*x, |y| ratio * pushed(y), |y| ratio * (1.0 + y / 3000.0));
                }
            }
            Self::OneSidedSpring { ratio } => {
                for x in motion_um {
                    *x = solved(*x, |y| ratio * above(y), |y| ratio * slope_above(y));
                }
            }
            Self::Stop { at_um } => {
                each(motion_um, |x| *x -= above(*x - at_um));
            }
        }
    }

    /// Force on the actuator over its stiffness, um, when the target is at `y_um`.
    pub(crate) fn force_um(self, y_um: f64) -> f64 {
        match self {
            Self::Spring { ratio } => ratio * pushed(y_um),
            Self::OneSidedSpring { ratio } => ratio * above(y_um),
            _ => 0.0,
        }
    }
}

/// Compression of the spring that counts, um.
fn pushed(y_um: f64) -> f64 {
    y_um + y_um * y_um / 6000.0
}

/// What lies above zero, softly; um.
fn above(y_um: f64) -> f64 {
    0.5 * (y_um + y_um.hypot(SOFT_UM))
}

fn slope_above(y_um: f64) -> f64 {
    0.5 * (1.0 + y_um / y_um.hypot(SOFT_UM))
}

/// `y` with `y + f(y) = x` (Newton).
fn solved(x: f64, f: impl Fn(f64) -> f64, slope: impl Fn(f64) -> f64) -> f64 {
    let mut y = x;
    for _ in 0..6 {
        y -= (y + f(y) - x) / (1.0 + slope(y));
    }
    y
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn springs_take_their_share_and_carry_their_force() {
        for (spring, at) in [
            (Mechanics::Spring { ratio: 0.2 }, 120.0),
            (Mechanics::Spring { ratio: 0.2 }, -150.0),
            (Mechanics::OneSidedSpring { ratio: 0.3 }, 100.0),
        ] {
            let mut motion = [at];
            spring.apply(1e-3, &mut motion);
            assert!((motion[0] + spring.force_um(motion[0]) - at).abs() < 1e-9);
        }
        let mut free = [-150.0];
        Mechanics::OneSidedSpring { ratio: 0.3 }.apply(1e-3, &mut free);
        assert!((free[0] + 150.0).abs() < 0.1);
    }

    #[test]
    fn friction_never_moves_the_target_against_the_drive_and_loses_its_width() {
        let way = |i: u32| 100.0 * (0.01 * f64::from(i)).sin();
        let mut motion: Vec<f64> = (0..2000).map(way).collect();
        let drive = motion.clone();
        Mechanics::Friction { width_um: 8.0 }.apply(1e-4, &mut motion);
        for i in 1..2000 {
            let (own, driven) = (motion[i] - motion[i - 1], drive[i] - drive[i - 1]);
            assert!(own * driven > -1e-3, "{i}: {own} {driven}");
        }
        let fast: Vec<f64> = motion.iter().zip(&drive).map(|(y, x)| x - y).collect();
        let largest = fast.iter().fold(0.0_f64, |m, v| m.max(v.abs()));
        assert!((3.9..4.9).contains(&largest), "{largest}");
    }
}
