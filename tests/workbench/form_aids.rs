//! Aids of the form: steps, conversions, materials, limits, inch units, fields without effect.
use crate::harness::{Desk, LARGE, SMALL, TABLE_1};

use tipstrike::tui::testing::Action;

#[test]
fn the_form_shows_the_given_size_and_the_value_of_its_alternative() {
    let mut desk = Desk::new(LARGE);
    assert!(desk.line_with("diametral pitch").contains("(5.08 1/in)"));
    assert!(desk.line_with("tip diameter").contains("(110 mm)"));
    assert!(desk.line_with("root diameter").contains("(87.5 mm)"));
    desk.go_to("driver.tip_diameter").type_in("109");
    assert_eq!(desk.text("driver.tip_diameter"), "109 mm");
    assert_eq!(desk.text("driver.addendum"), "");
    desk.assert(desk.line_with("addendum").contains("(0.9)"));
    desk.assert_shows("addendum 1.0 replaced by the tip diameter");
    desk.go_to("pair.diametral_pitch").type_in("8");
    assert_eq!(desk.text("pair.diametral_pitch"), "8 1/in");
    desk.assert(desk.line_with("module").contains("(3.175 mm)"));
    desk.keys(&["Ctrl-U"]);
    assert_eq!(desk.text("pair.module"), "5 mm");
}

#[test]
fn typed_letters_select_the_choice_that_begins_with_them() {
    let mut desk = Desk::new(SMALL);
    for (key, typed, chosen) in [
        ("model.method", "paper", "paper"),
        ("model.method", "staqd", "static"),
        ("model.method", "pd", "dynamic"),
        ("model.tooth_compliance", "kuang-yang", "kuang-yang"),
        ("model.relief_shape", "parabolic", "parabolic"),
    ] {
        desk.go_to(key).keys(&[typed]);
        assert_eq!(desk.text(key), chosen, "{typed}");
    }
    for (pasted, chosen) in
        [("parabola", "parabolic"), (" \n", "parabolic"), (" linear\n", "linear")]
    {
        desk.act(Action::Paste(pasted.to_owned()));
        assert_eq!(desk.text("model.relief_shape"), chosen);
    }
}

#[test]
fn fields_that_the_method_does_not_use_are_marked_with_a_reason() {
    let mut desk = Desk::new(SMALL);
    desk.go_to("driver.root_relief");
    let idle = desk.line_with("Ca1");
    assert!(idle.starts_with("- Ca1"), "{idle}");
    desk.go_to("driver.tip_relief").assert_shows("Not used: this relief acts at the exit");
}

#[test]
fn a_material_fills_three_fields_at_once_and_undo_reverts_it() {
    let mut desk = Desk::new(LARGE);
    desk.go_to("driven.teeth").keys(&["Alt-G"]).assert_shows("Material of the driven gear");
    desk.keys(&["42cr", "Enter"]);
    desk.assert_shows("driven: E 210 GPa, ν 0.3, ρ 7720 kg/m3 from 42CrMo4");
    assert_eq!((desk.text("driven.young"), desk.text("driven.density")), ("210 GPa", "7720 kg/m3"));
    assert_eq!(desk.text("driver.young"), "205 GPa");
    desk.assert_shows("Driven (gear 2), 42CrMo4");
    desk.go_to("driven.density");
    desk.assert(
        desk.line_with(" *E2 ").contains("210 GPa")
            && desk.line_with("▸*ρ2 ").contains("7720 kg/m3"),
    );
    desk.assert_at("unchanged values have no mark:", desk.line_with("  ν2 ").contains("0.3"));
    desk.go_to("driven.young").assert_shows("42CrMo4: Deutsche Edelstahlwerke");
    desk.keys(&["Ctrl-Z"]);
    assert!(!desk.app.tab.is_unsaved());
    desk.lacks(&[" *E2 "]);
    desk.go_to("pair.module").keys(&["Alt-G", "PEEK", "Enter"]).assert_shows("both gears: E 4 GPa");
    assert_eq!((desk.text("driver.young"), desk.text("driven.young")), ("4 GPa", "4 GPa"));
}

