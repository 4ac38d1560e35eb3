//! Studies: many solves of one case.

pub mod axis;
pub mod batch;
mod chunks;
pub mod condition;
pub mod design;
pub mod distribution;
pub mod headline;
pub mod refusals;
pub mod relief;
pub mod seek;
pub mod shard;
pub mod sobol;
pub mod statistics;
pub mod stiffness;
pub mod sweep;
pub mod tolerance;
pub mod trade;
