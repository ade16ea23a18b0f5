//! From the values of a case to those the models below take: radians, rotor units.

use super::{
    Case, CompressibilityChoice, CouplingsChoice, DissimilarBlade, EffectivenessValues, FlapValues,
    FreeWakeValues, GravityChoice, PitchHarmonic, PropulsiveTrim, RolledUpChoice, TrimValues,
};
use crate::ModelError;
use flap_aero::{AttachedFlowModel, FlapEffectiveness};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_fem::{BladeProperties, BladeSpec, Distribution, ModeCount, TorsionTerms, Twist};
use rotor_response::{
    Camber, Compressibility, Controls, Couplings, Discretisation, DynamicStall, NonlinearSections,
    Planform, ResponseTolerances, Rotor, RotorModel, SectionOffsets, TrailingEdgeFlap,
    with_flap_masses,
};
use rotor_wake::{CoreSettings, FarTrailers, FreeWakeSettings, ShedVorticity};
use trim::{HorizontalTail, TrimSettings, TrimTarget, Vehicle, WakeTrimSettings};

/// Stations outboard of the root at which the loads are given unless a case says others, R.
const USUAL_STATIONS_R: [f64; 3] = [0.25, 0.5, 0.75];

/// Planes in which tip vortices are given unless a case says others, on both sides of the rotor, R.
const USUAL_PLANES_R: [f64; 4] = [0.4, 0.7, 0.85, 0.97];

/// Standard gravity, m/s^2.
const GRAVITY_M_S2: f64 = 9.806_65;

/// Where the sheet inboard of the tip vortex goes on as vortices, unit `R`.
const SHEET_STATIONS: [f64; 4] = [0.35, 0.5, 0.65, 0.78];

/// Kinematic viscosity of air at sea level, m^2/s (ISA).
const VISCOSITY_M2_S: f64 = 1.46e-5;

impl Case {
    /// The blade's structure at zero pitch.
    ///
    /// # Errors
    /// [`ModelError::Blade`]; a checked case gives none.
    pub fn blade_properties(&self) -> Result<BladeProperties, ModelError> {
        self.blade(&DissimilarBlade::default(), "rotor")
    }

    /// The structure of a blade that differs from the others.
    ///
    /// # Errors
    /// As [`Self::blade_properties`].
    pub fn dissimilar_blade(&self, own: &DissimilarBlade) -> Result<BladeProperties, ModelError> {
        self.blade(own, "rotor.dissimilar_blades")
    }

    /// The structure with the factors of a blade; `field` is at fault where there is none.
    fn blade(&self, own: &DissimilarBlade, field: &str) -> Result<BladeProperties, ModelError> {
        let (b, t) = (&self.rotor, &self.rotor.tables);
        let twist_rad: Vec<_> = t.twist_deg.iter().map(|(x, deg)| (*x, deg.to_radians())).collect();
        let spec = BladeSpec {
            flap_stiffness: distribution(&t.ei_flap, b.ei_flap, own.ei_flap),
            lag_stiffness: distribution(&t.ei_lag, b.ei_lag, own.ei_lag),
            torsion_stiffness: distribution(&t.gj, b.gj, own.gj),
            axial_stiffness: distribution(&t.ea, b.ea, 1.0),
            mass: distribution(&t.mass, 1.0, own.mass),
            thickness_gyration_radius: distribution(&t.km1_r, b.km1_r, 1.0),
            chord_gyration_radius: distribution(&t.km2_r, b.km2_r, 1.0),
            axis_mass: 0.0.into(),
            area_gyration_radius: distribution(&t.ka_r, b.ka_r, 1.0),
            twist: given(&twist_rad, 1.0)
                .map_or(Twist::Linear { rate_rad: b.twist_deg.to_radians() }, Twist::Table),
            pitch_rad: 0.0,
            precone_rad: b.precone_deg.to_radians(),
            root_offset: b.root_offset_r,
            root: b.root,
            rotor_speed: 1.0,
        };
        BladeProperties::new(spec)
            .map_err(|source| ModelError::Blade { field: field.to_owned(), source })
    }

