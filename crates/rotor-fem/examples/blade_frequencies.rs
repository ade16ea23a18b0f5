//! Frequencies of the paper's uniform blade (Table 1) beside the exact ones, at pitch, and over the rotor speed.
//!
//! ```text
//! cargo run -p rotor-fem --example blade_frequencies
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use rotor_fem::{
    BladeProperties, BladeSpec, FemError, ModalBasis, ModeCount, ModeKind, uncoupled_modes,
};

/// Per rev: power series in 60 digits, `fixtures/reference/rotor/bo105_uniform_frequencies.csv`; torsion in
/// closed form with the paper's radii of gyration.
const EXACT: [(ModeKind, &[f64]); 3] = [
    (ModeKind::Flap, &[1.125_789_21, 3.421_609_8, 7.667_070_72, 13.915_885]),
    (ModeKind::Lag, &[0.701_362_786, 4.299_964_31, 10.899_359_4, 20.656_413_3]),
    (ModeKind::Torsion, &[4.588_073]),
];

fn main() -> Result<(), FemError> {
    let blade = BladeProperties::new(BladeSpec::table_1())?;
    println!("                         error, % with");
    println!("mode        exact, /rev   5 elements  10 elements  20 elements");
    for (kind, exact) in EXACT {
        for (mode, &per_rev) in exact.iter().enumerate() {
            let errors = [5, 10, 20].map(|elements| {
                let set = uncoupled_modes(
                    &blade,
                    elements,
                    ModeCount { flap: 4, lag: 4, torsion: 1, axial: 0 },
                    ModalBasis::Natural,
                )?;
                Ok(100.0 * (set.of(kind)[mode].per_rev / per_rev - 1.0))
            });
            let name = format!("{kind:?} {}", mode + 1);
            print!("{name:10} {per_rev:12.6}");
            for error in errors {
                print!(" {:12.5}", error.map_err(|e: FemError| e)?);
            }
            println!();
        }
    }
    Ok(())
}
