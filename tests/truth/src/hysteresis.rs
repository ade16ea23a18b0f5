//! Rate-independent hysteresis: populations of pinned domain walls (Jiles-Atherton type).
//!
//! ```text
//! P(u)        = L((u - u_c)/a),                      L(x) = coth x - 1/x          (anhysteretic)
//! e_j         = max(0, s (P(u) - m_j)) / P'(u),      s = sign(du)                 (lead, V)
//! s dm_j/du   = P'(u) (e_j / k_j(s))^2,              k_j(s) = k_j (1 + s b)
//! h(u)        = d (u - u_b) + S [ c P + (1 - c) sum_j w_j m_j - P(u_b) ],   sum_j w_j = 1
//! ```
//!
//! `u_b` is the bias, `m_j` the irreversible polarisation of the walls that are pinned by a voltage
//! `k_j`: they follow the anhysteretic curve at a distance of at most about `k_j` volts.
//!
//! Differs from source, in three points. Jiles and Atherton let the irreversible part run against
//! the field just after a reversal, which flattens or even inverts the slope there; here it moves
//! only in the dissipative direction, `max(0, .)`, as usual since. They release walls in proportion
//! to the lead; with the square few walls move at a small lead and all at `e = k`, so that a
//! reversal begins almost without loss and a small loop accommodates more slowly. And the
//! mean-field term (`H + alpha M`) is left out; several pinning strengths stand side by side
//! instead, which makes small loops relatively narrow.
//!
//! Minor loops accommodate with repetition (an 8 V loop: first by 0.2 %, in the end by 0.8 % of the
//! stroke) and then close, they are not congruent, and there is no exact return-point memory: no
//! Preisach operator contains this one. The slope is never
//! below `d`, and `m_j` never leaves the range of `P`: the output is bounded. The loop is
//! asymmetric about the bias since the bias is not the centre `u_c` of the Langevin function (a
//! poled ceramic driven from -20 to 150 V) and since pinning differs with the direction (`b`).
//!
//! Source: D. C. Jiles, D. L. Atherton, J. Magn. Magn. Mater. 61 (1986) 48-60 (wall pinning);
//! R. C. Smith, Z. Ounaies, J. Intell. Mater. Syst. Struct. 11 (2000) 62-79 (the same for
//! ferroelectrics); J. H. B. Deane, IEEE Trans. Magn. 30 (1994) 2795-2801 (the clipped irreversible
//! part). Named from memory: the equations above are the definition.

use crate::error::{TruthError, require};
use crate::stage::Stage;

/// Walls of one pinning strength.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct WallPopulation {
    /// Share `w_j` of the irreversible polarisation; all shares together are normalised to 1.
    pub weight: f64,
    /// Pinning strength `k_j`: the lead at which all these walls move, V.
    pub pinning_volt: f64,
}

/// Parameters of [`DomainWallHysteresis`].
#[derive(Debug, Clone, PartialEq)]
pub struct DomainWallParameters {
    /// Intrinsic (lossless) piezoelectric gain `d`, um/V.
    pub intrinsic_um_per_volt: f64,
    /// Displacement of full polarisation, `S`, um.
    pub polarisation_stroke_um: f64,
    /// Reversible share `c` of the polarisation, 0..1.
    pub reversible_share: f64,
    /// Centre `u_c` of the Langevin function, V.
    pub langevin_centre_volt: f64,
    /// Width `a` of the Langevin function, V.
    pub langevin_width_volt: f64,
    /// Relative difference `b` of the pinning between rising (+) and falling (-) voltage, -1..1.
    pub pinning_imprint: f64,
    /// The populations.
    pub populations: Vec<WallPopulation>,
    /// Voltage at which the displacement of the settled actuator is zero, `u_b`, V.
    pub bias_volt: f64,
}

/// The hysteresis stage: volts in, micrometres out.
#[derive(Debug, Clone)]
pub struct DomainWallHysteresis {
    parameters: DomainWallParameters,
    total_weight: f64,
    voltage_volt: f64,
    anhysteretic: f64,
    irreversible: Vec<f64>,
}

