//! The table of quantities: one row each, with the methods or the variants side by side, marks of
//! changes and limits, and the difference from the baseline.

use std::borrow::Cow;

use ratatui::layout::{Alignment, Constraint};
use ratatui::style::Style;
use ratatui::text::Text;
use ratatui::widgets::{HighlightSpacing, Row, Table};
use unicode_width::UnicodeWidthStr;

use super::Results;
use crate::model::inputs::Method;
use crate::model::quantities::Need;
use crate::model::{QUANTITIES, Quantity, Solution, Stages};
use crate::report::compare::difference;
use crate::report::verdict::{Standing, verdict};
use crate::report::{self, value_as_in};
use crate::tui::solver::Answer;
use crate::tui::text;
use crate::tui::text::symbol;

/// The most important quantities of each method.
const FIRST: [&str; 15] = [
    "dynamic_peak_approach_force",
    "dynamic_peak_force",
    "dynamic_impact_duration",
    "dynamic_first_contact_angle_driver",
    "dynamic_contact_lost",
    "static_force_at_start",
    "static_peak_force",
    "static_first_contact_angle_driver",
    "static_transmission_error",
    "impact_force",
    "impact_duration",
    "approach_angle_driver",
    "friction_ratio",
    "normal_velocity",
    "total_deviation",
];

/// Marks after a value that the last edit changed, and after a value above its limit.
const CHANGED: &str = "←";
const EXCEEDED: &str = "!";
/// The text of an absent value.
const NONE: &str = "–";
/// A longer name of a variant is cut.
const LONGEST_NAME: usize = 18;

/// A column with a cell for each quantity. In a narrow pane, the columns of the highest rank are
/// removed first, and those of rank 0 remain; a column is cut to its least width before.
struct Column {
    rank: usize,
    least: usize,
    heading: String,
    cells: Vec<String>,
    alignment: Alignment,
    /// The styles of the heading and of the cells.
    styles: [Style; 2],
}

/// The rank of the units, which are cut but not removed.
const UNITS: usize = 2;

impl Column {
    fn words(rank: usize, least: usize, cells: Vec<String>, style: Style) -> Column {
        let (heading, alignment) = (String::new(), Alignment::Left);
        Column { rank, least, heading, cells, alignment, styles: [style; 2] }
    }

    fn numbers(rank: usize, heading: String, cells: Vec<String>, styles: [Style; 2]) -> Column {
        let (least, alignment) = (usize::MAX, Alignment::Right);
        Column { rank, least, heading, cells, alignment, styles }
    }

    fn width(&self) -> usize {
        let texts = self.cells.iter().chain([&self.heading]);
        texts.map(|text| text.width()).max().unwrap_or(0)
    }
}

