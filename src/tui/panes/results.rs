//! The results pane: faults, verdict, limits, figures and notes as sentences above the table of
//! quantities, with the methods or the variants side by side, marks of changes and limits, and the
//! difference from the baseline.

use std::borrow::Cow;
use std::collections::BTreeSet;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect};
use ratatui::style::Style;
use ratatui::text::Line;

use super::Title;
use crate::case::sanitize::sanitize;
use crate::case::units::{self, System, named};
use crate::case::{Case, FIELDS, Field, Problem, changes};
use crate::model::inputs::Method;
use crate::model::quantities::Need;
use crate::model::{QUANTITIES, Quantity, Refusal, Solution, Stage, Stages};
use crate::report::compare::difference;
use crate::report::verdict::{Standing, Verdict, verdict, verdicts};
use crate::report::{self, digest, value_as_in};
use crate::tui::layout::NEXT_FAULT;
use crate::tui::rows;
use crate::tui::session;
use crate::tui::solver::{Answer, Baseline, Values, Variants};
use crate::tui::text::{self, symbol};
use crate::tui::theme::Look;

/// Number of quantities that stay visible below the sentences, and below a long verdict or fault.
const USUAL_ROWS: usize = 12;
const LEAST_ROWS: usize = 4;
/// Notes that only the page has, besides those that say the same for almost every case.
const USUAL_NOTES: [&str; 2] = ["deflection-given", "deflection-ignored"];

/// The state of the pane, separate for each open case.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub struct ResultsState {
    /// The key of the selected quantity. While the results do not have it, the first one is
    /// selected.
    pub selected: Option<&'static str>,
    /// The first visible line of the quantities.
    pub top: usize,
}

/// The pane with the results that it shows.
#[derive(Debug, Clone)]
pub struct Results<'a> {
    pub(crate) state: ResultsState,
    /// The last valid results.
    pub(crate) answer: Option<&'a Answer>,
    /// Whether they are older than the form.
    pub(crate) is_stale: bool,
    /// The pinned results.
    pub(crate) baseline: Option<&'a Baseline>,
    /// The variants, with the first visible one, if they are shown instead of the methods.
    pub(crate) variants: Option<(&'a Variants, usize)>,
    /// The values before the last edit.
    pub(crate) earlier: Option<&'a Values>,
    /// Why the model refuses the case.
    pub(crate) refusal: Option<&'a Refusal>,
    /// The invalid rows of the form.
    pub(crate) problems: &'a [(usize, Problem)],
    /// The case in the form.
    pub(crate) case: &'a Case,
    /// Whether the free impact and the other methods are shown beside the method of the case.
    pub(crate) shows_every_method: bool,
    /// Whether the title shows the cost of the solve.
    pub(crate) shows_cost: bool,
    pub(crate) units: System,
    pub(crate) look: Look,
    pub(crate) title: Title,
    /// The area of the pane with its title; empty if the pane is hidden.
    pub(crate) area: Rect,
}

