//! The target file of a save: resolves links, checks the folder, and replaces the file in one step.

use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};
use std::time::Duration;

use tempfile::{Builder, NamedTempFile, PersistError};

use super::fault::{SaveError, shown};
use crate::system::files;

/// Greatest number of symbolic links in a path.
const MOST_LINKS: usize = 40;
/// Prefix of temporary files.
const TEMPORARY: &str = ".tipstrike-";
/// Prefix of a complete result that cannot replace its target.
const RESULT: &str = "tipstrike-result-";

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
    target.replace(bytes, None, path, over)
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
            Ok(next) => match refuse_planted(&path) {
                Ok(()) => path = path.parent().unwrap_or(&path).join(next),
                Err(error) => return Err((path, error)),
            },
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
    matches!(error.kind(), ErrorKind::InvalidInput | ErrorKind::NotFound | ErrorKind::NotADirectory)
        || fs::symlink_metadata(path).is_ok_and(|about| !about.is_symlink())
}

/// Refuses what Linux refuses with `fs.protected_symlinks` and `fs.protected_regular`, after the link
/// is read: another user can replace his own link at any time, but not a trusted one.
fn refuse_planted(path: &Path) -> io::Result<()> {
    if !files::is_planted(path, folder_of(path))? {
        return Ok(());
    }
    Err(io::Error::new(
        ErrorKind::Unsupported,
        format!(
            "{} belongs to another user, in a folder where every user can create files",
            shown(path)
        ),
    ))
}

/// The absolute path. The root, `.` and `..` are folders themselves.
fn place_of(path: &Path) -> io::Result<PathBuf> {
    match path.file_name() {
        Some(name) => Ok(fs::canonicalize(folder_of(path))?.join(name)),
        None => fs::canonicalize(path),
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
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
            refuse_planted(&target).map_err(|error| SaveError::Unwritable(name, error))?;
            replaceable(&target, &old, path)?;
            Ok(Target { path: target, old: Some(old) })
        }
        Err(error) if error.kind() == ErrorKind::NotFound && files::names_a_folder(path) => {
            Err(no_folder(path, &path.join("file"), error))
        }
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Target { path: target, old: None }),
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
    /// Writes a temporary file beside the target, then renames it. `mode` is the mode of a new file;
    /// `over` allows replacing a file that another program created meanwhile.
    pub(super) fn replace(
        &self,
        bytes: &[u8],
        mode: Option<u32>,
        path: &Path,
        over: bool,
    ) -> Result<(), SaveError> {
        let is_private = self.old.is_some() || mode.is_some();
        let written = begin(&self.path, is_private).and_then(|mut file| {
            file.as_file_mut().write_all(bytes)?;
            Ok(self.finish(file, mode, over)?)
        });
        written.map_err(|error| match error.kind() {
            ErrorKind::AlreadyExists if !over => SaveError::AlreadyThere(shown(path)),
            _ => SaveError::Unwritable(shown(path), error),
        })
    }

    /// Moves the complete file to the target. Each step is on disk before the next step.
    fn finish(
        &self,
        file: NamedTempFile,
        mode: Option<u32>,
        over: bool,
    ) -> Result<(), PersistError> {
        let prepared = match (&self.old, mode) {
            (Some(old), _) => files::keep(old, &self.path, file.as_file()),
            (None, Some(mode)) => files::set_mode(file.as_file(), mode),
            (None, None) => Ok(()),
        };
        if let Err(error) = prepared.and_then(|()| file.as_file().sync_all()) {
            return Err(PersistError { error, file });
        }
        if over || self.old.is_some() {
            file.persist(&self.path)?;
        } else {
            file.persist_noclobber(&self.path)?;
        }
        let folder = folder_of(&self.path);
        // The new file is in place even if flushing the folder fails.
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
        clear(folder);
        Ok(())
    }
}

