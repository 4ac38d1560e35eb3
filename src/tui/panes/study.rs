//! The study pane: a result over the range of a field, a map over two fields, the same as a table, or
//! the tolerance of the case.

pub(crate) mod points;
pub(crate) mod range;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::symbols::Marker;
use ratatui::text::Line;

use super::Title;
use super::plot::{NO_CONTACT, REFUSED};
use crate::case::units::System;
use crate::case::{Case, FIELDS};
use crate::model::inputs::Method;
use crate::model::{Inputs, Outcome, Quantity};
use crate::report::{common_unit, shown_in, shown_with};
use crate::study::axis::Axis as StudyAxis;
use crate::study::batch::{PointOutcome, Refusals, Refused};
use crate::tui::text;
use crate::tui::text::symbol;
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

/// The state of the pane.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct StudyState {
    /// Whether the pane shows the tolerance.
    pub(crate) is_tolerance: bool,
    /// Whether the pane shows the points as a table.
    pub(crate) is_table: bool,
    /// The chosen field; otherwise the study follows the focused one.
    pub(crate) field: Option<usize>,
    /// The key of the chosen quantity; otherwise the study follows the selected result.
    pub(crate) quantity: Option<&'static str>,
    /// The typed ranges.
    pub(crate) ranges: Vec<StudyAxis>,
    /// The second field of a map.
    pub(crate) second: Option<usize>,
    /// Number of halvings of the ranges; negative for doublings.
    pub(crate) zoom: i32,
    /// The first visible line of the tolerance.
    pub(crate) top: usize,
}

/// Samples of a tolerance study in the workbench.
pub(crate) const SAMPLES: usize = 10_000;

/// A requested study.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyRequest {
    /// The number of its work.
    pub serial: u64,
    /// The study.
    pub parameters: StudyParameters,
}

/// The parameters of a study.
#[derive(Debug, Clone, PartialEq)]
pub enum StudyParameters {
    /// Values over one or two fields.
    Grid(GridParameters),
    /// The samples of `[spread]`.
    Tolerance(Box<ToleranceParameters>),
}

/// Values over one or two fields.
#[derive(Debug, Clone, PartialEq)]
pub struct GridParameters {
    /// For a map the second field, then the first one; the first of these axes varies slowest.
    pub axes: Vec<StudyAxis>,
    /// The curves; the active method comes first.
    pub(crate) layers: Vec<Layer>,
}

/// A curve, or the values of a map.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layer {
    /// Whether it is the baseline.
    pub(crate) is_baseline: bool,
    /// The case with the method of the curve.
    pub(crate) inputs: Inputs,
    /// The key of the quantity.
    pub(crate) quantity: &'static str,
}

/// The distributions of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct ToleranceParameters {
    /// The case with its distributions.
    pub(crate) case: Case,
    /// The pair.
    pub(crate) inputs: Inputs,
    /// The selected quantity.
    pub(crate) quantity: &'static str,
}

/// How a study ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum End {
    /// Every point is solved.
    Whole,
    /// The user stopped it.
    Stopped,
    /// The study is not possible, or the program failed.
    Failed(String),
}

/// The points of a layer so far.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LayerFound {
    /// How each point ended.
    pub(crate) outcomes: Vec<PointOutcome>,
    /// The value of each point in SI.
    pub values: Vec<Option<f64>>,
    /// The refused points.
    pub(crate) refusals: Refusals,
}

/// The study of an open case.
#[derive(Debug, Clone, Default)]
pub struct Study {
    /// The present request.
    pub request: Option<StudyRequest>,
    /// The point of the cursor on the first and on the second axis.
    pub cursor: Option<(usize, usize)>,
    /// Why there is no study.
    pub obstacle: Option<String>,
    /// The visible results: of the present request, or of the previous one until the first results
    /// arrive.
    pub shown: Option<StudyResults>,
}

/// The results of a study so far.
#[derive(Debug, Clone)]
pub struct StudyResults {
    /// The request.
    pub request: StudyRequest,
    /// The points of each layer.
    pub layers: Vec<LayerFound>,
    /// The page of a tolerance study.
    pub page: Vec<String>,
    /// The solved part of a tolerance study.
    pub(crate) part: f64,
    /// How the study ended, if it has ended.
    pub end: Option<End>,
}

impl Layer {
    /// The name in the legend.
    pub(crate) fn name(&self) -> &'static str {
        if self.is_baseline { "baseline" } else { self.inputs.method.name() }
    }

    /// The quantity.
    pub(crate) fn quantity(&self) -> Option<&'static Quantity> {
        Quantity::find(self.quantity)
    }
}

