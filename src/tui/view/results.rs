//! The results: the outcome in a sentence, the rungs side by side, what to know, and every quantity.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::text::{Line, Span};
use ratatui::widgets::Widget;
use unicode_width::UnicodeWidthStr;

use super::{plan, text};
use crate::model::inputs::Rung;
use crate::model::{Outcome, QUANTITIES, Quantity, Solution};
use crate::report::{self, Shown};
use crate::tui::app::App;
use crate::tui::clean::symbol;
use crate::tui::solver::Answer;

/// What an engineer looks at first.
const FIRST: [&str; 5] = ["approach_angle_driven", "contact_radius_driver", "normal_velocity", "impact_force", "impact_duration"];
/// The same, when no tooth strikes.
const FIRST_WITHOUT_CONTACT: [&str; 5] =
    ["total_deviation", "equivalent_error", "combined_deflection", "mesh_force", "contact_ratio"];

const SYMBOL: usize = 7;
/// Beside labels there is room for the longest symbol.
const LONG_SYMBOL: usize = 9;
const LABEL: usize = 25;
const VALUE: usize = 9;
const UNIT: usize = 7;
/// Below this width only the active rung has room.
const ALL_RUNGS_FROM: usize = SYMBOL + 2 * (VALUE + 1) + UNIT;
/// From this width the labels have room too.
const LABELS_FROM: usize = ALL_RUNGS_FROM - SYMBOL + LONG_SYMBOL + LABEL;

/// Draw the results.
pub fn draw(app: &App, area: Rect, buffer: &mut Buffer) {
    let lines = lines(app, area.width);
    let shown = usize::from(area.height.saturating_sub(1));
    let top = app.results_top.min(lines.len().saturating_sub(shown));
    let inner = text::titled(&title(app, top, shown, lines.len()), area, app.look.theme, buffer);
    let inner = Rect { x: inner.x + inner.width.min(1), width: inner.width.saturating_sub(1), ..inner };
    for (line, y) in lines.iter().skip(top).zip(inner.top()..inner.bottom()) {
        line.render(Rect { y, height: 1, ..inner }, buffer);
    }
}

/// How many lines there are.
#[must_use]
pub fn length(app: &App) -> usize {
    lines(app, plan(app.size, app.panes).results.width).len()
}

/// How many lines are in sight.
#[must_use]
pub fn page(app: &App) -> usize {
    plan(app.size, app.panes).results.height.saturating_sub(1).into()
}

/// The outcome of a solve, in a sentence.
#[must_use]
pub fn sentence(solution: &Solution, ascii: bool) -> String {
    let value = |key| quantity_text(key, solution).unwrap_or_default();
    match solution.outcome {
        Outcome::CornerContact => {
            let force =
                quantity_text("impact_force", solution).map_or("no force is given".to_owned(), |force| format!("with {force}"));
            format!("Corner contact {} of the driver before E, {force}.", value("approach_angle_driver"))
        }
        Outcome::NoCornerContact => {
            let total = symbol("Δ", ascii);
            format!("No corner contact: {total} = {}, the tooth comes in on time.", value("total_deviation"))
        }
    }
}

fn title(app: &App, top: usize, shown: usize, count: usize) -> String {
    let name = if app.is_stale() { "Results: LAST VALID" } else { "Results" };
    let last = (top + shown).min(count);
    if count > shown { format!("{name}, {}-{last} of {count}", top + 1) } else { name.to_owned() }
}

fn lines(app: &App, width: u16) -> Vec<Line<'static>> {
    let width = usize::from(width.saturating_sub(1));
    let mut lines = banner(app, width);
    if let Some(answer) = &app.answer {
        let from = lines.len();
        lines.extend(body(app, answer, width));
        if app.is_stale() {
            lines[from..].iter_mut().for_each(|line| *line = line.clone().patch_style(app.look.theme.faint));
        }
    }
    lines
}

fn banner(app: &App, width: usize) -> Vec<Line<'static>> {
    let theme = app.look.theme;
    let said = |text: String, style: Style| text::wrap(&text, width).into_iter().map(move |line| Line::styled(line, style));
    let Some(refusal) = &app.refusal else { return Vec::new() };
    let cause = said(format!("! Not solved: {refusal}."), theme.problem);
    cause.chain(said(format!("Mend: {}.", refusal.mend()), Style::new())).collect()
}

fn body(app: &App, answer: &Answer, width: usize) -> Vec<Line<'static>> {
    let theme = app.look.theme;
    let wrapped = |text: &str, style: Style| -> Vec<Line<'static>> {
        text::wrap(text, width).into_iter().map(|line| Line::styled(line, style)).collect()
    };
    let mut lines = Vec::new();
    if let Some(solution) = answer.of(answer.active) {
        lines.extend(wrapped(&sentence(solution, app.look.ascii), theme.focus));
    }
    if let Some(band) = answer.of(answer.active).and_then(band) {
        lines.extend(wrapped(&band, Style::new()));
    }
    if let Some(ratios) = ratios(answer, app.look.ascii) {
        lines.extend(wrapped(&ratios, Style::new()));
    }
    lines.push(heading(app, answer, width));
    let first = first(answer);
    let rest = QUANTITIES.iter().filter(|quantity| !first.contains(&quantity.key));
    lines.extend(first.iter().filter_map(|key| Quantity::find(key)).map(|quantity| row(app, answer, quantity, width)));
    for note in &answer.notes {
        lines.extend(wrapped(&format!("* {}", note.message), theme.note));
    }
    lines.extend(rest.map(|quantity| row(app, answer, quantity, width)));
    lines
}

