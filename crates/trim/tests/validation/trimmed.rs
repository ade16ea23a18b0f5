//! Trim.

use std::sync::Arc;

use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec, TorsionTerms};
use rotor_response::{
    Condition, Couplings, Discretisation, FlapMass, PowerBalance, ResponseTolerances, Rotor,
    RotorModel, RotorSolution, RotorSolver, TrailingEdgeFlap,
};
use rotor_wake::LinearInflow;
use trim::{TrimSettings, TrimSolution, TrimTarget, Vehicle, trim};

use crate::trim_reference;
use validation::{Check, Failure, row, worst};

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-TRIM-01",
        "propulsive trim, mu 0.10, 0.20, 0.30, Drees: largest trim residual",
        "weight",
    )
    .against("the six equations themselves")
    .at_most(1e-8, || propulsive_residual(|solution| solution.residual)),
    row("V-TRIM-02", "the same: largest periodicity residual", "m0 Omega^2 R^2")
        .against("the equation itself")
        .at_most(1e-8, || propulsive_residual(|solution| solution.rotor.residuals.periodicity)),
    row("V-TRIM-03", "wind-tunnel trim, mu 0.25: thrust off its target", "-")
        .against("C_T/sigma .07 = .07 N_b gamma / (3 a) in m0 Omega^2 R^2, by hand")
        .at_most(1e-8, wind_tunnel_thrust),
    row("V-TRIM-04", "the same: mean hub roll and pitch moment left over", "m0 Omega^2 R^3")
        .against("the trim target")
        .at_most(1e-9, wind_tunnel_moment),
    row(
        "V-TRIM-06",
        "power of air, damping, shaft and pitch control on the trimmed orbit, mu \
         0.30, default discretisation, unsteady sections, couplings Full (in its \
         own order: the foreshortening neither carries a section round nor lets a \
         force work on it, the couple stands along the straight blade) and Moderate \
         (all terms), torque as on the hub: larger sum over the shaft's",
        "-",
    )
    .against("conservation of energy")
    .at_most(1e-5, trimmed_power),
    row(
        "V-TRIM-07",
        "that sum with 6 over 4 and with 8 over 6 time elements, quasi-steady \
         sections: larger",
        "-",
    )
    .against("the sum is a discretisation error")
    .at_most(0.5, trimmed_power_falls),
    row(
        "V-TRIM-08",
        "that sum with 12 over 8 time elements, unsteady sections, couplings Full \
         and Moderate, orbit to 1e-13: larger",
        "-",
    )
    .against("the sum is a discretisation error")
    .at_most(0.5, unsteady_power_falls),
    row(
        "V-TRIM-09",
        "that sum at the default without the smallest part (damping or pitch \
         control): what the bound must see, smaller of both couplings",
        "-",
    )
    .against("conservation of energy")
    .at_least(2e-5, power_without_a_part),
    row(
        "V-TRIM-10",
        "the same with flaps that weigh beside the blade and move at 3/rev, \
         controls of the trim held, Full and Moderate: larger sum over the shaft's",
        "-",
    )
    .against("conservation of energy")
    .at_most(1e-5, power_beside_the_blade),
    row(
        "V-TRIM-11",
        "4/rev hub loads in trim, mu 0.15 and 0.30, Drees, and with flaps at 3/rev, at the \
         default tolerances: distance from those with residuals a hundred times smaller, \
         largest, of the vector",
        "-",
    )
    .against("the same equations")
    .at_most(1e-8, left_by_tolerances),
    row(
        "V-TRIM-05",
        "coupled trim of a rigid flapping blade, flight speed 0.10 to 0.35 of the \
         tip speed: largest error of five angles over 2 % or 0.1 deg, whichever is \
         larger",
        "-",
    )
    .against(
        "independent program, trim_reference_simple.csv; its mu is the speed, not \
         its part in the disk; pitch-rate lift taken out by two chords",
    )
    .at_most(trim_reference::BOUND, trim_reference::largest_error),
];

const CT_SIGMA: f64 = 0.07;

fn trimmed(advance_ratio: f64, target: &TrimTarget) -> Result<TrimSolution, Failure> {
    let model = RotorModel::table_1(Couplings::Full);
    trimmed_rotor(model, Discretisation::default(), advance_ratio, target)
}

fn trimmed_rotor(
    model: RotorModel,
    discretisation: Discretisation,
    advance_ratio: f64,
    target: &TrimTarget,
) -> Result<TrimSolution, Failure> {
    let rotor = Rotor::new(model, &BladeProperties::new(BladeSpec::table_1())?, discretisation)?;
    let mut solver =
        RotorSolver::new(Arc::new(rotor), advance_ratio, ResponseTolerances::default())?;
    let settings = TrimSettings::default();
    let inflow = LinearInflow::Drees;
    Ok(trim(&mut solver, &inflow, advance_ratio, target, &settings, None)?)
}

fn propulsive_residual(residual: fn(&TrimSolution) -> f64) -> Result<f64, Failure> {
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
) -> Result<PowerBalance, Failure> {
    let model = RotorModel { couplings, ..RotorModel::paper_case() };
    let discretisation = Discretisation { time_elements, ..Discretisation::default() };
    let rotor = Rotor::new(model, &BladeProperties::new(BladeSpec::table_1())?, discretisation)?;
    let tolerances = ResponseTolerances { periodicity, ..ResponseTolerances::default() };
    let mut solver = RotorSolver::new(Arc::new(rotor), 0.3, tolerances)?;
    let (inflow, settings) = (LinearInflow::Drees, TrimSettings::default());
    Ok(trim(&mut solver, &inflow, 0.3, &LEVEL(), &settings, None)?.rotor.power)
}

