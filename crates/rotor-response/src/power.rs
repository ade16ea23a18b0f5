//! Power of one blade over a revolution: what the air, the shaft, the pitch control and damping give.

use crate::blade::ResponseBlade;
use crate::motion::{Motion, RootPitch};
use crate::structure::BladeState;

/// Mean power of one blade over a revolution, `m0 Omega^3 R^3`; each is what is given to the blade.
///
/// ```text
/// sum( f . V + M (theta' + phi' + om . e) ) - sum( c q'^2 ) - Omega M_z - M_pitch theta' = 0
/// ```
/// `V` and `om` are velocity and angular velocity over ground of the section, `M_z` and `M_pitch` the
/// moments of the blade on shaft and pitch control. The motion repeats, so the mean is zero when loads,
/// equations of motion and root loads belong together.
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
    /// Sum over the shaft's power: zero but for the discretisation, and for terms that the couplings
    /// `Linear` and `Full` leave out of the equations.
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

/// Axial displacement and its rate at the stations, and the moment that inertia and elasticity put on the
/// pitch of the root, nose up.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct AxialMotion {
    pub(crate) value: Vec<f64>,
    pub(crate) rate: Vec<f64>,
    pub(crate) pitch_moment: f64,
}

impl AxialMotion {
    /// Of the inextensional blade of the couplings `Linear` and `Full`.
    ///
    /// ```text
    /// u = -int_0^x (v_x^2 + w_x^2) / 2
    /// M = int m km^2 th'' + m (km2^2 - km1^2) sin th cos th + (EI_z - EI_y) kz ky
    /// ```
    pub(crate) fn inextensional(blade: &ResponseBlade, motion: &Motion, pitch: RootPitch) -> Self {
        let (w, v, phi) = (&motion.w, &motion.v, &motion.phi);
        let n = blade.grid.len();
        let running = |f: &dyn Fn(usize) -> f64| -> Vec<f64> {
            let integrand: Vec<f64> = (0..n).map(f).collect();
            let mut out = vec![0.0; n];
            blade.grid.integral_from_root(&integrand, &mut out);
            out
        };
        let moment: Vec<f64> = (0..n)
            .map(|i| {
                let (sin, cos) = (pitch.angle + blade.twist[i] + phi.value[i]).sin_cos();
                let [km1, km2] = [blade.km1_squared[i], blade.km2_squared[i]];
                let kz = v.curvature[i] * cos + w.curvature[i] * sin;
                let ky = w.curvature[i] * cos - v.curvature[i] * sin;
                let turning = (km1 + km2) * (pitch.acceleration + phi.acceleration[i]);
                blade.mass[i] * (turning + (km2 - km1) * sin * cos)
                    + (blade.ei_lag[i] - blade.ei_flap[i]) * kz * ky
            })
            .collect();
        Self {
            value: running(&|i| -0.5 * (v.slope[i].powi(2) + w.slope[i].powi(2))),
            rate: running(&|i| -(v.slope[i] * v.slope_rate[i] + w.slope[i] * w.slope_rate[i])),
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
        let force = loads.force(blade, motion, i);
        let y = blade.offsets.torque + v.value[i];
        let velocity = [
            axial.rate[i] - across * y,
            v.rate[i] + across * (blade.grid.x()[i] + axial.value[i]) - along * w.value[i],
            w.rate[i] + along * y,
        ];
        let turning = pitch.rate + motion.phi.rate[i] + along + across * w.slope[i];
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
