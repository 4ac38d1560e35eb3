//! Writes a case as a new commented text or as changed values in the original text, where every line
//! without a change keeps its bytes, and replaces files in one step.

use std::fmt::Write as _;
use std::fs::{self, File, OpenOptions};
use std::io::{self, ErrorKind, Write};
use std::iter;
use std::ops::Range;
use std::path::{Path, PathBuf};
use std::time::Duration;

use tempfile::{Builder, NamedTempFile, PersistError};

use super::{Entry, FORMAT, Layout, Place, SaveError, Value, line_start, shown};
use crate::case::changes::texts;
use crate::case::fields::{Absent, FIELDS, FLAG, Field, GROUPS, Kind, index_of};
use crate::case::sanitize::{is_hidden, sanitize};
use crate::case::units::{self, Dimension};
use crate::case::{ABOUT, Case, changes, check, spread};
use crate::system::files;

/// A value of a case as written in a file.
#[derive(Debug, Clone, PartialEq, Eq, PartialOrd, Ord)]
struct Written {
    /// The keys from the top level.
    path: Vec<String>,
    /// The value in TOML.
    value: String,
}

impl Written {
    fn of(key: &str, text: &str) -> Written {
        let variant = key.strip_prefix(changes::PREFIX).and_then(|path| path.split_once('.'));
        let own = variant.map_or(key, |(_, own)| own);
        let names = match own.split_once('.').filter(|_| variant.is_none()) {
            Some((table, name)) => vec![table, name],
            None => vec![own],
        };
        let is_about = own.starts_with(ABOUT);
        let plain = |name: &str| if is_about { name.to_owned() } else { name.replace('"', "") };
        let above = variant.into_iter().flat_map(|(name, _)| ["variants", name]);
        let path = above.chain(names).map(plain).collect();
        let value = match (index_of(own), text.split_once(' ')) {
            _ if text.is_empty() => string(""),
            _ if is_about => string(text),
            (Some(field), _) => value(&FIELDS[field], text),
            (None, Some((shape, width))) if own.starts_with(spread::PREFIX) => {
                format!("{{ {shape} = {} }}", number(width))
            }
            _ => number(text),
        };
        Written { path, value }
    }

    /// The key with its table, as [`Entry::key`].
    fn key(&self) -> String {
        self.path.join(".")
    }

    /// The keys of its table.
    fn table(&self) -> &[String] {
        &self.path[..self.path.len() - 1]
    }

    fn line(&self) -> String {
        format!("{} = {}", key_of(&self.path[self.path.len() - 1]), self.value)
    }
}

/// All values of a case, in the order of a new file.
fn written(case: &Case) -> Vec<Written> {
    // A form can hold an empty limit.
    let texts = texts(case).into_iter();
    let given = texts.filter(|(key, text)| !text.is_empty() || key.starts_with(changes::PREFIX));
    given.map(|(key, text)| Written::of(&key, &text)).collect()
}

/// Whether two cases have the same values, in any order.
pub(super) fn are_same(one: &Case, other: &Case) -> bool {
    let sorted = |case: &Case| {
        let mut all = written(case);
        all.sort();
        all
    };
    sorted(one) == sorted(other)
}

/// The examples of limits and distributions in a new case.
const LIMIT_EXAMPLE: &str = "# impact_force = \"2500 N\"";
const SPREAD_EXAMPLE: &str = "# \"deviations.base_pitch\" = { normal = \"4 um\" }";
/// The example of a variant of a new case, as [`ABOUT_EXAMPLE`].
const VARIANT_EXAMPLE: &str = "# [variants.relieved]\n# \"driven.tip_relief\" = \"48 um\"";
/// The table `[about]` of a new case.
const ABOUT_EXAMPLE: &str = "# [about]\n# project = \"\"\n# author = \"\"";

