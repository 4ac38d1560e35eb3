//! Pages: a page of text, and the explanation of a result: the page of `tipstrike explain`, with a
//! selection among the fields of its last list.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::Style;

use super::boxes::{self, extent, frame, page_height, room};
use super::{Dialog, Outcome, Surroundings};
use crate::case::fields::index_of;
use crate::model::Quantity;
use crate::report::Shown;
use crate::report::explain::{Kind, Line, Page as ExplanationPage, lines};
use crate::tui::ascii::written_out;
use crate::tui::keys::Place;
use crate::tui::text;
use crate::tui::theme::Theme;

/// A page of text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Page {
    /// The title.
    pub(crate) title: String,
    pub(crate) lines: Vec<String>,
    /// The first visible line.
    pub(crate) top: usize,
    /// Whether it shows the outcome of the open case.
    pub(crate) is_of_results: bool,
}

impl Page {
    /// A page that shows its first line.
    #[must_use]
    pub(crate) fn new(title: impl Into<String>, lines: Vec<String>) -> Page {
        Page { title: title.into(), lines, top: 0, is_of_results: false }
    }

    fn scroll(&mut self, by: isize, screen: Size) {
        let last = wrapped(self, screen).len().saturating_sub(room(screen).height.into());
        self.top = self.top.saturating_add_signed(by).min(last);
    }
}

impl Dialog for Page {
    fn place(&self) -> Place {
        Place::READ
    }

    fn step(&mut self, by: isize, around: &Surroundings<'_>) {
        self.scroll(by, around.screen);
    }

    fn turn(&mut self, by: isize, around: &Surroundings<'_>) {
        self.scroll(by * page_height(around.screen), around.screen);
    }

    fn accept(&mut self, _: &Surroundings<'_>) -> Outcome {
        Outcome::none()
    }

    fn draw(&self, around: &Surroundings<'_>, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        draw_page(self, area, around.look.theme, buffer);
        None
    }
}

/// An open explanation.
#[derive(Debug, Clone)]
pub struct Explanation {
    /// The result.
    pub quantity: &'static Quantity,
    /// The name of the case.
    pub(crate) case: String,
    /// The value in the units of the results, if these differ from the units of the page.
    pub(crate) value: Option<Shown>,
    /// The page, or the reason of its absence; `None` while the job runs.
    pub page: Option<Result<Box<ExplanationPage>, String>>,
    /// The first visible line.
    pub top: usize,
    /// The index of the selected field.
    pub(crate) marked: Option<usize>,
}

impl Explanation {
    /// An explanation without its page, which a job computes.
    #[must_use]
    pub(crate) fn new(
        quantity: &'static Quantity,
        case: String,
        value: Option<Shown>,
    ) -> Explanation {
        Explanation { quantity, case, value, page: None, top: 0, marked: None }
    }

    /// The keys of the fields that the result depends on, in the order of the page.
    #[must_use]
    pub fn fields(&self) -> Vec<&'static str> {
        let Some(Ok(page)) = &self.page else {
            return Vec::new();
        };
        let (acting, idle): (Vec<_>, Vec<_>) =
            page.effects.iter().partition(|effect| !effect.change.is_empty());
        acting.into_iter().chain(idle).map(|effect| effect.key).collect()
    }

    /// The selected field.
    #[must_use]
    pub fn field(&self) -> Option<&'static str> {
        self.fields().get(self.marked?).copied()
    }

    /// Selects the next or previous field, wrapping around.
    pub(crate) fn mark(&mut self, by: isize) {
        let count = self.fields().len();
        let from =
            self.marked.map_or(if by > 0 { count.saturating_sub(1) } else { 0 }, |marked| marked);
        self.marked = (count > 0).then(|| (from + count).saturating_add_signed(by) % count);
    }

    /// Scrolls by `by` lines, within the page.
    pub fn scroll(&mut self, by: isize, screen: Size, ascii: bool) {
        let last = explanation_text(self, screen, ascii)
            .len()
            .saturating_sub(boxes::room(screen).height.into());
        self.top = self.top.saturating_add_signed(by).min(last);
    }

    // Makes the selected field visible.
    fn follow(&mut self, screen: Size, ascii: bool) {
        let lines = explanation_text(self, screen, ascii);
        let height = usize::from(boxes::room(screen).height).max(1);
        if let Some((row, ..)) = place_of_field(self, &lines) {
            self.top = self.top.clamp((row + 1).saturating_sub(height), row);
        }
    }
}

impl Dialog for Explanation {
    fn place(&self) -> Place {
        Place::EXPLAIN
    }

    fn step(&mut self, by: isize, around: &Surroundings<'_>) {
        self.scroll(by, around.screen, around.look.ascii);
    }

    fn turn(&mut self, by: isize, around: &Surroundings<'_>) {
        let height = boxes::page_height(around.screen);
        self.scroll(by * height, around.screen, around.look.ascii);
    }

    fn select_field(&mut self, by: isize, around: &Surroundings<'_>) {
        self.mark(by);
        self.follow(around.screen, around.look.ascii);
    }

    // Without a selected field, selects the first one.
    fn accept(&mut self, around: &Surroundings<'_>) -> Outcome {
        if let Some(field) = self.field().and_then(index_of) {
            return Outcome::GoTo(field);
        }
        self.select_field(1, around);
        Outcome::none()
    }

