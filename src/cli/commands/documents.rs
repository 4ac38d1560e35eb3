//! Commands that write new cases and reference pages: `new`, `import`, `fields`, `schema`,
//! `completions`, `man`.

use std::io::{self, Write};
use std::path::{Path, PathBuf};

use crate::case::file::{self, SaveError};
use crate::case::units::System;
use crate::case::{Case, Document, EXAMPLES, Example};
use crate::cli::options::formats;
use crate::cli::output::{Done, Exit, Failure};
use crate::cli::{Streams, cases};
use crate::report::digest::Digest;
use crate::report::{fields, schema, solve};
use crate::study::shard::Format;
use clap::builder::{PossibleValuesParser, Resettable, TypedValueParser};
use clap::{Args, ValueHint};
use clap_complete::Shell;

/// The options of the command.
#[derive(Debug, Args)]
pub struct New {
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

impl New {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        if self.list {
            list(streams.output.as_mut())?;
            return Ok(Exit::Done);
        }
        let text = self.from.map_or_else(
            || Document::new(Case::fresh()).render(),
            |example| example.text.to_owned(),
        );
        write_case(self.file.as_deref(), &text, streams)
    }
}

/// Writes a case to a file that must not exist yet, or to standard output.
fn write_case(file: Option<&Path>, text: &str, streams: &mut Streams) -> Done {
    match file.filter(|file| file.as_os_str() != "-") {
        None => streams.output.write_all(text.as_bytes())?,
        Some(path) => file::write(path, text.as_bytes(), false).map_err(|error| match error {
            SaveError::AlreadyThere(name) => {
                let line = format!("{name}: the file exists: choose another name");
                Failure::new(Exit::Unreadable, line)
            }
            other => other.into(),
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
        writeln!(out, "{:width$}  {}", "", digest.outcome)?;
        for (standing, limit) in &digest.limits {
            writeln!(out, "{:width$}  {} {limit}", "", standing.word())?;
        }
    }
    Ok(())
}

fn digest(example: &Example) -> Digest {
    let case = example.document().case;
    let inputs = case.inputs().ok();
    inputs
        .and_then(|inputs| solve::digest(&case, &inputs, System::Metric, &|_| true))
        .unwrap_or_default()
}

fn examples() -> impl TypedValueParser<Value = &'static Example> {
    PossibleValuesParser::new(EXAMPLES.iter().map(|example| example.name))
        .try_map(|name| Example::find(&name))
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Import {
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

impl Import {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let imported = cases::read_model(&self.model, self.stage.as_deref(), streams)?;
        write_case(self.out.as_deref(), &imported.document.render(), streams)
    }
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Fields {
    /// List the quantities instead: the names for --only and [limits]
    #[arg(long)]
    pub results: bool,
    /// Format of the output
    #[arg(long, default_value = "text", value_parser = formats([Format::Text, Format::Json]))]
    pub format: Format,
}

impl Fields {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let out = streams.output.as_mut();
        let is_json = self.format == Format::Json;
        if self.results {
            fields::write_quantities(is_json, out)?;
        } else {
            fields::write_fields(is_json, out)?;
        }
        Ok(Exit::Done)
    }
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Schema {
    /// Write the schema of `solve --format json` instead
    #[arg(long)]
    pub results: bool,
}

impl Schema {
    pub(super) fn run(&self, streams: &mut Streams) -> Done {
        let out = streams.output.as_mut();
        if self.results {
            schema::write_results(out)?;
        } else {
            schema::write_case(out)?;
        }
        Ok(Exit::Done)
    }
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Completions {
    /// The shell
    pub shell: Shell,
}

impl Completions {
    pub(super) fn run(&self, mut program: clap::Command, streams: &mut Streams) -> Done {
        // The generator panics if its writer fails, and therefore writes to memory.
        let mut script = Vec::new();
        clap_complete::generate(self.shell, &mut program, "tipstrike", &mut script);
        streams.output.write_all(&script)?;
        Ok(Exit::Done)
    }
}

/// The options of the command.
#[derive(Debug, Args)]
pub struct Man {
    /// The page of this command
    pub command: Option<String>,
}

impl Man {
    pub(super) fn run(&self, program: clap::Command, streams: &mut Streams) -> Done {
        let page = page(self.command.as_deref(), program).ok_or_else(|| {
            Failure::usage(format!(
                "man: there is no command {}: `tipstrike help` lists them",
                self.command.as_deref().unwrap_or_default()
            ))
        })?;
        let source = format!("tipstrike {}", env!("CARGO_PKG_VERSION"));
        clap_mangen::Man::new(page).source(source).render(&mut streams.output)?;
        exit_status(streams.output.as_mut())?;
        Ok(Exit::Done)
    }
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
