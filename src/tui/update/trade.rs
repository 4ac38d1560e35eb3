//! Accuracy against run time: the benchmark, the selection of a setting, and its use in the case.

use super::edit;
use crate::report::trade::conclusion;
use crate::study::trade::STEADY;
use crate::tui::actions::{Effect, Progress};
use crate::tui::app::App;
use crate::tui::jobs::{BenchmarkProgress, End, Measuring, Traded};
use crate::tui::layout::{Pane, is_too_small};
use crate::tui::panes::trade::{nearest, stepped};

/// The name of the work in the progress.
const MEASURING: &str = "measuring";

/// Starts the benchmark of every method on the case of the form.
pub(super) fn measure(app: &mut App) -> Vec<Effect> {
    let Some(inputs) = app.tab.inputs().cloned() else {
        app.complain("no benchmark: fix the fields marked with ! first");
        return Vec::new();
    };
    app.last_serial += 1;
    let serial = app.last_serial;
    app.tab.traded = Some(Traded { serial, inputs: inputs.clone(), trade: None, marked: None });
    app.measuring = Some(serial);
    app.progress = Some(Progress { what: MEASURING.to_owned(), part: 0.0 });
    vec![Effect::Measure(Box::new(Measuring { serial, inputs, patience: STEADY }))]
}

/// Stops a hidden benchmark. A terminal that is briefly too small does not stop it.
pub(super) fn stop_unseen(app: &App) -> Vec<Effect> {
    let is_too_small = is_too_small(app.layout.size());
    let Some(serial) = app.measuring.filter(|_| !is_too_small) else {
        return Vec::new();
    };
    let is_own = app.tab.traded.as_ref().is_some_and(|traded| traded.serial == serial);
    let is_shown = is_own && !app.layout.plan().area(Pane::Trade).is_empty();
    if is_shown { Vec::new() } else { vec![Effect::CancelWork] }
}

/// Adds results of the benchmark and reports its end.
pub(super) fn measured(app: &mut App, measured: BenchmarkProgress) {
    let BenchmarkProgress { serial, trade, end } = measured;
    let is_shown = app.tab.traded.as_ref().is_some_and(|traded| traded.serial == serial);
    let is_latest = app.measuring == Some(serial);
    if let Some(trade) = trade {
        if is_latest {
            app.progress = Some(Progress { what: MEASURING.to_owned(), part: trade.part() });
        }
        if let Some(traded) = app.traded_of(serial) {
            traded.trade = Some(*trade);
        }
    }
    let Some(end) = end else { return };
    if is_latest {
        (app.progress, app.measuring) = (None, None);
    }
    let recommended = app.traded_of(serial).and_then(|traded| {
        let trade = traded.trade.as_ref()?;
        let setting = trade.recommended().map(|measured| measured.setting);
        traded.marked = traded.marked.or(setting);
        Some(conclusion(trade))
    });
    match end {
        _ if !is_shown => (),
        End::Whole => app.say(recommended.unwrap_or_default()),
        End::Stopped => app.say("the benchmark is stopped; its results stay"),
        End::Failed(reason) => app.complain(format!("no benchmark: {reason}")),
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
pub(super) fn take(app: &mut App) -> Vec<Effect> {
    let Some(setting) = app.tab.traded.as_ref().and_then(|traded| traded.marked) else {
        app.say(if app.tab.traded.is_some() {
            "no setting is selected: the arrow keys select one"
        } else {
            "no benchmark yet: m runs it"
        });
        return Vec::new();
    };
    let mut case = app.tab.case.clone();
    setting.apply(&mut case);
    let outcome = edit::undone_by(app, &case);
    let effects = edit::replace(app, case);
    app.say(format!("method {setting}{outcome}"));
    effects
}
