//! Convex limits of a control vector: voltage, flap angle, power.

use crate::{ControlError, ControlLayout, error};
use nalgebra::{DMatrix, DVector, SymmetricEigen};
use rotor_base::uniform_azimuths_rad;

/// Range of the total voltage of every flap, its bias included.
///
/// ```text
/// V_min <= u_st + sum_N (u_Nc cos N psi + u_Ns sin N psi) <= V_max     at every azimuth sample
/// u_st = b + s_1c u_1c + s_1s u_1s + ...                               of the flap's own controls
/// ```
/// The bias is solved for, and moves with the control: a range that holds it fast is left by the next step along
/// its edge.
#[derive(Debug, Clone, PartialEq)]
pub struct VoltageRange {
    /// Lowest and highest voltage the actuators may see, V.
    pub range_volt: [f64; 2],
    /// Bias `b` of each flap as the tangent continues it to zero control, V, inside the range.
    pub bias_volt: Vec<f64>,
    /// Change `s` of the bias of a flap with each of its controls, V/V, in the order of the control vector; empty
    /// for a bias that stays.
    pub bias_slope: Vec<f64>,
    /// Number of uniform azimuth samples at which the range holds, 8 or more.
    pub azimuths: usize,
}

/// Largest amplitude of one flap at one harmonic, through the gain of its actuator.
///
/// ```text
/// | g [u_Nc, u_Ns]' | <= limit
/// ```
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FlapCircle {
    /// Flap cosine and sine per voltage cosine and sine, deg/V, `[row][column]`.
    pub gain_deg_per_volt: [[f64; 2]; 2],
    /// Largest flap amplitude, deg, positive.
    pub limit_deg: f64,
}

/// A bound on a quadratic form of the control, such as the mean actuation power.
///
/// ```text
/// p0 + p' u + u' P u <= limit,      P symmetric, without negative eigenvalue
/// ```
#[derive(Debug, Clone, PartialEq)]
pub struct PowerLimit {
    /// `P`, unit of the limit per V^2.
    pub quadratic: DMatrix<f64>,
    /// `p`, unit of the limit per V.
    pub linear: Vec<f64>,
    /// `p0`, below the limit.
    pub constant: f64,
    /// The limit.
    pub limit: f64,
}

/// Every limit a control vector has to keep. Zero control keeps them all with room to spare, which
/// makes them a convex set that is star-shaped about zero.
///
/// Source: the limits of the stroke and of the voltage in Viswamurthy and Ganguli, sections 3 and 6,
/// as constraints of the optimum; the paper does not say how it keeps them.
#[derive(Debug, Clone, PartialEq)]
pub struct ControlLimits {
    layout: ControlLayout,
    /// Largest amplitude of every pair.
    pub(crate) amplitude_volt: Vec<f64>,
    /// With the cosines and sines of the harmonics at every sample.
    voltage: Option<(VoltageRange, Vec<f64>)>,
    /// Of every pair.
    pub(crate) flaps: Vec<Option<FlapCircle>>,
    /// With a root `F` of its form, `F' F = P`.
    pub(crate) power: Option<(PowerLimit, DMatrix<f64>)>,
}

impl ControlLimits {
    /// No limit at all for a layout.
    pub fn none(layout: &ControlLayout) -> Self {
        let pairs = layout.pairs();
        Self {
            layout: layout.clone(),
            amplitude_volt: vec![f64::INFINITY; pairs],
            voltage: None,
            flaps: vec![None; pairs],
            power: None,
        }
    }

    /// With a largest voltage amplitude for each pair of the layout, V; infinity for none.
    ///
    /// # Errors
    /// [`ControlError::Length`]; [`ControlError::OutOfRange`] unless every amplitude is positive.
    pub fn with_amplitudes_volt(self, amplitude_volt: Vec<f64>) -> Result<Self, ControlError> {
        let (what, expected) = ("voltage amplitudes", self.layout.pairs());
        error::check_length(what, amplitude_volt.len(), expected)?;
        for &volt in &amplitude_volt {
            error::check_range(volt > 0.0, "largest voltage amplitude (V)", volt, "above 0")?;
        }
        Ok(Self { amplitude_volt, ..self })
    }

