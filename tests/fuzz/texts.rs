//! Mutated texts of cases; most of them are still TOML and many still cases.

use proptest::prelude::*;
use proptest::sample::{Index, select};
use tipstrike::case::{Document, FIELDS};

use crate::values::field_and_text;

const TABLE_1: &str = include_str!("../../cases/zhou-chen-2014.toml");
const SPEED_UP: &str = include_str!("../../cases/hydro-speed-up.toml");
const FINE: &str = include_str!("../../cases/turbo-fine-fast.toml");

/// The same pair, with every TOML syntax of a table.
const COMPACT: &str = r#"format = 1
title = 'compact' # as far as TOML allows
pair = { module = "5 mm", "pressure_angle" = "20 deg" }
driver.teeth = 20
driver.face_width = "8 mm"
"driver"."bore_radius" = """20 mm"""
operation = {
    # as installed, at most
    power = "15 kW", # of the motor
    speed = "2000 rpm", # a, b
}
spread."deviations.base_pitch" = { normal = "4 um" }

  [ driven ] # the wheel
	teeth = 2_0
	face_width = "8 mm"
[deviations]
"base_pitch" = '16 um'
[limits]
"impact_force" = "2500 N"
dynamic_factor = 1.5
[variants.relieved] # more relief
"driven.tip_relief" = "48 um" # amount
driver.teeth = 2_1
operation = { torque = "70 N m" }
spread."deviations.base_pitch" = ""
[variants.slow.limits]
impact_force = "900 N"
"#;

/// Right-hand sides of a line.
#[rustfmt::skip]
const VALUES: [&str; 32] = [
    "nan", "-inf", "1e400", "1e-400", "0x14", "0b1", "2_0", "+20", "-0.0",
        "99999999999999999999999999", "true", "1979-05-27",
    "[]", "[1, [2]]", "{}", "{ a = 1 }", "{ normal = \"4 um\" }", "\"\"", "''", "'''\n20 mm'''", "\"\"\"20 mm\"\"\"", "\"20 mm",
    "20 mm", "\"20 mm\" # end", "\"20\\u0020mm\"", "\"\\u001b[2J\"", "\"\\u202e20 mm\"", "\"1e308 mm\"", "\"1e-320 mm\"",
    "\"−20 mm\"", "\"2,0 mm\"", "",
];

/// Left-hand sides of a line.
#[rustfmt::skip]
const NAMES: [&str; 14] = [
    "modul", "\"module\"", "driver.teeth", "\"driver\" . 'teeth'", "\"\"", "\"\\u001b]0;x\\u0007\"", "\"ключ\"", "a.b.c",
    "format", "torque", "impact_force", "\"deviations.base_pitch\"", "\"a\\nb\"", "title",
];

/// Texts to insert anywhere.
#[rustfmt::skip]
const PIECES: [&str; 40] = [
    "\u{1b}[2J", "\0", "\u{9b}", "\u{85}", "\u{202e}", "\u{200b}", "\u{feff}", "\u{e0041}", "\u{2028}", "\u{ffa0}", "\u{34f}",
    "\r", "\n", "\t", "\"", "'", "\"\"\"", "'''", "[", "]", "{", "}", "=", "#", ".", ",", "\\", "é", "歯", "e999",
    "\n[driver]\n", "\n[[pair]]\n", "\n[pair.x]\n", "\n[limits]\nimpact_force = \"2 kN\"\n",
    "\n[spread]\n\"driven.teeth\" = { normal = 1 }\n", "\nformat = 2\n", "\n# a comment\n",
    "\n[spread.driver]\nyoung = { uniform = \"1 GPa\" }\n",
    "\n[variants.a]\n\"driven.tip_relief\" = \"1 um\"\n",
        "\n[variants.\"ключ\"]\npair.module = \"4 mm\"\n",
];

