//! The lines around the panes: the open cases, what is focused, the keys.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::text::{Line, Span};
use ratatui::widgets::Widget;
use unicode_width::UnicodeWidthStr;

use super::{results, text, trade};
use crate::case::fields::{self, Absent, Field, Kind};
use crate::case::units::System;
use crate::case::{Acting, FIELDS, Limit, materials, partial_relevance, relevance};
use crate::model::inputs::Method;
use crate::numeric::decimal::shortest;
use crate::report::verdict::verdicts;
use crate::tui::app::{App, Progress};
use crate::tui::ascii::symbol;
use crate::tui::commands::{BINDINGS, Binding, Command, key_of};
use crate::tui::keys::Chord;
use crate::tui::pane::Pane;
use crate::tui::panes::chart;
use crate::tui::rows::{self, Row};
use crate::tui::tab::{Origin, Tab};

/// What the header begins with.
const HEAD: &str = "tipstrike";
/// Stands before the open cases where there are others before them.
const BEFORE: &str = "‹ ";
/// A longer name of a case is cut where there are several.
const LONGEST_NAME: usize = 24;
/// Cells of a bar of progress.
const BAR: usize = 20;

/// The open cases, the current one with its path and title, and which of them are unsaved.
pub fn header(app: &App, area: Rect, buffer: &mut Buffer) {
    let mut spans = vec![Span::styled(HEAD, app.look.theme.title), Span::raw("  ")];
    if app.others.is_empty() {
        spans.extend(only_case(app, area.width));
    } else {
        spans.extend(tabs(app, area.width));
    }
    Line::from(spans).render(area, buffer);
}

/// A message, or the progress of long work; else what is focused.
pub fn hint(app: &App, area: Rect, buffer: &mut Buffer) {
    let theme = app.look.theme;
    let width = usize::from(area.width);
    let (mut lines, mut is_long) = (Vec::new(), false);
    if let Some(progress) = app.progress.clone().or_else(|| solving(app)) {
        lines.push(Line::styled(text::cut(&bar(&progress), width), theme.note));
    }
    if let Some(message) = &app.message {
        let (mark, style) = if message.is_fault {
            ("! ", theme.problem)
        } else {
            ("", theme.note)
        };
        let told = text::wrap(&format!("{mark}{}", message.text), width);
        // A fault's mend stands at its end: a long message takes the place of what is focused.
        is_long = told.len() > 1;
        if is_long {
            lines.clear();
        }
        lines.splice(0..0, told.into_iter().map(|line| Line::styled(line, style)));
    }
    let room = usize::from(area.height);
    if !is_long {
        let left = room.saturating_sub(lines.len());
        lines.extend(
            text::sentences(&focused(app), width, left)
                .into_iter()
                .map(Line::raw),
        );
    }
    if let Some(at) = room.checked_sub(1).filter(|_| lines.len() > room) {
        lines[at] = Line::styled(
            text::cut(&format!("{} {}", lines[at], lines[room]), width),
            lines[at].style,
        );
    }
    for (line, y) in lines.iter().zip(area.top()..area.bottom()) {
        line.render(
            Rect {
                y,
                height: 1,
                ..area
            },
            buffer,
        );
    }
}

/// As many keys as fit, from the table of bindings.
pub fn keys(app: &App, area: Rect, buffer: &mut Buffer) {
    let theme = app.look.theme;
    let place = app.place();
    let mut spans = Vec::new();
    let mut told: Vec<&str> = Vec::new();
    let mut left = usize::from(area.width);
    for binding in BINDINGS
        .iter()
        .filter(|binding| binding.places.meets(place) && binding.footer.meets(place))
    {
        let key = short(binding);
        let used = key.width() + binding.name.width() + 3;
        if used > left + 2 {
            break;
        }
        if told.contains(&binding.name) {
            continue;
        }
        told.push(binding.name);
        left = left.saturating_sub(used);
        spans.extend([
            Span::styled(key, theme.key),
            Span::raw(format!(" {}  ", binding.name)),
        ]);
    }
    Line::from(spans).render(area, buffer);
}

/// What a field is, in its own words.
#[must_use]
pub fn about(field: &Field, ascii: bool, units: System) -> String {
    let name = [symbol(field.symbol, ascii).as_ref(), &field.full_label()].join(" ");
    let bounds = match field.kind {
        Kind::Text => String::new(),
        Kind::Number(_, range, _) if units.unit(range.unit) == range.unit => format!(
            ", {}..{} {}",
            shortest(range.from),
            shortest(range.to),
            range.unit
        )
        .trim_end()
        .to_owned(),
        Kind::Number(..) => format!(", {}", field.range_in(units)),
        Kind::Count(from, to, _) => format!(", {from}..{to}"),
        Kind::Choice(names, _) => format!(", {}", names.join(" | ")),
    };
    let absent = match field.absent {
        Absent::Default("") | Absent::Refused | Absent::Either(_) => String::new(),
        Absent::Default(_) => format!(" (else {})", field.default_in(units)),
        Absent::Without(_) => " (may be empty)".to_owned(),
    };
    format!("{}{bounds}{absent}. {}", name.trim_start(), field.help)
}

