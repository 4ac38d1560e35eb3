//! Reasons why a model cannot become a case: place, cause and fix on one line.

use crate::case::sanitize::sanitize;

/// The reason why a model of another program cannot become a case.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Refusal {
    file: String,
    /// Line and column, from 1, for an error in the text.
    place: Option<(usize, usize)>,
    cause: String,
    fix: String,
}

/// Refuses more than `most` of the named parts.
pub(super) fn within(count: usize, most: usize, parts: &str) -> Result<(), Refusal> {
    if count <= most {
        return Ok(());
    }
    Err(Refusal::new(
        format!("the model has more than {most} {parts}"),
        "export the gear pair alone and without results",
    ))
}

impl Refusal {
    pub(super) fn new(cause: impl Into<String>, fix: impl Into<String>) -> Refusal {
        Refusal { file: String::new(), place: None, cause: cause.into(), fix: fix.into() }
    }

    pub(super) fn at(self, line: usize, column: usize) -> Refusal {
        Refusal { place: Some((line, column)), ..self }
    }

    pub(super) fn of(self, file: &str) -> Refusal {
        Refusal { file: file.to_owned(), ..self }
    }
}

impl std::fmt::Display for Refusal {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: ", sanitize(&self.file))?;
        if let Some((line, column)) = self.place {
            write!(f, "{line}:{column}: ")?;
        }
        write!(f, "{}: {}", sanitize(&self.cause), sanitize(&self.fix))
    }
}

impl std::error::Error for Refusal {}
