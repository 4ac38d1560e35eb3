//! The table of quantities: one row each, with the methods or the variants side by side, marks of
//! changes and limits, and the difference from the baseline.

use std::borrow::Cow;

use ratatui::layout::{Alignment, Constraint};
use ratatui::style::Style;
use ratatui::text::Text;
use ratatui::widgets::{HighlightSpacing, Row, Table};
use unicode_width::UnicodeWidthStr;

use super::Results;
use super::words::shown_in;
use crate::model::inputs::Method;
use crate::model::{Outcome, QUANTITIES, Quantity, Solution, Stages};
use crate::report::compare::difference;
use crate::report::verdict::{Standing, verdict};
use crate::report::{self, value_as_in};
use crate::tui::ascii::symbol;
use crate::tui::solver::Answer;
use crate::tui::text;

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

/// Marks after a value that the last edit changed, and after a value above its limit.
const CHANGED: &str = "←";
const EXCEEDED: &str = "!";
/// Texts of an absent value and of a refused variant.
const NONE: &str = "–";
const REFUSED: &str = "refused";
/// A longer name of a variant is cut.
const LONGEST_NAME: usize = 18;
/// Least width of the equations; a longer one is left out if it does not fit.
const LEAST_EQUATION: usize = 12;
/// Least width of the units with their marks.
const LEAST_UNIT: usize = 5;

/// In a narrow pane columns give way in this order; the last ones remain.
#[derive(Debug, Clone, Copy, PartialEq, Eq, PartialOrd, Ord)]
enum Rank {
    Equation,
    /// A method or a variant beyond the second one.
    Further,
    Label,
    /// The second method, or the case beside its variants.
    Second,
    Baseline,
    Kept,
    /// The units are cut if nothing else gives way.
    Unit,
}

/// A column with a cell for each quantity.
struct Column {
    rank: Rank,
    heading: String,
    cells: Vec<String>,
    alignment: Alignment,
    /// The styles of the heading and of the cells.
    styles: [Style; 2],
}

impl Column {
    fn words(rank: Rank, cells: impl Iterator<Item = String>, style: Style) -> Column {
        let (heading, alignment) = (String::new(), Alignment::Left);
        Column { rank, heading, cells: cells.collect(), alignment, styles: [style; 2] }
    }

    fn numbers(rank: Rank, heading: String, cells: Vec<String>, styles: [Style; 2]) -> Column {
        Column { rank, heading, cells, alignment: Alignment::Right, styles }
    }

    fn width(&self) -> usize {
        let texts = self.cells.iter().chain([&self.heading]);
        texts.map(|text| text.width()).max().unwrap_or(0)
    }

    fn cell(&self, text: &str, style: Style) -> Text<'static> {
        Text::styled(text.to_owned(), style).alignment(self.alignment)
    }
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
    let rest = report::quantities(answer.active).filter(is_listed);
    first
        .iter()
        .filter_map(|key| Quantity::find(key))
        .chain(rest)
        .filter(move |quantity| stages.has(quantity.stage))
}

/// The label of a quantity, which names the free impact beside a method that resolves the impact.
pub(crate) fn label(quantity: &Quantity, active: Method) -> Cow<'static, str> {
    let label = quantity.label_in(active);
    if active.shares_load() && quantity.is_of_free_impact() {
        format!("free: {}", label.trim_start()).into()
    } else {
        label.into()
    }
}

