//! The page of the runs of an actuator bench.

use crate::common::{
    AFTER, BEFORE, MEASURED, RIVAL, after_name, colour_of, costs, diagnosis_page, look, parameters,
    rms, scale_for, standing_note, yardstick,
};
use crate::words::Words;
use actuator_gap::{Diagnosis, RunShown};
use maud::{Markup, html};
use model_gap::discovery::{Fingerprint, Verdict};
use model_gap::{Findings, HarmonicFit, Sine};
use report_page::pictures::{
    HeatMap, Look, Mark, MarkForm, Panel, PointForm, Row, RowScale, Rows, Series, averaged, legend,
    short, thinned,
};
use report_page::{Section, counted, folded};
use rotor_base::Harmonic;
use std::ops::Range;

/// Runs that are drawn at once, and those drawn at all.
const RUNS: usize = 3;
const MOST_RUNS: usize = 12;
/// Runs whose fingerprints are drawn.
const FINGERPRINTS: usize = 2;
/// Points of a line.
const POINTS: usize = 400;
/// Cycles of a sine that are drawn, its last ones; of other runs, crossings of the mean.
const CYCLES: f64 = 2.0;
const TURNS: usize = 16;
/// Parts of a run in the map of what is left, and harmonics of a sine.
const PARTS: usize = 24;
const HARMONICS: usize = 7;
/// Standard deviations of the full colour: at least, and at most.
const FULL: [f64; 2] = [2.0, 8.0];

/// Part of chi-square below which what is left hides the misfit.
const HIDDEN: f64 = 0.1;

/// Values of a run and its residual, in the unit of the outputs; none of a run that has none.
type RowOf<'a> = dyn Fn(&RunShown, &[f64]) -> Option<Vec<f64>> + 'a;

/// A line made of fewer points.
type Fewer = fn(&[[f64; 2]], usize) -> Vec<[f64; 2]>;

/// The page of a diagnosis of a bench, as one HTML text that loads nothing.
pub fn bench_page(d: &Diagnosis, words: &Words) -> String {
    let findings = Findings::from(d);
    let is_raw = is_hidden(d.shown.iter().flat_map(|run| {
        let over = |value: f64| value / run.sigma;
        let pairs = run.misfit(0).into_iter().zip(&run.residual[0]);
        pairs.map(move |(missed, left)| (over(missed), over(*left)))
    }));
    let page = BenchPage { d, after: after_name(d.finding.verdict), is_raw };
    let none = |candidate: usize, place: usize| {
        let own = d.candidates[candidate].parameters.get(place)?;
        own.is_amount.then_some(own.none)
    };
    let is_nothing = findings.verdict == Verdict::NothingMissing;
    let pictures = html! {
        @if is_nothing { (would_have_shown(&findings, words)) }
        (page.compared())
        (page.residuals())
        (page.fingerprints())
        (parameters(&d.finding, &d.candidates, &none))
        (page.floors())
        (costs(&d.finding, &d.candidates, words))
        @if !is_nothing { (would_have_shown(&findings, words)) }
        section { h2 { "Numbers" } (page.runs().folded()) }
    };
    diagnosis_page(words, &pictures)
}

/// The yardstick: from which part of the output on each cause would have been seen.
fn would_have_shown(findings: &Findings, words: &Words) -> Markup {
    let sizes = findings.would_have_shown.iter();
    let sizes: Vec<(String, f64, String)> = sizes
        .filter_map(|(name, size)| Some((name, 100.0 * (*size)?)))
        .map(|(name, percent)| (name.clone(), percent, format!("{} %", short(percent))))
        .collect();
    yardstick((findings, words), &sizes, ("size that would have been seen, % of the output", None))
}

/// A diagnosis as it is drawn.
struct BenchPage<'a> {
    d: &'a Diagnosis,
    /// What the extended model is called.
    after: &'static str,
    /// Whether residuals are drawn with nothing taken off, since that would hide them.
    is_raw: bool,
}

