//! Journals of unsaved edits: their text, with a checksum that shows whether it is complete, their
//! folder, and the thread that writes them: the workbench never waits for a disk.
//!
//! The session that writes a journal has it locked; a journal without a lock is of an ended session.

use std::collections::{BTreeMap, BTreeSet};
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Read, Write};
use std::path::{Path, PathBuf};
use std::sync::mpsc::{Sender, channel};
use std::sync::{Arc, Mutex, MutexGuard, PoisonError};
use std::thread;

use serde::{Deserialize, Serialize};

use crate::case::changes::Change;
use crate::case::file::{Stamp, hash};
use crate::case::sanitize::sanitize;
use crate::system::sharing;
use crate::tui::session;
use crate::tui::store;

/// Greatest size of a journal to read, in bytes: more than the changes of any case.
const MOST_BYTES: u64 = 4 << 20;

const OPENING: &str =
    "# Edits that were not saved. tipstrike offers them when the case is opened again.\n";

/// The extension of a journal.
const ENDING: &str = "toml";
/// Number of letters of the case's name in the name of its journal.
const MOST_LETTERS: usize = 40;
/// Age in seconds of a journal that is not reported any more.
const RECENT: u64 = 30 * 86400;

/// Edits of a case that are not in its file.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Journal {
    /// The file of the case; `None` if it has none yet.
    pub case: Option<PathBuf>,
    /// Length and hash of the text that was edited.
    pub(crate) base_stamp: Stamp,
    /// When the journal was written, in seconds since 1970.
    pub(crate) written: u64,
    /// The edits, each from the value in the file to the typed text, valid or not.
    pub changes: Vec<Change>,
}

/// The content of a journal file below its checksum.
#[derive(Serialize, Deserialize)]
struct Body {
    written: u64,
    length: u64,
    /// In hexadecimal, because TOML has no such large integers.
    hash: String,
    case: Option<String>,
    /// A path that is not valid text.
    case_bytes: Option<Vec<u8>>,
    #[serde(default)]
    change: Vec<Change>,
}

/// The lines above the content: the format of journals that this version reads, and the checksum.
fn head(body: &str) -> String {
    format!("{OPENING}format = 1\nchecksum = \"{:016x}\"\n", hash(body.as_bytes()))
}

impl Journal {
    /// Whether the journal belongs to the case in a file; without a file, to the text with a stamp.
    fn is_of(&self, case: Option<&Path>, stamp: Stamp) -> bool {
        self.case.as_deref() == case && (case.is_some() || self.base_stamp == stamp)
    }

    fn to_text(&self) -> io::Result<String> {
        let case = self.case.as_deref();
        let text = case.and_then(Path::to_str);
        let bytes = case.filter(|_| text.is_none()).map(sharing::path_bytes);
        let body = toml::to_string(&Body {
            written: self.written,
            length: self.base_stamp.length,
            hash: format!("{:016x}", self.base_stamp.hash),
            case: text.map(str::to_owned),
            case_bytes: bytes.map(<[u8]>::to_vec),
            change: self.changes.clone(),
        })
        .map_err(io::Error::other)?;
        Ok(head(&body) + &body)
    }

    /// The journal of a text; `None` unless the text is, byte for byte, that of a journal.
    pub fn from_text(text: &str) -> Option<Journal> {
        let body = text.splitn(4, '\n').nth(3)?;
        if text.strip_suffix(body)? != head(body) {
            return None;
        }
        let body: Body = toml::from_str(body).ok()?;
        let hash = u64::from_str_radix(&body.hash, 16).ok()?;
        let bytes = body.case_bytes.map(sharing::path_from_bytes);
        Some(Journal {
            case: body.case.map(PathBuf::from).or(bytes),
            base_stamp: Stamp { length: body.length, hash },
            written: body.written,
            changes: body.change,
        })
    }

    /// In seconds.
    fn age(&self) -> u64 {
        session::now().saturating_sub(self.written)
    }

    fn is_missing(&self) -> bool {
        self.case.as_ref().is_some_and(|path| !path.exists())
    }

