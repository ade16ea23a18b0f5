//! The families of models that the same records can be fitted with.

use crate::identify::families::family::{Family, Fitted, Given, Search, share};
use crate::identify::families::{layered, mode, plays_fit, stop_fit};
use crate::identify::fit::linear_mode::LinearMode;
use crate::identify::fit::output_error::{Build, Slopes};
use crate::identify::fit::preisach::{RateFit, fit_linear};
use crate::identify::fit::refine::Refined;
use crate::identify::fit::static_fit;
use crate::identify::fit::training::Training;
use crate::identify::{RateSmoothness, Settings};
use crate::{
    ActuatorLaw, AmplifierStage, BoucWen, BoucWenParameters, Envelope, Lag, LinearGain,
    PrandtlIshlinskii, PrandtlParameters, PreisachError, StaticPreisach, TimeOrder, WeightedPlay,
};
use nalgebra::DVector;

/// Fits a family.
///
/// # Errors
/// [`PreisachError::NoTrainingRecord`] without the records a family needs, [`PreisachError::NotFitted`]
/// if no start led anywhere, or those of the fits.
pub(crate) fn fit(
    family: Family,
    training: &Training<'_>,
    given: Given<'_>,
) -> Result<Fitted, PreisachError> {
    let has_rate =
        !training.fast.is_empty() || !(family.needs_cycles() || training.others.is_empty());
    if family.needs_rate() && !has_rate {
        return Err(PreisachError::NoTrainingRecord {
            part: "what depends on rate",
            remedy: "record periodic runs at two or more frequencies, for instance 1 and 10 Hz",
        });
    }
    let mut settings = training.settings.clone();
    settings.rate_smoothness = RateSmoothness::Fixed(given.smoothness);
    let training = &training.with_rate(&settings);
    match family {
        Family::StaticPreisach => {
            let law = StaticPreisach::new(training.grid, static_fit::as_measured(training)?)?;
            let model = settings.actuator_of(ActuatorLaw::StaticPreisach(law));
            Ok(Fitted { model, parameters: Vec::new() })
        }
        Family::DynamicPreisachFirst | Family::DynamicPreisach => {
            let time_order = match family {
                Family::DynamicPreisachFirst => TimeOrder::First,
                _ => TimeOrder::Second,
            };
            let settings = Settings { time_order, ..settings.clone() };
            let training = training.with_rate(&settings);
            let map = static_fit::as_measured(&training)?;
            let rate = RateFit::new(&training, map, given.uncertainty())?;
            let Refined { law, parameters, .. } = rate.refined;
            Ok(Fitted { model: settings.actuator_of(law), parameters })
        }
        Family::PrandtlStop => stop_fit::fit(training),
        Family::PrandtlPlays => plays_fit::fit(training),
        Family::StaticPreisachCreep | Family::DynamicPreisachCreep => {
            layered::creep(family, training, given)
        }
        Family::StaticPreisachRelaxation => layered::relaxation(training, given),
        Family::StaticPreisachMode | Family::HystereticOscillator => {
            let found = given.mode.ok_or(PreisachError::NotFitted { family: family.name() })?;
            let fit = match family {
                Family::StaticPreisachMode => mode::behind_static,
                _ => mode::oscillator,
            };
            fit(training, given, found)
        }
        _ => by_output_error(family, training, given),
    }
}

/// Plays of the Prandtl-Ishlinskii model.
const PLAYS: usize = 8;

