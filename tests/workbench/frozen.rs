//! Cases of earlier versions open without a change of their bytes; newer ones are shown and never
//! overwritten; saves leave no temporary files.
use crate::harness;

use std::fs;
use std::path::Path;
use std::time::{Duration, SystemTime};

use harness::{Desk, SMALL, TABLE_1};
use tipstrike::case::Document;
use tipstrike::tui::testing::actions::Effect;

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
    assert!(desk.shows("*read-only*") && desk.shows("newer format"), "{}", desk.screen());
    assert!(desk.shows("5 mm"), "what this version knows is shown");
    desk.fill("operation.speed", "1500 rpm").keys(&["Ctrl-S"]);
    assert!(desk.shows("not saved: ") && desk.app.tab.is_unsaved(), "{}", desk.screen());
    let other = desk.path("other.toml").display().to_string();
    desk.keys(&["F2", "Ctrl-U", &other, "Enter"]);
    assert!(desk.shows("not saved: ") && !desk.path("other.toml").exists(), "{}", desk.screen());
    assert_eq!(desk.read("newer.toml"), newer);
    // An invalid text is not a newer case either.
    let path = desk.write("none.toml", "format = 2\n\u{1b}[2J");
    desk.perform(Effect::Load(path));
}

#[test]
fn a_save_deletes_only_the_temporary_file_of_a_killed_save_on_this_machine() {
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    let boot = fs::read_to_string("/proc/sys/kernel/random/boot_id").expect("this is Linux");
    let boot = boot.trim();
    let names = [
        format!(".tipstrike-{boot}-killed"),
        format!(".tipstrike-{boot}-used"),
        ".tipstrike-00000000-0000-4000-8000-000000000000-abc".to_owned(),
        format!(".tipstrike-{}-abc", u32::MAX / 4),
        ".tipstrike-x".to_owned(),
    ];
    let old = SystemTime::now() - Duration::from_secs(3600);
    let files = names.each_ref().map(|name| {
        let file = fs::File::options().write(true).open(desk.write(name, "left"));
        let file = file.expect("our own file");
        file.set_modified(old).expect("our own file");
        file
    });
    files[1].try_lock().expect("our own file");
    desk.fill("operation.speed", "1500 rpm").keys(&["Ctrl-S"]);
    assert!(desk.shows("saved "), "{}", desk.screen());
    assert_eq!(names.map(|name| desk.path(&name).exists()), [false, true, true, true, true]);
}
