//! Virtual work of a blade at one azimuth, and the loads at its root.
//!
//! ```text
//! flap     int (w_dd + b_p (x + 2 v_d) - F_z) F + N w' F' + M_w F''                                  M_w = EI_z k_z sin th + EI_y k_y cos th
//! lag      int (v_dd - v + 2 u_d - 2 b_p w_d - F_y) L + N v' L' + M_v L''                            M_v = EI_z k_z cos th - EI_y k_y sin th
//! torsion  int (k_m^2 th_dd + (k_2^2 - k_1^2) sin th cos th + (EI_z - EI_y) k_z k_y - M) P + (GJ + k_A^2 (1 - x^2)/2) p' P'
//! k_z = v'' cos th + w'' sin th,  k_y = w'' cos th - v'' sin th,  N = (1 - x^2)/2 + int_x^1 2 v_d
//! third order:  N += int_x^1 u - u_dd - w' F_z - v' F_y
//! ```
//! Source: Hodges and Dowell, NASA TN D-7818 (1974), in the form of second order for a uniform, inextensional blade.

use super::airload::Loads;
use super::blade::{Blade, Couplings};
use super::hub::Root;
use super::kinematics::Snapshot;
use super::modes::{Mode, Modes};
use super::span::Span;

/// What acts on a station at an azimuth.
#[derive(Debug, Clone, Copy, Default)]
pub struct Acting {
    /// Pitch with its rate and acceleration.
    pub theta: [f64; 3],
    /// Airloads.
    pub air: Loads,
    /// Inertia force and moment of a moving flap, up and nose up.
    pub flap: [f64; 2],
}

/// Integrands that a family of modes is weighted with: of its shape, slope and curvature.
#[derive(Debug, Clone, Default)]
struct Work {
    shape: Vec<f64>,
    slope: Vec<f64>,
    curvature: Vec<f64>,
}

impl Work {
    fn zeros(stations: usize) -> Self {
        let zeros = || vec![0.0; stations];
        Self { shape: zeros(), slope: zeros(), curvature: zeros() }
    }

    fn of(&self, mode: &Mode, weight: &[f64]) -> f64 {
        (0..weight.len())
            .map(|p| {
                weight[p]
                    * (self.shape[p] * mode.shape[p]
                        + self.slope[p] * mode.slope[p]
                        + self.curvature[p] * mode.curvature[p])
            })
            .sum()
    }
}

/// Inertia of a mass centre ahead of the elastic axis: what it adds to first order in the offset, second moments being those
/// about the elastic axis.
///
/// A point `eta` ahead lies at `r + eta d`, `d = (-(v' cos th + w' sin th), cos th, sin th)`. Its virtual work is `-a . delta`.
#[derive(Debug, Clone, Copy)]
struct Offset {
    /// Force on the axis by the acceleration of `d`.
    force: [f64; 3],
    /// Moment about the axis by the acceleration of the axis.
    moment: [f64; 3],
    /// Work on `w'`, `v'` and on the twist.
    on_w_slope: f64,
    on_v_slope: f64,
    on_twist: f64,
}

impl Offset {
    fn new(e: f64, p: usize, x: f64, theta: [f64; 3], s: &Snapshot) -> Self {
        let (w, v) = (&s.w, &s.v);
        let (sin, cos) = theta[0].sin_cos();
        let (rate, square, turn) = (theta[1], theta[1] * theta[1], theta[2]);
        let axis = [
            x + s.u[0][p] + 2.0 * v.rate[p] - s.u[2][p],
            v.value[p] - v.acceleration[p] - 2.0 * s.u[1][p],
            -w.acceleration[p],
        ];
        let d = [-(v.slope[p] * cos + w.slope[p] * sin), cos, sin];
        let along = -(v.slope_rate[p] * cos - v.slope[p] * sin * rate
            + w.slope_rate[p] * sin
            + w.slope[p] * cos * rate);
        let along_dd = -(v.slope_acceleration[p] * cos
            - 2.0 * v.slope_rate[p] * sin * rate
            - v.slope[p] * (cos * square + sin * turn)
            + w.slope_acceleration[p] * sin
            + 2.0 * w.slope_rate[p] * cos * rate
            + w.slope[p] * (cos * turn - sin * square));
        let force = [
            e * (d[0] - along_dd - 2.0 * sin * rate),
            e * (d[1] + cos * square + sin * turn - 2.0 * along),
            e * (sin * square - cos * turn),
        ];
        let moment = [
            e * (d[1] * axis[2] - d[2] * axis[1]),
            e * (d[2] * axis[0] - d[0] * axis[2]),
            e * (d[0] * axis[1] - d[1] * axis[0]),
        ];
        let turned = v.slope[p] * sin - w.slope[p] * cos;
        Self {
            force,
            moment,
            on_w_slope: e * axis[0] * sin,
            on_v_slope: e * axis[0] * cos,
            on_twist: -e * (axis[0] * turned - sin * axis[1] + cos * axis[2]),
        }
    }
}

