//! Air velocities and section loads at the stations.
//!
//! ```text
//! a   = V - W                                         the section through the air, coned blade axes
//! V   = (u' - c y, v' + c X - s w, w' + s y)          X = x + u,  y = y_t + v,  c = cos bp,  s = sin bp
//! W   = (c mu cos psi - s lambda, -(mu sin psi + u_i), -(c lambda + s mu cos psi))
//! om  = th' + w_x + bp + mu cos psi th_x              rate at which the incidence grows along the chord
//! U_T = a . chord                                     tangential, from leading to trailing edge
//! U   = U_T + a . t tan L,  t = (1, v_x, w_x)         the same across a line swept back by L
//! U_P = a . normal + e_d om                           down through the blade at the aerodynamic centre
//! ```
//! `u_i` is the induced velocity in the plane of the disk. Air that moves outward by `mu cos psi` meets another
//! pitch: `th_x` is the slope of built-in and elastic twist, and acts as a pitch rate does.
//!
//! The axes are chord and normal of [`SectionAxes`], along which the loads stand: velocity and force are each other's
//! transpose, so that in hover shaft torque is inflow times thrust plus profile drag whatever the blade does.
//! With `Linear` and `Full` neither the foreshortening `u` nor the lag `v` carries the section round, `X = x` and
//! `V_x = -c y_t`, and the normal does not lean back with a lagged blade: of a blade that turns as a whole about its
//! root, `w_x v` and `-v_x w_x x` cancel but for `e v_x w_x`.
//!
//! and the four section inputs as velocities: `U_T th - |U_T| a_0 - U_P`, `c om`, `U_T delta`, `c delta'`, with `a_0` the
//! incidence of zero lift.
//! The lift is normal to the local flow: a lift per tangential speed `L/|U_T|` gives
//! `F_z = L`, `F_y = -s (L/|U_T|) U_P`, which stays finite where the tangential speed vanishes. The
//! sense `s` of the circulation is the matter of [`ReverseFlow`].
//!
//! Source: Johnson, Helicopter Theory (1980), chapter 5, for the velocities; section loads by
//! `flap-aero`.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use crate::ReverseFlow;
use crate::model::air_scales::AirScales;
use crate::structure::blade::ResponseBlade;
use crate::structure::motion::Motion;
use flap_aero::{FreeStream, loads_of_outputs};
use rotor_base::{LANES, Lanes, Number};
use rotor_fem::PitchMotion;

/// Angle of one trailing-edge flap with its azimuth derivatives (rad).
pub(crate) type FlapAngle<T = f64> = [T; 3];

/// Air seen by one section at one azimuth, or at several side by side; speeds in tip speed.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct SectionFlow<T = f64> {
    /// Speed across the line of the sections, chordwise.
    pub(crate) u_t: T,
    pub(crate) u_p: T,
    /// Sense of the circulation: 1 in flow from the leading edge, -1 in reverse flow.
    pub(crate) sense: T,
    /// Pitch of the section, nose up, rad.
    pub(crate) pitch: T,
    /// `[U alpha, c om, U delta, c delta']`.
    pub(crate) input: [T; 4],
    /// Azimuth derivative of the inputs.
    pub(crate) input_rate: [T; 4],
}

impl SectionFlow<Lanes> {
    /// The flow in one lane.
    pub(crate) fn lane(&self, k: usize) -> SectionFlow {
        SectionFlow {
            u_t: self.u_t.0[k],
            u_p: self.u_p.0[k],
            sense: self.sense.0[k],
            pitch: self.pitch.0[k],
            input: self.input.map(|row| row.0[k]),
            input_rate: self.input_rate.map(|row| row.0[k]),
        }
    }