/// A commented case, valid if the case is valid. `comments` are additional comments by key.
pub(super) fn template(case: &Case, comments: &[(&str, String)]) -> String {
    let values = written(case);
    let of_table = |table: &[&str]| -> Vec<String> {
        let own = values.iter().filter(|own| own.table() == table);
        own.map(Written::line).collect()
    };
    let mut text = format!(
        "# A gear pair for tipstrike.\n# A value with a dimension is a string with its unit; any \
            unit of the dimension is valid.\nformat = {FORMAT}\n"
    );
    for (table, title) in GROUPS {
        if !table.is_empty() {
            let _ = write!(text, "\n# {title}\n[{table}]\n");
        }
        for (index, field) in FIELDS.iter().enumerate().filter(|(_, field)| field.table() == table)
        {
            let own = values.iter().find(|own| own.key() == field.key);
            let _ = writeln!(text, "# {}", description(field));
            for (_, comment) in comments.iter().filter(|(key, _)| *key == field.key) {
                let _ = writeln!(text, "# {}", sanitize(comment));
            }
            let line = own.map_or_else(|| unwritten(case, index), Written::line);
            let _ = writeln!(text, "{line}");
        }
    }
    for (table, help, example) in [
        ("limits", "Greatest allowed value of any quantity of the results.", LIMIT_EXAMPLE),
        ("spread", "Distribution of a field around its value, for tolerance.", SPREAD_EXAMPLE),
    ] {
        let lines = of_table(&[table]);
        let lines = if lines.is_empty() { example.to_owned() } else { lines.join("\n") };
        let _ = writeln!(text, "\n# {help}\n[{table}]\n{lines}");
    }
    let about = of_table(&["about"]);
    let lines = if about.is_empty() {
        ABOUT_EXAMPLE.to_owned()
    } else {
        format!("[about]\n{}", about.join("\n"))
    };
    let _ = writeln!(text, "\n# Texts for the page of a report, with any keys.\n{lines}");
    text.push_str("\n# Overrides of the case, for compare, --variant and the workbench.\n");
    if case.variants.is_empty() {
        text.extend([VARIANT_EXAMPLE, "\n"]);
    }
    let variants = case.variants.iter().map(|variant| {
        let lines = of_table(&["variants", &variant.name]);
        let head = format!("[variants.{}]", key_of(&variant.name));
        iter::once(head).chain(lines).collect::<Vec<_>>().join("\n") + "\n"
    });
    text + &variants.collect::<Vec<_>>().join("\n")
}

/// Symbol, help and range of a field.
fn description(field: &Field) -> String {
    let symbol =
        if field.symbol.is_empty() { String::new() } else { format!("{}: ", field.symbol) };
    let range = field.range_text();
    let range = if range.is_empty() { range } else { format!(" [{range}]") };
    let absent = match field.absent {
        Absent::Without(words) => format!(" Left out: {words}."),
        _ => String::new(),
    };
    format!("{symbol}{}{range}{absent}", field.help)
}

/// A name as a key, with quotes if TOML needs them.
pub(super) fn key_of(name: &str) -> String {
    let is_bare = |byte: u8| byte.is_ascii_alphanumeric() || b"-_".contains(&byte);
    if name.bytes().all(is_bare) { name.to_owned() } else { string(name) }
}

/// A field without a value: an empty text if required, otherwise an example as a comment.
fn unwritten(case: &Case, index: usize) -> String {
    let field = &FIELDS[index];
    let (name, assignment) = (field.name(), check::assignment(field));
    let example = assignment.split_once(" = ").map_or("", |(_, value)| value);
    let other = field.partner();
    if !case.lacks(index) || other.is_some_and(|other| other < index) {
        return format!("# {assignment}");
    }
    let unless = other
        .map_or_else(String::new, |other| format!(" unless {} is given", FIELDS[other].name()));
    format!("{name} = \"\"  # required{unless}, such as {example}")
}