impl StudyParameters {
    /// The axes of a curve or a map.
    pub fn axes(&self) -> &[StudyAxis] {
        match self {
            StudyParameters::Grid(grid) => &grid.axes,
            StudyParameters::Tolerance(_) => &[],
        }
    }
}

impl Study {
    /// Starts a request. The cursor does not move on unchanged axes.
    pub fn start(&mut self, request: StudyRequest) {
        let shown = self.shown.as_ref().map(|shown| &shown.request);
        let before = self.request.as_ref().or(shown);
        if before.is_none_or(|before| before.parameters.axes() != request.parameters.axes()) {
            self.cursor = None;
        }
        self.request = Some(request);
    }

    /// The results of the present request.
    pub(crate) fn results(&mut self) -> Option<&mut StudyResults> {
        if !self.is_shown() {
            self.shown = Some(StudyResults::of(self.request.clone()?));
        }
        self.shown.as_mut()
    }

    /// Whether the present request has ended.
    pub(crate) fn is_over(&self) -> bool {
        self.is_shown() && self.shown.as_ref().is_some_and(|shown| shown.end.is_some())
    }

    fn is_shown(&self) -> bool {
        let serial = |request: &StudyRequest| request.serial;
        let shown = self.shown.as_ref().map(|shown| shown.request.serial);
        shown.is_some() && shown == self.request.as_ref().map(serial)
    }
}

impl StudyResults {
    /// The quantity of the study: that of its first curve.
    pub fn quantity(&self) -> Option<&'static Quantity> {
        match &self.request.parameters {
            StudyParameters::Grid(grid) => grid.layers.first()?.quantity(),
            StudyParameters::Tolerance(parameters) => Quantity::find(parameters.quantity),
        }
    }

    /// The method of the first curve.
    #[must_use]
    pub(crate) fn method(&self) -> Method {
        match &self.request.parameters {
            StudyParameters::Grid(grid) => {
                grid.layers.first().map_or(Method::Exact, |layer| layer.inputs.method)
            }
            StudyParameters::Tolerance(parameters) => parameters.inputs.method,
        }
    }

    fn of(request: StudyRequest) -> StudyResults {
        let layers = match &request.parameters {
            StudyParameters::Grid(grid) => vec![LayerFound::default(); grid.layers.len()],
            StudyParameters::Tolerance(_) => Vec::new(),
        };
        StudyResults { request, layers, page: Vec::new(), part: 0.0, end: None }
    }

    /// Adds points to a layer.
    pub(crate) fn add(&mut self, layer: usize, found: LayerFound) {
        if let Some(known) = self.layers.get_mut(layer) {
            known.outcomes.extend(found.outcomes);
            known.values.extend(found.values);
            known.refusals = found.refusals;
        }
    }
}

/// The pane with the study that it shows.
#[derive(Debug, Clone)]
pub(crate) struct StudyPane<'a> {
    /// The state of the pane.
    pub(crate) state: &'a StudyState,
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
    let (about, width) = (below(pane, shown), usize::from(inner.width).saturating_sub(2));
    let (plot, words) = split(inner, text::wrap(&about, width).len());
    if pane.state.is_table {
        points::draw_table(pane, shown, grid, plot, buffer);
    } else {
        points::draw(pane, shown, grid, plot, buffer);
    }
    text::draw_words(&about, words, buffer);
}

/// The hint line while the pane has the focus.
#[must_use]
pub(crate) fn hint(pane: &StudyPane<'_>) -> String {
    let shown = pane.study.shown.as_ref();
    let shown = shown.filter(|_| pane.study.obstacle.is_none());
    match shown.map(|shown| &shown.request.parameters) {
        Some(StudyParameters::Grid(_)) => {
            format!("● present value, ▴ cursor, {NO_CONTACT} no contact, {REFUSED} refused point.")
        }
        Some(StudyParameters::Tolerance(_)) => {
            format!("{SAMPLES} samples draw every field of [spread] from its distribution.")
        }
        None => "The study varies a field over a range; r types the range.".to_owned(),
    }
}

/// The text of each varied field at the cursor, in the syntax of a case file.
#[must_use]
pub(crate) fn at_cursor(pane: &StudyPane<'_>) -> Vec<(usize, String)> {
    let shown = pane.study.shown.iter();
    let places = shown.flat_map(|shown| places(pane, shown));
    places.map(|(axis, at)| (axis.field, axis.with_unit(at))).collect()
}

