//! The study pane: the selected result over the range of the focused field, a map over two fields,
//! or the tolerance of the case.

mod curve;
mod map;
pub(crate) mod range;
mod words;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use super::title::Title;
use crate::case::Case;
use crate::case::units::System;
use crate::study::axis::Axis;
use crate::tui::study::{End, Study, StudyParameters, StudyResults};
use crate::tui::text;
use crate::tui::theme::Look;
use ratatui::symbols::Marker;

/// Points of a curve over a range.
pub(crate) const CURVE_POINTS: usize = 101;
/// Greatest number of points of a map, horizontally and vertically.
const MOST_CELLS: (u16, u16) = (60, 30);
/// Columns and rows of a map outside its cells.
const MAP_MARGIN: (u16, u16) = (12, 6);
/// Least heights of a pane with a row for the legend, and with two rows for the texts.
const LEGEND_FROM: u16 = 6;
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

/// The areas of legend, plot and texts.
struct Rooms {
    legend: Rect,
    plot: Rect,
    words: Rect,
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
    let room = pane.title.room(pane.area.width);
    let title = words::title(pane, room);
    let inner = pane.title.draw(&title, pane.area, buffer);
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
    let lines = words::below(pane, shown, words::room(inner.width));
    let rooms = rooms(inner, lines.len());
    match grid.axes.as_slice() {
        [across] => curve::draw(pane, shown, across, &rooms, buffer),
        [up, across] => map::draw(pane, shown, (across, up), &rooms, buffer),
        _ => {}
    }
    for (line, y) in lines.iter().zip(rooms.words.top()..rooms.words.bottom()) {
        buffer.set_stringn(inner.x + 1, y, line, usize::from(inner.width) - 1, Style::new());
    }
}

/// The text about the cursor for the hint line.
#[must_use]
pub(crate) fn hint(pane: &StudyPane<'_>) -> String {
    words::hint(pane)
}

/// The text of each varied field at the cursor, in the syntax of a case file.
#[must_use]
pub(crate) fn at_cursor(pane: &StudyPane<'_>) -> Vec<(usize, String)> {
    let Some(shown) = &pane.study.shown else {
        return Vec::new();
    };
    let (across, up) = axes(shown);
    let (x, y) = cursor(pane, shown);
    let text = |axis: &Axis, at: usize| (axis.field, axis.with_unit(at));
    let first = across.map(|axis| text(axis, x));
    let second = up.map(|axis| text(axis, y));
    first.into_iter().chain(second).collect()
}

/// The cursor after a move by points on the visible axes.
#[must_use]
pub(crate) fn moved(pane: &StudyPane<'_>, across: isize, up: isize) -> Option<(usize, usize)> {
    let shown = pane.study.shown.as_ref()?;
    let last = |axis: Option<&Axis>| axis.map_or(0, |axis| axis.points.len().saturating_sub(1));
    let (x_axis, y_axis) = axes(shown);
    let (x, y) = cursor(pane, shown);
    Some((
        x.saturating_add_signed(across).min(last(x_axis)),
        y.saturating_add_signed(up).min(last(y_axis)),
    ))
}

/// The first and the second axis.
fn axes(shown: &StudyResults) -> (Option<&Axis>, Option<&Axis>) {
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
    let at = |axis: Option<&Axis>, chosen: Option<usize>| {
        let own = || axis.and_then(|axis| range::nearest(axis, pane.case));
        let last = axis.map_or(0, |axis| axis.points.len().saturating_sub(1));
        chosen.or_else(own).unwrap_or(0).min(last)
    };
    let chosen = pane.study.cursor;
    (at(across, chosen.map(|chosen| chosen.0)), at(up, chosen.map(|chosen| chosen.1)))
}

/// The areas for `lines` lines of text below the plot, if the plot keeps most of the pane.
fn rooms(inner: Rect, lines: usize) -> Rooms {
    let legend = u16::from(inner.height >= LEGEND_FROM);
    let least = inner.height.min(if inner.height >= TALL { 2 } else { 1 });
    let most = least.max(inner.height / WORDS);
    let words = u16::try_from(lines).unwrap_or(most).clamp(least, most);
    let plot =
        Rect { y: inner.y + legend, height: inner.height.saturating_sub(legend + words), ..inner };
    Rooms {
        legend: Rect { height: legend, ..inner },
        plot,
        words: Rect { y: plot.bottom(), height: words, ..inner },
    }
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
