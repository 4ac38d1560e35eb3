//! The study pane: a field over its range, a map of two fields, the tolerance of the case; and
//! variants kept from the edits.
use crate::harness;

use crossterm::event::KeyCode;
use harness::{Desk, LARGE, SMALL, TABLE_1};
use insta::assert_snapshot;
use ratatui::layout::Size;
use tipstrike::case::fields::index_of;
use tipstrike::tui::testing::actions::{self, Action, Effect};
use tipstrike::tui::testing::study::{End, Found, Question, StudyPart};
use tipstrike::tui::testing::update::update;

const SPREAD: &str = "\n[spread]\n\"deviations.base_pitch\" = { normal = \"2 um\" }\n\"operation.power\" = { uniform = \"1 kW\" }\n";

/// The study of a field of Table 1, alone on the screen.
fn study(size: Size, key: &str) -> Desk {
    let mut desk = Desk::on(size, "case.toml", TABLE_1);
    desk.go_to(key).keys(&["Esc", "6", "z"]);
    desk
}

/// The effects of a key, not performed.
fn asked(desk: &mut Desk, key: &str) -> Vec<Effect> {
    let letter = || KeyCode::Char(key.chars().next().expect("a key")).into();
    let event = harness::named(key).unwrap_or_else(letter);
    let action = actions::of_key(event, desk.app.place()).expect("an action");
    update(&mut desk.app, action)
}

fn written(desk: &Desk, key: &str) -> String {
    let field = index_of(key).expect("a field");
    desk.app.tab.case.text(field).unwrap_or_default().to_owned()
}

#[test]
fn the_focused_field_over_its_range() {
    for (name, size) in [("80x24", SMALL), ("140x45", LARGE)] {
        let mut desk = Desk::on(size, "case.toml", TABLE_1);
        desk.go_to("operation.speed").keys(&["Esc", "6"]);
        assert_snapshot!(format!("speed_{name}"), desk.screen());
        desk.keys(&["z", "Right", "Right"]);
        assert_snapshot!(format!("speed_alone_{name}"), desk.screen());
    }
}

#[test]
fn a_gap_shows_where_no_tooth_strikes() {
    let desk = study(SMALL, "driven.tip_relief");
    assert!(desk.shows("· no contact"), "{}", desk.screen());
    let shown = desk.app.tab.study.shown.as_ref().expect("a study");
    let found = &shown.layers[0];
    assert!(found.values[0].is_some() && found.values[100].is_none());
    assert_eq!((found.values.len(), &shown.end), (101, &Some(End::Whole)));
    assert_snapshot!("tip_relief_80x24", desk.screen());
}

#[test]
fn refused_points_are_counted_and_named() {
    let mut desk = study(SMALL, "driver.bore_radius");
    desk.keys(&["-", "-"]);
    assert!(desk.shows("points refused:"), "{}", desk.screen());
    assert!(desk.shows("× refused"), "{}", desk.screen());
}

#[test]
fn the_curve_follows_every_edit_and_the_baseline_stays_behind_it() {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    desk.keys(&["Esc", "6", "b"]);
    let ends = |desk: &Desk| {
        let shown = desk.app.tab.study.shown.as_ref().expect("a study");
        let Question::Grid(grid) = &shown.request.question else {
            panic!("a curve")
        };
        let axis = &grid.axes[0];
        (axis.key(), axis.with_unit(0), axis.with_unit(100))
    };
    desk.fill("operation.power", "20 kW");
    assert_eq!(
        ends(&desk),
        ("operation.power", "10 kW".into(), "30 kW".into())
    );
    assert!(desk.shows("+ baseline"), "{}", desk.screen());
    desk.keys(&["Esc", "6", "+"]);
    assert_eq!(ends(&desk).1, "15 kW");
    desk.keys(&["-", "-"]);
    assert_eq!(ends(&desk).2, "40 kW");
    desk.keys(&["0"]);
    assert_eq!(ends(&desk).1, "10 kW");
}

#[test]
fn enter_takes_the_value_under_the_cursor_and_undo_returns_it() {
    let mut desk = study(SMALL, "operation.speed");
    desk.keys(&["l", "l", "h", "Enter"]);
    assert_eq!(written(&desk, "operation.speed"), "2020 rpm");
    assert!(
        desk.shows("driver speed = 2020 rpm; u undoes") || desk.shows("speed = 2020 rpm; u undoes")
    );
    desk.keys(&["u"]);
    assert_eq!(written(&desk, "operation.speed"), "2000 rpm");
}

#[test]
fn two_fields_make_a_map_with_a_limit_and_the_edge_of_contact() {
    for (name, size) in [("80x24", SMALL), ("140x45", LARGE)] {
        let mut desk = study(size, "driven.tip_relief");
        desk.keys(&["s", "operation.speed", "Enter"]);
        assert!(
            desk.shows("+ limit 2500") && desk.shows("o edge of contact"),
            "{}",
            desk.screen()
        );
        desk.keys(&["l", "k"]);
        assert_snapshot!(format!("map_{name}"), desk.screen());
        let cursor = desk.app.study.cursor.expect("a cursor");
        desk.keys(&["Enter"]);
        assert_ne!(written(&desk, "operation.speed"), "2000 rpm");
        assert_ne!(written(&desk, "driven.tip_relief"), "0 um");
        assert_eq!((cursor.0, desk.app.study.cursor), (1, None));
        desk.keys(&["s"]);
        assert!(!desk.shows("edge of contact"), "{}", desk.screen());
    }
}

