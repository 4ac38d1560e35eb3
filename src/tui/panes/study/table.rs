//! The points of a study as a table: the varied fields, then each curve.

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Rect};
use ratatui::text::Text;
use ratatui::widgets::{Row, Table, Widget};
use unicode_width::UnicodeWidthStr;

use super::{StudyPane, cursor, value_words};
use crate::case::FIELDS;
use crate::report::chart::Axis;
use crate::report::common_unit;
use crate::tui::ascii::symbol;
use crate::tui::study::{GridParameters, StudyResults};

pub(super) fn draw(
    pane: &StudyPane<'_>,
    shown: &StudyResults,
    grid: &GridParameters,
    area: Rect,
    buffer: &mut Buffer,
) {
    let count: usize = grid.axes.iter().map(|axis| axis.points.len()).product();
    let width = grid.axes.last().map_or(1, |axis| axis.points.len());
    let (x, y) = cursor(pane, shown);
    let (marked, rows) = (y * width + x, usize::from(area.height.saturating_sub(1)));
    let top = marked.saturating_sub(rows / 2).min(count.saturating_sub(rows));
    let fields = grid.axes.iter().map(|axis| {
        let name = FIELDS[axis.field].full_label();
        Axis::new(name, axis.unit.clone()).in_unit()
    });
    let layers = || grid.layers.iter().zip(&shown.layers);
    let curves = layers().filter_map(|(layer, found)| {
        let known = layer.quantity()?;
        let unit = common_unit(known, found.values.iter().flatten().copied(), pane.units);
        let name = format!("{} {}", layer.name(), known.symbol_in(layer.inputs.method));
        Some(Axis::new(name, unit).in_unit())
    });
    let head: Vec<String> =
        fields.chain(curves).map(|name| symbol(&name, pane.look.ascii).into_owned()).collect();
    let row = |at: usize| {
        let up = (grid.axes.len() > 1).then(|| grid.axes[0].points[at / width].text.clone());
        let across = grid.axes.last().map(|axis| axis.points[at % width].text.clone());
        let curves = layers().map(|(layer, found)| {
            value_words(layer, found, at, pane.units, false).unwrap_or_default()
        });
        up.into_iter().chain(across).chain(curves).collect::<Vec<String>>()
    };
    let shown: Vec<_> = (top..count.min(top + rows)).map(|at| (at == marked, row(at))).collect();
    let widest = |column: usize| {
        let cells = shown.iter().filter_map(|(_, row)| row.get(column)).map(|cell| cell.width());
        cells.chain([head[column].width()]).max().unwrap_or(0) as u16
    };
    let widths: Vec<_> = (0..head.len()).map(|at| Constraint::Length(widest(at))).collect();
    let cells = |texts: Vec<String>| texts.into_iter().map(|text| Text::from(text).right_aligned());
    let theme = pane.look.theme;
    let lines = shown.into_iter().map(|(is_marked, row)| {
        let row = Row::new(cells(row));
        if is_marked { row.style(theme.focus) } else { row }
    });
    let table = Table::new(lines, widths).header(Row::new(cells(head)).style(theme.title));
    let area = Rect { x: area.x + 1, width: area.width.saturating_sub(2), ..area };
    table.column_spacing(2).render(area, buffer);
}
