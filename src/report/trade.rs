//! A trade study of run time against accuracy as text, JSON and pictures.

use std::fmt;
use std::io::{self, Write};

use super::json::{Json, object, sorted, write_line};
use super::layout::{WIDTH, flow, item};
use super::table::Table;
use crate::case::sanitize::sanitize;
use crate::model::impact::StiffnessModels;
use crate::numeric::decimal::significant;
use crate::study::trade::{
    Build, Differences, METHODS, MeasuredSetting, Setting, Subject, Trade, greatest,
};

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
        settings(report.trade),
    ];
    for section in sections {
        writeln!(out, "{}\n", section.join("\n"))?;
    }
    writeln!(out, "{}", item("", &conclusion(report.trade)).join("\n"))
}

fn heading(report: &TradeReport<'_>) -> Vec<String> {
    let title = if report.title.is_empty() { "Case without a title" } else { report.title };
    let name = format!("{} · accuracy against run time on this machine", sanitize(report.name));
    [sanitize(title), name].iter().flat_map(|line| flow(line.split_whitespace(), WIDTH)).collect()
}

fn reference(trade: &Trade) -> Vec<String> {
    let sentence = match &trade.reference {
        Err(refusal) => format!("No reference: method dynamic refuses the case: {refusal}."),
        Ok(reference) => format!("Reference: {}. {}", reference.setting, build(trade)),
    };
    item("", &sentence)
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
    let setting = &measured.setting;
    match (measured.total(), &measured.found) {
        (_, Err(refusal)) => format!("{setting}: {refusal}"),
        (total, Ok(figures)) => {
            let total = total.map_or_else(String::new, |total| format!("{} % in ", percent(total)));
            format!("{setting}, {total}{}", duration(figures.time.seconds))
        }
    }
}

/// The causes of the error of a setting, if it has an error.
#[must_use]
pub fn parts(trade: &Trade, measured: &MeasuredSetting) -> Option<String> {
    let [numbers, curve, model, _] = errors(trade, measured)?;
    let taken = taken(measured);
    let is_reference = trade
        .reference
        .as_ref()
        .is_ok_and(|reference| reference.setting.is_finer_or_coarser(&taken));
    let named = |name: &str, off: Option<f64>| Some(format!("{name} {} %", percent(off?)));
    let model =
        if is_reference { Some("model: the reference".to_owned()) } else { named("model", model) };
    let known = [named("numbers", numbers), named("curve", curve), model];
    let known: Vec<String> = known.into_iter().flatten().collect();
    (!known.is_empty()).then(|| known.join(", "))
}

/// The greatest numerical error of the values, that of the curve, the model error and the total
/// error of a setting that solves the case.
fn errors(trade: &Trade, measured: &MeasuredSetting) -> Option<[Option<f64>; 4]> {
    let figures = measured.found.as_ref().ok()?;
    let mut numbers = figures.numerical;
    let curve = numbers[Subject::Curve as usize].take();
    let model = trade.model(&figures.taken).and_then(|model| greatest(&model.off));
    Some([greatest(&numbers), curve, model, greatest(&figures.total)])
}

/// A relative difference in percent, without the sign.
#[must_use]
pub fn percent(difference: f64) -> String {
    significant(100.0 * difference, if difference < 0.1 { 2 } else { 3 })
}

/// An error limited to the range of a logarithmic axis: smaller errors are rounding.
#[must_use]
pub fn plotted_error(error: f64) -> f64 {
    error.clamp(1e-16, 1e4)
}

/// A power of ten in seconds, as the label of an axis.
#[must_use]
pub fn power_of_time(seconds: f64) -> String {
    let decade = seconds.log10().round() as i32;
    let (unit, zero) = match decade {
        ..=-7 => ("ns", -9),
        -6..=-4 => ("us", -6),
        -3..=-1 => ("ms", -3),
        0.. => ("s", 0),
    };
    format!("{} {unit}", 10f64.powi(decade - zero))
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
    let current = trade.settings.iter().find(|measured| measured.is_current);
    let own = current.and_then(|current| taken(current).models);
    let head = METHODS.iter().map(|method| method.name().to_owned());
    let head = std::iter::once(String::new()).chain(head).collect();
    let rows = compliances(trade).into_iter().map(|(models, cells)| {
        let mark = if own == Some(models) { '>' } else { ' ' };
        let cells = cells.map(|cell| cell.map_or_else(String::new, |cell| cell.to_string()));
        [format!("{mark} {}", compliance_name(models))].into_iter().chain(cells).collect()
    });
    [item("", title), Table::of_texts(head, rows).lines()].concat()
}

/// The models of tooth and contact in at most 22 characters.
#[must_use]
pub fn compliance_name(models: StiffnessModels) -> String {
    let contact = models.contact.map(|contact| format!(" {}", contact.name()));
    models.tooth.name().to_owned() + &contact.unwrap_or_default()
}

/// The setting that the solve used.
fn taken(measured: &MeasuredSetting) -> Setting {
    let figures = measured.found.as_ref();
    figures.map_or(measured.setting, |figures| figures.taken)
}

