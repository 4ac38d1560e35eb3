//! The lines around the panes: the name of the case, what the focused field is, the keys.

use ratatui::buffer::Buffer;
use ratatui::layout::Rect;
use ratatui::text::{Line, Span};
use ratatui::widgets::Widget;
use unicode_width::UnicodeWidthStr;

use super::text;
use crate::case::FIELDS;
use crate::case::fields::{self, Absent, Field, Kind};
use crate::tui::actions::{BINDINGS, Binding};
use crate::tui::app::App;
use crate::tui::clean::symbol;

/// The name of the file, whether it is unsaved, and the title of the case.
pub fn header(app: &App, area: Rect, buffer: &mut Buffer) {
    let theme = app.look.theme;
    let mut spans = vec![Span::styled("tipstrike", theme.title), Span::raw("  ")];
    let mark = [if app.is_unsaved() { " *unsaved*" } else { "" }, app.access.mark()].concat();
    let room = usize::from(area.width).saturating_sub(11 + mark.width());
    spans.push(Span::raw(text::cut(&app.name(), room)));
    spans.push(Span::styled(mark, theme.note));
    let used: usize = spans.iter().map(Span::width).sum();
    let title = fields::index_of("title").and_then(|title| app.case.text(title)).unwrap_or_default();
    let left = usize::from(area.width).saturating_sub(used + 3);
    if !title.is_empty() && left > 8 {
        spans.push(Span::raw(format!("   {}", text::cut(title, left))));
    }
    Line::from(spans).render(area, buffer);
}

/// A message; else unit, range and meaning of the focused field.
pub fn hint(app: &App, area: Rect, buffer: &mut Buffer) {
    let theme = app.look.theme;
    let width = usize::from(area.width);
    let about = about(&FIELDS[app.focus], app.look.ascii);
    let mut lines = text::wrap(&about, width).into_iter().map(Line::raw).collect::<Vec<_>>();
    if let Some(message) = &app.message {
        let (mark, style) = if message.is_fault { ("! ", theme.problem) } else { ("", theme.note) };
        lines.insert(0, Line::styled(text::cut(&format!("{mark}{}", message.text), width), style));
    }
    for (line, y) in lines.iter().zip(area.top()..area.bottom()) {
        line.render(Rect { y, height: 1, ..area }, buffer);
    }
}

/// As many keys as fit, from the table of bindings.
pub fn keys(app: &App, area: Rect, buffer: &mut Buffer) {
    let theme = app.look.theme;
    let place = app.place();
    let mut spans = Vec::new();
    let mut left = usize::from(area.width);
    for binding in BINDINGS.iter().filter(|binding| binding.places.meets(place) && !binding.name.is_empty()) {
        let key = short(binding);
        let used = key.width() + binding.name.width() + 3;
        if used > left + 2 {
            break;
        }
        left = left.saturating_sub(used);
        spans.extend([Span::styled(key, theme.key), Span::raw(format!(" {}  ", binding.name))]);
    }
    Line::from(spans).render(area, buffer);
}

/// What a field is, in its own words.
#[must_use]
pub fn about(field: &Field, ascii: bool) -> String {
    let name = [symbol(field.symbol, ascii).as_ref(), field.label].join(" ");
    let bounds = match field.kind {
        Kind::Text => String::new(),
        Kind::Number(_, range, _) => {
            format!(", {}..{} {}", number(range.from), number(range.to), range.unit).trim_end().to_owned()
        }
        Kind::Count(from, to, _) => format!(", {from}..{to}"),
        Kind::Choice(names, _) => format!(", {}", names.join(" | ")),
    };
    let absent = match field.absent {
        Absent::Default("") | Absent::Refused | Absent::Either(_) => String::new(),
        Absent::Default(text) => format!(" (else {text})"),
        Absent::Without(_) => " (may be empty)".to_owned(),
    };
    format!("{}{bounds}{absent}. {}", name.trim_start(), field.help)
}

fn number(value: f64) -> String {
    let is_plain = value == 0.0 || (1e-4..1e7).contains(&value.abs());
    if is_plain { format!("{value}") } else { format!("{value:e}") }
}

fn short(binding: &Binding) -> String {
    binding.chords.first().map(|chord| chord.name().replace("Ctrl-", "^")).unwrap_or_default()
}
