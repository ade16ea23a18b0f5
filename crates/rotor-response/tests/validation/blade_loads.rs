//! Loads along the span: force summation, its counterpart in the equations of motion, curvature.

use std::sync::{Arc, Mutex};

use rotor_base::HarmonicSeries;
use rotor_fem::{BladeProperties, BladeSpec, ModalBasis, TorsionTerms};
use rotor_response::{
    Condition, Couplings, Discretisation, LoadHistory, ResponseTolerances, Rotor, RotorModel,
    RotorSolution, RotorSolver, StationLoads,
};
use rotor_wake::LinearInflow;

use crate::rotor::{fixed_controls, paper_blade, paper_rotor};
use validation::{Check, Failure, row, worst};

const SAME_EQUATION: &str = "both integrate the same equation";
const MONOTONE: &str = "monotone convergence";

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-RESP-45",
        "flap, lag and torsion moment at root, .25, .5, .75 R, mean to 4/rev: \
         curvature of 16 completed modes of each off the force summation, as the \
         hub gets it and as it is printed (V-RESP-57 has what the statics of the \
         deflected blade add), Full, over the largest along the span: worst of all",
        "%",
    )
    .against(SAME_EQUATION)
    .at_most(1.0, || Ok(100.0 * largest(&gaps(16, ModalBasis::Completed, Couplings::Full)?))),
    row(
        "V-RESP-46",
        "the same: gap with 16 over 10 and 10 over 4 modes, largest of the three \
         moments",
        "-",
    )
    .against(MONOTONE)
    .at_most(0.99, || gap_ratio(Couplings::Full)),
    row("V-RESP-52", "the same with Moderate, 16 modes", "%")
        .against(SAME_EQUATION)
        .at_most(1.0, || Ok(100.0 * largest(&gaps(16, ModalBasis::Completed, MODERATE)?))),
    row("V-RESP-53", "the same with Moderate: gap with 16 over 10 and 10 over 4 modes", "-")
        .against(MONOTONE)
        .at_most(0.99, || gap_ratio(MODERATE)),
    row("V-RESP-35", "the same with Linear, 16 modes", "%")
        .against(SAME_EQUATION)
        .at_most(1.0, || Ok(100.0 * largest(&gaps(16, ModalBasis::Completed, Couplings::Linear)?))),
    row("V-RESP-36", "the same with Linear: gap with 16 over 10 and 10 over 4 modes", "-")
        .against(MONOTONE)
        .at_most(0.99, || gap_ratio(Couplings::Linear)),
    row("V-RESP-54", "the same with 16 natural modes at .25, .5, .75 R, Full and Moderate", "%")
        .against(SAME_EQUATION)
        .at_most(1.0, || {
            let gaps = [Couplings::Full, MODERATE].map(|couplings| {
                Ok(100.0 * largest(&gaps(16, ModalBasis::Natural, couplings)?[1..]))
            });
            worst("couplings", 2, gaps)
        }),
    row(
        "V-RESP-37",
        "the same with 16 natural modes at the root, Full: what mode displacement \
         misses where torsion is loaded to the root",
        "%",
    )
    .against(SAME_EQUATION)
    .between(10.0, 40.0, || {
        Ok(100.0 * largest(&gaps(16, ModalBasis::Natural, Couplings::Full)?[..1]))
    }),
    row(
        "V-RESP-55",
        "forces and moments of force summation at the root, unsteady sections, \
         gravity, Full and Moderate, harmonics 0 to 12: off the load on the hub \
         (but for the torque of Moderate, V-RESP-64); at the tip: off zero",
        "m0 Omega^2 R^2",
    )
    .against("identity")
    .at_most(1e-14, end_error),
    row(
        "V-RESP-64",
        "torque of Moderate, the reaction at the azimuth, off the lag moment, the \
         reaction at the lag slope: largest of mean and harmonics to 12 over the \
         largest",
        "%",
    )
    .against("third order in the deflection")
    .at_most(3.0, torque_gap),
    row(
        "V-RESP-56",
        "tension of a stiff blade in vacuum at 0, .1, .333, .5, .75 R, Full and \
         Moderate: largest error",
        "%",
    )
    .against("(1 - s^2) / 2")
    .at_most(1e-4, tension_error),
    row(
        "V-RESP-57",
        "terms of third order in the moments at root, .25, .5, .75 R: statics of \
         the deflected blade off the force summation of Full at any azimuth, over \
         the largest peak to peak along the span",
        "%",
    )
    .against("the statics of the deflected blade")
    .at_most(5.0, ordering),
];

