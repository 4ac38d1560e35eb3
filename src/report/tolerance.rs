//! A tolerance study as text, JSON or CSV.

use std::io::{self, Write};

use super::absence::Absence;
use super::data::{cell, write_rows};
use crate::case::Case;
use crate::case::fields::{FIELDS, index_of};
use crate::case::sanitize::sanitize;
use crate::case::units::System;
use crate::model::Quantity;
use crate::model::inputs::Method;
use crate::report::data::write_line;
use crate::report::{common_unit, shown_with};
use crate::study::batch::{Points, Refused};
use crate::study::sample::Member;
use crate::study::statistics::{Estimate, Figure, Figures, Indices, PERCENTILES, least_count};
use crate::study::tolerance::{Exceedance, OfQuantity, Samples, Summary, Tolerance};
use serde::Serialize;

/// A tolerance study and its results.
#[derive(Clone, Copy)]
pub struct ToleranceReport<'a> {
    /// The name of the case, as the user gave it.
    pub name: &'a str,
    /// The case.
    pub case: &'a Case,
    /// The name of the method.
    pub method: &'a str,
    /// The study.
    pub study: &'a Tolerance,
    /// Its results.
    pub samples: &'a Samples,
}

impl ToleranceReport<'_> {
    /// Writes the results as text.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        write_text(self, out)
    }

    /// Writes the results for a screen that already shows the case: the figures, then the spread.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_for_screen(&self, out: &mut dyn Write) -> io::Result<()> {
        write_for_screen(self, out)
    }

    /// Writes the results as one JSON object on one line.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_json(&self, out: &mut dyn Write) -> io::Result<()> {
        write_json(self, out)
    }

    /// Writes one row per solve: the samples, then the points of the ranking.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let study = self.study;
        let spread = study.design.distributions.iter().map(|distribution| {
            let unit = distribution.unit();
            let unit = if unit.is_empty() { "1" } else { unit };
            format!("{} [{unit}]", distribution.key())
        });
        let computed =
            study.quantities.iter().map(|quantity| format!("{} [{}]", quantity.key, quantity.unit));
        let names = ["sample", "set"].map(str::to_owned).into_iter();
        let header = names.chain(spread).chain(computed);
        let header = header.chain(["outcome".to_owned()]).collect();
        let rows = (0..study.design.count()).map(|index| self.row(index));
        write_rows(std::iter::once(header).chain(rows), out)
    }

    fn row(&self, index: usize) -> Vec<String> {
        let design = &self.study.design;
        let (number, set) = match design.member(index) {
            Member::Sample(number) => (number, "a".to_owned()),
            Member::Second(number) => (number, "b".to_owned()),
            Member::Swapped(number, field) => {
                (number, format!("b:{}", design.distributions[field].key()))
            }
        };
        let spread = design.values(index).into_iter().map(|value| cell(Some(value)));
        let quantities = 0..self.study.quantities.len();
        let computed = quantities.map(|at| cell(self.samples.value(at, index)));
        let outcome = self.samples.outcomes[index].name().to_owned();
        [number.to_string(), set]
            .into_iter()
            .chain(spread)
            .chain(computed)
            .chain([outcome])
            .collect()
    }

    /// How the base pitch deviations of a sample add, by its name in a case file.
    fn combination(&self) -> &'static str {
        let key = index_of("deviations.combination");
        let text = key.and_then(|key| self.case.effective(key));
        if self.study.design.draws_known_deviations() || text == Some("sum") {
            "sum"
        } else {
            "independent"
        }
    }

    /// Why no sample has a value of a quantity, if another method computes it.
    fn why_absent(&self, quantity: &Quantity) -> Option<String> {
        let mut methods = Method::ALL.into_iter();
        let method = methods.find(|method| method.name() == self.method)?;
        Absence::by_method(quantity, method).map(|absence| absence.to_string())
    }

    /// Refused points in one sentence.
    #[must_use]
    pub fn refused(&self, refused: &Refused) -> String {
        let design = &self.study.design;
        let (count, of) = (refused.count, design.count());
        let which = if count == 1 { "" } else { "the first " };
        let point = design.point(refused.first);
        format!("{count} of {of} points refused, {which}at {point}: {}", refused.problem)
    }
}

/// Whether every sample is refused.
#[must_use]
pub fn is_all_refused(samples: &Samples) -> bool {
    samples.refusals.total() == samples.outcomes.len()
}

/// Greatest length of a bar of a histogram, in characters.
const LONGEST_BAR: usize = 40;

fn write_text(report: &ToleranceReport, out: &mut dyn Write) -> io::Result<()> {
    let summary = report.study.summary(report.samples);
    let title = Some(report.case.title()).filter(|title| !title.is_empty());
    writeln!(out, "{}", sanitize(title.unwrap_or(report.name)))?;
    samples(report, &summary, out)?;
    spread(report, out)?;
    figures(report, &summary, "#", out)
}

