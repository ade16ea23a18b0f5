//! The table of models, its choice, the uncertainty of parameters, and long records piece by piece.
#![expect(clippy::unwrap_used, reason = "a test stops at what it does not expect")]

use crate::common;

use chacha20::ChaCha8Rng;
use common::Wavy;
use preisach_dyn::identify::{
    BenchRecord, Candidates, Family, Finding, LeftOut, Order, RecordUse, Settings,
    StaticAccumulator, compare_models, identify,
};
use preisach_dyn::{
    ActuatorLaw, ActuatorModel, AmplifierStage, Calibration, Lag, LinkageStage, LogCreep,
    PreisachError, Relaxation, RelaxationElement, StaticPreisach, VoltageRange,
};
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use std::f64::consts::TAU;

const BIAS_VOLT: f64 = 65.0;

fn sine(hz: f64, amplitude_volt: f64, cycles: f64, time_step_s: f64) -> (String, f64, Vec<f64>) {
    let count = cycles / hz / time_step_s;
    let mut volts = Vec::new();
    while (volts.len() as f64) <= count {
        let t = volts.len() as f64 * time_step_s;
        volts.push(BIAS_VOLT + amplitude_volt * (TAU * hz * t).sin());
    }
    (format!("{hz} Hz {amplitude_volt} V"), time_step_s, volts)
}

/// Sweeps from the top to ever higher turning points.
fn reversals() -> (String, f64, Vec<f64>) {
    let sweep = |i: usize| {
        let t = i as f64 * 1e-2;
        let depth = (170.0 - 12.0 * (t / 5.0).floor()).max(10.0);
        150.0 - depth * (1.0 - (2.0 * (t / 5.0).fract() - 1.0).abs())
    };
    ("reversals".into(), 1e-2, (0..6000).map(sweep).collect())
}

fn record(
    model: &ActuatorModel,
    (id, time_step_s, voltage_volt): (String, f64, Vec<f64>),
    mut noise: impl FnMut() -> f64,
) -> BenchRecord {
    let output = model.simulate(&voltage_volt, time_step_s).unwrap().output_deg;
    let output_deg = output.iter().map(|y| y + noise()).collect();
    BenchRecord { id, time_step_s, voltage_volt, output_deg, ..BenchRecord::default() }
}

fn runs() -> Vec<(String, f64, Vec<f64>)> {
    vec![
        sine(0.2, 85.0, 3.0, 1e-2),
        reversals(),
        sine(1.0, 85.0, 4.0, 2e-3),
        sine(1.0, 25.0, 4.0, 2e-3),
        sine(10.0, 85.0, 10.0, 1e-3),
        sine(10.0, 25.0, 10.0, 1e-3),
        sine(20.0, 55.0, 10.0, 1e-3),
    ]
}

fn static_law(levels: usize) -> StaticPreisach {
    Wavy { height: 0.4, ..Wavy::GENTLE }.law(levels)
}

fn bare(law: ActuatorLaw) -> ActuatorModel {
    let calibration = Calibration { deg_per_um: 1.0, zero_um: 0.0 };
    ActuatorModel::new(law, VoltageRange::amplified_stack(), calibration)
}

fn settings() -> Settings {
    Settings { levels: 12, ..Settings::default() }
}

