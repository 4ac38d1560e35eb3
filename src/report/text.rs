//! A solve as a page of text, 80 columns wide.

use super::absence::Absence;
use super::digest::{closed_forms, differing, relief, whine};
use super::layout::{WIDTH, flow, item, widest};
use super::stations::{Column, columns, rows};
use super::verdict::{Verdict, verdicts};
use super::{FREE_IMPACT, Group, Report, Shown, digest, groups, shown, value};
use crate::case::FIELDS;
use crate::case::fields::Absent;
use crate::case::sanitize::{one_line, sanitize};
use crate::case::units::System;
use crate::model::inputs::Method;
use crate::model::{self, Inputs, Quantity, Solution, Stage, Stages};
use std::io::{self, Write};

/// The sections of a page, in order; empty sections are omitted.
const SECTIONS: [fn(&Report) -> Vec<String>; 7] =
    [heading, outcome, inputs, quantities, notes, limits, station_table];

/// The inputs that identify the pair. Missing inputs, zeros and defaults are omitted.
const SHOWN_INPUTS: &[&str] = &[
    "driver.teeth",
    "driven.teeth",
    "pair.module",
    "pair.diametral_pitch",
    "pair.pressure_angle",
    "pair.centre_distance",
    "driver.profile_shift",
    "driven.profile_shift",
    "driver.addendum",
    "driven.addendum",
    "driver.tip_diameter",
    "driven.tip_diameter",
    "driver.dedendum",
    "driven.dedendum",
    "driver.root_diameter",
    "driven.root_diameter",
    "driver.face_width",
    "driven.face_width",
    "driver.inertia",
    "driven.inertia",
    "driver.root_relief",
    "driven.tip_relief",
    "driven.tip_chamfer",
    "deviations.base_pitch",
    "driver.base_pitch",
    "driver.grade",
    "driven.base_pitch",
    "driven.grade",
    "deviations.backlash",
    "operation.power",
    "operation.torque",
    "operation.speed",
    "model.deflection",
];

/// Writes the page.
///
/// # Errors
/// Errors of the writer.
pub fn write(report: &Report, out: &mut dyn Write) -> io::Result<()> {
    out.write_all(render(report).as_bytes())
}

/// The page.
#[must_use]
pub fn render(report: &Report) -> String {
    let sections = SECTIONS.iter().map(|section| section(report)).filter(|lines| !lines.is_empty());
    sections.map(|lines| lines.join("\n") + "\n").collect::<Vec<_>>().join("\n")
}

fn heading(report: &Report) -> Vec<String> {
    let title = if report.title().is_empty() { "Case without a title" } else { report.title() };
    let mut lines = flow(sanitize(title).split_whitespace(), WIDTH);
    lines.extend(flow(
        [sanitize(&report.name).as_str(), "·", "method", report.solution.method.name()],
        WIDTH,
    ));
    lines
}

fn outcome(report: &Report) -> Vec<String> {
    verdict(report).iter().flat_map(|sentence| item("", sentence)).collect()
}

/// The verdict in sentences.
pub(super) fn verdict(report: &Report) -> Vec<String> {
    let solution = &report.solution;
    let mut sentences = vec![digest::sentence(solution, System::Metric)];
    if report.selection.is_whole() {
        let others: Vec<Solution> = others(report);
        let others: Vec<&Solution> = others.iter().collect();
        let beside: Vec<&Solution> =
            (others.iter().copied()).filter(|other| other.method != Method::Paper).collect();
        let is_given = report.inputs.deflection.is_some();
        let others = [
            differing(solution, &beside).map(|[words, ..]| words),
            relief(solution, &beside, System::Metric).map(|[words, ..]| words),
            closed_forms(solution, &others, is_given, System::Metric),
            whine(solution).map(|[words, ..]| words),
        ];
        sentences.extend(others.into_iter().flatten().map(|words| words + "."));
    }
    sentences
}

/// Solutions of other, fast methods: the load at rest if `dynamic` governs, and the closed
/// forms.
fn others(report: &Report) -> Vec<Solution> {
    let governing = report.solution.method;
    let at_rest = (governing == Method::Dynamic).then_some(Method::Static);
    let closed_forms = [Method::Exact, Method::Paper];
    let methods = at_rest.into_iter().chain(closed_forms);
    let stages = Stages::of(Stage::Clearing).and(Stages::of(Stage::Impact));
    methods
        .filter(|&method| method != governing)
        .filter_map(|method| {
            let inputs = Inputs { method, ..report.inputs.clone() };
            model::solve(&inputs, stages).ok()
        })
        .collect()
}

fn inputs(report: &Report) -> Vec<String> {
    if !report.selection.is_whole() {
        return Vec::new();
    }
    let shown: Vec<String> =
        SHOWN_INPUTS.iter().filter_map(|key| shown_input(report, key)).collect();
    // Each input stays on one line with its unit.
    let lines = flow(shown.join(",\n").split('\n'), WIDTH);
    lines.into_iter().chain(item("Notes of the case: ", &one_line(report.text("notes")))).collect()
}

