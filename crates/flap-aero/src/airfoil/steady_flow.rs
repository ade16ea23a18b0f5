//! Steady nonlinear section from tables: any direction of flow, reverse and yawed included.

use crate::{AeroError, AirfoilSpan, FlapChord, FlapEffectiveness, Mach, TheodorsenFunctions};
use std::f64::consts::PI;

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
        for (quantity, value, fits) in [
            ("chord", chord, chord.is_finite() && chord > 0.0),
            ("friction drag coefficient", friction, friction.is_finite() && friction >= 0.0),
            ("station", station, station.is_finite()),
        ] {
            if !fits {
                let expected = "a finite number in its range";
                return Err(AeroError::BadInput { quantity, value, expected });
            }
        }
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
        check(flow)?;
        let (u, w, s) = (flow.chordwise, flow.normal, flow.spanwise);
        let plane = u.hypot(w);
        if plane <= NO_FLOW * flow.sound_speed {
            return Ok(LinearisedForces::default());
        }
        let mach = plane / flow.sound_speed;
        let point = self.airfoils.at(self.station, w.atan2(u), mach);
        let state = State::new(self, flow, plane);
        let whole = plane.hypot(s);
        // derivatives with respect to u, w, s and the flap angle
        let d_plane = [u / plane, w / plane, 0.0, 0.0];
        let d_whole = [u / whole, w / whole, s / whole, 0.0];
        let d_incidence = [-w / (plane * plane), u / (plane * plane), 0.0, 0.0];
        let (q, friction) = (0.5 * flow.density * self.chord, self.friction);
        let [c0, c1, c2] = [0, 1, 2].map(|i| {
            // value and four derivatives of Cl, Cm, Ch
            let (value, per_alpha, per_mach) = match i {
                0 => (point.value.lift, point.per_incidence.lift, point.per_mach.lift),
                1 => (point.value.moment, point.per_incidence.moment, point.per_mach.moment),
                _ => (0.0, 0.0, 0.0),
            };
            let [add, d_add] = state.increment(i);
            let slopes: [f64; 4] = std::array::from_fn(|n| {
                per_alpha * d_incidence[n] + per_mach * d_plane[n] / flow.sound_speed + d_add[n]
            });
            (value + add[0], slopes)
        });
        let drag = point.value.drag - friction;
        let d_drag: [f64; 4] = std::array::from_fn(|n| {
            point.per_incidence.drag * d_incidence[n]
                + point.per_mach.drag * d_plane[n] / flow.sound_speed
        });
        let unit = |i: usize, n: usize| if i == n { 1.0 } else { 0.0 };
        let part = |n: usize| {
            let (du, dw, ds) = (unit(0, n), unit(1, n), unit(2, n));
            let normal = c0.0 * u + drag * w;
            let chord = c0.0 * w - drag * u;
            let d_normal = c0.1[n] * u + c0.0 * du + d_drag[n] * w + drag * dw;
            let d_chord = c0.1[n] * w + c0.0 * dw - d_drag[n] * u - drag * du;
            let rub = |v: f64, dv: f64| friction * (d_whole[n] * v + whole * dv);
            let pressure =
                |c: f64, dc: f64| q * self.chord * plane * (2.0 * d_plane[n] * c + plane * dc);
            SectionForces {
                normal: q * (d_plane[n] * normal + plane * d_normal + rub(w, dw)),
                chordwise: q * (d_plane[n] * chord + plane * d_chord - rub(u, du)),
                spanwise: q * rub(s, ds),
                moment: pressure(c1.0, c1.1[n]),
                hinge: pressure(c2.0, c2.1[n]),
            }
        };
        let value = SectionForces {
            normal: q * (plane * (c0.0 * u + drag * w) + friction * whole * w),
            chordwise: q * (plane * (c0.0 * w - drag * u) - friction * whole * u),
            spanwise: q * friction * whole * s,
            moment: q * self.chord * plane * plane * c1.0,
            hinge: q * self.chord * plane * plane * c2.0,
        };
        Ok(LinearisedForces {
            value,
            per_velocity: [part(0), part(1), part(2)],
            per_flap_rad: part(3),
        })
    }
}

/// What the flap's increments need.
struct State {
    flap: [f64; 4],
    delta: f64,
    cos: f64,
    sin: f64,
    compress: f64,
    /// Derivatives with respect to `u`, `w`, `s`, flap angle.
    d_cos: [f64; 4],
    d_sin: [f64; 4],
    d_compress: [f64; 4],
}

impl State {
    fn new(section: &TabulatedSection, flow: &SectionFlow, plane: f64) -> Self {
        let (u, w) = (flow.chordwise, flow.normal);
        let mach = plane / flow.sound_speed;
        let held = mach.min(MACH_LIMIT);
        let beta2 = 1.0 - held * held;
        let compress = beta2.sqrt().recip();
        let slope =
            if mach < MACH_LIMIT { held * compress / beta2 / flow.sound_speed } else { 0.0 };
        let (cos, sin) = (u / plane, w / plane);
        Self {
            flap: section.flap,
            delta: flow.flap_rad,
            cos,
            sin,
            compress,
            d_cos: [sin * sin / plane, -sin * cos / plane, 0.0, 0.0],
            d_sin: [-sin * cos / plane, cos * cos / plane, 0.0, 0.0],
            d_compress: [slope * cos, slope * sin, 0.0, 0.0],
        }
    }

    /// Increment of `Cl`, `Cm` or `Ch` (first entry of the first array) and its four derivatives.
    fn increment(&self, load: usize) -> [[f64; 4]; 2] {
        if self.cos <= 0.0 {
            return [[0.0; 4]; 2];
        }
        let [lift, moment, hinge_alpha, hinge] = self.flap;
        let (per_delta, per_sin) = match load {
            0 => (lift, 0.0),
            1 => (moment, 0.0),
            _ => (hinge, hinge_alpha),
        };
        let shape = per_sin * self.sin + per_delta * self.delta;
        let slopes = std::array::from_fn(|n| {
            let d_shape = per_sin * self.d_sin[n] + if n == 3 { per_delta } else { 0.0 };
            self.compress * (self.d_cos[n] * shape + self.cos * d_shape)
                + self.d_compress[n] * self.cos * shape
        });
        [[self.compress * self.cos * shape, 0.0, 0.0, 0.0], slopes]
    }
}

fn check(flow: &SectionFlow) -> Result<(), AeroError> {
    for (quantity, value) in [
        ("chordwise velocity", flow.chordwise),
        ("normal velocity", flow.normal),
        ("spanwise velocity", flow.spanwise),
        ("flap angle", flow.flap_rad),
        ("air density", flow.density),
        ("speed of sound", flow.sound_speed),
    ] {
        if !value.is_finite() {
            return Err(AeroError::BadInput { quantity, value, expected: "a finite number" });
        }
    }
    for (quantity, value) in [("air density", flow.density), ("speed of sound", flow.sound_speed)] {
        if value <= 0.0 {
            return Err(AeroError::BadInput { quantity, value, expected: "a number above 0" });
        }
    }
    Mach::limited(flow.chordwise / flow.sound_speed, MACH_LIMIT).map(|_| ())
}
