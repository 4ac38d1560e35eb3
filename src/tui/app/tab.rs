//! An open case: its document, its form, its results and its views; and the header with the names of
//! the open cases.

use std::path::PathBuf;

use ratatui::text::Span;

use super::panes::chart::ChartWork;
use super::panes::form::FormState;
use super::panes::results::ResultsState;
use super::panes::study::Study;
use super::panes::trade::Traded;
use crate::case::{Case, Document, FIELDS, Limit, Problem, Spread, Variant, fields};
use crate::model::inputs::Method;
use crate::model::{Inputs, Quantity, Refusal, Solution, Stage};
use crate::report::verdict::{Standing, Verdict};
use crate::study::relief::Demand;
use crate::tui::rows;
use crate::tui::session::{Access, OpenCase};
use crate::tui::settings::Theme;
use crate::tui::solver::{Answer, Request, Values, Variants, Wanted};
use crate::tui::text::{self, Line};

/// An open case.
#[derive(Debug, Clone)]
pub struct Tab {
    /// Unique among all tabs, including closed ones.
    pub id: usize,
    /// The text of the file, whose comments and order a save keeps.
    pub document: Document,
    /// The file from which it was read, or to which it was last saved.
    pub path: Option<PathBuf>,
    /// The origin of the case.
    pub origin: Origin,
    /// The case in the form.
    pub case: Case,
    /// The case at the time of a save that is still running.
    pub(crate) saving: Option<Case>,
    /// Whether the file may be written.
    pub(crate) access: Access,
    /// Whether another program changed the file after it was read.
    pub is_outdated: bool,
    /// The file that the user named and that could not be opened, if the built-in case replaces it.
    pub in_place_of: Option<PathBuf>,
    /// Focus, typed text and scrolling of the form.
    pub form: FormState,
    /// The undo history.
    pub(crate) history: History,
    /// The inputs of the valid fields, read again for each request.
    pub(crate) inputs_so_far: Inputs,
    /// The problems of the form.
    pub problems: Vec<(usize, Problem)>,
    /// The serial of the last request. No two tabs share a serial.
    pub serial: u64,
    /// The valid form of that request.
    pub(crate) valid: Option<Case>,
    /// The results of that request.
    pub(crate) requested: Wanted,
    /// Progress of a slow solve.
    pub(crate) solving: Option<f64>,
    /// Whether the worker has answered the request, with results or without.
    pub is_settled: bool,
    /// The last valid results.
    pub answer: Option<Answer>,
    /// The method that `auto` chose for the last complete results.
    pub(crate) chosen: Option<Method>,
    /// The values before the present visit of a field, in the order of the quantities.
    pub(crate) earlier: Option<Values>,
    /// Why the model refuses the case of the form.
    pub refusal: Option<Refusal>,
    /// Whether the worker failed on the case of the form.
    pub(crate) has_failed: bool,
    /// The benchmark.
    pub traded: Option<Traded>,
    /// The last typed demand on a relief.
    pub(crate) demand: Option<Demand>,
    /// The solved variants.
    pub(crate) variants: Option<Variants>,
    /// The study of the case.
    pub study: Study,
    /// The chart that the worker computes for the case.
    pub chart_work: ChartWork,
    /// Selection and scrolling of the results.
    pub results: ResultsState,
}

/// The origin of a case.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Origin {
    /// The file that the user named; the built-in case if there is no path.
    Given,
    /// The file of the last session, which the user did not name.
    LastCase,
    /// A new, empty case.
    New,
    /// A new case from the example with this name.
    Example(&'static str),
}

