//! MAT files written byte by byte here, in both byte orders, plain and compressed.

use super::select::select;
use super::value::{MatValue, inflate};
use super::*;
use flate2::write::ZlibEncoder;
use proptest::prelude::*;
use std::io::Write;

/// Writes MAT files; shares no code with the reader.
struct Writer {
    little: bool,
}

impl Writer {
    fn u16(&self, v: u16) -> Vec<u8> {
        if self.little { v.to_le_bytes().to_vec() } else { v.to_be_bytes().to_vec() }
    }

    fn u32(&self, v: u32) -> Vec<u8> {
        if self.little { v.to_le_bytes().to_vec() } else { v.to_be_bytes().to_vec() }
    }

    fn f64(&self, v: f64) -> Vec<u8> {
        if self.little { v.to_le_bytes().to_vec() } else { v.to_be_bytes().to_vec() }
    }

    fn element(&self, kind: u32, data: &[u8]) -> Vec<u8> {
        let mut out = self.u32(kind);
        out.extend(self.u32(u32::try_from(data.len()).unwrap()));
        out.extend(data);
        out.resize(out.len().next_multiple_of(8), 0);
        out
    }

    /// The form with size and type in one word.
    fn short(&self, kind: u32, data: &[u8]) -> Vec<u8> {
        let mut out = self.u32(u32::try_from(data.len()).unwrap() << 16 | kind);
        out.extend(data);
        out.resize(8, 0);
        out
    }

    fn array(&self, class: u32, sizes: &[u32], name: &str, rest: &[u8]) -> Vec<u8> {
        let mut body = self.element(6, &[self.u32(class), self.u32(0)].concat());
        body.extend(self.element(5, &sizes.iter().flat_map(|s| self.u32(*s)).collect::<Vec<_>>()));
        body.extend(if name.len() <= 4 && !name.is_empty() {
            self.short(1, name.as_bytes())
        } else {
            self.element(1, name.as_bytes())
        });
        body.extend(rest);
        self.element(14, &body)
    }

    fn matrix(&self, name: &str, sizes: &[u32], values: &[f64]) -> Vec<u8> {
        let data: Vec<u8> = values.iter().flat_map(|v| self.f64(*v)).collect();
        self.array(6, sizes, name, &self.element(9, &data))
    }

    /// A double array stored as bytes, as MATLAB does with small whole numbers.
    fn packed(&self, name: &str, values: &[u8]) -> Vec<u8> {
        let sizes = [u32::try_from(values.len()).unwrap(), 1];
        self.array(6, &sizes, name, &self.element(2, values))
    }

    fn text(&self, name: &str, text: &str) -> Vec<u8> {
        let data: Vec<u8> = text.encode_utf16().flat_map(|c| self.u16(c)).collect();
        let sizes = [1, u32::try_from(text.len()).unwrap()];
        self.array(4, &sizes, name, &self.element(17, &data))
    }

    fn structure(&self, name: &str, sizes: &[u32], fields: &[&str], values: &[Vec<u8>]) -> Vec<u8> {
        let mut rest = self.short(5, &self.u32(16));
        let mut names = Vec::new();
        for field in fields {
            let mut padded = field.as_bytes().to_vec();
            padded.resize(16, 0);
            names.extend(padded);
        }
        rest.extend(self.element(1, &names));
        rest.extend(values.concat());
        self.array(2, sizes, name, &rest)
    }

    fn cell(&self, name: &str, values: &[Vec<u8>]) -> Vec<u8> {
        let sizes = [1, u32::try_from(values.len()).unwrap()];
        self.array(1, &sizes, name, &values.concat())
    }

    fn compressed(&self, array: &[u8]) -> Vec<u8> {
        let mut encoder = ZlibEncoder::new(Vec::new(), flate2::Compression::default());
        encoder.write_all(array).unwrap();
        let data = encoder.finish().unwrap();
        // compressed elements are not padded
        [self.u32(15), self.u32(u32::try_from(data.len()).unwrap()), data].concat()
    }

    fn file(&self, variables: &[Vec<u8>]) -> Vec<u8> {
        let mut out = b"MATLAB 5.0 MAT-file, written by a test".to_vec();
        out.resize(124, b' ');
        out.extend(self.u16(0x0100));
        out.extend(self.u16(0x4d49));
        out.extend(variables.concat());
        out
    }
}

const TIME: [f64; 5] = [0.0, 0.25, 0.5, 0.75, 1.0];
const U: [f64; 5] = [-20.0, 65.0, 150.0, 65.0, -20.0];
const X: [f64; 5] = [0.0, 90.5, 210.0, 120.25, 3.0];

