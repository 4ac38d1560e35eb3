//! The visible chart that a worker computes: its requests to the worker.

use crate::tui::actions::Effect;
use crate::tui::app::App;
use crate::tui::jobs::{ChartPart, ChartRequest};
use crate::tui::layout::Pane;

/// Requests the visible chart, unless it is the last request; stops a hidden one.
pub(super) fn request(app: &mut App) -> Vec<Effect> {
    let is_visible = !app.layout.plan().area(Pane::Chart).is_empty();
    let Some(chart) = app.chart.worker_chart.filter(|_| is_visible) else {
        return stop(app);
    };
    let Some(inputs) = app.tab.inputs().cloned() else {
        return stop(app);
    };
    let last = app.tab.chart_work.request.as_ref();
    if last.is_some_and(|last| last.chart == chart && last.inputs == inputs) {
        return Vec::new();
    }
    forget_running(app);
    app.last_serial += 1;
    let request = ChartRequest { serial: app.last_serial, chart, inputs };
    app.tab.chart_work.request = Some(request.clone());
    app.tab.chart_work.is_running = true;
    vec![Effect::Chart(Box::new(request))]
}

/// Stops the computation; the request is repeated once the chart is visible.
fn stop(app: &mut App) -> Vec<Effect> {
    if forget_running(app) { vec![Effect::CancelChart] } else { Vec::new() }
}

/// Forgets the running request of any tab: the computation ends, and the tab requests it again.
fn forget_running(app: &mut App) -> bool {
    let mut has_run = false;
    for tab in std::iter::once(&mut app.tab).chain(&mut app.others) {
        if std::mem::take(&mut tab.chart_work.is_running) {
            tab.chart_work.request = None;
            has_run = true;
        }
    }
    has_run
}

/// Adds the next values.
pub(super) fn take(app: &mut App, part: &ChartPart) {
    let tabs = std::iter::once(&mut app.tab).chain(&mut app.others);
    tabs.for_each(|tab| tab.chart_work.take(part.clone()));
}
