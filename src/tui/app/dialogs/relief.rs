//! The dialog that searches for the tip relief to specify.

use std::cell::Cell;

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Position};
use ratatui::text::{Line as Words, Span, Text};
use ratatui::widgets::Widget;
use unicode_width::UnicodeWidthStr;

use super::{Dialog, Prompt, Window, wrapped};
use crate::case::units::System;
use crate::model::{Inputs, Refusal};
use crate::study::relief::{Demand, NoRelief, Specification, specify};
use crate::tui::app::App;
use crate::tui::app::actions::{Change, Running, Slot, Work};
use crate::tui::layout::Place;
use crate::tui::text::Line;
use crate::tui::{rows, text};

/// The label of the input line.
const LABEL: &str = "Loads, tolerances, te|peak|entry: ";
/// Rows beside the list and its legend: input, state, headers, and one below the list.
const BESIDE: usize = 4;

/// Writes values of fields, with their texts in the shown units.
type TakeOver = fn(&mut App, &[(&'static str, String)], &[(&'static str, String)]);

/// The search and its result.
#[derive(Debug, Clone)]
pub struct ReliefDialog {
    /// The typed demand.
    pub(crate) input: Line,
    inputs: Inputs,
    /// The units of the steps.
    units: System,
    /// The demand of the last search.
    searched: Option<Demand>,
    /// The progress of the search.
    percent: u8,
    answer: Option<Result<Box<Specification>, String>>,
    /// The selected relief.
    selected: usize,
    /// Why the typed text is not a valid demand.
    problem: Option<String>,
    /// The first visible line about the selected relief.
    top: usize,
    /// Writes values of fields into the case, and reports them as shown.
    take_over: TakeOver,
}

impl ReliefDialog {
    /// The dialog on a pair with a demand, before its first search.
    pub(crate) fn new(
        inputs: Inputs,
        (demand, units): (String, System),
        take_over: TakeOver,
    ) -> ReliefDialog {
        ReliefDialog {
            input: Line::whole(demand),
            inputs,
            units,
            searched: None,
            percent: 0,
            answer: None,
            selected: 0,
            problem: None,
            top: 0,
            take_over,
        }
    }

    fn open(app: &mut App) -> Option<&mut ReliefDialog> {
        app.dialog_of(|prompt| match prompt {
            Prompt::Relief(dialog) => Some(&mut **dialog),
            _ => None,
        })
    }

    /// Searches for the typed demand, as `tipstrike relief`.
    pub(crate) fn search(&mut self) -> Option<Work> {
        let demand = match self.demand() {
            Ok(demand) => demand,
            Err(problem) => {
                self.problem = Some(problem);
                return None;
            }
        };
        (self.searched, self.answer, self.problem) = (Some(demand.clone()), None, None);
        self.percent = 0;
        let inputs = self.inputs.clone();
        let search = move |running: &Running<'_>| {
            let shown = Cell::new(0);
            let go_on = |part: f64| {
                let percent = ((100.0 * part) as u8).max(shown.get());
                if shown.replace(percent) != percent {
                    running.send(move |app| {
                        if let Some(dialog) = ReliefDialog::open(app) {
                            dialog.percent = percent;
                        }
                    });
                }
                running.is_wanted()
            };
            let found = match specify(&inputs, &demand, &go_on) {
                Ok(found) => Ok(Box::new(found)),
                Err(NoRelief::Refused(Refusal::Stopped)) => return None,
                Err(none) => Err(none.to_string()),
            };
            Some(found)
        };
        Some(Work::new(Slot::Relief, search, |app, found| {
            if let Some(dialog) = ReliefDialog::open(app) {
                dialog.take(found);
            }
        }))
    }

    /// Shows the result of the search.
    fn take(&mut self, found: Result<Box<Specification>, String>) {
        (self.selected, self.top) = (found.as_ref().map_or(0, |found| found.specified()), 0);
        self.answer = Some(found);
    }

    pub(crate) fn demand(&self) -> Result<Demand, String> {
        Demand::parse(self.input.value(), self.units)
    }

    /// Whether the last search is for the typed demand.
    fn is_searched(&self) -> bool {
        self.searched.is_some() && self.demand().ok() == self.searched
    }

    fn state(&self) -> String {
        let state = match &self.answer {
            None if self.searched.is_none() => "Enter searches.",
            None => return format!("Searching: {} %. Esc ends the search.", self.percent),
            Some(_) if !self.is_searched() => "Results of the earlier input. Enter searches again.",
            Some(Ok(_)) => {
                "Up, Down select; Enter writes the relief into the case; PageDown scrolls."
            }
            Some(Err(_)) => "No relief is found.",
        };
        state.to_owned()
    }

    fn found(&self) -> Option<&Specification> {
        self.answer.as_ref()?.as_ref().ok().map(|found| &**found)
    }

    /// The lines about the selected relief. Rows of tables keep their spaces.
    fn lines(&self, app: &App) -> Vec<Words<'static>> {
        let width = app.room().width;
        let lines = match (self.found(), &self.answer) {
            (Some(found), _) => found.of_choice(self.selected, false, app.settings.units),
            (None, Some(Err(reason))) => vec![reason.clone()],
            _ => Vec::new(),
        };
        lines.iter().flat_map(|line| wrapped(line, width)).map(Words::from).collect()
    }

    /// The meaning of the list.
    fn legend(&self, app: &App) -> Vec<String> {
        let legend = self.found().map(|found| found.legend(app.settings.units));
        legend.map_or_else(Vec::new, |legend| wrapped(&legend, app.room().width))
    }

    fn count(&self) -> usize {
        self.found().map_or(0, |found| found.choices.len())
    }
}

