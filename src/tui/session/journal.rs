//! Journals of unsaved edits: their text, with a checksum that shows whether it is complete, their
//! folder, and the thread that writes them: the workbench never waits for a disk.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File};
use std::io::{self, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::{Arc, Condvar, Mutex, MutexGuard, PoisonError};
use std::thread;

use serde::{Deserialize, Serialize};
use thiserror::Error;

use super::lock::Lock;
use crate::case::changes::Change;
use crate::case::sanitize::sanitize;
use crate::case::stamp::{Stamp, hash};
use crate::system::sharing;
use crate::tui::session;
use crate::tui::store::{self, state};

/// The format of journals that this version reads and writes.
const FORMAT: i64 = 1;

/// Greatest size of a journal to read, in bytes: more than the changes of any case.
pub(crate) const MOST_BYTES: usize = 4 << 20;

const OPENING: &str =
    "# Edits that were not saved. tipstrike offers them when the case is opened again.\n";
const FORMAT_KEY: &str = "format = ";
const CHECKSUM_KEY: &str = "checksum = ";

/// The extension of a journal.
const ENDING: &str = "toml";
/// Number of letters of the case's name in the name of its journal.
const MOST_LETTERS: usize = 40;

/// Age in seconds of a journal that is not reported any more.
const RECENT: u64 = 30 * 86400;

/// The name of the thread that writes journals.
const THREAD: &str = "journal";

/// Edits of a case that are not in its file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Journal {
    /// The file of the case; `None` if it has none yet.
    pub case: Option<PathBuf>,
    /// Length and hash of the text that was edited.
    pub(crate) base_stamp: Stamp,
    /// When the journal was written, in seconds since 1970.
    pub(crate) written: u64,
    /// The session of the journal.
    pub(crate) session: String,
    /// The edits, each from the value in the file to the typed text, valid or not.
    pub changes: Vec<Change>,
}

/// The content of a journal file below its checksum.
#[derive(Serialize, Deserialize)]
struct Body {
    written: u64,
    session: String,
    length: u64,
    /// In hexadecimal, because TOML has no such large integers.
    hash: String,
    case: Option<String>,
    /// A path that is not valid text.
    case_bytes: Option<Vec<u8>>,
    #[serde(default)]
    change: Vec<Change>,
}

/// Why a text is not a valid journal.
#[derive(Debug, Clone, PartialEq, Eq, Error)]
pub enum JournalFault {
    /// The text is not a journal.
    #[error("the file is not a journal")]
    NotOne,
    /// The journal has a newer format.
    #[error("the format {0} of the journal is newer than this version")]
    NewerFormat(i64),
    /// The journal was cut or changed after it was written.
    #[error("the journal is damaged")]
    Damaged,
}

impl Journal {
    /// Whether the journal belongs to the case in a file; without a file, to the text with a stamp.
    pub(crate) fn is_of(&self, case: Option<&Path>, stamp: Stamp) -> bool {
        self.case.as_deref() == case && (case.is_some() || self.base_stamp == stamp)
    }

    /// The text of a journal file.
    ///
    /// # Errors
    /// Returns an error if TOML cannot represent the journal.
    pub(crate) fn to_text(&self) -> io::Result<String> {
        let case = self.case.as_deref();
        let text = case.and_then(Path::to_str);
        let bytes = case.filter(|_| text.is_none()).map(sharing::path_bytes);
        let body = toml_edit::ser::to_string(&Body {
            written: self.written,
            session: self.session.clone(),
            length: self.base_stamp.length,
            hash: format!("{:016x}", self.base_stamp.hash),
            case: text.map(str::to_owned),
            case_bytes: bytes.map(<[u8]>::to_vec),
            change: self.changes.clone(),
        })
        .map_err(io::Error::other)?;
        let checksum = hash(body.as_bytes());
        Ok(format!("{OPENING}{FORMAT_KEY}{FORMAT}\n{CHECKSUM_KEY}\"{checksum:016x}\"\n{body}"))
    }

