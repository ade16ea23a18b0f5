//! The page around a body.

use maud::{DOCTYPE, Markup, PreEscaped, html};
use plotly::Plot;

/// Text that every page holds and no page of another program.
pub const MADE_HERE: &str = "<meta name=\"generator\" content=\"rotor-hhc\">";

/// A whole page around its body: style and script inside, nothing loaded from anywhere.
///
/// The library of the charts is part of it where there is any, some 5 MB.
pub fn page(title: &str, body: &Markup, charts: &Charts) -> String {
    let page = html! {
        (DOCTYPE)
        html lang="en" {
            head {
                meta charset="utf-8";
                meta name="viewport" content="width=device-width, initial-scale=1";
                meta name="color-scheme" content="light dark";
                (PreEscaped(MADE_HERE))
                title { (title) }
                style { (PreEscaped(STYLE)) }
                @if !charts.json.is_empty() { (PreEscaped(plotly_script())) }
            }
            body {
                main { (body) }
                @if !charts.json.is_empty() { script { (PreEscaped(charts.script())) } }
            }
        }
    };
    page.into_string()
}

/// Lines of a terminal as paragraphs; what is indented becomes a list, the further the deeper.
pub fn paragraphs(text: &str) -> Markup {
    let lines: Vec<(usize, &str)> = text
        .lines()
        .map(|line| (line.len() - line.trim_start().len(), line.trim()))
        .filter(|(_, line)| !line.is_empty())
        .collect();
    let blocks = lines.chunk_by(|a, b| (a.0 > 0) == (b.0 > 0));
    html! {
        @for block in blocks {
            @if block[0].0 == 0 {
                @for (_, line) in block { p { (line) } }
            } @else {
                ul { @for (indent, line) in block { li.deep[*indent > 2] { (line) } } }
            }
        }
    }
}

/// The head of a page: its title, and what it says in a sentence.
pub fn heading(title: &str, verdict: &str) -> Markup {
    html! { header { h1 { (title) } p.verdict { (verdict) } } }
}

/// A section of a class: its heading, lines as [`paragraphs`] takes them, and what follows.
pub fn titled(class: &str, title: &str, text: &str, parts: &[Markup]) -> Markup {
    html! { section class=(class) { h2 { (title) } (paragraphs(text)) @for part in parts { (part) } } }
}

/// Figures side by side; `class` says how wide they are: `grid`, `grid small` or `grid wide`.
pub fn grid(class: &str, figures: impl IntoIterator<Item = Markup>) -> Markup {
    html! { div class=(class) { @for own in figures { (own) } } }
}

/// Parts of a page one below the other, and what it was made by.
pub fn body(parts: &[Markup], made_by: &str) -> Markup {
    html! { @for part in parts { (part) } footer { p { (made_by) } } }
}

/// What a reader unfolds: its title, and what is behind it.
pub fn folded(title: &str, body: &Markup) -> Markup {
    html! { details { summary { (title) } (body) } }
}

/// The charts of a page: boxes in the text, their data in one script at its end.
#[derive(Debug, Clone, Default)]
pub struct Charts {
    json: Vec<String>,
}

impl Charts {
    /// Adds a chart; its box, of a class that says its height: `chart` or `chart tall`.
    pub fn figure(&mut self, class: &str, title: &str, note: &str, plot: &Plot) -> Markup {
        let id = format!("chart-{}", self.json.len());
        // a title in the data must not end the script it stands in
        self.json.push(plot.to_json().replace("</", "<\\/"));
        html! {
            figure {
                figcaption { strong { (title) } @if !note.is_empty() { br; span.note { (note) } } }
                div class=(class) id=(id) {}
            }
        }
    }

    fn script(&self) -> String {
        format!("const charts = [{}];\n{SCRIPT}", self.json.join(",\n"))
    }
}

/// The plotting library alone, of the scripts plotly brings.
fn plotly_script() -> String {
    let sources = Plot::offline_js_sources();
    let end = sources.find("</script>").map_or(sources.len(), |i| i + "</script>".len());
    sources[..end].to_owned()
}

/// Draws the charts in the colours of the reader's theme, again when it changes.
const SCRIPT: &str = include_str!("page.js");
/// The style of the page and of the pictures.
const STYLE: &str = concat!(include_str!("page.css"), include_str!("pictures/pictures.css"));

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn lines_become_paragraphs_and_lists() {
        let text = paragraphs("Missing: <a>.\n  first\n    within\n\nThen\n").into_string();
        assert_eq!(
            text,
            "<p>Missing: &lt;a&gt;.</p><ul><li class=\"\">first</li><li class=\"deep\">within</li></ul><p>Then</p>"
        );
    }

    #[test]
    fn a_page_without_charts_has_no_script() {
        let text = page("a <title>", &html! { p { "body" } }, &Charts::default());
        assert!(text.contains("<title>a &lt;title&gt;</title>") && text.contains("<p>body</p>"));
        assert!(!text.contains("<script") && text.len() < 10_000, "{}", text.len());
        let mut charts = Charts::default();
        let own = charts.figure("chart", "one", "", &Plot::new()).into_string();
        assert!(own.contains("id=\"chart-0\""), "{own}");
        assert!(page("t", &html! {}, &charts).contains("plotly.js v"));
    }
}
