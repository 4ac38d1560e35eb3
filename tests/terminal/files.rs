//! Files in all states: changed by another program, linked, closed, missing; no edit is lost and
//! nothing blocks.
use crate::harness::{self, Desk, LARGE, SMALL, TABLE_1};
use crate::tty::{Launch, PROGRAM};

use std::fs::{self, File, Permissions};
use std::os::unix::fs::{MetadataExt, PermissionsExt, symlink};
use std::path::Path;
use std::process::Command;
use std::sync::Arc;
use std::time::{Duration, SystemTime};

use tipstrike::case::{Document, fields};
use tipstrike::tui::testing::{Action, Effect, Found, Next, SaveFault, Tab, update};

fn edited() -> Desk {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    desk.fill("operation.speed", "1500 rpm");
    desk
}

/// Changes of the file by another program: the same size and time, an older time, another file with
/// its name.
fn meddle(desk: &Desk, how: &str, text: &str) {
    let path = desk.path("case.toml");
    let time = fs::metadata(&path).and_then(|old| old.modified()).expect("a file");
    match how {
        "replaced" => {
            desk.write("other", text);
            fs::rename(desk.path("other"), &path).expect("the same folder");
        }
        _ => fs::write(&path, text).expect("room on the disk"),
    }
    let time = match how {
        "same time" | "replaced" => time,
        "older" => time - Duration::from_secs(86400),
        _ => SystemTime::now(),
    };
    touch(&path, time);
}

fn touch(path: &Path, time: SystemTime) {
    let file = File::options().write(true).open(path);
    file.and_then(|file| file.set_modified(time)).expect("our own file");
}

#[test]
fn a_file_changed_by_another_program_is_refused_and_the_differences_are_shown() {
    for how in ["same time", "older", "newer", "replaced"] {
        let mut desk = edited();
        // The same length as the old text.
        let theirs = TABLE_1.replace("2000 rpm", "2100 rpm").replace("\"5 mm\"", "\"6 mm\"");
        meddle(&desk, how, &theirs);
        desk.keys(&["Ctrl-S"]).has(&[
            "has changed on disk",
            "module: 6 mm in the file, 5 mm in the form (changed in the file)",
            "speed: 2100 rpm in the file, 1500 rpm in the form (changed in",
            "[  Reload  ] [  Save as  ] [  Overwrite  ] [> Cancel <]",
        ]);
        assert!(desk.read("case.toml").contains("2100 rpm") && desk.app.tab.is_unsaved(), "{how}");
    }
}

#[test]
fn a_changed_file_is_reloaded_saved_elsewhere_overwritten_or_kept() {
    let theirs = TABLE_1.replace("2000 rpm", "2100 rpm");
    for (keys, there, unsaved) in [
        (&["r"][..], "2100 rpm", false),
        (&["o"], "1500 rpm", false),
        (&["c"], "2100 rpm", true),
        (&["s", "Ctrl-U", "DIR/other.toml", "Enter"], "2100 rpm", false),
    ] {
        let mut desk = edited();
        meddle(&desk, "newer", &theirs);
        let folder = desk.folder.path().display().to_string();
        let keys: Vec<_> = keys.iter().map(|key| key.replace("DIR", &folder)).collect();
        desk.keys(&["Ctrl-S"]).keys(&keys.iter().map(String::as_str).collect::<Vec<_>>());
        assert!(desk.read("case.toml").contains(there), "{keys:?}");
        assert_eq!(desk.app.tab.is_unsaved(), unsaved, "{keys:?}");
        assert_eq!(desk.path("other.toml").exists(), keys[0] == "s", "{keys:?}");
        assert!(desk.app.prompts.is_empty(), "{keys:?}");
    }
}

#[test]
fn overwrite_asks_again_after_a_change_that_was_not_shown() {
    let theirs = |speed: &str| TABLE_1.replace("2000 rpm", speed);
    let mut desk = edited();
    meddle(&desk, "newer", &theirs("2100 rpm"));
    desk.keys(&["Ctrl-S"]);
    meddle(&desk, "same time", &theirs("2200 rpm"));
    desk.keys(&["o"]).has(&["has changed on disk", "2200 rpm in the file"]);
    assert!(desk.read("case.toml").contains("2200 rpm"));
    desk.keys(&["o"]);
    assert!(desk.app.prompts.is_empty() && desk.read("case.toml").contains("1500 rpm"));

    let other = desk.write("other.toml", &theirs("2100 rpm"));
    desk.keys(&["F2", "Ctrl-U", other.to_str().expect("UTF-8"), "Enter"]);
    desk.write("other.toml", &theirs("2200 rpm"));
    desk.keys(&["o"]).has(&["The file exists", "2200 rpm in the file"]);
    fs::remove_file(&other).expect("our own file");
    desk.keys(&["o"]);
    assert!(desk.read("other.toml").contains("1500 rpm"));
}

