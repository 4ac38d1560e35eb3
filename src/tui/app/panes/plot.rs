//! Draws charts on the terminal: the legend, two axes with their labels, a map, curves, bars, points
//! and marks.

use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Position, Rect};
use ratatui::style::{Color, Modifier, Style};
use ratatui::symbols::Marker;
use ratatui::widgets::canvas::{Canvas, Line, Points};
use ratatui::widgets::{Block, Borders, Widget};
use unicode_width::UnicodeWidthStr;

use crate::report::chart::{Axis, Cell as MapCell, Chart, Kind, Labels, Map, Point, Series, Span};
use crate::tui::settings::Theme;
use crate::tui::text;

/// Least distance of labels below a plot, in columns.
pub(crate) const LABEL_COLUMNS: u16 = 9;
/// Least distance of labels beside it, in rows.
const LABEL_ROWS: u16 = 2;
/// The signs of the horizontal axis.
const AXIS: &str = "─┴";
/// The smallest plot.
const LEAST: (u16, u16) = (12, 2);
/// Shades of a map from the least to the greatest value.
const SHADES: [char; 5] = ['∙', '░', '▒', '▓', '█'];
/// The signs of a map: the limit, the edge of contact, no contact, and a refused point.
const LIMIT: char = '+';
const EDGE: char = 'o';
pub(crate) const NO_CONTACT: char = '_';
pub(crate) const REFUSED: char = '!';

/// The marker and the style of a series.
pub(crate) type Look = (Marker, Style);

/// Words with their style in the legend.
pub(crate) type Words = (String, Style);

/// A chart with the looks of its series.
pub(crate) struct TerminalChart<'a> {
    pub(crate) chart: &'a Chart,
    pub(crate) looks: Vec<Look>,
    /// Further words of the legend.
    pub(crate) words: Vec<Words>,
    /// Whether the curves share the cells that several of them cross.
    pub(crate) is_compared: bool,
    pub(crate) theme: &'static Theme,
}

/// The cells of a plot with the ranges of its axes.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Plot {
    /// The cells between the axes; empty if there is no room.
    pub(crate) cells: Rect,
    pub(crate) across: Span,
    pub(crate) up: Span,
    /// Whether each row is a cell of a map.
    pub(crate) is_map: bool,
}

impl TerminalChart<'_> {
    /// Draws the legend and the chart below it, in the ranges of its axes and with at least this
    /// margin for labels.
    pub(crate) fn draw(
        &self,
        area: Rect,
        spans: (Span, Span),
        margin: u16,
        buffer: &mut Buffer,
    ) -> Plot {
        let Chart { across, up, series, marks, map, .. } = self.chart;
        let names = series.iter().zip(&self.looks).map(|(series, look)| {
            let missing = if series.pieces.is_empty() { " (no value)" } else { "" };
            let name = series.name.split(", ").next().unwrap_or_default();
            (format!("{} {name}{missing}", sample(look.0)), look.1)
        });
        let shades = map.iter().flat_map(|map| map_words(map, self.theme));
        let words: Vec<Words> = shades.chain(names).chain(self.words.iter().cloned()).collect();
        let most = area.height.saturating_sub(2 + LEAST.1);
        let rows = draw_legend(&words, Rect { height: most, ..area }, buffer);
        let area = Rect { y: area.y + rows, height: area.height - rows, ..area };
        let unit = unit_of(across).width() as u16 + 1;
        let margin = margin.max(label_margin(up, spans.1, area.height)).max(unit);
        let plot = Plot { is_map: map.is_some(), ..Plot::new(area, margin, spans) };
        if !plot.cells.is_empty() {
            plot.draw_axes(across, up, self.theme, buffer);
            if let Some(map) = map {
                plot.draw_map(map, self.theme, buffer);
            }
            for column in marks.iter().filter_map(|mark| plot.column(mark.0)) {
                let line = Rect { x: column, width: 1, ..plot.cells };
                line.positions().filter(|_| map.is_some()).for_each(|at| buffer[at].reset());
            }
            self.draw_series(&plot, buffer);
            // The 0 of logarithms means nothing.
            if map.is_none() && up.labels.is_empty() && spans.1.from < 0.0 && spans.1.to > 0.0 {
                plot.draw_level(0.0, "┄", self.theme.faint, buffer);
            }
            for (x, name) in marks {
                plot.draw_upright(*x, "┊", self.theme.faint, buffer);
                plot.draw_mark(*x, name, self.theme.focus, buffer);
            }
        }
        plot
    }

    /// Bars, then curves, then points; the first series is on top. Compared curves alternate in the
    /// columns of cells that several of them cross, so that each is visible without colour.
    fn draw_series(&self, plot: &Plot, buffer: &mut Buffer) {
        let all = || self.chart.series.iter().zip(&self.looks).enumerate().rev();
        for (at, (series, look)) in all().filter(|(_, (series, _))| series.kind == Kind::Bars) {
            let (width, from) = Series::bar(at, self.chart.series.len());
            plot.draw_bars(series, (width, from), *look, buffer);
        }
        let is_curve = |kind| matches!(kind, Kind::Curve | Kind::Bound);
        let curves = all().filter(|(_, (series, _))| is_curve(series.kind));
        let layers: Vec<Buffer> = curves
            .map(|(_, (series, look))| plot.layer(&[(&series.pieces, look.1)], look.0))
            .collect();
        for (at, position) in plot.cells.positions().enumerate() {
            let cells = layers.iter().map(|layer| &layer.content[at]);
            let mut drawn = cells.filter(|cell| cell.symbol() != " ");
            let count = drawn.clone().count().max(1);
            let turn = if self.is_compared { position.x.into() } else { count - 1 };
            if let Some(own) = drawn.nth(turn % count) {
                buffer[position] = own.clone();
            }
        }
        for (_, (series, look)) in all() {
            if matches!(series.kind, Kind::Marks(_)) {
                for &point in series.pieces.iter().flatten() {
                    plot.draw_point(point, &sample(look.0), look.1, buffer);
                }
            }
        }
    }
}

