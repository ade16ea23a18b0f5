//! Tables for people and JSON for programs.

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

/// Width and height of a terminal that a summary fits.
pub const SCREEN: [usize; 2] = [100, 45];

/// Text that grows by lines and tables.
#[derive(Debug, Clone, Default)]
pub struct Sheet {
    text: String,
}

impl Sheet {
    /// Adds a line, or several: a text, or `format_args!(...)`.
    pub fn line(&mut self, line: impl Display) {
        self.text.push_str(&line.to_string());
        self.text.push('\n');
    }

    /// Adds a table or any text that ends in a line end.
    pub fn block(&mut self, text: &str) {
        self.text.push_str(text);
    }

    /// Adds lines, each broken where it is too long; what follows keeps its indentation.
    pub fn paragraphs(&mut self, text: &str) {
        for line in text.lines() {
            let indent = line.len() - line.trim_start().len();
            let broken = wrap(line, SCREEN[0] - indent);
            for part in &broken {
                self.line(format_args!("{:indent$}{part}", ""));
            }
            if broken.is_empty() {
                self.line("");
            }
        }
    }

    /// Adds a sentence behind a name, broken into lines.
    pub fn labelled(&mut self, label: &str, text: &str) {
        for (k, line) in wrap(text, SCREEN[0] - LABEL).into_iter().enumerate() {
            let label = if k == 0 { label } else { "" };
            self.line(format_args!("{label:LABEL$}{line}"));
        }
    }

    /// The whole text.
    pub fn finish(self) -> String {
        self.text
    }

    /// The text as one screen: what does not fit is left out, which the last line says.
    pub fn screen(&self) -> String {
        let [width, height] = SCREEN;
        let mut lines: Vec<&str> = self.text.lines().collect();
        let more = lines.len().saturating_sub(height);
        let rest = format!("... {} more lines with --details", more + 1);
        if more > 0 {
            lines.truncate(height - 1);
            lines.push(&rest);
        }
        lines.into_iter().map(|line| clipped(line, width) + "\n").collect()
    }
}

/// Columns of the name of a sentence.
const LABEL: usize = 11;

/// A line cut to a width.
fn clipped(line: &str, width: usize) -> String {
    if line.chars().count() <= width {
        return line.trim_end().to_owned();
    }
    let kept: String = line.chars().take(width - 3).collect();
    kept.trim_end().to_owned() + "..."
}

/// A sentence broken at blanks.
pub fn wrap(text: &str, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for word in text.split_whitespace() {
        match lines.last_mut() {
            Some(line) if line.chars().count() + 1 + word.chars().count() <= width => {
                line.push(' ');
                line.push_str(word);
            }
            _ => lines.push(word.to_owned()),
        }
    }
    lines
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

/// Items in their order, each once.
pub(crate) fn unique<T: PartialEq>(items: impl IntoIterator<Item = T>) -> Vec<T> {
    items.into_iter().fold(Vec::new(), |mut kept, item| {
        if !kept.contains(&item) {
            kept.push(item);
        }
        kept
    })
}

/// A column of a table: its head, and its cell in the row of an item.
pub(crate) type Column<'a, T> = (&'a str, &'a dyn Fn(&T) -> String);

/// A table with a row for each item.
pub(crate) fn table_of<T>(items: impl IntoIterator<Item = T>, columns: &[Column<'_, T>]) -> String {
    let header: Vec<&str> = columns.iter().map(|(head, _)| *head).collect();
    table(&header, cells(items, columns))
}

/// The same as CSV text.
pub(crate) fn csv_of<T>(items: impl IntoIterator<Item = T>, columns: &[Column<'_, T>]) -> String {
    let header = columns.iter().map(|(head, _)| (*head).to_owned()).collect();
    let rows = std::iter::once(header).chain(cells(items, columns));
    rows.map(|row: Vec<String>| row.join(",") + "\n").collect()
}

fn cells<T>(
    items: impl IntoIterator<Item = T>,
    columns: &[Column<'_, T>],
) -> impl Iterator<Item = Vec<String>> {
    let row = move |item| columns.iter().map(|(_, cell)| cell(&item)).collect();
    items.into_iter().map(row)
}

/// A plain table with a header and aligned columns.
pub fn table(header: &[&str], rows: impl IntoIterator<Item = Vec<String>>) -> String {
    use comfy_table::{CellAlignment, Table, presets::NOTHING};
    let mut table = Table::new();
    table.load_style(NOTHING).set_header(header.to_vec());
    for row in rows {
        table.add_row(row);
    }
    for index in 1..header.len() {
        if let Some(column) = table.column_mut(index) {
            column.set_cell_alignment(CellAlignment::Right);
        }
    }
    table.lines().map(|line| line.trim_end().to_owned() + "\n").collect()
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
