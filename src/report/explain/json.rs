//! An explanation as one JSON object on one line.

use super::numbers::GLUE;
use super::{Correction, Effect, Finding, How, Leaf, Page, Work};
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
    says: &'static str,
    #[serde(skip_serializing_if = "Option::is_none")]
    beside: Option<&'a str>,
    work: Vec<WorkLine<'a>>,
    with: Vec<LeafLine<'a>>,
    source: &'static str,
    mended: Vec<MendLine>,
    assumes: &'static str,
    valid: Vec<FindingLine<'a>>,
    worth: &'a [String],
    depends_on: Vec<EffectLine<'a>>,
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
struct MendLine {
    equation: &'static str,
    wrong: &'static str,
    used: &'static str,
}

#[derive(Serialize)]
struct FindingLine<'a> {
    range: &'a str,
    here: &'a str,
    holds: bool,
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

/// Write the page as one line; `name` says of which case it is.
///
/// # Errors
/// What the writer refuses.
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
        says: page.says,
        beside: page.beside.as_deref(),
        work: page.work.iter().map(WorkLine::of).collect(),
        with: page.leaves.iter().map(LeafLine::of).collect(),
        source: page.source,
        mended: page
            .mended
            .iter()
            .map(
                |&&Correction {
                     equation,
                     wrong,
                     used,
                 }| MendLine {
                    equation,
                    wrong,
                    used,
                },
            )
            .collect(),
        assumes: page.assumes,
        valid: page.valid.iter().map(FindingLine::of).collect(),
        worth: &page.worth,
        depends_on: page.effects.iter().map(EffectLine::of).collect(),
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
                How::Told => "told",
            },
            formula: &work.formula,
            numbers: work
                .numbers
                .as_ref()
                .map(|numbers| numbers.replace(GLUE, " ")),
            shown: work.shown.as_ref().map(Shown::to_string),
            residual: work.residual.as_deref(),
        }
    }
}

impl LeafLine<'_> {
    fn of(leaf: &Leaf) -> LeafLine<'_> {
        LeafLine {
            symbol: leaf.symbol,
            key: leaf.key,
            shown: &leaf.shown,
            meaning: leaf.meaning,
        }
    }
}

impl FindingLine<'_> {
    fn of(finding: &Finding) -> FindingLine<'_> {
        FindingLine {
            range: &finding.range,
            here: &finding.here,
            holds: finding.holds,
        }
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
