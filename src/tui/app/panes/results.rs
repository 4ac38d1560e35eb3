//! The results pane: faults, verdict, limits, figures and notes as sentences above the table of
//! quantities, with the methods or the variants side by side, marks of changes and limits, and the
//! difference from the baseline.

use std::borrow::Cow;
use std::collections::BTreeSet;

use ratatui::buffer::Buffer;
use ratatui::layout::Constraint::{Fill, Length};
use ratatui::layout::{Layout, Position, Rect};
use ratatui::style::Style;
use ratatui::text::Line;

use crate::case::fields::index_of;
use crate::case::sanitize::sanitize;
use crate::case::units::named;
use crate::case::{Case, FIELDS, changes};
use crate::model::inputs::Method;
use crate::model::quantities::Need;
use crate::model::{QUANTITIES, Quantity, Solution, Stage, Stages};
use crate::report::compare::{self, difference};
use crate::report::digest::{self, Remarks};
use crate::report::trade::duration;
use crate::report::verdict::{Beside, Standing, Verdict, verdict, verdicts};
use crate::report::{self, value_as_in};
use crate::tui::app::App;
use crate::tui::layout::{NEXT_FAULT, Pane};
use crate::tui::rows;
use crate::tui::session;
use crate::tui::solver::{Answer, Baseline, Variants};
use crate::tui::text::{self, symbol};

/// Number of quantities that stay visible below the sentences; at most two thirds of the lines.
const LEAST_ROWS: usize = 12;

/// The state of the pane, separate for each open case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ResultsState {
    /// The key of the selected quantity. While the results do not have it, the first one is
    /// selected.
    pub selected: Option<&'static str>,
    /// The first visible line of the quantities.
    pub top: usize,
}

impl App {
    /// The visible quantities; beside variants their required relief is first.
    pub fn listed_results(&self) -> Vec<&'static Quantity> {
        let order = |answer| order(answer, self.shows_every_method);
        let mut listed = self.shown_answer().map_or_else(Vec::new, order);
        if self.shown_variants().is_some() {
            listed.sort_by_key(|quantity| quantity.stage != Stage::Clearing);
        }
        listed
    }

    /// The selected line among the quantities.
    fn result_row(&self) -> usize {
        let Some(selected) = self.tab.results.selected else { return 0 };
        self.listed_results().iter().position(|quantity| quantity.key == selected).unwrap_or(0)
    }

    /// The selected quantity.
    pub fn marked_result(&self) -> Option<&'static Quantity> {
        self.listed_results().get(self.result_row()).copied()
    }

    /// The number of visible lines of the table.
    pub fn results_page(&self) -> usize {
        parts(self).1
    }

    /// The state with the selection `by` quantities further.
    pub(crate) fn stepped_result(&self, by: isize) -> ResultsState {
        let (listed, row) = (self.listed_results(), self.result_row().saturating_add_signed(by));
        let quantity = listed.get(row).or(listed.last());
        ResultsState { selected: quantity.map(|quantity| quantity.key), ..self.tab.results }
    }

    /// The state with selection and visible lines `by` quantities further.
    pub(crate) fn turned_results(&self, by: isize) -> ResultsState {
        ResultsState { top: self.scrolled_results(by), ..self.stepped_result(by) }
    }

    /// The first visible line after scrolling by lines downwards.
    pub(crate) fn scrolled_results(&self, by: isize) -> usize {
        let last = self.table_lines().saturating_sub(self.results_page());
        self.tab.results.top.saturating_add_signed(by).min(last)
    }

    /// The first visible line such that the selected quantity is visible.
    pub(crate) fn top_of_results(&self) -> usize {
        let row = inputs(self).len() + self.result_row();
        if row == 0 {
            return 0;
        }
        let rows = self.results_page().max(1);
        let least = (row + 1).saturating_sub(rows);
        if self.result_row() == 0 {
            return least;
        }
        let last = self.table_lines().saturating_sub(rows);
        self.tab.results.top.clamp(least, row.max(least)).min(last)
    }

    /// The key of the quantity at a cell, if any.
    pub(crate) fn result_at(&self, at: Position) -> Option<&'static str> {
        let (head, rows) = parts(self);
        let above = head.len() + 1 + usize::from(self.has_result_header());
        let line = usize::from(at.y - self.area(Pane::Results).y).checked_sub(above)?;
        let row = (self.tab.results.top + line).checked_sub(inputs(self).len())?;
        self.listed_results().get(row).filter(|_| line < rows).map(|quantity| quantity.key)
    }

    /// The number of inputs that differ between the variants, and of quantities below them.
    fn table_lines(&self) -> usize {
        inputs(self).len() + self.listed_results().len()
    }

    /// Whether the columns need names; otherwise the title names the only method.
    fn has_result_header(&self) -> bool {
        self.shows_every_method || self.shown_variants().is_some() || self.baseline.is_some()
    }

    /// The solved variants with the first visible one, if they are shown instead of the methods.
    fn shown_variants(&self) -> Option<(&Variants, usize)> {
        self.tab.variants.as_ref().zip(self.first_variant)
    }

    /// The results of the case: beside variants, by their method.
    fn shown_answer(&self) -> Option<&Answer> {
        let shown = self.shown_variants().filter(|(found, _)| found.serial == self.tab.serial);
        let beside = shown.and_then(|(variants, _)| variants.case.as_ref());
        beside.or(self.tab.answer.as_ref())
    }
}