    /// With a range of the total voltage.
    ///
    /// # Errors
    /// [`ControlError::Length`]; [`ControlError::OutOfRange`] for a bias outside the range or fewer
    /// than 8 samples.
    pub fn with_voltage_range(self, voltage: VoltageRange) -> Result<Self, ControlError> {
        error::check_vector("bias voltages (V)", &voltage.bias_volt, self.layout.flaps())?;
        error::check_vector("range of the voltage (V)", &voltage.range_volt, 2)?;
        if !voltage.bias_slope.is_empty() {
            let (what, controls) = ("slopes of the bias (V/V)", self.layout.len());
            error::check_vector(what, &voltage.bias_slope, controls)?;
        }
        let [low, high] = voltage.range_volt;
        for &bias in &voltage.bias_volt {
            let room = (high - bias).min(bias - low);
            error::check_positive("room between bias and range (V)", room)?;
        }
        let (what, samples) = ("azimuth samples of the voltage", voltage.azimuths as f64);
        error::check_range(samples >= 8.0, what, samples, "8 or more")?;
        let azimuths = uniform_azimuths_rad(voltage.azimuths);
        let harmonics = self.layout.harmonics();
        let waves = azimuths
            .iter()
            .flat_map(|psi| harmonics.iter().map(move |&n| (f64::from(n) * psi).sin_cos()))
            .flat_map(|(sin, cos)| [cos, sin])
            .collect();
        Ok(Self { voltage: Some((voltage, waves)), ..self })
    }

    /// With a largest flap amplitude of one pair of the layout.
    ///
    /// # Errors
    /// [`ControlError::OutOfRange`] for a pair beyond the last or a limit that is not positive.
    pub fn with_flap_circle(
        mut self,
        pair: usize,
        circle: FlapCircle,
    ) -> Result<Self, ControlError> {
        error::check_positive("largest flap amplitude (deg)", circle.limit_deg)?;
        let gains = circle.gain_deg_per_volt.concat();
        error::check_vector("gain of a flap (deg/V)", &gains, 4)?;
        let (pairs, expected) = (self.flaps.len(), "a pair of the layout");
        error::check_range(pair < pairs, "pair of a flap limit", pair as f64, expected)?;
        self.flaps[pair] = Some(circle);
        Ok(self)
    }

    /// With a bound on a quadratic form of the control.
    ///
    /// # Errors
    /// [`ControlError::Length`], [`ControlError::NotFinite`]; [`ControlError::OutOfRange`] for a form
    /// with a negative eigenvalue or a limit that zero control does not keep.
    pub fn with_power(self, power: PowerLimit) -> Result<Self, ControlError> {
        let n = self.layout.len();
        error::check_vector("quadratic form of the power", power.quadratic.as_slice(), n * n)?;
        error::check_vector("linear form of the power", &power.linear, n)?;
        error::check_positive("power limit left at zero control", power.limit - power.constant)?;
        let symmetric = (&power.quadratic + power.quadratic.transpose()) * 0.5;
        let eigen = SymmetricEigen::new(symmetric);
        let (least, largest) = (eigen.eigenvalues.min(), eigen.eigenvalues.amax());
        let fits = least >= -1e-12 * largest;
        error::check_range(fits, "least eigenvalue of the power", least, "0 or above")?;
        let root = DMatrix::from_diagonal(&eigen.eigenvalues.map(|v| v.max(0.0).sqrt()))
            * eigen.eigenvectors.transpose();
        Ok(Self { power: Some((power, root)), ..self })
    }

    /// The layout the limits belong to.
    pub fn layout(&self) -> &ControlLayout {
        &self.layout
    }

