//! Keys in, screen out: focus, palette, tabs, baseline, cursor, copying, mouse, settings.
use crate::harness::{self, Desk, LARGE, SMALL, TABLE_1, name, requested};

use std::sync::Arc;

use insta::assert_snapshot;
use ratatui::layout::{Position, Size};
use ratatui::symbols::Marker;
use tipstrike::case::fields;
use tipstrike::model::inputs::Method;
use tipstrike::model::{Stage, Stages};
use tipstrike::tui::testing::{
    Action, Answer, CONTRAST, Effect, Item, Pane, Prompt, Settings, Slot, of_key, update,
};

const TINY: Size = Size { width: 60, height: 16 };
const HUGE: Size = Size { width: 240, height: 70 };

/// Three cases, the last one current, the second one unsaved.
fn three_cases(size: Size) -> Desk {
    let mut desk = Desk::on(size, "one.toml", TABLE_1);
    for (file, speed) in [("two.toml", "900 rpm"), ("three.toml", "700 rpm")] {
        let path = desk.write(file, &TABLE_1.replace("2000 rpm", speed));
        desk.keys(&["Ctrl-O", "Ctrl-U", name(&path), "Enter"]);
        if file == "two.toml" {
            desk.fill("operation.power", "10 kW");
        }
    }
    desk
}

#[test]
fn a_new_case_marks_its_required_fields_and_shows_the_defaults_of_the_others() {
    let mut desk = Desk::new(LARGE);
    desk.keys(&["Ctrl-N"]);
    for line in [
        "! 7 required values are missing (Alt-E)",
        "▸ m     module               (required)",
        "! z1    number of teeth      (required)",
        "  α     pressure angle       (20 deg)",
        "Required, such as 5 mm.",
    ] {
        desk.assert_shows(line);
    }
    assert!(!desk.shows("LAST VALID") && !desk.app.tab.is_unsaved());
    for (at, value) in ["4", "17", "20", "40", "22", "5 kW", "1500"].iter().enumerate() {
        assert_eq!(desk.app.tab.problems.len(), 7 - at);
        desk.keys(&[value, "Alt-E"]);
    }
    let text = |key| desk.app.tab.case.text(fields::index_of(key).expect("a field"));
    assert_eq!(text("driven.teeth"), Some("40"));
    assert_eq!((text("model.method"), text("model.within")), (Some("auto"), None));
    assert!(desk.app.tab.answer.is_some() && desk.app.tab.problems.is_empty());
}

#[test]
fn a_case_with_missing_values_opens_is_saved_and_opens_again() {
    let mut desk = Desk::new(SMALL);
    let path = desk.path("pair.toml");
    let path = path.to_str().expect("a name in UTF-8");
    desk.keys(&["Ctrl-N", "4", "Ctrl-S", "Ctrl-U", path, "Enter"]);
    desk.assert(desk.shows("; 6 required values are missing") && !desk.app.tab.is_unsaved());
    assert!(desk.read("pair.toml").contains("\nmodule = \"4 mm\"  # required"));
    desk.keys(&["Alt-W", "Ctrl-O", "Ctrl-U", path]);
    desk.has(&["Required values are missing:", "the driver's number of teeth"]);
    desk.keys(&["Enter"]).assert_shows("! 6 required values are missing");
    desk.go_to("driver.teeth").keys(&["17.5", "Ctrl-S"]);
    desk.assert_shows("fix driver number of teeth first; the edits stay in the form");
}

fn listed(desk: &Desk) -> Vec<Arc<Item>> {
    match desk.app.prompts.last() {
        Some(Prompt::Pick(picker)) => picker.fitting(),
        other => panic!("{other:?}"),
    }
}

