//! A trade study of run time against accuracy as text, JSON and pictures.

use std::fmt;

use super::table::Table;
use super::table::item;
use super::table::{Json, json, sorted};
use super::table::{Named, Results};
use crate::model::impact::StiffnessModels;
use crate::numeric::decimal::significant;
use crate::study::seek::distinct;
use crate::study::trade::{
    Differences, Finest, METHODS, MeasuredSetting, Setting, Subject, Trade, greatest,
};

impl Results for Trade {
    /// The results in 80 columns.
    fn lines(&self, case: Named) -> Vec<String> {
        let reference = match self.reference() {
            Err(refusal) => {
                let method = if self.is_over_face { "static" } else { "dynamic" };
                format!("No reference: method {method} refuses the case: {refusal}.")
            }
            Ok(Finest { setting, .. }) => {
                // The settings over the face width have the compliance of the reference.
                let is_given = setting.models.is_some_and(|models| models.tooth.reads_table());
                let has_build = !self.is_over_face || !is_given;
                let build = if has_build { build(self) } else { String::new() };
                format!("Reference: {setting}. {build}")
            }
        };
        let mut lines = case.headings("accuracy against run time on this machine");
        let tables = if self.is_over_face { by_slices(self) } else { by_compliance(self) };
        let refusals = refusals(self);
        let sections = [item("", &reference), tables, refusals, item("", &conclusion(self))];
        for section in sections.into_iter().filter(|section| !section.is_empty()) {
            lines.push(String::new());
            lines.extend(section);
        }
        lines
    }

    /// SI units, seconds, relative errors, without absent values.
    fn json(&self) -> Json {
        let reference = self.reference().ok().map(|Finest { setting, values, .. }| {
            let quantity = |subject: Subject| {
                let key = subject.quantity(setting.method)?.key;
                Some((key, json!(values[subject as usize])))
            };
            json!({
                "method": setting.method.name(),
                "tooth_compliance": setting.models.map(|models| models.tooth.name()),
                "contact_compliance": contact(setting),
                "stations": stations(setting),
                "tolerance": setting.tolerance,
                "slices": slices(self, setting),
                "quantities": sorted(Subject::ALL.into_iter().filter_map(quantity)),
            })
        });
        let setting = |measured| setting(self, measured);
        json!({
            "within": self.within,
            "reference": reference,
            // Driver and driven gear; no other time includes them.
            "field_seconds": self.build.ok(),
            "no_reference": self.reference().err().map(|refusal| refusal.to_string()),
            "settings": self.settings.iter().map(setting).collect::<Json>(),
            "recommended": self.recommended().map(setting),
        })
    }
}

/// The time to build the fields, as a sentence.
pub fn build(trade: &Trade) -> String {
    match &trade.build {
        Ok([driver, driven]) => format!(
            "The finite elements are solved once per gear: {} for the driver, {} for the driven gear. \
             The times of the settings do not include this.",
            duration(*driver),
            duration(*driven)
        ),
        Err(refusal) => format!("There are no finite elements to compare with: {refusal}."),
    }
}

/// The conclusion if the reference finds no corner contact.
pub const NO_CONTACT: &str = "There is no corner contact: no setting is recommended";

/// The recommendation as a sentence.
pub fn conclusion(trade: &Trade) -> String {
    let within = percent(trade.within);
    match trade.recommended() {
        _ if trade.is_without_contact() => format!("{NO_CONTACT}."),
        Some(measured) => {
            let total = measured.total();
            let is_greatest = |subject: &Subject| {
                measured.found.as_ref().is_ok_and(|found| found.total[*subject as usize] == total)
            };
            let greatest = Subject::ALL.into_iter().find(is_greatest);
            let greatest = greatest.map_or_else(String::new, |subject| {
                format!("; its greatest error is that of the {}", subject.key().replace('_', " "))
            });
            format!("Within {within} %: {}{greatest}", summary(measured))
        }
        None => format!("Within {within} %: none"),
    }
}

/// A setting with its error and time.
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
pub fn parts(trade: &Trade, measured: &MeasuredSetting) -> Option<String> {
    let figures = measured.found.as_ref().ok()?;
    let mut numbers = figures.numerical;
    let curve = numbers[Subject::Curve as usize].take();
    let named = |name: &str, off: Option<f64>| Some(format!("{name} {} %", percent(off?)));
    let is_reference = trade
        .reference()
        .is_ok_and(|reference| reference.setting.is_finer_or_coarser(&figures.taken));
    let model = if is_reference {
        Some("model: the reference".to_owned())
    } else {
        named("model", trade.model(&figures.taken).and_then(|model| greatest(&model.off)))
    };
    let known = [named("numbers", greatest(&numbers)), named("curve", curve), model];
    let known: Vec<String> = known.into_iter().flatten().collect();
    (!known.is_empty()).then(|| known.join(", "))
}

/// A relative difference in percent, without the sign.
pub fn percent(difference: f64) -> String {
    significant(100.0 * difference, if difference < 0.1 { 2 } else { 3 })
}

/// An error limited to the range of a logarithmic axis: smaller errors are rounding.
pub fn plotted_error(error: f64) -> f64 {
    error.clamp(1e-16, 1e4)
}

/// A power of ten in seconds, as the label of an axis.
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
        with 64 stations. >: the compliance of the case.";
    let current = trade.settings.iter().find(|measured| measured.is_current);
    let own = current.and_then(|current| taken(current).models);
    [item("", title), compliance_table(trade, own, '>', Cell::to_string).lines()].concat()
}

