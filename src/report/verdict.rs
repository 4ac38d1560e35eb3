//! The limits of a case compared with its results.

mod json;
#[cfg(test)]
mod tests;

use super::absence::Absence;
use super::{shown_in, value};
use crate::case::sanitize::sanitize;
use crate::case::units::System;
use crate::case::{Case, Limit};
use crate::model::inputs::Method;
use crate::model::{Quantity, Refusal, Solution, Stage, Stages};
pub use json::write as write_json;

use std::fmt;

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
        match self {
            Standing::Within => "within",
            Standing::Exceeded => "exceeded",
            Standing::NotApplicable => "not-applicable",
            Standing::Unknown => "unknown",
        }
    }

    /// The word in front of a verdict.
    #[must_use]
    pub fn word(self) -> &'static str {
        match self {
            Standing::Within | Standing::NotApplicable => "ok",
            Standing::Exceeded => "EXCEEDED",
            Standing::Unknown => "unknown",
        }
    }
}

/// A limit of a case with its result.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict<'a> {
    /// The limit.
    pub limit: &'a Limit,
    /// The value of the quantity in SI.
    pub value: Option<f64>,
    /// The comparison.
    pub standing: Standing,
    /// Why the value is absent.
    pub absence: Option<Absence>,
    /// The counterpart in the method, if the limited quantity belongs to the free impact.
    pub beside: Option<Beside>,
}

/// The counterpart of a quantity of the free impact in a method that resolves the impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beside {
    /// The method.
    pub method: Method,
    /// The quantity of the method and its value in SI, if it has them.
    pub own: Option<(&'static str, Option<f64>)>,
    /// Whether the case also limits that quantity.
    pub is_limited: bool,
}

impl Beside {
    /// The counterpart of that quantity in a solution.
    #[must_use]
    pub fn of(quantity: &'static Quantity, solution: &Solution) -> Option<Beside> {
        let method = solution.method;
        let own = || quantity.by(method).map(|own| (own.key, value(own, solution)));
        (method.shares_load() && quantity.is_of_free_impact()).then(|| Beside {
            method,
            own: own(),
            is_limited: false,
        })
    }

    /// The counterpart as a sentence, with the value in metric or inch units.
    #[must_use]
    pub fn sentence(&self, system: System) -> String {
        let own = self.own.and_then(|(key, value)| Some((Quantity::find(key)?, value)));
        let method = self.method.name();
        match own {
            Some((own, Some(value))) => {
                let value = shown_in(own, value, system);
                format!("the free impact. Method {method}: {} {value}", own.key)
            }
            Some((own, None)) => {
                format!("the free impact; {method} has {} instead", own.key)
            }
            None => format!("the free impact; {method} has no such quantity"),
        }
    }
}

/// The verdict on every limit, in the order of the case.
#[must_use]
pub fn verdicts<'a>(case: &'a Case, solution: &Solution) -> Vec<Verdict<'a>> {
    let is_limited = |beside: &Beside| {
        case.limits.iter().any(|limit| beside.own.is_some_and(|(own, _)| own == limit.quantity))
    };
    let of_case = |verdict: Verdict<'a>| Verdict {
        beside: verdict.beside.map(|beside| Beside { is_limited: is_limited(&beside), ..beside }),
        ..verdict
    };
    case.limits.iter().map(|limit| of_case(verdict(limit, solution))).collect()
}

/// The stages for every limit of a case.
#[must_use]
pub fn stages(case: &Case) -> Stages {
    of_all(limited(case))
}

/// The stages of the counterparts of the limited quantities in a method.
#[must_use]
pub fn stages_beside(case: &Case, method: Method) -> Stages {
    of_all(
        limited(case)
            .filter(|quantity| quantity.is_of_free_impact())
            .filter_map(|quantity| quantity.by(method)),
    )
}

fn limited(case: &Case) -> impl Iterator<Item = &'static Quantity> {
    case.limits.iter().filter_map(|limit| Quantity::find(limit.quantity))
}

