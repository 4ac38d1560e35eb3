//! The mouse, where the user wants it: a press on the name of a pane out of sight brings the pane.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, reason = "a test that cannot go on says why")]
#![cfg(feature = "tui")]

mod desk;

use desk::{Desk, SMALL};
use ratatui::layout::{Position, Size};
use tipstrike::tui::actions::Action;

/// Press the first letter of a word.
fn press(desk: &mut Desk, word: &str) {
    let screen = desk.screen();
    let found = screen.lines().enumerate().find_map(|(y, line)| Some((y, line[..line.find(word)?].chars().count())));
    let (y, x) = found.unwrap_or_else(|| panic!("{word} is not on\n{screen}"));
    desk.act(Action::Click(Position::new(x as u16, y as u16)));
}

#[test]
fn the_name_of_a_pane_out_of_sight_brings_it() {
    for size in [SMALL, Size::new(60, 24)] {
        let mut desk = Desk::new(size);
        for (name, title) in [("4 Teeth", "▸ 4 Teeth"), ("5 Trade", "▸ 5 "), ("3 Chart", "▸ 3 ")] {
            press(&mut desk, name);
            assert!(desk.shows(title), "{name}\n{}", desk.screen());
        }
        desk.keys(&["Ctrl-P"]);
        desk.act(Action::Click(Position::new(size.width - 5, 13)));
        assert!(desk.shows("Commands"), "a press beside a list changes nothing");
    }
}