impl DomainWallHysteresis {
    /// A stage at rest at the bias.
    ///
    /// # Errors
    /// [`TruthError::Parameter`] for a width, weight or pinning that is not positive, a share
    /// outside 0..1, or an imprint outside -1..1.
    pub fn new(parameters: DomainWallParameters) -> Result<Self, TruthError> {
        const STAGE: &str = "domain-wall hysteresis";
        let p = &parameters;
        let positive = [
            ("intrinsic_um_per_volt", p.intrinsic_um_per_volt),
            ("polarisation_stroke_um", p.polarisation_stroke_um),
            ("langevin_width_volt", p.langevin_width_volt),
        ];
        for (name, value) in positive {
            require(value > 0.0, STAGE, name, value, "positive")?;
        }
        let share = p.reversible_share;
        require((0.0..=1.0).contains(&share), STAGE, "reversible_share", share, "in 0..1")?;
        let imprint = p.pinning_imprint;
        require(imprint.abs() < 1.0, STAGE, "pinning_imprint", imprint, "in -1..1")?;
        require(true, STAGE, "langevin_centre_volt", p.langevin_centre_volt, "finite")?;
        require(true, STAGE, "bias_volt", p.bias_volt, "finite")?;
        for walls in &p.populations {
            require(walls.weight > 0.0, STAGE, "weight", walls.weight, "positive")?;
            require(
                walls.pinning_volt > 0.0,
                STAGE,
                "pinning_volt",
                walls.pinning_volt,
                "positive",
            )?;
        }
        let total_weight: f64 = p.populations.iter().map(|walls| walls.weight).sum();
        require(
            total_weight > 0.0,
            STAGE,
            "populations (sum of weights)",
            total_weight,
            "positive",
        )?;
        let mut stage = Self {
            irreversible: vec![0.0; p.populations.len()],
            total_weight,
            voltage_volt: p.bias_volt,
            anhysteretic: 0.0,
            parameters,
        };
        stage.settle(stage.parameters.bias_volt);
        Ok(stage)
    }

    fn polarisation(&self, voltage_volt: f64) -> f64 {
        let p = &self.parameters;
        langevin((voltage_volt - p.langevin_centre_volt) / p.langevin_width_volt)
    }

    fn displacement_um(&self) -> f64 {
        let p = &self.parameters;
        let walls: f64 =
            p.populations.iter().zip(&self.irreversible).map(|(walls, m)| walls.weight * m).sum();
        let irreversible = walls / self.total_weight;
        let share = p.reversible_share;
        let polarisation = share * self.anhysteretic + (1.0 - share) * irreversible;
        p.intrinsic_um_per_volt * (self.voltage_volt - p.bias_volt)
            + p.polarisation_stroke_um * (polarisation - self.polarisation(p.bias_volt))
    }
}

impl Stage for DomainWallHysteresis {
    fn settle(&mut self, input: f64) -> f64 {
        self.voltage_volt = input;
        self.anhysteretic = self.polarisation(input);
        self.irreversible.fill(self.anhysteretic);
        self.displacement_um()
    }

    fn step(&mut self, input: f64, _dt_s: f64) -> f64 {
        let travel_volt = (input - self.voltage_volt).abs();
        if travel_volt > 0.0 {
            let sense = (input - self.voltage_volt).signum();
            let (from, to) = (self.anhysteretic, self.polarisation(input));
            let strength = 1.0 + sense * self.parameters.pinning_imprint;
            for (m, walls) in self.irreversible.iter_mut().zip(&self.parameters.populations) {
                let gap = pinned_gap(
                    sense * (from - *m),
                    sense * (to - from),
                    travel_volt,
                    walls.pinning_volt * strength,
                );
                *m = to - sense * gap;
            }
            self.voltage_volt = input;
            self.anhysteretic = to;
        }
        self.displacement_um()
    }
}

/// The gap between anhysteretic and irreversible polarisation after a stretch of monotone voltage.
///
/// ```text
/// dE/dv = q - max(0, E)^2 / (q k^2),   v = 0..V,   q = rise/V
///
/// E(V)  = K (E0 + K t)/(K + E0 t),     K = q k,    t = tanh(V/k)          while E0 >= 0
/// ```
/// | argument | symbol | unit | range |
/// |---|---|---|---|
/// | `gap` | `E0` | - | any; positive when the walls lag behind |
/// | `rise` | `q V` | - | >= 0, the anhysteretic curve is monotone |
/// | `travel_volt` | `V` | V | > 0 |
/// | `pinning_volt` | `k` | V | > 0 |
///
/// Returns `E(V)`, exact for a straight piece of the anhysteretic curve (`e = E/q` is the lead in
/// volts). Walls ahead of it (`E < 0`, just after a reversal) stay where they are until it has come
/// back to them; only the rest of the stretch moves them.
fn pinned_gap(gap: f64, rise: f64, travel_volt: f64, pinning_volt: f64) -> f64 {
    if rise <= 0.0 || gap + rise <= 0.0 {
        return gap + rise;
    }
    let free_share = (-gap / rise).max(0.0);
    let start = gap.max(0.0);
    let limit = rise / travel_volt * pinning_volt;
    let t = (travel_volt * (1.0 - free_share) / pinning_volt).tanh();
    limit * (start + limit * t) / (limit + start * t)
}

/// The Langevin function `coth x - 1/x`, dimensionless, in -1..1, odd and monotone.
pub fn langevin(x: f64) -> f64 {
    if x.abs() < 0.05 {
        let square = x * x;
        x / 3.0 * (1.0 - square / 15.0 * (1.0 - square * 2.0 / 21.0 * (1.0 - square / 10.0)))
    } else {
        1.0 / x.tanh() - 1.0 / x
    }
}
