//! The chart of accuracy against run time: one letter per setting, both axes logarithmic.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use super::pane::{TradePane, ordered, own};
use crate::model::inputs::Method;
use crate::report::trade::percent;
use crate::report::trade::plot::{Axis, shown, time};
use crate::study::trade::{METHODS, MeasuredSetting, Trade};
use crate::tui::jobs::Traded;

/// Width of a number beside the vertical axis.
const LABEL: u16 = 9;

/// The line of the accepted error.
pub(super) const LEVEL: &str = "╌";

/// The letter of a method, with its colour.
fn mark(pane: &TradePane<'_>, method: Method) -> (char, Style) {
    let theme = pane.look.theme;
    match method {
        Method::Paper => ('p', theme.faint),
        Method::Exact => ('e', theme.other),
        Method::Static => ('s', theme.path),
        Method::Dynamic => ('d', theme.active),
        Method::Auto => ('a', theme.note),
    }
}

/// Draws the legend: the meaning of the letters, one word each, then their case.
pub(super) fn draw_legend(pane: &TradePane<'_>, trade: &Trade, area: Rect, buffer: &mut Buffer) {
    let methods = METHODS.into_iter().chain([Method::Auto]);
    let words = methods.map(|method| (method.name().to_owned(), mark(pane, method).1));
    let within = format!("{LEVEL}{LEVEL} within {} %", percent(trade.within));
    let writing =
        ["CAPITAL on the front".to_owned(), "(case)".to_owned(), "[selected]".to_owned(), within];
    let mut x = area.x + 1;
    for (word, style) in words.chain(writing.map(|word| (word, Style::new()))) {
        let width = word.chars().count() as u16;
        if area.is_empty() || x + width > area.right() {
            return;
        }
        buffer.set_string(x, area.y, &word, style);
        x += width + 2;
    }
}

pub(super) fn draw_plot(
    pane: &TradePane<'_>,
    traded: &Traded,
    trade: &Trade,
    area: Rect,
    buffer: &mut Buffer,
) {
    let field = Rect {
        x: area.x + LABEL + 1,
        width: area.width - LABEL - 2,
        height: area.height - 2,
        ..area
    };
    let mut found = ordered(trade);
    let errors =
        found.iter().filter_map(|measured| measured.total()).chain([trade.within]).map(shown);
    let across = Axis::of(
        found.iter().map(|measured| measured.seconds()),
        f64::from(field.left()),
        f64::from(field.right() - 1),
    );
    let up = Axis::of(errors, f64::from(field.bottom() - 1), f64::from(field.top()));
    let errors: Vec<f64> = found.iter().filter_map(|measured| measured.total()).collect();
    let rows = Rows::of(up, trade.within, &errors, field);
    draw_axes(pane, &across, &rows, field, buffer);
    buffer.set_string(field.x, rows.level, LEVEL.repeat(field.width.into()), pane.look.theme.rule);
    let place = |measured: &MeasuredSetting| {
        Some((across.at(measured.seconds()).round() as u16, rows.at(measured.total()?)))
    };
    let front: Vec<(u16, u16)> =
        found.iter().filter(|measured| measured.is_on_front).filter_map(|one| place(one)).collect();
    draw_front(pane, &front, field, buffer);
    let own = own(pane);
    // The selected setting and the setting of the case are drawn on top.
    let weight = |measured: &MeasuredSetting| {
        (
            traded.marked == Some(measured.setting),
            own == Some(measured.setting),
            measured.is_on_front,
        )
    };
    found.sort_by_key(|measured| weight(measured));
    for measured in found {
        if let Some(at) = place(measured) {
            draw_mark(pane, measured, weight(measured), at, field, buffer);
        }
    }
}

/// The rows of the field. One row is the accepted error; greater errors are above it and smaller
/// ones below.
struct Rows {
    up: Axis,
    within: f64,
    level: u16,
    field: Rect,
}

impl Rows {
    fn of(up: Axis, within: f64, errors: &[f64], field: Rect) -> Rows {
        let above = u16::from(errors.iter().any(|error| *error > within));
        let below = u16::from(errors.iter().any(|error| *error <= within));
        let (first, last) = (field.top() + above, (field.bottom() - 1).saturating_sub(below));
        let level = (up.at(shown(within)).round() as u16).max(first).min(last.max(first));
        Rows { up, within, level, field }
    }

