//! The charts: each as it looks, each of their keys, what they promise over random cases, and the
//! bytes that they cost.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    reason = "a test that cannot go on says why"
)]
#![allow(clippy::print_stdout, reason = "figures are told")]
#![cfg(feature = "tui")]

mod harness;

use std::fs;

use harness::{Desk, LARGE, SMALL, TABLE_1};
use insta::assert_snapshot;
use proptest::prelude::*;
use ratatui::backend::{Backend, CrosstermBackend};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use tipstrike::case::units::System;
use tipstrike::model::{ContactState, Outcome};
use tipstrike::report::graphs::GRAPHS;
use tipstrike::tui::actions::Action;
use tipstrike::tui::layout;
use tipstrike::tui::pane::Pane;
use tipstrike::tui::solver::Answer;
use tipstrike::tui::theme::{Look, MONO};
use tipstrike::tui::view::chart;
use tipstrike::tui::view::teeth::readings::readings;
use tipstrike::tui::window::Frame;

const HUGE: Size = Size {
    width: 240,
    height: 70,
};
const MIDDLE: Size = Size {
    width: 120,
    height: 40,
};
const TINY: Size = Size {
    width: 60,
    height: 16,
};

/// Table 1 at a method, the chart focused.
fn at_method(size: Size, method: &str) -> Desk {
    let mut desk = Desk::on(
        size,
        "case.toml",
        &TABLE_1.replace("\"exact\"", &format!("\"{method}\"")),
    );
    // The first picture may not wait for a slow method.
    desk.fill("title", "a");
    desk.keys(&["Esc", "3"]);
    desk
}

fn chart_area(desk: &Desk) -> Rect {
    layout::plan(desk.app.size, desk.app.panes).area(Pane::Chart)
}

/// The lines of the chart's pane.
fn chart(desk: &Desk) -> Vec<String> {
    let area = chart_area(desk);
    let buffer = desk.buffer(desk.app.size);
    let cell = |x, y| buffer.cell((x, y)).map_or(" ", |cell| cell.symbol());
    area.rows()
        .map(|row| {
            row.columns()
                .map(|at| cell(at.x, at.y))
                .collect::<String>()
                .trim_end()
                .to_owned()
        })
        .collect()
}

/// Every chart of the method, one below the other.
fn album(desk: &mut Desk) -> String {
    let mut pages = Vec::new();
    for _ in 0..GRAPHS.len() {
        pages.extend(chart(desk));
        desk.keys(&["j"]);
    }
    pages.join("\n")
}

#[test]
fn a_chart_that_comes_in_sight_while_a_field_is_wrong_says_so() {
    let mut desk = Desk::on(TINY, "case.toml", TABLE_1);
    desk.keys(&["x", "Esc", "3"]);
    let text = chart(&desk).join("\n");
    assert!(
        text.contains("LAST VALID")
            && text.contains("Nothing is drawn anew while a field is wrong."),
        "{text}"
    );
}

#[test]
fn every_chart() {
    for method in ["exact", "static", "dynamic"] {
        assert_snapshot!(
            format!("{method}_80x24"),
            album(&mut at_method(SMALL, method))
        );
    }
    assert_snapshot!("dynamic_140x45", album(&mut at_method(LARGE, "dynamic")));
    let mut desk = at_method(SMALL, "dynamic");
    desk.app.look = Look {
        theme: &MONO,
        ascii: true,
    };
    assert_snapshot!("dynamic_ascii", album(desk.keys(&["l"])));
    let mut huge = at_method(HUGE, "static");
    assert_snapshot!(
        "static_240x70",
        chart(huge.keys(&["b", "v", "l"])).join("\n")
    );
}

#[test]
fn charts_are_walked_through_and_chosen_by_name_and_the_choice_is_kept() {
    let mut desk = at_method(SMALL, "static");
    for graph in GRAPHS.iter().chain([&GRAPHS[0]]) {
        assert!(
            desk.shows(&format!("3 {} ", graph.label)),
            "{}\n{}",
            graph.label,
            desk.screen()
        );
        desk.keys(&["j"]);
    }
    desk.keys(&["Up", "k"]);
    assert!(desk.shows("3 Driver radius"), "round and round");
    for graph in &GRAPHS {
        desk.keys(&[
            "1",
            ":",
            "chart: ",
            &graph.label.to_lowercase(),
            "Enter",
            "3",
        ]);
        assert!(
            desk.shows(&format!("3 {} ", graph.label)),
            "{}",
            desk.screen()
        );
    }
    assert_eq!(
        desk.kept, None,
        "which chart is looked at is no setting: a session begins with the force"
    );
}

