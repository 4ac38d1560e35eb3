//! Differences between two cases, their application to a case, and variants, which are named ones.

use super::check::unknown_key;
use super::{ABOUT, Case, Problem, Spread, keep, spread};
use crate::case::fields::{self, FIELDS, index_of};
use crate::case::sanitize::{quoted, suggestion};
use crate::model::Quantity;
use serde::{Deserialize, Serialize};

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
pub fn text_of(case: &Case, key: &str) -> Option<String> {
    texts(case).into_iter().find(|(own, _)| own == key).map(|(_, text)| text)
}

/// The label of a key: the label of the field, with its gear if both gears have the field. A limit
/// includes its quantity, a distribution its field.
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
        if let Some(path) = key.strip_prefix(PREFIX) {
            return self.apply_override(path, text);
        }
        let text = text.unwrap_or_default();
        if let Some(quantity) = key.strip_prefix("limits.") {
            return self.set_limit(quantity, text);
        }
        if let Some(field) = key.strip_prefix("spread.") {
            return self.set_spread(field.trim_matches('"'), text);
        }
        if let Some(name) = key.strip_prefix(ABOUT) {
            self.write_about(name, text);
            return Ok(());
        }
        let field = fields::index_of(key).ok_or_else(|| unknown_key(key))?;
        self.write(field, text);
        Ok(())
    }

    fn set_spread(&mut self, field: &str, text: &str) -> Result<(), Problem> {
        let new = (!text.is_empty()).then(|| Spread::new(field, text)).transpose()?;
        keep(&mut self.spread, new, |held| held.field == field);
        Ok(())
    }
}

impl Variant {
    /// The variant with the changes from one case to another, except those of `[about]`. If two fields
    /// exclude each other, the override of one replaces the other.
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
            .filter(|change| ![PREFIX, ABOUT].iter().any(|table| change.key.starts_with(table)))
            .filter(|change| change.to.is_some() || !is_replaced(&change.key))
            .map(|change| Override {
                key: change.key.clone(),
                text: change.to.clone().unwrap_or_default(),
            });
        Variant::new(name, overrides.collect())
    }
}

/// Every text of a case by its key: fields, limits, distributions, overrides and `[about]`; without
/// empty limits and distributions.
pub(super) fn texts(case: &Case) -> Vec<(String, String)> {
    let fields = FIELDS
        .iter()
        .enumerate()
        .filter_map(|(index, field)| Some((field.key.to_owned(), case.text(index)?.to_owned())));
    let limits = case
        .limits
        .iter()
        .map(|limit| (format!("limits.{}", limit.quantity.key), limit.text.clone()));
    let spreads = case.spread.iter().map(|held| (spread::place(held.field), held.text.clone()));
    // A new row of the form is empty until the user writes into it.
    let rows = limits.chain(spreads).filter(|(_, text)| !text.is_empty());
    let overrides = case.variants.iter().flat_map(|variant| {
        let of = |change: &Override| (variant.place(&change.key), change.text.clone());
        variant.overrides.iter().map(of)
    });
    let about = case.about.iter();
    let about = about.map(|(name, text)| (format!("{ABOUT}{name}"), text.clone()));
    fields.chain(rows).chain(overrides).chain(about).collect()
}

/// Greatest length of the name of a variant, in characters.
const LONGEST_NAME: usize = 40;

/// A named set of overrides.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Variant {
    /// The name: letters, digits, `-` and `_`.
    pub name: String,
    /// The overrides, in the order of the fields, then limits and distributions.
    pub overrides: Vec<Override>,
}

/// A value that replaces the case's value.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Override {
    /// The field's key, or `limits.…` or `spread."…"`.
    pub key: String,
    /// The new text. An empty text removes the key.
    pub text: String,
}

impl Variant {
    /// A variant whose overrides are in the order of the fields.
    pub fn new(name: &str, mut overrides: Vec<Override>) -> Variant {
        overrides.sort_by_key(|change| {
            let place = index_of(&change.key).unwrap_or(FIELDS.len());
            (place, change.key.clone())
        });
        Variant { name: name.to_owned(), overrides }
    }

    /// Checks the name of a variant.
    ///
    /// # Errors
    /// If the name is empty, too long, or has an invalid character.
    pub fn check_name(name: &str) -> Result<(), Problem> {
        let is_allowed = |letter: char| letter.is_alphanumeric() || "-_".contains(letter);
        let count = name.chars().count();
        if (1..=LONGEST_NAME).contains(&count) && name.chars().all(is_allowed) {
            return Ok(());
        }
        Err(Problem::new(
            &format!("{PREFIX}{name}"),
            format!("{} is no name of a variant", quoted(name)),
            format!("use 1 to {LONGEST_NAME} letters, digits, - or _"),
        ))
    }

