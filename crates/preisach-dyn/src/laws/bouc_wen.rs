//! The Bouc-Wen model in its normalised, rate-independent form.

use crate::check::{check_not_negative, check_positive, check_that, check_within};
use crate::{Envelope, HysteresisLaw, PreisachError, StartState, VoltageRange};
use serde::{Deserialize, Serialize};

/// The numbers of a [`BoucWen`] model, as they are written to files.
///
/// | symbol | relation to `dz = [A - |z|^n (beta sgn(z du) + gamma)] du` |
/// |---|---|
/// | `z0` | `(A / (beta + gamma))^(1/n)` |
/// | `rise` | `z0 / A` |
/// | `sigma` | `beta / (beta + gamma)` |
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoucWenParameters {
    /// Voltages it may see, V.
    pub range_volt: VoltageRange,
    /// Slope of the reversible part, deg/V, `> 0`.
    pub gain_deg_per_volt: f64,
    /// Half the height of a wide loop, `z0`, deg, `>= 0`.
    pub half_height_deg: f64,
    /// Voltage over which a loop opens, `rise`, V, `> 0`.
    pub rise_volt: f64,
    /// Shape `sigma`, `>= 1/2`: 1/2 unloads straight, larger values unload fast.
    pub sigma: f64,
    /// Exponent `n`, 1 to 10: sharpness of the bend into the wide loop.
    pub exponent: f64,
    /// The output curve.
    #[serde(default)]
    pub envelope: Envelope,
}

/// A Bouc-Wen hysteresis: a straight line less one hysteretic variable.
///
/// ```text
/// z = gain (u - u_mid) - z0 w
/// dw = [ 1 - sigma sgn(du) |w|^(n-1) w + (sigma - 1) |w|^n ] du / rise
/// delta = envelope(z)
/// ```
/// Rate-independent: `w` depends on the voltage's path alone.
///
/// Checked when built: `sigma >= 1/2`, which makes it passive (every closed loop loses energy) and
/// keeps `|w| <= 1`; `gain >= 2 sigma z0 / rise`, so that the output never falls with the voltage.
///
/// Integration: exact for `n = 1` and `n = 2`; otherwise Runge-Kutta of order four in steps of at
/// most a sixteenth of the natural length.
///
/// Not modelled: minor loops do not close (no return-point memory), as is known of this model.
/// Source: T. S. Low, W. Guo, *Modeling of a three-layer piezoelectric bimorph beam with
/// hysteresis*, Journal of Microelectromechanical Systems 4 (1995); normalised form and passivity:
/// F. Ikhouane, J. Rodellar, *Systems with Hysteresis* (2007), chapters 2 and 3; admissible
/// parameters: S. Erlicher, N. Point, *Thermodynamic admissibility of Bouc-Wen type hysteresis
/// models*, Comptes Rendus Mecanique 332 (2004).
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(try_from = "BoucWenParameters", into = "BoucWenParameters")]
pub struct BoucWen {
    parameters: BoucWenParameters,
}

stored_as_parameters!(BoucWen, BoucWenParameters);

/// The hysteretic variable, -1 to 1, and the voltage it belongs to, V.
#[derive(Debug, Clone, Copy, PartialEq, Serialize, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct BoucWenMemory {
    w: f64,
    voltage_volt: f64,
}

impl BoucWen {
    /// The model of the given numbers.
    ///
    /// # Errors
    /// [`PreisachError::OutOfRange`], [`PreisachError::NotFinite`].
    pub fn new(parameters: BoucWenParameters) -> Result<Self, PreisachError> {
        let p = &parameters;
        check_positive("gain_deg_per_volt", p.gain_deg_per_volt)?;
        check_positive("rise_volt", p.rise_volt)?;
        check_not_negative("half_height_deg", p.half_height_deg)?;
        p.envelope.check()?;
        let dissipates = p.sigma.is_finite() && p.sigma >= 0.5;
        check_that(
            dissipates,
            "sigma",
            p.sigma,
            "a finite number, 1/2 or more: less gives energy",
        )?;
        check_within("exponent", p.exponent, 1.0..=10.0)?;
        let (gain, steepest) =
            (p.gain_deg_per_volt, 2.0 * p.sigma * p.half_height_deg / p.rise_volt);
        let expected = format!(
            "up to the gain of {gain}, or the output falls while the voltage rises; raise rise_volt or \
             lower half_height_deg"
        );
        let rises = steepest <= gain * (1.0 + 1e-12);
        check_that(rises, "steepest slope of the loop (deg/V)", steepest, expected)?;
        Ok(Self { parameters })
    }

    /// Its numbers.
    pub fn parameters(&self) -> &BoucWenParameters {
        &self.parameters
    }