#[test]
fn the_family_of_the_truth_is_chosen_and_its_times_are_found() {
    let mut truth = bare(ActuatorLaw::StaticPreisach(static_law(10)));
    let element = |share: f64, time_constant_s: f64| RelaxationElement { share, time_constant_s };
    let elements = vec![element(0.92, 0.025)];
    truth.linkage.push(LinkageStage::Relaxation(Relaxation { elements }));
    truth.linkage.push(LinkageStage::LogCreep(LogCreep::new(0.015)));
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let normal = Normal::new(0.0, 0.005).unwrap();
    let records: Vec<BenchRecord> =
        runs().into_iter().map(|run| record(&truth, run, || normal.sample(&mut rng))).collect();
    let families = vec![
        Family::Linear,
        Family::LinearLag,
        Family::StaticPreisach,
        Family::StaticPreisachRelaxation,
    ];
    // the grid of the truth, and half of it
    let settings = Settings { levels: 10, rate_levels: 5, ..settings() };
    let order = |levels, static_smoothness| Order { levels, rate_levels: 5, static_smoothness };
    let candidates = Candidates {
        families,
        orders: vec![order(5, 1e-4), order(10, 1e-7)],
        ..Candidates::default()
    };
    let table = compare_models(&records, &settings, &candidates, &|| ()).unwrap();
    assert_eq!(table.rows[table.chosen].family, Family::StaticPreisachRelaxation);
    assert_eq!(table.orders.len(), 3);
    let best = table.best().unwrap();
    let (_, worst) = table.error_over(best, RecordUse::HeldOut).unwrap();
    let fitted = best.fitted.as_ref().unwrap();
    println!("chosen {:?}, worst held-out record {:.2} %", best.order, 100.0 * worst);
    assert!(worst < 0.01, "{worst}");
    // too smooth and too coarse grids are worse, and cross-validation says so
    assert!(best.order == order(10, 1e-7), "{:?}", best.order);
    let longer = &fitted.parameters[0];
    assert!((longer.value - 0.025_f64.ln()).abs() < 0.1, "{longer:?}");
    assert!(longer.std_deviation > 0.0 && longer.std_deviation < 0.1, "{longer:?}");
    let Some(LinkageStage::LogCreep(creep)) = fitted.model.linkage.last() else { panic!("creep") };
    assert!((creep.rate_per_decade - 0.015).abs() < 0.003, "{creep:?}");
    // held-out records are not looked at: spoilt, they change the table but not the choice
    let mut spoilt = records.clone();
    spoilt[6].output_deg.iter_mut().for_each(|y| *y *= 1.5);
    let again = compare_models(&spoilt, &settings, &candidates, &|| ()).unwrap();
    assert_eq!(again.model(), table.model());
    assert!(
        again.error_over(best, RecordUse::HeldOut) == table.error_over(best, RecordUse::HeldOut)
    );
    assert_ne!(again.best().unwrap().fitted, best.fitted);
}

#[test]
fn every_family_can_be_fitted_and_one_frequency_leaves_only_static_ones() {
    let mut truth = bare(ActuatorLaw::StaticPreisach(static_law(10)));
    truth.amplifier.push(AmplifierStage::Lag(Lag { tau_s: 0.03 }));
    let records: Vec<BenchRecord> =
        runs().into_iter().map(|run| record(&truth, run, || 0.0)).collect();
    let settings = Settings { levels: 8, ..settings() };
    let candidates = Candidates { orders: Vec::new(), ..Candidates::default() };
    let table = compare_models(&records, &settings, &candidates, &|| ()).unwrap();
    for row in &table.rows {
        if row.family == Family::PrandtlStop {
            // an actuator lags, a stop leads
            assert!(
                matches!(row.fitted, Err(PreisachError::OutputLags { area_share }) if area_share < 0.0)
            );
            continue;
        }
        let fitted = row.fitted.as_ref().unwrap();
        assert_eq!(fitted.fits.len(), records.len());
        assert!(row.cross_validation.unwrap().is_finite(), "{:?}", row.family);
    }
    let error = |family: Family| {
        let row = table.rows.iter().find(|row| row.family == family).unwrap();
        table.error_over(row, RecordUse::Train).unwrap().0
    };
    // each knows something the one before does not
    assert!(error(Family::LinearLag) < 0.5 * error(Family::Linear));
    assert!(error(Family::BoucWen) < error(Family::Linear));
    assert!(error(Family::PrandtlIshlinskii) < error(Family::BoucWen));
    assert!(error(Family::DynamicPreisach) < 0.5 * error(Family::LinearLag));
    assert!(error(Family::StaticPreisachRelaxation) < 0.5 * error(Family::LinearLag));
    let alone = compare_models(&records[2..3], &settings, &candidates, &|| ()).unwrap();
    for row in &alone.rows {
        let refused = matches!(row.fitted, Err(PreisachError::NoTrainingRecord { .. }));
        assert_eq!(refused, row.family.needs_rate(), "{:?}", row.family);
    }
    // what it says of rate, creep can have; blocks in time of it choose
    assert_eq!(alone.left_out, LeftOut::Blocks);
    assert_eq!(alone.best().unwrap().family, Family::StaticPreisachCreep);
    assert!(alone.summary.findings.iter().any(|f| matches!(f, Finding::OneFrequency { .. })));
}

