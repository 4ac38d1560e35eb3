//! A trade study of run time against accuracy as text, JSON and pictures.

mod json;
pub mod plot;
mod table;

pub use json::write_json;
pub use table::{Cell, compliance_name, compliances};

use std::io::{self, Write};

use super::layout::{WIDTH, flow};
use crate::case::sanitize::sanitize;
use crate::numeric::decimal::significant;
use crate::study::trade::{Build, Differences, MeasuredSetting, Setting, Subject, Trade, greatest};

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
    let (numbers, curve) = table::parts(&figures.numerical);
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
