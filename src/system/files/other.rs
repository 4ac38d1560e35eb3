//! Systems without Unix owners, modes and access lists: a new file gets the permissions of the old
//! one.

use std::fs::{self, File, Metadata};
use std::io;
use std::path::{MAIN_SEPARATOR, Path};

/// Gives a new file the permissions of the old one.
pub(crate) fn keep(old: &Metadata, _: &Path, new: &File) -> io::Result<()> {
    new.set_permissions(old.permissions())
}

/// Always `None`: these systems have no mode.
pub(crate) fn mode(_: &Metadata) -> Option<u32> {
    None
}

/// Always 1: these systems report no hard links.
pub(crate) fn links(_: &Metadata) -> u64 {
    1
}

/// Whether both paths lead to the same file.
#[cfg(feature = "cli")]
pub(crate) fn is_same(one: &Path, other: &Path) -> bool {
    matches!((fs::canonicalize(one), fs::canonicalize(other)), (Ok(one), Ok(other)) if one == other)
}

/// Always false: these systems have no sticky folders.
pub(crate) fn is_planted(_: &Path, _: &Path) -> io::Result<bool> {
    Ok(false)
}

/// Whether the path ends in a separator.
pub(crate) fn names_a_folder(path: &Path) -> bool {
    path.to_string_lossy().ends_with(['/', MAIN_SEPARATOR])
}

/// Does nothing: these systems have no mode.
pub(crate) fn set_mode(_: &File, _: u32) -> io::Result<()> {
    Ok(())
}

/// Does nothing: the system chooses the permissions.
pub(crate) fn with_mode<'b, 'p, 's>(
    builder: &'b mut tempfile::Builder<'p, 's>,
    _: u32,
) -> &'b mut tempfile::Builder<'p, 's> {
    builder
}
