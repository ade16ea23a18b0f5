//! The actuators of a case: the ideal one, the real one, and what must be said about them.

use crate::SimError;
use crate::case::{ActuatorSource, FlapActuator, LoadedCase};
use crate::files::{BenchData, Folder, RonIndex, Source, missing_file, read_bench};
use crate::problem::{Fault, Place, Problem, Problems};
use bench_study::BenchError;
use bench_study::identification::{BenchIdentification, dataset_place, identify_bench};
use bench_study::stored::{StoredActuator, StoredFit, actuator_warnings, read_actuator};
use preisach_dyn::identify::Settings;
use preisach_dyn::{ActuatorModel, PeriodicSettings, VoltageRange};
use rotor_base::{Harmonic, HarmonicSeries};
use std::collections::BTreeSet;
use std::sync::Arc;

/// The actuators of a case.
#[derive(Debug, Clone)]
pub struct CaseActuators {
    /// The ideal linear actuator.
    pub ideal: ActuatorModel,
    /// The identified actuator; none if the case asks for the ideal one alone.
    pub real: Option<ActuatorModel>,
    /// Title of the data the real one was identified from.
    pub data_title: String,
    /// How it fits its bench.
    pub fits: Vec<StoredFit>,
    /// Data and identification, if it was identified just now.
    pub bench: Option<(BenchData, BenchIdentification)>,
    /// blake3 of the data behind it, for the key of the result.
    pub inputs: Vec<String>,
    /// What a reader should know: frequencies beyond the bench.
    pub warnings: Vec<String>,
}

impl CaseActuators {
    /// The ideal actuator alone.
    pub(crate) fn new(ideal: ActuatorModel) -> Self {
        Self {
            ideal,
            real: None,
            data_title: String::new(),
            fits: vec![],
            bench: None,
            inputs: vec![],
            warnings: vec![],
        }
    }
}

/// Bench data with the actuator identified from them.
pub(crate) type BenchActuator = (BenchData, BenchIdentification);

/// Reads bench data and identifies their actuator.
///
/// # Errors
/// Every problem of the data; [`BenchError::Actuator`] for an identification that fails.
pub(crate) fn identified(folder: &Folder) -> Result<BenchActuator, SimError> {
    let data = read_bench(folder)?;
    let found = identify_bench(&data, &Settings::default(), None)?;
    Ok((data, found))
}

/// Gets the actuators of a case: identifies, reads or makes them.
///
/// # Errors
/// Every problem of the bench data or the actuator file; [`BenchError::Actuator`] for an
/// identification that fails.
pub fn case_actuators(loaded: &LoadedCase) -> Result<CaseActuators, SimError> {
    let bench = match &loaded.actuator_source() {
        ActuatorSource::Bench(folder) => Some(identified(folder)?),
        _ => None,
    };
    let actuators = actuators_with(loaded, bench.as_ref())?;
    Ok(CaseActuators { bench, ..actuators })
}

/// The same with the bench of the case identified before; it is not kept beside the models.
///
/// # Errors
/// As [`case_actuators`].
pub(crate) fn actuators_with(
    loaded: &LoadedCase,
    bench: Option<&BenchActuator>,
) -> Result<CaseActuators, SimError> {
    let case = &loaded.case;
    let values = &case.actuator;
    let (low, high) = values.range_volt;
    let fail =
        |source| BenchError::Actuator { place: loaded.index.place("actuator.range_V"), source };
    let range = VoltageRange::new(low, high).map_err(fail)?;
    // the case gives the amplitude at full scale, the model wants it at the ends of the range
    let full_scale = 2.0 * case.control.amplitude_volt / range.span_volt();
    let ideal = ActuatorModel::linear(range, values.ideal_amplitude_deg / full_scale, 1.0);
    let mut actuators = CaseActuators::new(ideal);
    let stored = match &loaded.actuator_source() {
        ActuatorSource::Ideal => None,
        ActuatorSource::Bench(_) => bench.map(|(data, found)| {
            actuators.warnings.extend(data.warnings.iter().map(Problem::to_string));
            let stored = found.stored();
            let place = |_: &str| dataset_place(&data.folder);
            actuators.warnings.extend(actuator_warnings(&stored, place));
            actuators.inputs.push(data.content_hash.clone());
            stored
        }),
        ActuatorSource::Stored { folder, file } => {
            let source = folder.read(file)?;
            let (stored, warnings) = stored_actuator(loaded, &source)?;
            actuators.warnings.extend(warnings);
            actuators.inputs.push(blake3::hash(source.text.as_bytes()).to_hex().to_string());
            Some(stored)
        }
    };
    if let Some(StoredActuator { title, runs, model, .. }) = stored {
        within_model(loaded, model.range_volt)?;
        actuators.warnings.extend(extrapolation_warnings(loaded, &model));
        actuators.warnings.extend(gain_warning(loaded, &model));
        (actuators.data_title, actuators.fits, actuators.real) = (title, runs, Some(model));
    }
    Ok(actuators)
}