#[test]
fn a_method_without_the_curve_says_so() {
    let mut desk = at_method(SMALL, "exact");
    desk.keys(&[":", "chart: load", "Enter"]);
    assert!(desk.shows("The method exact has no load share: static and dynamic do."));
    let mut desk = at_method(SMALL, "static");
    desk.keys(&[":", "chart: impact", "Enter"]);
    assert!(
        desk.shows("The method static has no impact energy: paper and exact do."),
        "{}",
        desk.screen()
    );
    assert!(desk.shows("∘"), "those of the others are drawn");
}

#[test]
fn the_axis_goes_on_to_the_last_contact_where_the_method_does() {
    for (method, ends) in [("exact", false), ("static", true), ("dynamic", true)] {
        let desk = at_method(SMALL, method);
        let axis = chart(&desk)
            .into_iter()
            .find(|line| line.contains('└'))
            .expect("an axis");
        assert!(axis.contains('D') && axis.contains('E'), "{axis}");
        assert_eq!(
            (axis.contains('B'), axis.contains('L')),
            (ends, ends),
            "{axis}"
        );
        assert_eq!(desk.app.scale.across.to > 0.0, ends);
    }
}

#[test]
fn the_cursor_walks_beyond_e_and_every_value_is_read_off() {
    let mut desk = at_method(SMALL, "dynamic");
    desk.keys(&["End", "L"]);
    let cursor = desk.app.cursor.expect("a cursor");
    assert!(
        cursor < 0.0 && desk.shows("deg of the driver after E: F "),
        "{}",
        desk.screen()
    );
    for symbol in ["S ", "ΔV_τ ", "F/ΣF ", "q_s ", "x "] {
        assert!(desk.shows(symbol), "{symbol}\n{}", desk.screen());
    }
    desk.keys(&["L"; 9]);
    let end = desk.app.cursor.expect("a cursor");
    desk.keys(&["L"]);
    assert_eq!(desk.app.cursor, Some(end), "the axis has its end");
    desk.keys(&["4"]);
    assert!(desk.shows("after E"), "the teeth stand there as well");
    let mut desk = at_method(SMALL, "static");
    desk.keys(&["v", "Home", "LL"]);
    assert!(
        desk.shows(" N, exact "),
        "every curve in sight is read off\n{}",
        desk.screen()
    );
}

#[test]
fn a_click_points_where_it_is_drawn() {
    let mut desk = at_method(SMALL, "static");
    let area = chart_area(&desk);
    for x in [8, 9, 40, 78] {
        desk.act(Action::Click(Position::new(x, area.y + 2)));
        let axis = area.bottom() - 2;
        assert_eq!(
            desk.buffer(SMALL)
                .cell((x, axis))
                .map(|cell| cell.symbol().to_owned())
                .as_deref(),
            Some("▴"),
            "{x}"
        );
    }
}

#[test]
fn zoom_goes_to_the_strike_around_the_cursor_and_back_to_the_whole() {
    let mut desk = at_method(SMALL, "static");
    let (whole, window) = (chart(&desk), |desk: &Desk| {
        desk.app.chart.window(&desk.app.scale)
    });
    let all = window(&desk);
    desk.keys(&["v"]);
    let strike = window(&desk);
    assert!(
        strike.length() < 0.2 * all.length() && strike.from < -1.25 && strike.to > 0.0,
        "{strike:?}"
    );
    desk.keys(&["v"]);
    assert_eq!(window(&desk), all);
    desk.keys(&["End", "++"]);
    assert!(
        (window(&desk).length() / all.length() - 0.5).abs() < 1e-9 && window(&desk).covers(strike),
        "around E"
    );
    desk.keys(&["-"]);
    assert!(window(&desk).length() < all.length());
    desk.keys(&["0", "c"]);
    assert_eq!(chart(&desk), whole);
    assert!(desk.keys(&["-"]).shows("the whole range is visible"));
    desk.act(Action::Wheel(
        Position::new(20, chart_area(&desk).y + 2),
        -3,
    ));
    assert!(window(&desk).length() < all.length(), "the wheel zooms");
    desk.keys(&["+"; 30]);
    assert!(desk.shows("the zoom is at its maximum"));
}

