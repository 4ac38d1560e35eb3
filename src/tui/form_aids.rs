//! What only a form needs of a case: values that are stepped, units and ranges that are shown,
//! fields that are found, materials that are filled in.

mod hint;
pub(crate) mod materials;
mod search;
mod step;
mod typing;
mod words;

pub(crate) use search::{search, search_results};
pub(crate) use step::step_limit;
pub(crate) use typing::Measure;
