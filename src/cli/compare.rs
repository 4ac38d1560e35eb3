//! Cases and their variants side by side.

use super::progress::follow;
use super::{Compare, CompareFormat, Edits, Exit, Streams, cases};
use crate::case::{Document, Problem};
use crate::report::compare::{Column, Comparison};
use crate::report::{Report, Selection};
use crate::study::headline::distinct;
use std::io;
use std::path::Path;

pub(super) fn run(options: &Compare, streams: &mut Streams) -> io::Result<Exit> {
    let selection = Selection {
        only: distinct(options.only.iter().flatten().copied()),
        stations: false,
    };
    let (mut cases, mut worst) = (Vec::new(), Exit::Done);
    for path in &options.cases {
        let found = cases::read(path, streams)
            .and_then(|document| edited(options, path, &document, streams));
        match found {
            Ok(found) => cases.extend(found),
            Err(exit) => worst = worst.max(exit),
        }
    }
    let columns = follow("cases", |report| {
        let count = cases.len();
        let cases = cases.into_iter().enumerate();
        let wanted = cases.take_while(|(at, _)| report(*at, count));
        wanted
            .map(|(_, case)| case.solve(&selection))
            .collect::<Vec<_>>()
    });
    if columns.len() < 2 && worst == Exit::Done {
        let name = columns.first().map_or("", |column| column.name.as_str());
        streams.say(&format!(
            "{name}: the case has no variants: name a second case, or add a table [variants.NAME]"
        ));
        return Ok(Exit::Usage);
    }
    if columns.is_empty() {
        return Ok(worst);
    }
    write(&Comparison { columns, selection }, options.format, streams).map(|exit| exit.max(worst))
}

fn write(
    comparison: &Comparison,
    format: CompareFormat,
    streams: &mut Streams,
) -> io::Result<Exit> {
    let out = streams.output.as_mut();
    match format {
        CompareFormat::Text => comparison.write(out)?,
        CompareFormat::Csv => comparison.write_csv(out)?,
        CompareFormat::Json => comparison.write_json(out)?,
        CompareFormat::Md => comparison.write_markdown(out)?,
    }
    for line in comparison.refusals() {
        streams.say(&line);
    }
    Ok(if comparison.is_all_refused() {
        Exit::BadCase
    } else {
        Exit::Done
    })
}

/// A case, or one of its variants, with the changes of the command line.
struct Edited {
    file: String,
    edits: Edits,
    document: Document,
}

/// The case itself, then its variants.
fn edited(
    options: &Compare,
    path: &Path,
    document: &Document,
    streams: &mut Streams,
) -> Result<Vec<Edited>, Exit> {
    let all = document.case.variants.iter().map(|variant| &variant.name);
    let variants: Vec<&String> = if options.variants.is_empty() {
        all.collect()
    } else {
        options.variants.iter().collect()
    };
    let names = std::iter::once(None).chain(variants.into_iter().map(|name| Some(name.as_str())));
    let edited = names.map(|variant| {
        let (mut document, edits) = (document.clone(), options.edits(variant));
        cases::edit(&mut document, &edits)?;
        Ok(Edited {
            file: path.display().to_string(),
            edits,
            document,
        })
    });
    edited.collect::<Result<_, String>>().map_err(|line| {
        streams.say(&line);
        Exit::Usage
    })
}

impl Edited {
    fn solve(self, selection: &Selection) -> Column {
        let Edited {
            file,
            edits,
            document,
        } = self;
        let (case, name) = (&document.case, cases::named(file.clone(), &edits));
        let solved = case.inputs().and_then(|inputs| {
            Report::solve(name.clone(), case.clone(), inputs, selection.clone())
                .map_err(|refusal| vec![Problem::from(&refusal).at_given(case)])
        });
        let found = solved.map_err(|problems| cases::refused(&document, problems, &edits));
        Column {
            name,
            file,
            variant: edits.variant,
            case: document.case,
            found,
        }
    }
}
