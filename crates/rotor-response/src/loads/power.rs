//! Power of one blade over a revolution: what the air, the shaft, the pitch control and damping give.

use crate::Couplings;
use crate::structure::blade::ResponseBlade;
use crate::structure::equations::{BladeState, SpanLoads};
use rotor_fem::ModalLoads;

/// Mean power of one blade over a revolution, `m0 Omega^3 R^3`; each is what is given to the blade.
///
/// ```text
/// sum( f . V + M om_M ) - sum( c q'^2 ) - Omega M_z - M_pitch theta' = 0
/// ```
/// `V` is the velocity of the section over ground, `om_M` its angular velocity about the axis of the
/// twisting couple `M`, `M_z` and `M_pitch` are the moments of the blade on shaft and pitch control. The
/// motion repeats, so the mean is zero when loads, equations of motion and root loads belong together.
///
/// With the couplings `Moderate` the couple stands along the deflected blade, `om_M = theta' + phi' + Omega w_x`,
/// and the axial force works on the foreshortening. With `Linear` and `Full` it stands along the straight
/// blade, `om_M = theta' + phi'`, in root loads as in the power, and the axial force works on no
/// foreshortening, in the equations as in the power. With `Full`, whose torque is that of its equations of
/// motion, neither foreshortening nor lag carry the section round, `V = (-y_t, v' + x, w')`.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PowerBalance {
    /// From the air (and from the flaps, where they move), negative in powered flight.
    pub aerodynamic: f64,
    /// From structural damping, never positive.
    pub damping: f64,
    /// From the shaft: the negative of the torque on the hub times the rotor speed.
    pub shaft: f64,
    /// From the pitch control.
    pub pitch: f64,
}

impl PowerBalance {
    /// Sum over the shaft's power: zero but for the discretisation.
    pub fn imbalance(&self) -> f64 {
        (self.aerodynamic + self.damping + self.shaft + self.pitch) / self.shaft.abs()
    }

    pub(crate) fn add(&mut self, weight: f64, part: &Self) {
        self.aerodynamic += weight * part.aerodynamic;
        self.damping += weight * part.damping;
        self.shaft += weight * part.shaft;
        self.pitch += weight * part.pitch;
    }
}

/// What the loads of one blade work on besides its deflections at one azimuth, station by station.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct AxialMotion {
    /// Axial displacement, which carries the section round.
    pub(crate) value: Vec<f64>,
    /// Its rate, as far as the equations let the axial force work on it.
    pub(crate) rate: Vec<f64>,
    /// Distance ahead of the shaft, as far as the force along the blade has it for a lever.
    pub(crate) lever: Vec<f64>,
    /// Force along the blade, weight included.
    pub(crate) force: Vec<f64>,
    /// Slope `w_x` of the axis about which the section is twisted.
    pub(crate) tilt: Vec<f64>,
    /// Moment that inertia and elasticity put on the pitch of the root, nose up.
    pub(crate) pitch_moment: f64,
}

impl AxialMotion {
    /// Of the moderately deflected blade.
    pub(crate) fn condensed(blade: &ResponseBlade, state: BladeState<'_>, of: ModalLoads) -> Self {
        let BladeState { motion, loads, .. } = state;
        Self {
            force: (0..blade.grid.len()).map(|i| loads.force(blade, motion, i)[0]).collect(),
            lever: motion.v.value.iter().map(|v| blade.offsets.torque + v).collect(),
            tilt: motion.w.slope.clone(),
            value: of.axial,
            rate: of.axial_rate,
            pitch_moment: of.pitch_moment,
        }
    }

