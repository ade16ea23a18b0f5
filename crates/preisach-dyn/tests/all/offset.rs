//! Results do not depend on where the zero of a sensor is, nor on the unit of the output.
#![allow(clippy::unwrap_used, reason = "a test stops at what it does not expect")]

use crate::common::Wavy;
use chacha20::ChaCha8Rng;
use preisach_dyn::forc::{self, ForcCurve, ForcData, ForcSettings};
use preisach_dyn::identify::{
    BenchRecord, Candidates, Family, FlapZero, ModelComparison, ModelRow, Settings,
    StaticAccumulator, compare_models, identify,
};
use preisach_dyn::{
    ActuatorLaw, ActuatorModel, AmplifierStage, Calibration, HysteresisLaw, Lag, LinkageStage,
    LogCreep, PreisachGrid, StartState, StaticPreisach, VoltageRange,
};
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};
use std::f64::consts::TAU;

const DEG_PER_UM: f64 = 0.04;
/// Offset of a sensor that stands away from what it reads, um.
const AWAY_UM: f64 = 1e5;

/// Slow loops of several amplitudes through a Preisach density, with noise, behind a sensor: um.
fn bench(offset_um: f64, scale: f64) -> Vec<BenchRecord> {
    let (grid, map) = Wavy::WIDE.map(24);
    let truth = StaticPreisach::new(grid, map).unwrap();
    let mut rng = ChaCha8Rng::seed_from_u64(5);
    let noise = Normal::new(0.0, 0.02).unwrap();
    let record = |amplitude: f64| {
        let volt = |i: u32| 65.0 + amplitude * (TAU * 0.2 * 0.01 * f64::from(i)).sin();
        let voltage_volt: Vec<f64> = (0..1500).map(volt).collect();
        let (mut memory, _) = truth.start(voltage_volt[0], StartState::Rest);
        let step = |u: &f64| {
            let deg = truth.step(&mut memory, *u, 0.01) + noise.sample(&mut rng);
            scale * DEG_PER_UM * (deg / DEG_PER_UM + offset_um)
        };
        let output_deg = voltage_volt.iter().map(step).collect();
        let id = format!("{amplitude} V");
        BenchRecord { id, time_step_s: 0.01, voltage_volt, output_deg, ..BenchRecord::default() }
    };
    [85.0, 60.0, 35.0, 15.0].map(record).into()
}

fn settings(zero: FlapZero) -> Settings {
    Settings {
        range_volt: VoltageRange::new(-30.0, 160.0).unwrap(),
        deg_per_um: DEG_PER_UM,
        levels: 12,
        zero,
        ..Settings::default()
    }
}

/// NRMSE of the records by every family, and the displacement the static model gives for the first
/// record, um from that of the record.
fn found(offset_um: f64, scale: f64, zero: FlapZero) -> (Vec<f64>, f64) {
    let records = bench(offset_um, scale);
    let settings = Settings { deg_per_um: scale * DEG_PER_UM, ..settings(zero) };
    let single = identify(&records, &settings).unwrap();
    let families = [Family::BoucWen, Family::PrandtlStop, Family::StaticPreisach];
    let candidates =
        Candidates { families: families.to_vec(), orders: vec![], ..Candidates::default() };
    let table = compare_models(&records, &settings, &candidates, &|| ()).unwrap();
    let mut errors: Vec<f64> = single.records.iter().map(|r| r.static_only.nrmse).collect();
    let fitted = table.rows.iter().filter_map(|row| row.fitted.as_ref().ok());
    errors.extend(fitted.flat_map(|fitted| fitted.fits.iter().map(|fit| fit.nrmse)));
    let model = &single.static_only;
    let first = &records[0];
    let ours = model.simulate(&first.voltage_volt, first.time_step_s).unwrap().output_deg;
    let pairs = || ours.iter().zip(&first.output_deg);
    let zero_missed = pairs().map(|(a, b)| (a + single.zero_deg - b).abs()).fold(0.0, f64::max);
    let um = |deg: f64| deg / model.calibration.deg_per_um + model.calibration.zero_um;
    let missed = pairs().map(|(a, b)| (um(*a) - b / settings.deg_per_um).abs()).fold(0.0, f64::max);
    assert!((zero_missed / settings.deg_per_um - missed).abs() < 1e-6 * (1.0 + AWAY_UM * 1e-3));
    (errors, missed)
}

