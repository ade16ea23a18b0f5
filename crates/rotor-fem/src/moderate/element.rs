//! Residual, tangents, energies and momentum of one nonlinear 15-dof element.

use super::Scalar;
use super::inertia::{SectionState, Spin};
use super::points::{ElementPoints, MOTION, Point, STRAIN, SectionMatrix, add_at};
use super::strain::Turn;
use crate::beam::element::ElementMatrix;
use crate::beam::shape::ELEMENT_DOF;

/// Degrees of freedom of an element with two rates.
#[derive(Debug, Clone, Copy)]
pub(crate) struct ElementMotion<T> {
    pub(crate) value: [T; ELEMENT_DOF],
    pub(crate) rate: [T; ELEMENT_DOF],
    pub(crate) acceleration: [T; ELEMENT_DOF],
}

/// What is imposed on all elements: rotation, and root pitch with two rates.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Imposed {
    pub(crate) spin: Spin,
    pub(crate) pitch: [f64; 3],
}

/// Force with its derivatives in displacements, rates and accelerations.
#[derive(Debug, Clone)]
pub(crate) struct ElementTangent {
    pub(crate) force: [f64; ELEMENT_DOF],
    pub(crate) stiffness: ElementMatrix,
    pub(crate) damping: ElementMatrix,
    pub(crate) mass: ElementMatrix,
}

fn section_state<T: Scalar>(
    point: &Point,
    imposed: &Imposed,
    motion: &ElementMotion<T>,
) -> SectionState<T> {
    let [angle, rate, acceleration] = imposed.pitch;
    let variables = |dof: &[T; ELEMENT_DOF]| {
        let z = point.variables(dof);
        MOTION.map(|i| z[i])
    };
    SectionState {
        station: point.station,
        pitch: [angle + point.twist_rad, rate, acceleration].map(T::from_real),
        value: variables(&motion.value),
        rate: variables(&motion.rate),
        acceleration: variables(&motion.acceleration),
    }
}

/// Kinetic and strain energy.
pub(crate) fn energies<T: Scalar>(
    points: &ElementPoints,
    imposed: &Imposed,
    motion: &ElementMotion<T>,
) -> [T; 2] {
    let (mut kinetic, mut strain) = (T::zero(), T::zero());
    for point in &points.whole {
        let dx = T::from_real(point.dx);
        let state = section_state(point, imposed, motion);
        let s = point.strain(&motion.value);
        let turn = Turn::of(imposed.pitch[0] + point.twist_rad, &s);
        kinetic += dx * point.mass.energy(&imposed.spin, &state);
        strain += dx * point.stiffness.bending_energy(turn, &s);
    }
    for point in &points.stretch {
        let s = point.strain(&motion.value);
        let turn = Turn::of(imposed.pitch[0] + point.twist_rad, &s);
        strain += T::from_real(point.dx) * point.stiffness.stretch_energy(turn, &s);
    }
    [kinetic, strain]
}

/// Gradient of the strain energy in the degrees of freedom.
pub(crate) fn elastic_force<T: Scalar>(
    points: &ElementPoints,
    imposed: &Imposed,
    dof: &[T; ELEMENT_DOF],
) -> [T; ELEMENT_DOF] {
    let mut out = [T::zero(); ELEMENT_DOF];
    for point in &points.whole {
        let s = point.strain(dof);
        let turn = Turn::of(imposed.pitch[0] + point.twist_rad, &s);
        point.add_force(&mut out, &STRAIN, &point.stiffness.bending_force(turn, &s));
    }
    for point in &points.stretch {
        let s = point.strain(dof);
        let turn = Turn::of(imposed.pitch[0] + point.twist_rad, &s);
        let tension = point.stiffness.stretch(turn, &s).value * T::from_real(point.stiffness.axial);
        point.add_force(&mut out, &STRAIN, &point.stiffness.tension_force(turn, &s, tension));
    }
    out
}

/// Elastic plus inertial force.
pub(crate) fn force<T: Scalar>(
    points: &ElementPoints,
    imposed: &Imposed,
    motion: &ElementMotion<T>,
) -> [T; ELEMENT_DOF] {
    let mut out = elastic_force(points, imposed, &motion.value);
    for point in &points.whole {
        let state = section_state(point, imposed, motion);
        point.add_force(&mut out, &MOTION, &point.mass.force(&imposed.spin, &state));
    }
    out
}

/// Momentum, and gradient of the kinetic less the strain energy.
pub(crate) fn momentum<T: Scalar>(
    points: &ElementPoints,
    imposed: &Imposed,
    motion: &ElementMotion<T>,
) -> [[T; ELEMENT_DOF]; 2] {
    let mut momentum = [T::zero(); ELEMENT_DOF];
    let mut gradient = elastic_force(points, imposed, &motion.value).map(|f| -f);
    for point in &points.whole {
        let state = section_state(point, imposed, motion);
        let [p, g] = point.mass.momentum(&imposed.spin, &state);
        point.add_force(&mut momentum, &MOTION, &p);
        point.add_force(&mut gradient, &MOTION, &g);
    }
    [momentum, gradient]
}

