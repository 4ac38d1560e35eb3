//! A trade of speed against accuracy as a person or a script reads it.

pub mod plot;
mod table;

pub use table::{Cell, compliance_name, compliances};

use std::io::{self, Write};

use serde::{Serialize, Serializer};

use super::json::write_line;
use super::layout::{WIDTH, flow};
use crate::case::fields::AUTO;
use crate::case::sanitize::sanitize;
use crate::model::inputs::Method;
use crate::numeric::decimal::significant;
use crate::study::trade::{Build, Differences, Measured, Setting, Subject, Trade, greatest};

/// A trade and the case it was made of.
#[derive(Debug, Clone, Copy)]
pub struct TradeReport<'a> {
    /// The case's name, as the user gave it.
    pub name: &'a str,
    /// The case's title, empty without one.
    pub title: &'a str,
    /// What was measured.
    pub trade: &'a Trade,
}

/// Write it for a person, 80 columns wide.
///
/// # Errors
/// What the writer refuses.
pub fn write(report: &TradeReport<'_>, out: &mut dyn Write) -> io::Result<()> {
    let sections = [
        heading(report),
        reference(report.trade),
        table::by_compliance(report.trade),
        table::models(report.trade),
        table::settings(report.trade),
    ];
    for section in sections {
        writeln!(out, "{}\n", section.join("\n"))?;
    }
    flow(conclusion(report.trade).split(' '), WIDTH)
        .iter()
        .try_for_each(|line| writeln!(out, "{line}"))
}

fn heading(report: &TradeReport<'_>) -> Vec<String> {
    let title = if report.title.is_empty() {
        "Case without a title"
    } else {
        report.title
    };
    let mut lines = flow(sanitize(title).split_whitespace(), WIDTH);
    lines.extend(flow(
        [
            sanitize(report.name).as_str(),
            "·",
            "accuracy against run time, measured on this machine",
        ],
        WIDTH,
    ));
    lines
}

fn reference(trade: &Trade) -> Vec<String> {
    let sentence = match &trade.reference {
        Err(refusal) => format!("No reference: method dynamic refuses the case: {refusal}."),
        Ok(reference) => {
            let check = match &reference.disagreement {
                Ok(off) => format!(
                    "a second integration method differs by at most {:.0e}",
                    greatest(off).unwrap_or(0.0)
                ),
                Err(refusal) => {
                    format!("a second integration method could not check it: {refusal}")
                }
            };
            format!(
                "Reference: {}; {check}. {}",
                reference.setting,
                build(trade)
            )
        }
    };
    flow(sentence.split(' '), WIDTH)
}

/// The time of the fields, in a sentence.
#[must_use]
pub fn build(trade: &Trade) -> String {
    match &trade.build {
        Ok(Build { driver, driven }) => format!(
            "The fields of the finite elements are built once per gear: {} for the driver, {} for the driven gear; \
             the times below read them.",
            duration(*driver),
            duration(*driven)
        ),
        Err(refusal) => format!("There is no elastic field to compare with: {refusal}."),
    }
}

/// The conclusion where no method finds corner contact.
pub const NO_CONTACT: &str = "No method finds corner contact: no setting is recommended";

/// The recommendation in a sentence.
#[must_use]
pub fn conclusion(trade: &Trade) -> String {
    let within = percent(trade.within);
    match trade.recommended() {
        _ if trade.is_without_contact() => format!("{NO_CONTACT}."),
        Some(measured) => format!("Within {within} %: {}", summary(measured)),
        None => format!("Within {within} %: none"),
    }
}

/// A setting with its error and time.
#[must_use]
pub fn summary(measured: &Measured) -> String {
    match (measured.total(), &measured.found) {
        (_, Err(refusal)) => format!("{}: {refusal}", measured.setting),
        (None, Ok(figures)) => format!("{}, {}", measured.setting, duration(figures.time.seconds)),
        (Some(total), Ok(figures)) => {
            format!(
                "{}, {} % in {}",
                measured.setting,
                percent(total),
                duration(figures.time.seconds)
            )
        }
    }
}

