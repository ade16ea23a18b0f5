//! Torque in hover with uniform inflow: inflow times thrust plus profile drag, whatever the blade does.
//!
//! Lift stands normal to the flow that the section sees, so that the work of the shaft goes into the air that
//! the thrust pushes down:
//!
//! ```text
//! C_Q = lambda C_T + sigma c_d (1 - x0^4) / 8
//! ```
//! It holds for a blade that cones, lags, or passes ahead of the shaft only if the velocity of a section and the
//! lever of its force are the same vector.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![expect(clippy::print_stdout, reason = "the measured torque is worth seeing")]

use crate::common;

use common::{paper_model, paper_spec};
use rotor_fem::{BladeProperties, BladeSpec, Joint, RootSupport, TorsionTerms};
use rotor_response::{
    Condition, Controls, Couplings, Discretisation, ResponseTolerances, ReverseFlow, Rotor,
    RotorModel, RotorSolver, SectionOffsets,
};
use rotor_wake::{FlightState, LinearInflow};
use std::sync::Arc;

const CLAMPED: RootSupport = RootSupport::CLAMPED;
const FLAPPING: RootSupport = RootSupport { flap: Joint::Free, ..CLAMPED };
const ARTICULATED: RootSupport = RootSupport { flap: Joint::Free, lag: Joint::Free, ..CLAMPED };

/// Collective and inflow of a blade loading of 0.07 and 0.10 of the blade without precone.
const LOADINGS: [(f64, f64); 2] = [(0.147, 0.055), (0.19, 0.065)];

#[derive(Debug, Clone, Copy)]
struct Hover {
    couplings: Couplings,
    root: RootSupport,
    precone_deg: f64,
    torque_offset: f64,
    drag: f64,
}

/// Thrust and torque over solidity; torque over inflow times thrust plus profile drag, less 1.
#[derive(Debug, Clone, Copy)]
struct Found {
    thrust: f64,
    torque: f64,
    excess: f64,
}

impl Hover {
    fn at(&self, (theta0_rad, lambda): (f64, f64)) -> Found {
        let model = RotorModel {
            offsets: SectionOffsets { torque: self.torque_offset, ..SectionOffsets::default() },
            // lift normal to the flow; `Gradual` leans it back by the cosine of the inflow angle, 0.3 % of the torque
            reverse_flow: ReverseFlow::Abrupt,
            drag_coefficient: self.drag,
            ..paper_model(self.couplings)
        };
        let root_offset = if self.root == CLAMPED { 0.0 } else { 0.04 };
        let precone_rad = self.precone_deg.to_radians();
        let spec = BladeSpec { root: self.root, root_offset, precone_rad, ..paper_spec() };
        let (unit, solidity) = (model.thrust_coefficient(1.0), model.solidity());
        let profile = solidity * model.drag_coefficient * (1.0 - model.root_cutout.powi(4)) / 8.0;
        let blade = BladeProperties::new(spec).unwrap();
        let rotor = Rotor::new(model, &blade, Discretisation::default()).unwrap();
        let mut solver =
            RotorSolver::new(Arc::new(rotor), 0.0, ResponseTolerances::default()).unwrap();
        let condition = Condition {
            bank_rad: 0.0,
            flight: FlightState { advance_ratio: 0.0, shaft_tilt_rad: 0.0 },
            controls: Controls { theta0_rad, ..Controls::default() },
            flap_angles_rad: vec![],
        };
        let inflow = LinearInflow::Prescribed { induced_inflow: lambda };
        let mean = solver.solve(&condition, &inflow, None).unwrap().hub.mean();
        let (thrust, torque) = (unit * mean[2], -unit * mean[5]);
        let excess = torque / (lambda * thrust + profile) - 1.0;
        let found = Found { thrust: thrust / solidity, torque: torque / solidity, excess };
        let Self { couplings, root, precone_deg, torque_offset, drag } = self;
        let free = [root.flap, root.lag].map(|joint| joint != Joint::Locked);
        println!(
            "{couplings:?}, flap and lag free {free:?}, precone {precone_deg} deg, offset {torque_offset}, c_d {drag}: \
             C_T/sigma {:.4}, C_Q/sigma {:.5}, off by {:.3} %",
            found.thrust,
            found.torque,
            100.0 * excess
        );
        found
    }
}