impl Results<'_> {
    /// The quantities in their order.
    pub fn listed(&self) -> Vec<&'static Quantity> {
        self.answer.map_or_else(Vec::new, |answer| order(self, answer))
    }

    /// The selected line among the quantities.
    fn row(&self) -> usize {
        let Some(selected) = self.state.selected else { return 0 };
        self.listed().iter().position(|quantity| quantity.key == selected).unwrap_or(0)
    }

    /// The selected quantity.
    pub fn marked(&self) -> Option<&'static Quantity> {
        self.listed().get(self.row()).copied()
    }

    /// The number of visible quantities.
    pub fn page(&self) -> usize {
        parts(self).1
    }

    /// The state with the selection `by` quantities further.
    pub(crate) fn stepped(&self, by: isize) -> ResultsState {
        let (listed, row) = (self.listed(), self.row().saturating_add_signed(by));
        let quantity = listed.get(row).or(listed.last());
        ResultsState { selected: quantity.map(|quantity| quantity.key), ..self.state }
    }

    /// The state with selection and visible lines `by` quantities further.
    pub(crate) fn turned(&self, by: isize) -> ResultsState {
        ResultsState { top: self.scrolled(by), ..self.stepped(by) }
    }

    /// The first visible line after scrolling by lines downwards.
    pub(crate) fn scrolled(&self, by: isize) -> usize {
        let last = self.listed().len().saturating_sub(self.page());
        self.state.top.saturating_add_signed(by).min(last)
    }

    /// The first visible line such that the selected quantity is visible.
    pub(crate) fn top_for(&self) -> usize {
        let row = self.row();
        if row == 0 {
            return 0;
        }
        let rows = self.page().max(1);
        let least = (row + 1).saturating_sub(rows);
        let last = self.listed().len().saturating_sub(rows);
        self.state.top.clamp(least, row.max(least)).min(last)
    }

    /// The key of the quantity at a cell, if any.
    pub(crate) fn key_at(&self, at: Position) -> Option<&'static str> {
        let (head, rows) = parts(self);
        let above = head.len() + 1 + usize::from(self.has_header()) + inputs(self).len();
        let line = usize::from(at.y - self.area.y).checked_sub(above)?;
        let listed = self.listed();
        listed.get(self.state.top + line).filter(|_| line < rows).map(|quantity| quantity.key)
    }

    /// Whether the columns need names; otherwise the title names the only method.
    fn has_header(&self) -> bool {
        self.shows_every_method || self.variants.is_some() || self.baseline.is_some()
    }

    fn shows_last_valid(&self) -> bool {
        self.is_stale && self.answer.is_some()
    }
}

pub(crate) fn draw(pane: &Results<'_>, buffer: &mut Buffer) {
    let (head, rows) = parts(pane);
    let listed = pane.listed();
    let inner = pane.title.draw(&title(pane, listed.len(), rows), pane.area, buffer);
    let [above, body] = text::split(inner, head.len() as u16);
    // The first column has the mark of the selected row.
    text::draw_lines(
        &head,
        Rect { x: above.x + 1, width: above.width.saturating_sub(1), ..above },
        buffer,
    );
    let Some(answer) = pane.answer else { return };
    let theme = pane.look.theme;
    let is_outdated = pane.variants.is_some_and(|(variants, _)| variants.serial != answer.serial);
    let base = if pane.is_stale || is_outdated { theme.faint } else { Style::new() };
    let [header, body] = text::split(body, u16::from(pane.has_header()));
    let row = pane.row().checked_sub(pane.state.top).filter(|row| *row < rows);
    let row = row.map(|row| row + inputs(pane).len());
    if let Some(row) = row.filter(|_| pane.title.has_focus && !body.is_empty()) {
        text::put("▸", (body.x, body.y + row as u16), 1, base.patch(theme.focus), buffer);
    }
    let columns = fitting(pane, answer, &listed, rows);
    let units = columns.iter().position(|column| column.rank == UNITS).unwrap_or(0);
    let mut x = body.x + 1;
    for (at, column) in columns.iter().enumerate() {
        let width = column.width();
        let mut put = |text: &str, y: u16, style: Style, back: usize| {
            let gap = if column.is_number { width.saturating_sub(text::width(text)) } else { 0 };
            let (x, style) = ((x + gap as u16).saturating_sub(back as u16), base.patch(style));
            text::put(text, (x, y), body.right().saturating_sub(x).into(), style, buffer);
        };
        if !header.is_empty() {
            put(&column.heading, header.y, column.styles[0], 0);
        }
        for (line, (y, text)) in (body.y..body.bottom()).zip(&column.cells).enumerate() {
            // A long unit moves the numbers of its row to the left and cuts the name.
            let unit = &columns[units];
            let over = text::width(&unit.cells[line]).saturating_sub(unit.width());
            match column.rank {
                NAMES => put(&text::cut(text, width - over.min(width)), y, column.styles[1], 0),
                _ if at == units || at < units && column.is_number => {
                    put(text, y, column.styles[1], over);
                }
                _ => put(text, y, column.styles[1], 0),
            }
        }
        x += width as u16 + 1;
    }
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
    /// Always.
    Pane,
    /// If there is room.
    Room,
    /// Nowhere else.
    Page,
}

