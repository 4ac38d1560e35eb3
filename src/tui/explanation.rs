//! Where a result comes from, as it is read: the page, the line on top, and the marked one of the
//! fields behind it.

use super::jobs::Explained;
use crate::model::Quantity;
use crate::report::Shown;
use crate::report::explain::Page;

/// An explanation that is being read.
#[derive(Debug, Clone)]
pub struct Explanation {
    /// The result.
    pub quantity: &'static Quantity,
    /// What the case is called.
    pub case: String,
    /// The value in the units of the results, where those are not the page's.
    pub value: Option<Shown>,
    /// The page, or why there is none; nothing while it is being written.
    pub page: Option<Result<Box<Page>, String>>,
    /// The first line in sight.
    pub top: usize,
    /// The marked one of the fields.
    pub marked: Option<usize>,
}

impl Explanation {
    /// An explanation that is being written.
    #[must_use]
    pub fn new(quantity: &'static Quantity, case: String, value: Option<Shown>) -> Explanation {
        Explanation {
            quantity,
            case,
            value,
            page: None,
            top: 0,
            marked: None,
        }
    }

    /// Take the page, if it is the one that is waited for.
    pub fn take(&mut self, explained: Explained) {
        if self.page.is_none() && explained.quantity.key == self.quantity.key {
            self.page = Some(explained.page);
        }
    }

    /// The fields that the result depends on, by their keys, in the order in which they stand on
    /// the page.
    #[must_use]
    pub fn fields(&self) -> Vec<&'static str> {
        let Some(Ok(page)) = &self.page else {
            return Vec::new();
        };
        let (acting, idle): (Vec<_>, Vec<_>) = page
            .effects
            .iter()
            .partition(|effect| !effect.change.is_empty());
        acting
            .into_iter()
            .chain(idle)
            .map(|effect| effect.key)
            .collect()
    }

    /// The marked field.
    #[must_use]
    pub fn field(&self) -> Option<&'static str> {
        self.fields().get(self.marked?).copied()
    }

    /// Mark the next field or the one before, round and round.
    pub fn mark(&mut self, by: isize) {
        let count = self.fields().len();
        let from = self
            .marked
            .map_or(if by > 0 { count.saturating_sub(1) } else { 0 }, |marked| {
                marked
            });
        self.marked = (count > 0).then(|| (from + count).saturating_add_signed(by) % count);
    }
}
