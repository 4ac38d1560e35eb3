//! The study pane: a field over its range, a map of two fields, the tolerance of the case; and
//! variants saved from the edits.
use crate::harness::{Desk, LARGE, SMALL, TABLE_1, requested, results};

use insta::assert_snapshot;
use ratatui::layout::{Position, Size};
use tipstrike::case::Document;
use tipstrike::tui::testing::{Action, Effect, End, Slot, update};

const SPREAD: &str = "\n[spread]\n\"deviations.base_pitch\" = { normal = \"2 um\" }\n\"operation.power\" = { \
        uniform = \"1 kW\" }\n";

/// The study of a field of Table 1, alone on the screen.
fn study(size: Size, key: &str) -> Desk {
    let mut desk = Desk::on(size, "case.toml", TABLE_1);
    desk.go_to(key).keys(&["Esc", "6", "z"]);
    desk
}

#[test]
fn the_focused_field_over_its_range() {
    for (name, size) in [("80x24", SMALL), ("140x45", LARGE)] {
        let mut desk = Desk::on(size, "case.toml", TABLE_1);
        desk.go_to("operation.speed").keys(&["Esc", "6", "Right", "Right"]);
        assert_snapshot!(format!("speed_{name}"), desk.screen());
    }
}

#[test]
fn a_gap_shows_where_no_tooth_strikes() {
    let desk = study(SMALL, "driven.tip_relief");
    desk.assert_shows("_ no contact");
    let shown = desk.app.tab.study.shown.as_ref().expect("a study");
    let found: Vec<_> = shown.layers[0].points().map(|(_, value)| value).collect();
    assert!(found[0].is_some() && found[100].is_none());
    assert_eq!((found.len(), &shown.end), (101, &Some(End::Whole)));
}

#[test]
fn the_curve_follows_every_edit_and_the_baseline_stays_behind_it() {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    desk.keys(&["Esc", "6", "b"]);
    desk.fill("operation.power", "20 kW").assert_shows("+ baseline");
    assert!(key_and_ends(&desk)[0].starts_with("pair.module"), "it keeps its field");
    for (keys, ends) in [
        (&["Esc", "6"][..], "10 kW 30 kW"),
        (&["+"], "15 kW 25 kW"),
        (&["-", "-"], "1e-15 kW 40 kW"),
        (&["0"], "10 kW 30 kW"),
    ] {
        assert_eq!(key_and_ends(desk.keys(keys)), [format!("operation.power {ends} 100")]);
    }
}

#[test]
fn two_fields_make_a_map_with_a_limit_and_the_edge_of_contact() {
    for size in [SMALL, LARGE] {
        let mut desk = study(size, "driven.tip_relief");
        desk.keys(&["s", "operation.speed", "Enter"]).has(&["+ limit 2500", "o edge of contact"]);
        desk.keys(&["l", "k"]);
        if size == SMALL {
            assert_snapshot!("map_80x24", desk.screen());
        }
        let cursor = desk.app.tab.study.cursor.expect("a cursor");
        desk.keys(&["Enter"]);
        assert_ne!(desk.text("operation.speed"), "2000 rpm");
        assert_ne!(desk.text("driven.tip_relief"), "0 um");
        assert_eq!((cursor.0, desk.app.tab.study.cursor), (1, None));
        desk.keys(&["s"]).lacks(&["edge of contact"]);
    }
}

fn key_and_ends(desk: &Desk) -> Vec<String> {
    let shown = desk.app.tab.study.shown.as_ref().expect("a study");
    let ends = shown.request.parameters.axes().iter().map(|axis| {
        let last = axis.points.len() - 1;
        format!("{} {} {} {last}", axis.key(), axis.with_unit(0), axis.with_unit(last))
    });
    ends.collect()
}

fn key(desk: &Desk) -> &str {
    let shown = desk.app.tab.study.shown.as_ref().expect("a study");
    shown.quantity().expect("a result").key
}

