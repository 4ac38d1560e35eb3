//! Protection of typed values: saving, locks, journals of unsaved edits, and their recovery.
//!
//! An idle workbench sleeps: a deadline exists only while a journal is behind the edits.

pub(crate) mod journal;

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs::{self, File, TryLockError};
use std::io::{self, ErrorKind, Read, Seek, Write};
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use serde::{Deserialize, Serialize};

use crate::case::changes::{self, Change};
use crate::case::file::{MOST_BYTES, ReadError, SaveError, Saved, followed, read_bytes};
use crate::case::file::{Stamp, brief, hash};
use crate::case::sanitize::sanitize;
use crate::case::{Case, Document};
use crate::system::sharing;
use crate::tui::store::State;
use journal::{Journal, JournalWriter, Journals};

/// Delay of the journal after the last edit.
const AFTER_LAST: Duration = Duration::from_millis(900);
/// Greatest delay of the journal after the first edit that it lacks, while the user types.
const AFTER_FIRST: Duration = Duration::from_millis(1900);

/// Saves the open cases, takes their locks and journals their unsaved edits.
#[derive(Debug)]
pub struct Autosave {
    journal_writer: Arc<JournalWriter>,
    /// The journals of this session; `None` if no folder is private.
    journals: Option<Journals>,
    /// Whether the journals of other cases were reported.
    has_reported: bool,
    /// A message about the folder of journals, until it is shown.
    notice: Option<String>,
    /// The name of this session in the names of its journals, from the first edit on.
    session: Option<String>,
    locks: Locks,
    tracked: BTreeMap<usize, Tracked>,
    /// The journal of an earlier session whose edits are now in the form.
    adopted: Option<PathBuf>,
    /// The first and the last edit that the journals lack.
    behind: Option<(Instant, Instant)>,
}

/// An open case.
#[derive(Debug, Default)]
struct Tracked {
    path: Option<PathBuf>,
    is_held: bool,
    /// The last edits that were passed to the journal.
    noted: Option<Case>,
    journal: Option<PathBuf>,
}

impl Autosave {
    /// An autosave with journals in a state folder. Without a folder, edits are not journaled, and
    /// a claim reports this.
    pub fn new(state: State, journal_writer: Arc<JournalWriter>) -> Autosave {
        Autosave {
            journal_writer,
            journals: state.folder.as_deref().map(Journals::within),
            has_reported: false,
            notice: state.notice,
            session: None,
            locks: Locks::default(),
            tracked: BTreeMap::new(),
            adopted: None,
            behind: None,
        }
    }

