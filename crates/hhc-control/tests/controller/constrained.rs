//! The optimum within limits, against enumeration and against what else can be done.

use crate::plants::{Problem, as_t};
use hhc_control::{
    Acceptance, AllowedIncrease, ControlError, ControlLayout, ControlLimits, ControlRun,
    Controller, FeedbackController, FeedbackLaw, FeedbackSettings, FlapCircle, LinearPlant,
    LoadWeights, Measurement, Plant, PowerLimit, RunError, StopReason, TMatrix, VoltageRange,
};
use nalgebra::{DMatrix, DVector};
use proptest::prelude::*;
use std::convert::Infallible;
use std::f64::consts::PI;

fn law(problem: &Problem) -> FeedbackLaw {
    FeedbackLaw::new(&as_t(&problem.t), &LoadWeights::Identity).unwrap()
}

fn loads_cost(problem: &Problem, u: &[f64]) -> f64 {
    problem.loads_cost(&DVector::from_column_slice(u))
}

/// The least cost over a grid in angle and share of the limits that closes in on its best point; the
/// limits are asked for the length of a direction only.
fn brute_force(cost: impl Fn(&[f64]) -> f64, limits: &ControlLimits) -> Vec<f64> {
    let control = |angle: f64, share: f64| {
        let direction = [angle.cos(), angle.sin()];
        let usage = limits.usage(&direction).unwrap();
        [share.clamp(0.0, 1.0) * direction[0] / usage, share.clamp(0.0, 1.0) * direction[1] / usage]
    };
    let mut best = (cost(&[0.0, 0.0]), 0.0, 0.5);
    let mut width = 1.0;
    while width > 1e-9 {
        let (_, angle, share) = best;
        for i in -60..=60 {
            for j in -10..=10 {
                let angle = angle + width * PI * f64::from(i) / 60.0;
                let share = share + width * f64::from(j) / 10.0;
                let value = cost(&control(angle, share));
                if value < best.0 {
                    best = (value, angle, share);
                }
            }
        }
        width *= 0.6;
    }
    control(best.1, best.2).to_vec()
}

fn one_flap() -> (Problem, ControlLayout) {
    let t = DMatrix::from_fn(12, 2, |i, j| (1.0 + 0.9 * i as f64 + 2.1 * j as f64).sin());
    let z0: Vec<f64> = (0..12).map(|i| 3.0 * (0.4 * f64::from(i)).cos()).collect();
    (Problem::new(1, &[3], t, &z0), ControlLayout::new(1, vec![3]).unwrap())
}

#[test]
fn two_variables_meet_a_brute_force_grid() {
    let (problem, layout) = one_flap();
    let z0: Vec<f64> = problem.z0.iter().copied().collect();
    let free = problem.optimum(&[1.0; 12], 0.0);
    let none = ControlLimits::none(&layout);
    let range = VoltageRange {
        range_volt: [-0.4 * free.norm(), 0.9 * free.norm()],
        bias_volt: vec![0.1 * free.norm()],
        bias_slope: Vec::new(),
        azimuths: 720,
    };
    let skewed = FlapCircle {
        gain_deg_per_volt: [[0.06, 0.02], [-0.01, 0.03]],
        limit_deg: 0.02 * free.norm(),
    };
    let power = PowerLimit {
        quadratic: DMatrix::from_row_slice(2, 2, &[2.0, 0.7, 0.7, 0.5]),
        linear: vec![0.03, -0.02],
        constant: 0.1,
        limit: 0.1 + 0.05 * free.norm_squared(),
    };
    let each = [
        none.clone().with_amplitudes_volt(vec![0.5 * free.norm()]).unwrap(),
        none.clone().with_voltage_range(range).unwrap(),
        none.clone().with_flap_circle(0, skewed).unwrap(),
        none.clone().with_power(power.clone()).unwrap(),
        none.with_amplitudes_volt(vec![0.7 * free.norm()])
            .and_then(|l| {
                l.with_flap_circle(0, FlapCircle { limit_deg: 0.03 * free.norm(), ..skewed })
            })
            .and_then(|l| l.with_power(power))
            .unwrap(),
    ];
    for (case, limits) in each.iter().enumerate() {
        let found = law(&problem).optimum_within(0.0, &[0.0; 2], &z0, limits).unwrap();
        assert!(found.binding);
        assert!(found.kkt.largest() <= 1e-8, "case {case}: {:?}", found.kkt);
        assert!(limits.usage(&found.control_volt).unwrap() <= 1.0 + 1e-14);
        let grid = brute_force(|u| loads_cost(&problem, u), limits);
        let (cone, brute) =
            (loads_cost(&problem, &found.control_volt), loads_cost(&problem, &grid));
        assert!((cone / brute - 1.0).abs() <= 1e-6, "case {case}: {cone} against {brute}");
        let distance = (found.control_volt[0] - grid[0]).hypot(found.control_volt[1] - grid[1]);
        assert!(distance <= 1e-4 * free.norm(), "case {case}: off by {distance}");
        println!(
            "case {case}: cone / grid - 1 = {:.1e}, KKT {:.1e}, {} iterations",
            cone / brute - 1.0,
            found.kkt.largest(),
            found.iterations
        );
    }
}

