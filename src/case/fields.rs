//! The one table of fields, from which the form, the TOML keys, `--set` and the help are derived.

mod derived;
pub mod reasons;
mod table;

use super::units::Dimension;
use crate::model::Inputs;
use crate::numeric::decimal::shortest;

use reasons::{Reason, When};
pub use table::FIELDS;

/// One line of the form, one key of the case file.
#[derive(Debug, Clone, Copy)]
pub struct Field {
    /// The dotted key in the case file, such as `pair.module`.
    pub key: &'static str,
    /// The symbol in the field's writing.
    pub symbol: &'static str,
    /// A few words for a person.
    pub label: &'static str,
    /// One sentence of help.
    pub help: &'static str,
    /// What it holds.
    pub kind: Kind,
    /// Whether a case may leave it out, and the value it has then.
    pub absent: Absent,
    /// A text that shows how to write a value; empty where the default or a choice shows it.
    pub example: &'static str,
    /// The key of the field that gives the same measure in another way; a case has one of them.
    pub alternative: Option<&'static str>,
    /// Its value, in SI, from other fields where the case leaves it out.
    pub derived: Option<Derive>,
    /// Why it makes no difference in some cases, or less than expected; the first that fits counts.
    pub reasons: &'static [Reason],
    /// Whether a case reads it, where the inputs of the stages do not decide.
    pub read_when: Option<When>,
}

/// A value in SI that follows from the inputs; `None` where they are not enough.
pub type Derive = fn(&Inputs) -> Option<f64>;

/// What a field holds.
#[derive(Debug, Clone, Copy)]
pub enum Kind {
    /// Words.
    Text,
    /// A value of a dimension, or a bare number where the dimension is [`Dimension::Number`].
    Number(Dimension, Range, fn(&mut Inputs, f64)),
    /// A whole number; 0 stands for "auto" where the field takes it.
    Count(u32, u32, fn(&mut Inputs, u32)),
    /// One of a few names.
    Choice(&'static [&'static str], fn(&mut Inputs, usize)),
}

/// A value of a field, in SI.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Value {
    /// Of a field of words, which no model reads.
    Text,
    /// Of a number.
    Number(f64),
    /// Of a whole number.
    Count(u32),
    /// Of a choice, by its place in the list.
    Choice(usize),
}

/// What stands in place of a number that the program finds itself.
pub const AUTO: &str = "auto";

/// The names of a choice that TOML writes as a bare truth value.
pub const FLAG: &[&str] = &["false", "true"];

/// The values that a field takes, in SI, both ends included unless said.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Range {
    /// Least value, in the unit `unit`.
    pub from: f64,
    /// Greatest value, in the unit `unit`.
    pub to: f64,
    /// The unit in which a person reads the range and in which a new value starts.
    pub unit: &'static str,
}

impl Range {
    /// From `from` to `to`, both in `unit`.
    const fn new(from: f64, to: f64, unit: &'static str) -> Range {
        Range { from, to, unit }
    }
}

/// What holds when a case leaves a field out.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Absent {
    /// It may not be left out.
    Refused,
    /// This text stands for it.
    Default(&'static str),
    /// The model does without; a person reads these words instead of a value.
    Without(&'static str),
    /// Exactly one of this field and its alternative is given.
    Either,
}

impl Field {
    /// The unit in which values of the field are mostly written; empty for a number, a count, a
    /// choice and words.
    #[must_use]
    pub fn usual_unit(&self) -> &'static str {
        match self.kind {
            Kind::Number(..) => self.example().split_once(' ').map_or("", |(_, unit)| unit),
            Kind::Text | Kind::Count(..) | Kind::Choice(..) => "",
        }
    }

    /// The place in [`FIELDS`] of its alternative, if it has one.
    #[must_use]
    pub fn partner(&self) -> Option<usize> {
        self.alternative.and_then(index_of)
    }

    /// The table of the case file in which the field stands; empty for the top level.
    #[must_use]
    pub fn table(&self) -> &'static str {
        self.key.split_once('.').map_or("", |(table, _)| table)
    }

    /// Whether it describes one of the gears.
    #[must_use]
    pub fn is_of_gear(&self) -> bool {
        matches!(self.table(), "driver" | "driven")
    }

    /// The label, with the gear where both gears have such a field: `driven tip relief`.
    #[must_use]
    pub fn full_label(&self) -> String {
        if self.is_of_gear() {
            format!("{} {}", self.table(), self.label)
        } else {
            self.label.to_owned()
        }
    }

    /// The key within its table.
    #[must_use]
    pub fn name(&self) -> &'static str {
        self.key.split_once('.').map_or(self.key, |(_, name)| name)
    }
}

