//! The tip relief to specify as text, JSON or CSV.

use std::io::{self, Write};

use super::json::{Json, object, write_line};
use super::layout::{WIDTH, item};
use super::table::{Cell, Column, Table};
use crate::case::sanitize::sanitize;
use crate::model::explanation::tidy;
use crate::model::inputs::{Method, ReliefShape};
use crate::study::relief::{Choice, MOST_LOAD, MapPoint, Specification, TipReliefs};

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
            let line = if is_short { line } else { item("", &line).join("\n") };
            writeln!(out, "{line}")?;
        }
        Ok(())
    }

    /// The specification without the title: rows of tables of at most 80 columns, and unwrapped
    /// sentences.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
        let found = self.found;
        let head = |lines: &[&str]| lines.iter().map(|line| (*line).to_owned()).collect();
        let is_cut = "The search ended with its budget; a better relief may exist.".to_owned();
        [
            vec![self.demand(), String::new()],
            self.answer(),
            vec![String::new(), self.margin(), self.contact_ratio()],
            Some(is_cut).filter(|_| found.is_cut).into_iter().collect(),
            head(&[
                "",
                "Choices: amounts C_a, gap and transmission error TE in um, lengths L in mm; TE peak to \
                 peak, its maximum and mean over the loads",
            ]),
            choices(found),
            head(&["", "Transmission error peak to peak over the load, um (Harris map)"]),
            harris(found),
            head(&[
                "",
                "Greatest transmission error over the loads by length and amount of the relief, um; \
                 - corner contact at the greatest load, * the relief to specify",
            ]),
            map(found),
        ]
        .concat()
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
        let found = self.found;
        let choice = |choice: &Choice| {
            object([
                ("name", choice.name.into()),
                ("relief", relief(&choice.reliefs)),
                ("transmission_errors", choice.errors.iter().copied().collect()),
                ("margin", choice.margin.into()),
            ])
        };
        let point = |point: &MapPoint| {
            object([
                ("relief", relief(&point.reliefs)),
                ("transmission_error", point.error.into()),
                ("margin", point.margin.into()),
            ])
        };
        let line = object([
            ("case", self.name.into()),
            ("title", self.title.into()),
            ("version", env!("CARGO_PKG_VERSION").into()),
            ("method", found.method.name().into()),
            ("torque", found.torque.into()),
            ("loads", found.loads.iter().copied().collect()),
            ("tolerance", found.demand.tolerance.into()),
            ("relief", relief(&found.chosen().reliefs)),
            ("margin", found.chosen().margin.into()),
            ("greatest_load", found.greatest_load.into()),
            ("unloaded_contact_ratio", found.unloaded_contact_ratio.into()),
            ("choices", found.choices.iter().map(choice).collect()),
            ("map", found.map.iter().flatten().map(point).collect()),
            ("tries", found.tries.into()),
            ("is_complete", (!found.is_cut).into()),
        ]);
        write_line(&line, out)
    }

    /// Writes the choices and then the map over amount and length as CSV in SI units.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let texts = ["choice", "best", "shape"].map(|key| Column::text(key, ""));
        let lengths = [
            "driver.tip_relief",
            "driver.tip_relief_length",
            "driven.tip_relief",
            "driven.tip_relief_length",
            "transmission_error",
            "margin",
        ];
        let lengths = lengths.map(|key| Column::number(key, "", "m", ("1", 0)));
        let row = |name: &str, best: &str, reliefs: &TipReliefs, error: f64, margin: f64| {
            let texts = [name, best, shape(reliefs.shape)].map(Cell::from);
            let ([driver, driven], lengths) = (reliefs.amounts, reliefs.lengths);
            let numbers = [driver, lengths[0], driven, lengths[1], error, margin];
            [texts.to_vec(), numbers.map(|number| number.to_string().into()).to_vec()].concat()
        };
        let choices = self.found.choices.iter().enumerate().map(|(at, choice)| {
            let best = if at == self.found.best { "true" } else { "false" };
            row(choice.name, best, &choice.reliefs, choice.greatest_error(), choice.margin)
        });
        let map = self.found.map.iter().flatten();
        let map = map.map(|point| row("map", "", &point.reliefs, point.error, point.margin));
        Table::new("", texts.into_iter().chain(lengths).collect())
            .with(choices.chain(map))
            .write_csv(out)
    }
}

