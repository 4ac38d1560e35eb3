//! Lists to pick from: an input line, the matching lines, and the details of the selected line.

use std::cmp::Reverse;

use ratatui::buffer::Buffer;
use ratatui::layout::{Constraint, Layout, Position, Rect, Size};
use ratatui::style::Style;
use ratatui::text::Span;
use ratatui::widgets::{Block, Borders, Widget};
use unicode_width::UnicodeWidthStr;

use super::boxes::{self, PreviewPane};
use super::{Dialog, Outcome, Surroundings};
use crate::case::fields::{Field, Kind};
use crate::case::units::System;
use crate::case::{EXAMPLES, Example, FIELDS};
use crate::model::{QUANTITIES, Quantity};
use crate::report::graphs::GRAPHS;
use crate::tui::form_aids::materials::{self, Material};
use crate::tui::form_aids::{COMMAND, Entry, HELP, LABEL, query};
use crate::tui::jobs::{Job, WorkerChart};
use crate::tui::keys::Place;
use crate::tui::line::Line;
use crate::tui::store::folder::{Preview, Target};
use crate::tui::text;
use crate::tui::theme::Theme;

/// Preferred size of a list.
const SIZE: Size = Size { width: 100, height: 20 };
/// Width of the keys of a command.
const KEYS: usize = 14;

/// Prefix of the name of a variant in the list of commands.
pub(crate) const VARIANT: &str = "variant";

/// Penalty of fields without effect: they follow similar fields, but a typed symbol still finds
/// them first.
const IDLE: u32 = 9;
/// The most frequent choice among fields with equal scores.
const FOREMOST: &str = "driven.tip_relief";

