//! Accuracy of every setting against its run time, as a chart or as a table of methods and
//! compliances.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::style::Style;

use super::Title;
use crate::model::Inputs;
use crate::model::impact::StiffnessModels;
use crate::model::inputs::Method;
use crate::report::svg::{Axis, Scale};
use crate::report::trade::{
    Cell, NO_CONTACT, build, compliance_name, compliances, parts, percent, plotted_error,
    power_of_time, summary,
};
use crate::study::trade::{METHODS, MeasuredSetting, Setting, Trade};
use crate::tui::jobs::{TradeView, Traded};
use crate::tui::text;
use crate::tui::theme::{Look, Theme};

/// Least height with a row for the legend.
const TALL: u16 = 8;
const INVITATION: &str = "runs every method with its settings on this case for a few seconds. Esc stops the \
    benchmark and keeps its results. Enter then applies the selected setting to the case.";

/// Width of a number beside the vertical axis.
const LABEL: u16 = 9;

/// The line of the accepted error.
const LEVEL: &str = "╌";

/// Width of a compliance with its mark.
const COMPLIANCE_NAME: usize = 23;
/// Width of a cell with time and difference.
const WIDE_CELL: usize = 14;
/// Width of a cell with only the difference.
const NARROW_CELL: usize = 8;

/// The pane with the benchmark that it shows.
#[derive(Debug, Clone)]
pub(crate) struct TradePane<'a> {
    /// The benchmark of the open case.
    pub(crate) traded: Option<&'a Traded>,
    /// The case in the form, if it is valid.
    pub(crate) inputs: Option<&'a Inputs>,
    /// Chart or table.
    pub(crate) view: TradeView,
    /// The capabilities of the terminal.
    pub(crate) look: Look,
    /// The title line.
    pub(crate) title: Title,
    /// The area of the pane with its title; empty if the pane is hidden.
    pub(crate) area: Rect,
}

pub(crate) fn draw(pane: &TradePane<'_>, buffer: &mut Buffer) {
    let title = title(pane, pane.title.room(pane.area.width));
    let inner = pane.title.draw(&title, pane.area, buffer);
    if inner.is_empty() {
        return;
    }
    let traded = pane.traded.and_then(|traded| Some((traded, traded.trade.as_ref()?)));
    let Some((traded, trade)) = traded.filter(|(_, trade)| !trade.settings.is_empty()) else {
        let words = if pane.traded.is_some() {
            "Computing the reference.".to_owned()
        } else {
            format!("No benchmark yet: {} {INVITATION}", pane.title.key_to("m"))
        };
        return text::draw_words(&words, inner, buffer);
    };
    if pane.view == TradeView::Table {
        return draw_table(pane, traded, trade, inner, buffer);
    }
    let (legend, plot, words) = split(inner);
    draw_legend(pane, trade, legend, buffer);
    if plot.height >= 3 && plot.width >= 20 {
        draw_plot(pane, traded, trade, plot, buffer);
    }
    text::draw_words(&fitting(&phrases(pane, traded, trade), words), words, buffer);
}

/// The meaning of the signs in the pane.
#[must_use]
pub(crate) fn signs(pane: &TradePane<'_>) -> String {
    let within =
        pane.traded.and_then(|traded| traded.trade.as_ref()).map(|trade| percent(trade.within));
    if pane.view == TradeView::Table {
        return "Time of a solve with 64 stations and tolerance 1e-6, and its greatest difference from the reference \
            in %; * compliance of the case, ▸ selected."
            .to_owned();
    }
    let level = within.map_or_else(String::new, |within| format!("; {LEVEL} tolerance {within} %"));
    format!(
        "p paper, e exact, s static, d dynamic, a auto. Capitals and ·: no other setting is both \
            faster and more accurate. (x): setting of the case. [x]: selected setting{level}."
    )
}

