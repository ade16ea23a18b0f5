//! Dynamic stall after Leishman and Beddoes, on top of any attached-flow model. Off unless it is used.

mod airfoils;
mod parameters;

pub use airfoils::{FittedStall, StallAirfoil};
pub use parameters::StallParameters;

use crate::error::check;
use crate::motion::decay::{LANES, decay};
use crate::{AeroError, FlapChord, FlapEffectiveness, Load, Mach, Mode, TheodorsenFunctions};
use std::f64::consts::{PI, TAU};

/// Beddoes's circulatory lags, pairs `(A, b)`.
const BEDDOES: [(f64, f64); 2] = [(0.3, 0.14), (0.7, 0.53)];

/// A section that can stall.
///
/// The attached-flow model stays what it is; this adds what separation takes away and what the
/// vortex brings:
///
/// ```text
/// Cn  = Cn_attached - Cn_alpha alpha_E (1 - K(f'')) + Cn_v
/// Cm  = Cm_attached + [k0 + k1 (1 - f'') + k2 sin(pi f''^2)] Cn_alpha alpha_E K(f'')
///                   - arm (1 - cos(pi tau/Tvl)) Cn_v
/// Cc  = eta Cn_alpha A0^2 sqrt(f'') f''^x - delta Cn_flap              toward the leading edge,
///       x = Df (|Cn'| - Cn1), 0 to 1: the suction goes with the vortex
///       A0      = alpha_E - (sqrt(1 - e^2)/pi) delta + (T4/4 pi) q_delta
///       Cn_flap = (2/beta) [ (arccos e - sqrt(1 - e^2)) alpha_E K + ((1 - e^2)/pi) delta ]
/// alpha_E: two lags on the circulatory downwash alpha + q/2 + (T10/pi) delta + (T11/4 pi) q_delta
/// Cn' : lag Tp on Cn_attached;      f'' : lag Tf on f(Cn'/Cn_alpha), Tf_attaching where f'' grows
/// d Cn_v/dS = strength d/dS [Cn_alpha alpha_E (1 - K)] - Cn_v/Tv;   the feed ends when tau reaches Tvl
/// tau: distance since |Cn'| passed Cn1, until 2 Tvl, where the vortex is gone; 0 without one
/// ```
/// Held for ever it is the static curve of Kirchhoff; with `alpha1` out of reach it is the attached
/// model.
///
/// `A0` is the strength of the leading edge (steady: `alpha + delta arccos(e)/pi`), `Cn_flap` the force on the
/// flap, normal to it and so inclined by its angle: with full suction a steady section has no pressure drag,
/// whatever the flap angle. With a flap effectiveness the flow sees a flap of that share of the angle.
///
/// Differs from source: the source has no flap; the time constants are not changed during the vortex's travel; a vortex once
/// shed runs its course, also when the force falls below the critical one, and when another is shed
/// before it is gone keeps its place (the loads are then continuous in time); and the impulsive part of the attached load is not separated from it when
/// its lag `Tp` is formed (it is in the source too) nor touched by the separation; the separation of
/// a falling incidence follows the same static curve as that of a rising one: with the constants of the source, which has one
/// lag for both, the flow attaches again too early. Strength and arm of the vortex are those of the source unless fitted. Assumes the flap
/// acts on the separation through the lift it makes. Not modelled: the hinge moment of separated
/// flow (the attached one is kept), the inclination of the flap's force due to rates and accelerations, the
/// pitch rate's `-q/4` in `A0` (the source has none), reattachment beyond the lags.
///
/// Source: Leishman and Beddoes, J. Am. Helicopter Soc. 34(3), 1989; the flap's part of `A0` as in Garrick,
/// NACA Report 567 (1936), its force by integration of thin-aerofoil theory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StallSection {
    parameters: StallParameters,
    slope: f64,
    circulation: [f64; 4],
    /// What the downwash at the leading edge lacks of the circulatory one, per flap angle and rate.
    ahead: [f64; 2],
    /// Normal force of the flap per circulatory downwash, and at once per flap angle.
    on_flap: [f64; 2],
    /// Flap angle the flow sees, over the flap angle.
    turning: f64,
    poles: [f64; 4],
}

/// Loads of a section that may be stalled.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StalledLoads {
    /// Normal force, up +.
    pub normal: f64,
    /// Moment about the quarter chord, nose-up +.
    pub moment: f64,
    /// Hinge moment, that of attached flow.
    pub hinge: f64,
    /// Chord force, toward the leading edge +.
    pub chord: f64,
    /// Place of separation `f''`, 1 attached.
    pub separation: f64,
    /// Share of the vortex in the normal force.
    pub vortex: f64,
}

