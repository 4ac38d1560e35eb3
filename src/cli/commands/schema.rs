//! `schema`: writes the JSON Schema of a case file, or of the results.

use crate::cli::Streams;
use crate::cli::exit::{Exit, Failure};
use crate::report::schema;
use clap::Args;

/// The options of the command.
#[derive(Debug, Args)]
pub struct Options {
    /// Write the schema of `solve --format json` instead
    #[arg(long)]
    pub results: bool,
}

pub(super) fn run(options: &Options, streams: &mut Streams) -> Result<Exit, Failure> {
    let out = streams.output.as_mut();
    if options.results {
        schema::write_results(out)?;
    } else {
        schema::write_case(out)?;
    }
    Ok(Exit::Done)
}
