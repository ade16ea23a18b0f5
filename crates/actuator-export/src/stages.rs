//! The stages around the law as the generated code knows them.

use crate::ExportError;
use crate::constant::Constant;
use preisach_dyn::{ActuatorModel, AmplifierStage, LinkageStage, Resonance};
use std::f64::consts::TAU;

/// What a stage does.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
pub(crate) enum Kind {
    Lags,
    Delay,
    Saturation,
    CurrentLimit,
    Accommodation,
    Resonance,
    Backlash,
    Friction,
    Load,
}

impl Kind {
    /// Name of its pieces of code.
    pub(crate) fn piece(self) -> &'static str {
        match self {
            Self::Lags => "lags",
            Self::Delay => "delay",
            Self::Saturation => "saturation",
            Self::CurrentLimit => "current_limit",
            Self::Accommodation => "accommodation",
            Self::Resonance => "resonance",
            Self::Backlash => "backlash",
            Self::Friction => "friction",
            Self::Load => "load",
        }
    }

    pub(crate) fn title(self) -> &'static str {
        match self {
            Self::Lags => "first-order lags",
            Self::Delay => "transport delay",
            Self::Saturation => "voltage limits",
            Self::CurrentLimit => "slew limit",
            Self::Accommodation => "accommodation: a share that settles with the way travelled",
            Self::Resonance => "one mechanical mode",
            Self::Backlash => "lost motion",
            Self::Friction => "dry friction against an elastic linkage",
            Self::Load => "load spring",
        }
    }

    pub(crate) fn equation(self) -> &'static [&'static str] {
        match self {
            Self::Lags => &[
                "y = u + total (u - u_start) + sum_i weight_i (x_i - u),   tau_i dx_i/dt + x_i = u",
            ],
            Self::Delay => &["y(t) = u(t - delay)"],
            Self::Saturation => {
                &["y = max(low, min(high, u)), rounded off within a knee before the limits"]
            }
            Self::CurrentLimit => &["|dy/dt| <= slew rate"],
            Self::Accommodation => &["y = x - share e,   de = (1 - sgn(dx) e / travel) dx"],
            Self::Resonance => &["y'' + 2 zeta w y' + w^2 y = w^2 x"],
            Self::Backlash => &["y <- max(x - width / 2, min(x + width / 2, y))"],
            Self::Friction => &["x = y + e,   de = stiffness (1 - sgn(dy) e / limit) dy"],
            Self::Load => &["y = x / (1 + stiffness ratio)"],
        }
    }

    /// Whether it remembers anything.
    pub(crate) fn remembers(self) -> bool {
        !matches!(self, Self::Saturation | Self::Load)
    }

    /// Whether its inverse remembers more than it does itself.
    pub(crate) fn has_history(self) -> bool {
        matches!(self, Self::Lags | Self::Resonance)
    }
}

/// A list of stages of an actuator.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum List {
    Amplifier,
    Linkage,
}

impl List {
    pub(crate) fn unit(self) -> &'static str {
        match self {
            Self::Amplifier => "V",
            Self::Linkage => "deg",
        }
    }
}

/// A stage ready to be written.
pub(crate) struct Stage {
    pub(crate) list: List,
    /// Its name in the generated code, such as `linkage1`.
    pub(crate) id: String,
    /// Its name for people, such as `linkage[0] (Relaxation)`.
    pub(crate) place: String,
    pub(crate) kind: Kind,
    pub(crate) constants: Vec<Constant>,
}

/// Most samples that a delay keeps.
const LARGEST_DELAY: usize = 4096;

/// Stiffness of a contact before it slips over that of the linkage, as in the source model.
const CONTACT_STIFFNESS: f64 = 10.0;

