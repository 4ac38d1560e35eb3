//! Options that several commands share: changes of the case, quantities, formats, files, threads.

mod changes;
mod quantities;

use crate::report::sweep::TableFormat;
use crate::study::shard::Shard;
pub(super) use changes::{Changes, Edits, Setting, Settings, by_method, methods, station_count};
use clap::error::{Error, ErrorKind};
use clap::{Args, ValueEnum, ValueHint};
pub(super) use quantities::{Quantities, QuantityList};
use std::path::PathBuf;

/// The format of a solve.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum OutputFormat {
    /// Text in usual units
    #[default]
    Text,
    /// One JSON object per line
    Json,
    /// Comma-separated values
    Csv,
}

/// The format of a list or a page.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum Listing {
    /// Text
    #[default]
    Text,
    /// One JSON object per line
    Json,
}

/// The format of a table with one row per point.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum RowFormat {
    /// A header and one row per point
    #[default]
    Csv,
    /// One object per line and point
    Json,
}

impl From<RowFormat> for TableFormat {
    fn from(format: RowFormat) -> TableFormat {
        match format {
            RowFormat::Csv => TableFormat::Csv,
            RowFormat::Json => TableFormat::Json,
        }
    }
}

/// Options of a study whose points can be divided among machines.
#[derive(Debug, Args)]
pub struct StudyOptions {
    /// Number of threads (default: one per core); does not change the output
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// Solve only part I of N equal parts, such as 3/8, for `tipstrike gather`
    #[arg(long, value_name = "I/N", value_parser = Shard::parse)]
    pub shard: Option<Shard>,
    /// File to write (default: standard output); replaces an existing file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub out: Option<PathBuf>,
}

/// Parses a number of points or samples.
pub(super) fn count(text: &str) -> Result<usize, String> {
    text.trim()
        .parse()
        .map_err(|_| "write a whole number, such as 101".to_owned())
}

/// A usage error with one line.
fn misused(cause: String) -> Error {
    Error::raw(ErrorKind::ValueValidation, cause + "\n")
}