    /// Takes the locks of newly opened cases and passes new edits to the journal. Returns claims of
    /// the opened cases, and the reasons why edits cannot be journaled.
    pub fn follow(&mut self, cases: &[OpenCase<'_>], now: Instant) -> Vec<Result<Claim, String>> {
        self.drop_closed(cases);
        let claims = cases.iter().filter_map(|case| self.claim(case)).map(Ok);
        let mut results: Vec<_> = claims.collect();
        results.extend(cases.iter().filter_map(|case| self.note(case, now).err()).map(Err));
        self.adopted = None;
        results
    }

    /// The time at which the journal must be written; `None` if it is complete.
    pub fn deadline(&self) -> Option<Instant> {
        self.behind.map(|(first, last)| (last + AFTER_LAST).min(first + AFTER_FIRST))
    }

    /// Requests the write of the journal if its time has come.
    pub fn keep_if_due(&mut self, now: Instant) {
        if self.deadline().is_some_and(|deadline| deadline <= now) {
            self.behind = None;
            self.journal_writer.ring();
        }
    }

    /// Writes the journal now.
    pub fn keep(&mut self) {
        self.behind = None;
        drop(self.journal_writer.write(false));
    }

    /// Saves a case, unless another session has its file open. The journal is written first, so
    /// that the edits are in the file or in the journal however the process ends.
    ///
    /// Without a lock, the save still compares the file with the text that was read, and does not
    /// overwrite changes of others.
    pub(crate) fn save(&mut self, saving: &Saving) -> Result<Box<Written>, SaveFault> {
        self.keep();
        match followed(&saving.path).map(|path| self.locks.take(&path)) {
            Ok(Ok(Some(holder))) => Err(SaveFault::Held(holder)),
            _ => saving.write(),
        }
    }

    /// The journals of ended sessions, each with its description.
    pub(crate) fn ended_sessions(&self) -> Vec<(PathBuf, String)> {
        self.journals.iter().flat_map(Journals::list).collect()
    }

    /// Makes the next journal replace the journal of an earlier session, whose edits it contains.
    pub fn adopt(&mut self, journal: PathBuf) {
        self.adopted = Some(journal);
    }

    /// Ends the session and deletes its journals: unsaved edits that remain are discarded.
    pub fn end(mut self) {
        self.drop_closed(&[]);
        drop(self.journal_writer.write(false));
    }

    // Drops closed cases, and cases that were saved under another name.
    fn drop_closed(&mut self, cases: &[OpenCase<'_>]) {
        self.tracked.retain(|id, case| {
            let is_open =
                cases.iter().any(|open| open.id == *id && open.path == case.path.as_deref());
            if let Some(journal) = case.journal.as_ref().filter(|_| !is_open) {
                self.journal_writer.put(journal, None);
            }
            is_open
        });
        self.locks.keep_only(cases.iter().filter_map(|open| open.path));
    }

    fn claim(&mut self, open: &OpenCase<'_>) -> Option<Claim> {
        let is_new = !self.tracked.contains_key(&open.id);
        let path = open.path.map(Path::to_owned);
        let case = self.tracked.entry(open.id).or_insert(Tracked { path, ..Tracked::default() });
        // A save may have found that the other session has ended, or the user opened the same file
        // again.
        let has_lock = open.path.is_some_and(|path| self.locks.has(path));
        if !is_new && !(case.is_held && (has_lock || !open.is_held)) {
            return None;
        }
        let mut claim = Claim::of(open.id, Access::Own);
        match open.path.map_or(Ok(None), |path| self.locks.take(path)) {
            Ok(None) => {}
            Ok(Some(holder)) => claim.access = Access::Held(holder),
            Err(reason) => claim.notices.push(reason),
        }
        case.is_held = claim.access != Access::Own;
        // Edits of earlier sessions are offered to the session that may save them.
        if is_new && !case.is_held {
            self.offer(open, &mut claim);
        }
        (!is_new || open.is_held || !claim.is_silent()).then_some(claim)
    }

    fn offer(&mut self, open: &OpenCase<'_>, claim: &mut Claim) {
        claim.notices.extend(self.notice.take());
        let Some(own) = &self.journals else { return };
        let stamp = open.document.stamp();
        let (journals, notices) = own.left_behind(open.path, stamp);
        for (place, journal) in journals {
            let changes = journal.changes.iter().map(|change| Change {
                from: changes::text_of(open.document.loaded(), &change.key),
                ..change.clone()
            });
            let changes: Vec<_> = changes.filter(|change| change.from != change.to).collect();
            if changes.is_empty() {
                drop(fs::remove_file(place));
                continue;
            }
            claim.offers.push(Offer {
                journal: place,
                age: age(now().saturating_sub(journal.written)),
                changes,
                is_file_changed: journal.base_stamp != stamp,
            });
        }
        claim.notices.extend(notices);
        // Only when the workbench starts.
        if !std::mem::replace(&mut self.has_reported, true) && claim.offers.is_empty() {
            claim.notices.extend(own.report(open.path, stamp));
        }
    }

    // Passes new edits to the journal. The error is the reason why they cannot be journaled.
    fn note(&mut self, open: &OpenCase<'_>, now: Instant) -> Result<(), String> {
        let unsaved = (open.case != open.document.loaded()).then_some(open.case);
        let Some(case) =
            self.tracked.get_mut(&open.id).filter(|case| case.noted.as_ref() != unsaved)
        else {
            return Ok(());
        };
        case.noted = unsaved.cloned();
        let (Some(edited), Some(journals)) = (unsaved, &self.journals) else {
            if let Some(journal) = case.journal.take() {
                self.journal_writer.put(&journal, None);
            }
            return Ok(());
        };
        if self.session.is_none() {
            journals.create().map_err(|error| {
                format!(
                    "the journal cannot be written: {error}: save the case, or a crash loses the \
                     edits"
                )
            })?;
        }
        let session = self.session.get_or_insert_with(|| {
            let unique = format!("{} {:?}", std::process::id(), SystemTime::now());
            format!("{:016x}", hash(unique.as_bytes()))
        });
        let own = || journals.place(open.path, session, open.id);
        let place = self.adopted.take().or_else(|| case.journal.clone()).unwrap_or_else(own);
        let journal = Journal {
            case: case.path.clone(),
            base_stamp: open.document.stamp(),
            written: 0,
            changes: changes::between(open.document.loaded(), edited),
        };
        self.journal_writer.put(&place, Some(journal));
        if let Some(replaced) = case.journal.replace(place.clone()).filter(|own| *own != place) {
            self.journal_writer.put(&replaced, None);
        }
        self.behind = Some((self.behind.map_or(now, |(first, _)| first), now));
        Ok(())
    }
}

const ONLY_SPACING: &str = "Every field is the same: only comments or spacing differ.";
const ALL_THE_SAME: &str = "The file and the form have the same values.";

/// The message for a case of a newer format.
pub(crate) const NEWER: &str =
    "read-only: newer format; fields that this version does not know are hidden";

/// The step after a save or after discarding edits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Next {
    /// Continue with this case.
    Stay,
    /// Quit the workbench.
    Quit,
    /// Save the remaining cases, then quit the workbench.
    SaveRest,
    /// Close this case.
    Close,
    /// Open this file instead of the case.
    Load(PathBuf),
}

/// A case that was written.
#[derive(Debug, Clone)]
pub struct Written {
    /// The document with its present text in the file.
    pub document: Document,
    /// The result of the write.
    pub(crate) saved: Saved,
}

/// Why a case was not written.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum SaveFault {
    /// A file with this name exists.
    Exists(Found),
    /// Another program has changed the file since it was read.
    Changed(Found),
    /// Another session has the file open: its process, machine and age.
    Held(String),
    /// Another reason, as text.
    Failed(String),
}

