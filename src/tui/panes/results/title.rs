//! The title of the results pane.

use unicode_width::UnicodeWidthStr;

use super::pane::Results;
use super::selection::line_count;
use crate::tui::text;

/// Least useful width of the baseline's name with the word before it.
const LEAST_OF_BASE: usize = ", against name…".len();

/// Words for the variants, the longest first.
const VARIANTS: [&str; 2] = [", variants against the case", ", variants"];

// The range of visible lines of the table, if some are hidden: in words, in numbers, as arrows.
fn position(pane: &Results<'_>, rows: usize) -> [String; 3] {
    let (lines, first) = (line_count(pane), pane.state.top + 1);
    let last = (pane.state.top + rows).min(lines);
    if rows == 0 || rows >= lines {
        return Default::default();
    }
    [
        format!(" {first} to {last} of {lines}"),
        format!(" {first}-{last}/{lines}"),
        [" ", if first > 1 { "↑" } else { "" }, if last < lines { "↓" } else { "" }].concat(),
    ]
}

// The longest title that fits without a cut.
pub(super) fn title(pane: &Results<'_>, rows: usize, room: usize) -> String {
    let name = if pane.shows_last_valid { "Results: LAST VALID" } else { "Results" };
    let left = room.saturating_sub(name.width());
    let name_of_base = match (pane.variants, pane.baseline) {
        (Some(_), _) => VARIANTS.into_iter().find(|words| words.width() <= left).map(str::to_owned),
        (None, baseline) => baseline.map(|baseline| format!(", against {}", baseline.name)),
    };
    let against = name_of_base.as_deref().unwrap_or_default();
    let begun = text::cut(against, left);
    let base =
        if begun.width() >= LEAST_OF_BASE || pane.variants.is_some() { begun.as_str() } else { "" };
    let answer = pane.answer;
    let pending = answer
        .and_then(|answer| answer.pending)
        .map_or_else(String::new, |method| format!(", {} pending", method.name()));
    let cost = answer.filter(|_| pane.shows_cost).map_or_else(String::new, |answer| {
        format!(", {} stages in {} us", answer.cost.stages, answer.cost.micros)
    });
    let short = if pane.shows_last_valid { "LAST VALID" } else { name };
    let [position, numbers, arrows] = position(pane, rows);
    let titles = [
        format!("{name}{position}{against}{pending}{cost}"),
        format!("{name}{numbers}{against}{pending}{cost}"),
        format!("{name}{arrows}{against}{pending}{cost}"),
        format!("{name}{arrows}{against}{cost}"),
        format!("{name}{position}{base}"),
        format!("{name}{numbers}{base}"),
        format!("{name}{arrows}{base}"),
        format!("{name}{base}"),
        format!("{name}{arrows}"),
        name.to_owned(),
    ];
    titles.into_iter().find(|title| title.width() <= room).unwrap_or_else(|| short.to_owned())
}