fn only_case(app: &App, width: u16) -> Vec<Span<'static>> {
    let last = if app.tab.origin == Origin::LastCase {
        format!(" (last case; {}: Table 1)", key_of(Command::BuiltIn))
    } else {
        String::new()
    };
    let mark = [
        if app.tab.is_unsaved() {
            " *unsaved*"
        } else {
            ""
        },
        app.tab.access.mark(),
        &last,
    ]
    .concat();
    let room = usize::from(width).saturating_sub(11 + mark.width());
    let instead = app
        .tab
        .in_place_of
        .as_ref()
        .map(|path| format!(", for {} cannot be opened", path.display()));
    let name = text::cut(
        &format!("{}{}", app.tab.name(), instead.unwrap_or_default()),
        room,
    );
    let title = fields::index_of("title")
        .and_then(|title| app.tab.case.text(title))
        .unwrap_or_default();
    let left = usize::from(width).saturating_sub(11 + name.width() + mark.width() + 3);
    let title = if title.is_empty() || left <= 8 {
        String::new()
    } else {
        format!("   {}", text::cut(title, left))
    };
    vec![
        Span::raw(name),
        Span::styled(mark, app.look.theme.note),
        Span::raw(title),
    ]
}

/// The place of the open case whose name stands on a cell, where there is one.
#[must_use]
pub fn tab_at(app: &App, area: Rect, at: Position) -> Option<usize> {
    if app.others.is_empty() || !area.contains(at) {
        return None;
    }
    let names: Vec<String> = app
        .tabs()
        .enumerate()
        .map(|(at, tab)| tab_name(at, tab))
        .collect();
    let (from, to) = window(
        &names,
        app.place_of_tab,
        usize::from(area.width).saturating_sub(15),
    );
    let mut right =
        usize::from(area.x) + HEAD.width() + 2 + if from > 0 { BEFORE.width() } else { 0 };
    (from..to).find(|&tab| {
        let left = right;
        right += names[tab].width() + 2;
        (left..right).contains(&at.x.into())
    })
}

// The open cases by their numbers, as many around the current one as have room; a mark at the end
// where others are.
fn tabs(app: &App, width: u16) -> Vec<Span<'static>> {
    let names: Vec<String> = app
        .tabs()
        .enumerate()
        .map(|(at, tab)| tab_name(at, tab))
        .collect();
    let (from, to) = window(
        &names,
        app.place_of_tab,
        usize::from(width).saturating_sub(15),
    );
    let mut spans = vec![Span::raw(if from > 0 { BEFORE } else { "" })];
    for (at, name) in names.iter().enumerate().take(to).skip(from) {
        if at == app.place_of_tab {
            spans.push(Span::styled(format!("[{name}]"), app.look.theme.key));
        } else {
            spans.push(Span::raw(format!(" {name} ")));
        }
    }
    spans.push(Span::raw(if to < names.len() { " ›" } else { "" }));
    spans
}

fn tab_name(at: usize, tab: &Tab) -> String {
    format!(
        "{} {}{}{}",
        at + 1,
        text::cut(&tab.short_name(), LONGEST_NAME),
        if tab.is_unsaved() { "*" } else { "" },
        tab.access.mark()
    )
}

// The first and the last but one of the names that have room, grown from the one in the middle.
fn window(names: &[String], middle: usize, width: usize) -> (usize, usize) {
    let size = |at: usize| names.get(at).map_or(0, |name| name.width() + 2);
    let (mut from, mut to, mut used) = (middle, middle + 1, size(middle));
    loop {
        if to < names.len() && used + size(to) <= width {
            used += size(to);
            to += 1;
        } else if from > 0 && used + size(from - 1) <= width {
            from -= 1;
            used += size(from);
        } else {
            return (from, to);
        }
    }
}

fn focused(app: &App) -> String {
    match app.panes.focus {
        Pane::Form => {
            let about = match rows::row(&app.tab.case, app.tab.focus) {
                Row::Field(field) => about_field(app, field),
                Row::Limit(limit) => about_limit(app, limit),
            };
            typed(app)
                .into_iter()
                .chain([about])
                .collect::<Vec<_>>()
                .join(" ")
        }
        Pane::Results => results::marked(app).map_or_else(String::new, |quantity| {
            let method = app
                .tab
                .answer
                .as_ref()
                .map_or(Method::Exact, |answer| answer.active);
            let name = symbol(quantity.symbol_in(method), app.look.ascii);
            let about = format!(
                "{name} {}, {} ({}).",
                quantity.label_in(method).trim(),
                symbol(quantity.equation, app.look.ascii),
                quantity.key
            );
            let compared = results::compared(app, quantity)
                .map_or_else(String::new, |compared| format!("{compared} "));
            compared + &about
        }),
        Pane::Chart | Pane::Teeth => at_cursor(app),
        Pane::Trade => trade::signs(app),
    }
}

