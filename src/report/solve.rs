//! Solves cases for reports: every result exists before it is rendered.

use super::compare::{ComparedCase, Comparison};
use super::digest::{Digest, STAGES};
use super::{Report, Selection, verdict};
use crate::case::fields::index_of;
use crate::case::units::System;
use crate::case::{Case, Evaluator, Problem};
use crate::model::inputs::Method;
use crate::model::solve::speeds;
use crate::model::speeds::SpeedCurve;
use crate::model::{self, Inputs, Outcome, Quantity, Refusal, Solution, Stage, Stages};
use crate::study::batch::Control;
use crate::study::seek::{distinct, headline};
use crate::study::shard::Format;
use crate::study::stiffness::{
    FLANK_POINTS, Flanks, PATH_POINTS, PathComparison, compare_flanks, compare_path,
};
use crate::study::tolerance::{Samples, Size, Tolerance, usual_samples};

impl Selection {
    /// Solves a case as far as the selection and the outcome of the method need it: beside a motion, the
    /// load at rest decides the exit. Returns the inputs of the solve with the solution.
    ///
    /// # Errors
    /// The refusal of the model.
    pub fn solve(&self, inputs: Inputs) -> Result<(Inputs, Solution), Refusal> {
        let inputs = inputs.needing(self.only.iter().map(|quantity| quantity.stage));
        let deciding = inputs.method.deciding_stages();
        let at_exit = deciding.has(Stage::Dynamic).then_some(Stages::of(Stage::Static));
        let wanted = self.stages().and(deciding).and(at_exit.unwrap_or_default());
        let solution = model::solve(&inputs, wanted)?;
        Ok((inputs, solution))
    }
}

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
        let (inputs, solution) = selection.solve(inputs)?;
        Ok(Report::of(name, case, inputs, solution, selection))
    }

    /// The report with the load at rest, if `dynamic` governs, and the free impact by `exact`. A
    /// method that refuses the case is left out.
    pub fn with_others(mut self) -> Report {
        let governing = self.solution.method;
        let stages = Stages::of(Stage::Static).and(Stages::of(Stage::Impact));
        let at_rest = (governing == Method::Dynamic).then_some(Method::Static);
        let exact = (governing != Method::Exact).then_some(Method::Exact);
        let methods = at_rest.into_iter().chain(exact);
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
pub fn compared(name: String, case: Case, selection: &Selection) -> ComparedCase {
    let found = case.inputs().and_then(|inputs| {
        Report::solve(name.clone(), case.clone(), inputs, selection.clone())
            .map_err(|refusal| vec![Problem::from(&refusal).at_given(&case)])
    });
    ComparedCase { name, file: String::new(), variant: None, case, found, alone: None }
}

/// The method of the columns of a comparison that `auto` solves: the most detailed one of all
/// columns, so that they have the same quantities by the same definitions.
pub(crate) fn common_method(methods: impl Iterator<Item = Method>) -> Method {
    methods.max_by_key(|method| *method as u8).unwrap_or(Method::Auto)
}

/// The comparison of solved cases, those of `auto` by one method.
pub fn comparison(mut cases: Vec<ComparedCase>, selection: Selection) -> Comparison {
    let most = common_method(cases.iter().filter_map(|case| Some(case.solution()?.method)));
    for case in &mut cases {
        let Ok(report) = &case.found else { continue };
        if report.solution.choice.is_none() || report.solution.method == most {
            continue;
        }
        case.alone = Some(report.solution.method);
        let inputs = Inputs { method: most, ..report.inputs.clone() };
        let found = Report::solve(case.name.clone(), case.case.clone(), inputs, selection.clone());
        case.found = found.map_err(|refusal| vec![Problem::from(&refusal).at_given(&case.case)]);
    }
    Comparison { cases, selection }
}

/// Solves a case as far as its digest needs it: verdict, notes and limits; without the relief of a
/// motion, which takes long. Returns `None` if `go_on` returns false.
pub fn digest(
    case: &Case,
    inputs: &Inputs,
    system: System,
    go_on: &dyn Fn(f64) -> bool,
) -> Option<Digest> {
    let is_slow = matches!(inputs.method, Method::Dynamic | Method::Auto);
    let relief = if is_slow { Stages::NONE } else { Stages::of(Stage::Clearing) };
    let stages = verdict::stages(case).and(STAGES).and(relief);
    let found = Evaluator::default().solve(inputs, inputs.method, stages, go_on);
    let found = Refusal::unless_stopped(found).ok()?;
    Some(Digest::of(case, inputs, found.as_ref(), system))
}

/// Seed of the command `tolerance`.
const SEED: u64 = 1;
/// Forces of variants, by their counterparts in the method, before the headline quantities.
const FORCES_OF_VARIANTS: [&str; 2] = ["peak_force", "impact_force"];
/// Quantities of variants after the headline quantities.
const OF_VARIANTS: [&str; 5] = [
    "clearing_relief",
    "total_deviation",
    "static_te_peak_to_peak",
    "mesh_force_factor",
    "steady_back_strikes",
];

/// A case to solve.
#[derive(Debug, Clone, Copy)]
pub struct Unsolved<'a> {
    /// The name of the case, as the user gave it.
    pub name: &'a str,
    /// The case.
    pub case: &'a Case,
    /// The pair of the case.
    pub inputs: &'a Inputs,
}

