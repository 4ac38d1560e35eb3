//! The state of the workbench: plain data, changed by `update` alone.

use std::path::PathBuf;

use ratatui::layout::Size;

use super::actions::Progress;
use super::baseline::Baseline;
use super::benchmark::TradeView;
use super::benchmark::Traded;
use super::commands::{Command, key_of};
use super::cursor_range::CursorScope;
use super::dialogs::{Prompt, Surroundings};
use super::keys::Place;
use super::layout::{Plan, plan};
use super::pane::{Pane, Panes};
use super::panes::chart::{ChartPane, Charts};
use super::panes::form::Form;
use super::panes::results::{self, Results};
use super::panes::study::{StudyPane, StudyState};
use super::panes::teeth::{Picture, TeethView};
use super::panes::title::Title;
use super::panes::trade::TradePane;
use super::rows;
use super::session::recovery::{Access, NEWER, OpenCase};
use super::settings::Settings;
use super::solver::{self, Answer, Request};
use super::tab::Tab;
use super::theme::Look;
use crate::case::fields::Kind;
use crate::case::{Case, Document, Problem};
use crate::model::{Stage, Stages};
use crate::report;
use crate::report::graphs::GRAPHS;

/// Everything that the screen shows.
#[derive(Debug, Clone)]
#[expect(clippy::struct_excessive_bools, reason = "each is a switch of its own")]
pub struct App {
    /// The current case.
    pub tab: Tab,
    /// The other open cases, in their order.
    pub others: Vec<Tab>,
    /// How many of the others stand before the current one.
    pub place_of_tab: usize,
    /// Counts the tabs, those that are closed among them.
    pub last_id: usize,
    /// Counts the requests of all cases.
    pub last_serial: u64,
    /// Focus and layout.
    pub panes: Panes,
    /// Whether letters go into the focused field while the form has the focus.
    pub is_editing: bool,
    /// The case before the last key, where that key was a digit which started a new value.
    pub before_digit: Option<Case>,
    /// Results to hold the others against.
    pub baseline: Option<Baseline>,
    /// Whether the results are to be pinned as soon as all of them are there.
    pub is_pinning: bool,
    /// Whether the results tell what they took.
    pub shows_cost: bool,
    /// How the trade pane shows its measurement.
    pub trade_view: TradeView,
    /// The cursor of charts and teeth: the driver's roll angle before E, in rad, negative after E.
    pub cursor: Option<f64>,
    /// The view of the teeth pane.
    pub teeth: TeethView,
    /// The state of the chart pane.
    pub chart: ChartPane,
    /// The first variant beside the case in the results; `None` while the methods are shown.
    pub first_variant: Option<usize>,
    /// The state of the study pane.
    pub study: StudyState,
    /// The serial of the study that runs.
    pub studying: Option<u64>,
    /// Whether the run plays.
    pub is_playing: bool,
    /// Long work that goes on.
    pub progress: Option<Progress>,
    /// The serial of the measurement that goes on; its tab may be closed by now.
    pub measuring: Option<u64>,
    /// What lies over the panes, the topmost last.
    pub prompts: Vec<Prompt>,
    /// Whether what is focused may be out of sight in form or results.
    pub needs_scroll: bool,
    /// Said once, until the next key.
    pub message: Option<Message>,
    /// The size of the terminal.
    pub size: Size,
    /// What the user chose for every case.
    pub settings: Settings,
    /// What the terminal is able to show.
    pub look: Look,
}

/// Something said once.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Message {
    /// The words.
    pub text: String,
    /// Whether something went wrong.
    pub is_fault: bool,
}

impl App {
    /// The workbench on a document with all its results, however long they take.
    #[must_use]
    pub fn new(document: Document, path: Option<PathBuf>, look: Look, size: Size) -> App {
        App::answered(document, path, (look, size), |request| {
            Some(solver::answer(request))
        })
    }

    /// The workbench for the first frame, which waits for no elastic field.
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
            panes: Panes::default(),
            is_editing: true,
            before_digit: None,
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
            is_playing: false,
            progress: None,
            measuring: None,
            prompts: Vec::new(),
            needs_scroll: false,
            message: None,
            size,
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

    /// The open cases in their order, the current one among them.
    pub fn tabs(&self) -> impl Iterator<Item = &Tab> {
        let (before, after) = self
            .others
            .split_at(self.place_of_tab.min(self.others.len()));
        before.iter().chain(std::iter::once(&self.tab)).chain(after)
    }

