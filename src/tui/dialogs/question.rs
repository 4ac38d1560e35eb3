//! A question with buttons.

use std::path::{Path, PathBuf};

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::Style;
use ratatui::text::{Line, Span};
use ratatui::widgets::Widget;
use unicode_width::UnicodeWidthStr;

use super::{Dialog, Outcome, Surroundings, boxes};
use crate::case::stamp::Stamp;
use crate::tui::keys::Place;
use crate::tui::session::save::{self, Found, Next, Offer, SaveFault};
use crate::tui::text;

/// Width of brackets, marks and gap around the name of a button.
const BESIDE_NAME: u16 = 7;

const EXPORT_RUNS: &str = "An export runs";
const EXISTS: &str = "The file exists";
const UNSAVED: &str = "Unsaved edits";

/// A question with buttons.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Question {
    title: &'static str,
    /// The question.
    text: String,
    /// Details, one line each.
    details: Vec<String>,
    /// The answers. The first letter of each selects it.
    buttons: Vec<(&'static str, Choice)>,
    selected: usize,
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
    /// A question whose last button is selected, so that an accidental Enter changes nothing.
    fn new(
        title: &'static str,
        text: String,
        buttons: impl Into<Vec<(&'static str, Choice)>>,
    ) -> Question {
        let buttons = buttons.into();
        let selected = buttons.len() - 1;
        Question { title, text, details: Vec::new(), buttons, selected }
    }

    /// Asks before the edits of one case are discarded.
    #[must_use]
    pub(crate) fn unsaved(name: &str, next: &Next) -> Question {
        let reload = match next {
            Next::Load(_) => " Discard reads the file again without the edits.",
            _ => "",
        };
        let buttons = [
            ("Save", Choice::Save(next.clone())),
            ("Discard", Choice::Proceed(next.clone())),
            ("Cancel", Choice::Cancel),
        ];
        Question::new(UNSAVED, format!("{name} has unsaved edits.{reload}"), buttons)
    }

    /// Asks before the edits of several cases are discarded.
    pub(crate) fn all_unsaved(names: &[String]) -> Question {
        let text = format!("{} cases have unsaved edits: {}.", names.len(), names.join(", "));
        let buttons = [
            ("Save all", Choice::Proceed(Next::SaveRest)),
            ("Discard all", Choice::Proceed(Next::Quit)),
            ("Cancel", Choice::Cancel),
        ];
        Question::new(UNSAVED, text, buttons)
    }

    /// Asks after a save that would overwrite a file or that has no lock; the error is another reason
    /// of the failure.
    pub(crate) fn refused(path: &Path, fault: SaveFault, next: &Next) -> Result<Question, String> {
        let name = path.display();
        let save_as = ("Save as", Choice::SaveAs(next.clone()));
        let cancel = ("Cancel", Choice::Cancel);
        let overwrite =
            |stamp| ("Overwrite", Choice::Overwrite(path.to_owned(), stamp, next.clone()));
        Ok(match fault {
            SaveFault::Exists(Found { stamp, lines }) => {
                let text = format!("{name} exists. Overwrite replaces it with the form.");
                let question = Question::new(EXISTS, text, [overwrite(stamp), save_as, cancel]);
                Question { details: lines, ..question }
            }
            SaveFault::Changed(Found { stamp, lines }) => {
                let text = format!(
                    "{name} was changed after it was opened here. Reload discards the edits in the \
                     form."
                );
                let reload = ("Reload", Choice::Proceed(Next::Load(path.to_owned())));
                let buttons = [reload, save_as, overwrite(stamp), cancel];
                let question = Question::new("The file has changed on disk", text, buttons);
                Question { details: lines, ..question }
            }
            SaveFault::Held(holder) => {
                let text = format!("{name} is not saved: another session has it open: {holder}.");
                let question = Question::new("Open elsewhere", text, [save_as, cancel]);
                Question { selected: 0, ..question }
            }
            SaveFault::Failed(reason) => return Err(reason),
        })
    }

    /// Asks before the workbench ends while an export runs.
    pub(crate) fn export_runs(path: &Path) -> Question {
        let text = format!("The export to {} still runs.", path.display());
        let buttons = [("Wait", Choice::Cancel), ("Quit without the export", Choice::Leave)];
        Question { selected: 0, ..Question::new(EXPORT_RUNS, text, buttons) }
    }

    /// Whether the question is about a running export.
    pub(crate) fn is_about_running_export(&self) -> bool {
        self.title == EXPORT_RUNS
    }

    /// Asks before an export replaces an existing file.
    pub(crate) fn export_exists(path: &Path) -> Question {
        let text = format!("{} exists. Overwrite replaces it with the export.", path.display());
        let buttons =
            [("Overwrite", Choice::ExportOver(path.to_owned())), ("Cancel", Choice::Cancel)];
        Question::new(EXISTS, text, buttons)
    }

    /// Offers edits that an earlier session could not save.
    #[must_use]
    pub fn recover(name: &str, offer: Offer) -> Question {
        let changed = if offer.is_file_changed { " The file has changed since." } else { "" };
        let text = format!(
            "Unsaved edits of {name}, {} old.{changed} Value in the file -> edited value:",
            offer.age
        );
        let details = offer.changes.iter().map(save::line).collect();
        let buttons = [
            ("Discard", Choice::Forget(vec![offer.journal.clone()])),
            ("Recover", Choice::Recover(Box::new(offer))),
            ("Later", Choice::Cancel),
        ];
        let question = Question::new("Unsaved edits found", text, buttons);
        Question { details, selected: 1, ..question }
    }

    /// Lists the journals of ended sessions.
    pub(crate) fn journals(journals: Vec<(PathBuf, String)>) -> Question {
        let (places, details) = journals.into_iter().unzip();
        let text = "Sessions ended with these unsaved edits. A case offers its edits when it is \
                    opened.";
        let buttons = [("Delete all", Choice::Forget(places)), ("Close", Choice::Cancel)];
        Question { details, ..Question::new(UNSAVED, text.to_owned(), buttons) }
    }

    // The lines above the buttons. The buttons must be visible: details that do not fit are
    // omitted, one line each.
    fn lines(&self, room: Size) -> Vec<Line<'static>> {
        let mut lines: Vec<_> = boxes::said(&self.text, Style::new(), room.width).collect();
        let left = usize::from(room.height).saturating_sub(lines.len() + 2);
        let count = self.details.len();
        let shown = if count <= left { count } else { left.saturating_sub(1) };
        let cut = |line: &String| Line::from(text::cut(&format!("  {line}"), room.width.into()));
        lines.extend(self.details[..shown].iter().map(cut));
        lines.extend(
            (shown < count && left > 0).then(|| format!("  and {} more", count - shown).into()),
        );
        // An empty line, and the line of the buttons.
        lines.extend([Line::default(), Line::default()]);
        lines
    }

    // The row of the buttons; empty if there is no room.
    fn button_row(lines: &[Line<'_>], inner: Rect) -> Rect {
        inner.rows().nth(lines.len() - 1).unwrap_or_default()
    }

    fn choose(button: Option<&(&'static str, Choice)>) -> Outcome {
        button.map_or_else(Outcome::none, |(_, choice)| Outcome::Choose(choice.clone()))
    }
}

impl Dialog for Question {
    fn place(&self) -> Place {
        Place::ASK
    }

    fn letter(&mut self, letter: char) -> Option<Outcome> {
        let fits = |(name, _): &(&str, Choice)| {
            name.starts_with(|first: char| first.eq_ignore_ascii_case(&letter))
        };
        Some(Question::choose(self.buttons.iter().find(|button| fits(button))))
    }

    // Wraps around.
    fn step(&mut self, by: isize, _: &Surroundings<'_>) {
        let count = self.buttons.len();
        self.selected = (self.selected + count).saturating_add_signed(by) % count;
    }

    fn wheel(&mut self, _: isize, _: &Surroundings<'_>) {}

    fn click(&mut self, at: Position, screen: Rect) -> bool {
        let lines = self.lines(boxes::room(screen));
        let row = Question::button_row(&lines, boxes::inside(boxes::extent(&lines), screen));
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

    fn accept(&mut self, _: &Surroundings<'_>) -> Outcome {
        Question::choose(self.buttons.get(self.selected))
    }

    fn draw(&self, around: &Surroundings<'_>, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let theme = around.look.theme;
        let lines = self.lines(boxes::room(area));
        let inner = boxes::frame(self.title, boxes::extent(&lines), area, theme, buffer);
        text::draw_lines(&lines, inner, buffer);
        let buttons = self.buttons.iter().enumerate().flat_map(|(at, (name, _))| {
            let button = if at == self.selected {
                Span::styled(format!("[> {name} <]"), theme.key)
            } else {
                Span::raw(format!("[  {name}  ]"))
            };
            [button, Span::raw(" ")]
        });
        buttons.collect::<Line<'_>>().render(Question::button_row(&lines, inner), buffer);
        None
    }
}
