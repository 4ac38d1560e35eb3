//! Limits of the model: refusals with the value and the limit.

pub mod field;
mod refusal;
mod remedy;

pub use refusal::Refusal;
