//! A trade study as one JSON object.

use std::io::{self, Write};

use serde::{Serialize, Serializer};

use super::{TradeReport, model_off, table};
use crate::case::fields::AUTO;
use crate::model::inputs::Method;
use crate::report::json::write_line;
use crate::study::trade::{Differences, MeasuredSetting, Setting, Subject, Trade};

#[derive(Serialize)]
struct Line<'a> {
    case: &'a str,
    title: &'a str,
    version: &'static str,
    within: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    reference: Option<ReferenceLine>,
    /// Times to build the fields of driver and driven gear; no other time includes them.
    #[serde(skip_serializing_if = "Option::is_none")]
    field_seconds: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    no_reference: Option<String>,
    settings: Vec<SettingLine>,
    #[serde(skip_serializing_if = "Option::is_none")]
    recommended: Option<SettingLine>,
}

/// The compliance of the solve.
#[derive(Serialize)]
struct ModelsLine {
    #[serde(skip_serializing_if = "Option::is_none")]
    tooth_compliance: Option<&'static str>,
    /// Absent if the tooth compliance includes the contact.
    #[serde(skip_serializing_if = "Option::is_none")]
    contact_compliance: Option<&'static str>,
}

impl ModelsLine {
    fn of(setting: &Setting) -> ModelsLine {
        let models = setting.models;
        ModelsLine {
            tooth_compliance: models.map(|models| models.tooth.name),
            contact_compliance: models.and_then(|models| Some(models.contact?.name)),
        }
    }
}

#[derive(Serialize)]
struct ReferenceLine {
    method: &'static str,
    #[serde(flatten)]
    models: ModelsLine,
    #[serde(serialize_with = "count_or_auto")]
    stations: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    tolerance: Option<f64>,
    quantities: serde_json::Map<String, serde_json::Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    disagreement: Option<serde_json::Map<String, serde_json::Value>>,
    #[serde(skip_serializing_if = "Option::is_none")]
    unchecked: Option<String>,
}

#[derive(Serialize)]
#[expect(clippy::struct_excessive_bools, reason = "each is a name that scripts read")]
struct SettingLine {
    method: &'static str,
    /// The method that `auto` chose.
    #[serde(skip_serializing_if = "Option::is_none")]
    took: Option<&'static str>,
    #[serde(flatten)]
    models: ModelsLine,
    #[serde(serialize_with = "count_or_auto")]
    stations: Option<usize>,
    #[serde(skip_serializing_if = "Option::is_none")]
    tolerance: Option<f64>,
    accurate: bool,
    current: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    seconds: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    spread: Option<f64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    runs: Option<u64>,
    #[serde(skip_serializing_if = "Option::is_none")]
    evaluations: Option<u64>,
    errors: serde_json::Map<String, serde_json::Value>,
    #[serde(skip_serializing_if = "Option::is_none")]
    total: Option<f64>,
    pareto: bool,
    qualifies: bool,
    #[serde(skip_serializing_if = "Option::is_none")]
    refusal: Option<String>,
}

/// Serializes a number, or `auto` if the program chooses it.
#[expect(clippy::ref_option, reason = "serde's signature")]
fn count_or_auto<S: Serializer>(count: &Option<usize>, serializer: S) -> Result<S::Ok, S::Error> {
    match count {
        Some(count) => serializer.serialize_u64(*count as u64),
        None => serializer.serialize_str(AUTO),
    }
}

/// Writes one line of JSON: SI units, seconds, relative errors, without absent values.
///
/// # Errors
/// Errors of the writer.
pub fn write_json(report: &TradeReport<'_>, out: &mut dyn Write) -> io::Result<()> {
    let trade = report.trade;
    let line = Line {
        case: report.name,
        title: report.title,
        version: env!("CARGO_PKG_VERSION"),
        within: trade.within,
        reference: reference_line(trade),
        field_seconds: trade.build.ok().map(|build| [build.driver, build.driven]),
        no_reference: trade.reference.as_ref().err().map(ToString::to_string),
        settings: trade.settings.iter().map(|measured| setting_line(trade, measured)).collect(),
        recommended: trade.recommended().map(|measured| setting_line(trade, measured)),
    };
    write_line(&line, out)
}

fn reference_line(trade: &Trade) -> Option<ReferenceLine> {
    let reference = trade.reference.as_ref().ok()?;
    let Setting { method, stations, tolerance, .. } = reference.setting;
    let quantities = Subject::ALL.into_iter().filter_map(|subject| {
        let quantity = subject.quantity(method)?;
        Some((quantity.key.to_owned(), reference.values[subject as usize]?.into()))
    });
    Some(ReferenceLine {
        method: method.name(),
        models: ModelsLine::of(&reference.setting),
        stations,
        tolerance,
        quantities: quantities.collect(),
        disagreement: reference
            .disagreement
            .as_ref()
            .ok()
            .map(|off| by_subject(|subject| off[subject as usize].map(Into::into))),
        unchecked: reference.disagreement.as_ref().err().map(ToString::to_string),
    })
}

fn setting_line(trade: &Trade, measured: &MeasuredSetting) -> SettingLine {
    let Setting { method, stations, tolerance, accurate, models: _ } = measured.setting;
    let figures = measured.found.as_ref().ok();
    SettingLine {
        method: method.name(),
        took: figures
            .map(|figures| figures.taken.method)
            .filter(|&took| took != method)
            .map(Method::name),
        models: ModelsLine::of(&table::taken(measured)),
        stations,
        tolerance,
        accurate,
        current: measured.is_current,
        seconds: figures.map(|figures| figures.time.seconds),
        spread: figures.map(|figures| figures.time.spread),
        runs: figures.map(|figures| figures.time.runs),
        evaluations: figures.and_then(|figures| figures.evaluations),
        errors: figures.map_or_else(serde_json::Map::new, |_| {
            by_subject(|subject| errors(trade, measured, subject))
        }),
        total: measured.total(),
        pareto: measured.is_on_front,
        qualifies: measured.qualifies,
        refusal: measured.found.as_ref().err().map(ToString::to_string),
    }
}

/// The three errors of a subject, if it has any.
fn errors(
    trade: &Trade,
    measured: &MeasuredSetting,
    subject: Subject,
) -> Option<serde_json::Value> {
    let figures = measured.found.as_ref().ok()?;
    let model = model_off(trade, &figures.taken);
    let of = |differences: &Differences| differences[subject as usize];
    let parts = [
        ("numerical", of(&figures.numerical)),
        ("model", of(&model)),
        ("total", of(&figures.total)),
    ];
    let known: serde_json::Map<_, _> = parts
        .into_iter()
        .filter_map(|(name, value)| Some((name.to_owned(), value?.into())))
        .collect();
    (!known.is_empty()).then(|| known.into())
}

fn by_subject(
    value: impl Fn(Subject) -> Option<serde_json::Value>,
) -> serde_json::Map<String, serde_json::Value> {
    Subject::ALL
        .into_iter()
        .filter_map(|subject| Some((subject.key().to_owned(), value(subject)?)))
        .collect()
}
