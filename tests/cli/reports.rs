//! Every case in `cases/` solves, and its report does not change.

use std::fs;
use std::path::Path;

use tipstrike::case::file::Document;
use tipstrike::report::{Report, Selection, data};

#[test]
fn the_report_of_every_case_is_unchanged_and_fits_80_columns() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("cases");
    for path in fs::read_dir(folder).unwrap().map(|entry| entry.unwrap().path()) {
        let stem = path.file_stem().unwrap().to_string_lossy();
        let name = format!("cases/{stem}.toml");
        let document = Document::parse(&name, fs::read_to_string(&path).unwrap()).unwrap();
        let inputs = document.case.inputs().unwrap();
        let report = Report::solve(name, document.case, inputs, Selection::default()).unwrap();
        let mut report = report.with_others();
        insta::assert_snapshot!(format!("report_{stem}"), data::render(&report));
        report.selection.stations = true;
        let page = data::render(&report);
        let wide = page.lines().find(|line| line.chars().count() > 80);
        assert_eq!(wide, None, "{stem}");
    }
}
