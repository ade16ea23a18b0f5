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

use super::inertia::{MOTION_VARIABLES, SectionMass, SectionState, Spin};
use super::section_shape::SectionShape;
use super::span::Span;
use super::strain::{Curvatures, STRAIN_VARIABLES, SectionStiffness, at};
use super::{ModerateBlade, PitchMotion, Scalar};
use crate::FemError;

/// A displacement field of the blade at its root and at all stations.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalShape {
    /// At the root, for its springs.
    pub root: SectionShape,
    /// At the stations of the modal blade.
    pub sections: Vec<SectionShape>,
}

/// Modal coordinates with two rates in azimuth.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModalMotion<'a> {
    /// Coordinates, one for each mode.
    pub value: &'a [f64],
    /// Rates.
    pub rate: &'a [f64],
    /// Accelerations.
    pub acceleration: &'a [f64],
}

/// Modal force with what it was summed from.
#[derive(Debug, Clone, PartialEq)]
pub struct ModalForce {
    /// Elastic plus inertial force on each mode; the equations of motion set it equal to the applied
    /// one.
    pub generalised: Vec<f64>,
    /// Tension that the inertial loads put into the blade at each station, over m0 Omega^2 R^2.
    pub tension: Vec<f64>,
    /// Axial displacement at each station, R.
    pub axial: Vec<f64>,
    /// Inertial force per length on `u v w v_x w_x phi` at each station: mass times acceleration.
    pub inertial: Vec<[f64; 6]>,
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
    pub(super) span: Span,
    pub(super) sections: Vec<Section>,
    pub(super) base: ModalShape,
    pub(super) modes: Vec<ModalShape>,
    /// Springs of the root on `v_x`, `w_x`, `phi`.
    springs: [f64; 3],
    pub(super) spin: Spin,
}

/// Properties of one station.
#[derive(Debug, Clone, Copy)]
pub(super) struct Section {
    pub(super) twist_rad: f64,
    pub(super) stiffness: SectionStiffness,
    pub(super) mass: SectionMass,
    /// Stretch by the steady tension, `T0 / EA`.
    stretch: f64,
}

/// Motion of one station, the axial one included.
#[derive(Debug, Clone, Copy)]
pub(super) struct Station<T> {
    pub(super) state: SectionState<T>,
    pub(super) strain: [[T; STRAIN_VARIABLES]; 3],
}

/// Modal coordinates in the numbers of the calculation.
#[derive(Debug, Clone, Copy)]
pub(super) struct Coordinates<'a, T> {
    pub(super) value: &'a [T],
    pub(super) rate: &'a [T],
    pub(super) acceleration: &'a [T],
}

/// Everything at all stations.
pub(super) struct Loaded<T> {
    pub(super) stations: Vec<Station<T>>,
    pub(super) inertial: Vec<[T; MOTION_VARIABLES]>,
    pub(super) tension: Vec<T>,
    pub(super) generalised: Vec<T>,
    pub(super) pitch_moment: T,
}

