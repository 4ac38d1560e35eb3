//! Keys in, screen and files out: editing, saving, opening, quitting.
use crate::harness::{Desk, LARGE, SMALL, TABLE_1, name};

use tipstrike::tui::testing::{Action, rows};

#[test]
fn every_keystroke_that_leaves_a_valid_value_changes_the_results() {
    let mut desk = Desk::new(SMALL);
    let force = |desk: &Desk| desk.line_with("F_S   ");
    assert!(force(&desk).contains("2191"));
    desk.go_to("operation.speed").keys(&["Home", "Delete", "1"]);
    let slower = force(&desk);
    assert!(!slower.contains("2191"), "{slower}");
    desk.keys(&["Backspace", "2"]);
    assert!(force(&desk).contains("2191"));
}

#[test]
fn undo_and_redo_move_by_one_field() {
    let mut desk = Desk::new(SMALL);
    desk.fill("operation.speed", "1500 rpm").keys(&["Tab", "Tab", "0.1", "Ctrl-Z"]);
    desk.assert_shows("undo: friction coefficient: 0.1 -> (empty)");
    desk.assert_shows("1500 rpm");
    desk.keys(&["Ctrl-Z"]).has(&["2000 rpm", "undo: speed: 1500 rpm -> 2000 rpm"]);
    assert!(!desk.app.tab.is_unsaved());
    desk.keys(&["Ctrl-Y"]).assert_shows("1500 rpm");
    desk.keys(&["Ctrl-Z", "Ctrl-Z"]).assert_shows("nothing to undo");
    // A new edit replaces the undone ones.
    desk.fill("operation.speed", "1600 rpm")
        .keys(&["Ctrl-Y"])
        .has(&["nothing to redo", "1600 rpm"]);
}

#[test]
fn switching_through_methods_is_one_step_of_undo() {
    let mut desk = Desk::new(SMALL);
    desk.keys(&["6", "Ctrl-T", "Ctrl-T", "Ctrl-T"]).has(&["method auto", "6 mm"]);
    desk.keys(&["Ctrl-Z"]).has(&[" by exact", "6 mm", ": auto -> "]);
    desk.keys(&["Ctrl-T", "7", "Ctrl-Z"]);
    // Later typing is a separate step.
    desk.has(&[" by static", "6 mm"]);
}

#[test]
fn a_character_that_cannot_begin_a_value_is_a_command() {
    let mut desk = Desk::new(LARGE);
    for (keys, expected) in [
        (&["/power", "Enter", "16"][..], "16 kW"),
        (&["Ctrl-U", ":undo", "Enter"], "undo: power: (empty) -> 15 kW"),
        (&["/method", "Enter", ":theme", "Enter"], "theme contrast"),
        (&["Alt-L", "impact_force", "Enter", "/"], "Go to a field or a result"),
    ] {
        assert!(desk.keys(keys).shows(expected), "{keys:?}\n{}", desk.screen());
    }
    desk.keys(&["Esc"]).go_to("pair.module").keys(&["End", "/"]).has(&["5 mm/", "! "]);
    desk.keys(&["Ctrl-Z"]).go_to("title").keys(&["End", "/:"]).has(&["Table 1/:"]);
    desk.keys(&["Ctrl-Z"]).go_to("title").keys(&["/"]).has(&["Go to a field or a result"]);
}

#[test]
fn the_notes_open_from_every_pane() {
    for pane in ["1", "2", "3", "4", "5"] {
        let mut desk = Desk::new(LARGE);
        desk.keys(&["Esc", pane, "n"]).assert_shows("Outcome, limits, notes");
    }
}

#[test]
fn chart_and_teeth_copy_the_reading_at_the_cursor() {
    for pane in ["3", "4"] {
        let mut desk = Desk::new(LARGE);
        desk.keys(&["Esc", pane, "y"]);
        desk.assert(desk.shows("no value to copy") && desk.copied.is_none());
        desk.keys(&["l", "y"]);
        let copied = desk.copied.clone().unwrap_or_default();
        assert!(copied.starts_with("1.3663 deg of the driver before E: "), "{copied}");
        assert!(copied.contains("F_S 2191.0 N"), "{copied}");
        desk.assert_shows("copied 1.3663 deg of the driver before E");
    }
}

#[test]
fn saving_the_built_in_case_asks_for_a_name_and_about_an_existing_file() {
    let mut desk = Desk::new(SMALL);
    let taken = desk.write("taken.toml", "not yours");
    desk.keys(&["Ctrl-S", "Ctrl-U", name(&taken), "Enter"]).assert_shows("exists. Overwrite");
    desk.keys(&["Esc", "Backspace"]);
    assert_eq!(desk.read("taken.toml"), "not yours");
    desk.keys(&["Ctrl-U", name(&desk.path("new.toml")), "Enter"]);
    assert_eq!(desk.read("new.toml"), TABLE_1);
    desk.assert_shows("new.toml");
    desk.keys(&["F2", "Ctrl-U", name(&taken), "Enter", "o"]);
    assert_eq!(desk.read("taken.toml"), TABLE_1);
}

