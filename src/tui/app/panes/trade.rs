//! Accuracy of every setting against its run time, as a chart or as a table of methods and
//! compliances.

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Rect};
use ratatui::style::Style;
use ratatui::symbols::Marker;

use super::plot::TerminalChart;
use crate::model::Inputs;
use crate::model::inputs::Method;
use crate::report::chart::{Axis, Chart, Kind, Point, Series};
use crate::report::trade::{
    Cell, NO_CONTACT, build, compliance_table, compliances, parts, percent, plotted_error,
    power_of_time, summary,
};
use crate::study::trade::{MeasuredSetting, Setting, Trade};
use crate::tui::app::App;
use crate::tui::layout::Pane;
use crate::tui::text;

/// Least height with two lines of text.
const TALL: u16 = 8;
const INVITATION: &str = "runs every method with its settings on this case for a few seconds. Esc stops the \
    benchmark and keeps its results. Enter then applies the selected setting to the case.";

/// The benchmark of a case, with error and time of every setting.
#[derive(Debug, Clone)]
pub struct Traded {
    /// The number of its work.
    pub(crate) work: u64,
    /// The pair at the time of the request.
    pub(crate) inputs: Inputs,
    /// The results so far.
    pub trade: Option<Trade>,
    /// The selected setting.
    pub marked: Option<Setting>,
}

impl Traded {
    /// Whether the case has changed since the benchmark, apart from its setting.
    pub(crate) fn is_stale(&self, inputs: &Inputs) -> bool {
        let then = &self.inputs;
        let alike = |inputs: &Inputs| Inputs {
            tooth_compliance: then.tooth_compliance,
            contact_compliance: then.contact_compliance,
            tolerance: then.tolerance,
            within: then.within,
            station_tolerance: then.station_tolerance,
            ..Setting::of(then).inputs(inputs)
        };
        alike(inputs) != alike(then)
    }
}

pub(crate) fn draw(app: &App, buffer: &mut Buffer) {
    let inner = app.draw_title(Pane::Trade, &title(app), buffer);
    let traded = app.tab.traded.as_ref().and_then(|traded| Some((traded, traded.trade.as_ref()?)));
    let Some((traded, trade)) = traded.filter(|(_, trade)| !trade.settings.is_empty()) else {
        let words = match app.tab.traded {
            Some(_) => "Computing the reference.".to_owned(),
            None => format!("No benchmark yet: {} {INVITATION}", app.key_to(Pane::Trade, "m")),
        };
        return text::draw_words(&words, inner, buffer);
    };
    let lines = if inner.height > TALL { 2 } else { 1 };
    let [above, below] =
        Layout::vertical([Constraint::Fill(1), Constraint::Length(lines)]).areas(inner);
    let draw = if app.is_trade_table { draw_table } else { draw_chart };
    draw(app, traded, trade, above, buffer);
    let width = usize::from(below.width).saturating_sub(2);
    let about = text::fitted(&about(app, traded, trade), width, lines.into()).join(" ");
    text::draw_words(&about, below, buffer);
}

/// The meaning of the signs in the pane.
pub(crate) fn signs(app: &App) -> &'static str {
    if app.is_trade_table {
        "Time of a solve with 64 stations, and its greatest difference from the reference in %; \
            * compliance of the case, ▸ selected."
    } else {
        "Each letter is a setting of a method; on the dotted line, no other setting is both faster \
            and more accurate."
    }
}

/// The visible setting nearest to the selected one: that setting itself, otherwise one of its
/// method, preferably with its compliance.
pub(crate) fn nearest(traded: &Traded, is_table: bool) -> Option<Setting> {
    let (marked, trade) = (traded.marked?, traded.trade.as_ref()?);
    let distance = |setting: &Setting| {
        (*setting != marked, setting.method != marked.method, setting.models != marked.models)
    };
    visible(trade, is_table).into_iter().min_by_key(distance)
}

