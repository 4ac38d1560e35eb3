//! Lists that are filtered by what is typed: the palette of commands, the fields, materials,
//! limits, examples.

use std::cmp::Reverse;

use super::ascii::symbol;
use super::commands::{self, Command};
use super::line::Line;
use super::panes::chart::ChartCommand;
use crate::case::materials::{self, Material};
use crate::case::{EXAMPLES, Example, FIELDS, search};
use crate::model::{QUANTITIES, Quantity};
use crate::report::digest::Digest;
use crate::report::graphs::{GRAPHS, Graph};

/// A name must be this like what is typed to be offered when nothing contains it.
const LIKENESS: f64 = 0.75;
/// How far behind a line stands that merely tells of a word.
const TOLD: usize = 100;
/// The least score for each word of a field or a result that is called so.
const CALLED: u32 = 65;
/// By so much a field that makes no difference fits less: behind its like, yet before others where
/// its very symbol is typed.
const IDLE: u32 = 9;
/// Of fields that fit alike the one that is meant most often.
const FOREMOST: &str = "driven.tip_relief";
/// What is longer is like no name, and would take long to compare.
const LONGEST_NAME: usize = 64;

/// A list under a line of text.
#[derive(Debug, Clone)]
pub struct Picker {
    /// What is listed.
    pub list: List,
    /// What is typed.
    pub input: Line,
    /// The marked one of those that fit.
    pub marked: usize,
    /// The results that may be gone to, by their keys, and whether they come before the fields.
    pub results: (Vec<&'static str>, bool),
    /// The fields that make no difference in the case.
    pub idle: Vec<usize>,
}

/// What is listed.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum List {
    /// Every command.
    Commands,
    /// Every field of the form, and every result.
    Places,
    /// Every material, for these gears.
    Materials(&'static [&'static str]),
    /// Every quantity that may be held to a limit.
    Limits,
    /// The examples, each with its digest as soon as it is there.
    Examples(Vec<Digest>),
}

