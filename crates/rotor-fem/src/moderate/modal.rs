//! The moderately deflected blade in modal coordinates, its axial motion condensed.
//!
//! ```text
//! u_x = T0 / EA - q/2 - q^2/8 - k_A^2 (th_x phi_x + phi_x^2 / 2) + e_A kappa_z
//! ```
//! with `q = v_x^2 + w_x^2`. The stretch is that of the steady tension T0; everything else of the axial motion follows from
//! bending and twist, exactly and with its rates. The tension is then what axial equilibrium asks for,
//! and acts on the derivative of the right side: centrifugal stiffening, Coriolis tension, the tension's
//! part of torsion and the moment of an offset tension axis come out of one expression.
//!
//! Left out: the stretch by the changing part of the tension, of the order of its ratio to EA.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use super::inertia::{MOTION_VARIABLES, SectionMass, SectionState, Spin, at as motion_at};
use super::section_shape::SectionShape;
use super::span::Span;
use super::strain::{Curvatures, STRAIN_VARIABLES, SectionStiffness, Turn, at};
use super::{ModerateBlade, PitchMotion, Scalar};
use crate::FemError;
use pulp::{Arch, Simd, WithSimd};
use rotor_base::Lanes;

/// A displacement field of the blade at its root and at all stations.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalShape {
    /// At the root, for its springs.
    pub root: SectionShape,
    /// At the stations of the modal blade.
    pub sections: Vec<SectionShape>,
}

/// Modal coordinates with two rates in azimuth, in the numbers of the calculation.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModalMotion<'a, T = f64> {
    /// Coordinates, one for each mode.
    pub value: &'a [T],
    /// Rates.
    pub rate: &'a [T],
    /// Accelerations.
    pub acceleration: &'a [T],
}

/// What a motion asks of hub and pitch control, inertial and elastic: applied loads not counted.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalLoads {
    /// Axial displacement at each station, R.
    pub axial: Vec<f64>,
    /// Its radial derivative.
    pub axial_slope: Vec<f64>,
    /// Its rate in azimuth.
    pub axial_rate: Vec<f64>,
    /// Mass times acceleration per length at each station as force and moment about the rotor centre,
    /// in the axes of the coned blade.
    pub wrench: Vec<[f64; 6]>,
    /// The same as force on `u v w v_x w_x phi`, which the equations of motion are made of.
    pub inertial: Vec<[f64; 6]>,
    /// Elastic plus inertial moment on the pitch of the root, nose up, `m0 Omega^2 R^3`: the pitch control
    /// must supply it, less the applied one.
    pub pitch_moment: f64,
}

/// The blade at Gauss points along its span, with mode shapes.
#[derive(Debug, Clone)]
pub struct ModalBlade {
    span: Span,
    sections: Vec<Section>,
    modes: Vec<ModalShape>,
    /// Springs of the root on `v_x`, `w_x`, `phi`.
    springs: [f64; 3],
    spin: Spin,
}

/// Properties of one station.
#[derive(Debug, Clone, Copy)]
struct Section {
    twist_rad: f64,
    stiffness: SectionStiffness,
    mass: SectionMass,
    /// Stretch by the steady tension, `T0 / EA`.
    stretch: f64,
}

/// Motion of one station, the axial one included.
#[derive(Debug, Clone, Copy)]
struct Station<T> {
    state: SectionState<T>,
    turn: Turn<T>,
    strain: [[T; STRAIN_VARIABLES]; 3],
}

/// Everything at all stations.
struct Loaded<T> {
    stations: Vec<Station<T>>,
    inertial: Vec<[T; MOTION_VARIABLES]>,
    generalised: Vec<T>,
    pitch_moment: T,
}

