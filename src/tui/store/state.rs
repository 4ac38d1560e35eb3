//! The state folder, which survives a session: recent cases and journals of unsaved edits.
//!
//! Only a folder that no other user can change is used; otherwise a private folder replaces it.

use std::collections::VecDeque;
use std::env;
use std::ffi::OsString;
use std::fmt;
use std::fs;
use std::io;
use std::path::{Component, Path, PathBuf};

use directories::ProjectDirs;

use crate::case::sanitize::sanitize;
use crate::system::sharing::{self, Access};

/// Folders inside the state folder.
const INSIDE: [&str; 2] = ["journals", "sessions"];
/// Greatest number of symbolic links to follow.
const MOST_LINKS: usize = 40;
const STICKY: u32 = 0o1000;
const OWN_FOLDER: &str = "set XDG_STATE_HOME to a folder of your own";
const NO_FOLDER: &str = "HOME and XDG_STATE_HOME name no folder: set one of them";

/// The state folders that only this user can change.
#[derive(Debug, Clone, Default)]
pub struct State {
    /// The folder of this session.
    pub folder: Option<PathBuf>,
    /// Folders in which earlier sessions may have written.
    pub others: Vec<PathBuf>,
    /// Why the usual folder is not used, and which folder replaces it.
    pub notice: Option<String>,
}

/// Why a folder is not private.
#[derive(Debug)]
enum Exposed {
    Owner(PathBuf, u32),
    Writable(PathBuf),
    Unknown(PathBuf, io::Error),
}

impl State {
    /// The folders that the environment names.
    #[must_use]
    pub(crate) fn find() -> State {
        State::choose(usual(), private())
    }

    /// Selects the first private folder of the usual one and its replacements.
    #[must_use]
    pub fn choose(usual: Option<PathBuf>, private: Vec<PathBuf>) -> State {
        let user = sharing::user();
        let problem = match &usual {
            None => Some(NO_FOLDER.to_owned()),
            Some(folder) => check(folder, user).err().map(|why| why.to_string()),
        };
        let is_usual = problem.is_none();
        let mut safe: VecDeque<PathBuf> =
            private.into_iter().filter(|folder| check(folder, user).is_ok()).collect();
        let folder = usual.filter(|_| is_usual).or_else(|| safe.pop_front());
        let notice = problem.map(|problem| match &folder {
            Some(place) => format!(
                "{problem}. Until then the journals are in {}, and a restart deletes them",
                shown(place)
            ),
            None => format!("{problem}; until then, a crash loses unsaved edits"),
        });
        State { folder, others: safe.into(), notice }
    }
}

/// Creates a folder that only its owner can read, and its parents.
pub(in crate::tui) fn make(folder: &Path) -> io::Result<()> {
    sharing::create_private(folder)
}

/// Refuses a state folder that another user can change.
pub(in crate::tui) fn require_private(folder: &Path) -> io::Result<()> {
    let user = sharing::user();
    check(folder, user).map_err(|why| io::Error::other(why.to_string()))
}

fn usual() -> Option<PathBuf> {
    let own = absolute("XDG_STATE_HOME").map(|path| path.join("tipstrike"));
    own.or_else(|| {
        let folders = ProjectDirs::from("", "", "tipstrike")?;
        Some(folders.state_dir().unwrap_or(folders.data_local_dir()).to_owned())
    })
}

fn private() -> Vec<PathBuf> {
    let user = sharing::user();
    let runtime = absolute("XDG_RUNTIME_DIR").map(|path| path.join("tipstrike"));
    let temporary = env::temp_dir().join(format!("tipstrike-{user}"));
    runtime.into_iter().chain([temporary]).collect()
}

fn absolute(variable: &str) -> Option<PathBuf> {
    env::var_os(variable).map(PathBuf::from).filter(|path| path.is_absolute())
}

/// A missing folder is accepted, because it is created as private.
fn check(folder: &Path, user: u32) -> Result<(), Exposed> {
    is_private(folder, user)?;
    INSIDE.iter().try_for_each(|name| is_private(&folder.join(name), user))
}

