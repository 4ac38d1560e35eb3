//! The file browser: folders, previews with their verdict, recent cases; no content of a folder
//! delays the screen.
use crate::harness::{self, Desk, LARGE, SMALL, TABLE_1, name, requested, results};

use std::ffi::OsStr;
use std::fs;
use std::os::unix::ffi::OsStrExt;
use std::os::unix::fs::symlink;
use std::path::Path;
use std::process::Command;

use insta::assert_snapshot;
use tipstrike::tui::testing::ascii::is_safe;
use tipstrike::tui::testing::store::case_search;
use tipstrike::tui::testing::{Action, Effect, Slot, update};

/// Five cases and a folder; the second case is open.
fn shelf(desk: &mut Desk) {
    for (file, text) in [
        ("a-strikes.toml", TABLE_1.to_owned()),
        ("b-exceeds.toml", TABLE_1.replace("2500 N", "2000 N")),
        ("c-relieved.toml", TABLE_1.replace("tip_relief = \"0 um\"", "tip_relief = \"80 um\"")),
        (
            "d-bad.toml",
            TABLE_1.replace("\"5 mm\"", "\"5 kg\"").replace("teeth = 20\n", "teth = 20\n"),
        ),
        ("e-newer.toml", TABLE_1.replacen("format = 1", "format = 2", 1)),
        ("f-refused.toml", TABLE_1.replace("addendum = 1.0", "addendum = 1.9")),
        ("note.txt", String::new()),
    ] {
        desk.write(file, &text);
    }
    fs::create_dir(desk.path("sub")).expect("a folder");
    desk.write("sub/deep.toml", TABLE_1);
}

fn desk_before_a_shelf(size: ratatui::layout::Size) -> Desk {
    let mut desk = Desk::on(size, "case.toml", TABLE_1);
    shelf(&mut desk);
    desk
}

/// The preview of the selected line, on one line.
fn preview(desk: &Desk) -> String {
    let screen = desk.screen();
    let right = screen.lines().filter_map(|line| line.split('│').nth(2));
    right.flat_map(str::split_whitespace).collect::<Vec<_>>().join(" ")
}

fn marked(desk: &Desk) -> String {
    let screen = desk.screen();
    let line = screen.lines().find_map(|line| line.split_once("│ ▸ ")).unwrap_or_default().1;
    line.split('│').next().unwrap_or_default().trim().to_owned()
}

#[test]
fn the_case_under_the_cursor_shows_its_verdict() {
    let mut desk = desk_before_a_shelf(LARGE);
    desk.write("sub/Cargo.toml", "[package]\n");
    desk.keys(&["Ctrl-O"]);
    assert_eq!(marked(&desk), "case.toml", "the present case, among the others");
    for (file, expected) in [
        ("a-str", &["Zhou & Chen 2014, Table 1", "z 20/20, m 5 mm, α 20 deg, b 8 mm"][..]),
        ("a-str", &["15 kW at 2000 rpm", "method exact", "ok impact force F_S 2191.0 N <= 2500 N"]),
        ("a-str", &["Corner contact 1.366 deg before E: free impact 2191.0 N"]),
        ("b-exc", &["EXCEEDED impact force F_S 2191.0 N > 2000 N (110 %)"]),
        (
            "c-rel",
            &[
                "No corner contact: the tip clears the flank before E, Δ = ",
                "ok impact force F_S does not occur: no corner contact",
            ],
        ),
        ("d-bad", &["It cannot be opened:", "11:10: pair.module", "teth"]),
        ("e-new", &["Newer format: opens read-only.", "Corner contact 1.366 deg"]),
        ("f-ref", &["Not solved: ", "unknown impact force F_S"]),
        ("sub", &["A folder with 1 case, 0 folders."]),
    ] {
        desk.keys(&["Ctrl-U", file]);
        for expected in expected {
            assert!(preview(&desk).contains(expected), "{file}: {expected}\n{}", desk.screen());
        }
    }
    desk.keys(&["Esc", "Ctrl-P", "units", "Enter", "Ctrl-O", "a-str"]);
    assert!(preview(&desk).contains("492.56 lbf"), "in the units of the results");
}

