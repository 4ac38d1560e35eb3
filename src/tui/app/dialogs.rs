//! The dialogs over the panes. Each file contains the state, keys, update and drawing of one
//! dialog; what a dialog changes in the workbench, the caller gives to it.

pub(crate) mod boxes;
pub(crate) mod browser;
pub(crate) mod cursor_to;
pub(crate) mod page;
pub(crate) mod picker;
pub(crate) mod question;
mod relief;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::App;
use super::actions::{Change, Choice, Work};
use crate::case::units::System;
use crate::tui::keys::Place;
use crate::tui::line::Line;
use crate::tui::store::folder::{Preview, Target};
use crate::tui::theme::Look;

use browser::Browser;
use cursor_to::{CursorScope, CursorTo};
use page::{Explanation, Page};
use picker::Picker;
use question::{PathDialog, Question};
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

    /// The change of the state by Enter.
    fn accept(&mut self, _around: &Surroundings<'_>) -> Option<Change> {
        None
    }

    /// The edited line of text.
    fn input(&mut self) -> Option<&mut Line> {
        None
    }

    /// Handles a change of the edited line.
    fn typed(&mut self) -> Vec<Work> {
        Vec::new()
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

    /// The work that previews the selection, once for each selection.
    fn preview(&mut self, _units: System) -> Option<Work> {
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
}

// Closes the dialog, then carries out the choice.
fn closing(choice: &Choice) -> Change {
    let change = choice.change();
    Change::of(|app| {
        app.prompts.pop();
        change.apply(app);
    })
}

impl App {
    /// Passes control to the topmost dialog; `None` if there is no dialog.
    pub(crate) fn with_dialog<T>(
        &mut self,
        act: impl FnOnce(&mut dyn Dialog, &Surroundings<'_>) -> T,
    ) -> Option<T> {
        let mut prompt = self.prompts.pop()?;
        let result = act(prompt.dialog_mut(), &self.surroundings());
        self.prompts.push(prompt);
        Some(result)
    }

    pub(crate) fn ask(&mut self, question: Question) {
        self.prompts.push(Prompt::Ask(question));
    }

    pub(crate) fn pick(&mut self, picker: Picker) {
        self.prompts.push(Prompt::Pick(picker));
    }

    /// Enter in the topmost dialog.
    pub(crate) fn accept(&mut self) {
        if let Some(change) = self.with_dialog(|dialog, around| dialog.accept(around)).flatten() {
            change.apply(self);
        }
    }

    /// The topmost dialog if it is the file browser.
    pub(crate) fn browser(&mut self) -> Option<&mut Browser> {
        match self.prompts.last_mut() {
            Some(Prompt::Browse(browser)) => Some(browser),
            _ => None,
        }
    }

    /// Goes to the parent folder in the file browser.
    pub(crate) fn browse_up(&mut self) {
        let work = self.browser().map(Browser::leave);
        self.start_all(work);
    }

    /// Handles a change of the line of the topmost dialog.
    pub(crate) fn line_changed(&mut self) {
        let prompt = self.prompts.last_mut();
        let works = prompt.map_or_else(Vec::new, |prompt| prompt.dialog_mut().typed());
        self.start_all(works);
    }

    /// Closes the topmost dialog if it is a path or a question with this title.
    pub(crate) fn close_titled(&mut self, title: &str) -> bool {
        let is_it = match self.prompts.last() {
            Some(Prompt::Path(dialog)) => dialog.title == title,
            Some(Prompt::Ask(question)) => question.title == title,
            _ => false,
        };
        if is_it {
            self.prompts.pop();
        }
        is_it
    }
}
