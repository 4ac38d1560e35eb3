//! The variants of a case: tables of overrides, whose keys may be dotted, quoted or nested.

use toml::de::DeValue;

use super::{Key, Reader, Value, in_order, is_table, joined};
use crate::case::fields::{Absent, FIELDS, Kind, index_of};
use crate::case::file::fault::Found;
use crate::case::file::unknown::{unknown_at_top, unknown_in_table};
use crate::case::file::value::kind_of;
use crate::case::{Case, Override, Problem, Variant, check, spread};

const EXAMPLE: &str = "\"driven.tip_relief\" = \"48 um\"";

impl Reader {
    /// A table `[variants.NAME]`.
    pub(super) fn variant(&mut self, key: Key<'_, '_>, value: Value<'_, '_>) {
        let name = key.get_ref().as_ref();
        let place = format!("variants.{name}");
        if let Err(problem) = Variant::check_name(name) {
            return self.fault(key.span().start, problem);
        }
        let Some(table) = value.get_ref().as_table() else {
            let cause =
                format!("expected a table of overrides, found {}", kind_of(value.get_ref()));
            let fix = format!("write [{place}] on a line of its own, and {EXAMPLE} below it");
            return self.fault(value.span().start, Problem::new(&place, cause, fix));
        };
        self.places.tables.push((place.clone(), key.span()));
        let mut overrides = Overrides { reader: Reader::of(""), taken: Vec::new() };
        for (key, value) in in_order(table) {
            overrides.read("", key, value);
        }
        overrides.check();
        self.case.variants.push(Variant::new(name, overrides.taken));
        self.adopt(&place, overrides.reader);
    }

    /// Reports the variants without overrides.
    pub(super) fn empty_variants(&mut self) {
        for at in 0..self.case.variants.len() {
            let variant = &self.case.variants[at];
            let place = format!("variants.{}", variant.name);
            let is_of_it = |found: &Found| found.problem.field.starts_with(&format!("{place}."));
            if variant.overrides.is_empty() && !self.faults.iter().any(is_of_it) {
                let start = self.places.table(&place).map_or(0, |span| span.start);
                let fix = format!("write an override, such as {EXAMPLE}, or remove the table");
                self.fault(start, Problem::new(&place, "the variant changes nothing", fix));
            }
        }
    }

    /// Adds the results of another reader for the table of this name.
    fn adopt(&mut self, table: &str, other: Reader) {
        let of_table = |key: &str| format!("{table}.{key}");
        for place in other.places.entries {
            let key = of_table(&place.key);
            self.places.entries.push(super::Place { key, ..place });
        }
        for found in other.faults {
            let field = of_table(&found.problem.field);
            let problem = Problem { field, ..found.problem };
            self.faults.push(Found { problem, ..found });
        }
        self.more += other.more;
    }
}

/// Reads the overrides of a variant as a separate case.
struct Overrides {
    reader: Reader,
    taken: Vec<Override>,
}

impl Overrides {
    fn read(&mut self, above: &str, key: Key<'_, '_>, value: Value<'_, '_>) {
        let path = joined(above, key.get_ref());
        let table = value.get_ref().as_table();
        match (index_of(&path), path.split_once('.')) {
            (Some(field), _) => self.field(field, value),
            (None, Some(("limits", quantity))) => self.limit(quantity, key, value),
            (None, Some(("spread", field))) => self.spread(field, key, value),
            (None, _) => match table {
                Some(table) if is_table(&path) && path != "variants" => {
                    in_order(table).for_each(|(key, value)| self.read(&path, key, value));
                }
                _ => self.reader.unknown(key, || unknown(&path)),
            },
        }
    }

    fn field(&mut self, field: usize, value: Value<'_, '_>) {
        let known = &FIELDS[field];
        if is_empty(value) && !matches!(known.kind, Kind::Text) {
            self.reader.note(known.key, value);
            if known.absent == Absent::Refused {
                let fix = format!("write {}", check::assignment(known));
                let problem = Problem::new(known.key, "the case needs this value", fix);
                return self.reader.fault(value.span().start, problem);
            }
            return self.take(known.key, String::new());
        }
        self.reader.field(field, value);
        if let Some(text) = self.reader.case.text(field).map(str::to_owned) {
            self.take(known.key, text);
        } else if is_empty(value) {
            self.take(known.key, String::new());
        }
    }

    fn limit(&mut self, quantity: &str, key: Key<'_, '_>, value: Value<'_, '_>) {
        let place = format!("limits.{quantity}");
        if is_empty(value) && Case::empty().set_limit(quantity, "").is_ok() {
            self.reader.note(&place, value);
            return self.take(&place, String::new());
        }
        let before = self.reader.case.limits.len();
        self.reader.limit(quantity, key, value);
        if let Some(limit) = self.reader.case.limits.get(before) {
            let text = limit.text.clone();
            self.take(&place, text);
        }
    }

    /// A distribution. Its field can be quoted, dotted or nested.
    fn spread(&mut self, field: &str, key: Key<'_, '_>, value: Value<'_, '_>) {
        let path = field.trim_matches('"');
        if let Some(table) = value.get_ref().as_table()
            && index_of(path).is_none()
            && is_table(path)
        {
            let above = format!("spread.{path}");
            return in_order(table).for_each(|(key, value)| self.read(&above, key, value));
        }
        let place = spread::place(path);
        if is_empty(value) && index_of(path).is_some() {
            self.reader.note(&place, value);
            return self.take(&place, String::new());
        }
        let before = self.reader.case.spread.len();
        self.reader.distribution(path, key, value);
        if let Some(spread) = self.reader.case.spread.get(before) {
            let text = spread.in_words();
            self.take(&place, text);
        }
    }

    fn take(&mut self, key: &str, text: String) {
        if self.taken.iter().any(|known| known.key == key) {
            let at = self.reader.places.entries.last().map_or(0, |place| place.value.start);
            let fix = "keep one of the two";
            let problem = Problem::new(key, "the variant overrides this key twice", fix);
            return self.reader.fault(at, problem);
        }
        self.taken.push(Override { key: key.to_owned(), text });
    }

    /// Checks every value, and that the variant gives only one of two fields that exclude each
    /// other.
    fn check(&mut self) {
        let case = &self.reader.case;
        let problems: Vec<Problem> = (0..FIELDS.len())
            .filter(|&field| case.text(field).is_some() && !self.reader.wrong.contains(&field))
            .flat_map(|field| {
                let misfit = check::given_twice(case, field);
                case.check_field(field).err().into_iter().chain(misfit)
            })
            .collect();
        for problem in problems {
            let at = self.reader.places.entry(&problem.field);
            let at = at.map_or(0, |place| place.value.start);
            self.reader.fault(at, problem);
        }
    }
}

fn is_empty(value: Value<'_, '_>) -> bool {
    matches!(value.get_ref(), DeValue::String(text) if text.is_empty())
}

/// The refusal of a key that a variant cannot override.
fn unknown(path: &str) -> Problem {
    match path.rsplit_once('.') {
        _ if path == "format" => {
            Problem::new(path, "a variant has the format of its case", "remove this key")
        }
        Some((table, name)) if is_table(table) => unknown_in_table(table, name),
        Some(_) => check::unknown_key(path),
        None => unknown_at_top(path),
    }
}