#[test]
fn a_typed_range_makes_a_curve_or_a_map_and_a_usual_range_replaces_it() {
    let mut desk = study(SMALL, "operation.speed");
    desk.keys(&["r", "1000..1500 rpm, 6 points", "Enter"]);
    assert_eq!(key_and_ends(&desk), ["operation.speed 1000 rpm 1500 rpm 5"]);
    desk.keys(&["r", "5..2 rpm", "Enter"]).assert_shows("the range is reversed");
    let map = "driven.tip_relief = 0..40 um, 5 points; operation.speed = 1..2 rpm, 2 points";
    desk.keys(&["Ctrl-U", map, "Enter"]);
    let expected = ["operation.speed 1 rpm 2 rpm 1", "driven.tip_relief 0 um 40 um 4"];
    assert_eq!(key_and_ends(&desk), expected);
    // The ranges stay, also those of the case while another one is shown.
    desk.go_to("driver.bore_radius").keys(&["Esc", "6"]);
    assert_eq!(key_and_ends(&desk), expected);
    let path = desk.write("other.toml", TABLE_1);
    let loaded = Document::read(&path).expect("a good case");
    desk.act(Action::Loaded(path, Ok(Box::new(loaded))));
    assert_eq!(key_and_ends(desk.keys(&["Esc", "6"])).len(), 1);
    desk.keys(&["Alt-1"]);
    assert_eq!(key_and_ends(&desk), expected);
    desk.go_to("operation.speed");
    desk.keys(&["Esc", "6", "s", "p", "Enter", "+"]);
    assert!(key_and_ends(&desk)[0].starts_with("operation.speed 1500 rpm"));
}

#[test]
fn the_sweep_command_studies_any_field_and_result_from_every_pane() {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    desk.keys(&["Esc", ":", "sweep driven.tip_relief = 0..40 um, 5 points", "Enter"]);
    assert_eq!(key_and_ends(&desk), ["driven.tip_relief 0 um 40 um 4"]);
    let usual = key(&desk).to_owned();
    desk.keys(&["o", "friction_ratio", "Enter"]);
    assert_eq!(key(&desk), "friction_ratio");
    desk.keys(&["o", "F_d,max", "Enter"]);
    assert_eq!(key(&desk), "dynamic_peak_force", "the typed keys again choose another result");
    desk.keys(&["p", "Enter", "o", "Enter"]);
    assert_eq!(key(&desk), usual);
    assert!(!key_and_ends(&desk)[0].starts_with("driven.tip_relief"));
}

#[test]
fn the_table_has_a_row_for_each_point_and_its_cursor_follows_them() {
    let mut desk = study(SMALL, "operation.speed");
    desk.keys(&["r", "1000..1500 rpm, 6 points", "Enter", "v", "l", "j"]);
    assert_snapshot!("table_80x24", desk.screen());
    assert_eq!(desk.app.tab.study.cursor, Some((5, 0)), "the present value is above the range");
    desk.keys(&["k", "Enter"]);
    assert_eq!(desk.text("operation.speed"), "1400 rpm");
}

#[test]
fn a_table_in_a_narrow_pane_has_fewer_columns_and_whole_numbers() {
    let mut desk = study(Size::new(60, 20), "operation.speed");
    desk.keys(&["v"]).has(&["n1 in rpm", "exact F_S in N"]).lacks(&["F_d,DE in"]);
    let found = &desk.app.tab.study.shown.as_ref().expect("a study").layers[0];
    let value = found.points().nth(50).and_then(|(_, value)| value).expect("a value");
    let row = desk.line_with(" 2000  ");
    desk.assert(row.contains(&format!(" {value:.1} ")));
}

#[test]
fn the_shown_points_are_exported_as_by_the_command_that_is_named() {
    for (name, part) in [
        ("a.csv", "outcome,method,static outcome,static method,static exit_outcome,"),
        ("a.json", "{\"varied\":{\"operation.speed\":{\"value\":1000.0"),
        ("a.svg", "<svg"),
    ] {
        let mut desk = study(SMALL, "operation.speed");
        desk.keys(&["o", "impact_force", "Enter", "r", "1000..1500 rpm, 6 points", "Enter"]);
        desk.keys(&["Alt-X"]).assert_shows("case.csv");
        desk.keys(&[name, "Enter"]);
        assert!(desk.read(name).contains(part), "{}", desk.read(name));
    }
    let mut desk = study(SMALL, "operation.speed");
    desk.keys(&["o", "impact_force", "Enter", "r", "1000..1500 rpm, 6 points", "Enter", "y"]);
    let commands = [
        ("", "impact_force"),
        (" --method static", "static_force_at_start"),
        (" --method dynamic", "dynamic_peak_approach_force"),
    ];
    let commands = commands.map(|(method, quantity)| {
        format!(
            "tipstrike sweep --vary 'operation.speed=1000..1500 rpm' --points 6{method} --only \
                {quantity} --format csv '{}'",
            desk.folder.path().join("case.toml").display()
        )
    });
    assert_eq!(desk.copied, Some(commands.join("\n")));
}

