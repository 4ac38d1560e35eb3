//! The study pane: a result over the range of a field, a map over two fields, the points of both as a
//! table, or the tolerance of the case.

pub(crate) mod range;

use std::mem::discriminant;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;
use ratatui::symbols::Marker;

use super::chart::curves::sign_of;
use super::plot::{Look as SeriesLook, NO_CONTACT, REFUSED, TerminalChart};
use crate::case::units::{self, System};
use crate::case::{Case, FIELDS};
use crate::model::explanation::tidy;
use crate::model::{Inputs, Outcome, Quantity};
use crate::report::chart::{Axis, Cell as MapCell, Chart, Kind, Labels, Point, Series, Span};
use crate::report::charts::pieces;
use crate::report::swept::{map_chart, with_marks};
use crate::report::table::{Cell, Column, Table};
use crate::report::verdict::Absence;
use crate::report::{self, common_unit, name_of, shown_in, shown_with};
use crate::study::axis::{ADDED, Axis as StudyAxis, AxisPoint, add_by_sign};
use crate::study::batch::{self, PointOutcome, Refusals, Refused, Row};
use crate::study::tolerance::usual_samples;
use crate::tui::app::App;
use crate::tui::layout::Pane;
use crate::tui::text::{self, symbol};

/// Significant digits of the values of a varied field.
const DIGITS: usize = 5;
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
pub(crate) struct StudyState {
    /// Whether the pane shows the tolerance.
    pub(crate) is_tolerance: bool,
    /// Whether the pane shows the points as a table.
    pub(crate) is_table: bool,
    /// The chosen field; otherwise the field that had the focus when the pane opened.
    pub(crate) field: Option<usize>,
    /// The focused field when the pane opened.
    pub(crate) opened: Option<usize>,
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
    /// The typed number of samples of the tolerance.
    pub(crate) samples: Option<usize>,
}

impl StudyState {
    /// The number of samples of the tolerance.
    pub(crate) fn samples(&self, inputs: &Inputs) -> usize {
        self.samples.unwrap_or_else(|| usual_samples(inputs))
    }
}

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
    /// The number of samples.
    pub(crate) samples: usize,
    /// The display units.
    pub(crate) units: System,
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
#[derive(Debug, Clone, PartialEq)]
pub struct LayerFound {
    /// The layer.
    pub(crate) layer: Layer,
    /// The results of each point.
    pub rows: Vec<Row>,
    /// The refused points.
    pub(crate) refusals: Refusals,
}

/// The study of an open case.
#[derive(Debug, Clone, Default)]
pub struct Study {
    /// What the user chose to see.
    pub(crate) state: StudyState,
    /// Whether the case opened beside the pane, so that no study starts before the pane has the focus.
    pub(crate) waits: bool,
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
    /// The points of each layer; of a tolerance, those of all samples once they are solved.
    pub layers: Vec<LayerFound>,
    /// Whether base pitch deviations add by their signs, see [`ADDED`].
    are_added: bool,
    /// The page of a tolerance study.
    pub page: Vec<String>,
    /// The solved part, and the remaining time in words, unless it is short.
    pub(crate) progress: (f64, String),
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

impl LayerFound {
    /// The name of the layer with the symbol of its quantity.
    fn title(&self) -> Option<String> {
        let symbol = self.layer.quantity()?.symbol_in(self.layer.inputs.method);
        Some(format!("{} {symbol}", self.layer.name()))
    }

    /// No points of a layer yet.
    pub(crate) fn of(layer: &Layer) -> LayerFound {
        LayerFound { layer: layer.clone(), rows: Vec::new(), refusals: Refusals::default() }
    }

    /// How each point ended, and its value in SI.
    pub fn points(&self) -> impl Iterator<Item = (PointOutcome, Option<f64>)> {
        (0..).map_while(|at| self.point(at))
    }

    /// How a point ended, and its value in SI.
    fn point(&self, at: usize) -> Option<(PointOutcome, Option<f64>)> {
        self.rows.get(at).map(|row| (row.outcome, row.values.first().copied().flatten()))
    }

