//! Strain energy of a section of the moderately deflected blade: measures, forces, stiffness.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use nalgebra::SMatrix;

use super::Scalar;

/// Number of strain variables.
pub(crate) const STRAIN_VARIABLES: usize = 7;

/// Places of the strain variables.
pub(crate) mod at {
    pub(crate) const U_X: usize = 0;
    pub(crate) const V_X: usize = 1;
    pub(crate) const W_X: usize = 2;
    pub(crate) const V_XX: usize = 3;
    pub(crate) const W_XX: usize = 4;
    pub(crate) const PHI: usize = 5;
    pub(crate) const PHI_X: usize = 6;
}

/// Elastic properties of a section, rotor units.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) struct SectionStiffness {
    /// `EI_y` about the chord line through the tension centre.
    pub(crate) flap: f64,
    /// `EI_z` about the chord's normal through the tension centre.
    pub(crate) lag: f64,
    /// `GJ`.
    pub(crate) torsion: f64,
    /// `EA`.
    pub(crate) axial: f64,
    /// `k_A^2`.
    pub(crate) area_radius_squared: f64,
    /// `e_A`, tension centre ahead of the elastic axis.
    pub(crate) tension_centre: f64,
    /// Rate of the built-in twist along the radius, as far as tension works on it.
    pub(crate) twist_rate: f64,
    /// 1 where bending in two planes twists the section by itself, else 0.
    pub(crate) bending_twist: f64,
}

/// A strain measure with its gradient in the strain variables.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Measure<T> {
    pub(crate) value: T,
    pub(crate) gradient: [T; STRAIN_VARIABLES],
}

/// The two curvatures and the rate of twist of a section.
///
/// ```text
/// kappa_z = v_xx cos th1 + w_xx sin th1      kappa_y = w_xx cos th1 - v_xx sin th1
/// kappa_x = phi_x + b w_x v_xx               th1 = pitch + twist + phi
/// ```
/// b is 1 where phi is the last of three rotations (lag, flap, pitch), 0 where it is the elastic twist.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Curvatures<T> {
    pub(crate) z: Measure<T>,
    pub(crate) y: Measure<T>,
    pub(crate) x: Measure<T>,
}

/// Sine and cosine of the angle `th1` of a section.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Turn<T> {
    pub(crate) sin: T,
    pub(crate) cos: T,
}

impl<T: Scalar> Turn<T> {
    /// At pitch plus built-in twist, rad, and an elastic twist.
    #[inline(always)]
    pub(crate) fn new(theta_rad: T, phi_rad: T) -> Self {
        let (sin, cos) = (phi_rad + theta_rad).sine_cosine();
        Self { sin, cos }
    }

    /// At pitch plus built-in twist, rad, and the strain variables.
    pub(crate) fn of(theta_rad: f64, s: &[T; STRAIN_VARIABLES]) -> Self {
        Self::new(T::from_real(theta_rad), s[at::PHI])
    }
}

impl<T: Scalar> Curvatures<T> {
    /// At the strain variables `s`, the angle th1 and the factor b.
    #[inline(always)]
    pub(crate) fn new(turn: Turn<T>, bending_twist: f64, s: &[T; STRAIN_VARIABLES]) -> Self {
        let b = T::from_real(bending_twist);
        let Turn { sin, cos } = turn;
        let (zero, one) = (T::zero(), T::one());
        let z = s[at::V_XX] * cos + s[at::W_XX] * sin;
        let y = s[at::W_XX] * cos - s[at::V_XX] * sin;
        Self {
            z: Measure { value: z, gradient: [zero, zero, zero, cos, sin, y, zero] },
            y: Measure { value: y, gradient: [zero, zero, zero, -sin, cos, -z, zero] },
            x: Measure {
                value: s[at::PHI_X] + b * s[at::W_X] * s[at::V_XX],
                gradient: [zero, zero, b * s[at::V_XX], b * s[at::W_X], zero, zero, one],
            },
        }
    }
}

