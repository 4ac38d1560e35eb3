//! A quantity of a case explained.

use super::cases::{self, Opened};
use super::{Exit, Explain, Listing, Streams};
use crate::case::Document;
use crate::model::{self, Stages};
use crate::report::explain::{explain, render, write_json};
use std::io::{self, Write};

/// What the built-in case is called.
const BUILT_IN: &str = "Table 1 of Zhou & Chen 2014";

pub(super) fn run(options: &Explain, streams: &mut Streams) -> io::Result<Exit> {
    let edits = options.changes.edits();
    let opened = match &options.case {
        Some(path) => cases::open(path, &edits, streams),
        None => cases::changed(BUILT_IN.to_owned(), Document::table_1(), &edits, streams),
    };
    match opened {
        Ok(opened) => tell(options, &opened, streams),
        Err(exit) => Ok(exit),
    }
}

fn tell(options: &Explain, opened: &Opened, streams: &mut Streams) -> io::Result<Exit> {
    let Opened {
        name,
        document,
        inputs,
        ..
    } = opened;
    let solution = match model::solve(inputs, Stages::of(options.quantity.stage)) {
        Ok(solution) => solution,
        Err(refusal) => return Ok(opened.refused(&refusal, streams)),
    };
    let page = explain(options.quantity, &document.case, inputs, &solution);
    match options.format {
        Listing::Text => streams.output.write_all(render(&page, name).as_bytes())?,
        Listing::Json => write_json(&page, name, &mut streams.output)?,
    }
    Ok(Exit::Done)
}
