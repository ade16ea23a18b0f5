//! The free wake against the inflow measured over a model rotor.

use std::f64::consts::{PI, TAU};
use std::sync::LazyLock;

use reference_rotors::{AttachedPolar, BladeElementRotor, RigidMotion};
use rotor_wake::{
    CirculationMap, CoreSettings, FlightState, FreeWakeSettings, InflowModel, LinearInflow,
    RotorLoading, Vec3, WakeRotor,
};
use validation::{Check, Failure, Table, row};

pub(crate) const ROWS: &[Check] = &[
    row("V-WAKE-29", "Elliott and Althoff's inflow, mu 0.15: correlation with the free wake", "-")
        .against(MAP)
        .shown(0.947, 0.02, || Ok(at(0)?.free.correlation)),
    row("V-WAKE-30", "the same with Drees's inflow", "-")
        .against(MAP)
        .shown(0.886, 0.002, || Ok(at(0)?.drees.correlation)),
    row("V-WAKE-31", "the same: rms distance of the free wake over that of Drees's inflow", "-")
        .against(MAP)
        .shown(0.628, 0.05, || Ok(at(0)?.free.rms / at(0)?.drees.rms)),
    row("V-WAKE-32", "the same: over that of uniform inflow", "-").against(MAP).shown(
        0.333,
        0.03,
        || Ok(at(0)?.free.rms / at(0)?.uniform.rms),
    ),
    row("V-WAKE-33", "Elliott and Althoff's inflow, mu 0.23: correlation with the free wake", "-")
        .against(MAP)
        .shown(0.898, 0.02, || Ok(at(1)?.free.correlation)),
    row("V-WAKE-34", "the same with Drees's inflow", "-")
        .against(MAP)
        .shown(0.832, 0.002, || Ok(at(1)?.drees.correlation)),
    row("V-WAKE-35", "the same: rms distance of the free wake over that of Drees's inflow", "-")
        .against(MAP)
        .shown(0.677, 0.03, || Ok(at(1)?.free.rms / at(1)?.drees.rms)),
    row("V-WAKE-36", "the same: over that of uniform inflow", "-").against(MAP).shown(
        0.483,
        0.02,
        || Ok(at(1)?.free.rms / at(1)?.uniform.rms),
    ),
    row(
        "V-WAKE-37",
        "mu 0.15: collective at 0.75 R of the rigid rotor in its free wake less the \
         measured 9.37 deg",
        "deg",
    )
    .against(GAP)
    .shown(-2.8, 0.2, || gap_deg(0, 0)),
    row("V-WAKE-38", "the same: cos part of the pitch less the measured 1.11 deg", "deg")
        .against(GAP)
        .shown(0.7, 0.2, || gap_deg(0, 1)),
    row("V-WAKE-39", "the same: sin part less the measured -3.23 deg", "deg").against(GAP).shown(
        1.1,
        0.2,
        || gap_deg(0, 2),
    ),
    row("V-WAKE-40", "mu 0.23: collective at 0.75 R less the measured 8.16 deg", "deg")
        .against(GAP)
        .shown(-1.8, 0.2, || gap_deg(1, 0)),
    row("V-WAKE-41", "the same: cos part of the pitch less the measured 1.52 deg", "deg")
        .against(GAP)
        .shown(-0.4, 0.2, || gap_deg(1, 1)),
    row("V-WAKE-42", "the same: sin part less the measured -4.13 deg", "deg").against(GAP).shown(
        1.0,
        0.2,
        || gap_deg(1, 2),
    ),
];

const MAP: &str = "shown, nothing fitted: the figure when written down; fixtures/measured/elliott_althoff; rigid rotor of its \
               thrust, no moment at the hub; means in time 0.0885 R above the disk (height assumed: the source does not \
               give it)";
const GAP: &str = "shown: the figure when written down; the same rotor";

/// Pitch of the blades less the measured one, deg.
fn gap_deg(case: usize, part: usize) -> Result<f64, Failure> {
    Ok(at(case)?.pitch_rad[part].to_degrees() - MEASURED_PITCH_DEG[case][part])
}

/// How an inflow compares with the measured one.
#[derive(Debug, Clone, Copy)]
struct Likeness {
    correlation: f64,
    rms: f64,
}

/// The inflows at one advance ratio.
#[derive(Debug, Clone, Copy)]
struct Comparison {
    free: Likeness,
    drees: Likeness,
    uniform: Likeness,
    /// Mean, cos and sin part.
    pitch_rad: [f64; 3],
}

fn likeness(measured: &[f64], computed: &[f64]) -> Likeness {
    let count = measured.len() as f64;
    let mean = |x: &[f64]| x.iter().sum::<f64>() / count;
    let (a, b) = (mean(measured), mean(computed));
    let (mut aa, mut bb, mut ab, mut square) = (0.0, 0.0, 0.0, 0.0);
    for (x, y) in measured.iter().zip(computed) {
        aa += (x - a).powi(2);
        bb += (y - b).powi(2);
        ab += (x - a) * (y - b);
        square += (x - y).powi(2);
    }
    Likeness { correlation: ab / (aa * bb).sqrt(), rms: (square / count).sqrt() }
}

const CASES: [(&str, f64, f64, &str); 2] = [
    ("nasa_report_rotor_inflow_data_mu_015.csv", 0.15, 3.00, "Mean"),
    ("nasa_report_rotor_inflow_data_mu_023.csv", 0.23, 3.04, "mean"),
];
/// Mean at 0.75 R, cos and sin part of the measured pitch.
const MEASURED_PITCH_DEG: [[f64; 3]; 2] = [[9.37, 1.11, -3.23], [8.16, 1.52, -4.13]];
const RADIUS_M: f64 = 0.860_552;
const CHORD: f64 = 0.066_04 / RADIUS_M;
const THRUST: f64 = 0.0064;
/// Height of the measured plane above the disk, unit `R`.
const PLANE: f64 = 0.0885;
const AZIMUTHS: usize = 24;
/// Updates of wake, circulation and controls; the last ones are averaged, for at low speed they go on wandering.
const UPDATES: usize = 36;
const AVERAGED: usize = 12;

