//! T of one flap and two loads, handed to other programs as a table and as JSON.
//!
//! ```text
//! cargo run -p rotor-export --example t_for_others
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it makes")]

use rotor_export::{Axis, DataFormat, Document, LabelledArray, data_files};

/// Cosine and sine of the 4/rev thrust, N, for a volt of cosine and sine at 3/rev.
const T: [[f64; 2]; 2] = [[1.8, -0.6], [0.6, 1.8]];

fn main() -> Result<(), Box<dyn std::error::Error>> {
    let names = |of: &str| ["cos", "sin"].map(|part| format!("{of}_{part}")).to_vec();
    let loads = Axis::of_unit("load", names("fz_4_per_rev"), "N");
    let controls = Axis::of_unit("control", names("flap1_3_per_rev"), "V");
    let meaning = "N of 4/rev thrust for a V at 3/rev";
    let t = LabelledArray::from_fn("T_3", meaning, vec![loads, controls], |i, j, _| T[i][j]);
    let document = Document { arrays: vec![t], ..Document::default() };
    for format in [DataFormat::Csv, DataFormat::Json] {
        for (name, bytes) in data_files(&document, "rotor", format) {
            println!("{name}\n{}", String::from_utf8(bytes)?);
        }
    }
    Ok(())
}
