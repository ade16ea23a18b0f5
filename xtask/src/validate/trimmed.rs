//! Trim.

use std::sync::Arc;

use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::TorsionTerms;
use rotor_response::{
    Condition, Couplings, Discretisation, FlapMass, PowerBalance, ResponseTolerances, Rotor,
    RotorModel, RotorSolver, TrailingEdgeFlap,
};
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
            id: "V-TRIM-06",
            quantity: "power of air, damping, shaft and pitch control on the trimmed orbit, mu 0.30, \
                       default discretisation, unsteady sections, couplings Full (in its own order: the \
                       foreshortening neither carries a section round nor lets a force work on it, the \
                       couple stands along the straight blade) and Moderate (all terms), torque as on the \
                       hub: larger sum over the shaft's",
            unit: "-",
            source: "conservation of energy",
            criterion: Criterion::AtMost(1e-5),
            repeatability: Repeatability::Everywhere,
            measure: trimmed_power,
        },
        Check {
            id: "V-TRIM-07",
            quantity: "that sum with 6 over 4 and with 8 over 6 time elements, quasi-steady sections: larger",
            unit: "-",
            source: "the sum is a discretisation error",
            criterion: Criterion::AtMost(0.5),
            repeatability: Repeatability::Everywhere,
            measure: trimmed_power_falls,
        },
        Check {
            id: "V-TRIM-08",
            quantity: "that sum with 12 over 8 time elements, unsteady sections, couplings Full and Moderate, \
                       orbit to 1e-13: larger",
            unit: "-",
            source: "the sum is a discretisation error",
            criterion: Criterion::AtMost(0.5),
            repeatability: Repeatability::Everywhere,
            measure: unsteady_power_falls,
        },
        Check {
            id: "V-TRIM-09",
            quantity: "that sum at the default without the smallest part (damping or pitch control): what \
                       the bound must see, smaller of both couplings",
            unit: "-",
            source: "conservation of energy",
            criterion: Criterion::AtLeast(2e-5),
            repeatability: Repeatability::Everywhere,
            measure: power_without_a_part,
        },
        Check {
            id: "V-TRIM-10",
            quantity: "the same with flaps that weigh beside the blade and move at 3/rev, controls of the \
                       trim held, Full and Moderate: larger sum over the shaft's",
            unit: "-",
            source: "conservation of energy",
            criterion: Criterion::AtMost(1e-5),
            repeatability: Repeatability::Everywhere,
            measure: power_beside_the_blade,
        },
        Check {
            id: "V-TRIM-05",
            quantity: "coupled trim of a rigid flapping blade, flight speed 0.10 to 0.35 of the tip speed: largest error of five \
                       angles over 2 % or 0.1 deg, whichever is larger",
            unit: "-",
            source: "independent program, trim_reference_simple.csv; its mu is the speed, not its part in the disk; pitch-rate lift taken out by two chords",
            criterion: Criterion::AtMost(trim_reference::BOUND),
            repeatability: Repeatability::Everywhere,
            measure: trim_reference::largest_error,
        },
    ],
};

const CT_SIGMA: f64 = 0.07;

fn trimmed(advance_ratio: f64, target: &TrimTarget) -> Result<TrimSolution, CheckError> {
    let model = paper_rotor(Couplings::Full, 0.2);
    trimmed_rotor(model, Discretisation::default(), advance_ratio, target)
}

fn trimmed_rotor(
    model: RotorModel,
    discretisation: Discretisation,
    advance_ratio: f64,
    target: &TrimTarget,
) -> Result<TrimSolution, CheckError> {
    let rotor = Rotor::new(model, &paper_blade(1.0)?, discretisation)?;
    let mut solver =
        RotorSolver::new(Arc::new(rotor), advance_ratio, ResponseTolerances::default())?;
    let settings = TrimSettings::default();
    let inflow = LinearInflow::Drees;
    Ok(trim(&mut solver, &inflow, advance_ratio, target, &settings, None)?)
}

fn propulsive_residual(residual: fn(&TrimSolution) -> f64) -> Result<f64, CheckError> {
    let residuals = [0.10, 0.20, 0.30].map(|mu| Ok(residual(&trimmed(mu, &LEVEL())?)));
    worst("advance ratios", 3, residuals)
}

