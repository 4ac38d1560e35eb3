//! Writes a new case with every field and its help, or one of the examples.

use super::{Exit, New, Streams};
use crate::case::file::{self, SaveError};
use crate::case::units::System;
use crate::case::{Case, Document, EXAMPLES, Example};
use crate::report::digest::Digest;
use std::io::{self, Write};
use std::path::Path;

pub(super) fn run(options: &New, streams: &mut Streams) -> io::Result<Exit> {
    if options.list {
        return list(streams.output.as_mut()).map(|()| Exit::Done);
    }
    let text = options.from.map_or_else(
        || Document::new(Case::fresh()).render(),
        |example| example.text.to_owned(),
    );
    write(options.file.as_deref(), &text, streams)
}

/// Writes a case to a file that must not exist yet, or to standard output.
pub(super) fn write(file: Option<&Path>, text: &str, streams: &mut Streams) -> io::Result<Exit> {
    match file.filter(|file| file.as_os_str() != "-") {
        None => streams
            .output
            .write_all(text.as_bytes())
            .map(|()| Exit::Done),
        Some(path) => Ok(file::write(path, text.as_bytes(), false)
            .map_or_else(|error| refused(&error, streams), |()| Exit::Done)),
    }
}

/// The examples, each with its title, its pair and its verdict.
fn list(out: &mut dyn Write) -> io::Result<()> {
    let width = EXAMPLES
        .iter()
        .map(|example| example.name.len())
        .max()
        .unwrap_or(0);
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

fn refused(error: &SaveError, streams: &mut Streams) -> Exit {
    match error {
        SaveError::AlreadyThere(name) => {
            streams.say(&format!("{name}: the file exists: choose another name"));
        }
        other => streams.say(&other.to_string()),
    }
    Exit::Unreadable
}
