//! The linearised rotor against differences of converged solutions.

#![expect(clippy::unwrap_used, reason = "a test that cannot unwrap has failed")]
#![expect(clippy::print_stdout, reason = "the measured differences are worth seeing")]

use crate::common;

use rayon::prelude::*;
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_response::{
    Condition, Disturbance, FlapDirection, InflowState, ResponseError, RotorSolution, RotorSolver,
};
use rotor_wake::{
    CirculationMap, FreeWake, FreeWakeSettings, FrozenWake, InducedInflow, InflowModel,
    LinearInflow, PittPeters, RotorLoading, WakeError, WakeMethod, WakeRotor, momentum_inflow,
};

const BLADES: usize = 4;

/// The inflow of another solution, whatever the thrust.
#[derive(Debug)]
struct Frozen(InducedInflow);

impl InflowModel for Frozen {
    fn name(&self) -> &'static str {
        "frozen"
    }

    fn induced(
        &self,
        _: &rotor_wake::FlightState,
        _: &RotorLoading,
    ) -> Result<InducedInflow, WakeError> {
        Ok(self.0.clone())
    }
}

fn unit(flap: usize, n: usize, sine: bool) -> FlapDirection {
    let mut direction = vec![HarmonicSeries::zero(0); 2];
    let harmonic = if sine {
        Harmonic { cosine: 0.0, sine: 1.0 }
    } else {
        Harmonic { cosine: 1.0, sine: 0.0 }
    };
    direction[flap].set_harmonic(n, harmonic);
    direction
}

fn moved(condition: &Condition, direction: &FlapDirection, by_rad: f64) -> Condition {
    let mut moved = condition.clone();
    for (angle, along) in moved.flap_angles_rad.iter_mut().zip(direction) {
        for k in 1..=along.harmonics.len() {
            let (mut a, d) = (angle.harmonic(k), along.harmonic(k));
            a.cosine += by_rad * d.cosine;
            a.sine += by_rad * d.sine;
            angle.set_harmonic(k, a);
        }
        angle.mean += by_rad * along.mean;
    }
    moved
}

fn difference(
    (solver, condition, about): (&RotorSolver, &Condition, &RotorSolution),
    inflow: &dyn InflowModel,
    direction: &FlapDirection,
) -> Result<[f64; 12], ResponseError> {
    let step_rad = 0.5_f64.to_radians();
    let at = |sign: f64| -> Result<[f64; 12], ResponseError> {
        let condition = moved(condition, direction, sign * step_rad);
        Ok(solver.clone().solve(&condition, inflow, Some(about))?.hub.harmonic(BLADES))
    };
    let (plus, minus) = (at(1.0)?, at(-1.0)?);
    Ok(std::array::from_fn(|k| (plus[k] - minus[k]) / (2.0 * step_rad)))
}

fn norm(z: impl IntoIterator<Item = f64>) -> f64 {
    z.into_iter().map(|v| v * v).sum::<f64>().sqrt()
}

/// T of higher harmonics of root pitch against differences of converged responses, the inflow settled; with the inflow held
/// it is far off.
#[test]
fn root_pitch_is_linearised_as_differences_are() {
    let mut solver = common::solver();
    let (condition, inflow) = (common::condition(), PittPeters);
    let rest = solver.solve(&condition, &inflow, None).unwrap();
    let series: Vec<HarmonicSeries> = [2, 3, 4, 5]
        .into_iter()
        .flat_map(|n| {
            [(n, Harmonic { cosine: 1.0, sine: 0.0 }), (n, Harmonic { cosine: 0.0, sine: 1.0 })]
        })
        .map(|(n, harmonic)| {
            let mut series = HarmonicSeries::zero(n);
            series.set_harmonic(n, harmonic);
            series
        })
        .collect();
    let along: Vec<Disturbance> = series.iter().cloned().map(Disturbance::RootPitch).collect();
    let mut of = |state| {
        let found = solver.linearised_along((&condition, &rest), &inflow, &along, state).unwrap();
        let hub = found.sensitivities.iter().flat_map(|one| one.hub.harmonic(BLADES));
        hub.collect::<Vec<f64>>()
    };
    let (settled, frozen) = (of(InflowState::Settled), of(InflowState::Frozen));
    let step_rad = 0.05_f64.to_radians();
    let at = |series: &HarmonicSeries, by_rad: f64| {
        let mut moved = series.clone();
        for n in 1..=series.harmonics.len() {
            let Harmonic { cosine, sine } = series.harmonic(n);
            moved.set_harmonic(n, Harmonic { cosine: by_rad * cosine, sine: by_rad * sine });
        }
        let found = solver.with_root_pitch(moved).solve(&condition, &inflow, Some(&rest));
        found.unwrap().hub.harmonic(BLADES)
    };
    let exact: Vec<f64> = series
        .iter()
        .flat_map(|one| {
            let (plus, minus) = (at(one, step_rad), at(one, -step_rad));
            plus.into_iter().zip(minus).map(|(a, b)| (a - b) / (2.0 * step_rad)).collect::<Vec<_>>()
        })
        .collect();
    let off =
        |found: &[f64]| norm(found.iter().zip(&exact).map(|(a, b)| a - b)) / norm(exact.clone());
    println!(
        "root pitch: {:.1e} settled, {:.1e} with the inflow held",
        off(&settled),
        off(&frozen)
    );
    assert!(off(&settled) < 1e-4 && off(&frozen) > 3e-4);
}

