//! What a simulation of measured data lacks.

use crate::actuator::Actuator;
use crate::answers::{json, refused, table, warn, worked};
use actuator_gap::StoredActuator;
use preisach_dyn::ActuatorModel;
use pyo3::prelude::*;
use sim_driver::SimError;
use sim_driver::case::load_case;
use sim_driver::diagnose::{
    CasePoints, Findings, FolderStore, PointStory, Question, Story, both, extended, model_or_case,
    points_of,
};
use sim_driver::output::Printable;
use std::path::PathBuf;

/// What was found: what is missing, how sure that is, and the model with it.
#[pyclass(frozen, module = "rotor_hhc")]
pub(crate) struct Diagnosis {
    /// As JSON.
    findings: String,
    text: String,
    /// None of points of test.
    extended: Option<StoredActuator>,
    warnings: Vec<String>,
}

#[pymethods]
impl Diagnosis {
    /// What `findings.json` of `hhc diagnose` holds: verdict, causes, parameters with deviations, gain, next experiment.
    #[getter]
    fn findings<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        table(py, &self.findings)
    }

    /// What `hhc diagnose` prints.
    #[getter]
    fn text(&self) -> &str {
        &self.text
    }

    /// The actuator with what was found; none of points of test.
    #[getter]
    fn extended(&self) -> Option<Actuator> {
        self.extended.clone().map(Actuator::new)
    }

    /// What a reader should know about the data.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    fn __repr__(&self) -> String {
        format!("Diagnosis({:?})", self.text.lines().next().unwrap_or_default())
    }
}

/// The simulation asked about.
#[derive(FromPyObject)]
pub(crate) enum Simulation<'py> {
    /// An actuator.
    Actuator(Bound<'py, Actuator>),
    /// The path of an actuator file or of a case.
    Path(PathBuf),
}

/// Says what the simulation of a bench, of loops or of points of test lacks. `model` is an actuator, its file, or a case; points of
/// test need the case.
#[pyfunction]
#[pyo3(signature = (data, model=None, *, reference=None, only=vec![], cache=None))]
#[pyo3(text_signature = "(data, model=None, *, reference=None, only=(), cache=None)")]
pub(crate) fn diagnose(
    py: Python<'_>,
    data: PathBuf,
    model: Option<Simulation<'_>>,
    reference: Option<PathBuf>,
    only: Vec<String>,
    cache: Option<PathBuf>,
) -> PyResult<Diagnosis> {
    let (given, path) = match model {
        Some(Simulation::Actuator(own)) => (Some(own.get().stored.model.clone()), None),
        Some(Simulation::Path(path)) => (None, Some(path)),
        None => (None, None),
    };
    let asked = Asked { data, path, reference, only, cache };
    let found = worked(py, || asked.answer(given))?;
    warn(py, &found.warnings)?;
    Ok(found)
}

/// What is asked, without what belongs to the interpreter.
struct Asked {
    data: PathBuf,
    path: Option<PathBuf>,
    reference: Option<PathBuf>,
    only: Vec<String>,
    cache: Option<PathBuf>,
}

impl Asked {
    fn answer(&self, given: Option<ActuatorModel>) -> Result<Diagnosis, SimError> {
        if let Some(points) = points_of(&self.data)? {
            let Some(case) = &self.path else {
                let message = "points of test are diagnosed with a case: give its path".to_owned();
                return Err(refused("model", message).into());
            };
            let found = CasePoints::of(&load_case(case)?, &points, &self.only, &|_, _| ())?;
            return Ok(Diagnosis {
                findings: json(&found.diagnosis.findings())?,
                text: PointStory::of(&found.diagnosis).text(),
                extended: None,
                warnings: points.warnings.iter().map(ToString::to_string).collect(),
            });
        }
        let given = match &self.path {
            Some(path) => model_or_case(path)?.0,
            None => given,
        };
        let records = both(&self.data, self.reference.as_deref())?;
        let store = self.cache.as_deref().map(FolderStore);
        let question = Question {
            reference: records.reference,
            only: self.only.clone(),
            cache: store.as_ref().map(|store| store as &dyn actuator_gap::StructureStore),
            given: given.as_ref(),
            begun: None,
        };
        let found = sim_driver::diagnose::diagnose(&records.measured, &question)?;
        Ok(Diagnosis {
            findings: json(&Findings::from(&found))?,
            text: Story::of(&found).text(),
            extended: Some(extended(&found)?),
            warnings: records.warnings.iter().map(ToString::to_string).collect(),
        })
    }
}