#[test]
fn the_tolerance_fills_its_page_and_needs_distributions() {
    let mut desk = study(SMALL, "operation.speed");
    desk.keys(&["d"]).assert_shows("The case has no [spread]");
    let mut desk = Desk::on(SMALL, "case.toml", &format!("{TABLE_1}{SPREAD}"));
    desk.keys(&["Esc", "6", "z", "d"]).assert_shows("10000 samples");
    desk.assert_shows("P50");
    let top = desk.screen();
    desk.keys(&["j", "j", "j"]);
    assert_ne!(desk.screen(), top);
    desk.keys(&["N", "1", "Enter"]).assert_shows("a number of samples from 2 to 1000000");
    desk.keys(&["Ctrl-U", "500", "Enter"]).assert_shows("500 samples, seed 1");
    desk.keys(&[":", "units", "Enter"]).has(&["500 samples", " lbf ("]);
    desk.keys(&["d"]).lacks(&["500 samples"]);
}

#[test]
fn a_tolerance_of_an_earlier_case_is_outdated_until_its_successor_arrives() {
    let mut desk = Desk::on(SMALL, "case.toml", &format!("{TABLE_1}{SPREAD}"));
    desk.fill("driven.tip_relief", "20 um").keys(&["Esc", "6", "z", "d"]).assert_shows("P50");
    desk.lacks(&["OUTDATED"]);
    let (number, work) = requested(desk.effects("u"), Slot::Study).expect("a study");
    desk.has(&["OUTDATED, the new result is computed: Tolerance", "P50"]);
    desk.take(results(number, work));
    desk.assert_shows("P50").lacks(&["OUTDATED"]);
}

fn is_stop(effect: &Effect) -> bool {
    matches!(effect, Effect::Cancel(Slot::Study))
}

#[test]
fn escape_stops_the_study_and_its_results_stay() {
    let mut desk = Desk::on(SMALL, "case.toml", &format!("{TABLE_1}{SPREAD}"));
    desk.keys(&["Esc", "6", "z"]);
    let (number, work) = requested(desk.effects("d"), Slot::Study).expect("a study");
    let mut all = results(number, work).into_iter();
    desk.act(all.next().expect("a page"));
    desk.assert_shows("P50");
    assert!(desk.effects("Esc").iter().any(is_stop));
    all.for_each(|action| desk.act(action));
    desk.has(&["the study is stopped", "P50"]);
    assert!(requested(desk.effects("j"), Slot::Study).is_none());
}

#[test]
fn a_hidden_study_is_not_computed_and_a_late_result_is_ignored() {
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    desk.fill("operation.speed", "2100 rpm");
    assert!(desk.app.tab.study.request.is_none());
    desk.keys(&["Esc"]);
    let (number, work) = requested(desk.effects("6"), Slot::Study).expect("a study");
    let late = results(number, work);
    assert!(desk.effects("5").iter().any(is_stop));
    desk.take(late);
    assert!(desk.app.tab.study.shown.is_none());
    assert!(requested(desk.effects("6"), Slot::Study).is_some());
    desk.fill("operation.speed", "2 kg");
    assert_eq!(
        desk.app.tab.study.obstacle.as_deref(),
        Some("No study: a field is empty or has an error. Alt-E goes to that field.")
    );
}

#[test]
fn variant_keeps_the_edits_and_without_edits_shows_them_again() {
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    desk.fill("driven.tip_relief", "48 um").keys(&["Esc", ":", "variant relieved", "Enter"]);
    desk.assert_shows("variant relieved now has 1 edit");
    assert_eq!(desk.text("driven.tip_relief"), "0 um");
    desk.keys(&["Ctrl-S"]);
    let saved = desk.read("case.toml");
    let added = "\n[variants.relieved]\n\"driven.tip_relief\" = \"48 um\"\n";
    assert_eq!(saved, format!("{TABLE_1}{added}"));
    desk.keys(&[":", "variant relieved", "Enter"]);
    assert_eq!(desk.text("driven.tip_relief"), "48 um");
    desk.keys(&["u", ":", "variant other", "Enter"]).assert_shows("no edits to keep");
}

