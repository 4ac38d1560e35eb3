//! The output of a command: a stream, or a file that appears only when it is complete; progress,
//! Ctrl-C and exit codes.

use std::cell::Cell;
use std::fmt;
use std::io::{self, BufWriter, ErrorKind, IsTerminal, Write};
use std::path::Path;
use std::process::ExitCode;
use std::time::{Duration, Instant};

use super::Streams;
use crate::case::Problem;
use crate::case::file::{Draft, SaveError};
use crate::study::batch::Stopped;
use crate::system::files::is_same;
use crate::system::interrupt::Interrupt;
use indicatif::{HumanCount, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle};

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
    pub(super) fn finish(self) -> Done {
        if let Sink::File(mut writer, _interrupt) = self {
            let flushed = writer.flush();
            let (draft, _) = writer.into_parts();
            flushed.map_err(|error| draft.unwritable(error))?;
            draft.finish()?;
        }
        Ok(Exit::Done)
    }

    /// Converts an error of a write.
    pub(super) fn failure(&self, error: io::Error) -> Failure {
        match self {
            Sink::Stream(_) => error.into(),
            Sink::File(_, interrupt) if !interrupt.go_on() => Failure::Interrupted,
            Sink::File(writer, _) => writer.get_ref().unwritable(error).into(),
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
        return Err(Failure::usage(format!(
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
    streams: &mut Streams,
    write: impl FnOnce(&mut Sink) -> io::Result<()>,
) -> Done {
    let mut sink = Sink::open(out, streams.output.as_mut())?;
    write(&mut sink).map_err(|error| sink.failure(error))?;
    sink.finish()
}

/// Delay before the bar appears.
const QUIET: Duration = Duration::from_secs(1);

/// Runs work with a progress bar on a terminal if it takes long. The work reports the number of
/// completed parts and their total, and stops if the report returns false.
///
/// # Errors
/// [`Failure::Interrupted`] after Ctrl-C.
pub(super) fn follow<T>(
    what: &'static str,
    work: impl FnOnce(&dyn Fn(usize, usize) -> bool) -> T,
) -> Result<T, Failure> {
    const LINE_ABOVE: &[u8] = b"\x1b[A\x1b[2K";
    let (begun, interrupt) = (Instant::now(), Interrupt::install());
    let (bar, is_up) = (bar(what), Cell::new(false));
    let done = work(&|done, of| {
        if !is_up.get() && begun.elapsed() >= QUIET && io::stderr().is_terminal() {
            is_up.set(true);
            bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        bar.set_length(of as u64);
        bar.set_position(done as u64);
        interrupt.go_on()
    });
    bar.finish_and_clear();
    if interrupt.go_on() {
        return Ok(done);
    }
    // The terminal appends `^C` to the bar, which fills its line: the cursor is on the next line.
    if is_up.get() && interrupt.is_ctrl_c() {
        drop(io::stderr().write_all(LINE_ABOVE));
    }
    Err(Failure::Interrupted)
}

/// A hidden bar; `what` is the name of its parts.
fn bar(what: &'static str) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
    let rate = |state: &ProgressState, out: &mut dyn fmt::Write| {
        let rate = state.per_sec() as u64;
        if rate > 0 {
            // Errors of the bar are ignored.
            let _ = write!(out, ", {}/s", HumanCount(rate));
        }
    };
    let template = "{bar:30} {human_pos}/{human_len} {msg}{rate}, {eta} left";
    if let Ok(style) = ProgressStyle::with_template(template) {
        bar.set_style(style.with_key("rate", rate).progress_chars("=> "));
    }
    bar.set_message(what);
    bar
}

/// The exit code of a command; of several, the greatest counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Exit {
    /// Success.
    Done = 0,
    /// A case exceeds one of its limits, or the limited quantity has no value.
    Exceeded = 1,
    /// Wrong usage of the command line.
    Usage = 2,
    /// A case is invalid, or the model refuses it.
    BadCase = 3,
    /// A case has a newer format.
    NewerFormat = 4,
    /// A file cannot be read or written.
    Unreadable = 5,
}

impl Exit {
    /// Every exit code with its meaning.
    pub(super) const MEANINGS: [(Exit, &'static str); 6] = [
        (Exit::Done, "done"),
        (Exit::Exceeded, "a limit is exceeded, or its quantity has no value"),
        (Exit::Usage, "wrong usage, or no terminal for the workbench"),
        (Exit::BadCase, "an invalid case, or a case that cannot be solved"),
        (Exit::NewerFormat, "a case of a newer format"),
        (Exit::Unreadable, "a file cannot be read or written"),
    ];
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> ExitCode {
        ExitCode::from(exit as u8)
    }
}

/// The end of a command.
pub(super) type Done = Result<Exit, Failure>;

/// Why a command stopped early.
pub(super) enum Failure {
    /// The lines to report.
    Reported(Exit, Vec<String>),
    /// The standard output cannot be written.
    Stream(io::Error),
    /// Ctrl-C stopped the work.
    Interrupted,
}

impl Failure {
    /// A failure with one line.
    pub(super) fn new(exit: Exit, line: impl fmt::Display) -> Failure {
        Failure::Reported(exit, vec![line.to_string()])
    }

    /// Wrong usage, with the reason.
    pub(super) fn usage(line: String) -> Failure {
        Failure::new(Exit::Usage, line)
    }

    /// An invalid value of an option.
    pub(super) fn of_option(option: &str, value: &str, problem: &Problem) -> Failure {
        let Problem { cause, fix, .. } = problem;
        Failure::usage(format!("{option} {value}: {cause}: {fix}"))
    }
}

impl From<Stopped> for Failure {
    fn from(_: Stopped) -> Failure {
        Failure::Interrupted
    }
}

impl From<SaveError> for Failure {
    fn from(error: SaveError) -> Failure {
        Failure::new(Exit::Unreadable, error)
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Failure {
        match error.kind() {
            ErrorKind::Interrupted => Failure::Interrupted,
            _ => Failure::Stream(error),
        }
    }
}
