//! Writes cases side by side as a page or as data, in the format of the file's ending.

use super::{Exit, Export, Streams, cases, plot};
use crate::report::charts::with_other_method;
use crate::report::export::Format;
use crate::report::page::Subject;
use std::io;

pub(super) fn run(options: &Export, streams: &mut Streams) -> io::Result<Exit> {
    let Some(format) = Format::of(&options.out) else {
        streams.say(&format!(
            "--out {}: the ending chooses the format: use {}",
            options.out.display(),
            Format::ENDINGS
        ));
        return Ok(Exit::Usage);
    };
    let edits = options.changes.edits();
    let (mut subjects, mut worst) = (Vec::new(), Exit::Done);
    for path in &options.cases {
        let solved = cases::open(path, &edits, streams).and_then(|opened| {
            let report = plot::solve(&opened, format.has_stations(), streams)?;
            Ok((report, opened.document.render()))
        });
        match solved {
            Ok((report, file)) => {
                let reports = if format.is_page() {
                    with_other_method(report)
                } else {
                    vec![report]
                };
                let speeds = (format == Format::Html)
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
    let text = format.render(&subjects)?;
    plot::write(Some(&options.out), &text, streams).map(|exit| exit.max(worst))
}
