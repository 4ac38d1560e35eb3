//! Explanations of results: Enter shows the page of `tipstrike explain`, and its fields lead to the
//! form.
use crate::harness::{self, Desk, LARGE, SMALL, TABLE_1};

use std::process::Command;

use insta::assert_snapshot;
use tipstrike::case::{EXAMPLES, Example};
use tipstrike::tui::testing::ascii::written_out;
use tipstrike::tui::testing::{Action, Explanation, Look, MONO, Prompt, Slot};

fn in_box(screen: &str) -> Vec<String> {
    let lines = screen
        .lines()
        .filter(|line| line.ends_with(['█', '│']) || line.contains("│ ") || line.contains("█ "));
    let inside =
        |line: &str| Some(line.split_once("│ ")?.1.trim_end_matches(['│', '█', ' ']).to_owned());
    lines.filter_map(inside).collect()
}

/// The whole page, line by line.
fn read_through(desk: &mut Desk) -> Vec<String> {
    let mut screen = desk.screen();
    let mut page = in_box(&screen);
    loop {
        let before = std::mem::replace(&mut screen, desk.keys(&["Down"]).screen());
        if screen == before {
            return page;
        }
        page.extend(in_box(&screen).pop());
    }
}

fn of(desk: &Desk) -> &Explanation {
    match desk.app.prompts.last() {
        Some(Prompt::Explain(explanation)) => explanation,
        other => panic!("no explanation: {other:?}"),
    }
}

fn stdout_of(arguments: &[&str]) -> String {
    let output =
        Command::new(env!("CARGO_BIN_EXE_tipstrike")).args(arguments).output().expect("it runs");
    String::from_utf8(output.stdout).expect("text")
}

fn words(text: &str) -> Vec<&str> {
    text.split_whitespace().collect()
}

#[test]
fn the_page_of_every_result_is_that_of_the_command_and_can_be_read_through() {
    for (method, pages) in [("exact", 34), ("dynamic", 40)] {
        let case = TABLE_1.replace("\"exact\"", &format!("\"{method}\""));
        let mut desk = Desk::on(SMALL, "case.toml", &case);
        let path = desk.path("case.toml").display().to_string();
        let listed = desk.app.listed_results();
        let count = listed.len();
        assert!(count >= pages, "{method}: {count}");
        // Some rows: the text is the same, and each takes a dozen solves.
        for row in (0..count).step_by(if method == "dynamic" { 16 } else { 5 }) {
            desk.app.tab.results.selected = Some(listed[row].key);
            desk.keys(&["Esc", "2", "Enter"]);
            let key = of(&desk).quantity.key;
            let folder = desk.folder.path().display().to_string();
            let page = read_through(&mut desk).join("\n").replace("DIR", &folder);
            let command = stdout_of(&["explain", key, &path]);
            assert_eq!(words(&page), words(&command), "{key}");
            desk.keys(&["Esc"]);
        }
    }
}

#[test]
fn the_fields_behind_a_result_lead_to_the_form() {
    let mut desk = Desk::new(SMALL);
    desk.keys(&["Esc", "2", "Enter"]);
    let fields = of(&desk).fields();
    assert!(fields.len() > 20 && fields[0] == "pair.module");
    for (at, key) in fields.iter().enumerate() {
        desk.keys(&["Tab"]);
        assert!(desk.shows(&format!("▸{key}")), "{at} {key}\n{}", desk.screen());
    }
    desk.keys(&["Tab"]);
    assert_eq!(of(&desk).field(), Some("pair.module"), "round and round");
    desk.keys(&["BackTab", "BackTab"]);
    let wanted = of(&desk).field().expect("one is marked");
    desk.keys(&["Enter"]);
    assert!(desk.app.prompts.is_empty());
    assert_eq!(tipstrike::case::FIELDS[desk.app.tab.form.focus].key, wanted);
    // Without a selection Enter selects the first field.
    desk.keys(&["Esc", "2", "Enter", "Enter"]);
    assert_eq!(of(&desk).field(), Some("pair.module"));
}

#[test]
fn an_unfinished_page_is_marked_and_a_late_page_is_dropped() {
    let mut desk = Desk::new(SMALL);
    desk.keys(&["Esc", "2"]);
    let (number, work) =
        harness::requested(desk.effects("Enter"), Slot::Explanation).expect("work");
    assert!(desk.shows("computing: each field") && of(&desk).quantity.key == "impact_force");
    desk.keys(&["Esc", "j", "Enter"]);
    let before = desk.screen();
    desk.take(harness::results(number, work));
    assert_eq!(desk.screen(), before);
}

#[test]
fn a_refusal_and_an_invalid_value_are_explained_in_words() {
    let mut desk = Desk::new(SMALL);
    desk.fill("driven.addendum", "1.9").keys(&["Esc", "2", "Enter"]);
    desk.has(&["Not solved: ", "Correction: "]);
    desk.keys(&["Esc", "1"]).fill("driven.addendum", "x").keys(&["Esc", "2", "Enter"]);
    desk.assert_shows("these are the last valid results");
}

#[test]
fn every_letter_of_every_page_has_its_like_in_ascii() {
    // Each page of a pair in slices takes a hundred times as long.
    let is_spur = |example: &&Example| example.document().case.inputs().unwrap().helix_angle == 0.0;
    for (number, example) in EXAMPLES.iter().filter(is_spur).enumerate() {
        let mut desk = Desk::on(LARGE, "case.toml", example.text);
        desk.app.look = Look { theme: &MONO, ascii: true };
        // Each quantity in two cases or more.
        for quantity in desk.app.listed_results().into_iter().skip(number % 3).step_by(3) {
            desk.app.tab.results.selected = Some(quantity.key);
            desk.keys(&["Esc", "2", "Enter"]);
            let page = of(&desk).page.as_ref().expect("it is written").as_ref();
            let page = tipstrike::report::explain::render(page.expect("it is explained"), "case");
            let strange = page.lines().map(written_out).find(|line| !line.is_ascii());
            assert_eq!(strange, None, "{} of {}", of(&desk).quantity.key, example.name);
            desk.keys(&["Esc"]);
        }
    }
}

#[test]
fn it_scrolls_no_farther_than_its_end_at_any_size() {
    let mut desk = Desk::new(SMALL);
    desk.keys(&["Esc", "2", "Enter", "PageDown", "Tab"]);
    for (width, height) in [(0, 0), (1, 1), (60, 16), (61, 17), (80, 24), (200, 60), (300, 100)] {
        desk.act(Action::Resize(ratatui::layout::Size { width, height }));
        desk.keys(&["PageDown", "PageDown", "Down", "Tab", "PageUp"]);
        desk.screen();
    }
    desk.act(Action::Resize(SMALL));
    desk.keys(&["PageDown"; 40]);
    let end = desk.screen();
    desk.keys(&["Down"]);
    assert_eq!(desk.screen(), end);
}

#[test]
fn the_screens() {
    let mut desk = Desk::new(SMALL);
    desk.keys(&["Esc", "2", "Enter"]);
    assert_snapshot!("page_80x24", desk.screen());
    desk.keys(&["Tab", "Tab"]);
    desk.act(Action::Resize(LARGE));
    assert_snapshot!("fields_140x45", desk.screen());
    harness::assert_ascii(&mut desk);
}
