//! What noise does to the static density, against repeated draws of the noise.
#![expect(clippy::unwrap_used, reason = "a test stops at what it does not expect")]

use crate::common::Wavy;
use chacha20::ChaCha8Rng;
use preisach_dyn::identify::{BenchRecord, DensitySpread, NoiseSource, Settings, identify};
use preisach_dyn::{ActuatorLaw, HysteresisLaw, StartState};
use rand::SeedableRng;
use rand_distr::{Distribution, Normal};

const LEVELS: usize = 6;
const NOISE_DEG: f64 = 0.03;
const DRAWS: u32 = 150;

/// A major loop in several cycles and reversals of growing depth, without noise.
fn exact(cycles: f64) -> [BenchRecord; 2] {
    let triangle = |phase: f64| 1.0 - (2.0 * phase.fract() - 1.0).abs();
    let major = move |t: f64| -20.0 + 170.0 * triangle(t / 5.0);
    let reversals = |t: f64| 150.0 - (25.0 + 12.0 * (t / 5.0).floor()) * triangle(t / 5.0);
    let law = Wavy::GENTLE.law(LEVELS);
    let record = |id: &str, seconds: f64, command: &dyn Fn(f64) -> f64| {
        let steps = (0_u32..).map(|i| 0.02 * f64::from(i)).take_while(|t| *t < seconds);
        let voltage_volt: Vec<f64> = steps.map(command).collect();
        let (mut memory, _) = law.start(voltage_volt[0], StartState::Rest);
        let output_deg = voltage_volt.iter().map(|&u| law.step(&mut memory, u, 0.02)).collect();
        BenchRecord {
            id: id.into(),
            time_step_s: 0.02,
            voltage_volt,
            output_deg,
            ..BenchRecord::default()
        }
    };
    [record("major", 5.0 * cycles, &major), record("reversals", 60.0, &reversals)]
}

/// The rises found with a draw of the noise, and their spread as told.
fn fit(exact: &[BenchRecord], noise_deg: f64, seed: u64) -> (Vec<f64>, DensitySpread) {
    let mut rng = ChaCha8Rng::seed_from_u64(seed);
    let noise = Normal::new(0.0, noise_deg).unwrap();
    let mut records = exact.to_vec();
    for output in records.iter_mut().flat_map(|record| &mut record.output_deg) {
        *output += noise.sample(&mut rng);
    }
    let settings = Settings { levels: LEVELS, rate_levels: 1, ..Settings::default() };
    let found = identify(&records, &settings).unwrap();
    let ActuatorLaw::StaticPreisach(law) = found.static_only.law else { panic!("static") };
    (law.map().rises().concat(), found.density_spread.unwrap())
}

/// Deviation over draws against that told of the first, least and largest ratio over the cells well
/// above their bound.
fn ratios(noise_deg: f64) -> [f64; 2] {
    let exact = exact(4.0);
    let (_, told) = fit(&exact, NOISE_DEG, 1000);
    assert_eq!(told.noise_source, NoiseSource::Cycles);
    assert!((told.noise_deg / NOISE_DEG - 1.0).abs() < 0.1, "{}", told.noise_deg);
    let draws: Vec<Vec<f64>> =
        (0..DRAWS).map(|seed| fit(&exact, noise_deg, seed.into()).0).collect();
    let count = f64::from(DRAWS);
    let (mut range, mut cells) = ([f64::INFINITY, 0.0_f64], 0);
    for (cell, told) in told.rise_std_deg.concat().into_iter().enumerate() {
        let mean = draws.iter().map(|own| own[cell]).sum::<f64>() / count;
        let squares: f64 = draws.iter().map(|own| (own[cell] - mean).powi(2)).sum();
        let deviation = (squares / (count - 1.0)).sqrt();
        let Some(told) = told.filter(|_| mean > 4.0 * deviation) else { continue };
        range = [range[0].min(deviation / told), range[1].max(deviation / told)];
        cells += 1;
    }
    assert!(cells >= 15, "{cells} of {} cells", LEVELS * (LEVELS + 1) / 2);
    range
}

#[test]
fn the_spread_of_the_density_is_that_of_repeated_noise() {
    let [least, largest] = ratios(NOISE_DEG);
    assert!(least > 0.75 && largest < 1.25, "{least} to {largest}");
    // the bound sees noise of half the size
    let [least, largest] = ratios(0.5 * NOISE_DEG);
    assert!(least < 0.6 && largest < 0.75, "{least} to {largest}");
}

/// Cells that no record reaches are those of their neighbours; a single cycle tells no noise, so that what
/// the model leaves stands in its place.
#[test]
fn what_no_record_reaches_is_told() {
    let [_, mut small] = exact(1.0);
    small.voltage_volt.truncate(1000);
    small.output_deg.truncate(1000);
    let (_, told) = fit(&[small], NOISE_DEG, 7);
    assert_eq!(told.noise_source, NoiseSource::Residual);
    assert!((told.noise_deg / NOISE_DEG - 1.0).abs() < 0.3, "{}", told.noise_deg);
    let shares: Vec<f64> = told.record_share.concat().into_iter().flatten().collect();
    let of = |is_known: fn(f64) -> bool| shares.iter().filter(|share| is_known(**share)).count();
    assert!(of(|share| share > 0.9) >= 3 && of(|share| share < 0.1) >= 4, "{shares:?}");
}
