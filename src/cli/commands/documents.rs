//! Commands that write new cases and reference pages: `new`, `import`, `fields`, `schema`,
//! `completions`, `man`.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::case::file::{self, SaveError};
use crate::case::units::System;
use crate::case::{Case, Document, EXAMPLES, Example};
use crate::cli::options::{FormatOption, Listing};
use crate::cli::output::{Exit, Failure};
use crate::cli::{Streams, cases};
use crate::report::digest::Digest;
use crate::report::{fields, schema};
use clap::builder::{PossibleValuesParser, Resettable, TypedValueParser};
use clap::{Args, ValueHint};
use clap_complete::Shell;
use clap_mangen::Man;

/// The options of the command.
#[derive(Debug, Args)]
pub struct NewOptions {
    /// Start from this example instead of an empty case
    #[arg(long, value_name = "EXAMPLE", value_parser = examples())]
    pub from: Option<&'static Example>,
    /// List the examples instead, each with its pair and its verdict
    #[arg(long, conflicts_with_all = ["from", "file"])]
    pub list: bool,
    /// File to write (default: standard output); must not exist yet
    #[arg(value_hint = ValueHint::FilePath)]
    pub file: Option<PathBuf>,
}

pub(super) fn run_new(options: &NewOptions, streams: &mut Streams) -> Result<Exit, Failure> {
    if options.list {
        list(streams.output.as_mut())?;
        return Ok(Exit::Done);
    }
    let text = options
        .from
        .map_or_else(|| Document::new(Case::fresh()).render(), |example| example.text.to_owned());
    write_case(options.file.as_deref(), &text, streams)
}

/// Writes a case to a file that must not exist yet, or to standard output.
fn write_case(file: Option<&Path>, text: &str, streams: &mut Streams) -> Result<Exit, Failure> {
    match file.filter(|file| file.as_os_str() != "-") {
        None => streams.output.write_all(text.as_bytes())?,
        Some(path) => file::write(path, text.as_bytes(), false).map_err(|error| match error {
            SaveError::AlreadyThere(name) => {
                streams.say(&format!("{name}: the file exists: choose another name"));
                Failure::Reported(Exit::Unreadable)
            }
            other => Failure::File(other),
        })?,
    }
    Ok(Exit::Done)
}

/// The examples, each with its title, its pair and its verdict.
fn list(out: &mut dyn Write) -> io::Result<()> {
    let width = EXAMPLES.iter().map(|example| example.name.len()).max().unwrap_or(0);
    for example in EXAMPLES {
        let digest = digest(example);
        writeln!(out, "{:width$}  {}", example.name, digest.title)?;
        writeln!(out, "{:width$}  {}; {}", "", digest.pair, digest.load)?;
        writeln!(out, "{:width$}  {}", "", digest.verdict())?;
    }
    Ok(())
}

fn digest(example: &Example) -> Digest {
    let case = example.document().case;
    let inputs = case.inputs().ok();
    inputs
        .and_then(|inputs| Digest::solve(&case, &inputs, System::Metric, &|_| true))
        .unwrap_or_default()
}

fn examples() -> impl TypedValueParser<Value = &'static Example> {
    PossibleValuesParser::new(EXAMPLES.iter().map(|example| example.name))
        .try_map(|name| Example::find(&name))
}

const IMPORT_HELP: &str = "REXS is the exchange format of gear programs such as FVA-Workbench and Bearinx. Versions 1.0 to 2.0 \
    are read. Each value of the case has its source as a comment; standard error lists the stages of the model and each field \
    that stays empty, with the reason. Helical, planetary, bevel and other stages are refused.";

/// The options of the command.
#[derive(Debug, Args)]
#[command(after_help = IMPORT_HELP)]
pub struct ImportOptions {
    /// REXS model (.rexs, .rexsj or .rexsz); - is standard input
    #[arg(value_name = "MODEL", value_hint = ValueHint::FilePath)]
    pub model: PathBuf,
    /// Import the stage with this id (default: the only spur stage of the model)
    #[arg(long, value_name = "ID")]
    pub stage: Option<String>,
    /// File to write (default: standard output); must not exist yet
    #[arg(long, value_name = "CASE", value_hint = ValueHint::FilePath)]
    pub out: Option<PathBuf>,
}

pub(super) fn run_import(options: &ImportOptions, streams: &mut Streams) -> Result<Exit, Failure> {
    let imported = cases::read_model(&options.model, options.stage.as_deref(), streams)?;
    write_case(options.out.as_deref(), &imported.document.render(), streams)
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct FieldsOptions {
    /// List the quantities instead: the names for --only and [limits]
    #[arg(long)]
    pub results: bool,
    /// The format
    #[command(flatten)]
    pub output: FormatOption<Listing>,
}

pub(super) fn run_fields(options: &FieldsOptions, streams: &mut Streams) -> Result<Exit, Failure> {
    let out = streams.output.as_mut();
    match (options.results, options.output.format) {
        (false, Listing::Text) => fields::write_fields(out),
        (false, Listing::Json) => fields::write_fields_json(out),
        (true, Listing::Text) => fields::write_quantities(out),
        (true, Listing::Json) => fields::write_quantities_json(out),
    }?;
    Ok(Exit::Done)
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct SchemaOptions {
    /// Write the schema of `solve --format json` instead
    #[arg(long)]
    pub results: bool,
}

pub(super) fn run_schema(options: &SchemaOptions, streams: &mut Streams) -> Result<Exit, Failure> {
    let out = streams.output.as_mut();
    if options.results {
        schema::write_results(out)?;
    } else {
        schema::write_case(out)?;
    }
    Ok(Exit::Done)
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct CompletionsOptions {
    /// The shell
    pub shell: Shell,
}

pub(super) fn run_completions(
    options: &CompletionsOptions,
    mut program: clap::Command,
    streams: &mut Streams,
) -> Result<Exit, Failure> {
    // The generator panics if its writer fails, and therefore writes to memory.
    let mut script = Vec::new();
    clap_complete::generate(options.shell, &mut program, "tipstrike", &mut script);
    streams.output.write_all(&script)?;
    Ok(Exit::Done)
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct ManOptions {
    /// The page of this command
    pub command: Option<String>,
}

pub(super) fn run_man(
    options: &ManOptions,
    program: clap::Command,
    streams: &mut Streams,
) -> Result<Exit, Failure> {
    let page = page(options.command.as_deref(), program).ok_or_else(|| {
        Failure::Usage(format!(
            "man: there is no command {}: `tipstrike help` lists them",
            options.command.as_deref().unwrap_or_default()
        ))
    })?;
    let source = format!("tipstrike {}", env!("CARGO_PKG_VERSION"));
    Man::new(page).source(source).render(&mut streams.output)?;
    exit_status(streams.output.as_mut())?;
    Ok(Exit::Done)
}

fn exit_status(out: &mut dyn Write) -> io::Result<()> {
    writeln!(out, ".SH \"EXIT STATUS\"")?;
    Exit::MEANINGS
        .iter()
        .try_for_each(|&(exit, meaning)| writeln!(out, ".TP\n\\fB{}\\fR\n{meaning}", exit as u8))
}

fn page(name: Option<&str>, program: clap::Command) -> Option<clap::Command> {
    let mut program = program.disable_help_subcommand(true);
    program.build();
    match name {
        // The help ends with the exit codes, which have a separate section in the manual page.
        None => Some(program.after_help(Resettable::Reset)),
        Some(name) => program.find_subcommand(name).cloned(),
    }
}