/// The results of a case that charts and pages show, as far as they are computed.
#[derive(Debug, Default)]
pub struct Subject {
    /// The solve by the method of the case and, for charts that this method lacks, a solve by
    /// another method.
    pub reports: Vec<Report>,
    /// Why the other method refuses the case.
    pub refusal: Option<Refusal>,
    /// The mesh stiffness by every compliance model.
    pub path: Option<Result<PathComparison, Refusal>>,
    /// The tooth compliances.
    pub flanks: Option<Result<Flanks, Refusal>>,
    /// The dynamic factor over speed.
    pub speeds: Option<SpeedCurve>,
    /// The case and its variants, if it has any.
    pub variants: Option<Comparison>,
    /// The samples of its distributions, if it has any.
    pub tolerance: Option<(Tolerance, Samples)>,
    /// The text of the case file.
    pub file: String,
}

/// The results that a picture shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Part {
    /// The stations of the method and of another method.
    Stations,
    /// The mesh stiffness by every compliance model.
    Path,
    /// The tooth compliances.
    Flanks,
    /// The dynamic factor over speed, which takes seconds.
    Speeds,
}

/// Receives the number of computed parts and their total; stops the work by returning false.
type GoOn<'a> = &'a dyn Fn(usize, usize) -> bool;

impl Subject {
    /// The results of one report.
    pub fn of(report: Report, file: String) -> Subject {
        Subject { reports: vec![report], file, ..Subject::default() }
    }

    /// The solve by the method of the case.
    pub fn own(&self) -> Option<&Report> {
        self.reports.first()
    }

    /// Adds a solve by another method for the charts that the method of the case lacks.
    fn with_other_method(mut self) -> Subject {
        let other = self.own().map(|report| {
            let inputs = Inputs { method: other_method(report), ..report.inputs.clone() };
            let (name, case) = (report.name.clone(), report.case.clone());
            Report::solve(name, case, inputs, report.selection.clone())
        });
        match other {
            Some(Ok(other)) => self.reports.push(other),
            Some(Err(refusal)) => self.refusal = Some(refusal),
            None => {}
        }
        self
    }

    /// Why the case lacks values that only some methods compute.
    pub(super) fn absence(&self, has: impl Fn(Method) -> bool) -> String {
        let solved = self.reports.iter().find(|report| has(report.solution.method));
        match (solved, self.own(), &self.refusal) {
            (Some(report), ..) if report.solution.outcome == Outcome::NoCornerContact => {
                "no corner contact is found".to_owned()
            }
            (Some(report), ..) => {
                format!("method {} finds no values", report.solution.method.name())
            }
            (None, Some(own), Some(refusal)) => {
                format!("method {} refuses the case: {refusal}", other_method(own).name())
            }
            (None, Some(own), None) => {
                format!("method {} has no such values", own.solution.method.name())
            }
            (None, None, _) => "no case is solved".to_owned(),
        }
    }
}

/// `static` after a closed form, `exact` after a method that shares the load.
fn other_method(report: &Report) -> Method {
    if report.solution.method.shares_load() { Method::Exact } else { Method::Static }
}

