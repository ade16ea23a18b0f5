//! What pages of every kind of data have in common.

use crate::words::Words;
use maud::{Markup, html};
use model_gap::discovery::{
    Finding, Fingerprint, FittedParameter, Found, Standing, Verdict, by_score,
};
use model_gap::{Candidate, Findings};
use report_page::pictures::{
    Interval, Look, Mark, MarkForm, PointForm, Row, RowScale, Rows, intervals,
};
use report_page::{Charts, folded, page, paragraphs};

/// Colours of what was measured, of the simulation before and after, and of a rival.
pub(super) const MEASURED: usize = 0;
pub(super) const AFTER: usize = 1;
pub(super) const BEFORE: usize = 2;
pub(super) const RIVAL: usize = 3;
/// Colour of a limit.
const LIMIT: usize = 4;

/// Standard deviations up to which a scale is straight.
const STRAIGHT: f64 = 8.0;

/// Most rows of the costs; the rest is in the table of the screening.
const MOST_COSTS: usize = 16;

/// The whole page: words first, then the pictures of the kind of data.
pub(super) fn diagnosis_page(words: &Words, pictures: &Markup) -> String {
    let ground = words.ground.lines().skip(1).collect::<Vec<_>>().join("\n");
    let body = html! {
        header {
            h1 { "Diagnosis: " (words.title) }
            p.verdict { (words.verdict) }
        }
        section.why { h2 { "Why, and how sure" } (paragraphs(&words.why)) (paragraphs(&words.gain)) }
        @if !words.next.is_empty() {
            section.next { h2 { "What to measure next" } (paragraphs(&words.next)) }
        }
        (pictures)
        section.ground {
            h2 { "What it rests on" }
            (paragraphs(&ground))
            @if !words.notes.is_empty() { ul { @for note in &words.notes { li { (note) } } } }
        }
        footer { p { (words.program) ". Residuals are measured less simulated; sd: standard deviations. "
            "All numbers are in the files beside this page." } }
    };
    page(&words.title, &body, &Charts::default())
}

/// What the simulation with what was fitted is called.
pub(super) fn after_name(verdict: Verdict) -> &'static str {
    match verdict {
        Verdict::Unknown => "with the best fit, which has no name",
        _ => "with what was found",
    }
}

/// A look of a group of panels.
pub(super) fn look(name: &str, colour: usize, form: PointForm) -> Look {
    Look { name: name.to_owned(), colour, form }
}

/// Root of the mean square of some values; 0 of none.
pub(super) fn rms(values: impl IntoIterator<Item = f64>) -> f64 {
    let (sum, count) =
        values.into_iter().fold((0.0, 0.0), |(sum, count), v| (v.mul_add(v, sum), count + 1.0));
    if count > 0.0 { f64::sqrt(sum / count) } else { 0.0 }
}

/// Colour of an explanation.
pub(super) fn colour_of(own: &Fingerprint) -> usize {
    if own.standing == Standing::Found { AFTER } else { RIVAL }
}

/// What is said of an explanation beside its name.
pub(super) fn standing_note(own: &Fingerprint) -> String {
    let standing = match own.standing {
        Standing::Found => "found",
        Standing::Open => "not excluded",
        Standing::Alone => "fitted alone",
    };
    format!("{standing}; likeness to the residual {:.2}", own.likeness)
}

/// The parameters with their intervals; `none` gives the value of one without effect, by candidate and place.
pub(super) fn parameters(
    finding: &Finding,
    candidates: &[Candidate],
    none: &dyn Fn(usize, usize) -> Option<f64>,
) -> Markup {
    let of = |(candidate, own, colour): (usize, &[FittedParameter], usize)| {
        let one = |(place, p): (usize, &FittedParameter)| {
            let unit = if p.unit == "1" { String::new() } else { format!(", {}", p.unit) };
            let beside = none(candidate, place).filter(|value| value.is_finite());
            Interval {
                label: format!("{}: {}{unit}", candidates[candidate].id, p.name),
                value: p.value,
                ends: p.ci95,
                beside: beside.map(|value| (value, "as simulated:".to_owned())),
                colour,
            }
        };
        own.iter().enumerate().filter(|own| !own.1.is_shape).map(one).collect::<Vec<_>>()
    };
    let named = finding.causes.iter().filter(|_| finding.verdict != Verdict::Unknown);
    let all: Vec<Interval> = named
        .flat_map(|own| {
            let others = own.alternatives.iter();
            let others = others.map(|other| (other.candidate, &other.parameters[..], RIVAL));
            std::iter::once((own.candidate, &own.parameters[..], AFTER)).chain(others).flat_map(of)
        })
        .collect();
    if all.is_empty() {
        return html! {};
    }
    html! {
        section.parameters {
            h2 { "Parameters" }
            p { "Value and 95 % interval, each on its own axis. Green: what is about as likely, were it the one." }
            (intervals(&all))
        }
    }
}

/// What each explanation costs: chi-square in the place of each cause, or the screening where nothing has a name.
pub(super) fn costs(finding: &Finding, candidates: &[Candidate], words: &Words) -> Markup {
    let is_named = !finding.causes.is_empty() && finding.verdict != Verdict::Unknown;
    // where none was tried, the reason of most
    let blocked = || candidates.iter().filter_map(|own| own.blocked.as_ref());
    let times = |why: &&String| blocked().filter(|other| other == why).count();
    let untried = blocked().max_by_key(times).filter(|_| blocked().count() == candidates.len());
    html! {
        section.costs {
            h2 { "What each explanation costs" }
            @if is_named {
                @for found in &finding.causes { (in_its_place(found, candidates)) }
            } @else {
                p { "Drop of chi-square that each suspect could bring, scaled freely; the stroke is the floor below which "
                    "there is nothing to name." }
                @match untried {
                    Some(why) => { p { "No suspect was tried: " (why) "." } }
                    None => { (screened_bars(finding, candidates)) }
                }
            }
            (words.screening.folded())
        }
    }
}