#[test]
fn a_failed_save_changes_nothing_and_skips_the_next_step() {
    let faults = [
        SaveFault::Exists(Found::default()),
        SaveFault::Changed(Found { lines: vec!["speed".to_owned()], stamp: None }),
        SaveFault::Held("process 1 on another machine for 3 s".to_owned()),
        SaveFault::Failed("no room".to_owned()),
    ];
    let nexts =
        [Next::Stay, Next::Quit, Next::Close, Next::SaveRest, Next::Load("other.toml".into())];
    for (fault, next) in faults.iter().flat_map(|fault| nexts.iter().map(move |next| (fault, next)))
    {
        let mut desk = edited();
        let before = desk.app.tab.clone();
        let failed = Action::Saved(desk.path("other.toml"), next.clone(), Err(fault.clone()));
        assert!(update(&mut desk.app, failed).is_empty(), "{fault:?} {next:?}");
        let after = &desk.app.tab;
        let parts = |tab: &Tab| {
            (
                tab.path.clone(),
                tab.case.clone(),
                tab.document.loaded().clone(),
                tab.document.stamp(),
            )
        };
        assert!(parts(after) == parts(&before), "{fault:?} {next:?}");
        assert!(after.is_unsaved() && desk.app.tabs().count() == 1, "{fault:?} {next:?}");
        desk.keys(&["Esc", "Esc", "Ctrl-Q"]).assert_shows("has unsaved edits");
        assert!(!desk.has_quit, "{fault:?} {next:?}");
    }
}

#[test]
fn text_typed_during_a_save_remains_unsaved() {
    let mut desk = edited();
    let effects = update(&mut desk.app, harness::run("save"));
    let save =
        effects.into_iter().find(|effect| matches!(effect, Effect::Save(..))).expect("a save");
    desk.keys(&["Ctrl-U", "1600 rpm"]);
    desk.perform(save);
    assert!(desk.shows("saved ") && desk.read("case.toml").contains("1500 rpm"));
    desk.assert(desk.shows("1600 rpm") && desk.app.tab.is_unsaved());
    desk.keys(&["Ctrl-S"]);
    assert!(desk.read("case.toml").contains("1600 rpm") && !desk.app.tab.is_unsaved());
}

#[test]
fn a_save_creates_a_deleted_file_again_with_its_mode_and_reports_this() {
    let desk = Desk::on(SMALL, "case.toml", TABLE_1);
    let path = desk.path("case.toml");
    fs::set_permissions(&path, Permissions::from_mode(0o600)).expect("our own file");
    let mut desk = Desk::at(desk.folder, "case.toml");
    desk.act(Action::Resize(LARGE));
    desk.fill("operation.speed", "1500 rpm");
    fs::remove_file(&path).expect("our own file");
    desk.keys(&["Ctrl-S"]).has(&["saved ", "the file was deleted, and this save created it again"]);
    let mode = fs::metadata(&path).expect("it is there").mode();
    assert_eq!(mode & 0o7777, 0o600);
    assert!(desk.read("case.toml").contains("1500 rpm") && !desk.app.tab.is_unsaved());
    desk.fill("operation.speed", "1600 rpm").keys(&["Ctrl-S"]);
    desk.assert_shows("saved ").lacks(&["deleted"]);
}

#[test]
fn after_a_save_under_another_name_the_case_is_the_new_file() {
    let mut desk = edited();
    let new = desk.path("new.toml").display().to_string();
    desk.keys(&["F2", "Ctrl-U", &new, "Enter"]);
    desk.assert(desk.shows("saved ") && desk.app.tab.short_name() == "new.toml");
    desk.fill("operation.speed", "1600 rpm").keys(&["Ctrl-S"]);
    assert!(desk.read("new.toml").contains("1600 rpm") && desk.read("case.toml") == TABLE_1);
}