/// A stored actuator that fits a case, and what must be said about it.
///
/// # Errors
/// Every problem of the file; those of [`fits_case`].
pub(crate) fn stored_actuator(
    loaded: &LoadedCase,
    source: &Source,
) -> Result<(StoredActuator, Vec<String>), Problems> {
    let stored = read_actuator(source)?;
    fits_case(loaded, &stored, source)?;
    let index = RonIndex::new(&source.name, &source.text);
    let warnings = actuator_warnings(&stored, |field| index.place(field));
    Ok((stored, warnings))
}

/// A case with the actuators of single flaps of its flight read, and what must be said about them.
///
/// # Errors
/// A file that is missing or holds no actuator.
pub fn with_flap_actuators(loaded: &LoadedCase) -> Result<(LoadedCase, Vec<String>), Problems> {
    let (mut read, mut warnings) = (loaded.clone(), Vec::new());
    let own = read.case.flight.iter_mut().flat_map(|flight| &mut flight.flap_actuators);
    for (i, FlapActuator { path, model, .. }) in own.enumerate() {
        if !loaded.folder.contains(path) {
            let place = loaded.index.place(&format!("flight.flap_actuators[{i}].path"));
            return Err(Problem::new(place, missing_file(&loaded.folder, path)).into());
        }
        let (stored, more) = stored_actuator(loaded, &loaded.folder.read(path)?)?;
        *model = Some(Arc::new(stored.model));
        warnings.extend(more);
    }
    Ok((read, warnings))
}

/// Refuses a stored model that is no actuator, or that does not know all voltages of the case.
///
/// # Errors
/// [`Problem`] at the actuator file or at the range of the case.
fn fits_case(loaded: &LoadedCase, stored: &StoredActuator, source: &Source) -> Result<(), Problem> {
    if let Some(channels) = &stored.channels {
        let message = format!(
            "a model from {} to {}: a case needs an actuator, from command_V to displacement_um",
            channels.input, channels.output
        );
        let place = Place::file(&source.name).field("channels");
        return Err(Problem::new(place, Fault::Refused { message }));
    }
    within_model(loaded, stored.model.range_volt)
}

/// Refuses a range of voltages wider than the actuator model's: what the records do not cover the model
/// does not know.
fn within_model(loaded: &LoadedCase, known: VoltageRange) -> Result<(), Problem> {
    let slack = 1e-9 * known.span_volt();
    let (low_volt, high_volt) = loaded.case.actuator.range_volt;
    if [low_volt, high_volt].iter().all(|&volt| known.excess_volt(volt) <= slack) {
        return Ok(());
    }
    let message = format!(
        "({low_volt}, {high_volt}) V reaches beyond the ({}, {}) V the actuator was identified over; narrow the range, or record wider ones",
        known.lowest_volt(),
        known.highest_volt()
    );
    Err(Problem::new(loaded.index.place("actuator.range_V"), Fault::Other(message)))
}

/// Difference of the gains beyond which the ideal actuator is not the identified one without its
/// hysteresis.
const GAIN_ALLOWANCE: f64 = 0.05;

/// A warning if the ideal actuator's gain is not that of the identified one cycled slowly about the
/// middle of its range: then more than hysteresis lies between them.
fn gain_warning(loaded: &LoadedCase, model: &ActuatorModel) -> Option<String> {
    let case = &loaded.case;
    let trained = model.trained?;
    let range = model.range_volt;
    let amplitude_volt = trained.largest_amplitude_volt.min(0.499 * range.span_volt());
    let mut voltage = HarmonicSeries { mean: range.middle_volt(), ..HarmonicSeries::zero(1) };
    voltage.set_harmonic(1, Harmonic { cosine: amplitude_volt, sine: 0.0 });
    let settings = PeriodicSettings::default();
    let cycle = model.periodic_response(&voltage, trained.lowest_hz, &settings).ok()?;
    let slow = cycle.flap_deg.harmonic(1).amplitude() / amplitude_volt;
    let ideal = case.actuator.ideal_amplitude_deg / case.control.amplitude_volt;
    ((ideal / slow - 1.0).abs() > GAIN_ALLOWANCE).then(|| {
        format!(
            "{}: the ideal actuator makes {ideal:.4} deg/V (ideal_amplitude_deg over control.amplitude_V), the identified one {slow:.4} deg/V when cycled slowly: more than hysteresis lies between the rows ideal, ignored and hysteretic",
            loaded.index.place("actuator.ideal_amplitude_deg")
        )
    })
}

/// One warning per harmonic whose frequency lies above everything the bench has seen.
fn extrapolation_warnings(loaded: &LoadedCase, model: &ActuatorModel) -> Vec<String> {
    let Some(trained) = model.trained else { return vec![] };
    let place = loaded.index.place("actuator.bench_rev_hz");
    let case = &loaded.case;
    let harmonics: BTreeSet<usize> = case.control.harmonics.iter().flatten().copied().collect();
    harmonics
        .into_iter()
        .map(|harmonic| (harmonic, case.bench_frequency_hz(harmonic)))
        .filter(|(_, hz)| trained.is_beyond_bench(*hz))
        .map(|(harmonic, hz)| {
            format!(
                "{place}: {harmonic}/rev = {hz:.1} Hz is outside the tested range (bench up to {:.1} Hz): the actuator model extrapolates there",
                trained.bench_highest_hz
            )
        })
        .collect()
}
