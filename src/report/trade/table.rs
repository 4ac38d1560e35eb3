//! The tables of a trade for a person.

use super::{duration, model_off, percent};
use crate::report::layout::{WIDTH, flow, item};
use crate::study::trade::{Differences, METHODS, Measured, Subject, Trade, greatest};

/// What each method leaves out, a line a subject.
pub(super) fn models(trade: &Trade) -> Vec<String> {
    let title = "Model error: the best setting of each method against the reference, in %";
    let head = row("", METHODS.map(|method| method.name().to_owned()));
    let lines = Subject::ALL.into_iter().filter_map(|subject| {
        let cells = METHODS.map(|method| model_off(trade, method)[subject as usize]);
        cells
            .iter()
            .any(Option::is_some)
            .then(|| row(subject.label(), cells.map(cell)))
    });
    [title.to_owned(), head].into_iter().chain(lines).collect()
}

fn row<const N: usize>(label: &str, cells: [String; N]) -> String {
    format!("    {label:<22}") + &cells.map(|cell| format!("{cell:>10}")).concat()
}

/// Every setting with time and errors; those that refuse the case with the reason.
pub(super) fn settings(trade: &Trade) -> Vec<String> {
    let title = "Settings, with the greatest errors in %. numbers and curve: against the best setting of the same \
        method. model: as above. total: against the reference. *: no other setting is both faster and more accurate. \
        >: the setting of the case.";
    let head = format!(
        "  {:<16}{:>5}{:>7}{:>9}{:>7}{:>9}{:>9}{:>8}{:>8}",
        "method", "stat.", "tol.", "time", "spread", "numbers", "curve", "model", "total"
    );
    let lines = trade
        .settings
        .iter()
        .flat_map(|measured| lines(trade, measured));
    flow(title.split(' '), WIDTH)
        .into_iter()
        .chain([head])
        .chain(lines)
        .collect()
}

fn lines(trade: &Trade, measured: &Measured) -> Vec<String> {
    let setting = &measured.setting;
    let own = if measured.is_current { '>' } else { ' ' };
    let front = if measured.is_on_front { '*' } else { ' ' };
    let tolerance = setting
        .tolerance
        .map_or("-".to_owned(), |tolerance| format!("{tolerance:e}"));
    let before = format!(
        "{own}{front}{:<16}{:>5}{tolerance:>7}",
        name(measured),
        setting.stations_text()
    );
    match &measured.found {
        Err(refusal) => item(&(before + "  "), &refusal.to_string()),
        Ok(figures) => {
            let time = &figures.time;
            let spread = format!("{:.0} %", 100.0 * time.spread / time.seconds);
            let (numbers, curve) = parts(&figures.numerical);
            let model = greatest(&model_off(trade, figures.method));
            let [numbers, curve, model, total] =
                [numbers, curve, model, greatest(&figures.total)].map(cell);
            vec![format!(
                "{before}{:>9}{spread:>7}{numbers:>9}{curve:>9}{model:>8}{total:>8}",
                duration(time.seconds)
            )]
        }
    }
}

/// The method, what it took where it chose, and whether it took care.
fn name(measured: &Measured) -> String {
    let (method, took) = (
        measured.setting.method,
        measured
            .found
            .as_ref()
            .map_or(measured.setting.method, |figures| figures.method),
    );
    let accurate = if measured.setting.accurate {
        ", accurate"
    } else {
        ""
    };
    if method == took {
        format!("{}{accurate}", method.name())
    } else {
        format!("{}: {}{accurate}", method.name(), took.name())
    }
}

/// The greatest difference of the numbers, and that of the curve.
pub(super) fn parts(differences: &Differences) -> (Option<f64>, Option<f64>) {
    let mut numbers = *differences;
    let curve = std::mem::take(&mut numbers[Subject::Curve as usize]);
    (greatest(&numbers), curve)
}

fn cell(difference: Option<f64>) -> String {
    difference.map_or("-".to_owned(), percent)
}
