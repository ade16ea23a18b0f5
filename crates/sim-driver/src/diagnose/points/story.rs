//! What the terminal and the files say of points of test.

use crate::SimError;
use crate::diagnose::PAGE_FILE;
use crate::diagnose::story::{common_words, one_of, screening, sure, told, valued};
use crate::files::significant;
use crate::output::{Printable, Sheet, json, table_of, unique};
use crate::problem::Place;
use bench_study::BenchError;
use diagnosis_page::{Words, points_page};
use model_gap::discovery::{Compared, Found, Verdict};
use model_gap::points::{ChannelGain, PointFinding, PointTable};
use model_gap::{Findings, GapError, places};
use serde::Serialize;

/// Rows of a table on the first screen.
const SHOWN: usize = 6;
/// Rejected rivals that are told, the nearest first.
const REJECTED: usize = 4;

/// Points of test with what was found of them.
#[derive(Debug, Clone)]
pub struct PointDiagnosis {
    /// One line about the data.
    pub title: String,
    /// Kind of the data.
    pub data_kind: &'static str,
    /// The points with the simulation.
    pub table: PointTable,
    /// What was found.
    pub found: PointFinding,
    /// What it means besides, in sentences.
    pub besides: Vec<String>,
    /// What a reader should know of the inputs and models that it rests on.
    pub notes: Vec<String>,
}

impl PointDiagnosis {
    /// Finds what the simulation of a table lacks; with `only`, fits these suspects and refuses nothing.
    ///
    /// # Errors
    /// [`BenchError::Diagnosis`] at the place of the data.
    pub fn of(
        (title, folder): (String, &str),
        data_kind: &'static str,
        table: PointTable,
        only: &[String],
    ) -> Result<Self, SimError> {
        let at = |source: GapError| BenchError::Diagnosis {
            place: Place::file(folder),
            source: source.into(),
        };
        let ids: Vec<&str> = table.suspects.iter().map(|own| own.name).collect();
        let found = match &places(&ids, only).map_err(at)?[..] {
            [] => table.find(),
            given => table.refit(given),
        };
        Ok(Self {
            title,
            data_kind,
            found: found.map_err(at)?,
            table,
            besides: vec![],
            notes: vec![],
        })
    }