/// The content of a file that a save would overwrite.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub struct Found {
    /// The stamp of the content; `None` if the file cannot be read.
    pub stamp: Option<Stamp>,
    /// The differences from the form, one line per field.
    pub lines: Vec<String>,
}

/// A requested save.
#[derive(Debug, Clone)]
pub struct Saving {
    /// The document with the case of the form.
    pub(crate) document: Document,
    /// The file to write.
    pub path: PathBuf,
    /// The content of the file that the save may overwrite.
    pub(crate) over: Over,
}

/// The content of a file that a save may overwrite.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Over {
    /// Nothing: an existing file is not overwritten.
    Nothing,
    /// The content that was read, if no other program has changed it.
    Own,
    /// The content that the user saw, which has this stamp if it can be read.
    Seen(Option<Stamp>),
}

impl Saving {
    /// Writes the case. The caller must have the lock.
    fn write(&self) -> Result<Box<Written>, SaveFault> {
        let path = &self.path;
        let is_there = path.symlink_metadata().is_ok() && !path.is_dir();
        let mut document = self.document.clone();
        let result = match self.over {
            // The write refuses a pipe or a device without a question.
            Over::Nothing if is_there => return Err(self.conflict(false)),
            Over::Seen(seen) if is_there && stamp_of(path) != seen => {
                return Err(self.conflict(document.path() == followed(path).ok().as_deref()));
            }
            Over::Seen(_) => document.save_over(path),
            Over::Nothing | Over::Own => document.save(path),
        };
        match result {
            Ok(saved) => Ok(Box::new(Written { document, saved })),
            Err(SaveError::ChangedOnDisk(_)) => Err(self.conflict(true)),
            Err(SaveError::AlreadyThere(_)) => Err(self.conflict(false)),
            Err(other) => Err(SaveFault::Failed(other.to_string())),
        }
    }

