//! The laws as the generated code knows them: equation, numbers, pieces of code.

use crate::ExportError;
use crate::constant::Constant;
use preisach_dyn::{
    ActuatorLaw, BoucWenParameters, DynamicParameters, Envelope, PlayMap, PrandtlParameters,
    PreisachGrid, RateForm, StaticPreisach, StopParameters, TimeOrder, VoltageRange,
};

/// A law ready to be written.
pub(crate) struct Law {
    pub(crate) title: &'static str,
    pub(crate) equation: &'static [&'static str],
    pub(crate) constants: Vec<Constant>,
    /// Piece that declares its memory.
    pub(crate) memory: &'static str,
    /// Pieces that hold its functions, in order.
    pub(crate) functions: Vec<&'static str>,
    /// Whether the inverse has to guess the rate to come.
    pub(crate) guesses_rate: bool,
}

impl Law {
    pub(crate) fn new(law: &ActuatorLaw, time_step_s: f64) -> Result<Self, ExportError> {
        let scalar = Constant::scalar;
        Ok(match law {
            ActuatorLaw::Linear(law) => Self {
                title: "linear gain",
                equation: &["delta = gain (u - bias)"],
                constants: vec![
                    scalar("GAIN_DEG_PER_VOLT", law.gain_deg_per_volt, "deg/V", "gain"),
                    scalar("BIAS_VOLT", law.bias_volt, "V", "voltage of zero flap angle"),
                ],
                memory: "linear.type",
                functions: vec!["linear.functions"],
                guesses_rate: false,
            },
            ActuatorLaw::StaticPreisach(law) => statics(law),
            ActuatorLaw::DynamicPreisach(law) => dynamics(law.parameters(), time_step_s),
            ActuatorLaw::PrandtlIshlinskii(law) => prandtl(law.parameters()),
            ActuatorLaw::BoucWen(law) => bouc_wen(law.parameters()),
            ActuatorLaw::PrandtlStop(law) => stops(law.parameters()),
            other => return Err(ExportError::Law { law: other.name() }),
        })
    }
}

/// Levels, lower end and cell of a grid.
fn grid_constants(grid: &PreisachGrid) -> Vec<Constant> {
    let lowest = grid.range().lowest_volt();
    vec![
        Constant::count("LEVELS", grid.levels(), "number of plays"),
        Constant::scalar("GRID_LOWEST_VOLT", lowest, "V", "lower end of the grid"),
        Constant::scalar("CELL_VOLT", grid.cell_volt(), "V", "side of a cell of the grid"),
    ]
}

/// The static map, in both Preisach laws.
fn static_map(map: &PlayMap) -> [Constant; 2] {
    [
        Constant::scalar("CONSTANT_DEG", map.constant, "deg", "part of G0 that remembers nothing"),
        Constant::triangle(
            "G0_DEG",
            &map.nodes,
            "deg",
            "what play j adds to G0 at its knots: row j, from the lowest centre up",
        ),
    ]
}

fn statics(law: &StaticPreisach) -> Law {
    let mut constants = grid_constants(law.grid());
    constants.extend(static_map(law.map()));
    Law {
        title: "static Preisach",
        equation: &[
            "delta = constant + sum_j g_j(w_j),   w_j <- max(u - r_j, min(u + r_j, w_j))",
            "r_j = j cell / 2,  g_j straight between knots",
            "Source: Viswamurthy and Ganguli, eq. (2); Brokate and Sprekels (1996), section 2.4.",
        ],
        constants,
        memory: "plays.type",
        functions: vec!["plays.plays", "plays.functions"],
        guesses_rate: false,
    }
}

