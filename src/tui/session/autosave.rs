//! Autosave of the open cases: takes their locks, saves them, writes their unsaved edits to
//! journals, and finds the journals of earlier sessions.
//!
//! An idle workbench sleeps: a deadline exists only while a journal is behind the edits.

use std::collections::BTreeMap;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::journal::{Found, Journal, JournalWriter, Journals};
use super::lock::{Lock, Locks};
use super::save::{Access, Claim, Offer, OpenCase, SaveFault, Saving, Written};
use crate::case::Case;
use crate::case::changes::{self, Change};
use crate::case::file::followed;
use crate::case::stamp::Stamp;
use crate::tui::session;
use crate::tui::store::state::State;

/// Delay of the journal after the last edit.
const AFTER_LAST: Duration = Duration::from_millis(900);
/// Greatest delay of the journal after the first edit that it lacks, while the user types.
const AFTER_FIRST: Duration = Duration::from_millis(1900);

/// Saves the open cases and journals their unsaved edits.
#[derive(Debug)]
pub struct Autosave {
    journal_writer: Arc<JournalWriter>,
    /// The journals of this session; `None` if no folder is private.
    journals: Option<Journals>,
    /// Folders in which earlier sessions may have written journals of the opened cases.
    others: Vec<Journals>,
    /// Whether the journals of other cases were reported.
    has_reported: bool,
    /// A message about the folder of journals, until it is shown.
    notice: Option<String>,
    /// The name of this session, and the lock that shows other sessions that it runs; from the
    /// first edit on.
    session: Option<(String, Lock)>,
    locks: Locks,
    tracked: BTreeMap<usize, Tracked>,
    /// Journals of earlier sessions whose edits are in the form.
    adopted: Vec<PathBuf>,
    due: Option<Due>,
}

/// An open case.
#[derive(Debug)]
struct Tracked {
    path: Option<PathBuf>,
    is_held: bool,
    /// The last edits that were passed to the journal.
    noted: Option<Case>,
    /// The stamp of the edited text.
    stamp: Option<Stamp>,
    journal: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy)]
struct Due {
    first: Instant,
    last: Instant,
}

impl Autosave {
    /// An autosave with journals in a state folder. Without a folder, edits are not journaled, and
    /// a claim reports this.
    #[must_use]
    pub fn new(state: State, journal_writer: Arc<JournalWriter>) -> Autosave {
        let journals = |folder: &PathBuf| Journals::within(folder);
        Autosave {
            journal_writer,
            journals: state.folder.as_ref().map(journals),
            others: state.others.iter().map(journals).collect(),
            has_reported: false,
            notice: state.notice,
            session: None,
            locks: Locks::default(),
            tracked: BTreeMap::new(),
            adopted: Vec::new(),
            due: None,
        }
    }

