//! Force and moment per length of the deflected blade, and hub loads in the fixed frame.

use crate::structure::blade::ResponseBlade;
use crate::structure::equations::{BladeState, SpanLoads};
use rotor_base::{HarmonicSeries, rotating_to_fixed, uniform_azimuths_rad};
use rotor_fem::ModalLoads;

/// Six load components over one revolution as harmonic series, order
/// `F_x, F_y, F_z, M_x, M_y, M_z`; forces in `m0 Omega^2 R^2`, moments in `m0 Omega^2 R^3`.
#[derive(Debug, Clone, PartialEq)]
pub struct SixLoads {
    /// The six series.
    pub components: [HarmonicSeries; 6],
}

impl SixLoads {
    /// Mean of each component.
    pub fn mean(&self) -> [f64; 6] {
        self.components.each_ref().map(|c| c.mean)
    }

    /// Cosine and sine coefficients of harmonic `n` of all components:
    /// `[Fx_c, Fx_s, Fy_c, Fy_s, Fz_c, ... Mz_s]`, twice the mean of `F cos n psi` and `F sin n psi`.
    pub fn harmonic(&self, n: usize) -> [f64; 12] {
        let mut out = [0.0; 12];
        for (pair, component) in out.chunks_exact_mut(2).zip(&self.components) {
            let h = component.harmonic(n);
            pair.copy_from_slice(&[h.cosine, h.sine]);
        }
        out
    }

    /// Component values at an azimuth.
    pub fn at(&self, azimuth_rad: f64) -> [f64; 6] {
        self.components.each_ref().map(|c| c.value(azimuth_rad))
    }
}

/// `series + factor other`.
pub(crate) fn added(
    series: &HarmonicSeries,
    other: &HarmonicSeries,
    factor: f64,
) -> HarmonicSeries {
    let mut out = series.clone();
    out.mean += factor * other.mean;
    for (k, part) in other.harmonics.iter().enumerate() {
        let mut harmonic = out.harmonic(k + 1);
        harmonic.cosine += factor * part.cosine;
        harmonic.sine += factor * part.sine;
        out.set_harmonic(k + 1, harmonic);
    }
    out
}

/// Force and moment about the rotor centre, per length, of all loads on one blade at one azimuth at every
/// station, coned blade axes.
///
/// ```text
/// f_x = m (c (c X - s w) + 2 c v' - u'') + F_x      F_x = -w_x F_z - v_x F_y (aerodynamic)
/// f_y = m (y - v'' - 2 c u' + 2 s w') + F_y      X = x + u,  y = y_t + v,  c = cos bp,  s = sin bp
/// f_z = -m (w'' + s (c X - s w) + 2 s v') + F_z
/// m_x = -m km^2 th'' - m (km2^2 - km1^2) sin th cos th + M,  m_z = m (km2^2 - km1^2) sin th cos th s / c
/// M_x = int y f_z - w f_y + m_x,  M_y = int w f_x - X f_z,  M_z = int X f_y - y f_x + m_z
/// ```
/// The inertial forces are those of a point in axes that turn about the shaft, exact in the precone. The hub
/// gets the forces; its moments are those of the equations of motion ([`crate::response::root_reaction`]), but with
/// `Linear`.
///
/// `M_y` and `M_z` also hold the moments on the slopes of flaps that weigh beside the blade.
/// The foreshortening `u` and its rates enter in second order whatever the couplings of the modal
/// equations: without them the vibratory in-plane loads are wrong by most of their size.
pub(crate) fn span_wrenches(
    blade: &ResponseBlade,
    state: BladeState<'_>,
    aerodynamic: &SpanLoads,
) -> Vec<[f64; 6]> {
    let BladeState { motion, pitch, loads } = state;
    let n = blade.grid.len();
    let (w, v) = (&motion.w, &motion.v);
    let running = |f: &dyn Fn(usize) -> f64| -> Vec<f64> {
        let integrand: Vec<f64> = (0..n).map(f).collect();
        let mut out = vec![0.0; n];
        blade.grid.integral_from_root(&integrand, &mut out);
        out
    };
    let squares = running(&|i| 0.5 * (v.slope[i].powi(2) + w.slope[i].powi(2)));
    let rates = running(&|i| v.slope[i] * v.slope_rate[i] + w.slope[i] * w.slope_rate[i]);
    let accelerations = running(&|i| {
        v.slope_rate[i].powi(2)
            + w.slope_rate[i].powi(2)
            + v.slope[i] * v.slope_acceleration[i]
            + w.slope[i] * w.slope_acceleration[i]
    });
    let (along, across) = blade.precone.sin_cos();
    let wrench = |i: usize| {
        let (m, x) = (blade.mass[i], blade.grid.x()[i]);
        let (u, u_rate, u_acceleration) = (-squares[i], -rates[i], -accelerations[i]);
        let y = blade.offsets.torque + v.value[i];
        // distance from the shaft of the coned blade
        let out = across * (x + u) - along * w.value[i];
        let [weight_x, weight_y, weight_z] = loads.gravity.map(|g| m * g);
        let aero_x = -w.slope[i] * aerodynamic.fz[i] - v.slope[i] * aerodynamic.fy[i];
        let fx = m * (across * (out + 2.0 * v.rate[i]) - u_acceleration)
            + aero_x
            + loads.axial[i]
            + weight_x;
        let turning = 2.0 * (along * w.rate[i] - across * u_rate);
        let fy = m * (y - v.acceleration[i] + turning) + loads.fy[i] + weight_y;
        let fz =
            -m * (w.acceleration[i] + along * (out + 2.0 * v.rate[i])) + loads.fz[i] + weight_z;
        let theta = pitch.angle_rad + blade.twist[i] + motion.phi.value[i];
        let theta_acceleration = pitch.acceleration + motion.phi.acceleration[i];
        let (sin, cos) = theta.sin_cos();
        let (km1, km2) = (blade.km1_squared[i], blade.km2_squared[i]);
        let propeller = m * (km2 - km1) * sin * cos;
        let mx = -m * (km1 + km2) * theta_acceleration - propeller
            + loads.moment[i]
            + across_the_axis(loads, [v.slope[i], w.slope[i]], i);
        [
            fx,
            fy,
            fz,
            y * fz - w.value[i] * fy + mx,
            w.value[i] * fx - (x + u) * fz - loads.slope[1][i],
            (x + u) * fy - y * fx + propeller * along / across + loads.slope[0][i],
        ]
    };
    (0..n).map(wrench).collect()
}

