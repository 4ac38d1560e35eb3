//! A question with buttons.

use std::path::{Path, PathBuf};

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::Style;
use ratatui::text::{Line, Span};
use ratatui::widgets::Widget;
use unicode_width::UnicodeWidthStr;

use super::boxes::{extent, frame, inside, room};
use super::{Dialog, Outcome, Surroundings};
use crate::case::stamp::Stamp;
use crate::tui::keys::Place;
use crate::tui::session::save::{self, Found, Next, Offer};
use crate::tui::text;
use crate::tui::theme::Theme;

/// Width of brackets, marks and gap around the name of a button.
const BESIDE_NAME: u16 = 7;

const EXPORT_RUNS: &str = "An export runs";

/// A question with buttons.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Question {
    /// The title.
    pub(crate) title: &'static str,
    /// The question.
    pub(crate) text: String,
    /// Details, one line each.
    pub(crate) details: Vec<String>,
    /// The answers. The first letter of each selects it.
    pub(crate) buttons: Vec<(&'static str, Choice)>,
    pub(crate) marked: usize,
}

/// An answer to a question.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum Choice {
    /// Save, then continue with the next step.
    Save(Next),
    /// Discard the edits and continue with the next step.
    Proceed(Next),
    /// Overwrite the file, whose content has this stamp, with the form.
    Overwrite(PathBuf, Option<Stamp>, Next),
    /// Overwrite the file with the export.
    ExportOver(PathBuf),
    /// Quit immediately.
    Leave,
    /// Ask for another name.
    SaveAs(Next),
    /// Restore kept edits into the form.
    Recover(Box<Offer>),
    /// Delete these journals with their edits.
    Forget(Vec<PathBuf>),
    /// Return to the form.
    Cancel,
}

impl Question {
    /// Asks before the edits of one case are discarded. An accidental Enter neither saves nor
    /// discards them.
    #[must_use]
    pub(crate) fn unsaved(name: &str, next: &Next) -> Question {
        let text = if matches!(next, Next::Load(_)) {
            format!("{name} has unsaved edits. Discard reads the file again without the edits.")
        } else {
            format!("{name} has unsaved edits.")
        };
        Question {
            title: "Unsaved edits",
            text,
            details: Vec::new(),
            buttons: vec![
                ("Save", Choice::Save(next.clone())),
                ("Discard", Choice::Proceed(next.clone())),
                ("Cancel", Choice::Cancel),
            ],
            marked: 2,
        }
    }

    /// Asks before the edits of several cases are discarded.
    pub(crate) fn all_unsaved(names: &[String]) -> Question {
        Question {
            title: "Unsaved edits",
            text: format!("{} cases have unsaved edits: {}.", names.len(), names.join(", ")),
            details: Vec::new(),
            buttons: vec![
                ("Save all", Choice::Proceed(Next::SaveRest)),
                ("Discard all", Choice::Proceed(Next::Quit)),
                ("Cancel", Choice::Cancel),
            ],
            marked: 2,
        }
    }

    /// Asks before overwriting an existing file.
    #[must_use]
    pub(crate) fn exists(path: &Path, found: Found, next: &Next) -> Question {
        Question {
            title: "The file exists",
            text: format!("{} exists. Overwrite replaces it with the form.", path.display()),
            details: found.lines,
            buttons: vec![
                ("Overwrite", Choice::Overwrite(path.to_owned(), found.stamp, next.clone())),
                ("Save as", Choice::SaveAs(next.clone())),
                ("Cancel", Choice::Cancel),
            ],
            marked: 2,
        }
    }

    /// Asks before the workbench ends while an export runs.
    pub(crate) fn export_runs(path: &Path) -> Question {
        Question {
            title: EXPORT_RUNS,
            text: format!("The export to {} still runs.", path.display()),
            details: Vec::new(),
            buttons: vec![("Wait", Choice::Cancel), ("Quit without the export", Choice::Leave)],
            marked: 0,
        }
    }

    /// Whether the question is about a running export.
    pub(crate) fn is_about_running_export(&self) -> bool {
        self.title == EXPORT_RUNS
    }

    /// Asks before an export replaces an existing file.
    pub(crate) fn export_exists(path: &Path) -> Question {
        Question {
            title: "The file exists",
            text: format!("{} exists. Overwrite replaces it with the export.", path.display()),
            details: Vec::new(),
            buttons: vec![
                ("Overwrite", Choice::ExportOver(path.to_owned())),
                ("Cancel", Choice::Cancel),
            ],
            marked: 1,
        }
    }

    /// Asks after another program wrote the file.
    #[must_use]
    pub(crate) fn changed(path: &Path, found: Found, next: &Next) -> Question {
        Question {
            title: "The file has changed on disk",
            text: format!(
                "{} was changed after it was opened here. Reload discards the edits in the form.",
                path.display()
            ),
            details: found.lines,
            buttons: vec![
                ("Reload", Choice::Proceed(Next::Load(path.to_owned()))),
                ("Save as", Choice::SaveAs(next.clone())),
                ("Overwrite", Choice::Overwrite(path.to_owned(), found.stamp, next.clone())),
                ("Cancel", Choice::Cancel),
            ],
            marked: 3,
        }
    }

    /// Reports that another session has the file open.
    #[must_use]
    pub(crate) fn held(path: &Path, holder: &str, next: &Next) -> Question {
        Question {
            title: "Open elsewhere",
            text: format!(
                "{} is not saved: another session has it open: {holder}.",
                path.display()
            ),
            details: Vec::new(),
            buttons: vec![("Save as", Choice::SaveAs(next.clone())), ("Cancel", Choice::Cancel)],
            marked: 0,
        }
    }

