//! One record as many instruments and programs write it: in unchanged, or refused with a remedy that works at once.
#![expect(clippy::print_stdout, reason = "the counts are worth seeing")]
#![expect(clippy::disallowed_methods, reason = "tests read fixtures and what was written")]
#![expect(clippy::unwrap_used, reason = "a test stops at what it does not expect")]

#[cfg(feature = "hdf5")]
use measured_data::import::read_variables;
use measured_data::import::{ColumnOptions, ImportRequest, MOST_SAMPLES, import};
use measured_data::{Channel, EvenRecord, Source};
use std::path::{Path, PathBuf};

/// Folders of recordings, each with its truth: fewest kinds in it, and fewest that go in without an option.
const FOLDERS: [(&str, usize, usize); 2] =
    [("instruments", 89, 67 + 2 * cfg!(feature = "hdf5") as usize), ("instrument_habits", 101, 74)];

/// A row of `index.tsv`.
struct Recording {
    name: String,
    files: Vec<PathBuf>,
    output_unit: String,
    tolerance: f64,
    step_s: f64,
    rows: usize,
    /// Factors from the truth to input and output.
    factors: [f64; 2],
    needs: String,
}

fn folder() -> PathBuf {
    folder_of("instruments")
}

fn folder_of(name: &str) -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../../fixtures").join(name)
}

fn recordings(folder: &Path) -> Vec<Recording> {
    let text = std::fs::read_to_string(folder.join("index.tsv")).unwrap();
    let recording = |line: &str| {
        let cells: Vec<&str> = line.split('\t').collect();
        let number = |i: usize| cells[i].parse::<f64>().unwrap();
        Recording {
            name: cells[0].to_owned(),
            files: cells[1].split(' ').map(|file| folder.join(file)).collect(),
            output_unit: cells[2].to_owned(),
            tolerance: number(3),
            step_s: number(4),
            rows: cells[5].parse().unwrap(),
            factors: [number(6), number(7)],
            needs: match cells[8] {
                "hdf5" if cfg!(feature = "hdf5") => String::new(),
                "hdf5" => "?".to_owned(),
                needs => needs.to_owned(),
            },
        }
    };
    text.lines().map(recording).collect()
}

/// The numbers of a table and its header.
fn table(path: &Path) -> (Vec<String>, Vec<Vec<f64>>) {
    let text = std::fs::read_to_string(path).unwrap();
    let mut lines = text.lines();
    let header = lines.next().unwrap().split(',').map(str::to_owned).collect();
    let row = |line: &str| line.split(',').map(|cell| cell.parse().unwrap()).collect();
    (header, lines.map(row).collect())
}

/// Imports with the options of a line of the shell; the folder, or what was said.
fn imported(recording: &Recording, options: &str, out: &Path) -> Result<(), String> {
    let mut words = Vec::new();
    for (i, part) in options.split('\'').enumerate() {
        if i % 2 == 1 {
            words.push(part.to_owned());
        } else {
            words.extend(part.split_whitespace().map(str::to_owned));
        }
    }
    let value = |option: &str| {
        let at = words.iter().position(|word| word == option)?;
        words.get(at + 1).cloned()
    };
    let request = ImportRequest {
        files: recording.files.clone(),
        out: out.to_owned(),
        source: None,
        kind: None,
        columns: ColumnOptions { columns: value("--columns"), ..ColumnOptions::default() },
        variable: None,
        range: None,
        sampling_hz: value("--sampling-hz").map(|hz| hz.parse().unwrap()),
        reduce_to_hz: None,
        most_samples: MOST_SAMPLES,
        title: None,
        deg_per_um: None,
        split: words.iter().any(|word| word == "--split"),
    };
    import(&request).map(|_| ()).map_err(|error| error.to_string())
}

