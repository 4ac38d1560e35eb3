//! Options that several commands share: changes of the case, quantities, formats, files, threads.

use std::ffi::OsStr;
use std::path::{Path, PathBuf};

use super::{Done, Failure, Opened, Streams, check_out, each, file_of, open};
use crate::case::{Case, Problem, quantity};
use crate::model::inputs::Method;
use crate::model::{QUANTITIES, Quantity};
use crate::report::page::{format_of, is_picture};
use crate::study::batch::Control;
use crate::study::seek::distinct;
use crate::study::shard::{Format, Shard};
use clap::builder::{PossibleValue, PossibleValuesParser, TypedValueParser};
use clap::error::{Error, ErrorKind};
use clap::{Arg, Args, ValueEnum};

/// Formats of words and objects.
pub(super) const WORDS: &[Format] = &[Format::Text, Format::Json];
/// Formats of words, objects and tables.
pub(super) const TABLES: &[Format] = &[Format::Text, Format::Json, Format::Csv];

/// Parser of the formats of a command.
pub(super) fn formats(formats: &[Format]) -> impl TypedValueParser<Value = Format> + use<> {
    let values = formats.iter().filter_map(ValueEnum::to_possible_value);
    PossibleValuesParser::new(values).try_map(|name| Format::from_str(&name, false))
}

/// The selected quantities.
#[derive(Debug, Args)]
pub(super) struct Only {
    /// Compute only these quantities, by name or symbol, and run only the stages that they need;
    /// `tipstrike fields --results` lists them
    #[arg(long, value_name = "QUANTITY,...", hide_possible_values = true, value_parser = Quantities)]
    pub only: Vec<Vec<&'static Quantity>>,
}

impl Only {
    /// The quantities without duplicates; empty if the user names none.
    pub(super) fn quantities(&self) -> Vec<&'static Quantity> {
        distinct(self.only.iter().flatten().copied())
    }
}

/// The number of threads.
#[derive(Debug, Clone, Copy, Args)]
pub struct Threads {
    /// Number of threads (default: one per core); does not change the output
    #[arg(long, value_name = "N", allow_negative_numbers = true, value_parser = jobs)]
    pub jobs: Option<u16>,
}

impl Threads {
    /// The control of a study that reports to `go_on`.
    pub fn control<'a>(&self, go_on: &'a dyn Fn(usize, usize) -> bool) -> Control<'a> {
        Control { jobs: self.jobs.map(usize::from), go_on }
    }
}

/// Options of a study whose points can be divided among machines.
#[derive(Debug, Args)]
pub(super) struct StudyOptions {
    /// The threads
    #[command(flatten)]
    pub threads: Threads,
    /// Solve only part I of N equal parts, such as 3/8, for `tipstrike gather`
    #[arg(long, value_name = "I/N", value_parser = Shard::parse)]
    pub shard: Option<Shard>,
    /// The file
    #[command(flatten)]
    pub destination: Destination,
}

/// Parses a number of threads.
fn jobs(text: &str) -> Result<u16, String> {
    let count = text.trim().parse().ok().filter(|count| (1..=1024).contains(count));
    count.ok_or_else(|| "write a whole number from 1 to 1024".to_owned())
}

/// Parses a number of points or samples.
pub(super) fn count(text: &str) -> Result<usize, String> {
    text.trim().parse().map_err(|_| "write a whole number, such as 101".to_owned())
}

/// A usage error with one line.
fn misused(cause: String) -> Error {
    Error::raw(ErrorKind::ValueValidation, cause + "\n")
}

/// Values that replace those of a case: those of a variant first, then single fields.
#[derive(Debug, Clone, Default, PartialEq, Eq, Args)]
pub(super) struct Edits {
    /// Use this variant of the case, a table [variants.NAME]
    #[arg(long, value_name = "NAME")]
    pub variant: Option<String>,
    /// Change a field of the case, such as "operation.speed=3000 rpm"
    #[arg(long = "set", value_name = "KEY=VALUE", value_parser = Settings)]
    pub settings: Vec<Setting>,
}

/// The method and the values that replace those of a case.
#[derive(Debug, Args)]
pub(super) struct Changes {
    /// Use this method instead of the method of the case
    #[arg(long, value_parser = methods())]
    method: Option<Method>,
    /// The values
    #[command(flatten)]
    edits: Edits,
}

impl Changes {
    /// The variant and the fields; the method is the last field.
    pub(super) fn edits(&self) -> Edits {
        let mut edits = self.edits.clone();
        edits.settings.extend(by_method(self.method));
        edits
    }
}