pub(crate) fn draw(app: &App, buffer: &mut Buffer) {
    let (head, rows) = parts(app);
    let listed = app.listed_results();
    let count = inputs(app).len() + listed.len();
    let inner = app.draw_title(Pane::Results, &title(app, count, rows), buffer);
    let [above, body] = text::split(inner, head.len() as u16);
    // The first column has the mark of the selected row.
    let [_, above] = above.layout(&Layout::horizontal([Length(1), Fill(1)]));
    text::draw_lines(head, above, buffer);
    let Some(answer) = app.shown_answer() else { return };
    let theme = app.look.theme;
    let now = app.tab.answer.as_ref().map(|answer| answer.serial);
    let is_outdated =
        app.shown_variants().is_some_and(|(variants, _)| Some(variants.serial) != now);
    let base = if app.tab.is_stale() || is_outdated { theme.faint } else { Style::new() };
    let row = (inputs(app).len() + app.result_row()).checked_sub(app.tab.results.top);
    let columns = fitting(app, answer, &listed, rows);
    let cells = columns.first().map_or(0, |column| column.cells.len());
    let header = app.has_result_header().then_some(None);
    let usual: Vec<usize> = columns.iter().map(Column::width).collect();
    for (line, area) in header.into_iter().chain((0..cells).map(Some)).zip(body.rows()) {
        let is_marked = line.is_some() && row == line && app.has_focus(Pane::Results);
        text::paint(area, base, buffer);
        let mut at = text::put(if is_marked { "▸" } else { " " }, area, theme.focus, buffer);
        for (column, width) in columns.iter().zip(widths(&columns, usual.clone(), line)) {
            let (text, style) = match line {
                Some(line) => (&column.cells[line], column.styles[1]),
                None => (&column.heading, column.styles[0]),
            };
            let gap = if column.is_number { width.saturating_sub(text::width(text)) } else { 0 };
            let part = |from, width: usize| {
                Rect { x: area.x + from, width: width as u16, ..area }.intersection(area)
            };
            text::paint(part(at, width + 1), style, buffer);
            let text = text::cut(text, width - gap);
            text::put(&text, part(at + gap as u16, width - gap), style, buffer);
            at += width as u16 + 1;
        }
    }
}

/// The widths of the columns in a line, from those in other lines. A long unit cuts the name before it,
/// and otherwise moves the texts before it to the left.
fn widths(columns: &[Column], mut widths: Vec<usize>, line: Option<usize>) -> Vec<usize> {
    let unit = columns.iter().position(|column| column.is_unit);
    let Some((unit, line)) = unit.zip(line) else { return widths };
    let width = |at: usize| text::width(&columns[at].cells[line]);
    let mut over = width(unit).saturating_sub(widths[unit]);
    if over == 0 {
        return widths;
    }
    widths[unit] += over;
    let mut before: Vec<usize> = (0..unit).rev().collect();
    before.sort_by_key(|at| columns[*at].rank != NAMES);
    for at in before {
        let least = if columns[at].rank == NAMES { 0 } else { width(at) };
        let part = over.min(widths[at].saturating_sub(least));
        (widths[at], over) = (widths[at] - part, over - part);
    }
    widths
}

/// A sentence above the table.
struct Sentence {
    text: String,
    style: Style,
    place: Place,
}

/// Where a sentence is shown besides the page of notes.
#[derive(PartialEq, Eq)]
enum Place {
    /// Always; a long sentence ends after one of its clauses.
    Pane,
    /// Always; a long verdict loses remarks first.
    Verdict,
    /// If there is room, also for the sentences before it.
    Room,
    /// Nowhere else.
    Page,
}

/// The lines above the table, and the number of its lines that fit below them.
fn parts(app: &App) -> (Vec<Line<'static>>, usize) {
    let width = usize::from(app.area(Pane::Results).width.saturating_sub(1));
    let height = usize::from(app.area(Pane::Results).height.saturating_sub(1));
    let height = height.saturating_sub(usize::from(app.has_result_header()));
    let has_rows = app.tab.answer.is_some();
    let room = if has_rows { height - LEAST_ROWS.min(2 * height / 3) } else { height };
    let (mut head, mut has_more, mut is_cut) = (Vec::new(), false, false);
    for Sentence { text, style, place } in sentences(app) {
        let (mut lines, left) = (text::wrap(&text, width), room - head.len());
        // The last line names the page of the hidden sentences.
        let is_shown = match place {
            Place::Pane | Place::Verdict => left > 0,
            Place::Room => !has_more && lines.len() < left,
            Place::Page => false,
        };
        has_more |= !is_shown;
        if is_shown && lines.len() > left {
            (has_more, is_cut) = (true, true);
            // A key and its prefix stay in one line.
            let end = format!(" … ({}n)", app.leave().replace(' ', "\u{a0}"));
            let fewer = Remarks::FEWER.into_iter().filter(|_| place == Place::Verdict);
            let texts = [text].into_iter().chain(fewer.filter_map(|fewer| remarked(app, fewer)));
            lines = shortened(texts, &symbol(&end, app.look.ascii), width, left);
        }
        let lines = lines.into_iter().filter(|_| is_shown);
        head.extend(lines.map(|line| Line::styled(line.replace('\u{a0}', " "), style)));
    }
    let notes = (has_more && !is_cut).then(|| {
        let notes = match app.tab.answer.as_ref().map_or(0, |answer| answer.notes.len()) {
            0 => "more".to_owned(),
            1 => "1 note".to_owned(),
            count => format!("{count} notes"),
        };
        format!("{notes} ({}n)", app.leave())
    });
    let folded = app.tab.answer.as_ref().and_then(|answer| folded(app, answer));
    let last: Vec<String> = notes.into_iter().chain(folded).collect();
    if !last.is_empty() && head.len() < room {
        let last = text::cut(&last.join(", "), width);
        head.push(Line::styled(last, app.look.theme.note));
    }
    let rows = if has_rows { height.saturating_sub(head.len()) } else { 0 };
    (head, rows)
}

