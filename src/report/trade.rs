//! A trade study of run time against accuracy as text, JSON and pictures.

pub mod plot;

use std::fmt;
use std::io::{self, Write};

use super::layout::{WIDTH, flow};
use crate::case::fields::AUTO;
use crate::case::sanitize::sanitize;
use crate::model::impact::StiffnessModels;
use crate::model::inputs::Method;
use crate::numeric::decimal::significant;
use crate::report::data::write_line;
use crate::report::layout::item;
use crate::study::trade::{
    Build, Differences, METHODS, MeasuredSetting, Model, Setting, Subject, Trade, greatest,
};
use serde::{Serialize, Serializer};

/// A trade study and its case.
#[derive(Debug, Clone, Copy)]
pub struct TradeReport<'a> {
    /// The name of the case, as the user gave it.
    pub name: &'a str,
    /// The title of the case, empty without one.
    pub title: &'a str,
    /// The measurement.
    pub trade: &'a Trade,
}

/// Writes the study as text, 80 columns wide.
///
/// # Errors
/// Errors of the writer.
pub fn write(report: &TradeReport<'_>, out: &mut dyn Write) -> io::Result<()> {
    let sections = [
        heading(report),
        reference(report.trade),
        by_compliance(report.trade),
        models(report.trade),
        settings(report.trade),
    ];
    for section in sections {
        writeln!(out, "{}\n", section.join("\n"))?;
    }
    flow(conclusion(report.trade).split(' '), WIDTH)
        .iter()
        .try_for_each(|line| writeln!(out, "{line}"))
}

fn heading(report: &TradeReport<'_>) -> Vec<String> {
    let title = if report.title.is_empty() { "Case without a title" } else { report.title };
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
            format!("Reference: {}; {check}. {}", reference.setting, build(trade))
        }
    };
    flow(sentence.split(' '), WIDTH)
}

/// The time to build the fields, as a sentence.
#[must_use]
pub fn build(trade: &Trade) -> String {
    match &trade.build {
        Ok(Build { driver, driven }) => format!(
            "The fields of the finite elements are built once per gear: {} for the driver, {} for the driven gear. \
             The times of the settings do not include this.",
            duration(*driver),
            duration(*driven)
        ),
        Err(refusal) => format!("There is no elastic field to compare with: {refusal}."),
    }
}

/// The conclusion if no method finds corner contact.
pub const NO_CONTACT: &str = "No method finds corner contact: no setting is recommended";

/// The recommendation as a sentence.
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
pub fn summary(measured: &MeasuredSetting) -> String {
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

/// The causes of the error of a setting, if it has an error.
#[must_use]
pub fn parts(trade: &Trade, measured: &MeasuredSetting) -> Option<String> {
    let figures = measured.found.as_ref().ok()?;
    let (numbers, curve) = both_parts(&figures.numerical);
    let model = greatest(&model_off(trade, &figures.taken));
    let is_reference = trade
        .reference
        .as_ref()
        .is_ok_and(|reference| reference.setting.is_finer_or_coarser(&figures.taken));
    let named = |name: &str, off: Option<f64>| Some(format!("{name} {} %", percent(off?)));
    let model =
        if is_reference { Some("model: the reference".to_owned()) } else { named("model", model) };
    let known = [named("numbers", numbers), named("curve", curve), model];
    let known: Vec<String> = known.into_iter().flatten().collect();
    (!known.is_empty()).then(|| known.join(", "))
}

/// A relative difference in percent, without the sign.
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

/// The model error of a setting.
fn model_off(trade: &Trade, setting: &Setting) -> Differences {
    trade.model(setting).map_or([None; Subject::ALL.len()], |model| model.off)
}

/// A method with a compliance, at the default fineness.
#[derive(Debug, Clone)]
pub struct Cell {
    /// Time of a solve, or the word for a refusal.
    pub time: String,
    /// Greatest difference from the reference, in %.
    pub total: String,
    /// The measured setting.
    pub setting: Setting,
}

impl fmt::Display for Cell {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        // A column has room for five characters.
        let is_long = self.total.len() > 5 && self.total.starts_with("0.0");
        let total = if is_long { "<0.01" } else { &self.total };
        write!(f, "{} {total:>5}", self.time)
    }
}

/// The compliances, first that of the reference, each with its cell for each of [`METHODS`].
#[must_use]
pub fn compliances(trade: &Trade) -> Vec<(StiffnessModels, [Option<Cell>; METHODS.len()])> {
    let cell = |measured: &MeasuredSetting| {
        let figures = measured.found.as_ref();
        Cell {
            time: figures.map_or("refused".to_owned(), |figures| duration(figures.time.seconds)),
            total: measured.total().map_or("-".to_owned(), percent),
            setting: measured.setting,
        }
    };
    let rows = trade.compliances().into_iter();
    rows.map(|models| {
        let cells = METHODS.map(|method| trade.usual(method, models).map(cell));
        (models, cells)
    })
    .collect()
}

/// Time and difference of each method with each compliance, one line per compliance.
fn by_compliance(trade: &Trade) -> Vec<String> {
    let title = "Time of a solve and greatest difference from the reference in %, by compliance and method, \
        with 64 stations and tolerance 1e-6. >: the compliance of the case.";
    let own = |models: StiffnessModels| {
        let is_own = |measured: &&MeasuredSetting| measured.is_current;
        let current = trade.settings.iter().find(is_own);
        current.is_some_and(|current| taken(current).models == Some(models))
    };
    let line = |(models, cells): (StiffnessModels, [Option<Cell>; METHODS.len()])| {
        let mark = if own(models) { '>' } else { ' ' };
        let cells = cells.map(|cell| cell.map_or_else(String::new, |cell| cell.to_string()));
        format!("{mark} {:<22}", compliance_name(models)) + &wide(cells, 14)
    };
    let methods = METHODS.map(|method| method.name().to_owned());
    let head = format!("  {:<22}", "") + &wide(methods, 14);
    let rows = compliances(trade).into_iter().map(line);
    let title = flow(title.split(' '), WIDTH);
    title.into_iter().chain([head]).chain(rows).collect()
}

