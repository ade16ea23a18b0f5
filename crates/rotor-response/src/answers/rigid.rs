//! Pitch controls of a rigid blade: where the trim of an elastic one starts.

use crate::{Controls, Rotor};
use nalgebra::{Matrix3, Vector3};
use rotor_base::uniform_azimuths_rad;

/// Azimuths of the average; the products hold no more than four harmonics but for reverse flow.
const AZIMUTHS: usize = 72;

impl Rotor {
    /// Controls with which a rigid blade that neither cones nor flaps carries a mean thrust without
    /// first-harmonic flap moment.
    ///
    /// ```text
    /// K mean int |U_T| (U_T theta - lambda) dx             = T / N_b
    /// mean int |U_T| (U_T theta - lambda) x cos psi dx     = 0        likewise sin psi
    /// U_T = x + mu sin psi,   theta = theta0 + theta1c cos psi + theta1s sin psi + twist,
    /// K = rho c a / (2 m0 beta),  a = 2 pi,  beta at 0.75 R
    /// ```
    /// Three linear equations for three controls.
    ///
    /// | argument | symbol | unit |
    /// |---|---|---|
    /// | `advance_ratio` | `mu` | tip speed |
    /// | `inflow` | `lambda` | tip speed, down positive |
    /// | `thrust` | T | m0 Omega^2 R^2 |
    ///
    /// Returns none if the equations are singular, which a blade that lifts somewhere is not.
    ///
    /// The weights of a tapered blade hold its chord over the reference chord.
    ///
    /// Assumes: quasi-steady lift of a symmetrical section, uniform inflow, flaps at rest.
    /// Source: blade-element theory; the airloads of this crate with the blade's motion left out.
    pub fn rigid_blade_controls(
        &self,
        advance_ratio: f64,
        inflow: f64,
        thrust: f64,
    ) -> Option<Controls> {
        let (blade, model) = (self.blade(), self.model());
        let mach = 0.75 * model.compressible_tip_mach();
        let slope = std::f64::consts::TAU / (1.0 - mach * mach).max(0.05).sqrt();
        let lift = 0.5 * model.density_chord() * slope;
        let mut matrix = Matrix3::zeros();
        let mut without_controls = Vector3::zeros();
        for psi in uniform_azimuths_rad(AZIMUTHS) {
            let (sin, cos) = psi.sin_cos();
            for (i, (&x, &weight)) in blade.grid.x().iter().zip(blade.grid.weight()).enumerate() {
                if x < blade.cutout || x > blade.tip_loss {
                    continue;
                }
                let speed = x + advance_ratio * sin;
                let taper = blade.air[i].chord / model.chord;
                let part = weight * taper * speed.abs() / AZIMUTHS as f64;
                // thrust, and the flap moments that turn once per revolution
                let test = Vector3::new(1.0, x * cos, x * sin);
                let pitch = Vector3::new(1.0, cos, sin);
                matrix += part * speed * test * pitch.transpose();
                let incidence = blade.twist[i] - blade.air[i].zero_lift;
                without_controls += part * (speed * incidence - inflow) * test;
            }
        }
        let wanted = Vector3::new(thrust / (model.blades as f64 * lift), 0.0, 0.0);
        let found = matrix.lu().solve(&(wanted - without_controls))?;
        Some(Controls { theta0_rad: found[0], theta1c_rad: found[1], theta1s_rad: found[2] })
    }
}

#[cfg(test)]
mod tests {
    use crate::{
        Camber, Compressibility, Couplings, Discretisation, NonlinearSections, ReverseFlow, Rotor,
        RotorModel, SectionOffsets,
    };
    use approx::assert_relative_eq;
    use flap_aero::AttachedFlowModel;
    use rotor_fem::{BladeProperties, BladeSpec, Twist};

    fn rotor(cutout: f64) -> Rotor {
        let twist = Twist::Linear { rate_rad: -0.14 };
        let blade = BladeProperties::new(BladeSpec {
            twist,
            ..BladeSpec::uniform(0.0108, 0.0268, 0.00615, 1000.0)
        })
        .unwrap();
        let model = RotorModel {
            tip_loss: 1.0,
            gravity: 0.0,
            offsets: SectionOffsets::default(),
            blades: 4,
            chord: 0.055,
            planform: crate::Planform::default(),
            lock_number: 5.2,
            drag_coefficient: 0.01,
            camber: Camber::default(),
            root_cutout: cutout,
            modal_damping: 0.005,
            lag_damper: 0.0,
            couplings: Couplings::Linear,
            section_model: AttachedFlowModel::QuasiSteady,
            compressibility: Compressibility::None,
            reverse_flow: ReverseFlow::default(),
            flaps: vec![],
            nonlinear: NonlinearSections::default(),
        };
        Rotor::new(model, &blade, Discretisation::default()).unwrap()
    }

    /// With no cut-out, thrust and moment have closed forms: of the reverse-flow circle they hold the
    /// terms in mu^2, and at mu 0.05 those in mu^3 are below 0.02 %.
    #[test]
    fn forward_flight_meets_the_closed_blade_element_integrals() {
        let (mu, lambda) = (0.05_f64, 0.03);
        let rotor = rotor(0.0);
        let model = rotor.model();
        let thrust = model.thrust_of_loading(0.07);
        let c = rotor.rigid_blade_controls(mu, lambda, thrust).unwrap();
        let (theta0, tw, t1s) = (c.theta0_rad + 0.75 * 0.14, -0.14, c.theta1s_rad);
        // root pitch theta0, twist tw x
        let loading = 0.07;
        let integral =
            theta0 * (1.0 / 3.0 + mu * mu / 2.0) + tw * (0.25 + mu * mu / 4.0) + t1s * mu / 2.0
                - lambda * (0.5 + mu * mu / 4.0);
        assert_relative_eq!(std::f64::consts::PI * integral, loading, max_relative = 3e-4);
        let sine = theta0 * (2.0 * mu / 3.0) + tw * mu / 2.0 + t1s * (0.25 + 3.0 * mu * mu / 8.0)
            - lambda * mu / 2.0;
        assert!(sine.abs() < 1e-5, "{sine}");
        assert!(c.theta1c_rad.abs() < 1e-12, "nothing asks for it without coning");
    }

    #[test]
    fn hover_needs_no_cyclic() {
        let rotor = rotor(0.2);
        let thrust = rotor.model().thrust_of_loading(0.07);
        let c = rotor.rigid_blade_controls(0.0, 0.05, thrust).unwrap();
        assert!(c.theta1c_rad.abs() < 1e-14 && c.theta1s_rad.abs() < 1e-14);
        assert!(c.theta0_rad > 0.05 && c.theta0_rad < 0.25);
    }
}
