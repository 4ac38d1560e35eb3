//! The charts: snapshots, keys, properties over random cases, and bytes written per key.
use crate::harness::{Desk, LARGE, SMALL, TABLE_1, requested, results};

use insta::assert_snapshot;
use proptest::prelude::*;
use ratatui::backend::{Backend, CrosstermBackend};
use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use tipstrike::case::EXAMPLES;
use tipstrike::case::units::System;
use tipstrike::model::solve::speeds;
use tipstrike::model::{ContactState, Outcome};
use tipstrike::report::charts::speed_chart;
use tipstrike::report::stations::{GRAPHS, Graph};
use tipstrike::tui::testing::chart::curves;
use tipstrike::tui::testing::teeth::readings;
use tipstrike::tui::testing::{
    Action, Answer, ChartRequest, CurveSource, Look, MONO, Pane, Slot, chart,
};

const HUGE: Size = Size { width: 240, height: 70 };
const MIDDLE: Size = Size { width: 120, height: 40 };
const TINY: Size = Size { width: 60, height: 16 };

/// Table 1 with a method, the chart pane focused.
fn at_method(size: Size, method: &str) -> Desk {
    let mut desk =
        Desk::on(size, "case.toml", &TABLE_1.replace("\"exact\"", &format!("\"{method}\"")));
    // The first frame does not wait for a slow method; an edit starts it.
    desk.fill("title", "a");
    desk.keys(&["Esc", "3"]);
    desk
}

fn chart_area(desk: &Desk) -> Rect {
    desk.app.layout.plan().area(Pane::Chart)
}

/// The lines of the chart pane.
fn chart(desk: &Desk) -> Vec<String> {
    let area = chart_area(desk);
    let buffer = desk.buffer();
    let cell = |x, y| buffer.cell((x, y)).map_or(" ", |cell| cell.symbol());
    let text = |row: Rect| row.columns().map(|at| cell(at.x, at.y)).collect::<String>();
    area.rows().map(|row| text(row).trim_end().to_owned()).collect()
}

/// Every chart of the method, one after the other.
fn album(desk: &mut Desk) -> String {
    let mut pages = Vec::new();
    for _ in 0..GRAPHS.len() {
        pages.extend(chart(desk));
        desk.keys(&["j"]);
    }
    pages.join("\n")
}

#[test]
fn every_chart() {
    assert_snapshot!("dynamic_80x24", album(&mut at_method(SMALL, "dynamic")));
    let mut desk = at_method(SMALL, "dynamic");
    desk.app.look = Look { theme: &MONO, ascii: true };
    assert_snapshot!("dynamic_ascii", album(desk.keys(&["0", "l"])));
    let mut huge = at_method(HUGE, "static");
    assert_snapshot!("static_240x70", chart(huge.keys(&["b", "l"])).join("\n"));
}

fn assert_title(desk: &Desk, graph: &Graph) {
    let title = &chart(desk)[0].to_lowercase();
    let label = graph.label.to_lowercase();
    assert!(title.contains(&label), "{label}\n{}", desk.screen());
}

#[test]
fn charts_are_selected_by_key_and_by_name() {
    let mut desk = at_method(SMALL, "static");
    for graph in GRAPHS {
        assert_title(&desk, graph);
        desk.keys(&["j"]);
    }
    for title in [
        "Tooth compliance q of the driver in um",
        "Tooth compliance q of the driven gear in um",
        "Transmission error, amplitude in um",
        "Dynamic factor over speed of the driver in rpm",
    ] {
        desk.assert_shows(title);
        desk.keys(&["j"]);
    }
    assert_title(&desk, &GRAPHS[0]);
    desk.keys(&["Up", "k", "k", "k", "k"]);
    assert_title(&desk, &GRAPHS[GRAPHS.len() - 1]);
    for graph in GRAPHS {
        desk.keys(&["1", ":", "chart: ", &graph.label.to_lowercase(), "Enter", "3"]);
        assert_title(&desk, graph);
    }
    assert_eq!(desk.kept, None, "the chart is no setting: a session starts with the force");
}