/// The table in the width of the pane.
pub(super) fn table(pane: &Results<'_>, answer: &Answer) -> Table<'static> {
    let columns = fitting(pane, columns(pane, answer, pane.first_variant));
    let theme = pane.look.theme;
    let is_outdated = |serial: u64| serial != answer.serial;
    let is_stale =
        pane.is_stale || pane.variants.is_some_and(|variants| is_outdated(variants.serial));
    let heading = columns.iter().map(|column| column.cell(&column.heading, column.styles[0]));
    let row = |at: usize| {
        let cells = columns.iter().map(|column| column.cell(&column.cells[at], column.styles[1]));
        Row::new(cells.collect::<Vec<_>>())
    };
    let rows: Vec<Row<'static>> = (0..order(answer).count()).map(row).collect();
    let widths = columns.iter().map(|column| Constraint::Length(column.width() as u16));
    Table::new(rows, widths)
        .header(Row::new(heading.collect::<Vec<_>>()))
        .style(if is_stale { theme.faint } else { Style::new() })
        .highlight_symbol(Text::styled("▸", theme.focus))
        .highlight_spacing(HighlightSpacing::Always)
}

/// The columns that fit, each after a blank. The fastest method, which is the least accurate one,
/// and the last variant give way first.
fn fitting(pane: &Results<'_>, mut columns: Vec<Column>) -> Vec<Column> {
    let width = usize::from(pane.area.width);
    let taken = |columns: &[Column]| columns.iter().map(|column| column.width() + 1).sum::<usize>();
    let unit = |columns: &[Column]| {
        let unit = columns.iter().find(|column| column.rank == Rank::Unit);
        unit.map_or(0, Column::width)
    };
    while let Some(least) = columns.iter().map(|column| column.rank).min() {
        let is_plenty = least < Rank::Second;
        let spare = if is_plenty { 0 } else { unit(&columns).saturating_sub(LEAST_UNIT) };
        if taken(&columns) <= width + spare || least >= Rank::Kept {
            break;
        }
        let over = taken(&columns) - width;
        let equations = columns.iter_mut().find(|column| column.rank == Rank::Equation);
        if let Some(equations) = equations
            && let Some(room) = equations.width().checked_sub(over)
            && room >= LEAST_EQUATION
        {
            equations.cells.iter_mut().filter(|cell| cell.width() > room).for_each(String::clear);
            break;
        }
        let is_least = |column: &Column| column.rank == least;
        let found = match pane.variants {
            Some(_) => columns.iter().rposition(is_least),
            None => columns.iter().position(is_least),
        };
        columns.remove(found.unwrap_or(0));
    }
    let room = (width + unit(&columns)).saturating_sub(taken(&columns));
    for column in columns.iter_mut().filter(|column| column.rank == Rank::Unit) {
        column.cells.iter_mut().for_each(|unit| *unit = text::cut(unit, room));
    }
    columns
}

/// Every column, with the variants from a first one on.
fn columns(pane: &Results<'_>, answer: &Answer, first_variant: usize) -> Vec<Column> {
    let (theme, active) = (pane.look.theme, answer.active);
    let known: Vec<&'static Quantity> = order(answer).collect();
    let methods = if pane.variants.is_some() { vec![active] } else { methods(answer) };
    let units = units(pane, answer, &known, &methods);
    let number = |at: usize, value: Option<f64>| {
        let shown = |value| report::shown_with(known[at], value, units[at]).number;
        value.map_or_else(|| NONE.to_owned(), shown)
    };
    let own = |at: usize| value(answer, active, known[at]);
    let of_method = |(at, &method): (usize, &Method)| {
        let (rank, heading) = match (pane.variants, methods.len() - at) {
            (Some(_), _) => (Rank::Second, "case".to_owned()),
            _ if method == active => (Rank::Kept, format!("▸{}", method.name())),
            (None, left) => {
                let rank = if left > 2 { Rank::Further } else { Rank::Second };
                (rank, method.name().to_owned())
            }
        };
        let cells = (0..known.len()).map(|at| number(at, value(answer, method, known[at])));
        let is_active = method == active;
        let styles =
            if is_active { [theme.active, theme.focus] } else { [theme.other, Style::new()] };
        Column::numbers(rank, heading, cells.collect(), styles)
    };
    let of_variant = |(at, (name, found)): (usize, &(String, Result<Solution, String>))| {
        let cell = |at: usize| {
            let Ok(found) = found else { return [REFUSED.to_owned(), String::new()] };
            let now = value_as_in(known[at], found, active).filter(|now| now.is_finite());
            let against = now.zip(own(at));
            let against = against.map(|(now, own)| difference(known[at], now, own, units[at]));
            [number(at, now), against.unwrap_or_default()]
        };
        let cells: Vec<[String; 2]> = (0..known.len()).map(cell).collect();
        let widest = |part: usize| cells.iter().map(|cell| cell[part].width()).max().unwrap_or(0);
        let (left, right) = (widest(0), widest(1));
        let cells = cells.iter().map(|[now, by]| format!("{now:>left$} {by:>right$}")).collect();
        let rank = [Rank::Kept, Rank::Second].get(at).copied().unwrap_or(Rank::Further);
        Column::numbers(rank, text::cut(name, LONGEST_NAME), cells, [theme.other, Style::new()])
    };
    let difference_to_base = |at: usize| match (own(at), base(pane, answer, known[at])) {
        (Some(now), Some((_, Some(base)))) => difference(known[at], now, base, units[at]),
        (None, Some((_, Some(base)))) => format!("was {}", number(at, Some(base))),
        (Some(_), _) => "was none".to_owned(),
        (None, _) => String::new(),
    };
    let symbols = known.iter().map(|known| symbol(known.symbol_in(active), pane.look.ascii));
    let labels = known.iter().map(|known| label(known, active));
    let shown_units = known.iter().zip(&units).map(|(known, &unit)| {
        let has_value = methods.iter().any(|&method| value(answer, method, known).is_some());
        let unit = if has_value { report::shown_with(known, 0.0, unit).unit } else { "" };
        let mark = if pane.variants.is_some() { "" } else { mark(pane, answer, known) };
        [unit, mark].join(" ").trim().to_owned()
    });
    let plain = Style::new();
    let mut columns = vec![
        Column::words(Rank::Kept, symbols.map(Cow::into_owned), plain),
        Column::words(Rank::Label, labels.map(Cow::into_owned), plain),
    ];
    columns.extend(methods.iter().enumerate().map(of_method));
    columns.push(Column::words(Rank::Unit, shown_units, plain));
    if let Some(variants) = pane.variants {
        columns.extend(variants.columns.iter().skip(first_variant).enumerate().map(of_variant));
        return columns;
    }
    if pane.baseline.is_some() {
        let cells = (0..known.len()).map(difference_to_base).collect();
        let heading = "baseline".to_owned();
        columns.push(Column::numbers(Rank::Baseline, heading, cells, [theme.baseline; 2]));
    } else {
        let equations = known.iter().map(|quantity| quantity.equation.to_owned());
        columns.push(Column::words(Rank::Equation, equations, theme.faint));
    }
    columns
}

/// The common unit of the values of each quantity.
fn units(
    pane: &Results<'_>,
    answer: &Answer,
    known: &[&'static Quantity],
    methods: &[Method],
) -> Vec<&'static str> {
    let variants = pane.variants.map_or(&[][..], |variants| &variants.columns);
    let unit = |quantity: &&'static Quantity| {
        let of_methods = methods.iter().filter_map(|&method| value(answer, method, quantity));
        let of_variants = variants
            .iter()
            .filter_map(|(_, found)| value_as_in(quantity, found.as_ref().ok()?, answer.active));
        report::common_unit(quantity, of_methods.chain(of_variants), pane.units)
    };
    known.iter().map(unit).collect()
}

