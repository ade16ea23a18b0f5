//! Rotating modes of a blade, and the data of a fan plot.

use crate::error::StudyError;
use nalgebra::DVector;
use rayon::prelude::*;
use rotor_case::Case;
use rotor_fem::{
    AxialMotion, BladeModel, BladeProperties, CoupledMode, EnergyShares, FemError, GyroscopicTerms,
    ModeKind, ModerateBlade, ModerateModel, ModerateSpec, SectionMotion, StaticSettings,
    deflected_modes, modes,
};
use rotor_response::RESONANCE_PER_REV;
use serde::Serialize;

/// Rotor speeds over the nominal one of a fan plot for which none are given.
pub const FAN_SPEEDS: [f64; 13] = [0.0, 0.1, 0.2, 0.3, 0.4, 0.5, 0.6, 0.7, 0.8, 0.9, 1.0, 1.1, 1.2];

/// The state whose small motions the modes are.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum AboutState {
    /// The blade as rotation deflects it at its pitch, without air loads: nonlinear elements.
    #[default]
    Deflected,
    /// The undeformed blade with the tension of rotation: linear elements.
    Undeformed,
}

/// Which modes are wanted.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct ModesQuestion {
    /// Coriolis terms.
    pub terms: GyroscopicTerms,
    /// Pitch angle at 0.75 R, rad: the collective.
    pub pitch_rad: f64,
    /// State the modes are about.
    pub about: AboutState,
    /// Further rotor speeds over the nominal one.
    pub speed_ratios: Vec<f64>,
    /// Stations r/R, 0 to 1, at which shapes are wanted.
    pub shape_stations_r: Vec<f64>,
}

/// One mode as it is printed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModeLine {
    /// `flap`, `lag` or `torsion`: the family with most of the kinetic energy.
    pub kind: String,
    /// Frequency per revolution of the rotor's own speed; none at rest.
    pub per_rev: Option<f64>,
    /// Frequency, Hz.
    pub hz: f64,
    /// Division of the kinetic energy among flap, lag, torsion and axial motion.
    pub energy: [f64; 4],
    /// Lag, flap (both over R) and twist (rad) at the stations asked for, each as the part that is extreme at time zero and the
    /// part a quarter of a cycle ahead; of unit modal mass. Empty unless asked for.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub shape: Vec<[[f64; 2]; 3]>,
}

/// Displacement of the tip in the state the modes are about.
#[derive(Debug, Clone, Copy, PartialEq, Serialize)]
pub struct SteadyTip {
    /// Toward the leading edge, R.
    pub lag_r: f64,
    /// Up, R.
    pub flap_r: f64,
    /// Elastic twist, deg, nose up.
    pub twist_deg: f64,
}

/// The modes at one rotor speed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModesResult {
    /// Rotor speed, rad/s.
    pub rotor_speed_rad_s: f64,
    /// Tip of the deflected blade; none if the modes are about the undeformed one.
    #[serde(skip_serializing_if = "Option::is_none")]
    pub steady_tip: Option<SteadyTip>,
    /// Flap, lag and torsion modes, each kind from its lowest.
    pub modes: Vec<ModeLine>,
    /// What a user should know about them.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub warnings: Vec<String>,
    /// The same at further rotor speeds: the data of a fan plot.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub fan: Vec<ModesResult>,
}

/// Rotating modes of a case's blade, twist included, at its pitch and at further rotor speeds.
///
/// # Errors
/// [`StudyError::Blade`].
pub fn rotating_modes(case: &Case, question: &ModesQuestion) -> Result<ModesResult, StudyError> {
    let mut fan = modes_at_speeds(case, question, &[&[1.0], &question.speed_ratios[..]].concat())?;
    let nominal = fan.remove(0);
    let warnings = undamped_at_a_harmonic(case, &nominal.modes);
    Ok(ModesResult { warnings, fan, ..nominal })
}

/// Rotating modes of a case's blade at rotor speeds over the nominal one, those of the question aside.
///
/// # Errors
/// [`StudyError::Blade`].
pub fn modes_at_speeds(
    case: &Case,
    question: &ModesQuestion,
    speed_ratios: &[f64],
) -> Result<Vec<ModesResult>, StudyError> {
    let fail = |source: FemError| StudyError::Blade { field: "rotor".to_owned(), source };
    let blade = case.blade_with_flaps()?.with_pitch_rad(question.pitch_rad).map_err(fail)?;
    let at = |ratio: &f64| modes_at(case, question, &blade, *ratio).map_err(fail);
    speed_ratios.par_iter().map(at).collect()
}

