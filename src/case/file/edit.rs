//! Changed values put into the text that was read; every other byte of it stays.

use std::ops::Range;

use super::template::{self, Entry, entries};
use super::tree::{self, Place, Places};
use super::{Document, Lines};

/// The document's text with its changes.
pub(super) fn render(document: &Document) -> String {
    let text = Editor::new(document).edited();
    let sorted = |case| {
        let mut entries = entries(case);
        entries.sort();
        entries
    };
    let kept = sorted(&tree::read(&text).case) == sorted(&document.case);
    // A layout that no single line can be added to is written anew; a case that is not valid keeps its layout.
    if kept || document.case.inputs().is_err() { text } else { template::text(&document.case) }
}

struct Editor<'d> {
    text: &'d str,
    places: &'d Places,
    lines: Lines<'d>,
    line_end: &'static str,
    before: Vec<Entry>,
    after: Vec<Entry>,
    edits: Vec<(Range<usize>, String)>,
}

impl<'d> Editor<'d> {
    fn new(document: &'d Document) -> Editor<'d> {
        let text = document.text.as_str();
        let line_end = if text.find('\n').is_some_and(|at| text[..at].ends_with('\r')) { "\r\n" } else { "\n" };
        let (before, after) = (entries(&document.loaded), entries(&document.case));
        Editor { text, places: &document.places, lines: Lines::of(text), line_end, before, after, edits: Vec::new() }
    }

    fn edited(mut self) -> String {
        for entry in self.before.clone() {
            self.take_out(&entry);
        }
        for entry in self.after.clone() {
            self.change_or_add(&entry);
        }
        let mut appended = self.new_tables();
        // What is added comes before what is taken out at the same place.
        self.edits.sort_by_key(|(span, _)| (span.start, span.end));
        let mut edited = String::with_capacity(self.text.len() + appended.len());
        let mut at = 0;
        for (span, new) in &self.edits {
            edited.push_str(&self.text[at..span.start]);
            edited.push_str(new);
            at = at.max(span.end);
        }
        edited.push_str(&self.text[at..]);
        if !appended.is_empty() && !edited.is_empty() && !edited.ends_with('\n') {
            appended.insert_str(0, self.line_end);
        }
        edited + &appended
    }

    fn take_out(&mut self, entry: &Entry) {
        let key = entry.key();
        if self.after.iter().any(|kept| kept.key() == key) {
            return;
        }
        let Some(place) = self.places.entry(&key) else { return };
        match &place.inline {
            Some(braces) => self.take_out_of(braces, place, entry.table),
            None => self.edits.push((self.whole_lines(place), String::new())),
        }
    }

    fn change_or_add(&mut self, entry: &Entry) {
        let key = entry.key();
        let same = self.before.contains(entry);
        match self.places.entry(&key) {
            Some(_) if same => {}
            Some(place) => self.edits.push((place.value.clone(), entry.value.clone())),
            None => self.add(entry),
        }
    }

    fn add(&mut self, entry: &Entry) {
        let braces = self.places.table(entry.table).filter(|span| self.text[(*span).clone()].starts_with('{'));
        if let Some(braces) = braces {
            return self.add_to(braces, entry);
        }
        let Some((anchor, prefix)) = self.anchor(entry) else { return };
        let end = self.lines.around(anchor).end;
        let next = self.text[end..].find('\n').map(|at| end + at + 1);
        let line = format!("{prefix}{}", entry.line());
        self.edits.push(match next {
            Some(next) => (next..next, line + self.line_end),
            None => (self.text.len()..self.text.len(), format!("{}{line}", self.line_end)),
        });
    }

    /// The byte after whose line a new entry belongs, and what stands before its key there: the entry before it in the
    /// order of the fields, the comment that shows it, the table's header, any entry of the table.
    fn anchor(&self, entry: &Entry) -> Option<(usize, String)> {
        let header = self.places.table(entry.table).filter(|span| self.text[(*span).clone()].starts_with('['));
        if let Some(comment) = self.commented(entry, header.map_or(0, |span| span.end)) {
            return Some((comment, String::new()));
        }
        let before = self.after.iter().take_while(|other| *other != entry).filter(|other| other.table == entry.table);
        let sibling = before.filter_map(|other| self.places.entry(&other.key())).last();
        if let Some(place) = sibling {
            return Some((place.value.end, self.prefix(place)));
        }
        if let Some(header) = header {
            return Some((header.start, String::new()));
        }
        let top = (entry.table.is_empty()).then(|| self.places.entry("format")).flatten();
        let any = self.after.iter().filter(|other| other.table == entry.table).find_map(|other| self.places.entry(&other.key()));
        top.or(any).map(|place| (place.value.end, self.prefix(place)))
    }

    /// Where a comment such as `# torque = "70 N m"` holds the entry's place in its table.
    fn commented(&self, entry: &Entry, from: usize) -> Option<usize> {
        if !entry.table.is_empty() && from == 0 {
            return None;
        }
        let mut at = from;
        for line in self.text[from..].split_inclusive('\n') {
            let shown = line.trim_start();
            if shown.starts_with('[') {
                return None;
            }
            let held = shown.strip_prefix('#').and_then(|rest| rest.trim_start().strip_prefix(entry.name.as_str()));
            if held.is_some_and(|rest| rest.trim_start().starts_with('=')) {
                return Some(at);
            }
            at += line.len();
        }
        None
    }

    fn prefix(&self, place: &Place) -> String {
        let line = self.lines.around(place.name.start);
        self.text[line.start..place.name.start].to_owned()
    }

    fn whole_lines(&self, place: &Place) -> Range<usize> {
        let start = self.lines.around(place.name.start).start;
        let end = self.lines.around(place.value.end).end;
        start..self.text[end..].find('\n').map_or(self.text.len(), |at| end + at + 1)
    }

    /// Take an entry and one comma beside it out of an inline table, which may have lines and comments of its own.
    fn take_out_of(&mut self, braces: &Range<usize>, place: &Place, table: &'static str) {
        let neighbours = || self.places.entries.iter().filter(|other| other.inline.as_ref() == Some(braces));
        let before = neighbours().map(|other| other.value.end).filter(|&end| end <= place.name.start).max();
        let after = neighbours().map(|other| other.name.start).filter(|&start| start >= place.value.end).min();
        let ahead = self.comma(place.value.end..after.unwrap_or(braces.end - 1));
        let comma = ahead.or_else(|| self.comma(before?..place.name.start));
        match comma {
            Some(comma) if self.stays(braces).next().is_some() => {
                self.edits.extend([(place.name.start..place.value.end, String::new()), (comma, String::new())]);
            }
            _ => self.refill(braces.clone(), table),
        }
    }

    /// Add an entry to an inline table, behind those that stay.
    fn add_to(&mut self, braces: &Range<usize>, entry: &Entry) {
        match self.stays(braces).map(|place| place.value.end).max() {
            Some(end) => self.edits.push((end..end, format!(", {}", entry.line()))),
            None => self.refill(braces.clone(), entry.table),
        }
    }

    /// The entries of an inline table that are not taken out.
    fn stays<'s>(&'s self, braces: &'s Range<usize>) -> impl Iterator<Item = &'d Place> + 's {
        let stays = |place: &&Place| self.after.iter().any(|entry| entry.key() == place.key);
        self.places.entries.iter().filter(|place| place.inline.as_ref() == Some(braces)).filter(stays)
    }

