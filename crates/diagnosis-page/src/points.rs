//! The page of points of test.

use crate::common::{
    AFTER, BEFORE, MEASURED, after_name, colour_of, costs, diagnosis_page, look, parameters, rms,
    scale_for, standing_note, yardstick,
};
use crate::words::Words;
use maud::{Markup, html};
use model_gap::Findings;
use model_gap::discovery::{Standing, Verdict};
use model_gap::points::{ChannelFloor, ChannelGain, Part, PointFinding, PointTable, Reading};
use report_page::pictures::{
    HeatMap, Look, Mark, MarkForm, Panel, PointForm, Row, RowScale, Rows, Series, legend, short,
};
use report_page::{Section, folded};

/// Panels that are seen at once; the others are unfolded.
const PANELS: usize = 8;
/// Standard deviations of the full colour: at least, and at most.
const FULL: [f64; 2] = [3.0, 8.0];
/// Deviations to either side of a reading.
const WHISKER: f64 = 2.0;

/// A value of a reading.
type Value = fn(&Reading) -> f64;

/// The page of a diagnosis of points of test, as one HTML text that loads nothing.
///
/// `found` and `findings` are those of the table.
pub fn points_page(
    table: &PointTable,
    found: &PointFinding,
    findings: &Findings,
    words: &Words,
) -> String {
    let page = PointsPage { table, found };
    let none = |suspect: usize, place: usize| {
        let own = table.suspects[suspect].parameters.get(place)?;
        (!own.tables.is_empty()).then(|| own.shown.of(own.none))
    };
    let is_nothing = found.finding.verdict == Verdict::NothingMissing;
    let yardstick = page.would_have_shown(findings, words);
    let pictures = html! {
        @if is_nothing { (yardstick) }
        (page.compared())
        (page.residuals())
        (page.fingerprints())
        (parameters(&found.finding, &found.candidates, &none))
        (page.held_out())
        (page.floors())
        (costs(&found.finding, &found.candidates, words))
        @if !is_nothing { (yardstick) }
        section { h2 { "Numbers" } (page.readings().folded()) (page.effects().folded()) }
    };
    diagnosis_page(words, &pictures)
}

/// A diagnosis as it is drawn.
struct PointsPage<'a> {
    table: &'a PointTable,
    found: &'a PointFinding,
}

