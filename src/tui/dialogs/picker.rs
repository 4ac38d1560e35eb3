//! Lists to pick from: an input line, the matching lines, and the details of the selected line.

use std::cmp::Reverse;

use ratatui::buffer::Buffer;
use ratatui::layout::{Position, Rect, Size};
use ratatui::style::Style;
use unicode_width::UnicodeWidthStr;

use super::boxes::{self, draw_window, frame, halves, inside, line_at, parted};
use super::{Dialog, Outcome, Surroundings};
use crate::case::fields::Kind;
use crate::case::{EXAMPLES, Example, FIELDS};
use crate::model::{QUANTITIES, Quantity};
use crate::report::digest::Digest;
use crate::report::graphs::{GRAPHS, Graph};
use crate::tui::ascii::symbol;
use crate::tui::form_aids::materials::{self, Material};
use crate::tui::form_aids::{search, search_results};
use crate::tui::jobs::{Job, WorkerChart};
use crate::tui::keys::Place;
use crate::tui::line::Line;
use crate::tui::text;
use crate::tui::theme::Theme;

/// Preferred size of a list.
const SIZE: Size = Size { width: 100, height: 20 };
/// Width of the keys of a command.
const KEYS: usize = 14;

/// Prefix of the name of a variant in the list of commands.
pub(crate) const VARIANT: &str = "variant";
/// The rank of a word that occurs only in the description.
const DESCRIBED: usize = 100;

/// Least similarity of a name that is listed when no name contains the typed words.
const LIKENESS: f64 = 0.75;
/// The least score per word of a field or a result whose name matches.
const NAMED: u32 = 65;
/// Penalty of fields without effect: they follow similar fields, but a typed symbol still finds
/// them first.
const IDLE: u32 = 9;
/// The most frequent choice among fields with equal scores.
const FOREMOST: &str = "driven.tip_relief";
/// Longer texts are not compared with names.
const LONGEST_NAME: usize = 64;

impl Dialog for Picker {
    fn place(&self) -> Place {
        Place::PICK
    }

    fn input(&mut self) -> Option<&mut Line> {
        Some(&mut self.input)
    }