/// The visible quantities: those of the method, the most important ones first and those without a
/// value last. The free impact beside a method that resolves the impact is folded away unless
/// every method is shown.
pub(super) fn order(pane: &Results<'_>, answer: &Answer) -> Vec<&'static Quantity> {
    let methods = || answer.methods.iter().map(|(method, _)| *method);
    let stages = methods().fold(Stages::NONE, |stages, method| stages.and(method.stages()));
    let has_friction = answer.inputs.friction_coefficient.is_some();
    let has_slices = answer.inputs.face().is_some();
    let is_folded = answer.active.shares_load() && !pane.shows_every_method;
    let first = FIRST.iter().filter_map(|key| Quantity::find(key));
    let rest = report::quantities(answer.active).filter(|quantity| {
        let is_open = match quantity.needs {
            Need::Friction => has_friction,
            Need::Slices => has_slices,
            _ => true,
        };
        is_open && !FIRST.contains(&quantity.key)
    });
    let listed = first.chain(rest).filter(|quantity| {
        stages.has(quantity.stage) && !(is_folded && quantity.is_of_free_impact())
    });
    let has_value =
        |quantity: &&Quantity| methods().any(|method| value(answer, method, quantity).is_some());
    let (mut known, unknown): (Vec<_>, Vec<_>) = listed.partition(has_value);
    known.extend(unknown);
    known
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
    let theme = pane.look.theme;
    let is_outdated = pane.variants.is_some_and(|(variants, _)| variants.serial != answer.serial);
    let columns = fitting(pane, answer);
    let row = |text: fn(&Column, usize) -> &str, part: usize, at: usize| {
        Row::new(columns.iter().map(|column| {
            let text = text(column, at).to_owned();
            Text::styled(text, column.styles[part]).alignment(column.alignment)
        }))
    };
    let rows = 0..columns.first().map_or(0, |column| column.cells.len());
    let widths = columns.iter().map(|column| Constraint::Length(column.width() as u16));
    let table = Table::new(rows.map(|at| row(|column, at| &column.cells[at], 1, at)), widths);
    let heading = row(|column, _| &column.heading, 0, 0);
    let table = if pane.has_header() { table.header(heading) } else { table };
    table
        .style(if pane.is_stale || is_outdated { theme.faint } else { Style::new() })
        .highlight_symbol(Text::styled("▸", theme.focus))
        .highlight_spacing(HighlightSpacing::Always)
}

/// The number of variants that fit side by side: the columns after the one of the units, which has
/// no heading.
pub(super) fn variants_page(pane: &Results<'_>) -> usize {
    let shown = pane.answer.map(|answer| fitting(pane, answer));
    let is_variant = |column: &&Column| !column.heading.is_empty();
    shown.map_or(1, |shown| shown.iter().rev().take_while(is_variant).count().max(1))
}

/// The value of the quantity and the value of the baseline, with the method of the baseline if it
/// differs.
pub(crate) fn compared(pane: &Results<'_>, quantity: &Quantity) -> Option<String> {
    let answer = pane.answer?;
    let (method, base) = base(pane, answer, quantity)?;
    let printed = |value: Option<f64>| match value {
        Some(value) => report::shown_in(quantity, value, pane.units).to_string(),
        None => "none".to_owned(),
    };
    let whose =
        if method == answer.active { String::new() } else { format!(" ({})", method.name()) };
    let own = printed(value(answer, answer.active, quantity));
    Some(format!("{own}; baseline{whose}: {}.", printed(base)))
}

/// The columns that fit, each after a blank.
fn fitting(pane: &Results<'_>, answer: &Answer) -> Vec<Column> {
    let mut columns = columns(pane, answer);
    loop {
        let taken: usize = columns.iter().map(|column| column.width() + 1).sum();
        let over = taken.saturating_sub(pane.area.width.into());
        let is_cut = |column: &Column| column.rank == UNITS && column.width() <= column.least;
        let left = columns.iter().enumerate().filter(|(_, column)| !is_cut(column));
        let last = left.max_by_key(|(_, column)| column.rank);
        let Some((at, last)) = last.filter(|(_, last)| over > 0 && last.rank > 0) else {
            return columns;
        };
        let least = if last.rank == UNITS { last.least } else { 0 };
        let room = last.width().saturating_sub(over).max(least);
        if room >= last.least {
            // The symbol tells the method.
            let short = |cell: &str| {
                let stripped =
                    ["static: ", "dynamic: "].iter().find_map(|by| cell.strip_prefix(by));
                text::cut(stripped.unwrap_or(cell), room)
            };
            columns[at].cells.iter_mut().for_each(|cell| *cell = short(cell));
        } else {
            columns.remove(at);
        }
    }
}

fn columns(pane: &Results<'_>, answer: &Answer) -> Vec<Column> {
    let (theme, active, known) = (pane.look.theme, answer.active, order(pane, answer));
    // Results of `static` are among the rows of `dynamic`.
    let shows_others = pane.shows_every_method && pane.variants.is_none();
    let is_shown = |method: Method| {
        let is_among_rows = active == Method::Dynamic && method == Method::Static;
        method == active || (shows_others && !is_among_rows)
    };
    let methods = answer.methods.iter().map(|(method, _)| *method);
    let methods: Vec<Method> = methods.filter(|method| is_shown(*method)).collect();
    let variants = pane.variants.map_or(&[][..], |(variants, _)| &variants.columns);
    let unit = |quantity: &&'static Quantity| {
        let of_methods = methods.iter().filter_map(|&method| value(answer, method, quantity));
        let of_variants = variants
            .iter()
            .filter_map(|(_, found)| value_as_in(quantity, found.as_ref().ok()?, active));
        report::common_unit(quantity, of_methods.chain(of_variants), pane.units)
    };
    let units: Vec<&str> = known.iter().map(unit).collect();
    let own = |at: usize| value(answer, active, known[at]);
    let number = |at: usize, value: Option<f64>| {
        let shown = |value| report::shown_with(known[at], value, units[at]).number;
        value.map_or_else(|| NONE.to_owned(), shown)
    };
    let cells = |cell: &dyn Fn(usize) -> String| (0..known.len()).map(cell).collect::<Vec<_>>();
    let symbols = cells(&|at| symbol(known[at].symbol_in(active), pane.look.ascii).into_owned());
    let labels = cells(&|at| label(known[at], active).into_owned());
    let mut columns = vec![
        Column::words(0, 0, symbols, Style::new()),
        Column::words(90, 10, labels, Style::new()),
    ];
    for (at, &method) in methods.iter().enumerate() {
        let numbers = cells(&|at| number(at, value(answer, method, known[at])));
        let (rank, heading, styles) = match pane.variants {
            Some(_) => (3, "case".to_owned(), [theme.active, theme.focus]),
            None if method == active => {
                (0, format!("▸{}", method.name()), [theme.active, theme.focus])
            }
            // The fastest method, which is the least accurate one, is removed first.
            None => (50 - at, method.name().to_owned(), [theme.other, Style::new()]),
        };
        columns.push(Column::numbers(rank, heading, numbers, styles));
    }
    let of_unit = |at: usize| {
        let has_value = methods.iter().any(|&method| value(answer, method, known[at]).is_some());
        let unit = if has_value { report::shown_with(known[at], 0.0, units[at]).unit } else { "" };
        let mark = if pane.variants.is_some() { "" } else { mark(pane, answer, known[at]) };
        [unit, mark].join(" ").trim().to_owned()
    };
    columns.push(Column::words(UNITS, 5, cells(&of_unit), Style::new()));
    if let Some((variants, first)) = pane.variants {
        let plain = [theme.other, Style::new()];
        for (at, (name, found)) in variants.columns.iter().skip(first).enumerate() {
            let pair = |at: usize| variant_cell(found, known[at], (own(at), active, units[at]));
            let pairs: Vec<_> = (0..known.len()).map(pair).collect();
            let right = pairs.iter().map(|pair| pair[1].width()).max().unwrap_or(0);
            let pairs = pairs.iter().map(|[now, by]| format!("{now} {by:>right$}")).collect();
            let rank = if at == 0 { 0 } else { 3 + at };
            columns.push(Column::numbers(rank, text::cut(name, LONGEST_NAME), pairs, plain));
        }
    } else if pane.baseline.is_some() {
        let difference = |at: usize| match (own(at), base(pane, answer, known[at])) {
            (Some(now), Some((_, Some(base)))) => difference(known[at], now, base, units[at]),
            (None, Some((_, Some(base)))) => format!("was {}", number(at, Some(base))),
            (Some(_), _) => "was none".to_owned(),
            (None, _) => String::new(),
        };
        let heading = "baseline".to_owned();
        columns.push(Column::numbers(1, heading, cells(&difference), [theme.baseline; 2]));
    } else {
        let equations = cells(&|at| known[at].equation.to_owned());
        columns.push(Column::words(99, 12, equations, theme.faint));
    }
    columns
}

