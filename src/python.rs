//! The native half of the Python package `python/tipstrike`: cases, solves and studies, with results as
//! columns of bytes, JSON and text.
#![allow(unsafe_code, reason = "the macros of PyO3 generate the interface of C")]
#![allow(
    clippy::needless_pass_by_value,
    reason = "the macros of PyO3 hand arguments over by value"
)]
#![allow(missing_docs, reason = "python/tipstrike/__init__.pyi documents the package")]

use std::cell::{Cell, RefCell};
use std::ffi::OsString;
use std::fmt::Display;
use std::io;
use std::path::{Path, PathBuf};
use std::sync::OnceLock;
use std::time::{Duration, Instant};

use pyo3::exceptions::{PyFileNotFoundError, PyKeyError, PyOSError, PyValueError};
use pyo3::prelude::*;
use pyo3::types::{PyBool, PyByteArray, PyFloat, PyList};

use crate::case::fields::{FIELDS, Kind, index_of};
use crate::case::file::{Document, MOST_MODEL_BYTES, ReadError, read_bytes};
use crate::case::units::System;
use crate::case::{
    Case as Fields, EXAMPLES, Example, Problem, put_field, quantity, rexs, violated_rule,
};
use crate::cli::options::Threads;
use crate::cli::questions::{Excitation, Misuse, NoAnswer, Question, Seek, Stiffness, within};
use crate::cli::{self, Arguments, Streams};
use crate::model::inputs::Method;
use crate::model::{Inputs, Quantity, Refusal, Solution, Stages};
use crate::report::charts::{Pattern, find, pictures};
use crate::report::compare::ComparedCase;
use crate::report::data::{self, stations, write_json};
use crate::report::page::{format_of, render};
use crate::report::solve::{Unsolved, compared, comparison};
use crate::report::studies::table;
use crate::report::table::{Cell as TableCell, Column as TableColumn, Named, Results, Table};
use crate::report::tolerance::ToleranceReport;
use crate::report::verdict::Absence;
use crate::report::{Report, Selection, page};
use crate::study::axis::Grid;
use crate::study::batch::{Batch, Points, Refusals, Row, solve_all};
use crate::study::relief::{Criterion, Demand, demand};
use crate::study::seek::{distinct, headline};
use crate::study::shard::Format;
use crate::study::tolerance::{MOST_SAMPLES, Samples, Size, Tolerance};

pyo3::import_exception!(tipstrike, CaseError);

/// A column: name, unit, and an array of f64 in bytes or a list of texts.
type Column = (String, String, Py<PyAny>);

/// The results of a study: columns, JSON, text and warnings.
type Found = (Vec<Column>, String, String, Vec<String>);

/// Time between two looks for Ctrl-C and two reports of the progress.
const TICK: Duration = Duration::from_millis(50);

/// Runs long work without the lock of the interpreter; Ctrl-C and an exception of `progress` end it.
fn run<T: Send>(
    py: Python<'_>,
    progress: Option<Py<PyAny>>,
    work: impl Send + FnOnce(&dyn Fn(usize, usize) -> bool) -> T,
) -> PyResult<T> {
    py.detach(|| {
        let (looked, error) = (Cell::new(Instant::now()), RefCell::new(None));
        let found = work(&|done, of| {
            if error.borrow().is_none() && looked.get().elapsed() >= TICK {
                let look = |py: Python<'_>| {
                    py.check_signals()?;
                    progress.as_ref().map_or(Ok(()), |call| call.call1(py, (done, of)).map(drop))
                };
                error.replace(Python::attach(look).err());
                looked.set(Instant::now());
            }
            error.borrow().is_none()
        });
        error.into_inner().map_or(Ok(found), Err)
    })
}

fn wrong(error: impl Display) -> PyErr {
    PyValueError::new_err(error.to_string())
}

/// An argument that is no value of a case.
fn misused(argument: &str, Problem { cause, fix, .. }: &Problem) -> PyErr {
    wrong(format!("{argument}: {cause}: {fix}"))
}

