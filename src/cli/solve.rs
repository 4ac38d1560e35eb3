//! `solve`: solves cases and prints the results.

use super::cases::{self, Opened};
use super::{Edits, Exit, Format, Setting, Solve, Streams};
use crate::model::Refusal;
use crate::report::{Report, Selection, csv, json, text};
use crate::study::headline::distinct;
use std::io::{self, Write};

pub(super) fn run(options: &Solve, streams: &mut Streams) -> io::Result<Exit> {
    let edits = edits(options);
    let selection = selection(options);
    let (mut first, mut worst) = (true, Exit::Done);
    for path in &options.cases {
        let report = cases::open(path, &edits, streams)
            .and_then(|opened| solve(&opened, &selection, streams));
        match report {
            Ok(report) => {
                print(&report, options.format, first, streams.output.as_mut())?;
                first = false;
            }
            Err(exit) => worst = worst.max(exit),
        }
    }
    Ok(worst)
}

/// `--stations` is a field as well.
fn edits(options: &Solve) -> Edits {
    let stations = options
        .stations
        .clone()
        .map(|value| Setting::by("--stations", "model.stations", &value));
    let mut edits = options.changes.edits();
    edits.settings.extend(stations);
    edits
}

fn selection(options: &Solve) -> Selection {
    let only = distinct(options.only.iter().flatten().copied());
    let whole_json = options.format == Format::Json && only.is_empty();
    Selection {
        only,
        stations: options.stations.is_some() || whole_json,
    }
}

fn solve(opened: &Opened, selection: &Selection, streams: &mut Streams) -> Result<Report, Exit> {
    let Opened {
        name,
        document,
        inputs,
        ..
    } = opened;
    let solved = Report::solve(
        name.clone(),
        document.case.clone(),
        inputs.clone(),
        selection.clone(),
    );
    match solved.and_then(in_full) {
        Ok(report) => Ok(report),
        Err(refusal) => Err(opened.refused(&refusal, streams)),
    }
}

/// What was asked for by name must be there, where the model did not withhold it.
fn in_full(report: Report) -> Result<Report, Refusal> {
    let missing = report.values().count() < report.selection.only.len();
    match report.solution.withheld {
        Some(refusal) if missing => Err(refusal),
        _ => Ok(report),
    }
}

fn print(report: &Report, format: Format, first: bool, out: &mut dyn Write) -> io::Result<()> {
    match format {
        Format::Text if first => text::write(report, out),
        Format::Text => writeln!(out).and_then(|()| text::write(report, out)),
        Format::Json => json::write(report, out),
        Format::Csv => csv::write(report, first, out),
    }
}
