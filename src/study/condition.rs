//! A condition on a result, such as `impact_force<=2500 N`, and whether a point meets it.

use super::batch::{PointOutcome, Rows};
use crate::case::sanitize::quoted;
use crate::case::{Case, Fix, Limit, Problem, unknown_quantity};
use crate::model::inputs::Method;
use crate::model::{Outcome, Quantity};

/// A relation of a quantity to its limit.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Relation {
    /// Whether the limit is the greatest value; an absent quantity is below every limit.
    is_upper: bool,
    /// Whether the limit itself does not meet the condition.
    is_strict: bool,
}

/// Every sign, the longer ones first.
const SIGNS: [(&str, Relation); 4] = [
    ("<=", AT_MOST),
    (">=", AT_LEAST),
    ("<", Relation { is_upper: true, is_strict: true }),
    (">", Relation { is_upper: false, is_strict: true }),
];
const AT_MOST: Relation = Relation { is_upper: true, is_strict: false };
const AT_LEAST: Relation = Relation { is_upper: false, is_strict: false };

impl Relation {
    /// The distance of a value from the limit, above 0 where the condition is met.
    fn margin(self, value: f64, limit: f64) -> f64 {
        if self.is_upper { limit - value } else { value - limit }
    }

    fn is_met(self, value: f64, limit: f64) -> bool {
        let margin = self.margin(value, limit);
        margin > 0.0 || margin == 0.0 && !self.is_strict
    }
}

/// A condition on the result of a point.
#[derive(Debug, Clone, PartialEq)]
pub struct Condition {
    /// The condition as the user wrote it.
    pub text: String,
    kind: Kind,
}

#[derive(Debug, Clone, PartialEq)]
enum Kind {
    Outcome(Outcome),
    Compared(&'static str, Relation, f64),
}

/// Whether a point meets the condition.
#[derive(Debug, Clone, PartialEq)]
pub enum State {
    /// The point meets the condition.
    Met,
    /// The point does not meet the condition.
    NotMet,
    /// The point is refused, or the quantity has no value for another reason than no contact.
    Unknown(Problem),
}

impl State {
    /// Whether both states are of the same variant; the reason may differ.
    #[must_use]
    pub fn is_like(&self, other: &State) -> bool {
        std::mem::discriminant(self) == std::mem::discriminant(other)
    }
}

impl Condition {
    /// Parses a text such as `impact_force<=2500 N` or `outcome=no-corner-contact`.
    ///
    /// # Errors
    /// Returns an error if the quantity, the sign, the value or the outcome is unknown.
    pub fn parse(text: &str) -> Result<Condition, Problem> {
        let sign = SIGNS
            .into_iter()
            .filter_map(|(sign, relation)| Some((text.find(sign)?, sign, relation)))
            .min_by_key(|(at, sign, _)| (*at, std::cmp::Reverse(sign.len())));
        let kind = match (sign, text.split_once('=')) {
            (Some((at, sign, relation)), _) => {
                compared(&text[..at], relation, &text[at + sign.len()..])?
            }
            (None, Some((name, value))) if name.trim() == "outcome" => {
                outcome(value.strip_prefix('=').unwrap_or(value).trim())?
            }
            (None, Some((name, value))) => flag(name, value)?,
            (None, None) => {
                return Err(problem(
                    text,
                    "this is not a condition",
                    "write QUANTITY<=VALUE, such as 'impact_force<=2500 N', or \
                        outcome=no-corner-contact",
                ));
            }
        };
        let text = text.trim().to_owned();
        Ok(Condition { text, kind })
    }

    /// The quantity that the condition reads; `None` for the outcome.
    #[must_use]
    pub fn quantity(&self) -> Option<&'static Quantity> {
        match self.kind {
            Kind::Outcome(_) => None,
            Kind::Compared(key, ..) => Quantity::find(key),
        }
    }