#[test]
fn standard_deviations_are_those_of_repeated_benches_with_coloured_noise() {
    const BENCHES: u32 = 24;
    let mut truth = ActuatorModel::linear(VoltageRange::amplified_stack(), 10.0, 1.0);
    truth.amplifier.push(AmplifierStage::Lag(Lag { tau_s: 0.02 }));
    let candidates = Candidates {
        families: vec![Family::LinearLag],
        orders: Vec::new(),
        ..Candidates::default()
    };
    let normal = Normal::new(0.0, 0.05).unwrap();
    let (mut found, mut stated) = (Vec::new(), 0.0);
    for seed in 0..BENCHES {
        let mut rng = ChaCha8Rng::seed_from_u64(u64::from(seed));
        let mut last = 0.0;
        // neighbouring samples correlated by 0.95
        let mut noise = || {
            last = 0.95 * last + normal.sample(&mut rng);
            last
        };
        let records: Vec<BenchRecord> =
            [sine(0.2, 85.0, 2.0, 1e-2), sine(1.0, 85.0, 3.0, 5e-3), sine(10.0, 85.0, 10.0, 2e-3)]
                .into_iter()
                .map(|run| record(&truth, run, &mut noise))
                .collect();
        let settings = Settings { levels: 4, ..settings() };
        let table = compare_models(&records, &settings, &candidates, &|| ()).unwrap();
        let fitted = table.rows[0].fitted.as_ref().unwrap();
        found.push(fitted.parameters[2].value);
        stated += fitted.parameters[2].std_deviation / f64::from(BENCHES);
    }
    let mean = found.iter().sum::<f64>() / f64::from(BENCHES);
    let squares: f64 = found.iter().map(|v| (v - mean).powi(2)).sum();
    let scatter = (squares / f64::from(BENCHES - 1)).sqrt();
    println!("ln tau: scatter {scatter:.5}, stated {stated:.5}, bias {:.5}", mean - 0.02_f64.ln());
    // 24 benches tell a standard deviation to 15 %; white noise assumed would state a sixth of it
    assert!((0.6..1.7).contains(&(stated / scatter)), "{stated} {scatter}");
    assert!((mean - 0.02_f64.ln()).abs() < 3.0 * scatter, "{mean}");
}

#[test]
fn a_long_record_streams_in_bounded_memory_and_gives_the_batch_fit() {
    let law = static_law(10);
    let truth = bare(ActuatorLaw::StaticPreisach(law));
    let settings = Settings { levels: 10, rate_levels: 5, static_smoothness: 1e-8, ..settings() };
    let short = record(&truth, reversals(), || 0.0);
    // one record, whole and in pieces
    let batch = identify(std::slice::from_ref(&short), &settings).unwrap().static_only;
    let mut stream = StaticAccumulator::new(&settings, 2).unwrap();
    for (u, y) in short.voltage_volt.chunks(77).zip(short.output_deg.chunks(77)) {
        stream.push(u, y).unwrap();
    }
    let pieces = bare(ActuatorLaw::StaticPreisach(stream.fit().unwrap()));
    let volts = &short.voltage_volt;
    let (a, b) = (batch.simulate(volts, 1e-2).unwrap(), pieces.simulate(volts, 1e-2).unwrap());
    let shift = b.output_deg[0] - a.output_deg[0];
    for (a, b) in a.output_deg.iter().zip(&b.output_deg) {
        assert!((b - a - shift).abs() < 2e-3, "{a} {b}");
    }
    // a million samples more: what is kept does not grow, the memory of the simulation neither
    let kept = stream.kept_numbers();
    let stepper = truth.stepper(1e-2).unwrap();
    stream.begin_record();
    let mut memory = truth.start(volts[0], preisach_dyn::StartState::Rest).unwrap();
    for _ in 0..170 {
        let outputs: Vec<f64> =
            volts.iter().map(|&u| stepper.step(&mut memory, u, 0.0).unwrap()).collect();
        stream.push(volts, &outputs).unwrap();
    }
    assert_eq!(stream.kept_numbers(), kept);
    assert_eq!(stream.samples()[0], 171 * 6000);
    assert!(stream.fit().is_ok());
    let error = stream.push(&[0.0, f64::NAN], &[0.0, 0.0]).unwrap_err();
    assert!(matches!(error, PreisachError::BadRecord { index: 1_026_001, .. }), "{error}");
    assert!(stream.push(&[0.0], &[]).is_err());
    assert!(StaticAccumulator::new(&settings, 0).is_err());
    assert!(StaticAccumulator::new(&settings, 1).unwrap().fit().is_err());
}

