//! Tables for people and JSON for programs.

use crate::SimError;
use serde::Serialize;
use std::io::Write;

/// Form of what a command prints.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, clap::ValueEnum)]
pub enum Format {
    /// Tables for people.
    #[default]
    Text,
    /// JSON for programs.
    Json,
}

/// A result that can be printed either way.
pub trait Printable: Serialize {
    /// The tables.
    fn text(&self) -> String;

    /// The text of a format, ending in a line end. Numbers that are not finite are `null` in JSON.
    ///
    /// # Errors
    /// [`SimError::NotWritten`] if JSON cannot express the result.
    fn render(&self, format: Format) -> Result<String, SimError> {
        let mut text = match format {
            Format::Text => self.text(),
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
