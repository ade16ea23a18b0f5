//! The actuator: laws and stages against their closed forms.

use std::f64::consts::TAU;
use std::sync::LazyLock;

use preisach_dyn::{
    Accommodation, ActuatorLaw, ActuatorModel, AmplifierStage, Backlash, Calibration,
    CoulombFriction, DielectricHeating, Drive, DynamicParameters, DynamicPreisach, HysteresisLaw,
    KelvinVoigt, KelvinVoigtElement, Lag, LinkageStage, LoadStiffness, LogCreep, PlayMap,
    PrandtlStop, PreisachError, RateForm, Resonance, StartState, StaticPreisach, StopParameters,
    TimeOrder, VoltageRange, WeightedStop,
};

use crate::actuator::{grid_and_map, wander};
use crate::oracles::relays::RelayGrid;
use validation::{Check, Failure, row, worst};

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-ACT-10",
        "relay grid against play form: order in the relay's size, 2 to 16 relays \
         per cell",
        "–",
    )
    .against("a relay is a staircase of the play")
    .between(0.9, 1.1, relay_order),
    row("V-ACT-12", "implicit Euler on a lag under a sine: order in the step", "–")
        .against("closed form")
        .between(0.9, 1.1, || time_order(TimeOrder::First)),
    row("V-ACT-13", "second-order step on a lag under a sine: order in the step", "–")
        .against("closed form")
        .between(1.9, 2.1, || time_order(TimeOrder::Second)),
    row("V-ACT-14", "lag under a ramp, steps of twice its time constant", "–")
        .against("closed form")
        .at_most(1e-10, lag),
    row("V-ACT-15", "Kelvin-Voigt element after a move over one step", "–")
        .against("closed form")
        .at_most(1e-10, kelvin_voigt),
    row("V-ACT-16", "logarithmic creep of 1.5 %: rise per decade, 1 to 100 s", "–")
        .against("y = U (1 + rate log10 t), Jung and Gweon")
        .near(0.015, 2e-4, creep),
    row("V-ACT-17", "resonance under a ramp, steps of a third of its period", "–")
        .against("closed form")
        .at_most(1e-10, resonance),
    row("V-ACT-18", "backlash of 3 um: width of the loop, off by", "–")
        .against("closed form")
        .at_most(1e-10, backlash),
    row("V-ACT-19", "Coulomb friction: way of the input behind long monotone moves", "–")
        .against("closed form")
        .at_most(1e-10, friction),
    row("V-ACT-20", "accommodation of 20 %: long monotone moves", "–")
        .against("closed form")
        .at_most(1e-10, || {
            let stage = Accommodation { share: 0.2, travel_um: 40.0 };
            long_moves(LinkageStage::Accommodation(stage), 40.0, 0.2)
        }),
    row("V-ACT-21", "load spring a quarter as stiff: gain, off 1/1.25 by", "–")
        .against("closed form")
        .at_most(1e-10, load),
    row("V-ACT-22", "dielectric heating at 10 Hz, 80 V: steady rise", "K")
        .against("f A^2 times the rise of the material")
        .near(6.4, 0.01, heating),
    row(
        "V-ACT-23",
        "stops: area of steady loops against 4 sum w r (A - r), largest difference",
        "–",
    )
    .against("closed form")
    .at_most(1e-10, stop_area),
    row("V-ACT-24", "stop and play of one half-width: sum off the input by", "–")
        .against("closed form")
        .at_most(1e-10, stop_and_play),
];

/// Gain 1 deg/V, zero at 0 V, 1 deg/um: a stage's output can be read off in its own unit.
fn unit() -> Result<ActuatorModel, Failure> {
    let range = VoltageRange::new(-1e4, 1e4)?;
    let calibration = Calibration { deg_per_um: 1.0, zero_um: 0.0 };
    Ok(ActuatorModel { calibration, ..ActuatorModel::linear(range, 1e4, 1.0) })
}