fn at(case: usize) -> Result<Comparison, Failure> {
    static SOLVED: [LazyLock<Result<Comparison, String>>; 2] = [
        LazyLock::new(|| compare(0).map_err(|error| error.to_string())),
        LazyLock::new(|| compare(1).map_err(|error| error.to_string())),
    ];
    SOLVED[case].as_ref().map_err(|error| error.clone().into()).copied()
}

fn compare(case: usize) -> Result<Comparison, Failure> {
    let (file, advance_ratio, tilt_deg, column) = CASES[case];
    let flight = FlightState { advance_ratio, shaft_tilt_rad: tilt_deg.to_radians() };
    let table = Table::read(&format!("../measured/elliott_althoff/{file}"))?;
    let mut places = Vec::new();
    let mut measured = Vec::new();
    for row in table.rows() {
        let (psi, r) = (row.number("psi")?, row.number("r/R")?);
        if psi < 359.0 && (0.2..=1.0).contains(&r) {
            places.push((psi.to_radians(), r));
            measured.push(-row.number(column)?);
        }
    }
    let linear = |model: LinearInflow| -> Result<Likeness, Failure> {
        let inflow = model.induced(&flight, &RotorLoading::from_thrust_coefficient(THRUST))?;
        let values: Vec<f64> = places.iter().map(|(psi, r)| inflow.at(*psi, *r)).collect();
        Ok(likeness(&measured, &values))
    };
    let points: Vec<Vec3> =
        places.iter().map(|(psi, r)| [r * psi.cos(), r * psi.sin(), PLANE]).collect();
    let (free, pitch_rad) = free_wake(flight, &points)?;
    Ok(Comparison {
        free: likeness(&measured, &free),
        pitch_rad,
        drees: linear(LinearInflow::Drees)?,
        uniform: linear(LinearInflow::Uniform)?,
    })
}

/// Inflow, averaged over time, of the rigid rotor with the measured thrust and without moment at its hub, and its
/// pitch.
fn free_wake(flight: FlightState, points: &[Vec3]) -> Result<(Vec<f64>, [f64; 3]), Failure> {
    let polar = AttachedPolar { zero_lift_drag: 0.008, drag_growth: 0.1 };
    let mut rotor = BladeElementRotor {
        rotor: WakeRotor::cosine(4, 0.2, 20)?,
        chord: CHORD,
        twist_rad: (-8.0_f64).to_radians(),
        tip_mach: 2113.0 * TAU / 60.0 * RADIUS_M / 340.0,
        motion: RigidMotion { pitch_rad: [0.14, 0.02, -0.06], flap_rad: [0.0; 3] },
        polar: &polar,
    };
    let panels = rotor.rotor.panels();
    let (stations, widths) = (rotor.rotor.stations(), rotor.rotor.widths());
    let settings = FreeWakeSettings {
        turns: if flight.advance_ratio < 0.2 { 4 } else { 3 },
        // a chord for what passes the blades
        core: CoreSettings { radius: 0.03, near_radius: CHORD, ..CoreSettings::default() },
        ..FreeWakeSettings::default()
    };
    let mut wake = rotor.starting_wake(&settings, flight, THRUST)?;
    let mut circulation = CirculationMap::constant(AZIMUTHS, panels, TAU * THRUST / 4.0)?;
    let mut inflow = vec![wake.carrying_inflow(); AZIMUTHS * panels];
    let mut mean = vec![0.0; points.len()];
    let solidity = 4.0 * CHORD / PI;
    for update in 0..UPDATES {
        let induction = wake.line_induction(&circulation)?;
        let still = rotor.circulation_in(&flight, &induction, &inflow)?;
        inflow = still.inflow.values().to_vec();
        circulation = still.circulation.mixed(&circulation, 0.5)?;
        // thrust, and its moment about the hub as an amplitude of the flapping moment
        let [mut thrust, mut cosine, mut sine] = [0.0; 3];
        for i in 0..AZIMUTHS {
            let (sin, cos) = (TAU * i as f64 / AZIMUTHS as f64).sin_cos();
            for ((gamma, r), dr) in still.circulation.row(i).iter().zip(&stations).zip(&widths) {
                let lift =
                    4.0 / PI * (r + flight.advance_ratio * sin) * gamma * dr / AZIMUTHS as f64;
                thrust += lift;
                cosine += 2.0 * lift * r * cos;
                sine += 2.0 * lift * r * sin;
            }
        }
        // sigma a / 6 of thrust per rad of pitch, sigma a / 8 of its moment, half of it at once
        let slope = solidity * TAU;
        let [collective, cyclic_c, cyclic_s] = &mut rotor.motion.pitch_rad;
        *collective += 0.5 * (THRUST - thrust) * 6.0 / slope;
        *cyclic_c -= 0.5 * cosine * 8.0 / slope;
        *cyclic_s -= 0.5 * sine * 8.0 / slope;
        for _ in 0..2 {
            wake.sweep(&circulation)?;
        }
        if update + AVERAGED >= UPDATES {
            for (m, v) in mean.iter_mut().zip(wake.mean_velocity(points, &circulation)?) {
                *m -= v[2] / AVERAGED as f64;
            }
        }
    }
    Ok((mean, rotor.motion.pitch_rad))
}
