//! The target file of a save: resolves links, checks the folder, and replaces the file in one step.

use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use tempfile::NamedTempFile;

use super::error::{SaveError, shown};
use crate::system::files;

/// Greatest number of symbolic links in a path.
const MOST_LINKS: usize = 40;
/// Prefix of temporary files. The process id follows.
const TEMPORARY: &str = ".tipstrike-";
/// Age of a temporary file that no save can still use.
const STALE: Duration = Duration::from_secs(60);

/// Writes a file that is not a case, such as a report or the settings. Resolves links. On failure
/// the old file stays. `over` allows replacing an existing file.
///
/// # Errors
/// If nothing was written.
pub fn write(path: &Path, bytes: &[u8], over: bool) -> Result<(), SaveError> {
    let target = target_of(path)?;
    if target.old.is_some() && !over {
        return Err(SaveError::AlreadyThere(shown(path)));
    }
    target.replace(bytes, None, path)
}

/// The path after resolution of all symbolic links, for an existing or a new file.
///
/// # Errors
/// If a folder of the path is missing or cannot be read, or the links form a circle.
pub fn followed(path: &Path) -> io::Result<PathBuf> {
    resolve(path).map_err(|(_, error)| error)
}

/// Like [`followed`]. The error includes the path whose folder it concerns.
fn resolve(path: &Path) -> Result<PathBuf, (PathBuf, io::Error)> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&path) {
            Ok(next) => path = path.parent().unwrap_or(&path).join(next),
            Err(error) if is_no_link(&path, &error) => {
                return place_of(&path).map_err(|error| (path, error));
            }
            Err(error) => return Err((path, error)),
        }
    }
    Err((path, io::Error::other("too many symbolic links")))
}

// The error for a file that is not a link depends on the system.
fn is_no_link(path: &Path, error: &io::Error) -> bool {
    matches!(
        error.kind(),
        ErrorKind::InvalidInput | ErrorKind::NotFound | ErrorKind::NotADirectory
    ) || fs::symlink_metadata(path).is_ok_and(|about| !about.is_symlink())
}

/// The absolute path. The root, `.` and `..` are folders themselves.
fn place_of(path: &Path) -> io::Result<PathBuf> {
    match path.file_name() {
        Some(name) => Ok(fs::canonicalize(folder_of(path))?.join(name)),
        None => fs::canonicalize(path),
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent()
        .filter(|folder| !folder.as_os_str().is_empty())
        .unwrap_or(Path::new("."))
}

/// A file to write, after resolution of links, and its present state.
pub(super) struct Target {
    pub(super) path: PathBuf,
    pub(super) old: Option<fs::Metadata>,
}

pub(super) fn target_of(path: &Path) -> Result<Target, SaveError> {
    let name = shown(path);
    let target = resolve(path).map_err(|(last, error)| no_folder(path, &last, error))?;
    match fs::metadata(&target) {
        Ok(old) => {
            replaceable(&target, &old, path)?;
            Ok(Target {
                path: target,
                old: Some(old),
            })
        }
        Err(error) if error.kind() == ErrorKind::NotFound && files::names_a_folder(path) => {
            Err(no_folder(path, &path.join("file"), error))
        }
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Target {
            path: target,
            old: None,
        }),
        Err(error) => Err(SaveError::Unwritable(name, error)),
    }
}

/// The error if the folder of `last` does not exist. The links of `path` lead to `last`.
fn no_folder(path: &Path, last: &Path, error: io::Error) -> SaveError {
    let (name, folder) = (shown(path), folder_of(last));
    if !matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) {
        return SaveError::Unwritable(name, error);
    }
    let nearest = folder.ancestors().find(|place| place.exists());
    match nearest.filter(|place| !place.is_dir()) {
        Some(file) => SaveError::NotAFolder(name, shown(file)),
        None => SaveError::NoFolder(name, shown(folder), for_a_shell(folder)),
    }
}

/// The path quoted as one word of a shell command.
fn for_a_shell(path: &Path) -> String {
    let name = shown(path);
    let is_plain = |c: char| c.is_alphanumeric() || "/._+-,=@%".contains(c);
    if name.chars().all(is_plain) && !name.starts_with('-') {
        name
    } else {
        let dashed = if name.starts_with('-') { "./" } else { "" };
        format!("'{dashed}{}'", name.replace('\'', "'\\''"))
    }
}

