//! Lists to pick from: an input line, the matching lines, and the details of the selected line.

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::Style;
use unicode_width::UnicodeWidthStr;

use super::boxes::{draw_window, frame, halves, inside, line_at, parted};
use super::{Dialog, Outcome, Surroundings, boxes, digest};
use crate::case::EXAMPLES;
use crate::report::digest::Digest;
use crate::tui::actions::{Action, Effect};
use crate::tui::keys::Place;
use crate::tui::line::Line;
use crate::tui::text;
use crate::tui::theme::Theme;

mod item;
mod state;

pub use item::Item;
pub(crate) use item::{Pick, VARIANT};
pub(crate) use state::{Context, List, Picker};

/// Preferred size of a list.
const SIZE: Size = Size { width: 100, height: 20 };
/// Width of the keys of a command.
const KEYS: usize = 14;

impl Dialog for Picker {
    fn place(&self) -> Place {
        Place::PICK
    }

    fn input(&mut self) -> Option<&mut Line> {
        Some(&mut self.input)
    }

    fn typed(&mut self) -> Vec<Effect> {
        self.marked = 0;
        Vec::new()
    }

    fn step(&mut self, by: isize, _: &Surroundings<'_>) {
        self.mark(by);
    }

    fn turn(&mut self, by: isize, around: &Surroundings<'_>) {
        self.mark(by * boxes::page_height(around.screen));
    }

    fn click(&mut self, at: Position, screen: Size) -> bool {
        item_at(self, screen, at).is_some_and(|line| boxes::select(&mut self.marked, line))
    }

    fn accept(&mut self, _: &Surroundings<'_>) -> Outcome {
        let item = self.fitting().into_iter().nth(self.marked);
        item.map_or_else(Outcome::none, |item| Outcome::Pick(item.pick))
    }

    fn receive(&mut self, result: Action) {
        if let (List::Examples(digests), Action::Examples(found)) = (&mut self.list, result) {
            *digests = found;
        }
    }

    fn draw(&self, around: &Surroundings<'_>, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        draw(self, area, around.look.theme, buffer)
    }
}

fn draw(picker: &Picker, screen: Rect, theme: &Theme, buffer: &mut Buffer) -> Option<Position> {
    let inner = frame(picker.title(), SIZE, screen, theme, buffer);
    let items = picker.fitting();
    let list = below_line(inner);
    if let List::Examples(digests) = &picker.list {
        draw_examples(&items, digests, picker.marked, list, theme, buffer);
    } else {
        let above = above_detail(&items, list);
        draw_items(&items, picker.marked, above, theme, buffer);
        let below = Rect { y: above.bottom(), height: list.height - above.height, ..list };
        draw_detail(items.get(picker.marked), below, theme, buffer);
    }
    text::edited(&picker.input, Rect { height: inner.height.min(1), ..inner }, theme.focus, buffer)
}

// The index of the line at a cell, if any.
fn item_at(picker: &Picker, screen: Size, at: Position) -> Option<usize> {
    let items = picker.fitting();
    let list = below_line(inside(SIZE, Rect::from((Position::ORIGIN, screen))));
    let area = if matches!(picker.list, List::Examples(_)) {
        parted(list).0
    } else {
        above_detail(&items, list)
    };
    line_at(items.len(), Some(picker.marked), area, at)
}

fn below_line(inner: Rect) -> Rect {
    Rect { y: inner.y + 1, height: inner.height.saturating_sub(1), ..inner }
}

fn above_detail(items: &[Item], list: Rect) -> Rect {
    Rect { height: list.height - detail_lines(items, list), ..list }
}

// Name, keys, and as much of the description as fits.
fn draw_items(items: &[Item], marked: usize, area: Rect, theme: &Theme, buffer: &mut Buffer) {
    let widest = |text: fn(&Item) -> &str, most: usize| {
        items.iter().map(|item| text(item).width().min(most)).max().unwrap_or(0)
    };
    let keys = widest(|item| &item.keys, KEYS);
    let name = widest(|item| &item.name, usize::from(area.width) * 2 / 5);
    let line = |item: &Item| {
        let keys =
            if keys == 0 { String::new() } else { format!("  {}", text::padded(&item.keys, keys)) };
        format!("{}{keys}  {}", text::padded(&item.name, name), item.about).trim_end().to_owned()
    };
    draw_window(items.len(), |at| line(&items[at]), Some(marked), area, theme, buffer);
    say_if_none(items, area, theme, buffer);
}

// The number of lines that the longest description needs, including a rule above it, so that the
// list does not move.
fn detail_lines(items: &[Item], list: Rect) -> u16 {
    let lines = |item: &Item| text::wrap(&detail(item), list.width.into()).len();
    let most = items.iter().map(lines).max().unwrap_or(0) as u16 + 1;
    most.min(list.height / 3)
}

fn detail(item: &Item) -> String {
    let keys = if item.keys.is_empty() { String::new() } else { format!(" ({})", item.keys) };
    format!("{}{keys}: {}", item.name, item.about)
}

fn draw_detail(item: Option<&Item>, area: Rect, theme: &Theme, buffer: &mut Buffer) {
    let Some(item) = item.filter(|_| area.height > 1) else {
        return;
    };
    buffer.set_stringn(
        area.x,
        area.y,
        "─".repeat(area.width.into()),
        area.width.into(),
        theme.rule,
    );
    for (line, y) in
        text::wrap(&detail(item), area.width.into()).iter().zip(area.y + 1..area.bottom())
    {
        buffer.set_stringn(area.x, y, line, area.width.into(), Style::new());
    }
}

// The names on the left, the digest of the selected one on the right.
fn draw_examples(
    items: &[Item],
    digests: &[Digest],
    marked: usize,
    area: Rect,
    theme: &Theme,
    buffer: &mut Buffer,
) {
    let (left, right) = halves(area, buffer);
    draw_window(items.len(), |at| items[at].name.clone(), Some(marked), left, theme, buffer);
    say_if_none(items, left, theme, buffer);
    let at = items
        .get(marked)
        .and_then(|item| EXAMPLES.iter().position(|example| example.name == item.name));
    let lines = at
        .and_then(|at| digests.get(at))
        .map(|digest| digest::lines(digest, right.width.into(), theme));
    for ((line, style), y) in lines.unwrap_or_default().iter().zip(right.top()..right.bottom()) {
        buffer.set_stringn(right.x, y, line, right.width.into(), *style);
    }
}

fn say_if_none(items: &[Item], area: Rect, theme: &Theme, buffer: &mut Buffer) {
    if items.is_empty() && !area.is_empty() {
        buffer.set_stringn(area.x, area.y, "No match.", area.width.into(), theme.faint);
    }
}
