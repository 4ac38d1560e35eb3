//! Accuracy of every setting against its run time, as a chart or as a table of methods and
//! compliances.

mod compliances;
mod pane;
mod plot;

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;

use crate::report::trade::{NO_CONTACT, build, parts, percent, summary};
use crate::study::trade::Trade;
use crate::tui::jobs::{TradeView, Traded};
use crate::tui::text;

use pane::own;
pub(crate) use pane::{TradePane, nearest, stepped};
use plot::{LEVEL, draw_legend, draw_plot};

/// Least height with a row for the legend.
const TALL: u16 = 8;
const INVITATION: &str = "runs every method with its settings on this case for a few seconds. Esc stops the \
    benchmark and keeps its results. Enter then applies the selected setting to the case.";

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

/// Draws the table of methods and compliances, with a text about the selected setting below it.
fn draw_table(
    pane: &TradePane<'_>,
    traded: &Traded,
    trade: &Trade,
    inner: Rect,
    buffer: &mut Buffer,
) {
    let marks =
        compliances::Marks { selected: traded.marked, own: own(pane).and_then(|own| own.models) };
    let words = inner.height.min(if inner.height > TALL { 2 } else { 1 });
    let table = Rect { height: inner.height - words, ..inner };
    let rows = compliances::draw(trade, &marks, pane.look.theme, table, buffer);
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
        let far = if measured == planned && trade.part < 1.0 {
            format!("all {planned} settings measured once; repeating")
        } else {
            format!("{measured} of {planned} settings measured")
        };
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