fn trimmed_power() -> Result<f64, Failure> {
    let default = ResponseTolerances::default().periodicity;
    let imbalances =
        COUPLINGS().map(|couplings| Ok(power(couplings, 8, default)?.imbalance().abs()));
    worst("couplings", 2, imbalances)
}

/// The response to both flaps at 3/rev, Drees's inflow, the controls of the trim held.
fn with_moving_flaps(
    solver: &mut RotorSolver,
    trimmed: &TrimSolution,
) -> Result<RotorSolution, Failure> {
    let mut angle = HarmonicSeries::zero(3);
    angle.set_harmonic(3, Harmonic { cosine: 0.03, sine: 0.02 });
    let condition = Condition {
        bank_rad: trimmed.attitude.roll_rad,
        flight: trimmed.flight,
        controls: trimmed.controls,
        flap_angles_rad: vec![angle.clone(), angle],
    };
    Ok(solver.solve(&condition, &LinearInflow::Drees, Some(&trimmed.rotor))?)
}

/// On the orbit that flaps beside the blade leave, the controls of the trim held.
fn power_beside_the_blade() -> Result<f64, Failure> {
    let imbalances = COUPLINGS().map(|couplings| {
        let flaps = TrailingEdgeFlap::paper_case()
            .map(|flap| TrailingEdgeFlap { mass: FlapMass::AddedToBlade, ..flap });
        let model = RotorModel { couplings, flaps: flaps.to_vec(), ..RotorModel::paper_case() };
        let rotor = Rotor::new(
            model,
            &BladeProperties::new(BladeSpec::table_1())?,
            Discretisation::default(),
        )?;
        let tolerances = ResponseTolerances::default();
        let mut solver = RotorSolver::new(Arc::new(rotor), 0.3, tolerances)?;
        let (inflow, settings) = (LinearInflow::Drees, TrimSettings::default());
        let trimmed = trim(&mut solver, &inflow, 0.3, &LEVEL(), &settings, None)?;
        let moved = with_moving_flaps(&mut solver, &trimmed)?;
        let of = |power: PowerBalance| power.imbalance().abs();
        Ok(of(trimmed.rotor.power).max(of(moved.power)))
    });
    worst("couplings", 2, imbalances)
}

fn left_by_tolerances() -> Result<f64, Failure> {
    let exact = ResponseTolerances { periodicity: 1e-13, inflow: 1e-13, ..Default::default() };
    let exact = (exact, TrimSettings { tolerance: 1e-11, ..TrimSettings::default() });
    let usual = (ResponseTolerances::default(), TrimSettings::default());
    let blade = BladeProperties::new(BladeSpec::table_1())?;
    let rotor = Rotor::new(RotorModel::paper_case(), &blade, Discretisation::default())?;
    let rotor = Arc::new(rotor);
    let distances = [0.15, 0.30].map(|mu| {
        let loads = |(tolerances, settings): (ResponseTolerances, TrimSettings)| {
            let mut solver = RotorSolver::new(Arc::clone(&rotor), mu, tolerances)?;
            let inflow = LinearInflow::Drees;
            let trimmed = trim(&mut solver, &inflow, mu, &LEVEL(), &settings, None)?;
            let moved = with_moving_flaps(&mut solver, &trimmed)?;
            let fourth = |of: RotorSolution| of.hub.components.map(|own| own.harmonic(4));
            Ok::<_, Failure>([trimmed.rotor, moved].map(fourth))
        };
        let [fast, slow] = [loads(usual)?, loads(exact)?];
        let norm = |of: &[Harmonic]| {
            of.iter().map(|h| h.cosine.powi(2) + h.sine.powi(2)).sum::<f64>().sqrt()
        };
        let apart = fast.iter().zip(&slow).map(|(fast, slow)| {
            let apart = fast
                .iter()
                .zip(slow)
                .map(|(a, b)| Harmonic { cosine: a.cosine - b.cosine, sine: a.sine - b.sine });
            norm(&apart.collect::<Vec<_>>()) / norm(slow)
        });
        Ok(apart.fold(0.0, f64::max))
    });
    worst("advance ratios", 2, distances)
}

fn unsteady_power_falls() -> Result<f64, Failure> {
    let ratios = COUPLINGS().map(|couplings| {
        let [eight, twelve] = [8, 12].map(|elements| power(couplings, elements, 1e-13));
        Ok((twelve?.imbalance() / eight?.imbalance()).abs())
    });
    worst("couplings", 2, ratios)
}

fn power_without_a_part() -> Result<f64, Failure> {
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

fn trimmed_power_falls() -> Result<f64, Failure> {
    let imbalance = |time_elements| {
        let discretisation = Discretisation { time_elements, ..Discretisation::default() };
        let model = RotorModel::table_1(Couplings::Full);
        let solution = trimmed_rotor(model, discretisation, 0.3, &LEVEL())?;
        Ok::<f64, Failure>(solution.rotor.power.imbalance().abs())
    };
    let (few, some, many) = (imbalance(4)?, imbalance(6)?, imbalance(8)?);
    Ok((some / few).max(many / some))
}

fn wind_tunnel() -> Result<TrimSolution, Failure> {
    trimmed(
        0.25,
        &TrimTarget::WindTunnel { ct_sigma: CT_SIGMA, shaft_tilt_rad: 0.08, hub_moments: [0.0; 2] },
    )
}

fn wind_tunnel_thrust() -> Result<f64, Failure> {
    let expected = CT_SIGMA * 4.0 * 5.2 / (3.0 * std::f64::consts::TAU);
    Ok((wind_tunnel()?.rotor.hub.mean()[2] / expected - 1.0).abs())
}

fn wind_tunnel_moment() -> Result<f64, Failure> {
    let mean = wind_tunnel()?.rotor.hub.mean();
    Ok(mean[3].hypot(mean[4]))
}
