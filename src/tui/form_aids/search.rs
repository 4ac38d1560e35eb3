//! Search for a field or a result by symbol, label, key, a word of the help, or the name of a Greek
//! letter.

use std::sync::LazyLock;

use crate::case::fields::{FIELDS, Field, GROUPS};
use crate::model::{QUANTITIES, Quantity};

/// Greek letters and their names.
const GREEK: [(char, &str); 14] = [
    ('α', "alpha"),
    ('β', "beta"),
    ('γ', "gamma"),
    ('δ', "delta"),
    ('ε', "epsilon"),
    ('ζ', "zeta"),
    ('η', "eta"),
    ('θ', "theta"),
    ('μ', "mu"),
    ('ν', "nu"),
    ('ρ', "rho"),
    ('σ', "sigma"),
    ('τ', "tau"),
    ('ω', "omega"),
];

/// Least similarity of a mistyped word.
const LIKE: f64 = 0.75;

/// The searched texts of a field or a result, with the weight of each.
struct Entry {
    /// The symbol, complete and without the number of the gear.
    symbols: [String; 2],
    /// Words with their weights, the greatest first.
    words: [(u32, Vec<String>); 4],
}

static ENTRIES: LazyLock<Vec<Entry>> =
    LazyLock::new(|| FIELDS.iter().map(Entry::of_field).collect());
static RESULTS: LazyLock<Vec<Entry>> =
    LazyLock::new(|| QUANTITIES.iter().map(Entry::of_result).collect());

/// Fields that match every word of the query, the best first, each with its score; equal ones in
/// the order of the form. Case and underscores are ignored. Greek letters may be spelled out, and
/// words may be shortened or slightly mistyped. An empty query matches all fields equally.
#[must_use]
pub(crate) fn search(query: &str) -> Vec<(usize, u32)> {
    search_in(&ENTRIES, query)
}

/// Results that match every word of the query, by their index in the table of quantities, as
/// [`search`] finds fields.
#[must_use]
pub(crate) fn search_results(query: &str) -> Vec<(usize, u32)> {
    search_in(&RESULTS, query)
}

fn search_in(entries: &[Entry], query: &str) -> Vec<(usize, u32)> {
    let sought: Vec<String> = query
        .split(|c: char| c.is_whitespace() || c == '.')
        .map(plain)
        .filter(|word| !word.is_empty())
        .collect();
    let score = |entry: &Entry| sought.iter().map(|word| entry.score(word)).sum::<Option<u32>>();
    let mut found: Vec<(usize, u32)> =
        entries.iter().enumerate().filter_map(|(at, entry)| Some((at, score(entry)?))).collect();
    found.sort_by_key(|&(at, score)| (std::cmp::Reverse(score), at));
    found
}

impl Entry {
    fn of_field(field: &Field) -> Entry {
        let group =
            GROUPS.iter().find(|(table, _)| *table == field.table()).map_or("", |(_, title)| title);
        Entry::new(field.symbol, field.label, field.name(), group, field.help)
    }

    fn of_result(quantity: &Quantity) -> Entry {
        Entry::new(quantity.symbol, quantity.label, quantity.key, "result", quantity.equation)
    }

    fn new(symbol: &str, label: &str, name: &str, group: &str, help: &str) -> Entry {
        let symbol = plain(symbol);
        let stem = symbol.trim_end_matches(['1', '2']).to_owned();
        let name = words(name).into_iter().chain([plain(name)]).collect();
        Entry {
            symbols: [symbol, stem],
            words: [
                (41, words(label).into_iter().chain([plain(label)]).collect()),
                (30, name),
                (20, words(group)),
                (10, words(help)),
            ],
        }
    }

    /// The score of the entry for one word of the query; `None` without a match.
    fn score(&self, sought: &str) -> Option<u32> {
        let [whole, stem] = &self.symbols;
        let symbol = if whole == sought { Some(101) } else { (stem == sought).then_some(100) };
        let begun = self.symbols[0].starts_with(sought).then_some(60);
        let word = self.words.iter().filter_map(|(weight, words)| {
            let best = words.iter().filter_map(|word| fit(sought, word)).max()?;
            Some(weight + best)
        });
        word.chain(symbol).chain(begun).max()
    }
}

/// The quality of a match: whole, prefix, substring, similar, or shortened.
fn fit(sought: &str, word: &str) -> Option<u32> {
    let long = sought.len() > 2;
    if word == sought {
        Some(50)
    } else if word.starts_with(sought) {
        Some(40)
    } else if long && word.contains(sought) {
        Some(25)
    } else if sought.len() > 3 && strsim::normalized_damerau_levenshtein(sought, word) >= LIKE {
        Some(20)
    } else if long && is_shortened(sought, word) {
        Some(5)
    } else {
        None
    }
}

