//! The assembled nonlinear blade.

#![expect(clippy::inline_always, reason = "only what is inlined is compiled for the vector unit")]

use nalgebra::{DMatrix, DVector, Matrix3, Vector3};

use super::ModerateBlade;
use super::element::{self, ElementMotion, Imposed};
use super::inertia::Spin;
use super::points::ElementPoints;
use super::strain::Turn;
use crate::beam::assembly::{add_element, check_elements, section_motion};
use crate::beam::shape::{ELEMENT_DOF, JOINT_DOF, STRIDE, place};
use crate::{FemError, RootSupport, SectionMotion};

/// Pitch imposed at the root, at 0.75 R of a linearly twisted blade, with its rates in azimuth: at one azimuth, or at
/// several side by side.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct PitchMotion<T = f64> {
    /// Angle, rad, nose up.
    pub angle_rad: T,
    /// Rate, rad per rad of azimuth.
    pub rate: T,
    /// Acceleration, rad per rad^2 of azimuth.
    pub acceleration: T,
}

impl PitchMotion {
    /// A pitch angle that does not change.
    pub fn steady(angle_rad: f64) -> Self {
        Self { angle_rad, ..Self::default() }
    }
}

impl<T: Copy> PitchMotion<T> {
    /// Angle, rate and acceleration.
    #[inline(always)]
    pub(crate) fn rates(&self) -> [T; 3] {
        [self.angle_rad, self.rate, self.acceleration]
    }
}

/// Displacements of the blade over all degrees of freedom with two rates.
#[derive(Debug, Clone, PartialEq)]
pub struct NodalMotion {
    /// Displacements, R and rad.
    pub value: DVector<f64>,
    /// Rates, per rad of azimuth at nominal speed.
    pub rate: DVector<f64>,
    /// Accelerations.
    pub acceleration: DVector<f64>,
}

impl NodalMotion {
    /// At rest in the rotating frame.
    pub fn steady(value: DVector<f64>) -> Self {
        let zero = DVector::zeros(value.len());
        Self { value, rate: zero.clone(), acceleration: zero }
    }

    fn element(&self, e: usize) -> ElementMotion<f64> {
        let part = |v: &DVector<f64>| std::array::from_fn(|i| v[STRIDE * e + i]);
        ElementMotion {
            value: part(&self.value),
            rate: part(&self.rate),
            acceleration: part(&self.acceleration),
        }
    }
}

/// Residual with its derivatives over all degrees of freedom.
#[derive(Debug, Clone, PartialEq)]
pub struct Tangents {
    /// Elastic plus inertial force; the equations of motion set it equal to the applied force.
    pub force: DVector<f64>,
    /// Derivative in the displacements; symmetric about a state of rest.
    pub stiffness: DMatrix<f64>,
    /// Derivative in the rates (gyroscopic); skew-symmetric about a state of rest.
    pub damping: DMatrix<f64>,
    /// Derivative in the accelerations; symmetric.
    pub mass: DMatrix<f64>,
}

/// A moderately deflected blade cut into nonlinear 15-dof elements.
///
/// The degrees of freedom are those of [`BladeModel`](crate::BladeModel): joint j holds
/// `u v v' w w' phi` at 9 j + 0..=5, element e `u(1/3) u(2/3) phi(1/2)` at 9 e + 6..=8. Here u is the whole
/// axial displacement, foreshortening included, so every element stands alone and the Coriolis force of
/// foreshortening needs no integral over the blade.
///
/// No element crosses a jump or kink of a property: each stretch between two of them is cut into equal
/// elements no longer than the blade over the number asked for.
#[derive(Debug, Clone)]
pub struct ModerateModel {
    blade: ModerateBlade,
    edges: Vec<f64>,
    points: Vec<ElementPoints>,
    /// For each element: axial displacements at 1/3, 2/3 and the end from the slopes at the points of
    /// the stretch.
    axial_from_slopes: Vec<Matrix3<f64>>,
    free: Vec<usize>,
}

impl ModerateModel {
    /// Cuts a blade into at least `elements` elements.
    ///
    /// # Errors
    /// [`FemError::Parameter`] unless 1 to 200 elements are asked for and needed.
    pub fn new(blade: ModerateBlade, elements: usize) -> Result<Self, FemError> {
        check_elements(elements)?;
        let root = blade.properties().spec().root_offset;
        let mut edges = vec![root];
        for pair in blade.breaks().windows(2) {
            let length = pair[1] - pair[0];
            // a hair of slack, so that round-off does not add an element
            let wanted = (length * elements as f64 / (1.0 - root) - 1e-9).ceil().max(1.0);
            #[expect(clippy::cast_possible_truncation, clippy::cast_sign_loss, reason = "1 to 200")]
            let parts = wanted as usize;
            edges.extend((1..parts).map(|i| pair[0] + length * i as f64 / wanted));
            edges.push(pair[1]);
        }
        let count = edges.len() - 1;
        check_elements(count)?;
        let points: Vec<ElementPoints> =
            edges.windows(2).map(|pair| ElementPoints::new(&blade, pair[0], pair[1])).collect();
        let axial_from_slopes = points.iter().map(axial_from_slopes).collect();
        let size = STRIDE * count + JOINT_DOF;
        let free = blade.spec().blade.root.free_dof(size);
        Ok(Self { blade, edges, points, axial_from_slopes, free })
    }

