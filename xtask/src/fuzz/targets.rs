//! The readers, and valid inputs to begin with.

use std::path::{Path, PathBuf};

use bench_study::stored::{StoredActuator, read_actuator};
use case_sweep::{Merged, StoredCase, read_sweep_file};
use rotor_gap::read_table;
use sim_driver::actuator_use::used;
use sim_driver::case::{load_case, read_case};
use sim_driver::files::{Folder, Source, read_airfoil, read_dataset};
use sim_driver::import::{ColumnOptions, ImportRequest, SourceKind, import};
use sim_driver::results::{StoredResult, figures};

use super::bytes::Form;
use super::seeds;
use crate::XtaskError;
use crate::files::{in_folder, read, read_bytes, write_atomically};

/// Whether the actuator of a file takes a record.
type Use = fn([&Path; 2]) -> bool;

/// Whether a reader takes an input.
type Read = Box<dyn Fn(&[u8]) -> bool>;

/// A reader.
pub(super) struct Target {
    /// Its name.
    pub(super) reader: &'static str,
    /// What its inputs are made of.
    pub(super) form: Form,
    /// Valid inputs.
    pub(super) valid: Vec<Vec<u8>>,
    /// Gives it an input; whether it was taken.
    pub(super) read: Read,
}

/// A record of the bench, and curves of a magnetometer.
const RECORD: &str = "sine_20hz_25v.csv";
const FORC: &str = "MicroMag 2900/3900 Data File (Series 0015)\nUnits of measure: cgs\n\"wires\"\nHCal = 1000\nNCrv = 3\nNData = 12\n
1000,1e-3\n\n200,0\n300,1e-4\n400,2e-4\n\n1000,1.001e-3\n\n100,0\n200,1e-4\n300,2e-4\n
1000,1.002e-3\n\n0,0\n100,1e-4\n200,2e-4\n\nMicroMag 2900/3900 Data File ends\n";

/// Actuators with laws of their own.
const ACTUATORS: [&str; 2] = [
    "(kind: Actuator, title: \"by hand\", model: (law: BoucWen(range_volt: (-20, 150), gain_deg_per_volt: 0.12, \
     half_height_deg: 0.9, rise_volt: 30, sigma: 0.8, exponent: 2), range_volt: (-20, 150), \
     calibration: (deg_per_um: 0.04, zero_um: 0)))",
    "(kind: Actuator, title: \"by hand\", channels: Some((input: \"current_A\", output: \"force_N\")), \
     model: (law: Linear(gain_deg_per_volt: -0.1, bias_volt: 0), range_volt: (0, 1), \
     calibration: (deg_per_um: 1, zero_um: 0)))",
];

/// A folder of anyone's simulator.
const TABLE: [(&str, &str); 4] = [
    (
        "measured.csv",
        "point,frequency_Hz,x1_um,x1_um_sd,x2_um,x2_um_sd\na,1,10.2,0.1,5.1,0.1\nb,2,8.1,0.1,4.4,0.1\nc,3,6.3,0.1,,\n",
    ),
    ("predicted.csv", "point,frequency_Hz,x1_um,x2_um\na,1,10,5\nb,2,8,4.3\nc,3,6,3.5\n"),
    (
        "effect_spring.csv",
        "point,frequency_Hz,x1_um,x2_um\na,1,10.5,5.1\nb,2,8.2,4.5\nc,3,6.4,3.6\n",
    ),
    (
        "table.ron",
        "(title: \"t\", effects: [(name: \"spring\", amount: 1.05, none: 1.0, range: (0.5, 2.0), parameter: \"ratio\", unit: \"1\", physics: \"stiff\", form_error_percent: 4)], conditions: [\"frequency_Hz\"], gain_percent: 0.5, accuracy: [(channel: \"x1_um\", gain_percent: 2.0, zero: 5.0)])",
    ),
];

/// Rows of a sweep.
const ROWS: &str =
    "advance_ratio,rotor.gj,inflow.model\n0.2,0.005,Drees\n0.3,0.006,\"FreeWake(preset: Fast)\"\n";

/// Most bytes of an input, and of a record that goes with it: a part of a long file is as good.
const MOST_BYTES: usize = 40_000;
const MOST_RECORD_BYTES: usize = 2_000;

fn text(bytes: &[u8]) -> Source {
    Source { name: "input".to_owned(), text: String::from_utf8_lossy(bytes).into_owned() }
}

fn bytes_of(path: &Path) -> Result<Vec<u8>, XtaskError> {
    start_of(path, MOST_BYTES)
}

/// At most so many bytes from the start of a file.
fn start_of(path: &Path, most: usize) -> Result<Vec<u8>, XtaskError> {
    let mut bytes = read_bytes(path)?;
    if bytes.len() > most {
        // whole lines
        let end = bytes[..most].iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
        bytes.truncate(end);
    }
    Ok(bytes)
}

