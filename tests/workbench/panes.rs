//! Keys in, screen out: the content of results, chart and teeth during the work on a case.
use crate::harness::{Desk, LARGE, SMALL, TABLE_1};

use ratatui::layout::Size;
use tipstrike::model::Quantity;
use tipstrike::model::quantities::Need;
use tipstrike::tui::testing::Answer;

const TINY: Size = Size { width: 60, height: 16 };

#[test]
fn last_valid_results_show_their_reason_and_the_key_that_goes_there() {
    for size in [TINY, SMALL, LARGE] {
        let mut desk = Desk::new(size);
        desk.fill("pair.module", "2 mm").keys(&["Down", "Down"]);
        desk.has(&["! rh1 bore radius", "1 more", "Alt-E"]);
        desk.keys(&["Alt-E"]).assert_shows("rh1 driver bore radius, ");
        assert_eq!(desk.app.tab.case.text(desk.app.tab.form.focus), Some("20 mm"));
        desk.keys(&["Alt-E"]).assert_shows("rh2 driven bore radius, ");
        desk.fill("pair.module", "5 mm").keys(&["Alt-E"]);
        desk.assert_shows("no field has an error").lacks(&["! rh"]);
    }
}

#[test]
fn the_mark_in_the_results_stays_with_its_quantity() {
    let mut desk = Desk::new(SMALL);
    let marked = |desk: &Desk| desk.app.marked_result().map(|quantity| quantity.key);
    desk.keys(&["Esc", "2", "j", "j", "j", "j", "j", "j", "j"]);
    assert_eq!(marked(&desk), Some("base_pitch"));
    let is_in_sight = |desk: &Desk| desk.shows("▸p_b ");
    desk.keys(&["j", "k", "Ctrl-T"]);
    desk.assert(marked(&desk) == Some("base_pitch") && is_in_sight(&desk));
    desk.keys(&["Ctrl-T", "Ctrl-T", "Ctrl-T", "Ctrl-T"]);
    desk.assert(marked(&desk) == Some("base_pitch") && is_in_sight(&desk));
    // A removed quantity is selected again when it returns.
    desk.keys(&["Ctrl-T"]).fill("operation.friction_coefficient", "0.1");
    let listed = desk.app.listed_results();
    let needs_friction = |known: &&&Quantity| known.needs == Need::Friction;
    let of_friction = listed.iter().find(needs_friction).map(|known| known.key);
    desk.app.tab.results.selected = of_friction;
    assert!(of_friction.is_some() && marked(&desk) == of_friction);
    desk.fill("operation.friction_coefficient", "");
    assert!(marked(&desk) == Some("static_force_at_start") && desk.app.tab.results.top == 0);
    desk.fill("operation.friction_coefficient", "0.1");
    assert_eq!(marked(&desk), of_friction);
}

#[test]
fn the_baseline_is_drawn_by_the_method_in_force() {
    let mut desk = Desk::new(LARGE);
    desk.keys(&["Alt-B"])
        .fill("operation.speed", "1900 rpm")
        .keys(&["Ctrl-T", "Ctrl-T", "Ctrl-T", "Ctrl-T", "Esc", "3", "Home"]);
    let shown = desk.line_with("before E: F_S");
    assert!(shown.contains("F_S 80.39") && shown.contains("baseline 84.6"), "{shown}");
    desk.keys(&["Ctrl-T", "Ctrl-T", "3", "Home"]).assert_shows("baseline (exact)");
}

#[test]
fn the_free_impact_and_the_other_methods_are_folded_until_f_shows_them() {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    desk.keys(&["Esc", "2", "z"]).assert_shows("other methods (f)").lacks(&["paper"]);
    desk.keys(&["f"]).has(&[" paper ", "▸exact"]).lacks(&["(f)"]);
    desk.keys(&["f", "Ctrl-T", "G"]);
    let folded = desk.app.listed_results().len();
    desk.assert_shows("free impact (f)").lacks(&[" free: "]);
    desk.keys(&["f", "G"]).has(&[" free: ", "▸static"]);
    assert!(desk.app.listed_results().len() > folded);
    // A search for a folded result shows it.
    desk.keys(&["f", "/", "impact_duration", "Enter"]).assert_shows(" free: ");
}

