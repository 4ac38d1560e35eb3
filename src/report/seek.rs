//! The crossings of a condition as text or as JSON.

use super::json::{Json, json, measured, reason};
use super::results::{Named, Results};
use super::shown;
use crate::case::fields::FIELDS;
use crate::case::sanitize::sanitize;
use crate::numeric::decimal::shortest;
use crate::study::axis::{AxisRange, with_unit};
use crate::study::condition::{Condition, State};
use crate::study::seek::{Found, Sample};

/// A search and its result.
#[derive(Clone, Copy)]
pub struct SeekReport<'a> {
    /// The name of the method.
    pub method: &'a str,
    /// The searched range.
    pub range: &'a AxisRange,
    /// The condition.
    pub condition: &'a Condition,
    /// The result.
    pub found: &'a Found,
}

impl SeekReport<'_> {
    /// The result in one word.
    fn answer(&self) -> &'static str {
        match self.found.segments()[..] {
            [[Sample { state: State::Met, .. }, _]] => "always",
            [[Sample { state: State::NotMet, .. }, _]] => "never",
            [[Sample { state: State::Unknown(_), .. }, _]] => "unknown",
            _ => "crossings",
        }
    }

    fn value(&self, number: f64) -> String {
        with_unit(&shortest(number), &self.range.unit)
    }

    /// The values of the quantity of the condition at both ends of a bracket.
    fn values(&self, lower: &Sample, upper: &Sample) -> String {
        let Some(quantity) = self.condition.quantity() else { return String::new() };
        let [from, to] = [lower, upper].map(|sample| match sample.value {
            Some(value) => shown(quantity, value).to_string(),
            None => "no value".to_owned(),
        });
        format!(", {} {from} to {to}", quantity.key)
    }
}

impl Results for SeekReport<'_> {
    fn lines(&self, case: Named) -> Vec<String> {
        let AxisRange { field, from, to, .. } = *self.range;
        let (key, from, to) = (FIELDS[field].key, self.value(from), self.value(to));
        let (condition, method) = (sanitize(&self.condition.text), self.method);
        let first = format!("{condition} by method {method}, {key} from {from} to {to}:");
        let mut lines = vec![case.heading(), first];
        match self.answer() {
            "crossings" => {}
            "unknown" => {
                let line = "  unknown: the condition is unknown at every point of the range";
                lines.push(line.to_owned());
            }
            answer => {
                lines.push(format!("  {answer}"));
                return lines;
            }
        }
        // A value with the digits that a bracket supports.
        let rounded = |number: f64| self.value(format!("{number:.9e}").parse().unwrap_or(number));
        for [lower, upper] in self.found.crossings() {
            let middle = rounded(lower.at + 0.5 * (upper.at - lower.at));
            let (below, above) = (word(&lower.state), word(&upper.state));
            lines.push(format!("  crossing at {middle}: {below} below, {above} above"));
            let [from, to] = [lower, upper].map(|sample| self.value(sample.at));
            lines.push(format!("    bracket {from} to {to}{}", self.values(lower, upper)));
        }
        for [first, last] in self.found.segments() {
            let reason = match &first.state {
                State::Unknown(problem) => format!(": {problem}"),
                _ => String::new(),
            };
            let [from, to] = [first, last].map(|sample| rounded(sample.at));
            lines.push(format!("  {} from {from} to {to}{reason}", word(&first.state)));
        }
        lines
    }

    fn json(&self) -> Json {
        let AxisRange { field, unit, from, to } = self.range;
        let quantity = self.condition.quantity();
        let end = |Sample { at, state, value }: &Sample| {
            let value = quantity.and_then(|known| Some(measured(known, (*value)?, None)));
            json!({"at": at, "state": word(state).replace(' ', "-"), "quantity": value})
        };
        let crossings = self.found.crossings().into_iter();
        let crossings =
            crossings.map(|[lower, upper]| json!({"from": end(lower), "to": end(upper)}));
        let segments = self.found.segments().into_iter().map(|[Sample { at, state, .. }, last]| {
            let refusal = match state {
                State::Unknown(problem) => Some(reason(problem)),
                _ => None,
            };
            json!({"from": at, "to": last.at, "state": word(state).replace(' ', "-"), "refusal": refusal})
        });
        json!({
            "method": self.method,
            "vary": FIELDS[*field].key,
            "unit": if unit.is_empty() { "1" } else { unit },
            "from": from,
            "to": to,
            "until": self.condition.text,
            "answer": self.answer(),
            "crossings": crossings.collect::<Json>(),
            "segments": segments.collect::<Json>(),
            "solves": self.found.0.len(),
        })
    }
}

/// A state in the text report.
fn word(state: &State) -> &'static str {
    match state {
        State::Met => "met",
        State::NotMet => "not met",
        State::Unknown(_) => "unknown",
    }
}