/// What is picked.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pick {
    /// Run a command.
    Run(Command),
    /// Go to a field.
    Go(usize),
    /// Go to a result, by its key.
    Show(&'static str),
    /// Make the gears of a material.
    Make(&'static [&'static str], &'static Material),
    /// Hold a quantity to a limit.
    Limit(&'static str),
    /// Begin a case with an example.
    Begin(&'static Example),
}

/// A line of a list.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Item {
    /// What Enter does.
    pub pick: Pick,
    /// By what it is called.
    pub name: String,
    /// What more there is to say.
    pub about: String,
    /// Its keys.
    pub keys: String,
}

impl Picker {
    /// The whole list.
    #[must_use]
    pub fn new(list: List) -> Picker {
        Picker {
            list,
            input: Line::default(),
            marked: 0,
            results: (Vec::new(), false),
            idle: Vec::new(),
        }
    }

    /// The whole list, with these results, by their keys, and whether they come before the fields;
    /// and the fields that make no difference, which come after those that do.
    #[must_use]
    pub fn over(
        list: List,
        results: Vec<&'static str>,
        are_first: bool,
        idle: Vec<usize>,
    ) -> Picker {
        Picker {
            results: (results, are_first),
            idle,
            ..Picker::new(list)
        }
    }

    /// In a few words.
    #[must_use]
    pub fn title(&self) -> &'static str {
        match self.list {
            List::Commands => "Commands",
            List::Places => "Go to a field or a result",
            List::Materials(["driver"]) => "Material of the driver",
            List::Materials(["driven"]) => "Material of the driven gear",
            List::Materials(_) => "Material of both gears",
            List::Limits => "Hold to a limit",
            List::Examples(_) => "New from an example",
        }
    }

    /// The lines in which every typed word occurs, those that begin with it first; else those that
    /// are most like it.
    #[must_use]
    pub fn fitting(&self) -> Vec<Item> {
        if self.list == List::Places {
            return self.places().into_iter().map(|(_, item)| item).collect();
        }
        let typed = self.input.value().to_lowercase();
        let words: Vec<&str> = typed.split_whitespace().collect();
        let items = self.items();
        let mut fitting: Vec<_> = items
            .iter()
            .filter_map(|item| Some((rank(item, &words)?, item)))
            .collect();
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
            fitting = alike
                .map(|(likeness, item)| (((1.0 - likeness) * 1e3) as usize, item))
                .collect();
        }
        fitting.sort_by_key(|(rank, _)| *rank);
        // What is called so comes before what is merely told with that word.
        let (called, told): (Vec<_>, Vec<_>) =
            fitting.into_iter().partition(|(rank, _)| *rank < TOLD);
        let commands = |found: Vec<(usize, &Item)>| {
            found
                .into_iter()
                .map(|(_, item)| item.clone())
                .collect::<Vec<_>>()
        };
        let is_called = |(score, _): &(u32, Item)| *score >= CALLED * words.len() as u32;
        let (called_places, told_places): (Vec<_>, Vec<_>) =
            places.into_iter().partition(is_called);
        let places =
            |found: Vec<(u32, Item)>| found.into_iter().map(|(_, item)| item).collect::<Vec<_>>();
        [
            commands(called),
            places(called_places),
            commands(told),
            places(told_places),
        ]
        .concat()
    }

    // The fields and the results that fit, the best first of each, with their scores.
    fn places(&self) -> Vec<(u32, Item)> {
        let typed = self.input.value();
        let (known, are_first) = &self.results;
        let mut fields = search::search(typed);
        fields.sort_by_key(|&(at, score)| self.rank_of_field(at, score));
        let fields: Vec<_> = fields
            .into_iter()
            .map(|(at, score)| (score, field(at)))
            .collect();
        let results = search::search_results(typed)
            .into_iter()
            .map(|(at, score)| (score, &QUANTITIES[at]));
        let results = results.filter(|(_, quantity)| known.contains(&quantity.key));
        let results = results
            .map(|(score, quantity)| (score, result(quantity)))
            .collect();
        if *are_first {
            [results, fields].concat()
        } else {
            [fields, results].concat()
        }
    }

    // Of what fits alike that comes first which makes a difference in the case. Without a word the
    // order of the form stays.
    fn rank_of_field(&self, at: usize, score: u32) -> (Reverse<u32>, bool) {
        let loss = if self.idle.contains(&at) { IDLE } else { 0 };
        (
            Reverse(score.saturating_sub(loss)),
            score > 0 && FIELDS[at].key != FOREMOST,
        )
    }

    /// Move the mark, as far as there are lines.
    pub fn mark(&mut self, by: isize) {
        let last = self.fitting().len().saturating_sub(1);
        self.marked = self.marked.saturating_add_signed(by).min(last);
    }

    fn items(&self) -> Vec<Item> {
        match &self.list {
            List::Commands => commands::commands()
                .map(command)
                .chain(GRAPHS.iter().enumerate().map(graph))
                .collect(),
            List::Places => Vec::new(),
            List::Materials(gears) => materials::all()
                .iter()
                .map(|material| of_material(gears, material))
                .collect(),
            List::Limits => QUANTITIES.iter().map(quantity).collect(),
            List::Examples(digests) => EXAMPLES
                .iter()
                .enumerate()
                .map(|(at, one)| example(one, digests.get(at)))
                .collect(),
        }
    }
}

fn command(binding: &commands::Binding) -> Item {
    Item {
        pick: Pick::Run(binding.command),
        name: binding.name.to_owned(),
        about: binding.sentence.to_owned(),
        keys: commands::keys_of(binding.command),
    }
}

