//! Loads of oscillating sections: a measured flap, and loops with something planted.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use flap_aero::{AttachedFlowModel, FlapEffectiveness, Motion, StallAirfoil};
use measured_data::{DatasetKind, PointData, Source};
use model_gap::SplitMix;
use model_gap::discovery::Verdict;
use rotor_case::Case;
use rotor_gap::section::{SectionLoads, diagnose_section};
use rotor_gap::{CaseDiagnosis, CaseQuestion, RotorGapError};
use section_study::{LoopQuestion, SectionChoice, loop_history};
use std::f64::consts::TAU;
use std::fmt::Write;

/// A section with the flap of the measurement, a quarter of the chord.
fn section() -> Case {
    let mut case = Case::default();
    case.flaps.truncate(1);
    case.flaps[0].chord_fraction = 0.25;
    case.aerodynamics.model = AttachedFlowModel::Calibrated;
    case
}

fn read(text: String) -> Result<SectionLoads, RotorGapError> {
    let source = Source { name: "a.csv".into(), text };
    SectionLoads::of(&PointData::read_with(&source, DatasetKind::SectionLoops.words()).unwrap())
}

fn diagnosed(case: &Case, text: String) -> CaseDiagnosis {
    let question = CaseQuestion { case, uncertain: &[], only: &[], begun: &|_, _| {} };
    diagnose_section(&question, &read(text).unwrap()).unwrap()
}

fn ids(own: &CaseDiagnosis) -> Vec<&'static str> {
    let causes = own.found.finding.causes.iter();
    causes.map(|found| own.found.candidates[found.candidate].id).collect()
}

/// NACA 64A006 at Mach 0.5, flap at k = 0.098, 2.5 deg: first harmonics as read from the loops of
/// `fixtures/measured/flap_hinge_moment` and their scatter, as a history.
#[test]
fn a_measured_flap_makes_less_lift_than_theory() {
    let (cn, cm) = ([2.714, -0.630], [-0.7566, -0.046]);
    let mut random = SplitMix(1);
    let mut text = String::from("mach,reduced_frequency,frequency_hz,time_s,flap_deg,cn,cm\n");
    for k in 0..40 {
        let phase = TAU * f64::from(k) / 40.0;
        let flap = 2.5_f64.to_radians();
        let load = |own: [f64; 2]| flap * (own[0] * phase.sin() + own[1] * phase.cos());
        let cn = load(cn) + 0.00076 * random.normal();
        let cm = load(cm) + 0.00021 * random.normal();
        let (time, deg) = (phase / TAU / 30.0, 2.5 * phase.sin());
        writeln!(text, "0.5,0.098,30,{time},{deg},{cn},{cm}").unwrap();
    }
    let own = diagnosed(&section(), text);
    let finding = &own.found.finding;
    assert_eq!(finding.verdict, Verdict::Named, "{:?}", finding.reasons);
    assert_eq!(ids(&own), ["flap-effectiveness"]);
    let [lift, moment] = &finding.causes[0].parameters[..] else { panic!() };
    assert!((lift.value - 0.78).abs() < 0.02, "{lift:?}");
    assert!(moment.ci95[0] < 1.0 && moment.ci95[1] > 1.0, "{moment:?}");
    // lift and moment come from the same pressures: a gain or a time would be that of both
    for rejected in ["sensor-gain", "timing"] {
        let place = own.found.candidates.iter().position(|own| own.id == rejected).unwrap();
        let compared = finding.causes[0].compared.iter().find(|own| own.candidate == place);
        assert!(!compared.unwrap().is_as_likely(), "{rejected}");
    }
    let flap = own.extended.unwrap().flaps[0].effectiveness;
    assert!((flap.lift - lift.value).abs() < 1e-12);
}

/// What is planted in loops of pitch and flap.
#[derive(Default)]
struct Plant {
    stall: Option<StallAirfoil>,
    stalls_later_deg: f64,
    late_s: f64,
    gain: f64,
    flap_lift: f64,
}

