//! A wrong value on the command line.

use clap::error::{Error, ErrorKind};

/// One line of wrong usage.
pub(super) fn misused(cause: String) -> Error {
    Error::raw(ErrorKind::ValueValidation, cause + "\n")
}
