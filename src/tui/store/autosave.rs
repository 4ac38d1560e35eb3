//! Keeps what is typed: follows the open cases, holds their locks, has their unsaved edits kept,
//! finds those left behind.
//!
//! Nothing here wakes an idle workbench: a deadline exists only while there are edits that no
//! journal holds.

use std::collections::BTreeMap;
use std::ffi::OsString;
use std::fs;
use std::path::{Path, PathBuf};
use std::sync::Arc;
use std::time::{Duration, Instant};

use super::clock;
use super::journal_writer::JournalWriter;
use super::journals::{Found, Journals};
use super::lock::{Holder, Lock, Taken};
use super::{SaveFault, Saving, expanded, save};
use crate::case::changes::{self, Change};
use crate::case::file::followed;
use crate::case::journal::{Journal, Stamp};
use crate::case::{Case, Document};
use crate::tui::recovery::{Access, Claim, Offer, OpenCase};

/// Edits are kept so long after the last of them,
const AFTER_LAST: Duration = Duration::from_millis(900);
/// and so long after the first one that is not kept, while more are typed.
const AFTER_FIRST: Duration = Duration::from_millis(1900);

/// Keeps what is typed into the open cases.
#[derive(Debug)]
pub struct Autosave {
    journal_writer: Arc<JournalWriter>,
    journals: Option<Journals>,
    /// The name of this session, and the lock that tells others that it lives; from the first edit
    /// on.
    session: Option<(String, Lock)>,
    locks: BTreeMap<PathBuf, Lock>,
    charges: BTreeMap<usize, Tracked>,
    /// Journals of earlier sessions whose edits are in the form now.
    adopted: Vec<PathBuf>,
    due: Option<Due>,
}

/// An open case.
#[derive(Debug)]
struct Tracked {
    path: Option<PathBuf>,
    is_held: bool,
    /// The last edits that were handed on.
    noted: Option<Case>,
    /// Of the text that they stand on.
    stamp: Option<Stamp>,
    page: Option<PathBuf>,
}

#[derive(Debug, Clone, Copy)]
struct Due {
    first: Instant,
    last: Instant,
}

impl Autosave {
    /// Keep journals in a folder; without one, nothing can be kept, and a claim says so. The
    /// journal_writer is where they are written from.
    #[must_use]
    pub fn new(state: Option<&Path>, journal_writer: Arc<JournalWriter>) -> Autosave {
        Autosave {
            journal_writer,
            journals: state.map(Journals::within),
            session: None,
            locks: BTreeMap::new(),
            charges: BTreeMap::new(),
            adopted: Vec::new(),
            due: None,
        }
    }

