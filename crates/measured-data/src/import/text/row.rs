//! Lines of a text table in cells.

/// A line of the head, in cells.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Row {
    pub(super) cells: Vec<String>,
    /// Its text, of a comment without the mark.
    pub(super) text: String,
    pub(super) is_comment: bool,
}

impl Row {
    pub(super) fn of(line: &str, separator: char) -> Self {
        let line = line.trim_end_matches(['\n', '\r']);
        let bare = line.trim_start();
        let is_comment = bare.starts_with(['#', '%']) || bare.starts_with("//");
        let text = if is_comment { bare.trim_start_matches(['#', '%', '/']) } else { line };
        Self { cells: cells(text, separator), text: text.to_owned(), is_comment }
    }

    /// Its cells without the blank ones at the end.
    pub(super) fn filled(&self) -> &[String] {
        let count = self.cells.iter().rposition(|cell| !cell.is_empty()).map_or(0, |at| at + 1);
        &self.cells[..count]
    }
}

/// The cells of a line, without quotes; where blanks separate, several are as good as one.
pub(super) fn cells(line: &str, separator: char) -> Vec<String> {
    let mut is_quoted = false;
    let parts = line.split(|c: char| {
        is_quoted ^= c == '"';
        !is_quoted && (c == separator || separator == ' ' && c == '\t')
    });
    let plain = parts.map(|part| part.trim().trim_matches('"').trim().to_owned());
    plain.filter(|cell| separator != ' ' || !cell.is_empty()).collect()
}
