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
use crate::report::{self, Shown, value_as_in};
use crate::tui::ascii::symbol;
use crate::tui::solver::Answer;
use crate::tui::text;

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
/// Texts of an absent value and of a refused variant.
const NONE: &str = "–";
const REFUSED: &str = "refused";
/// A longer name of a variant is cut.
const LONGEST_NAME: usize = 18;
/// Least widths of the equations and of the units, which are cut in a narrow pane.
const LEAST_EQUATION: usize = 12;
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
    /// The units are cut before the second method or the baseline gives way.
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

/// The quantities that at least one method has: first those with a value, the most important ones
/// before the others in the order of the active method.
pub(super) fn order(answer: &Answer) -> Vec<&'static Quantity> {
    let methods = || answer.methods.iter().map(|(method, _)| *method);
    let stages = methods().fold(Stages::NONE, |stages, method| stages.and(method.stages()));
    let has_friction = answer.inputs.friction_coefficient.is_some();
    let first = FIRST.iter().filter_map(|key| Quantity::find(key));
    let rest = report::quantities(answer.active).filter(|quantity| {
        !FIRST.contains(&quantity.key) && (has_friction || quantity.needs != Need::Friction)
    });
    let listed = first.chain(rest).filter(|quantity| stages.has(quantity.stage));
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
    let columns = Content::of(pane, answer).fitting();
    let theme = pane.look.theme;
    let is_outdated = pane.variants.is_some_and(|(variants, _)| variants.serial != answer.serial);
    let heading = columns.iter().map(|column| column.cell(&column.heading, column.styles[0]));
    let row = |at: usize| {
        let cells = columns.iter().map(|column| column.cell(&column.cells[at], column.styles[1]));
        Row::new(cells.collect::<Vec<_>>())
    };
    let count = columns.first().map_or(0, |column| column.cells.len());
    let widths = columns.iter().map(|column| Constraint::Length(column.width() as u16));
    Table::new((0..count).map(row), widths)
        .header(Row::new(heading.collect::<Vec<_>>()))
        .style(if pane.is_stale || is_outdated { theme.faint } else { Style::new() })
        .highlight_symbol(Text::styled("▸", theme.focus))
        .highlight_spacing(HighlightSpacing::Always)
}

/// The number of variants that fit side by side: the columns after the one of the units, which has
/// no heading.
pub(super) fn variants_page(pane: &Results<'_>) -> usize {
    let shown = pane.answer.map(|answer| Content::of(pane, answer).fitting());
    let is_variant = |column: &&Column| !column.heading.is_empty();
    shown.map_or(1, |shown| shown.iter().rev().take_while(is_variant).count().max(1))
}

/// The value of the quantity and the value of the baseline, with the method of the baseline if it
/// differs.
pub(crate) fn compared(pane: &Results<'_>, quantity: &Quantity) -> Option<String> {
    let answer = pane.answer?;
    let (method, base) = base(pane, answer, quantity)?;
    let printed = |value: Option<f64>| {
        value.map_or_else(|| "none".to_owned(), |value| shown_in(pane, quantity, value).to_string())
    };
    let whose =
        if method == answer.active { String::new() } else { format!(" ({})", method.name()) };
    let own = printed(value(answer, answer.active, quantity));
    Some(format!("{own}; baseline{whose}: {}.", printed(base)))
}

/// The quantities with the methods that have a column and the units of the values.
struct Content<'a> {
    pane: &'a Results<'a>,
    answer: &'a Answer,
    known: Vec<&'static Quantity>,
    methods: Vec<Method>,
    units: Vec<&'static str>,
}