    /// Take note of what is open and of what was typed; what is to be told about it, and why edits
    /// cannot be kept.
    pub fn follow(&mut self, sheets: &[OpenCase<'_>], now: Instant) -> Vec<Result<Claim, String>> {
        self.let_go(sheets);
        let claims: Vec<_> = sheets
            .iter()
            .filter_map(|sheet| self.claim(sheet))
            .collect();
        let mut told: Vec<_> = claims.into_iter().map(Ok).collect();
        for sheet in sheets {
            told.extend(self.note(sheet, now).err().map(Err));
        }
        self.drop_adopted();
        told
    }

    /// Until when edits must be kept; `None` while all are.
    #[must_use]
    pub fn deadline(&self) -> Option<Instant> {
        self.due
            .map(|due| (due.last + AFTER_LAST).min(due.first + AFTER_FIRST))
    }

    /// Have the edits kept if it is time.
    pub fn keep_if_due(&mut self, now: Instant) {
        if self.deadline().is_some_and(|deadline| deadline <= now) {
            self.due = None;
            self.journal_writer.ring();
        }
    }

    /// Keep the edits here and now.
    pub fn keep(&mut self) {
        self.due = None;
        drop(self.journal_writer.write(false));
    }

    /// Write a case, unless another session has its file open; where, and how it went. The edits
    /// are kept first: whatever ends the process in the midst of it, they are in the file or in the
    /// journal.
    pub fn save(&mut self, mut saving: Saving) -> (PathBuf, Result<Box<Document>, SaveFault>) {
        self.keep();
        saving.path = expanded(&saving);
        let holder = followed(&saving.path)
            .ok()
            .and_then(|path| self.lock(&path));
        let result = holder.map_or_else(
            || save(&saving),
            |holder| Err(SaveFault::Held(holder.words(clock::now()))),
        );
        (saving.path, result)
    }

    /// Take a journal for dealt with, once the edits in the form are kept.
    pub fn adopt(&mut self, journal: PathBuf) {
        self.adopted.push(journal);
    }

    /// Leave, with nothing unsaved that is wanted.
    pub fn end(mut self) {
        self.let_go(&[]);
        drop(self.journal_writer.write(false));
        self.journal_writer.close();
    }

    // What is open no more, or under another name.
    fn let_go(&mut self, sheets: &[OpenCase<'_>]) {
        let is_open = |id: usize, charge: &Tracked| {
            sheets
                .iter()
                .any(|sheet| sheet.id == id && sheet.path == charge.path.as_deref())
        };
        for (_, charge) in self
            .charges
            .iter()
            .filter(|(id, charge)| !is_open(**id, charge))
        {
            if let Some(page) = &charge.page {
                self.journal_writer.put(page, None);
                self.journal_writer.ring();
            }
        }
        self.charges.retain(|id, charge| is_open(*id, charge));
        let wanted: Vec<_> = sheets
            .iter()
            .filter_map(|sheet| lock_of(sheet.path?))
            .collect();
        self.locks.retain(|place, _| wanted.contains(place));
    }

    fn claim(&mut self, sheet: &OpenCase<'_>) -> Option<Claim> {
        if self.charges.contains_key(&sheet.id) {
            return self.claim_again(sheet);
        }
        let holder = sheet.path.and_then(|path| self.lock(path));
        let path = sheet.path.map(Path::to_owned);
        self.charges.insert(
            sheet.id,
            Tracked {
                path,
                is_held: holder.is_some(),
                noted: None,
                stamp: None,
                page: None,
            },
        );
        let claim = match holder {
            // Edits left behind are for the session that may save them.
            Some(holder) => Claim::of(sheet.id, Access::Held(holder.words(clock::now()))),
            None => self.found(sheet),
        };
        (sheet.is_held || !claim.is_silent()).then_some(claim)
    }

    // A save may have found that the other session has ended; or the same file was opened anew.
    fn claim_again(&mut self, sheet: &OpenCase<'_>) -> Option<Claim> {
        let is_locked = sheet
            .path
            .and_then(lock_of)
            .is_some_and(|place| self.locks.contains_key(&place));
        let charge = self
            .charges
            .get(&sheet.id)
            .filter(|charge| charge.is_held && (is_locked || !sheet.is_held))?;
        let holder = charge.path.clone().and_then(|path| self.lock(&path));
        let access = holder.map_or(Access::Own, |holder| {
            Access::Held(holder.words(clock::now()))
        });
        if let Some(charge) = self.charges.get_mut(&sheet.id) {
            charge.is_held = access != Access::Own;
        }
        Some(Claim::of(sheet.id, access))
    }

    fn found(&self, sheet: &OpenCase<'_>) -> Claim {
        let mut claim = Claim::of(sheet.id, Access::Own);
        match &self.journals {
            None => claim.notices.push(
                "edits are not kept for a crash: set HOME or XDG_STATE_HOME to a folder".to_owned(),
            ),
            Some(folder) => {
                let Found { journals, notices } = folder.left_behind(sheet.path);
                claim.offers = journals
                    .into_iter()
                    .filter_map(|(place, journal)| offer(sheet, place, &journal))
                    .collect();
                claim.notices = notices;
                // Told once, when the workbench opens.
                if self.charges.len() == 1 && claim.offers.is_empty() {
                    claim.notices.extend(elsewhere(folder, sheet.path));
                }
            }
        }
        claim
    }

    // Who has the case open, if it cannot be ours. Where no lock can be made, no save can either.
    fn lock(&mut self, path: &Path) -> Option<Holder> {
        let place = lock_of(path).filter(|place| !self.locks.contains_key(place))?;
        match Lock::take(&place) {
            Ok(Taken::Held(holder)) => return Some(holder),
            Ok(Taken::Ours(lock)) => drop(self.locks.insert(place, lock)),
            Err(_) => {}
        }
        None
    }

    // Hand on what is new. The error says why it cannot be kept.
    fn note(&mut self, sheet: &OpenCase<'_>, now: Instant) -> Result<(), String> {
        let unsaved = (sheet.case != sheet.document.loaded()).then_some(sheet.case);
        let Some(charge) = self
            .charges
            .get_mut(&sheet.id)
            .filter(|charge| charge.noted.as_ref() != unsaved)
        else {
            return Ok(());
        };
        charge.noted = unsaved.cloned();
        if let Some(case) = unsaved {
            return self.put(sheet, case, now);
        }
        charge.stamp = None;
        if let Some(page) = charge.page.take() {
            self.journal_writer.put(&page, None);
            self.journal_writer.ring();
        }
        Ok(())
    }

    fn put(&mut self, sheet: &OpenCase<'_>, case: &Case, now: Instant) -> Result<(), String> {
        let Some(journals) = &self.journals else {
            return Ok(());
        };
        if self.session.is_none() {
            let begun = journals
                .begin()
                .map_err(|error| format!("edits are not kept for a crash: {error}: save soon"));
            self.session = Some(begun?);
        }
        let session = self
            .session
            .as_ref()
            .map(|(session, _)| session.clone())
            .unwrap_or_default();
        let page = journals.place(sheet.path, &session, sheet.id);
        if let Some(charge) = self.charges.get_mut(&sheet.id) {
            let stands_on = *charge.stamp.get_or_insert_with(|| sheet.document.stamp());
            let changes = changes::between(sheet.document.loaded(), case);
            let journal = Journal {
                case: charge.path.clone(),
                stands_on,
                written: 0,
                session,
                changes,
            };
            self.journal_writer.put(&page, Some(journal));
            charge.page = Some(page);
        }
        self.due = Some(Due {
            first: self.due.map_or(now, |due| due.first),
            last: now,
        });
        Ok(())
    }

    // Only when their edits are kept anew.
    fn drop_adopted(&mut self) {
        if !self.adopted.is_empty()
            && self.journal_writer.is_needed()
            && self.journal_writer.write(false).is_ok()
        {
            self.adopted
                .drain(..)
                .for_each(|journal| drop(fs::remove_file(journal)));
        }
    }
}

// Beside the case, so that other users and other machines see it as well: whoever may save there
// may lock there.
fn lock_of(path: &Path) -> Option<PathBuf> {
    let mut name = OsString::from(".");
    name.push(path.file_name()?);
    name.push(".tipstrike");
    Some(path.with_file_name(name))
}

// Other cases for which edits were left behind.
fn elsewhere(journals: &Journals, open: Option<&Path>) -> Option<String> {
    let others: Vec<_> = journals
        .cases_left_behind()
        .into_iter()
        .filter(|case| case.as_deref() != open)
        .collect();
    let name = |case: &Option<PathBuf>| {
        case.as_ref()
            .map_or("the built-in case".to_owned(), |path| {
                path.display().to_string()
            })
    };
    let more = if others.len() > 1 {
        format!(" and {} more", others.len() - 1)
    } else {
        String::new()
    };
    others.first().map(|case| {
        format!(
            "unsaved edits of {}{more} are kept: open it to get them back",
            name(case)
        )
    })
}

// A journal that says what the file says by now has nothing to offer.
fn offer(sheet: &OpenCase<'_>, place: PathBuf, journal: &Journal) -> Option<Offer> {
    let from_now = |change: &Change| Change {
        from: changes::text_of(sheet.document.loaded(), &change.key),
        ..change.clone()
    };
    let changes: Vec<_> = journal
        .changes
        .iter()
        .map(from_now)
        .filter(|change| change.from != change.to)
        .collect();
    if changes.is_empty() {
        drop(fs::remove_file(place));
        return None;
    }
    let age = clock::age(clock::now().saturating_sub(journal.written));
    Some(Offer {
        journal: place,
        age,
        changes,
        is_file_changed: journal.stands_on != sheet.document.stamp(),
    })
}
