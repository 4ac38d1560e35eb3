//! Everything that differs between operating systems: files, signals, terminal and users.
//!
//! No other module names an interface of Unix. The commands need only `files` and Ctrl-C, which
//! every system has in some form; the workbench needs Unix.

#[cfg(all(unix, feature = "tui"))]
pub(crate) mod changes;
pub(crate) mod files;
#[cfg(feature = "cli")]
pub(crate) mod interrupt;
#[cfg(all(unix, feature = "tui"))]
pub(crate) mod sharing;
#[cfg(all(unix, feature = "tui"))]
pub(crate) mod terminal;

/// Makes a write beyond the file size limit return an error. By default the signal of the limit
/// ends the process.
#[cfg(feature = "cli")]
pub fn report_file_limit_as_error() {
    #[cfg(unix)]
    drop(signal_hook::flag::register(signal_hook::consts::SIGXFSZ, std::sync::Arc::default()));
}
