//! A problem at one place of a case: the cause and the fix.

use crate::case::Case;
use crate::case::fields::{FIELDS, index_of};
use crate::case::sanitize::{quoted, sanitize};
use crate::case::suggest;
use crate::case::units::ParseError;
use crate::model::{QUANTITIES, Quantity, Refusal};

/// A problem at one place: the cause and the fix.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Problem {
    /// The field's key, or an unknown key as written.
    pub field: String,
    /// The cause.
    pub cause: String,
    /// How to fix it.
    pub fix: String,
}

impl Problem {
    pub(in crate::case) fn new(
        field: &str,
        cause: impl Into<String>,
        fix: impl Into<String>,
    ) -> Problem {
        Problem { field: field.to_owned(), cause: cause.into(), fix: fix.into() }
    }

    /// An invalid value, as a problem of its field.
    pub(in crate::case) fn of(field: &str, misread: ParseError) -> Problem {
        Problem::new(field, misread.cause, misread.fix)
    }
}

/// One line: `field: cause: fix`.
impl std::fmt::Display for Problem {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        write!(f, "{}: {}: {}", sanitize(&self.field), sanitize(&self.cause), sanitize(&self.fix))
    }
}

impl std::error::Error for Problem {}

impl Problem {
    /// The problem at the alternative of its field if the case gives the alternative.
    #[must_use]
    pub fn at_given(mut self, case: &Case) -> Problem {
        let field = index_of(&self.field).filter(|&field| case.is_replaced(field));
        let given = field.and_then(|field| FIELDS[field].partner());
        if let Some(given) = given.filter(|&given| case.text(given).is_some()) {
            FIELDS[given].key.clone_into(&mut self.field);
        }
        self
    }
}

impl From<&Refusal> for Problem {
    fn from(refusal: &Refusal) -> Problem {
        Problem::new(refusal.field(), refusal.to_string(), refusal.fix())
    }
}

/// The refusal of an unknown key.
#[must_use]
pub fn unknown_key(key: &str) -> Problem {
    let known = FIELDS.iter().map(|field| field.key);
    let name = key.rsplit('.').next().unwrap_or(key);
    let same_name = FIELDS
        .iter()
        .find(|field| field.name() == name)
        .map(|field| format!("did you mean {}?", field.key));
    let fix = same_name.unwrap_or_else(|| {
        suggest::fix(key, known, || "`tipstrike fields` lists every key".to_owned())
    });
    Problem::new(key, format!("unknown key {}", quoted(key)), fix)
}

/// The refusal of a limit on a quantity that does not exist.
#[must_use]
pub fn unknown_quantity(field: &str, quantity: &str) -> Problem {
    let is_symbol = |known: &&Quantity| {
        !known.symbol.is_empty() && known.symbol.eq_ignore_ascii_case(quantity.trim())
    };
    if let Some(known) = QUANTITIES.iter().find(is_symbol) {
        if known.symbol == quantity.trim() {
            let cause = format!("{} is the symbol of {}", quoted(quantity), known.key);
            return Problem::new(field, cause, format!("write {}", known.key));
        }
        let cause = format!("unknown quantity {}", quoted(quantity));
        let fix = format!("did you mean {}, {}?", known.symbol, known.key);
        return Problem::new(field, cause, fix);
    }
    if quantity.trim().is_empty() {
        return Problem::new(
            field,
            "no quantity is named",
            "write names with commas between them, such as impact_force,contact_ratio",
        );
    }
    if quantity.trim().contains(' ') {
        let cause = format!("unknown quantity {}", quoted(quantity));
        return Problem::new(field, cause, "put commas between names");
    }
    let known = QUANTITIES.iter().map(|quantity| quantity.key);
    let fix = suggest::fix(quantity, known, || {
        "`tipstrike fields --results` lists every quantity".to_owned()
    });
    Problem::new(field, format!("unknown quantity {}", quoted(quantity)), fix)
}