/// Plays without weight act on nothing: what they are is not known, and the gain is known as well as it is.
#[test]
fn parameters_without_influence_cost_the_others_no_digits() {
    let truth = bare(ActuatorLaw::StaticPreisach(static_law(12)));
    let normal = Normal::new(0.0, 0.05).unwrap();
    let deviations = |command_noise: f64| -> Vec<f64> {
        let mut rng = ChaCha8Rng::seed_from_u64(4);
        let records: Vec<BenchRecord> = runs()
            .into_iter()
            .map(|run| {
                let mut record = record(&truth, run, || normal.sample(&mut rng));
                for (i, u) in record.voltage_volt.iter_mut().enumerate() {
                    *u = (*u + command_noise * (7919.0 * i as f64).sin()).clamp(-20.0, 150.0);
                }
                record
            })
            .collect();
        let families = vec![Family::PrandtlIshlinskii];
        let candidates = Candidates { families, orders: Vec::new(), ..Candidates::default() };
        let table = compare_models(&records, &settings(), &candidates, &|| ()).unwrap();
        let fitted = table.rows[0].fitted.as_ref().unwrap();
        fitted.parameters.iter().map(|p| p.std_deviation).collect()
    };
    let (clean, noisy) = (deviations(0.0), deviations(0.01));
    assert!(clean[0] < 0.1 && (0.3..3.0).contains(&(noisy[0] / clean[0])), "{clean:?} {noisy:?}");
    for all in [&clean, &noisy] {
        assert!(all.iter().all(|d| *d <= 10.0 || d.is_infinite()), "{all:?}");
    }
}

/// What the records do not determine has the deviation of the usual value, and says so.
#[test]
fn what_only_usual_values_say_is_called_tied() {
    let mut truth = bare(ActuatorLaw::StaticPreisach(static_law(10)));
    let elements = vec![RelaxationElement { share: 1.0, time_constant_s: 0.02 }];
    truth.linkage.push(LinkageStage::Relaxation(Relaxation { elements }));
    let mut rng = ChaCha8Rng::seed_from_u64(9);
    let normal = Normal::new(0.0, 0.05).unwrap();
    let records: Vec<BenchRecord> = [sine(0.2, 85.0, 3.0, 1e-2), sine(10.0, 85.0, 6.0, 2e-3)]
        .into_iter()
        .map(|run| record(&truth, run, || normal.sample(&mut rng)))
        .collect();
    let families = vec![Family::StaticPreisachRelaxation];
    let candidates = Candidates { families, orders: Vec::new(), ..Candidates::default() };
    let settings = Settings { levels: 10, rate_levels: 5, ..settings() };
    let table = compare_models(&records, &settings, &candidates, &|| ()).unwrap();
    let parameters = &table.rows[0].fitted.as_ref().unwrap().parameters;
    println!("{parameters:#?}");
    // the time is found; a share that follows at once is left to what is usual, with its deviation
    assert!(!parameters[0].is_tied() && parameters[0].std_deviation < 0.2, "{parameters:?}");
    let at_once = &parameters[1];
    assert!(at_once.is_tied() && (0.5..1.5).contains(&at_once.std_deviation), "{at_once:?}");
}

