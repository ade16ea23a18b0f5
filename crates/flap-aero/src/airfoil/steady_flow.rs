//! Steady nonlinear section from tables: any direction of flow, reverse and yawed included.

use crate::error::check;
use crate::{
    AeroError, AirfoilSpan, FlapChord, FlapEffectiveness, Mach, SteadyCoefficients,
    TheodorsenFunctions,
};
use std::f64::consts::PI;
use std::ops::{Add, Mul, Sub};

/// Where the Prandtl-Glauert factor of the flap's increments is held.
const MACH_LIMIT: f64 = 0.9;
/// Slowest flow, over the speed of sound, that has a direction.
const NO_FLOW: f64 = 1e-12;

/// The flow a section meets, in section axes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct SectionFlow {
    /// Air density.
    pub density: f64,
    /// Speed of sound.
    pub sound_speed: f64,
    /// Along the chord, from leading to trailing edge; negative in reverse flow.
    pub chordwise: f64,
    /// Normal to the chord, up.
    pub normal: f64,
    /// Along the span, outboard: the flow is yawed.
    pub spanwise: f64,
    /// Flap angle, rad, trailing edge down.
    pub flap_rad: f64,
}

/// Forces of a section per length of span.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SectionForces {
    /// Normal to the chord, up.
    pub normal: f64,
    /// Along the chord, toward the leading edge; drag makes it negative.
    pub chordwise: f64,
    /// Along the span, outboard: friction of the spanwise flow.
    pub spanwise: f64,
    /// Moment about the quarter chord, nose-up.
    pub moment: f64,
    /// Hinge moment of the flap, in the sense of its angle.
    pub hinge: f64,
}

/// Forces and their slopes.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct LinearisedForces {
    /// The forces.
    pub value: SectionForces,
    /// Per unit of chordwise, normal and spanwise velocity.
    pub per_velocity: [SectionForces; 3],
    /// Per rad of flap angle.
    pub per_flap_rad: SectionForces,
}

/// A section with tables, a flap and the part of its drag that is friction.
#[derive(Debug, Clone, PartialEq)]
pub struct TabulatedSection {
    airfoils: AirfoilSpan,
    station: f64,
    chord: f64,
    friction: f64,
    /// Lift and moment per flap angle, hinge moment per incidence and per flap angle, at Mach 0.
    flap: [f64; 4],
}

impl TabulatedSection {
    /// A section at a station of a span.
    ///
    /// | argument | meaning | unit | range |
    /// |---|---|---|---|
    /// | `airfoils` | tables along the span | | |
    /// | `station` | where on the span | that of the span | |
    /// | `chord` | chord | length | above 0 |
    /// | `friction` | drag coefficient of skin friction, part of the tables' drag | - | 0 and up |
    ///
    /// # Errors
    /// [`AeroError::BadInput`] outside these ranges.
    pub fn new(
        airfoils: AirfoilSpan,
        station: f64,
        chord: f64,
        friction: f64,
    ) -> Result<Self, AeroError> {
        check(&[("chord", chord)], "a finite number above 0", |x| x.is_finite() && x > 0.0)?;
        let part = [("friction drag coefficient", friction)];
        check(&part, "a finite number, 0 or more", |x| x.is_finite() && x >= 0.0)?;
        check(&[("station", station)], "a finite number", f64::is_finite)?;
        Ok(Self { airfoils, station, chord, friction, flap: [0.0; 4] })
    }

    /// The section with a flap: thin-aerofoil increments times its effectiveness.
    #[must_use]
    pub fn with_flap(mut self, flap: FlapChord, effectiveness: &FlapEffectiveness) -> Self {
        if flap.is_none() {
            self.flap = [0.0; 4];
            return self;
        }
        let t = TheodorsenFunctions::new(flap.hinge());
        let hinge = t.t::<18>() + t.t::<12>() * t.t::<10>();
        self.flap = [
            2.0 * t.t::<10>() * effectiveness.of(crate::Load::Lift),
            -0.5 * t.t::<15>() * effectiveness.of(crate::Load::Moment),
            -0.5 * t.t::<12>(),
            -hinge / (2.0 * PI) * effectiveness.of(crate::Load::Hinge),
        ];
        self
    }

