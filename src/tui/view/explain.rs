//! The explanation of a result: the page of `tipstrike explain`, with the marked one of the fields
//! behind it.

use ratatui::buffer::Buffer;
use ratatui::layout::{Rect, Size};
use ratatui::style::Style;

use super::{boxes, text as words};
use crate::report::explain::{Kind, Line, lines};
use crate::tui::ascii::written_out;
use crate::tui::explanation::Explanation;
use crate::tui::theme::{Look, Theme};

/// Draw the page over the screen.
pub fn draw(explanation: &Explanation, screen: Rect, look: Look, buffer: &mut Buffer) {
    let theme = look.theme;
    let lines = text(explanation, screen.as_size(), look.ascii);
    let wanted = Size {
        width: u16::MAX,
        height: u16::try_from(lines.len()).unwrap_or(u16::MAX),
    };
    let inner = boxes::frame(
        explanation.quantity.label.trim(),
        wanted,
        screen,
        theme,
        buffer,
    );
    let marked = place_of_field(explanation, &lines);
    for ((at, line), y) in lines
        .iter()
        .enumerate()
        .skip(explanation.top)
        .zip(inner.top()..inner.bottom())
    {
        buffer.set_stringn(
            inner.x,
            y,
            &line.text,
            inner.width.into(),
            style(line.kind, theme),
        );
        if let Some((_, column, key)) = marked.filter(|(row, ..)| *row == at) {
            let x = inner.x + column;
            buffer.set_stringn(x.saturating_sub(1), y, "▸", 1, theme.focus);
            buffer.set_stringn(
                x,
                y,
                key,
                usize::from(inner.right().saturating_sub(x)),
                theme.key,
            );
        }
    }
    if lines.len() > usize::from(inner.height) {
        words::scroll_bar(
            explanation.top,
            lines.len(),
            Rect {
                x: inner.right(),
                width: 1,
                ..inner
            },
            buffer,
        );
    }
}

/// Scroll, as far as there are lines.
pub fn scroll(explanation: &mut Explanation, by: isize, screen: Size, ascii: bool) {
    let last = text(explanation, screen, ascii)
        .len()
        .saturating_sub(boxes::room(screen).height.into());
    explanation.top = explanation.top.saturating_add_signed(by).min(last);
}

/// Bring the marked field into sight.
pub fn follow(explanation: &mut Explanation, screen: Size, ascii: bool) {
    let lines = text(explanation, screen, ascii);
    let height = usize::from(boxes::room(screen).height).max(1);
    if let Some((row, ..)) = place_of_field(explanation, &lines) {
        explanation.top = explanation.top.clamp((row + 1).saturating_sub(height), row);
    }
}

fn text(explanation: &Explanation, screen: Size, ascii: bool) -> Vec<Line> {
    let width = boxes::room(screen).width.into();
    let said = |text: &str| {
        vec![Line {
            kind: Kind::Text,
            text: text.to_owned(),
        }]
    };
    let page = match &explanation.page {
        None => said("being computed: each field behind it is moved a small step"),
        Some(Err(reason)) => said(reason),
        Some(Ok(page)) => lines(page, &explanation.case, width),
    };
    let other_units = explanation.value.iter().flat_map(|value| {
        said(&format!(
            "{value} in inch units; this page is in metric ones."
        ))
    });
    let lines = other_units.chain(page);
    if ascii {
        lines.flat_map(|line| in_ascii(&line, width)).collect()
    } else {
        lines.collect()
    }
}

// Letters that are written out may need another line.
fn in_ascii(line: &Line, width: usize) -> Vec<Line> {
    let written = written_out(&line.text);
    let indent = written.len() - written.trim_start().len();
    let pieces = words::wrap(&written[indent..], width.saturating_sub(indent + 2));
    if written.len() <= width {
        return vec![Line {
            kind: line.kind,
            text: written.into_owned(),
        }];
    }
    let lead = |at: usize| " ".repeat(indent + if at == 0 { 0 } else { 2 });
    pieces
        .iter()
        .enumerate()
        .map(|(at, piece)| Line {
            kind: line.kind,
            text: lead(at) + piece,
        })
        .collect()
}

// Row and column of the marked field, and its key. No line breaks inside a key.
fn place_of_field(explanation: &Explanation, lines: &[Line]) -> Option<(usize, u16, &'static str)> {
    let key = explanation.field()?;
    let list = lines.iter().rposition(|line| line.kind == Kind::Heading)?;
    let is_end = |letter: char| !letter.is_alphanumeric() && letter != '_';
    let whole = |text: &str| {
        text.match_indices(key)
            .map(|(at, _)| at)
            .find(|at| text[at + key.len()..].chars().next().is_none_or(is_end))
    };
    let found = lines
        .iter()
        .enumerate()
        .skip(list + 1)
        .find_map(|(row, line)| Some((row, whole(&line.text)?)));
    let (row, at) = found?;
    Some((
        row,
        u16::try_from(lines[row].text[..at].chars().count()).ok()?,
        key,
    ))
}

fn style(kind: Kind, theme: &Theme) -> Style {
    match kind {
        Kind::Title => theme.focus,
        Kind::Heading => theme.title,
        Kind::Outside => theme.problem,
        Kind::Formula | Kind::Numbers | Kind::Text => Style::new(),
    }
}
