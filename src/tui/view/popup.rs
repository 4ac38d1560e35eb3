//! What lies over the form: pages, questions, lines and lists, each in its box.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::Style;
use ratatui::text::{Line, Span};
use ratatui::widgets::Widget;
use unicode_width::UnicodeWidthStr;

use super::boxes::{WIDEST, frame, inside, room};
use super::{browser, cursor_prompt, explain, picker, text};
use crate::tui::app::App;
use crate::tui::prompt::{Page, Prompt, Question};
use crate::tui::theme::Theme;

/// Brackets, marks and the gap beside the name of a button.
const BESIDE_NAME: u16 = 7;

/// How a name is given.
const NAMING: &str = "A name or a path, ~ is the home folder; without an ending it gets .toml. What is there already is asked about.";

/// Draw a prompt over the screen; where the cursor stands.
pub fn draw(app: &App, prompt: &Prompt, screen: Rect, buffer: &mut Buffer) -> Option<Position> {
    let theme = app.look.theme;
    match prompt {
        Prompt::Read(page) => {
            draw_page(page, screen, theme, buffer);
            None
        }
        Prompt::Ask(question) => {
            draw_question(question, screen, theme, buffer);
            None
        }
        Prompt::SaveAs(input, _) => {
            let how = text::wrap(NAMING, usize::from(room(screen.as_size()).width));
            let inner = frame(
                "Save as",
                Size::new(WIDEST, how.len() as u16 + 1),
                screen,
                theme,
                buffer,
            );
            for (line, y) in how.iter().zip(inner.top() + 1..inner.bottom()) {
                buffer.set_stringn(inner.x, y, line, inner.width.into(), theme.faint);
            }
            text::edited(
                input,
                Rect {
                    height: inner.height.min(1),
                    ..inner
                },
                theme.focus,
                buffer,
            )
        }
        Prompt::Aim(input) => cursor_prompt::draw(app, input, screen, buffer),
        Prompt::Explain(explanation) => {
            explain::draw(explanation, screen, app.look, buffer);
            None
        }
        Prompt::Browse(browser) => browser::draw(browser, screen, theme, buffer),
        Prompt::Pick(picker) => picker::draw(picker, screen, theme, buffer),
    }
}

/// The lines of a page as they stand in a box; lines that go on are indented.
#[must_use]
pub fn wrapped(page: &Page, screen: Size) -> Vec<String> {
    let width = usize::from(room(screen).width);
    let wrap = |line: &String| {
        let indent = hanging(line);
        let (head, text) = line.split_at(indent);
        let pieces = text::wrap(text, width.saturating_sub(indent));
        let head = head.to_owned();
        pieces.into_iter().enumerate().map(move |(index, piece)| {
            if index == 0 {
                head.clone() + &piece
            } else {
                " ".repeat(indent) + &piece
            }
        })
    };
    page.lines.iter().flat_map(wrap).collect()
}

// Where a line goes on when it is wrapped: below its second column, if it has one.
fn hanging(line: &str) -> usize {
    let lead = line.len() - line.trim_start().len();
    let gap = line[lead..].find("  ").map(|at| lead + at);
    let column = gap.map(|gap| line.len() - line[gap..].trim_start().len());
    column.filter(|_| line.is_ascii()).unwrap_or(lead)
}

/// Scroll a page, as far as there are lines.
pub fn scroll(page: &mut Page, by: isize, screen: Size) {
    let last = wrapped(page, screen)
        .len()
        .saturating_sub(room(screen).height.into());
    page.top = page.top.saturating_add_signed(by).min(last);
}

fn draw_page(page: &Page, screen: Rect, theme: &Theme, buffer: &mut Buffer) {
    let lines = wrapped(page, screen.as_size());
    let inner = frame(&page.title, extent(&lines, 0), screen, theme, buffer);
    for (line, y) in lines.iter().skip(page.top).zip(inner.top()..inner.bottom()) {
        buffer.set_stringn(inner.x, y, line, inner.width.into(), Style::new());
    }
    if lines.len() > usize::from(inner.height) {
        text::scroll_bar(
            page.top,
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

fn draw_question(question: &Question, screen: Rect, theme: &Theme, buffer: &mut Buffer) {
    let lines = question_lines(question, room(screen.as_size()));
    let inner = frame(question.title, extent(&lines, 2), screen, theme, buffer);
    for (line, y) in lines.iter().zip(inner.top()..inner.bottom()) {
        buffer.set_stringn(inner.x, y, line, inner.width.into(), Style::new());
    }
    let row = button_row(&lines, inner);
    let buttons = question
        .buttons
        .iter()
        .enumerate()
        .flat_map(|(index, (name, _))| {
            let marked = index == question.marked;
            let (text, style) = if marked {
                (format!("[> {name} <]"), theme.key)
            } else {
                (format!("[  {name}  ]"), Style::new())
            };
            [Span::styled(text, style), Span::raw(" ")]
        });
    buttons.collect::<Line<'_>>().render(row, buffer);
}

/// The button on a cell, where there is one.
#[must_use]
pub fn button_at(question: &Question, screen: Size, at: Position) -> Option<usize> {
    let lines = question_lines(question, room(screen));
    let row = button_row(
        &lines,
        inside(extent(&lines, 2), Rect::from((Position::ORIGIN, screen))),
    );
    let mut right = row.x;
    let ends = question.buttons.iter().map(|(name, _)| {
        right += name.width() as u16 + BESIDE_NAME;
        right
    });
    let ends: Vec<_> = ends.collect();
    // The gap before the next one is no button.
    ends.iter()
        .position(|&end| at.x + 1 < end)
        .filter(|_| row.contains(at))
}

// Below the lines and one that is empty; nothing where it has no room.
fn button_row(lines: &[String], inner: Rect) -> Rect {
    let below = u16::try_from(lines.len())
        .unwrap_or(u16::MAX)
        .saturating_add(1);
    if below < inner.height {
        Rect {
            y: inner.y + below,
            height: 1,
            ..inner
        }
    } else {
        Rect::ZERO
    }
}

// The buttons below them must be in sight: of the details, as many as there is room for, a line
// each.
fn question_lines(question: &Question, room: Size) -> Vec<String> {
    let width = usize::from(room.width);
    let mut lines = text::wrap(&question.text, width);
    let left = usize::from(room.height).saturating_sub(lines.len() + 2);
    let details = &question.details;
    let shown = if details.len() <= left {
        details.len()
    } else {
        left.saturating_sub(1)
    };
    lines.extend(
        details[..shown]
            .iter()
            .map(|line| text::cut(&format!("  {line}"), width)),
    );
    if shown < details.len() && left > 0 {
        lines.push(format!("  and {} more", details.len() - shown));
    }
    lines
}

// What the lines and some more below them take.
fn extent(lines: &[String], more: usize) -> Size {
    let width = lines.iter().map(|line| line.width()).max().unwrap_or(0);
    let size = |length: usize| u16::try_from(length).unwrap_or(u16::MAX);
    Size {
        width: size(width),
        height: size(lines.len() + more),
    }
}