    /// Parses the text of a journal file.
    ///
    /// # Errors
    /// Returns an error if the text is not, byte for byte, an output of [`Journal::to_text`].
    pub fn from_text(text: &str) -> Result<Journal, JournalFault> {
        let rest = text.strip_prefix(OPENING).ok_or(JournalFault::NotOne)?;
        let (format, rest) = line_of(rest, FORMAT_KEY).ok_or(JournalFault::NotOne)?;
        match format.parse() {
            Ok(FORMAT) => {}
            Ok(newer) if newer > FORMAT => return Err(JournalFault::NewerFormat(newer)),
            _ => return Err(JournalFault::NotOne),
        }
        let (checksum, body) = line_of(rest, CHECKSUM_KEY).ok_or(JournalFault::Damaged)?;
        if checksum != format!("\"{:016x}\"", hash(body.as_bytes())) {
            return Err(JournalFault::Damaged);
        }
        let body: Body = toml_edit::de::from_str(body).map_err(|_| JournalFault::Damaged)?;
        let hash = u64::from_str_radix(&body.hash, 16).map_err(|_| JournalFault::Damaged)?;
        let bytes = body.case_bytes.map(sharing::path_from_bytes);
        Ok(Journal {
            case: body.case.map(PathBuf::from).or(bytes),
            base_stamp: Stamp { length: body.length, hash },
            written: body.written,
            session: body.session,
            changes: body.change,
        })
    }
}

/// The folders of journals and of session locks.
#[derive(Debug, Clone)]
pub(super) struct Journals {
    journals: PathBuf,
    sessions: PathBuf,
}

/// The journals of a case.
#[derive(Debug, Default)]
pub(super) struct Found {
    /// Journals of ended sessions, the latest first.
    pub(super) journals: Vec<(PathBuf, Journal)>,
    /// A sentence for each damaged journal.
    pub(super) notices: Vec<String>,
}

impl Journals {
    /// The folders inside a state folder.
    #[must_use]
    pub(super) fn within(state: &Path) -> Journals {
        Journals { journals: state.join("journals"), sessions: state.join("sessions") }
    }

    /// Starts a session: its lock shows others that its journals are still in use.
    ///
    /// # Errors
    /// Returns an error if the disk is full, or if another user could change the folders.
    pub(super) fn begin(&self) -> io::Result<(String, Lock)> {
        for folder in [&self.journals, &self.sessions] {
            state::make(folder)?;
            state::require_private(folder)?;
        }
        Lock::create(&self.sessions)
    }

    /// The path of the journal of a case in a session; `number` distinguishes cases without a file.
    #[must_use]
    pub(super) fn place(&self, case: Option<&Path>, session: &str, number: usize) -> PathBuf {
        self.journals.join(format!("{}{session}-{number}.{ENDING}", stem(case)))
    }

    /// Replaces a journal; a `lasting` write survives a power failure.
    ///
    /// # Errors
    /// Returns an error if the journal cannot be written; the previous one then remains.
    pub(super) fn write(path: &Path, journal: &Journal, lasting: bool) -> io::Result<()> {
        let folder = path.parent().unwrap_or(Path::new("."));
        let mut file = tempfile::Builder::new().prefix(".").tempfile_in(folder)?;
        file.write_all(journal.to_text()?.as_bytes())?;
        if lasting {
            file.as_file().sync_data()?;
        }
        file.persist(path).map(drop).map_err(|error| error.error)
    }

    /// The journals of a case from ended sessions. A case without a file is identified by the stamp
    /// of its text. Damaged journals are moved, never deleted.
    #[must_use]
    pub(super) fn left_behind(&self, case: Option<&Path>, stamp: Stamp) -> Found {
        let mut found = Found::default();
        for path in self.named(&stem(case)) {
            match read_file(&path) {
                Ok(Ok(journal)) if !journal.is_of(case, stamp) || self.is_written(&journal) => {}
                Ok(Ok(journal)) => found.journals.push((path, journal)),
                Ok(Err(fault)) => found.notices.push(set_aside(&path, &fault)),
                Err(error) => found
                    .notices
                    .push(format!("unsaved edits in {} cannot be read: {error}", shown(&path))),
            }
        }
        found.journals.sort_by_key(|(_, journal)| std::cmp::Reverse(journal.written));
        found
    }

    /// The journals of every case from ended sessions, each with its case, its number of edits and
    /// its age.
    pub(super) fn list(&self) -> Vec<(PathBuf, String)> {
        let journals = self.all_left_behind();
        let described = journals.map(|(path, journal)| {
            let count = journal.changes.len();
            let edits = if count == 1 { "edit" } else { "edits" };
            let missing = if is_missing(&journal) { ", no such file" } else { "" };
            let age = session::age(age_of(&journal));
            let words = format!("{}: {count} {edits}, {age} old{missing}", name_of(&journal));
            (path, words)
        });
        described.collect()
    }

