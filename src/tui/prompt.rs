//! What lies over the form: prompts for a path, questions with buttons, pages to read.

use std::path::{Path, PathBuf};

use super::browser::Browser;
use super::explanation::Explanation;
use super::keys::Place;
use super::line::Line;
use super::pick::Picker;
use super::session::recovery::{self, Offer};

/// Something that lies over the form and takes the keys.
#[derive(Debug, Clone)]
pub enum Prompt {
    /// Which file to open.
    Browse(Box<Browser>),
    /// Where to save, and what comes next.
    SaveAs(Line, Next),
    /// Where the cursor is to go.
    Aim(Line),
    /// A question with buttons.
    Ask(Question),
    /// A page to read, scrolled to a line.
    Read(Page),
    /// Where a result comes from.
    Explain(Explanation),
    /// A list to pick from.
    Pick(Picker),
}

/// What comes after a save or a decision to lose the edits.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Next {
    /// Go on with this case.
    Stay,
    /// Leave the workbench.
    Quit,
    /// Save what else is unsaved, then leave the workbench.
    SaveRest,
    /// Close this case.
    Close,
    /// Open this file in place of the case.
    Load(PathBuf),
}

/// A question with buttons.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Question {
    /// In a few words.
    pub title: &'static str,
    /// In a sentence.
    pub text: String,
    /// What it is about, a line each.
    pub details: Vec<String>,
    /// The answers. The first letter of each calls it.
    pub buttons: Vec<(&'static str, Choice)>,
    /// The marked one.
    pub marked: usize,
}

/// An answer to a question.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Choice {
    /// Save, then go on.
    Save(Next),
    /// Lose the edits and go on.
    Proceed(Next),
    /// Write over what is in the file.
    Overwrite(PathBuf, Next),
    /// Ask for another name.
    SaveAs(Next),
    /// Put kept edits into the form.
    Recover(Box<Offer>),
    /// Throw the edits of this journal away.
    Forget(PathBuf),
    /// Back to the form.
    Cancel,
}

/// A page to read.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Page {
    /// In a few words.
    pub title: String,
    /// Its lines.
    pub lines: Vec<String>,
    /// The first line in sight.
    pub top: usize,
}

impl Prompt {
    /// Which keys it takes.
    #[must_use]
    pub fn place(&self) -> Place {
        match self {
            Prompt::Browse(_) => Place::BROWSE,
            Prompt::SaveAs(..) | Prompt::Aim(_) => Place::PATH,
            Prompt::Ask(_) => Place::ASK,
            Prompt::Read(_) => Place::READ,
            Prompt::Explain(_) => Place::EXPLAIN,
            Prompt::Pick(_) => Place::PICK,
        }
    }

    /// The line of text that it edits.
    pub fn input_mut(&mut self) -> Option<&mut Line> {
        match self {
            Prompt::Browse(browser) => Some(&mut browser.input),
            Prompt::SaveAs(input, _) | Prompt::Aim(input) => Some(input),
            Prompt::Pick(picker) => Some(&mut picker.input),
            Prompt::Ask(_) | Prompt::Read(_) | Prompt::Explain(_) => None,
        }
    }
}

impl Question {
    /// Edits of one case would be lost. A stray Enter neither saves nor loses them.
    #[must_use]
    pub fn unsaved(name: &str, next: &Next) -> Question {
        Question {
            title: "Unsaved edits",
            text: format!("{name} has unsaved edits."),
            details: Vec::new(),
            buttons: vec![
                ("Save", Choice::Save(next.clone())),
                ("Discard", Choice::Proceed(next.clone())),
                ("Cancel", Choice::Cancel),
            ],
            marked: 2,
        }
    }

    /// Edits of several cases would be lost.
    #[must_use]
    pub fn all_unsaved(names: &[String]) -> Question {
        Question {
            title: "Unsaved edits",
            text: format!(
                "{} cases have unsaved edits: {}.",
                names.len(),
                names.join(", ")
            ),
            details: Vec::new(),
            buttons: vec![
                ("Save all", Choice::Proceed(Next::SaveRest)),
                ("Discard all", Choice::Proceed(Next::Quit)),
                ("Cancel", Choice::Cancel),
            ],
            marked: 2,
        }
    }

    /// A file of that name is there, which says this otherwise than the form.
    #[must_use]
    pub fn exists(path: &Path, details: Vec<String>, next: &Next) -> Question {
        Question {
            title: "The file exists",
            text: format!(
                "{} exists. Overwrite replaces it with the form.",
                path.display()
            ),
            details,
            buttons: vec![
                (
                    "Overwrite",
                    Choice::Overwrite(path.to_owned(), next.clone()),
                ),
                ("Save as", Choice::SaveAs(next.clone())),
                ("Cancel", Choice::Cancel),
            ],
            marked: 2,
        }
    }

    /// Someone else wrote the file, which says this otherwise than the form.
    #[must_use]
    pub fn changed(path: &Path, details: Vec<String>, next: &Next) -> Question {
        Question {
            title: "The file has changed on disk",
            text: format!(
                "{} was changed after it was opened here. Reload discards the edits in the form.",
                path.display()
            ),
            details,
            buttons: vec![
                ("Reload", Choice::Proceed(Next::Load(path.to_owned()))),
                ("Save as", Choice::SaveAs(next.clone())),
                (
                    "Overwrite",
                    Choice::Overwrite(path.to_owned(), next.clone()),
                ),
                ("Cancel", Choice::Cancel),
            ],
            marked: 3,
        }
    }

    /// Another session has the file open.
    #[must_use]
    pub fn held(path: &Path, holder: &str, next: &Next) -> Question {
        Question {
            title: "Open elsewhere",
            text: format!(
                "{} is not saved: another session has it open: {holder}.",
                path.display()
            ),
            details: Vec::new(),
            buttons: vec![
                ("Save as", Choice::SaveAs(next.clone())),
                ("Cancel", Choice::Cancel),
            ],
            marked: 0,
        }
    }

    /// Edits were kept that an earlier session could not save.
    #[must_use]
    pub fn recover(name: &str, offer: Offer) -> Question {
        let changed = if offer.is_file_changed {
            " The file has been changed since."
        } else {
            ""
        };
        Question {
            title: "Unsaved edits found",
            text: format!(
                "Edits of {name} that were not saved, {} old.{changed} In the file now -> as typed:",
                offer.age
            ),
            details: offer.changes.iter().map(recovery::line).collect(),
            buttons: vec![
                ("Discard", Choice::Forget(offer.journal.clone())),
                ("Recover", Choice::Recover(Box::new(offer))),
                ("Later", Choice::Cancel),
            ],
            marked: 1,
        }
    }

    /// Move the mark to the next or the one before, round and round.
    pub fn mark(&mut self, by: isize) {
        let count = self.buttons.len().max(1);
        self.marked = (self.marked + count).saturating_add_signed(by) % count;
    }

    /// The answer whose name begins with the letter.
    #[must_use]
    pub fn by_letter(&self, letter: char) -> Option<Choice> {
        let fits = |name: &str| {
            name.chars()
                .next()
                .is_some_and(|first| first.eq_ignore_ascii_case(&letter))
        };
        self.buttons
            .iter()
            .find(|(name, _)| fits(name))
            .map(|(_, choice)| choice.clone())
    }
}

impl Page {
    /// A page from its first line.
    #[must_use]
    pub fn new(title: impl Into<String>, lines: Vec<String>) -> Page {
        Page {
            title: title.into(),
            lines,
            top: 0,
        }
    }
}
