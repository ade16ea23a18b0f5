//! Cases S1 and S2 of the cross-check: fixed controls, fixed uniform inflow, quasi-steady airloads.

use rotor_truth::physics::balance::{Elastic, Resolution};
use rotor_truth::physics::blade::{Airloads, Blade, Couplings};
use rotor_truth::physics::hub::{harmonics, hub_loads};
use rotor_truth::physics::inflow::Shape;
use rotor_truth::physics::trim::{Held, Solver};

/// What a case gives: mean hub loads, 4/rev and 8/rev as `cos sin` of each load, modal series to 5/rev.
struct Answer {
    mean: Vec<f64>,
    fourth: Vec<f64>,
    eighth: Vec<f64>,
    modal: Vec<f64>,
}

fn solved(couplings: Couplings, resolution: Resolution) -> Answer {
    let blade =
        Blade { cutout: 0.35, couplings, airloads: Airloads::QuasiSteady, ..Blade::default() };
    let elastic = Elastic::new(blade, resolution).unwrap();
    let flow = elastic.flow(0.3, 5.0_f64.to_radians(), Shape::Uniform, Vec::new()).unwrap();
    let controls = [8.0_f64, 1.0, -4.0].map(f64::to_radians);
    let held = Held::All { controls, lambda_i: 0.008 };
    let rest = elastic.flaps_at_rest();
    let found = Solver::new(&elastic).solve(held, (&flow, &rest), None).unwrap();
    let loads = hub_loads(&elastic.fourier, &[found.root.as_slice(); 4]);
    let all: Vec<_> = (0..6).map(|k| harmonics(&loads, k, 8)).collect();
    let of = |n: usize| all.iter().flat_map(|own| [own[n].cosine, own[n].sine]).collect();
    let modal = found.series().chunks_exact(elastic.fourier.size());
    Answer {
        mean: all.iter().map(|own| own[0].cosine).collect(),
        fourth: of(4),
        eighth: of(8),
        modal: modal.flat_map(|own| own[..11].to_vec()).collect(),
    }
}

fn error(found: &[f64], exact: &[f64]) -> f64 {
    assert_eq!(found.len(), exact.len());
    let norm = |own: &mut dyn Iterator<Item = f64>| own.map(|x| x * x).sum::<f64>().sqrt();
    let difference = norm(&mut found.iter().zip(exact).map(|(a, b)| a - b));
    difference / norm(&mut exact.iter().copied())
}

fn fixture(case: &str, what: &str) -> Vec<f64> {
    fn flat(own: &serde_json::Value, out: &mut Vec<f64>) {
        match own.as_array() {
            Some(all) => all.iter().for_each(|own| flat(own, out)),
            None => out.extend(own.as_f64()),
        }
    }
    let all: serde_json::Value =
        serde_json::from_str(include_str!("../../fixtures/crosscheck.json")).unwrap();
    let mut out = Vec::new();
    flat(&all[case][what], &mut out);
    out
}

#[test]
fn reference_cases_are_reproduced() {
    let fine = Resolution { harmonics: 14, azimuths: 96, points: 8, segment: 0.2 };
    for (name, couplings) in [("S1", Couplings::Linear), ("S2", Couplings::Full)] {
        let found = solved(couplings, fine);
        let modal = error(&found.modal, &fixture(name, "modal_fourier_F1_4_L1_4_T1_2"));
        let mean = error(&found.mean, &fixture(name, "hub_mean"));
        let fourth = error(&found.fourth, &fixture(name, "hub_Z4"));
        let eighth = error(&found.eighth, &fixture(name, "hub_Z8"));
        println!("{name}: modal {modal:.1e} mean {mean:.1e} Z4 {fourth:.1e} Z8 {eighth:.1e}");
        assert!(modal < 1e-7 && mean < 1e-7, "{name}: {modal:e} {mean:e}");
        assert!(fourth < 1e-7 && eighth < 1e-4, "{name}: {fourth:e} {eighth:e}");
    }
}

/// The page says 3.3 % of |Z4| for the exact equations of third order and up to 13 % in the vertical force, of a condition that
/// it does not state; here, at S2, it is 4.2 % and 14 %.
#[test]
fn third_order_is_of_the_size_known() {
    let (third, full) = (solved(Couplings::Third, Resolution::default()), fixture("S2", "hub_Z4"));
    let (all, vertical) = (error(&third.fourth, &full), error(&third.fourth[4..6], &full[4..6]));
    println!("third order: {:.2} % of |Z4|, {:.1} % of FZ", 100.0 * all, 100.0 * vertical);
    assert!((all - 0.033).abs() < 0.01 && (vertical - 0.13).abs() < 0.02, "{all} {vertical}");
}

#[test]
fn it_converges_in_harmonics_azimuths_and_stations() {
    let exact = fixture("S2", "hub_Z4");
    let at = |harmonics, azimuths, points| {
        let resolution = Resolution { harmonics, azimuths, points, segment: 0.2 };
        let own = error(&solved(Couplings::Full, resolution).fourth, &exact);
        println!("S2, {harmonics} harmonics, {azimuths} azimuths, {points} points: {own:.1e}");
        own
    };
    let coarse = [at(5, 24, 3), at(5, 24, 5), at(6, 32, 5), at(8, 40, 5), at(10, 48, 5)];
    assert!(coarse[0] > coarse[1] && coarse[1] > coarse[2] && coarse[2] > coarse[3]);
    assert!(coarse[4] < 1e-7, "{:e}", coarse[4]);
}
