//! A Rust source as words, without comments and without what is compiled for tests only.

use std::collections::BTreeSet;

/// A word, a sign, or a literal (whose text is left out).
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Token<'a> {
    pub(super) text: &'a str,
    /// First and last line, from 1.
    pub(super) lines: (usize, usize),
}

/// What stands for a string, character or lifetime.
const LITERAL: &str = "\"";

/// A source without its tests.
#[derive(Debug, Clone, Default)]
pub(super) struct Source<'a> {
    /// All words and signs that are left.
    pub(super) tokens: Vec<Token<'a>>,
    /// Modules in files of their own that are compiled for tests only.
    pub(super) test_modules: Vec<&'a str>,
}

impl<'a> Source<'a> {
    pub(super) fn of(text: &'a str) -> Self {
        let all = tokens(text);
        let mut out = Self::default();
        let mut at = 0;
        while let Some(token) = all.get(at) {
            match attribute(&all, at) {
                Some(found) if found.for_tests && found.inner => break,
                Some(found) if found.for_tests => {
                    let end = item_end(&all, found.end);
                    let words: Vec<&str> = all[found.end..end].iter().map(|t| t.text).collect();
                    if let [.., "mod", name, ";"] = words[..] {
                        out.test_modules.push(name);
                    }
                    at = end;
                }
                Some(found) => {
                    out.tokens.extend(&all[at..found.end]);
                    at = found.end;
                }
                None => {
                    out.tokens.push(*token);
                    at += 1;
                }
            }
        }
        out
    }

    /// Lines that hold code.
    pub(super) fn lines_of_code(&self) -> usize {
        let lines = self.tokens.iter().flat_map(|token| token.lines.0..=token.lines.1);
        lines.collect::<BTreeSet<usize>>().len()
    }
}

/// An attribute that begins at a token.
struct Attribute {
    /// The token after it.
    end: usize,
    inner: bool,
    for_tests: bool,
}

