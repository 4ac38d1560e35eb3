//! A solve as a page of text, 80 columns wide.

use super::absence::Absence;
use super::data::{self, subject};
use super::digest::{differing, free_impact, sentence, whine};
use super::layout::{WIDTH, flow, item};
use super::table::{Cell, Column, Table, text};
use super::verdict::verdicts;
use super::{Report, case_notes, groups, is_default, shown, value};
use crate::case::sanitize::{one_line, sanitize};
use crate::case::units::System;
use crate::case::{FIELDS, Field};
use crate::model::inputs::Method;
use crate::model::{Quantity, Solution};

/// The page; empty sections are omitted.
#[must_use]
pub fn render(report: &Report) -> String {
    let items = |mark: &str, sentences: Vec<String>| -> Vec<String> {
        sentences.iter().flat_map(|sentence| item(mark, sentence)).collect()
    };
    let notes = case_notes(&report.notes).map(|note| sanitize(&note.message)).collect();
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

/// The verdict in a sentence, followed by the results of other methods and the resonance.
pub(super) fn verdict(report: &Report) -> Vec<String> {
    let (solution, system) = (&report.solution, System::Metric);
    let mut sentences = vec![sentence(solution, system, None)];
    if report.selection.is_whole() {
        let all: Vec<&Solution> = report.others.iter().collect();
        let exact = all.iter().find(|other| other.method == Method::Exact);
        let is_given = report.inputs.deflection.is_some();
        let others = [
            differing(solution, &all),
            exact.and_then(|exact| free_impact(solution, exact, is_given, system)),
            whine(solution),
        ];
        sentences.extend(others.into_iter().flatten().map(|words| words + "."));
    }
    sentences
}

/// The given inputs that differ from their defaults, and the pressure angle.
fn inputs(report: &Report) -> Vec<String> {
    if !report.selection.is_whole() {
        return Vec::new();
    }
    let case = &report.case;
    let shown = |(at, field): (usize, &Field)| {
        let is_listed = match field.table() {
            "" => false,
            "model" => field.name() == "deflection",
            _ => field.name() == "pressure_angle" || !is_default(at, case),
        };
        let text = case.text(at).filter(|_| is_listed)?;
        Some(format!("{} = {}", field.symbol, sanitize(text)))
    };
    let shown: Vec<String> = FIELDS.iter().enumerate().filter_map(shown).collect();
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
        // With every quantity the headings of the groups say this.
        let beside = match subject(quantity, method) {
            Some("free-impact") if !is_whole => ", free impact",
            Some("without-deviations") if !is_whole => ", without deviations",
            _ => "",
        };
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
