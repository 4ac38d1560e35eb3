//! Draws the screen from the state: the open cases, the panes, the hint and the keys.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use ratatui::text::{Line, Span};

use super::app::App;
use super::app::actions::Binding;
use super::app::panes::chart;
use super::app::panes::form;
use super::app::panes::results;
use super::app::panes::study;
use super::app::panes::teeth;
use super::app::panes::trade;
use super::form_aids::materials;
use super::layout::{self, Pane, SMALLEST};
use super::rows::{self, Row};
use super::text::{self, symbol};
use super::update::commands::BINDINGS;
use crate::case::fields::{Absent, Field, Kind, in_unit, index_of};
use crate::case::{Acting, FIELDS, Limit, Spread, partial_relevance, relevance};
use crate::model::inputs::Method;
use crate::report::verdict::verdicts;
use crate::study::tolerance::centre;
use crate::study::trade::Trade;

/// Draws the whole screen on a buffer of its size. Returns the position of the text cursor, if any.
pub fn draw(app: &App, buffer: &mut Buffer) -> Option<Position> {
    let area = buffer.area;
    let cursor = if layout::is_too_small(app.layout.size) {
        let words = format!(
            "{}x{} cells needed; this is {}x{}. Nothing is lost.",
            SMALLEST.width, SMALLEST.height, area.width, area.height
        );
        text::draw_lines(text::wrap(&words, area.width.into()), area, buffer);
        None
    } else {
        draw_panes(app, buffer)
    };
    text::finish(buffer, app.look.ascii);
    cursor.filter(|&cursor| area.contains(cursor))
}

/// Draws a message, the progress of long work, and the hint of the focused item, as far as there is
/// room.
fn hint(app: &App, area: Rect, buffer: &mut Buffer) {
    let theme = app.look.theme;
    let mut parts = Vec::new();
    if let Some(message) = &app.message {
        let (mark, style) = if message.is_fault { ("! ", theme.problem) } else { ("", theme.note) };
        parts.push((format!("{mark}{}", message.text), style));
    }
    if let Some((what, part)) = progress(app) {
        // Esc first leaves the field.
        let cancel = if app.has_line() { "Ctrl-C" } else { "Esc" };
        let part = if part.is_finite() { 100.0 * part.clamp(0.0, 1.0) } else { 0.0 };
        parts.push((format!("{part:.0} % {what}; {cancel} cancels"), theme.note));
    }
    parts.push((focused(app), Style::new()));
    let mut lines = Vec::new();
    for (words, style) in parts {
        let room = usize::from(area.height).saturating_sub(lines.len());
        let fitted = text::fitted(&words, area.width.into(), room);
        lines.extend(fitted.into_iter().map(|line| Line::styled(line, style)));
    }
    text::draw_lines(lines, area, buffer);
}

/// As many keys as fit, from the table of bindings.
fn keys(app: &App, area: Rect, buffer: &mut Buffer) {
    let theme = app.look.theme;
    let place = app.place();
    let (mut spans, mut shown) = (Line::default(), Vec::<&str>::new());
    let is_here = |one: &&Binding| one.places.meets(place) && one.status.meets(place);
    for binding in BINDINGS.iter().filter(is_here) {
        let key = binding.first_key().replace("Ctrl-", "^").replace("Shift-Tab", "S-Tab");
        let used = spans.width() + key.len() + binding.name.len() + 1;
        if used > area.width.into() {
            break;
        }
        if !shown.contains(&binding.name) {
            shown.push(binding.name);
            spans.extend([Span::styled(key, theme.key), format!(" {}  ", binding.name).into()]);
        }
    }
    text::draw_lines([spans], area, buffer);
}

