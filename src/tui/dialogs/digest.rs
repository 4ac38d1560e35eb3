//! The digest of a case as lines: its description and its verdict.

use ratatui::style::Style;

use crate::report::digest::Digest;
use crate::tui::text;
use crate::tui::theme::Theme;

/// The lines in `width` columns, each with its style.
#[must_use]
pub(super) fn lines(digest: &Digest, width: usize, theme: &Theme) -> Vec<(String, Style)> {
    let plain = Style::new();
    let title = if digest.title.is_empty() { "without a title" } else { &digest.title };
    let said = |text: &str, style: Style| {
        text::wrap(text, width).into_iter().map(move |line| (line, style))
    };
    let empty = || std::iter::once((String::new(), plain));
    let mut lines: Vec<_> = said(title, theme.title).collect();
    lines.extend(
        [&digest.pair, &digest.load, &format!("method {}", digest.method)]
            .into_iter()
            .flat_map(|text| said(text, plain)),
    );
    lines.extend(empty().chain(said(&digest.outcome, theme.focus)));
    for (standing, text) in &digest.limits {
        let style = if standing.holds() { plain } else { theme.problem };
        lines.extend(said(&format!("{} {text}", standing.word()), style));
    }
    if digest.limits.is_empty() {
        lines.extend(said("No limits.", plain));
    }
    lines.extend(
        digest
            .notes
            .iter()
            .flat_map(|note| empty().chain(said(&format!("Note: {note}"), theme.note))),
    );
    lines
}