    fn id(&self, candidate: usize) -> &'static str {
        self.found.candidates[candidate].id
    }

    /// The findings, as other programs read them.
    pub fn findings(&self) -> Findings {
        self.found.findings(&self.table, self.data_kind)
    }

    /// Files to write: findings, the readings with what is simulated before and after, and the page of both.
    ///
    /// # Errors
    /// [`SimError::Data`] if JSON cannot express the findings.
    pub fn files(&self) -> Result<Vec<(String, String)>, SimError> {
        let findings = self.findings();
        let page = points_page(&self.table, &self.found, &findings, &self.words(&findings));
        let files = [
            ("findings.json", json(&findings)?),
            ("residuals.csv", self.found.residuals_csv(&self.table)),
            (PAGE_FILE, page),
        ];
        Ok(files.map(|(name, text)| (name.to_owned(), text)).into())
    }

    /// What is said of it.
    fn words(&self, findings: &Findings) -> Words {
        let found = &self.found;
        Words {
            title: self.title.clone(),
            verdict: self.verdict(),
            why: told(&|sheet| {
                self.causes(sheet);
                seen(findings, sheet);
                for own in &self.besides {
                    sheet.line(format_args!("  {own}"));
                }
            }),
            next: told(&|sheet| self.next(sheet)),
            ground: told(&|sheet| self.ground(sheet)),
            notes: self.notes.clone(),
            ..common_words(findings, (&found.candidates, &found.finding.screen))
        }
    }

    /// The verdict in words.
    fn verdict(&self) -> String {
        let finding = &self.found.finding;
        let how = sure(finding.confidence);
        let names: Vec<&str> = finding.causes.iter().map(|own| self.id(own.candidate)).collect();
        let names = names.join(" + ");
        match finding.verdict {
            Verdict::NothingMissing => {
                format!(
                    "Nothing is missing ({how}): the misfit is what readings and simulation are stated to be off by."
                )
            }
            Verdict::Named => format!("Missing ({how}): {names}."),
            Verdict::NamedStructureRemains => {
                format!("Missing ({how}): {names}; structure remains that it does not explain.")
            }
            Verdict::Ambiguous => {
                let one = |found: &Found| {
                    let mut ids = vec![self.id(found.candidate)];
                    ids.extend(found.alternatives.iter().map(|other| self.id(other.candidate)));
                    let ids = unique(ids);
                    one_of(&ids)
                };
                let sets: Vec<String> = finding.causes.iter().map(one).collect();
                format!("Missing: {}; these points do not distinguish them.", sets.join(" + "))
            }
            Verdict::Unknown => {
                "Something is missing, and no suspect explains it: no name is given.".to_owned()
            }
            Verdict::NotObservable => "These points cannot show what could be missing.".to_owned(),
        }
    }

    /// The causes with their parameters, and why the verdict is what it is.
    fn causes(&self, sheet: &mut Sheet) {
        for found in &self.found.finding.causes {
            let cause = &self.found.candidates[found.candidate];
            sheet.line(format_args!("  {}: {}", cause.id, cause.physics));
            for own in found.parameters.iter().filter(|own| !own.is_shape) {
                sheet.line(format_args!("    {}", valued(own.name, own.value, own.unit, own.ci95)));
            }
            for other in found.compared.iter().filter(|other| other.is_as_likely()) {
                sheet.line(format_args!(
                    "    {} in its place leaves a chi-square higher by {:.0}; {:.0} would tell them apart",
                    self.id(other.candidate),
                    other.delta_chi2,
                    other.discrimination_threshold
                ));
            }
            let mut out: Vec<&Compared> =
                found.compared.iter().filter(|other| !other.is_as_likely()).collect();
            out.sort_by(|a, b| a.delta_chi2.total_cmp(&b.delta_chi2));
            let rejected = |other: &&Compared| {
                format!("{} by {:.0}", self.id(other.candidate), other.delta_chi2)
            };
            let out: Vec<String> = out.iter().take(REJECTED).map(rejected).collect();
            if !out.is_empty() {
                sheet.line(format_args!(
                    "    rejected in its place, chi-square higher: {}",
                    out.join(", ")
                ));
            }
        }
        let off = self.found.finding.standing_out.iter();
        let off: Vec<&str> = off
            .map(|own| self.table.points[self.found.measured[own.experiment]].id.as_str())
            .collect();
        if !off.is_empty() {
            sheet.line(format_args!("  points beyond their deviations: {}", off.join(", ")));
        }
        for reason in &self.found.finding.reasons {
            sheet.line(format_args!("  {reason}"));
        }
    }

    /// The channels whose error falls most, on points held out.
    fn gains(&self, most: usize, sheet: &mut Sheet) {
        let gains = &self.found.gains;
        if gains.is_empty() {
            return;
        }
        let fall = |own: &ChannelGain| own.in_deviations[0] - own.in_deviations[1];
        let mut order: Vec<&ChannelGain> = gains.iter().collect();
        order.sort_by(|a, b| fall(b).total_cmp(&fall(a)));
        sheet.line("\nError on points held out, rms");
        sheet.block(&table_of(
            &order[..most.min(order.len())],
            &[
                ("channel", &|own| self.table.channels[own.channel].name.clone()),
                ("before", &|own| significant(own.rms_before, 3).to_string()),
                ("after", &|own| significant(own.rms_after, 3).to_string()),
                ("before, sd", &|own| significant(own.in_deviations[0], 3).to_string()),
                ("after, sd", &|own| significant(own.in_deviations[1], 3).to_string()),
            ],
        ));
        if gains.len() > most {
            sheet.line(format_args!("  {} more channels: --details", gains.len() - most));
        }
    }

    /// What to measure next.
    fn next(&self, sheet: &mut Sheet) {
        let Some(next) = &self.found.next else { return };
        sheet.line(format_args!("Measure next: {}", next.in_words(&self.table)));
        let open: Vec<&str> = next.open.iter().map(|&c| self.id(c)).collect();
        let told = if next.told_apart >= 1.0 {
            "it would tell them apart".to_owned()
        } else if next.told_apart > 0.0 {
            format!("it would tell {:.0} % of the pairs apart", 100.0 * next.told_apart)
        } else {
            format!(
                "no point of the table tells them apart: it comes nearest, with {:.0} % of the difference needed",
                100.0 * next.least_distance.min(1.0)
            )
        };
        sheet.line(format_args!("  open: {}; {told}", unique(open).join(", ")));
        let all = next.open.iter().flat_map(|&c| self.found.candidates[c].separating);
        let besides = unique(all.copied()).join("; ");
        if !besides.is_empty() {
            sheet.line(format_args!("  what tells them apart besides: {besides}"));
        }
    }

    /// What it rests on.
    fn ground(&self, sheet: &mut Sheet) {
        let table = &self.table;
        sheet.line(format_args!("Diagnosis: {}", self.title));
        sheet.line(format_args!(
            "  {} readings at {} points, {} suspects, {} other models thought as good, {} uncertain inputs",
            table.values(),
            self.found.measured.len(),
            table.suspects.len(),
            table.alternatives.len(),
            table.uncertain.len()
        ));
        let gains: Vec<f64> = table.instruments.iter().map(|own| 100.0 * own.gain).collect();
        let low = significant(gains.iter().copied().fold(f64::INFINITY, f64::min), 2);
        let high = significant(gains.iter().copied().fold(0.0, f64::max), 2);
        let right = if low < high { format!("{low} to {high}") } else { low.to_string() };
        sheet.line(format_args!(
            "  Gains of the channels are taken to be right to {right} % (1 sd); a smooth error of one sd of a reading is allowed for"
        ));
        if table.alternatives.is_empty() {
            sheet.line(
                "  No other model was given: what an equally good one would differ by is not known",
            );
        }
    }
}

