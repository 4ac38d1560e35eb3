//! The commands: case files, errors, output.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a failing test panics with a message and prints its figures"
)]

mod bad_files;
mod case_files;
mod commands;
mod compare;
mod drawing_sizes;
mod excitation_command;
mod explain;
mod import_command;
mod meaning;
mod output_files;
mod program;
mod report_command;
mod reports;
mod schema;
mod shards;
mod stiffness_command;
mod studies;
mod version;
