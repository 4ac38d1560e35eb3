//! Search for cases in the folders below a folder, with limits.

use std::collections::VecDeque;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::folder::{Entry, beneath, place_of};
use crate::case::sanitize::sanitize;

/// Greatest depth of the search.
const DEEPEST: usize = 6;
/// Greatest number of entries to visit.
const MOST_ENTRIES: usize = 50_000;
/// Greatest number of cases to find.
const MOST_CASES: usize = 2_000;
/// Greatest duration of the search.
const LONGEST: Duration = Duration::from_secs(2);

/// A case in a folder below.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Case {
    /// Depth of its folder below the start.
    pub(crate) depth: usize,
    /// The relative path as text.
    pub name: String,
    /// The path in lower case.
    pub(crate) folded: String,
    pub(crate) way: PathBuf,
}

/// The result of a search.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct SearchResult {
    /// The folder of the browser, and the folders typed after it.
    pub asked: (PathBuf, String),
    /// The cases, the nearest first.
    pub cases: Vec<Case>,
    /// Whether the search ended at a limit.
    pub is_cut: bool,
}

/// Searches for cases; returns `None` if `go_on` returns false. Skips hidden folders and does not
/// follow links.
#[must_use]
pub fn find(base: PathBuf, typed: String, go_on: &dyn Fn(f64) -> bool) -> Option<SearchResult> {
    let top = place_of(&base, &typed);
    let (began, mut entries) = (Instant::now(), 0);
    let (mut cases, mut is_cut) = (Vec::new(), false);
    let mut ahead = VecDeque::from([(PathBuf::new(), 0)]);
    while let Some((way, depth)) = ahead.pop_front() {
        if !go_on(0.0) {
            return None;
        }
        if entries >= MOST_ENTRIES || cases.len() >= MOST_CASES || began.elapsed() > LONGEST {
            is_cut = true;
            break;
        }
        for entry in look(&top.join(&way)).take(MOST_ENTRIES - entries) {
            entries += 1;
            let way = way.join(entry.file_name());
            match kind(&entry) {
                Kind::Folder if depth < DEEPEST => ahead.push_back((way, depth + 1)),
                Kind::Case if depth > 0 => cases.push(Case::of(way, depth)),
                Kind::Folder => is_cut = true,
                Kind::Case | Kind::Other => (),
            }
        }
    }
    cases.sort();
    cases.truncate(MOST_CASES);
    Some(SearchResult { asked: (base, typed), cases, is_cut })
}

enum Kind {
    Folder,
    Case,
    Other,
}

fn look(folder: &Path) -> impl Iterator<Item = fs::DirEntry> {
    fs::read_dir(folder).into_iter().flatten().flatten()
}

fn kind(entry: &fs::DirEntry) -> Kind {
    let is_hidden = entry.file_name().as_encoded_bytes().starts_with(b".");
    match entry.file_type() {
        Ok(kind) if kind.is_dir() && !is_hidden => Kind::Folder,
        Ok(kind)
            if kind.is_file() && !is_hidden && Entry::is_case(Path::new(&entry.file_name())) =>
        {
            Kind::Case
        }
        _ => Kind::Other,
    }
}

impl Case {
    fn of(way: PathBuf, depth: usize) -> Case {
        let name = sanitize(&way.to_string_lossy());
        Case { depth, folded: name.to_lowercase(), name, way }
    }
}

impl SearchResult {
    /// The path of a case, relative to the browser.
    #[must_use]
    pub(crate) fn path(&self, case: &Case) -> PathBuf {
        beneath(&self.asked.0, &self.asked.1).join(&case.way)
    }
}
