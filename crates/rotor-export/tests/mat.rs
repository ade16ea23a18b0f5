//! The MAT file in another program: `SciPy` reads every number as it was written. Nothing is checked where it is not there.

#![expect(clippy::disallowed_methods, reason = "tests write what another program reads")]

use rotor_export::{Axis, DataFormat, Document, LabelledArray, data_files};
use std::path::Path;
use std::process::Command;

const SCRIPT: &str = "
from scipy.io import loadmat
t = loadmat('x.mat')['T_2']
values = t['values'][0, 0]
print(*[str(label[0]) for label in t['row_labels'][0, 0][0]])
print(*[values[i, j, k].hex() for k in range(5) for j in range(3) for i in range(2)])
";

#[test]
fn scipy_reads_every_number_as_it_was_written() {
    let there = Command::new("python3").args(["-c", "import scipy.io"]).output();
    if !there.is_ok_and(|found| found.status.success()) {
        println!("SciPy is not there: nothing was read");
        return;
    }
    let axis = |name: &str, count: usize| {
        Axis::of_unit(name, (0..count).map(|k| format!("{name}{k}")).collect(), "N")
    };
    let axes = vec![axis("load", 2), axis("control", 3), axis("point", 5)];
    let t = LabelledArray::from_fn("T_2", "dZ/du", axes, |i, j, k| {
        1e-7 * (1.0 + i as f64 - 2.0 * j as f64) / (3.0 + 7.0 * k as f64)
    });
    let document = Document { arrays: vec![t.clone()], ..Document::default() };
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("rotor-export").join("mat");
    std::fs::create_dir_all(&folder).unwrap();
    for (name, bytes) in data_files(&document, "x", DataFormat::Mat) {
        std::fs::write(folder.join(name), bytes).unwrap();
    }
    let read = Command::new("python3").args(["-c", SCRIPT]).current_dir(&folder).output().unwrap();
    let text = String::from_utf8(read.stdout).unwrap();
    let mut lines = text.lines();
    assert_eq!(lines.next().unwrap(), "load0 load1", "{}", String::from_utf8_lossy(&read.stderr));
    let found: Vec<&str> = lines.next().unwrap().split(' ').collect();
    // 52 bits in hexadecimal digits, the first one before the point
    let hex = |value: f64| {
        let bits = value.abs().to_bits();
        let exponent = i64::try_from(bits >> 52).unwrap() - 1023;
        let sign = if value < 0.0 { "-" } else { "" };
        format!("{sign}0x1.{:013x}p{exponent:+}", bits & ((1 << 52) - 1))
    };
    // a zero has no leading 1
    let expected = t.values.iter().map(|value| match *value {
        0.0 => "0x0.0p+0".to_owned(),
        value => hex(value),
    });
    assert_eq!(found, expected.collect::<Vec<String>>());
}
