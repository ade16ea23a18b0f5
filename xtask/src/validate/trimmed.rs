//! Trim.

use std::sync::Arc;

use rotor_response::{Couplings, Discretisation, ResponseTolerances, Rotor, RotorSolver};
use rotor_wake::LinearInflow;
use trim::{TrimSettings, TrimSolution, TrimTarget, Vehicle, trim};

use super::CheckError;
use super::check::{Area, Check, Criterion, Repeatability};
use super::reference::worst;
use super::rotor::{paper_blade, paper_rotor};
use super::trim_reference;

pub(super) const AREA: Area = Area {
    heading: "Trim (`trim`)",
    checks: &[
        Check {
            id: "V-TRIM-01",
            quantity: "propulsive trim, mu 0.10, 0.20, 0.30, Drees: largest trim residual",
            unit: "weight",
            source: "the six equations themselves",
            criterion: Criterion::AtMost(1e-8),
            repeatability: Repeatability::Everywhere,
            measure: || propulsive_residual(|solution| solution.residual),
        },
        Check {
            id: "V-TRIM-02",
            quantity: "the same: largest periodicity residual",
            unit: "m0 Omega^2 R^2",
            source: "the equation itself",
            criterion: Criterion::AtMost(1e-8),
            repeatability: Repeatability::Everywhere,
            measure: || propulsive_residual(|solution| solution.rotor.residuals.periodicity),
        },
        Check {
            id: "V-TRIM-03",
            quantity: "wind-tunnel trim, mu 0.25: thrust off its target",
            unit: "-",
            source: "C_T/sigma .07 = .07 N_b gamma / (3 a) in m0 Omega^2 R^2, by hand",
            criterion: Criterion::AtMost(1e-8),
            repeatability: Repeatability::Everywhere,
            measure: wind_tunnel_thrust,
        },
        Check {
            id: "V-TRIM-04",
            quantity: "the same: mean hub roll and pitch moment left over",
            unit: "m0 Omega^2 R^3",
            source: "the trim target",
            criterion: Criterion::AtMost(1e-9),
            repeatability: Repeatability::Everywhere,
            measure: wind_tunnel_moment,
        },
        Check {
            id: "V-TRIM-05",
            quantity: "coupled trim of a rigid flapping blade, mu 0.10 to 0.35: largest error of five \
                       angles over 2 % or 0.1 deg, whichever is larger",
            unit: "-",
            source: "independent program, trim_reference_simple.csv; pitch-rate lift taken out by two chords",
            criterion: Criterion::AtMost(1.0),
            repeatability: Repeatability::Everywhere,
            measure: trim_reference::largest_error,
        },
    ],
};

const CT_SIGMA: f64 = 0.07;

fn trimmed(advance_ratio: f64, target: &TrimTarget) -> Result<TrimSolution, CheckError> {
    let model = paper_rotor(Couplings::Full, 0.2);
    let rotor = Rotor::new(model, &paper_blade(1.0)?, Discretisation::default())?;
    let mut solver =
        RotorSolver::new(Arc::new(rotor), advance_ratio, ResponseTolerances::default())?;
    let settings = TrimSettings::default();
    let inflow = LinearInflow::Drees;
    Ok(trim(&mut solver, &inflow, advance_ratio, target, &settings, None)?)
}

fn propulsive_residual(residual: fn(&TrimSolution) -> f64) -> Result<f64, CheckError> {
    let target = TrimTarget::Propulsive { weight_ct_sigma: CT_SIGMA, vehicle: Vehicle::default() };
    let residuals = [0.10, 0.20, 0.30].map(|mu| Ok(residual(&trimmed(mu, &target)?)));
    worst("advance ratios", 3, residuals)
}

fn wind_tunnel() -> Result<TrimSolution, CheckError> {
    trimmed(0.25, &TrimTarget::WindTunnel { ct_sigma: CT_SIGMA, shaft_tilt_rad: 0.08 })
}

fn wind_tunnel_thrust() -> Result<f64, CheckError> {
    let expected = CT_SIGMA * 4.0 * 5.2 / (3.0 * std::f64::consts::TAU);
    Ok((wind_tunnel()?.rotor.hub.mean()[2] / expected - 1.0).abs())
}

fn wind_tunnel_moment() -> Result<f64, CheckError> {
    let mean = wind_tunnel()?.rotor.hub.mean();
    Ok(mean[3].hypot(mean[4]))
}
