//! The command line's shape, from which help, completions and manual are derived.
#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "the help names tables of the case file, such as [limits]"
)]

mod changes;
mod compare;
mod misuse;
mod quantities;
mod studies;
mod texts;

use super::Exit;
use crate::case::{EXAMPLES, Example};
use crate::model::Quantity;
use crate::report::graphs::GRAPHS;
use crate::report::whine::charts::{SPECTRUM, SPEED};
use crate::study::stiffness::{LEAST_POINTS, MOST_POINTS};
use changes::{Changes, station_count};
pub use changes::{Edits, Setting};
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, Parser, Subcommand, ValueEnum, ValueHint};
use clap_complete::Shell;
pub use compare::{Compare, CompareFormat};
use quantities::{Quantities, QuantityList};
use std::path::PathBuf;
use std::sync::LazyLock;
pub use studies::{Gather, Relief, RowFormat, Running, Seek, Sweep, Tolerance};
use texts::{
    CHECK_SHAPE, CSV_SHAPE, IMPORT_SHAPE, PLOT_SHAPE, REPORT_SHAPE, STIFFNESS_SHAPE, TRADE_SHAPE,
};

/// The version, with the commit where the build names it, as `.ci/release` does.
static VERSION: LazyLock<String> = LazyLock::new(|| {
    let version = env!("CARGO_PKG_VERSION");
    let commit = option_env!("TIPSTRIKE_COMMIT");
    commit.map_or_else(
        || version.to_owned(),
        |commit| format!("{version} ({commit})"),
    )
});

/// Compute corner contact in spur gear pairs: position, force and duration of the tip impact
#[derive(Debug, Parser)]
#[command(name = "tipstrike", version = VERSION.as_str(), args_conflicts_with_subcommands = true, after_help = exit_codes())]
pub struct Arguments {
    /// Case to open in the workbench (default: the last case, or Table 1 of Zhou & Chen 2014)
    #[arg(value_hint = ValueHint::FilePath)]
    pub case: Option<PathBuf>,
    /// What to do without the workbench.
    #[command(subcommand)]
    pub command: Option<Command>,
}

/// A headless command.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Solve cases and print the results
    Solve(Solve),
    /// Check each case's [limits] against its results, one verdict per line
    Check(Check),
    /// Explain a quantity of a case: formula, numbers, source, validity and sensitivity
    Explain(Explain),
    /// Measure accuracy against run time of every method on a case, on this machine
    Trade(Trading),
    /// Compare the tooth compliance of every model over the flank with finite elements
    Stiffness(Stiffness),
    /// Solve a case over a range of one or more fields, as a table
    Sweep(Sweep),
    /// Sample the distributions of [spread]: percentiles, probabilities, ranking of the fields
    Tolerance(Tolerance),
    /// Put the shards of a sweep or a tolerance study together
    Gather(Gather),
    /// Compare the variants of a case, or several cases, side by side with their differences
    Compare(Compare),
    /// Find the values of a field at which a condition on the results changes
    Seek(Seek),
    /// Find the tip relief to specify on both gears: no corner contact, least transmission error
    Relief(Relief),
    /// Write a chart of a case, or its teeth, as a picture (SVG)
    Plot(Plot),
    /// Write cases side by side as one page or as data: .html, .md, .csv or .json
    Report(Export),
    /// List every field of a case with its unit, range, default and meaning
    Fields(Fields),
    /// Write the JSON Schema of a case file, with which editors complete keys
    Schema {
        /// Write the schema of `solve --format json` instead
        #[arg(long)]
        results: bool,
    },
    /// Write a commented case to start from
    New(New),
    /// Import a spur stage of a REXS model as a commented case
    Import(Import),
    /// Write a shell's completions to standard output
    Completions {
        /// The shell
        shell: Shell,
    },
    /// Write the manual page (roff) to standard output
    Man {
        /// The page of this command
        command: Option<String>,
    },
}