fn dynamics(p: &DynamicParameters, time_step_s: f64) -> Law {
    let scalar = Constant::scalar;
    let mut constants = grid_constants(&p.grid);
    constants.extend(static_map(&p.g0_deg));
    constants.extend([
        scalar("CONSTANT_S", p.g1_s.constant, "s", "part of G1 that remembers nothing"),
        Constant::triangle("G1_S", &p.g1_s.nodes, "s", "what the plays add to G1, as above"),
        scalar("CONSTANT_S2_PER_DEG", p.g2_s2_per_deg.constant, "s^2/deg", "likewise of G2"),
        Constant::triangle(
            "G2_S2_PER_DEG",
            &p.g2_s2_per_deg.nodes,
            "s^2/deg",
            "what the plays add to G2, as above",
        ),
    ]);
    // the backward difference after the first step, from equal steps
    let [now, before, scale, weight_s] = match p.time_order {
        TimeOrder::First => [1.0, 0.0, 1.0, time_step_s],
        TimeOrder::Second => {
            let scale = 1.0 / (1.0 + 2.0);
            [4.0, 1.0, scale, 2.0 * time_step_s * scale]
        }
    };
    // of the other form nothing is known
    let unfolded = if p.form == RateForm::WellPosed { p.unfolded_rate_deg_s } else { 0.0 };
    constants.extend([
        scalar("NOW", now, "", "backward difference: factor of the output"),
        scalar("BEFORE", before, "", "factor of the output before"),
        scalar("SCALE", scale, "", "factor of both"),
        scalar("WEIGHT_S", weight_s, "s", "factor of the rate"),
        scalar("UNFOLDED_DEG_PER_S", unfolded, "deg/s", "rate up to which nothing folds"),
    ]);
    Law {
        title: match p.time_order {
            TimeOrder::First => "dynamic Preisach, implicit Euler steps",
            TimeOrder::Second => "dynamic Preisach, steps of second order (BDF2)",
        },
        equation: &[
            "delta = G0 + d G1 + d^2 G2,   d = d(delta)/dt",
            "G = constant + sum_j g_j(w_j),   w_j <- max(u - r_j, min(u + r_j, w_j)),   r_j = j cell / 2",
            "Source: Viswamurthy and Ganguli, eq. (5), after Mayergoyz (1988).",
        ],
        constants,
        memory: "dynamic.type",
        functions: vec!["plays.plays", "dynamic.functions"],
        guesses_rate: false,
    }
}

/// Middle of the range and the output curve, and the piece that holds it.
fn envelope_constants(
    range: VoltageRange,
    slope_deg_per_volt: f64,
    envelope: &Envelope,
) -> (Vec<Constant>, &'static str) {
    let scalar = Constant::scalar;
    let reference_deg = 0.5 * slope_deg_per_volt * range.span_volt();
    let mut constants = vec![
        scalar("MIDDLE_VOLT", range.middle_volt(), "V", "middle of the voltage range"),
        scalar("OFFSET_DEG", envelope.offset_deg, "deg", "output at rest there"),
    ];
    if reference_deg == 0.0 {
        return (constants, "prandtl.flat");
    }
    constants.extend([
        scalar("REFERENCE_DEG", reference_deg, "deg", "largest z"),
        scalar("QUADRATIC", envelope.quadratic, "", "factor of zeta^2 in the output curve"),
        scalar("CUBIC", envelope.cubic, "", "factor of zeta^3 in the output curve"),
    ]);
    (constants, "prandtl.envelope")
}

/// Lists of at least one: no language but some have empty ones.
fn at_least_one(values: impl Iterator<Item = f64>) -> Vec<f64> {
    let mut values: Vec<f64> = values.collect();
    if values.is_empty() {
        values.push(0.0);
    }
    values
}

fn prandtl(p: &PrandtlParameters) -> Law {
    // the inverse in C takes the narrowest first
    let mut plays = p.plays.clone();
    plays.sort_by(|a, b| a.threshold_volt.total_cmp(&b.threshold_volt));
    let thresholds = at_least_one(plays.iter().map(|play| play.threshold_volt));
    let weights = at_least_one(plays.iter().map(|play| play.weight_deg_per_volt));
    let slope =
        p.plays.iter().fold(p.gain_deg_per_volt, |sum, play| sum + play.weight_deg_per_volt);
    let (envelope, curve) = envelope_constants(p.range_volt, slope, &p.envelope);
    let gain = ("GAIN_DEG_PER_VOLT", p.gain_deg_per_volt);
    let mut constants = vec![
        Constant::count("PLAYS", thresholds.len(), "number of plays"),
        Constant::scalar(gain.0, gain.1, "deg/V", "slope q of the reversible part"),
        Constant::list("THRESHOLD_VOLT", thresholds, "V", "half-widths r_i at vanishing rate"),
        Constant::list("WEIGHT_DEG_PER_VOLT", weights, "deg/V", "weights p_i"),
        Constant::scalar(
            "GROWTH_S",
            p.threshold_growth_s,
            "s",
            "growth b of half-widths with rate",
        ),
    ];
    constants.extend(envelope);
    Law {
        title: "rate-dependent Prandtl-Ishlinskii",
        equation: &[
            "z = q (u - u_mid) + sum_i p_i (w_i - u_mid),   w_i <- max(u - R_i, min(u + R_i, w_i))",
            "R_i = r_i + b |du/dt|",
            "delta = offset + z (1 + quadratic zeta + cubic zeta^2),   zeta = z / reference",
            "Source: Al Janaideh, Rakheja, Su, IEEE/ASME Trans. Mechatronics 16 (2011).",
        ],
        constants,
        memory: "prandtl.type",
        functions: vec![curve, "prandtl.functions"],
        guesses_rate: p.threshold_growth_s > 0.0,
    }
}