/// The models of tooth and contact in at most 22 characters.
#[must_use]
pub fn compliance_name(models: StiffnessModels) -> String {
    let contact = models.contact.map(|contact| format!(" {}", contact.name));
    models.tooth.name.to_owned() + &contact.unwrap_or_default()
}

/// The setting that the solve used.
fn taken(measured: &MeasuredSetting) -> Setting {
    let figures = measured.found.as_ref();
    figures.map_or(measured.setting, |figures| figures.taken)
}

/// The model error of each method, one line per subject.
fn models(trade: &Trade) -> Vec<String> {
    let title = "Model error: the best setting of each method, with the compliance of a case that names \
        none, against the reference, in %";
    let head = row("", METHODS.map(|method| method.name().to_owned()));
    let of = |method: Method| -> Option<&Model> {
        let mut models = trade.models.iter();
        models.find(|model| model.setting.method == method)
    };
    let lines = Subject::ALL.into_iter().filter_map(|subject| {
        let cells = METHODS.map(|method| of(method)?.off[subject as usize]);
        cells.iter().any(Option::is_some).then(|| row(subject.label(), cells.map(cell)))
    });
    let title = flow(title.split(' '), WIDTH);
    title.into_iter().chain([head]).chain(lines).collect()
}

fn wide<const N: usize>(cells: [String; N], width: usize) -> String {
    cells.map(|cell| format!("{cell:>width$}")).concat()
}

fn row<const N: usize>(label: &str, cells: [String; N]) -> String {
    format!("    {label:<22}") + &wide(cells, 10)
}

/// Every setting with time and errors; a setting that refuses the case with its reason.
fn settings(trade: &Trade) -> Vec<String> {
    let title = "Settings, with the greatest errors in %. numbers and curve: against the best setting of the same \
        method and compliance. model: as above. total: difference from the reference. *: no other setting is both faster and \
        more accurate. >: the setting of the case.";
    let head = format!(
        "  {:<16}{:>5}{:>7}{:>9}{:>7}{:>9}{:>9}{:>8}{:>8}",
        "method", "stat.", "tol.", "time", "spread", "numbers", "curve", "model", "total"
    );
    let lines = by_models(trade).into_iter().flat_map(|(models, settings)| {
        let names = models.map_or("chosen by auto".to_owned(), |models| models.names());
        let settings = settings.into_iter().flat_map(|measured| lines(trade, measured));
        [format!("  {names}")].into_iter().chain(settings).collect::<Vec<_>>()
    });
    flow(title.split(' '), WIDTH).into_iter().chain([head]).chain(lines).collect()
}

/// The settings of each compliance.
fn by_models(trade: &Trade) -> Vec<(Option<StiffnessModels>, Vec<&MeasuredSetting>)> {
    let mut found: Vec<(Option<StiffnessModels>, Vec<&MeasuredSetting>)> = Vec::new();
    for measured in &trade.settings {
        let models = measured.setting.models;
        match found.iter_mut().find(|(own, _)| *own == models) {
            Some((_, settings)) => settings.push(measured),
            None => found.push((models, vec![measured])),
        }
    }
    found
}

fn lines(trade: &Trade, measured: &MeasuredSetting) -> Vec<String> {
    let setting = &measured.setting;
    let own = if measured.is_current { '>' } else { ' ' };
    let front = if measured.is_on_front { '*' } else { ' ' };
    let tolerance = setting.tolerance.map_or("-".to_owned(), |tolerance| format!("{tolerance:e}"));
    let before =
        format!("{own}{front}{:<16}{:>5}{tolerance:>7}", name(measured), setting.stations_text());
    match &measured.found {
        Err(refusal) => item(&(before + "  "), &refusal.to_string()),
        Ok(figures) => {
            let time = &figures.time;
            let spread = format!("{:.0} %", 100.0 * time.spread / time.seconds);
            let (numbers, curve) = both_parts(&figures.numerical);
            let model = greatest(&model_off(trade, &figures.taken));
            let [numbers, curve, model, total] =
                [numbers, curve, model, greatest(&figures.total)].map(cell);
            vec![format!(
                "{before}{:>9}{spread:>7}{numbers:>9}{curve:>9}{model:>8}{total:>8}",
                duration(time.seconds)
            )]
        }
    }
}

/// The method, the method that `auto` chose, and whether the arithmetic is accurate.
fn name(measured: &MeasuredSetting) -> String {
    let (method, took) = (measured.setting.method, taken(measured).method);
    let accurate = if measured.setting.accurate { ", accurate" } else { "" };
    if method == took {
        format!("{}{accurate}", method.name())
    } else {
        format!("{}: {}{accurate}", method.name(), took.name())
    }
}

/// The greatest numerical difference of the values, and that of the curve.
fn both_parts(differences: &Differences) -> (Option<f64>, Option<f64>) {
    let mut numbers = *differences;
    let curve = std::mem::take(&mut numbers[Subject::Curve as usize]);
    (greatest(&numbers), curve)
}

fn cell(difference: Option<f64>) -> String {
    difference.map_or("-".to_owned(), percent)
}

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
        models: ModelsLine::of(&taken(measured)),
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
