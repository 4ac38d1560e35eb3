//! The headless commands: results to the output, messages to the errors, and an exit code for
//! scripts.

mod commands;
pub mod options;
pub mod questions;

use std::cell::Cell;
use std::ffi::OsString;
use std::fmt;
use std::io::{self, BufWriter, ErrorKind, IsTerminal, Write};
use std::path::{Path, PathBuf};
use std::process::ExitCode;
use std::sync::LazyLock;
use std::time::{Duration, Instant};

use crate::case::fields::FIELDS;
use crate::case::file::{Draft, MOST_MODEL_BYTES, ReadError, SaveError, read_bytes};
use crate::case::rexs::{self, Imported};
use crate::case::sanitize::{sanitize, suggestion};
use crate::case::{Acting, Case, Document, Problem, partial_relevance, relevance};
use crate::model::{Inputs, Quantity, Refusal};
use crate::report::solve::Unsolved;
use crate::report::table::{Named, Results};
use crate::study::seek::distinct;
use crate::study::shard::Format;
use crate::system::files::is_same;
use crate::system::interrupt::Interrupt;
use clap::{CommandFactory, FromArgMatches, Parser};
pub use commands::Command;
use indicatif::{
    HumanDuration, HumanFloatCount, ProgressBar, ProgressDrawTarget, ProgressState, ProgressStyle,
};
use options::{CaseFile, Edits, Setting};
use questions::Misuse;

/// The streams of a command.
pub struct Streams<'a> {
    /// Stream of the results.
    pub output: Box<dyn Write + 'a>,
    /// Stream of the messages.
    pub errors: Box<dyn Write + 'a>,
}

impl Streams<'static> {
    /// The streams of the process.
    pub fn standard() -> Streams<'static> {
        Streams { output: Box::new(BufWriter::new(io::stdout())), errors: Box::new(io::stderr()) }
    }
}

impl Streams<'_> {
    /// Writes one message line. Ignores a closed error stream.
    fn say(&mut self, message: &str) {
        let _ = writeln!(self.errors, "{}", sanitize(message));
    }

    fn say_all<T: AsRef<str>>(&mut self, messages: impl IntoIterator<Item = T>) {
        messages.into_iter().for_each(|message| self.say(message.as_ref()));
    }
}

/// Reports that the workbench needs another system.
pub fn refuse_workbench(streams: &mut Streams) -> Exit {
    streams.say(
        "tipstrike: the workbench needs Linux, macOS or another Unix; on this system: tipstrike \
         solve CASE",
    );
    Exit::Usage
}

/// Parses the command line.
///
/// # Errors
/// The exit code if there is nothing to run: after help, for wrong usage, or without the named case.
pub fn parse(
    arguments: impl IntoIterator<Item = OsString>,
    streams: &mut Streams,
) -> Result<Arguments, Exit> {
    let arguments: Vec<OsString> = arguments.into_iter().collect();
    let matches = Arguments::command().try_get_matches_from(&arguments);
    if let Some(line) = matches.as_ref().err().and_then(|error| no_command(error, &arguments)) {
        streams.say(&line);
        return Err(Exit::Usage);
    }
    let parsed = matches.and_then(|matches| Arguments::from_arg_matches(&matches));
    if let Ok(Arguments { case: Some(case), .. }) = &parsed
        && case.as_os_str() != "-"
        && matches!(case.try_exists(), Ok(false))
    {
        streams.say(&format!(
            "error: {0}: there is no such case: `tipstrike new {0}` writes one, `tipstrike help` \
             lists the commands",
            case.display()
        ));
        return Err(Exit::Unreadable);
    }
    parsed.map_err(|error| {
        let text = error.render().to_string();
        if error.use_stderr() {
            // Cause, values and tip; usage and the way to the help follow.
            let is_of_cause =
                |line: &&str| !line.starts_with("Usage:") && !line.starts_with("For more");
            let lines = text.lines().take_while(is_of_cause).map(str::trim);
            streams.say(&lines.filter(|line| !line.is_empty()).collect::<Vec<_>>().join(" "));
            return Exit::Usage;
        }
        let printed = streams.output.write_all(text.as_bytes());
        finish(printed.map(|()| Exit::Done).map_err(Failure::Stream), streams)
    })
}