#[test]
fn the_palette_lists_commands_of_the_focused_pane_and_field_first() {
    let first = |desk: &Desk| listed(desk).swap_remove(0).name.clone();
    for (field, keys, command) in [
        ("pair.module", &["Ctrl-P"][..], "step"),
        ("driven.tip_relief", &["Esc", ":"], "edit"),
        ("driven.tip_radius", &["Ctrl-P"], "material"),
        ("model.method", &["Ctrl-P"], "method"),
        ("pair.module", &["Esc", "2", ":"], "explain"),
        ("pair.module", &["Esc", "3", ":"], "play"),
        ("pair.module", &["Esc", "5", ":"], "apply setting"),
    ] {
        let mut desk = Desk::new(LARGE);
        desk.go_to(field).keys(keys);
        assert_eq!(first(&desk), command, "{field} {keys:?}\n{}", desk.screen());
    }
    let mut desk = Desk::new(SMALL);
    desk.keys(&["Esc", "2", ":", "tip rel"]);
    assert_eq!(first(&desk), "driven.tip_relief");
    desk.assert_shows("Ca2 driven tip relief.");
    desk.keys(&["Ctrl-U", "unlikely words"]).assert_shows("No match.");
}

#[test]
fn a_field_takes_text_until_esc_leaves_it() {
    let mut desk = Desk::new(SMALL);
    desk.keys(&["Ctrl-U", "6 mm", "Esc", "q"]);
    assert!(desk.shows("has unsaved edits"), "outside a field q quits, and asks");
    desk.keys(&["Esc", "jjjjjjj"]);
    assert!(desk.shows("z1 driver number of teeth"), "j moves down");
    desk.keys(&["kkkkk", "i", "Ctrl-U", "21 deg", "Esc", "u"]);
    assert!(desk.shows("6 mm") && desk.shows("20 deg"), "u undoes a visit");
    desk.keys(&["Ctrl-R"]).assert_shows("21 deg");
    desk.keys(&["Enter", "End", "Backspace"]);
    assert_eq!(desk.app.tab.form.input.value(), "21 de", "Enter edits again");
}

#[test]
fn tab_cycles_the_panes_whose_letters_are_commands() {
    let mut desk = Desk::new(LARGE);
    desk.keys(&["Esc"]);
    for pane in [Pane::Results, Pane::Chart, Pane::Teeth, Pane::Trade, Pane::Study, Pane::Form] {
        desk.keys(&["Tab"]);
        assert_eq!(desk.app.layout.focus, pane);
        desk.assert_shows(&format!("▸ {}", pane.number()));
        desk.keys(&["xwv0"]).act(Action::Paste("999".to_owned()));
        assert!(!desk.app.tab.is_unsaved() && desk.shows("nothing to paste into"));
    }
    desk.keys(&["BackTab"]);
    assert_eq!(desk.app.layout.focus, Pane::Study);
    desk.keys(&["Esc"]);
    assert_eq!(desk.app.layout.focus, Pane::Form);
}

#[test]
fn every_pane_can_be_shown_at_every_size() {
    for size in [TINY, SMALL, LARGE, HUGE] {
        for pane in Pane::ALL {
            let mut desk = Desk::new(size);
            desk.keys(&["Esc", &pane.number().to_string()]);
            assert!(desk.shows(&format!("▸ {}", pane.number())), "{pane:?} at {size}");
            desk.keys(&["z"]);
            assert!(desk.shows(&format!("▸ {}", pane.number())), "{pane:?} zoomed at {size}");
        }
    }
}

#[test]
fn hidden_results_are_not_computed() {
    let mut desk = Desk::new(SMALL);
    let stages = |desk: &Desk| desk.app.tab.answer.as_ref().expect("a result").stages;
    assert!(stages(&desk).has(Stage::Stations));
    desk.keys(&["F5"]).fill("operation.speed", "1500 rpm");
    assert!(!stages(&desk).has(Stage::Stations) && stages(&desk).has(Stage::Friction));
    desk.keys(&["Esc", "3"]);
    assert!(stages(&desk).has(Stage::Stations), "and is as soon as it is looked at");
    desk.assert_shows("⠒");
}