    /// The values in SI.
    fn values(&self) -> impl Iterator<Item = f64> {
        self.points().filter_map(|(_, value)| value)
    }

    /// The unit for all values of the layer.
    fn unit(&self, units: System) -> Option<&'static str> {
        Some(common_unit(self.layer.quantity()?, self.values(), units))
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
        // A curve is no earlier state of a tolerance.
        let kind = |request: &StudyRequest| discriminant(&request.parameters);
        self.shown.take_if(|shown| kind(&shown.request) != kind(&request));
        self.request = Some(request);
    }

    /// The key of the quantity of the last tolerance.
    pub(crate) fn sampled(&self) -> Option<&'static str> {
        let shown = self.shown.as_ref().map(|shown| &shown.request);
        match &self.request.as_ref().or(shown)?.parameters {
            StudyParameters::Tolerance(of) => Some(of.quantity),
            StudyParameters::Grid(_) => None,
        }
    }

    /// The results of the present request.
    pub(crate) fn results(&mut self) -> Option<&mut StudyResults> {
        if !self.is_shown() {
            self.shown = Some(StudyResults::of(self.request.clone()?));
        }
        self.shown.as_mut()
    }

    /// The curves of the present request, with the points that are solved.
    pub(crate) fn curves(&self) -> Vec<LayerFound> {
        let shown = self.shown.as_ref().filter(|_| self.is_shown());
        let unsolved = || Some(StudyResults::of(self.request.clone()?).layers);
        shown.map(|shown| shown.layers.clone()).or_else(unsolved).unwrap_or_default()
    }

    /// Whether the present request has ended.
    pub(crate) fn is_over(&self) -> bool {
        self.is_shown() && self.shown.as_ref().is_some_and(|shown| shown.end.is_some())
    }

    /// Whether the visible results are those of an earlier case, field or quantity.
    fn is_stale(&self) -> bool {
        let shown = self.shown.as_ref().map(|shown| &shown.request.parameters);
        shown.is_some() && shown != self.request.as_ref().map(|request| &request.parameters)
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
        self.layers.first()?.layer.quantity()
    }

    /// The axes of a curve or a map.
    fn axes(&self) -> &[StudyAxis] {
        self.request.parameters.axes()
    }

    /// The number of points of a curve or a map.
    fn count(&self) -> usize {
        self.axes().iter().map(|axis| axis.points.len()).product()
    }

    fn of(request: StudyRequest) -> StudyResults {
        let layers: Vec<LayerFound> = match &request.parameters {
            StudyParameters::Grid(grid) => grid.layers.iter().map(LayerFound::of).collect(),
            StudyParameters::Tolerance(of) => vec![LayerFound::of(&Layer {
                is_baseline: false,
                inputs: of.inputs.clone(),
                quantity: of.quantity,
            })],
        };
        let is_added =
            |found: &LayerFound| add_by_sign(request.parameters.axes(), &found.layer.inputs);
        let are_added = layers.first().is_some_and(is_added);
        let (page, progress, end) = (Vec::new(), Default::default(), None);
        StudyResults { request, layers, are_added, page, progress, end }
    }

    /// Adds points to a layer.
    pub(crate) fn add(&mut self, layer: usize, found: LayerFound, progress: (f64, String)) {
        self.progress = progress;
        if let Some(known) = self.layers.get_mut(layer) {
            known.rows.extend(found.rows);
            known.refusals = found.refusals;
        }
    }
}

/// The number of points of a map in a pane with an area, horizontally and vertically.
pub(crate) fn map_points(area: Rect) -> (usize, usize) {
    let across = area.width.saturating_sub(MAP_MARGIN.0).clamp(2, MOST_CELLS.0);
    let up = area.height.saturating_sub(MAP_MARGIN.1).clamp(2, MOST_CELLS.1);
    (across.into(), up.into())
}