    /// Why the file is not overwritten: its own file was changed, or another file exists; with one
    /// line per field that differs from the form.
    fn conflict(&self, is_own: bool) -> SaveFault {
        // The stamp first: a change before the next line then asks again.
        let stamp = stamp_of(&self.path);
        let mut lines = match Document::read_draft(&self.path) {
            Ok(theirs) => {
                let line = |change: Change| {
                    let (there, here) =
                        (shown(change.from.as_deref()), shown(change.to.as_deref()));
                    let before = changes::text_of(self.document.loaded(), &change.key);
                    let by = match (before == change.from, before == change.to) {
                        _ if !is_own => "",
                        (true, _) => " (changed in the form)",
                        (_, true) => " (changed in the file)",
                        (false, false) => " (changed in both)",
                    };
                    let label = changes::label(&change.key);
                    format!("{label}: {there} in the file, {here} in the form{by}")
                };
                changes::between(&theirs.case, &self.document.case).into_iter().map(line).collect()
            }
            Err(error) => {
                let is_case = !matches!(error, ReadError::Bad(_) | ReadError::NewerFormat(_));
                let error = error.to_string();
                let first = error.lines().next().unwrap_or_default();
                let cause = if is_case { "" } else { "It is not a valid case: " };
                vec![format!("{cause}{first}")]
            }
        };
        if lines.is_empty() {
            lines.push(if is_own { ONLY_SPACING } else { ALL_THE_SAME }.to_owned());
        }
        let found = Found { stamp, lines };
        if is_own { SaveFault::Changed(found) } else { SaveFault::Exists(found) }
    }
}

/// Whether this session may write the file of a case.
#[derive(Debug, Clone, PartialEq, Eq, Default)]
pub enum Access {
    /// The session may write the file.
    #[default]
    Own,
    /// Another session has the file open: its process, machine and age.
    Held(String),
    /// The case has a newer format that this version does not fully know.
    Newer,
}

/// An open case and its form.
#[derive(Debug, Clone, Copy)]
pub struct OpenCase<'a> {
    /// Unique among open cases.
    pub(crate) id: usize,
    /// Its file.
    pub(crate) path: Option<&'a Path>,
    /// The text of the file.
    pub(crate) document: &'a Document,
    /// The case in the form.
    pub(crate) case: &'a Case,
    /// Whether the header marks it as open elsewhere.
    pub(crate) is_held: bool,
}

/// The result of opening a case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Claim {
    /// The id of the open case.
    pub id: usize,
    /// Whether its file may be written.
    pub access: Access,
    /// Unsaved edits of earlier sessions, the latest first.
    pub offers: Vec<Offer>,
    /// Messages for the user, one sentence each.
    pub notices: Vec<String>,
}

/// Unsaved edits of an earlier session.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Offer {
    /// The journal of the edits.
    pub journal: PathBuf,
    /// Age of the journal as text.
    pub age: String,
    /// The edits, each from the present value in the file to the typed text.
    pub changes: Vec<Change>,
    /// Whether the file has changed since the edits.
    pub is_file_changed: bool,
}

impl Claim {
    /// A claim without offers and notices.
    pub fn of(id: usize, access: Access) -> Claim {
        Claim { id, access, offers: Vec::new(), notices: Vec::new() }
    }

    /// Whether the claim has no message for the user.
    pub(crate) fn is_silent(&self) -> bool {
        self.access == Access::Own && self.offers.is_empty() && self.notices.is_empty()
    }
}

impl Access {
    /// The initial access to a document.
    pub(crate) fn of(document: &Document) -> Access {
        if document.is_newer() { Access::Newer } else { Access::Own }
    }

    /// The mark beside the name of the case.
    pub(crate) fn mark(&self) -> &'static str {
        match self {
            Access::Own => "",
            Access::Held(_) | Access::Newer => " *read-only*",
        }
    }
}

