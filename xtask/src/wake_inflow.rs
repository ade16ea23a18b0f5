//! Where the mean inflow at the blades comes from: from undistorted helices to the trimmed rotor in its free wake step by
//! step, and then by the part of the wake.
//!
//! Two means of each: at the blades that turn through the disk, and over time at the places they pass. For a wake of
//! undistorted helices the second one is known whatever the load over the disk, as long as it is the same fore and aft:
//! Glauert's inflow at the thrust that the circulation carries (`docs/src/theory/free-wake.md`).

use std::f64::consts::{PI, TAU};

use rotor_wake::{
    BladeLines, CirculationMap, CoreModel, FlightState, FreeWake, FreeWakeSettings, NearWakeMotion,
    SegmentSet, SegmentState, Vec3, WakeRotor, induced_velocities, momentum_inflow,
};
use trim::WakeTrim;
use validation::Failure;

use crate::wake_refinement::paper_trimmed;

/// Rings of the whole disk, as in the reference of the undistorted helices.
const RINGS: usize = 40;
/// Core of these.
const HELIX_CORE: f64 = 0.02;

/// Mean downwash over Glauert's.
#[derive(Debug, Clone, Copy, Default)]
struct Means {
    at_blades: f64,
    in_time: f64,
}

/// The disk on which inflow is averaged: panels of the blades where they are.
struct Disk<'a> {
    rotor: &'a WakeRotor,
    lines: &'a BladeLines,
}

impl Disk<'_> {
    /// Middles of the panels at an azimuth of the grid.
    fn of_blade(&self, azimuth: usize) -> Vec<Vec3> {
        let ends = self.lines.at(azimuth).windows(2);
        ends.map(|p| std::array::from_fn(|k| 0.5 * (p[0][k] + p[1][k]))).collect()
    }

    /// The places between this azimuth and the next one, where no blade stands on the grid.
    fn passed(&self, azimuth: usize) -> Vec<Vec3> {
        let azimuths = self.lines.azimuths();
        let (sin, cos) = (PI / azimuths as f64).sin_cos();
        let next = self.of_blade((azimuth + 1) % azimuths);
        let pairs = self.of_blade(azimuth).into_iter().zip(next);
        pairs
            .map(|([x, y, z], b)| [x * cos - y * sin, x * sin + y * cos, 0.5 * (z + b[2])])
            .collect()
    }

    /// Mean by area of the downwash at points of every azimuth.
    fn mean(&self, velocities: impl FnMut(usize) -> Vec<Vec3>) -> f64 {
        self.by_station(velocities).iter().sum()
    }

    /// What each panel adds to it.
    fn by_station(&self, mut velocities: impl FnMut(usize) -> Vec<Vec3>) -> Vec<f64> {
        let (stations, widths) = (self.rotor.stations(), self.rotor.widths());
        let azimuths = self.lines.azimuths();
        let areas: Vec<f64> = stations.iter().zip(&widths).map(|(r, dr)| r * dr).collect();
        let whole = areas.iter().sum::<f64>() * azimuths as f64;
        let mut out = vec![0.0; areas.len()];
        for i in 0..azimuths {
            for ((sum, v), area) in out.iter_mut().zip(velocities(i)).zip(&areas) {
                *sum -= area / whole * v[2];
            }
        }
        out
    }

    /// Both means of the velocities of segments that repeat with every blade spacing.
    fn means(&self, instants: &[SegmentSet]) -> Means {
        let phases = instants.len();
        let at_blades = self.mean(|i| induced_velocities(&self.of_blade(i), &instants[i % phases]));
        let in_time = self.mean(|i| {
            let points = self.passed(i);
            let mut mean = vec![[0.0; 3]; points.len()];
            for set in instants {
                for (m, v) in mean.iter_mut().zip(induced_velocities(&points, set)) {
                    for (m, v) in m.iter_mut().zip(v) {
                        *m += v / phases as f64;
                    }
                }
            }
            mean
        });
        Means { at_blades, in_time }
    }
}