#[test]
fn entering_and_leaving_folders_selects_the_previous_folder() {
    let mut desk = desk_before_a_shelf(SMALL);
    desk.keys(&["Ctrl-O", "sub", "Enter"]);
    assert_eq!(marked(&desk), "deep.toml");
    desk.keys(&["Backspace"]);
    assert_eq!(marked(&desk), "sub/");
    desk.keys(&["Tab", "Alt-Up"]);
    assert_eq!(marked(&desk), "sub/");
    desk.keys(&["Enter", "Up", "Enter"]);
    assert_eq!(marked(&desk), "sub/", "../ leads up as well");
    desk.keys(&["x", "Backspace"]);
    assert!(desk.shows("a-strikes.toml"), "a letter is deleted before the folder is left");
    for _ in 0..40 {
        desk.keys(&["Alt-Up"]);
    }
    desk.assert(desk.screen().lines().nth(2).is_some_and(|line| line.contains("│ / ")));
}

#[test]
fn paths_are_typed_or_pasted() {
    let mut desk = desk_before_a_shelf(LARGE);
    let deep = desk.path("sub/deep.toml");
    desk.keys(&["Ctrl-O"]).act(Action::Paste(name(&deep).to_owned()));
    assert_eq!(marked(&desk), "deep.toml");
    desk.keys(&["Enter"]);
    assert!(desk.shows("opened ") && desk.app.tab.short_name() == "deep.toml");
    // A path begins in the folder that is shown.
    desk.keys(&["Ctrl-O", "../a-str", "Enter"]);
    assert_eq!(desk.app.tab.short_name(), "a-strikes.toml");
}

#[test]
fn an_entry_with_the_typed_name_is_selected_before_those_that_contain_it() {
    let mut desk = desk_before_a_shelf(SMALL);
    desk.write("a-case.toml", TABLE_1);
    desk.write("case-relief.toml", TABLE_1);
    for typed in ["case.toml", "case"] {
        desk.keys(&["Ctrl-O", "Ctrl-U", typed]);
        assert_eq!(marked(&desk), "case.toml");
        desk.keys(&["Esc"]);
    }
    desk.keys(&["Ctrl-O"]);
    desk.keys(&["Ctrl-U", "DEEP"]);
    assert_eq!(marked(&desk), "sub/deep.toml", "cases below the folder are found");
    desk.write(".hidden.toml", TABLE_1);
    desk.keys(&["Esc", "Ctrl-O"]).lacks(&["hidden"]);
    desk.keys(&[".hi"]);
    assert_eq!(marked(&desk), ".hidden.toml", "hidden ones are there where their dot is typed");
}

#[test]
fn recent_cases_are_on_the_same_page_and_missing_files_are_marked() {
    let mut desk = desk_before_a_shelf(SMALL);
    desk.recents =
        vec![desk.path("a-strikes.toml"), desk.path("gone.toml"), desk.path("sub/deep.toml")];
    desk.keys(&["Ctrl-O"]).has(&["Recent cases", "gone.toml  (missing)", "deep.toml  in sub/"]);
    desk.keys(&["Alt-R", "Down"]);
    assert!(preview(&desk).contains("It cannot be opened: file not found"));
    desk.keys(&["Enter"]).has(&["gone.toml cannot be opened", "file not found"]);
    desk.keys(&["Esc", "Alt-R"]);
    assert!(!preview(&desk).contains("file not found"), "back in the folder");
    desk.keys(&["deep", "Enter"]);
    assert_eq!(desk.app.tab.short_name(), "deep.toml", "typing also finds recent cases");
}

#[test]
fn names_that_no_terminal_should_see_are_shown_as_text_and_open() {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    let names: [&[u8]; 4] = [
        b"z1 \x1b[2J\x07.toml",
        "z2 \u{202e}lmot\u{200b}.toml".as_bytes(),
        b"z3 \xff\xfe.toml",
        b"z4\nline\tend.toml",
    ];
    for name in names {
        fs::write(desk.folder.path().join(OsStr::from_bytes(name)), TABLE_1)
            .expect("any bytes are a name");
    }
    fs::create_dir(desk.folder.path().join(OsStr::from_bytes(b"z5 \xff\x1b"))).expect("a folder");
    fs::write(desk.folder.path().join(OsStr::from_bytes(b"z5 \xff\x1b/in.toml")), TABLE_1)
        .expect("a case in it");
    for start in ["z1", "z2", "z3", "z4"] {
        desk.keys(&["Ctrl-O", start]);
        desk.assert_at(start, preview(&desk).contains("Corner contact 1.366 deg"));
        assert!(desk.screen().chars().all(|letter| letter == '\n' || is_safe(letter)), "{start}");
        desk.keys(&["Enter"]);
        assert!(desk.shows("opened "), "{start}\n{}", desk.screen());
        assert!(desk.screen().chars().all(|letter| letter == '\n' || is_safe(letter)), "{start}");
    }
    desk.keys(&["Ctrl-O", "z5", "Enter"]);
    assert_eq!(marked(&desk), "in.toml", "{}", desk.screen());
    desk.keys(&["Enter"]).assert_shows("opened ");
}