/// `bench.note`, `bench.run(1:2).{t, u, x}`, `parts{2}`, `flat`, in either order of bytes.
fn sample(little: bool, compress: bool) -> Vec<u8> {
    let w = Writer { little };
    let run = |scale: f64| {
        let u: Vec<f64> = U.iter().map(|u| scale * u).collect();
        vec![w.matrix("", &[5, 1], &TIME), w.matrix("", &[5, 1], &u), w.matrix("", &[1, 5], &X)]
    };
    let runs = w.structure("", &[1, 2], &["t", "u", "x"], &[run(1.0), run(0.5)].concat());
    let bench = w.structure(
        "bench",
        &[1, 1],
        &["note", "run", "rate"],
        &[w.text("", "Bühne 7"), runs, w.matrix("", &[1, 1], &[4.0])],
    );
    let flat: Vec<f64> = TIME.iter().chain(&U).chain(&X).copied().collect();
    let cells = w.cell("parts", &[w.text("", "first"), w.matrix("", &[5, 3], &flat)]);
    let all = [bench, cells, w.matrix("flat", &[5, 3], &flat), w.packed("ab", &[1, 2, 200])];
    let all = all.map(|array| if compress { w.compressed(&array) } else { array });
    w.file(&all)
}

#[test]
fn both_byte_orders_plain_and_compressed_read_alike() {
    let reference = read_variables(&sample(true, false)).unwrap();
    for (little, compress) in [(true, true), (false, false), (false, true)] {
        assert_eq!(read_variables(&sample(little, compress)).unwrap(), reference);
    }
    let names: Vec<&str> = reference.iter().map(|(n, _)| n.as_str()).collect();
    assert_eq!(names, ["bench", "parts", "flat", "ab"]);
    assert_eq!(
        reference[3].1,
        MatValue::Numeric { sizes: vec![3, 1], values: vec![1.0, 2.0, 200.0] }
    );
    let MatValue::Struct(fields) = &reference[0].1 else { panic!("{:?}", reference[0]) };
    assert_eq!(fields[0], ("note".to_owned(), MatValue::Text("Bühne 7".to_owned())));
}

#[test]
fn paths_lead_through_structures_and_cells() {
    let variables = read_variables(&sample(false, true)).unwrap();
    let run = select(&variables, Some("bench.run(2)")).unwrap();
    assert_eq!(run.names.as_deref().unwrap(), ["t", "u", "x"]);
    assert_eq!(run.columns[1], [-10.0, 32.5, 75.0, 32.5, -10.0]);
    assert_eq!(run.columns[2], X);
    for path in ["parts{2}", "flat"] {
        let found = select(&variables, Some(path)).unwrap();
        assert_eq!(found.columns, [TIME, U, X]);
        assert_eq!(found.names, None);
    }
    let error = |path: &str| select(&variables, Some(path)).unwrap_err().to_string();
    assert!(error("bench.run").contains("is an array of structures; choose one as in name(1)"));
    assert!(
        error("bench.runs").contains("`bench.runs` is not there; the file has: bench.run(1).t 5x1")
    );
    assert!(error("bench.run(3)").contains("index beyond"));
    assert!(error("bench.run.t").contains("goes through an array of structures"));
    assert!(error("bench.note").contains("is a text"));
    assert!(error("parts").contains("choose one as in name{1}"));
    assert!(error("ab").contains("is no matrix of several columns"));
    assert!(error("bench..run").contains("is no path"));
    // several variables, no path: their vectors, if there are some of one length
    assert!(select(&variables, None).unwrap_err().to_string().contains("no vectors of one length"));
}

#[test]
fn rows_stand_for_columns_where_there_are_more_columns() {
    let w = Writer { little: true };
    let wide: Vec<f64> = (0..5).flat_map(|i| [TIME[i], U[i], X[i]]).collect();
    let file = w.file(&[w.matrix("wide", &[3, 5], &wide)]);
    let found = select(&read_variables(&file).unwrap(), None).unwrap();
    assert_eq!(found.columns, [TIME, U, X]);
}

#[test]
fn vectors_of_the_commonest_length_are_the_record() {
    let vector = |name: &str, values: &[f64]| {
        let sizes = vec![values.len(), 1];
        (name.to_owned(), MatValue::Numeric { sizes, values: values.to_vec() })
    };
    let long: Vec<f64> = (0..9).map(f64::from).collect();
    let mut all = vec![vector("t", &TIME), vector("long", &long), vector("u", &U), vector("x", &X)];
    assert_eq!(select(&all, None).unwrap().columns, [TIME, U, X]);
    // of two lengths as common as one another the longer one
    all.remove(3);
    all.push(vector("longer", &long));
    assert_eq!(select(&all, None).unwrap().columns, [&long[..], &long[..]]);
}