impl Tab {
    /// A document that was just opened, unsolved.
    pub(crate) fn new(document: Document, path: Option<PathBuf>) -> Tab {
        let case = document.case.clone();
        let focus = fields::index_of("pair.module").unwrap_or(0);
        Tab {
            id: 0,
            access: Access::of(&document),
            form: FormState::at(&case, focus),
            saving: None,
            inputs_so_far: case.read().0,
            case,
            document,
            path,
            origin: Origin::Given,
            is_outdated: false,
            in_place_of: None,
            history: History::default(),
            problems: Vec::new(),
            serial: 0,
            valid: None,
            requested: Wanted::NOTHING,
            solving: None,
            is_settled: false,
            answer: None,
            chosen: None,
            earlier: None,
            refusal: None,
            has_failed: false,
            traded: None,
            demand: None,
            variants: None,
            study: Study::default(),
            chart_work: ChartWork::default(),
            results: ResultsState::default(),
        }
    }

    /// The last request.
    pub fn request(&self) -> Request {
        let inputs = self.inputs_so_far.clone();
        Request { serial: self.serial, inputs, wanted: self.requested }
    }

    /// Whether a requested stage is not computed yet.
    pub fn lacks(&self, stage: Stage) -> bool {
        let lacks = |answer: &Answer| !answer.stages.has(stage);
        self.requested.stages.has(stage) && self.answer.as_ref().is_some_and(lacks)
    }

    /// Whether the work that may decide on a limit is not finished.
    pub(crate) fn awaits(&self, verdict: &Verdict<'_>) -> bool {
        let is_pending = self.answer.as_ref().is_some_and(|answer| answer.pending.is_some());
        let lacks = |quantity: &Quantity| self.lacks(quantity.stage);
        verdict.standing == Standing::Unknown
            && (is_pending || verdict.limit.quantities().any(lacks))
    }

    /// The inputs, if the form is valid.
    pub(crate) fn inputs(&self) -> Option<&Inputs> {
        self.problems.is_empty().then_some(&self.inputs_so_far)
    }

    /// The document with the edits of the form.
    pub(crate) fn as_edited(&self) -> Document {
        let mut document = self.document.clone();
        document.case = self.case.clone();
        document
    }

    /// Whether the form differs from the file by more than empty limits and distributions.
    pub fn is_unsaved(&self) -> bool {
        let without_empty = |case: &Case| {
            let mut case = case.clone();
            case.drop_empty(None);
            case
        };
        let saved = self.document.loaded();
        self.case != *saved && without_empty(&self.case) != without_empty(saved)
    }

    /// Whether the user neither named nor edited it, so that another case may replace it.
    pub(crate) fn is_untouched(&self) -> bool {
        (self.path.is_none() || self.origin == Origin::LastCase) && !self.is_unsaved()
    }

    /// Whether it is the built-in Table 1, with or without edits.
    pub(crate) fn is_built_in(&self) -> bool {
        self.path.is_none() && self.origin == Origin::Given
    }

    /// Whether the results are older than the form.
    pub fn is_stale(&self) -> bool {
        !self.problems.is_empty() || self.refusal.is_some() || self.has_failed
    }

    /// Whether the visible results belong to an earlier state of the form.
    pub(crate) fn shows_last_valid(&self) -> bool {
        self.is_stale() && self.answer.is_some()
    }

    /// The shown results of the active method.
    pub(crate) fn solution(&self) -> Option<&Solution> {
        self.answer.as_ref().and_then(|answer| answer.of(answer.active))
    }

    /// The results of the active method, if they are those of the form.
    pub(crate) fn present(&self) -> Option<&Solution> {
        self.solution().filter(|_| !self.is_stale())
    }

    /// The row that the fix of the model's refusal names first; of two fields that exclude each
    /// other, the one with a value.
    pub(crate) fn refused_row(&self) -> Option<usize> {
        let field = fields::index_of(fields::key_of(self.refusal?.at()))?;
        let partner = fields::FIELDS[field].partner();
        let other = partner.filter(|&other| self.case.text(other).is_some());
        Some(other.filter(|_| self.case.text(field).is_none()).unwrap_or(field))
    }