/// A reader of a file on disk: the input is written there before it is read.
#[expect(clippy::disallowed_methods, reason = "an input that cannot be written is no input")]
fn on_disk(path: PathBuf, read: impl Fn() -> bool + 'static) -> Read {
    Box::new(move |bytes| std::fs::write(&path, bytes).is_ok() && read())
}

/// All readers; those of files have a folder below `place`.
pub(super) fn targets(root: &Path, place: &Path) -> Result<Vec<Target>, XtaskError> {
    let mut targets = of_texts(root)?;
    targets.extend(of_use(place)?);
    targets.extend(of_folders(root, place)?);
    targets.extend(of_imports(&root.join("fixtures"), place)?);
    Ok(targets)
}

/// The readers of a text.
fn of_texts(root: &Path) -> Result<Vec<Target>, XtaskError> {
    let fixtures = root.join("fixtures");
    let all = |names: &[&str]| -> Result<Vec<Vec<u8>>, XtaskError> {
        names.iter().map(|name| bytes_of(&fixtures.join(name))).collect()
    };
    let book = read(&root.join("docs/src/case-format.md"))?;
    let every_stage = book.split_once("<!-- every stage -->").and_then(|(_, rest)| {
        Some(rest.split_once("```text\n")?.1.split_once("```")?.0.as_bytes().to_vec())
    });
    let actuators: Vec<Vec<u8>> =
        every_stage.into_iter().chain(ACTUATORS.map(|text| text.as_bytes().to_vec())).collect();
    let cases = Folder::Disk(fixtures.join("cases"));
    let earlier = root.join("crates/sim-driver/tests/data/earlier_result/result.json");
    let sweep = b"(base: \"c.ron\", axes: [(field: \"a.b[0]\", values: [1, X(y: 2), [3]]), (field: \"x\", from: 1, to: 2, count: 3)], sampling: LatinHypercube(count: 9, seed: 1))";
    let stored = b"\"version\":\"1\",\"inputs\":[\"a\"],\"case\":\"(x: 1)\",\"outcome\":{\"found\":{\"columns\":[[\"a_deg\",1.5e-3],[\"b\",\"w\"],[\"c\",null]],\"warnings\":[]}}}\n";
    let merged = b"{\"axes\":[\"rotor.gj\",\"model\"],\"axis_units\":[\"m0\",\"\"],\"columns\":[\"a_deg\",\"b\"],\"cases\":[{\"case\":1,\"key\":\"0f\",\"values\":{\"rotor.gj\":0.005,\"model\":\"X\"},\"found\":{\"a_deg\":1.5e-3,\"b\":null},\"warnings\":[\"w\"]},{\"case\":2,\"key\":\"1f\",\"values\":{\"rotor.gj\":0.006,\"model\":\"X\"},\"failed\":\"why\",\"found\":{},\"warnings\":[]}]}";
    Ok(vec![
        Target {
            reader: "case",
            form: Form::Nested,
            valid: all(&[
                "cases/paper_mu030.ron",
                "cases/stalled_mu030.ron",
                "cases/hart_ii_bl.ron",
                "cases/controllers_mu030.ron",
            ])?,
            read: Box::new(move |bytes| read_case(&text(bytes), &cases).is_ok()),
        },
        Target {
            reader: "sweep file",
            form: Form::Nested,
            valid: vec![sweep.to_vec(), b"(base: \"c.ron\", rows: \"r.csv\")".to_vec()],
            read: Box::new(|bytes| {
                read_sweep_file(&text(bytes), &Folder::Disk("no-such-folder".into())).is_ok()
            }),
        },
        Target {
            reader: "stored case",
            form: Form::Nested,
            valid: vec![stored.to_vec()],
            // hash and key are made to fit, or the rest would never be read
            read: Box::new(|bytes| {
                let rest = text(bytes).text;
                let object = format!("{{{}", rest.trim_end_matches('\n'));
                let stored = serde_json::from_str::<StoredCase>(&object);
                let key = stored.map_or_else(|_| "no key".to_owned(), |stored| stored.key());
                let hash = blake3::hash(object.as_bytes()).to_hex();
                StoredCase::of(&format!("{{\"hash\":\"{hash}\",{rest}"), &key).is_some()
            }),
        },
        Target {
            reader: "merged sweep",
            form: Form::Nested,
            valid: vec![merged.to_vec()],
            read: Box::new(|bytes| serde_json::from_slice::<Merged>(bytes).is_ok()),
        },
        Target {
            reader: "result",
            form: Form::Nested,
            valid: vec![bytes_of(&earlier)?],
            // beyond the hash, which refuses all of them
            read: Box::new(|bytes| {
                let stored = serde_json::from_str::<StoredResult>(&text(bytes).text).ok();
                stored.is_some_and(|stored| {
                    let setting = stored.setting();
                    setting
                        .is_ok_and(|setting| !figures(&stored.result, &setting).control.is_empty())
                })
            }),
        },
        Target {
            reader: "C81",
            form: Form::Fixed,
            valid: all(&["airfoils/naca0012_synthetic.c81"])?,
            read: Box::new(|bytes| read_airfoil(&text(bytes)).is_ok()),
        },
        Target {
            reader: "actuator",
            form: Form::Nested,
            valid: actuators,
            read: Box::new(|bytes| read_actuator(&text(bytes)).is_ok()),
        },
    ])
}

