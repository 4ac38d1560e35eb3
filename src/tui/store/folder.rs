//! What the file browser shows: the content of a folder, the cases found below it, and previews.

use std::collections::VecDeque;
use std::fs;
use std::io::Read;
use std::path::{self, Path, PathBuf};
use std::time::{Duration, Instant};

use ratatui::style::Style;

use super::{at_home, load};
use crate::case::sanitize::sanitize;
use crate::case::units::System;
use crate::case::{Document, EXAMPLES, Example, rexs};
use crate::report::digest::Digest;
use crate::report::solve;
use crate::tui::settings::Theme;

/// Greatest number of listed entries.
const MOST: usize = 50_000;

/// Greatest depth of the search.
const DEEPEST: usize = 6;
/// Greatest number of entries to visit.
const MOST_ENTRIES: usize = 50_000;
/// Greatest number of cases to find.
const MOST_CASES: usize = 2_000;
/// Bytes of a file that show whether it is a case.
const HEAD: u64 = 1 << 16;
/// Greatest duration of the search.
const LONGEST: Duration = Duration::from_secs(2);

/// Greatest number of shown faults; further faults are counted.
const MOST_FAULTS: usize = 20;

/// A line of the file browser.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Entry {
    /// The shown name.
    pub name: String,
    /// The text that typing finds, in lower case.
    pub(crate) folded: String,
    /// What it opens.
    pub(crate) target: Target,
}

/// What a line of the file browser opens.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Target {
    /// A case file.
    File(PathBuf),
    /// A folder.
    Folder(PathBuf),
    /// An example.
    Example(&'static Example),
}

impl Target {
    /// The path; empty for an example.
    pub(crate) fn path(&self) -> PathBuf {
        match self {
            Target::File(path) | Target::Folder(path) => path.clone(),
            Target::Example(_) => PathBuf::new(),
        }
    }
}

/// The content of a folder.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Listing {
    /// The full path of the folder.
    pub(crate) folder: PathBuf,
    /// The entries, including hidden ones; or the error of reading.
    pub entries: Result<Vec<Entry>, String>,
}

/// The preview of a line: texts, each with its style.
pub(crate) type Preview = Vec<(String, Tone)>;

/// A style of any theme.
pub(crate) type Tone = fn(&Theme) -> Style;

const PLAIN: Tone = |_| Style::new();
const PROBLEM: Tone = |theme| theme.problem;

impl Entry {
    pub(super) fn new(name: String, matched: &str, target: Target) -> Entry {
        Entry { name, folded: matched.to_lowercase(), target }
    }

    /// The parent folder, which no typed text finds.
    pub(crate) fn up(folder: PathBuf) -> Entry {
        Entry::new("../".to_owned(), "", Target::Folder(folder))
    }

    /// The examples.
    pub(crate) fn examples() -> Vec<Entry> {
        let entry = |example: &'static Example| {
            let name = format!("{}  (example)", example.name);
            Entry::new(name, example.name, Target::Example(example))
        };
        EXAMPLES.iter().map(entry).collect()
    }

    pub(crate) fn is_folder(&self) -> bool {
        matches!(self.target, Target::Folder(_))
    }

    // Only a link needs another system call.
    fn of(entry: &fs::DirEntry, shown: &Path) -> Option<Entry> {
        let file = entry.file_name();
        let kind = entry.file_type().ok()?;
        let is_folder = kind.is_dir() || kind.is_symlink() && entry.path().is_dir();
        let (name, path) = (sanitize(&file.to_string_lossy()), shown.join(&file));
        if is_folder {
            return Some(Entry::new(format!("{name}/"), &name, Target::Folder(path)));
        }
        is_case(Path::new(&file)).then(|| Entry::new(name.clone(), &name, Target::File(path)))
    }
}

/// Whether a file with this name is a case, or a model that can be imported as a case.
fn is_case(file: &Path) -> bool {
    file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("toml"))
        || rexs::is_model(file)
}

/// Whether a file has a key of a case, or is a model.
fn has_a_case(file: &Path) -> bool {
    let mut text = Vec::new();
    let is_read = file.is_file()
        && fs::File::open(file).is_ok_and(|file| file.take(HEAD).read_to_end(&mut text).is_ok());
    let is_of_case = |line: &str| {
        let key = line.split('=').next().unwrap_or_default();
        let table = key.split(['.', ']']).next().unwrap_or_default();
        matches!(table.trim_matches(['[', '"', ' ', '\t', '\r']), "pair" | "driver" | "driven")
    };
    rexs::is_model(file) || is_read && String::from_utf8_lossy(&text).lines().any(is_of_case)
}

/// Lists a folder; the paths of its entries begin with `shown`.
pub fn list(shown: &Path, place: PathBuf) -> Listing {
    let folder = fs::canonicalize(&place).or_else(|_| path::absolute(&place)).unwrap_or(place);
    let entries = entries(&folder, shown);
    Listing { folder, entries }
}

impl Listing {
    /// Whether the list is incomplete.
    pub(crate) fn is_cut(&self) -> bool {
        self.entries.as_ref().is_ok_and(|entries| entries.len() >= MOST)
    }
}

/// The typed folder; by default the present folder.
pub(crate) fn place_of(base: &Path, typed: &str) -> PathBuf {
    let place = at_home(&beneath(base, typed));
    if place.as_os_str().is_empty() { PathBuf::from(".") } else { place }
}

/// The path of a text typed into a browser of `base`; `~` and `/` make it absolute.
pub fn beneath(base: &Path, typed: &str) -> PathBuf {
    if typed.starts_with('~') { PathBuf::from(typed) } else { base.join(typed) }
}