#[test]
fn what_is_in_sight_follows_the_cursor() {
    let mut desk = at_method(SMALL, "static");
    desk.keys(&["v", "End"]);
    for _ in 0..12 {
        desk.keys(&["L"]);
        let window = desk.app.chart.window(&desk.app.scale);
        let x = -desk.app.cursor.expect("a cursor").to_degrees();
        assert!((window.from..=window.to).contains(&x), "{x} {window:?}");
    }
    assert!(
        desk.app.chart.frame == Frame::Strike
            && desk.app.cursor.is_some_and(|cursor| cursor < -0.01)
    );
}

#[test]
fn the_time_axis_tells_the_same_curve_in_time() {
    let mut desk = at_method(SMALL, "dynamic");
    let angle = chart(&desk);
    desk.keys(&["t"]);
    let time = chart(&desk);
    assert!(
        time[0].contains("over time in us") && angle[0].contains("over roll angle in deg"),
        "{}",
        time[0]
    );
    assert_eq!(
        angle[1..angle.len() - 2],
        time[1..time.len() - 2],
        "the curves stay where they are"
    );
    desk.keys(&["l"]);
    assert!(desk.shows(" us: F "), "{}", desk.screen());
    assert_eq!(desk.kept, None, "a way to look at it is no setting");
    desk.keys(&["c", "t"]);
    assert_eq!(chart(&desk), angle);
}

#[test]
fn pinned_results_and_the_present_ones_are_in_sight_from_end_to_end() {
    for method in ["paper", "exact", "static", "dynamic"] {
        for relief in ["46 um", "48 um", "80 um"] {
            let mut desk = at_method(SMALL, method);
            desk.keys(&["b"]);
            let pinned = desk.app.scale;
            desk.fill("driven.tip_relief", relief);
            for frame in [Frame::Whole, Frame::Strike] {
                let window = desk.app.chart.window(&desk.app.scale);
                let solution = |answer: &Answer| answer.of(answer.active).expect("solved").clone();
                let baseline = solution(&desk.app.baseline.as_ref().expect("pinned").answer);
                let now = solution(desk.app.answer.as_ref().expect("solved"));
                for first in [&baseline, &now]
                    .into_iter()
                    .filter_map(chart::first_contact)
                {
                    assert!(
                        window.from <= -first.to_degrees(),
                        "{method} {relief} {frame:?}: {window:?} {first}"
                    );
                }
                desk.keys(&["Esc", "3", "v"]);
            }
            // Of pinned results of the method paper the other method, which drew the axis, is not
            // drawn.
            assert!(
                method == "paper" || desk.app.scale.across == pinned.across,
                "{method} {relief}: the axis stays as long as it serves"
            );
        }
    }
}

#[test]
fn the_readout_and_the_teeth_tell_the_same_numbers() {
    for method in ["paper", "exact", "static", "dynamic"] {
        let mut desk = at_method(LARGE, method);
        desk.keys(&["Home", "lllll"]);
        for _ in 0..6 {
            desk.keys(&["l"]);
            let angle = desk.app.cursor.expect("a cursor");
            let answer = desk.app.answer.as_ref().expect("solved");
            let solved = (&answer.inputs, answer.of(answer.active).expect("solved"));
            let moment = ContactState::at(solved.0, solved.1, angle).expect("in sight");
            let said = chart::readout(&desk.app, angle);
            let told = |symbol| {
                readings(&moment, solved, System::Metric)
                    .into_iter()
                    .find(|reading| reading.symbol == symbol && reading.number.is_some())
                    .map(|one| one.to_string())
            };
            for symbol in ["F_S", "F", "S", "ΔV_n", "ΔV_τ", "x", "F/ΣF", "q_s", "E_k"] {
                if let Some(told) = told(symbol) {
                    let alone = format!(" {told}");
                    let same = said
                        .split([':', ',', ';'])
                        .any(|part| part.trim_end_matches('.') == alone);
                    assert!(same, "{method}: {told} in {said}");
                }
            }
            assert!(
                told("S").is_some() && (told("F_S").is_some() || told("F").is_some()),
                "{method}"
            );
        }
    }
}

#[test]
fn a_run_goes_on_to_the_last_contact() {
    let mut desk = at_method(SMALL, "static");
    desk.keys(&["Space"]);
    let runs = (0..200).take_while(|_| {
        desk.act(Action::Tick);
        desk.ticks
    });
    assert!((40..60).contains(&runs.count()));
    let last = desk.app.cursor.expect("a cursor");
    assert!(last < -0.4 && !desk.app.is_playing, "{last}");
}

