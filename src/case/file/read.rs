//! Reads a case from TOML: finds every key in the table of fields and places every fault.

use std::collections::{HashMap, HashSet};

use super::FORMAT;
use super::fault::{FaultKind, Found};
use super::layout::{Entry, Layout, Value};
use super::syntax;
use crate::case::fields::{AUTO, Absent, FIELDS, Field, GROUPS, Kind, index_of};
use crate::case::sanitize::quoted;
use crate::case::{
    Case, Limit, Override, Problem, Spread, Variant, check, spread, suggest, variant,
};
use crate::model::Quantity;

/// Number of faults after which further ones are only counted.
const ENOUGH: usize = 200;

/// Common names of the two gears.
const GEARS: [&str; 8] = ["pinion", "wheel", "gear", "gears", "gear1", "gear2", "gear_1", "gear_2"];

const OVERRIDE: &str = "\"driven.tip_relief\" = \"48 um\"";

/// The case of a text and its faults.
pub(super) struct Reading {
    pub(super) case: Case,
    pub(super) faults: Vec<Found>,
    /// Number of further faults.
    pub(super) more: usize,
}

impl Reading {
    /// Whether the text is a case that lacks only required values.
    pub(super) fn is_draft(&self) -> bool {
        self.faults.iter().all(|found| found.is_missing)
    }
}

/// Reads a text. A syntax error and a newer format are reported alone. `is_newer` reads the known
/// part of a text of a newer format.
pub(super) fn read(text: &str, is_newer: bool) -> Reading {
    let mut case = Case::empty();
    if let Err(error) = toml_edit::Document::parse(text) {
        let faults = vec![syntax::fault(&error, text)];
        return Reading { case, faults, more: 0 };
    }
    let layout = Layout::of(text);
    let mut reader = Reader {
        layout: &layout,
        scopes: vec![Scope::new("", 0)],
        variants: HashMap::new(),
        seen: HashSet::new(),
        faults: Vec::new(),
        more: 0,
    };
    let newer = reader.format().filter(|_| !is_newer);
    let (mut faults, mut more) = (Vec::from_iter(newer), 0);
    if faults.is_empty() {
        for at in 0..layout.entries.len() {
            reader.entry(at);
        }
        reader.check();
        case = reader.case();
        (faults, more) = (reader.faults, reader.more);
    }
    Reading { case, faults, more }
}

/// The case itself or one of its variants while it is read.
struct Scope {
    /// The name of a variant. Empty for the case itself.
    name: String,
    /// The place of the name of a variant.
    at: usize,
    case: Case,
    /// The values of a variant.
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
            name => format!("{}{name}.{key}", variant::PREFIX),
        }
    }
}

/// The meaning of a key.
enum Target {
    Table,
    Format,
    Field(usize),
    /// A quantity, which may be unknown.
    Limit(String),
    Distribution(&'static Field),
    Unknown,
}

struct Reader<'l> {
    layout: &'l Layout,
    /// The case itself, then its variants.
    scopes: Vec<Scope>,
    /// The scopes of the variants by name.
    variants: HashMap<String, usize>,
    /// Keys that have been read, and unknown keys that have been reported.
    seen: HashSet<String>,
    faults: Vec<Found>,
    more: usize,
}

