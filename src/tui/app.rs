//! The state of the workbench: plain data that only `update` changes.

mod requests;
mod shown;

use std::path::PathBuf;

use ratatui::layout::Size;

use super::actions::Progress;
use super::baseline::Baseline;
use super::benchmark::TradeView;
use super::commands::{Command, key_in};
use super::dialogs::Prompt;
use super::jobs::RunningExport;
use super::keys::Place;
use super::layout::Layout;
use super::pane::Pane;
use super::panes::chart::ChartPane;
use super::panes::study::StudyState;
use super::panes::teeth::TeethView;
use super::rows;
use super::session::recovery::{Access, NEWER, OpenCase};
use super::settings::Settings;
use super::solver::{self, Answer, Request};
use super::store::WatchedFile;
use super::tab::Tab;
use super::theme::Look;
use crate::case::Document;
use crate::case::fields::Kind;

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
    /// Whether the results show the run time of each stage.
    pub(crate) shows_cost: bool,
    /// The view of the trade pane.
    pub(crate) trade_view: TradeView,
    /// The cursor of charts and teeth: the driver's roll angle before E, in rad, negative after E.
    pub cursor: Option<f64>,
    /// The view of the teeth pane.
    pub(crate) teeth: TeethView,
    /// The state of the chart pane.
    pub chart: ChartPane,
    /// The first variant beside the case in the results; `None` while the methods are shown.
    pub first_variant: Option<usize>,
    /// The state of the study pane.
    pub study: StudyState,
    /// The serial of the running study.
    pub(crate) studying: Option<u64>,
    /// The running export.
    pub(crate) exporting: Option<RunningExport>,
    /// The serial of the case whose variants the worker solves.
    pub(crate) comparing: Option<u64>,
    /// Whether the animation runs.
    pub is_playing: bool,
    /// Progress of running work.
    pub progress: Option<Progress>,
    /// The serial of the running benchmark; its tab may be closed.
    pub measuring: Option<u64>,
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

/// A message, shown until the next key.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// The text of the message.
    pub text: String,
    /// Whether it reports an error.
    pub(crate) is_fault: bool,
}

impl App {
    /// The workbench on a document with all its results, which may take long.
    #[must_use]
    pub(crate) fn new(document: Document, path: Option<PathBuf>, look: Look, size: Size) -> App {
        App::answered(document, path, (look, size), |request| Some(solver::answer(request)))
    }

    /// The workbench for the first frame, without results that need an elastic field.
    #[must_use]
    pub fn at_start(document: Document, path: Option<PathBuf>, look: Look, size: Size) -> App {
        App::answered(document, path, (look, size), solver::answer_without_fields)
    }

    fn answered(
        document: Document,
        path: Option<PathBuf>,
        (look, size): (Look, Size),
        answer: impl Fn(&Request) -> Option<Answer>,
    ) -> App {
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
            shows_cost: false,
            trade_view: TradeView::default(),
            cursor: None,
            teeth: TeethView::default(),
            chart: ChartPane::default(),
            first_variant: None,
            study: StudyState::default(),
            studying: None,
            exporting: None,
            comparing: None,
            is_playing: false,
            progress: None,
            measuring: None,
            prompts: Vec::new(),
            needs_scroll: false,
            message: None,
            settings: Settings::default(),
            look,
        };
        if app.tab.access == Access::Newer {
            app.complain(NEWER);
        }
        app.follow();
        if let Some(answer) = app.request().and_then(|request| answer(&request)) {
            app.take(answer);
        }
        app
    }

    /// The open cases in their order, including the current one.
    pub fn tabs(&self) -> impl Iterator<Item = &Tab> {
        let (before, after) = self.others.split_at(self.place_of_tab.min(self.others.len()));
        before.iter().chain(std::iter::once(&self.tab)).chain(after)
    }

    /// The files of the open cases and their content.
    pub(super) fn files(&self) -> Vec<WatchedFile> {
        let files = self.tabs().filter_map(|tab| {
            Some(WatchedFile {
                path: tab.path.clone()?,
                target: tab.document.path()?.to_owned(),
                stamp: tab.document.stamp(),
            })
        });
        files.collect()
    }

    /// The state of every open case for the autosave.
    #[must_use]
    pub fn sheets(&self) -> Vec<OpenCase<'_>> {
        self.tabs().map(Tab::sheet).collect()
    }

    /// The place that decides the meaning of keys.
    #[must_use]
    pub fn place(&self) -> Place {
        match self.prompts.last() {
            Some(prompt) => prompt.dialog().place(),
            None if !self.has_line() => self.place_of_pane(),
            None if !rows::names(&self.tab.case, self.tab.form.focus).is_empty() => Place::CHOICE,
            None if self.is_fresh() => Place::TEXT.or(Place::FRESH),
            None => Place::TEXT,
        }
    }

    /// The key of a command in the present place, see [`key_in`].
    pub(super) fn key_of(&self, command: Command) -> String {
        key_in(self.place(), command)
    }

    fn place_of_pane(&self) -> Place {
        match self.layout.focus() {
            Pane::Chart if self.chart.worker_chart.is_some() => Place::WORKER_CHART,
            Pane::Study if self.study.is_tolerance => Place::TOLERANCE,
            pane => pane.place(),
        }
    }

    /// Whether typed letters go into the focused field.
    #[must_use]
    pub fn has_line(&self) -> bool {
        self.layout.focus() == Pane::Form && self.is_editing
    }

    /// Whether the focused row is a value and typing would replace all of it.
    fn is_fresh(&self) -> bool {
        let Tab { case, form, .. } = &self.tab;
        let is_words =
            rows::field(case, form.focus).is_some_and(|field| matches!(field.kind, Kind::Text));
        !is_words && form.input.kept() == 0
    }

    /// Whether a key would be the first of an edit that replaces the text of the focused row.
    pub(super) fn starts_new_edit(&self) -> bool {
        let Tab { form, history, .. } = &self.tab;
        let is_in_line = self.prompts.is_empty() && self.has_line();
        is_in_line && form.input.kept() == 0 && !history.is_visited(form.focus)
    }

    /// The completion of the typed text of the focused field: its unit, or the rest of a name.
    #[must_use]
    pub fn ending(&self) -> Option<String> {
        let (tab, system) = (&self.tab, self.settings.units);
        let typed = || {
            rows::ending(
                &tab.case,
                tab.form.focus,
                tab.form.input.value(),
                tab.form.written_unit.as_deref(),
                system,
            )
        };
        if self.has_line() { typed() } else { None }
    }

    /// The number of missing required values, if nothing else is wrong.
    #[must_use]
    pub(crate) fn missing(&self) -> Option<usize> {
        let count = self.tab.problems.len();
        let is_draft = self.tab.problems.iter().all(|(row, _)| rows::lacks(&self.tab.case, *row));
        Some(count).filter(|_| is_draft)
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
}