fn draw_panes(app: &App, buffer: &mut Buffer) -> Option<Position> {
    let plan = app.layout.plan();
    let header = app.header().into_iter().map(|(_, span)| span);
    text::draw_lines([header.collect::<Line<'_>>()], plan.header, buffer);
    let mut cursor = None;
    for pane in Pane::ALL.into_iter().filter(|&pane| plan.shows(pane)) {
        match pane {
            Pane::Form => cursor = form::draw(app, buffer),
            Pane::Results => results::draw(app, buffer),
            Pane::Chart => drop(chart::draw(app.charts(), buffer)),
            Pane::Teeth => teeth::draw_pane(app, buffer),
            Pane::Trade => trade::draw(app, buffer),
            Pane::Study => study::draw(app, buffer),
        }
    }
    hint(app, plan.hint, buffer);
    keys(app, plan.keys, buffer);
    match app.prompts.last() {
        Some(prompt) => prompt.dialog().draw(app, buffer),
        None => cursor,
    }
}

fn focused(app: &App) -> String {
    match app.layout.focus {
        Pane::Form => {
            let about = match rows::row(&app.tab.case, app.tab.form.focus) {
                Row::Field(field) => about_field(app, field),
                Row::Limit(limit) => about_limit(app, limit),
                Row::Spread(spread) => about_spread(app, spread),
            };
            typed(app).into_iter().chain([about]).collect::<Vec<_>>().join(" ")
        }
        Pane::Results => app.marked_result().map_or_else(String::new, |quantity| {
            let method = app.tab.answer.as_ref().map_or(Method::Exact, |answer| answer.active);
            let [name, equation] = [quantity.symbol_in(method), quantity.equation]
                .map(|text| symbol(text, app.look.ascii));
            let label = results::label(quantity, method);
            let about = format!("{name} {}, {equation} ({}).", label.trim(), quantity.key);
            let compared = results::compared(app, quantity);
            compared.into_iter().chain([about]).collect::<Vec<_>>().join(" ")
        }),
        Pane::Chart if app.chart.own_axes().is_some() => app.charts().own_readout(),
        Pane::Chart | Pane::Teeth => at_cursor(app),
        Pane::Trade => trade::signs(app).to_owned(),
        Pane::Study => study::hint(app),
    }
}

// The unit that a bare number gets, or why the typed text is not yet valid. The text does not
// change while digits are typed, which saves output.
fn typed(app: &App) -> Option<String> {
    let (case, row) = (&app.tab.case, app.tab.form.focus);
    if rows::lacks(case, row) {
        let example = |field: &Field| field.example_in(app.bare_unit(row));
        let example = rows::field(case, row).map(example).unwrap_or_default();
        return Some(format!("Required, such as {example}."));
    }
    let problem = app.tab.problems.iter().find(|(at, _)| *at == row);
    if let Some((_, problem)) = problem.filter(|_| app.is_unfinished(row)) {
        return Some(format!("Not yet: {}: {}.", problem.cause, problem.fix));
    }
    app.ending()?;
    rows::written_unit(case, row).map(|unit| format!("Unit added: {unit}."))
}

// The typed value in another unit, why the field has no effect, its spread, the source of the value
// if it is that of a material, and the description of the field.
fn about_field(app: &App, index: usize) -> String {
    let (field, unit, case) = (&FIELDS[index], app.bare_unit(index), &app.tab.case);
    let converted = |text| field.converted(text, app.settings.units);
    let converted = case.text(index).and_then(converted);
    let inputs = &app.tab.inputs_so_far;
    let idle = match relevance(index, inputs) {
        Acting::No(why) | Acting::Beside(why) if !matches!(field.kind, Kind::Text) => {
            Some(format!("Not used: {why}."))
        }
        _ => partial_relevance(index, inputs).map(|why| format!("Limited effect: {why}.")),
    };
    let spread = case.spread.iter().find(|spread| spread.field == field.key);
    let spread = spread.map(|spread| format!("Spread: {}.", spread.text));
    let material = match materials::of_gear(case, field.table())[..] {
        [material] if matches!(field.name(), "young" | "poisson" | "density") => {
            Some(format!("{}: {}.", material.name, material.source))
        }
        _ => None,
    };
    let name = format!("{} {}", symbol(field.symbol, app.look.ascii), field.full_label());
    let range = Some(field.range_in(unit)).filter(|range| !range.is_empty());
    let range = range.map_or_else(String::new, |range| format!(", {range}"));
    let absent = match field.absent {
        Absent::Default("") | Absent::Refused | Absent::Either => String::new(),
        Absent::Default(text) => format!(" (default {})", field.text_in(text, unit)),
        Absent::Without(_) => " (may be empty)".to_owned(),
    };
    let about = format!("{}{range}{absent}. {}", name.trim_start(), field.help);
    let parts = [converted.map(|value| value + "."), idle, spread, material, Some(about)];
    parts.into_iter().flatten().collect::<Vec<_>>().join(" ")
}

fn about_limit(app: &App, limit: &Limit) -> String {
    let (_, name) = rows::names_of(&app.tab.case, app.tab.form.focus);
    let solution = app.tab.present().filter(|_| !limit.text.is_empty());
    let verdicts = solution.map_or_else(Vec::new, |solution| verdicts(&app.tab.case, solution));
    let verdict = verdicts.iter().find(|verdict| verdict.limit.quantity == limit.quantity);
    let verdict = verdict.filter(|verdict| !app.tab.awaits(verdict));
    let sentence = verdict.map(|verdict| {
        format!("{} {}. ", verdict.standing.word(), verdict.sentence(app.settings.units))
    });
    let own = limit.quantity;
    let multiple = match own.key {
        "mesh_force" | "static_te_peak_to_peak" => "",
        _ if own.unit == "N" => ", or 1.3 x mesh_force (1.3 x nominal)",
        key if key.contains("_te_") || key.contains("transmission_error") => {
            ", or 1.3 x static_te_peak_to_peak"
        }
        _ => "",
    };
    format!("{}Upper limit of {name}{multiple}; empty: no limit.", sentence.unwrap_or_default())
}

fn about_spread(app: &App, spread: &Spread) -> String {
    let (case, inputs) = (&app.tab.case, &app.tab.inputs_so_far);
    let (_, name) = rows::names_of(case, app.tab.form.focus);
    let unit = rows::displayed_unit(case, app.tab.form.focus, app.settings.units);
    let one = if matches!(unit, "in" | "thou") { "0.1" } else { "1" };
    let value = index_of(spread.field).and_then(|field| centre(field, case, inputs));
    let value = value.map(|value| in_unit(value, unit));
    let value = value.map_or(", which has no value".to_owned(), |value| format!(" around {value}"));
    let grade = if spread.field.ends_with("base_pitch") { ", grade 7" } else { "" };
    format!(
        "Distribution of {name}{value}: normal {one} {unit} (standard deviation), uniform, \
            triangular or truncated {one} {unit} (half-width){grade}; empty: none."
    )
}

fn at_cursor(app: &App) -> String {
    const NONE: &str = "Cursor hidden. h and l show the cursor; Space plays the motion. D first \
        contact; E and B ends of the path of contact (A and E of ISO 21771); L last contact.";
    app.cursor.map_or_else(|| NONE.to_owned(), |cursor| chart::readout(app.charts(), cursor))
}

// The name of running work and its completed part: of a benchmark or of a slow solve.
fn progress(app: &App) -> Option<(String, f64)> {
    if app.is_measuring() {
        let trade = app.tab.traded.as_ref().and_then(|traded| traded.trade.as_ref());
        return Some(("measuring".to_owned(), trade.map_or(0.0, Trade::part)));
    }
    let method = app.tab.answer.as_ref().and_then(|answer| answer.pending).map_or("", Method::name);
    app.tab.solving.map(|part| (format!("solving {method}"), part))
}