    /// Higher harmonics of pitch at the root of every blade, rad.
    pub fn root_pitch_rad(&self) -> HarmonicSeries {
        let given = &self.rotor.root_pitch;
        let most = given.iter().map(|one| one.harmonic).max().unwrap_or(0);
        let mut series = HarmonicSeries::zero(most);
        for PitchHarmonic { harmonic, amplitude_deg, phase_deg } in given {
            let (amplitude, phase) = (amplitude_deg.to_radians(), phase_deg.to_radians());
            series.set_harmonic(*harmonic, Harmonic::from_amplitude_phase(amplitude, phase));
        }
        series
    }

    /// Terms of torsion that the equations of moderate deflection keep: in flight with the couplings `Moderate`, in
    /// modes about the deflected blade always.
    pub fn torsion_terms(&self) -> TorsionTerms {
        TorsionTerms { untwist: self.structure.untwist, angle: self.structure.twist_angle }
    }

    /// The same with the mass of flaps that it does not contain.
    ///
    /// # Errors
    /// As [`Self::blade_properties`]; [`ModelError::Response`], which a checked case does not give.
    pub fn blade_with_flaps(&self) -> Result<BladeProperties, ModelError> {
        with_flap_masses(&self.blade_properties()?, &self.rotor_model().flaps)
            .map_err(|source| ModelError::Response { field: "flaps".to_owned(), source })
    }

    /// The rotor with blades of a structure; `field` is at fault where it cannot be built.
    ///
    /// # Errors
    /// [`ModelError::Response`].
    pub fn rotor_of(&self, blade: &BladeProperties, field: &str) -> Result<Rotor, ModelError> {
        Rotor::new(self.rotor_model(), blade, self.discretisation())
            .map_err(|source| ModelError::Response { field: field.to_owned(), source })
    }

    /// Modes kept in the response.
    pub fn mode_count(&self) -> ModeCount {
        let [flap, lag, torsion] = self.structure.modes.as_array();
        ModeCount { flap, lag, torsion, axial: 0 }
    }

    /// The rotor apart from the structure of its blades.
    pub fn rotor_model(&self) -> RotorModel {
        RotorModel {
            blades: self.rotor.blades,
            chord: self.rotor.chord_r,
            planform: Planform {
                chord: given(&self.rotor.tables.chord_r, 1.0),
                set_back: given(&self.rotor.tables.set_back_r, 1.0),
            },
            lock_number: self.rotor.lock_number,
            drag_coefficient: self.aerodynamics.drag_coefficient,
            camber: Camber {
                zero_lift_rad: self.aerodynamics.zero_lift_deg.to_radians(),
                moment: self.aerodynamics.zero_lift_moment,
            },
            root_cutout: self.rotor.root_cutout_r,
            tip_loss: self.aerodynamics.tip_loss,
            gravity: match self.rotor.gravity {
                GravityChoice::Off => 0.0,
                GravityChoice::On => {
                    let scales = self.scales();
                    let speed = scales.omega_rad_s();
                    GRAVITY_M_S2 / (speed * speed * scales.radius_m())
                }
            },
            offsets: SectionOffsets {
                mass_centre: self.rotor.mass_centre_r,
                tension_centre: self.rotor.tension_centre_r,
                aerodynamic_centre: self.rotor.aerodynamic_centre_r,
                torque: self.rotor.torque_offset_r,
            },
            modal_damping: self.rotor.modal_damping,
            lag_damper: self.rotor.lag_damper,
            couplings: match self.structure.couplings {
                CouplingsChoice::Linear => Couplings::Linear,
                CouplingsChoice::Full => Couplings::Full,
                CouplingsChoice::Moderate => Couplings::Moderate(self.torsion_terms()),
            },
            section_model: self.aerodynamics.model,
            compressibility: match self.aerodynamics.compressibility {
                CompressibilityChoice::None => Compressibility::None,
                CompressibilityChoice::LocalMach => {
                    Compressibility::LocalMach { tip_mach: self.tip_mach() }
                }
            },
            reverse_flow: self.aerodynamics.reverse_flow,
            flaps: self.flaps.iter().map(FlapValues::model).collect(),
            nonlinear: NonlinearSections {
                airfoils: self.aerodynamics.tables.clone(),
                dynamic_stall: self.aerodynamics.dynamic_stall.airfoil().map(DynamicStall::Of),
            },
        }
    }