/// The message for a first word that looks like a mistyped command.
fn no_command(error: &clap::Error, arguments: &[OsString]) -> Option<String> {
    let first = arguments.get(1)?.to_str().filter(|first| !first.starts_with('-'))?;
    let command = Arguments::command();
    let is_command =
        command.get_subcommands().any(|known| known.get_name() == first) || first == "help";
    let is_case = Path::new(first).extension().is_some() || Path::new(first).exists();
    if error.kind() != clap::error::ErrorKind::ArgumentConflict || is_command || is_case {
        return None;
    }
    let known =
        command.get_subcommands().map(|known| known.get_name().to_owned()).collect::<Vec<_>>();
    let fix = suggestion(first, known.iter().map(String::as_str), || {
        "`tipstrike help` lists the commands".to_owned()
    });
    Some(format!("error: {first}: there is no such command: {fix}"))
}

/// Runs a command.
pub fn run(command: &Command, streams: &mut Streams) -> Exit {
    let done = command.run(streams);
    finish(done, streams)
}

/// The exit code; reports a failure. A reader that closes the output (`| head -1`) is not a failure.
fn finish(done: Done, streams: &mut Streams) -> Exit {
    let flushed = done.and_then(|exit| Ok(streams.output.flush().map(|()| exit)?));
    match flushed {
        Ok(exit) => exit,
        Err(Failure::Reported(exit, lines)) => {
            streams.say_all(lines);
            exit
        }
        Err(Failure::Stream(error)) if error.kind() == ErrorKind::BrokenPipe => Exit::Done,
        Err(Failure::Stream(error)) => {
            streams.say(&format!("standard output: cannot be written: {error}"));
            Exit::Unreadable
        }
        Err(Failure::Interrupted) => {
            Interrupt::end();
            Exit::Unreadable
        }
    }
}

/// The version; a release includes its commit (`build.rs`).
static VERSION: LazyLock<String> = LazyLock::new(|| {
    let version = env!("CARGO_PKG_VERSION");
    let commit = option_env!("TIPSTRIKE_COMMIT");
    commit.map_or_else(|| version.to_owned(), |commit| format!("{version} ({commit})"))
});

/// Compute corner contact in spur and helical gear pairs: position, force and duration of the tip impact
#[derive(Debug, Parser)]
#[command(name = "tipstrike", version = VERSION.as_str(), args_conflicts_with_subcommands = true, after_help = exit_codes())]
pub struct Arguments {
    /// Case to open in the workbench (default: the last case, or Table 1 of Zhou & Chen 2014)
    pub case: Option<PathBuf>,
    /// The headless command; without one the workbench starts.
    #[command(subcommand)]
    pub command: Option<Command>,
}

fn exit_codes() -> String {
    let codes = Exit::MEANINGS.map(|(exit, meaning)| format!("{} {meaning}", exit as u8));
    format!(
        "Exit: {}.\n\nEnvironment: NO_COLOR switches colours off; without UTF-8 in the locale \
         (LC_ALL, LC_CTYPE, LANG) the workbench is ASCII.",
        codes.join("; ")
    )
}

/// A case that is ready to solve.
struct Opened {
    /// The name as the user gave it.
    name: String,
    document: Document,
    inputs: Inputs,
    /// The changes of the command line.
    edits: Edits,
}

impl Opened {
    /// Tells method `auto` to compute these quantities, which the user names.
    fn need(&mut self, quantities: impl IntoIterator<Item = &'static Quantity>) {
        let stages = quantities.into_iter().map(|quantity| quantity.stage);
        self.inputs = self.inputs.clone().needing(stages);
    }

    /// Why a varied field changes no result, or only some of them.
    fn without_effect(&self, field: usize, inputs: &Inputs) -> Option<String> {
        let (name, key) = (&self.name, FIELDS[field].key);
        match relevance(field, inputs) {
            Acting::Yes => {
                partial_relevance(field, inputs).map(|why| format!("{name}: {key}: {why}"))
            }
            Acting::No(why) | Acting::Beside(why) => {
                Some(format!("{name}: {key} changes no quantity: {why}"))
            }
        }
    }

