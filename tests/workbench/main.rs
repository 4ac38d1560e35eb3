//! The workbench without a terminal: keys in, screen out.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    clippy::print_stdout,
    clippy::print_stderr,
    reason = "a failing test panics with a message and prints its figures"
)]
#![cfg(feature = "tui")]

#[path = "../oracle/envelope.rs"]
mod envelope;
#[path = "../harness/mod.rs"]
mod harness;

mod actions;
mod bare_numbers;
mod basics;
mod browser;
mod charts;
mod cursor;
mod explanation;
mod export;
mod form_aids;
mod frozen;
mod keys;
mod memory;
mod models;
mod panes;
mod picture;
mod pointer;
mod prompts;
mod readme_session;
mod relief_dialog;
mod screens;
mod study_pane;
mod teeth;
mod trade_pane;