#[test]
fn models_do_not_depend_on_offset_and_unit() {
    for zero in [FlapZero::MajorLoopMean, FlapZero::AsRecorded] {
        let (near, missed_near) = found(0.0, 1.0, zero);
        assert!(near.len() >= 12 && near[0] < 0.02, "{near:?}");
        for (offset_um, scale) in
            [(AWAY_UM, 1.0), (-AWAY_UM, 1.0), (3e4, 1.0), (AWAY_UM, 1e-3), (AWAY_UM, 1e3)]
        {
            let (away, missed) = found(offset_um, scale, zero);
            assert_eq!(near.len(), away.len(), "{offset_um} {scale}");
            for (a, b) in near.iter().zip(&away) {
                assert!((a - b).abs() < 1e-3 * a, "{offset_um} {scale}: {a} {b}");
            }
            assert!((missed - missed_near).abs() < 0.02, "{offset_um} {scale}: {missed}");
        }
    }
}

#[test]
fn streams_do_not_depend_on_offset_and_unit() {
    let rms_deg = |offset_um: f64, scale: f64| {
        let records = bench(offset_um, scale);
        let mut stream = StaticAccumulator::new(&settings(FlapZero::AsRecorded), 1).unwrap();
        for record in &records {
            stream.begin_record();
            stream.push(&record.voltage_volt, &record.output_deg).unwrap();
        }
        let law = stream.fit().unwrap();
        let (mut memory, _) = law.start(records[0].voltage_volt[0], StartState::Rest);
        let samples = records[0].voltage_volt.iter().zip(&records[0].output_deg);
        let squares: f64 =
            samples.map(|(u, y)| (law.step(&mut memory, *u, 0.01) - y).powi(2)).sum();
        (squares / records[0].output_deg.len() as f64).sqrt() / scale
    };
    let near = rms_deg(0.0, 1.0);
    for (offset_um, scale) in [(AWAY_UM, 1.0), (0.0, 1e-3), (0.0, 1e3), (AWAY_UM, 1e3)] {
        let away = rms_deg(offset_um, scale);
        assert!(near < 0.1 && (near - away).abs() < 1e-3 * near, "{near} {away}");
    }
}

#[test]
fn reversal_curves_do_not_depend_on_the_offset() {
    let (grid, map): (PreisachGrid, _) = Wavy::WIDE.map(12);
    let truth = StaticPreisach::new(grid, map).unwrap();
    let worst = |offset: f64| {
        let curve = |k: u32| {
            let volt = |i: u32| 150.0 - 14.0 * f64::from(k) + 1.4 * f64::from(k * i) / 2.0;
            let input: Vec<f64> = (0..=20).map(volt).collect();
            let (mut memory, _) = truth.start(150.0, StartState::FallingFromHighest);
            let output = input.iter().map(|u| truth.step(&mut memory, *u, 1.0) + offset).collect();
            ForcCurve { input, output }
        };
        let data = ForcData { curves: (1..=12).map(curve).collect(), calibration: vec![] };
        let settings = ForcSettings { levels: 12, ..ForcSettings::default() };
        let fitted = forc::fit(&data, &settings).unwrap();
        fitted.curves.iter().map(|c| c.rms_percent).fold(0.0, f64::max)
    };
    let (near, away) = (worst(0.0), worst(AWAY_UM));
    assert!(near < 2.0 && (near - away).abs() < 1e-2 * near + 1e-6, "{near} {away}");
}

/// Neither the order of the runs nor what they are called says anything.
#[test]
fn models_do_not_depend_on_the_order_and_names_of_runs() {
    let errors = |order: [usize; 4], name: fn(usize) -> String| {
        let all = bench(0.0, 1.0);
        let renamed = |i: usize| BenchRecord { id: name(i), ..all[i].clone() };
        let records = order.map(renamed);
        let families = vec![Family::BoucWen, Family::StaticPreisach];
        let candidates = Candidates { families, orders: vec![], ..Candidates::default() };
        let settings = settings(FlapZero::MajorLoopMean);
        let table = compare_models(&records, &settings, &candidates, &|| ()).unwrap();
        let mut errors = vec![0.0; 4 * table.rows.len()];
        for (row, own) in table.rows.iter().enumerate() {
            for (fit, i) in own.fitted.as_ref().unwrap().fits.iter().zip(order) {
                errors[4 * row + i] = fit.nrmse;
            }
        }
        (table.best().unwrap().family, errors)
    };
    let (family, as_given) = errors([0, 1, 2, 3], |i| format!("run {i}"));
    for order in [[3, 1, 0, 2], [2, 3, 1, 0]] {
        let (other, found) = errors(order, |i| format!("{}", 100 - i));
        assert_eq!(family, other);
        for (a, b) in as_given.iter().zip(&found) {
            assert!((a - b).abs() < 1e-3 * a, "{as_given:?} {found:?}");
        }
    }
}

