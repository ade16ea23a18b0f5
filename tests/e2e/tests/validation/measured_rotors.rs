//! The rotor against measured rotors: HART II and `HeliNOVI`.

use std::sync::LazyLock;

use rotor_base::{Harmonic, HarmonicSeries, wrap_degrees};
use rotor_study::{
    CURVE_AZIMUTHS, CurveComparison, ModesQuestion, Quantity, TrimmedRotor, VortexComparison,
    compare_curves, compare_vortices, computed_curves, rotating_modes,
};
use sim_driver::case::{
    BodyValues, Case, FreeWakeValues, InflowChoice, LoadedCase, TrimValues, load_case,
};
use sim_driver::results::MeasuredPart;
use validation::{Check, Failure, root, row, shared, too_few};

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
        .at_least(0.80, || Ok(baseline()?.curve(Quantity::NormalM2)?.from_1.correlation)),
    row("V-MEAS-03", "the same: rms distance", "-")
        .against(HART)
        .at_most(0.010, || Ok(baseline()?.curve(Quantity::NormalM2)?.from_1.rms)),
    row("V-MEAS-04", "the same, near wake of 360 in place of 180 deg: correlation", "-")
        .against(HART)
        .near(0.767, 0.03, || descent(360.0))
        .long(),
    row("V-MEAS-13", "the same, near wake of 90 deg: correlation", "-")
        .against(HART)
        .near(0.746, 0.03, || descent(90.0))
        .long(),
    row("V-MEAS-05", "the same, near wake of 30 deg: correlation", "-")
        .against(HART)
        .near(0.431, 0.05, || descent(30.0))
        .long(),
    row(
        "V-MEAS-14",
        "the same, sections every 10 deg as the wake, 8 time elements: correlation",
        "-",
    )
    .against(HART)
    .near(0.876, 0.03, || Ok(coarse()?.curve(Quantity::NormalM2)?.from_1.correlation))
    .long(),
    row("V-MEAS-06", "the same: tip deflection, rms distance", "% R")
        .against(HART)
        .at_most(0.35, || baseline()?.tip(Quantity::TipFlap)),
    row(
        "V-MEAS-07",
        "the same: elastic twist of the tip, rms distance; shown, the bar is 0.35",
        "deg",
    )
    .against(HART)
    .near(0.48, 0.03, || baseline()?.tip(Quantity::TipTwist)),
    row("V-MEAS-08", "the same: centres of tip vortices, vertical rms distance", "% R")
        .against(HART)
        .at_most(3.0, || vertical_distance(baseline()?)),
    row("V-MEAS-09", "HeliNOVI, level flight: C_N at 0.87 R, 1 to 6/rev, correlation", "-")
        .against(HELINOVI)
        .at_least(0.85, || Ok(level()?.curve(Quantity::Normal)?.from_1.correlation)),
    row("V-MEAS-10", "the same, 2 to 6/rev; shown", "-").against(HELINOVI).near(
        0.481,
        0.05,
        || Ok(level()?.curve(Quantity::Normal)?.from_2.correlation),
    ),
    row("V-MEAS-11", "HeliNOVI, climb: C_N at 0.87 R, 1 to 6/rev, correlation", "-")
        .against(HELINOVI)
        .at_least(0.85, || Ok(climb()?.curve(Quantity::Normal)?.from_1.correlation)),
    row("V-MEAS-12", "the same, 2 to 6/rev; shown", "-").against(HELINOVI).near(
        0.519,
        0.05,
        || Ok(climb()?.curve(Quantity::Normal)?.from_2.correlation),
    ),
    row("V-MEAS-15", "level flight, 2 to 6/rev, near wake of 360 in place of 180 deg; shown", "-")
        .against(HELINOVI)
        .near(0.42, 0.05, || {
            let flown = flown("helinovi_level.ron", |case| in_wake(case, 360.0))?;
            Ok(flown.curve(Quantity::Normal)?.from_2.correlation)
        })
        .long(),
    row("V-MEAS-16", "climb, 2 to 6/rev, near wake of 360 in place of 180 deg; shown", "-")
        .against(HELINOVI)
        .near(0.745, 0.05, || {
            let flown = flown("helinovi_climb.ron", |case| in_wake(case, 360.0))?;
            Ok(flown.curve(Quantity::Normal)?.from_2.correlation)
        })
        .long(),
    row(
        "V-MEAS-17",
        "HART II, minimum noise less baseline: C_n M^2 at 0.87 R at 3/rev, amplitude off by",
        "%",
    )
    .against(HART)
    .at_most(25.0, || Ok(change(minimum_noise()?, Quantity::NormalM2)?.amplitude_percent)),
    row("V-MEAS-18", "the same: phase off by", "deg")
        .against(HART)
        .at_most(20.0, || Ok(change(minimum_noise()?, Quantity::NormalM2)?.phase_deg)),
    row("V-MEAS-19", "the same, phase of the root pitch read the other way: off by; shown", "deg")
        .against(HART)
        .near(120.0, 30.0, || Ok(change(&read_the_other_way()?, Quantity::NormalM2)?.phase_deg))
        .long(),
    row("V-MEAS-20", "the same, elastic twist of the tip at 3/rev: amplitude off by", "%")
        .against(HART)
        .at_most(25.0, || Ok(change(minimum_noise()?, Quantity::TipTwist)?.amplitude_percent)),
    row("V-MEAS-21", "the same: phase off by", "deg")
        .against(HART)
        .at_most(20.0, || Ok(change(minimum_noise()?, Quantity::TipTwist)?.phase_deg)),
    row("V-MEAS-22", "HART II, baseline, without the body below the hub: correlation; shown", "-")
        .against(HART)
        .near(0.775, 0.02, || Ok(shared(&BODILESS)?.curve(Quantity::NormalM2)?.from_1.correlation)),
    row("V-MEAS-23", "the same: centres of tip vortices, vertical rms distance; shown", "% R")
        .against(HART)
        .near(3.35, 0.15, || vertical_distance(shared(&BODILESS)?)),
    row(
        "V-MEAS-24",
        "HeliNOVI, level flight, without the body: 2 to 6/rev, correlation; shown",
        "-",
    )
    .against(HELINOVI)
    .near(0.426, 0.03, || {
        Ok(without_body("helinovi_level.ron")?.curve(Quantity::Normal)?.from_2.correlation)
    }),
    row("V-MEAS-25", "climb, without the body: 2 to 6/rev, correlation; shown", "-")
        .against(HELINOVI)
        .near(0.504, 0.008, || {
            Ok(without_body("helinovi_climb.ron")?.curve(Quantity::Normal)?.from_2.correlation)
        }),
    row("V-MEAS-26", "HART II, baseline, roll moment as given: tip deflection, rms; shown", "% R")
        .against(HART)
        .near(0.42, 0.03, || {
            flown("hart_ii_bl.ron", |case| {
                if let TrimValues::WindTunnel(own) = &mut case.trim {
                    own.hub_mx_n_m = -own.hub_mx_n_m;
                }
            })?
            .tip(Quantity::TipFlap)
        })
        .long(),
];