/// Writes the results for a screen that already shows the case: the figures come first, and bars
/// consist of block characters.
fn write_for_screen(report: &ToleranceReport, out: &mut dyn Write) -> io::Result<()> {
    let summary = report.study.summary(report.samples);
    samples(report, &summary, out)?;
    figures(report, &summary, "█", out)?;
    spread(report, out)
}

fn figures(
    report: &ToleranceReport,
    summary: &Summary,
    bar: &str,
    out: &mut dyn Write,
) -> io::Result<()> {
    probabilities(summary, out)?;
    for of in &summary.quantities {
        writeln!(out)?;
        quantity(report, of, bar, out)?;
    }
    Ok(())
}

fn samples(report: &ToleranceReport, summary: &Summary, out: &mut dyn Write) -> io::Result<()> {
    let design = &report.study.design;
    let refused = design.samples - summary.solved;
    let refused = if refused == 0 { String::new() } else { format!(", {refused} refused") };
    let (samples, seed, method) = (design.samples, design.seed, report.method);
    writeln!(out, "{samples} samples{refused}, seed {seed}, method {method}")
}

fn spread(report: &ToleranceReport, out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, "\nSpread")?;
    let width = key_width(report);
    for held in &report.case.spread {
        let field = crate::case::fields::index_of(held.field);
        let value = field.and_then(|field| report.case.effective(field));
        let (value, words) = (sanitize(value.unwrap_or_default()), sanitize(&held.in_words()));
        writeln!(out, "  {:width$}  {value}, {words}", held.field)?;
    }
    if report.case.spread.iter().any(|held| held.field.ends_with(".base_pitch")) {
        let rule = match report.combination() {
            "sum" => "with their signs: known",
            _ => "as squares: independent",
        };
        writeln!(out, "  base pitch deviations add {rule}")?;
    }
    Ok(())
}

fn key_width(report: &ToleranceReport) -> usize {
    let fields = report.study.design.distributions.iter();
    let keys = fields.map(|distribution| FIELDS[distribution.field].key.len());
    keys.max().unwrap_or(0)
}

fn probabilities(summary: &Summary, out: &mut dyn Write) -> io::Result<()> {
    let named =
        |limit: &Exceedance| format!("{} > {}", limit.quantity.key, sanitize(&limit.limit.text));
    let contact = ("corner contact".to_owned(), summary.contact);
    let limits = summary.limits.iter().map(|limit| (named(limit), limit.probability));
    let rows: Vec<(String, Option<Estimate>)> = std::iter::once(contact).chain(limits).collect();
    let width = rows.iter().map(|(name, _)| name.chars().count()).max().unwrap_or(0);
    writeln!(out, "\nProbability (95 % interval)")?;
    for (name, probability) in rows {
        match probability {
            Some(estimate) => writeln!(out, "  {name:width$}  {}", in_percent(&estimate))?,
            None => writeln!(out, "  {name:width$}  unknown: no sample has a value")?,
        }
    }
    Ok(())
}

/// A probability with its interval, down to the first digit in which the ends of the interval
/// differ.
fn in_percent(estimate: &Estimate) -> String {
    let Estimate { value, from, to } = estimate;
    let width = 100.0 * (to - from);
    let decimals = if width > 0.0 { (-width.log10()).ceil().clamp(0.0, 6.0) as usize } else { 0 };
    let percent = |part: f64| format!("{:.decimals$} %", 100.0 * part);
    format!("{} ({} to {})", percent(*value), percent(*from), percent(*to))
}

fn quantity(
    report: &ToleranceReport,
    of: &OfQuantity,
    bar: &str,
    out: &mut dyn Write,
) -> io::Result<()> {
    let OfQuantity { quantity, .. } = of;
    let heading = format!("{} {} ({})", quantity.label, quantity.symbol, quantity.key);
    let Some(figures) = &of.figures else {
        let reason = report.why_absent(quantity);
        let reason = reason.as_deref().unwrap_or("no sample has a value");
        return writeln!(out, "{heading}\n  {reason}");
    };
    writeln!(out, "{heading}, {} values", figures.count)?;
    let ends = [figures.range.0, figures.range.1].into_iter();
    let unit = common_unit(quantity, ends, System::Metric);
    let printed = |value: f64| shown_with(quantity, value, unit).to_string();
    let mut row = |name: &str, figure: &Figure, least: usize| {
        let value = printed(figure.value);
        let ends = figure.interval.map(|(from, to)| [from, to].map(printed));
        let interval = match ends {
            Some([from, to]) => format!("({from} to {to})"),
            None => format!("(no 95 % interval below {least} values)"),
        };
        writeln!(out, "  {name:<20}{value:>12} {interval}")
    };
    for (&percent, figure) in PERCENTILES.iter().zip(&figures.percentiles) {
        row(&format!("P{percent}"), figure, least_count(percent))?;
    }
    row("mean", &figures.mean, 2)?;
    let deviation = printed(figures.deviation);
    writeln!(out, "  {:<20}{deviation:>12}", "standard deviation")?;
    histogram(figures, &printed, bar, out)?;
    ranking(report, of, out)
}

