//! The flights of measured rotors: every measured curve beside the computed one.

use super::figure::{Axis, Mark, Panel, Series, drawn};
use super::{Done, Study, Teller, Told, table};
use crate::{XtaskError, workspace};
use rotor_base::HarmonicSeries;
use rotor_study::{
    CURVE_AZIMUTHS, CurveComparison, Quantity, TrimmedRotor, compare_curves, computed_curves,
};
use sim_driver::SimError;
use sim_driver::case::load_case;
use sim_driver::results::MeasuredPart;
use std::path::Path;

pub(super) const STUDY: Study =
    Study { name: "measured-flights", is_quick: false, runs: &[], told: Teller::Simulating(told) };

/// The flights with their cases.
const FLIGHTS: [(&str, &str); 4] = [
    ("HART II, baseline", "hart_ii_bl.ron"),
    ("HART II, minimum noise", "hart_ii_mn.ron"),
    ("HeliNOVI, level", "helinovi_level.ron"),
    ("HeliNOVI, climb", "helinovi_climb.ron"),
];
/// Harmonics shown.
const SHOWN: usize = 6;
/// Azimuth from point to point of a curve, deg.
const STEP_DEG: usize = 3;

/// The measured curves of a flight beside those of the rotor in its trim.
fn flown(root: &Path, case: &str) -> Result<Vec<CurveComparison>, XtaskError> {
    let loaded = load_case(&root.join("fixtures/cases").join(case)).map_err(SimError::from)?;
    let own = &loaded.case;
    let rotor = TrimmedRotor::new(own, None).map_err(SimError::from)?;
    let stations: Vec<f64> = own.measured.airloads.iter().map(|of| of.station_r).collect();
    let (airloads, tip) = rotor
        .airloads(&stations, own.tip_mach(), CURVE_AZIMUTHS)
        .map_err(|error| XtaskError::Study(format!("{case}: {error}")))?;
    let part = MeasuredPart::of(&loaded.measured, &computed_curves(&airloads, &tip), None);
    let curves = part.map(|part| part.curves).unwrap_or_default();
    Ok(curves.iter().map(|line| compare_curves(&line.curve, &line.computed)).collect())
}

/// A series of as many harmonics as are shown, without its mean, over a revolution.
fn waves(of: &HarmonicSeries, scale: f64) -> Vec<[f64; 2]> {
    let harmonics = of.harmonics.iter().take(SHOWN).copied().collect();
    let own = HarmonicSeries { mean: 0.0, harmonics };
    let at = |psi: usize| [psi as f64, scale * own.value((psi as f64).to_radians())];
    (0..=360).step_by(STEP_DEG).map(at).collect()
}

/// What a quantity is multiplied by to be shown, and its name with the unit.
fn shown(quantity: Quantity) -> Option<(f64, &'static str)> {
    match quantity {
        Quantity::NormalM2 => Some((1e3, "C_n M^2, 1e-3")),
        Quantity::MomentM2 => Some((1e3, "C_m M^2, 1e-3")),
        Quantity::Normal => Some((1e3, "C_n, 1e-3")),
        Quantity::TipFlap => Some((1.0, "tip flap, % R")),
        Quantity::TipTwist => Some((1.0, "tip twist, deg")),
        Quantity::ChordM2 | Quantity::TipLag => None,
    }
}

/// Rows of the harmonics of a flight.
fn rows(flight: &str, curves: &[CurveComparison]) -> Vec<Vec<String>> {
    let mut all = Vec::new();
    for curve in curves {
        let Some((scale, name)) = shown(curve.quantity) else { continue };
        let last = curve.measured.harmonics.len().min(SHOWN);
        for n in 1..=last {
            let cell = |of: &HarmonicSeries| {
                let own = of.harmonic(n);
                format!("{:.2}, {:.0}", scale * own.amplitude(), own.phase_deg())
            };
            let once = |text: &str| if n == 1 { text.to_owned() } else { String::new() };
            all.push(vec![
                once(flight),
                once(name),
                n.to_string(),
                cell(&curve.measured),
                cell(&curve.computed),
            ]);
        }
    }
    all
}

/// Correlation and distance of a flight, a row for each curve.
fn agreements(flight: &str, curves: &[CurveComparison]) -> Vec<Vec<String>> {
    let row = |curve: &CurveComparison| {
        let (scale, name) = shown(curve.quantity)?;
        let [from_1, from_2] = [&curve.from_1, &curve.from_2];
        Some(vec![
            flight.to_owned(),
            name.to_owned(),
            format!("1 to {}", curve.last_harmonic),
            format!("{:.3}", from_1.correlation),
            format!("{:.2}", scale * from_1.rms),
            format!("{:.3}", from_2.correlation),
            format!("{:.2}", scale * from_2.rms),
        ])
    };
    curves.iter().filter_map(row).collect()
}

/// A panel of one curve.
fn panel(title: &str, curves: &[CurveComparison], of: Quantity, y: Axis) -> Panel {
    let scale = shown(of).map_or(1.0, |(scale, _)| scale);
    let curve = curves.iter().find(|curve| curve.quantity == of);
    let points = |of: fn(&CurveComparison) -> &HarmonicSeries| {
        curve.map(|curve| waves(of(curve), scale)).unwrap_or_default()
    };
    let line = |name, colour, points| Series { name, colour, mark: Mark::Line, points };
    Panel {
        title: title.to_owned(),
        x: Axis { label: "azimuth, deg", ends: [0.0, 360.0], step: 90.0 },
        y,
        series: vec![
            line("measured, 1 to 6 per rev", 0, points(|curve| &curve.measured)),
            line("computed, the same", 1, points(|curve| &curve.computed)),
        ],
    }
}

fn told(_: &[Done]) -> Result<Told, XtaskError> {
    let root = workspace::root();
    let found = FLIGHTS.map(|(name, case)| flown(&root, case).map(|curves| (name, curves)));
    let found = found.into_iter().collect::<Result<Vec<_>, _>>()?;
    let (mut agree, mut harmonics) = (Vec::new(), Vec::new());
    for (name, curves) in &found {
        agree.extend(agreements(name, curves));
        harmonics.extend(rows(name, curves));
    }
    let load = Axis { label: "C_n M^2 at 0.87 R, 1e-3", ends: [-80.0, 80.0], step: 40.0 };
    let level = Axis { label: "C_n at 0.87 R, 1e-3", ends: [-300.0, 300.0], step: 100.0 };
    let flap = Axis { label: "tip flap, % R", ends: [-1.5, 1.5], step: 0.5 };
    let twist = Axis { label: "tip twist, deg", ends: [-2.0, 2.0], step: 1.0 };
    let panels = [
        panel("baseline", &found[0].1, Quantity::NormalM2, load),
        panel("baseline", &found[0].1, Quantity::TipFlap, flap),
        panel("baseline", &found[0].1, Quantity::TipTwist, twist),
        panel("minimum noise", &found[1].1, Quantity::NormalM2, load),
        panel("minimum noise", &found[1].1, Quantity::TipTwist, twist),
        panel("HeliNOVI, level", &found[2].1, Quantity::Normal, level),
        panel("HeliNOVI, climb", &found[3].1, Quantity::Normal, level),
    ];
    let titles = ["flight", "curve", "per rev", "correlation", "rms", "from 2: correlation", "rms"];
    let each = ["flight", "curve", "per rev", "measured, deg", "computed, deg"];
    Ok(Told {
        numbers: format!("{}\n{}", table(&titles, &agree), table(&each, &harmonics)),
        figure: drawn("Measured flights, means removed", &panels),
    })
}
