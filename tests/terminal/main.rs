//! The program in a real terminal: signals, saves, recovery, floods.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a failing test panics with a message and prints its figures"
)]
#![cfg(all(feature = "cli", feature = "tui"))]

#[path = "../harness/mod.rs"]
mod harness;
#[path = "../tty/mod.rs"]
mod tty;

mod busy;
mod faults;
mod files;
mod first_frame;
mod hostile;
mod pty;
mod recovery;
mod screen;
mod soak;
