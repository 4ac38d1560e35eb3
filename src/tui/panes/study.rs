//! The study pane: the selected result over the range of the focused field, a map over two fields,
//! or the tolerance of the case.

mod curve;
mod map;
pub(crate) mod range;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::symbols::Marker;
use unicode_width::UnicodeWidthStr;

use super::Title;
use crate::case::units::System;
use crate::case::{Case, FIELDS};
use crate::model::Outcome;
use crate::model::inputs::Method;
use crate::report::chart::Axis;
use crate::report::{common_unit, shown_in};
use crate::study::axis::Axis as StudyAxis;
use crate::study::batch::PointOutcome;
use crate::study::batch::Refused;
use crate::tui::ascii::symbol;
use crate::tui::study::{End, Layer, LayerFound, SAMPLES, Study, StudyParameters, StudyResults};
use crate::tui::text;
use crate::tui::theme::Look;

/// Points of a curve over a range.
pub(crate) const CURVE_POINTS: usize = 101;
/// Greatest number of points of a map, horizontally and vertically.
const MOST_CELLS: (u16, u16) = (60, 30);
/// Columns and rows of a map outside its cells.
const MAP_MARGIN: (u16, u16) = (12, 6);
/// Least height of a pane with two rows for the texts.
const TALL: u16 = 8;
/// The texts below a plot get at most this fraction of the rows.
const WORDS: u16 = 4;
/// Signs of a point without contact and of a refused point.
const NO_CONTACT: &str = "_";
const REFUSED: &str = "!";

/// The state of the pane.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct StudyState {
    /// Whether the pane shows the tolerance.
    pub(crate) is_tolerance: bool,
    /// The second field of a map.
    pub(crate) second: Option<usize>,
    /// Number of halvings of the ranges; negative for doublings.
    pub(crate) zoom: i32,
    /// The first visible line of the tolerance.
    pub(crate) top: usize,
}

/// A command of the pane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum StudyCommand {
    /// Moves the cursor horizontally and vertically.
    Move(isize, isize),
    /// Scrolls the tolerance by lines.
    Scroll(isize),
    /// Scrolls the tolerance by pages.
    Page(isize),
    /// Halves or doubles the range.
    Zoom(i32),
    /// Restores the default range.
    Reset,
    /// Chooses a second field, or leaves the map.
    Second,
    /// Shows the tolerance, or the curve again.
    Tolerance,
    /// Writes the values at the cursor into the form.
    Take,
}

/// The pane with the study that it shows.
#[derive(Debug, Clone)]
pub(crate) struct StudyPane<'a> {
    /// The state of the pane.
    pub(crate) state: StudyState,
    /// The study of the open case.
    pub(crate) study: &'a Study,
    /// The case in the form.
    pub(crate) case: &'a Case,
    /// The value of the selected quantity in the present case, in SI.
    pub(crate) present: Option<f64>,
    /// The display units.
    pub(crate) units: System,
    /// The marker of curves.
    pub(crate) marker: Marker,
    /// The capabilities of the terminal.
    pub(crate) look: Look,
    /// The title line.
    pub(crate) title: Title,
    /// The area of the pane with its title; empty if the pane is hidden.
    pub(crate) area: Rect,
}

/// The number of points of a map in a pane with an area, horizontally and vertically.
#[must_use]
pub(crate) fn map_points(area: Rect) -> (usize, usize) {
    let across = area.width.saturating_sub(MAP_MARGIN.0).clamp(2, MOST_CELLS.0);
    let up = area.height.saturating_sub(MAP_MARGIN.1).clamp(2, MOST_CELLS.1);
    (across.into(), up.into())
}

