//! Differences between two cases, field by field, and their application to a case.

use serde::{Deserialize, Serialize};

use super::fields::{self, FIELDS};
use super::{Case, Override, Problem, Spread, Variant, spread, variant};
use crate::model::Quantity;

/// A text that differs between two cases.
#[derive(Debug, Clone, PartialEq, Eq, Serialize, Deserialize)]
pub struct Change {
    /// The field's key, or `limits.…`, `spread."…"` or `variants.…`.
    pub key: String,
    /// The text in the first case. `None` if the first case does not have it.
    pub from: Option<String>,
    /// The text in the second case.
    pub to: Option<String>,
}

/// The changes from one case to another, in the order of the fields, the limits and the
/// distributions.
#[must_use]
pub fn between(from: &Case, to: &Case) -> Vec<Change> {
    let (old, new) = (texts(from), texts(to));
    let find = |texts: &[(String, String)], key: &str| {
        texts.iter().find(|(own, _)| own == key).map(|(_, text)| text.clone())
    };
    let mut keys: Vec<&String> = Vec::new();
    for (key, _) in old.iter().chain(&new) {
        if !keys.contains(&key) {
            keys.push(key);
        }
    }
    keys.sort_by_key(|key| fields::index_of(key).unwrap_or(FIELDS.len()));
    let change =
        |key: &String| Change { key: key.clone(), from: find(&old, key), to: find(&new, key) };
    keys.into_iter().map(change).filter(|change| change.from != change.to).collect()
}

/// The text of a case under a key. `None` if the case does not have it.
#[must_use]
pub fn text_of(case: &Case, key: &str) -> Option<String> {
    texts(case).into_iter().find(|(own, _)| own == key).map(|(_, text)| text)
}

/// The label of a key: the label of the field, with its gear if both gears have the field. A limit
/// includes its quantity, a distribution its field.
#[must_use]
pub fn label(key: &str) -> String {
    let of_field = |key: &str| fields::index_of(key).map(|field| FIELDS[field].full_label());
    let of_limit = || {
        let quantity = Quantity::find(key.strip_prefix("limits.")?)?;
        Some(format!("limit of {}", quantity.label.trim_start()))
    };
    let of_spread = || {
        let field = key.strip_prefix("spread.")?.trim_matches('"');
        Some(format!("spread of {}", of_field(field)?))
    };
    of_field(key).or_else(of_limit).or_else(of_spread).unwrap_or_else(|| key.to_owned())
}

impl Case {
    /// Writes the new text of a change, valid or invalid. `None` removes the entry.
    ///
    /// # Errors
    /// If the key does not exist, or a limit or a distribution is invalid. The case is then
    /// unchanged.
    pub fn apply(&mut self, key: &str, text: Option<&str>) -> Result<(), Problem> {
        if let Some(path) = key.strip_prefix(variant::PREFIX) {
            return self.apply_override(path, text);
        }
        let text = text.unwrap_or_default();
        if let Some(quantity) = key.strip_prefix("limits.") {
            return self.set_limit(quantity, text);
        }
        if let Some(field) = key.strip_prefix("spread.") {
            return self.set_spread(field.trim_matches('"'), text);
        }
        if let Some(name) = key.strip_prefix(super::ABOUT) {
            self.write_about(name, text);
            return Ok(());
        }
        let field = fields::index_of(key).ok_or_else(|| super::check::unknown_key(key))?;
        self.write(field, text);
        Ok(())
    }

    fn set_spread(&mut self, field: &str, text: &str) -> Result<(), Problem> {
        if text.is_empty() {
            self.spread.retain(|held| held.field != field);
            return Ok(());
        }
        super::keep(&mut self.spread, Spread::new(field, text)?, |held| held.field == field);
        Ok(())
    }
}