/// The value of the quantity and the value of the baseline, with the method of the baseline if it
/// differs.
pub(super) fn compared(pane: &Results<'_>, answer: &Answer, quantity: &Quantity) -> Option<String> {
    let (method, base) = base(pane, answer, quantity)?;
    let printed = |value: Option<f64>| {
        value.map_or_else(|| "none".to_owned(), |value| shown_in(pane, quantity, value).to_string())
    };
    let whose =
        if method == answer.active { String::new() } else { format!(" ({})", method.name()) };
    Some(format!(
        "{}; baseline{whose}: {}.",
        printed(value(answer, answer.active, quantity)),
        printed(base)
    ))
}

/// The number of variants that fit side by side: the columns after the one of the units, which has
/// no heading.
pub(super) fn variants_page(pane: &Results<'_>) -> usize {
    let shown = pane.answer.map(|answer| fitting(pane, columns(pane, answer, 0)));
    let is_variant = |column: &&Column| !column.heading.is_empty();
    shown.map_or(1, |shown| shown.iter().rev().take_while(is_variant).count().max(1))
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
        .and_then(|(limit, solution)| verdict(limit, solution))
        .is_some_and(|verdict| verdict.standing == Standing::Exceeded);
    match is_exceeded {
        true => EXCEEDED,
        false if is_changed(pane, answer, quantity) => CHANGED,
        false => "",
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

// The method and the value of the baseline.
fn base(pane: &Results<'_>, answer: &Answer, quantity: &Quantity) -> Option<(Method, Option<f64>)> {
    let base = &pane.baseline?.answer;
    let method = base.beside(answer.active);
    Some((method, report::value_as_in(quantity, base.of(method)?, answer.active)))
}
