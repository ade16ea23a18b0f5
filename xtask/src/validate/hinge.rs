//! Hinge moments of a flap against closed forms: a blade that does not move, in hover without pitch and
//! without inflow.

use std::f64::consts::TAU;

use flap_aero::{FlapChord, FlapEffectiveness, TheodorsenFunctions};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec};
use rotor_response::{
    Condition, Controls, Couplings, Discretisation, FlapMass, HingeMoment, RotorModel,
    TrailingEdgeFlap,
};
use rotor_wake::{FlightState, LinearInflow};

use super::CheckError;
use super::rotor::{paper_rotor, response};

/// The outboard flap of the paper's rotor.
const FLAP: TrailingEdgeFlap = TrailingEdgeFlap {
    start: 0.80,
    end: 0.85,
    chord_fraction: 0.2,
    mass_fraction: 0.1,
    cg_fraction: 0.2,
    gyration_fraction: None,
    mass: FlapMass::PartOfBlade,
    effectiveness: FlapEffectiveness::IDEAL,
};

/// `int x^n dx` over the flap.
fn span(n: i32) -> f64 {
    (FLAP.end.powi(n + 1) - FLAP.start.powi(n + 1)) / f64::from(n + 1)
}

fn hinge_moment(
    flap: TrailingEdgeFlap,
    angle: HarmonicSeries,
) -> Result<(RotorModel, HingeMoment), CheckError> {
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
pub(super) fn inertial_error(cg_fraction: f64) -> Result<f64, CheckError> {
    let amplitude = 0.02;
    let mut angle = HarmonicSeries::zero(4);
    angle.set_harmonic(4, Harmonic { cosine: amplitude, sine: 0.0 });
    let (model, found) = hinge_moment(TrailingEdgeFlap { cg_fraction, ..FLAP }, angle)?;
    let flap_chord = FLAP.chord_fraction * model.chord;
    let (cg, d) = (FLAP.cg_fraction * flap_chord, (0.75 - FLAP.chord_fraction) * model.chord);
    let about_hinge = cg * cg + flap_chord * flap_chord / 12.0;
    let expected = FLAP.mass_fraction * (15.0 * about_hinge - d * cg) * span(0) * amplitude;
    Ok(100.0 * (found.inertial.harmonic(4).cosine / expected - 1.0).abs())
}

/// Distance of the steady aerodynamic hinge moment from Theodorsen's, %.
pub(super) fn aerodynamic_error() -> Result<f64, CheckError> {
    let mean = 3.0_f64.to_radians();
    let angle = HarmonicSeries { mean, ..HarmonicSeries::zero(1) };
    let (model, found) = hinge_moment(FLAP, angle)?;
    let t = TheodorsenFunctions::new(FlapChord::new(FLAP.chord_fraction)?.hinge());
    let slope = -(t.t::<18>() + t.t::<12>() * t.t::<10>()) / TAU;
    let expected = 0.5 * model.density_chord() * model.chord * slope * mean * span(2);
    Ok(100.0 * (found.aerodynamic.mean / expected - 1.0).abs())
}
