//! Identification on the shipped bench set (synthetic, made by an independent generator).
#![expect(clippy::unwrap_used, reason = "a test stops at what it does not expect")]
#![expect(clippy::disallowed_methods, reason = "tests read fixtures")]

use preisach_dyn::identify::{
    BenchRecord, Candidates, Family, Finding, Identification, RecordUse, RefinementOutcome,
    Settings, compare_models, identify,
};
use preisach_dyn::{ActuatorLaw, PeriodicSettings, RateForm};
use rotor_base::{Harmonic, HarmonicSeries};
use std::path::PathBuf;
use std::sync::LazyLock;

const DEG_PER_UM: f64 = 0.039_537_815;

fn records() -> Vec<BenchRecord> {
    let folder =
        PathBuf::from(env!("CARGO_MANIFEST_DIR")).join("../../fixtures/bench/apa500l_synthetic");
    let list = std::fs::read_to_string(folder.join("dataset.ron")).unwrap();
    assert!(list.contains("flap_deg_per_um: 0.039537815"), "the gain of the set has changed");
    let files = list.split("file: \"").skip(1).map(|rest| rest.split('"').next().unwrap());
    files
        .map(|file| {
            let text = std::fs::read_to_string(folder.join(file)).unwrap();
            let rows: Vec<Vec<f64>> = text
                .lines()
                .skip(1)
                .map(|line| line.split(',').map(|field| field.parse().unwrap()).collect())
                .collect();
            let last = rows.len() - 1;
            BenchRecord {
                id: file.trim_end_matches(".csv").to_owned(),
                time_step_s: (rows[last][0] - rows[0][0]) / last as f64,
                voltage_volt: rows.iter().map(|row| row[1]).collect(),
                output_deg: rows.iter().map(|row| row[2] * DEG_PER_UM).collect(),
                ..BenchRecord::default()
            }
        })
        .collect()
}

fn settings() -> Settings {
    Settings { deg_per_um: DEG_PER_UM, ..Settings::default() }
}

fn identified_on(threads: usize) -> Identification {
    let pool = rayon::ThreadPoolBuilder::new().num_threads(threads).build().unwrap();
    pool.install(|| identify(&records(), &settings()).unwrap())
}

/// Identified once for all tests of this file.
static IDENTIFIED: LazyLock<Identification> = LazyLock::new(|| identified_on(2));

#[test]
fn the_split_is_by_experiment() {
    let trained: Vec<&str> = IDENTIFIED
        .records
        .iter()
        .filter(|r| r.record_use == RecordUse::Train)
        .map(|r| r.id.as_str())
        .collect();
    let expected = [
        "major_0p2hz",
        "forc_from_150v",
        "forc_from_minus20v",
        "sine_1hz_85v",
        "sine_1hz_25v",
        "sine_10hz_85v",
        "sine_10hz_25v",
    ];
    assert_eq!(trained, expected);
}

#[test]
fn commands_are_recognised() {
    for report in &IDENTIFIED.records {
        let name: Vec<&str> = report.id.split('_').collect();
        if let ["sine", hz, volt] = name.as_slice() {
            let hz: f64 = hz.trim_end_matches("hz").parse().unwrap();
            let volt: f64 = volt.trim_end_matches('v').parse().unwrap();
            assert!((report.drive.base_hz / hz - 1.0).abs() < 1e-3, "{report:?}");
            assert!((report.drive.amplitude_volt - volt).abs() < 0.1, "{report:?}");
            assert_eq!(report.drive.strongest_harmonic, 1);
        }
        if report.id.starts_with("mix") {
            assert!((report.drive.base_hz - 5.0).abs() < 5e-3, "{report:?}");
            assert_eq!(report.drive.strongest_harmonic, 2);
        }
        // the noise of the set is 0.25 um
        if let (Some(noise), true) = (report.noise.map(|n| n.std_deg), report.drive.base_hz < 1.5) {
            assert!((0.9..1.5).contains(&(noise / (0.25 * DEG_PER_UM))), "{report:?}");
        }
    }
}

#[test]
fn the_static_model_is_visibly_wrong_at_speed() {
    for report in IDENTIFIED.records.iter().filter(|r| r.id.contains("15hz")) {
        assert!(report.static_only.nrmse > 0.5, "{}: {:?}", report.id, report.static_only);
        assert!(report.linear.nrmse > 0.5, "{}: {:?}", report.id, report.linear);
    }
    let slow = IDENTIFIED.records.iter().find(|r| r.id == "major_0p2hz").unwrap();
    assert!(slow.static_only.nrmse < 0.02 && slow.linear.nrmse > 0.1, "{slow:?}");
}

