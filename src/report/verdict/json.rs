//! Verdicts as JSON, one object per verdict: SI units, full precision, without absent values.

use super::{Beside, Standing, Verdict};
use crate::model::Quantity;
use crate::model::inputs::Method;
use crate::report::json::write_line;
use serde::Serialize;
use std::io::{self, Write};

#[derive(Serialize)]
struct Line<'a> {
    case: &'a str,
    method: &'static str,
    standing: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    quantity: Option<&'static str>,
    #[serde(skip_serializing_if = "Option::is_none")]
    value: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    limit: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<&'static str>,
    /// `free-impact` if the method resolves the impact itself.
    #[serde(skip_serializing_if = "Option::is_none")]
    of: Option<&'static str>,
    /// The counterpart in the method.
    #[serde(skip_serializing_if = "Option::is_none")]
    own: Option<Own>,
    message: String,
}

#[derive(Serialize)]
struct Own {
    quantity: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    value: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    unit: Option<&'static str>,
}

impl Own {
    fn of(beside: &Beside) -> Option<Own> {
        let (quantity, value) = beside.own?;
        Some(Own { quantity, value, unit: Quantity::find(quantity).map(|own| own.unit) })
    }
}

/// Writes the verdicts on a case, one line each; one line for a case without limits.
///
/// # Errors
/// Errors of the writer.
pub fn write(
    verdicts: &[Verdict],
    case: &str,
    method: Method,
    out: &mut dyn Write,
) -> io::Result<()> {
    if verdicts.is_empty() {
        let message = "no limits".to_owned();
        let standing = Standing::Within.name();
        let method = method.name();
        let (quantity, value, limit, unit, of, own) = (None, None, None, None, None, None);
        return write_line(
            &Line { case, method, standing, quantity, value, limit, unit, of, own, message },
            out,
        );
    }
    let line = |verdict: &Verdict| Line {
        case,
        method: method.name(),
        standing: verdict.standing.name(),
        quantity: Some(verdict.limit.quantity),
        value: verdict.value,
        limit: Some(verdict.limit.value),
        unit: Quantity::find(verdict.limit.quantity).map(|quantity| quantity.unit),
        of: verdict.beside.map(|_| "free-impact"),
        own: verdict.beside.as_ref().and_then(Own::of),
        message: verdict.to_string(),
    };
    verdicts.iter().try_for_each(|verdict| write_line(&line(verdict), out))
}