/// The lines above the table, and the number of quantities that fit below them.
fn parts(pane: &Results<'_>) -> (Vec<Line<'static>>, usize) {
    let width = usize::from(pane.area.width.saturating_sub(1));
    let height = usize::from(pane.area.height.saturating_sub(1));
    let (mut head, mut hidden) = (Vec::new(), 0);
    let height = height.saturating_sub(usize::from(pane.has_header()) + inputs(pane).len());
    let kept = |rows: usize| height.saturating_sub(rows);
    let most = if pane.answer.is_some() { kept(LEAST_ROWS + 1) } else { height };
    for Sentence { text, style, place } in sentences(pane) {
        let lines = text::wrap(&text, width).into_iter().map(|line| Line::styled(line, style));
        // The last line counts the hidden sentences.
        let room = kept(USUAL_ROWS).saturating_sub(head.len() + 1);
        match place {
            Place::Pane => head.extend(lines),
            Place::Room if hidden == 0 && lines.len() <= room => head.extend(lines),
            Place::Room | Place::Page => hidden += 1,
        }
    }
    if head.len() > most {
        head.truncate(most);
        head.iter_mut().last().into_iter().for_each(|line| line.push_span("…"));
    }
    let notes = (hidden > 0).then(|| {
        let ending = if hidden == 1 { "" } else { "s" };
        format!("{hidden} note{ending} ({}n)", pane.title.leave())
    });
    let folded = pane.answer.and_then(|answer| folded(pane, answer));
    // Between variants the results need the line; the key of the notes is in the line of keys.
    let has_room = pane.variants.is_none() || head.len() < kept(USUAL_ROWS);
    let last: Vec<String> = notes.into_iter().chain(folded).filter(|_| has_room).collect();
    if !last.is_empty() {
        let last = text::cut(&last.join(", "), width);
        head.push(Line::styled(last, pane.look.theme.note));
    }
    let rows = if pane.answer.is_some() { kept(head.len()) } else { 0 };
    (head, rows)
}

/// The folded rows and columns, with the key that shows them.
fn folded(pane: &Results<'_>, answer: &Answer) -> Option<String> {
    let name = if answer.active.shares_load() { "free impact" } else { "other methods" };
    let is_folded = !pane.shows_every_method && pane.variants.is_none();
    is_folded.then(|| format!("{name} ({}f)", pane.title.leave()))
}

/// Every sentence in full, one per line: the page of notes.
pub(crate) fn in_full(pane: &Results<'_>) -> Vec<String> {
    sentences(pane).into_iter().flat_map(|sentence| [sentence.text, String::new()]).collect()
}