    fn name(&self) -> String {
        match &self.case {
            Some(path) => shown(path),
            None if self.base_stamp == store::built_in().stamp() => "the built-in case".to_owned(),
            None => "a new case".to_owned(),
        }
    }
}

/// The folder of journals.
#[derive(Debug, Clone)]
pub(super) struct Journals(PathBuf);

impl Journals {
    /// The folder inside a state folder.
    pub(super) fn within(folder: &Path) -> Journals {
        Journals(folder.join(store::JOURNALS))
    }

    /// Creates the folder, unless another user could change it.
    pub(super) fn create(&self) -> io::Result<()> {
        sharing::create_private(&self.0)?;
        store::is_private(&self.0).map_err(io::Error::other)
    }

    /// The path of the journal of a case in a session; `number` distinguishes cases without a file.
    pub(super) fn place(&self, case: Option<&Path>, session: &str, number: usize) -> PathBuf {
        self.0.join(format!("{}{session}-{number}.{ENDING}", stem(case)))
    }

    /// The journals of a case from ended sessions, the latest first, and a sentence for each damaged
    /// one. A case without a file is identified by the stamp of its text. Damaged journals are
    /// moved, never deleted.
    pub(super) fn left_behind(
        &self,
        case: Option<&Path>,
        stamp: Stamp,
    ) -> (Vec<(PathBuf, Journal)>, Vec<String>) {
        let (mut journals, mut notices) = (Vec::new(), Vec::new());
        for path in self.named(&stem(case)) {
            match read_file(&path) {
                Ok(journal) if journal.is_of(case, stamp) => journals.push((path, journal)),
                Err(error) if error.kind() == ErrorKind::InvalidData => {
                    notices.push(set_aside(&path));
                }
                Err(error) if error.kind() != ErrorKind::WouldBlock => {
                    let path = shown(&path);
                    notices.push(format!("unsaved edits in {path} cannot be read: {error}"));
                }
                _ => {}
            }
        }
        journals.sort_by_key(|(_, journal)| std::cmp::Reverse(journal.written));
        (journals, notices)
    }

    /// The journals of every case from ended sessions, each with its case, its number of edits and
    /// its age.
    pub(super) fn list(&self) -> Vec<(PathBuf, String)> {
        let described = self.all_left_behind().map(|(path, journal)| {
            let count = journal.changes.len();
            let edits = if count == 1 { "edit" } else { "edits" };
            let missing = if journal.is_missing() { ", no such file" } else { "" };
            let age = session::age(journal.age());
            (path, format!("{}: {count} {edits}, {age} old{missing}", journal.name()))
        });
        described.collect()
    }

    /// Reports recent journals of existing cases other than this one.
    pub(super) fn report(&self, case: Option<&Path>, stamp: Stamp) -> Option<String> {
        let others = self.all_left_behind().filter(|(_, journal)| {
            !journal.is_of(case, stamp) && !journal.is_missing() && journal.age() < RECENT
        });
        let mut names: BTreeSet<String> = others.map(|(_, journal)| journal.name()).collect();
        let name = match names.len() {
            0 | 1 => names.pop_first()?,
            count => format!("{count} other cases"),
        };
        Some(format!("{name}: unsaved edits of an ended session; :journals lists them"))
    }

    fn all_left_behind(&self) -> impl Iterator<Item = (PathBuf, Journal)> {
        let paths = self.named("").into_iter();
        paths.filter_map(|path| read_file(&path).ok().map(|journal| (path, journal)))
    }

    fn named(&self, start: &str) -> Vec<PathBuf> {
        let entries = fs::read_dir(&self.0).into_iter().flatten().flatten();
        let fits = |path: &PathBuf| {
            let name = path.file_name().unwrap_or_default().to_string_lossy();
            let is_journal = path.extension().is_some_and(|ending| ending == ENDING);
            is_journal && name.starts_with(start) && !name.starts_with('.')
        };
        let mut paths: Vec<_> = entries.map(|entry| entry.path()).filter(fits).collect();
        paths.sort();
        paths
    }
}