#[test]
fn static_and_dynamic_open_on_the_strike_and_0_shows_the_whole_contact() {
    let window = |desk: &Desk| desk.app.charts().window();
    for method in ["static", "dynamic"] {
        let mut desk = at_method(SMALL, method);
        let (strike, whole) = (window(&desk), desk.app.charts().scale().across);
        assert!(strike.length() < 0.2 * whole.length(), "{strike:?}");
        assert!(strike.from < -1.25 && strike.to > 0.0, "{strike:?}");
        assert_eq!(window(desk.keys(&["0"])), whole);
        assert_eq!(window(desk.keys(&["j", "0"])), whole);
        assert_eq!(window(desk.keys(&["v"])), strike);
        assert_eq!(window(desk.keys(&["v"])), whole);

        let mut desk = at_method(SMALL, method);
        desk.keys(&["b"]).fill("driven.tip_relief", "80 um");
        assert_eq!(window(&desk), desk.app.charts().scale().across, "only the baseline strikes");
        desk.fill("driven.tip_relief", "0 um");
        assert!(window(&desk).length() < 0.2 * whole.length());
    }
    let desk = at_method(SMALL, "exact");
    assert_eq!(window(&desk), desk.app.charts().scale().across, "from D to E");
}

/// The bars at each harmonic at rest and in motion; the run-up and run-down with present speed and
/// resonances.
#[test]
fn the_charts_with_their_own_axes() {
    let mut desk = at_method(LARGE, "dynamic");
    desk.keys(&[":", "chart: spectrum", "Enter", "3", "j"]);
    assert_snapshot!("speed_140x45", chart(&desk).join("\n"));
    // The curve begins above this speed.
    desk.fill("operation.speed", "300 rpm").keys(&["Esc", "3", "l"]);
    desk.assert_shows("300.0 rpm (present): K_tooth ");
    desk.assert_shows("present");
    let mut small = at_method(SMALL, "dynamic");
    small.keys(&["k", "k"]);
    assert_snapshot!("spectrum_80x24", chart(&small).join("\n"));
}

/// A bar ends at the row of its amplitude, and an amplitude of 0 has no bar.
#[test]
fn a_harmonic_without_amplitude_has_no_bar() {
    let mut desk = at_method(SMALL, "exact");
    desk.keys(&["k", "k"]);
    let Some((_, Ok(spectrum))) = &mut desk.app.tab.chart_work.found else {
        panic!("spectra");
    };
    spectrum.series.truncate(1);
    for harmonic in &mut spectrum.series[0].pieces[0][1..] {
        harmonic.1 = 0.0;
    }
    let rows = chart(&desk);
    let lowest = rows.iter().rfind(|row| row.contains("██")).expect("a bar");
    let bars = lowest.split_whitespace().filter(|word| word.contains("██"));
    assert_eq!(bars.count(), 1, "{rows:?}");
}

/// A chart of the worker is requested once for a pair, its growing values are shown, and the values of
/// an earlier request are not.
#[test]
fn the_latest_request_for_a_chart_of_the_worker_wins() {
    let mut desk = at_method(SMALL, "exact");
    let (number, work) = requested(desk.effects("k"), Slot::Chart).expect("a request");
    desk.assert_shows("Computing");
    assert!(requested(desk.effects("l"), Slot::Chart).is_none(), "the same pair");
    let all = results(number, work);
    desk.fill("operation.speed", "1900 rpm");
    desk.keys(&["Esc", "3"]);
    let shown = desk.app.tab.chart_work.found.clone();
    desk.take(all);
    assert_eq!(desk.app.tab.chart_work.found, shown, "a late value");
    desk.has(&["N=1", "present"]).lacks(&["computing"]);
    assert!(requested(desk.effects("j"), Slot::Chart).is_none());
}

#[test]
fn a_growing_curve_is_marked_as_unfinished() {
    let mut desk = at_method(SMALL, "exact");
    desk.keys(&["k"]);
    // The work is requested again and not carried out.
    desk.app.tab.chart_work.request = None;
    assert!(requested(desk.effects("h"), Slot::Chart).is_some());
    let inputs = desk.app.tab.case.inputs().expect("a valid case");
    let mut curve = speeds(&inputs, &mut |_| (), &|_, _| true).expect("a curve");
    curve.up[60..].fill(None);
    curve.down.fill(None);
    let work = &mut desk.app.tab.chart_work;
    work.found.as_mut().expect("a curve").1 = speed_chart(&[("", &curve)]);
    desk.assert_shows("computing: Dynamic factor");
}