impl Unsolved<'_> {
    /// Solves the case with every quantity, and with the stations on request.
    ///
    /// # Errors
    /// The refusal of the model.
    pub fn solve(&self, stations: bool) -> Result<Report, Refusal> {
        let selection = Selection { only: Vec::new(), stations };
        let (name, case) = (self.name.to_owned(), self.case.clone());
        Report::solve(name, case, self.inputs.clone(), selection)
    }

    /// Solves the case with as many stations as its curves need, unless the case gives their number.
    fn solve_for_picture(&self) -> Result<Report, Refusal> {
        let is_given =
            index_of("model.stations").is_some_and(|field| self.case.text(field).is_some());
        let stations = self.inputs.stations.filter(|_| is_given);
        Unsolved { inputs: &Inputs { stations, ..self.inputs.clone() }, ..*self }.solve(true)
    }

    /// Computes the results that a picture shows.
    ///
    /// # Errors
    /// The refusal of the model; [`Refusal::Stopped`] if `go_on` returns false.
    pub fn part(&self, part: Part, go_on: GoOn) -> Result<Subject, Refusal> {
        if part == Part::Speeds {
            let speeds = Some(speeds(self.inputs, &mut |_| (), go_on)?);
            return Ok(Subject { speeds, ..Subject::default() });
        }
        let stations = Subject::of(self.solve_for_picture()?, String::new()).with_other_method();
        let path = (part == Part::Path).then(|| compare_path(self.inputs, PATH_POINTS));
        let flanks = (part == Part::Flanks).then(|| compare_flanks(self.inputs, FLANK_POINTS));
        Ok(Subject { path, flanks, ..stations })
    }

    /// Computes the results that a format shows. A page includes the studies of the case, with a
    /// number of tolerance samples, and other methods; HTML also includes what its charts show.
    ///
    /// # Errors
    /// The refusal of the model; [`Refusal::Stopped`] if `go_on` returns false.
    pub fn subject(
        &self,
        file: String,
        format: Format,
        samples: Option<usize>,
        go_on: GoOn,
    ) -> Result<Subject, Refusal> {
        let report = match format {
            Format::Html => self.solve_for_picture()?,
            _ => self.solve(format != Format::Csv)?,
        };
        if !matches!(format, Format::Html | Format::Md) {
            return Ok(Subject::of(report, file));
        }
        let page = Subject {
            variants: self.variants(go_on)?,
            tolerance: self.tolerance(samples, go_on)?,
            ..Subject::of(report.with_others(), file)
        };
        if format == Format::Md {
            return Ok(page);
        }
        // A pair without steady motion has no chart over speed.
        let speeds = Refusal::unless_stopped(speeds(self.inputs, &mut |_| (), go_on))?.ok();
        let path = Some(compare_path(self.inputs, PATH_POINTS));
        Ok(Subject { path, speeds, ..page.with_other_method() })
    }

    fn variants(&self, go_on: GoOn) -> Result<Option<Comparison>, Refusal> {
        let case = self.case;
        if case.variants.is_empty() {
            return Ok(None);
        }
        let variants = case.variants.iter().map(|one| (one.name.as_str(), case.with(one)));
        let cases: Vec<(&str, Case)> =
            std::iter::once(("case", case.clone())).chain(variants).collect();
        let methods = cases.iter().filter_map(|(_, case)| Some(case.inputs().ok()?.method));
        let methods: Vec<Method> = methods.chain([self.inputs.method]).collect();
        let others = || OF_VARIANTS.iter().filter_map(|key| Quantity::find(key));
        let only = distinct(headline(case, &methods).into_iter().chain(others()));
        let selection = Selection { only, stations: false };
        let count = cases.len();
        let solved = cases.into_iter().enumerate().map(|(at, (name, case))| {
            if !go_on(at, count) {
                return Err(Refusal::Stopped);
            }
            Ok(compared(name.to_owned(), case, &selection))
        });
        let mut found = comparison(solved.collect::<Result<_, _>>()?, selection.clone());
        // The forces by the methods that `auto` chose.
        let methods = found.cases.iter().filter_map(|case| Some(case.solution()?.method));
        let methods = distinct(methods);
        let force = |key| methods.iter().filter_map(move |&by| Quantity::find(key)?.by(by));
        let forces = FORCES_OF_VARIANTS.into_iter().flat_map(force);
        found.selection.only = distinct(forces.chain(headline(case, &methods)).chain(others()));
        Ok(Some(found))
    }

    fn tolerance(
        &self,
        samples: Option<usize>,
        go_on: GoOn,
    ) -> Result<Option<(Tolerance, Samples)>, Refusal> {
        let samples = samples.unwrap_or_else(|| usual_samples(self.inputs));
        let size = Size { samples, seed: SEED, ranked: Some(0) };
        let Ok(study) = Tolerance::of(self.case, self.inputs, &[], size) else { return Ok(None) };
        let samples = study.run(self.inputs, &Control { jobs: None, go_on })?;
        Ok(Some((study, samples)))
    }
}
