//! Files that commands write with `--out`: what becomes of a result if the target changes, and which
//! targets are refused.

use crate::program::run;
use std::fs;
use std::io::Write;
use std::os::unix::fs::{MetadataExt, PermissionsExt, lchown, symlink};
use std::path::{Path, PathBuf};
use tipstrike::case::file::{Draft, SaveError, write};

const TABLE_1: &str = "cases/zhou-chen-2014.toml";
const NOBODY: u32 = 65534;

fn draft(path: &Path) -> Draft {
    Draft::check(path).unwrap();
    let mut draft = Draft::create(path).unwrap();
    draft.write_all(b"result").unwrap();
    draft
}

fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).unwrap();
    entries.map(|entry| entry.unwrap().path()).collect()
}

#[test]
fn a_result_replaces_a_target_that_appears_changes_or_vanishes_during_the_run() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out");
    let begun = draft(&path);
    fs::write(&path, "other").unwrap();
    fs::set_permissions(&path, fs::Permissions::from_mode(0o640)).unwrap();
    begun.finish().unwrap();
    let is_result = || {
        let mode = fs::metadata(&path).unwrap().mode();
        assert_eq!((fs::read_to_string(&path).unwrap().as_str(), mode & 0o7777), ("result", 0o640));
    };
    is_result();

    let begun = draft(&path);
    fs::remove_file(&path).unwrap();
    begun.finish().unwrap();
    is_result();

    let begun = draft(&path);
    fs::remove_file(&path).unwrap();
    symlink("end", &path).unwrap();
    begun.finish().unwrap();
    assert!(fs::symlink_metadata(&path).unwrap().is_symlink());
    assert_eq!(fs::read_to_string(folder.path().join("end")).unwrap(), "result");
    assert_eq!(files(folder.path()).len(), 2);
}

#[test]
fn a_result_that_cannot_replace_its_target_is_kept_and_named() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("out");
    let begun = draft(&path);
    fs::create_dir(&path).unwrap();
    let error = begun.finish().unwrap_err();
    let SaveError::Kept(cause, kept) = &error else { panic!("{error}") };
    assert!(matches!(**cause, SaveError::IsAFolder(..)), "{error}");
    assert!(error.to_string().contains(kept.as_str()), "{error}");
    // Later writes keep it, too.
    write(&folder.path().join("later"), b"", true).unwrap();
    assert_eq!(fs::read_to_string(kept).unwrap(), "result");
    assert_eq!(files(folder.path()).len(), 3);
}

#[test]
fn a_link_or_file_that_another_user_planted_is_not_replaced() {
    let (folder, own) = (tempfile::tempdir().unwrap(), tempfile::tempdir().unwrap());
    let private = own.path().join("private");
    fs::write(&private, "private").unwrap();
    let planted = folder.path().join("out");
    symlink(&private, &planted).unwrap();
    if lchown(&planted, Some(NOBODY), None).is_err() {
        eprintln!("skipped: this process cannot give files to another user");
        return;
    }
    let (outer, file) = (own.path().join("outer"), folder.path().join("file"));
    symlink(&planted, &outer).unwrap();
    fs::write(&file, "").unwrap();
    lchown(&file, Some(NOBODY), None).unwrap();
    let dangling = folder.path().join("dangling");
    symlink(own.path().join("new"), &dangling).unwrap();
    lchown(&dangling, Some(NOBODY), None).unwrap();
    let mode = |mode| fs::set_permissions(folder.path(), fs::Permissions::from_mode(mode));
    mode(0o1777).unwrap();
    for path in [&planted, &outer, &file, &dangling] {
        let out = path.to_str().unwrap();
        let varied = ["--vary", "operation.speed=500,900 rpm", "--out", out];
        let (code, _, errors) = run(&[&["sweep", TABLE_1][..], &varied].concat());
        assert!(code == 5 && errors.contains("belongs to another user"), "{errors}");
        assert!(write(path, b"", true).is_err(), "{out}");
    }
    assert_eq!(fs::read_to_string(&private).unwrap(), "private");
    assert_eq!(files(own.path()).len(), 2);
    assert_eq!(files(folder.path()).len(), 3);
    // Linux trusts the owner of the folder, and folders that not every user can write.
    lchown(folder.path(), Some(NOBODY), None).unwrap();
    draft(&outer).finish().unwrap();
    lchown(folder.path(), Some(0), None).unwrap();
    mode(0o755).unwrap();
    draft(&file).finish().unwrap();
    assert_eq!(fs::metadata(&file).unwrap().uid(), NOBODY);
    assert_eq!(fs::read_to_string(&private).unwrap(), "result");
}

#[test]
fn no_command_replaces_the_case_that_it_reads() {
    let folder = tempfile::tempdir().unwrap();
    let case = folder.path().join("case.svg");
    let text = fs::read_to_string(TABLE_1).unwrap();
    fs::write(&case, &text).unwrap();
    fs::create_dir(folder.path().join("inner")).unwrap();
    let link = folder.path().join("link.html");
    symlink("case.svg", &link).unwrap();
    let spelled = folder.path().join("inner/../case.svg");
    let second = folder.path().join("second.svg");
    let name = case.to_str().unwrap();
    let refused = |arguments: &[&str], out: &Path| {
        let out = ["--out", out.to_str().unwrap()];
        let (code, printed, errors) = run(&[arguments, &out].concat());
        assert_eq!((code, printed.as_str()), (2, ""), "{arguments:?} {errors}");
        assert!(errors.contains("is read by the command"), "{errors}");
        assert_eq!(fs::read_to_string(&case).unwrap(), text);
    };
    refused(&["plot", name], &case);
    refused(&["plot", name], &spelled);
    refused(&["plot", link.to_str().unwrap()], &case);
    refused(&["report", TABLE_1, name], &link);
    refused(&["relief", name], &link);
    fs::hard_link(&case, &second).unwrap();
    refused(&["plot", name], &second);
}