/// The text of a field as a TOML value.
fn value(field: &Field, text: &str) -> String {
    if field.is_flag() && FLAG.contains(&text) {
        text.to_owned()
    } else if matches!(field.kind, Kind::List(_)) && check::list(text).is_some() {
        format!("[{}]", text.trim())
    } else if field.is_bare() {
        number(text)
    } else {
        string(text)
    }
}

/// A bare number if the text is a number, otherwise the text in quotes.
fn number(text: &str) -> String {
    let bare = text.trim();
    if is_toml_number(bare) {
        return bare.to_owned();
    }
    match units::parse(bare, Dimension::Number, "") {
        Ok(value) => units::text(value, ""),
        Err(_) => string(text),
    }
}

fn is_toml_number(text: &str) -> bool {
    let is_plain = text.bytes().all(|byte| byte.is_ascii_digit() || b"+-.eE".contains(&byte));
    let value = text.parse::<toml_edit::Value>();
    is_plain && value.is_ok_and(|value| value.is_integer() || value.is_float())
}

/// A TOML string on one line without hidden characters: a line end in a string would look like a
/// line end of the file, and a control character would reach the terminal.
fn string(text: &str) -> String {
    if !text.contains(is_hidden) {
        return toml_edit::Value::from(text).to_string();
    }
    let mut quoted = String::new();
    for c in serde_json::Value::from(text).to_string().chars() {
        if is_hidden(c) {
            let _ = write!(quoted, "\\U{:08x}", u32::from(c));
        } else {
            quoted.push(c);
        }
    }
    quoted
}

/// The text of the case `before` with the values of the case `after`.
pub(super) fn render(text: &str, before: &Case, after: &Case) -> String {
    let mut text = text.to_owned();
    for variant in &before.variants {
        if after.variant(&variant.name).is_err() {
            remove(&mut text, |entry| entry.path.iter().take(2).eq(["variants", &variant.name]));
        }
    }
    let (before, after) = (written(before), written(after));
    for old in &before {
        if !after.iter().any(|new| new.key() == old.key()) {
            remove(&mut text, |entry| is_of(entry, &old.key()));
        }
    }
    for new in after.iter().filter(|new| !before.contains(new)) {
        put(&mut text, new);
        // A new file has an empty value for a required field; its alternative replaces it.
        if let Some(other) = index_of(&new.key()).and_then(|field| FIELDS[field].partner()) {
            let is_empty = |entry: &Entry| entry.value == Value::String(String::new());
            remove(&mut text, |entry| entry.key() == FIELDS[other].key && is_empty(entry));
        }
    }
    text
}

fn layout(text: &str) -> Layout {
    Layout::of(text).unwrap_or_default()
}

/// Whether an entry is a key or a member of its distribution.
fn is_of(entry: &Entry, key: &str) -> bool {
    entry.key() == key || entry.table().join(".") == key
}

/// Replaces the value at its place, or inserts it.
fn put(text: &mut String, new: &Written) {
    let (layout, key) = (layout(text), new.key());
    let member = layout.values().find(|entry| entry.table().join(".") == key);
    let distribution = new.value.strip_prefix("{ ");
    let distribution = distribution.and_then(|inner| inner.strip_suffix(" }")?.split_once(" = "));
    match (member, distribution, layout.value(&key)) {
        (Some(member), Some((shape, width)), _) => {
            text.replace_range(member.span.clone(), width);
            if member.path.last().is_none_or(|name| name != shape) {
                text.replace_range(member.name.clone(), shape);
            }
        }
        (_, _, Some(own)) => text.replace_range(own.span.clone(), &new.value),
        (Some(_), None, None) => {
            remove(text, |entry| is_of(entry, &key));
            put(text, new);
        }
        (None, _, None) => insert(text, &layout, new),
    }
}

/// Removes entries, then their headers. A comment on another line stays.
fn remove(text: &mut String, is_removed: impl Fn(&Entry) -> bool) {
    let is_header = |entry: &Entry| entry.place == Place::Header;
    let next = |text: &str| {
        let own = layout(text).entries.into_iter().filter(|entry| is_removed(entry));
        own.min_by_key(is_header)
    };
    while let Some(entry) = next(text) {
        take_out(text, &entry);
    }
}