#[test]
fn variants_are_shown_beside_the_case_with_their_differences() {
    let variants = "\n[variants.relieved]\n\"driven.tip_relief\" = \"30 \
            um\"\n[variants.far]\npair.centre_distance = \"200 mm\"\noperation.speed = \"1 rpm\"\n\
            driver.tip_relief = \"1 um\"\n";
    for (name, size) in [("80x24", SMALL), ("140x45", LARGE)] {
        let mut desk = Desk::on(size, "case.toml", &format!("{TABLE_1}{variants}"));
        desk.keys(&["Esc", "2", "v"]).has(&["relieved", "-40.1 %"]);
        assert_snapshot!(format!("variants_{name}"), desk.screen());
        desk.assert_shows("2 Variants").lacks(&["% N", "um um"]);
        assert!((0..3).any(|_| desk.keys(&["v"]).app.first_variant.is_none()));
    }
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    desk.keys(&["Esc", "2", "v"]).assert_shows("the case has no variants");
}

#[test]
fn a_result_that_the_pair_cannot_have_is_no_missing_contact() {
    let mut desk = study(SMALL, "driven.tip_relief");
    desk.run("method static");
    desk.keys(&["o", "load_swing", "Enter"]).has(&["_ no value", "only a helical"]);
    desk.lacks(&["no contact"]);
}

/// `auto` chooses `dynamic` for the fast pair, and `static` for the slow one.
#[test]
fn a_typed_range_keeps_its_result_of_which_auto_without_it_has_one_curve() {
    let text = TABLE_1.replace("method = \"exact\"", "method = \"auto\"");
    let mut desk = Desk::on(LARGE, "case.toml", &text);
    desk.keys(&["Esc", ":", "sweep operation.speed = 50..150 rpm, 3 points", "Enter"]);
    let before = key(&desk).to_owned();
    assert!(before.starts_with("dynamic"), "{before}");
    desk.fill("operation.speed", "100 rpm").has(&["by static", "● now"]);
    assert_eq!(key(&desk), before);
    let count = |desk: &Desk| desk.app.tab.study.shown.as_ref().expect("a study").layers.len();
    assert_eq!(count(&desk), 1);
    // Another method has the same load at rest.
    desk.keys(&["Esc", "6", "o", "static_peak_force", "Enter"]);
    assert_eq!((key(&desk), count(&desk)), ("static_peak_force", 1));
}

/// `auto` chooses `dynamic` for the fast pair alone, and `static` for the slow one.
#[test]
fn auto_solves_the_case_and_its_variants_by_one_method() {
    let text = TABLE_1.replace("method = \"exact\"", "method = \"auto\"");
    for (own, other) in [("2000", "100"), ("100", "2000")] {
        let text = text.replace("2000 rpm", &format!("{own} rpm"));
        let text = format!("{text}\n[variants.other]\n\"operation.speed\" = \"{other} rpm\"\n");
        let mut desk = Desk::on(SMALL, "case.toml", &text);
        desk.keys(&["Esc", "2", "v"]);
        desk.assert(desk.line_with(" n1 ").contains(&format!(" {other} rpm")));
        desk.assert_shows("by dynamic");
        desk.assert(!desk.line_with("F_d,max").contains('–'));
        desk.keys(&["n"]).assert_shows(&format!("Variant other: speed: {own} rpm -> {other} rpm."));
    }
}

#[test]
fn a_tolerance_that_fails_shows_the_reason() {
    let mut desk = Desk::on(SMALL, "case.toml", &format!("{TABLE_1}{SPREAD}"));
    desk.keys(&["Esc", "6", "z", "d"]);
    let shown = desk.app.tab.study.shown.as_mut().expect("a study");
    shown.page.clear();
    shown.end = Some(End::Failed("the spread is too wide: narrow it".to_owned()));
    desk.keys(&["j"]).lacks(&["Sampling."]);
    desk.assert_shows("the spread is too wide: narrow it");
}

#[test]
fn escape_in_a_field_leaves_the_field_while_a_study_runs() {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    desk.go_to("operation.speed").keys(&["Esc", "6", "1", "Enter"]);
    assert!(desk.app.has_line());
    assert!(requested(desk.effects("3"), Slot::Study).is_some());
    // The digit is undone, then the field is left.
    desk.effects("5");
    desk.effects("Esc");
    assert!(!desk.app.has_line());
    let effects = desk.effects("Esc");
    assert!(!effects.iter().any(is_stop));
}

#[test]
fn the_baseline_of_another_method_has_its_own_quantity() {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    desk.keys(&["Esc", "6", "b"]);
    desk.fill("operation.power", "20 kW").keys(&["Esc"]);
    desk.run("method dynamic");
    desk.assert_shows("+ baseline");
}

