//! Time and difference of every method with every compliance, one row per compliance.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use crate::model::impact::StiffnessModels;
use crate::report::trade::{Cell, compliance_name, compliances};
use crate::study::trade::{METHODS, Setting, Trade};
use crate::tui::theme::Theme;

/// Width of a compliance with its mark.
const NAME: usize = 23;
/// Width of a cell with time and difference.
const WIDE: usize = 14;
/// Width of a cell with only the difference.
const NARROW: usize = 8;

/// The marked settings of the table.
#[derive(Debug, Clone, Copy)]
pub(super) struct Marks {
    /// The selected setting.
    pub(super) selected: Option<Setting>,
    /// The compliance of the case.
    pub(super) own: Option<StiffnessModels>,
}

/// Draws the table and returns the number of rows that it uses.
pub(super) fn draw(
    trade: &Trade,
    marks: &Marks,
    theme: &Theme,
    area: Rect,
    buffer: &mut Buffer,
) -> u16 {
    let width = usize::from(area.width);
    let is_wide = NAME + WIDE * METHODS.len() <= width;
    let cell_width = if is_wide { WIDE } else { NARROW };
    let mut put = |row: u16, column: usize, text: &str, style: Style| {
        if row < area.height && column < width {
            let x = area.x + column as u16;
            buffer.set_stringn(x, area.y + row, text, width - column, style);
        }
    };
    for (at, method) in METHODS.into_iter().enumerate() {
        let name = format!("{:>cell_width$}", method.name());
        put(0, NAME + at * cell_width, &name, theme.title);
    }
    let rows = compliances(trade);
    for (row, (models, cells)) in (1..).zip(&rows) {
        let mark = if marks.own == Some(*models) { '*' } else { ' ' };
        let name = format!("{mark}{}", compliance_name(*models));
        put(row, 0, &name, Style::new());
        for (at, cell) in cells.iter().enumerate() {
            let Some(cell) = cell else { continue };
            let is_selected = marks.selected == Some(cell.setting);
            let (text, style) = (text(cell, is_wide, is_selected), theme);
            let style = if is_selected { style.key } else { Style::new() };
            put(row, NAME + at * cell_width, &format!("{text:>cell_width$}"), style);
        }
    }
    (rows.len() as u16 + 1).min(area.height)
}

fn text(cell: &Cell, is_wide: bool, is_selected: bool) -> String {
    let text = if is_wide { cell.to_string() } else { cell.total.clone() };
    if is_selected { format!("▸{text}") } else { text }
}
