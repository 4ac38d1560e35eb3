//! A tolerance study as a page of text.

use std::io::{self, Write};

use super::ToleranceReport;
use crate::case::fields::FIELDS;
use crate::case::sanitize::sanitize;
use crate::case::units::System;
use crate::report::{common_unit, shown_with};
use crate::study::statistics::{Estimate, Figure, Figures, Indices, PERCENTILES, least_count};
use crate::study::tolerance::{Exceedance, OfQuantity, Summary};

/// Greatest length of a bar of a histogram, in characters.
const LONGEST_BAR: usize = 40;

pub(super) fn write(report: &ToleranceReport, out: &mut dyn Write) -> io::Result<()> {
    let summary = report.study.summary(report.samples);
    let title = Some(report.case.title()).filter(|title| !title.is_empty());
    writeln!(out, "{}", sanitize(title.unwrap_or(report.name)))?;
    samples(report, &summary, out)?;
    spread(report, out)?;
    figures(report, &summary, "#", out)
}

/// Writes the results for a screen that already shows the case: the figures come first, and bars
/// consist of block characters.
pub(super) fn write_for_screen(report: &ToleranceReport, out: &mut dyn Write) -> io::Result<()> {
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
