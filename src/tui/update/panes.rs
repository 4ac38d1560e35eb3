//! The panes: focus and layout, the commands of charts and teeth, the charts that are computed beside
//! the loop, the selection of the results, and the cursor on the driver's roll angle.

use std::time::{Duration, Instant};

use super::edit;
use crate::case::units::System;
use crate::model::compliance::model_of;
use crate::model::inputs::Method;
use crate::model::solve::speeds;
use crate::model::speeds::SpeedCurve;
use crate::model::{self, Inputs, Refusal, Stage, Stages, solve_while};
use crate::report::charts::{chart_of_spectra, spectra, speed_chart, tooth_chart};
use crate::report::{self, explain as explanation};
use crate::study::stiffness::{FLANK_POINTS, compare_flanks};
use crate::tui::app::App;
use crate::tui::app::actions::{Effect, Running, Slot, Work};
use crate::tui::app::dialogs::Prompt;
use crate::tui::app::dialogs::page::{Explanation, Page};
use crate::tui::app::dialogs::question::PathDialog;
use crate::tui::app::panes::chart::curves::ChartView;
use crate::tui::app::panes::chart::{
    self, CHARTS, ChartRequest, ChartValues, OwnChart, first_contact,
};
use crate::tui::app::panes::cursor::{Reach, cursor_range, greatest_load, meaning, parse_cursor};
use crate::tui::app::panes::results::in_full;
use crate::tui::app::panes::teeth::{Picture, TeethView};
use crate::tui::layout::{Layout, Pane};
use crate::tui::session::Next;
use crate::tui::text::Line;

/// The instruction of the dialog for the cursor.
const HOW: &str = "Type an angle after E (-1.2 deg, -20 mrad), a time after E (-80 us, 0.1 ms) \
    or a point (D, E, B, L, peak).";
const NO_CURSOR: &str = "no valid results for a cursor";

/// Time between two messages of a growing curve.
const CHART_STEP: Duration = Duration::from_millis(150);

/// Moves the focus to a pane and makes it visible. In the form, letters are commands until the user
/// enters a field.
pub(super) fn show(app: &mut App, pane: Pane) {
    app.tab.history.end_visit();
    app.layout.focus = pane;
    app.is_editing = false;
    // A zoomed pane stays visible when the zoom ends.
    let unzoomed = Layout { is_zoomed: false, ..app.layout };
    if pane.is_lower() && !unzoomed.plan().shows(pane) {
        app.layout.lower = pane;
    }
    app.follow();
}

/// Moves the focus by `by` panes, wrapping around.
pub(super) fn step(app: &mut App, by: isize) {
    show(app, app.layout.focus.beside(by));
}

/// Shows another pane in the lower area; the focus does not move unless it is there.
pub(super) fn cycle_lower(app: &mut App) {
    let plan = app.layout.plan();
    let now = Pane::LOWER.iter().position(|&pane| pane == app.layout.lower).unwrap_or(0);
    let mut others = Pane::LOWER.into_iter().cycle().skip(now + 1).take(Pane::LOWER.len());
    let next = others.find(|&pane| !plan.shows(pane)).unwrap_or(Pane::Chart);
    app.layout.lower = next;
    let has_room = Pane::LOWER.iter().any(|&pane| plan.shows(pane));
    if app.layout.focus.is_lower() || !has_room {
        return show(app, next);
    }
    app.follow();
}

/// Makes the focused pane fill the screen, or restores the layout.
pub(super) fn zoom(app: &mut App) {
    app.layout.is_zoomed = !app.layout.is_zoomed;
    app.follow();
}

/// Goes to a field of the form and starts its edit.
pub(super) fn go_to(app: &mut App, field: usize) {
    app.focus_on(field);
    edit::begin(app);
}

/// Goes to the result with a key.
pub(super) fn show_result(app: &mut App, key: &str) {
    let find = |app: &App| app.listed_results().into_iter().find(|known| known.key == key);
    // A folded result is shown.
    app.shows_every_method |= find(app).is_none();
    if let Some(quantity) = find(app) {
        app.tab.results.selected = Some(quantity.key);
    }
    show(app, Pane::Results);
}

