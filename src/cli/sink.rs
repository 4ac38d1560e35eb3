//! The output of a study: a stream, or a file that appears only once it is complete.

use super::{Exit, Streams};
use crate::case::file::{Draft, SaveError, followed};
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// Where the results of a study go.
pub(super) enum Sink<'a> {
    Stream(&'a mut dyn Write),
    File(Box<BufWriter<Draft>>),
}

impl<'a> Sink<'a> {
    /// A file, or the stream where none is named or the name is `-`.
    pub(super) fn open(
        out: Option<&Path>,
        stream: &'a mut dyn Write,
    ) -> Result<Sink<'a>, SaveError> {
        match out.filter(|path| *path != Path::new("-")) {
            Some(path) => {
                Draft::create(path).map(|draft| Sink::File(Box::new(BufWriter::new(draft))))
            }
            None => Ok(Sink::Stream(stream)),
        }
    }

    /// Puts a file into its place.
    pub(super) fn finish(self) -> Result<(), Failure> {
        match self {
            Sink::Stream(_) => Ok(()),
            Sink::File(writer) => {
                let draft = writer
                    .into_inner()
                    .map_err(|error| Failure::Stream(error.into_error()))?;
                draft.finish().map_err(Failure::File)
            }
        }
    }

    /// The failure of a write.
    pub(super) fn failure(&self, error: io::Error) -> Failure {
        match self {
            Sink::Stream(_) => Failure::Stream(error),
            Sink::File(writer) => Failure::File(writer.get_ref().unwritable(error)),
        }
    }
}

impl Write for Sink<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Sink::Stream(stream) => stream.write(bytes),
            Sink::File(writer) => writer.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Sink::Stream(stream) => stream.flush(),
            Sink::File(writer) => writer.flush(),
        }
    }
}

/// Why an output was not written.
pub(super) enum Failure {
    Stream(io::Error),
    File(SaveError),
}

impl Failure {
    /// Reports a file that cannot be written; the error of a stream goes to the caller.
    pub(super) fn report(self, streams: &mut Streams) -> io::Result<Exit> {
        match self {
            Failure::Stream(error) => Err(error),
            Failure::File(error) => {
                streams.say(&error.to_string());
                Ok(Exit::Unreadable)
            }
        }
    }
}

/// Refuses to write over one of the files that are read.
pub(super) fn overwrites(out: Option<&Path>, inputs: &[&Path]) -> Option<String> {
    let out = out?;
    let target = followed(out).ok()?;
    let is_input = inputs
        .iter()
        .any(|input| followed(input).is_ok_and(|input| input == target));
    is_input.then(|| {
        format!(
            "--out {}: this file is read by the command: choose another name",
            out.display()
        )
    })
}
