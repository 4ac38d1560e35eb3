//! Properties of every text, every case and every report.

use serde_json::Value;
use tipstrike::case::fields::{index_of, key_of};
use tipstrike::case::file::Fault;
use tipstrike::case::{Document, FIELDS, NEWER_FORMAT};
use tipstrike::model::{Inputs, QUANTITIES, Quantity, Refusal, Solution, Stage, Station};
use tipstrike::report::{self, Report, Selection};

use crate::assert_safe;

/// The result for a text.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Fate {
    /// The text is not a valid case.
    Faulty,
    /// The text is a case that the model refuses.
    Refused,
    Solved,
}

/// Checks that a text is a case or that every fault is reported at its place, and that a case is
/// solved or refused by name.
pub(crate) fn read_and_solve(text: &str) -> Fate {
    match Document::parse("a case.toml", text) {
        Ok(document) => {
            assert_eq!(document.render(), text, "untouched, it is written as it was read");
            solve(&document)
        }
        Err(faults) => {
            assert_placed(&faults, text);
            Fate::Faulty
        }
    }
}

/// Checks that faults have a place inside the text, and print on one line that is safe for a
/// terminal.
pub(crate) fn assert_placed(faults: &[Fault], text: &str) {
    assert!(!faults.is_empty(), "a refusal has a reason");
    let lines: Vec<&str> = text.strip_prefix('\u{feff}').unwrap_or(text).split('\n').collect();
    for fault in faults {
        let line = fault.line.checked_sub(1).and_then(|line| lines.get(line));
        let columns = line.map_or(0, |line| line.chars().count() + 1);
        assert!((1..=columns).contains(&fault.column), "{fault} is not in {text:?}");
        let message = fault.to_string();
        assert!(!message.contains('\n') && message.chars().count() < 1000, "{message}");
        assert!(!fault.problem.cause.is_empty() && !fault.problem.fix.is_empty(), "{message}");
        assert_safe(&message);
    }
    let ordered = faults.is_sorted_by_key(|fault| (fault.line, fault.column));
    assert!(ordered, "in the order of the places: {faults:?}");
    assert!(
        faults.len() == 1 || faults.iter().all(|fault| &*fault.problem.code != NEWER_FORMAT),
        "{faults:?}"
    );
}

fn solve(document: &Document) -> Fate {
    let inputs = document.case.inputs().expect("a case without faults has inputs");
    // The run over the speed is a hundred motions, and the spread builds the field of each gear: both
    // are solved, and the other methods beside them, in one case of forty.
    let is_whole = document.case.title().len().is_multiple_of(40);
    let is_quick = |quantity: &&Quantity| ![Stage::SpeedRun, Stage::Band].contains(&quantity.stage);
    let quick = || QUANTITIES.iter().filter(is_quick).collect();
    let only = if is_whole { Vec::new() } else { quick() };
    let selection = Selection { only, stations: true };
    match Report::solve("a case.toml".to_owned(), document.case.clone(), inputs, selection) {
        Ok(report) => {
            assert_sound(&report, is_whole);
            Fate::Solved
        }
        Err(refusal) => {
            assert_named(&refusal);
            Fate::Refused
        }
    }
}

/// Checks that a refusal has a name, a field and a fix, and finite numbers.
pub(crate) fn assert_named(refusal: &Refusal) {
    let message = refusal.to_string();
    assert!(
        !refusal.code().is_empty() && !refusal.fix().is_empty() && !message.contains('\n'),
        "{refusal:?}"
    );
    assert!(index_of(key_of(refusal.at())).is_some(), "{refusal:?}");
    assert_numbers(&message);
}

/// Checks that no report prints a NaN or an infinity, in any format.
fn assert_sound(report: &Report, is_whole: bool) {
    assert_finite(&report.solution);
    report.notes.iter().for_each(|note| assert_numbers(&note.message));
    assert_json(report);
    assert_csv(report);
    assert_page(if is_whole { report.clone().with_others() } else { report.clone() });
}

fn assert_finite(solution: &Solution) {
    for quantity in QUANTITIES {
        let value = (quantity.value)(solution);
        assert!(value.is_none_or(f64::is_finite), "{} is {value:?}", quantity.key);
    }
    for row in solution.own_stations() {
        for column in report::stations::columns(solution.method) {
            let value = (column.value)(solution, row);
            assert!(
                value.map_or_else(|| has_none(column.key, row), f64::is_finite),
                "{} of {row:?}",
                column.key
            );
        }
    }
}

/// Without a force there is no compliance: at E in the closed forms. A sharp tip has no pressure.
fn has_none(key: &str, station: &Station) -> bool {
    key == "hertz_pressure"
        || key == "pair_compliance" && station.load_share().is_none() && station.force == 0.0
}

