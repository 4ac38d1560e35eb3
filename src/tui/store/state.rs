//! The folder of what outlives a session: the case that was open last, and the journals of unsaved edits.

use std::env;
use std::ffi::OsString;
use std::fs::{self, DirBuilder};
use std::io;
use std::os::unix::ffi::{OsStrExt, OsStringExt};
use std::os::unix::fs::DirBuilderExt;
use std::path::{Path, PathBuf};

use directories::ProjectDirs;

/// Where it is; `None` where the system names no home.
#[must_use]
pub fn folder() -> Option<PathBuf> {
    let own = env::var_os("XDG_STATE_HOME").map(PathBuf::from).filter(|path| path.is_absolute());
    own.map(|path| path.join("tipstrike")).or_else(|| {
        let folders = ProjectDirs::from("", "", "tipstrike")?;
        Some(folders.state_dir().unwrap_or(folders.data_local_dir()).to_owned())
    })
}

/// Make a folder that only its owner looks into, and those above it.
pub(super) fn make(folder: &Path) -> io::Result<()> {
    DirBuilder::new().recursive(true).mode(0o700).create(folder)
}

/// Open this case when the workbench starts the next time. Only a convenience: without it the next start begins with
/// the built-in case.
pub(super) fn remember(path: &Path) {
    let write = |folder: PathBuf| -> io::Result<()> {
        make(&folder)?;
        fs::write(folder.join("last-case"), std::path::absolute(path)?.as_os_str().as_bytes())
    };
    drop(folder().map(write));
}

/// The case that was open last.
pub(super) fn last_case() -> Option<PathBuf> {
    let path = OsString::from_vec(fs::read(folder()?.join("last-case")).ok()?);
    (!path.is_empty()).then(|| path.into())
}
