//! Tables and objects of results, with the writers of text, CSV, JSON, Markdown and HTML.

use super::number;
use crate::case::Problem;
use crate::case::sanitize::{is_hidden, sanitize};
use crate::model::{Inputs, Quantity};
use crate::report::chart::Chart;
use crate::study::shard::Format;
use csv::{ErrorKind, Writer};
use serde::Serialize;
use serde_json::ser::Formatter;
pub use serde_json::{Value as Json, json};
use std::borrow::Cow;
use std::collections::BTreeMap;
use std::fmt;
use std::io::{self, Write};

/// Columns, rows and notes. A row has one cell per column.
#[derive(Debug, Clone, Default)]
pub struct Table {
    /// The heading of the table; empty for none.
    pub title: String,
    /// The columns.
    pub columns: Vec<Column>,
    /// The rows.
    pub rows: Vec<Vec<Cell>>,
    /// Sentences below the table.
    pub notes: Vec<String>,
}

/// A column: the name for scripts, the header for readers, and the unit and digits of its numbers.
#[derive(Debug, Clone, Default)]
pub struct Column {
    /// The name in CSV and JSON.
    pub key: Cow<'static, str>,
    /// The header for a reader.
    pub title: Cow<'static, str>,
    /// The unit in CSV; empty for texts.
    pub unit: Cow<'static, str>,
    /// The unit in which text shows the numbers.
    pub shown: &'static str,
    /// Significant digits of the numbers in text.
    pub digits: usize,
    /// Whether the cells are aligned to the right.
    pub is_right: bool,
    /// Blanks before the column in text.
    pub gap: usize,
    /// Least width in text.
    pub least: usize,
}

/// A value of a table.
#[derive(Debug, Clone, PartialEq)]
pub enum Cell {
    /// A value in SI, shown in the unit and with the digits of the column.
    Number(f64),
    /// A value in SI with its text.
    Shown(f64, String),
    /// A text.
    Text(String),
    /// A text that is a default; faint in HTML.
    Default(String),
    /// No value, with the mark or the reason that a reader sees.
    None(Cow<'static, str>),
}

impl Column {
    /// A column of texts, aligned to the left.
    pub fn text(key: impl Into<Cow<'static, str>>, title: impl Into<Cow<'static, str>>) -> Column {
        Column { key: key.into(), title: title.into(), gap: 1, ..Column::default() }
    }

    /// The class of its cells in HTML.
    fn class(&self) -> &str {
        if self.is_right { "number" } else { &self.key }
    }

    /// A column of numbers, aligned to the right: their unit in SI, and the unit and the digits in
    /// text.
    pub fn number(
        key: impl Into<Cow<'static, str>>,
        title: impl Into<Cow<'static, str>>,
        unit: &'static str,
        (shown, digits): (&'static str, usize),
    ) -> Column {
        Column { unit: unit.into(), shown, digits, ..Column::text(key, title) }.to_the_right()
    }

    /// A column of numbers in SI, without a header for readers.
    pub fn si(key: impl Into<Cow<'static, str>>, unit: &'static str) -> Column {
        Column::number(key, "", unit, ("1", 0))
    }

    /// The same column, aligned to the right.
    pub fn to_the_right(self) -> Column {
        Column { is_right: true, ..self }
    }

    /// The same column with other blanks before it and another least width.
    pub fn wide(self, gap: usize, least: usize) -> Column {
        Column { gap, least, ..self }
    }

    fn header(&self) -> String {
        if self.unit.is_empty() {
            self.key.to_string()
        } else {
            format!("{} [{}]", self.key, self.unit)
        }
    }

    fn shown<'a>(&self, cell: &'a Cell) -> Cow<'a, str> {
        match cell {
            Cell::Number(value) => number(*value, self.shown, self.digits).into(),
            other => other.text().into(),
        }
    }