impl<'a> Content<'a> {
    fn of(pane: &'a Results<'a>, answer: &'a Answer) -> Content<'a> {
        let (known, active) = (order(answer), answer.active);
        // Results of `static` are among the rows of `dynamic`.
        let is_column = |method: Method| match pane.variants {
            Some(_) => method == active,
            None => active != Method::Dynamic || method != Method::Static,
        };
        let methods: Vec<Method> = answer.methods.iter().map(|(method, _)| *method).collect();
        let methods: Vec<Method> =
            methods.into_iter().filter(|method| is_column(*method)).collect();
        let variants = pane.variants.map_or(&[][..], |(variants, _)| &variants.columns);
        let unit = |quantity: &&'static Quantity| {
            let of_methods = methods.iter().filter_map(|&method| value(answer, method, quantity));
            let of_variants = variants
                .iter()
                .filter_map(|(_, found)| value_as_in(quantity, found.as_ref().ok()?, active));
            report::common_unit(quantity, of_methods.chain(of_variants), pane.units)
        };
        let units = known.iter().map(unit).collect();
        Content { pane, answer, known, methods, units }
    }

    /// The columns that fit, each after a blank. The fastest method, which is the least accurate
    /// one, and the last variant give way first.
    fn fitting(&self) -> Vec<Column> {
        let mut columns = self.columns();
        let width = usize::from(self.pane.area.width);
        loop {
            let taken: usize = columns.iter().map(|column| column.width() + 1).sum();
            let over = taken.saturating_sub(width);
            let ranks = columns.iter().map(|column| column.rank);
            let Some(least) = ranks.min().filter(|least| over > 0 && *least < Rank::Kept) else {
                return columns;
            };
            let (cut, narrowest) = match least {
                Rank::Equation => (Rank::Equation, LEAST_EQUATION),
                Rank::Further | Rank::Label => (Rank::Unit, usize::MAX),
                _ => (Rank::Unit, LEAST_UNIT),
            };
            let cut = columns.iter_mut().find(|column| column.rank == cut);
            if let Some(column) = cut
                && column.width().saturating_sub(over) >= narrowest
            {
                let room = column.width() - over;
                column.cells.iter_mut().for_each(|cell| *cell = text::cut(cell, room));
                continue;
            }
            let is_least = |column: &Column| column.rank == least;
            let found = match self.pane.variants {
                Some(_) => columns.iter().rposition(is_least),
                None => columns.iter().position(is_least),
            };
            columns.remove(found.unwrap_or(0));
        }
    }

    fn columns(&self) -> Vec<Column> {
        let (pane, answer, known) = (self.pane, self.answer, &self.known);
        let (theme, active) = (pane.look.theme, answer.active);
        let symbols = known.iter().map(|known| symbol(known.symbol_in(active), pane.look.ascii));
        let labels = known.iter().map(|known| label(known, active));
        let plain = Style::new();
        let mut columns = vec![
            Column::words(Rank::Kept, symbols.map(Cow::into_owned), plain),
            Column::words(Rank::Label, labels.map(Cow::into_owned), plain),
        ];
        columns.extend((0..self.methods.len()).map(|at| self.of_method(at)));
        let units = known.iter().zip(&self.units).map(|(known, &unit)| {
            let has_value =
                self.methods.iter().any(|&method| value(answer, method, known).is_some());
            let unit = if has_value { report::shown_with(known, 0.0, unit).unit } else { "" };
            let mark = if pane.variants.is_some() { "" } else { mark(pane, answer, known) };
            [unit, mark].join(" ").trim().to_owned()
        });
        columns.push(Column::words(Rank::Unit, units, plain));
        if let Some((variants, first)) = pane.variants {
            let variants = variants.columns.iter().skip(first).enumerate();
            columns.extend(variants.map(|(at, (name, found))| self.of_variant(at, name, found)));
        } else if pane.baseline.is_some() {
            let cells = (0..known.len()).map(|at| self.difference_to_base(at)).collect();
            let styles = [theme.baseline; 2];
            columns.push(Column::numbers(Rank::Baseline, "baseline".to_owned(), cells, styles));
        } else {
            let equations = known.iter().map(|quantity| quantity.equation.to_owned());
            columns.push(Column::words(Rank::Equation, equations, theme.faint));
        }
        columns
    }

