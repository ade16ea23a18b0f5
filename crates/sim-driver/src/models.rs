//! From the validated case to the values the models below take.

use crate::SimError;
use crate::case::{
    Case, CompressibilityChoice, CouplingsChoice, DynamicStallChoice, FlapMassChoice,
    ReverseFlowChoice, SectionModelChoice, TrimValues,
};
use crate::problem::Place;
use flap_aero::{AttachedFlowModel, FlapEffectiveness};
use rotor_fem::{BladeProperties, BladeSpec, ModeCount, TorsionTerms, Twist};
use rotor_response::{
    Compressibility, Controls, Couplings, Discretisation, DynamicStall, FlapMass,
    NonlinearSections, ResponseTolerances, ReverseFlow, RotorModel, TrailingEdgeFlap,
    with_flap_masses,
};
use trim::{HorizontalTail, TrimSettings, TrimTarget, Vehicle};

impl Case {
    /// The blade's structure, clamped at the rotor centre, at zero pitch.
    ///
    /// # Errors
    /// [`SimError::Blade`]; a validated case gives none.
    pub fn blade_properties(&self) -> Result<BladeProperties, SimError> {
        let b = &self.blade;
        let spec = BladeSpec {
            thickness_gyration_radius: b.km1.into(),
            chord_gyration_radius: b.km2.into(),
            area_gyration_radius: b.ka.into(),
            twist: Twist::Linear { rate_rad: b.twist_rad },
            precone_rad: b.precone_rad,
            ..BladeSpec::uniform(b.ei_flap, b.ei_lag, b.gj, b.ea)
        };
        BladeProperties::new(spec)
            .map_err(|source| SimError::Blade { place: Place::file("case").field("rotor"), source })
    }

    /// The same with the mass of flaps that it does not contain.
    ///
    /// # Errors
    /// As [`Self::blade_properties`]; [`SimError::Response`], which a validated case does not give.
    pub fn blade_with_flaps(&self) -> Result<BladeProperties, SimError> {
        with_flap_masses(&self.blade_properties()?, &self.rotor_model().flaps).map_err(|source| {
            SimError::Response { place: Place::file("case").field("flaps"), source }
        })
    }

    /// Modes kept in the response.
    pub fn mode_count(&self) -> ModeCount {
        let [flap, lag, torsion] = self.blade.modes;
        ModeCount { flap, lag, torsion, axial: 0 }
    }

    /// The rotor apart from the structure of its blades.
    pub fn rotor_model(&self) -> RotorModel {
        RotorModel {
            blades: self.blades,
            chord: self.chord,
            lock_number: self.lock_number,
            drag_coefficient: self.section.drag_coefficient,
            root_cutout: self.blade.root_cutout,
            modal_damping: self.blade.modal_damping,
            couplings: match self.blade.couplings {
                CouplingsChoice::Linear => Couplings::Linear,
                CouplingsChoice::Full => Couplings::Full,
                CouplingsChoice::Moderate => Couplings::Moderate(TorsionTerms::default()),
            },
            section_model: self.section_model(),
            compressibility: match self.section.compressibility {
                CompressibilityChoice::None => Compressibility::None,
                CompressibilityChoice::LocalMach => {
                    Compressibility::LocalMach { tip_mach: self.tip_mach() }
                }
            },
            reverse_flow: match self.section.reverse_flow {
                ReverseFlowChoice::Gradual => ReverseFlow::Gradual,
                ReverseFlowChoice::Abrupt => ReverseFlow::Abrupt,
            },
            flaps: self
                .flaps
                .iter()
                .map(|f| TrailingEdgeFlap {
                    start: f.start,
                    end: f.end,
                    chord_fraction: f.chord_fraction,
                    mass_fraction: f.mass_fraction,
                    cg_fraction: f.cg_fraction,
                    gyration_fraction: f.gyration_fraction,
                    mass: match f.mass {
                        FlapMassChoice::PartOfBlade => FlapMass::PartOfBlade,
                        FlapMassChoice::AddedToBlade => FlapMass::AddedToBlade,
                    },
                    effectiveness: effectiveness(f.effectiveness),
                })
                .collect(),
            nonlinear: NonlinearSections {
                airfoils: self.section.airfoils.clone(),
                dynamic_stall: match self.section.dynamic_stall {
                    DynamicStallChoice::Off => None,
                    DynamicStallChoice::Naca0012 => Some(DynamicStall::Naca0012),
                },
            },
        }
    }

    /// Section aerodynamics.
    pub fn section_model(&self) -> AttachedFlowModel {
        match self.section.model {
            SectionModelChoice::QuasiSteady => AttachedFlowModel::QuasiSteady,
            SectionModelChoice::Incompressible => AttachedFlowModel::Incompressible,
            SectionModelChoice::HariharanLeishman => AttachedFlowModel::HariharanLeishman,
            SectionModelChoice::Calibrated => AttachedFlowModel::Calibrated,
        }
    }

    /// How finely the rotor is resolved.
    pub fn discretisation(&self) -> Discretisation {
        let r = &self.response;
        Discretisation {
            blade_elements: self.blade.elements,
            modes: self.blade.modes,
            span_points_per_piece: r.span_points_per_piece,
            time_elements: r.time_elements,
            time_order: r.time_order,
            time_gauss_points: r.time_gauss_points,
            load_harmonics: r.load_harmonics,
        }
    }

    /// What the rotor is trimmed to.
    pub fn trim_target(&self) -> TrimTarget {
        match self.trim {
            TrimValues::Propulsive {
                ct_sigma,
                drag_area,
                cg_below_hub,
                hub_aft_of_cg,
                hub_starboard_of_cg,
                tail_rotor_arm,
                tail_rotor_height,
                horizontal_tail: tail,
            } => TrimTarget::Propulsive {
                weight_ct_sigma: ct_sigma,
                vehicle: Vehicle {
                    drag_area,
                    cg_below_hub,
                    hub_aft_of_cg,
                    hub_starboard_of_cg,
                    tail_rotor_arm,
                    tail_rotor_height,
                    horizontal_tail: HorizontalTail {
                        area: tail.area,
                        arm: tail.arm_r,
                        height: tail.height_r,
                        incidence_rad: tail.incidence_deg.to_radians(),
                        lift_slope: tail.lift_slope,
                    },
                },
            },
            TrimValues::WindTunnel { ct_sigma, shaft_tilt_rad } => {
                TrimTarget::WindTunnel { ct_sigma, shaft_tilt_rad }
            }
            TrimValues::Prescribed { theta0_rad, theta1c_rad, theta1s_rad, shaft_tilt_rad } => {
                TrimTarget::Prescribed {
                    controls: Controls { theta0_rad, theta1c_rad, theta1s_rad },
                    shaft_tilt_rad,
                }
            }
        }
    }

    /// Tolerances of the periodic response.
    pub fn response_tolerances(&self) -> ResponseTolerances {
        let t = &self.tolerances;
        ResponseTolerances {
            periodicity: t.periodicity,
            inflow: t.inflow,
            inflow_iterations: t.inflow_iterations,
        }
    }

    /// Tolerances of the trim.
    pub fn trim_settings(&self) -> TrimSettings {
        let t = &self.tolerances;
        TrimSettings { tolerance: t.trim, max_iterations: t.trim_iterations }
    }
}

/// The factors of a flap; a case's are within their range.
fn effectiveness([lift, moment, hinge]: [f64; 3]) -> FlapEffectiveness {
    FlapEffectiveness::new(lift, moment, hinge).unwrap_or_default()
}