    /// The state of the case for the autosave.
    pub(crate) fn sheet(&self) -> OpenCase<'_> {
        let path = self.document.path().or(self.path.as_deref()).filter(|_| self.path.is_some());
        let is_held = matches!(self.access, Access::Held(_));
        OpenCase { id: self.id, path, document: &self.document, case: &self.case, is_held }
    }

    /// The marks beside the name of the case.
    pub(crate) fn marks(&self) -> String {
        let outdated = if self.is_outdated { " *changed on disk*" } else { "" };
        format!("{outdated}{}", self.access.mark())
    }

    /// The name of the case in the title and in questions.
    pub(crate) fn name(&self) -> String {
        match (&self.path, self.origin) {
            (Some(path), _) => path.display().to_string(),
            (None, Origin::Example(example)) => format!("new case from {example}"),
            (None, Origin::New) => "new case".to_owned(),
            (None, Origin::Given | Origin::LastCase) => "built-in Table 1".to_owned(),
        }
    }

    /// The name without its folders.
    pub fn short_name(&self) -> String {
        let file = self.path.as_ref().and_then(|path| path.file_name());
        file.map_or_else(|| self.name(), |name| name.to_string_lossy().into_owned())
    }

    /// Stores the state before an edit of a row, with its results.
    pub(crate) fn before_edit(&mut self, row: usize) {
        self.form.added_from = None;
        if self.history.before_edit(&self.case, self.form.focus, row) {
            self.remember();
        }
    }

    /// Stores the values, so that later changes can be marked.
    pub(crate) fn remember(&mut self) {
        self.earlier = self.answer.as_ref().map(Answer::values);
    }

    /// Focuses a row of the form, with the cursor at the end of its text. Leaving an empty limit or
    /// distribution removes it.
    pub(crate) fn focus_on(&mut self, at: usize) {
        let at = at.min(rows::count(&self.case) - 1);
        let entry = rows::row(&self.case, at).entry();
        self.case.drop_empty(entry);
        let focus = entry.and_then(|key| rows::of_entry(&self.case, key)).unwrap_or(at);
        self.form = FormState { top: self.form.top, ..FormState::at(&self.case, focus) };
        self.history.end_visit();
    }

    /// Reads the text of the focused row from the case, as when the user leaves the row.
    pub(crate) fn read_line_anew(&mut self) {
        let text = rows::text(&self.case, self.form.focus).unwrap_or_default();
        if text != self.form.input.value() {
            self.form.input = Line::whole(text);
        }
    }

    /// Shows an answer to the present request.
    pub(crate) fn take(&mut self, mut answer: Answer) {
        self.has_failed = false;
        self.is_settled = answer.pending.is_none();
        self.solving = self.solving.filter(|_| !self.is_settled);
        self.refusal = answer.refusal().copied();
        if self.refusal.is_none() {
            if answer.stiffness.is_none() && self.requested.stiffness {
                // The chart keeps its curves until the new ones are computed.
                answer.stiffness = self.answer.take().and_then(|earlier| earlier.stiffness);
            }
            if self.is_settled {
                let is_auto = answer.inputs.method == Method::Auto;
                self.chosen = Some(answer.active).filter(|_| is_auto);
            }
            self.answer = Some(answer);
        }
    }
}

