//! A page as one JSON object on one line.

use super::corrections::Correction;
use super::derivation::{How, Leaf, Work};
use super::effects::Effect;
use super::page::Page;
use super::substitution::GLUE;
use crate::model::explanation::Finding;
use crate::report::Shown;
use crate::report::json::write_line;
use serde::Serialize;
use std::io::{self, Write};

#[derive(Serialize)]
struct Line<'a> {
    case: &'a str,
    method: &'static str,
    key: &'static str,
    symbol: &'static str,
    label: &'static str,
    equation: &'static str,
    unit: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    value: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    shown: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    missing: Option<&'a str>,
    meaning: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    beside: Option<&'a str>,
    derivation: Vec<WorkLine<'a>>,
    with: Vec<LeafLine<'a>>,
    source: &'static str,
    corrections: Vec<CorrectionLine>,
    assumptions: &'static str,
    validity: Vec<FindingLine<'a>>,
    accuracy: &'a [String],
    sensitivity: Vec<EffectLine<'a>>,
}

#[derive(Serialize)]
struct WorkLine<'a> {
    symbol: &'a str,
    #[serde(skip_serializing_if = "str::is_empty")]
    meaning: &'a str,
    how: &'static str,
    formula: &'a str,
    #[serde(skip_serializing_if = "Option::is_none")]
    numbers: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    shown: Option<String>,
    #[serde(skip_serializing_if = "Option::is_none")]
    residual: Option<&'a str>,
}

#[derive(Serialize)]
struct LeafLine<'a> {
    symbol: &'a str,
    key: &'a str,
    shown: &'a str,
    meaning: &'a str,
}

#[derive(Serialize)]
struct CorrectionLine {
    equation: &'static str,
    error: &'static str,
    used: &'static str,
}

#[derive(Serialize)]
struct FindingLine<'a> {
    range: &'a str,
    here: &'a str,
    inside: bool,
}

#[derive(Serialize)]
struct EffectLine<'a> {
    key: &'a str,
    text: &'a str,
    #[serde(skip_serializing_if = "str::is_empty")]
    step: &'a str,
    #[serde(skip_serializing_if = "str::is_empty")]
    change: &'a str,
}

/// Writes the page as one line; `name` is the name of the case.
///
/// # Errors
/// Errors of the writer.
pub fn write(page: &Page, name: &str, out: &mut dyn Write) -> io::Result<()> {
    let quantity = page.quantity;
    let line = Line {
        case: name,
        method: page.method,
        key: quantity.key,
        symbol: page.symbol,
        label: page.label,
        equation: quantity.equation,
        unit: quantity.unit,
        value: page.value,
        shown: page.shown.as_ref().map(Shown::to_string),
        missing: page.missing.as_deref(),
        meaning: page.meaning,
        beside: page.beside.as_deref(),
        derivation: page.derivation.iter().map(WorkLine::of).collect(),
        with: page.leaves.iter().map(LeafLine::of).collect(),
        source: page.source,
        corrections: page
            .corrections
            .iter()
            .map(|correction| CorrectionLine::of(correction))
            .collect(),
        assumptions: page.assumptions,
        validity: page.validity.iter().map(FindingLine::of).collect(),
        accuracy: &page.accuracy,
        sensitivity: page.effects.iter().map(EffectLine::of).collect(),
    };
    write_line(&line, out)
}

impl WorkLine<'_> {
    fn of(work: &Work) -> WorkLine<'_> {
        WorkLine {
            symbol: work.symbol,
            meaning: work.meaning,
            how: match work.how {
                How::Equals => "equals",
                How::Solves => "solves",
                How::Described => "described",
            },
            formula: &work.formula,
            numbers: work.numbers.as_ref().map(|numbers| numbers.replace(GLUE, " ")),
            shown: work.shown.as_ref().map(Shown::to_string),
            residual: work.residual.as_deref(),
        }
    }
}

impl CorrectionLine {
    fn of(correction: &Correction) -> CorrectionLine {
        CorrectionLine {
            equation: correction.equation,
            error: correction.error,
            used: correction.used,
        }
    }
}

impl LeafLine<'_> {
    fn of(leaf: &Leaf) -> LeafLine<'_> {
        LeafLine { symbol: leaf.symbol, key: leaf.key, shown: &leaf.shown, meaning: leaf.meaning }
    }
}

impl FindingLine<'_> {
    fn of(finding: &Finding) -> FindingLine<'_> {
        FindingLine { range: &finding.range, here: &finding.here, inside: finding.inside }
    }
}

impl EffectLine<'_> {
    fn of(effect: &Effect) -> EffectLine<'_> {
        EffectLine {
            key: effect.key,
            text: &effect.text,
            step: &effect.step,
            change: &effect.change,
        }
    }
}
