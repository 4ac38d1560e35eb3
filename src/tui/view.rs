//! The screen, drawn from the state alone.

pub mod chart;
pub mod form;
pub mod help;
pub mod popup;
pub mod results;
pub mod status;
pub mod text;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::Style;

use super::app::{App, Panes};
use super::clean;

/// The smallest useful terminal.
pub const SMALLEST: Size = Size { width: 60, height: 16 };
/// A lower terminal has no room for the chart beside the rest.
const CHART_FROM: u16 = 20;

/// Where everything stands. An area without room is empty.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct Plan {
    /// The name of the case.
    pub header: Rect,
    /// The form, its title and its scroll bar.
    pub form: Rect,
    /// The results and their title.
    pub results: Rect,
    /// The chart and its title.
    pub chart: Rect,
    /// What the focused field is, and messages.
    pub hint: Rect,
    /// The keys.
    pub keys: Rect,
}

/// Draw the whole screen; the place of the cursor, where there is one.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let cursor = if is_too_small(area.as_size()) {
        too_small(area, buffer);
        None
    } else {
        draw_panes(app, area, buffer)
    };
    clean::finish(buffer, app.look.ascii);
    cursor.filter(|&cursor| area.contains(cursor))
}

/// Where everything stands on a screen of that size.
#[must_use]
pub fn plan(size: Size, panes: Panes) -> Plan {
    if is_too_small(size) {
        return Plan::default();
    }
    let Size { width, height } = size;
    let row = |y, height| Rect::new(0, y, width, height);
    let body = height - 4;
    let chart = match panes {
        Panes::Chart => body,
        Panes::All if height >= CHART_FROM => (height / 3).clamp(7, 20),
        Panes::All | Panes::NoChart => 0,
    };
    let upper = body - chart;
    let form = (width * 57 / 100).clamp(34, 66);
    Plan {
        header: row(0, 1),
        form: Rect::new(0, 1, form, upper),
        results: Rect::new(form, 1, width - form, upper),
        chart: row(1 + upper, chart),
        hint: row(height - 3, 2),
        keys: row(height - 1, 1),
    }
}

fn is_too_small(size: Size) -> bool {
    size.width < SMALLEST.width || size.height < SMALLEST.height
}

fn too_small(area: Rect, buffer: &mut Buffer) {
    let lines = [
        format!("tipstrike needs {}x{};", SMALLEST.width, SMALLEST.height),
        format!("this is {}x{}.", area.width, area.height),
        "Nothing is lost.".to_owned(),
    ];
    for (line, y) in lines.iter().zip(area.top()..area.bottom()) {
        buffer.set_stringn(area.x, y, line, area.width.into(), Style::new());
    }
}

fn draw_panes(app: &App, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let plan = plan(area.as_size(), app.panes);
    status::header(app, plan.header, buffer);
    let in_form = form::draw(app, plan.form, buffer);
    results::draw(app, plan.results, buffer);
    chart::draw(app, plan.chart, buffer);
    status::hint(app, plan.hint, buffer);
    status::keys(app, plan.keys, buffer);
    match app.prompts.last() {
        Some(prompt) => popup::draw(app, prompt, area, buffer),
        None => in_form,
    }
}