/// Largest error over every way the blade is held, coned and set off.
fn largest_excess(couplings: Couplings, torque_offsets: &[f64], drag: f64) -> f64 {
    let mut largest = 0.0_f64;
    let rest = Hover { couplings, root: CLAMPED, precone_deg: 0.0, torque_offset: 0.0, drag };
    for loading in LOADINGS {
        for root in [CLAMPED, FLAPPING, ARTICULATED] {
            for precone_deg in [-4.0, 0.0, 4.0] {
                let excess = Hover { root, precone_deg, ..rest }.at(loading).excess;
                largest = largest.max(excess.abs());
            }
        }
        for &torque_offset in torque_offsets {
            largest = largest.max(Hover { torque_offset, ..rest }.at(loading).excess.abs());
        }
    }
    println!("{couplings:?}: at most {:.3} %", 100.0 * largest);
    largest
}

fn moderate() -> Couplings {
    Couplings::Moderate(TorsionTerms::default())
}

#[test]
fn without_drag_the_torque_is_inflow_times_thrust() {
    let full = largest_excess(Couplings::Full, &[-0.05, 0.05], 0.0);
    let moderate = largest_excess(moderate(), &[], 0.0);
    assert!(full <= 1e-3 && moderate <= 3e-3, "{full:e} {moderate:e}");
}

/// Profile drag is that of the radius and the speed that the deflected blade has: a coned blade has less, one that
/// bends towards its torque offset more.
#[test]
fn profile_drag_adds_its_closed_form() {
    let full = largest_excess(Couplings::Full, &[], 0.01);
    let set_off = largest_excess(Couplings::Full, &[-0.05, 0.05], 0.01);
    let moderate = largest_excess(moderate(), &[], 0.01);
    let all = [full, set_off, moderate];
    assert!(full <= 4e-3 && set_off <= 1e-2 && moderate <= 4e-3, "{all:?}");
}

/// At a blade loading of 0.13 an articulated blade of `Moderate` lags by 0.2 rad and still has its periodic motion.
#[test]
fn a_blade_that_lags_far_has_its_orbit() {
    let rest = Hover {
        couplings: moderate(),
        root: ARTICULATED,
        precone_deg: 0.0,
        torque_offset: 0.0,
        drag: 0.01,
    };
    for precone_deg in [-4.0, 0.0, 4.0] {
        let found = Hover { precone_deg, ..rest }.at((0.24, 0.075));
        assert!(found.thrust > 0.12 && found.excess.abs() <= 1e-2, "{found:?}");
    }
}

/// The hub loads of `Linear` are the statics of the deflected blade, whose velocity its air does not have: as
/// good as the blade is straight.
#[test]
fn the_torque_of_linear_is_good_for_a_straight_blade() {
    let rest = Hover {
        couplings: Couplings::Linear,
        root: CLAMPED,
        precone_deg: 0.0,
        torque_offset: 0.0,
        drag: 0.0,
    };
    for loading in LOADINGS {
        for root in [CLAMPED, FLAPPING] {
            let excess = Hover { root, ..rest }.at(loading).excess;
            assert!(excess.abs() <= 1e-2, "{excess:e}");
        }
        // not of one that lags far
        assert!(Hover { root: ARTICULATED, ..rest }.at(loading).excess > 2e-2);
    }
}

/// Precone of a blade that is free to flap and lag changes its collective, not its torque at a thrust.
#[test]
fn precone_of_an_articulated_blade_is_none_of_its_torque() {
    for couplings in [Couplings::Full, moderate()] {
        let at_thrust = |precone_deg: f64| {
            let root = ARTICULATED;
            let hover = Hover { couplings, root, precone_deg, torque_offset: 0.0, drag: 0.01 };
            // linear in the collective to far below the bound
            let [low, high] = [0.185, 0.195].map(|theta0| hover.at((theta0, 0.065)));
            let share = (0.1 - low.thrust) / (high.thrust - low.thrust);
            low.torque + share * (high.torque - low.torque)
        };
        let [down, flat, up] = [-4.0, 0.0, 4.0].map(at_thrust);
        for coned in [down, up] {
            assert!((coned / flat - 1.0).abs() <= 3e-3, "{couplings:?}: {coned} {flat}");
        }
    }
}