#[test]
fn rounding_errors_of_zero_are_zero_in_the_teeth() {
    let mut desk = Desk::new(LARGE);
    for _ in 0..3 {
        desk.keys(&["Esc", "4", "End"]).has(&["S 0 um", "ΔV_n 0 m/s"]).lacks(&["e-1"]);
        desk.keys(&["Ctrl-T"]);
    }
}

#[test]
fn an_axis_fits_the_visible_part_of_its_curves() {
    let mut desk = Desk::new(LARGE);
    desk.keys(&["Ctrl-T", "Esc", ":", "sliding velocity", "Enter", "3", "0"]);
    let axis = |desk: &Desk| desk.app.charts().upright(desk.app.chart.graph());
    assert!(axis(&desk).from < 0.0 && axis(&desk).to > 0.0, "{:?}", axis(&desk));
    desk.keys(&["v"]);
    assert!(axis(&desk).from >= 0.0, "the strike has one sign: {:?}", axis(&desk));
    desk.keys(&["v"]);
    assert!(axis(&desk).from < 0.0, "{:?}", axis(&desk));
}

#[test]
fn a_limit_that_is_not_met_is_in_the_verdict_and_every_limit_is_on_the_page() {
    let strict = TABLE_1.replace("\"2500 N\"", "\"1 kN\"");
    for size in [TINY, SMALL, LARGE] {
        let mut desk = Desk::on(size, "case.toml", &strict);
        desk.assert_shows("! Limit EXCEEDED:");
        desk.keys(&["Esc", "n"]).assert_shows("Limit EXCEEDED: impact force F_S");
        let desk = Desk::on(size, "case.toml", TABLE_1);
        desk.lacks(&[" > 2500 N"]);
    }
    // The limit of the free impact is met, and the impact of the method exceeds it.
    let free = include_str!("../../cases/hydro-speed-up.toml");
    let dynamic = free.replace("method = \"exact\"", "method = \"dynamic\"");
    let mut desk = Desk::on(SMALL, "case.toml", &dynamic);
    desk.assert_shows("! Limit EXCEEDED: F_d,DE.");
    let of_velocity = "Limit ok: approach velocity at D";
    desk.keys(&["Esc", "n"]).has(&["! Limit ok: impact force F_S", of_velocity]);
}

#[test]
fn the_page_of_a_refused_case_begins_with_the_reason_and_alt_e_goes_to_the_field() {
    let mut desk = Desk::new(SMALL);
    desk.fill("pair.centre_distance", "5 mm").keys(&["Down"]).assert_shows("!*a ");
    desk.keys(&["Alt-E"]).assert_shows("a centre distance, ");
    // Of a size and its alternative, the one that the case gives.
    desk.fill("pair.centre_distance", "").fill("driven.tip_diameter", "119.9 mm");
    desk.keys(&["Down", "Alt-E"]);
    assert_eq!(desk.text("driven.tip_diameter"), "119.9 mm");
    assert_eq!(desk.app.tab.case.text(desk.app.tab.form.focus), Some("119.9 mm"));
    desk.fill("driven.tip_diameter", "").fill("pair.centre_distance", "5 mm");
    desk.keys(&["Esc", "n"]);
    desk.has(&[
        "│ ! Not solved: the centre distance jams the mesh",
        "│ LAST VALID: Corner contact",
    ]);
}

#[test]
fn the_page_of_the_outcome_follows_later_results() {
    let mut desk = Desk::new(LARGE);
    desk.keys(&["Esc", "n"]).assert_shows("│ Note: ");
    let answer = desk.app.tab.answer.clone().expect("an answer");
    desk.show(Answer { notes: Vec::new(), ..answer });
    desk.assert_shows("│ Corner contact").lacks(&["│ Note: "]);
}
