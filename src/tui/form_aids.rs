//! What only a form needs of a case: values that are stepped, units and ranges that are shown,
//! fields that are found, materials that are filled in.

mod hint;
pub mod materials;
mod search;
mod step;
mod typing;
mod words;

pub use search::{search, search_results};
pub use step::{step, step_limit};
pub use typing::Measure;