fn misuse((option, value, problem): Misuse) -> PyErr {
    misused(&format!("{option} = {value}"), &problem)
}

/// The rows of a study and its refused points.
fn solved(
    py: Python<'_>,
    batch: &Batch,
    jobs: Option<u16>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(Vec<Row>, Vec<String>)> {
    let (threads, count) = (Threads { jobs }, batch.points.count());
    let mut rows = Vec::with_capacity(count);
    let _ = run(py, progress, |go_on| {
        solve_all(batch, 0..count, &threads.control(go_on), &mut |_, solved| {
            rows.extend_from_slice(solved);
            true
        })
    })?;
    let mut refusals = Refusals::default();
    refusals.count(0, &rows);
    let notes = refusals.0.iter().map(|refused| refused.sentence(batch.points));
    Ok((rows, notes.collect()))
}

/// Place, field, cause and fix of problems.
fn bad_case(problems: Vec<(String, Problem)>) -> PyErr {
    let parts = problems
        .into_iter()
        .map(|(place, problem)| (place, problem.field, problem.cause, problem.fix));
    CaseError::new_err((parts.collect::<Vec<_>>(),))
}

fn unread(error: ReadError) -> PyErr {
    let faults = match error {
        ReadError::Bad(faults) => faults,
        ReadError::NewerFormat(fault) => vec![*fault],
        ReadError::NotFound(_) => return PyFileNotFoundError::new_err(error.to_string()),
        _ => return PyOSError::new_err(error.to_string()),
    };
    let placed = faults.into_iter();
    bad_case(
        placed.map(|at| (format!("{}:{}:{}", at.file, at.line, at.column), at.problem)).collect(),
    )
}

fn quantities(names: &[String]) -> PyResult<Vec<&'static Quantity>> {
    let named =
        names.iter().map(|name| quantity("", name).map_err(|problem| misused("only", &problem)));
    Ok(distinct(named.collect::<PyResult<Vec<_>>>()?))
}

fn numbers(py: Python<'_>, (key, unit): (&str, &str), values: impl Iterator<Item = f64>) -> Column {
    let bytes: Vec<u8> = values.flat_map(f64::to_ne_bytes).collect();
    (key.to_owned(), unit.to_owned(), PyByteArray::new(py, &bytes).into_any().unbind())
}

/// The columns of a table: numbers where every cell is a number or empty, else texts. An absent
/// number is NaN.
fn columns(py: Python<'_>, table: &Table) -> PyResult<Vec<Column>> {
    let number = |cell: &TableCell| match cell {
        TableCell::Number(value) | TableCell::Shown(value, _) => Some(*value),
        TableCell::None(_) => Some(f64::NAN),
        TableCell::Text(text) | TableCell::Default(text) if text.is_empty() => Some(f64::NAN),
        TableCell::Text(text) | TableCell::Default(text) => text.parse().ok(),
    };
    let column = |(at, column): (usize, &TableColumn)| {
        let cells = || table.rows.iter().map(move |row| &row[at]);
        let name = (&*column.key, &*column.unit);
        if let Some(values) = cells().map(number).collect::<Option<Vec<f64>>>() {
            return Ok(numbers(py, name, values.into_iter()));
        }
        let texts = PyList::new(py, cells().map(TableCell::text))?;
        Ok((name.0.to_owned(), name.1.to_owned(), texts.into_any().unbind()))
    };
    table.columns.iter().enumerate().map(column).collect()
}

/// A writer's output as text.
fn written(write: impl FnOnce(&mut Vec<u8>) -> io::Result<()>) -> PyResult<String> {
    let mut bytes = Vec::new();
    write(&mut bytes)?;
    Ok(String::from_utf8_lossy(&bytes).into_owned())
}

/// A case that does not change.
#[pyclass(frozen, module = "tipstrike")]
struct Case {
    /// The file with the variant.
    #[pyo3(get)]
    name: String,
    #[pyo3(get)]
    variant: Option<String>,
    document: Document,
    /// The changes of a call, for the place of an error.
    changes: Vec<(String, String)>,
    inputs: OnceLock<Result<Inputs, Vec<Problem>>>,
}