// The unit that a number typed without one takes, or why it is no value yet. That it stays as it is
// while digits are typed spares bytes.
fn typed(app: &App) -> Option<String> {
    if app.lacks(app.tab.focus) {
        let example = rows::field(&app.tab.case, app.tab.focus).map_or("", Field::example);
        return Some(format!("Required, such as {example}."));
    }
    if app.is_unfinished(app.tab.focus)
        && let Some((_, problem)) = app.tab.problems.iter().find(|(at, _)| *at == app.tab.focus)
    {
        return Some(format!("Not yet: {}: {}.", problem.cause, problem.mend));
    }
    app.ending()?;
    rows::written_unit(&app.tab.case, app.tab.focus).map(|unit| format!("Unit added: {unit}."))
}

// What is typed in another unit, why it does not act, what it is.
fn about_field(app: &App, index: usize) -> String {
    let field = &FIELDS[index];
    let converted = app
        .tab
        .case
        .text(index)
        .and_then(|text| field.converted(text, app.settings.units));
    let inputs = app.tab.case.inputs_so_far();
    let idle = match relevance(index, &inputs) {
        Acting::No(why) | Acting::Beside(why) if !matches!(field.kind, Kind::Text) => {
            Some(format!("Not used: {why}."))
        }
        _ => partial_relevance(index, &inputs).map(|why| format!("Limited effect: {why}.")),
    };
    let about = about(field, app.look.ascii, app.settings.units);
    [
        converted.map(|value| value + "."),
        idle,
        material(app, field),
        Some(about),
    ]
    .into_iter()
    .flatten()
    .collect::<Vec<_>>()
    .join(" ")
}

// Where the value is from, where it is that of a material.
fn material(app: &App, field: &Field) -> Option<String> {
    let is_of_material = matches!(field.name(), "young" | "poisson" | "density");
    match materials::of_gear(&app.tab.case, field.table())[..] {
        [material] if is_of_material => Some(format!("{}: {}.", material.name, material.source)),
        _ => None,
    }
}

fn about_limit(app: &App, limit: &Limit) -> String {
    let solution = app
        .tab
        .answer
        .as_ref()
        .and_then(|answer| answer.of(answer.active))
        .filter(|_| !app.tab.is_stale());
    let of_case = |solution| {
        verdicts(&app.tab.case, solution)
            .into_iter()
            .find(|verdict| verdict.limit.quantity == limit.quantity)
    };
    let verdict = solution
        .filter(|_| !limit.text.is_empty())
        .and_then(of_case);
    let told = verdict.map(|verdict| {
        format!(
            "{} {}. ",
            verdict.standing.word(),
            verdict.told(app.settings.units)
        )
    });
    format!(
        "{}The greatest value that {} may take; empty: none.",
        told.unwrap_or_default(),
        rows::label(&app.tab.case, app.tab.focus)
    )
}

fn at_cursor(app: &App) -> String {
    const NONE: &str = "No cursor: h and l show it, Space plays it.";
    const MARKS: &str = "D first contact, E and B ends of the path of contact, L last contact, d another method's D.";
    const LINES: &str = "Solid: flanks (incoming pair bold), path of contact; dashed: line of action; dots: base circles, tip's path.";
    match app.cursor {
        Some(cursor) => chart::readout(&app.charts(), cursor),
        None if app.panes.focus == Pane::Chart => format!("{NONE} {MARKS}"),
        None => format!("{NONE} {LINES}"),
    }
}

// A solve that takes its time.
fn solving(app: &App) -> Option<Progress> {
    let method = app
        .tab
        .answer
        .as_ref()
        .and_then(|answer| answer.pending)
        .map_or("", Method::name);
    app.tab.solving.map(|part| Progress {
        what: format!("solving {method}"),
        part,
    })
}

fn bar(progress: &Progress) -> String {
    let part = if progress.part.is_finite() {
        progress.part.clamp(0.0, 1.0)
    } else {
        0.0
    };
    let full = (part * BAR as f64).floor() as usize;
    let bar = "█".repeat(full) + &"░".repeat(BAR - full);
    format!(
        "{bar} {:3.0} % {}; Esc cancels",
        part * 100.0,
        progress.what
    )
}

fn short(binding: &Binding) -> String {
    binding
        .chords
        .first()
        .map(Chord::short_name)
        .unwrap_or_default()
}