/// Draws the pane.
pub(crate) fn draw(pane: &StudyPane<'_>, buffer: &mut Buffer) {
    let inner = pane.title.draw(&title(pane), pane.area, buffer);
    if inner.is_empty() {
        return;
    }
    if let Some(obstacle) = &pane.study.obstacle {
        return text::draw_words(obstacle, inner, buffer);
    }
    let Some(shown) = &pane.study.shown else {
        return text::draw_words("Computing.", inner, buffer);
    };
    let StudyParameters::Grid(grid) = &shown.request.parameters else {
        return draw_page(pane, shown, inner, buffer);
    };
    let lines = below(pane, shown, text_room(inner.width));
    let (plot, words) = split(inner, lines.len());
    match grid.axes.as_slice() {
        [across] => curve::draw(pane, shown, across, plot, buffer),
        [up, across] => map::draw(pane, shown, (across, up), plot, buffer),
        _ => {}
    }
    for (line, row) in lines.iter().zip(words.rows()) {
        buffer.set_stringn(row.x + 1, row.y, line, usize::from(row.width) - 1, Style::new());
    }
}

/// The hint line while the pane has the focus: the values at the cursor if the pane cuts them,
/// otherwise the signs.
#[must_use]
pub(crate) fn hint(pane: &StudyPane<'_>) -> String {
    let shown = pane.study.shown.as_ref();
    let shown = shown.filter(|_| pane.study.obstacle.is_none());
    match shown.map(|shown| (shown, &shown.request.parameters)) {
        Some((shown, StudyParameters::Grid(_))) => {
            let line = values_at_cursor(pane, shown);
            if line.width() > text_room(pane.area.width) {
                format!("{line}.")
            } else {
                format!(
                    "● present value, ▴ cursor, {NO_CONTACT} no contact, {REFUSED} refused point."
                )
            }
        }
        Some((_, StudyParameters::Tolerance(_))) => {
            format!("{SAMPLES} samples draw every field of [spread] from its distribution.")
        }
        None => "The study varies the focused field over a range.".to_owned(),
    }
}

/// The text of each varied field at the cursor, in the syntax of a case file.
#[must_use]
pub(crate) fn at_cursor(pane: &StudyPane<'_>) -> Vec<(usize, String)> {
    let Some(shown) = &pane.study.shown else {
        return Vec::new();
    };
    let (across, up) = axes(shown);
    let (x, y) = cursor(pane, shown);
    let text = |axis: &StudyAxis, at: usize| (axis.field, axis.with_unit(at));
    let first = across.map(|axis| text(axis, x));
    let second = up.map(|axis| text(axis, y));
    first.into_iter().chain(second).collect()
}

/// The cursor after a move by points on the visible axes.
#[must_use]
pub(crate) fn moved(pane: &StudyPane<'_>, across: isize, up: isize) -> Option<(usize, usize)> {
    let shown = pane.study.shown.as_ref()?;
    let last =
        |axis: Option<&StudyAxis>| axis.map_or(0, |axis| axis.points.len().saturating_sub(1));
    let (x_axis, y_axis) = axes(shown);
    let (x, y) = cursor(pane, shown);
    Some((
        x.saturating_add_signed(across).min(last(x_axis)),
        y.saturating_add_signed(up).min(last(y_axis)),
    ))
}

/// The first visible line of the tolerance after scrolling by lines downwards.
#[must_use]
pub(crate) fn scrolled(pane: &StudyPane<'_>, by: isize) -> usize {
    let Some(shown) = &pane.study.shown else {
        return 0;
    };
    let last = shown.page.len().saturating_sub(page_height(pane));
    top(pane, shown).saturating_add_signed(by).min(last)
}

/// The first visible line after scrolling by pages, which overlap by one line.
#[must_use]
pub(crate) fn paged(pane: &StudyPane<'_>, by: isize) -> usize {
    let page = page_height(pane).saturating_sub(1).max(1);
    scrolled(pane, by * isize::try_from(page).unwrap_or(1))
}

/// The first and the second axis.
fn axes(shown: &StudyResults) -> (Option<&StudyAxis>, Option<&StudyAxis>) {
    match &shown.request.parameters {
        StudyParameters::Grid(grid) => {
            let second = grid.axes.first().filter(|_| grid.axes.len() == 2);
            (grid.axes.last(), second)
        }
        StudyParameters::Tolerance(_) => (None, None),
    }
}

