//! A case as a case of a sweep: what its key depends on, and the columns of its result.

use crate::SimError;
use crate::actuator::{BenchActuator, actuators_with, identified};
use crate::case::{ActuatorSource, LoadedCase, read_case, unit_of};
use crate::files::{Folder, Source, read_bench, ron_text};
use crate::problem::{Fault, Place, Problem, Problems};
use crate::progress::Progress;
use crate::results::{ControlLine, Figures, flap_name, set_name};
use crate::run::run_trimmed;
use crate::sweep::{continued_trim, refuse_diverged};
use case_sweep::{Cell, Found, NoNumbers, ReadCase, Runner};
use measured_data::DataError;
use rotor_base::RotorScales;
use rotor_study::{HubLoads, WakeStatus};
use std::collections::BTreeMap;
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Runs the cases of a sweep. Bench data are read and identified once for all cases.
#[derive(Debug)]
pub(super) struct CaseRunner {
    folder: Folder,
    /// blake3 of bench data by folder.
    hashes: Mutex<BTreeMap<String, String>>,
    /// Actuators by folder of their bench data.
    actuators: Mutex<BTreeMap<String, Arc<BenchActuator>>>,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl CaseRunner {
    /// A runner of cases whose paths are relative to `folder`.
    pub(super) fn new(folder: Folder) -> Self {
        Self { folder, hashes: Mutex::default(), actuators: Mutex::default() }
    }

    /// A case printed anew, with its defaults.
    ///
    /// # Errors
    /// A value that RON cannot express.
    pub(super) fn canonical(loaded: &LoadedCase) -> Result<String, Problem> {
        ron_text(&loaded.case).map_err(|error| {
            let message = format!("cannot be written as a case: {error}");
            Problem::new(Place::file("case"), Fault::Refused { message })
        })
    }

    /// blake3 of every file that a case names: tables of aerofoils, measured files, bench data or actuator file.
    pub(super) fn inputs(&self, loaded: &LoadedCase) -> Result<Vec<String>, Problems> {
        let hash = |source: &Source| blake3::hash(source.text.as_bytes()).to_hex().to_string();
        let mut inputs = loaded.measured.inputs.clone();
        inputs.extend(loaded.table_hashes()?);
        match loaded.actuator_source() {
            ActuatorSource::Ideal => {}
            ActuatorSource::Stored { folder, file } => inputs.push(hash(&folder.read(&file)?)),
            ActuatorSource::Bench(folder) => {
                let mut hashes = lock(&self.hashes);
                let name = folder.display("");
                if !hashes.contains_key(&name) {
                    hashes.insert(name.clone(), read_bench(&folder)?.content_hash);
                }
                inputs.extend(hashes.get(&name).cloned());
            }
        }
        Ok(inputs)
    }

    /// The actuator of bench data, identified once.
    pub(super) fn bench(
        &self,
        loaded: &LoadedCase,
    ) -> Result<Option<Arc<BenchActuator>>, SimError> {
        let ActuatorSource::Bench(folder) = loaded.actuator_source() else { return Ok(None) };
        let mut actuators = lock(&self.actuators);
        let name = folder.display("");
        if let Some(found) = actuators.get(&name) {
            return Ok(Some(found.clone()));
        }
        // data that went meanwhile are no failure of the case: without its hash they are looked for again
        let forget = |_: &SimError| drop(lock(&self.hashes).remove(&name));
        let found = Arc::new(identified(&folder).inspect_err(forget)?);
        // what was identified, whatever was read for the key before
        lock(&self.hashes).insert(name.clone(), found.0.content_hash.clone());
        actuators.insert(name, found.clone());
        Ok(Some(found))
    }

    fn found(&self, loaded: &LoadedCase) -> Result<Found, SimError> {
        let bench = self.bench(loaded)?;
        let actuators = actuators_with(loaded, bench.as_deref())?;
        let trimmed = continued_trim(loaded, None)?;
        let outcome = run_trimmed(loaded, actuators, trimmed, &Progress::hidden())?;
        refuse_diverged(loaded, outcome.trimmed.wake_diverged())?;
        Ok(found_of(outcome.figures(), loaded))
    }
}

/// What keeps a case from having numbers: a disk that takes none, or the case.
pub(super) fn no_numbers(error: SimError) -> NoNumbers {
    match error {
        SimError::Data(error @ DataError::NotWritten { .. }) => NoNumbers::Stopped(error),
        error => NoNumbers::Failed(error.to_string()),
    }
}

/// The figures of a case as its result in a sweep.
pub(super) fn found_of(figures: Figures, loaded: &LoadedCase) -> Found {
    Found { columns: columns(&figures, &loaded.case.scales()), warnings: figures.warnings }
}

impl Runner for CaseRunner {
    type Case = LoadedCase;

    fn version(&self) -> &'static str {
        rotor_study::MODEL_VERSION
    }

    fn folder(&self) -> String {
        self.folder.display("")
    }

    fn read(&self, text: &str) -> Result<ReadCase<LoadedCase>, Problems> {
        let source = Source { name: "case".to_owned(), text: text.to_owned() };
        let loaded = read_case(&source, &self.folder)?;
        let inputs = self.inputs(&loaded)?;
        Ok(ReadCase { canonical: Self::canonical(&loaded)?, inputs, case: loaded })
    }

    fn unit(&self, loaded: &LoadedCase, field: &str) -> Option<String> {
        unit_of(&loaded.case, field).map(str::to_owned)
    }

    fn run(&self, case: LoadedCase) -> Result<Found, NoNumbers> {
        self.found(&case).map_err(no_numbers)
    }
}