impl SectionStiffness {
    /// Strain of the tension centre's fibre, with the shortening by twist.
    ///
    /// ```text
    /// e = u_x + q/2 + q^2/8 + k_A^2 (th_x phi_x + phi_x^2 / 2) - e_A kappa_z
    /// ```
    /// with `q = v_x^2 + w_x^2`: the foreshortening of a blade that turns by a finite angle, `1 - sqrt(1 - q)`, to fourth order. The
    /// centrifugal stiffness of a hinge close to the shaft is the small difference `e` of two terms of the size of the
    /// radius, and `q^2` is not small beside it.
    #[inline(always)]
    pub(crate) fn stretch<T: Scalar>(
        &self,
        turn: Turn<T>,
        s: &[T; STRAIN_VARIABLES],
    ) -> Measure<T> {
        let (half, twist_rate) = (T::from_real(0.5), T::from_real(self.twist_rate));
        let ka_2 = T::from_real(self.area_radius_squared);
        let ea = T::from_real(self.tension_centre);
        let [v_x, w_x, phi_x] = [s[at::V_X], s[at::W_X], s[at::PHI_X]];
        let bending = Curvatures::new(turn, self.bending_twist, s).z;
        let mut gradient = bending.gradient;
        for g in &mut gradient {
            *g = -ea * *g;
        }
        gradient[at::U_X] += T::one();
        let q = v_x * v_x + w_x * w_x;
        let growth = T::one() + half * q;
        gradient[at::V_X] += v_x * growth;
        gradient[at::W_X] += w_x * growth;
        gradient[at::PHI_X] += ka_2 * (twist_rate + phi_x);
        let value = s[at::U_X] + half * q * (T::one() + T::from_real(0.25) * q)
            - ea * bending.value
            + ka_2 * phi_x * (twist_rate + half * phi_x);
        Measure { value, gradient }
    }

    /// Energy per length of bending and torsion.
    ///
    /// ```text
    /// (EI_z kappa_z^2 + EI_y kappa_y^2 + GJ kappa_x^2) / 2
    /// ```
    /// Source: D. H. Hodges, E. H. Dowell, NASA TN D-7818 (1974), moderate-deflection strain energy; the
    /// trigonometric functions are kept whole. Not modelled: warping, shear.
    pub(crate) fn bending_energy<T: Scalar>(&self, turn: Turn<T>, s: &[T; STRAIN_VARIABLES]) -> T {
        let k = Curvatures::new(turn, self.bending_twist, s);
        let half = |stiffness: f64, value: T| value * value * T::from_real(0.5 * stiffness);
        half(self.lag, k.z.value) + half(self.flap, k.y.value) + half(self.torsion, k.x.value)
    }

    /// Energy per length of stretching, `EA e^2 / 2`.
    pub(crate) fn stretch_energy<T: Scalar>(&self, turn: Turn<T>, s: &[T; STRAIN_VARIABLES]) -> T {
        let e = self.stretch(turn, s).value;
        e * e * T::from_real(0.5 * self.axial)
    }

    /// Gradient of [`Self::bending_energy`].
    #[inline(always)]
    pub(crate) fn bending_force<T: Scalar>(
        &self,
        turn: Turn<T>,
        s: &[T; STRAIN_VARIABLES],
    ) -> [T; STRAIN_VARIABLES] {
        let k = Curvatures::new(turn, self.bending_twist, s);
        let mut out = [T::zero(); STRAIN_VARIABLES];
        for (stiffness, m) in [(self.lag, k.z), (self.flap, k.y), (self.torsion, k.x)] {
            let moment = m.value * T::from_real(stiffness);
            for (sum, g) in out.iter_mut().zip(m.gradient) {
                *sum += moment * g;
            }
        }
        out
    }

