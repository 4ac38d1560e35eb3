//! The cases in the folders below one, as far as a short walk comes.

use std::collections::VecDeque;
use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use super::folder::{Entry, beneath, place_of};
use crate::case::sanitize::sanitize;

/// A walk goes so many folders down, ...
const DEEPEST: usize = 6;
/// ... looks at so many entries, ...
const MOST_ENTRIES: usize = 50_000;
/// ... finds so many cases, ...
const MOST_CASES: usize = 2_000;
/// ... and takes no longer than this.
const LONGEST: Duration = Duration::from_secs(2);

/// A case in a folder below.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
pub struct Case {
    /// How many folders down it is.
    pub(crate) depth: usize,
    /// The way to it, as a person reads it.
    pub name: String,
    /// The same in small letters.
    pub(crate) folded: String,
    pub(crate) way: PathBuf,
}

/// What a walk found.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Below {
    /// Where the browser was, and the folders that were typed after it.
    pub asked: (PathBuf, String),
    /// The cases, those that are near first.
    pub cases: Vec<Case>,
    /// Whether the walk ended before it was through.
    pub is_cut: bool,
}

/// Walk; `None` where `go_on` says that it is wanted no more. Hidden folders are passed by, and
/// links are not followed.
#[must_use]
pub fn find(base: PathBuf, typed: String, go_on: &dyn Fn(f64) -> bool) -> Option<Below> {
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
    Some(Below {
        asked: (base, typed),
        cases,
        is_cut,
    })
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
        Case {
            depth,
            folded: name.to_lowercase(),
            name,
            way,
        }
    }
}

impl Below {
    /// The path of a case, as the browser calls it.
    #[must_use]
    pub(crate) fn path(&self, case: &Case) -> PathBuf {
        beneath(&self.asked.0, &self.asked.1).join(&case.way)
    }
}