/// Loops of a section with something planted, with noise of 1 % of the amplitude of each load.
fn loops(seed: u64, plant: &Plant) -> String {
    let mut random = SplitMix(seed);
    let mut text = String::from(
        "loop,mach,reduced_frequency,frequency_hz,phase_deg,alpha_deg,flap_deg,cn,cm,ch\n",
    );
    let effectiveness = FlapEffectiveness::new(1.0 + plant.flap_lift, 1.0, 1.0).unwrap();
    let of_mach = |mach| SectionChoice {
        model: AttachedFlowModel::Calibrated,
        mach,
        flap_chord: 0.25,
        effectiveness,
    };
    let motions = [
        (Motion::Pitch, 0.3, 0.05, 9.0_f64, 8.0_f64),
        (Motion::Pitch, 0.3, 0.15, 9.0, 8.0),
        (Motion::Pitch, 0.2, 0.1, 2.0, 3.0),
        (Motion::Flap, 0.3, 0.1, 2.0, 4.0),
        (Motion::Flap, 0.2, 0.2, 2.0, 4.0),
    ];
    for (number, (motion, mach, k, mean_deg, amplitude_deg)) in motions.into_iter().enumerate() {
        let table = loop_history(&LoopQuestion {
            section: of_mach(mach),
            motion,
            mean_rad: mean_deg.to_radians(),
            amplitude_rad: amplitude_deg.to_radians(),
            reduced_frequency: k,
            points: 60,
            stall: plant.stall,
            stalls_later_rad: plant.stalls_later_deg.to_radians(),
        });
        let rows = table.unwrap().rows;
        // as if the chord were 0.3 m in air at 20 C
        let hz = k * 343.0 * mach / (std::f64::consts::PI * 0.3);
        let span = |c: usize| {
            let own: Vec<f64> = rows.iter().map(|row| row[c]).collect();
            own.iter().copied().fold(f64::MIN, f64::max)
                - own.iter().copied().fold(f64::MAX, f64::min)
        };
        let noise = [3, 4, 5].map(|c| 0.005 * span(c));
        for row in &rows {
            // what is read at a phase was there a time before
            let late_deg = 360.0 * hz * plant.late_s;
            let phase = row[0] + late_deg;
            let moved = |mean: f64, moves: bool| {
                if moves { mean + amplitude_deg * phase.to_radians().sin() } else { mean }
            };
            let alpha = moved(mean_deg, motion == Motion::Pitch);
            let flap = moved(0.0, motion == Motion::Flap);
            let load = |k: usize, random: &mut SplitMix| {
                (1.0 + plant.gain) * row[3 + k] + noise[k] * random.normal()
            };
            let (cn, cm, ch) = (load(0, &mut random), load(1, &mut random), load(2, &mut random));
            writeln!(text, "m{number},{mach},{k},{hz},{phase},{alpha},{flap},{cn},{cm},{ch}")
                .unwrap();
        }
    }
    text
}

/// The onset is the incidence of the constants at the Mach number of the loop that goes furthest, and moves with it.
#[test]
fn a_stall_is_told_by_its_onset() {
    let stall = StallAirfoil::Naca0012Measured;
    let stated = stall.parameters(flap_aero::Mach::new(0.3).unwrap()).alpha1_rad.to_degrees();
    for stalls_later_deg in [0.0, 1.5] {
        let plant = Plant { stall: Some(stall), stalls_later_deg, ..Plant::default() };
        let own = diagnosed(&section(), loops(7, &plant));
        assert_eq!(ids(&own), ["dynamic-stall"], "{:?}", own.found.finding.reasons);
        let onset = own.found.finding.causes[0].parameters[0].value;
        assert!((onset - stated - stalls_later_deg).abs() < 0.3, "{onset} {stated}");
    }
}

#[test]
fn a_section_with_something_planted_is_known_by_it() {
    let case = section();
    let named = |seed: u64, wanted: &str, plant: Plant| {
        let own = diagnosed(&case, loops(seed, &plant));
        let finding = &own.found.finding;
        assert_eq!(ids(&own), [wanted], "{seed}: {:?} {:?}", finding.verdict, finding.reasons);
    };
    for seed in 0..3 {
        named(
            seed,
            "dynamic-stall",
            Plant { stall: Some(StallAirfoil::Naca0012Measured), ..Plant::default() },
        );
        named(seed, "timing", Plant { late_s: 0.002, ..Plant::default() });
        named(seed, "sensor-gain", Plant { gain: -0.1, ..Plant::default() });
        named(seed, "flap-effectiveness", Plant { flap_lift: -0.2, ..Plant::default() });
        let nothing = diagnosed(&case, loops(seed, &Plant::default()));
        let finding = &nothing.found.finding;
        assert_eq!(
            finding.verdict,
            Verdict::NothingMissing,
            "{:?} {:?}",
            ids(&nothing),
            finding.reasons
        );
    }
}

#[test]
fn what_is_no_loop_is_refused() {
    let text = |text: &str| read(text.to_owned()).unwrap_err().to_string();
    assert!(text("mach,reduced_frequency,cn_re\n0.3,0.1,5\n").contains("motion"));
    let head = "motion,mach,reduced_frequency";
    assert!(text(&format!("{head},cn_re\nheave,0.3,0.1,5\n")).contains("`heave` is not"));
    assert!(text(&format!("{head},lift\nflap,0.3,0.1,5\n")).contains("cn_re"));
    assert!(text(&format!("{head}\nflap,0.3,0.1\n")).contains("no load"));
    assert!(
        text("mach,reduced_frequency,time_s,flap_deg,cn\n0.3,0.1,0,1,5\n0.3,0.1,1,1,5\n")
            .contains("neither")
    );
}