const LEVEL: fn() -> TrimTarget =
    || TrimTarget::Propulsive { weight_ct_sigma: CT_SIGMA, vehicle: Vehicle::default() };

const COUPLINGS: fn() -> [Couplings; 2] =
    || [Couplings::Full, Couplings::Moderate(TorsionTerms::default())];

/// Power on the trimmed orbit of the paper's case.
fn power(
    couplings: Couplings,
    time_elements: usize,
    periodicity: f64,
) -> Result<PowerBalance, CheckError> {
    let model = RotorModel { couplings, ..RotorModel::paper_case() };
    let discretisation = Discretisation { time_elements, ..Discretisation::default() };
    let rotor = Rotor::new(model, &paper_blade(1.0)?, discretisation)?;
    let tolerances = ResponseTolerances { periodicity, ..ResponseTolerances::default() };
    let mut solver = RotorSolver::new(Arc::new(rotor), 0.3, tolerances)?;
    let (inflow, settings) = (LinearInflow::Drees, TrimSettings::default());
    Ok(trim(&mut solver, &inflow, 0.3, &LEVEL(), &settings, None)?.rotor.power)
}

fn trimmed_power() -> Result<f64, CheckError> {
    let default = ResponseTolerances::default().periodicity;
    let imbalances =
        COUPLINGS().map(|couplings| Ok(power(couplings, 8, default)?.imbalance().abs()));
    worst("couplings", 2, imbalances)
}

/// On the orbit that flaps beside the blade leave, the controls of the trim held.
fn power_beside_the_blade() -> Result<f64, CheckError> {
    let imbalances = COUPLINGS().map(|couplings| {
        let flaps = TrailingEdgeFlap::paper_case()
            .map(|flap| TrailingEdgeFlap { mass: FlapMass::AddedToBlade, ..flap });
        let model = RotorModel { couplings, flaps: flaps.to_vec(), ..RotorModel::paper_case() };
        let rotor = Rotor::new(model, &paper_blade(1.0)?, Discretisation::default())?;
        let tolerances = ResponseTolerances::default();
        let mut solver = RotorSolver::new(Arc::new(rotor), 0.3, tolerances)?;
        let (inflow, settings) = (LinearInflow::Drees, TrimSettings::default());
        let trimmed = trim(&mut solver, &inflow, 0.3, &LEVEL(), &settings, None)?;
        let mut angle = HarmonicSeries::zero(3);
        angle.set_harmonic(3, Harmonic { cosine: 0.03, sine: 0.02 });
        let condition = Condition {
            bank_rad: trimmed.attitude.roll_rad,
            flight: trimmed.flight,
            controls: trimmed.controls,
            flap_angles_rad: vec![angle.clone(), angle],
        };
        let moved = solver.solve(&condition, &inflow, Some(&trimmed.rotor))?;
        let of = |power: PowerBalance| power.imbalance().abs();
        Ok(of(trimmed.rotor.power).max(of(moved.power)))
    });
    worst("couplings", 2, imbalances)
}

fn unsteady_power_falls() -> Result<f64, CheckError> {
    let ratios = COUPLINGS().map(|couplings| {
        let [eight, twelve] = [8, 12].map(|elements| power(couplings, elements, 1e-13));
        Ok((twelve?.imbalance() / eight?.imbalance()).abs())
    });
    worst("couplings", 2, ratios)
}

fn power_without_a_part() -> Result<f64, CheckError> {
    let default = ResponseTolerances::default().periodicity;
    let mut least = f64::INFINITY;
    for couplings in COUPLINGS() {
        let all = power(couplings, 8, default)?;
        for less in [PowerBalance { damping: 0.0, ..all }, PowerBalance { pitch: 0.0, ..all }] {
            least = least.min(less.imbalance().abs());
        }
    }
    Ok(least)
}

fn trimmed_power_falls() -> Result<f64, CheckError> {
    let imbalance = |time_elements| {
        let discretisation = Discretisation { time_elements, ..Discretisation::default() };
        let model = paper_rotor(Couplings::Full, 0.2);
        let solution = trimmed_rotor(model, discretisation, 0.3, &LEVEL())?;
        Ok::<f64, CheckError>(solution.rotor.power.imbalance().abs())
    };
    let (few, some, many) = (imbalance(4)?, imbalance(6)?, imbalance(8)?);
    Ok((some / few).max(many / some))
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
