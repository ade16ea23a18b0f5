//! The response in detail: closed forms of stiff blades, loads in two ways, refinement, blades unlike the rest.

use std::f64::consts::{PI, TAU};
use std::sync::Arc;

use flap_aero::AttachedFlowModel;
use rotor_fem::{
    BladeProperties, BladeSpec, Joint, RootSupport, TorsionTerms, TwistAngle, Untwist,
};
use rotor_response::{
    Compressibility, Condition, Controls, Couplings, Discretisation, OtherBlade,
    ResponseTolerances, ReverseFlow, Rotor, RotorModel, RotorSolution, RotorSolver,
    dissimilar_hub_loads,
};
use rotor_wake::{FlightState, LinearInflow};

use crate::rotor::{fixed_controls, norm, paper_blade, paper_rotor, response};
use validation::{Check, Failure, crosscheck_rows, row, too_few, worst};

const CROSSCHECK: &str = "independent Fourier collocation model, crosscheck_S1_S2.json";
const FINER: &str = "8 stations per piece and 24 time elements";

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-RESP-30",
        "hover coning of a stiff blade on a flap hinge, collective 6 and 10 deg: \
         largest error",
        "%",
    )
    .against("beta = 3 K (theta M3 - lambda M2) / (1 - 3 K c/2 M2), blade-element theory")
    .at_most(0.5, coning_error),
    row(
        "V-RESP-31",
        "droop of a stiff blade on springs under gravity, shaft tilted: flap and \
         lag, largest error",
        "%",
    )
    .against("-1.5 g cos a / nu_b^2 and 1.5 g sin a / (nu_z^2 - 1)")
    .at_most(0.01, droop_error),
    row("V-RESP-32", "hover thrust with tip loss .97 and .90: largest error", "%")
        .against("(sigma a / 2) (theta (B^3 - x0^3) / 3 - lambda (B^2 - x0^2) / 2)")
        .at_most(0.05, tip_loss_error),
    row(
        "V-RESP-33",
        "1/rev in-plane hub force of a blade 2 % heavier, stiff, in vacuum: error",
        "%",
    )
    .against("Delta m Omega^2 R^2 / 2")
    .at_most(0.01, || heavy_blade(0.02).map(|found| 100.0 * (found / 0.01 - 1.0).abs())),
    row(
        "V-RESP-34",
        "hub loads summed over separately solved blades, all alike: distance from \
         those of one blade",
        "m0 Omega^2 R^2",
    )
    .against("identity")
    .at_most(1e-12, alike_error),
    row("V-RESP-38", "case S2: modal harmonics 0 to 5 of all ten modes, error of their norm", "%")
        .against(CROSSCHECK)
        .at_most(0.1, || modal_error(Couplings::Full)),
    row(
        "V-RESP-58",
        "case S2 with moderate deflections, torsion as in the reference: modal \
         harmonics 0 to 5 of all ten modes, distance of their norm from the \
         second-order reference",
        "%",
    )
    .against(CROSSCHECK)
    .at_most(1.0, || modal_error(Couplings::Moderate(AS_REFERENCE))),
    row(
        "V-RESP-39",
        "case S2 with moderate deflections, torsion as in the reference: mean tip \
         deflection, error",
        "%",
    )
    .against(CROSSCHECK)
    .at_most(1.0, tip_error),
    row(
        "V-RESP-40",
        "4/rev hub loads at the default mesh, unsteady sections, fixed controls, mu \
         0.30: largest of all six loads, off the fine mesh",
        "%",
    )
    .against(FINER)
    .at_most(1.0, || Ok(largest(refinement(UNSTEADY, 0.2, ReverseFlow::Gradual)?))),
    row(
        "V-RESP-41",
        "the same, 8 time elements off 24 with the same stations: what kinks of \
         fast lags leave inside an element",
        "%",
    )
    .against("24 time elements")
    .at_most(0.1, refinement_in_time),
    row(
        "V-RESP-44",
        "the same with circulation that jumps where the tangential speed turns \
         round (Abrupt): largest of all six loads",
        "%",
    )
    .against(FINER)
    .at_most(1.0, || Ok(largest(refinement(UNSTEADY, 0.2, ReverseFlow::Abrupt)?))),
    row("V-RESP-42", "the same with quasi-steady sections: largest of all six loads", "%")
        .against(FINER)
        .at_most(1.0, || {
            Ok(largest(refinement(AttachedFlowModel::QuasiSteady, 0.2, ReverseFlow::Gradual)?))
        }),
    row(
        "V-RESP-43",
        "the same with unsteady sections and the cut-out outside the reverse-flow \
         circle, .3: largest of all six loads",
        "%",
    )
    .against(FINER)
    .at_most(1.0, || Ok(largest(refinement(UNSTEADY, 0.3, ReverseFlow::Gradual)?))),
];

const PRESCRIBED: LinearInflow = LinearInflow::Prescribed { induced_inflow: 0.02 };

fn largest(values: impl IntoIterator<Item = f64>) -> f64 {
    values.into_iter().fold(0.0, f64::max)
}

