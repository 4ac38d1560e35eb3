//! The header: the open cases.

use std::ops::Range;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::text::{Line, Span};

use super::app::App;
use super::tab::{Origin, Tab};
use super::text;

/// The start of the header.
const HEAD: &str = "tipstrike";
/// Precedes the visible tabs if there are others before them.
const BEFORE: &str = "‹ ";
/// A longer name is cut if there are several tabs.
const LONGEST_NAME: usize = 24;
/// The open cases, the current one with its path and title, with marks for unsaved edits.
pub(super) fn draw(app: &App, area: Rect, buffer: &mut Buffer) {
    let mut spans = vec![Span::styled(HEAD, app.look.theme.title), Span::raw("  ")];
    if app.others.is_empty() {
        spans.extend(only_case(app, area.width));
    } else {
        spans.extend(tabs(app, area.width));
    }
    text::draw_lines(&[Line::from(spans)], area, buffer);
}

fn only_case(app: &App, width: u16) -> Vec<Span<'static>> {
    let tab = &app.tab;
    let is_last = tab.origin == Origin::LastCase;
    let last = if is_last { " (last case; Alt-T: Table 1)" } else { "" };
    let unsaved = if tab.is_unsaved() { " *unsaved*" } else { "" };
    let mark = format!("{unsaved}{}{last}", tab.marks());
    let room = usize::from(width).saturating_sub(11 + text::width(&mark));
    let instead = tab.in_place_of.as_ref();
    let instead = instead.map(|path| format!(" ({} cannot be opened)", path.display()));
    let name = text::cut(&format!("{}{}", tab.name(), instead.unwrap_or_default()), room);
    let left = room.saturating_sub(text::width(&name) + 3);
    let title = Some(tab.case.title()).filter(|title| !title.is_empty() && left > 8);
    let title = title.map(|title| format!("   {}", text::cut(title, left))).unwrap_or_default();
    vec![Span::raw(name), Span::styled(mark, app.look.theme.note), Span::raw(title)]
}

/// The index of the open case whose name is at a cell, if any.
pub(super) fn tab_at(app: &App, area: Rect, at: Position) -> Option<usize> {
    if app.others.is_empty() || !area.contains(at) {
        return None;
    }
    let (names, Range { start, end }) = shown_tabs(app, area.width);
    let mut right = usize::from(area.x)
        + text::width(HEAD)
        + 2
        + if start > 0 { text::width(BEFORE) } else { 0 };
    (start..end).find(|&tab| {
        let left = right;
        right += text::width(&names[tab]) + 2;
        (left..right).contains(&at.x.into())
    })
}

// The open cases with their numbers, as many around the current one as fit, and a mark at each end
// with hidden ones.
fn tabs(app: &App, width: u16) -> Vec<Span<'static>> {
    let (names, Range { start, end }) = shown_tabs(app, width);
    let mut spans = vec![Span::raw(if start > 0 { BEFORE } else { "" })];
    for (at, name) in names.iter().enumerate().take(end).skip(start) {
        spans.push(if at == app.place_of_tab {
            Span::styled(format!("[{name}]"), app.look.theme.key)
        } else {
            Span::raw(format!(" {name} "))
        });
    }
    spans.push(Span::raw(if end < names.len() { " ›" } else { "" }));
    spans
}

/// The names of the open cases, and the range of names that fit: from the current one on, then before
/// it.
fn shown_tabs(app: &App, width: u16) -> (Vec<String>, Range<usize>) {
    const OTHER_TEXT: usize = 15;
    let name = |(at, tab): (usize, &Tab)| {
        let (name, marks) = (text::cut(&tab.short_name(), LONGEST_NAME), tab.marks());
        format!("{} {name}{}{marks}", at + 1, if tab.is_unsaved() { "*" } else { "" })
    };
    let names: Vec<String> = app.tabs().enumerate().map(name).collect();
    let room = usize::from(width).saturating_sub(OTHER_TEXT);
    let fits = |from: usize, to: usize| {
        names[from..to].iter().map(|name| text::width(name) + 2).sum::<usize>() <= room
    };
    let at = app.place_of_tab;
    let to = (at + 1..=names.len()).rev().find(|&to| fits(at, to)).unwrap_or(at + 1);
    let from = (0..at).find(|&from| fits(from, to)).unwrap_or(at);
    (names, from..to)
}
