//! What records cannot tell must be said, and records that cannot be right must be refused.
#![expect(clippy::unwrap_used, reason = "a test stops at what it does not expect")]

use preisach_dyn::identify::{
    BenchRecord, Channel, Finding, Identification, RecordUse, RecordWindows, Settings, Severity,
    identify,
};
use preisach_dyn::{ActuatorLaw, PreisachError, VoltageRange};
use std::f64::consts::TAU;

const BIAS_VOLT: f64 = 65.0;

/// Dahl's hysteresis before a lag, finely stepped: outside the identified class.
fn respond(voltage_volt: &[f64], time_step_s: f64) -> Vec<f64> {
    let (mut z, mut x, mut last) = (0.0_f64, 0.0_f64, voltage_volt[0]);
    voltage_volt
        .iter()
        .map(|&u| {
            for part in 1..=10 {
                let now = last + (u - last) * f64::from(part) / 10.0;
                let du = (u - last) / 10.0;
                z += du - du.abs() * z / 25.0;
                let target = 0.13 * (now - BIAS_VOLT) - 0.03 * z;
                x += (target - x) * (1.0 - (-time_step_s / 10.0 / 0.02).exp());
            }
            last = u;
            // the last digits of a sensor, the same every time
            x + 0.002 * (1e4 * x).sin()
        })
        .collect()
}

fn record(id: &str, seconds: f64, time_step_s: f64, voltage: impl Fn(f64) -> f64) -> BenchRecord {
    let mut voltage_volt = Vec::new();
    while voltage_volt.len() as f64 * time_step_s <= seconds {
        voltage_volt.push(voltage(voltage_volt.len() as f64 * time_step_s));
    }
    let output_deg = respond(&voltage_volt, time_step_s);
    BenchRecord { id: id.into(), time_step_s, voltage_volt, output_deg, ..BenchRecord::default() }
}

fn sine(hz: f64, amplitude_volt: f64, cycles: f64) -> BenchRecord {
    let id = format!("{hz} Hz {amplitude_volt} V");
    let wave = move |t: f64| BIAS_VOLT + amplitude_volt * (TAU * hz * t).sin();
    record(&id, cycles / hz, if hz < 0.5 { 5e-3 } else { 1e-3 }, wave)
}

/// Sweeps from one end to ever higher turning points.
fn reversals() -> BenchRecord {
    let sweep = |t: f64| {
        let (index, phase) = ((t / 5.0).floor(), (t / 5.0).fract());
        let depth = (170.0 - 12.0 * index).max(10.0);
        150.0 - depth * (1.0 - (2.0 * phase - 1.0).abs())
    };
    record("reversals", 60.0, 1e-2, sweep)
}

fn full() -> Vec<BenchRecord> {
    vec![
        sine(0.2, 85.0, 4.0),
        reversals(),
        sine(1.0, 85.0, 5.0),
        sine(1.0, 25.0, 5.0),
        sine(10.0, 85.0, 12.0),
        sine(10.0, 25.0, 12.0),
    ]
}

fn settings() -> Settings {
    Settings { levels: 12, ..Settings::default() }
}

fn found(records: &[BenchRecord]) -> Identification {
    identify(records, &settings()).unwrap()
}

fn is_static(identified: &Identification) -> bool {
    matches!(identified.dynamic.law, ActuatorLaw::StaticPreisach(_))
}

#[test]
fn a_full_set_has_nothing_to_complain_of() {
    let identified = found(&full());
    assert_eq!(identified.summary.findings, [], "{:?}", identified.summary);
    assert_eq!(identified.summary.worst(), None);
    assert_eq!(identified.summary.trained_hz.len(), 3);
    assert!(!is_static(&identified));
    let [determined, unknowns] = identified.summary.density_determined;
    assert!(2 * determined > unknowns, "{determined} of {unknowns}");
}