/// A rest tells the noise of runs that never repeat; it is taken off before models are compared.
#[test]
fn the_noise_of_a_rest_takes_part_in_the_choice() {
    const NOISE_DEG: f64 = 1.0;
    let truth = bare(ActuatorLaw::StaticPreisach(static_law(12)));
    let mut rng = ChaCha8Rng::seed_from_u64(3);
    let normal = Normal::new(0.0, NOISE_DEG).unwrap();
    // loops that fade: no cycle is like another
    let fade = |depth: f64, hz: f64| {
        let at = |i: u32| {
            let t = 0.01 * f64::from(i);
            BIAS_VOLT + depth * (1.0 - t / 44.0) * (TAU * hz * t).sin()
        };
        (format!("{hz} Hz {depth} V"), 0.01, (0..4000).map(at).collect::<Vec<f64>>())
    };
    let runs = [fade(85.0, 0.21), reversals(), fade(60.0, 0.31)];
    let mut records: Vec<BenchRecord> =
        runs.into_iter().map(|run| record(&truth, run, || normal.sample(&mut rng))).collect();
    let candidates = Candidates {
        families: vec![Family::BoucWen, Family::StaticPreisach],
        orders: Vec::new(),
        ..Candidates::default()
    };
    let table = |records: &[BenchRecord], rest_noise_deg| {
        let candidates = Candidates { rest_noise_deg, ..candidates.clone() };
        compare_models(records, &settings(), &candidates, &|| ()).unwrap()
    };
    let alone = table(&records, None);
    let told = table(&records, Some(NOISE_DEG));
    let at_rest = ("rest".into(), 0.01, vec![BIAS_VOLT; 2000]);
    records.push(record(&truth, at_rest, || normal.sample(&mut rng)));
    let beside = table(&records, None);
    for own in [&alone, &told, &beside] {
        let errors = own.rows.iter().map(|row| (row.cross_validation.unwrap(), row.noise));
        println!("chosen {:?}: {:?}", own.rows[own.chosen].family, errors.collect::<Vec<_>>());
    }
    // unknown noise hides the misfit of the simpler family
    assert!(alone.rows[0].noise <= 0.0);
    assert_eq!(alone.rows[alone.chosen].family, Family::BoucWen);
    for own in [&told, &beside] {
        assert_eq!(own.rows[own.chosen].family, Family::StaticPreisach);
    }
    assert!((beside.rows[0].noise / told.rows[0].noise - 1.0).abs() < 0.05);
    assert!((told.rows[1].noise / told.rows[1].cross_validation.unwrap() - 1.0).abs() < 0.05);
}

/// Two bands of commands apart: each record left out asks for what the other does not show.
#[test]
fn records_beyond_all_others_are_not_left_out() {
    let truth = bare(ActuatorLaw::StaticPreisach(static_law(24)));
    let moved = |by_volt: f64, amplitude: f64| {
        let (id, step_s, mut volts) = sine(0.2, amplitude, 3.0, 1e-2);
        for u in &mut volts {
            *u += by_volt;
        }
        record(&truth, (format!("{id} {by_volt}"), step_s, volts), || 0.0)
    };
    let left_out = |records: &[BenchRecord]| {
        let families = vec![Family::Linear, Family::PrandtlPlays];
        let candidates = Candidates { families, orders: vec![], ..Candidates::default() };
        let table = compare_models(records, &settings(), &candidates, &|| ()).unwrap();
        assert!(table.rows.iter().all(|row| row.cross_validation.unwrap().is_finite()));
        table.left_out
    };
    assert_eq!(left_out(&[moved(-45.0, 25.0), moved(45.0, 30.0)]), LeftOut::Blocks);
    assert_eq!(left_out(&[moved(-45.0, 25.0), moved(0.0, 80.0)]), LeftOut::Records);
}

/// Holds of some voltages, 40 s each.
fn holds(volts: &[f64]) -> (String, f64, Vec<f64>) {
    let held = volts.iter().flat_map(|volt| std::iter::repeat_n(*volt, 2000));
    ("holds".into(), 0.02, held.collect())
}

