//! Tables for people and JSON for programs.

pub use report_page::{SCREEN, Sheet, table, wrap};
pub(crate) use report_page::{counted, table_of, unique};

use crate::SimError;
use serde::Serialize;
use std::fmt::Display;
use std::io::Write;

/// Form of what a command prints.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum Format {
    /// One screen for people.
    #[default]
    Text,
    /// Every table.
    #[value(skip)]
    Details,
    /// JSON for programs.
    Json,
}

/// A result that can be printed either way.
pub trait Printable: Serialize {
    /// What a person wants to see first.
    fn text(&self) -> String;

    /// Every table; the same where all of it fits one screen.
    fn details(&self) -> String {
        self.text()
    }

    /// The text of a format, ending in a line end. Numbers that are not finite are `null` in JSON.
    ///
    /// # Errors
    /// [`SimError::Data`] if JSON cannot express the result.
    fn render(&self, format: Format) -> Result<String, SimError> {
        let mut text = match format {
            Format::Text => self.text(),
            Format::Details => self.details(),
            Format::Json => json(self)?,
        };
        if !text.ends_with('\n') {
            text.push('\n');
        }
        Ok(text)
    }
}

/// A value as JSON for people to read, ending in a line end.
///
/// # Errors
/// [`SimError::Data`] if JSON cannot express it.
pub fn json(value: &(impl Serialize + ?Sized)) -> Result<String, SimError> {
    let text = serde_json::to_string_pretty(value);
    Ok(text.map_err(|e| SimError::not_written("JSON", &e))? + "\n")
}

/// Prints to standard output; a reader that has gone away (`| head`) is no error.
///
/// # Errors
/// [`SimError::Data`] if standard output cannot take the text.
pub fn print(text: &str) -> Result<(), SimError> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(SimError::not_written("standard output", &e))
        }
        _ => Ok(()),
    }
}

/// Lines of a warning on the terminal, and warnings that are shown.
const WARNING_LINES: usize = 2;
const MOST_WARNINGS: usize = 5;

/// A warning in two lines: how it begins, and its last sentence, which is the remedy.
fn short_warning(warning: &str) -> Vec<String> {
    let lines = wrap(warning, SCREEN[0]);
    if lines.len() <= WARNING_LINES {
        return lines;
    }
    let cut = |text: &str, width: usize| -> String {
        let kept: String = text.chars().take(width - 4).collect();
        let whole = text.chars().count() <= width - 4;
        if whole { kept } else { format!("{} ...", kept.trim_end()) }
    };
    let begins = cut(&format!("{} {}", lines[0], lines[1]), SCREEN[0]);
    match warning.trim_end_matches('.').rsplit_once(". ") {
        Some((_, remedy)) => vec![begins, format!("  {}", cut(remedy, SCREEN[0] - 2))],
        None => vec![lines[0].clone(), cut(&lines[1], SCREEN[0])],
    }
}

/// Warnings for standard error, each once and short; `rest` says where all of them are.
pub fn warnings_text<T: Display>(warnings: &[T], format: Format, rest: &str) -> String {
    let all = unique(warnings.iter().map(T::to_string));
    let is_short = format == Format::Text;
    let most = if is_short { MOST_WARNINGS } else { all.len() };
    let mut shown: Vec<String> = Vec::new();
    for warning in all.iter().take(most).map(|warning| format!("warning: {warning}")) {
        shown.extend(if is_short { short_warning(&warning) } else { vec![warning] });
    }
    if let more @ 1.. = all.len().saturating_sub(most) {
        shown.push(format!("warning: {more} more {rest}"));
    }
    shown.into_iter().map(|line| line + "\n").collect()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_long_warning_keeps_its_beginning_and_its_remedy() {
        let long = format!("a value is strange: {}. Give another one", "very ".repeat(60));
        let text = warnings_text(&[long], Format::Text, "elsewhere");
        let lines: Vec<&str> = text.lines().collect();
        assert_eq!(lines.len(), 2, "{text}");
        assert!(lines[0].starts_with("warning: a value is strange:"), "{text}");
        assert!(lines[0].ends_with(" ...") && lines[0].chars().count() <= SCREEN[0], "{text}");
        assert_eq!(lines[1], "  Give another one");
    }
}