    /// Reports recent journals of existing cases other than this one.
    pub(super) fn report(&self, case: Option<&Path>, stamp: Stamp) -> Option<String> {
        let others = self.all_left_behind().filter(|(_, journal)| {
            !journal.is_of(case, stamp) && !is_missing(journal) && age_of(journal) < RECENT
        });
        let mut names: BTreeSet<String> = others.map(|(_, journal)| name_of(&journal)).collect();
        let name = match names.len() {
            0 | 1 => names.pop_first()?,
            count => format!("{count} other cases"),
        };
        Some(format!("{name}: unsaved edits of an ended session; :journals lists them"))
    }

    fn all_left_behind(&self) -> impl Iterator<Item = (PathBuf, Journal)> {
        let journals = self.named("").into_iter().filter_map(|path| {
            let journal = read_file(&path).ok()?.ok()?;
            Some((path, journal))
        });
        journals.filter(|(_, journal)| !self.is_written(journal))
    }

    fn is_written(&self, journal: &Journal) -> bool {
        let is_a_name = journal.session.chars().all(|letter| letter.is_ascii_alphanumeric());
        is_a_name && Lock::is_held(&self.sessions.join(&journal.session))
    }

    fn named(&self, start: &str) -> Vec<PathBuf> {
        let entries =
            fs::read_dir(&self.journals).into_iter().flatten().flatten().map(|entry| entry.path());
        let fits = |path: &PathBuf| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            !name.starts_with('.')
                && name.starts_with(start)
                && path.extension().is_some_and(|ending| ending == ENDING)
        };
        let mut paths: Vec<_> = entries.filter(fits).collect();
        paths.sort();
        paths
    }
}

/// The requested journals, shared by the threads that may write them.
#[derive(Debug, Default)]
pub struct JournalWriter {
    entries: Mutex<Entries>,
    bell: Condvar,
    /// Locked during a write.
    write_lock: Mutex<()>,
}

impl JournalWriter {
    /// Starts the writer thread, which sleeps until [`JournalWriter::ring`]. `tell` receives the
    /// reason if a journal cannot be written.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn open(tell: impl Fn(String) + Send + 'static) -> io::Result<Arc<JournalWriter>> {
        let journal_writer = Arc::new(JournalWriter::default());
        let theirs = Arc::clone(&journal_writer);
        thread::Builder::new().name(THREAD.to_owned()).spawn(move || {
            while theirs.wait() {
                if let Err(error) = theirs.write(true) {
                    tell(format!("a crash would lose unsaved edits: {error}: save soon"));
                }
            }
        })?;
        Ok(journal_writer)
    }

    /// Sets the content of a journal; `None` removes it.
    pub(crate) fn put(&self, path: &Path, journal: Option<Journal>) {
        self.entries().by_path.entry(path.to_owned()).or_default().wanted = journal;
    }

    /// Wakes the thread, which writes every changed journal.
    pub(crate) fn ring(&self) {
        self.entries().is_due = true;
        self.bell.notify_all();
    }

    /// Writes every changed journal now. A journal survives the end of the process; a `lasting`
    /// write is flushed to the disk and also survives a power failure.
    ///
    /// # Errors
    /// The first error; the other journals are written nevertheless.
    pub fn write(&self, lasting: bool) -> io::Result<()> {
        let write_lock = self.write_lock.lock().unwrap_or_else(PoisonError::into_inner);
        let changed: Vec<_> = self.entries().changed();
        let mut result = Ok(());
        for (path, wanted) in changed {
            let written = match &wanted {
                Some(journal) => Journals::write(
                    &path,
                    &Journal { written: session::now(), ..journal.clone() },
                    lasting,
                ),
                None => fs::remove_file(&path).or_else(|error| {
                    if error.kind() == io::ErrorKind::NotFound { Ok(()) } else { Err(error) }
                }),
            };
            if written.is_ok() {
                self.entries().settle(&path, wanted);
            }
            result = result.and(written);
        }
        drop(write_lock);
        result
    }

    /// Whether any journal contains edits that no file has.
    #[must_use]
    pub fn is_needed(&self) -> bool {
        self.entries().by_path.values().any(|entry| entry.wanted.is_some())
    }

    /// Ends the thread.
    pub(crate) fn close(&self) {
        self.entries().is_closed = true;
        self.bell.notify_all();
    }

    fn entries(&self) -> MutexGuard<'_, Entries> {
        self.entries.lock().unwrap_or_else(PoisonError::into_inner)
    }

    // Returns false at the end.
    fn wait(&self) -> bool {
        let mut entries = self.entries();
        while !entries.is_due && !entries.is_closed {
            entries = self.bell.wait(entries).unwrap_or_else(PoisonError::into_inner);
        }
        entries.is_due = false;
        !entries.is_closed
    }
}