/// The table of compliances and methods, with a mark before the compliance of the case.
pub fn compliance_table(
    trade: &Trade,
    own: Option<StiffnessModels>,
    mark: char,
    text: impl Fn(&Cell) -> String,
) -> Table {
    let head = METHODS.iter().map(|method| method.name().to_owned());
    let head = std::iter::once(String::new()).chain(head).collect();
    let rows = compliances(trade).into_iter().map(|(models, cells)| {
        let mark = if own == Some(models) { mark } else { ' ' };
        let cells = cells.map(|cell| cell.as_ref().map_or_else(String::new, &text));
        [format!("{mark} {}", compliance_name(models))].into_iter().chain(cells).collect()
    });
    Table::of_texts(head, rows)
}

/// Time and differences of each number of slices and coupling.
fn by_slices(trade: &Trade) -> Vec<String> {
    const SUBJECTS: [(Subject, &str); 6] = [
        (Subject::FirstContact, "contact"),
        (Subject::PeakForce, "peak"),
        (Subject::PeakApproachForce, "before E"),
        (Subject::Curve, "curve"),
        (Subject::LineLoad, "line load"),
        (Subject::TransmissionError, "TE"),
    ];
    let title = "Time of a solve and difference from the reference in %, by number of slices and \
        by what is coupled. >: the setting of the case.";
    let head = ["  slices", "coupled", "time"].into_iter().chain(SUBJECTS.map(|(_, name)| name));
    let rows = shown(trade).map(|measured| {
        let mark = if measured.is_current { '>' } else { ' ' };
        let slices = format!("{mark} {}", measured.setting.slices_text());
        let Setting { slice_coupling, tooth_coupling, .. } = measured.setting;
        let coupled = match (slice_coupling, tooth_coupling) {
            (true, true) => "slices, teeth",
            (false, true) => "teeth",
            (true, false) => "slices",
            (false, false) => "nothing",
        };
        let figures = measured.found.as_ref();
        let time = figures.map_or("refused".to_owned(), |it| duration(it.time.seconds));
        let errors = SUBJECTS.map(|(subject, _)| {
            let total = figures.ok().and_then(|figures| figures.total[subject as usize]);
            total.map_or("-".to_owned(), percent)
        });
        [slices, coupled.to_owned(), time].into_iter().chain(errors).collect()
    });
    let table = Table::of_texts(head.map(str::to_owned).collect(), rows);
    [item("", title), table.lines()].concat()
}

/// The settings of the tables: over the face width, those with the compliance of the reference.
fn shown(trade: &Trade) -> impl Iterator<Item = &MeasuredSetting> {
    let usual = trade.reference().ok().and_then(|reference| reference.setting.models);
    let is_shown = move |one: &&MeasuredSetting| !trade.is_over_face || one.setting.models == usual;
    trade.settings.iter().filter(is_shown)
}

/// The reasons of the refusals in the tables.
fn refusals(trade: &Trade) -> Vec<String> {
    let reason = |measured: &MeasuredSetting| Some(measured.found.as_ref().err()?.to_string());
    let reasons = distinct(shown(trade).filter_map(reason));
    reasons.iter().flat_map(|reason| item("", &format!("Refused: {reason}."))).collect()
}

/// The models of tooth and contact in at most 22 characters.
fn compliance_name(models: StiffnessModels) -> String {
    let contact = models.contact.map(|contact| format!(" {}", contact.name()));
    models.tooth.name().to_owned() + &contact.unwrap_or_default()
}

/// The setting that the solve used.
fn taken(measured: &MeasuredSetting) -> Setting {
    measured.found.as_ref().map_or(measured.setting, |figures| figures.taken)
}

/// The compliance of the contact, if that of the teeth does not include it.
fn contact(setting: &Setting) -> Option<&'static str> {
    Some(setting.models?.contact?.name())
}

fn stations(setting: &Setting) -> Json {
    setting.stations.map_or_else(|| json!(setting.stations_text()), |stations| json!(stations))
}

/// The number of slices, if the load varies over the face width.
fn slices(trade: &Trade, setting: &Setting) -> Option<Json> {
    let count = setting.slices.map_or_else(|| json!(setting.slices_text()), |count| json!(count));
    trade.is_over_face.then_some(count)
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
        Some((subject.key(), json!({"model": model, "numerical": numerical, "total": total})))
    };
    json!({
        "method": setting.method.name(),
        // The method that `auto` chose.
        "took": (taken.method != setting.method).then(|| taken.method.name()),
        "tooth_compliance": taken.models.map(|models| models.tooth.name()),
        "contact_compliance": contact(&taken),
        "stations": stations(setting),
        "tolerance": setting.tolerance,
        "accurate": setting.accurate,
        "slices": slices(trade, setting),
        "slice_coupling": trade.is_over_face.then_some(setting.slice_coupling),
        "tooth_coupling": trade.is_over_face.then_some(setting.tooth_coupling),
        "current": measured.is_current,
        "seconds": time.map(|time| time.seconds),
        "spread": time.map(|time| time.spread),
        "runs": time.map(|time| time.runs),
        "evaluations": figures.and_then(|figures| figures.evaluations),
        "errors": sorted(Subject::ALL.into_iter().filter_map(errors)),
        "total": measured.total(),
        "pareto": trade.is_on_front(measured),
        "qualifies": trade.qualifies(measured),
        "refusal": measured.found.as_ref().err().map(ToString::to_string),
    })
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
