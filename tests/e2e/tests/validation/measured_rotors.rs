//! The rotor against measured rotors: HART II and `HeliNOVI`.

use std::sync::LazyLock;

use nalgebra::{DMatrix, DVector};
use rotor_base::{Harmonic, HarmonicSeries, harmonic_waves, uniform_azimuths_rad, wrap_degrees};
use rotor_response::{SectionAirload, StationAirloads, TipMotion};
use rotor_study::{ModesQuestion, TrimmedRotor, rotating_modes};
use rotor_wake::FreeWake;
use sim_driver::case::{Case, FreeWakeValues, InflowChoice, shipped_case};
use validation::{Check, Failure, Table, row, shared, too_few};

const HART: &str = "measured: HART II, fixtures/measured/hart_ii";
const HELINOVI: &str = "measured: HeliNOVI, fixtures/measured/helinovi";

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-MEAS-01",
        "HART II blade tuned to its six frequencies: largest error; nothing else is tuned",
        "%",
    )
    .against("remembered documentation, fixtures/measured/hart_ii/SOURCE.md")
    .at_most(1.5, frequencies),
    row("V-MEAS-02", "HART II, baseline: C_n M^2 at 0.87 R, 1 to 6/rev, correlation", "-")
        .against(HART)
        .at_least(0.80, || Ok(airload(&CN_M2, baseline()?, "BL", 1)?.correlation)),
    row("V-MEAS-03", "the same: rms distance", "-")
        .against(HART)
        .at_most(0.010, || Ok(airload(&CN_M2, baseline()?, "BL", 1)?.rms)),
    row("V-MEAS-04", "the same, near wake of 360 in place of 180 deg: correlation", "-")
        .against(HART)
        .near(0.654, 0.03, || descent(360.0, 36)),
    row("V-MEAS-13", "the same, near wake of 90 deg: correlation", "-").against(HART).near(
        0.79,
        0.03,
        || descent(90.0, 36),
    ),
    row("V-MEAS-05", "the same, near wake of 30 deg: correlation", "-").against(HART).near(
        0.44,
        0.05,
        || descent(30.0, 36),
    ),
    row(
        "V-MEAS-14",
        "the same, near wake of 180 deg, steps of 5 in place of 10 deg: correlation",
        "-",
    )
    .against(HART)
    .near(0.73, 0.03, || descent(180.0, 72)),
    row("V-MEAS-06", "the same: tip deflection, rms distance; shown, the bar is 0.35", "% R")
        .against(HART)
        .near(0.41, 0.03, || tip(&baseline()?.tip, TIP_FLAP, |at| 100.0 * at.flap)),
    row(
        "V-MEAS-07",
        "the same: elastic twist of the tip, rms distance; shown, the bar is 0.35",
        "deg",
    )
    .against(HART)
    .near(0.50, 0.03, || tip(&baseline()?.tip, TIP_TWIST, |at| at.twist_rad.to_degrees())),
    row(
        "V-MEAS-08",
        "the same: centres of tip vortices, vertical rms distance; shown, the bar is 3.0",
        "% R",
    )
    .against(HART)
    .near(3.3, 0.3, || vertical_distance(baseline()?)),
    row("V-MEAS-09", "HeliNOVI, level flight: C_N at 0.87 R, 1 to 6/rev, correlation", "-")
        .against(HELINOVI)
        .at_least(0.85, || Ok(airload(&CN, level()?, "ID2", 1)?.correlation)),
    row("V-MEAS-10", "the same, 2 to 6/rev; shown", "-")
        .against(HELINOVI)
        .near(0.42, 0.05, || Ok(airload(&CN, level()?, "ID2", 2)?.correlation)),
    row("V-MEAS-11", "HeliNOVI, climb: C_N at 0.87 R, 1 to 6/rev, correlation", "-")
        .against(HELINOVI)
        .at_least(0.85, || Ok(airload(&CN, climb()?, "ID1", 1)?.correlation)),
    row("V-MEAS-12", "the same, 2 to 6/rev; shown", "-").against(HELINOVI).near(
        0.565,
        0.05,
        || Ok(airload(&CN, climb()?, "ID1", 2)?.correlation),
    ),
    row("V-MEAS-15", "level flight, 2 to 6/rev, near wake of 360 in place of 180 deg; shown", "-")
        .against(HELINOVI)
        .near(0.32, 0.05, || {
            let flown = flown("helinovi_level.ron", |case| in_wake(case, 360.0, 36))?;
            Ok(airload(&CN, &flown, "ID2", 2)?.correlation)
        }),
    row("V-MEAS-16", "climb, 2 to 6/rev, near wake of 360 in place of 180 deg; shown", "-")
        .against(HELINOVI)
        .near(0.765, 0.05, || {
            let flown = flown("helinovi_climb.ron", |case| in_wake(case, 360.0, 36))?;
            Ok(airload(&CN, &flown, "ID1", 2)?.correlation)
        }),
    row(
        "V-MEAS-17",
        "HART II, minimum noise less baseline: C_n M^2 at 0.87 R at 3/rev, amplitude off by",
        "%",
    )
    .against(HART)
    .at_most(25.0, || Ok(airload_change(minimum_noise()?)?.amplitude_percent)),
    row("V-MEAS-18", "the same: phase off by", "deg")
        .against(HART)
        .at_most(20.0, || Ok(airload_change(minimum_noise()?)?.phase_deg)),
    row("V-MEAS-19", "the same, phase of the root pitch read the other way: off by; shown", "deg")
        .against(HART)
        .near(120.0, 30.0, || Ok(airload_change(&read_the_other_way()?)?.phase_deg)),
    row("V-MEAS-20", "the same, elastic twist of the tip at 3/rev: amplitude off by", "%")
        .against(HART)
        .at_most(25.0, || Ok(twist_change(minimum_noise()?)?.amplitude_percent)),
    row("V-MEAS-21", "the same: phase off by", "deg")
        .against(HART)
        .at_most(20.0, || Ok(twist_change(minimum_noise()?)?.phase_deg)),
];

