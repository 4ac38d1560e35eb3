//! Lists to pick from: an input line, the matching lines, and the details of the selected line.

use std::cmp::Reverse;
use std::sync::Arc;

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Position, Rect, Size};
use ratatui::style::Style;
use ratatui::text::{Span, Text};
use ratatui::widgets::{Block, Borders, Widget};
use unicode_width::UnicodeWidthStr;

use super::{Dialog, PreviewPane, Window, closing, draw_details, halves, said};
use crate::case::fields::{FIELDS, Field, Kind};
use crate::model::Quantity;
use crate::tui::app::App;
use crate::tui::app::actions::{Change, Choice, Work};
use crate::tui::form_aids::{COMMAND, Entry, HELP, LABEL, query};
use crate::tui::layout::Place;
use crate::tui::settings::Theme;
use crate::tui::store::folder::Target;
use crate::tui::text;
use crate::tui::text::Line;

/// Preferred size of a list.
const SIZE: Size = Size { width: 100, height: 20 };
/// Width of the keys of a command.
const KEYS: usize = 14;

/// A line of a list.
#[derive(Debug, Clone)]
pub struct Item {
    choice: Choice,
    /// The name in the list.
    pub name: String,
    /// The description.
    pub(crate) about: String,
    keys: String,
    /// The texts that find the line.
    entry: Entry,
    /// Penalty in the score.
    loss: u32,
    /// The order of lines with equal scores.
    order: usize,
    /// Whether the list shows it before the user types.
    is_command: bool,
    /// The target of the preview.
    preview: Option<Target>,
}

/// A command whose argument the user types after its name.
#[derive(Debug, Clone, Copy)]
pub(crate) struct Typed {
    pub(crate) name: &'static str,
    /// The sentence about the argument.
    pub(crate) about: fn(&str) -> String,
    pub(crate) run: fn(&mut App, &str),
}

/// A list with an input line.
#[derive(Debug, Clone)]
pub struct Picker {
    title: &'static str,
    items: Vec<Arc<Item>>,
    typed: &'static [Typed],
    /// The typed text.
    pub(crate) input: Line,
    /// The index of the selected line among the matches.
    selected: usize,
    /// The preview beside the list of examples.
    preview: Option<PreviewPane>,
}

impl Picker {
    /// A list of these lines; `typed` commands take the rest of the typed text.
    pub(crate) fn new(
        title: &'static str,
        items: impl Iterator<Item = Item>,
        typed: &'static [Typed],
    ) -> Picker {
        let items: Vec<_> = items.map(Arc::new).collect();
        let has_preview = items.iter().any(|item| item.preview.is_some());
        let preview = has_preview.then(PreviewPane::default);
        Picker { title, items, typed, input: Line::default(), selected: 0, preview }
    }

    /// Every field with a value, only those that are no count or choice if `are_numbers`.
    pub(crate) fn fields(
        title: &'static str,
        are_numbers: bool,
        choose: fn(&mut App, usize),
    ) -> Picker {
        let is_valued = |field: &Field| match field.kind {
            Kind::Text => false,
            Kind::Number(..) => true,
            _ => !are_numbers,
        };
        let valued = FIELDS.iter().enumerate().filter(|(_, field)| is_valued(field));
        let item = |(at, field)| Item::field(Choice::of(move |app| choose(app, at)), field);
        Picker::new(title, valued.map(item), &[])
    }

    /// The list with a first line before it.
    pub(crate) fn after(mut self, first: Item) -> Picker {
        self.items.insert(0, Arc::new(first));
        self
    }

    /// Every result.
    pub(crate) fn results(title: &'static str, choose: fn(&mut App, &'static Quantity)) -> Picker {
        let item = |quantity: &'static Quantity| {
            let about = format!("{} {}", quantity.symbol, quantity.label.trim_start());
            Item::result(Choice::of(move |app| choose(app, quantity)), quantity, about)
        };
        Picker::new(title, Quantity::all().map(item), &[])
    }

    /// The lines that match every typed word, the best first.
    pub fn fitting(&self) -> Vec<Arc<Item>> {
        if let Some(item) = self.with_argument() {
            return vec![Arc::new(item)];
        }
        let typed = self.input.value().trim();
        let words = query(typed);
        let has_commands = self.items.first().is_some_and(|first| first.is_command);
        let is_shown = |item: &&Arc<Item>| !typed.is_empty() || !has_commands || item.is_command;
        let shown = self.items.iter().filter(is_shown);
        let mut found: Vec<_> =
            shown.filter_map(|item| Some((item.rank(typed, &words)?, item))).collect();
        if !words.is_empty() {
            found.sort_by_key(|(rank, _)| *rank);
        }
        found.into_iter().map(|(_, item)| Arc::clone(item)).collect()
    }

    fn with_argument(&self) -> Option<Item> {
        let (command, argument) = self.input.value().trim_start().split_once(' ')?;
        let argument = Some(argument.trim().to_owned()).filter(|argument| !argument.is_empty())?;
        let Typed { name, about, run } = *self.typed.iter().find(|typed| typed.name == command)?;
        let (name, about) = (format!("{name} {argument}"), about(&argument));
        Some(Item::command(Choice::of(move |app| run(app, &argument)), name, about, String::new()))
    }
}

impl Item {
    fn new(choice: Choice, name: String, about: String, entry: Entry) -> Item {
        Item {
            choice,
            name,
            about,
            keys: String::new(),
            entry,
            loss: 0,
            order: 0,
            is_command: false,
            preview: None,
        }
    }

    pub(crate) fn named(choice: Choice, name: String, about: String) -> Item {
        let entry = Entry::new("", &[(LABEL, &name), (HELP, &about)]);
        Item::new(choice, name, about, entry)
    }