fn behind(stage: LinkageStage, input: &[f64], step_s: f64) -> Result<Vec<f64>, Failure> {
    let model = ActuatorModel { linkage: vec![stage], ..unit()? };
    Ok(model.simulate(input, step_s)?.output_deg)
}

/// Largest distance of `output` from a function of time.
fn off(output: &[f64], step_s: f64, exact: impl Fn(f64) -> f64) -> f64 {
    let differences = output.iter().enumerate().map(|(i, y)| (y - exact(i as f64 * step_s)).abs());
    differences.fold(0.0, f64::max)
}

/// Slope of `ln error` over `ln size` between the first and the last.
fn order(sizes: &[f64], errors: &[f64]) -> f64 {
    let ends = |v: &[f64]| v.first().zip(v.last()).map_or(f64::NAN, |(a, b)| (a / b).ln());
    ends(errors) / ends(sizes)
}

fn relay_order() -> Result<f64, Failure> {
    let (grid, map) = grid_and_map()?;
    let plays = StaticPreisach::new(grid, map)?;
    let history = wander(11, 400);
    let parts = [2_u32, 4, 8, 16];
    let errors = parts.map(|parts| {
        let relays = RelayGrid::of(&plays, parts);
        let (mut a, _) = plays.start(65.0, StartState::RisingFromLowest);
        let (mut b, _) = relays.start(65.0, StartState::RisingFromLowest);
        let squares =
            history.iter().map(|&u| (plays.step(&mut a, u, 1.0) - relays.step(&mut b, u)).powi(2));
        (squares.sum::<f64>() / history.len() as f64).sqrt()
    });
    Ok(order(&parts.map(|p| 1.0 / f64::from(p)), &errors))
}

fn time_order(time_order: TimeOrder) -> Result<f64, Failure> {
    let (lag_s, hz) = (0.02, 5.0);
    let (grid, _) = grid_and_map()?;
    let levels = grid.levels();
    // a straight line: only the plays of no width rise
    let rises: Vec<Vec<f64>> =
        (0..levels).map(|j| vec![if j == 0 { 1.0 } else { 0.0 }; levels - j]).collect();
    let law = DynamicPreisach::new(DynamicParameters {
        grid,
        g0_deg: PlayMap::from_rises(&grid, 0.0, &rises)?,
        g1_s: PlayMap::constant(&grid, -lag_s),
        g2_s2_per_deg: PlayMap::constant(&grid, 0.0),
        form: RateForm::WellPosed,
        unfolded_rate_deg_s: 1e4,
        time_order,
    })?;
    let calibration = Calibration { deg_per_um: 1.0, zero_um: 0.0 };
    let model = ActuatorModel::new(ActuatorLaw::DynamicPreisach(law), grid.range(), calibration);
    let gain = levels as f64 / grid.range().span_volt();
    let omega = TAU * hz;
    let steps = [100_u32, 200, 400];
    let errors = steps.map(|per_cycle| -> Result<f64, Failure> {
        let step_s = 1.0 / hz / f64::from(per_cycle);
        let volts: Vec<f64> = (0..=3 * per_cycle)
            .map(|i| -15.0 + 80.0 * (1.0 - (omega * step_s * f64::from(i)).cos()))
            .collect();
        let output = model.simulate(&volts, step_s)?.output_deg;
        let first = output[0];
        // from rest: the lag of 1 - cos
        let x = omega * lag_s;
        let exact = |t: f64| {
            let (s, c) = (omega * t).sin_cos();
            let decay = (-t / lag_s).exp();
            first + gain * 80.0 * (1.0 - decay - (c + x * s - decay) / (1.0 + x * x))
        };
        Ok(off(&output, step_s, exact))
    });
    let errors = errors.into_iter().collect::<Result<Vec<_>, _>>()?;
    Ok(order(&steps.map(|n| 1.0 / f64::from(n)), &errors))
}

fn ramp(samples: u32, rise: f64) -> Vec<f64> {
    (0..samples).map(|i| rise * f64::from(i)).collect()
}