    fn aligned(&self, text: &str, width: usize) -> String {
        let gap = self.gap;
        let cell = if self.is_right { format!("{text:>width$}") } else { format!("{text:width$}") };
        format!("{:gap$}{cell}", "")
    }
}

impl Cell {
    /// A number, or the mark of its absence.
    pub fn number(value: Option<f64>, mark: &'static str) -> Cell {
        value.map_or(Cell::None(mark.into()), Cell::Number)
    }

    /// The text for a reader; empty for a number that its column would format.
    pub fn text(&self) -> &str {
        match self {
            Cell::Shown(_, text) | Cell::Text(text) | Cell::Default(text) => text,
            Cell::None(mark) => mark,
            Cell::Number(_) => "",
        }
    }

    /// The shortest text that parses to the same number; empty for an absent value.
    fn record(&self) -> Cow<'_, str> {
        match self {
            Cell::Number(value) | Cell::Shown(value, _) => format!("{value:?}").into(),
            Cell::Text(text) | Cell::Default(text) => text.into(),
            Cell::None(_) => "".into(),
        }
    }

    fn json(&self) -> Json {
        match self {
            Cell::Number(value) | Cell::Shown(value, _) => json!(value),
            Cell::Text(text) | Cell::Default(text) => json!(text),
            Cell::None(_) => Json::Null,
        }
    }
}

impl<T: Into<String>> From<T> for Cell {
    fn from(text: T) -> Cell {
        Cell::Text(text.into())
    }
}

/// The widths of the columns of tables with the same columns.
pub fn widths(tables: &[Table]) -> Vec<usize> {
    let columns = tables.first().map_or(&[][..], |table| &table.columns);
    let width = |(at, column): (usize, &Column)| {
        let cells = tables.iter().flat_map(|table| &table.rows).filter_map(|row| row.get(at));
        let cells = cells.map(|cell| count(&column.shown(cell))).max().unwrap_or(0);
        cells.max(column.least).max(count(&column.title))
    };
    columns.iter().enumerate().map(width).collect()
}

/// The lines of tables with the same columns, whose widths they share. A title is in the line of
/// the headers if it ends before the first of them.
pub fn text(tables: &[Table]) -> Vec<Vec<String>> {
    let Some(Table { columns, .. }) = tables.first() else { return Vec::new() };
    let widths = widths(tables);
    let line = |texts: &mut dyn Iterator<Item = Cow<'_, str>>| {
        let cells = columns.iter().zip(&widths).zip(texts);
        let line: String =
            cells.map(|((column, &width), text)| column.aligned(&text, width)).collect();
        line.trim_end().to_owned()
    };
    let lines = |table: &Table| {
        let mut header = line(&mut columns.iter().map(|column| column.title.as_ref().into()));
        let blank = count(&header) - count(header.trim_start());
        let mut lines = Vec::new();
        if count(&table.title) < blank {
            header = format!("{}{}", table.title, &header[count(&table.title)..]);
        } else if !table.title.is_empty() {
            lines.push(table.title.clone());
        }
        lines.extend(Some(header).filter(|header| !header.is_empty()));
        let cells = |row: &Vec<Cell>| {
            line(&mut columns.iter().zip(row).map(|(column, cell)| column.shown(cell)))
        };
        lines.extend(table.rows.iter().map(cells));
        lines.extend(table.notes.iter().cloned());
        lines
    };
    tables.iter().map(lines).collect()
}

impl Table {
    /// A table without rows.
    pub fn new(title: impl Into<String>, columns: Vec<Column>) -> Table {
        Table { title: title.into(), columns, ..Table::default() }
    }

    /// A table of texts: the first column is aligned to the left, the others to the right.
    pub fn of_texts(head: Vec<String>, rows: impl IntoIterator<Item = Vec<String>>) -> Table {
        let column = |(at, title)| match at {
            0 => Column { gap: 0, ..Column::text("", title) },
            _ => Column { is_right: true, ..Column::text("", title) },
        };
        let cells = |row: Vec<String>| row.into_iter().map(Cell::Text).collect();
        let columns: Vec<Column> = head.into_iter().enumerate().map(column).collect();
        Table::new("", columns).with(rows.into_iter().map(cells))
    }