/// A rotor trimmed in its free wake, beside what was measured of it.
struct Flown {
    curves: Vec<CurveComparison>,
    vortices: VortexComparison,
}

/// The shipped case with what its measured files hold.
fn shipped(case: &str) -> Result<LoadedCase, Failure> {
    Ok(load_case(&root().join("fixtures/cases").join(case))?)
}

fn flown(case: &str, change: impl Fn(&mut Case)) -> Result<Flown, Failure> {
    let LoadedCase { mut case, measured, .. } = shipped(case)?;
    change(&mut case);
    let rotor = TrimmedRotor::new(&case, None)?;
    let stations: Vec<f64> = case.measured.airloads.iter().map(|of| of.station_r).collect();
    let (airloads, tip) = rotor.airloads(&stations, case.tip_mach(), CURVE_AZIMUTHS)?;
    let part = MeasuredPart::of(&measured, &computed_curves(&airloads, &tip), None);
    let curves = part.map(|part| part.curves).unwrap_or_default();
    let wake = &rotor.wake().ok_or_else(|| too_few("wakes", 0, 1))?.wake;
    Ok(Flown {
        curves: curves.iter().map(|line| compare_curves(&line.curve, &line.computed)).collect(),
        vortices: compare_vortices(&measured.vortex_centres, wake),
    })
}

impl Flown {
    /// A measured quantity beside the computed one.
    fn curve(&self, quantity: Quantity) -> Result<&CurveComparison, Failure> {
        let found = self.curves.iter().find(|curve| curve.quantity == quantity);
        found.ok_or_else(|| too_few(quantity.name(), 0, 1))
    }

    /// Rms distance of a motion of the tip.
    fn tip(&self, quantity: Quantity) -> Result<f64, Failure> {
        self.curve(quantity)?.distance.ok_or_else(|| too_few(quantity.name(), 0, 1))
    }
}

/// Changes the free wake of a case.
fn change_wake(case: &mut Case, change: impl Fn(&mut FreeWakeValues)) {
    if let InflowChoice::FreeWake(wake) = &mut case.inflow.model {
        change(wake);
    }
}

/// A flight without a body below the hub.
fn without_body(case: &str) -> Result<Flown, Failure> {
    flown(case, |case| change_wake(case, |wake| wake.body = BodyValues::default()))
}

/// Gives a case a free wake of another near wake.
fn in_wake(case: &mut Case, near_wake_deg: f64) {
    change_wake(case, |wake| wake.near_wake_deg = Some(near_wake_deg));
}

/// The descent with sections at the steps of the wake and the usual elements in time.
fn coarse() -> Result<Flown, Failure> {
    flown("hart_ii_bl.ron", |case| {
        change_wake(case, |wake| wake.section_azimuths = None);
        (case.response.time_elements, case.response.time_gauss_points) = (8, 8);
    })
}

/// Correlation of `C_n M^2` in descent with another wake.
fn descent(near_wake_deg: f64) -> Result<f64, Failure> {
    let flown = flown("hart_ii_bl.ron", |case| in_wake(case, near_wake_deg))?;
    Ok(flown.curve(Quantity::NormalM2)?.from_1.correlation)
}

static BASELINE: LazyLock<Result<Flown, Failure>> =
    LazyLock::new(|| flown("hart_ii_bl.ron", |_| ()));
static BODILESS: LazyLock<Result<Flown, Failure>> =
    LazyLock::new(|| without_body("hart_ii_bl.ron"));
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
    let case = shipped("hart_ii_bl.ron")?.case;
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

/// Of the change of a quantity from baseline to minimum noise.
fn change(pitched: &Flown, quantity: Quantity) -> Result<Apart, Failure> {
    let (to, from) = (pitched.curve(quantity)?, baseline()?.curve(quantity)?);
    let both = |of: fn(&CurveComparison) -> &HarmonicSeries| {
        [of(to).harmonic(PITCHED), of(from).harmonic(PITCHED)]
    };
    Ok(apart(both(|of| &of.computed), both(|of| &of.measured)))
}

/// Vertical rms distance of vortex centres, percent of R, over at least 40 of them.
fn vertical_distance(flown: &Flown) -> Result<f64, Failure> {
    let VortexComparison { vertical_percent_r, compared, .. } = flown.vortices;
    if compared < 40 {
        return Err(too_few("vortex centres", compared, 40));
    }
    Ok(vertical_percent_r)
}
