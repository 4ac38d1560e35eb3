//! Where the model stops being right: refusals, and notes beside a result.

use thiserror::Error;

/// Why a pair cannot be solved.
#[derive(Debug, Clone, PartialEq, Error)]
pub enum Refusal {
    /// The driven tip would touch the driver below its base circle.
    #[error("interference at the start of contact: N1E is {start:.6} m and must be above 0")]
    Interference {
        /// N₁E, in m.
        start: f64,
    },
}

impl Refusal {
    /// A short name for scripts.
    #[must_use]
    pub fn code(&self) -> &'static str {
        match self {
            Refusal::Interference { .. } => "interference",
        }
    }

    /// The key of the field where the mend begins.
    #[must_use]
    pub fn field(&self) -> &'static str {
        match self {
            Refusal::Interference { .. } => "driven.addendum",
        }
    }

    /// How to mend it.
    #[must_use]
    pub fn mend(&self) -> &'static str {
        match self {
            Refusal::Interference { .. } => {
                "shorten the driven addendum, shift the driver's profile outward or give it more teeth"
            }
        }
    }
}

/// Something a reader must know beside a result.
#[derive(Debug, Clone, PartialEq)]
pub struct Note {
    /// A short name for scripts.
    pub code: &'static str,
    /// One sentence with the value and the limit.
    pub message: String,
}