    fn draw(
        &self,
        around: &Surroundings<'_>,
        screen: Rect,
        buffer: &mut Buffer,
    ) -> Option<Position> {
        let look = around.look;
        let theme = look.theme;
        let lines = explanation_text(self, screen.as_size(), look.ascii);
        let wanted =
            Size { width: u16::MAX, height: u16::try_from(lines.len()).unwrap_or(u16::MAX) };
        let inner = boxes::frame(self.quantity.label.trim(), wanted, screen, theme, buffer);
        let marked = place_of_field(self, &lines);
        for ((at, line), y) in
            lines.iter().enumerate().skip(self.top).zip(inner.top()..inner.bottom())
        {
            buffer.set_stringn(inner.x, y, &line.text, inner.width.into(), style(line.kind, theme));
            if let Some((_, column, key)) = marked.filter(|(row, ..)| *row == at) {
                let x = inner.x + column;
                buffer.set_stringn(x.saturating_sub(1), y, "▸", 1, theme.focus);
                buffer.set_stringn(
                    x,
                    y,
                    key,
                    usize::from(inner.right().saturating_sub(x)),
                    theme.key,
                );
            }
        }
        text::scroll_bar_beside(self.top, lines.len(), inner, buffer);
        None
    }
}

// The lines of a page wrapped for its box; continuation lines are indented.
fn wrapped(page: &Page, screen: Size) -> Vec<String> {
    let width = usize::from(room(screen).width);
    let wrap = |line: &String| {
        let indent = hanging(line);
        let (head, text) = line.split_at(indent);
        let pieces = text::wrap(text, width.saturating_sub(indent));
        let head = head.to_owned();
        pieces.into_iter().enumerate().map(move |(index, piece)| {
            if index == 0 { head.clone() + &piece } else { " ".repeat(indent) + &piece }
        })
    };
    page.lines.iter().flat_map(wrap).collect()
}

// The indent of continuation lines: the second column of the line, if it has one.
fn hanging(line: &str) -> usize {
    let lead = line.len() - line.trim_start().len();
    let gap = line[lead..].find("  ").map(|at| lead + at);
    let column = gap.map(|gap| line.len() - line[gap..].trim_start().len());
    column.filter(|_| line.is_ascii()).unwrap_or(lead)
}

fn draw_page(page: &Page, screen: Rect, theme: &Theme, buffer: &mut Buffer) {
    let lines = wrapped(page, screen.as_size());
    let inner = frame(&page.title, extent(&lines, 0), screen, theme, buffer);
    for (line, y) in lines.iter().skip(page.top).zip(inner.top()..inner.bottom()) {
        buffer.set_stringn(inner.x, y, line, inner.width.into(), Style::new());
    }
    text::scroll_bar_beside(page.top, lines.len(), inner, buffer);
}

fn explanation_text(explanation: &Explanation, screen: Size, ascii: bool) -> Vec<Line> {
    let width = boxes::room(screen).width.into();
    let said = |text: &str| vec![Line { kind: Kind::Text, text: text.to_owned() }];
    let page = match &explanation.page {
        None => said("computing: each field is changed by a small step"),
        Some(Err(reason)) => said(reason),
        Some(Ok(page)) => lines(page, &explanation.case, width),
    };
    let other_units = explanation
        .value
        .iter()
        .flat_map(|value| said(&format!("{value} in inch units; this page is in metric ones.")));
    let lines = other_units.chain(page);
    if ascii { lines.flat_map(|line| in_ascii(&line, width)).collect() } else { lines.collect() }
}

// Symbols spelled in ASCII may need another line.
fn in_ascii(line: &Line, width: usize) -> Vec<Line> {
    let written = written_out(&line.text);
    let indent = written.len() - written.trim_start().len();
    let pieces = text::wrap(&written[indent..], width.saturating_sub(indent + 2));
    if written.len() <= width {
        return vec![Line { kind: line.kind, text: written.into_owned() }];
    }
    let lead = |at: usize| " ".repeat(indent + if at == 0 { 0 } else { 2 });
    pieces
        .iter()
        .enumerate()
        .map(|(at, piece)| Line { kind: line.kind, text: lead(at) + piece })
        .collect()
}

// Row and column of the selected field, and its key. No line breaks inside a key.
fn place_of_field(explanation: &Explanation, lines: &[Line]) -> Option<(usize, u16, &'static str)> {
    let key = explanation.field()?;
    let list = lines.iter().rposition(|line| line.kind == Kind::Heading)?;
    let is_end = |letter: char| !letter.is_alphanumeric() && letter != '_';
    let whole = |text: &str| {
        text.match_indices(key)
            .map(|(at, _)| at)
            .find(|at| text[at + key.len()..].chars().next().is_none_or(is_end))
    };
    let found = lines
        .iter()
        .enumerate()
        .skip(list + 1)
        .find_map(|(row, line)| Some((row, whole(&line.text)?)));
    let (row, at) = found?;
    Some((row, u16::try_from(lines[row].text[..at].chars().count()).ok()?, key))
}

fn style(kind: Kind, theme: &Theme) -> Style {
    match kind {
        Kind::Title => theme.focus,
        Kind::Heading => theme.title,
        Kind::Outside => theme.problem,
        Kind::Formula | Kind::Numbers | Kind::Text => Style::new(),
    }
}
