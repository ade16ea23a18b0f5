//! `hhc modes`: rotating frequencies and the data of a fan plot.

use crate::SimError;
use crate::case::{Case, LoadedCase};
use crate::output::{Printable, Sheet, table};
use crate::problem::Place;
use nalgebra::DVector;
use rotor_fem::{
    AxialMotion, BladeModel, BladeProperties, CoupledMode, EnergyShares, FemError, GyroscopicTerms,
    ModeKind, ModerateBlade, ModerateModel, ModerateSpec, SectionMotion, StaticSettings,
    deflected_modes, modes,
};
use rotor_response::RESONANCE_PER_REV;
use serde::Serialize;
use std::fmt::Write as _;

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

/// Rotating modes of a case's blade, twist included, at its pitch and at further rotor speeds, with doubts about
/// the blade.
///
/// # Errors
/// [`SimError::Blade`].
pub fn rotating_modes(
    loaded: &LoadedCase,
    question: &ModesQuestion,
) -> Result<ModesResult, SimError> {
    let case = &loaded.case;
    let doubts = || loaded.blade_doubts();
    let found = modes_of(case, question).map_err(|error| error.in_doubt(doubts()))?;
    let warnings = doubts().into_iter().chain(found.warnings).collect();
    Ok(ModesResult { warnings, ..found })
}

fn modes_of(case: &Case, question: &ModesQuestion) -> Result<ModesResult, SimError> {
    let fail = |source: FemError| SimError::Blade { place: Place::file("modes"), source };
    let blade = case.blade_with_flaps()?.with_pitch_rad(question.pitch_rad).map_err(fail)?;
    let at = |ratio: f64| modes_at(case, question, &blade, ratio).map_err(fail);
    let fan = question.speed_ratios.iter().map(|ratio| at(*ratio)).collect::<Result<_, _>>()?;
    let nominal = at(1.0)?;
    let warnings = undamped_at_a_harmonic(case, &nominal.modes);
    Ok(ModesResult { warnings, fan, ..nominal })
}

/// Lag modes at a harmonic of the rotor speed that nothing damps.
fn undamped_at_a_harmonic(case: &Case, modes: &[ModeLine]) -> Vec<String> {
    if case.blade.modal_damping > 0.0 {
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
    let nominal_rad_s = case.scales.omega_rad_s();
    let (elements, count) = (case.blade.elements, case.mode_count());
    let blade = blade.with_rotor_speed(ratio)?;
    let (found, steady_tip) = match question.about {
        AboutState::Undeformed => {
            (modes(&BladeModel::new(blade, elements)?, question.terms, count)?, None)
        }
        AboutState::Deflected => {
            let spec = ModerateSpec {
                mass_centre: case.blade.mass_centre.into(),
                tension_centre: case.blade.tension_centre.into(),
                torsion: case.torsion_terms(),
                ..ModerateSpec::from(blade.spec().clone())
            };
            let model = ModerateModel::new(ModerateBlade::new(spec)?, elements)?;
            let none = DVector::zeros(model.size());
            let state = model.static_state(&none, &StaticSettings::default())?;
            let tip = model.section(&state.dof, 1.0)?;
            let found = deflected_modes(&model, &state, question.terms, AxialMotion::Free, count)?;
            (found, Some(tip.into()))
        }
    };
    Ok(ModesResult {
        rotor_speed_rad_s: ratio * nominal_rad_s,
        steady_tip,
        modes: found.iter().map(|mode| ModeLine::new(mode, nominal_rad_s)).collect(),
        warnings: vec![],
        fan: vec![],
    })
}

impl ModeLine {
    fn new(mode: &CoupledMode, nominal_rad_s: f64) -> Self {
        let EnergyShares { flap, lag, torsion, axial } = mode.energy;
        Self {
            kind: mode.kind.to_string(),
            per_rev: mode.per_rev.is_finite().then_some(mode.per_rev),
            hz: mode.frequency * nominal_rad_s / std::f64::consts::TAU,
            energy: [flap, lag, torsion, axial],
        }
    }
}

impl From<SectionMotion> for SteadyTip {
    fn from(tip: SectionMotion) -> Self {
        Self { lag_r: tip.lag[0], flap_r: tip.flap[0], twist_deg: tip.twist[0].to_degrees() }
    }
}

/// The fan plot as a table: one row for each mode at each rotor speed.
pub fn fan_csv(result: &ModesResult) -> String {
    let mut text = String::from(
        "rotor_speed_rad_s,mode,frequency_hz,per_rev,flap_share,lag_share,torsion_share,axial_share\n",
    );
    for point in &result.fan {
        for (name, mode) in numbered(&point.modes).zip(&point.modes) {
            let per_rev = mode.per_rev.map_or_else(String::new, |p| format!("{p:.9}"));
            let [flap, lag, torsion, axial] = mode.energy;
            // writing to a string cannot fail
            let _ = writeln!(
                text,
                "{},{name},{:.9},{per_rev},{flap:.6},{lag:.6},{torsion:.6},{axial:.6}",
                point.rotor_speed_rad_s, mode.hz
            );
        }
    }
    text
}

impl Printable for ModesResult {
    fn text(&self) -> String {
        let mut sheet = Sheet::default();
        sheet.line(format_args!("Rotor speed {:.4} rad/s", self.rotor_speed_rad_s));
        if let Some(tip) = self.steady_tip {
            sheet.line(format_args!(
                "Steady tip: lag {:.5} R, flap {:.5} R, twist {:.3} deg",
                tip.lag_r, tip.flap_r, tip.twist_deg
            ));
        }
        sheet.block(&table(
            &["mode", "per rev", "Hz", "flap %", "lag %", "torsion %"],
            numbered(&self.modes).zip(&self.modes).map(|(name, mode)| {
                let per_rev = mode.per_rev.map_or_else(|| "-".to_owned(), |p| format!("{p:.6}"));
                let shares = mode.energy.iter().take(3).map(|e| format!("{:.1}", 100.0 * e));
                [name, per_rev, format!("{:.4}", mode.hz)].into_iter().chain(shares).collect()
            }),
        ));
        for warning in &self.warnings {
            sheet.line(format_args!("warning: {warning}"));
        }
        if !self.fan.is_empty() {
            sheet.line(format_args!("\nFrequencies in Hz over rotor speed"));
            let names: Vec<String> = numbered(&self.modes).collect();
            let mut header = vec!["rad/s"];
            header.extend(names.iter().map(String::as_str));
            sheet.block(&table(
                &header,
                self.fan.iter().map(|point| {
                    std::iter::once(format!("{:.4}", point.rotor_speed_rad_s))
                        .chain(point.modes.iter().map(|m| format!("{:.3}", m.hz)))
                        .collect()
                }),
            ));
        }
        sheet.finish()
    }
}

/// `flap 1`, `flap 2`, ... `lag 1`, ...
fn numbered(modes: &[ModeLine]) -> impl Iterator<Item = String> {
    modes.iter().enumerate().map(|(i, mode)| {
        let before = modes[..i].iter().filter(|m| m.kind == mode.kind).count();
        format!("{} {}", mode.kind, before + 1)
    })
}