/// The point of the cursor; without a cursor, the point of the present case.
fn cursor(pane: &StudyPane<'_>, shown: &StudyResults) -> (usize, usize) {
    let (across, up) = axes(shown);
    let at = |axis: Option<&StudyAxis>, chosen: Option<usize>| {
        let own = || axis.and_then(|axis| range::nearest(axis, pane.case));
        let last = axis.map_or(0, |axis| axis.points.len().saturating_sub(1));
        chosen.or_else(own).unwrap_or(0).min(last)
    };
    let chosen = pane.study.cursor;
    (at(across, chosen.map(|chosen| chosen.0)), at(up, chosen.map(|chosen| chosen.1)))
}

/// The area of the plot and the area below it for `lines` lines of text, if the plot keeps most of
/// the pane.
fn split(inner: Rect, lines: usize) -> (Rect, Rect) {
    let least = inner.height.min(if inner.height >= TALL { 2 } else { 1 });
    let most = least.max(inner.height / WORDS);
    let words = u16::try_from(lines).unwrap_or(most).clamp(least, most);
    let plot = Rect { height: inner.height - words, ..inner };
    (plot, Rect { y: plot.bottom(), height: words, ..inner })
}

/// Draws the page of a tolerance study from its first visible line on.
fn draw_page(pane: &StudyPane<'_>, shown: &StudyResults, inner: Rect, buffer: &mut Buffer) {
    if shown.page.is_empty() {
        let words = match &shown.end {
            Some(End::Failed(reason)) => reason.as_str(),
            Some(End::Stopped) => "Stopped before the first samples.",
            Some(End::Whole) | None => "Sampling.",
        };
        return text::draw_words(words, inner, buffer);
    }
    let top = top(pane, shown);
    let lines = shown.page.iter().skip(top);
    let page = Rect { x: inner.x + 1, width: inner.width.saturating_sub(2), ..inner };
    for (line, y) in lines.zip(page.top()..page.bottom()) {
        let width = usize::from(page.width);
        buffer.set_stringn(page.x, y, text::cut(line, width), width, Style::new());
    }
    text::scroll_bar_beside(top, shown.page.len(), page, buffer);
}

/// The number of lines of the tolerance that fit.
fn page_height(pane: &StudyPane<'_>) -> usize {
    usize::from(pane.area.height.saturating_sub(1))
}

/// The first visible line of the tolerance.
fn top(pane: &StudyPane<'_>, shown: &StudyResults) -> usize {
    let last = shown.page.len().saturating_sub(page_height(pane));
    pane.state.top.min(last)
}

fn title(pane: &StudyPane<'_>) -> String {
    let shown = pane.study.shown.as_ref().filter(|_| pane.study.obstacle.is_none());
    let Some((shown, known)) = shown.and_then(|shown| Some((shown, shown.quantity()?))) else {
        return "Study".to_owned();
    };
    let state = progress(shown);
    let words = match &shown.request.parameters {
        StudyParameters::Tolerance(_) => format!("Tolerance{}{state}", position(pane, shown)),
        StudyParameters::Grid(grid) => {
            let method = grid.layers.first().map_or(Method::Exact, |layer| layer.inputs.method);
            let values = shown.layers.iter().flat_map(|found| &found.values);
            let up = Axis::new(
                known.symbol_in(method),
                common_unit(known, values.flatten().copied(), pane.units),
            );
            let field = |axis: &StudyAxis| {
                Axis::new(FIELDS[axis.field].full_label(), axis.unit.clone()).in_unit()
            };
            let fields: Vec<String> = grid.axes.iter().rev().map(field).collect();
            format!("Study{state}: {} over {}", up.in_unit(), fields.join(" and "))
        }
    };
    symbol(&words, pane.look.ascii).into_owned()
}

/// The visible lines of a tolerance, if some do not fit.
fn position(pane: &StudyPane<'_>, shown: &StudyResults) -> String {
    let (lines, height) = (shown.page.len(), page_height(pane));
    if lines <= height {
        return String::new();
    }
    let top = top(pane, shown);
    format!(" {} to {} of {lines}", top + 1, (top + height).min(lines))
}

