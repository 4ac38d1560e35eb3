//! Reads a case from TOML: finds every key in the table of fields and records its place in the
//! text.

mod variants;

use toml::de::{DeTable, DeValue};

use super::excerpt::excerpt;
use super::fault::{FaultKind, Found};
use super::places::{Place, Places};
use super::unknown::{unknown_at_top, unknown_in_table};
use super::value::{bare_number, flag, kind_of, measure, misplaced, scalar, untaken, words};
use super::{FORMAT, syntax};
use crate::case::fields::{AUTO, Absent, FIELDS, Field, GROUPS, Kind, index_of};
use crate::case::spread;
use crate::case::units::ParseError;
use crate::case::{Case, Limit, Problem, Spread, check};
use crate::model::Quantity;

type Key<'k, 'i> = &'k toml::Spanned<toml::de::DeString<'i>>;
type Value<'k, 'i> = &'k toml::Spanned<DeValue<'i>>;

/// Number of faults after which unknown keys are only counted.
const ENOUGH: usize = 200;

/// The case of a text and its faults.
pub(super) struct Reading {
    pub(super) case: Case,
    pub(super) places: Places,
    pub(super) faults: Vec<Found>,
    pub(super) more: usize,
}

impl Reading {
    /// Whether the text is a case that lacks only required values.
    pub(super) fn is_draft(&self) -> bool {
        self.faults.iter().all(|found| found.is_missing)
    }
}

/// Reads the known part of a text of a newer format and ignores its faults.
pub(super) fn read_newer(text: &str) -> Reading {
    let mut reader = Reader::of(text);
    let recovered = syntax::recover(text);
    let (tree, _) = DeTable::parse_recoverable(&recovered.text);
    if recovered.tables_known {
        reader.tables(tree.get_ref());
    }
    Reading { case: reader.case, places: reader.places, faults: Vec::new(), more: 0 }
}

/// Reads a text. Recovers from syntax errors if possible.
pub(super) fn read(text: &str) -> Reading {
    let mut reader = Reader::of(text);
    let (text, unread) = excerpt(text);
    let recovered = syntax::recover(text);
    let (tree, _) = DeTable::parse_recoverable(&recovered.text);
    if recovered.tables_known {
        reader.root(tree.get_ref());
    }
    let is_newer = |found: &Found| found.kind == FaultKind::NewerFormat;
    if !reader.faults.iter().any(is_newer) {
        // The unread rest may contain values that seem to be missing.
        if recovered.tables_known && unread == 0 {
            if recovered.faults.is_empty() {
                reader.empty_variants();
            }
            reader.fields_together(&recovered.broken);
        }
        reader.faults.extend(recovered.faults);
        reader.more += recovered.more + unread;
    }
    Reading { case: reader.case, places: reader.places, faults: reader.faults, more: reader.more }
}

struct Reader {
    case: Case,
    places: Places,
    faults: Vec<Found>,
    /// Number of unknown keys that were only counted.
    more: usize,
    /// Fields with invalid values.
    wrong: Vec<usize>,
}

impl Reader {
    fn of(text: &str) -> Reader {
        let places = Places { end: text.len(), ..Places::default() };
        Reader { case: Case::empty(), places, faults: Vec::new(), more: 0, wrong: Vec::new() }
    }

    fn root(&mut self, root: &DeTable<'_>) {
        if self.format(root) == FaultKind::NewerFormat {
            return;
        }
        self.tables(root);
    }

    fn tables(&mut self, root: &DeTable<'_>) {
        for (key, value) in in_order(root) {
            let name = key.get_ref().as_ref();
            if name == "format" {
                self.note(name, value);
            } else if let Some(field) = index_of(name) {
                self.field(field, value);
            } else if is_table(name) {
                self.table(key, value);
            } else {
                self.unknown(key, || unknown_at_top(name));
            }
        }
    }

