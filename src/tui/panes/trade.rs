//! Accuracy of every setting against its run time, as a chart or as a table of methods and
//! compliances.

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Rect};
use ratatui::style::Style;
use ratatui::text::Line;
use ratatui::widgets::{Row, Table, Widget};

use super::Title;
use super::plot::{Plot, Words, draw_legend, label_margin};
use crate::model::Inputs;
use crate::model::impact::StiffnessModels;
use crate::model::inputs::Method;
use crate::report::chart::Axis;
use crate::report::trade::{
    Cell, NO_CONTACT, build, compliance_name, compliances, parts, percent, plotted_error,
    power_of_time, summary,
};
use crate::study::trade::{METHODS, MeasuredSetting, Setting, Trade};
use crate::tui::jobs::{TradeView, Traded};
use crate::tui::text;
use crate::tui::theme::Look;

/// Least height with two lines of text.
const TALL: u16 = 8;
const INVITATION: &str = "runs every method with its settings on this case for a few seconds. Esc stops the \
    benchmark and keeps its results. Enter then applies the selected setting to the case.";

/// The line of the accepted error.
const LEVEL: &str = "╌";

/// Width of a compliance with its mark.
const COMPLIANCE_NAME: u16 = 23;
/// Width of a cell with time and difference, and with only the difference.
const CELL: [u16; 2] = [14, 8];

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
    let inner = pane.title.draw(&title(pane), pane.area, buffer);
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
    let words = inner.height.min(if inner.height > TALL { 2 } else { 1 });
    let (above, below) = (inner.height - words, Rect { height: words, ..inner });
    let area = Rect { height: above, ..inner };
    match pane.view {
        TradeView::Table => draw_table(pane, traded, trade, area, buffer),
        TradeView::Chart => draw_chart(pane, traded, trade, area, buffer),
    }
    let (below, width) = (Rect { y: area.bottom(), ..below }, usize::from(inner.width));
    let lines = text::fitted(&about(pane, traded, trade), width.saturating_sub(2), words.into());
    for (line, row) in lines.iter().zip(below.rows()) {
        buffer.set_stringn(row.x + 1, row.y, line, width - 1, Style::new());
    }
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

fn title(pane: &TradePane<'_>) -> String {
    let is_stale = |traded: &Traded| pane.inputs.is_none_or(|inputs| traded.is_stale(inputs));
    let words = match pane.view {
        TradeView::Chart => "Accuracy against run time, both logarithmic",
        TradeView::Table => "Run time and difference from the reference in %",
    };
    if pane.traded.is_some_and(is_stale) {
        format!("OUTDATED, {} runs it again: {words}", pane.title.key_to("m"))
    } else {
        words.to_owned()
    }
}