fn line_of<'t>(text: &'t str, key: &str) -> Option<(&'t str, &'t str)> {
    text.strip_prefix(key)?.split_once('\n')
}

/// Reads a journal; the inner error if the file is none.
fn read_file(path: &Path) -> io::Result<Result<Journal, JournalFault>> {
    if !fs::symlink_metadata(path)?.is_file() {
        return Ok(Err(JournalFault::NotOne));
    }
    let mut bytes = Vec::new();
    File::open(path)?.take(MOST_BYTES as u64 + 1).read_to_end(&mut bytes)?;
    if bytes.len() > MOST_BYTES {
        return Ok(Err(JournalFault::NotOne));
    }
    let text = String::from_utf8(bytes).map_err(|_| JournalFault::Damaged);
    Ok(text.and_then(|text| Journal::from_text(&text)))
}

// Returns the message. A journal that cannot be moved remains and is reported again.
fn set_aside(path: &Path, fault: &JournalFault) -> String {
    let free = (1..100)
        .map(|number| path.with_extension(format!("damaged-{number}")))
        .find(|name| fs::symlink_metadata(name).is_err());
    let moved = free.and_then(|name| fs::rename(path, &name).ok().map(|()| name));
    let place = moved.unwrap_or_else(|| path.to_owned());
    format!(
        "unsaved edits of this case cannot be restored: {fault}; the file is now {}",
        shown(&place)
    )
}

fn is_missing(journal: &Journal) -> bool {
    journal.case.as_ref().is_some_and(|path| !path.exists())
}

/// In seconds.
fn age_of(journal: &Journal) -> u64 {
    session::now().saturating_sub(journal.written)
}

fn name_of(journal: &Journal) -> String {
    match &journal.case {
        Some(path) => shown(path),
        None if journal.base_stamp == store::built_in().stamp() => "the built-in case".to_owned(),
        None => "a new case".to_owned(),
    }
}

fn shown(path: &Path) -> String {
    sanitize(&path.display().to_string())
}

// The start of the names of a case's journals: a few letters for the reader, and a hash that
// distinguishes cases with the same name.
fn stem(case: Option<&Path>) -> String {
    let Some(case) = case else {
        return "new-".to_owned();
    };
    let name = case.file_stem().unwrap_or_default().to_string_lossy();
    let letters: String =
        name.chars().filter(char::is_ascii_alphanumeric).take(MOST_LETTERS).collect();
    format!("case-{letters}-{:016x}-", hash(sharing::path_bytes(case)))
}

#[derive(Debug, Default)]
struct Entries {
    by_path: BTreeMap<PathBuf, Entry>,
    is_due: bool,
    is_closed: bool,
}

#[derive(Debug, Default)]
struct Entry {
    wanted: Option<Journal>,
    written: Option<Journal>,
}

impl Entries {
    fn changed(&self) -> Vec<(PathBuf, Option<Journal>)> {
        let differs = |(_, entry): &(&PathBuf, &Entry)| entry.wanted != entry.written;
        self.by_path
            .iter()
            .filter(differs)
            .map(|(path, entry)| (path.clone(), entry.wanted.clone()))
            .collect()
    }

