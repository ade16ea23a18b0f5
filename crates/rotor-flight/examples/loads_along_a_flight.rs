//! Vibration of the default rotor along an acceleration, from knots of advance ratio at which it was trimmed.
//!
//! ```text
//! cargo run --release -p rotor-flight --example loads_along_a_flight
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use rotor_case::Case;
use rotor_flight::{FlightError, FlightState, RotorPath};

fn main() -> Result<(), FlightError> {
    let path = RotorPath::new(&Case::default(), &[0.20, 0.25, 0.30])?;
    println!("advance ratio   size of the hub loads at the blade number per rev, flaps at rest");
    for k in 0..=8_u32 {
        let advance_ratio = 0.20 + 0.0125 * f64::from(k);
        let loads = path.loads(FlightState { advance_ratio, thrust_share: 0.0 }, &[])?;
        let size = loads.iter().map(|load| load * load).sum::<f64>().sqrt();
        println!("{advance_ratio:13.4}   {size:.6}");
    }
    Ok(())
}