    /// Flows side by side; the last one fills the rest.
    pub(crate) fn gather(flows: &[SectionFlow]) -> Self {
        let of = |value: fn(&SectionFlow) -> f64| gathered(flows, value);
        Self {
            u_t: of(|flow| flow.u_t),
            u_p: of(|flow| flow.u_p),
            sense: of(|flow| flow.sense),
            pitch: of(|flow| flow.pitch),
            input: std::array::from_fn(|i| gathered(flows, |flow| flow.input[i])),
            input_rate: std::array::from_fn(|i| gathered(flows, |flow| flow.input_rate[i])),
        }
    }
}

/// A value of every element, side by side; the last one fills the rest.
pub(crate) fn gathered<A>(of: &[A], value: impl Fn(&A) -> f64) -> Lanes {
    Lanes::from_fn(|k| of.get(k).or(of.last()).map_or(0.0, &value))
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

/// Azimuth, free stream and pitch at one azimuth point, or at several side by side.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct AirPoint<T = f64> {
    pub(crate) sin: T,
    pub(crate) cos: T,
    pub(crate) advance_ratio: f64,
    pub(crate) pitch: PitchMotion<T>,
    pub(crate) reverse_flow: ReverseFlow,
}

/// A vector in coned blade axes with its azimuth derivative.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Turned<T> {
    pub(crate) value: [T; 3],
    pub(crate) rate: [T; 3],
}

