//! A case: modes of its blade, its trim, its T, its control.
#![expect(clippy::needless_pass_by_value, reason = "arguments of Python are handed over")]

use crate::answers::{json, table, warn, worked};
use crate::arrays::{array, complex, numbers, shaped};
use measured_data::problem::{Fault, Place, Problems};
use measured_data::refuse_unwritable;
use pyo3::prelude::*;
use pyo3::types::PyDict;
use rotor_export::LabelledArray;
use rotor_fem::GyroscopicTerms;
use rotor_flight::exported_case;
use rotor_study::{AboutState, HubLoads, ModesQuestion};
use sim_driver::SimError;
use sim_driver::case::{CaseFaults, LoadedCase};
use sim_driver::choices::value_named;
use sim_driver::cli::{InflowOverride, case_or_paper, moved_to, overridden};
use sim_driver::flight::leaving;
use sim_driver::print::modes_of_case;
use sim_driver::progress::Progress;
use sim_driver::results::{RESULT_FILE, StoredResult};
use sim_driver::run::{run_case, stored_of, trimmed_result};
use sim_driver::sweep::{continued_trim, refuse_diverged};
use std::path::PathBuf;

/// Stations of a shape for which none are given.
const STATIONS: usize = 21;

/// The case of a file, the paper's without one, in another inflow and at another advance ratio where they are given.
fn loaded(
    case: Option<&PathBuf>,
    inflow: Option<&str>,
    advance_ratio: Option<f64>,
) -> Result<LoadedCase, SimError> {
    let inflow = inflow.map(|name| value_named::<InflowOverride>("inflow", name)).transpose()?;
    moved_to(overridden(case_or_paper(case)?, inflow), advance_ratio)
}

/// Rotating modes of the blade of a case with their shapes. Without a case: the paper's blade.
#[pyfunction]
#[pyo3(signature = (case=None, *, pitch_deg=0.0, gyroscopic=true, undeformed=false, speeds=None, stations_r=None))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn modes<'py>(
    py: Python<'py>,
    case: Option<PathBuf>,
    pitch_deg: f64,
    gyroscopic: bool,
    undeformed: bool,
    speeds: Option<&Bound<'py, PyAny>>,
    stations_r: Option<&Bound<'py, PyAny>>,
) -> PyResult<Bound<'py, PyDict>> {
    let speed_ratios = speeds.map_or(Ok(vec![]), |given| numbers("speeds", given))?;
    let stations = || (0..STATIONS).map(|i| i as f64 / (STATIONS - 1) as f64).collect();
    let stations =
        stations_r.map_or_else(|| Ok(stations()), |given| numbers("stations_r", given))?;
    let question = ModesQuestion {
        terms: if gyroscopic { GyroscopicTerms::Included } else { GyroscopicTerms::Neglected },
        pitch_rad: pitch_deg.to_radians(),
        about: if undeformed { AboutState::Undeformed } else { AboutState::Deflected },
        speed_ratios,
        shape_stations_r: stations,
    };
    let (found, steady_tip, fan) = worked(py, || {
        let found = modes_of_case(&loaded(case.as_ref(), None, None)?, &question)?;
        let steady_tip = found.steady_tip.map(|tip| json(&tip)).transpose()?;
        let fan = json(&found.fan)?;
        Ok((found, steady_tip, fan))
    })?;
    warn(py, &found.warnings)?;
    let modes = &found.modes;
    let per_rev: Vec<f64> =
        modes.iter().map(|mode| mode.per_rev.unwrap_or(f64::INFINITY)).collect();
    let hz: Vec<f64> = modes.iter().map(|mode| mode.hz).collect();
    let energy: Vec<f64> = modes.iter().flat_map(|mode| mode.energy).collect();
    let shape: Vec<[f64; 2]> = modes.iter().flat_map(|mode| mode.shape.concat()).collect();
    let kinds: Vec<&str> = modes.iter().map(|mode| mode.kind.as_str()).collect();
    let stations = question.shape_stations_r;
    let answer = PyDict::new(py);
    answer.set_item("kind", kinds)?;
    answer.set_item("per_rev", array(py, &per_rev)?)?;
    answer.set_item("hz", array(py, &hz)?)?;
    answer.set_item("energy", shaped(py, &energy, &[modes.len(), 4])?)?;
    answer.set_item("stations_r", array(py, &stations)?)?;
    answer.set_item("shape", complex(py, &shape, &[modes.len(), stations.len(), 3])?)?;
    answer.set_item("rotor_speed_rad_s", found.rotor_speed_rad_s)?;
    answer.set_item("steady_tip", steady_tip.map(|text| table(py, &text)).transpose()?)?;
    answer.set_item("fan", table(py, &fan)?)?;
    answer.set_item("warnings", &found.warnings)?;
    Ok(answer)
}

