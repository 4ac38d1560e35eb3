//! Conditions on results, such as `impact_force<=2500 N`, and the values of a field at which one changes.

use crate::case::sanitize::quoted;
use crate::case::{self, Case, Limit, Problem};
use crate::model::inputs::Method;
use crate::model::{Inputs, Outcome, Quantity, Refusal, Stage};
use crate::study::axis::{Axis, AxisRange, Grid};
use crate::study::batch::{Batch, Control, PointOutcome, Points, Row, solve_all};

/// A relation of a quantity to its limit.
#[derive(Debug, Clone, Copy, PartialEq)]
struct Relation {
    /// Whether the limit is the greatest value; an absent quantity is below every limit.
    is_upper: bool,
    /// Whether the limit itself does not meet the condition.
    is_strict: bool,
}

const AT_MOST: Relation = Relation { is_upper: true, is_strict: false };
const AT_LEAST: Relation = Relation { is_upper: false, is_strict: false };

impl Relation {
    /// The distance of a value from the limit, above 0 where the condition is met.
    fn margin(self, value: f64, limit: f64) -> f64 {
        if self.is_upper { limit - value } else { value - limit }
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
    /// The outcome before E, or at the exit.
    Outcome(Outcome, bool),
    /// The quantity with its limit, or with its factor of another quantity.
    Compared(&'static Quantity, Relation, f64, Option<&'static Quantity>),
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
        let text = text.trim();
        let (name, relation, value) = if let Some(at) = text.find(['<', '>']) {
            let (is_upper, limit) = (text[at..].starts_with('<'), &text[at + 1..]);
            let (is_strict, limit) =
                limit.strip_prefix('=').map_or((true, limit), |limit| (false, limit));
            (&text[..at], Some(Relation { is_upper, is_strict }), limit.trim())
        } else if let Some((name, value)) = text.split_once('=') {
            (name, None, value.strip_prefix('=').unwrap_or(value).trim())
        } else {
            let fix = "write QUANTITY<=VALUE, such as 'impact_force<=2500 N', or \
                outcome=no-corner-contact";
            return Err(Problem::new(text, "this is not a condition", fix));
        };
        let kind = match name.trim() {
            name @ ("outcome" | "exit_outcome") if relation.is_none() => outcome(name, value)?,
            name => compared(name, relation, value)?,
        };
        Ok(Condition { text: text.to_owned(), kind })
    }

    /// The quantity that the condition reads; `None` for the outcome.
    pub fn quantity(&self) -> Option<&'static Quantity> {
        match self.kind {
            Kind::Outcome(..) => None,
            Kind::Compared(quantity, ..) => Some(quantity),
        }
    }

    /// The quantity, and the one to which its limit is relative.
    pub fn quantities(&self) -> Vec<&'static Quantity> {
        match self.kind {
            Kind::Outcome(..) => Vec::new(),
            Kind::Compared(quantity, .., of) => [quantity].into_iter().chain(of).collect(),
        }
    }

    /// The stages that the condition reads, besides those of every solve.
    pub fn stages(&self) -> Vec<Stage> {
        match self.kind {
            Kind::Outcome(_, is_at_exit) => {
                is_at_exit.then_some(Stage::Static).into_iter().collect()
            }
            Kind::Compared(..) => self.quantities().iter().map(|quantity| quantity.stage).collect(),
        }
    }

    /// Checks that a method computes the quantities, or the outcome at the exit.
    ///
    /// # Errors
    /// Returns an error if the method does not compute one of them.
    pub fn check(&self, method: Method) -> Result<(), Problem> {
        let is_absent = |stage: &Stage| !method.stages().has(*stage);
        let Some(at) = self.stages().iter().position(is_absent) else { return Ok(()) };
        let key = self.quantities().get(at).map_or("exit_outcome", |quantity| quantity.key);
        let computes = |method: &Method| method.stages().has(self.stages()[at]);
        let others: Vec<&str> =
            Method::ALL.into_iter().filter(computes).map(Method::name).collect();
        let cause = format!("method {} does not compute {key}", method.name());
        let fix = format!("use --method with one of {}", others.join(", "));
        Err(Problem::new(key, cause, fix))
    }

    /// Whether a row meets the condition; the values of the row are [`Self::quantities`].
    pub fn state(&self, row: &Row) -> State {
        let outcome = match (row.outcome, &row.refusal) {
            (_, Some(refused)) => return State::Unknown((**refused).clone()),
            (PointOutcome::Solved(outcome), None) => outcome,
            (PointOutcome::Refused, None) => Outcome::NoCornerContact,
        };
        let is_met = match self.kind {
            Kind::Outcome(wanted, false) => outcome == wanted,
            Kind::Outcome(wanted, true) => row.exit_outcome == Some(PointOutcome::Solved(wanted)),
            Kind::Compared(quantity, relation, ..) => {
                match self.margin(row) {
                    Some(margin) => margin > 0.0 || margin == 0.0 && !relation.is_strict,
                    // No tooth strikes.
                    None if outcome == Outcome::NoCornerContact || quantity.is_of_free_impact() => {
                        relation.is_upper
                    }
                    None => {
                        let fix = "solve the point alone for the reason";
                        let key = quantity.key;
                        let problem = Problem::new(key, format!("{key} has no value here"), fix);
                        return State::Unknown(problem);
                    }
                }
            }
        };
        if is_met { State::Met } else { State::NotMet }
    }

    /// The distance of the value of a row from the limit, above 0 where the condition is met.
    fn margin(&self, row: &Row) -> Option<f64> {
        let Kind::Compared(_, relation, limit, of) = self.kind else { return None };
        let value = |at: usize| row.values.get(at).copied().flatten();
        let base = if of.is_some() { value(1)? } else { 1.0 };
        Some(relation.margin(value(0)?, limit * base))
    }
}

