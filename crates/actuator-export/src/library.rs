//! Pieces of code by name, and what is filled into them.

/// The pieces of one language: texts cut at lines `@@ name`.
#[derive(Debug, Clone)]
pub struct Library {
    pieces: Vec<(&'static str, &'static str)>,
}

impl Library {
    /// Texts cut at their lines `@@ name`.
    pub fn new(texts: &[&'static str]) -> Self {
        let pieces = texts.iter().flat_map(|text| {
            let cut = text.split("@@ ").skip(1);
            cut.map(|piece| piece.split_once('\n').unwrap_or((piece, "")))
        });
        Self { pieces: pieces.collect() }
    }

    /// The piece of a name; an empty text where the language needs none.
    pub fn piece(&self, name: &str) -> &'static str {
        let found = self.pieces.iter().find(|(known, _)| *known == name);
        found.map_or("", |(_, text)| text.trim_end())
    }

    /// The pieces of some names, an empty line between them.
    pub fn pieces<'a>(&self, names: impl IntoIterator<Item = &'a str>) -> String {
        let pieces = names.into_iter().map(|name| self.piece(name));
        pieces.filter(|piece| !piece.is_empty()).collect::<Vec<_>>().join("\n\n")
    }
}

/// A text with every `{{key}}` replaced by its value; a key on a line of its own that has no text is left out with
/// its line.
pub fn filled(text: &str, values: &[(&str, &str)]) -> String {
    let mut text = text.to_owned();
    for (key, value) in values {
        let mark = format!("{{{{{key}}}}}");
        if value.is_empty() {
            text = text.replace(&format!("\n{mark}\n"), "\n");
        }
        text = text.replace(&mark, value);
    }
    text
}

/// Lines, each behind a prefix; nothing behind the prefix of an empty one.
pub fn prefixed<S: AsRef<str>>(lines: &[S], prefix: &str) -> String {
    let lines = lines.iter().map(|line| format!("{prefix}{}", line.as_ref()));
    lines.map(|line| line.trim_end().to_owned()).collect::<Vec<_>>().join("\n")
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn pieces_are_found_and_filled() {
        let library = Library::new(&["@@ a.one\nx {{k}}\n\n@@ a.two\ny\n"]);
        assert_eq!(filled(library.piece("a.one"), &[("k", "1")]), "x 1");
        assert_eq!(library.pieces(["a.two", "no", "a.one"]), "y\n\nx {{k}}");
        assert_eq!(filled("a\n{{gone}}\nb", &[("gone", "")]), "a\nb");
    }
}
