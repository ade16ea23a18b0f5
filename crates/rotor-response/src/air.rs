//! Air velocities and section loads at the stations.
//!
//! ```text
//! U_R = mu cos psi + y_t                              along the blade, y_t the torque offset
//! U_T = x + mu sin psi + v' + v_x U_R                 tangential, from leading to trailing edge
//! om  = th' + w_x + bp                                pitch rate of the section
//! U_P = lambda + w' + (w_x + bp) U_R + e_d om         down through the blade at the aerodynamic centre
//! ```
//! and the four section inputs as velocities: `U_T th - U_P`, `c om`, `U_T delta`, `c delta'`.
//! The lift is normal to the local flow: a lift per tangential speed `L/|U_T|` gives
//! `F_z = L`, `F_y = -s (L/|U_T|) U_P`, which stays finite where the tangential speed vanishes. The
//! sense `s` of the circulation is the matter of [`ReverseFlow`].
//!
//! Source: Johnson, Helicopter Theory (1980), chapter 5, for the velocities; section loads by
//! `flap-aero`.

use crate::ReverseFlow;
use crate::blade::ResponseBlade;
use crate::motion::{Motion, RootPitch};
use flap_aero::{FreeStream, loads_of_outputs};

/// Angle of one trailing-edge flap with its azimuth derivatives (rad).
pub(crate) type FlapAngle = [f64; 3];

/// Air seen by one section at one azimuth; speeds in tip speed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct SectionFlow {
    pub(crate) u_t: f64,
    pub(crate) u_p: f64,
    /// Sense of the circulation: 1 in flow from the leading edge, -1 in reverse flow.
    pub(crate) sense: f64,
    /// Pitch of the section, nose up, rad.
    pub(crate) pitch: f64,
    /// `[U alpha, c om, U delta, c delta']`.
    pub(crate) input: [f64; 4],
    /// Azimuth derivative of the inputs.
    pub(crate) input_rate: [f64; 4],
}

impl SectionFlow {
    /// Adds a share of another flow; the sense is none of the sum's.
    pub(crate) fn add(&mut self, share: f64, other: &Self) {
        self.u_t += share * other.u_t;
        self.u_p += share * other.u_p;
        self.pitch += share * other.pitch;
        for (sum, value) in self.input.iter_mut().zip(other.input) {
            *sum += share * value;
        }
        for (sum, value) in self.input_rate.iter_mut().zip(other.input_rate) {
            *sum += share * value;
        }
    }
}

/// Azimuth, free stream and pitch at one azimuth point.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct AirPoint {
    pub(crate) sin: f64,
    pub(crate) cos: f64,
    pub(crate) advance_ratio: f64,
    pub(crate) pitch: RootPitch,
    pub(crate) reverse_flow: ReverseFlow,
}

/// Flow at station `i` for a total inflow `lambda` (down positive, tip speed).
pub(crate) fn section_flow(
    blade: &ResponseBlade,
    chord: f64,
    motion: &Motion,
    point: &AirPoint,
    (i, lambda): (usize, f64),
    delta: FlapAngle,
) -> SectionFlow {
    let (w, v, phi) = (&motion.w, &motion.v, &motion.phi);
    let (mu_sin, mu_cos) = (point.advance_ratio * point.sin, point.advance_ratio * point.cos);
    let theta = point.pitch.angle + blade.twist[i] + phi.value[i];
    let theta_rate = point.pitch.rate + phi.rate[i];
    let along = mu_cos + blade.offsets.torque;
    let centre = blade.offsets.aerodynamic_centre;
    let om = theta_rate + w.slope[i] + blade.precone;
    let om_rate = point.pitch.acceleration + phi.acceleration[i] + w.slope_rate[i];
    let u_t = blade.grid.x()[i] + mu_sin + v.rate[i] + v.slope[i] * along;
    let u_p = lambda + w.rate[i] + (w.slope[i] + blade.precone) * along + centre * om;
    let u_t_rate = mu_cos + v.acceleration[i] + v.slope_rate[i] * along - v.slope[i] * mu_sin;
    let u_p_rate = w.acceleration[i] + w.slope_rate[i] * along
        - (w.slope[i] + blade.precone) * mu_sin
        + centre * om_rate;
    SectionFlow {
        u_t,
        u_p,
        sense: sense(point.reverse_flow, (u_t, u_p), blade.grid.x()[i] + mu_sin),
        pitch: theta,
        input: [u_t * theta - u_p, chord * om, u_t * delta[0], chord * delta[1]],
        input_rate: [
            u_t_rate * theta + u_t * theta_rate - u_p_rate,
            chord * om_rate,
            u_t_rate * delta[0] + u_t * delta[1],
            chord * delta[2],
        ],
    }
}