/// A record of holds neither repeats nor is slow: what it says of creep must reach the fit.
#[test]
fn holds_that_train_are_fitted() {
    let mut truth = bare(ActuatorLaw::StaticPreisach(static_law(12)));
    truth.linkage.push(LinkageStage::LogCreep(LogCreep::new(0.02)));
    let mut rng = ChaCha8Rng::seed_from_u64(11);
    let normal = Normal::new(0.0, 0.2).unwrap();
    let loops = [0.4, 10.0].map(|hz| sine(hz, 85.0, 4.0, 0.01 / (1.0 + hz)));
    let runs = loops.into_iter().chain([holds(&[20.0, 120.0, 60.0, 140.0])]);
    let records: Vec<BenchRecord> =
        runs.map(|run| record(&truth, run, || normal.sample(&mut rng))).collect();
    let used = |record_use| {
        let mut records = records.clone();
        records[2].record_use = Some(record_use);
        let families = vec![Family::StaticPreisachCreep];
        let candidates = Candidates { families, orders: Vec::new(), ..Candidates::default() };
        let table = compare_models(&records, &settings(), &candidates, &|| ()).unwrap();
        let fitted = table.rows[0].fitted.clone().unwrap();
        let stage = fitted.model.linkage.first().cloned();
        let Some(LinkageStage::LogCreep(creep)) = stage else { unreachable!("{stage:?}") };
        (creep.rate_per_decade, fitted.fits[2].nrmse)
    };
    let (without, with) = (used(RecordUse::HeldOut), used(RecordUse::Train));
    println!("held out {without:?}, trained {with:?}");
    let off = [without, with].map(|own: (f64, f64)| (own.0 / 0.02 - 1.0).abs());
    assert!(off[1] < 0.05 && off[0] > 2.0 * off[1] && with.1 < without.1, "{off:?}");
}

/// The time from which creep is counted is found to its decade, and with it the rate.
#[test]
fn creep_is_found_with_the_time_it_begins() {
    for from_s in [0.01, 0.1] {
        let mut truth = bare(ActuatorLaw::StaticPreisach(static_law(12)));
        truth.linkage.push(LinkageStage::LogCreep(LogCreep { from_s, ..LogCreep::new(0.02) }));
        let mut rng = ChaCha8Rng::seed_from_u64(12);
        let normal = Normal::new(0.0, 0.1).unwrap();
        let fast = [sine(10.0, 60.0, 10.0, 1e-3), sine(1.0, 60.0, 4.0, 2e-3)];
        let loops = [sine(0.4, 85.0, 2.0, 1e-2), reversals(), sine(0.02, 70.0, 2.0, 0.1)];
        let runs = loops.into_iter().chain(fast);
        let records: Vec<BenchRecord> =
            runs.map(|run| record(&truth, run, || normal.sample(&mut rng))).collect();
        let families = vec![Family::StaticPreisachCreep];
        let candidates = Candidates { families, orders: Vec::new(), ..Candidates::default() };
        let table = compare_models(&records, &settings(), &candidates, &|| ()).unwrap();
        let stage = table.rows[0].fitted.as_ref().unwrap().model.linkage.first().cloned();
        let Some(LinkageStage::LogCreep(found)) = stage else { unreachable!("{stage:?}") };
        println!("{from_s} s: {found:?}");
        assert!((found.from_s / from_s - 1.0).abs() < 1e-9, "{found:?}");
        assert!((found.rate_per_decade / 0.02 - 1.0).abs() < 0.15, "{found:?}");
    }
}

/// Slow runs and one fast one: the slow ones are left out in turn, and parts of the fast one, so that a lag still shows.
#[test]
fn a_single_fast_run_leaves_something_to_choose_by() {
    let chosen = |lag_s: f64| {
        let mut truth = bare(ActuatorLaw::StaticPreisach(static_law(12)));
        if lag_s > 0.0 {
            truth.amplifier.push(AmplifierStage::Lag(Lag { tau_s: lag_s }));
        }
        let mut rng = ChaCha8Rng::seed_from_u64(13);
        let normal = Normal::new(0.0, 0.3).unwrap();
        let slow = [85.0, 60.0, 35.0, 15.0].map(|volt| sine(0.4, volt, 4.0, 5e-3));
        let runs = slow.into_iter().chain([sine(10.0, 60.0, 20.0, 1e-3)]);
        let records: Vec<BenchRecord> =
            runs.map(|run| record(&truth, run, || normal.sample(&mut rng))).collect();
        let families = vec![Family::StaticPreisach, Family::DynamicPreisach];
        let candidates = Candidates { families, orders: Vec::new(), ..Candidates::default() };
        let table = compare_models(&records, &settings(), &candidates, &|| ()).unwrap();
        assert_eq!(table.left_out, LeftOut::RecordsAndBlocks);
        table.best().unwrap().family
    };
    assert_eq!(chosen(0.0), Family::StaticPreisach);
    assert_eq!(chosen(0.003), Family::DynamicPreisach);
}
