//! Static curves of a section.

use super::{SectionChoice, SectionTable, stall_remark, within, within_points};
use flap_aero::{AeroError, C81Airfoil, StallAirfoil, StallSection, steady_response};
use std::f64::consts::TAU;

/// A static curve over incidence.
#[derive(Debug, Clone, PartialEq)]
pub struct PolarQuestion {
    /// The section; of a table the Mach number alone counts.
    pub section: SectionChoice,
    /// First and last incidence, rad.
    pub incidences_rad: [f64; 2],
    /// Number of rows after the first.
    pub points: usize,
    /// How the section stalls; `None` is linear.
    pub stall: Option<StallAirfoil>,
    /// A table that takes the place of the model.
    pub table: Option<C81Airfoil>,
}

/// The curve.
///
/// # Errors
/// [`AeroError`] of a number outside its range.
pub fn polar(question: &PolarQuestion) -> Result<SectionTable, AeroError> {
    let [from, to] = question.incidences_rad;
    for (quantity, incidence) in [("first incidence, deg", from), ("last incidence, deg", to)] {
        within(quantity, incidence.to_degrees(), incidence.abs() <= TAU, "-360 to 360")?;
    }
    within("range of incidences, deg", (to - from).to_degrees(), to > from, "above 0")?;
    let points = question.points;
    within_points(points)?;
    let incidences = (0..=points).map(|n| from + (to - from) * n as f64 / points as f64);
    let mach = question.section.mach;
    if let Some(airfoil) = &question.table {
        within("Mach number", mach, mach >= 0.0, "a finite number, 0 or more")?;
        let rows = incidences.map(|a| {
            let point = airfoil.at(a, mach).value;
            vec![a.to_degrees(), point.lift, point.drag, point.moment]
        });
        return Ok(SectionTable {
            title: format!("{}, Mach {mach}", airfoil.name),
            columns: vec!["incidence_deg", "cl", "cd", "cm"],
            rows: rows.collect(),
            remarks: table_remarks(airfoil, [from, to].map(f64::to_degrees), mach),
        });
    }
    let (section, mach, flap) = question.section.coefficients()?;
    let mut remarks = question.section.remarks_at_rest(&section.remarks);
    remarks.extend(question.stall.and_then(|airfoil| stall_remark(airfoil, mach.value())));
    let stalling = match question.stall {
        Some(airfoil) => Some((airfoil, StallSection::new(mach, flap, airfoil.parameters(mach))?)),
        None => None,
    };
    let rows = incidences.map(|a| {
        let zero_lift = stalling.map_or(0.0, |(airfoil, _)| airfoil.zero_lift_rad());
        let modes = [a - zero_lift, 0.0, 0.0, 0.0];
        let [cn, cm, ch] = steady_response(&section, &modes);
        let Some((airfoil, stalling)) = &stalling else { return vec![a.to_degrees(), cn, cm, ch] };
        let l = stalling.settled([cn, cm, ch], &modes);
        let (drag, moment) = (l.pressure_drag(a), l.moment + airfoil.zero_lift_moment());
        vec![a.to_degrees(), l.normal, moment, l.hinge, l.chord, drag, l.separation]
    });
    let rows = rows.collect();
    let mut columns = vec!["incidence_deg", "cn", "cm", "ch"];
    let mut flow = "attached flow";
    if stalling.is_some() {
        columns.extend(["cc", "cd_pressure", "f"]);
        flow = "static stall";
    }
    let title = format!("{}, Mach {}, {flow}", question.section.model.name(), mach.value());
    Ok(SectionTable { title, remarks, columns, rows })
}

/// What of a table's answers is held at its ends, and what cannot be true in it.
fn table_remarks(airfoil: &C81Airfoil, [from, to]: [f64; 2], mach: f64) -> Vec<String> {
    let mut remarks = Vec::new();
    let tables = [("lift", &airfoil.lift), ("drag", &airfoil.drag), ("moment", &airfoil.moment)];
    // a whole turn repeats
    let round = from < -180.0 || to > 180.0;
    let [low, high] = if round { [-180.0, 180.0] } else { [from, to] };
    let held = |name: &str, axis: &[f64], [low, high]: [f64; 2], [of, unit]: [&str; 2]| {
        let (first, last) = (axis[0], axis[axis.len() - 1]);
        (low < first || high > last).then(|| {
            format!(
                "the {name} table is for {of}{first} to {last}{unit}: beyond, its end values are held"
            )
        })
    };
    for (name, table) in tables {
        remarks.extend(held(name, table.machs(), [mach, mach], ["Mach ", ""]));
        remarks.extend(held(name, table.incidences_deg(), [low, high], ["", " deg"]));
    }
    if let Some([incidence, mach, drag]) = airfoil.negative_drag() {
        remarks.push(format!(
            "the drag table has a negative drag, {drag} at {incidence} deg and Mach {mach}: no section has"
        ));
    }
    remarks
}