/// Distance of T and of the hinge moments' derivatives from differences of converged solutions, each over
/// the norm of the whole.
fn settled_gap(inflow: &dyn InflowModel, step_deg: f64) -> [f64; 3] {
    let load_harmonics = 6;
    let mut solver = common::solver();
    let condition = common::condition();
    let rest = solver.solve(&condition, inflow, None).unwrap();
    let directions: Vec<FlapDirection> = [2, 4]
        .into_iter()
        .flat_map(|n| [unit(0, n, false), unit(1, n, true), unit(1, n, false)])
        .collect();
    let at = (&condition, &rest);
    let mut of = |state| solver.linearised(at, inflow, &directions, state).unwrap();
    let (settled, frozen) = (of(InflowState::Settled), of(InflowState::Frozen));
    println!(
        "{}: {} evaluations settled, {} frozen",
        inflow.name(),
        settled.evaluations,
        frozen.evaluations
    );
    let parts = directions
        .par_iter()
        .enumerate()
        .map(|(k, direction)| {
            let step_rad = step_deg.to_radians();
            let at = |sign: f64| {
                let moved = moved(&condition, direction, sign * step_rad);
                let found = solver.clone().solve(&moved, inflow, Some(&rest)).unwrap();
                let hinge: Vec<f64> = found
                    .hinge
                    .iter()
                    .flat_map(|h| {
                        let total = h.total();
                        (1..=load_harmonics)
                            .flat_map(|n| [total.harmonic(n).cosine, total.harmonic(n).sine])
                            .collect::<Vec<f64>>()
                    })
                    .collect();
                (found.hub.harmonic(BLADES), hinge)
            };
            let (plus, minus) = (at(1.0), at(-1.0));
            let mut sums = [0.0; 5];
            for k_load in 0..12 {
                let exact = (plus.0[k_load] - minus.0[k_load]) / (2.0 * step_rad);
                let of = |found: &rotor_response::LinearisedRotor| {
                    found.sensitivities[k].hub.harmonic(BLADES)[k_load]
                };
                sums[0] += (of(&settled) - exact).powi(2);
                sums[1] += exact.powi(2);
                sums[4] += (of(&frozen) - exact).powi(2);
            }
            let hinge = settled.sensitivities[k].hinge.iter().flat_map(|total| {
                (1..=load_harmonics).flat_map(|n| {
                    let h = total.harmonic(n);
                    [h.cosine, h.sine]
                })
            });
            for (linear, (p, m)) in hinge.zip(plus.1.iter().zip(&minus.1)) {
                let exact = (p - m) / (2.0 * step_rad);
                sums[2] += (linear - exact).powi(2);
                sums[3] += exact.powi(2);
            }
            sums
        })
        .collect::<Vec<_>>();
    let sum = |k: usize| parts.iter().map(|p| p[k]).sum::<f64>();
    let ratios = [sum(0) / sum(1), sum(2) / sum(3), sum(4) / sum(1)].map(f64::sqrt);
    println!(
        "{}: T {:.1e}, hinge {:.1e}, T with the inflow frozen {:.1e}",
        inflow.name(),
        ratios[0],
        ratios[1],
        ratios[2]
    );
    ratios
}

/// Hub loads and hinge moments with an inflow that follows the thrust.
#[test]
fn hinge_moments_are_derived_along_with_the_loads() {
    let [drees, hinge, _] = settled_gap(&LinearInflow::Drees, 0.5);
    assert!(drees <= 1e-4 && hinge <= 1e-4, "{drees:e} {hinge:e}");
}