    /// Offers edits that an earlier session could not save.
    #[must_use]
    pub fn recover(name: &str, offer: Offer) -> Question {
        let changed = if offer.is_file_changed { " The file has changed since." } else { "" };
        Question {
            title: "Unsaved edits found",
            text: format!(
                "Unsaved edits of {name}, {} old.{changed} Value in the file -> edited value:",
                offer.age
            ),
            details: offer.changes.iter().map(save::line).collect(),
            buttons: vec![
                ("Discard", Choice::Forget(vec![offer.journal.clone()])),
                ("Recover", Choice::Recover(Box::new(offer))),
                ("Later", Choice::Cancel),
            ],
            marked: 1,
        }
    }

    /// Lists the journals of ended sessions.
    pub(crate) fn journals(journals: Vec<(PathBuf, String)>) -> Question {
        let (places, details) = journals.into_iter().unzip();
        Question {
            title: "Unsaved edits",
            text: "Sessions ended with these unsaved edits. A case offers its edits when it is \
                opened."
                .to_owned(),
            details,
            buttons: vec![("Delete all", Choice::Forget(places)), ("Close", Choice::Cancel)],
            marked: 1,
        }
    }

    /// Selects the next or previous button, wrapping around.
    pub(crate) fn mark(&mut self, by: isize) {
        let count = self.buttons.len().max(1);
        self.marked = (self.marked + count).saturating_add_signed(by) % count;
    }

    /// The answer whose name begins with the letter.
    pub(crate) fn by_letter(&self, letter: char) -> Option<Choice> {
        let fits = |name: &str| {
            name.chars().next().is_some_and(|first| first.eq_ignore_ascii_case(&letter))
        };
        self.buttons.iter().find(|(name, _)| fits(name)).map(|(_, choice)| choice.clone())
    }
}

impl Dialog for Question {
    fn place(&self) -> Place {
        Place::ASK
    }

    fn letter(&mut self, letter: char) -> Option<Outcome> {
        Some(self.by_letter(letter).map_or_else(Outcome::none, Outcome::Choose))
    }

    fn step(&mut self, by: isize, _: &Surroundings<'_>) {
        self.mark(by);
    }

    fn wheel(&mut self, _: isize, _: &Surroundings<'_>) {}

    fn click(&mut self, at: Position, screen: Size) -> bool {
        let button = button_at(self, screen, at);
        self.marked = button.unwrap_or(self.marked);
        button.is_some()
    }

    fn accept(&mut self, _: &Surroundings<'_>) -> Outcome {
        let button = self.buttons.get(self.marked);
        button.map_or_else(Outcome::none, |(_, choice)| Outcome::Choose(choice.clone()))
    }

    fn draw(&self, around: &Surroundings<'_>, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        draw_question(self, area, around.look.theme, buffer);
        None
    }
}

fn draw_question(question: &Question, screen: Rect, theme: &Theme, buffer: &mut Buffer) {
    let lines = question_lines(question, room(screen.as_size()));
    let inner = frame(question.title, extent(&lines, 2), screen, theme, buffer);
    for (line, y) in lines.iter().zip(inner.top()..inner.bottom()) {
        buffer.set_stringn(inner.x, y, line, inner.width.into(), Style::new());
    }
    let row = button_row(&lines, inner);
    let buttons = question.buttons.iter().enumerate().flat_map(|(index, (name, _))| {
        let marked = index == question.marked;
        let (text, style) = if marked {
            (format!("[> {name} <]"), theme.key)
        } else {
            (format!("[  {name}  ]"), Style::new())
        };
        [Span::styled(text, style), Span::raw(" ")]
    });
    buttons.collect::<Line<'_>>().render(row, buffer);
}

// The index of the button at a cell, if any.
fn button_at(question: &Question, screen: Size, at: Position) -> Option<usize> {
    let lines = question_lines(question, room(screen));
    let row = button_row(&lines, inside(extent(&lines, 2), Rect::from((Position::ORIGIN, screen))));
    let mut right = row.x;
    let ends = question.buttons.iter().map(|(name, _)| {
        right += name.width() as u16 + BESIDE_NAME;
        right
    });
    let ends: Vec<_> = ends.collect();
    // The gap before the next button is not part of a button.
    ends.iter().position(|&end| at.x + 1 < end).filter(|_| row.contains(at))
}

// The row below the lines and an empty line; empty if there is no room.
fn button_row(lines: &[String], inner: Rect) -> Rect {
    let below = u16::try_from(lines.len()).unwrap_or(u16::MAX).saturating_add(1);
    if below < inner.height { Rect { y: inner.y + below, height: 1, ..inner } } else { Rect::ZERO }
}

// The lines above the buttons. The buttons must be visible: details that do not fit are omitted,
// one line each.
fn question_lines(question: &Question, room: Size) -> Vec<String> {
    let width = usize::from(room.width);
    let mut lines = text::wrap(&question.text, width);
    let left = usize::from(room.height).saturating_sub(lines.len() + 2);
    let details = &question.details;
    let shown = if details.len() <= left { details.len() } else { left.saturating_sub(1) };
    lines.extend(details[..shown].iter().map(|line| text::cut(&format!("  {line}"), width)));
    if shown < details.len() && left > 0 {
        lines.push(format!("  and {} more", details.len() - shown));
    }
    lines
}
