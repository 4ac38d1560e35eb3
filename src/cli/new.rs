//! A commented case to start from.

use super::{Exit, Streams};
use crate::case::{Case, Document};
use std::fs::OpenOptions;
use std::io::{self, Write};
use std::path::Path;

pub(super) fn run(file: Option<&Path>, streams: &mut Streams) -> io::Result<Exit> {
    let text = Document::new(Case::table_1()).render();
    match file.filter(|file| file.as_os_str() != "-") {
        None => streams.output.write_all(text.as_bytes()).map(|()| Exit::Done),
        Some(file) => Ok(write(file, &text).map_or_else(|error| refused(file, &error, streams), |()| Exit::Done)),
    }
}

fn write(file: &Path, text: &str) -> io::Result<()> {
    let mut opened = OpenOptions::new().write(true).create_new(true).open(file)?;
    opened.write_all(text.as_bytes())?;
    opened.sync_all()
}

fn refused(file: &Path, error: &io::Error, streams: &mut Streams) -> Exit {
    let why = match error.kind() {
        io::ErrorKind::AlreadyExists => "it exists already: give a name that is free".to_owned(),
        _ => error.to_string(),
    };
    streams.say(&format!("{}: cannot be written: {why}", file.display()));
    Exit::Unreadable
}