/// A quantity compared with a limit, or a flag with its value.
fn compared(name: &str, relation: Option<Relation>, value: &str) -> Result<Kind, Problem> {
    let quantity = case::quantity(name, name)?;
    let key = quantity.key;
    let flags = format!("write {key}=true or {key}=false");
    let (cause, fix) = match (quantity.is_flag(), relation) {
        (false, Some(relation)) => {
            let Limit { value, of, .. } = Limit::new(key, value)?;
            return Ok(Kind::Compared(quantity, relation, value, of));
        }
        (false, None) => {
            let cause = format!("= compares only flags and outcomes, and {key} is a number");
            (cause, format!("write {key}<={value}"))
        }
        (true, Some(_)) => (format!("{key} is true or false and has no order"), flags),
        (true, None) => match value {
            "true" | "yes" => return Ok(Kind::Compared(quantity, AT_LEAST, 1.0, None)),
            "false" | "no" => return Ok(Kind::Compared(quantity, AT_MOST, 0.0, None)),
            other => (format!("{} is neither true nor false", quoted(other)), flags),
        },
    };
    Err(Problem::new(key, cause, fix))
}

fn outcome(key: &str, name: &str) -> Result<Kind, Problem> {
    let outcomes = [Outcome::CornerContact, Outcome::NoCornerContact];
    let found = outcomes.into_iter().find(|outcome| outcome.name() == name);
    found.map(|found| Kind::Outcome(found, key == "exit_outcome")).ok_or_else(|| {
        let names = outcomes.map(Outcome::name).join(" or ");
        let cause = format!("unknown outcome {}", quoted(name));
        Problem::new(key, cause, format!("write {names}"))
    })
}

/// The limited quantities of a case, otherwise the impact force; each with its counterparts in the
/// methods that resolve the impact.
pub fn headline(case: &Case, methods: &[Method]) -> Vec<&'static Quantity> {
    // Method `auto` may choose any of these.
    let single = |method: &Method| match method {
        Method::Auto => vec![Method::Exact, Method::Static, Method::Dynamic],
        one => vec![*one],
    };
    let methods: Vec<Method> = methods.iter().flat_map(single).collect();
    let counterparts = |quantity: &'static Quantity| {
        let methods = methods.iter().filter(|_| quantity.is_of_free_impact());
        methods.filter_map(|&method| quantity.by(method)).collect::<Vec<_>>()
    };
    let limited = case.limits.iter().filter(|limit| !limit.text.is_empty());
    let limited = limited.map(|limit| limit.quantity);
    let found = distinct(limited.flat_map(|known| [vec![known], counterparts(known)].concat()));
    if found.is_empty() {
        return distinct(Quantity::find("impact_force").into_iter().flat_map(counterparts));
    }
    found
}

