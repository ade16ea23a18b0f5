//! Hinge moments of a flap against closed forms: a blade that does not move, in hover without pitch and
//! without inflow.

use std::f64::consts::TAU;

use flap_aero::{FlapChord, TheodorsenFunctions};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec};
use rotor_response::{
    Condition, Controls, Couplings, Discretisation, HingeMoment, RotorModel, TrailingEdgeFlap,
};
use rotor_wake::{FlightState, LinearInflow};

use crate::rotor::{paper_rotor, response};
use validation::Failure;

/// The outboard flap of the paper's rotor.
fn outboard() -> TrailingEdgeFlap {
    let [_, outboard] = TrailingEdgeFlap::paper_case();
    outboard
}

/// `int x^n dx` over the flap.
fn span(n: i32) -> f64 {
    let flap = outboard();
    (flap.end.powi(n + 1) - flap.start.powi(n + 1)) / f64::from(n + 1)
}

fn hinge_moment(
    flap: TrailingEdgeFlap,
    angle: HarmonicSeries,
) -> Result<(RotorModel, HingeMoment), Failure> {
    let model = RotorModel { flaps: vec![flap], ..paper_rotor(Couplings::Full, 0.2) };
    let condition = Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio: 0.0, shaft_tilt_rad: 0.0 },
        controls: Controls::default(),
        flap_angles_rad: vec![angle],
    };
    let stiff = BladeProperties::new(BladeSpec::uniform(1e5, 1e5, 1e5, 1e5))?;
    let still = LinearInflow::Prescribed { induced_inflow: 0.0 };
    let found = response(model.clone(), &stiff, Discretisation::default(), &condition, &still)?;
    Ok((model, found.hinge.into_iter().next().unwrap_or_default()))
}

/// Distance of the 4/rev inertial hinge moment of a flap with its centre of gravity at `cg_fraction`
/// from that of the paper's flap, %.
pub(crate) fn inertial_error(cg_fraction: f64) -> Result<f64, Failure> {
    let amplitude = 0.02;
    let mut angle = HarmonicSeries::zero(4);
    angle.set_harmonic(4, Harmonic { cosine: amplitude, sine: 0.0 });
    let flap = outboard();
    let (model, found) = hinge_moment(TrailingEdgeFlap { cg_fraction, ..flap }, angle)?;
    let flap_chord = flap.chord_fraction * model.chord;
    let (cg, d) = (flap.cg_fraction * flap_chord, (0.75 - flap.chord_fraction) * model.chord);
    let about_hinge = cg * cg + flap_chord * flap_chord / 12.0;
    let expected = flap.mass_fraction * (15.0 * about_hinge - d * cg) * span(0) * amplitude;
    Ok(100.0 * (found.inertial.harmonic(4).cosine / expected - 1.0).abs())
}

/// Distance of the steady aerodynamic hinge moment from Theodorsen's, %.
pub(crate) fn aerodynamic_error() -> Result<f64, Failure> {
    let mean = 3.0_f64.to_radians();
    let angle = HarmonicSeries { mean, ..HarmonicSeries::zero(1) };
    let flap = outboard();
    let (model, found) = hinge_moment(flap, angle)?;
    let t = TheodorsenFunctions::new(FlapChord::new(flap.chord_fraction)?.hinge());
    let slope = -(t.t::<18>() + t.t::<12>() * t.t::<10>()) / TAU;
    let expected = 0.5 * model.density_chord() * model.chord * slope * mean * span(2);
    Ok(100.0 * (found.aerodynamic.mean / expected - 1.0).abs())
}
