//! The dialog that searches for the tip relief to specify.

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Position, Rect};
use ratatui::text::{Line as Words, Span};
use ratatui::widgets::Widget;
use unicode_width::UnicodeWidthStr;

use super::{Dialog, Outcome, Surroundings, boxes};
use crate::model::Inputs;
use crate::report::relief::{ReliefReport, settings};
use crate::study::relief::{Demand, Specification};
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

    /// Whether the last search is for the typed demand.
    fn is_searched(&self) -> bool {
        self.searched.is_some() && Demand::parse(self.input.value()).ok() == self.searched
    }

    fn state(&self) -> String {
        let state = match (&self.problem, &self.answer) {
            (Some(problem), _) => return format!("! {problem}"),
            (None, None) => "Searching. Esc ends the search.",
            (None, Some(_)) if !self.is_searched() => "Enter searches again.",
            (None, Some(Ok(_))) => {
                "Enter writes the relief into the case; Down and PageDown scroll."
            }
            (None, Some(Err(_))) => "No relief is found.",
        };
        state.to_owned()
    }

    // Rows of tables keep their spaces.
    fn wrapped(&self, screen: Rect) -> Vec<Words<'static>> {
        let width = boxes::room(screen).width;
        self.lines.iter().flat_map(|line| boxes::wrapped(line, width)).map(Words::from).collect()
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
        let count = self.wrapped(around.screen).len() + usize::from(HEAD);
        self.top = boxes::scrolled(self.top, by, count, around.screen);
    }

    fn turn(&mut self, by: isize, around: &Surroundings<'_>) {
        let page = boxes::page_height(around.screen) - HEAD.cast_signed() as isize;
        self.step(by * page.max(1), around);
    }

    fn accept(&mut self, _: &Surroundings<'_>) -> Outcome {
        match &self.answer {
            _ if !self.is_searched() => Outcome::Jobs(self.search()),
            Some(Ok(found)) => Outcome::Relief(settings(&found.chosen().reliefs)),
            _ => Outcome::none(),
        }
    }

    fn draw(&self, around: &Surroundings<'_>, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let theme = around.look.theme;
        let inner = boxes::frame("Tip relief", boxes::room(area), area, theme, buffer);
        let [line, state, _, below] = Layout::vertical([
            Constraint::Length(1),
            Constraint::Length(1),
            Constraint::Length(1),
            Constraint::Fill(1),
        ])
        .areas(inner);
        let lines = self.wrapped(area);
        text::draw_lines(lines.get(self.top..).unwrap_or_default(), below, buffer);
        Span::styled(text::cut(&self.state(), inner.width.into()), theme.note)
            .render(state, buffer);
        let [label, line] =
            Layout::horizontal([Constraint::Length(LABEL.width() as u16), Constraint::Fill(1)])
                .areas(line);
        Span::raw(LABEL).render(label, buffer);
        text::edited(&self.input, line, theme.focus, buffer)
    }
}