/// Draws the pane.
pub(crate) fn draw(app: &App, buffer: &mut Buffer) {
    let inner = app.draw_title(Pane::Study, &title(app), buffer);
    if inner.is_empty() {
        return;
    }
    if let Some(obstacle) = &app.tab.study.obstacle {
        return text::draw_words(obstacle, inner, buffer);
    }
    let Some(shown) = &app.tab.study.shown else {
        return text::draw_words("Computing.", inner, buffer);
    };
    if let StudyParameters::Tolerance(_) = shown.request.parameters {
        return draw_page(app, shown, inner, buffer);
    }
    let (about, width) = (below(app, shown), usize::from(inner.width).saturating_sub(2));
    let (plot, words) = split(inner, text::wrap(&about, width).len());
    if app.tab.study.state.is_table {
        draw_table(app, shown, plot, buffer);
    } else {
        draw_points(app, shown, plot, buffer);
    }
    text::draw_words(&about, words, buffer);
}

/// The hint line while the pane has the focus.
pub(crate) fn hint(app: &App) -> String {
    let Study { shown, obstacle, .. } = &app.tab.study;
    if app.tab.study.state.is_tolerance {
        let count = app.tab.study.state.samples(&app.tab.inputs_so_far);
        format!("{count} samples draw every field of [spread] from its distribution.")
    } else if let (Some(shown), None) = (shown, obstacle) {
        refused(shown).unwrap_or_else(|| {
            let none = shown.layers.first().map_or("no contact", |found| missing(app, found));
            format!("● present value, ▴ cursor, {NO_CONTACT} {none}, {REFUSED} refused point.")
        })
    } else {
        "The study varies a field over a range; r types the range.".to_owned()
    }
}

/// The text of each varied field at the cursor, in the syntax of a case file.
pub(crate) fn at_cursor(app: &App) -> Vec<(usize, String)> {
    let shown = app.tab.study.shown.iter();
    let places = shown.flat_map(|shown| places(app, shown));
    places.map(|(axis, at)| (axis.field, axis.with_unit(at))).collect()
}