/// What the moments on the slopes have along the blade's own axis, taken out of the turning moment.
///
/// ```text
/// t . M = M_x + v_x M_y + w_x M_z,   M_y = -slope_w,   M_z = slope_v
/// ```
/// The turning moment of a flap beside the blade is `t . M`, about the deflected axis; the wrench holds `M_x`.
fn across_the_axis(loads: &SpanLoads, [v_x, w_x]: [f64; 2], i: usize) -> f64 {
    v_x * loads.slope[1][i] - w_x * loads.slope[0][i]
}

/// The same of the moderately deflected blade.
///
/// ```text
/// F = sum( f - m a ),   M = sum( r x f + (1, v_x, w_x) M - integral r x a dm )
/// ```
/// Loads stand on the deflected axis; inertial forces are those of the equations of motion, so that the
/// power of loads, shaft and pitch control agrees.
pub(crate) fn moderate_wrenches(
    blade: &ResponseBlade,
    state: BladeState<'_>,
    modal: &ModalLoads,
) -> Vec<[f64; 6]> {
    let BladeState { motion, loads, .. } = state;
    let (w, v) = (&motion.w, &motion.v);
    let wrench = |(i, inertial): (usize, &[f64; 6])| {
        let force = loads.force(blade, motion, i);
        let arm = [blade.grid.x()[i] + modal.axial[i], v.value[i], w.value[i]];
        let turn = loads.moment[i];
        let own = [
            turn + across_the_axis(loads, [v.slope[i], w.slope[i]], i),
            turn * v.slope[i] - loads.slope[1][i],
            turn * w.slope[i] + loads.slope[0][i],
        ];
        let mut out = [0.0; 6];
        for k in 0..3 {
            let (a, b) = ((k + 1) % 3, (k + 2) % 3);
            let moment = arm[a] * force[b] - arm[b] * force[a] + own[k];
            out[k] = force[k] - inertial[k];
            out[3 + k] = moment - inertial[3 + k];
        }
        out
    };
    modal.wrench.iter().enumerate().map(wrench).collect()
}

/// Sum of the loads at all stations with given weights of integration.
pub(crate) fn summed(weights: &[f64], wrenches: &[[f64; 6]]) -> [f64; 6] {
    let mut total = [0.0; 6];
    for (weight, wrench) in weights.iter().zip(wrenches) {
        for (t, part) in total.iter_mut().zip(wrench) {
            *t += weight * part;
        }
    }
    total
}

/// A vector of the coned blade axes in the rotating shaft axes: x outboard in the plane of the hub, z
/// along the shaft. Without it the centrifugal force of a coned blade would pull the hub down.
///
/// ```text
/// X = x cos bp - z sin bp,   Y = y,   Z = x sin bp + z cos bp
/// ```
pub(crate) fn coned_to_shaft(precone_rad: f64, [x, y, z]: [f64; 3]) -> [f64; 3] {
    let (sin, cos) = precone_rad.sin_cos();
    [x * cos - z * sin, y, x * sin + z * cos]
}

