//! The periodic response of the rotor and its loads.

use std::f64::consts::TAU;
use std::sync::Arc;

use rotor_fem::{BladeProperties, BladeSpec, TorsionTerms, Twist, TwistAngle, Untwist};
use rotor_response::{
    Condition, Controls, Couplings, Discretisation, ResponseTolerances, ReverseFlow, Rotor,
    RotorModel, RotorSolution, RotorSolver, SixLoads, hub_loads,
};
use rotor_wake::{FlightState, InflowModel, LinearInflow};

use crate::hinge;
use validation::{Check, Failure, crosscheck, row, worst};

const CROSSCHECK: &str = "independent Fourier collocation model, crosscheck_S1_S2.json";

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-RESP-01",
        "case S1 (linear, quasi-steady, fixed controls): 4/rev hub loads, error of \
         their norm",
        "%",
    )
    .against(CROSSCHECK)
    .at_most(0.1, || four_per_rev_error(&S1)),
    row("V-RESP-02", "case S1: mean hub force, error of its norm", "%")
        .against(CROSSCHECK)
        .at_most(0.1, || mean_error(&S1, 0..3)),
    row("V-RESP-03", "case S1: mean hub moment, error of its norm", "%")
        .against(CROSSCHECK)
        .at_most(0.1, || mean_error(&S1, 3..6)),
    row("V-RESP-04", "case S2 (full couplings): 4/rev hub loads, error of their norm", "%")
        .against(CROSSCHECK)
        .at_most(5.0, || four_per_rev_error(&S2)),
    row("V-RESP-05", "case S2 solved without the couplings: what the bounds must see", "%")
        .against(CROSSCHECK)
        .at_least(50.0, || {
            four_per_rev_error(&Crosscheck { couplings: || Couplings::Linear, ..S2 })
        }),
    row(
        "V-RESP-06",
        "hub loads of identical blades off 0, 4, 8 per rev, summed blade by blade, \
         over the 4/rev level",
        "-",
    )
    .against("symmetry")
    .at_most(1e-10, || leak(1.0)),
    row("V-RESP-07", "the same with 1 % more mass on one blade: what the bound must see", "-")
        .against("symmetry, broken")
        .at_least(1e-2, || leak(1.01)),
    row("V-RESP-08", "hover thrust of a stiff blade, collective 6 and 10 deg: largest error", "%")
        .against("blade-element momentum theory, integral from the cut-out to the tip")
        .at_most(0.5, hover_thrust_error),
    row(
        "V-RESP-09",
        "root flap moment at 3/rev, force summation against EI w'' with 10 flap \
         modes, linear, no modal damping",
        "%",
    )
    .against("both integrate the same equation")
    .at_most(0.1, || Ok(100.0 * bending_gap(10)?)),
    row("V-RESP-10", "that gap with 10 over 4, and 16 over 10 flap modes: the larger ratio", "-")
        .against("monotone convergence")
        .at_most(0.99, bending_convergence),
    row("V-RESP-11", "periodicity residual of case S2", "m0 Omega^2 R^2")
        .against("the equation itself")
        .at_most(1e-8, || Ok(solve(&S2)?.residuals.periodicity)),
    row(
        "V-RESP-12",
        "inertial hinge moment of a flap driven at 4/rev on a stiff blade in hover",
        "%",
    )
    .against(
        "(16 I_h - I_h - m_f d X_f) delta over the span: moment of inertia and \
         centrifugal moment about the hinge",
    )
    .at_most(0.02, || hinge::inertial_error(0.2)),
    row(
        "V-RESP-13",
        "the same with the centre of gravity taken on the hinge: what the bound \
         must see",
        "%",
    )
    .against("the same closed form")
    .at_least(1.0, || hinge::inertial_error(0.0)),
    row("V-RESP-14", "aerodynamic hinge moment of a flap held at 3 deg, stiff blade in hover", "%")
        .against("-(T18 + T12 T10) / (2 pi), Theodorsen, over the span")
        .at_most(1e-5, hinge::aerodynamic_error),
    row(
        "V-RESP-15",
        "power of air, damping, shaft and pitch control over a revolution, moderate \
         deflections, mu 0.30: sum over the shaft's",
        "-",
    )
    .against("conservation of energy")
    .at_most(1e-5, || power_imbalance(8)),
    row("V-RESP-16", "that sum with eight time elements over that with four", "-")
        .against("the sum is a discretisation error")
        .at_most(0.5, || Ok(power_imbalance(8)? / power_imbalance(4)?)),
];

/// The reference knows neither tension on the built-in twist nor twist of bending in two planes.
const AS_IN_THE_REFERENCE: TorsionTerms =
    TorsionTerms { untwist: Untwist::Neglected, angle: TwistAngle::Elastic };