/// Checks that a text has no NaN, no infinity and no number that cannot be printed.
fn assert_numbers(words: &str) {
    let no_number = |word: &str| ["NaN", "inf", "-inf", "n/a"].contains(&word);
    let mut all = words.split(|c: char| c.is_whitespace() || "(),;:=<>".contains(c));
    assert_eq!(all.find(|word| no_number(word)), None, "in {words}");
}

fn assert_json(report: &Report) {
    let line = written(|out| report::data::write_json(report, out));
    assert_safe(&line);
    assert_eq!(line.matches('\n').count(), 1);
    let value: Value = serde_json::from_str(&line).expect("JSON parses again");
    assert_eq!(value["title"], report.case.title());
    assert!(!line.contains("null"));
    let quantities = value["quantities"].as_object().expect("an object");
    assert_eq!(quantities.len(), report.values().count());
    for (quantity, value) in report.values() {
        let start = format!("\"{}\":{{\"value\":", quantity.key);
        let rest = line.split_once(&start).map_or("", |(_, rest)| rest);
        let back = rest.split_once(',').map(|(number, _)| match number {
            "true" | "false" if quantity.is_flag() => {
                f64::from(u8::from(number == "true")).to_bits()
            }
            _ => bits(number),
        });
        assert_eq!(back, Some(value.to_bits()), "{} is read unchanged", quantity.key);
    }
    assert_eq!(
        value["stations"].as_array().map(Vec::len),
        Some(report.solution.own_stations().len())
    );
}

fn assert_csv(report: &Report) {
    let whole = Report { selection: Selection::default(), ..report.clone() };
    let rows = rows(&written(|out| report::data::write_csv(&whole, true, out)));
    assert_eq!(rows.len(), 2);
    assert_eq!(rows[0].len(), rows[1].len());
    let found: Vec<u64> =
        rows[1].iter().skip(3).filter(|cell| !cell.is_empty()).map(bits).collect();
    assert_eq!(found, whole.values().map(|(_, value)| value.to_bits()).collect::<Vec<_>>());
    let stations = self::rows(&written(|out| report::data::write_csv(report, true, out)));
    assert_eq!(stations.len(), report.solution.own_stations().len() + 1);
    let empty = stations[1..]
        .iter()
        .enumerate()
        .flat_map(|(at, row)| row.iter().zip(&stations[0]).map(move |cell| (at, cell)))
        // A sharp tip and a rounded one after its edge have no pressure.
        .filter(|(_, (_, column))| !column.starts_with("hertz_pressure"))
        .map(|(at, (cell, _))| (at, cell));
    let empty: Vec<usize> = empty.filter(|(_, cell)| cell.is_empty()).map(|(at, _)| at).collect();
    assert!(empty.len() <= 1 && empty.iter().all(|&at| at + 2 == stations.len()), "{empty:?}");
    let is_number = |cell: &str| cell.is_empty() || cell.parse::<f64>().is_ok_and(f64::is_finite);
    assert!(stations[1..].iter().all(|row| row.iter().skip(1).all(is_number)));
}

fn assert_page(mut unnamed: Report) {
    assert_safe(&report::data::render(&unnamed));
    let names = ["title", "notes"].into_iter().filter_map(index_of);
    names.for_each(|field| unnamed.case.write(field, ""));
    unnamed.notes.clear();
    assert_numbers(&report::data::render(&unnamed));
}

fn written(write: impl FnOnce(&mut dyn std::io::Write) -> std::io::Result<()>) -> String {
    let mut out = Vec::new();
    write(&mut out).expect("a write to memory succeeds");
    String::from_utf8(out).expect("a report is text")
}

fn rows(text: &str) -> Vec<csv::StringRecord> {
    let mut reader = csv::ReaderBuilder::new().has_headers(false).from_reader(text.as_bytes());
    reader.records().map(|row| row.expect("CSV reads again")).collect()
}

fn bits(number: &str) -> u64 {
    number.parse::<f64>().expect("a number").to_bits()
}

/// Checks that two cases are equal: texts exactly, bare numbers by value.
pub(crate) fn assert_same(one: &Document, other: &Document) {
    let inputs = |document: &Document| -> Inputs { document.case.inputs().expect("a valid case") };
    assert_eq!(inputs(one), inputs(other));
    for (index, field) in FIELDS.iter().enumerate().filter(|(_, field)| !field.is_bare()) {
        assert_eq!(one.case.text(index), other.case.text(index), "{}", field.key);
    }
    let limits = |document: &Document| {
        let limits = document.case.limits.iter();
        limits.map(|limit| (limit.quantity.key, limit.value.to_bits())).collect::<Vec<_>>()
    };
    // A file has `0.5` for `.5`.
    let variants = |document: &Document| {
        let mut variants = document.case.variants.clone();
        for change in variants.iter_mut().flat_map(|one| &mut one.overrides) {
            if let Ok(number) = change.text.parse::<f64>() {
                change.text = number.to_string();
            }
        }
        variants
    };
    assert_eq!(
        (limits(one), &one.case.spread, variants(one)),
        (limits(other), &other.case.spread, variants(other))
    );
}