    /// Writes results of the case to the file, or to standard output.
    fn write(
        &self,
        results: &dyn Results,
        format: Format,
        out: Option<&Path>,
        streams: &mut Streams,
    ) -> Done {
        write_to(out, streams, |sink| self.named().write(results, format, sink))
    }

    fn named(&self) -> Named<'_> {
        Named { name: &self.name, title: self.document.case.title() }
    }

    /// The case, to solve for a report or a picture.
    fn unsolved(&self) -> Unsolved<'_> {
        Unsolved { name: &self.name, case: &self.document.case, inputs: &self.inputs }
    }

    /// A refusal of the model at the field that its fix names first.
    fn refused(&self, refusal: &Refusal) -> Failure {
        self.faulty(Problem::from(refusal).at_given(&self.document.case))
    }

    /// Why a study of the case has no result.
    fn failed(&self, reason: &impl fmt::Display) -> Failure {
        Failure::of_case(&self.name, reason)
    }

    /// A problem of the case at its place.
    fn faulty(&self, problem: Problem) -> Failure {
        Failure::new(Exit::BadCase, placed(&self.document, problem, &self.edits))
    }
}

impl CaseFile {
    /// Opens the case. `varied` has the index of each field that a study varies, with one of its
    /// values.
    fn open(&self, varied: &[(usize, String)], streams: &mut Streams) -> Result<Opened, Failure> {
        open(&self.case, &self.changes.edits(), varied, streams)
    }
}

/// Runs a command on each case and reports its failures. The exit code is the greatest of all.
fn each(
    paths: &[PathBuf],
    streams: &mut Streams,
    mut run: impl FnMut(&Path, &mut Streams) -> Done,
) -> Done {
    paths.iter().try_fold(Exit::Done, |worst, path| match run(path, streams) {
        Ok(exit) => Ok(worst.max(exit)),
        Err(Failure::Reported(exit, lines)) => {
            streams.say_all(&lines);
            Ok(worst.max(exit))
        }
        Err(failure) => Err(failure),
    })
}

/// Reads a case and applies the changes of the command line. `varied` has the index of each field
/// that a study varies, with one of its values for a case that lacks them.
fn open(
    path: &Path,
    edits: &Edits,
    varied: &[(usize, String)],
    streams: &mut Streams,
) -> Result<Opened, Failure> {
    for (field, _) in varied {
        keep_varied(&edits.settings, FIELDS[*field].key)?;
    }
    let mut document = read(path, streams)?;
    for (field, value) in varied {
        if document.case.effective(*field).is_none() {
            // An invalid value is reported later with its point.
            drop(document.case.set(FIELDS[*field].key, value));
        }
    }
    changed(path.display().to_string(), document, edits)
}

/// Refuses to set a field that a study varies.
fn keep_varied(settings: &[Setting], key: &str) -> Result<(), Failure> {
    let is_varied =
        |setting: &&Setting| key == setting.key || Case::are_exclusive(key, &setting.key);
    let Some(setting) = settings.iter().find(is_varied) else { return Ok(()) };
    let written = setting.written();
    Err(Failure::usage(format!("{written}: --vary replaces this value: leave one of them out")))
}

/// Reads a case that may lack values, or the first stage of a model.
fn read(path: &Path, streams: &mut Streams) -> Result<Document, Failure> {
    if rexs::is_model(path) {
        return Ok(read_model(path, None, streams)?.document);
    }
    Ok(Document::read_draft(path)?)
}

