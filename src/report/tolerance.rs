//! A tolerance study as text, JSON or CSV.

use std::io::{self, Write};

use super::absence::Absence;
use super::json::{Json, object, sorted, write_line};
use super::layout::count;
use super::table::{Cell, Column, Table};
use super::{common_unit, shown_with};
use crate::case::fields::index_of;
use crate::case::sanitize::sanitize;
use crate::case::units::System;
use crate::case::{Case, Problem};
use crate::model::Quantity;
use crate::model::inputs::Method;
use crate::study::batch::Points;
use crate::study::sample::{Distribution, Member};
use crate::study::statistics::{Estimate, Figure, Figures, Indices, PERCENTILES, least_count};
use crate::study::tolerance::{Exceedance, OfQuantity, Samples, Summary, Tolerance};

/// Greatest length of a bar of a histogram, in characters.
const LONGEST_BAR: usize = 40;

/// Rows of CSV that are written together.
const ROWS: usize = 1024;

/// A tolerance study and its results.
#[derive(Clone, Copy)]
pub struct ToleranceReport<'a> {
    /// The name of the case, as the user gave it.
    pub name: &'a str,
    /// The case.
    pub case: &'a Case,
    /// The method of the study.
    pub method: Method,
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
        let summary = self.study.summary(self.samples);
        let title = Some(self.case.title()).filter(|title| !title.is_empty());
        writeln!(out, "{}", sanitize(title.unwrap_or(self.name)))?;
        self.write_samples(&summary, out)?;
        self.write_spread(out)?;
        self.write_figures(&summary, "#", out)
    }

    /// Writes the results for a screen that already shows the case: the figures come first, and bars
    /// consist of block characters.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_for_screen(&self, out: &mut dyn Write) -> io::Result<()> {
        let summary = self.study.summary(self.samples);
        self.write_samples(&summary, out)?;
        self.write_figures(&summary, "█", out)?;
        self.write_spread(out)
    }

    fn write_samples(&self, summary: &Summary, out: &mut dyn Write) -> io::Result<()> {
        let design = &self.study.design;
        let refused = design.samples - summary.solved;
        let refused = if refused == 0 { String::new() } else { format!(", {refused} refused") };
        let (samples, seed, method) = (design.samples, design.seed, self.method.name());
        writeln!(out, "{samples} samples{refused}, seed {seed}, method {method}")
    }

    fn write_spread(&self, out: &mut dyn Write) -> io::Result<()> {
        writeln!(out, "\nSpread")?;
        let width = self.key_width();
        for spread in &self.case.spread {
            let value = index_of(spread.field).and_then(|field| self.case.effective(field));
            let (value, words) =
                (sanitize(value.unwrap_or_default()), sanitize(&spread.in_words()));
            writeln!(out, "  {:width$}  {value}, {words}", spread.field)?;
        }
        if self.case.spread.iter().any(|spread| spread.field.ends_with(".base_pitch")) {
            let rule = match self.combination() {
                "sum" => "with their signs: known",
                _ => "as squares: independent",
            };
            writeln!(out, "  base pitch deviations add {rule}")?;
        }
        Ok(())
    }

    fn key_width(&self) -> usize {
        widest(self.study.design.distributions.iter().map(Distribution::key))
    }

    /// How the base pitch deviations of a sample add, by its name in a case file.
    fn combination(&self) -> &'static str {
        let field = index_of("deviations.combination");
        let is_sum = field.and_then(|field| self.case.effective(field)) == Some("sum");
        let is_sum = is_sum || self.study.design.draws_known_deviations();
        if is_sum { "sum" } else { "independent" }
    }

    fn write_figures(&self, summary: &Summary, bar: &str, out: &mut dyn Write) -> io::Result<()> {
        let limit = |of: &Exceedance| {
            (format!("{} > {}", of.quantity.key, sanitize(&of.limit.text)), of.probability)
        };
        let contact = ("corner contact".to_owned(), summary.contact);
        let limits = summary.limits.iter().map(limit);
        let rows: Vec<_> = std::iter::once(contact).chain(limits).collect();
        let width = widest(rows.iter().map(|(name, _)| name.as_str()));
        writeln!(out, "\nProbability (95 % interval)")?;
        for (name, probability) in rows {
            let unknown = || "unknown: no sample has a value".to_owned();
            let probability = probability.as_ref().map_or_else(unknown, in_percent);
            writeln!(out, "  {name:width$}  {probability}")?;
        }
        summary.quantities.iter().try_for_each(|of| self.write_quantity(of, bar, out))
    }

    fn write_quantity(&self, of: &OfQuantity, bar: &str, out: &mut dyn Write) -> io::Result<()> {
        let OfQuantity { quantity, .. } = of;
        write!(out, "\n{} {} ({})", quantity.label, quantity.symbol, quantity.key)?;
        let Some(figures) = &of.figures else {
            let reason = self.why_absent(quantity);
            return writeln!(out, "\n  {}", reason.as_deref().unwrap_or("no sample has a value"));
        };
        writeln!(out, ", {} values", figures.count)?;
        let unit =
            common_unit(quantity, [figures.range.0, figures.range.1].into_iter(), System::Metric);
        let printed = |value: f64| shown_with(quantity, value, unit).to_string();
        let percentiles = PERCENTILES.iter().zip(&figures.percentiles);
        let percentiles = percentiles
            .map(|(&percent, figure)| (format!("P{percent}"), figure, least_count(percent)));
        let mean = ("mean".to_owned(), &figures.mean, 2);
        for (name, Figure { value, interval }, least) in percentiles.chain([mean]) {
            let interval = match interval {
                Some((from, to)) => format!("{} to {}", printed(*from), printed(*to)),
                None => format!("no 95 % interval below {least} values"),
            };
            writeln!(out, "  {name:<20}{:>12} ({interval})", printed(*value))?;
        }
        writeln!(out, "  {:<20}{:>12}", "standard deviation", printed(figures.deviation))?;
        write_histogram(figures, &printed, bar, out)?;
        self.write_ranking(of, out)
    }

    fn write_ranking(&self, of: &OfQuantity, out: &mut dyn Write) -> io::Result<()> {
        const HEADING: &str = "part of the variance";
        let design = &self.study.design;
        let Some(indices) = &of.indices else {
            return match (design.ranked, of.ranked) {
                (0, _) => Ok(()),
                (_, 0) => writeln!(out, "  no ranking: no sample of the ranking has every value"),
                _ => writeln!(out, "  no ranking: the values do not vary"),
            };
        };
        let width = self.key_width().max(HEADING.len());
        writeln!(out, "  {HEADING:width$}  {:>18}{:>18}", "first-order", "total")?;
        let mut rows: Vec<_> = design.distributions.iter().zip(indices).collect();
        rows.sort_by(|(_, one), (_, other)| other.total.value.total_cmp(&one.total.value));
        for (distribution, Indices { first_order, total }) in rows {
            let [first_order, total] = [first_order, total]
                .map(|index| format!("{:.3} +- {:.3}", index.value, 0.5 * (index.to - index.from)));
            writeln!(out, "  {:width$}  {first_order:>18}{total:>18}", distribution.key())?;
        }
        if of.ranked < design.ranked {
            let (left, all) = (design.ranked - of.ranked, design.ranked);
            let rest = "samples of the ranking lack a value, so it is approximate";
            writeln!(out, "  {left} of {all} {rest}")?;
        }
        Ok(())
    }

    /// Why no sample has a value of a quantity, if another method computes it.
    fn why_absent(&self, quantity: &Quantity) -> Option<String> {
        Absence::by_method(quantity, self.method).map(|absence| absence.to_string())
    }

    /// Writes one row per solve: the samples, then the points of the ranking.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let (design, quantities) = (&self.study.design, &self.study.quantities);
        let number = |(key, unit)| Column::number(key, "", unit, ("1", 0));
        let spread = design.distributions.iter().map(|one| (one.key(), unit(one)));
        let computed = quantities.iter().map(|quantity| (quantity.key, quantity.unit));
        let [sample, set, outcome] = ["sample", "set", "outcome"].map(|key| Column::text(key, ""));
        let columns = [sample, set].into_iter().chain(spread.chain(computed).map(number));
        let table = Table::new("", columns.chain([outcome]).collect());
        table.write_csv_header(out)?;
        let row = |index: usize| {
            let (number, set) = match design.member(index) {
                Member::Sample(number) => (number, "a".to_owned()),
                Member::Second(number) => (number, "b".to_owned()),
                Member::Swapped(number, field) => {
                    (number, format!("b:{}", design.distributions[field].key()))
                }
            };
            let computed = (0..quantities.len()).map(|at| self.samples.value(at, index));
            let values = design.values(index).into_iter().map(Some).chain(computed);
            let values = values.map(|value| Cell::number(value, ""));
            let outcome = self.samples.outcomes[index].name().into();
            [number.to_string().into(), set.into()]
                .into_iter()
                .chain(values)
                .chain([outcome])
                .collect()
        };
        // A study may have more rows than fit into memory as text.
        (0..design.count()).step_by(ROWS).try_for_each(|first| {
            let part = first..(first + ROWS).min(design.count());
            table.clone().with(part.map(row)).write_csv_rows(out)
        })
    }

    /// Writes the results as one JSON object on one line.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_json(&self, out: &mut dyn Write) -> io::Result<()> {
        let design = &self.study.design;
        let summary = self.study.summary(self.samples);
        let refused = self.samples.refusals.0.iter().map(|refused| {
            let Problem { field, cause, fix, .. } = &refused.problem;
            object([
                ("count", refused.count.into()),
                ("of", design.count().into()),
                ("field", field.as_str().into()),
                ("cause", cause.as_str().into()),
                ("fix", fix.to_string().into()),
            ])
        });
        let spread = self.case.spread.iter().zip(&design.distributions);
        let spread = spread.map(|(spread, distribution)| {
            object([
                ("field", spread.field.into()),
                ("shape", spread.shape.name().into()),
                ("width", spread.text.as_str().into()),
                ("centre", distribution.centre.into()),
                ("unit", unit(distribution).into()),
            ])
        });
        let limits = summary.limits.iter().map(|limit| {
            object([
                ("quantity", limit.quantity.key.into()),
                ("limit", limit.limit.text.as_str().into()),
                ("samples", limit.known.into()),
                ("exceeded", limit.probability.as_ref().map(chance).into()),
            ])
        });
        let quantities = summary.quantities.iter().map(|of| (of.quantity.key, self.quantity(of)));
        let line = object([
            ("case", self.name.into()),
            ("title", self.case.title().into()),
            ("version", env!("CARGO_PKG_VERSION").into()),
            ("method", self.method.name().into()),
            ("samples", design.samples.into()),
            ("seed", design.seed.into()),
            ("solved", summary.solved.into()),
            ("refused", refused.collect()),
            ("spread", spread.collect()),
            ("combination", self.combination().into()),
            ("corner_contact", summary.contact.as_ref().map(chance).into()),
            ("limits", limits.collect()),
            ("quantities", sorted(quantities)),
        ]);
        write_line(&line, out)
    }

    fn quantity(&self, of: &OfQuantity) -> Json {
        let shape = |figures: &Figures| {
            let [p5, p50, p95] = figures.percentiles.each_ref().map(figure);
            object([
                ("greatest", figures.range.1.into()),
                ("histogram", figures.histogram.iter().copied().collect()),
                ("least", figures.range.0.into()),
                ("mean", figure(&figures.mean)),
                ("p5", p5),
                ("p50", p50),
                ("p95", p95),
                ("standard_deviation", figures.deviation.into()),
            ])
        };
        let fields = self.study.design.distributions.iter().map(Distribution::key);
        let share = |(field, Indices { first_order, total }): (&str, &Indices)| {
            object([
                ("field", field.into()),
                ("first_order", index(first_order)),
                ("total", index(total)),
            ])
        };
        let ranking = of.indices.as_ref().map(|all| fields.zip(all).map(share).collect::<Json>());
        object([
            ("count", of.figures.as_ref().map_or(0, |figures| figures.count).into()),
            ("figures", of.figures.as_ref().map(shape).into()),
            ("no_value", self.why_absent(of.quantity).into()),
            ("ranked", of.ranked.into()),
            ("ranking", ranking.into()),
            ("unit", of.quantity.unit.into()),
        ])
    }
}