    /// Whether the variant overrides a key.
    pub fn overrides(&self, key: &str) -> bool {
        self.overrides.iter().any(|change| change.key == key)
    }

    /// The key of one of its overrides in the case file, such as
    /// `variants.relieved.driven.tip_relief`.
    pub fn place(&self, key: &str) -> String {
        format!("{PREFIX}{}.{key}", self.name)
    }
}

/// How the keys of variants begin.
pub(super) const PREFIX: &str = "variants.";

impl Case {
    /// The variant with this name.
    ///
    /// # Errors
    /// If the case has no such variant.
    pub fn variant(&self, name: &str) -> Result<&Variant, Problem> {
        let found = self.variants.iter().find(|variant| variant.name == name);
        found.ok_or_else(|| {
            let known = || self.variants.iter().map(|variant| variant.name.as_str());
            let all: Vec<&str> = known().collect();
            let fix = if all.is_empty() {
                format!("add a table [{PREFIX}{name}]")
            } else {
                suggestion(name, known(), || format!("use one of {}", all.join(", ")))
            };
            Problem::new(
                &format!("{PREFIX}{name}"),
                format!("the case has no variant {}", quoted(name)),
                fix,
            )
        })
    }

    /// The case with the overrides of a variant.
    pub fn with(&self, variant: &Variant) -> Case {
        let mut case = self.clone();
        for change in &variant.overrides {
            if let Some(other) = index_of(&change.key).and_then(|field| FIELDS[field].partner())
                && !change.text.is_empty()
            {
                case.write(other, "");
            }
            // Reading checked every override.
            drop(case.apply(&change.key, Some(&change.text)));
        }
        case
    }

    /// Adds a variant to the case, or replaces the variant with the same name.
    pub fn keep_variant(&mut self, variant: Variant) {
        let name = variant.name.clone();
        keep(&mut self.variants, Some(variant), |known| known.name == name);
    }

    /// Writes or removes an override by its key after `variants.`, such as
    /// `relieved.driven.tip_relief`. Removes a variant without overrides.
    pub(super) fn apply_override(&mut self, path: &str, text: Option<&str>) -> Result<(), Problem> {
        let unknown = || unknown_key(&format!("{PREFIX}{path}"));
        let (name, key) = path.split_once('.').ok_or_else(unknown)?;
        Variant::check_name(name)?;
        let known = self.variants.iter().find(|variant| variant.name == name);
        let mut overrides = known.map_or_else(Vec::new, |variant| variant.overrides.clone());
        Case::empty().apply(key, text)?;
        let new = text.map(|text| Override { key: key.to_owned(), text: text.to_owned() });
        keep(&mut overrides, new, |change| change.key == key);
        self.keep_variant(Variant::new(name, overrides));
        self.variants.retain(|variant| !variant.overrides.is_empty());
        Ok(())
    }
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
        let mut begun = varied();
        begun.write_spread("pair.pressure_angle", "");
        assert_eq!(between(&varied(), &begun), []);
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

    fn edited(edits: &[(&str, &str)]) -> Case {
        let mut case = Case::table_1();
        for (key, value) in edits {
            case.set(key, value).expect("a value of the field");
        }
        case
    }

    #[test]
    fn a_variant_of_the_edits_gives_the_edited_case() {
        for edits in [
            &[("driven.tip_relief", "48 um"), ("pair.module", "6 mm")][..],
            &[("operation.torque", "80 N m")],
            &[("model.deflection", ""), ("limits.impact_force", "900 N")],
            &[("operation.power", "20 kW"), ("title", "a = \"b\"")],
        ] {
            let (base, case) = (Case::table_1(), edited(edits));
            let variant = Variant::between("edited", &base, &case);
            assert_eq!(variant.overrides.len(), edits.len(), "{variant:?}");
            assert_eq!(base.with(&variant), case);
            let mut described = case.clone();
            described.write_about("project", "GB 12");
            assert_eq!(Variant::between("edited", &base, &described), variant);
        }
    }

    #[test]
    fn an_unknown_variant_is_refused_with_a_suggestion() {
        let mut case = Case::table_1();
        let variant =
            Variant::between("relieved", &case, &edited(&[("driven.tip_relief", "1 um")]));
        assert!(
            case.variant("relieved")
                .is_err_and(|problem| problem.fix.contains("[variants.relieved]"))
        );
        case.keep_variant(variant);
        assert!(case.variant("releived").is_err_and(|problem| problem.fix.contains("relieved")));
        assert!(case.variant("relieved").is_ok());
        for name in ["", "a b", "a.b", "\u{1b}[2J", &"x".repeat(41)] {
            assert!(Variant::check_name(name).is_err(), "{name}");
        }
    }
}
