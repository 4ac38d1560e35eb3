//! Options that several commands share: changes of the case, quantities, formats, files, threads.

mod changes;
mod files;
mod quantities;

use crate::report::sweep::TableFormat;
use crate::study::shard::Shard;
pub(super) use changes::{Changes, Edits, Setting, Settings, by_method, methods, station_count};
use clap::error::{Error, ErrorKind};
use clap::{Args, ValueEnum};
pub(super) use files::{CaseFile, Cases, Destination};
pub(super) use quantities::{Quantities, QuantityList};

/// The format of a solve.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum OutputFormat {
    /// Text in usual units
    Text,
    /// One JSON object per line
    Json,
    /// Comma-separated values
    Csv,
}

/// The format of a list or a page.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Listing {
    /// Text
    Text,
    /// One JSON object per line
    Json,
}

/// The format of a table with one row per point.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum RowFormat {
    /// A header and one row per point
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

/// The formats of one command, for `--format`.
pub trait FormatChoice: ValueEnum + Send + Sync + 'static {
    /// The default format.
    const DEFAULT: &str;
}

impl FormatChoice for OutputFormat {
    const DEFAULT: &str = "text";
}

impl FormatChoice for Listing {
    const DEFAULT: &str = "text";
}

impl FormatChoice for RowFormat {
    const DEFAULT: &str = "csv";
}

/// The format of the output.
// clap stores a `default_value_t` in a static, which all instances of a generic struct share.
#[derive(Debug, Args)]
pub struct FormatOption<Choice: FormatChoice> {
    /// Format of the output
    #[arg(long, value_enum, default_value = Choice::DEFAULT)]
    pub format: Choice,
}

/// The number of threads.
#[derive(Debug, Args)]
pub struct Threads {
    /// Number of threads (default: one per core); does not change the output
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
}

/// Options of a study whose points can be divided among machines.
#[derive(Debug, Args)]
pub struct StudyOptions {
    /// The threads
    #[command(flatten)]
    pub threads: Threads,
    /// Solve only part I of N equal parts, such as 3/8, for `tipstrike gather`
    #[arg(long, value_name = "I/N", value_parser = Shard::parse)]
    pub shard: Option<Shard>,
    /// The file
    #[command(flatten)]
    pub destination: Destination,
}

/// Parses a number of points or samples.
pub(super) fn count(text: &str) -> Result<usize, String> {
    text.trim().parse().map_err(|_| "write a whole number, such as 101".to_owned())
}

/// A usage error with one line.
fn misused(cause: String) -> Error {
    Error::raw(ErrorKind::ValueValidation, cause + "\n")
}
