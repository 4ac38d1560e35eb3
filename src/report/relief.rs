//! The tip relief to specify as text, JSON or CSV.

use super::json::{Json, json};
use super::layout::{WIDTH, item};
use super::results::{Named, Results};
use super::table::{Cell, Column, Table};
use crate::model::explanation::tidy;
use crate::model::inputs::{Method, ReliefShape};
use crate::study::relief::{Choice, MOST_LOAD, MapPoint, Specification, TipReliefs};

/// A relief to specify with the name of its case.
#[derive(Clone, Copy)]
pub struct ReliefReport<'a> {
    /// The method of the case.
    pub method: Method,
    /// The specification.
    pub found: &'a Specification,
}

impl ReliefReport<'_> {
    /// The specification without the title: rows of tables of at most 80 columns, and unwrapped
    /// sentences.
    pub fn without_title(&self) -> Vec<String> {
        let found = self.found;
        let mut lines = vec![self.demand(), String::new()];
        lines.extend(self.answer());
        lines.extend([String::new(), self.margin()]);
        let ratio = found.unloaded_contact_ratio;
        let below = ", below 1: under light load the pairs change on the reliefs";
        let below = if ratio < 1.0 { below } else { "" };
        lines.push(format!(
            "The unrelieved flanks alone have a contact ratio of {ratio:.3}{below}."
        ));
        if found.is_cut {
            lines.push("The search ended with its budget; a better relief may exist.".to_owned());
        }
        for (title, table) in [
            (
                "Choices: amounts C_a, gap and transmission error TE in um, lengths L in mm; TE peak to \
                 peak, its maximum and mean over the loads",
                choices(found),
            ),
            ("Transmission error peak to peak over the load, um (Harris map)", harris(found)),
            (
                "Greatest transmission error over the loads by length and amount of the relief, um; \
                 - corner contact at the greatest load, * the relief to specify",
                map(found),
            ),
        ] {
            lines.extend([String::new(), title.to_owned()]);
            lines.extend(table.lines());
        }
        lines
    }

    fn demand(&self) -> String {
        let Specification { demand, torque, method, .. } = self.found;
        let (from, to) = (percent(demand.loads.0), percent(demand.loads.1));
        let loads =
            if demand.loads.0 < demand.loads.1 { format!("{from} to {to} %") } else { to + " %" };
        // Why the method is not that of the case.
        let reason = match self.method {
            own if own == *method => String::new(),
            Method::Auto => ", chosen by auto".to_owned(),
            own => {
                let own = own.name();
                format!(", because method {own} does not share the load among pairs")
            }
        };
        let (torque, tolerance) = (tidy(*torque, 4), tidy(demand.tolerance * 1e6, 3));
        format!(
            "Tip relief for {loads} of {torque} N m, tolerance {tolerance} um on each relief; \
             computed by method {}{reason}.",
            method.name()
        )
    }

    /// The relief in two lines.
    pub fn answer(&self) -> Vec<String> {
        let TipReliefs { shape, amounts, lengths } = self.found.chosen().reliefs;
        let line = |(at, gear): (usize, &str)| {
            let (amount, length, shape) = (um(amounts[at]), mm(lengths[at]), name(shape));
            format!(
                "  {gear}  {amount:>5} um over {length:>5} mm along the path of contact, {shape}"
            )
        };
        ["driver", "driven"].into_iter().enumerate().map(line).collect()
    }

    fn margin(&self) -> String {
        let greatest = self.found.demand.loads.1;
        let rest = match self.found.greatest_load {
            Some(load) => {
                let load = (1e3 * load).floor() / 1e3;
                format!("the load can rise to {} %", percent(load))
            }
            None => {
                format!("no load up to {} % causes corner contact", percent(MOST_LOAD * greatest))
            }
        };
        format!(
            "No corner contact at {} % of the load with each relief off by the tolerance: a gap of {} um \
             remains; at rest, {rest}.",
            percent(greatest),
            tidy(self.found.chosen().margin * 1e6, 2),
        )
    }
}

impl Results for ReliefReport<'_> {
    fn lines(&self, case: Named) -> Vec<String> {
        // Rows of tables fit; only sentences are wrapped.
        let is_short = |line: &String| line.chars().count() <= WIDTH;
        let lines = self.without_title().into_iter();
        let lines =
            lines.flat_map(|line| if is_short(&line) { vec![line] } else { item("", &line) });
        std::iter::once(case.heading()).chain(lines).collect()
    }

    fn json(&self) -> Json {
        let found = self.found;
        let choice = |Choice { name, reliefs, errors, margin }: &Choice| {
            json!({
                "name": name,
                "relief": relief(reliefs),
                "transmission_errors": errors,
                "margin": margin,
            })
        };
        let point = |MapPoint { reliefs, error, margin }: &MapPoint| json!({"relief": relief(reliefs), "transmission_error": error, "margin": margin});
        json!({
            "method": found.method.name(),
            "torque": found.torque,
            "loads": found.loads,
            "tolerance": found.demand.tolerance,
            "relief": relief(&found.chosen().reliefs),
            "margin": found.chosen().margin,
            "greatest_load": found.greatest_load,
            "unloaded_contact_ratio": found.unloaded_contact_ratio,
            "choices": found.choices.iter().map(choice).collect::<Json>(),
            "map": found.map.iter().flatten().map(point).collect::<Json>(),
            "tries": found.tries,
            "is_complete": !found.is_cut,
        })
    }

    /// The choices, then the map over amount and length.
    fn table(&self) -> Table {
        let texts = ["choice", "best", "shape"].map(|key| Column::text(key, ""));
        let [amounts, lengths] = KEYS;
        let keys = [amounts[0], lengths[0], amounts[1], lengths[1], "transmission_error", "margin"];
        let lengths = keys.map(|key| Column::si(key, "m"));
        let row = |name: &str, best: &str, reliefs: &TipReliefs, error: f64, margin: f64| {
            let TipReliefs { shape, amounts, lengths } = *reliefs;
            let numbers = [amounts[0], lengths[0], amounts[1], lengths[1], error, margin];
            let texts = [name, best, self::name(shape)].map(Cell::from);
            texts.into_iter().chain(numbers.map(|number| number.to_string().into())).collect()
        };
        let choices = self.found.choices.iter().enumerate().map(|(at, choice)| {
            let best = if at == self.found.best { "true" } else { "false" };
            row(choice.name, best, &choice.reliefs, choice.greatest_error(), choice.margin)
        });
        let map = self.found.map.iter().flatten();
        let map = map.map(|point| row("map", "", &point.reliefs, point.error, point.margin));
        Table::new("", texts.into_iter().chain(lengths).collect()).with(choices.chain(map))
    }
}

