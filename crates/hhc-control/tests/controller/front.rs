//! The front of two costs against closed forms, projected gradients and what chance finds.

use crate::plants::{Problem, as_t};
use chacha20::ChaCha8Rng;
use hhc_control::{
    ControlLayout, ControlLimits, FeedbackLaw, FrontPoint, LoadWeights, SecondCost, VoltageRange,
};
use nalgebra::{DMatrix, DVector};
use rand::{RngExt, SeedableRng};

/// Two flaps at 3/rev, twelve loads.
fn problem() -> Problem {
    let t = DMatrix::from_fn(12, 4, |i, j| {
        (1.0 + 0.9 * i as f64 + (2.1 + 0.7 * i as f64) * j as f64).sin()
    });
    let z0: Vec<f64> = (0..12).map(|i| 3.0 * (0.4 * f64::from(i)).cos()).collect();
    Problem::new(2, &[3], t, &z0)
}

fn law(problem: &Problem) -> FeedbackLaw {
    FeedbackLaw::new(&as_t(&problem.t), &LoadWeights::Identity).unwrap()
}

fn z0(problem: &Problem) -> Vec<f64> {
    problem.z0.iter().copied().collect()
}

/// Power, least at no control: a gain for each pair.
fn power() -> SecondCost {
    let gains = [0.7, 0.7, 1.9, 1.9];
    SecondCost {
        at_rest: vec![0.0; 4],
        t: as_t(&DMatrix::from_fn(4, 4, |i, j| if i == j { gains[i] } else { 0.0 })),
    }
}

/// Loads of a blade, there without control.
fn blade() -> SecondCost {
    SecondCost {
        at_rest: (0..8).map(|i| 2.0 + f64::from(i).sin()).collect(),
        t: as_t(&DMatrix::from_fn(8, 4, |i, j| {
            (0.3 + 1.7 * i as f64 - (0.8 + 0.6 * i as f64) * j as f64).cos()
        })),
    }
}

/// The minimum of `J + w S` by the normal equations.
fn weighted(problem: &Problem, second: &SecondCost, weight: f64) -> DVector<f64> {
    let (m, s) = (second.t.as_matrix(), DVector::from_column_slice(&second.at_rest));
    let normal = problem.t.transpose() * &problem.t + m.transpose() * m * weight;
    let right = problem.t.transpose() * &problem.z0 + m.transpose() * s * weight;
    normal.lu().solve(&-right).unwrap()
}

fn limits(amplitude_volt: f64) -> ControlLimits {
    let layout = ControlLayout::new(2, vec![3]).unwrap();
    ControlLimits::none(&layout).with_amplitudes_volt(vec![amplitude_volt; 2]).unwrap()
}

fn goes_one_way(front: &[FrontPoint]) {
    assert!(front.len() > 8, "{}", front.len());
    for pair in front.windows(2) {
        assert!(pair[1].loads_cost < pair[0].loads_cost, "{pair:?}");
        assert!(pair[1].second_cost > pair[0].second_cost, "{pair:?}");
        assert!(pair[1].weight < pair[0].weight);
        // the front is convex: the slope between two points lies between their weights
        let slope =
            (pair[0].loads_cost - pair[1].loads_cost) / (pair[1].second_cost - pair[0].second_cost);
        assert!(slope <= pair[0].weight * (1.0 + 1e-6), "{slope} {pair:?}");
        assert!(slope >= pair[1].weight * (1.0 - 1e-6), "{slope} {pair:?}");
    }
}

#[test]
fn without_a_limit_every_point_is_that_of_the_normal_equations() {
    let problem = problem();
    for second in [power(), blade()] {
        let front = law(&problem).front(&z0(&problem), &second, &limits(1e3)).unwrap();
        goes_one_way(&front);
        for point in &front[1..front.len() - 1] {
            let exact = weighted(&problem, &second, point.weight);
            let found = DVector::from_column_slice(&point.control_volt);
            assert!((&found - &exact).norm() <= 1e-9 * exact.norm(), "{point:?}");
            assert!((problem.loads_cost(&exact) - point.loads_cost).abs() <= 1e-9);
        }
    }
}

