//! An actuator: identified from records, read and written, simulated and inverted.
#![expect(clippy::needless_pass_by_value, reason = "arguments of Python are handed over")]

use crate::answers::{json, table, warn, worked};
use crate::arrays::{array, numbers};
use crate::records::{Description, folder_of, same_count, step_of};
use actuator_gap::{Commanded, StoredActuator};
use bench_study::BenchError;
use bench_study::any_data::{FoundModel, identified_data};
use bench_study::identification::{Comparing, dataset_place};
use bench_study::stored::{actuator_warnings, read_actuator, write_actuator};
use measured_data::problem::Place;
use measured_data::{RonIndex, Source, read_dataset, refuse_other_kind};
use preisach_dyn::identify::Settings;
use pyo3::prelude::*;
use sim_driver::SimError;
use sim_driver::choices::model_named;
use std::path::PathBuf;

/// An actuator: what its flap does under a voltage.
#[pyclass(frozen, module = "rotor_hhc")]
pub(crate) struct Actuator {
    pub(crate) stored: StoredActuator,
    /// What the identification says, as JSON; none of a file.
    summary: Option<String>,
    /// What a reader should know about data and model.
    warnings: Vec<String>,
}

impl Actuator {
    pub(crate) fn new(stored: StoredActuator) -> Self {
        Self { stored, summary: None, warnings: vec![] }
    }

    fn motion(is_angle: bool) -> &'static str {
        if is_angle { "flap_deg" } else { "displacement_um" }
    }
}

/// An error of the model at the argument that asked for it.
fn at(argument: &str, source: preisach_dyn::PreisachError) -> SimError {
    BenchError::Actuator { place: Place::file(argument), source }.into()
}

#[pymethods]
impl Actuator {
    /// Reads an actuator file, of `hhc identify`, of `save` or written by hand.
    #[staticmethod]
    fn load(py: Python<'_>, path: PathBuf) -> PyResult<Self> {
        let (stored, warnings) = worked(py, || {
            let source = Source::read(&path)?;
            let stored = read_actuator(&source)?;
            let index = RonIndex::new(&source.name, &source.text);
            let warnings = actuator_warnings(&stored, |field| index.place(field));
            Ok((stored, warnings))
        })?;
        warn(py, &warnings)?;
        Ok(Self { warnings, ..Self::new(stored) })
    }

    /// Writes the actuator file. Another file than that of an actuator is replaced with `force` only.
    #[pyo3(signature = (path, *, force=false))]
    fn save(&self, py: Python<'_>, path: PathBuf, force: bool) -> PyResult<()> {
        worked(py, || {
            if !force {
                refuse_other_kind(&path, "Actuator")?;
            }
            Ok(write_actuator(&self.stored, &path)?)
        })
    }

    /// One line about the data it was identified from.
    #[getter]
    fn title(&self) -> &str {
        &self.stored.title
    }

    /// Names of input and output with their units.
    #[getter]
    fn channels(&self) -> (String, String) {
        (self.stored.input_column(), self.stored.output_column())
    }

    /// Voltages it knows, V: lowest and highest.
    #[getter]
    fn range_volt(&self) -> (f64, f64) {
        let range = self.stored.model.range_volt;
        (range.lowest_volt(), range.highest_volt())
    }

    /// Flap angle per displacement, deg/um.
    #[getter]
    fn deg_per_um(&self) -> f64 {
        self.stored.model.calibration.deg_per_um
    }