/// The readers of what a case and an actuator are given beside them.
fn of_use(place: &Path) -> Result<Vec<Target>, XtaskError> {
    let folder = place.join("t_file");
    let (case, cases) = (text(seeds::T_CASE.as_bytes()), Folder::Disk(folder.clone()));
    write_atomically(&folder.join(seeds::T_FILE), "")?;
    let mut targets = vec![Target {
        reader: "T file",
        form: Form::Nested,
        valid: seeds::t_files(),
        read: on_disk(folder.join(seeds::T_FILE), move || read_case(&case, &cases).is_ok()),
    }];
    let actuator = place.join("use/plays.ron");
    write_atomically(&actuator, seeds::PLAYS)?;
    let measured = [("command_V", 60.0), ("displacement_um", 80.0)];
    for (reader, valid, of) in [
        (
            "predict CSV",
            [&measured[..1], &measured[..]],
            (|files| {
                used(files, (&ColumnOptions::default(), None), StoredActuator::predicted).is_ok()
            }) as Use,
        ),
        ("invert CSV", [&measured[1..], &[("flap_deg", 2.0)][..]], |files| {
            used(files, (&ColumnOptions::default(), None), StoredActuator::inverted).is_ok()
        }),
    ] {
        let (own, actuator) = (place.join("use").join(reader.replace(' ', "_")), actuator.clone());
        targets.push(Target {
            reader,
            form: Form::Table,
            valid: valid.map(seeds::record).to_vec(),
            read: on_disk(own.clone(), move || of([&actuator, &own])),
        });
    }
    Ok(targets)
}

/// The readers of folders: one file of each is changed.
fn of_folders(root: &Path, place: &Path) -> Result<Vec<Target>, XtaskError> {
    let fixtures = root.join("fixtures");
    let mut targets = Vec::new();
    for (reader, form, of, own) in [
        ("dataset.ron", Form::Nested, "points/ignored_hysteresis", "dataset.ron"),
        ("points CSV", Form::Table, "points/stall_naca0012", "points.csv"),
        ("loops", Form::Nested, "measured/friction_damper", "dataset.ron"),
        ("record CSV", Form::Table, "bench/apa500l_synthetic", RECORD),
    ] {
        let folder = place.join(reader.replace(' ', "_"));
        copy(&fixtures.join(of), &folder, own)?;
        let data = Folder::Disk(folder.clone());
        targets.push(Target {
            reader,
            form,
            valid: vec![start_of(
                &fixtures.join(of).join(own),
                if own == RECORD { 12_000 } else { MOST_BYTES },
            )?],
            read: on_disk(folder.join(own), move || read_dataset(&data).is_ok()),
        });
    }
    for (reader, form, own) in
        [("table.ron", Form::Nested, "table.ron"), ("table CSV", Form::Table, "measured.csv")]
    {
        let folder = place.join(reader.replace(' ', "_"));
        for (name, text) in TABLE {
            write_atomically(&folder.join(name), text)?;
        }
        let valid = TABLE.iter().filter(|(name, _)| *name == own);
        let data = Folder::Disk(folder.clone());
        targets.push(Target {
            reader,
            form,
            valid: valid.map(|(_, text)| text.as_bytes().to_vec()).collect(),
            read: on_disk(folder.join(own), move || read_table(&data).is_ok()),
        });
    }
    let (folder, own) = (place.join("sweep_rows"), "rows.csv");
    write_atomically(&folder.join(own), ROWS)?;
    let rows = Folder::Disk(folder.clone());
    let sweep = text(b"(base: \"c.ron\", rows: \"rows.csv\")");
    targets.push(Target {
        reader: "sweep rows",
        form: Form::Table,
        valid: vec![ROWS.as_bytes().to_vec()],
        read: on_disk(folder.join(own), move || read_sweep_file(&sweep, &rows).is_ok()),
    });
    let (folder, measured) = (place.join("measured"), fixtures.join("measured/hart_ii"));
    copy(&measured, &folder.join("measured/hart_ii"), "")?;
    let case = folder.join("cases/hart_ii_mn.ron");
    write_atomically(&case, &read(&fixtures.join("cases/hart_ii_mn.ron"))?)?;
    let own = "airloads_087r_harmonics.csv";
    targets.push(Target {
        reader: "measured airloads",
        form: Form::Table,
        valid: vec![bytes_of(&measured.join(own))?],
        read: on_disk(folder.join("measured/hart_ii").join(own), move || load_case(&case).is_ok()),
    });
    Ok(targets)
}