#[test]
fn the_axis_ends_at_the_last_contact_for_static_and_dynamic() {
    for (method, ends) in [("exact", false), ("static", true), ("dynamic", true)] {
        let mut desk = at_method(SMALL, method);
        desk.keys(&["0"]);
        let axis = chart(&desk).into_iter().find(|line| line.contains('└')).expect("an axis");
        assert!(axis.contains('D') && axis.contains('E'), "{axis}");
        assert_eq!((axis.contains('B'), axis.contains('L')), (ends, ends), "{axis}");
        assert_eq!(desk.app.charts().scale().across.to > 0.0, ends);
    }
}

#[test]
fn the_cursor_moves_beyond_e_and_the_readout_shows_every_value() {
    let mut desk = at_method(SMALL, "dynamic");
    desk.keys(&["0", "End", "L"]);
    let cursor = desk.app.cursor.expect("a cursor");
    desk.assert(cursor < 0.0 && desk.shows("deg of the driver after E: F "));
    for symbol in ["S ", "ΔV_τ ", "F/ΣF ", "q_s ", "x "] {
        desk.assert_shows(symbol);
    }
    desk.keys(&["L"; 9]);
    let end = desk.app.cursor.expect("a cursor");
    desk.keys(&["L"]);
    assert_eq!(desk.app.cursor, Some(end), "the axis ends here");
    desk.keys(&["4"]);
    assert!(desk.shows("after E"), "the teeth pane has the same cursor");
    let mut desk = at_method(SMALL, "static");
    desk.keys(&["Home", "LL"]);
    assert!(desk.shows(" N, exact "), "the readout has every visible curve\n{}", desk.screen());
}

#[test]
fn zoom_is_around_the_cursor_and_ends_at_the_whole_contact() {
    let mut desk = at_method(SMALL, "static");
    desk.keys(&["0"]);
    let (whole, window) = (chart(&desk), |desk: &Desk| desk.app.charts().window());
    let all = window(&desk);
    let strike = window(desk.keys(&["v"]));
    desk.keys(&["v", "End", "++"]);
    assert!((window(&desk).length() / all.length() - 0.5).abs() < 1e-9, "around E");
    assert!(window(&desk).covers(strike));
    desk.keys(&["-"]);
    assert!(window(&desk).length() < all.length());
    desk.keys(&["0", "c"]);
    assert_eq!(chart(&desk), whole);
    assert!(desk.keys(&["-"]).shows("the charts show the whole contact"));
    desk.act(Action::Wheel(Position::new(20, chart_area(&desk).y + 2), -3));
    assert!(window(&desk).length() < all.length(), "the wheel zooms");
    desk.keys(&["+"; 30]).assert_shows("closest zoom");
}

#[test]
fn the_time_axis_shows_the_same_curve() {
    let size = Size { width: 96, ..SMALL };
    let mut desk = at_method(size, "dynamic");
    let angle = chart(&desk);
    desk.keys(&["t"]);
    let time = chart(&desk);
    assert!(time[0].contains("over time after E in us"), "{}", time[0]);
    assert!(angle[0].contains("over roll angle after E in deg"), "{}", angle[0]);
    assert_eq!(angle[1..angle.len() - 2], time[1..time.len() - 2], "the curves do not move");
    desk.keys(&["l"]).assert_shows(" us: F ");
    assert_eq!(desk.kept, None, "the x axis is no setting");
    desk.keys(&["c", "t"]);
    assert_eq!(chart(&desk), angle);
}

#[test]
fn the_axis_covers_the_results_and_the_baseline() {
    for method in ["paper", "exact", "dynamic"] {
        for relief in ["46 um", "48 um", "80 um"] {
            let mut desk = at_method(SMALL, method);
            desk.keys(&["b"]);
            let pinned = desk.app.charts().scale();
            desk.fill("driven.tip_relief", relief);
            for key in ["0", "v"] {
                desk.keys(&["Esc", "3", key]);
                let window = desk.app.charts().window();
                let solution = |answer: &Answer| answer.of(answer.active).expect("solved").clone();
                let baseline = solution(&desk.app.baseline.as_ref().expect("pinned").answer);
                let now = solution(desk.app.tab.answer.as_ref().expect("solved"));
                for first in [&baseline, &now].into_iter().filter_map(chart::first_contact) {
                    assert!(window.from <= -first.to_degrees(), "{method} {relief} {key}");
                }
            }
            // A baseline by method paper has a curve only of that method and not of exact.
            let stays = desk.app.charts().scale().across == pinned.across;
            assert!(method == "paper" || stays, "{method} {relief}: the axis stays");
        }
    }
}