#[test]
fn the_cursor_returns_to_the_present_value_on_other_axes_alone() {
    let mut desk = study(SMALL, "operation.speed");
    desk.keys(&["l", "l"]);
    assert!(desk.app.tab.study.cursor.is_some());
    desk.keys(&["Enter"]);
    assert_eq!(desk.text("operation.speed"), "2040 rpm");
    desk.keys(&["l", "l", "+"]);
    assert_eq!(desk.app.tab.study.cursor, None);
    desk.keys(&["Enter"]).assert_shows("the cursor is at the present value");
    assert_eq!(desk.text("operation.speed"), "2040 rpm");
    desk.keys(&["l"]);
    let cursor = desk.app.tab.study.cursor;
    desk.keys(&["d", "d"]);
    assert_eq!(desk.app.tab.study.cursor, cursor);
    desk.go_to("driver.bore_radius").keys(&["Esc", "6"]);
    assert!(cursor.is_some() && desk.app.tab.study.cursor.is_none());
}

#[test]
fn fields_that_exclude_each_other_make_no_map() {
    let mut desk = study(SMALL, "operation.power");
    desk.keys(&["s", "operation.torque", "Enter"]).assert_shows("exclude each other");
    desk.assert_shows("s in this pane leaves the map");
}

#[test]
fn the_wheel_scrolls_the_tolerance_and_the_zoom_keys_keep_the_hidden_range() {
    let mut desk = Desk::on(SMALL, "case.toml", &format!("{TABLE_1}{SPREAD}"));
    desk.go_to("operation.speed").keys(&["Esc", "6", "z"]);
    let ends = key_and_ends(&desk);
    desk.keys(&["d"]);
    let top = desk.screen();
    desk.act(Action::Wheel(Position::new(5, 10), 3));
    let scrolled = desk.screen();
    assert_ne!(scrolled, top);
    desk.keys(&["k", "k", "k"]);
    assert_eq!(desk.screen(), top);
    desk.keys(&["+", "0", "-", "-", "d"]);
    assert_eq!(key_and_ends(&desk), ends);
}

#[test]
fn the_present_value_is_a_point_of_every_curve_and_map() {
    let mut desk = study(LARGE, "operation.speed");
    desk.fill("operation.speed", "2175 rpm").keys(&["Esc", "6"]);
    desk.assert_shows("n1 = 2175 rpm: exact");
    desk.keys(&["s", "damping", "Enter"]).assert_shows("n1 = 2175 rpm, ζ = 0.07: ");
    desk.keys(&["s"]);
    desk.go_to("pair.pressure_angle").keys(&["Esc", "6"]).assert_shows("α = 20 deg: exact");
    // Without a centre distance the gears mesh without backlash.
    desk.go_to("pair.centre_distance").keys(&["Esc", "6"]).assert_shows("a = 100 mm: exact");
}

#[test]
fn the_number_of_refused_points_is_that_of_the_marks() {
    let mut desk = study(LARGE, "driven.addendum");
    desk.keys(&["-"]);
    let shown = desk.app.tab.study.shown.as_ref().expect("a study");
    let count = shown.layers[0].points().filter(|(_, value)| value.is_none()).count();
    desk.assert_at(count, count > 1 && desk.shows(&format!("{count} points refused")));
}

/// One request is enough until another case with the same pane replaces the work.
#[test]
fn work_that_another_case_replaced_is_requested_again() {
    let text = format!("{TABLE_1}\n[variants.relieved]\n\"driven.tip_relief\" = \"30 um\"\n");
    for (pane, key, slot) in
        [("6", "6", Slot::Study), ("2", "v", Slot::Variants), ("3", "k", Slot::Chart)]
    {
        let mut desk = Desk::on(SMALL, "case.toml", &text);
        desk.keys(&["Esc"]);
        if pane != key {
            desk.keys(&[pane]);
        }
        let is_requested = |effects| requested(effects, slot).is_some();
        assert!(is_requested(desk.effects(key)), "{slot:?}");
        assert!(!is_requested(desk.effects("l")), "{slot:?}: one is enough");
        let path = desk.write("other.toml", &text);
        let loaded = Document::read(&path).expect("a good case");
        update(&mut desk.app, Action::Loaded(path, Ok(Box::new(loaded))));
        assert!(is_requested(desk.effects("Alt-1")), "{slot:?}: the other case replaced the work");
    }
}

#[test]
fn with_inch_units_a_study_is_in_inches() {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    desk.go_to("pair.module");
    desk.keys(&["Esc", "6", ":", "units", "Enter"]).assert_shows("over module in inches");
    desk.assert_shows("m = 0.19685 in:");
    desk.keys(&["l", "Enter"]);
    assert!(desk.text("pair.module").ends_with(" in"));
}