/// Where the error of a setting comes from, where it has one.
#[must_use]
pub fn parts(trade: &Trade, measured: &Measured) -> Option<String> {
    let figures = measured.found.as_ref().ok()?;
    let (numbers, curve) = table::parts(&figures.numerical);
    let model = greatest(&model_off(trade, &figures.taken));
    let [numbers, curve, model] =
        [numbers, curve, model].map(|off| off.map_or_else(|| "-".to_owned(), percent));
    let is_reference = trade
        .reference
        .as_ref()
        .is_ok_and(|reference| reference.setting.is_finer_or_coarser(&figures.taken));
    let model = if is_reference {
        "model: the reference".to_owned()
    } else {
        format!("model {model} %")
    };
    Some(format!("numbers {numbers} %, curve {curve} %, {model}"))
}

/// A relative difference in per cent, without the sign.
#[must_use]
pub fn percent(difference: f64) -> String {
    significant(100.0 * difference, if difference < 0.1 { 2 } else { 3 })
}

/// A time with its unit.
#[must_use]
pub fn duration(seconds: f64) -> String {
    let (factor, unit) = match seconds {
        _ if seconds < 1e-3 => (1e6, "us"),
        _ if seconds < 1.0 => (1e3, "ms"),
        _ => (1.0, "s"),
    };
    format!("{} {unit}", significant(factor * seconds, 3))
}

#[derive(Serialize)]
struct Line<'a> {
    case: &'a str,
    title: &'a str,
    version: &'static str,
    within: f64,
    #[serde(skip_serializing_if = "Option::is_none")]
    reference: Option<ReferenceLine>,
    /// Times of the fields of driver and driven gear, apart from every other time.
    #[serde(skip_serializing_if = "Option::is_none")]
    field_seconds: Option<[f64; 2]>,
    #[serde(skip_serializing_if = "Option::is_none")]
    no_reference: Option<String>,
    settings: Vec<SettingLine>,
    #[serde(skip_serializing_if = "Option::is_none")]
    recommended: Option<SettingLine>,
}

/// The compliance that was taken.
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
#[expect(
    clippy::struct_excessive_bools,
    reason = "each is a name that scripts read"
)]
struct SettingLine {
    method: &'static str,
    /// What the method `auto` took.
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

/// A number, or the word for as many as it takes.
#[expect(clippy::ref_option, reason = "serde's signature")]
fn count_or_auto<S: Serializer>(count: &Option<usize>, serializer: S) -> Result<S::Ok, S::Error> {
    match count {
        Some(count) => serializer.serialize_u64(*count as u64),
        None => serializer.serialize_str(AUTO),
    }
}

/// Write it as one line of JSON: SI units, seconds, errors relative; what does not exist is absent.
///
/// # Errors
/// What the writer refuses.
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
        settings: trade
            .settings
            .iter()
            .map(|measured| setting_line(trade, measured))
            .collect(),
        recommended: trade
            .recommended()
            .map(|measured| setting_line(trade, measured)),
    };
    write_line(&line, out)
}

fn reference_line(trade: &Trade) -> Option<ReferenceLine> {
    let reference = trade.reference.as_ref().ok()?;
    let Setting {
        method,
        stations,
        tolerance,
        ..
    } = reference.setting;
    let quantities = Subject::ALL.into_iter().filter_map(|subject| {
        let quantity = subject.quantity(method)?;
        Some((
            quantity.key.to_owned(),
            reference.values[subject as usize]?.into(),
        ))
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
        unchecked: reference
            .disagreement
            .as_ref()
            .err()
            .map(ToString::to_string),
    })
}

fn setting_line(trade: &Trade, measured: &Measured) -> SettingLine {
    let Setting {
        method,
        stations,
        tolerance,
        accurate,
        models: _,
    } = measured.setting;
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

/// The three errors of a subject, where there are any.
fn errors(trade: &Trade, measured: &Measured, subject: Subject) -> Option<serde_json::Value> {
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

/// What the physics of a setting leaves out.
fn model_off(trade: &Trade, setting: &Setting) -> Differences {
    trade
        .model(setting)
        .map_or([None; Subject::ALL.len()], |model| model.off)
}

#[cfg(test)]
mod tests {
    use super::{duration, percent};

    #[test]
    fn times_and_errors_have_three_digits_at_most() {
        assert_eq!(
            [duration(1.234e-6), duration(0.0123), duration(61.0)],
            ["1.23 us", "12.3 ms", "61.0 s"]
        );
        assert_eq!(
            [percent(0.05), percent(0.55), percent(1.2e-9), percent(0.0)],
            ["5.0", "55.0", "1.2e-7", "0"]
        );
    }
}