#[test]
fn the_ends_are_no_control_and_the_optimum() {
    let problem = problem();
    for amplitude in [1e3, 0.25] {
        let law = law(&problem);
        let limits = limits(amplitude);
        let front = law.front(&z0(&problem), &power(), &limits).unwrap();
        let (first, last) = (&front[0], front.last().unwrap());
        assert!(first.control_volt.iter().all(|u| *u == 0.0), "{first:?}");
        assert!((first.loads_cost - problem.z0.norm_squared()).abs() < 1e-12);
        let best = law.optimum_within(0.0, &[0.0; 4], &z0(&problem), &limits).unwrap();
        assert_eq!(last.control_volt, best.control_volt);
        // of a load that is there without control the first end is where it is least
        let front = law.front(&z0(&problem), &blade(), &limits).unwrap();
        let at_rest = blade().at(&[0.0; 4]).unwrap();
        assert!(front[0].second_cost < 0.99 * at_rest, "{} {at_rest}", front[0].second_cost);
        assert_eq!(front.last().unwrap().control_volt, best.control_volt);
    }
}

/// Where two loads alone have a weight, many controls take them away: the end of the front is the one of them that costs least,
/// by Lagrange's multipliers in closed form.
#[test]
fn among_controls_that_take_the_weighted_loads_away_the_cheapest_ends_the_front() {
    let problem = problem();
    let mut weights = vec![0.0; 12];
    (weights[4], weights[5]) = (1.0, 1.0);
    let law = FeedbackLaw::new(&as_t(&problem.t), &LoadWeights::Diagonal(weights)).unwrap();
    let front = law.front(&z0(&problem), &power(), &limits(1e3)).unwrap();
    let t = problem.t.rows(4, 2).into_owned();
    let weight = DMatrix::from_diagonal(&DVector::from_column_slice(&[0.49, 0.49, 3.61, 3.61]));
    let cheap = weight.try_inverse().unwrap() * t.transpose();
    let exact = -&cheap * (&t * &cheap).lu().solve(&problem.z0.rows(4, 2).into_owned()).unwrap();
    let last = front.last().unwrap();
    let found = DVector::from_column_slice(&last.control_volt);
    assert!((&found - &exact).norm() < 1e-3 * exact.norm(), "{found} {exact}");
    assert!(last.loads_cost < 1e-6 * front[0].loads_cost, "{last:?}");
    let any = law.optimum_within(0.0, &[0.0; 4], &z0(&problem), &limits(1e3)).unwrap();
    let any = power().at(&any.control_volt).unwrap();
    assert!(any > 1.05 * last.second_cost, "{any} {}", last.second_cost);
}

/// Nothing that chance finds within the limits is better in both costs, and some of it comes near.
#[test]
fn no_control_within_the_limits_dominates() {
    let problem = problem();
    let amplitude = 0.25;
    let mut random = ChaCha8Rng::seed_from_u64(7);
    for second in [power(), blade()] {
        let front = law(&problem).front(&z0(&problem), &second, &limits(amplitude)).unwrap();
        goes_one_way(&front);
        let costs =
            |u: &[f64]| [problem.loads_cost(&DVector::from_column_slice(u)), second.at(u).unwrap()];
        let span = [front[0].loads_cost, front.last().unwrap().second_cost];
        let mut nearest = f64::INFINITY;
        for k in 0..60_000 {
            // anywhere, then about points of the front
            let about = (k % 2 == 1).then(|| &front[k / 2 % front.len()].control_volt);
            let mut u = vec![0.0; 4];
            for (pair, own) in u.chunks_exact_mut(2).enumerate() {
                let radius = amplitude * random.random::<f64>().sqrt();
                let angle = std::f64::consts::TAU * random.random::<f64>();
                let drawn = [radius * angle.cos(), radius * angle.sin()];
                for (j, volt) in own.iter_mut().enumerate() {
                    *volt = about.map_or(drawn[j], |u| u[2 * pair + j] + 0.02 * drawn[j]);
                }
                let size = own[0].hypot(own[1]).max(amplitude) / amplitude;
                for volt in own {
                    *volt /= size;
                }
            }
            let [j, s] = costs(&u);
            for point in &front {
                let worse =
                    (j / point.loads_cost - 1.0).max(s / point.second_cost.max(1e-12) - 1.0);
                assert!(worse >= -1e-9, "{u:?}: {j} {s} dominates {point:?}");
                nearest = nearest
                    .min(((j - point.loads_cost) / span[0]).max((s - point.second_cost) / span[1]));
            }
        }
        assert!(nearest < 1e-2, "{nearest}");
    }
}