#[test]
fn every_command_of_the_palette_works_on_every_screen() {
    for pane in Pane::ALL {
        let number = pane.number().to_string();
        let mut palette = Desk::new(SMALL);
        palette.keys(&["Esc", &number, ":"]);
        // A quarter of the commands in each pane beside the form, which runs all.
        let step = if pane == Pane::Form { 1 } else { 4 };
        let first = (pane.number() % 4) % step;
        for command in listed(&palette).into_iter().skip(first).step_by(step) {
            let mut desk = Desk::with(palette.app.clone());
            desk.act(Action::Paste(command.name.clone()));
            let place = listed(&desk).iter().position(|one| one.name == command.name);
            for _ in 0..place.unwrap_or_else(|| panic!("{}", command.name)) {
                desk.keys(&["Down"]);
            }
            // Its work is the same in every pane.
            if pane == Pane::Form && !matches!(command.name.as_str(), "suspend" | "redraw") {
                desk.keys(&["Enter"]);
            } else {
                desk.effects("Enter");
            }
            desk.screen();
        }
    }
}

#[test]
fn cases_are_in_tabs_each_with_its_own_results_and_history() {
    let mut desk = three_cases(LARGE);
    assert_eq!(desk.app.tabs().count(), 3);
    desk.has(&["1 one.toml", "2 two.toml*", "[3 three.toml]"]);
    desk.keys(&["Alt-1"]).has(&["2191.0", "[1 one.toml]"]);
    desk.keys(&["Ctrl-PageDown"]).assert_shows("10 kW");
    desk.keys(&["Ctrl-Z", "Ctrl-Z"]).has(&["nothing to undo", "[2 two.toml]"]);
    desk.keys(&["Ctrl-PageUp", "Ctrl-PageUp"]);
    assert!(desk.shows("[3 three.toml]"), "round and round");
    desk.keys(&["Alt-9"]).assert_shows("[3 three.toml]");
}

#[test]
fn opening_an_open_case_goes_to_its_tab_and_keeps_its_edits() {
    let mut desk = three_cases(LARGE);
    let two = desk.path("two.toml");
    desk.keys(&["Ctrl-O", "Ctrl-U", name(&two), "Enter"]);
    desk.has(&["is open already", "[2 two.toml*]", "10 kW"]);
}

#[test]
fn a_tab_closes_on_request_and_asks_about_unsaved_edits() {
    let mut desk = three_cases(LARGE);
    desk.keys(&["Alt-W"]);
    assert!(desk.shows("[2 two.toml*]") && desk.app.tabs().count() == 2);
    desk.keys(&["Alt-W", "c"]);
    assert_eq!(desk.app.tabs().count(), 2);
    desk.keys(&["Alt-W", "s"]);
    assert!(desk.app.tabs().count() == 1 && desk.read("two.toml").contains("10 kW"));
    desk.keys(&["Alt-W"]).assert_shows("built-in Table 1");
    assert!(!desk.has_quit, "the last one leaves the built-in case");
}

#[test]
fn quitting_asks_about_every_unsaved_case() {
    let both = || {
        let mut desk = three_cases(LARGE);
        desk.keys(&["Alt-1"]).fill("operation.speed", "1100 rpm");
        desk
    };
    let mut desk = both();
    desk.keys(&["Ctrl-Q"]).assert_shows("2 cases have unsaved edits");
    desk.keys(&["c"]);
    assert!(!desk.has_quit);
    desk.keys(&["Ctrl-Q", "s"]);
    assert!(desk.has_quit);
    assert!(desk.read("one.toml").contains("1100 rpm") && desk.read("two.toml").contains("10 kW"));
    let mut desk = both();
    desk.keys(&["Ctrl-Q", "d"]);
    assert!(desk.has_quit && !desk.read("one.toml").contains("1100 rpm"));
    let mut desk = three_cases(LARGE);
    // The one that is unsaved is in sight.
    desk.keys(&["Ctrl-Q"]).has(&["two.toml has unsaved edits", "[2 two.toml*]"]);
}

