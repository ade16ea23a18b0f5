//! Air velocities and section loads at the stations.
//!
//! ```text
//! a   = V - W                                         the section through the air, coned blade axes
//! V   = (u' - c y, v' + c X - s w, w' + s y)          X = x + u,  y = y_t + v,  c = cos bp,  s = sin bp
//! W   = (c mu cos psi - s lambda, -mu sin psi, -(c lambda + s mu cos psi))
//! om  = th' + w_x + bp                                pitch rate of the section
//! U_T = a . chord                                     tangential, from leading to trailing edge
//! U   = U_T + a . t tan L,  t = (1, v_x, w_x)         the same across a line swept back by L
//! U_P = a . normal + e_d om                           down through the blade at the aerodynamic centre
//! ```
//! with chord and normal of [`SectionAxes`], along which the loads stand: velocity and force are each other's
//! transpose, so that in hover shaft torque is inflow times thrust plus profile drag whatever the blade does.
//! With `Linear` and `Full` neither the foreshortening `u` nor the lag `v` carries the section round, `X = x` and
//! `V_x = -c y_t`, and the normal does not lean back with a lagged blade: of a blade that turns as a whole about its
//! root, `w_x v` and `-v_x w_x x` cancel but for `e v_x w_x`.
//!
//! and the four section inputs as velocities: `U_T th - U_P`, `c om`, `U_T delta`, `c delta'`.
//! The lift is normal to the local flow: a lift per tangential speed `L/|U_T|` gives
//! `F_z = L`, `F_y = -s (L/|U_T|) U_P`, which stays finite where the tangential speed vanishes. The
//! sense `s` of the circulation is the matter of [`ReverseFlow`].
//!
//! Source: Johnson, Helicopter Theory (1980), chapter 5, for the velocities; section loads by
//! `flap-aero`.

use crate::ReverseFlow;
use crate::model::air_scales::AirScales;
use crate::structure::blade::ResponseBlade;
use crate::structure::motion::Motion;
use flap_aero::{FreeStream, loads_of_outputs};
use rotor_fem::PitchMotion;

/// Angle of one trailing-edge flap with its azimuth derivatives (rad).
pub(crate) type FlapAngle = [f64; 3];

/// Air seen by one section at one azimuth; speeds in tip speed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct SectionFlow {
    /// Speed across the line of the sections, chordwise.
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
    pub(crate) pitch: PitchMotion,
    pub(crate) reverse_flow: ReverseFlow,
}

/// A vector in coned blade axes with its azimuth derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Turned {
    pub(crate) value: [f64; 3],
    pub(crate) rate: [f64; 3],
}

impl Turned {
    /// Component along another vector and its derivative.
    #[inline]
    fn along(&self, other: &Self) -> [f64; 2] {
        let product = |a: &[f64; 3], b: &[f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
        let rate = product(&self.rate, &other.value) + product(&self.value, &other.rate);
        [product(&self.value, &other.value), rate]
    }
}

/// Chord (toward the leading edge, at no pitch) and normal of a section of the deflected blade.
///
/// ```text
/// chord = (-v_x, 1, 0)                    normal = (-w_x, 0, 1)                          Linear, Full
/// chord = (-v_x, 1 - v_x^2/2, 0)          normal = (-w_x, -v_x w_x, 1 - w_x^2/2)         Moderate
/// ```
/// The second are those of a section turned by lag and then by flap, `t x chord` with `t = (1, v_x, w_x)`, to second order.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SectionAxes {
    pub(crate) chord: Turned,
    pub(crate) normal: Turned,
}

impl SectionAxes {
    /// In a lane of a motion.
    #[inline]
    pub(crate) fn of(blade: &ResponseBlade, motion: &Motion, lane: usize) -> Self {
        let (v_x, v_rate) = (motion.v.slope[lane], motion.v.slope_rate[lane]);
        let (w_x, w_rate) = (motion.w.slope[lane], motion.w.slope_rate[lane]);
        let second = if blade.modal.is_some() { 1.0 } else { 0.0 };
        Self {
            chord: Turned {
                value: [-v_x, 1.0 - second * 0.5 * v_x * v_x, 0.0],
                rate: [-v_rate, -second * v_x * v_rate, 0.0],
            },
            normal: Turned {
                value: [-w_x, -second * v_x * w_x, 1.0 - second * 0.5 * w_x * w_x],
                rate: [-w_rate, -second * (v_rate * w_x + v_x * w_rate), -second * w_x * w_rate],
            },
        }
    }

    /// Forces toward the leading edge and up, in coned blade axes, of a load along the section's axes. The one along
    /// the blade is [`SpanLoads::fx`](crate::structure::equations::SpanLoads::fx).
    #[inline]
    pub(crate) fn force(&self, loads: &SectionLoads) -> [f64; 2] {
        let along = |k: usize| loads.fy * self.chord.value[k] + loads.fz * self.normal.value[k];
        [along(1), along(2)]
    }
}