/// The amplifier stages that do anything.
pub(crate) fn amplifier(
    model: &ActuatorModel,
    time_step_s: f64,
) -> Result<Vec<Stage>, ExportError> {
    let scalar = Constant::scalar;
    let mut stages = Vec::new();
    for (index, stage) in model.amplifier.iter().enumerate() {
        let (name, kind, constants) = match stage {
            AmplifierStage::Lag(lag) => {
                ("Lag", Kind::Lags, lags(&[(1.0, lag.tau_s)], false, time_step_s))
            }
            AmplifierStage::CurrentLimit(limit) => {
                let most = limit.slew_rate_volt_per_s * time_step_s;
                let most = scalar("MOST_VOLT", most, "V", "largest change over a time step");
                ("CurrentLimit", Kind::CurrentLimit, vec![most])
            }
            AmplifierStage::Saturation(s) => {
                let constants = vec![
                    scalar("LOW_VOLT", s.v_min_volt, "V", "lower limit"),
                    scalar("HIGH_VOLT", s.v_max_volt, "V", "upper limit"),
                    scalar("KNEE_VOLT", s.knee_volt, "V", "half-width of the knee before both"),
                ];
                ("Saturation", Kind::Saturation, constants)
            }
            AmplifierStage::Delay(delay) => {
                ("Delay", Kind::Delay, delayed(index, delay.delay_s / time_step_s)?)
            }
            AmplifierStage::DielectricHeating(_) => return refused(index, "DielectricHeating"),
            AmplifierStage::Depolarisation(_) => return refused(index, "Depolarisation"),
            _ => return refused(index, "of a kind unknown here"),
        };
        let place = format!("amplifier[{index}] ({name})");
        let id = format!("amplifier{}", index + 1);
        stages.push(Stage { list: List::Amplifier, id, place, kind, constants });
    }
    stages.retain(|stage| !stage.constants.is_empty());
    Ok(stages)
}

fn refused(index: usize, stage: &'static str) -> Result<Vec<Stage>, ExportError> {
    Err(ExportError::Stage { list: "amplifier", index, stage })
}

/// The linkage stages that do anything.
pub(crate) fn linkage(model: &ActuatorModel, time_step_s: f64) -> Result<Vec<Stage>, ExportError> {
    let deg = model.calibration.deg_per_um.abs();
    let scalar = Constant::scalar;
    let mut stages = Vec::new();
    for (index, stage) in model.linkage.iter().enumerate() {
        let (name, kind, constants) = match stage {
            LinkageStage::LogCreep(creep) => {
                ("LogCreep", Kind::Lags, lags(&creep.lags(), true, time_step_s))
            }
            LinkageStage::KelvinVoigt(creep) => {
                let elements = creep.elements.iter();
                let terms = elements.map(|e| (e.compliance_ratio, e.time_constant_s));
                ("KelvinVoigt", Kind::Lags, lags(&terms.collect::<Vec<_>>(), true, time_step_s))
            }
            LinkageStage::Relaxation(relaxation) => {
                let elements = relaxation.elements.iter();
                let terms = elements.map(|e| (e.share, e.time_constant_s));
                ("Relaxation", Kind::Lags, lags(&terms.collect::<Vec<_>>(), false, time_step_s))
            }
            LinkageStage::Accommodation(a) => {
                let constants = vec![
                    scalar("TRAVEL_DEG", a.travel_um * deg, "deg", "way after which it settles"),
                    scalar("SHARE", a.share, "", "share of the motion that settles late"),
                ];
                ("Accommodation", Kind::Accommodation, constants)
            }
            LinkageStage::Resonance(mode) => {
                ("Resonance", Kind::Resonance, resonance(mode, time_step_s))
            }
            LinkageStage::Backlash(gap) => {
                let half = 0.5 * gap.width_um * deg;
                let constant = scalar("HALF_WIDTH_DEG", half, "deg", "half the width of the gap");
                ("Backlash", Kind::Backlash, unless_zero(half, vec![constant]))
            }
            LinkageStage::CoulombFriction(friction) => {
                let limit = 0.5 * friction.width_um * deg;
                let stiffness = "of the contact before it slips over that of the linkage";
                let constants = vec![
                    scalar("LIMIT_DEG", limit, "deg", "largest stretch of the linkage"),
                    scalar("STIFFNESS", CONTACT_STIFFNESS, "", stiffness),
                ];
                ("CoulombFriction", Kind::Friction, unless_zero(limit, constants))
            }
            LinkageStage::LoadStiffness(load) => {
                let share = 1.0 / (1.0 + load.stiffness_ratio);
                let constant =
                    scalar("SHARE", share, "", "what the load spring leaves of the angle");
                ("LoadStiffness", Kind::Load, vec![constant])
            }
            _ => {
                let stage = "of a kind unknown here";
                return Err(ExportError::Stage { list: "linkage", index, stage });
            }
        };
        let place = format!("linkage[{index}] ({name})");
        let id = format!("linkage{}", index + 1);
        stages.push(Stage { list: List::Linkage, id, place, kind, constants });
    }
    stages.retain(|stage| !stage.constants.is_empty());
    Ok(stages)
}