impl BenchPage<'_> {
    fn has_after(&self) -> bool {
        !self.d.finding.effects.is_empty()
    }

    /// The residual of a run as it is drawn, before or after.
    fn left(&self, run: &RunShown, which: usize) -> Vec<f64> {
        if self.is_raw { run.misfit(which) } else { run.residual[which].clone() }
    }

    /// The runs, that with the largest residual over its deviations first.
    fn worst_first(&self) -> Vec<&RunShown> {
        let size = |own: &RunShown| rms(own.residual[0].iter().copied()) / own.sigma;
        let mut runs: Vec<&RunShown> = self.d.shown.iter().collect();
        runs.sort_by(|a, b| size(b).total_cmp(&size(a)));
        runs
    }

    /// Measured against simulated, over time and over the input.
    fn compared(&self) -> Markup {
        let runs = self.worst_first();
        let drawn = &runs[..runs.len().min(MOST_RUNS)];
        let (first, rest) = drawn.split_at(drawn.len().min(RUNS));
        let mut looks = vec![
            look("measured", MEASURED, PointForm::Line),
            look("simulated", BEFORE, PointForm::Line),
        ];
        if self.has_after() {
            looks.push(look(&format!("simulated {}", self.after), AFTER, PointForm::Line));
        }
        let panels = |run: &RunShown| {
            let outputs = [&run.measured, &run.simulated[0], &run.simulated[1]];
            let lines: Vec<(Look, &[f64])> =
                looks.iter().cloned().zip(outputs.map(Vec::as_slice)).collect();
            self.both(run, &lines, &self.d.output_unit, thinned)
        };
        let grid = |runs: &[&RunShown]| {
            html! { div.grid { @for run in runs { @for own in panels(run) { (own.markup()) } } } }
        };
        html! {
            section.compared {
                h2 { "Measured against simulated" }
                p { "The runs that the base model misses most, over time and over the input; of a sine the last two cycles, of a fast run "
                    "the part about its largest value." }
                (legend(&looks))
                (grid(first))
                @if !rest.is_empty() { (folded(&format!("{} more", counted(rest.len(), "run")), &grid(rest))) }
            }
        }
    }

    /// Lines of a run over time and over its input, each made of fewer points.
    fn both(
        &self,
        run: &RunShown,
        lines: &[(Look, &[f64])],
        unit: &str,
        fewer: Fewer,
    ) -> [Panel; 2] {
        // the last line is of a simulation: it has no noise
        let samples = drawn_samples(run, lines.last().map_or(&[], |own| own.1));
        let time = |i: usize| run.start_s + i as f64 * run.step_s;
        let panel = |x: &str, of: &dyn Fn(usize) -> f64| {
            let series = lines.iter().map(|(look, values)| {
                let each = samples.clone().filter_map(|i| Some([of(i), *values.get(i)?]));
                let points = fewer(&each.collect::<Vec<_>>(), POINTS);
                Series { look: look.clone(), points, told: Vec::new() }
            });
            Panel {
                title: run.id.clone(),
                axes: [x.to_owned(), unit.to_owned()],
                series: series.collect(),
                ..Panel::default()
            }
        };
        let input = format!("input, {}", self.d.input_unit());
        [panel("time, s", &time), panel(&input, &|i| run.input.get(i).copied().unwrap_or(f64::NAN))]
    }

    /// What is left of every run, where in it, and of which harmonic.
    fn residuals(&self) -> Markup {
        let row = |run: &RunShown| {
            let mut marks = vec![mark(MarkForm::Tick, MEASURED, 1.0, "one sd".to_owned())];
            let mut missed = Vec::new();
            for (which, name) in self.sides() {
                let whole = rms(run.misfit(which)) / run.sigma;
                let left = rms(run.residual[which].iter().copied()) / run.sigma;
                let colour = if which == 0 { BEFORE } else { AFTER };
                let told = |value: f64| format!("{name}: {} sd", short(value));
                marks.push(mark(
                    MarkForm::Ring,
                    colour,
                    whole,
                    told(whole) + ", nothing taken off",
                ));
                marks.push(mark(MarkForm::Dot, colour, left, told(left)));
                missed.push(short(whole));
            }
            let note = missed.join(" to ");
            Row { label: run.id.clone(), note, marks, is_strong: false }
        };
        let rows: Vec<Row> = self.worst_first().into_iter().map(row).collect();
        let axis = "rms of measured less simulated, standard deviations".to_owned();
        let sides = self.sides().into_iter();
        let looks: Vec<Look> = sides
            .flat_map(|(which, name)| {
                let colour = if which == 0 { BEFORE } else { AFTER };
                let ring = look(&format!("{name}, nothing taken off"), colour, PointForm::Rings);
                [ring, look(name, colour, PointForm::Dots)]
            })
            .collect();
        let maps = [self.parts_maps(), self.harmonics_maps()].concat();
        html! {
            section.residuals {
                h2 { "What is left, run by run" }
                p { "In standard deviations of a sample: noise and what the base model leaves with nothing missing. Rings: "
                    "nothing taken off; dots: what the base model may move by and the calibrations taken off. Maps: "
                    (if self.is_raw { "as the rings." } else { "as the dots." }) }
                (legend(&looks))
                (Rows { axis, scale: scale_for(&rows), rows }.markup())
                div.grid.wide { @for map in &maps { (map.markup()) } }
            }
        }
    }

    /// Before, and after where something was fitted.
    fn sides(&self) -> Vec<(usize, &'static str)> {
        let after = self.has_after().then_some((1, self.after));
        std::iter::once((0, "before")).chain(after).collect()
    }

    /// Maps before and after of values by run, over the deviations, with one limit; none where `row` has none of any run.
    fn maps(&self, title: &str, columns: &[String], row: &RowOf<'_>) -> Vec<HeatMap> {
        let one = |(which, name): (usize, &str)| {
            let of = |run: &RunShown| {
                let values = row(run, &self.left(run, which))?;
                Some((run.id.clone(), values.iter().map(|v| Some(v / run.sigma)).collect()))
            };
            let (rows, values): (Vec<String>, Vec<Vec<Option<f64>>>) =
                self.worst_first().into_iter().filter_map(of).unzip();
            let (title, columns) = (format!("{title}, {name}"), columns.to_vec());
            HeatMap { title, columns, rows, values, unit: " sd", ..HeatMap::default() }
        };
        let mut maps: Vec<HeatMap> = self.sides().into_iter().map(one).collect();
        let values = maps.iter().flat_map(|own| &own.values).flatten().flatten();
        let limit = values.copied().fold(0.0, f64::max).clamp(FULL[0], FULL[1]);
        maps.retain(|own| !own.rows.is_empty());
        for own in &mut maps {
            own.limit = limit;
        }
        maps
    }

    /// What is left in every part of every run.
    fn parts_maps(&self) -> Vec<HeatMap> {
        let columns: Vec<String> = (1..=PARTS).map(|part| format!("{part}/{PARTS}")).collect();
        self.maps("where in the run", &columns, &|_, residual| {
            let length = residual.len().div_ceil(PARTS).max(1);
            Some(residual.chunks(length).map(|part| rms(part.iter().copied())).collect())
        })
    }

    /// Harmonics of what is left of every sine; no map without sines.
    fn harmonics_maps(&self) -> Vec<HeatMap> {
        let columns: Vec<String> = (1..=HARMONICS).map(|n| format!("n = {n}")).collect();
        self.maps("harmonics of sines, amplitude", &columns, &|run, residual| {
            let sine = Sine::of(&run.input, run.step_s)?;
            let own = residual.get(sine.samples)?;
            let is_carried = |n: &usize| *n as f64 * sine.frequency_hz < 0.45 / run.step_s;
            let last = (1..=HARMONICS).rev().find(is_carried)?;
            let fit = HarmonicFit::of(own, run.step_s, sine.frequency_hz, last).ok()?;
            Some(fit.harmonics.iter().map(Harmonic::amplitude).collect())
        })
    }

    /// What each explanation does, beside what is left, of the runs that show the first of them most.
    fn fingerprints(&self) -> Markup {
        let all = &self.d.fingerprints;
        let size = |own: &RunShown| {
            own.effects.first().map_or(0.0, |[adds, _]| rms(adds.iter().copied())) / own.sigma
        };
        let mut runs: Vec<&RunShown> = self.d.shown.iter().collect();
        runs.sort_by(|a, b| size(b).total_cmp(&size(a)));
        runs.truncate(FINGERPRINTS);
        let looks = [
            look("residual", MEASURED, PointForm::Line),
            look("found", AFTER, PointForm::Line),
            look("a rival", RIVAL, PointForm::Line),
        ];
        let panels = |run: &RunShown, axis: usize| -> Vec<Panel> {
            let misfit = self.left(run, 0);
            let one = |(own, effect): (&Fingerprint, &[Vec<f64>; 2])| {
                let effect = &effect[usize::from(!self.is_raw)];
                let over = |values: &[f64]| values.iter().map(|v| v / run.sigma).collect();
                let (residual, effect): (Vec<f64>, Vec<f64>) = (over(&misfit), over(effect));
                let name = self.d.candidates[own.candidate].id;
                let lines = [
                    (look("residual", MEASURED, PointForm::Line), &residual[..]),
                    (look(name, colour_of(own), PointForm::Line), &effect[..]),
                ];
                let panel = self.both(run, &lines, "sd", averaged)[axis].clone();
                Panel { title: format!("{name}, {}", run.id), note: standing_note(own), ..panel }
            };
            all.iter().zip(&run.effects).map(one).collect()
        };
        // over time, then those of the first also over the input
        let mut rows: Vec<Vec<Panel>> = runs.iter().map(|run| panels(run, 0)).collect();
        if let Some(first) = runs.first() {
            rows.insert(1, panels(first, 1));
        }
        html! {
            section.fingerprints {
                h2 { "Fingerprints" }
                p { "The residual to be explained, and what each explanation does as fitted, in the runs that show it most: a "
                    "part of those that are fast, means of a few samples. The right cause follows the residual. "
                    (taken_off(self.is_raw)) }
                @if all.is_empty() { p { "No suspect promised enough to be fitted." } }
                @else {
                    (legend(&looks))
                    @for row in &rows { div.grid.small { @for own in row { (own.markup()) } } }
                }
            }
        }
    }

    /// What is not known of every run, beside what the first explanation does.
    fn floors(&self) -> Markup {
        let d = self.d;
        let leading = d.fingerprints.first();
        let name = leading.map(|own| d.candidates[own.candidate].id);
        let colour = leading.map_or(AFTER, colour_of);
        let unit = &d.output_unit;
        let row = |run: &RunShown| {
            let of = |form, colour, value: f64, name: &str| {
                mark(form, colour, value, format!("{name}: {} {unit}", short(value)))
            };
            let mut marks = vec![
                of(MarkForm::Tick, MEASURED, run.noise, "noise"),
                of(MarkForm::Ring, BEFORE, run.sigma, "noise and the base model"),
            ];
            let mut note = String::new();
            if let (Some(name), Some(effect)) = (name, run.effects.first()) {
                let [adds, shows] = effect.each_ref().map(|own| rms(own.iter().copied()));
                marks.push(of(MarkForm::Ring, colour, adds, name));
                marks.push(of(MarkForm::Dot, colour, shows, &format!("{name}, beyond these")));
                note = format!("{}, seen {}", short(adds), short(shows));
            }
            Row { label: run.id.clone(), note, marks, is_strong: false }
        };
        let rows: Vec<Row> = self.worst_first().into_iter().map(row).collect();
        let noises = d.shown.iter().map(|run| run.noise).filter(|noise| *noise > 0.0);
        let least = noises.fold(f64::INFINITY, f64::min).log10().floor();
        let scale = RowScale::LogFrom(if least.is_finite() { 10.0_f64.powf(least) } else { 1e-3 });
        let mut looks =
            vec![look("noise and what the base model leaves", BEFORE, PointForm::Rings)];
        if let Some(name) = name {
            looks.push(look(name, colour, PointForm::Rings));
            looks.push(look("what of it neither explains", colour, PointForm::Dots));
        }
        html! {
            section.floors {
                h2 { "What is not known, beside what the cause does" }
                p { "The stroke is the noise of the reading." }
                (legend(&looks))
                (Rows { axis: format!("rms over the run, {unit}"), scale, rows }.markup())
            }
        }
    }

    /// Every run, in numbers.
    fn runs(&self) -> Section {
        let d = self.d;
        let names =
            d.fingerprints.iter().map(|own| format!("{} shows", d.candidates[own.candidate].id));
        let head = ["run", "measured", "noise", "sd", "left before", "left after"];
        let row = |run: &RunShown| {
            let size = |values: &Vec<f64>| rms(values.iter().copied());
            let mean = run.measured.iter().sum::<f64>() / run.measured.len().max(1) as f64;
            let moved = rms(run.measured.iter().map(|y| y - mean));
            let [before, after] = run.residual.each_ref().map(size);
            let numbers = [moved, run.noise, run.sigma, before, after];
            let all = numbers.into_iter().chain(run.effects.iter().map(|own| size(&own[1])));
            std::iter::once(run.id.clone()).chain(all.map(short)).collect()
        };
        Section {
            title: counted(d.shown.len(), "run"),
            text: format!(
                "Roots of mean squares, {}; that of the measured output about its mean.",
                d.output_unit
            ),
            header: head.into_iter().map(str::to_owned).chain(names).collect(),
            rows: d.shown.iter().map(row).collect(),
        }
    }
}