#[test]
fn an_answer_goes_to_the_case_that_asked_for_it() {
    let mut desk = three_cases(LARGE);
    desk.keys(&["Alt-1"]).fill("operation.speed", "1100 rpm");
    let late = update(&mut desk.app, Action::Insert('x'));
    assert!(requested(late, Slot::Solve).is_none(), "an invalid case is not solved");
    let effects = update(&mut desk.app, harness::run("undo"));
    assert!(requested(effects, Slot::Solve).is_some(), "it asks for a solve");
    let answer = desk.whole_answer();
    desk.keys(&["Alt-2"]);
    let before = desk.screen();
    desk.show(answer);
    assert_eq!(desk.screen(), before);
    desk.keys(&["Alt-1"]).assert_shows("2191.0");
}

#[test]
fn a_request_that_another_case_put_aside_is_asked_for_again() {
    let mut desk = three_cases(LARGE);
    desk.keys(&["Alt-1"]).go_to("operation.speed");
    update(&mut desk.app, harness::run("method"));
    desk.keys(&["Alt-2", "Alt-1"]);
    assert!(desk.shows(" by static") && desk.app.tab.is_settled);
}

#[test]
fn the_baseline_is_pinned_and_the_difference_is_shown_beside_it() {
    let mut desk = Desk::new(LARGE);
    desk.keys(&["Alt-B"]).fill("operation.speed", "1900 rpm");
    desk.assert_shows("against built-in Table 1");
    let is_unchanged = desk.line_with("p_b ").ends_with("unchanged");
    desk.assert(desk.line_with("ΔV_n").contains("-5.0 %") && is_unchanged);
    desk.act(Action::Resize(SMALL));
    assert!(desk.shows("-5.0 %"), "where there is no room the other method gives way");
    desk.keys(&["Alt-B"]);
    assert!(desk.app.baseline.is_none() && !desk.shows("-5.0 %"));
}

#[test]
fn the_baseline_is_common_to_tabs_and_has_its_curve_even_if_no_chart_was_visible() {
    let mut desk = three_cases(SMALL);
    desk.keys(&["Alt-1", "F5", "Esc", "b", "Alt-3"]);
    let pinned = desk.app.baseline.as_ref().expect("it is pinned");
    assert_eq!(pinned.name, "one.toml");
    assert!(pinned.answer.stages.covers(Stages::EVERY));
    desk.fill("driven.tip_relief", "20 um").keys(&["Esc", "2", "z"]).has(&[" baseline", " %"]);
    desk.fill("operation.speed", "bad").keys(&["Esc", "b", "b"]);
    desk.assert_shows("no valid results to pin");
}

#[test]
fn a_baseline_of_another_method_has_the_values_that_both_methods_compute() {
    let mut desk = Desk::new(LARGE);
    desk.run("method dynamic");
    desk.keys(&["Alt-B"]);
    desk.run("method static");
    desk.assert_shows("unchanged").lacks(&["was none", "not solved"]);
    let mut desk = Desk::new(LARGE);
    desk.keys(&["Alt-B"]);
    desk.run("method dynamic");
    desk.assert_shows("not solved").lacks(&["was none"]);
}

#[test]
fn an_opened_case_shows_all_panes() {
    let mut desk = Desk::new(LARGE);
    let path = desk.write("other.toml", TABLE_1);
    desk.keys(&["Esc", "3", "z"]).lacks(&["Corner contact"]);
    desk.keys(&["Ctrl-O", "Ctrl-U", name(&path), "Enter"]).assert_shows("Corner contact");
}

#[test]
fn values_that_an_edit_changed_are_marked_until_the_next_visit() {
    let mut desk = Desk::new(LARGE);
    let marked = |desk: &Desk, symbol: &str| desk.line_with(symbol).contains('←');
    desk.fill("operation.speed", "1900 rpm");
    assert!(marked(&desk, "approach velocity") && !marked(&desk, "base pitch"));
    desk.fill("operation.power", "14 kW");
    assert!(marked(&desk, " mesh force  ") && !marked(&desk, "approach velocity"));
    desk.keys(&["Ctrl-Z"]);
    assert!(marked(&desk, " mesh force  ") && !marked(&desk, "approach velocity"));
    desk.keys(&["Ctrl-Z"]);
    assert!(marked(&desk, "approach velocity"));
}