/// Tip helices of a strength by the azimuth of release, at every instant.
fn tip_helices(wake: &FreeWake, strength: &[f64], core: f64) -> Vec<SegmentSet> {
    let tip = wake.vortices().pop().map(|f| f.points).unwrap_or_default();
    let (azimuths, blades) = (wake.settings().azimuths, wake.rotor().blades());
    let spacing = azimuths / blades;
    let instant = |phase: usize| {
        let mut set = SegmentSet::new(CoreModel::Vatistas);
        for at in (0..blades).map(|b| phase + spacing * b) {
            for (k, ends) in tip[at].windows(2).enumerate() {
                let of = |age: usize| strength[(at + azimuths - age % azimuths) % azimuths];
                set.push(ends[0], ends[1], 0.5 * (of(k) + of(k + 1)), core);
            }
        }
        set
    };
    (0..spacing).map(instant).collect()
}

/// What a step of the way carries and induces.
struct Step {
    means: Means,
    /// Thrust carried by its circulation over that of the rotor.
    carried: f64,
}

/// A wake as it is: at the blades as they feel it, and over time.
fn of_wake(wake: &FreeWake, circulation: &CirculationMap) -> Result<Means, Failure> {
    let disk = Disk { rotor: wake.rotor(), lines: wake.lines() };
    let at_blades = wake.line_induction(circulation)?.inflow(circulation)?.mean();
    let points: Vec<Vec3> = (0..wake.lines().azimuths()).flat_map(|i| disk.passed(i)).collect();
    let velocities = wake.mean_velocity(&points, circulation)?;
    let panels = wake.rotor().panels();
    let in_time = disk.mean(|i| velocities[i * panels..(i + 1) * panels].to_vec());
    Ok(Means { at_blades, in_time })
}

/// The steps from undistorted helices to a trimmed rotor.
const STEPS: [&str; 7] = [
    "tip helices of constant circulation 2 pi C_T / N_b, whole disk",
    "the same over the lifting span alone",
    "released and felt by the deflected blades of the trim",
    "strength: the outboard peak of its circulation, mean over the azimuth",
    "the peak of every azimuth",
    "bound vortices, and all trailers for a revolution",
    "moved freely: the trimmed rotor",
];

fn steps(trimmed: &WakeTrim) -> Result<Vec<Step>, Failure> {
    let (wake, circulation) = (&trimmed.wake, &trimmed.moving);
    let (rotor, settings, flight) = (wake.rotor(), wake.settings(), *wake.flight());
    let (blades, azimuths, mu) = (rotor.blades() as f64, settings.azimuths, flight.advance_ratio);
    let ct = circulation.thrust_coefficient(rotor, mu);
    let glauert = momentum_inflow(&flight, ct)?;
    let undistorted = |near_wake_motion, lines: &BladeLines| {
        let settings = FreeWakeSettings { near_wake_motion, ..settings.clone() };
        FreeWake::undistorted(rotor.clone(), settings, flight, glauert, lines.clone())
    };
    let flat = undistorted(settings.near_wake_motion, &BladeLines::flat(rotor, azimuths))?;
    let deflected = undistorted(NearWakeMotion::Convected, wake.lines())?;
    let rings = WakeRotor::uniform(rotor.blades(), 0.0, RINGS)?;
    let whole = BladeLines::flat(&rings, azimuths);
    let lifting = |wake: &FreeWake, strength: &[f64]| {
        Disk { rotor, lines: wake.lines() }.means(&tip_helices(wake, strength, HELIX_CORE))
    };
    let constant = vec![TAU * ct / blades; azimuths];
    let peaks = circulation.outboard_peaks().into_iter().enumerate();
    let peaks: Vec<f64> = peaks.map(|(i, s)| circulation.row(i)[s]).collect();
    let mean = vec![peaks.iter().sum::<f64>() / azimuths as f64; azimuths];
    // of constant circulation from the centre to the tip
    let carried = |strength: &[f64]| {
        let of = |(i, g): (usize, &f64)| g * (0.5 + mu * (TAU * i as f64 / azimuths as f64).sin());
        let sum: f64 = strength.iter().enumerate().map(of).sum();
        blades / PI * sum / azimuths as f64 / ct
    };
    let found = [
        (
            Disk { rotor: &rings, lines: &whole }.means(&tip_helices(&flat, &constant, HELIX_CORE)),
            1.0,
        ),
        (lifting(&flat, &constant), 1.0),
        (lifting(&deflected, &constant), 1.0),
        (lifting(&deflected, &mean), carried(&mean)),
        (lifting(&deflected, &peaks), carried(&peaks)),
        (of_wake(&deflected, circulation)?, 1.0),
        (of_wake(wake, circulation)?, 1.0),
    ];
    let over = |m: Means| Means { at_blades: m.at_blades / glauert, in_time: m.in_time / glauert };
    Ok(found.map(|(means, carried)| Step { means: over(means), carried }).into())
}