/// The effect of a line.
#[derive(Debug, Clone, Copy)]
pub(crate) enum Pick {
    /// Run the command with this name.
    Run(&'static str),
    /// Show the chart with this index.
    Chart(usize),
    /// Go to a field.
    Go(usize),
    /// Go to a result.
    Show(&'static Quantity),
    /// Give the gears a material.
    Make(&'static [&'static str], &'static Material),
    /// Set a limit on a quantity.
    Limit(&'static Quantity),
    /// Keep the edits as the variant with the typed name.
    Variant,
    /// Choose the second field of a map.
    Second(usize),
    /// Start a case from an example.
    Begin(&'static Example),
}

/// A line of a list.
#[derive(Debug, Clone)]
pub struct Item {
    /// The effect of Enter.
    pub(crate) pick: Pick,
    /// The name in the list.
    pub name: String,
    /// The description.
    pub(crate) about: String,
    pub(crate) keys: String,
}

/// A line with the texts that find it.
#[derive(Debug, Clone)]
struct Candidate {
    item: Item,
    entry: Entry,
    /// Penalty in the score.
    loss: u32,
    /// The order of candidates with equal scores.
    order: usize,
}

/// A list with an input line.
#[derive(Debug, Clone)]
pub struct Picker {
    title: &'static str,
    candidates: Vec<Candidate>,
    /// The typed text.
    pub(crate) input: Line,
    /// The index of the selected line among the matches.
    selected: usize,
    /// The preview beside the list of examples.
    preview: Option<PreviewPane>,
}

/// The focused pane and field, and the results and fields of the case, which decide the order of a
/// list.
#[derive(Debug, Clone, Default)]
pub(crate) struct Context {
    /// The keys of the present results.
    pub(crate) results: Vec<&'static str>,
    /// Whether results precede fields with equal scores.
    pub(crate) are_results_first: bool,
    /// The fields without effect in the case.
    pub(crate) idle: Vec<usize>,
    /// The commands, those of the focused pane and field first.
    pub(crate) commands: Vec<Item>,
}

impl Picker {
    fn new(title: &'static str, candidates: Vec<Candidate>) -> Picker {
        Picker { title, candidates, input: Line::default(), selected: 0, preview: None }
    }

    /// Every command; a typed word also finds fields and results.
    pub(crate) fn commands(context: &Context) -> Picker {
        let listed = context.commands.iter().cloned().map(Candidate::of_command);
        let graphs = GRAPHS.iter().map(|graph| {
            let symbols: Vec<_> = graph.all_columns().map(|column| column.symbol).collect();
            let about = format!("Show {} over the driver's roll angle.", symbols.join(", "));
            (graph.label, about)
        });
        let of_worker = WorkerChart::ALL.into_iter();
        let of_worker = of_worker.map(|chart| {
            let [name, about, _] = chart.words();
            (name, about.to_owned())
        });
        let charts = graphs.chain(of_worker).enumerate().map(|(at, (label, about))| {
            let name = format!("chart: {}", label.to_lowercase());
            let keys = String::new();
            Candidate::of_command(Item { pick: Pick::Chart(at), name, about, keys })
        });
        Picker::new("Commands", listed.chain(charts).chain(places(context)).collect())
    }

    /// Every field of the form, and every result.
    pub(crate) fn places(context: &Context) -> Picker {
        Picker::new("Go to a field or a result", places(context).collect())
    }

    /// Every material, for these gears.
    pub(crate) fn materials(gears: &'static [&'static str]) -> Picker {
        let title = match gears {
            ["driver"] => "Material of the driver",
            ["driven"] => "Material of the driven gear",
            _ => "Material of both gears",
        };
        let of_material = |material: &'static Material| {
            let Material { name, group, young, poisson, density, source, .. } = material;
            let about = format!("{young}, {poisson}, {density}, {group}; {source}");
            Candidate::named(Pick::Make(gears, material), name.clone(), about)
        };
        Picker::new(title, materials::all().iter().map(of_material).collect())
    }

    /// Every quantity that may have a limit.
    pub(crate) fn limits() -> Picker {
        let of_quantity = |quantity: &'static Quantity| {
            let about = format!("{} {}", quantity.symbol, quantity.label.trim_start());
            let entry = Entry::of_result(quantity);
            Candidate::new(Pick::Limit(quantity), quantity.key.to_owned(), about, entry)
        };
        Picker::new("Set a limit on a result", QUANTITIES.iter().map(of_quantity).collect())
    }

    /// Every field that a map can vary.
    pub(crate) fn second_field() -> Picker {
        let numbers = FIELDS.iter().enumerate();
        let numbers = numbers.filter(|(_, field)| !matches!(field.kind, Kind::Text));
        let numbers = numbers.map(|(at, field)| Candidate::of_field(Pick::Second(at), field));
        Picker::new("Second field of the map", numbers.collect())
    }

    /// The examples, with a preview of the selected one.
    pub(crate) fn examples() -> Picker {
        let of_example = |example: &'static Example| {
            let title = example.document().case.title().to_owned();
            Candidate::named(Pick::Begin(example), example.name.to_owned(), title)
        };
        let candidates = EXAMPLES.iter().map(of_example).collect();
        let picker = Picker::new("New case from an example", candidates);
        Picker { preview: Some(PreviewPane::default()), ..picker }
    }

    /// The lines that match every typed word, the best first.
    #[must_use]
    pub fn fitting(&self) -> Vec<Item> {
        if let Some(name) = self.variant_name() {
            let about =
                format!("Keep the edits as variant {name}, or show that variant in the form.");
            let name = format!("{VARIANT} {name}");
            return vec![Candidate::named(Pick::Variant, name, about).item];
        }
        let typed = self.input.value().trim();
        let words = query(typed);
        let has_commands = self.has_commands();
        let mut found: Vec<_> = self
            .candidates
            .iter()
            .filter(|candidate| {
                let is_command = matches!(candidate.item.pick, Pick::Run(_) | Pick::Chart(_));
                !typed.is_empty() || !has_commands || is_command
            })
            .filter_map(|candidate| Some((candidate.rank(typed, &words)?, &candidate.item)))
            .collect();
        if !words.is_empty() {
            found.sort_by_key(|(rank, _)| *rank);
        }
        found.into_iter().map(|(_, item)| item.clone()).collect()
    }