fn stiff() -> BladeSpec {
    BladeSpec::uniform(1e5, 1e5, 1e5, 1e8)
}

fn hover(theta0_rad: f64) -> Condition {
    Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio: 0.0, shaft_tilt_rad: 0.0 },
        controls: Controls { theta0_rad, ..Controls::default() },
        flap_angles_rad: vec![],
    }
}

fn solve(
    model: RotorModel,
    spec: BladeSpec,
    condition: &Condition,
) -> Result<RotorSolution, Failure> {
    let d = Discretisation { modes: [1, 1, 1], ..Discretisation::default() };
    response(model, &BladeProperties::new(spec)?, d, condition, &PRESCRIBED)
}

/// `M_n = int_{x0}^{B} x^n dx`.
fn moment(n: i32, from: f64, to: f64) -> f64 {
    (to.powi(n + 1) - from.powi(n + 1)) / f64::from(n + 1)
}

fn coning_error() -> Result<f64, Failure> {
    let errors = [6.0_f64, 10.0].map(|theta0_deg| {
        let model = paper_rotor(Couplings::Linear, 0.2);
        let root = RootSupport { flap: Joint::Free, ..RootSupport::CLAMPED };
        let (theta, lambda) = (theta0_deg.to_radians(), 0.02);
        let k = 3.0 * PI * model.density_chord();
        let arm = |n| moment(n, model.root_cutout, 1.0);
        let pitching = 1.0 - k * 0.5 * model.chord * arm(2);
        let expected = k * (theta * arm(3) - lambda * arm(2)) / pitching;
        let found = solve(model, BladeSpec { root, ..stiff() }, &hover(theta))?;
        Ok(100.0 * (found.modal[0].mean / expected - 1.0).abs())
    });
    worst("collectives", 2, errors)
}

fn droop_error() -> Result<f64, Failure> {
    let (g, tilt, kb, kz) = (0.001_23, 0.2_f64, 0.08, 0.9);
    let spring = |stiffness| Joint::Spring { stiffness };
    let root = RootSupport { flap: spring(kb), lag: spring(kz), ..RootSupport::CLAMPED };
    let model = RotorModel {
        lock_number: 1e-9,
        modal_damping: 0.0,
        gravity: g,
        ..paper_rotor(Couplings::Linear, 0.2)
    };
    let flight = FlightState { advance_ratio: 0.0, shaft_tilt_rad: tilt };
    let found = solve(model, BladeSpec { root, ..stiff() }, &Condition { flight, ..hover(0.0) })?;
    let flap = -1.5 * g * tilt.cos() / (1.0 + 3.0 * kb);
    let lag = 1.5 * g * tilt.sin() / (3.0 * kz - 1.0);
    let errors = [found.modal[0].mean / flap, found.modal[1].harmonic(1).sine / lag];
    Ok(100.0 * largest(errors.map(|ratio| (ratio - 1.0).abs())))
}

fn tip_loss_error() -> Result<f64, Failure> {
    let (theta, lambda) = (0.15, 0.02);
    let errors = [0.97, 0.90].map(|tip_loss| {
        let model = RotorModel { tip_loss, ..paper_rotor(Couplings::Full, 0.2) };
        let arm = |n| moment(n, model.root_cutout, tip_loss);
        let expected = 0.5 * model.solidity() * TAU * (theta * arm(2) - lambda * arm(1));
        let found = solve(model, stiff(), &hover(theta))?;
        Ok(100.0 * (found.thrust_coefficient / expected - 1.0).abs())
    });
    worst("tip losses", 2, errors)
}

fn solver(
    model: RotorModel,
    blade: &BladeProperties,
    modes: [usize; 3],
    advance_ratio: f64,
) -> Result<RotorSolver, Failure> {
    let d = Discretisation { modes, ..Discretisation::default() };
    let rotor = Arc::new(Rotor::new(model, blade, d)?);
    Ok(RotorSolver::new(rotor, advance_ratio, ResponseTolerances::default())?)
}

/// Amplitude of the 1/rev force in the plane with one blade heavier by a share.
fn heavy_blade(more: f64) -> Result<f64, Failure> {
    let make = |mass: f64| {
        let model = RotorModel { lock_number: 1e-9, ..paper_rotor(Couplings::Full, 0.2) };
        let blade = BladeProperties::new(BladeSpec { mass: mass.into(), ..stiff() })?;
        solver(model, &blade, [1, 1, 1], 0.0)
    };
    let condition = hover(0.0);
    let mut alike = make(1.0)?;
    let about = alike.solve(&condition, &PRESCRIBED, None)?;
    let mut others =
        [OtherBlade { position: 2, solver: make(1.0 + more)?, condition: condition.clone() }];
    let hub = dissimilar_hub_loads(&mut alike, (&condition, &about), &mut others)?;
    Ok(hub.components[0].harmonic(1).amplitude())
}

