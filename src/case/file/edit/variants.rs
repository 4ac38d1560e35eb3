//! Writes changed variants into the original text, in any notation of their keys.

use toml_edit::{DocumentMut, InlineTable, Item, Table, TableLike, Value};

use super::{put, take_out};
use crate::case::file::template::override_entry;
use crate::case::{Override, Variant};

const VARIANTS: &str = "variants";

/// Writes the variants into the text with the variants `before`.
pub(super) fn edit(toml: &mut DocumentMut, before: &[Variant], after: &[Variant]) -> Option<()> {
    let named = |variants: &[Variant], name: &str| {
        variants
            .iter()
            .find(|variant| variant.name == name)
            .cloned()
    };
    for old in before {
        if named(after, &old.name).is_none() {
            all(toml)?.remove(&old.name);
        }
    }
    for new in after {
        match named(before, &new.name) {
            Some(old) if old == *new => {}
            Some(old) => change(
                all(toml)?.get_mut(&new.name)?.as_table_like_mut()?,
                &old,
                new,
            )?,
            None => add(all(toml)?, new)?,
        }
    }
    Some(())
}

fn all(toml: &mut DocumentMut) -> Option<&mut dyn TableLike> {
    let implicit = || {
        let mut table = Table::new();
        table.set_implicit(true);
        Item::Table(table)
    };
    toml.entry(VARIANTS)
        .or_insert_with(implicit)
        .as_table_like_mut()
}

fn add(all: &mut dyn TableLike, variant: &Variant) -> Option<()> {
    let is_inline = all.iter().any(|(_, item)| item.is_inline_table());
    let item = if is_inline {
        Item::Value(Value::InlineTable(InlineTable::new()))
    } else {
        Item::Table(Table::new())
    };
    all.insert(&variant.name, item);
    let table = all.get_mut(&variant.name)?.as_table_like_mut()?;
    variant
        .overrides
        .iter()
        .try_for_each(|change| write(table, change))
}

fn write(table: &mut dyn TableLike, change: &Override) -> Option<()> {
    let (key, value) = override_entry(change);
    put(table, key.trim_matches('"'), &key, &value)
}

/// Writes the changed overrides at their places.
fn change(table: &mut dyn TableLike, old: &Variant, new: &Variant) -> Option<()> {
    for gone in &old.overrides {
        if !new.overrides(&gone.key) {
            let path = path_of(table, "", &gone.key)?;
            let (name, tables) = path.split_last()?;
            take_out(inner(table, tables)?, name, "");
        }
    }
    for change in new
        .overrides
        .iter()
        .filter(|change| !old.overrides.contains(change))
    {
        match path_of(table, "", &change.key) {
            Some(path) => {
                let (name, tables) = path.split_last()?;
                let (_, value) = override_entry(change);
                put(inner(table, tables)?, name, name, &value)?;
            }
            None => write(table, change)?,
        }
    }
    Some(())
}

fn inner<'t>(table: &'t mut dyn TableLike, names: &[String]) -> Option<&'t mut dyn TableLike> {
    names.iter().try_fold(table, |table, name| {
        table.get_mut(name)?.as_table_like_mut()
    })
}

/// The keys of the path to an override, dotted, quoted or nested.
fn path_of(table: &dyn TableLike, above: &str, wanted: &str) -> Option<Vec<String>> {
    let wanted = wanted.replace('"', "");
    table.iter().find_map(|(name, item)| {
        let path = if above.is_empty() {
            name.to_owned()
        } else {
            format!("{above}.{name}")
        };
        if path == wanted {
            return Some(vec![name.to_owned()]);
        }
        let is_above = wanted.starts_with(&format!("{path}."));
        let table = item.as_table_like().filter(|_| is_above)?;
        let mut rest = path_of(table, &path, &wanted)?;
        rest.insert(0, name.to_owned());
        Some(rest)
    })
}
