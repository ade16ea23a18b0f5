//! Actuators of every law and stage, the shipped bench commands, and programs to run them in.

use actuator_export::{Target, export};
use preisach_dyn::{
    Accommodation, ActuatorLaw, ActuatorModel, AmplifierStage, Backlash, BoucWen,
    BoucWenParameters, Calibration, CoulombFriction, CurrentLimit, Delay, DynamicParameters,
    DynamicPreisach, Envelope, KelvinVoigt, KelvinVoigtElement, Lag, LinearGain, LinkageStage,
    LoadStiffness, LogCreep, PlayMap, PrandtlIshlinskii, PrandtlParameters, PrandtlStop,
    PreisachGrid, RateForm, Relaxation, RelaxationElement, Resonance, Saturation, StaticPreisach,
    StopParameters, TimeOrder, VoltageRange, WeightedPlay, WeightedStop,
};
use std::path::{Path, PathBuf};
use std::process::Command;

/// An actuator under a name that every language takes.
pub(crate) struct Named {
    pub(crate) name: &'static str,
    pub(crate) model: ActuatorModel,
}

/// A density with structure: a wave across the centres, falling with the half-width.
pub(crate) fn map(levels: usize) -> (PreisachGrid, PlayMap) {
    let grid = PreisachGrid::new(VoltageRange::amplified_stack(), levels).unwrap();
    let n = levels as f64;
    let rises: Vec<Vec<f64>> = (0..levels)
        .map(|j| {
            let rise = |k: usize| {
                let (s, r) = ((2 * k + j) as f64 / n - 1.0, j as f64 / n);
                let reversible = if j == 0 { 12.0 / n } else { 0.0 };
                reversible + (1.2 + (4.0 * s).sin()) * (-3.0 * r).exp() * 20.0 / (n * n)
            };
            (0..levels - j).map(rise).collect()
        })
        .collect();
    (grid, PlayMap::from_rises(&grid, 0.5, &rises).unwrap())
}

pub(crate) fn plain(law: ActuatorLaw) -> ActuatorModel {
    let calibration = Calibration { deg_per_um: 0.04, zero_um: 3.0 };
    ActuatorModel::new(law, VoltageRange::amplified_stack(), calibration)
}

pub(crate) fn statics(levels: usize) -> ActuatorModel {
    let (grid, map) = map(levels);
    plain(ActuatorLaw::StaticPreisach(StaticPreisach::new(grid, map).unwrap()))
}

pub(crate) fn dynamics(levels: usize, form: RateForm, time_order: TimeOrder) -> ActuatorModel {
    let (grid, g0_deg) = map(levels);
    let waves = |size: f64, constant: f64| {
        let row = |j: usize| (0..=levels - j).map(move |k| size * ((j + 2 * k) as f64).sin());
        PlayMap { constant, nodes: (0..levels).map(|j| row(j).collect()).collect() }
    };
    let parameters = DynamicParameters {
        grid,
        g0_deg,
        g1_s: waves(1e-4, -0.015),
        g2_s2_per_deg: waves(1e-8, 2e-6),
        form,
        unfolded_rate_deg_s: 600.0,
        time_order,
    };
    plain(ActuatorLaw::DynamicPreisach(DynamicPreisach::new(parameters).unwrap()))
}

fn envelope() -> Envelope {
    Envelope { offset_deg: 0.2, quadratic: 0.1, cubic: -0.05 }
}

pub(crate) fn prandtl(threshold_growth_s: f64) -> ActuatorModel {
    let play = |i: u32| WeightedPlay {
        threshold_volt: 4.0 * f64::from(i),
        weight_deg_per_volt: 0.012 * (-0.2 * f64::from(i)).exp(),
    };
    let parameters = PrandtlParameters {
        range_volt: VoltageRange::amplified_stack(),
        gain_deg_per_volt: 0.06,
        plays: (1..8).map(play).collect(),
        threshold_growth_s,
        envelope: envelope(),
    };
    plain(ActuatorLaw::PrandtlIshlinskii(PrandtlIshlinskii::new(parameters).unwrap()))
}

