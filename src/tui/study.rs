//! A study of the case in the form: a result over the range of a field, a map over two fields, or
//! the tolerance.

use crate::case::Case;
use crate::model::inputs::Method;
use crate::model::{Inputs, Quantity};
use crate::study::axis::Axis;
use crate::study::batch::{PointOutcome, Refusals};

/// Samples of a tolerance study in the workbench.
pub(crate) const SAMPLES: usize = 10_000;

/// A requested study.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyRequest {
    /// The number of its work.
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
    /// Whether it is the baseline.
    pub(crate) is_baseline: bool,
    /// The case with the method of the curve.
    pub(crate) inputs: Inputs,
    /// The key of the quantity.
    pub(crate) quantity: &'static str,
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

/// The study of an open case.
#[derive(Debug, Clone, Default)]
pub struct Study {
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

impl Layer {
    /// The name in the legend.
    pub(crate) fn name(&self) -> &'static str {
        if self.is_baseline { "baseline" } else { self.inputs.method.name() }
    }

    /// The quantity.
    pub(crate) fn quantity(&self) -> Option<&'static Quantity> {
        Quantity::find(self.quantity)
    }
}

impl StudyParameters {
    /// The axes of a curve or a map.
    pub fn axes(&self) -> &[Axis] {
        match self {
            StudyParameters::Grid(grid) => &grid.axes,
            StudyParameters::Tolerance(_) => &[],
        }
    }
}

impl Study {
    /// Starts a request. The cursor does not move on unchanged axes.
    pub fn start(&mut self, request: StudyRequest) {
        let shown = self.shown.as_ref().map(|shown| &shown.request);
        let before = self.request.as_ref().or(shown);
        if before.is_none_or(|before| before.parameters.axes() != request.parameters.axes()) {
            self.cursor = None;
        }
        self.request = Some(request);
    }

    /// The results of the present request.
    pub(crate) fn results(&mut self) -> Option<&mut StudyResults> {
        if !self.is_shown() {
            self.shown = Some(StudyResults::of(self.request.clone()?));
        }
        self.shown.as_mut()
    }

    /// Whether the present request has ended.
    pub(crate) fn is_over(&self) -> bool {
        self.is_shown() && self.shown.as_ref().is_some_and(|shown| shown.end.is_some())
    }

    fn is_shown(&self) -> bool {
        let serial = |request: &StudyRequest| request.serial;
        let shown = self.shown.as_ref().map(|shown| shown.request.serial);
        shown.is_some() && shown == self.request.as_ref().map(serial)
    }
}

impl StudyResults {
    /// The quantity of the study: that of its first curve.
    pub fn quantity(&self) -> Option<&'static Quantity> {
        match &self.request.parameters {
            StudyParameters::Grid(grid) => grid.layers.first()?.quantity(),
            StudyParameters::Tolerance(parameters) => Quantity::find(parameters.quantity),
        }
    }

    /// The method of the first curve.
    #[must_use]
    pub(crate) fn method(&self) -> Method {
        match &self.request.parameters {
            StudyParameters::Grid(grid) => {
                grid.layers.first().map_or(Method::Exact, |layer| layer.inputs.method)
            }
            StudyParameters::Tolerance(parameters) => parameters.inputs.method,
        }
    }

    fn of(request: StudyRequest) -> StudyResults {
        let layers = match &request.parameters {
            StudyParameters::Grid(grid) => vec![LayerFound::default(); grid.layers.len()],
            StudyParameters::Tolerance(_) => Vec::new(),
        };
        StudyResults { request, layers, page: Vec::new(), part: 0.0, end: None }
    }

    /// Adds points to a layer.
    pub(crate) fn add(&mut self, layer: usize, found: LayerFound) {
        if let Some(known) = self.layers.get_mut(layer) {
            known.outcomes.extend(found.outcomes);
            known.values.extend(found.values);
            known.refusals = found.refusals;
        }
    }
}