/// Parts of a wake by age.
const PARTS: [&str; 5] = [
    "bound vortices, chords",
    "trailers up to 30 deg",
    "30 to 120 deg",
    "120 deg to a revolution",
    "rolled-up vortices behind",
];

/// What one blade at an azimuth and its wake are made of.
fn parts_of(
    wake: &FreeWake,
    circulation: &CirculationMap,
    at: usize,
) -> Result<Vec<SegmentSet>, Failure> {
    let mut parts = vec![SegmentSet::new(wake.settings().core.model); PARTS.len()];
    let mut push = |part: usize, ends: [Vec3; 2], state: SegmentState| {
        parts[part].push(ends[0], ends[1], state.circulation, state.core_radius);
    };
    let (row, core) = (circulation.row(at), wake.settings().core.near_radius);
    let line = wake.lines().at(at);
    for (ends, &circulation) in line.windows(2).zip(row) {
        push(0, [ends[0], ends[1]], SegmentState { circulation, core_radius: core });
    }
    let step = wake.settings().step_rad();
    let of_age = |k: usize| match ((k as f64 + 0.5) * step).to_degrees() {
        a if a < 30.0 => 1,
        a if a < 120.0 => 2,
        _ => 3,
    };
    let states = wake.trailer_states(circulation)?;
    for (n, (filament, states)) in wake.near_wake().iter().zip(&states).enumerate() {
        let of = |s: Option<usize>| s.and_then(|s| row.get(s)).copied().unwrap_or(0.0);
        let chord = SegmentState {
            circulation: of(n.checked_sub(1)) - of(Some(n)),
            core_radius: states[at][0].core_radius,
        };
        push(0, [line[n], wake.lines().edge_at(at)[n]], chord);
        for (k, (ends, state)) in filament.points[at].windows(2).zip(&states[at]).enumerate() {
            push(of_age(k), [ends[0], ends[1]], *state);
        }
    }
    let states = wake.vortex_states(circulation)?;
    for (filament, states) in wake.vortices().iter().zip(&states) {
        let segments = filament.points[at].windows(2).zip(&states[at]);
        for (ends, state) in segments.skip(filament.first_age) {
            push(4, [ends[0], ends[1]], *state);
        }
    }
    Ok(parts)
}

/// Share of each part at the blades, of the own blade and of the others, and over time; Glauert's inflow is 1.
fn shares(trimmed: &WakeTrim) -> Result<Vec<[f64; 3]>, Failure> {
    let (wake, circulation) = (&trimmed.wake, &trimmed.moving);
    let (blades, azimuths) = (wake.rotor().blades(), wake.settings().azimuths);
    let flight = wake.flight();
    let ct = circulation.thrust_coefficient(wake.rotor(), flight.advance_ratio);
    let glauert = momentum_inflow(flight, ct)?;
    let disk = Disk { rotor: wake.rotor(), lines: wake.lines() };
    let all: Vec<Vec<SegmentSet>> =
        (0..azimuths).map(|at| parts_of(wake, circulation, at)).collect::<Result<_, _>>()?;
    let spacing = azimuths / blades;
    let summed = |points: &[Vec3], sets: &mut dyn Iterator<Item = &SegmentSet>, share: f64| {
        let mut sum = vec![[0.0; 3]; points.len()];
        for set in sets {
            for (s, v) in sum.iter_mut().zip(induced_velocities(points, set)) {
                for (s, v) in s.iter_mut().zip(v) {
                    *s += share * v;
                }
            }
        }
        sum
    };
    let of_part = |part: usize| {
        let own = disk.mean(|i| summed(&disk.of_blade(i), &mut [&all[i][part]].into_iter(), 1.0));
        let others = disk.mean(|i| {
            let mut sets = (1..blades).map(|b| &all[(i + b * spacing) % azimuths][part]);
            summed(&disk.of_blade(i), &mut sets, 1.0)
        });
        let in_time = disk.mean(|i| {
            let mut sets = all.iter().map(|parts| &parts[part]);
            summed(&disk.passed(i), &mut sets, blades as f64 / azimuths as f64)
        });
        [own, others, in_time].map(|v| v / glauert)
    };
    Ok((0..PARTS.len()).map(of_part).collect())
}