fn alike_error() -> Result<f64, Failure> {
    let make = || solver(paper_rotor(Couplings::Full, 0.2), &paper_blade(1.0)?, [4, 4, 2], 0.3);
    let condition = fixed_controls();
    let mut alike = make()?;
    let about = alike.solve(&condition, &LinearInflow::Drees, None)?;
    let mut others = [OtherBlade { position: 1, solver: make()?, condition: condition.clone() }];
    let hub = dissimilar_hub_loads(&mut alike, (&condition, &about), &mut others)?;
    let apart = (1..=12)
        .flat_map(|n| hub.harmonic(n).into_iter().zip(about.hub.harmonic(n)))
        .chain(hub.mean().into_iter().zip(about.hub.mean()));
    Ok(largest(apart.map(|(a, b)| (a - b).abs())))
}

fn case_s2(couplings: Couplings) -> Result<RotorSolution, Failure> {
    let model = RotorModel { reverse_flow: ReverseFlow::Abrupt, ..paper_rotor(couplings, 0.35) };
    let inflow = LinearInflow::Prescribed { induced_inflow: 0.008 };
    let d = Discretisation::paper();
    response(model, &paper_blade(1.0)?, d, &fixed_controls(), &inflow)
}

fn modal_error(couplings: Couplings) -> Result<f64, Failure> {
    let found = case_s2(couplings)?;
    let expected = crosscheck_rows("S2_full_fixed", "modal_fourier_F1_4_L1_4_T1_2")?;
    let (mut apart, mut all) = (vec![], vec![]);
    for (series, row) in found.modal.iter().zip(&expected) {
        let got = std::iter::once(series.mean)
            .chain((1..=5).flat_map(|n| [series.harmonic(n).cosine, series.harmonic(n).sine]));
        for (got, expected) in got.zip(row) {
            apart.push(got - expected);
            all.push(*expected);
        }
    }
    let needed = 110;
    if all.len() < needed {
        return Err(too_few("modal harmonics", all.len(), needed));
    }
    Ok(100.0 * norm(apart) / norm(all))
}

/// Torsion without what the reference leaves out.
const AS_REFERENCE: TorsionTerms =
    TorsionTerms { untwist: Untwist::Neglected, angle: TwistAngle::Elastic };

fn tip_error() -> Result<f64, Failure> {
    let found = case_s2(Couplings::Moderate(AS_REFERENCE))?;
    let rows = crosscheck_rows("S2_full_fixed", "modal_fourier_F1_4_L1_4_T1_2")?;
    // tip value of each shape is 1
    let expected: f64 = rows.iter().take(4).filter_map(|row| row.first()).sum();
    let got: f64 = found.modal.iter().take(4).map(|series| series.mean).sum();
    Ok(100.0 * (got / expected - 1.0).abs())
}

/// Sections with lags as fast as pressure waves.
const UNSTEADY: AttachedFlowModel = AttachedFlowModel::HariharanLeishman;

/// The 4/rev loads at fixed controls.
fn four_per_rev(
    section_model: AttachedFlowModel,
    (root_cutout, reverse_flow): (f64, ReverseFlow),
    discretisation: Discretisation,
) -> Result<[f64; 12], Failure> {
    let model = RotorModel {
        section_model,
        compressibility: Compressibility::LocalMach { tip_mach: 0.582 },
        reverse_flow,
        ..paper_rotor(Couplings::Full, root_cutout)
    };
    let blade = paper_blade(1.0)?;
    let found = response(model, &blade, discretisation, &fixed_controls(), &LinearInflow::Drees)?;
    Ok(found.hub.harmonic(4))
}

/// Each 4/rev load of a mesh from that of another one, % of the load.
fn apart(base: &[f64; 12], refined: &[f64; 12]) -> impl Iterator<Item = f64> + use<> {
    percent_apart(base, refined).into_iter().take(6)
}

fn refinement(
    section_model: AttachedFlowModel,
    root_cutout: f64,
    reverse_flow: ReverseFlow,
) -> Result<impl Iterator<Item = f64>, Failure> {
    let at = |d| four_per_rev(section_model, (root_cutout, reverse_flow), d);
    let d = Discretisation::default();
    let fine = Discretisation { span_points_per_piece: 8, time_elements: 24, ..d };
    Ok(apart(&at(d)?, &at(fine)?))
}

fn refinement_in_time() -> Result<f64, Failure> {
    let at = |d| four_per_rev(UNSTEADY, (0.2, ReverseFlow::Gradual), d);
    let d = Discretisation::default();
    Ok(largest(apart(&at(d)?, &at(Discretisation { time_elements: 24, ..d })?)))
}

/// Distance of each load from a refined one over its amplitude there, and of all over their norm, %.
fn percent_apart(base: &[f64; 12], refined: &[f64; 12]) -> [f64; 7] {
    let apart: [f64; 12] = std::array::from_fn(|i| base[i] - refined[i]);
    let norm = |v: &[f64]| v.iter().map(|x| x * x).sum::<f64>().sqrt();
    std::array::from_fn(|k| {
        let part = if k < 6 { 2 * k..2 * k + 2 } else { 0..12 };
        100.0 * norm(&apart[part.clone()]) / norm(&refined[part])
    })
}
