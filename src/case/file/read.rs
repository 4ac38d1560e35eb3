//! Reads a case from TOML: finds every key in the table of fields and places every fault.

use std::cmp::Ordering;
use std::collections::{BTreeMap, HashMap, HashSet};

use super::FORMAT;
use super::fault::MOST;
use super::layout::{Entry, Layout, Value};
use super::syntax;
use crate::case::fields::{AUTO, Absent, FIELDS, Field, GROUPS, Kind, index_of};
use crate::case::problem::{MISSING, NEWER_FORMAT};
use crate::case::sanitize::quoted;
use crate::case::{
    Case, Limit, Override, Problem, Spread, Variant, check, spread, suggest, variant,
};
use crate::model::Quantity;

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
        Err(error) => return refused(syntax::fault(&error, text)),
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
    case.variants = named.map(|own| Variant::new(&own.name, own.values.clone())).collect();
    Reading { case, faults: reader.faults }
}

/// The case itself or one of its variants while it is read.
struct Scope {
    /// The name of a variant. Empty for the case itself.
    name: String,
    /// The place of the name of a variant.
    at: usize,
    case: Case,
    /// Every value, as an override.
    values: Vec<Override>,
    /// Fields with invalid values.
    wrong: Vec<usize>,
    has_faults: bool,
}

impl Scope {
    fn new(name: &str, at: usize) -> Scope {
        let (name, case) = (name.to_owned(), Case::empty());
        Scope { name, at, case, values: Vec::new(), wrong: Vec::new(), has_faults: false }
    }

    /// A key of the scope as a key of the file.
    fn key(&self, key: &str) -> String {
        match &*self.name {
            "" => key.to_owned(),
            name => format!("{}{name}.{key}", variant::PREFIX),
        }
    }

    fn keep(&mut self, key: &str, text: String) {
        self.values.push(Override { key: key.to_owned(), text });
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
        match written.map(|number| (number, number.cmp(&u64::from(FORMAT)))) {
            Some((_, Ordering::Equal)) => {}
            Some((number, Ordering::Greater)) => {
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
        match target {
            Target::Unknown => {
                if self.seen.insert(self.scopes[scope].key(&key)) {
                    self.fault(scope, entry.key_at(above + depth), unknown(&key));
                }
            }
            Target::Table if is_own && *value != Value::Table => {
                let cause = format!("expected the table [{key}], found {}", value.kind());
                let fix = format!("write [{key}] on a line of its own, once");
                self.fault(scope, start, Problem::new(&key, cause, fix));
                let belongs = |field: &usize| FIELDS[*field].table() == key;
                self.scopes[scope].wrong.extend((0..FIELDS.len()).filter(belongs));
            }
            Target::Format | Target::Table => {}
            Target::Spread(field) => {
                let own = self.distributions.entry((scope, field)).or_default();
                own.0 = above + depth;
                own.1.push(entry);
            }
            Target::Field(_) | Target::Limit(_)
                if !self.seen.insert(self.scopes[scope].key(&key)) =>
            {
                if is_own {
                    let cause = match scope {
                        0 => format!("the key {} appears twice", quoted(&key)),
                        _ => "the variant overrides this key twice".to_owned(),
                    };
                    self.fault(scope, start, Problem::new(&key, cause, "keep one of the two"));
                }
            }
            Target::About => match value {
                Value::String(text) | Value::Number(text) | Value::Date(text) => {
                    self.scopes[scope].case.write_about(&path[1], text);
                }
                _ => {
                    let problem = misplaced("a text in quotes", value, "project = \"Mill 7\"");
                    self.fault(scope, start, problem.at(&key));
                }
            },
            Target::Field(field) => self.field(scope, field, value, start),
            Target::Limit(quantity) => self.limit(scope, quantity, value, start),
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

    fn field(&mut self, scope: usize, field: usize, value: &Value, at: usize) {
        let known = &FIELDS[field];
        let is_empty = *value == Value::String(String::new()) && !matches!(known.kind, Kind::Text);
        let missing = |cause| Err(Problem::new("", cause, written(known)));
        let text = match known.absent {
            _ if !is_empty => text_of(known, value),
            Absent::Refused | Absent::Either if scope == 0 => return,
            Absent::Refused => missing("the case needs this value"),
            _ if scope > 0 => Ok(String::new()),
            _ => missing("the value is missing"),
        };
        match text {
            Ok(text) => {
                self.scopes[scope].case.write(field, &text);
                self.scopes[scope].keep(known.key, text);
            }
            Err(problem) => {
                self.scopes[scope].wrong.push(field);
                self.fault(scope, at, problem.at(known.key));
            }
        }
    }

    fn limit(&mut self, scope: usize, quantity: &Quantity, value: &Value, at: usize) {
        let key = format!("limits.{}", quantity.key);
        if scope > 0 && *value == Value::String(String::new()) {
            return self.scopes[scope].keep(&key, String::new());
        }
        let example = format!("{} = {}", quantity.key, limit_by_example(quantity));
        // A limit may be relative to another result, such as "1.3 x mesh_force".
        let is_relative = matches!(value, Value::String(text) if text.contains(" x "));
        let text = number_or_text(value, quantity.unit == "1" && !is_relative, &example);
        match text
            .map_err(|problem| problem.at(&key))
            .and_then(|text| Limit::new(quantity.key, &text))
        {
            Ok(limit) => {
                self.scopes[scope].keep(&key, limit.text.clone());
                self.scopes[scope].case.limits.push(limit);
            }
            Err(problem) => self.fault(scope, at, problem),
        }
    }

    /// Reads the distributions, each of one shape with a width.
    fn spread(&mut self) {
        let mut all: Vec<_> = std::mem::take(&mut self.distributions).into_iter().collect();
        all.sort_by_key(|(_, (_, entries))| entries[0].start);
        for ((scope, field), (depth, entries)) in all {
            let (key, place) = (FIELDS[field].key, spread::place(FIELDS[field].key));
            let is_part = |entry: &&&Entry| entry.path.len() > depth || entry.value != Value::Table;
            let mut parts = entries.iter().filter(is_part);
            let only = parts.next().filter(|_| parts.next().is_none());
            let read = match only.map(|entry| (&entry.path[depth..], &entry.value)) {
                Some(([], Value::String(text))) if scope > 0 && text.is_empty() => {
                    self.scopes[scope].keep(&place, String::new());
                    continue;
                }
                Some(([shape], Value::String(width) | Value::Number(width))) => {
                    Spread::new(key, shape, width)
                }
                Some(([shape], _)) => Err(Spread::malformed(key, Some(shape))),
                _ => Err(Spread::malformed(key, None)),
            };
            match read {
                Ok(spread) => {
                    self.scopes[scope].keep(&place, spread.in_words());
                    self.scopes[scope].case.spread.push(spread);
                }
                Err(problem) => self.fault(scope, entries[0].span.start, problem),
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
            if scope > 0 && own.values.is_empty() && !own.has_faults {
                let place = format!("{}{}", variant::PREFIX, own.name);
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
        (Kind::List(_), Value::Array(Some(numbers))) => Ok(numbers.clone()),
        (Kind::List(_), _) => {
            Err(misplaced("numbers in brackets", value, &check::assignment(field)))
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
