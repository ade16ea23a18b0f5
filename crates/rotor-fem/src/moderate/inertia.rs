//! Kinetic energy of a section of the moderately deflected blade in the rotating frame: momentum,
//! inertial force and its derivatives.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use nalgebra::SMatrix;

use super::Scalar;
use super::strain::Turn;

/// Number of motion variables: `u v w v_x w_x phi`.
pub(crate) const MOTION_VARIABLES: usize = 6;

/// Places of the motion variables.
pub(crate) mod at {
    pub(crate) const V_X: usize = 3;
    pub(crate) const W_X: usize = 4;
    pub(crate) const PHI: usize = 5;
}

type Vector<T> = [T; 3];
/// Matrix over the motion variables.
pub(crate) type MotionMatrix = SMatrix<f64, MOTION_VARIABLES, MOTION_VARIABLES>;

/// Mass properties of a section, per length, about the elastic axis; rotor units.
///
/// The second moments are in two parts. That of the mass centre moves with the section in every
/// direction. The `flat` ones stay in the plane across the blade: they make torsional inertia and
/// propeller moment, but no rotary inertia of bending.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SectionMass {
    /// `m`.
    pub(crate) mass: f64,
    /// `m e_g`, mass centre ahead of the elastic axis.
    pub(crate) first: f64,
    /// Chordwise second moment of the mass centre, `m e_g^2`.
    pub(crate) centre: f64,
    /// Chordwise second moment that stays across the blade.
    pub(crate) flat_chord: f64,
    /// Thickness second moment that stays across the blade.
    pub(crate) flat_thickness: f64,
}

/// Rotation of the blade's frame: speed over nominal, and precone.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct Spin {
    /// Component of the angular velocity along the blade, `Omega sin(precone)`.
    pub(crate) along: f64,
    /// Component normal to it, `Omega cos(precone)`.
    pub(crate) across: f64,
}

impl Spin {
    #[inline(always)]
    pub(crate) fn new(speed: f64, precone_rad: f64) -> Self {
        let (sin, cos) = precone_rad.sin_cos();
        Self { along: speed * sin, across: speed * cos }
    }

    /// `omega x r`.
    #[inline(always)]
    fn turn<T: Scalar>(&self, r: &Vector<T>) -> Vector<T> {
        let (a, c) = (T::from_real(self.along), T::from_real(self.across));
        [-(c * r[1]), c * r[0] - a * r[2], a * r[1]]
    }
}

/// A vector of the rotating frame with its first two rates.
#[derive(Debug, Clone, Copy)]
struct Moving<T> {
    value: Vector<T>,
    rate: Vector<T>,
    acceleration: Vector<T>,
}

impl<T: Scalar> Moving<T> {
    #[inline(always)]
    fn fixed(value: Vector<T>) -> Self {
        Self { value, rate: [T::zero(); 3], acceleration: [T::zero(); 3] }
    }

    #[inline(always)]
    fn along_x(value: T, rate: T, acceleration: T) -> Self {
        let x = |component| [component, T::zero(), T::zero()];
        Self { value: x(value), rate: x(rate), acceleration: x(acceleration) }
    }

    /// Without its component along the blade.
    #[inline(always)]
    fn flat(&self) -> Self {
        let across = |v: &Vector<T>| [T::zero(), v[1], v[2]];
        Self {
            value: across(&self.value),
            rate: across(&self.rate),
            acceleration: across(&self.acceleration),
        }
    }

    #[inline(always)]
    fn negative(&self) -> Self {
        let minus = |v: &Vector<T>| v.map(|c| -c);
        Self {
            value: minus(&self.value),
            rate: minus(&self.rate),
            acceleration: minus(&self.acceleration),
        }
    }

    /// Velocity over ground, `r' + omega x r`.
    fn velocity(&self, spin: &Spin) -> Vector<T> {
        add(&self.rate, &spin.turn(&self.value))
    }

    /// Acceleration over ground at constant rotation, `r'' + 2 omega x r' + omega x (omega x r)`.
    #[inline(always)]
    fn absolute(&self, spin: &Spin) -> Vector<T> {
        let [x, y, z] = self.rate;
        let centrifugal = spin.turn(&spin.turn(&self.value));
        add(&self.acceleration, &add(&spin.turn(&[x + x, y + y, z + z]), &centrifugal))
    }
}

#[inline(always)]
fn add<T: Scalar>(a: &Vector<T>, b: &Vector<T>) -> Vector<T> {
    [a[0] + b[0], a[1] + b[1], a[2] + b[2]]
}

