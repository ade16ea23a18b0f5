//! Responses of a section with a trailing-edge flap.

use crate::answers::{raised, refused, worked};
use crate::arrays::{array, complex, numbers};
use flap_aero::{AttachedFlowModel, FlapEffectiveness, Motion};
use pyo3::prelude::*;
use pyo3::types::PyDict;
use section_study::{
    DrivenQuestion, SectionChoice, driven_history, section_response as response_at,
};
use sim_driver::SimError;
use sim_driver::choices::choice_named;

/// Names of the loads.
const LOADS: [&str; 3] = ["cn", "cm", "ch"];

/// The section that keywords describe.
fn section(
    model: &str,
    mach: f64,
    flap_chord: f64,
    effectiveness: Option<(f64, f64, f64)>,
) -> Result<SectionChoice, SimError> {
    let model = choice_named::<AttachedFlowModel>("model", model)?;
    let effectiveness = match effectiveness {
        Some((lift, moment, hinge)) => FlapEffectiveness::new(lift, moment, hinge)?,
        None => FlapEffectiveness::IDEAL,
    };
    Ok(SectionChoice { model, mach, flap_chord, effectiveness })
}

/// Complex amplitudes of the loads for a motion of 1 rad (plunge: `h_dot / U = 1`) at reduced frequencies `omega c / 2 U`.
#[pyfunction]
#[pyo3(signature = (reduced_frequency, *, motion="flap", model="calibrated", mach=0.0, flap_chord=0.2, effectiveness=None))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn section_response<'py>(
    py: Python<'py>,
    reduced_frequency: &Bound<'py, PyAny>,
    motion: &str,
    model: &str,
    mach: f64,
    flap_chord: f64,
    effectiveness: Option<(f64, f64, f64)>,
) -> PyResult<Bound<'py, PyDict>> {
    let numpy = py.import("numpy")?;
    let frequencies =
        numbers("reduced_frequency", &numpy.call_method1("atleast_1d", (reduced_frequency,))?)?;
    let (loads, remarks) = worked(py, || {
        let section = section(model, mach, flap_chord, effectiveness)?;
        let motion = choice_named::<Motion>("motion", motion)?;
        let mut loads = [vec![], vec![], vec![]];
        let mut remarks: Vec<String> = vec![];
        // what is wrong with the section is wrong at every frequency
        section.coefficients()?;
        for (i, &k) in frequencies.iter().enumerate() {
            let found =
                response_at(&section, motion, k).map_err(|error| match frequencies.len() {
                    1 => SimError::from(error),
                    _ => refused(&format!("reduced_frequency[{i}]"), error.to_string()).into(),
                })?;
            for (all, one) in loads.iter_mut().zip([found.cn, found.cm, found.ch]) {
                all.push(one);
            }
            remarks.extend(found.remarks);
        }
        Ok((loads, remarks))
    })?;
    let found = PyDict::new(py);
    found.set_item("reduced_frequency", array(py, &frequencies)?)?;
    for (name, load) in LOADS.iter().zip(&loads) {
        found.set_item(name, complex(py, load, &[load.len()])?)?;
    }
    found.set_item("remarks", each_once(remarks))?;
    Ok(found)
}

/// Loads under histories of incidence and flap angle, attached flow, a sample every `step_semichords` of travel
/// (`2 U t / c`). Before the first sample both were held.
#[pyfunction]
#[pyo3(signature = (step_semichords, incidence_rad, flap_rad, *, pitching=true, model="calibrated", mach=0.0, flap_chord=0.2, effectiveness=None))]
#[expect(clippy::too_many_arguments, reason = "keywords of Python")]
pub(crate) fn section_history<'py>(
    py: Python<'py>,
    step_semichords: f64,
    incidence_rad: &Bound<'py, PyAny>,
    flap_rad: &Bound<'py, PyAny>,
    pitching: bool,
    model: &str,
    mach: f64,
    flap_chord: f64,
    effectiveness: Option<(f64, f64, f64)>,
) -> PyResult<Bound<'py, PyDict>> {
    let incidence_rad = numbers("incidence_rad", incidence_rad)?;
    let flap_rad = numbers("flap_rad", flap_rad)?;
    let section = section(model, mach, flap_chord, effectiveness).map_err(|e| raised(py, e))?;
    let (loads, remarks) = worked(py, || {
        let question = DrivenQuestion {
            section,
            step_semichords,
            incidence_rad: &incidence_rad,
            flap_rad: &flap_rad,
            pitches: pitching,
        };
        let (coefficients, ..) = section.coefficients()?;
        let moves =
            |angle: &[f64]| angle.windows(2).any(|pair| pair[0].to_bits() != pair[1].to_bits());
        let incidence = if pitching { Motion::Pitch } else { Motion::Plunge };
        let moved = [(incidence, moves(&incidence_rad)), (Motion::Flap, moves(&flap_rad))];
        let moved = moved.into_iter().filter(|(_, moves)| *moves);
        let remarks: Vec<String> = moved
            .flat_map(|(motion, _)| section.remarks_in_motion(&coefficients.remarks, motion))
            .collect();
        Ok((driven_history(&question)?, remarks))
    })?;
    let found = PyDict::new(py);
    let distance: Vec<f64> = (0..loads.len()).map(|n| n as f64 * step_semichords).collect();
    found.set_item("s_semichords", array(py, &distance)?)?;
    for (i, name) in LOADS.iter().enumerate() {
        let load: Vec<f64> = loads.iter().map(|all| all[i]).collect();
        found.set_item(name, array(py, &load)?)?;
    }
    found.set_item("remarks", each_once(remarks))?;
    Ok(found)
}

/// Texts without those that were there before.
fn each_once(texts: Vec<String>) -> Vec<String> {
    let mut once: Vec<String> = Vec::new();
    for text in texts {
        if !once.contains(&text) {
            once.push(text);
        }
    }
    once
}