fn first(answer: &Answer) -> &'static [&'static str] {
    let strikes = |solution: &Solution| solution.outcome == Outcome::CornerContact;
    let any_strikes = answer.rungs.iter().any(|(_, result)| result.as_ref().is_ok_and(strikes));
    if any_strikes { &FIRST } else { &FIRST_WITHOUT_CONTACT }
}

// How far the force depends on the choice of stiffness model.
fn band(solution: &Solution) -> Option<String> {
    let (band, force) = (solution.band?, solution.impact?.force);
    let percent = |end: f64| 100.0 * (end / force - 1.0) + 0.0;
    let (low, high) = (quantity_number("impact_force_low", solution)?, quantity_text("impact_force_high", solution)?);
    Some(format!("stiffness band {low}..{high} ({:+.1}..{:+.1} %)", percent(band.low), percent(band.high)))
}

// How far the printed position is off, where both rungs find one.
fn ratios(answer: &Answer, ascii: bool) -> Option<String> {
    let (paper, exact) = (answer.of(Rung::Paper)?, answer.of(Rung::Exact)?);
    let ratio = |key| {
        let quantity = Quantity::find(key)?;
        let ratio = (quantity.value)(exact)? / (quantity.value)(paper)?;
        ratio.is_finite().then(|| format!("{} {}x", symbol(quantity.symbol, ascii), rounded(ratio)))
    };
    Some(format!("exact/paper: {}, {}", ratio("approach_angle_driven")?, ratio("impact_force")?))
}

fn rounded(ratio: f64) -> String {
    let digits = if ratio < 10.0 { 2 } else { usize::from(ratio < 100.0) };
    format!("{ratio:.digits$}")
}

fn columns(answer: &Answer, width: usize) -> Vec<Rung> {
    let all = answer.rungs.iter().map(|(rung, _)| *rung);
    if width >= ALL_RUNGS_FROM { all.collect() } else { vec![answer.active] }
}

fn heading(app: &App, answer: &Answer, width: usize) -> Line<'static> {
    let indent = if width >= LABELS_FROM { LONG_SYMBOL + LABEL } else { SYMBOL };
    let mut spans = vec![Span::raw(" ".repeat(indent))];
    for rung in columns(answer, width) {
        let is_active = rung == answer.active;
        let name = if is_active { format!("▸{}", rung.name()) } else { rung.name().to_owned() };
        spans.push(Span::styled(format!("{name:>VALUE$} "), style_of(app, answer, rung)));
    }
    Line::from(spans)
}

fn row(app: &App, answer: &Answer, quantity: &Quantity, width: usize) -> Line<'static> {
    let symbol = symbol(quantity.symbol, app.look.ascii);
    let mut spans = if width >= LABELS_FROM {
        vec![Span::raw(padded(&symbol, LONG_SYMBOL)), Span::raw(padded(quantity.label, LABEL))]
    } else {
        vec![Span::raw(padded(&symbol, SYMBOL))]
    };
    let mut unit = "";
    for rung in columns(answer, width) {
        let shown = answer.of(rung).and_then(|solution| shown(quantity, solution));
        unit = shown.as_ref().map_or(unit, |shown| shown.unit);
        let number = shown.map_or_else(|| "–".to_owned(), |shown| shown.number);
        let style = if rung == answer.active { app.look.theme.focus } else { Style::new() };
        spans.push(Span::styled(format!("{number:>VALUE$} "), style));
    }
    spans.push(Span::raw(unit));
    Line::from(spans)
}

fn style_of(app: &App, answer: &Answer, rung: Rung) -> Style {
    if rung == answer.active { app.look.theme.active } else { app.look.theme.other }
}

fn padded(text: &str, width: usize) -> String {
    let text = text::cut(text, width);
    let gap = width - text.width().min(width);
    text + &" ".repeat(gap)
}

fn shown(quantity: &Quantity, solution: &Solution) -> Option<Shown> {
    (quantity.value)(solution).map(|value| report::shown(quantity, value))
}

fn quantity_number(key: &str, solution: &Solution) -> Option<String> {
    Some(shown(Quantity::find(key)?, solution)?.number)
}

fn quantity_text(key: &str, solution: &Solution) -> Option<String> {
    let Shown { number, unit } = shown(Quantity::find(key)?, solution)?;
    Some(format!("{number} {unit}").trim_end().to_owned())
}
