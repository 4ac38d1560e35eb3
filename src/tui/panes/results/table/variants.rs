//! The variants of the case beside the case, each with its difference.

use ratatui::style::Style;
use ratatui::text::{Line, Span};
use unicode_width::UnicodeWidthStr;

use super::{Table, above_heading, order};
use crate::model::{Quantity, Solution};
use crate::report::difference::difference;
use crate::report::groups::FREE_IMPACT;
use crate::report::{common_unit, shown_with, value_as_in};
use crate::tui::ascii::symbol;
use crate::tui::panes::results::pane::Results;
use crate::tui::solver::{Answer, Variants};
use crate::tui::text;
use crate::tui::theme::Theme;

/// Least width of a value and of a difference.
const LEAST: usize = 7;
/// From this number of variants on, the names of the results have priority over a further variant.
const ENOUGH: usize = 2;
/// Texts of an absent value and of a refused variant.
const NONE: &str = "–";
const REFUSED: &str = "refused";

struct Cells {
    symbol: String,
    label: &'static str,
    unit: &'static str,
    own: String,
    /// The value and the difference of each variant.
    others: Vec<(String, String)>,
}

struct Layout {
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

/// The number of variants that fit side by side.
pub(in crate::tui::panes::results) fn page(pane: &Results<'_>, width: usize) -> usize {
    let (Some(answer), Some(variants)) = (pane.answer, pane.variants) else {
        return 1;
    };
    let cells: Vec<Cells> =
        order(answer).map(|known| Cells::of(pane, answer, variants, known)).collect();
    Layout::of(&cells, variants, width).count
}

/// The table of the variants from the first visible one on.
pub(super) fn lines(
    pane: &Results<'_>,
    answer: &Answer,
    variants: &Variants,
    width: usize,
) -> Table {
    let cells: Vec<Cells> =
        order(answer).map(|known| Cells::of(pane, answer, variants, known)).collect();
    let layout = Layout::of(&cells, variants, width);
    let seen = |of: usize| (pane.first_variant..of).take(layout.count).collect::<Vec<_>>();
    let seen = seen(variants.columns.len());
    let theme = pane.look.theme;
    let heading = layout.heading(variants, &seen, width, theme);
    let line = |cells: &Cells| layout.line(cells, &seen, width, theme);
    let mut rows: Vec<Line<'static>> = cells.iter().map(line).collect();
    if let Some(above) = above_heading(answer) {
        let title = text::cut(&format!("{FREE_IMPACT}:"), width);
        rows.insert(above, Line::styled(title, theme.title));
    }
    let faint =
        if pane.is_stale || variants.serial != answer.serial { theme.faint } else { Style::new() };
    Table { heading, rows: rows.into_iter().map(|row| row.patch_style(faint)).collect() }
}

impl Cells {
    fn of(
        pane: &Results<'_>,
        answer: &Answer,
        variants: &Variants,
        known: &'static Quantity,
    ) -> Cells {
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
        Cells {
            symbol: symbol(known.symbol_in(answer.active), pane.look.ascii).into_owned(),
            label: known.label_in(answer.active).trim_start(),
            unit: shown_with(known, own.unwrap_or(0.0), unit).unit,
            own: shown(own),
            others: found.iter().map(cell).collect(),
        }
    }
}

impl Layout {
    fn of(cells: &[Cells], variants: &Variants, width: usize) -> Layout {
        let most = |of: &dyn Fn(&Cells) -> usize| cells.iter().map(of).max().unwrap_or(0);
        let others = |of: &dyn Fn(&(String, String)) -> usize| {
            most(&|cells| cells.others.iter().map(of).max().unwrap_or(0)).max(LEAST)
        };
        let all = Layout {
            symbol: 1 + most(&|cells| cells.symbol.width()),
            label: 1 + most(&|cells| cells.label.width()),
            own: 1 + most(&|cells| cells.own.width()).max(LEAST),
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
            (labelled, _) if labelled >= wanted.min(ENOUGH) => {
                Layout { count: labelled.min(wanted), ..all }
            }
            (_, 0) => Layout { label: 0, own: 0, ..all },
            (_, count) => Layout { label: 0, count: count.min(wanted), ..all },
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
    fn line(&self, cells: &Cells, seen: &[usize], width: usize, theme: &Theme) -> Line<'static> {
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