#[test]
fn no_step_folds_or_runs_away_and_the_refinement_helped() {
    for report in &IDENTIFIED.records {
        let counts = report.dynamic.counts;
        assert!(counts.steps > 0 && counts.bad_steps() == 0, "{}: {counts:?}", report.id);
    }
    let refinement = IDENTIFIED.refinement;
    assert_eq!(refinement.outcome, RefinementOutcome::Kept);
    assert!(refinement.nrmse_after < 0.95 * refinement.nrmse_before, "{refinement:?}");
}

#[test]
fn stroke_zero_and_trained_range_are_those_of_the_bench() {
    let model = &IDENTIFIED.dynamic;
    let periodic = PeriodicSettings::default();
    let full_scale = |harmonic: usize, rev_hz: f64| {
        let mut volts = HarmonicSeries::zero(harmonic);
        volts.mean = 65.0;
        volts.set_harmonic(harmonic, Harmonic { cosine: 85.0, sine: 0.0 });
        model.periodic_response(&volts, rev_hz, &periodic).unwrap().flap_deg
    };
    let slow = full_scale(1, 0.2);
    let slow_deg = slow.harmonic(1).amplitude();
    assert!((slow_deg - 10.158).abs() < 0.2, "{slow_deg}");
    assert!(slow.mean.abs() < 0.1, "{}", slow.mean);
    // fundamental at 15 Hz as the set documents it; the model has not seen 15 Hz
    let fast_deg = full_scale(3, 5.0).harmonic(3).amplitude();
    assert!((fast_deg - 4.005).abs() < 0.15, "{fast_deg}");
    let trained = model.trained.unwrap();
    assert!((trained.highest_hz - 10.0).abs() < 0.01 && (trained.lowest_hz - 0.2).abs() < 0.01);
    assert!((trained.largest_amplitude_volt - 85.0).abs() < 0.01);
    assert!((trained.bench_highest_hz - 20.0).abs() < 0.02);
    assert!(trained.is_beyond_bench(25.5) && !trained.is_beyond_bench(20.0));
}

/// No record of the set is cut or spoilt: none is called so.
#[test]
fn the_records_shipped_raise_no_alarm() {
    let alarm = IDENTIFIED
        .summary
        .findings
        .iter()
        .find(|finding| matches!(finding, Finding::Clipped { .. } | Finding::Spikes { .. }));
    assert_eq!(alarm, None);
}

#[test]
fn the_literal_form_reports_how_often_it_was_ill_posed() {
    let literal = Settings { form: RateForm::Literal, ..settings() };
    let identified = identify(&records(), &literal).unwrap();
    let large = identified.records.iter().find(|r| r.id == "sine_10hz_85v").unwrap();
    let same = IDENTIFIED.records.iter().find(|r| r.id == "sine_10hz_85v").unwrap();
    // near saturation its G1 goes through zero: a plain lag is outside equation (5) as printed
    let ActuatorLaw::DynamicPreisach(model) = &identified.dynamic.law else { panic!("law") };
    assert!(model.parameters().g1_s.largest().0 > 0.0);
    assert!(large.dynamic.counts.g1_not_negative > 0, "{:?}", large.dynamic);
    assert!(large.dynamic.nrmse > 3.0 * same.dynamic.nrmse, "{:?}", large.dynamic);
}

#[test]
fn results_do_not_depend_on_the_number_of_threads() {
    assert_eq!(identified_on(1), *IDENTIFIED);
}

/// These records have no mode, and none is chosen where it is asked for.
#[test]
fn no_mode_is_chosen_for_the_records_shipped() {
    let without = [Family::BoucWen, Family::StaticPreisach, Family::DynamicPreisach];
    let with = Family::ALL.into_iter().filter(|family| family.has_mode());
    let families: Vec<Family> = without.into_iter().chain(with).collect();
    let candidates = Candidates { families, orders: Vec::new(), ..Candidates::default() };
    let table = compare_models(&records(), &settings(), &candidates, &|| ()).unwrap();
    assert_eq!(table.rows.len(), 6);
    for row in &table.rows {
        println!("{:26} {:?}", row.family.name(), row.cross_validation);
    }
    assert!(!table.rows[table.chosen].family.has_mode());
}