impl Variant {
    /// The variant with the changes from one case to another. If two fields exclude each other, the
    /// override of one replaces the other.
    #[must_use]
    pub fn between(name: &str, from: &Case, to: &Case) -> Variant {
        let changes = between(from, to);
        let is_replaced = |key: &str| {
            let other = fields::index_of(key).and_then(|field| FIELDS[field].partner());
            other.is_some_and(|other| {
                let is_written = |change: &&Change| change.key == FIELDS[other].key;
                changes.iter().find(is_written).is_some_and(|change| change.to.is_some())
            })
        };
        let overrides = changes
            .iter()
            .filter(|change| !change.key.starts_with(variant::PREFIX))
            .filter(|change| change.to.is_some() || !is_replaced(&change.key))
            .map(|change| Override {
                key: change.key.clone(),
                text: change.to.clone().unwrap_or_default(),
            });
        Variant::new(name, overrides.collect())
    }
}

/// Every text of a case by its key: fields, limits, distributions, overrides and `[about]`.
pub(super) fn texts(case: &Case) -> Vec<(String, String)> {
    let fields = FIELDS
        .iter()
        .enumerate()
        .filter_map(|(index, field)| Some((field.key.to_owned(), case.text(index)?.to_owned())));
    let limits =
        case.limits.iter().map(|limit| (format!("limits.{}", limit.quantity), limit.text.clone()));
    let spreads = case.spread.iter().map(|held| (spread::place(held.field), held.text.clone()));
    let overrides = case.variants.iter().flat_map(|variant| {
        let of = |change: &Override| (variant.place(&change.key), change.text.clone());
        variant.overrides.iter().map(of)
    });
    let about = case.about.iter();
    let about = about.map(|(name, text)| (format!("{}{name}", super::ABOUT), text.clone()));
    fields.chain(limits).chain(spreads).chain(overrides).chain(about).collect()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::case::Limit;

    fn varied() -> Case {
        let mut case = Case::table_1();
        for (key, text) in [
            ("pair.module", "1 in"),
            ("title", ""),
            ("driver.teeth", "twenty"),
            ("model.method", "paper"),
        ] {
            case.write(fields::index_of(key).expect("a field"), text);
        }
        case.limits = vec![Limit::new("dynamic_factor", "1.5").expect("a limit")];
        case.spread.push(Spread::new("pair.module", "normal 4 um").expect("a distribution"));
        let change =
            |key: &str, text: &str| Override { key: key.to_owned(), text: text.to_owned() };
        let overrides = vec![
            change("driven.tip_relief", "48 um"),
            change("model.deflection", ""),
            change("spread.\"pair.module\"", "uniform 2 um"),
        ];
        case.keep_variant(Variant::new("relieved", overrides));
        case.write_about("drawing no.", "4711");
        case
    }

    #[test]
    fn the_changes_between_two_cases_convert_one_into_the_other() {
        let pairs = [
            (Case::table_1(), varied()),
            (varied(), Case::table_1()),
            (Case::empty(), varied()),
            (varied(), Case::empty()),
        ];
        for (from, to) in pairs {
            let mut case = from.clone();
            let changes = between(&from, &to);
            assert!(!changes.is_empty());
            for change in &changes {
                assert_eq!(text_of(&case, &change.key), change.from);
                case.apply(&change.key, change.to.as_deref()).expect("the text of a case");
            }
            assert_eq!(between(&case, &to), []);
            assert_eq!(case, to);
        }
        assert_eq!(between(&varied(), &varied()), []);
    }

    #[test]
    fn keys_without_a_field_are_refused_and_change_nothing() {
        let mut case = Case::table_1();
        for (key, text) in [
            ("pair.modul", "5 mm"),
            ("limits.force", "5 N"),
            ("spread.\"title\"", "normal 1"),
            ("limits.impact_force", "x"),
            ("variants.a", "x"),
            ("variants.a.pair.modul", "5 mm"),
            ("variants.a b.pair.module", "5 mm"),
        ] {
            assert!(case.apply(key, Some(text)).is_err(), "{key}");
        }
        assert_eq!(case, Case::table_1());
    }

    #[test]
    fn a_label_names_the_gear() {
        assert_eq!(
            label("pair.module"),
            FIELDS[fields::index_of("pair.module").expect("a field")].label
        );
        assert_ne!(label("driver.teeth"), label("driven.teeth"));
        assert_eq!(label("limits.impact_force"), "limit of impact force");
    }
}
