//! Values for the fields of a case, each with its source in the model.

use super::model::{Attribute, Component};
use super::units;
use crate::case::sanitize::quoted;
use crate::case::units::Dimension;

/// What the model gives for a field.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Found {
    /// A value as the case file writes it, and where it comes from.
    Value {
        /// The value with its unit.
        text: String,
        /// Such as `normal_module of cylindrical_gear 23`.
        source: String,
    },
    /// Why the field stays empty.
    Absent(String),
}

/// Why an attribute gives no value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Problem {
    pub(super) words: String,
    /// Two readings of what must be one value differ.
    pub(super) is_unequal: bool,
}

impl From<Problem> for String {
    fn from(problem: Problem) -> String {
        problem.words
    }
}

impl Problem {
    fn unreadable(words: String) -> Problem {
        Problem {
            words,
            is_unequal: false,
        }
    }
}

/// What the model gives for every field that was looked for.
#[derive(Debug, Default)]
pub(super) struct Values {
    fields: Vec<(&'static str, Found)>,
    /// Why the stage cannot become a case at all.
    pub(super) refusals: Vec<String>,
    /// What a reader of the case should know beside its values.
    pub(super) remarks: Vec<String>,
}

impl Values {
    pub(super) fn put(&mut self, key: &'static str, found: Found) {
        self.fields.push((key, found));
    }

    /// Puts a value that several components may give; the first counts.
    pub(super) fn put_once(&mut self, key: &'static str, found: Found) {
        if self.fields.iter().all(|(known, _)| *known != key) {
            self.put(key, found);
        }
    }

    pub(super) fn into_fields(self) -> Vec<(&'static str, Found)> {
        self.fields
    }
}

/// One attribute of one component, read in its unit.
#[derive(Debug, Clone, PartialEq)]
pub(super) struct Reading {
    /// The value with its unit, as a case file writes it.
    pub(super) text: String,
    /// In SI.
    pub(super) value: f64,
    /// Such as `normal_module of cylindrical_gear 23`.
    pub(super) source: String,
}

impl Reading {
    /// As the case file takes it.
    pub(super) fn found(self) -> Found {
        Found::Value {
            text: self.text,
            source: self.source,
        }
    }
}

/// An attribute to look for: its id, its dimension, and its unit where the model gives none.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wanted {
    pub(super) id: &'static str,
    pub(super) dimension: Dimension,
    pub(super) unit: &'static str,
}

impl Wanted {
    pub(super) const fn new(id: &'static str, dimension: Dimension, unit: &'static str) -> Wanted {
        Wanted {
            id,
            dimension,
            unit,
        }
    }

    pub(super) const fn number(id: &'static str) -> Wanted {
        Wanted::new(id, Dimension::Number, "")
    }

    pub(super) const fn length(id: &'static str) -> Wanted {
        Wanted::new(id, Dimension::Length, "mm")
    }

    /// The value in a component; none where the component lacks it.
    ///
    /// # Errors
    /// Where it is there and cannot be read.
    pub(super) fn read(self, component: &Component) -> Result<Option<Reading>, Problem> {
        let mut given = component.given(self.id);
        let first = given.next();
        if let Some(other) = given.find(|other| first != Some(*other)) {
            return Err(Problem::unreadable(format!(
                "{} has two values of {}, {} and {}",
                component.label(),
                self.id,
                quoted(first.map_or("", |first| &first.value)),
                quoted(&other.value),
            )));
        }
        first
            .map(|attribute| self.reading(attribute, &component.label()))
            .transpose()
    }

    /// The value of an attribute of the labelled component.
    ///
    /// # Errors
    /// Where it cannot be read.
    pub(super) fn reading(self, attribute: &Attribute, label: &str) -> Result<Reading, Problem> {
        let source = format!("{} of {label}", self.id);
        let (text, value) = units::read(attribute, self.dimension, self.unit)
            .map_err(|cause| Problem::unreadable(format!("{source}: {cause}")))?;
        Ok(Reading {
            text,
            value,
            source,
        })
    }

    /// The first component that has the value.
    ///
    /// # Errors
    /// Where it is there and cannot be read.
    pub(super) fn first<'a>(
        self,
        components: impl IntoIterator<Item = &'a Component>,
    ) -> Result<Option<Reading>, Problem> {
        for component in components {
            if let Some(reading) = self.read(component)? {
                return Ok(Some(reading));
            }
        }
        Ok(None)
    }
}

/// A reading as what a field takes; `missing` is the reason where there is none.
pub(super) fn found(reading: Result<Option<Reading>, impl Into<String>>, missing: &str) -> Found {
    match reading {
        Ok(Some(reading)) => reading.found(),
        Ok(None) => Found::Absent(missing.to_owned()),
        Err(problem) => Found::Absent(problem.into()),
    }
}

/// Two readings of what must be one value: the first, where they agree or one is missing.
///
/// # Errors
/// Where they differ: both, in words.
pub(super) fn agreed(
    first: Option<Reading>,
    second: Option<Reading>,
) -> Result<Option<Reading>, Problem> {
    match (first, second) {
        (Some(first), Some(second)) if !are_equal(first.value, second.value) => Err(Problem {
            words: format!(
                "{} is {}, {} is {}",
                first.source, first.text, second.source, second.text
            ),
            is_unequal: true,
        }),
        (first, second) => Ok(first.or(second)),
    }
}

/// Equal but for the rounding of a printed value.
fn are_equal(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * a.abs().max(b.abs())
}