/// The first of some texts that has at most `rows` lines, otherwise the last one up to its last clause
/// that fits, unless that leaves more than one line.
fn shortened(
    texts: impl Iterator<Item = String>,
    end: &str,
    width: usize,
    rows: usize,
) -> Vec<String> {
    let wrapped = |text: &str| text::wrap(&format!("{text}{end}"), width);
    let mut text = String::new();
    let mut forms = texts.inspect(|next| text.clone_from(next)).map(|text| wrapped(&text));
    if let Some(lines) = forms.find(|lines| lines.len() <= rows) {
        return lines;
    }
    let mut ends = text.rmatch_indices([',', ';']).map(|(at, _)| wrapped(&text[..at]));
    let to_clause = ends.find(|lines| lines.len() <= rows).filter(|lines| lines.len() + 1 >= rows);
    to_clause.unwrap_or_else(|| to_word(text::wrap(&text, width), end, width, rows))
}

/// The first `rows` lines, the last one with as many words as fit before the end.
fn to_word(mut lines: Vec<String>, end: &str, width: usize, rows: usize) -> Vec<String> {
    lines.truncate(rows);
    if let Some(last) = lines.last_mut() {
        let room = width.saturating_sub(text::width(end));
        while text::width(last) > room {
            last.truncate(last.rfind(' ').unwrap_or(0));
        }
        last.push_str(end);
    }
    lines
}

/// The folded rows and columns, with the key that shows them.
fn folded(app: &App, answer: &Answer) -> Option<String> {
    let name = if answer.active.shares_load() { "free impact" } else { "other methods" };
    let is_folded = !app.shows_every_method && app.shown_variants().is_none();
    is_folded.then(|| format!("{name} ({}f)", app.leave()))
}

/// The verdict of the active method with some of its remarks.
fn remarked(app: &App, remarks: Remarks) -> Option<String> {
    let answer = app.tab.answer.as_ref()?;
    let is_pending = answer.strikes() && app.tab.lacks(Stage::Clearing);
    let solution = answer.of(answer.active)?;
    let verdict = digest::remarked(solution, app.settings.units, is_pending, remarks);
    Some(symbol(&format!("{}{verdict}", age(app, answer)), app.look.ascii).into_owned())
}

/// Every sentence in full, one per line: the page of notes.
pub(crate) fn in_full(app: &App) -> Vec<String> {
    sentences(app).into_iter().flat_map(|sentence| [sentence.text, String::new()]).collect()
}

/// Faults, symbols of the limits that are not met, verdict, these limits in full, figures, limits that
/// are met, and notes: the most important sentence first.
fn sentences(app: &App) -> Vec<Sentence> {
    let theme = app.look.theme;
    let mut all = Vec::new();
    let mut add = |text: String, style: Style, place: Place| {
        let text = symbol(&text, app.look.ascii).into_owned();
        all.push(Sentence { text, style, place });
    };
    let faults = faults(app);
    let has_fault = !faults.is_empty();
    for (fault, style) in faults.into_iter().zip([theme.problem, Style::new()]) {
        add(fault, style, Place::Pane);
    }
    let Some(answer) = &app.tab.answer else { return all };
    let fresh = |style: Style| if app.tab.is_stale() { theme.faint } else { style };
    if let Some(solution) = answer.of(answer.active) {
        let verdicts =
            if app.tab.is_stale() { Vec::new() } else { verdicts(&app.tab.case, solution) };
        let written = verdicts.iter().filter(|verdict| !verdict.limit.text.is_empty());
        let written = written.filter(|verdict| !app.tab.awaits(verdict));
        let (met, unmet): (Vec<_>, Vec<_>) = written.partition(|verdict| is_met(verdict));
        let limit = |verdict: &Verdict<'_>| {
            format!("Limit {}: {}.", verdict.standing.word(), verdict.sentence(app.settings.units))
        };
        let is_unknown = |verdict: &&Verdict<'_>| verdict.standing == Standing::Unknown;
        let (unknown, exceeded): (Vec<_>, Vec<_>) = unmet.into_iter().partition(is_unknown);
        let symbols = |(standing, of): (Standing, &Vec<&Verdict<'_>>)| {
            // A limit of the free impact can be exceeded by the method's own quantity.
            let exceeding = |of: &&Verdict<'_>| match (of.standing, of.beside) {
                (Standing::Within, Some(Beside { own: Some((own, _)), .. })) => own.symbol,
                _ => of.limit.quantity.symbol,
            };
            let symbols: Vec<_> = of.iter().map(exceeding).collect();
            // A narrow pane has room for two symbols in one line.
            let all = symbols.len();
            let count = if app.area(Pane::Results).width < WIDE { all.min(2) } else { all };
            let more = if all > count { format!(", +{}", all - count) } else { String::new() };
            let listed = symbols[..count].join(", ");
            (all > 0).then(|| format!("{}: {listed}{more}", standing.word()))
        };
        let named = [(Standing::Exceeded, &exceeded), (Standing::Unknown, &unknown)];
        let named: Vec<String> = named.into_iter().filter_map(symbols).collect();
        if !named.is_empty() {
            add(format!("! Limit {}.", named.join("; ")), theme.problem, Place::Pane);
        }
        let place = if has_fault { Place::Room } else { Place::Verdict };
        add(remarked(app, Remarks::All).unwrap_or_default(), fresh(theme.focus), place);
        for verdict in exceeded.into_iter().chain(unknown) {
            add(format!("! {}", limit(verdict)), theme.problem, Place::Room);
        }
        let figures = [differing(answer, solution), digest::whine(solution)];
        for figure in figures.into_iter().flatten() {
            add(format!("{figure}."), fresh(Style::new()), Place::Room);
        }
        for verdict in met {
            add(limit(verdict), fresh(Style::new()), Place::Room);
        }
        if app.tab.case.limits.is_empty() {
            add("No limits.".to_owned(), Style::new(), Place::Page);
        }
    }
    for (name, found) in
        app.shown_variants().into_iter().flat_map(|(variants, _)| &variants.columns)
    {
        let Ok(variant) = app.tab.case.variant(name) else { continue };
        let mut changes = changes::between(&app.tab.case, &app.tab.case.with(variant));
        changes.retain(|change| !change.key.starts_with("variants."));
        let found = match found {
            Ok(solution) => digest::sentence(solution, app.settings.units, false),
            Err(reason) => format!("Refused: {reason}."),
        };
        let inputs = session::summary(&changes);
        add(format!("Variant {name}: {inputs}. {found}"), fresh(theme.note), Place::Room);
    }
    for note in &answer.notes {
        let place = if note.is_general { Place::Page } else { Place::Room };
        add(format!("Note: {note}."), fresh(theme.note), place);
    }
    all
}