/// Fits a family of few parameters to all records at once.
fn by_output_error(
    family: Family,
    training: &Training<'_>,
    given: Given<'_>,
) -> Result<Fitted, PreisachError> {
    let all = training.all();
    let behind = given.mode.filter(|_| family.has_mode());
    let line = behind.map_or_else(|| fit_linear(&training.slow), |found| found.line);
    let range = training.settings.range_volt;
    let middle_deg = line.output_deg(range.middle_volt());
    let wrap = |law: ActuatorLaw| training.settings.actuator_of(law);
    let linear = |x: &DVector<f64>| {
        let gain_deg_per_volt = line.gain_deg_per_volt * (1.0 + x[0]);
        let bias_volt = line.bias_volt + 0.1 * range.span_volt() * x[1];
        wrap(ActuatorLaw::Linear(LinearGain { gain_deg_per_volt, bias_volt }))
    };
    // a rising law: the families below know no falling ones
    let gain = line.gain_deg_per_volt.abs();
    let envelope = |x: &DVector<f64>| Envelope {
        offset_deg: middle_deg + 0.1 * gain * range.span_volt() * x[1],
        quadratic: 0.45 * x[2].tanh(),
        cubic: 0.3 * x[3].tanh(),
    };
    let bouc_wen = |x: &DVector<f64>, exponent: f64| {
        let (gain_deg_per_volt, rise_volt) = (gain * x[0].exp(), 20.0 * x[5].exp());
        let sigma = 0.5 + 0.5 * x[6].exp();
        let most_deg = gain_deg_per_volt * rise_volt / (2.0 * sigma);
        let parameters = BoucWenParameters {
            range_volt: range,
            gain_deg_per_volt,
            half_height_deg: most_deg * share(x[4]),
            rise_volt,
            sigma,
            exponent,
            envelope: envelope(x),
        };
        let mut model = wrap(ActuatorLaw::BoucWen(BoucWen::new(parameters).ok()?));
        // the last parameters, of a family with a mode
        if let Some(x) = x.as_slice().get(7..9) {
            model.linkage.push(mode::stage(x)?);
        }
        Some(model)
    };
    let prandtl = |x: &DVector<f64>| {
        let step_volt = 0.5 * range.span_volt() / (PLAYS + 1) as f64;
        let parameters = PrandtlParameters {
            range_volt: range,
            gain_deg_per_volt: gain * x[0].exp(),
            plays: (0..PLAYS)
                .map(|i| WeightedPlay {
                    threshold_volt: (i + 1) as f64 * step_volt,
                    weight_deg_per_volt: gain * x[5 + i] * x[5 + i],
                })
                .collect(),
            threshold_growth_s: x[4].exp(),
            envelope: envelope(x),
        };
        Some(wrap(ActuatorLaw::PrandtlIshlinskii(PrandtlIshlinskii::new(parameters).ok()?)))
    };
    let common = ["ln gain", "offset, tenths of the stroke", "quadratic, artanh", "cubic, artanh"];
    let search = |build: Build<'_>, everywhere: &[DVector<f64>], names: &[&str]| {
        let search =
            Search { family, build, records: &all, names, pulls: &[], slopes: Slopes::Exact };
        let minimum = search.minimum(&given.starts(everywhere))?;
        Ok(search.fitted(minimum, given.uncertainty()))
    };
    match family {
        Family::Linear => {
            let build = |x: &DVector<f64>| Some(linear(x));
            search(&build, &[DVector::zeros(2)], &["gain, relative", "bias, tenths of the range"])
        }
        Family::LinearLag => {
            let build = |x: &DVector<f64>| {
                let mut model = linear(x);
                model.amplifier.push(AmplifierStage::Lag(Lag { tau_s: x[2].exp() }));
                Some(model)
            };
            let start = |tau_s: f64| DVector::from_vec(vec![0.0, 0.0, tau_s.ln()]);
            let names = ["gain, relative", "bias, tenths of the range", "ln time constant, s"];
            search(&build, &[1e-3, 1e-2, 5e-2].map(start), &names)
        }
        Family::BoucWen | Family::BoucWenMode => {
            let (starts, names) = of_bouc_wen(&common, behind);
            let starts = given.starts(&starts);
            // the exponents with a closed solution
            let builds = [1.0, 2.0].map(|exponent| move |x: &DVector<f64>| bouc_wen(x, exponent));
            let [one, two] = [&builds[0], &builds[1]].map(|build| {
                let (records, names) = (&all[..], &names[..]);
                Search { family, build, records, names, pulls: &[], slopes: Slopes::Exact }
            });
            let (first, second) = (one.minimum(&starts)?, two.minimum(&starts)?);
            let second_is_better = second.nrmse < first.nrmse;
            let (search, minimum) = if second_is_better { (two, second) } else { (one, first) };
            Ok(search.fitted(minimum, given.uncertainty()))
        }
        _ => {
            let start = |growth_s: f64| {
                let mut x = vec![-0.5, 0.0, 0.0, 0.0, growth_s.ln()];
                x.resize(5 + PLAYS, 0.2);
                DVector::from_vec(x)
            };
            let mut names = common.to_vec();
            names.push("ln growth of the half-widths, s");
            let plays: Vec<String> = (1..=PLAYS).map(|i| format!("root of weight {i}")).collect();
            names.extend(plays.iter().map(String::as_str));
            search(&prandtl, &[1e-3, 1e-2].map(start), &names)
        }
    }
}

/// Where a search for the numbers of Bouc and Wen starts, and what they are called; those of a mode come last.
fn of_bouc_wen(
    common: &[&'static str],
    behind: Option<&LinearMode>,
) -> (Vec<DVector<f64>>, Vec<&'static str>) {
    let start = |rise: f64| {
        let own = [0.1, 0.0, 0.0, 0.0, 0.0, rise, 0.0].into_iter();
        let all = own.chain(behind.iter().flat_map(|found| found.parameters()));
        DVector::from_vec(all.collect())
    };
    let mut names = common.to_vec();
    names.extend(["loop height, logit", "ln rise over 20 V", "ln (2 sigma - 1)"]);
    names.extend(behind.iter().flat_map(|_| mode::MODE_NAMES));
    ([-0.7, 0.5].map(start).to_vec(), names)
}