#[test]
fn the_readout_and_the_teeth_pane_show_the_same_numbers() {
    for method in ["paper", "exact", "static", "dynamic"] {
        let mut desk = at_method(LARGE, method);
        desk.keys(&["Home", "lllll"]);
        for _ in 0..6 {
            desk.keys(&["l"]);
            let angle = desk.app.cursor.expect("a cursor");
            let answer = desk.app.tab.answer.as_ref().expect("solved");
            let solved = (&answer.inputs, answer.of(answer.active).expect("solved"));
            let moment = ContactState::at(solved.0, solved.1, angle).expect("in sight");
            let said = chart::readout(desk.app.charts(), angle);
            let readout = |symbol| {
                let mut all = readings(&moment, solved, System::Metric).into_iter();
                let found = all.find(|one| one.symbol == symbol && one.number.is_some());
                found.map(|one| one.to_string())
            };
            for symbol in ["F_S", "F", "S", "ΔV_n", "ΔV_τ", "x", "F/ΣF", "q_s", "E_k"] {
                if let Some(alone) = readout(symbol).map(|readout| format!(" {readout}")) {
                    let mut parts = said.split([':', ',', ';']);
                    let is_same = parts.any(|part| part.trim_end_matches('.') == alone);
                    assert!(is_same, "{method}: {alone} in {said}");
                }
            }
            let has_force = readout("F_S").or(readout("F")).is_some();
            assert!(readout("S").is_some() && has_force, "{method}");
        }
    }
}

#[test]
fn a_run_covers_the_visible_part_of_the_contact() {
    let mut desk = at_method(SMALL, "static");
    let strike = desk.app.charts().window();
    let last = desk.played(&["Space"]);
    assert!((last.to_degrees() + strike.to).abs() < 1e-9);
    assert_eq!(desk.app.charts().window(), strike);
    let last = desk.played(&["0", "Home", "Space"]);
    assert!(last < -0.4, "{last}");
}

#[test]
fn a_large_pane_shows_several_charts() {
    let desk = at_method(HUGE, "static");
    desk.has(&["3 Force F in N over roll angle after E in deg", "─ Gap S in um"]);
    let mut desk = at_method(LARGE, "exact");
    desk.lacks(&["─ Gap S in um"]);
    desk.keys(&["z"]).assert_shows("─ Gap S in um");
}

/// The numbers on the axes of a chart: below it, and beside it.
fn labels(desk: &Desk, lines: &[String]) -> (Vec<f64>, Vec<f64>) {
    let Some(axis) = lines.iter().position(|line| line.contains('└')) else {
        return (Vec::new(), Vec::new());
    };
    let number = |text: &str| {
        text.parse::<f64>().unwrap_or_else(|_| panic!("{text} is no number\n{}", desk.screen()))
    };
    let below = lines.get(axis + 1).map_or("", String::as_str).split_whitespace();
    let below = below.filter(|word| !["deg", "us", "ms"].contains(word)).map(number).collect();
    let beside = lines[..axis].iter().filter_map(|line| line.split_once('┤'));
    (below, beside.map(|(label, _)| number(label.trim())).collect())
}

fn assert_round(numbers: &[f64], desk: &Desk) {
    let steps: Vec<f64> = numbers.windows(2).map(|pair| (pair[1] - pair[0]).abs()).collect();
    for step in &steps {
        let digit = step / 10f64.powf((step * (1.0 + 1e-6)).log10().floor());
        let is_round = [1.0, 2.0, 5.0].iter().any(|round| (digit - round).abs() < 1e-6);
        desk.assert_at(numbers, is_round);
        assert!((step - steps[0]).abs() < 1e-6 * step, "{numbers:?}\n{}", desk.screen());
    }
}

