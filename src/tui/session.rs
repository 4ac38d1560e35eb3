//! What keeps typed values safe: saving, locks, journals of unsaved edits, and their recovery.

pub mod autosave;
mod clock;
mod holder;
pub mod journal;
pub mod journal_writer;
mod journals;
pub mod lock;
mod locks;
pub mod recovery;
pub mod save;