/// Checks that every link and folder of the path belongs to the user or the system, that nobody
/// else may replace any of them, and that nobody else may write into the last folder.
fn is_private(folder: &Path, user: u32) -> Result<(), Exposed> {
    let mut at = PathBuf::from("/");
    // In a container the files of the system may belong to another user than 0.
    let system = fs::metadata(&at).map_or(0, |root| Access::of(&root).owner);
    let mut links = 0;
    let mut parts = parts_of(folder);
    while let Some(part) = parts.pop_front() {
        if part == ".." {
            at.pop();
            continue;
        }
        let next = at.join(part);
        let about = match fs::symlink_metadata(&next) {
            Err(error) if error.kind() == io::ErrorKind::NotFound => return Ok(()),
            about => about.map_err(|error| Exposed::Unknown(next.clone(), error))?,
        };
        let owner = Access::of(&about).owner;
        if ![user, 0, system].contains(&owner) {
            return Err(Exposed::Owner(next, owner));
        }
        if about.is_symlink() {
            links += 1;
            let target = fs::read_link(&next).and_then(|target| {
                (links <= MOST_LINKS)
                    .then_some(target)
                    .ok_or_else(|| io::Error::other("too many symbolic links"))
            });
            let target = target.map_err(|error| Exposed::Unknown(next, error))?;
            if target.is_absolute() {
                at = PathBuf::from("/");
            }
            parts = parts_of(&target).into_iter().chain(parts).collect();
            continue;
        }
        let is_last = parts.is_empty();
        if about.is_dir() && others_may_write(Access::of(&about), is_last) {
            return Err(Exposed::Writable(next));
        }
        if is_last && owner != user {
            return Err(Exposed::Owner(next, owner));
        }
        at = next;
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

fn parts_of(path: &Path) -> VecDeque<OsString> {
    let part = |part: Component<'_>| match part {
        Component::Normal(name) => Some(name.to_owned()),
        Component::ParentDir => Some("..".into()),
        Component::RootDir | Component::CurDir | Component::Prefix(_) => None,
    };
    path.components().filter_map(part).collect()
}

impl fmt::Display for Exposed {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Exposed::Owner(path, user) => {
                write!(f, "{} belongs to user {user}: {OWN_FOLDER}", shown(path))
            }
            Exposed::Writable(path) => {
                write!(f, "others may write in {}: chmod go-w it", shown(path))
            }
            Exposed::Unknown(path, error) => {
                write!(f, "{}: {error}: {OWN_FOLDER}", shown(path))
            }
        }
    }
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
        for name in ["there", "new/deeper"] {
            let state = State::choose(Some(path.join(name)), vec![path.join("other")]);
            assert_eq!(state.folder, Some(path.join(name)));
            assert_eq!(state.others, [path.join("other")]);
            assert_eq!(state.notice, None);
        }
        symlink("there", path.join("own-link")).expect("a link");
        let state = State::choose(Some(path.join("own-link")), Vec::new());
        assert_eq!((state.folder, state.notice), (Some(path.join("own-link")), None));
    }

    #[test]
    fn a_folder_that_others_may_write_is_replaced_by_a_private_one() {
        for exposed in ["state", "state/journals", "above"] {
            let (_folder, path) = folder_with(&["state/journals", "above/state"]);
            open_to_all(&path.join(exposed));
            let usual = path.join(exposed.split('/').next().unwrap_or_default());
            let usual = if exposed == "above" { usual.join("state") } else { usual };
            let state = State::choose(Some(usual.clone()), vec![path.join("run")]);
            assert_eq!(state.folder, Some(path.join("run")), "{exposed}");
            let notice = state.notice.expect("a notice");
            let place = path.join(exposed);
            let fix = format!("others may write in {}: chmod go-w it", place.display());
            assert!(notice.starts_with(&fix), "{notice}");
            assert!(notice.contains(&format!("are in {}", path.join("run").display())));
            let nowhere = State::choose(Some(usual), Vec::new());
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
            let state = State::choose(Some(path.join(usual)), vec![path.join("run")]);
            assert_eq!(state.folder, Some(path.join("run")), "{usual}");
            let notice = state.notice.expect("a notice");
            assert!(notice.contains("belongs to user 65534"), "{notice}");
        }
    }

    #[test]
    fn a_circle_of_links_is_refused() {
        let (_folder, path) = folder_with(&[]);
        symlink("circle", path.join("circle")).expect("a link");
        let state = State::choose(Some(path.join("circle/state")), Vec::new());
        assert!(state.folder.is_none() && state.notice.is_some());
    }
}
