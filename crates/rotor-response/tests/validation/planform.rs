//! A blade whose chord varies along the span: closed forms of a stiff blade in hover, and the identity of one reference
//! chord with another.

use std::f64::consts::TAU;
use std::sync::Arc;

use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec, Distribution, RootSupport};
use rotor_response::{
    Condition, Controls, Couplings, Discretisation, Planform, ResponseTolerances, ReverseFlow,
    Rotor, RotorModel, RotorSolution, RotorSolver, TrailingEdgeFlap,
};
use rotor_wake::{FlightState, LinearInflow};

use crate::rotor::{fixed_controls, paper_rotor};
use validation::{Check, Failure, row, worst};

const ELEMENTS: &str = "blade-element integral in closed form, uniform inflow";

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-PLAN-01",
        "thrust and torque of a stiff blade in hover, chord from .055 R at the \
         root to .0275 R at the tip, and the same beyond .6 R: largest error",
        "%",
    )
    .against(ELEMENTS)
    .at_most(1e-3, || worst("tapers", 2, TAPERS.map(|(kink, _)| taper_error(kink)))),
    row(
        "V-PLAN-02",
        "that with one point in each of 10, 20 and 40 elements: order of \
         convergence with the stations, the smaller of two",
        "-",
    )
    .against("order 2 of one Gauss point")
    .between(1.9, 2.1, order),
    row(
        "V-PLAN-03",
        "hinge moment of a flap of a fifth of the chord from .7 to .75 R of the \
         tapered blade, held at 2 deg at no pitch, over that of the rectangular: \
         error",
        "%",
    )
    .against("int c^2 x^2 dx over the flap")
    .at_most(1e-3, hinge_error),
    row(
        "V-PLAN-04",
        "chord of half the reference chord by a table off a reference chord and \
         a Lock number of half: modal harmonics, hub loads and hinge moments of \
         the paper's rotor at mu .3, flaps at 4/rev, unsteady sections: largest \
         difference over the largest",
        "relative",
    )
    .against("the same rotor")
    .at_most(1e-9, identity),
];

/// Where the taper begins, R, with the name it has.
const TAPERS: [(f64, &str); 2] = [(0.0, "root"), (0.6, "kink")];
const ROOT: f64 = 0.055;
const TIP: f64 = 0.0275;
const CUTOUT: f64 = 0.2;
const DRAG: f64 = 0.01;
const INFLOW: f64 = 0.05;
const PITCH: f64 = 0.15;

/// Straight from `from` to the tip, constant inboard.
fn tapered(from: f64) -> Distribution {
    let kink = (from > 0.0).then_some((from, ROOT));
    let all = [(0.0, ROOT)].into_iter().chain(kink).chain([(1.0, TIP)]);
    let (stations, values) = all.unzip();
    Distribution::PiecewiseLinear { stations, values }
}

/// `int c x^n dx` from `low` to `high`, where the chord is a line through `c(low)` and `c(high)`.
fn moment(n: i32, [low, high]: [f64; 2], [first, last]: [f64; 2]) -> f64 {
    let slope = (last - first) / (high - low);
    let start = first - slope * low;
    let power = |k: i32| (high.powi(k) - low.powi(k)) / f64::from(k);
    start * power(n + 1) + slope * power(n + 2)
}

/// The same over the lifting span of a taper.
fn chord_moment(n: i32, from: f64) -> f64 {
    if from > CUTOUT {
        moment(n, [CUTOUT, from], [ROOT; 2]) + moment(n, [from, 1.0], [ROOT, TIP])
    } else {
        let at_cutout = ROOT + (TIP - ROOT) * (CUTOUT - from) / (1.0 - from);
        moment(n, [CUTOUT, 1.0], [at_cutout, TIP])
    }
}

fn model(chord: Option<Distribution>) -> RotorModel {
    RotorModel {
        planform: Planform { chord },
        drag_coefficient: DRAG,
        reverse_flow: ReverseFlow::Abrupt,
        ..paper_rotor(Couplings::Full, CUTOUT)
    }
}

fn hover(
    model: RotorModel,
    theta0_rad: f64,
    induced_inflow: f64,
    d: Discretisation,
) -> Result<RotorSolution, Failure> {
    let spec = BladeSpec { root: RootSupport::CLAMPED, ..BladeSpec::uniform(1e5, 1e5, 1e5, 1e8) };
    let flaps = model.flaps.len();
    let rotor = Rotor::new(model, &BladeProperties::new(spec)?, d)?;
    let mut solver = RotorSolver::new(Arc::new(rotor), 0.0, ResponseTolerances::default())?;
    let condition = Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio: 0.0, shaft_tilt_rad: 0.0 },
        controls: Controls { theta0_rad, ..Controls::default() },
        flap_angles_rad: vec![still(2.0_f64.to_radians()); flaps],
    };
    let inflow = LinearInflow::Prescribed { induced_inflow };
    Ok(solver.solve(&condition, &inflow, None)?)
}