/// `--method` as a setting of a field.
pub(in crate::cli) fn by_method(method: Option<Method>) -> Option<Setting> {
    method.map(|method| Setting::new("model.method", method.name()))
}

/// A field and its new value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Setting {
    /// The key of the field or limit.
    pub key: String,
    /// The new text of the field.
    pub value: String,
}

impl Setting {
    pub(super) fn new(key: &str, value: &str) -> Setting {
        Setting { key: key.to_owned(), value: value.to_owned() }
    }

    /// The setting in the syntax of the command line.
    pub(super) fn written(&self) -> String {
        format!("--set {}={}", self.key, self.value)
    }
}

/// Parser of a field and its value; checks each separately.
#[derive(Clone)]
pub(in crate::cli) struct Settings;

impl TypedValueParser for Settings {
    type Value = Setting;

    fn parse_ref(
        &self,
        _: &clap::Command,
        _: Option<&Arg>,
        value: &OsStr,
    ) -> Result<Setting, Error> {
        let text = value.to_string_lossy();
        setting(&text).map_err(|cause| misused(format!("--set {text}: {cause}")))
    }
}

/// Parses a setting and checks that the field accepts the value in some case.
fn setting(text: &str) -> Result<Setting, String> {
    let (key, value) = text
        .split_once('=')
        .ok_or("no value is given: write KEY=VALUE, such as \"operation.speed=3000 rpm\"")?;
    Case::empty()
        .set(key.trim(), value)
        .map_err(|problem| format!("{}: {}", problem.cause, problem.fix))?;
    Ok(Setting::new(key.trim(), value))
}

/// Parses a number of stations.
pub(in crate::cli) fn station_count(text: &str) -> Result<String, String> {
    setting(&format!("model.stations={text}")).map(|setting| setting.value)
}

pub(in crate::cli) fn methods() -> impl TypedValueParser<Value = Method> {
    PossibleValuesParser::new(Method::ALL.map(Method::name)).try_map(|name| {
        Method::ALL.into_iter().find(|method| method.name() == name).ok_or("no such method")
    })
}

/// Parser of a comma-separated list of quantities by name or symbol; a comma may be part of a
/// symbol, as in `F_d,max`.
#[derive(Clone)]
pub(in crate::cli) struct Quantities;

impl TypedValueParser for Quantities {
    type Value = Vec<&'static Quantity>;

    fn parse_ref(
        &self,
        _: &clap::Command,
        argument: Option<&Arg>,
        value: &OsStr,
    ) -> Result<Self::Value, Error> {
        let option = argument.and_then(Arg::get_long);
        let option = option.map_or("QUANTITY".to_owned(), |long| format!("--{long}"));
        let known = |name: String| {
            quantity("", &name)
                .map_err(|Problem { cause, fix, .. }| misused(format!("{option}: {cause}: {fix}")))
        };
        names(&value.to_string_lossy()).into_iter().map(known).collect()
    }

    fn possible_values(&self) -> Option<Box<dyn Iterator<Item = PossibleValue> + '_>> {
        Some(Box::new(Quantity::all().map(|quantity| PossibleValue::new(quantity.key))))
    }
}

/// Parser of one quantity.
pub(in crate::cli) fn one_quantity() -> impl TypedValueParser<Value = &'static Quantity> {
    Quantities.try_map(|found| match found[..] {
        [quantity] => Ok(quantity),
        _ => Err("name one quantity"),
    })
}

/// The names in a list: a part that continues a symbol is joined with the previous part.
fn names(list: &str) -> Vec<String> {
    let is_symbol = |name: &str| {
        let mut symbols = QUANTITIES.iter().map(|quantity| quantity.symbol);
        symbols.any(|symbol| symbol.eq_ignore_ascii_case(name)) || quantity("", name).is_ok()
    };
    let mut names: Vec<String> = Vec::new();
    for part in list.split(',').map(str::trim) {
        let joined = names.last().map(|before| format!("{before},{part}"));
        match joined.filter(|joined| is_symbol(joined)) {
            Some(joined) => {
                names.pop();
                names.push(joined);
            }
            None => names.push(part.to_owned()),
        }
    }
    names
}

/// Any number of cases, all with the same changes.
#[derive(Debug, Args)]
pub(super) struct Cases {
    /// Case files; - is standard input
    #[arg(required = true, value_name = "CASE")]
    pub cases: Vec<PathBuf>,
    /// The changes of each case
    #[command(flatten)]
    pub changes: Changes,
}

