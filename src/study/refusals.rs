//! The refused points of a study, counted by their reason.

use super::batch::Rows;
use crate::case::Problem;

/// Refused points with the same field and the same fix, apart from the numbers in the fix.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refused {
    /// Number of points.
    pub count: usize,
    /// Index of the first point.
    pub first: usize,
    /// The reason at the first point.
    pub problem: Problem,
}

/// Every reason, in the order of the first points.
#[derive(Debug, Clone, Default, PartialEq, Eq)]
pub struct Refusals(pub Vec<Refused>);

impl Refusals {
    /// Counts the refused points of these rows.
    pub fn count(&mut self, rows: &Rows) {
        for (index, problem) in &rows.refusals {
            self.add(*index, problem);
        }
    }

    fn add(&mut self, index: usize, problem: &Problem) {
        let is_same = |other: &&mut Refused| {
            let other = &other.problem;
            other.field == problem.field && words(&other.fix).eq(words(&problem.fix))
        };
        match self.0.iter_mut().find(is_same) {
            Some(same) => same.count += 1,
            None => self.0.push(Refused { count: 1, first: index, problem: problem.clone() }),
        }
    }

    /// How many points are refused.
    #[must_use]
    pub fn total(&self) -> usize {
        self.0.iter().map(|refused| refused.count).sum()
    }
}

/// The characters of a text without its numbers.
fn words(text: &str) -> impl Iterator<Item = char> {
    text.chars().filter(|character| !character.is_ascii_digit() && !".+-".contains(*character))
}