/// Reads a stage of a model, and reports the stages and the empty fields.
fn read_model(
    path: &Path,
    stage: Option<&str>,
    streams: &mut Streams,
) -> Result<Imported, Failure> {
    let bytes = read_bytes(path, MOST_MODEL_BYTES)?;
    let imported = rexs::import(path, &bytes, stage)
        .map_err(|refusal| Failure::new(Exit::BadCase, refusal))?;
    let name = path.display();
    for stage in &imported.stages {
        let mark = if stage.id == imported.stage { ", imported" } else { "" };
        streams.say(&format!("{name}: stage {}: {}{mark}", stage.label(), stage.kind));
    }
    for remark in &imported.remarks {
        streams.say(&format!("{name}: {remark}"));
    }
    let reasons = distinct(imported.absent.iter().map(|(_, reason)| reason));
    let empty = reasons.into_iter().map(|reason| {
        let fields = imported.absent.iter().filter(|(_, own)| own == reason);
        let fields: Vec<&str> = fields.map(|(field, _)| *field).collect();
        format!("{} ({reason})", fields.join(", "))
    });
    let empty: Vec<String> = empty.collect();
    if !empty.is_empty() {
        streams.say(&format!("{name}: fields that stay empty: {}", empty.join("; ")));
    }
    Ok(imported)
}

/// A document with the changes of the command line.
fn changed(name: String, mut document: Document, edits: &Edits) -> Result<Opened, Failure> {
    edit(&mut document, edits)?;
    match document.case.inputs() {
        Ok(inputs) => {
            Ok(Opened { name: named(name, edits), document, inputs, edits: edits.clone() })
        }
        Err(mut problems) => {
            problems.sort_by_key(|problem| document.place(&problem.field));
            let lines = problems.into_iter().map(|problem| placed(&document, problem, edits));
            Err(Failure::Reported(Exit::BadCase, lines.collect()))
        }
    }
}

/// The name of a case with its variant.
fn named(name: String, edits: &Edits) -> String {
    match &edits.variant {
        Some(variant) => format!("{name}:{variant}"),
        None => name,
    }
}

/// Applies the variant and the settings to the case.
fn edit(document: &mut Document, edits: &Edits) -> Result<(), Failure> {
    if let Some(name) = &edits.variant {
        let variant = document.case.variant(name).cloned().map_err(|problem| {
            let option = format!("{}, --variant", document.name());
            Failure::of_option(&option, name, &problem)
        })?;
        document.case = document.case.with(&variant);
    }
    let settings = &edits.settings;
    for (index, setting) in settings.iter().enumerate() {
        let is_partner = |other: &&Setting| Case::are_exclusive(&other.key, &setting.key);
        if let Some(other) = settings[..index].iter().find(is_partner) {
            let (written, key) = (setting.written(), &other.key);
            return Err(Failure::usage(format!(
                "{written}: --set {key} excludes this field: remove one of the two --set options"
            )));
        }
        let set = document.case.set(&setting.key, &setting.value);
        set.map_err(|problem| Failure::usage(on_command_line(setting, &problem)))?;
    }
    Ok(())
}

/// A problem at its place: on the command line for a changed field, otherwise in the file; a
/// changed field may also contradict another field.
fn placed(document: &Document, problem: Problem, edits: &Edits) -> String {
    let settings = &edits.settings;
    if let Some(setting) = settings.iter().rev().find(|setting| setting.key == problem.field) {
        return format!("{}, {}", document.name(), on_command_line(setting, &problem));
    }
    let variant = edits.variant.as_deref();
    // The key of the variant's override, if there is one.
    let own = variant.and_then(|name| document.case.variant(name).ok());
    let own = own.filter(|own| own.overrides(&problem.field));
    let field = own.map_or_else(|| problem.field.clone(), |own| own.place(&problem.field));
    let fault = document.fault(Problem { field, ..problem });
    let variant = variant.map(|name| format!("--variant {name}"));
    let written: Vec<String> =
        variant.into_iter().chain(settings.iter().map(Setting::written)).collect();
    if written.is_empty() {
        fault.to_string()
    } else {
        format!("{fault} (with {})", written.join(" "))
    }
}

fn on_command_line(setting: &Setting, problem: &Problem) -> String {
    format!("{}: {}: {}", setting.written(), problem.cause, problem.fix)
}

