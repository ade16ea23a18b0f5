//! Lines and tables of a terminal.

use std::fmt::Display;

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

/// Items in their order, each once.
pub fn unique<T: PartialEq>(items: impl IntoIterator<Item = T>) -> Vec<T> {
    items.into_iter().fold(Vec::new(), |mut kept, item| {
        if !kept.contains(&item) {
            kept.push(item);
        }
        kept
    })
}

/// A number of things in words: `1 run`, `2 runs`; `one` is the word for one of them.
pub fn counted(count: usize, one: &str) -> String {
    format!("{count} {one}{}", if count == 1 { "" } else { "s" })
}

/// A column of a table: its head, and its cell in the row of an item.
pub type Column<'a, T> = (&'a str, &'a dyn Fn(&T) -> String);

/// A table with a row for each item.
pub fn table_of<T>(items: impl IntoIterator<Item = T>, columns: &[Column<'_, T>]) -> String {
    let header: Vec<&str> = columns.iter().map(|(head, _)| *head).collect();
    table(&header, cells(items, columns))
}

/// The same as CSV text.
pub fn csv_of<T>(items: impl IntoIterator<Item = T>, columns: &[Column<'_, T>]) -> String {
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