#[test]
fn where_no_limit_binds_it_is_the_fixed_point_of_the_law() {
    let (problem, layout) = one_flap();
    let free = problem.optimum(&[1.0; 12], 0.0);
    let roomy = ControlLimits::none(&layout).with_amplitudes_volt(vec![1.1 * free.norm()]).unwrap();
    let mut plant = limited(problem.plant.clone(), roomy);
    let settings = FeedbackSettings { step_tolerance: 1e-12, ..FeedbackSettings::default() };
    let controller =
        FeedbackController::new(&as_t(&problem.t), &LoadWeights::Identity, settings).unwrap();
    let constrained = controller.run_constrained(&mut plant, 0.0).unwrap();
    let law = controller.run(&mut plant, 0.0).unwrap();
    let u = DVector::from_column_slice(&constrained.last().control_volt);
    assert!((&u - &free).norm() <= 1e-8 * free.norm());
    assert!(
        (u - DVector::from_column_slice(&law.last().control_volt)).norm() <= 1e-8 * free.norm()
    );
    assert!(constrained.kkt.unwrap().largest() <= 1e-12);
}

/// A linear plant whose limits move with the control, as a function gives them.
#[derive(Clone)]
struct Moving<L> {
    plant: LinearPlant,
    limits_at: L,
}

impl<L: Fn(&[f64]) -> ControlLimits> Plant for Moving<L> {
    type Error = Infallible;

    fn layout(&self) -> &ControlLayout {
        self.plant.layout()
    }

    fn measure(&mut self, control_volt: &[f64]) -> Result<Measurement, Infallible> {
        self.plant.measure(control_volt)
    }

    fn strokes_deg(&mut self, control_volt: &[f64]) -> Result<Vec<f64>, Infallible> {
        self.plant.strokes_deg(control_volt)
    }

    fn stroke_limits_deg(&self) -> Vec<f64> {
        self.plant.stroke_limits_deg()
    }

    fn limits(&mut self, control_volt: &[f64]) -> Result<ControlLimits, Infallible> {
        Ok((self.limits_at)(control_volt))
    }
}

/// The same with limits that stand.
fn limited(
    plant: LinearPlant,
    limits: ControlLimits,
) -> Moving<impl Fn(&[f64]) -> ControlLimits + Clone> {
    Moving { plant, limits_at: move |_: &[f64]| limits.clone() }
}

/// Two flaps at 4/rev whose effects nearly cancel, the outboard one four times as strong: the free
/// optimum works them hard against each other.
fn opposed_flaps() -> (Problem, ControlLayout) {
    let t = DMatrix::from_fn(12, 4, |i, j| {
        let common = (0.8 * i as f64 + 1.3 * (j % 2) as f64).sin();
        let own = 0.15 * (1.9 * i as f64 + 0.7 * j as f64).cos();
        if j < 2 { common + own } else { 4.0 * common - own }
    });
    let wanted = DVector::from_vec(vec![-6.0, 4.0, 1.5, -1.0]);
    let rest = DVector::from_fn(12, |i, _| 0.6 * (1.7 * i as f64).cos());
    let z0: Vec<f64> = (rest - &t * wanted).iter().copied().collect();
    (Problem::new(2, &[4], t, &z0), ControlLayout::new(2, vec![4]).unwrap())
}

