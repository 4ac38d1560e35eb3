//! The tip relief to specify as text, JSON or CSV.

use std::io::{self, Write};

use super::layout::{WIDTH, item};
use crate::case::sanitize::sanitize;
use crate::model::explanation::tidy;
use crate::model::inputs::{Method, ReliefShape};
use crate::report::data::write_line;
use crate::report::layout::widest;
use crate::study::relief::{Choice, MOST_LOAD, MapPoint, Specification, TipReliefs};
use serde::Serialize;

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
        line(self.name, self.title, self.found, out)
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

/// One row per choice.
fn choices(found: &Specification) -> Vec<String> {
    let head = ["  choice", "C_a1", "L_1", "C_a2", "L_2", "max TE", "mean TE", "gap"];
    let rows = found.choices.iter().enumerate().map(|(at, choice)| {
        let Choice { reliefs, .. } = choice;
        let mark = if at == found.best { "* " } else { "  " };
        let length = |at: usize| {
            if reliefs.amounts[at] > 0.0 { mm(reliefs.lengths[at]) } else { "-".to_owned() }
        };
        [
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
    let head = head.map(str::to_owned);
    table(&std::iter::once(head.to_vec()).chain(rows.map(|row| row.to_vec())).collect::<Vec<_>>())
}

/// One row per load: the relief of the case and the relief to specify.
fn harris(found: &Specification) -> Vec<String> {
    let chosen = found.chosen();
    let cells = |name: &str, values: Vec<String>| {
        std::iter::once(format!("  {name}")).chain(values).collect::<Vec<_>>()
    };
    let errors = |choice: &Choice| {
        let errors = choice.errors.iter();
        errors.map(|error| tidy(error * 1e6, 3)).collect::<Vec<_>>()
    };
    let loads = found.loads.iter().map(|&load| format!("{} %", percent(load)));
    table(&[
        cells("load", loads.collect()),
        cells("relief of the case", errors(&found.choices[0])),
        cells("relief to specify", errors(chosen)),
    ])
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
    let mut rows = amounts(found.map.first().map_or(&[], Vec::as_slice));
    rows.extend(found.map.iter().map(|row| {
        let length = row.first().map(|point| length(point.reliefs.lengths));
        std::iter::once(length.unwrap_or_default()).chain(row.iter().map(cell)).collect()
    }));
    table(&rows)
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

/// Aligns the first column to the left and the others to the right.
fn table(rows: &[Vec<String>]) -> Vec<String> {
    let columns = rows.iter().map(Vec::len).max().unwrap_or(0);
    let cell = |row: &Vec<String>, at: usize| row.get(at).cloned().unwrap_or_default();
    let widths: Vec<usize> = (0..columns)
        .map(|at| {
            let cells: Vec<String> = rows.iter().map(|row| cell(row, at)).collect();
            widest(cells.iter().map(String::as_str))
        })
        .collect();
    let line = |row: &Vec<String>| {
        let cells = (0..columns).map(|at| {
            let (text, width) = (cell(row, at), widths[at]);
            if at == 0 { format!("{text:width$}") } else { format!(" {text:>width$}") }
        });
        cells.collect::<String>().trim_end().to_owned()
    };
    rows.iter().map(line).collect()
}

/// Writes the specification on one line.
///
/// # Errors
/// Errors of the writer.
fn line(name: &str, title: &str, found: &Specification, out: &mut dyn Write) -> io::Result<()> {
    let line = Line {
        case: name,
        title,
        version: env!("CARGO_PKG_VERSION"),
        method: found.method.name(),
        torque: found.torque,
        loads: &found.loads,
        tolerance: found.demand.tolerance,
        relief: Reliefs::of(&found.chosen().reliefs),
        margin: found.chosen().margin,
        greatest_load: found.greatest_load,
        unloaded_contact_ratio: found.unloaded_contact_ratio,
        choices: found.choices.iter().map(JsonChoice::of).collect(),
        map: found.map.iter().flatten().map(JsonPoint::of).collect(),
        tries: found.tries,
        is_complete: !found.is_cut,
    };
    write_line(&line, out)
}

#[derive(Serialize)]
struct Line<'a> {
    case: &'a str,
    title: &'a str,
    version: &'static str,
    method: &'a str,
    torque: f64,
    loads: &'a [f64],
    tolerance: f64,
    relief: Reliefs,
    margin: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    greatest_load: Option<f64>,
    unloaded_contact_ratio: f64,
    choices: Vec<JsonChoice<'a>>,
    map: Vec<JsonPoint>,
    tries: u64,
    is_complete: bool,
}

#[derive(Serialize)]
struct Reliefs {
    shape: &'static str,
    driver: OneRelief,
    driven: OneRelief,
}

#[derive(Serialize)]
struct OneRelief {
    tip_relief: f64,
    tip_relief_length: f64,
}

impl Reliefs {
    fn of(reliefs: &TipReliefs) -> Reliefs {
        let one = |at: usize| OneRelief {
            tip_relief: reliefs.amounts[at],
            tip_relief_length: reliefs.lengths[at],
        };
        Reliefs { shape: shape(reliefs.shape), driver: one(0), driven: one(1) }
    }
}

#[derive(Serialize)]
struct JsonChoice<'a> {
    name: &'a str,
    relief: Reliefs,
    transmission_errors: &'a [f64],
    margin: f64,
}

impl JsonChoice<'_> {
    fn of(choice: &Choice) -> JsonChoice<'_> {
        JsonChoice {
            name: choice.name,
            relief: Reliefs::of(&choice.reliefs),
            transmission_errors: &choice.errors,
            margin: choice.margin,
        }
    }
}

#[derive(Serialize)]
struct JsonPoint {
    relief: Reliefs,
    transmission_error: f64,
    margin: f64,
}

impl JsonPoint {
    fn of(point: &MapPoint) -> JsonPoint {
        JsonPoint {
            relief: Reliefs::of(&point.reliefs),
            transmission_error: point.error,
            margin: point.margin,
        }
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
