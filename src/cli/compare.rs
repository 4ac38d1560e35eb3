//! Cases and their variants side by side.

use super::{Compare, CompareFormat, Exit, Streams, cases};
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
    let (mut columns, mut worst) = (Vec::new(), Exit::Done);
    for path in &options.cases {
        let found = cases::read(path, streams)
            .and_then(|document| of_case(options, path, &document, &selection, streams));
        match found {
            Ok(found) => columns.extend(found),
            Err(exit) => worst = worst.max(exit),
        }
    }
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

/// The columns of a case: the case itself, then its variants.
fn of_case(
    options: &Compare,
    path: &Path,
    document: &Document,
    selection: &Selection,
    streams: &mut Streams,
) -> Result<Vec<Column>, Exit> {
    let all = document.case.variants.iter().map(|variant| &variant.name);
    let variants: Vec<&String> = if options.variants.is_empty() {
        all.collect()
    } else {
        options.variants.iter().collect()
    };
    let names = std::iter::once(None).chain(variants.into_iter().map(|name| Some(name.as_str())));
    let columns = names.map(|variant| column(options, path, document, variant, selection));
    columns.collect::<Result<_, String>>().map_err(|line| {
        streams.say(&line);
        Exit::Usage
    })
}

fn column(
    options: &Compare,
    path: &Path,
    document: &Document,
    variant: Option<&str>,
    selection: &Selection,
) -> Result<Column, String> {
    let mut document = document.clone();
    cases::edit(&mut document, &options.edits(variant))?;
    let (case, file) = (document.case, path.display().to_string());
    let name = match variant {
        Some(variant) => format!("{file}:{variant}"),
        None => file.clone(),
    };
    let found = match case.inputs() {
        Ok(inputs) => Report::solve(name.clone(), case.clone(), inputs, selection.clone())
            .map_err(|refusal| Problem::from(&refusal).at_given(&case)),
        Err(problems) => Err(problems.into_iter().next().unwrap_or_else(|| Problem {
            field: String::new(),
            cause: "the case is not valid".to_owned(),
            fix: "check its values".to_owned(),
        })),
    };
    Ok(Column {
        name,
        file,
        variant: variant.map(str::to_owned),
        case,
        found,
    })
}