    /// In a file of a newer format, the format is the only reported fault.
    fn format(&mut self, root: &DeTable<'_>) -> FaultKind {
        let Some(value) = root.get("format") else {
            self.fault(
                0,
                Problem::new(
                    "format",
                    "the format is missing",
                    format!("begin the file with format = {FORMAT}"),
                ),
            );
            return FaultKind::Bad;
        };
        let at = value.span().start;
        let written = value
            .get_ref()
            .as_integer()
            .and_then(|number| u64::from_str_radix(number.as_str(), number.radix()).ok());
        match written {
            Some(number) if number == u64::from(FORMAT) => {}
            Some(number) if number > u64::from(FORMAT) => {
                let cause = format!(
                    "format {number} is newer than this version, which reads format {FORMAT}"
                );
                let problem = Problem::new("format", cause, "open it with a newer tipstrike");
                self.faults.push(Found {
                    at,
                    problem,
                    kind: FaultKind::NewerFormat,
                    is_missing: false,
                });
                return FaultKind::NewerFormat;
            }
            _ => self.fault(
                at,
                Problem::new(
                    "format",
                    "this format is unknown",
                    format!("write format = {FORMAT}"),
                ),
            ),
        }
        FaultKind::Bad
    }

    fn table(&mut self, key: Key<'_, '_>, value: Value<'_, '_>) {
        let name = key.get_ref().as_ref();
        let Some(table) = value.get_ref().as_table() else {
            let cause = format!("expected the table [{name}], found {}", kind_of(value.get_ref()));
            self.fault(
                value.span().start,
                Problem::new(name, cause, format!("write [{name}] on a line of its own, once")),
            );
            let belongs = |field: &usize| FIELDS[*field].table() == name;
            self.wrong.extend((0..FIELDS.len()).filter(belongs));
            return;
        };
        self.places.tables.push((name.to_owned(), value.span()));
        for (key, value) in in_order(table) {
            match name {
                "limits" => self.limit(key.get_ref(), key, value),
                "spread" => self.spread("", key, value),
                "variants" => self.variant(key, value),
                _ => self.member(name, key, value),
            }
        }
    }

    fn member(&mut self, table: &str, key: Key<'_, '_>, value: Value<'_, '_>) {
        let name = key.get_ref().as_ref();
        match index_of(&format!("{table}.{name}")) {
            Some(field) => self.field(field, value),
            None => self.unknown(key, || unknown_in_table(table, name)),
        }
    }

    fn field(&mut self, field: usize, value: Value<'_, '_>) {
        let known = &FIELDS[field];
        self.note(known.key, value);
        let written = match known.kind {
            Kind::Choice(..) if known.is_flag() => flag(value.get_ref()),
            Kind::Text | Kind::Choice(..) => words(value.get_ref()),
            Kind::Count(..) if known.takes_auto() && value.get_ref().as_str() == Some(AUTO) => {
                Ok(AUTO.to_owned())
            }
            Kind::Number(..) | Kind::Count(..) if known.is_bare() => {
                bare_number(value.get_ref(), &check::assignment(known))
            }
            Kind::Number(..) | Kind::Count(..) => measure(value.get_ref()),
        };
        let empty = |text: &String| text.is_empty() && !matches!(known.kind, Kind::Text);
        match written {
            _ if is_required(known) && value.get_ref().as_str() == Some("") => {}
            Ok(text) if empty(&text) => {
                self.wrongly(
                    field,
                    value,
                    ParseError::new(
                        "the value is missing",
                        format!("write {}", check::assignment(known)),
                    ),
                );
            }
            Ok(text) => self.case.write(field, &text),
            Err(misread) => self.wrongly(
                field,
                value,
                misread.unwrap_or_else(|| {
                    untaken(value.get_ref(), known.kind, &check::assignment(known))
                }),
            ),
        }
    }

    fn wrongly(&mut self, field: usize, value: Value<'_, '_>, misread: ParseError) {
        self.wrong.push(field);
        self.fault(value.span().start, Problem::of(FIELDS[field].key, misread));
    }

