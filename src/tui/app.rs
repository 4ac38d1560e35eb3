//! The state of the workbench: plain data that only `update` changes, its requests to the solver and
//! to other work, and the panes with the state that they show.

pub(crate) mod actions;
pub(crate) mod dialogs;
pub(crate) mod panes;
pub(crate) mod tab;

use std::cell::Cell;
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};
use std::sync::{Arc, Mutex, PoisonError};
use std::time::{Duration, Instant};

use ratatui::layout::Size;
use ratatui::text::Span;

use super::layout::{Layout, Pane, Place};
use super::rows;
use super::session::{Access, NEWER, OpenCase};
use super::settings::{Look, Settings};
use super::solver::{self, Answer, Baseline, Request, Wanted};
use super::store::WatchedFile;
use super::text;
use crate::case::{Case, Document, Evaluator, Problem};
use crate::model::inputs::Method;
use crate::model::{Stage, Stages};
use crate::report::stations::GRAPHS;
use crate::study::trade::STEADY;
use panes::chart::{ChartPane, Charts};
use panes::teeth::TeethView;
use tab::{Tab, header};

use actions::{Effect, Slot, Work};
use dialogs::Prompt;

/// A solve that takes longer shows its progress.
const LONG: Duration = Duration::from_millis(400);
/// Time between two reports of the progress.
const PROGRESS_STEP: Duration = Duration::from_millis(200);

/// The whole state of the screen.
#[derive(Debug, Clone)]
#[expect(clippy::struct_excessive_bools, reason = "the flags are independent")]
pub struct App {
    /// The current case.
    pub tab: Tab,
    /// The other open cases, in their order.
    pub others: Vec<Tab>,
    /// Number of the other tabs before the current one.
    pub(crate) place_of_tab: usize,
    /// Identifier of the newest tab.
    pub(crate) last_id: usize,
    /// Serial of the newest request, over all cases.
    pub(crate) last_serial: u64,
    /// The visible panes and their areas.
    pub layout: Layout,
    /// Whether letters go into the focused field while the form has the focus.
    pub(crate) is_editing: bool,
    /// The pinned results for comparison.
    pub baseline: Option<Baseline>,
    /// Whether to pin the results as soon as they are complete.
    pub(crate) is_pinning: bool,
    /// Whether results and charts show the free impact and the other methods beside the method of
    /// the case.
    pub(crate) shows_every_method: bool,
    /// Whether the results show the run time of each stage.
    pub(crate) shows_cost: bool,
    /// Whether the trade pane shows its table.
    pub(crate) is_trade_table: bool,
    /// The cursor of charts and teeth: the driver's roll angle before E, in rad, negative after E.
    pub cursor: Option<f64>,
    /// The view of the teeth pane.
    pub(crate) teeth: TeethView,
    /// The state of the chart pane.
    pub chart: ChartPane,
    /// The first variant beside the case in the results; `None` while the methods are shown.
    pub first_variant: Option<usize>,
    /// The file of the running export.
    pub(crate) exporting: Option<PathBuf>,
    /// The serial of the case whose variants the worker solves.
    pub(crate) comparing: Option<u64>,
    /// The message before the present key.
    pub(super) last_message: Option<Message>,
    /// Whether the animation runs.
    pub is_playing: bool,
    /// How long a benchmark measures each setting.
    pub patience: Duration,
    /// The last solves, which the next solve uses again.
    evaluator: Arc<Mutex<Evaluator>>,
    /// The running work of each slot, by its number.
    running: BTreeMap<Slot, u64>,
    /// The effects of the present action.
    pub(super) effects: Effects,
    /// The dialogs over the panes, the topmost last.
    pub prompts: Vec<Prompt>,
    /// Whether the focused row of form or results may be outside the visible lines.
    pub(crate) needs_scroll: bool,
    /// The message of the last key; the next key removes it.
    pub message: Option<Message>,
    /// Settings for every case.
    pub settings: Settings,
    /// The capabilities of the terminal.
    pub look: Look,
}

/// Effects that wait for the end of the action.
#[derive(Debug, Default)]
pub(super) struct Effects(pub(super) Vec<Effect>);

/// A copy of the state, for a test, requests nothing.
impl Clone for Effects {
    fn clone(&self) -> Effects {
        Effects::default()
    }
}

