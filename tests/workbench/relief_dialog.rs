//! The search for the tip relief to specify, in the workbench.
use crate::harness::{Desk, LARGE, SMALL, TABLE_1, requested, results};

use tipstrike::tui::testing::Slot;

#[test]
fn the_relief_to_specify_is_written_into_the_case_as_one_edit() {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    desk.keys(&["Esc", ":", "relief", "Enter"]);
    insta::assert_snapshot!("relief_140x45", desk.screen());
    desk.keys(&["Enter"]).assert_shows("Ctrl-Z undoes");
    let amounts = ["driver.tip_relief", "driven.tip_relief"].map(|key| desk.text(key));
    desk.assert(amounts.iter().all(|amount| *amount != "0 um" && amount.ends_with(" um")));
    assert!(desk.text("driven.tip_relief_length").ends_with(" mm"));
    let spread = desk.app.tab.case.spread.iter().map(|own| own.text.as_str());
    assert!(spread.eq(["uniform 5 um", "uniform 0.1 mm", "uniform 5 um", "uniform 0.1 mm"]));
    desk.keys(&["Ctrl-Z"]);
    assert!(!desk.app.tab.is_unsaved(), "one edit");
}

#[test]
fn a_typed_demand_starts_a_search_and_an_invalid_one_gets_a_reason() {
    let relief = TABLE_1.replace("tip_relief = \"0 um\"", "tip_relief = \"20 um\"");
    let spread = "\n[spread]\n\"driven.tip_relief\" = { uniform = \"4 um\" }\n";
    let mut desk = Desk::on(LARGE, "case.toml", &(relief + spread));
    desk.keys(&["Esc", ":", "relief", "Enter"]).assert_shows("25..110 %, 4 um, te");
    desk.keys(&["Ctrl-U", "110..25 %", "Enter"]);
    desk.assert_shows("! 110..25 %: the range is reversed: write a range");
    desk.keys(&["Ctrl-U", "50..100 %, 2 um"]).assert_shows("Results of the earlier input");
    desk.keys(&["Ctrl-Q"]).assert_shows("has not used its text: 50..100 %, 2 um");
    desk.keys(&["Esc", "Enter"]).has(&["for 50 to 100 %", "tolerances 2 um"]);
    desk.keys(&["PageDown", "Down", "Esc"]);
    desk.assert(!desk.app.tab.is_unsaved() && desk.app.prompts.is_empty());
    desk.keys(&[":", "relief", "Enter"]).has(&["50..100 %, 2 um", "for 50 to 100 %"]);
}

#[test]
fn a_search_shows_its_progress() {
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    desk.keys(&["Esc", ":", "relief"]);
    let (number, work) = requested(desk.effects("Enter"), Slot::Relief).expect("a search");
    desk.assert_shows("Searching: 0 %. Esc ends the search.");
    let mut sent = results(number, work);
    // Without the relief and the end of the work.
    sent.truncate(sent.len() - 2);
    desk.keys(&["F1"]).assert_shows("In the tip relief");
    desk.take(sent);
    desk.keys(&["Esc"]).has(&["Searching: "]).lacks(&["Searching: 0 %"]);
}

#[test]
fn any_relief_of_the_list_is_written_into_the_case() {
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    desk.keys(&["Esc", ":", "relief", "Enter"]);
    desk.keys(&["Up"; 9]).keys(&["Down", "Enter"]);
    assert_eq!(desk.text("model.relief_shape"), "linear");
    desk.keys(&["Ctrl-Z", "Esc", ":", "units", "Enter", ":", "relief", "Enter"]);
    desk.has(&["error) in thou, La in inches", "lbf ft"]).lacks(&[" mm", " N ", "…"]);
    desk.keys(&["Up"; 9]).keys(&["Down", "Down", "Enter"]);
    assert_eq!(desk.text("model.relief_shape"), "parabolic");
    desk.assert(desk.text("driven.tip_relief_length").ends_with(" mm"));
}

#[test]
fn on_a_narrow_screen_sentences_are_wrapped_and_the_last_row_is_reached() {
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    desk.keys(&["Esc", ":", "relief", "Enter"]);
    insta::assert_snapshot!("relief_80x24", desk.screen());
    desk.keys(&["PageDown"; 20]);
    let end = desk.screen();
    assert_eq!(desk.keys(&["PageDown"]).screen(), end, "the end stays");
    assert!(end.contains("length 8.20 mm"), "{end}");
}