/// The visible setting nearest to the selected one: that setting itself, otherwise one of its
/// method, preferably with its compliance.
#[must_use]
pub(crate) fn nearest(traded: &Traded, view: TradeView) -> Option<Setting> {
    let (marked, trade) = (traded.marked?, traded.trade.as_ref()?);
    let distance = |setting: &Setting| {
        (*setting != marked, setting.method != marked.method, setting.models != marked.models)
    };
    visible(trade, view).into_iter().min_by_key(distance)
}

/// The setting `by` places from the selected one, in the order of the view.
#[must_use]
pub(crate) fn stepped(traded: &Traded, view: TradeView, by: isize) -> Option<Setting> {
    let settings: Vec<Setting> =
        traded.trade.iter().flat_map(|trade| visible(trade, view)).collect();
    let last = settings.len().checked_sub(1)?;
    let now =
        traded.marked.and_then(|marked| settings.iter().position(|setting| *setting == marked));
    let next = now.map_or(0, |now| now.saturating_add_signed(by).min(last));
    Some(settings[next])
}

/// Draws the table of methods and compliances, with a text about the selected setting below it.
fn draw_table(
    pane: &TradePane<'_>,
    traded: &Traded,
    trade: &Trade,
    inner: Rect,
    buffer: &mut Buffer,
) {
    let marks = Marks { selected: traded.marked, own: own(pane).and_then(|own| own.models) };
    let words = inner.height.min(if inner.height > TALL { 2 } else { 1 });
    let table = Rect { height: inner.height - words, ..inner };
    let rows = draw_compliances(trade, &marks, pane.look.theme, table, buffer);
    let rest = Rect { y: table.y + rows, height: table.height - rows, ..inner };
    if rest.height > 1 {
        let below = Rect { y: rest.y + 1, height: rest.height - 1, ..rest };
        text::draw_words(&build(trade), below, buffer);
    }
    let words = Rect { y: inner.bottom() - words, height: words, ..inner };
    text::draw_words(&fitting(&phrases(pane, traded, trade), words), words, buffer);
}

/// The longest title that fits, otherwise the shortest one.
fn title(pane: &TradePane<'_>, room: usize) -> String {
    let is_stale = |traded: &Traded| pane.inputs.is_none_or(|inputs| traded.is_stale(inputs));
    let titles = match pane.view {
        TradeView::Chart => {
            ["Accuracy against run time, both logarithmic", "Accuracy against run time", "Accuracy"]
        }
        TradeView::Table => [
            "Run time and difference from the reference in %",
            "Run time and difference in %",
            "Methods",
        ],
    };
    let outdated = if pane.traded.is_some_and(is_stale) {
        let key = pane.title.key_to("m");
        [format!("OUTDATED, {key} runs it again: "), format!("OUTDATED ({key}): ")]
    } else {
        [String::new(), String::new()]
    };
    let starts = [&outdated[0], &outdated[1], &outdated[1]];
    let titles = starts.into_iter().zip(titles).map(|(start, title)| format!("{start}{title}"));
    let mut titles: Vec<_> = titles.collect();
    let at = titles.iter().position(|title| title.len() <= room);
    titles.swap_remove(at.unwrap_or(2))
}

/// The areas of the legend, of the plot with its axes, and of the text below it.
fn split(inner: Rect) -> (Rect, Rect, Rect) {
    let legend = u16::from(inner.height >= TALL);
    let words = inner.height.min(if inner.height > TALL { 2 } else { 1 });
    let plot = Rect { y: inner.y + legend, height: inner.height - legend - words, ..inner };
    (Rect { height: legend, ..inner }, plot, Rect { y: plot.bottom(), height: words, ..inner })
}

