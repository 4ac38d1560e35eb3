//! The crossings of a condition as text or as JSON.

use std::io::{self, Write};

use super::json::{measured, object, reason, write_line};
use super::shown;
use crate::case::fields::FIELDS;
use crate::case::sanitize::sanitize;
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
        let answer = self.answer();
        match answer {
            "crossings" => {}
            "unknown" => {
                writeln!(out, "  unknown: the condition is unknown at every point of the range")?;
            }
            answer => writeln!(out, "  {answer}")?,
        }
        for Crossing { lower, upper } in &self.found.crossings {
            let middle = self.rounded(lower.at + 0.5 * (upper.at - lower.at));
            let (below, above) = (word(&lower.state), word(&upper.state));
            writeln!(out, "  crossing at {middle}: {below} below, {above} above")?;
            let [from, to] = [lower, upper].map(|sample| self.value(sample.at));
            writeln!(out, "    bracket {from} to {to}{}", self.values(lower, upper))?;
        }
        if ["always", "never"].contains(&answer) {
            return Ok(());
        }
        for Segment { from, to, state } in &self.found.segments {
            let reason = match state {
                State::Unknown(problem) => format!(": {problem}"),
                _ => String::new(),
            };
            let [from, to] = [*from, *to].map(|end| self.rounded(end));
            writeln!(out, "  {} from {from} to {to}{reason}", word(state))?;
        }
        Ok(())
    }

    /// A value with the digits that a bracket supports.
    fn rounded(&self, number: f64) -> String {
        self.value(format!("{number:.9e}").parse().unwrap_or(number))
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

    /// Writes the result as one JSON object on one line.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_json(&self, out: &mut dyn Write) -> io::Result<()> {
        let unit = self.range.unit.as_str();
        let end = |sample: &Sample| {
            let quantity = self.condition.quantity();
            let value = quantity.and_then(|known| Some(measured(known, sample.value?, None)));
            object([
                ("at", sample.at.into()),
                ("state", name(&sample.state).into()),
                ("quantity", value.into()),
            ])
        };
        let crossings =
            self.found.crossings.iter().map(|crossing| {
                object([("from", end(&crossing.lower)), ("to", end(&crossing.upper))])
            });
        let segments = self.found.segments.iter().map(|segment| {
            let refusal = match &segment.state {
                State::Unknown(problem) => Some(reason(problem)),
                _ => None,
            };
            object([
                ("from", segment.from.into()),
                ("to", segment.to.into()),
                ("state", name(&segment.state).into()),
                ("refusal", refusal.into()),
            ])
        });
        let line = object([
            ("case", self.name.into()),
            ("title", self.title.into()),
            ("version", env!("CARGO_PKG_VERSION").into()),
            ("method", self.method.into()),
            ("vary", self.key().into()),
            ("unit", if unit.is_empty() { "1" } else { unit }.into()),
            ("from", self.range.from.into()),
            ("to", self.range.to.into()),
            ("until", self.condition.text.as_str().into()),
            ("answer", self.answer().into()),
            ("crossings", crossings.collect()),
            ("segments", segments.collect()),
            ("solves", self.found.solves.into()),
        ]);
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