/// Checks that every curve has a name with its sign.
fn assert_legends(desk: &Desk, text: &str) {
    let app = &desk.app;
    for graph in app.charts().shown() {
        for curve in &curves::curves(app.charts(), &GRAPHS[graph]) {
            let name = match curve.source {
                CurveSource::Active(method) => format!("⠒ {}", method.name()),
                CurveSource::Other(method) => method.name().to_owned(),
                CurveSource::Pinned(_) => "+ baseline".to_owned(),
                CurveSource::Bound(symbol) => format!("╌ {symbol}"),
                CurveSource::Model { model, .. } => model.name().to_owned(),
            };
            assert!(text.contains(&name), "{name} is missing\n{text}");
        }
    }
}

#[test]
fn the_baseline_is_in_every_chart_at_every_size() {
    for method in ["exact", "static", "dynamic"] {
        let mut desk = at_method(SMALL, method);
        desk.keys(&["b"]).fill("operation.power", "12 kW");
        assert_charts(&mut desk);
        desk.keys(&["1"]).fill("driven.tip_relief", "80 um");
        assert_charts(&mut desk);
    }
}

/// Checks every chart at several sizes: no panic, no invalid number, round ticks, and a name for
/// every curve from 80x24 on.
fn assert_charts(desk: &mut Desk) {
    desk.keys(&["Esc", "3"]);
    for (size, keys) in [(SMALL, "0"), (TINY, "v"), (LARGE, "+"), (HUGE, "t")] {
        desk.act(Action::Resize(size));
        desk.keys(&[keys, "l"]);
        for _ in GRAPHS {
            let lines = chart(desk);
            let text = lines.join("\n");
            assert!(!["NaN", "inf ", "n/a"].iter().any(|none| text.contains(none)), "{text}");
            if size != TINY {
                assert_legends(desk, &text);
            }
            if size.height < HUGE.height {
                let (below, beside) = labels(desk, &lines);
                assert_round(&below, desk);
                assert_round(&beside, desk);
            }
            desk.keys(&["j"]);
            desk.app.chart.selected = desk.app.chart.graph();
        }
    }
    desk.act(Action::Resize(SMALL));
}

#[test]
fn every_example_is_drawn_at_every_method() {
    for (number, example) in EXAMPLES.iter().enumerate() {
        let mut desk = Desk::on(SMALL, "case.toml", example.text);
        for method in 0..4 {
            desk.keys(&["Ctrl-T"]);
            // Each chart of each method in two of the cases.
            if (number + method) % 4 == 0 {
                assert_charts(&mut desk);
            }
            // The closed form `paper` refuses a helical pair.
            let answer = desk.app.tab.answer.as_ref();
            let Some(solution) = answer.and_then(|answer| answer.of(answer.active)) else {
                assert!(desk.app.tab.case.inputs().is_ok_and(|inputs| inputs.face().is_some()));
                continue;
            };
            let strikes = solution.outcome == Outcome::CornerContact;
            let (method, has_force) = (solution.method, strikes && solution.withheld.is_none());
            desk.app.chart.selected = 0;
            let is_drawn =
                chart(desk.keys(&["Esc", "3", "0"])).iter().any(|line| line.contains('└'));
            assert!(is_drawn || !has_force, "{} {method:?}", example.name);
        }
    }
}