/// Opens the explanation of the selected result.
pub(super) fn explain(app: &mut App) {
    let Some(quantity) = app.marked_result() else {
        return app.complain("there are no results to explain");
    };
    let Some(inputs) = app.tab.inputs().cloned() else {
        return app.complain(
            "these are the last valid results: fix the fields marked with ! to explain a result",
        );
    };
    let value = app.tab.solution().and_then(|solution| report::value(quantity, solution));
    let value = value.and_then(|value| {
        let [own, metric] = [app.settings.units, System::Metric]
            .map(|system| report::shown_in(quantity, value, system));
        (own.unit != metric.unit).then_some(own)
    });
    app.prompts.push(Prompt::Explain(Explanation::new(
        quantity,
        app.tab.name(),
        value,
        |app, field| {
            app.prompts.clear();
            go_to(app, field);
        },
    )));
    let case = app.tab.case.clone();
    // As in `tipstrike explain`.
    let page = move |running: &Running<'_>| {
        let inputs = inputs.needing([quantity.stage]);
        Some(match model::solve(&inputs, explanation::stages_of(quantity, inputs.method)) {
            Ok(solution) => {
                let go_on = |_, _| running.is_wanted();
                let page = explanation::explain(quantity, &case, &inputs, &solution, &go_on);
                Ok(Box::new(page))
            }
            Err(refusal) => Err(format!("Not solved: {refusal}. Correction: {}.", refusal.fix())),
        })
    };
    app.start(Work::new(Slot::Explanation, page, |app, page| {
        let open = app.dialog_of(|prompt| match prompt {
            Prompt::Explain(explanation) => Some(explanation),
            _ => None,
        });
        if let Some(explanation) = open {
            explanation.page = Some(page);
        }
    }));
}

/// Opens a page with the outcome, the limits and every note in full.
pub(super) fn notes(app: &mut App) {
    if in_full(app).is_empty() {
        return app.complain("there are no results to show");
    }
    app.prompts.push(Prompt::Read(Page::new("Outcome, limits, notes", None)));
}

/// Reports a letter without a command in the focused pane, and suggests a command.
pub(super) fn stray(app: &mut App, letter: char) {
    let name = if letter == ' ' { "Space".to_owned() } else { letter.to_string() };
    let meant = if app.layout.focus == Pane::Form { "Enter edits the field, " } else { "" };
    let pane = app.layout.focus.name();
    app.say(format!("{name} is not a command in {pane}: {meant}? lists the keys"));
}

/// Zooms the teeth in by steps, or out if negative.
pub(super) fn zoom_teeth(app: &mut App, steps: i32) {
    let zoomed = |picture: Picture<'_>| app.teeth.zoomed(steps, picture.inputs, picture.solution);
    let Some(view) = app.picture().map(zoomed) else {
        return app.complain("no valid results to show");
    };
    if std::mem::replace(&mut app.teeth, view) == view {
        app.say(if steps > 0 { CLOSEST } else { "the teeth pane shows the whole pair" });
    }
}

/// Shows another view of the teeth.
pub(super) fn turn_teeth(app: &mut App, by: isize) {
    app.teeth = TeethView { centre: app.teeth.centre.beside(by), zoom: 0, ..app.teeth };
    app.say(format!("view: {}", app.teeth.centre.name()));
}

/// Switches the exaggeration of the gap.
pub(super) fn switch_gap(app: &mut App) {
    app.teeth.has_true_gap = !app.teeth.has_true_gap;
    let factor = ["exaggerated by the factor shown", "drawn true to scale"];
    app.say(format!("gap {}", factor[usize::from(app.teeth.has_true_gap)]));
}

const WHOLE: &str = "the charts show the whole contact";
const CLOSEST: &str = "closest zoom";

/// Shows the next or previous chart, wrapping around.
pub(super) fn step_chart(app: &mut App, by: isize) {
    let all = CHARTS - usize::from(app.charts().pattern().is_none());
    let last = all - usize::from(by > 0);
    let selected = (app.chart.selected.min(last) + all).saturating_add_signed(by) % all;
    (app.chart.selected, app.chart.place) = (selected, None);
}

/// Goes to the chart with an index.
pub(super) fn select_chart(app: &mut App, at: usize) {
    show(app, Pane::Chart);
    (app.chart.selected, app.chart.place) = (at, None);
}

/// Moves the cursor of a chart with its own axes by points.
pub(super) fn step_point(app: &mut App, by: isize) {
    app.chart.place = app.charts().moved(by);
    if app.chart.place.is_none() {
        app.say("no chart to move in");
    }
}

/// Moves that cursor to the next peak.
fn step_peak(app: &mut App) {
    match app.charts().next_peak() {
        Some(place) => app.chart.place = Some(place),
        None => app.say("no chart to move in"),
    }
}

/// Zooms the charts in by steps, or out if negative.
pub(super) fn zoom_chart(app: &mut App, steps: i32) {
    let (before, view) = (app.charts().view(), app.charts().zoomed(steps));
    app.chart.view = view;
    if view == before {
        app.say(if steps > 0 { CLOSEST } else { WHOLE });
    }
}