impl Case {
    fn of(name: String, document: Document, changes: Vec<(String, String)>) -> Case {
        Case { name, variant: None, document, changes, inputs: OnceLock::new() }
    }

    fn read_inputs(&self) -> &Result<Inputs, Vec<Problem>> {
        self.inputs.get_or_init(|| {
            self.document.case.inputs().map_err(|mut problems| {
                problems.sort_by_key(|problem| self.document.place(&problem.field));
                problems
            })
        })
    }

    fn inputs(&self) -> PyResult<&Inputs> {
        self.read_inputs().as_ref().map_err(|problems| self.faulty(problems.clone()))
    }

    /// The inputs of a valid changed case, without reading the other fields again. `None` if every
    /// field must be read.
    fn changed_inputs(&self, case: &Fields, changes: &[(String, String)]) -> Option<Inputs> {
        let before = self.read_inputs().as_ref().ok()?;
        let mut inputs = before.clone();
        for (key, _) in changes {
            let field = index_of(key)?;
            case.text(field)?;
            put_field(case, field, &mut inputs).ok()?;
        }
        // Only `auto` needs the stages of the limits.
        let is_auto = [before.method, inputs.method].map(|method| method == Method::Auto);
        match is_auto {
            [false, true] => return None,
            [true, false] => inputs.needs = Stages::NONE,
            _ => {}
        }
        violated_rule(&inputs).is_none().then_some(inputs)
    }

    /// Problems at the change that causes them, otherwise in the text.
    fn faulty(&self, problems: Vec<Problem>) -> PyErr {
        let placed = problems.into_iter().map(|problem| {
            let mut changes = self.changes.iter().rev();
            let change = changes.find(|(key, _)| *key == problem.field);
            let change = change.map(|(key, value)| format!("{}, {key}={value}", self.name));
            let place = change.unwrap_or_else(|| {
                let (line, column) = self.document.place(&problem.field);
                format!("{}:{line}:{column}", self.name)
            });
            (place, problem)
        });
        bad_case(placed.collect())
    }

    fn refused(&self, refusal: &Refusal) -> PyErr {
        self.faulty(vec![Problem::from(refusal).at_given(&self.document.case)])
    }

    /// Why a study of the case has no result.
    fn failed(&self, reason: &impl Display) -> PyErr {
        self.faulty(vec![Problem::new("case", reason.to_string(), "change the case")])
    }

    fn named(&self) -> Named<'_> {
        Named { name: &self.name, title: self.document.case.title() }
    }

    fn unsolved(&self) -> PyResult<Unsolved<'_>> {
        Ok(Unsolved { name: &self.name, case: &self.document.case, inputs: self.inputs()? })
    }

    fn found(&self, py: Python<'_>, results: &dyn Results) -> PyResult<Found> {
        let write = |format| written(|out| self.named().write(results, format, out));
        let columns = columns(py, &results.table())?;
        Ok((columns, write(Format::Json)?, write(Format::Text)?, Vec::new()))
    }

    /// The inputs with which method `auto` computes these quantities.
    fn needing(&self, quantities: &[&Quantity]) -> PyResult<Inputs> {
        let stages = quantities.iter().map(|quantity| quantity.stage);
        Ok(self.inputs()?.clone().needing(stages))
    }

    fn answer(
        &self,
        py: Python<'_>,
        question: &impl Question,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Found> {
        let case = self.with_varied(question.varied().map_err(misuse)?);
        let inputs = case.inputs()?;
        let found = run(py, progress, |go_on| question.answer(inputs, go_on))?;
        let found = found.map_err(|none| match none {
            NoAnswer::Misused(misused) => misuse(misused),
            NoAnswer::Refused(refusal) => case.refused(&refusal),
            NoAnswer::Failed(reason) => case.failed(&reason),
        })?;
        case.found(py, &*found)
    }

    /// The case with a value for each field that a study varies and that the case lacks.
    fn with_varied(&self, fields: impl IntoIterator<Item = (usize, String)>) -> Case {
        let mut document = self.document.clone();
        for (field, value) in fields {
            if document.case.effective(field).is_none() {
                // An invalid value is reported with its point.
                let _ = document.case.set(FIELDS[field].key, &value);
            }
        }
        Case::of(self.name.clone(), document, self.changes.clone())
    }
}

