//! Floquet exponents of the blade in flight against closed forms of the flapping blade.
#![expect(clippy::unwrap_used, reason = "a test fails by panicking")]

use crate::common;

use common::{paper_blade, paper_model};
use flap_aero::{AttachedFlowModel, FlapChord, Mach, SectionCoefficients};
use nalgebra::Complex;
use rotor_base::gauss_legendre;
use rotor_fem::{BladeProperties, BladeSpec, Joint, ModeKind, RootSupport, TorsionTerms};
use rotor_response::{
    Condition, Controls, Couplings, Discretisation, ResponseTolerances, Rotor, RotorModel,
    RotorSolver, SectionLags, SectionOffsets, Stability,
};
use rotor_wake::{FlightState, LinearInflow};
use std::sync::Arc;

fn stability(model: RotorModel, blade: &BladeProperties, modes: [usize; 3], mu: f64) -> Stability {
    stability_with(model, blade, (modes, mu), SectionLags::Moving)
}

fn stability_with(
    model: RotorModel,
    blade: &BladeProperties,
    (modes, mu): ([usize; 3], f64),
    lags: SectionLags,
) -> Stability {
    let lifting = Controls { theta0_rad: 0.14, theta1c_rad: 0.01, theta1s_rad: -0.2 * mu };
    stability_at(model, blade, (modes, mu), (lags, lifting, 0.05))
}

fn stability_at(
    model: RotorModel,
    blade: &BladeProperties,
    (modes, mu): ([usize; 3], f64),
    (lags, controls, induced_inflow): (SectionLags, Controls, f64),
) -> Stability {
    let discretisation = Discretisation { modes, ..Discretisation::default() };
    let rotor = Rotor::new(model, blade, discretisation).unwrap();
    let mut solver = RotorSolver::new(Arc::new(rotor), mu, ResponseTolerances::default()).unwrap();
    let condition = Condition {
        bank_rad: 0.0,
        flight: FlightState { advance_ratio: mu, shaft_tilt_rad: 0.1 * mu },
        controls,
        flap_angles_rad: vec![],
    };
    let inflow = LinearInflow::Prescribed { induced_inflow };
    let solution = solver.solve(&condition, &inflow, None).unwrap();
    solver.stability_with(&condition, &solution, lags).unwrap()
}

/// A hinged rigid blade in hover: `b'' + (g/8) b' + (1 - g c/12) b = 0`. The last term is the lift of the
/// pitch rate `Omega b` of a flapped section at its three-quarter chord, `(g/2) (c/2) int x^2 dx b`.
#[test]
fn hovering_blade_flaps_with_a_sixteenth_of_the_lock_number() {
    let blade = hinged_blade();
    let model = RotorModel {
        root_cutout: 0.0,
        modal_damping: 0.0,
        drag_coefficient: 0.0,
        ..paper_model(Couplings::Linear)
    };
    let result = stability(model, &blade, [1, 0, 0], 0.0);
    let motion = result.least_stable().unwrap();
    let expected = -5.2 / 16.0;
    let frequency = (1.0_f64 - 5.2 * 0.055 / 12.0 - expected * expected).sqrt();
    println!("{motion:?}, expected {expected}, {frequency}");
    assert!((motion.growth_per_rad - expected).abs() < 1e-6, "{motion:?}");
    assert!((motion.frequency_per_rev - (1.0 - frequency)).abs() < 1e-6, "{motion:?}");
    // of 0.054, 0.946 and 1.054 per rev the size of the exponent picks the true one
    assert!((motion.modal_frequency_per_rev - frequency).abs() < 1e-6, "{motion:?}");
    let damping = -expected / (1.0_f64 - 5.2 * 0.055 / 12.0).sqrt();
    assert!((motion.damping_ratio() - damping).abs() < 1e-6, "{motion:?}");
    assert!((motion.multiplier.norm().ln() / std::f64::consts::TAU - expected).abs() < 1e-6);
}

