//! A heading with a table, for the terminal and for a page.

use crate::text::{Sheet, table};
use maud::{Markup, Render, html};
use std::fmt;

/// A table with its heading.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Section {
    /// Heading.
    pub title: String,
    /// A sentence or two.
    pub text: String,
    /// Column heads.
    pub header: Vec<String>,
    /// Rows.
    pub rows: Vec<Vec<String>>,
}

/// For the terminal.
impl fmt::Display for Section {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let header: Vec<&str> = self.header.iter().map(String::as_str).collect();
        let mut sheet = Sheet::default();
        sheet.paragraphs(&format!("\n{}. {}", self.title, self.text));
        sheet.block(&table(&header, self.rows.iter().cloned()));
        f.write_str(&sheet.finish())
    }
}

impl Section {
    /// The table alone, for a page.
    pub fn table(&self) -> Markup {
        html! {
            div.scroll { table {
                thead { tr { @for head in &self.header { th { (head) } } } }
                tbody { @for row in &self.rows { tr {
                    @for (i, cell) in row.iter().enumerate() {
                        @if i == 0 { th { (cell) } } @else { td { (cell) } }
                    }
                } } }
            } }
        }
    }

    /// The table behind its title and its sentence, for a page.
    pub fn folded(&self) -> Markup {
        html! {
            details {
                summary { (self.title) }
                @if !self.text.is_empty() { p { (self.text) } }
                (self.table())
            }
        }
    }
}

/// For a page.
impl Render for Section {
    fn render(&self) -> Markup {
        html! {
            section {
                h2 { (self.title) }
                @if !self.text.is_empty() { p { (self.text) } }
                (self.table())
            }
        }
    }
}
