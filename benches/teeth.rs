//! Time of one picture of the teeth: `cargo bench --bench teeth`.
#![allow(clippy::print_stdout, reason = "a benchmark prints its results")]

mod timing;

use std::hint::black_box;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::symbols::Marker;
use tipstrike::case::Case;
use tipstrike::model::{Stages, solve};
use tipstrike::tui::testing::{Centre, Look, Picture, TeethView, teeth};

fn main() {
    let inputs =
        Case::table_1().inputs().unwrap_or_else(|_| unreachable!("the built-in case is valid"));
    let solution =
        solve(&inputs, Stages::ALL).unwrap_or_else(|_| unreachable!("the built-in case is solved"));
    for (name, centre, zoom) in [
        ("strike", Centre::Strike, 0),
        ("strike, close up", Centre::Strike, 10),
        ("path", Centre::PitchPoint, 0),
        ("pair", Centre::Pair, 0),
    ] {
        let view = TeethView { centre, zoom, ..TeethView::default() };
        let picture = Picture {
            inputs: &inputs,
            solution: &solution,
            cursor: None,
            z: 0.0,
            view: &view,
            look: Look::FULL,
            marker: Marker::Braille,
            units: tipstrike::case::units::System::Metric,
            is_stale: false,
        };
        let area = Rect::new(0, 0, 200, 60);
        let mut buffer = Buffer::empty(area);
        timing::time(&format!("teeth at 200x60/{name}"), || {
            buffer.reset();
            teeth::draw(black_box(&picture), area, &mut buffer);
        });
    }
}
