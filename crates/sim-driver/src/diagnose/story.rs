//! What the terminal says: what is wrong, how we know, the name or the honest absence of one, the
//! gain, what to measure next.

use super::{Diagnosis, Findings};
use crate::files::significant;
use crate::output::{Printable, Sheet, counted, table, table_of, unique};
use diagnosis_page::Words;
use model_gap::Candidate;
use model_gap::discovery::{Confidence, Found, Screened, Verdict, by_score};
use report_page::Section;
use serde::Serialize;

/// Error of the base model, over the output, from which on the story says that little can be seen beside it.
const POOR_BASE: f64 = 0.1;
/// Times that error from which on a simulation given lacks something of the reference runs already.
const LACKS: f64 = 2.0;
/// Percent of the output of the reference runs from which on it is said first.
const FAR: f64 = 5.0;

/// The story of a diagnosis, printable.
#[derive(Clone, Serialize)]
#[serde(transparent)]
pub struct Story<'a> {
    findings: Findings,
    #[serde(skip)]
    diagnosis: &'a Diagnosis,
}

impl<'a> Story<'a> {
    /// The story of a diagnosis.
    pub fn of(diagnosis: &'a Diagnosis) -> Self {
        Self { findings: Findings::from(diagnosis), diagnosis }
    }
}

/// What is said of a diagnosis of a bench.
fn words(d: &Diagnosis, findings: &Findings) -> Words {
    Words {
        title: d.title.clone(),
        verdict: verdict_line(d, findings),
        why: told(&|sheet| {
            causes(d, sheet);
            seen(findings, sheet);
        }),
        gain: told(&|sheet| gain(d, findings, sheet)),
        next: told(&|sheet| next(d, sheet)),
        ground: told(&|sheet| base(d, sheet)),
        ..common_words(findings, (&d.candidates, &d.finding.screen))
    }
}

/// What is said of every diagnosis alike.
pub(super) fn common_words(
    findings: &Findings,
    (candidates, screened): (&[Candidate], &[Screened]),
) -> Words {
    Words {
        not_observable: not_observable(findings),
        screening: Section {
            title: "Screening of every suspect".to_owned(),
            text: LEGEND.replace('\n', " "),
            header: SCREENED.map(str::to_owned).into(),
            rows: screened_rows(candidates, screened).collect(),
        },
        program: format!("rotor-hhc {}", crate::VERSION),
        ..Words::default()
    }
}

/// The lines of a part.
pub(super) fn told(say: &dyn Fn(&mut Sheet)) -> String {
    let mut sheet = Sheet::default();
    say(&mut sheet);
    sheet.finish()
}

/// The page of a diagnosis of a bench, as one HTML text that loads nothing.
pub fn bench_page(diagnosis: &Diagnosis) -> String {
    diagnosis_page::bench_page(diagnosis, &words(diagnosis, &Findings::from(diagnosis)))
}

impl Printable for Story<'_> {
    /// The verdict first, then what it rests on.
    fn text(&self) -> String {
        let Words { verdict, why, gain, next, ground, .. } = words(self.diagnosis, &self.findings);
        let mut screen = Sheet::default();
        for part in [&verdict, &why, &gain, &next] {
            screen.paragraphs(part);
        }
        screen.line("");
        screen.paragraphs(&ground);
        screen.line("\nEvery run and every cause: --details");
        screen.screen()
    }

    /// Everything, the verdict first, then in the order of the work.
    fn details(&self) -> String {
        let Self { findings, diagnosis: d } = self;
        let Words { verdict, why, gain, next, ground, .. } = words(d, findings);
        let mut sheet = Sheet::default();
        sheet.line(&verdict);
        sheet.block(&why);
        sheet.block(&gain);
        sheet.line("");
        sheet.block(&ground);
        accuracy(d, &mut sheet);
        energies(d, &mut sheet);
        sheet.line("\nScreening: drop of chi-square that each cause could bring, and the floor that surrogates with nothing missing reach");
        sheet.block(&screening(&d.candidates, &d.finding.screen));
        sheet.block(LEGEND);
        if let Some(own) = not_observable(findings) {
            sheet.line(own);
        }
        sheet.block(&next);
        sheet.finish()
    }
}