/// Creates a temporary file beside a file. The umask limits the mode of a file that is not private.
fn begin(beside: &Path, is_private: bool) -> io::Result<NamedTempFile> {
    let mode = if is_private { 0o600 } else { 0o666 };
    files::with_mode(Builder::new().prefix(TEMPORARY), mode).tempfile_in(folder_of(beside))
}

/// Removes temporary files of killed saves in a folder: those that nobody wrote to for a day.
/// Ignores files that cannot be removed.
fn clear(folder: &Path) {
    const LEFT: Duration = Duration::from_secs(86_400);
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let is_left = |about: fs::Metadata| {
            let age = about.modified().ok().and_then(|time| time.elapsed().ok());
            about.is_file() && age.is_some_and(|age| age > LEFT)
        };
        let is_ours = entry.file_name().to_string_lossy().starts_with(TEMPORARY);
        if is_ours && entry.metadata().is_ok_and(is_left) {
            drop(fs::remove_file(entry.path()));
        }
    }
}

/// A file that replaces the target only after it is complete. If dropped before, it leaves no file.
pub struct Draft {
    path: PathBuf,
    file: NamedTempFile,
}

impl Draft {
    /// Refuses a target that cannot be replaced, before long work starts.
    ///
    /// # Errors
    /// The reason.
    pub fn check(path: &Path) -> Result<(), SaveError> {
        let target = target_of(path)?;
        let file = begin(&target.path, true);
        let tried = file.and_then(|file| match &target.old {
            Some(old) => files::keep(old, &target.path, file.as_file()),
            None => Ok(()),
        });
        tried.map_err(|error| SaveError::Unwritable(shown(path), error))
    }

    /// Creates the file. Only [`Draft::finish`] refuses a target that cannot be replaced.
    ///
    /// # Errors
    /// If the file cannot be created.
    pub fn create(path: &Path) -> Result<Draft, SaveError> {
        let place = resolve(path).map_err(|(last, error)| no_folder(path, &last, error))?;
        let old = target_of(path).ok().and_then(|target| target.old);
        let file = begin(&place, old.is_some())
            .map_err(|error| SaveError::Unwritable(shown(path), error))?;
        if let Some(old) = old {
            // The target may vanish. The file then has its attributes, as far as possible.
            let _ = files::keep(&old, &place, file.as_file());
        }
        let path = path.to_owned();
        Ok(Draft { path, file })
    }

    /// Moves the complete file to the target, whether or not the target exists by now.
    ///
    /// # Errors
    /// If the system refuses. The old file then stays, and the error names the complete file beside it.
    pub fn finish(self) -> Result<(), SaveError> {
        let Draft { path, file } = self;
        let unwritable = |error| SaveError::Unwritable(shown(&path), error);
        file.as_file().sync_all().map_err(unwritable)?;
        match target_of(&path) {
            Err(error) => Err(kept(file, error)),
            Ok(target) => target
                .finish(file, None, true)
                .map_err(|PersistError { error, file }| kept(file, unwritable(error))),
        }
    }

    /// The error of a failed write, with the name of the file.
    #[must_use]
    pub fn unwritable(&self, error: io::Error) -> SaveError {
        SaveError::Unwritable(shown(&self.path), error)
    }
}

impl Write for Draft {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.as_file_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_file_mut().flush()
    }
}

/// Keeps a complete file under a name that no save clears, and adds the name to the error.
fn kept(file: NamedTempFile, error: SaveError) -> SaveError {
    let name = file.path().to_string_lossy();
    let random = name.rsplit('-').next().unwrap_or_default();
    let place = file.path().with_file_name(format!("{RESULT}{random}"));
    let place = match file.persist_noclobber(&place) {
        Ok(_) => Ok(place),
        // In a folder that is read-only by now, the file stays where it is.
        Err(PersistError { file, .. }) => file.keep().map(|(_, place)| place),
    };
    match place {
        Ok(place) if place.exists() => SaveError::Kept(Box::new(error), shown(&place)),
        _ => error,
    }
}
