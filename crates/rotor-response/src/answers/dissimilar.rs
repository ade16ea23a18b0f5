//! Hub loads of a rotor whose blades are not all alike.

use crate::loads::wrenches::{SixLoads, hub_loads};
use crate::response::revolution::{RevolutionLoads, SETTLED};
use crate::{Condition, ResponseError, ResponseResiduals, RotorSolution, RotorSolver};
use rotor_fem::Orbit;

/// A blade unlike the rest.
#[derive(Debug, Clone)]
pub struct OtherBlade {
    /// Its place: it flies `2 pi position / N_b` ahead of the azimuth of the rotor, from 0.
    pub position: usize,
    /// A solver of a rotor all of whose blades are like this one.
    pub solver: RotorSolver,
    /// The condition of the rotor, with the flap motions of this blade.
    pub condition: Condition,
}

impl RotorSolver {
    /// Root loads of one blade of this rotor in the inflow of a solution, held: harmonics to one more
    /// than `load_harmonics`, against the blade's own azimuth.
    ///
    /// # Errors
    /// [`ResponseError::FlapMotions`], [`ResponseError::Periodic`].
    pub fn blade_loads(
        &mut self,
        condition: &Condition,
        about: &RotorSolution,
    ) -> Result<SixLoads, ResponseError> {
        let loads = self.in_inflow_of(condition, about)?.2;
        Ok(loads.root(&self.time, self.rotor.discretisation.load_harmonics + 1))
    }

    /// The response of one blade of this rotor in the inflow of a solution, held, for its stability and its
    /// loads along the span: motion, loads, hinge moments and power are the blade's, inflow, thrust and hub
    /// loads those of the solution.
    ///
    /// # Errors
    /// As [`Self::blade_loads`].
    pub fn blade_response(
        &mut self,
        condition: &Condition,
        about: &RotorSolution,
    ) -> Result<RotorSolution, ResponseError> {
        let (orbit, residuals, loads) = self.in_inflow_of(condition, about)?;
        let count = self.rotor.discretisation.load_harmonics;
        Ok(RotorSolution {
            modal: self.modal_harmonics(&orbit.sample(&self.time)),
            orbit,
            root: loads.root(&self.time, count),
            hinge: loads.hinge(&self.time, count),
            power: loads.power,
            lifting: loads.lifting,
            accelerations: loads.accelerations,
            residuals,
            ..about.clone()
        })
    }

    fn in_inflow_of(
        &mut self,
        condition: &Condition,
        about: &RotorSolution,
    ) -> Result<(Orbit, ResponseResiduals, RevolutionLoads), ResponseError> {
        self.check_flaps(&condition.flap_angles_rad)?;
        let (rotor, air) = (self.rotor.clone(), self.air.clone());
        let system = rotor.system(&air, self.point_inputs(condition, &about.inflow));
        let solved = self.solver.solve(&system, &about.orbit);
        let solution = solved.map_err(Self::orbit_error(&rotor))?;
        let residuals = ResponseResiduals {
            periodicity: solution.residual_norm,
            response_iterations: solution.iterations,
            factorisations: solution.factorisations,
            inflow_iterations: 0,
            ..about.residuals
        };
        let found = (solution.samples, solution.force, solution.seen);
        let loads = RevolutionLoads::new(&rotor, &self.solver, &system, found, SETTLED)?;
        Ok((solution.orbit, residuals, loads))
    }
}

/// Hub loads of a rotor with some blades unlike the rest, at every harmonic: nothing filters any more.
///
/// Controls, attitude and inflow stay those of the solution with all blades alike: one blade that is off
/// changes the mean loads and the inflow by its share only.
///
/// # Errors
/// [`ResponseError::Parameter`] for a place that no blade has, and the errors of
/// [`RotorSolver::blade_loads`].
pub fn dissimilar_hub_loads(
    alike: &mut RotorSolver,
    (condition, about): (&Condition, &RotorSolution),
    others: &mut [OtherBlade],
) -> Result<SixLoads, ResponseError> {
    let (blades, count) = (alike.rotor.model().blades, alike.rotor.discretisation.load_harmonics);
    let common = alike.blade_loads(condition, about)?;
    let mut loads = vec![common; blades];
    for other in others {
        let place = loads.get_mut(other.position).ok_or(ResponseError::Parameter {
            field: "position of a blade",
            value: other.position as f64,
            expected: "0 to the number of blades less one",
        })?;
        *place = other.solver.blade_loads(&other.condition, about)?;
    }
    Ok(hub_loads(&loads, count))
}