/// The setting `by` places from the selected one, in the order of the view.
pub(crate) fn stepped(traded: &Traded, is_table: bool, by: isize) -> Option<Setting> {
    let settings: Vec<Setting> =
        traded.trade.iter().flat_map(|trade| visible(trade, is_table)).collect();
    let last = settings.len().checked_sub(1)?;
    let now =
        traded.marked.and_then(|marked| settings.iter().position(|setting| *setting == marked));
    let next = now.map_or(0, |now| now.saturating_add_signed(by).min(last));
    Some(settings[next])
}

fn title(app: &App) -> String {
    let is_stale = |traded: &Traded| app.tab.inputs().is_none_or(|inputs| traded.is_stale(inputs));
    let words = if app.is_trade_table {
        "Run time and difference from the reference in %"
    } else {
        "Accuracy against run time, both logarithmic"
    };
    if app.tab.traded.as_ref().is_some_and(is_stale) {
        format!("OUTDATED, {} runs it again: {words}", app.key_to(Pane::Trade, "m"))
    } else {
        words.to_owned()
    }
}

/// The text about the selected setting, the most important part first; without a selection the
/// progress of the benchmark.
fn about(app: &App, traded: &Traded, trade: &Trade) -> String {
    let is_selected = |measured: &&MeasuredSetting| traded.marked == Some(measured.setting);
    let selected = trade.settings.iter().find(is_selected);
    let first = match selected {
        None => format!("{} of {} settings measured", trade.settings.len(), trade.planned),
        Some(measured) => {
            let qualifies = if trade.qualifies(measured) { "within" } else { "not within" };
            format!("[{}] {qualifies} {} %", summary(measured), percent(trade.within))
        }
    };
    let refused = trade.settings.iter().filter(|measured| measured.found.is_err()).count();
    let said = |holds: bool, words: &str| holds.then(|| words.to_owned());
    let is_own = selected.is_some_and(|measured| own(app) == Some(measured.setting));
    let is_best = selected.is_some_and(|measured| trade.is_on_front(measured));
    let words = [
        Some(first),
        said(trade.is_without_contact(), NO_CONTACT),
        said(is_own, "setting of the case"),
        selected.and_then(|measured| parts(trade, measured)),
        said(is_best, "no other setting is both faster and more accurate"),
        said(
            refused > 0,
            &format!(
                "{refused} {} the case",
                if refused == 1 { "setting refuses" } else { "settings refuse" }
            ),
        ),
    ];
    words.into_iter().flatten().collect::<Vec<_>>().join("; ")
}

/// The settings that have an error and a time, the faster ones first.
fn ordered(trade: &Trade) -> Vec<&MeasuredSetting> {
    let mut found: Vec<&MeasuredSetting> =
        trade.settings.iter().filter(|measured| measured.total().is_some()).collect();
    found.sort_by(|one, other| one.seconds().total_cmp(&other.seconds()));
    found
}

/// The visible settings in the order of the arrow keys: by their times in the chart, row by row in
/// the table.
fn visible(trade: &Trade, is_table: bool) -> Vec<Setting> {
    if is_table {
        let cells = compliances(trade).into_iter().flat_map(|(_, cells)| cells);
        return cells.flatten().map(|cell| cell.setting).collect();
    }
    ordered(trade).into_iter().map(|measured| measured.setting).collect()
}

fn own(app: &App) -> Option<Setting> {
    app.tab.inputs().map(Setting::of)
}