    /// The blade.
    pub fn blade(&self) -> &ModerateBlade {
        &self.blade
    }

    /// Number of elements.
    pub fn elements(&self) -> usize {
        self.edges.len() - 1
    }

    /// Ends of the elements r/R, root first.
    pub fn edges(&self) -> &[f64] {
        &self.edges
    }

    /// Number of degrees of freedom, those held at the root included: 9 n + 6.
    pub fn size(&self) -> usize {
        STRIDE * self.elements() + JOINT_DOF
    }

    /// Indices of the degrees of freedom the root leaves free, ascending.
    pub fn free(&self) -> &[usize] {
        &self.free
    }

    /// Pitch of the blade's own description.
    pub fn own_pitch(&self) -> PitchMotion {
        PitchMotion::steady(self.blade.properties().spec().pitch_rad)
    }

    /// What is imposed on the elements, the rotor speed times `speed_factor`.
    pub(crate) fn imposed(&self, pitch: PitchMotion, speed_factor: f64) -> Imposed {
        let spec = self.blade.properties().spec();
        let spin = Spin::new(spec.rotor_speed * speed_factor, spec.precone_rad);
        Imposed { spin, pitch: pitch.rates() }
    }

    /// Elastic plus inertial force over all degrees of freedom, springs of the root included.
    ///
    /// The motion satisfies the equations when it equals the applied force on the free degrees of
    /// freedom; on the held ones the difference is the reaction of the support.
    ///
    /// # Panics
    /// If the motion is not over all [`Self::size`] degrees of freedom.
    pub fn force(&self, motion: &NodalMotion, pitch: PitchMotion) -> DVector<f64> {
        self.force_at(motion, &self.imposed(pitch, 1.0)).0
    }

    /// The force, and the largest force of any element.
    pub(crate) fn force_at(&self, motion: &NodalMotion, imposed: &Imposed) -> (DVector<f64>, f64) {
        let mut out = DVector::zeros(self.size());
        let mut largest = 0.0_f64;
        for (e, points) in self.points.iter().enumerate() {
            let force = element::force(points, imposed, &motion.element(e));
            add_force(&mut out, e, &force);
            largest = force.iter().fold(largest, |m, f| m.max(f.abs()));
        }
        for (place, stiffness) in self.springs() {
            out[place] += stiffness * motion.value[place];
        }
        (out, largest)
    }

    /// Force with its derivatives.
    ///
    /// # Panics
    /// If the motion is not over all [`Self::size`] degrees of freedom.
    pub fn tangents(&self, motion: &NodalMotion, pitch: PitchMotion) -> Tangents {
        self.tangents_at(motion, &self.imposed(pitch, 1.0))
    }

    pub(crate) fn tangents_at(&self, motion: &NodalMotion, imposed: &Imposed) -> Tangents {
        let size = self.size();
        let mut out = Tangents {
            force: DVector::zeros(size),
            stiffness: DMatrix::zeros(size, size),
            damping: DMatrix::zeros(size, size),
            mass: DMatrix::zeros(size, size),
        };
        for (e, points) in self.points.iter().enumerate() {
            let local = element::tangent(points, imposed, &motion.element(e));
            add_force(&mut out.force, e, &local.force);
            add_element(&mut out.stiffness, e, &local.stiffness);
            add_element(&mut out.damping, e, &local.damping);
            add_element(&mut out.mass, e, &local.mass);
        }
        for (place, stiffness) in self.springs() {
            out.force[place] += stiffness * motion.value[place];
            out.stiffness[(place, place)] += stiffness;
        }
        out
    }

    /// Kinetic and strain energy at the blade's own rotor speed, springs of the root included; over
    /// m0 Omega^2 R^3.
    pub fn energies(&self, motion: &NodalMotion, pitch: PitchMotion) -> [f64; 2] {
        let imposed = self.imposed(pitch, 1.0);
        let mut sum = [0.0; 2];
        for (e, points) in self.points.iter().enumerate() {
            let [kinetic, strain] = element::energies(points, &imposed, &motion.element(e));
            sum[0] += kinetic;
            sum[1] += strain;
        }
        for (place, stiffness) in self.springs() {
            sum[1] += 0.5 * stiffness * motion.value[place].powi(2);
        }
        sum
    }