    /// The table with these rows.
    pub fn with(self, rows: impl IntoIterator<Item = Vec<Cell>>) -> Table {
        Table { rows: rows.into_iter().collect(), ..self }
    }

    /// The table with only these columns.
    pub fn of(&self, columns: &[usize]) -> Table {
        let row = |row: &Vec<Cell>| columns.iter().map(|&at| row[at].clone()).collect();
        Table {
            title: self.title.clone(),
            columns: columns.iter().map(|&at| self.columns[at].clone()).collect(),
            rows: self.rows.iter().map(row).collect(),
            notes: self.notes.clone(),
        }
    }

    /// The lines of the table for a reader.
    pub fn lines(&self) -> Vec<String> {
        text(std::slice::from_ref(self)).concat()
    }

    /// The lines of the table with its last column wrapped at a width.
    pub fn wrapped(&self, width: usize) -> Vec<String> {
        let Some((last, before)) = self.columns.split_last() else { return Vec::new() };
        let all: Vec<usize> = (0..before.len()).collect();
        let lead = Table { notes: Vec::new(), ..self.of(&all) }.lines();
        let widest = lead.iter().map(|line| count(line)).max().unwrap_or(0);
        let texts = self.rows.iter().filter_map(|row| Some(last.shown(row.last()?)));
        let head = (lead.len() > self.rows.len()).then(|| last.title.clone());
        let texts = head.into_iter().chain(texts);
        let indent = widest + last.gap;
        let rows = lead.into_iter().zip(texts).flat_map(|(mut lead, text)| {
            let parts = flow(text.split(' '), width.saturating_sub(indent).max(8));
            parts
                .into_iter()
                .map(move |part| {
                    let line = format!("{:indent$}{part}", std::mem::take(&mut lead));
                    line.trim_end().to_owned()
                })
                .collect::<Vec<_>>()
        });
        rows.collect()
    }

