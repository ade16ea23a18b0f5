//! The modules of a crate and which of them uses which.

use std::collections::{BTreeMap, BTreeSet, VecDeque};

use super::source::{Source, Token};

/// A module as the names on the way to it from the root of the crate.
pub(super) type Place = Vec<String>;

/// An import: `path` under the name `name`.
#[derive(Debug, Clone)]
struct Import {
    path: Vec<String>,
    name: String,
    line: usize,
}

/// One file.
#[derive(Debug, Clone, Default)]
struct Module {
    file: String,
    imports: Vec<Import>,
    /// Paths in the code, with their lines.
    paths: Vec<(Vec<String>, usize)>,
}

/// Where a use of another module stands.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Use {
    pub(super) from: Place,
    pub(super) to: Place,
    /// The file of the user, its line and the path that is written there.
    pub(super) file: String,
    pub(super) line: usize,
    pub(super) path: String,
}

/// The modules of a crate.
#[derive(Debug, Clone, Default)]
pub(super) struct Modules(BTreeMap<Place, Module>);

/// Modules whose uses do not count: an error carries what it speaks of.
const ERRORS: &str = "error";

impl Modules {
    /// The modules of sources by their path below `src/`.
    pub(super) fn of(sources: &BTreeMap<String, Source<'_>>) -> Self {
        let modules = sources.iter().map(|(path, source)| {
            let (imports, paths) = read(&source.tokens);
            (place(path), Module { file: path.clone(), imports, paths })
        });
        Self(modules.collect())
    }

    /// Circles among the modules of each folder: each the uses that lead round it, the shortest way.
    pub(super) fn circles(&self) -> Vec<Vec<Use>> {
        let uses = self.uses();
        let mut circles = Vec::new();
        let folders: BTreeSet<&[String]> =
            self.0.keys().flat_map(|place| (0..place.len()).map(|depth| &place[..depth])).collect();
        for folder in folders {
            let depth = folder.len();
            let inside = |place: &Place| place.len() > depth && place.starts_with(folder);
            let mut edges: BTreeMap<&[String], BTreeMap<&[String], &Use>> = BTreeMap::new();
            for edge in uses.iter().filter(|edge| inside(&edge.from) && inside(&edge.to)) {
                let (from, to) = (&edge.from[..=depth], &edge.to[..=depth]);
                if from != to {
                    edges.entry(from).or_default().entry(to).or_insert(edge);
                }
            }
            let mut seen = BTreeSet::new();
            for start in edges.keys() {
                if let Some(circle) = round(&edges, start)
                    && !circle.iter().any(|edge| seen.contains(&edge.from[..=depth]))
                {
                    seen.extend(circle.iter().map(|edge| edge.from[..=depth].to_vec()));
                    circles.push(circle.into_iter().cloned().collect());
                }
            }
        }
        circles
    }

    /// Every use that counts: of a module that neither holds the user nor lies within it.
    fn uses(&self) -> Vec<Use> {
        let mut uses = Vec::new();
        for (from, module) in &self.0 {
            if from.last().is_some_and(|name| name == ERRORS) {
                continue;
            }
            let imports = module.imports.iter().map(|import| (&import.path, import.line));
            let paths = module.paths.iter().map(|(path, line)| (path, *line));
            for (path, line) in imports.chain(paths) {
                if let Some(to) = self.resolve(from, path, &mut BTreeSet::new())
                    && !to.starts_with(from)
                    && !from.starts_with(&to)
                {
                    let (from, file) = (from.clone(), module.file.clone());
                    uses.push(Use { from, to, file, line, path: path.join("::") });
                }
            }
        }
        uses
    }

    /// The module that defines what a path in the module `at` leads to; none outside the crate.
    fn resolve(
        &self,
        at: &[String],
        path: &[String],
        seen: &mut BTreeSet<(Place, String)>,
    ) -> Option<Place> {
        let (mut place, mut rest) = (at.to_vec(), path);
        match path.first()?.as_str() {
            "crate" => (place, rest) = (Place::new(), &path[1..]),
            "self" => rest = &path[1..],
            "super" => {
                while let Some(("super", after)) =
                    rest.split_first().map(|(first, after)| (first.as_str(), after))
                {
                    place.pop();
                    rest = after;
                }
            }
            first => {
                let is_known = self.child(at, first).is_some() || self.import(at, first).is_some();
                is_known.then_some(())?;
            }
        }
        while let Some((name, after)) = rest.split_first() {
            if let Some(child) = self.child(&place, name) {
                (place, rest) = (child, after);
                continue;
            }
            let Some(import) = self.import(&place, name) else { break };
            if !seen.insert((place.clone(), name.clone())) {
                break;
            }
            let found = self.resolve(&place, &import.path, seen)?;
            if after.is_empty() {
                return Some(found);
            }
            (place, rest) = (found, after);
        }
        self.0.contains_key(&place).then_some(place)
    }