pub(super) fn show_whole(app: &mut App) {
    app.chart.view = ChartView::Whole;
    app.say(WHOLE);
}

/// Switches between the strike and the whole contact.
pub(super) fn show_strike(app: &mut App) {
    let scale = app.charts().scale();
    app.chart.view = app.charts().view().strike_or_whole(&scale);
    app.say(match app.chart.view {
        ChartView::Strike if scale.strike.is_empty() => "no corner contact: no strike to show",
        ChartView::Strike => "the charts show the strike",
        _ => WHOLE,
    });
}

/// Switches the x axis between roll angle and time.
pub(super) fn switch_time(app: &mut App) {
    app.chart.by_time = !app.chart.by_time;
    app.say(if app.chart.by_time { "time after E" } else { "driver roll angle" });
}

/// Scrolls to a moved cursor.
pub(super) fn follow_cursor(app: &mut App, cursor_before: Option<f64>) {
    if let Some(cursor) = app.cursor.filter(|_| app.cursor != cursor_before) {
        app.chart.view = app.charts().following(cursor);
    }
}

/// Moves the cursor along the face by slices.
pub(super) fn step_slice(app: &mut App, by: isize) {
    if begin_in_pattern(app) {
        return;
    }
    match app.charts().pattern().map(|pattern| pattern.beside(app.chart.z, by)) {
        Some(z) => app.chart.z = z,
        None => app.complain("no line load over the face width to move in"),
    }
}

/// Starts a cursor of the contact pattern at its greatest line load. Returns whether it did.
fn begin_in_pattern(app: &mut App) -> bool {
    let is_first = app.cursor.is_none() && app.layout.focus == Pane::Chart;
    let found = greatest_load(app.charts()).ok().filter(|_| is_first);
    if let Some((angle, z)) = found {
        (app.cursor, app.chart.z) = (Some(angle), z);
        stop_playing(app);
    }
    found.is_some()
}

/// Moves the cursor by columns towards E.
pub(super) fn step_cursor(app: &mut App, columns: isize) {
    if begin_in_pattern(app) {
        return;
    }
    let reach = range_of_cursor(app).map(|reach| reach.moved(app.cursor, columns));
    put_cursor(app, reach.ok_or(NO_CURSOR));
}

pub(super) fn put_cursor(app: &mut App, angle: Result<f64, &str>) {
    match angle {
        Ok(angle) => app.cursor = Some(angle),
        Err(reason) => app.complain(reason),
    }
    stop_playing(app);
}

/// Moves the cursor to the first contact.
pub(super) fn cursor_to_start(app: &mut App) {
    let start = app.charts().solution().and_then(first_contact);
    put_cursor(app, start.ok_or("no corner contact, so no D"));
}

/// Asks for an angle, a time or a point.
pub(super) fn ask_cursor(app: &mut App) {
    let is_own = app.chart.own_axes().is_some() && !app.chart.is_pattern();
    if is_own && app.layout.focus == Pane::Chart {
        step_peak(app);
    } else if range_of_cursor(app).is_some() {
        let dialog = PathDialog::new("Cursor to", HOW, Line::default(), move_cursor);
        app.prompts.push(Prompt::Path(PathDialog { meaning: Some(meaning), ..dialog }));
    } else {
        app.complain(NO_CURSOR);
    }
}

/// Moves the cursor to the typed angle. Shows the chart if neither charts nor teeth are visible.
fn move_cursor(app: &mut App, typed: &str, _: Next) {
    match parse_cursor(app.charts(), typed) {
        Ok(angle) => {
            app.prompts.pop();
            let plan = app.layout.plan();
            if !plan.shows(Pane::Chart) && !plan.shows(Pane::Teeth) {
                show(app, Pane::Chart);
            }
            if let (Ok((_, z)), "peak") =
                (greatest_load(app.charts()), &*typed.trim().to_lowercase())
            {
                app.chart.z = z;
            }
            put_cursor(app, Ok(angle));
            let reading = chart::readout(app.charts(), angle);
            app.say(format!("cursor: {reading}"));
        }
        Err(reason) => {
            put_cursor(app, Err(&reason));
            // Typing replaces the invalid text.
            app.with_dialog(|dialog, _| dialog.input().map(Line::select_all));
        }
    }
}

pub(super) fn hide_cursor(app: &mut App) {
    (app.cursor, app.chart.place, app.chart.z) = (None, None, 0.0);
    stop_playing(app);
}