/// Chi-square of what was fitted in the place of a cause, above that of the cause.
fn in_its_place(found: &Found, candidates: &[Candidate]) -> Markup {
    let bar = |value: f64, colour: usize| {
        let told = format!("{value:.1}");
        Mark { form: MarkForm::Bar, colour, value, told }
    };
    let id = candidates[found.candidate].id;
    let mut rows = vec![Row {
        label: id.to_owned(),
        note: "found".to_owned(),
        is_strong: true,
        marks: vec![bar(0.0, AFTER)],
    }];
    let mut others: Vec<_> = found.compared.iter().collect();
    others.sort_by(|a, b| a.delta_chi2.total_cmp(&b.delta_chi2));
    let mut named = vec![id];
    for other in others {
        let name = candidates[other.candidate].id;
        // of several of one name the best stands for all
        if named.contains(&name) || rows.len() == MOST_COSTS {
            continue;
        }
        named.push(name);
        let (delta, needed) = (other.delta_chi2, other.discrimination_threshold);
        let told = format!("{needed:.1} would tell them apart");
        let limit = Mark { form: MarkForm::Tick, colour: LIMIT, value: needed, told };
        rows.push(Row {
            label: name.to_owned(),
            note: format!("+{delta:.0}, needs {needed:.0}"),
            is_strong: other.is_as_likely(),
            marks: vec![bar(delta, if other.is_open() { RIVAL } else { MEASURED }), limit],
        });
    }
    rows.push(Row {
        label: "nothing in its place".to_owned(),
        note: format!("+{:.0}", found.drop),
        marks: vec![bar(found.drop, BEFORE)],
        ..Row::default()
    });
    let axis = format!("chi-square above that of {id}");
    let picture = Rows { axis, scale: RowScale::LogFrom(1.0), rows };
    html! {
        p { "In the place of " strong { (id) } ": the lower, the better. The stroke is the difference that tells two apart; "
            "green: not excluded." }
        (picture.markup())
    }
}

fn screened_bars(finding: &Finding, candidates: &[Candidate]) -> Markup {
    let row = |c: usize| {
        let own = &finding.screen[c];
        let [score, floor] = [own.score, own.threshold].map(|value| format!("{value:.0}"));
        let bar = Mark {
            form: MarkForm::Bar,
            colour: if own.score > own.threshold { BEFORE } else { MEASURED },
            value: own.score,
            told: score.clone(),
        };
        let told = format!("floor {floor}");
        let limit = Mark { form: MarkForm::Tick, colour: LIMIT, value: own.threshold, told };
        Row {
            label: candidates[c].id.to_owned(),
            note: format!("{score} of {floor}"),
            is_strong: own.score > own.threshold,
            marks: vec![bar, limit],
        }
    };
    let tried = by_score(&finding.screen).into_iter();
    let tried = tried.filter(|&c| candidates[c].blocked.is_none()).take(MOST_COSTS);
    let axis = "drop of chi-square".to_owned();
    Rows { axis, scale: RowScale::LogFrom(1.0), rows: tried.map(row).collect() }.markup()
}

/// The yardstick: label, size and note of each suspect that would have been seen, the size counted as `axis` says, those
/// up to what `matters` in green. Unfolded where nothing is missing.
pub(super) fn yardstick(
    (findings, words): (&Findings, &Words),
    sizes: &[(String, f64, String)],
    (axis, matters): (&str, Option<f64>),
) -> Markup {
    // what would be seen at a hundred times an amount that matters is not observable
    let most = 100.0 * matters.unwrap_or(1.0);
    let mut sizes: Vec<_> = sizes.iter().filter(|own| own.1 <= most).collect();
    sizes.sort_by(|a, b| a.1.total_cmp(&b.1));
    let rows = sizes.iter().map(|(label, size, note)| {
        let is_seen = matters.is_none_or(|most| *size <= most);
        let colour = if is_seen { RIVAL } else { BEFORE };
        let bar = Mark { form: MarkForm::Bar, colour, value: *size, told: format!("{size:.3}") };
        let limit = matters.map(|value| Mark {
            form: MarkForm::Tick,
            colour: LIMIT,
            value,
            told: "an amount that matters".to_owned(),
        });
        let marks = std::iter::once(bar).chain(limit).collect();
        Row { label: label.clone(), note: note.clone(), marks, ..Row::default() }
    });
    let rows: Vec<Row> = rows.collect();
    let is_empty = rows.is_empty();
    let picture = Rows { axis: axis.to_owned(), scale: RowScale::LogFrom(0.01), rows };
    let title = "What would have been seen";
    let body = html! {
        p { "Size of each suspect that these data would have shown with 90 % probability: the shorter the bar, the more "
            "surely it is not there." }
        @if !is_empty { (picture.markup()) }
        @if let Some(own) = &words.not_observable { p.note { (own) "." } }
    };
    let is_open = matches!(findings.verdict, Verdict::NothingMissing | Verdict::NotObservable);
    html! {
        section.yardstick {
            @if is_open { h2 { (title) } (body) } @else { (folded(title, &body)) }
        }
    }
}

/// A scale for marks of some size: straight where they are alike.
pub(super) fn scale_for<'a>(rows: impl IntoIterator<Item = &'a Row>) -> RowScale {
    let values = rows.into_iter().flat_map(|row| &row.marks).map(|mark| mark.value);
    if values.fold(0.0, f64::max) < STRAIGHT { RowScale::Linear } else { RowScale::LogFrom(0.1) }
}
