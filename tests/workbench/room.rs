//! Room on the screen: titles, panes alone, rows on a small screen, aligned columns.
use crate::harness;

use harness::{Desk, LARGE, SMALL, TABLE_1};
use ratatui::layout::Size;
use tipstrike::report::stations::GRAPHS;
use tipstrike::tui::testing::chart::curves::{self, CurveSource};

const HYDRO: &str = include_str!("../../cases/hydro-speed-up.toml");
const TINY: Size = Size { width: 60, height: 16 };
const SPREAD: &str = "\n[spread]\n\"deviations.base_pitch\" = { normal = \"2 um\" }\n";

/// The example with another method.
fn hydro(size: Size, method: &str) -> Desk {
    let text = HYDRO.replace("method = \"exact\"", &format!("method = \"{method}\""));
    Desk::on(size, "case.toml", &text)
}

/// The title of the focused pane, from its number to the rule.
fn title(desk: &Desk, pane: &str) -> String {
    let screen = desk.screen();
    let start = format!("▸ {pane} ");
    let found = screen.lines().find_map(|line| line.split_once(&start));
    let (_, title) = found.expect("a focused pane");
    let end = title.find(" ─").unwrap_or(title.len());
    title[..end].to_owned()
}

#[test]
fn a_pane_alone_has_no_poorer_title() {
    for size in [SMALL, Size::new(100, 30), LARGE] {
        for pane in ["2", "3", "4", "5", "6"] {
            for charts in 0..if pane == "3" { GRAPHS.len() } else { 1 } {
                let mut desk = Desk::on(size, "case.toml", TABLE_1);
                desk.keys(&["Esc", pane]).keys(&vec!["j"; charts]);
                let among = title(&desk, pane);
                desk.keys(&["z"]);
                let alone = title(&desk, pane);
                // The unit of the x axis is also below the corner of its axes.
                let is_cut = alone.contains('…') && !alone.contains(" over ");
                let is_poorer = pane != "2"
                    && !among.contains('…')
                    && alone.chars().count()
                        < among.split("  ").next().unwrap_or_default().chars().count();
                assert!(!is_cut && !is_poorer, "{size}: {among:?}, alone {alone:?}");
            }
        }
    }
}

#[test]
fn a_pane_alone_leaves_no_other_in_sight() {
    for size in [TINY, SMALL, LARGE] {
        let mut desk = Desk::on(size, "case.toml", TABLE_1);
        desk.keys(&["Esc", "2", "z"]);
        desk.assert_shows("Corner contact ");
        desk.assert(!desk.shows("title Zhou"));
        desk.keys(&["1"]);
        desk.assert_shows("title Zhou");
        desk.assert(!desk.shows("Corner contact "));
        desk.keys(&["z"]);
        assert!(desk.shows("title Zhou") && desk.shows("orner contact "));
    }
}

#[test]
fn no_title_is_cut_for_names_that_have_no_room() {
    for keys in [&[][..], &["Esc"]] {
        let mut desk = Desk::on(TINY, "case.toml", TABLE_1);
        desk.keys(keys);
        desk.assert_shows("2 Results 1");
    }
}

#[test]
fn a_small_screen_shows_twelve_quantities_and_counts_the_hidden_lines() {
    for method in ["paper", "exact", "static", "dynamic"] {
        let text = TABLE_1.replace("method = \"exact\"", &format!("method = \"{method}\""));
        let desk = Desk::on(SMALL, "case.toml", &text);
        let rows = desk.app.results().page();
        assert!(rows >= 12, "{method}: {rows}\n{}", desk.screen());
        for size in [TINY, SMALL] {
            let desk = hydro(size, method);
            let rows = desk.app.results().page();
            assert!(rows >= 4, "{size} {method}: {rows}\n{}", desk.screen());
        }
    }
    let mut desk = hydro(SMALL, "static");
    desk.assert_shows("notes (Esc n)");
    desk.keys(&["Esc", "n"]);
    desk.assert_shows("tip relief on the");
}

#[test]
fn the_stiffness_model_of_the_case_is_drawn_on_top() {
    for model in ["kuang-yang", "beam", "finite-element"] {
        let from = "tooth_compliance = \"kuang-yang\"";
        let text = TABLE_1.replace(from, &format!("tooth_compliance = \"{model}\""));
        let mut desk = Desk::on(SMALL, "case.toml", &text);
        desk.keys(&["Esc", ":", "mesh stiff", "Enter"]);
        let graph = GRAPHS.iter().find(|graph| graph.by_model.is_some());
        let curves = curves::curves(&desk.app.charts(), graph.expect("a chart"));
        let top = curves.last().expect("a curve").source;
        assert!(matches!(top, CurveSource::Model { is_own: true, .. }), "{top:?}");
    }
}