    /// The name of a variant, typed after the command.
    #[must_use]
    pub(crate) fn variant_name(&self) -> Option<&str> {
        let (command, name) = self.input.value().trim_start().split_once(' ')?;
        let is_meant = command == VARIANT && self.has_commands();
        Some(name.trim()).filter(|name| is_meant && !name.is_empty())
    }

    fn has_commands(&self) -> bool {
        matches!(self.candidates.first(), Some(first) if matches!(first.item.pick, Pick::Run(_)))
    }
}

/// The fields of the form and the present results, in the order that the context prefers.
fn places(context: &Context) -> impl Iterator<Item = Candidate> {
    let Context { results, are_results_first, idle, .. } = context;
    let (of_fields, of_results) = if *are_results_first { (2, 0) } else { (0, 2) };
    let fields = FIELDS.iter().enumerate().map(|(at, field)| Candidate {
        loss: if idle.contains(&at) { IDLE } else { 0 },
        order: of_fields + usize::from(field.key != FOREMOST),
        ..Candidate::of_field(Pick::Go(at), field)
    });
    let known = QUANTITIES.iter().filter(|quantity| results.contains(&quantity.key));
    let known = known.map(|quantity| {
        let Quantity { key, symbol, label, equation, .. } = quantity;
        let about = format!("{symbol} {}, a result; {equation}", label.trim_start());
        let entry = Entry::of_result(quantity);
        let result = Candidate::new(Pick::Show(quantity), (*key).to_owned(), about, entry);
        Candidate { order: of_results, ..result }
    });
    let mut places: Vec<_> = fields.chain(known).collect();
    places.sort_by_key(|place| place.order / 2);
    places.into_iter()
}

impl Candidate {
    fn new(pick: Pick, name: String, about: String, entry: Entry) -> Candidate {
        let item = Item { pick, name, about, keys: String::new() };
        Candidate { item, entry, loss: 0, order: 0 }
    }

    fn named(pick: Pick, name: String, about: String) -> Candidate {
        let entry = Entry::new("", &[(LABEL, &name), (HELP, &about)]);
        Candidate::new(pick, name, about, entry)
    }

    fn of_command(item: Item) -> Candidate {
        let entry = Entry::new("", &[(COMMAND, &item.name), (HELP, &item.about)]);
        Candidate { item, entry, loss: 0, order: 0 }
    }

    fn of_field(pick: Pick, field: &Field) -> Candidate {
        let about = format!("{} {}. {}", field.symbol, field.full_label(), field.help);
        let about = about.trim_start().to_owned();
        Candidate::new(pick, field.key.to_owned(), about, Entry::of_field(field))
    }

    /// Smaller is better; `None` unless every word matches. A typed name is the best match.
    fn rank(&self, typed: &str, words: &[String]) -> Option<(Reverse<u32>, usize, usize)> {
        let is_name = self.item.name.eq_ignore_ascii_case(typed);
        let score = self.entry.score(words)?.saturating_sub(self.loss);
        let score = if is_name { u32::MAX } else { score };
        Some((Reverse(score), self.entry.untyped(words), self.order))
    }
}

impl Dialog for Picker {
    fn place(&self) -> Place {
        Place::PICK
    }

    fn input(&mut self) -> Option<&mut Line> {
        Some(&mut self.input)
    }

    fn typed(&mut self) -> Vec<Job> {
        self.selected = 0;
        Vec::new()
    }

    fn step(&mut self, by: isize, _: &Surroundings<'_>) {
        let last = self.fitting().len().saturating_sub(1);
        self.selected = self.selected.saturating_add_signed(by).min(last);
    }

    fn click(&mut self, at: Position, screen: Rect) -> bool {
        let items = self.fitting();
        let (_, list, _) = self.areas(&items, boxes::inside(SIZE, screen));
        boxes::line_at(items.len(), Some(self.selected), list, at)
            .is_some_and(|line| boxes::select(&mut self.selected, line))
    }

    fn accept(&mut self, _: &Surroundings<'_>) -> Outcome {
        let item = self.fitting().into_iter().nth(self.selected);
        item.map_or_else(Outcome::none, |item| Outcome::Pick(item.pick))
    }

