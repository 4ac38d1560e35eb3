//! The crossings of a condition as text or as JSON.

use std::io::{self, Write};

use serde::Serialize;

use super::data::{ValueWithUnit, write_line};
use super::shown;
use super::sweep::Reason;
use crate::case::fields::FIELDS;
use crate::case::sanitize::sanitize;
use crate::model::Quantity;
use crate::numeric::decimal::shortest;
use crate::study::axis::{AxisRange, with_unit};
use crate::study::condition::{Condition, State};
use crate::study::seek::{Crossing, Found, Sample, Segment};

/// A search and its result.
#[derive(Clone, Copy)]
pub struct SeekReport<'a> {
    /// The name of the case, as the user gave it.
    pub name: &'a str,
    /// The title of the case.
    pub title: &'a str,
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
    fn key(&self) -> &'static str {
        FIELDS[self.range.field].key
    }

    /// The result in one word.
    fn answer(&self) -> &'static str {
        match &self.found.segments[..] {
            [one] => match one.state {
                State::Met => "always",
                State::NotMet => "never",
                State::Unknown(_) => "unknown",
            },
            _ => "crossings",
        }
    }

    fn value(&self, number: f64) -> String {
        with_unit(&shortest(number), &self.range.unit)
    }

    /// Writes the result as text.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let (from, to) = (self.value(self.range.from), self.value(self.range.to));
        let title = if self.title.is_empty() { self.name } else { self.title };
        writeln!(out, "{}", sanitize(title))?;
        writeln!(
            out,
            "{} by method {}, {} from {from} to {to}:",
            sanitize(&self.condition.text),
            self.method,
            self.key()
        )?;
        match self.answer() {
            "crossings" => {}
            "unknown" => {
                writeln!(out, "  unknown: the condition is unknown at every point of the range")?;
            }
            answer => writeln!(out, "  {answer}")?,
        }
        for crossing in &self.found.crossings {
            self.write_crossing(crossing, out)?;
        }
        if self.answer() != "always" && self.answer() != "never" {
            self.write_segments(out)?;
        }
        Ok(())
    }

    fn write_crossing(&self, crossing: &Crossing, out: &mut dyn Write) -> io::Result<()> {
        let Crossing { lower, upper } = crossing;
        let (below, above) = (word(&lower.state), word(&upper.state));
        let [from, to] = [self.value(lower.at), self.value(upper.at)];
        writeln!(out, "  crossing at {}: {below} below, {above} above", self.middle(crossing))?;
        writeln!(out, "    bracket {from} to {to}{}", self.values(lower, upper))
    }

    /// The middle of a bracket.
    fn middle(&self, crossing: &Crossing) -> String {
        let (lower, upper) = (crossing.lower.at, crossing.upper.at);
        self.rounded(lower + 0.5 * (upper - lower))
    }

    /// A value with the digits that a bracket supports.
    fn rounded(&self, number: f64) -> String {
        self.value(format!("{number:.9e}").parse().unwrap_or(number))
    }

    fn values(&self, lower: &Sample, upper: &Sample) -> String {
        let printed = |sample: &Sample| match (self.condition.quantity(), sample.value) {
            (Some(quantity), Some(value)) => shown(quantity, value).to_string(),
            _ => "no value".to_owned(),
        };
        match self.condition.quantity() {
            Some(quantity) => {
                format!(", {} {} to {}", quantity.key, printed(lower), printed(upper))
            }
            None => String::new(),
        }
    }

    fn write_segments(&self, out: &mut dyn Write) -> io::Result<()> {
        for segment in &self.found.segments {
            let reason = match &segment.state {
                State::Unknown(problem) => format!(": {problem}"),
                _ => String::new(),
            };
            let [from, to] = [segment.from, segment.to].map(|end| self.rounded(end));
            let word = word(&segment.state);
            writeln!(out, "  {word} from {from} to {to}{reason}")?;
        }
        Ok(())
    }

    /// Writes the result as one JSON object on one line.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_json(&self, out: &mut dyn Write) -> io::Result<()> {
        let quantity = self.condition.quantity();
        let unit = self.range.unit.as_str();
        let line = Line {
            case: self.name,
            title: self.title,
            version: env!("CARGO_PKG_VERSION"),
            method: self.method,
            vary: self.key(),
            unit: if unit.is_empty() { "1" } else { unit },
            from: self.range.from,
            to: self.range.to,
            until: &self.condition.text,
            answer: self.answer(),
            crossings: self
                .found
                .crossings
                .iter()
                .map(|crossing| Bracket {
                    from: End::of(&crossing.lower, quantity),
                    to: End::of(&crossing.upper, quantity),
                })
                .collect(),
            segments: self.found.segments.iter().map(Part::of).collect(),
            solves: self.found.solves,
        };
        write_line(&line, out)
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

/// A state in JSON.
fn name(state: &State) -> &'static str {
    match state {
        State::NotMet => "not-met",
        other => word(other),
    }
}

#[derive(Serialize)]
struct Line<'a> {
    case: &'a str,
    title: &'a str,
    version: &'static str,
    method: &'a str,
    vary: &'static str,
    unit: &'a str,
    from: f64,
    to: f64,
    until: &'a str,
    answer: &'static str,
    crossings: Vec<Bracket>,
    segments: Vec<Part<'a>>,
    solves: usize,
}

#[derive(Serialize)]
struct Bracket {
    from: End,
    to: End,
}

#[derive(Serialize)]
struct End {
    at: f64,
    state: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    quantity: Option<ValueWithUnit>,
}

impl End {
    fn of(sample: &Sample, quantity: Option<&Quantity>) -> End {
        End {
            at: sample.at,
            state: name(&sample.state),
            quantity: quantity
                .and_then(|quantity| Some(ValueWithUnit::new(quantity, sample.value?))),
        }
    }
}

#[derive(Serialize)]
struct Part<'a> {
    from: f64,
    to: f64,
    state: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    refusal: Option<Reason<'a>>,
}

impl Part<'_> {
    fn of(segment: &Segment) -> Part<'_> {
        Part {
            from: segment.from,
            to: segment.to,
            state: name(&segment.state),
            refusal: match &segment.state {
                State::Unknown(problem) => Some(Reason::of(problem)),
                _ => None,
            },
        }
    }
}
