//! A case held against its own limits.

mod json;

use super::absence::Absence;
use super::{shown_in, value};
use crate::case::sanitize::sanitize;
use crate::case::units::System;
use crate::case::{Case, Limit};
use crate::model::inputs::Method;
use crate::model::{Quantity, Refusal, Solution, Stage, Stages};
pub use json::write as write_json;
use std::fmt;

/// How a quantity stands to its limit.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Standing {
    /// At most the limit.
    Within,
    /// Above the limit.
    Exceeded,
    /// No tooth strikes, so that there is nothing to exceed it.
    NotApplicable,
    /// There is no value to hold against it, though a tooth may strike: the limit does not hold.
    Unknown,
}

impl Standing {
    /// Whether the limit holds.
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

/// A limit of a case and what was found of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Verdict<'a> {
    /// The limit.
    pub limit: &'a Limit,
    /// The quantity's value in SI.
    pub value: Option<f64>,
    /// How the two stand.
    pub standing: Standing,
    /// Why there is no value.
    pub absence: Option<Absence>,
    /// What the method itself finds in place of the limited quantity, where that is the closed
    /// form's.
    pub beside: Option<Beside>,
}

/// What stands beside a quantity of the free impact in a method that resolves the impact.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Beside {
    /// The method.
    pub method: Method,
    /// Its own quantity and the value in SI, where it has them.
    pub own: Option<(&'static str, Option<f64>)>,
    /// Whether the case holds that one to a limit of its own.
    pub is_limited: bool,
}

impl Beside {
    /// What stands beside that quantity of a solution.
    #[must_use]
    pub fn of(quantity: &'static Quantity, solution: &Solution) -> Option<Beside> {
        let method = solution.method;
        let own = || {
            quantity
                .by(method)
                .map(|own| (own.key, value(own, solution)))
        };
        (method.shares_load() && quantity.is_of_free_impact()).then(|| Beside {
            method,
            own: own(),
            is_limited: false,
        })
    }

    /// In words, the value in metric or inch units.
    #[must_use]
    pub fn told(&self, system: System) -> String {
        let own = self
            .own
            .and_then(|(key, value)| Some((Quantity::find(key)?, value)));
        let method = self.method.name();
        match own {
            Some((own, Some(value))) => {
                format!(
                    "of the free impact, in closed form; {method} itself finds {} {}",
                    own.key,
                    shown_in(own, value, system)
                )
            }
            Some((own, None)) => format!(
                "of the free impact, in closed form; {method} itself tells {}",
                own.key
            ),
            None => format!("of the free impact, in closed form, and not of {method}"),
        }
    }
}

/// Every limit of the case held against the solution, in the case's order.
#[must_use]
pub fn verdicts<'a>(case: &'a Case, solution: &Solution) -> Vec<Verdict<'a>> {
    let is_limited = |beside: &Beside| {
        case.limits
            .iter()
            .any(|limit| beside.own.is_some_and(|(own, _)| own == limit.quantity))
    };
    let of_case = |verdict: Verdict<'a>| Verdict {
        beside: verdict.beside.map(|beside| Beside {
            is_limited: is_limited(&beside),
            ..beside
        }),
        ..verdict
    };
    case.limits
        .iter()
        .map(|limit| of_case(verdict(limit, solution)))
        .collect()
}

/// The stages that every limit of a case needs.
#[must_use]
pub fn stages(case: &Case) -> Stages {
    of_all(limited(case))
}

/// The stages of what a method itself finds in place of the limited quantities.
#[must_use]
pub fn stages_beside(case: &Case, method: Method) -> Stages {
    of_all(
        limited(case)
            .filter(|quantity| quantity.is_of_free_impact())
            .filter_map(|quantity| quantity.by(method)),
    )
}

fn limited(case: &Case) -> impl Iterator<Item = &'static Quantity> {
    case.limits
        .iter()
        .filter_map(|limit| Quantity::find(limit.quantity))
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
    let absence = quantity
        .filter(|_| value.is_none())
        .map(|quantity| Absence::of(quantity, solution));
    let standing = match (value, absence) {
        (Some(value), _) if value <= limit.value => Standing::Within,
        (Some(_), _) => Standing::Exceeded,
        (None, Some(absence)) if absence.is_for_want_of_contact() => Standing::NotApplicable,
        (None, _) => Standing::Unknown,
    };
    // Where nothing strikes no method tells another story.
    let beside = quantity
        .filter(|_| value.is_some())
        .and_then(|quantity| Beside::of(quantity, solution));
    Verdict {
        limit,
        value,
        standing,
        absence,
        beside,
    }
}

/// Every limit of a case that the model refuses: none can be held against anything.
#[must_use]
pub fn refused<'a>(case: &'a Case, refusal: &Refusal) -> Vec<Verdict<'a>> {
    let absence = Some(Absence::Withheld(*refusal));
    let verdict = |limit| Verdict {
        limit,
        value: None,
        standing: Standing::Unknown,
        absence,
        beside: None,
    };
    case.limits.iter().map(verdict).collect()
}

