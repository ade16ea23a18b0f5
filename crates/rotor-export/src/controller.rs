//! A controller that flies as C99.

use crate::RotorExportError;
use actuator_export::{Library, check_name, filled, number, prefixed, wrapped};
use hhc_control::{
    ControlError, ControlLayout, EstimatorSettings, HarmonicAnalyser, LoadEstimator,
    OperatingPoint, RelaxedController, RelaxedSettings, TMatrix,
};
use std::f64::consts::TAU;

const HEADER: &str = include_str!("../templates/controller.h");
const SOURCE: &str = include_str!("../templates/controller.c");
const KNOWLEDGE: &str = include_str!("../templates/knowledge.c");

/// Longest line of a list of numbers, characters.
const WIDTH: usize = 110;

/// How a controller knows T.
#[derive(Debug, Clone, PartialEq)]
pub enum TKnowledge {
    /// Held, 1/V.
    Fixed(TMatrix),
    /// Linear over the advance ratio between knots that rise, held beyond their ends.
    Scheduled {
        /// The knots.
        advance_ratios: Vec<f64>,
        /// T of each knot, 1/V.
        t: Vec<TMatrix>,
    },
    /// Estimated with Z0 and the noise, as by [`LoadEstimator`].
    Adaptive {
        /// Of the estimate.
        settings: EstimatorSettings,
        /// T at the start, 1/V.
        t0: TMatrix,
        /// Loads at the start without control, nondimensional.
        baseline: Vec<f64>,
    },
}

impl TKnowledge {
    /// Its T, one or one of each knot.
    fn matrices(&self) -> &[TMatrix] {
        match self {
            Self::Fixed(t) | Self::Adaptive { t0: t, .. } => std::slice::from_ref(t),
            Self::Scheduled { t, .. } => t,
        }
    }

    fn word(&self) -> &'static str {
        match self {
            Self::Fixed(_) => "fixed",
            Self::Scheduled { .. } => "scheduled",
            Self::Adaptive { .. } => "adaptive",
        }
    }
}

/// Everything that a generated controller holds.
#[derive(Debug, Clone, PartialEq)]
pub struct ControllerSpec {
    /// What it is of, one line.
    pub title: String,
    /// Flaps and harmonics of the control.
    pub layout: ControlLayout,
    /// Weights and limits.
    pub settings: RelaxedSettings,
    /// What it knows of T.
    pub knowledge: TKnowledge,
    /// Signals of a sample: name with unit, and what a nondimensional load of 1 is in that unit.
    pub channels: Vec<(String, f64)>,
    /// Harmonic of the loads, per rev: the blade number.
    pub load_harmonic: u32,
    /// Samples of a revolution, above twice the harmonic of the loads.
    pub samples_per_rev: usize,
    /// Revolutions of a cycle that settle, and those that are measured, 1 or more.
    pub cycle_rev: [usize; 2],
}

/// Header and source, name and text of each, of a controller that does what the steppers of [`hhc_control`] do:
/// [`HarmonicAnalyser`] over the window of a cycle, then [`hhc_control::CycleController`] for an estimated T or
/// [`RelaxedController`] for one that is given.
///
/// # Errors
/// [`RotorExportError`]: a name that is no identifier, settings or matrices that the controller refuses.
pub fn controller_files(
    spec: &ControllerSpec,
    name: &str,
) -> Result<[(String, String); 2], RotorExportError> {
    check_name(name)?;
    let known = check(spec)?;
    let library = Library::new(&[KNOWLEDGE]);
    let piece = |part: &str| library.piece(&format!("{}.{part}", spec.knowledge.word())).to_owned();
    let counts = [
        ("flaps", spec.layout.flaps()),
        ("harmonics", spec.layout.harmonics().len()),
        ("controls", spec.layout.len()),
        ("channels", spec.channels.len()),
        ("loads", 2 * spec.channels.len()),
        ("samples_per_rev", spec.samples_per_rev),
        ("settling_rev", spec.cycle_rev[0]),
        ("window_rev", spec.cycle_rev[1]),
    ]
    .map(|(key, count)| (key, count.to_string()));
    let channels: Vec<&str> = spec.channels.iter().map(|(name, _)| name.as_str()).collect();
    let mut words: Vec<(&str, String)> = vec![
        ("state", piece("state")),
        ("t_code", piece("code")),
        ("t_start", piece("start")),
        ("t_now", piece("now")),
        ("t_volt", piece("volt").trim().to_owned()),
        ("t_after", piece("after")),
        ("t_lose_flap", piece("lose_flap")),
        ("constants", constants(spec, known)),
        ("about", prefixed(&about(spec), " * ")),
        ("channel_names", channels.join(", ")),
    ];
    words.extend(counts);
    words.extend([
        ("title", spec.title.replace("*/", "* /")),
        ("name", name.to_owned()),
        ("NAME", name.to_uppercase()),
    ]);
    let words: Vec<(&str, &str)> = words.iter().map(|(key, text)| (*key, text.as_str())).collect();
    let text = |template: &str| {
        let lines = filled(template, &words);
        // where a word is nothing its line holds its indent alone
        let lines: Vec<&str> = lines.lines().map(str::trim_end).collect();
        lines.join("\n") + "\n"
    };
    Ok([(format!("{name}.h"), text(HEADER)), (format!("{name}.c"), text(SOURCE))])
}