/// Numbers in -1..1, uniform and always the same.
fn uniform(seed: u64) -> impl FnMut() -> f64 {
    let mut state = seed;
    move || {
        state =
            state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1_442_695_040_888_963_407);
        (state >> 11) as f64 / (1_u64 << 52) as f64 - 1.0
    }
}

/// `J / J0` of the cone optimum, of the best random control, of the weighted and of the clipped one.
fn compared(problem: &Problem, layout: &ControlLayout, limit_volt: [f64; 2]) -> [f64; 4] {
    let room = 0.95 * limit_volt[0].max(limit_volt[1]);
    let limits = ControlLimits::none(layout)
        .with_amplitudes_volt(limit_volt.to_vec())
        .and_then(|l| {
            l.with_voltage_range(VoltageRange {
                range_volt: [-room, 1.2 * room],
                bias_volt: vec![0.05; 2],
                bias_slope: Vec::new(),
                azimuths: 720,
            })
        })
        .unwrap();
    let z0: Vec<f64> = problem.z0.iter().copied().collect();
    let found = law(problem).optimum_within(0.0, &[0.0; 4], &z0, &limits).unwrap();
    let cone = loads_cost(problem, &found.control_volt);
    assert!(found.binding && found.kkt.largest() <= 1e-8, "{:?}", found.kkt);

    let mut random = uniform(7);
    let mut best = f64::INFINITY;
    for _ in 0..10_000 {
        let u: Vec<f64> = (0..4).map(|k| limit_volt[k / 2] * random()).collect();
        let usage = limits.usage(&u).unwrap();
        // one half inside, one half just keeping the limits
        let part = if random() < 0.0 { usage.max(1.0) } else { usage };
        let u: Vec<f64> = u.iter().map(|v| v / part).collect();
        best = best.min(loads_cost(problem, &u));
    }

    // the control weight for which every limit is kept: bisection on the usage of the law's optimum
    let law = law(problem);
    let (mut low, mut high) = (-30.0_f64, 30.0_f64);
    for _ in 0..100 {
        let middle = f64::midpoint(low, high);
        let u = law.optimum_volt(middle.exp(), &[0.0; 4], &z0).unwrap();
        if limits.usage(&u).unwrap() > 1.0 { low = middle } else { high = middle }
    }
    let weighted = loads_cost(problem, &law.optimum_volt(high.exp(), &[0.0; 4], &z0).unwrap());

    // the unconstrained step, clipped pair by pair
    let free = problem.optimum(&[1.0; 12], 0.0);
    let clipped: Vec<f64> = free
        .as_slice()
        .chunks_exact(2)
        .zip(limit_volt)
        .flat_map(|(u, limit)| {
            let part = (limit / u[0].hypot(u[1])).min(1.0);
            [part * u[0], part * u[1]]
        })
        .collect();
    [cone, best, weighted, loads_cost(problem, &clipped)].map(|j| j / problem.z0.norm_squared())
}

#[test]
fn binding_limits_beat_random_search_weighting_and_the_clipped_step() {
    let (problem, layout) = opposed_flaps();
    for (limit_volt, trapped) in [([2.0, 2.0], true), ([2.0, 0.3], false), ([0.5, 0.5], false)] {
        let [cone, random, weighted, clipped] = compared(&problem, &layout, limit_volt);
        println!(
            "limits {limit_volt:?}: J / J0 cone {cone:.4}, random {random:.4}, weighted {weighted:.4}, clipped {clipped:.4}"
        );
        assert!(cone <= random && cone <= weighted && cone < 1.0);
        if trapped {
            assert!(clipped > 1.2, "the clipped step is worse than no control: {clipped}");
        }
    }
}