/// Sense of the circulation in a flow `(U_T, U_P)`, the rigid blade having the tangential speed `rigid`.
pub(crate) fn sense(reverse_flow: ReverseFlow, (u_t, u_p): (f64, f64), rigid: f64) -> f64 {
    match reverse_flow {
        ReverseFlow::Gradual => u_t / u_t.hypot(u_p).max(f64::MIN_POSITIVE),
        ReverseFlow::Abrupt => rigid.signum(),
    }
}

/// Loads of one section per length, rotor units.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct SectionLoads {
    pub(crate) fz: f64,
    pub(crate) fy: f64,
    pub(crate) moment: f64,
    pub(crate) hinge: f64,
    /// Bound circulation, tip speed times R, positive with lift up in flow from the leading edge.
    pub(crate) circulation: f64,
}

impl SectionLoads {
    /// The same about an axis that lies `centre` behind the point of attack, the section pitched by `pitch`.
    pub(crate) fn about(self, centre: f64, pitch: f64) -> Self {
        let (sin, cos) = pitch.sin_cos();
        Self { moment: self.moment + centre * (self.fz * cos - self.fy * sin), ..self }
    }

    /// Adds a share of other loads.
    pub(crate) fn add(&mut self, share: f64, other: &Self) {
        self.fz += share * other.fz;
        self.fy += share * other.fy;
        self.moment += share * other.moment;
        self.hinge += share * other.hinge;
        self.circulation += share * other.circulation;
    }
}

/// What the past of a section adds to its loads.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct SectionPast {
    /// Lag part of lift, moment and hinge moment, velocities.
    pub(crate) lag: [f64; 3],
    /// Share of the rigid section, without its flap, in the lag part of the lift; only of sections
    /// beyond linear theory.
    pub(crate) rigid_lift: f64,
    /// What stall adds to the coefficients of normal force, chord force and moment.
    pub(crate) stall: [f64; 3],
}

/// What turns coefficients into loads: `rho c R/m0`, chord `c/R`, profile drag coefficient, aerodynamic
/// centre ahead of the elastic axis over R.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct AirScales {
    pub(crate) density_chord: f64,
    pub(crate) chord: f64,
    pub(crate) drag: f64,
    pub(crate) centre: f64,
}

/// Section coefficients without their lags: outputs per input, and per rate of an input in
/// semichords travelled, `[output][input]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PromptCoefficients {
    pub(crate) direct: [[f64; 4]; 3],
    pub(crate) rate: [[f64; 4]; 3],
}

/// Scalar product over the four section inputs.
pub(crate) fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

/// Section loads from the flow, the coefficients and the lag part of the three outputs
/// (lift, moment, hinge moment, as velocities).
pub(crate) fn section_loads(
    scales: AirScales,
    flow: &SectionFlow,
    coefficients: &PromptCoefficients,
    lag: [f64; 3],
) -> SectionLoads {
    let stream = FreeStream {
        density: scales.density_chord / scales.chord,
        semichord: 0.5 * scales.chord,
        speed: flow.u_t,
    };
    let circulating = [0, 1, 2].map(|k| dot(&coefficients.direct[k], &flow.input) + lag[k]);
    let apparent = [0, 1, 2].map(|k| dot(&coefficients.rate[k], &flow.input_rate));
    let loads = loads_of_outputs(&stream, circulating, apparent);
    let half = 0.5 * scales.density_chord;
    SectionLoads {
        fz: loads.lift,
        fy: -half
            * (flow.sense * circulating[0] * flow.u_p + scales.drag * flow.u_t.abs() * flow.u_t),
        moment: loads.moment,
        hinge: loads.hinge,
        circulation: 0.5 * scales.chord * flow.sense * circulating[0],
    }
}
