//! Requests to the solver and their answers.

use super::App;
use crate::case::{Case, Problem};
use crate::model::{Stage, Stages};
use crate::report::graphs::GRAPHS;
use crate::tui::benchmark::Traded;
use crate::tui::pane::Pane;
use crate::tui::rows;
use crate::tui::solver::{Answer, Request};
use crate::tui::tab::Tab;

impl App {
    /// The stages of the visible results.
    #[must_use]
    pub(crate) fn wanted(&self) -> Stages {
        if self.is_pinning {
            return Stages::EVERY;
        }
        let plan = self.layout.plan();
        let seen = Pane::ALL.into_iter().filter(|&pane| !plan.area(pane).is_empty());
        // The verdict with its notes is visible even if only the chart is: it needs all stages
        // except the stiffness spread and the late stages.
        let verdict = Pane::Results.needs().without(Stage::Band).except(Stages::LATE);
        seen.fold(verdict, |stages, pane| stages.and(pane.needs()))
    }

    /// Whether the chart of the mesh stiffness is visible.
    fn wants_stiffness(&self) -> bool {
        let is_visible = !self.layout.plan().area(Pane::Chart).is_empty();
        is_visible && GRAPHS[self.chart.graph].by_model.is_some()
    }

    /// Replaces the case of the form and returns the request for its results.
    pub(in crate::tui) fn replace_case(&mut self, case: Case, focus: usize) -> Option<Request> {
        self.tab.case = case;
        let request = self.request();
        self.focus_on(focus);
        request
    }

    /// Checks the form and returns the request for its results if the form is valid.
    pub(in crate::tui) fn request(&mut self) -> Option<Request> {
        let (stages, wants_stiffness) = (self.wanted(), self.wants_stiffness());
        let (inputs, problems) = self.tab.case.read();
        self.tab.inputs_so_far = inputs.clone();
        if problems.is_empty() {
            self.last_serial += 1;
            let tab = &mut self.tab;
            tab.requested_stiffness = wants_stiffness;
            (tab.serial, tab.requested, tab.is_settled, tab.solving) =
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
        self.tab.problems =
            problems.into_iter().map(|problem| (place_of(&problem), problem.for_form())).collect();
        None
    }

    /// The request for the results that the first frame leaves out.
    pub(in crate::tui) fn unanswered(&mut self) -> Option<Request> {
        let requested = self.tab.requested;
        let lacks_stiffness = self.wants_stiffness();
        let is_partial = |answer: &Answer| {
            answer.stages != requested || (lacks_stiffness && answer.stiffness.is_none())
        };
        let waits = !self.tab.is_settled || self.tab.answer.as_ref().is_some_and(is_partial);
        if waits { self.request() } else { None }
    }

    /// A request for the stages that became visible after the last request.
    pub(in crate::tui) fn catch_up(&mut self) -> Option<Request> {
        let lacks = !self.wanted().iter().all(|stage| self.tab.requested.has(stage));
        let lacks = lacks || (self.wants_stiffness() && !self.tab.requested_stiffness);
        if lacks && self.tab.problems.is_empty() { self.request() } else { None }
    }

    /// Shows an answer in its tab, unless a later request is running.
    pub(in crate::tui) fn take(&mut self, answer: Answer) {
        if let Some(tab) = self.tab_of(answer.serial) {
            tab.take(answer);
        }
        self.follow();
    }

    /// The benchmark with this serial.
    pub(in crate::tui) fn traded_of(&mut self, serial: u64) -> Option<&mut Traded> {
        let all = std::iter::once(&mut self.tab).chain(&mut self.others);
        all.filter_map(|tab| tab.traded.as_mut()).find(|traded| traded.serial == serial)
    }

    /// The tab that waits for the answer with this serial.
    pub(in crate::tui) fn tab_of(&mut self, serial: u64) -> Option<&mut Tab> {
        std::iter::once(&mut self.tab).chain(&mut self.others).find(|tab| tab.serial == serial)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::inputs::Method;
    use crate::model::{Refusal, Solution};
    use crate::tui::theme::Look;
    use crate::tui::{solver, store};
    use ratatui::layout::Size;

    fn on_dynamic(first_frame: impl Fn(&Request) -> Option<Answer>) -> App {
        let mut document = store::built_in();
        let mut case = Case::table_1();
        case.set("model.method", "dynamic").expect("a method");
        document.case = case;
        App::answered(document, None, (Look::FULL, Size::new(140, 45)), first_frame)
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
