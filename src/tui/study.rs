//! A study of the case in the form: a result over the range of a field, a map over two fields, or
//! the tolerance.

use ratatui::layout::Rect;

use crate::case::Case;
use crate::case::units::System;
use crate::model::inputs::Method;
use crate::model::{Inputs, Quantity};
use crate::study::axis::Axis;
use crate::study::batch::{PointOutcome, Refusals};

/// Samples of a tolerance study in the workbench.
pub(crate) const SAMPLES: usize = 10_000;

/// A request of a study to the worker.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyRequest {
    /// The serial of the request.
    pub serial: u64,
    /// The study.
    pub parameters: StudyParameters,
}

/// The parameters of a study.
#[derive(Debug, Clone, PartialEq)]
pub enum StudyParameters {
    /// Values over one or two fields.
    Grid(GridParameters),
    /// The samples of `[spread]`.
    Tolerance(Box<ToleranceParameters>),
}

/// Values over one or two fields.
#[derive(Debug, Clone, PartialEq)]
pub struct GridParameters {
    /// For a map the second field, then the first one; the first of these axes varies slowest.
    pub axes: Vec<Axis>,
    /// The curves; the active method comes first.
    pub(crate) layers: Vec<Layer>,
}

/// A curve, or the values of a map.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layer {
    /// The method, or the baseline.
    pub(crate) source: LayerSource,
    /// The case with that method.
    pub(crate) inputs: Inputs,
    /// The key of the quantity.
    pub(crate) quantity: &'static str,
}

/// The origin of a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum LayerSource {
    /// The method of the case.
    Active(Method),
    /// Another method.
    Other(Method),
    /// The baseline.
    Baseline,
}

/// The distributions of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct ToleranceParameters {
    /// The case with its distributions.
    pub(crate) case: Case,
    /// The pair.
    pub(crate) inputs: Inputs,
    /// The selected quantity.
    pub(crate) quantity: &'static str,
}

/// The next results of a study.
#[derive(Debug, Clone)]
pub struct StudyPart {
    /// The serial of the request.
    pub serial: u64,
    /// The results.
    pub found: Found,
    /// How the study ended, if it has ended.
    pub end: Option<End>,
}

/// Results of a study.
#[derive(Debug, Clone)]
pub enum Found {
    /// The next points of a layer.
    Points(LayerFound, usize),
    /// The page of the tolerance so far, and the solved part.
    Page(Vec<String>, f64),
    /// Nothing new.
    Nothing,
}

/// How a study ended.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum End {
    /// Every point is solved.
    Whole,
    /// The user stopped it.
    Stopped,
    /// The study is not possible, or the program failed.
    Failed(String),
}

/// The points of a layer so far.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct LayerFound {
    /// How each point ended.
    pub(crate) outcomes: Vec<PointOutcome>,
    /// The value of each point in SI.
    pub values: Vec<Option<f64>>,
    /// The refused points.
    pub(crate) refusals: Refusals,
}

/// The state that decides which study is requested.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct StudyKey {
    /// The serial of the case.
    pub serial: u64,
    /// Whether the form is valid.
    pub is_valid: bool,
    /// The focused row of the form.
    pub row: usize,
    /// The key of the selected result.
    pub quantity: Option<&'static str>,
    /// The method of the displayed results.
    pub solved_by: Option<Method>,
    /// The serial of the baseline.
    pub baseline: Option<u64>,
    /// The second field of a map.
    pub second: Option<usize>,
    /// The zoom of the ranges.
    pub zoom: i32,
    /// The display units.
    pub units: System,
    /// Whether the pane shows the tolerance.
    pub is_tolerance: bool,
    /// The area of the pane.
    pub area: Rect,
}