/// The header in a width: the open cases with their numbers, as many from the current one on and then
/// before it as fit; a single case with its path and title. Each part with the index of its case.
pub(crate) fn header(
    tabs: &[&Tab],
    current: usize,
    theme: &Theme,
    width: u16,
) -> Vec<(Option<usize>, Span<'static>)> {
    const HEAD: &str = "tipstrike";
    const OTHER_TEXT: usize = 15;
    const LONGEST_NAME: usize = 24;
    let mut spans = vec![Span::styled(HEAD, theme.title), Span::raw("  ")];
    if let [tab] = tabs {
        let is_last = tab.origin == Origin::LastCase;
        let last = if is_last { " (last case; Alt-T: Table 1)" } else { "" };
        let unsaved = if tab.is_unsaved() { " *unsaved*" } else { "" };
        let mark = format!("{unsaved}{}{last}", tab.marks());
        let room = usize::from(width).saturating_sub(HEAD.len() + 2 + text::width(&mark));
        let instead = tab.in_place_of.as_ref();
        let instead = instead.map(|path| format!(" ({} cannot be opened)", path.display()));
        let name = text::cut(&format!("{}{}", tab.name(), instead.unwrap_or_default()), room);
        let left = room.saturating_sub(text::width(&name) + 3);
        let title = Some(tab.case.title()).filter(|title| !title.is_empty() && left > 8);
        let title = title.map(|title| format!("   {}", text::cut(title, left)));
        let title = Span::raw(title.unwrap_or_default());
        spans.extend([Span::raw(name), Span::styled(mark, theme.note), title]);
        return spans.into_iter().map(|span| (None, span)).collect();
    }
    let name = |(at, tab): (usize, &&Tab)| {
        let (name, marks) = (text::cut(&tab.short_name(), LONGEST_NAME), tab.marks());
        let text = format!("{} {name}{}{marks}", at + 1, if tab.is_unsaved() { "*" } else { "" });
        if at == current {
            Span::styled(format!("[{text}]"), theme.key)
        } else {
            Span::raw(format!(" {text} "))
        }
    };
    let names: Vec<Span<'_>> = tabs.iter().enumerate().map(name).collect();
    let room = usize::from(width).saturating_sub(OTHER_TEXT);
    let fits =
        |from: usize, to: usize| names[from..to].iter().map(Span::width).sum::<usize>() <= room;
    let to = (current + 1..=names.len()).rev().find(|&to| fits(current, to));
    let to = to.unwrap_or(current + 1);
    let from = (0..current).find(|&from| fits(from, to)).unwrap_or(current);
    spans.push(Span::raw(if from > 0 { "‹ " } else { "" }));
    let after = Span::raw(if to < names.len() { " ›" } else { "" });
    let shown = names.into_iter().enumerate().take(to).skip(from);
    let shown = shown.map(|(at, name)| (Some(at), name));
    spans.into_iter().map(|span| (None, span)).chain(shown).chain([(None, after)]).collect()
}

/// States of a case, each with the field that had the focus.
#[derive(Debug, Clone, Default)]
pub(crate) struct History {
    past: States,
    future: States,
    /// The edited row, until its visit ends.
    visited: Option<usize>,
}

impl History {
    /// Stores the state before the first edit of a visit to a row. Returns whether it is the first
    /// edit.
    pub(crate) fn before_edit(&mut self, case: &Case, focus: usize, row: usize) -> bool {
        let is_first = self.visited != Some(row);
        if is_first {
            self.past.push(case, focus);
            self.visited = Some(row);
        }
        self.future = States::default();
        is_first
    }

    /// The case before the first edit of this visit.
    pub(crate) fn before_visit(&self) -> Option<&Case> {
        self.past.last.as_ref().filter(|_| self.visited.is_some()).map(|(case, _)| case)
    }

    /// Whether a row was edited in this visit.
    pub(crate) fn is_visited(&self, row: usize) -> bool {
        self.visited == Some(row)
    }

    /// Ends the visit: the next edit stores a new state.
    pub(crate) fn end_visit(&mut self) {
        self.visited = None;
    }

    /// Exchanges the present state for the previous one, or for the undone one.
    pub(crate) fn travel(
        &mut self,
        case: &Case,
        focus: usize,
        forwards: bool,
    ) -> Option<(Case, usize)> {
        let (from, to) = if forwards {
            (&mut self.future, &mut self.past)
        } else {
            (&mut self.past, &mut self.future)
        };
        let state = from.pop()?;
        to.push(case, focus);
        Some(state)
    }
}

/// The last state in full, and each earlier state as its difference from the next, so that a long
/// session stays small.
#[derive(Debug, Clone, Default)]
struct States {
    last: Option<(Case, usize)>,
    before: Vec<(Difference, usize)>,
}

