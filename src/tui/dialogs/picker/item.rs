//! The lines of lists: their names, descriptions and effects, and their rank as matches.

use crate::case::{Example, FIELDS};
use crate::model::Quantity;
use crate::report::digest::Digest;
use crate::report::graphs::Graph;
use crate::tui::ascii::symbol;
use crate::tui::commands::{self, Command};
use crate::tui::form_aids::materials::Material;
use crate::tui::jobs::WorkerChart;
use crate::tui::panes::chart::ChartCommand;

/// Prefix of the name of a variant in the list of commands.
pub(crate) const VARIANT: &str = "variant";
/// The rank of a word that occurs only in the description.
pub(super) const DESCRIBED: usize = 100;

/// The effect of a line.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Pick {
    Run(Command),
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

pub(super) fn command(binding: &commands::Binding) -> Item {
    Item {
        pick: Pick::Run(binding.command),
        name: binding.name.to_owned(),
        about: binding.sentence.to_owned(),
        keys: commands::keys_of(binding.command),
    }
}

pub(super) fn variant(name: &str) -> Item {
    Item {
        pick: Pick::Variant,
        name: format!("{VARIANT} {name}"),
        about: format!("Keep the edits as variant {name}, or show that variant in the form."),
        keys: String::new(),
    }
}

pub(super) fn graph((place, graph): (usize, &Graph)) -> Item {
    let symbols: Vec<_> = graph.all_columns().map(|column| column.symbol).collect();
    Item {
        pick: Pick::Run(Command::Chart(ChartCommand::Select(place))),
        name: format!("chart: {}", graph.label.to_lowercase()),
        about: format!("Show {} over the driver's roll angle.", symbols.join(", ")),
        keys: String::new(),
    }
}

pub(super) fn worker_chart((place, chart): (usize, WorkerChart)) -> Item {
    Item {
        pick: Pick::Run(Command::Chart(ChartCommand::Select(place))),
        name: format!("chart: {}", chart.label().to_lowercase()),
        about: chart.about().to_owned(),
        keys: String::new(),
    }
}

pub(super) fn field(index: usize) -> Item {
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

pub(super) fn of_material(gears: &'static [&'static str], material: &'static Material) -> Item {
    let Material { name, group, young, poisson, density, source, .. } = material;
    Item {
        pick: Pick::Make(gears, material),
        name: name.clone(),
        about: format!("{young}, {poisson}, {density}, {group}; {source}"),
        keys: String::new(),
    }
}

pub(super) fn result(quantity: &'static Quantity) -> Item {
    let Quantity { key, symbol, label, equation, .. } = quantity;
    let about = format!("{symbol} {}, a result; {equation}", label.trim_start());
    Item { pick: Pick::Show(key), name: (*key).to_owned(), about, keys: String::new() }
}

pub(super) fn quantity(quantity: &'static Quantity) -> Item {
    Item {
        pick: Pick::Limit(quantity.key),
        name: quantity.key.to_owned(),
        about: format!("{} {}", quantity.symbol, quantity.label.trim_start()),
        keys: String::new(),
    }
}

pub(super) fn example(example: &'static Example, digest: Option<&Digest>) -> Item {
    let about =
        digest.map_or_else(String::new, |digest| format!("{}: {}", digest.title, digest.verdict()));
    Item { pick: Pick::Begin(example), name: example.name.to_owned(), about, keys: String::new() }
}

// The rank of a line, smaller is better; `None` if a word does not match. Symbols may be typed in
// ASCII.
pub(super) fn rank(item: &Item, words: &[&str]) -> Option<usize> {
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
