//! What a shell and a manual reader are given.

use super::{Arguments, Exit, Streams};
use clap::builder::Resettable;
use clap::{Command, CommandFactory};
use clap_complete::Shell;
use clap_mangen::Man;
use std::io::{self, Write};

pub(super) fn completions(shell: Shell, out: &mut dyn Write) -> io::Result<Exit> {
    // The generator panics where its writer fails, so it writes to memory.
    let mut script = Vec::new();
    clap_complete::generate(shell, &mut Arguments::command(), "tipstrike", &mut script);
    out.write_all(&script).map(|()| Exit::Done)
}

pub(super) fn man(name: Option<&str>, streams: &mut Streams) -> io::Result<Exit> {
    let Some(page) = page(name) else {
        streams.say(&format!(
            "man: there is no command {}: `tipstrike help` lists them",
            name.unwrap_or_default()
        ));
        return Ok(Exit::Usage);
    };
    let source = format!("tipstrike {}", env!("CARGO_PKG_VERSION"));
    Man::new(page).source(source).render(&mut streams.output)?;
    exit_status(streams.output.as_mut()).map(|()| Exit::Done)
}

fn exit_status(out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, ".SH \"EXIT STATUS\"")?;
    Exit::MEANINGS
        .iter()
        .try_for_each(|&(exit, meaning)| writeln!(out, ".TP\n\\fB{}\\fR\n{meaning}", exit as u8))
}

fn page(name: Option<&str>) -> Option<Command> {
    let mut program = Arguments::command().disable_help_subcommand(true);
    program.build();
    match name {
        // The exit codes of the help have a section of their own here.
        None => Some(program.after_help(Resettable::Reset)),
        Some(name) => program.find_subcommand(name).cloned(),
    }
}