/// A change on one line: the present value and the new one.
pub(crate) fn line(change: &Change) -> String {
    format!(
        "{}: {} -> {}",
        changes::label(&change.key),
        shown(change.from.as_deref()),
        shown(change.to.as_deref())
    )
}

/// The first changes on one line, and the number of the others.
pub(crate) fn summary(changes: &[Change]) -> String {
    const MOST: usize = 3;
    let first: Vec<_> = changes.iter().take(MOST).map(line).collect();
    let more = changes.len().saturating_sub(MOST);
    let more = if more > 0 { format!("; and {more} more") } else { String::new() };
    if first.is_empty() { "no value changes".to_owned() } else { first.join("; ") + &more }
}

/// A text cut to one short line; `(empty)` without a text.
pub(crate) fn shown(text: Option<&str>) -> String {
    const MOST: usize = 40;
    match text {
        None => "(empty)".to_owned(),
        Some(text) if text.chars().count() > MOST => {
            text.chars().take(MOST - 1).chain(['…']).collect()
        }
        Some(text) => text.to_owned(),
    }
}

fn stamp_of(path: &Path) -> Option<Stamp> {
    read_bytes(path, MOST_BYTES).ok().map(|bytes| Stamp::of(&bytes))
}

/// Attempts to lock: another process may delete the lock file between opening and locking it.
const ATTEMPTS: usize = 5;

/// Greatest size of a lock file.
const LONGEST_LOCK: u64 = 4096;

/// A lock; dropping it releases the lock.
#[derive(Debug)]
struct Lock {
    file: File,
    path: PathBuf,
}

impl Lock {
    /// Takes a lock, or names the running process that has it. The file of an ended process is
    /// reused: the system releases a lock with its process.
    ///
    /// # Errors
    /// Returns an error if the lock file cannot be created or is not a regular file, or if the file
    /// system has no locks.
    fn take(path: &Path) -> io::Result<Result<Lock, Holder>> {
        for _ in 0..ATTEMPTS {
            let mut file = open(path)?;
            let held = file.try_lock();
            if let Err(TryLockError::WouldBlock) = held {
                return Ok(Err(Holder::read(&mut file).unwrap_or_default()));
            }
            let mut lock = Lock { file, path: path.to_owned() };
            if let Err(TryLockError::Error(error)) = held {
                return Err(error);
            }
            if lock.is_in_place() {
                lock.sign();
                return Ok(Ok(lock));
            }
        }
        Err(io::Error::other("changes too often"))
    }

    // The text only names the process: a lock without it still works.
    fn sign(&mut self) {
        let text = Holder::ourselves().to_text();
        let file = &mut self.file;
        // Whatever the umask: a user who cannot read the file cannot find out who has the lock.
        drop(sharing::open_to_readers(file));
        drop(
            file.set_len(0)
                .and_then(|()| file.rewind())
                .and_then(|()| file.write_all(text.as_bytes())),
        );
    }

    // The last holder deletes the file, possibly while this process opens it.
    fn is_in_place(&self) -> bool {
        let both =
            self.file.metadata().and_then(|ours| Ok((ours, fs::symlink_metadata(&self.path)?)));
        both.is_ok_and(|(ours, there)| sharing::is_same_file(&ours, &there))
    }
}

impl Drop for Lock {
    fn drop(&mut self) {
        if self.is_in_place() {
            drop(fs::remove_file(&self.path));
        }
    }
}

/// The holder of a lock; the process is 0 if the file does not name it.
#[derive(Debug, Clone, PartialEq, Eq, Default, Serialize, Deserialize)]
struct Holder {
    /// The host name.
    host: String,
    /// The process id.
    process: u32,
    /// Time of the lock, in seconds since 1970.
    since: u64,
}

impl Holder {
    /// This process.
    fn ourselves() -> Holder {
        Holder { host: sharing::host(), process: std::process::id(), since: now() }
    }

