//! The options of the studies: many solves of one case.
#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "the help names tables of the case file, such as [limits]"
)]

use super::changes::Changes;
use super::quantities::QuantityList;
use super::{Format, Listing};
use crate::model::Quantity;
use crate::report::sweep::TableFormat;
use crate::study::relief::demand;
use crate::study::seek::USUAL_SCAN;
use crate::study::shard::Shard;
use crate::study::tolerance::USUAL_SAMPLES;
use clap::{Args, ValueEnum, ValueHint};
use std::path::PathBuf;

const SWEEP_SHAPE: &str = "CSV has one row per point: the varied fields in the units of --vary, then the quantities in SI units, then the \
    outcome. A cell is empty where a quantity has no value, such as an impact force without corner contact. A refused point has the outcome \
    `refused` and no values; standard error counts the refused points and gives the reason. JSON is one object per line and point. \
    Without --only the quantities are those of [limits], else the impact force of the method.";

const SEEK_SHAPE: &str = "A crossing is a value at which the condition changes, with a bracket of 1e-9 of the value. `always` and `never` \
    are answers for the whole range. Without corner contact a quantity of the impact is below every limit. JSON is one object; its \
    numbers are in the unit of --vary, and those of the quantity in SI.";

const TOLERANCE_SHAPE: &str = "A distribution is a line of [spread]: the field in quotes, then { \
    normal = WIDTH } with the standard deviation, or { uniform = WIDTH }, { triangular = WIDTH } \
    or { truncated = WIDTH } (a normal distribution cut off at three standard deviations) with \
    half the span, or { grade = CLASS } with a flank tolerance class of ISO 1328-1, for a base \
    pitch deviation. CSV has one row per solve in SI units: the samples (set a), then the points \
    of the ranking (set b, and b:FIELD with the value of b in that field). JSON is one object in \
    SI units.";

const RELIEF_SHAPE: &str = "Corner contact counts before the start and after the end of the path of contact, at the greatest load, with \
    each relief off by the tolerance to either side. Among the reliefs without corner contact the command chooses the one with the \
    smallest maximum transmission error (peak to peak, at rest, without base pitch deviations) over six loads of the range. Amounts are \
    multiples of 0.5 um, lengths are round numbers. With method dynamic the motion must have no corner contact either. CSV has one row per choice \
    and point of the map, JSON is one object; both are in SI units.";

/// How a study runs whose points can be divided among machines.
#[derive(Debug, Args)]
pub struct Running {
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

/// The options of `sweep`.
#[derive(Debug, Args)]
#[command(after_help = SWEEP_SHAPE)]
pub struct Sweep {
    /// Case file; - is standard input
    #[arg(value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub case: PathBuf,
    /// Vary a field over a range, such as 'operation.speed=500..3000 rpm', or over a list, such as
    /// 'driven.teeth=20,30,40'; of several fields the first varies slowest
    #[arg(long, required = true, value_name = "KEY=FROM..TO")]
    pub vary: Vec<String>,
    /// Number of points of each range, both ends included; default 101, or every whole number.
    /// Given once for all ranges, or once for each
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count)]
    pub points: Vec<usize>,
    /// Use equal ratios between the points of a range instead of equal steps
    #[arg(long)]
    pub log: bool,
    /// What differs from the case
    #[command(flatten)]
    pub changes: Changes,
    /// Compute these quantities alone, by name or symbol; `tipstrike fields --results` lists them
    #[arg(long, value_name = "QUANTITY,...", hide_possible_values = true, value_parser = QuantityList)]
    pub only: Vec<Vec<&'static Quantity>>,
    /// Format of the output
    #[arg(long, value_enum, default_value_t)]
    pub format: RowFormat,
    /// How the study runs
    #[command(flatten)]
    pub running: Running,
}

/// The options of `seek`.
#[derive(Debug, Args)]
#[command(after_help = SEEK_SHAPE)]
pub struct Seek {
    /// Case file; - is standard input
    #[arg(value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub case: PathBuf,
    /// The field and its range, such as 'deviations.base_pitch=0..40 um'
    #[arg(long, value_name = "KEY=FROM..TO")]
    pub vary: String,
    /// The condition, such as 'impact_force<=2500 N', 'dynamic_contact_lost=true' or
    /// 'outcome=no-corner-contact'
    #[arg(long, value_name = "CONDITION")]
    pub until: String,
    /// Number of points of the first scan; a finer scan finds narrower regions
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = USUAL_SCAN, value_parser = count)]
    pub points: usize,
    /// What differs from the case
    #[command(flatten)]
    pub changes: Changes,
    /// Format of the output
    #[arg(long, value_enum, default_value_t)]
    pub format: Listing,
    /// Number of threads (default: one per core); does not change the output
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u16).range(1..=1024))]
    pub jobs: Option<u16>,
    /// File to write (default: standard output); replaces an existing file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub out: Option<PathBuf>,
}

/// The options of `relief`.
#[derive(Debug, Args)]
#[command(after_help = RELIEF_SHAPE)]
pub struct Relief {
    /// Case file; - is standard input
    #[arg(value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub case: PathBuf,
    /// Loads that the relief must serve, in percent of the load of the case
    #[arg(long, value_name = "A..B", default_value = "25..110%", value_parser = demand::loads)]
    pub load: (f64, f64),
    /// Manufacturing tolerance of each relief, plus and minus, such as '5 um'
    #[arg(long, value_name = "LENGTH", default_value = "5 um", value_parser = demand::tolerance)]
    pub tolerance: f64,
    /// What differs from the case
    #[command(flatten)]
    pub changes: Changes,
    /// Format of the output
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
    /// File to write (default: standard output); replaces an existing file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub out: Option<PathBuf>,
}

/// The options of `tolerance`.
#[derive(Debug, Args)]
#[command(after_help = TOLERANCE_SHAPE)]
pub struct Tolerance {
    /// Case file with [spread]; - is standard input
    #[arg(value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub case: PathBuf,
    /// Number of samples
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = USUAL_SAMPLES, value_parser = count)]
    pub samples: usize,
    /// Seed of the samples; the same seed gives the same samples
    #[arg(long, value_name = "S", default_value_t = 1)]
    pub seed: u64,
    /// Number of samples for the ranking of the fields (default: 4096, at most --samples; 0: no
    /// ranking). Each sample needs one solve per field, plus one
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = count)]
    pub ranking: Option<usize>,
    /// What differs from the case
    #[command(flatten)]
    pub changes: Changes,
    /// Compute these quantities and those of [limits] alone, by name or symbol
    #[arg(long, value_name = "QUANTITY,...", hide_possible_values = true, value_parser = QuantityList)]
    pub only: Vec<Vec<&'static Quantity>>,
    /// Format of the output
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
    /// How the study runs
    #[command(flatten)]
    pub running: Running,
}

/// Format of a table with a row per point.
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

/// A number of points or samples.
fn count(text: &str) -> Result<usize, String> {
    text.trim()
        .parse()
        .map_err(|_| "write a whole number, such as 101".to_owned())
}

/// The options of `gather`.
#[derive(Debug, Args)]
pub struct Gather {
    /// Files that --shard wrote, in any order
    #[arg(required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub files: Vec<PathBuf>,
    /// File to write (default: standard output); replaces an existing file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub out: Option<PathBuf>,
}