impl StalledLoads {
    /// Pressure drag at an incidence, `Cn sin(alpha) - Cc cos(alpha)`.
    pub fn pressure_drag(&self, incidence_rad: f64) -> f64 {
        let (sin, cos) = incidence_rad.sin_cos();
        self.normal * sin - self.chord * cos
    }
}

/// What of a stalling section remembers its past.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct StallState {
    /// The circulatory downwash and what its two lags lack of it.
    downwash: f64,
    lacking: [f64; 2],
    /// Flap angle and rate.
    flap: [f64; 2],
    attached: f64,
    delayed: f64,
    /// Delayed force beyond the critical one of its section, which follows the Mach number.
    beyond: f64,
    quasi: f64,
    separation: f64,
    shed: f64,
    vortex: f64,
    /// What is left of earlier vortices: normal force, and moment about the quarter chord, nose-down +.
    spent: [f64; 2],
    /// Distance since the vortex left the leading edge, semichords; `None` below the critical force.
    travel: Option<f64>,
}

fn flap_of(modes: &[f64; 4]) -> [f64; 2] {
    [modes[Mode::Flap.index()], modes[Mode::FlapRate.index()]]
}

/// `[1 - e^(-z), (1 - e^(-z))/z]`.
fn gone_and_mean(z: f64) -> [f64; 2] {
    if z < 1e-200 {
        return [0.0, 1.0];
    }
    let d = decay(&[z; LANES], &[1.0 / z; LANES]);
    [d.gone[0], d.mean[0]]
}

/// A lag over a step in which what it follows runs straight from `from` to `to`.
fn lagged(state: f64, [from, to]: [f64; 2], z: f64) -> f64 {
    let [gone, mean] = gone_and_mean(z);
    let behind = state - from;
    to - (to - from) * mean + (behind - behind * gone)
}

impl StallSection {
    /// A section at a Mach number, with the lift slope `2 pi / beta` of the attached models.
    ///
    /// # Errors
    /// [`AeroError::BadInput`] if a parameter is not finite, or one that must be positive is not.
    pub fn new(
        mach: Mach,
        flap: FlapChord,
        parameters: StallParameters,
    ) -> Result<Self, AeroError> {
        parameters.check()?;
        let beta = mach.beta();
        let pole = |i: usize| BEDDOES[i].1 * beta * beta;
        let t = TheodorsenFunctions::new(flap.hinge());
        // sqrt(1 - e^2) and arccos e of the hinge e = 1 - 2 E
        let s = 2.0 * (flap.ratio() * (1.0 - flap.ratio())).sqrt();
        let angle = t.t::<10>() - s;
        Ok(Self {
            parameters,
            slope: TAU / beta,
            circulation: t.circulatory_input(),
            ahead: [s / PI, -t.t::<4>() / (4.0 * PI)],
            on_flap: [2.0 * (angle - s) / beta, 2.0 * s * s / (PI * beta)],
            turning: 1.0,
            poles: [pole(0), pole(1), 1.0 / parameters.tp, 1.0 / parameters.tf],
        })
    }

    /// The static loads: incidence and inputs held for ever.
    ///
    /// `attached` is what the attached model settles to, `[Cn, Cm, Ch]`.
    pub fn settled(&self, attached: [f64; 3], modes: &[f64; 4]) -> StalledLoads {
        StallState::settled(self, attached[0], modes).loads(self, attached)
    }

    /// The section with a flap of this effectiveness in lift: the attached loads it is given are to be
    /// those of the same flap.
    #[must_use]
    pub fn with_flap_effectiveness(mut self, effectiveness: &FlapEffectiveness) -> Self {
        let factor = effectiveness.of(Load::Lift);
        self.circulation[Mode::Flap.index()] *= factor;
        self.circulation[Mode::FlapRate.index()] *= factor;
        self.ahead = self.ahead.map(|share| share * factor);
        self.turning *= factor;
        self
    }

    fn downwash(&self, modes: &[f64; 4]) -> f64 {
        self.circulation.iter().zip(modes).map(|(w, m)| w * m).sum()
    }
}

impl StallState {
    /// A section whose inputs have been held for ever, with the attached normal force of that.
    pub fn settled(section: &StallSection, attached_normal: f64, modes: &[f64; 4]) -> Self {
        let downwash = section.downwash(modes);
        let separation = section.parameters.separation(attached_normal / section.slope);
        let lost = 1.0 - StallParameters::kirchhoff(separation);
        let shed = section.parameters.vortex_strength * section.slope * downwash * lost;
        Self {
            downwash,
            lacking: [0.0; 2],
            flap: flap_of(modes),
            attached: attached_normal,
            delayed: attached_normal,
            beyond: attached_normal.abs() - section.parameters.cn1,
            quasi: separation,
            separation,
            shed,
            vortex: 0.0,
            spent: [0.0; 2],
            // a vortex long gone
            travel: (attached_normal.abs() > section.parameters.cn1)
                .then_some(2.0 * section.parameters.tvl),
        }
    }

