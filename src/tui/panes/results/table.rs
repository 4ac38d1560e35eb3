//! The table of quantities: one line each, with the methods side by side, marks of changes and
//! limits, and the difference from the baseline.

use ratatui::style::Style;
use ratatui::text::{Line, Span};
use unicode_width::UnicodeWidthStr;

use super::Results;
use super::words::shown_in;
use crate::case::units::system::counted;
use crate::model::inputs::Method;
use crate::model::{Outcome, QUANTITIES, Quantity, Solution, Stages};
use crate::report::compare::{UNCHANGED, difference, in_percent, is_unchanged, percent};
use crate::report::verdict::{Standing, verdict};
use crate::report::{self, FREE_IMPACT, common_unit, shown_with, value_as_in};
use crate::tui::ascii::symbol;
use crate::tui::solver::{Answer, Variants};
use crate::tui::text;
use crate::tui::theme::Theme;

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

/// Columns of a difference.
const DIFFERENCE: usize = UNCHANGED.len();

/// Width of a number, if there is room.
const NUMBER: usize = 9;
/// Width of the mark after a unit, with its blank.
const MARK: usize = 2;
/// From this number of methods on, labels have priority over a further method.
const ENOUGH_METHODS: usize = 2;
/// Least width of the column of the equations.
const EQUATIONS: usize = 12;
/// The heading of the differences.
const TO_BASE: &str = "vs baseline";
/// The headings of the closed forms beside a method that resolves the impact.
const FREE: [&str; 3] = ["free impact: ", "free: ", ""];
/// Signs of a value equal to the baseline and of a different value, if the words do not fit.
const EQUAL: &str = "=";
const OTHER: &str = "!=";
/// Width of a symbol if value, unit and difference share the rest of the line.
const SHARED_SYMBOL: usize = 7;

/// Least width of a value and of a difference.
const LEAST_VARIANT: usize = 7;
/// From this number of variants on, the names of the results have priority over a further variant.
const ENOUGH_VARIANTS: usize = 2;
/// Texts of an absent value and of a refused variant.
const NONE: &str = "–";
const REFUSED: &str = "refused";