/// Columns of hub loads at the blade number per rev, in N and N m.
fn load_columns(prefix: &str, loads: &HubLoads, scales: &RotorScales) -> Vec<(String, Cell)> {
    let (force, moment) = (scales.force_newton(), scales.moment_newton_metre());
    let unit = |i: usize| if i < 3 { ("N", force) } else { ("N_m", moment) };
    let named = HubLoads::NAMES.iter().zip(loads.amplitudes()).enumerate();
    named
        .map(|(i, (name, amplitude))| {
            let (unit, scale) = unit(i);
            (format!("{prefix}{name}_nb_per_rev_{unit}"), (scale * amplitude).into())
        })
        .collect()
}

/// Columns of a control: cost, loads, powers, flaps; named by actuator and set of harmonics.
fn control_columns(line: &ControlLine, scales: &RotorScales) -> Vec<(String, Cell)> {
    let prefix = format!("{}_{}_per_rev_", line.head.actuator, set_name(&line.head.harmonics));
    let mut columns = vec![
        ("status".to_owned(), Cell::Text(line.head.status.clone())),
        ("j_before".to_owned(), line.j_before.into()),
        ("j_after".to_owned(), line.j_after.into()),
        ("reduction_percent".to_owned(), line.reduction_percent.into()),
        ("actuation_power_W".to_owned(), line.actuation_power_watt.into()),
    ];
    for flap in &line.flaps {
        let several = line.head.harmonics.len() > 1;
        let which = if several { format!("_{}_per_rev", flap.harmonic) } else { String::new() };
        let name = flap_name(flap.flap).replace(' ', "_") + &which;
        columns.push((format!("{name}_flap_amplitude_deg"), flap.flap_amplitude_deg.into()));
        columns.push((format!("{name}_voltage_amplitude_V"), flap.voltage_amplitude_volt.into()));
    }
    columns.extend(load_columns("", &line.head.hub_nb_per_rev, scales));
    columns.into_iter().map(|(name, cell)| (format!("{prefix}{name}"), cell)).collect()
}

/// The columns of a result: trim, residuals, power, mean loads, loads without control, and every control.
fn columns(figures: &Figures, scales: &RotorScales) -> Vec<(String, Cell)> {
    let (t, r) = (&figures.trim, &figures.residuals);
    let loads = figures.mean_loads.as_ref();
    let least = figures.stability.least_damped.as_ref();
    let mut columns: Vec<(String, Cell)> = [
        ("theta0_deg", Some(t.theta0_deg)),
        ("theta1c_deg", Some(t.theta1c_deg)),
        ("theta1s_deg", Some(t.theta1s_deg)),
        ("alpha_s_deg", Some(t.alpha_s_deg)),
        ("phi_s_deg", Some(t.phi_s_deg)),
        ("ct_sigma", Some(t.ct_sigma)),
        ("induced_inflow", Some(t.induced_inflow)),
        ("trim_iterations", Some(t.iterations as f64)),
        ("trim_residual", Some(r.trim)),
        ("periodicity_residual", Some(r.periodicity)),
        ("inflow_residual", Some(r.inflow)),
        ("shaft_power_W", loads.map(|loads| loads.shaft_power_watt)),
        ("least_damping_ratio", least.map(|mode| mode.damping_ratio)),
    ]
    .map(|(name, value)| (name.to_owned(), value.into()))
    .to_vec();
    if let Some(wake) = figures.wake {
        columns.push(("wake".to_owned(), Cell::Text(WakeStatus::name(wake).to_owned())));
    }
    let means = loads.into_iter().flat_map(|l| [l.hub_force_newton, l.hub_moment_newton_metre]);
    let units = [["N"; 3], ["N_m"; 3]].concat();
    let means = HubLoads::NAMES.iter().zip(units).zip(means.flatten());
    columns.extend(means.map(|((name, unit), mean)| (format!("{name}_mean_{unit}"), mean.into())));
    columns.extend(load_columns("", &figures.baseline.hub_nb_per_rev, scales));
    columns.extend(figures.control.iter().flat_map(|line| control_columns(line, scales)));
    columns
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{ActuatorChoice, BenchFolder, PAPER_CASE, shipped_case};

    /// Bench data that go after they were hashed are no failure of the case: it cannot be read again, which ends the sweep.
    #[test]
    fn bench_data_that_went_are_looked_for_again() {
        let place = tempfile::tempdir().unwrap();
        let bench = place.path().join("bench");
        std::fs::create_dir(&bench).unwrap();
        let shipped =
            concat!(env!("CARGO_MANIFEST_DIR"), "/../../fixtures/bench/apa500l_synthetic");
        for entry in std::fs::read_dir(shipped).unwrap() {
            let path = entry.unwrap().path();
            std::fs::copy(&path, bench.join(path.file_name().unwrap())).unwrap();
        }
        let mut case = shipped_case(PAPER_CASE).unwrap().case;
        case.actuator.model = ActuatorChoice::Bench(BenchFolder { dataset: "bench".to_owned() });
        let text = ron_text(&case).unwrap();
        let runner = CaseRunner::new(Folder::Disk(place.path().to_path_buf()));
        let read = runner.read(&text).unwrap();
        let lost = std::fs::read_dir(&bench).unwrap().map(|entry| entry.unwrap().path());
        let lost =
            lost.filter(|path| path.extension().is_some_and(|end| end == "csv")).min().unwrap();
        std::fs::remove_file(lost).unwrap();
        assert_eq!(runner.read(&text).unwrap().inputs, read.inputs, "the hash is kept");
        runner.bench(&read.case).unwrap_err();
        assert!(runner.read(&text).is_err(), "a lost file is not looked for");
    }
}