    /// The holder as text for a message.
    fn words(&self) -> String {
        let Holder { host, process, since } = self;
        let age = age(now().saturating_sub(*since));
        match process {
            0 => "an unknown process".to_owned(),
            _ => format!("process {process} on {host} for {age}"),
        }
    }

    fn to_text(&self) -> String {
        let toml = toml::to_string(self).unwrap_or_default();
        format!("# tipstrike has this case open.\n{toml}")
    }

    fn read(file: &mut File) -> Option<Holder> {
        let mut text = String::new();
        file.rewind().ok()?;
        file.take(LONGEST_LOCK).read_to_string(&mut text).ok()?;
        toml::from_str(&text).ok()
    }
}

/// The locks by the names of the lock files; the path of a lock is that of its folder without links,
/// because two names may lead to one file.
#[derive(Debug, Default)]
struct Locks(BTreeMap<PathBuf, Lock>);

impl Locks {
    /// Takes the lock of a case. Returns the process that has the case open, or `None` if this
    /// session now has the lock. The error is the reason why the case has no lock.
    fn take(&mut self, path: &Path) -> Result<Option<String>, String> {
        let Some(named) = lock_of(path).filter(|named| !self.0.contains_key(named)) else {
            return Ok(None);
        };
        let whole = followed(path).ok().and_then(|path| lock_of(&path));
        let place = whole.unwrap_or_else(|| named.clone());
        if self.0.values().any(|lock| lock.path == place) {
            return Ok(None);
        }
        match Lock::take(&place).map_err(|error| unlocked(path, &place, &error))? {
            Err(holder) => Ok(Some(holder.words())),
            Ok(lock) => {
                self.0.insert(named, lock);
                Ok(None)
            }
        }
    }

    /// Whether this session has the lock of the case.
    fn has(&self, path: &Path) -> bool {
        lock_of(path).is_some_and(|place| self.0.contains_key(&place))
    }

    /// Releases the locks of all other cases.
    fn keep_only<'a>(&mut self, cases: impl Iterator<Item = &'a Path>) {
        let wanted: Vec<_> = cases.filter_map(lock_of).collect();
        self.0.retain(|named, _| wanted.contains(named));
    }
}

// Another user may have created a link or a pipe with that name: the link is not followed, and the
// pipe does not block.
fn open(path: &Path) -> io::Result<File> {
    let is_link = || fs::symlink_metadata(path).is_ok_and(|about| about.is_symlink());
    match sharing::open_lock(path) {
        Err(_) if is_link() => Err(io::Error::other("is a symbolic link")),
        Ok(file) if !file.metadata()?.is_file() => Err(io::Error::other("is not a regular file")),
        other => other,
    }
}

// The lock file is beside the case, so that other users and other machines also see it: whoever may
// save there may lock there.
fn lock_of(path: &Path) -> Option<PathBuf> {
    let mut name = OsString::from(".");
    name.push(path.file_name()?);
    name.push(".tipstrike");
    Some(path.with_file_name(name))
}

/// Why a case has no lock, and the fix.
fn unlocked(path: &Path, place: &Path, error: &io::Error) -> String {
    let lock = name_of(place);
    let (cause, fix) = match error.kind() {
        ErrorKind::PermissionDenied if place.symlink_metadata().is_ok() => (
            format!("another user created its lock {lock}, which you cannot read"),
            "ask whether that user has the case open",
        ),
        ErrorKind::PermissionDenied | ErrorKind::ReadOnlyFilesystem => {
            ("its folder is read-only".to_owned(), "save it elsewhere")
        }
        ErrorKind::IsADirectory => (format!("{lock} is a folder"), "remove that"),
        ErrorKind::Other => (format!("{lock} {error}"), "remove that"),
        _ => (format!("{lock}: {}", brief(error)), "open it only once"),
    };
    let name = name_of(path);
    format!("{name} is not locked, so other sessions may save it too: {cause}: {fix}")
}

fn name_of(path: &Path) -> String {
    sanitize(&path.file_name().unwrap_or_default().to_string_lossy())
}

