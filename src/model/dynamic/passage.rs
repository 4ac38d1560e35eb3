//! The stored steps of a run, window by window.

use super::motion::{Motion, Window};
use super::step::{Course, Step};
use crate::model::pair_forces::Touching;

/// A step of the run.
pub(super) struct Record {
    pub(super) touching: Touching,
    pub(super) step: Step,
}

/// The steps of a window in which the incoming pair may touch.
pub(super) struct Passage {
    pub(super) window: Window,
    /// The incoming pair's index in the window.
    pub(super) incoming: usize,
    pub(super) records: Vec<Record>,
}

impl Passage {
    /// Stores a step. The list grows by a quarter, so that the old and the new list together use
    /// less than 2.25 times the budget. Returns the growth in bytes.
    pub(super) fn keep(&mut self, record: Record) -> usize {
        const LEAST: usize = 16;
        let room = self.records.capacity();
        if self.records.len() == room {
            self.records.reserve_exact((room / 4).max(LEAST));
        }
        self.records.push(record);
        (self.records.capacity() - room) * size_of::<Record>()
    }

    pub(super) fn records(&self) -> &[Record] {
        &self.records
    }

    pub(super) fn course<'a>(&'a self, motion: &'a Motion<'a>, record: &Record) -> Course<'a> {
        Course::new(motion, &self.window, record.touching)
    }
}