#[test]
fn one_frequency_gives_a_static_model_and_says_so() {
    let identified = found(&[sine(1.0, 85.0, 6.0)]);
    assert!(is_static(&identified));
    let summary = &identified.summary;
    let one = |f: &Finding| matches!(f, Finding::OneFrequency { hz } if (hz - 1.0).abs() < 1e-3);
    assert!(summary.findings.iter().any(one), "{summary:?}");
    let slow = |f: &Finding| matches!(f, Finding::NoSlowRecords { .. });
    assert!(summary.findings.iter().any(slow), "{summary:?}");
    let free = |f: &Finding| matches!(f, Finding::DensityNotUnique { .. });
    assert!(summary.findings.iter().any(free), "{summary:?}");
    assert_eq!(summary.worst(), Some(Severity::Limits));
    // it is good on what it saw
    assert!(identified.records[0].static_only.nrmse < 0.02, "{:?}", identified.records[0]);
    assert_eq!(identified.records[0].static_only, identified.records[0].dynamic);
    // a frequency the split rule does not name trains all the same, and that is said
    let identified = found(&[sine(3.0, 85.0, 6.0)]);
    let taken = |f: &Finding| matches!(f, Finding::TrainedByDefault { records: 1 });
    assert!(identified.summary.findings.iter().any(taken), "{:?}", identified.summary);
}

#[test]
fn slow_records_alone_leave_rate_unknown() {
    let identified = found(&full()[..2]);
    assert!(is_static(&identified));
    let none =
        |f: &Finding| matches!(f, Finding::NoRateRecords { .. } | Finding::OneFrequency { .. });
    assert!(identified.summary.findings.iter().any(none), "{:?}", identified.summary);
}

#[test]
fn without_reversal_curves_the_density_is_not_unique() {
    let mut records = full();
    records.remove(1);
    let identified = found(&records);
    let [Finding::DensityNotUnique { determined, unknowns }] =
        identified.summary.findings.as_slice()
    else {
        panic!("{:?}", identified.summary)
    };
    assert!(*unknowns == 79 && 2 * determined < *unknowns, "{determined}");
}

#[test]
fn one_amplitude_and_no_slow_record_are_named() {
    let mut records = full();
    records.retain(|r| !r.id.contains("25 V"));
    let one = |f: &Finding| matches!(f, Finding::OneAmplitude { amplitude_volt } if (amplitude_volt - 85.0).abs() < 0.5);
    let identified = found(&records);
    assert!(identified.summary.findings.iter().any(one), "{:?}", identified.summary);
    let slow = |f: &Finding| matches!(f, Finding::NoSlowRecords { lowest_hz, .. } if (lowest_hz - 1.0).abs() < 1e-3);
    let identified = found(&full()[2..]);
    assert!(identified.summary.findings.iter().any(slow), "{:?}", identified.summary);
    assert!(!is_static(&identified));
}

#[test]
fn a_constant_command_is_a_remark() {
    let mut records = full();
    let mut rest = record("rest", 2.0, 1e-3, |_| BIAS_VOLT);
    rest.output_deg.iter_mut().enumerate().for_each(|(i, y)| *y = 1e-3 * (i as f64).sin());
    records.push(rest);
    let identified = found(&records);
    let [Finding::ConstantCommand { id, noise }] = &identified.summary.findings[..] else {
        panic!("{:?}", identified.summary.findings)
    };
    assert!(id == "rest" && (noise.std_deg / (1e-3 / 2.0_f64.sqrt()) - 1.0).abs() < 0.01);
    assert_eq!(identified.summary.worst(), Some(Severity::Remark));
}

#[test]
fn clipped_records_are_suspect() {
    let mut records = full();
    records[0].output_deg.iter_mut().for_each(|y| *y = y.min(5.0));
    let identified = found(&records);
    let clipped = |f: &Finding| {
        matches!(f, Finding::Clipped { id, channel: Channel::Output, level: level_deg, share_percent }
            if id == "0.2 Hz 85 V" && (*level_deg - 5.0).abs() < 1e-12 && *share_percent > 5.0)
    };
    assert!(identified.summary.findings.iter().any(clipped), "{:?}", identified.summary);
    assert_eq!(identified.summary.worst(), Some(Severity::Suspect));
    let mut records = full();
    let clip = |t: f64| (BIAS_VOLT + 85.0 * (TAU * t).sin()).min(120.0);
    records[2] = record("clipped", 5.0, 1e-3, clip);
    let identified = found(&records);
    let clipped = |f: &Finding| {
        matches!(f, Finding::Clipped { id, channel: Channel::Command, level: level_volt, .. }
            if id == "clipped" && (level_volt - 120.0).abs() < 1e-9)
    };
    assert!(identified.summary.findings.iter().any(clipped), "{:?}", identified.summary);
}