fn histogram(
    figures: &Figures,
    printed: &dyn Fn(f64) -> String,
    bar: &str,
    out: &mut dyn Write,
) -> io::Result<()> {
    let most = figures.histogram.iter().copied().max().unwrap_or(0).max(1);
    let (from, to) = figures.range;
    let step = (to - from) / figures.histogram.len() as f64;
    let lower: Vec<String> =
        (0..figures.histogram.len()).map(|bin| printed(from + step * bin as f64)).collect();
    let width = lower.iter().map(|text| text.chars().count()).max().unwrap_or(0);
    for (count, lower) in figures.histogram.iter().zip(lower) {
        let length = (count * LONGEST_BAR).div_ceil(most);
        let bar = bar.repeat(length);
        let gap = if bar.is_empty() { "" } else { " " };
        writeln!(out, "  {lower:>width$} | {bar}{gap}{count}")?;
    }
    Ok(())
}

fn ranking(report: &ToleranceReport, of: &OfQuantity, out: &mut dyn Write) -> io::Result<()> {
    let design = &report.study.design;
    if design.ranked == 0 {
        return Ok(());
    }
    let Some(indices) = &of.indices else {
        let reason = if of.ranked == 0 {
            "no sample of the ranking has every value"
        } else {
            "the values do not vary"
        };
        return writeln!(out, "  no ranking: {reason}");
    };
    let heading = "part of the variance";
    let width = key_width(report).max(heading.len());
    writeln!(out, "  {heading:width$}  {:>18}{:>18}", "first-order", "total")?;
    let mut rows: Vec<(&str, &Indices)> = design
        .distributions
        .iter()
        .map(|distribution| FIELDS[distribution.field].key)
        .zip(indices)
        .collect();
    rows.sort_by(|(_, one), (_, other)| other.total.value.total_cmp(&one.total.value));
    for (key, Indices { first_order, total }) in rows {
        let [first_order, total] = [first_order, total].map(index);
        writeln!(out, "  {key:width$}  {first_order:>18}{total:>18}")?;
    }
    if of.ranked < design.ranked {
        let (left, all) = (design.ranked - of.ranked, design.ranked);
        writeln!(
            out,
            "  {left} of {all} samples of the ranking lack a value, so it is approximate"
        )?;
    }
    Ok(())
}

fn index(estimate: &Estimate) -> String {
    let half = 0.5 * (estimate.to - estimate.from);
    format!("{:.3} +- {half:.3}", estimate.value)
}

#[derive(Serialize)]
struct Line<'a> {
    case: &'a str,
    title: &'a str,
    version: &'static str,
    method: &'a str,
    samples: usize,
    seed: u64,
    solved: usize,
    refused: Vec<RefusedLine<'a>>,
    spread: Vec<Distribution<'a>>,
    combination: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    corner_contact: Option<Interval>,
    limits: Vec<Compared<'a>>,
    quantities: serde_json::Map<String, serde_json::Value>,
}

#[derive(Serialize)]
struct RefusedLine<'a> {
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
struct QuantityLine {
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

fn write_json(report: &ToleranceReport, out: &mut dyn Write) -> io::Result<()> {
    let study = report.study;
    let summary = study.summary(report.samples);
    let title = Some(report.case.title()).filter(|title| !title.is_empty());
    let quantities = summary.quantities.iter().map(|of| {
        let value = serde_json::to_value(quantity_line(report, of))?;
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
        spread: spread_lines(report),
        combination: report.combination(),
        corner_contact: summary.contact.as_ref().map(Interval::of),
        limits: summary.limits.iter().map(limit).collect(),
        quantities: quantities.collect::<Result<_, serde_json::Error>>()?,
    };
    write_line(&line, out)
}

fn refused<'a>(report: &ToleranceReport<'a>) -> Vec<RefusedLine<'a>> {
    let reasons = report.samples.refusals.0.iter();
    reasons
        .map(|refused| RefusedLine {
            count: refused.count,
            of: report.study.design.count(),
            field: &refused.problem.field,
            cause: &refused.problem.cause,
            fix: &refused.problem.fix,
        })
        .collect()
}

fn spread_lines<'a>(report: &ToleranceReport<'a>) -> Vec<Distribution<'a>> {
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

fn quantity_line(report: &ToleranceReport, of: &OfQuantity) -> QuantityLine {
    let fields = report.study.design.distributions.iter();
    let shares = of.indices.iter().flatten().zip(fields);
    QuantityLine {
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

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_probability_has_the_digits_that_its_interval_leaves() {
        for ([value, from, to], text) in [
            ([1.0, 0.999_62, 1.0], "100.00 % (99.96 % to 100.00 %)"),
            ([0.5, 0.48, 0.52], "50 % (48 % to 52 %)"),
            ([0.25, 0.02, 0.6], "25 % (2 % to 60 %)"),
            ([1.0, 1.0, 1.0], "100 % (100 % to 100 %)"),
        ] {
            assert_eq!(in_percent(&Estimate { value, from, to }), text);
        }
    }
}
