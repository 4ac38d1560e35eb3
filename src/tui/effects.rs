//! Carries out the effects on files.

use std::fs;

use super::actions::{Action, Effect};
use super::session::autosave::Autosave;
use super::session::recovery::Claim;
use super::store::{self, recents};

/// Carries out an effect on files and returns its result as an action. Ignores other effects.
#[must_use]
pub fn perform(effect: Effect, autosave: &mut Autosave) -> Option<Action> {
    match effect {
        Effect::Load(path) => {
            let path = store::at_home(&path);
            let result = store::load(&path);
            Some(Action::Loaded(path, result))
        }
        Effect::Save(saving, next) => {
            let (path, result) = autosave.save(*saving);
            Some(Action::Saved(path, next, result))
        }
        Effect::Adopt(journal) => {
            autosave.adopt(journal);
            None
        }
        Effect::Remember(path) => {
            recents::add(&path);
            None
        }
        Effect::Keep(settings) => {
            let kept = settings.keep();
            kept.err().map(|reason| Action::Failed(format!("the settings are not saved: {reason}")))
        }
        Effect::Forget(journals) => {
            // A journal that cannot be deleted is offered again at the next start.
            for journal in journals {
                drop(fs::remove_file(journal));
            }
            None
        }
        Effect::Journals => Some(Action::Journals(autosave.ended_sessions())),
        Effect::Solve(_)
        | Effect::Job(_)
        | Effect::Copy(_)
        | Effect::Mouse(_)
        | Effect::Play(_)
        | Effect::Measure(_)
        | Effect::CancelWork
        | Effect::CancelSolve
        | Effect::Study(_)
        | Effect::CancelStudy
        | Effect::Chart(_)
        | Effect::CancelChart
        | Effect::CancelRelief
        | Effect::Redraw
        | Effect::Suspend
        | Effect::Quit => None,
    }
}

/// The result of opening a case under autosave, as an action.
#[must_use]
pub fn claimed(claim: Result<Claim, String>) -> Action {
    claim.map_or_else(Action::Failed, |claim| Action::Claimed(Box::new(claim)))
}
