//! A variant of a case: named overrides of its fields, limits and distributions.

use super::fields::{FIELDS, index_of};
use super::sanitize::quoted;
use super::{Case, Problem, suggest};

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
    #[must_use]
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
    #[must_use]
    pub fn overrides(&self, key: &str) -> bool {
        self.overrides.iter().any(|change| change.key == key)
    }

    /// The key of one of its overrides in the case file, such as
    /// `variants.relieved.driven.tip_relief`.
    #[must_use]
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
                suggest::fix(name, known(), || format!("use one of {}", all.join(", ")))
            };
            Problem::new(
                &format!("{PREFIX}{name}"),
                format!("the case has no variant {}", quoted(name)),
                fix,
            )
        })
    }

    /// The case with the overrides of a variant.
    #[must_use]
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
        super::keep(&mut self.variants, variant, |known| known.name == name);
    }

    /// Writes or removes an override by its key after `variants.`, such as
    /// `relieved.driven.tip_relief`. Removes a variant without overrides.
    pub(super) fn apply_override(&mut self, path: &str, text: Option<&str>) -> Result<(), Problem> {
        let unknown = || super::check::unknown_key(&format!("{PREFIX}{path}"));
        let (name, key) = path.split_once('.').ok_or_else(unknown)?;
        Variant::check_name(name)?;
        let known = self.variants.iter().find(|variant| variant.name == name);
        let mut overrides = known.map_or_else(Vec::new, |variant| variant.overrides.clone());
        overrides.retain(|change| change.key != key);
        if let Some(text) = text {
            Case::empty().apply(key, Some(text))?;
            overrides.push(Override { key: key.to_owned(), text: text.to_owned() });
        }
        self.keep_variant(Variant::new(name, overrides));
        self.variants.retain(|variant| !variant.overrides.is_empty());
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;

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
        }
    }

    #[test]
    fn an_unknown_variant_is_refused_with_a_suggestion() {
        let mut case = Case::table_1();
        let variant =
            Variant::between("relieved", &case, &edited(&[("driven.tip_relief", "1 um")]));
        assert!(
            case.variant("relieved")
                .is_err_and(|problem| problem.fix.to_string().contains("[variants.relieved]"))
        );
        case.keep_variant(variant);
        assert!(
            case.variant("releived")
                .is_err_and(|problem| problem.fix.to_string().contains("relieved"))
        );
        assert!(case.variant("relieved").is_ok());
        for name in ["", "a b", "a.b", "\u{1b}[2J", &"x".repeat(41)] {
            assert!(Variant::check_name(name).is_err(), "{name}");
        }
    }
}
