//! Moments in the sections of one blade at one azimuth: by force summation with the terms of the equations of
//! motion, and by curvature.

use crate::Couplings;
use crate::structure::blade::ResponseBlade;
use crate::structure::equations::BladeState;
use crate::structure::load_station::LoadStation;
use rotor_fem::{ModalBlade, ModalLoads};

/// What turns the part of the blade outboard of a station, per length.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Turning {
    /// Forces up and forward.
    force: [f64; 2],
    /// Moments of flap, lag and torsion.
    pub(crate) moment: [f64; 3],
}

/// Moments of flap, lag and torsion at a station: tip up, tip forward, nose up.
///
/// ```text
/// M_w(s) = int_s^1 (x - s) f_z + m_w dx      M_v(s) = int_s^1 (x - s) f_y + m_v dx      M_phi(s) = int_s^1 m_phi dx
/// ```
/// Each is the equation of motion with the part outboard turned as a whole for the mode shape. `outboard` are
/// the weights of integrals from the station to the tip over the `points` of the span.
pub(crate) fn moments_outboard(
    station: f64,
    outboard: &[f64],
    points: &[f64],
    turning: &[Turning],
) -> [f64; 3] {
    let mut total = [0.0; 3];
    for ((of, weight), x) in turning.iter().zip(outboard).zip(points) {
        let arm = x - station;
        let [up, forward] = of.force;
        for (sum, part) in total.iter_mut().zip([arm * up, arm * forward, 0.0]) {
            *sum += weight * part;
        }
        for (sum, part) in total.iter_mut().zip(of.moment) {
            *sum += weight * part;
        }
    }
    total
}

/// With the terms of the couplings `Linear` and `Full`.
///
/// ```text
/// m_w = -N w_x      m_v = -N v_x      N = T + c int_x^1 2 m v'
/// m_phi = M - m km^2 th'' - m (km2^2 - km1^2) sin th cos th - (EI_z - EI_y) kz ky
/// ```
pub(crate) fn turning(
    blade: &ResponseBlade,
    couplings: Couplings,
    state: BladeState<'_>,
) -> Vec<Turning> {
    let BladeState { motion, pitch, loads } = state;
    let n = blade.grid.len();
    let (w, v, phi) = (&motion.w, &motion.v, &motion.phi);
    let full = couplings != Couplings::Linear;
    let (along, across) = blade.precone.sin_cos();
    let mut tension = vec![0.0; n];
    let mut shortening = vec![0.0; n];
    if full {
        let coriolis: Vec<f64> = (0..n).map(|i| 2.0 * across * blade.mass[i] * v.rate[i]).collect();
        blade.grid.integral_to_tip(&coriolis, &mut tension);
        let rates: Vec<f64> =
            (0..n).map(|i| v.slope[i] * v.slope_rate[i] + w.slope[i] * w.slope_rate[i]).collect();
        blade.grid.integral_from_root(&rates, &mut shortening);
    }
    let of = |i: usize| {
        let (m, x) = (blade.mass[i], blade.grid.x()[i]);
        let [_, weight_y, weight_z] = loads.gravity.map(|g| m * g);
        let pull = blade.tension[i] + tension[i];
        let up = -m
            * (w.acceleration[i] + along * (across * x + 2.0 * v.rate[i] - along * w.value[i]))
            + loads.fz[i]
            + weight_z;
        let forward = m
            * (blade.offsets.torque + v.value[i] - v.acceleration[i]
                + 2.0 * (across * shortening[i] + along * w.rate[i]))
            + loads.fy[i]
            + weight_y;
        let theta = pitch.angle_rad + blade.twist[i] + phi.value[i];
        let radii = blade.km2_squared[i] - blade.km1_squared[i];
        let (sin, cos) = theta.sin_cos();
        let twisting = if full {
            let kz = v.curvature[i] * cos + w.curvature[i] * sin;
            let ky = w.curvature[i] * cos - v.curvature[i] * sin;
            m * radii * sin * cos + (blade.ei_lag[i] - blade.ei_flap[i]) * kz * ky
        } else {
            m * radii * theta
        };
        let polar = m * (blade.km1_squared[i] + blade.km2_squared[i]);
        let spinning = polar * (pitch.acceleration + phi.acceleration[i]);
        Turning {
            force: [up, forward],
            moment: [
                loads.slope[1][i] - pull * w.slope[i],
                loads.slope[0][i] - pull * v.slope[i],
                loads.moment[i] - spinning - twisting,
            ],
        }
    };
    (0..n).map(of).collect()
}

/// With the terms of the moderately deflected blade.
///
/// ```text
/// m_c = applied - inertial - elastic force on c = w_x, v_x, phi,   N = int_x^1 f_x - m a_x
/// ```
pub(crate) fn moderate_turning(
    blade: &ResponseBlade,
    modal: &ModalBlade,
    state: BladeState<'_>,
    q: &[f64],
    found: &ModalLoads,
) -> Vec<Turning> {
    let BladeState { motion, pitch, loads } = state;
    let n = blade.grid.len();
    let force: Vec<[f64; 3]> = (0..n).map(|i| loads.force(blade, motion, i)).collect();
    let axial: Vec<f64> = force.iter().zip(&found.inertial).map(|(f, m)| f[0] - m[0]).collect();
    let mut tension = vec![0.0; n];
    blade.grid.integral_to_tip(&axial, &mut tension);
    let elastic = modal.turning_forces(q, pitch, &tension);
    let of = |i: usize| {
        let ([_, fy, fz], [v_x, w_x, phi]) = (force[i], elastic[i]);
        let [_, v, w, v_x_inertial, w_x_inertial, phi_inertial] = found.inertial[i];
        Turning {
            force: [fz - w, fy - v],
            moment: [
                loads.slope[1][i] - w_x_inertial - w_x,
                loads.slope[0][i] - v_x_inertial - v_x,
                loads.moment[i] - phi_inertial - phi,
            ],
        }
    };
    (0..n).map(of).collect()
}

/// Moments of flap, lag and torsion at a station from curvature and rate of twist: tip up, tip forward, nose
/// up.
///
/// ```text
/// M_w = EI_z kz sin th + EI_y ky cos th      M_v = EI_z kz cos th - EI_y ky sin th      M_phi = (GJ + kA^2 T) phi_x
/// ```
/// `tension` is that of the force summation there; of it only the moderately deflected blade
/// ([`ModerateBlade::section_moments`](rotor_fem::ModerateBlade::section_moments)) takes more than the steady
/// part.
pub(crate) fn curvature_moments(
    blade: &ResponseBlade,
    couplings: Couplings,
    station: &LoadStation,
    q: &[f64],
    pitch_rad: f64,
    tension: f64,
) -> [f64; 3] {
    let shape = station.shape(blade, q);
    if let Some(moderate) = &blade.moderate {
        return moderate.section_moments(station.x, pitch_rad, &shape, tension);
    }
    let [ei_flap, ei_lag] = station.stiffness;
    let (w_xx, v_xx) = (shape.flap[2], shape.lag[2]);
    let twisting = station.torsion_stiffness * shape.twist[1];
    if couplings == Couplings::Linear {
        return [ei_flap * w_xx, ei_lag * v_xx, twisting];
    }
    let (sin, cos) = (pitch_rad + station.twist + shape.twist[0]).sin_cos();
    let (kz, ky) = (v_xx * cos + w_xx * sin, w_xx * cos - v_xx * sin);
    let [lagging, flapping] = [ei_lag * kz, ei_flap * ky];
    [lagging * sin + flapping * cos, lagging * cos - flapping * sin, twisting]
}
