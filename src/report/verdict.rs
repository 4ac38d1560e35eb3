//! The limits of a case compared with its results.

use std::fmt;
use std::io::{self, Write};

use super::absence::Absence;
use super::json::{json, write_line};
use super::{shown_in, value};
use crate::case::sanitize::sanitize;
use crate::case::units::System;
use crate::case::{Case, Limit};
use crate::model::inputs::Method;
use crate::model::{Quantity, Refusal, Solution, Stage, Stages};

/// The comparison of a quantity with its limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// At most the limit.
    Within,
    /// Above the limit.
    Exceeded,
    /// No corner contact, so that nothing can exceed the limit.
    NotApplicable,
    /// The quantity is absent, although corner contact is possible: the limit is not met.
    Unknown,
}

impl Standing {
    /// Whether the limit is met.
    #[must_use]
    pub fn holds(self) -> bool {
        matches!(self, Standing::Within | Standing::NotApplicable)
    }

    /// The name for scripts.
    #[must_use]
    pub fn name(self) -> &'static str {
        ["within", "exceeded", "not-applicable", "unknown"][self as usize]
    }

    /// The word in front of a verdict.
    #[must_use]
    pub fn word(self) -> &'static str {
        ["ok", "EXCEEDED", "ok", "unknown"][self as usize]
    }
}

/// A limit of a case with its result.
#[derive(Debug, Clone)]
pub struct Verdict<'a> {
    /// The limit.
    pub limit: &'a Limit,
    /// The limited quantity.
    pub quantity: &'static Quantity,
    /// The value of the quantity in SI.
    pub value: Option<f64>,
    /// The greatest allowed value in SI.
    pub bound: Option<f64>,
    /// The comparison.
    pub standing: Standing,
    /// Why the value is absent.
    pub absence: Option<Absence>,
    /// The counterpart in the method, if the limited quantity belongs to the free impact.
    pub beside: Option<Beside>,
}

/// The counterpart of a quantity of the free impact in a method that resolves the impact.
#[derive(Debug, Clone, Copy)]
pub struct Beside {
    /// The method.
    pub method: Method,
    /// The quantity of the method and its value in SI, if it has them.
    pub own: Option<(&'static Quantity, Option<f64>)>,
    /// Whether the case also limits that quantity.
    pub is_limited: bool,
}

impl Beside {
    /// The counterpart of that quantity in a solution.
    #[must_use]
    pub fn of(quantity: &'static Quantity, solution: &Solution) -> Option<Beside> {
        let method = solution.method;
        if !method.shares_load() || !quantity.is_of_free_impact() {
            return None;
        }
        let own = quantity.by(method).map(|own| (own, value(own, solution)));
        Some(Beside { method, own, is_limited: false })
    }

    /// The counterpart as a sentence, with the value in metric or inch units.
    #[must_use]
    pub fn sentence(&self, system: System) -> String {
        let method = self.method.name();
        match self.own {
            Some((own, Some(value))) => {
                let value = shown_in(own, value, system);
                format!("the free impact. Method {method}: {} {value}", own.key)
            }
            Some((own, None)) => format!("the free impact; {method} has {} instead", own.key),
            None => format!("the free impact; {method} has no such quantity"),
        }
    }
}

/// The verdict on every limit, in the order of the case.
#[must_use]
pub fn verdicts<'a>(case: &'a Case, solution: &Solution) -> Vec<Verdict<'a>> {
    let limits = case.limits.iter();
    let mut verdicts: Vec<_> = limits.filter_map(|limit| verdict(limit, solution)).collect();
    for beside in verdicts.iter_mut().filter_map(|verdict| verdict.beside.as_mut()) {
        beside.is_limited =
            beside.own.is_some_and(|(own, _)| limited(case).any(|other| other.key == own.key));
    }
    verdicts
}

