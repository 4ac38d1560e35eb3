//! Attributes of a file other than its content, and their transfer to a new file.

#[cfg(not(unix))]
mod other;
#[cfg(unix)]
mod unix;

#[cfg(all(not(unix), feature = "cli"))]
pub(crate) use other::is_same;
#[cfg(not(unix))]
pub(crate) use other::{is_planted, keep, links, mode, names_a_folder, set_mode, with_mode};
#[cfg(all(unix, feature = "cli"))]
pub(crate) use unix::is_same;
#[cfg(all(unix, feature = "tui"))]
pub(crate) use unix::number;
#[cfg(unix)]
pub(crate) use unix::{is_planted, keep, links, mode, names_a_folder, set_mode, with_mode};