/// The beginning of the verdict of results that belong to an earlier state of the form, with the value
/// of the faulty field in that state.
fn age(app: &App, answer: &Answer) -> String {
    if !app.tab.shows_last_valid() {
        return String::new();
    }
    let case = &app.tab.case;
    let row = app.tab.problems.iter().map(|(row, _)| *row).min();
    let valid = app.tab.valid.as_ref().filter(|_| answer.serial == app.tab.serial);
    let edited = row.zip(valid).filter(|(row, valid)| rows::differs(case, valid, *row));
    let value = edited.and_then(|(row, valid)| {
        let (symbol, text) = (rows::names_of(case, row).0, rows::text_beside(valid, case, row)?);
        Some(if symbol.is_empty() { text.to_owned() } else { format!("{symbol} = {text}") })
    });
    value.map_or_else(|| "LAST VALID: ".to_owned(), |value| format!("LAST VALID ({value}): "))
}

/// Why the results belong to an earlier state of the form: the cause, then the fix.
fn faults(app: &App) -> Vec<String> {
    let key = NEXT_FAULT;
    if let Some(refusal) = &app.tab.refusal {
        return vec![
            format!("! Not solved: {refusal}."),
            format!("Correction: {} ({key}).", refusal.fix()),
        ];
    }
    let rows: BTreeSet<usize> = app.tab.problems.iter().map(|(row, _)| *row).collect();
    let Some((row, problem)) = app.tab.problems.iter().min_by_key(|(row, _)| *row) else {
        return Vec::new();
    };
    if rows.len() > 1 && rows.iter().all(|&row| rows::lacks(&app.tab.case, row)) {
        return vec![format!("! {} required values are missing ({key})", rows.len())];
    }
    let (symbol, label) = rows::names_of(&app.tab.case, *row);
    let name = format!("{symbol} {label}");
    let more = if rows.len() > 1 { format!(" and {} more", rows.len() - 1) } else { String::new() };
    vec![format!("! {}{more} ({key}): {}", name.trim_start(), problem.cause)]
}

/// Whether the limit is met; also by the method's own quantity, unless that quantity has a limit.
fn is_met(verdict: &Verdict<'_>) -> bool {
    let is_own_limited = verdict.beside.is_some_and(|beside| beside.is_limited);
    verdict.standing.holds() && (is_own_limited || !verdict.is_exceeded_beside())
}

// The other methods with another outcome. `paper` is not compared: it repeats `exact` with
// misprints. A slow method is not compared before its own result is present.
fn differing(answer: &Answer, solution: &Solution) -> Option<String> {
    let others = answer.methods.iter().rev().filter(|(method, _)| {
        answer.pending.is_none() && *method != answer.active && *method != Method::Paper
    });
    let others: Vec<&Solution> = others.filter_map(|(_, found)| found.as_ref().ok()).collect();
    digest::differing(solution, &others)
}