fn of_all(quantities: impl Iterator<Item = &'static Quantity>) -> Stages {
    quantities.fold(Stages::of(Stage::Geometry), |stages, quantity| {
        stages.and(Stages::of(quantity.stage))
    })
}

/// The verdict on one limit.
#[must_use]
pub fn verdict<'a>(limit: &'a Limit, solution: &Solution) -> Verdict<'a> {
    let quantity = Quantity::find(limit.quantity);
    let value = quantity.and_then(|quantity| value(quantity, solution));
    let absence =
        quantity.filter(|_| value.is_none()).map(|quantity| Absence::of(quantity, solution));
    let standing = match (value, absence) {
        (Some(value), _) if value <= limit.value => Standing::Within,
        (Some(_), _) => Standing::Exceeded,
        (None, Some(absence)) if absence.is_for_want_of_contact() => Standing::NotApplicable,
        (None, _) => Standing::Unknown,
    };
    // Without corner contact there is no counterpart to compare.
    let beside =
        quantity.filter(|_| value.is_some()).and_then(|quantity| Beside::of(quantity, solution));
    Verdict { limit, value, standing, absence, beside }
}

/// Every limit of a case that the model refuses: no quantity has a value.
#[must_use]
pub fn refused<'a>(case: &'a Case, refusal: &Refusal) -> Vec<Verdict<'a>> {
    let absence = Some(Absence::Withheld(*refusal));
    let verdict =
        |limit| Verdict { limit, value: None, standing: Standing::Unknown, absence, beside: None };
    case.limits.iter().map(verdict).collect()
}

impl Verdict<'_> {
    /// The value as a fraction of the limit, if both are in range.
    #[must_use]
    pub fn part(&self) -> Option<f64> {
        let value = self.value.filter(|&value| {
            self.limit.value > 0.0 && self.limit.value.is_finite() && value >= 0.0
        })?;
        Some(value / self.limit.value)
    }

    /// The verdict as a sentence, with the value in metric or inch units, and the limit as the user
    /// wrote it.
    #[must_use]
    pub fn sentence(&self, system: System) -> String {
        let statement = self.statement(system);
        let Some(beside) = self.beside else {
            return statement;
        };
        let is_unlimited = beside.own.is_some() && !beside.is_limited;
        let also = match (self.is_exceeded_beside(), is_unlimited) {
            (true, true) => ", above this limit; this quantity has no limit",
            (true, false) => ", above this limit",
            (false, true) => "; this quantity has no limit",
            (false, false) => "",
        };
        format!("{statement} for {}{also}", beside.sentence(system))
    }

    /// Whether the counterpart in the method exceeds the limit on the free impact.
    #[must_use]
    pub fn is_exceeded_beside(&self) -> bool {
        let own = self.beside.and_then(|beside| beside.own);
        own.and_then(|(_, own)| own).is_some_and(|own| own > self.limit.value)
    }

    fn statement(&self, system: System) -> String {
        let (key, limit) = (self.limit.quantity, sanitize(&self.limit.text));
        let (Some(value), Some(quantity)) = (self.value, Quantity::find(key)) else {
            return match self.absence {
                Some(Absence::Withheld(refusal)) => {
                    format!("{key} cannot be computed: {refusal} (limit {limit})")
                }
                Some(absence) if self.standing == Standing::Unknown => {
                    format!("{key} has no value (limit {limit}): {absence}")
                }
                _ => format!("{key} does not occur: no corner contact (limit {limit})"),
            };
        };
        let sign = if self.standing == Standing::Exceeded { ">" } else { "<=" };
        let part = self.part().map(|part| format!(" ({:.0} %)", 100.0 * part));
        format!(
            "{key} {} {sign} {limit}{}",
            shown_in(quantity, value, system),
            part.unwrap_or_default()
        )
    }
}

impl fmt::Display for Verdict<'_> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str(&self.sentence(System::Metric))
    }
}