/// The study of an open case.
#[derive(Debug, Clone, Default)]
pub struct Study {
    /// The state behind the present request or obstacle.
    pub key: Option<StudyKey>,
    /// The present request.
    pub request: Option<StudyRequest>,
    /// The point of the cursor on the first and on the second axis.
    pub cursor: Option<(usize, usize)>,
    /// Why there is no study.
    pub obstacle: Option<String>,
    /// The visible results: of the present request, or of the previous one until the first results
    /// arrive.
    pub shown: Option<StudyResults>,
}

/// The results of a study so far.
#[derive(Debug, Clone)]
pub struct StudyResults {
    /// The request.
    pub request: StudyRequest,
    /// The points of each layer.
    pub layers: Vec<LayerFound>,
    /// The page of a tolerance study.
    pub page: Vec<String>,
    /// The solved part of a tolerance study.
    pub(crate) part: f64,
    /// How the study ended, if it has ended.
    pub end: Option<End>,
}

impl LayerSource {
    /// The name in the legend.
    pub(crate) fn name(self) -> &'static str {
        match self {
            LayerSource::Active(method) | LayerSource::Other(method) => method.name(),
            LayerSource::Baseline => "baseline",
        }
    }
}

impl Layer {
    /// The quantity.
    #[must_use]
    pub(crate) fn quantity(&self) -> Option<&'static Quantity> {
        Quantity::find(self.quantity)
    }
}

impl StudyParameters {
    /// The axes of a curve or a map.
    #[must_use]
    pub fn axes(&self) -> &[Axis] {
        match self {
            StudyParameters::Grid(grid) => &grid.axes,
            StudyParameters::Tolerance(_) => &[],
        }
    }
}

impl Study {
    /// Whether the present request has this serial.
    #[must_use]
    pub fn runs(&self, serial: u64) -> bool {
        let request = self.request.as_ref();
        request.is_some_and(|request| request.serial == serial)
    }

    /// Starts a request. The cursor does not move on unchanged axes.
    pub fn start(&mut self, request: StudyRequest) {
        let shown = self.shown.as_ref().map(|shown| &shown.request);
        let before = self.request.as_ref().or(shown);
        if before.is_none_or(|before| before.parameters.axes() != request.parameters.axes()) {
            self.cursor = None;
        }
        self.request = Some(request);
    }

    /// Adds results; ignores those of another request.
    pub(crate) fn take(&mut self, part: StudyPart) {
        let Some(request) = self.request.as_ref().filter(|_| self.runs(part.serial)) else {
            return;
        };
        let is_shown = |shown: &StudyResults| shown.request.serial == part.serial;
        if !self.shown.as_ref().is_some_and(is_shown) {
            self.shown = Some(StudyResults::of(request.clone()));
        }
        if let Some(shown) = self.shown.as_mut() {
            shown.add(part);
        }
    }
}

impl StudyResults {
    /// The quantity of the study: that of its first curve.
    #[must_use]
    pub fn quantity(&self) -> Option<&'static Quantity> {
        match &self.request.parameters {
            StudyParameters::Grid(grid) => grid.layers.first()?.quantity(),
            StudyParameters::Tolerance(parameters) => Quantity::find(parameters.quantity),
        }
    }

    fn of(request: StudyRequest) -> StudyResults {
        let layers = match &request.parameters {
            StudyParameters::Grid(grid) => vec![LayerFound::default(); grid.layers.len()],
            StudyParameters::Tolerance(_) => Vec::new(),
        };
        StudyResults { request, layers, page: Vec::new(), part: 0.0, end: None }
    }

    fn add(&mut self, part: StudyPart) {
        match part.found {
            Found::Points(found, layer) => {
                if let Some(known) = self.layers.get_mut(layer) {
                    known.outcomes.extend(found.outcomes);
                    known.values.extend(found.values);
                    known.refusals = found.refusals;
                }
            }
            Found::Page(lines, part) => (self.page, self.part) = (lines, part),
            Found::Nothing => {}
        }
        self.end = part.end.or(self.end.take());
    }
}
