//! A bare number typed into a field of the form gets the unit that the field shows.
use crate::harness::{Desk, LARGE, SMALL, TABLE_1};

use tipstrike::case::units::System;

#[test]
fn a_bare_number_gets_its_unit_during_typing() {
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    desk.fill("deviations.base_pitch", "48").has(&["Unit added: um.", "48 um"]);
    assert!(!desk.shows("LAST VALID") && !desk.shows("2191.0"), "the results are those of 48 um");
    assert_eq!(
        [desk.app.tab.form.input.value(), desk.text("deviations.base_pitch")],
        ["48", "48 um"]
    );
    desk.keys(&["Down"]).assert_shows("48 um").lacks(&["Unit added"]);
    desk.keys(&["Ctrl-S"]);
    assert_eq!(desk.read("case.toml"), TABLE_1.replace("16 um", "48 um"));
    desk.keys(&["Up", "Esc"]);
    assert_eq!(desk.app.tab.form.input.value(), "48 um", "a line that is left is the case's");
}

#[test]
fn on_the_way_to_a_value_no_error_flickers() {
    for (key, whole) in [
        ("deviations.base_pitch", "48 um"),
        ("operation.power", "20 hp"),
        ("operation.speed", "209.44 rad/s"),
        ("pair.pressure_angle", "22.5 deg"),
        ("pair.module", "0.2 in"),
        ("driver.face_width", "8000 um"),
        ("driver.teeth", "24"),
        ("driver.profile_shift", "-0.05"),
        ("driver.density", "7.85 g/cm3"),
        ("limits.impact_force", "2.5 kN"),
    ] {
        let mut desk = Desk::new(SMALL);
        match key.strip_prefix("limits.") {
            None => drop(desk.fill(key, "")),
            Some(_) => drop(desk.keys(&["Ctrl-End", "Ctrl-U"])),
        }
        for letter in whole.chars() {
            desk.keys(&[&letter.to_string()]);
            let typed = desk.app.tab.form.input.value().to_owned();
            let screen = desk.screen();
            assert!(!screen.lines().any(|line| line.starts_with("  ! ")), "{typed}:\n{screen}");
        }
        assert!(!desk.shows("Not yet:") && !desk.shows("LAST VALID"), "{key}:\n{}", desk.screen());
    }
}

#[test]
fn the_unit_is_the_written_one_or_else_the_displayed_one() {
    let mut desk = Desk::on(LARGE, "case.toml", &TABLE_1.replace("15 kW", "20 hp"));
    desk.fill("operation.power", "25");
    assert_eq!(desk.text("operation.power"), "25 hp");
    desk.keys(&["Backspace", "Backspace", "3"]).fill("driver.tip_radius", "0.2");
    assert_eq!(desk.text("operation.power"), "3 hp");
    assert_eq!(desk.text("driver.tip_radius"), "0.2 mm");
    desk.app.settings.units = System::Inch;
    desk.fill("driven.tip_radius", "0.02").assert_shows("Unit added: in.");
    assert_eq!(desk.text("driven.tip_radius"), "0.02 in");
    desk.fill("driver.young", "").assert_shows("(206 GPa)");
    desk.keys(&["4"]);
    assert_eq!(desk.text("driver.young"), "4 GPa", "it was written in GPa");
}

#[test]
fn a_typed_unit_is_never_replaced() {
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    desk.fill("deviations.base_pitch", "48 m").assert_shows("Not yet: 48 m is above the limit of");
    assert_eq!(desk.text("deviations.base_pitch"), "48 m");
    // After the user leaves the field the value is invalid.
    desk.keys(&["Down"]).assert_shows("! 48 m is above the limit of");
    desk.keys(&["Ctrl-S"]).assert_shows("not saved");
    desk.fill("driver.young", "200 M");
    assert_eq!(desk.text("driver.young"), "200 M", "MPa or Mpsi");
    desk.assert_shows("Not yet: unknown unit M");
    desk.fill("driver.poisson", "0.9");
    desk.assert_at("no digit fixes it:", desk.shows("! 0.9 is above the limit of 0.499"));
}

#[test]
fn an_equal_text_is_not_an_edit() {
    let mut desk = Desk::new(SMALL);
    desk.go_to("deviations.base_pitch").keys(&["End", "Backspace", "Backspace", "Backspace"]);
    assert_eq!(desk.app.tab.form.input.value(), "16");
    assert!(!desk.app.tab.is_unsaved());
    desk.keys(&["Ctrl-Z"]).assert_shows("nothing to undo");
}

#[test]
fn steps_copies_and_limits_know_the_unit_of_a_bare_number() {
    let mut desk = Desk::new(SMALL);
    desk.fill("deviations.base_pitch", "48").keys(&["Shift-Up"]);
    assert_eq!(desk.app.tab.form.input.value(), "49 um");
    assert_eq!(desk.text("deviations.base_pitch"), "49 um");
    desk.keys(&["Ctrl-U", "50", "Esc", "y", "Ctrl-End", "i", "Ctrl-U", "2200"]);
    assert_eq!(desk.copied.as_deref(), Some("50 um"));
    assert_eq!(desk.app.tab.case.limits[0].text, "2200 N");
}