/// The undistorted wake of a rotor in Drees's inflow, the circulation that it has there, and the wake held still.
fn still_wake(
    solver: &mut RotorSolver,
    condition: &Condition,
) -> (FreeWake, CirculationMap, FrozenWake) {
    let start = solver.solve(condition, &LinearInflow::Drees, None).unwrap();
    let model = solver.rotor().model();
    let (cutout, azimuths) = (model.root_cutout, 16);
    let panels = WakeRotor::cosine(BLADES, cutout, 8).unwrap();
    let settings = FreeWakeSettings { azimuths, turns: 2, ..FreeWakeSettings::default() };
    let flight = condition.flight;
    let mean = momentum_inflow(&flight, start.thrust_coefficient).unwrap();
    let lines = solver.blade_lines(&start.modal, &condition.controls, &panels, azimuths);
    let wake = FreeWake::undistorted(panels.clone(), settings, flight, mean, lines).unwrap();
    let circulation = solver.circulation(&start, &panels, azimuths).unwrap();
    let induction = wake.line_induction(&circulation).unwrap();
    let slope = solver.circulation_slope(&condition.controls, &panels, azimuths);
    let frozen = FrozenWake::new(induction, &circulation, &slope).unwrap();
    (wake, circulation, frozen)
}

/// A wake held still that keeps the Newton matrix of another geometry gives the response of its own, and Newton's steps
/// from it are no slower by half; another grid is refused.
#[test]
fn the_newton_matrix_of_a_wake_before_sets_the_way_alone() {
    let mut solver = common::solver();
    let condition = common::condition();
    let (mut wake, circulation, before) = still_wake(&mut solver, &condition);
    wake.carry_on(WakeMethod::Relaxed, 3, &circulation).unwrap();
    let induction = wake.line_induction(&circulation).unwrap();
    let slope =
        solver.circulation_slope(&condition.controls, wake.rotor(), wake.settings().azimuths);
    let own = FrozenWake::new(induction.clone(), &circulation, &slope).unwrap();
    let kept = before.moved_on(induction, &circulation).unwrap();
    let [own, kept, before] =
        [own, kept, before.clone()].map(|wake| solver.solve(&condition, &wake, None).unwrap());
    let apart = |a: &RotorSolution, b: &RotorSolution| {
        let pairs = a.inflow.parameters().into_iter().zip(b.inflow.parameters());
        pairs.fold(0.0_f64, |most, (a, b)| most.max((a - b).abs()))
    };
    let steps = [&own, &kept].map(|found| found.residuals.inflow_iterations);
    println!("{:.1e} of {:.1e}, {steps:?} steps", apart(&kept, &own), apart(&before, &own));
    assert!(apart(&kept, &own) < 1e-9 && apart(&before, &own) > 1e-4);
    assert!(2 * steps[1] <= 3 * steps[0], "{steps:?}");

    let coarse = WakeRotor::cosine(BLADES, solver.rotor().model().root_cutout, 6).unwrap();
    let lines = solver.blade_lines(&own.modal, &condition.controls, &coarse, 16);
    let other = FreeWake::undistorted(
        coarse.clone(),
        wake.settings().clone(),
        condition.flight,
        0.02,
        lines,
    );
    let few = solver.circulation(&own, &coarse, 16).unwrap();
    let induction = other.unwrap().line_induction(&few).unwrap();
    let refused = still_wake(&mut solver, &condition).2.moved_on(induction, &few).unwrap_err();
    assert!(refused.to_string().contains("96"), "{refused}");
}

/// A wake held still, whose inflow follows the circulation: the derivative sees it, and without it the bound
/// fails by far.
#[test]
fn in_a_wake_the_inflow_settles_on_the_circulation() {
    let (_, _, frozen) = still_wake(&mut common::solver(), &common::condition());
    let [settled, hinge, held] = settled_gap(&frozen, 0.5);
    assert!(settled <= 1e-3 && hinge <= 1e-3, "{settled:e} {hinge:e}");
    assert!(held > 10.0 * 1e-3, "{held:e}");
}