    // If the case was closed during the write, its entry is gone. The entry is added again, so that
    // the next write deletes the file.
    fn settle(&mut self, path: &Path, written: Option<Journal>) {
        self.by_path.entry(path.to_owned()).or_default().written = written;
        self.by_path.retain(|_, entry| entry.wanted.is_some() || entry.written.is_some());
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn journal() -> Journal {
        let change = |key: &str, from: Option<&str>, to: Option<&str>| Change {
            key: key.to_owned(),
            from: from.map(str::to_owned),
            to: to.map(str::to_owned),
        };
        Journal {
            case: Some("/home/me/äöü \"quoted\"\n\u{1b}[2J.toml".into()),
            base_stamp: Stamp::of(b"format = 1\n"),
            written: 1_795_265_502,
            session: "abc123".to_owned(),
            changes: vec![
                change("pair.module", Some("5 mm"), Some("1 in")),
                change("title", Some("'''\"\"\"\\"), Some("\u{0}\u{7f}\u{9b}\r\n\u{202e}")),
                change("driver.tip_radius", None, Some("0.2 mm")),
                change("notes", Some("x"), None),
            ],
        }
    }

    #[test]
    fn a_journal_is_parsed_from_its_text() {
        let other =
            Journal { case: Some(sharing::path_from_bytes(vec![b'/', 0xff, b'a'])), ..journal() };
        let fresh = Journal { case: None, changes: Vec::new(), ..journal() };
        for journal in [journal(), other, fresh] {
            assert_eq!(Journal::from_text(&journal.to_text().expect("TOML")), Ok(journal));
        }
    }

    #[test]
    fn no_journal_that_is_cut_or_changed_is_trusted() {
        let text = journal().to_text().expect("TOML");
        for (at, _) in text.char_indices() {
            assert!(Journal::from_text(&text[..at]).is_err(), "cut at {at}");
            let changed: String = text
                .char_indices()
                .map(|(own, letter)| if own == at { '~' } else { letter })
                .collect();
            assert!(Journal::from_text(&changed).is_err() || changed == text, "changed at {at}");
        }
        assert!(Journal::from_text(&(text.clone() + "\n")).is_err());
        assert!(Journal::from_text(&text.replace('\n', "\r\n")).is_err());
    }

    #[test]
    fn a_journal_of_an_earlier_version_is_read() {
        let body = "written = 5\nsession = \"one\"\nlength = 11\nhash = \"00000000000000ff\"\n\
                    case = \"/c.toml\"\n\n[[change]]\nkey = \"title\"\nto = \"x\"\n";
        let sum = hash(body.as_bytes());
        let text = format!("{OPENING}format = 1\nchecksum = \"{sum:016x}\"\n{body}");
        let journal = Journal::from_text(&text).expect("a journal");
        assert_eq!(journal.base_stamp, Stamp { length: 11, hash: 255 });
        assert_eq!((journal.changes.len(), journal.changes[0].from.as_ref()), (1, None));
    }

    #[test]
    fn a_newer_journal_is_refused_by_its_version() {
        let newer = journal().to_text().expect("TOML").replace("format = 1", "format = 2");
        assert_eq!(Journal::from_text(&newer), Err(JournalFault::NewerFormat(2)));
        assert_eq!(Journal::from_text("format = 1\n"), Err(JournalFault::NotOne));
    }

    #[test]
    fn only_recent_journals_of_existing_cases_are_reported_and_all_are_listed() {
        let folder = tempfile::tempdir().expect("a folder");
        let journals = Journals::within(folder.path());
        drop(journals.begin().expect("our own folder"));
        let leave = |name: &str, age: u64| {
            let case = folder.path().join(name);
            let journal = Journal {
                case: Some(case.clone()),
                base_stamp: Stamp::of(b""),
                written: session::now() - age,
                session: "ended".to_owned(),
                changes: Vec::new(),
            };
            let place = journals.place(Some(&case), "ended", 0);
            Journals::write(&place, &journal, false).expect("room on the disk");
            case
        };
        let report =
            |case: Option<&Path>| journals.report(case, Stamp::of(b"")).unwrap_or_default();
        leave("deleted.toml", 60);
        fs::write(leave("old.toml", 40 * 86400), "").expect("room on the disk");
        assert_eq!(report(None), "");
        let one = leave("one.toml", 60);
        fs::write(&one, "").expect("room on the disk");
        assert!(report(None).starts_with(&format!("{}: ", one.display())));
        assert_eq!(report(Some(&one)), "");
        fs::write(leave("two.toml", 60), "").expect("room on the disk");
        assert!(report(None).starts_with("2 other cases: "));
        let list = journals.list();
        assert_eq!(list.len(), 4);
        assert!(list[0].1.ends_with("deleted.toml: 0 edits, 1 min old, no such file"));
    }

    fn journal_of(session: &str) -> Journal {
        Journal {
            case: None,
            base_stamp: Stamp::of(b""),
            written: 0,
            session: session.to_owned(),
            changes: Vec::new(),
        }
    }

    #[test]
    fn no_journal_stays_of_a_case_closed_during_a_write() {
        let folder = tempfile::tempdir().expect("a folder");
        let paths: Vec<PathBuf> =
            (0..20).map(|number| folder.path().join(number.to_string())).collect();
        for round in 0..20 {
            let writer = JournalWriter::default();
            for path in &paths {
                writer.put(path, Some(journal_of("one")));
            }
            std::thread::scope(|scope| {
                let first = scope.spawn(|| writer.write(false));
                while round > 0 && !paths[round % 7].exists() && !first.is_finished() {
                    std::thread::yield_now();
                }
                for path in &paths {
                    writer.put(path, None);
                }
                first.join().expect("no panic").expect("a write");
            });
            writer.write(false).expect("a second write");
            let left = fs::read_dir(folder.path()).expect("the folder").count();
            assert_eq!(left, 0, "round {round}");
        }
    }
}
