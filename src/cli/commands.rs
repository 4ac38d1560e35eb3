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
use super::output::{Exit, Failure};
use clap::Subcommand;

/// A headless command.
#[derive(Debug, Subcommand)]
pub enum Command {
    /// Solve cases and print the results
    Solve(results::SolveOptions),
    /// Check each case's [limits] against its results, one verdict per line
    Check(results::CheckOptions),
    /// Explain a quantity of a case: formula, numbers, source, validity and sensitivity
    Explain(results::ExplainOptions),
    /// Measure accuracy against run time of every method on a case, on this machine
    Trade(searches::TradeOptions),
    /// Compare the tooth compliance of every model over the flank with finite elements
    Stiffness(searches::StiffnessOptions),
    /// Solve a case over a range of one or more fields, as a table
    Sweep(studies::SweepOptions),
    /// Sample the distributions of [spread]: percentiles, probabilities, ranking of the fields
    Tolerance(studies::ToleranceOptions),
    /// Merge the shards of a sweep or a tolerance study
    Gather(studies::GatherOptions),
    /// Compare the variants of a case, or several cases, side by side with their differences
    Compare(results::CompareOptions),
    /// Find the values of a field at which a condition on the results changes
    Seek(searches::SeekOptions),
    /// Find the tip relief to specify on both gears: no corner contact, least transmission error
    Relief(searches::ReliefOptions),
    /// Write a chart of a case, or its teeth, as a picture (SVG)
    Plot(results::PlotOptions),
    /// Write cases side by side as one page or as data: .html, .md, .csv or .json
    Report(results::ReportOptions),
    /// List every field of a case with its unit, range, default and meaning
    Fields(documents::FieldsOptions),
    /// Write the JSON Schema of a case file, with which editors complete keys
    Schema(documents::SchemaOptions),
    /// Write a commented case to start from
    New(documents::NewOptions),
    /// Import a spur stage of a REXS model as a commented case
    Import(documents::ImportOptions),
    /// Write a shell's completions to standard output
    Completions(documents::CompletionsOptions),
    /// Write the manual page (roff) to standard output
    Man(documents::ManOptions),
}

impl Command {
    /// Runs the command. Completions and manual use the definition of the whole program.
    pub(super) fn run(
        &self,
        program: fn() -> clap::Command,
        streams: &mut Streams,
    ) -> Result<Exit, Failure> {
        match self {
            Command::Solve(options) => results::run_solve(options, streams),
            Command::Check(options) => results::run_check(options, streams),
            Command::Explain(options) => results::run_explain(options, streams),
            Command::Trade(options) => searches::run_trade(options, streams),
            Command::Stiffness(options) => searches::run_stiffness(options, streams),
            Command::Sweep(options) => studies::run_sweep(options, streams),
            Command::Tolerance(options) => studies::run_tolerance(options, streams),
            Command::Gather(options) => studies::run_gather(options, streams),
            Command::Compare(options) => results::run_compare(options, streams),
            Command::Seek(options) => searches::run_seek(options, streams),
            Command::Relief(options) => searches::run_relief(options, streams),
            Command::Plot(options) => results::run_plot(options, streams),
            Command::Report(options) => results::run_report(options, streams),
            Command::Fields(options) => documents::run_fields(options, streams),
            Command::Schema(options) => documents::run_schema(options, streams),
            Command::New(options) => documents::run_new(options, streams),
            Command::Import(options) => documents::run_import(options, streams),
            Command::Completions(options) => {
                documents::run_completions(options, program(), streams)
            }
            Command::Man(options) => documents::run_man(options, program(), streams),
        }
    }
}