/// The fields, limits and spreads in which a case differs from another.
#[derive(Debug, Clone)]
struct Difference {
    texts: Box<[(usize, Box<str>)]>,
    /// Limits, spreads, variants and `[about]`, which seldom change.
    others: Option<Box<Others>>,
}

type Others = (Vec<Limit>, Vec<Spread>, Vec<Variant>, Vec<(String, String)>);

impl States {
    fn push(&mut self, case: &Case, focus: usize) {
        if let Some((last, at)) = self.last.replace((case.clone(), focus)) {
            self.before.push((Difference::of(&last, case), at));
        }
    }

    fn pop(&mut self) -> Option<(Case, usize)> {
        let state = self.last.take()?;
        self.last =
            self.before.pop().map(|(difference, at)| (difference.put_into(state.0.clone()), at));
        Some(state)
    }
}

impl Difference {
    /// The difference of `case` from `other`.
    fn of(case: &Case, other: &Case) -> Difference {
        let fields = (0..FIELDS.len()).filter(|&field| case.text(field) != other.text(field));
        let texts = fields.map(|field| (field, case.text(field).unwrap_or_default().into()));
        let others = Box::new(others_of(case));
        Difference {
            texts: texts.collect(),
            others: (*others != others_of(other)).then_some(others),
        }
    }

    /// The case, from the other one and the difference.
    fn put_into(self, mut other: Case) -> Case {
        for (field, text) in self.texts {
            other.write(field, &text);
        }
        if let Some(others) = self.others {
            (other.limits, other.spread, other.variants, other.about) = *others;
        }
        other
    }
}

// The parts of a case other than its fields.
fn others_of(case: &Case) -> Others {
    (case.limits.clone(), case.spread.clone(), case.variants.clone(), case.about.clone())
}

#[cfg(test)]
mod tests {
    use super::*;

    fn states() -> Vec<Case> {
        let edited = |case: &Case, change: &dyn Fn(&mut Case)| {
            let mut case = case.clone();
            change(&mut case);
            case
        };
        let first = Case::table_1();
        let second = edited(&first, &|case| case.write(3, "6 mm"));
        let third = edited(&second, &|case| case.set_limit("friction_ratio", "0.5").unwrap());
        let fourth = edited(&third, &|case| {
            case.spread.push(Spread::new("pair.module", "normal 4 um").unwrap());
        });
        let fifth = edited(&fourth, &|case| {
            (0..9).for_each(|field| case.write(field, ""));
        });
        let sixth = edited(&fifth, &|case| case.about.push(("project".to_owned(), "A".to_owned())));
        vec![first, second, third, fourth, fifth, sixth]
    }

    #[test]
    fn undo_restores_every_state_in_order() {
        let states = states();
        let (mut history, last) = (History::default(), states.len() - 1);
        for (focus, state) in states[..last].iter().enumerate() {
            assert!(history.before_edit(state, focus, focus));
            assert_eq!(history.before_visit(), Some(state));
            history.end_visit();
        }
        for _ in 0..2 {
            for at in (0..last).rev() {
                let undone = history.travel(&states[at + 1], at + 1, false);
                assert_eq!(undone, Some((states[at].clone(), at)));
            }
            assert_eq!(history.travel(&states[0], 0, false), None);
            for at in 1..=last {
                let redone = history.travel(&states[at - 1], at - 1, true);
                assert_eq!(redone, Some((states[at].clone(), at)));
            }
            assert_eq!(history.travel(&states[last], last, true), None);
        }
    }

    #[test]
    fn a_state_stores_only_its_difference() {
        let mut history = History::default();
        let mut case = Case::table_1();
        for number in 0..1000 {
            history.before_edit(&case, 0, 0);
            history.end_visit();
            case.write(0, &format!("title {number}"));
        }
        assert!(history.past.before.iter().all(|(difference, _)| difference.texts.len() == 1));
        assert_eq!(history.past.before.len(), 999);
    }
}