/// Seconds since 1970.
fn now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs())
}

/// A duration in seconds as text.
pub(crate) fn age(seconds: u64) -> String {
    let (minutes, hours, days) = (seconds / 60, seconds / 3600, seconds / 86400);
    match (days, hours, minutes) {
        (2.., ..) => format!("{days} days"),
        (_, 1.., _) => format!("{hours} h {} min", minutes % 60),
        (_, _, 1..) => format!("{minutes} min"),
        _ => format!("{seconds} s"),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn durations_are_rounded_to_a_readable_unit() {
        let ages = [0, 59, 60, 3599, 3600, 7260, 100_000, 172_800].map(age);
        assert_eq!(
            ages,
            ["0 s", "59 s", "1 min", "59 min", "1 h 0 min", "2 h 1 min", "27 h 46 min", "2 days"]
        );
    }

    use std::os::unix::fs::PermissionsExt;

    fn place() -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().expect("a folder");
        let path = folder.path().join("lock");
        (folder, path)
    }

    fn ours(path: &Path) -> Lock {
        Lock::take(path).expect("a lock").expect("no holder")
    }

    #[test]
    fn one_session_has_a_lock_which_names_it_and_is_deleted_at_the_end() {
        let (_folder, path) = place();
        let lock = ours(&path);
        let holder = Lock::take(&path).expect("a lock").expect_err("a holder");
        assert_eq!((holder.process, holder.host), (std::process::id(), sharing::host()));
        drop(lock);
        assert!(!path.exists());
        drop(ours(&path));
    }

    #[test]
    fn every_user_can_read_the_lock_of_a_user_with_a_strict_umask() {
        let (_folder, path) = place();
        let file = File::create(&path).expect("room on the disk");
        file.set_permissions(fs::Permissions::from_mode(0o600)).expect("our own file");
        let lock = ours(&path);
        let mode = fs::metadata(&path).expect("it is there").permissions().mode();
        assert_eq!(mode & 0o777, 0o644);
        drop(lock);
    }

    #[test]
    fn the_lock_file_of_an_ended_process_never_blocks() {
        // Nobody has locked the file, so that even the text of a running process has no effect.
        let ourselves = Holder::ourselves();
        let dead = Holder { process: u32::MAX / 4, ..ourselves.clone() };
        let texts = [dead, ourselves].map(|holder| holder.to_text());
        for text in texts.iter().map(String::as_str).chain(["", "\0\u{1b}[2J", "process = -1"]) {
            let (_folder, path) = place();
            fs::write(&path, text).expect("room on the disk");
            drop(ours(&path));
        }
    }

    #[test]
    fn no_link_is_followed_and_no_pipe_waited_for() {
        let (folder, path) = place();
        let other = folder.path().join("other");
        fs::write(&other, "mine").expect("room on the disk");
        std::os::unix::fs::symlink(&other, &path).expect("a link");
        assert!(Lock::take(&path).is_err());
        assert_eq!(fs::read_to_string(&other).expect("it is there"), "mine");
        let pipe = folder.path().join("pipe");
        assert!(
            std::process::Command::new("mkfifo")
                .arg(&pipe)
                .status()
                .is_ok_and(|status| status.success())
        );
        assert!(Lock::take(&pipe).is_err());
        assert!(Lock::take(&folder.path().join("none/lock")).is_err());
    }

    #[test]
    fn a_lock_that_cannot_be_read_is_not_called_a_read_only_folder() {
        let folder = tempfile::tempdir().expect("a folder");
        let case = folder.path().join("case.toml");
        let lock = lock_of(&case).expect("a name");
        let denied = io::Error::from(ErrorKind::PermissionDenied);
        assert!(unlocked(&case, &lock, &denied).contains("its folder is read-only"));
        std::fs::write(&lock, "").expect("room on the disk");
        let words = unlocked(&case, &lock, &denied);
        assert!(!words.contains("read-only"), "{words}");
        assert!(words.contains("created its lock .case.toml.tipstrike"), "{words}");
    }
}