impl ModalBlade {
    /// A blade whose motion is made of modes.
    ///
    /// | argument | meaning |
    /// |---|---|
    /// | `blade` | the blade, at its own rotor speed and precone; its pitch comes with the motion |
    /// | `edges` | ends of the pieces of quadrature r/R, from root to tip, growing; every break of the blade should be among them |
    /// | `points` | Gauss points in each piece, 2 to 16 |
    /// | `modes` | shapes at the stations that [`Self::stations_of`] gives for the same edges |
    ///
    /// # Errors
    /// [`FemError::Parameter`] for edges or points out of range, [`FemError::StationOrder`],
    /// [`FemError::ShapeCount`].
    pub fn new(
        blade: &ModerateBlade,
        edges: &[f64],
        points: usize,
        modes: Vec<ModalShape>,
    ) -> Result<Self, FemError> {
        let stations = Self::stations_of(edges, points)?;
        for (mode, shape) in modes.iter().enumerate() {
            let (found, expected) = (shape.sections.len(), stations.len());
            if found != expected {
                return Err(FemError::ShapeCount { mode, found, expected });
            }
        }
        let properties = blade.properties();
        let spec = properties.spec();
        let sections = stations
            .iter()
            .map(|&x| Section {
                twist_rad: properties.twist_rad(x),
                stiffness: blade.stiffness(x),
                mass: blade.mass(x),
                stretch: properties.tension(x) / properties.axial_stiffness(x),
            })
            .collect();
        let springs = spec.root.springs();
        let spin = Spin::new(spec.rotor_speed, spec.precone_rad);
        Ok(Self { span: Span::new(edges, points), sections, modes, springs, spin })
    }

    /// The stations r/R of a blade cut into pieces at `edges` with so many Gauss points in each.
    ///
    /// # Errors
    /// [`FemError::Parameter`] for less than two edges, edges off the blade, or points out of range,
    /// [`FemError::StationOrder`] for edges that do not grow.
    pub fn stations_of(edges: &[f64], points: usize) -> Result<Vec<f64>, FemError> {
        if !(2..=16).contains(&points) {
            let (value, expected) = (points as f64, "2 to 16 Gauss points");
            return Err(FemError::Parameter { field: "points", value, expected });
        }
        let ends = [edges.first(), edges.last()].map(|end| end.copied().unwrap_or(f64::NAN));
        if edges.len() < 2 || !(ends[0] >= 0.0 && (ends[1] - 1.0).abs() < 1e-12) {
            let expected = "growing stations r/R from the root to the tip, 1";
            return Err(FemError::Parameter { field: "edges", value: ends[1], expected });
        }
        for (i, pair) in edges.windows(2).enumerate() {
            if pair[1].partial_cmp(&pair[0]) != Some(std::cmp::Ordering::Greater) {
                let [previous, station] = [pair[0], pair[1]];
                let (field, index) = ("edges", i + 1);
                return Err(FemError::StationOrder { field, index, station, previous });
            }
        }
        Ok(Span::new(edges, points).stations)
    }

    /// Stations r/R, root side first.
    pub fn stations(&self) -> &[f64] {
        &self.span.stations
    }

    /// Weights of quadrature at the stations, R.
    pub fn weights(&self) -> &[f64] {
        &self.span.weights
    }

    /// Number of modes.
    pub fn modes(&self) -> usize {
        self.modes.len()
    }

    /// Elastic plus inertial force on each mode at one azimuth; the equations of motion set it equal to the
    /// applied one. A pure function of its arguments.
    ///
    /// # Panics
    /// If the motion has another number of coordinates than there are modes.
    pub fn force(&self, motion: ModalMotion<'_>, pitch: PitchMotion) -> Vec<f64> {
        self.loaded(&motion, &pitch).generalised
    }

