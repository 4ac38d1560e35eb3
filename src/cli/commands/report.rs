//! `report`: writes cases side by side as a page or as data, in the format of the file extension.

use super::plot;
use crate::cli::Streams;
use crate::cli::cases;
use crate::cli::exit::{Exit, Failure};
use crate::cli::options::Cases;
use crate::cli::output::{check_out, write_to};
use crate::cli::progress::follow;
use crate::report::export::{ReportFormat, subject};
use clap::{Args, ValueHint};
use std::io::Write;
use std::path::{Path, PathBuf};

const AFTER_HELP: &str = "The HTML page needs no other file: verdict, inputs, results, charts, \
    teeth, limits, notes and the case files; one case prints on two A4 pages. Markdown has the \
    same without charts. CSV and JSON are those of `solve`, JSON with the stations.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub struct Options {
    /// The cases
    #[command(flatten)]
    pub input: Cases,
    /// File to write; the extension selects the format; replaces an existing file
    #[arg(long, required = true, value_name = "FILE", value_hint = ValueHint::FilePath)]
    pub out: PathBuf,
}

pub(super) fn run(options: &Options, streams: &mut Streams) -> Result<Exit, Failure> {
    let Some(format) = ReportFormat::of(&options.out) else {
        return Err(Failure::Usage(format!(
            "--out {}: the file extension selects the format: use {}",
            options.out.display(),
            ReportFormat::ENDINGS
        )));
    };
    let cases: Vec<&Path> = options.input.cases.iter().map(AsRef::as_ref).collect();
    check_out(Some(&options.out), &cases)?;
    let edits = options.input.changes.edits();
    let (mut subjects, mut worst) = (Vec::new(), Exit::Done);
    for path in cases {
        let solved = cases::open(path, &edits, streams).and_then(|opened| {
            let report = plot::solve(&opened, format.has_stations(), streams)?;
            let file = opened.document.render();
            // Ctrl-C ends the program.
            let subject = follow("parts", |go_on| subject(report, file, format, go_on));
            subject.map_err(|refusal| opened.refused(&refusal, streams))
        });
        match solved {
            Ok(subject) => subjects.push(subject),
            Err(exit) => worst = worst.max(exit),
        }
    }
    if subjects.is_empty() {
        return Ok(worst);
    }
    let text = format.render(&subjects)?;
    write_to(Some(&options.out), streams.output.as_mut(), |sink| sink.write_all(text.as_bytes()))?;
    Ok(worst)
}