/// What is wrong with the record that was written, compared with the truth.
fn wrong(recording: &Recording, truth: &[Vec<f64>], out: &Path) -> Option<String> {
    let mut tables: Vec<PathBuf> =
        std::fs::read_dir(out).unwrap().map(|entry| entry.unwrap().path()).collect();
    tables.retain(|path| path.extension().is_some_and(|e| e == "csv"));
    if recording.rows == 0 {
        return (tables.len() < 2).then(|| format!("{} parts", tables.len()));
    }
    let [path] = &tables[..] else { return Some(format!("{} tables", tables.len())) };
    let (header, rows) = table(path);
    if rows.len() != recording.rows {
        return Some(format!("{} rows", rows.len()));
    }
    let step_s = (rows[rows.len() - 1][0] - rows[0][0]) / (rows.len() - 1) as f64;
    if (step_s / recording.step_s - 1.0).abs() > 1e-3 {
        return Some(format!("a step of {step_s} s"));
    }
    for (column, unit) in [(1, "V"), (2, recording.output_unit.as_str())] {
        let found = Channel::parse(&header[column]).unwrap().unit;
        let Some(factor) = found.factor_to(measured_data::Unit::find(unit).unwrap()) else {
            return Some(format!("the columns {}", header.join(", ")));
        };
        let expected = truth.iter().map(|row| row[column] * recording.factors[column - 1]);
        let (mut low, mut high, mut off) = (f64::INFINITY, f64::NEG_INFINITY, 0.0_f64);
        for (row, expected) in rows.iter().zip(expected) {
            (low, high) = (low.min(expected), high.max(expected));
            off = off.max((factor * row[column] - expected).abs());
        }
        if off > recording.tolerance * (high - low) {
            return Some(format!("{} by {:.2e}", header[column], off / (high - low)));
        }
    }
    None
}

/// The option that a message names, as it stands there.
fn printed(message: &str, rate_hz: f64) -> String {
    let options = ["--columns", "--sampling-hz", "--split"].into_iter();
    let (at, option) = options.filter_map(|o| Some((message.find(o)?, o))).min().unwrap();
    let rest = message[at + option.len()..].trim_start();
    let value = match rest.strip_prefix('\'') {
        Some(rest) => rest.split('\'').next().unwrap(),
        None => rest.split([' ', ';', '\n']).next().unwrap(),
    };
    // the rate is the user's to know
    let rate = format!("--sampling-hz {rate_hz}");
    match option {
        "--columns" if message.contains("--sampling-hz RATE") => {
            format!("--columns '{value}' {rate}")
        }
        "--columns" => format!("--columns '{value}'"),
        "--sampling-hz" => rate,
        _ => option.to_owned(),
    }
}

#[test]
fn any_recording_goes_in_or_says_what_helps() {
    for (name, least, least_in) in FOLDERS {
        let (all, inside, flaws) = tried(&folder_of(name));
        assert!(flaws.is_empty(), "{name}\n{}", flaws.join("\n"));
        assert!(all >= least && inside >= least_in, "{name}: {inside} of {all}");
    }
}

/// Recordings of a folder, how many go in without an option, and what is wrong.
fn tried(of: &Path) -> (usize, usize, Vec<String>) {
    let (_, truth) = table(&of.join("truth.csv"));
    let folder = tempfile::tempdir().unwrap();
    let all = recordings(of);
    let (mut inside, mut helped, mut refused) = (0, 0, 0);
    let mut flaws = Vec::new();
    for recording in &all {
        let name = &recording.name;
        let out = folder.path().join(name);
        let said = imported(recording, "", &out);
        match (said, recording.needs.as_str()) {
            (Ok(()), "") => {
                inside += 1;
                flaws.extend(wrong(recording, &truth, &out).map(|what| format!("{name}: {what}")));
            }
            (Ok(()), needs) => {
                flaws.push(format!("{name}: went in, where it needs {needs}"));
            }
            (Err(said), "") => flaws.push(format!("{name}: {said}")),
            (Err(said), "?") => {
                refused += 1;
                let advises = ["save", "export", "write", "copy", "sort", "numpy.", "pandas."];
                if !advises.iter().any(|word| said.contains(word)) {
                    flaws.push(format!("{name}: no remedy in: {said}"));
                }
            }
            (Err(said), needs) => {
                helped += 1;
                let literal = printed(&said, 1.0 / recording.step_s);
                let place = folder.path().join("literal");
                match imported(recording, &literal, &place) {
                    Ok(()) => {
                        let what = wrong(recording, &truth, &place);
                        flaws.extend(what.map(|what| format!("{name}: {literal}: {what}")));
                    }
                    Err(more) => flaws.push(format!("{name}: {literal} does not help: {more}")),
                }
                let _ = std::fs::remove_dir_all(place);
                match imported(recording, needs, &out) {
                    Ok(()) => {
                        let what = wrong(recording, &truth, &out);
                        flaws.extend(what.map(|what| format!("{name}: {what}")));
                    }
                    Err(more) => flaws.push(format!("{name}: {needs} does not help: {more}")),
                }
            }
        }
    }
    println!(
        "{} recordings: {inside} in without an option, {helped} with the option that is named, {refused} refused, {} wrong",
        all.len(),
        flaws.len()
    );
    (all.len(), inside, flaws)
}