impl<T: Number> Turned<T> {
    /// Component along another vector and its derivative.
    #[inline(always)]
    fn along(&self, other: &Self) -> [T; 2] {
        let product = |a: &[T; 3], b: &[T; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
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
pub(crate) struct SectionAxes<T> {
    pub(crate) chord: Turned<T>,
    pub(crate) normal: Turned<T>,
}

impl<T: Number> SectionAxes<T> {
    /// In a lane, or a block of lanes, of a motion.
    #[inline(always)]
    pub(crate) fn of(blade: &ResponseBlade, motion: &Motion, lane: usize) -> Self {
        let (v_x, v_rate): (T, T) = (motion.v.slope(lane), motion.v.slope_rate(lane));
        let (w_x, w_rate): (T, T) = (motion.w.slope(lane), motion.w.slope_rate(lane));
        let second = if blade.modal.is_some() { -1.0 } else { 0.0 };
        let zero = T::default();
        Self {
            chord: Turned {
                value: [-v_x, v_x * v_x * (0.5 * second) + 1.0, zero],
                rate: [-v_rate, v_x * v_rate * second, zero],
            },
            normal: Turned {
                value: [-w_x, v_x * w_x * second, w_x * w_x * (0.5 * second) + 1.0],
                rate: [-w_rate, (v_rate * w_x + v_x * w_rate) * second, w_x * w_rate * second],
            },
        }
    }

    /// Forces toward the leading edge and up, in coned blade axes, of a load along the section's axes. The one along
    /// the blade is [`SpanLoads::fx`](crate::structure::equations::SpanLoads::fx).
    #[inline(always)]
    pub(crate) fn force(&self, loads: &SectionLoads<T>) -> [T; 2] {
        let along = |k: usize| loads.fy * self.chord.value[k] + loads.fz * self.normal.value[k];
        [along(1), along(2)]
    }
}

/// Velocity of a section through the air, coned blade axes; the inflow is held in the rate.
#[inline(always)]
fn through_air<T: Number>(
    blade: &ResponseBlade,
    (motion, lane): (&Motion, usize),
    point: &AirPoint<T>,
    (i, [lambda, along]): (usize, [T; 2]),
) -> Turned<T> {
    let (w, v) = (&motion.w, &motion.v);
    let (mu_sin, mu_cos) = (point.sin * point.advance_ratio, point.cos * point.advance_ratio);
    let [s, c] = blade.cone;
    let y_t = blade.offsets.torque;
    let [u, u_rate, u_acceleration]: [T; 3] = motion.shortening(lane);
    let (value, rate): (T, T) = (v.value(lane), v.rate(lane));
    // what the section has of the speed along the blade by its lag
    let [lag, lag_rate] = if blade.modal.is_some() { [value, rate] } else { [T::default(); 2] };
    let x = blade.grid.x()[i];
    let w_rate: T = w.rate(lane);
    Turned {
        value: [
            u_rate - (lag + y_t) * c - mu_cos * c + lambda * s,
            rate + (u + x) * c - w.value::<T>(lane) * s + mu_sin + along,
            w_rate + (value + y_t) * s + lambda * c + mu_cos * s,
        ],
        rate: [
            u_acceleration - lag_rate * c + mu_sin * c,
            v.acceleration::<T>(lane) + u_rate * c - w_rate * s + mu_cos,
            w.acceleration::<T>(lane) + rate * s - mu_sin * s,
        ],
    }
}

/// Flow at station `i`, whose motion stands in a lane or a block of lanes, for a total inflow (down positive) and an induced
/// velocity in the plane of the disk (from the leading to the trailing edge), tip speed.
#[inline(always)]
pub(crate) fn section_flow<T: Number>(
    blade: &ResponseBlade,
    (motion, lane): (&Motion, usize),
    point: &AirPoint<T>,
    (i, inflow): (usize, [T; 2]),
    delta: FlapAngle<T>,
) -> SectionFlow<T> {
    let (w, phi) = (&motion.w, &motion.phi);
    let theta = point.pitch.angle_rad + blade.twist[i] + phi.value::<T>(lane);
    let theta_rate = point.pitch.rate + phi.rate::<T>(lane);
    let AirScales { chord, centre, sweep, zero_lift, .. } = blade.air[i];
    // what the air along the blade meets of the twist
    let (mu_sin, mu_cos) = (point.sin * point.advance_ratio, point.cos * point.advance_ratio);
    let twist_slope = phi.slope::<T>(lane) + blade.twist_slope[i];
    let om = theta_rate + w.slope::<T>(lane) + mu_cos * twist_slope + blade.precone;
    let met_rate = mu_cos * phi.slope_rate::<T>(lane) - mu_sin * twist_slope;
    let om_rate =
        point.pitch.acceleration + phi.acceleration::<T>(lane) + w.slope_rate::<T>(lane) + met_rate;
    let through = through_air(blade, (motion, lane), point, (i, inflow));
    let axes = SectionAxes::of(blade, motion, lane);
    let [u_t, u_t_rate] = through.along(&axes.chord);
    let [normal, normal_rate] = through.along(&axes.normal);
    let u_p = normal + om * centre;
    let u_p_rate = normal_rate + om_rate * centre;
    let along_span = || {
        let [x, y, z] = through.value;
        x + motion.v.slope::<T>(lane) * y + w.slope::<T>(lane) * z
    };
    let speed = if sweep == 0.0 { u_t } else { u_t + along_span() * sweep };
    let rigid = (point.sin - point.cos * sweep) * point.advance_ratio + blade.grid.x()[i];
    let [mut inclined, mut inclined_rate] =
        [u_t * theta - u_p, u_t_rate * theta + u_t * theta_rate - u_p_rate];
    if zero_lift != 0.0 {
        inclined -= u_t.abs() * zero_lift;
        inclined_rate -= u_t.map(f64::signum) * u_t_rate * zero_lift;
    }
    SectionFlow {
        u_t: speed,
        u_p,
        sense: sense(point.reverse_flow, speed, u_p, rigid),
        pitch: theta,
        input: [inclined, om * chord, u_t * delta[0], delta[1] * chord],
        input_rate: [
            inclined_rate,
            om_rate * chord,
            u_t_rate * delta[0] + u_t * delta[1],
            delta[2] * chord,
        ],
    }
}

/// Sense of the circulation in a flow `(U_T, U_P)`, the rigid blade having the tangential speed `rigid`.
#[inline(always)]
pub(crate) fn sense<T: Number>(reverse_flow: ReverseFlow, u_t: T, u_p: T, rigid: T) -> T {
    match reverse_flow {
        ReverseFlow::Gradual => u_t / (u_t * u_t + u_p * u_p).sqrt().at_least(f64::MIN_POSITIVE),
        ReverseFlow::Abrupt => rigid.map(f64::signum),
    }
}

/// Loads of one section per length at one azimuth, or at several side by side; rotor units.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub(crate) struct SectionLoads<T = f64> {
    pub(crate) fz: T,
    pub(crate) fy: T,
    pub(crate) moment: T,
    pub(crate) hinge: T,
    /// Bound circulation, tip speed times R, positive with lift up in flow from the leading edge.
    pub(crate) circulation: T,
}

impl<T: Number> SectionLoads<T> {
    /// The same about an axis that lies `centre` behind the point of attack, the section pitched by `pitch`.
    #[inline(always)]
    pub(crate) fn about(self, centre: f64, pitch: T) -> Self {
        let (sin, cos) = pitch.sin_cos();
        Self { moment: self.moment + (self.fz * cos - self.fy * sin) * centre, ..self }
    }
}

impl SectionLoads<Lanes> {
    /// The loads in one lane.
    #[inline]
    pub(crate) fn lane(&self, k: usize) -> SectionLoads {
        SectionLoads {
            fz: self.fz.0[k],
            fy: self.fy.0[k],
            moment: self.moment.0[k],
            hinge: self.hinge.0[k],
            circulation: self.circulation.0[k],
        }
    }

    /// Loads side by side; the last one fills the rest.
    pub(crate) fn gather(loads: &[SectionLoads]) -> Self {
        Self {
            fz: gathered(loads, |of| of.fz),
            fy: gathered(loads, |of| of.fy),
            moment: gathered(loads, |of| of.moment),
            hinge: gathered(loads, |of| of.hinge),
            circulation: gathered(loads, |of| of.circulation),
        }
    }
}

impl SectionLoads {
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
pub(crate) struct SectionPast<T = f64> {
    /// Lag part of lift, moment and hinge moment, velocities.
    pub(crate) lag: [T; 3],
    /// Share of the rigid section, without its flap, in the lag part of the lift; only of sections
    /// beyond linear theory.
    pub(crate) rigid_lift: T,
    /// Circulatory share in the lag part of the lift; only of sections whose lift holds pressure waves.
    pub(crate) circulatory_lift: T,
    /// What stall adds to the coefficients of normal force, chord force and moment.
    pub(crate) stall: [T; 3],
}

impl SectionPast<Lanes> {
    /// The past in one lane.
    pub(crate) fn lane(&self, k: usize) -> SectionPast {
        SectionPast {
            lag: self.lag.map(|row| row.0[k]),
            rigid_lift: self.rigid_lift.0[k],
            circulatory_lift: self.circulatory_lift.0[k],
            stall: self.stall.map(|row| row.0[k]),
        }
    }
}

/// Outputs per input, `[output][input]`.
pub(crate) type Gains<T = f64> = [[T; 4]; 3];

/// Section coefficients without their lags: outputs per input, and per rate of an input in
/// semichords travelled, `[output][input]`.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct PromptCoefficients<T = f64> {
    pub(crate) direct: Gains<T>,
    /// None if there are none.
    pub(crate) rate: Option<Gains<T>>,
    /// Whether the lift holds pressure waves, see [`SectionCoefficients::has_waves`](flap_aero::SectionCoefficients).
    pub(crate) has_waves: bool,
}

impl<T: Number> PromptCoefficients<T> {
    /// Output `o` of apparent mass.
    #[inline(always)]
    pub(crate) fn apparent(&self, o: usize, flow: &SectionFlow<T>) -> T {
        match &self.rate {
            Some(rate) => dot(&rate[o], &flow.input_rate),
            None => T::default(),
        }
    }

    /// What of the lift, as a velocity, are pressure waves that make no circulation.
    #[inline(always)]
    pub(crate) fn waves(&self, flow: &SectionFlow<T>, past: &SectionPast<T>) -> T {
        if self.has_waves {
            dot(&self.direct[0], &flow.input) + past.lag[0] - past.circulatory_lift
        } else {
            T::default()
        }
    }
}

impl PromptCoefficients<Lanes> {
    /// The coefficients in one lane.
    pub(crate) fn lane(&self, k: usize) -> PromptCoefficients {
        PromptCoefficients {
            direct: lane_of(&self.direct, k),
            rate: self.rate.map(|rate| lane_of(&rate, k)),
            has_waves: self.has_waves,
        }
    }
}

/// Gains in one lane.
pub(crate) fn lane_of(gains: &Gains<Lanes>, k: usize) -> Gains {
    gains.map(|row| row.map(|gain| gain.0[k]))
}

/// Gains of points side by side; the last one fills the rest.
pub(crate) fn in_lanes(points: &[Gains]) -> Vec<Gains<Lanes>> {
    let block = |block: &[Gains]| -> Gains<Lanes> {
        std::array::from_fn(|o| std::array::from_fn(|i| gathered(block, |gains| gains[o][i])))
    };
    points.chunks(LANES).map(block).collect()
}

/// Scalar product over the four section inputs.
#[inline(always)]
pub(crate) fn dot<T: Number>(a: &[T; 4], b: &[T; 4]) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2] + a[3] * b[3]
}

