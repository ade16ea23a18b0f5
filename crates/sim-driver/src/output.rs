//! Tables for people and JSON for programs.

use crate::SimError;
use serde::Serialize;
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
    /// [`SimError::NotWritten`] if JSON cannot express the result.
    fn render(&self, format: Format) -> Result<String, SimError> {
        let mut text = match format {
            Format::Text => self.text(),
            Format::Details => self.details(),
            Format::Json => serde_json::to_string_pretty(self)
                .map_err(|e| SimError::NotWritten { path: "JSON".into(), reason: e.to_string() })?,
        };
        if !text.ends_with('\n') {
            text.push('\n');
        }
        Ok(text)
    }
}

/// Prints to standard output; a reader that has gone away (`| head`) is no error.
///
/// # Errors
/// [`SimError::NotWritten`] if standard output cannot take the text.
pub fn print(text: &str) -> Result<(), SimError> {
    let mut out = std::io::stdout().lock();
    match out.write_all(text.as_bytes()).and_then(|()| out.flush()) {
        Err(e) if e.kind() != std::io::ErrorKind::BrokenPipe => {
            Err(SimError::NotWritten { path: "standard output".into(), reason: e.to_string() })
        }
        _ => Ok(()),
    }
}

/// Text that grows by lines and tables.
#[derive(Debug, Clone, Default)]
pub struct Sheet {
    text: String,
}

impl Sheet {
    /// Adds a line: `sheet.line(format_args!(...))`.
    pub fn line(&mut self, line: std::fmt::Arguments<'_>) {
        self.text.push_str(&line.to_string());
        self.text.push('\n');
    }

    /// Adds a table or any text that ends in a line end.
    pub fn block(&mut self, text: &str) {
        self.text.push_str(text);
    }

    /// The text.
    pub fn finish(self) -> String {
        self.text
    }
}

/// Width and height of a terminal that a summary fits.
pub const SCREEN: [usize; 2] = [100, 45];

/// Text of one screen: lines of at most 100 columns, at most 45 of them.
#[derive(Debug, Clone, Default)]
pub struct Screen {
    lines: Vec<String>,
}

impl Screen {
    /// Adds a line, or several.
    pub fn line(&mut self, text: &str) {
        self.lines.extend(text.split('\n').map(str::to_owned));
    }

    /// Adds a table.
    pub fn block(&mut self, text: &str) {
        self.lines.extend(text.lines().map(str::to_owned));
    }

    /// Adds a sentence, broken into lines.
    pub fn wrapped(&mut self, text: &str) {
        self.lines.extend(wrap(text, SCREEN[0]));
    }

    /// Adds lines, each broken where it is too long; what follows keeps its indentation.
    pub fn paragraphs(&mut self, text: &str) {
        for line in text.lines() {
            let indent = line.len() - line.trim_start().len();
            let broken = wrap(line, SCREEN[0] - indent);
            self.lines.extend(broken.iter().map(|part| format!("{:indent$}{part}", "")));
            if broken.is_empty() {
                self.lines.push(String::new());
            }
        }
    }

    /// Adds a sentence behind a name, broken into lines.
    pub fn labelled(&mut self, label: &str, text: &str) {
        for (k, line) in wrap(text, SCREEN[0] - LABEL).into_iter().enumerate() {
            let label = if k == 0 { label } else { "" };
            self.lines.push(format!("{label:LABEL$}{line}"));
        }
    }

    /// The text; what does not fit is left out, which the last line says.
    pub fn finish(mut self) -> String {
        let [width, height] = SCREEN;
        let more = self.lines.len().saturating_sub(height);
        if more > 0 {
            self.lines.truncate(height - 1);
            self.lines.push(format!("... {} more lines with --details", more + 1));
        }
        let fitted = self.lines.iter().map(|line| clipped(line, width) + "\n");
        fitted.collect()
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

/// Warnings for standard error, each once and short; `rest` says where all of them are.
pub fn warnings_text<T: std::fmt::Display>(warnings: &[T], format: Format, rest: &str) -> String {
    let mut all: Vec<String> = Vec::new();
    for warning in warnings.iter().map(T::to_string) {
        if !all.contains(&warning) {
            all.push(warning);
        }
    }
    let mut shown: Vec<String> = Vec::new();
    let most = if format == Format::Text { MOST_WARNINGS } else { all.len() };
    for warning in all.iter().take(most) {
        let warning = format!("warning: {warning}");
        if format != Format::Text {
            shown.push(warning);
            continue;
        }
        let mut lines = wrap(&warning, SCREEN[0]);
        if lines.len() > WARNING_LINES {
            lines.truncate(WARNING_LINES);
            if let Some(last) = lines.last_mut() {
                let kept: String = last.chars().take(SCREEN[0] - 4).collect();
                *last = format!("{} ...", kept.trim_end());
            }
        }
        shown.extend(lines);
    }
    if let more @ 1.. = all.len().saturating_sub(most) {
        shown.push(format!("warning: {more} more {rest}"));
    }
    shown.iter().map(|line| line.to_owned() + "\n").collect()
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