/// What goes in without an option is a record of its own as well, with the numbers that the import writes.
#[test]
fn a_record_of_its_own_is_read_as_the_import_reads_it() {
    let folder = tempfile::tempdir().unwrap();
    for (name, ..) in FOLDERS {
        let of = folder_of(name);
        let mut read = 0;
        for recording in recordings(&of) {
            let out = folder.path().join(&recording.name);
            let [file] = &recording.files[..] else { continue };
            if imported(&recording, "", &out).is_err() {
                continue;
            }
            let mut tables: Vec<PathBuf> =
                std::fs::read_dir(&out).unwrap().map(|entry| entry.unwrap().path()).collect();
            tables.retain(|path| path.extension().is_some_and(|e| e == "csv"));
            let (header, rows) = table(&tables[0]);
            let own = EvenRecord::open(file, &ColumnOptions::default(), None).unwrap();
            assert_eq!(own.time_s.len(), rows.len(), "{}", recording.name);
            for (column, beside) in [(1, 2), (2, 1)] {
                let own = own.column(&header[column], &header[beside]).unwrap();
                let own = own.unwrap_or_else(|| panic!("{}: {header:?}", recording.name));
                let values = own.values;
                let most = values.iter().fold(0.0, |most: f64, own| most.max(own.abs()));
                for (own, row) in values.iter().zip(&rows) {
                    assert!((own - row[column]).abs() <= 1e-6 * most, "{}", recording.name);
                }
            }
            read += 1;
        }
        println!("{name}: {read} records of their own");
        assert!(read >= 60, "{name}: {read}");
    }
}

/// The times of a `LabVIEW` measurement stand in its column, where it has one, whatever its one step says.
#[test]
fn times_of_a_labview_measurement_say_more_than_its_step() {
    let text = |columns: &str| {
        let head = format!("LabVIEW Measurement\nX_Columns\t{columns}\n***End_of_Header***\n");
        let own = "Channels\t2\nY_Unit_Label\tVolts\tMicrometers\nDelta_X\t1.0\t1.0\n***End_of_Header***\n";
        let row = |k: u32| format!("{:.4}\t{}\t{}", 0.002 * f64::from(k), k % 7, k % 5);
        let rows = (0..40).map(row).collect::<Vec<_>>().join("\n");
        format!("{head}{own}X_Value\tCommand\tDisplacement\n{rows}")
    };
    let read = |text: String| EvenRecord::read(&Source { name: "a.lvm".into(), text }).unwrap();
    assert!((read(text("One")).step_s - 0.002).abs() < 1e-9);
    // without a column of times the step is all there is
    assert!((read(text("No")).step_s - 1.0).abs() < 1e-9);
}

