//! Attributes of a file other than its content, and their transfer to a new file.

#[cfg(not(unix))]
pub(crate) use other::*;
#[cfg(unix)]
pub(crate) use unix::*;

/// Owner, mode and access list of a file, for the file that replaces it.
#[cfg(unix)]
mod unix {
    use std::fs::{self, File, Metadata, Permissions};
    use std::io::{self, ErrorKind};
    use std::os::unix::ffi::OsStrExt;
    use std::os::unix::fs::{MetadataExt, PermissionsExt, fchown};
    use std::path::Path;

    use xattr::FileExt;

    /// The attribute with the access list of a file.
    const ACCESS_LIST: &str = "system.posix_acl_access";

    /// Gives a new file owner, access list and mode of the old one.
    ///
    /// # Errors
    /// [`ErrorKind::Unsupported`] if the system refuses that, or the error of a full disk.
    pub(crate) fn keep(old: &Metadata, path: &Path, new: &File) -> io::Result<()> {
        keep_owner(old, new)?;
        keep_access_list(path, new)?;
        // The mode is set last: a new owner clears bits, and an access list sets them.
        set_mode(new, old.mode())
    }

    #[expect(clippy::unnecessary_wraps, reason = "other systems have no mode")]
    pub(crate) fn mode(about: &Metadata) -> Option<u32> {
        Some(about.mode())
    }

    /// The number of hard links to a file.
    pub(crate) fn links(about: &Metadata) -> u64 {
        about.nlink()
    }

    /// The inode number of a file.
    #[cfg(feature = "tui")]
    pub(crate) fn number(about: &Metadata) -> u64 {
        about.ino()
    }

    /// Whether both paths lead to the same file.
    #[cfg(feature = "cli")]
    pub(crate) fn is_same(one: &Path, other: &Path) -> bool {
        let inode = |path| fs::metadata(path).map(|about| (about.dev(), about.ino()));
        matches!((inode(one), inode(other)), (Ok(one), Ok(other)) if one == other)
    }

    /// Whether a link or file can be a trap: it is in a sticky folder that every user can write, and
    /// belongs neither to this user nor to the owner of the folder.
    pub(crate) fn is_planted(path: &Path, folder: &Path) -> io::Result<bool> {
        const STICKY_AND_OPEN: u32 = 0o1002;
        let (about, folder) = (fs::symlink_metadata(path)?, fs::metadata(folder)?);
        let trusted = [folder.uid(), rustix::process::geteuid().as_raw()];
        Ok(folder.mode() & STICKY_AND_OPEN == STICKY_AND_OPEN && !trusted.contains(&about.uid()))
    }

    /// Whether the path ends in a separator.
    pub(crate) fn names_a_folder(path: &Path) -> bool {
        path.as_os_str().as_bytes().ends_with(b"/")
    }

    /// Sets the permission bits of a file.
    pub(crate) fn set_mode(file: &File, mode: u32) -> io::Result<()> {
        file.set_permissions(Permissions::from_mode(mode & 0o7777))
    }

    /// Creates files with these permission bits, less the umask.
    pub(crate) fn with_mode<'b, 'p, 's>(
        builder: &'b mut tempfile::Builder<'p, 's>,
        mode: u32,
    ) -> &'b mut tempfile::Builder<'p, 's> {
        builder.permissions(Permissions::from_mode(mode))
    }

    fn keep_owner(old: &Metadata, new: &File) -> io::Result<()> {
        let now = new.metadata()?;
        if (now.uid(), now.gid()) == (old.uid(), old.gid()) {
            return Ok(());
        }
        let owner = format!(
            "the file belongs to user {} and group {}, and a new one would not",
            old.uid(),
            old.gid()
        );
        fchown(new, Some(old.uid()), Some(old.gid())).map_err(|error| refused(&error, owner))
    }

    // A new file may inherit an access list from its folder that the old file does not have.
    fn keep_access_list(path: &Path, new: &File) -> io::Result<()> {
        let known = |list: io::Result<Option<Vec<u8>>>| match list {
            Err(error) if error.kind() == ErrorKind::Unsupported => Ok(None),
            list => list,
        };
        let kept = match (known(xattr::get(path, ACCESS_LIST))?, known(new.get_xattr(ACCESS_LIST))?)
        {
            (Some(list), _) => new.set_xattr(ACCESS_LIST, &list),
            (None, Some(_)) => new.remove_xattr(ACCESS_LIST),
            (None, None) => Ok(()),
        };
        let lost =
            |error: &io::Error| format!("the access list of the file would be lost ({error})");
        kept.map_err(|error| refused(&error, lost(&error)))
    }

    fn refused(error: &io::Error, words: String) -> io::Error {
        let is_full = matches!(error.kind(), ErrorKind::StorageFull | ErrorKind::QuotaExceeded);
        io::Error::new(if is_full { error.kind() } else { ErrorKind::Unsupported }, words)
    }
}

/// Systems without Unix owners, modes and access lists: a new file gets the permissions of the old
/// one.
#[cfg(not(unix))]
mod other {
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
}