impl ModalBlade {
    /// A blade whose motion is `base` plus modes.
    ///
    /// | argument | meaning |
    /// |---|---|
    /// | `blade` | the blade, at its own rotor speed and precone; its pitch comes with the motion |
    /// | `edges` | ends of the pieces of quadrature r/R, from root to tip, growing; every break of the blade should be among them |
    /// | `points` | Gauss points in each piece, 2 to 16 |
    /// | `base` | displacement the modes are added to; none for the undeformed blade |
    /// | `modes` | shapes at the stations that [`Self::stations_of`] gives for the same edges |
    ///
    /// # Errors
    /// [`FemError::Parameter`] for edges or points out of range, [`FemError::StationOrder`],
    /// [`FemError::ShapeCount`].
    pub fn new(
        blade: &ModerateBlade,
        edges: &[f64],
        points: usize,
        base: Option<ModalShape>,
        modes: Vec<ModalShape>,
    ) -> Result<Self, FemError> {
        let stations = Self::stations_of(edges, points)?;
        let still = || ModalShape {
            root: SectionShape::default(),
            sections: vec![SectionShape::default(); stations.len()],
        };
        let base = base.unwrap_or_else(still);
        for (mode, shape) in modes.iter().chain([&base]).enumerate() {
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
        Ok(Self { span: Span::new(edges, points), sections, base, modes, springs, spin })
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

    /// Elastic and inertial modal force at one azimuth. A pure function of its arguments.
    ///
    /// # Panics
    /// If the motion has another number of coordinates than there are modes.
    pub fn force(&self, motion: ModalMotion<'_>, pitch: PitchMotion) -> ModalForce {
        let ModalMotion { value, rate, acceleration } = motion;
        let loaded = self.loaded(&Coordinates { value, rate, acceleration }, &pitch);
        ModalForce {
            generalised: loaded.generalised,
            tension: loaded.tension,
            axial: loaded.stations.iter().map(|s| s.state.value[0]).collect(),
            inertial: loaded.inertial,
        }
    }

    /// What the same motion asks of hub and pitch control. A pure function of its arguments.
    ///
    /// Force, moment and power belong together: over one revolution of a periodic motion the power of
    /// the applied loads equals that of hub, pitch control and damping.
    ///
    /// # Panics
    /// If the motion has another number of coordinates than there are modes.
    pub fn loads(&self, motion: ModalMotion<'_>, pitch: PitchMotion) -> ModalLoads {
        let ModalMotion { value, rate, acceleration } = motion;
        let loaded = self.loaded(&Coordinates { value, rate, acceleration }, &pitch);
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
        let zero = vec![0.0; value.len()];
        let motion = Coordinates { value, rate: &zero, acceleration: &zero };
        let stations = self.kinematics(&motion, &pitch);
        let of = |((station, section), n): ((&Station<f64>, &Section), &f64)| {
            let (theta, s) = (station.state.pitch[0], &station.strain[0]);
            let bending = section.stiffness.bending_force(theta, s);
            let pull = section.stiffness.tension_force(theta, s, *n);
            [at::V_X, at::W_X, at::PHI].map(|k| bending[k] + pull[k])
        };
        stations.iter().zip(&self.sections).zip(tension).map(of).collect()
    }

    /// Modal force of applied loads per length `[f_x, f_y, f_z, nose-up moment]` at the stations, the
    /// virtual work of the axial force on the foreshortening included.
    ///
    /// # Panics
    /// If the numbers of coordinates or loads do not fit.
    pub fn applied(&self, value: &[f64], pitch: PitchMotion, loads: &[[f64; 4]]) -> Vec<f64> {
        let zero = vec![0.0; value.len()];
        let motion = Coordinates { value, rate: &zero, acceleration: &zero };
        let stations = self.kinematics(&motion, &pitch);
        let axial: Vec<f64> = loads.iter().map(|load| load[0]).collect();
        let pull = self.span.to_tip(&axial);
        self.modes
            .iter()
            .map(|mode| {
                let mut sum = 0.0;
                for (i, shape) in mode.sections.iter().enumerate() {
                    let [_, fy, fz, moment] = loads[i];
                    let section = &self.sections[i];
                    let theta = pitch.angle_rad + section.twist_rad;
                    let strain = &stations[i].strain[0];
                    let gradient = section.stiffness.stretch(theta, strain).gradient;
                    let shortening: f64 =
                        gradient[1..].iter().zip(shape.strain()).map(|(g, s)| g * s).sum();
                    let transverse = fy * shape.lag[0] + fz * shape.flap[0];
                    sum += self.span.weights[i]
                        * (transverse + moment * shape.twist[0] - pull[i] * shortening);
                }
                sum
            })
            .collect()
    }

    /// Motion of every station from the modal coordinates.
    pub(super) fn kinematics<T: Scalar>(
        &self,
        motion: &Coordinates<'_, T>,
        pitch: &PitchMotion,
    ) -> Vec<Station<T>> {
        let count = self.sections.len();
        let mut stations = Vec::with_capacity(count);
        let mut slopes = [(); 3].map(|()| Vec::with_capacity(count));
        for (i, section) in self.sections.iter().enumerate() {
            let base = self.base.sections[i];
            let sum = |coordinates: &[T], start: f64| {
                let mut moving = base.motion().map(|b| T::from_real(start * b));
                let mut strain = base.strain().map(|b| T::from_real(start * b));
                for (mode, q) in self.modes.iter().zip(coordinates) {
                    let shape = &mode.sections[i];
                    for (out, s) in moving.iter_mut().zip(shape.motion()) {
                        *out += *q * T::from_real(s);
                    }
                    for (out, s) in strain.iter_mut().zip(shape.strain()) {
                        *out += *q * T::from_real(s);
                    }
                }
                let [v, w, v_x, w_x, phi] = moving;
                let [a, b, c, d, e, f] = strain;
                ([T::zero(), v, w, v_x, w_x, phi], [T::zero(), a, b, c, d, e, f])
            };
            let (value, s0) = sum(motion.value, 1.0);
            let (rate, s1) = sum(motion.rate, 0.0);
            let (acceleration, s2) = sum(motion.acceleration, 0.0);
            let [angle, pitch_rate, pitch_acceleration] = pitch.rates();
            let state = SectionState {
                station: self.span.stations[i],
                pitch: [angle + section.twist_rad, pitch_rate, pitch_acceleration],
                value,
                rate,
                acceleration,
            };
            let station = Station { state, strain: [s0, s1, s2] };
            for (slope, part) in slopes.iter_mut().zip(section.axial_slope(&station)) {
                slope.push(part);
            }
            stations.push(station);
        }
        let [u, u1, u2] = slopes.each_ref().map(|slope| self.span.running(slope));
        for (i, station) in stations.iter_mut().enumerate() {
            station.state.value[0] = u[i];
            station.state.rate[0] = u1[i];
            station.state.acceleration[0] = u2[i];
        }
        stations
    }

    /// Motion, inertial loads, tension and modal force.
    pub(super) fn loaded<T: Scalar>(
        &self,
        motion: &Coordinates<'_, T>,
        pitch: &PitchMotion,
    ) -> Loaded<T> {
        let stations = self.kinematics(motion, pitch);
        let inertial: Vec<[T; MOTION_VARIABLES]> = stations
            .iter()
            .zip(&self.sections)
            .map(|(station, section)| section.mass.force(&self.spin, &station.state))
            .collect();
        let axial: Vec<T> = inertial.iter().map(|f| -f[0]).collect();
        let tension = self.span.to_tip(&axial);
        let elastic: Vec<[T; STRAIN_VARIABLES]> = stations
            .iter()
            .zip(&self.sections)
            .zip(&tension)
            .map(|((station, section), n)| {
                let (theta, s) = (station.state.pitch[0], &station.strain[0]);
                let bending = section.stiffness.bending_force(theta, s);
                let pull = section.stiffness.tension_force(theta, s, *n);
                std::array::from_fn(|k| bending[k] + pull[k])
            })
            .collect();
        let generalised = self.modes.iter().map(|mode| {
            let mut sum = self.spring_force(mode, motion.value);
            for (i, shape) in mode.sections.iter().enumerate() {
                let weight = self.span.weights[i];
                for (s, f) in shape.motion().iter().zip(&inertial[i][1..]) {
                    sum += *f * T::from_real(weight * s);
                }
                for (s, f) in shape.strain().iter().zip(&elastic[i][1..]) {
                    sum += *f * T::from_real(weight * s);
                }
            }
            sum
        });
        let generalised = generalised.collect();
        let mut pitch_moment = T::zero();
        for (weight, (f, e)) in self.span.weights.iter().zip(inertial.iter().zip(&elastic)) {
            pitch_moment += (f[super::inertia::at::PHI] + e[at::PHI]) * T::from_real(*weight);
        }
        Loaded { stations, inertial, tension, generalised, pitch_moment }
    }

    /// Derivative of the springs' force in the coordinates, for two modes.
    pub(super) fn spring_stiffness(&self, a: &ModalShape, b: &ModalShape) -> f64 {
        let (a, b) = (root_rotations(a), root_rotations(b));
        self.springs.iter().zip(a).zip(b).map(|((k, a), b)| k * a * b).sum()
    }

    fn spring_force<T: Scalar>(&self, mode: &ModalShape, value: &[T]) -> T {
        let base = T::from_real(self.spring_stiffness(mode, &self.base));
        self.modes.iter().zip(value).fold(base, |sum, (other, q)| {
            sum + *q * T::from_real(self.spring_stiffness(mode, other))
        })
    }
}

/// Rotations of the root that the springs see.
fn root_rotations(shape: &ModalShape) -> [f64; 3] {
    [shape.root.lag[1], shape.root.flap[1], shape.root.twist[0]]
}

impl Section {
    /// Slope of the axial displacement with two rates.
    fn axial_slope<T: Scalar>(&self, station: &Station<T>) -> [T; 3] {
        let [s, s1, s2] = &station.strain;
        let state = &station.state;
        let e = self.stiffness.stretch(state.pitch[0], s);
        let [_, b, c] = state.pitch.map(T::from_real);
        let (t1, t2) = (s1[at::PHI] + b, s2[at::PHI] + c);
        let turned = |part: &[T; STRAIN_VARIABLES], turn: T| {
            let mut out = *part;
            out[at::PHI] = turn;
            out
        };
        let along = |part: &[T; STRAIN_VARIABLES]| {
            e.gradient.iter().zip(part).fold(T::zero(), |sum, (g, p)| sum + *g * *p)
        };
        let two = T::from_real(2.0);
        let [ka_2, ea] =
            [self.stiffness.area_radius_squared, self.stiffness.tension_centre].map(T::from_real);
        let k = Curvatures::new(state.pitch[0], 0.0, s);
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
            -along(&turned(s1, t1)),
            -(along(&turned(s2, t2)) + squares - ea * bending),
        ]
    }
}