#[test]
fn after_a_save_form_and_file_are_equal() {
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    for (key, text) in [
        ("driver.teeth", " 21  "),
        ("operation.speed", " 1500  rpm "),
        ("title", " a \t"),
        ("pair.module", "5.5 mm "),
    ] {
        desk.fill(key, text).keys(&["Ctrl-S"]);
        assert!(desk.shows("saved ") && !desk.app.tab.is_unsaved(), "{key}\n{}", desk.screen());
        let file = Document::read(&desk.path("case.toml")).expect("a good case");
        assert!(desk.app.tab.case == file.case, "{key}");
        let text = file.case.text(fields::index_of(key).expect("a field"));
        assert_eq!(desk.app.tab.form.input.value(), text.unwrap_or_default(), "{key}");
    }
    assert_eq!(desk.text("driver.teeth"), "21");
}

#[test]
fn a_path_that_is_no_file_is_reported_without_a_terminal() {
    let folder = tempfile::tempdir().expect("a folder");
    let path = |name: &str| folder.path().join(name);
    assert!(Command::new("mkfifo").arg(path("pipe")).status().is_ok_and(|status| status.success()));
    for (target, link) in [("loop", "loop"), ("nowhere", "dangling"), ("nodir/y", "far")] {
        symlink(target, path(link)).expect("a link");
    }
    fs::write(path("file"), "").expect("room on the disk");
    let run = |command: &str, name: &str| {
        Command::new(PROGRAM).arg(command).arg(path(name)).output().expect("the program starts")
    };
    let refused = |command: &str, name: &str| {
        let output = run(command, name);
        let words = String::from_utf8_lossy(&output.stderr).into_owned();
        assert_eq!(output.status.code(), Some(5), "{command} {name}: {words}");
        assert!(output.stdout.is_empty() && words.lines().count() == 1, "{command} {name} {words}");
        words
    };
    for name in ["pipe", "loop", "dangling", "none", ".", "none/case.toml"] {
        refused("solve", name);
        refused("check", name);
    }
    let here = folder.path().display();
    let missing = |name: &str| {
        let folder = format!("{here}/{name}");
        format!("the folder {folder} does not exist: create the folder (mkdir -p '{folder}')")
    };
    for (name, cause) in [
        ("pipe", "not a regular file".to_owned()),
        ("loop", String::new()),
        (".", "this is a folder".to_owned()),
        ("far", missing("nodir")),
        ("my own/x", missing("my own")),
        ("new/", format!("the folder {here}/new does not exist")),
        ("file/x/y", format!("{here}/file is not a folder")),
        ("/", "/: this is a folder: add the name of a file to it, such as /case.toml".to_owned()),
    ] {
        let words = refused("new", name);
        assert!(words.contains(&cause), "new {name}: {words}");
    }
    // A dangling link is the name of a new file.
    assert!(run("new", "dangling").status.success() && path("nowhere").is_file());
}

#[test]
fn a_path_to_save_to_is_completed_where_possible() {
    let mut desk = edited();
    let path = |name: &str| desk.folder.path().join(name).display().to_string();
    let (folder, missing, good) = (path("."), path("none/such/case.toml"), path("good.toml"));
    desk.keys(&["F2", "Ctrl-U", &folder, "Enter"]);
    desk.assert_shows("this is a folder: add the name of a file");
    desk.keys(&["Ctrl-U", &missing, "Enter"]).assert_shows("does not exist: create");
    assert!(desk.app.message.as_ref().is_some_and(|message| message.text.contains("mkdir -p")));
    desk.keys(&["Ctrl-U", &good, "Enter"]);
    desk.assert(desk.shows("saved ") && Path::new(&good).is_file());
}

#[test]
fn a_tilde_is_the_home_folder_where_paths_are_typed() {
    let launch = Launch::on_table_1();
    let home = launch.folder.path().join("home");
    fs::create_dir(&home).expect("a folder");
    fs::write(home.join("there.toml"), TABLE_1.replace("2000 rpm", "2100 rpm"))
        .expect("room on the disk");
    let mut tty = launch.variable("HOME", home.to_str().expect("UTF-8")).shown("Corner contact");
    tty.type_for("\x1bs\x15~/mine.toml\r", "saved ");
    assert!(home.join("mine.toml").is_file());
    tty.type_for("\x0f\x15~/", "there.toml");
    tty.type_for("there\r", "opened ");
    tty.wait_for("home/there.toml");
    tty.quit();
    assert!(!tty.folder.path().join("~").exists());
}

