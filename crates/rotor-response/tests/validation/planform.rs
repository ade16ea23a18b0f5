//! A blade whose chord varies along the span, a swept blade, a lag damper: closed forms of stiff blades, and the identity
//! of one reference chord with another.

use std::f64::consts::TAU;
use std::sync::Arc;

use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec, Distribution, Joint, RootSupport, TorsionTerms};
use rotor_response::{
    Compressibility, Condition, Controls, Couplings, Discretisation, Planform, ResponseTolerances,
    ReverseFlow, Rotor, RotorModel, RotorSolution, RotorSolver, SectionLags, TrailingEdgeFlap,
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
    row(
        "V-PLAN-05",
        "thrust and torque of a stiff blade in hover, swept aft by 21.8 deg beyond \
         .8 R, incompressible and at a tip Mach number of .6: largest error",
        "%",
    )
    .against(SWEPT)
    .at_most(1e-3, || worst("Mach numbers", 2, [0.0, 0.6].map(swept_hover))),
    row(
        "V-PLAN-06",
        "pitch and roll moment of that blade on the hub at mu .15, no pitch, upflow \
         of .05: error over the norm",
        "%",
    )
    .against(SWEPT)
    .at_most(1e-3, || Ok(swept_flight()?.0)),
    row(
        "V-PLAN-07",
        "the same of the unswept blade against that form: what the bound must see",
        "%",
    )
    .against(SWEPT)
    .at_least(5.0, || Ok(swept_flight()?.1)),
    row(
        "V-PLAN-08",
        "moment about the elastic axis at the root of that blade, at no pitch: lift \
         of an upflow of .05; mass in vacuum at .5 deg of precone: largest error",
        "%",
    )
    .against("int of lift, and of m x sin b cos b, times the distance behind the axis")
    .at_most(1e-2, || worst("moments", 2, [swept_lift_torsion(), swept_mass_torsion()])),
    row(
        "V-PLAN-09",
        "stiff blade with lag hinge at .05 R, free and on a spring, damper of .01 \
         m0 Omega R^3, in vacuum, both theories: Floquet exponent, largest error",
        "relative",
    )
    .against("-c/(2 I) +- i sqrt(w^2 - (c/2I)^2)")
    .at_most(1e-6, lag_damper),
];

const SWEPT: &str = "blade elements of simple sweep theory in closed form";

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
        planform: Planform { chord, set_back: None },
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
    let planform = Planform { chord: Some(table), set_back: None };
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

/// Where the swept part begins, R, and the tangent of its angle, aft.
const SWEEP_FROM: f64 = 0.8;
const TANGENT: f64 = 0.4;
const MU: f64 = 0.15;

/// `int f(x) dx` over the lifting span: `f` is given the tangent of the sweep and the distance behind the axis.
fn over_span(f: impl Fn(f64, f64, f64) -> f64) -> f64 {
    let of = |low: f64, high: f64, tangent: f64| {
        let half = 0.5 * (high - low);
        let rule = rotor_base::gauss_legendre(12);
        let parts = rule.nodes.iter().zip(&rule.weights).map(|(node, weight)| {
            let x = low + half * (node + 1.0);
            half * weight * f(x, tangent, tangent * (x - SWEEP_FROM))
        });
        parts.sum::<f64>()
    };
    of(CUTOUT, SWEEP_FROM, 0.0) + of(SWEEP_FROM, 1.0, TANGENT)
}

fn cosine(tangent: f64) -> f64 {
    1.0 / (1.0 + tangent * tangent).sqrt()
}

/// A stiff blade, swept or not, without trailing-edge flaps.
struct Stiff {
    tangent: f64,
    lock_number: f64,
    precone_rad: f64,
    mu: f64,
    theta0_rad: f64,
    inflow: f64,
    tip_mach: f64,
}

