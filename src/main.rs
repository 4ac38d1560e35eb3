//! The program: a workbench in the terminal, and the same from scripts.

use std::process::ExitCode;
use std::sync::Arc;

use signal_hook::consts::SIGXFSZ;
use tipstrike::cli::{self, Arguments, Streams};

fn main() -> ExitCode {
    // With a handler, a limit on the size of files becomes an error of the write and does not end
    // the program.
    drop(signal_hook::flag::register(SIGXFSZ, Arc::default()));
    let mut streams = Streams::standard();
    match cli::parse(std::env::args_os(), &mut streams) {
        Err(exit) => exit.into(),
        Ok(Arguments {
            command: Some(command),
            ..
        }) => cli::run(&command, &mut streams).into(),
        Ok(Arguments { case, .. }) => tipstrike::tui::run(case),
    }
}
