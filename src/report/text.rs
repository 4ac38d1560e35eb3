//! A solve as a page of text, 80 columns wide.

use super::absence::Absence;
use super::data;
use super::digest::{closed_forms, differing, relief, sentence, whine};
use super::layout::{WIDTH, flow, item};
use super::table::{Cell, Column, Table, text};
use super::verdict::verdicts;
use super::{Report, groups, shown, value};
use crate::case::FIELDS;
use crate::case::fields::{Absent, index_of};
use crate::case::sanitize::{one_line, sanitize};
use crate::case::units::System;
use crate::model::inputs::Method;
use crate::model::{Quantity, Solution};

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

/// The page; empty sections are omitted.
#[must_use]
pub fn render(report: &Report) -> String {
    let items = |mark: &str, sentences: Vec<String>| -> Vec<String> {
        sentences.iter().flat_map(|sentence| item(mark, sentence)).collect()
    };
    let notes = report.notes.iter().map(|note| sanitize(&note.message)).collect();
    let sections = [
        report.named().headings(&format!("method {}", report.solution.method.name())),
        items("", verdict(report)),
        inputs(report),
        quantities(report),
        titled("Notes", items("  - ", notes)),
        limits(report),
        stations(report),
    ];
    let sections = sections.iter().filter(|lines| !lines.is_empty());
    sections.map(|lines| lines.join("\n") + "\n").collect::<Vec<_>>().join("\n")
}

/// The verdict in sentences, with what other methods find.
pub(super) fn verdict(report: &Report) -> Vec<String> {
    let (solution, system) = (&report.solution, System::Metric);
    let mut sentences = vec![sentence(solution, system)];
    if report.selection.is_whole() {
        let all: Vec<&Solution> = report.others.iter().collect();
        let beside = all.iter().copied().filter(|other| other.method != Method::Paper);
        let beside: Vec<&Solution> = beside.collect();
        let others = [
            differing(solution, &beside),
            relief(solution, &beside, system),
            closed_forms(solution, &all, report.inputs.deflection.is_some(), system),
            whine(solution),
        ];
        sentences.extend(others.into_iter().flatten().map(|words| words + "."));
    }
    sentences
}

fn inputs(report: &Report) -> Vec<String> {
    if !report.selection.is_whole() {
        return Vec::new();
    }
    let shown = |key: &&str| {
        let field = &FIELDS[index_of(key)?];
        let text = report.text(key);
        let number = text.split_whitespace().next()?.parse::<f64>().ok();
        let default = match field.absent {
            Absent::Default(text) => text.parse::<f64>().ok(),
            _ => None,
        };
        let is_usual = number.is_some_and(|number| number == 0.0 || Some(number) == default);
        (!is_usual).then(|| format!("{} = {}", field.symbol, sanitize(text)))
    };
    let shown: Vec<String> = SHOWN_INPUTS.iter().filter_map(shown).collect();
    // Each input stays on one line with its unit.
    let lines = flow(shown.join(",\n").split('\n'), WIDTH);
    lines.into_iter().chain(item("Notes of the case: ", &one_line(report.text("notes")))).collect()
}

/// The quantities in groups; selected quantities in their order, each without a value with its
/// reason.
fn quantities(report: &Report) -> Vec<String> {
    let solution = &report.solution;
    let method = solution.method;
    let is_whole = report.selection.is_whole();
    let columns = vec![
        Column::text("symbol", "").wide(2, 0),
        Column::text("label", ""),
        Column::text("value", "").to_the_right(),
        Column::text("unit", ""),
        Column::text("equation", "").wide(2, 0),
    ];
    let row = |quantity: &'static Quantity| {
        let shown = shown(quantity, value(quantity, solution)?);
        let is_beside = !is_whole && method.shares_load() && quantity.is_of_free_impact();
        let beside = if is_beside { ", free impact" } else { "" };
        let equation = format!("{}{beside}", quantity.equation);
        let names = [quantity.symbol_in(method), quantity.label_in(method), &shown.number];
        Some(names.into_iter().chain([shown.unit, &equation]).map(Cell::from).collect())
    };
    if is_whole {
        let tables = groups(method).into_iter().map(|group| {
            let title = match group.heading(method).split_once(": ") {
                Some((beside, title)) => format!("{beside}: {}", lower(title)),
                None => group.title.to_owned(),
            };
            Table::new(title, columns.clone()).with(group.quantities().filter_map(row))
        });
        let tables: Vec<Table> = tables.filter(|table| !table.rows.is_empty()).collect();
        return text(&tables).concat();
    }
    let known = || report.selection.quantities();
    let absent = known().filter(|quantity| value(quantity, solution).is_none());
    let absent = absent.flat_map(|quantity| {
        let start = format!("  {} has no value: ", quantity.symbol_in(method));
        item(&start, &Absence::of(quantity, solution).to_string())
    });
    let table = Table::new("", columns).with(known().filter_map(row));
    Table { notes: absent.collect(), ..table }.lines()
}

fn lower(title: &str) -> String {
    let mut letters = title.chars();
    letters.next().map(|first| first.to_lowercase().chain(letters).collect()).unwrap_or_default()
}

fn limits(report: &Report) -> Vec<String> {
    if !report.selection.is_whole() {
        return Vec::new();
    }
    let verdicts = verdicts(&report.case, &report.solution);
    let lines = verdicts.iter().flat_map(|verdict| {
        item(&format!("  {:10}", verdict.standing.word()), &verdict.to_string())
    });
    titled("Limits", lines.collect())
}

/// The stations in several tables, each with the angle, if the columns do not fit a line.
fn stations(report: &Report) -> Vec<String> {
    const IN_A_LINE: usize = 5;
    if !report.selection.stations {
        return Vec::new();
    }
    let table = data::stations(report);
    let values: Vec<usize> = (1..table.columns.len()).collect();
    let tables = values.chunks(IN_A_LINE).flat_map(|values| {
        let columns: Vec<usize> = [0].into_iter().chain(values.iter().copied()).collect();
        table.of(&columns).lines()
    });
    let title = if report.solution.method.shares_load() {
        "Stations from D to the last contact"
    } else {
        "Stations from D to E"
    };
    titled(title, tables.collect())
}

fn titled(title: &str, mut lines: Vec<String>) -> Vec<String> {
    if !lines.is_empty() {
        lines.insert(0, title.to_owned());
    }
    lines
}