#[test]
fn four_harmonics_together_keep_the_range_at_every_azimuth() {
    let layout = ControlLayout::new(2, vec![2, 3, 4, 5]).unwrap();
    let mut random = uniform(3);
    let t = DMatrix::from_fn(12, 16, |_, _| random());
    let z0: Vec<f64> = (0..12).map(|_| 20.0 * random()).collect();
    let problem = Problem::new(2, &[2, 3, 4, 5], t, &z0);
    let limits = ControlLimits::none(&layout)
        .with_amplitudes_volt(vec![3.0, 2.5, 2.0, 1.5, 3.0, 2.5, 2.0, 1.5])
        .and_then(|l| {
            l.with_voltage_range(VoltageRange {
                range_volt: [-2.0, 4.0],
                bias_volt: vec![0.9, 1.2],
                bias_slope: Vec::new(),
                azimuths: 720,
            })
        })
        .unwrap();
    let rho = 1e-8 * law(&problem).singular_values()[0].powi(2);
    let found = law(&problem).optimum_within(rho, &[0.0; 16], &z0, &limits).unwrap();
    assert!(found.kkt.largest() <= 1e-6, "{:?}", found.kkt);
    let usage = limits.usage(&found.control_volt).unwrap();
    assert!((1.0 - 1e-6..=1.0 + 1e-12).contains(&usage), "{usage}");
    // the range binds, not the circles alone
    let amplitudes = layout.amplitudes_volt(&found.control_volt).unwrap();
    assert!(amplitudes.iter().zip([3.0, 2.5, 2.0, 1.5].iter().cycle()).any(|(a, l)| *a < 0.99 * l));
    let cost = loads_cost(&problem, &found.control_volt);
    for _ in 0..10_000 {
        let u: Vec<f64> = (0..16).map(|_| 3.0 * random()).collect();
        let usage = limits.usage(&u).unwrap();
        let u: Vec<f64> = u.iter().map(|v| v / usage).collect();
        assert!(cost <= loads_cost(&problem, &u));
    }
    println!("KKT {:.1e}, {} iterations", found.kkt.largest(), found.iterations);
}

proptest! {
    #![proptest_config(ProptestConfig::with_cases(60))]

    #[test]
    fn the_kkt_residual_is_small_always(
        numbers in prop::collection::vec(-1.0..1.0_f64, 12 * 8),
        baseline in prop::collection::vec(-1.0..1.0_f64, 12),
        exponent in -7.0..1.0_f64,
        limit in 0.01..2.0_f64,
        bias in 0.2..0.8_f64,
    ) {
        // loads in rotor units per volt, limits in volt
        let t = DMatrix::from_vec(12, 8, numbers) * 10.0_f64.powf(exponent);
        let z0: Vec<f64> = baseline.iter().map(|z| z * 10.0_f64.powf(exponent)).collect();
        let problem = Problem::new(2, &[2, 3], t, &z0);
        let layout = ControlLayout::new(2, vec![2, 3]).unwrap();
        let circle =
            FlapCircle { gain_deg_per_volt: [[0.05, 0.02], [-0.02, 0.05]], limit_deg: 0.04 * limit };
        let limits = ControlLimits::none(&layout)
            .with_amplitudes_volt(vec![limit, 2.0 * limit, f64::INFINITY, limit])
            .and_then(|l| l.with_flap_circle(2, circle))
            .and_then(|l| l.with_voltage_range(VoltageRange {
                range_volt: [0.0, 2.0 * limit], bias_volt: vec![2.0 * bias * limit; 2], bias_slope: Vec::new(), azimuths: 360,
            }))
            .unwrap();
        let found = law(&problem).optimum_within(0.0, &[0.0; 8], &z0, &limits).unwrap();
        prop_assert!(found.kkt.largest() <= 1e-6, "{:?}", found.kkt);
        prop_assert!(limits.usage(&found.control_volt).unwrap() <= 1.0 + 1e-12);
    }
}