/// The text about the selected setting, the most important part first; without a selection the
/// progress of the benchmark.
fn phrases(pane: &TradePane<'_>, traded: &Traded, trade: &Trade) -> Vec<String> {
    let marked = traded
        .marked
        .and_then(|marked| trade.settings.iter().find(|measured| measured.setting == marked));
    let refused = trade.settings.iter().filter(|measured| measured.found.is_err()).count();
    let refused = (refused > 0).then(|| format!("; {refused} settings refuse the case"));
    let without_contact = trade.is_without_contact().then(|| NO_CONTACT.to_owned());
    let Some(measured) = marked else {
        let (measured, planned) = (trade.settings.len(), trade.planned);
        let far = format!("{measured} of {planned} settings measured");
        let far = match &without_contact {
            Some(_) => format!("; {far}"),
            None => far,
        };
        return without_contact.into_iter().chain([far]).chain(refused).collect();
    };
    let qualifies = if measured.qualifies { "within" } else { "not within" };
    let qualifies = format!(" {qualifies} {} %", percent(trade.within));
    let own = (own(pane) == Some(measured.setting)).then(|| "; setting of the case".to_owned());
    let front = measured
        .is_on_front
        .then(|| "; no other setting is both faster and more accurate".to_owned());
    let parts = parts(trade, measured).map(|parts| format!("; {parts}"));
    let without_contact = without_contact.map(|words| format!("; {words}"));
    let first = format!("[{}]", summary(measured));
    [Some(first), Some(qualifies), without_contact, own, parts, front, refused]
        .into_iter()
        .flatten()
        .collect()
}

/// As many phrases as fit into the lines without a cut.
fn fitting(phrases: &[String], area: Rect) -> String {
    let width = usize::from(area.width).saturating_sub(2);
    let fits = |words: &String| text::wrap(words, width).len() <= area.height.into();
    let joined = |count: usize| phrases[..count].concat();
    let all = (1..=phrases.len()).rev().map(joined);
    // A long text is shortened to the method and its results.
    let brief = phrases.first().and_then(|first| {
        let (method, _) = first.split_once(" with ")?;
        let (_, found) = first.rsplit_once(", ")?;
        Some(format!("{method}, {found}"))
    });
    let fitting = all.chain(brief).find(fits);
    fitting.unwrap_or_else(|| text::cut(&joined(phrases.len().min(1)), width))
}

/// The settings that have an error and a time, the faster ones first.
#[must_use]
fn ordered(trade: &Trade) -> Vec<&MeasuredSetting> {
    let mut found: Vec<&MeasuredSetting> =
        trade.settings.iter().filter(|measured| measured.total().is_some()).collect();
    found.sort_by(|one, other| one.seconds().total_cmp(&other.seconds()));
    found
}

/// The visible settings in the order of the arrow keys: by their times in the chart, row by row in
/// the table.
fn visible(trade: &Trade, view: TradeView) -> Vec<Setting> {
    match view {
        TradeView::Chart => ordered(trade).into_iter().map(|measured| measured.setting).collect(),
        TradeView::Table => {
            let rows = compliances(trade).into_iter();
            let cells = rows.flat_map(|(_, cells)| cells);
            cells.flatten().map(|cell| cell.setting).collect()
        }
    }
}

fn own(pane: &TradePane<'_>) -> Option<Setting> {
    pane.inputs.map(Setting::of)
}

