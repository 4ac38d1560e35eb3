//! Writes cases side by side as a page or as data, in the format of the file's ending.

use super::{Exit, Export, Streams, cases, plot};
use crate::report::charts::with_other_method;
use crate::report::page::{Page, Subject};
use crate::report::{csv, json};
use std::io;
use std::path::Path;

/// The format of a file by its ending.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Ending {
    Html,
    Markdown,
    Csv,
    Json,
}

impl Ending {
    fn of(path: &Path) -> Option<Ending> {
        let ending = path.extension()?.to_str()?.to_ascii_lowercase();
        Some(match ending.as_str() {
            "html" | "htm" => Ending::Html,
            "md" | "markdown" => Ending::Markdown,
            "csv" => Ending::Csv,
            "json" | "jsonl" => Ending::Json,
            _ => return None,
        })
    }
}

pub(super) fn run(options: &Export, streams: &mut Streams) -> io::Result<Exit> {
    let Some(ending) = Ending::of(&options.out) else {
        streams.say(&format!(
            "--out {}: the ending chooses the format: use .html, .md, .csv or .json",
            options.out.display()
        ));
        return Ok(Exit::Usage);
    };
    let settings = options.changes.settings();
    let (mut subjects, mut worst) = (Vec::new(), Exit::Done);
    for path in &options.cases {
        let solved = cases::open(path, &settings, streams).and_then(|opened| {
            let report = plot::solve(&opened, ending != Ending::Csv, streams)?;
            Ok((report, opened.document.render()))
        });
        match solved {
            Ok((report, file)) => {
                let is_page = matches!(ending, Ending::Html | Ending::Markdown);
                let reports = if is_page {
                    with_other_method(report)
                } else {
                    vec![report]
                };
                let speeds = (ending == Ending::Html)
                    .then(|| plot::speeds_of(&reports[0].inputs))
                    .and_then(Result::ok);
                subjects.push(Subject {
                    reports,
                    speeds,
                    file,
                });
            }
            Err(exit) => worst = worst.max(exit),
        }
    }
    if subjects.is_empty() {
        return Ok(worst);
    }
    let text = rendered(ending, &subjects)?;
    plot::write(Some(&options.out), &text, streams).map(|exit| exit.max(worst))
}

fn rendered(ending: Ending, subjects: &[Subject]) -> io::Result<String> {
    let reports = || {
        subjects
            .iter()
            .filter_map(|subject| subject.reports.first())
    };
    let mut bytes = Vec::new();
    match ending {
        Ending::Html => return Page::of(subjects).html().map_err(io::Error::other),
        Ending::Markdown => return Ok(Page::of(subjects).markdown()),
        Ending::Csv => {
            for (at, report) in reports().enumerate() {
                csv::write(report, at == 0, &mut bytes)?;
            }
        }
        Ending::Json => {
            for report in reports() {
                json::write(report, &mut bytes)?;
            }
        }
    }
    String::from_utf8(bytes).map_err(io::Error::other)
}
