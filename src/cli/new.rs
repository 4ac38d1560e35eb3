//! A commented case to start from.

use super::{Exit, Streams};
use crate::case::file::{self, SaveError};
use crate::case::{Case, Document};
use std::io;
use std::path::Path;

pub(super) fn run(file: Option<&Path>, streams: &mut Streams) -> io::Result<Exit> {
    let text = Document::new(Case::table_1()).render();
    match file.filter(|file| file.as_os_str() != "-") {
        None => streams.output.write_all(text.as_bytes()).map(|()| Exit::Done),
        Some(path) => {
            Ok(file::write(path, text.as_bytes(), false).map_or_else(|error| refused(&error, streams), |()| Exit::Done))
        }
    }
}

fn refused(error: &SaveError, streams: &mut Streams) -> Exit {
    match error {
        SaveError::AlreadyThere(name) => streams.say(&format!("{name}: it exists already: give a name that is free")),
        other => streams.say(&other.to_string()),
    }
    Exit::Unreadable
}
