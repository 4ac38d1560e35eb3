//! The table of quantities: one line each, with the methods side by side, marks of changes and
//! limits, and the difference from the baseline.

mod columns;
mod difference;
mod variants;

use ratatui::style::Style;
use ratatui::text::Line;
use unicode_width::UnicodeWidthStr;

pub(super) use difference::compared;
pub(super) use variants::page as variants_page;

use super::words::shown_in;
use crate::model::inputs::Method;
use crate::model::{Outcome, QUANTITIES, Quantity, Solution, Stages};
use crate::report;
use crate::report::groups::{self, FREE_IMPACT};
use crate::report::verdict::{Standing, verdict};
use crate::tui::ascii::symbol;
use crate::tui::panes::results::pane::Results;
use crate::tui::solver::Answer;
use crate::tui::text;
use columns::Columns;

/// The first rows, which show the most important quantities of a closed form.
const FIRST: &[&str] = &[
    "impact_force",
    "impact_duration",
    "approach_angle_driver",
    "friction_ratio",
    "normal_velocity",
    "total_deviation",
];
/// The first rows of `static`, which shares the load among all pairs.
const FIRST_OF_STATIC: &[&str] = &[
    "static_force_at_start",
    "static_peak_force",
    "static_first_contact_angle_driver",
    "static_transmission_error",
    "mesh_force",
    "total_deviation",
];
/// The first rows of `dynamic`.
const FIRST_OF_DYNAMIC: &[&str] = &[
    "dynamic_peak_approach_force",
    "dynamic_peak_force",
    "dynamic_impact_duration",
    "dynamic_first_contact_angle_driver",
    "dynamic_contact_lost",
    "total_deviation",
];
/// The first rows without corner contact.
const FIRST_WITHOUT_CONTACT: &[&str] = &[
    "total_deviation",
    "dynamic_peak_force",
    "dynamic_contact_lost",
    "static_peak_force",
    "equivalent_error",
    "combined_deflection",
    "mesh_force",
    "contact_ratio",
];

/// Mark after a value that the last edit changed.
const CHANGED: &str = "←";

pub(super) struct Table {
    pub(super) heading: Line<'static>,
    /// A line for every quantity, and a heading above the quantities of the free impact.
    pub(super) rows: Vec<Line<'static>>,
}

/// The quantities that at least one method has: the most important first, then those of the active
/// method.
pub(super) fn order(answer: &Answer) -> impl Iterator<Item = &'static Quantity> {
    let strikes = |solution: &Solution| solution.outcome == Outcome::CornerContact;
    let strikes = answer.of(answer.active).is_none_or(strikes);
    let first = match answer.active {
        _ if !strikes => FIRST_WITHOUT_CONTACT,
        Method::Static => FIRST_OF_STATIC,
        Method::Dynamic => FIRST_OF_DYNAMIC,
        Method::Paper | Method::Exact | Method::Auto => FIRST,
    };
    let stages =
        answer.methods.iter().fold(Stages::NONE, |stages, (method, _)| stages.and(method.stages()));
    let has_friction = answer.inputs.friction_coefficient.is_some();
    let is_listed = move |quantity: &&Quantity| {
        !first.contains(&quantity.key) && (has_friction || !quantity.needs_friction)
    };
    let rest = groups::quantities(answer.active).filter(is_listed);
    first
        .iter()
        .filter_map(|key| Quantity::find(key))
        .chain(rest)
        .filter(move |quantity| stages.has(quantity.stage))
}

/// The number of quantities above the heading of the free impact, if the method resolves the impact
/// itself.
pub(super) fn above_heading(answer: &Answer) -> Option<usize> {
    let own = || order(answer).position(Quantity::is_of_free_impact);
    answer.active.shares_load().then(own).flatten()
}

/// The line of a quantity.
pub(super) fn line_of(answer: &Answer, row: usize) -> usize {
    row + usize::from(above_heading(answer).is_some_and(|above| above <= row))
}

/// The quantity on a line; `None` on a heading.
pub(super) fn row_of(answer: &Answer, line: usize) -> Option<usize> {
    match above_heading(answer) {
        Some(above) if line == above => None,
        Some(above) if line > above => Some(line - 1),
        _ => Some(line),
    }
}