/// Lag modes at a harmonic of the rotor speed that nothing damps.
fn undamped_at_a_harmonic(case: &Case, modes: &[ModeLine]) -> Vec<String> {
    if case.rotor.modal_damping > 0.0 {
        return vec![];
    }
    let lag = ModeKind::Lag.to_string();
    let near = |per_rev: f64| (per_rev - per_rev.round()).abs() < RESONANCE_PER_REV;
    numbered(modes)
        .zip(modes)
        .filter(|(_, mode)| mode.kind == lag && mode.per_rev.is_some_and(near))
        .map(|(name, mode)| {
            let harmonic = mode.per_rev.unwrap_or_default().round();
            format!(
                "{name} is at the harmonic {harmonic} of the loads at this pitch and rotor.modal_damping is 0: a rotor that flies at it is refused"
            )
        })
        .collect()
}

fn modes_at(
    case: &Case,
    question: &ModesQuestion,
    blade: &BladeProperties,
    ratio: f64,
) -> Result<ModesResult, FemError> {
    let nominal_rad_s = case.scales().omega_rad_s();
    let (elements, count) = (case.structure.elements, case.mode_count());
    let blade = blade.with_rotor_speed(ratio)?;
    let (lines, steady_tip) = match question.about {
        AboutState::Undeformed => {
            let model = BladeModel::new(blade, elements)?;
            let found = modes(&model, question.terms, count)?;
            let section = |dof: &DVector<f64>, station| model.motion(dof, station);
            (mode_lines(&found, question, nominal_rad_s, &section)?, None)
        }
        AboutState::Deflected => {
            let spec = ModerateSpec {
                mass_centre: case.rotor_model().mass_centre(),
                tension_centre: case.rotor.tension_centre_r.into(),
                torsion: case.torsion_terms(),
                ..ModerateSpec::from(blade.spec().clone())
            };
            let model = ModerateModel::new(ModerateBlade::new(spec)?, elements)?;
            let none = DVector::zeros(model.size());
            let state = model.static_state(&none, &StaticSettings::default())?;
            let tip = model.section(&state.dof, 1.0)?;
            let found = deflected_modes(&model, &state, question.terms, AxialMotion::Free, count)?;
            let (lag_r, flap_r) = (tip.lag[0], tip.flap[0]);
            let section = |dof: &DVector<f64>, station| model.section(dof, station);
            let lines = mode_lines(&found, question, nominal_rad_s, &section)?;
            (lines, Some(SteadyTip { lag_r, flap_r, twist_deg: tip.twist[0].to_degrees() }))
        }
    };
    Ok(ModesResult {
        rotor_speed_rad_s: ratio * nominal_rad_s,
        steady_tip,
        modes: lines,
        warnings: vec![],
        fan: vec![],
    })
}

/// Reads the motion of a station from degrees of freedom.
type ReadStation<'a> = &'a dyn Fn(&DVector<f64>, f64) -> Result<SectionMotion, FemError>;

/// The modes found, with their shapes where they are wanted; `section` reads the motion of a station.
fn mode_lines(
    found: &[CoupledMode],
    question: &ModesQuestion,
    nominal_rad_s: f64,
    section: ReadStation<'_>,
) -> Result<Vec<ModeLine>, FemError> {
    let line = |mode: &CoupledMode| {
        let EnergyShares { flap, lag, torsion, axial } = mode.energy;
        let at = |station: &f64| {
            let [a, b] = [section(&mode.in_phase, *station)?, section(&mode.quadrature, *station)?];
            Ok([[a.lag[0], b.lag[0]], [a.flap[0], b.flap[0]], [a.twist[0], b.twist[0]]])
        };
        Ok(ModeLine {
            kind: mode.kind.to_string(),
            per_rev: mode.per_rev.is_finite().then_some(mode.per_rev),
            hz: mode.frequency * nominal_rad_s / std::f64::consts::TAU,
            energy: [flap, lag, torsion, axial],
            shape: question.shape_stations_r.iter().map(at).collect::<Result<_, FemError>>()?,
        })
    };
    found.iter().map(line).collect()
}

/// `flap 1`, `flap 2`, ... `lag 1`, ...
pub fn numbered(modes: &[ModeLine]) -> impl Iterator<Item = String> {
    modes.iter().enumerate().map(|(i, mode)| {
        let before = modes[..i].iter().filter(|m| m.kind == mode.kind).count();
        format!("{} {}", mode.kind, before + 1)
    })
}