    /// How finely the rotor is resolved.
    pub fn discretisation(&self) -> Discretisation {
        let r = &self.response;
        Discretisation {
            blade_elements: self.structure.elements,
            modes: self.structure.modes.as_array(),
            basis: self.structure.basis,
            span_points_per_piece: r.span_points_per_piece,
            time_elements: r.time_elements,
            time_order: r.time_order,
            time_gauss_points: r.time_gauss_points,
            load_harmonics: r.load_harmonics,
        }
    }

    /// What the rotor is trimmed to.
    pub fn trim_target(&self) -> TrimTarget {
        match &self.trim {
            TrimValues::Propulsive(p) => {
                TrimTarget::Propulsive { weight_ct_sigma: p.ct_sigma, vehicle: p.vehicle() }
            }
            TrimValues::WindTunnel(w) => TrimTarget::WindTunnel {
                ct_sigma: w.ct_sigma,
                shaft_tilt_rad: w.shaft_tilt_deg.to_radians(),
                hub_moments: [w.hub_mx_n_m, w.hub_my_n_m]
                    .map(|moment| moment / self.scales().moment_newton_metre()),
            },
            TrimValues::Prescribed(p) => TrimTarget::Prescribed {
                controls: Controls {
                    theta0_rad: p.theta0_deg.to_radians(),
                    theta1c_rad: p.theta1c_deg.to_radians(),
                    theta1s_rad: p.theta1s_deg.to_radians(),
                },
                shaft_tilt_rad: p.shaft_tilt_deg.to_radians(),
            },
        }
    }

    /// Stations at which the loads of the blade are asked for, R; root, 0.25, 0.5 and 0.75 unless the case says
    /// others.
    pub fn load_stations_r(&self) -> Vec<f64> {
        let root = self.rotor.root_offset_r;
        self.response.load_stations_r.clone().unwrap_or_else(|| {
            let outboard = USUAL_STATIONS_R.into_iter().filter(|station| *station > root + 1e-3);
            std::iter::once(root).chain(outboard).collect()
        })
    }

    /// Planes of constant `Y` in which the tip vortices of a free wake are asked for, R, starboard positive, in the order of
    /// the case; 0.4, 0.7, 0.85 and 0.97 on both sides, from port, unless the case says others.
    pub fn vortex_planes_y_r(&self) -> Vec<f64> {
        self.response.vortex_planes_y_r.clone().unwrap_or_else(|| {
            let port = USUAL_PLANES_R.into_iter().rev().map(|y| -y);
            port.chain(USUAL_PLANES_R).collect()
        })
    }

    /// Tolerances of the periodic response.
    pub fn response_tolerances(&self) -> ResponseTolerances {
        let t = &self.tolerances;
        ResponseTolerances {
            periodicity: t.periodicity,
            inflow: t.inflow,
            inflow_iterations: t.inflow_iterations,
            ..ResponseTolerances::default()
        }
    }