    /// What every open case makes of its file.
    #[must_use]
    pub fn sheets(&self) -> Vec<OpenCase<'_>> {
        self.tabs().map(Tab::sheet).collect()
    }

    /// The areas of the screen.
    #[must_use]
    pub fn plan(&self) -> Plan {
        plan(self.size, self.panes)
    }

    /// The title line of a pane.
    #[must_use]
    pub fn title(&self, pane: Pane) -> Title {
        let plan = self.plan();
        let hidden = if plan.names_hidden() == Some(pane) {
            plan.hidden().collect()
        } else {
            Vec::new()
        };
        Title {
            pane,
            has_focus: self.panes.focus == pane && self.prompts.is_empty(),
            is_editing: self.has_line(),
            hidden,
            theme: self.look.theme,
        }
    }

    /// The charts and the pane in which the cursor moves.
    pub(crate) fn cursor_scope(&self) -> CursorScope<'_> {
        let plan = self.plan();
        let is_alone = plan.chart.is_empty() && !plan.teeth.is_empty();
        CursorScope {
            charts: self.charts(),
            is_in_teeth: self.panes.focus == Pane::Teeth || is_alone,
        }
    }

    /// The surroundings of a dialog.
    pub(crate) fn surroundings(&self) -> Surroundings<'_> {
        Surroundings {
            screen: self.size,
            look: self.look,
            cursor: self.cursor_scope(),
        }
    }

    /// The form with the case in it.
    #[must_use]
    pub fn form(&self) -> Form<'_> {
        let tab = &self.tab;
        Form {
            case: &tab.case,
            saved: &tab.saved,
            inputs: &tab.inputs_so_far,
            problems: &tab.problems,
            answer: tab.answer.as_ref(),
            is_stale: tab.is_stale(),
            focus: tab.form.focus,
            line: self.has_line().then_some(&tab.form.input),
            ending: self.ending(),
            top: tab.form.top,
            look: self.look,
            title: self.title(Pane::Form),
            area: self.plan().form,
        }
    }

    /// The results pane with the results that it shows.
    #[must_use]
    pub fn results(&self) -> Results<'_> {
        let tab = &self.tab;
        Results {
            state: tab.results,
            answer: tab.answer.as_ref(),
            baseline: self.baseline.as_ref(),
            variants: tab
                .variants
                .as_ref()
                .filter(|_| self.first_variant.is_some()),
            first_variant: self.first_variant.unwrap_or(0),
            earlier: tab.earlier.as_ref(),
            refusal: tab.refusal.as_ref(),
            problems: &tab.problems,
            missing: self.missing(),
            case: &tab.case,
            is_stale: tab.is_stale(),
            shows_last_valid: tab.shows_last_valid(),
            shows_cost: self.shows_cost,
            is_focused: self.panes.focus == Pane::Results,
            next_fault: || key_of(Command::NextFault),
            units: self.settings.units,
            look: self.look,
            title: self.title(Pane::Results),
            area: self.plan().results,
        }
    }

    /// The trade pane with the benchmark that it shows.
    #[must_use]
    pub fn trade(&self) -> TradePane<'_> {
        TradePane {
            traded: self.tab.traded.as_ref(),
            inputs: self.tab.inputs(),
            view: self.trade_view,
            look: self.look,
            title: self.title(Pane::Trade),
            area: self.plan().trade,
        }
    }

    /// The study pane with the study that it shows.
    #[must_use]
    pub fn study(&self) -> StudyPane<'_> {
        let tab = &self.tab;
        let answer = tab.answer.as_ref().filter(|_| !tab.is_stale());
        let present = results::marked(&self.results())
            .zip(answer)
            .and_then(|(quantity, answer)| report::value(quantity, answer.of(answer.active)?));
        StudyPane {
            state: self.study,
            study: &tab.study,
            case: &tab.case,
            present,
            units: self.settings.units,
            marker: self.settings.marker,
            look: self.look,
            title: self.title(Pane::Study),
            area: self.plan().study,
        }
    }

    /// The chart pane with the results that it shows.
    #[must_use]
    pub fn charts(&self) -> Charts<'_> {
        Charts {
            pane: &self.chart,
            scale: &self.tab.scale,
            answer: self.tab.answer.as_ref(),
            baseline: self.baseline.as_ref().map(|baseline| &baseline.answer),
            cursor: self.cursor,
            is_stale: self.tab.shows_last_valid(),
            undone: self.tab.undone,
            units: self.settings.units,
            marker: self.settings.marker,
            look: self.look,
            area: self.plan().chart,
        }
    }

    /// The picture of the teeth, if the active method has results.
    #[must_use]
    pub fn picture(&self) -> Option<Picture<'_>> {
        let answer = self.tab.answer.as_ref()?;
        Some(Picture {
            inputs: &answer.inputs,
            solution: answer.of(answer.active)?,
            cursor: self.cursor,
            view: &self.teeth,
            look: self.look,
            marker: self.settings.marker,
            units: self.settings.units,
            is_stale: self.tab.shows_last_valid(),
        })
    }

    /// Where keys go.
    #[must_use]
    pub fn place(&self) -> Place {
        match self.prompts.last() {
            Some(prompt) => prompt.dialog().place(),
            None if !self.has_line() => self.panes.focus.place(),
            None if !rows::names(&self.tab.case, self.tab.form.focus).is_empty() => Place::CHOICE,
            None if self.is_fresh() => Place::TEXT.or(Place::FRESH),
            None => Place::TEXT,
        }
    }

    /// Whether what is typed goes into the focused field.
    #[must_use]
    pub fn has_line(&self) -> bool {
        self.panes.focus == Pane::Form && self.is_editing
    }

    /// Whether the focused row has a value rather than words, and typing would replace all of it.
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

    /// What completes the text that is typed into the focused field: its unit, or the rest of it.
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

    /// How many required values are missing, where nothing else is wrong.
    #[must_use]
    pub fn missing(&self) -> Option<usize> {
        let count = self.tab.problems.len();
        let is_draft = self
            .tab
            .problems
            .iter()
            .all(|(row, _)| rows::lacks(&self.tab.case, *row));
        Some(count).filter(|_| is_draft)
    }

    /// The stages of a solve whose results are in sight.
    #[must_use]
    pub fn wanted(&self) -> Stages {
        if self.is_pinning {
            return Stages::EVERY;
        }
        let plan = self.plan();
        let seen = Pane::ALL
            .into_iter()
            .filter(|&pane| !plan.area(pane).is_empty());
        // The verdict, with the outcome and its notes, stands there even where only the chart is in
        // sight: all but the band and the late stages.
        let verdict = Pane::Results
            .needs()
            .without(Stage::Band)
            .except(Stages::LATE);
        seen.fold(verdict, |stages, pane| stages.and(pane.needs()))
    }

    /// Whether the chart of the mesh stiffness is in sight.
    fn wants_stiffness(&self) -> bool {
        let is_visible = !self.plan().area(Pane::Chart).is_empty();
        is_visible && GRAPHS[self.chart.graph].by_model.is_some()
    }

    /// Say something until the next key.
    pub(super) fn say(&mut self, text: impl Into<String>) {
        self.message = Some(Message {
            text: text.into(),
            is_fault: false,
        });
    }

    /// Say what went wrong, until the next key.
    pub(super) fn complain(&mut self, text: impl Into<String>) {
        self.message = Some(Message {
            text: text.into(),
            is_fault: true,
        });
    }

    /// Move to a field, the cursor at the end of its text.
    pub(super) fn focus_on(&mut self, field: usize) {
        self.tab.focus_on(field);
        self.follow();
    }

    /// Form and results are to scroll until what is focused is in sight with what is wrong with it.
    pub(super) fn follow(&mut self) {
        self.needs_scroll = true;
    }

    /// Put another case into the form, and ask for its results.
    pub(super) fn replace_case(&mut self, case: Case, focus: usize) -> Option<Request> {
        self.tab.case = case;
        let request = self.request();
        self.focus_on(focus);
        request
    }

    /// Check the form; when it is valid, what the worker shall solve.
    pub(super) fn request(&mut self) -> Option<Request> {
        let (stages, wants_stiffness) = (self.wanted(), self.wants_stiffness());
        let (inputs, problems) = self.tab.case.read();
        self.tab.inputs_so_far = inputs.clone();
        if problems.is_empty() {
            self.last_serial += 1;
            let tab = &mut self.tab;
            tab.asked_stiffness = wants_stiffness;
            (tab.serial, tab.asked, tab.is_settled, tab.solving) =
                (self.last_serial, stages, false, None);
            tab.problems.clear();
            return Some(Request {
                serial: tab.serial,
                case: tab.case.clone(),
                inputs,
                stages,
                stiffness: wants_stiffness,
            });
        }
        self.tab.refusal = None;
        let (case, focus) = (&self.tab.case, self.tab.form.focus);
        let place_of = |problem: &Problem| rows::of_key(case, &problem.field).unwrap_or(focus);
        self.tab.problems = problems
            .into_iter()
            .map(|problem| (place_of(&problem), problem.for_form()))
            .collect();
        None
    }

    /// The request for the results that the first frame could not wait for.
    pub(super) fn unanswered(&mut self) -> Option<Request> {
        let asked = self.tab.asked;
        let lacks_stiffness = self.wants_stiffness();
        let is_partial = |answer: &Answer| {
            answer.stages != asked || (lacks_stiffness && answer.stiffness.is_none())
        };
        let waits = !self.tab.is_settled || self.tab.answer.as_ref().is_some_and(is_partial);
        if waits { self.request() } else { None }
    }

    /// A request for the stages that became visible after the last request.
    pub(super) fn catch_up(&mut self) -> Option<Request> {
        let lacks = !self.wanted().iter().all(|stage| self.tab.asked.has(stage));
        let lacks = lacks || (self.wants_stiffness() && !self.tab.asked_stiffness);
        if lacks && self.tab.problems.is_empty() {
            self.request()
        } else {
            None
        }
    }

    /// Show an answer in its tab, unless a later one is on its way.
    pub(super) fn take(&mut self, answer: Answer) {
        if let Some(tab) = self.tab_of(answer.serial) {
            tab.take(answer);
        }
        self.follow();
    }

    /// The measurement of that serial.
    pub(super) fn traded_of(&mut self, serial: u64) -> Option<&mut Traded> {
        let all = std::iter::once(&mut self.tab).chain(&mut self.others);
        all.filter_map(|tab| tab.traded.as_mut())
            .find(|traded| traded.serial == serial)
    }

    /// The tab that waits for the answer of that serial.
    pub(super) fn tab_of(&mut self, serial: u64) -> Option<&mut Tab> {
        std::iter::once(&mut self.tab)
            .chain(&mut self.others)
            .find(|tab| tab.serial == serial)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;
    use crate::model::inputs::Method;
    use crate::model::{Refusal, Solution};
    use crate::tui::store;

    fn on_dynamic(first_frame: impl Fn(&Request) -> Option<Answer>) -> App {
        let mut document = store::built_in();
        let mut case = Case::table_1();
        case.set("model.method", "dynamic").expect("a method");
        document.case = case;
        App::answered(
            document,
            None,
            (Look::FULL, Size::new(140, 45)),
            first_frame,
        )
    }

    #[test]
    fn the_worker_solves_the_results_that_the_first_frame_leaves_out() {
        let whole = |request: &Request| Some(solver::answer(request));
        assert_eq!(on_dynamic(whole).unanswered(), None);

        let without_relief = |request: &Request| {
            let answer = solver::answer(request);
            let stages = answer.stages.without(Stage::Clearing);
            Some(Answer { stages, ..answer })
        };
        let closed_form = |exact: Result<Solution, Refusal>| {
            move |request: &Request| {
                Some(Answer {
                    active: Method::Exact,
                    pending: Some(Method::Dynamic),
                    methods: vec![(Method::Exact, exact.clone())],
                    ..solver::answer(request)
                })
            }
        };
        let inputs = Case::table_1().inputs().expect("Table 1 is valid");
        let found = crate::model::solve(&inputs, Stages::EVERY);
        let assert_asks = |mut app: App| {
            let request = app.unanswered().expect("a request for the worker");
            assert_eq!(request.inputs.method, Method::Dynamic);
            assert_eq!(request.serial, app.tab.serial);
            assert!(!app.tab.is_settled);
        };
        assert_asks(on_dynamic(|_| None));
        assert_asks(on_dynamic(without_relief));
        assert_asks(on_dynamic(closed_form(found)));
        assert_asks(on_dynamic(closed_form(Err(Refusal::Stopped))));
    }
}
