//! Files outside the open cases: cases that are opened, and the state folder with the recent cases,
//! the latest first, and the journals of unsaved edits.
//!
//! Only a state folder that no other user can change is used; otherwise a private folder replaces it.

pub(crate) mod folder;

use std::env;
use std::ffi::OsStr;
use std::fs;
use std::io::{self, ErrorKind, Write};
use std::path::{Path, PathBuf};

use directories::ProjectDirs;
use tempfile::NamedTempFile;

use crate::case::file::ReadError;
use crate::case::file::Stamp;
use crate::case::sanitize::sanitize;
use crate::case::{Document, rexs};
use crate::system::sharing::{self, Access};

use folder::{Entry, Target};

/// Greatest number of recent cases.
const MOST_RECENTS: usize = 20;
/// Greatest size of the file of recent cases.
const MOST_BYTES: u64 = 256 * 1024;
/// Separator of paths: the only byte that no path contains.
const END: u8 = 0;

/// The folder of journals inside the state folder.
pub(super) const JOURNALS: &str = "journals";
const OWN_FOLDER: &str = "set XDG_STATE_HOME to a folder of your own";
const NO_FOLDER: &str = "HOME and XDG_STATE_HOME name no folder: set one of them";

/// The file of an open case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) struct WatchedFile {
    /// The path of the case.
    pub(crate) path: PathBuf,
    /// The file that was read, after resolution of links.
    pub(crate) target: PathBuf,
    /// The stamp of the text that was read.
    pub(crate) stamp: Stamp,
}

/// The document of the built-in case.
pub fn built_in() -> Document {
    Document::table_1()
}

/// Reads a case, or a model that is imported as a case. The error has one fault per line.
pub(super) fn load(path: &Path) -> Result<Box<Document>, Vec<String>> {
    // The keyboard is the standard input: reading a case from it would block.
    if path == Path::new("-") {
        return Err(vec![
            "the workbench does not read standard input: name a file, or use tipstrike solve -"
                .to_owned(),
        ]);
    }
    let document =
        if rexs::is_model(path) { rexs::read_document(path) } else { Document::read_draft(path) };
    let document = match document {
        Err(ReadError::NewerFormat(_)) => Document::read_newer(path),
        document => document,
    };
    document
        .map(Box::new)
        .map_err(|error| error.to_string().lines().map(|fault| without_name(path, fault)).collect())
}

/// The path with the home folder in place of `~`.
pub(super) fn at_home(path: &Path) -> PathBuf {
    match (path.strip_prefix("~"), absolute("HOME")) {
        (Ok(rest), Some(home)) => home.join(rest),
        _ => path.to_owned(),
    }
}

// The title above the faults already has the name.
fn without_name(path: &Path, fault: &str) -> String {
    fault.strip_prefix(&format!("{}:", shown(path))).unwrap_or(fault).trim_start().to_owned()
}

fn shown(path: &Path) -> String {
    sanitize(&path.display().to_string())
}

/// Recent cases as lines of the browser, and whether their files still exist.
pub fn looked_at(paths: Vec<PathBuf>) -> Vec<Entry> {
    let look = |path: PathBuf| {
        let is_missing = fs::metadata(&path).is_err_and(|error| !is_there(&error));
        let text = |name: &OsStr| name.to_string_lossy().into_owned();
        let mut name = path.file_name().map(text).unwrap_or_default();
        if is_missing {
            name += "  (missing)";
        }
        if let Some(folder) = path.parent().and_then(Path::file_name) {
            name = format!("{name}  in {}/", text(folder));
        }
        let whole = sanitize(&path.to_string_lossy());
        Entry::new(name, &whole, Target::File(path))
    };
    paths.into_iter().map(look).collect()
}

/// The recent cases.
pub(crate) fn recents() -> Vec<PathBuf> {
    let is_ours =
        |about: fs::Metadata| (about.is_file() && about.len() <= MOST_BYTES).then_some(());
    let read = |file: PathBuf| {
        fs::metadata(&file).ok().and_then(is_ours).and_then(|()| fs::read(&file).ok())
    };
    parse_list(&list_file().and_then(read).unwrap_or_default())
}