/// The verdict on one limit; a case limits only known quantities.
#[must_use]
pub fn verdict<'a>(limit: &'a Limit, solution: &Solution) -> Option<Verdict<'a>> {
    let quantity = Quantity::find(limit.quantity)?;
    let found = value(quantity, solution);
    let bound = limit.bound(|of| value(of, solution));
    // The result to which the limit is relative may be absent.
    let lacking = match (found, bound) {
        (None, _) => Some(quantity),
        (_, None) => limit.of.and_then(Quantity::find),
        _ => None,
    };
    let absence = lacking.map(|lacking| Absence::of(lacking, solution));
    let standing = match (found, bound, absence) {
        (Some(value), Some(bound), _) if value <= bound => Standing::Within,
        (Some(_), Some(_), _) => Standing::Exceeded,
        (None, _, Some(Absence::NoContact(..) | Absence::NoExit)) => Standing::NotApplicable,
        _ => Standing::Unknown,
    };
    let value = found.filter(|_| bound.is_some());
    // Without corner contact there is no counterpart to compare.
    let beside = value.and_then(|_| Beside::of(quantity, solution));
    Some(Verdict { limit, quantity, value, bound, standing, absence, beside })
}

/// The stages for every limit of a case.
#[must_use]
pub fn stages(case: &Case) -> Stages {
    let quantities = case.limits.iter().flat_map(Limit::quantities);
    let stages = Stages::of(Stage::Geometry);
    quantities.fold(stages, |stages, own| stages.and(Stages::of(own.stage)))
}

fn limited(case: &Case) -> impl Iterator<Item = &'static Quantity> {
    case.limits.iter().filter_map(|limit| Quantity::find(limit.quantity))
}

/// Every limit of a case that the model refuses: no quantity has a value.
#[must_use]
pub fn refused<'a>(case: &'a Case, refusal: &Refusal) -> Vec<Verdict<'a>> {
    let absence = Some(Absence::Withheld(*refusal));
    let verdict = |limit: &'a Limit| {
        let (quantity, standing) = (Quantity::find(limit.quantity)?, Standing::Unknown);
        let (value, bound) = (None, limit.bound(|_| None));
        Some(Verdict { limit, quantity, value, bound, standing, absence, beside: None })
    };
    case.limits.iter().filter_map(verdict).collect()
}

impl Verdict<'_> {
    /// The value as a fraction of the limit, if both are in range.
    #[must_use]
    pub fn part(&self) -> Option<f64> {
        let (value, limit) = (self.value?, self.bound?);
        (limit > 0.0 && limit.is_finite() && value >= 0.0).then(|| value / limit)
    }

    /// The verdict as a sentence, with the value in metric or inch units, and the limit as the user
    /// wrote it.
    #[must_use]
    pub fn sentence(&self, system: System) -> String {
        let statement = self.statement(system);
        let Some(beside) = self.beside else { return statement };
        let limit = sanitize(&self.limit.text);
        let above = if self.is_exceeded_beside() { format!(" > {limit}") } else { String::new() };
        let is_unlimited = beside.own.is_some() && !beside.is_limited;
        let also = if is_unlimited { "; this quantity has no limit" } else { "" };
        format!("{statement} for {}{above}{also}", beside.sentence(system))
    }

    /// Whether the counterpart in the method exceeds the limit on the free impact.
    #[must_use]
    pub fn is_exceeded_beside(&self) -> bool {
        let own = self.beside.and_then(|beside| beside.own?.1);
        own.zip(self.bound).is_some_and(|(own, bound)| own > bound)
    }

    fn statement(&self, system: System) -> String {
        let (key, mut limit) = (self.quantity.key, sanitize(&self.limit.text));
        if let Some(bound) = self.bound.filter(|_| self.limit.of.is_some()) {
            limit = format!("{limit} = {}", shown_in(self.quantity, bound, system));
        }
        match (self.value, self.absence) {
            (Some(value), _) => {
                let value = shown_in(self.quantity, value, system);
                let sign = if self.standing == Standing::Exceeded { ">" } else { "<=" };
                let part = self.part().map(|part| format!(" ({:.0} %)", 100.0 * part));
                format!("{key} {value} {sign} {limit}{}", part.unwrap_or_default())
            }
            (None, Some(Absence::Withheld(refusal))) => {
                format!("{key} cannot be computed: {refusal} (limit {limit})")
            }
            (None, Some(absence)) if self.bound.is_none() => {
                format!("{key} cannot be compared with {limit}: {absence}")
            }
            (None, Some(absence)) if self.standing == Standing::Unknown => {
                format!("{key} has no value (limit {limit}): {absence}")
            }
            (_, Some(Absence::NoExit)) => {
                format!("{key} does not occur: {} (limit {limit})", Absence::NoExit)
            }
            _ => format!("{key} does not occur: no corner contact (limit {limit})"),
        }
    }
}