/// No constants, thus no stage, where a width is zero.
fn unless_zero(width: f64, constants: Vec<Constant>) -> Vec<Constant> {
    if width > 0.0 { constants } else { Vec::new() }
}

/// Constants of lags of given weights and time constants (s). Creep grows from where the record starts, and its weights
/// come on top.
///
/// ```text
/// forward: d_i <- e d_i - phi (change of u),   x = h / tau,   e = exp(-x),   phi = (1 - e) / x
/// inverse: x_i = base_i + share_i (u - base_i),   share = s / (1 + s),   s = 2 h / (3 tau)
/// ```
fn lags(terms: &[(f64, f64)], creeps: bool, step_s: f64) -> Vec<Constant> {
    if terms.is_empty() {
        return Vec::new();
    }
    let weights: Vec<f64> = terms.iter().map(|(weight, _)| *weight).collect();
    let total = if creeps { weights.iter().sum() } else { 0.0 };
    let each = |of: fn(f64) -> f64, without: f64| {
        let value = |&(_, tau_s): &(f64, f64)| {
            if tau_s == 0.0 { without } else { of(step_s / tau_s) }
        };
        terms.iter().map(value).collect::<Vec<f64>>()
    };
    let decays = each(|x| (-x).exp(), 0.0);
    let ramps = each(|x| -(-x).exp_m1() / x, 0.0);
    let shares = each(|x| 2.0 * x / (3.0 + 2.0 * x), 1.0);
    let late = weights.iter().zip(&shares).map(|(weight, share)| weight * (1.0 - share));
    let slope = 1.0 + total - late.sum::<f64>();
    vec![
        Constant::count("LAGS", terms.len(), "number of lags"),
        Constant::list("WEIGHT", weights, "", "weight of each lag"),
        Constant::scalar("TOTAL", total, "", "sum of weights that come on top"),
        Constant::list("DECAY", decays, "", "what a step leaves of a deviation"),
        Constant::list("RAMP", ramps, "", "deviation for a change over a step"),
        Constant::list("SHARE", shares, "", "inverse: what a lag takes of a step"),
        Constant::scalar("SLOPE", slope, "", "inverse: output for a change of the input"),
    ]
}

/// Constants of a delay of some time steps.
fn delayed(index: usize, steps: f64) -> Result<Vec<Constant>, ExportError> {
    let whole = steps.ceil();
    let counts = 1..=LARGEST_DELAY;
    if whole == 0.0 {
        return Ok(Vec::new());
    }
    let Some(samples) = counts.into_iter().find(|&count| count as f64 >= whole) else {
        let factor = (steps / LARGEST_DELAY as f64 * 100.0).ceil() / 100.0;
        return Err(ExportError::Delay { index, samples: whole, largest: LARGEST_DELAY, factor });
    };
    Ok(vec![
        Constant::count("SAMPLES", samples, "samples under way"),
        Constant::scalar("SHARE", whole - steps, "", "place between the oldest and the next"),
    ])
}

/// Constants of a mode: the matrix exponential of the homogeneous motion over a step, and the weights of the inverse.
fn resonance(mode: &Resonance, step_s: f64) -> Vec<Constant> {
    let [[place, of_rate], [pull, rate]] = mode.free_motion(step_s);
    let lead_s = mode.lead_s();
    let second = 1.0 / (TAU * mode.frequency_hz * step_s).powi(2);
    let scalar = Constant::scalar;
    vec![
        scalar("LEAD_S", lead_s, "s", "a ramp is followed this much later"),
        scalar("PLACE_OF_PLACE", place, "", "free motion over a step: place from place"),
        scalar("PLACE_OF_RATE", of_rate, "s", "place from rate"),
        scalar("RATE_OF_PLACE", pull, "1/s", "rate from place"),
        scalar("RATE_OF_RATE", rate, "", "rate from rate"),
        scalar("FIRST", lead_s / (2.0 * step_s), "", "inverse: factor of the first difference"),
        scalar("SECOND", second, "", "inverse: factor of the second difference"),
    ]
}
