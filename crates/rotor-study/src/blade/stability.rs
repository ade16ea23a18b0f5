//! Stability of the trimmed blade as a result: the motions of its Floquet multipliers.

use rotor_response::{BladeMotion, Stability};
use serde::{Deserialize, Serialize};

/// Floquet exponents of one blade about its trimmed orbit; inflow held, the lags of attached sections move with the blade.
#[derive(Debug, Clone, PartialEq, Default, Serialize, Deserialize)]
pub struct StabilityLine {
    /// Whether every motion dies out.
    pub stable: bool,
    /// The motion with the least damping over critical; none in results stored before stability was.
    pub least_damped: Option<MotionLine>,
    /// Every motion, least stable first. A motion locked to the rotor speed or half of it has two real multipliers and
    /// is there twice, once for each growth.
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

impl MotionLine {
    /// Whether the motion is the same from revolution to revolution but for its size: a multiplier that is real
    /// and positive. Of a blade in hover that is divergence; in forward flight a motion locked to the rotor speed, at a whole
    /// number per rev, has such a multiplier too.
    fn repeats(&self) -> bool {
        let [real, imaginary] = self.multiplier;
        imaginary == 0.0 && real > 0.0
    }

    /// How it grows: a multiplier that is real locks the motion to whole or half numbers per rev.
    fn growth_text(&self, in_hover: bool) -> String {
        let [real, imaginary] = self.multiplier;
        let frequency = self.frequency_per_rev;
        match (self.repeats(), in_hover) {
            (true, true) => {
                "diverges: the same deflection from revolution to revolution grows".to_owned()
            }
            (true, false) => format!(
                "at {frequency:.3} per rev, locked to the rotor speed, or diverging (both repeat every revolution, and the multiplier does not tell them apart; hover does), grows"
            ),
            _ if imaginary == 0.0 && real < 0.0 => {
                format!("at {frequency:.3} per rev, locked to half the rotor speed, grows")
            }
            _ => format!("at {frequency:.3} per rev grows"),
        }
    }

    /// What helps. Which mode has most of a motion says little of its cause: a blade that its mass or its lift turns nose
    /// up leaves in flap and lag as well, and torsion, with next to no inertia, seldom leads.
    fn remedy(&self, in_hover: bool) -> &'static str {
        match (self.mode.starts_with("lag"), self.repeats(), in_hover) {
            (_, true, true) => {
                "a stiffer pitch link (rotor.root.pitch) or blade (gj), the mass centre farther forward (rotor.mass_centre_r) or the quarter chord farther aft (rotor.aerodynamic_centre_r); of a blade soft in lag a stiffer spring (rotor.root.lag) or a hinge farther from the centre; damping does not help"
            }
            (_, true, false) => {
                "a stiffer pitch link (rotor.root.pitch) or blade (gj), the mass centre farther forward (rotor.mass_centre_r) or the quarter chord farther aft (rotor.aerodynamic_centre_r); of a blade soft in lag a stiffer spring (rotor.root.lag) or a hinge farther from the centre; a lower advance ratio and more damping where the motion is locked, which do not help against divergence"
            }
            (true, false, _) => {
                "more damping in lag (rotor.modal_damping), a lower thrust or advance ratio; with a soft pitch link (rotor.root.pitch) a stiffer one"
            }
            (false, false, _) => {
                "the mass centre farther forward (rotor.mass_centre_r; at the quarter chord or ahead of it is usual), a stiffer pitch link (rotor.root.pitch) or blade (gj), more modal_damping, or a lower advance ratio"
            }
        }
    }
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

    /// What a reader must know of every motion that does not die out, at an advance ratio.
    pub fn warnings(&self, advance_ratio: f64) -> Vec<String> {
        self.warnings_of("the trimmed blade", advance_ratio)
    }

    /// The same of a blade with a name.
    pub(crate) fn warnings_of(&self, blade: &str, advance_ratio: f64) -> Vec<String> {
        let in_hover = advance_ratio == 0.0;
        let mut named: Vec<&str> = Vec::new();
        let mut warnings = Vec::new();
        for m in self.motions.iter().filter(|m| m.growth_per_rad >= 0.0) {
            // two real multipliers of one mode are one instability: that which grows faster
            if named.contains(&m.mode.as_str()) {
                continue;
            }
            named.push(&m.mode);
            warnings.push(format!(
                "{blade} is unstable: {} {} by {:.4} per rad (damping ratio {:.4}); the periodic response exists, but the blade will leave it. Remedy: {}",
                m.mode,
                m.growth_text(in_hover),
                m.growth_per_rad,
                m.damping_ratio,
                m.remedy(in_hover)
            ));
        }
        warnings
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
        assert!(line.stable && line.warnings(0.3).is_empty());
        let text = line.text().unwrap();
        assert!(text.starts_with("stable, least damped torsion 1 at 4.600 per rev"), "{text}");
        let motions =
            vec![motion(ModeKind::Lag, 0.01, 0.7), motion(ModeKind::Torsion, -0.023, 4.6)];
        let line = StabilityLine::from(&Stability { motions });
        let warnings = line.warnings(0.3);
        assert!(!line.stable && warnings.len() == 1, "{warnings:?}");
        assert!(warnings[0].contains("lag 1 at 0.700 per rev grows by 0.0100"), "{warnings:?}");
        assert!(line.text().unwrap().starts_with("UNSTABLE, least damped lag 1"));
        assert!(warnings[0].contains("more damping in lag"), "{warnings:?}");
        assert_eq!(StabilityLine::default().text(), None);
    }

    /// Two real multipliers of one mode are one instability, and a mass centre too far aft has its own remedies.
    #[test]
    fn a_locked_motion_is_warned_of_once_and_divergence_says_what_helps() {
        let real = |kind, growth: f64, sign: f64| BladeMotion {
            multiplier: Complex::from(sign * (std::f64::consts::TAU * growth).exp()),
            ..motion(kind, growth, 1.5)
        };
        let at = |advance_ratio, motions: Vec<BladeMotion>| {
            StabilityLine::from(&Stability { motions }).warnings(advance_ratio)
        };
        let warnings_of = |motions| at(0.3, motions);
        let flap = |growth| real(ModeKind::Flap, growth, -1.0);
        let locked = warnings_of(vec![flap(0.3), flap(0.1)]);
        assert_eq!(locked.len(), 1, "{locked:?}");
        assert!(
            locked[0]
                .contains("flap 1 at 1.500 per rev, locked to half the rotor speed, grows by 0.3")
        );
        assert!(
            locked[0].contains("rotor.mass_centre_r") && locked[0].contains("rotor.root.pitch")
        );
        let nose_up = || vec![real(ModeKind::Torsion, 0.2, 1.0)];
        let diverging = at(0.0, nose_up());
        assert!(diverging[0].contains("torsion 1 diverges"), "{diverging:?}");
        assert!(diverging[0].contains("damping does not help"), "{diverging:?}");
        let in_flight = warnings_of(nose_up());
        assert!(
            in_flight[0].contains("locked to the rotor speed, or diverging (both repeat"),
            "{in_flight:?}"
        );
        assert!(in_flight[0].contains("a lower advance ratio and more damping"), "{in_flight:?}");
    }
}
