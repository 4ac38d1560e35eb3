//! Reads a case from TOML: finds every key in the table of fields and places every fault.

use std::collections::{BTreeMap, HashMap, HashSet};

use super::{Entry, FORMAT, Layout, MOST, Value, line_start};
use crate::case::check::{MISSING, NEWER_FORMAT};
use crate::case::fields::{AUTO, Absent, FIELDS, Field, GROUPS, Kind, index_of};
use crate::case::sanitize::{cut, quoted, suggestion};
use crate::case::units::{self, Dimension};
use crate::case::{ABOUT, Case, Limit, Override, Problem, Spread, Variant, changes, check, spread};
use crate::model::Quantity;
use toml_edit::TomlError;

/// Common names of the two gears.
const GEARS: [&str; 8] = ["pinion", "wheel", "gear", "gears", "gear1", "gear2", "gear_1", "gear_2"];

const OVERRIDE: &str = "\"driven.tip_relief\" = \"48 um\"";

/// The case of a text and its faults.
pub(super) struct Reading {
    pub(super) case: Case,
    /// The problems at their bytes.
    pub(super) faults: Vec<(usize, Problem)>,
}

impl Reading {
    /// Whether the text is a case that lacks only required values.
    pub(super) fn is_draft(&self) -> bool {
        self.faults.iter().all(|(_, problem)| &*problem.code == MISSING)
    }
}

/// Reads a text. A syntax error and a newer format are reported alone. `is_newer` reads the known
/// part of a text of a newer format.
pub(super) fn read(text: &str, is_newer: bool) -> Reading {
    let refused = |fault| Reading { case: Case::empty(), faults: vec![fault] };
    let layout = match Layout::of(text) {
        Ok(layout) => layout,
        Err(error) => return refused(syntax_fault(&error, text)),
    };
    let mut reader = Reader {
        layout: &layout,
        scopes: vec![Scope::new("", 0)],
        variants: HashMap::new(),
        seen: HashSet::new(),
        distributions: BTreeMap::new(),
        faults: Vec::new(),
    };
    if let Some(newer) = reader.format().filter(|_| !is_newer) {
        return refused(newer);
    }
    for entry in &layout.entries {
        // Further faults are not shown.
        if reader.faults.len() <= MOST {
            reader.entry(entry);
        }
    }
    reader.check();
    let mut case = reader.scopes[0].case.clone();
    let named = reader.scopes[1..].iter().filter(|own| Variant::check_name(&own.name).is_ok());
    case.variants = named.map(|own| Variant::new(&own.name, own.overrides.clone())).collect();
    Reading { case, faults: reader.faults }
}

/// The case itself or one of its variants while it is read.
struct Scope {
    /// The name of a variant. Empty for the case itself.
    name: String,
    /// The place of the name of a variant.
    at: usize,
    case: Case,
    /// The texts as overrides; an empty text removes its key.
    overrides: Vec<Override>,
    /// Fields with invalid values.
    wrong: Vec<usize>,
    has_faults: bool,
}

impl Scope {
    fn new(name: &str, at: usize) -> Scope {
        let (name, case) = (name.to_owned(), Case::empty());
        Scope { name, at, case, overrides: Vec::new(), wrong: Vec::new(), has_faults: false }
    }

    /// A key of the scope as a key of the file.
    fn key(&self, key: &str) -> String {
        match &*self.name {
            "" => key.to_owned(),
            name => format!("{}{name}.{key}", changes::PREFIX),
        }
    }

    /// Writes a text by its key.
    fn give(&mut self, key: String, text: &str) -> Result<(), Problem> {
        self.case.apply(&key, Some(text))?;
        self.overrides.push(Override { key, text: text.to_owned() });
        Ok(())
    }
}

