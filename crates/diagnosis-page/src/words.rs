//! What is said of a diagnosis.

use report_page::Section;

/// What is said of a diagnosis, part by part: lines as a terminal shows them, indented where they explain the one above.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Words {
    /// Title of the data.
    pub title: String,
    /// The verdict in a sentence or two.
    pub verdict: String,
    /// What was found, how sure it is, and why.
    pub why: String,
    /// What it gains on data that no fit has seen; empty where that is told by channel.
    pub gain: String,
    /// What to measure next; empty where nothing is open.
    pub next: String,
    /// What it rests on, the title first.
    pub ground: String,
    /// What a reader should know besides.
    pub notes: Vec<String>,
    /// What the data cannot show; none where they may show everything.
    pub not_observable: Option<String>,
    /// The screening of every suspect.
    pub screening: Section,
    /// Name and version of the program.
    pub program: String,
}