    /// Checks that a method computes the quantity.
    ///
    /// # Errors
    /// Returns an error if the method does not compute the quantity.
    pub fn check(&self, method: Method) -> Result<(), Problem> {
        let missing = self.quantity().filter(|quantity| !method.stages().has(quantity.stage));
        let Some(quantity) = missing else {
            return Ok(());
        };
        let computes = |method: &Method| method.stages().has(quantity.stage);
        let others = Method::ALL.into_iter().filter(computes).map(Method::name);
        let others: Vec<&str> = others.collect();
        let cause = format!("method {} does not compute {}", method.name(), quantity.key);
        let fix = format!("use --method with one of {}", others.join(", "));
        Err(problem(quantity.key, cause, fix))
    }

    /// Whether a row meets the condition; the first value of the row must be the quantity.
    #[must_use]
    pub fn state(&self, rows: &Rows, row: usize) -> State {
        let outcome = match rows.outcomes[row] {
            PointOutcome::Solved(outcome) => outcome,
            PointOutcome::Refused => {
                let refused = || problem(&self.text, "the point is refused", "solve it alone");
                return State::Unknown(rows.refusal(row).cloned().unwrap_or_else(refused));
            }
        };
        let is_met = match self.kind {
            Kind::Outcome(wanted) => outcome == wanted,
            Kind::Compared(key, relation, limit) => {
                match (rows.values(row).next().flatten(), is_without(key, outcome)) {
                    (Some(value), _) => relation.is_met(value, limit),
                    (None, true) => relation.is_upper,
                    (None, false) => {
                        return State::Unknown(problem(
                            key,
                            format!("{key} has no value here"),
                            "solve the point alone for the reason",
                        ));
                    }
                }
            }
        };
        if is_met { State::Met } else { State::NotMet }
    }

    /// The distance of a value from the limit, above 0 where the condition is met.
    #[must_use]
    pub fn margin(&self, value: f64) -> Option<f64> {
        match self.kind {
            Kind::Outcome(_) => None,
            Kind::Compared(_, relation, limit) => Some(relation.margin(value, limit)),
        }
    }
}

/// Whether a quantity is absent because no tooth strikes.
fn is_without(key: &str, outcome: Outcome) -> bool {
    outcome == Outcome::NoCornerContact
        || Quantity::find(key).is_some_and(Quantity::is_of_free_impact)
}

fn compared(name: &str, relation: Relation, value: &str) -> Result<Kind, Problem> {
    let quantity = named(name)?;
    if quantity.is_flag() {
        let key = quantity.key;
        return Err(problem(
            key,
            format!("{key} is true or false and has no order"),
            format!("write {key}=true or {key}=false"),
        ));
    }
    let limit = Limit::new(quantity.key, value.trim())?;
    Ok(Kind::Compared(quantity.key, relation, limit.value))
}

fn named(name: &str) -> Result<&'static Quantity, Problem> {
    Quantity::named(name.trim()).ok_or_else(|| unknown_quantity(name, name))
}

fn outcome(name: &str) -> Result<Kind, Problem> {
    let outcomes = [Outcome::CornerContact, Outcome::NoCornerContact];
    let found = outcomes.into_iter().find(|outcome| outcome.name() == name);
    found.map(Kind::Outcome).ok_or_else(|| {
        let names = outcomes.map(Outcome::name).join(" or ");
        problem("outcome", format!("unknown outcome {}", quoted(name)), format!("write {names}"))
    })
}

fn flag(name: &str, value: &str) -> Result<Kind, Problem> {
    let quantity = named(name)?;
    let key = quantity.key;
    let value = value.strip_prefix('=').unwrap_or(value);
    if !quantity.is_flag() {
        return Err(problem(
            key,
            format!("= compares only flags and outcomes, and {key} is a number"),
            format!("write {key}<={}", value.trim()),
        ));
    }
    match value.trim() {
        "true" | "yes" => Ok(Kind::Compared(key, AT_LEAST, 1.0)),
        "false" | "no" => Ok(Kind::Compared(key, AT_MOST, 0.0)),
        other => Err(problem(
            key,
            format!("{} is neither true nor false", quoted(other)),
            format!("write {key}=true or {key}=false"),
        )),
    }
}

