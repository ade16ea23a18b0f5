//! A case as a person writes it: its problems with their lines, and the frequencies of the rotor it describes.
//!
//! ```text
//! cargo run -p sim-driver --example case_file
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use measured_data::{Folder, Source};
use rotor_fem::GyroscopicTerms;
use rotor_study::{AboutState, ModesQuestion, rotating_modes};
use sim_driver::SimError;
use sim_driver::case::read_case;
use std::path::PathBuf;

const WRONG: &str = "(
    advance_ratio: 0.7,
    rotor: (blades: 4, chord_r: -0.055),
    response: (time_oder: 5),
)";

/// The paper's rotor with nothing but its title; every other field has the paper's value.
const PAPER: &str = "(title: \"the rotor of the paper\")";

/// Flap and lag frequencies at 8 deg of pitch and -8 deg of twist, per rev:
/// `fixtures/reference/rotor/bo105_pitch_coupled_frequencies.csv`.
const REFERENCE: [(&str, f64); 4] =
    [("lag", 0.690_680), ("flap", 1.132_344), ("flap", 3.416_783), ("lag", 4.302_368)];

fn main() -> Result<(), SimError> {
    let folder = Folder::Disk(PathBuf::from("."));
    let source = |text: &str| Source { name: "my.ron".into(), text: text.into() };
    if let Err(problems) = read_case(&source(WRONG), &folder) {
        println!("{problems}\n");
    }

    let case = read_case(&source(PAPER), &folder)?.case;
    let question = ModesQuestion {
        terms: GyroscopicTerms::Neglected,
        pitch_rad: 8.0_f64.to_radians(),
        about: AboutState::Undeformed,
        ..ModesQuestion::default()
    };
    let mut modes = rotating_modes(&case, &question)?.modes;
    modes.sort_by(|a, b| a.hz.total_cmp(&b.hz));
    println!("{}\nmode       Hz   per rev  reference", case.title);
    let bending = modes.iter().filter(|mode| mode.kind != "torsion");
    for (mode, (kind, reference)) in bending.zip(REFERENCE) {
        let per_rev = mode.per_rev.unwrap_or(f64::NAN);
        println!("{:6} {:7.3} {per_rev:9.5}  {reference:.5} ({kind})", mode.kind, mode.hz);
    }
    Ok(())
}
