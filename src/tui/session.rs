//! Protection of typed values: saving, locks, journals of unsaved edits, and their recovery.

pub(crate) mod autosave;
mod clock;
mod holder;
pub(crate) mod journal;
pub(crate) mod journal_writer;
mod journals;
pub(crate) mod lock;
mod locks;
pub(crate) mod recovery;
pub(crate) mod save;
