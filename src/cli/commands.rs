//! The commands. Each file contains the options, the help and the execution of one command.
#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "the help names tables of the case file, such as [limits]"
)]

mod check;
mod compare;
mod completions;
mod explain;
mod fields;
mod gather;
mod import;
mod man;
mod new;
mod plot;
mod relief;
mod report;
mod schema;
mod seek;
mod solve;
mod stiffness;
mod sweep;
mod tolerance;
mod trade;

use super::Streams;
use super::exit::{Exit, Failure};
use clap::Subcommand;

/// A headless command.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Solve cases and print the results
    Solve(solve::Options),
    /// Check each case's [limits] against its results, one verdict per line
    Check(check::Options),
    /// Explain a quantity of a case: formula, numbers, source, validity and sensitivity
    Explain(explain::Options),
    /// Measure accuracy against run time of every method on a case, on this machine
    Trade(trade::Options),
    /// Compare the tooth compliance of every model over the flank with finite elements
    Stiffness(stiffness::Options),
    /// Solve a case over a range of one or more fields, as a table
    Sweep(sweep::Options),
    /// Sample the distributions of [spread]: percentiles, probabilities, ranking of the fields
    Tolerance(tolerance::Options),
    /// Merge the shards of a sweep or a tolerance study
    Gather(gather::Options),
    /// Compare the variants of a case, or several cases, side by side with their differences
    Compare(compare::Options),
    /// Find the values of a field at which a condition on the results changes
    Seek(seek::Options),
    /// Find the tip relief to specify on both gears: no corner contact, least transmission error
    Relief(relief::Options),
    /// Write a chart of a case, or its teeth, as a picture (SVG)
    Plot(plot::Options),
    /// Write cases side by side as one page or as data: .html, .md, .csv or .json
    Report(report::Options),
    /// List every field of a case with its unit, range, default and meaning
    Fields(fields::Options),
    /// Write the JSON Schema of a case file, with which editors complete keys
    Schema(schema::Options),
    /// Write a commented case to start from
    New(new::Options),
    /// Import a spur stage of a REXS model as a commented case
    Import(import::Options),
    /// Write a shell's completions to standard output
    Completions(completions::Options),
    /// Write the manual page (roff) to standard output
    Man(man::Options),
}

impl Command {
    /// Runs the command. Completions and manual use the definition of the whole program.
    pub(super) fn run(
        &self,
        program: fn() -> clap::Command,
        streams: &mut Streams,
    ) -> Result<Exit, Failure> {
        match self {
            Command::Solve(options) => solve::run(options, streams),
            Command::Check(options) => check::run(options, streams),
            Command::Explain(options) => explain::run(options, streams),
            Command::Trade(options) => trade::run(options, streams),
            Command::Stiffness(options) => stiffness::run(options, streams),
            Command::Sweep(options) => sweep::run(options, streams),
            Command::Tolerance(options) => tolerance::run(options, streams),
            Command::Gather(options) => gather::run(options, streams),
            Command::Compare(options) => compare::run(options, streams),
            Command::Seek(options) => seek::run(options, streams),
            Command::Relief(options) => relief::run(options, streams),
            Command::Plot(options) => plot::run(options, streams),
            Command::Report(options) => report::run(options, streams),
            Command::Fields(options) => fields::run(options, streams),
            Command::Schema(options) => schema::run(options, streams),
            Command::New(options) => new::run(options, streams),
            Command::Import(options) => import::run(options, streams),
            Command::Completions(options) => completions::run(options, program(), streams),
            Command::Man(options) => man::run(options, program(), streams),
        }
    }
}