/// The cursor after a move by points on the visible axes.
pub(crate) fn moved(app: &App, across: isize, up: isize) -> Option<(usize, usize)> {
    let shown = app.tab.study.shown.as_ref()?;
    let places = places(app, shown);
    if app.tab.study.state.is_table && !places.is_empty() {
        let [width, height] =
            [0, 1].map(|at| places.get(at).map_or(1, |(axis, _)| axis.points.len()));
        let (x, y) = cursor(app, shown);
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
pub(crate) fn scrolled(app: &App, by: isize) -> usize {
    let Some(shown) = &app.tab.study.shown else {
        return 0;
    };
    let last = shown.page.len().saturating_sub(page_height(app));
    top(app, shown).saturating_add_signed(by).min(last)
}

/// The first visible line after scrolling by pages, which overlap by one line.
pub(crate) fn paged(app: &App, by: isize) -> usize {
    let page = page_height(app).saturating_sub(1).max(1);
    scrolled(app, by * isize::try_from(page).unwrap_or(1))
}

/// The axes, the horizontal one first, each with the point of the cursor; without a cursor, with the
/// point of the present case.
fn places<'a>(app: &App, shown: &'a StudyResults) -> Vec<(&'a StudyAxis, usize)> {
    let chosen = app.tab.study.cursor.map(|(x, y)| [x, y]);
    let axes = shown.axes().iter().rev().enumerate();
    let place = |(at, axis): (usize, &'a StudyAxis)| {
        let chosen = chosen.map(|chosen| chosen[at]);
        let point = chosen.or_else(|| range::nearest(axis, &app.tab.case)).unwrap_or(0);
        (axis, point.min(axis.points.len().saturating_sub(1)))
    };
    axes.map(place).collect()
}

/// The point of the cursor on the horizontal and on the vertical axis.
fn cursor(app: &App, shown: &StudyResults) -> (usize, usize) {
    let places = places(app, shown);
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
fn draw_page(app: &App, shown: &StudyResults, inner: Rect, buffer: &mut Buffer) {
    if shown.page.is_empty() {
        let words = match &shown.end {
            Some(End::Failed(reason)) => reason.as_str(),
            Some(End::Stopped) => "Stopped before the first samples.",
            Some(End::Whole) | None => "Sampling.",
        };
        return text::draw_words(words, inner, buffer);
    }
    let top = top(app, shown);
    let page = Rect { x: inner.x + 1, width: inner.width.saturating_sub(2), ..inner };
    let width = usize::from(page.width);
    // A title, a bar of a histogram and a row of a table are lines of different kinds.
    let kind = |line: &String| (line.starts_with(' '), line.contains('|'));
    let blocks = shown.page.chunk_by(|line, next| kind(line) == kind(next));
    let lines = blocks.flat_map(|block| narrowed(block, width)).skip(top);
    text::draw_lines(lines, page, buffer);
    text::scroll_bar_beside(top, shown.page.len(), page, buffer);
}

/// The rows of a table; too wide a table has single blanks between its columns.
fn narrowed(rows: &[String], width: usize) -> Vec<String> {
    if rows.iter().all(|row| text::width(row) <= width) {
        return rows.to_vec();
    }
    let is_blank =
        |at: usize| rows.iter().all(|row| row.chars().nth(at).is_none_or(|it| it == ' '));
    let column = |at: &usize| *at == 0 || !is_blank(*at) || !is_blank(*at - 1);
    let narrow = |row: &String| {
        let kept = row.chars().enumerate().filter(|(at, _)| column(at)).map(|(_, it)| it);
        text::cut(&kept.collect::<String>(), width)
    };
    rows.iter().map(narrow).collect()
}

/// The number of lines of the tolerance that fit.
fn page_height(app: &App) -> usize {
    usize::from(app.area(Pane::Study).height.saturating_sub(1))
}

/// The first visible line of the tolerance.
fn top(app: &App, shown: &StudyResults) -> usize {
    let last = shown.page.len().saturating_sub(page_height(app));
    app.tab.study.state.top.min(last)
}

fn title(app: &App) -> String {
    let shown = app.tab.study.shown.as_ref().filter(|_| app.tab.study.obstacle.is_none());
    let Some(shown) = shown.filter(|shown| shown.quantity().is_some()) else {
        return if app.tab.study.state.is_tolerance { "Tolerance" } else { "Study" }.to_owned();
    };
    let state = progress(shown);
    let words = match &shown.request.parameters {
        StudyParameters::Tolerance(_) => format!("Tolerance{}{state}", position(app, shown)),
        StudyParameters::Grid(_) => {
            let chart = chart(app, shown);
            // The legend of a map has the names of its axes.
            let words = chart.map(|(chart, _)| match &chart.map {
                Some(map) => map.value.in_unit(),
                None => chart.quantities(),
            });
            format!("Study{state}: {}", words.unwrap_or_default())
        }
    };
    let outdated =
        if app.tab.study.is_stale() { "OUTDATED, the new result is computed: " } else { "" };
    symbol(&format!("{outdated}{words}"), app.look.ascii).into_owned()
}

/// The visible lines of a tolerance, if some do not fit.
fn position(app: &App, shown: &StudyResults) -> String {
    let (lines, height) = (shown.page.len(), page_height(app));
    if lines <= height {
        return String::new();
    }
    let top = top(app, shown);
    format!(" {} to {} of {lines}", top + 1, (top + height).min(lines))
}

/// The progress of an unfinished study.
fn progress(shown: &StudyResults) -> String {
    let (part, left) = &shown.progress;
    match &shown.end {
        Some(End::Whole) => String::new(),
        Some(End::Stopped) => ", stopped".to_owned(),
        Some(End::Failed(_)) => ", failed".to_owned(),
        None => format!(", {:.0} % solved{left}", 100.0 * part),
    }
}

/// The text below the plot: why the study failed, the values at the cursor.
fn below(app: &App, shown: &StudyResults) -> String {
    let failed = match &shown.end {
        Some(End::Failed(reason)) => Some(reason.clone()),
        _ => None,
    };
    let absent = shown.layers.first().and_then(|found| absence(app, found));
    let absent = absent.map(|absence| format!("No value: {absence}"));
    let added = shown.are_added.then(|| ADDED.to_owned());
    let parts = [failed, absent, added, Some(values_at_cursor(app, shown))];
    let parts: Vec<String> = parts.into_iter().flatten().collect();
    symbol(&parts.join(". "), app.look.ascii).into_owned()
}

/// The varied values at the cursor, and the value of each curve.
fn values_at_cursor(app: &App, shown: &StudyResults) -> String {
    let places = places(app, shown);
    let settings = places.iter().map(|(axis, at)| {
        let known = &FIELDS[axis.field];
        let name = if known.symbol.is_empty() { known.label } else { known.symbol };
        format!("{name} = {}", batch::with_unit(&short(axis, *at), &axis.unit))
    });
    let settings: Vec<String> = settings.collect();
    let index = places.iter().rev().fold(0, |index, (axis, at)| index * axis.points.len() + at);
    let value = |found: &LayerFound| {
        let words = value_words(app, found, index, true)?;
        Some(format!("{} {words}", found.layer.name()))
    };
    let values: Vec<String> = shown.layers.iter().filter_map(value).collect();
    format!("{}: {}", settings.join(", "), values.join(", "))
}

/// Why no point of a curve has a value, if the reason is not missing contact.
fn absence(app: &App, found: &LayerFound) -> Option<Absence> {
    let known = found.layer.quantity().filter(|_| found.values().next().is_none())?;
    let absence = Absence::of(known, app.tab.solution()?);
    let is_contact = matches!(absence, Absence::NoContact(..) | Absence::NoExit);
    Some(absence).filter(|_| !is_contact)
}

/// Why points without corner contact have no value, in two words.
fn missing(app: &App, found: &LayerFound) -> &'static str {
    if absence(app, found).is_none() { "no contact" } else { "no value" }
}

/// The value of a point, with its unit if wanted, or why there is none.
fn value_words(app: &App, found: &LayerFound, at: usize, has_unit: bool) -> Option<String> {
    let (known, units) = (found.layer.quantity()?, app.settings.units);
    Some(match found.point(at)? {
        (_, Some(value)) if has_unit => shown_in(known, value, units).to_string(),
        (_, Some(value)) => shown_with(known, value, found.unit(units)?).number,
        (PointOutcome::Refused, None) => "refused".to_owned(),
        (PointOutcome::Solved(Outcome::NoCornerContact), None) => missing(app, found).to_owned(),
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

/// Least width of the labels beside a map.
const LABELS: u16 = 7;

/// Draws the curves or the map, with the limit, the present value and the cursor.
fn draw_points(app: &App, shown: &StudyResults, area: Rect, buffer: &mut Buffer) {
    let Some((chart, looks)) = chart(app, shown) else { return };
    let (theme, is_map) = (app.look.theme, chart.map.is_some());
    let words = if is_map {
        // The unit of x is below the corner of the axes.
        let axes = [format!("x: {}", chart.across.name), format!("y: {}", chart.up.in_unit())];
        axes.map(|words| (words, Style::new())).to_vec()
    } else {
        vec![("▴ cursor".to_owned(), theme.focus)]
    };
    let margin = if is_map { LABELS } else { 0 };
    let spans = match shown.axes() {
        [axis] => (chart.spans().0.and(ends(axis)), chart.spans().1),
        _ => chart.spans(),
    };
    let drawn = TerminalChart { chart: &chart, looks, words, is_compared: false, theme };
    let plot = drawn.draw(area, spans, margin, buffer);
    let (at, row) = cursor(app, shown);
    match shown.axes() {
        _ if plot.cells.is_empty() => (),
        [axis] => {
            let limit =
                app.tab.case.limits.iter().find(|limit| shown.quantity() == Some(limit.quantity));
            if let Some(limit) = limit.filter(|limit| limit.of.is_none()) {
                let factor = units::factor(&chart.up.unit).unwrap_or(1.0);
                plot.draw_level(limit.value / factor, "╌", theme.rule, buffer);
            }
            if let Some(present) = present(app, axis) {
                plot.draw_upright(present, "│", theme.faint, buffer);
            }
            plot.draw_cursor(x(axis, at), theme, buffer);
        }
        _ => plot.draw_cursor_at((at as f64, row as f64), theme, buffer),
    }
}

/// The chart of the shown points as a picture.
pub(crate) fn picture(app: &App) -> Option<Chart> {
    let shown = app.tab.study.shown.as_ref().filter(|_| app.tab.study.obstacle.is_none())?;
    let (known, (mut chart, _)) = (shown.quantity()?, chart(app, shown)?);
    let (label, is_map) = (known.label.trim(), chart.map.is_some());
    if !is_map {
        chart.title = format!("{label} over {}", chart.across.name);
        chart.up.name = name_of(known);
        chart.series.retain(|series| series.kind == Kind::Curve && !series.pieces.is_empty());
        if let [only] = &mut chart.series[..] {
            only.name = name_of(known);
        }
        with_marks(&mut chart.series);
    }
    (is_map || !chart.series.is_empty()).then_some(chart)
}

/// The curves or the map of the points, with their looks.
fn chart(app: &App, shown: &StudyResults) -> Option<(Chart, Vec<SeriesLook>)> {
    match shown.axes() {
        [axis] => curves(app, shown, axis),
        [up, across] => map(app, shown, (across, up)),
        _ => None,
    }
}

/// The methods over each other, the active one on top and the baseline behind them, the present
/// value, and signs where the active method has no value.
fn curves(app: &App, shown: &StudyResults, axis: &StudyAxis) -> Option<(Chart, Vec<SeriesLook>)> {
    let (theme, known) = (app.look.theme, shown.quantity()?);
    let all = shown.layers.iter().flat_map(LayerFound::values);
    let unit = common_unit(known, all, app.settings.units);
    let factor = units::factor(unit).unwrap_or(1.0);
    let is_joined = axis.points.iter().all(|point| point.number.is_some());
    let longest = if is_joined { f64::INFINITY } else { 0.0 };
    let mut series: Vec<(Series, SeriesLook)> = Vec::new();
    for (at, found) in shown.layers.iter().enumerate() {
        let layer = &found.layer;
        let points = found.points().enumerate();
        let points =
            points.map(|(at, (_, value))| (x(axis, at), value.map(|value| value / factor)));
        let pieces = pieces(points, longest);
        let look = match (at, layer.is_baseline) {
            (0, _) => (app.settings.marker, theme.active),
            (_, true) => (Marker::Custom('+'), theme.baseline),
            (_, false) => (sign_of(layer.inputs.method), theme.other),
        };
        if at == 0 || !pieces.is_empty() {
            series.push((Series { name: found.title()?, pieces, kind: Kind::Curve }, look));
        }
    }
    let mut mark = |name: &str, points: Vec<Point>, look: (char, _)| {
        let pieces = points.into_iter().map(|point| vec![point]).collect();
        let series_of = Series { name: name.to_owned(), pieces, kind: Kind::Marks(None) };
        series.push((series_of, (Marker::Custom(look.0), look.1)));
    };
    let now = present(app, axis);
    // A quantity that only the study computes has its present value at the point of the case.
    let of_point = || {
        let at = range::nearest(axis, &app.tab.case)?;
        let is_present = (x(axis, at) - now?).abs() <= range::SAME * now?.abs();
        shown.layers.first()?.point(at)?.1.filter(|_| is_present)
    };
    let now =
        now.zip(present_value(app, shown).or_else(of_point)).map(|(x, value)| (x, value / factor));
    let now = now.filter(|now| ends(axis).covers(Span::new(now.0, now.0)));
    if let Some(now) = now {
        mark("now", vec![now], ('●', theme.focus));
    }
    let own = shown.layers.first()?;
    let none = missing(app, own);
    for (sought, sign, name) in [
        (PointOutcome::Solved(Outcome::NoCornerContact), NO_CONTACT, none),
        (PointOutcome::Refused, REFUSED, "refused"),
    ] {
        let points = own.points().enumerate();
        let points = points.filter(|(_, (outcome, value))| *outcome == sought && value.is_none());
        // Below every value: at the axis.
        let points: Vec<Point> = points.map(|(at, _)| (x(axis, at), f64::NEG_INFINITY)).collect();
        if !points.is_empty() {
            mark(name, points, (sign, theme.note));
        }
    }
    let step = if is_joined { (axis.points.len() - 1).div_ceil(4).max(1) } else { 1 };
    let names = (0..axis.points.len()).step_by(step).map(|at| (x(axis, at), short(axis, at)));
    let has_ticks = is_joined && !axis.is_log;
    let labels = if has_ticks { Labels::new() } else { names.collect() };
    let (series, looks) = series.into_iter().unzip();
    let across = Axis { labels, ..field_axis(axis) };
    Some((Chart { across, up: up_axis(shown, unit), series, ..Chart::default() }, looks))
}

/// The cells of a map, by the indices of its points.
fn map(
    app: &App,
    shown: &StudyResults,
    (across, up): (&StudyAxis, &StudyAxis),
) -> Option<(Chart, Vec<SeriesLook>)> {
    let (theme, known, found) = (app.look.theme, shown.quantity()?, shown.layers.first()?);
    let unit = common_unit(known, found.values(), app.settings.units);
    let is_contact = absence(app, found).is_none();
    let cell = |point| match point {
        (PointOutcome::Refused, _) => MapCell::Refused,
        (_, Some(value)) => MapCell::Value(value),
        (PointOutcome::Solved(Outcome::NoCornerContact), None) if is_contact => MapCell::NoContact,
        (PointOutcome::Solved(_), None) => MapCell::Blank,
    };
    let limit = app.tab.case.limits.iter().find(|limit| limit.quantity == known);
    let limit = limit.and_then(|limit| limit.bound(|_| None)).filter(|value| value.is_finite());
    let axes = [across, up]
        .map(|axis| (field_axis(axis), (0..axis.points.len()).map(|at| short(axis, at)).collect()));
    let now = place_of_present(app, across).zip(place_of_present(app, up));
    let now = now.map(|place| vec![place]).into_iter().collect();
    let mut chart = map_chart(known, axes, found.points().map(cell).collect(), unit);
    chart.series.push(Series { name: "now".to_owned(), pieces: now, kind: Kind::Marks(None) });
    if let Some(map) = &mut chart.map {
        map.value = up_axis(shown, unit);
        map.limit = limit.map(|limit| (limit, format!("limit {}", shown_with(known, limit, unit))));
    }
    Some((chart, vec![(Marker::Custom('●'), theme.focus)]))
}

/// The axis of the values.
fn up_axis(shown: &StudyResults, unit: &str) -> Axis {
    let layer = shown.layers.first().map(|found| &found.layer);
    let symbol = layer
        .and_then(|layer| Some(layer.quantity()?.symbol_in(layer.inputs.method)))
        .unwrap_or("");
    Axis::new(symbol, unit)
}

/// The axis of a field without labels.
fn field_axis(axis: &StudyAxis) -> Axis {
    Axis::new(FIELDS[axis.field].full_label(), axis.unit.clone())
}

/// The value of the shown quantity in the present case, in SI.
fn present_value(app: &App, shown: &StudyResults) -> Option<f64> {
    report::value(shown.quantity()?, app.tab.present()?)
}

/// The position of the present case on an axis.
fn present(app: &App, axis: &StudyAxis) -> Option<f64> {
    let nearest = || range::nearest(axis, &app.tab.case).map(|at| x(axis, at));
    range::present(axis, &app.tab.case).map(|number| scaled(axis, number)).or_else(nearest)
}

/// The index of the point at the present case, or a fraction between those around it.
fn place_of_present(app: &App, axis: &StudyAxis) -> Option<f64> {
    let now = present(app, axis)?;
    let part = |at: usize| {
        let [from, to] = [at, at + 1].map(|at| x(axis, at));
        (now - from) / (to - from)
    };
    let mut pieces = (0..axis.points.len().saturating_sub(1)).map(|at| (at as f64, part(at)));
    pieces
        .find(|(_, part)| (-range::SAME..=1.0 + range::SAME).contains(part))
        .map(|(at, part)| at + part)
}

/// The text of a point with the digits of a result.
fn short(axis: &StudyAxis, at: usize) -> String {
    let AxisPoint { text, number, .. } = &axis.points[at];
    number.map_or_else(|| text.clone(), |number| tidy(number, DIGITS))
}

/// The position of a point on the axis: its number or the logarithm, or the index of a choice.
fn x(axis: &StudyAxis, at: usize) -> f64 {
    let number = axis.points.get(at).and_then(|point| point.number);
    number.map_or(at as f64, |number| scaled(axis, number))
}

/// The position of a number on the axis.
fn scaled(axis: &StudyAxis, number: f64) -> f64 {
    if axis.is_log { number.log10() } else { number }
}

fn ends(axis: &StudyAxis) -> Span {
    Span::NONE.with(x(axis, 0)).with(x(axis, axis.points.len().saturating_sub(1)))
}

/// Draws the points as a table: the varied fields, then each curve.
fn draw_table(app: &App, shown: &StudyResults, area: Rect, buffer: &mut Buffer) {
    let (axes, layers) = (shown.axes(), &shown.layers);
    let (width, (x, y)) = (axes.last().map_or(1, |axis| axis.points.len()), cursor(app, shown));
    let count = shown.count();
    let (marked, rows) = (y * width + x, usize::from(area.height.saturating_sub(1)));
    let top = marked.saturating_sub(rows / 2).min(count.saturating_sub(rows));
    let lines = |layers: &[LayerFound], is_short: bool| {
        let curves = layers
            .iter()
            .filter_map(|found| Some(Axis::new(found.title()?, found.unit(app.settings.units)?)));
        let field = |axis: &StudyAxis| match FIELDS[axis.field].symbol {
            symbol if is_short && !symbol.is_empty() => Axis::new(symbol, axis.unit.clone()),
            _ => field_axis(axis),
        };
        let column = |name: Axis| {
            let title = symbol(&name.in_unit(), app.look.ascii).into_owned();
            Column::text("", title).to_the_right().wide(2, 0)
        };
        let columns = axes.iter().map(field).chain(curves).map(column).collect();
        let row = |at: usize| {
            let places = [at / width, at % width];
            let axes = axes.iter().zip(&places[2 - axes.len()..]);
            let fields = axes.map(|(axis, at)| short(axis, *at));
            let values =
                layers.iter().map(|found| value_words(app, found, at, false).unwrap_or_default());
            fields.chain(values).map(Cell::from).collect()
        };
        Table::new("", columns).with((top..count.min(top + rows)).map(row)).lines()
    };
    // Short names of the fields, then fewer curves, where the pane is too narrow.
    let fits =
        |lines: &Vec<String>| lines.iter().all(|line| text::width(line) <= usize::from(area.width));
    let counts = (1..=layers.len()).rev().map(|count| (count, true));
    let mut forms = [(layers.len(), false)].into_iter().chain(counts);
    let lines = forms.find_map(|(count, is_short)| {
        let lines = lines(&layers[..count], is_short);
        (count == 1 && is_short || fits(&lines)).then_some(lines)
    });
    let lines = lines.unwrap_or_default();
    super::draw_table(&lines, Some(marked - top), app.look.theme, area, buffer);
}
