//! The free wake in hover.

use std::f64::consts::{PI, SQRT_2, TAU};
use std::sync::LazyLock;

use reference_rotors::{
    AttachedPolar, BladeElementRotor, BladeElementSolution, CARADONNA_TUNG_THRUST,
    CouplingSettings, Landgrebe, contraction_drift,
};
use rotor_wake::{
    CirculationMap, CoreModel, FlightState, FreeWake, FreeWakeSettings, Vec3, WakeError,
    WakeFilament, WakeMarch, WakeSymmetry,
};
use validation::{Check, Failure, row, worst};

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-WAKE-14",
        "thrust of Caradonna and Tung's rotor at 5, 8, 12 deg, Vatistas's cores: \
         largest relative error",
        "-",
    )
    .against(
        "C_T 0.00213, 0.00459, 0.00796 of NASA TM 81232 as quoted since (0.00474 at \
         8 deg by another)",
    )
    .at_most(0.05, || caradonna_tung(CoreModel::Vatistas)),
    row("V-WAKE-15", "the same with the corrected cores: largest relative error", "-")
        .against("the same; the two core models lie on either side of the measurement")
        .at_most(0.08, || caradonna_tung(CoreModel::RosenheadMoore)),
    row(
        "V-WAKE-16",
        "tip vortex of four slender blades of -8 deg twist, free near wake of 90 \
         deg: radius at ages of 90 to 720 deg, largest relative error",
        "-",
    )
    .against("Landgrebe, J. Am. Helicopter Soc. 17 (1972)")
    .at_most(0.10, || {
        let TipVortex { landgrebe, tip, turn } = slender()?;
        worst(
            "ages",
            6,
            [1, 2, 3, 4, 6, 8].map(|quarters| {
                let (age, zeta) = (quarters * turn / 4, quarters as f64 * 0.25 * TAU);
                Ok((tip[age][0] / landgrebe.radius(zeta) - 1.0).abs())
            }),
        )
    }),
    row(
        "V-WAKE-17",
        "the same: descent per rad of age in the turn behind the first passage \
         (k2), relative error",
        "-",
    )
    .against("the same")
    .at_most(0.10, || {
        let TipVortex { landgrebe, tip, turn } = slender()?;
        let behind = tip[turn / 4 + turn][1] - tip[turn / 4][1];
        Ok((behind / TAU / landgrebe.k2() - 1.0).abs())
    }),
    row(
        "V-WAKE-18",
        "the same: height at the first passage over its age (k1), relative error",
        "-",
    )
    .against(
        "the same; other steps, cores and loads have 0.45 to 1.25 of it: the \
         free-wake page",
    )
    .at_most(0.10, || {
        let TipVortex { landgrebe, tip, turn } = slender()?;
        Ok((tip[turn / 4][1] / (0.25 * TAU) / landgrebe.k1() - 1.0).abs())
    })
    .machine_dependent(),
    row(
        "V-WAKE-57",
        "the same with steps of 7.5 deg, k1 and k2 fitted to the first turn by \
         least squares: larger relative error",
        "-",
    )
    .against(
        "the same, in Landgrebe's form: two straight lines that meet at the first \
         passage",
    )
    .at_most(0.10, || {
        let settings = rolling_up().with_azimuths(48);
        let TipVortex { landgrebe, tip, turn } = &tip_vortex(&settings)?;
        let heights: Vec<f64> = tip[..=*turn].iter().map(|at| at[1]).collect();
        let fitted = Landgrebe::fitted(&heights, settings.step_rad(), 0.25 * TAU);
        let [k1, k2] = fitted.unwrap_or([f64::NAN; 2]);
        Ok((k1 / landgrebe.k1() - 1.0).abs().max((k2 / landgrebe.k2() - 1.0).abs()))
    })
    .machine_dependent(),
    row(
        "V-WAKE-19",
        "figure of merit of the same rotor, its near wake as in forward flight, \
         sections without drag",
        "-",
    )
    .against("1 is the most that momentum theory allows")
    .between(0.80, 1.0, || {
        let mut rotor = reference_rotors::slender()?;
        rotor.polar = &AttachedPolar { zero_lift_drag: 0.0, drag_growth: 0.0 };
        let (solution, _) = hover(&rotor, CoreModel::RosenheadMoore)?;
        let ideal = solution.thrust_coefficient.max(0.0).powf(1.5) / SQRT_2;
        Ok(ideal / solution.torque_coefficient)
    }),
    row(
        "V-WAKE-20",
        "the rotor of V-WAKE-16: displacement of the tip vortex over 200 sweeps \
         after it has settled, largest",
        "R",
    )
    .against("a wake that turns with its rotor")
    .at_most(1e-9, drift)
    .machine_dependent(),
    row(
        "V-WAKE-21",
        "the rotor of V-WAKE-19 marched in time by PC2B for 200 steps: radius and \
         height of the tip vortex at ages up to a turn, mean over the last 96 steps \
         against the 96 before, largest",
        "R",
    )
    .against("it does not drift; its older turns pair and wander (V-WAKE-45)")
    .at_most(0.02, marched_drift)
    .machine_dependent(),
    row(
        "V-WAKE-43",
        "the same rotor in a climb at a tenth of the tip speed, PC2B for 216 steps: \
         RMS change in the last revolution",
        "R",
    )
    .against("a wake far from its own turns comes to rest")
    .at_most(1e-4, || Ok(climb()?.0))
    .machine_dependent(),
    row(
        "V-WAKE-44",
        "the same: amplitude of what alternates from step to step in the height of \
         the tip vortex, largest",
        "R",
    )
    .against(
        "damped by the backward difference; differences about the middle of the \
         cell keep 1e-4",
    )
    .at_most(1e-6, || Ok(climb()?.1))
    .machine_dependent(),
    row(
        "V-WAKE-45",
        "growth of a disturbance of 1e-8 of the circulation in the hovering wake of \
         V-WAKE-21, per rad, over the rate at which the turns of a row of vortices \
         pair",
        "-",
    )
    .against(
        "pi Gamma / 4 h^2, H. Lamb, Hydrodynamics, section 156, h the distance of \
         neighbouring turns: the instability is the vortices' own",
    )
    .between(0.3, 1.2, pairing)
    .machine_dependent(),
];

