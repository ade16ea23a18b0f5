//! From the validated case to the values the models below take.

use crate::SimError;
use crate::case::{
    BasisChoice, Case, CompressibilityChoice, CouplingsChoice, DynamicStallChoice, FlapMassChoice,
    GravityChoice, JointChoice, ReverseFlowChoice, SectionModelChoice, TrimValues,
    TwistAngleChoice, UnlikeBladeFile, UntwistChoice,
};
use crate::problem::Place;
use flap_aero::{AttachedFlowModel, FlapEffectiveness};
use rotor_fem::{
    BladeProperties, BladeSpec, Distribution, Joint, ModalBasis, ModeCount, RootSupport,
    TorsionTerms, Twist, TwistAngle, Untwist,
};
use rotor_response::{
    Compressibility, Controls, Couplings, Discretisation, DynamicStall, FlapMass,
    NonlinearSections, ResponseTolerances, ReverseFlow, RotorModel, SectionOffsets,
    TrailingEdgeFlap, with_flap_masses,
};
use trim::{HorizontalTail, TrimSettings, TrimTarget, Vehicle};

/// Standard gravity, m/s^2.
const GRAVITY_M_S2: f64 = 9.806_65;

impl Case {
    /// The blade's structure at zero pitch.
    ///
    /// # Errors
    /// [`SimError::Blade`]; a validated case gives none.
    pub fn blade_properties(&self) -> Result<BladeProperties, SimError> {
        BladeProperties::new(self.blade_spec())
            .map_err(|source| SimError::Blade { place: Place::file("case").field("rotor"), source })
    }

    fn blade_spec(&self) -> BladeSpec {
        let (b, t) = (&self.blade, &self.blade.tables);
        BladeSpec {
            flap_stiffness: distribution(&t.ei_flap, b.ei_flap),
            lag_stiffness: distribution(&t.ei_lag, b.ei_lag),
            torsion_stiffness: distribution(&t.gj, b.gj),
            axial_stiffness: distribution(&t.ea, b.ea),
            mass: distribution(&t.mass, 1.0),
            thickness_gyration_radius: distribution(&t.km1_r, b.km1),
            chord_gyration_radius: distribution(&t.km2_r, b.km2),
            axis_mass: 0.0.into(),
            area_gyration_radius: distribution(&t.ka_r, b.ka),
            twist: if t.twist_deg.is_empty() {
                Twist::Linear { rate_rad: b.twist_rad }
            } else {
                let rad: Vec<(f64, f64)> =
                    t.twist_deg.iter().map(|(x, deg)| (*x, deg.to_radians())).collect();
                Twist::Table(distribution(&rad, 0.0))
            },
            pitch_rad: 0.0,
            precone_rad: b.precone_rad,
            root_offset: b.root_offset,
            root: RootSupport {
                flap: joint(b.root.flap),
                lag: joint(b.root.lag),
                feather: joint(b.root.pitch),
            },
            rotor_speed: 1.0,
        }
    }

    /// The structure of a blade unlike the rest.
    ///
    /// # Errors
    /// As [`Self::blade_properties`].
    pub fn unlike_blade(&self, unlike: &UnlikeBladeFile) -> Result<BladeProperties, SimError> {
        let spec = self.blade_spec();
        let spec = BladeSpec {
            mass: scaled(spec.mass, unlike.mass),
            flap_stiffness: scaled(spec.flap_stiffness, unlike.ei_flap),
            lag_stiffness: scaled(spec.lag_stiffness, unlike.ei_lag),
            torsion_stiffness: scaled(spec.torsion_stiffness, unlike.gj),
            ..spec
        };
        let place = || Place::file("case").field("rotor.unlike_blades");
        BladeProperties::new(spec).map_err(|source| SimError::Blade { place: place(), source })
    }

    /// Centres of the sections off the elastic axis.
    pub fn section_offsets(&self) -> SectionOffsets {
        SectionOffsets {
            mass_centre: self.blade.mass_centre,
            tension_centre: self.blade.tension_centre,
            aerodynamic_centre: self.blade.aerodynamic_centre,
            torque: self.blade.torque_offset,
        }
    }

    /// Terms of torsion that the equations of moderate deflection keep: in flight with the couplings `Moderate`, in
    /// modes about the deflected blade always.
    pub(crate) fn torsion_terms(&self) -> TorsionTerms {
        TorsionTerms {
            untwist: match self.blade.untwist {
                UntwistChoice::Included => Untwist::Included,
                UntwistChoice::Neglected => Untwist::Neglected,
            },
            angle: match self.blade.twist_angle {
                TwistAngleChoice::Rotation => TwistAngle::Rotation,
                TwistAngleChoice::Elastic => TwistAngle::Elastic,
            },
        }
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
            tip_loss: self.section.tip_loss,
            gravity: match self.blade.gravity {
                GravityChoice::Off => 0.0,
                GravityChoice::On => {
                    let speed = self.scales.omega_rad_s();
                    GRAVITY_M_S2 / (speed * speed * self.scales.radius_m())
                }
            },
            offsets: self.section_offsets(),
            modal_damping: self.blade.modal_damping,
            couplings: match self.blade.couplings {
                CouplingsChoice::Linear => Couplings::Linear,
                CouplingsChoice::Full => Couplings::Full,
                CouplingsChoice::Moderate => Couplings::Moderate(self.torsion_terms()),
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

    fn modal_basis(&self) -> ModalBasis {
        match self.blade.basis {
            BasisChoice::Natural => ModalBasis::Natural,
            BasisChoice::Completed => ModalBasis::Completed,
        }
    }

    /// How finely the rotor is resolved.
    pub fn discretisation(&self) -> Discretisation {
        let r = &self.response;
        Discretisation {
            blade_elements: self.blade.elements,
            modes: self.blade.modes,
            basis: self.modal_basis(),
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

/// A table of a case, or the uniform value in its place.
fn distribution(table: &[(f64, f64)], uniform: f64) -> Distribution {
    if table.is_empty() {
        return uniform.into();
    }
    let (stations, values) = table.iter().copied().unzip();
    Distribution::PiecewiseLinear { stations, values }
}

fn scaled(distribution: Distribution, factor: f64) -> Distribution {
    let times = |values: Vec<f64>| values.into_iter().map(|v| factor * v).collect();
    match distribution {
        Distribution::Uniform(value) => Distribution::Uniform(factor * value),
        Distribution::PiecewiseLinear { stations, values } => {
            Distribution::PiecewiseLinear { stations, values: times(values) }
        }
        Distribution::PiecewiseConstant { edges, values } => {
            Distribution::PiecewiseConstant { edges, values: times(values) }
        }
    }
}

fn joint(choice: JointChoice) -> Joint {
    match choice {
        JointChoice::Locked => Joint::Locked,
        JointChoice::Free => Joint::FREE,
        JointChoice::Spring { stiffness } => Joint::Spring { stiffness },
    }
}