/// Draws the settings over the line of the tolerance, and the steps of the least error for each
/// time, below which is no setting.
fn draw_chart(app: &App, traded: &Traded, trade: &Trade, area: Rect, buffer: &mut Buffer) {
    let (theme, within, found) = (app.look.theme, trade.within, ordered(trade));
    let across = found.iter().map(|measured| measured.seconds().log10());
    let across = Axis::logarithmic("", across, power_of_time);
    let errors = found.iter().filter_map(|measured| measured.total());
    // There is room on both sides of the tolerance.
    let errors = errors.chain([10.0 * within, within / 10.0]);
    let up = Axis::logarithmic("", errors.map(|error| plotted_error(error).log10()), in_percent);
    let (level, spans) = (plotted_error(within).log10(), (across.span(), up.span()));
    // A little more than a row.
    let row = 1.25 * spans.1.length() / f64::from(area.height.saturating_sub(4).max(1));
    let points = |is_drawn: &dyn Fn(&MeasuredSetting) -> bool| -> Vec<Point> {
        let drawn = found.iter().filter(|measured| is_drawn(measured));
        let point = |measured: &&MeasuredSetting| {
            let (error, time) = (measured.total()?, measured.seconds().log10());
            let place = plotted_error(error).log10();
            // A point is not on the line of the tolerance.
            let is_above = error > within;
            Some((time, if is_above { place.max(level + row) } else { place.min(level - row) }))
        };
        drawn.filter_map(point).collect()
    };
    let mut steps: Vec<Point> = Vec::new();
    for (x, y) in
        points(&|measured| trade.is_on_front(measured)).into_iter().chain([(spans.0.to, 0.0)])
    {
        steps.extend(steps.last().map(|last| (x, last.1)));
        steps.push((x, y));
    }
    steps.pop();
    let marks = |name: &str, points, look: (char, Style)| {
        let series =
            Series { name: name.to_owned(), pieces: vec![points], kind: Kind::Marks(None) };
        (series, (Marker::Custom(look.0), look.1))
    };
    let of_setting = |setting| points(&move |measured| Some(measured.setting) == setting);
    let selected = marks("selected", of_setting(traded.marked), ('◆', theme.key));
    let own = marks("case", of_setting(own(app)), ('◇', theme.focus));
    let methods = [
        (Method::Paper, 'p', theme.faint),
        (Method::Exact, 'e', theme.other),
        (Method::Static, 's', theme.path),
        (Method::Dynamic, 'd', theme.active),
        (Method::Auto, 'a', theme.note),
    ];
    let methods = methods.map(|(method, letter, style)| {
        let points = points(&|measured| measured.setting.method == method);
        marks(method.name(), points, (letter, style))
    });
    let mut best = marks("best", steps, ('·', theme.note));
    best.0.kind = Kind::Curve;
    let (series, looks) = [selected, own].into_iter().chain(methods).chain([best]).unzip();
    let chart = Chart { across, up, series, ..Chart::default() };
    let words = vec![(format!("╌ tolerance {} %", percent(within)), theme.rule)];
    let drawn = TerminalChart { chart: &chart, looks, words, is_compared: false, theme };
    let plot = drawn.draw(area, spans, 0, buffer);
    plot.draw_level(level, "╌", theme.rule, buffer);
}

/// An error as a power of ten in percent.
fn in_percent(error: f64) -> String {
    match error.log10().round() as i32 + 2 {
        exponent @ -3..=5 => format!("{} %", 10f64.powi(exponent)),
        exponent => format!("1e{exponent} %"),
    }
}

/// Draws the table of methods and compliances, with the time to build the fields below it.
fn draw_table(app: &App, traded: &Traded, trade: &Trade, area: Rect, buffer: &mut Buffer) {
    let table = |is_wide: bool| {
        let own = own(app).and_then(|own| own.models);
        let text = |cell: &Cell| {
            let mark = if traded.marked == Some(cell.setting) { "▸" } else { "" };
            if is_wide { format!("{mark}{cell}") } else { format!("{mark}{}", cell.total) }
        };
        compliance_table(trade, own, '*', text).lines()
    };
    let fits = |line: &String| line.chars().count() <= area.width.into();
    let lines = Some(table(true)).filter(|lines| lines.iter().all(fits));
    let lines = lines.unwrap_or_else(|| table(false));
    let marked = lines.iter().position(|line| line.contains('▸'));
    let [above, below] =
        Layout::vertical([Constraint::Length(lines.len() as u16 + 1), Constraint::Fill(1)])
            .areas(area);
    super::draw_table(&lines, marked.map(|line| line - 1), app.look.theme, above, buffer);
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
