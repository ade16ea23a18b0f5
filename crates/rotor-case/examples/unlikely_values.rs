//! What is wrong and what is unlikely about a rotor, before anything is computed: the torsion stiffness of the default
//! case, made softer step by step.
//!
//! `cargo run -p rotor-case --example unlikely_values`
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use rotor_case::Case;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    println!("{:>10}  said of the case", "GJ");
    for factor in [1.0, 0.3, 0.1, 0.03, -1.0] {
        let mut case = Case::default();
        case.rotor.gj *= factor;
        let gj = case.rotor.gj;
        if let Err(faults) = case.check() {
            println!("{gj:10.2e}  {faults}");
            continue;
        }
        let warnings = case.plausibility_warnings()?;
        if warnings.is_empty() {
            println!("{gj:10.2e}  nothing");
        }
        for warning in warnings {
            println!("{gj:10.2e}  {}: {}", warning.field, warning.message);
        }
    }
    Ok(())
}