const MODERATE: Couplings = Couplings::Moderate(TorsionTerms {
    untwist: rotor_fem::Untwist::Included,
    angle: rotor_fem::TwistAngle::Rotation,
});

const STATIONS: [f64; 4] = [0.0, 0.25, 0.5, 0.75];

fn largest(gaps: &[[f64; 3]]) -> f64 {
    gaps.iter().flatten().fold(0.0, |largest, gap| gap.max(largest))
}

fn solved(
    model: RotorModel,
    blade: &BladeProperties,
    discretisation: Discretisation,
    (condition, stations): (&Condition, &[f64]),
) -> Result<(RotorSolution, Vec<StationLoads>), Failure> {
    let rotor = Arc::new(Rotor::new(model, blade, discretisation)?);
    let mu = condition.flight.advance_ratio;
    let mut solver = RotorSolver::new(rotor, mu, ResponseTolerances::default())?;
    let inflow = LinearInflow::Prescribed { induced_inflow: 0.008 };
    let found = solver.solve(condition, &inflow, None)?;
    let loads = solver.station_loads(condition, &found, stations)?;
    Ok((found, loads))
}

/// Mean and harmonics to 4/rev as pairs of cosine and sine.
fn harmonics(series: &HarmonicSeries) -> [[f64; 2]; 5] {
    std::array::from_fn(|n| match n {
        0 => [series.mean, 0.0],
        n => [series.harmonic(n).cosine, series.harmonic(n).sine],
    })
}

/// Distance of the three moments of two kinds, over the largest of that harmonic of the moment along the span:
/// worst harmonic, by station and moment.
fn distances(
    loads: &[StationLoads],
    kinds: [fn(&StationLoads) -> &LoadHistory<3>; 2],
) -> Vec<[f64; 3]> {
    let size = |[c, s]: [f64; 2]| c.hypot(s);
    let of = |at: &StationLoads, kind: usize, k: usize| harmonics(&kinds[kind](at).harmonics[k]);
    let distance = |at: &StationLoads, k: usize, n: usize| {
        let most = loads.iter().map(|at| size(of(at, 0, k)[n])).fold(0.0, f64::max);
        let [a, b] = [of(at, 0, k)[n], of(at, 1, k)[n]];
        size([a[0] - b[0], a[1] - b[1]]) / most
    };
    let worst =
        |at: &StationLoads, k: usize| (0..5).map(|n| distance(at, k, n)).fold(0.0, f64::max);
    loads.iter().map(|at| std::array::from_fn(|k| worst(at, k))).collect()
}

/// What the gaps were found for, and the gaps.
type Known = ((usize, ModalBasis, Couplings), Vec<[f64; 3]>);

/// Gaps that several rows ask for: a response of 48 modes takes a while.
static KNOWN: Mutex<Vec<Known>> = Mutex::new(Vec::new());

/// Gaps of curvature off force summation by station and moment. Without modal damping, which has no
/// distribution along the span.
fn gaps(modes: usize, basis: ModalBasis, couplings: Couplings) -> Result<Vec<[f64; 3]>, Failure> {
    let question = (modes, basis, couplings);
    let mut known = KNOWN.lock().unwrap_or_else(std::sync::PoisonError::into_inner);
    if let Some((_, gaps)) = known.iter().find(|(of, _)| *of == question) {
        return Ok(gaps.clone());
    }
    let discretisation = Discretisation {
        blade_elements: 40,
        modes: [modes; 3],
        basis,
        time_elements: 12,
        ..Discretisation::default()
    };
    let model = RotorModel { modal_damping: 0.0, ..paper_rotor(couplings, 0.35) };
    let at = (&fixed_controls(), &STATIONS[..]);
    let (_, loads) = solved(model, &paper_blade(1.0)?, discretisation, at)?;
    let gaps = distances(&loads, [|at| &at.moments, |at| &at.curvature]);
    known.push((question, gaps.clone()));
    Ok(gaps)
}

/// Largest ratio of the worst gap of a moment with more modes over that with less.
fn gap_ratio(couplings: Couplings) -> Result<f64, Failure> {
    let worst_of = |modes: usize| -> Result<[f64; 3], Failure> {
        let gaps = gaps(modes, ModalBasis::Completed, couplings)?;
        Ok(std::array::from_fn(|k| gaps.iter().map(|gap| gap[k]).fold(0.0, f64::max)))
    };
    let (few, more, most) = (worst_of(4)?, worst_of(10)?, worst_of(16)?);
    Ok((0..3).flat_map(|k| [more[k] / few[k], most[k] / more[k]]).fold(0.0, f64::max))
}