    /// Takes the locks of newly opened cases and passes new edits to the journal. Returns claims of
    /// the opened cases, and the reasons why edits cannot be journaled.
    pub fn follow(&mut self, cases: &[OpenCase<'_>], now: Instant) -> Vec<Result<Claim, String>> {
        self.drop_closed(cases);
        let claims: Vec<_> = cases.iter().filter_map(|case| self.claim(case)).collect();
        let mut results: Vec<_> = claims.into_iter().map(Ok).collect();
        for case in cases {
            results.extend(self.note(case, now).err().map(Err));
        }
        self.drop_adopted();
        results
    }

    /// The time at which the journal must be written; `None` if it is complete.
    #[must_use]
    pub fn deadline(&self) -> Option<Instant> {
        self.due.map(|due| (due.last + AFTER_LAST).min(due.first + AFTER_FIRST))
    }

    /// Requests the write of the journal if its time has come.
    pub fn keep_if_due(&mut self, now: Instant) {
        if self.deadline().is_some_and(|deadline| deadline <= now) {
            self.due = None;
            self.journal_writer.ring();
        }
    }

    /// Writes the journal now.
    pub fn keep(&mut self) {
        self.due = None;
        drop(self.journal_writer.write(false));
    }

    /// Saves a case, unless another session has its file open. The journal is written first, so
    /// that the edits are in the file or in the journal however the process ends.
    ///
    /// Without a lock, the save still compares the file with the text that was read, and does not
    /// overwrite changes of others.
    pub(crate) fn save(
        &mut self,
        mut saving: Saving,
    ) -> (PathBuf, Result<Box<Written>, SaveFault>) {
        self.keep();
        saving.expand();
        let lock = followed(&saving.path).map(|path| self.locks.take(&path));
        let result = match lock {
            Ok(Ok(Some(holder))) => Err(SaveFault::Held(holder.words(session::now()))),
            _ => saving.write(),
        };
        (saving.path, result)
    }

    /// The journals of ended sessions, each with its description.
    pub(crate) fn ended_sessions(&self) -> Vec<(PathBuf, String)> {
        self.journals.iter().flat_map(Journals::list).collect()
    }

    /// Deletes a journal of an earlier session once the journal of this session contains its edits.
    pub fn adopt(&mut self, journal: PathBuf) {
        self.adopted.push(journal);
    }

    /// Ends the session and deletes its journals: unsaved edits that remain are discarded.
    pub fn end(mut self) {
        self.drop_closed(&[]);
        drop(self.journal_writer.write(false));
        self.journal_writer.close();
    }

    // Drops closed cases, and cases that were saved under another name.
    fn drop_closed(&mut self, cases: &[OpenCase<'_>]) {
        let is_open = |id: usize, case: &Tracked| {
            cases.iter().any(|open| open.id == id && open.path == case.path.as_deref())
        };
        for (_, case) in self.tracked.iter().filter(|(id, case)| !is_open(**id, case)) {
            if let Some(journal) = &case.journal {
                self.journal_writer.put(journal, None);
                self.journal_writer.ring();
            }
        }
        self.tracked.retain(|id, case| is_open(*id, case));
        let paths = cases.iter().filter_map(|open| open.path);
        self.locks.keep_only(paths);
    }

    fn claim(&mut self, open: &OpenCase<'_>) -> Option<Claim> {
        if self.tracked.contains_key(&open.id) {
            return self.claim_again(open);
        }
        let lock = open.path.map_or(Ok(None), |path| self.locks.take(path));
        let case = Tracked {
            path: open.path.map(Path::to_owned),
            is_held: matches!(lock, Ok(Some(_))),
            noted: None,
            stamp: None,
            journal: None,
        };
        self.tracked.insert(open.id, case);
        let claim = match lock {
            // Edits of earlier sessions are offered to the session that may save them.
            Ok(Some(holder)) => Claim::of(open.id, Access::Held(holder.words(session::now()))),
            Ok(None) => self.found(open, None),
            Err(reason) => self.found(open, Some(reason)),
        };
        (open.is_held || !claim.is_silent()).then_some(claim)
    }

    // A save may have found that the other session has ended, or the user opened the same file
    // again.
    fn claim_again(&mut self, open: &OpenCase<'_>) -> Option<Claim> {
        let is_locked = open.path.is_some_and(|path| self.locks.has(path));
        let case = self
            .tracked
            .get(&open.id)
            .filter(|case| case.is_held && (is_locked || !open.is_held))?;
        let lock = case.path.clone().map_or(Ok(None), |path| self.locks.take(&path));
        let mut claim = Claim::of(open.id, Access::Own);
        match lock {
            Ok(None) => {}
            Ok(Some(holder)) => claim.access = Access::Held(holder.words(session::now())),
            Err(reason) => claim.notices.push(reason),
        }
        if let Some(case) = self.tracked.get_mut(&open.id) {
            case.is_held = claim.access != Access::Own;
        }
        Some(claim)
    }

    fn found(&mut self, open: &OpenCase<'_>, unlocked: Option<String>) -> Claim {
        let mut claim = Claim::of(open.id, Access::Own);
        claim.notices.extend(unlocked);
        claim.notices.extend(self.notice.take());
        let stamp = open.document.stamp();
        for folder in self.journals.iter().chain(&self.others) {
            let Found { journals, notices } = folder.left_behind(open.path, stamp);
            let offers =
                journals.into_iter().filter_map(|(place, journal)| offer(open, place, &journal));
            claim.offers.extend(offers);
            claim.notices.extend(notices);
        }
        // Only when the workbench starts.
        if !std::mem::replace(&mut self.has_reported, true) && claim.offers.is_empty() {
            let own = self.journals.as_ref();
            claim.notices.extend(own.and_then(|own| own.report(open.path, stamp)));
        }
        claim
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
        if let Some(edited) = unsaved {
            return self.put(open, edited, now);
        }
        case.stamp = None;
        if let Some(journal) = case.journal.take() {
            self.journal_writer.put(&journal, None);
            self.journal_writer.ring();
        }
        Ok(())
    }

    fn put(&mut self, open: &OpenCase<'_>, edited: &Case, now: Instant) -> Result<(), String> {
        let Some(journals) = &self.journals else {
            return Ok(());
        };
        if self.session.is_none() {
            let begun = journals.begin().map_err(|error| {
                format!(
                    "the journal cannot be written: {error}: save the case, or a crash loses \
                         the edits"
                )
            });
            self.session = Some(begun?);
        }
        let session = self.session.as_ref().map(|(session, _)| session.clone()).unwrap_or_default();
        let place = journals.place(open.path, &session, open.id);
        if let Some(case) = self.tracked.get_mut(&open.id) {
            let base_stamp = *case.stamp.get_or_insert_with(|| open.document.stamp());
            let changes = changes::between(open.document.loaded(), edited);
            let journal =
                Journal { case: case.path.clone(), base_stamp, written: 0, session, changes };
            self.journal_writer.put(&place, Some(journal));
            case.journal = Some(place);
        }
        self.due = Some(Due { first: self.due.map_or(now, |due| due.first), last: now });
        Ok(())
    }

    // Only once the journal of this session contains their edits.
    fn drop_adopted(&mut self) {
        if !self.adopted.is_empty()
            && self.journal_writer.is_needed()
            && self.journal_writer.write(false).is_ok()
        {
            self.adopted.drain(..).for_each(|journal| drop(fs::remove_file(journal)));
        }
    }
}

// A journal without differences from the file is deleted.
fn offer(open: &OpenCase<'_>, place: PathBuf, journal: &Journal) -> Option<Offer> {
    let from_now = |change: &Change| Change {
        from: changes::text_of(open.document.loaded(), &change.key),
        ..change.clone()
    };
    let changes: Vec<_> =
        journal.changes.iter().map(from_now).filter(|change| change.from != change.to).collect();
    if changes.is_empty() {
        drop(fs::remove_file(place));
        return None;
    }
    let age = session::age(session::now().saturating_sub(journal.written));
    Some(Offer {
        journal: place,
        age,
        changes,
        is_file_changed: journal.base_stamp != open.document.stamp(),
    })
}
