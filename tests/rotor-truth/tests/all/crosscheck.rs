//! Cases S1 and S2 of the cross-check: fixed controls, fixed uniform inflow, quasi-steady airloads.

use rotor_truth::physics::balance::{Elastic, Resolution};
use rotor_truth::physics::blade::{Airloads, Blade, Couplings};
use rotor_truth::physics::hub::{harmonics, hub_loads};
use rotor_truth::physics::inflow::Shape;
use rotor_truth::physics::trim::{Held, Solver};

/// Hub loads, `cos sin` of each, of a harmonic.
fn hub(couplings: Couplings, resolution: Resolution, harmonic: usize) -> Vec<f64> {
    let blade =
        Blade { cutout: 0.35, couplings, airloads: Airloads::QuasiSteady, ..Blade::default() };
    let elastic = Elastic::new(blade, resolution).unwrap();
    let flow = elastic.flow(0.3, 5.0_f64.to_radians(), Shape::Uniform, Vec::new()).unwrap();
    let controls = [8.0_f64, 1.0, -4.0].map(f64::to_radians);
    let held = Held::All { controls, lambda_i: 0.008 };
    let rest = elastic.flaps_at_rest();
    let found = Solver::new(&elastic).solve(held, (&flow, &rest), None).unwrap();
    let loads = hub_loads(&elastic.fourier, &[found.root.as_slice(); 4]);
    (0..6)
        .flat_map(|k| {
            let own = harmonics(&loads, k, 8)[harmonic];
            [own.cosine, own.sine]
        })
        .collect()
}

fn error(found: &[f64], exact: &[f64]) -> f64 {
    let norm = |own: &mut dyn Iterator<Item = f64>| own.map(|x| x * x).sum::<f64>().sqrt();
    let difference = norm(&mut found.iter().zip(exact).map(|(a, b)| a - b));
    difference / norm(&mut exact.iter().copied())
}

fn fixture(case: &str, what: &str) -> Vec<f64> {
    let all: serde_json::Value =
        serde_json::from_str(include_str!("../../fixtures/crosscheck.json")).unwrap();
    serde_json::from_value(all[case][what].clone()).unwrap()
}

#[test]
fn reference_cases_are_reproduced() {
    let fine = Resolution { harmonics: 14, azimuths: 96, points: 8, segment: 0.2 };
    for (name, couplings) in [("S1", Couplings::Linear), ("S2", Couplings::Full)] {
        let z4 = error(&hub(couplings, fine, 4), &fixture(name, "hub_Z4"));
        println!("{name}: {z4:.3e} of |Z4|");
        assert!(z4 < 1e-6, "{name}: {z4:e}");
    }
}

#[test]
fn more_of_everything_changes_little() {
    let exact = fixture("S2", "hub_Z4");
    for (harmonics, azimuths, points) in
        [(6, 32, 5), (8, 32, 5), (8, 40, 5), (10, 48, 4), (10, 48, 5), (12, 64, 6)]
    {
        let resolution = Resolution { harmonics, azimuths, points, segment: 0.2 };
        let found = hub(Couplings::Full, resolution, 4);
        println!("S2 {harmonics} {azimuths} {points}: {:.2e}", error(&found, &exact));
    }
}
