//! The program: a workbench in the terminal, and the same from scripts.

use std::process::ExitCode;
use tipstrike::cli::{self, Arguments, Streams};

fn main() -> ExitCode {
    let mut streams = Streams::standard();
    match cli::parse(std::env::args_os(), &mut streams) {
        Err(exit) => exit.into(),
        Ok(Arguments { command: Some(command), .. }) => cli::run(&command, &mut streams).into(),
        Ok(Arguments { case, .. }) => tipstrike::tui::run(case),
    }
}