/// The base model, and what is odd about the runs beside it.
fn base(d: &Diagnosis, sheet: &mut Sheet) {
    let unit = &d.output_unit;
    sheet.line(format_args!("Diagnosis: {}", d.title));
    sheet.line(format_args!(
        "  {} against a base model of {}; its error on runs left out of its fit is {:.2} % of the output, the noise {} {unit}",
        counted(d.run_ids.len(), "measured run"),
        match (d.has_reference, d.given.filter(|own| !own.is_foreign())) {
            (true, _) => counted(d.fitted_runs(), "reference run"),
            (false, Some(_)) => "the simulation given (no reference runs)".to_owned(),
            (false, None) => "the same runs (no reference runs)".to_owned(),
        },
        100.0 * d.floor,
        significant(d.noise, 3),
    ));
    if let [first, others @ ..] = &d.interpolated[..] {
        let runs = if others.is_empty() {
            first.clone()
        } else {
            format!("{first} and {} more", others.len())
        };
        sheet.line(format_args!(
            "  Samples of {runs} were interpolated between measured ones: they tell nothing, and are left out."
        ));
    }
    if !d.has_reference {
        let taken = match d.given.filter(|own| !own.is_foreign()) {
            Some(_) => "the simulation is taken at its word",
            None => "what these runs share is taken for ordinary",
        };
        sheet.line(format_args!(
            "  Without reference runs the floor cannot be calibrated: {taken}, and nothing is said with confidence."
        ));
    }
    if d.floor > POOR_BASE {
        let known = if d.fitted_runs() == 1 {
            "one run alone says little about others"
        } else {
            "it is of another kind, or its runs move where the others never did"
        };
        sheet.line(format_args!(
            "  The base model hardly predicts a run that it has not seen: {known}. What is not much larger cannot be seen beside that."
        ));
    }
    if d.unit_looks_wrong() {
        let ask = if d.scale < 0.0 { "sign" } else { "unit" };
        sheet.line(format_args!(
            "  The measured outputs move {} times as much as the base model expects: before anything else, see whether every column has the {ask} of its name.",
            significant(d.scale, 2)
        ));
    }
    if let Some(own) = d.given {
        let runs = if d.has_reference {
            format!("{:.1} % of the output of the reference runs and ", own.error_percent)
        } else {
            String::new()
        };
        sheet.line(format_args!(
            "  The simulation given leaves {runs}{:.1} % of that of the measured runs (rms over spread).",
            own.measured_error_percent
        ));
        if lacks(d).is_some() {
            sheet.line(format_args!(
                "  What it lacks of the reference runs already: hhc diagnose ACTUATOR.ron --data FOLDER OF THE REFERENCE RUNS"
            ));
        }
    }
}

/// What the simulation given leaves of the reference runs, percent, if that is far more than the base model does.
fn lacks(d: &Diagnosis) -> Option<f64> {
    let left = d.given.filter(|_| d.has_reference)?.error_percent;
    (left > LACKS * 100.0 * d.floor).then_some(left)
}

/// How well the channels are taken to keep their calibration.
fn accuracy(d: &Diagnosis, sheet: &mut Sheet) {
    let one = |(field, value, unit): &(&str, f64, &str)| format!("{field} {value} {unit}");
    let rows = d.accuracy().rows();
    let stated: Vec<String> = rows.iter().filter(|row| row.1 > 0.0).map(one).collect();
    if !stated.is_empty() {
        sheet.line(format_args!("  accuracy from session to session: {}", stated.join(", ")));
    }
}

/// What the base model leaves of each run.
fn energies(d: &Diagnosis, sheet: &mut Sheet) {
    sheet.line("\nWhat the base model leaves, run by run");
    sheet.block(&table_of(
        &d.energy,
        &[
            ("run", &|row| row.id.clone()),
            ("explained %", &|row| format!("{:.3}", 100.0 * row.explained)),
            ("noise %", &|row| format!("{:.4}", 100.0 * row.noise)),
            ("structured %", &|row| format!("{:.4}", 100.0 * row.structured)),
        ],
    ));
}

/// What the words of the screening mean.
const LEGEND: &str = "Chi-square counts misfits in units of their noise. Score: by how much a cause could lower it. Floor: what surrogates
reach, the same runs simulated anew with noise and nothing missing; no name is given below it. Absorbed: share of
the effect that the base model takes for its own. Most alike: the cause with the most similar effect, with its cosine.
";

/// Heads of the columns of the screening.
const SCREENED: [&str; 5] = ["cause", "score", "floor", "absorbed %", "most alike"];

/// What each cause could explain, as a table of the terminal.
pub(super) fn screening(candidates: &[Candidate], screened: &[Screened]) -> String {
    table(&SCREENED, screened_rows(candidates, screened))
}

