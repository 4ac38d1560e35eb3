//! The dialogs for a path: to export to, and to save to.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::boxes::path_box;
use super::{Dialog, Outcome, Surroundings};
use crate::tui::keys::Place;
use crate::tui::line::Line;
use crate::tui::session::save::Next;

/// The instruction.
const NAMING: &str = "A name or a path; ~ is the home folder. The file extension selects the \
    content: .html, .md, .csv and .json write the report, .svg writes the visible chart or the \
    teeth.";

/// The instruction.
const SAVE_NAMING: &str =
    "A name or a path; ~ is the home folder, .toml is added if missing. Asks before overwriting.";

/// The dialog with its typed path.
#[derive(Debug, Clone)]
pub struct ExportTo {
    /// The typed path.
    pub(crate) input: Line,
}

impl Dialog for ExportTo {
    fn place(&self) -> Place {
        Place::PATH
    }

    fn input(&mut self) -> Option<&mut Line> {
        Some(&mut self.input)
    }

    fn accept(&mut self, _: &Surroundings<'_>) -> Outcome {
        Outcome::Export(self.input.value().to_owned())
    }

    fn draw(&self, around: &Surroundings<'_>, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        path_box("Export", NAMING, &self.input, around.look.theme, (area, buffer))
    }
}

/// The dialog with its typed path.
#[derive(Debug, Clone)]
pub struct SaveAs {
    /// The typed path.
    pub(crate) input: Line,
    /// The step after the save.
    pub(crate) next: Next,
}

impl Dialog for SaveAs {
    fn place(&self) -> Place {
        Place::PATH
    }

    fn input(&mut self) -> Option<&mut Line> {
        Some(&mut self.input)
    }

    fn accept(&mut self, _: &Surroundings<'_>) -> Outcome {
        Outcome::SaveAs(self.input.value().to_owned(), self.next.clone())
    }

    fn draw(&self, around: &Surroundings<'_>, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        path_box("Save as", SAVE_NAMING, &self.input, around.look.theme, (area, buffer))
    }
}