    /// Forces and slopes in a flow.
    ///
    /// ```text
    /// alpha = atan2(normal, chordwise),  W^2 = chordwise^2 + normal^2,  M = W / sound speed
    /// N = (1/2) rho c W [ Cl u + (Cd - Cf) w ] + (1/2) rho c Cf V w
    /// C = (1/2) rho c W [ Cl w - (Cd - Cf) u ] - (1/2) rho c Cf V u
    /// R = (1/2) rho c Cf V s,         V^2 = W^2 + s^2
    /// M = (1/2) rho c^2 W^2 Cm,       H = (1/2) rho c^2 W^2 Ch
    /// Cl = table + Cl_delta delta g,  Cm = table + Cm_delta delta g,  Ch = (Ch_alpha sin(alpha) + Ch_delta delta) g
    /// g = max(cos(alpha), 0) / beta
    /// ```
    /// Yawed flow: the loads are those of the flow normal to the span (independence principle; its
    /// smaller dynamic pressure is what delays stall in terms of the whole speed), only friction
    /// follows the whole velocity. The tables know reverse flow; the flap has no effect in it.
    ///
    /// Assumes: steady flow. Not modelled: the crossflow's effect on separation, flap in stall.
    ///
    /// # Errors
    /// [`AeroError::BadInput`] if a number is not finite, or density or speed of sound not positive.
    pub fn forces(&self, flow: &SectionFlow) -> Result<LinearisedForces, AeroError> {
        check_flow(flow)?;
        if flow.chordwise.hypot(flow.normal) <= NO_FLOW * flow.sound_speed {
            return Ok(LinearisedForces::default());
        }
        let (u, w) = (Sloped::variable(flow.chordwise, 0), Sloped::variable(flow.normal, 1));
        let (s, delta) = (Sloped::variable(flow.spanwise, 2), Sloped::variable(flow.flap_rad, 3));
        let plane = u.hypot(w);
        let whole = plane.hypot(s);
        let mach = plane * (1.0 / flow.sound_speed).into();
        let square = plane.value * plane.value;
        let incidence =
            Sloped::of(w.value.atan2(u.value), [(-w.value / square, u), (u.value / square, w)]);
        let point = self.airfoils.at(self.station, incidence.value, mach.value);
        let table = |pick: fn(&SteadyCoefficients) -> f64| {
            let slopes = [(pick(&point.per_incidence), incidence), (pick(&point.per_mach), mach)];
            Sloped::of(pick(&point.value), slopes)
        };
        let flap = flap_factor(u, plane, mach);
        let [per_lift, per_moment, hinge_per_sin, per_hinge] = self.flap.map(Sloped::from);
        let lift = table(|c| c.lift) + per_lift * delta * flap;
        let moment = table(|c| c.moment) + per_moment * delta * flap;
        let hinge = (hinge_per_sin * w * plane.inverse() + per_hinge * delta) * flap;
        let drag = table(|c| c.drag) - self.friction.into();
        let scale = Sloped::from(0.5 * flow.density * self.chord);
        let rub = whole * self.friction.into();
        let pressure = scale * plane * plane * self.chord.into();
        let normal = scale * (plane * (lift * u + drag * w) + rub * w);
        let chordwise = scale * (plane * (lift * w - drag * u) - rub * u);
        let spanwise = scale * rub * s;
        let (moment, hinge) = (pressure * moment, pressure * hinge);
        let each = |pick: &dyn Fn(Sloped) -> f64| SectionForces {
            normal: pick(normal),
            chordwise: pick(chordwise),
            spanwise: pick(spanwise),
            moment: pick(moment),
            hinge: pick(hinge),
        };
        Ok(LinearisedForces {
            value: each(&|force| force.value),
            per_velocity: [0, 1, 2].map(|n| each(&|force| force.slopes[n])),
            per_flap_rad: each(&|force| force.slopes[3]),
        })
    }
}

/// `max(cos(alpha), 0) / beta`, which the increments of the flap are multiplied with.
fn flap_factor(u: Sloped, plane: Sloped, mach: Sloped) -> Sloped {
    if u.value <= 0.0 {
        return 0.0.into();
    }
    let held = mach.value.min(MACH_LIMIT);
    let compress = (1.0 - held * held).sqrt().recip();
    let slope = if mach.value < MACH_LIMIT { held * compress.powi(3) } else { 0.0 };
    u * plane.inverse() * Sloped::of(compress, [(slope, mach), (0.0, mach)])
}

/// A number with its derivatives with respect to chordwise, normal and spanwise velocity and flap angle.
#[derive(Debug, Clone, Copy)]
struct Sloped {
    value: f64,
    slopes: [f64; 4],
}

impl Sloped {
    /// One of the four variables.
    fn variable(value: f64, index: usize) -> Self {
        let slopes = std::array::from_fn(|n| if n == index { 1.0 } else { 0.0 });
        Self { value, slopes }
    }

    /// A function of two numbers, from its value and its slopes.
    fn of(value: f64, [(a, x), (b, y)]: [(f64, Self); 2]) -> Self {
        let slopes = std::array::from_fn(|n| a * x.slopes[n] + b * y.slopes[n]);
        Self { value, slopes }
    }

    fn hypot(self, other: Self) -> Self {
        let value = self.value.hypot(other.value);
        Self::of(value, [(self.value / value, self), (other.value / value, other)])
    }

    fn inverse(self) -> Self {
        let value = self.value.recip();
        Self::of(value, [(-value * value, self), (0.0, self)])
    }
}

impl From<f64> for Sloped {
    fn from(value: f64) -> Self {
        Self { value, slopes: [0.0; 4] }
    }
}

impl Add for Sloped {
    type Output = Self;

    fn add(self, other: Self) -> Self {
        Self::of(self.value + other.value, [(1.0, self), (1.0, other)])
    }
}

impl Sub for Sloped {
    type Output = Self;

    fn sub(self, other: Self) -> Self {
        Self::of(self.value - other.value, [(1.0, self), (-1.0, other)])
    }
}

impl Mul for Sloped {
    type Output = Self;

    fn mul(self, other: Self) -> Self {
        Self::of(self.value * other.value, [(other.value, self), (self.value, other)])
    }
}

fn check_flow(flow: &SectionFlow) -> Result<(), AeroError> {
    let positive = [("air density", flow.density), ("speed of sound", flow.sound_speed)];
    check(&positive, "a number above 0", |value| value.is_finite() && value > 0.0)?;
    let finite = [
        ("chordwise velocity", flow.chordwise),
        ("normal velocity", flow.normal),
        ("spanwise velocity", flow.spanwise),
        ("flap angle", flow.flap_rad),
    ];
    check(&finite, "a finite number", f64::is_finite)?;
    Mach::limited(flow.chordwise / flow.sound_speed, MACH_LIMIT).map(|_| ())
}