/// Force with all its derivatives.
pub(crate) fn tangent(
    points: &ElementPoints,
    imposed: &Imposed,
    motion: &ElementMotion<f64>,
) -> ElementTangent {
    let mut out = ElementTangent {
        force: [0.0; ELEMENT_DOF],
        stiffness: ElementMatrix::zeros(),
        damping: ElementMatrix::zeros(),
        mass: ElementMatrix::zeros(),
    };
    for point in &points.whole {
        let s = point.strain(&motion.value);
        let turn = Turn::of(imposed.pitch[0] + point.twist_rad, &s);
        let inertia = point.mass.tangent(&imposed.spin, &section_state(point, imposed, motion));
        point.add_force(&mut out.force, &STRAIN, &point.stiffness.bending_force(turn, &s));
        point.add_force(&mut out.force, &MOTION, &inertia.force);
        let mut section = SectionMatrix::zeros();
        add_at(&mut section, &STRAIN, &point.stiffness.bending_stiffness(turn, &s));
        add_at(&mut section, &MOTION, &inertia.stiffness);
        point.add_matrix(&mut out.stiffness, &section);
        for (matrix, part) in [(&mut out.damping, &inertia.damping), (&mut out.mass, &inertia.mass)]
        {
            let mut section = SectionMatrix::zeros();
            add_at(&mut section, &MOTION, part);
            point.add_matrix(matrix, &section);
        }
    }
    for point in &points.stretch {
        let s = point.strain(&motion.value);
        let turn = Turn::of(imposed.pitch[0] + point.twist_rad, &s);
        let tension = point.stiffness.axial * point.stiffness.stretch(turn, &s).value;
        let pull = point.stiffness.tension_force(turn, &s, tension);
        point.add_force(&mut out.force, &STRAIN, &pull);
        let mut section = SectionMatrix::zeros();
        add_at(&mut section, &STRAIN, &point.stiffness.stretch_stiffness(turn, &s));
        point.add_matrix(&mut out.stiffness, &section);
    }
    out
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::moderate::{ModerateBlade, ModerateSpec};
    use crate::{BladeSpec, Twist};
    use nalgebra::Complex;

    const STEP: f64 = 1e-30;

    fn points() -> ElementPoints {
        let blade = BladeSpec {
            twist: Twist::Linear { rate_rad: -0.3 },
            ..BladeSpec::uniform(0.0108, 0.0268, 0.006_15, 20.0)
        };
        let spec = ModerateSpec {
            mass_centre: (-0.01).into(),
            tension_centre: 0.013.into(),
            ..blade.into()
        };
        ElementPoints::new(&ModerateBlade::new(spec).unwrap(), 0.4, 0.6)
    }

    fn imposed() -> Imposed {
        Imposed { spin: Spin::new(1.1, 0.05), pitch: [0.2, -0.3, 0.4] }
    }

    fn motion() -> ElementMotion<f64> {
        let wave = |a: f64, b: f64| std::array::from_fn(|i| a * (b * i as f64 + a).sin());
        ElementMotion { value: wave(0.1, 1.3), rate: wave(0.2, 2.1), acceleration: wave(0.3, 0.7) }
    }

    fn complex(m: &ElementMotion<f64>) -> ElementMotion<Complex<f64>> {
        ElementMotion {
            value: m.value.map(Complex::from),
            rate: m.rate.map(Complex::from),
            acceleration: m.acceleration.map(Complex::from),
        }
    }

    #[test]
    fn tangents_meet_the_complex_step_of_the_residual() {
        let (points, imposed) = (points(), imposed());
        let found = tangent(&points, &imposed, &motion());
        let again = force(&points, &imposed, &motion());
        let matrices = [&found.stiffness, &found.damping, &found.mass];
        for j in 0..ELEMENT_DOF {
            let error = (found.force[j] - again[j]).abs();
            assert!(error < 1e-14 * again[j].abs().max(1.0), "{j}: {error:e} of {}", again[j]);
            let mut moved = [complex(&motion()); 3];
            moved[0].value[j].im = STEP;
            moved[1].rate[j].im = STEP;
            moved[2].acceleration[j].im = STEP;
            for (which, (moved, matrix)) in moved.iter().zip(matrices).enumerate() {
                let exact = force(&points, &imposed, moved);
                for i in 0..ELEMENT_DOF {
                    let gap = (exact[i].im / STEP - matrix[(i, j)]).abs();
                    assert!(gap <= 1e-13 * matrix.amax(), "{which} {i} {j}: {gap:e}");
                }
            }
        }
    }

    #[test]
    fn elastic_force_and_momentum_meet_the_complex_step_of_the_energies() {
        let (points, imposed) = (points(), imposed());
        let [momentum, gradient] = momentum(&points, &imposed, &motion());
        for j in 0..ELEMENT_DOF {
            let mut moved = complex(&motion());
            moved.rate[j].im = STEP;
            let [kinetic, _] = energies(&points, &imposed, &moved);
            assert!((kinetic.im / STEP - momentum[j]).abs() < 1e-14, "momentum {j}");
            let mut moved = complex(&motion());
            moved.value[j].im = STEP;
            let [kinetic, strain] = energies(&points, &imposed, &moved);
            let exact = (kinetic - strain).im / STEP;
            assert!((exact - gradient[j]).abs() < 1e-12, "gradient {j}: {exact} {}", gradient[j]);
        }
    }
}
