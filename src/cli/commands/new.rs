//! `new`: writes a new case with every field and its help, or one of the examples.

use crate::case::file::{self, SaveError};
use crate::case::units::System;
use crate::case::{Case, Document, EXAMPLES, Example};
use crate::cli::Streams;
use crate::cli::exit::{Exit, Failure};
use crate::report::digest::Digest;
use clap::builder::{PossibleValuesParser, TypedValueParser};
use clap::{Args, ValueHint};
use std::io::{self, Write};
use std::path::{Path, PathBuf};

/// The options of the command.
#[derive(Debug, Args)]
pub struct Options {
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

pub(super) fn run(options: &Options, streams: &mut Streams) -> Result<Exit, Failure> {
    if options.list {
        list(streams.output.as_mut())?;
        return Ok(Exit::Done);
    }
    let text = options
        .from
        .map_or_else(|| Document::new(Case::fresh()).render(), |example| example.text.to_owned());
    write(options.file.as_deref(), &text, streams)
}

/// Writes a case to a file that must not exist yet, or to standard output.
pub(super) fn write(
    file: Option<&Path>,
    text: &str,
    streams: &mut Streams,
) -> Result<Exit, Failure> {
    match file.filter(|file| file.as_os_str() != "-") {
        None => streams.output.write_all(text.as_bytes())?,
        Some(path) => file::write(path, text.as_bytes(), false).map_err(|error| match error {
            SaveError::AlreadyThere(name) => {
                streams.say(&format!("{name}: the file exists: choose another name"));
                Failure::Reported(Exit::Unreadable)
            }
            other => Failure::File(other),
        })?,
    }
    Ok(Exit::Done)
}

/// The examples, each with its title, its pair and its verdict.
fn list(out: &mut dyn Write) -> io::Result<()> {
    let width = EXAMPLES.iter().map(|example| example.name.len()).max().unwrap_or(0);
    for example in EXAMPLES {
        let digest = digest(example);
        writeln!(out, "{:width$}  {}", example.name, digest.title)?;
        writeln!(out, "{:width$}  {}; {}", "", digest.pair, digest.load)?;
        writeln!(out, "{:width$}  {}", "", digest.verdict())?;
    }
    Ok(())
}

fn digest(example: &Example) -> Digest {
    let case = example.document().case;
    let inputs = case.inputs().ok();
    inputs
        .and_then(|inputs| Digest::solve(&case, &inputs, System::Metric, &|_| true))
        .unwrap_or_default()
}

fn examples() -> impl TypedValueParser<Value = &'static Example> {
    PossibleValuesParser::new(EXAMPLES.iter().map(|example| example.name))
        .try_map(|name| Example::find(&name))
}