impl Stiff {
    fn swept() -> Self {
        Self {
            tangent: TANGENT,
            lock_number: RotorModel::paper_case().lock_number,
            precone_rad: 0.0,
            mu: 0.0,
            theta0_rad: PITCH,
            inflow: INFLOW,
            tip_mach: 0.0,
        }
    }

    fn solve(&self) -> Result<(RotorModel, RotorSolution), Failure> {
        let set_back = Distribution::PiecewiseLinear {
            stations: vec![0.0, SWEEP_FROM, 1.0],
            values: vec![0.0, 0.0, self.tangent * (1.0 - SWEEP_FROM)],
        };
        let model = RotorModel {
            planform: Planform { chord: None, set_back: Some(set_back) },
            drag_coefficient: DRAG,
            reverse_flow: ReverseFlow::Abrupt,
            lock_number: self.lock_number,
            compressibility: match self.tip_mach {
                0.0 => Compressibility::None,
                tip_mach => Compressibility::LocalMach { tip_mach },
            },
            ..paper_rotor(Couplings::Moderate(TorsionTerms::default()), CUTOUT)
        };
        let spec = BladeSpec {
            root: RootSupport::CLAMPED,
            precone_rad: self.precone_rad,
            chord_gyration_radius: 0.09.into(),
            ..BladeSpec::uniform(1e5, 1e5, 1e5, 1e8)
        };
        let d = Discretisation { modes: [1, 1, 1], ..Discretisation::default() };
        let rotor = Rotor::new(model.clone(), &BladeProperties::new(spec)?, d)?;
        let rotor = Arc::new(rotor);
        let mut solver = RotorSolver::new(rotor, self.mu, ResponseTolerances::default())?;
        let condition = Condition {
            bank_rad: 0.0,
            flight: FlightState { advance_ratio: self.mu, shaft_tilt_rad: 0.0 },
            controls: Controls { theta0_rad: self.theta0_rad, ..Controls::default() },
            flap_angles_rad: vec![],
        };
        let inflow = LinearInflow::Prescribed { induced_inflow: self.inflow };
        Ok((model, solver.solve(&condition, &inflow, None)?))
    }
}

/// `C_T = N_b int c cos L (x^2 th - x la) / sqrt(1 - (M x cos L)^2) dx`,
/// `C_Q = la C_T + N_b c_d / (2 pi) int c cos L x^3 dx`.
fn swept_hover(tip_mach: f64) -> Result<f64, Failure> {
    let (model, found) = Stiff { tip_mach, ..Stiff::swept() }.solve()?;
    let (unit, blades) = (model.thrust_coefficient(1.0), model.blades as f64);
    let mean = found.hub.mean();
    let c = model.chord;
    let slope = |mach: f64| 1.0 / (1.0 - mach * mach).sqrt();
    let lift = |x: f64, cos: f64| cos * x * (x * PITCH - INFLOW) * slope(tip_mach * x * cos);
    let thrust = blades * c * over_span(|x, t, _| lift(x, cosine(t)));
    let torque =
        INFLOW * thrust + blades * c * DRAG * over_span(|x, t, _| cosine(t) * x.powi(3)) / TAU;
    let errors = [unit * mean[2] / thrust - 1.0, -unit * mean[5] / torque - 1.0];
    Ok(100.0 * errors.iter().fold(0.0_f64, |most, e| most.max(e.abs())))
}