/// The progress of an unfinished study.
fn progress(shown: &StudyResults) -> String {
    match (&shown.end, &shown.request.parameters) {
        (Some(End::Whole), _) => String::new(),
        (Some(End::Stopped), _) => ", stopped".to_owned(),
        (Some(End::Failed(_)), _) => ", failed".to_owned(),
        (None, StudyParameters::Tolerance(_)) => format!(", {:.0} % solved", 100.0 * shown.part),
        (None, StudyParameters::Grid(grid)) => {
            let points: usize = grid.axes.iter().map(|axis| axis.points.len()).product();
            let solved: usize = shown.layers.iter().map(|found| found.outcomes.len()).sum();
            let all = (points * grid.layers.len()).max(1);
            format!(", {:.0} % solved", 100.0 * solved as f64 / all as f64)
        }
    }
}

/// The lines below the plot: the values at the cursor, then the refused points.
fn below(pane: &StudyPane<'_>, shown: &StudyResults, width: usize) -> Vec<String> {
    let mut lines = Vec::new();
    if let Some(End::Failed(reason)) = &shown.end {
        lines.extend(text::wrap(reason, width));
    }
    let line = values_at_cursor(pane, shown);
    lines.push(text::cut(&symbol(&line, pane.look.ascii), width));
    lines.extend(refused(shown).into_iter().flat_map(|line| text::wrap(&line, width)));
    lines
}

/// The varied values at the cursor, and the value of each curve.
fn values_at_cursor(pane: &StudyPane<'_>, shown: &StudyResults) -> String {
    let StudyParameters::Grid(grid) = &shown.request.parameters else {
        return String::new();
    };
    let (across, up) = axes(shown);
    let (x, y) = cursor(pane, shown);
    let width = across.map_or(0, |axis| axis.points.len());
    let setting = |axis: &StudyAxis, at: usize| {
        let known = &FIELDS[axis.field];
        let name = if known.symbol.is_empty() { known.label } else { known.symbol };
        format!("{name} = {}", axis.with_unit(at))
    };
    let first = across.map(|axis| setting(axis, x));
    let settings: Vec<String> = first.into_iter().chain(up.map(|axis| setting(axis, y))).collect();
    let values: Vec<String> = grid
        .layers
        .iter()
        .zip(&shown.layers)
        .filter_map(|(layer, found)| value(pane, layer, found, y * width + x))
        .collect();
    format!("{}: {}", settings.join(", "), values.join(", "))
}

fn value(pane: &StudyPane<'_>, layer: &Layer, found: &LayerFound, at: usize) -> Option<String> {
    let (name, known) = (layer.source.name(), layer.quantity()?);
    let words = match (found.outcomes.get(at)?, found.values.get(at)?) {
        (_, Some(value)) => format!(
            "{} {}",
            known.symbol_in(layer.inputs.method),
            shown_in(known, *value, pane.units)
        ),
        (PointOutcome::Refused, None) => "refused".to_owned(),
        (PointOutcome::Solved(Outcome::NoCornerContact), None) => "no contact".to_owned(),
        (PointOutcome::Solved(_), None) => "no value".to_owned(),
    };
    Some(format!("{name} {words}"))
}

/// The refused points of the first curve that has some: their number and the most frequent reason.
fn refused(shown: &StudyResults) -> Option<String> {
    let found = shown.layers.iter().find(|found| found.refusals.total() > 0)?;
    let reasons = found.refusals.0.iter();
    let Refused { count, problem, .. } = reasons.rev().max_by_key(|refused| refused.count)?;
    let total = found.refusals.total();
    let points = if total == 1 { "point" } else { "points" };
    let of_them = if *count < total { format!(", {count} of them") } else { String::new() };
    Some(format!("{total} {points} refused{of_them}: {}: {}", problem.cause, problem.fix))
}

/// The number of columns of a line in a pane with a width.
fn text_room(width: u16) -> usize {
    usize::from(width).saturating_sub(2)
}
