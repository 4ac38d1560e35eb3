//! Studies: many solves of one case.

pub mod axis;
pub mod batch;
pub mod excitation;
pub mod relief;
pub mod seek;
pub mod shard;
pub mod statistics;
pub mod stiffness;
pub mod tolerance;
pub mod trade;