/// Items without duplicates, in the order of their first occurrence.
pub fn distinct<T: PartialEq>(items: impl IntoIterator<Item = T>) -> Vec<T> {
    let mut found = Vec::new();
    for item in items {
        if !found.contains(&item) {
            found.push(item);
        }
    }
    found
}

/// Default number of points of the first scan.
pub const USUAL_SCAN: usize = 201;

/// Width of the bracket of a crossing, relative to the value of the field.
const WIDTH: f64 = 1e-9;

/// Width of the bracket of a crossing at 0, relative to the range.
const WIDTH_AT_ZERO: f64 = 1e-15;

/// Pieces into which a round divides an interval.
const PIECES: usize = 16;

/// Greatest number of rounds. One round makes a bracket sixteen times narrower.
const MOST_ROUNDS: usize = 24;

/// A point of the range.
#[derive(Debug, Clone, PartialEq)]
pub struct Sample {
    /// The value of the field, in the unit of the range.
    pub at: f64,
    /// Whether this point meets the condition.
    pub state: State,
    /// The value of the quantity in SI.
    pub value: Option<f64>,
    /// Its distance from the limit.
    margin: Option<f64>,
}

/// The result of a search: every solved point, in order.
#[derive(Debug, Clone, PartialEq)]
pub struct Found(pub Vec<Sample>);

impl Found {
    /// Every change of the state: the neighbouring points between which it changes.
    pub fn crossings(&self) -> Vec<[&Sample; 2]> {
        let changes = self.0.windows(2).filter(|pair| !pair[0].state.is_like(&pair[1].state));
        changes.map(|pair| [&pair[0], &pair[1]]).collect()
    }

    /// The first and the last point of each part of the range with one state. An unknown state has
    /// the reason at the first point.
    pub fn segments(&self) -> Vec<[&Sample; 2]> {
        let parts = self.0.chunk_by(|one, other| one.state.is_like(&other.state));
        parts.filter_map(|part| Some([part.first()?, part.last()?])).collect()
    }
}

/// Finds every value of a field at which a condition changes.
///
/// `scan` has the points of the range that are solved first. The search divides each interval with different
/// states at its ends until its width is 1e-9 of the value. It also divides the interval where the
/// quantity turns back close to its limit, so that it finds two crossings close to each other.
///
/// # Errors
/// [`Refusal::Stopped`] if the user stops the search.
pub fn seek(
    inputs: &Inputs,
    range: &AxisRange,
    condition: &Condition,
    scan: &Axis,
    control: &Control,
) -> Result<Found, Refusal> {
    let quantities = condition.quantities();
    let solve = |axis: Axis| {
        let grid = Grid { axes: vec![axis] };
        let batch = Batch { inputs, points: &grid, quantities: &quantities };
        let mut samples = Vec::with_capacity(grid.count());
        solve_all(&batch, 0..grid.count(), control, &mut |first, rows| {
            let points = &grid.axes[0].points[first..];
            samples.extend(points.iter().zip(rows).map(|(point, row)| Sample {
                at: point.number.unwrap_or_default(),
                state: condition.state(row),
                value: row.values.first().copied().flatten(),
                margin: condition.margin(row),
            }));
            true
        })?;
        Ok(samples)
    };
    let mut samples = solve(scan.clone())?;
    for _ in 0..MOST_ROUNDS {
        let wanted = refinement(range, &samples);
        if wanted.is_empty() {
            break;
        }
        // The field accepts every number between the ends of the range.
        let points = wanted.into_iter().filter_map(|number| range.at(number).ok()).collect();
        samples.extend(solve(Axis { points, ..scan.clone() })?);
        samples.sort_by(|one, other| one.at.total_cmp(&other.at));
    }
    Ok(Found(samples))
}

