//! Derivatives of the modal force in coordinates, rates and accelerations.

use nalgebra::{DMatrix, SVector};

use super::PitchMotion;
use super::inertia::MOTION_VARIABLES;
use super::modal::{Coordinates, ModalBlade, ModalMotion, Station};
use super::section_shape::SectionShape;
use super::strain::{Curvatures, STRAIN_VARIABLES, SectionStiffness, at};

/// Modal force with its derivatives.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalTangent {
    /// Elastic plus inertial force on each mode.
    pub force: Vec<f64>,
    /// Derivative in the coordinates.
    pub stiffness: DMatrix<f64>,
    /// Derivative in the rates.
    pub damping: DMatrix<f64>,
    /// Derivative in the accelerations, symmetric.
    pub mass: DMatrix<f64>,
}

type Motion = SVector<f64, MOTION_VARIABLES>;

impl ModalBlade {
    /// Modal force with its consistent derivatives at one azimuth. A pure function of its arguments.
    ///
    /// # Panics
    /// If the motion has another number of coordinates than there are modes.
    pub fn tangent(&self, motion: ModalMotion<'_>, pitch: PitchMotion) -> ModalTangent {
        let ModalMotion { value, rate, acceleration } = motion;
        let loaded = self.loaded(&Coordinates { value, rate, acceleration }, &pitch);
        let count = self.modes();
        let mut out = ModalTangent {
            force: loaded.generalised,
            stiffness: DMatrix::from_fn(count, count, |a, b| {
                self.spring_stiffness(&self.modes[a], &self.modes[b])
            }),
            damping: DMatrix::zeros(count, count),
            mass: DMatrix::zeros(count, count),
        };
        // axial displacement of each mode at each station, with two rates
        let axial: Vec<[Vec<f64>; 3]> = (0..count)
            .map(|a| {
                let slopes = [0, 1, 2].map(|k| {
                    let of = |(i, station): (usize, &Station<f64>)| {
                        let shape = self.modes[a].sections[i];
                        -shortening(&self.sections[i].stiffness, station, &shape)[k]
                    };
                    loaded.stations.iter().enumerate().map(of).collect::<Vec<f64>>()
                });
                slopes.each_ref().map(|slope| self.span.running(slope))
            })
            .collect();
        for (i, station) in loaded.stations.iter().enumerate() {
            let (section, weight) = (&self.sections[i], self.span.weights[i]);
            let inertia = section.mass.tangent(&self.spin, &station.state);
            let (theta, s) = (station.state.pitch[0], &station.strain[0]);
            let elastic = section.stiffness.bending_stiffness(theta, s)
                + section.stiffness.tension_stiffness(theta, s, loaded.tension[i]);
            let rows: Vec<Motion> = (0..count)
                .map(|a| {
                    let [v, w, v_x, w_x, phi] = self.modes[a].sections[i].motion();
                    Motion::from([axial[a][0][i], v, w, v_x, w_x, phi])
                })
                .collect();
            let strains: Vec<SVector<f64, STRAIN_VARIABLES>> = (0..count)
                .map(|a| {
                    let [b, c, d, e, f, g] = self.modes[a].sections[i].strain();
                    SVector::from([0.0, b, c, d, e, f, g])
                })
                .collect();
            for b in 0..count {
                let [_, u1, u2] = [0, 1, 2].map(|k| axial[b][k][i]);
                let [mass_u, damping_u] =
                    [inertia.mass.column(0).into_owned(), inertia.damping.column(0).into_owned()];
                let mass = inertia.mass * rows[b];
                let damping = inertia.damping * rows[b] + mass_u * (2.0 * u1);
                let stiffness = inertia.stiffness * rows[b] + damping_u * u1 + mass_u * u2;
                let bending = elastic * strains[b];
                for a in 0..count {
                    out.mass[(a, b)] += weight * rows[a].dot(&mass);
                    out.damping[(a, b)] += weight * rows[a].dot(&damping);
                    out.stiffness[(a, b)] +=
                        weight * (rows[a].dot(&stiffness) + strains[a].dot(&bending));
                }
            }
        }
        out
    }
}

/// Derivative of `q/2 + q^2/8`, `q = v_x^2 + w_x^2`, in the two slopes with two rates: `(v_x, w_x) (1 + q/2)`.
fn turning_shortens([s, s1, s2]: &[[f64; STRAIN_VARIABLES]; 3]) -> [[f64; 2]; 3] {
    let [a, b, c] = [s, s1, s2].map(|part| [part[at::V_X], part[at::W_X]]);
    let dot = |a: [f64; 2], b: [f64; 2]| a[0] * b[0] + a[1] * b[1];
    let growth = [1.0 + 0.5 * dot(a, a), dot(a, b), dot(b, b) + dot(a, c)];
    [
        a.map(|slope| slope * growth[0]),
        [0, 1].map(|k| b[k] * growth[0] + a[k] * growth[1]),
        [0, 1].map(|k| c[k] * growth[0] + 2.0 * b[k] * growth[1] + a[k] * growth[2]),
    ]
}

