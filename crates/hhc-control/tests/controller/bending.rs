//! A plant whose loads bend and do not vanish at the optimum: a parabola across the way.

use hhc_control::{
    Acceptance, ControlLayout, ControlLimits, Controller, FeedbackController, FeedbackSettings,
    LoadWeights, Measurement, Plant, StopReason, TMatrix,
};
use rotor_base::Harmonic;
use std::convert::Infallible;

/// `Z = (1 + bend u_s^2 / 2, weak (u_s - 1), u_c - 1)`: the cost along `u_s` is
/// `weak^2 (u_s - 1)^2 + (1 + bend u_s^2 / 2)^2`, of which T sees the first term where `u_s` is small.
struct Bent {
    layout: ControlLayout,
    weak: f64,
    bend: f64,
}

impl Bent {
    fn loads(&self, u: &[f64]) -> Vec<f64> {
        vec![1.0 + 0.5 * self.bend * u[1] * u[1], self.weak * (u[1] - 1.0), u[0] - 1.0]
    }

    /// The optimum: `weak^2 (u_s - 1) + bend u_s (1 + bend u_s^2 / 2) = 0`, by bisection.
    fn optimum(&self) -> f64 {
        let slope = |u: f64| {
            self.weak.powi(2) * (u - 1.0) + self.bend * u * (1.0 + 0.5 * self.bend * u * u)
        };
        let (mut low, mut high) = (0.0, 1.0);
        for _ in 0..60 {
            let middle = f64::midpoint(low, high);
            *(if slope(middle) < 0.0 { &mut low } else { &mut high }) = middle;
        }
        low
    }
}

impl Plant for Bent {
    type Error = Infallible;

    fn layout(&self) -> &ControlLayout {
        &self.layout
    }

    fn measure(&mut self, control_volt: &[f64]) -> Result<Measurement, Infallible> {
        Ok(Measurement {
            outputs: self.loads(control_volt),
            flap_motion_deg: vec![Harmonic { cosine: control_volt[0], sine: control_volt[1] }],
            mean_flap_deg: vec![0.0],
        })
    }

    fn strokes_deg(&mut self, control_volt: &[f64]) -> Result<Vec<f64>, Infallible> {
        Ok(vec![control_volt[0].hypot(control_volt[1])])
    }

    fn stroke_limits_deg(&self) -> Vec<f64> {
        vec![f64::INFINITY]
    }

    fn limits(&mut self, _: &[f64]) -> Result<ControlLimits, Infallible> {
        Ok(ControlLimits::none(&self.layout).with_amplitudes_volt(vec![3.0]).unwrap())
    }

    fn linearised_t(&mut self, u: &[f64]) -> Result<Option<TMatrix>, Infallible> {
        let columns = [vec![0.0, 0.0, 1.0], vec![self.bend * u[1], self.weak, 0.0]];
        Ok(Some(TMatrix::from_columns(&columns).unwrap()))
    }
}

/// The bend is 30 times what T sees: the step of an untrusting quadratic is far too long, at every state
/// anew. A loop that learns from its halvings settles on the optimum with few of them.
#[test]
fn a_loop_that_halves_learns_how_far_to_trust_its_t() {
    for (weak, bend) in [(0.1, 0.3), (0.05, 0.2), (0.2, 0.1)] {
        for constrained in [false, true] {
            let layout = ControlLayout::new(1, vec![2]).unwrap();
            let mut plant = Bent { layout, weak, bend };
            let t0 = plant.linearised_t(&[0.0, 0.0]).unwrap().unwrap();
            let settings = FeedbackSettings {
                acceptance: Acceptance::Monotone { cost_tolerance: 1e-9 },
                ..FeedbackSettings::default()
            };
            let controller = FeedbackController::new(&t0, &LoadWeights::Identity, settings)
                .unwrap()
                .with_controller(Controller::Local { step_volt: vec![0.01; 2] })
                .unwrap();
            let run = if constrained {
                controller.run_constrained(&mut plant, 0.0).unwrap()
            } else {
                controller.run(&mut plant, 0.0).unwrap()
            };
            let exact = plant.optimum();
            let found = &run.last().control_volt;
            println!(
                "weak {weak}, bend {bend}: {} steps, {} halvings, {:?}, u_s {:.5} of {exact:.5}",
                run.steps.len(),
                run.backtracks,
                run.stop,
                found[1]
            );
            assert_eq!(run.stop, StopReason::Converged);
            let lost = |u: &[f64]| plant.loads(u).iter().map(|z| z * z).sum::<f64>();
            let (there, best) = (lost(found), lost(&[1.0, exact]));
            assert!(there - best <= 1e-8 * best, "{:e}", there / best - 1.0);
            assert!(run.backtracks <= 8, "{}", run.backtracks);
        }
    }
}

/// `Z = (u_c - 1, rest)`: the cost does not depend on `u_s`, but the T that is offered says it does, one way and then the
/// other, as differences over the steps of a memory may.
struct Level {
    layout: ControlLayout,
    rest: f64,
    asked: u32,
}

impl Plant for Level {
    type Error = Infallible;

    fn layout(&self) -> &ControlLayout {
        &self.layout
    }

    fn measure(&mut self, u: &[f64]) -> Result<Measurement, Infallible> {
        Ok(Measurement {
            outputs: vec![u[0] - 1.0, self.rest],
            flap_motion_deg: vec![Harmonic { cosine: u[0], sine: u[1] }],
            mean_flap_deg: vec![0.0],
        })
    }

    fn strokes_deg(&mut self, u: &[f64]) -> Result<Vec<f64>, Infallible> {
        Ok(vec![u[0].hypot(u[1])])
    }

    fn stroke_limits_deg(&self) -> Vec<f64> {
        vec![f64::INFINITY]
    }

    fn linearised_t(&mut self, _: &[f64]) -> Result<Option<TMatrix>, Infallible> {
        self.asked += 1;
        let slope = if self.asked.is_multiple_of(3) { 1e-2 } else { -1e-2 };
        Ok(Some(TMatrix::from_columns(&[vec![1.0, 0.0], vec![0.0, slope]]).unwrap()))
    }
}

#[test]
fn a_loop_that_wanders_along_a_flat_says_so() {
    let settings = FeedbackSettings {
        acceptance: Acceptance::Monotone { cost_tolerance: 1e-5 },
        ..FeedbackSettings::default()
    };
    let run = |rest: f64| {
        let layout = ControlLayout::new(1, vec![2]).unwrap();
        let mut plant = Level { layout, rest, asked: 0 };
        let t0 = plant.linearised_t(&[0.0, 0.0]).unwrap().unwrap();
        FeedbackController::new(&t0, &LoadWeights::Identity, settings.clone())
            .unwrap()
            .with_controller(Controller::Local { step_volt: vec![0.01; 2] })
            .unwrap()
            .run(&mut plant, 0.0)
            .unwrap()
    };
    // 1e-6 of the starting cost is promised at every step, and 0.1 V asked for
    let flat = run(1e-3);
    assert_eq!((flat.stop, flat.backtracks), (StopReason::Stagnated, 0));
    assert!((5..=8).contains(&flat.steps.len()), "{}", flat.steps.len());
    assert!((flat.last().control_volt[0] - 1.0).abs() < 1e-12);
    assert!(flat.end.asked_volt > 0.05, "{}", flat.end.asked_volt);
    // what promises more is followed
    assert_ne!(run(1e-2).stop, StopReason::Stagnated);
}
