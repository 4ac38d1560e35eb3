//! A case held against its own limits.

use super::{shown, value};
use crate::case::visible::visible;
use crate::case::{Case, Limit};
use crate::model::{Outcome, Quantity, Solution};
use std::fmt;

/// How a quantity stands to its limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// At most the limit.
    Within,
    /// Above the limit.
    Exceeded,
    /// No tooth strikes, so that there is nothing to exceed it.
    NotApplicable,
    /// A tooth strikes, and the quantity still has no value.
    Unknown,
}

impl Standing {
    /// Whether the limit holds.
    #[must_use]
    pub fn holds(self) -> bool {
        matches!(self, Standing::Within | Standing::NotApplicable)
    }
}

/// A limit of a case and what was found of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict<'a> {
    /// The limit.
    pub limit: &'a Limit,
    /// The quantity's value in SI.
    pub value: Option<f64>,
    /// How the two stand.
    pub standing: Standing,
}

/// Every limit of the case held against the solution, in the case's order.
#[must_use]
pub fn verdicts<'a>(case: &'a Case, solution: &Solution) -> Vec<Verdict<'a>> {
    case.limits.iter().map(|limit| verdict(limit, solution)).collect()
}

fn verdict<'a>(limit: &'a Limit, solution: &Solution) -> Verdict<'a> {
    let value = Quantity::find(limit.quantity).and_then(|quantity| value(quantity, solution));
    let standing = match value {
        Some(value) if value <= limit.value => Standing::Within,
        Some(_) => Standing::Exceeded,
        None if solution.outcome == Outcome::NoCornerContact => Standing::NotApplicable,
        None => Standing::Unknown,
    };
    Verdict { limit, value, standing }
}

impl fmt::Display for Verdict<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (key, limit) = (self.limit.quantity, visible(&self.limit.text));
        let (Some(value), Some(quantity)) = (self.value, Quantity::find(key)) else {
            let why = if self.standing == Standing::Unknown { "has no value here" } else { "none, no corner contact" };
            return write!(f, "{key} {why} (limit {limit})");
        };
        let sign = if self.standing == Standing::Exceeded { ">" } else { "<=" };
        write!(f, "{key} {} {sign} {limit}", shown(quantity, value))?;
        if self.limit.value > 0.0 && value >= 0.0 {
            write!(f, " ({:.0} %)", 100.0 * value / self.limit.value)?;
        }
        Ok(())
    }
}