impl Plot {
    /// The plot in an area with a margin for the labels of the vertical axis.
    pub(crate) fn new(area: Rect, margin: u16, (across, up): (Span, Span)) -> Plot {
        let cells = Rect {
            x: area.x + margin,
            width: area.width.saturating_sub(margin + 1),
            height: area.height.saturating_sub(2),
            ..area
        };
        let has_room = cells.width >= LEAST.0 && cells.height >= LEAST.1;
        let cells = if has_room { cells } else { Rect::ZERO };
        Plot { cells, across, up, is_map: false }
    }

    /// The column of a value, if it is in the range.
    pub(crate) fn column(&self, x: f64) -> Option<u16> {
        let part = self.across.part(x);
        let width = f64::from(self.cells.width.saturating_sub(1));
        (-1e-9..=1.0 + 1e-9)
            .contains(&part)
            .then(|| self.cells.x + (width * part.clamp(0.0, 1.0)).round() as u16)
    }

    /// The value on a column.
    pub(crate) fn value(&self, column: u16) -> f64 {
        let last = f64::from(self.cells.width.max(2) - 1);
        let part = f64::from(column.saturating_sub(self.cells.x)) / last;
        self.across.from + part * self.across.length()
    }

    /// The row of a value, or the nearest row: that of its Braille dot, on a map that of its cell.
    pub(crate) fn row(&self, y: f64) -> u16 {
        if !self.is_map {
            return self.cells.y + row_in(self.cells.height, self.up, y);
        }
        let last = f64::from(self.cells.height.saturating_sub(1));
        self.cells.y + ((1.0 - self.up.part(y)).clamp(0.0, 1.0) * last).round() as u16
    }

    /// The value on a row: the first and the last row show the ends of the axis.
    pub(crate) fn height(&self, row: u16) -> f64 {
        let last = f64::from(self.cells.height.max(2) - 1);
        self.up.to - f64::from(row.saturating_sub(self.cells.y)) / last * self.up.length()
    }

    /// Draws the lines, ticks and labels of both axes, and the unit of the horizontal one.
    pub(crate) fn draw_axes(&self, across: &Axis, up: &Axis, theme: &Theme, buffer: &mut Buffer) {
        let (cells, rule) = (self.cells, theme.rule);
        let (left, bottom) = (cells.x - 1, cells.bottom());
        let frame = Rect { x: left, width: cells.width + 1, height: cells.height + 1, ..cells };
        let lines = Block::new().borders(Borders::LEFT | Borders::BOTTOM).border_style(rule);
        lines.render(frame, buffer);
        for (value, label) in labels_beside(up, self.up, cells.height) {
            let (y, room) = (self.row(value), label.width() as u16 + 1);
            buffer.set_string(left.saturating_sub(room), y, label, Style::new());
            buffer.set_string(left, y, "┤", rule);
        }
        let unit = unit_of(across);
        let width = unit.width().min(left.into());
        buffer.set_stringn(left - width as u16, bottom + 1, unit, width, Style::new());
        let labels = across.ticks(self.across, cells.width / LABEL_COLUMNS).into_iter();
        let labels = labels.filter_map(|(value, label)| Some((self.column(value)?, label)));
        let mut labels: Vec<(u16, String)> = labels.collect();
        labels.sort_by_key(|(column, _)| *column);
        let mut free = cells.x;
        for (column, label) in labels {
            let width = label.width() as u16;
            let last = (cells.right() + 1).saturating_sub(width);
            let start = column.saturating_sub(width / 2).min(last).max(free.min(column));
            if start >= free {
                buffer.set_string(column, bottom, "┴", rule);
                buffer.set_string(start, bottom + 1, &label, Style::new());
                free = start + width + 1;
            }
        }
    }