    fn of_method(&self, at: usize) -> Column {
        let (theme, method) = (self.pane.look.theme, self.methods[at]);
        let is_active = method == self.answer.active;
        let (rank, heading) = match (self.pane.variants, self.methods.len() - at) {
            (Some(_), _) => (Rank::Second, "case".to_owned()),
            (None, _) if is_active => (Rank::Kept, format!("▸{}", method.name())),
            (None, left) => {
                let rank = if left > 2 { Rank::Further } else { Rank::Second };
                (rank, method.name().to_owned())
            }
        };
        let value = |at: usize| self.number(at, value(self.answer, method, self.known[at]));
        let cells = (0..self.known.len()).map(value).collect();
        let styles =
            if is_active { [theme.active, theme.focus] } else { [theme.other, Style::new()] };
        Column::numbers(rank, heading, cells, styles)
    }

    /// The values of a variant and their differences from the case.
    fn of_variant(&self, at: usize, name: &str, found: &Result<Solution, String>) -> Column {
        let cell = |at: usize| {
            let Ok(found) = found else { return [REFUSED.to_owned(), String::new()] };
            let quantity = self.known[at];
            let now = value_as_in(quantity, found, self.answer.active);
            let now = now.filter(|now| now.is_finite());
            let by = now.zip(self.own(at));
            let by = by.map(|(now, own)| difference(quantity, now, own, self.units[at]));
            [self.number(at, now), by.unwrap_or_default()]
        };
        let cells: Vec<[String; 2]> = (0..self.known.len()).map(cell).collect();
        let widest = |part: usize| cells.iter().map(|cell| cell[part].width()).max().unwrap_or(0);
        let (left, right) = (widest(0), widest(1));
        let cells = cells.iter().map(|[now, by]| format!("{now:>left$} {by:>right$}")).collect();
        let rank = [Rank::Kept, Rank::Second].get(at).copied().unwrap_or(Rank::Further);
        let styles = [self.pane.look.theme.other, Style::new()];
        Column::numbers(rank, text::cut(name, LONGEST_NAME), cells, styles)
    }

    fn difference_to_base(&self, at: usize) -> String {
        let quantity = self.known[at];
        match (self.own(at), base(self.pane, self.answer, quantity)) {
            (Some(now), Some((_, Some(base)))) => difference(quantity, now, base, self.units[at]),
            (None, Some((_, Some(base)))) => format!("was {}", self.number(at, Some(base))),
            (Some(_), _) => "was none".to_owned(),
            (None, _) => String::new(),
        }
    }

    fn own(&self, at: usize) -> Option<f64> {
        value(self.answer, self.answer.active, self.known[at])
    }

    fn number(&self, at: usize, value: Option<f64>) -> String {
        let shown = |value| report::shown_with(self.known[at], value, self.units[at]).number;
        value.map_or_else(|| NONE.to_owned(), shown)
    }
}

// The mark of a quantity: above its limit, or changed.
fn mark(pane: &Results<'_>, answer: &Answer, quantity: &Quantity) -> &'static str {
    let Some(solution) = answer.of(answer.active).filter(|_| !pane.is_stale) else { return "" };
    let limit = pane.case.limits.iter().find(|limit| limit.quantity == quantity.key);
    let verdict = limit.and_then(|limit| verdict(limit, solution));
    if verdict.is_some_and(|verdict| verdict.standing == Standing::Exceeded) {
        return EXCEEDED;
    }
    // Whether the present visit of a field changed the printed value of the quantity.
    let at = QUANTITIES.iter().position(|known| known.key == quantity.key);
    let before = pane.earlier.zip(at).map(|(earlier, at)| earlier.get(at).copied().flatten());
    let printed = |value: Option<f64>| value.map(|value| shown_in(pane, quantity, value));
    let is_changed = |before| printed(before) != printed((quantity.value)(solution));
    if before.is_some_and(is_changed) { CHANGED } else { "" }
}

fn shown_in(pane: &Results<'_>, quantity: &Quantity, value: f64) -> Shown {
    report::shown_in(quantity, value, pane.units)
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
