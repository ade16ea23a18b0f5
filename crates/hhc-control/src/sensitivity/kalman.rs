//! T and Z0 from measured pairs: a Kalman filter, recursive least squares with a model of drift.

use crate::{ControlError, ControlStep, FeedbackLaw, TMatrix, error};
use nalgebra::{DMatrix, DVector};

/// Settings of the adaptive controller.
#[derive(Debug, Clone, PartialEq)]
pub struct AdaptiveSettings {
    /// Control voltage over which the actuator is used, V: the unit of the excitation.
    pub full_scale_volt: f64,
    /// Standard deviation of the noise of one measured load, nondimensional; 0 for none.
    pub noise: f64,
    /// Standard deviation of an element of T0, as a part of the root mean square of its elements.
    pub uncertainty: f64,
    /// Change of an element of T that a move of the control by full scale brings, as a part of the same:
    /// the random walk of the filter. Zero makes it ordinary recursive least squares.
    pub drift: f64,
    /// Excitation below which T is left alone: the move of the control since the pair before, as a
    /// part of full scale. A filter fed with moves near zero would read noise as T.
    pub dead_zone: f64,
    /// Times a step may be rejected in full before the run ends: after the first, T has learnt from the
    /// rejected pairs; if it still asks for much the same, each control is moved by a
    /// twentieth of full scale to excite it.
    pub probes: u32,
}

impl AdaptiveSettings {
    /// Settings for actuators of a given full scale, V, and loads without noise: T0 good to a half, a
    /// change of T by a half over full scale.
    pub fn of_full_scale(full_scale_volt: f64) -> Self {
        let (noise, uncertainty, drift) = (0.0, 0.5, 0.5);
        Self { full_scale_volt, noise, uncertainty, drift, dead_zone: 1e-4, probes: 4 }
    }

    pub(crate) fn check(&self) -> Result<(), ControlError> {
        error::check_positive("full scale of the adaptive controller (V)", self.full_scale_volt)?;
        error::check_not_negative("noise of a load", self.noise)?;
        error::check_positive("uncertainty of T0", self.uncertainty)?;
        error::check_not_negative("drift of T", self.drift)?;
        error::check_not_negative("dead zone of the excitation", self.dead_zone)
    }
}

/// Part of full scale by which a control is moved to excite it.
const PROBE: f64 = 0.05;
/// Noise of a load that rounding and convergence leave, as a part of the loads' root mean square.
const NOISE_FLOOR: f64 = 1e-7;

/// The estimate `Z = Z0 + T u` with its covariance, the same for every load.
///
/// ```text
/// Z_i = theta_i . phi,   phi = (1, u / u_full),   theta_i = (Z0_i, T_i u_full)
/// predict   P += Q,   Q = (drift |du| / u_full)^2 rms^2 on the elements of T
/// update    k = P phi / (r + phi' P phi),   theta_i += k (Z_i - theta_i . phi),   P -= k phi' P
/// ```
/// Safeguards: no update of T below the dead zone; the variance of an element never grows beyond that
/// of T0, so that directions that are not excited cannot burst.
///
/// Source: W. Johnson, NASA TP-1996 (1982), section on identification; B. Anderson, J. Moore, *Optimal
/// Filtering* (1979), chapter 3.
#[derive(Debug, Clone)]
pub(crate) struct Kalman {
    settings: AdaptiveSettings,
    /// Loads x (1 + controls).
    theta: DMatrix<f64>,
    covariance: DMatrix<f64>,
    /// Variance of a scaled element of T0, and the largest allowed.
    prior: f64,
    noise_variance: f64,
    last_volt: Vec<f64>,
}

impl Kalman {
    pub(crate) fn new(settings: &AdaptiveSettings, law: &FeedbackLaw, start: &ControlStep) -> Self {
        let t = law.t().as_matrix() * settings.full_scale_volt;
        let loads = DVector::from_column_slice(&start.measurement.outputs);
        let u = DVector::from_column_slice(&start.control_volt) / settings.full_scale_volt;
        let z0 = &loads - &t * &u;
        let rms = |m: &[f64]| -> f64 {
            (m.iter().map(|v| v * v).sum::<f64>() / m.len().max(1) as f64).sqrt()
        };
        let prior = (settings.uncertainty * rms(t.as_slice())).powi(2);
        let noise = settings.noise.hypot(NOISE_FLOOR * rms(loads.as_slice()));
        let noise_variance = noise.powi(2).max(f64::MIN_POSITIVE);
        let mut covariance = DMatrix::identity(t.ncols() + 1, t.ncols() + 1) * prior;
        // Z0 is as good as the one measurement it comes from
        covariance[(0, 0)] = noise_variance;
        let theta = t.insert_column(0, 0.0);
        let mut this = Self {
            settings: settings.clone(),
            theta,
            covariance,
            prior,
            noise_variance,
            last_volt: start.control_volt.clone(),
        };
        this.theta.set_column(0, &z0);
        this
    }

    fn regressor(&self, control_volt: &[f64]) -> DVector<f64> {
        let scaled = control_volt.iter().map(|u| u / self.settings.full_scale_volt);
        DVector::from_iterator(control_volt.len() + 1, std::iter::once(1.0).chain(scaled))
    }