/// Lift `F = c cos L (U_T + U_S tan L)(-la)` at no pitch, `U_T = x + mu sin psi`, `U_S = -mu cos psi`, at `x` along the blade
/// and `s` behind its axis. Its cosine and sine at 1/rev make the moments
///
/// ```text
/// M_x = (x F_1s - s F_1c) N_b / 2,   M_y = -(x F_1c + s F_1s) N_b / 2
/// ```
/// Errors of the swept blade, and of the unswept one, against those of the swept.
fn swept_flight() -> Result<(f64, f64), Failure> {
    let of = |tangent: f64| -> Result<[f64; 2], Failure> {
        let stiff = Stiff { tangent, mu: MU, theta0_rad: 0.0, inflow: -INFLOW, ..Stiff::swept() };
        let (model, found) = stiff.solve()?;
        let unit = model.thrust_coefficient(1.0) / (model.blades as f64 * model.chord);
        let mean = found.hub.mean();
        Ok([unit * mean[3], unit * mean[4]])
    };
    let factor = 0.5 * MU * INFLOW;
    let roll = factor * over_span(|x, t, s| cosine(t) * (x + s * t));
    let pitch = factor * over_span(|x, t, s| cosine(t) * (x * t - s));
    let error = |[x, y]: [f64; 2]| 100.0 * (x - roll).hypot(y - pitch) / roll.hypot(pitch);
    Ok((error(of(TANGENT)?), error(of(0.0)?)))
}

fn swept_lift_torsion() -> Result<f64, Failure> {
    let (model, found) = Stiff { theta0_rad: 0.0, inflow: -INFLOW, ..Stiff::swept() }.solve()?;
    let unit = model.thrust_coefficient(1.0);
    let expected = -model.chord * INFLOW * over_span(|x, t, back| cosine(t) * x * back);
    Ok(100.0 * (unit * found.root.components[3].mean / expected - 1.0).abs())
}

fn swept_mass_torsion() -> Result<f64, Failure> {
    let precone_rad = 0.5_f64.to_radians();
    let blade =
        Stiff { lock_number: 0.0, precone_rad, theta0_rad: 0.0, inflow: 0.0, ..Stiff::swept() };
    let (_, found) = blade.solve()?;
    let expected = precone_rad.sin() * precone_rad.cos() * over_span(|x, _, back| x * back);
    Ok(100.0 * (found.root.components[3].mean / expected - 1.0).abs())
}

fn lag_damper() -> Result<f64, Failure> {
    let (hinge, damper) = (0.05_f64, 0.01);
    let inertia = (1.0 - hinge).powi(3) / 3.0;
    let mut errors = Vec::new();
    for couplings in [Couplings::Linear, Couplings::Moderate(TorsionTerms::default())] {
        for (lag, spring) in [(Joint::Free, 0.0), (Joint::Spring { stiffness: 0.02 }, 0.02)] {
            let root = RootSupport { lag, ..RootSupport::CLAMPED };
            let spec =
                BladeSpec { root, root_offset: hinge, ..BladeSpec::uniform(1e5, 1e5, 1e5, 1e8) };
            let model = RotorModel {
                lock_number: 0.0,
                modal_damping: 0.0,
                lag_damper: damper,
                ..paper_rotor(couplings, CUTOUT)
            };
            let d = Discretisation { modes: [0, 1, 0], ..Discretisation::default() };
            let rotor = Arc::new(Rotor::new(model, &BladeProperties::new(spec)?, d)?);
            let mut solver = RotorSolver::new(rotor, 0.0, ResponseTolerances::default())?;
            let condition = Condition {
                bank_rad: 0.0,
                flight: FlightState { advance_ratio: 0.0, shaft_tilt_rad: 0.0 },
                controls: Controls::default(),
                flap_angles_rad: vec![],
            };
            let still = LinearInflow::Prescribed { induced_inflow: 0.0 };
            let found = solver.solve(&condition, &still, None)?;
            let stability = solver.stability_with(&condition, &found, SectionLags::Moving)?;
            let motion = stability.least_stable().ok_or("no motion")?;
            let decay = damper / (2.0 * inertia);
            // centrifugal stiffness int m e (x - e) dx
            let squared = (0.5 * hinge * (1.0 - hinge).powi(2) + spring) / inertia;
            let frequency = (squared - decay * decay).sqrt();
            errors.push(Ok((motion.growth_per_rad / -decay - 1.0).abs()));
            errors.push(Ok((motion.frequency_per_rev / frequency - 1.0).abs()));
        }
    }
    worst("exponents", 8, errors)
}
