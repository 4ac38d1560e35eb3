//! Where a quantity holds, and how a case stands there.

pub(super) mod friction;
pub(super) mod impact;
pub(super) mod load;
pub(super) mod pair;
pub(super) mod position;
pub(super) mod stiffness;

use super::context::Known;
use super::numbers::tidy;

/// A range of validity and the case's place in it.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Finding {
    /// The range.
    pub range: String,
    /// How the case stands to it.
    pub here: String,
    /// Whether it is inside.
    pub holds: bool,
}

/// A range to look at; `None` where the case gives no value to look at.
pub(super) type Look = fn(&Known) -> Option<Finding>;

#[expect(
    clippy::unnecessary_wraps,
    reason = "every look has one shape, whether or not it may find nothing to look at"
)]
fn finding(range: impl Into<String>, here: impl Into<String>, holds: bool) -> Option<Finding> {
    Some(Finding {
        range: range.into(),
        here: here.into(),
        holds,
    })
}

/// A length in mm.
fn mm(length: f64) -> String {
    format!("{} mm", tidy(length * 1e3, 5))
}

/// A time or a length in millionths.
fn micro(value: f64, unit: &str) -> String {
    format!("{} {unit}", tidy(value * 1e6, 4))
}

fn four(value: f64) -> String {
    tidy(value, 4)
}
