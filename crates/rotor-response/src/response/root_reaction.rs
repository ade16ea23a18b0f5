//! What one blade puts on the hub at one azimuth: the reactions of its equations of motion.
//!
//! ```text
//! F    = sum( f - m a )                                        the root does not move
//! flap = int (x - e) f_z + m_w,   lag = int (x - e) f_y + m_v,   torsion = int m_phi      (R.33) at the root
//! M_x  = torsion + v_x flap - w_x lag + y_t F_z,   M_y = -(flap + e F_z),   M_z = lag + e F_y - y_t N
//! ```
//! A joint that is free carries the moment that the equation of its rotation leaves there, none, and a spring
//! its stiffness times its angle. The statics of the deflected blade ([`wrenches`](Loading::wrenches)) would
//! leave at a free hinge what the equations leave out, the lever that deflection gives the loads: tens of newton metres.
//!
//! The moment about the shaft is the reaction at the azimuth, which holds the rotor speed: with it the power
//! of the shaft is what air and damping leave; flow and lever of a section are the same vector, so that in hover it is
//! inflow times thrust and profile drag. `N` holds the axial force of the air. With `Full` that is `M_z` of the lag moment, above; with
//! `Moderate`, whose section turns as a whole about the shaft, that of the statics, off the lag moment by
//! terms of third order.
//!
//! `Linear` keeps no terms of second order in its equations but its hub loads need them: they are the statics
//! of the deflected blade, moments too.

use crate::Couplings;
use crate::loads::power::AxialMotion;
use crate::loads::section_moments::{Turning, moderate_turning, moments_outboard, turning};
use crate::loads::wrenches::{coned_to_shaft, moderate_wrenches, span_wrenches, summed};
use crate::response::system::ResponseSystem;
use crate::sections::air::SectionLoads;
use crate::structure::blade::ResponseBlade;
use crate::structure::equations::{BladeState, SpanLoads};
use crate::structure::motion::Motion;
use rotor_fem::ModalMotion;

/// Loads on the whole span at one azimuth.
pub(crate) struct Loading {
    /// Force and moment about the rotor centre of the deflected blade, per length, coned blade axes.
    pub(crate) wrenches: Vec<[f64; 6]>,
    /// What turns the blade outboard of a station in the equations of motion.
    pub(crate) turning: Vec<Turning>,
    /// Radial derivative of the axial displacement.
    pub(crate) shortening: Vec<f64>,
    /// What the loads work on.
    pub(crate) axial: AxialMotion,
}

impl Loading {
    /// At point `p` of the revolution, of its motion and the air loads at the lifting stations; `loads` is filled with what acts there.
    pub(crate) fn new(
        system: &ResponseSystem<'_>,
        (motion, sections): (&Motion, &[SectionLoads]),
        p: usize,
        loads: &mut SpanLoads,
        [q, qd, qdd]: [&[f64]; 3],
    ) -> Self {
        let (blade, couplings) = (system.blade, system.couplings);
        system.span_loads(p, motion, sections, loads);
        let pitch = system.points[p].air.pitch;
        let state = BladeState { motion, pitch, loads };
        if let Some(modal) = &blade.modal {
            let coordinates = ModalMotion { value: q, rate: qd, acceleration: qdd };
            let found = modal.loads(coordinates, pitch);
            return Self {
                wrenches: moderate_wrenches(blade, state, &found),
                turning: moderate_turning(blade, modal, state, q, &found),
                shortening: found.axial_slope.clone(),
                axial: AxialMotion::condensed(blade, state, found),
            };
        }
        let first = system.air.first_station;
        let aerodynamic = aerodynamic_loads(blade.grid.len(), first, sections);
        let slopes = motion.v.slope.iter().zip(&motion.w.slope);
        Self {
            wrenches: span_wrenches(blade, state, &aerodynamic),
            turning: turning(blade, couplings, state),
            shortening: slopes.map(|(v, w)| -0.5 * (v * v + w * w)).collect(),
            axial: AxialMotion::inextensional(blade, couplings, state, &aerodynamic),
        }
    }

    /// Force and moment of the blade on the hub about the rotor centre: rotating shaft axes.
    pub(crate) fn on_hub(
        &self,
        blade: &ResponseBlade,
        couplings: Couplings,
        state: BladeState<'_>,
        q: &[f64],
    ) -> [f64; 6] {
        let weights = blade.grid.weight();
        let statics = summed(weights, &self.wrenches);
        let [fx, fy, fz, sx, sy, sz] = statics;
        let turned = |v| coned_to_shaft(blade.precone, v);
        let force = turned([fx, fy, fz]);
        let whole = turned([sx, sy, sz]);
        let moment = if couplings == Couplings::Linear {
            whole
        } else {
            let (root, y_t) = (blade.root_offset, blade.offsets.torque);
            let [flap, lag, torsion] =
                moments_outboard(root, weights, blade.grid.x(), &self.turning);
            let [v_x, w_x, _] = blade.joint_angles_rad(q);
            let lagging = lag + root * fy
                - y_t * (coriolis_tension(blade, state) + blade.grid.integral(&self.axial.force));
            let twisting = torsion + v_x * flap - w_x * lag + y_t * fz;
            let [mx, my, _] = turned([twisting, -(flap + root * fz), lagging]);
            let (along, across) = blade.precone.sin_cos();
            let about_shaft = match couplings {
                Couplings::Moderate(_) => whole[2],
                _ => across * lagging + along * about_the_blade(blade, state),
            };
            [mx, my, about_shaft]
        };
        [force[0], force[1], force[2], moment[0], moment[1], moment[2]]
    }
}

/// Tension at the root with the terms of the equations of `Full`: `c int m (c x + 2 v')`.
fn coriolis_tension(blade: &ResponseBlade, state: BladeState<'_>) -> f64 {
    let across = blade.precone.cos();
    let rates = &state.motion.v.rate;
    let density = |i: usize| across * blade.mass[i] * (across * blade.grid.x()[i] + 2.0 * rates[i]);
    let density: Vec<f64> = (0..blade.grid.len()).map(density).collect();
    blade.grid.integral(&density)
}

/// Moment about the axis of the blade at rest of what acts on it and, of a coned blade, of its centrifugal
/// force `-s c m x` up, which is ahead of that axis: what it has of the torque about the shaft.
fn about_the_blade(blade: &ResponseBlade, state: BladeState<'_>) -> f64 {
    let BladeState { motion, loads, .. } = state;
    let (along, across) = blade.precone.sin_cos();
    let density = |i: usize| {
        let [_, fy, fz] = loads.force(blade, motion, i);
        let y = blade.offsets.torque + motion.v.value[i];
        let up = fz - blade.mass[i] * along * across * blade.grid.x()[i];
        y * up - motion.w.value[i] * fy + loads.moment[i]
    };
    let density: Vec<f64> = (0..blade.grid.len()).map(density).collect();
    blade.grid.integral(&density)
}

/// Aerodynamic forces alone at all stations.
fn aerodynamic_loads(stations: usize, first: usize, sections: &[SectionLoads]) -> SpanLoads {
    let mut out = SpanLoads::default();
    out.clear(stations);
    for (s, load) in sections.iter().enumerate() {
        out.fz[first + s] = load.fz;
        out.fy[first + s] = load.fy;
        out.moment[first + s] = load.moment;
    }
    out
}