#[inline(always)]
fn dot<T: Scalar>(a: &Vector<T>, b: &Vector<T>) -> T {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

/// A field over the section that is linear in its coordinates: on the axis, per chordwise coordinate
/// eta (forward); that and the one per coordinate zeta (up) for the mass that stays across the blade.
#[derive(Debug, Clone, Copy)]
struct Field<V> {
    axis: V,
    eta: V,
    flat_eta: V,
    flat_zeta: V,
}

impl<T: Scalar> Field<Moving<T>> {
    #[inline(always)]
    fn new(axis: Moving<T>, eta: Moving<T>, zeta: Moving<T>) -> Self {
        Self { axis, eta, flat_eta: eta.flat(), flat_zeta: zeta.flat() }
    }

    #[inline(always)]
    fn map(&self, f: impl Fn(&Moving<T>) -> Vector<T>) -> Field<Vector<T>> {
        Field {
            axis: f(&self.axis),
            eta: f(&self.eta),
            flat_eta: f(&self.flat_eta),
            flat_zeta: f(&self.flat_zeta),
        }
    }

    #[inline(always)]
    fn values(&self) -> Field<Vector<T>> {
        self.map(|moving| moving.value)
    }
}

/// Motion variables of a section with two rates, and the pitch that comes from outside.
#[derive(Debug, Clone, Copy)]
pub(crate) struct SectionState<T> {
    /// Station r/R.
    pub(crate) station: f64,
    /// Pitch plus built-in twist and the rates of pitch, rad.
    pub(crate) pitch: [T; 3],
    /// `u v w v_x w_x phi`.
    pub(crate) value: [T; MOTION_VARIABLES],
    /// Their rates.
    pub(crate) rate: [T; MOTION_VARIABLES],
    /// Their accelerations.
    pub(crate) acceleration: [T; MOTION_VARIABLES],
}

/// The position of every point of the section.
///
/// ```text
/// r = (x + u, v, w) + eta d(th1) + zeta d(th1 + pi/2)
/// d(a) = (-v_x cos a - w_x sin a, cos a, sin a)
/// ```
#[derive(Debug, Clone, Copy)]
struct Geometry<T> {
    /// Cosine and sine of `th1` with two rates.
    unit: [[T; 2]; 3],
    position: Field<Moving<T>>,
    /// `d(th1 + pi/2)`, its component along the blade with it.
    zeta: Moving<T>,
}

/// A quarter turn takes `(cos, sin)` to `(-sin, cos)`.
#[inline(always)]
fn quarter<T: Scalar>(unit: &[[T; 2]; 3]) -> [[T; 2]; 3] {
    let [[c, s], [c1, s1], [c2, s2]] = *unit;
    [[-s, c], [-s1, c1], [-s2, c2]]
}

/// `d` with two rates, of a direction and the slopes of a section.
#[inline(always)]
fn across<T: Scalar>([e, e1, e2]: &[[T; 2]; 3], s: &SectionState<T>) -> Moving<T> {
    let [n, n1, n2] = [
        [s.value[at::V_X], s.value[at::W_X]],
        [s.rate[at::V_X], s.rate[at::W_X]],
        [s.acceleration[at::V_X], s.acceleration[at::W_X]],
    ];
    let along = |p: &[T; 2], q: &[T; 2]| p[0] * q[0] + p[1] * q[1];
    let mixed = along(&n1, e1);
    Moving {
        value: [-along(&n, e), e[0], e[1]],
        rate: [-along(&n1, e) - along(&n, e1), e1[0], e1[1]],
        acceleration: [-along(&n2, e) - mixed - mixed - along(&n, e2), e2[0], e2[1]],
    }
}

impl<T: Scalar> Geometry<T> {
    #[inline(always)]
    fn new(s: &SectionState<T>) -> Self {
        let zero = T::zero();
        let [a, b, c] = s.pitch;
        let Turn { sin, cos } = Turn::new(a, s.value[at::PHI]);
        let (t1, t2) = (s.rate[at::PHI] + b, s.acceleration[at::PHI] + c);
        let axis = |part: &[T; MOTION_VARIABLES], x: T| [part[0] + x, part[1], part[2]];
        let axis = Moving {
            value: axis(&s.value, T::from_real(s.station)),
            rate: axis(&s.rate, zero),
            acceleration: axis(&s.acceleration, zero),
        };
        let square = t1 * t1;
        let unit = [
            [cos, sin],
            [-(sin * t1), cos * t1],
            [-(cos * square) - sin * t2, cos * t2 - sin * square],
        ];
        let zeta = across(&quarter(&unit), s);
        Self { unit, position: Field::new(axis, across(&unit, s), zeta), zeta }
    }

    /// Derivatives of the position in the motion variables.
    fn jacobian(&self) -> [Field<Moving<T>>; MOTION_VARIABLES] {
        let (zero, one) = (T::zero(), T::one());
        let still = Moving::fixed([zero; 3]);
        let shift = |k: usize| {
            let unit = std::array::from_fn(|i| if i == k { one } else { zero });
            Field::new(Moving::fixed(unit), still, still)
        };
        let turned = quarter(&self.unit);
        let slope = |k: usize| {
            let along = |[e, e1, e2]: &[[T; 2]; 3]| Moving::along_x(-e[k], -e1[k], -e2[k]);
            Field::new(still, along(&self.unit), along(&turned))
        };
        let Field { eta, .. } = self.position;
        let zeta = self.zeta;
        [shift(0), shift(1), shift(2), slope(0), slope(1), Field::new(still, zeta, eta.negative())]
    }
}

impl SectionMass {
    /// Integral over the section of the product of two fields, per length.
    #[inline(always)]
    fn product<T: Scalar>(&self, f: &Field<Vector<T>>, g: &Field<Vector<T>>) -> T {
        let of = |moment: f64, value: T| value * T::from_real(moment);
        of(self.mass, dot(&f.axis, &g.axis))
            + of(self.first, dot(&f.axis, &g.eta) + dot(&f.eta, &g.axis))
            + of(self.centre, dot(&f.eta, &g.eta))
            + of(self.flat_chord, dot(&f.flat_eta, &g.flat_eta))
            + of(self.flat_thickness, dot(&f.flat_zeta, &g.flat_zeta))
    }

    /// Kinetic energy per length.
    ///
    /// ```text
    /// T = integral |r' + omega x r|^2 dm / 2,   omega = Omega (sin bp, 0, cos bp)
    /// ```
    /// Source: Hodges and Dowell, NASA TN D-7818 (1974), position of a point to second order.
    pub(crate) fn energy<T: Scalar>(&self, spin: &Spin, s: &SectionState<T>) -> T {
        let velocity = Geometry::new(s).position.map(|r| r.velocity(spin));
        self.product(&velocity, &velocity) * T::from_real(0.5)
    }

    /// Derivatives of the kinetic energy in the rates (momentum) and in the variables.
    pub(crate) fn momentum<T: Scalar>(
        &self,
        spin: &Spin,
        s: &SectionState<T>,
    ) -> [[T; MOTION_VARIABLES]; 2] {
        let geometry = Geometry::new(s);
        let velocity = geometry.position.map(|r| r.velocity(spin));
        let pair = |f: Field<Vector<T>>| self.product(&f, &velocity);
        let jacobian = geometry.jacobian();
        [
            std::array::from_fn(|k| pair(jacobian[k].values())),
            std::array::from_fn(|k| pair(jacobian[k].map(|r| r.velocity(spin)))),
        ]
    }

    /// Inertial force per length on the motion variables: what has to be added to the elastic force for
    /// a sum of zero, the acceleration over ground times mass.
    #[inline(always)]
    pub(crate) fn force<T: Scalar>(
        &self,
        spin: &Spin,
        s: &SectionState<T>,
    ) -> [T; MOTION_VARIABLES] {
        let Geometry { unit: [[cos, sin], ..], position, zeta } = Geometry::new(s);
        let of = |moment: f64, value: T| value * T::from_real(moment);
        let [axis, eta] = [position.axis.absolute(spin), position.eta.absolute(spin)];
        let chord = position.flat_eta.absolute(spin);
        let thickness = position.flat_zeta.absolute(spin);
        let along = of(self.first, axis[0]) + of(self.centre, eta[0]);
        let [_, q_y, q_z] = zeta.value;
        let turning = of(self.first, dot(&zeta.value, &axis))
            + of(self.centre, dot(&zeta.value, &eta))
            + of(self.flat_chord, q_y * chord[1] + q_z * chord[2])
            - of(self.flat_thickness, cos * thickness[1] + sin * thickness[2]);
        [
            of(self.mass, axis[0]) + of(self.first, eta[0]),
            of(self.mass, axis[1]) + of(self.first, eta[1]),
            of(self.mass, axis[2]) + of(self.first, eta[2]),
            -(cos * along),
            -(sin * along),
            turning,
        ]
    }

    /// Mass times acceleration per length as force and moment about the rotor centre, in the axes of
    /// the coned blade: `integral a dm`, `integral r x a dm`.
    ///
    /// It belongs to the same positions as [`force`](Self::force), so that the power of both agrees.
    pub(crate) fn wrench(&self, spin: &Spin, s: &SectionState<f64>) -> [f64; 6] {
        let position = Geometry::new(s).position;
        let acceleration = position.map(|r| r.absolute(spin));
        let still = Moving::fixed([0.0; 3]);
        let along = |k: usize| {
            let unit = std::array::from_fn(|i| if i == k { 1.0 } else { 0.0 });
            Field::new(Moving::fixed(unit), still, still).values()
        };
        let about = |k: usize| {
            let (i, j) = ((k + 1) % 3, (k + 2) % 3);
            position.map(|r| {
                let mut turned = [0.0; 3];
                (turned[i], turned[j]) = (-r.value[j], r.value[i]);
                turned
            })
        };
        std::array::from_fn(|k| {
            let field = if k < 3 { along(k) } else { about(k - 3) };
            self.product(&field, &acceleration)
        })
    }

    /// Force with its derivatives in variables, rates and accelerations.
    pub(crate) fn tangent(&self, spin: &Spin, s: &SectionState<f64>) -> InertialTangent {
        let g = Geometry::new(s);
        let acceleration = g.position.map(|r| r.absolute(spin));
        let jacobian = g.jacobian();
        let row = jacobian.each_ref().map(Field::values);
        let twice = jacobian.each_ref().map(|j| j.map(|r| r.velocity(spin).map(|c| 2.0 * c)));
        let absolute = jacobian.each_ref().map(|j| j.map(|r| r.absolute(spin)));
        let table = |columns: &[Field<Vector<f64>>; MOTION_VARIABLES]| {
            MotionMatrix::from_fn(|k, l| self.product(&row[k], &columns[l]))
        };
        let mut stiffness = table(&absolute);
        self.add_curving(&mut stiffness, &g, &acceleration);
        InertialTangent {
            force: std::array::from_fn(|k| self.product(&row[k], &acceleration)),
            mass: table(&row),
            damping: table(&twice),
            stiffness,
        }
    }

    /// Adds the part of the acceleration on the second derivatives of the position.
    fn add_curving(
        &self,
        stiffness: &mut MotionMatrix,
        g: &Geometry<f64>,
        acceleration: &Field<Vector<f64>>,
    ) {
        let [cos, sin] = g.unit[0];
        let fixed = |v: Vector<f64>| Moving::fixed(v);
        let pair = |eta: Vector<f64>, zeta: Vector<f64>| {
            let curving = Field::new(fixed([0.0; 3]), fixed(eta), fixed(zeta)).values();
            self.product(&curving, acceleration)
        };
        let lag = pair([sin, 0.0, 0.0], [cos, 0.0, 0.0]);
        let flap = pair([-cos, 0.0, 0.0], [sin, 0.0, 0.0]);
        for (place, value) in [(at::V_X, lag), (at::W_X, flap)] {
            stiffness[(place, at::PHI)] += value;
            stiffness[(at::PHI, place)] += value;
        }
        let back = |v: &Vector<f64>| v.map(|c| -c);
        stiffness[(at::PHI, at::PHI)] +=
            pair(back(&g.position.eta.value), back(&g.position.flat_zeta.value));
    }
}

/// Inertial force per length with its derivatives.
#[derive(Debug, Clone, Copy)]
pub(crate) struct InertialTangent {
    pub(crate) force: [f64; MOTION_VARIABLES],
    /// In the accelerations: symmetric.
    pub(crate) mass: MotionMatrix,
    /// In the rates: skew-symmetric for a blade at rest in the rotating frame.
    pub(crate) damping: MotionMatrix,
    /// In the variables: symmetric for a blade at rest in the rotating frame.
    pub(crate) stiffness: MotionMatrix,
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Complex;

    const STEP: f64 = 1e-30;

    fn mass() -> SectionMass {
        SectionMass { mass: 1.3, first: -0.2, centre: 0.15, flat_chord: 0.11, flat_thickness: 0.02 }
    }

    fn spin() -> Spin {
        Spin::new(1.2, 0.1)
    }

    fn state() -> SectionState<f64> {
        SectionState {
            station: 0.7,
            pitch: [0.3, -0.2, 0.4],
            value: [-0.05, 0.1, 0.2, 0.3, -0.4, 0.2],
            rate: [0.3, -0.6, 0.5, 0.9, -0.7, 0.8],
            acceleration: [0.2, 0.4, -0.3, 0.5, 0.6, -0.9],
        }
    }

    fn complex(s: &SectionState<f64>) -> SectionState<Complex<f64>> {
        SectionState {
            station: s.station,
            pitch: s.pitch.map(Complex::from),
            value: s.value.map(Complex::from),
            rate: s.rate.map(Complex::from),
            acceleration: s.acceleration.map(Complex::from),
        }
    }

    #[test]
    fn momentum_and_gradient_are_those_of_the_energy() {
        let (m, spin) = (mass(), spin());
        let [momentum, gradient] = m.momentum(&spin, &state());
        for k in 0..MOTION_VARIABLES {
            let mut moved = complex(&state());
            moved.rate[k].im = STEP;
            assert!((m.energy(&spin, &moved).im / STEP - momentum[k]).abs() < 1e-14, "{k}");
            let mut moved = complex(&state());
            moved.value[k].im = STEP;
            assert!((m.energy(&spin, &moved).im / STEP - gradient[k]).abs() < 1e-14, "{k}");
        }
    }

    /// Lagrange: the force is the rate of the momentum less the gradient of the energy.
    #[test]
    fn force_is_the_rate_of_momentum_less_the_gradient() {
        let (m, spin, s) = (mass(), spin(), state());
        let force = m.force(&spin, &s);
        let [_, gradient] = m.momentum(&spin, &s);
        let mut ahead = complex(&s);
        for k in 0..MOTION_VARIABLES {
            ahead.value[k].im = STEP * s.rate[k];
            ahead.rate[k].im = STEP * s.acceleration[k];
        }
        // pitch moves as the twist does: its motion is carried by the twist here
        ahead.value[at::PHI].im += STEP * s.pitch[1];
        ahead.rate[at::PHI].im += STEP * s.pitch[2];
        let [momentum, _] = m.momentum(&spin, &ahead);
        for k in 0..MOTION_VARIABLES {
            let expected = momentum[k].im / STEP - gradient[k];
            assert!((force[k] - expected).abs() < 1e-14, "{k}: {} {expected}", force[k]);
        }
    }

    /// Forces on the axis are the sums over the section, and the power of all inertial forces, those that
    /// turn the frame included, is the rate of the kinetic energy.
    #[test]
    fn the_power_of_wrench_and_force_is_the_rate_of_the_energy() {
        let (m, spin, s) = (mass(), spin(), state());
        let (force, wrench) = (m.force(&spin, &s), m.wrench(&spin, &s));
        for k in 0..3 {
            assert!((force[k] - wrench[k]).abs() < 1e-14, "{k}");
        }
        let mut ahead = complex(&s);
        for k in 0..MOTION_VARIABLES {
            ahead.value[k].im = STEP * s.rate[k];
            ahead.rate[k].im = STEP * s.acceleration[k];
        }
        ahead.value[at::PHI].im += STEP * s.pitch[1];
        ahead.rate[at::PHI] += Complex::new(s.pitch[1], STEP * s.pitch[2]);
        ahead.pitch = [s.pitch[0], 0.0, 0.0].map(Complex::from);
        let gained = m.energy(&spin, &ahead).im / STEP;
        let moving: f64 = force.iter().zip(s.rate).map(|(f, v)| f * v).sum();
        let turning = spin.along * wrench[3] + spin.across * wrench[5];
        let pitching = force[at::PHI] * s.pitch[1];
        let power = moving + pitching + turning;
        assert!((gained - power).abs() < 1e-13, "{gained} {power}");
        assert!(turning.abs() > 1e-2 && pitching.abs() > 1e-3);
    }

    #[test]
    fn tangents_are_the_gradients_of_the_force() {
        let (m, spin) = (mass(), spin());
        let tangent = m.tangent(&spin, &state());
        for (a, b) in tangent.force.iter().zip(m.force(&spin, &state())) {
            assert!((a - b).abs() < 1e-15);
        }
        for l in 0..MOTION_VARIABLES {
            let mut moved = [complex(&state()); 3];
            moved[0].value[l].im = STEP;
            moved[1].rate[l].im = STEP;
            moved[2].acceleration[l].im = STEP;
            let matrices = [&tangent.stiffness, &tangent.damping, &tangent.mass];
            for (which, (moved, matrix)) in moved.iter().zip(matrices).enumerate() {
                let force = m.force(&spin, moved);
                for k in 0..MOTION_VARIABLES {
                    let gap = force[k].im / STEP - matrix[(k, l)];
                    assert!(gap.abs() < 1e-13, "{which} {k} {l}: {gap:e}");
                }
            }
        }
    }
}