    /// What the same motion asks of hub and pitch control. A pure function of its arguments.
    ///
    /// Force, moment and power belong together: over one revolution of a periodic motion the power of
    /// the applied loads equals that of hub, pitch control and damping.
    ///
    /// # Panics
    /// If the motion has another number of coordinates than there are modes.
    pub fn loads(&self, motion: ModalMotion<'_>, pitch: PitchMotion) -> ModalLoads {
        let loaded = self.loaded(&motion, &pitch);
        let of = |section: &Section, station: &Station<f64>| {
            section.mass.wrench(&self.spin, &station.state)
        };
        ModalLoads {
            axial: loaded.stations.iter().map(|s| s.state.value[0]).collect(),
            axial_slope: (self.sections.iter().zip(&loaded.stations))
                .map(|(section, station)| section.axial_slope(station)[0])
                .collect(),
            axial_rate: loaded.stations.iter().map(|s| s.state.rate[0]).collect(),
            wrench: self.sections.iter().zip(&loaded.stations).map(|(a, b)| of(a, b)).collect(),
            inertial: loaded.inertial,
            pitch_moment: loaded.pitch_moment,
        }
    }

    /// Elastic force per length on `v_x`, `w_x` and `phi` at the stations, of a blade that carries the given
    /// tension there: what bending, twist and tension do to the part outboard when it turns as a whole.
    ///
    /// # Panics
    /// If the numbers of coordinates or tensions do not fit.
    pub fn turning_forces(
        &self,
        value: &[f64],
        pitch: PitchMotion,
        tension: &[f64],
    ) -> Vec<[f64; 3]> {
        let stations = self.standing(value, &pitch);
        let of = |((station, section), n): ((&Station<f64>, &Section), &f64)| {
            let force = section.elastic_force(station, *n);
            [at::V_X, at::W_X, at::PHI].map(|k| force[k])
        };
        stations.iter().zip(&self.sections).zip(tension).map(of).collect()
    }

    /// What is not in balance on each mode under applied loads per length `[f_x, f_y, f_z, nose-up moment]` at the stations:
    /// elastic plus inertial force less the virtual work of the loads, that of the axial force on the foreshortening included. A
    /// pure function of its arguments.
    ///
    /// # Panics
    /// If the numbers of coordinates or loads do not fit.
    pub fn unbalanced(
        &self,
        motion: ModalMotion<'_>,
        pitch: PitchMotion,
        loads: &[[f64; 4]],
    ) -> Vec<f64> {
        self.left_by(&motion, &pitch, loads)
    }

    /// The same at azimuths side by side: in every lane what it is there, but for the rounding of sine and cosine.
    ///
    /// # Panics
    /// As [`unbalanced`](Self::unbalanced).
    pub fn unbalanced_side_by_side(
        &self,
        motion: ModalMotion<'_, Lanes>,
        pitch: PitchMotion<Lanes>,
        loads: &[[Lanes; 4]],
    ) -> Vec<Lanes> {
        Arch::new().dispatch(Unbalanced { blade: self, motion, pitch, loads })
    }

    #[inline(always)]
    fn left_by<T: Scalar>(
        &self,
        motion: &ModalMotion<'_, T>,
        pitch: &PitchMotion<T>,
        loads: &[[T; 4]],
    ) -> Vec<T> {
        let Loaded { stations, mut generalised, .. } = self.loaded(motion, pitch);
        let mut axial = Vec::with_capacity(loads.len());
        for load in loads {
            axial.push(load[0]);
        }
        let pull = self.span.to_tip(&axial);
        let of = |value: T, shape: f64| value * T::from_real(shape);
        let sections = self.sections.iter().zip(&stations);
        for (i, (section, station)) in sections.enumerate() {
            let [_, fy, fz, moment] = loads[i];
            let gradient = section.stiffness.stretch(station.turn, &station.strain[0]).gradient;
            let weight = self.span.weights[i];
            for (mode, left) in self.modes.iter().zip(&mut generalised) {
                let shape = &mode.sections[i];
                let mut shortening = T::zero();
                for (g, s) in gradient[1..].iter().zip(shape.strain()) {
                    shortening += of(*g, s);
                }
                let work =
                    of(fy, shape.lag[0]) + of(fz, shape.flap[0]) + of(moment, shape.twist[0]);
                *left -= of(work - pull[i] * shortening, weight);
            }
        }
        generalised
    }

