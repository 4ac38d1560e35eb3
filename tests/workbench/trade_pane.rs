//! The trade pane: benchmark, stop, selection of a setting, and its use in the case.
use crate::harness::{self, Desk, LARGE, SMALL, TABLE_1, requested, results, time_evenly};

use insta::assert_snapshot;
use ratatui::layout::Size;
use tipstrike::model::inputs::Method;
use tipstrike::study::trade::Setting;
use tipstrike::tui::testing::{Action, Effect, Slot, update};

fn measured(size: Size) -> Desk {
    let mut desk = Desk::on(size, "case.toml", TABLE_1);
    desk.keys(&["Esc", "5", "z", "m"]);
    desk
}

fn own(desk: &Desk) -> Setting {
    Setting::of(&desk.app.tab.case.inputs().expect("a valid form"))
}

#[test]
fn m_measures_and_the_cheapest_that_will_do_is_marked() {
    let desk = measured(LARGE);
    let traded = desk.app.tab.traded.as_ref().expect("a measurement");
    assert_eq!(traded.marked.expect("a mark").method, Method::Dynamic);
    desk.assert_shows("Within 5.0 %: dynamic with");
    desk.has(&["◆ selected", "◇ case"]);
    assert!(desk.shows("p paper") && desk.shows("1 ms") && !desk.app.is_busy(Slot::Benchmark));
}

#[test]
fn arrows_select_from_the_fastest_to_the_slowest() {
    let mut desk = measured(LARGE);
    let seconds = |desk: &Desk| {
        let traded = desk.app.tab.traded.as_ref().unwrap();
        let mut settings = traded.trade.as_ref().unwrap().settings.iter();
        settings.find(|one| Some(one.setting) == traded.marked).unwrap().seconds()
    };
    desk.keys(&["Left"; 100]);
    let mut last = seconds(&desk);
    for _ in 0..10 {
        desk.keys(&["l"]);
        assert!(seconds(&desk) >= last);
        last = seconds(&desk);
    }
    desk.assert_shows("not within 5.0 %");
}

#[test]
fn enter_uses_the_selected_setting_and_undo_reverts_it() {
    let mut desk = measured(LARGE);
    let (before, traded) = (own(&desk), desk.app.tab.traded.as_ref().unwrap());
    let mut all = traded.trade.as_ref().unwrap().settings.iter().map(|one| one.setting);
    let beam = all.find(|one| one.to_string() == "static with beam and weber, 64 stations");
    for marked in [traded.marked, beam].map(Option::unwrap) {
        desk.app.tab.traded.as_mut().unwrap().marked = Some(marked);
        desk.keys(&["Enter"]).assert_shows(&format!("method {marked}; Ctrl-Z undoes"));
        assert_eq!(own(&desk), marked);
        assert_eq!(desk.app.tab.answer.as_ref().unwrap().active, marked.method);
        assert!(!desk.shows("OUTDATED"), "a setting makes no other case");
        desk.keys(&["u"]);
        assert_eq!(own(&desk), before);
    }
}

#[test]
fn another_case_makes_the_benchmark_outdated() {
    let mut desk = measured(LARGE);
    desk.keys(&["z"]);
    desk.fill("operation.speed", "1500 rpm");
    desk.keys(&["Esc", "5", "z"]).assert_shows("OUTDATED, m runs it again");
    desk.keys(&["m"]).lacks(&["OUTDATED"]);
}

/// The settings that are measured so far.
fn count(desk: &Desk) -> usize {
    let trade = desk.app.tab.traded.as_ref().and_then(|traded| traded.trade.as_ref());
    trade.map_or(0, |trade| trade.settings.len())
}

#[test]
fn esc_stops_a_benchmark_and_keeps_its_results() {
    let mut desk = Desk::new(LARGE);
    desk.keys(&["Esc", "5", "z"]);
    let (number, work) = requested(desk.effects("m"), Slot::Benchmark).expect("a benchmark");
    desk.assert_shows("0 % measuring; Esc cancels");
    let mut all = results(number, work).into_iter();
    all.by_ref().take(4).for_each(|action| desk.act(action));
    assert_eq!(count(&desk), 3);
    assert!(matches!(desk.effects("Esc")[..], [Effect::Cancel(Slot::Benchmark)]));
    desk.assert_shows("the benchmark is stopped").lacks(&["measuring"]);
    all.for_each(|action| desk.act(action));
    assert_eq!(count(&desk), 3, "a late result is ignored");
}

#[test]
fn a_measurement_out_of_sight_stops() {
    let stops = |effects: &[Effect]| {
        effects.iter().any(|effect| matches!(effect, Effect::Cancel(Slot::Benchmark)))
    };
    let mut desk = Desk::new(SMALL);
    desk.keys(&["Esc", "5"]);
    desk.effects("m");
    for size in [Size::new(20, 5), SMALL] {
        let effects = update(&mut desk.app, Action::Resize(size));
        assert!(!stops(&effects), "a briefly too small window does not stop the benchmark");
    }
    assert!(!stops(&desk.effects("2")), "it is in sight");
    assert!(stops(&desk.effects("3")), "the chart replaces it");
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    desk.keys(&["Alt-T", "Esc", "5"]);
    desk.effects("m");
    desk.keys(&["Alt-W"]);
    desk.assert(desk.has_cancelled && !desk.shows("measuring"));
}

#[test]
fn the_results_of_a_replaced_benchmark_are_ignored_and_a_refusal_is_shown() {
    let mut desk = Desk::new(LARGE);
    desk.keys(&["Esc", "5", "z"]);
    let (number, work) = requested(desk.effects("m"), Slot::Benchmark).expect("a benchmark");
    assert!(requested(desk.effects("m"), Slot::Benchmark).is_some());
    desk.take(results(number, work));
    assert!(count(&desk) == 0 && desk.shows("measuring"), "the second one runs");
    desk.fill("pair.centre_distance", "10 mm").keys(&["Esc", "5", "m"]);
    desk.assert_shows("no benchmark: ").lacks(&["measuring"]);
    desk.fill("pair.module", "x").keys(&["Esc", "5"]);
    assert!(desk.effects("m").is_empty());
    desk.assert_shows("no benchmark: fix the fields");
}

fn timed(size: Size) -> Desk {
    let mut desk = measured(size);
    time_evenly(&mut desk);
    let trade = desk.app.tab.traded.as_mut().and_then(|traded| traded.trade.as_mut());
    trade.expect("it is whole").build = Ok([12e-3, 15e-3]);
    desk.app.message = None;
    desk
}

#[test]
fn the_pane_as_it_looks() {
    for (name, size) in [("80x24", SMALL), ("140x45", LARGE)] {
        let desk = timed(size);
        assert_snapshot!(format!("alone_{name}"), desk.screen());
    }
    let mut desk = timed(SMALL);
    harness::assert_ascii(&mut desk);
    harness::assert_ascii(desk.keys(&["z"]));
}

#[test]
fn v_shows_every_method_with_every_compliance_as_a_table() {
    for (name, size) in [("80x24", SMALL), ("140x45", LARGE)] {
        let mut desk = timed(size);
        desk.keys(&["v"]).assert_shows("* kuang-yang logarithmic");
        desk.assert_shows(" finite-element");
        assert_snapshot!(format!("table_{name}"), desk.screen());
        desk.keys(&["v"]).assert_shows("└");
    }
}