    /// Advances by `semichords`, over which `modes` and the attached loads run straight to these
    /// values, and returns the loads at the end.
    ///
    /// # Errors
    /// [`AeroError::BadInput`] if the step is negative or a number is not finite; the state is then
    /// unchanged.
    pub fn step(
        &mut self,
        section: &StallSection,
        attached: [f64; 3],
        modes: &[f64; 4],
        semichords: f64,
    ) -> Result<StalledLoads, AeroError> {
        for number in attached.iter().chain(modes).chain([&semichords]) {
            check(
                &[("input of the stalling section", *number)],
                "a finite number",
                f64::is_finite,
            )?;
        }
        check(&[("step, semichords", semichords)], "0 or more", |step| step >= 0.0)?;
        let p = &section.parameters;
        let z = section.poles.map(|pole| pole * semichords);
        let downwash = section.downwash(modes);
        for (lacking, z) in self.lacking.iter_mut().zip(z) {
            // in the shape of a lag of the downwash, less the downwash
            *lacking = lagged(*lacking + self.downwash, [self.downwash, downwash], z) - downwash;
        }
        self.downwash = downwash;
        self.flap = flap_of(modes);
        self.delayed = lagged(self.delayed, [self.attached, attached[0]], z[2]);
        self.attached = attached[0];
        let quasi = p.separation(self.delayed / section.slope);
        // where they meet neither changes anything
        let attaches = self.quasi + quasi > 2.0 * self.separation;
        let z_separation = if attaches { semichords / p.tf_attaching } else { z[3] };
        self.separation = lagged(self.separation, [self.quasi, quasi], z_separation);
        self.quasi = quasi;
        let lost = 1.0 - StallParameters::kirchhoff(self.separation);
        let shed = p.vortex_strength * self.effective(section) * lost;
        self.advance_vortex(section, shed, semichords);
        Ok(self.loads(section, attached))
    }

    /// The loads without delay at the effective incidence of this state: the separation of these
    /// attached loads held for ever, no vortex. What is dynamic in [`step`](Self::step)'s loads is
    /// their difference from these.
    pub fn without_delay(&self, section: &StallSection, attached: [f64; 3]) -> StalledLoads {
        let separation = section.parameters.separation(attached[0] / section.slope);
        let delayed = attached[0];
        Self { separation, delayed, vortex: 0.0, spent: [0.0; 2], travel: None, ..*self }
            .loads(section, attached)
    }

    /// The loads of attached flow in the form of stalled ones: the chord force is the whole
    /// leading-edge suction `Cn_alpha A0^2` less the inclined force of the flap; held for ever there is no drag.
    pub fn without_stall(&self, section: &StallSection, attached: [f64; 3]) -> StalledLoads {
        let [normal, moment, hinge] = attached;
        let chord = self.suction(section) - self.inclined(section, 1.0);
        StalledLoads { normal, moment, hinge, chord, separation: 1.0, vortex: 0.0 }
    }

    /// `Cn_alpha alpha_E`.
    fn effective(&self, section: &StallSection) -> f64 {
        let lacking: f64 = BEDDOES.iter().zip(self.lacking).map(|((a, _), y)| a * y).sum();
        section.slope * (self.downwash + lacking)
    }

    /// Suction of the leading edge in attached flow, `Cn_alpha A0^2`.
    fn suction(&self, section: &StallSection) -> f64 {
        let lacks: f64 = section.ahead.iter().zip(self.flap).map(|(share, m)| share * m).sum();
        let leading = self.effective(section) - section.slope * lacks;
        leading * leading / section.slope
    }

    /// Rearward force of a flap that is turned, `delta Cn_flap`, with a share of the circulatory loading left.
    fn inclined(&self, section: &StallSection, left: f64) -> f64 {
        let turned = section.turning * self.flap[0];
        let alpha = self.effective(section) / section.slope;
        turned * (section.on_flap[0] * alpha * left + section.on_flap[1] * turned)
    }

    /// The vortex over a step in which its source runs straight to `shed` and what the delayed force has beyond the
    /// critical one to its value now. The step is parted where the force passes the critical one, where the vortex
    /// leaves the chord and where it is gone.
    fn advance_vortex(&mut self, section: &StallSection, shed: f64, ds: f64) {
        let p = &section.parameters;
        let feed = if ds > 0.0 { (shed - self.shed) / ds } else { 0.0 };
        let (was, now) = (self.beyond, self.delayed.abs() - p.cn1);
        self.beyond = now;
        let crossing = ds * (was / (was - now)).clamp(0.0, 1.0);
        if (was > 0.0) == (now > 0.0) {
            self.travel_on(p, feed, now > 0.0, ds);
        } else {
            self.travel_on(p, feed, was > 0.0, crossing);
            if now > 0.0 {
                self.release(p);
            }
            self.travel_on(p, feed, now > 0.0, ds - crossing);
        }
        self.shed = shed;
    }