/// Borders of the bands of span, R: of panels of 0.04 R.
const BANDS: [f64; 5] = [0.2, 0.6, 0.88, 0.96, 1.0];

/// Share of the area, and mean inflow at the blades and over time over Glauert's, of every band of span.
fn bands(trimmed: &WakeTrim) -> Result<Vec<[f64; 3]>, Failure> {
    let (wake, circulation) = (&trimmed.wake, &trimmed.moving);
    let rotor = wake.rotor();
    let ct = circulation.thrust_coefficient(rotor, wake.flight().advance_ratio);
    let glauert = momentum_inflow(wake.flight(), ct)?;
    let disk = Disk { rotor, lines: wake.lines() };
    let map = wake.line_induction(circulation)?.inflow(circulation)?;
    let at_blades = disk.by_station(|i| map.row(i).iter().map(|v| [0.0, 0.0, -v]).collect());
    let points: Vec<Vec3> = (0..map.azimuths()).flat_map(|i| disk.passed(i)).collect();
    let velocities = wake.mean_velocity(&points, circulation)?;
    let panels = rotor.panels();
    let in_time = disk.by_station(|i| velocities[i * panels..(i + 1) * panels].to_vec());
    let area = disk.by_station(|_| vec![[0.0, 0.0, -1.0]; panels]);
    let stations = rotor.stations();
    let of_band = |ends: &[f64]| {
        let of = |values: &[f64]| -> f64 {
            let within =
                stations.iter().zip(values).filter(|(r, _)| (ends[0]..ends[1]).contains(*r));
            within.map(|(_, v)| v).sum()
        };
        let share = of(&area);
        [share, of(&at_blades) / share / glauert, of(&in_time) / share / glauert]
    };
    Ok(BANDS.windows(2).map(of_band).collect())
}

/// The undistorted wake of the trim shared by other numbers of blades: the same circulation in all.
fn shared_by(trimmed: &WakeTrim, blades: usize) -> Result<Means, Failure> {
    let (wake, circulation) = (&trimmed.wake, &trimmed.moving);
    let flight = *wake.flight();
    let rotor = wake.rotor();
    let glauert =
        momentum_inflow(&flight, circulation.thrust_coefficient(rotor, flight.advance_ratio))?;
    let settings =
        FreeWakeSettings { near_wake_motion: NearWakeMotion::Convected, ..wake.settings().clone() };
    let many = WakeRotor::new(blades, rotor.nodes().to_vec())?;
    let share = rotor.blades() as f64 / blades as f64;
    let values = circulation.values().iter().map(|g| share * g).collect();
    let circulation = CirculationMap::new(rotor.panels(), values)?;
    let wake = FreeWake::undistorted(many, settings, flight, glauert, wake.lines().clone())?;
    let means = of_wake(&wake, &circulation)?;
    Ok(Means { at_blades: means.at_blades / glauert, in_time: means.in_time / glauert })
}

/// Undistorted tip helices of constant circulation at an advance ratio, felt over the whole disk with a core.
fn thin(advance_ratio: f64, core: f64) -> Result<Means, Failure> {
    const AZIMUTHS: usize = 144;
    const THRUST: f64 = 0.0049;
    let flight = FlightState { advance_ratio, shaft_tilt_rad: 5.0_f64.to_radians() };
    let glauert = momentum_inflow(&flight, THRUST)?;
    let rotor = WakeRotor::uniform(4, 0.0, 4 * RINGS)?;
    let lines = BladeLines::flat(&rotor, AZIMUTHS);
    let settings =
        FreeWakeSettings { azimuths: AZIMUTHS, turns: 16, ..FreeWakeSettings::default() };
    let wake = FreeWake::undistorted(rotor.clone(), settings, flight, glauert, lines.clone())?;
    let strength = vec![TAU * THRUST / 4.0; AZIMUTHS];
    let m = Disk { rotor: &rotor, lines: &lines }.means(&tip_helices(&wake, &strength, core));
    Ok(Means { at_blades: m.at_blades / glauert, in_time: m.in_time / glauert })
}

