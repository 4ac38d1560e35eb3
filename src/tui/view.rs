//! The screen, drawn from the state alone.

pub mod boxes;
pub mod browser;
pub mod cursor_prompt;
pub mod digest;
pub mod explain;
pub mod form;
pub mod help;
pub mod picker;
pub mod popup;
pub mod results;
pub mod status;
pub mod trade;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use unicode_width::UnicodeWidthStr;

use super::app::App;
use super::ascii;
use super::layout::{self, SMALLEST, plan};
use super::pane::Pane;
use super::panes::chart::{Charts, panels};
use super::panes::teeth;

pub use super::text;

/// Room for a title beside the names of hidden panes.
const LEAST_TITLE: usize = 32;
/// Stands before the number of a pane while a field takes the digits.
const LEAVE: &str = "Esc ";

/// Draw the whole screen; the place of the cursor, where there is one.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let cursor = if layout::is_too_small(area.as_size()) {
        too_small(area, buffer);
        None
    } else {
        draw_panes(app, area, buffer)
    };
    ascii::finish(buffer, app.look.ascii);
    cursor.filter(|&cursor| area.contains(cursor))
}

/// So many columns a title has for itself in a pane of that width.
#[must_use]
pub fn title_room(app: &App, pane: Pane, width: u16) -> usize {
    let hidden = hidden(app, pane, width);
    room_beside(&hidden, width).saturating_sub(4 + key(app, pane).len())
}

// The keys that go to a pane, with a space behind them: in a field Esc comes first, since a digit
// is part of the value there. None for the form while one of its fields is edited.
fn key(app: &App, pane: Pane) -> String {
    match (app.has_line(), pane) {
        (false, _) => format!("{} ", pane.number()),
        (true, Pane::Form) => String::new(),
        (true, _) => format!("{LEAVE}{} ", pane.number()),
    }
}

// The hidden ones are named at the right end, before one cell of the rule.
fn room_beside(hidden: &str, width: u16) -> usize {
    usize::from(width).saturating_sub(if hidden.is_empty() {
        0
    } else {
        hidden.width() + 1
    })
}

/// The title line of a pane: its number, whether it has the focus, its title, and in one of the
/// panes the names of those that are not in sight; what is below it.
pub fn titled(app: &App, pane: Pane, title: &str, area: Rect, buffer: &mut Buffer) -> Rect {
    let hidden = hidden(app, pane, area.width);
    let room = room_beside(&hidden, area.width);
    let has_focus = app.panes.focus == pane && app.prompts.is_empty();
    let title = text::cut(
        &format!("{}{title}", key(app, pane)),
        room.saturating_sub(4),
    );
    let inner = text::titled(&title, area, app.look.theme, buffer);
    if has_focus && area.width > 4 {
        buffer.set_string(area.x, area.y, "▸", app.look.theme.title);
        buffer.set_stringn(
            area.x + 1,
            area.y,
            format!(" {title} "),
            usize::from(area.width) - 1,
            app.look.theme.key,
        );
    }
    if !hidden.is_empty() && room > LEAST_TITLE {
        buffer.set_string(area.x + room as u16, area.y, &hidden, Style::new());
    }
    inner
}

/// The pane out of sight whose name or key stands on a cell.
#[must_use]
pub fn named_at(app: &App, at: Position) -> Option<Pane> {
    let plan = plan(app.size, app.panes);
    let owner = plan.names_hidden()?;
    let area = plan.area(owner);
    let names = hidden(app, owner, area.width);
    let from = area.right().checked_sub(names.width() as u16 + 1)?;
    let column = usize::from(at.x.checked_sub(from)?);
    let begins = |pane: &Pane| {
        names
            .find(&format!(" {}", pane.number()))
            .is_some_and(|start| start <= column)
    };
    plan.hidden()
        .filter(begins)
        .last()
        .filter(|_| at.y == area.y && column < names.width())
}