/// Faults, limits that are not met, verdict, figures, limits that are met, and notes, the most
/// important first.
fn sentences(pane: &Results<'_>) -> Vec<Sentence> {
    let theme = pane.look.theme;
    let mut all = Vec::new();
    let mut add = |text: String, style: Style, place: Place| {
        let text = symbol(&text, pane.look.ascii).into_owned();
        all.push(Sentence { text, style, place });
    };
    let faults = faults(pane);
    let has_fault = !faults.is_empty();
    for (fault, style) in faults.into_iter().zip([theme.problem, Style::new()]) {
        add(fault, style, Place::Pane);
    }
    let Some(answer) = pane.answer else { return all };
    let fresh = |style: Style| if pane.is_stale { theme.faint } else { style };
    if let Some(solution) = answer.of(answer.active) {
        let verdicts = if pane.is_stale { Vec::new() } else { verdicts(pane.case, solution) };
        let written = verdicts.iter().filter(|verdict| !verdict.limit.text.is_empty());
        let (met, unmet): (Vec<_>, Vec<_>) = written.partition(|verdict| is_met(verdict));
        let limit = |verdict: &Verdict<'_>| {
            format!("Limit {}: {}.", verdict.standing.word(), verdict.sentence(pane.units))
        };
        for verdict in unmet {
            add(format!("! {}", limit(verdict)), theme.problem, Place::Pane);
        }
        let place = if has_fault { Place::Room } else { Place::Pane };
        let age = if pane.shows_last_valid() { "LAST VALID: " } else { "" };
        let is_pending = answer.strikes() && answer.lacks(Stage::Clearing);
        let verdict = digest::sentence(solution, pane.units, is_pending);
        add(format!("{age}{verdict}"), fresh(theme.focus), place);
        let figures = [differing(answer, solution), digest::whine(solution)];
        for figure in figures.into_iter().flatten() {
            add(format!("{figure}."), fresh(Style::new()), Place::Room);
        }
        for verdict in met {
            add(limit(verdict), fresh(Style::new()), Place::Room);
        }
        if pane.case.limits.is_empty() {
            add("No limits.".to_owned(), Style::new(), Place::Page);
        }
    }
    for (name, found) in pane.variants.into_iter().flat_map(|(variants, _)| &variants.columns) {
        let Ok(variant) = pane.case.variant(name) else { continue };
        let mut changes = changes::between(pane.case, &pane.case.with(variant));
        changes.retain(|change| !change.key.starts_with("variants."));
        let refused = found.as_ref().err().map(|reason| format!("; refused: {reason}"));
        let place = if refused.is_some() { Place::Room } else { Place::Page };
        let (inputs, refused) = (session::summary(&changes), refused.unwrap_or_default());
        add(format!("Variant {name}: {inputs}{refused}."), fresh(theme.note), place);
    }
    for note in &answer.notes {
        let is_usual = report::is_general(note) || USUAL_NOTES.contains(&note.code);
        let place = if is_usual { Place::Page } else { Place::Room };
        add(format!("Note: {}.", note.message), fresh(theme.note), place);
    }
    all
}