/// The meaning of a key.
enum Target {
    Table,
    Format,
    Field(usize),
    Limit(&'static Quantity),
    /// The distribution of a field.
    Spread(usize),
    /// A text of the table `[about]`.
    About,
    Unknown,
}

struct Reader<'l> {
    layout: &'l Layout,
    /// The case itself, then its variants.
    scopes: Vec<Scope>,
    /// The scopes of the variants by name.
    variants: HashMap<&'l str, usize>,
    /// Keys that have been read, and unknown keys that have been reported.
    seen: HashSet<String>,
    /// The entries of the distribution of a field of a scope, and the number of keys above them.
    distributions: BTreeMap<(usize, usize), (usize, Vec<&'l Entry>)>,
    faults: Vec<(usize, Problem)>,
}

impl<'l> Reader<'l> {
    /// Checks the format. A newer format is the only reported fault.
    fn format(&mut self) -> Option<(usize, Problem)> {
        let Some(entry) = self.layout.value("format") else {
            let fix = format!("begin the file with format = {FORMAT}");
            self.fault(0, 0, Problem::new("format", "the format is missing", fix));
            return None;
        };
        let written = match &entry.value {
            Value::Number(number) => number.parse::<u64>().ok(),
            _ => None,
        };
        let at = entry.span.start;
        match written {
            Some(number) if number == u64::from(FORMAT) => {}
            Some(number) if number > u64::from(FORMAT) => {
                let cause = format!(
                    "format {number} is newer than this version, which reads format {FORMAT}"
                );
                let problem = Problem::new("format", cause, "open it with a newer tipstrike");
                return Some((at, problem.coded(NEWER_FORMAT)));
            }
            _ => {
                let fix = format!("write format = {FORMAT}");
                self.fault(0, at, Problem::new("format", "this format is unknown", fix));
            }
        }
        None
    }

    fn entry(&mut self, entry: &'l Entry) {
        let (scope, above) = match &*entry.path {
            [table, name, ..] if table == "variants" => (self.scope(entry, name), 2),
            _ => (0, 0),
        };
        let (path, start) = (&entry.path[above..], entry.span.start);
        if path.is_empty() {
            if entry.value != Value::Table {
                let place = entry.key();
                let cause = format!("expected a table of overrides, found {}", entry.value.kind());
                let fix = format!("write [{place}] on a line of its own, and {OVERRIDE} below it");
                self.scopes[scope].has_faults = true;
                self.fault(0, start, Problem::new(&place, cause, fix));
            }
            return;
        }
        let (target, depth) = target(path, scope > 0);
        let (key, is_own) = (path[..depth].join("."), depth == path.len());
        let value = if is_own { &entry.value } else { &Value::Table };
        let is_first = self.seen.insert(self.scopes[scope].key(&key));
        if let (Target::Unknown, [shape]) = (&target, &path[depth..])
            && let Some(field) = key.strip_prefix(spread::PREFIX)
            && let Err(problem) = spread::named(shape)
        {
            self.fault(scope, start, problem.at(&spread::place(field)));
        }
        let read = match target {
            Target::Unknown if is_first => {
                return self.fault(scope, entry.key_at(above + depth), unknown(&key));
            }
            Target::Table if is_own && *value != Value::Table => {
                let belongs = |field: &usize| FIELDS[*field].table() == key;
                self.scopes[scope].wrong.extend((0..FIELDS.len()).filter(belongs));
                let cause = format!("expected the table [{key}], found {}", value.kind());
                let fix = format!("write [{key}] on a line of its own, once");
                Err(Problem::new("", cause, fix))
            }
            Target::Spread(field) => {
                let own = self.distributions.entry((scope, field)).or_default();
                own.0 = above + depth;
                own.1.push(entry);
                Ok(())
            }
            Target::Field(_) | Target::Limit(_) if is_own && !is_first => {
                let cause = match scope {
                    0 => format!("the key {} appears twice", quoted(&key)),
                    _ => "the variant overrides this key twice".to_owned(),
                };
                Err(Problem::new("", cause, "keep one of the two"))
            }
            Target::About => self.about(scope, &path[1], value),
            Target::Field(field) if is_first => self.field(scope, field, value),
            Target::Limit(quantity) if is_first => self.limit(scope, quantity, value),
            _ => Ok(()),
        };
        if let Err(problem) = read {
            self.fault(scope, start, problem.at(&key));
        }
    }