/// The requested journals, shared by the threads that may write them.
#[derive(Debug, Default)]
pub struct JournalWriter {
    entries: Mutex<BTreeMap<PathBuf, Entry>>,
    /// Locked during a write.
    write_lock: Mutex<()>,
    /// Wakes the thread.
    bell: Option<Sender<()>>,
}

#[derive(Debug, Default)]
struct Entry {
    wanted: Option<Journal>,
    /// The content of the file, and the file with its lock.
    written: Option<(Journal, File)>,
}

impl JournalWriter {
    /// Starts the writer thread, which sleeps until [`JournalWriter::ring`]. `tell` receives the
    /// reason if a journal cannot be written.
    ///
    /// # Errors
    /// Returns an error if the system cannot start a thread.
    pub fn open(tell: impl Fn(String) + Send + 'static) -> io::Result<Arc<JournalWriter>> {
        let (bell, rings) = channel();
        let writer = Arc::new(JournalWriter { bell: Some(bell), ..JournalWriter::default() });
        let theirs = Arc::downgrade(&writer);
        thread::Builder::new().name("journal".to_owned()).spawn(move || {
            for () in rings {
                let Some(writer) = theirs.upgrade() else { return };
                if let Err(error) = writer.write(true) {
                    tell(format!("a crash would lose unsaved edits: {error}: save soon"));
                }
            }
        })?;
        Ok(writer)
    }

    /// Sets the content of a journal; without content it is deleted.
    pub(crate) fn put(&self, path: &Path, journal: Option<Journal>) {
        let is_deleted = journal.is_none();
        locked(&self.entries).entry(path.to_owned()).or_default().wanted = journal;
        if is_deleted {
            self.ring();
        }
    }

    /// Wakes the thread, which writes every changed journal.
    pub(crate) fn ring(&self) {
        if let Some(bell) = &self.bell {
            let _ = bell.send(());
        }
    }

    /// Writes every changed journal now. A journal survives the end of the process; a `lasting`
    /// write is flushed to the disk and also survives a power failure. After an error the other
    /// journals are written nevertheless.
    ///
    /// # Errors
    /// The first error.
    pub fn write(&self, lasting: bool) -> io::Result<()> {
        let _one_at_a_time = locked(&self.write_lock);
        let changed = |(path, entry): (&PathBuf, &Entry)| {
            let written = entry.written.as_ref().map(|(journal, _)| journal);
            // An earlier session may have written the file of a journal that is not wanted.
            let is_known = entry.wanted.is_some() && entry.wanted.as_ref() == written;
            (!is_known).then(|| (path.clone(), entry.wanted.clone()))
        };
        let changed: Vec<_> = locked(&self.entries).iter().filter_map(changed).collect();
        let mut result = Ok(());
        for (path, wanted) in changed {
            let written = match wanted {
                Some(journal) => {
                    write_file(&path, &journal, lasting).map(|file| Some((journal, file)))
                }
                None => match fs::remove_file(&path) {
                    Err(error) if error.kind() != ErrorKind::NotFound => Err(error),
                    _ => Ok(None),
                },
            };
            match written {
                Ok(written) => {
                    let mut entries = locked(&self.entries);
                    entries.entry(path).or_default().written = written;
                    entries.retain(|_, entry| entry.wanted.is_some() || entry.written.is_some());
                }
                Err(error) => result = result.and(Err(error)),
            }
        }
        result
    }

    /// Whether any journal contains edits that no file has.
    pub fn is_needed(&self) -> bool {
        locked(&self.entries).values().any(|entry| entry.wanted.is_some())
    }
}

fn locked<T>(mutex: &Mutex<T>) -> MutexGuard<'_, T> {
    mutex.lock().unwrap_or_else(PoisonError::into_inner)
}

// Replaces a journal; on an error the previous one remains. The lock is taken before other sessions
// can see the file; in a file system without locks they offer the edits too early.
fn write_file(path: &Path, journal: &Journal, lasting: bool) -> io::Result<File> {
    let folder = path.parent().unwrap_or(Path::new("."));
    let mut file = tempfile::Builder::new().prefix(".").tempfile_in(folder)?;
    drop(file.as_file().try_lock());
    let journal = Journal { written: session::now(), ..journal.clone() };
    file.write_all(journal.to_text()?.as_bytes())?;
    if lasting {
        file.as_file().sync_data()?;
    }
    file.persist(path).map_err(|error| error.error)
}