    fn preview(&mut self, units: System) -> Option<Job> {
        let example = self.fitting().get(self.selected).and_then(|item| match item.pick {
            Pick::Begin(example) => Some(Target::Example(example)),
            _ => None,
        });
        self.preview.as_mut()?.request(example, units)
    }

    fn show(&mut self, target: &Target, preview: Preview) {
        if let Some(pane) = &mut self.preview {
            pane.show(target, preview);
        }
    }

    fn draw(&self, around: &Surroundings<'_>, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        let theme = around.look.theme;
        let items = self.fitting();
        let inner = boxes::frame(self.title, SIZE, area, theme, buffer);
        let (line, list, details) = self.areas(&items, inner);
        if let Some(preview) = &self.preview {
            let name = |at: usize| items[at].name.clone();
            boxes::draw_window(items.len(), name, Some(self.selected), list, theme, buffer);
            boxes::draw_details(|width| preview.lines(width, theme), details, buffer);
        } else {
            self.draw_items(&items, list, theme, buffer);
            if let Some(item) = items.get(self.selected) {
                let rule = Block::new().borders(Borders::TOP).border_style(theme.rule);
                let inner = rule.inner(details);
                let lines: Vec<_> =
                    boxes::said(&item.in_full(), Style::new(), inner.width).collect();
                rule.render(details, buffer);
                text::draw_lines(&lines, inner, buffer);
            }
        }
        if items.is_empty() {
            Span::styled("No match.", theme.faint).render(list, buffer);
        }
        text::edited(&self.input, line, theme.focus, buffer)
    }
}

impl Picker {
    // The input line, the list, and the details: beside the list of examples, otherwise below. The
    // longest description has room, so that the list does not move.
    fn areas(&self, items: &[Item], inner: Rect) -> (Rect, Rect, Rect) {
        let [line, list] = boxes::input_above(inner);
        if self.preview.is_some() {
            let [left, right] = boxes::halves(list);
            return (line, left, right);
        }
        let lines = |item: &Item| text::wrap(&item.in_full(), list.width.into()).len();
        let most = items.iter().map(lines).max().unwrap_or(0) as u16 + 1;
        let details = Constraint::Length(most.min(list.height / 3));
        let [list, details] = Layout::vertical([Constraint::Fill(1), details]).areas(list);
        (line, list, details)
    }

    // Name, keys, and as much of the description as fits.
    fn draw_items(&self, items: &[Item], area: Rect, theme: &Theme, buffer: &mut Buffer) {
        let widest = |text: fn(&Item) -> &str, most: usize| {
            items.iter().map(|item| text(item).width().min(most)).max().unwrap_or(0)
        };
        let keys = widest(|item| &item.keys, KEYS);
        let name = widest(|item| &item.name, usize::from(area.width) * 2 / 5);
        let line = |at: usize| {
            let item: &Item = &items[at];
            let name = text::padded(&item.name, name);
            let keys = match keys {
                0 => String::new(),
                _ => format!("  {}", text::padded(&item.keys, keys)),
            };
            format!("{name}{keys}  {}", item.about).trim_end().to_owned()
        };
        boxes::draw_window(items.len(), line, Some(self.selected), area, theme, buffer);
    }
}