/// A message, shown until the next key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// The text of the message.
    pub text: String,
    /// Whether it reports an error.
    pub(crate) is_fault: bool,
}

impl App {
    /// The workbench on a document that is not solved yet.
    pub(super) fn new(document: Document, path: Option<PathBuf>, look: Look, size: Size) -> App {
        let mut app = App {
            tab: Tab::new(document, path),
            others: Vec::new(),
            place_of_tab: 0,
            last_id: 0,
            last_serial: 0,
            layout: Layout::new(size),
            is_editing: true,
            baseline: None,
            is_pinning: false,
            shows_every_method: false,
            shows_cost: false,
            is_trade_table: false,
            cursor: None,
            teeth: TeethView::default(),
            chart: ChartPane::default(),
            first_variant: None,
            exporting: None,
            comparing: None,
            is_playing: false,
            patience: STEADY,
            evaluator: Arc::default(),
            running: BTreeMap::new(),
            effects: Effects::default(),
            prompts: Vec::new(),
            needs_scroll: false,
            message: None,
            last_message: None,
            settings: Settings::default(),
            look,
        };
        if app.tab.access == Access::Newer {
            app.complain(NEWER);
        }
        app.follow();
        app
    }

    /// The open cases in their order, including the current one.
    pub fn tabs(&self) -> impl Iterator<Item = &Tab> {
        let (before, after) = self.others.split_at(self.place_of_tab.min(self.others.len()));
        before.iter().chain(std::iter::once(&self.tab)).chain(after)
    }

    /// The parts of the header.
    pub(super) fn header(&self) -> Vec<(Option<usize>, Span<'static>)> {
        let tabs: Vec<&Tab> = self.tabs().collect();
        header(&tabs, self.place_of_tab, self.look.theme, self.layout.size.width)
    }

    /// The files of the open cases and their content.
    pub(super) fn files(&self) -> Vec<WatchedFile> {
        let file = |tab: &Tab| {
            let (path, target) = (tab.path.clone()?, tab.document.path()?.to_owned());
            Some(WatchedFile { path, target, stamp: tab.document.stamp() })
        };
        self.tabs().filter_map(file).collect()
    }

