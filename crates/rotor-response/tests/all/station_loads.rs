//! Loads along the span: force summation, its counterpart in the equations of motion, curvature.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "the measured gaps are worth seeing")]

use crate::common;

use common::{paper_flaps, paper_model, paper_spec};
use flap_aero::AttachedFlowModel;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec, ModalBasis, TorsionTerms};
use rotor_response::{
    Compressibility, Condition, Controls, Couplings, Discretisation, FlapMass, ResponseTolerances,
    Rotor, RotorModel, RotorSolution, RotorSolver, SectionOffsets, StationLoads, TrailingEdgeFlap,
};
use rotor_wake::{FlightState, LinearInflow};
use std::sync::Arc;

const MODERATE: Couplings = Couplings::Moderate(TorsionTerms {
    untwist: rotor_fem::Untwist::Included,
    angle: rotor_fem::TwistAngle::Rotation,
});

/// Flight at mu .3 with flaps as they move, solved; the loads at the stations.
fn loads(
    (model, spec): (RotorModel, BladeSpec),
    discretisation: Discretisation,
    flap: HarmonicSeries,
    stations: &[f64],
) -> (RotorSolution, Vec<StationLoads>) {
    let flaps = vec![flap; model.flaps.len()];
    let blade = BladeProperties::new(spec).unwrap();
    let rotor = Rotor::new(model, &blade, discretisation).unwrap();
    let mut solver = RotorSolver::new(Arc::new(rotor), 0.3, ResponseTolerances::default()).unwrap();
    let deg = f64::to_radians;
    let condition = Condition {
        bank_rad: -0.03,
        flight: FlightState { advance_ratio: 0.3, shaft_tilt_rad: deg(5.5) },
        controls: Controls { theta0_rad: deg(8.0), theta1c_rad: deg(1.0), theta1s_rad: deg(-4.5) },
        flap_angles_rad: flaps,
    };
    let inflow = LinearInflow::Prescribed { induced_inflow: 0.008 };
    let found = solver.solve(&condition, &inflow, None).unwrap();
    let loads = solver.station_loads(&condition, &found, stations).unwrap();
    (found, loads)
}

fn moving_flap() -> HarmonicSeries {
    let mut angle = HarmonicSeries::zero(3);
    angle.set_harmonic(3, Harmonic { cosine: 0.05, sine: 0.02 });
    angle
}

/// Rotors with all that loads a blade.
fn rotors() -> Vec<(RotorModel, BladeSpec)> {
    let flaps = |mass: FlapMass| -> Vec<TrailingEdgeFlap> {
        paper_flaps().into_iter().map(|flap| TrailingEdgeFlap { mass, ..flap }).collect()
    };
    let of = |couplings, mass, offsets| RotorModel {
        flaps: flaps(mass),
        gravity: 0.01,
        section_model: AttachedFlowModel::HariharanLeishman,
        compressibility: Compressibility::LocalMach { tip_mach: 0.58 },
        offsets,
        ..paper_model(couplings)
    };
    let ahead = SectionOffsets { torque: 0.01, aerodynamic_centre: 0.001, ..Default::default() };
    let heavy = SectionOffsets { mass_centre: 0.002, ..SectionOffsets::default() };
    vec![
        (of(Couplings::Linear, FlapMass::PartOfBlade, ahead), paper_spec()),
        (of(Couplings::Full, FlapMass::AddedToBlade, SectionOffsets::default()), paper_spec()),
        (of(MODERATE, FlapMass::AddedToBlade, heavy), paper_spec()),
    ]
}

/// Mean, cosine and sine parts of a series up to 12.
fn parts(series: &HarmonicSeries) -> Vec<f64> {
    let harmonics = (1..=12).map(|n| series.harmonic(n)).flat_map(|h| [h.cosine, h.sine]);
    std::iter::once(series.mean).chain(harmonics).collect()
}