fn title(app: &App, count: usize, rows: usize) -> String {
    let name = if app.shown_variants().is_some() { "Variants" } else { "Results" };
    let valid = if app.tab.shows_last_valid() { ": LAST VALID" } else { "" };
    let top = app.tab.results.top;
    let position = (0 < rows && rows < count)
        .then(|| format!(" {}-{}/{count}", top + 1, (top + rows).min(count)));
    let base = app.baseline.as_ref().filter(|_| app.shown_variants().is_none());
    let base = base.map(|baseline| format!(", against {}", baseline.name));
    let pending = app.tab.answer.as_ref().and_then(|answer| answer.pending);
    let pending = pending.map(|method| format!(", {} pending", method.name()));
    let cost = app.tab.answer.as_ref().filter(|_| app.shows_cost).map(|answer| answer.cost);
    let cost = cost
        .map(|cost| format!(", {} stages in {}", cost.stages, duration(cost.micros as f64 / 1e6)));
    let method =
        app.shown_answer().filter(|_| !app.has_result_header() || app.shown_variants().is_some());
    let method = method.map(|answer| format!(" by {}", answer.active.name()));
    let parts = [position, method, base, pending, cost].into_iter().flatten();
    format!("{name}{valid}{}", parts.collect::<String>())
}

/// The most important quantities of each method.
const FIRST: [&str; 15] = [
    "dynamic_peak_approach_force",
    "dynamic_peak_force",
    "dynamic_impact_duration",
    "dynamic_first_contact_angle_driver",
    "dynamic_contact_lost",
    "static_force_at_start",
    "static_peak_force",
    "static_first_contact_angle_driver",
    "static_transmission_error",
    "impact_force",
    "impact_duration",
    "approach_angle_driver",
    "friction_ratio",
    "normal_velocity",
    "total_deviation",
];

/// Marks after a value that the last edit changed, and after a value above its limit.
const CHANGED: &str = "←";
const EXCEEDED: &str = "!";
/// The text of an absent value.
const NONE: &str = "–";
/// The text of a value that the baseline did not compute.
const NOT_SOLVED: &str = "not solved";
/// A longer name of a variant is cut.
const LONGEST_NAME: usize = 18;
/// A longer input of a variant is cut; in a narrow pane its name, a field, and a limit or a
/// distribution of a variant.
const LONGEST_INPUT: usize = 24;
const NARROW_INPUT: [usize; 3] = [10, 9, 12];
/// The width of all but a few symbols, and of all but a few numbers.
const SYMBOL: usize = 8;
const NUMBER: usize = 8;
/// The width of the usual units, which a pane narrower than `WIDE` has room for, and of a mark with
/// its blank.
const UNIT: usize = 4;
const MARK: usize = 2;
const WIDE: u16 = 56;

/// A column with a cell for each quantity. In a narrow pane, the columns of the highest rank are
/// removed first, and those of rank 0 remain; a column is cut to its least width before.
struct Column {
    rank: usize,
    least: usize,
    heading: String,
    cells: Vec<String>,
    /// The width of a column that is wider than its cells.
    room: usize,
    /// Whether the texts end at the right.
    is_number: bool,
    /// Whether long texts take room from the names of their rows.
    is_unit: bool,
    /// The styles of the heading and of the cells.
    styles: [Style; 2],
}

/// The rank of the case beside its variants.
const OF_CASE: usize = 1;
/// The rank of the names.
const NAMES: usize = 90;

impl Column {
    fn words(rank: usize, least: usize, room: usize, cells: Vec<String>, style: Style) -> Column {
        let heading = String::new();
        let styles = [style; 2];
        Column { rank, least, heading, cells, room, is_number: false, is_unit: false, styles }
    }

    fn numbers(rank: usize, heading: String, cells: Vec<String>, styles: [Style; 2]) -> Column {
        let words = Column::words(rank, usize::MAX, NUMBER, cells, Style::new());
        Column { heading, is_number: true, styles, ..words }
    }

    fn width(&self) -> usize {
        let texts = self.cells.iter().filter(|_| !self.is_unit).chain([&self.heading]);
        texts.map(|text| text::width(text)).max().unwrap_or(0).max(self.room)
    }
}

/// The visible quantities: those of the method, the most important ones first and those without a
/// value last. The free impact beside a method that resolves the impact is folded away unless
/// every method is shown.
pub(crate) fn order(answer: &Answer, is_all: bool) -> Vec<&'static Quantity> {
    let methods = || answer.methods.iter().map(|(method, _)| *method);
    let stages = methods().fold(Stages::NONE, |stages, method| stages.and(method.stages()));
    let has_friction = answer.inputs.friction_coefficient.is_some();
    let has_slices = answer.inputs.face().is_some();
    let is_folded = answer.active.shares_load() && !is_all;
    let first = FIRST.iter().filter_map(|key| Quantity::find(key));
    let rest = report::quantities(answer.active).filter(|quantity| {
        let is_open = match quantity.needs {
            Need::Friction => has_friction,
            Need::Slices => has_slices,
            _ => true,
        };
        is_open && !FIRST.contains(&quantity.key)
    });
    let has_value =
        |quantity: &&Quantity| methods().any(|method| value(answer, method, quantity).is_some());
    // A limited result can come from a slower method than the choice of `auto`.
    let listed = first.chain(rest).filter(|quantity| {
        (stages.has(quantity.stage) || has_value(quantity))
            && !(is_folded && quantity.is_of_free_impact())
    });
    let (mut known, unknown): (Vec<_>, Vec<_>) = listed.partition(has_value);
    known.extend(unknown);
    known
}

