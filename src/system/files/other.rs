//! Systems without owners, modes and access lists of Unix: a new file gets the permissions of the
//! old one.

use std::fs::{File, Metadata};
use std::io;
use std::path::{MAIN_SEPARATOR, Path};

/// Gives a new file the permissions of the old one.
pub(crate) fn keep(old: &Metadata, _: &Path, new: &File) -> io::Result<()> {
    new.set_permissions(old.permissions())
}

/// No mode.
pub(crate) fn mode(_: &Metadata) -> Option<u32> {
    None
}

/// Every file has one name.
pub(crate) fn links(_: &Metadata) -> u64 {
    1
}

/// Whether the path ends like that of a folder.
pub(crate) fn names_a_folder(path: &Path) -> bool {
    path.to_string_lossy().ends_with(['/', MAIN_SEPARATOR])
}

/// Leaves the file as it is.
pub(crate) fn set_mode(_: &File, _: u32) -> io::Result<()> {
    Ok(())
}

/// Leaves the new file to the system.
pub(crate) fn with_mode<'b, 'p, 's>(
    builder: &'b mut tempfile::Builder<'p, 's>,
    _: u32,
) -> &'b mut tempfile::Builder<'p, 's> {
    builder
}