// The cases and then the folders of a folder, sorted by name; their paths begin with `shown`.
fn entries(folder: &Path, shown: &Path) -> Result<Vec<Entry>, String> {
    let found =
        fs::read_dir(folder).map_err(|error| format!("This folder cannot be read: {error}."))?;
    let found = found.flatten().filter_map(|entry| Entry::of(&entry, shown));
    let mut entries: Vec<_> = found.take(MOST).collect();
    entries.sort_by(|a, b| (a.is_folder(), &a.name).cmp(&(b.is_folder(), &b.name)));
    Ok(entries)
}

/// Searches for cases below a folder, the nearest first; their paths begin with `shown`. Returns `None`
/// if `go_on` returns false. Skips hidden folders and does not follow links.
pub fn find(shown: &Path, top: &Path, go_on: &dyn Fn() -> bool) -> Option<Vec<Entry>> {
    let (began, mut entries) = (Instant::now(), 0);
    let mut cases = Vec::new();
    let mut ahead = VecDeque::from([(PathBuf::new(), 0)]);
    while let Some((way, depth)) = ahead.pop_front() {
        if !go_on() {
            return None;
        }
        if entries >= MOST_ENTRIES || cases.len() >= MOST_CASES || began.elapsed() > LONGEST {
            break;
        }
        let found = fs::read_dir(top.join(&way)).into_iter().flatten().flatten();
        for entry in found.take(MOST_ENTRIES - entries) {
            entries += 1;
            let name = entry.file_name();
            let Ok(kind) = entry.file_type() else { continue };
            let way = way.join(&name);
            if name.as_encoded_bytes().starts_with(b".") {
            } else if kind.is_dir() && depth < DEEPEST {
                ahead.push_back((way, depth + 1));
            } else if kind.is_file() && depth > 0 && is_case(&way) {
                cases.push((depth, sanitize(&way.to_string_lossy()), way));
            }
        }
    }
    cases.sort();
    cases.truncate(MOST_CASES);
    let entry = |(_, name, way): (usize, String, PathBuf)| {
        Entry::new(name.clone(), &name, Target::File(shown.join(way)))
    };
    Some(cases.into_iter().map(entry).collect())
}

/// Computes a preview; returns `None` if `go_on` returns false.
pub(crate) fn preview(
    target: &Target,
    system: System,
    go_on: &dyn Fn(f64) -> bool,
) -> Option<Preview> {
    match target {
        Target::File(path) => match load(&at_home(path)) {
            Ok(document) => of_document(&document, system, go_on),
            Err(faults) => Some(of_faults(faults)),
        },
        Target::Folder(path) => Some(match entries(&at_home(path), path) {
            Ok(entries) => {
                let folders = entries.iter().filter(|entry| entry.is_folder()).count();
                let mut cases = 0;
                for entry in &entries {
                    if !go_on(0.0) {
                        return None;
                    }
                    let Target::File(path) = &entry.target else { continue };
                    cases += usize::from(has_a_case(&at_home(path)));
                }
                let [cases, folders] =
                    [(cases, "case"), (folders, "folder")].map(|(count, one)| {
                        format!("{count} {one}{}", if count == 1 { "" } else { "s" })
                    });
                vec![(format!("A folder with {cases}, {folders}."), PLAIN)]
            }
            Err(reason) => of_faults(vec![reason]),
        }),
        Target::Example(example) => of_document(&example.document(), system, go_on),
    }
}

fn of_document(
    document: &Document,
    system: System,
    go_on: &dyn Fn(f64) -> bool,
) -> Option<Preview> {
    let is_newer = document.is_newer();
    let mut lines = match document.case.inputs() {
        Ok(inputs) => {
            let digest = solve::digest(&document.case, &inputs, system, go_on)?;
            let Digest { title, pair, load, method, outcome, limits, notes, .. } = digest;
            let mut lines = Preview::new();
            let title = if title.is_empty() { "without a title".to_owned() } else { title };
            lines.push((title, |theme| theme.title));
            let plain = [pair, load, format!("method {method}"), String::new()];
            lines.extend(plain.map(|line| (line, PLAIN)));
            lines.push((outcome, |theme| theme.focus));
            if limits.is_empty() {
                lines.push(("No limits.".to_owned(), PLAIN));
            }
            for (standing, text) in limits {
                let tone = if standing.holds() { PLAIN } else { PROBLEM };
                lines.push((format!("{} {text}", standing.word()), tone));
            }
            for note in notes {
                lines.push((String::new(), PLAIN));
                lines.push((format!("Note: {note}"), |theme| theme.note));
            }
            lines
        }
        Err(problems) => {
            let head = if is_newer {
                "Missing, or not read by this version:"
            } else {
                "Required values are missing:"
            };
            let head: (String, Tone) = (head.to_owned(), |theme| theme.note);
            let fields = problems.iter().map(|problem| (problem.for_form().field, PLAIN));
            std::iter::once(head).chain(fields).collect()
        }
    };
    if is_newer {
        lines.insert(0, ("Newer format: opens read-only.".to_owned(), PROBLEM));
    }
    Some(lines)
}

fn of_faults(mut faults: Vec<String>) -> Preview {
    let more = faults.len().saturating_sub(MOST_FAULTS);
    faults.truncate(MOST_FAULTS);
    faults.extend((more > 0).then(|| format!("and {more} more")));
    let head = ("It cannot be opened:".to_owned(), PROBLEM);
    std::iter::once(head).chain(faults.into_iter().map(|fault| (fault, PLAIN))).collect()
}
