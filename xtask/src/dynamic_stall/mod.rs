//! Dynamic stall against measured loops: errors of the stored constants, and the fit that they come from.
//!
//! The loops are not part of the project; their folder is given.

pub mod cycle;
pub mod fit;
pub mod loops;
mod page;

use crate::XtaskError;
use cycle::{Cycle, Errors, Stalling};
use fit::Shape;
use flap_aero::{Mach, StallAirfoil};
use loops::MeasuredLoop;
use rayon::prelude::*;
use std::fmt::Write as _;
use std::path::Path;

/// The page, from the root.
pub const PAGE: &str = "docs/src/dynamic-stall.md";

/// Parts of a cross-validation: every so many loops of an aerofoil one belongs to the same part.
const PARTS: usize = 4;

/// The aerofoils with measured loops, and what was fitted of each.
const AIRFOILS: [(StallAirfoil, &str, Shape); 3] = [
    (
        StallAirfoil::Naca0012Measured,
        "NACA 0012",
        Shape { machs: &[0.036, 0.11, 0.185, 0.3], cambered: false },
    ),
    (StallAirfoil::Ames01, "AMES-01", Shape { machs: &[0.185, 0.3], cambered: false }),
    (StallAirfoil::Naca23012a, "NACA 23012A", Shape { machs: &[0.117], cambered: true }),
];

/// A loop and how far constants are off it.
struct Judged {
    measured: MeasuredLoop,
    errors: Errors,
}

/// The loops of an aerofoil.
fn of_airfoil(all: &[MeasuredLoop], airfoil: StallAirfoil) -> Vec<&MeasuredLoop> {
    all.iter().filter(|measured| measured.airfoil == airfoil).collect()
}

fn judged(
    loops: &[&MeasuredLoop],
    stalling: impl Fn(&MeasuredLoop) -> Result<Stalling, XtaskError> + Sync,
) -> Result<Vec<Judged>, XtaskError> {
    let judge = |measured: &&MeasuredLoop| {
        let cycle = Cycle::of(measured, &stalling(measured)?).map_err(study)?;
        let errors = Errors::of(measured, &cycle);
        Ok(Judged { measured: (*measured).clone(), errors })
    };
    loops.par_iter().map(judge).collect()
}

/// Every loop judged by constants fitted to the other parts.
fn cross_validated(loops: &[&MeasuredLoop], shape: Shape) -> Result<Vec<Judged>, XtaskError> {
    let mut found = Vec::new();
    for part in 0..PARTS.min(loops.len()) {
        let of = |inside: bool| {
            let picked = loops.iter().enumerate().filter(|(n, _)| (n % PARTS == part) == inside);
            picked.map(|(_, measured)| *measured).collect::<Vec<_>>()
        };
        let (values, _) = fit::fit(&of(false), shape);
        found.extend(judged(&of(true), |measured| Ok(shape.stalling(&values, measured.mach)))?);
    }
    Ok(found)
}

fn study(error: impl std::fmt::Display) -> XtaskError {
    XtaskError::Study(error.to_string())
}

/// The constants that the program has.
fn stored(measured: &MeasuredLoop, airfoil: StallAirfoil) -> Result<Stalling, XtaskError> {
    let mach = Mach::new(measured.mach).map_err(study)?;
    Ok(Stalling {
        parameters: airfoil.parameters(mach),
        zero_lift_rad: airfoil.zero_lift_rad(),
        zero_lift_moment: airfoil.zero_lift_moment(),
    })
}

/// What is known of an aerofoil.
struct OfAirfoil {
    airfoil: StallAirfoil,
    name: &'static str,
    /// Errors of the stored constants, of the published ones of the NACA 0012, and of fits that have not seen the loop.
    stored: Vec<Judged>,
    published: Vec<Judged>,
    unseen: Vec<Judged>,
}

/// The page on the loops of a folder.
///
/// # Errors
/// Those of reading, and of a section.
pub fn page(folder: &Path) -> Result<String, XtaskError> {
    let all = loops::read(folder)?;
    let mut found = Vec::new();
    for (airfoil, name, shape) in AIRFOILS {
        let of = of_airfoil(&all, airfoil);
        if of.is_empty() {
            continue;
        }
        found.push(OfAirfoil {
            airfoil,
            name,
            stored: judged(&of, |measured| stored(measured, airfoil))?,
            published: judged(&of, |measured| stored(measured, StallAirfoil::Naca0012))?,
            unseen: cross_validated(&of, shape)?,
        });
    }
    Ok(page::page(&found))
}

/// What a fit to the loops of a folder gives, as text; nothing is written.
///
/// # Errors
/// Those of reading, and of a section.
pub fn fitted(folder: &Path) -> Result<String, XtaskError> {
    let all = loops::read(folder)?;
    let mut text = String::new();
    for (airfoil, name, shape) in AIRFOILS {
        let of = of_airfoil(&all, airfoil);
        if of.is_empty() {
            continue;
        }
        let (values, squares) = fit::fit(&of, shape);
        let count = shape.machs.len();
        let _ = writeln!(text, "{name}: {} loops, sum of squares a loop {squares:.3}", of.len());
        let _ = writeln!(text, "  Mach {:?}", shape.machs);
        let _ = writeln!(text, "  alpha1, deg {:.2?}", &values[..count]);
        let _ = writeln!(text, "  Cn1 {:.3?}", &values[count..2 * count]);
        for ((name, _), value) in fit::SAME.iter().zip(&values[2 * count..]) {
            let _ = writeln!(text, "  {name} {value:.4}");
        }
        if let [zero_lift_deg, moment] = values[2 * count + fit::SAME.len()..] {
            let _ =
                writeln!(text, "  zero lift at {zero_lift_deg:.3} deg, moment there {moment:.4}");
        }
    }
    Ok(text)
}
