//! Faults of a file, each with its place and on one line.

use std::fmt;

use crate::case::Problem;
use crate::case::sanitize::{cut, sanitize};

/// Greatest number of faults shown for one file.
const MOST: usize = 100;

/// The reason why a file is refused.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum FaultKind {
    /// The text is not a valid case.
    Bad,
    /// The file has a newer format.
    NewerFormat,
}

/// A fault at one place of a file. Prints as `file:line:column: field: cause: fix`, on one line and
/// without control characters.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Fault {
    /// The file's name.
    pub file: String,
    /// Line, from 1.
    pub line: usize,
    /// Column in characters, from 1.
    pub column: usize,
    /// The field's key, an unknown key as written, or `toml` if the text is not TOML.
    pub field: String,
    /// The cause.
    pub cause: String,
    /// How to fix it.
    pub fix: String,
    /// The reason why the file is refused.
    pub kind: FaultKind,
}

impl Fault {
    pub(super) fn new(file: &str, (line, column): (usize, usize), problem: Problem) -> Fault {
        let Problem { field, cause, fix } = problem;
        Fault { file: file.to_owned(), line, column, field, cause, fix, kind: FaultKind::Bad }
    }
}

impl fmt::Display for Fault {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Fault { file, line, column, field, cause, fix, .. } = self;
        write!(
            f,
            "{}:{line}:{column}: {}: {}: {}",
            sanitize(file),
            cut(field),
            sanitize(cause),
            sanitize(fix)
        )
    }
}

impl std::error::Error for Fault {}

/// A problem at a byte of the text.
#[derive(Debug)]
pub(super) struct Found {
    pub(super) at: usize,
    pub(super) problem: Problem,
    pub(super) kind: FaultKind,
    /// Whether the problem is a missing required value.
    pub(super) is_missing: bool,
}

impl Found {
    pub(super) fn new(at: usize, problem: Problem) -> Found {
        Found { at, problem, kind: FaultKind::Bad, is_missing: false }
    }
}

/// The first faults with line and column, in the order of their places, and the number of the other
/// faults. `more` of these are not in the list.
pub(super) fn placed(file: &str, text: &str, mut found: Vec<Found>, more: usize) -> Vec<Fault> {
    found.sort_by_key(|found| found.at);
    let more = more + found.len().saturating_sub(MOST);
    found.truncate(MOST);
    let lines = Lines::of(text);
    let mut faults: Vec<Fault> = found
        .into_iter()
        .map(|found| Fault {
            kind: found.kind,
            ..Fault::new(file, lines.place(found.at), found.problem)
        })
        .collect();
    if let (Some(last), 1..) = (faults.last(), more) {
        let problem =
            Problem::new("toml", format!("and {more} more faults"), "fix those above first");
        faults.push(Fault::new(file, (last.line, last.column), problem));
    }
    faults
}

/// The refusal of a file over the limit.
pub(super) fn too_large(file: &str) -> Fault {
    let cause = format!("the text is longer than {} KiB", super::MOST_BYTES / 1024);
    Fault::new(
        file,
        (1, 1),
        Problem::new("toml", cause, "name a case file; a case needs a few KiB"),
    )
}

/// The refusal of bytes that are not UTF-8.
pub(super) fn not_text(file: &str, bytes: &[u8], at: usize) -> Fault {
    let before = String::from_utf8_lossy(&bytes[..at]);
    let cause =
        format!("byte 0x{:02x} is not UTF-8 text", bytes.get(at).copied().unwrap_or_default());
    Fault::new(
        file,
        Lines::of(&before).place(at),
        Problem::new("toml", cause, "save the file as UTF-8"),
    )
}

/// The starts of the lines of a text.
pub(super) struct Lines<'t> {
    text: &'t str,
    starts: Vec<usize>,
}

impl<'t> Lines<'t> {
    pub(super) fn of(text: &'t str) -> Lines<'t> {
        let starts =
            std::iter::once(0).chain(text.match_indices('\n').map(|(at, _)| at + 1)).collect();
        Lines { text, starts }
    }

    /// Line and column of a byte, both from 1, the column in characters.
    pub(super) fn place(&self, at: usize) -> (usize, usize) {
        let line = self.starts.partition_point(|&start| start <= at).max(1);
        let start = self.starts[line - 1];
        let column = self.text[start..]
            .char_indices()
            .take_while(|&(offset, _)| start + offset < at)
            .count();
        (line, column + 1)
    }

    /// The bytes of the line with the byte `at`, without the line end.
    pub(super) fn around(&self, at: usize) -> std::ops::Range<usize> {
        let line = self.starts.partition_point(|&start| start <= at).max(1);
        let end = self.starts.get(line).map_or(self.text.len(), |&next| next - 1);
        let start = self.starts[line - 1];
        start..start + self.text[start..end].trim_end_matches('\r').len()
    }
}
