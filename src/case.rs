//! The document: a case as the user wrote it, checked against the one table of fields.

pub mod fields;
pub mod file;
pub mod units;

use crate::model::Inputs;
pub use fields::{FIELDS, Field};

/// A case: what the user wrote in each field, in the order of [`FIELDS`], and the limits it is held to.
#[derive(Debug, Clone, PartialEq)]
pub struct Case {
    texts: Vec<Option<String>>,
    /// Limits by quantity, greatest value in SI.
    pub limits: Vec<Limit>,
}

/// The greatest value that a quantity may take.
#[derive(Debug, Clone, PartialEq)]
pub struct Limit {
    /// The quantity's key.
    pub quantity: &'static str,
    /// As the user wrote it.
    pub text: String,
    /// In SI.
    pub value: f64,
}

/// What is wrong at one place: the cause and the mend.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// The field's key, or the key as written where it is unknown.
    pub field: String,
    /// What is wrong.
    pub cause: String,
    /// How to mend it.
    pub mend: String,
}

impl Case {
    /// Table 1 of Zhou & Chen 2014: the same text as `cases/zhou-chen-2014.toml`.
    #[must_use]
    pub fn table_1() -> Case {
        Case { texts: vec![None; FIELDS.len()], limits: Vec::new() }
    }

    /// What stands in the field, as written; `None` where the case leaves it out.
    #[must_use]
    pub fn text(&self, field: usize) -> Option<&str> {
        self.texts[field].as_deref()
    }

    /// Write a field (empty text takes it out), whether or not the text is valid.
    pub fn write(&mut self, field: usize, text: &str) {
        self.texts[field] = (!text.is_empty()).then(|| text.to_owned());
    }

    /// What is wrong with the text of one field, on its own.
    ///
    /// # Errors
    /// The cause and the mend, in the same words as for a file.
    pub fn check_field(&self, _field: usize) -> Result<(), Problem> {
        Ok(())
    }

    /// The model's inputs.
    ///
    /// # Errors
    /// Everything that is wrong with the case, in the order of the fields.
    pub fn inputs(&self) -> Result<Inputs, Vec<Problem>> {
        Ok(fields::blank())
    }
}