impl Dialog for ReliefDialog {
    fn place(&self) -> Place {
        Place::PICK
    }

    fn input(&mut self) -> Option<&mut Line> {
        Some(&mut self.input)
    }

    fn typed(&mut self) -> Vec<Work> {
        self.problem = None;
        Vec::new()
    }

    fn step(&mut self, by: isize, _: &App) {
        let next = self.selected.saturating_add_signed(by);
        self.selected = next.min(self.count().saturating_sub(1));
        self.top = 0;
    }

    fn turn(&mut self, by: isize, app: &App) {
        let above = self.count() + self.legend(app).len() + BESIDE;
        let page = app.page_height() - above.cast_signed();
        let count = self.lines(app).len() + above;
        self.top = app.scrolled(self.top, by * page.max(1), count);
    }

    fn accept(&mut self, app: &App) -> Option<Change> {
        if !self.is_searched() {
            let search = self.search()?;
            return Some(Change::of(|app| app.start_all([search])));
        }
        let report = self.found()?;
        let system = |key: &str| rows::written_system(&app.tab.case, key);
        let values =
            report.settings(self.selected, |key| system(key).unwrap_or(app.settings.units));
        let mut shown = report.settings(self.selected, |_| app.settings.units);
        shown.retain(|(_, text)| !text.is_empty());
        let take_over = self.take_over;
        Some(Change::of(move |app| take_over(app, &values, &shown)))
    }

    fn draw(&self, app: &App, buffer: &mut Buffer) -> Option<Position> {
        let theme = app.look.theme;
        let inner = app.frame("Tip relief", app.room(), buffer);
        let count = self.count();
        let (has_list, legend) = (u16::from(count > 0), self.legend(app));
        let heights = [1, 1, legend.len() as u16, has_list, count as u16, has_list];
        let rows = heights.map(Constraint::Length).into_iter().chain([Constraint::Fill(1)]);
        let [line, state, columns, head, list, _, below] = Layout::vertical(rows).areas(inner);
        if let Some(found) = self.found() {
            let rows =
                found.gains(app.settings.units, usize::from(inner.width.saturating_sub(2))).lines();
            let legend: Text<'_> = legend.into_iter().map(Words::from).collect();
            legend.style(theme.faint).render(columns, buffer);
            Span::raw(format!("  {}", rows[0])).render(head, buffer);
            let row = |at: usize| rows[at + 1].clone();
            Window { count, selected: Some(self.selected), area: list }.draw(row, theme, buffer);
        }
        let lines = self.lines(app).into_iter().skip(self.top);
        lines.collect::<Text<'_>>().render(below, buffer);
        let is_stale = self.answer.is_some() && !self.is_searched();
        if is_stale {
            for area in [head, list, below] {
                buffer.set_style(area, theme.faint);
            }
        }
        let style = if is_stale { theme.problem } else { theme.note };
        let problem = self.problem.as_ref().map(|problem| format!("! {problem}"));
        let words = problem.unwrap_or_else(|| self.state());
        let words = text::cut(&words, inner.width.into());
        Span::styled(words, style).render(state, buffer);
        let [label, line] =
            Layout::horizontal([Constraint::Length(LABEL.width() as u16), Constraint::Fill(1)])
                .areas(line);
        Span::raw(LABEL).render(label, buffer);
        text::edited(&self.input, line, theme.focus, buffer)
    }
}