    fn limit(&mut self, name: &str, key: Key<'_, '_>, value: Value<'_, '_>) {
        let place = format!("limits.{name}");
        let Some(known) = Quantity::find(name) else {
            return self.unknown(key, || check::unknown_quantity(&place, name));
        };
        self.note(&place, value);
        let bare = known.unit == "1";
        let example = format!("{name} = {}", limit_by_example(known));
        let written =
            if bare { bare_number(value.get_ref(), &example) } else { measure(value.get_ref()) };
        let taken = match written {
            Ok(text) => Limit::new(name, &text),
            Err(misread) => {
                let misread =
                    misread.unwrap_or_else(|| misplaced(value.get_ref(), "a value", &example));
                Err(Problem::of(&place, misread))
            }
        };
        match taken {
            Ok(limit) => self.case.limits.push(limit),
            Err(problem) => self.fault(value.span().start, problem),
        }
    }

    /// The distribution of a field, under its dotted key with or without quotes.
    fn spread(&mut self, above: &str, key: Key<'_, '_>, value: Value<'_, '_>) {
        let path = joined(above, key.get_ref());
        let table = value.get_ref().as_table();
        if let (Some(table), true) = (table, GROUPS.iter().any(|(group, _)| *group == path)) {
            in_order(table).for_each(|(key, value)| self.spread(&path, key, value));
            return;
        }
        self.distribution(&path, key, value);
    }

    fn distribution(&mut self, path: &str, key: Key<'_, '_>, value: Value<'_, '_>) {
        let place = spread::place(path);
        if index_of(path).is_none() {
            return self.unknown(key, || Problem { field: place, ..check::unknown_key(path) });
        }
        let table = value.get_ref().as_table();
        self.note(&place, value);
        let only = table.and_then(|table| table.iter().next().filter(|_| table.len() == 1));
        let taken = match only.map(|(shape, width)| (shape.get_ref(), scalar(width.get_ref()))) {
            Some((shape, Some(width))) => Spread::new(path, shape, &width),
            found => Err(Spread::malformed(path, found.map(|(shape, _)| shape.as_ref()))),
        };
        match taken {
            Ok(spread) => self.case.spread.push(spread),
            Err(problem) => self.fault(value.span().start, problem),
        }
    }

    /// Checks the fields together. A value on a broken line is not missing.
    fn fields_together(&mut self, broken: &str) {
        let on_broken_line = |field: &usize| {
            self.case.text(*field).is_none() && syntax::names(broken, FIELDS[*field].name())
        };
        let lost: Vec<usize> = (0..FIELDS.len()).filter(on_broken_line).collect();
        self.wrong.extend(lost);
        let (_, problems) = check::read(&self.case, &self.wrong);
        for problem in problems {
            let is_missing = index_of(&problem.field).is_some_and(|field| self.case.lacks(field));
            let found = Found::new(self.places.offset(&problem.field), problem);
            self.faults.push(Found { is_missing, ..found });
        }
    }

    fn note(&mut self, path: &str, value: Value<'_, '_>) {
        self.places.entries.push(Place { key: path.to_owned(), value: value.span() });
    }

    /// Suggests a known key for the first faults only, because the search is slow.
    fn unknown(&mut self, key: Key<'_, '_>, problem: impl FnOnce() -> Problem) {
        if self.faults.len() < ENOUGH {
            self.fault(key.span().start, problem());
        } else {
            self.more += 1;
        }
    }

    fn fault(&mut self, at: usize, problem: Problem) {
        self.faults.push(Found::new(at, problem));
    }
}

/// Whether an empty string is a missing required value.
fn is_required(field: &Field) -> bool {
    matches!(field.absent, Absent::Refused | Absent::Either)
}

/// The keys and values of a table in the order of the text.
fn in_order<'k, 'i>(table: &'k DeTable<'i>) -> impl Iterator<Item = (Key<'k, 'i>, Value<'k, 'i>)> {
    let mut members: Vec<_> = table.iter().collect();
    members.sort_by_key(|(key, _)| key.span().start);
    members.into_iter()
}

/// A key with the name of its table.
fn joined(table: &str, name: &str) -> String {
    if table.is_empty() { name.to_owned() } else { format!("{table}.{name}") }
}

fn is_table(name: &str) -> bool {
    matches!(name, "limits" | "spread" | "variants")
        || GROUPS.iter().any(|(group, _)| *group == name && !name.is_empty())
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
