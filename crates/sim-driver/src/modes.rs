//! `hhc modes`: rotating frequencies and the data of a fan plot.

use crate::SimError;
use crate::case::Case;
use crate::output::{Printable, Sheet, table};
use crate::problem::Place;
use rotor_fem::{BladeModel, CoupledMode, FemError, GyroscopicTerms, fan_plot, modes};
use serde::Serialize;

/// One mode as it is printed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModeLine {
    /// `flap`, `lag` or `torsion`.
    pub kind: String,
    /// Frequency per revolution of the rotor's own speed; none at rest.
    pub per_rev: Option<f64>,
    /// Frequency, Hz.
    pub hz: f64,
}

/// The modes at one rotor speed.
#[derive(Debug, Clone, PartialEq, Serialize)]
pub struct ModesResult {
    /// Rotor speed, rad/s.
    pub rotor_speed_rad_s: f64,
    /// Flap, lag and torsion modes, each kind from its lowest.
    pub modes: Vec<ModeLine>,
    /// The same at further rotor speeds: the data of a fan plot.
    #[serde(skip_serializing_if = "Vec::is_empty")]
    pub fan: Vec<ModesResult>,
}

/// Rotating modes of a case's blade, twist included, at a pitch angle (rad, at 0.75 R) and at further
/// rotor speeds over the nominal one.
///
/// # Errors
/// [`SimError::Blade`].
pub fn rotating_modes(
    case: &Case,
    terms: GyroscopicTerms,
    pitch_rad: f64,
    speed_ratios: &[f64],
) -> Result<ModesResult, SimError> {
    let fail = |source: FemError| SimError::Blade { place: Place::file("modes"), source };
    let blade = case.blade_properties()?.with_pitch_rad(pitch_rad).map_err(fail)?;
    let nominal_rad_s = case.scales.omega_rad_s();
    let lines = |found: &[CoupledMode]| {
        found
            .iter()
            .map(|mode| ModeLine {
                kind: mode.kind.to_string(),
                per_rev: mode.per_rev.is_finite().then_some(mode.per_rev),
                hz: mode.frequency * nominal_rad_s / std::f64::consts::TAU,
            })
            .collect()
    };
    let fan = fan_plot(&blade, case.blade.elements, speed_ratios, terms, case.mode_count())
        .map_err(fail)?
        .iter()
        .map(|point| ModesResult {
            rotor_speed_rad_s: point.rotor_speed * nominal_rad_s,
            modes: lines(&point.modes),
            fan: vec![],
        })
        .collect();
    let model = BladeModel::new(blade, case.blade.elements).map_err(fail)?;
    let nominal = modes(&model, terms, case.mode_count()).map_err(fail)?;
    Ok(ModesResult { rotor_speed_rad_s: nominal_rad_s, modes: lines(&nominal), fan })
}

impl Printable for ModesResult {
    fn text(&self) -> String {
        let mut sheet = Sheet::default();
        sheet.line(format_args!("Rotor speed {:.4} rad/s", self.rotor_speed_rad_s));
        sheet.block(&table(
            &["mode", "per rev", "Hz"],
            numbered(&self.modes).zip(&self.modes).map(|(name, mode)| {
                let per_rev = mode.per_rev.map_or_else(|| "-".to_owned(), |p| format!("{p:.6}"));
                vec![name, per_rev, format!("{:.4}", mode.hz)]
            }),
        ));
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
