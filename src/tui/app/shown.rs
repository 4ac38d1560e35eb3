//! The panes and dialogs with the state that they show.

use super::App;
use crate::report;
use crate::tui::commands::{Command, key_in};
use crate::tui::cursor_range::CursorScope;
use crate::tui::dialogs::Surroundings;
use crate::tui::keys::Place;
use crate::tui::pane::Pane;
use crate::tui::panes::chart::Charts;
use crate::tui::panes::form::Form;
use crate::tui::panes::results::Results;
use crate::tui::panes::study::StudyPane;
use crate::tui::panes::teeth::Picture;
use crate::tui::panes::title::Title;
use crate::tui::panes::trade::TradePane;
use crate::tui::study::StudyResults;

impl App {
    /// The title line of a pane.
    #[must_use]
    pub(crate) fn title(&self, pane: Pane) -> Title {
        let plan = self.layout.plan();
        let hidden =
            if plan.names_hidden() == Some(pane) { plan.hidden().collect() } else { Vec::new() };
        Title {
            pane,
            has_focus: self.layout.focus() == pane && self.prompts.is_empty(),
            is_editing: self.has_line(),
            hidden,
            theme: self.look.theme,
        }
    }

    /// The visible charts and the pane in which the cursor moves.
    pub(crate) fn cursor_scope(&self) -> CursorScope<'_> {
        let plan = self.layout.plan();
        let is_alone = plan.chart.is_empty() && !plan.teeth.is_empty();
        CursorScope {
            charts: self.charts(),
            is_in_teeth: self.layout.focus() == Pane::Teeth || is_alone,
        }
    }

    /// The context of a dialog.
    pub(crate) fn surroundings(&self) -> Surroundings<'_> {
        Surroundings { screen: self.layout.size(), look: self.look, cursor: self.cursor_scope() }
    }

    /// The form with its case.
    #[must_use]
    pub(crate) fn form(&self) -> Form<'_> {
        let tab = &self.tab;
        Form {
            case: &tab.case,
            saved: &tab.saved,
            inputs: &tab.inputs_so_far,
            problems: &tab.problems,
            refused: tab.refused_row(),
            answer: tab.answer.as_ref(),
            is_stale: tab.is_stale(),
            focus: tab.form.focus,
            line: self.has_line().then_some(&tab.form.input),
            ending: self.ending(),
            top: tab.form.top,
            lines: &tab.form.lines,
            look: self.look,
            title: self.title(Pane::Form),
            area: self.layout.plan().form,
        }
    }

    /// The results pane with its results.
    #[must_use]
    pub fn results(&self) -> Results<'_> {
        let tab = &self.tab;
        Results {
            state: tab.results,
            answer: tab.answer.as_ref(),
            baseline: self.baseline.as_ref(),
            variants: tab.variants.as_ref().filter(|_| self.first_variant.is_some()),
            first_variant: self.first_variant.unwrap_or(0),
            earlier: tab.earlier.as_ref(),
            refusal: tab.refusal.as_ref(),
            problems: &tab.problems,
            missing: self.missing(),
            case: &tab.case,
            is_stale: tab.is_stale(),
            shows_last_valid: tab.shows_last_valid(),
            shows_cost: self.shows_cost,
            is_focused: self.layout.focus() == Pane::Results,
            next_fault: || key_in(Place::FORM, Command::NextFault),
            notes_key: self.notes_key(),
            units: self.settings.units,
            look: self.look,
            title: self.title(Pane::Results),
            area: self.layout.plan().results,
        }
    }

    fn notes_key(&self) -> fn() -> String {
        if self.has_line() {
            || key_in(Place::FORM, Command::Notes)
        } else {
            || key_in(Place::FIELD, Command::Notes)
        }
    }

    /// The trade pane with its benchmark.
    #[must_use]
    pub(crate) fn trade(&self) -> TradePane<'_> {
        TradePane {
            traded: self.tab.traded.as_ref(),
            inputs: self.tab.inputs(),
            view: self.trade_view,
            look: self.look,
            title: self.title(Pane::Trade),
            area: self.layout.plan().trade,
        }
    }

    /// The study pane with its study.
    #[must_use]
    pub(crate) fn study(&self) -> StudyPane<'_> {
        let tab = &self.tab;
        let answer = tab.answer.as_ref().filter(|_| !tab.is_stale());
        let shown = tab.study.shown.as_ref();
        let present = shown
            .and_then(StudyResults::quantity)
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
            area: self.layout.plan().study,
        }
    }

    /// The chart pane with its results.
    #[must_use]
    pub fn charts(&self) -> Charts<'_> {
        Charts {
            pane: &self.chart,
            scale: &self.tab.scale,
            answer: self.tab.answer.as_ref(),
            baseline: self.baseline.as_ref().map(|baseline| &baseline.answer),
            cursor: self.cursor,
            is_stale: self.tab.shows_last_valid(),
            notes_key: self.notes_key(),
            work: &self.tab.chart_work,
            undone: self.tab.undone,
            units: self.settings.units,
            marker: self.settings.marker,
            look: self.look,
            area: self.layout.plan().chart,
        }
    }

    /// The picture of the teeth, if the active method has results.
    #[must_use]
    pub(crate) fn picture(&self) -> Option<Picture<'_>> {
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
}