/// Exponent of a hinged rigid blade in hover with all lag states of its sections, by Newton's method on its
/// characteristic equation; with `settled` they follow their inputs at once:
///
/// ```text
/// (s^2 + 1) / 3 = (rho c / 2) int x [ x ( direct . w + sum output input . w a p / (s + a p) ) + (c / 2) s rate . w ] dx
/// w = [ -x s, c ],   a = x / (c / 2)
/// ```
fn flapping_exponent(
    section: &SectionCoefficients,
    model: &RotorModel,
    settled: bool,
) -> Complex<f64> {
    let rule = gauss_legendre(40);
    let (chord, semichord) = (model.chord, 0.5 * model.chord);
    let residual = |s: Complex<f64>| {
        let lift: Complex<f64> = rule
            .nodes
            .iter()
            .zip(&rule.weights)
            .map(|(node, weight)| {
                let x = 0.5 * (node + 1.0);
                let w = [-s * x, Complex::from(chord)];
                let along = |row: &[f64; 4]| w[0] * row[0] + w[1] * row[1];
                let lags: Complex<f64> = section
                    .lags
                    .iter()
                    .map(|lag| {
                        let pole = lag.pole * x / semichord;
                        let follows = if settled { 1.0.into() } else { pole / (s + pole) };
                        along(&lag.input) * lag.output[0] * follows
                    })
                    .sum();
                let circulating = (along(&section.direct[0]) + lags) * x;
                (circulating + along(&section.rate[0]) * s * semichord) * (0.5 * weight * x)
            })
            .sum();
        (s * s + 1.0) / 3.0 - lift * (0.5 * model.density_chord())
    };
    let mut s = Complex::new(-0.3, 0.9);
    for _ in 0..50 {
        let step = 1e-6;
        let slope = (residual(s + step) - residual(s - step)) / (2.0 * step);
        s -= residual(s) / slope;
    }
    assert!(residual(s).norm() < 1e-12);
    s
}

/// A flap-hinged uniform blade, stiff in torsion.
fn hinged_blade() -> BladeProperties {
    BladeProperties::new(BladeSpec {
        root: RootSupport::HINGED,
        ..BladeSpec::uniform(0.0108, 0.0268, 0.00615, 1000.0)
    })
    .unwrap()
}

/// Structure and lags move together: the exponent is that of the characteristic equation with all lag states;
/// with settled lags that of the equation without. The lags raise the frequency of the flapping blade.
#[test]
fn exponents_are_those_of_blade_and_lags_together() {
    let blade = hinged_blade();
    let section_model = AttachedFlowModel::Incompressible;
    let model = RotorModel {
        root_cutout: 0.0,
        modal_damping: 0.0,
        drag_coefficient: 0.0,
        section_model,
        ..paper_model(Couplings::Linear)
    };
    let chord = FlapChord::new(0.2).unwrap();
    let section = section_model.coefficients(Mach::ZERO, chord).unwrap();
    let [settled, with_lags] = [true, false].map(|s| flapping_exponent(&section, &model, s));
    for (lags, expected) in [(SectionLags::Moving, with_lags), (SectionLags::Settled, settled)] {
        let result = stability_with(model.clone(), &blade, ([1, 0, 0], 0.0), lags);
        let motion = result.least_stable().unwrap();
        println!("{lags:?} {motion:?}, expected {expected}");
        assert!((motion.growth_per_rad - expected.re).abs() < 1e-5, "{motion:?} {expected}");
        assert!((motion.modal_frequency_per_rev - expected.im).abs() < 1e-5, "{motion:?}");
    }
    assert!((with_lags.re / settled.re - 1.0).abs() < 0.02, "{with_lags}");
    assert!((0.04..0.07).contains(&(with_lags.im - settled.im)), "{with_lags}");
}

/// The blade of the paper is stable in flight, its first lag motion least: little air damps it.
#[test]
fn the_paper_blade_is_stable_and_lags_longest() {
    let result = stability(paper_model(Couplings::Full), &paper_blade(), [4, 4, 2], 0.3);
    for motion in &result.motions {
        println!(
            "{} {}: {:+.4} per rad, {:.4} per rev",
            motion.kind, motion.number, motion.growth_per_rad, motion.frequency_per_rev
        );
    }
    assert!(result.is_stable());
    assert_eq!(result.motions.len(), 10);
    let least = result.least_stable().unwrap();
    assert_eq!(least.kind, ModeKind::Lag);
    let damped = result.least_damped().unwrap();
    assert!(damped.damping_ratio() > 0.004 && damped.damping_ratio() < 0.02, "{damped:?}");
    // every motion is found near its mode: frequencies of the uncoupled modes of the paper's blade
    for (kind, number, natural) in
        [(ModeKind::Lag, 1, 0.701), (ModeKind::Lag, 2, 4.30), (ModeKind::Torsion, 1, 4.59)]
    {
        let found = result.motions.iter().find(|m| (m.kind, m.number) == (kind, number)).unwrap();
        assert!((found.modal_frequency_per_rev - natural).abs() < 0.15, "{found:?}");
    }
}