#[test]
fn a_file_that_is_no_case_is_refused_with_a_message() {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    let pipe = desk.path("p-pipe.toml");
    assert!(Command::new("mkfifo").arg(&pipe).status().is_ok_and(|status| status.success()));
    symlink("l-loop.toml", desk.path("l-loop.toml")).expect("a link");
    fs::write(desk.path("m-long.toml"), vec![b'x'; (1 << 20) + 1]).expect("room");
    fs::write(desk.path("n-zeroes.toml"), vec![0; 1 << 20]).expect("room");
    fs::write(desk.path("o-words.toml"), "no case at all\n".repeat(60_000)).expect("room");
    fs::write(desk.path("q-empty.toml"), "").expect("room");
    for (file, expected) in [
        ("p-pipe", "this is not a regular file"),
        ("l-loop", "cannot be read"),
        ("m-long", "longer than 1024 KiB"),
        ("n-zero", "1:1"),
        ("o-words", "1:"),
        ("q-empty", "format"),
    ] {
        desk.keys(&["Ctrl-O", file]);
        let said = preview(&desk);
        desk.assert_at(file, said.contains("It cannot be opened:") && said.contains(expected));
        desk.keys(&["Enter"]);
        desk.assert_at(file, desk.shows(" cannot be opened ") && desk.shows(expected));
        desk.keys(&["Esc", "Esc"]);
    }
    desk.keys(&["Ctrl-O", "nowhere/"]);
    desk.has(&["This folder cannot be read: No such", "file or directory"]);
    desk.keys(&["Ctrl-U", "case.toml/"]).assert_shows("This folder cannot be read: Not a");
}

#[test]
fn a_folder_of_ten_thousand_is_read_once_and_a_key_requests_at_most_one_preview() {
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    for number in 0..10_000 {
        fs::write(desk.path(&format!("{number:05}.toml")), "").expect("room");
    }
    desk.keys(&["Ctrl-O"]);
    assert!(desk.shows("00000.toml") || desk.shows("case.toml"));
    let mut asked = Vec::new();
    let keys = ["PageDown", "Down", "Down", "9", "9", "9", "Backspace", "Up"];
    for key in keys {
        asked.extend(desk.effects(key));
        desk.screen();
    }
    let count = |slot| {
        let is_it = |effect: &&Effect| matches!(effect, Effect::Work(_, work) if work.slot == slot);
        asked.iter().filter(is_it).count()
    };
    let (previews, searches) = (count(Slot::Preview), count(Slot::Search));
    assert!(previews <= keys.len() && searches == 1, "{asked:?}");
    assert_eq!(previews + searches, asked.len(), "{asked:?}");
    desk.assert_shows("99");
}

#[test]
fn keys_work_during_the_reading_of_a_folder_and_a_late_result_is_dropped() {
    let mut desk = desk_before_a_shelf(SMALL);
    let (number, work) = requested(desk.effects("Ctrl-O"), Slot::Folder).expect("a listing");
    let late = results(number, work);
    desk.assert_shows("reading ...");
    for letter in ["s", "u", "b", "/"] {
        desk.effects(letter);
    }
    desk.take(late);
    assert!(desk.shows("reading ...") && !desk.shows("a-strikes.toml"), "that was another folder");
    desk.effects("Esc");
    assert!(desk.app.prompts.is_empty());
}

#[test]
fn a_new_case_begins_with_an_example_and_has_no_file() {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    desk.keys(&["Alt-N"]);
    desk.has(&["New case from an example", "▸ zhou-chen-2014", "free impact 2191.0 N"]);
    let said = preview(desk.keys(&["Down"]));
    assert!(said.contains("FZG type C test gears") && said.contains("free impact 3718.8 N"));
    desk.keys(&["relief", "Enter"]);
    desk.has(&["2 new case from tip-reli", "No corner contact"]);
    let tab = &desk.app.tab;
    assert!(tab.path.is_none() && !tab.is_unsaved() && desk.app.tabs().count() == 2);
    desk.fill("operation.speed", "1234 rpm").keys(&["Ctrl-S"]).has(&["Save as", "case.toml"]);
    let path = desk.path("mine.toml");
    desk.keys(&["Ctrl-U", name(&path), "Enter"]);
    let saved = desk.read("mine.toml");
    assert!(saved.starts_with("# A pair whose tip relief is larger") && saved.contains("1234 rpm"));
}