/// The keys of the amounts and of the lengths of both gears.
const KEYS: [[&str; 2]; 2] = [
    ["driver.tip_relief", "driven.tip_relief"],
    ["driver.tip_relief_length", "driven.tip_relief_length"],
];

fn relief(TipReliefs { shape, amounts, lengths }: &TipReliefs) -> Json {
    let gear = |at: usize| json!({"tip_relief": amounts[at], "tip_relief_length": lengths[at]});
    json!({"shape": name(*shape), "driver": gear(0), "driven": gear(1)})
}

/// The reliefs as values of the fields of a case, rounded as the report prints them.
pub fn settings(reliefs: &TipReliefs) -> Vec<(&'static str, String)> {
    let [amounts, lengths] = KEYS;
    let mut settings = vec![("model.relief_shape", name(reliefs.shape).to_owned())];
    for at in 0..2 {
        let has_relief = reliefs.amounts[at] > 0.0;
        let in_mm = format!("{} mm", mm(reliefs.lengths[at]));
        settings.push((amounts[at], format!("{} um", um(reliefs.amounts[at]))));
        settings.push((lengths[at], if has_relief { in_mm } else { String::new() }));
    }
    settings
}

/// One row per choice.
fn choices(found: &Specification) -> Table {
    let head = ["  choice", "C_a1", "L_1", "C_a2", "L_2", "max TE", "mean TE", "gap"];
    let rows = found.choices.iter().enumerate().map(|(at, choice)| {
        let mark = if at == found.best { '*' } else { ' ' };
        let TipReliefs { amounts, lengths, .. } = choice.reliefs;
        let length = |at: usize| if amounts[at] > 0.0 { mm(lengths[at]) } else { "-".to_owned() };
        let errors = [choice.greatest_error(), choice.mean_error()];
        let [greatest, mean] = errors.map(|error| tidy(error * 1e6, 3));
        let name = format!("{mark} {}", choice.name);
        let gap = tidy(choice.margin * 1e6, 2);
        let [driver, driven] = amounts.map(um);
        vec![name, driver, length(0), driven, length(1), greatest, mean, gap]
    });
    Table::of_texts(head.map(str::to_owned).to_vec(), rows)
}

/// One row per load: the relief of the case and the relief to specify.
fn harris(found: &Specification) -> Table {
    let errors = |name: &str, choice: &Choice| {
        let errors = choice.errors.iter().map(|error| tidy(error * 1e6, 3));
        std::iter::once(format!("  {name}")).chain(errors).collect()
    };
    let loads = found.loads.iter().map(|&load| format!("{} %", percent(load)));
    let rows = [
        errors("relief of the case", &found.choices[0]),
        errors("relief to specify", found.chosen()),
    ];
    Table::of_texts(std::iter::once("  load".to_owned()).chain(loads).collect(), rows)
}

/// One row per length: the greatest transmission error by amount.
fn map(found: &Specification) -> Table {
    let chosen = found.chosen().reliefs;
    let cell = |point: &MapPoint| {
        let same = |one: [f64; 2], other: [f64; 2]| (one[0] - other[0]).abs() < 1e-9;
        let is_chosen = same(point.reliefs.amounts, chosen.amounts)
            && same(point.reliefs.lengths, chosen.lengths);
        let error = if point.margin < 0.0 { "-".to_owned() } else { tidy(point.error * 1e6, 2) };
        if is_chosen { format!("*{error}") } else { error }
    };
    // The amounts in one row, or in one per gear.
    let points = found.map.first().map_or(&[][..], Vec::as_slice);
    let head = |name: &str, at: usize| {
        let amounts = points.iter().map(|point| um(point.reliefs.amounts[at]));
        std::iter::once(format!("  amount{name}, um")).chain(amounts).collect::<Vec<_>>()
    };
    let [both, driver, driven] =
        [("", 0), (" driver", 0), (" driven", 1)].map(|(name, at)| head(name, at));
    let is_alike = driver[1..] == driven[1..];
    let (first, second) = if is_alike { (both, None) } else { (driver, Some(driven)) };
    let rows = found.map.iter().map(|row| {
        let length = row.first().map(|point| length(point.reliefs.lengths));
        std::iter::once(length.unwrap_or_default()).chain(row.iter().map(cell)).collect()
    });
    Table::of_texts(first, second.into_iter().chain(rows))
}

fn length(lengths: [f64; 2]) -> String {
    let [driver, driven] = lengths.map(mm);
    if driver == driven {
        format!("  length {driver} mm")
    } else {
        format!("  length {driver}/{driven} mm")
    }
}

fn name(shape: ReliefShape) -> &'static str {
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
