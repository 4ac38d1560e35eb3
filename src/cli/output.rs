//! The output of a study: a stream, or a file that appears only when it is complete.

use super::exit::Failure;
use crate::case::file::{Draft, SaveError};
use crate::system::files::is_same;
use crate::system::interrupt::Interrupt;
use std::io::{self, BufWriter, Write};
use std::path::Path;

/// The destination of the results of a study.
pub(super) enum Sink<'a> {
    Stream(&'a mut dyn Write),
    /// A signal stops the writing, so that the draft is deleted.
    File(Box<BufWriter<Draft>>, Interrupt),
}

impl<'a> Sink<'a> {
    /// Opens a file, or the stream if no file is named or the name is `-`.
    pub(super) fn open(
        out: Option<&Path>,
        stream: &'a mut dyn Write,
    ) -> Result<Sink<'a>, SaveError> {
        match named(out) {
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
            Sink::File(mut writer, _interrupt) => {
                let flushed = writer.flush();
                let (draft, _) = writer.into_parts();
                flushed.map_err(|error| draft.unwritable(error))?;
                Ok(draft.finish()?)
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

/// The file of `--out`. The name `-` is the stream.
fn named(out: Option<&Path>) -> Option<&Path> {
    out.filter(|path| *path != Path::new("-"))
}

/// Refuses a file that the command reads or that cannot be written, before long work starts.
pub(super) fn check_out(out: Option<&Path>, inputs: &[&Path]) -> Result<(), Failure> {
    let Some(out) = named(out) else { return Ok(()) };
    if inputs.iter().any(|input| is_same(input, out)) {
        return Err(Failure::Usage(format!(
            "--out {}: this file is read by the command: choose another name",
            out.display()
        )));
    }
    let interrupt = Interrupt::install();
    Draft::check(out)?;
    if interrupt.go_on() { Ok(()) } else { Err(Failure::Interrupted) }
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