    /// Draws a name on the horizontal axis, at or beside its place, unless other names are there.
    pub(crate) fn draw_mark(&self, x: f64, name: &str, style: Style, buffer: &mut Buffer) {
        let Some(column) = self.column(x) else { return };
        let (width, y) = (name.width() as u16, self.cells.bottom());
        let middle = column.saturating_sub(width / 2).clamp(self.cells.x, column);
        let left = (column + 1).saturating_sub(width).max(self.cells.x);
        let is_word = |cell: &Cell| cell.symbol().starts_with(char::is_alphanumeric);
        let is_free = |x| buffer.cell((x, y)).is_none_or(|cell| !is_word(cell));
        // Between words is a gap.
        let gap = u16::from(width > 1);
        let has_room = |start: &u16| {
            let end = start + width;
            end <= self.cells.right() && (start.saturating_sub(gap)..end + gap).all(is_free)
        };
        if let Some(start) = [middle, column, left].into_iter().find(has_room) {
            buffer.set_string(start, y, name, style);
        }
    }

    /// Draws the cursor: a dotted line on blank cells, and a mark on the axis.
    pub(crate) fn draw_cursor(&self, x: f64, theme: &Theme, buffer: &mut Buffer) {
        self.draw_upright(x, "┊", theme.faint, buffer);
        if let Some(column) = self.column(x) {
            let row = self.cells.bottom();
            let is_letter = |column: u16| {
                let cell = buffer.cell((column, row));
                cell.is_some_and(|cell| !AXIS.contains(cell.symbol()))
            };
            // A word on the axis stays legible.
            let is_in_word =
                is_letter(column) && (is_letter(column + 1) || is_letter(column.saturating_sub(1)));
            if !is_in_word {
                buffer.set_string(column, row, "▴", theme.focus);
            }
        }
    }

    /// Draws the cursor of a map: its cell, and a mark on both axes.
    pub(crate) fn draw_cursor_at(&self, (x, y): Point, theme: &Theme, buffer: &mut Buffer) {
        let (Some(column), row) = (self.column(x), self.row(y)) else { return };
        buffer[(column, row)].modifier |= Modifier::REVERSED;
        buffer.set_string(column, self.cells.bottom(), "▴", theme.focus);
        buffer.set_string(self.cells.x - 1, row, "▸", theme.focus);
    }

    /// Draws the nearest value of a map in each cell, with the contours of the limit and of contact.
    fn draw_map(&self, map: &Map, theme: &Theme, buffer: &mut Buffer) {
        const BESIDE: [(i16, i16); 4] = [(-1, 0), (1, 0), (0, -1), (0, 1)];
        let found = |at: Position| map.at(self.value(at.x), self.height(at.y));
        for at in self.cells.positions() {
            let has_beside = |is: &dyn Fn(MapCell) -> bool| {
                BESIDE.into_iter().any(|(x, y)| {
                    let (x, y) = (at.x.wrapping_add_signed(x), at.y.wrapping_add_signed(y));
                    self.cells.contains(Position::new(x, y)) && is(found(Position::new(x, y)))
                })
            };
            let (sign, style) = match found(at) {
                MapCell::Blank => continue,
                MapCell::Refused => (REFUSED, theme.problem),
                MapCell::NoContact if has_beside(&MapCell::is_contact) => (EDGE, theme.note),
                MapCell::NoContact => (NO_CONTACT, theme.note),
                cell if map.is_above(cell) && has_beside(&|beside| !map.is_above(beside)) => {
                    (LIMIT, theme.problem)
                }
                MapCell::Value(value) => shade(map, value, theme),
            };
            buffer[at].set_char(sign).set_style(style);
        }
    }

