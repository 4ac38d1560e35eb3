//! The headless commands: results to the output, everything else to the errors, and an exit code
//! that scripts hold on to.

mod arguments;
mod cases;
mod check;
mod compare;
mod explain;
mod gather;
mod import;
mod new;
mod plot;
mod progress;
mod relief;
mod report;
mod seek;
mod shards;
mod shell;
mod sink;
mod solve;
mod stiffness;
mod sweep;
mod tolerance;
mod trade;

use crate::case::sanitize::sanitize;
use crate::case::suggest;
use crate::report::{fields, schema};

pub use arguments::{
    Arguments, Check, Command, Compare, CompareFormat, Edits, Explain, Export, Fields, Format,
    Gather, Import, Listing, New, Plot, Relief, RowFormat, Running, Seek, Setting, Solve,
    Stiffness, Sweep, Tolerance, Trading,
};
use clap::error::ErrorKind;
use clap::{CommandFactory, FromArgMatches};
use std::ffi::OsString;
use std::io::{self, BufWriter, Write};
use std::path::Path;
use std::process::ExitCode;

/// How a command ended; of several, the greatest counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Exit {
    /// All is done.
    Done = 0,
    /// A case exceeds one of its limits, or has no value to hold against it.
    Exceeded = 1,
    /// The command line is wrong.
    Usage = 2,
    /// A case is wrong, or the model refuses it.
    BadCase = 3,
    /// A case is of a newer format.
    NewerFormat = 4,
    /// A file cannot be read or written.
    Unreadable = 5,
}

impl Exit {
    /// Every way to end, and its meaning.
    const MEANINGS: [(Exit, &'static str); 6] = [
        (Exit::Done, "done"),
        (
            Exit::Exceeded,
            "a limit is exceeded, or its quantity has no value",
        ),
        (Exit::Usage, "wrong usage, or no terminal for the workbench"),
        (
            Exit::BadCase,
            "an invalid case, or a case that cannot be solved",
        ),
        (Exit::NewerFormat, "a case of a newer format"),
        (Exit::Unreadable, "a file cannot be read or written"),
    ];
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> ExitCode {
        ExitCode::from(exit as u8)
    }
}

/// Where a command writes.
pub struct Streams<'a> {
    /// Where results go.
    pub output: Box<dyn Write + 'a>,
    /// Where everything else goes.
    pub errors: Box<dyn Write + 'a>,
}

impl Streams<'static> {
    /// The streams of the process.
    #[must_use]
    pub fn standard() -> Streams<'static> {
        Streams {
            output: Box::new(BufWriter::new(io::stdout())),
            errors: Box::new(io::stderr()),
        }
    }
}

impl Streams<'_> {
    /// One line for a person. That nobody reads it is no reason to fail.
    fn say(&mut self, message: &str) {
        let _ = writeln!(self.errors, "{}", sanitize(message));
    }
}

/// The command line taken apart.
///
/// # Errors
/// The exit code where there is nothing to run: after help, or for wrong usage.
pub fn parse(
    arguments: impl IntoIterator<Item = OsString>,
    streams: &mut Streams,
) -> Result<Arguments, Exit> {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let matches = Arguments::command().try_get_matches_from(&arguments);
    if let Some(line) = matches
        .as_ref()
        .err()
        .and_then(|error| no_command(error, &arguments))
    {
        streams.say(&line);
        return Err(Exit::Usage);
    }
    matches
        .and_then(|matches| Arguments::from_arg_matches(&matches))
        .map_err(|error| {
            let text: String = error
                .render()
                .to_string()
                .lines()
                .map(|line| sanitize(line) + "\n")
                .collect();
            if error.use_stderr() {
                let _ = streams.errors.write_all(text.as_bytes());
                return Exit::Usage;
            }
            let printed = streams
                .output
                .write_all(text.as_bytes())
                .map(|()| Exit::Done);
            finish(printed, streams)
        })
}

/// Whether the first word was meant to be a command, and which.
fn no_command(error: &clap::Error, arguments: &[OsString]) -> Option<String> {
    let first = arguments
        .get(1)?
        .to_str()
        .filter(|first| !first.starts_with('-'))?;
    let command = Arguments::command();
    let is_command = command
        .get_subcommands()
        .any(|known| known.get_name() == first)
        || first == "help";
    let is_case = Path::new(first).extension().is_some() || Path::new(first).exists();
    if error.kind() != ErrorKind::ArgumentConflict || is_command || is_case {
        return None;
    }
    let known = command
        .get_subcommands()
        .map(|known| known.get_name().to_owned())
        .collect::<Vec<_>>();
    let fix = suggest::fix(first, known.iter().map(String::as_str), || {
        "`tipstrike help` lists the commands".to_owned()
    });
    Some(format!("error: {first}: there is no such command: {fix}"))
}

/// Run a command to its end.
pub fn run(command: &Command, streams: &mut Streams) -> Exit {
    let done = match command {
        Command::Solve(options) => solve::run(options, streams),
        Command::Check(options) => check::run(options, streams),
        Command::Explain(options) => explain::run(options, streams),
        Command::Trade(options) => trade::run(options, streams),
        Command::Stiffness(options) => stiffness::run(options, streams),
        Command::Sweep(options) => sweep::run(options, streams),
        Command::Seek(options) => seek::run(options, streams),
        Command::Compare(options) => compare::run(options, streams),
        Command::Tolerance(options) => tolerance::run(options, streams),
        Command::Gather(options) => gather::run(options, streams),
        Command::Fields(options) => list_fields(options, streams.output.as_mut()),
        Command::Schema { results: false } => {
            schema::write_case(streams.output.as_mut()).map(|()| Exit::Done)
        }
        Command::Schema { results: true } => {
            schema::write_results(streams.output.as_mut()).map(|()| Exit::Done)
        }
        Command::New(options) => new::run(options, streams),
        Command::Relief(options) => relief::run(options, streams),
        Command::Plot(options) => plot::run(options, streams),
        Command::Report(options) => report::run(options, streams),
        Command::Import(options) => import::run(options, streams),
        Command::Completions { shell } => shell::completions(*shell, streams.output.as_mut()),
        Command::Man { command } => shell::man(command.as_deref(), streams),
    };
    finish(done, streams)
}

fn list_fields(options: &Fields, out: &mut dyn Write) -> io::Result<Exit> {
    match (options.results, options.format) {
        (false, Listing::Text) => fields::write_fields(out),
        (false, Listing::Json) => fields::write_fields_json(out),
        (true, Listing::Text) => fields::write_quantities(out),
        (true, Listing::Json) => fields::write_quantities_json(out),
    }
    .map(|()| Exit::Done)
}

/// A reader that went away (`| head -1`) ends a command quietly; an output that cannot be written
/// does not.
fn finish(done: io::Result<Exit>, streams: &mut Streams) -> Exit {
    let written = done.and_then(|exit| streams.output.flush().map(|()| exit));
    written.unwrap_or_else(|error| {
        if error.kind() == io::ErrorKind::BrokenPipe {
            return Exit::Done;
        }
        streams.say(&format!("standard output: cannot be written: {error}"));
        Exit::Unreadable
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn whatever_is_said_controls_no_terminal() {
        let mut said = Vec::new();
        Streams {
            output: Box::new(io::sink()),
            errors: Box::new(&mut said),
        }
        .say("a\u{1b}[2J\u{9b}\nb\u{202e}");
        assert_eq!(
            String::from_utf8_lossy(&said),
            "a\\u{1b}[2J\\u{9b}\\nb\\u{202e}\n"
        );
    }
}