/// Adds a case as the latest.
pub(crate) fn add_recent(path: &Path) {
    let write = || -> io::Result<()> {
        let file = list_file().ok_or(ErrorKind::NotFound)?;
        let folder = file.parent().ok_or(ErrorKind::NotFound)?;
        sharing::create_private(folder)?;
        let mut new = NamedTempFile::new_in(folder)?;
        new.write_all(&render_list(&with_latest(recents(), std::path::absolute(path)?)))?;
        new.persist(&file).map_err(|error| error.error).map(drop)
    };
    // An error is ignored, because the list is only a convenience.
    drop(write());
}

fn with_latest(mut paths: Vec<PathBuf>, latest: PathBuf) -> Vec<PathBuf> {
    paths.retain(|path| *path != latest);
    paths.insert(0, latest);
    paths.truncate(MOST_RECENTS);
    paths
}

fn parse_list(bytes: &[u8]) -> Vec<PathBuf> {
    let paths = bytes.split(|&byte| byte == END).filter(|path| !path.is_empty());
    paths.map(|path| sharing::path_from_bytes(path.to_vec())).take(MOST_RECENTS).collect()
}

fn render_list(paths: &[PathBuf]) -> Vec<u8> {
    paths.iter().flat_map(|path| sharing::path_bytes(path).iter().copied().chain([END])).collect()
}

fn list_file() -> Option<PathBuf> {
    // Earlier versions stored the last case as a single path without a separator.
    State::find().folder.map(|folder| folder.join("last-case"))
}

/// The state folder, which survives a session and which only this user can change.
#[derive(Debug, Clone, Default)]
pub struct State {
    /// The folder; `None` if no folder is private.
    pub folder: Option<PathBuf>,
    /// Why the usual folder is not used, and which folder replaces it.
    pub notice: Option<String>,
}

impl State {
    /// The folder that the environment names, otherwise a replacement.
    pub(crate) fn find() -> State {
        let within = |variable: &str| absolute(variable).map(|path| path.join("tipstrike"));
        let usual = within("XDG_STATE_HOME").or_else(|| {
            let folders = ProjectDirs::from("", "", "tipstrike")?;
            Some(folders.state_dir().unwrap_or(folders.data_local_dir()).to_owned())
        });
        let temporary = env::temp_dir().join(format!("tipstrike-{}", sharing::user()));
        State::choose(usual, within("XDG_RUNTIME_DIR").into_iter().chain([temporary]))
    }

    /// Selects the first private folder of the usual one and its replacements.
    pub fn choose(
        usual: Option<PathBuf>,
        replacements: impl IntoIterator<Item = PathBuf>,
    ) -> State {
        let check = |folder: PathBuf| -> Result<PathBuf, String> {
            is_private(&folder).and_then(|()| is_private(&folder.join(JOURNALS)))?;
            Ok(folder)
        };
        let problem = match usual.ok_or_else(|| NO_FOLDER.to_owned()).and_then(check) {
            Ok(folder) => return State { folder: Some(folder), notice: None },
            Err(problem) => problem,
        };
        let folder = replacements.into_iter().find_map(|folder| check(folder).ok());
        let notice = match &folder {
            Some(place) => format!(
                "{problem}. Until then the journals are in {}, and a restart deletes them",
                shown(place)
            ),
            None => format!("{problem}; until then, a crash loses unsaved edits"),
        };
        State { folder, notice: Some(notice) }
    }
}

fn absolute(variable: &str) -> Option<PathBuf> {
    env::var_os(variable).map(PathBuf::from).filter(|path| path.is_absolute())
}

fn is_there(error: &io::Error) -> bool {
    error.kind() != ErrorKind::NotFound
}