/// Residuals of the modes and loads at the root at one azimuth; `q` are the modal coordinates with two derivatives.
pub fn equations(
    blade: &Blade,
    span: &Span,
    modes: &Modes,
    q: &[[f64; 3]],
    s: &Snapshot,
    acting: &[Acting],
) -> (Vec<f64>, Root) {
    let n = span.len();
    let offsets: Vec<Offset> = if blade.mass_centre == 0.0 {
        Vec::new()
    } else {
        let one = |p: usize| Offset::new(blade.mass_centre, p, span.x[p], acting[p].theta, s);
        (0..n).map(one).collect()
    };
    let tension = tension(blade, span, s, acting, &offsets);
    let mut work = [Work::zeros(n), Work::zeros(n), Work::zeros(n)];
    for p in 0..n {
        station(blade, (p, span.x[p]), (s, tension[p]), &acting[p], &mut work);
        if let Some(own) = offsets.get(p) {
            work[0].shape[p] -= own.force[2];
            work[0].slope[p] += own.on_w_slope;
            work[1].shape[p] -= own.force[1];
            work[1].slope[p] += own.on_v_slope;
            work[2].shape[p] += own.on_twist;
        }
    }
    let families = [&modes.flap, &modes.lag, &modes.torsion];
    let mut residual = Vec::with_capacity(q.len());
    for (family, work) in families.iter().zip(&work) {
        residual.extend(family.iter().map(|mode| work.of(mode, &span.weight)));
    }
    add_at_root(blade, modes, q, &mut residual);
    (residual, root(blade, span, s, acting, &offsets))
}

/// Tension by station.
fn tension(
    blade: &Blade,
    span: &Span,
    s: &Snapshot,
    acting: &[Acting],
    offsets: &[Offset],
) -> Vec<f64> {
    let mut out = vec![0.0; span.len()];
    if blade.couplings != Couplings::Linear {
        let along = |p: usize| {
            let offset = offsets.get(p).map_or(0.0, |own| own.force[0]);
            if blade.couplings == Couplings::Third {
                let air = &acting[p].air;
                let drawn = -s.w.slope[p] * air.f_z - s.v.slope[p] * air.f_y;
                offset + s.u[0][p] - s.u[2][p] + drawn
            } else {
                offset
            }
        };
        let f: Vec<f64> = (0..span.len()).map(|p| 2.0 * s.v.rate[p] + along(p)).collect();
        span.to_tip(&f, &mut out);
    }
    for (own, x) in out.iter_mut().zip(&span.x) {
        *own += 0.5 * (1.0 - x * x);
    }
    out
}

/// The integrands of a station.
fn station(
    blade: &Blade,
    (p, x): (usize, f64),
    (s, tension): (&Snapshot, f64),
    acting: &Acting,
    [flap, lag, torsion]: &mut [Work; 3],
) {
    let (w, v) = (&s.w, &s.v);
    let [km1, km2, ka] = blade.gyration.map(|own| own * own);
    let (sin, cos) = acting.theta[0].sin_cos();
    let (bend_w, bend_v) = (w.curvature[p], v.curvature[p]);
    let cone = blade.precone_rad;
    let (m_w, m_v, coriolis, propeller, coupled) = match blade.couplings {
        Couplings::Linear => {
            let theta = acting.theta[0];
            (blade.ei_flap * bend_w, blade.ei_lag * bend_v, 0.0, theta, 0.0)
        }
        Couplings::Full | Couplings::Third => {
            let k_z = bend_v * cos + bend_w * sin;
            let k_y = bend_w * cos - bend_v * sin;
            (
                blade.ei_lag * k_z * sin + blade.ei_flap * k_y * cos,
                blade.ei_lag * k_z * cos - blade.ei_flap * k_y * sin,
                2.0 * s.u[1][p],
                sin * cos,
                (blade.ei_lag - blade.ei_flap) * k_z * k_y,
            )
        }
    };
    let [inertia_z, inertia_m] = acting.flap;
    flap.shape[p] = w.acceleration[p] + cone * (x + 2.0 * v.rate[p]) - acting.air.f_z - inertia_z;
    flap.slope[p] = tension * w.slope[p];
    flap.curvature[p] = m_w;
    lag.shape[p] =
        v.acceleration[p] - v.value[p] + coriolis - 2.0 * cone * w.rate[p] - acting.air.f_y;
    lag.slope[p] = tension * v.slope[p];
    lag.curvature[p] = m_v;
    torsion.shape[p] = (km1 + km2) * acting.theta[2] + (km2 - km1) * propeller + coupled
        - acting.air.moment
        - inertia_m;
    torsion.slope[p] = (blade.gj + 0.5 * ka * (1.0 - x * x)) * s.phi.slope[p];
}

