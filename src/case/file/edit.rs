//! Changed values put into the text that was read; comments, order and spacing stay.

use toml_edit::{DocumentMut, Item, Key, RawString, Table, TableLike, Value};

use super::template::{self, Entry, entries};
use super::{Document, tree};

/// The document's text with its changes.
pub(super) fn render(document: &Document) -> String {
    let Some(text) = edited(document) else {
        return template::text(&document.case, &[]);
    };
    let sorted = |case| {
        let mut entries = entries(case);
        entries.sort();
        entries
    };
    let kept = sorted(&tree::read(&text).case) == sorted(&document.case);
    // If the changes do not fit into the layout, the file gets the default layout; an invalid case
    // keeps its layout.
    if kept || document.case.inputs().is_err() {
        text
    } else {
        template::text(&document.case, &[])
    }
}

fn edited(document: &Document) -> Option<String> {
    let mut toml: DocumentMut = document.text.parse().ok()?;
    let (before, after) = (entries(&document.loaded), entries(&document.case));
    for entry in &before {
        if !after.iter().any(|kept| kept.key() == entry.key()) {
            // In braces a comment ends with a line of its own.
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
    Some(with_line_ends_of(&document.text, toml.to_string()))
}

/// The table of that name, made at the end where the text has none.
fn table<'t>(toml: &'t mut DocumentMut, name: &str) -> Option<&'t mut dyn TableLike> {
    if name.is_empty() {
        return Some(toml.as_table_mut());
    }
    toml.entry(name)
        .or_insert(Item::Table(Table::new()))
        .as_table_like_mut()
}

/// Write an entry, in its place where it has one.
fn write(table: &mut dyn TableLike, entry: &Entry) -> Option<()> {
    let mut value: Value = entry.value.parse().ok()?;
    if let Some(old) = table
        .get_mut(entry.bare_name())
        .and_then(Item::as_value_mut)
    {
        *value.decor_mut() = old.decor().clone();
        *old = value;
    } else {
        let key = Key::parse(&entry.name).ok()?.pop()?;
        value.decor_mut().clear();
        table.entry_format(&key).or_insert(Item::Value(value));
    }
    Some(())
}

/// Take an entry out, with its own trailing comment; the comments above it go above what comes
/// next, else below what comes before. Those that have no neighbour are given back.
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

/// The text with the line ends of another, which the editor of TOML makes its own.
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