fn attribute(all: &[Token<'_>], at: usize) -> Option<Attribute> {
    let text = |i: usize| all.get(i).map_or("", |token| token.text);
    let inner = text(at + 1) == "!";
    let open = at + 1 + usize::from(inner);
    if text(at) != "#" || text(open) != "[" {
        return None;
    }
    let end = closed(all, open);
    let words: Vec<&str> = all[open..end].iter().map(|token| token.text).collect();
    let for_tests = text(open + 1) == "cfg"
        && words.iter().any(|word| ["test", "doctest"].contains(word))
        && !words.contains(&"not");
    Some(Attribute { end, inner, for_tests })
}

/// The token after the bracket that closes the one at `open`.
fn closed(all: &[Token<'_>], open: usize) -> usize {
    let mut depth = 0_usize;
    for (i, token) in all.iter().enumerate().skip(open) {
        match token.text {
            "(" | "[" | "{" => depth += 1,
            ")" | "]" | "}" => depth = depth.saturating_sub(1),
            _ => {}
        }
        if depth == 0 {
            return i + 1;
        }
    }
    all.len()
}

/// The token after the item, with its further attributes, that begins at `at`.
fn item_end(all: &[Token<'_>], mut at: usize) -> usize {
    while let Some(found) = attribute(all, at) {
        at = found.end;
    }
    let is_use = all[at..].iter().take(3).any(|token| token.text == "use");
    while let Some(token) = all.get(at) {
        match token.text {
            ";" => return at + 1,
            "{" if !is_use => return closed(all, at),
            "(" | "[" | "{" => at = closed(all, at),
            _ => at += 1,
        }
    }
    all.len()
}

fn tokens(text: &str) -> Vec<Token<'_>> {
    let mut out = Vec::new();
    let (mut at, mut line) = (0, 1);
    while let Some(first) = text[at..].chars().next() {
        let rest = &text[at..];
        let (length, shown) = match first {
            _ if rest.starts_with("//") => (rest.find('\n').unwrap_or(rest.len()), None),
            _ if rest.starts_with("/*") => (block_comment(rest), None),
            c if c.is_whitespace() => (c.len_utf8(), None),
            '"' => (string(rest), Some(LITERAL)),
            '\'' => (quoted(rest), Some(LITERAL)),
            _ if rest.starts_with("::") => (2, Some("::")),
            c if c.is_alphanumeric() || c == '_' => {
                let word = rest.find(|c: char| !(c.is_alphanumeric() || c == '_'));
                let length = word.unwrap_or(rest.len());
                raw_string(rest).map_or((length, Some(&rest[..length])), |raw| (raw, Some(LITERAL)))
            }
            c => (c.len_utf8(), Some(&rest[..c.len_utf8()])),
        };
        let last = line + rest[..length].matches('\n').count();
        out.extend(shown.map(|text| Token { text, lines: (line, last) }));
        (at, line) = (at + length, last);
    }
    out
}

fn block_comment(rest: &str) -> usize {
    let (mut depth, mut at) = (0_usize, 0);
    while at < rest.len() {
        if rest[at..].starts_with("/*") {
            (depth, at) = (depth + 1, at + 2);
        } else if rest[at..].starts_with("*/") {
            (depth, at) = (depth - 1, at + 2);
            if depth == 0 {
                return at;
            }
        } else {
            at += rest[at..].chars().next().map_or(1, char::len_utf8);
        }
    }
    rest.len()
}

fn string(rest: &str) -> usize {
    let mut escaped = false;
    for (i, c) in rest.char_indices().skip(1) {
        match c {
            '"' if !escaped => return i + 1,
            _ => escaped = c == '\\' && !escaped,
        }
    }
    rest.len()
}

/// Length of a raw or byte string that begins here.
fn raw_string(rest: &str) -> Option<usize> {
    let marks = rest.trim_start_matches(['b', 'r', 'c']);
    let prefix = rest.len() - marks.len();
    let hashes = marks.len() - marks.trim_start_matches('#').len();
    if prefix == 0 || prefix > 2 || !marks[hashes..].starts_with('"') {
        return None;
    }
    if !rest[..prefix].contains('r') {
        return (hashes == 0).then(|| prefix + string(marks));
    }
    let end = format!("\"{}", "#".repeat(hashes));
    let body = prefix + hashes + 1;
    Some(rest[body..].find(&end).map_or(rest.len(), |i| body + i + end.len()))
}

/// Length of a character, or of a lifetime.
fn quoted(rest: &str) -> usize {
    let mut chars = rest.char_indices().skip(1);
    match (chars.next(), chars.next()) {
        (Some((_, '\\')), Some((after, _))) => {
            let from = after + rest[after..].chars().next().map_or(1, char::len_utf8);
            rest[from..].find('\'').map_or(rest.len(), |i| from + i + 1)
        }
        (Some(_), Some((end, '\''))) => end + 1,
        _ => 1 + rest[1..].find(|c: char| !(c.is_alphanumeric() || c == '_')).unwrap_or(0),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(text: &str) -> Vec<&str> {
        Source::of(text).tokens.iter().map(|token| token.text).collect()
    }

    #[test]
    fn comments_strings_and_tests_are_left_out() {
        let text = "// use crate::a;\n/* b /* c */ d */ let x: &'a str = \"use crate::\\\"e\";\n\
                    let y = ('\\'', 'z', r#\"f \"g\"#, b\"h\");\n\
                    #[cfg(test)]\n#[derive(Debug)]\nmod tests {\n use crate::i;\n}\n\
                    #[cfg(test)]\nmod far;\n#[cfg(test)]\nuse j::{k};\nfn last() {}\n";
        let expected = [
            "let", "x", ":", "&", "\"", "str", "=", "\"", ";", "let", "y", "=", "(", "\"", ",",
            "\"", ",", "\"", ",", "\"", ")", ";", "fn", "last", "(", ")", "{", "}",
        ];
        assert_eq!(words(text), expected);
        let source = Source::of(text);
        assert_eq!((source.lines_of_code(), &source.test_modules[..]), (3, &["far"][..]));
    }

    #[test]
    fn what_is_not_for_tests_alone_stays() {
        assert_eq!(words("#[cfg(not(test))] fn f() {}").len(), 16);
        assert_eq!(words("#![cfg(test)]\nfn f() {}"), [""; 0]);
    }
}