impl Cases {
    /// Opens each case, with one more setting if there is one, and runs a command on it.
    pub(super) fn each(
        &self,
        more: Option<Setting>,
        streams: &mut Streams,
        mut run: impl FnMut(&Opened, &mut Streams) -> Done,
    ) -> Done {
        let mut edits = self.changes.edits();
        edits.settings.extend(more);
        each(&self.cases, streams, |path, streams| run(&open(path, &edits, &[], streams)?, streams))
    }
}

/// One case.
#[derive(Debug, Args)]
pub(super) struct CaseFile {
    /// Case file; - is standard input
    #[arg(value_name = "CASE")]
    pub case: PathBuf,
    /// The changes of the case
    #[command(flatten)]
    pub changes: Changes,
}

/// The file for the output.
#[derive(Debug, Args)]
pub(super) struct Destination {
    /// File to write (default: standard output); replaces an existing file
    #[arg(long, value_name = "FILE")]
    pub out: Option<PathBuf>,
}

impl Destination {
    /// Refuses a file that the command reads or that cannot be written, before long work starts.
    pub(super) fn check(&self, input: &Path) -> Result<(), Failure> {
        check_out(self.out.as_deref(), &[input])
    }

    /// The format of the output: that of `--format`, otherwise that of the extension of the file,
    /// otherwise the first of `formats`. `None` is a picture.
    pub(super) fn format(
        &self,
        given: Option<Format>,
        formats: &[Format],
        is_drawn: bool,
    ) -> Result<Option<Format>, Failure> {
        let (formats, is_drawn) = match &given {
            Some(given) => (std::slice::from_ref(given), false),
            None => (formats, is_drawn),
        };
        let file = file_of(self.out.as_deref());
        let Some(file) = file.filter(|file| file.extension().is_some()) else {
            return Ok(formats.first().copied());
        };
        if is_drawn && is_picture(file) {
            return Ok(None);
        }
        let is_text = file.extension().is_some_and(|ending| ending.eq_ignore_ascii_case("txt"));
        let named = format_of(file).or(is_text.then_some(Format::Text));
        if named.is_some_and(|named| formats.contains(&named)) {
            return Ok(named);
        }
        let picture = is_drawn.then_some(".svg");
        let endings = formats.iter().map(|format| format.extension()).chain(picture);
        let (file, endings) = (file.display(), endings.collect::<Vec<_>>().join(", "));
        Err(Failure::usage(match given {
            Some(_) => format!(
                "--out {file}: --format selects another format: use the extension {endings}, or \
                 leave --format out"
            ),
            None => format!(
                "--out {file}: the command does not write this format: use the extension {endings}"
            ),
        }))
    }
}

impl StudyOptions {
    /// The format of the results. The file of a shard has any extension; that of a format selects it.
    pub(super) fn format(
        &self,
        given: Option<Format>,
        formats: &[Format],
        is_drawn: bool,
    ) -> Result<Option<Format>, Failure> {
        match self.shard {
            Some(_) => {
                let named = || self.destination.format(None, formats, false).ok().flatten();
                Ok(given.or_else(named).or(formats.first().copied()))
            }
            None => self.destination.format(given, formats, is_drawn),
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_setting_is_split_at_the_first_equals_sign() {
        assert_eq!(setting("title=a=b"), Ok(Setting::new("title", "a=b")));
        assert!(setting("pair.modul=5 mm").unwrap_err().contains("did you mean pair.module?"));
        assert!(setting("pair.module").unwrap_err().contains("KEY=VALUE"));
    }

    #[test]
    fn a_comma_in_a_symbol_does_not_end_a_name() {
        assert_eq!(
            names("F_d,max, F_d,DE,impact_force,F_S,T_S,32"),
            ["F_d,max", "F_d,DE", "impact_force", "F_S", "T_S,32"]
        );
        let list = QUANTITIES.iter().map(|quantity| quantity.symbol);
        assert!(list.clone().eq(names(&list.collect::<Vec<_>>().join(","))));
    }

    #[test]
    fn a_symbol_may_be_in_ascii_and_a_field_is_named_as_one() {
        for name in ["K_Hβ", "K_Hbeta", "K_Hb", "KHbeta"] {
            assert_eq!(quantity("", name).map(|known| known.key), Ok("face_load_factor"), "{name}");
        }
        assert_eq!(names("dV_tau,E,epsilon_beta"), ["dV_tau,E", "epsilon_beta"]);
        let refused = quantity("", "torque").unwrap_err().to_string();
        assert!(refused.contains("`torque` is the field operation.torque"), "{refused}");
    }
}
