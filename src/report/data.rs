//! A solve as a page of text, as a JSON object on one line, and as rows of CSV.

use super::{Report, case_notes, grouped, is_default, shown_with, unit_of_gears, value};
use crate::case::file::FORMAT;
use crate::case::sanitize::{one_line, sanitize};
use crate::case::units::System;
use crate::case::{FIELDS, Field};
use crate::model::inputs::Method;
use crate::model::{Outcome, Quantity, Solution, Stage};
use crate::report::digest::{by_exact, differing, sentence, whine};
use crate::report::stations::columns;
pub use crate::report::table::write_line;
use crate::report::table::{Cell, Column, Table, WIDTH, flow, item, json, measured, object, text};
use crate::report::verdict::verdicts;
use std::io::{self, Write};

/// The page; empty sections are omitted.
pub fn render(report: &Report) -> String {
    let items = |mark: &str, sentences: Vec<String>| -> Vec<String> {
        sentences.iter().flat_map(|sentence| item(mark, sentence)).collect()
    };
    let notes = case_notes(&report.notes).map(|note| sanitize(&note.to_string())).collect();
    let sections = [
        report.named().headings(&methods(report)),
        items("", verdict(report, System::Metric)),
        inputs(report),
        quantity_lines(report),
        titled("Notes", items("  - ", notes)),
        limits(report),
        station_lines(report),
    ];
    let sections = sections.iter().filter(|lines| !lines.is_empty());
    sections.map(|lines| lines.join("\n") + "\n").collect::<Vec<_>>().join("\n")
}

/// The method, followed by the quantities that a slower method computes besides `auto`'s choice.
fn methods(report: &Report) -> String {
    let solution = &report.solution;
    let is_beside = |(quantity, _): &(&Quantity, f64)| beside(quantity, solution).is_some();
    let others: Vec<&Quantity> =
        report.values().filter(is_beside).map(|(known, _)| known).collect();
    let plane = if solution.is_helical() { ", transverse plane" } else { "" };
    let own = format!("method {}{plane}", solution.method.name());
    let Some(slower) = others.first().and_then(|first| beside(first, solution)) else { return own };
    let named = match others[..] {
        [one] => one.symbol.to_owned(),
        _ => format!("{} quantities", others.len()),
    };
    format!("{own}; {named} by {slower}")
}

/// The method of a quantity that the method of the solution does not compute.
fn beside(quantity: &Quantity, solution: &Solution) -> Option<&'static str> {
    let method = solution.having(quantity.stage).method;
    (method != solution.method).then(|| method.name())
}

/// The verdict in a sentence, followed by the results of other methods and the resonance.
pub(super) fn verdict(report: &Report, system: System) -> Vec<String> {
    let solution = &report.solution;
    let mut sentences = vec![sentence(solution, system, false)];
    if report.selection.is_whole() {
        let all: Vec<&Solution> = report.others.iter().collect();
        let exact = all.iter().find(|other| other.method == Method::Exact);
        let others = [
            differing(solution, &all),
            exact.and_then(|exact| by_exact(solution, exact, system)),
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
            "model" => !["method", "stations"].contains(&field.name()) && !is_default(at, case),
            _ => field.name() == "pressure_angle" || !is_default(at, case),
        };
        // The pressure angle also by default.
        let text = case.effective(at).filter(|_| is_listed)?;
        let name = Some(case.symbol(at)).filter(|symbol| !symbol.is_empty()).unwrap_or(field.key);
        Some(format!("{name} = {}", sanitize(text)))
    };
    let shown: Vec<String> = FIELDS.iter().enumerate().filter_map(shown).collect();
    // Each input stays on one line with its unit.
    let lines = flow(shown.join(",\n").split('\n'), WIDTH);
    lines.into_iter().chain(item("Notes of the case: ", &one_line(report.text("notes")))).collect()
}

/// The quantities in groups; selected quantities in their order.
fn quantity_lines(report: &Report) -> Vec<String> {
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
        let unit = unit_of_gears(quantity, |of| value(of, solution), System::Metric);
        let shown = shown_with(quantity, report.selection.value(quantity, solution)?, unit);
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
        return text(&grouped(method, &columns, row)).concat();
    }
    Table::new("", columns).with(report.selection.quantities().filter_map(row)).lines()
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
fn station_lines(report: &Report) -> Vec<String> {
    const IN_A_LINE: usize = 5;
    if !report.selection.stations {
        return Vec::new();
    }
    let table = stations(report);
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

/// The subject of a quantity in a method, if it differs from the result of the method.
pub(super) fn subject(quantity: &Quantity, method: Method) -> Option<&'static str> {
    if method.shares_load() && quantity.is_of_free_impact() {
        Some("free-impact")
    } else if matches!(
        quantity.stage,
        Stage::StaticSpectrum | Stage::SteadyMotion | Stage::SpeedRun
    ) {
        // No tooth of the pair deviates.
        Some("without-deviations")
    } else if quantity.symbol_in(method) != quantity.symbol {
        Some("deviations-without-reliefs")
    } else {
        None
    }
}

