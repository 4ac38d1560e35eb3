//! The tip relief to specify as text, JSON or CSV.

mod json;
mod numbers;
mod tables;

use std::io::{self, Write};

use super::layout::{WIDTH, item};
use crate::case::sanitize::sanitize;
use crate::model::explanation::tidy;
use crate::model::inputs::Method;
use crate::study::relief::{MOST_LOAD, Specification, TipReliefs};
use numbers::{mm, percent, shape, um};
use tables::{choices, harris, map};

/// A relief to specify with the name of its case.
#[derive(Clone, Copy)]
pub struct ReliefReport<'a> {
    /// The name of the case, as the user gave it.
    pub name: &'a str,
    /// The title of the case.
    pub title: &'a str,
    /// The method of the case.
    pub method: Method,
    /// The specification.
    pub found: &'a Specification,
}

impl ReliefReport<'_> {
    /// Writes the specification as text.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let title = if self.title.is_empty() { self.name } else { self.title };
        writeln!(out, "{}", sanitize(title))?;
        for line in self.lines() {
            // Rows of tables fit; only sentences are wrapped.
            let is_short = line.chars().count() <= WIDTH;
            let parts = if is_short { vec![line] } else { item("", &line) };
            for part in parts {
                writeln!(out, "{part}")?;
            }
        }
        Ok(())
    }

    /// The specification without the title: rows of tables of at most 80 columns, and unwrapped
    /// sentences.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
        let found = self.found;
        let mut lines = vec![self.demand()];
        lines.push(String::new());
        lines.extend(self.answer());
        lines.push(String::new());
        lines.push(self.margin());
        lines.push(self.contact_ratio());
        if found.is_cut {
            lines.push("The search ended with its budget; a better relief may exist.".to_owned());
        }
        lines.push(String::new());
        lines.push(
            "Choices: amounts C_a, gap and transmission error TE in um, lengths L in mm; TE peak to \
             peak, its maximum and mean over the loads"
                .to_owned(),
        );
        lines.extend(choices(found));
        lines.push(String::new());
        lines.push("Transmission error peak to peak over the load, um (Harris map)".to_owned());
        lines.extend(harris(found));
        lines.push(String::new());
        lines.push(
            "Greatest transmission error over the loads by length and amount of the relief, um; \
             - corner contact at the greatest load, * the relief to specify"
                .to_owned(),
        );
        lines.extend(map(found));
        lines
    }

    fn demand(&self) -> String {
        let found = self.found;
        format!(
            "Tip relief for {} of {} N m, tolerance {} um on each relief; computed by method {}{}.",
            self.loads(),
            tidy(found.torque, 4),
            tidy(found.demand.tolerance * 1e6, 3),
            found.method.name(),
            if found.method == self.method {
                String::new()
            } else {
                format!(", {}", self.reason())
            }
        )
    }

    fn loads(&self) -> String {
        let (from, to) = self.found.demand.loads;
        if from < to {
            format!("{} to {} %", percent(from), percent(to))
        } else {
            format!("{} %", percent(to))
        }
    }

    /// Why the relief is computed by a method other than that of the case.
    fn reason(&self) -> String {
        match self.method {
            Method::Auto => "chosen by auto".to_owned(),
            method => {
                format!("because method {} does not share the load among pairs", method.name())
            }
        }
    }

    /// The relief in two lines.
    #[must_use]
    pub fn answer(&self) -> Vec<String> {
        let reliefs = &self.found.chosen().reliefs;
        let line = |gear: &str, at: usize| {
            format!(
                "  {gear}  {:>5} um over {:>5} mm along the path of contact, {}",
                um(reliefs.amounts[at]),
                mm(reliefs.lengths[at]),
                shape(reliefs.shape)
            )
        };
        vec![line("driver", 0), line("driven", 1)]
    }

    fn margin(&self) -> String {
        let (found, chosen) = (self.found, self.found.chosen());
        let greatest = found.demand.loads.1;
        let rest = match found.greatest_load {
            Some(load) => {
                let load = (1e3 * load).floor() / 1e3;
                format!("at rest, the load can rise to {} %", percent(load))
            }
            None => format!(
                "at rest, no load up to {} % causes corner contact",
                percent(MOST_LOAD * greatest)
            ),
        };
        format!(
            "No corner contact at {} % of the load with each relief off by the tolerance: a gap of {} um \
             remains; {rest}.",
            percent(greatest),
            tidy(chosen.margin * 1e6, 2),
        )
    }

    fn contact_ratio(&self) -> String {
        let ratio = self.found.unloaded_contact_ratio;
        let flanks = format!("The unrelieved flanks alone have a contact ratio of {ratio:.3}");
        if ratio < 1.0 {
            format!("{flanks}, below 1: under light load the pairs change on the reliefs.")
        } else {
            format!("{flanks}.")
        }
    }

    /// Writes the specification as one JSON object on one line.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_json(&self, out: &mut dyn Write) -> io::Result<()> {
        json::line(self.name, self.title, self.found, out)
    }

    /// Writes the choices and then the map over amount and length as CSV in SI units.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut rows = csv::Writer::from_writer(out);
        rows.write_record([
            "choice",
            "best",
            "shape",
            "driver.tip_relief [m]",
            "driver.tip_relief_length [m]",
            "driven.tip_relief [m]",
            "driven.tip_relief_length [m]",
            "transmission_error [m]",
            "margin [m]",
        ])?;
        let found = self.found;
        for (at, choice) in found.choices.iter().enumerate() {
            let name = (choice.name, if at == found.best { "true" } else { "false" });
            let error = choice.greatest_error();
            rows.write_record(record(name, &choice.reliefs, error, choice.margin))?;
        }
        for point in found.map.iter().flatten() {
            let name = ("map", "");
            rows.write_record(record(name, &point.reliefs, point.error, point.margin))?;
        }
        rows.flush()
    }
}

/// The reliefs as values of the fields of a case, rounded as the report prints them.
#[must_use]
pub fn settings(reliefs: &TipReliefs) -> Vec<(&'static str, String)> {
    const KEYS: [[&str; 2]; 2] = [
        ["driver.tip_relief", "driver.tip_relief_length"],
        ["driven.tip_relief", "driven.tip_relief_length"],
    ];
    let shape = shape(reliefs.shape).to_owned();
    let mut settings = vec![("model.relief_shape", shape)];
    for (at, [amount, length]) in KEYS.into_iter().enumerate() {
        let has_relief = reliefs.amounts[at] > 0.0;
        let in_mm = format!("{} mm", mm(reliefs.lengths[at]));
        settings.push((amount, format!("{} um", um(reliefs.amounts[at]))));
        settings.push((length, if has_relief { in_mm } else { String::new() }));
    }
    settings
}

fn record(
    (name, is_best): (&str, &str),
    reliefs: &TipReliefs,
    error: f64,
    margin: f64,
) -> [String; 9] {
    let [driver, driven] = reliefs.amounts;
    let [driver_length, driven_length] = reliefs.lengths;
    let numbers = [driver, driver_length, driven, driven_length, error, margin];
    let [a, b, c, d, e, f] = numbers.map(|number| number.to_string());
    [name.to_owned(), is_best.to_owned(), shape(reliefs.shape).to_owned(), a, b, c, d, e, f]
}