impl From<ReadError> for Failure {
    fn from(error: ReadError) -> Failure {
        match error {
            ReadError::Bad(faults) => {
                Failure::Reported(Exit::BadCase, faults.iter().map(ToString::to_string).collect())
            }
            ReadError::NewerFormat(_) => Failure::new(Exit::NewerFormat, error),
            _ => Failure::new(Exit::Unreadable, error),
        }
    }
}

/// A draft that a signal keeps from being completed.
struct Stoppable(Draft, Interrupt);

impl Write for Stoppable {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        if self.1.go_on() {
            self.0.write(bytes)
        } else {
            Err(io::Error::other("a signal ends the program"))
        }
    }

    fn flush(&mut self) -> io::Result<()> {
        self.0.flush()
    }
}

/// The file of `--out`. The name `-` is the stream.
fn file_of(out: Option<&Path>) -> Option<&Path> {
    out.filter(|path| *path != Path::new("-"))
}

/// Refuses a file that the command reads or that cannot be written, before long work starts.
fn check_out(out: Option<&Path>, inputs: &[&Path]) -> Result<(), Failure> {
    let Some(out) = file_of(out) else { return Ok(()) };
    if inputs.iter().any(|input| is_same(input, out)) {
        return Err(Failure::usage(format!(
            "--out {}: this file is read by the command: choose another name",
            out.display()
        )));
    }
    let interrupt = Interrupt::install();
    Draft::check(out)?;
    if interrupt.go_on() { Ok(()) } else { Err(Failure::Interrupted) }
}

/// Writes results with `write` to a file, which appears when it is complete, or to the stream.
fn write_to(
    out: Option<&Path>,
    streams: &mut Streams,
    write: impl FnOnce(&mut dyn Write) -> io::Result<()>,
) -> Done {
    let Some(path) = file_of(out) else {
        write(streams.output.as_mut())?;
        return Ok(Exit::Done);
    };
    let interrupt = Interrupt::install();
    let mut writer = BufWriter::new(Stoppable(Draft::create(path)?, interrupt));
    let written = write(&mut writer).and_then(|()| writer.flush());
    let (Stoppable(draft, interrupt), _) = writer.into_parts();
    match written {
        Ok(()) => draft.finish()?,
        Err(_) if !interrupt.go_on() => return Err(Failure::Interrupted),
        Err(error) => return Err(draft.unwritable(error).into()),
    }
    Ok(Exit::Done)
}

/// Writes a text to a file or to the stream.
fn write_text(out: Option<&Path>, streams: &mut Streams, text: &str) -> Done {
    write_to(out, streams, |sink| sink.write_all(text.as_bytes()))
}

/// Delay before the bar appears.
const QUIET: Duration = Duration::from_secs(1);

/// Runs work with a progress bar on a terminal if it takes long. The work reports the number of
/// completed parts and their total, and stops if the report returns false.
///
/// # Errors
/// [`Failure::Interrupted`] after Ctrl-C.
fn follow<T>(
    what: &'static str,
    work: impl FnOnce(&dyn Fn(usize, usize) -> bool) -> T,
) -> Result<T, Failure> {
    const LINE_ABOVE: &[u8] = b"\x1b[A\x1b[2K";
    let (begun, interrupt) = (Instant::now(), Interrupt::install());
    let (bar, is_up) = (bar(what), Cell::new(false));
    let done = work(&|done, of| {
        if !is_up.get() && begun.elapsed() >= QUIET && io::stderr().is_terminal() {
            is_up.set(true);
            bar.set_draw_target(ProgressDrawTarget::stderr());
        }
        bar.set_length(of as u64);
        bar.set_position(done as u64);
        interrupt.go_on()
    });
    bar.finish_and_clear();
    if interrupt.go_on() {
        return Ok(done);
    }
    // The terminal appends `^C` to the bar, which fills its line: the cursor is on the next line.
    if is_up.get() && interrupt.is_ctrl_c() {
        drop(io::stderr().write_all(LINE_ABOVE));
    }
    Err(Failure::Interrupted)
}