    /// How much of the limits a control vector uses: it keeps them all if this is at most 1, and
    /// divided by this it just keeps them.
    ///
    /// # Errors
    /// [`ControlError::Length`], [`ControlError::NotFinite`].
    pub fn usage(&self, control_volt: &[f64]) -> Result<f64, ControlError> {
        error::check_vector("control vector (volt)", control_volt, self.layout.len())?;
        let pairs = control_volt.chunks_exact(2);
        let circles = pairs.zip(&self.amplitude_volt).zip(&self.flaps).map(|((u, volt), flap)| {
            let of_flap = flap.map_or(0.0, |circle| {
                let [c, s] = circle.gain_deg_per_volt.map(|row| row[0] * u[0] + row[1] * u[1]);
                c.hypot(s) / circle.limit_deg
            });
            of_flap.max(u[0].hypot(u[1]) / volt)
        });
        let power = self.power.iter().map(|(power, _)| power.usage(control_volt));
        Ok(circles.chain(power).fold(self.voltage_usage(control_volt), f64::max))
    }

    /// The part of the usage that is the range of the voltage.
    fn voltage_usage(&self, control_volt: &[f64]) -> f64 {
        let Some((voltage, waves)) = &self.voltage else { return 0.0 };
        let per_flap = 2 * self.layout.harmonics().len();
        let [lowest, highest] = voltage.range_volt;
        let flaps = control_volt.chunks_exact(per_flap).zip(&voltage.bias_volt).enumerate();
        flaps.fold(0.0, |most, (flap, (u, bias))| {
            let moved = along(voltage.slope_of(flap, per_flap), u);
            waves.chunks_exact(per_flap).fold(most, |most: f64, wave| {
                let volt = moved + along(wave, u);
                most.max(volt / (highest - bias)).max(volt / (lowest - bias))
            })
        })
    }

    /// The range of the voltage as rows `row u <= room`: for each flap and azimuth sample the upper, then
    /// the lower end.
    pub(crate) fn voltage_rows(&self) -> Vec<(Vec<(usize, f64)>, f64)> {
        let Some((voltage, waves)) = &self.voltage else { return Vec::new() };
        let per_flap = 2 * self.layout.harmonics().len();
        let mut rows = Vec::new();
        for (flap, bias) in voltage.bias_volt.iter().enumerate() {
            let slope = voltage.slope_of(flap, per_flap);
            for wave in waves.chunks_exact(per_flap) {
                let row = |sign: f64| -> Vec<(usize, f64)> {
                    let first = per_flap * flap;
                    let moves = slope.iter().copied().chain(std::iter::repeat(0.0));
                    let each = wave.iter().zip(moves).enumerate();
                    each.map(|(k, (value, moves))| (first + k, sign * (value + moves))).collect()
                };
                rows.push((row(1.0), voltage.range_volt[1] - bias));
                rows.push((row(-1.0), bias - voltage.range_volt[0]));
            }
        }
        rows
    }

    /// A voltage of the size the limits allow, V; none without limit in volt.
    pub(crate) fn typical_volt(&self) -> Option<f64> {
        let room = self.voltage.iter().map(|(v, _)| 0.5 * (v.range_volt[1] - v.range_volt[0]));
        let flaps = self.flaps.iter().flatten().map(|circle| {
            let largest = circle.gain_deg_per_volt.concat().iter().fold(0.0, |m, g| g.abs().max(m));
            circle.limit_deg / largest
        });
        let finite = self.amplitude_volt.iter().copied().chain(room).chain(flaps);
        finite.filter(|v| v.is_finite() && *v > 0.0).reduce(f64::max)
    }
}

impl VoltageRange {
    /// Slopes of the bias of one flap; empty where it stays.
    fn slope_of(&self, flap: usize, controls: usize) -> &[f64] {
        self.bias_slope.get(flap * controls..(flap + 1) * controls).unwrap_or_default()
    }
}

