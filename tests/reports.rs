//! Every case of the collection solves, and its report reads as it did.

// A test may stop at what it did not expect.
#![allow(clippy::unwrap_used)]

use std::fs;
use std::path::{Path, PathBuf};
use tipstrike::case::file::Document;
use tipstrike::report::{Report, Selection, text};

fn cases() -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    let mut paths: Vec<PathBuf> = fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    paths.sort();
    paths
}

fn report(path: &Path, selection: Selection) -> Report {
    let name = format!("cases/{}", path.file_name().unwrap().to_string_lossy());
    let document = Document::parse(&name, &fs::read_to_string(path).unwrap()).unwrap();
    let inputs = document.case.inputs().unwrap();
    Report::solve(name, document.case, inputs, selection).unwrap()
}

#[test]
fn every_case_reads_as_it_did() {
    for path in cases() {
        let stem = path.file_stem().unwrap().to_string_lossy().into_owned();
        insta::assert_snapshot!(format!("report_{stem}"), text::render(&report(&path, Selection::default())));
    }
}

#[test]
fn no_line_is_wider_than_80_columns() {
    for path in cases() {
        let page = text::render(&report(&path, Selection { stations: true, ..Selection::default() }));
        let wide = page.lines().find(|line| line.chars().count() > 80);
        assert_eq!(wide, None, "{}", path.display());
    }
}