/// A hidden bar; `what` is the name of its parts.
fn bar(what: &'static str) -> ProgressBar {
    let bar = ProgressBar::with_draw_target(None, ProgressDrawTarget::hidden());
    // Before the first part is complete, there is no rate and no estimate.
    let rate = |state: &ProgressState, out: &mut dyn fmt::Write| {
        let (rate, left) = (HumanFloatCount(state.per_sec()), HumanDuration(state.eta()));
        if state.pos() > 0 {
            let _ = write!(out, ", {rate}/s, {left:#} left");
        }
    };
    if let Ok(style) = ProgressStyle::with_template("{bar:30} {human_pos}/{human_len} {msg}{rate}")
    {
        bar.set_style(style.progress_chars("=> ").with_key("rate", rate));
    }
    bar.set_message(what);
    bar
}

/// The exit code of a command; of several, the greatest counts.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
#[repr(u8)]
pub enum Exit {
    /// Success.
    Done = 0,
    /// A case exceeds one of its limits, or the limited quantity has no value.
    Exceeded = 1,
    /// Wrong usage of the command line.
    Usage = 2,
    /// A case is invalid, or the model refuses it.
    BadCase = 3,
    /// A case has a newer format.
    NewerFormat = 4,
    /// A file cannot be read or written.
    Unreadable = 5,
}

impl Exit {
    /// Every exit code with its meaning.
    const MEANINGS: [(Exit, &'static str); 6] = [
        (Exit::Done, "done"),
        (Exit::Exceeded, "check: a limit is exceeded, or its quantity has no value"),
        (Exit::Usage, "wrong usage, or no terminal for the workbench"),
        (Exit::BadCase, "an invalid case, or a case that cannot be solved"),
        (Exit::NewerFormat, "a case of a newer format"),
        (Exit::Unreadable, "a file cannot be read or written"),
    ];
}

impl From<Exit> for ExitCode {
    fn from(exit: Exit) -> ExitCode {
        ExitCode::from(exit as u8)
    }
}

/// The end of a command.
type Done = Result<Exit, Failure>;

/// Why a command stopped early.
enum Failure {
    /// The lines to report.
    Reported(Exit, Vec<String>),
    /// The standard output cannot be written.
    Stream(io::Error),
    /// Ctrl-C stopped the work.
    Interrupted,
}

impl Failure {
    /// A failure with one line.
    fn new(exit: Exit, line: impl fmt::Display) -> Failure {
        Failure::Reported(exit, vec![line.to_string()])
    }

    /// Wrong usage, with the reason.
    fn usage(line: impl fmt::Display) -> Failure {
        Failure::new(Exit::Usage, format!("error: {line}"))
    }

    /// Why a case or a file of results has no result.
    fn of_case(name: &str, reason: &impl fmt::Display) -> Failure {
        Failure::new(Exit::BadCase, format!("{name}: {reason}"))
    }

    /// An option of a question without a valid value.
    fn misused((option, value, problem): &Misuse) -> Failure {
        Failure::of_option(&format!("--{option}"), value, problem)
    }

    /// An invalid value of an option.
    fn of_option(option: &str, value: &str, problem: &Problem) -> Failure {
        let Problem { cause, fix, .. } = problem;
        Failure::usage(format!("{option} {value}: {cause}: {fix}"))
    }
}

impl From<SaveError> for Failure {
    fn from(error: SaveError) -> Failure {
        Failure::new(Exit::Unreadable, error)
    }
}

impl From<io::Error> for Failure {
    fn from(error: io::Error) -> Failure {
        match error.kind() {
            ErrorKind::Interrupted => Failure::Interrupted,
            _ => Failure::Stream(error),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn messages_contain_no_control_characters() {
        let mut said = Vec::new();
        Streams { output: Box::new(io::sink()), errors: Box::new(&mut said) }
            .say("a\u{1b}[2J\u{9b}\nb\u{202e}");
        assert_eq!(String::from_utf8_lossy(&said), "a\\u{1b}[2J\\u{9b}\\nb\\u{202e}\n");
    }

    #[test]
    fn the_options_of_all_commands_fit_together() {
        Arguments::command().debug_assert();
    }
}
