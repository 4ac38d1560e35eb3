//! `completions`: writes shell completions.

use crate::cli::Streams;
use crate::cli::exit::{Exit, Failure};
use clap::Args;
use clap_complete::Shell;

/// The options of the command.
#[derive(Debug, Args)]
pub struct Options {
    /// The shell
    pub shell: Shell,
}

pub(super) fn run(
    options: &Options,
    mut program: clap::Command,
    streams: &mut Streams,
) -> Result<Exit, Failure> {
    // The generator panics if its writer fails, and therefore writes to memory.
    let mut script = Vec::new();
    clap_complete::generate(options.shell, &mut program, "tipstrike", &mut script);
    streams.output.write_all(&script)?;
    Ok(Exit::Done)
}
