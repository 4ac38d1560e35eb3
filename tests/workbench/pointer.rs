//! The mouse, if the setting is on: a click selects, a second click is Enter.
use crate::harness::{Desk, LARGE, SMALL, TABLE_1};

use ratatui::layout::{Position, Size};
use tipstrike::tui::testing::Action;

/// Clicks the first letter of a word.
fn press(desk: &mut Desk, word: &str) {
    let screen = desk.screen();
    let found = screen
        .lines()
        .enumerate()
        .find_map(|(y, line)| Some((y, line[..line.find(word)?].chars().count())));
    let (y, x) = found.unwrap_or_else(|| panic!("{word} is not on\n{screen}"));
    desk.act(Action::Click(Position::new(x as u16, y as u16)));
}

#[test]
fn a_click_on_the_name_of_a_hidden_pane_shows_it() {
    let (names, keys) = (["4 5 6", "5 Trade", "3 Chart"], ["4 5 6", "5 6", "3 4 6"]);
    for (size, words) in [(SMALL, names), (Size::new(64, 24), keys)] {
        let mut desk = Desk::new(size);
        for (name, title) in words.into_iter().zip(["▸ 4 Teeth", "▸ 5 ", "▸ 3 "]) {
            press(&mut desk, name);
            assert!(desk.shows(title), "{name}\n{}", desk.screen());
        }
        desk.keys(&["Ctrl-P"]);
        desk.act(Action::Click(Position::new(size.width - 5, 13)));
        assert!(desk.shows("Commands"), "a click beside a list changes nothing");
    }
}

#[test]
fn a_first_click_selects_a_line_of_a_list_and_a_second_accepts_it() {
    for size in [SMALL, LARGE] {
        let mut desk = Desk::on(size, "case.toml", TABLE_1);
        desk.keys(&["Ctrl-P", "m"]);
        press(&mut desk, "marker ");
        desk.assert_shows("▸ marker");
        press(&mut desk, "marker ");
        desk.assert_shows("chart in halfblock");
        desk.keys(&["Alt-G"]);
        press(&mut desk, "18CrNiMo7-6");
        press(&mut desk, "18CrNiMo7-6");
        desk.assert(desk.app.prompts.is_empty() && desk.shows("from 18CrNiMo7-6"));
        desk.write("other.toml", &TABLE_1.replace("2000 rpm", "900 rpm"));
        desk.recents = vec![desk.path("other.toml")];
        desk.keys(&["Ctrl-O"]);
        press(&mut desk, "other.toml  in");
        desk.assert_shows("▸ other.toml  in");
        press(&mut desk, "   other.toml ");
        desk.assert_shows("│ ▸ other.toml ");
        press(&mut desk, "▸ other.toml ");
        desk.assert_shows("opened ");
    }
}

#[test]
fn a_button_and_the_name_of_a_case_are_pressed() {
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    desk.keys(&["Ctrl-N", "7"]);
    press(&mut desk, "1 case.toml");
    desk.assert_shows("[1 case.toml]");
    press(&mut desk, "2 new case");
    desk.assert_shows("[2 new case*]");
    for (button, leaves) in [("Cancel", false), ("Discard", true)] {
        desk.keys(&["Ctrl-Q"]);
        press(&mut desk, button);
        assert!(desk.app.prompts.is_empty() && desk.has_quit == leaves, "{button}");
    }
    desk.keys(&["Ctrl-Q"]);
    desk.act(Action::Click(Position::new(1, 1)));
    assert!(desk.shows("[> Cancel <]"), "a press beside the buttons presses none");
}

#[test]
fn a_first_click_focuses_a_field_and_a_second_edits_it() {
    let mut desk = Desk::new(LARGE);
    press(&mut desk, "number of teeth");
    desk.assert(desk.shows("▸ z1") && !desk.app.has_line());
    press(&mut desk, "number of teeth");
    desk.type_in("25");
    desk.assert_shows("number of teeth      25");
    press(&mut desk, "impact duration");
    desk.assert_shows("▸T_S");
    press(&mut desk, "impact duration");
    desk.assert(desk.shows("impact duration, by the method, T_S") || !desk.app.prompts.is_empty());
}