    /// The comma and, before another entry on its line, the blanks behind it, where it alone stands in the gap, comments left aside.
    fn comma(&self, gap: Range<usize>) -> Option<Range<usize>> {
        let mut is_comment = false;
        let mut comma = None;
        for (at, letter) in self.text[gap.clone()].char_indices() {
            is_comment = (is_comment || letter == '#') && letter != '\n';
            match letter {
                _ if is_comment || letter.is_whitespace() => {}
                ',' if comma.is_none() => comma = Some(gap.start + at),
                _ => return None,
            }
        }
        let start = comma?;
        let rest = &self.text[start + 1..gap.end];
        let blanks = if rest.trim().is_empty() { rest.bytes().take_while(|byte| *byte == b' ').count() } else { 0 };
        Some(start..start + 1 + blanks)
    }

    /// Write an inline table anew, once.
    fn refill(&mut self, braces: Range<usize>, table: &'static str) {
        if self.edits.iter().any(|(span, _)| *span == braces) {
            return;
        }
        let entries = self.after.iter().filter(|entry| entry.table == table).map(Entry::line);
        let inside = entries.collect::<Vec<_>>().join(", ");
        self.edits.push((braces, format!("{{ {inside} }}")));
    }

    /// The tables that the text does not have, with their entries.
    fn new_tables(&self) -> String {
        let mut tables: Vec<&str> = Vec::new();
        let fresh = |entry: &&Entry| !entry.table.is_empty() && self.places.table(entry.table).is_none();
        let mut lines: Vec<String> = Vec::new();
        for entry in self.after.iter().filter(fresh) {
            if !tables.contains(&entry.table) {
                tables.push(entry.table);
                let blank = if self.text.is_empty() { "" } else { self.line_end };
                lines.push(format!("{blank}[{}]", entry.table));
            }
            lines.push(entry.line());
        }
        lines.into_iter().map(|line| line + self.line_end).collect()
    }
}