/// Runs of an actuator with lag and creep, slow and fast, behind a sensor: um.
fn bench_with_rate(offset_um: f64, scale: f64) -> Vec<BenchRecord> {
    let (grid, map) = Wavy::WIDE.map(24);
    let law = ActuatorLaw::StaticPreisach(StaticPreisach::new(grid, map).unwrap());
    let calibration = Calibration { deg_per_um: 1.0, zero_um: 0.0 };
    let mut truth = ActuatorModel::new(law, VoltageRange::amplified_stack(), calibration);
    truth.amplifier.push(AmplifierStage::Lag(Lag { tau_s: 0.008 }));
    truth.linkage.push(LinkageStage::LogCreep(LogCreep::new(0.015)));
    let mut rng = ChaCha8Rng::seed_from_u64(8);
    let noise = Normal::new(0.0, 0.02).unwrap();
    let record = |(hz, amplitude, cycles): (f64, f64, u32)| {
        let time_step_s = 1.0 / (200.0 * hz);
        let volt = |i: u32| 65.0 + amplitude * (TAU * f64::from(i) / 200.0).sin();
        let voltage_volt: Vec<f64> = (0..200 * cycles).map(volt).collect();
        let deg = truth.simulate(&voltage_volt, time_step_s).unwrap().output_deg;
        let sensed = |deg: &f64| {
            scale * DEG_PER_UM * ((deg + noise.sample(&mut rng)) / DEG_PER_UM + offset_um)
        };
        let output_deg = deg.iter().map(sensed).collect();
        let id = format!("{hz} Hz {amplitude} V");
        BenchRecord { id, time_step_s, voltage_volt, output_deg, ..BenchRecord::default() }
    };
    [
        (0.2, 80.0, 3),
        (0.2, 50.0, 3),
        (0.2, 20.0, 3),
        (1.0, 80.0, 4),
        (1.0, 30.0, 4),
        (10.0, 80.0, 8),
        (10.0, 30.0, 8),
        (4.0, 50.0, 6),
    ]
    .map(record)
    .into()
}

/// Errors and parameters of every family, whatever the sensor's zero and unit. Searches stop where a step gains 1e-4 of the
/// sum of squares: what they leave open is below a hundredth of an error and a fifth of a standard deviation.
#[test]
fn no_family_depends_on_offset_and_unit() {
    // with all of them named, those with a mode would be left out
    let families: Vec<Family> =
        Family::ALL.into_iter().filter(|family| *family != Family::PrandtlStop).collect();
    let table = |offset_um: f64, scale: f64| {
        let records = bench_with_rate(offset_um, scale);
        let settings = Settings {
            deg_per_um: scale * DEG_PER_UM,
            levels: 8,
            ..settings(FlapZero::AsRecorded)
        };
        let candidates =
            Candidates { families: families.clone(), orders: vec![], ..Candidates::default() };
        compare_models(&records, &settings, &candidates, &|| ()).unwrap()
    };
    let near = table(0.0, 1.0);
    let mut moved = Vec::new();
    for (offset_um, scale) in [(AWAY_UM, 1.0), (-30.0, 1.0), (0.0, 1e-3), (AWAY_UM, 1e3)] {
        let away = table(offset_um, scale);
        for (a, b) in near.rows.iter().zip(&away.rows) {
            let (own, other) = (a.fitted.as_ref().unwrap(), b.fitted.as_ref().unwrap());
            let errors = own.fits.iter().zip(&other.fits).map(|(a, b)| (b.nrmse / a.nrmse).ln());
            let left_out = (b.cross_validation.unwrap() / a.cross_validation.unwrap()).ln();
            let error = errors.chain([left_out]).fold(0.0, |m: f64, e| m.max(e.abs()));
            let pairs = own.parameters.iter().zip(&other.parameters);
            // the constant of a model moves with the zero of its sensor
            let is_shape = |name: &str| !name.contains("offset") && !name.starts_with("bias");
            let moves = pairs.filter(|(a, _)| is_shape(&a.name));
            let parameter = moves
                .map(|(a, b)| (a.value - b.value).abs() / a.std_deviation)
                .fold(0.0, |m: f64, e| m.max(e));
            println!(
                "{offset_um:e} um x {scale:e}, {}: error {error:.1e}, parameters {parameter:.1e}",
                a.family.name()
            );
            if error > 1e-2 || parameter > 0.2 {
                moved.push(format!(
                    "{offset_um:e} um x {scale:e}, {}: {error} {parameter}",
                    a.family.name()
                ));
            }
        }
        assert_eq!(near.chosen, away.chosen);
    }
    assert!(moved.is_empty(), "{moved:#?}");
}