#[test]
fn a_record_with_units_of_its_own() {
    let options = ColumnOptions {
        columns: Some("time_s=t,command_V=u,displacement_mm=x".into()),
        ..ColumnOptions::default()
    };
    let reduction =
        Reduction { most_samples: 64, reduce_to_hz: None, sampling_hz: None, split: false };
    let read = |variable, options: &ColumnOptions| {
        read_mat(
            &sample(true, true),
            "b.mat",
            (options, variable),
            Reading::Folder(None),
            reduction,
        )
    };
    let (table, taken) = read(Some("bench.run(1)"), &options).unwrap();
    assert_eq!(table.choice.labels(), ["time_s", "command_V", "displacement_um"]);
    assert!((table.parts[0].columns[1][2] - 210_000.0).abs() < 1e-9);
    assert!(taken.contains("t, u, x of 5 samples"), "{taken}");
    let error = read(Some("bench.run(1)"), &ColumnOptions::default()).err().unwrap().to_string();
    assert!(error.contains("b.mat: the column `t` has no known unit"), "{error}");
    let error = read(Some("flat"), &ColumnOptions::default()).err().unwrap().to_string();
    assert!(error.contains("the 3 columns have no names"), "{error}");
}

#[test]
fn other_formats_are_recognised() {
    let order = |bytes: &[u8]| byte_order(bytes, true);
    let refused = |bytes: &[u8], as_what: &str| {
        assert_eq!(order(bytes).unwrap().is_ok(), cfg!(feature = "hdf5"));
        let text = read_variables(bytes).unwrap_err().to_string();
        assert!(text.starts_with(as_what) && text.contains("'-v7'"), "{text}");
    };
    assert_eq!(order(&sample(true, false)), Some(Ok(true)));
    assert_eq!(order(&sample(false, false)), Some(Ok(false)));
    let mut hdf5 = b"MATLAB 7.3 MAT-file, Platform: GLNXA64".to_vec();
    hdf5.resize(512, b' ');
    hdf5.extend(b"\x89HDF\r\n\x1a\n");
    refused(&hdf5, "is an HDF5 file");
    refused(b"\x89HDF\r\n\x1a\n and so on", "is an HDF5 file");
    assert_eq!(order(b"time_s,command_V,displacement_um\n0,1,2\n"), None);
}

#[test]
fn sizes_that_lie_are_refused() {
    let w = Writer { little: true };
    let refused = |array: Vec<u8>| read_variables(&w.file(&[array])).unwrap_err().to_string();
    let huge = w.array(1, &[u32::MAX / 4, u32::MAX / 4, 4], "c", &[]);
    assert!(refused(huge).contains("damaged MAT file at byte"));
    let cells = w.array(1, &[1 << 30, 1], "c", &[]);
    assert!(refused(cells).contains("truncated"));
    let structs = w.structure("s", &[1 << 30, 1], &["a"], &[]);
    assert!(refused(structs).contains("truncated"));
    assert!(
        refused(w.matrix("m", &[7, 1], &TIME))
            .contains("sizes of an array and its numbers disagree")
    );
    let mut deep = w.matrix("", &[1, 1], &[1.0]);
    for _ in 0..60 {
        deep = w.cell("", &[deep]);
    }
    assert!(refused(w.cell("deep", &[deep])).contains("nested too deeply"));
}

#[test]
fn every_prefix_is_an_error_or_fewer_variables() {
    for compress in [false, true] {
        let file = sample(true, compress);
        let all = read_variables(&file).unwrap();
        for cut in 0..file.len() {
            if let Ok(variables) = read_variables(&file[..cut]) {
                assert!(variables.len() < all.len() || variables == all, "cut at {cut}");
            }
        }
    }
}

proptest! {
    #![proptest_config(ProptestConfig { cases: 4000, failure_persistence: None, ..ProptestConfig::default() })]

    /// Changed bytes never make the reader panic, hang or use memory without bound.
    #[test]
    fn damaged_files_never_panic(
        little in any::<bool>(),
        compress in any::<bool>(),
        changes in prop::collection::vec((any::<prop::sample::Index>(), any::<u8>()), 1..8),
    ) {
        let mut file = sample(little, compress);
        for (index, byte) in changes {
            let at = index.index(file.len());
            file[at] = byte;
        }
        if let Ok(variables) = read_variables(&file) {
            for path in [None, Some("bench.run(1)"), Some("flat"), Some("parts{2}")] {
                let _ = select(&variables, path);
            }
        }
    }

    /// Bytes of chance behind a good header never make the reader panic.
    #[test]
    fn bytes_of_chance_never_panic(
        little in any::<bool>(),
        bytes in prop::collection::vec(any::<u8>(), 0..400),
    ) {
        let mut file = Writer { little }.file(&[]);
        file.extend(bytes);
        let _ = read_variables(&file);
    }
}

#[test]
fn a_compressed_variable_is_not_inflated_beyond_the_room_left() {
    let mut encoder = ZlibEncoder::new(Vec::new(), flate2::Compression::best());
    encoder.write_all(&vec![0; 100_000]).unwrap();
    let packed = encoder.finish().unwrap();
    let bytes = Bytes::new(&packed, 0, true, true);
    assert_eq!(inflate(&bytes, 100_000).unwrap().len(), 100_000);
    let refused = inflate(&bytes, 99_999).unwrap_err();
    assert!(refused.to_string().contains("more than 1 GiB"), "{refused}");
}
