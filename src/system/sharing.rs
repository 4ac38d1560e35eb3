//! What the processes of one machine share: lock files, users, and paths as bytes.

use std::ffi::OsString;
use std::fs::{DirBuilder, File, Metadata, OpenOptions, Permissions};
use std::io::{self, ErrorKind};
use std::os::unix::ffi::{OsStrExt, OsStringExt};
use std::os::unix::fs::{DirBuilderExt, MetadataExt, OpenOptionsExt, PermissionsExt};
use std::path::{Path, PathBuf};

use rustix::fs::OFlags;

/// Opens a lock file without following a link, and creates it if missing. The file of another user
/// may be readable only, which is enough to lock it.
pub(crate) fn open_lock(path: &Path) -> io::Result<File> {
    let flags = (OFlags::NOFOLLOW | OFlags::NONBLOCK).bits().cast_signed();
    let open = |options: &mut OpenOptions| options.read(true).custom_flags(flags).open(path);
    let ours = open(OpenOptions::new().write(true).create(true).truncate(false).mode(0o644));
    ours.or_else(|error| match error.kind() {
        ErrorKind::PermissionDenied => open(&mut OpenOptions::new()).map_err(|_| error),
        _ => Err(error),
    })
}

/// Makes an own file readable for every user.
pub(crate) fn open_to_readers(file: &File) -> io::Result<()> {
    file.set_permissions(Permissions::from_mode(0o644))
}

/// Whether both are the same file.
pub(crate) fn is_same_file(one: &Metadata, other: &Metadata) -> bool {
    (one.dev(), one.ino()) == (other.dev(), other.ino())
}

/// Owner, group and mode of a file.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Access {
    pub(crate) owner: u32,
    pub(crate) mode: u32,
}

impl Access {
    pub(crate) fn of(about: &Metadata) -> Access {
        Access { owner: about.uid(), mode: about.mode() }
    }
}

/// The effective user id of this process.
pub(crate) fn user() -> u32 {
    rustix::process::geteuid().as_raw()
}

/// The host name.
pub(crate) fn host() -> String {
    rustix::system::uname().nodename().to_string_lossy().into_owned()
}

/// Creates a folder that only its owner can read, and its parents.
pub(crate) fn create_private(folder: &Path) -> io::Result<()> {
    DirBuilder::new().recursive(true).mode(0o700).create(folder)
}

/// The bytes of a path.
pub(crate) fn path_bytes(path: &Path) -> &[u8] {
    path.as_os_str().as_bytes()
}

/// The path of these bytes.
pub(crate) fn path_from_bytes(bytes: Vec<u8>) -> PathBuf {
    OsString::from_vec(bytes).into()
}
