//! Claims of opened cases: shows the process that has the case open, and offers unsaved edits.

use std::path::PathBuf;

use super::{solve, tabs};
use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::dialogs::Prompt;
use crate::tui::dialogs::question::Question;
use crate::tui::session::recovery::{Access, Claim, Offer};

/// Shows the result of opening a case.
pub(super) fn claimed(app: &mut App, claim: Claim) {
    let Some(at) = app.tabs().position(|tab| tab.id == claim.id) else {
        return;
    };
    if !claim.is_silent() {
        tabs::go_to(app, at);
    }
    let Claim { id, access, offers, notices } = claim;
    if let Access::Held(holder) = &access {
        app.complain(format!("read-only: open in {holder}; F2 saves under another name"));
    }
    if let Some(tab) = std::iter::once(&mut app.tab)
        .chain(&mut app.others)
        .find(|tab| tab.id == id && tab.access != Access::Newer)
    {
        tab.access = access;
    }
    if !notices.is_empty() {
        let said = app.message.take().map(|message| message.text);
        app.complain(said.into_iter().chain(notices).collect::<Vec<_>>().join("; "));
    }
    let name = app.tab.name();
    // The latest is on top.
    app.prompts
        .extend(offers.into_iter().rev().map(|offer| Prompt::Ask(Question::recover(&name, offer))));
}

/// Shows the journals of ended sessions.
pub(super) fn list(app: &mut App, journals: Vec<(PathBuf, String)>) {
    if journals.is_empty() {
        app.say("no ended session left unsaved edits");
    } else {
        app.prompts.push(Prompt::Ask(Question::journals(journals)));
    }
}

/// Restores the kept edits into the form as one edit, which undo reverts.
pub(super) fn recover(app: &mut App, offer: &Offer) -> Vec<Effect> {
    let mut case = app.tab.case.clone();
    let refused: Vec<_> = offer
        .changes
        .iter()
        .filter_map(|change| case.apply(&change.key, change.to.as_deref()).err())
        .collect();
    app.tab.history.end_visit();
    app.tab.before_edit(app.tab.form.focus);
    let mut effects = solve(app.replace_case(case, app.tab.form.focus));
    if let Some(problem) = refused.first() {
        app.complain(format!("some edits are not restored, and the journal stays: {problem}"));
    } else {
        app.say("the edits are restored, not saved yet");
        effects.push(Effect::Adopt(offer.journal.clone()));
    }
    effects
}
