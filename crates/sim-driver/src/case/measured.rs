//! The measured files a case names.

use super::MeasuredFiles;
use crate::files::{ColumnTable, Folder, RonIndex, missing_file, parse_columns};
use crate::problem::{Fault, Problem, Problems};
use rotor_base::{Harmonic, HarmonicSeries};
use rotor_study::{
    CURVE_AZIMUTHS, MeasuredCurve, MeasuredData, Quantity, VortexCentre, resolved_harmonics,
};

/// What the measured files of a case hold.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct MeasuredRotor {
    /// Airloads of sections and motions of the tip.
    pub curves: Vec<MeasuredCurve>,
    /// Centres of tip vortices.
    pub vortex_centres: Vec<VortexCentre>,
    /// blake3 of every file, for the key of the result.
    pub inputs: Vec<String>,
    /// Files that are not inside the program, though the case is.
    pub notes: Vec<String>,
}

/// Columns of azimuth and harmonic number.
const AZIMUTH: &str = "azimuth_deg";
const PER_REV: &str = "per_rev";
/// Another name of the tip deflection.
const OTHER_NAME: (&str, Quantity) = ("tip_deflection_percent_r", Quantity::TipFlap);
/// Columns of vortex centres.
const CENTRE: [&str; 3] = ["x_m", "y_m", "z_m"];
/// Their names in the tables of the HART II workshop, and columns there that say where a centre was looked for.
const WORKSHOP_CENTRE: [&str; 3] = ["x_hub_m", "y_hub_m", "z_hub_m"];
const WORKSHOP_PLACE: [&str; 3] = ["data_point", "piv_location", "plane_y_r"];
/// Fewest harmonics that samples must resolve: with fewer, half of the revolution is not seen.
const LEAST_HARMONICS: usize = 2;

/// A file that a case names.
struct Named<'a> {
    field: String,
    file: &'a str,
    case: Option<&'a str>,
}

impl Named<'_> {
    /// File and rows, for people.
    fn source(&self) -> String {
        self.case.map_or_else(|| self.file.to_owned(), |case| format!("{}, {case}", self.file))
    }
}

/// Reads the measured files of a case; lengths in a table in m come back over the radius.
///
/// # Errors
/// Every file that is not there and every fault in one, each with its place.
pub(super) fn read_measured(
    named: &MeasuredFiles,
    radius_m: f64,
    folder: &Folder,
    index: &RonIndex,
) -> Result<MeasuredRotor, Problems> {
    let mut found = MeasuredRotor::default();
    let mut problems = Problems::default();
    let mut note = |read: Result<(), Problems>| {
        if let Err(more) = read {
            problems.append(more);
        }
    };
    let place = |list: &str, i: usize| format!("measured.{list}[{i}].file");
    for (i, of) in named.airloads.iter().enumerate() {
        let field = place("airloads", i);
        let named = Named { field, file: &of.file, case: of.case.as_deref() };
        note(found.add_curves(&named, Some(of.station_r), (folder, index)));
    }
    for (i, of) in named.tip.iter().enumerate() {
        let named = Named { field: place("tip", i), file: &of.file, case: of.case.as_deref() };
        note(found.add_curves(&named, None, (folder, index)));
    }
    for (i, of) in named.vortex_centres.iter().enumerate() {
        let field = place("vortex_centres", i);
        let named = Named { field, file: &of.file, case: of.case.as_deref() };
        note(found.add_centres(&named, radius_m, (folder, index)));
    }
    problems.into_result(Some(found))
}

impl MeasuredRotor {
    /// The table of a file; none of one that is not inside the program.
    fn table(
        &mut self,
        named: &Named<'_>,
        known: &[&str],
        (folder, index): (&Folder, &RonIndex),
    ) -> Result<Option<ColumnTable>, Problems> {
        // an empty name is a fault of the values
        if named.file.trim().is_empty() {
            return Ok(None);
        }
        if !folder.contains(named.file) {
            let place = index.place(&named.field);
            if matches!(folder, Folder::Embedded(_)) {
                let message = format!(
                    "{} is not inside the program: nothing measured is shown; run the case from its file in fixtures/cases",
                    named.file
                );
                self.notes.push(Problem::new(place, Fault::Other(message)).to_string());
                return Ok(None);
            }
            return Err(Problem::new(place, missing_file(folder, named.file)).into());
        }
        let source = folder.read(named.file)?;
        let table = parse_columns(&source, named.case, known)?;
        self.inputs.push(blake3::hash(source.text.as_bytes()).to_hex().to_string());
        Ok(Some(table))
    }

