//! The studies of a case on its page: its variants and its tolerance.

use std::sync::atomic::{AtomicBool, Ordering};

use crate::case::{Case, FIELDS, Problem};
use crate::model::inputs::Method;
use crate::model::{Inputs, Quantity};
use crate::report::compare::{Column, Comparison, Refused, Row};
use crate::report::{Report, Selection, common_unit, shown_with};
use crate::study::batch::{Control, Stopped};
use crate::study::condition::{distinct, headline};
use crate::study::statistics::{Estimate, PERCENTILES};
use crate::study::tolerance::{Samples, Size, Tolerance};

use crate::case::sanitize::sanitize;
use crate::case::units::System;

/// Samples of a closed form, as in the command `tolerance`.
const SAMPLES: usize = 10_000;
/// Samples of a method that shares the load: a solve takes a hundred times as long.
const FEW_SAMPLES: usize = 1000;
/// Seed of the command `tolerance`.
const SEED: u64 = 1;
/// Quantities of variants in addition to the headline quantities.
const OF_VARIANTS: [&str; 4] =
    ["total_deviation", "static_te_peak_to_peak", "mesh_force_factor", "steady_back_strikes"];

/// The studies of a case.
#[derive(Debug, Default)]
pub struct Studies {
    variants: Option<Comparison>,
    tolerance: Option<(Tolerance, Samples)>,
}

pub(super) struct StudyTable {
    pub(super) title: String,
    pub(super) names: Vec<String>,
    pub(super) rows: Vec<Vec<String>>,
    pub(super) sentences: Vec<String>,
}

impl Studies {
    /// Computes the studies of the case: its `[variants]` and its `[spread]`. `go_on` receives the
    /// number of solved points and their total.
    ///
    /// # Errors
    /// [`Stopped`] if `go_on` returns false.
    pub fn of(
        case: &Case,
        inputs: &Inputs,
        go_on: &dyn Fn(usize, usize) -> bool,
    ) -> Result<Studies, Stopped> {
        let variants = variants(case, inputs, go_on)?;
        let is_stopped = AtomicBool::new(false);
        let control = Control {
            jobs: None,
            go_on: &|| !is_stopped.load(Ordering::Relaxed),
            progress: &|done, of| is_stopped.store(!go_on(done, of), Ordering::Relaxed),
        };
        let samples = if inputs.method.shares_load() || inputs.method == Method::Auto {
            FEW_SAMPLES
        } else {
            SAMPLES
        };
        let size = Size { samples, seed: SEED, ranked: Some(0) };
        let study = Tolerance::of(case, inputs, &[], size).ok();
        let sampled = study.map(|study| {
            let samples = study.run(inputs, &control)?;
            Ok((study, samples))
        });
        Ok(Studies { variants, tolerance: sampled.transpose()? })
    }

    pub(super) fn tables(&self, case: &Case) -> Vec<StudyTable> {
        let variants = self.variants.iter().map(of_variants);
        let tolerance = self.tolerance.iter();
        let tolerance = tolerance.map(|(study, samples)| of_tolerance(case, study, samples));
        variants.chain(tolerance).collect()
    }
}

/// The case and its variants; `None` without variants.
fn variants(
    case: &Case,
    inputs: &Inputs,
    go_on: &dyn Fn(usize, usize) -> bool,
) -> Result<Option<Comparison>, Stopped> {
    if case.variants.is_empty() {
        return Ok(None);
    }
    let cases: Vec<(&str, Case)> = std::iter::once(("case", case.clone()))
        .chain(case.variants.iter().map(|one| (one.name.as_str(), case.with(one))))
        .collect();
    let methods = cases.iter().filter_map(|(_, case)| Some(case.inputs().ok()?.method));
    let methods: Vec<Method> = methods.chain([inputs.method]).collect();
    let others = OF_VARIANTS.iter().filter_map(|key| Quantity::find(key));
    let selection = Selection {
        only: distinct(headline(case, &methods).into_iter().chain(others)),
        stations: false,
    };
    let count = cases.len();
    let solved = cases.into_iter().enumerate().map(|(at, (name, case))| {
        if !go_on(at, count) {
            return Err(Stopped);
        }
        let found = case.inputs().and_then(|inputs| {
            Report::solve(name.to_owned(), case.clone(), inputs, selection.clone())
                .map_err(|refusal| vec![Problem::from(&refusal).at_given(&case)])
        });
        Ok(Column {
            name: name.to_owned(),
            file: String::new(),
            variant: (at > 0).then(|| name.to_owned()),
            case,
            found: found.map_err(|problems| problems.into_iter().map(refused).collect()),
        })
    });
    let columns = solved.collect::<Result<Vec<_>, _>>()?;
    Ok(Some(Comparison { columns, selection }))
}

