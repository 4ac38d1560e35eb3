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

/// The least columns of a title beside the keys of hidden panes, and beside their names.
const LEAST_TITLE: usize = 16;
const TITLE_BESIDE_NAMES: usize = 32;

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
    room_beside(&hidden, width).saturating_sub(4 + "0 ".len())
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
        &format!("{} {title}", pane.number()),
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
    let named: Vec<_> = plan
        .hidden()
        .map(|pane| format!(" {} {} ", pane.number(), pane.name()))
        .collect();
    let named = named.concat();
    if named.width() + TITLE_BESIDE_NAMES <= width.into() {
        return named;
    }
    plan.hidden()
        .map(|pane| format!(" {}", pane.number()))
        .chain([" ".to_owned()])
        .collect()
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
    let stale = if app.is_stale() { "LAST VALID, " } else { "" };
    let centre = app.teeth.centre.name();
    let title = format!("{stale}Teeth, true to scale, around {centre}");
    let inner = titled(app, Pane::Teeth, &title, area, buffer);
    if let Some(picture) = app.picture() {
        teeth::draw(&picture, inner, buffer);
    } else {
        let message = "  This method has no valid results.";
        buffer.set_stringn(inner.x, inner.y, message, inner.width.into(), Style::new());
    }
}