/// Moderate deflections against the second-order reference.
pub(crate) const MODERATE: &[Check] = &[
    row(
        "V-MOD-16",
        "case S2 with moderate deflections, torsion as in the reference, which has \
         neither N k_A^2 th_x nor w_x v_xx in torsion (V-MOD-19, 20 have them on): \
         4/rev hub loads, distance of their norm (third-order terms: 3.3 by the \
         reference's account)",
        "%",
    )
    .against(CROSSCHECK)
    .at_most(5.0, || s2_distance(|| Couplings::Moderate(AS_IN_THE_REFERENCE), 0..12)),
    row("V-MOD-17", "the same: vertical force (third-order terms: up to 13)", "%")
        .against(CROSSCHECK)
        .at_most(15.0, || s2_distance(|| Couplings::Moderate(AS_IN_THE_REFERENCE), 4..6)),
    row(
        "V-MOD-18",
        "the same with twist of bending in two planes (w_x v_xx), which the \
         reference leaves out: its size",
        "%",
    )
    .against(CROSSCHECK)
    .between(2.5, 4.0, || {
        let turning = || {
            Couplings::Moderate(TorsionTerms { angle: TwistAngle::Rotation, ..AS_IN_THE_REFERENCE })
        };
        s2_distance(turning, 0..12)
    }),
    row(
        "V-MOD-19",
        "the same with that and tension on the built-in twist (N k_A^2 th_x), which \
         the reference leaves out: its size",
        "%",
    )
    .against(CROSSCHECK)
    .between(9.0, 12.0, || s2_distance(|| Couplings::Moderate(TorsionTerms::default()), 0..12)),
    row(
        "V-MOD-20",
        "the same with both: vertical force, of which tension on the built-in \
         twist, untwisting the blade, is 13 to 26 by itself",
        "%",
    )
    .against(CROSSCHECK)
    .between(21.0, 28.0, || s2_distance(|| Couplings::Moderate(TorsionTerms::default()), 4..6)),
];

/// A case of the independent model.
struct Crosscheck {
    name: &'static str,
    couplings: fn() -> Couplings,
}

const S1: Crosscheck = Crosscheck { name: "S1_linear_fixed", couplings: || Couplings::Linear };
const S2: Crosscheck = Crosscheck { name: "S2_full_fixed", couplings: || Couplings::Full };

/// The blade of Table 1 with the twist of the paper's case; `mass` over m0.
pub(crate) fn paper_blade(mass: f64) -> Result<BladeProperties, Failure> {
    Ok(BladeProperties::new(BladeSpec { mass: mass.into(), ..BladeSpec::table_1() })?)
}

/// The rotor of Table 1, incompressible and quasi-steady, without flaps.
pub(crate) fn paper_rotor(couplings: Couplings, root_cutout: f64) -> RotorModel {
    RotorModel { root_cutout, ..RotorModel::table_1(couplings) }
}

/// Fixed controls of the crosscheck cases at advance ratio 0.30.
pub(crate) fn fixed_controls() -> Condition {
    Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio: 0.3, shaft_tilt_rad: 5.0_f64.to_radians() },
        controls: Controls {
            theta0_rad: 8.0_f64.to_radians(),
            theta1c_rad: 1.0_f64.to_radians(),
            theta1s_rad: (-4.0_f64).to_radians(),
        },
        flap_angles_rad: vec![],
    }
}

const PRESCRIBED: LinearInflow = LinearInflow::Prescribed { induced_inflow: 0.008 };

pub(crate) fn response(
    model: RotorModel,
    blade: &BladeProperties,
    discretisation: Discretisation,
    condition: &Condition,
    inflow: &dyn InflowModel,
) -> Result<RotorSolution, Failure> {
    let rotor = Arc::new(Rotor::new(model, blade, discretisation)?);
    let mu = condition.flight.advance_ratio;
    let mut solver = RotorSolver::new(rotor, mu, ResponseTolerances::default())?;
    Ok(solver.solve(condition, inflow, None)?)
}

fn solve(case: &Crosscheck) -> Result<RotorSolution, Failure> {
    let reverse_flow = ReverseFlow::Abrupt; // the small-angle form, as the crosscheck has it
    let model = RotorModel { reverse_flow, ..paper_rotor((case.couplings)(), 0.35) };
    let d = Discretisation::paper();
    response(model, &paper_blade(1.0)?, d, &fixed_controls(), &PRESCRIBED)
}