fn refused(problem: Problem) -> Refused {
    Refused { line: format!("{}: {}: {}", problem.field, problem.cause, problem.fix), problem }
}

fn of_variants(comparison: &Comparison) -> StudyTable {
    let columns = comparison.columns.iter();
    let names = columns.clone().map(|column| sanitize(&column.name));
    let cells = |row: &Row| {
        let values = row.values.iter().zip(&row.differences);
        let values = values.map(|(value, difference)| match difference.as_str() {
            "" => sanitize(value),
            difference => format!("{} ({difference})", sanitize(value)),
        });
        let label = [sanitize(&row.label), sanitize(&row.symbol)];
        let cells = label.into_iter().chain(values);
        cells.chain([row.unit.to_owned()]).collect()
    };
    let refused = columns.filter_map(|column| Some((&column.name, column.found.as_ref().err()?)));
    let sentences = refused.flat_map(|(name, all)| {
        let lines = all.iter().map(move |one| format!("{name}: {}", one.line));
        lines.map(|line| sanitize(&line))
    });
    StudyTable {
        title: "Variants, with the differences from the case".to_owned(),
        names: [String::new(), String::new()]
            .into_iter()
            .chain(names)
            .chain([String::new()])
            .collect(),
        rows: comparison.brief().iter().map(cells).collect(),
        sentences: sentences.collect(),
    }
}

fn of_tolerance(case: &Case, study: &Tolerance, samples: &Samples) -> StudyTable {
    let summary = study.summary(samples);
    let design = &study.design;
    let percentiles = PERCENTILES.iter().map(|percent| format!("P{percent}"));
    let names = ["quantity", ""].map(str::to_owned).into_iter();
    let figures = ["mean", "standard deviation", "unit"].map(str::to_owned);
    let names = names.chain(percentiles).chain(figures).collect();
    let rows = summary.quantities.iter().filter_map(|of| {
        let (quantity, found) = (of.quantity, of.figures.as_ref()?);
        let ends = [found.range.0, found.range.1].into_iter();
        let unit = common_unit(quantity, ends, System::Metric);
        let shown = |value: f64| shown_with(quantity, value, unit);
        let values = found.percentiles.iter().map(|one| one.value);
        let values = values.chain([found.mean.value, found.deviation]);
        let label = [quantity.label, quantity.symbol].map(str::to_owned);
        let cells = label.into_iter().chain(values.map(|value| shown(value).number));
        let unit = shown(found.mean.value).unit.to_owned();
        Some(cells.chain([unit]).collect())
    });
    let refused = design.samples - summary.solved;
    let refused = if refused == 0 { String::new() } else { format!(", {refused} refused") };
    let spread = case.spread.iter().map(|spread| {
        let field = FIELDS.iter().position(|field| field.key == spread.field);
        let value = field.and_then(|field| case.effective(field));
        format!("{} {}, {}", spread.field, value.unwrap_or_default(), spread.in_words())
    });
    let spread: Vec<String> = spread.map(|words| sanitize(&words)).collect();
    let contact = summary.contact.map(|found| chance("corner contact", &found));
    let limits = summary.limits.iter().filter_map(|limit| {
        let name = format!("{} > {}", limit.quantity.key, sanitize(&limit.limit.text));
        Some(chance(&name, limit.probability.as_ref()?))
    });
    StudyTable {
        title: format!("Tolerance, {} samples{refused}, seed {SEED}", design.samples),
        names,
        rows: rows.collect(),
        sentences: [format!("Spread: {}.", spread.join("; "))]
            .into_iter()
            .chain(contact)
            .chain(limits)
            .collect(),
    }
}

fn chance(what: &str, Estimate { value, from, to }: &Estimate) -> String {
    let percent = |part: &f64| format!("{:.1}", 100.0 * part);
    let (value, from, to) = (percent(value), percent(from), percent(to));
    format!("Probability of {what}: {value} % (95 % interval {from} to {to} %).")
}
