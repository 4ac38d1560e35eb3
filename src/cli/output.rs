//! The output of a study: a stream, or a file that appears only when it is complete.

use super::exit::Failure;
use crate::case::file::{Draft, SaveError, followed};
use crate::system::interrupt::Interrupt;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// The destination of the results of a study.
pub(super) enum Sink<'a> {
    Stream(&'a mut dyn Write),
    /// Ctrl-C and SIGTERM stop the writing, so that the draft is deleted.
    File(Box<BufWriter<Draft>>, Interrupt),
}

impl<'a> Sink<'a> {
    /// Opens a file, or the stream if no file is named or the name is `-`.
    pub(super) fn open(
        out: Option<&Path>,
        stream: &'a mut dyn Write,
    ) -> Result<Sink<'a>, SaveError> {
        match out.filter(|path| *path != Path::new("-")) {
            Some(path) => {
                let interrupt = Interrupt::install();
                let draft = Draft::create(path)?;
                Ok(Sink::File(Box::new(BufWriter::new(draft)), interrupt))
            }
            None => Ok(Sink::Stream(stream)),
        }
    }

    /// Replaces the target by the complete file.
    pub(super) fn finish(self) -> Result<(), Failure> {
        match self {
            Sink::Stream(_) => Ok(()),
            Sink::File(writer, _interrupt) => {
                let draft = writer
                    .into_inner()
                    .map_err(|error| Failure::Stream(error.into_error()))?;
                draft.finish().map_err(Failure::File)
            }
        }
    }

    /// Converts an error of a write.
    pub(super) fn failure(&self, error: io::Error) -> Failure {
        match self {
            Sink::Stream(_) => Failure::Stream(error),
            Sink::File(_, interrupt) if !interrupt.go_on() => Failure::Interrupted,
            Sink::File(writer, _) => Failure::File(writer.get_ref().unwritable(error)),
        }
    }
}

impl Write for Sink<'_> {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        match self {
            Sink::Stream(stream) => stream.write(bytes),
            Sink::File(_, interrupt) if !interrupt.go_on() => {
                Err(io::Error::other("a signal ends the program"))
            }
            Sink::File(writer, _) => writer.write(bytes),
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        match self {
            Sink::Stream(stream) => stream.flush(),
            Sink::File(writer, _) => writer.flush(),
        }
    }
}

/// Refuses a file that cannot be written before long work starts.
pub(super) fn check_out(out: Option<&Path>) -> Result<(), SaveError> {
    Sink::open(out, &mut io::sink()).map(drop)
}

/// Refuses to overwrite a file that the command reads.
pub(super) fn keep_inputs(out: Option<&Path>, inputs: &[&Path]) -> Result<(), Failure> {
    let target = out.and_then(|out| followed(out).ok());
    let is_input = |input: &&Path| followed(input).is_ok_and(|input| Some(input) == target);
    match out.filter(|_| inputs.iter().any(is_input)) {
        Some(out) => Err(Failure::Usage(format!(
            "--out {}: this file is read by the command: choose another name",
            out.display()
        ))),
        None => Ok(()),
    }
}

/// Writes results with `write` to a file, which appears when it is complete, or to the stream.
pub(super) fn write_to(
    out: Option<&Path>,
    stream: &mut dyn Write,
    write: impl FnOnce(&mut Sink) -> io::Result<()>,
) -> Result<(), Failure> {
    let mut sink = Sink::open(out, stream)?;
    write(&mut sink).map_err(|error| sink.failure(error))?;
    sink.finish()
}
