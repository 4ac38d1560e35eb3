//! Memory of an open case, an edit and a benchmark.
use crate::harness::{Desk, LARGE, SMALL, TABLE_1};

use tipstrike::case::Document;
use tipstrike::model::inputs::Method;
use tipstrike::study::trade::MeasuredSetting;
use tipstrike::tui::testing::Action;

/// Remaining bytes per run, over a number of runs.
fn kept(times: usize, mut run: impl FnMut(usize)) -> f64 {
    let info = allocation_counter::measure(|| (0..times).for_each(&mut run));
    info.bytes_current as f64 / times as f64
}

#[test]
fn an_edit_stores_its_difference_and_undo_has_no_limit() {
    const EDITS: usize = 1500;
    let mut desk = Desk::new(SMALL);
    let edit = |desk: &mut Desk, text: &str| {
        desk.keys(&["Ctrl-U"]).act(Action::Paste(text.to_owned()));
        desk.keys(&["Down", "Up"]);
    };
    edit(&mut desk, "6 mm");
    let bytes = kept(EDITS, |number| {
        edit(&mut desk, if number % 2 == 0 { "5 mm" } else { "6 mm" });
    });
    println!("an edit: {bytes:.0} bytes");
    assert!(bytes < 100.0, "{bytes}");
    (0..=EDITS).for_each(|_| {
        desk.keys(&["Ctrl-Z"]);
        let message = desk.app.message.as_ref().map(|message| message.text.as_str());
        assert_ne!(message, Some("nothing to undo"));
    });
    assert!(!desk.app.tab.is_unsaved(), "back at the first one");
    assert!(desk.keys(&["Ctrl-Z"]).shows("nothing to undo"));
}

#[test]
fn an_open_case_needs_little_memory_and_a_closed_one_none() {
    const CASES: usize = 12;
    let mut desk = Desk::new(LARGE);
    let mut tell = |method: Method, most: f64| {
        let whole = allocation_counter::measure(|| {
            let bytes = kept(CASES, |number| {
                let path = desk.write(&format!("{number}.toml"), TABLE_1);
                let document = Document::read(&path).unwrap();
                desk.act(Action::Loaded(path, Ok(Box::new(document))));
                desk.fill("operation.speed", "1500 rpm");
                while desk.app.tab.answer.as_ref().is_none_or(|answer| answer.active != method) {
                    desk.keys(&["Ctrl-T"]);
                }
            });
            println!("an open case, method {}: {:.1} kB", method.name(), bytes / 1e3);
            assert!(bytes < most, "{method:?}: {bytes}");
            (0..CASES).for_each(|_| {
                desk.keys(&["Alt-W", "d"]);
            });
        });
        assert_eq!(desk.app.tabs().count(), 1);
        // The list of cases keeps its capacity, and the first case its results.
        println!("after closing them: {:.1} kB", whole.bytes_current as f64 / 1e3);
        assert!(whole.bytes_current < 400_000, "{}", whole.bytes_current);
    };
    tell(Method::Exact, 40e3);
    tell(Method::Static, 80e3);
    tell(Method::Dynamic, 140e3);
}

#[test]
fn a_benchmark_stores_its_figures_and_no_curve() {
    let mut desk = Desk::new(LARGE);
    desk.keys(&["Esc", "5", "z"]);
    let bytes = kept(1, |_| {
        desk.keys(&["m"]);
    });
    let traded = desk.app.tab.traded.as_ref().expect("a measurement");
    let settings = traded.trade.as_ref().expect("it is whole").settings.len() as f64;
    println!("a measurement: {:.1} kB, {settings} settings", bytes / 1e3);
    // The rest is shared: the pair, the finest settings and the message.
    let figures = size_of::<MeasuredSetting>() as f64;
    assert!(bytes < 1.3 * figures * settings, "{bytes}, {figures} a setting");
}