    /// Motion of every station at rest in the rotating frame.
    fn standing(&self, value: &[f64], pitch: &PitchMotion) -> Vec<Station<f64>> {
        let zero = vec![0.0; value.len()];
        self.kinematics(&ModalMotion { value, rate: &zero, acceleration: &zero }, pitch)
    }

    /// Motion of every station from the modal coordinates.
    #[inline(always)]
    fn kinematics<T: Scalar>(
        &self,
        motion: &ModalMotion<'_, T>,
        pitch: &PitchMotion<T>,
    ) -> Vec<Station<T>> {
        let count = self.sections.len();
        let mut stations = Vec::with_capacity(count);
        let [mut u, mut u1, mut u2] = [(); 3].map(|()| Vec::with_capacity(count));
        for (i, section) in self.sections.iter().enumerate() {
            let (value, s0) = self.at_station(i, motion.value);
            let (rate, s1) = self.at_station(i, motion.rate);
            let (acceleration, s2) = self.at_station(i, motion.acceleration);
            let [angle, pitch_rate, pitch_acceleration] = pitch.rates();
            let state = SectionState {
                station: self.span.stations[i],
                pitch: [angle + T::from_real(section.twist_rad), pitch_rate, pitch_acceleration],
                value,
                rate,
                acceleration,
            };
            let turn = Turn::new(state.pitch[0], state.value[motion_at::PHI]);
            let station = Station { state, turn, strain: [s0, s1, s2] };
            let [slope, slope_rate, slope_acceleration] = section.axial_slope(&station);
            u.push(slope);
            u1.push(slope_rate);
            u2.push(slope_acceleration);
            stations.push(station);
        }
        let [u, u1, u2] = [self.span.running(&u), self.span.running(&u1), self.span.running(&u2)];
        for (i, station) in stations.iter_mut().enumerate() {
            station.state.value[0] = u[i];
            station.state.rate[0] = u1[i];
            station.state.acceleration[0] = u2[i];
        }
        stations
    }

    /// Motion and strain variables of a station, the axial ones left 0, of modal coordinates or their rates.
    #[inline(always)]
    fn at_station<T: Scalar>(
        &self,
        i: usize,
        coordinates: &[T],
    ) -> ([T; MOTION_VARIABLES], [T; STRAIN_VARIABLES]) {
        let mut moving = [T::zero(); MOTION_VARIABLES];
        let mut strain = [T::zero(); STRAIN_VARIABLES];
        for (mode, q) in self.modes.iter().zip(coordinates) {
            let shape = &mode.sections[i];
            for (out, s) in moving[1..].iter_mut().zip(shape.motion()) {
                *out += *q * T::from_real(s);
            }
            for (out, s) in strain[1..].iter_mut().zip(shape.strain()) {
                *out += *q * T::from_real(s);
            }
        }
        (moving, strain)
    }

    /// Motion, inertial loads, tension and modal force.
    #[inline(always)]
    fn loaded<T: Scalar>(&self, motion: &ModalMotion<'_, T>, pitch: &PitchMotion<T>) -> Loaded<T> {
        let stations = self.kinematics(motion, pitch);
        let count = stations.len();
        let mut inertial = Vec::with_capacity(count);
        let mut axial = Vec::with_capacity(count);
        for (station, section) in stations.iter().zip(&self.sections) {
            let force = section.mass.force(&self.spin, &station.state);
            axial.push(-force[0]);
            inertial.push(force);
        }
        let tension = self.span.to_tip(&axial);
        let mut generalised = Vec::with_capacity(self.modes.len());
        for mode in &self.modes {
            generalised.push(self.spring_force(mode, motion.value));
        }
        let mut pitch_moment = T::zero();
        for (i, (station, section)) in stations.iter().zip(&self.sections).enumerate() {
            let elastic = section.elastic_force(station, tension[i]);
            let weight = self.span.weights[i];
            for (mode, sum) in self.modes.iter().zip(&mut generalised) {
                let shape = &mode.sections[i];
                for (s, f) in shape.motion().iter().zip(&inertial[i][1..]) {
                    *sum += *f * T::from_real(weight * s);
                }
                for (s, f) in shape.strain().iter().zip(&elastic[1..]) {
                    *sum += *f * T::from_real(weight * s);
                }
            }
            let moment = inertial[i][motion_at::PHI] + elastic[at::PHI];
            pitch_moment += moment * T::from_real(weight);
        }
        Loaded { stations, inertial, generalised, pitch_moment }
    }

