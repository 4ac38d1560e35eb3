//! The case files that a command reads, and the file that a command writes.

use clap::{Args, ValueHint};
use std::path::PathBuf;

use super::Changes;

/// Any number of cases, all with the same changes.
#[derive(Debug, Args)]
pub struct Cases {
    /// Case files; - is standard input
    #[arg(required = true, value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub cases: Vec<PathBuf>,
    /// The changes of each case
    #[command(flatten)]
    pub changes: Changes,
}

/// One case.
#[derive(Debug, Args)]
pub struct CaseFile {
    /// Case file; - is standard input
    #[arg(value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub case: PathBuf,
}

/// The file for the output.
#[derive(Debug, Args)]
pub struct Destination {
    /// File to write (default: standard output); replaces an existing file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub out: Option<PathBuf>,
}
