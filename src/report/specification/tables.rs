//! The tables of a relief: its choices, and the maps of the transmission error.

use super::numbers::{mm, percent, um};
use crate::model::explanation::tidy;
use crate::report::layout::widest;
use crate::study::relief::{Choice, MapPoint, Specification};

/// One row per choice.
pub(super) fn choices(found: &Specification) -> Vec<String> {
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
pub(super) fn harris(found: &Specification) -> Vec<String> {
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
pub(super) fn map(found: &Specification) -> Vec<String> {
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