/// Derivative of the shortening per length in a mode's coordinate, with its two rates.
fn shortening(
    stiffness: &SectionStiffness,
    station: &Station<f64>,
    shape: &SectionShape,
) -> [f64; 3] {
    let [s, s1, s2] = &station.strain;
    let pitch = station.state.pitch;
    let (t1, t2) = (s1[at::PHI] + pitch[1], s2[at::PHI] + pitch[2]);
    let k = Curvatures::new(pitch[0], 0.0, s);
    let [sin, cos] = [k.z.gradient[at::W_XX], k.z.gradient[at::V_XX]];
    let lag = [cos, -sin * t1, -cos * t1 * t1 - sin * t2];
    let flap = [sin, cos * t1, cos * t2 - sin * t1 * t1];
    let along = |part: &[f64; STRAIN_VARIABLES]| part[at::V_XX] * cos + part[at::W_XX] * sin;
    let ahead = |part: &[f64; STRAIN_VARIABLES]| part[at::W_XX] * cos - part[at::V_XX] * sin;
    let twist = [
        k.y.value,
        ahead(s1) - t1 * k.z.value,
        ahead(s2) - 2.0 * t1 * along(s1) - t2 * k.z.value - t1 * t1 * k.y.value,
    ];
    let turning = turning_shortens(&station.strain);
    let pretwist = [stiffness.twist_rate, 0.0, 0.0];
    let ([_, v_x, v_xx], [_, w_x, w_xx], [phi, phi_x]) = (shape.lag, shape.flap, shape.twist);
    std::array::from_fn(|n| {
        let part = &station.strain[n];
        turning[n][0] * v_x
            + turning[n][1] * w_x
            + stiffness.area_radius_squared * (pretwist[n] + part[at::PHI_X]) * phi_x
            - stiffness.tension_centre * (lag[n] * v_xx + flap[n] * w_xx + twist[n] * phi)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::moderate::modal::ModalShape;
    use crate::moderate::{ModerateBlade, ModerateSpec, RotaryInertia};
    use crate::{BladeSpec, Twist};
    use crate::{Joint, RootSupport};
    use nalgebra::Complex;

    const STEP: f64 = 1e-30;
    const MODES: usize = 5;

    /// Arbitrary smooth shapes: no equation asks for modes.
    fn shape(k: usize, x: f64) -> SectionShape {
        let a = 1.0 + k as f64;
        let wave = |b: f64, p: f64| {
            let z = b * a * x + p;
            [x * x * z.sin(), 2.0 * x * z.sin() + x * x * b * a * z.cos(), {
                let d = b * a;
                (2.0 - x * x * d * d) * z.sin() + 4.0 * x * d * z.cos()
            }]
        };
        let twist = wave(0.8, 0.9);
        SectionShape { lag: wave(0.7, 0.3), flap: wave(1.1, 0.1), twist: [twist[0], twist[1]] }
    }

    fn blade() -> ModalBlade {
        let spec = ModerateSpec {
            mass_centre: (-0.01).into(),
            tension_centre: 0.02.into(),
            rotary_inertia: RotaryInertia::Included,
            ..BladeSpec {
                root: RootSupport {
                    flap: Joint::Spring { stiffness: 0.3 },
                    lag: Joint::Spring { stiffness: 0.2 },
                    feather: Joint::Spring { stiffness: 0.1 },
                },
                twist: Twist::Linear { rate_rad: -0.3 },
                precone_rad: 0.05,
                root_offset: 0.1,
                area_gyration_radius: 0.1.into(),
                ..BladeSpec::uniform(0.0108, 0.0268, 0.006_15, 5.0)
            }
            .into()
        };
        let edges = [0.1, 0.4, 0.7, 1.0];
        let sample = |k: usize| ModalShape {
            root: shape(k, 0.1),
            sections: ModalBlade::stations_of(&edges, 8)
                .unwrap()
                .into_iter()
                .map(|x| shape(k, x))
                .collect(),
        };
        let mut base = sample(7);
        for section in base.sections.iter_mut().chain([&mut base.root]) {
            let scale = |v: &mut f64| *v *= 0.05;
            section.lag.iter_mut().for_each(scale);
            section.flap.iter_mut().for_each(scale);
            section.twist.iter_mut().for_each(scale);
        }
        let blade = ModerateBlade::new(spec).unwrap();
        ModalBlade::new(&blade, &edges, 8, Some(base), (0..MODES).map(sample).collect()).unwrap()
    }

    fn pitch() -> PitchMotion {
        PitchMotion { angle_rad: 0.2, rate: -0.15, acceleration: 0.12 }
    }

    fn state() -> [[f64; MODES]; 3] {
        [0.04, 0.2, 0.3].map(|a| std::array::from_fn(|k| a * (1.7 * k as f64 + 9.0 * a).sin()))
    }

    #[test]
    fn tangents_meet_the_complex_step_of_the_force() {
        let blade = blade();
        let [value, rate, acceleration] = state();
        let motion = ModalMotion { value: &value, rate: &rate, acceleration: &acceleration };
        let found = blade.tangent(motion, pitch());
        assert_eq!(found.force, blade.force(motion, pitch()).generalised);
        let matrices = [&found.stiffness, &found.damping, &found.mass];
        for (which, matrix) in matrices.into_iter().enumerate() {
            for b in 0..MODES {
                let mut moved = state().map(|part| part.map(Complex::from));
                moved[which][b].im = STEP;
                let [value, rate, acceleration] = &moved;
                let coordinates = Coordinates { value, rate, acceleration };
                let exact = blade.loaded(&coordinates, &pitch()).generalised;
                for a in 0..MODES {
                    let gap = (exact[a].im / STEP - matrix[(a, b)]).abs();
                    assert!(gap < 1e-12 * matrix.amax(), "{which} {a} {b}: {gap:e}");
                }
            }
        }
    }

    /// Lagrange's equations of the whole blade, the rate of momentum by central difference in time.
    #[test]
    fn force_is_that_of_the_lagrangian() {
        let blade = blade();
        let [value, rate, acceleration] = state();
        let at_time = |t: f64| {
            let p = pitch();
            let pitch = PitchMotion {
                angle_rad: p.angle_rad + t * p.rate + 0.5 * t * t * p.acceleration,
                rate: p.rate + t * p.acceleration,
                acceleration: p.acceleration,
            };
            let q: [f64; MODES] =
                std::array::from_fn(|k| value[k] + t * rate[k] + 0.5 * t * t * acceleration[k]);
            let qd: [f64; MODES] = std::array::from_fn(|k| rate[k] + t * acceleration[k]);
            (q, qd, pitch)
        };
        let lagrangian = |q: &[Complex<f64>], qd: &[Complex<f64>], pitch: &PitchMotion| {
            let none = [Complex::from(0.0); MODES];
            let coordinates = Coordinates { value: q, rate: qd, acceleration: &none };
            let mut sum = Complex::from(0.0);
            for (i, station) in blade.kinematics(&coordinates, pitch).iter().enumerate() {
                let section = &blade.sections[i];
                let kinetic = section.mass.energy(&blade.spin, &station.state);
                let theta = station.state.pitch[0];
                let strain = section.stiffness.bending_energy(theta, &station.strain[0]);
                sum += (kinetic - strain) * Complex::from(blade.span.weights[i]);
            }
            for (a, qa) in q.iter().enumerate() {
                let base = blade.spring_stiffness(&blade.modes[a], &blade.base);
                sum -= *qa * Complex::from(base);
                for (b, qb) in q.iter().enumerate() {
                    let k = blade.spring_stiffness(&blade.modes[a], &blade.modes[b]);
                    sum -= *qa * *qb * Complex::from(0.5 * k);
                }
            }
            sum
        };
        let slope = |t: f64, k: usize, of_rate: bool| {
            let (q, qd, pitch) = at_time(t);
            let (mut q, mut qd) = (q.map(Complex::from), qd.map(Complex::from));
            if of_rate {
                qd[k].im = STEP;
            } else {
                q[k].im = STEP;
            }
            lagrangian(&q, &qd, &pitch).im / STEP
        };
        let motion = ModalMotion { value: &value, rate: &rate, acceleration: &acceleration };
        let force = blade.force(motion, pitch()).generalised;
        for (k, got) in force.iter().enumerate() {
            let h = 1e-4;
            let momentum_rate = (8.0 * (slope(h, k, true) - slope(-h, k, true))
                - (slope(2.0 * h, k, true) - slope(-2.0 * h, k, true)))
                / (12.0 * h);
            let expected = momentum_rate - slope(0.0, k, false);
            let gap = (got - expected).abs();
            assert!(gap < 1e-9 * (1.0 + expected.abs()), "{k}: {got} {expected}");
        }
    }
}