/// Starts or stops the animation. At its end it starts again.
pub(super) fn play(app: &mut App) {
    if stop_playing(app) {
        return;
    }
    let Some(reach) = range_of_cursor(app).filter(|reach| reach.run_from > reach.run_to) else {
        return app.complain("no corner contact, so nothing to play");
    };
    if app.cursor.is_none_or(|cursor| cursor <= reach.run_to || cursor > reach.run_from) {
        app.cursor = Some(reach.run_from);
    }
    app.is_playing = true;
    app.want(Effect::Play(true));
}

/// Moves to the next frame of the animation.
pub(super) fn tick(app: &mut App) {
    if !app.is_playing {
        return app.want(Effect::Play(false));
    }
    let reach = range_of_cursor(app);
    let next = reach.zip(app.cursor).and_then(|(reach, cursor)| reach.played(cursor));
    app.cursor = Some(next.unwrap_or(reach.map_or(0.0, |reach| reach.run_to)));
    if next.is_none() {
        stop_playing(app);
    }
}

/// Stops the animation. Returns whether it ran.
pub(super) fn stop_playing(app: &mut App) -> bool {
    let has_run = std::mem::take(&mut app.is_playing);
    if has_run {
        app.want(Effect::Play(false));
    }
    has_run
}

/// Requests the visible chart, unless it is the last request; stops a hidden one.
pub(super) fn request_chart(app: &mut App) {
    let is_visible = app.layout.plan().shows(Pane::Chart);
    let chart = app.chart.own_axes().filter(|_| is_visible && !app.chart.is_pattern());
    let inputs = app.tab.inputs().map(|inputs| {
        let chosen = app.tab.chosen.filter(|_| inputs.method == Method::Auto);
        Inputs { method: chosen.unwrap_or(inputs.method), ..inputs.clone() }
    });
    let Some((chart, inputs)) = chart.zip(inputs) else {
        if app.cancel(Slot::Chart) {
            app.tab.chart_work.request = None;
        }
        return;
    };
    let request = ChartRequest { chart, inputs };
    if app.tab.chart_work.request.as_ref() == Some(&request) {
        return;
    }
    // The new work replaces unfinished work of another tab.
    if app.is_busy(Slot::Chart) {
        app.others.iter_mut().for_each(|tab| tab.chart_work.request = None);
    }
    let (tab, own) = (app.tab.id, request.clone());
    let work = Work::in_steps(Slot::Chart, move |running| compute(tab, &own, running));
    let failed = Err("internal error".to_owned());
    let work = app.start(work.or(move |app| take_chart(app, tab, failed)));
    (app.tab.chart_work.request, app.tab.chart_work.work) = (Some(request), work);
}

/// Computes a chart for a tab and sends its values as they arrive.
fn compute(tab: usize, request: &ChartRequest, running: &Running<'_>) {
    let inputs = &request.inputs;
    let send = |found| running.send(move |app| take_chart(app, tab, found));
    let found = match request.chart {
        OwnChart::ToothCompliance(gear) => compare_flanks(inputs, FLANK_POINTS)
            .map(|flanks| tooth_chart(gear, &flanks, model_of(inputs))),
        // At rest and, for method `dynamic`, in steady motion. A closed form has no mesh; method
        // `static` replaces it.
        OwnChart::Spectrum => {
            let is_dynamic = inputs.method == Method::Dynamic;
            let method = if is_dynamic { Method::Dynamic } else { Method::Static };
            let late = Stages::of(Stage::StaticSpectrum).and(Stages::of(Stage::SteadyMotion));
            let inputs = Inputs { method, ..inputs.clone() };
            solve_while(&inputs, late, &|_| running.is_wanted())
                .map(|solution| Ok(chart_of_spectra(spectra("", &solution))))
        }
        OwnChart::Speed => {
            let mut sent = Instant::now();
            let mut show = |curve: &SpeedCurve| {
                if sent.elapsed() >= CHART_STEP {
                    sent = Instant::now();
                    if let Ok(chart) = speed_chart(&[("", curve)]) {
                        send(Ok(chart));
                    }
                }
            };
            let curve = speeds(inputs, &mut show, &|_, _| running.is_wanted());
            curve.map(|curve| speed_chart(&[("", &curve)]))
        }
        OwnChart::Pattern => return,
    };
    match found {
        Ok(found) => send(found),
        Err(Refusal::Stopped) => (),
        Err(refusal) => send(Err(format!("{refusal}: {}", refusal.fix()))),
    }
}

fn take_chart(app: &mut App, tab: usize, found: ChartValues) {
    let work = app.tab_with(tab).map(|tab| &mut tab.chart_work);
    if let Some(work) = work
        && let Some(request) = &work.request
    {
        work.found = Some((request.chart, found));
    }
}

fn range_of_cursor(app: &App) -> Option<Reach> {
    cursor_range(app.charts())
}
