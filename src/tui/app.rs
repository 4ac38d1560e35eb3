//! The state of the workbench: plain data, changed by `update` alone.

use std::path::PathBuf;

use ratatui::layout::Size;
use ratatui::symbols::Marker;
use tui_input::Input;

use super::actions::Place;
use super::prompt::Prompt;
use super::recovery::Access;
use super::scale::Scale;
use super::solver::{self, Answer, Request};
use super::theme::Look;
use super::view::form;
use crate::case::fields::{Absent, Kind};
use crate::case::{Case, Document, FIELDS, Problem, fields};
use crate::model::Refusal;

/// Everything that the screen shows.
#[derive(Debug, Clone)]
pub struct App {
    /// The file's text, in which a save keeps comments and order.
    pub document: Document,
    /// Where it was read from, or last saved to.
    pub path: Option<PathBuf>,
    /// The case in the form.
    pub case: Case,
    /// The case as the file has it.
    pub saved: Case,
    /// Whether the file may be written.
    pub access: Access,
    /// The focused field.
    pub focus: usize,
    /// The text of the focused field, and the cursor in it.
    pub input: Input,
    /// States to go back to.
    pub history: History,
    /// What is wrong in the form.
    pub problems: Vec<(usize, Problem)>,
    /// Counts the edits that led to a request.
    pub serial: u64,
    /// The last valid results.
    pub answer: Option<Answer>,
    /// Why the model does not solve what the form says.
    pub refusal: Option<Refusal>,
    /// Whether the worker failed on what the form says.
    pub has_failed: bool,
    /// What lies over the form, the topmost last.
    pub prompts: Vec<Prompt>,
    /// Said once, until the next key.
    pub message: Option<Message>,
    /// The size of the terminal.
    pub size: Size,
    /// The first line of the form that is shown.
    pub form_top: usize,
    /// The first line of the results that is shown.
    pub results_top: usize,
    /// What shares the screen.
    pub panes: Panes,
    /// The axes of the chart.
    pub scale: Scale,
    /// How the chart draws a point.
    pub marker: Marker,
    /// What the terminal is able to show.
    pub look: Look,
}

/// Something said once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// The words.
    pub text: String,
    /// Whether something went wrong.
    pub is_fault: bool,
}

/// What shares the screen.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Panes {
    /// Form, results and chart.
    All,
    /// Form and results.
    NoChart,
    /// The chart alone.
    Chart,
}

/// States of the case to go back to, one for each visit of a field.
#[derive(Debug, Clone, Default)]
pub struct History {
    past: Vec<(Case, usize)>,
    future: Vec<(Case, usize)>,
    is_visiting: bool,
}

impl App {
    /// Open a document, solved at once so that the first frame is whole.
    #[must_use]
    pub fn new(document: Document, path: Option<PathBuf>, look: Look, size: Size) -> App {
        let case = document.case.clone();
        let mut app = App {
            saved: case.clone(),
            case,
            document,
            path,
            access: Access::default(),
            focus: 0,
            input: Input::default(),
            history: History::default(),
            problems: Vec::new(),
            serial: 0,
            answer: None,
            refusal: None,
            has_failed: false,
            prompts: Vec::new(),
            message: None,
            size,
            form_top: 0,
            results_top: 0,
            panes: Panes::All,
            scale: Scale::default(),
            marker: Marker::Braille,
            look,
        };
        app.focus_on(fields::index_of("pair.module").unwrap_or(0));
        if let Some(request) = app.request() {
            app.take(solver::answer(&request));
        }
        app
    }

    /// Whether the form differs from the file.
    #[must_use]
    pub fn is_unsaved(&self) -> bool {
        self.case != self.saved
    }

    /// Whether the results are not those of what the form says now.
    #[must_use]
    pub fn is_stale(&self) -> bool {
        !self.problems.is_empty() || self.refusal.is_some() || self.has_failed
    }