/// New points in the intervals that need refinement.
fn refinement(range: &AxisRange, samples: &[Sample]) -> Vec<f64> {
    let is_wide = |lower: &Sample, upper: &Sample| {
        let size = lower.at.abs().max(upper.at.abs());
        upper.at - lower.at > (WIDTH * size).max(WIDTH_AT_ZERO * (range.to - range.from))
    };
    let mut intervals: Vec<bool> = samples
        .windows(2)
        .map(|pair| !pair[0].state.is_like(&pair[1].state) && is_wide(&pair[0], &pair[1]))
        .collect();
    for (at, three) in samples.windows(3).enumerate() {
        if turns_back(three) && is_wide(&three[0], &three[2]) {
            (intervals[at], intervals[at + 1]) = (true, true);
        }
    }
    let wanted = samples.windows(2).zip(intervals).filter(|(_, is_wanted)| *is_wanted);
    wanted.flat_map(|(pair, _)| pieces(pair[0].at, pair[1].at)).collect()
}

/// Whether the quantity is so close to its limit at the middle of three points with one state that
/// it may cross the limit between them.
fn turns_back(three: &[Sample]) -> bool {
    let margin = |sample: &Sample| Some(sample.margin?.abs());
    let state = &three[0].state;
    let is_one_answer =
        three.iter().all(|one| one.state.is_like(state)) && !matches!(state, State::Unknown(_));
    let [Some(left), Some(middle), Some(right)] = [0, 1, 2].map(|at| margin(&three[at])) else {
        return false;
    };
    let is_nearest = middle < left.max(right) && middle <= left.min(right);
    // Assumes that between the points the margin falls by at most as much as it fell towards the
    // middle point.
    is_one_answer && is_nearest && 2.0 * middle <= left.max(right)
}

/// The numbers that divide an interval, without its ends.
fn pieces(from: f64, to: f64) -> impl Iterator<Item = f64> {
    let step = (to - from) / PIECES as f64;
    (1..PIECES)
        .map(move |piece| from + step * piece as f64)
        .filter(move |&number| from < number && number < to)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_condition_compares_a_quantity_or_an_outcome() {
        let compared = |key: &str, relation: Relation, limit: f64| {
            Kind::Compared(Quantity::find(key).unwrap(), relation, limit, None)
        };
        let strict = |relation: Relation| Relation { is_strict: true, ..relation };
        for (text, kind) in [
            ("impact_force<=2.5 kN", compared("impact_force", AT_MOST, 2500.0)),
            ("F_S < 2500 N", compared("impact_force", strict(AT_MOST), 2500.0)),
            ("contact_ratio>=1.4", compared("contact_ratio", AT_LEAST, 1.4)),
            ("contact_ratio>1.4", compared("contact_ratio", strict(AT_LEAST), 1.4)),
            ("outcome=no-corner-contact", Kind::Outcome(Outcome::NoCornerContact, false)),
            ("exit_outcome=corner-contact", Kind::Outcome(Outcome::CornerContact, true)),
            ("dynamic_contact_lost=false", compared("dynamic_contact_lost", AT_MOST, 0.0)),
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
            ("impact_force<=1.3 x contact_ratio", "name a result in the same unit"),
            ("impact_force=2500 N", "is a number: write impact_force<=2500 N"),
            ("outcome=contact", "write corner-contact or no-corner-contact"),
            ("impact_force==2500 N", "is a number: write impact_force<=2500 N"),
            ("dynamic_contact_lost=maybe", "neither true nor false"),
            ("dynamic_contact_lost<=1", "has no order: write dynamic_contact_lost=true or"),
        ] {
            let message = Condition::parse(text).unwrap_err().to_string();
            assert!(message.contains(part), "{text}: {message}");
        }
        for (text, methods) in [
            ("dynamic_peak_force<=1 kN", "use --method with one of dynamic, auto"),
            ("exit_outcome=corner-contact", "use --method with one of static, dynamic, auto"),
        ] {
            let message = Condition::parse(text).unwrap().check(Method::Exact).unwrap_err();
            assert!(message.to_string().contains(methods), "{message}");
        }
    }
}
