//! Help for the form: stepping of values, units and ranges, search of fields, materials.

mod hint;
pub(crate) mod materials;
mod search;
mod step;
mod typing;
mod words;

pub(crate) use search::{search, search_results};
pub(crate) use step::step_limit;
pub(crate) use typing::Measure;