#[test]
fn a_map_fills_its_pane_and_has_a_legend_on_a_small_screen() {
    for size in [SMALL, LARGE] {
        let mut desk = Desk::on(size, "case.toml", TABLE_1);
        desk.go_to("driven.tip_relief");
        desk.keys(&["Esc", "6", "s", "operation.speed", "Enter"]);
        desk.assert_shows("+ limit 2500");
        let screen = desk.screen();
        let from = screen.find("6 Study").expect("the pane");
        let mut lines = screen[from..].lines();
        let axis = lines.find(|line| line.trim_start().starts_with('└'));
        let pane = if size == SMALL { 80 } else { 84 };
        let cells = axis.expect("an axis").matches(['─', '┴', '▴']).count();
        assert!(cells + 10 >= pane, "{cells}: {screen}");
    }
}

#[test]
fn the_tolerance_shows_its_figures_first_and_how_to_scroll() {
    let mut desk = Desk::on(SMALL, "case.toml", &format!("{TABLE_1}{SPREAD}"));
    desk.keys(&["Esc", "6", "d"]);
    desk.assert_shows("Tolerance 1 to ");
    desk.assert_shows("corner contact         100.00 %");
    desk.assert_shows("j scroll  l next page");
    desk.assert(!desk.shows("narrower"));
    desk.keys(&["PageDown", "PageDown"]);
    desk.assert_shows(" | █");
    desk.assert_shows("Tolerance 13 to ");
    desk.keys(&["h", "h"]);
    desk.assert_shows("Tolerance 1 to ");
    desk.keys(&["l"; 20]);
    let spread = "deviations.base_pitch  16 um";
    desk.assert_shows(spread);
}

#[test]
fn with_inch_units_a_study_is_in_inches() {
    let mut desk = Desk::on(LARGE, "case.toml", TABLE_1);
    desk.go_to("pair.module");
    desk.keys(&["Esc", "6", ":", "units", "Enter"]);
    desk.assert_shows("over module in in");
    desk.assert_shows("m = 0.19685 in:");
    desk.keys(&["l", "Enter"]);
    let text = desk.app.tab.case.text(tipstrike::case::fields::index_of("pair.module").unwrap());
    assert!(text.is_some_and(|text| text.ends_with(" in")), "{text:?}");
}

#[test]
fn the_descriptions_of_commands_line_up() {
    for size in [SMALL, LARGE] {
        let mut desk = Desk::on(size, "case.toml", TABLE_1);
        desk.keys(&["Esc", ":", "chart: "]);
        let screen = desk.screen();
        let charts = screen.lines().filter(|line| line.contains("  chart: "));
        let columns: Vec<Option<usize>> = charts
            .map(|line| line.split_once("Show ").map(|(before, _)| before.chars().count()))
            .collect();
        assert!(columns.len() > 5, "{screen}");
        assert!(columns.iter().all(|column| *column == columns[0]), "{screen}");
    }
}

#[test]
fn the_values_under_the_teeth_keep_their_places_while_the_cursor_moves() {
    let mut desk = hydro(SMALL, "dynamic");
    desk.keys(&["Esc", "4", "z", "Home"]);
    let place = |desk: &Desk| {
        let screen = desk.screen();
        let found = |name: &str| {
            let mut lines = screen.lines().enumerate();
            lines.find_map(|(row, line)| Some((row, line.find(name)?)))
        };
        [" ΔV_n ", " ΔV_τ ", " open "].map(found)
    };
    let first = place(&desk);
    desk.assert(first.iter().all(Option::is_some));
    for _ in 0..25 {
        desk.keys(&["l"]);
        let rows = place(&desk).map(|place| place.map(|(row, _)| row));
        let before = first.map(|place| place.map(|(row, _)| row));
        assert_eq!(rows, before, "{}", desk.screen());
    }
}

#[test]
fn the_values_of_a_chart_at_the_cursor_have_one_unit() {
    let mut desk = hydro(LARGE, "dynamic");
    desk.keys(&["Esc", "3", "Home"]);
    for _ in 0..20 {
        desk.keys(&["l"]);
        let screen = desk.screen();
        let line = screen.lines().rfind(|line| line.contains(" before E: "));
        let (_, values) = line.and_then(|line| line.split_once(": ")).expect("a readout");
        let forces = values.split(';').next().unwrap_or_default();
        let units: Vec<bool> = forces.split(", ").map(|value| value.ends_with(" kN")).collect();
        assert!(units.len() > 1, "{screen}");
        assert!(units.iter().all(|unit| *unit == units[0]), "{line:?}");
    }
}