    /// Where keys go.
    #[must_use]
    pub fn place(&self) -> Place {
        match self.prompts.last() {
            Some(prompt) => prompt.place(),
            None if matches!(FIELDS[self.focus].kind, Kind::Choice(..)) => Place::CHOICE,
            None => Place::TEXT,
        }
    }

    /// The name of the case in the title and in questions.
    #[must_use]
    pub fn name(&self) -> String {
        self.path.as_ref().map_or_else(|| "built-in Table 1".to_owned(), |path| path.display().to_string())
    }

    /// Say something until the next key.
    pub(super) fn say(&mut self, text: impl Into<String>) {
        self.message = Some(Message { text: text.into(), is_fault: false });
    }

    /// Say what went wrong, until the next key.
    pub(super) fn complain(&mut self, text: impl Into<String>) {
        self.message = Some(Message { text: text.into(), is_fault: true });
    }

    /// Move to a field, the cursor at the end of its text.
    pub(super) fn focus_on(&mut self, field: usize) {
        self.focus = field.min(FIELDS.len() - 1);
        self.input = Input::from(self.case.text(self.focus).unwrap_or_default());
        self.history.end_visit();
        self.follow();
    }

    /// Scroll the form until the focused line and what is wrong with it are in sight.
    pub(super) fn follow(&mut self) {
        self.form_top = form::top_for(self);
    }

    /// Put another case into the form, and ask for its results.
    pub(super) fn replace_case(&mut self, case: Case, focus: usize) -> Option<Request> {
        self.case = case;
        let request = self.request();
        self.focus_on(focus);
        request
    }

    /// Check the form; when it is valid, what the worker shall solve.
    pub(super) fn request(&mut self) -> Option<Request> {
        match self.case.inputs() {
            Ok(inputs) => {
                self.problems.clear();
                self.serial += 1;
                Some(Request { serial: self.serial, inputs })
            }
            Err(problems) => {
                self.refusal = None;
                self.problems = problems.into_iter().map(|problem| (self.place_of(&problem), problem)).collect();
                None
            }
        }
    }

    /// Show an answer, unless a later one is on its way.
    pub(super) fn take(&mut self, answer: Answer) {
        if answer.serial != self.serial {
            return;
        }
        self.has_failed = false;
        self.refusal = answer.refusal().copied();
        if self.refusal.is_none() {
            self.scale = self.scale.fitted(&answer);
            self.answer = Some(answer);
        }
    }

    fn place_of(&self, problem: &Problem) -> usize {
        fields::index_of(&problem.field).unwrap_or(self.focus)
    }
}

/// What holds where the case is silent, in a person's words.
#[must_use]
pub fn unwritten(case: &Case, field: usize) -> String {
    match FIELDS[field].absent {
        Absent::Default("") => String::new(),
        Absent::Default(text) | Absent::Without(text) => format!("({text})"),
        Absent::Refused => "(needed)".to_owned(),
        Absent::Either(other) => {
            let other = fields::index_of(other).filter(|&other| case.text(other).is_some());
            other.map_or_else(|| "(needed)".to_owned(), |other| format!("(by {})", FIELDS[other].label))
        }
    }
}

impl History {
    /// Remember the state before the first edit of a visit.
    pub(super) fn before_edit(&mut self, case: &Case, focus: usize) {
        if !self.is_visiting {
            self.past.push((case.clone(), focus));
            self.is_visiting = true;
        }
        self.future.clear();
    }

    /// The next edit begins a state of its own.
    pub(super) fn end_visit(&mut self) {
        self.is_visiting = false;
    }

    /// The state before, in exchange for the present one.
    pub(super) fn undo(&mut self, case: &Case, focus: usize) -> Option<(Case, usize)> {
        let state = self.past.pop()?;
        self.future.push((case.clone(), focus));
        Some(state)
    }

    /// The state that was undone, in exchange for the present one.
    pub(super) fn redo(&mut self, case: &Case, focus: usize) -> Option<(Case, usize)> {
        let state = self.future.pop()?;
        self.past.push((case.clone(), focus));
        Some(state)
    }
}