/// What a record of its own needs beside a time: a name, or one column of the quantity.
#[test]
fn columns_are_found_by_name_and_quantity() {
    let read =
        |text: &str| EvenRecord::read(&Source { name: "a.csv".into(), text: text.into() }).unwrap();
    let own = read("time_ms;u_mV;weg_mm\n0;1000;0,001\n1;2000;0,002\n2;3000;0,003\n");
    assert!((own.step_s - 1e-3).abs() < 1e-12);
    let command = own.column("command_V", "displacement_um").unwrap().unwrap();
    assert_eq!((&command.label[..], &command.values[..]), ("u_mV", &[1.0, 2.0, 3.0][..]));
    let displacement = own.column("displacement_um", "command_V").unwrap().unwrap();
    assert_eq!(displacement.values, [1.0, 2.0, 3.0]);
    // an output in volts is not the command
    assert_eq!(own.column("sensor_V", "command_V").unwrap(), None);
    assert_eq!(own.column("load_N", "command_V").unwrap(), None);
    let two = read("time_s,a_V,command_V\n0,1,2\n1,1,3\n2,1,4\n");
    let command = two.column("command_V", "displacement_um").unwrap().unwrap();
    assert_eq!(command.values, [2.0, 3.0, 4.0]);
    // what another quantity is named is no command
    for other in ["sensor_V", "Amplifier_V"] {
        let text = format!("time_s,{other},weg_um\n0,1,2\n1,1,3\n2,1,4\n");
        assert_eq!(read(&text).column("command_V", "displacement_um").unwrap(), None, "{other}");
    }
    let same = read("time_s,command_V,command_mV\n0,1,2\n1,1,3\n2,1,4\n");
    let said = same.column("command_V", "displacement_um").unwrap_err().to_string();
    assert!(said.contains("2 columns are called `command`"), "{said}");
    let said = own.missing("load_N").to_string();
    assert!(said.contains("`load_N` is missing") && said.contains("u_mV, weg_mm"), "{said}");
}

/// Workbooks and TDMS files that are cut off are refused; a flipped byte of a workbook is seen by its checksum, one of a
/// TDMS file changes a number at most.
#[test]
fn damaged_files_are_refused_and_end_nothing() {
    let folder = tempfile::tempdir().unwrap();
    let (_, truth) = table(&self::folder().join("truth.csv"));
    for recording in recordings(&self::folder()) {
        let [file] = &recording.files[..] else { continue };
        let is = |ending: &str| file.extension().is_some_and(|e| e == ending);
        if !is("xlsx") && !is("tdms") {
            continue;
        }
        let bytes = std::fs::read(file).unwrap();
        let damaged =
            Recording { files: vec![folder.path().join(file.file_name().unwrap())], ..recording };
        let mut tries = 0;
        let mut import_of = |bytes: &[u8]| {
            tries += 1;
            std::fs::write(&damaged.files[0], bytes).unwrap();
            let out = folder.path().join(format!("{tries}{}", damaged.name));
            imported(&damaged, "", &out).map(|()| out)
        };
        for end in (1..8).map(|k| k * bytes.len() / 8) {
            assert!(import_of(&bytes[..end]).is_err(), "{}, cut at {end}", damaged.name);
        }
        for at in (0..bytes.len()).step_by(bytes.len() / 60) {
            let mut flipped = bytes.clone();
            flipped[at] ^= 0x10;
            if let Ok(out) = import_of(&flipped) {
                let what = if is("xlsx") { wrong(&damaged, &truth, &out) } else { None };
                assert!(what.is_none(), "{}, byte {at}: {what:?}", damaged.name);
            }
        }
    }
}

/// Bytes of chance in an HDF5 file, or its end cut off: an error or other numbers, never a panic.
#[cfg(feature = "hdf5")]
#[test]
fn damaged_hdf5_never_panics() {
    for name in ["hdf5_units.h5", "matlab_v73.mat", "hdf5.h5"] {
        let bytes = std::fs::read(folder().join(name)).unwrap();
        assert!(!read_variables(&bytes).unwrap().is_empty(), "{name}");
        let mut state = 1_u64;
        let mut chance = |below: usize| {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            usize::try_from(state >> 33).unwrap() % below
        };
        for _ in 0..4000 {
            let mut damaged = bytes.clone();
            for _ in 0..=chance(4) {
                // the first bytes hold the structure
                let end = if chance(2) == 0 { bytes.len() } else { bytes.len().min(2048) };
                damaged[chance(end)] = chance(256).to_le_bytes()[0];
            }
            if chance(8) == 0 {
                damaged.truncate(chance(bytes.len()));
            }
            let _ = read_variables(&damaged);
        }
    }
}