/// Largest difference of a column over the norm of the whole T.
fn gap(model: InflowState, amplitude_deg: f64) -> f64 {
    let mut solver = common::solver();
    let mut condition = common::condition();
    condition = moved(&condition, &unit(0, 3, false), amplitude_deg.to_radians());
    let rest = solver.solve(&condition, &LinearInflow::Drees, None).unwrap();
    let directions: Vec<FlapDirection> = [2, 5]
        .into_iter()
        .flat_map(|n| [unit(0, n, false), unit(0, n, true), unit(1, n, false), unit(1, n, true)])
        .collect();
    let found =
        solver.linearised((&condition, &rest), &LinearInflow::Drees, &directions, model).unwrap();
    assert!(found.relative_residual <= 1e-5);
    let frozen = Frozen(rest.inflow.clone());
    let inflow: &dyn InflowModel = match model {
        InflowState::Frozen => &frozen,
        InflowState::Settled => &LinearInflow::Drees,
    };
    let exact: Vec<[f64; 12]> = directions
        .par_iter()
        .map(|direction| difference((&solver, &condition, &rest), inflow, direction).unwrap())
        .collect();
    let (mut whole, mut off) = (0.0, 0.0);
    for (exact, column) in exact.into_iter().zip(&found.sensitivities) {
        let linear = column.hub.harmonic(BLADES);
        whole = norm([whole, norm(exact)]);
        off = norm([off, norm((0..12).map(|k| linear[k] - exact[k]))]);
    }
    println!(
        "{model:?}, {amplitude_deg} deg: |T_lin - T_fd| / |T_fd| = {:.2e}, {} evaluations, {} factorisations",
        off / whole,
        found.evaluations,
        found.factorisations
    );
    off / whole
}

#[test]
fn with_frozen_and_settled_inflow_it_is_the_derivative() {
    assert!(gap(InflowState::Frozen, 0.0) <= 1e-4);
    assert!(gap(InflowState::Settled, 0.0) <= 1e-4);
    // also about flaps that move
    assert!(gap(InflowState::Settled, 3.0) <= 1e-4);
}

#[test]
fn the_inflow_that_settles_is_seen() {
    // 2/rev changes the mean thrust through the advancing side: frozen and settled differ
    let mut solver = common::solver();
    let condition = common::condition();
    let rest = solver.solve(&condition, &LinearInflow::Drees, None).unwrap();
    let directions = [unit(0, 2, false), unit(1, 2, true)];
    let mut of = |state| {
        solver.linearised((&condition, &rest), &LinearInflow::Drees, &directions, state).unwrap()
    };
    let (frozen, settled) = (of(InflowState::Frozen), of(InflowState::Settled));
    let pairs = frozen.sensitivities.iter().zip(&settled.sensitivities);
    let changes: Vec<f64> = pairs
        .map(|(a, b)| {
            let (a, b) = (a.hub.harmonic(BLADES), b.hub.harmonic(BLADES));
            norm((0..12).map(|k| a[k] - b[k])) / norm(b)
        })
        .collect();
    println!("frozen against settled: {changes:?}");
    // several times the bound of the test above, which would notice the one for the other
    assert!(changes.iter().any(|change| *change > 4e-4), "{changes:?}");
}

#[test]
fn directions_add_up() {
    let mut solver = common::solver();
    let condition = common::condition();
    let rest = solver.solve(&condition, &LinearInflow::Drees, None).unwrap();
    let mut both = unit(0, 3, false);
    both[1].set_harmonic(4, Harmonic { cosine: 0.0, sine: -2.0 });
    both[1].mean = 0.5;
    let mut mean = vec![HarmonicSeries::zero(0); 2];
    mean[1].mean = 1.0;
    let directions = [both, unit(0, 3, false), unit(1, 4, true), mean];
    let found = solver
        .linearised((&condition, &rest), &LinearInflow::Drees, &directions, InflowState::Settled)
        .unwrap();
    let z: Vec<[f64; 12]> = found.sensitivities.iter().map(|s| s.hub.harmonic(BLADES)).collect();
    let off = norm((0..12).map(|k| z[0][k] - (z[1][k] - 2.0 * z[2][k] + 0.5 * z[3][k])));
    assert!(off <= 1e-4 * norm(z[0]), "{off:e}");
    // a direction for one flap only
    let refused = solver.linearised(
        (&condition, &rest),
        &LinearInflow::Drees,
        &[vec![HarmonicSeries::zero(1)]],
        InflowState::Frozen,
    );
    assert!(matches!(refused, Err(ResponseError::FlapMotions { given: 1, expected: 2 })));
}

/// Pitt and Peters: three numbers of the inflow, which more directions of the flaps than three ask for.
/// Directions that depend on each other must not count as new ones.
#[test]
fn with_an_inflow_that_follows_the_moments_it_is_the_derivative() {
    let [settled, hinge, frozen] = settled_gap(&PittPeters, 0.5);
    assert!(settled <= 5e-5 && hinge <= 1e-5, "{settled:e} {hinge:e}");
    assert!(frozen > 1e-4, "{frozen:e}");
}
