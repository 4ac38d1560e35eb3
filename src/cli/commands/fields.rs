//! `fields`: lists the fields of a case, or the quantities of the results.

use crate::cli::Streams;
use crate::cli::exit::{Exit, Failure};
use crate::cli::options::{FormatOption, Listing};
use crate::report::fields;
use clap::Args;

/// The options of the command.
#[derive(Debug, Args)]
pub struct Options {
    /// List the quantities instead: the names for --only and [limits]
    #[arg(long)]
    pub results: bool,
    /// The format
    #[command(flatten)]
    pub output: FormatOption<Listing>,
}

pub(super) fn run(options: &Options, streams: &mut Streams) -> Result<Exit, Failure> {
    let out = streams.output.as_mut();
    match (options.results, options.output.format) {
        (false, Listing::Text) => fields::write_fields(out),
        (false, Listing::Json) => fields::write_fields_json(out),
        (true, Listing::Text) => fields::write_quantities(out),
        (true, Listing::Json) => fields::write_quantities_json(out),
    }?;
    Ok(Exit::Done)
}