/// A rotor settled with its wake in hover.
fn hover(
    rotor: &BladeElementRotor<'_>,
    model: CoreModel,
) -> Result<(BladeElementSolution, FreeWake), WakeError> {
    hover_with(rotor, &FreeWakeSettings::hover(model))
}

fn hover_with(
    rotor: &BladeElementRotor<'_>,
    settings: &FreeWakeSettings,
) -> Result<(BladeElementSolution, FreeWake), WakeError> {
    let still = FlightState { advance_ratio: 0.0, shaft_tilt_rad: 0.0 };
    let mut wake = rotor.starting_wake(settings, still, 0.0046)?;
    let coupling = CouplingSettings { updates: 80, sweeps: 2, inflow_tolerance: 1e-4 };
    Ok((rotor.solve(&mut wake, &coupling)?, wake))
}

fn caradonna_tung(model: CoreModel) -> Result<f64, Failure> {
    worst(
        "pitches",
        3,
        CARADONNA_TUNG_THRUST.map(|(pitch_deg, measured)| {
            let rotor = reference_rotors::caradonna_tung(pitch_deg.to_radians())?;
            Ok((hover(&rotor, model)?.0.thrust_coefficient / measured - 1.0).abs())
        }),
    )
}

/// Landgrebe's vortex, radius and height of the computed one by age, and the steps of a turn.
#[derive(Clone)]
struct TipVortex {
    landgrebe: Landgrebe,
    tip: Vec<[f64; 2]>,
    turn: usize,
}

fn rolling_up() -> FreeWakeSettings {
    FreeWakeSettings::hover_rolling_up(CoreModel::RosenheadMoore)
}

/// Of the four slender blades.
fn tip_vortex(settings: &FreeWakeSettings) -> Result<TipVortex, WakeError> {
    let rotor = reference_rotors::slender()?;
    let (solution, wake) = hover_with(&rotor, settings)?;
    let landgrebe = Landgrebe::of(&rotor, solution.thrust_coefficient);
    Ok(TipVortex { landgrebe, tip: contraction_drift(&wake), turn: settings.azimuths })
}

fn slender() -> Result<&'static TipVortex, Failure> {
    static SOLVED: LazyLock<Result<TipVortex, WakeError>> =
        LazyLock::new(|| tip_vortex(&rolling_up()));
    Ok(SOLVED.as_ref().map_err(Clone::clone)?)
}

fn drift() -> Result<f64, Failure> {
    let (solution, mut wake) = hover_with(&reference_rotors::slender()?, &rolling_up())?;
    for _ in 0..40 {
        wake.sweep(&solution.circulation)?;
    }
    let before = contraction_drift(&wake);
    for _ in 0..200 {
        wake.sweep(&solution.circulation)?;
    }
    let pairs = before.iter().zip(contraction_drift(&wake));
    worst("ages", before.len(), pairs.map(|(a, b)| Ok((a[0] - b[0]).hypot(a[1] - b[1]))))
}