/// What each cause could explain, the strongest first.
fn screened_rows(
    candidates: &[Candidate],
    screened: &[Screened],
) -> impl Iterator<Item = Vec<String>> {
    by_score(screened).into_iter().map(|c| {
        let (candidate, s) = (&candidates[c], &screened[c]);
        let name = candidate.id;
        if let Some(why) = &candidate.blocked {
            return vec![name.to_owned(), "-".into(), "-".into(), "-".into(), why.clone()];
        }
        let mark = match candidate {
            Candidate { refuted: Some(_), .. } => " (refuted)",
            Candidate { decoy: Some(_), .. } => " (decoy)",
            _ => "",
        };
        let alike = s
            .most_confused
            .map_or_else(String::new, |(b, cosine)| format!("{} {cosine:+.2}", candidates[b].id));
        let [score, floor] = [s.score, s.threshold].map(|drop| format!("{drop:.0}"));
        vec![format!("{name}{mark}"), score, floor, format!("{:.1}", 100.0 * s.absorbed), alike]
    })
}

/// The causes named, and the reasons of the verdict.
fn causes(d: &Diagnosis, sheet: &mut Sheet) {
    for found in &d.finding.causes {
        let cause = &d.candidates[found.candidate];
        sheet.line(format_args!("  {}: {}", cause.id, cause.physics));
        for p in &found.parameters {
            let own = valued(p.name, p.value, p.unit, p.ci95);
            sheet.line(format_args!("    {own}"));
            if let Some(needs) = p.needs {
                sheet.line(format_args!(
                    "      the value is a guess: without {needs} only its product with something unknown is found"
                ));
            }
        }
        let borne_out =
            if found.held_out_drop.is_some() { ", and runs held out bear it out" } else { "" };
        sheet.line(format_args!("    lowers chi-square by {:.0}{borne_out}", found.drop));
        if let Some(run) = found.only_run {
            sheet.line(format_args!("    run {} alone shows it", d.run_ids[run.experiment]));
        }
        for other in found.compared.iter().filter(|other| other.is_as_likely()) {
            sheet.line(format_args!(
                "    {} in its place leaves {:.0} more; the discrimination threshold is {:.0}",
                d.candidates[other.candidate].id, other.delta_chi2, other.discrimination_threshold
            ));
        }
    }
    for run in &d.finding.standing_out {
        sheet.line(format_args!(
            "  run {} leaves {:.1} times what the worst surrogate leaves there",
            d.run_ids[run.experiment], run.times
        ));
    }
    for reason in &d.finding.reasons {
        sheet.line(format_args!("  {reason}"));
    }
}

/// Causes that these data cannot show, if there are any.
fn not_observable(findings: &Findings) -> Option<String> {
    let names = unique(&findings.not_observable);
    let names = names.into_iter().map(String::as_str).collect::<Vec<_>>().join(", ");
    (!names.is_empty()).then(|| format!("Not observable in these data at usual strength: {names}"))
}

/// Where nothing is missing: what would have been seen.
fn seen(findings: &Findings, sheet: &mut Sheet) {
    if findings.verdict != Verdict::NothingMissing {
        return;
    }
    let sizes = findings.would_have_shown.iter();
    let mut sizes: Vec<(&str, f64)> =
        sizes.filter_map(|(id, size)| Some((id.as_str(), (*size)?))).collect();
    sizes.sort_by(|a, b| a.1.total_cmp(&b.1));
    let one = |(id, size): &(&str, f64)| format!("{id} {:.1}", 100.0 * size);
    let sizes: Vec<String> = sizes.iter().map(one).collect();
    sheet.line(format_args!(
        "  Would have been seen with 90 % probability, from so many % of the output: {}",
        sizes.join(", ")
    ));
}

/// What the extended model gains.
fn gain(d: &Diagnosis, findings: &Findings, sheet: &mut Sheet) {
    let unit = &d.output_unit;
    if let Some(gain) = &findings.gain {
        sheet.line(format_args!(
            "\nGain on held-out experiments: {} -> {} {unit} rms, less by {} to {} if they were measured again (95 %), by {} to {} on other experiments of these kinds",
            significant(gain.heldout_rms_before, 4),
            significant(gain.heldout_rms_after, 4),
            significant(gain.ci95[0], 3),
            significant(gain.ci95[1], 3),
            significant(gain.ci95_other_experiments[0], 3),
            significant(gain.ci95_other_experiments[1], 3)
        ));
    }
}

