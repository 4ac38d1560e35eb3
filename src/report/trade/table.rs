//! The tables of a trade study.

use std::fmt;

use super::{duration, model_off, percent};
use crate::model::impact::StiffnessModels;
use crate::model::inputs::Method;
use crate::report::layout::{WIDTH, flow, item};
use crate::study::trade::{
    Differences, METHODS, MeasuredSetting, Model, Setting, Subject, Trade, greatest,
};

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
pub(super) fn by_compliance(trade: &Trade) -> Vec<String> {
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
pub(super) fn taken(measured: &MeasuredSetting) -> Setting {
    let figures = measured.found.as_ref();
    figures.map_or(measured.setting, |figures| figures.taken)
}

/// The model error of each method, one line per subject.
pub(super) fn models(trade: &Trade) -> Vec<String> {
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
pub(super) fn settings(trade: &Trade) -> Vec<String> {
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
            let (numbers, curve) = parts(&figures.numerical);
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
pub(super) fn parts(differences: &Differences) -> (Option<f64>, Option<f64>) {
    let mut numbers = *differences;
    let curve = std::mem::take(&mut numbers[Subject::Curve as usize]);
    (greatest(&numbers), curve)
}

fn cell(difference: Option<f64>) -> String {
    difference.map_or("-".to_owned(), percent)
}