/// Unsteady sections of the paper's case in flight: with its lags the blade has other damping than with settled
/// ones, and keeps its motions.
#[test]
fn lags_of_unsteady_sections_change_the_damping_in_flight() {
    let model = RotorModel { flaps: vec![], ..RotorModel::paper_case() };
    let of = |lags| stability_with(model.clone(), &paper_blade(), ([2, 2, 1], 0.3), lags);
    let (moving, settled) = (of(SectionLags::Moving), of(SectionLags::Settled));
    assert!(moving.motions.len() >= 5 && settled.motions.len() >= 5);
    for m in moving.motions.iter().chain(&settled.motions) {
        println!(
            "{} {} {:.4} {:.4}",
            m.kind, m.number, m.growth_per_rad, m.modal_frequency_per_rev
        );
    }
    for kind in [ModeKind::Flap, ModeKind::Lag, ModeKind::Torsion] {
        let one =
            |s: &Stability| *s.motions.iter().find(|m| (m.kind, m.number) == (kind, 1)).unwrap();
        let (a, b) = (one(&moving), one(&settled));
        println!("{kind}: {a:?}\n       {b:?}");
        assert!((a.modal_frequency_per_rev - b.modal_frequency_per_rev).abs() < 0.2);
    }
    let damping = |s: &Stability| s.motions.iter().map(|m| m.growth_per_rad).collect::<Vec<_>>();
    assert!(moving.is_stable() && damping(&moving) != damping(&settled));
}

fn divergence_ratio(model: RotorModel, spec: BladeSpec, modes: [usize; 3], mu: f64) -> f64 {
    let blade = BladeProperties::new(spec).unwrap();
    let discretisation = Discretisation { modes, ..Discretisation::default() };
    Rotor::new(model, &blade, discretisation).unwrap().torsional_divergence_ratio(mu)
}

/// A stiff blade in a stream much faster than its rotation is a straight wing: it diverges at
/// `GJ (pi/2)^2 = (rho c / 2) 2 pi e mu^2 / 2`, the classical strip-theory result.
#[test]
fn a_wing_diverges_at_the_classical_dynamic_pressure() {
    let offsets = SectionOffsets { aerodynamic_centre: 0.01, ..SectionOffsets::default() };
    let model = RotorModel { root_cutout: 0.0, offsets, ..paper_model(Couplings::Linear) };
    let (mu, gj) = (300.0_f64, 1e5_f64);
    let lift = 0.5 * model.density_chord() * std::f64::consts::TAU * 0.5 * mu * mu;
    let expected = lift * 0.01 / (gj * std::f64::consts::FRAC_PI_2.powi(2));
    let stiff = BladeSpec { torsion_stiffness: gj.into(), ..common::paper_spec() };
    let found = divergence_ratio(model.clone(), stiff.clone(), [1, 1, 2], mu);
    assert!((found / expected - 1.0).abs() < 1e-4, "{found} {expected}");
    let behind = SectionOffsets { aerodynamic_centre: -0.01, ..SectionOffsets::default() };
    assert!(divergence_ratio(RotorModel { offsets: behind, ..model }, stiff, [1, 1, 2], mu) == 0.0);
}