/// Removes an entry with the comment after it, and the blank line above a header.
fn take_out(text: &mut String, entry: &Entry) {
    let mut cut = entry.start..entry.span.end;
    let Place::Inline { before, after } = entry.place else {
        cut = line(text, cut);
        if entry.place == Place::Header {
            let above = text[..cut.start].trim_end_matches([' ', '\t', '\r', '\n']);
            let blank = text[above.len()..cut.start].match_indices('\n').nth(1);
            cut.start = blank.map_or(cut.start, |_| line_start(text, cut.start - 1));
        }
        return text.replace_range(cut, "");
    };
    let is_blank = |range: Range<usize>| text[range].bytes().all(|byte| b" \t".contains(&byte));
    let mut spaces = [' ', '\t'].as_slice();
    match (after, before) {
        (Some(comma), _) if is_blank(cut.end..comma) => cut.end = comma + 1,
        (None, Some(comma)) if is_blank(comma + 1..cut.start) => {
            cut.start = comma;
            spaces = &[];
        }
        (Some(comma), _) => {
            text.remove(comma);
        }
        (None, _) => {}
    }
    let lines = line(text, cut.clone());
    let rest = &text[cut.end..];
    if text[lines.start..cut.start].trim().is_empty() && ends_line(rest) {
        cut = lines;
    } else {
        cut.end += rest.len() - rest.trim_start_matches(spaces).len();
    }
    text.replace_range(cut, "");
}

/// Whether a place is inside of a value, such as a text over several lines.
fn is_inside(layout: &Layout, at: usize) -> bool {
    layout.values().any(|own| own.span.contains(&at))
}

/// The line of the table that has the example of a field of the case as a comment, as in a new file.
fn example_of(text: &str, layout: &Layout, new: &Written) -> Option<Range<usize>> {
    let comment = match new.table() {
        [table] if table == "limits" => LIMIT_EXAMPLE.to_owned(),
        [table] if table == "spread" => SPREAD_EXAMPLE.to_owned(),
        _ => format!("# {}", check::assignment(&FIELDS[index_of(&new.key())?])),
    };
    let header = layout.headers().find(|header| header.path == new.table())?.span.end;
    let next = layout.headers().map(|header| header.start).find(|&start| start > header);
    let lines = text[header..next.unwrap_or(text.len())].split_inclusive('\n');
    let starts =
        lines.scan(header, |at, line| Some((std::mem::replace(at, *at + line.len()), line)));
    let found =
        starts.into_iter().find(|(at, line)| line.trim_end() == comment && !is_inside(layout, *at));
    found.map(|(at, _)| at..at + comment.len())
}

/// The lines with the example of a table, if the next entry is a header.
fn example_of_table(text: &str, layout: &Layout, example: &str) -> Option<Range<usize>> {
    let example = example.replace('\n', line_end(text));
    let start = text.find(&format!("\n{example}{}", line_end(text)))? + 1;
    let next = layout.entries.iter().filter(|own| own.start > start).min_by_key(|own| own.start);
    let is_free = !is_inside(layout, start) && next.is_none_or(|own| own.place == Place::Header);
    is_free.then(|| start..start + example.len())
}