pub(crate) fn bouc_wen(exponent: f64, sigma: f64) -> ActuatorModel {
    let parameters = BoucWenParameters {
        range_volt: VoltageRange::amplified_stack(),
        gain_deg_per_volt: 0.12,
        half_height_deg: 0.9,
        rise_volt: 30.0,
        sigma,
        exponent,
        envelope: envelope(),
    };
    plain(ActuatorLaw::BoucWen(BoucWen::new(parameters).unwrap()))
}

pub(crate) fn stops() -> ActuatorModel {
    let parameters = StopParameters {
        range_volt: VoltageRange::amplified_stack(),
        stiffness_deg_per_volt: 0.06,
        stops: vec![
            WeightedStop { threshold_volt: 10.0, stiffness_deg_per_volt: 0.03 },
            WeightedStop { threshold_volt: 30.0, stiffness_deg_per_volt: 0.02 },
        ],
        viscosity_deg_s_per_volt: 1e-4,
        offset_deg: 0.2,
    };
    plain(ActuatorLaw::PrandtlStop(PrandtlStop::new(parameters).unwrap()))
}

pub(crate) fn linear() -> ActuatorModel {
    plain(ActuatorLaw::Linear(LinearGain { gain_deg_per_volt: 0.12, bias_volt: 65.0 }))
}

/// One of every law, and of every form of it that is written differently.
pub(crate) fn laws() -> Vec<Named> {
    let named = |name, model| Named { name, model };
    vec![
        named("linear_gain", linear()),
        named("static_preisach", statics(13)),
        named("dynamic_preisach", dynamics(12, RateForm::WellPosed, TimeOrder::Second)),
        named("dynamic_euler", dynamics(12, RateForm::WellPosed, TimeOrder::First)),
        named("dynamic_literal", dynamics(11, RateForm::Literal, TimeOrder::Second)),
        named("prandtl", prandtl(0.0)),
        named("prandtl_rate", prandtl(5e-4)),
        named("bouc_wen_1", bouc_wen(1.0, 0.8)),
        named("bouc_wen_2", bouc_wen(2.0, 0.8)),
        named("bouc_wen_n", bouc_wen(1.6, 0.8)),
        named("bouc_wen_straight", bouc_wen(2.0, 0.5)),
        named("stops", stops()),
    ]
}

/// A law behind an amplifier.
fn behind(stages: Vec<AmplifierStage>) -> ActuatorModel {
    ActuatorModel { amplifier: stages, ..statics(10) }
}

/// A law before a linkage.
fn before(stages: Vec<LinkageStage>) -> ActuatorModel {
    ActuatorModel { linkage: stages, ..statics(10) }
}