    /// Writes the header as CSV in SI units.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_csv_header(&self, out: &mut dyn Write) -> io::Result<()> {
        write_records([self.columns.iter().map(Column::header)], out)
    }

    /// Writes the rows as CSV in SI units and full precision, without header; an absent value is an
    /// empty cell.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_csv_rows(&self, out: &mut dyn Write) -> io::Result<()> {
        let record = |row| {
            let cells: &Vec<Cell> = row;
            cells.iter().map(|cell| cell.record().into_owned())
        };
        write_records(self.rows.iter().map(record), out)
    }

    /// Writes header and rows as CSV.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write_csv(&self, out: &mut dyn Write) -> io::Result<()> {
        self.write_csv_header(out)?;
        self.write_csv_rows(out)
    }

    /// The rows as objects in SI units.
    pub fn objects(&self) -> Vec<Json> {
        let cells = |row| {
            let row: &Vec<Cell> = row;
            self.columns.iter().zip(row).map(|(column, cell)| (column.key.clone(), cell.json()))
        };
        self.rows.iter().map(|row| cells(row).collect()).collect()
    }

    /// The table in Markdown, without its title and notes.
    pub fn markdown(&self) -> String {
        if self.rows.is_empty() {
            return String::new();
        }
        let title = |column: &Column| match &*column.title {
            "" => " |".to_owned(),
            title => format!(" {} |", plain_markdown(title)),
        };
        let rule = |column: &Column| if column.is_right { "--:|" } else { "---|" };
        let cell = |(column, cell): (&Column, &Cell)| {
            format!(" {} |", plain_markdown(&column.shown(cell)))
        };
        let head: String = self.columns.iter().map(title).collect();
        let rules: String = self.columns.iter().map(rule).collect();
        let rows = self.rows.iter().map(|row| self.columns.iter().zip(row).map(cell).collect());
        let lines: Vec<String> = [head, rules].into_iter().chain(rows).collect();
        format!("|{}", lines.join("\n|"))
    }

    /// The table as HTML, with headers if `has_head`: the class of a cell is `number`, or the key
    /// of its column.
    pub fn html(&self, has_head: bool) -> String {
        let caption = match self.title.as_str() {
            "" => String::new(),
            title => format!("<caption>{}</caption>\n", escaped(title)),
        };
        format!("<table>\n{caption}{}{}</table>\n", self.head(has_head), self.body())
    }

    /// Tables with the same columns as one table in HTML, each below a line with its title, apart
    /// from the last column. The headers are repeated on every printed page.
    pub fn html_of(tables: &[Table], has_head: bool) -> String {
        let Some(first) = tables.first() else { return String::new() };
        let width = |column: &Column| format!("<col class=\"{}\">", column.class());
        let widths: String = first.columns.iter().map(width).collect();
        let head = first.head(has_head);
        let group = |table: &Table| {
            let title = match table.title.as_str() {
                "" => String::new(),
                title => format!(
                    "<tr><th colspan=\"{}\">{}</th></tr>\n",
                    table.columns.len() - 1,
                    escaped(title)
                ),
            };
            format!("<tbody>\n{title}{}</tbody>\n", table.body())
        };
        let groups: String = tables.iter().map(group).collect();
        format!("<table>\n<colgroup>{widths}</colgroup>\n{head}{groups}</table>\n")
    }

    fn head(&self, has_head: bool) -> String {
        if !has_head || self.rows.is_empty() {
            return String::new();
        }
        let title = |column: &Column| cell_of("th", column, "", &column.title);
        format!("<thead><tr>{}</tr></thead>\n", self.columns.iter().map(title).collect::<String>())
    }

    fn body(&self) -> String {
        let value = |(column, value): (&Column, &Cell)| {
            let faint = if matches!(value, Cell::Default(_)) { " soft" } else { "" };
            cell_of("td", column, faint, &column.shown(value))
        };
        let row = |row: &Vec<Cell>| {
            format!("<tr>{}</tr>\n", self.columns.iter().zip(row).map(value).collect::<String>())
        };
        self.rows.iter().map(row).collect()
    }
}

/// Escapes a text for HTML, with the indices of its symbols as subscripts.
pub(super) fn typeset(text: &str) -> String {
    let part = |(part, is_index): (&str, bool)| {
        let part = escaped(part);
        if is_index { format!("<sub>{part}</sub>") } else { part }
    };
    parts(text).into_iter().map(part).collect()
}

/// A cell of an HTML table.
fn cell_of(tag: &str, column: &Column, faint: &str, text: &str) -> String {
    let text = match (tag, &*column.key) {
        ("td", "symbol") => typeset(&numbered(text)),
        ("td", _) => typeset(text),
        _ => escaped(text),
    };
    format!("<{tag} class=\"{}{faint}\">{text}</{tag}>", column.class())
}

/// Symbols with the number of the gear as an index: `z_1 / z_2` for `z1 / z2`.
fn numbered(symbols: &str) -> String {
    let symbol = |symbol: &str| {
        let name = symbol.trim_end_matches(|c: char| c.is_ascii_digit());
        let is_name = !name.is_empty() && name.chars().all(|c| c.is_alphabetic() || c == '*');
        let number = &symbol[name.len()..];
        if is_name && !number.is_empty() { format!("{name}_{number}") } else { symbol.to_owned() }
    };
    symbols.split(' ').map(symbol).collect::<Vec<_>>().join(" ")
}

