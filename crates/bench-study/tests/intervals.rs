//! Intervals of physical quantities hold the truth in every family that gets some.
#![allow(clippy::unwrap_used, reason = "a test stops at what it does not expect")]

use bench_study::identification::known_quantities;
use model_gap::SplitMix;
use preisach_dyn::identify::{
    BenchRecord, Candidates, Family, FlapZero, Settings, compare_models, quantities,
};
use preisach_dyn::{
    Accommodation, ActuatorLaw, ActuatorModel, AmplifierStage, BoucWen, BoucWenParameters,
    Calibration, DynamicParameters, DynamicPreisach, Envelope, HystereticOscillator, Lag,
    LinearGain, LinkageStage, LogCreep, OscillatorParameters, PlayMap, PrandtlIshlinskii,
    PrandtlParameters, PrandtlStop, PreisachGrid, RateForm, Relaxation, RelaxationElement,
    Resonance, StaticPreisach, StopParameters, TimeOrder, VoltageRange, WeightedPlay, WeightedStop,
};
use std::f64::consts::TAU;

/// Benches of each family, if the variable of this name does not say another number.
const SEEDS: (&str, u64) = ("INTERVAL_SEEDS", 5);
/// Percent of the truths that 95 % intervals hold at least.
const LEAST_HELD_PERCENT: u64 = 85;
const LEVELS: usize = 8;
/// Noise over the stroke of about 20 deg: 0.4 %.
const NOISE_DEG: f64 = 0.08;

fn range() -> VoltageRange {
    VoltageRange::amplified_stack()
}

fn actuator(law: ActuatorLaw) -> ActuatorModel {
    ActuatorModel::new(law, range(), Calibration { deg_per_um: 1.0, zero_um: 0.0 })
}

fn grid() -> PreisachGrid {
    PreisachGrid::new(range(), LEVELS).unwrap()
}

/// A density that falls with the half-width and leans to one side.
fn map() -> PlayMap {
    let rises: Vec<Vec<f64>> = (0..LEVELS)
        .map(|j| {
            let at = |k: usize| {
                let [j, k, n] = [j, k, LEVELS].map(|v| v as f64);
                let (centre, half) = ((2.0 * k + j) / n - 1.0, j / n);
                let reversible = if j > 0.0 { 0.0 } else { 10.0 / n };
                reversible + 30.0 * (1.0 + 0.5 * centre) * (-3.0 * half).exp() / (n * n)
            };
            (0..LEVELS - j).map(at).collect()
        })
        .collect();
    PlayMap::from_rises(&grid(), -8.0, &rises).unwrap()
}

fn preisach() -> ActuatorModel {
    actuator(ActuatorLaw::StaticPreisach(StaticPreisach::new(grid(), map()).unwrap()))
}

fn with_stage(mut model: ActuatorModel, stage: LinkageStage) -> ActuatorModel {
    model.linkage.push(stage);
    model
}

fn dynamic(time_order: TimeOrder) -> ActuatorModel {
    let law = DynamicPreisach::new(DynamicParameters {
        grid: grid(),
        g0_deg: map(),
        g1_s: PlayMap::constant(&grid(), -0.006),
        g2_s2_per_deg: PlayMap::constant(&grid(), 0.0),
        form: RateForm::WellPosed,
        unfolded_rate_deg_s: 1000.0,
        time_order,
    });
    actuator(ActuatorLaw::DynamicPreisach(law.unwrap()))
}

fn bouc_wen() -> ActuatorModel {
    let law = BoucWen::new(BoucWenParameters {
        range_volt: range(),
        gain_deg_per_volt: 0.12,
        half_height_deg: 0.9,
        rise_volt: 24.0,
        sigma: 0.8,
        exponent: 1.0,
        envelope: Envelope { offset_deg: 0.0, quadratic: 0.05, cubic: 0.0 },
    });
    actuator(ActuatorLaw::BoucWen(law.unwrap()))
}

fn plays(threshold_growth_s: f64) -> ActuatorModel {
    let play = |i: u32| WeightedPlay {
        threshold_volt: 85.0 / 9.0 * f64::from(i),
        weight_deg_per_volt: 0.02 * (-0.3 * f64::from(i)).exp(),
    };
    let law = PrandtlIshlinskii::new(PrandtlParameters {
        range_volt: range(),
        gain_deg_per_volt: 0.08,
        plays: (1..9).map(play).collect(),
        threshold_growth_s,
        envelope: Envelope::default(),
    });
    actuator(ActuatorLaw::PrandtlIshlinskii(law.unwrap()))
}

fn stops() -> ActuatorModel {
    let stop = |i: u32| WeightedStop {
        threshold_volt: 85.0 / 4.0 * f64::from(i),
        stiffness_deg_per_volt: 0.03,
    };
    let law = PrandtlStop::new(StopParameters {
        range_volt: range(),
        stiffness_deg_per_volt: 0.08,
        stops: (1..4).map(stop).collect(),
        viscosity_deg_s_per_volt: 2e-4,
        offset_deg: 0.0,
    });
    actuator(ActuatorLaw::PrandtlStop(law.unwrap()))
}