/// The controller as it starts, with everything refused that its parts refuse.
fn check(spec: &ControllerSpec) -> Result<Known, RotorExportError> {
    let loads = 2 * spec.channels.len();
    let [_, window_rev] = spec.cycle_rev;
    let (channels, samples) = (spec.channels.len(), spec.samples_per_rev);
    HarmonicAnalyser::new(channels, samples, window_rev, &[spec.load_harmonic])?;
    RelaxedController::new(&spec.layout, loads, spec.settings.clone())?;
    for (_, unit) in &spec.channels {
        let is_unit = unit.is_finite() && *unit > 0.0;
        if !is_unit {
            return Err(ControlError::OutOfRange {
                what: "unit of a load",
                value: *unit,
                expected: "above 0",
            }
            .into());
        }
    }
    for t in spec.knowledge.matrices() {
        for (what, found, expected) in [
            ("loads of the T matrix", t.loads(), loads),
            ("controls of the T matrix", t.controls(), spec.layout.len()),
        ] {
            if found != expected {
                return Err(ControlError::Length { what, found, expected }.into());
            }
        }
    }
    match &spec.knowledge {
        TKnowledge::Fixed(_) => Ok(Known::None),
        TKnowledge::Scheduled { advance_ratios, t } => {
            let rise = advance_ratios.windows(2).all(|pair| pair[0] < pair[1]);
            if !rise || advance_ratios.is_empty() || advance_ratios.len() != t.len() {
                let (knots, matrices) = (advance_ratios.len(), t.len());
                return Err(RotorExportError::Schedule { knots, matrices });
            }
            Ok(Known::None)
        }
        TKnowledge::Adaptive { settings, t0, baseline } => {
            let control_volt = &spec.layout.zero();
            let start = OperatingPoint { control_volt, outputs: baseline };
            let covariance = LoadEstimator::new(settings, t0, start)?.covariance().clone();
            Ok(Known::Estimate { noise: covariance[(0, 0)], prior: covariance[(1, 1)] })
        }
    }
}

/// Variances that an estimate starts with.
enum Known {
    None,
    Estimate { noise: f64, prior: f64 },
}

/// What the header says of it.
fn about(spec: &ControllerSpec) -> Vec<String> {
    let harmonics: Vec<String> = spec.layout.harmonics().iter().map(u32::to_string).collect();
    let t = match &spec.knowledge {
        TKnowledge::Fixed(_) => "T: of the start of the flight, held.",
        TKnowledge::Scheduled { .. } => {
            "T: linear over the advance ratio between knots, held beyond them."
        }
        TKnowledge::Adaptive { .. } => "T: estimated with Z0 and the noise by a Kalman filter.",
    };
    let (settling, window) = (spec.cycle_rev[0], spec.cycle_rev[1]);
    [
        "Higher harmonic control of the flaps of a rotor, one cycle at a time:".to_owned(),
        format!(
            "    of its revolutions {settling} settle, {window} are measured; then the control changes."
        ),
        String::new(),
        format!("    loads    Z = harmonics of the hub loads at {} per rev", spec.load_harmonic),
        "    cost     J = E(Z'WZ)/q + rho u'u + du'S du,   Z = Z_here + T du,   q: chance that a flap acts".to_owned(),
        "    step     u <- u + min(g, c) ( argmin J over |u_p| <= U_p  -  u )".to_owned(),
        format!(
            "    control  cosine and sine voltage of each flap at {} per rev",
            harmonics.join(", ")
        ),
        String::new(),
        t.to_owned(),
        "Azimuth 0 is over the tail. The bias of a flap is not part of it.".to_owned(),
    ]
    .into()
}

/// A number in C; no limit is infinity.
fn c_number(value: f64) -> String {
    if value.is_infinite() { "INFINITY".to_owned() } else { number(value) }
}

fn c_list(values: impl IntoIterator<Item = f64>) -> String {
    let values: Vec<f64> = values.into_iter().collect();
    if values.iter().all(|value| value.is_finite()) {
        return wrapped(&values, WIDTH, "    ", "");
    }
    values.into_iter().map(c_number).collect::<Vec<_>>().join(",\n    ")
}

