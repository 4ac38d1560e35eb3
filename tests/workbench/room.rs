//! Room on the screen: titles, panes alone, rows on a small screen, aligned columns.
use crate::harness::{Desk, LARGE, SMALL, TABLE_1};

use ratatui::layout::Size;

const HYDRO: &str = include_str!("../../cases/hydro-speed-up.toml");
const TINY: Size = Size { width: 60, height: 16 };
const SPREAD: &str = "\n[spread]\n\"deviations.base_pitch\" = { normal = \"2 um\" }\n";

/// The example with another method.
fn hydro(size: Size, method: &str) -> Desk {
    let text = HYDRO.replace("method = \"exact\"", &format!("method = \"{method}\""));
    Desk::on(size, "case.toml", &text)
}

#[test]
fn a_pane_alone_leaves_no_other_in_sight() {
    for size in [TINY, SMALL, LARGE] {
        let mut desk = Desk::on(size, "case.toml", TABLE_1);
        desk.keys(&["Esc", "2", "z"]).assert_shows("Corner contact ");
        desk.lacks(&["title Zhou"]);
        desk.keys(&["1"]).assert_shows("title Zhou");
        desk.lacks(&["Corner contact "]);
        desk.keys(&["z"]).has(&["title Zhou", "orner contact "]);
    }
}

#[test]
fn a_small_screen_shows_twelve_quantities_and_counts_the_hidden_lines() {
    for method in ["paper", "exact", "static", "dynamic"] {
        let text = TABLE_1.replace("method = \"exact\"", &format!("method = \"{method}\""));
        let desk = Desk::on(SMALL, "case.toml", &text);
        let rows = desk.app.results().page();
        assert!(rows >= 12, "{method}: {rows}\n{}", desk.screen());
        for size in [TINY, SMALL] {
            let desk = hydro(size, method);
            let rows = desk.app.results().page();
            assert!(rows >= 4, "{size} {method}: {rows}\n{}", desk.screen());
        }
    }
    let mut desk = hydro(SMALL, "static");
    desk.assert_shows("notes (Esc n)");
    desk.keys(&["Esc", "n"]).assert_shows("tip relief on the");
}

#[test]
fn the_tolerance_shows_its_figures_first_and_how_to_scroll() {
    let mut desk = Desk::on(SMALL, "case.toml", &format!("{TABLE_1}{SPREAD}"));
    desk.keys(&["Esc", "6", "d"]).assert_shows("Tolerance 1 to ");
    desk.assert_shows("corner contact         100.00 %");
    desk.assert_shows("j scroll  l next page");
    desk.lacks(&["narrower"]);
    desk.keys(&["PageDown", "PageDown"]).assert_shows(" | █");
    desk.assert_shows("Tolerance 13 to ");
    desk.keys(&["h", "h"]).assert_shows("Tolerance 1 to ");
    desk.keys(&["l"; 20]);
    let spread = "deviations.base_pitch  16 um";
    desk.assert_shows(spread);
}

#[test]
fn with_inch_units_a_study_is_in_inches() {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    desk.go_to("pair.module");
    desk.keys(&["Esc", "6", ":", "units", "Enter"]).assert_shows("over module in in");
    desk.assert_shows("m = 0.19685 in:");
    desk.keys(&["l", "Enter"]);
    let text = desk.app.tab.case.text(tipstrike::case::fields::index_of("pair.module").unwrap());
    assert!(text.is_some_and(|text| text.ends_with(" in")), "{text:?}");
}

#[test]
fn the_values_under_the_teeth_keep_their_places_while_the_cursor_moves() {
    let mut desk = hydro(SMALL, "dynamic");
    desk.keys(&["Esc", "4", "z", "Home"]);
    let place = |desk: &Desk| {
        let screen = desk.screen();
        let found = |name: &str| {
            let mut lines = screen.lines().enumerate();
            lines.find_map(|(row, line)| Some((row, line.find(name)?)))
        };
        [" ΔV_n ", " ΔV_τ ", " open "].map(found)
    };
    let first = place(&desk);
    desk.assert(first.iter().all(Option::is_some));
    for _ in 0..25 {
        desk.keys(&["l"]);
        let rows = place(&desk).map(|place| place.map(|(row, _)| row));
        let before = first.map(|place| place.map(|(row, _)| row));
        assert_eq!(rows, before, "{}", desk.screen());
    }
}

#[test]
fn the_values_of_a_chart_at_the_cursor_have_one_unit() {
    let mut desk = hydro(LARGE, "dynamic");
    desk.keys(&["Esc", "3", "Home"]);
    for _ in 0..20 {
        desk.keys(&["l"]);
        let screen = desk.screen();
        let line = screen.lines().rfind(|line| line.contains(" before E: "));
        let (_, values) = line.and_then(|line| line.split_once(": ")).expect("a readout");
        let forces = values.split(';').next().unwrap_or_default();
        let units: Vec<bool> = forces.split(", ").map(|value| value.ends_with(" kN")).collect();
        assert!(units.len() > 1, "{screen}");
        assert!(units.iter().all(|unit| *unit == units[0]), "{line:?}");
    }
}