#[test]
fn the_loop_walks_to_the_constrained_optimum_with_a_wrong_t() {
    // full steps correct what T gets wrong; the limits never give way
    let (problem, layout) = opposed_flaps();
    let limits = ControlLimits::none(&layout).with_amplitudes_volt(vec![2.0; 2]).unwrap();
    let z0: Vec<f64> = problem.z0.iter().copied().collect();
    let exact = law(&problem).optimum_within(0.0, &[0.0; 4], &z0, &limits).unwrap();
    let mut plant = limited(problem.plant.clone(), limits);
    let settings = FeedbackSettings { step_tolerance: 1e-6, ..FeedbackSettings::default() };
    for controller in [Controller::Local { step_volt: vec![0.1; 4] }, Controller::Global] {
        let t0 = problem.distorted_t(1.1, 8.0);
        let run = FeedbackController::new(&t0, &LoadWeights::Identity, settings.clone())
            .and_then(|c| c.with_controller(controller.clone()))
            .unwrap()
            .run_constrained(&mut plant, 0.0)
            .unwrap();
        let cost = run.last().cost.loads;
        let best = loads_cost(&problem, &exact.control_volt);
        println!("{}: J / J* - 1 = {:.2e}, {:?}", controller.name(), cost / best - 1.0, run.stop);
        assert!(run.kkt.unwrap().largest() <= 1e-6);
        if controller != Controller::Global {
            assert_eq!(run.stop, StopReason::Converged);
            assert!((cost / best - 1.0).abs() <= 1e-8);
        }
        assert!(cost < run.start.cost.loads);
    }
}

/// A plant whose linearised solution is wrong by a gain and a phase, wherever it is asked for.
struct Misjudged<L> {
    limited: Moving<L>,
    t: TMatrix,
}

impl<L: Fn(&[f64]) -> ControlLimits> Plant for Misjudged<L> {
    type Error = Infallible;

    fn layout(&self) -> &ControlLayout {
        self.limited.layout()
    }

    fn measure(&mut self, control_volt: &[f64]) -> Result<Measurement, Infallible> {
        self.limited.measure(control_volt)
    }

    fn strokes_deg(&mut self, control_volt: &[f64]) -> Result<Vec<f64>, Infallible> {
        self.limited.strokes_deg(control_volt)
    }

    fn stroke_limits_deg(&self) -> Vec<f64> {
        self.limited.stroke_limits_deg()
    }

    fn limits(&mut self, control_volt: &[f64]) -> Result<ControlLimits, Infallible> {
        self.limited.limits(control_volt)
    }

    fn linearised_t(&mut self, _: &[f64]) -> Result<Option<TMatrix>, Infallible> {
        Ok(Some(self.t.clone()))
    }
}

/// At the limits the slope of the cost is nearly nothing: a T wrong by a little points uphill there, and
/// the correction along the rejected step lets the loop go on where the constant T stalls. (Where the loop
/// ends it is by the promise of the T it knows.)
#[test]
fn a_local_t_that_is_wrong_everywhere_learns_from_rejected_steps() {
    let (problem, layout) = opposed_flaps();
    let limits = ControlLimits::none(&layout).with_amplitudes_volt(vec![2.0; 2]).unwrap();
    let z0: Vec<f64> = problem.z0.iter().copied().collect();
    let exact = law(&problem).optimum_within(0.0, &[0.0; 4], &z0, &limits).unwrap();
    let best = loads_cost(&problem, &exact.control_volt);
    let tolerance = 1e-5;
    let mut stalled = 0;
    for (gain, phase_deg) in [(1.05, 3.0), (1.1, 8.0), (0.85, -12.0), (1.0, 25.0)] {
        let t = problem.distorted_t(gain, phase_deg);
        let limited = limited(problem.plant.clone(), limits.clone());
        let settings = FeedbackSettings {
            acceptance: Acceptance::Monotone { cost_tolerance: tolerance },
            ..FeedbackSettings::default()
        };
        let run = |way: Controller| {
            FeedbackController::new(&t, &LoadWeights::Identity, settings.clone())
                .and_then(|c| c.with_controller(way))
                .unwrap()
                .run_constrained(&mut Misjudged { limited: limited.clone(), t: t.clone() }, 0.0)
                .unwrap()
        };
        let held = run(Controller::Global);
        let learnt = run(Controller::Local { step_volt: vec![0.1; 4] });
        let above = |run: &ControlRun| (run.last().cost.loads - best) / run.start.cost.loads;
        println!(
            "gain {gain}, {phase_deg} deg: held {:?} {:.1e} above the optimum; learnt {:?} {:.1e}, {} measurements",
            held.stop,
            above(&held),
            learnt.stop,
            above(&learnt),
            learnt.measurements
        );
        stalled += usize::from(held.stop == StopReason::Stalled);
        assert_eq!(learnt.stop, StopReason::Converged, "gain {gain}, {phase_deg} deg");
        let (held_above, learnt_above) = (above(&held), above(&learnt));
        assert!(learnt_above <= held_above * (1.0 + 1e-9), "{learnt_above} {held_above}");
        if held.stop == StopReason::Stalled {
            assert!(learnt_above <= 0.5 * held_above, "{learnt_above} {held_above}");
        }
    }
    assert!(stalled >= 2);
}