    /// Derivative of the springs' force in the coordinates, for two modes.
    #[inline(always)]
    fn spring_stiffness(&self, a: &ModalShape, b: &ModalShape) -> f64 {
        let (a, b) = (root_rotations(a), root_rotations(b));
        self.springs.iter().zip(a).zip(b).map(|((k, a), b)| k * a * b).sum()
    }

    #[inline(always)]
    fn spring_force<T: Scalar>(&self, mode: &ModalShape, value: &[T]) -> T {
        let mut sum = T::zero();
        for (other, q) in self.modes.iter().zip(value) {
            sum += *q * T::from_real(self.spring_stiffness(mode, other));
        }
        sum
    }
}

/// Rotations of the root that the springs see.
#[inline(always)]
fn root_rotations(shape: &ModalShape) -> [f64; 3] {
    [shape.root.lag[1], shape.root.flap[1], shape.root.twist[0]]
}

/// [`ModalBlade::unbalanced_side_by_side`], compiled for the vector unit.
struct Unbalanced<'a> {
    blade: &'a ModalBlade,
    motion: ModalMotion<'a, Lanes>,
    pitch: PitchMotion<Lanes>,
    loads: &'a [[Lanes; 4]],
}

impl WithSimd for Unbalanced<'_> {
    type Output = Vec<Lanes>;

    #[inline(always)]
    fn with_simd<S: Simd>(self, _: S) -> Vec<Lanes> {
        self.blade.left_by(&self.motion, &self.pitch, self.loads)
    }
}

/// A gradient along a rate of the strain variables, with another rate of the twist.
#[inline(always)]
fn along<T: Scalar>(gradient: &[T; STRAIN_VARIABLES], rate: &[T; STRAIN_VARIABLES], turn: T) -> T {
    let mut sum = T::zero();
    for (k, (g, p)) in gradient.iter().zip(rate).enumerate() {
        sum += *g * if k == at::PHI { turn } else { *p };
    }
    sum
}

impl Section {
    /// Elastic force on the strain variables under a tension `n`.
    #[inline(always)]
    fn elastic_force<T: Scalar>(&self, station: &Station<T>, n: T) -> [T; STRAIN_VARIABLES] {
        self.stiffness.elastic_force(station.turn, &station.strain[0], n)
    }

    /// Slope of the axial displacement with two rates.
    #[inline(always)]
    fn axial_slope<T: Scalar>(&self, station: &Station<T>) -> [T; 3] {
        let [s, s1, s2] = &station.strain;
        let state = &station.state;
        let e = self.stiffness.stretch(station.turn, s);
        let [_, b, c] = state.pitch;
        let (t1, t2) = (s1[at::PHI] + b, s2[at::PHI] + c);
        let two = T::from_real(2.0);
        let ka_2 = T::from_real(self.stiffness.area_radius_squared);
        let ea = T::from_real(self.stiffness.tension_centre);
        let k = Curvatures::new(station.turn, 0.0, s);
        let [sin, cos] = [k.z.gradient[at::W_XX], k.z.gradient[at::V_XX]];
        let bending = two * t1 * (s1[at::W_XX] * cos - s1[at::V_XX] * sin) - t1 * t1 * k.z.value;
        let (v_x, w_x) = (s[at::V_X], s[at::W_X]);
        let growth = T::one() + T::from_real(0.5) * (v_x * v_x + w_x * w_x);
        let turn = v_x * s1[at::V_X] + w_x * s1[at::W_X];
        let squares = growth * (s1[at::V_X] * s1[at::V_X] + s1[at::W_X] * s1[at::W_X])
            + turn * turn
            + ka_2 * s1[at::PHI_X] * s1[at::PHI_X];
        [
            T::from_real(self.stretch) - e.value,
            -along(&e.gradient, s1, t1),
            -(along(&e.gradient, s2, t2) + squares - ea * bending),
        ]
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::moderate::ModerateSpec;
    use crate::{BladeSpec, Joint, RootSupport, Twist};
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
        let blade = ModerateBlade::new(spec).unwrap();
        ModalBlade::new(&blade, &edges, 8, (0..MODES).map(sample).collect()).unwrap()
    }