/// Projected gradients, which share nothing with the cone program, end at the same costs where limits bind.
#[test]
fn where_limits_bind_projected_gradients_agree() {
    let problem = problem();
    let amplitude = 0.25;
    for second in [power(), blade()] {
        let front = law(&problem).front(&z0(&problem), &second, &limits(amplitude)).unwrap();
        let (m, s) = (second.t.as_matrix(), DVector::from_column_slice(&second.at_rest));
        let mut bound = 0;
        for point in &front[1..front.len() - 1] {
            let w = point.weight;
            let hessian = problem.t.transpose() * &problem.t + m.transpose() * m * w;
            let linear = problem.t.transpose() * &problem.z0 + m.transpose() * &s * w;
            let step = 1.0 / hessian.norm();
            let mut u = DVector::zeros(4);
            for _ in 0..200_000 {
                u -= (&hessian * &u + &linear) * step;
                for pair in 0..2 {
                    let size = u[2 * pair].hypot(u[2 * pair + 1]).max(amplitude) / amplitude;
                    u[2 * pair] /= size;
                    u[2 * pair + 1] /= size;
                }
            }
            let other = problem.loads_cost(&u) + w * second.at(u.as_slice()).unwrap();
            let found = point.loads_cost + w * point.second_cost;
            assert!((found - other).abs() <= 1e-9 * other, "{found} {other}");
            let sizes = point.control_volt.chunks_exact(2).map(|u| u[0].hypot(u[1]));
            bound += usize::from(sizes.fold(0.0, f64::max) > 0.999 * amplitude);
        }
        assert!(bound > 2, "the limits of this test bind at {bound} points");
    }
}

/// The range of the voltage holds along the whole front.
#[test]
fn the_range_of_the_voltage_is_kept() {
    let problem = problem();
    let layout = ControlLayout::new(2, vec![3]).unwrap();
    let range = VoltageRange {
        range_volt: [-0.2, 1.0],
        bias_volt: vec![0.1; 2],
        bias_slope: Vec::new(),
        azimuths: 720,
    };
    let limits = ControlLimits::none(&layout).with_voltage_range(range).unwrap();
    let front = law(&problem).front(&z0(&problem), &power(), &limits).unwrap();
    goes_one_way(&front);
    let used: Vec<f64> = front.iter().map(|p| limits.usage(&p.control_volt).unwrap()).collect();
    assert!(used.iter().all(|u| *u <= 1.0 + 1e-9), "{used:?}");
    assert!(used.last().unwrap() > &0.999, "the range of this test binds");
}

/// More controls than loads: the least power among the many optima, and no weight on what nothing moves.
#[test]
fn among_optima_the_cheapest_is_the_end() {
    let t = DMatrix::from_fn(2, 4, |i, j| (1.0 + 0.9 * i as f64 + 2.1 * j as f64).sin());
    let problem = Problem::new(2, &[3], t, &[1.0, -0.5]);
    let second = power();
    let front = law(&problem).front(&z0(&problem), &second, &limits(1e3)).unwrap();
    goes_one_way(&front);
    // least |G u| with T u = -Z0:  u = -P^-1 T' (T P^-1 T')^-1 Z0,  P = G'G
    let m = second.t.as_matrix();
    let inverse = (m.transpose() * m).try_inverse().unwrap();
    let gram = &problem.t * &inverse * problem.t.transpose();
    let exact = -(&inverse * problem.t.transpose() * gram.try_inverse().unwrap() * &problem.z0);
    let cheapest = second.at(exact.as_slice()).unwrap();
    let last = front.last().unwrap();
    assert!(last.loads_cost <= 1e-9 * problem.z0.norm_squared(), "{last:?}");
    assert!((last.second_cost / cheapest - 1.0).abs() < 1e-4, "{} {cheapest}", last.second_cost);
    let still = SecondCost { at_rest: vec![1.0], t: as_t(&DMatrix::zeros(1, 4)) };
    assert!(law(&problem).front(&z0(&problem), &still, &limits(1e3)).is_err());
}
