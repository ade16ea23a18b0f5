//! Joints of the root: what a hinge, a spring and a pitch link carry.
#![allow(clippy::unwrap_used, reason = "a test fails by panicking")]
#![allow(clippy::print_stdout, reason = "the measured moments are worth seeing")]

use crate::common;

use common::{condition, paper_model, paper_spec};
use rotor_base::HarmonicSeries;
use rotor_fem::{
    BladeProperties, BladeSpec, Joint, ModalBasis, RootSupport, TorsionTerms, Twist, Untwist,
};
use rotor_response::{
    Condition, Couplings, Discretisation, ResponseTolerances, Rotor, RotorModel, RotorSolution,
    RotorSolver, StationLoads,
};
use rotor_wake::LinearInflow;
use std::sync::Arc;

const BOTH: [Couplings; 2] = [
    Couplings::Full,
    Couplings::Moderate(TorsionTerms {
        untwist: Untwist::Included,
        angle: rotor_fem::TwistAngle::Rotation,
    }),
];

/// Flight at mu .3; loads at the root and at mid-span.
fn flown(
    couplings: Couplings,
    spec: BladeSpec,
    (damping, modes): (f64, [usize; 3]),
) -> (RotorSolver, RotorSolution, Vec<StationLoads>) {
    let model = RotorModel { modal_damping: damping, gravity: 0.001, ..paper_model(couplings) };
    let stations = [spec.root_offset, 0.5];
    let basis = if modes[0] > 5 { ModalBasis::Completed } else { ModalBasis::Natural };
    let d = Discretisation { modes, basis, ..Discretisation::default() };
    let rotor = Rotor::new(model, &BladeProperties::new(spec).unwrap(), d).unwrap();
    let mut solver = RotorSolver::new(Arc::new(rotor), 0.3, ResponseTolerances::default()).unwrap();
    let condition = Condition { flap_angles_rad: vec![], ..condition() };
    let inflow = LinearInflow::Prescribed { induced_inflow: 0.008 };
    let found = solver.solve(&condition, &inflow, None).unwrap();
    let loads = solver.station_loads(&condition, &found, &stations).unwrap();
    (solver, found, loads)
}

/// Mean, cosine and sine parts to 4 per rev.
fn parts(series: &HarmonicSeries) -> Vec<f64> {
    let harmonics = (1..=4).map(|n| series.harmonic(n)).flat_map(|h| [h.cosine, h.sine]);
    std::iter::once(series.mean).chain(harmonics).collect()
}

fn size(of: impl IntoIterator<Item = f64>) -> f64 {
    of.into_iter().fold(0.0, |most, v| most.max(v.abs()))
}

fn supported(root: RootSupport, root_offset: f64) -> BladeSpec {
    BladeSpec { root, root_offset, ..paper_spec() }
}

/// A blade on a central flap hinge swings in its first mode: nothing is left at the hinge but rounding, with
/// modal damping too. The statics of the deflected blade leave terms of third order there.
#[test]
fn a_free_flap_hinge_carries_no_moment() {
    for couplings in BOTH {
        for damping in [0.0, 0.005] {
            let root = RootSupport { flap: Joint::Free, ..RootSupport::CLAMPED };
            let (_, found, at) = flown(couplings, supported(root, 0.0), (damping, [5, 4, 2]));
            let [hinge, middle] = [&at[0], &at[1]];
            let largest = size(parts(&middle.moments.harmonics[0]));
            let left = size(parts(&hinge.moments.harmonics[0])) / largest;
            let statics = size(parts(&hinge.statics.harmonics[0])) / largest;
            let hub = size(parts(&found.root.components[4])) / largest;
            println!("{couplings:?}: {left:.2e}, hub {hub:.2e}, statics {statics:.2e}");
            assert!(left < 1e-9 && hub < 1e-9, "{couplings:?}: {left:e} {hub:e}");
            assert!(statics > 1e-2, "{couplings:?}: {statics:e}");
        }
    }
}