/// Families with a truth of their own kind.
fn truths() -> Vec<(Family, ActuatorModel)> {
    let line = LinearGain { gain_deg_per_volt: 0.12, bias_volt: 60.0 };
    let line = actuator(ActuatorLaw::Linear(line));
    let mut lag = line.clone();
    lag.amplifier.push(AmplifierStage::Lag(Lag { tau_s: 0.008 }));
    let creep = LinkageStage::LogCreep(LogCreep::new(0.013));
    let elements = vec![RelaxationElement { share: 0.95, time_constant_s: 0.02 }];
    let relaxation = LinkageStage::Relaxation(Relaxation { elements });
    let late = LinkageStage::Accommodation(Accommodation { share: 0.1, travel_um: 6.0 });
    let layered = with_stage(with_stage(preisach(), late), relaxation);
    let oscillator = HystereticOscillator::new(OscillatorParameters {
        range_volt: range(),
        gain_deg_per_volt: 0.12,
        frequency_hz: 30.0,
        damping_ratio: 0.04,
        hysteretic_share: 0.4,
        loading_per_deg: 0.1,
        unloading_per_deg: 0.1,
        offset_deg: 0.0,
    });
    let oscillator = actuator(ActuatorLaw::HystereticOscillator(oscillator.unwrap()));
    let mode = LinkageStage::Resonance(Resonance { frequency_hz: 30.0, damping_ratio: 0.05 });
    vec![
        (Family::Linear, line),
        (Family::LinearLag, lag),
        (Family::BoucWen, bouc_wen()),
        (Family::BoucWenMode, with_stage(bouc_wen(), mode.clone())),
        (Family::HystereticOscillator, oscillator),
        (Family::PrandtlPlays, plays(0.0)),
        (Family::PrandtlIshlinskii, plays(2e-3)),
        (Family::PrandtlStop, stops()),
        (Family::StaticPreisach, preisach()),
        (Family::StaticPreisachCreep, with_stage(preisach(), creep.clone())),
        (Family::StaticPreisachMode, with_stage(preisach(), mode)),
        (Family::DynamicPreisachFirst, dynamic(TimeOrder::First)),
        (Family::DynamicPreisach, dynamic(TimeOrder::Second)),
        (Family::DynamicPreisachCreep, with_stage(dynamic(TimeOrder::Second), creep.clone())),
        (Family::StaticPreisachRelaxation, with_stage(layered, creep)),
    ]
}

/// Frequency, amplitude, cycles; 160 samples a cycle.
const RUNS: [(f64, f64, u32); 7] = [
    (0.2, 80.0, 2),
    (0.2, 50.0, 2),
    (0.2, 20.0, 2),
    (1.0, 80.0, 3),
    (1.0, 30.0, 3),
    (10.0, 80.0, 6),
    (10.0, 30.0, 6),
];

fn bench(truth: &ActuatorModel, seed: u64) -> Vec<BenchRecord> {
    let mut random = SplitMix(seed);
    let record = |(hz, amplitude, cycles): (f64, f64, u32)| {
        let time_step_s = 1.0 / (160.0 * hz);
        let volt = |i: u32| 65.0 + amplitude * (TAU * f64::from(i) / 160.0).sin();
        let voltage_volt: Vec<f64> = (0..160 * cycles).map(volt).collect();
        let exact = truth.simulate(&voltage_volt, time_step_s).unwrap().output_deg;
        let output_deg = exact.into_iter().map(|y| y + NOISE_DEG * random.normal()).collect();
        let id = format!("{hz} Hz {amplitude} V");
        BenchRecord { id, time_step_s, voltage_volt, output_deg, ..BenchRecord::default() }
    };
    RUNS.map(record).into()
}

#[expect(clippy::disallowed_methods, reason = "how many benches are tried is asked, no result")]
fn seeds() -> u64 {
    std::env::var(SEEDS.0).map_or(SEEDS.1, |text| text.parse().unwrap())
}

#[test]
fn intervals_hold_the_truth_in_every_family() {
    let seeds = seeds();
    let least_held = LEAST_HELD_PERCENT * seeds / 100;
    let mut wrong = Vec::new();
    let truths = truths();
    assert_eq!(truths.iter().map(|own| own.0).collect::<Vec<_>>(), Family::ALL);
    for (family, truth) in truths {
        let settings = Settings {
            range_volt: range(),
            levels: LEVELS,
            rate_levels: 2,
            zero: FlapZero::AsRecorded,
            ..Settings::default()
        };
        let candidates =
            Candidates { families: vec![family], orders: vec![], ..Candidates::default() };
        let expected = quantities(&truth, [-15.0, 145.0]);
        let mut held = vec![0; expected.len()];
        let mut widths = vec![0.0; expected.len()];
        for seed in 0..seeds {
            let records = bench(&truth, seed + 1);
            let table = compare_models(&records, &settings, &candidates, &|| ()).unwrap();
            let known = known_quantities(&table, &table.rows[0], &records, &settings);
            for (k, of_truth) in expected.iter().enumerate() {
                let own = known.iter().find(|own| own.quantity.name == of_truth.name).unwrap();
                let [low, high] = own.interval.unwrap();
                held[k] += u64::from((low..=high).contains(&of_truth.value));
                widths[k] += (high - low) / seeds as f64;
            }
        }
        for ((own, held), width) in expected.iter().zip(held).zip(widths) {
            let words = format!(
                "{}, {}: truth {:.4}, mean width {width:.4}, held in {held} of {seeds}",
                family.name(),
                own.name,
                own.value
            );
            println!("{words}");
            // not so wide that they say nothing
            if held < least_held || width > 1.5 * own.value.abs() {
                wrong.push(words);
            }
        }
    }
    assert!(wrong.is_empty(), "{wrong:#?}");
}
