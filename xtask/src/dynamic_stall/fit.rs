//! Fit of the constants of the stall to measured loops.

use super::cycle::{Cycle, FEWEST_POINTS, Stalling, extreme};
use super::loops::MeasuredLoop;
use flap_aero::FittedStall;
use levenberg_marquardt::{LeastSquaresProblem, LevenbergMarquardt};
use nalgebra::storage::Owned;
use nalgebra::{DMatrix, DVector, Dyn};
use rayon::prelude::*;

/// Root mean square of lift, drag and moment that counts one.
const SCALES: [f64; 3] = [0.12, 0.05, 0.04];
/// Relative error of an extreme that counts one, and the part of a scale below which it does not count as relative.
const EXTREME_SCALES: [f64; 3] = [0.14, 0.36, 0.43];
const LEAST_EXTREME: f64 = 1.0 / 3.0;
/// Sum of squares of a loop that counts half: one that no constants follow does not rule.
const HALF: f64 = 12.0;
/// Step of the differences, of a bounded constant's logit.
const STEP: f64 = 1e-4;
/// Starts, the first from the middle of what is usual.
const STARTS: u64 = 10;

/// Bounds and start of `alpha1` in deg, `Cn1`, the constants that are the same at all Mach numbers, and the camber.
const ALPHA1: [f64; 3] = [8.0, 20.0, 15.0];
const CN1: [f64; 3] = [0.9, 2.6, 1.6];
/// Names of the constants that are the same, with their bounds and starts.
pub const SAME: [(&str, [f64; 3]); 14] = [
    ("S1, deg", [0.3, 8.0, 3.0]),
    ("S2, deg", [0.5, 8.0, 2.0]),
    ("k0", [-0.05, 0.05, 0.005]),
    ("k1", [-0.3, -0.05, -0.135]),
    ("k2", [-0.1, 0.15, 0.04]),
    ("eta", [0.85, 1.0, 0.96]),
    ("Df", [0.0, 12.0, 5.0]),
    ("Tp", [0.5, 6.0, 2.0]),
    ("Tf", [0.5, 10.0, 2.5]),
    ("Tf attaching", [0.5, 30.0, 5.0]),
    ("Tv", [1.0, 12.0, 7.0]),
    ("Tvl", [3.0, 15.0, 7.0]),
    ("strength", [0.5, 3.0, 1.2]),
    ("arm", [0.1, 0.35, 0.15]),
];
const CAMBER: [[f64; 3]; 2] = [[-2.5, 2.5, -0.5], [-0.06, 0.08, 0.005]];

/// What is fitted: the Mach numbers between which `alpha1` and `Cn1` run straight, and whether there is camber.
#[derive(Debug, Clone, Copy)]
pub struct Shape {
    /// Ascending.
    pub machs: &'static [f64],
    /// Whether zero lift and its moment are unknown.
    pub cambered: bool,
}

impl Shape {
    fn bounds(&self) -> Vec<[f64; 3]> {
        let count = self.machs.len();
        let mut bounds = vec![ALPHA1; count];
        bounds.extend(vec![CN1; count]);
        bounds.extend(SAME.map(|(_, bounds)| bounds));
        bounds.extend(CAMBER.into_iter().filter(|_| self.cambered));
        bounds
    }

    /// The constants at a Mach number, of values in the order of the bounds.
    pub fn stalling(&self, values: &[f64], mach: f64) -> Stalling {
        let count = self.machs.len();
        let (alpha1_deg, rest) = values.split_at(count);
        let (cn1, rest) = rest.split_at(count);
        let (same, camber) = rest.split_at(SAME.len());
        let [zero_lift_deg, zero_lift_moment] =
            if self.cambered { [camber[0], camber[1]] } else { [0.0; 2] };
        let fitted = FittedStall {
            machs: self.machs,
            alpha1_deg,
            cn1,
            same: std::array::from_fn(|k| same[k]),
            zero_lift_deg,
            zero_lift_moment,
        };
        Stalling {
            parameters: fitted.at(mach),
            zero_lift_rad: zero_lift_deg.to_radians(),
            zero_lift_moment,
        }
    }
}

