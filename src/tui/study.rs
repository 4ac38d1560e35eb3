//! A study of the case in the form: a field over its range, two fields as a map, or the tolerance.

use crate::case::Case;
use crate::model::inputs::Method;
use crate::model::{Inputs, Quantity};
use crate::study::axis::Axis;
use crate::study::batch::PointOutcome;
use crate::study::refusals::Refusals;

/// Samples of a tolerance study in the workbench.
pub(crate) const SAMPLES: usize = 10_000;

/// A study for the worker.
#[derive(Debug, Clone, PartialEq)]
pub struct StudyRequest {
    /// Tells the request from the others.
    pub serial: u64,
    /// The study.
    pub question: Question,
}

/// What a study computes.
#[derive(Debug, Clone, PartialEq)]
pub enum Question {
    /// Values over one or two fields.
    Grid(GridQuestion),
    /// The samples of `[spread]`.
    Tolerance(Box<ToleranceQuestion>),
}

/// Values over one or two fields.
#[derive(Debug, Clone, PartialEq)]
pub struct GridQuestion {
    /// The second field of a map, then the first one; the first of these varies slowest.
    pub axes: Vec<Axis>,
    /// The curves; the active method comes first.
    pub(crate) layers: Vec<Layer>,
}

/// A curve, or the values of a map.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Layer {
    /// The method, or the baseline.
    pub(crate) whose: Whose,
    /// The case, on that method.
    pub(crate) inputs: Inputs,
    /// The key of the quantity.
    pub(crate) quantity: &'static str,
}

/// The origin of a curve.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Whose {
    /// The method of the case.
    Active(Method),
    /// Another method.
    Other(Method),
    /// The baseline.
    Baseline,
}

/// The distributions of a case.
#[derive(Debug, Clone, PartialEq)]
pub struct ToleranceQuestion {
    /// The name of the case.
    pub(crate) name: String,
    /// The case with its distributions.
    pub(crate) case: Case,
    /// The pair that it describes.
    pub(crate) inputs: Inputs,
    /// The quantity of the results pane.
    pub(crate) quantity: &'static str,
}

/// The next results of a study.
#[derive(Debug, Clone)]
pub struct StudyPart {
    /// That of the request.
    pub serial: u64,
    /// The results.
    pub found: Found,
    /// How the study ended, if it did.
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
    /// It was stopped.
    Stopped,
    /// There is no such study, or the program failed.
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
    pub asked: Option<StudyRequest>,
    /// Why there is no study.
    pub obstacle: Option<String>,
    /// The results in sight: of the present request, or of the one before until its first results.
    pub shown: Option<Shown>,
}

/// The results of a study so far.
#[derive(Debug, Clone)]
pub struct Shown {
    /// The request.
    pub request: StudyRequest,
    /// The points of each layer.
    pub layers: Vec<LayerFound>,
    /// The page of a tolerance study.
    pub page: Vec<String>,
    /// The solved part of a tolerance study.
    pub(crate) part: f64,
    /// How it ended, if it did.
    pub end: Option<End>,
}

impl Layer {
    /// The quantity.
    #[must_use]
    pub(crate) fn quantity(&self) -> Option<&'static Quantity> {
        Quantity::find(self.quantity)
    }
}

impl Study {
    /// Adds results; those of another request are left out.
    pub(crate) fn take(&mut self, part: StudyPart) {
        let asked = self.asked.as_ref();
        let Some(request) = asked.filter(|asked| asked.serial == part.serial) else {
            return;
        };
        let is_shown = |shown: &Shown| shown.request.serial == part.serial;
        if !self.shown.as_ref().is_some_and(is_shown) {
            self.shown = Some(Shown::of(request.clone()));
        }
        if let Some(shown) = self.shown.as_mut() {
            shown.add(part);
        }
    }
}

impl Shown {
    fn of(request: StudyRequest) -> Shown {
        let layers = match &request.question {
            Question::Grid(grid) => vec![LayerFound::default(); grid.layers.len()],
            Question::Tolerance(_) => Vec::new(),
        };
        Shown {
            request,
            layers,
            page: Vec::new(),
            part: 0.0,
            end: None,
        }
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
