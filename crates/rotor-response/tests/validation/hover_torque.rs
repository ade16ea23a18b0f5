//! Torque of the shaft: inflow times thrust and profile drag in hover, and the reaction of a free hinge in flight.

use std::sync::Arc;

use rotor_base::HarmonicSeries;
use rotor_fem::{BladeProperties, BladeSpec, Joint, ModalBasis, RootSupport, TorsionTerms};
use rotor_response::{
    Condition, Controls, Couplings, Discretisation, ResponseTolerances, ReverseFlow, Rotor,
    RotorModel, RotorSolver, SectionOffsets,
};
use rotor_wake::{FlightState, LinearInflow};

use crate::rotor::{fixed_controls, paper_rotor, response};
use validation::{Check, Failure, row, worst};

const WORK: &str =
    "C_Q = lambda C_T + sigma c_d (1 - x0^4) / 8: the work of the shaft goes into the air";

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-RESP-65",
        "torque in hover without drag, Full, C_T/sigma .07 and .10; blade clamped, \
         flapping, flapping and lagging at .04 R, precone -4, 0, 4 deg; clamped \
         with a torque offset of -.05 and .05 R: largest error",
        "%",
    )
    .against(WORK)
    .at_most(0.1, || hover_error(Couplings::Full, 0.0, &[-0.05, 0.05])),
    row("V-RESP-66", "the same with Moderate, which knows no torque offset", "%")
        .against(WORK)
        .at_most(0.3, || hover_error(MODERATE, 0.0, &[])),
    row(
        "V-RESP-67",
        "the same with a profile drag of .01 and no torque offset, Full and \
         Moderate: that of the deflected blade is not that of the straight one",
        "%",
    )
    .against(WORK)
    .at_most(0.4, || {
        let both = [Couplings::Full, MODERATE].map(|c| hover_error(c, 0.01, &[]));
        worst("couplings", 2, both)
    }),
    row(
        "V-RESP-68",
        "the torque of Linear for a blade that flaps and lags, without drag: the \
         second-order terms its equations lack, which a run warns of",
        "%",
    )
    .against(WORK)
    .at_least(2.0, || hover_error(Couplings::Linear, 0.0, &[])),
    row(
        "V-RESP-69",
        "torque at mu .3 of a blade on free flap and lag hinges, 9 completed modes, \
         no damping, Full, off hinge offset times the force in the plane on the \
         hinge: largest of mean and harmonics to 12 over the largest",
        "relative",
    )
    .against("a free hinge carries no moment")
    .at_most(1e-9, || hinge_torque_gap(Couplings::Full)),
    row("V-RESP-70", "the same of Moderate, whose torque is the reaction at the azimuth", "%")
        .against("third order in the deflection")
        .at_most(3.0, || Ok(100.0 * hinge_torque_gap(MODERATE)?)),
];

const MODERATE: Couplings = Couplings::Moderate(TorsionTerms {
    untwist: rotor_fem::Untwist::Included,
    angle: rotor_fem::TwistAngle::Rotation,
});

const CLAMPED: RootSupport = RootSupport::CLAMPED;
const FLAPPING: RootSupport = RootSupport { flap: Joint::Free, ..CLAMPED };
const ARTICULATED: RootSupport = RootSupport { lag: Joint::Free, ..FLAPPING };

/// Station of the hinges, R.
const HINGE: f64 = 0.04;

/// Collective and inflow of a blade loading of 0.07 and 0.10.
const LOADINGS: [(f64, f64); 2] = [(0.147, 0.055), (0.19, 0.065)];

fn held(root: RootSupport, precone_deg: f64) -> BladeSpec {
    let root_offset = if root == CLAMPED { 0.0 } else { HINGE };
    let precone_rad = precone_deg.to_radians();
    BladeSpec { root, root_offset, precone_rad, ..BladeSpec::table_1() }
}

/// Torque off the work on the air, %, at a collective and an inflow.
fn excess(
    model: RotorModel,
    spec: BladeSpec,
    (theta0_rad, lambda): (f64, f64),
) -> Result<f64, Failure> {
    let unit = model.thrust_coefficient(1.0);
    let ring = 1.0 - model.root_cutout.powi(4);
    let profile = model.solidity() * model.drag_coefficient * ring / 8.0;
    let condition = Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio: 0.0, shaft_tilt_rad: 0.0 },
        controls: Controls { theta0_rad, ..Controls::default() },
        flap_angles_rad: vec![],
    };
    let inflow = LinearInflow::Prescribed { induced_inflow: lambda };
    let (blade, d) = (BladeProperties::new(spec)?, Discretisation::default());
    let mean = response(model, &blade, d, &condition, &inflow)?.hub.mean();
    let expected = lambda * unit * mean[2] + profile;
    Ok(100.0 * (-unit * mean[5] / expected - 1.0).abs())
}

/// Largest excess over every way the blade is held, coned and set off.
fn hover_error(
    couplings: Couplings,
    drag_coefficient: f64,
    torque_offsets: &[f64],
) -> Result<f64, Failure> {
    // lift normal to the flow: `Gradual` leans it back by the cosine of the inflow angle
    let reverse_flow = ReverseFlow::Abrupt;
    let model = RotorModel { reverse_flow, drag_coefficient, ..paper_rotor(couplings, 0.2) };
    let mut errors = Vec::new();
    for at in LOADINGS {
        for root in [CLAMPED, FLAPPING, ARTICULATED] {
            for precone_deg in [-4.0, 0.0, 4.0] {
                errors.push(excess(model.clone(), held(root, precone_deg), at));
            }
        }
        for &torque in torque_offsets {
            let offsets = SectionOffsets { torque, ..SectionOffsets::default() };
            errors.push(excess(RotorModel { offsets, ..model.clone() }, held(CLAMPED, 0.0), at));
        }
    }
    worst("ways to hold the blade", errors.len(), errors)
}

/// Largest part of the torque that is not the lever of the hinge times the force in the plane.
fn hinge_torque_gap(couplings: Couplings) -> Result<f64, Failure> {
    let blade = BladeProperties::new(held(ARTICULATED, 0.0))?;
    // completed shapes hold the turn about a hinge exactly, natural modes nearly
    let completed =
        Discretisation { basis: ModalBasis::Completed, modes: [9; 3], ..Discretisation::default() };
    // damping of modes that are not the turn about a hinge would brake it
    let model = RotorModel { modal_damping: 0.0, ..paper_rotor(couplings, 0.2) };
    let rotor = Rotor::new(model, &blade, completed)?;
    let mut solver = RotorSolver::new(Arc::new(rotor), 0.3, ResponseTolerances::default())?;
    let inflow = LinearInflow::Prescribed { induced_inflow: 0.008 };
    let found = solver.solve(&fixed_controls(), &inflow, None)?;
    let parts = |series: &HarmonicSeries| -> Vec<f64> {
        let all = (1..=12).map(|n| series.harmonic(n)).flat_map(|h| [h.cosine, h.sine]);
        std::iter::once(series.mean).chain(all).collect()
    };
    let [force, torque] = [1, 5].map(|k| parts(&found.root.components[k]));
    let apart = torque.iter().zip(&force).map(|(q, f)| (q - HINGE * f).abs());
    let largest = torque.iter().fold(0.0_f64, |most, q| most.max(q.abs()));
    Ok(apart.fold(0.0, f64::max) / largest)
}
