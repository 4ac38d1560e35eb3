//! Corner contact in spur gear pairs: where, how hard and how long the tip of an incoming driven
//! tooth strikes the driver's flank before the normal path of contact begins.
//!
//! Data flows one way: [`numeric`] → [`model`] → [`case`](mod@case) → [`study`] → [`report`] → the
//! command line or the workbench. The core ([`numeric`], [`model`]) knows no files and no screen,
//! and builds without the terminal crates (`--no-default-features`).

pub mod case;
#[cfg(feature = "cli")]
pub mod cli;
pub mod model;
pub mod numeric;
pub mod report;
pub mod study;
#[cfg(feature = "tui")]
pub mod tui;