/// Inserts an entry after the last entry of its table. A new table is at the end of the text.
fn insert(text: &mut String, layout: &Layout, new: &Written) {
    let table = new.table();
    if let Some(example) = example_of(text, layout, new) {
        return text.replace_range(example, &new.line());
    }
    let shared = |path: &[String]| path.iter().zip(table).take_while(|(a, b)| a == b).count();
    // The number of shared keys, and whether the place is after an entry, not in an empty table. At
    // the top level, other entries can be of other tables.
    let places = layout.entries.iter().flat_map(|entry| {
        let (known, is_header) = (shared(entry.table()), entry.place == Place::Header);
        let is_after = !is_header && known >= entry.given;
        let is_neighbour = known > 0 || entry.table().is_empty();
        let is_in = (is_header || entry.value == Value::Table) && table.starts_with(&entry.path);
        let inside = is_in.then_some(((entry.path.len(), false, false), entry));
        inside.into_iter().chain(is_after.then_some(((known, true, is_neighbour), entry)))
    });
    let best = places.max_by_key(|(rank, _)| *rank);
    let Some(((known, is_after, _), entry)) = best else { return append(text, layout, new) };
    let above = if is_after && entry.table() == table {
        text[entry.start..entry.name.start].to_owned()
    } else {
        let given = if is_after { entry.given } else { known };
        table[given..].iter().map(|name| key_of(name) + ".").collect()
    };
    let added = format!("{above}{}", new.line());
    let start = line_start(text, entry.start);
    let indent = text[start..entry.start].to_owned();
    match entry.place {
        Place::Inline { after, .. } if is_after => {
            let comma = after.filter(|_| indent.trim().is_empty());
            match comma.filter(|comma| ends_line(&text[comma + 1..])) {
                Some(comma) => insert_line(text, comma, &format!("{indent}{added},")),
                None => text.insert_str(entry.span.end, &format!(", {added}")),
            }
        }
        Place::Line | Place::Inline { .. } if !is_after => {
            let at = entry.span.start + 1;
            let gap = if text[at..].starts_with('}') { " " } else { "" };
            text.insert_str(at, &format!(" {added}{gap}"));
        }
        Place::Line if known == table.len() => {
            insert_line(text, entry.span.end, &format!("{indent}{added}"));
        }
        Place::Header if known == table.len() => insert_line(text, entry.span.end, &added),
        _ => append(text, layout, new),
    }
}

/// Appends a table with an entry.
fn append(text: &mut String, layout: &Layout, new: &Written) {
    let (table, end) = (new.table(), line_end(text));
    let names: Vec<String> = table.iter().map(|name| key_of(name)).collect();
    let added = format!("[{}]{end}{}{end}", names.join("."), new.line());
    let example = match table {
        [about] if about == "about" => Some(ABOUT_EXAMPLE),
        [variants, _] if variants == "variants" => Some(VARIANT_EXAMPLE),
        _ => None,
    };
    let example = example.and_then(|example| example_of_table(text, layout, example));
    if let Some(example) = example {
        return text.replace_range(example, added.trim_end());
    }
    let inner = layout.headers().find(|header| header.path.starts_with(table));
    match inner.filter(|_| table.len() > 1) {
        // Above the other tables of a variant, so that the variants keep their order.
        Some(inner) => text.insert_str(line_start(text, inner.start), &format!("{added}{end}")),
        None if text.ends_with('\n') => text.extend([end, &*added]),
        None => text.extend([end, end, &*added]),
    }
}

/// Inserts a line below the line of `at`, with the same line end.
fn insert_line(text: &mut String, at: usize, added: &str) {
    let below = line(text, at..at).end;
    let (above, end) = match text[..below].strip_suffix('\n') {
        Some(above) if above.ends_with('\r') => ("", "\r\n"),
        Some(_) => ("", "\n"),
        None => (line_end(text), line_end(text)),
    };
    text.insert_str(below, &format!("{above}{added}{end}"));
}

/// The lines of a range, with their last line end.
fn line(text: &str, range: Range<usize>) -> Range<usize> {
    let end = text[range.end..].find('\n');
    line_start(text, range.start)..end.map_or(text.len(), |length| range.end + length + 1)
}

/// Whether only spaces and a comment are before the line end.
fn ends_line(rest: &str) -> bool {
    let rest = rest.trim_start_matches([' ', '\t']);
    rest.starts_with(['#', '\r', '\n'])
}