/// Structural damping, the spring of the root and the damper.
fn add_at_root(blade: &Blade, modes: &Modes, q: &[[f64; 3]], residual: &mut [f64]) {
    let all = modes.flap.iter().chain(&modes.lag).chain(&modes.torsion);
    for ((own, mode), q) in residual.iter_mut().zip(all).zip(q) {
        *own += 2.0 * blade.damping * mode.frequency * mode.mass * q[1];
    }
    let first_lag = modes.flap.len();
    let first_torsion = first_lag + modes.lag.len();
    if let Some(spring) = blade.pitch_spring {
        let turned: f64 =
            modes.torsion.iter().zip(&q[first_torsion..]).map(|(mode, q)| mode.root * q[0]).sum();
        for (own, mode) in residual[first_torsion..].iter_mut().zip(&modes.torsion) {
            *own += spring * turned * mode.root;
        }
    }
    if let Some((_, constant)) = blade.lag_damper {
        let rate: f64 =
            modes.lag.iter().zip(&q[first_lag..]).map(|(mode, q)| mode.at_damper * q[1]).sum();
        for (own, mode) in residual[first_lag..].iter_mut().zip(&modes.lag) {
            *own += constant * rate.abs() * rate * mode.at_damper;
        }
    }
}

/// Force and moment of the blade on the rotor centre, by summation of inertia and airloads.
fn root(blade: &Blade, span: &Span, s: &Snapshot, acting: &[Acting], offsets: &[Offset]) -> Root {
    let [km1, km2, _] = blade.gyration.map(|own| own * own);
    let cone = blade.precone_rad;
    let (w, v, u) = (&s.w, &s.v, &s.u);
    let mut sum = [0.0; 6];
    for (p, (x, weight)) in span.x.iter().zip(&span.weight).enumerate() {
        let own = &acting[p];
        let [inertia_z, inertia_m] = own.flap;
        let f_x_air = -w.slope[p] * own.air.f_z - v.slope[p] * own.air.f_y;
        let mut f = [
            x + u[0][p] + 2.0 * v.rate[p] - u[2][p] + f_x_air,
            v.value[p] - v.acceleration[p] - 2.0 * u[1][p] + 2.0 * cone * w.rate[p] + own.air.f_y,
            -w.acceleration[p] - cone * (x + 2.0 * v.rate[p]) + own.air.f_z + inertia_z,
        ];
        let (sin, cos) = own.theta[0].sin_cos();
        let twisting = -(km1 + km2) * own.theta[2] - (km2 - km1) * sin * cos;
        let mut m = [twisting + own.air.moment + inertia_m, 0.0, 0.0];
        if let Some(own) = offsets.get(p) {
            for k in 0..3 {
                f[k] += own.force[k];
                m[k] += own.moment[k];
            }
        }
        let arm = [x + u[0][p], v.value[p], w.value[p]];
        let about = [
            arm[1] * f[2] - arm[2] * f[1] + m[0],
            arm[2] * f[0] - arm[0] * f[2] + m[1],
            arm[0] * f[1] - arm[1] * f[0] + m[2],
        ];
        for k in 0..3 {
            sum[k] += weight * f[k];
            sum[k + 3] += weight * about[k];
        }
    }
    sum
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Without motion and air a mass centre ahead of the axis works by the centrifugal potential
    /// `-int e (X d_x + Y d_y)` alone.
    #[test]
    fn an_offset_works_by_its_potential() -> Result<(), crate::error::RotorTruthError> {
        let e = 0.002;
        let span = Span::new(&[], 8, 0.2);
        let plain = Blade { twist_rad: 0.0, ..Blade::default() };
        let ahead = Blade { mass_centre: e, ..plain.clone() };
        let modes = Modes::of(&plain, &span)?;
        let still: Vec<f64> = vec![0.04, 0.002, -1e-4, 1e-5, -0.01, 3e-4, 1e-5, 0.0, -0.006, 5e-4];
        let pitch = 0.15;
        let at = |q: &[f64]| -> Vec<[f64; 3]> { q.iter().map(|own| [*own, 0.0, 0.0]).collect() };
        let potential = |q: &[f64]| {
            let s = Snapshot::new(&modes, &span, &at(q));
            let one = |p: usize| {
                let (sin, cos) = (pitch + s.phi.value[p]).sin_cos();
                let along = -(s.v.slope[p] * cos + s.w.slope[p] * sin);
                -e * span.weight[p] * ((span.x[p] + s.u[0][p]) * along + s.v.value[p] * cos)
            };
            (0..span.len()).map(one).sum::<f64>()
        };
        let residual = |blade: &Blade| {
            let q = at(&still);
            let s = Snapshot::new(&modes, &span, &q);
            let acting: Vec<Acting> = s
                .phi
                .value
                .iter()
                .map(|phi| Acting { theta: [pitch + phi, 0.0, 0.0], ..Acting::default() })
                .collect();
            equations(blade, &span, &modes, &q, &s, &acting).0
        };
        let found: Vec<f64> =
            residual(&ahead).iter().zip(residual(&plain)).map(|(a, b)| a - b).collect();
        for (k, own) in found.iter().enumerate() {
            let mut moved = still.clone();
            moved[k] += 1e-5;
            let up = potential(&moved);
            moved[k] -= 2e-5;
            let exact = (up - potential(&moved)) / 2e-5;
            assert!((own - exact).abs() < 1e-9, "{k}: {own} {exact}");
        }
        Ok(())
    }
}