#[test]
fn the_baseline_stands_behind_in_the_same_chart() {
    let mut desk = at_method(SMALL, "static");
    desk.keys(&["b", "1"]).fill("operation.power", "12 kW");
    desk.keys(&["Esc", "3"]);
    for _ in 0..3 {
        assert!(desk.shows("+ baseline"), "{}", desk.screen());
        desk.keys(&["j", "j"]);
    }
    desk.keys(&["jjj", "l", "L"]);
    assert!(desk.shows("baseline "), "{}", desk.screen());
}

#[test]
fn as_many_charts_as_have_room_stand_below_each_other() {
    let desk = at_method(HUGE, "static");
    let lines = chart(&desk).join("\n");
    assert!(
        lines.contains("3 Force F in N over roll angle before E in deg")
            && lines.contains("─ Gap S in um"),
        "{lines}"
    );
    let mut desk = at_method(LARGE, "exact");
    assert!(!desk.shows("─ Gap S in um"));
    desk.keys(&["z"]);
    assert!(desk.shows("─ Gap S in um"), "{}", desk.screen());
}

#[test]
fn a_chart_out_of_sight_costs_nothing() {
    let mut desk = Desk::new(SMALL);
    desk.keys(&["F5"]);
    let fitted = desk.app.scale;
    desk.fill("operation.speed", "9000 rpm");
    assert_eq!(desk.app.scale, fitted, "no curve is looked at");
    assert!(
        !desk
            .app
            .answer
            .as_ref()
            .expect("results")
            .methods
            .iter()
            .any(|(method, _)| method.shares_load())
    );
    desk.keys(&["Esc", "3"]);
    assert_ne!(desk.app.scale, fitted);
}

/// The numbers on the axes of a chart as they stand on the screen: below it, and beside it.
fn labels(desk: &Desk) -> (Vec<f64>, Vec<f64>) {
    let lines = chart(desk);
    let Some(axis) = lines.iter().position(|line| line.contains('└')) else {
        return (Vec::new(), Vec::new());
    };
    let number = |text: &str| {
        text.parse::<f64>()
            .unwrap_or_else(|_| panic!("{text} is no number\n{}", desk.screen()))
    };
    let below = lines
        .get(axis + 1)
        .map_or("", String::as_str)
        .split_whitespace()
        .map(number)
        .collect();
    let beside = lines[..axis]
        .iter()
        .filter_map(|line| line.split_once('┤'))
        .map(|(label, _)| number(label.trim()));
    (below, beside.collect())
}

fn assert_round(numbers: &[f64], desk: &Desk) {
    let steps: Vec<f64> = numbers
        .windows(2)
        .map(|pair| (pair[1] - pair[0]).abs())
        .collect();
    for step in &steps {
        let digit = step / 10f64.powf((step * (1.0 + 1e-6)).log10().floor());
        assert!(
            [1.0, 2.0, 5.0]
                .iter()
                .any(|round| (digit - round).abs() < 1e-6),
            "{numbers:?}\n{}",
            desk.screen()
        );
        assert!(
            (step - steps[0]).abs() < 1e-6 * step,
            "{numbers:?}\n{}",
            desk.screen()
        );
    }
}

/// Every chart at some sizes: nothing panics, no number is none, ticks are round and each has a
/// label of its own.
fn assert_charts(desk: &mut Desk) {
    desk.keys(&["Esc", "3"]);
    for (size, keys) in [(SMALL, "0"), (TINY, "v"), (LARGE, "+"), (HUGE, "t")] {
        desk.act(Action::Resize(size));
        desk.keys(&[keys, "l"]);
        for _ in &GRAPHS {
            let screen = desk.screen();
            assert!(
                !["NaN", "inf ", "n/a"]
                    .iter()
                    .any(|none| screen.contains(none)),
                "{screen}"
            );
            if size.height < HUGE.height {
                let (below, beside) = labels(desk);
                assert_round(&below, desk);
                assert_round(&beside, desk);
            }
            desk.keys(&["j"]);
        }
    }
    desk.act(Action::Resize(SMALL));
}