#[pymethods]
impl Case {
    /// Reads a case file, or the only spur stage of a REXS model.
    #[staticmethod]
    fn read(path: PathBuf) -> PyResult<Case> {
        let name = path.display().to_string();
        let document = if rexs::is_model(&path) {
            let bytes = read_bytes(&path, MOST_MODEL_BYTES).map_err(unread)?;
            rexs::import(&path, &bytes, None).map_err(wrong)?.document
        } else {
            Document::read_draft(&path).map_err(unread)?
        };
        Ok(Case::of(name, document, Vec::new()))
    }

    /// Parses the text of a case file.
    #[staticmethod]
    fn parse(name: String, text: &str) -> PyResult<Case> {
        let parsed = Document::parse_draft(&name, text).map_err(ReadError::Bad);
        Ok(Case::of(name, parsed.map_err(unread)?, Vec::new()))
    }

    /// The case with a variant and with other values.
    fn changed(&self, changes: Vec<(String, String)>, variant: Option<&str>) -> PyResult<Case> {
        let (mut name, mut document) = (self.name.clone(), self.document.clone());
        if let Some(variant) = variant {
            let known = document.case.variant(variant).cloned();
            let known = known.map_err(|problem| misused("variant", &problem))?;
            document.case = document.case.with(&known);
            name = format!("{name}:{variant}");
        }
        for (at, (key, value)) in changes.iter().enumerate() {
            if let Some((other, _)) =
                changes[..at].iter().find(|(other, _)| Fields::are_exclusive(other, key))
            {
                return Err(wrong(format!(
                    "{key}: {other} excludes this field: leave one of them out"
                )));
            }
            document
                .case
                .set(key, value)
                .map_err(|problem| bad_case(vec![(format!("{name}, {key}={value}"), problem)]))?;
        }
        let inputs = match variant {
            None => self.changed_inputs(&document.case, &changes),
            Some(_) => None,
        };
        let inputs = inputs.map(Ok).map(OnceLock::from).unwrap_or_default();
        let changes = self.changes.iter().cloned().chain(changes).collect();
        let variant = variant.map(str::to_owned).or_else(|| self.variant.clone());
        Ok(Case { variant, inputs, ..Case::of(name, document, changes) })
    }

    #[getter]
    fn title(&self) -> &str {
        self.document.case.title()
    }

    #[getter]
    fn variants(&self) -> Vec<&str> {
        self.document.case.variants.iter().map(|variant| variant.name.as_str()).collect()
    }

    /// The text of the case file with the changes.
    fn text(&self) -> String {
        self.document.render()
    }

    /// The text of a field, given or by default.
    fn get(&self, key: &str) -> PyResult<Option<&str>> {
        let field = index_of(key).ok_or_else(|| PyKeyError::new_err(key.to_owned()))?;
        Ok(self.document.case.effective(field))
    }

    fn solve(
        case: Py<Case>,
        py: Python<'_>,
        only: Vec<String>,
        stations: bool,
    ) -> PyResult<Solved> {
        let only = quantities(&only)?;
        let selection = Selection { stations: stations || only.is_empty(), only };
        let this = case.get();
        let inputs = this.inputs()?.clone();
        let solved = py.detach(|| selection.solve(inputs));
        let (inputs, solution) = solved.map_err(|refusal| this.refused(&refusal))?;
        match solution.withheld {
            Some(refusal) if selection.values(&solution).count() < selection.only.len() => {
                Err(this.refused(&refusal))
            }
            _ => Ok(Solved { case, inputs, solution, selection, stations }),
        }
    }

