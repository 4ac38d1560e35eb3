//! A tolerance study as text, JSON or CSV.

use super::table::{Json, json, sorted};
use super::table::{Named, Results};
use super::table::{count, item};
use super::verdict::Absence;
use super::{common_unit, name_of, shown_with};
use crate::case::fields::{FIELDS, index_of};
use crate::case::sanitize::sanitize;
use crate::case::units::{self, System};
use crate::case::{Acting, Case, Problem, Spread, relevance};
use crate::model::Quantity;
use crate::model::inputs::Method;
use crate::study::batch::Points;
use crate::study::statistics::{Estimate, Figure, Indices, PERCENTILES, least_count};
use crate::study::tolerance::{Design, Distribution, centre};
use crate::study::tolerance::{Exceedance, OfQuantity, Samples, Summary, Tolerance};

/// Greatest length of a bar of a histogram, in characters; on a screen, in a narrow pane.
const LONGEST_BAR: usize = 40;
const SHORT_BAR: usize = 30;

/// A tolerance study and its results.
#[derive(Clone, Copy)]
pub struct ToleranceReport<'a> {
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
    /// The results for a screen that already shows the case: the figures come first, and bars
    /// consist of block characters.
    pub fn lines_for_screen(&self, units: System) -> Vec<String> {
        let [samples, spread, figures] = self.sections(("█", SHORT_BAR), units);
        [samples, figures, spread].concat()
    }

    /// The lines about the samples, the distributions and the results.
    fn sections(&self, bar: (&str, usize), units: System) -> [Vec<String>; 3] {
        let summary = self.study.summary(self.samples);
        let first = format!("{}, method {}", samples(self.study, &summary), self.method.name());
        let rows = probabilities(&summary);
        let width = widest(rows.iter().map(|(name, _)| name.as_str()));
        let mut figures = vec![String::new(), "Probability (95 % interval)".to_owned()];
        figures.extend(rows.iter().map(|(name, text)| format!("  {name:width$}  {text}")));
        let quantities = summary.quantities.iter();
        figures.extend(quantities.flat_map(|of| self.quantity_lines(of, bar, units)));
        [vec![first], self.spread(), figures]
    }

    fn spread(&self) -> Vec<String> {
        let width = self.key_width();
        let mut lines = vec![String::new(), "Spread".to_owned()];
        let spread = distributions(self.case).into_iter();
        lines.extend(spread.flat_map(|(field, text)| item(&format!("  {field:width$}  "), &text)));
        if self.case.spread.iter().any(|spread| spread.field.ends_with(".base_pitch")) {
            let is_sum = self.combination() == "sum";
            let rule = if is_sum {
                "f_pb1 + f_pb2, each with its sign"
            } else {
                "sqrt(f_pb1^2 + f_pb2^2), independent"
            };
            lines.push(format!("  Base pitch deviation of a sample: {rule}"));
        }
        lines
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

    fn quantity_lines(
        &self,
        of: &OfQuantity,
        (bar, longest): (&str, usize),
        units: System,
    ) -> Vec<String> {
        let OfQuantity { quantity, figures, .. } = of;
        let title = format!("{} ({})", name_of(quantity), quantity.key);
        let Some(figures) = figures else {
            let reason = self.why_absent(quantity);
            let reason = reason.as_deref().unwrap_or("no sample has a value");
            return vec![String::new(), title, format!("  {reason}")];
        };
        let (from, to) = figures.range;
        let unit = common_unit(quantity, [from, to].into_iter(), units);
        let printed = |value: f64| shown_with(quantity, value, unit).to_string();
        if figures.is_constant() {
            let value = printed(figures.mean.value);
            return vec![String::new(), format!("{title}: constant, {value}")];
        }
        let line = |name: &str, Figure { value, interval }: &Figure, least: usize| {
            let interval = match interval {
                Some((from, to)) => format!("{} to {}", printed(*from), printed(*to)),
                None => format!("no 95 % interval below {least} values"),
            };
            format!("  {name:<20}{:>12} ({interval})", printed(*value))
        };
        let mut lines = vec![String::new(), format!("{title}, {} values", figures.count)];
        let percentiles = PERCENTILES.iter().zip(&figures.percentiles);
        lines.extend(
            percentiles.map(|(&percent, figure)| {
                line(&format!("P{percent}"), figure, least_count(percent))
            }),
        );
        lines.push(line("mean", &figures.mean, 2));
        lines.push(format!("  {:<20}{:>12}", "standard deviation", printed(figures.deviation)));
        let counts = &figures.histogram;
        let most = counts.iter().copied().max().unwrap_or(0).max(1);
        let step = (to - from) / counts.len() as f64;
        let lower: Vec<String> =
            (0..counts.len()).map(|bin| printed(from + step * bin as f64)).collect();
        let width = widest(lower.iter().map(String::as_str));
        lines.extend(counts.iter().zip(lower).map(|(count, lower)| {
            let bar = bar.repeat((count * longest).div_ceil(most));
            let gap = if bar.is_empty() { "" } else { " " };
            format!("  {lower:>width$} | {bar}{gap}{count}")
        }));
        lines.extend(self.ranking(of));
        lines
    }

    fn ranking(&self, of: &OfQuantity) -> Vec<String> {
        const HEADING: &str = "part of the variance";
        let (ranked, all) = (of.ranked, self.study.design.ranked);
        let Some(indices) = &of.indices else {
            let reason = match (all, ranked) {
                (0, _) => return Vec::new(),
                (_, 0) => "no sample of the ranking has every value",
                _ => "the values do not vary",
            };
            return vec![format!("  no ranking: {reason}")];
        };
        let width = self.key_width().max(HEADING.len());
        let mut rows: Vec<_> = self.study.design.distributions.iter().zip(indices).collect();
        rows.sort_by(|(_, one), (_, other)| other.total.value.total_cmp(&one.total.value));
        let mut lines = vec![format!("  {HEADING:width$}  {:>18}{:>18}", "first-order", "total")];
        lines.extend(rows.into_iter().map(|(distribution, Indices { first_order, total })| {
            let [first_order, total] = [first_order, total]
                .map(|index| format!("{:.3} +- {:.3}", index.value, 0.5 * (index.to - index.from)));
            format!("  {:width$}  {first_order:>18}{total:>18}", distribution.key())
        }));
        if ranked < all {
            let left = all - ranked;
            lines.push(format!(
                "  {left} of {all} samples of the ranking lack a value, so it is approximate"
            ));
        }
        lines
    }

    /// Why no sample has a value of a quantity, if another method computes it.
    fn why_absent(&self, quantity: &Quantity) -> Option<String> {
        Absence::by_method(quantity, self.method).map(|absence| absence.to_string())
    }

    fn quantity(&self, of: &OfQuantity) -> Json {
        let figures = of.figures.as_ref().map(|figures| {
            let [p5, p50, p95] = figures.percentiles.map(figure);
            json!({
                "greatest": figures.range.1,
                "histogram": figures.histogram,
                "least": figures.range.0,
                "mean": figure(figures.mean),
                "p5": p5,
                "p50": p50,
                "p95": p95,
                "standard_deviation": figures.deviation,
            })
        });
        let index =
            |Estimate { value, from, to }| figure(Figure { value, interval: Some((from, to)) });
        let share = |(field, Indices { first_order, total }): (&Distribution, &Indices)| json!({"field": field.key(), "first_order": index(*first_order), "total": index(*total)});
        let fields = &self.study.design.distributions;
        let ranking =
            of.indices.as_ref().map(|all| fields.iter().zip(all).map(share).collect::<Json>());
        json!({
            "count": of.figures.as_ref().map_or(0, |figures| figures.count),
            "figures": figures,
            "no_value": self.why_absent(of.quantity),
            "ranked": of.ranked,
            "ranking": ranking,
            "unit": of.quantity.unit,
        })
    }
}