/// The arguments of `plot`.
#[derive(Debug, Args)]
#[command(after_help = PLOT_SHAPE)]
pub struct Plot {
    /// Case file; - is standard input
    #[arg(value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub case: PathBuf,
    /// What differs from the case
    #[command(flatten)]
    pub changes: Changes,
    /// The chart to draw
    #[arg(long, value_name = "NAME", default_value = "force", value_parser = charts())]
    pub chart: String,
    /// File to write (default: standard output); replaces an existing file
    #[arg(long, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub out: Option<PathBuf>,
}

/// The arguments of `report`.
#[derive(Debug, Args)]
#[command(after_help = REPORT_SHAPE)]
pub struct Export {
    /// Case files; - is standard input
    #[arg(required = true, value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub cases: Vec<PathBuf>,
    /// What differs from each case
    #[command(flatten)]
    pub changes: Changes,
    /// File to write, over an older one; its ending chooses the format
    #[arg(long, required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub out: PathBuf,
}

/// The arguments of `import`.
#[derive(Debug, Args)]
#[command(after_help = IMPORT_SHAPE)]
pub struct Import {
    /// REXS model (.rexs, .rexsj or .rexsz); - is standard input
    #[arg(value_name = "MODEL", value_hint = ValueHint::FilePath)]
    pub model: PathBuf,
    /// Import the stage with this id (default: the only spur stage of the model)
    #[arg(long, value_name = "ID")]
    pub stage: Option<String>,
    /// File to write (default: standard output); must not exist yet
    #[arg(long, value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub out: Option<PathBuf>,
}

/// What `solve` is asked.
#[derive(Debug, Args)]
#[command(after_help = CSV_SHAPE)]
pub struct Solve {
    /// Case files; - is standard input
    #[arg(required = true, value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub cases: Vec<PathBuf>,
    /// What differs from the case
    #[command(flatten)]
    pub changes: Changes,
    /// Print these quantities alone, by name or symbol, and run only the stages that they need;
    /// `tipstrike fields --results` lists them
    #[arg(long, value_name = "QUANTITY,...", hide_possible_values = true, value_parser = QuantityList)]
    pub only: Vec<Vec<&'static Quantity>>,
    /// Print the stations as well, in this many intervals between D and E, or auto
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = station_count)]
    pub stations: Option<String>,
    /// Format of the output
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// What `check` is asked.
#[derive(Debug, Args)]
#[command(after_help = CHECK_SHAPE)]
pub struct Check {
    /// Case files; - is standard input
    #[arg(required = true, value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub cases: Vec<PathBuf>,
    /// What differs from the case
    #[command(flatten)]
    pub changes: Changes,
    /// Format of the output
    #[arg(long, value_enum, default_value_t)]
    pub format: Listing,
}

/// What `explain` is asked.
#[derive(Debug, Args)]
pub struct Explain {
    /// Name or symbol of the quantity; `tipstrike fields --results` lists all quantities
    #[arg(value_name = "QUANTITY", hide_possible_values = true, value_parser = Quantities)]
    pub quantity: &'static Quantity,
    /// The case file, - for standard input (default: Table 1 of Zhou & Chen 2014)
    #[arg(value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub case: Option<PathBuf>,
    /// What differs from the case
    #[command(flatten)]
    pub changes: Changes,
    /// Format of the output
    #[arg(long, value_enum, default_value_t)]
    pub format: Listing,
}

/// What `trade` is asked.
#[derive(Debug, Args)]
#[command(after_help = TRADE_SHAPE)]
pub struct Trading {
    /// Case file; - is standard input
    #[arg(value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub case: PathBuf,
    /// What differs from the case
    #[command(flatten)]
    pub edits: Edits,
    /// Greatest error of the recommended setting, such as 5% or 0.05 (default: model.within of
    /// the case)
    #[arg(long, value_name = "ERROR", allow_negative_numbers = true, value_parser = part)]
    pub within: Option<f64>,
    /// Format of the output
    #[arg(long, value_enum, default_value_t)]
    pub format: Listing,
}