fn bouc_wen(p: &BoucWenParameters) -> Law {
    let scalar = Constant::scalar;
    let (envelope, curve) = envelope_constants(p.range_volt, p.gain_deg_per_volt, &p.envelope);
    let mut constants = vec![
        scalar("GAIN_DEG_PER_VOLT", p.gain_deg_per_volt, "deg/V", "slope of the reversible part"),
        scalar("HALF_HEIGHT_DEG", p.half_height_deg, "deg", "half the height z0 of a wide loop"),
        scalar("RISE_VOLT", p.rise_volt, "V", "voltage over which a loop opens"),
        scalar("K", 2.0 * p.sigma - 1.0, "", "2 sigma - 1"),
    ];
    #[expect(clippy::float_cmp, reason = "the exponents with a closed solution, as written")]
    let exponent = if p.exponent == 1.0 {
        "bouc_wen.exponent_1"
    } else if p.exponent == 2.0 {
        "bouc_wen.exponent_2"
    } else {
        constants.push(scalar("EXPONENT", p.exponent, "", "exponent n"));
        "bouc_wen.exponent_n"
    };
    constants.extend(envelope);
    Law {
        title: "Bouc-Wen",
        equation: &[
            "z = gain (u - u_mid) - z0 w",
            "dw = [ 1 - sigma sgn(du) |w|^(n-1) w + (sigma - 1) |w|^n ] du / rise",
            "delta = offset + z (1 + quadratic zeta + cubic zeta^2),   zeta = z / reference",
            "Source: Low and Guo, J. Microelectromechanical Systems 4 (1995); Ikhouane and Rodellar (2007).",
        ],
        constants,
        memory: "bouc_wen.type",
        functions: vec![curve, exponent, "bouc_wen.functions"],
        guesses_rate: false,
    }
}

fn stops(p: &StopParameters) -> Law {
    let scalar = Constant::scalar;
    let thresholds = at_least_one(p.stops.iter().map(|stop| stop.threshold_volt));
    let stiffnesses = at_least_one(p.stops.iter().map(|stop| stop.stiffness_deg_per_volt));
    let viscosity = ("VISCOSITY_DEG_S_PER_VOLT", p.viscosity_deg_s_per_volt);
    Law {
        title: "Prandtl-Ishlinskii stops",
        equation: &[
            "y = offset + k (u - u_mid) + sum_i w_i (u - p_i) + c du/dt",
            "p_i <- max(u - r_i, min(u + r_i, p_i))",
            "Source: Brokate and Sprekels (1996), chapter 2; Iwan, J. Applied Mechanics 34 (1967).",
        ],
        constants: vec![
            Constant::count("STOPS", thresholds.len(), "number of stops"),
            scalar("MIDDLE_VOLT", p.range_volt.middle_volt(), "V", "middle of the voltage range"),
            scalar("OFFSET_DEG", p.offset_deg, "deg", "output at rest there"),
            scalar("STIFFNESS_DEG_PER_VOLT", p.stiffness_deg_per_volt, "deg/V", "elastic part k"),
            scalar(viscosity.0, viscosity.1, "deg s/V", "viscosity c"),
            Constant::list("THRESHOLD_VOLT", thresholds, "V", "travel r_i from rest to slip"),
            Constant::list(
                "STOP_DEG_PER_VOLT",
                stiffnesses,
                "deg/V",
                "stiffnesses w_i of the stops",
            ),
        ],
        memory: "stops.type",
        functions: vec!["stops.functions"],
        guesses_rate: false,
    }
}
