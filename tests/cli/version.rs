//! The build script reads the commit of a release from the crate or from the variable.

use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

const COMMIT: &str = "0123456789abcdef0123456789abcdef01234567";

/// The compiled build script.
fn script(folder: &Path) -> PathBuf {
    let script = folder.join("script");
    let compiled = Command::new("rustc")
        .args(["--edition", "2024", "-o"])
        .arg(&script)
        .arg(Path::new(env!("CARGO_MANIFEST_DIR")).join("build.rs"))
        .status()
        .unwrap();
    assert!(compiled.success());
    script
}

fn commit(script: &Path, folder: &Path, variables: &[(&str, &str)]) -> Option<String> {
    let output = Command::new(script)
        .current_dir(folder)
        .env_remove("TIPSTRIKE_COMMIT")
        .env("CARGO_MANIFEST_DIR", folder)
        .env("GIT_CEILING_DIRECTORIES", folder.parent().unwrap())
        .envs(variables.iter().copied())
        .output()
        .unwrap();
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    let mut lines = text.lines();
    lines.find_map(|line| {
        let name = line.strip_prefix("cargo::rustc-env=TIPSTRIKE_COMMIT=")?;
        Some(name.to_owned())
    })
}

#[test]
fn a_release_names_its_commit_with_and_without_git() {
    let folder = tempfile::tempdir().unwrap();
    let script = script(folder.path());
    let at = |name: &str| {
        let path = folder.path().join(name);
        fs::create_dir_all(&path).unwrap();
        path
    };
    let release = [("PROFILE", "release")];

    let bare = at("bare");
    assert_eq!(commit(&script, &bare, &release), None);
    let named = [("PROFILE", "release"), ("TIPSTRIKE_COMMIT", "abc")];
    assert_eq!(commit(&script, &bare, &named).as_deref(), Some("abc"));

    let packaged = at("packaged");
    let about = format!("{{\n  \"git\": {{\n    \"sha1\": \"{COMMIT}\"\n  }}\n}}");
    fs::write(packaged.join(".cargo_vcs_info.json"), about).unwrap();
    let short = commit(&script, &packaged, &release);
    assert_eq!(short.as_deref(), Some(&COMMIT[..12]));
    // Otherwise a development build would compile again after every commit.
    let development = [("PROFILE", "debug")];
    assert_eq!(commit(&script, &packaged, &development), None);

    let tree = at("tree");
    let git = |arguments: &[&str]| {
        let output = Command::new("git").current_dir(&tree).args(arguments).output();
        String::from_utf8(output.unwrap().stdout).unwrap()
    };
    git(&["init", "--quiet"]);
    let author = ["-c", "user.name=a", "-c", "user.email=a@b"];
    git(&[&author[..], &["commit", "--quiet", "--allow-empty", "-m", "a"]].concat());
    let head = git(&["rev-parse", "--short=12", "HEAD"]);
    assert_eq!(commit(&script, &tree, &release).as_deref(), Some(head.trim()));
    // A crate inside another repository does not have the commit of that repository.
    let inside = at("tree/vendor/tipstrike");
    assert_eq!(commit(&script, &inside, &release), None);
}