    /// The hysteretic variable after a change of the voltage.
    pub fn hysteretic_variable(&self, w: f64, change_volt: f64) -> f64 {
        let p = &self.parameters;
        let sign = 1.0_f64.copysign(change_volt);
        let length = change_volt.abs() / p.rise_volt;
        sign * rising(sign * w, length, 2.0 * p.sigma - 1.0, p.exponent)
    }

    fn moved(&self, memory: &mut BoucWenMemory, voltage_volt: f64) -> f64 {
        let p = &self.parameters;
        memory.w = self.hysteretic_variable(memory.w, voltage_volt - memory.voltage_volt);
        memory.voltage_volt = voltage_volt;
        let linear = p.gain_deg_per_volt * (voltage_volt - p.range_volt.middle_volt());
        let reference = 0.5 * p.gain_deg_per_volt * p.range_volt.span_volt();
        p.envelope.output_deg(linear - p.half_height_deg * memory.w, reference)
    }
}

/// `w` after its argument has risen by `length >= 0`.
///
/// ```text
/// w < 0:  dw/dx = 1 + k |w|^n        w >= 0:  dw/dx = 1 - w^n
/// ```
fn rising(w: f64, length: f64, k: f64, n: f64) -> f64 {
    if length == 0.0 {
        return w;
    }
    #[expect(clippy::float_cmp, reason = "the exponents with a closed solution, as written")]
    let value = if n == 1.0 {
        rising_exponent_1(w, length, k)
    } else if n == 2.0 {
        rising_exponent_2(w, length, k)
    } else {
        rising_runge_kutta(w, length, k, n)
    };
    value.clamp(-1.0, 1.0)
}

fn rising_exponent_1(w: f64, length: f64, k: f64) -> f64 {
    let positive = |w: f64, x: f64| w - (1.0 - w) * (-x).exp_m1();
    if w >= 0.0 {
        return positive(w, length);
    }
    let to_zero = if k == 0.0 { -w } else { (-k * w).ln_1p() / k };
    if length >= to_zero {
        positive(0.0, length - to_zero)
    } else if k == 0.0 {
        w + length
    } else {
        w - (1.0 / k - w) * (-k * length).exp_m1()
    }
}

fn rising_exponent_2(w: f64, length: f64, k: f64) -> f64 {
    let positive = |w: f64, x: f64| {
        let t = x.tanh();
        (w + t) / (1.0 + w * t)
    };
    if w >= 0.0 {
        return positive(w, length);
    }
    let root = k.sqrt();
    let to_zero = if k == 0.0 { -w } else { (-root * w).atan() / root };
    if length >= to_zero {
        positive(0.0, length - to_zero)
    } else if k == 0.0 {
        w + length
    } else {
        let t = (root * length).tan() / root;
        (w + t) / (1.0 - k * w * t)
    }
}

/// Classical Runge-Kutta steps of equal length.
fn rising_runge_kutta(w: f64, length: f64, k: f64, n: f64) -> f64 {
    let slope = |w: f64| {
        let power = w.abs().min(1.0).powf(n);
        if w < 0.0 { 1.0 + k * power } else { 1.0 - power }
    };
    // past 40 lengths of the slowest part the loop is its own limit
    let length = length.min(40.0);
    let steps = (16.0 * length * (1.0 + k) * n).ceil().clamp(1.0, 1e5);
    let h = length / steps;
    let mut now = w;
    let mut done = 0.0;
    while done < steps {
        let a = slope(now);
        let b = slope(now + 0.5 * h * a);
        let c = slope(now + 0.5 * h * b);
        let d = slope(now + h * c);
        now += h / 6.0 * (a + 2.0 * (b + c) + d);
        done += 1.0;
    }
    now
}

impl HysteresisLaw for BoucWen {
    type Memory = BoucWenMemory;

    fn start(&self, voltage_volt: f64, state: StartState) -> (BoucWenMemory, f64) {
        let memory = BoucWenMemory { w: 0.0, voltage_volt };
        let range = self.parameters.range_volt;
        state.led(memory, range, voltage_volt, |m, volt| self.moved(m, volt))
    }

    fn step(&self, memory: &mut BoucWenMemory, voltage_volt: f64, _: f64) -> f64 {
        self.moved(memory, voltage_volt)
    }

    fn check_memory(&self, memory: &BoucWenMemory) -> Result<(), PreisachError> {
        if memory.w.abs() <= 1.0 && memory.voltage_volt.is_finite() {
            Ok(())
        } else {
            Err(PreisachError::MemoryOfAnotherLaw { expected: "Bouc-Wen" })
        }
    }

    fn shifted(mut self, shift_deg: f64) -> Self {
        self.parameters.envelope.offset_deg += shift_deg;
        self
    }
}
