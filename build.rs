//! Names the commit of a release, for `tipstrike --version`.
//!
//! The variable `TIPSTRIKE_COMMIT` names the commit; else the git repository of this folder, or
//! the file that `cargo package` writes into a crate. Builds for development name no commit, so that
//! a commit does not compile the program again.

use std::env;
use std::fs;
use std::path::{Path, PathBuf};
use std::process::Command;

/// Characters of the commit, as `git rev-parse --short=12` prints them.
const LENGTH: usize = 12;
const VARIABLE: &str = "TIPSTRIKE_COMMIT";
const PACKAGED: &str = ".cargo_vcs_info.json";

fn main() {
    println!("cargo::rerun-if-changed=build.rs");
    println!("cargo::rerun-if-env-changed={VARIABLE}");
    if let Some(commit) = commit().filter(|commit| !commit.is_empty()) {
        println!("cargo::rustc-env={VARIABLE}={commit}");
    }
}

fn commit() -> Option<String> {
    if let Ok(commit) = env::var(VARIABLE) {
        return Some(commit);
    }
    if env::var("PROFILE").as_deref() != Ok("release") {
        return None;
    }
    let root = PathBuf::from(env::var_os("CARGO_MANIFEST_DIR")?);
    from_git(&root).or_else(|| from_package(&root))
}

/// The commit, unless this folder is only a part of another repository.
fn from_git(root: &Path) -> Option<String> {
    let top = git(root, &["rev-parse", "--show-toplevel"])?;
    if fs::canonicalize(top).ok()? != fs::canonicalize(root).ok()? {
        return None;
    }
    // The log of HEAD grows with every commit and checkout.
    for file in ["HEAD", "logs/HEAD"] {
        let path = root.join(git(root, &["rev-parse", "--git-path", file])?);
        if path.exists() {
            println!("cargo::rerun-if-changed={}", path.display());
        }
    }
    let commit = git(root, &["rev-parse", "HEAD"])?;
    commit.get(..LENGTH).map(str::to_owned)
}

fn git(root: &Path, arguments: &[&str]) -> Option<String> {
    let output = Command::new("git").current_dir(root).args(arguments).output().ok()?;
    let text = String::from_utf8(output.stdout).ok()?;
    output.status.success().then(|| text.trim().to_owned())
}

fn from_package(root: &Path) -> Option<String> {
    let text = fs::read_to_string(root.join(PACKAGED)).ok()?;
    let (_, rest) = text.split_once("\"sha1\"")?;
    let digits = rest.split('"').find(|part| part.len() >= LENGTH)?;
    let is_commit = digits.bytes().all(|byte| byte.is_ascii_hexdigit());
    is_commit.then(|| digits[..LENGTH].to_owned())
}
