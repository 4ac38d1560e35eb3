//! Many solves of one case, for what a single one cannot tell.

pub mod stiffness;
pub mod trade;
