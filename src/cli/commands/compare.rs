//! `compare`: cases and their variants side by side.

use crate::case::{Document, Problem};
use crate::cli::Streams;
use crate::cli::cases;
use crate::cli::exit::{Exit, Failure};
use crate::cli::options::{
    Edits, FormatChoice, FormatOption, QuantityList, Setting, Settings, by_method, methods,
};
use crate::cli::progress::follow;
use crate::model::Quantity;
use crate::model::inputs::Method;
use crate::report::compare::{Column, Comparison};
use crate::report::{Report, Selection};
use crate::study::condition::distinct;
use clap::{Args, ValueEnum, ValueHint};
use std::path::{Path, PathBuf};

const AFTER_HELP: &str = "A variant is a table [variants.NAME] of the case file with the keys \
    that it changes, such as \"driven.tip_relief\" = \"48 um\". The first column is the reference \
    of all differences. A difference is in the unit of the quantity, or in percent if the \
    quantity cannot be negative and its value is at most ten times the reference. A refused case \
    or variant keeps its column, with the reason. CSV: one row per quantity in SI units. JSON: \
    one object in SI units; missing values are absent.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = AFTER_HELP)]
pub struct Options {
    /// Case files, each with its variants; - is standard input
    #[arg(required = true, value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub cases: Vec<PathBuf>,
    /// Compare only these variants
    #[arg(long = "variant", value_name = "NAME,...", value_delimiter = ',')]
    pub variants: Vec<String>,
    /// Use this method instead of the methods of the cases
    #[arg(long, value_parser = methods())]
    method: Option<Method>,
    /// Change a field of every case and variant, such as "operation.speed=3000 rpm"
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = Settings)]
    settings: Vec<Setting>,
    /// Compare only these quantities, by name or symbol; `tipstrike fields --results` lists them
    #[arg(long, value_name = "QUANTITY,...", hide_possible_values = true, value_parser = QuantityList)]
    pub only: Vec<Vec<&'static Quantity>>,
    /// The format
    #[command(flatten)]
    pub output: FormatOption<CompareFormat>,
}

/// Format of a comparison.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum CompareFormat {
    /// Tables for a person
    Text,
    /// One row per quantity
    Csv,
    /// One object
    Json,
    /// Tables in Markdown
    Md,
}

impl FormatChoice for CompareFormat {
    const DEFAULT: &str = "text";
}

impl Options {
    /// The changes of every case, for a variant or for the case itself.
    fn edits(&self, variant: Option<&str>) -> Edits {
        let settings = self.settings.iter().cloned();
        Edits {
            variant: variant.map(str::to_owned),
            settings: settings.chain(by_method(self.method)).collect(),
        }
    }
}

pub(super) fn run(options: &Options, streams: &mut Streams) -> Result<Exit, Failure> {
    let selection =
        Selection { only: distinct(options.only.iter().flatten().copied()), stations: false };
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
        wanted.map(|(_, case)| case.solve(&selection)).collect::<Vec<_>>()
    });
    if columns.len() < 2 && worst == Exit::Done {
        let name = columns.first().map_or("", |column| column.name.as_str());
        return Err(Failure::Usage(format!(
            "{name}: the case has no variants: name a second case, or add a table [variants.NAME]"
        )));
    }
    if columns.is_empty() {
        return Ok(worst);
    }
    write(&Comparison { columns, selection }, options.output.format, streams)
        .map(|exit| exit.max(worst))
}

fn write(
    comparison: &Comparison,
    format: CompareFormat,
    streams: &mut Streams,
) -> Result<Exit, Failure> {
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
    Ok(if comparison.is_all_refused() { Exit::BadCase } else { Exit::Done })
}

/// A case, or one of its variants, with the changes of the command line.
struct Edited {
    file: String,
    edits: Edits,
    document: Document,
}

/// The case itself, then its variants.
fn edited(
    options: &Options,
    path: &Path,
    document: &Document,
    streams: &mut Streams,
) -> Result<Vec<Edited>, Exit> {
    let all = document.case.variants.iter().map(|variant| &variant.name);
    let variants: Vec<&String> =
        if options.variants.is_empty() { all.collect() } else { options.variants.iter().collect() };
    let names = std::iter::once(None).chain(variants.into_iter().map(|name| Some(name.as_str())));
    let edited = names.map(|variant| {
        let (mut document, edits) = (document.clone(), options.edits(variant));
        cases::edit(&mut document, &edits)?;
        Ok(Edited { file: path.display().to_string(), edits, document })
    });
    edited.collect::<Result<_, String>>().map_err(|line| {
        streams.say(&line);
        Exit::Usage
    })
}

impl Edited {
    fn solve(self, selection: &Selection) -> Column {
        let Edited { file, edits, document } = self;
        let (case, name) = (&document.case, cases::named(file.clone(), &edits));
        let solved = case.inputs().and_then(|inputs| {
            Report::solve(name.clone(), case.clone(), inputs, selection.clone())
                .map_err(|refusal| vec![Problem::from(&refusal).at_given(case)])
        });
        let found = solved.map_err(|problems| cases::refused(&document, problems, &edits));
        Column { name, file, variant: edits.variant, case: document.case, found }
    }
}