    /// Of the inextensional blade of the couplings `Linear` and `Full`; `aerodynamic` loads alone are
    /// tilted with the blade.
    ///
    /// ```text
    /// u = -int_0^x (v_x^2 + w_x^2) / 2 for Linear, none for Full
    /// M = int m km^2 th'' + m (km2^2 - km1^2) sin th cos th + (EI_z - EI_y) kz ky      Full
    /// M = int m km^2 th'' + m (km2^2 - km1^2) th                                       Linear
    /// ```
    pub(crate) fn inextensional(
        blade: &ResponseBlade,
        couplings: Couplings,
        state: BladeState<'_>,
        aerodynamic: &SpanLoads,
    ) -> Self {
        let BladeState { motion, pitch, loads } = state;
        let (w, v, phi) = (&motion.w, &motion.v, &motion.phi);
        let n = blade.grid.len();
        let squares: Vec<f64> =
            (0..n).map(|i| -0.5 * (v.slope[i].powi(2) + w.slope[i].powi(2))).collect();
        let mut value = vec![0.0; n];
        blade.grid.integral_from_root(&squares, &mut value);
        let moment: Vec<f64> = (0..n)
            .map(|i| {
                let theta = pitch.angle_rad + blade.twist[i] + phi.value[i];
                let [km1, km2] = [blade.km1_squared[i], blade.km2_squared[i]];
                let turning = (km1 + km2) * (pitch.acceleration + phi.acceleration[i]);
                if couplings == Couplings::Linear {
                    return blade.mass[i] * (turning + (km2 - km1) * theta);
                }
                let (sin, cos) = theta.sin_cos();
                let kz = v.curvature[i] * cos + w.curvature[i] * sin;
                let ky = w.curvature[i] * cos - v.curvature[i] * sin;
                blade.mass[i] * (turning + (km2 - km1) * sin * cos)
                    + (blade.ei_lag[i] - blade.ei_flap[i]) * kz * ky
            })
            .collect();
        let weight = loads.gravity[0];
        let force = |i: usize| aerodynamic.fx(motion, i) + loads.axial[i] + blade.mass[i] * weight;
        let y_t = blade.offsets.torque;
        let (lever, value) = if couplings == Couplings::Linear {
            (v.value.iter().map(|v| y_t + v).collect(), value)
        } else {
            (vec![y_t; n], vec![0.0; n])
        };
        Self {
            force: (0..n).map(force).collect(),
            lever,
            value,
            rate: vec![0.0; n],
            tilt: vec![0.0; n],
            pitch_moment: blade.grid.integral(&moment),
        }
    }
}

/// Power given to one blade at one azimuth; `torque` is its moment on the shaft.
pub(crate) fn power(
    blade: &ResponseBlade,
    state: BladeState<'_>,
    axial: &AxialMotion,
    damping: f64,
    torque: f64,
) -> PowerBalance {
    let BladeState { motion, pitch, loads } = state;
    let (w, v) = (&motion.w, &motion.v);
    let (along, across) = blade.precone.sin_cos();
    let (mut air, mut twisting) = (0.0, 0.0);
    for i in 0..blade.grid.len() {
        let weight = blade.grid.weight()[i];
        let [_, fy, fz] = loads.force(blade, motion, i);
        let force = [axial.force[i], fy, fz];
        let y = blade.offsets.torque + v.value[i];
        let velocity = [
            axial.rate[i] - across * axial.lever[i],
            v.rate[i] + across * (blade.grid.x()[i] + axial.value[i]) - along * w.value[i],
            w.rate[i] + along * y,
        ];
        let turning = pitch.rate + motion.phi.rate[i] + along + across * axial.tilt[i];
        // a slope v_x turns about z, a slope w_x about -y
        let slopes =
            loads.slope[0][i] * (v.slope_rate[i] + across) + loads.slope[1][i] * w.slope_rate[i];
        let forces: f64 = force.iter().zip(velocity).map(|(f, v)| f * v).sum();
        air += weight * (forces + loads.moment[i] * turning + slopes);
        twisting += weight * loads.moment[i];
    }
    PowerBalance {
        aerodynamic: air,
        damping: -damping,
        shaft: -torque,
        pitch: (axial.pitch_moment - twisting) * pitch.rate,
    }
}
