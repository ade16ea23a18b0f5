//! The languages.

pub(crate) mod c;
pub(crate) mod json;
pub(crate) mod matlab;
pub(crate) mod python;

use crate::library::filled;
use crate::plan::Plan;

/// A text with the words of a plan and more filled in.
fn with(plan: &Plan<'_>, text: &str, more: &[(&str, &str)]) -> String {
    let words = plan.words();
    let words: Vec<(&str, &str)> = words.iter().map(|(key, word)| (*key, word.as_str())).collect();
    filled(&filled(text, more), &words)
}