/// The arguments of `stiffness`.
#[derive(Debug, Args)]
#[command(after_help = STIFFNESS_SHAPE)]
pub struct Stiffness {
    /// Case file; - is standard input
    #[arg(value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub case: PathBuf,
    /// What differs from the case
    #[command(flatten)]
    pub edits: Edits,
    /// Number of radii on each flank, from the form circle to the tip
    #[arg(long, value_name = "N", allow_negative_numbers = true, default_value_t = 9, value_parser = point_count)]
    pub points: usize,
    /// Format of the output
    #[arg(long, value_enum, default_value_t)]
    pub format: Format,
}

/// What `fields` is asked.
#[derive(Debug, Args)]
pub struct Fields {
    /// List the quantities instead: the names for --only and [limits]
    #[arg(long)]
    pub results: bool,
    /// Format of the output
    #[arg(long, value_enum, default_value_t)]
    pub format: Listing,
}

/// What `new` is asked.
#[derive(Debug, Args)]
pub struct New {
    /// Start from this example instead of an empty case
    #[arg(long, value_name = "EXAMPLE", value_parser = examples())]
    pub from: Option<&'static Example>,
    /// List the examples instead, each with its pair and its verdict
    #[arg(long, conflicts_with_all = ["from", "file"])]
    pub list: bool,
    /// File to write (default: standard output); must not exist yet
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: Option<PathBuf>,
}

/// The form in which a solve is printed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum Format {
    /// Text in usual units
    #[default]
    Text,
    /// One JSON object per line
    Json,
    /// Comma-separated values
    Csv,
}

/// The form in which a list or a page is printed.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, ValueEnum)]
pub enum Listing {
    /// Text
    #[default]
    Text,
    /// One JSON object per line
    Json,
}

fn exit_codes() -> String {
    let codes = Exit::MEANINGS.map(|(exit, meaning)| format!("{} {meaning}", exit as u8));
    format!("Exit: {}.", codes.join("; "))
}

fn charts() -> PossibleValuesParser {
    let names = GRAPHS.iter().map(|graph| graph.key);
    PossibleValuesParser::new(names.chain([SPECTRUM, SPEED, super::plot::TEETH]))
}

fn examples() -> impl TypedValueParser<Value = &'static Example> {
    PossibleValuesParser::new(EXAMPLES.iter().map(|example| example.name))
        .try_map(|name| Example::find(&name))
}

/// A number of radii on a flank.
fn point_count(text: &str) -> Result<usize, String> {
    let range = LEAST_POINTS..=MOST_POINTS;
    let count = text.parse().ok().filter(|count| range.contains(count));
    count.ok_or_else(|| format!("write a number from {LEAST_POINTS} to {MOST_POINTS}"))
}

/// A part of a whole: "5%" or 0.05.
fn part(text: &str) -> Result<f64, String> {
    let (number, whole) = text
        .trim()
        .strip_suffix('%')
        .map_or((text.trim(), 1.0), |number| (number.trim(), 100.0));
    let value = number
        .parse::<f64>()
        .ok()
        .map(|number| number / whole)
        .filter(|part| part.is_finite() && *part > 0.0);
    value.ok_or_else(|| "write a part above 0, such as 5% or 0.05".to_owned())
}

#[cfg(test)]
mod tests {
    use super::*;
    use clap::CommandFactory;

    #[test]
    fn the_shape_is_sound() {
        Arguments::command().debug_assert();
    }

    #[test]
    fn a_part_is_written_with_or_without_its_sign() {
        assert_eq!(
            (part("5%"), part("0.05"), part(" 0.5 % ")),
            (Ok(0.05), Ok(0.05), Ok(0.005))
        );
        assert!(
            ["", "%", "five", "-1%", "0", "nan", "inf%"]
                .iter()
                .all(|text| part(text).is_err())
        );
    }
}