/// At the root the sum is what the blade puts on the hub; at the tip there is nothing left to sum.
#[test]
fn at_the_root_it_is_the_load_on_the_hub_and_at_the_tip_nothing() {
    for rotor in rotors() {
        // the axis of the blade passes y_t ahead of the centre about which the hub loads are taken
        let (torque, couplings) = (rotor.0.offsets.torque, rotor.0.couplings);
        let d = Discretisation::default();
        let (found, at) = loads(rotor, d, moving_flap(), &[0.0, 1.0]);
        let hub = |k: usize| parts(&found.root.components[k]);
        let moved = |k: usize, share: f64, force: usize| -> Vec<f64> {
            hub(k).iter().zip(hub(force)).map(|(m, f)| m + share * f).collect()
        };
        let turned: Vec<f64> = hub(4).iter().map(|m| -m).collect();
        let expected = [hub(0), hub(1), hub(2), turned, moved(5, torque, 0), moved(3, -torque, 2)];
        // with Linear the statics, whose terms of second order its equations leave out
        let moments = if couplings == Couplings::Linear { &at[0].statics } else { &at[0].moments };
        let got = at[0].forces.harmonics.iter().chain(&moments.harmonics);
        for (k, (got, expected)) in got.zip(expected).enumerate() {
            if k == 4 && matches!(couplings, Couplings::Moderate(_)) {
                // the section turns as a whole about the shaft: off the lag moment by terms of third order
                let apart = (got.mean - expected[0]).abs();
                assert!(apart > 1e-9 && apart < 0.05 * got.mean.abs(), "{apart:e} of {}", got.mean);
                continue;
            }
            let gap = parts(got)
                .iter()
                .zip(expected)
                .fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()));
            assert!(gap < 1e-15, "{k}: {gap:e}");
        }
        for history in [&at[1].forces, &at[1].moments, &at[1].statics] {
            assert!(history.values.iter().flatten().all(|v| *v == 0.0));
        }
    }
}

/// A stiff blade that turns in vacuum under its weight:
///
/// ```text
/// N(s) = (1 - s^2) / 2,   flap = -g (1 - s)^2 / 2,   shear up = -g (1 - s)
/// ```
#[test]
fn a_stiff_blade_in_vacuum_pulls_and_hangs() {
    for couplings in [Couplings::Linear, Couplings::Full, MODERATE] {
        let model = RotorModel { lock_number: 1e-9, gravity: 0.001, ..paper_model(couplings) };
        let spec = BladeSpec::uniform(1e6, 1e6, 1e6, 1e8);
        let stations = [0.0, 0.1, 0.333, 0.5, 0.75, 0.9999];
        let (_, at) =
            loads((model, spec), Discretisation::default(), HarmonicSeries::zero(0), &stations);
        for at in at {
            let s = at.station;
            let g = 0.001 * 5.5_f64.to_radians().cos() * 0.03_f64.cos();
            let expected = [0.5 * (1.0 - s * s), -g * (1.0 - s), -0.5 * g * (1.0 - s).powi(2)];
            let got = [
                at.forces.harmonics[0].mean,
                at.forces.harmonics[2].mean,
                at.moments.harmonics[0].mean,
            ];
            for (got, expected) in got.iter().zip(expected) {
                assert!((got - expected).abs() < 2e-8, "{s}: {got} {expected}");
            }
        }
    }
}

const STATIONS: [f64; 4] = [0.0, 0.25, 0.5, 0.75];

/// Gaps between curvature and the sum of the equations over the largest of that harmonic of the moment along
/// the span: worst of the mean and the harmonics to 4/rev, by station and component.
///
/// Without modal damping: its generalised force has no distribution along the span, so a force
/// summation cannot hold it (with .5 % of critical it leaves a gap of 4 % at 3/rev, next to the second
/// flap mode).
fn gaps(modes: usize, basis: ModalBasis, couplings: Couplings) -> [[f64; 3]; 4] {
    let d = Discretisation {
        blade_elements: 40,
        modes: [modes; 3],
        basis,
        time_elements: 12,
        ..Discretisation::default()
    };
    let model = RotorModel { root_cutout: 0.35, modal_damping: 0.0, ..paper_model(couplings) };
    let (_, at) = loads((model, paper_spec()), d, HarmonicSeries::zero(0), &STATIONS);
    let harmonics = |series: &HarmonicSeries| -> Vec<[f64; 2]> {
        let of = |n| series.harmonic(n);
        let all = (1..=4).map(of).map(|h| [h.cosine, h.sine]);
        std::iter::once([series.mean, 0.0]).chain(all).collect()
    };
    let size = |[c, s]: [f64; 2]| f64::hypot(c, s);
    std::array::from_fn(|station| {
        std::array::from_fn(|k| {
            let summed = at.iter().map(|a| harmonics(&a.moments.harmonics[k])).collect::<Vec<_>>();
            let curved = harmonics(&at[station].curvature.harmonics[k]);
            let gap = |n: usize| {
                let largest = summed.iter().map(|s| size(s[n])).fold(0.0, f64::max);
                let [s, c] = [summed[station][n], curved[n]];
                size([s[0] - c[0], s[1] - c[1]]) / largest
            };
            (0..=4).map(gap).fold(0.0, f64::max)
        })
    })
}