#[test]
fn the_screens() {
    for (name, size) in [("80x24", SMALL), ("140x45", LARGE)] {
        let mut desk = desk_before_a_shelf(size);
        desk.recents = vec![desk.path("sub/deep.toml"), desk.path("sub/gone.toml")];
        for (screen, keys) in [
            ("browser", &["Ctrl-O", "b-exc"][..]),
            ("browser_of_a_bad_file", &["Ctrl-U", "d-bad"]),
            ("recents", &["Ctrl-U", "Alt-R"]),
            ("examples", &["Esc", "Alt-N", "Down", "Down"]),
        ] {
            desk.keys(keys);
            // The bad file and the recent cases use a large screen as the folder does.
            if size == SMALL || ["browser", "examples"].contains(&screen) {
                assert_snapshot!(format!("{screen}_{name}"), harness::without_folder(&desk));
            }
            harness::assert_ascii(&mut desk);
        }
    }
}

#[test]
fn typing_searches_the_folders_below_and_the_examples() {
    let mut desk = desk_before_a_shelf(LARGE);
    fs::create_dir_all(desk.path("sub/gearbox/stage 2")).expect("folders");
    fs::create_dir_all(desk.path(".hidden/x")).expect("folders");
    desk.write("sub/gearbox/stage 2/Pinion.toml", &TABLE_1.replace("2000 rpm", "777 rpm"));
    desk.write(".hidden/x/pinion.toml", TABLE_1);
    symlink(desk.folder.path(), desk.path("sub/round and round")).expect("a link");
    desk.keys(&["Ctrl-O", "pinion"]);
    assert_eq!(marked(&desk), "sub/gearbox/stage 2/Pinion.toml", "{}", desk.screen());
    desk.assert(preview(&desk).contains("777 rpm") && !desk.shows("hidden"));
    desk.keys(&["Enter"]);
    assert_eq!(desk.app.tab.path, Some(desk.path("sub/gearbox/stage 2/Pinion.toml")));
    desk.keys(&["Ctrl-O", "fzg"]);
    assert_eq!(marked(&desk), "fzg-type-c  (example)", "{}", desk.screen());
    desk.assert(preview(&desk).contains("FZG"));
    desk.keys(&["Enter"]);
    desk.assert(
        desk.app.prompts.is_empty() && desk.shows("new case from fzg-type-c; it has no file yet"),
    );
    desk.keys(&["Ctrl-O", "no such"]).assert_shows("No match here or below.");
}

#[test]
fn a_search_below_is_bounded_and_asked_once_for_a_folder() {
    let mut desk = desk_before_a_shelf(SMALL);
    let deep = "1/2/3/4/5/6/7/8";
    fs::create_dir_all(desk.path(deep)).expect("folders");
    desk.write("1/2/3/near.toml", TABLE_1);
    desk.write(&format!("{deep}/far.toml"), TABLE_1);
    let (root, wanted) = (desk.folder.path(), || true);
    let below = case_search::find(root, root, &wanted).expect("it is wanted");
    let names: Vec<&str> = below.iter().map(|case| case.name.as_str()).collect();
    assert_eq!(names, ["sub/deep.toml", "1/2/3/near.toml"]);
    assert_eq!(case_search::find(root, root, &|| false), None);
    assert_eq!(case_search::find(root, Path::new("/no/such/folder"), &wanted), Some(vec![]));
    desk.keys(&["Ctrl-O"]);
    let mut asked = Vec::new();
    for letter in "near".chars() {
        asked.extend(requested(update(&mut desk.app, Action::Insert(letter)), Slot::Search));
    }
    assert_eq!(asked.len(), 1);
    desk.assert_shows("Searching below ...");
    fs::remove_dir_all(desk.path("1")).expect("our own folder");
    let (number, work) = asked.remove(0);
    desk.take(results(number, work));
    desk.assert_shows("No match here or below.");
}

#[test]
fn enter_waits_for_the_listing_of_the_typed_folder() {
    let mut desk = desk_before_a_shelf(SMALL);
    desk.keys(&["Ctrl-O"]);
    let mut asked = Vec::new();
    for letter in "sub/deep".chars() {
        asked.extend(update(&mut desk.app, Action::Insert(letter)));
    }
    desk.effects("Enter");
    assert!(!desk.app.prompts.is_empty(), "it is not listed yet");
    let (number, work) = requested(asked, Slot::Folder).expect("a listing");
    desk.take(results(number, work));
    desk.assert(desk.app.prompts.is_empty() && desk.shows("sub/deep.toml"));
}