/// The first line end of the text.
fn line_end(text: &str) -> &'static str {
    match text.find('\n') {
        Some(at) if text[..at].ends_with('\r') => "\r\n",
        _ => "\n",
    }
}

/// Greatest number of symbolic links in a path.
const MOST_LINKS: usize = 40;
/// Prefix of temporary files.
const TEMPORARY: &str = ".tipstrike-";
/// Prefix of a complete result that cannot replace its target.
const RESULT: &str = "tipstrike-result-";

/// Writes a file that is not a case, such as a report or the settings. Resolves links. On failure
/// the old file stays. `over` allows replacing an existing file.
///
/// # Errors
/// If nothing was written.
pub fn write(path: &Path, bytes: &[u8], over: bool) -> Result<(), SaveError> {
    let target = target_of(path)?;
    if target.old.is_some() && !over {
        return Err(SaveError::AlreadyThere(shown(path)));
    }
    target.replace(bytes, None, path, over)
}

/// The path after resolution of all symbolic links, for an existing or a new file.
///
/// # Errors
/// If a folder of the path is missing or cannot be read, or the links form a circle.
pub fn followed(path: &Path) -> io::Result<PathBuf> {
    resolve(path).map_err(|(_, error)| error)
}

/// Like [`followed`]. The error includes the path whose folder it concerns.
fn resolve(path: &Path) -> Result<PathBuf, (PathBuf, io::Error)> {
    let mut path = path.to_owned();
    for _ in 0..MOST_LINKS {
        match fs::read_link(&path) {
            Ok(next) => match refuse_planted(&path) {
                Ok(()) => path = path.parent().unwrap_or(&path).join(next),
                Err(error) => return Err((path, error)),
            },
            Err(error) if is_no_link(&path, &error) => {
                return place_of(&path).map_err(|error| (path, error));
            }
            Err(error) => return Err((path, error)),
        }
    }
    Err((path, io::Error::other("too many symbolic links")))
}

// The error for a file that is not a link depends on the system.
fn is_no_link(path: &Path, error: &io::Error) -> bool {
    matches!(error.kind(), ErrorKind::InvalidInput | ErrorKind::NotFound | ErrorKind::NotADirectory)
        || fs::symlink_metadata(path).is_ok_and(|about| !about.is_symlink())
}

/// Refuses what Linux refuses with `fs.protected_symlinks` and `fs.protected_regular`, after the link
/// is read: another user can replace his own link at any time, but not a trusted one.
fn refuse_planted(path: &Path) -> io::Result<()> {
    if !files::is_planted(path, folder_of(path))? {
        return Ok(());
    }
    Err(io::Error::new(
        ErrorKind::Unsupported,
        format!(
            "{} belongs to another user, in a folder where every user can create files",
            shown(path)
        ),
    ))
}

/// The absolute path. The root, `.` and `..` are folders themselves.
fn place_of(path: &Path) -> io::Result<PathBuf> {
    match path.file_name() {
        Some(name) => Ok(fs::canonicalize(folder_of(path))?.join(name)),
        None => fs::canonicalize(path),
    }
}

fn folder_of(path: &Path) -> &Path {
    path.parent().filter(|folder| !folder.as_os_str().is_empty()).unwrap_or(Path::new("."))
}

/// A file to write, after resolution of links, and its present state.
pub(super) struct Target {
    pub(super) path: PathBuf,
    pub(super) old: Option<fs::Metadata>,
}

pub(super) fn target_of(path: &Path) -> Result<Target, SaveError> {
    let name = shown(path);
    let target = resolve(path).map_err(|(last, error)| no_folder(path, &last, error))?;
    match fs::metadata(&target) {
        Ok(old) => {
            refuse_planted(&target).map_err(|error| SaveError::Unwritable(name, error))?;
            replaceable(&target, &old, path)?;
            Ok(Target { path: target, old: Some(old) })
        }
        Err(error) if error.kind() == ErrorKind::NotFound && files::names_a_folder(path) => {
            Err(no_folder(path, &path.join("file"), error))
        }
        Err(error) if error.kind() == ErrorKind::NotFound => Ok(Target { path: target, old: None }),
        Err(error) => Err(SaveError::Unwritable(name, error)),
    }
}