    fn pitch() -> PitchMotion {
        PitchMotion { angle_rad: 0.2, rate: -0.15, acceleration: 0.12 }
    }

    fn complex(pitch: &PitchMotion) -> PitchMotion<Complex<f64>> {
        let [angle_rad, rate, acceleration] = pitch.rates().map(Complex::from);
        PitchMotion { angle_rad, rate, acceleration }
    }

    fn state() -> [[f64; MODES]; 3] {
        [0.04, 0.2, 0.3].map(|a| std::array::from_fn(|k| a * (1.7 * k as f64 + 9.0 * a).sin()))
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
            let coordinates = ModalMotion { value: q, rate: qd, acceleration: &none };
            let mut sum = Complex::from(0.0);
            for (i, station) in blade.kinematics(&coordinates, &complex(pitch)).iter().enumerate() {
                let section = &blade.sections[i];
                let kinetic = section.mass.energy(&blade.spin, &station.state);
                let strain = section.stiffness.bending_energy(station.turn, &station.strain[0]);
                sum += (kinetic - strain) * Complex::from(blade.span.weights[i]);
            }
            for (a, qa) in q.iter().enumerate() {
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
        let force = blade.force(motion, pitch());
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

    /// In every lane what is out of balance alone, loads and all.
    #[test]
    fn azimuths_side_by_side_are_those_one_by_one() {
        let blade = blade();
        let lane = |k: usize| 1.0 + 0.3 * (k as f64 + 0.5).sin();
        let side_by_side =
            |of: [f64; MODES]| of.map(|value| Lanes::from_fn(|k| lane(k) * value)).to_vec();
        let [value, rate, acceleration] = state().map(side_by_side);
        let pitches = pitch().rates().map(|own| Lanes::from_fn(|k| lane(k) * own));
        let [angle_rad, pitch_rate, pitch_acceleration] = pitches;
        let turning = PitchMotion { angle_rad, rate: pitch_rate, acceleration: pitch_acceleration };
        let load = |x: f64| [0.3 * x, -0.2, 0.5 * x * x, 0.04];
        let along: Vec<[f64; 4]> = blade.stations().iter().map(|x| load(*x)).collect();
        let loads: Vec<[Lanes; 4]> =
            along.iter().map(|own| own.map(|f| Lanes::from_fn(|k| f * lane(k)))).collect();
        let motion = ModalMotion { value: &value, rate: &rate, acceleration: &acceleration };
        let found = blade.unbalanced_side_by_side(motion, turning, &loads);
        for k in 0..rotor_base::LANES {
            let [q, qd, qdd] = state().map(|of| of.map(|own| lane(k) * own));
            let motion = ModalMotion { value: &q, rate: &qd, acceleration: &qdd };
            let [angle_rad, rate, acceleration] = pitch().rates().map(|own| lane(k) * own);
            let pitch = PitchMotion { angle_rad, rate, acceleration };
            let own: Vec<[f64; 4]> = along.iter().map(|of| of.map(|f| f * lane(k))).collect();
            let alone = blade.unbalanced(motion, pitch, &own);
            let bare = blade.force(motion, pitch);
            for (i, left) in alone.iter().enumerate() {
                let gap = (found[i].0[k] - left).abs();
                assert!(gap < 1e-14 * (1.0 + left.abs()), "{i} {k}: {gap:e}");
                assert!((left - bare[i]).abs() > 1e-4);
            }
        }
    }
}