impl Reader<'_> {
    fn case(&self) -> Case {
        let named =
            self.scopes[1..].iter().filter(|scope| Variant::check_name(&scope.name).is_ok());
        let variants = named.map(|own| Variant::new(&own.name, own.overrides.clone()));
        Case { variants: variants.collect(), ..self.scopes[0].case.clone() }
    }

    /// Checks the format. A newer format is the only reported fault.
    fn format(&mut self) -> Option<Found> {
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
                return Some(Found { kind: FaultKind::NewerFormat, ..Found::new(at, problem) });
            }
            _ => {
                let fix = format!("write format = {FORMAT}");
                self.fault(0, at, Problem::new("format", "this format is unknown", fix));
            }
        }
        None
    }

    fn entry(&mut self, at: usize) {
        let entry = &self.layout.entries[at];
        let is_variant = entry.path.len() > 1 && entry.path[0] == "variants";
        if !is_variant {
            return self.read(0, at, 0);
        }
        let scope = self.scope(entry);
        if entry.path.len() > 2 {
            return self.read(scope, at, 2);
        }
        if entry.value != Value::Table {
            let place = format!("{}{}", variant::PREFIX, entry.path[1]);
            let cause = format!("expected a table of overrides, found {}", entry.value.kind());
            let fix = format!("write [{place}] on a line of its own, and {OVERRIDE} below it");
            self.scopes[scope].has_faults = true;
            self.fault(0, entry.span.start, Problem::new(&place, cause, fix));
        }
    }

    /// The scope of a variant.
    fn scope(&mut self, entry: &Entry) -> usize {
        let name = &entry.path[1];
        if let Some(known) = self.variants.get(name) {
            return *known;
        }
        self.variants.insert(name.clone(), self.scopes.len());
        let at = entry.key_at(2);
        let mut scope = Scope::new(name, at);
        if let Err(problem) = Variant::check_name(name) {
            scope.has_faults = true;
            self.fault(0, at, problem);
        }
        self.scopes.push(scope);
        self.scopes.len() - 1
    }

    /// Reads an entry whose path begins with `above` keys of the scope.
    fn read(&mut self, scope: usize, at: usize, above: usize) {
        let entry = &self.layout.entries[at];
        let path = &entry.path[above..];
        let (target, depth) = target(path, scope > 0);
        let (key, is_own) = (path[..depth].join("."), depth == path.len());
        let value = if is_own { &entry.value } else { &Value::Table };
        match target {
            Target::Unknown => self.unknown(scope, entry.key_at(above + depth), &key),
            Target::Limit(quantity) if Quantity::find(&quantity).is_none() => {
                self.unknown(scope, entry.key_at(above + depth), &key);
            }
            Target::Table if is_own && *value != Value::Table => {
                let cause = format!("expected the table [{key}], found {}", value.kind());
                let fix = format!("write [{key}] on a line of its own, once");
                self.fault(scope, entry.span.start, Problem::new(&key, cause, fix));
                let belongs = |field: &usize| FIELDS[*field].table() == key;
                self.scopes[scope].wrong.extend((0..FIELDS.len()).filter(belongs));
            }
            Target::Format | Target::Table => {}
            Target::Distribution(field) => self.distribution(scope, at, field, &path[depth..]),
            Target::Field(_) | Target::Limit(_) => {
                if !self.seen.insert(self.scopes[scope].key(&key)) {
                    if is_own {
                        self.twice(scope, entry, &key);
                    }
                    return;
                }
                match target {
                    Target::Field(field) => self.field(scope, field, value, entry.span.start),
                    _ => self.limit(scope, &key, value, entry.span.start),
                }
            }
        }
    }

    fn twice(&mut self, scope: usize, entry: &Entry, key: &str) {
        let cause = if scope == 0 {
            format!("the key {} appears twice", quoted(key))
        } else {
            "the variant overrides this key twice".to_owned()
        };
        self.fault(scope, entry.span.start, Problem::new(key, cause, "keep one of the two"));
    }

    fn field(&mut self, scope: usize, field: usize, value: &Value, at: usize) {
        let known = &FIELDS[field];
        let is_text = matches!(known.kind, Kind::Text);
        let is_empty = matches!(value, Value::String(text) if text.is_empty());
        if is_empty && !is_text {
            let cause = match known.absent {
                Absent::Refused | Absent::Either if scope == 0 => return,
                Absent::Refused => "the case needs this value",
                _ if scope > 0 => return self.take(scope, known.key, String::new()),
                _ => "the value is missing",
            };
            return self.wrong(scope, field, at, Problem::new("", cause, written(known)));
        }
        match text_of(known, value) {
            Ok(text) if scope > 0 => {
                self.scopes[scope].case.write(field, &text);
                self.take(scope, known.key, text);
            }
            Ok(text) => self.scopes[scope].case.write(field, &text),
            Err(misread) => self.wrong(scope, field, at, misread),
        }
    }

    fn wrong(&mut self, scope: usize, field: usize, at: usize, misread: Problem) {
        self.scopes[scope].wrong.push(field);
        self.fault(scope, at, misread.at(FIELDS[field].key));
    }

    fn limit(&mut self, scope: usize, key: &str, value: &Value, at: usize) {
        let Some(known) = key.strip_prefix("limits.").and_then(Quantity::find) else { return };
        if scope > 0 && *value == Value::String(String::new()) {
            return self.take(scope, key, String::new());
        }
        let example = format!("{} = {}", known.key, limit_by_example(known));
        let text = number_or_text(value, known.unit == "1", &example);
        let text = text.map_err(|misread| misread.at(key));
        match text.and_then(|text| Limit::new(known.key, &text)) {
            Ok(limit) if scope > 0 => self.take(scope, key, limit.text),
            Ok(limit) => self.scopes[scope].case.limits.push(limit),
            Err(problem) => self.fault(scope, at, problem),
        }
    }

    /// A distribution; `rest` is the path below its field: nothing, or its shape.
    fn distribution(&mut self, scope: usize, at: usize, field: &Field, rest: &[String]) {
        let entry = &self.layout.entries[at];
        let (key, own) = (spread::place(field.key), entry.path.len() - rest.len());
        let (above, below) = (&self.layout.entries[..at], self.layout.entries.get(at + 1));
        let of_it = |other: &&Entry| other.path.starts_with(&entry.path[..own]);
        let has_members = below.as_ref().is_some_and(of_it);
        let is_scalar = matches!(entry.value, Value::String(_) | Value::Number(_));
        let is_known = is_scalar && !self.seen.insert(self.scopes[scope].key(&key));
        let read = match (rest, &entry.value) {
            ([], Value::Table) if has_members => return,
            _ if is_known && scope > 0 => return self.twice(scope, entry, &key),
            ([], Value::String(text)) if scope > 0 && text.is_empty() => {
                return self.take(scope, &key, String::new());
            }
            ([shape], Value::String(width) | Value::Number(width)) if !is_known => {
                Spread::new(field.key, shape, width)
            }
            ([shape], _) if !is_known => Err(Spread::malformed(field.key, Some(shape))),
            _ => Err(Spread::malformed(field.key, None)),
        };
        match read {
            Ok(spread) => {
                if scope > 0 {
                    self.take(scope, &key, spread.in_words());
                }
                self.scopes[scope].case.spread.push(spread);
            }
            Err(_) if self.faults.len() >= ENOUGH => self.more += 1,
            Err(problem) => {
                let table = above.iter().rev().take_while(of_it).last().unwrap_or(entry);
                self.fault(scope, table.span.start, problem);
            }
        }
    }

    fn take(&mut self, scope: usize, key: &str, text: String) {
        self.scopes[scope].overrides.push(Override { key: key.to_owned(), text });
    }

    /// Checks the values of each scope together.
    fn check(&mut self) {
        for scope in 0..self.scopes.len() {
            let own = &self.scopes[scope];
            let mut problems = Vec::new();
            if scope == 0 {
                problems = check::read(&own.case, &own.wrong).1;
            } else {
                for field in (0..FIELDS.len()).filter(|&field| own.case.text(field).is_some()) {
                    if !own.wrong.contains(&field) {
                        problems.extend(own.case.check_field(field).err());
                        problems.extend(check::given_twice(&own.case, field));
                    }
                }
            }
            for problem in problems {
                let own = &self.scopes[scope];
                let field = index_of(&problem.field);
                let is_missing = scope == 0 && field.is_some_and(|field| own.case.lacks(field));
                let at = self.layout.place(&own.key(&problem.field));
                let count = self.faults.len();
                self.fault(scope, at, problem);
                for found in &mut self.faults[count..] {
                    found.is_missing = is_missing;
                }
            }
            let own = &self.scopes[scope];
            if scope > 0 && own.overrides.is_empty() && !own.has_faults {
                let place = format!("{}{}", variant::PREFIX, own.name);
                let fix = format!("write an override, such as {OVERRIDE}, or remove the table");
                self.fault(0, own.at, Problem::new(&place, "the variant changes nothing", fix));
            }
        }
    }

    /// Reports an unknown key once.
    fn unknown(&mut self, scope: usize, at: usize, key: &str) {
        if !self.seen.insert(self.scopes[scope].key(key)) {
            return;
        }
        if self.faults.len() >= ENOUGH {
            self.more += 1;
            return;
        }
        self.fault(scope, at, unknown(key));
    }

    fn fault(&mut self, scope: usize, at: usize, problem: Problem) {
        let own = &mut self.scopes[scope];
        own.has_faults = true;
        if self.faults.len() < ENOUGH {
            let field = own.key(&problem.field);
            self.faults.push(Found::new(at, Problem { field, ..problem }));
        } else {
            self.more += 1;
        }
    }
}