fn still(mean: f64) -> HarmonicSeries {
    HarmonicSeries { mean, ..HarmonicSeries::zero(0) }
}

/// `C_T = (N_b / pi) pi int c (x^2 th - x la) dx`, `C_Q = la C_T + N_b c_d / (2 pi) int c x^3 dx`.
fn taper_errors(from: f64, d: Discretisation) -> Result<[f64; 2], Failure> {
    let model = model(Some(tapered(from)));
    let (unit, blades) = (model.thrust_coefficient(1.0), model.blades as f64);
    let mean = hover(model, PITCH, INFLOW, d)?.hub.mean();
    let [one, two, three] = [1, 2, 3].map(|n| chord_moment(n, from));
    let thrust = blades * (two * PITCH - one * INFLOW);
    let torque = INFLOW * thrust + blades * DRAG * three / TAU;
    Ok([unit * mean[2] / thrust - 1.0, -unit * mean[5] / torque - 1.0])
}

fn taper_error(from: f64) -> Result<f64, Failure> {
    let d = Discretisation { modes: [1, 1, 1], ..Discretisation::default() };
    let errors = taper_errors(from, d)?;
    Ok(100.0 * errors.iter().fold(0.0_f64, |most, e| most.max(e.abs())))
}

fn order() -> Result<f64, Failure> {
    let mut errors = Vec::new();
    for blade_elements in [10, 20, 40] {
        let d = Discretisation {
            modes: [1, 1, 1],
            blade_elements,
            span_points_per_piece: 1,
            ..Discretisation::default()
        };
        errors.push(taper_errors(0.6, d)?[0].abs());
    }
    let orders = errors.windows(2).map(|pair| (pair[0] / pair[1]).log2());
    Ok(orders.fold(f64::INFINITY, f64::min))
}

fn hinge_error() -> Result<f64, Failure> {
    let flap = TrailingEdgeFlap::paper_case()[0];
    let of = |chord: Option<Distribution>| -> Result<f64, Failure> {
        let model = RotorModel { flaps: vec![flap], ..model(chord) };
        let d = Discretisation { modes: [1, 1, 1], ..Discretisation::default() };
        Ok(hover(model, 0.0, 0.0, d)?.hinge[0].aerodynamic.mean)
    };
    // c = ROOT (1 - x / 2): c^2 x^2 = ROOT^2 (x^2 - x^3 + x^4 / 4)
    let power = |n: i32| (flap.end.powi(n) - flap.start.powi(n)) / f64::from(n);
    let expected = (power(3) - power(4) + 0.25 * power(5)) / power(3);
    let found = of(Some(tapered(0.0)))? / of(None)?;
    Ok(100.0 * (found / expected - 1.0).abs())
}

fn identity() -> Result<f64, Failure> {
    let paper = RotorModel::paper_case();
    let half = 0.5 * paper.chord;
    let stations = vec![0.0, 1.0];
    let table = Distribution::PiecewiseLinear { stations, values: vec![half; 2] };
    let planform = Planform { chord: Some(table) };
    let by_table = RotorModel { planform, ..paper.clone() };
    let lock_number = 0.5 * paper.lock_number;
    let by_reference = RotorModel { chord: half, lock_number, ..paper };
    let solve = |model: RotorModel| -> Result<(Vec<f64>, f64), Failure> {
        let blade = BladeProperties::new(BladeSpec::table_1())?;
        let ct_unit = model.thrust_coefficient(1.0) / model.solidity();
        let rotor = Rotor::new(model, &blade, Discretisation::default())?;
        let mut solver = RotorSolver::new(Arc::new(rotor), 0.3, ResponseTolerances::default())?;
        let mut flap = HarmonicSeries::zero(4);
        flap.set_harmonic(4, Harmonic { cosine: 0.02, sine: 0.01 });
        let condition = Condition { flap_angles_rad: vec![flap; 2], ..fixed_controls() };
        let inflow = LinearInflow::Prescribed { induced_inflow: 0.01 };
        let found = solver.solve(&condition, &inflow, None)?;
        let hinge = found.hinge.iter().map(rotor_response::HingeMoment::total);
        let series: Vec<HarmonicSeries> =
            found.hub.components.into_iter().chain(found.modal).chain(hinge).collect();
        let parts = series.iter().flat_map(|s| {
            let of = |n: usize| [s.harmonic(n).cosine, s.harmonic(n).sine];
            std::iter::once(s.mean).chain((1..=8).flat_map(of))
        });
        Ok((parts.collect(), ct_unit))
    };
    let ((a, unit_a), (b, unit_b)) = (solve(by_table)?, solve(by_reference)?);
    let largest = a.iter().fold(0.0_f64, |most, x| most.max(x.abs()));
    let gap = a.iter().zip(&b).fold(0.0_f64, |most, (x, y)| most.max((x - y).abs()));
    Ok((gap / largest).max((unit_a / unit_b - 1.0).abs()))
}