/// The parts of a text, and whether each is the index of a symbol, such as `d,max` of `F_d,max`.
pub(super) fn parts(text: &str) -> Vec<(&str, bool)> {
    /// Greatest number of characters before an index.
    const MOST: usize = 3;
    let (mut parts, mut from) = (Vec::new(), 0);
    for (at, _) in text.match_indices('_') {
        let before = text[..at].chars().rev();
        let symbol = before.take_while(|c| c.is_alphanumeric() || "'*_".contains(*c)).count();
        let after = &text[at + 1..];
        let end = after.find(|c: char| !c.is_alphanumeric() && c != ',').unwrap_or(after.len());
        let index = after[..end].trim_end_matches(',');
        if (1..=MOST).contains(&symbol) && !index.is_empty() && !after[end..].starts_with('_') {
            parts.extend([(&text[from..at], false), (index, true)]);
            from = at + 1 + index.len();
        }
    }
    parts.push((&text[from..], false));
    parts
}

/// Escapes a text for an element or an attribute of HTML or SVG.
pub(super) fn escaped(text: &str) -> String {
    let text = sanitize(text).replace('&', "&amp;").replace('<', "&lt;");
    text.replace('>', "&gt;").replace('"', "&quot;")
}

/// Writes records as CSV.
pub(super) fn write_records<R: IntoIterator<Item = String>>(
    records: impl IntoIterator<Item = R>,
    out: &mut dyn Write,
) -> io::Result<()> {
    let mut writer = Writer::from_writer(out);
    records.into_iter().try_for_each(|record| writer.write_record(record)).map_err(|error| {
        match error.into_kind() {
            // The kind of the error tells the caller of a closed pipe.
            ErrorKind::Io(error) => error,
            other => io::Error::other(format!("{other:?}")),
        }
    })?;
    writer.flush()
}

/// A case by its name, as the user gave it, and its title, empty without one.
#[derive(Debug, Clone, Copy)]
pub struct Named<'a> {
    /// The name.
    pub name: &'a str,
    /// The title.
    pub title: &'a str,
}

/// Results of a study.
pub trait Results {
    /// The results as text.
    fn lines(&self, case: Named) -> Vec<String>;

    /// The members of the JSON object after those of the case.
    fn json(&self) -> Json;

    /// The rows of CSV, if the results have this format.
    fn table(&self) -> Table {
        Table::default()
    }

    /// Sentences that have no place in CSV.
    fn remarks(&self) -> Vec<String> {
        Vec::new()
    }

    /// The picture of the results for a pair, if they have one.
    fn picture(&self, _: &Inputs) -> Option<Result<Chart, String>> {
        None
    }
}

impl Named<'_> {
    /// The title, or the name of a case without one.
    pub fn heading(&self) -> String {
        sanitize(if self.title.is_empty() { self.name } else { self.title })
    }

    /// The title and the name without folders, below a picture.
    pub fn caption(&self) -> String {
        let name = self.name.rsplit('/').next().unwrap_or_default();
        let title = Some(self.title).filter(|title| !title.is_empty());
        let parts: Vec<String> = title.into_iter().chain([name]).map(sanitize).collect();
        parts.join(" · ")
    }

    /// The title and the name with the subject of the results, wrapped.
    pub fn headings(&self, subject: &str) -> Vec<String> {
        let title = if self.title.is_empty() { "Case without a title" } else { self.title };
        let name = format!("{} · {subject}", sanitize(self.name));
        let lines = [sanitize(title), name];
        lines.iter().flat_map(|line| flow(line.split_whitespace(), WIDTH)).collect()
    }

    /// Writes results in a format.
    ///
    /// # Errors
    /// Errors of the writer.
    pub fn write(
        self,
        results: &dyn Results,
        format: Format,
        out: &mut dyn Write,
    ) -> io::Result<()> {
        match format {
            Format::Json => write_line(&self.json(results), out),
            Format::Csv => results.table().write_csv(out),
            _ => writeln!(out, "{}", results.lines(self).join("\n")),
        }
    }

    /// Results as one JSON object.
    pub fn json(self, results: &dyn Results) -> Json {
        let Named { name, title } = self;
        let version = env!("CARGO_PKG_VERSION");
        with(json!({"case": name, "title": title, "version": version}), results.json())
    }
}

