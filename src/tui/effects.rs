//! Does what the state asks of the files, and says what came of it.

use std::fs;

use super::actions::{Action, Effect};
use super::jobs::Finding;
use super::recovery::Claim;
use super::store::{self, recents};

/// Do what the state asks of the files; what is to be told about it. The other effects are not for
/// files.
#[must_use]
pub fn perform(effect: Effect) -> Option<Action> {
    match effect {
        Effect::Load(path) => {
            let path = store::at_home(&path);
            let result = store::load(&path);
            Some(Action::Loaded(path, result))
        }
        Effect::Save(mut saving, next) => {
            saving.path = store::expanded(&saving);
            let result = store::save(&saving);
            Some(Action::Saved(saving.path, next, result))
        }
        Effect::Remember(path) => {
            recents::add(&path);
            None
        }
        Effect::Keep(settings) => {
            let kept = settings.keep();
            kept.err()
                .map(|reason| Action::Failed(format!("the settings are not kept: {reason}")))
        }
        Effect::Forget(journal) => {
            // One that stays is offered again.
            drop(fs::remove_file(journal));
            None
        }
        Effect::Solve(_)
        | Effect::Job(_)
        | Effect::Adopt(_)
        | Effect::Copy(_)
        | Effect::Mouse(_)
        | Effect::Play(_)
        | Effect::Measure(_)
        | Effect::CancelWork
        | Effect::CancelSolve
        | Effect::Redraw
        | Effect::Suspend
        | Effect::Quit => None,
    }
}

/// What an errand found, as it is told.
#[must_use]
pub fn told(finding: Finding) -> Action {
    match finding {
        Finding::Folder(listing) => Action::Listed(listing),
        Finding::Below(below) => Action::Found(below),
        Finding::Preview(sight, preview) => Action::Previewed(sight, preview),
        Finding::Recents(recents) => Action::Recents(recents),
        Finding::Examples(digests) => Action::Examples(digests),
        Finding::Explained(explained) => Action::Explained(explained),
        Finding::Failed(reason) => Action::Failed(reason),
    }
}

/// What the autosave has to say, as it is told.
#[must_use]
pub fn claimed(claim: Result<Claim, String>) -> Action {
    claim.map_or_else(Action::Failed, |claim| Action::Claimed(Box::new(claim)))
}