    /// Draws a vertical line on blank cells.
    pub(crate) fn draw_upright(&self, x: f64, symbol: &str, style: Style, buffer: &mut Buffer) {
        if let Some(x) = self.column(x) {
            fill_blank(Rect { x, width: 1, ..self.cells }, symbol, style, buffer);
        }
    }

    /// Draws a horizontal line on blank cells.
    pub(crate) fn draw_level(&self, y: f64, symbol: &str, style: Style, buffer: &mut Buffer) {
        if (0.0..=1.0).contains(&self.up.part(y)) {
            let row = Rect { y: self.row(y), height: 1, ..self.cells };
            fill_blank(row, symbol, style, buffer);
        }
    }

    /// Draws a sign at a point.
    pub(crate) fn draw_point(&self, (x, y): Point, sign: &str, style: Style, buffer: &mut Buffer) {
        if let Some(column) = self.column(x) {
            buffer.set_string(column, self.row(y), sign, style);
        }
    }

    // The lowest row is the row of 0: a bar that rounds to 0 has no height.
    fn draw_bars(
        &self,
        series: &Series,
        (width, from): (f64, f64),
        look: Look,
        buffer: &mut Buffer,
    ) {
        let bottom = self.row(0.0);
        for (x, y) in series.pieces.iter().flatten() {
            let ends = [x + from, x + from + width].map(|x| self.column(x));
            let ([Some(left), Some(right)], top) = (ends, self.row(*y)) else { continue };
            let bar = sample(look.0).repeat(usize::from((right - left).max(1)));
            for row in (top..=bottom).filter(|_| top < bottom) {
                buffer.set_string(left, row, &bar, look.1);
            }
        }
    }

    /// Curves in cells of their own, the later ones on top; a piece with one point is a dot. Braille
    /// dots of all curves stay visible in a common cell. A sign is in the cells that a Braille curve
    /// crosses, so that a curve covers those that coincide with it.
    pub(crate) fn layer(&self, curves: &[(&[Vec<Point>], Style)], marker: Marker) -> Buffer {
        let mut layer = Buffer::empty(self.cells);
        let is_sign = matches!(marker, Marker::Custom(_));
        let canvas = Canvas::default()
            .marker(if is_sign { Marker::Braille } else { marker })
            .x_bounds(widened(self.across))
            .y_bounds(widened(self.up))
            .paint(|context| {
                for (at, (pieces, _)) in (0..).zip(curves) {
                    // The colour names the curve until its style replaces the colour.
                    let color = Color::Indexed(at);
                    for piece in *pieces {
                        if let [point] = piece[..] {
                            context.draw(&Points { coords: &[point], color });
                        }
                        for ends in piece.windows(2) {
                            let [(x1, y1), (x2, y2)] = [ends[0], ends[1]];
                            context.draw(&Line::new(x1, y1, x2, y2, color));
                        }
                    }
                }
            });
        canvas.render(self.cells, &mut layer);
        for cell in layer.content.iter_mut().filter(|cell| cell.symbol() != " ") {
            let curve = |color| if let Color::Indexed(at) = color { Some(at) } else { None };
            // A half block has two colours, for its upper and its lower half.
            match marker {
                Marker::Custom(sign) => cell.set_char(sign),
                _ if curve(cell.bg).is_some() => cell.set_char('█'),
                _ => cell,
            };
            let top = curve(cell.fg).max(curve(cell.bg)).map_or(0, usize::from);
            cell.set_style(Style::reset()).set_style(curves[top].1);
        }
        layer
    }
}

/// Draws a layer over a buffer.
pub(crate) fn put(layer: &Buffer, buffer: &mut Buffer) {
    let drawn = layer.area.positions().zip(&layer.content);
    for (position, cell) in drawn.filter(|(_, cell)| cell.symbol() != " ") {
        buffer[position] = cell.clone();
    }
}

/// The unit below the corner of the axes, without a remark.
fn unit_of(across: &Axis) -> &str {
    across.unit.split(';').next().unwrap_or_default()
}

/// The width of the labels of the vertical axis of a plot, with its line, in an area of this height.
pub(crate) fn label_margin(up: &Axis, span: Span, height: u16) -> u16 {
    let labels = labels_beside(up, span, height.saturating_sub(2)).into_iter();
    labels.map(|(_, label)| label.width() as u16).max().unwrap_or(0) + 2
}