/// What would have been seen, where nothing is missing.
fn seen(findings: &Findings, sheet: &mut Sheet) {
    if findings.verdict != Verdict::NothingMissing {
        return;
    }
    let shown = findings.would_have_shown.iter();
    let sizes: Vec<String> = shown
        .filter_map(|(name, value)| Some(format!("{name} {}", significant((*value)?, 4))))
        .collect();
    sheet.line(format_args!(
        "  Would have been seen with 90 % probability, from these values on: {}",
        sizes.join(", ")
    ));
}

/// A diagnosis of points, printable.
#[derive(Clone, Serialize)]
#[serde(transparent)]
pub struct PointStory<'a> {
    findings: Findings,
    #[serde(skip)]
    own: &'a PointDiagnosis,
}

impl<'a> PointStory<'a> {
    /// The story of a diagnosis.
    pub fn of(own: &'a PointDiagnosis) -> Self {
        Self { findings: own.findings(), own }
    }
}

impl Printable for PointStory<'_> {
    fn text(&self) -> String {
        let words = self.own.words(&self.findings);
        let mut screen = Sheet::default();
        screen.paragraphs(&words.verdict);
        screen.paragraphs(&words.why);
        self.own.gains(SHOWN, &mut screen);
        screen.paragraphs(&words.next);
        screen.line("");
        screen.paragraphs(&words.ground);
        screen.line("\nEvery suspect and every channel: --details");
        screen.screen()
    }

    fn details(&self) -> String {
        let words = self.own.words(&self.findings);
        let mut sheet = Sheet::default();
        sheet.line(&words.verdict);
        sheet.block(&words.why);
        self.own.gains(usize::MAX, &mut sheet);
        sheet.block(&words.next);
        sheet.line(format_args!("\n{}", words.ground.trim_end()));
        sheet.line("\nScreening: drop of chi-square that each suspect could bring, and the floor");
        let found = &self.own.found;
        sheet.block(&screening(&found.candidates, &found.finding.screen));
        sheet.finish()
    }
}
