//! The chart pane: the selected chart of the station values, and further charts below it if there
//! is room.

pub(crate) mod axes;
pub(crate) mod curves;
pub(crate) mod panels;
pub(crate) mod range;
mod worker_chart;

use std::sync::Arc;

use ratatui::layout::Rect;
use ratatui::symbols::Marker;

use super::plot::Span;
use crate::case::units::System;
use crate::model::Solution;
pub use crate::model::contact_state::first_contact_of_driver as first_contact;
use crate::report::graphs::GRAPHS;
use crate::tui::jobs::{ChartWork, WorkerChart};
use crate::tui::solver::Answer;
use crate::tui::theme::Look;

use curves::curves;
pub use curves::readout;
pub(crate) use range::last_contact;
use range::{ChartView, Frame, Occasion, Refit, Scale, angle_range_of, path, way};

/// Least height of each chart, in rows; it decides the number of charts.
const ROWS: u16 = 16;
const MOST: u16 = 3;
/// The part of the approach that the strike shows after E.
const AFTER_E: f64 = 0.5;

/// The state of the pane, common to all open cases.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct ChartPane {
    /// The selected chart, as an index of the table.
    pub graph: usize,
    /// The chart of a worker that replaces it.
    pub worker_chart: Option<WorkerChart>,
    /// Whether the x axis is the time after E.
    pub(crate) by_time: bool,
    /// The visible roll angles.
    pub view: ChartView,
}

/// The number of charts: those of the table, and those of the worker.
const CHARTS: usize = GRAPHS.len() + WorkerChart::ALL.len();

impl ChartPane {
    /// The index of the selected chart among all charts.
    fn place(&self) -> usize {
        let of_worker = |chart| WorkerChart::ALL.iter().position(|own| *own == chart);
        let place = self.worker_chart.and_then(of_worker);
        place.map_or(self.graph, |place| GRAPHS.len() + place)
    }

    /// Selects the chart with an index among all charts.
    fn select(&mut self, at: usize) {
        self.worker_chart = at.checked_sub(GRAPHS.len()).map(|at| WorkerChart::ALL[at]);
        if self.worker_chart.is_none() {
            self.graph = at;
        }
    }

    /// The key of the selected chart, as in `plot --chart`.
    #[must_use]
    pub fn key(&self) -> &'static str {
        self.worker_chart.map_or(GRAPHS[self.graph].key, WorkerChart::key)
    }
}

/// A command of the pane.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum ChartCommand {
    /// Selects the chart `by` places further, wrapping around.
    Step(isize),
    /// Selects the chart with an index of the table, or after the table a chart of the worker.
    Select(usize),
    /// Zooms in by steps around the cursor, or around D without a cursor; zooms out if negative.
    Zoom(i32),
    /// Shows the whole contact.
    Whole,
    /// Switches between the strike and the whole contact.
    Strike,
    /// Switches the x axis between roll angle and time.
    Time,
}

/// The pane with the results that it shows.
#[derive(Debug, Clone, Copy)]
pub struct Charts<'a> {
    /// The state of the pane.
    pub(crate) pane: &'a ChartPane,
    /// The axes of the case.
    pub(crate) scale: &'a Scale,
    /// The last valid results.
    pub(crate) answer: Option<&'a Answer>,
    /// The results of the baseline.
    pub(crate) baseline: Option<&'a Answer>,
    /// The cursor: the driver's roll angle before E, in rad.
    pub(crate) cursor: Option<f64>,
    /// Whether the results are older than the form.
    pub(crate) is_stale: bool,
    /// The key that shows the notes.
    pub(crate) notes_key: fn() -> String,
    /// The chart that the worker computes for the case.
    pub work: &'a ChartWork,
    /// The first request after the last undo.
    pub(crate) undone: u64,
    /// The display units.
    pub(crate) units: System,
    /// The marker of the active curve.
    pub(crate) marker: Marker,
    /// The capabilities of the terminal.
    pub(crate) look: Look,
    /// The area of the pane with its title; empty if the pane is hidden.
    pub(crate) area: Rect,
}