/// Time and errors of every setting; then the settings that refuse the case with their reasons.
fn settings(trade: &Trade) -> Vec<String> {
    let title = "Settings, with the greatest errors in %. numbers and curve: against the best setting of the same \
        method and compliance. total: difference from the reference. *: no other setting is both faster and more accurate. >: the setting of the case.";
    let head = ["  method", "compliance", "stat.", "tol.", "time", "numbers", "curve", "total"];
    let row = |measured: &MeasuredSetting| {
        let [numbers, curve, _, total] = errors(trade, measured)?;
        let (setting, taken) = (&measured.setting, taken(measured));
        let own = if measured.is_current { '>' } else { ' ' };
        let front = if measured.is_on_front { '*' } else { ' ' };
        let tolerance =
            setting.tolerance.map_or("-".to_owned(), |tolerance| format!("{tolerance:e}"));
        let models = taken.models.map(compliance_name).unwrap_or_default();
        let errors = [numbers, curve, total].map(|error| error.map_or("-".to_owned(), percent));
        let method = format!("{own}{front}{}", setting.method.name());
        let time = duration(measured.seconds());
        Some(
            [vec![method, models, setting.stations_text(), tolerance, time], errors.to_vec()]
                .concat(),
        )
    };
    let head = head.map(str::to_owned).to_vec();
    let table = Table::of_texts(head, trade.settings.iter().filter_map(row));
    let refusal = |measured: &MeasuredSetting| {
        let refusal = measured.found.as_ref().err()?;
        Some(item("  ", &format!("{}: {refusal}", measured.setting)))
    };
    let refusals = trade.settings.iter().filter_map(refusal).flatten().collect();
    [item("", title), table.lines(), refusals].concat()
}

/// Writes one line of JSON: SI units, seconds, relative errors, without absent values.
///
/// # Errors
/// Errors of the writer.
pub fn write_json(report: &TradeReport<'_>, out: &mut dyn Write) -> io::Result<()> {
    let trade = report.trade;
    let reference = trade.reference.as_ref().ok().map(|reference| {
        let setting = &reference.setting;
        let quantity = |subject: Subject| {
            let key = subject.quantity(setting.method)?.key;
            Some((key, reference.values[subject as usize].into()))
        };
        let quantities = sorted(Subject::ALL.into_iter().filter_map(quantity));
        let method = [("method", setting.method.name().into())].into_iter();
        let members = method.chain(fineness(setting, setting.models));
        object(members.chain([("quantities", quantities)]))
    });
    let build = trade.build.ok().map(|build| [build.driver, build.driven]);
    let setting = |measured| setting(trade, measured);
    let line = object([
        ("case", report.name.into()),
        ("title", report.title.into()),
        ("version", env!("CARGO_PKG_VERSION").into()),
        ("within", trade.within.into()),
        ("reference", reference.into()),
        // Driver and driven gear; no other time includes them.
        ("field_seconds", build.map(Json::from_iter).into()),
        ("no_reference", trade.reference.as_ref().err().map(ToString::to_string).into()),
        ("settings", trade.settings.iter().map(setting).collect()),
        ("recommended", trade.recommended().map(setting).into()),
    ]);
    write_line(&line, out)
}

/// Compliance of the solve, and fineness. The compliance of the contact is absent if that of the
/// teeth includes it.
fn fineness(setting: &Setting, models: Option<StiffnessModels>) -> [(&'static str, Json); 4] {
    let contact = models.and_then(|models| models.contact);
    [
        ("tooth_compliance", models.map(|models| models.tooth.name()).into()),
        ("contact_compliance", contact.map(|contact| contact.name()).into()),
        ("stations", setting.stations.map_or_else(|| setting.stations_text().into(), Json::from)),
        ("tolerance", setting.tolerance.into()),
    ]
}

fn setting(trade: &Trade, measured: &MeasuredSetting) -> Json {
    let (setting, taken) = (&measured.setting, taken(measured));
    let figures = measured.found.as_ref().ok();
    let time = figures.map(|figures| figures.time);
    let errors = |subject: Subject| {
        let of = |differences: &Differences| differences[subject as usize];
        let (numerical, total) = (of(&figures?.numerical), of(&figures?.total));
        let model = trade.model(&taken).and_then(|model| of(&model.off));
        numerical.or(model).or(total)?;
        let parts = [("model", model), ("numerical", numerical), ("total", total)];
        Some((subject.key(), object(parts.map(|(name, error)| (name, error.into())))))
    };
    let chosen = (taken.method != setting.method).then(|| taken.method.name());
    let methods = [("method", setting.method.name().into()), ("took", chosen.into())].into_iter();
    object(methods.chain(fineness(setting, taken.models)).chain([
        ("accurate", setting.accurate.into()),
        ("current", measured.is_current.into()),
        ("seconds", time.map(|time| time.seconds).into()),
        ("spread", time.map(|time| time.spread).into()),
        ("runs", time.map(|time| time.runs).into()),
        ("evaluations", figures.and_then(|figures| figures.evaluations).into()),
        ("errors", sorted(Subject::ALL.into_iter().filter_map(errors))),
        ("total", measured.total().into()),
        ("pareto", measured.is_on_front.into()),
        ("qualifies", measured.qualifies.into()),
        ("refusal", measured.found.as_ref().err().map(ToString::to_string).into()),
    ]))
}

#[cfg(test)]
mod tests {
    use super::{duration, percent, plotted_error, power_of_time};

    #[test]
    fn the_axes_of_the_benchmark_have_powers_of_ten_with_their_units() {
        assert_eq!([1e-6, 1e-4, 1e-2, 1.0].map(power_of_time), ["1 us", "100 us", "10 ms", "1 s"]);
        let errors = [0.0, 1e-3, f64::INFINITY].map(plotted_error);
        assert_eq!(errors.map(f64::to_bits), [1e-16, 1e-3, 1e4].map(f64::to_bits));
    }

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
