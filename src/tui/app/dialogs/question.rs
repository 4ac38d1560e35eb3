//! Questions with buttons, and dialogs for a line of text such as a path.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::Style;
use ratatui::text::{Line as Words, Span, Text};
use ratatui::widgets::Widget;
use unicode_width::UnicodeWidthStr;

use super::{Dialog, WIDEST, closing, extent, said};
use crate::tui::app::App;
use crate::tui::app::actions::{Change, Choice};
use crate::tui::layout::Place;
use crate::tui::session::Next;
use crate::tui::text;
use crate::tui::text::Line;

/// Width of brackets, marks and gap app the name of a button.
const BESIDE_NAME: u16 = 7;

/// A question with buttons.
#[derive(Debug, Clone)]
pub struct Question {
    pub(super) title: &'static str,
    text: String,
    /// Details, one line each.
    details: Vec<String>,
    /// The answers. The first letter of each selects it.
    buttons: Vec<(&'static str, Choice)>,
    selected: usize,
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

    pub(crate) fn with(self, details: Vec<String>) -> Question {
        Question { details, ..self }
    }

    /// The question with another button selected.
    pub(crate) fn on(self, selected: usize) -> Question {
        Question { selected, ..self }
    }

    /// The change by the button that begins with a letter.
    pub(crate) fn by_letter(&self, letter: char) -> Option<Change> {
        let fits = |(name, _): &&(&str, Choice)| {
            name.starts_with(|first: char| first.eq_ignore_ascii_case(&letter))
        };
        self.buttons.iter().find(fits).map(|(_, choice)| closing(choice))
    }

    // The lines above the buttons, and the rows of text and buttons inside the box. The buttons
    // must be visible: details that do not fit are omitted.
    fn lines(&self, app: &App) -> Vec<Words<'static>> {
        let room = app.room();
        let mut lines = said(&self.text, Style::new(), room.width);
        let left = usize::from(room.height).saturating_sub(lines.len() + 2);
        let count = self.details.len();
        let shown = if count <= left { count } else { left.saturating_sub(1) };
        let cut = |line: &String| Words::from(text::cut(&format!("  {line}"), room.width.into()));
        lines.extend(self.details[..shown].iter().map(cut));
        let more = shown < count && left > 0;
        lines.extend(more.then(|| format!("  and {} more", count - shown).into()));
        // An empty line, and the line of the buttons.
        lines.extend([Words::default(), Words::default()]);
        lines
    }
}

// The row of the buttons; empty if there is no room.
fn button_row(lines: &[Words<'_>], inner: Rect) -> Rect {
    inner.rows().nth(lines.len() - 1).unwrap_or_default()
}

impl Dialog for Question {
    fn place(&self) -> Place {
        Place::ASK
    }

    // Wraps app.
    fn step(&mut self, by: isize, _: &App) {
        let count = self.buttons.len();
        self.selected = (self.selected + count).saturating_add_signed(by) % count;
    }

    fn wheel(&mut self, _: isize, _: &App) {}

    fn click(&mut self, at: Position, app: &App) -> bool {
        let lines = self.lines(app);
        let row = button_row(&lines, app.inside(extent(&lines)));
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

    fn accept(&mut self, _: &App) -> Option<Change> {
        self.buttons.get(self.selected).map(|(_, choice)| closing(choice))
    }

    fn draw(&self, app: &App, buffer: &mut Buffer) -> Option<Position> {
        let lines = self.lines(app);
        let inner = app.frame(self.title, extent(&lines), buffer);
        lines.iter().cloned().collect::<Text<'_>>().render(inner, buffer);
        let buttons = self.buttons.iter().enumerate().flat_map(|(at, (name, _))| {
            let button = if at == self.selected {
                Span::styled(format!("[> {name} <]"), app.look.theme.key)
            } else {
                Span::raw(format!("[  {name}  ]"))
            };
            [button, Span::raw(" ")]
        });
        buttons.collect::<Words<'_>>().render(button_row(&lines, inner), buffer);
        None
    }
}

/// What a typed text means or why it is not valid, and its completion.
type Meaning = fn(&App, &str) -> (Result<String, String>, Option<String>);

/// The dialog for a line of text, such as a path to save or to export to.
#[derive(Debug, Clone)]
pub struct PathDialog {
    pub(crate) title: &'static str,
    pub(crate) how: &'static str,
    pub(crate) input: Line,
    /// The step after a save.
    pub(crate) next: Next,
    pub(crate) meaning: Option<Meaning>,
    pub(crate) done: fn(&mut App, &str, Next),
}

impl PathDialog {
    pub(crate) fn new(
        title: &'static str,
        how: &'static str,
        input: Line,
        done: fn(&mut App, &str, Next),
    ) -> PathDialog {
        PathDialog { title, how, input, next: Next::Stay, meaning: None, done }
    }
}

impl Dialog for PathDialog {
    fn place(&self) -> Place {
        Place::PATH
    }

    fn input(&mut self) -> Option<&mut Line> {
        Some(&mut self.input)
    }

    fn accept(&mut self, _: &App) -> Option<Change> {
        let (done, text, next) = (self.done, self.input.value().to_owned(), self.next.clone());
        Some(Change::of(move |app| done(app, &text, next)))
    }

    fn draw(&self, app: &App, buffer: &mut Buffer) -> Option<Position> {
        let (typed, theme, width) = (self.input.value(), app.look.theme, app.room().width);
        let (meant, ending) = self.meaning.map(|meaning| meaning(app, typed)).unzip();
        let meant = meant.map(|meant| match meant {
            Ok(text) => Words::styled(text::cut(&text, width.into()), theme.note),
            Err(reason) => Words::styled(text::cut(&reason, width.into()), theme.faint),
        });
        let lines = meant.into_iter().chain(said(self.how, theme.faint, width));
        let lines = lines.collect::<Text<'_>>();
        let size = Size::new(WIDEST, lines.height() as u16 + 1);
        let [line, below] = text::split(app.frame(self.title, size, buffer), 1);
        lines.render(below, buffer);
        let cursor = text::edited(&self.input, line, theme.focus, buffer);
        text::ending(ending.flatten().as_deref(), typed.width(), line, theme, buffer);
        cursor
    }
}