/// An object with the members of another one.
pub(super) fn with(mut line: Json, more: Json) -> Json {
    if let (Json::Object(line), Json::Object(more)) = (&mut line, more) {
        line.extend(more);
    }
    line
}

/// An object, whose members [`write_line`] omits if they are null.
pub fn object<K: Into<String>>(members: impl IntoIterator<Item = (K, Json)>) -> Json {
    members.into_iter().collect()
}

/// An object with its members in the order of their names.
pub fn sorted<K: Into<String>>(members: impl IntoIterator<Item = (K, Json)>) -> Json {
    let members = members.into_iter().map(|(key, value)| (key.into(), value));
    object(members.collect::<BTreeMap<String, Json>>())
}

/// A value of a quantity in SI with its unit. `of` names the subject of the value, if it differs
/// from the result of the method.
pub fn measured(quantity: &Quantity, value: f64, of: Option<&'static str>) -> Json {
    let number = if quantity.is_flag() { json!(value != 0.0) } else { json!(value) };
    json!({"value": number, "unit": quantity.unit, "of": of})
}

/// Why a case or a point has no result.
pub fn reason(Problem { field, cause, fix, .. }: &Problem) -> Json {
    json!({"field": field, "cause": cause, "fix": fix})
}

/// Writes a value as one line of JSON that is safe to print on a terminal. Members without a value
/// are omitted; a number that is not finite has none.
///
/// # Errors
/// Errors of the writer.
pub fn write_line(value: &impl Serialize, out: &mut dyn Write) -> io::Result<()> {
    let mut value = serde_json::to_value(value)?;
    omit_absent(&mut value);
    value.serialize(&mut serde_json::Serializer::with_formatter(&mut *out, Safe))?;
    out.write_all(b"\n")
}

fn omit_absent(value: &mut Json) {
    match value {
        Json::Object(members) => {
            members.retain(|_, member| !member.is_null());
            members.values_mut().for_each(omit_absent);
        }
        Json::Array(values) => values.iter_mut().for_each(omit_absent),
        _ => {}
    }
}

/// Compact JSON that also escapes the characters that a terminal interprets or hides.
struct Safe;

impl Formatter for Safe {
    fn write_string_fragment<W: ?Sized + Write>(
        &mut self,
        writer: &mut W,
        fragment: &str,
    ) -> io::Result<()> {
        let mut written = 0;
        for (at, hidden) in fragment.match_indices(is_hidden) {
            writer.write_all(&fragment.as_bytes()[written..at])?;
            hidden.encode_utf16().try_for_each(|unit| write!(writer, "\\u{unit:04x}"))?;
            written = at + hidden.len();
        }
        writer.write_all(&fragment.as_bytes()[written..])
    }
}

/// Greatest width of a line of a text report.
pub(super) const WIDTH: usize = 80;

/// Wraps words into lines of at most `width` characters; a longer word is cut.
pub(super) fn flow<'a>(words: impl IntoIterator<Item = &'a str>, width: usize) -> Vec<String> {
    flow_by(|_| 1, words.into_iter().filter(|word| !word.is_empty()), width)
}

/// Wraps words into lines of at most `width`, the sum of the sizes of their characters; a longer
/// word is cut.
pub(crate) fn flow_by<'a>(
    size: fn(char) -> usize,
    words: impl Iterator<Item = &'a str>,
    width: usize,
) -> Vec<String> {
    let count = |text: &str| text.chars().map(size).sum::<usize>();
    let mut lines: Vec<String> = Vec::new();
    for piece in words.flat_map(|word| pieces(size, word, width)) {
        let space = if lines.last().is_none_or(String::is_empty) { "" } else { " " };
        match lines.last_mut() {
            Some(line) if count(line) + space.len() + count(piece) <= width => {
                line.extend([space, piece]);
            }
            _ => lines.push(piece.to_owned()),
        }
    }
    lines
}