/// Checks that a folder and its target belong to the user, and that nobody else may write there. A
/// missing folder is accepted, because it is created as private.
pub(super) fn is_private(folder: &Path) -> Result<(), String> {
    let place = shown(folder);
    for about in [fs::symlink_metadata(folder), fs::metadata(folder)] {
        let about = match about {
            Err(error) if is_there(&error) => {
                return Err(format!("{place}: {error}: {OWN_FOLDER}"));
            }
            Err(_) => continue,
            Ok(about) => about,
        };
        let Access { owner, mode } = Access::of(&about);
        if owner != sharing::user() {
            return Err(format!("{place} belongs to user {owner}: {OWN_FOLDER}"));
        }
        if about.is_dir() && mode & 0o022 != 0 {
            return Err(format!("others may write in {place}: chmod go-w it"));
        }
    }
    Ok(())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::Permissions;
    use std::os::unix::fs::{PermissionsExt, lchown, symlink};

    #[test]
    fn the_latest_case_is_first_and_no_case_is_listed_twice() {
        let paths = ["a", "b", "c"].map(PathBuf::from).to_vec();
        assert_eq!(with_latest(paths.clone(), "c".into()), ["c", "a", "b"].map(PathBuf::from));
        let many: Vec<PathBuf> =
            (0..MOST_RECENTS).map(|number| number.to_string().into()).collect();
        let more = with_latest(many, "new".into());
        assert_eq!((more.len(), &more[0]), (MOST_RECENTS, &PathBuf::from("new")));
    }

    #[test]
    fn every_path_is_saved_and_read() {
        let odd = sharing::path_from_bytes(vec![b'/', 0xff, b'\n', b' ']);
        let paths = vec![odd, "/plain.toml".into()];
        assert_eq!(parse_list(&render_list(&paths)), paths);
        assert_eq!(parse_list(b"/kept/before.toml"), [PathBuf::from("/kept/before.toml")]);
        assert!(parse_list(b"").is_empty());
    }

    fn folder_with(names: &[&str]) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().expect("a folder");
        for name in names {
            sharing::create_private(&folder.path().join(name)).expect("our own folder");
        }
        let path = folder.path().to_owned();
        (folder, path)
    }

    fn open_to_all(folder: &Path) {
        let mode = Permissions::from_mode(0o777);
        fs::set_permissions(folder, mode).expect("our own folder");
    }

    #[test]
    fn a_private_folder_is_used_whether_or_not_it_exists() {
        let (_folder, path) = folder_with(&["there"]);
        symlink("there", path.join("own-link")).expect("a link");
        for name in ["there", "new/deeper", "own-link"] {
            let state = State::choose(Some(path.join(name)), [path.join("other")]);
            assert_eq!((state.folder, state.notice), (Some(path.join(name)), None));
        }
    }

    #[test]
    fn a_folder_that_others_may_write_is_replaced_by_a_private_one() {
        for exposed in ["state", "state/journals"] {
            let (_folder, path) = folder_with(&["state/journals"]);
            open_to_all(&path.join(exposed));
            let usual = path.join("state");
            let state = State::choose(Some(usual.clone()), [path.join("run")]);
            assert_eq!(state.folder, Some(path.join("run")), "{exposed}");
            let notice = state.notice.expect("a notice");
            let place = path.join(exposed);
            let fix = format!("others may write in {}: chmod go-w it", place.display());
            assert!(notice.starts_with(&fix), "{notice}");
            assert!(notice.contains(&format!("are in {}", path.join("run").display())));
            let nowhere = State::choose(Some(usual), []);
            assert_eq!(nowhere.folder, None);
            assert!(
                nowhere.notice.is_some_and(|notice| notice.contains("a crash loses unsaved edits"))
            );
        }
    }

    #[test]
    fn a_link_or_folder_of_another_user_is_replaced_by_a_private_one() {
        let (_folder, path) = folder_with(&["state", "theirs", "mine"]);
        symlink(path.join("mine"), path.join("state/journals")).expect("a link");
        // Only the superuser may change the owner of a file.
        if lchown(path.join("state/journals"), Some(65534), None).is_err()
            || lchown(path.join("theirs"), Some(65534), None).is_err()
        {
            return;
        }
        for usual in ["state", "theirs"] {
            let state = State::choose(Some(path.join(usual)), [path.join("run")]);
            assert_eq!(state.folder, Some(path.join("run")), "{usual}");
            let notice = state.notice.expect("a notice");
            assert!(notice.contains("belongs to user 65534"), "{notice}");
        }
    }

    #[test]
    fn a_circle_of_links_is_refused() {
        let (_folder, path) = folder_with(&[]);
        symlink("circle", path.join("circle")).expect("a link");
        let state = State::choose(Some(path.join("circle/state")), []);
        assert!(state.folder.is_none() && state.notice.is_some());
    }
}
