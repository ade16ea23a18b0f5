//! The readers, and valid inputs to begin with.

use std::path::{Path, PathBuf};

use case_sweep::{StoredCase, read_sweep_file};
use sim_driver::case::read_case;
use sim_driver::files::{Folder, Source, read_airfoil, read_dataset};
use sim_driver::import::{ColumnOptions, ImportRequest, SourceKind, import};
use sim_driver::results::{StoredResult, figures};

use crate::XtaskError;
use crate::files::read_bytes;

/// Whether a reader takes an input.
type Read = Box<dyn Fn(&[u8]) -> bool>;

/// A reader.
pub(super) struct Target {
    /// Its name.
    pub(super) reader: &'static str,
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

/// Most bytes of an input: a part of a long file is as good.
const MOST_BYTES: usize = 40_000;

fn text(bytes: &[u8]) -> Source {
    Source { name: "input".to_owned(), text: String::from_utf8_lossy(bytes).into_owned() }
}

fn bytes_of(path: &Path) -> Result<Vec<u8>, XtaskError> {
    let mut bytes = read_bytes(path)?;
    if bytes.len() > MOST_BYTES {
        // whole lines
        let end =
            bytes[..MOST_BYTES].iter().rposition(|byte| *byte == b'\n').map_or(0, |at| at + 1);
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
    let fixtures = root.join("fixtures");
    let all = |names: &[&str]| -> Result<Vec<Vec<u8>>, XtaskError> {
        names.iter().map(|name| bytes_of(&fixtures.join(name))).collect()
    };
    let cases = Folder::Disk(fixtures.join("cases"));
    let earlier = root.join("crates/sim-driver/tests/data/earlier_result/result.json");
    let sweep = b"(base: \"c.ron\", axes: [(field: \"a.b[0]\", values: [1, X(y: 2), [3]]), (field: \"x\", from: 1, to: 2, count: 3)], sampling: LatinHypercube(count: 9, seed: 1))";
    let stored = b"\"version\":\"1\",\"inputs\":[\"a\"],\"case\":\"(x: 1)\",\"outcome\":{\"found\":{\"columns\":[[\"a_deg\",1.5e-3],[\"b\",\"w\"],[\"c\",null]],\"warnings\":[]}}}\n";
    let mut targets = vec![
        Target {
            reader: "case",
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
            valid: vec![sweep.to_vec(), b"(base: \"c.ron\", rows: \"r.csv\")".to_vec()],
            read: Box::new(|bytes| {
                read_sweep_file(&text(bytes), &Folder::Disk("no-such-folder".into())).is_ok()
            }),
        },
        Target {
            reader: "stored case",
            valid: vec![stored.to_vec()],
            // the hash is made to fit, or the rest would never be read
            read: Box::new(|bytes| {
                let rest = text(bytes).text;
                let hash = blake3::hash(format!("{{{}", rest.trim_end_matches('\n')).as_bytes());
                let whole = format!("{{\"hash\":\"{}\",{rest}", hash.to_hex());
                StoredCase::of(&whole, "no key").is_some()
            }),
        },
        Target {
            reader: "result",
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
            valid: all(&["airfoils/naca0012_synthetic.c81"])?,
            read: Box::new(|bytes| read_airfoil(&text(bytes)).is_ok()),
        },
    ];
    for (reader, of, own) in [
        ("dataset.ron", "points/ignored_hysteresis", "dataset.ron"),
        ("points CSV", "points/stall_naca0012", "points.csv"),
        ("loops", "measured/friction_damper", "dataset.ron"),
        ("record CSV", "bench/apa500l_synthetic", RECORD),
    ] {
        let folder = place.join(reader.replace(' ', "_"));
        copy(&fixtures.join(of), &folder, own)?;
        let data = Folder::Disk(folder.clone());
        targets.push(Target {
            reader,
            valid: vec![bytes_of(&fixtures.join(of).join(own))?],
            read: on_disk(folder.join(own), move || read_dataset(&data).is_ok()),
        });
    }
    let record = bytes_of(&fixtures.join("bench/apa500l_synthetic").join(RECORD))?;
    let mat = bytes_of(&fixtures.join("mat/bench_struct.mat"))?;
    let tdms = bytes_of(&fixtures.join("instruments/labview_tdms.tdms"))?;
    let workbook = bytes_of(&fixtures.join("instruments/excel_xlsx.xlsx"))?;
    let oscilloscope = bytes_of(&fixtures.join("instruments/tek_mso5.csv"))?;
    for (reader, source, valid) in [
        ("import CSV", SourceKind::Csv, record),
        ("import preamble", SourceKind::Csv, oscilloscope),
        ("import workbook", SourceKind::Csv, workbook),
        ("import TDMS", SourceKind::Tdms, tdms),
        ("import MAT", SourceKind::Mat, mat),
        ("import FORC", SourceKind::MicromagForc, FORC.into()),
    ] {
        let file = place.join(reader.replace(' ', "_"));
        let out = place.join(format!("{}_out", reader.replace(' ', "_")));
        let request = request(&file, &out, source);
        targets.push(Target {
            reader,
            valid: vec![valid],
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
        // long records are left out: the dataset then names what is not there
        if entry.metadata().is_ok_and(|found| found.len() < 30_000) {
            std::fs::copy(entry.path(), to.join(name)).map_err(failed)?;
        }
    }
    Ok(())
}

fn request(file: &Path, out: &Path, source: SourceKind) -> ImportRequest {
    let is_mat = source == SourceKind::Mat;
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
