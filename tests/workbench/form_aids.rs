//! Aids of the form: steps, conversions, materials, limits, inch units, fields without effect.
use crate::harness;

use harness::{Desk, LARGE, SMALL, TABLE_1};
use tipstrike::case::fields::index_of;

/// A line of the screen with this text.
fn line(desk: &Desk, text: &str) -> String {
    let screen = desk.screen();
    screen
        .lines()
        .find(|line| line.contains(text))
        .unwrap_or_else(|| panic!("{text} is not on\n{screen}"))
        .to_owned()
}

#[test]
fn a_value_steps_inside_a_field_and_outside() {
    let mut desk = Desk::new(SMALL);
    desk.go_to("deviations.base_pitch");
    desk.keys(&["Shift-Up"]);
    assert_eq!(desk.text("deviations.base_pitch"), "17 um");
    desk.keys(&["Alt-Down"]);
    assert_eq!(desk.text("deviations.base_pitch"), "7 um");
    desk.keys(&["Esc", "+", "=", "-", ">", "<"]);
    assert_eq!(
        desk.text("deviations.base_pitch"),
        "7 um",
        "a letter that is typed unseen changes no value"
    );
    desk.assert_shows("< is not a command in Form");
    desk.keys(&["Alt-Up", "Shift-Down"]);
    assert_eq!(desk.text("deviations.base_pitch"), "16 um");
    desk.keys(&["Shift-Up"]);
    assert_eq!(desk.text("deviations.base_pitch"), "17 um");
    desk.keys(&["u"]);
    assert_ne!(desk.text("deviations.base_pitch"), "17 um");
}

#[test]
fn the_form_shows_the_given_size_and_the_value_of_its_alternative() {
    let mut desk = Desk::new(LARGE);
    assert!(line(&desk, "diametral pitch").contains("(5.08 1/in)"));
    assert!(line(&desk, "tip diameter").contains("(110 mm)"));
    assert!(line(&desk, "root diameter").contains("(87.5 mm)"));
    desk.go_to("driver.tip_diameter").type_in("109");
    assert_eq!(desk.text("driver.tip_diameter"), "109 mm");
    assert_eq!(desk.text("driver.addendum"), "");
    desk.assert(line(&desk, "addendum").contains("(0.9)"));
    assert!(desk.shows("addendum 1.0 replaced by the tip diameter"));
    desk.go_to("pair.diametral_pitch").type_in("8");
    assert_eq!(desk.text("pair.diametral_pitch"), "8 1/in");
    desk.assert(line(&desk, "module").contains("(3.175 mm)"));
    desk.keys(&["Ctrl-U"]);
    assert_eq!(desk.text("pair.module"), "5 mm");
}

#[test]
fn an_impossible_step_is_reported_and_changes_nothing() {
    let mut desk = Desk::new(SMALL);
    desk.go_to("model.deflection").keys(&["Ctrl-U"]);
    desk.keys(&["Shift-Up"]);
    assert!(desk.shows("combined deflection has no step here"));
    desk.go_to("title");
    desk.keys(&["Shift-Down"]);
    assert_eq!(desk.text("title"), "Zhou & Chen 2014, Table 1");
}

#[test]
fn a_value_in_another_unit_is_shown_in_the_usual_unit() {
    let mut desk = Desk::new(SMALL);
    desk.fill("operation.power", "20 hp");
    desk.assert_shows("= 14.914 kW.");
    desk.go_to("operation.speed");
    assert!(desk.shows("= 209.44 rad/s."));
}

#[test]
fn fields_that_the_method_does_not_use_are_marked_with_a_reason() {
    let mut desk = Desk::new(SMALL);
    desk.go_to("driver.root_relief");
    let idle = line(&desk, "Ca1");
    assert!(idle.starts_with("- Ca1"), "{idle}");
    desk.go_to("driver.tip_relief");
    assert!(desk.shows("Not used: this relief acts at the exit"));
}

#[test]
fn a_material_fills_three_fields_at_once_and_undo_reverts_it() {
    let mut desk = Desk::new(LARGE);
    desk.go_to("driven.teeth").keys(&["Alt-G"]);
    assert!(desk.shows("Material of the driven gear"));
    desk.keys(&["42cr", "Enter"]);
    desk.assert_shows("driven: E 210 GPa, ν 0.3, ρ 7720 kg/m3 from 42CrMo4");
    assert_eq!((desk.text("driven.young"), desk.text("driven.density")), ("210 GPa", "7720 kg/m3"));
    assert_eq!(desk.text("driver.young"), "205 GPa");
    desk.assert_shows("Driven (gear 2), 42CrMo4");
    desk.go_to("driven.density");
    desk.assert(
        line(&desk, " *E2 ").contains("210 GPa") && line(&desk, "▸*ρ2 ").contains("7720 kg/m3"),
    );
    desk.assert_at("unchanged values have no mark:", line(&desk, "  ν2 ").contains("0.3"));
    desk.go_to("driven.young");
    desk.assert_shows("42CrMo4: Deutsche Edelstahlwerke");
    desk.keys(&["Ctrl-Z"]);
    assert!(!desk.app.tab.is_unsaved());
    desk.assert(!desk.shows(" *E2 "));
    desk.go_to("pair.module").keys(&["Alt-G", "PEEK", "Enter"]);
    desk.assert_shows("both gears: E 4 GPa");
    assert_eq!((desk.text("driver.young"), desk.text("driven.young")), ("4 GPa", "4 GPa"));
}

