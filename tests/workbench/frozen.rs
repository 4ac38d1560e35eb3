//! Cases of earlier versions open without a change of their bytes; newer ones are shown and never
//! overwritten; saves leave no temporary files.
use crate::harness::{Desk, SMALL, TABLE_1};

use std::fs;
use std::path::Path;
use std::time::{Duration, SystemTime};

use tipstrike::case::Document;
use tipstrike::tui::testing::Effect;

#[test]
fn every_frozen_case_opens_and_an_untouched_save_keeps_its_bytes() {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("tests/frozen");
    let frozen: Vec<_> =
        fs::read_dir(folder).expect("a folder").flatten().map(|entry| entry.path()).collect();
    assert!(frozen.len() >= 8);
    let own = tempfile::tempdir().expect("a folder");
    for path in frozen {
        let bytes = fs::read(&path).expect("it is there");
        let copy = own.path().join(path.file_name().expect("a name"));
        fs::write(&copy, &bytes).expect("room on the disk");
        let mut document = Document::read(&copy).unwrap_or_else(|fault| panic!("{fault}"));
        assert!(document.case.inputs().is_ok(), "{}", path.display());
        document.save(&copy).unwrap_or_else(|fault| panic!("{fault}"));
        assert!(fs::read(&copy).expect("it is there") == bytes, "{}", path.display());
    }
}

#[test]
fn a_newer_format_is_shown_and_never_written() {
    let newer = TABLE_1.replacen("format = 1", "format = 2\nnew_key = \"kept\"", 1);
    let mut desk = Desk::new(SMALL);
    let path = desk.write("newer.toml", &newer);
    desk.perform(Effect::Load(path.clone()));
    desk.has(&["*read-only*", "newer format"]);
    assert!(desk.shows("5 mm"), "what this version knows is shown");
    desk.fill("operation.speed", "1500 rpm").keys(&["Ctrl-S"]);
    desk.assert(desk.shows("not saved: ") && desk.app.tab.is_unsaved());
    let other = desk.path("other.toml").display().to_string();
    desk.keys(&["F2", "Ctrl-U", &other, "Enter"]);
    desk.assert(desk.shows("not saved: ") && !desk.path("other.toml").exists());
    assert_eq!(desk.read("newer.toml"), newer);
    // An invalid text is not a newer case either.
    let path = desk.write("none.toml", "format = 2\n\u{1b}[2J");
    desk.perform(Effect::Load(path));
}

#[test]
fn a_save_deletes_temporary_files_that_a_killed_save_left_a_day_ago() {
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    let now = SystemTime::now();
    let names = [".tipstrike-killed", ".tipstrike-used", ".other-killed"];
    for (name, hours) in names.into_iter().zip([25, 23, 25]) {
        let file = fs::File::options().write(true).open(desk.write(name, "left"));
        let file = file.expect("our own file");
        file.set_modified(now - Duration::from_secs(3600 * hours)).expect("our own file");
    }
    desk.fill("operation.speed", "1500 rpm").keys(&["Ctrl-S"]).assert_shows("saved ");
    assert_eq!(names.map(|name| desk.path(name).exists()), [false, true, true]);
}