#[test]
fn limits_of_another_layout_are_refused() {
    let (problem, _) = one_flap();
    let other = ControlLimits::none(&ControlLayout::new(2, vec![3]).unwrap());
    let mut plant = limited(problem.plant.clone(), other);
    let controller = FeedbackController::new(
        &as_t(&problem.t),
        &LoadWeights::Identity,
        FeedbackSettings::default(),
    )
    .unwrap();
    let refused = controller.run_constrained(&mut plant, 0.0);
    assert!(matches!(refused, Err(RunError::Control(ControlError::Length { .. }))), "{refused:?}");
}

/// Limits that give way by as much as they are left: each step to the optimum within them is a step out of
/// them, and back, for ever, unless the loop looks between the two.
#[test]
fn a_loop_that_goes_to_and_fro_over_its_limits_ends_between() {
    let t = DMatrix::from_row_slice(2, 2, &[1.0, 0.0, 0.0, 1.0]);
    let problem = Problem::new(1, &[3], t, &[-8.0, -6.0]);
    let controller = FeedbackController::new(
        &as_t(&problem.t),
        &LoadWeights::Identity,
        FeedbackSettings::default(),
    )
    .unwrap();
    let layout = problem.plant.layout().clone();
    let limits_at = |u: &[f64]| {
        let limit = (4.0 - u[0].hypot(u[1])).clamp(1.5, 2.5);
        ControlLimits::none(&layout).with_amplitudes_volt(vec![limit]).unwrap()
    };
    let mut giving = Moving { plant: problem.plant, limits_at };
    let run = controller.run_constrained(&mut giving, 0.0).unwrap();
    assert_eq!(run.stop, StopReason::Converged);
    assert!(run.steps.len() <= 4, "{} steps", run.steps.len());
    let u = &run.last().control_volt;
    assert!((u[0] - 1.6).abs() < 1e-4 && (u[1] - 1.2).abs() < 1e-4, "{u:?}");
    assert_eq!(
        run.steps[1].allowed_increase,
        AllowedIncrease::Restoration,
        "the way back raises the cost, and says why"
    );
}

/// Two flaps whose limits move with the control of the other one: the optimum within them turns by a quarter about
/// one volt each, and a little farther out each time.
#[test]
fn a_loop_that_runs_round_in_its_limits_ends_in_the_middle() {
    let t = DMatrix::identity(4, 4);
    let problem = Problem::new(2, &[3], t, &[-8.0, 0.0, -6.0, 0.0]);
    let settings = FeedbackSettings { max_steps: 60, ..FeedbackSettings::default() };
    let controller =
        FeedbackController::new(&as_t(&problem.t), &LoadWeights::Identity, settings).unwrap();
    let layout = problem.plant.layout().clone();
    let limits_at = |u: &[f64]| {
        let [first, second] = [u[0].hypot(u[1]), u[2].hypot(u[3])];
        let limits = [1.0 + 1.05 * (second - 1.0), 1.0 - 1.05 * (first - 1.0)];
        let limits = limits.map(|limit| limit.clamp(0.5, 1.5)).to_vec();
        ControlLimits::none(&layout).with_amplitudes_volt(limits).unwrap()
    };
    let mut turning = Moving { plant: problem.plant, limits_at };
    let run = controller.run_constrained(&mut turning, 0.0).unwrap();
    let u = &run.last().control_volt;
    println!("{:?} after {} steps: {u:?}", run.stop, run.steps.len());
    // within a thousandth of limits that move a step back need not be
    assert_ne!(run.stop, StopReason::StepLimit);
    assert!((u[0] - 1.0).abs() < 1e-3 && (u[2] - 1.0).abs() < 1e-3, "{u:?}");
}