/// A mutation of a text.
#[derive(Debug, Clone)]
enum Mutation {
    /// A field gets another value.
    Write(usize, String),
    /// Two lines are swapped.
    Swap(Index, Index),
    Delete(Index),
    /// A line is repeated at a second place.
    Double(Index, Index),
    /// The right-hand side of a line is replaced.
    Value(Index, &'static str),
    /// The left-hand side of a line is replaced.
    Name(Index, &'static str),
    /// A line gets another syntax.
    Restyle(Index, Style),
    Insert(Index, &'static str),
    /// The value of a line is nested this deep.
    Nest(Index, usize),
    /// The end is cut off.
    Cut(Index),
    /// Lines end as on Windows.
    Crlf,
    /// The text begins with a byte order mark.
    Mark,
}

#[derive(Debug, Clone, Copy)]
enum Style {
    Quoted,
    Indented,
    Commented,
    Remarked,
    MultiLine,
    Array,
}

/// Texts of cases, from unchanged to heavily damaged.
pub(crate) fn mutated() -> impl Strategy<Value = String> {
    (select(bases()), prop::collection::vec(mutation(), 0..7)).prop_map(|(text, mutations)| {
        mutations.iter().fold(text, |text, mutation| mutation.apply(&text))
    })
}

/// Texts of cases in which only values of fields differ.
pub(crate) fn written() -> impl Strategy<Value = String> {
    (select(bases()), prop::collection::vec(field_and_text(), 0..5)).prop_map(|(text, fields)| {
        fields.iter().fold(text, |text, (field, value)| with_field(&text, *field, value))
    })
}

/// Valid cases in every layout.
pub(crate) fn bases() -> Vec<String> {
    let template = Document::new(Document::table_1().case).render();
    [TABLE_1, SPEED_UP, FINE, COMPACT].map(str::to_owned).into_iter().chain([template]).collect()
}

fn mutation() -> impl Strategy<Value = Mutation> {
    let index = any::<Index>;
    let styles = [
        Style::Quoted,
        Style::Indented,
        Style::Commented,
        Style::Remarked,
        Style::MultiLine,
        Style::Array,
    ];
    prop_oneof![
        16 => field_and_text().prop_map(|(field, text)| Mutation::Write(field, text)),
        2 => (index(), index()).prop_map(|(one, other)| Mutation::Swap(one, other)),
        2 => index().prop_map(Mutation::Delete),
        1 => (index(), index()).prop_map(|(from, to)| Mutation::Double(from, to)),
        2 => (index(), select(&VALUES[..])).prop_map(|(at, value)| Mutation::Value(at, value)),
        1 => (index(), select(&NAMES[..])).prop_map(|(at, name)| Mutation::Name(at, name)),
        4 => (index(), select(styles.to_vec())).prop_map(|(at, style)| Mutation::Restyle(at, style)),
        2 => (index(), select(&PIECES[..])).prop_map(|(at, piece)| Mutation::Insert(at, piece)),
        1 => (index(), 1..200usize).prop_map(|(at, depth)| Mutation::Nest(at, depth)),
        1 => index().prop_map(Mutation::Cut),
        1 => Just(Mutation::Crlf),
        1 => Just(Mutation::Mark),
    ]
}

impl Mutation {
    fn apply(&self, text: &str) -> String {
        match self {
            Mutation::Write(field, value) => with_field(text, *field, value),
            Mutation::Swap(one, other) => with_lines(text, |lines| {
                let (one, other) = (one.index(lines.len()), other.index(lines.len()));
                lines.swap(one, other);
            }),
            Mutation::Delete(at) => {
                with_lines(text, |lines| drop(lines.remove(at.index(lines.len()))))
            }
            Mutation::Double(from, to) => with_lines(text, |lines| {
                let line = lines[from.index(lines.len())].clone();
                lines.insert(to.index(lines.len()), line);
            }),
            Mutation::Value(at, value) => {
                with_side(text, *at, |name, _| format!("{name}= {value}"))
            }
            Mutation::Name(at, name) => with_side(text, *at, |_, value| format!("{name} ={value}")),
            Mutation::Restyle(at, style) => restyled(text, *at, *style),
            Mutation::Insert(at, piece) => {
                let (before, after) = text.split_at(character_at(text, *at));
                [before, piece, after].concat()
            }
            Mutation::Nest(at, depth) => {
                with_side(text, *at, |name, _| format!("{name}= {}", "[".repeat(*depth)))
            }
            Mutation::Cut(at) => text[..character_at(text, *at)].to_owned(),
            Mutation::Crlf => text.replace('\n', "\r\n"),
            Mutation::Mark => format!("\u{feff}{text}"),
        }
    }
}

/// Writes a field into its line, or into a new line below the header of its table.
fn with_field(text: &str, field: usize, value: &str) -> String {
    let known = &FIELDS[field];
    let quoted =
        if known.is_bare() { value.to_owned() } else { toml_edit::Value::from(value).to_string() };
    let line = format!("{} = {quoted}", known.name());
    with_lines(text, |lines| {
        let header = format!("[{}]", known.table());
        let Some(start) = (if known.table().is_empty() {
            Some(0)
        } else {
            lines.iter().position(|line| *line == header)
        }) else {
            return;
        };
        let own =
            lines[start + 1..].iter().take_while(|line| !line.starts_with('[')).position(|other| {
                other
                    .trim_start_matches(['#', ' '])
                    .strip_prefix(known.name())
                    .is_some_and(|rest| rest.trim_start().starts_with('='))
            });
        match own {
            Some(at) if value.is_empty() => drop(lines.remove(start + 1 + at)),
            Some(at) => lines[start + 1 + at] = line,
            None => lines.insert(start + 1, line),
        }
    })
}

fn restyled(text: &str, at: Index, style: Style) -> String {
    match style {
        Style::Quoted => with_side(text, at, |name, value| format!("\"{}\" ={value}", name.trim())),
        Style::Indented => with_side(text, at, |name, value| format!(" \t{name}= \t{value}")),
        Style::Remarked => with_side(text, at, |name, value| format!("{name}={value} # remark")),
        Style::MultiLine => {
            with_side(text, at, |name, value| format!("{name}= \"\"{}\"\"", value.trim()))
        }
        Style::Array => with_lines(text, |lines| {
            let at = at.index(lines.len());
            if lines[at].starts_with('[') {
                lines[at] = format!("[{}]", lines[at]);
            }
        }),
        Style::Commented => with_lines(text, |lines| {
            let at = at.index(lines.len());
            lines[at].insert(0, '#');
        }),
    }
}

fn with_lines(text: &str, change: impl FnOnce(&mut Vec<String>)) -> String {
    let mut lines: Vec<String> = text.split('\n').map(str::to_owned).collect();
    change(&mut lines);
    lines.join("\n")
}

/// Replaces one of the lines with an equals sign; `side` maps its two sides.
fn with_side(text: &str, at: Index, side: impl FnOnce(&str, &str) -> String) -> String {
    with_lines(text, |lines| {
        let mut sides: Vec<&mut String> =
            lines.iter_mut().filter(|line| line.contains('=')).collect();
        if sides.is_empty() {
            return;
        }
        let at = at.index(sides.len());
        if let Some((name, value)) = sides[at].split_once('=') {
            *sides[at] = side(name, value);
        }
    })
}

/// A position between two characters.
fn character_at(text: &str, at: Index) -> usize {
    let count = text.chars().count();
    text.char_indices().nth(at.index(count + 1)).map_or(text.len(), |(at, _)| at)
}
