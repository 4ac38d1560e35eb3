//! The headless commands: results to the output, messages to the errors, and an exit code for
//! scripts.

mod cases;
mod commands;
mod options;
mod output;

use std::ffi::OsString;
use std::io::{self, BufWriter, Write};
use std::path::{Path, PathBuf};
use std::sync::LazyLock;

use crate::case::sanitize::sanitize;
use crate::case::suggest;
use crate::system::interrupt::Interrupt;
use clap::error::ErrorKind;
use clap::{CommandFactory, FromArgMatches, Parser, ValueHint};
pub use commands::Command;
pub use output::Exit;
use output::{Done, Failure};

/// The streams of a command.
pub struct Streams<'a> {
    /// Stream of the results.
    pub output: Box<dyn Write + 'a>,
    /// Stream of the messages.
    pub errors: Box<dyn Write + 'a>,
}

impl Streams<'static> {
    /// The streams of the process.
    #[must_use]
    pub fn standard() -> Streams<'static> {
        Streams { output: Box::new(BufWriter::new(io::stdout())), errors: Box::new(io::stderr()) }
    }
}

impl Streams<'_> {
    /// Writes one message line. Ignores a closed error stream.
    fn say(&mut self, message: &str) {
        let _ = writeln!(self.errors, "{}", sanitize(message));
    }

    fn say_all<T: AsRef<str>>(&mut self, messages: impl IntoIterator<Item = T>) {
        messages.into_iter().for_each(|message| self.say(message.as_ref()));
    }
}

/// Reports that the workbench needs another system.
pub fn refuse_workbench(streams: &mut Streams) -> Exit {
    streams.say(
        "tipstrike: the workbench needs Linux, macOS or another Unix; on this system: tipstrike \
         solve CASE",
    );
    Exit::Usage
}

/// Parses the command line.
///
/// # Errors
/// The exit code if there is nothing to run: after help, or for wrong usage.
pub fn parse(
    arguments: impl IntoIterator<Item = OsString>,
    streams: &mut Streams,
) -> Result<Arguments, Exit> {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let matches = Arguments::command().try_get_matches_from(&arguments);
    if let Some(line) = matches.as_ref().err().and_then(|error| no_command(error, &arguments)) {
        streams.say(&line);
        return Err(Exit::Usage);
    }
    matches.and_then(|matches| Arguments::from_arg_matches(&matches)).map_err(|error| {
        let text: String =
            error.render().to_string().lines().map(|line| sanitize(line) + "\n").collect();
        if error.use_stderr() {
            let _ = streams.errors.write_all(text.as_bytes());
            return Exit::Usage;
        }
        let printed = streams.output.write_all(text.as_bytes());
        finish(printed.map(|()| Exit::Done).map_err(Failure::Stream), streams)
    })
}

/// The message for a first word that looks like a mistyped command.
fn no_command(error: &clap::Error, arguments: &[OsString]) -> Option<String> {
    let first = arguments.get(1)?.to_str().filter(|first| !first.starts_with('-'))?;
    let command = Arguments::command();
    let is_command =
        command.get_subcommands().any(|known| known.get_name() == first) || first == "help";
    let is_case = Path::new(first).extension().is_some() || Path::new(first).exists();
    if error.kind() != ErrorKind::ArgumentConflict || is_command || is_case {
        return None;
    }
    let known =
        command.get_subcommands().map(|known| known.get_name().to_owned()).collect::<Vec<_>>();
    let fix = suggest::fix(first, known.iter().map(String::as_str), || {
        "`tipstrike help` lists the commands".to_owned()
    });
    Some(format!("error: {first}: there is no such command: {fix}"))
}

/// Runs a command.
pub fn run(command: &Command, streams: &mut Streams) -> Exit {
    let done = command.run(Arguments::command, streams);
    finish(done, streams)
}

/// The exit code; reports a failure. A reader that closes the output (`| head -1`) is not a failure.
fn finish(done: Done, streams: &mut Streams) -> Exit {
    let flushed = done.and_then(|exit| Ok(streams.output.flush().map(|()| exit)?));
    match flushed {
        Ok(exit) => exit,
        Err(Failure::Reported(exit, lines)) => {
            streams.say_all(lines);
            exit
        }
        Err(Failure::Stream(error)) if error.kind() == io::ErrorKind::BrokenPipe => Exit::Done,
        Err(Failure::Stream(error)) => {
            streams.say(&format!("standard output: cannot be written: {error}"));
            Exit::Unreadable
        }
        Err(Failure::Interrupted) => {
            Interrupt::end();
            Exit::Unreadable
        }
    }
}

/// The version; a release includes its commit (`build.rs`).
static VERSION: LazyLock<String> = LazyLock::new(|| {
    let version = env!("CARGO_PKG_VERSION");
    let commit = option_env!("TIPSTRIKE_COMMIT");
    commit.map_or_else(|| version.to_owned(), |commit| format!("{version} ({commit})"))
});

/// Compute corner contact in spur gear pairs: position, force and duration of the tip impact
#[derive(Debug, Parser)]
#[command(name = "tipstrike", version = VERSION.as_str(), args_conflicts_with_subcommands = true, after_help = exit_codes())]
pub struct Arguments {
    /// Case to open in the workbench (default: the last case, or Table 1 of Zhou & Chen 2014)
    #[arg(value_hint = ValueHint::FilePath)]
    pub case: Option<PathBuf>,
    /// The headless command; without one the workbench starts.
    #[command(subcommand)]
    pub command: Option<Command>,
}

fn exit_codes() -> String {
    let codes = Exit::MEANINGS.map(|(exit, meaning)| format!("{} {meaning}", exit as u8));
    format!("Exit: {}.", codes.join("; "))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_contain_no_control_characters() {
        let mut said = Vec::new();
        Streams { output: Box::new(io::sink()), errors: Box::new(&mut said) }
            .say("a\u{1b}[2J\u{9b}\nb\u{202e}");
        assert_eq!(String::from_utf8_lossy(&said), "a\\u{1b}[2J\\u{9b}\\nb\\u{202e}\n");
    }

    #[test]
    fn the_options_of_all_commands_fit_together() {
        Arguments::command().debug_assert();
    }
}
