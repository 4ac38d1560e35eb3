//! Edits of files in every layout: other lines keep their bytes, comments stay, and reading gives
//! the edited case.

use std::cell::Cell;
use std::collections::BTreeSet;

use proptest::prelude::*;
use tipstrike::case::fields::FIELDS;
use tipstrike::case::{Case, Document, Spread, Variant};

use crate::documents::{Edit, edits};
use crate::properties::assert_same;
use crate::{hold, values};

/// Tables with their keys and values.
const TABLES: [(&str, &[(&str, &str)]); 9] = [
    ("pair", &[("module", "\"5 mm\""), ("pressure_angle", "\"20 deg\"")]),
    ("driver", &[("teeth", "20"), ("face_width", "\"8 mm\""), ("young", "\"205 GPa\"")]),
    ("driven", &[("teeth", "20"), ("face_width", "\"8 mm\""), ("tip_relief", "\"0 um\"")]),
    ("deviations", &[("base_pitch", "\"16 um\"")]),
    ("operation", &[("power", "\"15 kW\""), ("speed", "\"2000 rpm\"")]),
    ("limits", &[("impact_force", "\"2500 N\""), ("dynamic_factor", "1.5")]),
    (
        "spread",
        &[
            ("deviations.base_pitch", "{ normal = \"4 um\" }"),
            ("driver.face_width", "{ uniform = \"1 mm\" }"),
        ],
    ),
    ("variants.relieved", &[("driven.tip_relief", "\"48 um\""), ("operation.power", "\"9 kW\"")]),
    ("variants.slow", &[("operation.speed", "\"100 rpm\""), ("limits.impact_force", "\"900 N\"")]),
];

/// A file, and the lines of each key of a case.
struct Layout {
    text: String,
    /// Whether the next choice of the layout is random.
    choices: Vec<u8>,
    at: usize,
    /// Key and line. A key that begins with `[` is a table with this header, with `{` a table in
    /// braces, and a key that ends with a point is any key of a table.
    lines: Vec<(String, usize)>,
    comments: usize,
}

impl Layout {
    fn of(choices: &[u8]) -> Layout {
        let mut layout = Layout {
            text: String::new(),
            choices: choices.to_vec(),
            at: 0,
            lines: Vec::new(),
            comments: 0,
        };
        layout.line("", "format = 1");
        layout.line("title", "title = 'a # in a title'");
        match layout.choice(3) {
            0 => layout.line("notes", "notes = \"\"\"\none\n# two\\\n  three\"\"\""),
            1 => layout.line("notes", "notes = '''\n[one]\n\n\ttwo '''"),
            _ => layout.line("notes", "notes = \"one\""),
        }
        let forms: Vec<usize> = TABLES.iter().map(|_| layout.choice(5)).collect();
        // `variants` is one table.
        let forms = [&forms[..8], &forms[7..8]].concat();
        for (at, (table, members)) in TABLES.iter().enumerate() {
            match forms[at] {
                0 => layout.dotted(table, members),
                1 => layout.inline(table, members),
                2 => layout.inline_of_lines(table, members),
                _ => {}
            }
        }
        for (at, (table, members)) in TABLES.iter().enumerate() {
            match forms[at] {
                3 => layout.header(table, members),
                4 => layout.nested(table, members),
                _ => {}
            }
        }
        if layout.choice(3) == 0 {
            layout.text = layout.text.trim_end_matches(['\r', '\n']).into();
        }
        layout
    }

    fn choice(&mut self, of: usize) -> usize {
        self.at += 1;
        usize::from(self.choices[(self.at - 1) % self.choices.len()]) % of
    }

    /// Adds lines of a key, with comments and any line ends.
    fn line(&mut self, key: &str, line: &str) {
        if self.choice(4) == 0 {
            self.comments += 1;
            let comment = format!("# comment {}.", self.comments);
            self.end("", &comment);
        }
        let comment = if self.choice(3) == 0 { " # of this line" } else { "" };
        let lines: Vec<&str> = line.split('\n').collect();
        for (at, part) in lines.iter().enumerate() {
            let comment = if at + 1 == lines.len() { comment } else { "" };
            self.end(key, &format!("{part}{comment}"));
        }
        if self.choice(5) == 0 {
            self.end("", "");
        }
    }

    fn end(&mut self, key: &str, line: &str) {
        let number = self.text.matches('\n').count();
        self.lines.push((key.to_owned(), number));
        let is_windows = match self.choices[0] % 3 {
            0 => false,
            1 => true,
            _ => self.choice(2) == 0,
        };
        self.text.push_str(line);
        self.text.push_str(if is_windows { "\r\n" } else { "\n" });
    }

