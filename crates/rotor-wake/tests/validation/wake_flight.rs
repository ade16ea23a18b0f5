//! The free wake in forward flight: its mean inflow.

use std::f64::consts::TAU;

use rotor_wake::{
    BladeLines, CirculationMap, CoreModel, FlightState, FreeWake, FreeWakeSettings, SegmentSet,
    Vec3, WakeRotor, induced_velocities, momentum_inflow,
};
use validation::{Check, Failure, row, worst};

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-WAKE-22",
        "undistorted tip helices of V-WAKE-08, mu 0.1 to 0.35: inflow averaged over \
         disk and time over Glauert's, largest distance from 1",
        "-",
    )
    .against(
        "momentum theory; what V-WAKE-08 has above 1 is that blades meet their \
         wakes in phase",
    )
    .at_most(0.03, || {
        let ratios = ADVANCE_RATIOS.map(|mu| Ok((helices(4, mu)?[1] - 1.0).abs()));
        worst("advance ratios", 4, ratios)
    }),
    row(
        "V-WAKE-23",
        "the same with twelve blades of the same total circulation: at the blades \
         over the mean in time, largest distance from 1 (four blades: 0.25)",
        "-",
    )
    .against("many blades see the mean")
    .at_most(0.05, || {
        let ratios = ADVANCE_RATIOS.map(|mu| {
            let [blades, time] = helices(12, mu)?;
            Ok((blades / time - 1.0).abs())
        });
        worst("advance ratios", 4, ratios)
    }),
    row(
        "V-WAKE-24",
        "free wake, elliptic circulation without rolling moment, mu 0.10: inflow at \
         the blades over Glauert's",
        "-",
    )
    .against(AT_BLADES)
    .shown(1.20, 0.03, || Ok(free_wake(0.10)?[0])),
    row("V-WAKE-25", "the same, mu 0.20", "-")
        .against(AT_BLADES)
        .shown(1.17, 0.02, || Ok(free_wake(0.20)?[0])),
    row("V-WAKE-26", "the same, mu 0.30", "-")
        .against(AT_BLADES)
        .shown(1.27, 0.02, || Ok(free_wake(0.30)?[0])),
    row("V-WAKE-27", "the same, mu 0.35", "-")
        .against(AT_BLADES)
        .shown(1.32, 0.02, || Ok(free_wake(0.35)?[0])),
    row(
        "V-WAKE-28",
        "the same averaged over disk and time, mu 0.20 to 0.35: largest distance \
         from 1",
        "-",
    )
    .against("momentum theory")
    .at_most(0.05, || {
        let ratios = [0.2, 0.3, 0.35].map(|mu| Ok((free_wake(mu)?[1] - 1.0).abs()));
        worst("advance ratios", 3, ratios)
    }),
];

const AT_BLADES: &str = "shown: the figure when written down; momentum theory gives 1 for the mean in time \
                     (V-WAKE-28), blades meet their wakes in phase";

const ADVANCE_RATIOS: [f64; 4] = [0.1, 0.2, 0.3, 0.35];
const THRUST: f64 = 0.0049;

fn flight(advance_ratio: f64) -> FlightState {
    FlightState { advance_ratio, shaft_tilt_rad: 5.0_f64.to_radians() }
}

/// Mean inflow over the disk of undistorted tip helices over Glauert's: where the blades are, and averaged over time at
/// fixed points.
fn helices(blades: usize, advance_ratio: f64) -> Result<[f64; 2], Failure> {
    const STATIONS: usize = 40;
    const AZIMUTHS: usize = 72;
    let flight = flight(advance_ratio);
    let inflow = momentum_inflow(&flight, THRUST)?;
    let rotor = WakeRotor::uniform(blades, 0.2, 20)?;
    let settings = FreeWakeSettings { azimuths: AZIMUTHS, turns: 3, ..FreeWakeSettings::default() };
    let lines = BladeLines::flat(&rotor, AZIMUTHS);
    let wake = FreeWake::undistorted(rotor, settings, flight, inflow, lines)?;
    let vortices = wake.vortices();
    let spacing = AZIMUTHS / blades;
    let instants: Vec<SegmentSet> = (0..spacing)
        .map(|phase| {
            let mut set = SegmentSet::new(CoreModel::Vatistas);
            for b in 0..blades {
                for ends in vortices[0].points[phase + spacing * b].windows(2) {
                    set.push(ends[0], ends[1], TAU * THRUST / blades as f64, 0.02);
                }
            }
            set
        })
        .collect();
    let (mut at_blades, mut in_time, mut area) = (0.0, 0.0, 0.0);
    for i in 0..AZIMUTHS {
        let (sin, cos) = (TAU * i as f64 / AZIMUTHS as f64).sin_cos();
        let radii = (0..STATIONS).map(|k| (k as f64 + 0.5) / STATIONS as f64);
        let points: Vec<Vec3> = radii.clone().map(|r| [r * cos, r * sin, 0.0]).collect();
        for (phase, set) in instants.iter().enumerate() {
            for (r, v) in radii.clone().zip(induced_velocities(&points, set)) {
                in_time -= r * v[2] / spacing as f64;
                if phase == i % spacing {
                    at_blades -= r * v[2];
                    area += r;
                }
            }
        }
    }
    Ok([at_blades / area / inflow, in_time / area / inflow])
}

/// The same for a free wake of elliptic circulation, less on the advancing side so that there is no rolling moment.
fn free_wake(advance_ratio: f64) -> Result<[f64; 2], Failure> {
    const AZIMUTHS: usize = 24;
    const SWEEPS: u32 = 40;
    const AVERAGED: u32 = 8;
    let flight = flight(advance_ratio);
    let inflow = momentum_inflow(&flight, THRUST)?;
    let rotor = WakeRotor::cosine(4, 0.2, 20)?;
    let (stations, widths) = (rotor.stations(), rotor.widths());
    let circulation = CirculationMap::elliptic(&rotor, AZIMUTHS, THRUST, advance_ratio)?;
    let lines = BladeLines::flat(&rotor, AZIMUTHS);
    let settings = FreeWakeSettings::default();
    let mut wake = FreeWake::undistorted(rotor, settings, flight, inflow, lines)?;
    for _ in 0..SWEEPS {
        wake.sweep(&circulation)?;
    }
    // between the azimuths of the grid, where no blade stands on a point
    let mut points: Vec<Vec3> = Vec::new();
    let mut weights = Vec::new();
    for i in 0..AZIMUTHS {
        let (sin, cos) = (TAU * (i as f64 + 0.5) / AZIMUTHS as f64).sin_cos();
        for (r, dr) in stations.iter().zip(&widths) {
            points.push([r * cos, r * sin, 0.0]);
            weights.push(r * dr);
        }
    }
    let area: f64 = weights.iter().sum();
    let (mut at_blades, mut in_time) = (0.0, 0.0);
    // at low speed the sweeps go on wandering by some percent of R: the mean over some of them
    for _ in 0..AVERAGED {
        wake.sweep(&circulation)?;
        at_blades += wake.line_induction(&circulation)?.inflow(&circulation)?.mean();
        let velocities = wake.mean_velocity(&points, &circulation)?;
        let sum: f64 = velocities.iter().zip(&weights).map(|(v, weight)| -weight * v[2]).sum();
        in_time += sum / area;
    }
    let scale = inflow * f64::from(AVERAGED);
    Ok([at_blades / scale, in_time / scale])
}