#[test]
fn every_case_of_the_collection_is_drawn_at_every_method() {
    for entry in fs::read_dir(concat!(env!("CARGO_MANIFEST_DIR"), "/cases"))
        .expect("the cases")
        .flatten()
    {
        let path = entry.path();
        if path.extension().is_none_or(|ending| ending != "toml") {
            continue;
        }
        let mut desk = Desk::on(
            SMALL,
            "case.toml",
            &fs::read_to_string(&path).expect("a case"),
        );
        for _ in 0..4 {
            desk.keys(&["Ctrl-T"]);
            assert_charts(&mut desk);
            let solution = desk
                .app
                .answer
                .as_ref()
                .and_then(|answer| answer.of(answer.active))
                .expect("results");
            let (method, strikes) = (solution.method, solution.outcome == Outcome::CornerContact);
            let is_drawn = chart(desk.keys(&[":", "chart: force", "Enter", "0"]))
                .iter()
                .any(|line| line.contains('└'));
            assert!(is_drawn || !strikes, "{} {:?}", path.display(), method);
        }
    }
}

#[test]
fn random_cases_are_drawn() {
    let sizes = (12..150u32, 12..150u32, -1.3..1.69f64, -9.0..-3.5f64);
    let loads = (0.0..6.0f64, 0.0..4.5f64, 0..3usize);
    let config = ProptestConfig {
        cases: 24,
        failure_persistence: None,
        ..ProptestConfig::default()
    };
    proptest!(config, |((z1, z2, module, deviation) in sizes, (power, speed, method) in loads)| {
        let text = TABLE_1
            .replacen("teeth = 20", &format!("teeth = {z1}"), 1)
            .replacen("teeth = 20", &format!("teeth = {z2}"), 1)
            .replace("\"5 mm\"", &format!("\"{:e} mm\"", 10f64.powf(module)))
            .replace("\"16 um\"", &format!("\"{:e} mm\"", 10f64.powf(deviation + 3.0)))
            .replace("bore_radius = \"20 mm\"\n", "")
            .replace("deflection =", "# deflection =")
            .replace("\"15 kW\"", &format!("\"{:e} W\"", 10f64.powf(power)))
            .replace("\"2000 rpm\"", &format!("\"{:e} rpm\"", 10f64.powf(speed)))
            .replace("method = \"exact\"", &format!("method = \"{}\"", ["paper", "exact", "static"][method]));
        assert_charts(&mut Desk::on(SMALL, "case.toml", &text));
    });
}

/// The bytes with which a terminal goes from one picture of the chart to the next.
fn bytes(before: &Buffer, after: &Buffer, area: Rect) -> usize {
    let mut written = Vec::new();
    let changes = before
        .diff(after)
        .into_iter()
        .filter(|(x, y, _)| area.contains(Position::new(*x, *y)));
    CrosstermBackend::new(&mut written)
        .draw(changes)
        .expect("room in memory");
    written.len()
}

/// The bytes of the chart for one key.
fn cost(desk: &mut Desk, key: &str) -> usize {
    let before = desk.buffer(desk.app.size);
    desk.keys(&[key]);
    bytes(&before, &desk.buffer(desk.app.size), chart_area(desk))
}

#[test]
fn a_chart_costs_few_bytes_a_key() {
    for (size, most) in [(SMALL, 1400), (MIDDLE, 3000)] {
        let mut all = Vec::new();
        for (method, graph) in ["exact", "static", "dynamic"]
            .iter()
            .flat_map(|method| (0..GRAPHS.len()).map(move |graph| (method, graph)))
        {
            let mut desk = at_method(size, method);
            desk.app.graph = graph;
            for (field, unit, digits) in [
                ("operation.speed", " rpm", "2123.4567"),
                ("deviations.base_pitch", " um", "16.54321"),
                ("operation.power", " kW", "15.01234"),
            ] {
                desk.fill(field, unit).keys(&["Home"]);
                let keys = digits
                    .chars()
                    .map(|digit| digit.to_string())
                    .chain(["Backspace".to_owned()]);
                all.extend(keys.map(|key| cost(&mut desk, &key)));
            }
            desk.keys(&["Esc", "3", "l"]);
            all.extend(
                ["l"; 12]
                    .into_iter()
                    .chain(["L"])
                    .map(|key| cost(&mut desk, key)),
            );
        }
        all.sort_unstable();
        let late = all[all.len() * 95 / 100];
        println!(
            "chart at {size}: median {} bytes, 95 % {late}, most {}",
            all[all.len() / 2],
            all[all.len() - 1]
        );
        assert!(late <= most, "{late} bytes at {size}");
    }
}
