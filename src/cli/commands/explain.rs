//! `explain`: explains a quantity of a case.

use crate::case::Document;
use crate::cli::Streams;
use crate::cli::cases::{self, Opened};
use crate::cli::exit::{Exit, Failure};
use crate::cli::options::{Changes, FormatOption, Listing, Quantities};
use crate::model::Quantity;
use crate::model::{self, Stages};
use crate::report::explain::{explain, render, write_json};
use clap::{Args, ValueHint};
use std::path::PathBuf;

/// The name of the built-in case.
const BUILT_IN: &str = "Table 1 of Zhou & Chen 2014";

/// The options of the command.
#[derive(Debug, Args)]
pub struct Options {
    /// Name or symbol of the quantity; `tipstrike fields --results` lists all quantities
    #[arg(value_name = "QUANTITY", hide_possible_values = true, value_parser = Quantities)]
    pub quantity: &'static Quantity,
    /// The case file, - for standard input (default: Table 1 of Zhou & Chen 2014)
    #[arg(value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub case: Option<PathBuf>,
    /// The changes of the case
    #[command(flatten)]
    pub changes: Changes,
    /// The format
    #[command(flatten)]
    pub output: FormatOption<Listing>,
}

pub(super) fn run(options: &Options, streams: &mut Streams) -> Result<Exit, Failure> {
    let edits = options.changes.edits();
    let opened = match &options.case {
        Some(path) => cases::open(path, &edits, streams),
        None => cases::changed(BUILT_IN.to_owned(), Document::table_1(), &edits, streams),
    }?;
    let Opened { name, document, inputs, .. } = &opened;
    let inputs = &inputs.clone().needing([options.quantity.stage]);
    let solution = model::solve(inputs, Stages::of(options.quantity.stage))
        .map_err(|refusal| opened.refused(&refusal, streams))?;
    let page = explain(options.quantity, &document.case, inputs, &solution);
    match options.output.format {
        Listing::Text => streams.output.write_all(render(&page, name).as_bytes())?,
        Listing::Json => write_json(&page, name, &mut streams.output)?,
    }
    Ok(Exit::Done)
}