/// Whether the word becomes the query by removing letters after the first.
fn is_shortened(sought: &str, word: &str) -> bool {
    let mut rest = word.chars();
    word.chars().next() == sought.chars().next()
        && sought.chars().all(|letter| rest.any(|other| other == letter))
}

/// The words of a text in plain letters.
fn words(text: &str) -> Vec<String> {
    let split = text.split(|c: char| !c.is_alphanumeric() && c != '\'');
    split.map(plain).filter(|word| !word.is_empty()).collect()
}

/// Lower-case letters and digits of the keyboard: `α_w` is alphaw, `f_pb` is fpb, `ha*1` is ha1.
fn plain(text: &str) -> String {
    let mut plain = String::with_capacity(text.len());
    for letter in
        text.chars().flat_map(char::to_lowercase).filter(|letter| letter.is_alphanumeric())
    {
        let letter = if letter == 'µ' { 'μ' } else { letter };
        match GREEK.iter().find(|(greek, _)| *greek == letter) {
            Some((_, name)) => plain.push_str(name),
            None => plain.push(letter),
        }
    }
    plain
}

#[cfg(test)]
mod tests {
    use super::*;
    use proptest::prelude::*;

    fn keys(query: &str) -> Vec<&'static str> {
        search(query).into_iter().map(|(field, _)| FIELDS[field].key).collect()
    }

    #[test]
    fn the_intended_field_is_the_first_match() {
        for (query, key) in [
            ("alpha", "pair.pressure_angle"),
            ("α", "pair.pressure_angle"),
            ("rho", "driver.density"),
            ("ρ2", "driven.density"),
            ("nu", "driver.poisson"),
            ("mu", "operation.friction_coefficient"),
            ("µ", "operation.friction_coefficient"),
            ("delta", "model.deflection"),
            ("fpb", "deviations.base_pitch"),
            ("f_pb", "deviations.base_pitch"),
            ("jbn", "deviations.backlash"),
            ("ha", "driver.addendum"),
            ("ha*2", "driven.addendum"),
            ("E2", "driven.young"),
            ("z1", "driver.teeth"),
            ("a", "pair.centre_distance"),
            ("m", "pair.module"),
            ("MODULE", "pair.module"),
            ("n1", "operation.speed"),
            ("teeth", "driver.teeth"),
            ("young's", "driver.young"),
            ("pressure angle", "pair.pressure_angle"),
            ("driven tip relief", "driven.tip_relief"),
            ("driven relief length", "driven.tip_relief_length"),
            ("bore", "driver.bore_radius"),
            ("center distance", "pair.centre_distance"),
            ("defl", "model.deflection"),
            ("presure", "pair.pressure_angle"),
            ("method", "model.method"),
            ("double", "model.accurate"),
            ("coulomb", "operation.friction_coefficient"),
            ("driven.teeth", "driven.teeth"),
            ("base_pitch", "deviations.base_pitch"),
            ("driven.tip_radius", "driven.tip_radius"),
        ] {
            assert_eq!(keys(query).first(), Some(&key), "{query}: {:?}", keys(query));
        }
    }

    #[test]
    fn a_result_is_found_by_symbol_label_and_key() {
        for (query, key) in [
            ("F_S", "impact_force"),
            ("fs", "impact_force"),
            ("impact force", "impact_force"),
            ("friction ratio", "friction_ratio"),
            ("dynamic_peak_force", "dynamic_peak_force"),
            ("contact ratio", "contact_ratio"),
            ("epsilon", "contact_ratio"),
        ] {
            let found = search_results(query).first().map(|&(at, _)| QUANTITIES[at].key);
            assert_eq!(found, Some(key), "{query}");
        }
        assert!(search_results("xyzzy").is_empty());
    }

    #[test]
    fn every_word_must_fit() {
        assert!(keys("module relief").is_empty());
        assert!(keys("xyzzy").is_empty());
        assert!(keys("driven").iter().all(|key| !key.starts_with("pair")));
    }

    #[test]
    fn an_empty_query_fits_all_in_the_order_of_the_form() {
        let all: Vec<usize> = search("  ").into_iter().map(|(field, _)| field).collect();
        assert_eq!(all, (0..FIELDS.len()).collect::<Vec<_>>());
    }

    #[test]
    fn every_field_is_found_first_by_its_key_and_by_label_and_gear() {
        for field in &FIELDS {
            assert_eq!(keys(&field.key.replace(['.', '_'], " ")).first(), Some(&field.key));
            let gear =
                if matches!(field.table(), "driver" | "driven") { field.table() } else { "" };
            assert_eq!(
                keys(&format!("{gear} {}", field.label)).first(),
                Some(&field.key),
                "{}",
                field.label
            );
        }
    }

    proptest! {
        #[test]
        fn no_query_panics_and_the_best_matches_are_first(query in ".{0,12}") {
            let found = search(&query);
            prop_assert!(found.is_sorted_by(|a, b| a.1 >= b.1));
        }
    }
}
