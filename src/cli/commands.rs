//! The commands. Each file has the options, the help and the execution of several commands.
#![allow(
    rustdoc::broken_intra_doc_links,
    reason = "the help names tables of the case file, such as [limits]"
)]

mod documents;
mod results;
mod searches;
mod studies;

use super::Streams;
use super::output::Done;
use clap::Subcommand;

/// A headless command.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Solve cases and print the results
    Solve(results::Solve),
    /// Check each case's [limits] against its results, one verdict per line
    Check(results::Check),
    /// Explain a quantity of a case: formula, numbers, source, validity and sensitivity
    Explain(results::Explain),
    /// Measure accuracy against run time of every method on a case, on this machine
    Trade(searches::Trade),
    /// Compare the tooth compliance of every model over the flank with finite elements
    Stiffness(searches::Stiffness),
    /// Solve a case over a range of one or more fields, as a table
    Sweep(studies::Sweep),
    /// Sample the distributions of [spread]: percentiles, probabilities, ranking of the fields
    Tolerance(studies::Tolerance),
    /// Merge the shards of a sweep or a tolerance study
    Gather(studies::Gather),
    /// Compare the variants of a case, or several cases, side by side with their differences
    Compare(results::Compare),
    /// Find the values of a field at which a condition on the results changes
    Seek(searches::Seek),
    /// Find the tip relief to specify on both gears: no corner contact, least transmission error
    Relief(searches::Relief),
    /// Write a chart of a case, or its teeth, as a picture (SVG)
    Plot(results::Plot),
    /// Write cases side by side as one page or as data: .html, .md, .csv or .json
    Report(results::Report),
    /// List every field of a case with its unit, range, default and meaning
    Fields(documents::Fields),
    /// Write the JSON Schema of a case file, with which editors complete keys
    Schema(documents::Schema),
    /// Write a commented case to start from
    New(documents::New),
    /// Import a spur stage of a REXS model as a commented case
    Import(documents::Import),
    /// Write a shell's completions to standard output
    Completions(documents::Completions),
    /// Write the manual page (roff) to standard output
    Man(documents::Man),
}

impl Command {
    /// Runs the command. Completions and manual use the definition of the whole program.
    pub(super) fn run(&self, program: fn() -> clap::Command, streams: &mut Streams) -> Done {
        match self {
            Command::Solve(command) => command.run(streams),
            Command::Check(command) => command.run(streams),
            Command::Explain(command) => command.run(streams),
            Command::Trade(command) => command.run(streams),
            Command::Stiffness(command) => command.run(streams),
            Command::Sweep(command) => command.run(streams),
            Command::Tolerance(command) => command.run(streams),
            Command::Gather(command) => command.run(streams),
            Command::Compare(command) => command.run(streams),
            Command::Seek(command) => command.run(streams),
            Command::Relief(command) => command.run(streams),
            Command::Plot(command) => command.run(streams),
            Command::Report(command) => command.run(streams),
            Command::Fields(command) => command.run(streams),
            Command::Schema(command) => command.run(streams),
            Command::New(command) => command.run(streams),
            Command::Import(command) => command.run(streams),
            Command::Completions(command) => command.run(program(), streams),
            Command::Man(command) => command.run(program(), streams),
        }
    }
}
