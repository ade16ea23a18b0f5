//! Fits of a mode behind a hysteresis, and of a mode around one.

use crate::identify::families::family::{Family, Fitted, Given, Search, share};
use crate::identify::families::layered::remapped;
use crate::identify::fit::linear_mode::{LinearMode, MOST_DAMPING};
use crate::identify::fit::output_error::{Minimum, Slopes};
use crate::identify::fit::refine::{self, SHAPE, reshaped};
use crate::identify::fit::static_fit;
use crate::identify::fit::training::Training;
use crate::{
    ActuatorLaw, ActuatorModel, HystereticOscillator, LinkageStage, OscillatorParameters, PlayMap,
    PreisachError, Resonance, StaticPreisach,
};
use nalgebra::DVector;

/// Names of the parameters of a mode.
pub(crate) const MODE_NAMES: [&str; 2] = ["ln natural frequency, Hz", "ln damping ratio"];

/// The mode of two parameters, as a stage; none of so much damping that it is lags in a row.
pub(crate) fn stage(x: &[f64]) -> Option<LinkageStage> {
    let mode = Resonance { frequency_hz: x[0].exp(), damping_ratio: x[1].exp() };
    (mode.damping_ratio < MOST_DAMPING).then_some(LinkageStage::Resonance(mode))
}

/// Rounds of static map and mode.
const ROUNDS: usize = 5;

/// Static Preisach before a mode.
///
/// Rounds of two steps: output error over the mode, with the change of the density held to the exponential of a
/// quadratic form; then the density anew from the slow records, what the mode adds taken off.
pub(crate) fn behind_static(
    training: &Training<'_>,
    given: Given<'_>,
    found: &LinearMode,
) -> Result<Fitted, PreisachError> {
    let (settings, all) = (training.settings, training.all());
    let family = Family::StaticPreisachMode;
    let mut map = match given.whole {
        Some(whole) => remapped(training, &whole.model)?,
        None => static_fit::as_measured(training)?,
    };
    let mut start = found.parameters().to_vec();
    start.resize(2 + SHAPE, 0.0);
    let mut starts = given.starts(&[DVector::from_vec(start)]);
    let built = |held: &PlayMap, x: &DVector<f64>| {
        let map = reshaped(held, &x.as_slice()[2..]);
        let law = StaticPreisach::new(training.grid, map).ok()?;
        let model = settings.actuator_of(ActuatorLaw::StaticPreisach(law));
        Some(ActuatorModel { linkage: vec![stage(x.as_slice())?], ..model })
    };
    let names: Vec<&str> = MODE_NAMES.into_iter().chain(refine::NAMES).take(2 + SHAPE).collect();
    let search = |held: PlayMap| {
        let build = move |x: &DVector<f64>| built(&held, x);
        (build, &names)
    };
    let mut best: Option<(Minimum, PlayMap)> = None;
    for _ in 0..if given.whole.is_some() { 2 } else { ROUNDS } {
        let (build, names) = search(map.clone());
        let (pulls, slopes) = (&[][..], Slopes::Exact);
        let search = Search { family, build: &build, records: &all, names, pulls, slopes };
        let minimum = search.minimum(&starts)?;
        starts = vec![minimum.x.clone()];
        let held = map;
        map = remapped(training, &minimum.model)?;
        if best.as_ref().is_none_or(|(least, _)| minimum.nrmse < least.nrmse) {
            best = Some((minimum, held));
        }
    }
    let (minimum, held) = best.ok_or(PreisachError::NotFitted { family: family.name() })?;
    let (build, names) = search(held);
    let (pulls, slopes) = (&[][..], Slopes::Exact);
    let search = Search { family, build: &build, records: &all, names, pulls, slopes };
    Ok(search.fitted(minimum, given.uncertainty()))
}

/// Hysteretic shares and shapes that a search of an oscillator starts from: `(a - b) / (a + b)` is the shape.
const OSCILLATOR_STARTS: [[f64; 2]; 4] = [[-0.8, -0.3], [0.8, -0.3], [-0.8, -1.5], [0.8, -1.5]];
/// Names of its parameters.
const OSCILLATOR_NAMES: [&str; 7] = [
    "ln gain",
    "offset, tenths of the stroke",
    "ln natural frequency, Hz",
    "ln damping ratio",
    "hysteretic share of the stiffness, logit",
    "ln loss of the hysteretic spring over the stroke",
    "bend of the hysteretic spring over its loss",
];

/// The oscillator with hysteresis in its spring, by output error.
///
/// ```text
/// a + b = 2 exp(x5) / X,   a - b = 2 x6 exp(x5) / X,   x6 <= 1
/// ```
/// `X` is half of the widest motion.
pub(crate) fn oscillator(
    training: &Training<'_>,
    given: Given<'_>,
    found: &LinearMode,
) -> Result<Fitted, PreisachError> {
    let (settings, all) = (training.settings, training.all());
    let range_volt = settings.range_volt;
    let stroke_deg = 1.5 * all.iter().map(|r| r.spread_deg).fold(0.0, f64::max);
    let LinearMode { line, .. } = found;
    let middle_deg = line.output_deg(range_volt.middle_volt());
    let build = |x: &DVector<f64>| {
        if x[3].exp() >= MOST_DAMPING {
            return None;
        }
        let loss = x[5].exp() / stroke_deg;
        let parameters = OscillatorParameters {
            range_volt,
            gain_deg_per_volt: line.gain_deg_per_volt * x[0].exp(),
            frequency_hz: x[2].exp(),
            damping_ratio: x[3].exp(),
            hysteretic_share: 0.99 * share(x[4]),
            loading_per_deg: loss * (1.0 + x[6]),
            unloading_per_deg: loss * (1.0 - x[6]),
            offset_deg: middle_deg + 0.1 * stroke_deg * x[1],
        };
        let law = HystereticOscillator::new(parameters).ok()?;
        Some(settings.actuator_of(ActuatorLaw::HystereticOscillator(law)))
    };
    let [frequency, damping] = found.parameters();
    let start = |[share, loss]: [f64; 2]| {
        DVector::from_vec(vec![0.0, 0.0, frequency, damping.max(-6.0), share, loss, 0.0])
    };
    let family = Family::HystereticOscillator;
    let (names, slopes) = (&OSCILLATOR_NAMES[..], Slopes::Exact);
    let search = Search { family, build: &build, records: &all, names, pulls: &[], slopes };
    let minimum = search.minimum(&given.starts(&OSCILLATOR_STARTS.map(start)))?;
    Ok(search.fitted(minimum, given.uncertainty()))
}