fn shown_input(report: &Report, key: &str) -> Option<String> {
    let field = FIELDS.iter().find(|field| field.key == key)?;
    let text = report.text(key);
    let number = text.split_whitespace().next()?.parse::<f64>().ok();
    let default =
        if let Absent::Default(text) = field.absent { text.parse::<f64>().ok() } else { None };
    let usual = number.is_some_and(|number| number == 0.0 || Some(number) == default);
    (!usual).then(|| format!("{} = {}", field.symbol, sanitize(text)))
}

fn quantities(report: &Report) -> Vec<String> {
    let method = report.solution.method;
    let rows: Vec<Row> =
        report.values().map(|(quantity, value)| Row::new(quantity, value, method)).collect();
    let columns = Columns::of(&rows);
    if !report.selection.is_whole() {
        let is_beside = |row: &Row| method.shares_load() && row.quantity.is_of_free_impact();
        let line =
            |row: &Row| columns.line(row) + if is_beside(row) { ", free impact" } else { "" };
        return rows.iter().map(line).chain(absent(report)).collect();
    }
    let group = |group: &'static Group| {
        let line = |quantity: &Quantity| {
            rows.iter().find(|row| row.quantity.key == quantity.key).map(|row| columns.line(row))
        };
        let lines: Vec<String> = group.quantities().filter_map(line).collect();
        let title = if group.is_beside(method) {
            format!("{FREE_IMPACT}: {}", lower(group.title))
        } else {
            group.title.to_owned()
        };
        titled(&title, lines)
    };
    groups(method).into_iter().flat_map(group).collect()
}

/// The selected quantities without a value, each with its reason.
fn absent(report: &Report) -> Vec<String> {
    let solution = &report.solution;
    let line = |quantity: &Quantity| {
        let symbol = quantity.symbol_in(solution.method);
        let start = format!("  {symbol} has no value: ");
        item(&start, &Absence::of(quantity, solution).to_string())
    };
    let selected = report.selection.quantities();
    selected.filter(|quantity| value(quantity, solution).is_none()).flat_map(line).collect()
}

fn lower(title: &str) -> String {
    let mut letters = title.chars();
    letters.next().map(|first| first.to_lowercase().chain(letters).collect()).unwrap_or_default()
}

/// A quantity and its value as text.
struct Row {
    quantity: &'static Quantity,
    symbol: &'static str,
    label: &'static str,
    shown: Shown,
}

impl Row {
    fn new(quantity: &'static Quantity, value: f64, method: Method) -> Row {
        Row {
            quantity,
            symbol: quantity.symbol_in(method),
            label: quantity.label_in(method),
            shown: shown(quantity, value),
        }
    }
}

/// Widths of the columns of a table of quantities.
struct Columns {
    symbol: usize,
    label: usize,
    number: usize,
    unit: usize,
}

impl Columns {
    fn of(rows: &[Row]) -> Columns {
        Columns {
            symbol: widest(rows.iter().map(|row| row.symbol)),
            label: widest(rows.iter().map(|row| row.label)),
            number: widest(rows.iter().map(|row| row.shown.number.as_str())),
            unit: widest(rows.iter().map(|row| row.shown.unit)),
        }
    }

    fn line(&self, row: &Row) -> String {
        let Row { quantity, symbol, label, shown } = row;
        let value = format!("{:>2$} {:3$}", shown.number, shown.unit, self.number, self.unit);
        format!(
            "  {:3$} {:4$} {value}  {}",
            symbol, label, quantity.equation, self.symbol, self.label
        )
    }
}

fn notes(report: &Report) -> Vec<String> {
    titled("Notes", report.notes.iter().flat_map(|note| item("  - ", &sanitize(&note.message))))
}

fn limits(report: &Report) -> Vec<String> {
    if !report.selection.is_whole() {
        return Vec::new();
    }
    let mark = |verdict: &Verdict| format!("  {:10}", verdict.standing.word());
    let verdicts = verdicts(&report.case, &report.solution);
    titled("Limits", verdicts.iter().flat_map(|verdict| item(&mark(verdict), &verdict.to_string())))
}

// The table of the stations, split into several tables, each with the angle, if its columns do not
// fit a line.
fn station_table(report: &Report) -> Vec<String> {
    const CELL: usize = 12;
    const IN_A_LINE: usize = 5;
    if !report.selection.stations {
        return Vec::new();
    }
    let rows = rows(&report.solution);
    let columns: Vec<_> = columns(report.solution.method).collect();
    let (angle, values) = columns.split_at(1);
    let line = |row: Vec<String>| {
        row.iter().map(|cell| format!("{cell:>CELL$}")).collect::<Vec<_>>().concat()
    };
    let table = |values: &[&Column]| {
        let columns: Vec<_> = angle.iter().chain(values).copied().collect();
        let head =
            columns.iter().map(|column| format!("{} {}", column.symbol, column.shown)).collect();
        let stations =
            rows.iter().map(|row| columns.iter().map(|column| column.printed(*row)).collect());
        std::iter::once(head).chain(stations).map(line).collect::<Vec<_>>()
    };
    let title = if report.solution.method.shares_load() {
        "Stations from D to the last contact"
    } else {
        "Stations from D to E"
    };
    titled(title, values.chunks(IN_A_LINE).flat_map(table))
}

fn titled(title: &str, lines: impl IntoIterator<Item = String>) -> Vec<String> {
    let mut lines = lines.into_iter().peekable();
    let title = lines.peek().is_some().then(|| title.to_owned());
    title.into_iter().chain(lines).collect()
}