    /// The scope of a variant.
    fn scope(&mut self, entry: &Entry, name: &'l str) -> usize {
        let next = self.scopes.len();
        let scope = *self.variants.entry(name).or_insert(next);
        if scope == next {
            let at = entry.key_at(2);
            self.scopes.push(Scope::new(name, at));
            if let Err(problem) = Variant::check_name(name) {
                self.scopes[scope].has_faults = true;
                self.fault(0, at, problem);
            }
        }
        scope
    }

    fn about(&mut self, scope: usize, name: &str, value: &Value) -> Result<(), Problem> {
        match value {
            Value::String(text) | Value::Number(text) | Value::Date(text) => {
                self.scopes[scope].give(format!("{ABOUT}{name}"), text)
            }
            _ => Err(misplaced("a text in quotes", value, "project = \"Mill 7\"")),
        }
    }

    fn field(&mut self, scope: usize, field: usize, value: &Value) -> Result<(), Problem> {
        let (known, own) = (&FIELDS[field], &mut self.scopes[scope]);
        let is_empty = value.is_empty() && !matches!(known.kind, Kind::Text);
        let missing = |cause: &str| Err(Problem::new("", cause, written(known)));
        let text = match known.absent {
            _ if !is_empty => text_of(known, value),
            Absent::Refused | Absent::Either if scope == 0 => return Ok(()),
            Absent::Refused => missing("the case needs this value"),
            _ if scope > 0 => Ok(String::new()),
            _ => missing("the value is missing"),
        };
        let text = text.inspect_err(|_| own.wrong.push(field))?;
        own.give(known.key.to_owned(), &text)
    }

    fn limit(&mut self, scope: usize, quantity: &Quantity, value: &Value) -> Result<(), Problem> {
        let (own, key) = (&mut self.scopes[scope], format!("limits.{}", quantity.key));
        if scope > 0 && value.is_empty() {
            return own.give(key, "");
        }
        let example = format!("{} = {}", quantity.key, limit_by_example(quantity));
        // A limit may be relative to another result, such as "1.3 x mesh_force".
        let is_relative = matches!(value, Value::String(text) if text.contains(" x "));
        let text = number_or_text(value, quantity.unit == "1" && !is_relative, &example)?;
        Limit::new(quantity.key, &text)?;
        own.give(key, &text)
    }

    /// Reads the distributions, each of one shape with a width.
    fn spread(&mut self) {
        let mut all: Vec<_> = std::mem::take(&mut self.distributions).into_iter().collect();
        all.sort_by_key(|(_, (_, entries))| entries[0].start);
        for ((scope, field), (depth, entries)) in all {
            let key = FIELDS[field].key;
            let is_part = |entry: &&&Entry| entry.path.len() > depth || entry.value != Value::Table;
            let mut parts = entries.iter().filter(is_part);
            let only = parts.next().filter(|_| parts.next().is_none());
            let only = only.map(|entry| (&entry.path[depth..], &entry.value));
            let text = match only {
                Some(([], value)) if scope > 0 && value.is_empty() => Ok(String::new()),
                Some(([shape], Value::String(width) | Value::Number(width))) => {
                    Spread::read(key, Some(shape), Some(width)).map(|own| own.text)
                }
                Some(([shape], _)) => Spread::read(key, Some(shape), None).map(|own| own.text),
                _ => Spread::read(key, None, None).map(|own| own.text),
            };
            let own = &mut self.scopes[scope];
            let give = |text: String| own.give(spread::place(key), &text).map_err(|one| vec![one]);
            let read = text.and_then(give);
            for problem in read.err().into_iter().flatten() {
                self.fault(scope, entries[0].span.start, problem);
            }
        }
    }