/// Moments of flap, lag and torsion at springs off stiffness times angle, over the moment at mid-span.
fn spring_gaps(
    couplings: Couplings,
    spec: &BladeSpec,
    stiffness: [f64; 3],
    modes: [usize; 3],
) -> [f64; 3] {
    let (solver, found, at) = flown(couplings, spec.clone(), (0.0, modes));
    let coordinates: Vec<Vec<f64>> = found.modal.iter().map(parts).collect();
    let angles: Vec<[f64; 3]> = (0..9)
        .map(|n| {
            let q: Vec<f64> = coordinates.iter().map(|c| c[n]).collect();
            let [lag, flap, twist] = solver.rotor().blade().joint_angles_rad(&q);
            [flap, lag, twist]
        })
        .collect();
    std::array::from_fn(|k| {
        let expected = angles.iter().map(|a| stiffness[k] * a[k]);
        let moment = parts(&at[0].moments.harmonics[k]);
        let off = size(moment.iter().zip(expected).map(|(m, e)| m - e));
        off / size(parts(&at[1].moments.harmonics[k]))
    })
}

/// Hinges off the centre: the rotation about them is no natural mode but nearly, and what its equation leaves
/// falls with the modes; of completed modes it is one. A spring carries its stiffness times its angle.
#[test]
fn joints_carry_their_springs_and_nothing_else() {
    let spring = |stiffness| Joint::Spring { stiffness };
    let [k_flap, k_lag, k_feather] = [0.004, 0.01, 0.01];
    let free = RootSupport { feather: spring(k_feather), ..RootSupport::HINGED };
    let sprung =
        RootSupport { flap: spring(k_flap), lag: spring(k_lag), feather: spring(k_feather) };
    for couplings in BOTH {
        for (root, stiffness) in
            [(free, [0.0, 0.0, k_feather]), (sprung, [k_flap, k_lag, k_feather])]
        {
            let spec = supported(root, 0.04);
            let gap = |modes| spring_gaps(couplings, &spec, stiffness, modes);
            let [few, many] = [gap([5, 4, 3]), gap([9, 9, 6])];
            println!("{couplings:?} {stiffness:?}: {few:?} {many:?}");
            // tension on the built-in twist, which Moderate knows, is a twisting moment up to the root that the
            // modes, whose twist rate there is the spring's, meet with 1/N
            let twisted = if couplings == Couplings::Full { 1e-3 } else { 0.06 };
            let hinged = stiffness[0] == 0.0;
            let bent = if hinged { 1e-9 } else { 1e-2 };
            assert!(many[0] < bent && many[1] < bent && many[2] < twisted, "{many:?}");
            assert!(many.iter().zip(few).all(|(m, f)| *m < f), "{couplings:?}: {few:?} {many:?}");
        }
    }
}

/// What a pitch spring of `Moderate` carries beside its stiffness times its angle has one name: tension on the
/// built-in twist, `N k_A^2 th_x`. Without the term, or without the twist, the spring is met like that of `Full`.
#[test]
fn tension_on_the_built_in_twist_is_what_a_pitch_spring_is_off_by() {
    let stiffness = [0.004, 0.01, 0.01];
    let [flap, lag, feather] = stiffness.map(|stiffness| Joint::Spring { stiffness });
    let twisted = supported(RootSupport { flap, lag, feather }, 0.04);
    let straight = BladeSpec { twist: Twist::Linear { rate_rad: 0.0 }, ..twisted.clone() };
    let terms = TorsionTerms::default();
    let without = TorsionTerms { untwist: Untwist::Neglected, ..terms };
    for modes in [[5, 4, 3], [9, 9, 6]] {
        let of = |terms, spec: &BladeSpec| {
            spring_gaps(Couplings::Moderate(terms), spec, stiffness, modes)[2]
        };
        let [all, neglected, straight] =
            [of(terms, &twisted), of(without, &twisted), of(terms, &straight)];
        println!("{modes:?}: {all:.4}, without the term {neglected:.4}, untwisted {straight:.4}");
        assert!(neglected < 0.2 * all && straight < 0.2 * all, "{all} {neglected} {straight}");
    }
}