/// The letter of a method, with its colour.
fn mark_of(pane: &TradePane<'_>, method: Method) -> (char, Style) {
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
fn draw_legend(pane: &TradePane<'_>, trade: &Trade, area: Rect, buffer: &mut Buffer) {
    let methods = METHODS.into_iter().chain([Method::Auto]);
    let words = methods.map(|method| (method.name().to_owned(), mark_of(pane, method).1));
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

fn draw_plot(
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
    let errors: Vec<f64> = found.iter().filter_map(|measured| measured.total()).collect();
    let axis = |values: Vec<f64>, start: u16, end: u16| {
        let (start, end) = (f64::from(start), f64::from(end));
        Axis::of(Scale::Logarithmic, values.into_iter(), start, end, false)
    };
    let times = found.iter().map(|measured| measured.seconds()).collect();
    let across = axis(times, field.left(), field.right() - 1);
    let shown = errors.iter().chain([&trade.within]).map(|error| plotted_error(*error)).collect();
    let up = axis(shown, field.bottom() - 1, field.top());
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
        let level = (up.at(plotted_error(within)).round() as u16).max(first).min(last.max(first));
        Rows { up, within, level, field }
    }

    fn at(&self, error: f64) -> u16 {
        let row = self.up.at(plotted_error(error)).round() as u16;
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
    let (letter, style) = mark_of(pane, measured.setting.method);
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
    for error in rows.up.ticks(usize::from(field.height / 2)) {
        label(rows.at(error), &in_percent(error));
    }
    label(rows.level, &percent(rows.within));
    for seconds in across.ticks(usize::from(field.width / 9)) {
        let x = across.at(seconds).round() as u16;
        let label = power_of_time(seconds);
        let width = label.len() as u16;
        let start = x
            .saturating_sub(width / 2)
            .clamp(field.x, field.right().saturating_sub(width).max(field.x));
        buffer.set_string(x, axis, "┴", rule);
        buffer.set_stringn(start, axis + 1, label, usize::from(field.width), Style::new());
    }
}

/// A power of ten in percent, at most seven characters wide.
fn in_percent(error: f64) -> String {
    match error.log10().round() as i32 + 2 {
        exponent @ -3..=5 => format!("{}", 10f64.powi(exponent)),
        exponent => format!("1e{exponent}"),
    }
}

/// The marked settings of the table.
#[derive(Debug, Clone, Copy)]
struct Marks {
    /// The selected setting.
    selected: Option<Setting>,
    /// The compliance of the case.
    own: Option<StiffnessModels>,
}

/// Draws the table and returns the number of rows that it uses.
fn draw_compliances(
    trade: &Trade,
    marks: &Marks,
    theme: &Theme,
    area: Rect,
    buffer: &mut Buffer,
) -> u16 {
    let width = usize::from(area.width);
    let is_wide = COMPLIANCE_NAME + WIDE_CELL * METHODS.len() <= width;
    let cell_width = if is_wide { WIDE_CELL } else { NARROW_CELL };
    let mut put = |row: u16, column: usize, text: &str, style: Style| {
        if row < area.height && column < width {
            let x = area.x + column as u16;
            buffer.set_stringn(x, area.y + row, text, width - column, style);
        }
    };
    for (at, method) in METHODS.into_iter().enumerate() {
        let name = format!("{:>cell_width$}", method.name());
        put(0, COMPLIANCE_NAME + at * cell_width, &name, theme.title);
    }
    let rows = compliances(trade);
    for (row, (models, cells)) in (1..).zip(&rows) {
        let mark = if marks.own == Some(*models) { '*' } else { ' ' };
        let name = format!("{mark}{}", compliance_name(*models));
        put(row, 0, &name, Style::new());
        for (at, cell) in cells.iter().enumerate() {
            let Some(cell) = cell else { continue };
            let is_selected = marks.selected == Some(cell.setting);
            let (text, style) = (cell_text(cell, is_wide, is_selected), theme);
            let style = if is_selected { style.key } else { Style::new() };
            put(row, COMPLIANCE_NAME + at * cell_width, &format!("{text:>cell_width$}"), style);
        }
    }
    (rows.len() as u16 + 1).min(area.height)
}

fn cell_text(cell: &Cell, is_wide: bool, is_selected: bool) -> String {
    let text = if is_wide { cell.to_string() } else { cell.total.clone() };
    if is_selected { format!("▸{text}") } else { text }
}

#[cfg(test)]
mod tests {
    use super::in_percent;

    #[test]
    fn powers_of_ten_in_percent_are_short() {
        let phrases = [1e-16, 1e-5, 1e-2, 1.0, 1e3].map(in_percent);
        assert_eq!(phrases, ["1e-14", "0.001", "1", "100", "100000"]);
    }
}