/// What to measure next, and what that would settle.
fn next(d: &Diagnosis, sheet: &mut Sheet) {
    sheet.line(format_args!("Measure next: {} ({})", d.next.id, d.next.what));
    if d.next.resolves == Some(0.0) {
        sheet.line(
            "  it comes nearest, but no experiment of the catalogue would tell these explanations apart: \
             their effects are too alike at this strength, or the noise too large; repeat and average",
        );
    } else if let Some(share) = d.next.resolves {
        sheet.line(format_args!(
            "  as the explanations left are fitted, it would single out {:.0} % of them",
            100.0 * share
        ));
    }
}

/// The causes found, each with those that are about as likely.
fn places(d: &Diagnosis) -> String {
    let id = |candidate: usize| d.candidates[candidate].id;
    let one = |found: &Found| {
        let mut ids = vec![id(found.candidate)];
        ids.extend(found.alternatives.iter().map(|other| id(other.candidate)));
        one_of(&ids)
    };
    d.finding.causes.iter().map(one).collect::<Vec<_>>().join(" + ")
}

/// A parameter with its unit, 1 left out, and its interval.
pub(super) fn valued(name: &str, value: f64, unit: &str, ci95: [f64; 2]) -> String {
    let unit = if unit == "1" { String::new() } else { format!(" {unit}") };
    let [low, high] = ci95.map(|end| significant(end, 3));
    format!("{name} = {}{unit} (95 %: {low} to {high})", significant(value, 4))
}

/// The only name, or the names as a choice.
pub(super) fn one_of(ids: &[&str]) -> String {
    if let [only] = ids { (*only).to_owned() } else { format!("one of {}", ids.join(", ")) }
}

pub(super) fn sure(confidence: Confidence) -> &'static str {
    match confidence {
        Confidence::Confident => "confident",
        Confidence::Tentative => "tentative",
    }
}

/// What is missing in physical words, its cause as far as it is known, and where the data show it.
fn missing(d: &Diagnosis, findings: &Findings, cause: &str) -> String {
    let found: Vec<&Candidate> =
        d.finding.causes.iter().map(|found| &d.candidates[found.candidate]).collect();
    let kind = |(place, own): (usize, &&Candidate)| {
        // the class of the leading cause alone was judged
        let confidence = findings.class_confidence.filter(|_| place == 0);
        let sure = sure(confidence.unwrap_or(Confidence::Tentative));
        format!("{} ({sure})", own.class.words())
    };
    let kinds: Vec<String> = found.iter().enumerate().map(kind).collect();
    let most = d.energy.iter().max_by(|a, b| a.structured.total_cmp(&b.structured));
    let shown = most.map_or_else(String::new, |run| {
        let percent = 100.0 * run.structured.max(0.0).sqrt();
        format!(" Run {} shows it most: {percent:.1} % of its motion is unexplained.", run.id)
    });
    let typical = match (&found[..], findings.verdict) {
        ([only], Verdict::Named) => format!(" Typical of it: {}.", only.fingerprint),
        _ => String::new(),
    };
    format!("Missing: {}. The cause {cause}.{shown}{typical}", kinds.join(" + "))
}

fn verdict_line(d: &Diagnosis, findings: &Findings) -> String {
    let names = findings.causes.join(" + ");
    let sure = sure(findings.confidence);
    match findings.verdict {
        Verdict::NothingMissing => {
            let floor = format!("({sure}): the misfit is at the floor of the base model.");
            match lacks(d).filter(|left| *left > FAR) {
                None => format!("Nothing is missing {floor}"),
                Some(left) => format!(
                    "Nothing has changed since the reference runs {floor} The simulation given is another matter: it leaves {left:.1} % of their output."
                ),
            }
        }
        Verdict::Named => missing(d, findings, &format!("({sure}): {names}")),
        Verdict::NamedStructureRemains => {
            let cause = format!("({sure}): {names}; structure remains that it does not explain");
            missing(d, findings, &cause)
        }
        Verdict::Ambiguous => {
            let cause = format!("is {}; these data do not distinguish them", places(d));
            missing(d, findings, &cause)
        }
        Verdict::Unknown if d.given.is_some_and(|own| own.is_foreign()) => {
            "This simulation is not of this bench: nothing is said of what it lacks.".to_owned()
        }
        Verdict::Unknown => {
            "Something is missing, and no known cause explains it: no name is given.".to_owned()
        }
        Verdict::NotObservable => "These data cannot show what could be missing.".to_owned(),
    }
}