#[test]
fn random_cases_are_drawn() {
    let sizes = (12..150u32, 12..150u32, -1.3..1.69f64, -9.0..-3.5f64);
    let loads = (0.0..6.0f64, 0.0..4.5f64, 0..3usize);
    let config =
        ProptestConfig { cases: 10, failure_persistence: None, ..ProptestConfig::default() };
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

/// The bytes that change one picture of the chart into another.
fn bytes(before: &Buffer, after: &Buffer, area: Rect) -> usize {
    let mut written = Vec::new();
    let changes =
        before.diff(after).into_iter().filter(|(x, y, _)| area.contains(Position::new(*x, *y)));
    CrosstermBackend::new(&mut written).draw(changes).expect("room in memory");
    written.len()
}

/// Every chart on the screen, one after the other.
fn all_charts(desk: &mut Desk) -> Vec<Buffer> {
    let charts = (0..GRAPHS.len()).map(|graph| {
        desk.app.chart.selected = graph;
        desk.buffer()
    });
    charts.collect()
}

#[test]
fn a_key_changes_few_bytes_of_a_chart() {
    for (size, most, methods) in
        [(SMALL, 1400, &["exact", "dynamic"][..]), (MIDDLE, 3000, &["exact"])]
    {
        let mut all = Vec::new();
        for method in methods {
            let mut desk = at_method(size, method);
            let area = chart_area(&desk);
            let mut press = |desk: &mut Desk, keys: &[String]| {
                let mut before = all_charts(desk);
                for key in keys {
                    desk.keys(&[key]);
                    let after = all_charts(desk);
                    let pairs = before.iter().zip(&after);
                    all.extend(pairs.map(|(before, after)| bytes(before, after, area)));
                    before = after;
                }
            };
            for (field, unit, digits) in
                [("operation.speed", " rpm", "2123.4"), ("deviations.base_pitch", " um", "16.543")]
            {
                desk.fill(field, unit).keys(&["Home"]);
                let keys = digits.chars().map(|digit| digit.to_string());
                let keys: Vec<String> = keys.chain(["Backspace".to_owned()]).collect();
                press(&mut desk, &keys);
            }
            desk.keys(&["Esc", "3", "l"]);
            let keys = ["l"; 12].into_iter().chain(["L"]).map(str::to_owned);
            press(&mut desk, &keys.collect::<Vec<_>>());
        }
        all.sort_unstable();
        let late = all[all.len() * 95 / 100];
        println!("chart at {size}: 95 % {late} bytes, most {}", all[all.len() - 1]);
        assert!(late <= most, "{late} bytes at {size}");
    }
}

/// The models share the columns that several of them cross, so that no curve hides another without
/// colour.
#[test]
fn every_model_of_the_stiffness_is_visible_on_a_small_screen() {
    for example in EXAMPLES.iter().filter(|example| !example.name.contains("helical")).step_by(3) {
        let mut desk = Desk::on(SMALL, "case.toml", example.text);
        desk.keys(&["Esc", ":", "mesh stiff", "Enter"]);
        let charts = desk.app.charts();
        let curves = curves::curves(charts, &GRAPHS[charts.shown()[0]]);
        assert!(curves.len() > 1, "{}", example.name);
        let top = curves.last().expect("a curve").source;
        assert!(matches!(top, CurveSource::Model { is_own: true, .. }), "{top:?}");
        let rows = chart(&desk);
        for curve in &curves {
            let CurveSource::Model { model, .. } = curve.source else {
                panic!("a curve of a model");
            };
            let name = model.name();
            let before = rows.iter().find_map(|row| row.split_once(&format!(" {name}")));
            let sample = before.and_then(|(before, _)| before.chars().next_back());
            let sample = sample.expect("a name in the legend");
            let is_braille = |letter: char| ('\u{2801}'..='\u{28ff}').contains(&letter);
            let is_own = |letter: &char| match sample {
                '⠒' => is_braille(*letter),
                sample => *letter == sample,
            };
            let drawn = rows[1..].iter().flat_map(|row| row.chars().filter(is_own));
            assert!(drawn.count() > 15, "{name}: {}", rows.join("\n"));
        }
    }
}

/// The chart is computed only while it is visible.
#[test]
fn the_tooth_compliance_has_a_curve_for_every_model_over_the_flank() {
    let mut desk = at_method(SMALL, "exact");
    assert_eq!(desk.app.tab.chart_work.request, None);
    desk.keys(&["1", ":", "chart: driven tooth", "Enter", "3"]);
    let request = desk.app.tab.chart_work.request.as_ref();
    let chart_of = |request: &ChartRequest| request.chart.key();
    assert_eq!(request.map(chart_of), Some("tooth_compliance_driven"));
    desk.assert_shows("C is the pitch circle");
    assert_snapshot!("tooth_compliance_80x24", chart(&desk).join("\n"));
    let mut outside =
        Desk::on(SMALL, "case.toml", &TABLE_1.replacen("teeth = 20", "teeth = 111", 1));
    outside.keys(&["Esc", ":", "chart: driver tooth", "Enter"]);
    outside.assert(outside.shows("kuang-yang (case) (no value)") && outside.shows("∘ beam"));
}

#[test]
fn the_mesh_stiffness_appears_as_soon_as_it_is_computed() {
    let mut desk = at_method(SMALL, "exact");
    desk.keys(&["1", ":", "chart: mesh stiffness"]);
    assert!(requested(desk.effects("Enter"), Slot::Solve).is_some(), "a request");
    let answer = desk.whole_answer();
    let without = Answer { stiffness: None, ..answer.clone() };
    desk.show(without);
    desk.assert_shows("Computing the mesh stiffness.");
    desk.show(answer);
    let drawn = chart(&desk);
    desk.keys(&["3", "j", "k"]);
    assert_eq!(drawn[1..], chart(&desk)[1..]);
}

/// The helical example with the contact pattern in the focused chart pane.
fn pattern(size: Size, set: &[(&str, &str)]) -> Desk {
    let mut desk = Desk::on(size, "case.toml", include_str!("../../cases/helical-20-35.toml"));
    for (field, value) in set {
        desk.fill(field, value);
    }
    desk.keys(&["Esc", ":", "chart: contact pattern", "Enter", "3"]);
    desk
}

#[test]
fn the_contact_pattern_shows_the_line_load_over_roll_angle_and_face_width() {
    let mut desk = pattern(LARGE, &[]);
    assert_snapshot!("pattern_140x45", chart(&desk).join("\n"));
    let mut small = pattern(SMALL, &[]);
    small.app.look = Look { theme: &MONO, ascii: true };
    assert_snapshot!("pattern_ascii_80x24", chart(small.keys(&["l", "Up"])).join("\n"));
    desk.keys(&["v"]);
    let strike = desk.app.charts().window();
    assert!(strike.from < 0.0 && strike.to > 0.0 && strike.length() < 5.0, "{strike:?}");
}

#[test]
fn the_cursor_of_the_pattern_moves_along_the_contact_line_and_the_teeth_follow() {
    let mut desk = pattern(LARGE, &[]);
    desk.keys(&["Home", "Up"]);
    let (angle, z) = (desk.app.cursor.expect("a cursor"), desk.app.chart.z);
    assert!(z > 0.0);
    desk.has(&["In the plane at z", "line load"]);
    let teeth = desk.app.layout.plan().area(Pane::Teeth);
    let before = desk.buffer();
    desk.keys(&["Up"; 5]);
    assert_eq!(desk.app.cursor, Some(angle), "the gears do not turn");
    assert!(desk.app.chart.z > z);
    let after = desk.buffer();
    assert!(teeth.positions().any(|at| before[at] != after[at]), "another section");
    desk.keys(&["Down"; 99]);
    let width = desk.app.tab.case.inputs().expect("a case").common_width();
    assert!((desk.app.chart.z + 0.5 * width).abs() < 1e-12, "the face ends here");
    let area = chart_area(&desk);
    desk.act(Action::Click(Position::new(area.x + area.width / 2, area.y + area.height / 2)));
    assert!(desk.app.chart.z.abs() < 0.2 * width);
    desk.keys(&["c"]);
    assert_eq!((desk.app.cursor, desk.app.chart.z.to_bits()), (None, 0));
}

#[test]
fn a_pair_without_slices_has_no_contact_pattern() {
    let mut desk = at_method(SMALL, "static");
    desk.keys(&["k"]).assert_shows("Dynamic factor");
    desk.keys(&[":", "chart: contact pattern", "Enter", "3"]);
    desk.lacks(&["slice", "zoom"]).assert_shows("No chart: a spur pair without misalignment");
    desk.keys(&["j"]);
    assert_title(&desk, &GRAPHS[0]);
    let mut desk = pattern(SMALL, &[]);
    desk.keys(&["F8"]).assert_shows("the contact pattern is drawn in shades");
    assert_title(desk.keys(&["Alt-T", "3"]), &GRAPHS[0]);
    // A misaligned spur pair has slices; its contact lines are parallel to the axis.
    let mut desk = at_method(SMALL, "static");
    desk.fill("deviations.misalignment", "20 um");
    desk.keys(&["Esc", "3", "k"]).assert_shows("Line load at rest, roll angle after E, z in mm");
}

#[test]
fn the_curve_of_paper_is_drawn_on_request() {
    let mut desk = at_method(SMALL, "exact");
    desk.lacks(&["· paper"]);
    desk.keys(&["f"]).assert_shows("· paper");
    assert!(at_method(SMALL, "paper").shows("⠒ paper"));
}

#[test]
fn the_values_of_a_chart_at_the_cursor_have_one_unit() {
    let hydro = include_str!("../../cases/hydro-speed-up.toml");
    let dynamic = hydro.replace("method = \"exact\"", "method = \"dynamic\"");
    let mut desk = Desk::on(LARGE, "case.toml", &dynamic);
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