pub(super) struct Table {
    pub(super) heading: Line<'static>,
    /// A line for every quantity, and a heading above the quantities of the free impact.
    pub(super) rows: Vec<Line<'static>>,
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
        return variant_lines(pane, answer, variants, width);
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

/// The number of variants that fit side by side.
pub(super) fn variants_page(pane: &Results<'_>, width: usize) -> usize {
    let (Some(answer), Some(variants)) = (pane.answer, pane.variants) else {
        return 1;
    };
    let cells: Vec<VariantCells> =
        order(answer).map(|known| VariantCells::of(pane, answer, variants, known)).collect();
    VariantLayout::of(&cells, variants, width).count
}

/// The number of quantities above the heading of the free impact, if the method resolves the impact
/// itself.
fn above_heading(answer: &Answer) -> Option<usize> {
    let own = || order(answer).position(Quantity::is_of_free_impact);
    answer.active.shares_load().then(own).flatten()
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

// The difference of the active method's value from the baseline by the same method: in percent, or
// the value of the baseline.
fn difference_to_base(
    pane: &Results<'_>,
    answer: &Answer,
    quantity: &Quantity,
    unit: &str,
    room: usize,
) -> String {
    let now = value(answer, answer.active, quantity);
    match (now, base(pane, answer, quantity).and_then(|(_, base)| base)) {
        (Some(now), Some(base)) => {
            against(quantity, now, base).unwrap_or_else(|| was(base, unit, room))
        }
        (Some(_), None) => "was none".to_owned(),
        (None, Some(base)) => was(base, unit, room),
        (None, None) => String::new(),
    }
}

// The value of the baseline in the unit of the line, with as many digits as fit.
fn was(base: f64, unit: &str, room: usize) -> String {
    let words = (1..=3).rev().map(|digits| format!("was {}", counted(base, unit, digits)));
    words.into_iter().find(|words| words.len() <= room).unwrap_or_else(|| "was other".to_owned())
}

// The method and the value of the baseline.
fn base(pane: &Results<'_>, answer: &Answer, quantity: &Quantity) -> Option<(Method, Option<f64>)> {
    let base = &pane.baseline?.answer;
    let method = base.beside(answer.active);
    Some((method, report::value_as_in(quantity, base.of(method)?, answer.active)))
}

// The difference in percent, if a percentage has a meaning.
fn against(quantity: &Quantity, now: f64, base: f64) -> Option<String> {
    if is_unchanged(now, base) {
        return Some(UNCHANGED.to_owned());
    }
    percent(quantity, now, base).map(in_percent)
}

/// The columns of the table.
struct Columns {
    width: usize,
    /// Width of the symbols with the following blank.
    symbol: usize,
    /// Width of the labels, if they are shown.
    label: Option<usize>,
    methods: Vec<Method>,
    /// Width of the numbers of each method with the preceding blank. Without labels the first width
    /// includes the symbol.
    numbers: Vec<usize>,
    unit: usize,
    has_base: bool,
    /// Whether value, unit and difference share a column.
    is_shared: bool,
}

impl Columns {
    fn of(pane: &Results<'_>, answer: &Answer, cells: &[Cells], width: usize) -> Columns {
        let all = subsets(answer);
        let enough = |methods: &&Vec<Method>| methods.len() >= ENOUGH_METHODS.min(all[0].len());
        let columns = |methods: &Vec<Method>, is_labelled, is_tight| {
            Columns::measured(pane, methods, cells, width, is_labelled, is_tight)
        };
        let labelled = all.iter().filter(enough).map(|methods| columns(methods, true, false));
        let others = all.iter().flat_map(|methods| {
            [(true, false), (false, false), (false, true)]
                .map(|(is_labelled, is_tight)| columns(methods, is_labelled, is_tight))
        });
        labelled.chain(others).find(|columns| columns.taken() <= width).unwrap_or_else(|| Columns {
            is_shared: pane.baseline.is_some(),
            ..columns(&vec![answer.active], false, true)
        })
    }

    fn measured(
        pane: &Results<'_>,
        methods: &[Method],
        cells: &[Cells],
        width: usize,
        is_labelled: bool,
        is_tight: bool,
    ) -> Columns {
        let widest = |of: &dyn Fn(&Cells) -> usize| cells.iter().map(of).max().unwrap_or(0);
        let symbol = 1 + widest(&|cells| cells.symbol.width());
        let least = if is_tight { 0 } else { NUMBER };
        let number = |(at, &method): (usize, &Method)| {
            let heading = method.name().width() + 1;
            let number = widest(&|cells| cells.number(method).width());
            let column = 1 + number.max(least).max(heading);
            match at {
                0 if is_labelled => column,
                0 if is_tight => {
                    let joint =
                        |cells: &Cells| cells.symbol.width() + 1 + cells.number(method).width();
                    widest(&joint).max(heading)
                }
                0 => symbol - 1 + column,
                _ => column,
            }
        };
        Columns {
            width,
            symbol,
            label: is_labelled.then(|| 1 + widest(&|cells| cells.label.width())),
            methods: methods.to_vec(),
            numbers: methods.iter().enumerate().map(number).collect(),
            unit: widest(&|cells| cells.unit.width()),
            has_base: pane.baseline.is_some(),
            is_shared: false,
        }
    }

    fn taken(&self) -> usize {
        let names = self.label.map_or(0, |label| self.symbol + label - 1);
        let base = if self.has_base { 1 + DIFFERENCE } else { 0 };
        names + self.numbers.iter().sum::<usize>() + 1 + self.unit + MARK + base
    }

    /// The names of the methods above their columns.
    fn heading(&self, pane: &Results<'_>, answer: &Answer) -> Line<'static> {
        if self.is_shared {
            return self.shared_heading(pane, answer);
        }
        let theme = pane.look.theme;
        let mut spans = Vec::new();
        let mut before = self.label.map_or(0, |label| self.symbol + label - 1);
        for (at, (&method, &width)) in self.methods.iter().zip(&self.numbers).enumerate() {
            let is_active = method == answer.active;
            let mark = if is_active { "▸" } else { "" };
            let name = format!("{mark}{}", method.name());
            let room = before + width;
            before = 0;
            let is_free = at == 0 && !is_active && answer.active.shares_load();
            let fits = |free: &&&str| free.width() + name.width() < room;
            let free = FREE.iter().filter(|_| is_free).find(fits).copied().unwrap_or_default();
            let style = if is_active { theme.active } else { theme.other };
            let blank = room.saturating_sub(free.width() + name.width());
            spans.push(Span::raw(" ".repeat(blank)));
            spans.push(Span::styled(free, theme.faint));
            spans.push(Span::styled(name, style));
        }
        if self.has_base {
            let room = self.unit + MARK + DIFFERENCE + 1;
            let heading = to_base(pane, answer, room);
            let heading = format!(" {heading:>room$}");
            spans.push(Span::styled(heading, theme.baseline));
        }
        Line::from(spans)
    }

    fn shared_heading(&self, pane: &Results<'_>, answer: &Answer) -> Line<'static> {
        let method = format!("▸{}", answer.active.name());
        let room = self.width.saturating_sub(method.width() + 1);
        let heading = format!(" {:>room$}", to_base(pane, answer, room));
        Line::from(vec![
            Span::styled(method, pane.look.theme.active),
            Span::styled(heading, pane.look.theme.baseline),
        ])
    }

    fn line(&self, pane: &Results<'_>, answer: &Answer, cells: &Cells) -> Line<'static> {
        let unit = cells.unit;
        let theme = pane.look.theme;
        let base = |room| difference_to_base(pane, answer, cells.quantity, cells.common, room);
        if self.is_shared {
            let start = SHARED_SYMBOL.max(cells.symbol.width() + 1);
            let room = self.width.saturating_sub(start);
            let number = cells.number(answer.active);
            let rest = room.saturating_sub(number.width() + unit.width() + 2);
            let [value, base] = shared_row(number, unit, cells.mark, &base(rest), room);
            return Line::from(vec![
                Span::raw(text::padded(&cells.symbol, start)),
                Span::styled(value, theme.focus),
                Span::styled(base, theme.baseline),
            ]);
        }
        let mut spans = vec![Span::raw(match self.label {
            Some(label) => {
                text::padded(&cells.symbol, self.symbol) + &text::padded(cells.label, label - 1)
            }
            None => cells.symbol.clone(),
        })];
        let mut taken = if self.label.is_some() { 0 } else { cells.symbol.width() };
        for (&method, &width) in self.methods.iter().zip(&self.numbers) {
            let is_active = method == answer.active;
            let style = if is_active { theme.focus } else { Style::new() };
            let room = width.saturating_sub(taken);
            taken = 0;
            spans.push(Span::styled(format!("{:>room$}", cells.number(method)), style));
        }
        let behind =
            if unit.is_empty() { cells.mark.to_owned() } else { format!(" {}", cells.mark) };
        let room = (self.unit + MARK).saturating_sub(unit.width());
        let is_marked = !cells.mark.trim().is_empty();
        spans.push(Span::raw(format!(" {unit}")));
        spans.push(Span::styled(
            format!("{behind:<room$}"),
            if is_marked { theme.focus } else { Style::new() },
        ));
        if self.has_base {
            let difference = base(DIFFERENCE);
            spans.push(Span::styled(format!(" {difference:>DIFFERENCE$}"), theme.baseline));
        }
        let left = self.width.saturating_sub(self.taken() + 1);
        let equation = cells.quantity.equation;
        if !self.has_base && self.label.is_some() && left >= EQUATIONS && equation.width() <= left {
            spans.push(Span::styled(format!(" {equation}"), theme.faint));
        }
        Line::from(spans)
    }
}

// The sets of methods to show, the largest first: each set drops the least accurate of the
// remaining methods, and the last set is the active method.
fn subsets(answer: &Answer) -> Vec<Vec<Method>> {
    let mut methods = methods(answer);
    let mut subsets = vec![methods.clone()];
    while let Some(first) = methods.iter().position(|method| *method != answer.active) {
        methods.remove(first);
        subsets.push(methods.clone());
    }
    subsets
}

// The heading of the differences, with the method of the baseline if it differs.
fn to_base(pane: &Results<'_>, answer: &Answer, room: usize) -> String {
    let base = pane.baseline.map(|baseline| baseline.answer.beside(answer.active));
    let other = base.filter(|&base| base != answer.active).map(Method::name);
    let headings = other.map(|other| [format!("vs {other} baseline"), format!("{other} baseline")]);
    let fits = headings.into_iter().flatten().find(|heading| heading.width() <= room);
    fits.unwrap_or_else(|| text::cut(TO_BASE, room))
}

// The value with its unit, the mark and the difference. Without room, the mark and the blank before
// the percent sign are omitted, and a sign replaces the difference.
fn shared_row(number: &str, unit: &str, mark: &str, difference: &str, width: usize) -> [String; 2] {
    let joined = |parts: &[&str]| {
        let parts = parts.iter().filter(|part| !part.trim().is_empty());
        parts.copied().collect::<Vec<_>>().join(" ")
    };
    let (value, marked) = (joined(&[number, unit]), joined(&[number, unit, mark]));
    let close = difference.replace(" %", "%");
    let sign = if difference == UNCHANGED { EQUAL } else { OTHER };
    let sayings = [
        (&marked, difference),
        (&marked, close.as_str()),
        (&value, difference),
        (&value, close.as_str()),
        (&marked, sign),
    ];
    let fits = sayings
        .into_iter()
        .find(|(value, difference)| value.width() + 1 + difference.width() <= width);
    let (value, difference) = fits.unwrap_or((&value, sign));
    let gap = width.saturating_sub(value.width());
    [value.clone(), format!("{difference:>gap$}")]
}

struct VariantCells {
    symbol: String,
    label: &'static str,
    unit: &'static str,
    own: String,
    /// The value and the difference of each variant.
    others: Vec<(String, String)>,
}

struct VariantLayout {
    symbol: usize,
    /// 0 if the names do not fit.
    label: usize,
    /// 0 if the values of the case do not fit.
    own: usize,
    value: usize,
    difference: usize,
    unit: usize,
    /// Number of variants that fit.
    count: usize,
}

/// The table of the variants from the first visible one on.
fn variant_lines(pane: &Results<'_>, answer: &Answer, variants: &Variants, width: usize) -> Table {
    let cells: Vec<VariantCells> =
        order(answer).map(|known| VariantCells::of(pane, answer, variants, known)).collect();
    let layout = VariantLayout::of(&cells, variants, width);
    let seen = |of: usize| (pane.first_variant..of).take(layout.count).collect::<Vec<_>>();
    let seen = seen(variants.columns.len());
    let theme = pane.look.theme;
    let heading = layout.heading(variants, &seen, width, theme);
    let line = |cells: &VariantCells| layout.line(cells, &seen, width, theme);
    let mut rows: Vec<Line<'static>> = cells.iter().map(line).collect();
    if let Some(above) = above_heading(answer) {
        let title = text::cut(&format!("{FREE_IMPACT}:"), width);
        rows.insert(above, Line::styled(title, theme.title));
    }
    let faint =
        if pane.is_stale || variants.serial != answer.serial { theme.faint } else { Style::new() };
    Table { heading, rows: rows.into_iter().map(|row| row.patch_style(faint)).collect() }
}

impl VariantCells {
    fn of(
        pane: &Results<'_>,
        answer: &Answer,
        variants: &Variants,
        known: &'static Quantity,
    ) -> VariantCells {
        let value = |solution: &Solution| {
            value_as_in(known, solution, answer.active).filter(|value| value.is_finite())
        };
        let own = answer.of(answer.active).and_then(value);
        let found: Vec<Result<Option<f64>, ()>> = variants
            .columns
            .iter()
            .map(|(_, found)| found.as_ref().map(&value).map_err(|_| ()))
            .collect();
        let all = found.iter().filter_map(|found| found.ok().flatten()).chain(own);
        let unit = common_unit(known, all, pane.units);
        let shown = |value: Option<f64>| {
            value.map_or_else(|| NONE.to_owned(), |value| shown_with(known, value, unit).number)
        };
        let cell = |found: &Result<Option<f64>, ()>| match (found, own) {
            (Ok(Some(value)), Some(own)) => {
                (shown(Some(*value)), difference(known, *value, own, unit))
            }
            (Ok(value), _) => (shown(*value), String::new()),
            (Err(()), _) => (REFUSED.to_owned(), String::new()),
        };
        VariantCells {
            symbol: symbol(known.symbol_in(answer.active), pane.look.ascii).into_owned(),
            label: known.label_in(answer.active).trim_start(),
            unit: shown_with(known, own.unwrap_or(0.0), unit).unit,
            own: shown(own),
            others: found.iter().map(cell).collect(),
        }
    }
}

impl VariantLayout {
    fn of(cells: &[VariantCells], variants: &Variants, width: usize) -> VariantLayout {
        let most = |of: &dyn Fn(&VariantCells) -> usize| cells.iter().map(of).max().unwrap_or(0);
        let others = |of: &dyn Fn(&(String, String)) -> usize| {
            most(&|cells| cells.others.iter().map(of).max().unwrap_or(0)).max(LEAST_VARIANT)
        };
        let all = VariantLayout {
            symbol: 1 + most(&|cells| cells.symbol.width()),
            label: 1 + most(&|cells| cells.label.width()),
            own: 1 + most(&|cells| cells.own.width()).max(LEAST_VARIANT),
            value: 1 + others(&|cells| cells.0.width()),
            difference: 1 + others(&|cells| cells.1.width()),
            unit: 1 + most(&|cells| cells.unit.width()),
            count: 1,
        };
        let fitting = |label: usize| {
            let rest = width.saturating_sub(all.symbol + label + all.own + all.unit);
            rest / (all.value + all.difference)
        };
        let wanted = variants.columns.len().max(1);
        match (fitting(all.label), fitting(0)) {
            (labelled, _) if labelled >= wanted.min(ENOUGH_VARIANTS) => {
                VariantLayout { count: labelled.min(wanted), ..all }
            }
            (_, 0) => VariantLayout { label: 0, own: 0, ..all },
            (_, count) => VariantLayout { label: 0, count: count.min(wanted), ..all },
        }
    }

    /// The names of the columns.
    fn heading(
        &self,
        variants: &Variants,
        seen: &[usize],
        width: usize,
        theme: &Theme,
    ) -> Line<'static> {
        let name = |at: usize, room: usize| {
            let name = text::cut(&variants.columns[at].0, room.saturating_sub(1));
            Span::styled(format!("{name:>room$}"), theme.other)
        };
        if self.own == 0 {
            let names = seen.iter().map(|&at| name(at, width - self.symbol.min(width)));
            let blank = Span::raw(" ".repeat(self.symbol));
            return std::iter::once(blank).chain(names).collect();
        }
        let blank = Span::raw(" ".repeat(self.symbol + self.label + self.unit));
        let own = Span::styled(format!("{:>1$}", "case", self.own), theme.active);
        let names = seen.iter().map(|&at| name(at, self.value + self.difference));
        [blank, own].into_iter().chain(names).collect()
    }

    /// The line of a quantity. Without the values of the case, the unit follows the first value.
    fn line(
        &self,
        cells: &VariantCells,
        seen: &[usize],
        width: usize,
        theme: &Theme,
    ) -> Line<'static> {
        let symbol = Span::raw(text::padded(&cells.symbol, self.symbol));
        if self.own == 0 {
            let others = seen.iter().flat_map(|&at| {
                let (value, difference) = &cells.others[at];
                let value = format!("{value} {}", cells.unit).trim_end().to_owned();
                let rest = width.saturating_sub(self.symbol + value.width());
                let close = difference.replace(" %", "%");
                let fits = [difference, &close].into_iter().find(|words| words.width() < rest);
                let difference = fits.map_or("", |words| words);
                [Span::raw(value), Span::styled(format!("{difference:>rest$}"), theme.baseline)]
            });
            return std::iter::once(symbol).chain(others).collect();
        }
        let before = [
            symbol,
            Span::raw(text::padded(cells.label, self.label)),
            Span::raw(text::padded(cells.unit, self.unit)),
            Span::styled(format!("{:>1$}", cells.own, self.own), theme.focus),
        ];
        let others = seen.iter().flat_map(|&at| {
            let (value, difference) = &cells.others[at];
            let room = self.difference;
            [
                Span::raw(format!("{value:>0$}", self.value)),
                Span::styled(format!("{difference:>room$}"), theme.baseline),
            ]
        });
        before.into_iter().chain(others).collect()
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_value_many_times_the_baseline_or_that_may_be_negative_shows_the_baseline() {
        let force = Quantity::find("impact_force").expect("a quantity");
        for (now, base, worded) in [
            (1.0, 0.0, "was 0"),
            (18.0, 0.0169, "was 0.017"),
            (1e9, 1.0, "was 1.00"),
            (500.0, 47.3, "was 47.3"),
        ] {
            assert_eq!(against(force, now, base), None, "{now} {base}");
            assert_eq!(was(base, "1", DIFFERENCE), worded);
        }
        let deviation = Quantity::find("total_deviation").expect("a quantity");
        assert_eq!(against(deviation, 2e-6, 1e-6), None);
        assert_eq!(against(force, 2.0, 2.0).as_deref(), Some(UNCHANGED));
    }

    #[test]
    fn a_difference_without_room_is_a_sign_and_never_cut() {
        for (difference, width, shown) in [
            ("was 47.3", 18, ["216.79 kg mm2", "   !="]),
            (UNCHANGED, 18, ["216.79 kg mm2", "    ="]),
            (UNCHANGED, 24, ["216.79 kg mm2", "  unchanged"]),
        ] {
            assert_eq!(shared_row("216.79", "kg mm2", " ", difference, width), shown);
        }
        assert_eq!(shared_row("5354.2", "N", "!", "+48.1 %", 17), ["5354.2 N !", " +48.1%"]);
    }
}
