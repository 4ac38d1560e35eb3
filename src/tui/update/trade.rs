//! Accuracy against run time: the benchmark, the selection of a setting, and its use in the case.

use super::edit;
use crate::model::Refusal;
use crate::report::trade::conclusion;
use crate::study::trade::{Trade, trade};
use crate::tui::app::App;
use crate::tui::app::actions::Work;
use crate::tui::jobs::{Slot, Traded};
use crate::tui::layout::{Pane, is_too_small};
use crate::tui::panes::trade::{nearest, stepped};

/// Starts the benchmark of every method on the case of the form.
pub(super) fn measure(app: &mut App) {
    let Some(inputs) = app.tab.inputs().cloned() else {
        return app.complain("no benchmark: fix the fields marked with ! first");
    };
    let (tab, own) = (app.tab.id, inputs.clone());
    let patience = app.patience;
    let work = Work::in_steps(Slot::Benchmark, move |running| {
        let mut report = |sofar: &Trade| {
            let sofar = sofar.clone();
            running.send(move |app| take_measured(app, tab, sofar));
        };
        match trade(&own, patience, &|| running.is_wanted(), &mut report) {
            Ok(trade) => running.send(move |app| {
                take_measured(app, tab, trade);
                if let Some(words) = conclude(app, tab) {
                    app.say(words);
                }
            }),
            Err(Refusal::Stopped) => (),
            Err(refusal) => running.send(move |app| failed(app, tab, &refusal.to_string())),
        }
    });
    let work = app.start(work.or(move |app| failed(app, tab, "internal error")));
    app.tab.traded = Some(Traded { work, inputs, trade: None, marked: None });
}

/// Stops the benchmark; its results so far stay. Returns whether it ran.
pub(super) fn stop(app: &mut App) -> bool {
    let has_run = app.cancel(Slot::Benchmark);
    if has_run && conclude(app, app.tab.id).is_some() {
        app.say("the benchmark is stopped; its results stay");
    }
    has_run
}

/// Stops a hidden benchmark. A terminal that is briefly too small does not stop it.
pub(super) fn stop_unseen(app: &mut App) {
    let is_own = app.is_measuring() && app.layout.plan().shows(Pane::Trade);
    if !is_own && !is_too_small(app.layout.size()) {
        app.cancel(Slot::Benchmark);
    }
}

/// Switches between chart and table. The selection moves to a setting that the view shows.
pub(super) fn switch_view(app: &mut App) {
    app.trade_view = app.trade_view.other();
    if let Some(traded) = app.tab.traded.as_mut() {
        traded.marked = nearest(traded, app.trade_view).or(traded.marked);
    }
}

/// Moves the selection by `by` settings, in the order of the view.
pub(super) fn step(app: &mut App, by: isize) {
    let view = app.trade_view;
    if let Some(traded) = app.tab.traded.as_mut() {
        traded.marked = stepped(traded, view, by).or(traded.marked);
    }
}

/// Writes the selected setting into the case.
pub(super) fn take(app: &mut App) {
    let Some(setting) = app.tab.traded.as_ref().and_then(|traded| traded.marked) else {
        return app.say(if app.tab.traded.is_some() {
            "no setting is selected: the arrow keys select one"
        } else {
            "no benchmark yet: m runs it"
        });
    };
    let mut case = app.tab.case.clone();
    setting.apply(&mut case);
    let outcome = edit::undone_by(app, &case);
    edit::replace(app, case);
    app.say(format!("method {setting}{outcome}"));
}

fn traded(app: &mut App, tab: usize) -> Option<&mut Traded> {
    app.tab_with(tab)?.traded.as_mut()
}

fn take_measured(app: &mut App, tab: usize, trade: Trade) {
    if let Some(traded) = traded(app, tab) {
        traded.trade = Some(trade);
    }
}

/// Selects the recommended setting, unless the user has selected one. Returns the conclusion, empty
/// without results, if the tab is the current one.
fn conclude(app: &mut App, tab: usize) -> Option<String> {
    let is_shown = app.tab.id == tab;
    let traded = traded(app, tab)?;
    let words = traded.trade.as_ref().map(|trade| {
        let recommended = trade.recommended().map(|measured| measured.setting);
        traded.marked = traded.marked.or(recommended);
        conclusion(trade)
    });
    is_shown.then(|| words.unwrap_or_default())
}

fn failed(app: &mut App, tab: usize, reason: &str) {
    if conclude(app, tab).is_some() {
        app.complain(format!("no benchmark: {reason}"));
    }
}