/// Hub loads in the fixed frame from the root loads of every blade, summed blade by blade.
///
/// Blade `k` of `N_b` is at azimuth `psi + 2 pi k / N_b`; its root loads are given as functions of its
/// own azimuth. Harmonics 0..=`count` of the sum are returned.
///
/// Source: summation over blades, Johnson, Helicopter Theory (1980), section 8-2; no use is made of
/// the blades being alike.
pub fn hub_loads(blades: &[SixLoads], count: usize) -> SixLoads {
    let highest = blades
        .iter()
        .flat_map(|b| b.components.iter().map(|c| c.harmonics.len()))
        .max()
        .unwrap_or(0);
    // highest harmonic of the sum is one more than that of the root loads
    let samples = (highest + count + 2).next_multiple_of(blades.len().max(1));
    let azimuths = uniform_azimuths_rad(samples);
    let weights = vec![1.0 / samples as f64; samples];
    let mut history: [Vec<f64>; 6] = std::array::from_fn(|_| vec![0.0; samples]);
    for (k, blade) in blades.iter().enumerate() {
        let offset = std::f64::consts::TAU * k as f64 / blades.len() as f64;
        for (i, azimuth) in azimuths.iter().enumerate() {
            let psi = azimuth + offset;
            let [fx, fy, fz, mx, my, mz] = blade.at(psi);
            let force = rotating_to_fixed(psi, [fx, fy, fz]);
            let moment = rotating_to_fixed(psi, [mx, my, mz]);
            for (h, part) in history.iter_mut().zip(force.into_iter().chain(moment)) {
                h[i] += part;
            }
        }
    }
    let series = |h: &Vec<f64>| HarmonicSeries::project(&azimuths, &weights, h, count);
    SixLoads { components: history.each_ref().map(series) }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;
    use rotor_base::Harmonic;

    fn blade() -> SixLoads {
        let mut components = [(); 6].map(|()| HarmonicSeries::zero(5));
        for (k, c) in components.iter_mut().enumerate() {
            for n in 1..=5 {
                let (a, b) = ((k + 2 * n) as f64, (3 * k) as f64 - n as f64);
                c.set_harmonic(n, Harmonic { cosine: a.sin(), sine: b.cos() });
            }
        }
        SixLoads { components }
    }

    /// The closed sums for four blades: `F_X,4c = 2 (a3 + a5 + d3 - d5)` and so on.
    #[test]
    fn four_blades_pass_the_third_fourth_and_fifth_harmonic() {
        let b = blade();
        let hub = hub_loads(&[b.clone(), b.clone(), b.clone(), b.clone()], 8);
        let h = |k: usize, n: usize| b.components[k].harmonic(n);
        let (x3, x5, y3, y5) = (h(0, 3), h(0, 5), h(1, 3), h(1, 5));
        let z = hub.harmonic(4);
        let eps = 1e-13;
        assert_abs_diff_eq!(z[0], 2.0 * (x3.cosine + x5.cosine + y3.sine - y5.sine), epsilon = eps);
        assert_abs_diff_eq!(z[1], 2.0 * (x3.sine + x5.sine - y3.cosine + y5.cosine), epsilon = eps);
        assert_abs_diff_eq!(
            z[2],
            2.0 * (-x3.sine + x5.sine + y3.cosine + y5.cosine),
            epsilon = eps
        );
        assert_abs_diff_eq!(z[3], 2.0 * (x3.cosine - x5.cosine + y3.sine + y5.sine), epsilon = eps);
        assert_abs_diff_eq!(z[4], 4.0 * h(2, 4).cosine, epsilon = eps);
        assert_abs_diff_eq!(z[5], 4.0 * h(2, 4).sine, epsilon = eps);
    }

    #[test]
    fn unequal_blades_leak_into_every_harmonic() {
        let (b, mut other) = (blade(), blade());
        for c in &mut other.components {
            c.harmonics[0].cosine *= 1.01;
        }
        let equal = hub_loads(&[b.clone(), b.clone(), b.clone(), b.clone()], 8);
        let unequal = hub_loads(&[b.clone(), b.clone(), b, other], 8);
        for n in [1, 2, 3, 5, 6, 7] {
            assert!(equal.harmonic(n).iter().all(|v| v.abs() < 1e-13));
        }
        assert!(unequal.harmonic(1).iter().any(|v| v.abs() > 1e-3));
    }
}