/// Every stage that is written, and all of them in one chain.
pub(crate) fn stages() -> Vec<Named> {
    let named = |name, model| Named { name, model };
    let lag = AmplifierStage::Lag(Lag { tau_s: 2e-3 });
    let delay = AmplifierStage::Delay(Delay { delay_s: 1.7e-3 });
    let limit = AmplifierStage::CurrentLimit(CurrentLimit { slew_rate_volt_per_s: 4e3 });
    let knee = AmplifierStage::Saturation(Saturation {
        knee_volt: 8.0,
        ..Saturation::sharp(-15.0, 140.0)
    });
    let relaxation = LinkageStage::Relaxation(Relaxation {
        elements: [(0.4, 2e-3), (0.3, 8e-3), (0.2, 0.03)]
            .map(|(share, time_constant_s)| RelaxationElement { share, time_constant_s })
            .to_vec(),
    });
    let element = KelvinVoigtElement { compliance_ratio: 0.05, time_constant_s: 0.03 };
    let chain = LinkageStage::KelvinVoigt(KelvinVoigt { elements: vec![element] });
    let creep = LinkageStage::LogCreep(LogCreep::new(0.02));
    let late = LinkageStage::Accommodation(Accommodation { share: 0.05, travel_um: 60.0 });
    let mode = LinkageStage::Resonance(Resonance { frequency_hz: 190.0, damping_ratio: 0.03 });
    let gap = LinkageStage::Backlash(Backlash { width_um: 1.0 });
    let rub = LinkageStage::CoulombFriction(CoulombFriction { width_um: 1.0 });
    let spring = LinkageStage::LoadStiffness(preisach_dyn::LoadStiffness {
        stiffness_ratio: 0.1,
        ..NO_LOAD
    });
    vec![
        named("with_lag", behind(vec![lag])),
        named("with_delay", behind(vec![delay])),
        named("with_limit", behind(vec![limit])),
        named("with_knee", behind(vec![knee])),
        named(
            "with_sharp",
            behind(vec![AmplifierStage::Saturation(Saturation::sharp(-5.0, 120.0))]),
        ),
        named("with_relaxation", before(vec![relaxation.clone()])),
        named("with_elements", before(vec![chain])),
        named("with_creep", before(vec![creep.clone()])),
        named("with_accommodation", before(vec![late.clone()])),
        named("with_mode", before(vec![mode.clone()])),
        named("with_gap", before(vec![gap])),
        named("with_friction", before(vec![rub])),
        named("with_spring", before(vec![spring.clone()])),
        named(
            "whole_chain",
            ActuatorModel {
                amplifier: vec![lag, knee],
                linkage: vec![late, relaxation, creep, mode, spring],
                ..statics(24)
            },
        ),
    ]
}

const NO_LOAD: LoadStiffness =
    LoadStiffness { stiffness_ratio: 0.0, compliance_um_per_newton: 0.0 };

/// A command of the shipped bench set.
pub(crate) struct Run {
    pub(crate) id: String,
    pub(crate) time_step_s: f64,
    pub(crate) volts: Vec<f64>,
    /// What the bench saw, deg.
    pub(crate) output_deg: Vec<f64>,
}

/// Flap angle for displacement of the shipped set, deg/um.
pub(crate) const DEG_PER_UM: f64 = 0.039_537_815;

pub(crate) fn bench() -> Vec<Run> {
    let folder =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/bench/apa500l_synthetic");
    let list = std::fs::read_to_string(folder.join("dataset.ron")).unwrap();
    let files = list.split("file: \"").skip(1).map(|rest| rest.split('"').next().unwrap());
    let run = |file: &str| {
        let text = std::fs::read_to_string(folder.join(file)).unwrap();
        let row = |line: &str| line.split(',').map(|field| field.parse().unwrap()).collect();
        let rows: Vec<Vec<f64>> = text.lines().skip(1).map(row).collect();
        let last = rows.len() - 1;
        // to whole microseconds: as many time steps as the set has, not as rounding makes
        let step_s = (rows[last][0] - rows[0][0]) / last as f64;
        Run {
            id: file.trim_end_matches(".csv").to_owned(),
            time_step_s: (step_s * 1e6).round() / 1e6,
            volts: rows.iter().map(|row| row[1]).collect(),
            output_deg: rows.iter().map(|row| row[2] * DEG_PER_UM).collect(),
        }
    };
    files.map(run).collect()
}

/// The runs of each time step.
pub(crate) fn by_time_step(runs: Vec<Run>) -> Vec<(f64, Vec<Run>)> {
    let mut groups: Vec<(f64, Vec<Run>)> = Vec::new();
    for run in runs {
        match groups.iter_mut().find(|(step, _)| step.to_bits() == run.time_step_s.to_bits()) {
            Some((_, group)) => group.push(run),
            None => groups.push((run.time_step_s, vec![run])),
        }
    }
    groups
}

