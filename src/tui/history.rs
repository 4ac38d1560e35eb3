//! Undo and redo: states of a case to go back to, one for each visit of a field, without a limit.

use crate::case::Case;

/// States of a case, each with the field that had the focus.
#[derive(Debug, Clone, Default)]
pub struct History {
    past: Vec<(Case, usize)>,
    future: Vec<(Case, usize)>,
    is_visiting: bool,
}

impl History {
    /// Remember the state before the first edit of a visit; whether this is the first.
    pub(super) fn before_edit(&mut self, case: &Case, focus: usize) -> bool {
        let is_first = !self.is_visiting;
        if is_first {
            self.past.push((case.clone(), focus));
            self.is_visiting = true;
        }
        self.future.clear();
        is_first
    }

    /// The case before the first edit of this visit.
    pub(super) fn before_visit(&self) -> Option<&Case> {
        self.past.last().filter(|_| self.is_visiting).map(|(case, _)| case)
    }

    /// The next edit begins a state of its own.
    pub(super) fn end_visit(&mut self) {
        self.is_visiting = false;
    }

    /// The state before, in exchange for the present one.
    pub(super) fn undo(&mut self, case: &Case, focus: usize) -> Option<(Case, usize)> {
        let state = self.past.pop()?;
        self.future.push((case.clone(), focus));
        Some(state)
    }

    /// The state that was undone, in exchange for the present one.
    pub(super) fn redo(&mut self, case: &Case, focus: usize) -> Option<(Case, usize)> {
        let state = self.future.pop()?;
        self.past.push((case.clone(), focus));
        Some(state)
    }
}
