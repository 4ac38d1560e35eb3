//! The state folder, which survives a session: recent cases and journals of unsaved edits.
//!
//! Only a folder that no other user can change is used; otherwise a private folder replaces it.

use std::env;
use std::fs;
use std::io;
use std::path::{Path, PathBuf};

use directories::ProjectDirs;

use crate::case::sanitize::sanitize;
use crate::system::sharing::{self, Access};

/// The folder of journals inside the state folder.
pub(in crate::tui) const JOURNALS: &str = "journals";
const STICKY: u32 = 0o1000;
const OWN_FOLDER: &str = "set XDG_STATE_HOME to a folder of your own";
const NO_FOLDER: &str = "HOME and XDG_STATE_HOME name no folder: set one of them";

/// The state folder that only this user can change.
#[derive(Debug, Clone, Default)]
pub struct State {
    /// The folder; `None` if no folder is private.
    pub folder: Option<PathBuf>,
    /// Why the usual folder is not used, and which folder replaces it.
    pub notice: Option<String>,
}

impl State {
    /// The folder that the environment names, otherwise a replacement.
    #[must_use]
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
    #[must_use]
    pub fn choose(
        usual: Option<PathBuf>,
        replacements: impl IntoIterator<Item = PathBuf>,
    ) -> State {
        let checked = usual.ok_or_else(|| NO_FOLDER.to_owned()).and_then(check);
        let Err(problem) = checked else {
            return State { folder: checked.ok(), notice: None };
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

/// Creates a folder that only its owner can read, and its parents.
pub(in crate::tui) fn make(folder: &Path) -> io::Result<()> {
    sharing::create_private(folder)
}

/// Refuses a state folder that another user can change.
pub(in crate::tui) fn require_private(folder: &Path) -> io::Result<()> {
    is_private(folder).map_err(io::Error::other)
}

fn absolute(variable: &str) -> Option<PathBuf> {
    env::var_os(variable).map(PathBuf::from).filter(|path| path.is_absolute())
}

/// Returns the folder if it is private, with its folder of journals. A missing folder is accepted,
/// because it is created as private.
fn check(folder: PathBuf) -> Result<PathBuf, String> {
    is_private(&folder)?;
    is_private(&folder.join(JOURNALS))?;
    Ok(folder)
}

/// Checks that the folders of the path and of its target belong to the user or the system, that
/// nobody else may replace any of them, and that nobody else may write into the last folder.
fn is_private(folder: &Path) -> Result<(), String> {
    let user = sharing::user();
    // In a container the files of the system may belong to another user than 0.
    let system = fs::metadata("/").map_or(0, |root| Access::of(&root).owner);
    let unknown = |error: io::Error| format!("{}: {error}: {OWN_FOLDER}", shown(folder));
    let is_there = |error: &io::Error| error.kind() != io::ErrorKind::NotFound;
    let target = match fs::canonicalize(folder) {
        Err(error) if is_there(&error) => return Err(unknown(error)),
        target => target.ok(),
    };
    for place in folder.ancestors().chain(target.iter().flat_map(|target| target.ancestors())) {
        let about = match fs::symlink_metadata(place) {
            Err(error) if is_there(&error) => return Err(unknown(error)),
            Err(_) => continue,
            Ok(about) => about,
        };
        let (access, is_last) = (Access::of(&about), target.as_deref() == Some(place));
        if about.is_dir() && others_may_write(access, is_last) {
            return Err(format!("others may write in {}: chmod go-w it", shown(place)));
        }
        if access.owner != user && (is_last || ![0, system].contains(&access.owner)) {
            let (place, owner) = (shown(place), access.owner);
            return Err(format!("{place} belongs to user {owner}: {OWN_FOLDER}"));
        }
    }
    Ok(())
}

/// In a sticky folder everybody may write, but nobody may replace the files of others. A group with
/// the number of the owner is private, because most systems create one group for each user.
fn others_may_write(Access { owner, group, mode }: Access, is_last: bool) -> bool {
    let is_own_group = !is_last && [owner, 0].contains(&group);
    let by_group = mode & 0o020 != 0 && !is_own_group;
    let by_all = mode & 0o002 != 0;
    (by_group || by_all) && (is_last || mode & STICKY == 0)
}

fn shown(path: &Path) -> String {
    sanitize(&path.display().to_string())
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::fs::Permissions;
    use std::os::unix::fs::{PermissionsExt, lchown, symlink};

    fn folder_with(names: &[&str]) -> (tempfile::TempDir, PathBuf) {
        let folder = tempfile::tempdir().expect("a folder");
        for name in names {
            make(&folder.path().join(name)).expect("our own folder");
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
        for exposed in ["state", "state/journals", "above"] {
            let (_folder, path) = folder_with(&["state/journals", "above/state"]);
            open_to_all(&path.join(exposed));
            let usual = path.join(if exposed == "above" { "above/state" } else { "state" });
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