/// The label of a quantity, which names the free impact beside a method that resolves the impact.
pub(crate) fn label(quantity: &Quantity, active: Method) -> Cow<'static, str> {
    let label = quantity.label_in(active);
    if active.shares_load() && quantity.is_of_free_impact() {
        format!("free: {}", label.trim_start()).into()
    } else {
        label.into()
    }
}

/// The number of variants that fit side by side.
pub(crate) fn variants_page(app: &App) -> usize {
    let shown = app
        .shown_answer()
        .map(|answer| fitting(app, answer, &app.listed_results(), app.results_page()));
    let is_variant = |column: &&Column| !column.heading.is_empty() && column.rank != OF_CASE;
    shown.map_or(1, |shown| shown.iter().filter(is_variant).count().max(1))
}

/// The value of the quantity, and of every variant or of the baseline, with the method of the
/// baseline if it differs.
pub(crate) fn compared(app: &App, quantity: &'static Quantity) -> Option<String> {
    let answer = app.shown_answer()?;
    if app.shown_variants().is_some() {
        let columns = columns(app, answer, &[quantity], &[quantity]);
        let cell = |column: &Column| column.cells.last().cloned().unwrap_or_default();
        let unit = columns.iter().find(|column| column.is_unit).map(cell).unwrap_or_default();
        let numbers = columns.iter().filter(|column| column.is_number);
        let above = |cell: String| cell.trim_end().replace(EXCEEDED, " above its limit");
        let words = numbers.map(|column| match (column.heading.as_str(), above(cell(column))) {
            ("case", own) => format!("Case {own} {unit}").trim_end().to_owned(),
            ("", by) if by.is_empty() => by,
            ("", by) => format!(" ({by})"),
            (name, value) => format!("; {name} {value}"),
        });
        return Some(words.collect::<String>() + ".");
    }
    let (method, base) = base(app, answer, quantity);
    let active = app.baseline.as_ref()?.answer.active;
    let printed = |value: Option<f64>| match value {
        Some(value) => report::shown_in(quantity, value, app.settings.units).to_string(),
        None => "none".to_owned(),
    };
    let is_same = method == answer.active && method == active;
    let whose = if is_same { String::new() } else { format!(" ({})", method.name()) };
    let own = printed(value(answer, answer.active, quantity));
    let base = match base {
        None if !app.baseline.as_ref()?.answer.has(answer.active, quantity.stage) => {
            NOT_SOLVED.to_owned()
        }
        base => printed(base),
    };
    Some(format!("{own}; baseline{whose}: {base}."))
}

