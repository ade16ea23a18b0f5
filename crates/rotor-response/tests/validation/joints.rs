//! Joints of the root: what hinges and springs carry, printed and on the hub.

use std::sync::Arc;

use rotor_base::HarmonicSeries;
use rotor_fem::{BladeProperties, BladeSpec, Joint, ModalBasis, RootSupport, TorsionTerms};
use rotor_response::{
    Couplings, Discretisation, ResponseTolerances, Rotor, RotorModel, RotorSolution, RotorSolver,
    StationLoads,
};
use rotor_wake::LinearInflow;

use crate::rotor::{fixed_controls, paper_rotor};
use validation::{Check, Failure, row, too_few, worst};

const FREE: &str = "a free hinge carries no moment";

pub(crate) const ROWS: &[Check] = &[
    row(
        "V-RESP-59",
        "flap moment at a free central hinge, mean to 4/rev, as printed and on the \
         hub, default modal damping, gravity, Full and Moderate, over that at \
         mid-span",
        "relative",
    )
    .against(FREE)
    .at_most(1e-9, || central_hinge(Sum::Equations)),
    row(
        "V-RESP-60",
        "the same by the statics of the deflected blade: terms of third order, \
         which the bound must see",
        "relative",
    )
    .against("third order in the deflection")
    .between(1e-2, 0.2, || central_hinge(Sum::Statics)),
    row(
        "V-RESP-61",
        "flap and lag moment at free hinges at .04 R behind a pitch link, completed \
         modes, Full and Moderate, over that at mid-span",
        "relative",
    )
    .against(FREE)
    .at_most(1e-9, || {
        let both = COUPLINGS().map(|c| Ok(largest(&joints(c, HINGES, 9)?[..2])));
        worst("couplings", 2, both)
    }),
    row(
        "V-RESP-62",
        "flap, lag and pitch springs at .04 R: moment off stiffness times angle, 9 \
         completed modes, Full, over the moment at mid-span",
        "relative",
    )
    .against("k times angle")
    .at_most(1e-2, || Ok(largest(&joints(Couplings::Full, SPRINGS, 9)?))),
    row("V-RESP-63", "that with 9 over 5 completed modes: largest of the three joints", "-")
        .against("a truncation of the modes")
        .at_most(0.9, || {
            let few = joints(Couplings::Full, SPRINGS, 5)?;
            let many = joints(Couplings::Full, SPRINGS, 9)?;
            Ok(many.iter().zip(few).map(|(m, f)| m / f).fold(0.0, f64::max))
        }),
];

/// Which of the two sums.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Sum {
    Equations,
    Statics,
}

const COUPLINGS: fn() -> [Couplings; 2] =
    || [Couplings::Full, Couplings::Moderate(TorsionTerms::default())];

/// Stiffness of flap, lag and pitch.
const SPRINGS: [f64; 3] = [0.004, 0.01, 0.01];
const HINGES: [f64; 3] = [0.0, 0.0, 0.01];

/// Flight at mu .3 with fixed controls; loads at the root and at mid-span.
fn flown(
    spec: BladeSpec,
    model: RotorModel,
    discretisation: Discretisation,
) -> Result<(Arc<Rotor>, RotorSolution, [StationLoads; 2]), Failure> {
    let stations = [spec.root_offset, 0.5];
    let model = RotorModel { gravity: 0.001, ..model };
    let rotor = Arc::new(Rotor::new(model, &BladeProperties::new(spec)?, discretisation)?);
    let mut solver = RotorSolver::new(Arc::clone(&rotor), 0.3, ResponseTolerances::default())?;
    let inflow = LinearInflow::Prescribed { induced_inflow: 0.008 };
    let found = solver.solve(&fixed_controls(), &inflow, None)?;
    let loads = solver.station_loads(&fixed_controls(), &found, &stations)?;
    let found_stations = loads.len();
    let loads = loads.try_into().map_err(|_| too_few("stations", found_stations, 2))?;
    Ok((rotor, found, loads))
}

/// Mean, cosine and sine parts to 4 per rev.
fn parts(series: &HarmonicSeries) -> Vec<f64> {
    let harmonics = (1..=4).map(|n| series.harmonic(n)).flat_map(|h| [h.cosine, h.sine]);
    std::iter::once(series.mean).chain(harmonics).collect()
}

fn largest(of: &[f64]) -> f64 {
    of.iter().fold(0.0, |most, v| most.max(v.abs()))
}

fn central_hinge(sum: Sum) -> Result<f64, Failure> {
    let moments = COUPLINGS().map(|couplings| {
        let root = RootSupport { flap: Joint::Free, ..RootSupport::CLAMPED };
        let spec = BladeSpec { root, ..BladeSpec::table_1() };
        let model = paper_rotor(couplings, 0.2);
        let (_, found, [hinge, middle]) = flown(spec, model, Discretisation::default())?;
        let left = match sum {
            Sum::Statics => parts(&hinge.statics.harmonics[0]),
            Sum::Equations => {
                let hub = parts(&found.root.components[4]);
                [parts(&hinge.moments.harmonics[0]), hub].concat()
            }
        };
        Ok(largest(&left) / largest(&parts(&middle.moments.harmonics[0])))
    });
    worst("couplings", 2, moments)
}

/// Moment at the joints of flap, lag and pitch off stiffness times angle, over the moment at mid-span.
fn joints(couplings: Couplings, stiffness: [f64; 3], modes: usize) -> Result<[f64; 3], Failure> {
    let [flap, lag, feather] = stiffness.map(|stiffness| Joint::Spring { stiffness });
    let root = RootSupport { flap, lag, feather };
    let spec = BladeSpec { root, root_offset: 0.04, ..BladeSpec::table_1() };
    let model = RotorModel { modal_damping: 0.0, ..paper_rotor(couplings, 0.2) };
    let basis = ModalBasis::Completed;
    let d = Discretisation { modes: [modes; 3], basis, ..Discretisation::default() };
    let (rotor, found, [root, middle]) = flown(spec, model, d)?;
    let coordinates: Vec<Vec<f64>> = found.modal.iter().map(parts).collect();
    let angles: Vec<[f64; 3]> = (0..9)
        .map(|n| {
            let of_harmonic: Vec<f64> = coordinates.iter().map(|c| c[n]).collect();
            let [lag, flap, twist] = rotor.blade().joint_angles_rad(&of_harmonic);
            [flap, lag, twist]
        })
        .collect();
    Ok(std::array::from_fn(|k| {
        let moment = parts(&root.moments.harmonics[k]);
        let off: Vec<f64> =
            moment.iter().zip(&angles).map(|(m, angle)| m - stiffness[k] * angle[k]).collect();
        largest(&off) / largest(&parts(&middle.moments.harmonics[k]))
    }))
}