    pub(crate) fn command(choice: Choice, name: String, about: String, keys: String) -> Item {
        let entry = Entry::new("", &[(COMMAND, &name), (HELP, &about)]);
        Item { keys, is_command: true, ..Item::new(choice, name, about, entry) }
    }

    pub(crate) fn field(choice: Choice, field: &Field) -> Item {
        let about = format!("{} {}. {}", field.symbol, field.full_label(), field.help);
        let about = about.trim_start().to_owned();
        Item::new(choice, field.key.to_owned(), about, Entry::of_field(field))
    }

    pub(crate) fn result(choice: Choice, quantity: &Quantity, about: String) -> Item {
        Item::new(choice, quantity.key.to_owned(), about, Entry::of_result(quantity))
    }

    /// The line with a penalty in its score, and an order among lines with equal scores.
    pub(crate) fn ranked(self, loss: u32, order: usize) -> Item {
        Item { loss, order, ..self }
    }

    pub(crate) fn previewing(self, target: Target) -> Item {
        Item { preview: Some(target), ..self }
    }

    /// Smaller is better; `None` unless every word matches. A typed name is the best match.
    fn rank(&self, typed: &str, words: &[String]) -> Option<(Reverse<u32>, usize, usize)> {
        let is_name = self.name.eq_ignore_ascii_case(typed);
        let score = self.entry.score(words)?.saturating_sub(self.loss);
        let score = if is_name { u32::MAX } else { score };
        Some((Reverse(score), self.entry.untyped(words), self.order))
    }

    fn in_full(&self) -> String {
        let keys = if self.keys.is_empty() { String::new() } else { format!(" ({})", self.keys) };
        format!("{}{keys}: {}", self.name, self.about)
    }
}

impl Dialog for Picker {
    fn place(&self) -> Place {
        Place::PICK
    }

    fn input(&mut self) -> Option<&mut Line> {
        Some(&mut self.input)
    }

    fn typed(&mut self) -> Vec<Work> {
        self.selected = 0;
        Vec::new()
    }

    fn step(&mut self, by: isize, _: &App) {
        let last = self.fitting().len().saturating_sub(1);
        self.selected = self.selected.saturating_add_signed(by).min(last);
    }

    fn click(&mut self, at: Position, app: &App) -> bool {
        let items = self.fitting();
        let (_, list, _) = self.areas(&items, app.inside(SIZE));
        let line = self.window(&items, list).line_at(at);
        line.is_some_and(|line| std::mem::replace(&mut self.selected, line) == line)
    }

    fn accept(&mut self, _: &App) -> Option<Change> {
        self.fitting().get(self.selected).map(|item| closing(&item.choice))
    }

    fn preview(&mut self) -> Option<(&mut PreviewPane, Option<Target>)> {
        let target = self.fitting().get(self.selected).and_then(|item| item.preview.clone());
        Some((self.preview.as_mut()?, target))
    }

    fn draw(&self, app: &App, buffer: &mut Buffer) -> Option<Position> {
        let theme = app.look.theme;
        let items = self.fitting();
        let inner = app.frame(self.title, SIZE, buffer);
        let (line, list, details) = self.areas(&items, inner);
        if let Some(preview) = &self.preview {
            self.window(&items, list).draw(|at| items[at].name.clone(), theme, buffer);
            draw_details(|width| preview.lines(width, app.look), details, buffer);
        } else {
            self.draw_items(&items, list, theme, buffer);
            if let Some(item) = items.get(self.selected) {
                let rule = Block::new().borders(Borders::TOP).border_style(theme.rule);
                let inner = text::framed(&rule, details, buffer);
                Text::from(said(&item.in_full(), Style::new(), inner.width)).render(inner, buffer);
            }
        }
        if items.is_empty() {
            Span::styled("No match.", theme.faint).render(list, buffer);
        }
        text::edited(&self.input, line, theme.focus, buffer)
    }
}

impl Picker {
    fn window(&self, items: &[Arc<Item>], area: Rect) -> Window {
        Window { count: items.len(), selected: Some(self.selected), area }
    }

    // The input line, the list, and the details: beside the list of examples, otherwise below. The
    // longest description has room, so that the list does not move.
    fn areas(&self, items: &[Arc<Item>], inner: Rect) -> (Rect, Rect, Rect) {
        let [line, list] = text::split(inner, 1);
        if self.preview.is_some() {
            let [left, right] = halves(list);
            return (line, left, right);
        }
        let lines = |item: &Arc<Item>| text::wrap(&item.in_full(), list.width.into()).len();
        let most = items.iter().map(lines).max().unwrap_or(0) as u16 + 1;
        let details = Constraint::Length(most.min(list.height / 3));
        let [list, details] = Layout::vertical([Constraint::Fill(1), details]).areas(list);
        (line, list, details)
    }

    // Name, keys, and as much of the description as fits.
    fn draw_items(&self, items: &[Arc<Item>], area: Rect, theme: &Theme, buffer: &mut Buffer) {
        let widest = |text: fn(&Item) -> &str, most: usize| {
            items.iter().map(|item| text(item).width().min(most)).max().unwrap_or(0)
        };
        let keys = widest(|item| &item.keys, KEYS);
        let name = widest(|item| &item.name, usize::from(area.width) * 2 / 5);
        let line = |at: usize| {
            let item = &items[at];
            let name = text::padded(&item.name, name);
            let gap = if keys == 0 { "" } else { "  " };
            let keys = text::padded(&item.keys, keys);
            format!("{name}{gap}{keys}  {}", item.about).trim_end().to_owned()
        };
        self.window(items, area).draw(line, theme, buffer);
    }
}