/// Velocity of a section through the air, coned blade axes; the inflow is held in the rate.
#[inline]
fn through_air(
    blade: &ResponseBlade,
    (motion, lane): (&Motion, usize),
    point: &AirPoint,
    (i, lambda): (usize, f64),
) -> Turned {
    let (w, v) = (&motion.w, &motion.v);
    let (mu_sin, mu_cos) = (point.advance_ratio * point.sin, point.advance_ratio * point.cos);
    let [s, c] = blade.cone;
    let y_t = blade.offsets.torque;
    let [u, u_rate, u_acceleration] = motion.shortening(lane);
    let (value, rate) = (v.value[lane], v.rate[lane]);
    // what the section has of the speed along the blade by its lag
    let [lag, lag_rate] = if blade.modal.is_some() { [value, rate] } else { [0.0; 2] };
    let x = blade.grid.x()[i];
    Turned {
        value: [
            u_rate - c * (y_t + lag) - c * mu_cos + s * lambda,
            rate + c * (x + u) - s * w.value[lane] + mu_sin,
            w.rate[lane] + s * (y_t + value) + c * lambda + s * mu_cos,
        ],
        rate: [
            u_acceleration - c * lag_rate + c * mu_sin,
            v.acceleration[lane] + c * u_rate - s * w.rate[lane] + mu_cos,
            w.acceleration[lane] + s * rate - s * mu_sin,
        ],
    }
}

/// Flow at station `i`, whose motion stands in a lane, for a total inflow `lambda` (down positive, tip speed).
#[inline]
pub(crate) fn section_flow(
    blade: &ResponseBlade,
    (motion, lane): (&Motion, usize),
    point: &AirPoint,
    (i, lambda): (usize, f64),
    delta: FlapAngle,
) -> SectionFlow {
    let (w, phi) = (&motion.w, &motion.phi);
    let theta = point.pitch.angle_rad + blade.twist[i] + phi.value[lane];
    let theta_rate = point.pitch.rate + phi.rate[lane];
    let AirScales { chord, centre, sweep, .. } = blade.air[i];
    let om = theta_rate + w.slope[lane] + blade.precone;
    let om_rate = point.pitch.acceleration + phi.acceleration[lane] + w.slope_rate[lane];
    let through = through_air(blade, (motion, lane), point, (i, lambda));
    let axes = SectionAxes::of(blade, motion, lane);
    let [u_t, u_t_rate] = through.along(&axes.chord);
    let [normal, normal_rate] = through.along(&axes.normal);
    let u_p = normal + centre * om;
    let u_p_rate = normal_rate + centre * om_rate;
    let along_span = || {
        let [x, y, z] = through.value;
        x + motion.v.slope[lane] * y + w.slope[lane] * z
    };
    let speed = if sweep == 0.0 { u_t } else { u_t + sweep * along_span() };
    let rigid = blade.grid.x()[i] + point.advance_ratio * (point.sin - sweep * point.cos);
    SectionFlow {
        u_t: speed,
        u_p,
        sense: sense(point.reverse_flow, speed, u_p, rigid),
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
#[inline]
pub(crate) fn sense(reverse_flow: ReverseFlow, u_t: f64, u_p: f64, rigid: f64) -> f64 {
    match reverse_flow {
        ReverseFlow::Gradual => u_t / (u_t * u_t + u_p * u_p).sqrt().max(f64::MIN_POSITIVE),
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

/// Outputs per input, `[output][input]`.
pub(crate) type Gains = [[f64; 4]; 3];

/// Section coefficients without their lags: outputs per input, and per rate of an input in
/// semichords travelled, `[output][input]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PromptCoefficients<'a> {
    pub(crate) direct: &'a Gains,
    /// None if there are none.
    pub(crate) rate: Option<&'a Gains>,
}

impl PromptCoefficients<'_> {
    /// Output `o` of apparent mass.
    #[inline]
    pub(crate) fn apparent(&self, o: usize, flow: &SectionFlow) -> f64 {
        self.rate.map_or(0.0, |rate| dot(&rate[o], &flow.input_rate))
    }
}

/// Scalar product over the four section inputs.
#[inline]
pub(crate) fn dot(a: &[f64; 4], b: &[f64; 4]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

/// Section loads from the flow, the coefficients and the lag part of the three outputs
/// (lift, moment, hinge moment, as velocities).
#[inline]
pub(crate) fn section_loads(
    scales: AirScales,
    flow: &SectionFlow,
    coefficients: PromptCoefficients<'_>,
    lag: [f64; 3],
) -> SectionLoads {
    let stream = FreeStream {
        density: scales.density_chord / scales.chord,
        semichord: 0.5 * scales.chord,
        speed: flow.u_t,
    };
    let circulating = |k: usize| dot(&coefficients.direct[k], &flow.input) + lag[k];
    let circulating = [circulating(0), circulating(1), circulating(2)];
    let apparent = |k: usize| coefficients.apparent(k, flow);
    let apparent = [apparent(0), apparent(1), apparent(2)];
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