/// A sensor at its limit is noticed through its noise: 0.02 deg on 10 deg.
#[test]
fn a_clipped_record_is_suspect_through_noise() {
    let mut records = full();
    for (i, y) in records[0].output_deg.iter_mut().enumerate() {
        *y = y.min(5.0) + 0.02 * (0.7 * (i * i) as f64).sin();
    }
    let clipped = |f: &Finding| {
        matches!(f, Finding::Clipped { id, channel: Channel::Output, level: level_deg, share_percent }
            if id == "0.2 Hz 85 V" && (*level_deg - 5.0).abs() < 0.05 && *share_percent > 5.0)
    };
    let findings = found(&records).summary.findings;
    assert!(findings.iter().any(clipped), "{findings:?}");
}

/// One lost sample in a slow and in a fast record: named, left out, and the model is as good as without.
#[test]
fn spikes_are_named_and_left_out() {
    let whole = found(&full());
    let mut records = full();
    let slow = records.len() - 1;
    records[0].output_deg[700] += 40.0;
    records[slow].voltage_volt[500] = BIAS_VOLT + 80.0;
    let spoilt = found(&records);
    let has = |f: &dyn Fn(&Finding) -> bool| spoilt.summary.findings.iter().any(f);
    assert!(
        has(
            &|f| matches!(f, Finding::Spikes { id, channel: Channel::Output, samples: 1, index: 700, time_s, .. }
            if *id == records[0].id && (*time_s - 3.5).abs() < 1e-9)
        ),
        "{:?}",
        spoilt.summary
    );
    assert!(
        has(
            &|f| matches!(f, Finding::Spikes { id, channel: Channel::Command, samples: 1, index: 500, .. }
            if *id == records[slow].id)
        ),
        "{:?}",
        spoilt.summary
    );
    for (a, b) in whole.records.iter().zip(&spoilt.records) {
        let change = (a.dynamic.nrmse - b.dynamic.nrmse).abs();
        assert!(
            change < 1e-3 + 0.05 * a.dynamic.nrmse,
            "{}: {:?} {:?}",
            a.id,
            a.dynamic,
            b.dynamic
        );
    }
}

#[test]
fn swapped_columns_are_refused_or_suspect() {
    // the output in um leaves the range of the command: refused
    let deg_per_um = 0.04;
    let settings = Settings { deg_per_um, ..settings() };
    let mut records = full();
    for r in &mut records {
        let um: Vec<f64> = r.output_deg.iter().map(|y| y / deg_per_um).collect();
        r.output_deg = r.voltage_volt.iter().map(|u| u * deg_per_um).collect();
        r.voltage_volt = um;
    }
    let error = identify(&records, &settings).unwrap_err();
    assert!(matches!(error, PreisachError::SwappedColumns { .. }), "{error}");
    // inside the range the output then leads
    let mut records = full();
    for r in &mut records {
        let scaled: Vec<f64> = r.output_deg.iter().map(|y| BIAS_VOLT + 6.0 * y).collect();
        r.output_deg = r.voltage_volt.iter().map(|u| 0.1 * (u - BIAS_VOLT)).collect();
        r.voltage_volt = scaled;
    }
    let identified = identify(&records, &settings).unwrap();
    let leads = |f: &Finding| matches!(f, Finding::OutputLeads { lead_deg, .. } if *lead_deg > 5.0);
    assert!(identified.summary.findings.iter().any(leads), "{:?}", identified.summary);
}

#[test]
fn a_wrong_unit_is_refused() {
    let scaled = |factor: f64| {
        let mut records = full();
        for r in &mut records {
            r.voltage_volt.iter_mut().for_each(|u| *u *= factor);
        }
        identify(&records, &settings()).unwrap_err()
    };
    let error = scaled(1000.0);
    assert!(matches!(error, PreisachError::UnitMismatch { likely: "millivolt", .. }), "{error}");
    let error = scaled(1e-3);
    assert!(matches!(error, PreisachError::UnitMismatch { .. }), "{error}");
    // a little out of range is not a matter of units
    let error = scaled(1.05);
    assert!(matches!(error, PreisachError::BadRecord { .. }), "{error}");
}

#[test]
fn single_samples_empty_sets_and_bad_windows_are_errors() {
    let one = BenchRecord {
        id: "one".into(),
        time_step_s: 1e-3,
        voltage_volt: vec![1.0],
        output_deg: vec![1.0],
        ..BenchRecord::default()
    };
    assert!(matches!(identify(&[one], &settings()), Err(PreisachError::OutOfRange { .. })));
    assert!(matches!(identify(&[], &settings()), Err(PreisachError::NoTrainingRecord { .. })));
    for window in [5..10, 10..900_000] {
        let mut records = full();
        records[0].windows.train = Some(window);
        let error = identify(&records, &settings()).unwrap_err();
        assert!(matches!(error, PreisachError::BadRecord { .. }), "{error}");
    }
}

