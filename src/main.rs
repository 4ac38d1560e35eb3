//! The program: a workbench in the terminal, and the same from scripts.

fn main() -> std::process::ExitCode {
    tipstrike::tui::run(std::env::args_os().nth(1).map(Into::into))
}