/// Weights, limits, waves and matrices.
fn constants(spec: &ControllerSpec, known: Known) -> String {
    let loads = 2 * spec.channels.len();
    let settings = &spec.settings;
    let scalar = |name: &str, value: f64, meaning: &str| {
        format!("static const double {name} = {};   /* {meaning} */", c_number(value))
    };
    let list = |head: &str, values: String, meaning: &str| {
        format!("/* {meaning} */\nstatic const double {head} = {{\n    {values}\n}};")
    };
    let weights = settings.load_weights.diagonal(loads).unwrap_or_default();
    let harmonics = spec.layout.harmonics().iter().map(|&n| f64::from(n));
    let mut lines = vec![
        scalar("EFFORT_WEIGHT", settings.effort_weight, "rho, 1/V^2"),
        scalar("RATE_WEIGHT", settings.rate_weight, "s, S = s I, 1/V^2"),
        scalar("FLAP_SURVIVAL", settings.flap_survival, "q, the chance that a flap acts"),
        scalar(
            "DEAD_FLAP_COST",
            settings.dead_flap_cost,
            "largest J that a flap that stops may leave, over that of zero control",
        ),
        scalar("GAIN", settings.gain, "part of the way to the optimum that a step goes"),
        scalar(
            "RATE_LIMIT_VOLT",
            settings.rate_limit_volt,
            "largest change of a harmonic in a step, V",
        ),
        list("HARMONIC[WIDTH / 2]", c_list(harmonics), "controlled harmonics, per rev"),
        list(
            "LIMIT_VOLT[PAIRS]",
            c_list(settings.amplitude_limit_volt.iter().copied()),
            "largest amplitude of each flap at each harmonic, V",
        ),
        list("LOAD_WEIGHT[LOADS]", c_list(weights), "diagonal of W"),
        list(
            "LOAD_UNIT[CHANNELS]",
            c_list(spec.channels.iter().map(|(_, unit)| *unit)),
            "what a nondimensional load of 1 is",
        ),
        list(
            "WAVE[SAMPLES][2]",
            waves(spec),
            "weights of the samples of a revolution: cosine and sine",
        ),
    ];
    let matrices = spec.knowledge.matrices();
    lines.push(format!("enum {{ KNOTS = {} }};", matrices.len()));
    if let TKnowledge::Scheduled { advance_ratios, .. } = &spec.knowledge {
        let knots = c_list(advance_ratios.iter().copied());
        lines.push(list("KNOT_ADVANCE_RATIO[KNOTS]", knots, "advance ratio of every knot"));
    }
    lines.push(list("T[KNOTS][LOADS][CONTROLS]", rows(matrices), "dZ/du, 1/V, load by load"));
    if let (TKnowledge::Adaptive { settings, baseline, .. }, Known::Estimate { noise, prior }) =
        (&spec.knowledge, known)
    {
        let scale = baseline.iter().map(|z| z * z).sum::<f64>() / baseline.len() as f64;
        let scale = scale.max(f64::MIN_POSITIVE);
        lines.extend([
            list("BASELINE[LOADS]", c_list(baseline.iter().copied()), "Z0 at the start"),
            scalar("FULL_SCALE_VOLT", settings.full_scale_volt, "u_full, V"),
            scalar("UNCERTAINTY", settings.uncertainty, "of T0, part of itself"),
            scalar("DRIFT", settings.drift, "of T over full scale, part of itself"),
            scalar(
                "BASELINE_DRIFT",
                settings.baseline_drift,
                "of Z0 in a cycle, part of the loads",
            ),
            scalar(
                "TREND_DRIFT",
                settings.trend_drift,
                "of the trend of Z0 in a cycle, part of the loads",
            ),
            scalar(
                "DITHER_SIN",
                settings.dither_rad.sin(),
                "of the turn of every harmonic to and fro",
            ),
            scalar("DITHER_COS", settings.dither_rad.cos(), "of the same"),
            scalar("MEAN_SQUARE_LOAD", scale, "of the loads at the start"),
            scalar("PRIOR_VARIANCE", prior, "of an element of T0 u_full"),
            scalar("START_NOISE_VARIANCE", noise, "of a load"),
            scalar(
                "NOISE_FLOOR",
                LoadEstimator::NOISE_FLOOR_VARIANCE * scale,
                "least variance of an estimated noise",
            ),
            format!(
                "enum {{ NOISE_IS_TOLD = {}, TESTS_JUMPS = {} }};",
                u8::from(settings.noise_share.is_some()),
                u8::from(settings.tests_jumps)
            ),
        ]);
    }
    lines.join("\n")
}

/// Cosine and sine of every sample times the weight of the sum, as [`HarmonicAnalyser`] has them.
fn waves(spec: &ControllerSpec) -> String {
    let scale = 1.0 / spec.samples_per_rev as f64;
    let rows = (0..spec.samples_per_rev).map(|k| {
        let angle = TAU * f64::from(spec.load_harmonic) * (k as f64 * scale);
        let (sin, cos) = angle.sin_cos();
        format!("{{{}, {}}}", number(2.0 * scale * cos), number(2.0 * scale * sin))
    });
    rows.collect::<Vec<_>>().join(",\n    ")
}

fn rows(matrices: &[TMatrix]) -> String {
    let row = |t: &TMatrix, load: usize| {
        format!("{{{}}}", c_list(t.as_matrix().row(load).iter().copied()))
    };
    let one = |t: &TMatrix| {
        let rows: Vec<String> = (0..t.loads()).map(|load| row(t, load)).collect();
        format!("{{{}}}", rows.join(",\n    "))
    };
    matrices.iter().map(one).collect::<Vec<_>>().join(",\n    ")
}