impl Results for ToleranceReport<'_> {
    fn lines(&self, case: Named) -> Vec<String> {
        let [samples, spread, figures] = self.sections(("#", LONGEST_BAR), System::Metric);
        [vec![case.heading()], samples, spread, figures].concat()
    }

    fn json(&self) -> Json {
        let design = &self.study.design;
        let summary = self.study.summary(self.samples);
        let refused = self.samples.refusals.0.iter().map(|refused| {
            let Problem { field, cause, fix, .. } = &refused.problem;
            let (count, of) = (refused.count, design.count());
            json!({"count": count, "of": of, "field": field, "cause": cause, "fix": fix})
        });
        let spread = self.case.spread.iter().zip(&design.distributions);
        let spread = spread.map(|(spread, distribution)| {
            json!({
                "field": spread.field,
                "shape": spread.shape.name(),
                "width": spread.written_width(),
                "centre": distribution.centre,
                "unit": distribution.unit_or_one(),
            })
        });
        let limits = summary.limits.iter().map(|limit| {
            json!({
                "quantity": limit.limit.quantity.key,
                "limit": limit.limit.text,
                "samples": limit.known,
                "exceeded": limit.probability,
            })
        });
        let quantities = summary.quantities.iter().map(|of| (of.quantity.key, self.quantity(of)));
        json!({
            "method": self.method.name(),
            "samples": design.samples,
            "seed": design.seed,
            "solved": summary.solved,
            "refused": refused.collect::<Json>(),
            "spread": spread.collect::<Json>(),
            "combination": self.combination(),
            "corner_contact": summary.contact,
            "exit_corner_contact": summary.exit,
            "limits": limits.collect::<Json>(),
            "quantities": sorted(quantities),
        })
    }
}