#[test]
fn the_animation_plays_to_its_end_and_then_the_clock_stops() {
    let mut desk = Desk::new(SMALL);
    assert!(desk.played(&["Esc", "3", "Space"]).abs() < 1e-12);
    for stop in ["Space", "Esc", "Ctrl-C", "l", "c"] {
        desk.keys(&["Space"]);
        assert!(desk.ticks);
        desk.keys(&[stop]);
        assert!(!desk.ticks && !desk.app.is_playing, "{stop}");
    }
    desk.fill("driven.tip_relief", "80 um").keys(&["Esc", "3", "Space"]);
    assert!(!desk.ticks && desk.shows("nothing to play"));
}

#[test]
fn the_results_have_a_cursor_a_page_and_are_copied() {
    let mut desk = Desk::new(SMALL);
    desk.keys(&["Esc", "2", "Enter"]).has(&["impact_force", "Eq. 57"]);
    desk.keys(&["Esc", "y"]);
    assert_eq!(desk.copied.as_deref(), Some("2191.0 N"));
    desk.keys(&["Y"]);
    let copied = desk.copied.clone().unwrap_or_default();
    for part in [
        "# Zhou & Chen 2014, Table 1",
        "Corner contact 1.366 deg before E: free impact 2191.0 N (1.44",
        "| power | P | 15 kW |",
        "| impact force | F_S | 2191.0 | N |",
    ] {
        assert!(copied.contains(part), "{part}: {copied}");
    }
    desk.assert_shows("copied the report of the results");
    desk.keys(&["1", "y"]);
    assert_eq!(desk.copied.as_deref(), Some("5 mm"));
    desk.keys(&["2", "G"]);
    let last = desk.app.listed_results().last().map(|known| known.key);
    assert_eq!(desk.app.marked_result().map(|known| known.key), last);
}

#[test]
fn notes_are_never_off_the_screen() {
    for size in [TINY, SMALL, LARGE, HUGE] {
        let mut desk = Desk::new(size);
        assert!(desk.shows("(Esc n)") || desk.shows("Note: "), "{size}");
        desk.keys(&["Esc", "2", "G"]);
        desk.assert(desk.shows("(n)") || desk.shows("Note: "));
        desk.keys(&["n"]);
        if size == TINY {
            desk.keys(&["PageDown"]);
        }
        desk.assert_shows("the impact lasts");
    }
}

/// The required relief of a method that shares the load arrives after the other results: until then
/// a placeholder is shown, and no figure of another method or of an earlier edit.
#[test]
fn the_required_relief_has_a_placeholder_until_it_is_present() {
    let mut desk = Desk::new(LARGE);
    desk.assert_shows("47.4 um tip relief on the driven gear");
    let effects = update(&mut desk.app, harness::run("method"));
    assert!(requested(effects, Slot::Solve).is_some(), "it asks for a solve");
    let whole = desk.whole_answer();
    let mut first = Answer { stages: whole.stages.without(Stage::Clearing), ..whole.clone() };
    for (_, found) in first.methods.iter_mut().filter(|(method, _)| *method == Method::Static) {
        found.as_mut().expect("a solution").clearing = None;
    }
    desk.show(first);
    desk.assert_shows("being");
    let mut stopped = desk.app.clone();
    let cancel = of_key(harness::event("Ctrl-C"), stopped.place()).expect("a key");
    let effects = update(&mut stopped, cancel);
    assert!(matches!(effects[..], [Effect::Cancel(Slot::Solve)]) && stopped.message.is_some());
    // It is waited for no more.
    assert!(!stopped.tab.lacks(Stage::Clearing));
    desk.show(whole);
    desk.assert_shows("40.1 um tip").lacks(&["being"]);
}

