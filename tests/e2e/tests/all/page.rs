//! What holds of every page of a diagnosis.

/// Asserts that a page has its sections and loads nothing.
#[track_caller]
pub(crate) fn check_page(page: &str, sections: &[&str]) {
    assert!(page.starts_with("<!DOCTYPE html>") && page.ends_with("</html>"));
    for name in sections {
        assert!(page.contains(&format!("<section class=\"{name}\"")), "{name}");
    }
    for word in ["http://", "https://", "src=", "<link", "<script"] {
        assert!(!page.contains(word), "{word}");
    }
    for name in ["section", "figure", "svg", "details", "title", "text"] {
        let opened =
            page.matches(&format!("<{name}>")).count() + page.matches(&format!("<{name} ")).count();
        assert_eq!(opened, page.matches(&format!("</{name}>")).count(), "{name}");
    }
}