/// Harmonics that are compared.
const MOST: usize = 6;
const STATION: f64 = 0.87;
const AZIMUTHS: usize = 360;
const TIP_FLAP: [&str; 2] = ["tip_flap.csv", "tip_deflection_percent_r"];
const TIP_TWIST: [&str; 2] = ["tip_elastic_twist.csv", "elastic_twist_deg"];

/// A rotor trimmed in its free wake.
struct Flown {
    station: StationAirloads,
    tip: Vec<TipMotion>,
    radius_m: f64,
    wake: FreeWake,
}

fn flown(case: &str, change: impl Fn(&mut Case)) -> Result<Flown, Failure> {
    let mut case = shipped_case(case)?.case;
    change(&mut case);
    let rotor = TrimmedRotor::new(&case, None)?;
    let (stations, tip) = rotor.airloads(&[STATION], case.tip_mach(), AZIMUTHS)?;
    let station = stations.into_iter().next().ok_or_else(|| too_few("stations", 0, 1))?;
    let wake = rotor.wake().map(|trim| trim.wake.clone());
    let wake = wake.ok_or_else(|| too_few("wakes", 0, 1))?;
    Ok(Flown { station, tip, radius_m: case.rotor.radius_m, wake })
}

/// Gives a case a free wake of another near wake and number of steps, and as many time points as these need.
fn in_wake(case: &mut Case, near_wake_deg: f64, steps: usize) {
    let wake = FreeWakeValues {
        near_wake_deg: Some(near_wake_deg),
        azimuths: Some(steps),
        ..FreeWakeValues::default()
    };
    case.inflow.model = InflowChoice::FreeWake(wake);
    if steps > 48 {
        case.response.time_gauss_points = 12;
    }
}

/// Correlation of `C_n M^2` in descent with another wake.
fn descent(near_wake_deg: f64, steps: usize) -> Result<f64, Failure> {
    let flown = flown("hart_ii_bl.ron", |case| in_wake(case, near_wake_deg, steps))?;
    Ok(airload(&CN_M2, &flown, "BL", 1)?.correlation)
}

static BASELINE: LazyLock<Result<Flown, Failure>> =
    LazyLock::new(|| flown("hart_ii_bl.ron", |_| ()));
static MINIMUM_NOISE: LazyLock<Result<Flown, Failure>> =
    LazyLock::new(|| flown("hart_ii_mn.ron", |_| ()));
static LEVEL: LazyLock<Result<Flown, Failure>> =
    LazyLock::new(|| flown("helinovi_level.ron", |_| ()));
static CLIMB: LazyLock<Result<Flown, Failure>> =
    LazyLock::new(|| flown("helinovi_climb.ron", |_| ()));

fn baseline() -> Result<&'static Flown, Failure> {
    shared(&BASELINE)
}

fn minimum_noise() -> Result<&'static Flown, Failure> {
    shared(&MINIMUM_NOISE)
}

/// The minimum-noise case with `A cos(3 psi + phase)` in place of `A cos(3 psi - phase)`.
fn read_the_other_way() -> Result<Flown, Failure> {
    flown("hart_ii_mn.ron", |case| {
        for harmonic in &mut case.rotor.root_pitch {
            harmonic.phase_deg = -harmonic.phase_deg;
        }
    })
}

fn level() -> Result<&'static Flown, Failure> {
    shared(&LEVEL)
}

fn climb() -> Result<&'static Flown, Failure> {
    shared(&CLIMB)
}

