//! Exit codes of the commands.

use crate::case::Problem;
use crate::case::file::SaveError;
use crate::study::batch::Stopped;
use std::io;
use std::process::ExitCode;

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

/// Why a command stopped early.
pub(super) enum Failure {
    /// Wrong usage, with the reason.
    Usage(String),
    /// The reason is already reported.
    Reported(Exit),
    /// A file cannot be written.
    File(SaveError),
    /// The standard output cannot be written.
    Stream(io::Error),
    /// Ctrl-C stopped the work.
    Interrupted,
}

impl Failure {
    /// Reports an invalid value of an option.
    pub(super) fn of_option(option: &str, value: &str, problem: &Problem) -> Failure {
        let Problem { cause, fix, .. } = problem;
        Failure::Usage(format!("{option} {value}: {cause}: {fix}"))
    }
}

impl From<Stopped> for Failure {
    fn from(_: Stopped) -> Failure {
        Failure::Interrupted
    }
}

impl From<Exit> for Failure {
    fn from(exit: Exit) -> Failure {
        Failure::Reported(exit)
    }
}

impl From<SaveError> for Failure {
    fn from(error: SaveError) -> Failure {
        Failure::File(error)
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Failure {
        Failure::Stream(error)
    }
}
