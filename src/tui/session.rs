//! Protection of typed values: saving, locks, journals of unsaved edits, and their recovery.
//!
//! An idle workbench sleeps: a deadline exists only while a journal is behind the edits.

pub(crate) mod journal;
pub(crate) mod lock;
pub(crate) mod save;

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant, SystemTime, UNIX_EPOCH};

use crate::case::Case;
use crate::case::changes::{self, Change};
use crate::case::file::followed;
use crate::case::stamp::hash;
use crate::tui::store::State;
use journal::{Journal, JournalWriter, Journals};
use lock::Locks;
use save::{Access, Claim, Offer, OpenCase, SaveFault, Saving, Written};

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

/// Seconds since 1970.
fn now() -> u64 {
    SystemTime::now().duration_since(UNIX_EPOCH).map_or(0, |time| time.as_secs())
}

/// A duration in seconds as text.
fn age(seconds: u64) -> String {
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
    use super::age;

    #[test]
    fn durations_are_rounded_to_a_readable_unit() {
        let ages = [0, 59, 60, 3599, 3600, 7260, 100_000, 172_800].map(age);
        assert_eq!(
            ages,
            ["0 s", "59 s", "1 min", "59 min", "1 h 0 min", "2 h 1 min", "27 h 46 min", "2 days"]
        );
    }
}