/// The value of a quantity in a variant and its difference from the value of the case.
fn variant_cell(
    found: &Result<Solution, String>,
    quantity: &Quantity,
    (own, active, unit): (Option<f64>, Method, &'static str),
) -> [String; 2] {
    let Ok(found) = found else { return ["refused".to_owned(), String::new()] };
    let now = value_as_in(quantity, found, active).filter(|now| now.is_finite());
    let Some(now) = now else { return [NONE.to_owned(), String::new()] };
    let by = own.map_or_else(String::new, |own| difference(quantity, now, own, unit));
    [report::shown_with(quantity, now, unit).number, by]
}

// The mark of a quantity: above its limit, or changed.
fn mark(pane: &Results<'_>, answer: &Answer, quantity: &Quantity) -> &'static str {
    let Some(solution) = answer.of(answer.active).filter(|_| !pane.is_stale) else { return "" };
    let limit = pane.case.limits.iter().find(|limit| limit.quantity == quantity);
    let verdict = limit.map(|limit| verdict(limit, solution));
    if verdict.is_some_and(|verdict| verdict.standing == Standing::Exceeded) {
        return EXCEEDED;
    }
    // Whether the present visit of a field changed the printed value of the quantity.
    let at = QUANTITIES.iter().position(|known| known.key == quantity.key);
    let before = pane.earlier.zip(at).map(|(earlier, at)| earlier.get(at).copied().flatten());
    let printed =
        |value: Option<f64>| value.map(|value| report::shown_in(quantity, value, pane.units));
    let is_changed = |before| printed(before) != printed((quantity.value)(solution));
    if before.is_some_and(is_changed) { CHANGED } else { "" }
}

fn value(answer: &Answer, method: Method, quantity: &Quantity) -> Option<f64> {
    value_as_in(quantity, answer.of(method)?, answer.active)
}

// The method and the value of the baseline.
fn base(pane: &Results<'_>, answer: &Answer, quantity: &Quantity) -> Option<(Method, Option<f64>)> {
    let base = &pane.baseline?.answer;
    let method = base.beside(answer.active);
    Some((method, value_as_in(quantity, base.of(method)?, answer.active)))
}