    fn add_curves(
        &mut self,
        named: &Named<'_>,
        station_r: Option<f64>,
        at: (&Folder, &RonIndex),
    ) -> Result<(), Problems> {
        let quantities: &[Quantity] =
            if station_r.is_some() { &Quantity::OF_SECTION } else { &Quantity::OF_TIP };
        let names: Vec<(String, Quantity)> = quantities
            .iter()
            .map(|quantity| (quantity.name().to_owned(), *quantity))
            .chain(station_r.is_none().then(|| (OTHER_NAME.0.to_owned(), OTHER_NAME.1)))
            .collect();
        let parts = names.iter().map(|(name, _)| name);
        let parts: Vec<String> =
            parts.flat_map(|name| ["", "_cos", "_sin"].map(|end| format!("{name}{end}"))).collect();
        let known = [AZIMUTH, PER_REV].into_iter().chain(parts.iter().map(String::as_str));
        let Some(table) = self.table(named, &known.collect::<Vec<_>>(), at)? else {
            return Ok(());
        };
        let before = self.curves.len();
        for (name, quantity) in &names {
            if let Some(measured) = values_of(&table, name)? {
                let (quantity, source) = (*quantity, named.source());
                self.curves.push(MeasuredCurve { quantity, station_r, source, measured });
            }
        }
        if self.curves.len() == before {
            let end = if table.get(PER_REV).is_some() { "_cos" } else { "" };
            let wanted = names.iter().map(|(name, _)| format!("{name}{end}"));
            let wanted = wanted.collect::<Vec<_>>().join("` or `");
            return Err(table.missing(&wanted, "give at least one of them").into());
        }
        Ok(())
    }

    fn add_centres(
        &mut self,
        named: &Named<'_>,
        radius_m: f64,
        at: (&Folder, &RonIndex),
    ) -> Result<(), Problems> {
        let known = [&[AZIMUTH], &CENTRE[..], &WORKSHOP_CENTRE, &WORKSHOP_PLACE].concat();
        let Some(table) = self.table(named, &known, at)? else { return Ok(()) };
        let remedy = "centres need azimuth_deg, x_m, y_m and z_m, hub axes: aft, starboard, up";
        let azimuths = table.column(AZIMUTH, remedy)?;
        let is_workshop = table.get(WORKSHOP_CENTRE[0]).is_some();
        let [x, y, z] = if is_workshop { WORKSHOP_CENTRE } else { CENTRE };
        let [x, y, z] =
            [table.column(x, remedy)?, table.column(y, remedy)?, table.column(z, remedy)?];
        let centres = (0..azimuths.len()).map(|i| VortexCentre {
            azimuth_deg: azimuths[i],
            place_r: [x[i], y[i], z[i]].map(|length_m| length_m / radius_m),
        });
        self.vortex_centres.extend(centres);
        Ok(())
    }
}

/// What a table holds of a quantity: harmonics where it has a column of their numbers, else values against azimuth.
fn values_of(table: &ColumnTable, name: &str) -> Result<Option<MeasuredData>, Problem> {
    if let Some(per_rev) = table.get(PER_REV) {
        let [cosine, sine] = ["_cos", "_sin"].map(|end| format!("{name}{end}"));
        if table.get(&cosine).is_none() && table.get(&sine).is_none() {
            return Ok(None);
        }
        let remedy = "a harmonic has a cosine and a sine part";
        let (cosines, sines) = (table.column(&cosine, remedy)?, table.column(&sine, remedy)?);
        let mut series = HarmonicSeries::default();
        for n in 0..per_rev.len() {
            let row = per_rev.iter().position(|own| (own - n as f64).abs() < 1e-9);
            match row {
                Some(row) if n == 0 => series.mean = cosines[row],
                Some(row) if 2 * n < CURVE_AZIMUTHS => {
                    series.set_harmonic(n, Harmonic { cosine: cosines[row], sine: sines[row] });
                }
                _ => {
                    let message = format!(
                        "the row of {n}/rev is missing among {} rows, expected 0 (the mean), 1, 2, ... each once, below {}; give a mean that was removed as 0",
                        per_rev.len(),
                        CURVE_AZIMUTHS / 2
                    );
                    return Err(Problem::new(table.place(n, PER_REV), Fault::Other(message)));
                }
            }
        }
        return Ok(Some(MeasuredData::Harmonics(series)));
    }
    let remedy = "give azimuth_deg with values, or per_rev with the parts _cos and _sin";
    let azimuth_deg = table.column(AZIMUTH, remedy)?;
    let Some(values) = table.get(name) else { return Ok(None) };
    for (row, &value) in azimuth_deg.iter().enumerate() {
        if !(-360.0..=720.0).contains(&value) {
            let (low, high, remedy) = (-360.0, 720.0, "0 is over the tail");
            let fault = Fault::OutOfRange { value, low, high, unit: "deg", remedy };
            return Err(Problem::new(table.place(row, AZIMUTH), fault));
        }
    }
    if resolved_harmonics(azimuth_deg) < LEAST_HARMONICS {
        let message = format!(
            "{} azimuths do not resolve {LEAST_HARMONICS}/rev, expected at least 9 in deg with no gap beyond 180 deg; give the whole revolution",
            azimuth_deg.len()
        );
        return Err(Problem::new(table.place(0, AZIMUTH), Fault::Other(message)));
    }
    let azimuth_deg = azimuth_deg.iter().map(|psi| psi.rem_euclid(360.0)).collect();
    let values = values.to_vec();
    Ok(Some(MeasuredData::Samples { azimuth_deg, values }))
}
