//! The parts of the pane from top to bottom, with their heights.

use ratatui::style::Style;
use ratatui::text::Line;
use unicode_width::UnicodeWidthStr;

use super::gauges::{self, Gauge};
use super::limits;
use super::pane::Results;
use super::words::{NOTE, faults, refused_variants, sentence};
use crate::report::digest;
use crate::tui::solver::Answer;
use crate::tui::text;

/// Number of visible quantities above which gauges and notes get more than one line each.
const ENOUGH_ROWS: usize = 8;

/// Least number of visible quantities, below outcome and gauges or below a refusal.
const LEAST_ROWS: usize = 4;
const LEAST_BELOW_FAULT: usize = 2;

/// A pane with fewer lines and columns shows the outcome as a short phrase.
const LOW: usize = 20;

const NARROW: usize = 30;

/// The content of the pane, from top to bottom.
pub(super) struct Parts {
    /// The refusal, the outcome, the gauges.
    pub(super) head: Vec<Line<'static>>,
    /// Number of quantities that fit below their heading.
    pub(super) rows: usize,
    /// The notes.
    pub(super) notes: Vec<Line<'static>>,
}

// If there is room, every gauge and note is printed in full; otherwise each gauge has one line and
// all notes share one.
pub(super) fn parts(pane: &Results<'_>) -> Parts {
    let area = pane.area;
    let width = usize::from(area.width.saturating_sub(1));
    let height = usize::from(area.height.saturating_sub(1));
    let mut head = banner(pane, width);
    let faults = head.len();
    let (mut gauges, mut notes) = (Vec::new(), Vec::new());
    if let Some(answer) = pane.answer {
        head.extend(outcome(pane, answer, width, height < LOW));
        gauges = gauges::gauges(pane, answer).iter().map(|gauge| gauge.fitting(width)).collect();
        notes = answer
            .notes
            .iter()
            .map(|note| format!("{NOTE}{}", note.message))
            .chain(refused_variants(pane))
            .collect();
    }
    let whole = |texts: &[String]| {
        texts.iter().flat_map(|text| text::wrap(text, width)).collect::<Vec<_>>()
    };
    let rows_beside = |gauges: &[String], notes: &[String]| {
        height.saturating_sub(head.len() + gauges.len() + 1 + notes.len())
    };
    let (mut gauge_lines, mut note_lines) = (whole(&gauges), whole(&notes));
    if rows_beside(&gauge_lines, &note_lines) < ENOUGH_ROWS {
        gauge_lines = gauges.iter().map(|gauge| text::cut(gauge, width)).collect();
        note_lines = shortened(pane, 0, width).into_iter().collect();
        let least = if faults == 0 { LEAST_ROWS } else { LEAST_BELOW_FAULT };
        let room = |notes: usize| height.saturating_sub(head.len() + 1 + least + notes);
        if gauge_lines.len() > room(note_lines.len()) {
            let hidden = gauge_lines.len() - room(1).min(gauge_lines.len());
            gauge_lines.truncate(room(1));
            note_lines = shortened(pane, hidden, width).into_iter().collect();
        }
    }
    let faint = if pane.is_stale { pane.look.theme.faint } else { Style::new() };
    head.extend(gauge_lines.into_iter().map(|gauge| Line::styled(gauge, faint)));
    head.truncate(height.saturating_sub(1 + LEAST_BELOW_FAULT + note_lines.len()));
    let rows = height.saturating_sub(head.len() + 1 + note_lines.len());
    let style = pane.look.theme.note.patch(faint);
    Parts {
        head,
        rows,
        notes: note_lines.into_iter().map(|note| Line::styled(note, style)).collect(),
    }
}

// A single note in full, otherwise the names of as many notes as fit, otherwise their number. If
// lines above are hidden, the number of all hidden lines.
fn shortened(pane: &Results<'_>, hidden: usize, width: usize) -> Option<String> {
    let notes = pane.answer.map_or(&[][..], |answer| &answer.notes[..]);
    let count = notes.len() + hidden;
    let key = (pane.notes_key)();
    let noun = match (hidden, count) {
        (0, 1) => "note",
        (0, _) => "notes",
        (_, 1) => "more line",
        _ => "more lines",
    };
    let counted = format!("{count} {noun} ({key})");
    if hidden > 0 {
        return Some(counted);
    }
    let in_full =
        notes.first().filter(|_| count == 1).map(|note| format!("{NOTE}{}", note.message));
    let names: Vec<String> = notes.iter().map(|note| note.code.replace('-', " ")).collect();
    let by_names = (1..=count).rev().map(|shown| {
        let others =
            if shown < count { format!(", {} more", count - shown) } else { String::new() };
        format!("{NOTE}{}{others} ({key})", names[..shown].join(", "))
    });
    let mut sayings = in_full.into_iter().chain(by_names).chain([counted.clone()]);
    (count > 0).then(|| sayings.find(|words| words.width() <= width).unwrap_or(counted))
}

fn banner(pane: &Results<'_>, width: usize) -> Vec<Line<'static>> {
    let styles = [pane.look.theme.problem, Style::new()];
    let lines = faults(pane).into_iter().zip(styles);
    lines
        .flat_map(|(text, style)| {
            text::wrap(&text, width).into_iter().map(move |line| Line::styled(line, style))
        })
        .collect()
}

fn outcome(pane: &Results<'_>, answer: &Answer, width: usize, is_low: bool) -> Vec<Line<'static>> {
    let Some(solution) = answer.of(answer.active) else {
        return Vec::new();
    };
    let style = if pane.is_stale { pane.look.theme.faint } else { pane.look.theme.focus };
    let words = if is_low && width < NARROW {
        digest::short(solution, pane.units)
    } else {
        sentence(pane, solution)
    };
    let lines = text::wrap(&words, width).into_iter();
    let warning = limits::warning(pane, solution).filter(|_| !pane.is_stale);
    let warning = warning.map(|words| Gauge(words).fitting(width));
    let warning = warning.map(|words| {
        let line = text::cut(&words, width);
        Line::styled(line, pane.look.theme.problem)
    });
    lines.map(|line| Line::styled(line, style)).chain(warning).collect()
}
