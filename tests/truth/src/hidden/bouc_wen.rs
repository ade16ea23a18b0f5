//! Rate-independent hysteresis of several Bouc-Wen elements side by side.
//!
//! ```text
//! dz_j/du = 1 - (z_j/Z_j)^2 (b + (1 - b) sgn(du z_j)),   Z_j(s) = Z_j (1 + s a),   s = sgn du
//! h(u)    = - S sum_j w_j z_j/Z_j
//! ```
//! With `b > 1/2` an element unloads steeper than straight and closes its small loops only slowly:
//! neither wiping-out nor congruency holds, no Preisach operator contains this one.
//!
//! The elements hold a reversible motion back, as T. S. Low, W. Guo, J. Microelectromech. Syst. 4 (1995)
//! 230-237 write it for a piezo actuator.
//!
//! Source: Y.-K. Wen, J. Eng. Mech. Div. ASCE 102 (1976) 249-263. Differs from source: several elements, and
//! strengths that depend on the direction (`a`).

use crate::stage::Stage;

/// Parameters of [`BoucWen`].
#[derive(Debug, Clone, PartialEq)]
pub struct BoucWenParameters {
    /// Largest pull of all elements together, `S`, um: it holds the motion back.
    pub stroke_um: f64,
    /// Share `w_j` and strength `Z_j` (V) of each element.
    pub elements: Vec<(f64, f64)>,
    /// Shape `b`.
    pub shape: f64,
    /// Asymmetry `a` of the strengths.
    pub asymmetry: f64,
}

/// Largest voltage step that is taken at once, V.
const LARGEST_STEP_VOLT: f64 = 0.7;

/// The elements with their state.
#[derive(Debug, Clone)]
pub struct BoucWen {
    parameters: BoucWenParameters,
    voltage_volt: f64,
    z_volt: Vec<f64>,
}

impl BoucWen {
    /// Elements at rest.
    pub fn new(parameters: BoucWenParameters, rest_volt: f64) -> Self {
        let z_volt = vec![0.0; parameters.elements.len()];
        Self { parameters, voltage_volt: rest_volt, z_volt }
    }

    fn output_um(&self) -> f64 {
        let p = &self.parameters;
        let elements = p.elements.iter().zip(&self.z_volt);
        -p.stroke_um * elements.map(|((share, strength), z)| share * z / strength).sum::<f64>()
    }
}

impl Stage for BoucWen {
    fn settle(&mut self, input: f64) -> f64 {
        self.voltage_volt = input;
        self.z_volt.fill(0.0);
        self.output_um()
    }

    fn step(&mut self, input: f64, _dt_s: f64) -> f64 {
        let travel = input - self.voltage_volt;
        let sense = travel.signum();
        let p = &self.parameters;
        let pieces = (travel.abs() / LARGEST_STEP_VOLT).ceil();
        let du = travel / pieces.max(1.0);
        for ((_, strength), z) in p.elements.iter().zip(&mut self.z_volt) {
            let limit = strength * (1.0 + sense * p.asymmetry);
            let slope = |z: f64| {
                let share = z / limit;
                1.0 - share * share * (p.shape + (1.0 - p.shape) * (sense * z).signum())
            };
            let mut left = pieces;
            while left > 0.5 {
                let middle = *z + 0.5 * du * slope(*z);
                *z += du * slope(middle);
                left -= 1.0;
            }
        }
        self.voltage_volt = input;
        self.output_um()
    }
}