/// Number and seed of the samples.
pub(super) fn samples(study: &Tolerance, summary: &Summary) -> String {
    let Design { samples, seed, .. } = study.design;
    match samples - summary.solved {
        0 => format!("{samples} samples, seed {seed}"),
        refused => format!("{samples} samples, {refused} refused, seed {seed}"),
    }
}

/// The spread fields of a case with their values and distributions.
pub(super) fn distributions(case: &Case) -> Vec<(&'static str, String)> {
    let (inputs, _) = case.read();
    let of = |spread: &Spread| {
        let field = index_of(spread.field).unwrap_or_default();
        let shown = |value: f64| {
            let (number, unit) = units::shown(value, FIELDS[field].usual_unit(), 5, System::Metric);
            format!("{number} {unit}")
        };
        // The case leaves the field out, and its value follows from others.
        let derived = case.derived(field, &inputs).zip(centre(field, case, &inputs));
        let value = match derived {
            None => sanitize(case.effective(field).unwrap_or_default()),
            Some((own, drawn)) if own.total_cmp(&drawn).is_eq() => shown(drawn),
            Some((own, drawn)) => {
                format!("{} (without samples {}, by the grade)", shown(drawn), shown(own))
            }
        };
        let idle = match relevance(field, &inputs) {
            Acting::No(why) | Acting::Beside(why) => format!("; changes nothing: {why}"),
            Acting::Yes => String::new(),
        };
        let drawn = Distribution::of(spread, case, &inputs);
        let cut = if drawn.is_ok_and(|drawn| drawn.is_cut()) {
            "; samples below 0 count as 0"
        } else {
            ""
        };
        (spread.field, format!("{value}, {}{cut}{idle}", sanitize(&spread.text)))
    };
    case.spread.iter().map(of).collect()
}

/// The probabilities of corner contact and of a value above each limit, with their intervals.
pub(super) fn probabilities(summary: &Summary) -> Vec<(String, String)> {
    let limits = summary.limits.iter().map(|Exceedance { limit, probability, .. }| {
        (format!("{} > {}", name_of(limit.quantity), limit.shown()), probability.as_ref())
    });
    let exit =
        summary.exit.as_ref().map(|exit| ("corner contact at the exit".to_owned(), Some(exit)));
    let contact = [("corner contact".to_owned(), summary.contact.as_ref())];
    let all = contact.into_iter().chain(exit).chain(limits);
    let unknown = || "unknown: no sample has a value".to_owned();
    all.map(|(name, found)| (name, found.map_or_else(unknown, in_percent))).collect()
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

/// The greatest length of the texts, in characters.
fn widest<'a>(texts: impl Iterator<Item = &'a str>) -> usize {
    texts.map(count).max().unwrap_or(0)
}

fn figure(Figure { value, interval }: Figure) -> Json {
    let (from, to) = interval.unzip();
    json!({"from": from, "to": to, "value": value})
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
