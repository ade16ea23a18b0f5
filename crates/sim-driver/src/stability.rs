//! Stability of the trimmed blade as a result: the motions of its Floquet multipliers.

use rotor_response::{BladeMotion, Stability};
use serde::{Deserialize, Serialize};

/// Floquet exponents of one blade about its trimmed orbit; inflow held, section lags settled.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct StabilityLine {
    /// Whether every motion dies out.
    pub stable: bool,
    /// The motion with the least damping over critical; none in results stored before stability was.
    pub least_damped: Option<MotionLine>,
    /// Every motion, least stable first.
    pub motions: Vec<MotionLine>,
}

/// One motion of the blade.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct MotionLine {
    /// Mode shape that leads it, such as `lag 1`.
    pub mode: String,
    /// Damping over critical, `-Re s / |s|`; negative when the motion grows.
    pub damping_ratio: f64,
    /// Frequency nearest to the mode's, per rev: multipliers give it up to whole numbers and sign.
    pub frequency_per_rev: f64,
    /// Real part of the exponent `s`, per rad of azimuth; negative when the motion dies out.
    pub growth_per_rad: f64,
    /// Floquet multiplier, `[real, imaginary]`: factor of the motion over one revolution.
    pub multiplier: [f64; 2],
}

impl From<&BladeMotion> for MotionLine {
    fn from(motion: &BladeMotion) -> Self {
        Self {
            mode: format!("{} {}", motion.kind, motion.number),
            damping_ratio: motion.damping_ratio(),
            frequency_per_rev: motion.modal_frequency_per_rev,
            growth_per_rad: motion.growth_per_rad,
            multiplier: [motion.multiplier.re, motion.multiplier.im],
        }
    }
}

impl From<&Stability> for StabilityLine {
    fn from(stability: &Stability) -> Self {
        Self {
            stable: stability.is_stable(),
            least_damped: stability.least_damped().map(MotionLine::from),
            motions: stability.motions.iter().map(MotionLine::from).collect(),
        }
    }
}

impl StabilityLine {
    /// One line for people; none if there is nothing to say.
    pub fn text(&self) -> Option<String> {
        let least = self.least_damped.as_ref()?;
        Some(format!(
            "{}, least damped {} at {:.3} per rev: damping ratio {:.4}, growth {:.4} per rad",
            if self.stable { "stable" } else { "UNSTABLE" },
            least.mode,
            least.frequency_per_rev,
            least.damping_ratio,
            least.growth_per_rad
        ))
    }

    /// What a reader must know of every motion that does not die out.
    pub fn warnings(&self) -> Vec<String> {
        self.motions
            .iter()
            .filter(|m| m.growth_per_rad >= 0.0)
            .map(|m| {
                format!(
                    "the trimmed blade is unstable: {} at {:.3} per rev grows by {:.4} per rad (damping ratio {:.4}); the periodic response exists, but the blade will leave it. Remedy: more modal_damping, a stiffer blade or a lower advance ratio",
                    m.mode, m.frequency_per_rev, m.growth_per_rad, m.damping_ratio
                )
            })
            .collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Complex;
    use rotor_fem::ModeKind;

    fn motion(kind: ModeKind, growth_per_rad: f64, frequency: f64) -> BladeMotion {
        BladeMotion {
            multiplier: Complex::from_polar((std::f64::consts::TAU * growth_per_rad).exp(), 0.3),
            growth_per_rad,
            frequency_per_rev: 0.3,
            modal_frequency_per_rev: frequency,
            kind,
            number: 1,
        }
    }

    #[test]
    fn the_least_damped_motion_is_printed_and_a_growing_one_warned_of() {
        let motions =
            vec![motion(ModeKind::Lag, -0.007, 0.7), motion(ModeKind::Torsion, -0.023, 4.6)];
        let line = StabilityLine::from(&Stability { motions });
        assert!(line.stable && line.warnings().is_empty());
        let text = line.text().unwrap();
        assert!(text.starts_with("stable, least damped torsion 1 at 4.600 per rev"), "{text}");
        let motions =
            vec![motion(ModeKind::Lag, 0.01, 0.7), motion(ModeKind::Torsion, -0.023, 4.6)];
        let line = StabilityLine::from(&Stability { motions });
        let warnings = line.warnings();
        assert!(!line.stable && warnings.len() == 1, "{warnings:?}");
        assert!(warnings[0].contains("lag 1 at 0.700 per rev grows by 0.0100"), "{warnings:?}");
        assert!(line.text().unwrap().starts_with("UNSTABLE, least damped lag 1"));
        assert_eq!(StabilityLine::default().text(), None);
    }
}
