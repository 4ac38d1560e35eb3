//! The screens: at 80x24 and at 140x45.
use crate::harness::{self, Desk, LARGE, SMALL, TABLE_1, without_folder};

use insta::assert_snapshot;
use ratatui::layout::Size;
use tipstrike::model::inputs::Method;
use tipstrike::tui::testing::Action;

const TINY: Size = Size { width: 60, height: 16 };

#[test]
fn the_opening_screen() {
    assert_snapshot!("opening_80x24", Desk::new(SMALL).screen());
    assert_snapshot!("opening_140x45", Desk::new(LARGE).screen());
}

#[test]
fn an_invalid_value_shows_its_reason_under_the_field_and_the_last_valid_results() {
    let mut desk = Desk::new(SMALL);
    desk.fill("pair.module", "5 kg");
    assert_snapshot!("invalid_80x24", desk.screen());
}

#[test]
fn no_corner_contact_is_a_result() {
    let mut desk = Desk::new(SMALL);
    desk.fill("driven.tip_relief", "80 um");
    assert_snapshot!("no_corner_contact_80x24", desk.screen());
}

/// Table 1 in motion, with the closed form beside the results of the method.
fn in_motion(size: Size) -> Desk {
    let mut desk = Desk::new(size);
    desk.fill("model.method", "dynamic");
    desk.keys(&["Esc", "2"]);
    desk
}

#[test]
fn the_results_of_the_method_itself_come_first() {
    for (name, size) in [("in_motion_80x24", SMALL), ("in_motion_60x16", TINY)] {
        assert_snapshot!(name, in_motion(size).screen());
    }
    harness::assert_ascii(&mut in_motion(SMALL));
}

#[test]
fn every_quantity_can_be_scrolled_into_view_and_the_title_shows_the_visible_rows() {
    for size in [TINY, LARGE] {
        let mut desk = in_motion(size);
        let (count, mut rows) = (desk.app.listed_results().len(), Vec::new());
        for _ in 0..count {
            let marked = desk.app.marked_result().expect("a quantity");
            let symbol = format!("▸{} ", marked.symbol_in(Method::Dynamic));
            assert!(desk.shows(&symbol), "{size}: {symbol}\n{}", desk.screen());
            rows.push(marked.key);
            desk.keys(&["j"]);
        }
        rows.dedup();
        assert_eq!(rows.len(), count, "{size}");
        let shows_position = |desk: &Desk| {
            let first = desk.app.tab.results.top + 1;
            let last = desk.app.tab.results.top + desk.app.results_page();
            desk.shows(&format!("2 Results {first}-{last}/{count}"))
        };
        assert!(shows_position(&desk), "{size}: {}", desk.screen());
        desk.keys(&["g"]);
        assert!(shows_position(&desk), "{size}: {}", desk.screen());
    }
}

#[test]
fn a_bad_file_is_not_opened() {
    let mut desk = Desk::on(SMALL, "table-1.toml", TABLE_1);
    desk.write("bad.toml", &TABLE_1.replace("5 mm", "5 kg").replace("teeth = 20\n", "teth = 20\n"));
    desk.keys(&["Ctrl-O", "bad", "Enter"]);
    assert_snapshot!("faults_80x24", without_folder(&desk));
}

#[test]
fn plain_ascii_on_a_terminal_without_unicode() {
    let mut desk = Desk::new(SMALL);
    harness::assert_ascii(&mut desk);
    desk.app.look.ascii = true;
    assert_snapshot!("ascii_80x24", desk.screen());
}

#[test]
fn a_too_small_terminal_shows_a_message_and_keeps_the_state() {
    let mut desk = Desk::new(SMALL);
    desk.fill("operation.speed", "1500 rpm");
    let before = desk.screen();
    for (width, height) in [(59, 16), (60, 11), (20, 5), (10, 3), (5, 1), (4, 4), (1, 1), (0, 0)] {
        desk.act(Action::Resize(Size::new(width, height)));
        desk.keys(&["Down", "5", "Enter"]);
        let screen = desk.screen().replace('\n', "");
        let room = width >= 5 && height >= 1;
        assert!(!room || screen.contains("60x12"), "{width}x{height}: {screen}");
        assert_eq!(screen.contains(&format!("this is {width}x{height}")), width >= 20, "{screen}");
    }
    desk.act(Action::Resize(SMALL));
    assert_eq!(desk.screen(), before);
}

#[test]
fn the_chart_alone_and_the_form_without_it() {
    let mut desk = Desk::new(SMALL);
    desk.keys(&["F9"]).lacks(&["driver angle before E in deg"]);
    desk.keys(&["F9", "Esc", "3", "z"]);
    assert_snapshot!("chart_80x24", desk.screen());
}