/// Trims a case with its flaps at rest: controls, residuals, wake, hub loads. Without a case: the paper's.
#[pyfunction]
#[pyo3(signature = (case=None, *, inflow=None, advance_ratio=None))]
pub(crate) fn trim<'py>(
    py: Python<'py>,
    case: Option<PathBuf>,
    inflow: Option<&str>,
    advance_ratio: Option<f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let (loaded, found, texts) = worked(py, || {
        let loaded = loaded(case.as_ref(), inflow, advance_ratio)?;
        let trimmed = continued_trim(&loaded, None)?;
        refuse_diverged(&loaded, trimmed.wake_diverged())?;
        let found = trimmed_result(&loaded, &trimmed);
        let texts = [json(&found.trim)?, json(&found.residuals)?, json(&found.wake)?];
        Ok((loaded, found, texts))
    })?;
    warn(py, &loaded.warnings)?;
    let answer = PyDict::new(py);
    for (name, text) in ["controls", "residuals", "wake"].iter().zip(&texts) {
        answer.set_item(name, table(py, text)?)?;
    }
    let scales = loaded.case.scales();
    let units: Vec<f64> = [scales.force_newton(), scales.moment_newton_metre()]
        .into_iter()
        .flat_map(|unit| [unit; 3])
        .collect();
    let parts: Vec<[f64; 2]> = found.baseline.hub_nb_per_rev.parts().as_chunks::<2>().0.to_vec();
    let mean = found.mean_loads.map(|loads| loads.hub).unwrap_or_default();
    answer.set_item("loads", HubLoads::NAMES)?;
    answer.set_item("hub_mean", array(py, &mean)?)?;
    answer.set_item("hub_nb_per_rev", shaped(py, parts.as_flattened(), &[parts.len(), 2])?)?;
    answer.set_item("blades", loaded.case.rotor.blades)?;
    answer.set_item("load_unit", array(py, &units)?)?;
    answer.set_item("warnings", &loaded.warnings)?;
    Ok(answer)
}

/// T of a set of harmonics at the trim of a case, loads over their `load_unit` per V: `hhc export --to json` of a case without a
/// flight. Without harmonics: the first set of the case.
#[pyfunction]
#[pyo3(signature = (case=None, harmonics=None, *, inflow=None, advance_ratio=None))]
pub(crate) fn t_matrix<'py>(
    py: Python<'py>,
    case: Option<PathBuf>,
    harmonics: Option<Harmonics>,
    inflow: Option<&str>,
    advance_ratio: Option<f64>,
) -> PyResult<Bound<'py, PyDict>> {
    let (document, warnings) = worked(py, || {
        let mut loaded = loaded(case.as_ref(), inflow, advance_ratio)?;
        loaded.case.flight = None;
        match harmonics {
            Some(set) => loaded.case.control.harmonics = vec![set.into()],
            None => loaded.case.control.harmonics.truncate(1),
        }
        checked(&loaded)?;
        leaving(&loaded, exported_case)
    })?;
    warn(py, &warnings)?;
    let answer = PyDict::new(py);
    for own in &document.arrays {
        let name = if own.name.starts_with("T_") { "T" } else { &own.name };
        if own.name.starts_with("T_") {
            answer.set_item("loads", &own.axes[0].labels)?;
            answer.set_item("controls", &own.axes[1].labels)?;
        }
        match name {
            "T" | "baseline" | "load_unit" => answer.set_item(name, of_labels(py, own)?)?,
            "conditions" => {
                let conditions = PyDict::new(py);
                for (row, label) in own.axes[0].labels.iter().enumerate() {
                    conditions.set_item(label, own.at(row, 0, 0))?;
                }
                answer.set_item(name, conditions)?;
            }
            // that of a flight's noise
            _ => {}
        }
    }
    answer.set_item("notes", &document.notes)?;
    answer.set_item("warnings", warnings)?;
    Ok(answer)
}

