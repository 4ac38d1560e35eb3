//! Every case in `cases/` solves, and its report does not change.

use serde_json::Value;
use std::fs;
use std::path::{Path, PathBuf};
use tipstrike::case::file::Document;
use tipstrike::report::{Report, Selection, data};

fn toml_files(folder: &str) -> Vec<PathBuf> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join(folder);
    let mut paths: Vec<PathBuf> =
        fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()).collect();
    paths.retain(|path| path.extension().is_some_and(|ending| ending == "toml"));
    paths.sort();
    assert!(!paths.is_empty());
    paths
}

fn report(path: &Path, selection: Selection) -> Report {
    let name = format!("cases/{}", path.file_name().unwrap().to_string_lossy());
    let document = Document::parse(&name, &fs::read_to_string(path).unwrap()).unwrap();
    let inputs = document.case.inputs().unwrap();
    Report::solve(name, document.case, inputs, selection).unwrap()
}

#[test]
fn the_report_of_every_case_is_unchanged() {
    for path in toml_files("cases") {
        let stem = path.file_stem().unwrap().to_string_lossy().into_owned();
        insta::assert_snapshot!(
            format!("report_{stem}"),
            data::render(&report(&path, Selection::default()).with_others())
        );
    }
}

#[test]
fn no_line_is_wider_than_80_columns() {
    for path in toml_files("cases") {
        let selection = Selection { stations: true, ..Selection::default() };
        let page = data::render(&report(&path, selection).with_others());
        let wide = page.lines().find(|line| line.chars().count() > 80);
        assert_eq!(wide, None, "{}", path.display());
    }
}

/// Relative tolerance of the quantities of the reference answers.
const CLOSE: f64 = 1e-10;

#[test]
fn json_contains_the_reference_answers() {
    for path in toml_files("tests/reference/solve") {
        let mut line = Vec::new();
        data::write_json(&report(&path, Selection::default()), &mut line).unwrap();
        let object: Value = serde_json::from_slice(&line).unwrap();
        let answers: Value =
            serde_json::from_str(&fs::read_to_string(path.with_extension("json")).unwrap())
                .unwrap();
        assert_eq!(object["outcome"], answers["outcome"], "{}", path.display());
        for (key, answer) in
            answers.as_object().unwrap().iter().filter(|(_, answer)| answer.is_number())
        {
            let (value, answer) =
                (object["quantities"][key]["value"].as_f64().unwrap(), answer.as_f64().unwrap());
            assert!(
                (value - answer).abs() <= CLOSE * answer.abs(),
                "{}: {key} is {value}, not {answer}",
                path.display()
            );
        }
    }
}