/// 2, 3 and 4/rev of 5 Hz, faded in over half a second from rest, deg.
pub(crate) fn wanted(half_deg: f64, middle_deg: f64, time_step_s: f64) -> Vec<f64> {
    let count = (1.0 / time_step_s).round();
    let angle = |t: f64| {
        let fade = 0.5 - 0.5 * (std::f64::consts::PI * (t / 0.5).min(1.0)).cos();
        let psi = std::f64::consts::TAU * 5.0 * t;
        let mix = 0.5 * (2.0 * psi + 0.3).cos()
            + 0.35 * (3.0 * psi + 1.9).cos()
            + 0.25 * (4.0 * psi - 2.2).cos();
        middle_deg + half_deg * fade * mix
    };
    (0..=20_000_u32)
        .map(f64::from)
        .take_while(|i| *i <= count)
        .map(|i| angle(i * time_step_s))
        .collect()
}

pub(crate) fn largest_difference(a: &[f64], b: &[f64]) -> f64 {
    assert_eq!(a.len(), b.len());
    a.iter().zip(b).fold(0.0, |m, (x, y)| f64::max(m, (x - y).abs()))
}

/// Half peak to peak.
pub(crate) fn amplitude(values: &[f64]) -> f64 {
    let low = values.iter().copied().fold(f64::INFINITY, f64::min);
    let high = values.iter().copied().fold(f64::NEG_INFINITY, f64::max);
    0.5 * (high - low)
}

/// An empty folder for what a test writes.
pub(crate) fn folder(name: &str) -> PathBuf {
    let folder = Path::new(env!("CARGO_TARGET_TMPDIR")).join("actuator-export").join(name);
    if folder.exists() {
        std::fs::remove_dir_all(&folder).unwrap();
    }
    std::fs::create_dir_all(&folder).unwrap();
    folder
}

/// Writes the files of a language.
pub(crate) fn write(folder: &Path, named: &Named, time_step_s: f64, target: Target) {
    for (file, text) in export(&named.model, named.name, time_step_s, target).unwrap() {
        std::fs::write(folder.join(file), text).unwrap();
    }
}

pub(crate) fn write_numbers(path: &Path, values: &[f64]) {
    let bytes: Vec<u8> = values.iter().flat_map(|value| value.to_le_bytes()).collect();
    std::fs::write(path, bytes).unwrap();
}

pub(crate) fn read_numbers(path: &Path) -> Vec<f64> {
    let bytes = std::fs::read(path).unwrap();
    let (numbers, rest) = bytes.as_chunks::<8>();
    assert!(rest.is_empty());
    numbers.iter().map(|number| f64::from_le_bytes(*number)).collect()
}

/// Runs a program in a folder; what it prints if it succeeds.
pub(crate) fn run(folder: &Path, program: &str, arguments: &[&str]) -> String {
    let output = Command::new(program).args(arguments).current_dir(folder).output().unwrap();
    let text = |bytes: &[u8]| String::from_utf8_lossy(bytes).into_owned();
    let (printed, complaint) = (text(&output.stdout), text(&output.stderr));
    assert!(output.status.success(), "{program} {arguments:?}:\n{printed}\n{complaint}");
    printed
}

/// Whether a program is there and succeeds.
pub(crate) fn there_is(program: &str, arguments: &[&str]) -> bool {
    let output = Command::new(program).args(arguments).output();
    output.is_ok_and(|output| output.status.success())
}

/// Whether exported code can be checked by `numpy` or `octave`. `EXPORT_CHECKS` names those that have to be there.
#[expect(clippy::disallowed_methods, reason = "the environment says which checks may be left out")]
pub(crate) fn can_check(by: &str) -> bool {
    let found = match by {
        "octave" => there_is("octave-cli", &["--version"]),
        _ => there_is("python3", &["-c", &format!("import {by}")]),
    };
    let needed = std::env::var("EXPORT_CHECKS").unwrap_or_default();
    let is_needed = needed.split_whitespace().any(|name| name == by);
    assert!(found || !is_needed, "EXPORT_CHECKS names {by}, which is not there");
    if !found {
        println!("no {by} here: nothing tested");
    }
    found
}