/// Frequencies per rev of the blade: kind, number from 1, value.
const FREQUENCIES: [(&str, usize, f64); 6] = [
    ("flap", 1, 1.125),
    ("flap", 2, 2.835),
    ("flap", 3, 5.168),
    ("lag", 1, 0.782),
    ("lag", 2, 4.592),
    ("torsion", 1, 3.845),
];

fn frequencies() -> Result<f64, Failure> {
    let case = shipped_case("hart_ii_bl.ron")?.case;
    let found = rotating_modes(&case, &ModesQuestion::default())?.modes;
    let mut worst = 0.0_f64;
    for (kind, number, wanted) in FREQUENCIES {
        let mode = found.iter().filter(|mode| mode.kind == kind).nth(number - 1);
        let per_rev = mode.and_then(|mode| mode.per_rev);
        let per_rev = per_rev.ok_or_else(|| too_few("modes", found.len(), number))?;
        worst = worst.max(100.0 * (per_rev / wanted - 1.0).abs());
    }
    Ok(worst)
}

/// How two curves agree, their means removed.
struct Agreement {
    correlation: f64,
    rms: f64,
}

/// Of the harmonics from `first` to [`MOST`], by azimuth.
fn agreement(own: &HarmonicSeries, measured: &HarmonicSeries, first: usize) -> Agreement {
    let part = |series: &HarmonicSeries, psi: f64| -> f64 {
        (first..=MOST)
            .map(|n| {
                let Harmonic { cosine, sine } = series.harmonic(n);
                let angle = n as f64 * psi;
                cosine * angle.cos() + sine * angle.sin()
            })
            .sum()
    };
    let [mut xx, mut yy, mut xy, mut square] = [0.0; 4];
    for psi in uniform_azimuths_rad(AZIMUTHS) {
        let (x, y) = (part(own, psi), part(measured, psi));
        xx += x * x;
        yy += y * y;
        xy += x * y;
        square += (x - y) * (x - y);
    }
    Agreement { correlation: xy / (xx * yy).sqrt(), rms: (square / AZIMUTHS as f64).sqrt() }
}

fn measured(file: &str, case: &str, columns: [&str; 2]) -> Result<HarmonicSeries, Failure> {
    let table = Table::read(file)?;
    let mut series = HarmonicSeries::zero(MOST);
    for n in 1..=MOST {
        let row = table.row(["case", "per_rev"], [case, &n.to_string()])?;
        let [cosine, sine] = [row.number(columns[0])?, row.number(columns[1])?];
        series.set_harmonic(n, Harmonic { cosine, sine });
    }
    Ok(series)
}