impl PointsPage<'_> {
    fn channel(&self, channel: usize) -> &str {
        &self.table.channels[channel].name
    }

    fn point(&self, point: usize) -> &str {
        &self.table.points[point].id
    }

    /// Channels with readings, in their order.
    fn channels(&self) -> Vec<usize> {
        self.found.floors.iter().map(|own| own.channel).collect()
    }

    fn of_channel(&self, channel: usize) -> impl Iterator<Item = &Reading> {
        self.found.readings.iter().filter(move |own| own.channel == channel)
    }

    fn after(&self) -> &'static str {
        after_name(self.found.finding.verdict)
    }

    fn has_after(&self) -> bool {
        !self.found.finding.effects.is_empty()
    }

    /// Measured against simulated, a panel a channel, or a harmonic: those with the largest residual first.
    fn compared(&self) -> Markup {
        let size = |channel: usize| rms(self.of_channel(channel).map(|own| own.residual[0]));
        let mut panels: Vec<(f64, Panel)> = Vec::new();
        for channel in self.channels() {
            match self.table.channels[channel].part {
                Part::Scalar => panels.push((size(channel), self.over_points(channel))),
                Part::CosineOf(sine) => {
                    let both = size(channel).hypot(size(sine));
                    panels.push((both, self.in_plane([channel, sine])));
                }
                // it stands with its cosine
                Part::SineOf(_) => {}
            }
        }
        panels.sort_by(|a, b| b.0.total_cmp(&a.0));
        if self.found.measured.len() == 1 && panels.iter().all(|own| !own.1.is_equal) {
            return html! {
                section.compared { h2 { "Measured against simulated" } (self.readings().table()) }
            };
        }
        let (first, rest) = panels.split_at(panels.len().min(PANELS));
        let grid = |own: &[(f64, Panel)]| html! { div.grid { @for (_, panel) in own { (panel.markup()) } } };
        let mut looks = vec![
            look("measured", MEASURED, PointForm::Dots),
            look("simulated", BEFORE, PointForm::Rings),
        ];
        if self.has_after() {
            looks.push(look(&format!("simulated {}", self.after()), AFTER, PointForm::Crosses));
        }
        html! {
            section.compared {
                h2 { "Measured against simulated" }
                p { "Harmonics in the plane of cosine and sine, a line from what was measured to what is simulated; other "
                    "channels over the points. Two standard deviations to either side of what was measured." }
                (legend(&looks))
                (grid(first))
                @if !rest.is_empty() { (folded(&format!("{} more", rest.len()), &grid(rest))) }
            }
        }
    }

    /// Cosine and sine of a harmonic at every point that reads both.
    fn in_plane(&self, [cosine, sine]: [usize; 2]) -> Panel {
        let sines: Vec<&Reading> = self.of_channel(sine).collect();
        let pairs: Vec<[&Reading; 2]> = self
            .of_channel(cosine)
            .filter_map(|own| {
                let other = sines.iter().find(|other| other.point == own.point)?;
                Some([own, *other])
            })
            .collect();
        let series = |look: Look, of: Value| Series {
            points: pairs.iter().map(|both| both.map(of)).collect(),
            told: pairs
                .iter()
                .map(|both| {
                    let [c, s] = both.map(|own| short(of(own)));
                    format!("{}, {}: {c}, {s}", look.name, self.point(both[0].point))
                })
                .collect(),
            look,
        };
        let links = pairs.iter().flat_map(|both| {
            let [c, s] = both.map(|own| own.measured);
            let [dc, ds] = both.map(|own| WHISKER * own.deviation);
            let whiskers = [[c - dc, s], [c + dc, s], [c, s - ds], [c, s + ds]];
            [[c, s], both.map(|own| own.simulated[0])].into_iter().chain(whiskers)
        });
        let links = Series {
            look: look("", MEASURED, PointForm::Links),
            points: links.collect(),
            told: Vec::new(),
        };
        let names = [cosine, sine].map(|own| self.channel(own));
        let [cosine, sine] = names.map(|own| own.split('_'));
        // what both names share: the load and the harmonic
        let shared = cosine.zip(sine).filter(|(a, b)| a == b).map(|own| own.0);
        Panel {
            title: shared.collect::<Vec<_>>().join("_"),
            axes: names.map(str::to_owned),
            is_equal: true,
            series: self.three(links, &series),
            ..Panel::default()
        }
    }

    /// Measured, before and after, on top of whiskers or links.
    fn three(&self, below: Series, series: &dyn Fn(Look, Value) -> Series) -> Vec<Series> {
        let mut all = vec![
            below,
            series(look("measured", MEASURED, PointForm::Dots), |own| own.measured),
            series(look("simulated", BEFORE, PointForm::Rings), |own| own.simulated[0]),
        ];
        if self.has_after() {
            let after = look(&format!("simulated {}", self.after()), AFTER, PointForm::Crosses);
            all.push(series(after, |own| own.simulated[1]));
        }
        all
    }

    /// The condition that alone varies over the measured points, if there is one.
    fn only_condition(&self) -> Option<usize> {
        let table = self.table;
        let varies = |k: &usize| {
            let mut own = self.found.measured.iter().map(|&p| table.points[p].conditions[*k]);
            let first = own.next().unwrap_or_default();
            own.any(|value| (value - first).abs() > 1e-9 * first.abs())
        };
        let mut varied = (0..table.conditions.len()).filter(varies);
        varied.next().filter(|_| varied.next().is_none())
    }

    /// A channel over the points, or over the condition that alone varies.
    fn over_points(&self, channel: usize) -> Panel {
        let condition = self.only_condition();
        let row = |own: &Reading| self.found.measured.iter().position(|&p| p == own.point);
        let place = |own: &Reading| {
            let value = condition.map(|k| self.table.points[own.point].conditions[k]);
            value.unwrap_or_else(|| row(own).unwrap_or_default() as f64 + 1.0)
        };
        let readings: Vec<&Reading> = self.of_channel(channel).collect();
        let series = |look: Look, of: Value| Series {
            points: readings.iter().map(|own| [place(own), of(own)]).collect(),
            told: readings
                .iter()
                .map(|own| format!("{}, {}: {}", look.name, self.point(own.point), short(of(own))))
                .collect(),
            look,
        };
        let whiskers = readings.iter().flat_map(|own| {
            [-WHISKER, WHISKER].map(|by| [place(own), by.mul_add(own.deviation, own.measured)])
        });
        let whiskers = Series {
            look: look("", MEASURED, PointForm::Links),
            points: whiskers.collect(),
            told: Vec::new(),
        };
        let own = &self.table.channels[channel];
        let x = condition.map_or("point, in the order of the table", |k| &self.table.conditions[k]);
        Panel {
            title: own.name.clone(),
            axes: [x.to_owned(), if own.unit == "1" { String::new() } else { own.unit.clone() }],
            series: self.three(whiskers, &series),
            ..Panel::default()
        }
    }

    /// A map of a value of every reading, by point and channel.
    fn map(&self, title: &str, note: String, value: &dyn Fn(usize) -> f64) -> HeatMap {
        let channels = self.channels();
        let mut values = vec![vec![None; self.found.measured.len()]; channels.len()];
        for (i, own) in self.found.readings.iter().enumerate() {
            let row = channels.iter().position(|&c| c == own.channel);
            let column = self.found.measured.iter().position(|&p| p == own.point);
            if let (Some(row), Some(column)) = (row, column) {
                values[row][column] = Some(value(i));
            }
        }
        let most = self.found.readings.iter().map(|own| own.residual[0].abs()).fold(0.0, f64::max);
        HeatMap {
            title: title.to_owned(),
            note,
            rows: channels.iter().map(|&c| self.channel(c).to_owned()).collect(),
            columns: self.found.measured.iter().map(|&p| self.point(p).to_owned()).collect(),
            values,
            limit: most.clamp(FULL[0], FULL[1]),
            unit: " sd",
            ..HeatMap::default()
        }
    }

    fn residual_map(&self, which: usize) -> HeatMap {
        let readings = &self.found.readings;
        let [left, missed] = [
            rms(readings.iter().map(|own| own.residual[which])),
            rms(readings.iter().map(|own| own.misfit()[which])),
        ]
        .map(short);
        let note = format!("rms {left} sd; nothing taken off {missed} sd");
        let title = if which == 0 { "before" } else { self.after() };
        self.map(title, note, &|i| readings[i].residual[which])
    }

    /// What is left at every point, before and after.
    fn residuals(&self) -> Markup {
        html! {
            section.residuals {
                h2 { "What is left, point by point" }
                p { "Measured less simulated in standard deviations, that of the error of the simulation included; what is "
                    "known of the errors of readings and simulation is taken off. Orange: measured more, blue: less." }
                div.grid.wide {
                    (self.residual_map(0).markup())
                    @if self.has_after() { (self.residual_map(1).markup()) }
                }
            }
        }
    }

    /// What each explanation does, beside what is to be explained.
    fn fingerprints(&self) -> Markup {
        let found = &self.found;
        html! {
            section.fingerprints {
                h2 { "Fingerprints" }
                @if found.fingerprints.is_empty() { p { "No suspect promised enough to be fitted." } }
                @else {
                    p { "What is measured less simulated, and what each explanation adds as fitted. The right cause looks like "
                        "the first map where its effect is large beside the errors of readings and simulation. The square of "
                        "the likeness is the part of chi-square that it takes off, scaled freely." }
                    (self.effect_maps(true))
                    (folded("The same, what is known of the errors taken off", &self.effect_maps(false)))
                }
            }
        }
    }

    /// The residual and what each explanation does, with nothing taken off or with what is known of the errors.
    fn effect_maps(&self, is_raw: bool) -> Markup {
        let readings = &self.found.readings;
        let of = |i: usize| {
            let own: &Reading = &readings[i];
            if is_raw { own.misfit()[0] } else { own.residual[0] }
        };
        let limit = (0..readings.len()).map(|i| of(i).abs()).fold(0.0, f64::max);
        let limit = limit.clamp(FULL[0], FULL[1]);
        let map = |title: &str, note: String, value: &dyn Fn(usize) -> f64| {
            HeatMap { limit, ..self.map(title, note, value) }.markup()
        };
        html! {
            div.grid.wide {
                (map("residual", String::new(), &of))
                @for own in &self.found.fingerprints {
                    @let effect = if is_raw { own.adds.concat() } else { own.shows.concat() };
                    @let name = self.found.candidates[own.candidate].id;
                    (map(name, standing_note(own), &|i| effect[i]))
                }
            }
        }
    }

    /// The error of every channel on points held out.
    fn held_out(&self) -> Markup {
        if self.found.gains.is_empty() {
            return html! {};
        }
        let row = |own: &ChannelGain| {
            let [before, after] = own.in_deviations;
            let unit = &self.table.channels[own.channel].unit;
            let told = |name: &str, rms: f64, value: f64| {
                format!("{name}: {} {unit}, {} sd", short(rms), short(value))
            };
            Row {
                label: self.channel(own.channel).to_owned(),
                note: format!("{} to {}", short(before), short(after)),
                marks: vec![
                    mark(MarkForm::Ring, BEFORE, before, told("before", own.rms_before, before)),
                    mark(MarkForm::Dot, AFTER, after, told("after", own.rms_after, after)),
                ],
                ..Row::default()
            }
        };
        let rows: Vec<Row> = self.found.gains.iter().map(row).collect();
        let axis = "error on points held out, rms, standard deviations of the readings".to_owned();
        let looks =
            [look("before", BEFORE, PointForm::Rings), look(self.after(), AFTER, PointForm::Dots)];
        html! {
            section.gain {
                h2 { "Gain on points that no fit has seen" }
                (legend(&looks))
                (Rows { axis, scale: scale_for(&rows), rows }.markup())
            }
        }
    }

    /// What is not known, beside what the first explanation does.
    fn floors(&self) -> Markup {
        let leading = self.found.fingerprints.first();
        let name = leading.map(|own| self.found.candidates[own.candidate].id);
        let colour = leading.map_or(AFTER, colour_of);
        let row = |own: &ChannelFloor| {
            let of = |form, colour, value: f64, name: &str| {
                mark(form, colour, value, format!("{name}: {} sd", short(value)))
            };
            let mut marks = vec![
                of(MarkForm::Tick, MEASURED, 1.0, "the readings"),
                of(MarkForm::Ring, BEFORE, own.model_error, "error of the simulation"),
                of(MarkForm::Ring, 4, own.alternatives, "other models"),
                of(MarkForm::Ring, MEASURED, own.uncertain, "uncertain inputs"),
            ];
            let mut note = String::new();
            if let (Some(name), Some([adds, shows])) = (name, own.effects.first()) {
                marks.push(of(MarkForm::Ring, colour, *adds, name));
                marks.push(of(MarkForm::Dot, colour, *shows, &format!("{name}, beyond these")));
                note = format!("{}, seen {}", short(*adds), short(*shows));
            }
            Row { label: self.channel(own.channel).to_owned(), note, marks, is_strong: false }
        };
        let rows = self.found.floors.iter().map(row).collect();
        let mut looks = vec![
            look("error of the simulation", BEFORE, PointForm::Rings),
            look("other models thought as good", 4, PointForm::Rings),
            look("uncertain inputs", MEASURED, PointForm::Rings),
        ];
        if let Some(name) = name {
            looks.push(look(name, colour, PointForm::Rings));
            looks.push(look("what of it none of these explains", colour, PointForm::Dots));
        }
        let axis = "rms over the points, standard deviations of the readings".to_owned();
        html! {
            section.floors {
                h2 { "What is not known, beside what the cause does" }
                p { "The stroke is one standard deviation of the readings." }
                (legend(&looks))
                (Rows { axis, scale: RowScale::LogFrom(0.1), rows }.markup())
            }
        }
    }

    /// The yardstick: from which amount on each suspect would have been seen.
    fn would_have_shown(&self, findings: &Findings, words: &Words) -> Markup {
        let mut sizes: Vec<(String, f64, String)> = Vec::new();
        for (own, limit) in self.table.suspects.iter().zip(&self.found.finding.limits) {
            let Some(size) = *limit else { continue };
            let value = findings.would_have_shown.get(own.name).copied().flatten();
            let value = value.map(short).unwrap_or_default();
            let unit = own.parameters.first().map_or("", |p| p.unit);
            let unit = if unit == "1" { "" } else { unit };
            match sizes.iter_mut().find(|other| other.0 == own.name) {
                Some(other) => other.1 = other.1.min(size),
                None => sizes.push((own.name.to_owned(), size, format!("{value} {unit}"))),
            }
        }
        let axis = "size that would have been seen, over an amount that matters";
        yardstick((findings, words), &sizes, (axis, Some(1.0)))
    }

    /// Every reading, in numbers.
    fn readings(&self) -> Section {
        let rows = self.found.readings.iter().map(|own| {
            let [before, after] = own.residual.map(|value| format!("{value:.2}"));
            let [simulated, with] = own.simulated.map(short);
            let channel = &self.table.channels[own.channel];
            let [measured, deviation] = [own.measured, own.deviation].map(short);
            let names = [self.point(own.point), &channel.name, &channel.unit].map(str::to_owned);
            let numbers = [measured, deviation, simulated, with, before, after];
            names.into_iter().chain(numbers).collect()
        });
        let header = [
            "point",
            "channel",
            "unit",
            "measured",
            "sd",
            "simulated",
            "with the fit",
            "left, sd",
            "left with the fit, sd",
        ];
        Section {
            title: format!("{} readings", self.found.readings.len()),
            text: String::new(),
            header: header.map(str::to_owned).into(),
            rows: rows.collect(),
        }
    }

    /// What each explanation does to every channel, in numbers.
    fn effects(&self) -> Section {
        let found = &self.found;
        let causes = found.fingerprints.iter();
        let names = causes.map(|own| match own.standing {
            Standing::Found => format!("{} (found)", found.candidates[own.candidate].id),
            _ => found.candidates[own.candidate].id.to_owned(),
        });
        let head = ["channel", "residual before", "residual after"].map(str::to_owned);
        let row = |own: &ChannelFloor| {
            let left = |which: usize| {
                let over = |r: &Reading| r.residual[which] * r.sigma / r.deviation;
                rms(self.of_channel(own.channel).map(over))
            };
            let numbers = [left(0), left(1)].into_iter().chain(own.effects.iter().map(|e| e[1]));
            let name = self.channel(own.channel).to_owned();
            std::iter::once(name).chain(numbers.map(short)).collect()
        };
        Section {
            title: "Residual and effects by channel".to_owned(),
            text: "rms over the points, standard deviations of the readings.".to_owned(),
            header: head.into_iter().chain(names).collect(),
            rows: found.floors.iter().map(row).collect(),
        }
    }
}

fn mark(form: MarkForm, colour: usize, value: f64, told: String) -> Mark {
    Mark { form, colour, value, told }
}
