//! What a report shows: plain numbers and words.

use super::{Assumption, Finding};
use crate::identification::fit_table;
use crate::output::table;
use crate::results::{LoopRecord, Residuals, TrimLine};
use crate::stored_actuator::StoredFit;
use rotor_study::{MeanLoads, StabilityLine};

/// Everything a report shows.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StudyReport {
    /// Title of the page.
    pub title: String,
    /// Program and version.
    pub program: String,
    /// blake3 of version, case and data.
    pub key: String,
    /// What was run, a sentence each: rotor, inflow, sections, bench mapping.
    pub setting: Vec<String>,
    /// Everything the case says, with units.
    pub assumptions: Vec<Assumption>,
    /// The six loads before and after, one panel a set of harmonics.
    pub finding: Finding,
    /// What a reader should know before using the numbers.
    pub warnings: Vec<String>,
    /// Title of the bench data, which says whether they are synthetic.
    pub data_title: String,
    /// Our numbers beside the paper's.
    pub headline: Vec<HeadlineRow>,
    /// The trim.
    pub trim: TrimLine,
    /// Mean loads on the hub and the power of the shaft.
    pub mean_loads: Option<MeanLoads>,
    /// The three residuals.
    pub residuals: Residuals,
    /// Stability of the trimmed blade.
    pub stability: StabilityLine,
    /// Fit of every bench run.
    pub fits: Vec<StoredFit>,
    /// Measured and simulated loops.
    pub loops: Vec<LoopRecord>,
    /// Flap and voltage against azimuth.
    pub azimuth: Vec<AzimuthChart>,
    /// Hub loads before and after.
    pub loads: Vec<LoadBars>,
    /// Further tables, such as sensitivities.
    pub sections: Vec<ResultSection>,
}

/// One line of the comparison with the paper.
#[derive(Debug, Clone, PartialEq)]
pub struct HeadlineRow {
    /// The quantity, with its unit.
    pub quantity: String,
    /// The paper's number, as it prints it.
    pub paper: String,
    /// Ours, as `(actuator, number)`.
    pub ours: Vec<(String, String)>,
}

/// Voltage and flap angle over one revolution.
#[derive(Debug, Clone, PartialEq)]
pub struct AzimuthChart {
    /// Set of harmonics and actuator, such as `3/rev, hysteretic`.
    pub title: String,
    /// Azimuth, deg.
    pub azimuth_deg: Vec<f64>,
    /// One per flap.
    pub flaps: Vec<FlapTrace>,
}

/// One flap over one revolution.
#[derive(Debug, Clone, PartialEq)]
pub struct FlapTrace {
    /// Name, such as `inboard`.
    pub name: String,
    /// Voltage, V, bias included.
    pub voltage_volt: Vec<f64>,
    /// Flap angle, deg, trailing edge down positive.
    pub flap_deg: Vec<f64>,
}

/// The six hub loads of one set of harmonics without control and with each actuator.
#[derive(Debug, Clone, PartialEq)]
pub struct LoadBars {
    /// Set of harmonics, such as `3/rev`.
    pub title: String,
    /// Amplitudes without control, in the order of `HubLoads::NAMES`, nondimensional.
    pub before: [f64; 6],
    /// Amplitudes with each actuator, and the reduction of `J_Z` in percent.
    pub after: Vec<(String, [f64; 6], f64)>,
}

/// A further table.
#[derive(Debug, Clone, PartialEq)]
pub struct ResultSection {
    /// Heading.
    pub title: String,
    /// A sentence or two.
    pub text: String,
    /// Column heads.
    pub header: Vec<String>,
    /// Rows.
    pub rows: Vec<Vec<String>>,
}

impl StudyReport {
    /// The bench fits, the comparison with the paper and the further tables, for the terminal.
    pub fn text(&self) -> String {
        let mut text = String::new();
        if !self.fits.is_empty() {
            text += &["\nActuator: ", &self.data_title, "\n"].concat();
            text += &fit_table(self.fits.iter(), "V");
        }
        let mut actuators: Vec<&str> = Vec::new();
        for (actuator, _) in self.headline.iter().flat_map(|row| &row.ours) {
            if !actuators.contains(&actuator.as_str()) {
                actuators.push(actuator);
            }
        }
        let rows: Vec<&HeadlineRow> = self.headline.iter().filter(|r| !r.ours.is_empty()).collect();
        if !rows.is_empty() {
            let header: Vec<&str> =
                ["quantity", "paper"].into_iter().chain(actuators.iter().copied()).collect();
            text +=
                "\nBeside the paper (its numbers are for feedback on the hysteretic actuator)\n";
            text += &table(
                &header,
                rows.into_iter().map(|row| {
                    let ours = actuators.iter().map(|wanted| {
                        let found = row.ours.iter().find(|(actuator, _)| actuator == wanted);
                        found.map_or_else(String::new, |(_, number)| number.clone())
                    });
                    [row.quantity.clone(), row.paper.clone()].into_iter().chain(ours).collect()
                }),
            );
            text += "\nReduction counts J_Z alone. The hysteretic actuator can beat the ideal one at the same stroke: its flap\nmotion holds harmonics of its own, and they shake the hub too.\n";
        }
        for section in &self.sections {
            let header: Vec<&str> = section.header.iter().map(String::as_str).collect();
            text.push_str(&["\n", &section.title, ". ", &section.text, "\n"].concat());
            text += &table(&header, section.rows.iter().cloned());
        }
        text
    }
}