/// Writes the report as one line.
///
/// # Errors
/// Errors of the writer.
pub fn write_json(report: &Report, out: &mut dyn Write) -> io::Result<()> {
    let solution = &report.solution;
    let quantities = report.values().map(|(quantity, value)| {
        let mut member = measured(quantity, value, subject(quantity, solution.method));
        member["method"] = json!(beside(quantity, solution));
        (quantity.key, member)
    });
    let stations = report.selection.stations.then(|| stations(report).objects());
    let notes =
        report.notes.iter().map(|note| json!({"code": note.code, "message": note.to_string()}));
    let stages = solution.all_stages();
    let line = json!({
        "case": report.name,
        "title": report.case.title(),
        "format": FORMAT,
        "version": env!("CARGO_PKG_VERSION"),
        "method": solution.method.name(),
        "plane": solution.is_helical().then_some("transverse"),
        "outcome": solution.outcome.name(),
        "exit_outcome": solution.exit_outcome().map(Outcome::name),
        "quantities": object(quantities),
        "stations": stations,
        "stages": stages.iter().map(Stage::name).collect::<Vec<_>>(),
        "notes": notes.collect::<Vec<_>>(),
    });
    write_line(&line, out)
}

/// The stations of a solve.
pub fn stations(report: &Report) -> Table {
    let columns: Vec<_> = columns(report.solution.method).collect();
    let solution = &report.solution;
    let row =
        |row| columns.iter().map(|column| Cell::number(column.of(solution, row), "-")).collect();
    let cells = report.solution.own_stations().iter().map(row);
    let column = |known: &&super::stations::Column| {
        let title = format!("{} {}", known.symbol, known.shown);
        Column::number(known.key, title, known.unit, (known.shown, known.digits)).wide(0, 12)
    };
    Table::new("", columns.iter().map(column).collect()).with(cells)
}

/// Writes the requested quantities of a case, or the stations if they are requested.
///
/// # Errors
/// Errors of the writer.
pub fn write_csv(report: &Report, with_header: bool, out: &mut dyn Write) -> io::Result<()> {
    let mut table = if report.selection.stations { stations(report) } else { quantities(report) };
    table.columns.insert(0, Column::text("case", ""));
    let name = sanitize(&report.name);
    table.rows.iter_mut().for_each(|row| row.insert(0, name.as_str().into()));
    if with_header { table.write_csv(out) } else { table.write_csv_rows(out) }
}

/// One row with method, outcome and the requested quantities.
fn quantities(report: &Report) -> Table {
    let solution = &report.solution;
    let words = ["method", "outcome"].map(|key| Column::text(key, ""));
    let known = report.selection.quantities();
    let computed = known.map(|quantity| Column::si(quantity.key, quantity.unit));
    let names = [solution.method.name(), solution.outcome.name()].map(Cell::from);
    let values = report.selection.quantities();
    let values =
        values.map(|quantity| Cell::number(report.selection.value(quantity, solution), ""));
    Table::new("", words.into_iter().chain(computed).collect())
        .with([names.into_iter().chain(values).collect()])
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Case;
    use crate::model::{Stages, solve};
    use crate::report::Selection;

    #[test]
    fn json_omits_a_value_that_is_no_number_and_adds_a_note() {
        let case = Case::table_1();
        let inputs = case.inputs().unwrap();
        let mut solution = solve(&inputs, Stages::ALL).unwrap();
        solution.mesh_force = f64::NAN;
        solution.stations[0].force = f64::INFINITY;
        let selection = Selection { stations: true, ..Selection::default() };
        let mut out = Vec::new();
        write_json(&Report::of("case".to_owned(), case, inputs, solution, selection), &mut out)
            .unwrap();
        let line: serde_json::Value = serde_json::from_slice(&out).unwrap();
        assert_eq!(line["quantities"].get("mesh_force"), None);
        assert_eq!(line["quantities"].get("dynamic_factor"), None);
        assert_eq!(line["stations"][0].get("impact_force"), None);
        let is_of_mesh_force = |note: &serde_json::Value| {
            note["code"] == "not-finite" && note["message"].to_string().contains("mesh_force")
        };
        assert!(line["notes"].as_array().unwrap().iter().any(is_of_mesh_force));
        assert!(!String::from_utf8(out).unwrap().contains("null"));
    }
}