/// Advance ratios of the table of steps.
const ADVANCE_RATIOS: [f64; 5] = [0.15, 0.2, 0.25, 0.3, 0.35];

/// All tables, row by row to `say`.
///
/// # Errors
/// Those of the trims and the wakes.
pub fn tables(say: impl Fn(&str)) -> Result<(), Failure> {
    let trims: Vec<WakeTrim> = ADVANCE_RATIOS
        .iter()
        // without copies of the last turn every segment of the wake is known here
        .map(|&mu| paper_trimmed(mu, |s, _| s.wake.far_turns = 0))
        .collect::<Result<_, _>>()?;
    let steps: Vec<Vec<Step>> = trims.iter().map(steps).collect::<Result<_, _>>()?;
    say("| at the blades; over time (by the thrust carried) |");
    for mu in ADVANCE_RATIOS {
        say(&format!(" mu {mu:.2} |"));
    }
    say(&format!("\n|---|{}\n", "---|".repeat(ADVANCE_RATIOS.len())));
    for (k, name) in STEPS.iter().enumerate() {
        say(&format!("| {name} |"));
        for of_speed in &steps {
            let Step { means, carried } = &of_speed[k];
            say(&format!(" {:.3}; {:.3} ({carried:.3}) |", means.at_blades, means.in_time));
        }
        say("\n");
    }
    let trimmed = &trims[3];
    say(
        "\n| part at mu 0.30 | own blade | other blades | at the blades | over time |\n|---|---|---|---|---|\n",
    );
    let shares = shares(trimmed)?;
    let line = |name: &str, [own, others, in_time]: [f64; 3]| {
        format!("| {name} | {own:.3} | {others:.3} | {:.3} | {in_time:.3} |\n", own + others)
    };
    for (name, share) in PARTS.iter().zip(&shares) {
        say(&line(name, *share));
    }
    let sum = shares.iter().fold([0.0; 3], |s, p| std::array::from_fn(|k| s[k] + p[k]));
    say(&line("sum", sum));
    let induction = trimmed.wake.line_induction(&trimmed.moving)?.inflow(&trimmed.moving)?;
    let flight = trimmed.wake.flight();
    let ct = trimmed.moving.thrust_coefficient(trimmed.wake.rotor(), flight.advance_ratio);
    let map = induction.mean() / momentum_inflow(flight, ct)?;
    say(&format!("| the wake's own map | | | {map:.3} | |\n"));
    say(
        "\n| span at mu 0.30, R | share of the area | at the blades | over time |\n|---|---|---|---|\n",
    );
    for (ends, [area, at_blades, in_time]) in BANDS.windows(2).zip(bands(trimmed)?) {
        say(&format!(
            "| {} to {} | {area:.3} | {at_blades:.3} | {in_time:.3} |\n",
            ends[0], ends[1]
        ));
    }
    say(
        "\n| blades that share the circulation, undistorted, mu 0.30 | at the blades | over time | difference times the blades |\n|---|---|---|---|\n",
    );
    for blades in [2, 3, 4, 6, 9, 12] {
        let m = shared_by(trimmed, blades)?;
        let excess = (m.at_blades - m.in_time) * blades as f64;
        say(&format!("| {blades} | {:.3} | {:.3} | {excess:.3} |\n", m.at_blades, m.in_time));
    }
    say(
        "\n| undistorted tip helices, 16 turns, steps of 2.5 deg, 160 rings | at the blades | over time |\n|---|---|---|\n",
    );
    for (mu, core) in
        [(0.1, 0.02), (0.1, 0.005), (0.1, 0.001), (0.3, 0.02), (0.3, 0.005), (0.3, 0.001)]
    {
        let m = thin(mu, core)?;
        say(&format!("| mu {mu}, core {core} R | {:.3} | {:.3} |\n", m.at_blades, m.in_time));
    }
    Ok(())
}