/// Where the ratio passes 1 a motion of a hovering blade at flat pitch that does not bend passes from dying out to growing
/// without a turn.
#[test]
fn a_hovering_blade_diverges_where_the_ratio_is_one() {
    let offsets = SectionOffsets { aerodynamic_centre: 0.01, ..SectionOffsets::default() };
    let model = RotorModel { offsets, modal_damping: 0.005, ..paper_model(Couplings::Linear) };
    let modes = [1, 1, 2];
    let of = |gj: f64| BladeSpec::uniform(1e3, 1e3, gj, 1e6);
    let ratio = |gj| divergence_ratio(model.clone(), of(gj), modes, 0.0);
    let (mut soft, mut stiff) = (1e-4, 0.00615);
    assert!(ratio(soft) > 1.0 && ratio(stiff) < 1.0);
    for _ in 0..40 {
        let middle = 0.5 * (soft + stiff);
        if ratio(middle) > 1.0 { soft = middle } else { stiff = middle }
    }
    for (gj, diverges) in [(0.97 * soft, true), (1.03 * soft, false)] {
        let blade = BladeProperties::new(of(gj)).unwrap();
        let still = (SectionLags::Moving, Controls::default(), 0.0);
        let motions = stability_at(model.clone(), &blade, (modes, 0.0), still).motions;
        let grows = motions.iter().any(|m| m.growth_per_rad > 0.0 && m.multiplier.im == 0.0);
        assert_eq!(grows, diverges, "gj {gj}, ratio {}: {motions:?}", ratio(gj));
    }
}

/// What damps is the air and the modal damping: without both nothing is left.
#[test]
fn a_blade_in_vacuum_without_damping_neither_grows_nor_dies() {
    let model =
        RotorModel { lock_number: 0.0, modal_damping: 0.0, ..paper_model(Couplings::Linear) };
    let result = stability(model, &paper_blade(), [2, 2, 1], 0.0);
    assert!(result.motions.iter().all(|m| m.growth_per_rad.abs() < 1e-9), "{:?}", result.motions);
}

/// A spring at the flap hinge raises the frequency of a rigid blade: `nu^2 = 1 + 3 k`, in the second-order
/// equations and in those of moderate deflection alike.
#[test]
fn a_hinge_spring_stiffens_the_flapping_blade() {
    let nu = 1.125_789_21_f64;
    let spring = Joint::Spring { stiffness: (nu * nu - 1.0) / 3.0 };
    let blade = BladeProperties::new(BladeSpec {
        root: RootSupport { flap: spring, ..RootSupport::CLAMPED },
        ..BladeSpec::uniform(1e3, 1e3, 1e3, 1e6)
    })
    .unwrap();
    for couplings in
        [Couplings::Linear, Couplings::Full, Couplings::Moderate(TorsionTerms::default())]
    {
        let model = RotorModel { lock_number: 1e-9, modal_damping: 0.0, ..paper_model(couplings) };
        let motion = stability(model, &blade, [1, 0, 0], 0.0).motions[0];
        assert!((motion.frequency_per_rev - (nu - 1.0)).abs() < 1e-5, "{couplings:?} {motion:?}");
    }
}

/// A hinged rigid blade in flight with all lag states of its sections, written down on its own and integrated over a
/// revolution by a Runge-Kutta method of fourth order:
///
/// ```text
/// (b'' + b) / 3 = (rho c / 2) int x [ U y + (c / 2) rate . w' ] dx,   U = x + mu sin psi
/// w = [ -x b' - mu cos psi b, c b ],   y = direct . w + sum output z,   z' = pole U / (c / 2) (input . w - z)
/// ```
/// The cut-out keeps reverse flow out, so that everything is smooth.
struct FlyingBlade {
    section: SectionCoefficients,
    chord: f64,
    half_density: f64,
    mu: f64,
    /// Stations and weights of the lifting span.
    stations: Vec<(f64, f64)>,
}

impl FlyingBlade {
    fn states(&self) -> usize {
        2 + self.stations.len() * self.section.lags.len()
    }