impl Field {
    /// A field of text, from which rows start.
    const PLAIN: Field = Field {
        key: "",
        symbol: "",
        label: "",
        help: "",
        kind: Kind::Text,
        absent: Absent::Default(""),
        example: "",
        alternative: None,
        derived: None,
        reasons: &[],
        read_when: None,
    };

    const fn with_example(self, example: &'static str) -> Field {
        Field { example, ..self }
    }

    const fn instead_of(self, alternative: &'static str, derived: Derive) -> Field {
        Field {
            alternative: Some(alternative),
            ..self.derived(derived)
        }
    }

    const fn derived(self, derived: Derive) -> Field {
        let derived = Some(derived);
        Field { derived, ..self }
    }

    const fn reasons(self, reasons: &'static [Reason]) -> Field {
        Field { reasons, ..self }
    }

    const fn read_when(self, when: When) -> Field {
        let read_when = Some(when);
        Field { read_when, ..self }
    }

    /// Puts a value of this field into a model's inputs.
    pub fn put(&self, value: Value, inputs: &mut Inputs) {
        match (self.kind, value) {
            (Kind::Number(_, _, put), Value::Number(value)) => put(inputs, value),
            (Kind::Count(_, _, put), Value::Count(value)) => put(inputs, value),
            (Kind::Choice(_, put), Value::Choice(value)) => put(inputs, value),
            _ => {}
        }
    }

    /// Whether it takes true or false.
    #[must_use]
    pub fn is_flag(&self) -> bool {
        matches!(self.kind, Kind::Choice(names, _) if names == FLAG)
    }

    /// Whether the word "auto" may stand in place of the number.
    #[must_use]
    pub fn takes_auto(&self) -> bool {
        self.key == "model.stations"
    }

    /// Whether its value stands in a file without quotes.
    #[must_use]
    pub fn is_bare(&self) -> bool {
        self.is_flag()
            || matches!(
                self.kind,
                Kind::Count(..) | Kind::Number(Dimension::Number, ..)
            )
    }

    /// A text that the field takes, to show how one is written.
    #[must_use]
    pub fn example(&self) -> &'static str {
        match (self.absent, self.kind) {
            (Absent::Default(text), _) if !text.is_empty() => text,
            (_, Kind::Choice(names, _)) => names.first().copied().unwrap_or_default(),
            (_, Kind::Text) => "a few words",
            _ => self.example,
        }
    }

    /// The least and the greatest value as a person reads them; empty for words and choices.
    #[must_use]
    pub fn range_text(&self) -> String {
        match self.kind {
            Kind::Count(from, to, _) if self.takes_auto() => format!("{from} to {to}, or {AUTO}"),
            Kind::Count(from, to, _) => format!("{from} to {to}"),
            Kind::Number(_, range, _) if range.unit.is_empty() => {
                format!("{} to {}", shortest(range.from), shortest(range.to))
            }
            Kind::Number(_, range, _) => format!(
                "{} to {} {}",
                shortest(range.from),
                shortest(range.to),
                range.unit
            ),
            Kind::Text => String::new(),
            Kind::Choice(names, _) => names.join(", "),
        }
    }
}

/// The place of a key in [`FIELDS`].
#[must_use]
pub fn index_of(key: &str) -> Option<usize> {
    FIELDS.iter().position(|field| field.key == key)
}

/// The groups of the form: the table's name in the file and its title.
pub const GROUPS: [(&str, &str); 7] = [
    ("", "Case"),
    ("pair", "Pair"),
    ("driver", "Driver (gear 1)"),
    ("driven", "Driven (gear 2)"),
    ("deviations", "Deviations"),
    ("operation", "Operation"),
    ("model", "Model"),
];