    /// Momentum, the derivative of the kinetic energy in the rates, and gradient of the Lagrangian over all
    /// degrees of freedom.
    pub fn momentum(&self, motion: &NodalMotion, pitch: PitchMotion) -> [DVector<f64>; 2] {
        let imposed = self.imposed(pitch, 1.0);
        let mut out = [DVector::zeros(self.size()), DVector::zeros(self.size())];
        for (e, points) in self.points.iter().enumerate() {
            let parts = element::momentum(points, &imposed, &motion.element(e));
            for (whole, part) in out.iter_mut().zip(&parts) {
                add_force(whole, e, part);
            }
        }
        for (place, stiffness) in self.springs() {
            out[1][place] -= stiffness * motion.value[place];
        }
        out
    }

    fn springs(&self) -> impl Iterator<Item = (usize, f64)> {
        RootSupport::PLACES.into_iter().zip(self.blade.spec().blade.root.springs())
    }

    /// Dead load at the tip: force outboard, toward the leading edge and up over m0 Omega^2 R^2, and
    /// nose-up moment over m0 Omega^2 R^3.
    pub fn tip_load(&self, force: [f64; 3], moment: f64) -> DVector<f64> {
        let mut out = DVector::zeros(self.size());
        let tip = self.size() - JOINT_DOF;
        for (place, value) in [0, 1, 3, 5].into_iter().zip(force.into_iter().chain([moment])) {
            out[tip + place] = value;
        }
        out
    }

    /// Dead load along the blade: `[f_x, f_y, f_z, nose-up moment]` per length at a station r/R.
    pub fn distributed_load(&self, load: impl Fn(f64) -> [f64; 4]) -> DVector<f64> {
        let mut out = DVector::zeros(self.size());
        for (e, points) in self.points.iter().enumerate() {
            let mut local = [0.0; ELEMENT_DOF];
            for point in &points.whole {
                point.add_force(&mut local, &[0, 2, 5, 8], &load(point.station));
            }
            add_force(&mut out, e, &local);
        }
        out
    }

    /// Motion of the section at station r/R; at rest inboard of the root.
    ///
    /// # Errors
    /// [`FemError::Station`] outside 0 to 1.
    pub fn section(&self, dof: &DVector<f64>, station: f64) -> Result<SectionMotion, FemError> {
        section_motion(&self.edges, dof, station)
    }

    /// Steady tension `EA e` at the three points of the stretch of each element, station with value.
    pub fn tension(&self, dof: &DVector<f64>, pitch: PitchMotion) -> Vec<[f64; 2]> {
        let mut out = Vec::with_capacity(3 * self.elements());
        for (e, points) in self.points.iter().enumerate() {
            let local: [f64; ELEMENT_DOF] = std::array::from_fn(|i| dof[STRIDE * e + i]);
            for point in &points.stretch {
                let s = point.strain(&local);
                let turn = Turn::of(pitch.angle_rad + point.twist_rad, &s);
                let strain = point.stiffness.stretch(turn, &s).value;
                out.push([point.station, point.stiffness.axial * strain]);
            }
        }
        out
    }

    /// Adds an increment, and the axial displacement that cancels its quadratic part of the stretch.
    ///
    /// A straight Newton step leaves a stretch of half the squared slopes behind, which a stiff blade
    /// answers with an enormous force. With the correction the stretch changes as the linear step says.
    pub(crate) fn advance(&self, dof: &mut DVector<f64>, step: &DVector<f64>) {
        *dof += step;
        let mut before = 0.0;
        for (e, points) in self.points.iter().enumerate() {
            let local: [f64; ELEMENT_DOF] = std::array::from_fn(|i| step[STRIDE * e + i]);
            let mut slopes = Vector3::zeros();
            for (slope, point) in slopes.iter_mut().zip(&points.stretch) {
                let s = point.strain(&local);
                let [_, v_x, w_x, _, _, _, phi_x] = s;
                let turn = point.stiffness.area_radius_squared * phi_x * phi_x;
                *slope = -0.5 * (v_x * v_x + w_x * w_x + turn);
            }
            let inside = self.axial_from_slopes[e] * slopes;
            for (place, value) in place::AXIAL.into_iter().skip(1).zip(inside.iter()) {
                dof[STRIDE * e + place] += before + value;
            }
            before += inside[2];
        }
    }
}

fn add_force(out: &mut DVector<f64>, e: usize, force: &[f64; ELEMENT_DOF]) {
    for (i, value) in force.iter().enumerate() {
        out[STRIDE * e + i] += value;
    }
}

/// Axial displacements at 1/3, 2/3 and 1 of an element, held at 0, that have given slopes at its points
/// of the stretch.
fn axial_from_slopes(points: &ElementPoints) -> Matrix3<f64> {
    let slope = |row: usize, column: usize| {
        let mut dof = [0.0; ELEMENT_DOF];
        dof[place::AXIAL[column + 1]] = 1.0;
        points.stretch[row].variables(&dof)[1]
    };
    // a cubic that vanishes at 0 with no slope at three points is zero: the matrix has an inverse
    Matrix3::from_fn(slope).try_inverse().unwrap_or_else(Matrix3::zeros)
}