fn graph((place, graph): (usize, &Graph)) -> Item {
    let symbols: Vec<_> = graph.all_columns().map(|column| column.symbol).collect();
    Item {
        pick: Pick::Run(Command::Chart(ChartCommand::Select(place))),
        name: format!("chart: {}", graph.label.to_lowercase()),
        about: format!("Show {} over the driver's roll angle.", symbols.join(", ")),
        keys: String::new(),
    }
}

fn field(index: usize) -> Item {
    let field = &FIELDS[index];
    Item {
        pick: Pick::Go(index),
        name: field.key.to_owned(),
        about: format!("{} {}. {}", field.symbol, field.label, field.help)
            .trim_start()
            .to_owned(),
        keys: String::new(),
    }
}

fn of_material(gears: &'static [&'static str], material: &'static Material) -> Item {
    let Material {
        name,
        group,
        young,
        poisson,
        density,
        source,
        ..
    } = material;
    Item {
        pick: Pick::Make(gears, material),
        name: name.clone(),
        about: format!("{young}, {poisson}, {density}, {group}; {source}"),
        keys: String::new(),
    }
}

fn result(quantity: &'static Quantity) -> Item {
    let Quantity {
        key,
        symbol,
        label,
        equation,
        ..
    } = quantity;
    let about = format!("{symbol} {}, a result; {equation}", label.trim_start());
    Item {
        pick: Pick::Show(key),
        name: (*key).to_owned(),
        about,
        keys: String::new(),
    }
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
    let about = digest.map_or_else(String::new, |digest| {
        format!("{}: {}", digest.title, digest.verdict())
    });
    Item {
        pick: Pick::Begin(example),
        name: example.name.to_owned(),
        about,
        keys: String::new(),
    }
}

// The less the better; none where a word does not occur. Symbols may be typed as a bare keyboard
// can.
fn rank(item: &Item, words: &[&str]) -> Option<usize> {
    let name = item.name.to_lowercase();
    let about = item.about.to_lowercase();
    let written_out = symbol(&item.about, true).to_lowercase();
    let rank_of = |word: &&str| {
        let begins = name
            .split(['.', '_', ' ', '/'])
            .any(|part| part.starts_with(*word));
        let occurs = about.contains(*word) || written_out.contains(*word);
        match (
            name.starts_with(*word),
            begins,
            name.contains(*word),
            occurs,
        ) {
            (true, ..) => Some(0),
            (_, true, ..) => Some(1),
            (_, _, true, _) => Some(2),
            (.., true) => Some(TOLD),
            _ => None,
        }
    };
    words.iter().map(rank_of).sum()
}

#[cfg(test)]
mod tests {
    use super::*;

    fn first(list: List, typed: &str) -> Option<String> {
        let picker = Picker {
            input: typed.into(),
            ..Picker::new(list)
        };
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
            assert_eq!(
                first(List::Commands, typed).as_deref(),
                Some(name),
                "{typed}"
            );
        }
        for (typed, name) in [
            ("tab", "next case"),
            ("switch", "next case"),
            ("compare", "baseline"),
            ("static", "method static"),
            ("dynamic", "method dynamic"),
            ("method", "method"),
        ] {
            let results = QUANTITIES.iter().map(|quantity| quantity.key).collect();
            let picker = Picker {
                input: typed.into(),
                ..Picker::over(List::Commands, results, true, Vec::new())
            };
            let found = picker
                .fitting()
                .into_iter()
                .take(3)
                .map(|item| item.name)
                .collect::<Vec<_>>();
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
    fn what_acts_comes_before_what_does_not_but_a_symbol_is_what_it_says() {
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
                ..Picker::over(List::Places, Vec::new(), false, idle.clone())
            };
            assert_eq!(picker.fitting()[0].name, key, "{typed}");
        }
    }

    #[test]
    fn the_whole_list_stands_while_nothing_is_typed() {
        let all = Picker::new(List::Commands).fitting();
        assert_eq!(all.len(), commands::commands().count() + GRAPHS.len());
        assert_eq!(Picker::new(List::Places).fitting().len(), FIELDS.len());
    }
}