/// The SI unit of a spread field.
fn unit(distribution: &Distribution) -> &'static str {
    Some(distribution.unit()).filter(|unit| !unit.is_empty()).unwrap_or("1")
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

fn write_histogram(
    figures: &Figures,
    printed: &dyn Fn(f64) -> String,
    bar: &str,
    out: &mut dyn Write,
) -> io::Result<()> {
    let counts = &figures.histogram;
    let most = counts.iter().copied().max().unwrap_or(0).max(1);
    let (from, to) = figures.range;
    let step = (to - from) / counts.len() as f64;
    let lower = (0..counts.len()).map(|bin| printed(from + step * bin as f64));
    let lower: Vec<String> = lower.collect();
    let width = widest(lower.iter().map(String::as_str));
    for (count, lower) in counts.iter().zip(lower) {
        let bar = bar.repeat((count * LONGEST_BAR).div_ceil(most));
        let gap = if bar.is_empty() { "" } else { " " };
        writeln!(out, "  {lower:>width$} | {bar}{gap}{count}")?;
    }
    Ok(())
}

/// The greatest length of the texts, in characters.
fn widest<'a>(texts: impl Iterator<Item = &'a str>) -> usize {
    texts.map(count).max().unwrap_or(0)
}

/// A probability.
fn chance(Estimate { value, from, to }: &Estimate) -> Json {
    object([("value", (*value).into()), ("from", (*from).into()), ("to", (*to).into())])
}

fn figure(Figure { value, interval }: &Figure) -> Json {
    let (from, to) = interval.unzip();
    object([("from", from.into()), ("to", to.into()), ("value", (*value).into())])
}

fn index(Estimate { value, from, to }: &Estimate) -> Json {
    figure(&Figure { value: *value, interval: Some((*from, *to)) })
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