/// Sum of products; what has no partner is left out.
fn along(a: &[f64], b: &[f64]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

impl PowerLimit {
    /// The inverse of the largest factor by which the control may be multiplied.
    fn usage(&self, control_volt: &[f64]) -> f64 {
        let u = DVector::from_column_slice(control_volt);
        let a = u.dot(&(&self.quadratic * &u));
        let b: f64 = self.linear.iter().zip(control_volt).map(|(p, u)| p * u).sum();
        let room = self.limit - self.constant;
        // a k^2 + b k = room at k = 1 / usage: room w^2 - b w - a = 0
        (b + (b * b + 4.0 * a.max(0.0) * room).sqrt()) / (2.0 * room)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use approx::assert_abs_diff_eq;

    fn layout() -> ControlLayout {
        ControlLayout::new(2, vec![2, 3]).unwrap()
    }

    #[test]
    fn a_control_divided_by_its_usage_just_keeps_every_limit() {
        let voltage = VoltageRange {
            range_volt: [-20.0, 150.0],
            bias_volt: vec![60.0, 70.0],
            bias_slope: (0..8).map(|i| 0.2 * f64::from(i).sin()).collect(),
            azimuths: 720,
        };
        let power = PowerLimit {
            quadratic: DMatrix::from_fn(8, 8, |i, j| if i == j { 0.5 + i as f64 } else { 0.1 }),
            linear: (0..8).map(|i| 0.3 * f64::from(i) - 1.0).collect(),
            constant: 2.0,
            limit: 50.0,
        };
        let circle =
            FlapCircle { gain_deg_per_volt: [[0.03, -0.02], [0.02, 0.03]], limit_deg: 0.25 };
        let none = ControlLimits::none(&layout());
        let each = [
            none.clone().with_amplitudes_volt(vec![3.0, 5.0, 7.0, f64::INFINITY]).unwrap(),
            none.clone().with_voltage_range(voltage).unwrap(),
            none.clone().with_flap_circle(2, circle).unwrap(),
            none.clone().with_power(power).unwrap(),
        ];
        let u: Vec<f64> = (0..8).map(|i| 9.0 * (1.7 * f64::from(i)).sin()).collect();
        assert_abs_diff_eq!(none.usage(&u).unwrap(), 0.0);
        for limits in each {
            let usage = limits.usage(&u).unwrap();
            assert!(usage > 0.0);
            let scaled: Vec<f64> = u.iter().map(|v| v / usage).collect();
            assert_abs_diff_eq!(limits.usage(&scaled).unwrap(), 1.0, epsilon = 1e-12);
        }
    }

    #[test]
    fn impossible_limits_are_refused() {
        let none = || ControlLimits::none(&layout());
        assert!(none().with_amplitudes_volt(vec![1.0; 3]).is_err());
        assert!(none().with_amplitudes_volt(vec![1.0, 0.0, 1.0, 1.0]).is_err());
        assert!(none().with_amplitudes_volt(vec![1.0, f64::NAN, 1.0, 1.0]).is_err());
        let range = |bias: f64, azimuths| VoltageRange {
            range_volt: [-20.0, 150.0],
            bias_volt: vec![bias; 2],
            bias_slope: Vec::new(),
            azimuths,
        };
        let sloped = VoltageRange { bias_slope: vec![0.1; 7], ..range(65.0, 72) };
        assert!(none().with_voltage_range(sloped).is_err());
        assert!(none().with_voltage_range(range(150.0, 72)).is_err());
        assert!(none().with_voltage_range(range(65.0, 7)).is_err());
        let circle = FlapCircle { gain_deg_per_volt: [[0.1, 0.0], [0.0, 0.1]], limit_deg: 1.0 };
        assert!(none().with_flap_circle(4, circle).is_err());
        assert!(none().with_flap_circle(0, FlapCircle { limit_deg: 0.0, ..circle }).is_err());
        let power = |size: f64, constant: f64| PowerLimit {
            quadratic: DMatrix::identity(8, 8) * size,
            linear: vec![0.0; 8],
            constant,
            limit: 1.0,
        };
        assert!(none().with_power(power(-1.0, 0.0)).is_err());
        assert!(none().with_power(power(1.0, 1.0)).is_err());
    }
}