// The keys and names of the panes that are not in sight; their keys alone where names have no room.
fn hidden(app: &App, pane: Pane, width: u16) -> String {
    let plan = plan(app.size, app.panes);
    if plan.names_hidden() != Some(pane) {
        return String::new();
    }
    let leave = if app.has_line() {
        format!(" {}", LEAVE.trim_end())
    } else {
        String::new()
    };
    let names = plan
        .hidden()
        .map(|pane| format!(" {} {} ", pane.number(), pane.name()));
    let named: String = std::iter::once(leave.clone()).chain(names).collect();
    if named.width() + LEAST_TITLE <= width.into() {
        return named;
    }
    let numbers: String = plan
        .hidden()
        .map(|pane| format!(" {}", pane.number()))
        .chain([" ".to_owned()])
        .collect();
    let in_full = leave + &numbers;
    if room_beside(&in_full, width) > LEAST_TITLE {
        in_full
    } else {
        numbers
    }
}

// The most that fits whole.
fn too_small(area: Rect, buffer: &mut Buffer) {
    let needed = format!("{}x{}", SMALLEST.width, SMALLEST.height);
    let needs = format!("tipstrike needs {needed};");
    let this = format!("this is {}x{}.", area.width, area.height);
    let width = usize::from(area.width);
    let sayings = [
        vec![needs, this, "Nothing is lost.".to_owned()],
        vec![format!("needs {needed}")],
        vec![needed],
    ];
    let wrapped = |lines: &Vec<String>| {
        lines
            .iter()
            .flat_map(|line| text::wrap(line, width))
            .collect::<Vec<_>>()
    };
    let is_whole = |lines: &Vec<String>| {
        lines
            .iter()
            .flat_map(|line| line.split(' '))
            .all(|word| word.len() <= width)
    };
    let fits =
        |lines: &&Vec<String>| is_whole(lines) && wrapped(lines).len() <= usize::from(area.height);
    let lines = sayings
        .iter()
        .find(fits)
        .or(sayings.last())
        .map(wrapped)
        .unwrap_or_default();
    for (line, y) in lines.iter().zip(area.top()..area.bottom()) {
        buffer.set_stringn(area.x, y, line, area.width.into(), Style::new());
    }
}

fn draw_panes(app: &App, area: Rect, buffer: &mut Buffer) -> Option<Position> {
    let plan = plan(area.as_size(), app.panes);
    status::header(app, plan.header, buffer);
    let in_form = form::draw(app, plan.form, buffer);
    for (pane, draw) in PANES {
        if !plan.area(pane).is_empty() {
            draw(app, plan.area(pane), buffer);
        }
    }
    status::hint(app, plan.hint, buffer);
    status::keys(app, plan.keys, buffer);
    match app.prompts.last() {
        Some(prompt) => popup::draw(app, prompt, area, buffer),
        None => in_form,
    }
}

/// How a pane is drawn into its area.
type Draw = fn(&App, Rect, &mut Buffer);

/// The panes beside the form.
const PANES: [(Pane, Draw); 4] = [
    (Pane::Results, results::draw),
    (Pane::Chart, draw_charts),
    (Pane::Teeth, draw_teeth),
    (Pane::Trade, trade::draw),
];

fn draw_charts(app: &App, area: Rect, buffer: &mut Buffer) {
    let charts = Charts {
        area,
        ..app.charts()
    };
    let title = panels::first_title(&charts, title_room(app, Pane::Chart, area.width));
    titled(app, Pane::Chart, &title, area, buffer);
    panels::draw(&charts, buffer);
}

fn draw_teeth(app: &App, area: Rect, buffer: &mut Buffer) {
    let stale = if app.tab.shows_last_valid() {
        "LAST VALID, "
    } else {
        ""
    };
    let centre = app.teeth.centre.name();
    let title = format!("{stale}Teeth, true to scale, around {centre}");
    let inner = titled(app, Pane::Teeth, &title, area, buffer);
    if let Some(picture) = app.picture() {
        teeth::draw(&picture, inner, buffer);
    } else {
        let message = if app.tab.answer.is_some() {
            "  This method has no valid results."
        } else {
            "  No results yet."
        };
        buffer.set_stringn(inner.x, inner.y, message, inner.width.into(), Style::new());
    }
}