    /// The coupling with a free wake.
    pub fn wake_trim_settings(&self, values: &FreeWakeValues) -> WakeTrimSettings {
        let scales = self.scales();
        let speed = scales.tip_speed_m_s() * scales.radius_m();
        let chosen = values.choices();
        let far = match chosen.rolled_up {
            RolledUpChoice::Tip => FarTrailers::Tip,
            RolledUpChoice::TipAndRoot => FarTrailers::TipAndRoot,
            RolledUpChoice::TipRootAndFlaps => FarTrailers::Stations(
                self.flaps.iter().flat_map(|f| [f.start_r, f.end_r]).collect(),
            ),
            RolledUpChoice::TipRootAndSheet => FarTrailers::Stations(SHEET_STATIONS.to_vec()),
        };
        let wake = FreeWakeSettings {
            azimuths: values.azimuths_for(self.rotor.blades),
            turns: chosen.turns,
            far_turns: values.far_turns_at(self.advance_ratio),
            near_wake_rad: chosen.near_wake_deg.to_radians(),
            near_wake_motion: chosen.near_wake,
            far,
            // what quasi-steady sections do not know of the past, the wake does
            shed: match self.aerodynamics.model {
                AttachedFlowModel::QuasiSteady => ShedVorticity::InWake,
                _ => ShedVorticity::InSections,
            },
            release: values.release,
            control_point: values.control_point,
            core: CoreSettings {
                model: chosen.core,
                radius: values.core_r,
                mutual_radius: values.mutual_core_r,
                near_radius: values.near_core_r.unwrap_or(self.rotor.chord_r),
                panel_share: values.panel_share,
                viscosity: VISCOSITY_M2_S / speed,
                ..CoreSettings::default()
            },
            symmetry: chosen.symmetry,
            far_field: chosen.far_field,
            velocity_stride: chosen.velocity_stride,
            body: values.body.body(),
            ..FreeWakeSettings::default()
        };
        let usual = WakeTrimSettings::default();
        WakeTrimSettings {
            wake,
            panels: values.panels,
            section_azimuths: values.section_azimuths,
            // of the coarse grid before, too, the blades get whole steps
            stages: usual.stages.iter().map(|n| n.next_multiple_of(self.rotor.blades)).collect(),
            inflow_tolerance: values.tolerance,
            displacement_tolerance: values.displacement_tolerance_r,
            updates: values.updates,
            method: values.method,
            ..usual
        }
    }

    /// Tolerances of the trim.
    pub fn trim_settings(&self) -> TrimSettings {
        let t = &self.tolerances;
        TrimSettings { tolerance: t.trim, max_iterations: t.trim_iterations }
    }
}

impl FlapValues {
    fn model(&self) -> TrailingEdgeFlap {
        let EffectivenessValues { lift, moment, hinge } = self.effectiveness;
        TrailingEdgeFlap {
            start: self.start_r,
            end: self.end_r,
            chord_fraction: self.chord_fraction,
            mass_fraction: self.mass_fraction,
            cg_fraction: self.cg_fraction,
            gyration_fraction: self.gyration_fraction,
            mass: self.mass,
            // the factors of a checked case are within their range
            effectiveness: FlapEffectiveness::new(lift, moment, hinge).unwrap_or_default(),
        }
    }
}

impl PropulsiveTrim {
    fn vehicle(&self) -> Vehicle {
        let tail = &self.horizontal_tail;
        Vehicle {
            drag_area: self.drag_area,
            cg_below_hub: self.cg_below_hub_r,
            hub_aft_of_cg: self.hub_aft_of_cg_r,
            hub_starboard_of_cg: self.hub_starboard_of_cg_r,
            tail_rotor_arm: self.tail_rotor_arm_r,
            tail_rotor_height: self.tail_rotor_height_r,
            horizontal_tail: HorizontalTail {
                area: tail.area,
                arm: tail.arm_r,
                height: tail.height_r,
                incidence_rad: tail.incidence_deg.to_radians(),
                lift_slope: tail.lift_slope,
            },
        }
    }
}

/// A table of a case, or the uniform value in its place, times a factor.
fn distribution(table: &[(f64, f64)], uniform: f64, factor: f64) -> Distribution {
    given(table, factor).unwrap_or_else(|| (factor * uniform).into())
}

/// A table of a case times a factor, if the case has it.
fn given(table: &[(f64, f64)], factor: f64) -> Option<Distribution> {
    let (stations, values) = table.iter().map(|(x, value)| (*x, factor * value)).unzip();
    (!table.is_empty()).then_some(Distribution::PiecewiseLinear { stations, values })
}