fn lag() -> Result<f64, Failure> {
    let (tau_s, step_s) = (0.01, 0.02);
    let stage = AmplifierStage::Lag(Lag { tau_s });
    let model = ActuatorModel { amplifier: vec![stage], ..unit()? };
    let output = model.simulate(&ramp(20, 1.0), step_s)?.output_deg;
    Ok(off(&output, step_s, |t| (t - tau_s * (1.0 - (-t / tau_s).exp())) / step_s))
}

/// From 0 to 1 over the first step, then held.
fn step(samples: usize) -> Vec<f64> {
    let mut input = vec![1.0; samples];
    input[0] = 0.0;
    input
}

fn kelvin_voigt() -> Result<f64, Failure> {
    let (c, tau_s, step_s) = (0.05, 0.3, 0.1);
    let element = KelvinVoigtElement { compliance_ratio: c, time_constant_s: tau_s };
    let stage = LinkageStage::KelvinVoigt(KelvinVoigt { elements: vec![element] });
    let output = behind(stage, &step(60), step_s)?;
    let lead = tau_s / step_s * ((step_s / tau_s).exp() - 1.0);
    let exact = |t: f64| if t == 0.0 { 0.0 } else { 1.0 + c * (1.0 - lead * (-t / tau_s).exp()) };
    Ok(off(&output, step_s, exact))
}

fn creep() -> Result<f64, Failure> {
    let output = behind(LinkageStage::LogCreep(LogCreep::new(0.015)), &step(10_001), 0.01)?;
    Ok(0.5 * (output[10_000] - output[100]))
}

fn resonance() -> Result<f64, Failure> {
    let (frequency_hz, zeta, step_s) = (50.0, 0.05, 1.0 / 150.0);
    let stage = LinkageStage::Resonance(Resonance { frequency_hz, damping_ratio: zeta });
    let output = behind(stage, &ramp(60, 1.0), step_s)?;
    let omega = TAU * frequency_hz;
    let damped = omega * (1.0 - zeta * zeta).sqrt();
    let exact = |t: f64| {
        let (s, c) = (damped * t).sin_cos();
        let free = 2.0 * zeta / omega * c + (2.0 * zeta * zeta - 1.0) / damped * s;
        (t - 2.0 * zeta / omega + (-zeta * omega * t).exp() * free) / step_s
    };
    Ok(off(&output, step_s, exact))
}

fn backlash() -> Result<f64, Failure> {
    let width_um = 3.0;
    let input = [0.0, 10.0, 0.0, -10.0, 0.0];
    let output = behind(LinkageStage::Backlash(Backlash { width_um }), &input, 1.0)?;
    Ok((output[2] - output[4] - width_um).abs())
}

/// `|dx| = d + (r - sgn e)(1 - exp(-10 d / r))` of each move, `d` the way of the output: largest difference.
fn friction() -> Result<f64, Failure> {
    let (input, r) = ([0.0, 7.0, 90.0, 60.0, -40.0, 55.0], 3.0);
    let stage = LinkageStage::CoulombFriction(CoulombFriction { width_um: 2.0 * r });
    let output = behind(stage, &input, 1.0)?;
    let moves = input.windows(2).zip(output.windows(2)).map(|(x, y)| {
        let (way, d) = ((x[1] - x[0]).abs(), (y[1] - y[0]).abs());
        let left = r - (x[1] - x[0]).signum() * (x[0] - y[0]);
        (way - d - left * (1.0 - (-10.0 * d / r).exp())).abs()
    });
    Ok(moves.fold(0.0, f64::max))
}

/// Up, down and up again by a long way: what stays behind tends to `way` exponentially.
fn long_moves(stage: LinkageStage, way: f64, share: f64) -> Result<f64, Failure> {
    let input = [0.0, 7.0, 90.0, 60.0, -40.0, 55.0];
    let output = behind(stage, &input, 1.0)?;
    let (mut behind, mut last, mut largest) = (0.0, 0.0, 0.0_f64);
    for (u, y) in input.iter().zip(output) {
        let change: f64 = u - last;
        let goal = way * change.signum();
        behind = goal + (behind - goal) * (-change.abs() / way).exp();
        last = *u;
        largest = largest.max((y - (u - share * behind)).abs());
    }
    Ok(largest)
}

