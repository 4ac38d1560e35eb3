//! A box in the middle of the screen with its lists and lines of text.

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Position, Rect, Size};
use ratatui::style::Style;
use ratatui::text::{Line, Span};
use ratatui::widgets::{Block, Borders, Clear, Padding, Widget};
use unicode_width::UnicodeWidthStr;

use crate::case::units::System;
use crate::tui::app::App;
use crate::tui::app::actions::{Running, Slot, Work};
use crate::tui::ascii::printable;
use crate::tui::line::Line as Input;
use crate::tui::store::folder::{self, Preview, Target};
use crate::tui::text;
use crate::tui::theme::Theme;

/// Greatest width of a box.
pub(super) const WIDEST: u16 = 100;
/// Least width, with room for four buttons.
const NARROWEST: u16 = 52;

/// The size inside the largest box.
#[must_use]
pub(super) fn room(screen: Rect) -> Size {
    Size::new(screen.width.min(WIDEST).saturating_sub(4), screen.height.saturating_sub(4))
}

/// Number of lines of a page in the largest box.
#[must_use]
pub(super) fn page_height(screen: Rect) -> isize {
    isize::from(room(screen).height.cast_signed()).max(1)
}

/// The first visible line after a scroll by `by` of the lines in the largest box.
pub(super) fn scrolled(top: usize, by: isize, count: usize, screen: Rect) -> usize {
    top.saturating_add_signed(by).min(count.saturating_sub(room(screen).height.into()))
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
    let title = text::cut(title, usize::from(area.width).saturating_sub(6));
    let title = Line::styled(format!(" {title} "), theme.title);
    Block::bordered().title(title).render(area, buffer);
    inside(wanted, screen)
}

/// The area inside a box.
#[must_use]
pub(super) fn inside(wanted: Size, screen: Rect) -> Rect {
    Block::bordered().padding(Padding::horizontal(1)).inner(outside(wanted, screen))
}

