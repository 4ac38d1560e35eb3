//! The tables of a trade for a person.

use super::{duration, model_off, percent};
use crate::model::inputs::Rung;
use crate::report::layout::item;
use crate::study::trade::{Measured, Subject, Trade, greatest};

/// What each rung leaves out, a line a subject.
pub(super) fn models(trade: &Trade) -> Vec<String> {
    let title = "What a rung leaves out: its best setting against the reference, in %";
    let head = row("", Rung::ALL.map(|rung| rung.name().to_owned()));
    let lines = Subject::ALL.into_iter().filter_map(|subject| {
        let cells = Rung::ALL.map(|rung| model_off(trade, rung)[subject as usize]);
        cells.iter().any(Option::is_some).then(|| row(subject.label(), cells.map(cell)))
    });
    [title.to_owned(), head].into_iter().chain(lines).collect()
}

fn row<const N: usize>(label: &str, cells: [String; N]) -> String {
    format!("    {label:<22}") + &cells.map(|cell| format!("{cell:>10}")).concat()
}

/// Every setting with time and errors; those that refuse the case with the reason.
pub(super) fn settings(trade: &Trade) -> Vec<String> {
    let title = [
        "Settings, errors in %: numerical against the rung's best setting, model as above,",
        "total against the reference, each the greatest over the quantities.",
        "* as near and as quick as no other   > the case's own",
    ];
    let head = format!(
        "  {:<9}{:>7}{:>8}{:>10}{:>9}{:>8}{:>9}{:>9}{:>9}",
        "rung", "stat.", "tol.", "accurate", "time", "spread", "num.", "model", "total"
    );
    let lines = trade.settings.iter().flat_map(|measured| lines(trade, measured));
    title.map(str::to_owned).into_iter().chain([head]).chain(lines).collect()
}

fn lines(trade: &Trade, measured: &Measured) -> Vec<String> {
    let setting = &measured.setting;
    let own = if measured.is_current { '>' } else { ' ' };
    let front = if measured.is_on_front { '*' } else { ' ' };
    let tolerance = setting.tolerance.map_or("-".to_owned(), |tolerance| format!("{tolerance:e}"));
    let accurate = if setting.accurate { "yes" } else { "no" };
    let before = format!("{own}{front}{:<9}{:>7}{tolerance:>8}{accurate:>10}", setting.rung.name(), setting.stations);
    match &measured.found {
        Err(refusal) => item(&(before + "  "), &refusal.to_string()),
        Ok(figures) => {
            let time = &figures.time;
            let spread = format!("{:.0} %", 100.0 * time.spread / time.seconds);
            let model = model_off(trade, setting.rung);
            let errors = [&figures.numerical, &model, &figures.total].map(|differences| cell(greatest(differences)));
            let errors = errors.map(|error| format!("{error:>9}")).concat();
            vec![format!("{before}{:>9}{spread:>8}{errors}", duration(time.seconds))]
        }
    }
}

fn cell(difference: Option<f64>) -> String {
    difference.map_or("-".to_owned(), percent)
}
