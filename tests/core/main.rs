//! The computation core and the case: reference values, properties, accuracy, run time and
//! architecture.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a failing test panics with a message and prints its figures"
)]

#[path = "../oracle/envelope.rs"]
mod envelope;
#[path = "../reference/gears.rs"]
mod gears;
#[path = "../oracle/mod.rs"]
mod oracle;
#[path = "../trade/pairs.rs"]
mod pairs;
#[path = "../support/mod.rs"]
mod support;
#[path = "../trade/table.rs"]
mod table;

mod accuracy;
mod allocation;
mod architecture;
mod auto;
mod budget;
mod clearing;
mod coupling;
mod deviations;
mod helical;
mod mesh;
mod motion;
mod one_value;
mod properties;
mod reference;
mod relevance;
mod relief;
mod rounded;
mod scaling;
mod second_motion;
mod stiffness;
mod studies;
mod trade;
mod validation;
mod whine;
