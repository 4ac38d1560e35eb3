//! The folder of what outlives a session: the cases that were open last, and the journals of
//! unsaved edits.

use std::env;
use std::fs::DirBuilder;
use std::io;
use std::os::unix::fs::DirBuilderExt;
use std::path::{Path, PathBuf};

use directories::ProjectDirs;

/// Where it is; `None` where the system names no home.
#[must_use]
pub fn folder() -> Option<PathBuf> {
    let own = env::var_os("XDG_STATE_HOME")
        .map(PathBuf::from)
        .filter(|path| path.is_absolute());
    own.map(|path| path.join("tipstrike")).or_else(|| {
        let folders = ProjectDirs::from("", "", "tipstrike")?;
        Some(
            folders
                .state_dir()
                .unwrap_or(folders.data_local_dir())
                .to_owned(),
        )
    })
}

/// Make a folder that only its owner looks into, and those above it.
pub(in crate::tui) fn make(folder: &Path) -> io::Result<()> {
    DirBuilder::new().recursive(true).mode(0o700).create(folder)
}
