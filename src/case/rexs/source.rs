//! Values for the fields of a case, each with its source in the model.

use super::model::{Attribute, Component};
use super::units;
use crate::case::sanitize::quoted;
use crate::case::units::Dimension;

/// The value of the model for a field, or the reason why there is none.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) enum Found {
    /// A value as written in the case file, and its source.
    Value {
        /// The value with its unit.
        text: String,
        /// The source, such as `normal_module of cylindrical_gear 23`.
        source: String,
    },
    /// The reason why the field stays empty.
    Absent(String),
}

/// The reason why an attribute gives no value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(super) struct Problem {
    pub(super) words: String,
    /// Two readings of the same value differ.
    pub(super) is_unequal: bool,
}

impl From<Problem> for String {
    fn from(problem: Problem) -> String {
        problem.words
    }
}

impl Problem {
    fn unreadable(words: String) -> Problem {
        Problem { words, is_unequal: false }
    }
}

/// The values of the model for the fields.
#[derive(Debug, Default)]
pub(super) struct Values {
    fields: Vec<(&'static str, Found)>,
    /// Reasons why the stage cannot become a case.
    pub(super) refusals: Vec<String>,
    /// Assumptions and hints for the reader of the case.
    pub(super) remarks: Vec<String>,
}

impl Values {
    pub(super) fn put(&mut self, key: &'static str, found: Found) {
        self.fields.push((key, found));
    }

    /// Writes the value of the first of several components that give it.
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
    /// The value with its unit, as written in a case file.
    pub(super) text: String,
    /// The value in SI.
    pub(super) value: f64,
    /// The source, such as `normal_module of cylindrical_gear 23`.
    pub(super) source: String,
}

impl Reading {
    /// The reading as a value of a field.
    pub(super) fn found(self) -> Found {
        Found::Value { text: self.text, source: self.source }
    }
}

/// An attribute to find: its id, its dimension, and its default unit.
#[derive(Debug, Clone, Copy)]
pub(super) struct Wanted {
    pub(super) id: &'static str,
    pub(super) dimension: Dimension,
    pub(super) unit: &'static str,
}

impl Wanted {
    pub(super) const fn new(id: &'static str, dimension: Dimension, unit: &'static str) -> Wanted {
        Wanted { id, dimension, unit }
    }

    pub(super) const fn number(id: &'static str) -> Wanted {
        Wanted::new(id, Dimension::Number, "")
    }

    pub(super) const fn length(id: &'static str) -> Wanted {
        Wanted::new(id, Dimension::Length, "mm")
    }

    /// The value in a component. `None` if the component does not have it.
    ///
    /// # Errors
    /// If the value cannot be read.
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
        first.map(|attribute| self.reading(attribute, &component.label())).transpose()
    }

    /// The value of an attribute of the labelled component.
    ///
    /// # Errors
    /// If the value cannot be read.
    pub(super) fn reading(self, attribute: &Attribute, label: &str) -> Result<Reading, Problem> {
        let source = format!("{} of {label}", self.id);
        let (text, value) = units::read(attribute, self.dimension, self.unit)
            .map_err(|cause| Problem::unreadable(format!("{source}: {cause}")))?;
        Ok(Reading { text, value, source })
    }

    /// The value of the first component that has it.
    ///
    /// # Errors
    /// If the value cannot be read.
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

/// A reading as the value of a field. `missing` is the reason if there is none.
pub(super) fn found(reading: Result<Option<Reading>, impl Into<String>>, missing: &str) -> Found {
    match reading {
        Ok(Some(reading)) => reading.found(),
        Ok(None) => Found::Absent(missing.to_owned()),
        Err(problem) => Found::Absent(problem.into()),
    }
}

/// The first of two readings that must agree. One of them can be missing.
///
/// # Errors
/// If the readings differ. The error names both.
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

/// Whether two values are equal within the rounding of a printed value.
fn are_equal(a: f64, b: f64) -> bool {
    (a - b).abs() <= 1e-9 * a.abs().max(b.abs())
}