/// A measured airload at 0.87 R, and the computed one beside it.
struct Airload {
    file: &'static str,
    columns: [&'static str; 2],
    value: fn(&SectionAirload) -> f64,
}

const CN_M2: Airload = Airload {
    file: "../measured/hart_ii/airloads_087r_harmonics.csv",
    columns: ["cn_m2_cos", "cn_m2_sin"],
    value: |at| at.normal_m2,
};
const CN: Airload = Airload {
    file: "../measured/helinovi/cn_087r_harmonics.csv",
    columns: ["cn_cos", "cn_sin"],
    value: |at| at.normal,
};

/// Agreement of an airload with a measured case from a harmonic on.
fn airload(of: &Airload, flown: &Flown, case: &str, first: usize) -> Result<Agreement, Failure> {
    let values: Vec<f64> = flown.station.loads.iter().map(of.value).collect();
    let own = HarmonicSeries::from_uniform_samples(&values, MOST)?;
    Ok(agreement(&own, &measured(of.file, case, of.columns)?, first))
}

/// RMS distance of a motion of the tip from that measured in BL.
fn tip(
    own: &[TipMotion],
    [file, column]: [&str; 2],
    value: fn(&TipMotion) -> f64,
) -> Result<f64, Failure> {
    let values: Vec<f64> = own.iter().map(value).collect();
    let own = HarmonicSeries::from_uniform_samples(&values, 20)?;
    let table = Table::read(&format!("../measured/hart_ii/{file}"))?;
    let (mut square, mut count) = (0.0, 0);
    for row in table.rows() {
        if row.text("case")? == "BL" {
            let psi = row.number("azimuth_deg")?.to_radians();
            square += (own.value(psi) - row.number(column)?).powi(2);
            count += 1;
        }
    }
    if count == 0 { Err(too_few(column, count, 1)) } else { Ok((square / count as f64).sqrt()) }
}

/// Harmonic of the root pitch of the minimum-noise case.
const PITCHED: usize = 3;

/// How far a computed change of a harmonic is from the measured one.
#[derive(Debug)]
struct Apart {
    /// Of the amplitude, without sign.
    amplitude_percent: f64,
    /// Of the phase, without sign.
    phase_deg: f64,
}

/// Of the changes from the second harmonic of a pair to the first.
fn apart(own: [Harmonic; 2], measured: [Harmonic; 2]) -> Apart {
    let change = |[to, from]: [Harmonic; 2]| Harmonic {
        cosine: to.cosine - from.cosine,
        sine: to.sine - from.sine,
    };
    let (own, measured) = (change(own), change(measured));
    Apart {
        amplitude_percent: 100.0 * (own.amplitude() / measured.amplitude() - 1.0).abs(),
        phase_deg: wrap_degrees(own.phase_deg() - measured.phase_deg()).abs(),
    }
}

/// Of the change of `C_n M^2` from baseline to minimum noise.
fn airload_change(pitched: &Flown) -> Result<Apart, Failure> {
    let own = |flown: &Flown| -> Result<Harmonic, Failure> {
        let values: Vec<f64> = flown.station.loads.iter().map(CN_M2.value).collect();
        Ok(HarmonicSeries::from_uniform_samples(&values, MOST)?.harmonic(PITCHED))
    };
    let of = |case| Ok::<_, Failure>(measured(CN_M2.file, case, CN_M2.columns)?.harmonic(PITCHED));
    Ok(apart([own(pitched)?, own(baseline()?)?], [of("MN")?, of("BL")?]))
}

/// Of the change of the elastic twist of the tip from baseline to minimum noise.
fn twist_change(pitched: &Flown) -> Result<Apart, Failure> {
    let own = |flown: &Flown| -> Result<Harmonic, Failure> {
        let values: Vec<f64> = flown.tip.iter().map(|at| at.twist_rad.to_degrees()).collect();
        Ok(HarmonicSeries::from_uniform_samples(&values, MOST)?.harmonic(PITCHED))
    };
    let of = |case| measured_tip(TIP_TWIST, case);
    Ok(apart([own(pitched)?, own(baseline()?)?], [of("MN")?, of("BL")?]))
}

/// Harmonic [`PITCHED`] of a measured motion of the tip, by least squares over mean and 1 to 6/rev.
fn measured_tip([file, column]: [&str; 2], case: &str) -> Result<Harmonic, Failure> {
    let table = Table::read(&format!("../measured/hart_ii/{file}"))?;
    let (mut waves, mut values) = (Vec::new(), Vec::new());
    for row in table.rows() {
        if row.text("case")? == case {
            waves.extend(harmonic_waves(row.number("azimuth_deg")?.to_radians(), MOST));
            values.push(row.number(column)?);
        }
    }
    let waves = DMatrix::from_row_iterator(values.len(), 1 + 2 * MOST, waves);
    let found = waves.svd(true, true).solve(&DVector::from_vec(values.clone()), 1e-9);
    let found = found.map_err(|_| too_few(column, values.len(), 1 + 2 * MOST))?;
    Ok(Harmonic { cosine: found[2 * PITCHED - 1], sine: found[2 * PITCHED] })
}

/// A measured vortex farther along the flight path than this from any computed one, R, is that of another turn.
const SAME_VORTEX: f64 = 0.12;

/// Vertical rms distance of measured vortex centres from where the tip vortices of the wake cross the same vertical plane
/// along the flight, percent of R.
fn vertical_distance(flown: &Flown) -> Result<f64, Failure> {
    let settings = flown.wake.settings();
    let step = settings.step_rad().to_degrees();
    let table = Table::read("../measured/hart_ii/vortex_centres.csv")?;
    let (mut square, mut count) = (0.0, 0);
    for row in table.rows() {
        if row.text("case")? != "BL" {
            continue;
        }
        let [x, y, z] = [row.number("x_m")?, row.number("y_m")?, row.number("z_m")?]
            .map(|c| c / flown.radius_m);
        let azimuth = row.number("azimuth_deg")?;
        let mut nearest: Option<[f64; 2]> = None;
        // those of all blades with the first at that azimuth
        let seen = (0..settings.azimuths).find(|i| (*i as f64 * step - azimuth).abs() < 0.5 * step);
        for crossing in seen.iter().flat_map(|i| flown.wake.tip_vortex_crossings(*i, y)) {
            let [along, _, up] = crossing.point;
            if nearest.is_none_or(|[best, _]| (along - x).abs() < (best - x).abs()) {
                nearest = Some([along, up]);
            }
        }
        if let Some([_, up]) = nearest.filter(|[along, _]| (along - x).abs() <= SAME_VORTEX) {
            square += (up - z).powi(2);
            count += 1;
        }
    }
    if count < 40 {
        return Err(too_few("vortex centres", count, 40));
    }
    Ok(100.0 * (square / count as f64).sqrt())
}