    #[expect(clippy::too_many_arguments, reason = "the options of the command")]
    fn sweep(
        &self,
        py: Python<'_>,
        vary: Vec<String>,
        points: Vec<usize>,
        log: bool,
        only: Vec<String>,
        jobs: Option<u16>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<(Vec<Column>, Vec<String>)> {
        let grid = Grid::parse(&vary, &points, log);
        let grid = grid
            .map_err(|(text, problem)| misused(text.split('=').next().unwrap_or(text), &problem))?;
        let case = self.with_varied(grid.axes.iter().map(|axis| (axis.field, axis.with_unit(0))));
        let mut quantities = quantities(&only)?;
        let inputs = case.needing(&quantities)?;
        if quantities.is_empty() {
            quantities = headline(&case.document.case, &grid.methods(&inputs));
        }
        let batch = Batch { inputs: &inputs, points: &grid, quantities: &quantities };
        let (rows, notes) = solved(py, &batch, jobs, progress)?;
        let points = (&grid as &dyn Points, &grid.methods(&inputs)[..]);
        Ok((columns(py, &table(points, &quantities, 0, &rows))?, notes))
    }

    #[expect(clippy::too_many_arguments, reason = "the options of the command")]
    fn tolerance(
        &self,
        py: Python<'_>,
        samples: usize,
        seed: u64,
        ranking: Option<usize>,
        only: Vec<String>,
        jobs: Option<u16>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Found> {
        within("samples", samples, 2, MOST_SAMPLES).map_err(misuse)?;
        let only = quantities(&only)?;
        let inputs = self.needing(&only)?;
        let case = &self.document.case;
        let size = Size { samples, seed, ranked: ranking };
        let study = Tolerance::of(case, &inputs, &only, size);
        let study = study.map_err(|problem| self.faulty(vec![problem]))?;
        let (points, quantities) = (&study.design, &study.quantities);
        let batch = Batch { inputs: &inputs, points, quantities };
        let (rows, notes) = solved(py, &batch, jobs, progress)?;
        let mut found = Samples::of(&study);
        found.add(0, &rows);
        let report =
            ToleranceReport { case, method: inputs.method, study: &study, samples: &found };
        let (_, json, text, _) = self.found(py, &report)?;
        let points = (points as &dyn Points, &[inputs.method][..]);
        Ok((columns(py, &table(points, quantities, 0, &rows))?, json, text, notes))
    }

    fn seek(
        &self,
        py: Python<'_>,
        vary: String,
        until: String,
        points: usize,
        jobs: Option<u16>,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Found> {
        self.answer(py, &Seek { vary, until, points, threads: Threads { jobs } }, progress)
    }

    #[expect(clippy::too_many_arguments, reason = "the options of the command")]
    fn relief(
        &self,
        py: Python<'_>,
        load: &str,
        spectrum: Option<&str>,
        tolerance: &str,
        tolerance_length: Option<&str>,
        misalignment: &str,
        minimise: &str,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Found> {
        let minimise = Criterion::ALL.into_iter().find(|known| known.name() == minimise);
        let demand = Demand {
            loads: demand::loads(load).map_err(wrong)?,
            spectrum: demand::spectrum(spectrum.unwrap_or_default()).map_err(wrong)?,
            tolerance: demand::tolerance(tolerance).map_err(wrong)?,
            tolerance_length: tolerance_length.map(demand::tolerance).transpose().map_err(wrong)?,
            misalignment: demand::tolerance(misalignment).map_err(wrong)?,
            minimise: minimise.ok_or_else(|| wrong("minimise: write te, peak or entry"))?,
            units: System::Metric,
        };
        self.answer(py, &demand, progress)
    }

    fn stiffness(&self, py: Python<'_>, points: usize) -> PyResult<Found> {
        self.answer(py, &Stiffness { points }, None)
    }

    fn excitation(
        &self,
        py: Python<'_>,
        points: usize,
        progress: Option<Py<PyAny>>,
    ) -> PyResult<Found> {
        self.answer(py, &Excitation { points }, progress)
    }

    /// A chart as SVG.
    fn plot(&self, py: Python<'_>, chart: &str, progress: Option<Py<PyAny>>) -> PyResult<String> {
        let picture = find(chart).ok_or_else(|| {
            let names: Vec<&str> = pictures().map(|picture| picture.key).collect();
            wrong(format!("{chart}: there is no such chart: write one of {}", names.join(", ")))
        })?;
        let source = self.unsolved()?;
        let drawn = run(py, progress, |go_on| picture.of_case(source, System::Metric, go_on))?;
        let drawn = drawn.map_err(|refusal| self.refused(&refusal))?;
        drawn.map_err(|reason| self.failed(&reason))
    }

    fn __repr__(&self) -> String {
        format!("<Case {:?} {:?}>", self.name, self.title())
    }
}

/// The results of a solve.
#[pyclass(frozen, module = "tipstrike")]
struct Solved {
    case: Py<Case>,
    inputs: Inputs,
    solution: Solution,
    selection: Selection,
    /// Whether the text has the stations.
    stations: bool,
}

impl Solved {
    /// The report with its notes, which few calls need.
    fn report(&self) -> Report {
        let Case { name, document, .. } = self.case.get();
        let (inputs, solution) = (self.inputs.clone(), self.solution.clone());
        Report::of(name.clone(), document.case.clone(), inputs, solution, self.selection.clone())
    }
}

#[pymethods]
impl Solved {
    /// The value of a quantity, by name or symbol, and its unit.
    fn get<'py>(&self, py: Python<'py>, name: &str) -> Option<(Bound<'py, PyAny>, &'static str)> {
        let quantity = quantity("", name).ok()?;
        let mut values = self.selection.values(&self.solution);
        let (_, value) = values.find(|(known, _)| known.key == quantity.key)?;
        let value = if quantity.is_flag() {
            PyBool::new(py, value != 0.0).to_owned().into_any()
        } else {
            PyFloat::new(py, value).into_any()
        };
        Some((value, quantity.unit))
    }

    /// Why a name has no value.
    fn absence(&self, name: &str) -> String {
        let quantity = match quantity("", name) {
            Ok(quantity) => quantity,
            Err(Problem { cause, fix, .. }) => return format!("{cause}: {fix}"),
        };
        if self.selection.quantities().all(|known| known.key != quantity.key) {
            return "not computed: name the quantity in `only`".to_owned();
        }
        format!("no value: {}", Absence::of(quantity, &self.solution))
    }

    fn keys(&self) -> Vec<&'static str> {
        self.selection.values(&self.solution).map(|(quantity, _)| quantity.key).collect()
    }

    #[getter]
    fn method(&self) -> &'static str {
        self.solution.method.name()
    }

    #[getter]
    fn outcome(&self) -> &'static str {
        self.solution.outcome.name()
    }

