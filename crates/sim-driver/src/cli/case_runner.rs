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
use rotor_case::Case;
use rotor_study::{CurveComparison, HubLoads, TrimmedRotor, WakeStatus};
use std::collections::{BTreeMap, VecDeque};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};

/// Rotors that are kept though no running case has them.
const IDLE_ROTORS: usize = 2;

/// Where cases of one rotor find it, once one of them has trimmed it.
type SharedRotor = Arc<Mutex<Option<TrimmedRotor>>>;

/// Runs the cases of a sweep. Bench data are read and identified once for all cases; cases of one rotor share its trim and its
/// linearised T.
#[derive(Debug)]
pub(super) struct CaseRunner {
    folder: Folder,
    /// blake3 of bench data by folder.
    hashes: Mutex<BTreeMap<String, String>>,
    /// Actuators by folder of their bench data.
    actuators: Mutex<BTreeMap<String, Arc<BenchActuator>>>,
    /// Rotors in trim, the latest first, by what they depend on.
    rotors: Mutex<VecDeque<(String, SharedRotor)>>,
}

fn lock<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

impl CaseRunner {
    /// A runner of cases whose paths are relative to `folder`.
    pub(super) fn new(folder: Folder) -> Self {
        Self {
            folder,
            hashes: Mutex::default(),
            actuators: Mutex::default(),
            rotors: Mutex::default(),
        }
    }

