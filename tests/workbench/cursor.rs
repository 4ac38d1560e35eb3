//! The prompt that moves the cursor of charts and teeth to an angle, a time or a point.
use crate::harness::{Desk, LARGE, SMALL, TABLE_1};

use tipstrike::tui::testing::Prompt;

fn at(desk: &mut Desk, typed: &str) -> f64 {
    desk.keys(&["a", "Ctrl-U", typed, "Enter"]);
    assert!(desk.app.prompts.is_empty(), "{typed}\n{}", desk.screen());
    desk.app.cursor.expect("a cursor")
}

#[test]
fn an_angle_in_any_unit_and_a_time_mean_the_same_place() {
    let mut desk = Desk::new(LARGE);
    desk.keys(&["Esc"]);
    let same = "-0.6 deg,-0.6,-10.471975511965976 mrad,-0.010471975511965976 rad,-50 us,-0.05 ms";
    for typed in same.split(',') {
        let angle = at(&mut desk, typed).to_degrees();
        assert!((angle - 0.6).abs() < 1e-9, "{typed}: {angle}");
        desk.assert_at(typed, desk.shows("cursor: 0.6000 deg of the driver before E: F_S "));
    }
    desk.keys(&["3", "t"]);
    assert!(
        (at(&mut desk, "-50").to_degrees() - 0.6).abs() < 1e-9,
        "a bare number is in the unit of the axis"
    );
}

#[test]
fn points_have_names() {
    let case = TABLE_1.replace("\"exact\"", "\"dynamic\"");
    let mut desk = Desk::on(LARGE, "case.toml", &case);
    desk.keys(&["Esc"]);
    let [d, e, b, l, peak] = ["d", "E", "b", "L", "Peak"].map(|name| at(&mut desk, name));
    assert!(d > peak && peak > b && e == 0.0 && l < 0.0, "{d} {e} {b} {l} {peak}");
    desk.keys(&["3", "End", "Home"]);
    assert_eq!(desk.app.cursor, Some(d), "Home moves the cursor to D");
    let screen = desk.screen();
    at(&mut desk, "peak");
    assert_ne!(screen, desk.screen());
}

#[test]
fn a_wrong_text_shows_the_reason_and_stays() {
    let mut desk = Desk::new(SMALL);
    for (typed, said) in [
        ("-30 deg", "30 deg (2500 us) before E is out of range: from"),
        ("there", "there is not an angle, time or point"),
        ("5 mm", "5 mm is not an angle, time or point"),
        ("1 m", "1 m is not an angle, time or point"),
        ("L", "only static and dynamic compute the last contact L"),
    ] {
        desk.keys(&["Esc", "Esc", "a", typed, "Enter"]);
        assert!(desk.shows(said), "{typed}\n{}", desk.screen());
        assert!(matches!(desk.app.prompts[..], [Prompt::Path(_)]) && desk.app.cursor.is_none());
    }
    let mut desk = Desk::on(SMALL, "case.toml", include_str!("../../cases/tip-relief-enough.toml"));
    desk.keys(&["Esc", "a", "D", "Enter"]).assert_shows("no corner contact, so no D");
}

#[test]
fn the_chart_opens_if_no_pane_shows_the_cursor() {
    let mut desk = Desk::new(SMALL);
    desk.keys(&["Esc", "5", "a", "-0.6", "Enter"]).assert_shows("▸ 3 Force");
    desk.keys(&["4", "1", "a", "-0.6", "Enter"]).has(&["▸ 1 Form", "─ 4 "]);
}
