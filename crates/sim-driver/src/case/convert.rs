//! From the case file to the validated case: every value is checked, every problem collected.

use super::airfoils::read_airfoils;
use super::checker::Checker;
use super::file_control::SHIPPED_DATASET;
use super::ranges::check_case;
use super::{
    ActuatorChoice, ActuatorSource, ActuatorValues, BladeValues, Case, CaseFile, ControlFile,
    ControlValues, FlapValues, SectionValues, TrimFile, TrimValues,
};
use crate::files::{Folder, RonIndex, SHIPPED_BENCH};
use crate::problem::{Fault, Problem, Problems};
use flap_aero::AirfoilSpan;
use rotor_base::RotorScales;
use std::f64::consts::TAU;
use std::sync::Arc;

/// Validates a case file.
///
/// # Errors
/// Every value out of range, with its line.
pub(super) fn convert(
    file: &CaseFile,
    folder: &Folder,
    index: &RonIndex,
) -> Result<Case, Problems> {
    let mut check = Checker::new(index);
    check_case(&mut check, file);
    let mut problems = check.finish();
    let airfoils = match read_airfoils(&file.aerodynamics.airfoils, folder, index) {
        Ok(airfoils) => airfoils,
        Err(more) => {
            problems.append(more);
            None
        }
    };
    let rotor = &file.rotor;
    let scales = RotorScales::new(rotor.omega_rpm * TAU / 60.0, rotor.radius_m, rotor.mass_kg_m);
    let case =
        problems.into_result(scales.ok().map(|scales| build(file, folder, scales, airfoils)))?;
    // what only the blade as a whole can say: flaps beside a tapered one
    match case.blade_with_flaps() {
        Ok(_) => Ok(case),
        Err(error) => {
            let fault = Fault::Refused { message: error.to_string() };
            Err(Problem::new(index.place("rotor"), fault).into())
        }
    }
}

fn build(
    file: &CaseFile,
    folder: &Folder,
    scales: RotorScales,
    airfoils: Option<Arc<AirfoilSpan>>,
) -> Case {
    let (rotor, structure, control) = (&file.rotor, &file.structure, &file.control);
    let modes = &structure.modes;
    Case {
        title: file.title.clone(),
        advance_ratio: file.advance_ratio,
        scales,
        blades: rotor.blades,
        chord: rotor.chord_r,
        lock_number: rotor.lock_number,
        blade: BladeValues {
            ei_flap: rotor.ei_flap,
            ei_lag: rotor.ei_lag,
            gj: rotor.gj,
            ea: rotor.ea,
            km1: rotor.km1_r,
            km2: rotor.km2_r,
            ka: rotor.ka_r,
            twist_rad: rotor.twist_deg.to_radians(),
            precone_rad: rotor.precone_deg.to_radians(),
            root_cutout: rotor.root_cutout_r,
            modal_damping: rotor.modal_damping,
            elements: structure.elements,
            modes: [modes.flap, modes.lag, modes.torsion],
            basis: structure.basis,
            couplings: structure.couplings,
            untwist: structure.untwist,
            twist_angle: structure.twist_angle,
            root_offset: rotor.root_offset_r,
            root: rotor.root,
            mass_centre: rotor.mass_centre_r,
            tension_centre: rotor.tension_centre_r,
            aerodynamic_centre: rotor.aerodynamic_centre_r,
            torque_offset: rotor.torque_offset_r,
            gravity: rotor.gravity,
            tables: rotor.tables.clone(),
            unlike: rotor.unlike_blades.clone(),
        },
        flaps: file
            .flaps
            .iter()
            .map(|f| FlapValues {
                start: f.start_r,
                end: f.end_r,
                chord_fraction: f.chord_fraction,
                mass_fraction: f.mass_fraction,
                cg_fraction: f.cg_fraction,
                gyration_fraction: f.gyration_fraction,
                mass: f.mass,
                effectiveness: [
                    f.effectiveness.lift,
                    f.effectiveness.moment,
                    f.effectiveness.hinge,
                ],
            })
            .collect(),
        section: SectionValues {
            model: file.aerodynamics.model,
            compressibility: file.aerodynamics.compressibility,
            reverse_flow: file.aerodynamics.reverse_flow,
            drag_coefficient: file.aerodynamics.drag_coefficient,
            speed_of_sound_m_s: file.aerodynamics.speed_of_sound_m_s,
            airfoils,
            dynamic_stall: file.aerodynamics.dynamic_stall,
            tip_loss: file.aerodynamics.tip_loss,
        },
        inflow: file.inflow.model,
        trim: trim_values(&file.trim),
        actuator: ActuatorValues {
            source: actuator_source(&file.actuator.model, folder),
            ideal_amplitude_deg: file.actuator.ideal_amplitude_deg,
            bench_rev_hz: file.actuator.bench_rev_hz,
            range_volt: file.actuator.range_volt,
        },
        control: ControlValues::of(control),
        response: file.response.clone(),
        tolerances: file.tolerances.clone(),
    }
}

impl ControlValues {
    /// The control of a case file.
    pub(crate) fn of(control: &ControlFile) -> Self {
        Self {
            harmonics: control.harmonics.clone(),
            actuators: control.actuators.clone(),
            bias_volt: control.bias_volt,
            amplitude_volt: control.amplitude_volt,
            t_step_deg: control.t_step_deg,
            stroke_limit: control.stroke_limit,
            load_weights: control.load_weights.clone(),
            load_scale: control.load_scale,
            effort: control.effort,
            controller: control.controller,
            t_inflow: control.t_inflow,
            power_limit_watt: control.power_limit_watt,
            power_weight_per_watt: control.power_weight_per_watt,
            max_steps: control.max_steps,
            step_tolerance: control.step_tolerance,
        }
    }
}

fn trim_values(trim: &TrimFile) -> TrimValues {
    match trim {
        TrimFile::Propulsive(p) => TrimValues::Propulsive {
            ct_sigma: p.ct_sigma,
            drag_area: p.drag_area,
            cg_below_hub: p.cg_below_hub_r,
            hub_aft_of_cg: p.hub_aft_of_cg_r,
            hub_starboard_of_cg: p.hub_starboard_of_cg_r,
            tail_rotor_arm: p.tail_rotor_arm_r,
            tail_rotor_height: p.tail_rotor_height_r,
            horizontal_tail: p.horizontal_tail,
        },
        TrimFile::WindTunnel(w) => TrimValues::WindTunnel {
            ct_sigma: w.ct_sigma,
            shaft_tilt_rad: w.shaft_tilt_deg.to_radians(),
        },
        TrimFile::Prescribed(p) => TrimValues::Prescribed {
            theta0_rad: p.theta0_deg.to_radians(),
            theta1c_rad: p.theta1c_deg.to_radians(),
            theta1s_rad: p.theta1s_deg.to_radians(),
            shaft_tilt_rad: p.shaft_tilt_deg.to_radians(),
        },
    }
}

fn actuator_source(choice: &ActuatorChoice, folder: &Folder) -> ActuatorSource {
    match choice {
        ActuatorChoice::Ideal => ActuatorSource::Ideal,
        ActuatorChoice::Bench(bench) if bench.dataset == SHIPPED_DATASET => {
            ActuatorSource::Bench(Folder::Shipped(SHIPPED_BENCH.to_owned()))
        }
        ActuatorChoice::Bench(bench) => ActuatorSource::Bench(folder.join(&bench.dataset)),
        ActuatorChoice::File(stored) => {
            ActuatorSource::Stored { folder: folder.clone(), file: stored.path.clone() }
        }
    }
}