fn replaceable(target: &Path, old: &fs::Metadata, path: &Path) -> Result<(), SaveError> {
    let name = shown(path);
    if old.is_dir() {
        return Err(SaveError::IsAFolder(name, shown(&path.join("case.toml"))));
    }
    if !old.is_file() {
        return Err(SaveError::NotAFile(name));
    }
    if files::links(old) > 1 {
        return Err(SaveError::HardLinked(name, files::links(old)));
    }
    let closed = OpenOptions::new().write(true).open(target).err();
    match closed {
        None if !old.permissions().readonly() => Ok(()),
        Some(error) if error.kind() != ErrorKind::PermissionDenied => {
            Err(SaveError::Unwritable(name, error))
        }
        _ => Err(SaveError::ReadOnly(name)),
    }
}

impl Target {
    /// `mode` is the mode of a new file.
    pub(super) fn replace(
        &self,
        bytes: &[u8],
        mode: Option<u32>,
        path: &Path,
    ) -> Result<(), SaveError> {
        self.write(bytes, mode).map_err(|error| match error.kind() {
            ErrorKind::AlreadyExists if self.old.is_none() => SaveError::AlreadyThere(shown(path)),
            _ => SaveError::Unwritable(shown(path), error),
        })
    }

    /// Writes a temporary file beside the target, then renames it. Each step is on disk before the
    /// next step.
    fn write(&self, bytes: &[u8], mode: Option<u32>) -> io::Result<()> {
        let mut file = self.begin(mode)?;
        file.write_all(bytes)?;
        self.finish(file, mode)
    }

    /// Creates a temporary file beside the target.
    fn begin(&self, mode: Option<u32>) -> io::Result<NamedTempFile> {
        // Others cannot read the file before its mode is set. The umask limits the mode of a new
        // file.
        let is_new = self.old.is_none() && mode.is_none();
        let first = if is_new { 0o666 } else { 0o600 };
        let prefix = format!("{TEMPORARY}{}-", std::process::id());
        let mut builder = tempfile::Builder::new();
        files::with_mode(builder.prefix(&prefix), first).tempfile_in(folder_of(&self.path))
    }

    /// Moves the complete file to the target.
    fn finish(&self, file: NamedTempFile, mode: Option<u32>) -> io::Result<()> {
        let folder = folder_of(&self.path);
        if let Some(old) = &self.old {
            files::keep(old, &self.path, file.as_file())?;
        } else if let Some(mode) = mode {
            files::set_mode(file.as_file(), mode)?;
        }
        file.as_file().sync_all()?;
        match self.old {
            Some(_) => file.persist(&self.path).map_err(|error| error.error)?,
            // Does not replace a file that another program created meanwhile.
            None => file
                .persist_noclobber(&self.path)
                .map_err(|error| error.error)?,
        };
        // The new file is in place even if flushing the folder fails.
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
        clear(folder);
        Ok(())
    }
}

/// A file that replaces the target only after it is complete. If dropped before, it leaves no file.
pub struct Draft {
    target: Target,
    file: NamedTempFile,
    name: String,
}

impl Draft {
    /// Creates the file.
    ///
    /// # Errors
    /// If the file cannot be created.
    pub fn create(path: &Path) -> Result<Draft, SaveError> {
        let (target, name) = (target_of(path)?, shown(path));
        match target.begin(None) {
            Ok(file) => Ok(Draft { target, file, name }),
            Err(error) => Err(SaveError::Unwritable(name, error)),
        }
    }

    /// Moves the complete file to the target.
    ///
    /// # Errors
    /// If the system refuses. The old file then stays.
    pub fn finish(self) -> Result<(), SaveError> {
        let Draft { target, file, name } = self;
        target
            .finish(file, None)
            .map_err(|error| SaveError::Unwritable(name, error))
    }

    /// The error of a failed write, with the name of the file.
    #[must_use]
    pub fn unwritable(&self, error: io::Error) -> SaveError {
        SaveError::Unwritable(self.name.clone(), error)
    }
}

impl Write for Draft {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.flush()
    }
}

/// Removes temporary files of killed saves in a folder. Ignores files that cannot be removed.
fn clear(folder: &Path) {
    let entries = fs::read_dir(folder).into_iter().flatten().flatten();
    for entry in entries.filter(|entry| entry.file_name().to_str().is_some_and(is_left_over)) {
        let about = entry.metadata();
        let is_old = |about: &fs::Metadata| {
            about
                .modified()
                .is_ok_and(|time| time.elapsed().is_ok_and(|age| age > STALE))
        };
        if about.is_ok_and(|about| about.is_file() && is_old(&about)) {
            drop(fs::remove_file(entry.path()));
        }
    }
}

// The process of the file has ended. On a shared disk the process can run on another machine, hence
// the age.
fn is_left_over(name: &str) -> bool {
    let process = name
        .strip_prefix(TEMPORARY)
        .and_then(|rest| rest.split_once('-'))
        .and_then(|(process, _)| process.parse().ok());
    process.is_some_and(|process: u32| !Path::new("/proc").join(process.to_string()).exists())
}
