//! Where the wake leaves the blades of a response.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common;

use rotor_fem::Distribution;
use rotor_response::{
    Controls, Discretisation, Planform, ResponseTolerances, Rotor, RotorModel, RotorSolver,
};
use rotor_wake::{LinearInflow, WakeRotor};
use std::f64::consts::TAU;
use std::sync::Arc;

const AZIMUTHS: usize = 24;

/// The trailing edge lies three quarters of a chord behind the lifting line, turned with the section: built-in twist, pilot
/// controls and the elastic twist, which is some tenths of a degree here and vanishes at the root.
#[test]
fn the_wake_leaves_at_the_edge_of_the_pitched_section() {
    let (mut solver, condition) = (common::solver(), common::condition());
    let solution = solver.solve(&condition, &LinearInflow::Drees, None).unwrap();
    let (chord, properties) = (solver.rotor().model().chord, common::paper_blade());
    let panels = WakeRotor::cosine(4, 0.2, 10).unwrap();
    let below = |controls: &Controls| -> Vec<Vec<f64>> {
        let lines = solver.blade_lines(&solution.modal, controls, &panels, AZIMUTHS);
        let of = |i: usize| {
            let ends = lines.at(i).iter().zip(lines.edge_at(i));
            ends.map(|(line, edge)| {
                let [x, y, z] = [0, 1, 2].map(|c| edge[c] - line[c]);
                let distance = (x * x + y * y + z * z).sqrt();
                assert!((distance / (0.75 * chord) - 1.0).abs() < 1e-12, "{distance}");
                (-z / distance).asin()
            })
            .collect()
        };
        (0..AZIMUTHS).map(of).collect()
    };
    let controls = condition.controls;
    let mut largest_elastic = 0.0_f64;
    for (i, row) in below(&controls).iter().enumerate() {
        let (sin, cos) = (TAU * i as f64 / AZIMUTHS as f64).sin_cos();
        let root = controls.theta0_rad + controls.theta1c_rad * cos + controls.theta1s_rad * sin;
        for (&r, pitch) in panels.nodes().iter().zip(row) {
            let elastic = pitch - root - properties.twist_rad(r);
            // no twist at the clamp, most at the tip
            assert!(elastic.abs() < 0.03 * r, "{i} {r}: {elastic}");
            largest_elastic = largest_elastic.max(elastic.abs());
        }
    }
    assert!(largest_elastic > 1e-3, "{largest_elastic}");
    // other controls turn every section by the same angle
    let raised = Controls { theta0_rad: controls.theta0_rad + 0.02, ..controls };
    for (a, b) in below(&raised).iter().flatten().zip(below(&controls).iter().flatten()) {
        assert!((a - b - 0.02).abs() < 1e-12, "{a} {b}");
    }
}

/// The edge of a tapered blade is three quarters of its own chord away at every node.
#[test]
fn the_edge_of_a_tapered_blade_follows_its_chord() {
    let table = Distribution::PiecewiseLinear {
        stations: vec![0.0, 0.8, 1.0],
        values: vec![0.055, 0.055, 0.03],
    };
    let model = RotorModel {
        planform: Planform { chord: Some(table.clone()), set_back: None },
        ..RotorModel::paper_case()
    };
    let rotor = Rotor::new(model, &common::paper_blade(), Discretisation::default()).unwrap();
    let solver = RotorSolver::new(Arc::new(rotor), 0.3, ResponseTolerances::default());
    let (mut solver, condition) = (solver.unwrap(), common::condition());
    let solution = solver.solve(&condition, &LinearInflow::Drees, None).unwrap();
    let panels = WakeRotor::cosine(4, 0.2, 10).unwrap();
    let lines = solver.blade_lines(&solution.modal, &condition.controls, &panels, AZIMUTHS);
    for i in 0..AZIMUTHS {
        let ends = lines.at(i).iter().zip(lines.edge_at(i));
        for ((line, edge), &r) in ends.zip(panels.nodes()) {
            let distance = (0..3).map(|c| (edge[c] - line[c]).powi(2)).sum::<f64>().sqrt();
            assert!((distance / (0.75 * table.value(r)) - 1.0).abs() < 1e-12, "{r}: {distance}");
        }
    }
}
