//! The results pane: faults, verdict, limits, figures and notes as sentences above the table of
//! quantities.

mod table;

use std::collections::BTreeSet;

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Position, Rect};
use ratatui::style::Style;
use ratatui::text::{Line, Text};
use ratatui::widgets::{StatefulWidget, TableState, Widget};

use super::Title;
use crate::case::units::System;
use crate::case::{Case, Problem};
use crate::model::inputs::Method;
use crate::model::{Quantity, Refusal, Solution, Stage};
use crate::report::verdict::{Verdict, verdicts};
use crate::report::{self, digest};
use crate::tui::layout::NEXT_FAULT;
use crate::tui::rows;
use crate::tui::solver::{Answer, Baseline, Values, Variants};
use crate::tui::text;
use crate::tui::text::symbol;
use crate::tui::theme::Look;

pub(crate) use table::{compared, label};

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
    #[must_use]
    pub fn listed(&self) -> Vec<&'static Quantity> {
        self.answer.map_or_else(Vec::new, |answer| table::order(self, answer))
    }

    /// The selected line among the quantities.
    fn row(&self) -> usize {
        let is_selected = |quantity: &&Quantity| Some(quantity.key) == self.state.selected;
        self.listed().iter().position(is_selected).unwrap_or(0)
    }

    /// The selected quantity.
    #[must_use]
    pub fn marked(&self) -> Option<&'static Quantity> {
        self.listed().get(self.row()).copied()
    }

    /// The number of visible quantities.
    #[must_use]
    pub fn page(&self) -> usize {
        parts(self).1
    }

    /// The state with the selection `by` quantities further.
    #[must_use]
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
    #[must_use]
    pub(crate) fn scrolled(&self, by: isize) -> usize {
        let last = self.listed().len().saturating_sub(self.page());
        self.state.top.saturating_add_signed(by).min(last)
    }

    /// The first visible line such that the selected quantity is visible.
    pub(crate) fn top_for(&self) -> usize {
        let (rows, row) = (self.page().max(1), self.row());
        let least = (row + 1).saturating_sub(rows);
        let last = self.listed().len().saturating_sub(rows);
        self.state.top.clamp(least, row.max(least)).min(last)
    }

    /// The key of the quantity at a cell, if any.
    pub(crate) fn key_at(&self, at: Position) -> Option<&'static str> {
        let (head, rows) = parts(self);
        let above = head.len() + 1 + usize::from(self.has_header());
        let line = usize::from(at.y - self.area.y).checked_sub(above)?;
        let listed = self.listed();
        listed.get(self.state.top + line).filter(|_| line < rows).map(|quantity| quantity.key)
    }

    /// The number of variants that fit side by side.
    #[must_use]
    pub(crate) fn variants_page(&self) -> usize {
        table::variants_page(self)
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
    let inner = pane.title.draw(&title(pane, rows), pane.area, buffer);
    let [above, body] =
        Layout::vertical([Constraint::Length(head.len() as u16), Constraint::Fill(1)]).areas(inner);
    // The first column has the mark of the selected row.
    let [_, above] = Layout::horizontal([Constraint::Length(1), Constraint::Fill(1)]).areas(above);
    Text::from(head).render(above, buffer);
    let Some(answer) = pane.answer else { return };
    let (row, top) = (pane.row(), pane.state.top);
    let is_marked = pane.title.has_focus && (top..top + rows).contains(&row);
    let mut state = TableState::new().with_offset(top).with_selected(is_marked.then_some(row));
    StatefulWidget::render(table::table(pane, answer), body, buffer, &mut state);
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
    let height = height.saturating_sub(usize::from(pane.has_header()));
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
    let notes = match hidden {
        0 => None,
        1 => Some(format!("1 note ({}n)", pane.title.leave())),
        _ => Some(format!("{hidden} notes ({}n)", pane.title.leave())),
    };
    let folded = pane.answer.and_then(|answer| folded(pane, answer));
    let last: Vec<String> = notes.into_iter().chain(folded).collect();
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
#[must_use]
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
        let pending = is_pending.then_some(answer.inputs.driven.tip_relief);
        let verdict = digest::sentence(solution, pane.units, pending);
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
    for note in &answer.notes {
        let is_usual = report::is_general(note) || USUAL_NOTES.contains(&note.code);
        let place = if is_usual { Place::Page } else { Place::Room };
        add(format!("Note: {}.", note.message), fresh(theme.note), place);
    }
    for (name, found) in pane.variants.into_iter().flat_map(|(variants, _)| &variants.columns) {
        if let Err(reason) = found {
            let text = format!("Note: variant {name} is refused: {reason}.");
            add(text, fresh(theme.note), Place::Room);
        }
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

fn title(pane: &Results<'_>, rows: usize) -> String {
    let name = if pane.shows_last_valid() { "Results: LAST VALID" } else { "Results" };
    let (count, top) = (pane.listed().len(), pane.state.top);
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
    let method = pane.answer.filter(|_| !pane.has_header());
    let method = method.map(|answer| format!(" by {}", answer.active.name()));
    let parts = [position, method, base, pending, cost].into_iter().flatten();
    name.to_owned() + &parts.collect::<String>()
}
