//! The room rule: inside a crate modules do not stand on one another in circles, and nothing grows too large.
//!
//! What counts as a use: every path in `use` and in code that leads, through re-exports, to an item of another file of
//! the crate; tests apart. What does not count:
//!
//! - a folder and what lies in it are one: `mod.rs` may use its submodules and they may use it;
//! - what `error.rs` names: an error carries what it speaks of.
//!
//! In each folder the files and subfolders, each subfolder taken as one with all it holds, must then form no circle.

mod graph;
mod source;

use std::collections::{BTreeMap, BTreeSet};

use crate::tidy::Tree;
use graph::{Modules, Use, place};
use source::Source;

/// Rust files a folder of sources may hold.
pub const FILES_OF_A_FOLDER: usize = 15;

/// Lines of code a crate of the product may have, without comments, blank lines and tests.
pub const LINES_OF_A_CRATE: usize = 9000;

/// Folders that may hold more files, each with the reason: lists of alike things, one file each.
pub const LISTS: &[(&str, &str)] = &[
    ("crates/actuator-gap/src/causes", "one file a cause"),
    ("tests/truth/src/hidden", "one file for each part of a synthetic set"),
];

/// A breach of the room rule.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
#[non_exhaustive]
pub enum RoomFault {
    /// Modules of one folder use one another in a circle.
    #[error("{folder}: modules in a circle; move the misplaced item below its users\n{}", uses.join("\n"))]
    Circle {
        /// The folder, relative to the root.
        folder: String,
        /// The uses that lead round it: file with line, and path.
        uses: Vec<String>,
    },
    /// A folder holds too many files.
    #[error("{folder} holds {files} Rust files, at most {FILES_OF_A_FOLDER}: divide it by idea")]
    Folder {
        /// The folder, relative to the root.
        folder: String,
        /// The files in it, those of its subfolders apart.
        files: usize,
    },
    /// A crate has too much code.
    #[error("{member} has {lines} lines of code, at most {LINES_OF_A_CRATE}: divide it by idea")]
    Length {
        /// Folder of the crate.
        member: String,
        /// Its lines of code.
        lines: usize,
    },
    /// An exception that nothing needs.
    #[error("{path} needs no exception from the room rule any more")]
    Needless {
        /// The folder.
        path: String,
    },
}

/// All breaches of the room rule in a tree.
pub fn check(tree: &Tree) -> Vec<RoomFault> {
    check_but(tree, LISTS)
}

/// [`check`] with other folders that are lists.
pub fn check_but(tree: &Tree, lists: &[(&str, &str)]) -> Vec<RoomFault> {
    let mut faults: Vec<RoomFault> =
        members(tree).iter().flat_map(|(member, files)| faults_of(member, files, lists)).collect();
    let held = |folder: &str| files_of_folders(tree).get(folder).copied().unwrap_or(0);
    let needless = lists.iter().filter(|(folder, _)| held(folder) <= FILES_OF_A_FOLDER);
    faults.extend(needless.map(|(path, _)| RoomFault::Needless { path: (*path).to_owned() }));
    faults
}

/// Lines of code of every crate, by its folder.
pub fn lines_of_code(tree: &Tree) -> BTreeMap<&str, usize> {
    let count = |files: &BTreeMap<String, &str>| {
        shipped(files).values().map(Source::lines_of_code).sum::<usize>()
    };
    members(tree).iter().map(|(member, files)| (*member, count(files))).collect()
}

/// The sources of each member: texts by path below `src/`, by the member's folder.
fn members(tree: &Tree) -> BTreeMap<&str, BTreeMap<String, &str>> {
    let mut members: BTreeMap<&str, BTreeMap<String, &str>> = BTreeMap::new();
    for file in &tree.texts {
        if let Some((member, path)) = file.path.split_once("/src/")
            && is_rust(path)
        {
            members.entry(member).or_default().insert(path.to_owned(), &file.text);
        }
    }
    members
}

/// The sources that are not compiled for tests only.
fn shipped<'a>(files: &BTreeMap<String, &'a str>) -> BTreeMap<String, Source<'a>> {
    let mut sources: BTreeMap<String, Source<'a>> =
        files.iter().map(|(path, text)| (path.clone(), Source::of(text))).collect();
    let tests: BTreeSet<Vec<String>> = sources
        .iter()
        .flat_map(|(path, source)| {
            let parent = place(path);
            source.test_modules.iter().map(move |name| {
                parent.iter().cloned().chain([(*name).to_owned()]).collect::<Vec<String>>()
            })
        })
        .collect();
    sources.retain(|path, _| !tests.iter().any(|test| place(path).starts_with(test)));
    sources
}

fn faults_of(
    member: &str,
    files: &BTreeMap<String, &str>,
    lists: &[(&str, &str)],
) -> Vec<RoomFault> {
    let sources = shipped(files);
    let mut faults: Vec<RoomFault> =
        Modules::of(&sources).circles().iter().map(|circle| fault_of(member, circle)).collect();
    let lines = sources.values().map(Source::lines_of_code).sum();
    if member.starts_with("crates/") && lines > LINES_OF_A_CRATE {
        faults.push(RoomFault::Length { member: member.to_owned(), lines });
    }
    for (folder, files) in folders(files.keys().map(|path| format!("{member}/src/{path}"))) {
        let is_list = lists.iter().any(|(list, _)| *list == folder);
        if files > FILES_OF_A_FOLDER && !is_list {
            faults.push(RoomFault::Folder { folder, files });
        }
    }
    faults
}

fn fault_of(member: &str, circle: &[Use]) -> RoomFault {
    let mut shared = circle.first().map_or(&[][..], |edge| &edge.from[..]);
    for place in circle.iter().flat_map(|edge| [&edge.from, &edge.to]) {
        let same = shared.iter().zip(place).take_while(|(a, b)| a == b).count();
        shared = &shared[..same];
    }
    let uses = circle
        .iter()
        .map(|edge| format!("  {member}/src/{}:{}: {}", edge.file, edge.line, edge.path));
    let folder = [&[format!("{member}/src")], shared].concat().join("/");
    RoomFault::Circle { folder, uses: uses.collect() }
}

/// How many files each folder holds.
fn folders(paths: impl Iterator<Item = String>) -> BTreeMap<String, usize> {
    let mut folders = BTreeMap::new();
    for path in paths {
        if let Some((folder, _)) = path.rsplit_once('/') {
            *folders.entry(folder.to_owned()).or_default() += 1;
        }
    }
    folders
}

fn files_of_folders(tree: &Tree) -> BTreeMap<String, usize> {
    folders(tree.texts.iter().map(|file| file.path.clone()).filter(|path| is_rust(path)))
}

fn is_rust(path: &str) -> bool {
    path.rsplit_once('.').is_some_and(|(_, ending)| ending == "rs")
}