    fn at(&self, error: f64) -> u16 {
        let row = self.up.at(shown(error)).round() as u16;
        let row = if error > self.within {
            row.min(self.level.saturating_sub(1))
        } else {
            row.max(self.level + 1)
        };
        row.clamp(self.field.top(), self.field.bottom() - 1)
    }
}

/// Draws the steps of the least error for each time; no setting is below them.
fn draw_front(pane: &TradePane<'_>, front: &[(u16, u16)], field: Rect, buffer: &mut Buffer) {
    let mut dot = |x: u16, y: u16| {
        buffer.set_string(x, y, "·", pane.look.theme.note);
    };
    for (at, &(x, y)) in front.iter().enumerate() {
        let next = front.get(at + 1).copied().unwrap_or((field.right() - 1, y));
        (x..=next.0).for_each(|x| dot(x, y));
        (y.min(next.1)..=y.max(next.1)).for_each(|y| dot(next.0, y));
    }
}

/// Draws the letter of the method, a capital letter on the front, in brackets if the setting is
/// selected or belongs to the case.
fn draw_mark(
    pane: &TradePane<'_>,
    measured: &MeasuredSetting,
    (is_marked, is_own, is_on_front): (bool, bool, bool),
    (x, y): (u16, u16),
    field: Rect,
    buffer: &mut Buffer,
) {
    let theme = pane.look.theme;
    let (letter, style) = mark(pane, measured.setting.method);
    let letter = if is_on_front { letter.to_ascii_uppercase() } else { letter };
    let (mark, style) = match (is_marked, is_own) {
        (true, _) => (format!("[{letter}]"), theme.key),
        (false, true) => (format!("({letter})"), theme.focus),
        (false, false) => (letter.to_string(), style),
    };
    let x = if mark.len() == 3 {
        x.saturating_sub(1).clamp(field.left(), field.right().saturating_sub(3))
    } else {
        x
    };
    buffer.set_string(x, y, mark, style);
}

fn draw_axes(pane: &TradePane<'_>, across: &Axis, rows: &Rows, field: Rect, buffer: &mut Buffer) {
    let rule = pane.look.theme.rule;
    let axis = field.bottom();
    for y in field.top()..axis {
        buffer.set_string(field.x - 1, y, "│", rule);
    }
    buffer.set_string(field.x - 1, axis, "└", rule);
    buffer.set_string(field.x, axis, "─".repeat(field.width.into()), rule);
    let mut label = |y: u16, number: &str| {
        buffer.set_string(field.x - 1, y, "┤", rule);
        buffer.set_string(
            field.x - LABEL - 1,
            y,
            format!("{number:>0$} %", usize::from(LABEL) - 2),
            Style::new(),
        );
    };
    for decade in rows.up.marks(usize::from(field.height / 2)) {
        label(rows.at(10f64.powi(decade)), &in_percent(decade));
    }
    label(rows.level, &percent(rows.within));
    for decade in across.marks(usize::from(field.width / 9)) {
        let x = across.at(10f64.powi(decade)).round() as u16;
        let label = time(decade);
        let width = label.len() as u16;
        let start = x
            .saturating_sub(width / 2)
            .clamp(field.x, field.right().saturating_sub(width).max(field.x));
        buffer.set_string(x, axis, "┴", rule);
        buffer.set_stringn(start, axis + 1, label, usize::from(field.width), Style::new());
    }
}

/// A power of ten in percent, at most seven characters wide.
fn in_percent(decade: i32) -> String {
    match decade + 2 {
        exponent @ -3..=5 => format!("{}", 10f64.powi(exponent)),
        exponent => format!("1e{exponent}"),
    }
}

#[cfg(test)]
mod tests {
    use super::in_percent;

    #[test]
    fn powers_of_ten_in_percent_are_short() {
        let phrases: Vec<String> = [-16, -5, -2, 0, 3].map(in_percent).to_vec();
        assert_eq!(phrases, ["1e-14", "0.001", "1", "100", "100000"]);
    }
}
