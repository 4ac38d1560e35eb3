//! The title of the pane: as much as has room.

use unicode_width::UnicodeWidthStr;

use super::pane::Results;
use super::selection::line_count;
use crate::tui::text;

/// So much of the baseline's name, and of the word before it, tells something.
const LEAST_OF_BASE: usize = ", against name…".len();

/// Words for the variants, in full and in fewer.
const VARIANTS: [&str; 2] = [", variants against the case", ", variants"];

// Which lines of the table are in sight, where some are not; in words, in numbers, in arrows.
fn position(pane: &Results<'_>, rows: usize) -> [String; 3] {
    let (lines, first) = (line_count(pane), pane.state.top + 1);
    let last = (pane.state.top + rows).min(lines);
    if rows == 0 || rows >= lines {
        return Default::default();
    }
    [
        format!(" {first} to {last} of {lines}"),
        format!(" {first}-{last}/{lines}"),
        [
            " ",
            if first > 1 { "↑" } else { "" },
            if last < lines { "↓" } else { "" },
        ]
        .concat(),
    ]
}

// As much of it as has room, so that nothing is cut.
pub(super) fn title(pane: &Results<'_>, rows: usize, room: usize) -> String {
    let name = if pane.shows_last_valid {
        "Results: LAST VALID"
    } else {
        "Results"
    };
    let left = room.saturating_sub(name.width());
    let name_of_base = match (pane.variants, pane.baseline) {
        (Some(_), _) => VARIANTS
            .into_iter()
            .find(|words| words.width() <= left)
            .map(str::to_owned),
        (None, baseline) => baseline.map(|baseline| format!(", against {}", baseline.name)),
    };
    let against = name_of_base.as_deref().unwrap_or_default();
    let begun = text::cut(against, left);
    let base = if begun.width() >= LEAST_OF_BASE || pane.variants.is_some() {
        begun.as_str()
    } else {
        ""
    };
    let answer = pane.answer;
    let pending = answer
        .and_then(|answer| answer.pending)
        .map_or_else(String::new, |method| format!(", {} pending", method.name()));
    let cost = answer
        .filter(|_| pane.shows_cost)
        .map_or_else(String::new, |answer| {
            format!(
                ", {} stages in {} us",
                answer.cost.stages, answer.cost.micros
            )
        });
    let short = if pane.shows_last_valid {
        "LAST VALID"
    } else {
        name
    };
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
    titles
        .into_iter()
        .find(|title| title.width() <= room)
        .unwrap_or_else(|| short.to_owned())
}