/// Slow runs of exact plays with noise, amplitude in V and half cycles of each; one is a rise alone.
fn bench_of_plays(runs: &[(f64, u32)], scale: f64) -> Vec<BenchRecord> {
    let mut rng = ChaCha8Rng::seed_from_u64(13);
    let noise = Normal::new(0.0, 0.05).unwrap();
    let record = |&(amplitude, half_cycles): &(f64, u32)| {
        let volt = |i: u32| 70.0 - amplitude * (TAU * f64::from(i) / 500.0).cos();
        let voltage_volt: Vec<f64> = (0..250 * half_cycles).map(volt).collect();
        let mut plays_volt = [voltage_volt[0]; 4];
        let step = |u: &f64| {
            let mut um = u + noise.sample(&mut rng);
            for (play, half_width) in plays_volt.iter_mut().zip([5.0, 15.0, 30.0, 45.0]) {
                *play = play.min(u + half_width).max(u - half_width);
                um += 0.25 * *play;
            }
            scale * DEG_PER_UM * um
        };
        let output_deg = voltage_volt.iter().map(step).collect();
        let id = format!("{amplitude} V, {half_cycles} half cycles");
        BenchRecord { id, time_step_s: 0.01, voltage_volt, output_deg, ..BenchRecord::default() }
    };
    runs.iter().map(record).collect()
}

/// Settings of such a bench.
fn settings_of_plays(scale: f64) -> Settings {
    Settings {
        range_volt: VoltageRange::new(20.0, 120.0).unwrap(),
        deg_per_um: scale * DEG_PER_UM,
        ..Settings::default()
    }
}

/// Of a small loop alone, smoothness foretells the large one: as plays of one width that are alike, in every unit.
#[test]
fn what_smoothness_foretells_does_not_depend_on_the_unit() {
    let error = |scale: f64| {
        let [small, large] = [15.0, 50.0].map(|volt| bench_of_plays(&[(volt, 6)], scale));
        let found = identify(&small, &settings_of_plays(scale)).unwrap();
        let (model, truth) = (&found.static_only, &large[0]);
        let ours = model.simulate(&truth.voltage_volt, truth.time_step_s).unwrap().output_deg;
        let pairs = ours.iter().zip(&truth.output_deg);
        let squares: f64 = pairs.map(|(a, b)| (a + found.zero_deg - b).powi(2)).sum();
        (squares / ours.len() as f64).sqrt() / scale
    };
    let near = error(1.0);
    println!("error of the large loop {near:.4} deg");
    for scale in [1e-3, 1e3] {
        let moved = (error(scale) / near - 1.0).abs();
        println!("x {scale}: moves by {moved:.1e}");
        assert!(moved < 1e-6, "x {scale}: {moved:e}");
    }
}

/// A fold that leaves most of the density to smoothness has the same error in every unit: of loops, none but small ones.
#[test]
fn undetermined_folds_do_not_depend_on_the_unit() {
    for runs in [&[(50.0, 1), (50.0, 6)][..], &[(50.0, 1), (50.0, 6), (15.0, 6)][..]] {
        let found = |scale: f64| {
            let settings = settings_of_plays(scale);
            let families = vec![Family::PrandtlPlays, Family::StaticPreisach];
            let candidates = Candidates { families, orders: vec![], ..Candidates::default() };
            let records = bench_of_plays(runs, scale);
            compare_models(&records, &settings, &candidates, &|| ()).unwrap()
        };
        let errors = |table: &ModelComparison| -> Vec<f64> {
            let of_row = |row: &ModelRow| {
                let fits = row.fitted.as_ref().unwrap().fits.iter().map(|fit| fit.nrmse);
                fits.chain(row.cross_validation).collect::<Vec<f64>>()
            };
            table.rows.iter().flat_map(of_row).collect()
        };
        let near = found(1.0);
        let [plays, density] = [0, 1].map(|row| near.rows[row].cross_validation.unwrap());
        println!("{} runs, left out: plays {plays:.4}, density {density:.4}", runs.len());
        for scale in [1e-3, 0.04, 10.0, 1e3] {
            let away = found(scale);
            assert_eq!(near.chosen, away.chosen, "x {scale}");
            let pairs = errors(&near).into_iter().zip(errors(&away));
            let moved = pairs.map(|(a, b)| (b / a - 1.0).abs()).fold(0.0, f64::max);
            println!("x {scale}: errors move by {moved:.1e}");
            assert!(moved < 1e-6, "x {scale}: {moved:e}");
        }
    }
}
