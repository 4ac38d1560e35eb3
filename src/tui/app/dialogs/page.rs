//! Pages: a page of text, and the explanation of a result: the page of `tipstrike explain`, with a
//! selection among the fields of its last list.

use ratatui::buffer::Buffer;
use ratatui::layout::Position;
use ratatui::style::Style;
use ratatui::text::{Line as Words, Span};

use super::{Dialog, wrapped};
use crate::case::fields::index_of;
use crate::model::Quantity;
use crate::report::Shown;
use crate::report::explain::{Kind, Line, Page as ExplanationPage, lines};
use crate::tui::app::App;
use crate::tui::app::actions::Change;
use crate::tui::app::panes::results::in_full;
use crate::tui::layout::Place;
use crate::tui::settings::Theme;
use crate::tui::text::written_out;

/// A page of text.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Page {
    title: String,
    /// The lines; `None` for the present outcome of the open case with every note.
    lines: Option<Vec<String>>,
    /// The first visible line.
    top: usize,
}

impl Page {
    /// A page that shows its first line.
    pub(crate) fn new(title: impl Into<String>, lines: Option<Vec<String>>) -> Page {
        Page { title: title.into(), lines, top: 0 }
    }

    /// The page from a line of its text.
    pub(crate) fn at(mut self, line: &str, app: &App) -> Page {
        let top = self.wrapped(app).iter().position(|own| own.to_string() == line);
        self.step(top.unwrap_or(0).cast_signed(), app);
        self
    }

    fn wrapped(&self, app: &App) -> Vec<Words<'static>> {
        let width = app.room().width;
        let lines = self.lines.clone().unwrap_or_else(|| in_full(app));
        lines.iter().flat_map(|line| wrapped(line, width)).map(Words::from).collect()
    }
}

impl Dialog for Page {
    fn place(&self) -> Place {
        Place::READ
    }

    fn step(&mut self, by: isize, app: &App) {
        self.top = app.scrolled(self.top, by, self.wrapped(app).len());
    }

    fn draw(&self, app: &App, buffer: &mut Buffer) -> Option<Position> {
        app.page_box(&self.title, &self.wrapped(app), self.top, buffer);
        None
    }
}

/// An open explanation.
#[derive(Debug, Clone)]
pub struct Explanation {
    /// The result.
    pub quantity: &'static Quantity,
    /// The name of the case.
    case: String,
    /// The value in the units of the results, if these differ from the units of the page.
    value: Option<Shown>,
    /// The page, or the reason of its absence; `None` while the job runs.
    pub page: Option<Result<Box<ExplanationPage>, String>>,
    /// The first visible line.
    pub top: usize,
    /// The index of the selected field.
    selected: Option<usize>,
    go_to: fn(&mut App, usize),
}

impl Explanation {
    /// An explanation without its page, which a job computes.
    pub(crate) fn new(
        quantity: &'static Quantity,
        case: String,
        value: Option<Shown>,
        go_to: fn(&mut App, usize),
    ) -> Explanation {
        Explanation { quantity, case, value, page: None, top: 0, selected: None, go_to }
    }

    /// The keys of the fields that the result depends on, in the order of the page.
    pub fn fields(&self) -> Vec<&'static str> {
        let effects = self.page.iter().flatten().flat_map(|page| &page.effects);
        let (acting, idle): (Vec<_>, Vec<_>) =
            effects.partition(|effect| !effect.change.is_empty());
        acting.into_iter().chain(idle).map(|effect| effect.key).collect()
    }

    /// The selected field.
    pub fn field(&self) -> Option<&'static str> {
        self.fields().get(self.selected?).copied()
    }

    fn lines(&self, app: &App) -> Vec<Line> {
        let width = app.room().width;
        let said = |text: String| Line { kind: Kind::Text, text };
        let units = "in inch units; this page is in metric ones.";
        let mut all: Vec<_> =
            self.value.iter().map(|value| said(format!("{value} {units}"))).collect();
        match &self.page {
            None => all.push(said("computing: each field is changed by a small step".to_owned())),
            Some(Err(reason)) => all.push(said(reason.clone())),
            Some(Ok(page)) => all.extend(lines(page, &self.case, width.into())),
        }
        // Symbols spelled in ASCII may need another line.
        let in_ascii = |Line { kind, text }: Line| {
            let lines = wrapped(&written_out(&text), width);
            lines.into_iter().map(move |text| Line { kind, text })
        };
        if app.look.ascii { all.into_iter().flat_map(in_ascii).collect() } else { all }
    }

    // Row and column of the selected field, and its key. No line breaks inside a key.
    fn place_of_field(&self, lines: &[Line]) -> Option<(usize, usize, &'static str)> {
        let key = self.field()?;
        let list = lines.iter().rposition(|line| line.kind == Kind::Heading)?;
        let is_part = |letter: char| letter.is_alphanumeric() || letter == '_';
        let at = |text: &str| {
            let mut ends = text.match_indices(key).map(|(at, _)| at);
            ends.find(|at| !text[at + key.len()..].starts_with(is_part))
        };
        let mut rows = lines.iter().enumerate().skip(list + 1);
        rows.find_map(|(row, line)| Some((row, at(&line.text)?, key)))
    }
}

impl Dialog for Explanation {
    fn place(&self) -> Place {
        Place::EXPLAIN
    }

    fn step(&mut self, by: isize, app: &App) {
        self.top = app.scrolled(self.top, by, self.lines(app).len());
    }

    // Wraps app, and makes the selected field visible.
    fn select_field(&mut self, by: isize, app: &App) {
        let count = self.fields().len();
        let from = self.selected.unwrap_or(if by > 0 { count.saturating_sub(1) } else { 0 });
        self.selected = (count > 0).then(|| (from + count).saturating_add_signed(by) % count);
        if let Some((row, ..)) = self.place_of_field(&self.lines(app)) {
            let height = app.page_height().unsigned_abs();
            self.top = self.top.clamp((row + 1).saturating_sub(height), row);
        }
    }

    // Without a selected field, selects the first one.
    fn accept(&mut self, app: &App) -> Option<Change> {
        if let Some(field) = self.field().and_then(index_of) {
            let go_to = self.go_to;
            return Some(Change::of(move |app| go_to(app, field)));
        }
        self.select_field(1, app);
        None
    }

    fn draw(&self, app: &App, buffer: &mut Buffer) -> Option<Position> {
        let (lines, theme) = (self.lines(app), app.look.theme);
        let mut shown: Vec<_> = lines.iter().map(|line| styled(line, theme)).collect();
        if let Some((row, at, key)) = self.place_of_field(&lines) {
            let text = &lines[row].text;
            let before = text[..at].strip_suffix(' ').unwrap_or(&text[..at]);
            shown[row] = Words::from(vec![
                Span::raw(before),
                Span::styled("▸", theme.focus),
                Span::styled(key, theme.key),
                Span::raw(&text[at + key.len()..]),
            ]);
        }
        app.page_box(self.quantity.label.trim(), &shown, self.top, buffer);
        None
    }
}

fn styled<'l>(line: &'l Line, theme: &Theme) -> Words<'l> {
    let style = match line.kind {
        Kind::Title => theme.focus,
        Kind::Heading => theme.title,
        Kind::Outside => theme.problem,
        Kind::Formula | Kind::Numbers | Kind::Text => Style::new(),
    };
    Span::styled(line.text.as_str(), style).into()
}