pub(crate) fn norm(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// `|got - expected| / |expected|` in percent.
fn percent_off(got: &[f64], expected: &[f64]) -> f64 {
    let difference = norm(got.iter().zip(expected).map(|(g, e)| g - e));
    100.0 * difference / norm(expected.iter().copied())
}

fn four_per_rev_error(case: &Crosscheck) -> Result<f64, Failure> {
    let expected: [f64; 12] = crosscheck(case.name, "hub_Z4")?;
    Ok(percent_off(&solve(case)?.hub.harmonic(4), &expected))
}

/// Distance of part of the 4/rev vector of case S2 with couplings of the caller's choice, %.
fn s2_distance(couplings: fn() -> Couplings, part: std::ops::Range<usize>) -> Result<f64, Failure> {
    let expected: [f64; 12] = crosscheck(S2.name, "hub_Z4")?;
    let found = solve(&Crosscheck { couplings, ..S2 })?.hub.harmonic(4);
    Ok(percent_off(&found[part.clone()], &expected[part]))
}

fn mean_error(case: &Crosscheck, part: std::ops::Range<usize>) -> Result<f64, Failure> {
    let expected: [f64; 6] = crosscheck(case.name, "hub_mean")?;
    Ok(percent_off(&solve(case)?.hub.mean()[part.clone()], &expected[part]))
}

fn largest(loads: impl IntoIterator<Item = f64>) -> f64 {
    loads.into_iter().fold(0.0, |largest: f64, load| largest.max(load.abs()))
}

/// Content of the hub loads off the multiples of four per rev over the 4/rev level, with the mass of
/// the last blade multiplied.
fn leak(last_mass: f64) -> Result<f64, Failure> {
    let root = |mass: f64| -> Result<SixLoads, Failure> {
        let model = paper_rotor(Couplings::Full, 0.2);
        let d = Discretisation::default();
        Ok(response(model, &paper_blade(mass)?, d, &fixed_controls(), &PRESCRIBED)?.root)
    };
    let blade = root(1.0)?;
    let hub = hub_loads(&[blade.clone(), blade.clone(), blade, root(last_mass)?], 12);
    let off = (1..=11).filter(|n| n % 4 != 0).flat_map(|n| hub.harmonic(n));
    Ok(largest(off) / largest(hub.harmonic(4)))
}

/// `C_T = (sigma a / 2) int_{x0}^1 (theta x^2 - lambda x) dx`, `lambda = sqrt(C_T / 2)`: a quadratic
/// equation for `sqrt(C_T)`.
fn hover_thrust(model: &RotorModel, theta0_rad: f64, twist_rad: f64) -> f64 {
    let moment = |n: i32| (1.0 - model.root_cutout.powi(n + 1)) / f64::from(n + 1);
    let pitch = (theta0_rad - 0.75 * twist_rad) * moment(2) + twist_rad * moment(3);
    let half = 0.5 * model.solidity() * TAU;
    let b = half * moment(1) / 2.0_f64.sqrt();
    let root = 0.5 * (-b + (b * b + 4.0 * half * pitch).sqrt());
    root * root
}

fn hover_thrust_error() -> Result<f64, Failure> {
    let twist_rad = (-8.0_f64).to_radians();
    let stiff = BladeProperties::new(BladeSpec {
        twist: Twist::Linear { rate_rad: twist_rad },
        ..BladeSpec::uniform(10.8, 26.8, 6.15, 1000.0)
    })?;
    let errors = [6.0_f64, 10.0].map(|theta0_deg| {
        let condition = Condition {
            bank_rad: 0.0,
            flight: FlightState { advance_ratio: 0.0, shaft_tilt_rad: 0.0 },
            controls: Controls { theta0_rad: theta0_deg.to_radians(), ..Controls::default() },
            flap_angles_rad: vec![],
        };
        let model = paper_rotor(Couplings::Full, 0.2);
        let expected = hover_thrust(&model, theta0_deg.to_radians(), twist_rad);
        let d = Discretisation::default();
        let got = response(model, &stiff, d, &condition, &LinearInflow::Uniform)?;
        Ok(100.0 * (got.thrust_coefficient / expected - 1.0).abs())
    });
    worst("collectives", 2, errors)
}

/// Gap between the root flap moments at 3/rev, over the moment. Without modal damping: its generalised
/// force has no distribution along the span, so that force summation cannot hold it.
fn bending_gap(flap_modes: usize) -> Result<f64, Failure> {
    let discretisation = Discretisation {
        blade_elements: 40,
        modes: [flap_modes, 2, 2],
        time_elements: 12,
        ..Discretisation::default()
    };
    let model = RotorModel { modal_damping: 0.0, ..paper_rotor(Couplings::Linear, 0.35) };
    let blade = paper_blade(1.0)?;
    let condition = fixed_controls();
    let rotor = Arc::new(Rotor::new(model, &blade, discretisation)?);
    let mut solver = RotorSolver::new(rotor, 0.3, ResponseTolerances::default())?;
    let solution = solver.solve(&condition, &PRESCRIBED, None)?;
    let loads = solver.station_loads(&condition, &solution, &[0.0])?;
    let [summed, curved] = [&loads[0].moments, &loads[0].curvature];
    let [summed, curved] = [summed, curved].map(|history| history.harmonics[0].harmonic(3));
    let gap = (summed.cosine - curved.cosine).hypot(summed.sine - curved.sine);
    Ok(gap / summed.amplitude())
}

/// What the powers of the moderately deflected blade leave, over that of the shaft.
fn power_imbalance(time_elements: usize) -> Result<f64, Failure> {
    let d = Discretisation { time_elements, ..Discretisation::default() };
    let model = paper_rotor(Couplings::Moderate(TorsionTerms::default()), 0.2);
    let found = response(model, &paper_blade(1.0)?, d, &fixed_controls(), &PRESCRIBED)?;
    Ok(found.power.imbalance().abs())
}

fn bending_convergence() -> Result<f64, Failure> {
    let (few, some, many) = (bending_gap(4)?, bending_gap(10)?, bending_gap(16)?);
    Ok((some / few).max(many / some))
}