#[test]
fn a_slow_solve_shows_its_progress_and_esc_stops_it() {
    let mut desk = three_cases(LARGE);
    let effects = update(&mut desk.app, harness::run("method"));
    assert!(requested(effects, Slot::Solve).is_some(), "it asks for a solve");
    let whole = desk.whole_answer();
    let half = Answer { active: Method::Exact, pending: Some(Method::Static), ..whole };
    desk.show(half);
    let serial = desk.app.tab.serial;
    desk.app.show_progress(serial, 0.25);
    desk.has(&["25 % solving static; Ctrl-C cancels", "static pending"]);
    desk.keys(&["Ctrl-C"]).has(&["method static is stopped"]).lacks(&["pending"]);
    assert!(desk.has_cancelled && desk.app.has_line(), "the field keeps the keys");
    desk.app.show_progress(serial, 0.5);
    assert!(!desk.shows("solving"), "a late message is not shown");
}

#[test]
fn the_mouse_is_off_by_default_and_then_selects() {
    let mut desk = Desk::new(SMALL);
    assert!(!Settings::default().mouse);
    desk.keys(&["Ctrl-P", "mouse", "Enter"]);
    assert!(desk.has_mouse && desk.kept.is_some_and(|kept| kept.mouse));
    desk.act(Action::Click(Position::new(8, 15)));
    assert!(desk.app.cursor.is_some_and(|cursor| (cursor.to_degrees() - 1.5).abs() < 1e-9));
    desk.act(Action::Wheel(Position::new(10, 7), 3));
    assert_eq!(desk.app.tab.form.top, 3);
    desk.act(Action::Wheel(Position::new(50, 10), 3));
    assert_eq!(desk.app.tab.results.top, 3);
}

#[test]
fn settings_for_every_case_are_saved() {
    let mut desk = Desk::new(SMALL);
    desk.keys(&["F8", "Ctrl-P", "theme", "Enter"]);
    assert_eq!(desk.app.look.theme, &CONTRAST);
    assert_eq!(desk.kept.map(|kept| kept.marker), Some(Marker::HalfBlock));
    desk.keys(&["Ctrl-P", "ascii", "Enter", "F8"]);
    assert!(desk.screen().is_ascii() && desk.shows("no effect"));
    assert_eq!(desk.kept.map(|kept| kept.ascii), Some(true));
}

#[test]
fn torque_replaces_power_and_restores_it() {
    let mut desk = Desk::new(SMALL);
    desk.fill("operation.torque", "7");
    let notice = "power 15 kW replaced by the torque";
    desk.assert_shows(notice);
    desk.keys(&["0 N m"]);
    assert!(desk.shows(notice), "as long as it is typed\n{}", desk.screen());
    assert!(!desk.shows("both given") && desk.app.tab.problems.is_empty());
    desk.keys(&["Ctrl-U"]);
    assert!(desk.shows("power 15 kW restored") && desk.app.tab.problems.is_empty());
    desk.keys(&["70 N m", "Ctrl-Z"]);
    assert!(!desk.app.tab.is_unsaved(), "both changes are one step");
}

#[test]
fn the_screens() {
    let openings: [(&str, &[&str]); 3] = [
        ("palette", &["Ctrl-P", "cur"]),
        ("cursor", &["Esc", "3", "l", "L"]),
        ("baseline", &["Alt-B", "Ctrl-U", "5.5 mm"]),
    ];
    for (screen, keys) in openings {
        for (name, size) in [("80x24", SMALL), ("140x45", LARGE)] {
            let mut desk = Desk::new(size);
            desk.keys(keys);
            assert_snapshot!(format!("{screen}_{name}"), desk.screen());
            harness::assert_ascii(&mut desk);
        }
    }
    let mut outside = Desk::new(SMALL);
    outside.keys(&["Esc"]);
    assert_snapshot!("outside_a_field_80x24", outside.screen());
    assert_snapshot!("tabs_80x24", three_cases(SMALL).screen());
    assert_snapshot!("opening_240x70", Desk::new(HUGE).screen());
    assert_snapshot!("opening_60x16", Desk::new(TINY).screen());
}