#[test]
fn an_invalid_form_is_never_marked_as_saved() {
    for keys in [
        &["Ctrl-S"][..],
        &["F2"],
        &["Alt-S"],
        &["Ctrl-Q", "s"],
        &["Alt-W", "s"],
        &["Ctrl-P", "save as", "Enter"],
    ] {
        let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
        desk.fill("operation.speed", "fast").keys(keys);
        desk.assert_at(keys, desk.shows("not saved: fix") && desk.shows("*unsaved*"));
        let is_kept = desk.app.tab.is_unsaved() && desk.text("operation.speed") == "fast";
        assert!(is_kept && desk.app.prompts.is_empty() && !desk.has_quit, "{keys:?}");
        desk.keys(&["Ctrl-Q"]);
        assert!(desk.shows("has unsaved edits") && !desk.has_quit, "{keys:?}");
        assert_eq!(desk.read("case.toml"), TABLE_1, "{keys:?}");
    }
    // Of several cases, an invalid one stops the quitting; the others are saved.
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    desk.fill("operation.speed", "1500 rpm");
    let other = desk.write("other.toml", TABLE_1);
    desk.keys(&["Ctrl-O", "Ctrl-U", name(&other), "Enter"])
        .fill("operation.speed", "fast")
        .keys(&["Ctrl-Q", "s"]);
    desk.assert(!desk.has_quit && desk.shows("not saved: fix") && desk.shows("[2 other.toml*]"));
    assert!(desk.read("case.toml").contains("1500 rpm") && desk.read("other.toml") == TABLE_1);
}

#[test]
fn edits_are_not_lost_unasked() {
    for (keys, leaves, on_disk) in [
        (&["Ctrl-Q", "Esc"][..], false, "2000 rpm"),
        (&["Ctrl-Q", "c"], false, "2000 rpm"),
        (&["Ctrl-C", "Ctrl-C"], false, "2000 rpm"),
        (&["Ctrl-Q", "d"], true, "2000 rpm"),
        (&["Ctrl-Q", "Enter"], false, "2000 rpm"),
        (&["Ctrl-Q", "Left", "Enter"], true, "2000 rpm"),
        (&["Ctrl-Q", "Right", "Enter"], true, "1500 rpm"),
        (&["Alt-W", "my-quiet-pair", "Enter"], false, "2000 rpm"),
        (&["Ctrl-N", "7", "Ctrl-Q", "Enter"], false, "2000 rpm"),
        (&["Ctrl-O", "Esc", "Ctrl-Q", "s"], true, "1500 rpm"),
    ] {
        let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
        desk.fill("operation.speed", "1500 rpm").keys(keys);
        assert_eq!(desk.has_quit, leaves, "{keys:?}");
        assert!(desk.read("case.toml").contains(on_disk), "{keys:?}");
        assert!(leaves || keys.contains(&"Ctrl-N") || desk.shows("1500 rpm"), "{keys:?}");
    }
}

#[test]
fn without_edits_ctrl_q_leaves_at_once_and_ctrl_c_the_second_time() {
    let mut desk = Desk::new(SMALL);
    desk.keys(&["Ctrl-C"]);
    desk.assert(
        !desk.has_quit && desk.app.prompts.is_empty() && desk.shows("Ctrl-C again to quit"),
    );
    desk.keys(&["Down", "Ctrl-C"]);
    assert!(!desk.has_quit, "another key between them");
    desk.keys(&["Ctrl-C"]);
    assert!(desk.has_quit);
    let mut desk = Desk::new(SMALL);
    desk.keys(&["Ctrl-Q"]);
    assert!(desk.has_quit);
}

#[test]
fn a_paste_never_presses_a_button_and_inserts_no_control_character() {
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    desk.fill("operation.speed", "").act(Action::Paste("15\u{1b}[2J00\n rpm\u{202e}\r".to_owned()));
    assert_eq!(desk.text("operation.speed"), "15[2J00 rpm", "of its lines one is made");
    desk.keys(&["Ctrl-Q"]).act(Action::Paste("d".to_owned()));
    assert!(!desk.has_quit && desk.shows("has unsaved edits"));
    // A long one is cut.
    desk.keys(&["Esc"]).fill("title", "").act(Action::Paste("x".repeat(1 << 20)));
    assert_eq!(desk.app.tab.form.input.value().len(), 4096);
    desk.screen();
}