/// A flap whose bias moves with its own control by a known slope, and a plant that refuses every voltage beyond its range, as
/// an actuator does.
struct Biased {
    plant: LinearPlant,
    slope: [f64; 2],
    /// Whether the limits tell of it.
    is_told: bool,
}

impl Biased {
    const RANGE_VOLT: [f64; 2] = [-1.0, 1.0];

    fn bias_volt(&self, u: &[f64]) -> f64 {
        self.slope[0] * u[0] + self.slope[1] * u[1]
    }

    /// How far the voltage goes beyond its range, V; for one harmonic it swings by the amplitude.
    fn beyond_volt(&self, u: &[f64]) -> f64 {
        let [low, high] = Self::RANGE_VOLT;
        let (bias, amplitude) = (self.bias_volt(u), u[0].hypot(u[1]));
        (bias + amplitude - high).max(low - bias + amplitude)
    }
}

impl Plant for Biased {
    type Error = Infallible;

    fn layout(&self) -> &ControlLayout {
        self.plant.layout()
    }

    fn measure(&mut self, control_volt: &[f64]) -> Result<Measurement, Infallible> {
        self.plant.measure(control_volt)
    }

    fn strokes_deg(&mut self, control_volt: &[f64]) -> Result<Vec<f64>, Infallible> {
        self.plant.strokes_deg(control_volt)
    }

    fn stroke_limits_deg(&self) -> Vec<f64> {
        self.plant.stroke_limits_deg()
    }

    fn admits(&self, control_volt: &[f64]) -> bool {
        // a peak between two azimuths of the limits may lie beyond by the square of half their distance
        self.beyond_volt(control_volt) <= 1e-5
    }

    fn limits(&mut self, u: &[f64]) -> Result<ControlLimits, Infallible> {
        let (bias_volt, bias_slope) =
            if self.is_told { (0.0, self.slope.to_vec()) } else { (self.bias_volt(u), Vec::new()) };
        let voltage = VoltageRange {
            range_volt: Self::RANGE_VOLT,
            bias_volt: vec![bias_volt],
            bias_slope,
            azimuths: 720,
        };
        Ok(ControlLimits::none(self.layout()).with_voltage_range(voltage).unwrap())
    }
}

/// The voltage of one harmonic swings by `|u|` about `s'u`: within `|V| <= 1` that is the ellipse `|u| + |s'u| <= 1`, whose
/// best point for `|u - (2, 1)|` is enumerated along its edge.
#[test]
fn a_step_to_the_edge_of_the_range_takes_the_bias_with_it() {
    let slope = [0.15, -0.25];
    let problem = Problem::new(1, &[2], DMatrix::identity(2, 2), &[-2.0, -1.0]);
    let edge = (0..200_000).map(|k| {
        let (s, c) = (2.0 * PI * f64::from(k) / 200_000.0).sin_cos();
        let size = 1.0 / (1.0 + (slope[0] * c + slope[1] * s).abs());
        [size * c, size * s]
    });
    let best = edge.map(|u| loads_cost(&problem, &u)).fold(f64::INFINITY, f64::min);
    let settings = FeedbackSettings { max_steps: 60, ..FeedbackSettings::default() };
    let run = |is_told| {
        FeedbackController::new(&as_t(&problem.t), &LoadWeights::Identity, settings.clone())
            .unwrap()
            .run_constrained(&mut Biased { plant: problem.plant.clone(), slope, is_told }, 0.0)
            .unwrap()
    };
    let (told, untold) = (run(true), run(false));
    for (name, run) in [("told", &told), ("untold", &untold)] {
        println!(
            "{name}: {:?}, {} steps, {} halvings, J / J* - 1 = {:.1e}",
            run.stop,
            run.steps.len(),
            run.backtracks,
            run.last().cost.loads / best - 1.0
        );
    }
    assert_eq!((told.stop, told.steps.len(), told.backtracks), (StopReason::Converged, 1, 0));
    assert!((told.last().cost.loads / best - 1.0).abs() <= 1e-4);
    assert!(untold.backtracks > 0 && untold.steps.len() > 1, "the bias does not matter here");
}
