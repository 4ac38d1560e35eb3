//! The tip relief to specify as text, JSON or CSV.

use std::io::{self, Write};

use serde::Serialize;

use super::json::write_line;
use super::layout::{item, widest};
use crate::case::sanitize::sanitize;
use crate::model::inputs::ReliefShape;
use crate::study::relief::{Choice, MapPoint, Specification, TipReliefs};

/// A relief to specify with the name of its case.
#[derive(Clone, Copy)]
pub struct ReliefReport<'a> {
    /// The case's name, as the user gave it.
    pub name: &'a str,
    /// The case's title.
    pub title: &'a str,
    /// The name of the method of the case.
    pub method: &'a str,
    /// The answer.
    pub found: &'a Specification,
}

impl ReliefReport<'_> {
    /// Writes the answer for a person.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write(&self, out: &mut dyn Write) -> io::Result<()> {
        let title = if self.title.is_empty() {
            self.name
        } else {
            self.title
        };
        writeln!(out, "{}", sanitize(title))?;
        for line in self.lines() {
            writeln!(out, "{line}")?;
        }
        Ok(())
    }

    /// The answer in lines of at most 80 columns, without the title.
    #[must_use]
    pub fn lines(&self) -> Vec<String> {
        let found = self.found;
        let mut lines = self.demand();
        lines.push(String::new());
        lines.extend(self.answer());
        lines.push(String::new());
        lines.extend(item("", &self.margin()));
        lines.extend(item("", &self.contact_ratio()));
        if found.is_cut {
            lines.extend(item(
                "",
                "The search ended with its budget; a better relief may exist.",
            ));
        }
        lines.push(String::new());
        lines.push("Choices, with the transmission error peak to peak over the loads".to_owned());
        lines.extend(choices(found));
        lines.push(String::new());
        lines.push("Transmission error peak to peak over the load, um (Harris map)".to_owned());
        lines.extend(harris(found));
        lines.push(String::new());
        lines.extend(item(
            "",
            "Greatest transmission error over the loads by length and amount of the relief, um; \
             - corner contact at the greatest load, * the relief to specify",
        ));
        lines.extend(map(found));
        lines
    }

    fn demand(&self) -> Vec<String> {
        let found = self.found;
        let (from, to) = found.demand.loads;
        let words = format!(
            "Tip relief for {} to {} % of {} N m, tolerance {} um on each relief; method {} decides{}.",
            percent(from),
            percent(to),
            tidy(found.torque, 4),
            tidy(found.demand.tolerance * 1e6, 3),
            found.method.name(),
            if found.method.name() == self.method {
                String::new()
            } else {
                format!(", {}", self.reason())
            }
        );
        item("", &words)
    }

    /// Why another method than that of the case decides.
    fn reason(&self) -> String {
        if self.method == "auto" {
            "chosen by auto".to_owned()
        } else {
            format!("since method {} shares no load", self.method)
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
        format!(
            "No corner contact at {} % of the load with each relief off by the tolerance: a gap of {} um \
             remains, and the load can rise to {} %.",
            percent(found.demand.loads.1),
            tidy(chosen.margin * 1e6, 2),
            percent(found.greatest_load)
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

    /// Writes the answer as one JSON object on one line.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_json(&self, out: &mut dyn Write) -> io::Result<()> {
        let found = self.found;
        let line = Line {
            case: self.name,
            title: self.title,
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

    /// Writes the map over amount and length as CSV in SI units, the choices first.
    ///
    /// # Errors
    /// Those of the writer.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        let mut rows = csv::Writer::from_writer(out);
        rows.write_record([
            "choice",
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
            let name = if at == found.best {
                format!("{} (best)", choice.name)
            } else {
                choice.name.to_owned()
            };
            let error = choice.greatest_error();
            rows.write_record(record(&name, &choice.reliefs, error, choice.margin))?;
        }
        for point in found.map.iter().flatten() {
            rows.write_record(record("map", &point.reliefs, point.error, point.margin))?;
        }
        rows.flush()
    }
}

fn record(name: &str, reliefs: &TipReliefs, error: f64, margin: f64) -> [String; 8] {
    let [driver, driven] = reliefs.amounts;
    let [driver_length, driven_length] = reliefs.lengths;
    let numbers = [driver, driver_length, driven, driven_length, error, margin];
    let [a, b, c, d, e, f] = numbers.map(|number| number.to_string());
    [
        name.to_owned(),
        shape(reliefs.shape).to_owned(),
        a,
        b,
        c,
        d,
        e,
        f,
    ]
}

/// A row per choice.
fn choices(found: &Specification) -> Vec<String> {
    let head = [
        "  um, lengths in mm",
        "C_a1",
        "L_1",
        "C_a2",
        "L_2",
        "max",
        "mean",
        "gap",
    ];
    let rows = found.choices.iter().enumerate().map(|(at, choice)| {
        let Choice { reliefs, .. } = choice;
        let mark = if at == found.best { "* " } else { "  " };
        let length = |at: usize| {
            if reliefs.amounts[at] > 0.0 {
                mm(reliefs.lengths[at])
            } else {
                "-".to_owned()
            }
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
    table(
        &std::iter::once(head.to_vec())
            .chain(rows.map(|row| row.to_vec()))
            .collect::<Vec<_>>(),
    )
}

/// A row per load: the case as it is, and the relief to specify.
fn harris(found: &Specification) -> Vec<String> {
    let chosen = found.chosen();
    let cells = |name: &str, values: Vec<String>| {
        std::iter::once(format!("  {name}"))
            .chain(values)
            .collect::<Vec<_>>()
    };
    let errors = |choice: &Choice| {
        let errors = choice.errors.iter();
        errors.map(|error| tidy(error * 1e6, 3)).collect::<Vec<_>>()
    };
    let loads = found
        .loads
        .iter()
        .map(|&load| format!("{} %", percent(load)));
    table(&[
        cells("load", loads.collect()),
        cells("as the case has it", errors(&found.choices[0])),
        cells("relief to specify", errors(chosen)),
    ])
}

/// A row per length: the greatest error by amount.
fn map(found: &Specification) -> Vec<String> {
    let chosen = found.chosen().reliefs;
    let pair = |values: [String; 2]| {
        if values[0] == values[1] {
            values[0].clone()
        } else {
            values.join("/")
        }
    };
    let is_chosen = |point: &MapPoint| {
        let same = |one: f64, other: f64| (one - other).abs() < 1e-9;
        same(point.reliefs.amounts[0], chosen.amounts[0])
            && same(point.reliefs.lengths[0], chosen.lengths[0])
    };
    let cell = |point: &MapPoint| {
        let error = if point.margin < 0.0 {
            "-".to_owned()
        } else {
            tidy(point.error * 1e6, 2)
        };
        if is_chosen(point) {
            format!("*{error}")
        } else {
            error
        }
    };
    let head = found.map.first().into_iter().flatten();
    let head = head.map(|point| pair(point.reliefs.amounts.map(um)));
    let head: Vec<String> = std::iter::once("  mm \\ um".to_owned())
        .chain(head)
        .collect();
    let rows = found.map.iter().map(|row| {
        let length = row.first().map(|point| pair(point.reliefs.lengths.map(mm)));
        let length = format!("  {}", length.unwrap_or_default());
        std::iter::once(length)
            .chain(row.iter().map(cell))
            .collect()
    });
    table(
        &std::iter::once(head)
            .chain(rows)
            .collect::<Vec<Vec<String>>>(),
    )
}

/// The first column to the left, the others to the right.
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
            if at == 0 {
                format!("{text:width$}")
            } else {
                format!(" {text:>width$}")
            }
        });
        cells.collect::<String>().trim_end().to_owned()
    };
    rows.iter().map(line).collect()
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

fn tidy(value: f64, digits: usize) -> String {
    crate::model::explanation::tidy(value, digits)
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
    greatest_load: f64,
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
        Reliefs {
            shape: shape(reliefs.shape),
            driver: one(0),
            driven: one(1),
        }
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
