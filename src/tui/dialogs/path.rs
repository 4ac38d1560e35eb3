//! The dialog for a path, to save or to export to.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};

use super::{Dialog, Outcome, Surroundings, boxes};
use crate::tui::keys::Place;
use crate::tui::line::Line;
use crate::tui::session::save::Next;

const EXPORT: (&str, &str) = (
    "Export",
    "A name or a path; ~ is the home folder. The file extension selects the content: .html, .md, \
        .csv and .json write the report, .svg writes the visible chart or the teeth.",
);

const SAVE: (&str, &str) = (
    "Save as",
    "A name or a path; ~ is the home folder, .toml is added if missing. Asks before overwriting.",
);

/// The dialog with its typed path.
#[derive(Debug, Clone)]
pub struct PathDialog {
    /// The typed path.
    pub(crate) input: Line,
    /// The step after a save; `None` for an export.
    pub(crate) save: Option<Next>,
}

impl Dialog for PathDialog {
    fn place(&self) -> Place {
        Place::PATH
    }

    fn input(&mut self) -> Option<&mut Line> {
        Some(&mut self.input)
    }

    fn accept(&mut self, _: &Surroundings<'_>) -> Outcome {
        let path = self.input.value().to_owned();
        match &self.save {
            Some(next) => Outcome::SaveAs(path, next.clone()),
            None => Outcome::Export(path),
        }
    }

    fn draw(&self, around: &Surroundings<'_>, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let theme = around.look.theme;
        let (title, how) = if self.save.is_some() { SAVE } else { EXPORT };
        let how: Vec<_> = boxes::said(how, theme.faint, boxes::room(area).width).collect();
        boxes::input_box(title, boxes::WIDEST, &self.input, &how, theme, (area, buffer)).1
    }
}
