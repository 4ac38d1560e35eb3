//! Undo and redo without a limit: one state of a case for each visit of a field.

use crate::case::{Case, FIELDS, Limit, Spread, Variant};

/// States of a case, each with the field that had the focus.
#[derive(Debug, Clone, Default)]
pub(crate) struct History {
    past: States,
    future: States,
    /// The edited row, until its visit ends.
    visited: Option<usize>,
}

/// The last state in full, and each earlier state as its difference from the next, so that a long
/// session stays small.
#[derive(Debug, Clone, Default)]
struct States {
    last: Option<(Case, usize)>,
    before: Vec<(Difference, usize)>,
}

/// The fields, limits and spreads in which a case differs from another.
#[derive(Debug, Clone)]
struct Difference {
    texts: Box<[(usize, Box<str>)]>,
    /// Limits, spreads and variants, which seldom change.
    others: Option<Box<Others>>,
}

type Others = (Vec<Limit>, Vec<Spread>, Vec<Variant>);

impl History {
    /// Stores the state before the first edit of a visit to a row. Returns whether it is the first
    /// edit.
    pub(super) fn before_edit(&mut self, case: &Case, focus: usize, row: usize) -> bool {
        let is_first = self.visited != Some(row);
        if is_first {
            self.past.push(case, focus);
            self.visited = Some(row);
        }
        self.future = States::default();
        is_first
    }

    /// The case before the first edit of this visit.
    pub(super) fn before_visit(&self) -> Option<&Case> {
        self.past.last.as_ref().filter(|_| self.visited.is_some()).map(|(case, _)| case)
    }

    /// Whether a row was edited in this visit.
    pub(super) fn is_visited(&self, row: usize) -> bool {
        self.visited == Some(row)
    }

    /// Ends the visit: the next edit stores a new state.
    pub(super) fn end_visit(&mut self) {
        self.visited = None;
    }

    /// Exchanges the present state for the previous one.
    pub(super) fn undo(&mut self, case: &Case, focus: usize) -> Option<(Case, usize)> {
        let state = self.past.pop()?;
        self.future.push(case, focus);
        Some(state)
    }

    /// Exchanges the present state for the undone one.
    pub(super) fn redo(&mut self, case: &Case, focus: usize) -> Option<(Case, usize)> {
        let state = self.future.pop()?;
        self.past.push(case, focus);
        Some(state)
    }
}

impl States {
    fn push(&mut self, case: &Case, focus: usize) {
        if let Some((last, at)) = self.last.replace((case.clone(), focus)) {
            self.before.push((Difference::of(&last, case), at));
        }
    }

    fn pop(&mut self) -> Option<(Case, usize)> {
        let state = self.last.take()?;
        self.last =
            self.before.pop().map(|(difference, at)| (difference.put_into(state.0.clone()), at));
        Some(state)
    }
}

impl Difference {
    /// The difference of `case` from `other`.
    fn of(case: &Case, other: &Case) -> Difference {
        let texts = (0..FIELDS.len()).filter(|&field| case.text(field) != other.text(field));
        let differ = others_of(case) != others_of(other);
        Difference {
            texts: texts
                .map(|field| (field, case.text(field).unwrap_or_default().into()))
                .collect(),
            others: differ.then(|| Box::new(others_of(case))),
        }
    }

    /// The case, from the other one and the difference.
    fn put_into(self, mut other: Case) -> Case {
        for (field, text) in self.texts {
            other.write(field, &text);
        }
        if let Some(others) = self.others {
            (other.limits, other.spread, other.variants) = *others;
        }
        other
    }
}

// The parts of a case other than its fields.
fn others_of(case: &Case) -> Others {
    (case.limits.clone(), case.spread.clone(), case.variants.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn states() -> Vec<Case> {
        let edited = |case: &Case, change: &dyn Fn(&mut Case)| {
            let mut case = case.clone();
            change(&mut case);
            case
        };
        let first = Case::table_1();
        let second = edited(&first, &|case| case.write(3, "6 mm"));
        let third = edited(&second, &|case| case.write_limit("friction_ratio", "0.5"));
        let fourth = edited(&third, &|case| {
            case.spread.push(Spread::new("pair.module", "normal", "4 um").unwrap());
        });
        let fifth = edited(&fourth, &|case| {
            (0..9).for_each(|field| case.write(field, ""));
        });
        vec![first, second, third, fourth, fifth]
    }

    #[test]
    fn undo_restores_every_state_in_order() {
        let states = states();
        let (mut history, last) = (History::default(), states.len() - 1);
        for (focus, state) in states[..last].iter().enumerate() {
            assert!(history.before_edit(state, focus, focus));
            assert_eq!(history.before_visit(), Some(state));
            history.end_visit();
        }
        for _ in 0..2 {
            for at in (0..last).rev() {
                assert_eq!(history.undo(&states[at + 1], at + 1), Some((states[at].clone(), at)));
            }
            assert_eq!(history.undo(&states[0], 0), None);
            for at in 1..=last {
                assert_eq!(history.redo(&states[at - 1], at - 1), Some((states[at].clone(), at)));
            }
            assert_eq!(history.redo(&states[last], last), None);
        }
    }

    #[test]
    fn a_state_stores_only_its_difference() {
        let mut history = History::default();
        let mut case = Case::table_1();
        for number in 0..1000 {
            history.before_edit(&case, 0, 0);
            history.end_visit();
            case.write(0, &format!("title {number}"));
        }
        assert!(history.past.before.iter().all(|(difference, _)| difference.texts.len() == 1));
    }
}