/// Arrays that say themselves what they are.
const HDF5: &str = "import HDF5";

/// The importers, with what instruments and programs write.
fn of_imports(fixtures: &Path, place: &Path) -> Result<Vec<Target>, XtaskError> {
    let of_ending = |endings: &[&str]| -> Result<Vec<Vec<u8>>, XtaskError> {
        let is_one = |path: &PathBuf| {
            let ending = path.extension().unwrap_or_default().to_string_lossy().into_owned();
            endings.contains(&ending.as_str())
        };
        let files = in_folder(&fixtures.join("instruments"))?;
        files.iter().filter(|path| is_one(path)).map(|path| bytes_of(path)).collect()
    };
    let mat =
        [vec![bytes_of(&fixtures.join("mat/bench_struct.mat"))?], of_ending(&["mat"])?].concat();
    let hdf5 = vec![bytes_of(&fixtures.join("instruments/hdf5_units.h5"))?];
    let record = vec![bytes_of(&fixtures.join("bench/apa500l_synthetic").join(RECORD))?];
    let mut targets = Vec::new();
    for (reader, form, source, valid) in [
        ("import CSV", Form::Table, SourceKind::Csv, [record, of_ending(&["csv"])?].concat()),
        ("import text", Form::Table, SourceKind::Csv, of_ending(&["txt", "asc", "lvm", "dat"])?),
        ("import gzip", Form::Gzip, SourceKind::Csv, of_ending(&["gz"])?),
        ("import others", Form::Binary, SourceKind::Csv, of_ending(&["npy", "json"])?),
        ("import workbook", Form::Zip, SourceKind::Csv, of_ending(&["xlsx"])?),
        ("import TDMS", Form::Binary, SourceKind::Tdms, of_ending(&["tdms"])?),
        ("import MAT", Form::Mat, SourceKind::Mat, mat),
        (HDF5, Form::Binary, SourceKind::Mat, hdf5),
        ("import FORC", Form::Table, SourceKind::MicromagForc, vec![FORC.into()]),
    ] {
        let file = place.join(reader.replace(' ', "_"));
        let out = place.join(format!("{}_out", reader.replace(' ', "_")));
        let request = request(&file, &out, (source, reader != HDF5));
        targets.push(Target {
            reader,
            form,
            valid,
            read: on_disk(file, move || {
                let taken = import(&request).is_ok();
                // the next one writes there anew
                let _ = std::fs::remove_dir_all(&out);
                taken
            }),
        });
    }
    Ok(targets)
}

/// A data folder that is quick to read: the file that is changed, and the others that go with it.
#[expect(clippy::disallowed_methods, reason = "a copy of a fixture")]
fn copy(from: &Path, to: &Path, own: &str) -> Result<(), XtaskError> {
    let failed = |source| XtaskError::Write { path: to.to_path_buf(), source };
    std::fs::create_dir_all(to).map_err(failed)?;
    if own == RECORD {
        let dataset = format!(
            "(kind: ActuatorBench, title: \"t\", runs: [(id: \"a\", file: \"{own}\", role: Reference)])"
        );
        return std::fs::write(to.join("dataset.ron"), dataset).map_err(failed);
    }
    for entry in std::fs::read_dir(from).map_err(failed)?.flatten() {
        let name = entry.file_name();
        // of long records the start
        let is_long = entry.metadata().is_ok_and(|found| found.len() >= 30_000);
        let most = if is_long { MOST_RECORD_BYTES } else { usize::MAX };
        std::fs::write(to.join(name), start_of(&entry.path(), most)?).map_err(failed)?;
    }
    Ok(())
}

fn request(file: &Path, out: &Path, (source, is_named): (SourceKind, bool)) -> ImportRequest {
    let is_mat = source == SourceKind::Mat && is_named;
    ImportRequest {
        files: vec![file.to_path_buf()],
        out: out.to_path_buf(),
        source: Some(source),
        kind: None,
        columns: ColumnOptions {
            columns: is_mat.then(|| "time_ms=t,command_V=u,displacement_um=x".to_owned()),
            ..ColumnOptions::default()
        },
        variable: is_mat.then(|| "bench.run(2)".to_owned()),
        range: None,
        sampling_hz: None,
        reduce_to_hz: None,
        most_samples: 1 << 12,
        title: None,
        deg_per_um: None,
        split: false,
    }
}
