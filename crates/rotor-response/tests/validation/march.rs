//! The blades marched in time, each on its own, against the periodic response.

use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec, TorsionTerms, TwistAngle, Untwist};
use rotor_response::{
    Condition, Controls, Couplings, Discretisation, InstantDrive, ResponseTolerances, Rotor,
    RotorInTime, RotorModel, RotorSolution, RotorSolver,
};
use rotor_wake::{FlightState, LinearInflow};
use std::sync::{Arc, LazyLock};
use validation::{Check, Failure, row, shared};

const PERIODIC: &str = "time elements, whose residuals and states are those of a whole revolution";

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-RESP-71",
        "four blades marched for 12 revolutions in the inflow of a periodic solution, mu 0.30, flaps at 2 \
         and 5/rev, modes damped by 3 %, 288 steps: 4/rev hub loads off those of it, of the vector, Full",
        "-",
    )
    .against(PERIODIC)
    .at_most(4e-3, || Ok(off(Couplings::Full)?[1])),
    row("V-RESP-72", "the same, 144 over 288 steps", "-")
        .against("second order: 4")
        .near(4.0, 0.3, || of_order(Couplings::Full)),
    row("V-RESP-73", "the same with Moderate, 288 steps", "-")
        .against(PERIODIC)
        .at_most(4e-3, || Ok(off(MODERATE)?[1])),
    row("V-RESP-74", "the same with Moderate, 144 over 288 steps", "-")
        .against("second order: 4")
        .near(4.0, 0.3, || of_order(MODERATE)),
];

const MODERATE: Couplings =
    Couplings::Moderate(TorsionTerms { untwist: Untwist::Included, angle: TwistAngle::Rotation });
const MU: f64 = 0.3;
/// Revolutions after which what the start left has died away.
const REVOLUTIONS: usize = 12;

fn of_order(couplings: Couplings) -> Result<f64, Failure> {
    let [coarse, fine] = off(couplings)?;
    Ok(coarse / fine)
}

type Known = LazyLock<Result<[f64; 2], Failure>>;

/// Distance of the loads at 4/rev with 144 and 288 steps. Rows are computed at once: the second waits for the first.
fn off(couplings: Couplings) -> Result<[f64; 2], Failure> {
    static FULL: Known = LazyLock::new(|| marched(Couplings::Full));
    static OTHER: Known = LazyLock::new(|| marched(MODERATE));
    let known = if couplings == Couplings::Full { &FULL } else { &OTHER };
    shared(known).copied()
}

fn marched(couplings: Couplings) -> Result<[f64; 2], Failure> {
    let blade = BladeProperties::new(BladeSpec::table_1())?;
    let model = RotorModel { modal_damping: 0.03, couplings, ..RotorModel::paper_case() };
    let rotor = Arc::new(Rotor::new(model, &blade, Discretisation::default())?);
    let mut moved = HarmonicSeries::zero(5);
    moved.set_harmonic(2, Harmonic { cosine: 0.02, sine: -0.01 });
    moved.set_harmonic(5, Harmonic { cosine: 0.01, sine: 0.02 });
    let condition = Condition {
        flight: FlightState { advance_ratio: MU, shaft_tilt_rad: 0.08 },
        controls: Controls { theta0_rad: 0.14, theta1c_rad: 0.02, theta1s_rad: -0.07 },
        flap_angles_rad: vec![moved.clone(), moved],
        bank_rad: 0.0,
    };
    let mut solver = RotorSolver::new(rotor, MU, ResponseTolerances::default())?;
    let periodic = solver.solve(&condition, &LinearInflow::Drees, None)?;
    let off = |steps: usize| last_revolution(&solver, &condition, &periodic, steps);
    Ok([off(144)?, off(288)?])
}

fn last_revolution(
    solver: &RotorSolver,
    condition: &Condition,
    periodic: &RotorSolution,
    steps: usize,
) -> Result<f64, Failure> {
    let march = RotorInTime::new(solver, steps)?;
    let mut now = march.start(periodic, condition)?;
    let mut found = [0.0; 12];
    for step in 1..=REVOLUTIONS * steps {
        let azimuth = |blade: usize| march.azimuth_rad(step, blade);
        let induced =
            |blade: usize| periodic.inflow.velocities(azimuth(blade), march.lifting_stations());
        let flap_rad = |blade: usize| {
            let flaps = condition.flap_angles_rad.iter();
            flaps.map(|flap| flap.value_and_rates(azimuth(blade))).collect()
        };
        now = march.step(
            &now,
            &InstantDrive { condition, induced: &induced, flap_rad: &flap_rad },
            None,
        )?;
        if step > (REVOLUTIONS - 1) * steps {
            let (sin, cos) = (4.0 * azimuth(0)).sin_cos();
            for (pair, load) in found.chunks_exact_mut(2).zip(now.instant().hub) {
                pair[0] += 2.0 * load * cos / steps as f64;
                pair[1] += 2.0 * load * sin / steps as f64;
            }
        }
    }
    let exact = periodic.hub.harmonic(4);
    let norm = |of: &mut dyn Iterator<Item = f64>| of.map(|v| v * v).sum::<f64>().sqrt();
    let apart = norm(&mut found.iter().zip(exact).map(|(a, b)| a - b));
    Ok(apart / norm(&mut exact.into_iter()))
}
