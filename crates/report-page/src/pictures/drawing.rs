//! SVG elements as text.

use maud::{Markup, PreEscaped, html};
use std::fmt::{Arguments, Write as _};

/// Elements of a picture, one after another.
#[derive(Debug, Clone, Default)]
pub struct Drawing {
    /// The elements as SVG text.
    pub text: String,
}

impl Drawing {
    /// Adds an element: its name, its attributes, and what it tells where a pointer rests on it; nothing if that is empty.
    pub fn element(&mut self, name: &str, attributes: Arguments<'_>, told: &str) {
        // writing to a string cannot fail
        let _ = if told.is_empty() {
            writeln!(self.text, "<{name} {attributes}/>")
        } else {
            writeln!(self.text, "<{name} {attributes}><title>{}</title></{name}>", escaped(told))
        };
    }

    /// Adds words at a place, px.
    pub fn text(&mut self, [x, y]: [f64; 2], class: &str, words: &str) {
        let _ = writeln!(
            self.text,
            "<text x=\"{x:.1}\" y=\"{y:.1}\" class=\"{class}\">{}</text>",
            escaped(words)
        );
    }

    /// Adds words at a place, px, that run upwards.
    pub fn turned_text(&mut self, [x, y]: [f64; 2], class: &str, words: &str) {
        let _ = writeln!(
            self.text,
            "<text transform=\"translate({x:.1} {y:.1}) rotate(-90)\" class=\"{class}\">{}</text>",
            escaped(words)
        );
    }

    /// Adds a rectangle: left upper corner, width and height, px.
    pub fn bar(&mut self, [x, y]: [f64; 2], [width, height]: [f64; 2], class: &str) {
        let at = format_args!(
            "x=\"{x:.1}\" y=\"{y:.1}\" width=\"{width:.1}\" height=\"{height:.1}\" class=\"{class}\""
        );
        self.element("rect", at, "");
    }

    /// Adds a straight line between two places, px.
    pub fn line(&mut self, [x1, y1]: [f64; 2], [x2, y2]: [f64; 2], class: &str) {
        let at = format_args!(
            "x1=\"{x1:.1}\" y1=\"{y1:.1}\" x2=\"{x2:.1}\" y2=\"{y2:.1}\" class=\"{class}\""
        );
        self.element("line", at, "");
    }

    /// The picture, of a width and height in px that scale with the page.
    pub fn markup(self, [width, height]: [f64; 2]) -> Markup {
        html! {
            svg class="pic" role="img" viewBox=(format!("0 0 {width:.0} {height:.0}")) {
                (PreEscaped(self.text))
            }
        }
    }
}

/// Text that cannot end the element it stands in.
pub fn escaped(text: &str) -> String {
    text.replace('&', "&amp;").replace('<', "&lt;").replace('>', "&gt;")
}

/// A name cut to so many characters.
pub(super) fn clipped(name: &str, most: usize) -> String {
    if name.chars().count() <= most {
        return name.to_owned();
    }
    let kept: String = name.chars().take(most - 1).collect();
    kept + "\u{2026}"
}