const STEPS: usize = 24;

/// Change of the mean tip vortex of the first turn between two spans of 96 steps.
fn marched_drift() -> Result<f64, Failure> {
    let (solution, wake) = hover(&reference_rotors::slender()?, CoreModel::RosenheadMoore)?;
    let mut march = WakeMarch::new(wake);
    march.revolutions(1, &solution.circulation)?;
    let mut means = [vec![[0.0; 2]; STEPS + 1], vec![[0.0; 2]; STEPS + 1]];
    for mean in &mut means {
        for _ in 0..4 {
            march.revolutions(1, &solution.circulation)?;
            for (m, at) in mean.iter_mut().zip(contraction_drift(march.wake())) {
                *m = [m[0] + 0.25 * at[0], m[1] + 0.25 * at[1]];
            }
        }
    }
    let pairs = means[0].iter().zip(&means[1]);
    worst("ages", STEPS + 1, pairs.map(|(a, b)| Ok((a[0] - b[0]).hypot(a[1] - b[1]))))
}

/// Last change and alternating part of a climbing wake.
fn climb() -> Result<(f64, f64), Failure> {
    static SOLVED: LazyLock<Result<(f64, f64), WakeError>> = LazyLock::new(|| {
        let mut rotor = reference_rotors::slender()?;
        rotor.motion.pitch_rad[0] += 0.1;
        let settings = FreeWakeSettings {
            symmetry: WakeSymmetry::Periodic,
            ..FreeWakeSettings::hover(CoreModel::RosenheadMoore)
        };
        // straight up but for a millionth
        let flight = FlightState { advance_ratio: 1e-6, shaft_tilt_rad: 1e5_f64.atan() };
        let mut wake = rotor.starting_wake(&settings, flight, 0.0046)?;
        let coupling = CouplingSettings { updates: 60, sweeps: 2, inflow_tolerance: 1e-4 };
        let row = rotor.solve(&mut wake, &coupling)?.circulation.row(0).to_vec();
        let circulation = CirculationMap::from_fn(STEPS, row.len(), |_, s| row[s])?;
        let mut march = WakeMarch::new(wake);
        let changes = march.revolutions(9, &circulation)?;
        let mut alternating = 0.0_f64;
        if let Some(tip) = march.wake().vortices().last() {
            for age in 1..tip.points[0].len() {
                let pairs = tip.points.chunks_exact(2);
                let sum: f64 = pairs.map(|pair| pair[0][age][2] - pair[1][age][2]).sum();
                alternating = alternating.max(sum.abs() / STEPS as f64);
            }
        }
        Ok((changes[8], alternating))
    });
    Ok(SOLVED.as_ref().map_err(Clone::clone).copied()?)
}

/// Growth rate of the distance of two wakes over the rate of pairing.
fn pairing() -> Result<f64, Failure> {
    let rotor = reference_rotors::slender()?;
    let (solution, wake) = hover(&rotor, CoreModel::RosenheadMoore)?;
    let disturbed = CirculationMap::from_fn(STEPS, rotor.rotor.panels(), |i, s| {
        solution.circulation.row(i)[s] * (1.0 + 1e-8)
    })?;
    let tip = contraction_drift(&wake);
    let spacing = (tip[30][1] - tip[6][1]).abs() / rotor.rotor.blades() as f64;
    let strength = solution.circulation.row(0).iter().copied().fold(0.0, f64::max);
    let mut marches = [WakeMarch::new(wake.clone()), WakeMarch::new(wake)];
    marches[0].revolutions(1, &solution.circulation)?;
    marches[1].revolutions(1, &disturbed)?;
    let mut distances = Vec::new();
    for _ in 0..3 {
        for march in &mut marches {
            march.revolutions(1, &solution.circulation)?;
        }
        let [a, b] = [&marches[0], &marches[1]].map(|march| march.wake().vortices());
        let points = |v: &[WakeFilament]| -> Vec<Vec3> {
            v.iter().flat_map(|f| f.points.iter().flatten().copied()).collect()
        };
        let pairs: f64 = points(&a)
            .iter()
            .zip(&points(&b))
            .map(|(p, q)| (0..3).map(|c| (p[c] - q[c]).powi(2)).sum::<f64>())
            .sum();
        distances.push(pairs.sqrt());
    }
    let rate = (distances[2] / distances[0]).ln() / (2.0 * TAU);
    Ok(rate / (PI * strength / (4.0 * spacing * spacing)))
}