    /// A vortex leaves the leading edge; one still on its way joins the spent ones.
    fn release(&mut self, p: &StallParameters) {
        if self.travel.is_some() {
            self.spent[0] += self.vortex;
            self.spent[1] += self.centre(p) * self.vortex;
            self.vortex = 0.0;
        }
        self.travel = Some(0.0);
    }

    /// Centre of the vortex force behind the quarter chord, chords.
    fn centre(&self, p: &StallParameters) -> f64 {
        p.vortex_arm * (1.0 - (PI * self.travel.unwrap_or(0.0) / p.tvl).cos())
    }

    /// A distance with the delayed force above the critical one or not: a vortex on its way is fed
    /// over the chord, then decays over another chord; when it is gone and the force is not critical,
    /// the next one gathers.
    fn travel_on(&mut self, p: &StallParameters, feed: f64, critical: bool, distance: f64) {
        let Some(travelled) = self.travel else {
            self.grow(p, feed, distance);
            return;
        };
        let over_chord = (p.tvl - travelled).clamp(0.0, distance);
        self.grow(p, feed, over_chord);
        let left = distance - over_chord;
        let behind = (2.0 * p.tvl - (travelled + over_chord)).clamp(0.0, left);
        let gone = !critical && left > behind;
        self.grow(p, 0.0, if gone { behind } else { left });
        if gone {
            self.grow(p, feed, left - behind);
        }
        self.travel = (!gone).then_some((travelled + distance).min(2.0 * p.tvl));
    }

    /// Decay over a distance, fed evenly.
    fn grow(&mut self, p: &StallParameters, feed: f64, distance: f64) {
        let [gone, mean] = gone_and_mean(distance / p.tv);
        self.vortex = self.vortex - self.vortex * gone + feed * distance * mean;
        self.spent = self.spent.map(|left| left - left * gone);
    }

    fn loads(&self, section: &StallSection, [normal, moment, hinge]: [f64; 3]) -> StalledLoads {
        let p = &section.parameters;
        let f = self.separation;
        let effective = self.effective(section);
        let left = StallParameters::kirchhoff(f);
        let vortex = self.vortex + self.spent[0];
        let nose_down = self.centre(p) * self.vortex + self.spent[1];
        StalledLoads {
            normal: normal - effective * (1.0 - left) + vortex,
            moment: moment + p.moment_arm(f) * effective * left - nose_down,
            hinge,
            chord: p.eta * self.suction(section) * p.suction(f, self.delayed)
                - self.inclined(section, left),
            separation: f,
            vortex,
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn section(mach: f64) -> StallSection {
        let mach = Mach::new(mach).unwrap();
        StallSection::new(mach, FlapChord::NONE, StallParameters::naca_0012(mach)).unwrap()
    }

    /// A march at a normal force that is held while the Mach number runs from one value to another: where the last
    /// vortex is, semichords behind the leading edge.
    fn travelled(normal: f64, [from, to]: [f64; 2], steps: u32) -> Option<f64> {
        let at = |n: u32| from + (to - from) * f64::from(n) / f64::from(steps);
        let attached = [normal, 0.0, 0.0];
        let modes = [normal / section(from).slope, 0.0, 0.0, 0.0];
        let mut state = StallState::settled(&section(from), normal, &modes);
        for n in 1..=steps {
            state.step(&section(at(n)), attached, &modes, 8.0 / f64::from(steps)).unwrap();
        }
        state.travel
    }

    /// The critical force falls with the Mach number: a vortex leaves when it passes a force that is held, at the same
    /// place whatever the steps, and none leaves while the force stays beyond it.
    #[test]
    fn the_critical_force_passes_the_delayed_one_too() {
        // Cn1 is 1.2 at Mach .4 and 1.05 at .5: it passes 1.125 half way
        for steps in [3, 8, 31, 200] {
            let behind = travelled(1.125, [0.4, 0.5], steps).unwrap();
            assert!((behind - 4.0).abs() < 1e-9, "{steps} steps: {behind}");
        }
        // beyond all the way: the vortex is long gone and no other leaves
        assert_eq!(travelled(1.3, [0.4, 0.5], 8), Some(18.0));
        assert_eq!(travelled(1.0, [0.4, 0.5], 8), None);
    }
}