/// Residuals of a loop; empty where the constants make no section.
fn residuals(measured: &MeasuredLoop, stalling: &Stalling) -> Vec<f64> {
    let Ok(cycle) = Cycle::of(measured, stalling) else { return Vec::new() };
    let mut found = Vec::new();
    for (which, points) in measured.values.iter().enumerate() {
        if points.len() < FEWEST_POINTS {
            continue;
        }
        let scale = SCALES[which] * (points.len() as f64).sqrt();
        found.extend(points.iter().map(|[phase, value]| (cycle.at(which, *phase) - value) / scale));
        let real = extreme(points.iter().map(|[_, value]| *value), which);
        let scale = (EXTREME_SCALES[which] * real.abs()).max(LEAST_EXTREME * SCALES[which]);
        found.push((cycle.extreme(which) - real) / scale);
    }
    let squares: f64 = found.iter().map(|r| r * r).sum();
    let share = (HALF / (HALF + squares)).sqrt();
    found.iter().map(|r| r * share).collect()
}

/// The problem in logits of the constants between their bounds.
struct Problem<'a> {
    loops: &'a [&'a MeasuredLoop],
    shape: Shape,
    bounds: Vec<[f64; 3]>,
    logits: DVector<f64>,
}

impl Problem<'_> {
    fn values(&self, logits: &DVector<f64>) -> Vec<f64> {
        let pairs = self.bounds.iter().zip(logits);
        pairs.map(|([low, high, _], u)| low + (high - low) / (1.0 + (-u).exp())).collect()
    }

    fn all(&self, logits: &DVector<f64>) -> DVector<f64> {
        let values = self.values(logits);
        let of = |measured: &&MeasuredLoop| {
            residuals(measured, &self.shape.stalling(&values, measured.mach))
        };
        DVector::from_vec(self.loops.iter().flat_map(of).collect())
    }
}

impl LeastSquaresProblem<f64, Dyn, Dyn> for Problem<'_> {
    type ResidualStorage = Owned<f64, Dyn>;
    type JacobianStorage = Owned<f64, Dyn, Dyn>;
    type ParameterStorage = Owned<f64, Dyn>;

    fn set_params(&mut self, logits: &DVector<f64>) {
        self.logits.copy_from(logits);
    }

    fn params(&self) -> DVector<f64> {
        self.logits.clone()
    }

    fn residuals(&self) -> Option<DVector<f64>> {
        Some(self.all(&self.logits))
    }

    fn jacobian(&self) -> Option<DMatrix<f64>> {
        let columns: Vec<DVector<f64>> = (0..self.logits.len())
            .into_par_iter()
            .map(|k| {
                let moved = |by: f64| {
                    let mut logits = self.logits.clone();
                    logits[k] += by;
                    self.all(&logits)
                };
                (moved(STEP) - moved(-STEP)) / (2.0 * STEP)
            })
            .collect();
        Some(DMatrix::from_columns(&columns))
    }
}

/// Values that fit loops best of several starts, in the order of the bounds, and the sum of squares a loop.
pub fn fit(loops: &[&MeasuredLoop], shape: Shape) -> (Vec<f64>, f64) {
    let bounds = shape.bounds();
    let begun = |start: u64| {
        let logits = bounds.iter().enumerate().map(|(k, [low, high, usual])| {
            // places that fill the middle of the bounds evenly, whatever their number
            let golden = 0.618_034 * (start as f64) * (k as f64 + 1.0);
            let moved = if start == 0 { 0.0 } else { 0.4 * (golden.fract() - 0.5) };
            let share = ((usual - low) / (high - low) + moved).clamp(0.05, 0.95);
            (share / (1.0 - share)).ln()
        });
        let logits = DVector::from_iterator(bounds.len(), logits);
        let problem = Problem { loops, shape, bounds: bounds.clone(), logits };
        let (found, report) = LevenbergMarquardt::new()
            .with_ftol(1e-5)
            .with_xtol(1e-5)
            .with_patience(6)
            .minimize(problem);
        (report.objective_function, found.values(&found.logits))
    };
    let tried: Vec<(f64, Vec<f64>)> = (0..STARTS).map(begun).collect();
    let best = tried.into_iter().min_by(|a, b| a.0.total_cmp(&b.0));
    best.map_or_else(
        || (Vec::new(), f64::NAN),
        |(half, values)| (values, 2.0 * half / loops.len() as f64),
    )
}