#[test]
fn windows_train_and_judge_apart_while_the_memory_runs_from_the_first_sample() {
    // 3 s of rest, then cycles of 1 Hz: trained on two, judged on later ones
    let wave = |t: f64| if t < 3.0 { 0.0 } else { 85.0 * (TAU * t).sin() };
    let mut single = record("single", 10.0, 1e-3, wave);
    // the first cycle is spoilt, and so is the time between the windows
    for i in (0..3900).chain(6100..6900) {
        single.output_deg[i] += 3.0;
    }
    single.windows = RecordWindows { train: Some(4000..6000), judge: Some(7000..10_000) };
    let range_volt = VoltageRange::new(-100.0, 100.0).unwrap();
    let settings = Settings { range_volt, levels: 24, ..Settings::default() };
    let identified = identify(&[single.clone()], &settings).unwrap();
    let fit = identified.records[0].static_only;
    assert_eq!(identified.records[0].record_use, RecordUse::Train);
    assert!(fit.range_percent < 0.3, "{fit:?}");
    assert!(fit.start_up_percent.unwrap() > 5.0, "{fit:?}");
    let noise = identified.records[0].noise.unwrap();
    assert!(noise.pairs == 1 && noise.std_deg < 0.01, "{noise:?}");
    // trained on everything it is worse: the window keeps what is spoilt out
    let all = BenchRecord { windows: RecordWindows::default(), ..single };
    let whole = identify(&[all], &settings).unwrap().records[0].static_only;
    assert!(whole.range_percent > 3.0 * fit.range_percent, "{whole:?}");
}

/// An output that falls as the voltage rises is outside every class here, and that is said, whatever
/// numbers the fit finds; the same records the right way up are described.
#[test]
fn records_outside_the_class_are_called_so() {
    let outside = |sign: f64| {
        let mut records = full();
        for output in records.iter_mut().flat_map(|r| &mut r.output_deg) {
            *output *= sign;
        }
        found(&records).summary.findings.iter().any(|f| matches!(f, Finding::NotDescribed { .. }))
    };
    assert!(outside(-1.0));
    assert!(!outside(1.0));
}

/// Plays of 40 half-widths up to 60 V, the wider ones weighing less, from rest.
fn plays(voltage_volt: &[f64]) -> Vec<f64> {
    let mut states = [voltage_volt[0]; 40];
    let step = |&u: &f64| {
        let moved = states.iter_mut().zip(1..).map(|(state, place)| {
            let half_width_volt = 1.5 * f64::from(place);
            *state = state.clamp(u - half_width_volt, u + half_width_volt);
            *state * (-half_width_volt / 30.0).exp()
        });
        0.05 * u + 0.01 * moved.sum::<f64>()
    };
    voltage_volt.iter().map(step).collect()
}

/// One major loop says nothing of the loops inside it. Plays of one width taken as alike foretell them, as most
/// piezo actuators are; a density smooth in every direction leaves 2.3 to 4 % of
/// their spread.
#[test]
fn loops_inside_the_only_one_recorded_are_foretold() {
    let wave = |record_use, off: f64, amplitude_volt: f64| {
        let wave = move |t: f64| {
            BIAS_VOLT + off * (t / 5.0).min(1.0) + amplitude_volt * (TAU * 0.2 * t).sin()
        };
        let of = record(&format!("{amplitude_volt} V about {off} V"), 20.0, 5e-3, wave);
        let output_deg = plays(&of.voltage_volt);
        BenchRecord { output_deg, record_use: Some(record_use), ..of }
    };
    let inner = [(-45.0, 30.0), (40.0, 30.0), (0.0, 45.0)];
    let inner = inner.map(|(off, amplitude_volt)| wave(RecordUse::HeldOut, off, amplitude_volt));
    let records = [&[wave(RecordUse::Train, 0.0, 85.0)], &inner[..]].concat();
    let identified = identify(&records, &Settings::default()).unwrap();
    let free = |f: &Finding| matches!(f, Finding::DensityNotUnique { .. });
    assert!(identified.summary.findings.iter().any(free), "{:?}", identified.summary);
    for report in &identified.records {
        assert!(report.static_only.nrmse < 0.005, "{}: {:?}", report.id, report.static_only);
    }
}