    fn dotted(&mut self, table: &str, members: &[(&str, &str)]) {
        for (name, value) in members {
            let above = match self.choice(3) {
                0 => table.replace('.', " . "),
                1 => {
                    table.split('.').map(|part| format!("\"{part}\"")).collect::<Vec<_>>().join(".")
                }
                _ => table.to_owned(),
            };
            let line = format!("{above} . {} = {value}", self.spelled(table, name));
            self.line(&key(table, name), &line);
        }
    }

    fn inline(&mut self, table: &str, members: &[(&str, &str)]) {
        let members: Vec<String> = members
            .iter()
            .map(|(name, value)| format!("{}={value}", self.spelled(table, name)))
            .collect();
        let line = format!("{table} = {{ {} }}", members.join(" , "));
        self.line(&format!("{table}."), &line);
    }

    fn inline_of_lines(&mut self, table: &str, members: &[(&str, &str)]) {
        let first = self.text.matches('\n').count();
        self.line(&format!("{table}."), &format!("{table} = {{"));
        for (at, (name, value)) in members.iter().enumerate() {
            let is_last = at + 1 == members.len() && self.choice(2) == 0;
            let comma = if is_last { "" } else { "," };
            let line = format!("  {} = {value}{comma}", self.spelled(table, name));
            self.line(&key(table, name), &line);
            // A further key needs a comma after the last one.
            let own = self.lines.iter().rfind(|(own, _)| *own == key(table, name));
            if let Some((_, at)) = own.filter(|_| is_last) {
                self.lines.push((format!("{table}."), *at));
            }
        }
        self.line("", "}");
        let last = self.text.matches('\n').count();
        let inside = (first..last).map(|line| (format!("{{{table}"), line));
        self.lines.extend(inside);
    }

    fn header(&mut self, table: &str, members: &[(&str, &str)]) {
        self.line(&format!("[{table}"), &format!("[ {table}]"));
        for (name, value) in members {
            let line = format!("\t{}  =  {value}", self.spelled(table, name));
            self.line(&key(table, name), &line);
        }
    }

    fn nested(&mut self, table: &str, members: &[(&str, &str)]) {
        for (name, value) in members {
            let Some((above, name)) = name.split_once('.') else {
                return self.header(table, members);
            };
            self.line(&format!("[{table}"), &format!("[{table}.{above}]"));
            self.line(&format!("{table}.{above}.{name}"), &format!("{name} = {value}"));
        }
    }

    fn spelled(&mut self, table: &str, name: &str) -> String {
        let is_whole = ["spread", "variants"].iter().any(|own| table.starts_with(own));
        match self.choice(3) {
            0 if is_whole => name.to_owned(),
            0 => format!("'{name}'"),
            _ => format!("\"{name}\""),
        }
    }
}

fn key(table: &str, name: &str) -> String {
    format!("{table}.{name}")
}

/// The values of a case by their keys in [`Layout::lines`].
fn values(case: &Case) -> BTreeSet<(String, String)> {
    let fields = FIELDS
        .iter()
        .enumerate()
        .filter_map(|(at, field)| Some((field.key.to_owned(), case.text(at)?.to_owned())));
    let limits = case.limits.iter();
    let limits = limits.map(|limit| (key("limits", limit.quantity.key), limit.text.clone()));
    let spread = case.spread.iter();
    let spread = spread.map(|spread| (key("spread", spread.field), spread.text.clone()));
    let variants = case.variants.iter().flat_map(|variant| {
        let above = format!("variants.{}", variant.name);
        let change = variant.overrides.iter();
        change.map(move |change| (key(&above, &change.key.replace('"', "")), change.text.clone()))
    });
    fields.chain(limits).chain(spread).chain(variants).collect()
}