/// Section loads from the flow, the coefficients and the past. The circulation is that of the lift without
/// apparent mass and pressure waves.
#[inline(always)]
pub(crate) fn section_loads<T: Number>(
    scales: AirScales,
    flow: &SectionFlow<T>,
    coefficients: &PromptCoefficients<T>,
    past: &SectionPast<T>,
) -> SectionLoads<T> {
    let stream = FreeStream {
        density: scales.density_chord / scales.chord,
        semichord: 0.5 * scales.chord,
        speed: flow.u_t,
    };
    let [lift, moment, hinge] = coefficients.direct;
    let lag = past.lag;
    let circulating = [
        dot(&lift, &flow.input) + lag[0],
        dot(&moment, &flow.input) + lag[1],
        dot(&hinge, &flow.input) + lag[2],
    ];
    let apparent = [
        coefficients.apparent(0, flow),
        coefficients.apparent(1, flow),
        coefficients.apparent(2, flow),
    ];
    let loads = loads_of_outputs(&stream, circulating, apparent);
    let half = 0.5 * scales.density_chord;
    let circulatory = circulating[0] - coefficients.waves(flow, past);
    SectionLoads {
        fz: loads.lift,
        fy: -(flow.sense * circulating[0] * flow.u_p + flow.u_t.abs() * flow.u_t * scales.drag)
            * half,
        moment: loads.moment
            + flow.u_t.abs() * flow.u_t * (half * scales.chord * scales.camber_moment),
        hinge: loads.hinge,
        circulation: flow.sense * circulatory * (0.5 * scales.chord),
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{Discretisation, Rotor, RotorModel};
    use approx::assert_abs_diff_eq;
    use rotor_fem::{BladeProperties, BladeSpec, Twist};

    const MU: f64 = 0.3;

    /// A rotor whose blade is as twisted as a tilt rotor's, and a motion of its modes.
    fn twisted(scale: f64) -> (Rotor, Motion) {
        let spec = BladeSpec { twist: Twist::Linear { rate_rad: -0.6 }, ..BladeSpec::table_1() };
        let blade = BladeProperties::new(spec).unwrap();
        let rotor = Rotor::new(RotorModel::paper_case(), &blade, Discretisation::default());
        let rotor = rotor.unwrap();
        let count = rotor.blade().frequencies.len();
        let wave = |k: f64| -> Vec<f64> {
            (0..count).map(|j| scale * (k + 1.7 * j as f64).sin()).collect()
        };
        let parts = [wave(0.3), wave(1.1), wave(2.0)];
        let mut motion = Motion::default();
        motion.fill(rotor.blade(), parts.each_ref().map(Vec::as_slice));
        (rotor, motion)
    }

    fn point(psi: f64) -> AirPoint {
        let pitch = PitchMotion { angle_rad: 0.1, rate: 0.05, acceleration: -0.03 };
        let (sin, cos) = psi.sin_cos();
        AirPoint { sin, cos, advance_ratio: MU, pitch, reverse_flow: ReverseFlow::Gradual }
    }

    /// The pitch rate against the surface itself: a particle of air beside the blade moves outward by `mu cos psi` and meets
    /// a section of another pitch. No-penetration on `z = w(x, t) - eta theta(x, t)`, `eta` toward the trailing edge, whose
    /// slope along the chord is the pitch rate; derivatives of the surface by differences.
    #[test]
    fn the_pitch_rate_is_that_of_the_surface_the_air_passes() {
        let (rotor, motion) = twisted(0.01);
        let blade = rotor.blade();
        for psi in [0.0, 0.8, 2.5, 4.0] {
            let point = point(psi);
            let radial = MU * psi.cos();
            for i in [30, 45, 55] {
                let flow = section_flow(blade, (&motion, i), &point, (i, [0.0; 2]), [0.0; 3]);
                let x = blade.grid.x()[i];
                let step = 1e-4;
                // the surface around the station, rotating axes, after a time `t`
                let pitch = |dx: f64, t: f64| {
                    blade.properties.twist_rad(x + dx)
                        + point.pitch.angle_rad
                        + t * (point.pitch.rate + motion.phi.rate[i])
                        + motion.phi.value[i]
                        + dx * motion.phi.slope[i]
                };
                let height = |dx: f64, eta: f64, t: f64| {
                    motion.w.value[i]
                        + dx * (motion.w.slope[i] + blade.precone)
                        + t * motion.w.rate[i]
                        - eta * pitch(dx, t)
                };
                // velocity of the air that has to be made up for, by the speed along the blade and the turning axes
                let upwash = |eta: f64| {
                    let along_x = (height(step, eta, 0.0) - height(-step, eta, 0.0)) / (2.0 * step);
                    let in_time = (height(0.0, eta, step) - height(0.0, eta, -step)) / (2.0 * step);
                    -(in_time + (radial - eta) * along_x)
                };
                let eta = 1e-3;
                let slope = (upwash(eta) - upwash(-eta)) / (2.0 * eta);
                assert_abs_diff_eq!(flow.input[1] / blade.air[i].chord, slope, epsilon = 1e-9);
            }
        }
    }

    /// Rates of the inputs against differences over the azimuth, the controls at rest, and a velocity in the plane of the
    /// disk against a blade that moves as much faster toward its leading edge.
    #[test]
    fn rates_follow_and_air_in_the_plane_is_a_faster_blade() {
        let (rotor, motion) = twisted(0.0);
        let (blade, i, step) = (rotor.blade(), 50, 1e-5);
        let still = |psi: f64| AirPoint {
            pitch: PitchMotion { angle_rad: 0.1, rate: 0.0, acceleration: 0.0 },
            ..point(psi)
        };
        let at = |psi: f64| section_flow(blade, (&motion, i), &still(psi), (i, [0.0; 2]), [0.0; 3]);
        for psi in [0.4, 2.0, 5.0] {
            let (here, above, below) = (at(psi), at(psi + step), at(psi - step));
            for k in 0..2 {
                let slope = (above.input[k] - below.input[k]) / (2.0 * step);
                assert_abs_diff_eq!(here.input_rate[k], slope, epsilon = 1e-9);
            }
            let mut faster = motion.clone();
            faster.v.rate[i] += 0.02;
            let rate = section_flow(blade, (&faster, i), &point(psi), (i, [0.01, 0.0]), [0.0; 3]);
            let air = section_flow(blade, (&motion, i), &point(psi), (i, [0.01, 0.02]), [0.0; 3]);
            assert_abs_diff_eq!(air.u_t, rate.u_t, epsilon = 1e-15);
            assert_abs_diff_eq!(air.input[0], rate.input[0], epsilon = 1e-15);
            assert!((air.u_t - at(psi).u_t - 0.02).abs() < 1e-12);
        }
    }
}