    #[getter]
    fn notes(&self) -> Vec<(&'static str, String)> {
        self.report().notes.into_iter().map(|note| (note.code, note.to_string())).collect()
    }

    /// The line of `tipstrike solve --format json`.
    fn json(&self) -> PyResult<String> {
        written(|out| write_json(&self.report(), out))
    }

    /// The text of `tipstrike solve`.
    fn text(&self, py: Python<'_>) -> String {
        let mut report = self.report();
        report.selection.stations = self.stations;
        py.detach(|| data::render(&report.with_others()))
    }

    /// The stations; of a pair in slices also the line load of the incoming tooth over angle and face.
    fn stations(&self, py: Python<'_>) -> PyResult<Vec<Column>> {
        if !self.selection.stations {
            return Ok(Vec::new());
        }
        let mut all = columns(py, &stations(&self.report()))?;
        if let Some(pattern) = Pattern::of(&self.inputs, &self.solution) {
            let (angles, places, loads) = pattern.grid();
            all.push(numbers(py, ("line_load_roll_angle_driver", "rad"), angles.into_iter()));
            all.push(numbers(py, ("line_load_z", "m"), places.iter().copied()));
            all.push(numbers(py, ("line_load", "N/m"), loads));
        }
        Ok(all)
    }
}

/// The cases side by side, as JSON and text.
#[pyfunction]
fn compare(
    py: Python<'_>,
    cases: Vec<PyRef<'_, Case>>,
    only: Vec<String>,
    progress: Option<Py<PyAny>>,
) -> PyResult<(String, String)> {
    let selection = Selection { only: quantities(&only)?, stations: false };
    let plain = |case: &PyRef<'_, Case>| {
        let file = case.document.name().to_owned();
        (file, case.variant.clone(), case.name.clone(), case.document.case.clone())
    };
    let cases: Vec<_> = cases.iter().map(plain).collect();
    let count = cases.len();
    let cases = run(py, progress, |go_on| {
        let wanted = cases.into_iter().enumerate().take_while(|(at, _)| go_on(*at, count));
        let solved = wanted.map(|(_, (file, variant, name, case))| ComparedCase {
            file,
            variant,
            ..compared(name, case, &selection)
        });
        solved.collect::<Vec<_>>()
    })?;
    let comparison = comparison(cases, selection);
    Ok((written(|out| comparison.write_json(out))?, written(|out| comparison.write(out))?))
}