    /// Checks the values of each scope together.
    fn check(&mut self) {
        self.spread();
        for scope in 0..self.scopes.len() {
            let own = &self.scopes[scope];
            let is_given =
                |&field: &usize| own.case.text(field).is_some() && !own.wrong.contains(&field);
            let problems = if scope == 0 {
                check::read(&own.case, &own.wrong).1
            } else {
                let given = (0..FIELDS.len()).filter(is_given);
                let alone = |field| {
                    [own.case.check_field(field).err(), check::given_twice(&own.case, field)]
                };
                given.flat_map(alone).flatten().collect()
            };
            for problem in problems {
                let key = self.scopes[scope].key(&problem.field);
                self.fault(scope, self.layout.place(&key), problem);
            }
            let own = &self.scopes[scope];
            if scope > 0 && own.overrides.is_empty() && !own.has_faults {
                let place = format!("{}{}", changes::PREFIX, own.name);
                let fix = format!("write an override, such as {OVERRIDE}, or remove the table");
                self.fault(0, own.at, Problem::new(&place, "the variant changes nothing", fix));
            }
        }
    }

    fn fault(&mut self, scope: usize, at: usize, problem: Problem) {
        let own = &mut self.scopes[scope];
        own.has_faults = true;
        let field = own.key(&problem.field);
        self.faults.push((at, problem.at(&field)));
    }
}

/// The meaning of a path, and the number of its keys that decide it.
fn target(path: &[String], is_variant: bool) -> (Target, usize) {
    for depth in 1..=path.len() {
        let key = path[..depth].join(".");
        let target = match key.split_once('.') {
            None if key == "format" && !is_variant => Target::Format,
            Some(("about", _)) if !is_variant && depth > 1 => Target::About,
            Some(("limits", quantity)) => {
                Quantity::find(quantity).map_or(Target::Unknown, Target::Limit)
            }
            Some(("spread", field)) => match index_of(field.trim_matches('"')) {
                Some(field) => Target::Spread(field),
                None if is_group(field) => Target::Table,
                None => Target::Unknown,
            },
            _ => match index_of(&key) {
                Some(field) => Target::Field(field),
                None if is_table(&key)
                    && !(is_variant && ["about", "variants"].contains(&&*key)) =>
                {
                    Target::Table
                }
                None => Target::Unknown,
            },
        };
        if !matches!(target, Target::Table) {
            return (target, depth);
        }
    }
    (Target::Table, path.len())
}

/// The text of a value for a field.
fn text_of(field: &Field, value: &Value) -> Result<String, Problem> {
    let example = check::assignment(field);
    match (field.kind, value) {
        (Kind::Choice(..), Value::Flag(flag)) if field.is_flag() => Ok(flag.to_string()),
        (Kind::Choice(..), _) if field.is_flag() => {
            let cause = format!("expected true or false, found {}", value.kind());
            Err(Problem::new("", cause, "write true or false without quotes"))
        }
        (Kind::Text | Kind::Choice(..), Value::String(text)) => Ok(text.clone()),
        (Kind::Text | Kind::Choice(..), _) => Err(misplaced("a text in quotes", value, &example)),
        (Kind::Count(..), Value::String(text)) if field.takes_auto() && text == AUTO => {
            Ok(text.clone())
        }
        (Kind::List(_), Value::Array(Some(numbers))) => Ok(numbers.clone()),
        (Kind::List(_), _) => Err(misplaced("numbers in brackets", value, &example)),
        _ => number_or_text(value, field.is_bare(), &example),
    }
}

/// The text of a value with its unit, or of a bare number. The unit parser reports a missing unit.
fn number_or_text(value: &Value, is_bare: bool, example: &str) -> Result<String, Problem> {
    match value {
        Value::Number(text) => Ok(text.clone()),
        Value::String(text) if !is_bare => Ok(text.clone()),
        Value::String(text) => {
            let cause = format!("{} is in quotes, and a number is not", quoted(text));
            Err(match text.trim().parse::<f64>() {
                Ok(_) => Problem::new("", cause, "write the number without quotes"),
                Err(_) => Problem::new("", cause, format!("write {example}, without quotes")),
            })
        }
        other => Err(misplaced("a value", other, example)),
    }
}

fn misplaced(due: &str, value: &Value, example: &str) -> Problem {
    let cause = format!("expected {due}, found {}", value.kind());
    Problem::new("", cause, format!("write {example}"))
}

fn written(field: &Field) -> String {
    format!("write {}", check::assignment(field))
}

fn is_group(name: &str) -> bool {
    !name.is_empty() && GROUPS.iter().any(|(group, _)| *group == name)
}

fn is_table(name: &str) -> bool {
    matches!(name, "about" | "limits" | "spread" | "variants") || is_group(name)
}

/// An example of a limit of the quantity.
fn limit_by_example(quantity: &Quantity) -> String {
    match quantity.shown {
        _ if quantity.is_flag() => "0".to_owned(),
        "1" => "1.5".to_owned(),
        "N" => "\"2500 N\"".to_owned(),
        unit => format!("\"1 {unit}\""),
    }
}

/// The refusal of an unknown key with the most likely name.
fn unknown(key: &str) -> Problem {
    let elsewhere = |name: &str| FIELDS.iter().find(|field| field.name() == name);
    match key.split_once('.') {
        None if key == "format" => {
            Problem::new(key, "a variant has the format of its case", "remove this key")
        }
        None => {
            let tables = GROUPS.iter().map(|(table, _)| *table).filter(|table| !table.is_empty());
            let known =
                tables.chain(["limits", "spread", "variants", "about", "format", "title", "notes"]);
            let fix = match elsewhere(key) {
                _ if GEARS.contains(&key.to_lowercase().as_str()) => {
                    "the gears are [driver] and [driven], whatever their sizes".to_owned()
                }
                Some(field) => format!("put it under [{}]", field.table()),
                None => suggestion(key, known, || "remove it".to_owned()),
            };
            Problem::new(key, format!("unknown key or table {}", quoted(key)), fix)
        }
        Some(("limits", quantity)) => check::unknown_quantity(key, quantity),
        Some(("spread", field)) => {
            Problem { field: spread::place(field), ..check::unknown_key(field) }
        }
        Some((table, name)) if is_group(table) => {
            let here = || FIELDS.iter().filter(|field| field.table() == table).map(Field::name);
            let all = || format!("[{table}] has {}", here().collect::<Vec<_>>().join(", "));
            let fix = match elsewhere(name) {
                Some(field) => format!("it belongs under [{}]", field.table()),
                None => suggestion(name, here(), all),
            };
            Problem::new(key, format!("unknown key {}", quoted(name)), fix)
        }
        Some(_) => check::unknown_key(key),
    }
}

/// The first syntax error of a text: in terms of a case if its line belongs to a field, otherwise in
/// terms of TOML.
fn syntax_fault(error: &TomlError, source: &str) -> (usize, Problem) {
    let span = error.span().unwrap_or(source.len()..source.len());
    let at = (0..=span.start).rev().find(|&at| source.is_char_boundary(at)).unwrap_or_default();
    let start = line_start(source, at);
    let (above, text) = (&source[..start], source[start..].lines().next().unwrap_or_default());
    let named = key_and_value(text);
    let field = named.and_then(|(key, _)| field_of(above, key));
    let name = field.map_or("toml", |field| field.key);
    let is_control = |c: &char| c.is_control() && !matches!(c, '\t' | '\r');
    if let Some((offset, control)) = text.char_indices().find(|(_, c)| is_control(c)) {
        let cause = format!("control character {} in the text", quoted(&control.to_string()));
        return (start + offset, Problem::new(name, cause, "remove it"));
    }
    let message = error.message();
    if message == "duplicate key" {
        return (at, twice(above, text, source.get(span).unwrap_or_default()));
    }
    if let (Some(field), Some((_, value))) = (field, named)
        && let Some(problem) = mistaken(field, value)
    {
        let offset = value.as_ptr() as usize - text.as_ptr() as usize;
        return (start + offset, problem);
    }
    if let (None, Some((key, _))) = (field, text.split_once(':'))
        && let Some(field) = field_of(above, key.trim())
    {
        let problem = Problem::new(field.key, "`:` instead of `=`", written(field));
        return (start + key.len(), problem);
    }
    if let Some((key, _)) = named
        && above.rsplit('[').next().is_some_and(|table| table.starts_with("limits]"))
        && check::quantity("", key).is_ok_and(|known| known.key != key)
    {
        return (start, check::unknown_quantity("limits", key));
    }
    let cause = message.split(", expected").next().unwrap_or(message);
    let known = FIXES.iter().find(|(part, _)| message.contains(part));
    (at, Problem::new(name, cause, known.map_or("write valid TOML", |(_, fix)| *fix)))
}

/// The key and the value of a line without its comment.
fn key_and_value(line: &str) -> Option<(&str, &str)> {
    let (key, value) = line.split_once('=')?;
    let comment = value.find(" #").unwrap_or(value.len());
    Some((key.trim(), value[..comment].trim()))
}

/// The field of a key below these lines.
fn field_of(above: &str, key: &str) -> Option<&'static Field> {
    let header = above.lines().rev().find_map(|line| line.trim().strip_prefix('['));
    let table = header.map_or("", |rest| rest.split(']').next().unwrap_or_default().trim());
    let table = match table.strip_prefix("variants.") {
        Some(variant) => variant.split_once('.').map_or("", |(_, table)| table),
        None => table,
    };
    let key = key.trim_matches('"');
    let path = if table.is_empty() { key.to_owned() } else { format!("{table}.{key}") };
    index_of(&path).map(|index| &FIELDS[index])
}