fn problem(field: &str, cause: impl Into<String>, fix: impl Into<Fix>) -> Problem {
    Problem::new(field, cause, fix)
}

/// The limited quantities of a case, otherwise the impact force; each with its counterparts in the
/// methods that resolve the impact.
#[must_use]
pub fn headline(case: &Case, methods: &[Method]) -> Vec<&'static Quantity> {
    let limited: Vec<&Quantity> = case
        .limits
        .iter()
        .filter(|limit| !limit.text.is_empty())
        .filter_map(|limit| Quantity::find(limit.quantity))
        .collect();
    let force = Quantity::find("impact_force").into_iter();
    if limited.is_empty() {
        return distinct(force.flat_map(|force| in_methods(force, methods)));
    }
    let all = |quantity: &'static Quantity| {
        std::iter::once(quantity).chain(in_methods(quantity, methods))
    };
    distinct(limited.into_iter().flat_map(all))
}

/// The counterpart of a quantity of the free impact in each method; for `auto`, in each method that
/// `auto` may choose.
fn in_methods(quantity: &'static Quantity, methods: &[Method]) -> Vec<&'static Quantity> {
    let single = |method: &Method| match method {
        Method::Auto => vec![Method::Exact, Method::Static, Method::Dynamic],
        one => vec![*one],
    };
    methods.iter().flat_map(single).filter_map(|method| quantity.by(method)).collect()
}

/// Quantities without duplicates, in the order of their first occurrence.
#[must_use]
pub fn distinct(quantities: impl IntoIterator<Item = &'static Quantity>) -> Vec<&'static Quantity> {
    let mut found: Vec<&'static Quantity> = Vec::new();
    for quantity in quantities {
        if found.iter().all(|known| known.key != quantity.key) {
            found.push(quantity);
        }
    }
    found
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_condition_compares_a_quantity_or_an_outcome() {
        for (text, kind) in [
            ("impact_force<=2.5 kN", Kind::Compared("impact_force", AT_MOST, 2500.0)),
            ("F_S < 2500 N", Kind::Compared("impact_force", SIGNS[2].1, 2500.0)),
            ("contact_ratio>=1.4", Kind::Compared("contact_ratio", AT_LEAST, 1.4)),
            ("contact_ratio>1.4", Kind::Compared("contact_ratio", SIGNS[3].1, 1.4)),
            ("outcome=no-corner-contact", Kind::Outcome(Outcome::NoCornerContact)),
            ("dynamic_contact_lost=false", Kind::Compared("dynamic_contact_lost", AT_MOST, 0.0)),
        ] {
            assert_eq!(Condition::parse(text).unwrap().kind, kind, "{text}");
        }
    }

    #[test]
    fn a_bad_condition_gets_its_cause_and_fix() {
        for (text, part) in [
            ("impact_force", "this is not a condition: write QUANTITY<=VALUE"),
            ("impact_forc<=2500 N", "did you mean impact_force?"),
            ("impact_force<=2500", "2500 has no unit"),
            ("impact_force<=2500 mm", "unit of length"),
            ("impact_force=2500 N", "is a number: write impact_force<=2500 N"),
            ("outcome=contact", "write corner-contact or no-corner-contact"),
            ("impact_force==2500 N", "is a number: write impact_force<=2500 N"),
            ("dynamic_contact_lost=maybe", "neither true nor false"),
            ("dynamic_contact_lost<=1", "has no order: write dynamic_contact_lost=true or"),
        ] {
            let message = Condition::parse(text).unwrap_err().to_string();
            assert!(message.contains(part), "{text}: {message}");
        }
        let condition = Condition::parse("dynamic_peak_force<=1 kN").unwrap();
        let message = condition.check(Method::Exact).unwrap_err().to_string();
        assert!(message.contains("use --method with one of dynamic, auto"), "{message}");
    }
}