#[test]
fn limits_are_a_group_of_the_form_with_their_verdicts() {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    desk.keys(&["Ctrl-End"]);
    assert!(desk.line_with("impact force         2500 N").contains("ok 88 %"));
    desk.keys(&["Ctrl-U", "2 kN"]);
    desk.assert(desk.line_with("force         2 kN").contains("! 110 %"));
    assert!(desk.shows("2191.0 N !"), "the result is marked too");
    desk.keys(&["Shift-Up"]);
    desk.keys(&["Ctrl-S"]);
    assert_eq!(desk.read("case.toml"), TABLE_1.replace("2500 N", "3 kN"));
}

#[test]
fn a_new_limit_starts_at_the_result_and_an_empty_one_is_removed() {
    let mut desk = Desk::new(LARGE);
    for name in ["normal_vel", "F_d,max"] {
        desk.keys(&["Alt-L", name, "Enter", "Esc"]);
        assert_eq!(desk.app.tab.case, desk.app.tab.document.case, "Esc takes the limit back");
    }
    desk.keys(&["Alt-L", "normal_vel", "Enter"]);
    desk.assert(desk.line_with("ok 100 %").contains("0.82107 m/s"));
    desk.keys(&["Ctrl-U"]).assert_shows("(no limit)");
    desk.keys(&["0.8"]).has(&["Unit added: m/s.", "0.8 m/s"]);
    desk.keys(&[" m/s", "Ctrl-U", "Up"]);
    desk.assert(!desk.shows("(no limit)") && !desk.app.tab.is_unsaved());
    // A result that the method lacks has a limit, and is found with the reason.
    desk.keys(&["Alt-L", "F_d,max", "Enter", "7000", "Enter"]);
    let limits = &desk.app.tab.case.limits;
    assert!(limits.iter().any(|limit| limit.text == "7000 N"), "{limits:?}");
    desk.keys(&["Esc", "/", "F_d,max"]).assert_shows("method exact does not compute");
}

#[test]
fn a_field_without_distribution_names_another_field_and_opens_no_list() {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    for (key, fix) in [
        ("driver.grade", "go to the base pitch deviation f_pb, then Alt-D"),
        ("driver.teeth", "is a whole number and has no distribution"),
        ("model.method", "is a choice and has no distribution"),
    ] {
        desk.go_to(key).keys(&["Alt-D"]).assert_shows(fix).lacks(&["Distribution of a field"]);
        desk.assert(desk.app.tab.case.spread.is_empty());
    }
    desk.keys(&["Esc", "2", "Alt-D"]).assert_shows("Distribution of a field");
}

#[test]
fn a_distribution_of_a_field_is_a_row_that_the_tolerance_samples() {
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    desk.go_to("deviations.base_pitch").keys(&["Alt-D"]).assert_shows("(no distribution)");
    desk.assert(!desk.app.tab.is_unsaved() && !desk.shows("unsaved"));
    desk.keys(&["n", " ", "4"]).assert_shows("normal 4 um");
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
    desk.keys(&["Esc", "6", "d"]).assert_shows("10000 samples");
    // Another one is wrong until it is removed; undo restores it.
    desk.keys(&["1"]).go_to("driver.tip_relief").keys(&["Alt-D", "normal 4 kg", "Ctrl-Home"]);
    desk.keys(&["Ctrl-S"]).assert_shows("not saved");
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
    desk.keys(&["Ctrl-End", "Ctrl-U", "much", "Ctrl-Home", "Ctrl-S"]).assert_shows("not saved");
    assert_eq!(desk.read("case.toml"), TABLE_1);
    assert_eq!(desk.app.tab.form.input.value(), "much", "the focus is on the invalid field");
}

#[test]
fn inch_units_are_shown_and_the_case_keeps_its_own_units() {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    desk.keys(&["Esc", ":", "units", "Enter"]).has(&["492.56 lbf", "thou"]);
    assert!(desk.shows("5 mm") && !desk.app.tab.is_unsaved());
    desk.go_to("pair.module").assert_shows("= 0.19685 in. m module, 0.05 to 50 mm");
    desk.keys(&["Esc", ":", "units", "Enter"]).assert_shows("2191.0 N");
}