impl Item {
    fn in_full(&self) -> String {
        let keys = if self.keys.is_empty() { String::new() } else { format!(" ({})", self.keys) };
        format!("{}{keys}: {}", self.name, self.about)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    use crate::tui::store;
    use crate::tui::theme::Look;
    use crate::tui::update::{commands, opened};

    type List = fn(&Context) -> Picker;

    fn context() -> Context {
        let app = opened(store::built_in(), None, Look::FULL, Size::new(80, 24));
        Context { commands: commands::items(&app), ..Context::default() }
    }

    fn found(list: List, context: &Context, typed: &str) -> Vec<String> {
        let picker = Picker { input: typed.into(), ..list(context) };
        picker.fitting().into_iter().map(|item| item.name).collect()
    }

    fn first(list: List, typed: &str) -> Option<String> {
        found(list, &context(), typed).into_iter().next()
    }

    #[test]
    fn a_few_letters_find_the_command() {
        for (typed, name) in [
            ("und", "undo"),
            ("save a", "save as"),
            ("base", "baseline"),
            ("themme", "theme"),
            ("colours", "theme"),
        ] {
            assert_eq!(first(Picker::commands, typed).as_deref(), Some(name), "{typed}");
        }
        for (typed, name) in [
            ("next tab", "next case"),
            ("switch", "switch"),
            ("compare", "baseline"),
            ("static", "method static"),
            ("dynamic", "method dynamic"),
            ("method", "method"),
        ] {
            let results = QUANTITIES.iter().map(|quantity| quantity.key).collect();
            let context = Context { results, are_results_first: true, ..context() };
            let found = found(Picker::commands, &context, typed);
            assert!(found.iter().take(3).any(|one| one == name), "{typed}: {found:?}");
        }
        assert_eq!(first(Picker::commands, "xyzzy"), None);
    }

    #[test]
    fn a_field_is_found_by_key_label_and_symbol() {
        for (typed, key) in [
            ("speed", "operation.speed"),
            ("driven face", "driven.face_width"),
            ("rho2", "driven.density"),
            ("backl", "deviations.backlash"),
            ("ca1", "driver.tip_relief"),
        ] {
            assert_eq!(first(Picker::places, typed).as_deref(), Some(key), "{typed}");
        }
    }

    #[test]
    fn fields_with_effect_come_first_unless_a_symbol_is_typed() {
        let idle: Vec<_> = (0..FIELDS.len())
            .filter(|&at| FIELDS[at].key.starts_with("driver.tip_relief"))
            .collect();
        for (typed, key) in [
            ("relief", "driven.tip_relief"),
            ("tip relief", "driven.tip_relief"),
            ("driver tip relief", "driver.tip_relief"),
            ("ca1", "driver.tip_relief"),
        ] {
            let context = Context { idle: idle.clone(), ..context() };
            assert_eq!(found(Picker::places, &context, typed)[0], key, "{typed}");
        }
    }

    #[test]
    fn a_field_comes_before_a_result_with_a_longer_name() {
        for are_results_first in [false, true] {
            let context = Context {
                results: QUANTITIES.iter().map(|quantity| quantity.key).collect(),
                are_results_first,
                ..context()
            };
            for (typed, name) in [
                ("tip rel", "driven.tip_relief"),
                ("impact force", "impact_force"),
                (
                    "combined deflection",
                    ["model.deflection", "combined_deflection"][usize::from(are_results_first)],
                ),
            ] {
                for list in [Picker::commands, Picker::places] {
                    assert_eq!(found(list, &context, typed)[0], name, "{typed}");
                }
            }
        }
    }

    #[test]
    fn a_typed_key_is_the_first_match() {
        let fields = FIELDS.iter().map(|field| field.key);
        let results: Vec<_> = QUANTITIES.iter().map(|quantity| quantity.key).collect();
        for are_results_first in [false, true] {
            let context = Context {
                results: results.clone(),
                are_results_first,
                idle: (0..FIELDS.len()).collect(),
                ..context()
            };
            for key in fields.clone().chain(results.iter().copied()) {
                assert_eq!(found(Picker::places, &context, key)[0], key);
            }
        }
    }

    #[test]
    fn a_list_of_fields_names_the_gear() {
        let items = Picker::places(&context()).fitting();
        for gear in ["driver", "driven"] {
            let own = items.iter().filter(|item| item.name.starts_with(gear));
            assert!(own.clone().count() > 10);
            for item in own {
                let (_, label) = item.about.split_once(' ').unwrap();
                assert!(label.starts_with(&format!("{gear} ")), "{}", item.about);
            }
        }
    }

    #[test]
    fn an_empty_filter_shows_the_whole_list() {
        let all = Picker::commands(&context()).fitting();
        let charts = GRAPHS.len() + WorkerChart::ALL.len();
        assert_eq!(all.len(), context().commands.len() + charts);
        assert_eq!(Picker::places(&context()).fitting().len(), FIELDS.len());
    }
}