    /// Law, stages and calibration with all parameters.
    #[getter]
    fn model<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        table(py, &worked(py, || json(&self.stored.model))?)
    }

    /// How it fits every run.
    #[getter]
    fn runs<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        table(py, &worked(py, || json(&self.stored.runs))?)
    }

    /// What `hhc identify --format json` prints: parameters with deviations, fits, table of models; none of a file.
    #[getter]
    fn summary<'py>(&self, py: Python<'py>) -> PyResult<Option<Bound<'py, PyAny>>> {
        self.summary.as_deref().map(|text| table(py, text)).transpose()
    }

    /// What a reader should know about data and model.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    /// The motion under a command, at rest at its first sample: the displacement, um, as its sensor reads it, or with
    /// `angle` the flap angle, deg.
    #[pyo3(signature = (time_s, command_volt, *, angle=false))]
    fn simulate<'py>(
        &self,
        py: Python<'py>,
        time_s: &Bound<'py, PyAny>,
        command_volt: &Bound<'py, PyAny>,
        angle: bool,
    ) -> PyResult<Bound<'py, PyAny>> {
        let time_s = numbers("time_s", time_s)?;
        let command = numbers("command_volt", command_volt)?;
        let moved = worked(py, || {
            same_count("command_volt", &command, &time_s)?;
            let step_s = step_of(&time_s)?;
            let moved = self.stored.output_under(&command, step_s, !angle);
            moved.map_err(|source| at("command_volt", source))
        })?;
        array(py, &moved)
    }

    /// The voltage under which it moves as wanted: a displacement, um, or with `angle` a flap angle, deg.
    #[pyo3(signature = (time_s, wanted, *, angle=false))]
    fn invert(
        &self,
        py: Python<'_>,
        time_s: &Bound<'_, PyAny>,
        wanted: &Bound<'_, PyAny>,
        angle: bool,
    ) -> PyResult<Inverse> {
        let time_s = numbers("time_s", time_s)?;
        let wanted = numbers("wanted", wanted)?;
        let found = worked(py, || {
            same_count("wanted", &wanted, &time_s)?;
            let step_s = step_of(&time_s)?;
            let found = self.stored.command_for(&wanted, step_s, !angle);
            found.map_err(|source| at("wanted", source))
        })?;
        Ok(Inverse { found, motion: Self::motion(angle) })
    }

    fn __repr__(&self) -> String {
        let (low, high) = self.range_volt();
        format!("Actuator({:?}, {low} to {high} V)", self.stored.title)
    }
}

/// A voltage under which an actuator moves as wanted, and what is left of the wanted motion.
#[pyclass(frozen, module = "rotor_hhc")]
pub(crate) struct Inverse {
    found: Commanded,
    motion: &'static str,
}

#[pymethods]
impl Inverse {
    /// Voltage at every sample, V.
    #[getter]
    fn command_volt<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, &self.found.input)
    }

    /// Motion under it, in the unit of the wanted one.
    #[getter]
    fn moved<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        array(py, &self.found.output)
    }

    /// Rms of the motion less the wanted one, in its unit.
    #[getter]
    fn rms(&self) -> f64 {
        self.found.error.rms
    }

    /// The largest difference, in its unit.
    #[getter]
    fn largest(&self) -> f64 {
        self.found.error.largest
    }

    /// Rms over the standard deviation of the wanted motion, percent.
    #[getter]
    fn nrmse_percent(&self) -> f64 {
        self.found.error.nrmse_percent
    }

    /// Samples whose voltage is an end of the range: the motion is out of reach there.
    #[getter]
    fn at_limit(&self) -> usize {
        self.found.at_limit
    }

    /// Simulations it took.
    #[getter]
    fn simulations(&self) -> usize {
        self.found.simulations
    }

    fn __repr__(&self) -> String {
        let Commanded { error, at_limit, .. } = &self.found;
        let motion = self.motion;
        format!(
            "Inverse({motion} to {:.2e} % rms, {at_limit} samples at the range)",
            error.nrmse_percent
        )
    }
}

/// Identifies an actuator from a data folder, or from runs in memory: a dictionary from names to time (s), command (V) and
/// displacement (um). All models are fitted; `model` is that to use, `best` leaves the choice to cross-validation.
#[pyfunction]
#[pyo3(signature = (data, *, model="best", start=None, title=None, command_range_volt=None, flap_deg_per_um=None))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn identify(
    py: Python<'_>,
    data: &Bound<'_, PyAny>,
    model: &str,
    start: Option<PathBuf>,
    title: Option<String>,
    command_range_volt: Option<(f64, f64)>,
    flap_deg_per_um: Option<f64>,
) -> PyResult<Actuator> {
    let said = Description { title, command_range_volt, flap_deg_per_um };
    let folder = folder_of(data, &said)?;
    let found = worked(py, || {
        let choice = model_named("model", model)?;
        let base = match &start {
            Some(path) => read_actuator(&Source::read(path)?)?.settings,
            None => Settings::default(),
        };
        let data = read_dataset(&folder)?;
        let mut warnings: Vec<String> = data.warnings().iter().map(ToString::to_string).collect();
        let (glances, subject) = bench_study::glances(&data);
        warnings.extend(bench_study::compared(&glances, subject));
        let (stored, summary) = match identified_data(&data, &base, Some(Comparing::all(&|| ())))? {
            FoundModel::Curves(found) => (found.stored(), json(&found.summary(None))?),
            FoundModel::Records(mut found) => {
                found.pick(choice)?;
                (found.stored(), json(&found.summary(None))?)
            }
        };
        warnings.extend(actuator_warnings(&stored, |_| dataset_place(&stored.dataset)));
        Ok(Actuator { stored, summary: Some(summary), warnings })
    })?;
    warn(py, &found.warnings)?;
    Ok(found)
}
