//! The dialog that searches for the tip relief to specify.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use unicode_width::UnicodeWidthStr;

use super::boxes::{frame, page_height, room};
use super::{Dialog, Outcome, Surroundings};
use crate::model::Inputs;
use crate::report::relief::{ReliefReport, settings};
use crate::study::relief::{Demand, Specification};
use crate::tui::ascii::printable;
use crate::tui::jobs::{Job, ReliefRequest};
use crate::tui::keys::Place;
use crate::tui::line::Line;
use crate::tui::text;

/// The label of the input line.
const LABEL: &str = "Load range and tolerance: ";
/// Rows above the result.
const HEAD: u16 = 3;

/// The search and its result.
#[derive(Debug, Clone)]
pub struct ReliefDialog {
    /// The typed load range and tolerance.
    pub(crate) input: Line,
    inputs: Inputs,
    /// The demand of the last search.
    searched: Option<Demand>,
    answer: Option<Result<Box<Specification>, String>>,
    lines: Vec<String>,
    /// Why the typed text is not a valid demand.
    problem: Option<String>,
    top: usize,
}

impl ReliefDialog {
    /// The dialog on a pair, before its first search.
    pub(crate) fn new(inputs: Inputs) -> ReliefDialog {
        ReliefDialog {
            input: Line::whole(Demand::USUAL.text()),
            inputs,
            searched: None,
            answer: None,
            lines: Vec::new(),
            problem: None,
            top: 0,
        }
    }

    /// Searches for the typed demand.
    pub(crate) fn search(&mut self) -> Vec<Job> {
        self.top = 0;
        match Demand::parse(self.input.value()) {
            Ok(demand) => {
                (self.searched, self.answer, self.problem) = (Some(demand), None, None);
                self.lines.clear();
                let inputs = self.inputs.clone();
                vec![Job::Relief(Box::new(ReliefRequest { demand, inputs }))]
            }
            Err(problem) => {
                self.problem = Some(problem);
                Vec::new()
            }
        }
    }

    /// Shows the result of the search for a demand.
    pub(crate) fn take(&mut self, demand: Demand, found: Result<Box<Specification>, String>) {
        if Some(demand) != self.searched {
            return;
        }
        self.lines = match &found {
            Ok(found) => ReliefReport { method: self.inputs.method, found }.without_title(),
            Err(reason) => vec![reason.clone()],
        };
        self.answer = Some(found);
    }

    /// The specification for the typed demand.
    fn found(&self) -> Option<&Specification> {
        let typed = Demand::parse(self.input.value()).ok();
        let is_current = typed.is_some() && typed == self.searched;
        let answer = self.answer.as_ref().filter(|_| is_current)?;
        answer.as_ref().ok().map(|found| &**found)
    }

    fn state(&self) -> String {
        let typed = Demand::parse(self.input.value()).ok();
        match (&self.problem, &self.answer) {
            (Some(problem), _) => format!("! {problem}"),
            (None, None) => "Searching. Esc ends the search.".to_owned(),
            (None, Some(_)) if typed != self.searched => "Enter searches again.".to_owned(),
            (None, Some(Ok(_))) => {
                "Enter writes the relief into the case; Down and PageDown scroll.".to_owned()
            }
            (None, Some(Err(_))) => "No relief is found.".to_owned(),
        }
    }

    fn wrapped(&self, width: usize) -> impl Iterator<Item = String> {
        let lines = self.lines.iter();
        // Rows of tables keep their spaces.
        lines.flat_map(move |line| {
            if line.width() <= width {
                vec![printable(line).to_string()]
            } else {
                text::wrap(line, width)
            }
        })
    }

    fn scroll(&mut self, by: isize, around: &Surroundings<'_>) {
        let room = room(around.screen);
        let shown = usize::from(room.height.saturating_sub(HEAD));
        let last = self.wrapped(room.width.into()).count().saturating_sub(shown);
        self.top = self.top.saturating_add_signed(by).min(last);
    }
}

impl Dialog for ReliefDialog {
    fn place(&self) -> Place {
        Place::PICK
    }

    fn input(&mut self) -> Option<&mut Line> {
        Some(&mut self.input)
    }

    fn typed(&mut self) -> Vec<Job> {
        self.problem = None;
        Vec::new()
    }

    fn step(&mut self, by: isize, around: &Surroundings<'_>) {
        self.scroll(by, around);
    }

    fn turn(&mut self, by: isize, around: &Surroundings<'_>) {
        let page = page_height(around.screen) - HEAD.cast_signed() as isize;
        self.scroll(by * page.max(1), around);
    }

    fn accept(&mut self, _: &Surroundings<'_>) -> Outcome {
        if let Some(found) = self.found() {
            return Outcome::Relief(settings(&found.chosen().reliefs));
        }
        let typed = Demand::parse(self.input.value()).ok();
        if typed.is_some() && typed == self.searched {
            return Outcome::none();
        }
        Outcome::Jobs(self.search())
    }

    fn draw(&self, around: &Surroundings<'_>, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let theme = around.look.theme;
        let inner = frame("Tip relief", room(area.as_size()), area, theme, buffer);
        let width = usize::from(inner.width);
        let below = inner.top() + HEAD.min(inner.height)..inner.bottom();
        for (line, y) in self.wrapped(width).skip(self.top).zip(below) {
            buffer.set_stringn(inner.x, y, line, width, Style::new());
        }
        if inner.height > 1 {
            let state = text::cut(&self.state(), width);
            buffer.set_stringn(inner.x, inner.y + 1, state, width, theme.note);
        }
        buffer.set_stringn(inner.x, inner.y, LABEL, width, Style::new());
        let label = (LABEL.width() as u16).min(inner.width);
        let line = Rect {
            x: inner.x + label,
            width: inner.width - label,
            height: inner.height.min(1),
            ..inner
        };
        text::edited(&self.input, line, theme.focus, buffer)
    }
}