#[test]
fn a_file_written_by_another_program_is_read_again_without_edits() {
    let mut tty = Launch::on_table_1().size(24, 80).shown("5 mm");
    let theirs = TABLE_1.replace("\"5 mm\"", "\"6 mm\"");
    fs::write(tty.case(), &theirs).expect("room on the disk");
    tty.wait_for("it changed on disk");
    assert!(tty.shows("6 mm") && !tty.shows("5 mm"));

    // As an editor saves: a new file replaces the old one.
    let other = tty.case().with_extension("new");
    fs::write(&other, TABLE_1.replace("\"5 mm\"", "\"7 mm\"")).expect("room on the disk");
    fs::rename(&other, tty.case()).expect("the same folder");
    tty.wait_for("7 mm");

    let broken = TABLE_1.replace("\"5 mm\"", "5");
    fs::write(tty.case(), broken).expect("room on the disk");
    tty.wait_for("cannot be read: 11:10: pair.module");
    assert!(tty.shows("7 mm"));
    fs::write(tty.case(), &theirs).expect("room on the disk");
    tty.wait_for("6 mm");

    tty.type_for("\x158 mm", "8 mm");
    fs::write(tty.case(), TABLE_1).expect("room on the disk");
    tty.wait_for("changed on disk: Esc :reload reads it");
    assert!(tty.shows("8 mm"));
    tty.type_in("\x1b");
    tty.settle(Duration::from_millis(200));
    tty.type_for(":reload\r", "has unsaved edits");
    tty.type_for("d", "5 mm");
}

#[test]
fn another_file_at_the_path_of_the_case_is_read() {
    for swap in ["link", "folder", "linked folder", "folder above"] {
        let folder = Arc::new(tempfile::tempdir().expect("a folder"));
        let at = |name: &str| folder.path().join(name);
        for (place, module) in [("v1", "5 mm"), ("v2", "6 mm")] {
            fs::create_dir_all(at(place).join("deep")).expect("a folder");
            let text = TABLE_1.replace("5 mm", module);
            fs::write(at(place).join("case.toml"), &text).expect("room on the disk");
            fs::write(at(place).join("deep/case.toml"), &text).expect("room on the disk");
        }
        let link = |target: &str, name: &str| symlink(target, at(name)).expect("a link");
        let rename = |from: &str, to: &str| fs::rename(at(from), at(to)).expect("our own");
        let case = match swap {
            "link" => {
                link("v1/case.toml", "case.toml");
                link("v2/case.toml", "next");
                "case.toml"
            }
            "linked folder" => {
                link("v1", "now");
                link("v2", "next");
                "now/case.toml"
            }
            "folder above" => "v1/deep/case.toml",
            _ => "v1/case.toml",
        };
        let mut tty = Launch::of(Arc::clone(&folder)).argument(at(case)).shown("5 mm");
        tty.settle(Duration::from_millis(100));
        match swap {
            "link" => rename("next", "case.toml"),
            "linked folder" => rename("next", "now"),
            _ => {
                rename("v1", "old");
                rename("v2", "v1");
            }
        }
        tty.wait_for("6 mm");
        tty.type_for("\x157 mm\x13", "saved ");
        assert!(fs::read_to_string(at(case)).is_ok_and(|text| text.contains("7 mm")), "{swap}");
        tty.quit();
    }
}

#[test]
fn a_change_of_the_file_at_the_moment_of_a_key_stays_visible() {
    for delay in 0..12 {
        let mut tty = Launch::on_table_1().shown("5 mm");
        let theirs = TABLE_1.replace("20 deg", "21 deg");
        fs::write(tty.case(), &theirs).expect("room on the disk");
        tty.settle(Duration::from_millis(delay * 10 + 1));
        tty.type_for("7", "7 mm");
        for key in ["\x1b[D", "\x1b[C"] {
            tty.settle(Duration::from_millis(40));
            tty.type_in(key);
        }
        tty.wait_until("the change to be visible", |tty| {
            tty.shows("*changed on disk*") || tty.shows("21 deg")
        });
        if tty.shows("*changed on disk*") {
            fs::write(tty.case(), TABLE_1).expect("room on the disk");
            tty.wait_until("the change to be reverted", |tty| !tty.shows("*changed"));
        }
        tty.discard();
    }
}

#[test]
fn our_own_save_and_a_mere_touch_are_no_change_of_the_file() {
    let mut tty = Launch::on_table_1().size(24, 80).shown("5 mm");
    tty.type_for("\x156 mm", "6 mm");
    tty.type_for("\x13", "saved ");
    let later = SystemTime::now() + Duration::from_secs(5);
    touch(&tty.case(), later);
    tty.settle(Duration::from_millis(2500));
    assert!(tty.shows("saved ") && !tty.shows("changed on disk"));
}
