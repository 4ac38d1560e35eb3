//! A problem of a case: its place, its cause and its fix.

use std::fmt;

use super::fields::key_of;
use super::sanitize::sanitize;
use crate::model::Refusal;
use serde::{Deserialize, Deserializer, Serialize, Serializer};

/// A problem at one place: the cause and the fix.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Problem {
    /// The field's key, or an unknown key as written.
    pub field: String,
    /// The name of a kind of problem whose sentences differ only in their numbers, or empty.
    pub code: Box<str>,
    /// The cause.
    pub cause: String,
    /// How to fix it.
    pub fix: Fix,
}

/// The code of a required value that is missing.
pub(super) const MISSING: &str = "missing";
/// The code of a file of a newer format.
pub const NEWER_FORMAT: &str = "newer-format";

/// How to fix a problem.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Fix {
    /// Write a value of a field, such as this example in TOML.
    Assign {
        /// The key of the field.
        key: &'static str,
        /// The example.
        example: String,
    },
    /// Any other fix.
    Text(String),
}

impl Problem {
    /// A problem of a field without a code.
    pub fn new(field: &str, cause: impl Into<String>, fix: impl Into<Fix>) -> Problem {
        Problem { field: field.to_owned(), code: "".into(), cause: cause.into(), fix: fix.into() }
    }

    /// The same problem with a code.
    #[must_use]
    pub(super) fn coded(self, code: &str) -> Problem {
        Problem { code: code.into(), ..self }
    }

    /// The same problem of another field.
    #[must_use]
    pub fn at(self, field: &str) -> Problem {
        Problem { field: field.to_owned(), ..self }
    }

    /// Whether another problem differs at most in its numbers.
    #[must_use]
    pub fn is_like(&self, other: &Problem) -> bool {
        let is_same = if self.code.is_empty() { self.fix == other.fix } else { true };
        (&self.field, &self.code) == (&other.field, &other.code) && is_same
    }
}

impl From<&Refusal> for Problem {
    fn from(refusal: &Refusal) -> Problem {
        let field = key_of(refusal.at());
        Problem::new(field, refusal.to_string(), refusal.fix()).coded(refusal.code())
    }
}

impl<T: Into<String>> From<T> for Fix {
    fn from(text: T) -> Fix {
        Fix::Text(text.into())
    }
}

impl Serialize for Fix {
    fn serialize<S: Serializer>(&self, serializer: S) -> Result<S::Ok, S::Error> {
        serializer.collect_str(self)
    }
}

impl<'de> Deserialize<'de> for Fix {
    fn deserialize<D: Deserializer<'de>>(deserializer: D) -> Result<Fix, D::Error> {
        String::deserialize(deserializer).map(Fix::Text)
    }
}

/// One line: `field: cause: fix`.
impl fmt::Display for Problem {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let Problem { field, cause, fix, .. } = self;
        write!(f, "{}: {}: {}", sanitize(field), sanitize(cause), sanitize(&fix.to_string()))
    }
}

impl fmt::Display for Fix {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Fix::Text(text) => f.write_str(text),
            Fix::Assign { key, example } => match key.split_once('.') {
                None => write!(f, "write {key} = {example}"),
                Some((table, name)) => write!(f, "write {name} = {example} under [{table}]"),
            },
        }
    }
}

impl std::error::Error for Problem {}