/// The cursor after a move by points on the visible axes.
#[must_use]
pub(crate) fn moved(pane: &StudyPane<'_>, across: isize, up: isize) -> Option<(usize, usize)> {
    let shown = pane.study.shown.as_ref()?;
    let places = places(pane, shown);
    if pane.state.is_table && !places.is_empty() {
        let [width, height] =
            [0, 1].map(|at| places.get(at).map_or(1, |(axis, _)| axis.points.len()));
        let (x, y) = cursor(pane, shown);
        let next = (y * width + x).saturating_add_signed(across - up).min(width * height - 1);
        return Some((next % width, next / width));
    }
    let moved = places.into_iter().zip([across, up]).map(|((axis, at), by)| {
        at.saturating_add_signed(by).min(axis.points.len().saturating_sub(1))
    });
    let moved: Vec<usize> = moved.collect();
    Some((moved.first().copied()?, moved.get(1).copied().unwrap_or(0)))
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

/// The axes, the horizontal one first, each with the point of the cursor; without a cursor, with the
/// point of the present case.
fn places<'a>(pane: &StudyPane<'_>, shown: &'a StudyResults) -> Vec<(&'a StudyAxis, usize)> {
    let chosen = pane.study.cursor.map(|(x, y)| [x, y]);
    let axes = shown.request.parameters.axes().iter().rev().enumerate();
    let place = |(at, axis): (usize, &'a StudyAxis)| {
        let chosen = chosen.map(|chosen| chosen[at]);
        let point = chosen.or_else(|| range::nearest(axis, pane.case)).unwrap_or(0);
        (axis, point.min(axis.points.len().saturating_sub(1)))
    };
    axes.map(place).collect()
}

/// The point of the cursor on the horizontal and on the vertical axis.
fn cursor(pane: &StudyPane<'_>, shown: &StudyResults) -> (usize, usize) {
    let places = places(pane, shown);
    let at = |axis: usize| places.get(axis).map_or(0, |(_, at)| *at);
    (at(0), at(1))
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
    let page = Rect { x: inner.x + 1, width: inner.width.saturating_sub(2), ..inner };
    let lines: Vec<Line> = shown.page[top..].iter().map(|line| Line::raw(line.as_str())).collect();
    text::draw_lines(&lines, page, buffer);
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
    let Some(shown) = shown.filter(|shown| shown.quantity().is_some()) else {
        return "Study".to_owned();
    };
    let state = progress(shown);
    let words = match &shown.request.parameters {
        StudyParameters::Tolerance(_) => format!("Tolerance{}{state}", position(pane, shown)),
        StudyParameters::Grid(grid) => {
            let chart = points::chart(pane, shown, grid);
            format!(
                "Study{state}: {}",
                chart.map_or_else(String::new, |(chart, _)| chart.quantities())
            )
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

/// The text below the plot: why the study failed, the values at the cursor, the refused points.
fn below(pane: &StudyPane<'_>, shown: &StudyResults) -> String {
    let failed = match &shown.end {
        Some(End::Failed(reason)) => Some(reason.clone()),
        _ => None,
    };
    let parts = [failed, Some(values_at_cursor(pane, shown)), refused(shown)];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    symbol(&parts.join(". "), pane.look.ascii).into_owned()
}

/// The varied values at the cursor, and the value of each curve.
fn values_at_cursor(pane: &StudyPane<'_>, shown: &StudyResults) -> String {
    let StudyParameters::Grid(grid) = &shown.request.parameters else {
        return String::new();
    };
    let places = places(pane, shown);
    let settings = places.iter().map(|(axis, at)| {
        let known = &FIELDS[axis.field];
        let name = if known.symbol.is_empty() { known.label } else { known.symbol };
        format!("{name} = {}", axis.with_unit(*at))
    });
    let settings: Vec<String> = settings.collect();
    let index = places.iter().rev().fold(0, |index, (axis, at)| index * axis.points.len() + at);
    let layers = grid.layers.iter().zip(&shown.layers);
    let value = |(layer, found): (&Layer, &LayerFound)| {
        let words = value_words(layer, found, index, pane.units, true)?;
        Some(format!("{} {words}", layer.name()))
    };
    let values: Vec<String> = layers.filter_map(value).collect();
    format!("{}: {}", settings.join(", "), values.join(", "))
}

/// The value of a point, or why there is none; with the symbol and unit of the quantity.
fn value_words(
    layer: &Layer,
    found: &LayerFound,
    at: usize,
    units: System,
    has_name: bool,
) -> Option<String> {
    let known = layer.quantity()?;
    Some(match (found.outcomes.get(at)?, found.values.get(at)?) {
        (_, Some(value)) if has_name => {
            format!("{} {}", known.symbol_in(layer.inputs.method), shown_in(known, *value, units))
        }
        (_, Some(value)) => {
            let unit = common_unit(known, found.values.iter().flatten().copied(), units);
            shown_with(known, *value, unit).number
        }
        (PointOutcome::Refused, None) => "refused".to_owned(),
        (PointOutcome::Solved(Outcome::NoCornerContact), None) => "no contact".to_owned(),
        (PointOutcome::Solved(_), None) => "no value".to_owned(),
    })
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