/// The whole table in a width.
pub(super) fn lines(pane: &Results<'_>, answer: &Answer, width: usize) -> Table {
    if let Some(variants) = pane.variants {
        return variants::lines(pane, answer, variants, width);
    }
    let cells: Vec<Cells> =
        order(answer).map(|quantity| Cells::of(pane, answer, quantity)).collect();
    let columns = Columns::of(pane, answer, &cells, width);
    let faint = if pane.is_stale { pane.look.theme.faint } else { Style::new() };
    let line = |cells| columns.line(pane, answer, cells).patch_style(faint);
    let mut rows: Vec<Line<'static>> = cells.iter().map(line).collect();
    if let Some(above) = above_heading(answer) {
        let titles = [format!("{FREE_IMPACT}:"), "Free impact:".to_owned()];
        let fits = titles.iter().find(|title| title.width() <= width);
        let title = text::cut(fits.unwrap_or(&titles[1]), width);
        rows.insert(above, Line::styled(title, pane.look.theme.title).patch_style(faint));
    }
    Table { heading: columns.heading(pane, answer).patch_style(faint), rows }
}

/// The texts of a row.
pub(super) struct Cells {
    quantity: &'static Quantity,
    symbol: String,
    label: &'static str,
    /// The number of each method, in the order of the answer.
    numbers: Vec<(Method, String)>,
    unit: &'static str,
    /// The unit of the numbers, "1" if none is shown.
    common: &'static str,
    mark: &'static str,
}

impl Cells {
    fn of(pane: &Results<'_>, answer: &Answer, quantity: &'static Quantity) -> Cells {
        let methods = methods(answer);
        let values: Vec<Option<f64>> =
            methods.iter().map(|&method| value(answer, method, quantity)).collect();
        let unit = report::common_unit(quantity, values.iter().copied().flatten(), pane.units);
        let shown = |value: f64| report::shown_with(quantity, value, unit);
        let number =
            |value: Option<f64>| value.map_or_else(|| "–".to_owned(), |value| shown(value).number);
        let has_value = values.iter().rev().copied().flatten().next();
        Cells {
            quantity,
            symbol: symbol(quantity.symbol_in(answer.active), pane.look.ascii).into_owned(),
            label: quantity.label_in(answer.active),
            numbers: methods.into_iter().zip(values.into_iter().map(number)).collect(),
            unit: has_value.map_or("", |value| shown(value).unit),
            common: unit,
            mark: mark(pane, answer, quantity),
        }
    }

    fn number(&self, method: Method) -> &str {
        let found = self.numbers.iter().find(|(own, _)| *own == method);
        found.map_or("", |(_, number)| number)
    }
}

// The methods with columns: results of `static` are among the rows of `dynamic`.
fn methods(answer: &Answer) -> Vec<Method> {
    let is_row = |method: Method| method == Method::Static && answer.active == Method::Dynamic;
    let methods = answer.methods.iter().map(|(method, _)| *method);
    methods.filter(|&method| !is_row(method)).collect()
}

// The mark of a quantity: above its limit, or changed.
fn mark(pane: &Results<'_>, answer: &Answer, quantity: &Quantity) -> &'static str {
    let solution = answer.of(answer.active).filter(|_| !pane.is_stale);
    let limit = pane.case.limits.iter().find(|limit| limit.quantity == quantity.key);
    let is_exceeded = limit
        .zip(solution)
        .is_some_and(|(limit, solution)| verdict(limit, solution).standing == Standing::Exceeded);
    match is_exceeded {
        true => "!",
        false if is_changed(pane, answer, quantity) => CHANGED,
        false => " ",
    }
}

// Whether the present visit of a field changed the printed value of the quantity.
fn is_changed(pane: &Results<'_>, answer: &Answer, quantity: &Quantity) -> bool {
    let Some(earlier) = pane.earlier.filter(|_| !pane.is_stale) else {
        return false;
    };
    let at = QUANTITIES.iter().position(|known| known.key == quantity.key);
    let before = at.and_then(|at| earlier.get(at).copied().flatten());
    let now = answer.of(answer.active).and_then(quantity.value);
    let printed = |value: Option<f64>| value.map(|value| shown_in(pane, quantity, value));
    printed(before) != printed(now)
}

fn value(answer: &Answer, method: Method, quantity: &Quantity) -> Option<f64> {
    report::value_as_in(quantity, answer.of(method)?, answer.active)
}
