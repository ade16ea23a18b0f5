//! The assembled blade: mesh, matrices, free degrees of freedom, motion at any station.

use nalgebra::{DMatrix, DVector};

use crate::beam::element::{ElementMatrix, element_matrices};
use crate::beam::shape::{ELEMENT_DOF, JOINT_DOF, Rows, STRIDE};
use crate::error::check_parameters;
use crate::{BladeProperties, FemError, ModeKind, RootSupport};

/// Largest number of elements; dense algebra grows with its cube.
const MAX_ELEMENTS: usize = 200;

/// Refuses a number of elements of a blade that is out of range.
pub(crate) fn check_elements(found: usize) -> Result<(), FemError> {
    let allowed = (1..=MAX_ELEMENTS).contains(&found);
    check_parameters([("number of blade elements", found as f64, allowed, "1 to 200")])
}

/// Edges of `elements` equal elements from the blade's root to its tip.
pub(crate) fn element_edges(
    blade: &BladeProperties,
    elements: usize,
) -> Result<Vec<f64>, FemError> {
    check_elements(elements)?;
    let root = blade.spec().root_offset;
    let edge = |i: usize| root + (1.0 - root) * i as f64 / elements as f64;
    // the tip exactly, without round-off
    Ok((0..elements).map(edge).chain([1.0]).collect())
}

/// Element holding station `x` and the place in it, 0 to 1; none inboard of the root.
pub(crate) fn locate(edges: &[f64], x: f64) -> Result<Option<(usize, f64)>, FemError> {
    let tip = edges.last().copied().unwrap_or(1.0);
    if !(0.0..=tip).contains(&x) {
        return Err(FemError::Station { station: x });
    }
    if x < edges[0] {
        return Ok(None);
    }
    let e = edges.partition_point(|edge| *edge <= x).clamp(1, edges.len() - 1) - 1;
    Ok(Some((e, (x - edges[e]) / (edges[e + 1] - edges[e]))))
}

/// Displacements of a section, rotor units and rad.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct SectionMotion {
    /// Axial displacement u (outboard) and its radial derivative.
    pub axial: [f64; 2],
    /// Lag displacement v (toward the leading edge), first and second derivative.
    pub lag: [f64; 3],
    /// Flap displacement w (up), first and second derivative.
    pub flap: [f64; 3],
    /// Elastic twist (nose up), rad, and its derivative.
    pub twist: [f64; 2],
}

/// A blade cut into 15-dof elements, with its linear matrices about the undeformed rotating state.
///
/// ```text
/// M q'' + G q' + K q = 0
/// ```
/// An n-element blade has 9 n + 6 degrees of freedom. Joint j, counted from the root, holds
/// `u v v' w w' phi` at 9 j + 0..=5; element e holds `u(1/3) u(2/3) phi(1/2)` at 9 e + 6..=8. A clamped
/// root removes the first six (9 n left), a hinged root keeps v' and w' (9 n + 2), a pitch bearing phi.
///
/// Rotor units: length R, mass m0 R, time 1/Omega.
#[derive(Debug, Clone)]
pub struct BladeModel {
    properties: BladeProperties,
    edges: Vec<f64>,
    mass: DMatrix<f64>,
    stiffness: DMatrix<f64>,
    gyroscopic: DMatrix<f64>,
    free: Vec<usize>,
}

impl BladeModel {
    /// Cuts a blade into `elements` equal elements and assembles its matrices.
    ///
    /// # Errors
    /// [`FemError::Parameter`] unless there are 1 to 200 elements.
    pub fn new(properties: BladeProperties, elements: usize) -> Result<Self, FemError> {
        let edges = element_edges(&properties, elements)?;
        let size = STRIDE * elements + JOINT_DOF;
        let mut model = Self {
            mass: DMatrix::zeros(size, size),
            stiffness: DMatrix::zeros(size, size),
            gyroscopic: DMatrix::zeros(size, size),
            free: properties.spec().root.free_dof(size),
            properties,
            edges,
        };
        for e in 0..elements {
            let local = element_matrices(&model.properties, model.edges[e], model.edges[e + 1]);
            add_element(&mut model.mass, e, &local.mass);
            add_element(&mut model.stiffness, e, &local.stiffness);
            add_element(&mut model.gyroscopic, e, &local.gyroscopic);
        }
        let springs = model.properties.spec().root.springs();
        for (place, spring) in RootSupport::PLACES.into_iter().zip(springs) {
            model.stiffness[(place, place)] += spring;
        }
        Ok(model)
    }