/// Edits of distributions and variants.
#[derive(Debug, Clone)]
enum Other {
    Case(Edit),
    Spread(&'static str, &'static str, &'static str),
    Remove(usize),
    Override(usize, usize, String),
}

impl Other {
    fn apply(&self, case: &mut Case) {
        match self {
            Other::Case(edit) => edit.apply(case),
            Other::Spread(field, shape, width) => {
                let at = case.spread.iter().position(|own| own.field == *field);
                match (Spread::new(field, &format!("{shape} {width}")), at) {
                    (Ok(new), Some(at)) => case.spread[at] = new,
                    (Ok(new), None) => case.spread.push(new),
                    (Err(_), Some(at)) => drop(case.spread.remove(at)),
                    (Err(_), None) => {}
                }
            }
            Other::Remove(at) if *at < case.variants.len() => drop(case.variants.remove(*at)),
            Other::Remove(_) => {}
            Other::Override(at, field, text) => {
                let Some(variant) = case.variants.get(*at) else { return };
                let (name, mut edited) = (variant.name.clone(), case.with(variant));
                let is_set = edited.set(FIELDS[*field].key, text).is_ok();
                let variant = Variant::between(&name, case, &edited);
                if is_set && !variant.overrides.is_empty() {
                    case.keep_variant(variant);
                }
            }
        }
    }
}

fn others() -> impl Strategy<Value = Vec<Other>> {
    let spread = (
        prop::sample::select(
            &["deviations.base_pitch", "driver.face_width", "operation.speed"][..],
        ),
        prop::sample::select(&["normal", "uniform", "none"][..]),
        prop::sample::select(&["2 um", "1 mm", "5 rpm"][..]),
    );
    let other = prop_oneof![
        2 => spread.prop_map(|(field, shape, width)| Other::Spread(field, shape, width)),
        1 => (0..3usize).prop_map(Other::Remove),
        3 => (0..2usize, values::field_and_text())
            .prop_map(|(at, (field, text))| Other::Override(at, field, text)),
    ];
    let others = prop::collection::vec(other, 0..3);
    (edits(), others)
        .prop_map(|(edits, others)| edits.into_iter().map(Other::Case).chain(others).collect())
}

#[test]
fn an_edit_changes_only_the_lines_of_its_values() {
    let valid = Cell::new(0u32);
    let choices = prop::collection::vec(any::<u8>(), 1..200);
    hold(4000, &(choices, others()), |(choices, edits)| {
        let layout = Layout::of(&choices);
        let text = &layout.text;
        let mut document =
            Document::parse("case", text).unwrap_or_else(|faults| panic!("{}\n{text}", faults[0]));
        let before = values(&document.case);
        for edit in &edits {
            edit.apply(&mut document.case);
        }
        let rendered = document.render();
        let after = values(&document.case);
        let changed: Vec<&str> =
            before.symmetric_difference(&after).map(|(key, _)| key.as_str()).collect();
        let is_removed = |table: &str| {
            let is_of_it = |(key, _): &(String, String)| key.starts_with(&format!("{table}."));
            table.starts_with("variants") && !after.iter().any(is_of_it)
        };
        let is_touched = |line: usize| {
            let mut of_line = layout.lines.iter().filter(|(_, at)| *at == line);
            of_line.any(|(own, _)| match (own.strip_prefix('['), own.strip_prefix('{')) {
                // A removed distribution or variant leaves no header.
                (Some(table), _) => {
                    is_removed(table) || changed.iter().any(|key| key.starts_with(table))
                }
                (_, Some(table)) => is_removed(table),
                _ => changed
                    .iter()
                    .any(|key| own == key || own.ends_with('.') && key.starts_with(own)),
            })
        };
        let mut rest = rendered.as_str();
        for (number, line) in text.split_inclusive('\n').enumerate() {
            // A last line without a line end can get one.
            let found = rest
                .match_indices(line)
                .map(|(at, _)| at)
                .find(|&at| at == 0 || rest[..at].ends_with('\n') || number == 0);
            let is_blank = line.trim().is_empty();
            match found {
                // A blank line above a removed header is removed.
                Some(at) if !is_touched(number) && (at == 0 || !is_blank) => {
                    rest = &rest[at + line.len()..];
                }
                _ => assert!(
                    is_blank || is_touched(number),
                    "line {} {line:?} is lost by {changed:?}:\n{text}\nbecame\n{rendered}",
                    number + 1
                ),
            }
        }
        for comment in 1..=layout.comments {
            let comment = format!("# comment {comment}.");
            let line = text.lines().position(|line| line.contains(&comment));
            assert!(rendered.contains(&comment) || line.is_some_and(is_touched), "{comment}");
        }
        if document.case.inputs().is_ok() {
            valid.set(valid.get() + 1);
            let mut again = Document::parse("case", &rendered)
                .unwrap_or_else(|faults| panic!("{}\n{text}\nbecame\n{rendered}", faults[0]));
            for case in [&mut document.case, &mut again.case] {
                case.limits.sort_by_key(|limit| limit.quantity.key);
                case.spread.sort_by_key(|spread| spread.field);
            }
            assert_same(&document, &again);
        }
    });
    assert!(valid.get() > 500, "only {} valid cases", valid.get());
}