    fn typed(&mut self) -> Vec<Job> {
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

    fn draw(&self, around: &Surroundings<'_>, area: Rect, buffer: &mut Buffer) -> Option<Position> {
        draw(self, area, around.look.theme, buffer)
    }
}

/// The effect of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pick {
    /// Run the command with this name.
    Run(&'static str),
    /// Show the chart with this index.
    Chart(usize),
    /// Go to a field.
    Go(usize),
    /// Go to a result, by its key.
    Show(&'static str),
    /// Give the gears a material.
    Make(&'static [&'static str], &'static Material),
    /// Set a limit on a quantity.
    Limit(&'static str),
    /// Keep the edits as the variant with the typed name.
    Variant,
    /// Choose the second field of a map.
    Second(usize),
    /// Start a case from an example.
    Begin(&'static Example),
}

/// A line of a list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Item {
    /// The effect of Enter.
    pub(crate) pick: Pick,
    /// The name in the list.
    pub name: String,
    /// The description.
    pub(crate) about: String,
    pub(crate) keys: String,
}

/// A list with an input line.
#[derive(Debug, Clone)]
pub struct Picker {
    /// The contents.
    pub(crate) list: List,
    /// The typed text.
    pub(crate) input: Line,
    /// The index of the selected line among the matches.
    pub(crate) marked: usize,
    /// The focused pane and field, and the results and fields of the case.
    pub(crate) context: Context,
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

/// The contents of a list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub(crate) enum List {
    /// Every command.
    Commands,
    /// Every field of the form, and every result.
    Places,
    /// Every material, for these gears.
    Materials(&'static [&'static str]),
    /// Every quantity that may have a limit.
    Limits,
    /// Every field that a map can vary.
    SecondField,
    /// The examples, each with its digest once it is solved.
    Examples(Vec<Digest>),
}

impl Picker {
    /// The whole list.
    #[must_use]
    pub(crate) fn new(list: List) -> Picker {
        Picker { list, input: Line::default(), marked: 0, context: Context::default() }
    }

    /// The whole list, in the order of a context.
    #[must_use]
    pub(crate) fn over(list: List, context: Context) -> Picker {
        Picker { context, ..Picker::new(list) }
    }

    #[must_use]
    pub(crate) fn title(&self) -> &'static str {
        match self.list {
            List::Commands => "Commands",
            List::Places => "Go to a field or a result",
            List::Materials(["driver"]) => "Material of the driver",
            List::Materials(["driven"]) => "Material of the driven gear",
            List::Materials(_) => "Material of both gears",
            List::Limits => "Set a limit on a result",
            List::SecondField => "Second field of the map",
            List::Examples(_) => "New case from an example",
        }
    }

    /// The lines that contain every typed word, matches in the name first; if there are none, the
    /// lines with the most similar names.
    #[must_use]
    pub fn fitting(&self) -> Vec<Item> {
        if self.list == List::Places {
            return self.places().into_iter().map(|place| place.item).collect();
        }
        if let Some(name) = self.variant_name() {
            return vec![variant(name)];
        }
        let typed = self.input.value().to_lowercase();
        let words: Vec<&str> = typed.split_whitespace().collect();
        let items = self.items();
        let mut fitting: Vec<_> =
            items.iter().filter_map(|item| Some((rank(item, &words)?, item))).collect();
        let places = if self.list == List::Commands && !words.is_empty() {
            self.places()
        } else {
            Vec::new()
        };
        if fitting.is_empty() && places.is_empty() && typed.len() <= LONGEST_NAME {
            let likeness = |item: &Item| strsim::jaro_winkler(&typed, &item.name.to_lowercase());
            let alike = items
                .iter()
                .map(|item| (likeness(item), item))
                .filter(|(likeness, _)| *likeness > LIKENESS);
            fitting =
                alike.map(|(likeness, item)| (((1.0 - likeness) * 1e3) as usize, item)).collect();
        }
        fitting.sort_by_key(|(rank, _)| *rank);
        // Matches in the name rank before matches in the description.
        let (named, described): (Vec<_>, Vec<_>) =
            fitting.into_iter().partition(|(rank, _)| *rank < DESCRIBED);
        let is_named = |place: &MatchPlace| place.score >= NAMED * words.len() as u32;
        let (named_places, described_places): (Vec<_>, Vec<_>) =
            places.into_iter().partition(is_named);
        let command = |(_, item): (usize, &Item)| item.clone();
        let place = |place: MatchPlace| place.item;
        let named = named.into_iter().map(command);
        let described = described.into_iter().map(command);
        named
            .chain(named_places.into_iter().map(place))
            .chain(described)
            .chain(described_places.into_iter().map(place))
            .collect()
    }

    /// The name of a variant, typed after the command.
    #[must_use]
    pub(crate) fn variant_name(&self) -> Option<&str> {
        let (command, name) = self.input.value().trim_start().split_once(' ')?;
        let is_meant = self.list == List::Commands && command == VARIANT;
        Some(name.trim()).filter(|name| is_meant && !name.is_empty())
    }

    // The matching fields and results, the best first. Without a typed word they are in the order
    // of form and results.
    fn places(&self) -> Vec<MatchPlace> {
        let typed = self.input.value();
        let Context { results, are_results_first, idle, .. } = &self.context;
        let words = typed.split_whitespace().count();
        let more_words = |label: &str| label.split_whitespace().count().saturating_sub(words);
        // A typed key ranks before all other matches.
        let scored = |key: &str, score| {
            let is_key = key.eq_ignore_ascii_case(typed.trim());
            if is_key { u32::MAX } else { score }
        };
        let fields = search(typed).into_iter().map(|(at, score)| {
            let score = scored(FIELDS[at].key, score);
            let loss = if idle.contains(&at) { IDLE } else { 0 };
            let order = (more_words(FIELDS[at].label), *are_results_first);
            let is_later = FIELDS[at].key != FOREMOST;
            let rank = (Reverse(score.saturating_sub(loss)), order, is_later);
            MatchPlace::new(score, rank, field(at))
        });
        let known = |quantity: &&'static Quantity| results.contains(&quantity.key);
        let found = search_results(typed)
            .into_iter()
            .filter_map(|(at, score)| Some((score, Some(&QUANTITIES[at]).filter(known)?)));
        let found = found.map(|(score, quantity)| {
            let score = scored(quantity.key, score);
            let order = (more_words(quantity.label), !are_results_first);
            let rank = (Reverse(score), order, true);
            MatchPlace::new(score, rank, result(quantity))
        });
        let mut places: Vec<MatchPlace> = if *are_results_first {
            found.chain(fields).collect()
        } else {
            fields.chain(found).collect()
        };
        if words > 0 {
            places.sort_by_key(|place| place.rank);
        }
        places
    }

    /// Moves the selection, within the list.
    pub(crate) fn mark(&mut self, by: isize) {
        let last = self.fitting().len().saturating_sub(1);
        self.marked = self.marked.saturating_add_signed(by).min(last);
    }

    fn items(&self) -> Vec<Item> {
        match &self.list {
            List::Commands => {
                let of_worker = (GRAPHS.len()..).zip(WorkerChart::ALL).map(worker_chart);
                let charts = GRAPHS.iter().enumerate().map(graph).chain(of_worker);
                self.context.commands.iter().cloned().chain(charts).collect()
            }
            List::Places => Vec::new(),
            List::Materials(gears) => {
                materials::all().iter().map(|material| of_material(gears, material)).collect()
            }
            List::Limits => QUANTITIES.iter().map(quantity).collect(),
            List::SecondField => (0..FIELDS.len())
                .filter(|&at| !matches!(FIELDS[at].kind, Kind::Text))
                .map(|at| Item { pick: Pick::Second(at), ..field(at) })
                .collect(),
            List::Examples(digests) => {
                EXAMPLES.iter().enumerate().map(|(at, one)| example(one, digests.get(at))).collect()
            }
        }
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
        .map(|digest| boxes::digest_lines(digest, right.width.into(), theme));
    for ((line, style), y) in lines.unwrap_or_default().iter().zip(right.top()..right.bottom()) {
        buffer.set_stringn(right.x, y, line, right.width.into(), *style);
    }
}

fn say_if_none(items: &[Item], area: Rect, theme: &Theme, buffer: &mut Buffer) {
    if items.is_empty() && !area.is_empty() {
        buffer.set_stringn(area.x, area.y, "No match.", area.width.into(), theme.faint);
    }
}

fn variant(name: &str) -> Item {
    Item {
        pick: Pick::Variant,
        name: format!("{VARIANT} {name}"),
        about: format!("Keep the edits as variant {name}, or show that variant in the form."),
        keys: String::new(),
    }
}

fn graph((place, graph): (usize, &Graph)) -> Item {
    let symbols: Vec<_> = graph.all_columns().map(|column| column.symbol).collect();
    Item {
        pick: Pick::Chart(place),
        name: format!("chart: {}", graph.label.to_lowercase()),
        about: format!("Show {} over the driver's roll angle.", symbols.join(", ")),
        keys: String::new(),
    }
}

fn worker_chart((place, chart): (usize, WorkerChart)) -> Item {
    let [name, about, _] = chart.words();
    Item {
        pick: Pick::Chart(place),
        name: format!("chart: {}", name.to_lowercase()),
        about: about.to_owned(),
        keys: String::new(),
    }
}

fn field(index: usize) -> Item {
    let field = &FIELDS[index];
    Item {
        pick: Pick::Go(index),
        name: field.key.to_owned(),
        about: format!("{} {}. {}", field.symbol, field.full_label(), field.help)
            .trim_start()
            .to_owned(),
        keys: String::new(),
    }
}

fn of_material(gears: &'static [&'static str], material: &'static Material) -> Item {
    let Material { name, group, young, poisson, density, source, .. } = material;
    Item {
        pick: Pick::Make(gears, material),
        name: name.clone(),
        about: format!("{young}, {poisson}, {density}, {group}; {source}"),
        keys: String::new(),
    }
}

fn result(quantity: &'static Quantity) -> Item {
    let Quantity { key, symbol, label, equation, .. } = quantity;
    let about = format!("{symbol} {}, a result; {equation}", label.trim_start());
    Item { pick: Pick::Show(key), name: (*key).to_owned(), about, keys: String::new() }
}

fn quantity(quantity: &'static Quantity) -> Item {
    Item {
        pick: Pick::Limit(quantity.key),
        name: quantity.key.to_owned(),
        about: format!("{} {}", quantity.symbol, quantity.label.trim_start()),
        keys: String::new(),
    }
}

fn example(example: &'static Example, digest: Option<&Digest>) -> Item {
    let about =
        digest.map_or_else(String::new, |digest| format!("{}: {}", digest.title, digest.verdict()));
    Item { pick: Pick::Begin(example), name: example.name.to_owned(), about, keys: String::new() }
}

// The rank of a line, smaller is better; `None` if a word does not match. Symbols may be typed in
// ASCII.
fn rank(item: &Item, words: &[&str]) -> Option<usize> {
    let name = item.name.to_lowercase();
    let about = item.about.to_lowercase();
    let written_out = symbol(&item.about, true).to_lowercase();
    let rank_of = |word: &&str| {
        let begins = name.split(['.', '_', ' ', '/']).any(|part| part.starts_with(*word));
        let occurs = about.contains(*word) || written_out.contains(*word);
        match (name.starts_with(*word), begins, name.contains(*word), occurs) {
            (true, ..) => Some(0),
            (_, true, ..) => Some(1),
            (_, _, true, _) => Some(2),
            (.., true) => Some(DESCRIBED),
            _ => None,
        }
    };
    words.iter().map(rank_of).sum()
}

/// A field or a result that matches.
struct MatchPlace {
    score: u32,
    rank: Rank,
    item: Item,
}

/// The score, then the number of label words that are not typed, then the kind that the focused
/// pane prefers, then the more frequent choice.
type Rank = (Reverse<u32>, (usize, bool), bool);

impl MatchPlace {
    fn new(score: u32, rank: Rank, item: Item) -> MatchPlace {
        MatchPlace { score, rank, item }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::tui::store;
    use crate::tui::theme::Look;
    use crate::tui::update::{commands, opened};

    fn context() -> Context {
        let app = opened(store::built_in(), None, Look::FULL, Size::new(80, 24));
        Context { commands: commands::items(&app), ..Context::default() }
    }

    fn first(list: List, typed: &str) -> Option<String> {
        let picker = Picker { input: typed.into(), ..Picker::over(list, context()) };
        picker.fitting().into_iter().next().map(|item| item.name)
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
            assert_eq!(first(List::Commands, typed).as_deref(), Some(name), "{typed}");
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
            let picker = Picker {
                input: typed.into(),
                ..Picker::over(
                    List::Commands,
                    Context { results, are_results_first: true, ..context() },
                )
            };
            let found =
                picker.fitting().into_iter().take(3).map(|item| item.name).collect::<Vec<_>>();
            assert!(found.contains(&name.to_owned()), "{typed}: {found:?}");
        }
        assert_eq!(first(List::Commands, "xyzzy"), None);
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
            assert_eq!(first(List::Places, typed).as_deref(), Some(key), "{typed}");
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
            let picker = Picker {
                input: typed.into(),
                ..Picker::over(List::Places, Context { idle: idle.clone(), ..Context::default() })
            };
            assert_eq!(picker.fitting()[0].name, key, "{typed}");
        }
    }