fn ordering() -> Result<f64, Failure> {
    let model = paper_rotor(Couplings::Full, 0.35);
    let at = (&fixed_controls(), &STATIONS[..]);
    let (_, loads) = solved(model, &paper_blade(1.0)?, Discretisation::default(), at)?;
    let shares = (0..3).flat_map(|k| {
        let swing = loads.iter().map(|at| at.moments.peak_to_peak()[k]).fold(0.0, f64::max);
        let apart = loads.iter().flat_map(move |at| {
            let both = at.moments.values.iter().zip(&at.statics.values);
            both.map(move |(a, b)| (a[k] - b[k]).abs())
        });
        apart.map(move |gap| gap / swing)
    });
    Ok(100.0 * shares.fold(0.0, f64::max))
}

fn torque_gap() -> Result<f64, Failure> {
    let model = RotorModel { couplings: MODERATE, flaps: vec![], ..RotorModel::paper_case() };
    let at = (&fixed_controls(), &[0.0][..]);
    let (found, loads) = solved(model, &paper_blade(1.0)?, Discretisation::default(), at)?;
    let parts = |series: &HarmonicSeries| -> Vec<f64> {
        let all = (1..=12).map(|n| series.harmonic(n)).flat_map(|h| [h.cosine, h.sine]);
        std::iter::once(series.mean).chain(all).collect()
    };
    let (torque, lag) = (parts(&found.root.components[5]), parts(&loads[0].moments.harmonics[1]));
    let gap = torque.iter().zip(&lag).map(|(a, b)| (a - b).abs()).fold(0.0, f64::max);
    Ok(100.0 * gap / torque.iter().fold(0.0_f64, |most, t| most.max(t.abs())))
}

fn end_error() -> Result<f64, Failure> {
    let errors = [Couplings::Full, MODERATE].map(|couplings| {
        let flaps = vec![];
        let model = RotorModel { couplings, flaps, gravity: 0.001, ..RotorModel::paper_case() };
        let at = (&fixed_controls(), &[0.0, 1.0][..]);
        let (found, loads) = solved(model, &paper_blade(1.0)?, Discretisation::default(), at)?;
        let parts = |series: &HarmonicSeries| -> Vec<f64> {
            let all = (1..=12).map(|n| series.harmonic(n)).flat_map(|h| [h.cosine, h.sine]);
            std::iter::once(series.mean).chain(all).collect()
        };
        let [root, tip] = [&loads[0], &loads[1]];
        // flap is the moment about -y
        let order = [(0, 1.0), (1, 1.0), (2, 1.0), (4, -1.0), (5, 1.0), (3, 1.0)];
        let summed = root.forces.harmonics.iter().chain(&root.moments.harmonics);
        let known = |component: usize| component < 5 || couplings == Couplings::Full;
        let both = summed.zip(order).filter(|(_, (component, _))| known(*component));
        let apart = both.flat_map(|(got, (component, sign))| {
            let expected = parts(&found.root.components[component]);
            parts(got).into_iter().zip(expected).map(move |(a, b)| (a - sign * b).abs())
        });
        let left = [&tip.forces, &tip.moments, &tip.statics].map(|h| h.values.clone()).concat();
        let left = left.into_iter().flatten().map(f64::abs);
        Ok(apart.chain(left).fold(0.0, f64::max))
    });
    worst("couplings", 2, errors)
}

fn tension_error() -> Result<f64, Failure> {
    let errors = [Couplings::Full, MODERATE].map(|couplings| {
        let model = RotorModel { lock_number: 1e-9, ..paper_rotor(couplings, 0.2) };
        let blade = BladeProperties::new(BladeSpec::uniform(1e6, 1e6, 1e6, 1e8))?;
        let at = (&fixed_controls(), &[0.0, 0.1, 0.333, 0.5, 0.75][..]);
        let (_, loads) = solved(model, &blade, Discretisation::default(), at)?;
        let error = |at: &StationLoads| {
            let expected = 0.5 * (1.0 - at.station * at.station);
            100.0 * (at.forces.harmonics[0].mean / expected - 1.0).abs()
        };
        Ok(loads.iter().map(error).fold(0.0, f64::max))
    });
    worst("couplings", 2, errors)
}
