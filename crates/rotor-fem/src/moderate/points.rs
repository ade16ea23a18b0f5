//! Quadrature points of the nonlinear elements: shapes and section properties, computed once.

use nalgebra::SMatrix;
use rotor_base::gauss_legendre;

use super::inertia::{self, SectionMass};
use super::strain::{STRAIN_VARIABLES, SectionStiffness};
use super::{ModerateBlade, Scalar};
use crate::beam::element::ElementMatrix;
use crate::beam::shape::{ELEMENT_DOF, cubic, hermite, place, quadratic};

/// Gauss points for bending, torsion and inertia.
const GAUSS_POINTS: usize = 6;

/// Gauss points for the stretch.
///
/// Three, no more: the slope of the cubic axial displacement can be given any three values, so the
/// stretch can vanish at all of them for any bending. With more points it cannot, and a thin blade locks.
const STRETCH_POINTS: usize = 3;

/// Variables of a section: `u u_x v v_x v_xx w w_x w_xx phi phi_x`.
pub(crate) const SECTION_VARIABLES: usize = 10;

/// Places of the strain variables among the section's.
pub(crate) const STRAIN: [usize; STRAIN_VARIABLES] = [1, 3, 6, 4, 7, 8, 9];
/// Places of the motion variables among the section's.
pub(crate) const MOTION: [usize; inertia::MOTION_VARIABLES] = [0, 2, 5, 3, 6, 8];

/// A matrix over the variables of a section.
pub(crate) type SectionMatrix = SMatrix<f64, SECTION_VARIABLES, SECTION_VARIABLES>;

/// A point of quadrature in an element.
#[derive(Debug, Clone)]
pub(crate) struct Point {
    /// Station r/R.
    pub(crate) station: f64,
    /// Weight, a length.
    pub(crate) dx: f64,
    /// Built-in twist, rad.
    pub(crate) twist_rad: f64,
    pub(crate) stiffness: SectionStiffness,
    pub(crate) mass: SectionMass,
    axial: [[f64; 2]; 4],
    bending: [[f64; 3]; 4],
    twist: [[f64; 3]; 3],
}

/// The points of one element.
#[derive(Debug, Clone)]
pub(crate) struct ElementPoints {
    /// For bending, torsion and inertia.
    pub(crate) whole: Vec<Point>,
    /// For the stretch.
    pub(crate) stretch: Vec<Point>,
}

impl ElementPoints {
    /// Points of the element between two stations; no property jumps inside it.
    pub(crate) fn new(blade: &ModerateBlade, from: f64, to: f64) -> Self {
        let points = |count| {
            let rule = gauss_legendre(count);
            let pairs = rule.nodes.iter().zip(&rule.weights);
            pairs.map(|(x, w)| Point::new(blade, [from, to], [*x, *w])).collect()
        };
        Self { whole: points(GAUSS_POINTS), stretch: points(STRETCH_POINTS) }
    }
}

impl Point {
    fn new(blade: &ModerateBlade, [from, to]: [f64; 2], [node, weight]: [f64; 2]) -> Self {
        let length = to - from;
        let s = 0.5 * (1.0 + node);
        let station = from + s * length;
        Self {
            station,
            dx: 0.5 * length * weight,
            twist_rad: blade.properties().twist_rad(station),
            stiffness: blade.stiffness(station),
            mass: blade.mass(station),
            axial: cubic(s, length),
            bending: hermite(s, length),
            twist: quadratic(s, length),
        }
    }

    /// Degrees of freedom and shape values behind a section variable.
    fn shapes(&self, variable: usize) -> impl Iterator<Item = (usize, f64)> + '_ {
        let bending = |places: [usize; 4], k: usize| {
            let values = self.bending.map(|b| b[k]);
            (places, values)
        };
        let (places, values) = match variable {
            0 | 1 => (place::AXIAL, self.axial.map(|a| a[variable])),
            2..=4 => bending(place::LAG, variable - 2),
            5..=7 => bending(place::FLAP, variable - 5),
            _ => {
                let [a, b, c] = self.twist.map(|t| t[variable - 8]);
                let [i, j, k] = place::TWIST;
                // the fourth is a blank
                ([i, j, k, k], [a, b, c, 0.0])
            }
        };
        places.into_iter().zip(values)
    }

    /// The section variables of an element's degrees of freedom.
    pub(crate) fn variables<T: Scalar>(&self, dof: &[T; ELEMENT_DOF]) -> [T; SECTION_VARIABLES] {
        std::array::from_fn(|variable| {
            self.shapes(variable)
                .fold(T::zero(), |sum, (i, shape)| sum + dof[i] * T::from_real(shape))
        })
    }

    /// The strain variables of an element's degrees of freedom.
    pub(crate) fn strain<T: Scalar>(&self, dof: &[T; ELEMENT_DOF]) -> [T; STRAIN_VARIABLES] {
        let z = self.variables(dof);
        STRAIN.map(|i| z[i])
    }

    /// Adds forces on section variables to those on the element's degrees of freedom.
    pub(crate) fn add_force<T: Scalar, const N: usize>(
        &self,
        out: &mut [T; ELEMENT_DOF],
        places: &[usize; N],
        force: &[T; N],
    ) {
        for (variable, value) in places.iter().zip(force) {
            for (i, shape) in self.shapes(*variable) {
                out[i] += *value * T::from_real(shape * self.dx);
            }
        }
    }

    /// Adds a matrix over section variables to one over the element's degrees of freedom.
    pub(crate) fn add_matrix(&self, out: &mut ElementMatrix, section: &SectionMatrix) {
        let mut half = SMatrix::<f64, ELEMENT_DOF, SECTION_VARIABLES>::zeros();
        for variable in 0..SECTION_VARIABLES {
            for (i, shape) in self.shapes(variable) {
                for column in 0..SECTION_VARIABLES {
                    half[(i, column)] += shape * self.dx * section[(variable, column)];
                }
            }
        }
        for variable in 0..SECTION_VARIABLES {
            for (j, shape) in self.shapes(variable) {
                for i in 0..ELEMENT_DOF {
                    out[(i, j)] += half[(i, variable)] * shape;
                }
            }
        }
    }
}

/// Adds a matrix over the section variables at some places to one over all of them.
pub(crate) fn add_at<const N: usize>(
    out: &mut SectionMatrix,
    places: &[usize; N],
    part: &SMatrix<f64, N, N>,
) {
    for (i, row) in places.iter().enumerate() {
        for (j, column) in places.iter().enumerate() {
            out[(*row, *column)] += part[(i, j)];
        }
    }
}