/// As many labels beside a plot as have a row each.
fn labels_beside(up: &Axis, span: Span, height: u16) -> Labels {
    let are_apart = |labels: &Labels| {
        let rows = |pair: &[(f64, String)]| [0, 1].map(|at| row_in(height, span, pair[at].0));
        labels.windows(2).map(rows).all(|[one, other]| one != other)
    };
    let most = (height.saturating_sub(1) / LABEL_ROWS).max(1);
    let mut fewer = (1..=most).rev().map(|most| up.ticks(span, most));
    fewer.find(are_apart).unwrap_or_else(|| up.ticks(span, 1).into_iter().take(1).collect())
}

/// The row of the Braille dot of a value, from the top.
fn row_in(height: u16, up: Span, y: f64) -> u16 {
    let last = f64::from((4 * height).saturating_sub(1));
    ((1.0 - up.part(y)).clamp(0.0, 1.0) * last).round() as u16 / 4
}

fn shade(map: &Map, value: f64, theme: &Theme) -> (char, Style) {
    let at = map.level(value, SHADES.len());
    let styles = [theme.baseline, theme.driver, theme.active, theme.note, theme.problem];
    (SHADES[at], styles[at])
}

/// The legend of a map.
fn map_words(map: &Map, theme: &Theme) -> Vec<Words> {
    let ends = map.ends.iter().flatten().map(|(value, words)| {
        let (sign, style) = shade(map, *value, theme);
        (format!("{sign} {words}"), style)
    });
    let limit = map.limit.iter().map(|(_, words)| (format!("{LIMIT} {words}"), theme.problem));
    let has = |cell: MapCell| map.cells.contains(&cell);
    let signs = [
        (has(MapCell::NoContact), EDGE, "edge of contact", theme.note),
        (has(MapCell::NoContact), NO_CONTACT, "no contact", theme.note),
        (has(MapCell::Refused), REFUSED, "refused", theme.problem),
    ];
    let signs = signs.into_iter().filter(|(is_present, ..)| *is_present);
    let signs = signs.map(|(_, sign, name, style)| (format!("{sign} {name}"), style));
    ends.chain(limit).chain(signs).collect()
}

/// Draws words beside each other in as many rows as they need. Returns the number of rows.
pub(crate) fn draw_legend(words: &[Words], area: Rect, buffer: &mut Buffer) -> u16 {
    let start = area.x + 1;
    let (mut x, mut y) = (start, area.y);
    for (words, style) in words {
        let words = text::cut(words, area.width.saturating_sub(2).into());
        let width = words.width() as u16;
        if x > start && x + width >= area.right() {
            (x, y) = (start, y + 1);
        }
        if y >= area.bottom() {
            return area.height;
        }
        buffer.set_string(x, y, &words, *style);
        x += width + 2;
    }
    if words.is_empty() { 0 } else { y + 1 - area.y }
}

/// The sign of a marker in the legend.
pub(crate) fn sample(marker: Marker) -> String {
    match marker {
        Marker::Custom(sign) => sign,
        Marker::Dot => '•',
        Marker::HalfBlock => '▀',
        _ => '⠒',
    }
    .to_string()
}

/// Valid bounds of a canvas: finite, in order, never equal.
pub(in crate::tui) fn bounds(from: f64, to: f64) -> [f64; 2] {
    let sound = |value: f64| {
        if value.is_finite() { value.clamp(-1e100, 1e100) } else { 0.0 }
    };
    let (from, to) = (sound(from).min(sound(to)), sound(from).max(sound(to)));
    let pad = if from < to { 0.0 } else { 1f64.max(from.abs()) };
    [from - pad, to + pad]
}

// The bounds include points that are on an end within rounding.
fn widened(span: Span) -> [f64; 2] {
    let rounding = 1e-8 * span.length();
    bounds(span.from - rounding, span.to + rounding)
}

fn fill_blank(area: Rect, symbol: &str, style: Style, buffer: &mut Buffer) {
    for position in area.positions() {
        if let Some(cell) = buffer.cell_mut(position).filter(|cell| cell.symbol() == " ") {
            cell.set_symbol(symbol).set_style(style);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bounds_are_always_valid() {
        let hostile =
            [f64::NAN, f64::INFINITY, f64::NEG_INFINITY, f64::MAX, f64::MIN, 0.0, -1.0, 5e-324];
        for from in hostile {
            for to in hostile {
                let [low, high] = bounds(from, to);
                assert!(low < high && (high - low).is_finite(), "{from} {to}");
            }
        }
    }
}