/// A part of the density that no training loop determines takes what its neighbours have: held-out loops that visit it are
/// foretold, where without this prior the fit is as free there as its solver.
#[test]
fn a_part_that_no_loop_determines_is_as_beside_it() {
    let loops = |record_use, middle_volt: f64, amplitude_volt: f64| {
        let wave = move |t: f64| {
            let begins = BIAS_VOLT + (middle_volt - BIAS_VOLT) * (t / 5.0).min(1.0);
            begins + amplitude_volt * (TAU * 0.2 * t).sin()
        };
        let of = record(&format!("{amplitude_volt} V about {middle_volt} V"), 20.0, 5e-3, wave);
        let noise = |i: usize| 0.01 * (1e4 * (i as f64).sin()).sin();
        let output_deg = plays(&of.voltage_volt);
        let output_deg = output_deg.iter().enumerate().map(|(i, y)| y + noise(i)).collect();
        BenchRecord { output_deg, record_use: Some(record_use), ..of }
    };
    let trained = [(65.0, 40.0), (45.0, 25.0), (85.0, 25.0), (65.0, 12.0), (40.0, 12.0)];
    let trained = trained.map(|(middle, size)| loops(RecordUse::Train, middle, size));
    let beyond = [(65.0, 84.0), (110.0, 38.0)];
    let beyond = beyond.map(|(middle, size)| loops(RecordUse::HeldOut, middle, size));
    let records = [&trained[..], &beyond[..]].concat();
    let errors = |static_smoothness: f64| {
        let settings = Settings { static_smoothness, ..Settings::default() };
        let found = identify(&records, &settings).unwrap().records;
        let side = |record_use| {
            let of_use = found.iter().filter(move |r| r.record_use == record_use);
            of_use.map(|r| r.static_only.nrmse).fold(0.0, f64::max)
        };
        [side(RecordUse::Train), side(RecordUse::HeldOut)]
    };
    let usual = Settings::default().static_smoothness;
    let ([trained, with], [free, without]) = (errors(usual), errors(1e-12));
    println!("trained {trained} and {free}, beyond them {with} and {without}");
    assert!(trained < 1.5 * free && with < 0.5 * without, "{trained} {free} {with} {without}");
}

/// A record that begins as the amplifier is switched on: the output jumps, the command does not. With 0 V before it
/// the model has the memory that the actuator has. A record from rest is left alone.
#[test]
fn a_record_that_begins_at_switch_on_comes_from_zero_volt() {
    let range = VoltageRange::new(0.0, 150.0).unwrap();
    let wave = |t: f64| 75.0 + 75.0 * (TAU * t).sin();
    // 2 s at 0 V, then the sine; what is recorded begins at the jump
    let before = record("before", 8.0, 5e-3, |t| if t < 2.0 { 0.0 } else { wave(t - 2.0) });
    let cut = |from: usize| BenchRecord {
        voltage_volt: before.voltage_volt[from..].to_vec(),
        output_deg: before.output_deg[from - 1..before.output_deg.len() - 1].to_vec(),
        ..before.clone()
    };
    let begins = before.voltage_volt.iter().position(|volt| *volt > 0.0).unwrap();
    let switched = cut(begins);
    let longer = switched.from_switch_on(range).unwrap();
    assert_eq!(longer.voltage_volt[..2], [0.0, before.voltage_volt[begins]]);
    assert_eq!(longer.output_deg[..2], [switched.output_deg[0]; 2]);
    // the first rise, before the loop is closed: three quarters of the error
    let settings = Settings { range_volt: range, ..settings() };
    let first_rise = |record: &BenchRecord| {
        let windows = RecordWindows { train: Some(400..1000), judge: Some(15..50) };
        let record = BenchRecord { windows, ..record.clone() };
        identify(&[record], &settings).unwrap().records[0].static_only.range_percent
    };
    let (with, without) = (first_rise(&longer), first_rise(&switched));
    assert!(with < 0.8 * without, "{with} against {without}");
    // one second later nothing jumps
    assert_eq!(cut(begins + 200).from_switch_on(range), None);
    assert_eq!(sine(1.0, 85.0, 5.0).from_switch_on(VoltageRange::amplified_stack()), None);
}
