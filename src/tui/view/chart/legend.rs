//! Whose curve is whose: names in a corner of the plot that the curves leave free.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::symbols::Marker;
use ratatui::text::{Line, Span};
use ratatui::widgets::Widget;

use super::curves::{Curve, Whose};
use super::raster;
use super::readout::base_name;
use crate::tui::app::App;
use crate::tui::ascii::symbol;
use crate::tui::view::text;

/// Write the names, the active method first, and what there is to say about it, where there is
/// room.
pub fn draw(app: &App, curves: &[Curve], said: Option<String>, plot: Rect, buffer: &mut Buffer) {
    let mut taken = None;
    if let Some(said) = said {
        let line = Line::styled(
            text::cut(&said, plot.width.saturating_sub(2).into()),
            Style::new(),
        );
        taken = put(&line, plot, None, buffer);
    }
    let names = curves.iter().rev().flat_map(|curve| entry(app, curve));
    let line = Line::from(names.collect::<Vec<_>>());
    let _ = put(&line, plot, taken, buffer);
}

fn entry(app: &App, curve: &Curve) -> [Span<'static>; 2] {
    let name = match curve.whose {
        Whose::Active(method) | Whose::Other(method) => method.name().to_owned(),
        Whose::Pinned(method) => base_name(app, method),
        Whose::Bound(name) => symbol(name, app.look.ascii).into_owned(),
    };
    let sample = match raster::marker(app, curve.whose) {
        Marker::Custom(letter) => letter.to_string(),
        Marker::Dot => "•".to_owned(),
        Marker::HalfBlock => "▀".to_owned(),
        _ => "⠒".to_owned(),
    };
    [
        Span::styled(format!(" {sample} "), raster::style(app, curve.whose)),
        Span::raw(format!("{name} ")),
    ]
}

// Into the first corner in which nothing is drawn: on the right, then on the left, above, then
// below.
fn put(line: &Line, plot: Rect, taken: Option<Rect>, buffer: &mut Buffer) -> Option<Rect> {
    let width = u16::try_from(line.width())
        .ok()
        .filter(|&width| width <= plot.width)?;
    let rows = [
        0,
        1,
        plot.height.saturating_sub(1),
        plot.height.saturating_sub(2),
    ]
    .map(|row| plot.y + row.min(plot.height - 1));
    let columns = [
        plot.right() - width,
        plot.x,
        plot.x + (plot.width - width) / 2,
    ];
    let rooms = rows.into_iter().flat_map(|y| {
        columns.map(|x| Rect {
            x,
            y,
            width,
            height: 1,
        })
    });
    let is_free = |room: &Rect| {
        let empty = room
            .positions()
            .all(|at| buffer.cell(at).is_some_and(|cell| cell.symbol() == " "));
        empty && taken.is_none_or(|taken| !taken.intersects(*room))
    };
    let room = rooms.into_iter().find(is_free)?;
    line.render(room, buffer);
    Some(room)
}