#[test]
fn the_round_axes_of_a_chart_stay_until_the_curve_leaves_them() {
    let mut desk = Desk::new(SMALL);
    let axis = |desk: &Desk| desk.app.charts().upright(0);
    let before = axis(&desk);
    desk.fill("operation.speed", "2100 rpm");
    assert_eq!(axis(&desk), before);
    desk.fill("operation.speed", "9000 rpm");
    assert!(axis(&desk).to > before.to);
    desk.fill("operation.speed", "2000 rpm");
    assert_eq!(axis(&desk), before);
}

#[test]
fn every_field_can_be_reached_and_every_line_of_the_results() {
    let mut desk = Desk::new(SMALL);
    desk.keys(&["Ctrl-Home"]);
    let labels = tipstrike::case::FIELDS.iter().map(|field| field.label);
    for label in labels {
        desk.assert_shows(label);
        desk.keys(&["Down"]);
    }
    desk.lacks(&[" κ "]);
    let pages = (0..13).take_while(|_| {
        let is_hidden = !desk.shows(" κ ");
        desk.keys(&["F4"]);
        is_hidden
    });
    assert!(pages.count() < 13, "{}", desk.screen());
}

#[test]
fn a_failed_solve_is_reported_and_the_results_are_marked() {
    let mut desk = Desk::new(SMALL);
    desk.app.solver_failed(desk.app.tab.serial);
    desk.has(&["solver failed", "LAST VALID"]);
    desk.fill("operation.speed", "1500 rpm").lacks(&["solver failed", "LAST VALID"]);
}

#[test]
fn typing_replaces_the_value_and_a_move_keeps_it() {
    for (keys, text) in [
        (&["1500"][..], "1500 rpm"),
        (&["Enter", "Up", "1500"], "1500 rpm"),
        (&["End", "x"], "2000 rpmx"),
        (&["Home", "1"], "12000 rpm"),
        (&["End", "Ctrl-H", "Ctrl-H", "Ctrl-H", "Hz"], "2000 Hz"),
        (&["Delete", "900"], "900 rpm"),
        (&["Esc", "Enter", "700"], "700 rpm"),
        (&["Esc", "/", "speed", "Enter", "800"], "800 rpm"),
    ] {
        let mut desk = Desk::new(SMALL);
        desk.go_to("operation.speed").keys(keys);
        assert_eq!(desk.text("operation.speed"), text, "{keys:?}\n{}", desk.screen());
    }
}

#[test]
fn leaving_a_field_keeps_its_value() {
    for leave in ["Esc", "Enter", "Tab", "BackTab", "Down", "Up", "PageDown", "F9", "Ctrl-O"] {
        for (field, typed, text) in [
            ("pair.module", &["7"][..], "7 mm"),
            ("pair.module", &["2", "Backspace", "3"], "3 mm"),
            ("pair.module", &["Shift-Up", "2"], "2 mm"),
            ("pair.module", &["n"], "n"),
            ("driver.teeth", &["7"], "7"),
            ("operation.torque", &["7"], "7 N m"),
            ("title", &["a"], "a"),
        ] {
            let mut desk = Desk::new(SMALL);
            desk.go_to(field).keys(typed).keys(&[leave, "Esc", "Esc"]);
            assert_eq!(desk.text(field), text, "{typed:?} {leave}");
            let at = tipstrike::case::fields::index_of(field);
            let is_marked = desk.app.tab.problems.iter().any(|(row, _)| Some(*row) == at);
            assert_eq!(is_marked, text == "n", "{typed:?} {leave}");
        }
    }
}

#[test]
fn results_are_found_as_fields_are() {
    for (keys, expected) in [
        (&["Esc", "/", "fs", "Enter"][..], "F_S impact force, Eq. 57"),
        (&["Esc", "2", "/", "friction", "Enter"], "f friction ratio"),
        (&["Esc", ":", "sliding_velocity", "Enter"], "sliding velocity"),
        (&["Ctrl-P", "tip relief", "Enter"], "▸ Ca2   tip relief"),
        (&["/relief", "Enter", "48"], "▸*Ca2   tip relief"),
        (&["Ctrl-P", "driven tip relief", "Enter", "48"], "▸*Ca2   tip relief"),
    ] {
        let mut desk = Desk::new(LARGE);
        desk.keys(keys);
        assert!(desk.app.prompts.is_empty() && desk.shows(expected), "{keys:?}\n{}", desk.screen());
    }
    let mut desk = Desk::new(SMALL);
    desk.keys(&["Esc", "2", "/", "driver.inertia", "Enter"]);
    let field = rows::field(&desk.app.tab.case, desk.app.tab.form.focus);
    assert_eq!(field.map(|field| field.key), Some("driver.inertia"));
    let mut desk = Desk::new(SMALL);
    desk.keys(&["Esc", "/", "dynamic_peak_force"]);
    assert!(!desk.shows("dynamic_peak_force, "), "no result of another method:\n{}", desk.screen());
}