#[test]
fn limits_are_a_group_of_the_form_with_their_verdicts() {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    desk.keys(&["Ctrl-End"]);
    assert!(line(&desk, "impact force         2500 N").contains("ok 88 %"));
    desk.keys(&["Ctrl-U", "2 kN"]);
    desk.assert(line(&desk, "force         2 kN").contains("! 110 %"));
    assert!(desk.shows("2191.0 N !"), "the result is marked too");
    desk.keys(&["Shift-Up"]);
    desk.keys(&["Ctrl-S"]);
    assert_eq!(desk.read("case.toml"), TABLE_1.replace("2500 N", "3 kN"));
}

#[test]
fn a_new_limit_starts_at_the_result_and_an_empty_one_is_removed() {
    let mut desk = Desk::new(LARGE);
    desk.keys(&["Alt-L", "normal_vel", "Enter"]);
    desk.assert(line(&desk, "ok 100 %").contains("0.82107 m/s"));
    desk.keys(&["Ctrl-U"]);
    assert!(desk.shows("(no limit)"));
    desk.keys(&["0.8"]);
    desk.assert(desk.shows("Unit added: m/s.") && desk.shows("0.8 m/s"));
    desk.keys(&[" m/s", "Ctrl-U", "Up"]);
    desk.assert(!desk.shows("(no limit)") && !desk.app.tab.is_unsaved());
}

#[test]
fn a_distribution_of_a_field_is_a_row_that_the_tolerance_samples() {
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    desk.go_to("deviations.base_pitch").keys(&["Alt-D"]);
    desk.assert_shows("(no distribution)");
    desk.keys(&["n", " ", "4"]);
    desk.assert_shows("normal 4 um");
    desk.keys(&["Shift-Up"]);
    let texts = |desk: &Desk| {
        desk.app.tab.case.spread.iter().map(|spread| spread.text.clone()).collect::<Vec<_>>()
    };
    assert_eq!(texts(&desk), ["normal 5 um"]);
    desk.keys(&["Ctrl-S"]);
    let line = "\"deviations.base_pitch\" = { normal = \"5 um\" }\n";
    let saved = desk.read("case.toml");
    assert!(saved.contains(line), "{saved}");
    assert_eq!(saved.replace(&format!("\n[spread]\n{line}"), ""), TABLE_1);
    desk.keys(&["Esc", "6", "d"]);
    desk.assert_shows("10000 samples");
    // Another one is wrong until it is removed; undo restores it.
    desk.keys(&["1"]).go_to("driver.tip_relief").keys(&["Alt-D", "normal 4 kg", "Ctrl-Home"]);
    desk.keys(&["Ctrl-S"]);
    desk.assert_shows("not saved");
    desk.keys(&["Ctrl-U", "Up"]);
    assert_eq!(texts(&desk), ["normal 5 um"]);
    desk.go_to("deviations.base_pitch").keys(&["Alt-D", "Ctrl-U", "Ctrl-Home", "Ctrl-S"]);
    assert_eq!(desk.read("case.toml").replace("\n[spread]\n", ""), TABLE_1);
    desk.keys(&["Ctrl-Z"]);
    assert_eq!(texts(&desk), ["normal 5 um"]);
}

#[test]
fn a_limit_that_is_no_value_is_not_saved() {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    desk.keys(&["Ctrl-End", "Ctrl-U", "much", "Ctrl-Home", "Ctrl-S"]);
    assert!(desk.shows("not saved"));
    assert_eq!(desk.read("case.toml"), TABLE_1);
    assert_eq!(desk.app.tab.form.input.value(), "much", "the focus is on the invalid field");
}

#[test]
fn inch_units_are_shown_and_the_case_keeps_its_own_units() {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    desk.keys(&["Esc", ":", "units", "Enter"]);
    desk.assert(desk.shows("492.56 lbf") && desk.shows("thou"));
    assert!(desk.shows("5 mm") && !desk.app.tab.is_unsaved());
    desk.go_to("pair.module");
    desk.assert_shows("= 0.19685 in. m module, about 0.00197 to 1.97 in");
    desk.keys(&["Esc", ":", "units", "Enter"]);
    assert!(desk.shows("2191.0 N"));
}

#[test]
fn a_form_speaks_of_labels_and_not_of_files() {
    let mut desk = Desk::new(LARGE);
    desk.fill("operation.speed", "fast");
    desk.assert(desk.shows("such as 20 rpm") && !desk.shows("\"20 rpm\""));
}

#[test]
fn a_search_finds_a_field_by_its_greek_letter_and_its_meaning() {
    let mut desk = Desk::new(SMALL);
    for (typed, key) in [
        ("alpha", "pair.pressure_angle"),
        ("fpb", "deviations.base_pitch"),
        ("coulomb", "operation.friction_coefficient"),
    ] {
        desk.keys(&["Esc", "/", typed, "Enter"]);
        assert_eq!(desk.app.tab.form.focus, index_of(key).unwrap(), "{typed}");
    }
}