/// Reads a journal. The error is `WouldBlock` if a running session writes it, and `InvalidData` if
/// the file is damaged or no journal of this version.
fn read_file(path: &Path) -> io::Result<Journal> {
    let is_file = fs::symlink_metadata(path)?.is_file();
    let mut text = String::new();
    if is_file {
        let file = File::open(path)?;
        if let Err(TryLockError::WouldBlock) = file.try_lock() {
            return Err(ErrorKind::WouldBlock.into());
        }
        file.take(MOST_BYTES).read_to_string(&mut text)?;
    }
    Journal::from_text(&text).ok_or_else(|| ErrorKind::InvalidData.into())
}

// Returns the message. A journal that cannot be moved remains and is reported again.
fn set_aside(path: &Path) -> String {
    let free = (1..100)
        .map(|number| path.with_extension(format!("damaged-{number}")))
        .find(|name| fs::symlink_metadata(name).is_err());
    let moved = free.filter(|name| fs::rename(path, name).is_ok());
    let place = shown(moved.as_deref().unwrap_or(path));
    format!(
        "unsaved edits of this case cannot be restored: the journal is damaged or of a newer \
         version; the file is now {place}"
    )
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
            assert_eq!(Journal::from_text(&journal.to_text().expect("TOML")), Some(journal));
        }
    }

    #[test]
    fn no_journal_that_is_cut_or_changed_is_trusted() {
        let text = journal().to_text().expect("TOML");
        for (at, _) in text.char_indices() {
            assert!(Journal::from_text(&text[..at]).is_none(), "cut at {at}");
            let changed: String = text
                .char_indices()
                .map(|(own, letter)| if own == at { '~' } else { letter })
                .collect();
            assert!(Journal::from_text(&changed).is_none() || changed == text, "changed at {at}");
        }
        assert!(Journal::from_text(&(text.clone() + "\n")).is_none());
        assert!(Journal::from_text(&text.replace('\n', "\r\n")).is_none());
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
    fn a_newer_journal_is_not_read() {
        let newer = journal().to_text().expect("TOML").replace("format = 1", "format = 2");
        assert_eq!(Journal::from_text(&newer), None);
    }

    #[test]
    fn only_recent_journals_of_existing_cases_are_reported_and_all_are_listed() {
        let folder = tempfile::tempdir().expect("a folder");
        let journals = Journals::within(folder.path());
        journals.create().expect("our own folder");
        let leave = |name: &str, age: u64| {
            let case = folder.path().join(name);
            let journal = Journal {
                case: Some(case.clone()),
                base_stamp: Stamp::of(b""),
                written: 0,
                changes: Vec::new(),
            };
            let place = journals.place(Some(&case), "ended", 0);
            let text = Journal { written: session::now() - age, ..journal }.to_text();
            fs::write(&place, text.expect("TOML")).expect("room on the disk");
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

    #[test]
    fn no_journal_stays_of_a_case_closed_during_a_write() {
        let folder = tempfile::tempdir().expect("a folder");
        let paths: Vec<PathBuf> =
            (0..20).map(|number| folder.path().join(number.to_string())).collect();
        for round in 0..20 {
            let writer = JournalWriter::default();
            for path in &paths {
                writer.put(path, Some(journal()));
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

    #[test]
    fn a_journal_is_of_an_ended_session_once_its_writer_is_gone() {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("one.toml");
        let writer = JournalWriter::default();
        for edits in [journal(), Journal { changes: Vec::new(), ..journal() }] {
            writer.put(&path, Some(edits));
            writer.write(false).expect("room on the disk");
            assert!(read_file(&path).is_err_and(|error| error.kind() == ErrorKind::WouldBlock));
        }
        drop(writer);
        assert!(read_file(&path).is_ok());
    }
}
