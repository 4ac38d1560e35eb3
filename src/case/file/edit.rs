//! Writes changed values into the original text and keeps comments, order and spacing.

mod variants;

use toml_edit::{DocumentMut, Item, Key, RawString, Table, TableLike, Value};

use super::template::{self, Entry, entries, override_entry};
use super::{Document, tree};
use crate::case::{Case, Variant};

/// The document's text with its changes.
pub(super) fn render(document: &Document) -> String {
    let Some(text) = edited(document) else {
        return template::text(&document.case, &[]);
    };
    let kept = content(&tree::read(&text).case) == content(&document.case);
    // If the changes do not fit into the layout, the file gets the default layout; an invalid case
    // keeps its layout.
    if kept || document.case.inputs().is_err() {
        text
    } else {
        template::text(&document.case, &[])
    }
}

/// The content of a case, in sorted order.
fn content(case: &Case) -> (Vec<Entry>, Vec<Overrides<'_>>) {
    let mut entries = entries(case);
    entries.sort();
    let overrides = |variant: &'_ Variant| variant.overrides.iter().map(override_entry).collect();
    let variants = case.variants.iter();
    let mut variants: Vec<Overrides<'_>> = variants
        .map(|variant| (variant.name.as_str(), overrides(variant)))
        .collect();
    variants.sort();
    (entries, variants)
}

/// The name of a variant and its overrides as written in a file.
type Overrides<'v> = (&'v str, Vec<(String, String)>);

fn edited(document: &Document) -> Option<String> {
    let mut toml: DocumentMut = document.text.parse().ok()?;
    let (before, after) = (entries(&document.loaded), entries(&document.case));
    for entry in &before {
        if !after.iter().any(|kept| kept.key() == entry.key()) {
            // Inside braces a comment ends with its line.
            let end = if toml.get(entry.table).is_some_and(Item::is_inline_table) {
                "\n"
            } else {
                ""
            };
            let homeless = take_out(table(&mut toml, entry.table)?, entry.bare_name(), end);
            let trailing = toml.trailing().as_str().unwrap_or_default().to_owned();
            toml.set_trailing(trailing + &homeless);
        }
    }
    for entry in after.iter().filter(|entry| !before.contains(entry)) {
        write(table(&mut toml, entry.table)?, entry)?;
    }
    variants::edit(
        &mut toml,
        &document.loaded.variants,
        &document.case.variants,
    )?;
    Some(with_line_ends_of(&document.text, toml.to_string()))
}

/// The table with this name. Added at the end if the text has none.
fn table<'t>(toml: &'t mut DocumentMut, name: &str) -> Option<&'t mut dyn TableLike> {
    if name.is_empty() {
        return Some(toml.as_table_mut());
    }
    toml.entry(name)
        .or_insert(Item::Table(Table::new()))
        .as_table_like_mut()
}

/// Writes an entry, at its old place if it exists.
fn write(table: &mut dyn TableLike, entry: &Entry) -> Option<()> {
    put(table, entry.bare_name(), &entry.name, &entry.value)
}

/// Writes a value under a key, which is given plain and as TOML.
fn put(table: &mut dyn TableLike, name: &str, key: &str, value: &str) -> Option<()> {
    let mut value: Value = value.parse().ok()?;
    if let Some(old) = table.get_mut(name).and_then(Item::as_value_mut) {
        *value.decor_mut() = old.decor().clone();
        *old = value;
    } else {
        let key = Key::parse(key).ok()?.pop()?;
        value.decor_mut().clear();
        table.entry_format(&key).or_insert(Item::Value(value));
    }
    Some(())
}

/// Removes an entry with its trailing comment. The comments above it move above the next entry, or
/// below the previous one. Returns the comments if the entry has no neighbour.
fn take_out(table: &mut dyn TableLike, name: &str, end: &str) -> String {
    let above = table
        .key(name)
        .map(|key| words(key.leaf_decor().prefix()))
        .unwrap_or_default();
    let names: Vec<String> = table.iter().map(|(name, _)| name.to_owned()).collect();
    let at = names.iter().position(|known| known == name);
    table.remove(name);
    if above.trim().is_empty() {
        return String::new();
    }
    let next = at.and_then(|at| names.get(at + 1));
    if let Some(mut key) = next.and_then(|next| table.key_mut(next)) {
        let own = words(key.leaf_decor().prefix());
        key.leaf_decor_mut().set_prefix(above + &own);
        return String::new();
    }
    let before = at.and_then(|at| names.get(at.checked_sub(1)?));
    if let Some(last) = before.and_then(|before| table.get_mut(before)?.as_value_mut()) {
        let own = words(last.decor().suffix());
        last.decor_mut()
            .set_suffix(format!("{own}\n{}{end}", above.trim_end()));
        return String::new();
    }
    above
}

/// Comments and blanks around a key or a value.
fn words(decor: Option<&RawString>) -> String {
    decor
        .and_then(RawString::as_str)
        .unwrap_or_default()
        .to_owned()
}

/// The text with the line ends of `model`, because the TOML editor changes line ends.
fn with_line_ends_of(model: &str, text: String) -> String {
    if model
        .find('\n')
        .is_some_and(|at| model[..at].ends_with('\r'))
    {
        text.replace('\n', "\r\n")
    } else {
        text
    }
}