/// A box with an input line above other lines. Returns the input line and the position of the text
/// cursor.
pub(super) fn input_box(
    title: &str,
    width: u16,
    input: &Input,
    lines: &[Line<'_>],
    theme: &Theme,
    (screen, buffer): (Rect, &mut Buffer),
) -> (Rect, Option<Position>) {
    let size = Size::new(width, lines.len() as u16 + 1);
    let [line, below] = input_above(frame(title, size, screen, theme, buffer));
    text::draw_lines(lines, below, buffer);
    (line, text::edited(input, line, theme.focus, buffer))
}

/// The first line of an area, and the area below it.
#[must_use]
pub(super) fn input_above(area: Rect) -> [Rect; 2] {
    Layout::vertical([Constraint::Length(1), Constraint::Fill(1)]).areas(area)
}

/// A box that shows the lines from `top`, with a scroll bar if they do not fit.
pub(super) fn page_box(
    title: &str,
    lines: &[Line<'_>],
    top: usize,
    theme: &Theme,
    (screen, buffer): (Rect, &mut Buffer),
) -> Rect {
    let size = Size::new(WIDEST, extent(lines).height);
    let inner = frame(title, size, screen, theme, buffer);
    text::draw_lines(lines.get(top..).unwrap_or_default(), inner, buffer);
    text::scroll_bar_beside(top, lines.len(), inner, buffer);
    inner
}

/// A list on the left and its details on the right.
#[must_use]
pub(super) fn halves(area: Rect) -> [Rect; 2] {
    Layout::horizontal([Constraint::Percentage(40), Constraint::Fill(1)]).spacing(1).areas(area)
}

/// Draws the details on the right of a list.
pub(super) fn draw_details(
    lines: impl FnOnce(u16) -> Vec<Line<'static>>,
    area: Rect,
    buffer: &mut Buffer,
) {
    let beside = Block::new().borders(Borders::LEFT).padding(Padding::left(1));
    let inner = beside.inner(area);
    beside.render(area, buffer);
    text::draw_lines(&lines(inner.width), inner, buffer);
}

/// Draws the lines of a list around the selected one; only visible lines are built.
pub(super) fn draw_window(
    count: usize,
    line: impl Fn(usize) -> String,
    selected: Option<usize>,
    area: Rect,
    theme: &Theme,
    buffer: &mut Buffer,
) {
    for (at, row) in (top_of(selected, area)..count).zip(area.rows()) {
        let (sign, style) =
            if selected == Some(at) { ("▸", theme.focus) } else { (" ", Style::new()) };
        let line = text::cut(&format!("{sign} {}", line(at)), area.width.into());
        Span::styled(line, style).render(row, buffer);
    }
}

/// The index of the line at a cell, if any.
#[must_use]
pub(super) fn line_at(
    count: usize,
    selected: Option<usize>,
    area: Rect,
    at: Position,
) -> Option<usize> {
    let line = area.contains(at).then(|| top_of(selected, area) + usize::from(at.y - area.y));
    line.filter(|&line| line < count)
}

/// The size of lines of text.
#[must_use]
pub(super) fn extent(lines: &[Line<'_>]) -> Size {
    let width = lines.iter().map(Line::width).max().unwrap_or(0);
    let size = |length: usize| u16::try_from(length).unwrap_or(u16::MAX);
    Size::new(size(width), size(lines.len()))
}

/// The lines of a text in a width.
pub(super) fn said(text: &str, style: Style, width: u16) -> impl Iterator<Item = Line<'static>> {
    text::wrap(text, width.into()).into_iter().map(move |line| Span::styled(line, style).into())
}

/// A line in lines of a width; continuation lines begin below the second column of the line, if it
/// has one.
#[must_use]
pub(super) fn wrapped(line: &str, width: u16) -> Vec<String> {
    let width = usize::from(width);
    if line.width() <= width {
        return vec![printable(line).into_owned()];
    }
    let lead = line.len() - line.trim_start().len();
    let gap = line[lead..].find("  ").map(|at| lead + at);
    let column = gap.map(|gap| line.len() - line[gap..].trim_start().len());
    let (head, text) = line.split_at(column.filter(|_| line.is_ascii()).unwrap_or(lead));
    let mut lines = text::wrap(text, width.saturating_sub(head.len()));
    for (at, line) in lines.iter_mut().enumerate() {
        let lead = if at == 0 { head } else { &" ".repeat(head.len()) };
        line.insert_str(0, lead);
    }
    lines
}

/// The preview of the selected line of a list.
#[derive(Debug, Clone, Default)]
pub(super) struct PreviewPane {
    /// The target of the last request.
    target: Option<Target>,
    /// The preview, once it is computed.
    preview: Option<Preview>,
}

impl PreviewPane {
    /// The work of the preview, once for each selection.
    pub(super) fn request(&mut self, target: Option<Target>, units: System) -> Option<Work> {
        if target == self.target {
            return None;
        }
        (self.target, self.preview) = (target.clone(), None);
        let (own, path) = (target?, self.target.as_ref()?.path());
        let find = {
            let own = own.clone();
            move |running: &Running<'_>| folder::preview(&own, units, &|_| running.is_wanted())
        };
        let show = move |app: &mut App, preview| {
            if let Some(prompt) = app.prompts.last_mut() {
                prompt.dialog_mut().show(&own, preview);
            }
        };
        Some(Work::new(Slot::Preview, find, show).at(path))
    }

    /// Shows a preview if it belongs to the last request.
    pub(super) fn show(&mut self, target: &Target, preview: Preview) {
        if self.target.as_ref() == Some(target) {
            self.preview = Some(preview);
        }
    }

    /// The lines of the preview in a width.
    pub(super) fn lines(&self, width: u16, theme: &Theme) -> Vec<Line<'static>> {
        match (&self.target, &self.preview) {
            (None, _) => Vec::new(),
            (_, None) => vec![Line::styled("reading ...", theme.faint)],
            (_, Some(preview)) => {
                preview.iter().flat_map(|(text, tone)| said(text, tone(theme), width)).collect()
            }
        }
    }
}

fn outside(wanted: Size, screen: Rect) -> Rect {
    let room = room(screen);
    let height = wanted.height.clamp(1, room.height.max(1)) + 2;
    let width = wanted.width.max(NARROWEST).min(room.width) + 4;
    screen.centered(Constraint::Length(width), Constraint::Length(height)).intersection(screen)
}

fn top_of(selected: Option<usize>, area: Rect) -> usize {
    selected.map_or(0, |selected| (selected + 1).saturating_sub(area.height.into()))
}