/// The most likely mistake in a field's value: missing quotes, a missing point, or a missing value.
fn mistaken(field: &Field, value: &str) -> Option<Problem> {
    let problem = |cause: String, fix: String| Some(Problem::new(field.key, cause, fix));
    if value.is_empty() {
        return problem("no value after `=`".to_owned(), written(field));
    }
    if value.contains(['"', '\'', '[', '{']) {
        return None;
    }
    let index = index_of(field.key)?;
    match (check::field_value(index, value), units::parse(value, Dimension::Number, "")) {
        _ if field.is_flag() => problem(
            format!("{} is neither true nor false", quoted(value)),
            "write true or false".to_owned(),
        ),
        (Ok(_), Ok(number)) if field.is_bare() && value != AUTO => problem(
            format!("{} is not how TOML writes a number", quoted(value)),
            format!("write {}", units::text(number, "")),
        ),
        (Err(problem), _) if !field.is_choice() => Some(problem),
        _ if value.starts_with(|c: char| c.is_ascii_digit()) && field.is_choice() => None,
        _ => problem(
            format!("{} is not in quotes", quoted(value)),
            format!("write \"{}\"", cut(value)),
        ),
    }
}

/// Fixes of TOML errors, by a part of the error message.
const FIXES: [(&str, &str); 10] = [
    ("overflowed", "write a smaller number"),
    ("unclosed", "close it with its bracket ], or } for an inline table"),
    ("recurs", "a case has no nested arrays"),
    ("key with no value", "write key = value, or # in front of a comment"),
    ("invalid unquoted key", "a key has only letters, digits, - and _"),
    ("string values must be quoted", "put the value between quotes"),
    ("escape", "write \\\\ for a backslash, or put the text between single quotes"),
    ("basic string", "close the string with the quotes of its beginning"),
    ("literal string", "close the string with the quotes of its beginning"),
    ("unexpected key or value", "only a # comment may follow a value on its line"),
];

/// A key or table that occurs twice.
fn twice(above: &str, line: &str, name: &str) -> Problem {
    if line.trim_start().starts_with('[') {
        let cause = format!("the table {} appears twice", quoted(name));
        return Problem::new(name, cause, "put its keys under one header");
    }
    let field = field_of(above, name).map_or(name, |field| field.key);
    let cause = format!("the key {} appears twice", quoted(name));
    Problem::new(field, cause, "keep one of the two")
}
