//! The page of a flight: what happened against time, controllers beside each other.

use super::FlightResult;
use crate::results::flap_name;
use maud::{Markup, html};
use report_page::pictures::{Look, Panel, PointForm, Series, legend};
use report_page::{Charts, page};
use rotor_flight::{
    FlightPoint, FlownController, controllers_section, draws_pictures, draws_section,
    failures_section, load_amplitudes, margins_pictures, margins_section,
};
use rotor_study::HubLoads;

/// A quantity of a cycle.
type Of<'a> = &'a dyn Fn(&FlightPoint) -> f64;

fn line(name: &str, colour: usize, points: &[FlightPoint], of: Of<'_>) -> Series {
    Series {
        look: Look { name: name.to_owned(), colour, form: PointForm::Line },
        points: points.iter().map(|point| [point.time_s, of(point)]).collect(),
        told: vec![],
    }
}

fn panel(title: &str, axis: &str, series: Vec<Series>) -> Markup {
    let axes = ["time, s".to_owned(), axis.to_owned()];
    Panel { title: title.to_owned(), axes, series, ..Panel::default() }.markup()
}

/// What the lines of a picture mean.
fn looks(series: &[Series]) -> Markup {
    legend(&series.iter().map(|own| own.look.clone()).collect::<Vec<_>>())
}

impl FlightResult {
    /// A line of a quantity for every controller, and a grey one of the first flight if there is one without control.
    fn lines(&self, of: Of<'_>, at_rest: Option<Of<'_>>) -> Vec<Series> {
        let flights = &self.flown.flights;
        let without = flights.first().zip(at_rest);
        let without = without.map(|(own, of)| line("without control", 0, &own.points, of));
        let each = flights.iter().enumerate();
        let each = each.map(|(k, own)| line(own.controller, k + 1, &own.points, of));
        without.into_iter().chain(each).collect()
    }

    /// Hub loads against time.
    fn loads(&self) -> Markup {
        html! {
            @for (k, name) in HubLoads::NAMES.iter().enumerate() {
                @let of = |point: &FlightPoint| load_amplitudes(point.loads, self.units)[k];
                @let rest = |point: &FlightPoint| load_amplitudes(point.loads_at_rest, self.units)[k];
                @let unit = if k < 3 { "N" } else { "N m" };
                (panel(
                    &format!("{} at {}/rev", name.to_uppercase(), self.blades),
                    &format!("amplitude, {unit}"),
                    self.lines(&of, Some(&rest)),
                ))
            }
        }
    }

    /// What blades alike cancel, against time.
    fn off_blade_number(&self) -> Markup {
        html! {
            @let once_at_rest = |point: &FlightPoint| point.off_blade_number_at_rest[0];
            @let others_at_rest = |point: &FlightPoint| point.off_blade_number_at_rest[1];
            (panel(
                "J at 1/rev over J0",
                "J/J0",
                self.lines(&|p| p.once_per_rev_ratio, Some(&once_at_rest)),
            ))
            (panel(
                "J at the other harmonics over J0",
                "J/J0",
                self.lines(&|p| p.other_ratio, Some(&others_at_rest)),
            ))
        }
    }

    /// Voltages of every flap, and the power.
    fn voltages(&self) -> Markup {
        let flaps = self.flown.flights.first().and_then(|own| own.points.first());
        html! {
            @for flap in 0..flaps.map_or(0, |point| point.volt.len()) {
                @let highest = self.lines(&|point| point.volt[flap][1], None);
                @let lowest = self.lines(&|point| point.volt[flap][0], None);
                (panel(
                    &format!("{}: highest and lowest voltage", flap_name(flap)),
                    "voltage, V",
                    highest.into_iter().chain(lowest).collect(),
                ))
            }
            (panel("Power of the actuators of one blade", "power, W", self.lines(&|p| p.power_watt, None)))
        }
    }

    /// Harmonics of one flap under one controller: those commanded, and the largest of the others.
    fn harmonics(&self, own: &FlownController, flap: usize) -> Vec<Series> {
        let commanded = self.harmonics.iter().enumerate();
        let largest = |point: &FlightPoint| {
            let each = point.flap_deg[flap].iter().enumerate();
            let others = each.filter(|(k, _)| !self.harmonics.contains(&(k + 1)));
            others.map(|(_, deg)| *deg).fold(0.0, f64::max)
        };
        let mut lines: Vec<Series> = commanded
            .map(|(k, &n)| {
                let of = |point: &FlightPoint| point.flap_deg[flap][n - 1];
                line(&format!("{n}/rev"), 1 + k % 4, &own.points, &of)
            })
            .collect();
        lines.push(line("largest not commanded", 0, &own.points, &largest));
        lines
    }

    /// Harmonics of all flaps under every controller.
    fn motions(&self) -> Markup {
        let flaps = self.flown.flights.first().and_then(|own| own.points.first());
        let flaps = flaps.map_or(0, |point| point.flap_deg.len());
        html! {
            @if let Some(first) = self.flown.flights.first() { (looks(&self.harmonics(first, 0))) }
            div.grid {
                @for own in &self.flown.flights {
                    @for flap in 0..flaps {
                        (panel(
                            &format!("{}, {} T", flap_name(flap), own.controller),
                            "amplitude, deg",
                            self.harmonics(own, flap),
                        ))
                    }
                }
            }
        }
    }
}

/// The flight on one page.
pub fn flight_html(of: &FlightResult) -> String {
    let first = of.flown.flights.first().map(|own| own.points.as_slice()).unwrap_or_default();
    let cost = of.lines(&|point| point.cost_ratio, Some(&|_| 1.0));
    let speed = vec![line("advance ratio", 1, first, &|point| point.advance_ratio)];
    let thrust = vec![line("thrust", 1, first, &|point| point.thrust_share)];
    let is_unlike = first.iter().any(|point| point.other_ratio > 0.0);
    let steps = first.iter().any(|point| point.thrust_share > 0.0);
    let body = html! {
        header {
            h1 { (of.title) }
            @for note in &of.notes { p { (note) } }
        }
        @if !of.warnings.is_empty() {
            section.warnings {
                h2 { "Read first" }
                ul { @for warning in &of.warnings { li { (warning) } } }
            }
        }
        (controllers_section(&of.flown))
        section {
            h2 { "J, loads, voltages" }
            p { "A point for each cycle, of the loads without noise." }
            (looks(&cost))
            div.grid {
                (panel("J over J without control", "J/J0", cost))
                @if is_unlike { (of.off_blade_number()) }
                (panel("Speed", "advance ratio", speed))
                @if steps { (panel("Part of the step of the thrust", "part", thrust)) }
                (of.loads())
                (of.voltages())
            }
        }
        section {
            h2 { "Flaps" }
            p { "What is not commanded comes of the hysteresis: the harmonics mix." }
            (of.motions())
        }
        @if let Some(drawn) = &of.drawn {
            (draws_section(drawn))
            @for part in draws_pictures(drawn) { (part) }
        }
        @if let Some(study) = &of.margins {
            (margins_section(study))
            @for part in margins_pictures(study) { (part) }
        }
        @if let Some(study) = &of.failures { (failures_section(study)) }
    };
    page(&of.title, &body, &Charts::default())
}