/// The columns of the visible rows that fit, each after a blank. Texts have the room of all rows, so
/// that columns do not move; variants need all the room.
fn fitting(app: &App, answer: &Answer, listed: &[&'static Quantity], rows: usize) -> Vec<Column> {
    let (top, inputs) = (app.tab.results.top, inputs(app));
    let hidden = top.min(inputs.len());
    let inputs: Vec<_> = inputs.into_iter().skip(hidden).take(rows).collect();
    let known = listed.iter().copied().skip(top - hidden).take(rows - inputs.len());
    let mut columns = columns(app, answer, listed, &known.collect::<Vec<_>>());
    add_inputs(app, &inputs, &mut columns);
    if app.shown_variants().is_some() {
        columns.iter_mut().filter(|column| !column.is_unit).for_each(|column| column.room = 0);
    }
    loop {
        let taken: usize = columns.iter().map(|column| column.width() + 1).sum();
        let over = taken.saturating_sub(app.area(Pane::Results).width.into());
        let last = columns.iter().enumerate().max_by_key(|(_, column)| column.rank);
        let Some((at, last)) = last.filter(|(_, last)| over > 0 && last.rank > 0) else {
            return columns;
        };
        let room = last.width().saturating_sub(over);
        if room >= last.least {
            // The symbol tells the method.
            let short = |cell: &str| {
                let stripped =
                    ["static: ", "dynamic: "].iter().find_map(|by| cell.strip_prefix(by));
                text::cut(stripped.unwrap_or(cell), room)
            };
            columns[at].cells.iter_mut().for_each(|cell| *cell = short(cell));
            columns[at].room = room;
        } else {
            columns.remove(at);
        }
    }
}

/// Numbers beside variants, each with its own mark of an exceeded limit.
fn marked(
    (app, active): (&App, Method),
    (case, solution): (&Case, Option<&Solution>),
    [all, known]: [&[&'static Quantity]; 2],
    numbers: Vec<String>,
) -> Vec<String> {
    let Some(solution) = solution else { return numbers };
    let is_above = |quantity: &Quantity| {
        let mut limits = case.limits.iter();
        limits.any(|limit| {
            let is_own = limit.quantity.row_in(active) == quantity;
            is_own && verdict(limit, solution).standing == Standing::Exceeded
        })
    };
    if app.tab.is_stale() || !all.iter().any(|of| is_above(of)) {
        return numbers;
    }
    let mark = |of: &Quantity| if is_above(of) { EXCEEDED } else { " " };
    known.iter().zip(numbers).map(|(of, number)| number + mark(of)).collect()
}

/// The unit of each result, common to the methods and the variants.
fn common_units(
    (app, answer): (&App, &Answer),
    all: &[&'static Quantity],
    methods: &[Method],
) -> Vec<&'static str> {
    let variants = app.shown_variants();
    let solved = || variants.iter().flat_map(|(variants, _)| &variants.columns);
    let common = |&quantity: &&'static Quantity| {
        let of_methods = methods.iter().filter_map(|&method| value(answer, method, quantity));
        let of_variants = solved()
            .filter_map(|(_, found)| value_as_in(quantity, found.as_ref().ok()?, answer.active));
        report::common_unit(quantity, of_methods.chain(of_variants), app.settings.units)
    };
    all.iter().map(common).collect()
}

fn columns(
    app: &App,
    answer: &Answer,
    all: &[&'static Quantity],
    known: &[&'static Quantity],
) -> Vec<Column> {
    let (theme, active, variants) = (app.look.theme, answer.active, app.shown_variants());
    // Results of `static` are among the rows of `dynamic`.
    let shows_others = app.shows_every_method && variants.is_none();
    let is_shown = |method: Method| {
        let is_among_rows = active == Method::Dynamic && method == Method::Static;
        method == active || (shows_others && !is_among_rows)
    };
    let methods = answer.methods.iter().map(|(method, _)| *method);
    let methods: Vec<Method> = methods.filter(|method| is_shown(*method)).collect();
    let solved = || variants.iter().flat_map(|(variants, _)| &variants.columns);
    let units = common_units((app, answer), all, &methods);
    let unit = |quantity: &'static Quantity| {
        let at = all.iter().position(|known| std::ptr::eq(*known, quantity));
        at.map_or(quantity.shown, |at| units[at])
    };
    let own = |quantity| value(answer, active, quantity);
    let (shown, rows) = ((app, active), [all, known]);
    let number = |quantity: &'static Quantity, value: Option<f64>| {
        let shown = |value| report::shown_with(quantity, value, unit(quantity)).number;
        value.map_or_else(|| NONE.to_owned(), shown)
    };
    let cells = |cell: &dyn Fn(&'static Quantity) -> String| {
        known.iter().map(|quantity| cell(quantity)).collect::<Vec<_>>()
    };
    let words = |rank, least, style, text: &dyn Fn(&'static Quantity) -> Cow<'static, str>| {
        let room = all.iter().map(|quantity| text::width(&text(quantity))).max().unwrap_or(0);
        Column::words(rank, least, room, cells(&|of| text(of).into_owned()), style)
    };
    let symbols = |of: &'static Quantity| symbol(of.symbol_in(active), app.look.ascii);
    let symbols = words(0, 0, Style::new(), &symbols);
    let is_narrow = app.area(Pane::Results).width < WIDE;
    let mut columns = vec![
        Column { room: symbols.room.min(SYMBOL), ..symbols },
        words(NAMES, 9, Style::new(), &|of| label(of, active)),
    ];
    for (at, &method) in methods.iter().enumerate() {
        let numbers = cells(&|of| number(of, value(answer, method, of)));
        let (rank, heading, styles) = match variants {
            Some(_) => (OF_CASE, "case".to_owned(), [theme.active, theme.focus]),
            None if method == active => {
                (0, format!("▸{}", method.name()), [theme.active, theme.focus])
            }
            // The fastest method, which is the least accurate one, is removed first.
            None => (50 - at, method.name().to_owned(), [theme.other, Style::new()]),
        };
        let numbers = match variants {
            Some(_) => marked(shown, (&app.tab.case, answer.of(method)), rows, numbers),
            None => numbers,
        };
        columns.push(Column::numbers(rank, heading, numbers, styles));
    }
    let of_units = cells(&|of| {
        let has_value = methods.iter().any(|&method| value(answer, method, of).is_some());
        let name = if has_value && !of.is_flag() { named(unit(of)) } else { "" };
        let mark = if variants.is_some() { "" } else { mark(app, answer, of, unit(of)) };
        [name, mark].join(" ").trim().to_owned()
    });
    let width = |of: &&'static Quantity| text::width(named(unit(of)));
    let room = match variants {
        Some(_) => known.iter().map(width).max().unwrap_or(0),
        None if is_narrow => UNIT + MARK,
        None => all.iter().map(width).max().unwrap_or(0) + MARK,
    };
    let column = Column::words(0, 0, room, of_units, Style::new());
    columns.push(Column { is_unit: true, ..column });
    let first = variants.map_or(0, |(_, first)| first);
    for (at, (name, found)) in solved().skip(first).enumerate() {
        let now = |of| value_as_in(of, found.as_ref().ok()?, active).filter(|now| now.is_finite());
        let values = cells(&|of| match found {
            Ok(_) => number(of, now(of)),
            Err(_) => "refused".to_owned(),
        });
        let case = app.tab.case.variant(name).map(|variant| app.tab.case.with(variant));
        let values = match case {
            Ok(case) => marked(shown, (&case, found.as_ref().ok()), rows, values),
            Err(_) => values,
        };
        let differences = cells(&|of| match (now(of), own(of)) {
            (Some(now), Some(own)) => difference(of, now, own, unit(of)),
            _ => String::new(),
        });
        // The difference of the first variant gives way to its value and to the case.
        let ranks = if at == 0 { [0, 3] } else { [2 + 2 * at, 3 + 2 * at] };
        let (name, plain) = (text::cut(name, LONGEST_NAME), [theme.other, Style::new()]);
        columns.push(Column::numbers(ranks[0], name, values, plain));
        columns.push(Column::numbers(ranks[1], String::new(), differences, plain));
    }
    if let Some(baseline) = app.baseline.as_ref().filter(|_| variants.is_none()) {
        let differences = cells(&|of| match (own(of), base(app, answer, of).1) {
            (Some(now), Some(base)) => difference(of, now, base, unit(of)),
            (None, Some(base)) => format!("was {}", number(of, Some(base))),
            (Some(_), None) if baseline.answer.has(active, of.stage) => "was none".to_owned(),
            (Some(_), None) => NOT_SOLVED.to_owned(),
            (None, None) => String::new(),
        });
        let (heading, styles) = ("baseline".to_owned(), [theme.baseline; 2]);
        columns.push(Column::numbers(1, heading, differences, styles));
    } else if variants.is_none() {
        columns.push(words(99, 12, theme.faint, &|of| of.equation.into()));
    }
    columns
}

/// Inserts differing inputs of the variants above the quantities.
fn add_inputs(app: &App, inputs: &[(String, Vec<String>)], columns: &mut [Column]) {
    let [of_name, of_field, of_variant] =
        if app.area(Pane::Results).width < WIDE { NARROW_INPUT } else { [LONGEST_INPUT; 3] };
    let cut = |text: &str, most| text::cut(&sanitize(text), most);
    for (row, (key, texts)) in inputs.iter().enumerate() {
        let [own, label] = compare::names(key);
        let own = cut(&symbol(&own, app.look.ascii), of_name);
        let is_field = index_of(key).is_some();
        let of_variant = if is_field { of_field } else { of_variant };
        let first = app.shown_variants().map_or(0, |(_, first)| first);
        let others = texts.iter().skip(1 + first);
        let others = others.flat_map(|text| [cut(text, of_variant), String::new()]);
        let case = [own, label, cut(&texts[0], of_field), String::new()];
        let cells = case.into_iter().chain(others);
        columns.iter_mut().zip(cells).for_each(|(column, cell)| column.cells.insert(row, cell));
    }
}

/// The keys of the inputs that differ between the case and its variants, with the text of each.
fn inputs(app: &App) -> Vec<(String, Vec<String>)> {
    let Some((variants, _)) = app.shown_variants() else { return Vec::new() };
    let own = &app.tab.case;
    let of_variant = |(name, _): &(String, _)| own.variant(name).map(|variant| own.with(variant));
    let cases = variants.columns.iter().map(|column| of_variant(column).unwrap_or(own.clone()));
    let cases: Vec<Case> = std::iter::once(own.clone()).chain(cases).collect();
    let text = |case: &Case, field: usize| case.effective(field).unwrap_or(NONE).to_owned();
    let texts = |field| cases.iter().map(|case| text(case, field)).collect::<Vec<_>>();
    let fields = (0..FIELDS.len()).filter(|field| !FIELDS[*field].table().is_empty());
    let fields = fields.map(|field| (FIELDS[field].key.to_owned(), texts(field)));
    let mut entries: Vec<String> = Vec::new();
    for change in cases.iter().flat_map(|case| changes::between(own, case)) {
        let is_entry = ["limits.", "spread."].iter().any(|start| change.key.starts_with(start));
        if is_entry && !entries.contains(&change.key) {
            entries.push(change.key);
        }
    }
    let text = |case, key: &str| changes::text_of(case, key).unwrap_or_else(|| NONE.to_owned());
    let texts = |key: &String| cases.iter().map(|case| text(case, key)).collect();
    let entries = entries.into_iter().map(|key| (key.clone(), texts(&key)));
    let differing = fields.chain(entries);
    differing.filter(|(_, texts)| texts.iter().any(|text| *text != texts[0])).collect()
}

// The mark of a quantity: above its limit, or changed.
fn mark(app: &App, answer: &Answer, quantity: &Quantity, unit: &'static str) -> &'static str {
    let Some(solution) = answer.of(answer.active).filter(|_| !app.tab.is_stale()) else {
        return "";
    };
    let limits = app.tab.case.limits.iter();
    let mut limits = limits.filter(|limit| limit.quantity.row_in(answer.active) == quantity);
    if limits.any(|limit| verdict(limit, solution).standing == Standing::Exceeded) {
        return EXCEEDED;
    }
    // Whether the present visit of a field changed the printed value of the quantity.
    let Some(earlier) = &app.tab.earlier else { return "" };
    let at = QUANTITIES.iter().position(|known| std::ptr::eq(known, quantity));
    let (before, now) = (at.and_then(|at| *earlier.get(at)?), quantity.finite_value(solution));
    let printed =
        |value: Option<f64>| value.map(|value| report::shown_with(quantity, value, unit).number);
    if before != now && printed(before) != printed(now) { CHANGED } else { "" }
}

fn value(answer: &Answer, method: Method, quantity: &Quantity) -> Option<f64> {
    value_as_in(quantity, answer.of(method)?, answer.active)
}

// The method and the value of the baseline: by its own method what the compared one lacks, except
// the required relief, which each method defines by its own force.
fn base(app: &App, answer: &Answer, quantity: &Quantity) -> (Method, Option<f64>) {
    let Some(Baseline { answer: base, .. }) = &app.baseline else { return (answer.active, None) };
    let of = |method| value_as_in(quantity, base.of(method)?, answer.active);
    let method = base.beside(answer.active);
    let other = (base.active, of(base.active).filter(|_| quantity.stage != Stage::Clearing));
    of(method).map_or(other, |found| (method, Some(found)))
}