    /// Force of a tension `n` on the strain variables, `n` times the gradient of the stretch.
    #[inline(always)]
    pub(crate) fn tension_force<T: Scalar>(
        &self,
        turn: Turn<T>,
        s: &[T; STRAIN_VARIABLES],
        n: T,
    ) -> [T; STRAIN_VARIABLES] {
        let mut out = self.stretch(turn, s).gradient;
        for force in &mut out {
            *force = n * *force;
        }
        out
    }

    /// Force of bending, torsion and a tension `n` on the strain variables.
    #[inline(always)]
    pub(crate) fn elastic_force<T: Scalar>(
        &self,
        turn: Turn<T>,
        s: &[T; STRAIN_VARIABLES],
        n: T,
    ) -> [T; STRAIN_VARIABLES] {
        let mut out = self.bending_force(turn, s);
        for (sum, pull) in out.iter_mut().zip(self.tension_force(turn, s, n)) {
            *sum += pull;
        }
        out
    }

    /// Second derivatives of [`Self::bending_energy`], symmetric.
    pub(crate) fn bending_stiffness(
        &self,
        turn: Turn<f64>,
        s: &[f64; STRAIN_VARIABLES],
    ) -> SMatrix<f64, STRAIN_VARIABLES, STRAIN_VARIABLES> {
        let k = Curvatures::new(turn, self.bending_twist, s);
        let mut out = SMatrix::zeros();
        add_square(&mut out, self.lag, &k.z.gradient);
        add_square(&mut out, self.flap, &k.y.gradient);
        add_square(&mut out, self.torsion, &k.x.gradient);
        let [mz, my] = [self.lag * k.z.value, self.flap * k.y.value];
        add_rotation(&mut out, mz, &k.z, &k.y.gradient);
        // kappa_y is kappa_z a quarter turn ahead, so its own partner is -kappa_z
        add_rotation(&mut out, my, &k.y, &k.z.gradient.map(|g| -g));
        let coupling = self.torsion * k.x.value * self.bending_twist;
        add_pair(&mut out, at::W_X, at::V_XX, coupling);
        out
    }

    /// Second derivatives of the stretch, times a tension `n`, symmetric.
    pub(crate) fn tension_stiffness(
        &self,
        turn: Turn<f64>,
        s: &[f64; STRAIN_VARIABLES],
        n: f64,
    ) -> SMatrix<f64, STRAIN_VARIABLES, STRAIN_VARIABLES> {
        let k = Curvatures::new(turn, self.bending_twist, s);
        let mut out = SMatrix::zeros();
        let (v_x, w_x) = (s[at::V_X], s[at::W_X]);
        let growth = 1.0 + 0.5 * (v_x * v_x + w_x * w_x);
        out[(at::V_X, at::V_X)] = n * (growth + v_x * v_x);
        out[(at::W_X, at::W_X)] = n * (growth + w_x * w_x);
        add_pair(&mut out, at::V_X, at::W_X, n * v_x * w_x);
        out[(at::PHI_X, at::PHI_X)] = n * self.area_radius_squared;
        add_rotation(&mut out, -n * self.tension_centre, &k.z, &k.y.gradient);
        out
    }

    /// Second derivatives of [`Self::stretch_energy`], symmetric.
    pub(crate) fn stretch_stiffness(
        &self,
        turn: Turn<f64>,
        s: &[f64; STRAIN_VARIABLES],
    ) -> SMatrix<f64, STRAIN_VARIABLES, STRAIN_VARIABLES> {
        let e = self.stretch(turn, s);
        let mut out = self.tension_stiffness(turn, s, self.axial * e.value);
        add_square(&mut out, self.axial, &e.gradient);
        out
    }
}

type Stiffness = SMatrix<f64, STRAIN_VARIABLES, STRAIN_VARIABLES>;

/// `out += stiffness g g'`.
fn add_square(out: &mut Stiffness, stiffness: f64, g: &[f64; STRAIN_VARIABLES]) {
    for (i, gi) in g.iter().enumerate() {
        for (j, gj) in g.iter().enumerate() {
            out[(i, j)] += stiffness * gi * gj;
        }
    }
}

