//! The dialogs over the panes. Each file contains the state, keys, update and drawing of one
//! dialog.

mod boxes;
pub(crate) mod browser;
pub(crate) mod cursor_to;
pub(crate) mod page;
pub(crate) mod path;
pub(crate) mod picker;
pub(crate) mod question;
mod relief;

use std::path::PathBuf;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::jobs::Job;
use super::keys::Place;
use super::line::Line;
use super::session::save::Next;
use super::store::folder::{Preview, Target};
use super::theme::Look;
use crate::case::units::System;

use browser::Browser;
use cursor_to::{CursorScope, CursorTo};
use page::{Explanation, Page};
use path::PathDialog;
use picker::{Pick, Picker};
use question::{Choice, Question};
pub(crate) use relief::ReliefDialog;

/// The interface of a dialog. By default it ignores a key.
pub(crate) trait Dialog {
    /// The place that decides the meaning of keys.
    fn place(&self) -> Place;

    /// Draws the dialog over the screen and returns the position of the text cursor.
    fn draw(
        &self,
        around: &Surroundings<'_>,
        screen: Rect,
        buffer: &mut Buffer,
    ) -> Option<Position>;

    /// Handles Enter.
    fn accept(&mut self, around: &Surroundings<'_>) -> Outcome;

    /// The edited line of text.
    fn input(&mut self) -> Option<&mut Line> {
        None
    }

    /// Handles a change of the edited line.
    fn typed(&mut self) -> Vec<Job> {
        Vec::new()
    }

    /// The outcome of a letter that is a command of the dialog; `None` if the letter is text.
    fn letter(&mut self, _letter: char) -> Option<Outcome> {
        None
    }

    /// Moves by `by` lines.
    fn step(&mut self, _by: isize, _around: &Surroundings<'_>) {}

    /// Moves by `by` pages.
    fn turn(&mut self, by: isize, around: &Surroundings<'_>) {
        self.step(by * boxes::page_height(around.screen), around);
    }

    /// Handles the mouse wheel.
    fn wheel(&mut self, by: isize, around: &Surroundings<'_>) {
        self.step(by, around);
    }

    /// Handles a mouse click. Returns whether it accepts.
    fn click(&mut self, _at: Position, _screen: Rect) -> bool {
        false
    }

    /// Selects another field behind an explained result.
    fn select_field(&mut self, _by: isize, _around: &Surroundings<'_>) {}

    /// The job that previews the selection, once for each selection.
    fn preview(&mut self, _units: System) -> Option<Job> {
        None
    }

    /// Shows a preview.
    fn show(&mut self, _target: &Target, _preview: Preview) {}
}

/// The context of a dialog.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Surroundings<'a> {
    pub(crate) screen: Rect,
    /// The capabilities of the terminal.
    pub(crate) look: Look,
    /// The visible charts and the pane in which the cursor moves.
    pub(crate) cursor: CursorScope<'a>,
}

/// The decision of the user in a dialog.
#[derive(Debug, Clone)]
pub(crate) enum Outcome {
    /// No decision yet; jobs of the dialog itself.
    Jobs(Vec<Job>),
    /// Open a file.
    Open(PathBuf),
    /// An answer to a question.
    Choose(Choice),
    /// Save under this name, then continue with the next step.
    SaveAs(String, Next),
    /// Write these values of fields into the case.
    Relief(Vec<(&'static str, String)>),
    /// Export to the file with this name.
    Export(String),
    /// Move the cursor to this angle, in rad before E; or the reason of the refusal.
    CursorTo(Result<f64, String>),
    /// The selected line of a list.
    Pick(Pick),
    /// Go to a field.
    GoTo(usize),
}

impl Outcome {
    /// No effect.
    #[must_use]
    pub(crate) fn none() -> Outcome {
        Outcome::Jobs(Vec::new())
    }
}

/// An open dialog.
#[derive(Debug, Clone)]
pub enum Prompt {
    /// The file browser.
    Browse(Box<Browser>),
    /// The file to save or to export to.
    Path(PathDialog),
    /// The angle for the cursor.
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
            Prompt::Path(dialog) => dialog,
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
            Prompt::Path(dialog) => dialog,
            Prompt::CursorTo(dialog) => dialog,
            Prompt::Ask(dialog) => dialog,
            Prompt::Read(dialog) => dialog,
            Prompt::Explain(dialog) => dialog,
            Prompt::Relief(dialog) => &mut **dialog,
            Prompt::Pick(dialog) => dialog,
        }
    }

    /// The file browser, if it is one.
    pub(crate) fn browser(&mut self) -> Option<&mut Browser> {
        match self {
            Prompt::Browse(browser) => Some(browser),
            _ => None,
        }
    }

    /// Whether it is the dialog for the path to save to.
    pub(crate) fn is_save_as(&self) -> bool {
        matches!(self, Prompt::Path(dialog) if dialog.save.is_some())
    }

    /// Whether it is the question about a running export.
    pub(crate) fn is_about_running_export(&self) -> bool {
        matches!(self, Prompt::Ask(question) if question.is_about_running_export())
    }

    /// Whether it is the dialog for the path to export to.
    pub(crate) fn is_export(&self) -> bool {
        matches!(self, Prompt::Path(dialog) if dialog.save.is_none())
    }
}
