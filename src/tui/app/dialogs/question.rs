//! Questions with buttons, and the question for a path.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::Style;
use ratatui::text::{Line as Words, Span};
use ratatui::widgets::Widget;
use unicode_width::UnicodeWidthStr;

use super::{Dialog, Surroundings, boxes, closing};
use crate::tui::app::App;
use crate::tui::app::actions::{Change, Choice};
use crate::tui::keys::Place;
use crate::tui::line::Line;
use crate::tui::session::save::Next;
use crate::tui::text;

/// Width of brackets, marks and gap around the name of a button.
const BESIDE_NAME: u16 = 7;

/// A question with buttons.
#[derive(Debug, Clone)]
pub struct Question {
    pub(crate) title: &'static str,
    /// The question.
    pub(crate) text: String,
    /// Details, one line each.
    pub(crate) details: Vec<String>,
    /// The answers. The first letter of each selects it.
    pub(crate) buttons: Vec<(&'static str, Choice)>,
    pub(crate) selected: usize,
}

impl Question {
    /// A question whose last button is selected, so that an accidental Enter changes nothing.
    pub(crate) fn new(
        title: &'static str,
        text: String,
        buttons: impl Into<Vec<(&'static str, Choice)>>,
    ) -> Question {
        let buttons = buttons.into();
        let selected = buttons.len() - 1;
        Question { title, text, details: Vec::new(), buttons, selected }
    }

    /// The change by the button that begins with a letter.
    pub(crate) fn by_letter(&self, letter: char) -> Option<Change> {
        let fits = |(name, _): &&(&str, Choice)| {
            name.starts_with(|first: char| first.eq_ignore_ascii_case(&letter))
        };
        self.buttons.iter().find(fits).map(|(_, choice)| closing(choice))
    }

    // The lines above the buttons. The buttons must be visible: details that do not fit are
    // omitted, one line each.
    fn lines(&self, room: Size) -> Vec<Words<'static>> {
        let mut lines: Vec<_> = boxes::said(&self.text, Style::new(), room.width).collect();
        let left = usize::from(room.height).saturating_sub(lines.len() + 2);
        let count = self.details.len();
        let shown = if count <= left { count } else { left.saturating_sub(1) };
        let cut = |line: &String| Words::from(text::cut(&format!("  {line}"), room.width.into()));
        lines.extend(self.details[..shown].iter().map(cut));
        lines.extend(
            (shown < count && left > 0).then(|| format!("  and {} more", count - shown).into()),
        );
        // An empty line, and the line of the buttons.
        lines.extend([Words::default(), Words::default()]);
        lines
    }

    // The row of the buttons; empty if there is no room.
    fn button_row(lines: &[Words<'_>], inner: Rect) -> Rect {
        inner.rows().nth(lines.len() - 1).unwrap_or_default()
    }
}

impl Dialog for Question {
    fn place(&self) -> Place {
        Place::ASK
    }

    // Wraps around.
    fn step(&mut self, by: isize, _: &Surroundings<'_>) {
        let count = self.buttons.len();
        self.selected = (self.selected + count).saturating_add_signed(by) % count;
    }

    fn wheel(&mut self, _: isize, _: &Surroundings<'_>) {}

    fn click(&mut self, at: Position, screen: Rect) -> bool {
        let lines = self.lines(boxes::room(screen));
        let row = Question::button_row(&lines, boxes::inside(boxes::extent(&lines), screen));
        let mut right = row.x;
        // The gap before the next button is not part of a button.
        let button = self.buttons.iter().position(|(name, _)| {
            right += name.width() as u16 + BESIDE_NAME;
            at.x + 1 < right
        });
        let button = button.filter(|_| row.contains(at));
        self.selected = button.unwrap_or(self.selected);
        button.is_some()
    }

    fn accept(&mut self, _: &Surroundings<'_>) -> Option<Change> {
        self.buttons.get(self.selected).map(|(_, choice)| closing(choice))
    }

    fn draw(&self, around: &Surroundings<'_>, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let theme = around.look.theme;
        let lines = self.lines(boxes::room(area));
        let inner = boxes::frame(self.title, boxes::extent(&lines), area, theme, buffer);
        text::draw_lines(&lines, inner, buffer);
        let buttons = self.buttons.iter().enumerate().flat_map(|(at, (name, _))| {
            let button = if at == self.selected {
                Span::styled(format!("[> {name} <]"), theme.key)
            } else {
                Span::raw(format!("[  {name}  ]"))
            };
            [button, Span::raw(" ")]
        });
        buttons.collect::<Words<'_>>().render(Question::button_row(&lines, inner), buffer);
        None
    }
}

/// The dialog for a path, to save or to export to.
#[derive(Debug, Clone)]
pub struct PathDialog {
    pub(crate) title: &'static str,
    pub(crate) how: &'static str,
    /// The typed path.
    pub(crate) input: Line,
    /// The step after a save.
    pub(crate) next: Next,
    pub(crate) done: fn(&mut App, &str, Next),
}

impl Dialog for PathDialog {
    fn place(&self) -> Place {
        Place::PATH
    }

    fn input(&mut self) -> Option<&mut Line> {
        Some(&mut self.input)
    }

    fn accept(&mut self, _: &Surroundings<'_>) -> Option<Change> {
        let (done, path, next) = (self.done, self.input.value().to_owned(), self.next.clone());
        Some(Change::of(move |app| done(app, &path, next)))
    }

    fn draw(&self, around: &Surroundings<'_>, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let theme = around.look.theme;
        let how: Vec<_> = boxes::said(self.how, theme.faint, boxes::room(area).width).collect();
        boxes::input_box(self.title, boxes::WIDEST, &self.input, &how, theme, (area, buffer)).1
    }
}