impl fmt::Display for Verdict<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence(System::Metric))
    }
}

/// Writes the verdicts on a case, one line each; one line for a case without limits. `outcome` is
/// the verdict on the contact.
///
/// # Errors
/// Errors of the writer.
pub fn write_json(
    verdicts: &[Verdict],
    case: &str,
    (method, outcome): (Method, Option<&str>),
    out: &mut dyn Write,
) -> io::Result<()> {
    let method = method.name();
    if verdicts.is_empty() {
        let standing = Standing::Within.name();
        let line = json!({
            "case": case, "method": method, "verdict": outcome, "standing": standing,
            "message": "no limits",
        });
        return write_line(&line, out);
    }
    verdicts.iter().try_for_each(|verdict| {
        let Verdict { limit, quantity, value, bound, standing, beside, .. } = verdict;
        // The counterpart in the method, if the method resolves the impact itself.
        let own = beside.and_then(|beside| beside.own);
        let own =
            own.map(|(own, value)| json!({"quantity": own.key, "value": value, "unit": own.unit}));
        let line = json!({
            "case": case,
            "method": method,
            "verdict": outcome,
            "standing": standing.name(),
            "quantity": quantity.key,
            "value": value,
            "limit": bound,
            "limit_of": limit.of,
            "unit": quantity.unit,
            "of": beside.map(|_| "free-impact"),
            "own": own,
            "message": verdict.to_string(),
        });
        write_line(&line, out)
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Inputs;

    fn sentences(limits: &[(&str, &str)], system: System) -> Vec<String> {
        let mut case = Case::table_1();
        for (quantity, text) in limits {
            case.set_limit(quantity, text).unwrap();
        }
        let solution = crate::model::solve(&case.inputs().unwrap(), Stages::ALL).unwrap();
        verdicts(&case, &solution)
            .iter()
            .map(|verdict| format!("{} {}", verdict.standing.word(), verdict.sentence(system)))
            .collect()
    }

    #[test]
    fn a_limit_on_the_free_impact_is_followed_by_the_counterpart_in_the_method() {
        let verdicts = |method, limit| {
            let mut case = Case::table_1();
            case.set("model.method", method).unwrap();
            case.set_limit("impact_force", limit).unwrap();
            let solution = crate::model::solve(&case.inputs().unwrap(), Stages::EVERY).unwrap();
            verdicts(&case, &solution)
                .iter()
                .map(|verdict| (verdict.standing, verdict.to_string()))
                .collect::<Vec<_>>()
        };
        assert_eq!(
            verdicts("exact", "2500 N"),
            [(Standing::Within, "impact_force 2191.0 N <= 2500 N (88 %)".to_owned())]
        );
        let [(standing, sentence)] = &verdicts("dynamic", "2100 N")[..] else {
            panic!("one limit")
        };
        assert_eq!(*standing, Standing::Within);
        assert!(
            sentence.ends_with(
                " for the free impact. Method dynamic: dynamic_peak_approach_force 1410.8 N; this \
                    quantity has no limit"
            ),
            "{sentence}"
        );
        let [(standing, sentence)] = &verdicts("static", "1 kN")[..] else { panic!("one limit") };
        assert_eq!(*standing, Standing::Exceeded);
        assert!(
            sentence.ends_with(
                " for the free impact. Method static: static_force_at_start 1466.2 N > 1 kN; this \
                    quantity has no limit"
            ),
            "{sentence}"
        );
    }

    #[test]
    fn a_limit_without_a_value_gives_the_reason_and_passes_only_without_contact() {
        let stands = |method, relief, key, limit| {
            let mut case = Case::table_1();
            case.set("model.method", method).unwrap();
            case.set("driven.tip_relief", relief).unwrap();
            case.set("limits.impact_force", "").unwrap();
            case.set_limit(key, limit).unwrap();
            let solution = crate::model::solve(&case.inputs().unwrap(), Stages::EVERY).unwrap();
            let verdict = verdicts(&case, &solution).remove(0);
            (verdict.standing, verdict.to_string())
        };
        let (standing, sentence) = stands("exact", "0 um", "dynamic_peak_force", "2 kN");
        assert_eq!(standing, Standing::Unknown);
        assert_eq!(
            sentence,
            "dynamic_peak_force has no value (limit 2 kN): method exact does not compute this \
                quantity; dynamic and auto do"
        );
        // The closed form has no result for the motion.
        assert_eq!(stands("exact", "80 um", "dynamic_peak_force", "2 kN").0, Standing::Unknown);
        assert_eq!(stands("exact", "80 um", "impact_force", "2 kN").0, Standing::NotApplicable);
        let (standing, sentence) = stands("static", "80 um", "pitch_contact_jump", "2 kN");
        assert_eq!(standing, Standing::Unknown);
        assert!(sentence.ends_with("the case has no operation.friction_coefficient"), "{sentence}");
        for key in ["steady_back_force", "dynamic_back_strikes"] {
            let limit = if key.ends_with("force") { "1 N" } else { "1" };
            let (_, sentence) = stands("dynamic", "0 um", key, limit);
            assert!(sentence.contains("the case has no deviations.backlash"), "{sentence}");
        }
        assert_eq!(
            stands("static", "80 um", "static_first_contact_angle", "1 deg").0,
            Standing::NotApplicable
        );
    }

    #[test]
    fn a_counterpart_with_a_limit_of_its_own_needs_no_hint() {
        let mut case = Case::table_1();
        case.set("model.method", "static").unwrap();
        case.set_limit("static_force_at_start", "1 kN").unwrap();
        let solution = crate::model::solve(&case.inputs().unwrap(), Stages::EVERY).unwrap();
        let sentence = verdicts(&case, &solution)[0].to_string();
        assert!(sentence.ends_with("Method static: static_force_at_start 1466.2 N"), "{sentence}");
    }

    #[test]
    fn a_verdict_prints_the_limit_as_written_in_both_systems() {
        let limits = [("impact_force", "500 lbf"), ("contact_ratio", "1.5")];
        assert_eq!(
            sentences(&limits, System::Metric),
            [
                "ok impact_force 2191.0 N <= 500 lbf (99 %)",
                "EXCEEDED contact_ratio 1.5568 > 1.5 (104 %)"
            ]
        );
        assert_eq!(
            sentences(&limits, System::Inch)[0],
            "ok impact_force 492.56 lbf <= 500 lbf (99 %)"
        );
    }

    #[test]
    fn a_limit_relative_to_another_result_follows_it() {
        let limits =
            [("static_peak_force", "1.3 x mesh_force"), ("static_force_at_start", "0.5 x nominal")];
        let mut case = Case::table_1();
        case.set("model.method", "static").unwrap();
        case.set("limits.impact_force", "").unwrap();
        for (quantity, text) in limits {
            case.set_limit(quantity, text).unwrap();
        }
        let solution = crate::model::solve(&case.inputs().unwrap(), stages(&case)).unwrap();
        let found = verdicts(&case, &solution);
        let standings = found.iter().map(|verdict| verdict.standing);
        assert_eq!(standings.collect::<Vec<_>>(), [Standing::Within, Standing::Exceeded]);
        assert!(
            found[0].to_string().contains("<= 1.3 x mesh_force = 1981.6 N (77 %)"),
            "{}",
            found[0]
        );
        let other = Inputs { method: Method::Exact, ..case.inputs().unwrap() };
        let solution = crate::model::solve(&other, stages(&case)).unwrap();
        assert_eq!(verdicts(&case, &solution)[0].standing, Standing::Unknown);
        let wrong = |text: &str| case.clone().set_limit("static_peak_force", text).unwrap_err();
        assert!(wrong("1.3 x mesh_forc").to_string().contains("mesh_force"));
        assert!(wrong("1.3 x contact_ratio").to_string().contains("another unit"));
    }

    #[test]
    fn a_refused_case_gives_the_reason_for_every_limit() {
        let case = Case::table_1();
        let verdicts = refused(
            &case,
            &Refusal::ContactRatioBelowOne { ratio: 0.9, is_deflection_taken: true, cut: None },
        );
        assert!(!verdicts[0].standing.holds());
        assert!(
            verdicts[0]
                .to_string()
                .starts_with("impact_force cannot be computed: the contact ratio is 0.9000")
        );
    }
}