fn load() -> Result<f64, Failure> {
    let stage = LoadStiffness { stiffness_ratio: 0.25, compliance_um_per_newton: 0.0 };
    let output = behind(LinkageStage::LoadStiffness(stage), &[0.0, 50.0], 1.0)?;
    Ok((output[1] / 50.0 - 0.8).abs())
}

fn heating() -> Result<f64, Failure> {
    let (tau_s, hz, amplitude) = (2.0, 10.0, 80.0);
    let heating =
        DielectricHeating { rise_k_per_volt2_hz: 1e-4, ..DielectricHeating::new(tau_s, 1e-3) };
    let stage = AmplifierStage::DielectricHeating(heating);
    let model = ActuatorModel { amplifier: vec![stage], ..unit()? };
    let step_s = 1.0 / hz / 200.0;
    let input: Vec<f64> =
        (0..40_000).map(|i| amplitude * (TAU * hz * step_s * f64::from(i)).sin()).collect();
    let bench = model.simulate_bench(&Drive::new(&input, step_s))?;
    Ok(bench.temperature_k.iter().rev().take(200).sum::<f64>() / 200.0)
}

/// Stops whose thresholds lie on sixty-fourths.
static STOPS: LazyLock<Result<PrandtlStop, PreisachError>> = LazyLock::new(|| {
    let stop = |threshold_volt, stiffness_deg_per_volt| WeightedStop {
        threshold_volt,
        stiffness_deg_per_volt,
    };
    PrandtlStop::new(StopParameters {
        range_volt: VoltageRange::new(-1.0, 1.0)?,
        stiffness_deg_per_volt: 0.1,
        stops: vec![stop(0.0625, 1.0), stop(0.125, 0.5), stop(0.25, 2.0), stop(0.5, 0.25)],
        viscosity_deg_s_per_volt: 0.0,
        offset_deg: 0.3,
    })
});

fn stops() -> Result<&'static PrandtlStop, Failure> {
    STOPS.as_ref().map_err(|error| error.clone().into())
}

fn stop_area() -> Result<f64, Failure> {
    let law = stops()?;
    let differences = [8_i32, 24, 48, 64].map(|steps| {
        let around: Vec<f64> = (0..=steps)
            .chain((-steps..steps).rev())
            .chain(-steps + 1..=0)
            .map(|i| f64::from(i) / 64.0)
            .collect();
        let (mut memory, mut y) = law.start(0.0, StartState::Rest);
        let mut areas = [0.0; 2];
        for area in &mut areas {
            for pair in around.windows(2) {
                let next = law.step(&mut memory, pair[1], 1.0);
                *area += 0.5 * (y + next) * (pair[1] - pair[0]);
                y = next;
            }
        }
        Ok((areas[1] - law.loop_area_deg_volt(f64::from(steps) / 64.0)).abs())
    });
    worst("amplitudes", 4, differences)
}

fn stop_and_play() -> Result<f64, Failure> {
    let (mut memory, _) = stops()?.start(0.0, StartState::Rest);
    let radii: Vec<f64> = stops()?.parameters().stops.iter().map(|s| s.threshold_volt).collect();
    let mut plays = vec![0.0_f64; radii.len()];
    let mut largest = 0.0_f64;
    for voltage in wander(5, 2000) {
        let u = (voltage - 65.0) / 85.0;
        stops()?.step(&mut memory, u, 1.0);
        for ((play, r), stop) in plays.iter_mut().zip(&radii).zip(memory.stops_volt()) {
            *play = play.clamp(u - r, u + r);
            largest = largest.max((stop + *play - u).abs());
        }
    }
    Ok(largest)
}