/// The text about the selected setting, the most important part first; without a selection the
/// progress of the benchmark.
fn about(pane: &TradePane<'_>, traded: &Traded, trade: &Trade) -> String {
    let selected = traded
        .marked
        .and_then(|marked| trade.settings.iter().find(|measured| measured.setting == marked));
    let without_contact = trade.is_without_contact().then(|| NO_CONTACT.to_owned());
    let refused = trade.settings.iter().filter(|measured| measured.found.is_err()).count();
    let refused = (refused > 0).then(|| format!("{refused} settings refuse the case"));
    let words = match selected {
        None => {
            let (measured, planned) = (trade.settings.len(), trade.planned);
            vec![
                without_contact,
                Some(format!("{measured} of {planned} settings measured")),
                refused,
            ]
        }
        Some(measured) => {
            let qualifies = if measured.qualifies { "within" } else { "not within" };
            let own = own(pane) == Some(measured.setting);
            let front = "no other setting is both faster and more accurate".to_owned();
            vec![
                Some(format!("[{}] {qualifies} {} %", summary(measured), percent(trade.within))),
                without_contact,
                own.then(|| "setting of the case".to_owned()),
                parts(trade, measured),
                measured.is_on_front.then_some(front),
                refused,
            ]
        }
    };
    words.into_iter().flatten().collect::<Vec<_>>().join("; ")
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

/// Draws the legend, the meaning of the letters, and the settings below it.
fn draw_chart(
    pane: &TradePane<'_>,
    traded: &Traded,
    trade: &Trade,
    area: Rect,
    buffer: &mut Buffer,
) {
    let theme = pane.look.theme;
    let methods = METHODS.into_iter().chain([Method::Auto]);
    let methods = methods.map(|method| (method.name().to_owned(), mark_of(pane, method).1));
    let words: Vec<Words> = methods.collect();
    let legend = Rect { height: u16::from(area.height >= TALL - 2), ..area };
    draw_legend(&words, legend, buffer);
    let area = Rect { y: area.y + legend.height, height: area.height - legend.height, ..area };
    let mut found = ordered(trade);
    let across = found.iter().map(|measured| measured.seconds().log10());
    let across = Axis::logarithmic("", across, power_of_time);
    let errors = found.iter().filter_map(|measured| measured.total());
    let errors = errors.chain([trade.within]).map(|error| plotted_error(error).log10());
    let up = Axis::logarithmic("", errors, in_percent);
    let spans = (across.span(), up.span());
    let plot = Plot::new(area, label_margin(&up, spans.1, area.height), spans);
    if plot.cells.is_empty() {
        return;
    }
    plot.draw_axes(&across, &up, theme, buffer);
    let level = level(&plot, trade, &found);
    let label =
        format!("{:>1$} ┤", percent(trade.within) + " %", usize::from(plot.cells.x - area.x) - 2);
    buffer.set_string(area.x, level, label, Style::new());
    buffer.set_string(plot.cells.x, level, LEVEL.repeat(plot.cells.width.into()), theme.rule);
    // Greater errors are above the accepted one and smaller ones below.
    let place = |measured: &MeasuredSetting| {
        let error = measured.total()?;
        let row = plot.row(plotted_error(error).log10());
        let row = if error > trade.within {
            row.min(level.saturating_sub(1))
        } else {
            row.max(level + 1)
        };
        let row = row.clamp(plot.cells.top(), plot.cells.bottom() - 1);
        Some((plot.column(measured.seconds().log10())?, row))
    };
    let front = found.iter().filter(|measured| measured.is_on_front);
    draw_front(pane, &front.filter_map(|one| place(one)).collect::<Vec<_>>(), plot.cells, buffer);
    // The selected setting and the setting of the case are drawn on top.
    let own = own(pane);
    let weight = |measured: &MeasuredSetting| {
        let setting = Some(measured.setting);
        (traded.marked == setting, own == setting, measured.is_on_front)
    };
    found.sort_by_key(|measured| weight(measured));
    for measured in found {
        if let Some((x, y)) = place(measured) {
            let (is_marked, is_own, is_on_front) = weight(measured);
            let (letter, style) = mark_of(pane, measured.setting.method);
            let letter = if is_on_front { letter.to_ascii_uppercase() } else { letter };
            let (mark, style) = match (is_marked, is_own) {
                (true, _) => (format!("[{letter}]"), theme.key),
                (false, true) => (format!("({letter})"), theme.focus),
                (false, false) => (letter.to_string(), style),
            };
            let width = mark.len() as u16;
            let x = (x - width / 2).clamp(plot.cells.left(), plot.cells.right() - width);
            buffer.set_string(x, y, mark, style);
        }
    }
}

/// The row of the accepted error, with room for greater errors above it and smaller ones below.
fn level(plot: &Plot, trade: &Trade, found: &[&MeasuredSetting]) -> u16 {
    let has = |is_above: bool| {
        let mut errors = found.iter().filter_map(|measured| measured.total());
        u16::from(errors.any(|error| (error > trade.within) == is_above))
    };
    let (first, last) = (plot.cells.top() + has(true), plot.cells.bottom() - 1 - has(false));
    plot.row(plotted_error(trade.within).log10()).clamp(first, last.max(first))
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

/// An error as a power of ten in percent.
fn in_percent(error: f64) -> String {
    match error.log10().round() as i32 + 2 {
        exponent @ -3..=5 => format!("{} %", 10f64.powi(exponent)),
        exponent => format!("1e{exponent} %"),
    }
}

/// Draws the table of methods and compliances, with the time to build the fields below it.
fn draw_table(
    pane: &TradePane<'_>,
    traded: &Traded,
    trade: &Trade,
    area: Rect,
    buffer: &mut Buffer,
) {
    let theme = pane.look.theme;
    let is_wide = COMPLIANCE_NAME + CELL[0] * METHODS.len() as u16 <= area.width;
    let own = own(pane).and_then(|own| own.models);
    let rows = compliances(trade);
    let row = |(models, cells): &(StiffnessModels, [Option<Cell>; METHODS.len()])| {
        let mark = if own == Some(*models) { '*' } else { ' ' };
        let name = Line::raw(format!("{mark}{}", compliance_name(*models)));
        let cells = cells.iter().map(|cell| {
            let Some(cell) = cell else { return Line::default() };
            let text = if is_wide { cell.to_string() } else { cell.total.clone() };
            if traded.marked == Some(cell.setting) {
                Line::styled(format!("▸{text}"), theme.key).right_aligned()
            } else {
                Line::raw(text).right_aligned()
            }
        });
        Row::new(std::iter::once(name).chain(cells))
    };
    let names = METHODS.map(|method| Line::styled(method.name(), theme.title).right_aligned());
    let widths = [[COMPLIANCE_NAME].as_slice(), &[CELL[usize::from(!is_wide)]; METHODS.len()]];
    Table::new(rows.iter().map(row), widths.concat().into_iter().map(Constraint::Length))
        .header(Row::new(std::iter::once(Line::default()).chain(names)))
        .column_spacing(0)
        .render(area, buffer);
    let below = (rows.len() as u16 + 2).min(area.height);
    let below = Rect { y: area.y + below, height: area.height - below, ..area };
    text::draw_words(&build(trade), below, buffer);
}

#[cfg(test)]
mod tests {
    use super::in_percent;

    #[test]
    fn powers_of_ten_in_percent_are_short() {
        let phrases = [1e-16, 1e-5, 1e-2, 1.0, 1e3].map(in_percent);
        assert_eq!(phrases, ["1e-14 %", "0.001 %", "1 %", "100 %", "100000 %"]);
    }
}
