//! Writes a chart of a case, or its teeth, as a picture.

use super::cases::{self, Opened};
use super::progress::follow;
use super::{Exit, Plot, Streams};
use crate::case::file;
use crate::model::{Inputs, Refusal};
use crate::report::charts::{Drawn, find, no_curve, picture, with_other_method};
use crate::report::svg::teeth::teeth;
use crate::report::whine::charts::{SPECTRUM, SPEED, spectrum, speed};
use crate::report::{Report, Selection};
use crate::study::speeds::{SPEEDS, SpeedCurve, speeds};
use std::io::{self, Write};
use std::path::Path;

/// The chart that shows the teeth.
pub(super) const TEETH: &str = "teeth";

pub(super) fn run(options: &Plot, streams: &mut Streams) -> io::Result<Exit> {
    let drawn = cases::open(&options.case, &options.changes.edits(), streams)
        .and_then(|opened| draw(&opened, options, streams));
    match drawn {
        Ok(text) => write(options.out.as_deref(), &text, streams),
        Err(exit) => Ok(exit),
    }
}

fn draw(opened: &Opened, options: &Plot, streams: &mut Streams) -> Result<String, Exit> {
    if options.chart == SPEED {
        let curve =
            speeds_of(&opened.inputs).map_err(|refusal| opened.refused(&refusal, streams))?;
        return speed(&[("", &curve)]).ok_or_else(|| {
            streams.say(&format!(
                "{}: the chart {SPEED} has no curve: no motion becomes steady: give a greater \
                 model.damping_ratio",
                opened.name
            ));
            Exit::BadCase
        });
    }
    let report = solve(opened, true, streams)?;
    if options.chart == TEETH {
        return Ok(teeth(&report.inputs, &report.solution));
    }
    let reports = with_other_method(report);
    let subject = Drawn {
        name: "",
        reports: &reports,
    };
    let drawn = if options.chart == SPECTRUM {
        spectrum(&[subject])
    } else {
        find(&options.chart).and_then(|graph| picture(graph, &[subject]))
    };
    drawn.ok_or_else(|| {
        let reason = no_curve(&options.chart, &reports);
        streams.say(&format!("{}: {reason}", opened.name));
        Exit::BadCase
    })
}

/// The dynamic factor over speed, with a bar while it takes long.
pub(super) fn speeds_of(inputs: &Inputs) -> Result<SpeedCurve, Refusal> {
    follow("speeds", |report| {
        speeds(inputs, &mut |curve| {
            let done = curve.up.iter().chain(&curve.down).flatten().count();
            report(done, 2 * SPEEDS)
        })
    })
}

/// Solves a case with every quantity, and the stations on request.
pub(super) fn solve(
    opened: &Opened,
    stations: bool,
    streams: &mut Streams,
) -> Result<Report, Exit> {
    let selection = Selection {
        only: Vec::new(),
        stations,
    };
    let solved = Report::solve(
        opened.name.clone(),
        opened.document.case.clone(),
        opened.inputs.clone(),
        selection,
    );
    solved.map_err(|refusal| opened.refused(&refusal, streams))
}

/// Writes a picture or a page, over an older one, or to standard output.
pub(super) fn write(out: Option<&Path>, text: &str, streams: &mut Streams) -> io::Result<Exit> {
    let Some(path) = out.filter(|path| path.as_os_str() != "-") else {
        return streams
            .output
            .write_all(text.as_bytes())
            .map(|()| Exit::Done);
    };
    match file::write(path, text.as_bytes(), true) {
        Ok(()) => Ok(Exit::Done),
        Err(error) => {
            streams.say(&error.to_string());
            Ok(Exit::Unreadable)
        }
    }
}
