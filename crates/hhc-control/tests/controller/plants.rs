//! Plants with known answers.

use hhc_control::{ControlLayout, LinearPlant, Measurement, Plant, TMatrix};
use nalgebra::{DMatrix, DVector};
use rotor_base::Harmonic;
use std::convert::Infallible;
use std::f64::consts::PI;

/// A linear problem: the plant, its matrices, and its closed-form optimum.
#[derive(Debug, Clone)]
pub(crate) struct Problem {
    pub(crate) plant: LinearPlant,
    pub(crate) t: DMatrix<f64>,
    pub(crate) z0: DVector<f64>,
}

impl Problem {
    /// A problem of `flaps` flaps at some harmonics, from `loads x controls` and `loads` numbers.
    pub(crate) fn new(flaps: usize, harmonics: &[u32], t: DMatrix<f64>, z0: &[f64]) -> Self {
        let layout = ControlLayout::new(flaps, harmonics.to_vec()).unwrap();
        let plant = LinearPlant::new(layout, z0.to_vec(), as_t(&t)).unwrap();
        Self { plant, t, z0: DVector::from_column_slice(z0) }
    }

    /// The minimum of the cost by the normal equations:
    /// `(T' W T + rho I) u = -T' W Z0`.
    pub(crate) fn optimum(&self, weights: &[f64], rho: f64) -> DVector<f64> {
        let weighted = DMatrix::from_diagonal(&DVector::from_column_slice(weights)) * &self.t;
        let normal = self.t.transpose() * &weighted
            + DMatrix::identity(self.t.ncols(), self.t.ncols()) * rho;
        normal.lu().solve(&(-weighted.transpose() * &self.z0)).unwrap()
    }

    /// `J_Z` with unit weights.
    pub(crate) fn loads_cost(&self, control: &DVector<f64>) -> f64 {
        (&self.z0 + &self.t * control).norm_squared()
    }

    /// T with every voltage harmonic turned by `phase_deg` and multiplied by `gain`.
    pub(crate) fn distorted_t(&self, gain: f64, phase_deg: f64) -> TMatrix {
        let (s, c) = phase_deg.to_radians().sin_cos();
        let n = self.t.ncols();
        let turn = DMatrix::from_fn(n, n, |i, j| match (i / 2 == j / 2, i % 2, j % 2) {
            (false, _, _) => 0.0,
            (true, 0, 1) => -gain * s,
            (true, 1, 0) => gain * s,
            _ => gain * c,
        });
        as_t(&(&self.t * turn))
    }
}

pub(crate) fn as_t(matrix: &DMatrix<f64>) -> TMatrix {
    let columns: Vec<Vec<f64>> =
        matrix.column_iter().map(|c| c.iter().copied().collect()).collect();
    TMatrix::from_columns(&columns).unwrap()
}

/// Distance of two control vectors over the size of the second.
pub(crate) fn relative_error(control: &[f64], exact: &DVector<f64>) -> f64 {
    (DVector::from_column_slice(control) - exact).norm() / exact.norm()
}

/// Any plant, counting its calls.
pub(crate) struct Counted<P> {
    pub(crate) plant: P,
    pub(crate) measurements: usize,
    pub(crate) stroke_calls: usize,
}

impl<P> Counted<P> {
    pub(crate) fn new(plant: P) -> Self {
        Self { plant, measurements: 0, stroke_calls: 0 }
    }
}

impl<P: Plant> Plant for Counted<P> {
    type Error = P::Error;

    fn layout(&self) -> &ControlLayout {
        self.plant.layout()
    }

    fn measure(&mut self, control_volt: &[f64]) -> Result<Measurement, Self::Error> {
        self.measurements += 1;
        self.plant.measure(control_volt)
    }

    fn strokes_deg(&mut self, control_volt: &[f64]) -> Result<Vec<f64>, Self::Error> {
        self.stroke_calls += 1;
        self.plant.strokes_deg(control_volt)
    }

    fn stroke_limits_deg(&self) -> Vec<f64> {
        self.plant.stroke_limits_deg()
    }

    fn admits(&self, control_volt: &[f64]) -> bool {
        self.plant.admits(control_volt)
    }
}

/// Actuators with Rayleigh hysteresis and a lag: gain and phase depend on the amplitude, also in
/// the limit of small steps.
///
/// The Rayleigh loop of amplitude `A` is `(a + b A) v -+ (b/2) (A^2 - v^2)` for falling and rising
/// `v`; the first harmonic of its answer to `A cos` is `(a + b A) A cos + (4 / (3 pi)) b A^2 sin`.
#[derive(Debug, Clone)]
pub(crate) struct RayleighPlant {
    pub(crate) layout: ControlLayout,
    /// Loads per degree of flap.
    pub(crate) loads_per_deg: DMatrix<f64>,
    pub(crate) z0: DVector<f64>,
    pub(crate) a_deg_per_volt: f64,
    pub(crate) b_deg_per_volt2: f64,
    pub(crate) lag_rad: f64,
    pub(crate) stroke_limit_deg: f64,
}

impl RayleighPlant {
    /// Gain in phase and gain in quadrature (late) at a voltage amplitude, without the pure lag.
    pub(crate) fn gains(&self, amplitude_volt: f64) -> (f64, f64) {
        let in_phase = self.a_deg_per_volt + self.b_deg_per_volt2 * amplitude_volt;
        (in_phase, 4.0 / (3.0 * PI) * self.b_deg_per_volt2 * amplitude_volt)
    }

    pub(crate) fn flaps_deg(&self, control_volt: &[f64]) -> Vec<Harmonic> {
        let voltages = self.layout.voltages_volt(control_volt).unwrap();
        voltages
            .iter()
            .map(|voltage| {
                let (in_phase, late) = self.gains(voltage.amplitude());
                Harmonic::from_amplitude_phase(
                    voltage.amplitude() * in_phase.hypot(late),
                    voltage.phase_rad() + late.atan2(in_phase) + self.lag_rad,
                )
            })
            .collect()
    }
}

impl Plant for RayleighPlant {
    type Error = Infallible;

    fn layout(&self) -> &ControlLayout {
        &self.layout
    }

    fn measure(&mut self, control_volt: &[f64]) -> Result<Measurement, Self::Error> {
        let flap_motion_deg = self.flaps_deg(control_volt);
        let flaps = DVector::from_vec(self.layout.control_volt(&flap_motion_deg).unwrap());
        let hub_loads = (&self.z0 + &self.loads_per_deg * flaps).iter().copied().collect();
        Ok(Measurement {
            outputs: hub_loads,
            flap_motion_deg,
            mean_flap_deg: vec![0.0; self.layout.flaps()],
        })
    }

    fn strokes_deg(&mut self, control_volt: &[f64]) -> Result<Vec<f64>, Self::Error> {
        Ok(self.flaps_deg(control_volt).iter().map(Harmonic::amplitude).collect())
    }

    fn stroke_limits_deg(&self) -> Vec<f64> {
        vec![self.stroke_limit_deg; self.layout.pairs()]
    }
}