impl Verdict<'_> {
    /// The value as a part of the limit, where that says something.
    #[must_use]
    pub fn part(&self) -> Option<f64> {
        let value = self.value.filter(|&value| {
            self.limit.value > 0.0 && self.limit.value.is_finite() && value >= 0.0
        })?;
        Some(value / self.limit.value)
    }

    /// The verdict in a line, the value in metric or inch units; the limit as it was written.
    #[must_use]
    pub fn told(&self, system: System) -> String {
        let beside = self
            .beside
            .map_or_else(String::new, |beside| format!(": {}", beside.told(system)));
        let above = if self.is_exceeded_beside() {
            ", above the limit"
        } else {
            ""
        };
        self.said(system) + &beside + above + self.to_hold_beside()
    }

    // The limit keeps its meaning: how to hold what the method finds, where the case does not.
    fn to_hold_beside(&self) -> &'static str {
        let may_be_limited = self
            .beside
            .is_some_and(|beside| beside.own.is_some() && !beside.is_limited);
        if may_be_limited {
            "; a limit on that holds it"
        } else {
            ""
        }
    }

    /// Whether what the method itself finds is above the limit of what the closed form says.
    #[must_use]
    pub fn is_exceeded_beside(&self) -> bool {
        // An angle may be of the other gear.
        let is_held = |key: &str| Quantity::find(key).is_some_and(|own| own.unit != "rad");
        let own = self
            .beside
            .and_then(|beside| beside.own)
            .filter(|(key, _)| is_held(key))
            .and_then(|(_, own)| own);
        own.is_some_and(|own| own > self.limit.value)
    }

    fn said(&self, system: System) -> String {
        let (key, limit) = (self.limit.quantity, sanitize(&self.limit.text));
        let (Some(value), Some(quantity)) = (self.value, Quantity::find(key)) else {
            return match self.absence {
                Some(Absence::Withheld(refusal)) => {
                    format!("{key} cannot be computed: {refusal} (limit {limit})")
                }
                Some(absence) if self.standing == Standing::Unknown => {
                    format!("{key} has no value to hold against {limit}: {absence}")
                }
                _ => format!("{key} none, no corner contact (limit {limit})"),
            };
        };
        let sign = if self.standing == Standing::Exceeded {
            ">"
        } else {
            "<="
        };
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
        f.write_str(&self.told(System::Metric))
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::model::Stages;

    fn told(limits: &[(&str, &str)], system: System) -> Vec<String> {
        let mut case = Case::table_1();
        for (quantity, text) in limits {
            case.set_limit(quantity, text).unwrap();
        }
        let solution = crate::model::solve(&case.inputs().unwrap(), Stages::ALL).unwrap();
        verdicts(&case, &solution)
            .iter()
            .map(|verdict| format!("{} {}", verdict.standing.word(), verdict.told(system)))
            .collect()
    }

    #[test]
    fn what_the_method_itself_finds_stands_beside_the_free_impact_and_leaves_the_verdict() {
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
            [(
                Standing::Within,
                "impact_force 2191.0 N <= 2500 N (88 %)".to_owned()
            )]
        );
        let [(standing, told)] = &verdicts("dynamic", "2100 N")[..] else {
            panic!("one limit")
        };
        assert_eq!(*standing, Standing::Within);
        assert!(
            told.ends_with("; dynamic itself finds dynamic_peak_approach_force 1410.8 N; a limit on that holds it"),
            "{told}"
        );
        let [(standing, told)] = &verdicts("static", "1 kN")[..] else {
            panic!("one limit")
        };
        assert_eq!(*standing, Standing::Exceeded);
        assert!(
            told.ends_with("; static itself finds static_force_at_start 1466.2 N, above the limit; a limit on that holds it"),
            "{told}"
        );
    }

    #[test]
    fn a_limit_without_a_value_says_why_and_passes_only_where_nothing_strikes() {
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
        let (standing, told) = stands("exact", "0 um", "dynamic_peak_force", "2 kN");
        assert_eq!(standing, Standing::Unknown);
        assert_eq!(
            told,
            "dynamic_peak_force has no value to hold against 2 kN: the method is exact, and this is of dynamic, auto"
        );
        // That nothing strikes in closed form says nothing of the motion.
        assert_eq!(
            stands("exact", "80 um", "dynamic_peak_force", "2 kN").0,
            Standing::Unknown
        );
        assert_eq!(
            stands("exact", "80 um", "impact_force", "2 kN").0,
            Standing::NotApplicable
        );
        let (standing, told) = stands("static", "80 um", "pitch_contact_jump", "2 kN");
        assert_eq!(standing, Standing::Unknown);
        assert!(
            told.ends_with(
                "the case gives no friction coefficient, operation.friction_coefficient"
            ),
            "{told}"
        );
        assert_eq!(
            stands("static", "80 um", "static_first_contact_angle", "1 deg").0,
            Standing::NotApplicable
        );
    }

    #[test]
    fn who_limits_what_the_method_finds_is_not_told_to() {
        let mut case = Case::table_1();
        case.set("model.method", "static").unwrap();
        case.set_limit("static_force_at_start", "1 kN").unwrap();
        let solution = crate::model::solve(&case.inputs().unwrap(), Stages::EVERY).unwrap();
        let told = verdicts(&case, &solution)[0].to_string();
        assert!(
            told.ends_with("static itself finds static_force_at_start 1466.2 N"),
            "{told}"
        );
    }

    #[test]
    fn a_limit_stays_as_it_was_written_in_either_system() {
        let limits = [("impact_force", "500 lbf"), ("contact_ratio", "1.5")];
        assert_eq!(
            told(&limits, System::Metric),
            [
                "ok impact_force 2191.0 N <= 500 lbf (99 %)",
                "EXCEEDED contact_ratio 1.5568 > 1.5 (104 %)"
            ]
        );
        assert_eq!(
            told(&limits, System::Inch)[0],
            "ok impact_force 492.56 lbf <= 500 lbf (99 %)"
        );
    }

    #[test]
    fn a_refused_case_gives_the_reason_for_every_limit() {
        let case = Case::table_1();
        let verdicts = refused(
            &case,
            &Refusal::ContactRatioBelowOne {
                ratio: 0.9,
                is_deflection_taken: true,
            },
        );
        assert!(!verdicts[0].standing.holds());
        assert!(
            verdicts[0]
                .to_string()
                .starts_with("impact_force cannot be computed: the contact ratio is 0.9000")
        );
    }
}