fn relief(reliefs: &TipReliefs) -> Json {
    let gear = |at: usize| {
        object([
            ("tip_relief", reliefs.amounts[at].into()),
            ("tip_relief_length", reliefs.lengths[at].into()),
        ])
    };
    object([("shape", shape(reliefs.shape).into()), ("driver", gear(0)), ("driven", gear(1))])
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

/// One row per choice.
fn choices(found: &Specification) -> Vec<String> {
    let head = ["  choice", "C_a1", "L_1", "C_a2", "L_2", "max TE", "mean TE", "gap"];
    let rows = found.choices.iter().enumerate().map(|(at, choice)| {
        let Choice { reliefs, .. } = choice;
        let mark = if at == found.best { "* " } else { "  " };
        let length = |at: usize| {
            if reliefs.amounts[at] > 0.0 { mm(reliefs.lengths[at]) } else { "-".to_owned() }
        };
        vec![
            format!("{mark}{}", choice.name),
            um(reliefs.amounts[0]),
            length(0),
            um(reliefs.amounts[1]),
            length(1),
            tidy(choice.greatest_error() * 1e6, 3),
            tidy(choice.mean_error() * 1e6, 3),
            tidy(choice.margin * 1e6, 2),
        ]
    });
    Table::of_texts(head.map(str::to_owned).to_vec(), rows).lines()
}

/// One row per load: the relief of the case and the relief to specify.
fn harris(found: &Specification) -> Vec<String> {
    let row = |name: &str, values: &mut dyn Iterator<Item = String>| {
        std::iter::once(format!("  {name}")).chain(values).collect::<Vec<_>>()
    };
    let errors = |name, choice: &Choice| {
        row(name, &mut choice.errors.iter().map(|error| tidy(error * 1e6, 3)))
    };
    let loads = row("load", &mut found.loads.iter().map(|&load| format!("{} %", percent(load))));
    let rows = [
        errors("relief of the case", &found.choices[0]),
        errors("relief to specify", found.chosen()),
    ];
    Table::of_texts(loads, rows).lines()
}

/// One row per length: the greatest transmission error by amount.
fn map(found: &Specification) -> Vec<String> {
    let chosen = found.chosen().reliefs;
    let is_chosen = |point: &MapPoint| {
        let same = |one: f64, other: f64| (one - other).abs() < 1e-9;
        same(point.reliefs.amounts[0], chosen.amounts[0])
            && same(point.reliefs.lengths[0], chosen.lengths[0])
    };
    let cell = |point: &MapPoint| {
        let error = if point.margin < 0.0 { "-".to_owned() } else { tidy(point.error * 1e6, 2) };
        if is_chosen(point) { format!("*{error}") } else { error }
    };
    let mut head = amounts(found.map.first().map_or(&[], Vec::as_slice)).into_iter();
    let rows = found.map.iter().map(|row| {
        let length = row.first().map(|point| length(point.reliefs.lengths));
        std::iter::once(length.unwrap_or_default()).chain(row.iter().map(cell)).collect()
    });
    let first = head.next().unwrap_or_default();
    Table::of_texts(first, head.chain(rows)).lines()
}

/// The header rows with the amounts: one row, or one per gear.
fn amounts(points: &[MapPoint]) -> Vec<Vec<String>> {
    let row = |name: &str, at: usize| {
        let amounts = points.iter().map(|point| um(point.reliefs.amounts[at]));
        std::iter::once(format!("  amount{name}, um")).chain(amounts).collect::<Vec<_>>()
    };
    let alike = |point: &MapPoint| um(point.reliefs.amounts[0]) == um(point.reliefs.amounts[1]);
    if points.iter().all(alike) {
        vec![row("", 0)]
    } else {
        vec![row(" driver", 0), row(" driven", 1)]
    }
}

fn length(lengths: [f64; 2]) -> String {
    let [driver, driven] = lengths.map(mm);
    if driver == driven {
        format!("  length {driver} mm")
    } else {
        format!("  length {driver}/{driven} mm")
    }
}

fn shape(shape: ReliefShape) -> &'static str {
    match shape {
        ReliefShape::Linear => "linear",
        ReliefShape::Parabolic => "parabolic",
    }
}

fn um(length: f64) -> String {
    format!("{:.1}", length * 1e6)
}

fn mm(length: f64) -> String {
    format!("{:.2}", length * 1e3)
}

fn percent(part: f64) -> String {
    tidy(100.0 * part, 4)
}
