//! Search for a field, a result or a command by symbol, label, key, a word of the help, or the name
//! of a Greek letter.

use crate::case::fields::{Field, GROUPS};
use crate::case::sanitize::spelled;
use crate::model::Quantity;

/// Least similarity of a mistyped word.
const LIKE: f64 = 0.75;
/// Longer words are not compared by similarity.
const LONGEST: usize = 64;

/// Weights of the texts of an entry.
pub(crate) const COMMAND: u32 = 60;
pub(crate) const LABEL: u32 = 41;
const KEY: u32 = 30;
const GROUP: u32 = 20;
pub(crate) const HELP: u32 = 10;

/// The searched texts of a line of a list.
#[derive(Debug, Clone)]
pub(crate) struct Entry {
    /// The symbol, complete and without the number of the gear.
    symbols: [String; 2],
    /// Words with their weights.
    words: Vec<(u32, String)>,
    /// Number of words of the label.
    length: usize,
}

/// The words of a query. Case and underscores are ignored; Greek letters may be spelled out.
pub(crate) fn query(typed: &str) -> Vec<String> {
    let words = typed.split(|c: char| c.is_whitespace() || c == '.').map(plain);
    words.filter(|word| !word.is_empty()).collect()
}

impl Entry {
    /// An entry of a label and other texts, each with its weight.
    pub(crate) fn new(symbol: &str, texts: &[(u32, &str)]) -> Entry {
        let symbol = plain(symbol);
        let stem = symbol.trim_end_matches(['1', '2']).to_owned();
        let weighted = texts.iter().flat_map(|&(weight, text)| {
            let whole = (weight >= KEY).then(|| plain(text));
            words(text).into_iter().chain(whole).map(move |word| (weight, word))
        });
        let length = texts.first().map_or(0, |(_, label)| label.split_whitespace().count());
        Entry { symbols: [symbol, stem], words: weighted.collect(), length }
    }

    pub(crate) fn of_field(field: &Field) -> Entry {
        let group =
            GROUPS.iter().find(|(table, _)| *table == field.table()).map_or("", |(_, title)| title);
        let texts = [(LABEL, field.label), (KEY, field.name()), (GROUP, group), (HELP, field.help)];
        Entry::new(field.symbol, &texts)
    }

    pub(crate) fn of_result(quantity: &Quantity) -> Entry {
        let Quantity { symbol, label, key, equation, .. } = quantity;
        let texts = [(LABEL, *label), (KEY, *key), (GROUP, "result"), (HELP, *equation)];
        Entry::new(symbol, &texts)
    }

    /// The score, the greater the better; `None` unless every word of the query matches. Words may
    /// be shortened or slightly mistyped.
    pub(crate) fn score(&self, query: &[String]) -> Option<u32> {
        query.iter().map(|word| self.score_of(word)).sum()
    }

    /// Number of words of the label that the query lacks.
    pub(crate) fn untyped(&self, query: &[String]) -> usize {
        self.length.saturating_sub(query.len())
    }

    fn score_of(&self, sought: &str) -> Option<u32> {
        let [whole, stem] = &self.symbols;
        let symbol = match sought {
            _ if whole == sought => Some(101),
            _ if stem == sought => Some(100),
            _ => whole.starts_with(sought).then_some(60),
        };
        let words =
            self.words.iter().filter_map(|(weight, word)| Some(weight + fit(sought, word)?));
        words.chain(symbol).max()
    }
}

/// The quality of a match: whole, prefix, substring, similar, or shortened.
fn fit(sought: &str, word: &str) -> Option<u32> {
    let long = sought.len() > 2;
    let is_alike = || {
        (4..=LONGEST).contains(&sought.len())
            && strsim::normalized_damerau_levenshtein(sought, word) >= LIKE
    };
    match () {
        () if word == sought => Some(50),
        () if word.starts_with(sought) => Some(40),
        () if long && word.contains(sought) => Some(25),
        () if is_alike() => Some(20),
        () if long && is_shortened(sought, word) => Some(5),
        () => None,
    }
}

/// Whether the word becomes the query by removing at most two thirds of its letters, never the first.
fn is_shortened(sought: &str, word: &str) -> bool {
    let mut rest = word.chars();
    word.chars().count() <= 3 * sought.chars().count()
        && word.chars().next() == sought.chars().next()
        && sought.chars().all(|letter| rest.any(|other| other == letter))
}

/// The words of a text in plain letters; `f_pt` gives fpt, f and pt.
fn words(text: &str) -> Vec<String> {
    let split = |joints: &'static str| {
        text.split(move |c: char| !c.is_alphanumeric() && !joints.contains(c))
    };
    split("'").chain(split("'_")).map(plain).filter(|word| !word.is_empty()).collect()
}

/// Lower-case letters and digits of the keyboard: `α_w` is alphaw, `f_pb` is fpb, `ha*1` is ha1.
fn plain(text: &str) -> String {
    let letters = text.chars().flat_map(char::to_lowercase);
    let plain: String = letters.filter(|letter| letter.is_alphanumeric()).collect();
    if plain.is_ascii() {
        return plain;
    }
    // The search knows full names; symbols in ASCII use short ones.
    spelled(&plain.replace('ε', "epsilon").replace('σ', "sigma")).replace('^', "")
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::FIELDS;
    use crate::model::QUANTITIES;
    use proptest::prelude::*;

    fn best<'e>(entries: impl Iterator<Item = (&'e str, Entry)>, typed: &str) -> Vec<&'e str> {
        let words = query(typed);
        let mut found: Vec<_> =
            entries.filter_map(|(key, entry)| Some((entry.score(&words)?, key))).collect();
        found.sort_by_key(|(score, _)| std::cmp::Reverse(*score));
        found.into_iter().map(|(_, key)| key).collect()
    }

    fn keys(typed: &str) -> Vec<&'static str> {
        best(FIELDS.iter().map(|field| (field.key, Entry::of_field(field))), typed)
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
            ("f_pt", "driver.base_pitch"),
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
            let results = QUANTITIES.iter().map(|result| (result.key, Entry::of_result(result)));
            assert_eq!(best(results, query).first(), Some(&key), "{query}");
        }
    }

    #[test]
    fn every_word_must_fit() {
        assert!(keys("module relief").is_empty());
        assert!(keys("xyzzy").is_empty());
        // A mistyped "driver" is found, too.
        let is_of_gear = |key: &&str| !key.starts_with("pair") || *key == "pair.driver_hand";
        assert!(keys("driven").iter().all(is_of_gear));
    }

    #[test]
    fn every_field_is_found_first_by_its_key_and_by_label_and_gear() {
        // The words of compliance.contact are those of model.contact_compliance.
        for field in FIELDS.iter().filter(|field| field.key != "compliance.contact") {
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
        fn no_query_panics(typed in ".{0,12}") {
            keys(&typed);
        }
    }
}
