//! Dialogs and the lines around the panes: at 80x24, at 140x45 and in ASCII.
use crate::harness::{self, Desk, LARGE, SMALL, TABLE_1, without_folder};

use insta::assert_snapshot;
use ratatui::layout::Size;
use tipstrike::case::Change;
use tipstrike::tui::testing::{Access, Action, Claim, Next, Offer, SaveFault};

const HOLDER: &str = "process 4711 on drawing-office, since 12 min";

/// The actions that lead to a screen.
type Way = fn(&mut Desk);

const SCREENS: &[(&str, Way)] = &[
    ("materials", |desk| {
        desk.keys(&["Esc", "l", "Alt-G", "18cr"]);
    }),
    ("aim", |desk| {
        desk.keys(&["Esc", "a", "-0.6"]);
    }),
    ("limits_to_pick", |desk| {
        desk.keys(&["Alt-L", "dyn"]);
    }),
    ("limits", |desk| {
        desk.keys(&["Esc", "2", "Alt-L", "2000 N"]);
    }),
    ("inch_units", |desk| {
        desk.keys(&[":", "Backspace", "Esc", ":", "units", "Enter", "2"]);
    }),
    ("changed_on_disk", |desk| {
        desk.fill("operation.speed", "1500 rpm");
        desk.write(
            "case.toml",
            &TABLE_1.replace("2000 rpm", "2100 rpm").replace("\"5 mm\"", "\"6 mm\""),
        );
        desk.keys(&["Ctrl-S"]);
    }),
    ("exists", |desk| {
        let taken = desk.write("taken.toml", TABLE_1);
        desk.keys(&["F2", "Ctrl-U", harness::name(&taken), "Enter"]);
    }),
    ("save_as", |desk| {
        desk.keys(&["F2", "Home", "Ctrl-K", "~/mine.toml"]);
    }),
    ("read_only", |desk| {
        let claim = Claim::of(desk.app.tab.id, Access::Held(HOLDER.to_owned()));
        desk.act(Action::Claimed(Box::new(claim)));
        desk.fill("operation.speed", "1500 rpm");
    }),
    ("held", |desk| {
        let path = desk.path("case.toml");
        desk.act(Action::Saved(path, Next::Stay, Err(SaveFault::Held(HOLDER.to_owned()))));
    }),
    ("recovery", |desk| {
        let change = |key: &str, from: &str, to: &str| Change {
            key: key.to_owned(),
            from: Some(from.to_owned()),
            to: Some(to.to_owned()),
        };
        let changes = vec![
            change("operation.speed", "2000 rpm", "1500 rpm"),
            change("driven.tip_relief", "0 um", "48 um"),
        ];
        let offer = Offer {
            journal: desk.path("journal"),
            age: "3 min".to_owned(),
            changes,
            is_file_changed: true,
        };
        let claim = Claim::of(desk.app.tab.id, Access::Own);
        desk.act(Action::Claimed(Box::new(Claim { offers: vec![offer], ..claim })));
    }),
    ("quit", |desk| {
        desk.fill("operation.speed", "1500 rpm").keys(&["Ctrl-Q"]);
    }),
    ("help", |desk| {
        desk.keys(&["F1"]);
    }),
    ("notes", |desk| {
        desk.keys(&["Ctrl-T", "Esc", "2", "n"]);
    }),
    ("results_alone", |desk| {
        desk.keys(&["Ctrl-T", "Esc", "2", "z"]);
    }),
    ("refused", |desk| {
        desk.fill("driven.addendum", "1.9");
    }),
    ("in_place_of", |desk| {
        desk.app.tab.in_place_of = Some("gone.toml".into());
    }),
];

/// A list, a question and a page show how every dialog uses a large screen.
const AT_BOTH_SIZES: [&str; 3] = ["materials", "quit", "help"];

fn screen(way: Way, size: Size) -> String {
    let mut desk = Desk::on(size, "case.toml", TABLE_1);
    way(&mut desk);
    let screen = without_folder(&desk);
    harness::assert_ascii(&mut desk);
    screen
}

#[test]
fn the_screens() {
    for (name, way) in SCREENS {
        assert_snapshot!(format!("{name}_80x24"), screen(*way, SMALL));
        if AT_BOTH_SIZES.contains(name) {
            assert_snapshot!(format!("{name}_140x45"), screen(*way, LARGE));
        }
    }
}

#[test]
fn a_typed_name_replaces_the_suggested_one() {
    for (keys, file) in [
        (&["whine48"][..], "whine48.toml"),
        (&["Backspace", "whine48"], "whine48.toml"),
        (&["Right", "2"], "case2.toml"),
        (&["Left", "my-"], "my-case.toml"),
        (&["End", ".old"], "case.toml.old"),
        (&["pair.toml"], "pair.toml"),
        (&["pair.v2"], "pair.v2.toml"),
    ] {
        let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
        desk.keys(&["F2"]).keys(keys).keys(&["Enter"]);
        desk.assert_at(
            format!("{keys:?} {file}"),
            desk.path(file).is_file() && desk.shows("saved "),
        );
    }
}

#[test]
fn the_dialog_names_the_file_that_a_save_would_replace() {
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    desk.write("other.toml", &TABLE_1.replace("2000 rpm", "900 rpm"));
    desk.keys(&["F2", "other", "Enter"]);
    desk.assert_shows("speed: 900 rpm in the file, 2000 rpm in the form");
    desk.keys(&["Esc", "Ctrl-U", harness::name(&desk.path("case.toml")), "Enter"]);
    assert!(desk.shows("saved "), "its own file is not asked about: {}", desk.screen());
}

#[test]
fn a_line_for_the_reports_is_typed_and_undone() {
    let mut desk = Desk::new(LARGE);
    let project = ("drawing pinion".to_owned(), "GB 12".to_owned());
    desk.keys(&["Esc", ":", "about drawing pinion = GB 12", "Enter"]);
    assert!(desk.app.tab.case.about.contains(&project) && desk.app.tab.is_unsaved());
    desk.keys(&["u"]);
    assert!(!desk.app.tab.case.about.contains(&project));
    desk.keys(&[":", "about a b c", "Enter"]).assert_shows("type NAME = TEXT");
}
