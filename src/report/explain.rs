//! The explanation of a result: formula, the formula with the numbers of the case, source,
//! corrections to the paper, validity, accuracy and sensitivity.
//!
//! The sentences and formulas of a quantity are in its row of
//! [`QUANTITIES`](crate::model::QUANTITIES).

mod context;
mod corrections;
mod derivation;
mod effects;
mod json;
mod page;
mod substitution;
mod text;
mod uncertainty;

pub use context::STEP_UNITS;
pub use corrections::{CORRECTIONS, Correction};
pub use derivation::{How, Leaf, Work};
pub use effects::Effect;
pub use json::write as write_json;
pub use page::{Page, explain};
pub use substitution::{Token, tokens};
pub use text::{Kind, Line, lines, render};