    /// Rates of `b, b'` and the lags, station by station.
    fn rates(&self, psi: f64, state: &[f64]) -> Vec<f64> {
        let (sin, cos) = (self.mu * psi.sin(), self.mu * psi.cos());
        let (b, rate, semichord) = (state[0], state[1], 0.5 * self.chord);
        let (section, lags) = (&self.section, self.section.lags.len());
        let mut rates = vec![0.0; state.len()];
        rates[0] = rate;
        let (mut moment, mut inertia) = (0.0, 1.0 / 3.0);
        for (s, &(x, weight)) in self.stations.iter().enumerate() {
            let speed = x + sin;
            let w = [-x * rate - cos * b, self.chord * b];
            // without the part of b'', which stands on the other side
            let w_rate = [sin * b - cos * rate, self.chord * rate];
            let along = |row: &[f64; 4], w: [f64; 2]| w[0] * row[0] + w[1] * row[1];
            let mut y = along(&section.direct[0], w);
            for (l, lag) in section.lags.iter().enumerate() {
                let k = 2 + s * lags + l;
                y += lag.output[0] * state[k];
                rates[k] = lag.pole * speed / semichord * (along(&lag.input, w) - state[k]);
            }
            let arm = weight * x * self.half_density;
            moment += arm * (speed * y + semichord * along(&section.rate[0], w_rate));
            inertia += arm * semichord * section.rate[0][0] * x;
        }
        rates[1] = (moment - b / 3.0) / inertia;
        rates
    }

    /// Multiplier nearest to another one.
    fn multiplier_near(&self, other: Complex<f64>, steps: usize) -> Complex<f64> {
        let (n, h) = (self.states(), std::f64::consts::TAU / steps as f64);
        let plus = |a: &[f64], factor: f64, b: &[f64]| -> Vec<f64> {
            a.iter().zip(b).map(|(a, b)| a + factor * b).collect()
        };
        let mut monodromy = nalgebra::DMatrix::zeros(n, n);
        for column in 0..n {
            let mut state = vec![0.0; n];
            state[column] = 1.0;
            for step in 0..steps {
                let psi = step as f64 * h;
                let k1 = self.rates(psi, &state);
                let k2 = self.rates(psi + 0.5 * h, &plus(&state, 0.5 * h, &k1));
                let k3 = self.rates(psi + 0.5 * h, &plus(&state, 0.5 * h, &k2));
                let k4 = self.rates(psi + h, &plus(&state, h, &k3));
                for (weight, k) in [(1.0, k1), (2.0, k2), (2.0, k3), (1.0, k4)] {
                    state = plus(&state, weight * h / 6.0, &k);
                }
            }
            monodromy.set_column(column, &nalgebra::DVector::from_vec(state));
        }
        let all = monodromy.complex_eigenvalues();
        let near = |a: &&Complex<f64>, b: &&Complex<f64>| {
            (**a - other).norm().total_cmp(&(**b - other).norm())
        };
        *all.iter().min_by(near).unwrap()
    }
}

/// Multipliers with moving lags in flight meet direct integration of blade and lags, 1e-9 of the largest; those with
/// settled lags do not.
#[test]
fn multipliers_with_lags_in_flight_meet_direct_integration() {
    let mu = 0.3;
    let blade = hinged_blade();
    let section_model = AttachedFlowModel::Incompressible;
    let model = RotorModel {
        root_cutout: 0.4,
        modal_damping: 0.0,
        drag_coefficient: 0.0,
        reverse_flow: rotor_response::ReverseFlow::Abrupt,
        section_model,
        ..paper_model(Couplings::Linear)
    };
    let section = section_model.coefficients(Mach::ZERO, FlapChord::new(0.2).unwrap()).unwrap();
    let rule = gauss_legendre(12);
    let half_span = 0.5 * (1.0 - model.root_cutout);
    let place = |node: f64| model.root_cutout + half_span * (node + 1.0);
    let stations = rule.nodes.iter().zip(&rule.weights);
    let flying = FlyingBlade {
        section,
        chord: model.chord,
        half_density: 0.5 * model.density_chord(),
        mu,
        stations: stations.map(|(&node, weight)| (place(node), half_span * weight)).collect(),
    };
    let off = |lags| {
        let found = stability_with(model.clone(), &blade, ([1, 0, 0], mu), lags);
        let multiplier = found.least_stable().unwrap().multiplier;
        let expected = flying.multiplier_near(multiplier, 2000);
        println!("{lags:?}: {multiplier}, directly {expected}");
        (multiplier - expected).norm() / expected.norm()
    };
    let [moving, settled] = [SectionLags::Moving, SectionLags::Settled].map(off);
    println!("off by {moving:.1e}, with settled lags {settled:.1e}");
    assert!(moving < 1e-9 && settled > 1e-2, "{moving:e} {settled:e}");
}
