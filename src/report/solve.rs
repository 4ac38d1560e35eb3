//! Solves cases for reports: every result exists before it is rendered.

use super::charts::Solved;
use super::compare::{ComparedCase, Comparison};
use super::digest::Digest;
use super::pictures::Unsolved;
use super::{Report, Selection, verdict};
use crate::case::units::System;
use crate::case::{Case, Evaluator, Problem};
use crate::model::inputs::Method;
use crate::model::{self, Inputs, Quantity, Refusal, Stage, Stages};
use crate::study::batch::Control;
use crate::study::condition::{distinct, headline};
use crate::study::shard::Format;
use crate::study::tolerance::{Samples, Size, Tolerance};

impl Report {
    /// Solves the case as far as the selection and the outcome of the method need it.
    ///
    /// # Errors
    /// The refusal of the model.
    pub fn solve(
        name: String,
        case: Case,
        inputs: Inputs,
        selection: Selection,
    ) -> Result<Report, Refusal> {
        let inputs = inputs.needing(selection.only.iter().map(|quantity| quantity.stage));
        let solution =
            model::solve(&inputs, selection.stages().and(inputs.method.deciding_stages()))?;
        Ok(Report::of(name, case, inputs, solution, selection))
    }

    /// The report with the load at rest, if `dynamic` governs, and the closed forms. A method that
    /// refuses the case is left out.
    #[must_use]
    pub fn with_others(mut self) -> Report {
        let governing = self.solution.method;
        let stages = Stages::of(Stage::Clearing).and(Stages::of(Stage::Impact));
        let at_rest = (governing == Method::Dynamic).then_some(Method::Static);
        let methods = at_rest.into_iter().chain([Method::Exact, Method::Paper]);
        let methods = methods.filter(|&method| method != governing);
        if self.selection.is_whole() {
            self.others = methods
                .filter_map(|method| {
                    model::solve(&Inputs { method, ..self.inputs.clone() }, stages).ok()
                })
                .collect();
        }
        self
    }
}

/// Solves a case for a comparison.
#[must_use]
pub fn compared(name: String, case: Case, selection: &Selection) -> ComparedCase {
    let found = case.inputs().and_then(|inputs| {
        Report::solve(name.clone(), case.clone(), inputs, selection.clone())
            .map_err(|refusal| vec![Problem::from(&refusal).at_given(&case)])
    });
    ComparedCase { name, file: String::new(), variant: None, case, found }
}

/// Solves a case as far as its digest needs it: outcome, notes and limits. Returns `None` if `go_on`
/// returns false.
#[must_use]
pub fn digest(
    case: &Case,
    inputs: &Inputs,
    system: System,
    go_on: &dyn Fn(f64) -> bool,
) -> Option<Digest> {
    let shared = match inputs.method {
        Method::Static => Stages::of(Stage::Static),
        Method::Dynamic | Method::Auto => Stages::of(Stage::Dynamic),
        Method::Paper | Method::Exact => Stages::NONE,
    };
    let stages = verdict::stages(case).and(Stages::CLOSED_FORM).and(shared);
    match Evaluator::default().solve(inputs, inputs.method, stages, go_on) {
        Err(Refusal::Stopped) => None,
        found => Some(Digest::of(case, inputs, found.as_ref(), system)),
    }
}

/// Samples of a closed form, as in the command `tolerance`.
const SAMPLES: usize = 10_000;
/// Samples of a method that shares the load: a solve takes a hundred times as long.
const FEW_SAMPLES: usize = 1000;
/// Seed of the command `tolerance`.
const SEED: u64 = 1;
/// Quantities of variants in addition to the headline quantities.
const OF_VARIANTS: [&str; 5] = [
    "total_deviation",
    "clearing_relief",
    "static_te_peak_to_peak",
    "mesh_force_factor",
    "steady_back_strikes",
];

/// A solved case with its studies and the text of its file.
#[derive(Debug, Default)]
pub struct Subject {
    /// The results.
    pub solved: Solved,
    /// The case and its variants, if it has any.
    pub variants: Option<Comparison>,
    /// The samples of its distributions, if it has any.
    pub tolerance: Option<(Tolerance, Samples)>,
    /// The text of the case file.
    pub file: String,
}

/// Computes the parts of a solved case that a format shows. A page includes the studies of the case
/// and a second method; HTML also includes the dynamic factor over speed. `go_on` receives the
/// number of computed parts and their total.
///
/// # Errors
/// [`Refusal::Stopped`] if `go_on` returns false.
pub fn subject(
    report: Report,
    file: String,
    format: Format,
    go_on: &dyn Fn(usize, usize) -> bool,
) -> Result<Subject, Refusal> {
    let alone = |report| Solved { reports: vec![report], ..Solved::default() };
    if !matches!(format, Format::Html | Format::Md) {
        return Ok(Subject { solved: alone(report), file, ..Subject::default() });
    }
    let report = report.with_others();
    let source = Unsolved { name: &report.name, case: &report.case, inputs: &report.inputs };
    let variants = variants(source, go_on)?;
    let tolerance = tolerance(source, go_on)?;
    let solved = if format == Format::Md {
        alone(report)
    } else {
        // A pair without steady motion has no chart over speed.
        let speeds = match source.speeds(go_on) {
            Err(Refusal::Stopped) => return Err(Refusal::Stopped),
            found => found.ok(),
        };
        let path = Some(source.path());
        Solved { path, speeds, ..Solved::with_other_method(report) }
    };
    Ok(Subject { solved, variants, tolerance, file })
}

fn variants(
    Unsolved { case, inputs, .. }: Unsolved,
    go_on: &dyn Fn(usize, usize) -> bool,
) -> Result<Option<Comparison>, Refusal> {
    if case.variants.is_empty() {
        return Ok(None);
    }
    let variants = case.variants.iter().map(|one| (one.name.as_str(), case.with(one)));
    let cases: Vec<(&str, Case)> =
        std::iter::once(("case", case.clone())).chain(variants).collect();
    let methods = cases.iter().filter_map(|(_, case)| Some(case.inputs().ok()?.method));
    let methods: Vec<Method> = methods.chain([inputs.method]).collect();
    let others = OF_VARIANTS.iter().filter_map(|key| Quantity::find(key));
    let only = distinct(headline(case, &methods).into_iter().chain(others));
    let selection = Selection { only, stations: false };
    let count = cases.len();
    let solved = cases.into_iter().enumerate().map(|(at, (name, case))| {
        if !go_on(at, count) {
            return Err(Refusal::Stopped);
        }
        Ok(compared(name.to_owned(), case, &selection))
    });
    Ok(Some(Comparison { cases: solved.collect::<Result<_, _>>()?, selection }))
}

fn tolerance(
    Unsolved { case, inputs, .. }: Unsolved,
    go_on: &dyn Fn(usize, usize) -> bool,
) -> Result<Option<(Tolerance, Samples)>, Refusal> {
    let is_slow = inputs.method.shares_load() || inputs.method == Method::Auto;
    let samples = if is_slow { FEW_SAMPLES } else { SAMPLES };
    let size = Size { samples, seed: SEED, ranked: Some(0) };
    let Ok(study) = Tolerance::of(case, inputs, &[], size) else { return Ok(None) };
    let samples = study.run(inputs, &Control { jobs: None, go_on });
    let samples = samples.map_err(|_| Refusal::Stopped)?;
    Ok(Some((study, samples)))
}
