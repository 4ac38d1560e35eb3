//! A box in the middle of the screen, with its lists, and the digest of a case as lines.

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Position, Rect, Size};
use ratatui::style::Style;
use ratatui::text::Line;
use ratatui::widgets::{Block, Clear, Widget};
use unicode_width::UnicodeWidthStr;

use crate::report::digest::Digest;
use crate::tui::line::Line as Input;
use crate::tui::text;
use crate::tui::theme::Theme;

/// Greatest width of a box.
pub(super) const WIDEST: u16 = 100;
/// Least width, with room for four buttons.
const NARROWEST: u16 = 52;

/// The size inside the largest box.
#[must_use]
pub(super) fn room(screen: Size) -> Size {
    Size {
        width: screen.width.min(WIDEST).saturating_sub(4),
        height: screen.height.saturating_sub(4),
    }
}

/// Number of lines of a page in the largest box.
#[must_use]
pub(super) fn page_height(screen: Size) -> isize {
    isize::try_from(room(screen).height).unwrap_or(1).max(1)
}

/// Selects a line. Returns whether the line was already selected.
pub(super) fn select(selected: &mut usize, line: usize) -> bool {
    std::mem::replace(selected, line) == line
}

/// Clears a box with a border, as large as wanted if there is room, and returns its inside.
pub(super) fn frame(
    title: &str,
    wanted: Size,
    screen: Rect,
    theme: &Theme,
    buffer: &mut Buffer,
) -> Rect {
    let area = outside(wanted, screen);
    Clear.render(area, buffer);
    let title = Line::styled(
        format!(" {} ", text::cut(title, usize::from(area.width).saturating_sub(6))),
        theme.title,
    );
    Block::bordered().title(title).render(area, buffer);
    inside(wanted, screen)
}

/// A box with a line for a path and a sentence of help. Returns the position of the text cursor.
pub(super) fn path_box(
    title: &str,
    how: &str,
    input: &Input,
    theme: &Theme,
    (screen, buffer): (Rect, &mut Buffer),
) -> Option<Position> {
    let how = text::wrap(how, usize::from(room(screen.as_size()).width));
    let size = Size::new(WIDEST, how.len() as u16 + 1);
    let inner = frame(title, size, screen, theme, buffer);
    for (line, y) in how.iter().zip(inner.top() + 1..inner.bottom()) {
        buffer.set_stringn(inner.x, y, line, inner.width.into(), theme.faint);
    }
    let line = Rect { height: inner.height.min(1), ..inner };
    text::edited(input, line, theme.focus, buffer)
}

/// The area inside a box.
#[must_use]
pub(super) fn inside(wanted: Size, screen: Rect) -> Rect {
    let inner = Block::bordered().inner(outside(wanted, screen));
    Rect { x: inner.x + 1, width: inner.width.saturating_sub(2), ..inner }
}

/// Splits an area into a list on the left and its details on the right, with a rule between them.
pub(super) fn halves(area: Rect, buffer: &mut Buffer) -> (Rect, Rect) {
    let left = area.width * 2 / 5;
    for y in area.top()..area.bottom() {
        buffer.set_stringn(area.x + left, y, "│", usize::from(area.width > left), Style::new());
    }
    parted(area)
}

/// Both halves without the rule.
#[must_use]
pub(super) fn parted(area: Rect) -> (Rect, Rect) {
    let left = area.width * 2 / 5;
    let right = area.width.saturating_sub(left + 2);
    (
        Rect { width: left.saturating_sub(1), ..area },
        Rect { x: area.right() - right, width: right, ..area },
    )
}

/// Draws the lines of a list around the selected one; only visible lines are built.
pub(super) fn draw_window(
    count: usize,
    line: impl Fn(usize) -> String,
    marked: Option<usize>,
    area: Rect,
    theme: &Theme,
    buffer: &mut Buffer,
) {
    for (at, y) in (top_of(marked, area)..count).zip(area.top()..area.bottom()) {
        let is_marked = marked == Some(at);
        let line = format!("{} {}", if is_marked { "▸" } else { " " }, line(at));
        let style = if is_marked { theme.focus } else { Style::new() };
        buffer.set_stringn(
            area.x,
            y,
            text::cut(&line, area.width.into()),
            area.width.into(),
            style,
        );
    }
}

/// The index of the line at a cell, if any.
#[must_use]
pub(super) fn line_at(
    count: usize,
    marked: Option<usize>,
    area: Rect,
    at: Position,
) -> Option<usize> {
    let line = area.contains(at).then(|| top_of(marked, area) + usize::from(at.y - area.y));
    line.filter(|&line| line < count)
}

/// The size of the lines with `more` additional lines.
pub(super) fn extent(lines: &[String], more: usize) -> Size {
    let width = lines.iter().map(|line| line.width()).max().unwrap_or(0);
    let size = |length: usize| u16::try_from(length).unwrap_or(u16::MAX);
    Size { width: size(width), height: size(lines.len() + more) }
}

/// The lines in `width` columns, each with its style.
#[must_use]
pub(super) fn digest_lines(digest: &Digest, width: usize, theme: &Theme) -> Vec<(String, Style)> {
    let plain = Style::new();
    let title = if digest.title.is_empty() { "without a title" } else { &digest.title };
    let said = |text: &str, style: Style| {
        text::wrap(text, width).into_iter().map(move |line| (line, style))
    };
    let empty = || std::iter::once((String::new(), plain));
    let mut lines: Vec<_> = said(title, theme.title).collect();
    lines.extend(
        [&digest.pair, &digest.load, &format!("method {}", digest.method)]
            .into_iter()
            .flat_map(|text| said(text, plain)),
    );
    lines.extend(empty().chain(said(&digest.outcome, theme.focus)));
    for (standing, text) in &digest.limits {
        let style = if standing.holds() { plain } else { theme.problem };
        lines.extend(said(&format!("{} {text}", standing.word()), style));
    }
    if digest.limits.is_empty() {
        lines.extend(said("No limits.", plain));
    }
    lines.extend(
        digest
            .notes
            .iter()
            .flat_map(|note| empty().chain(said(&format!("Note: {note}"), theme.note))),
    );
    lines
}

fn outside(wanted: Size, screen: Rect) -> Rect {
    let room = room(screen.as_size());
    let height = wanted.height.clamp(1, room.height.max(1)) + 2;
    let width = wanted.width.max(NARROWEST).min(room.width) + 4;
    screen.centered(Constraint::Length(width), Constraint::Length(height)).intersection(screen)
}

fn top_of(marked: Option<usize>, area: Rect) -> usize {
    marked.map_or(0, |marked| (marked + 1).saturating_sub(area.height.into()))
}