    /// The blade.
    pub fn properties(&self) -> &BladeProperties {
        &self.properties
    }

    /// Number of elements.
    pub fn elements(&self) -> usize {
        self.edges.len() - 1
    }

    /// Ends of the elements r/R, root first.
    pub fn edges(&self) -> &[f64] {
        &self.edges
    }

    /// Mass matrix over all 9 n + 6 degrees of freedom, symmetric.
    pub fn mass(&self) -> &DMatrix<f64> {
        &self.mass
    }

    /// Stiffness matrix over all 9 n + 6 degrees of freedom, symmetric.
    pub fn stiffness(&self) -> &DMatrix<f64> {
        &self.stiffness
    }

    /// Gyroscopic matrix over all 9 n + 6 degrees of freedom, skew-symmetric.
    pub fn gyroscopic(&self) -> &DMatrix<f64> {
        &self.gyroscopic
    }

    /// Indices of the degrees of freedom the root leaves free, ascending.
    pub fn free(&self) -> &[usize] {
        &self.free
    }

    /// Indices of the free degrees of freedom of one family, ascending.
    pub fn free_of(&self, kind: ModeKind) -> Vec<usize> {
        self.free.iter().copied().filter(|&i| dof_kind(i) == kind).collect()
    }

    /// Motion of the section at station r/R for a vector over all 9 n + 6 degrees of freedom; at rest
    /// inboard of the root.
    ///
    /// # Errors
    /// [`FemError::Station`] outside 0 to 1.
    pub fn motion(&self, dof: &DVector<f64>, station: f64) -> Result<SectionMotion, FemError> {
        section_motion(&self.edges, dof, station)
    }
}

/// Motion of the section at station r/R of a mesh with element ends `edges`; at rest inboard of it.
pub(crate) fn section_motion(
    edges: &[f64],
    dof: &DVector<f64>,
    station: f64,
) -> Result<SectionMotion, FemError> {
    let Some((e, s)) = locate(edges, station)? else {
        return Ok(SectionMotion::default());
    };
    let rows = Rows::at(s, edges[e + 1] - edges[e]);
    let local = dof.fixed_rows::<ELEMENT_DOF>(STRIDE * e);
    Ok(SectionMotion {
        axial: rows.axial.map(|row| row.dot(&local)),
        lag: rows.lag.map(|row| row.dot(&local)),
        flap: rows.flap.map(|row| row.dot(&local)),
        twist: rows.twist.map(|row| row.dot(&local)),
    })
}

/// Adds the matrix of element `e` to that of the blade.
pub(crate) fn add_element(blade: &mut DMatrix<f64>, e: usize, part: &ElementMatrix) {
    let mut window = blade.fixed_view_mut::<ELEMENT_DOF, ELEMENT_DOF>(STRIDE * e, STRIDE * e);
    window += part;
}

/// The family a global degree of freedom belongs to.
pub(crate) fn dof_kind(index: usize) -> ModeKind {
    match index % STRIDE {
        0 | 6 | 7 => ModeKind::Axial,
        1 | 2 => ModeKind::Lag,
        3 | 4 => ModeKind::Flap,
        _ => ModeKind::Torsion,
    }
}

/// The rows and columns `keep` of a square matrix.
pub(crate) fn restrict(matrix: &DMatrix<f64>, keep: &[usize]) -> DMatrix<f64> {
    DMatrix::from_fn(keep.len(), keep.len(), |i, j| matrix[(keep[i], keep[j])])
}