fn largest<'a>(gaps: impl IntoIterator<Item = &'a [f64; 3]>) -> [f64; 3] {
    gaps.into_iter().fold([0.0; 3], |most, gap| std::array::from_fn(|k| gap[k].max(most[k])))
}

/// The curvature of completed modes converges to the sum of the equations everywhere, whatever the couplings.
#[test]
fn curvature_of_completed_modes_converges_to_the_force_summation() {
    for (couplings, most) in [(Couplings::Linear, 16), (Couplings::Full, 16), (MODERATE, 10)] {
        let counts: &[usize] = if most == 16 { &[4, 10, 16] } else { &[4, 10] };
        let found: Vec<[f64; 3]> =
            counts.iter().map(|n| largest(&gaps(*n, ModalBasis::Completed, couplings))).collect();
        println!("{couplings:?}: {found:.5?}");
        for pair in found.windows(2) {
            let falls = pair[0].iter().zip(pair[1]).all(|(few, many)| many < *few);
            assert!(falls, "{couplings:?}: {found:?}");
        }
        let bound = if most == 16 { 0.01 } else { 0.03 };
        assert!(
            found[counts.len() - 1].iter().all(|gap| *gap <= bound),
            "{couplings:?}: {found:?}"
        );
    }
}

/// Natural modes vanish at the root with what they carry there but the inertia of their own: torsion, which
/// the propeller moment and the bending load up to the root, converges with 1/N there, and well outboard.
#[test]
fn natural_modes_do_not_carry_torsion_to_the_root() {
    let [ten, sixteen] = [10, 16].map(|modes| gaps(modes, ModalBasis::Natural, Couplings::Full));
    let [at_ten, at_sixteen] = [ten[0][2], sixteen[0][2]];
    println!("{ten:.4?} {sixteen:.4?}");
    assert!(at_sixteen > 0.1 && (0.5..0.8).contains(&(at_sixteen / at_ten)));
    assert!(largest(&sixteen[1..]).iter().all(|gap| *gap <= 0.01), "{sixteen:?}");
}

#[test]
fn a_station_off_the_blade_is_refused() {
    let model = paper_model(Couplings::Full);
    let rotor = Rotor::new(model, &common::paper_blade(), Discretisation::default()).unwrap();
    let mut solver = RotorSolver::new(Arc::new(rotor), 0.3, ResponseTolerances::default()).unwrap();
    let condition = Condition { flap_angles_rad: vec![], ..common::condition() };
    let inflow = LinearInflow::Prescribed { induced_inflow: 0.008 };
    let found = solver.solve(&condition, &inflow, None).unwrap();
    for station in [-0.1, 1.01, f64::NAN] {
        let error = solver.station_loads(&condition, &found, &[0.5, station]).unwrap_err();
        assert!(error.to_string().contains("from 0 to 1 R"), "{error}");
    }
}

/// The turning moment of a flap that weighs beside the blade is about the deflected axis already: summed
/// along the span it is what the equations of motion twist the blade by, up to their own order.
#[test]
fn a_heavy_flap_beside_the_blade_twists_it_once() {
    for couplings in [Couplings::Full, MODERATE] {
        let flaps = paper_flaps()
            .into_iter()
            .map(|flap| TrailingEdgeFlap { mass: FlapMass::AddedToBlade, ..flap })
            .collect();
        let model = RotorModel { flaps, ..paper_model(couplings) };
        let rotor = (model, paper_spec());
        let d = Discretisation::default();
        let stations = [0.0, 0.25, 0.5, 0.7, 0.75];
        let (_, at) = loads(rotor, d, moving_flap(), &stations);
        let torsion = |history: &rotor_response::LoadHistory<3>| history.harmonics[2].mean;
        let largest = at.iter().map(|at| torsion(&at.moments).abs()).fold(0.0, f64::max);
        for at in &at {
            let gap = (torsion(&at.statics) - torsion(&at.moments)).abs() / largest;
            println!("{couplings:?} at {}: {gap:.4} of {largest:.2e}", at.station);
            assert!(gap < 0.01, "{couplings:?} at {}: {gap}", at.station);
        }
    }
}
