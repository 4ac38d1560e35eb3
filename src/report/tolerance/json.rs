//! A tolerance study as one JSON object.

use std::io::{self, Write};

use serde::Serialize;

use super::ToleranceReport;
use crate::report::json::write_line;
use crate::study::batch::Points;
use crate::study::statistics::{Estimate, Figure, Figures, PERCENTILES};
use crate::study::tolerance::{Exceedance, OfQuantity};

#[derive(Serialize)]
struct Line<'a> {
    case: &'a str,
    title: &'a str,
    version: &'static str,
    method: &'a str,
    samples: usize,
    seed: u64,
    solved: usize,
    refused: Vec<Refused<'a>>,
    spread: Vec<Distribution<'a>>,
    combination: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    corner_contact: Option<Interval>,
    limits: Vec<Compared<'a>>,
    quantities: serde_json::Map<String, serde_json::Value>,
}

#[derive(Serialize)]
struct Refused<'a> {
    count: usize,
    of: usize,
    field: &'a str,
    cause: &'a str,
    fix: &'a str,
}

#[derive(Serialize)]
struct Distribution<'a> {
    field: &'a str,
    shape: &'static str,
    width: &'a str,
    centre: f64,
    unit: &'static str,
}

#[derive(Serialize)]
struct Compared<'a> {
    quantity: &'static str,
    limit: &'a str,
    samples: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    exceeded: Option<Interval>,
}

#[derive(Serialize)]
struct Interval {
    value: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    from: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    to: Option<f64>,
}

impl Interval {
    fn of(estimate: &Estimate) -> Interval {
        Interval { value: estimate.value, from: Some(estimate.from), to: Some(estimate.to) }
    }

    /// The ends are absent if the sample is too small for an interval.
    fn of_figure(figure: &Figure) -> Interval {
        Interval {
            value: figure.value,
            from: figure.interval.map(|ends| ends.0),
            to: figure.interval.map(|ends| ends.1),
        }
    }
}

#[derive(Serialize)]
struct Quantity {
    unit: &'static str,
    count: usize,
    #[serde(skip_serializing_if = "Option::is_none")]
    figures: Option<Shape>,
    #[serde(skip_serializing_if = "Option::is_none")]
    no_value: Option<String>,
    ranked: usize,
    #[serde(skip_serializing_if = "Vec::is_empty")]
    ranking: Vec<Share>,
}

#[derive(Serialize)]
struct Shape {
    p5: Interval,
    p50: Interval,
    p95: Interval,
    mean: Interval,
    standard_deviation: f64,
    least: f64,
    greatest: f64,
    histogram: Vec<usize>,
}

impl Shape {
    fn of(figures: &Figures) -> Shape {
        debug_assert!(PERCENTILES.map(f64::to_bits) == [5.0, 50.0, 95.0].map(f64::to_bits));
        let [p5, p50, p95] = figures.percentiles.each_ref().map(Interval::of_figure);
        Shape {
            p5,
            p50,
            p95,
            mean: Interval::of_figure(&figures.mean),
            standard_deviation: figures.deviation,
            least: figures.range.0,
            greatest: figures.range.1,
            histogram: figures.histogram.clone(),
        }
    }
}

#[derive(Serialize)]
struct Share {
    field: &'static str,
    first_order: Interval,
    total: Interval,
}

pub(super) fn write(report: &ToleranceReport, out: &mut dyn Write) -> io::Result<()> {
    let study = report.study;
    let summary = study.summary(report.samples);
    let title = Some(report.case.title()).filter(|title| !title.is_empty());
    let quantities = summary.quantities.iter().map(|of| {
        let value = serde_json::to_value(quantity(report, of))?;
        Ok((of.quantity.key.to_owned(), value))
    });
    let line = Line {
        case: report.name,
        title: title.unwrap_or_default(),
        version: env!("CARGO_PKG_VERSION"),
        method: report.method,
        samples: study.design.samples,
        seed: study.design.seed,
        solved: summary.solved,
        refused: refused(report),
        spread: spread(report),
        combination: report.combination(),
        corner_contact: summary.contact.as_ref().map(Interval::of),
        limits: summary.limits.iter().map(limit).collect(),
        quantities: quantities.collect::<Result<_, serde_json::Error>>()?,
    };
    write_line(&line, out)
}

fn refused<'a>(report: &ToleranceReport<'a>) -> Vec<Refused<'a>> {
    let reasons = report.samples.refusals.0.iter();
    reasons
        .map(|refused| Refused {
            count: refused.count,
            of: report.study.design.count(),
            field: &refused.problem.field,
            cause: &refused.problem.cause,
            fix: &refused.problem.fix,
        })
        .collect()
}

fn spread<'a>(report: &ToleranceReport<'a>) -> Vec<Distribution<'a>> {
    let held = report.case.spread.iter();
    held.zip(&report.study.design.distributions)
        .map(|(held, distribution)| Distribution {
            field: held.field,
            shape: held.shape.name(),
            width: &held.text,
            centre: distribution.centre,
            unit: match distribution.unit() {
                "" => "1",
                unit => unit,
            },
        })
        .collect()
}

fn limit(exceedance: &Exceedance) -> Compared<'_> {
    Compared {
        quantity: exceedance.quantity.key,
        limit: &exceedance.limit.text,
        samples: exceedance.known,
        exceeded: exceedance.probability.as_ref().map(Interval::of),
    }
}

fn quantity(report: &ToleranceReport, of: &OfQuantity) -> Quantity {
    let fields = report.study.design.distributions.iter();
    let shares = of.indices.iter().flatten().zip(fields);
    Quantity {
        unit: of.quantity.unit,
        count: of.figures.as_ref().map_or(0, |figures| figures.count),
        figures: of.figures.as_ref().map(Shape::of),
        no_value: report.why_absent(of.quantity),
        ranked: of.ranked,
        ranking: shares
            .map(|(indices, distribution)| Share {
                field: distribution.key(),
                first_order: Interval::of(&indices.first_order),
                total: Interval::of(&indices.total),
            })
            .collect(),
    }
}