    /// The state of every open case for the autosave.
    pub fn sheets(&self) -> Vec<OpenCase<'_>> {
        self.tabs().map(Tab::sheet).collect()
    }

    /// The place that decides the meaning of keys.
    pub fn place(&self) -> Place {
        match self.prompts.last() {
            Some(prompt) => prompt.dialog().place(),
            None if !self.has_line() => self.place_of_pane(),
            None if !rows::names(&self.tab.case, self.tab.form.focus).is_empty() => Place::CHOICE,
            None if self.tab.form.input.kept() == 0 => Place::TEXT.or(Place::FRESH),
            None => Place::TEXT,
        }
    }

    fn place_of_pane(&self) -> Place {
        match self.layout.focus {
            Pane::Chart if self.charts().lacks_pattern() => Place::MISSING_CHART,
            Pane::Chart if self.chart.is_pattern() => Place::CHART.or(Place::PATTERN),
            Pane::Chart if self.chart.own_axes().is_some() => Place::OWN_CHART,
            Pane::Study if self.tab.study.state.is_tolerance => Place::TOLERANCE,
            pane => pane.place(),
        }
    }

    /// Whether typed letters go into the focused field.
    pub fn has_line(&self) -> bool {
        self.layout.focus == Pane::Form && self.is_editing
    }

    /// Whether a key would be the first of an edit that replaces the text of the focused row.
    pub(super) fn starts_new_edit(&self) -> bool {
        let Tab { form, history, .. } = &self.tab;
        let is_in_line = self.prompts.is_empty() && self.has_line();
        is_in_line && form.input.kept() == 0 && !history.is_visited(form.focus)
    }

    /// The completion of the typed text of the focused field: its unit, or the rest of a name.
    pub fn ending(&self) -> Option<String> {
        let Tab { case, form, .. } = &self.tab;
        if !self.has_line() {
            return None;
        }
        rows::ending(case, form.focus, form.input.value(), self.bare_unit(form.focus))
    }

    /// The unit that a bare number gets in a row: that of the focused value as it was written, otherwise
    /// the displayed unit.
    pub(crate) fn bare_unit(&self, row: usize) -> &str {
        let Tab { case, form, .. } = &self.tab;
        let written = form.written_unit.as_deref().filter(|_| form.focus == row);
        written.unwrap_or(rows::displayed_unit(case, row, self.settings.units))
    }

    /// A path for a message. Where a line has too little room, its folder is cut.
    pub(super) fn in_message(&self, path: &Path) -> String {
        /// Room for the words of the message.
        const WORDS: u16 = 20;
        let room = self.layout.size.width.saturating_sub(WORDS);
        text::cut_front(&path.display().to_string(), room.into())
    }

    /// Shows a message until the next key.
    pub(super) fn say(&mut self, text: impl Into<String>) {
        self.message = Some(Message { text: text.into(), is_fault: false });
    }

    /// Shows an error message until the next key.
    pub(super) fn complain(&mut self, text: impl Into<String>) {
        self.message = Some(Message { text: text.into(), is_fault: true });
    }

    /// Focuses a field, with the cursor at the end of its text.
    pub(super) fn focus_on(&mut self, field: usize) {
        self.tab.focus_on(field);
        self.follow();
    }

    /// Makes form and results scroll until the focused row and its problem are visible.
    pub(super) fn follow(&mut self) {
        self.needs_scroll = true;
    }

    /// The chart pane with its results.
    pub fn charts(&self) -> Charts<'_> {
        Charts(self)
    }

    /// The visible part of the results.
    pub(crate) fn wanted(&self) -> Wanted {
        let plan = self.layout.plan();
        let is_by_model = GRAPHS[self.chart.graph()].by_model.is_some();
        let stiffness = plan.shows(Pane::Chart) && is_by_model;
        let paper = self.shows_every_method || self.is_pinning;
        if self.is_pinning {
            return Wanted { stages: Stages::EVERY, stiffness, paper };
        }
        let seen = Pane::ALL.into_iter().filter(|&pane| plan.shows(pane));
        // The verdict with its notes is visible even if only the chart is: it needs all stages
        // except the stiffness spread and the late stages.
        let verdict = Pane::Results.needs().without(Stage::Band).except(Stages::LATE);
        let stages = seen.fold(verdict, |stages, pane| stages.and(pane.needs()));
        Wanted { stages, stiffness, paper }
    }

    /// Requests an effect.
    pub(super) fn want(&mut self, effect: Effect) {
        self.effects.0.push(effect);
    }

    /// Starts work, which replaces other work of its slot, and returns its number.
    pub(super) fn start(&mut self, work: Work) -> u64 {
        self.last_serial += 1;
        self.running.insert(work.slot, self.last_serial);
        self.want(Effect::Work(self.last_serial, work));
        self.last_serial
    }

    pub(super) fn start_all(&mut self, works: impl IntoIterator<Item = Work>) {
        for work in works {
            self.start(work);
        }
    }

    /// Stops the work of a slot and ignores its further results. Returns whether it ran.
    pub(super) fn cancel(&mut self, slot: Slot) -> bool {
        let has_run = self.running.remove(&slot).is_some();
        if has_run {
            self.want(Effect::Cancel(slot));
        }
        has_run
    }

    /// Marks work as ended.
    pub(super) fn end_work(&mut self, slot: Slot, number: u64) {
        self.running.retain(|own, running| *own != slot || *running != number);
    }

    /// Whether the work with this number is the running work of its slot.
    pub(crate) fn runs(&self, slot: Slot, number: u64) -> bool {
        self.running.get(&slot) == Some(&number)
    }

    /// Whether the benchmark of the current case runs.
    pub(crate) fn is_measuring(&self) -> bool {
        let traded = self.tab.traded.as_ref();
        traded.is_some_and(|traded| self.runs(Slot::Benchmark, traded.work))
    }

    /// Whether work of a slot runs.
    pub fn is_busy(&self, slot: Slot) -> bool {
        self.running.contains_key(&slot)
    }

    /// Replaces the case of the form and solves it.
    pub(super) fn replace_case(&mut self, case: Case, focus: usize) {
        self.tab.case = case;
        self.solve();
        self.focus_on(focus);
    }

    /// Checks the form and solves it if it is valid.
    pub(super) fn solve(&mut self) {
        let Some(request) = self.checked() else { return };
        let (serial, evaluator) = (request.serial, Arc::clone(&self.evaluator));
        let work = Work::in_steps(Slot::Solve, move |running| {
            let show = |answer: &Answer| {
                let answer = answer.clone();
                running.send(move |app| app.take(answer));
            };
            let next = Cell::new(Instant::now() + LONG);
            let go_on = |part| {
                let now = Instant::now();
                if now > next.get() {
                    next.set(now + PROGRESS_STEP);
                    running.send(move |app| app.show_progress(serial, part));
                }
                running.is_wanted()
            };
            solver::on_demand("solver");
            let mut evaluator = evaluator.lock().unwrap_or_else(PoisonError::into_inner);
            solver::solve(&mut evaluator, &request, &mut |answer| show(answer), &go_on);
        });
        self.start(work.or(move |app| app.solver_failed(serial)));
    }

    /// Shows the progress of a slow solve.
    pub fn show_progress(&mut self, serial: u64, part: f64) {
        if let Some(tab) = self.tab_of(serial).filter(|tab| !tab.is_settled) {
            tab.solving = Some(part);
        }
    }

    /// Reports that the solver failed on the request with a serial.
    pub fn solver_failed(&mut self, serial: u64) {
        let Some(tab) = self.tab_of(serial) else { return };
        (tab.has_failed, tab.is_settled, tab.solving) = (true, true, None);
        if self.tab.serial == serial {
            self.is_pinning = false;
            self.complain(
                "internal error: the solver failed on this; undo or change the last edit",
            );
        }
    }

    /// Checks the form and returns the request for its results if the form is valid.
    pub(super) fn checked(&mut self) -> Option<Request> {
        let wanted = self.wanted();
        let tab = &mut self.tab;
        let (inputs, problems) = tab.case.read();
        tab.inputs_so_far = inputs;
        let (case, focus) = (tab.case.clone(), tab.form.focus);
        let place_of = |problem: &Problem| rows::of_key(&case, &problem.field).unwrap_or(focus);
        let placed = problems.iter().map(|problem| (place_of(problem), problem.for_form()));
        tab.problems = placed.collect();
        if !tab.problems.is_empty() {
            tab.refusal = None;
            return None;
        }
        self.last_serial += 1;
        (tab.serial, tab.requested, tab.valid) = (self.last_serial, wanted, Some(case));
        (tab.is_settled, tab.solving) = (false, None);
        Some(self.tab.request())
    }

    /// Whether every requested result is present, apart from those of some stages.
    pub(super) fn has_results(&self, apart: Stages) -> bool {
        let Tab { answer, serial, requested, .. } = &self.tab;
        answer.as_ref().is_some_and(|answer| {
            let has_stiffness = answer.stiffness.is_some() >= requested.stiffness;
            let is_present = answer.serial == *serial && answer.pending.is_none();
            is_present && answer.stages.covers(requested.stages.except(apart)) && has_stiffness
        })
    }

    /// Solves the stages that became visible after the last request.
    pub(super) fn catch_up(&mut self) {
        if self.tab.problems.is_empty() && !self.tab.requested.covers(self.wanted()) {
            self.solve();
        }
    }

    /// Shows an answer in its tab, unless a later request is running.
    pub fn take(&mut self, answer: Answer) {
        let (serial, before) = (answer.serial, self.tab.chosen);
        if let Some(tab) = self.tab_of(serial) {
            tab.take(answer);
        }
        let now = self.tab.chosen.filter(|_| serial == self.tab.serial);
        if let Some((before, now)) = before.zip(now).filter(|(before, now)| before != now) {
            let earlier = self.message.take().map(|message| ". ".to_owned() + &message.text);
            let (earlier, before) = (earlier.unwrap_or_default(), before.name());
            let rest = if now == Method::Static { " (forces at rest)" } else { "" };
            self.say(format!("auto: {before} -> {}{rest}{earlier}", now.name()));
        }
        self.follow();
    }

    /// The open cases in any order.
    pub(super) fn tabs_mut(&mut self) -> impl Iterator<Item = &mut Tab> {
        std::iter::once(&mut self.tab).chain(&mut self.others)
    }

    /// The open case with this id.
    pub(super) fn tab_with(&mut self, id: usize) -> Option<&mut Tab> {
        self.tabs_mut().find(|tab| tab.id == id)
    }

    /// The tab that waits for the answer with this serial.
    pub(super) fn tab_of(&mut self, serial: u64) -> Option<&mut Tab> {
        self.tabs_mut().find(|tab| tab.serial == serial)
    }
}
