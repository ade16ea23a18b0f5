//! Modal blades made of the modes of a nonlinear finite-element blade.

use nalgebra::DVector;

use super::modal::{ModalBlade, ModalShape};
use super::section_shape::SectionShape;
use super::{AxialMotion, ModerateModel, StaticState, deflected_modes};
use crate::{CoupledMode, FemError, GyroscopicTerms, ModeCount};

impl ModalBlade {
    /// The blade about a static state, reduced to real modes of small motion about it.
    ///
    /// The axial motion is condensed, in the shapes as in the modal equations. Quadrature: the blade's
    /// elements with `points` Gauss points in each.
    ///
    /// Returns the blade and its modes, in the order flap, lag, torsion, each of unit modal mass.
    ///
    /// # Errors
    /// Those of [`deflected_modes`] and [`ModalBlade::new`]. Axial modes do not exist.
    pub fn about(
        model: &ModerateModel,
        state: &StaticState,
        count: ModeCount,
        points: usize,
    ) -> Result<(Self, Vec<CoupledMode>), FemError> {
        let terms = GyroscopicTerms::Neglected;
        let modes = deflected_modes(model, state, terms, AxialMotion::Condensed, count)?;
        let stations = Self::stations_of(model.edges(), points)?;
        let sample = |dof: &DVector<f64>| -> Result<ModalShape, FemError> {
            let section = |x: f64| {
                let s = model.section(dof, x)?;
                Ok(SectionShape { lag: s.lag, flap: s.flap, twist: s.twist })
            };
            Ok(ModalShape {
                root: section(model.edges()[0])?,
                sections: stations.iter().map(|x| section(*x)).collect::<Result<_, FemError>>()?,
            })
        };
        let shapes =
            modes.iter().map(|mode| sample(&mode.in_phase)).collect::<Result<_, FemError>>()?;
        let base = sample(&state.dof)?;
        let blade = Self::new(model.blade(), model.edges(), points, Some(base), shapes)?;
        Ok((blade, modes))
    }
}