/// One harmonic or a set of them, per rev.
#[derive(FromPyObject)]
pub(crate) enum Harmonics {
    /// One.
    One(usize),
    /// A set.
    Set(Vec<usize>),
}

impl From<Harmonics> for Vec<usize> {
    fn from(given: Harmonics) -> Self {
        match given {
            Harmonics::One(harmonic) => vec![harmonic],
            Harmonics::Set(harmonics) => harmonics,
        }
    }
}

/// Refuses a case that arguments have led out of its ranges.
fn checked(loaded: &LoadedCase) -> Result<(), Problems> {
    let mut problems = Problems::default();
    if let Err(CaseFaults(faults)) = loaded.case.check() {
        for own in faults {
            let place = Place::file("case").field(own.field);
            problems.push(place, Fault::Other(own.fault.to_string()));
        }
    }
    problems.into_result(Some(()))
}

/// An array of one point as NumPy has it: axes of one place at the end left out.
fn of_labels<'py>(py: Python<'py>, own: &LabelledArray) -> PyResult<Bound<'py, PyAny>> {
    let [rows, columns, _] = own.sizes();
    let at = |row, column| own.at(row, column, 0).unwrap_or(f64::NAN);
    let numbers: Vec<f64> =
        (0..rows).flat_map(|row| (0..columns).map(move |column| at(row, column))).collect();
    if own.axes.len() < 3 { array(py, &numbers) } else { shaped(py, &numbers, &[rows, columns]) }
}

/// A case that was run: what `hhc run` stores and shows.
#[pyclass(frozen, module = "rotor_hhc")]
pub(crate) struct Study {
    stored: StoredResult,
    /// Figures as JSON.
    figures: String,
    warnings: Vec<String>,
}

#[pymethods]
impl Study {
    /// What `hhc run --format json` prints: trim, loads, stability, control, costs.
    #[getter]
    fn figures<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        table(py, &self.figures)
    }

    /// The control table: an entry for each set of harmonics and actuator.
    #[getter]
    fn control<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        self.figures(py)?.get_item("control")
    }

    /// What is stored, every number once: `result` of `result.json`.
    #[getter]
    fn result<'py>(&self, py: Python<'py>) -> PyResult<Bound<'py, PyAny>> {
        table(py, &worked(py, || json(&self.stored.result))?)
    }

    /// Equal keys are equal results.
    #[getter]
    fn key(&self) -> &str {
        &self.stored.key
    }

    /// What a reader should know before using the numbers.
    #[getter]
    fn warnings(&self) -> Vec<String> {
        self.warnings.clone()
    }

    /// Writes `result.json` into a folder; `hhc report` makes report and tables of it.
    fn save(&self, py: Python<'_>, folder: PathBuf) -> PyResult<()> {
        worked(py, || {
            refuse_unwritable(&folder)?;
            self.stored.write(&folder.join(RESULT_FILE))
        })
    }

    fn __repr__(&self) -> String {
        format!(
            "Study({:?}, {} controls)",
            self.stored.case.title,
            self.stored.result.control.len()
        )
    }
}

/// Trims a case and controls its vibration with every actuator it names. Without a case: the paper's.
#[pyfunction]
#[pyo3(signature = (case=None, *, inflow=None, advance_ratio=None))]
pub(crate) fn run(
    py: Python<'_>,
    case: Option<PathBuf>,
    inflow: Option<&str>,
    advance_ratio: Option<f64>,
) -> PyResult<Study> {
    let found = worked(py, || {
        let loaded = loaded(case.as_ref(), inflow, advance_ratio)?;
        let outcome = run_case(&loaded, &Progress::hidden())?;
        refuse_diverged(&loaded, outcome.trimmed.wake_diverged())?;
        let figures = outcome.figures();
        let (stored, text) = (stored_of(&loaded, &outcome)?, json(&figures)?);
        Ok(Study { stored, figures: text, warnings: figures.warnings })
    })?;
    warn(py, &found.warnings)?;
    Ok(found)
}