impl Charts<'_> {
    /// The results of the active method.
    #[must_use]
    pub fn solution(&self) -> Option<&Solution> {
        self.answer.and_then(|answer| answer.of(answer.active))
    }

    /// The visible roll angles, in deg after E.
    #[must_use]
    pub fn window(&self) -> Span {
        self.view().window(self.scale)
    }

    /// The view of the pane. A chart of the path of contact starts with the whole contact.
    fn view(&self) -> ChartView {
        match self.pane.view.frame {
            Frame::Opening if self.is_by_model() => {
                ChartView { frame: Frame::Whole, ..self.pane.view }
            }
            _ => self.pane.view,
        }
    }

    /// Whether the selected chart has a curve for each compliance model.
    fn is_by_model(&self) -> bool {
        GRAPHS[self.pane.graph].by_model.is_some()
    }

    /// The state after a command, with a message.
    #[must_use]
    pub(crate) fn run(&self, command: ChartCommand) -> (ChartPane, Option<&'static str>) {
        let mut pane = *self.pane;
        let message = match command {
            ChartCommand::Step(by) => {
                let at = (pane.place() + CHARTS).saturating_add_signed(by) % CHARTS;
                pane.select(at);
                None
            }
            ChartCommand::Select(at) => {
                pane.select(at.min(CHARTS - 1));
                None
            }
            ChartCommand::Zoom(steps) => {
                pane.view = self.zoomed(steps);
                let end =
                    if steps > 0 { "closest zoom" } else { "the charts show the whole contact" };
                (pane.view == self.view()).then_some(end)
            }
            ChartCommand::Whole => {
                pane.view = ChartView::whole();
                Some("the charts show the whole contact")
            }
            ChartCommand::Strike => {
                pane.view = self.view().strike_or_whole(self.scale);
                Some(match pane.view.frame {
                    Frame::Strike if self.scale.strike.is_empty() => {
                        "no corner contact: no strike to show"
                    }
                    Frame::Strike => "the charts show the strike",
                    Frame::Opening | Frame::Whole => "the charts show the whole contact",
                })
            }
            ChartCommand::Time => {
                pane.by_time = !pane.by_time;
                Some(if pane.by_time {
                    "x axis: time after E"
                } else {
                    "x axis: driver roll angle before E"
                })
            }
        };
        (pane, message)
    }

    fn zoomed(&self, steps: i32) -> ChartView {
        let start = self.solution().and_then(first_contact);
        let around = 0.0 - self.cursor.or(start).unwrap_or(0.0).to_degrees();
        self.view().zoomed(steps, around, self.scale)
    }

    /// The state that the axes depend on.
    pub(crate) fn occasion(&self) -> Occasion {
        let view = &self.pane.view;
        Occasion {
            answered: self.answer.map(|answer| (answer.serial, answer.pending.is_some())),
            stiffness: self
                .answer
                .and_then(|answer| answer.stiffness.as_ref()?.as_ref().ok())
                .map(|stiffness| Arc::as_ptr(stiffness).addr()),
            pinned: self.baseline.map(|baseline| baseline.serial),
            shown: (self.pane.graph, self.count(), self.units),
            sight: (view.frame, view.zoom, view.middle.map(f64::to_bits)),
            ground: (self.answer.map(|answer| answer.active), self.undone),
        }
    }

    /// The axes, if they must change since an earlier occasion, with the new occasion.
    pub(crate) fn fitted_since(&self, before: Occasion) -> Option<(Occasion, Scale)> {
        let mut occasion = self.occasion();
        let refit = occasion.since(before);
        (before != occasion).then(|| (occasion, self.fitted(refit)))
    }

    /// Axes that contain every visible curve. Keeps the present axes while they fit.
    fn fitted(&self, refit: Refit) -> Scale {
        let mut scale = *self.scale;
        let Some(answer) = self.answer.filter(|_| !self.area.is_empty()) else {
            return scale;
        };
        // The axis does not shrink while the worker still solves a method.
        let pinned = self.baseline.map(|baseline| (baseline, baseline.beside(answer.active)));
        let way = pinned
            .map_or(Span::NONE, |(base, method)| angle_range_of(base, method))
            .and(way(answer));
        let way = if self.is_by_model() { way.and(path(answer)) } else { way };
        scale.across = match (answer.pending, refit.all) {
            (Some(_), _) => scale.across.grown(way),
            (None, true) => scale.across.refit(way),
            (None, false) => scale.across.fitted(way),
        };
        let touches = [Some((answer, answer.active)), pinned];
        let touches = touches
            .into_iter()
            .flatten()
            .filter_map(|(answer, method)| first_contact(answer.of(method)?));
        let first = touches.fold(0.0, f64::max).to_degrees();
        let strike = Span::new(-first, AFTER_E * first);
        scale.strike = match (strike.is_empty(), refit.all) {
            (true, _) => Span::default(),
            (false, true) => scale.strike.refit(strike),
            (false, false) => scale.strike.fitted(strike),
        };
        let window = self.view().window(&scale);
        for graph in self.shown() {
            let curves = curves(self, &GRAPHS[graph]);
            let values =
                curves.iter().map(|curve| curve.upright_within(window)).fold(Span::NONE, Span::and);
            let now = scale.upright[graph];
            let fitted = |now: Span| match GRAPHS[graph].by_model {
                Some(_) => now.fitted_closely(values),
                None => now.fitted(values),
            };
            let is_new = refit.upright || refit.all;
            let axis = fitted(if is_new { Span::default() } else { now });
            scale.upright[graph] = if axis.is_empty() { now } else { axis };
        }
        scale
    }

    /// The visible charts: the selected chart, and below it the next charts of the active method.
    #[must_use]
    pub fn shown(&self) -> Vec<usize> {
        let chosen = self.pane.graph;
        let method = self.answer.map(|answer| answer.active);
        let others = (1..GRAPHS.len()).map(|by| (chosen + by) % GRAPHS.len());
        let has_curve = |graph: &usize| {
            let graph = &GRAPHS[*graph];
            graph.by_model.is_none() && method.is_some_and(|method| graph.column(method).is_some())
        };
        std::iter::once(chosen).chain(others.filter(has_curve)).take(self.count()).collect()
    }

    fn count(&self) -> usize {
        if self.area.is_empty() { 0 } else { usize::from((self.area.height / ROWS).clamp(1, MOST)) }
    }
}