    /// Takes in one measured pair.
    pub(crate) fn observe(&mut self, control_volt: &[f64], hub_loads: &[f64]) {
        let moved: f64 = control_volt
            .iter()
            .zip(&self.last_volt)
            .map(|(a, b)| ((a - b) / self.settings.full_scale_volt).powi(2))
            .sum::<f64>()
            .sqrt();
        self.last_volt.copy_from_slice(control_volt);
        let controls = control_volt.len();
        let phi = self.regressor(control_volt);
        let innovation = DVector::from_column_slice(hub_loads) - &self.theta * &phi;
        if moved < self.settings.dead_zone {
            // nothing to tell T from: the loads alone are followed
            let spread = self.covariance[(0, 0)];
            let gain = spread / (spread + self.noise_variance);
            let mut z0 = self.theta.column_mut(0);
            z0.axpy(gain, &innovation, 1.0);
            self.covariance[(0, 0)] = (spread - gain * spread).max(0.5 * self.noise_variance);
            return;
        }
        let walk = self.settings.drift / self.settings.uncertainty * moved;
        for k in 1..=controls {
            self.covariance[(k, k)] += self.prior * walk * walk;
            let excess = (self.prior / self.covariance[(k, k)]).sqrt();
            if excess < 1.0 {
                self.covariance.row_mut(k).scale_mut(excess);
                self.covariance.column_mut(k).scale_mut(excess);
            }
        }
        let spread = &self.covariance * &phi;
        let gain = &spread / (self.noise_variance + phi.dot(&spread));
        self.theta += &innovation * gain.transpose();
        self.covariance -= &gain * spread.transpose();
        let symmetric = (&self.covariance + self.covariance.transpose()) * 0.5;
        self.covariance = symmetric;
    }

    /// The loads the estimate gives at a control vector.
    pub(crate) fn loads_at(&self, control_volt: &[f64]) -> Vec<f64> {
        (&self.theta * self.regressor(control_volt)).iter().copied().collect()
    }

    /// The estimate of T, 1/V.
    pub(crate) fn t(&self) -> Result<TMatrix, ControlError> {
        TMatrix::from_matrix(self.theta.columns_range(1..) / self.settings.full_scale_volt)
    }

    /// Size of a move that excites a control, V.
    pub(crate) fn probe_volt(&self) -> f64 {
        PROBE * self.settings.full_scale_volt
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::{AllowedIncrease, Cost, LoadWeights, Measurement};

    const LOADS: usize = 6;

    fn true_t(i: usize, j: usize) -> f64 {
        (1.0 + 2.3 * i as f64 + 0.7 * (j * j) as f64).sin()
    }

    fn start(loads: &[f64]) -> ControlStep {
        ControlStep {
            control_volt: vec![0.0; 4],
            measurement: Measurement {
                outputs: loads.to_vec(),
                flap_motion_deg: Vec::new(),
                mean_flap_deg: Vec::new(),
            },
            rho: 0.0,
            cost: Cost { loads: 0.0, control: 0.0 },
            asked_volt: 0.0,
            backtracks: 0,
            allowed_increase: AllowedIncrease::None,
        }
    }

    fn loads(u: &[f64]) -> Vec<f64> {
        (0..LOADS)
            .map(|i| 0.5 + i as f64 + (0..4).map(|j| true_t(i, j) * u[j]).sum::<f64>())
            .collect()
    }

    fn filter(drift: f64) -> Kalman {
        let wrong: Vec<Vec<f64>> =
            (0..4).map(|j| (0..LOADS).map(|i| 0.6 * true_t(i, j) + 0.2).collect()).collect();
        let law = FeedbackLaw::new(&TMatrix::from_columns(&wrong).unwrap(), &LoadWeights::Identity)
            .unwrap();
        let settings = AdaptiveSettings { drift, ..AdaptiveSettings::of_full_scale(10.0) };
        Kalman::new(&settings, &law, &start(&loads(&[0.0; 4])))
    }

    fn error(filter: &Kalman) -> f64 {
        let t = filter.t().unwrap();
        let entries = (0..LOADS).flat_map(|i| (0..4).map(move |j| (i, j)));
        entries.map(|(i, j)| (t.at(i, j).unwrap() - true_t(i, j)).abs()).fold(0.0, f64::max)
    }

    #[test]
    fn as_many_independent_moves_as_controls_tell_t() {
        for drift in [0.0, 0.5] {
            let mut filter = filter(drift);
            let before = error(&filter);
            assert!(before > 0.3);
            for j in 0..4 {
                let mut u = vec![0.0; 4];
                u[j] = 3.0;
                u[(j + 1) % 4] -= 1.0;
                filter.observe(&u, &loads(&u));
            }
            // a drifting T is never known for good: what was learnt first has aged
            let bound = if drift == 0.0 { 1e-4 } else { 0.6 * before };
            assert!(error(&filter) < bound, "{}", error(&filter));
        }
    }

    #[test]
    fn moves_near_zero_do_not_burst_t() {
        let mut filter = filter(0.5);
        for k in 0..200 {
            let noise = 1e-3 * f64::from(k % 2);
            let u = vec![1e-6 * f64::from(k % 3); 4];
            let z: Vec<f64> = loads(&u).iter().map(|z| z + noise).collect();
            filter.observe(&u, &z);
        }
        assert!(error(&filter) < 1.0, "{}", error(&filter));
    }

    #[test]
    fn the_variance_never_exceeds_that_of_t0() {
        let mut filter = filter(2.0);
        for k in 0..100 {
            // one direction only
            let u = vec![5.0 * (f64::from(k)).sin(), 0.0, 0.0, 0.0];
            filter.observe(&u, &loads(&u));
        }
        for k in 1..=4 {
            assert!(filter.covariance[(k, k)] <= filter.prior * (1.0 + 1e-12));
        }
    }
}