/// Escapes the marks of Markdown and HTML, so that the text appears unchanged.
pub(super) fn plain_markdown(text: &str) -> String {
    let mut plain = String::new();
    for letter in text.chars() {
        if "\\|*`<>[]#".contains(letter) {
            plain.push('\\');
        }
        plain.push(letter);
    }
    plain
}

/// Escapes the values of templates of Markdown.
#[derive(Clone, Copy)]
pub(super) struct Markdown;

impl askama::filters::Escaper for Markdown {
    fn write_escaped_str<W: fmt::Write>(&self, mut out: W, text: &str) -> fmt::Result {
        out.write_str(&plain_markdown(text))
    }
}

/// Wraps a sentence behind a mark; further lines are indented by the width of the mark.
pub fn item(mark: &str, sentence: &str) -> Vec<String> {
    let indent = count(mark);
    let width = WIDTH.saturating_sub(indent);
    let sentence = sentence.split_whitespace().collect::<Vec<_>>().join(" ");
    let words = with_units(&sentence, width);
    let lines = flow(words.iter().map(String::as_str), width);
    let lead = |index| {
        if index == 0 { mark.to_owned() } else { " ".repeat(indent) }
    };
    lines.iter().enumerate().map(|(index, line)| lead(index) + line).collect()
}

/// The words of a sentence. A number with its unit, and with the symbol and relation sign before
/// it, is one word, unless it is longer than `most`.
pub(crate) fn with_units(sentence: &str, most: usize) -> Vec<String> {
    let mut words: Vec<String> = Vec::new();
    let (mut after_number, mut after_sign) = (false, false);
    for word in sentence.split(' ') {
        let fits = |before: &String| count(before) + 1 + count(word) <= most;
        let is_unit = after_number && !word.is_empty();
        let is_sign = SIGNS.contains(&word);
        let is_bound = is_unit || is_sign || after_sign || word.starts_with("%)");
        match words.last_mut().filter(|before| is_bound && fits(before)) {
            Some(before) => before.extend([" ", word]),
            None => words.push(word.to_owned()),
        }
        (after_number, after_sign) = (!is_unit && is_number(word), is_sign);
    }
    words
}

/// The signs between a symbol and its value.
const SIGNS: [&str; 4] = ["=", "<=", ">", "<"];

fn is_number(word: &str) -> bool {
    let is_digit = |letter: char| letter.is_ascii_digit();
    word.contains(is_digit) && word.parse::<f64>().is_ok()
}

/// Number of characters of a text; each character of the tables takes one column.
pub(super) fn count(text: &str) -> usize {
    text.chars().count()
}