/// `out += moment` times the second derivatives of a curvature; `ahead` is the gradient of its partner
/// a quarter turn ahead, which is its own derivative in the twist.
fn add_rotation(
    out: &mut Stiffness,
    moment: f64,
    curvature: &Measure<f64>,
    ahead: &[f64; STRAIN_VARIABLES],
) {
    add_pair(out, at::V_XX, at::PHI, moment * ahead[at::V_XX]);
    add_pair(out, at::W_XX, at::PHI, moment * ahead[at::W_XX]);
    out[(at::PHI, at::PHI)] -= moment * curvature.value;
}

fn add_pair(out: &mut Stiffness, i: usize, j: usize, value: f64) {
    out[(i, j)] += value;
    out[(j, i)] += value;
}

#[cfg(test)]
mod tests {
    use super::*;
    use nalgebra::Complex;

    const STEP: f64 = 1e-30;
    const PITCH: f64 = 0.3;

    fn section() -> SectionStiffness {
        SectionStiffness {
            flap: 0.9,
            lag: 2.3,
            torsion: 0.4,
            axial: 30.0,
            area_radius_squared: 0.2,
            tension_centre: 0.15,
            twist_rate: -0.4,
            bending_twist: 0.7,
        }
    }

    const STATE: [f64; STRAIN_VARIABLES] = [-0.1, 0.3, -0.2, 0.7, -0.5, 0.25, 0.6];

    /// Derivative of every component of `f` in every variable by complex step.
    fn slope<const N: usize>(
        f: impl Fn(&[Complex<f64>; STRAIN_VARIABLES]) -> [Complex<f64>; N],
    ) -> [[f64; N]; STRAIN_VARIABLES] {
        std::array::from_fn(|i| {
            let mut moved = STATE.map(Complex::from);
            moved[i].im = STEP;
            f(&moved).map(|value| value.im / STEP)
        })
    }

    #[test]
    fn forces_are_the_gradient_of_the_energy() {
        let s = section();
        let bending = slope(|z| [s.bending_energy(Turn::of(PITCH, z), z)]);
        let force = s.bending_force(Turn::of(PITCH, &STATE), &STATE);
        let stretching = slope(|z| [s.stretch_energy(Turn::of(PITCH, z), z)]);
        let tension = s.axial * s.stretch(Turn::of(PITCH, &STATE), &STATE).value;
        let pull = s.tension_force(Turn::of(PITCH, &STATE), &STATE, tension);
        for i in 0..STRAIN_VARIABLES {
            assert!((bending[i][0] - force[i]).abs() < 1e-14, "{i}");
            assert!((stretching[i][0] - pull[i]).abs() < 1e-13, "{i}");
        }
        assert!(force.iter().map(|f| f.abs()).sum::<f64>() > 1.0);
    }

    #[test]
    fn stiffness_is_the_gradient_of_the_force() {
        let s = section();
        let bending = slope(|z| s.bending_force(Turn::of(PITCH, z), z));
        let stiffness = s.bending_stiffness(Turn::of(PITCH, &STATE), &STATE);
        let stretching = slope(|z| {
            let n = s.stretch(Turn::of(PITCH, z), z).value * Complex::from(s.axial);
            s.tension_force(Turn::of(PITCH, z), z, n)
        });
        let tangent = s.stretch_stiffness(Turn::of(PITCH, &STATE), &STATE);
        for i in 0..STRAIN_VARIABLES {
            for j in 0..STRAIN_VARIABLES {
                assert!((bending[i][j] - stiffness[(j, i)]).abs() < 1e-14, "bending {i} {j}");
                assert!((stretching[i][j] - tangent[(j, i)]).abs() < 1e-13, "stretch {i} {j}");
            }
        }
    }
}
