//! The dialogs over the panes. Each is a file with its state, keys, update and drawing.

mod boxes;
pub(crate) mod browser;
pub(crate) mod cursor_to;
mod digest;
pub(crate) mod explanation;
pub(crate) mod export;
pub(crate) mod page;
pub(crate) mod picker;
pub(crate) mod question;
mod relief;
pub(crate) mod save_as;

use std::path::PathBuf;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};

use super::actions::{Action, Effect};
use super::cursor_range::CursorScope;
use super::keys::Place;
use super::line::Line;
use super::session::save::Next;
use super::theme::Look;
use crate::case::units::System;

use browser::Browser;
use cursor_to::CursorTo;
use explanation::Explanation;
use export::ExportTo;
use page::Page;
use picker::{Pick, Picker};
use question::{Choice, Question};
pub(crate) use relief::ReliefDialog;
use save_as::SaveAs;

/// What every dialog does. By default it ignores a key.
pub(crate) trait Dialog {
    /// The keys that it takes.
    fn place(&self) -> Place;

    /// Draws it over the screen, and returns the place of the text cursor.
    fn draw(
        &self,
        around: &Surroundings<'_>,
        screen: Rect,
        buffer: &mut Buffer,
    ) -> Option<Position>;

    /// Enter.
    fn accept(&mut self, around: &Surroundings<'_>) -> Outcome;

    /// Esc: the dialog is gone.
    fn close(&mut self) -> Vec<Effect> {
        Vec::new()
    }

    /// The line of text that it edits.
    fn input(&mut self) -> Option<&mut Line> {
        None
    }

    /// The text of its line has changed.
    fn typed(&mut self) -> Vec<Effect> {
        Vec::new()
    }

    /// A letter that is an answer of its own; `None` if it is text for the line.
    fn letter(&mut self, _letter: char) -> Option<Outcome> {
        None
    }

    /// A line further.
    fn step(&mut self, _by: isize, _around: &Surroundings<'_>) {}

    /// A page further.
    fn turn(&mut self, _by: isize, _around: &Surroundings<'_>) {}

    /// A turn of the wheel.
    fn wheel(&mut self, by: isize, around: &Surroundings<'_>) {
        self.step(by, around);
    }

    /// A press of the mouse. Returns whether it accepts.
    fn click(&mut self, _at: Position, _screen: Size) -> bool {
        false
    }

    /// Selects another field behind an explained result.
    fn select_field(&mut self, _by: isize, _around: &Surroundings<'_>) {}

    /// The result of a job that it may have requested.
    fn receive(&mut self, _result: Action) {}

    /// The job that previews the selection, once for each selection.
    fn preview(&mut self, _units: System) -> Option<Effect> {
        None
    }
}

/// What a dialog needs to know of the workbench.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Surroundings<'a> {
    /// The size of the screen.
    pub(crate) screen: Size,
    /// The capabilities of the terminal.
    pub(crate) look: Look,
    /// The charts and the pane in which the cursor moves.
    pub(crate) cursor: CursorScope<'a>,
}

/// What the user decided in a dialog.
#[derive(Debug, Clone)]
pub(crate) enum Outcome {
    /// Nothing yet; effects of the dialog itself.
    Effects(Vec<Effect>),
    /// Open a file.
    Open(PathBuf),
    /// An answer to a question.
    Choose(Choice),
    /// Save under that name, then go on.
    SaveAs(String, Next),
    /// Take these values of fields into the case.
    Relief(Vec<(&'static str, String)>),
    /// Export to the file of that name.
    Export(String),
    /// Move the cursor to that angle, in rad before E; or why there is none.
    CursorTo(Result<f64, String>),
    /// A line of a list.
    Pick(Pick),
    /// Go to a field.
    GoTo(usize),
}

impl Outcome {
    /// Nothing.
    #[must_use]
    pub(crate) fn none() -> Outcome {
        Outcome::Effects(Vec::new())
    }
}

/// An open dialog.
#[derive(Debug, Clone)]
pub enum Prompt {
    /// Which file to open.
    Browse(Box<Browser>),
    /// The file to save to.
    SaveAs(SaveAs),
    /// The file to export to.
    Export(ExportTo),
    /// Where the cursor is to go.
    CursorTo(CursorTo),
    /// A question with buttons.
    Ask(Question),
    /// A page of text.
    Read(Page),
    /// The explanation of a result.
    Explain(Explanation),
    /// The tip relief to specify.
    Relief(Box<ReliefDialog>),
    /// A list to pick from.
    Pick(Picker),
}

impl Prompt {
    #[must_use]
    pub(crate) fn dialog(&self) -> &dyn Dialog {
        match self {
            Prompt::Browse(dialog) => &**dialog,
            Prompt::SaveAs(dialog) => dialog,
            Prompt::Export(dialog) => dialog,
            Prompt::CursorTo(dialog) => dialog,
            Prompt::Ask(dialog) => dialog,
            Prompt::Read(dialog) => dialog,
            Prompt::Explain(dialog) => dialog,
            Prompt::Relief(dialog) => &**dialog,
            Prompt::Pick(dialog) => dialog,
        }
    }

    /// The dialog, to change it.
    pub(crate) fn dialog_mut(&mut self) -> &mut dyn Dialog {
        match self {
            Prompt::Browse(dialog) => &mut **dialog,
            Prompt::SaveAs(dialog) => dialog,
            Prompt::Export(dialog) => dialog,
            Prompt::CursorTo(dialog) => dialog,
            Prompt::Ask(dialog) => dialog,
            Prompt::Read(dialog) => dialog,
            Prompt::Explain(dialog) => dialog,
            Prompt::Relief(dialog) => &mut **dialog,
            Prompt::Pick(dialog) => dialog,
        }
    }

    /// The browser of files, if it is one.
    pub(crate) fn browser(&mut self) -> Option<&mut Browser> {
        match self {
            Prompt::Browse(browser) => Some(browser),
            _ => None,
        }
    }

    /// Whether it asks for the name of a file to save to.
    pub(crate) fn is_save_as(&self) -> bool {
        matches!(self, Prompt::SaveAs(_))
    }

    /// Whether it asks what to do about an export that runs.
    pub(crate) fn is_about_running_export(&self) -> bool {
        matches!(self, Prompt::Ask(question) if question.is_about_running_export())
    }

    /// Whether it asks for the name of a file to export to.
    pub(crate) fn is_export(&self) -> bool {
        matches!(self, Prompt::Export(_))
    }
}