/// Why the results belong to an earlier state of the form: the cause, then the fix.
fn faults(pane: &Results<'_>) -> Vec<String> {
    let key = NEXT_FAULT;
    if let Some(refusal) = pane.refusal {
        return vec![
            format!("! Not solved: {refusal}."),
            format!("Correction: {} ({key}).", refusal.fix()),
        ];
    }
    let rows: BTreeSet<usize> = pane.problems.iter().map(|(row, _)| *row).collect();
    let Some((row, problem)) = pane.problems.iter().min_by_key(|(row, _)| *row) else {
        return Vec::new();
    };
    if rows.len() > 1 && rows.iter().all(|&row| rows::lacks(pane.case, row)) {
        return vec![format!("! {} required values are missing ({key})", rows.len())];
    }
    let (symbol, label) = rows::names_of(pane.case, *row);
    let name = format!("{symbol} {label}");
    let more = if rows.len() > 1 { format!("; {} more", rows.len() - 1) } else { String::new() };
    vec![format!("! {}: {}{more} ({key})", name.trim_start(), problem.cause)]
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

fn title(pane: &Results<'_>, count: usize, rows: usize) -> String {
    let name = if pane.shows_last_valid() { "Results: LAST VALID" } else { "Results" };
    let top = pane.state.top;
    let position = (0 < rows && rows < count)
        .then(|| format!(" {}-{}/{count}", top + 1, (top + rows).min(count)));
    let base = match (pane.variants, pane.baseline) {
        (Some(_), _) => Some(", variants".to_owned()),
        (None, baseline) => baseline.map(|baseline| format!(", against {}", baseline.name)),
    };
    let pending = pane.answer.and_then(|answer| answer.pending);
    let pending = pending.map(|method| format!(", {} pending", method.name()));
    let cost = pane.answer.filter(|_| pane.shows_cost).map(|answer| answer.cost);
    let cost = cost.map(|cost| format!(", {} stages in {} us", cost.stages, cost.micros));
    let method = pane.answer.filter(|_| !pane.has_header() || pane.variants.is_some());
    let method = method.map(|answer| format!(" by {}", answer.active.name()));
    let parts = [position, method, base, pending, cost].into_iter().flatten();
    name.to_owned() + &parts.collect::<String>()
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
/// A longer input of a variant is cut.
const LONGEST_INPUT: usize = 9;
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
    /// The styles of the heading and of the cells.
    styles: [Style; 2],
}

/// The rank of the case beside its variants.
const OF_CASE: usize = 1;
/// The rank of the units, which are cut but not removed.
const UNITS: usize = 2;
/// The rank of the names.
const NAMES: usize = 90;

impl Column {
    fn words(rank: usize, least: usize, room: usize, cells: Vec<String>, style: Style) -> Column {
        let heading = String::new();
        Column { rank, least, heading, cells, room, is_number: false, styles: [style; 2] }
    }

    fn numbers(rank: usize, heading: String, cells: Vec<String>, styles: [Style; 2]) -> Column {
        Column { rank, least: usize::MAX, heading, cells, room: NUMBER, is_number: true, styles }
    }

    fn width(&self) -> usize {
        let texts = self.cells.iter().filter(|_| self.rank != UNITS).chain([&self.heading]);
        texts.map(|text| text::width(text)).max().unwrap_or(0).max(self.room)
    }
}

/// The visible quantities: those of the method, the most important ones first and those without a
/// value last. The free impact beside a method that resolves the impact is folded away unless
/// every method is shown.
fn order(pane: &Results<'_>, answer: &Answer) -> Vec<&'static Quantity> {
    let methods = || answer.methods.iter().map(|(method, _)| *method);
    let stages = methods().fold(Stages::NONE, |stages, method| stages.and(method.stages()));
    let has_friction = answer.inputs.friction_coefficient.is_some();
    let has_slices = answer.inputs.face().is_some();
    let is_folded = answer.active.shares_load() && !pane.shows_every_method;
    let first = FIRST.iter().filter_map(|key| Quantity::find(key));
    let rest = report::quantities(answer.active).filter(|quantity| {
        let is_open = match quantity.needs {
            Need::Friction => has_friction,
            Need::Slices => has_slices,
            _ => true,
        };
        is_open && !FIRST.contains(&quantity.key)
    });
    let listed = first.chain(rest).filter(|quantity| {
        stages.has(quantity.stage) && !(is_folded && quantity.is_of_free_impact())
    });
    let has_value =
        |quantity: &&Quantity| methods().any(|method| value(answer, method, quantity).is_some());
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
pub(crate) fn variants_page(pane: &Results<'_>) -> usize {
    let shown = pane.answer.map(|answer| fitting(pane, answer, &pane.listed(), pane.page()));
    let is_variant = |column: &&Column| !column.heading.is_empty() && column.rank != OF_CASE;
    shown.map_or(1, |shown| shown.iter().filter(is_variant).count().max(1))
}

/// The value of the quantity, and of every variant or of the baseline, with the method of the
/// baseline if it differs.
pub(crate) fn compared(pane: &Results<'_>, quantity: &'static Quantity) -> Option<String> {
    let answer = pane.answer?;
    if let Some((variants, _)) = pane.variants {
        let own = value(answer, answer.active, quantity);
        let unit = report::common_unit(quantity, own.into_iter(), pane.units);
        let case = own.map(|own| report::shown_with(quantity, own, unit).to_string());
        let of_variant = |(name, found): &(String, Result<Solution, String>)| {
            let [value, by] = variant_cell(found, quantity, (own, answer.active, unit));
            if by.is_empty() { format!("{name} {value}") } else { format!("{name} {value} ({by})") }
        };
        let variants: Vec<String> = variants.columns.iter().map(of_variant).collect();
        let case = case.unwrap_or_else(|| NONE.to_owned());
        return Some(format!("Case {case}; {}.", variants.join("; ")));
    }
    let (method, base) = base(pane, answer, quantity);
    let active = pane.baseline?.answer.active;
    let printed = |value: Option<f64>| match value {
        Some(value) => report::shown_in(quantity, value, pane.units).to_string(),
        None => "none".to_owned(),
    };
    let is_same = method == answer.active && method == active;
    let whose = if is_same { String::new() } else { format!(" ({})", method.name()) };
    let own = printed(value(answer, answer.active, quantity));
    let base = match base {
        None if !pane.baseline?.answer.has(answer.active, quantity.stage) => NOT_SOLVED.to_owned(),
        base => printed(base),
    };
    Some(format!("{own}; baseline{whose}: {base}."))
}

/// The columns of the visible rows that fit, each after a blank. Texts have the room of all rows, so
/// that columns do not move; variants need all the room.
fn fitting(
    pane: &Results<'_>,
    answer: &Answer,
    listed: &[&'static Quantity],
    rows: usize,
) -> Vec<Column> {
    let mut columns = columns(pane, answer, listed, rows);
    if pane.variants.is_some() {
        for column in &mut columns {
            column.room = if column.rank == UNITS { column.room } else { 0 };
        }
    }
    loop {
        let taken: usize = columns.iter().map(|column| column.width() + 1).sum();
        let over = taken.saturating_sub(pane.area.width.into());
        let is_cut = |column: &Column| column.rank == UNITS && column.width() <= column.least;
        let left = columns.iter().enumerate().filter(|(_, column)| !is_cut(column));
        let last = left.max_by_key(|(_, column)| column.rank);
        let Some((at, last)) = last.filter(|(_, last)| over > 0 && last.rank > 0) else {
            return columns;
        };
        let least = if last.rank == UNITS { last.least } else { 0 };
        let room = last.width().saturating_sub(over).max(least);
        if room >= last.least {
            // The symbol tells the method.
            let short = |cell: &str| {
                let stripped =
                    ["static: ", "dynamic: "].iter().find_map(|by| cell.strip_prefix(by));
                text::cut(stripped.unwrap_or(cell), room)
            };
            if last.rank != UNITS || pane.variants.is_some() {
                columns[at].cells.iter_mut().for_each(|cell| *cell = short(cell));
            }
            columns[at].room = room;
        } else {
            columns.remove(at);
        }
    }
}

fn columns(
    pane: &Results<'_>,
    answer: &Answer,
    all: &[&'static Quantity],
    rows: usize,
) -> Vec<Column> {
    let (theme, active) = (pane.look.theme, answer.active);
    let known: Vec<_> = all.iter().copied().skip(pane.state.top).take(rows).collect();
    // Results of `static` are among the rows of `dynamic`.
    let shows_others = pane.shows_every_method && pane.variants.is_none();
    let is_shown = |method: Method| {
        let is_among_rows = active == Method::Dynamic && method == Method::Static;
        method == active || (shows_others && !is_among_rows)
    };
    let methods = answer.methods.iter().map(|(method, _)| *method);
    let methods: Vec<Method> = methods.filter(|method| is_shown(*method)).collect();
    let variants = pane.variants.map_or(&[][..], |(variants, _)| &variants.columns);
    let unit = |quantity: &&'static Quantity| {
        let of_methods = methods.iter().filter_map(|&method| value(answer, method, quantity));
        let of_variants = variants
            .iter()
            .filter_map(|(_, found)| value_as_in(quantity, found.as_ref().ok()?, active));
        report::common_unit(quantity, of_methods.chain(of_variants), pane.units)
    };
    let units: Vec<&str> = known.iter().map(unit).collect();
    let own = |at: usize| value(answer, active, known[at]);
    let number = |at: usize, value: Option<f64>| {
        let shown = |value| report::shown_with(known[at], value, units[at]).number;
        value.map_or_else(|| NONE.to_owned(), shown)
    };
    let cells = |cell: &dyn Fn(usize) -> String| (0..known.len()).map(cell).collect::<Vec<_>>();
    let words = |rank, least, style, text: &dyn Fn(&'static Quantity) -> Cow<'static, str>| {
        let room = all.iter().map(|quantity| text::width(&text(quantity))).max().unwrap_or(0);
        Column::words(rank, least, room, cells(&|at| text(known[at]).into_owned()), style)
    };
    let symbols = |of: &'static Quantity| symbol(of.symbol_in(active), pane.look.ascii);
    let symbols = words(0, 0, Style::new(), &symbols);
    // In a narrow pane the difference from the baseline leaves room for the symbols or for the names.
    let is_narrow = pane.area.width < WIDE;
    let gives_way = is_narrow && pane.baseline.is_some() && pane.variants.is_none();
    let rank = if gives_way { NAMES + 1 } else { 0 };
    let mut columns = vec![
        Column { room: symbols.room.min(SYMBOL), rank, least: usize::MAX, ..symbols },
        words(NAMES, 9, Style::new(), &|of| label(of, active)),
    ];
    for (at, &method) in methods.iter().enumerate() {
        let numbers = cells(&|at| number(at, value(answer, method, known[at])));
        let (rank, heading, styles) = match pane.variants {
            Some(_) => (OF_CASE, "case".to_owned(), [theme.active, theme.focus]),
            None if method == active => {
                (0, format!("▸{}", method.name()), [theme.active, theme.focus])
            }
            // The fastest method, which is the least accurate one, is removed first.
            None => (50 - at, method.name().to_owned(), [theme.other, Style::new()]),
        };
        columns.push(Column::numbers(rank, heading, numbers, styles));
    }
    let of_unit = |at: usize| {
        let has_value = methods.iter().any(|&method| value(answer, method, known[at]).is_some());
        let has_unit = has_value && !known[at].is_flag();
        let unit = if has_unit { named(units[at]) } else { "" };
        let mark =
            if pane.variants.is_some() { "" } else { mark(pane, answer, known[at], units[at]) };
        [unit, mark].join(" ").trim().to_owned()
    };
    let of_units = cells(&of_unit);
    let width = |of: &&'static Quantity| text::width(named(unit(of)));
    let room = match pane.variants {
        Some(_) => known.iter().map(width).max().unwrap_or(0),
        None if is_narrow => UNIT + MARK,
        None => all.iter().map(width).max().unwrap_or(0) + MARK,
    };
    columns.push(Column::words(UNITS, 5, room, of_units, Style::new()));
    if let Some((variants, first)) = pane.variants {
        let plain = [theme.other, Style::new()];
        for (at, (name, found)) in variants.columns.iter().skip(first).enumerate() {
            let pair = |at: usize| variant_cell(found, known[at], (own(at), active, units[at]));
            let (values, differences) =
                (0..known.len()).map(pair).map(|[now, by]| (now, by)).unzip();
            // The difference of the first variant gives way to its value and to the case.
            let ranks = if at == 0 { [0, UNITS + 1] } else { [UNITS + 2 * at, UNITS + 2 * at + 1] };
            let name = text::cut(name, LONGEST_NAME);
            columns.push(Column::numbers(ranks[0], name, values, plain));
            columns.push(Column::numbers(ranks[1], String::new(), differences, plain));
        }
    } else if pane.baseline.is_some() {
        let is_solved =
            |at: usize| pane.baseline.is_some_and(|base| base.answer.has(active, known[at].stage));
        let difference = |at: usize| match (own(at), base(pane, answer, known[at]).1) {
            (Some(now), Some(base)) => difference(known[at], now, base, units[at]),
            (None, Some(base)) => format!("was {}", number(at, Some(base))),
            (Some(_), None) if is_solved(at) => "was none".to_owned(),
            (Some(_), None) => NOT_SOLVED.to_owned(),
            (None, None) => String::new(),
        };
        let heading = "baseline".to_owned();
        columns.push(Column::numbers(1, heading, cells(&difference), [theme.baseline; 2]));
    } else {
        columns.push(words(99, 12, theme.faint, &|of| of.equation.into()));
    }
    add_inputs(pane, &mut columns);
    columns
}

/// Inserts the differing inputs of the variants above the quantities.
fn add_inputs(pane: &Results<'_>, columns: &mut [Column]) {
    for (row, (field, texts)) in inputs(pane).iter().enumerate() {
        let unit = units::split(&texts[0], "").map_or("", |(_, unit)| unit);
        let is_alike = texts.iter().all(|text| text.ends_with(unit));
        let value = |text: &String| {
            let text = text.strip_suffix(unit).filter(|_| is_alike).unwrap_or(text);
            text::cut(&sanitize(text.trim_end()), LONGEST_INPUT)
        };
        let Field { symbol: own, label, .. } = &FIELDS[*field];
        let names = [symbol(own, pane.look.ascii).into_owned(), (*label).to_owned()];
        let unit = if is_alike { unit.to_owned() } else { String::new() };
        let first = pane.variants.map_or(0, |(_, first)| first);
        let others = texts.iter().skip(1 + first).flat_map(|text| [value(text), String::new()]);
        let cells = names.into_iter().chain([value(&texts[0]), unit]).chain(others);
        columns.iter_mut().zip(cells).for_each(|(column, cell)| column.cells.insert(row, cell));
    }
}

/// The first fields that differ between the case and its variants, with the text of each.
fn inputs(pane: &Results<'_>) -> Vec<(usize, Vec<String>)> {
    const MOST: usize = 3;
    let Some((variants, _)) = pane.variants else { return Vec::new() };
    let own = pane.case;
    let of_variant = |(name, _): &(String, _)| own.variant(name).map(|variant| own.with(variant));
    let cases = variants.columns.iter().map(|column| of_variant(column).unwrap_or(own.clone()));
    let cases: Vec<Case> = std::iter::once(own.clone()).chain(cases).collect();
    let text = |case: &Case, field: usize| case.effective(field).unwrap_or(NONE).to_owned();
    let texts = |field| cases.iter().map(|case| text(case, field)).collect::<Vec<_>>();
    let fields = (0..FIELDS.len()).filter(|field| !FIELDS[*field].table().is_empty());
    let differing = fields.map(|field| (field, texts(field)));
    differing.filter(|(_, texts)| texts.iter().any(|text| *text != texts[0])).take(MOST).collect()
}

/// The value of a quantity in a variant and its difference from the value of the case.
fn variant_cell(
    found: &Result<Solution, String>,
    quantity: &Quantity,
    (own, active, unit): (Option<f64>, Method, &'static str),
) -> [String; 2] {
    let Ok(found) = found else { return ["refused".to_owned(), String::new()] };
    let now = value_as_in(quantity, found, active).filter(|now| now.is_finite());
    let Some(now) = now else { return [NONE.to_owned(), String::new()] };
    let by = own.map_or_else(String::new, |own| difference(quantity, now, own, unit));
    [report::shown_with(quantity, now, unit).number, by]
}

// The mark of a quantity: above its limit, or changed.
fn mark(
    pane: &Results<'_>,
    answer: &Answer,
    quantity: &Quantity,
    unit: &'static str,
) -> &'static str {
    let Some(solution) = answer.of(answer.active).filter(|_| !pane.is_stale) else { return "" };
    let limit = pane.case.limits.iter().find(|limit| limit.quantity == quantity);
    let verdict = limit.map(|limit| verdict(limit, solution));
    if verdict.is_some_and(|verdict| verdict.standing == Standing::Exceeded) {
        return EXCEEDED;
    }
    // Whether the present visit of a field changed the printed value of the quantity.
    let Some(earlier) = pane.earlier else { return "" };
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
fn base(pane: &Results<'_>, answer: &Answer, quantity: &Quantity) -> (Method, Option<f64>) {
    let Some(Baseline { answer: base, .. }) = pane.baseline else { return (answer.active, None) };
    let of = |method| value_as_in(quantity, base.of(method)?, answer.active);
    let method = base.beside(answer.active);
    let other = (base.active, of(base.active).filter(|_| quantity.stage != Stage::Clearing));
    of(method).map_or(other, |found| (method, Some(found)))
}
