//! Lists the fields of a case or the quantities of the results.

use std::io;

/// What the command line gives.
#[derive(Debug, Args)]
pub struct Options {
    /// List the quantities instead: the names for --only and [limits]
    #[arg(long)]
    pub results: bool,
    /// Format of the output
    #[arg(long, value_enum, default_value_t)]
    pub format: Listing,
}

pub(super) fn run