    fn child(&self, place: &[String], name: &str) -> Option<Place> {
        let child: Place = place.iter().cloned().chain([name.to_owned()]).collect();
        self.0.contains_key(&child).then_some(child)
    }

    fn import(&self, place: &[String], name: &str) -> Option<&Import> {
        self.0.get(place)?.imports.iter().find(|import| import.name == name)
    }
}

/// The shortest way from a module back to itself.
fn round<'a>(
    edges: &BTreeMap<&'a [String], BTreeMap<&'a [String], &'a Use>>,
    start: &'a [String],
) -> Option<Vec<&'a Use>> {
    let mut came: BTreeMap<&[String], &Use> = BTreeMap::new();
    let mut open = VecDeque::from([start]);
    while let Some(at) = open.pop_front() {
        for (&next, &edge) in edges.get(at).into_iter().flatten() {
            if came.contains_key(next) {
                continue;
            }
            came.insert(next, edge);
            if next == start {
                return Some(way_back(&came, edge, start));
            }
            open.push_back(next);
        }
    }
    None
}

/// The uses that led to `last`, which ends at `start`.
fn way_back<'a>(
    came: &BTreeMap<&[String], &'a Use>,
    last: &'a Use,
    start: &[String],
) -> Vec<&'a Use> {
    let mut way = vec![last];
    let mut at = &last.from[..start.len()];
    while at != start {
        let Some(edge) = came.get(at) else { break };
        way.push(edge);
        at = &edge.from[..start.len()];
    }
    way.reverse();
    way
}

/// The module of a file below `src/`.
pub(super) fn place(path: &str) -> Place {
    let mut names: Place = path.trim_end_matches(".rs").split('/').map(ToOwned::to_owned).collect();
    if names.last().is_some_and(|name| name == "mod")
        || (names.len() == 1 && ["lib", "main"].contains(&names[0].as_str()))
    {
        names.pop();
    }
    names
}

/// The imports and the other paths of a source.
fn read(tokens: &[Token<'_>]) -> (Vec<Import>, Vec<(Vec<String>, usize)>) {
    let text = |i: usize| tokens.get(i).map_or("", |token| token.text);
    let (mut imports, mut paths) = (Vec::new(), Vec::new());
    let mut at = 0;
    while at < tokens.len() {
        if text(at) == "use" && text(at + 1) != "<" {
            let length = tokens[at..].iter().take_while(|token| token.text != ";").count();
            let mut tree = Tree { tokens: &tokens[at + 1..at + length], at: 0 };
            tree.read(&[], &mut imports);
            at += length;
        } else if is_word(text(at))
            && text(at + 1) == "::"
            && !["::", "."].contains(&text(at.max(1) - 1))
        {
            let line = tokens[at].lines.0;
            let mut path = vec![text(at).to_owned()];
            while text(at + 1) == "::" && is_word(text(at + 2)) {
                at += 2;
                path.push(text(at).to_owned());
            }
            paths.push((path, line));
            at += 1;
        } else {
            at += 1;
        }
    }
    (imports, paths)
}

fn is_word(text: &str) -> bool {
    text.starts_with(|c: char| c.is_alphabetic() || c == '_')
}

/// The tree of one `use`.
struct Tree<'a> {
    tokens: &'a [Token<'a>],
    at: usize,
}

impl Tree<'_> {
    fn text(&self) -> &str {
        self.tokens.get(self.at).map_or("", |token| token.text)
    }

    /// One branch, up to the comma or brace behind it.
    fn read(&mut self, prefix: &[String], imports: &mut Vec<Import>) {
        let mut path = prefix.to_vec();
        let mut name = None;
        let line = self.tokens.get(self.at).map_or(0, |token| token.lines.0);
        while self.at < self.tokens.len() && ![",", "}"].contains(&self.text()) {
            match self.text() {
                "{" => {
                    self.at += 1;
                    while self.at < self.tokens.len() && self.text() != "}" {
                        self.read(&path, imports);
                        self.at += usize::from(self.text() == ",");
                    }
                    self.at += 1;
                    return;
                }
                "as" => {
                    self.at += 1;
                    name = Some(self.text().to_owned());
                }
                "::" => {}
                word => path.push(word.to_owned()),
            }
            self.at += 1;
        }
        match path.last().map(String::as_str) {
            Some("self") if path.len() > 1 => drop(path.pop()),
            None => return,
            _ => {}
        }
        let name = name.or_else(|| path.last().cloned()).unwrap_or_default();
        if name == "*" {
            path.pop();
        }
        imports.push(Import { path, name, line });
    }
}
