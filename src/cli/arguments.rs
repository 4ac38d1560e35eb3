//! The arguments of the program: a case for the workbench, or a command.

use super::commands::Command;
use super::exit::Exit;
use clap::{Parser, ValueHint};
use std::path::PathBuf;
use std::sync::LazyLock;

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
    use clap::CommandFactory;

    #[test]
    fn the_options_of_all_commands_fit_together() {
        Arguments::command().debug_assert();
    }
}