fn pieces(size: fn(char) -> usize, word: &str, width: usize) -> impl Iterator<Item = &str> {
    let mut rest = Some(word);
    std::iter::from_fn(move || {
        let (text, mut used) = (rest?, 0);
        // A character wider than the line has a line of its own.
        let end = text.char_indices().find(|&(at, letter)| {
            used += size(letter);
            used > width && at > 0
        });
        let (piece, after) = text.split_at(end.map_or(text.len(), |(at, _)| at));
        rest = Some(after).filter(|after| !after.is_empty());
        Some(piece)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

    fn table() -> Table {
        let columns = vec![
            Column::text("name", "").wide(2, 0),
            Column::number("force", "A", "N", ("kN", 3)).wide(2, 6),
        ];
        let rows = [
            vec!["tip|".into(), Cell::Number(1500.0)],
            vec!["root".into(), Cell::number(None, "–")],
        ];
        Table { notes: vec!["note".to_owned()], ..Table::new("Loads", columns).with(rows) }
    }

    #[test]
    fn one_table_has_five_writers() {
        let table = table();
        assert_eq!(table.lines(), ["Loads        A", "  tip|    1.50", "  root       –", "note"]);
        let mut csv = Vec::new();
        table.write_csv(&mut csv).unwrap();
        assert_eq!(String::from_utf8(csv).unwrap(), "name,force [N]\ntip|,1500.0\nroot,\n");
        let rows = serde_json::to_string(&table.objects()).unwrap();
        assert_eq!(rows, r#"[{"name":"tip|","force":1500.0},{"name":"root","force":null}]"#);
        assert_eq!(table.markdown(), "| | A |\n|---|--:|\n| tip\\| | 1.50 |\n| root | – |");
        assert!(table.html(false).contains("<td class=\"number\">1.50</td>"));
    }

    #[test]
    fn the_indices_of_symbols_are_subscripts_and_other_underscores_stay() {
        for (text, expected) in [
            ("x+Δf_0, TE_st,pp, c'_q", "x+Δf<sub>0</sub>, TE<sub>st,pp</sub>, c'<sub>q</sub>"),
            ("F_S/F_0 of base_pitch_a < b", "F<sub>S</sub>/F<sub>0</sub> of base_pitch_a &lt; b"),
            (&numbered("ha*1 / O1D"), "ha*<sub>1</sub> / O1D"),
        ] {
            assert_eq!(typeset(text), expected);
        }
    }

    #[test]
    fn a_long_title_has_its_own_line() {
        let long = Table { title: "A title to the end".to_owned(), ..table() };
        assert_eq!(long.lines()[..2], ["A title to the end", "             A"]);
    }

    #[test]
    fn members_keep_their_order_and_absent_values_are_omitted() {
        let mut out = Vec::new();
        let line = json!({"z": 1, "b": f64::NAN, "a": ["x"], "none": None::<f64>, "half": 0.5});
        write_line(&line, &mut out).unwrap();
        assert_eq!(String::from_utf8(out).unwrap(), "{\"z\":1,\"a\":[\"x\"],\"half\":0.5}\n");
    }

    #[test]
    fn control_characters_are_escaped_and_parse_to_the_same_text() {
        let text = "a\u{1b}[2J\u{7f}\u{9b}\u{202e}\u{e0041}\"\\\n é";
        let mut out = Vec::new();
        write_line(&text, &mut out).unwrap();
        let line = String::from_utf8(out).unwrap();
        assert_eq!(line, "\"a\\u001b[2J\\u007f\\u009b\\u202e\\udb40\\udc41\\\"\\\\\\n é\"\n");
        assert_eq!(serde_json::from_str::<String>(&line).unwrap(), text);
    }

    #[test]
    fn no_line_is_wider_than_asked() {
        assert_eq!(flow("one two three".split(' '), 7), ["one two", "three"]);
        assert_eq!(flow(["unbreakable"], 4), ["unbr", "eaka", "ble"]);
        assert!(flow([], 4).is_empty());
    }

    #[test]
    fn no_line_ends_between_a_number_and_its_unit() {
        for words in 1..40 {
            let lines = item("  - ", &("ab ".repeat(words) + "12.5 um, and 3 mm/N 7"));
            assert!(
                lines.iter().any(|line| line.contains("12.5 um,"))
                    && lines.iter().any(|line| line.contains("3 mm/N"))
            );
        }
    }

    #[test]
    fn no_line_ends_between_a_symbol_and_its_value() {
        assert_eq!(
            with_units("contact: θ_1 = 1.709 deg before E; F_S <= 4 kN", 20),
            ["contact:", "θ_1 = 1.709 deg", "before", "E;", "F_S <= 4 kN"]
        );
        assert_eq!(with_units("θ_1 = 1.709 deg", 10), ["θ_1 =", "1.709 deg"]);
    }

    #[test]
    fn an_item_hangs_behind_its_mark() {
        let lines = item("  - ", &"word ".repeat(20));
        assert!(lines[0].starts_with("  - word") && lines[1].starts_with("    word"));
        assert!(lines.iter().all(|line| count(line) <= WIDTH));
    }
}
