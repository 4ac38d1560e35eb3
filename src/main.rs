//! The program: the workbench in the terminal, and commands for scripts.

#![forbid(unsafe_code)]

use std::path::PathBuf;
use std::process::ExitCode;

use tipstrike::cli::{self, Arguments, Streams};

#[cfg(target_env = "musl")]
#[global_allocator]
static MEMORY: dlmalloc::GlobalDlmalloc = dlmalloc::GlobalDlmalloc;

fn main() -> ExitCode {
    tipstrike::system::report_file_limit_as_error();
    let mut streams = Streams::standard();
    match cli::parse(std::env::args_os(), &mut streams) {
        Err(exit) => exit.into(),
        Ok(Arguments { command: Some(command), .. }) => cli::run(&command, &mut streams).into(),
        Ok(Arguments { case, .. }) => workbench(case, &mut streams),
    }
}

#[cfg(unix)]
fn workbench(case: Option<PathBuf>, _: &mut Streams) -> ExitCode {
    tipstrike::tui::run(case).into()
}

#[cfg(not(unix))]
fn workbench(_: Option<PathBuf>, streams: &mut Streams) -> ExitCode {
    cli::refuse_workbench(streams).into()
}
