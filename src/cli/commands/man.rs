//! `man`: writes the manual page.

use crate::cli::Streams;
use crate::cli::exit::{Exit, Failure};
use clap::Args;
use clap::builder::Resettable;
use clap_mangen::Man;
use std::io::{self, Write};

/// The options of the command.
#[derive(Debug, Args)]
pub struct Options {
    /// The page of this command
    pub command: Option<String>,
}

pub(super) fn run(
    options: &Options,
    program: clap::Command,
    streams: &mut Streams,
) -> Result<Exit, Failure> {
    let page = page(options.command.as_deref(), program).ok_or_else(|| {
        Failure::Usage(format!(
            "man: there is no command {}: `tipstrike help` lists them",
            options.command.as_deref().unwrap_or_default()
        ))
    })?;
    let source = format!("tipstrike {}", env!("CARGO_PKG_VERSION"));
    Man::new(page).source(source).render(&mut streams.output)?;
    exit_status(streams.output.as_mut())?;
    Ok(Exit::Done)
}

fn exit_status(out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, ".SH \"EXIT STATUS\"")?;
    Exit::MEANINGS
        .iter()
        .try_for_each(|&(exit, meaning)| writeln!(out, ".TP\n\\fB{}\\fR\n{meaning}", exit as u8))
}

fn page(name: Option<&str>, program: clap::Command) -> Option<clap::Command> {
    let mut program = program.disable_help_subcommand(true);
    program.build();
    match name {
        // The help ends with the exit codes, which have a separate section in the manual page.
        None => Some(program.after_help(Resettable::Reset)),
        Some(name) => program.find_subcommand(name).cloned(),
    }
}