/// The error if the folder of `last` does not exist. The links of `path` lead to `last`.
fn no_folder(path: &Path, last: &Path, error: io::Error) -> SaveError {
    let (name, folder) = (shown(path), folder_of(last));
    if !matches!(error.kind(), ErrorKind::NotFound | ErrorKind::NotADirectory) {
        return SaveError::Unwritable(name, error);
    }
    let nearest = folder.ancestors().find(|place| place.exists());
    match nearest.filter(|place| !place.is_dir()) {
        Some(file) => SaveError::NotAFolder(name, shown(file)),
        None => SaveError::NoFolder(name, shown(folder)),
    }
}

fn replaceable(target: &Path, old: &fs::Metadata, path: &Path) -> Result<(), SaveError> {
    let name = shown(path);
    if old.is_dir() {
        return Err(SaveError::IsAFolder(name, shown(&path.join("case.toml"))));
    }
    if !old.is_file() {
        return Err(SaveError::NotAFile(name));
    }
    if files::links(old) > 1 {
        return Err(SaveError::HardLinked(name, files::links(old)));
    }
    let closed = OpenOptions::new().write(true).open(target).err();
    match closed {
        None if !old.permissions().readonly() => Ok(()),
        Some(error) if error.kind() != ErrorKind::PermissionDenied => {
            Err(SaveError::Unwritable(name, error))
        }
        _ => Err(SaveError::ReadOnly(name)),
    }
}

impl Target {
    /// Writes a temporary file beside the target, then renames it. `mode` is the mode of a new file;
    /// `over` allows replacing a file that another program created meanwhile.
    pub(super) fn replace(
        &self,
        bytes: &[u8],
        mode: Option<u32>,
        path: &Path,
        over: bool,
    ) -> Result<(), SaveError> {
        let is_private = self.old.is_some() || mode.is_some();
        let written = begin(&self.path, is_private).and_then(|mut file| {
            file.as_file_mut().write_all(bytes)?;
            Ok(self.finish(file, mode, over)?)
        });
        written.map_err(|error| match error.kind() {
            ErrorKind::AlreadyExists if !over => SaveError::AlreadyThere(shown(path)),
            _ => SaveError::Unwritable(shown(path), error),
        })
    }

    /// Moves the complete file to the target. Each step is on disk before the next step.
    fn finish(
        &self,
        file: NamedTempFile,
        mode: Option<u32>,
        over: bool,
    ) -> Result<(), PersistError> {
        let prepared = match (&self.old, mode) {
            (Some(old), _) => files::keep(old, &self.path, file.as_file()),
            (None, Some(mode)) => files::set_mode(file.as_file(), mode),
            (None, None) => Ok(()),
        };
        if let Err(error) = prepared.and_then(|()| file.as_file().sync_all()) {
            return Err(PersistError { error, file });
        }
        if over || self.old.is_some() {
            file.persist(&self.path)?;
        } else {
            file.persist_noclobber(&self.path)?;
        }
        let folder = folder_of(&self.path);
        // The new file is in place even if flushing the folder fails.
        let _ = File::open(folder).and_then(|folder| folder.sync_all());
        clear(folder);
        Ok(())
    }
}

/// Creates a temporary file beside a file. The umask limits the mode of a file that is not private.
fn begin(beside: &Path, is_private: bool) -> io::Result<NamedTempFile> {
    let mode = if is_private { 0o600 } else { 0o666 };
    let made =
        files::with_mode(Builder::new().prefix(TEMPORARY), mode).tempfile_in(folder_of(beside));
    // The error names the temporary file, which the user does not know.
    made.map_err(|error| {
        let text = error.to_string();
        io::Error::new(error.kind(), text.split(" at path ").next().unwrap_or_default())
    })
}