#[test]
fn the_tolerance_fills_its_page_and_needs_distributions() {
    let mut desk = study(SMALL, "operation.speed");
    desk.keys(&["d"]);
    assert!(desk.shows("The case has no [spread]"), "{}", desk.screen());
    let mut desk = Desk::on(SMALL, "case.toml", &format!("{TABLE_1}{SPREAD}"));
    desk.keys(&["Esc", "6", "z", "d"]);
    assert!(desk.shows("10000 samples"), "{}", desk.screen());
    assert!(
        desk.shows("P50") || desk.shows("probab"),
        "{}",
        desk.screen()
    );
    let top = desk.screen();
    desk.keys(&["j", "j", "j"]);
    assert_ne!(desk.screen(), top);
    desk.keys(&["d"]);
    assert!(!desk.shows("10000 samples"));
}

#[test]
fn escape_stops_the_study_and_its_results_stay() {
    let mut desk = Desk::on(SMALL, "case.toml", &format!("{TABLE_1}{SPREAD}"));
    desk.keys(&["Esc", "6", "z"]);
    let effects = asked(&mut desk, "d");
    let Some(Effect::Study(request)) = effects
        .into_iter()
        .find(|effect| matches!(effect, Effect::Study(_)))
    else {
        panic!("a study is asked for");
    };
    let part = |found, end| StudyPart {
        serial: request.serial,
        found,
        end,
    };
    let page = Found::Page(vec!["half of the samples".to_owned()], 0.5);
    update(&mut desk.app, Action::Studied(Box::new(part(page, None))));
    assert!(
        desk.shows("50 % solved") && desk.shows("half of the samples"),
        "{}",
        desk.screen()
    );
    let effects = asked(&mut desk, "Esc");
    assert!(
        effects
            .iter()
            .any(|effect| matches!(effect, Effect::CancelStudy))
    );
    update(
        &mut desk.app,
        Action::Studied(Box::new(part(Found::Nothing, Some(End::Stopped)))),
    );
    assert!(
        desk.shows("stopped") && desk.shows("half of the samples"),
        "{}",
        desk.screen()
    );
}

#[test]
fn a_hidden_study_is_not_computed_and_a_late_answer_is_left_out() {
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    desk.fill("operation.speed", "2100 rpm");
    assert!(desk.app.tab.study.asked.is_none());
    desk.keys(&["Esc", "6"]);
    let shown = desk.app.tab.study.shown.clone().expect("a study");
    let late = StudyPart {
        serial: shown.request.serial - 1,
        found: Found::Page(vec!["late".to_owned()], 1.0),
        end: None,
    };
    update(&mut desk.app, Action::Studied(Box::new(late)));
    assert!(
        desk.app
            .tab
            .study
            .shown
            .as_ref()
            .is_some_and(|shown| shown.page.is_empty())
    );
    desk.fill("operation.speed", "2 kg");
    assert_eq!(
        desk.app.tab.study.obstacle.as_deref(),
        Some("No study: a field has an error. Alt-E goes to that field.")
    );
}

#[test]
fn variant_keeps_the_edits_and_without_edits_shows_them_again() {
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    desk.fill("driven.tip_relief", "48 um")
        .keys(&["Esc", ":", "variant relieved", "Enter"]);
    assert!(
        desk.shows("variant relieved has 1 edit"),
        "{}",
        desk.screen()
    );
    assert_eq!(written(&desk, "driven.tip_relief"), "0 um");
    desk.keys(&["Ctrl-S"]);
    let saved = desk.read("case.toml");
    let added = "\n[variants.relieved]\n\"driven.tip_relief\" = \"48 um\"\n";
    assert_eq!(saved, format!("{TABLE_1}{added}"));
    desk.keys(&[":", "variant relieved", "Enter"]);
    assert_eq!(written(&desk, "driven.tip_relief"), "48 um");
    desk.keys(&["u", ":", "variant other", "Enter"]);
    assert!(
        desk.shows("no edit since the last save"),
        "{}",
        desk.screen()
    );
}

#[test]
fn variants_stand_beside_the_case_with_their_differences() {
    let variants = "\n[variants.relieved]\n\"driven.tip_relief\" = \"30 um\"\n[variants.far]\npair.centre_distance = \"200 mm\"\n";
    for (name, size) in [("80x24", SMALL), ("140x45", LARGE)] {
        let mut desk = Desk::on(size, "case.toml", &format!("{TABLE_1}{variants}"));
        desk.keys(&["Esc", "2", "v"]);
        assert!(
            desk.shows("relieved") && desk.shows("-40.1 %"),
            "{}",
            desk.screen()
        );
        assert_snapshot!(format!("variants_{name}"), desk.screen());
        for _ in 0..3 {
            if desk.app.first_variant.is_some() {
                desk.keys(&["v"]);
            }
        }
        assert_eq!(desk.app.first_variant, None);
    }
    let mut desk = Desk::on(SMALL, "case.toml", TABLE_1);
    desk.keys(&["Esc", "2", "v"]);
    assert!(desk.shows("the case has no variants"), "{}", desk.screen());
}
