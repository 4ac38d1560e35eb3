//! Lists with a filter: the palette of commands, the fields, materials, limits and examples.

use std::cmp::Reverse;

use super::item::{
    DESCRIBED, Item, Pick, VARIANT, command, example, field, graph, of_material, quantity, rank,
    result, variant, worker_chart,
};
use crate::case::fields::Kind;
use crate::case::{EXAMPLES, FIELDS};
use crate::model::{QUANTITIES, Quantity};
use crate::report::digest::Digest;
use crate::report::graphs::GRAPHS;
use crate::tui::commands::{self, Command};
use crate::tui::form_aids::{materials, search, search_results};
use crate::tui::jobs::WorkerChart;
use crate::tui::line::Line;

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
    /// Commands of the focused pane and field, which are listed first.
    pub(crate) own: Vec<Command>,
    /// Commands of other panes, which are listed last.
    pub(crate) elsewhere: Vec<Command>,
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
        let is_named = |place: &Place| place.score >= NAMED * words.len() as u32;
        let (named_places, described_places): (Vec<_>, Vec<_>) =
            places.into_iter().partition(is_named);
        let command = |(_, item): (usize, &Item)| item.clone();
        let place = |place: Place| place.item;
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
    fn places(&self) -> Vec<Place> {
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
            Place::new(score, rank, field(at))
        });
        let known = |quantity: &&'static Quantity| results.contains(&quantity.key);
        let found = search_results(typed)
            .into_iter()
            .filter_map(|(at, score)| Some((score, Some(&QUANTITIES[at]).filter(known)?)));
        let found = found.map(|(score, quantity)| {
            let score = scored(quantity.key, score);
            let order = (more_words(quantity.label), !are_results_first);
            let rank = (Reverse(score), order, true);
            Place::new(score, rank, result(quantity))
        });
        let mut places: Vec<Place> = if *are_results_first {
            found.chain(fields).collect()
        } else {
            fields.chain(found).collect()
        };
        if words > 0 {
            places.sort_by_key(|place| place.rank);
        }
        places
    }

    // The order in which commands are listed.
    fn distance(&self, command: Command) -> usize {
        let Context { own, elsewhere, .. } = &self.context;
        if own.contains(&command) { 0 } else { 1 + usize::from(elsewhere.contains(&command)) }
    }

    /// Moves the selection, within the list.
    pub(crate) fn mark(&mut self, by: isize) {
        let last = self.fitting().len().saturating_sub(1);
        self.marked = self.marked.saturating_add_signed(by).min(last);
    }

    fn items(&self) -> Vec<Item> {
        match &self.list {
            List::Commands => {
                let mut listed: Vec<_> = commands::commands().collect();
                listed.sort_by_key(|binding| self.distance(binding.command));
                let of_worker = (GRAPHS.len()..).zip(WorkerChart::ALL).map(worker_chart);
                let charts = GRAPHS.iter().enumerate().map(graph).chain(of_worker);
                listed.into_iter().map(command).chain(charts).collect()
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

/// A field or a result that matches.
struct Place {
    score: u32,
    rank: Rank,
    item: Item,
}

/// The score, then the number of label words that are not typed, then the kind that the focused
/// pane prefers, then the more frequent choice.
type Rank = (Reverse<u32>, (usize, bool), bool);

impl Place {
    fn new(score: u32, rank: Rank, item: Item) -> Place {
        Place { score, rank, item }
    }
}

#[cfg(test)]
mod tests;