/// A report on cases in the format of a file name.
#[pyfunction]
fn report(
    py: Python<'_>,
    cases: Vec<PyRef<'_, Case>>,
    name: PathBuf,
    title: Option<String>,
    no_appendix: bool,
    progress: Option<Py<PyAny>>,
) -> PyResult<String> {
    let format = format_of(Path::new(&name));
    let format = format.ok_or_else(|| {
        wrong(format!(
            "{}: the extension selects the format: use .html, .md, .csv or .json",
            name.display()
        ))
    })?;
    let cases: Vec<&Case> = cases.iter().map(|case| &**case).collect();
    let mut subjects = Vec::new();
    for case in cases {
        let (source, file) = (case.unsolved()?, case.text());
        let call = progress.as_ref().map(|call| call.clone_ref(py));
        let subject = run(py, call, |go_on| source.subject(file, format, None, go_on))?;
        subjects.push(subject.map_err(|refusal| case.refused(&refusal))?);
    }
    Ok(render(
        format,
        &subjects,
        &page::Settings { title, no_appendix, ..page::Settings::default() },
    )?)
}

/// The SI unit of each field; empty for bare numbers.
#[pyfunction]
fn units() -> Vec<(&'static str, &'static str)> {
    let unit = |kind: &Kind| match kind {
        Kind::Number(dimension, ..) => dimension.si_unit(),
        _ => "",
    };
    FIELDS.iter().map(|field| (field.key, unit(&field.kind))).collect()
}

/// The text of a built-in example.
#[pyfunction]
fn example(name: &str) -> PyResult<&'static str> {
    let found = Example::find(name);
    found
        .map(|example| example.text)
        .map_err(|fix| wrong(format!("{name}: no such example: {fix}")))
}

/// The version of the program.
#[pyfunction]
fn version() -> &'static str {
    env!("CARGO_PKG_VERSION")
}

/// The names of the built-in examples.
#[pyfunction]
fn examples() -> Vec<&'static str> {
    EXAMPLES.iter().map(|example| example.name).collect()
}

/// The command: its exit code. The workbench ends the process.
#[pyfunction]
fn main(arguments: Vec<OsString>) -> u8 {
    crate::system::report_file_limit_as_error();
    let mut streams = Streams::standard();
    match cli::parse(arguments, &mut streams) {
        Err(exit) => exit as u8,
        Ok(Arguments { command: Some(command), .. }) => cli::run(&command, &mut streams) as u8,
        #[cfg(unix)]
        Ok(Arguments { case, .. }) => crate::tui::run(case),
        #[cfg(not(unix))]
        Ok(_) => cli::refuse_workbench(&mut streams) as u8,
    }
}

#[pymodule]
mod _tipstrike {
    #[pymodule_export]
    use super::{Case, Solved, compare, example, examples, main, report, units, version};
}