/// Removes temporary files of killed saves in a folder: those that nobody wrote to for a day.
/// Ignores files that cannot be removed.
fn clear(folder: &Path) {
    const LEFT: Duration = Duration::from_secs(86_400);
    for entry in fs::read_dir(folder).into_iter().flatten().flatten() {
        let is_left = |about: fs::Metadata| {
            let age = about.modified().ok().and_then(|time| time.elapsed().ok());
            about.is_file() && age.is_some_and(|age| age > LEFT)
        };
        let is_ours = entry.file_name().to_string_lossy().starts_with(TEMPORARY);
        if is_ours && entry.metadata().is_ok_and(is_left) {
            drop(fs::remove_file(entry.path()));
        }
    }
}

/// A file that replaces the target only after it is complete. If dropped before, it leaves no file.
pub struct Draft {
    path: PathBuf,
    file: NamedTempFile,
}

impl Draft {
    /// Refuses a target that cannot be replaced, before long work starts.
    ///
    /// # Errors
    /// The reason.
    pub fn check(path: &Path) -> Result<(), SaveError> {
        let target = target_of(path)?;
        let file = begin(&target.path, true);
        let tried = file.and_then(|file| match &target.old {
            Some(old) => files::keep(old, &target.path, file.as_file()),
            None => Ok(()),
        });
        tried.map_err(|error| SaveError::Unwritable(shown(path), error))
    }

    /// Creates the file. Only [`Draft::finish`] refuses a target that cannot be replaced.
    ///
    /// # Errors
    /// If the file cannot be created.
    pub fn create(path: &Path) -> Result<Draft, SaveError> {
        let place = resolve(path).map_err(|(last, error)| no_folder(path, &last, error))?;
        let old = target_of(path).ok().and_then(|target| target.old);
        let file = begin(&place, old.is_some())
            .map_err(|error| SaveError::Unwritable(shown(path), error))?;
        if let Some(old) = old {
            // The target may vanish. The file then has its attributes, as far as possible.
            let _ = files::keep(&old, &place, file.as_file());
        }
        let path = path.to_owned();
        Ok(Draft { path, file })
    }

    /// Moves the complete file to the target, whether or not the target exists by now.
    ///
    /// # Errors
    /// If the system refuses. The old file then stays, and the error names the complete file beside it.
    pub fn finish(self) -> Result<(), SaveError> {
        let Draft { path, file } = self;
        let unwritable = |error| SaveError::Unwritable(shown(&path), error);
        file.as_file().sync_all().map_err(unwritable)?;
        match target_of(&path) {
            Err(error) => Err(kept(file, error)),
            Ok(target) => target
                .finish(file, None, true)
                .map_err(|PersistError { error, file }| kept(file, unwritable(error))),
        }
    }

    /// The error of a failed write, with the name of the file.
    pub fn unwritable(&self, error: io::Error) -> SaveError {
        SaveError::Unwritable(shown(&self.path), error)
    }
}

impl Write for Draft {
    fn write(&mut self, bytes: &[u8]) -> io::Result<usize> {
        self.file.as_file_mut().write(bytes)
    }

    fn flush(&mut self) -> io::Result<()> {
        self.file.as_file_mut().flush()
    }
}

/// Keeps a complete file under a name that no save clears, and adds the name to the error.
fn kept(file: NamedTempFile, error: SaveError) -> SaveError {
    let name = file.path().to_string_lossy();
    let random = name.rsplit('-').next().unwrap_or_default();
    let place = file.path().with_file_name(format!("{RESULT}{random}"));
    let place = match file.persist_noclobber(&place) {
        Ok(_) => Ok(place),
        // In a folder that is read-only by now, the file stays where it is.
        Err(PersistError { file, .. }) => file.keep().map(|(_, place)| place),
    };
    match place {
        Ok(place) if place.exists() => SaveError::Kept(Box::new(error), shown(&place)),
        _ => error,
    }
}
