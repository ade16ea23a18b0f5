//! Folders of the generator of everyday errors, and an error that was once named wrongly.
#![expect(clippy::disallowed_methods, reason = "tests write the folders they hand in")]
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use everyday_bench::answer::Answer;
use everyday_bench::family::Family;
use everyday_bench::hidden::Deal;
use everyday_bench::set::{Request, set};
use everyday_bench::text::File;
use model_gap::discovery::{Confidence, Reason};
use sim_driver::diagnose::{Diagnosis, Findings, Question, Records, diagnose};
use sim_driver::files::{BenchData, Folder, read_bench};

/// The data of a folder of these files.
pub(crate) fn bench(files: &[File]) -> BenchData {
    let folder = tempfile::tempdir().unwrap();
    for (name, text) in files {
        std::fs::write(folder.path().join(name), text).unwrap();
    }
    read_bench(&Folder::Disk(folder.path().to_path_buf())).unwrap()
}

/// What is found of the set of a seed.
fn found(family: Family, seed: u64, deal: Deal) -> (Answer, Diagnosis) {
    found_of(&Request::new(family, seed, deal))
}

fn found_of(request: &Request) -> (Answer, Diagnosis) {
    let made = set(request);
    let reference = Records::from(&bench(&made.reference)).runs;
    let question = Question { reference, ..Question::default() };
    let found = diagnose(&Records::from(&bench(&made.measured)), &question).unwrap();
    (made.answer, found)
}

/// A gain that drifts from 0 to 4 % is told as a change with time; nothing that stays is.
#[test]
fn a_gain_that_changes_over_the_session_is_told_with_its_ends() {
    let told = |found: &Diagnosis| {
        found.finding.reasons.iter().find_map(|reason| match reason {
            Reason::ChangesOverSession { is_gain, first_percent, last_percent, is_stated } => {
                Some((*is_gain, *is_stated, [*first_percent, *last_percent]))
            }
            _ => None,
        })
    };
    let (answer, drifting) = found(Family::Relays, 12_100, Deal::Everyday);
    assert_eq!(answer.hidden, "sensor-gain-drift");
    let (is_gain, is_stated, ends) = told(&drifting).unwrap();
    assert!(is_gain && !is_stated);
    assert!(ends[0].abs() < 1.0 && (ends[1] - 4.0).abs() < 1.0, "{ends:?}");
    let (_, nothing) = found(Family::Relays, 12_206, Deal::Nulls);
    assert_eq!(told(&nothing), None);
}

/// Gains that drift over the session. Of the first the run that repeats a reference run knows the gain far better than the
/// others, and with all weight on it the name is confident; the second gain and zero of an amplifier fit.
#[test]
fn a_gain_that_drifts_over_the_session_is_no_confident_constant() {
    for seed in [16_029, 32_169] {
        let (answer, found) = found(Family::Duhem, seed, Deal::Everyday);
        assert_eq!(answer.hidden, "sensor-gain-drift");
        let found = Findings::from(&found);
        assert_eq!(found.confidence, Confidence::Tentative, "{:?}", found.causes);
        assert_ne!(found.class_confidence, Some(Confidence::Confident), "{:?}", found.class);
    }
}

/// An amplifier that is 3 % high, no channel beside the displacement: a gain of the sensor fits better, probably because the
/// law is held beyond its range. By the fit alone it is a confident wrong name.
#[test]
fn gains_that_no_channel_tells_stay_one_set() {
    let hidden = "amplifier-gain:0.03".parse().unwrap();
    let request = Request { hidden, ..Request::new(Family::Relays, 15_001, Deal::Everyday) };
    let (answer, found) = found_of(&request);
    assert_eq!(answer.hidden, "amplifier-gain");
    let found = Findings::from(&found);
    assert_eq!(found.confidence, Confidence::Tentative, "{:?}", found.causes);
    assert!(found.causes.contains(&"amplifier-gain".to_owned()), "{:?}", found.causes);
    assert_eq!(found.class_confidence, Some(Confidence::Confident), "{:?}", found.class);
}

/// A current that runs out softly also delays a little. The name is sure, and its interval holds the slew rate.
#[test]
fn a_soft_current_limit_is_named_with_its_slew_rate() {
    let (answer, found) = found(Family::Duhem, 29_009, Deal::Singles);
    assert_eq!(answer.hidden, "amplifier-current-limit");
    let found = Findings::from(&found);
    assert_eq!(found.causes, ["amplifier-current-limit"]);
    assert_eq!(found.confidence, Confidence::Confident);
    let truth = answer.parameters["amplifier-current-limit"]["slew_rate"].value;
    let [low, high] = found.parameters["amplifier-current-limit"]["slew_rate"].ci95;
    assert!((low..high).contains(&truth), "{low} {truth} {high}");
}

/// Lost motion in runs of ten samples a cycle. A joint that felt the samples alone would leave half of it.
#[test]
fn lost_motion_is_a_sure_class_where_samples_miss_the_turns() {
    let (answer, found) = found(Family::Relays, 29_002, Deal::Singles);
    assert_eq!(answer.hidden, "backlash");
    let found = Findings::from(&found);
    assert_eq!(found.class_confidence, Some(Confidence::Confident), "{:?}", found.class);
}

/// A folder of measured runs alone, one of them at rest, with nothing beside it: identified, and diagnosed without confidence.
#[test]
fn a_bare_folder_with_a_record_at_rest_is_identified_and_diagnosed() {
    let made = set(&Request::new(Family::Relays, 15_001, Deal::Everyday));
    let mut files = made.measured;
    let (_, list) = files.iter_mut().find(|(name, _)| name == "dataset.ron").unwrap();
    *list = list.replace("runs: [", "runs: [(id: \"rest\", file: \"rest.csv\", role: Measured),");
    let noise = |i: u32| 0.2 * (7919.0 * f64::from(i)).sin();
    let row = |i: u32| format!("{:.3},65,{:.4}\n", 1e-3 * f64::from(i), noise(i));
    let rows: String = (0..4000).map(row).collect();
    files.push(("rest.csv".into(), format!("time_s,command_V,displacement_um\n{rows}")));
    let data = bench(&files);
    let settings = preisach_dyn::identify::Settings::default();
    let found = bench_study::identification::identify_bench(&data, &settings, None).unwrap();
    let findings = &found.identification.summary.findings;
    let told: Vec<String> = findings.iter().map(ToString::to_string).collect();
    assert!(told.iter().any(|text| text.contains("is at rest: noise")), "{told:?}");
    let trained = found.fits.iter().filter(|fit| fit.use_as == rotor_base::RecordUse::Train);
    let worst = trained.map(|fit| fit.nrmse_percent).fold(0.0, f64::max);
    assert!(worst > 0.0 && worst < 20.0, "{worst}");
    let found = diagnose(&Records::from(&data), &Question::default()).unwrap();
    assert!(!found.has_reference);
    assert_eq!(Findings::from(&found).confidence, Confidence::Tentative);
}