    /// A case printed anew, with its defaults.
    ///
    /// # Errors
    /// A value that RON cannot express.
    pub(super) fn canonical(case: &Case) -> Result<String, Problem> {
        ron_text(case).map_err(|error| {
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

    /// Where the cases of this rotor find it.
    fn shared(&self, loaded: &LoadedCase) -> Result<SharedRotor, SimError> {
        let of_rotor = Self::canonical(&loaded.case.of_rotor())?;
        let key = format!("{of_rotor}{:?}", loaded.table_hashes()?);
        let mut rotors = lock(&self.rotors);
        let known = rotors.iter().position(|(known, _)| *known == key);
        let (key, place) = known.and_then(|at| rotors.remove(at)).unwrap_or((key, Arc::default()));
        let mut idle = 0;
        rotors.retain(|(_, place)| {
            idle += usize::from(Arc::strong_count(place) == 1);
            idle <= IDLE_ROTORS || Arc::strong_count(place) > 1
        });
        rotors.push_front((key, place.clone()));
        Ok(place)
    }

    fn found(&self, loaded: &LoadedCase) -> Result<Found, SimError> {
        let bench = self.bench(loaded)?;
        let actuators = actuators_with(loaded, bench.as_deref())?;
        let shared = self.shared(loaded)?;
        let trimmed = {
            // a second case waits; a trim that fails is tried again, for the fault names the case
            let mut kept = lock(&shared);
            match kept.as_ref() {
                Some(trimmed) => trimmed.clone(),
                None => kept.insert(continued_trim(loaded, None)?).clone(),
            }
        };
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
        Ok(ReadCase { canonical: Self::canonical(&loaded.case)?, inputs, case: loaded })
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

/// Columns of a measured curve: agreement of its harmonics from 1/rev and from 2/rev on, means left out, distance with means, and
/// what is above the listed harmonics on both sides of the disk.
fn measured_columns(line: &CurveComparison) -> Vec<(String, Cell)> {
    let station = line.station_r.map_or_else(String::new, |r| format!("_r{r}").replace('.', "p"));
    let name = line.quantity.name();
    let last = line.last_harmonic;
    let mut columns = vec![(format!("measured_{name}{station}_distance"), line.distance.into())];
    for (first, of) in [(1, line.from_1), (2, line.from_2)] {
        let start = format!("measured_{name}{station}_{first}_to_{last}_per_rev_");
        columns.push((format!("{start}correlation"), of.correlation.into()));
        columns.push((format!("{start}rms"), of.rms.into()));
    }
    for (side, peak) in ["advancing", "retreating"].iter().zip(&line.computed_band) {
        let start = format!("{name}{station}_{side}_band_");
        let size = peak.as_ref().map(|peak| peak.peak_to_peak);
        columns.push((format!("{start}peak_to_peak"), size.into()));
        let azimuth_deg = peak.as_ref().map(|peak| peak.azimuth_deg);
        columns.push((format!("{start}azimuth_deg"), azimuth_deg.into()));
    }
    columns
}

/// The columns of a result: trim, residuals, power, mean loads, loads without control, agreement with what was
/// measured, and every control.
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
    columns.extend(figures.measured.iter().flat_map(measured_columns));
    let vortices = figures.vortices.map(|found| found.vertical_percent_r);
    columns.extend(
        vortices.map(|rms| ("measured_vortices_vertical_percent_r".to_owned(), rms.into())),
    );
    columns.extend(figures.control.iter().flat_map(|line| control_columns(line, scales)));
    columns
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::{ActuatorChoice, BenchFolder, PAPER_CASE, shipped_case};
    use rotor_case::{ControlActuator, ControllerChoice, EffortChoice};
    use rotor_study::{
        LISTED_HARMONICS, MeasuredCurve, MeasuredData, Quantity, compare_curves, series_of,
    };

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

    /// Cases that differ in control alone share a rotor, and have the numbers that they have alone, bit for bit.
    #[test]
    fn neighbours_share_a_trim_and_keep_their_bits() {
        let mut case = shipped_case(PAPER_CASE).unwrap().case;
        case.structure.elements = 4;
        case.structure.modes = [1, 1, 1].into();
        case.response.span_points_per_piece = 2;
        case.actuator.model = ActuatorChoice::Ideal;
        case.control.harmonics = vec![vec![3]];
        case.control.actuators = vec![ControlActuator::Ideal];
        let mut weighted = case.clone();
        weighted.control.load_weights.fz = 4.0;
        let mut local = case.clone();
        local.control.controller = ControllerChoice::Local;
        local.control.effort = EffortChoice::Limits;
        local.title = "another".to_owned();
        let mut heavier = case.clone();
        heavier.rotor.lock_number *= 1.01;
        let found = |runner: &CaseRunner, case: &Case| {
            let read = runner.read(&ron_text(case).unwrap()).unwrap();
            runner.found(&read.case).unwrap()
        };
        let anywhere = || CaseRunner::new(Folder::Disk(".".into()));
        let shared = anywhere();
        for (case, rotors) in [(&case, 1), (&weighted, 1), (&local, 1), (&heavier, 2)] {
            let alone = found(&anywhere(), case);
            let beside = found(&shared, case);
            assert_eq!(format!("{:?}", beside.columns), format!("{:?}", alone.columns));
            assert_eq!(lock(&shared.rotors).len(), rotors, "{}", case.title);
        }
        // the rotor that is kept is the one that is flown: another one in its place is felt
        let place = |at: usize| lock(&shared.rotors)[at].1.clone();
        let (heavy, light) = (place(0), place(1));
        *lock(&light) = lock(&heavy).clone();
        let (own, other) = (found(&anywhere(), &weighted), found(&shared, &weighted));
        assert_ne!(format!("{:?}", other.columns), format!("{:?}", own.columns));
    }

    /// A computed curve beside itself agrees with itself, under the names that the book gives.
    #[test]
    fn a_measured_curve_has_columns_of_agreement() {
        let values: Vec<f64> =
            (0..360).map(|i| (0.5 + f64::from(i).to_radians().cos()).powi(12)).collect();
        let measured = MeasuredCurve {
            quantity: Quantity::NormalM2,
            station_r: Some(0.87),
            source: String::new(),
            measured: MeasuredData::Harmonics(series_of(&values, LISTED_HARMONICS)),
        };
        let columns: BTreeMap<String, Cell> =
            measured_columns(&compare_curves(&measured, &values)).into_iter().collect();
        let number = |name: &str| match columns.get(name) {
            Some(Cell::Number(value)) => *value,
            other => panic!("{name}: {other:?}"),
        };
        let correlation = number("measured_cn_m2_r0p87_1_to_6_per_rev_correlation");
        assert!((correlation - 1.0).abs() < 1e-12, "{correlation}");
        assert!(number("measured_cn_m2_r0p87_2_to_6_per_rev_rms") < 1e-12);
        assert!(number("cn_m2_r0p87_advancing_band_peak_to_peak") > 0.0);
    }
}