/// The meaning of a path, and the number of its keys that decide it.
fn target(path: &[String], is_variant: bool) -> (Target, usize) {
    let mut key = String::new();
    for (depth, name) in path.iter().enumerate() {
        if depth > 0 {
            key.push('.');
        }
        key.push_str(name);
        let below = key.split_once('.');
        let target = match below {
            None if key == "format" && !is_variant => Target::Format,
            Some(("limits", quantity)) => Target::Limit(quantity.to_owned()),
            Some(("spread", field)) => match index_of(field.trim_matches('"')) {
                Some(field) => Target::Distribution(&FIELDS[field]),
                None if is_group(field) => Target::Table,
                None => Target::Unknown,
            },
            _ => match index_of(&key) {
                Some(field) => Target::Field(field),
                None if is_table(&key) && !(is_variant && key == "variants") => Target::Table,
                None => Target::Unknown,
            },
        };
        if !matches!(target, Target::Table) {
            return (target, depth + 1);
        }
    }
    (Target::Table, path.len())
}

/// The text of a value for a field.
fn text_of(field: &Field, value: &Value) -> Result<String, Problem> {
    match (field.kind, value) {
        (Kind::Choice(..), Value::Flag(flag)) if field.is_flag() => Ok(flag.to_string()),
        (Kind::Choice(..), _) if field.is_flag() => Err(Problem::new(
            "",
            format!("expected true or false, found {}", value.kind()),
            "write true or false without quotes",
        )),
        (Kind::Text | Kind::Choice(..), Value::String(text)) => Ok(text.clone()),
        (Kind::Text | Kind::Choice(..), _) => {
            Err(misplaced("a text in quotes", value, &check::assignment(field)))
        }
        (Kind::Count(..), Value::String(text)) if field.takes_auto() && text == AUTO => {
            Ok(text.clone())
        }
        _ => number_or_text(value, field.is_bare(), &check::assignment(field)),
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
    matches!(name, "limits" | "spread" | "variants") || is_group(name)
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
            let known = tables.chain(["limits", "spread", "variants", "format", "title", "notes"]);
            let fix = match elsewhere(key) {
                _ if GEARS.contains(&key.to_lowercase().as_str()) => {
                    "the gears are [driver] and [driven], whatever their sizes".to_owned()
                }
                Some(field) => format!("put it under [{}]", field.table()),
                None => suggest::fix(key, known, || "remove it".to_owned()),
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
                None => suggest::fix(name, here(), all),
            };
            Problem::new(key, format!("unknown key {}", quoted(name)), fix)
        }
        Some(_) => check::unknown_key(key),
    }
}