    #[test]
    fn a_field_comes_before_a_result_with_a_longer_name() {
        for are_results_first in [false, true] {
            let context = Context {
                results: QUANTITIES.iter().map(|quantity| quantity.key).collect(),
                are_results_first,
                ..Context::default()
            };
            for (typed, name) in [
                ("tip rel", "driven.tip_relief"),
                ("impact force", "impact_force"),
                (
                    "combined deflection",
                    ["model.deflection", "combined_deflection"][usize::from(are_results_first)],
                ),
            ] {
                for list in [List::Commands, List::Places] {
                    let picker =
                        Picker { input: typed.into(), ..Picker::over(list, context.clone()) };
                    assert_eq!(picker.fitting()[0].name, name, "{typed}");
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
                ..Context::default()
            };
            for key in fields.clone().chain(results.iter().copied()) {
                let picker =
                    Picker { input: key.into(), ..Picker::over(List::Places, context.clone()) };
                assert_eq!(picker.fitting()[0].name, key);
            }
        }
    }

    #[test]
    fn a_list_of_fields_names_the_gear() {
        let items = Picker::new(List::Places).fitting();
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
        let all = Picker::over(List::Commands, context()).fitting();
        let charts = GRAPHS.len() + WorkerChart::ALL.len();
        assert_eq!(all.len(), context().commands.len() + charts);
        assert_eq!(Picker::new(List::Places).fitting().len(), FIELDS.len());
    }
}
