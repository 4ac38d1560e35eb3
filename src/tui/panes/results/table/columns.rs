//! The columns of the table of quantities in a width, measured so that nothing is cut and no mark
//! touches a unit.

use ratatui::style::Style;
use ratatui::text::{Line, Span};
use unicode_width::UnicodeWidthStr;

use super::difference::{WIDTH as DIFFERENCE, difference};
use super::{Cells, methods};
use crate::model::inputs::Method;
use crate::report::difference::UNCHANGED;
use crate::tui::panes::results::pane::Results;
use crate::tui::solver::Answer;
use crate::tui::text;

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

/// The columns of the table.
pub(super) struct Columns {
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
    pub(super) fn of(
        pane: &Results<'_>,
        answer: &Answer,
        cells: &[Cells],
        width: usize,
    ) -> Columns {
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
    pub(super) fn heading(&self, pane: &Results<'_>, answer: &Answer) -> Line<'static> {
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

    pub(super) fn line(&self, pane: &Results<'_>, answer: &Answer, cells: &Cells) -> Line<'static> {
        let unit = cells.unit;
        let theme = pane.look.theme;
        let base = |room| difference(pane, answer, cells.quantity, cells.common, room);
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

#[cfg(test)]
mod tests {
    use super::*;

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