/// Whether what is taken off a misfit hides it, of what each value misses by and what is left of that: calibrations and
/// errors of the simulation would bear most of its chi-square, far beyond their deviations.
fn is_hidden(values: impl IntoIterator<Item = (f64, f64)>) -> bool {
    let sums = values.into_iter().fold([0.0, 0.0], |[chi2, left], (missed, own)| {
        [missed.mul_add(own, chi2), own.mul_add(own, left)]
    });
    sums[1] < HIDDEN * sums[0]
}

/// What is said of pictures of effects, by whether nothing is taken off, since that would hide the misfit.
fn taken_off(is_raw: bool) -> &'static str {
    if is_raw {
        "Nothing is taken off: calibrations and errors of the simulation could explain it, but far beyond their deviations."
    } else {
        "Of both, what is known of the errors of readings and simulation is taken off."
    }
}

/// Samples of a run that are drawn: the last cycles of a sine; of a signal without noise that turns often the part about its
/// largest value; else all.
fn drawn_samples(run: &RunShown, signal: &[f64]) -> Range<usize> {
    let all = 0..run.measured.len().min(signal.len());
    if let Some(sine) = Sine::of(&run.input, run.step_s) {
        let period = CYCLES / (sine.frequency_hz * run.step_s);
        let end = sine.samples.end.min(all.end);
        // the first sample within the last cycles
        let start = (sine.samples.start..end).find(|&i| ((end - i) as f64) <= period + 1.0);
        return start.map_or(all, |start| start..end);
    }
    let mean = signal.iter().sum::<f64>() / signal.len().max(1) as f64;
    let off: Vec<f64> = signal.iter().map(|value| value - mean).collect();
    let turns = off.windows(2).filter(|own| own[0] * own[1] < 0.0).count();
    if turns <= 2 * TURNS {
        return all;
    }
    let half = TURNS * all.len() / (2 * turns);
    let largest = off.iter().enumerate().max_by(|a, b| a.1.abs().total_cmp(&b.1.abs()));
    let middle = largest.map_or(0, |own| own.0);
    middle.saturating_sub(half)..(middle + half + 1).min(all.end)
}

fn mark(form: MarkForm, colour: usize, value: f64, told: String) -> Mark {
    Mark { form, colour, value, told }
}
