//! Momentum inflow with Drees's gradients from hover to fast flight, and the vortex kernel on a ring.
//!
//! ```text
//! cargo run -p rotor-wake --example inflow_and_ring
//! ```
#![expect(clippy::print_stdout, reason = "the example prints what it computes")]

use rotor_wake::{
    CoreModel, FlightState, InflowModel, LinearInflow, RotorLoading, SegmentSet, Vec3, WakeError,
    induced_velocities, wake_skew_rad,
};
use std::f64::consts::{PI, TAU};

fn main() -> Result<(), WakeError> {
    println!("C_T 0.0049, shaft tilt 5 deg: induced inflow over the tip speed");
    println!("  mu    mean      C_T / 2 mu     over the tail   over the nose   skew, deg");
    for mu in [0.0, 0.1, 0.2, 0.3] {
        let tilt = if mu == 0.0 { 0.0 } else { 5.0_f64.to_radians() };
        let flight = FlightState { advance_ratio: mu, shaft_tilt_rad: tilt };
        let loading = RotorLoading::from_thrust_coefficient(0.0049);
        let inflow = LinearInflow::Drees.induced(&flight, &loading)?;
        let mean = inflow.mean();
        let wing = if mu == 0.0 { "-".into() } else { format!("{:.5}", 0.0049 / (2.0 * mu)) };
        let (tail, nose) = (inflow.at(0.0, 0.8), inflow.at(PI, 0.8));
        let skew = wake_skew_rad(&flight, mean).to_degrees();
        println!("{mu:4} {mean:10.6} {wing:>12} {tail:16.5} {nose:15.5} {skew:12.1}");
    }

    println!("\nvelocity at the centre of a vortex ring, Gamma/R; exact 1/2");
    for segments in [36_u32, 72, 144, 288] {
        let node = |k: u32| -> Vec3 {
            let (sin, cos) = (TAU * f64::from(k) / f64::from(segments)).sin_cos();
            [cos, sin, 0.0]
        };
        let mut ring = SegmentSet::new(CoreModel::Vatistas);
        for k in 0..segments {
            ring.push(node(k), node(k + 1), 1.0, 0.0);
        }
        let velocity = induced_velocities(&[[0.0; 3]], &ring)[0][2];
        println!("{segments:4} segments {velocity:10.6}   error {:9.2e}", velocity - 0.5);
    }
    Ok(())
}
