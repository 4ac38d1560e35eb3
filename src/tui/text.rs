//! Text: lines in a width, cut or wrapped, a line with a cursor and a selection, which typing replaces,
//! and the last pass over a screen: it removes control characters, limits combining marks and writes
//! plain ASCII if the terminal needs it.

use std::borrow::Cow;
use std::ops::{Deref, Range};

use ratatui::buffer::{Buffer, Cell};
use ratatui::layout::{Constraint, Layout, Margin, Position, Rect};
use ratatui::style::{Modifier, Style};
use ratatui::text::{Line as Words, Span};
use ratatui::widgets::{
    Block, Borders, Scrollbar, ScrollbarOrientation, ScrollbarState, StatefulWidget, Widget,
};
use tui_input::{Input, InputRequest, StateChanged};
use unicode_width::{UnicodeWidthChar, UnicodeWidthStr};

use crate::case::sanitize::{is_hidden, spelled};
use crate::report::{flow_by, with_units};
use crate::tui::settings::Theme;

/// The width of a text in columns.
pub(super) fn width(text: &str) -> usize {
    if text.is_ascii() { text.len() } else { text.width() }
}

/// The text cut to the width, with a mark at a cut end.
pub(super) fn cut(text: &str, width: usize) -> String {
    let text = printable(text);
    if self::width(&text) <= width {
        return text.into_owned();
    }
    let mut kept = take(&text, width.saturating_sub(1)).to_owned();
    if width > 0 {
        kept.push('…');
    }
    kept
}

/// The text cut to the width at its start, with a mark: the end of a path identifies the path.
pub(super) fn cut_front(text: &str, width: usize) -> String {
    let text = printable(text);
    let over = self::width(&text).saturating_sub(width);
    if over == 0 {
        return text.into_owned();
    }
    if width == 0 { String::new() } else { format!("…{}", skip(&text, over + 1)) }
}

/// The text cut or padded to the width.
pub(super) fn padded(text: &str, width: usize) -> String {
    let text = cut(text, width);
    let gap = width - self::width(&text).min(width);
    text + &" ".repeat(gap)
}

/// The text in lines of at most the width, broken between words, and after a unit rather than
/// before it.
pub(super) fn wrap(text: &str, width: usize) -> Vec<String> {
    let width = width.max(1);
    let words = with_units(&printable(text), width);
    flow_by(width_of, words.iter().map(String::as_str), width)
}

/// The text in at most `rows` lines; the last line of a longer text is cut.
pub(super) fn fitted(text: &str, width: usize, rows: usize) -> Vec<String> {
    let mut lines = wrap(text, width);
    if lines.len() > rows {
        let rest = lines.split_off(rows.saturating_sub(1)).join(" ");
        lines.extend((rows > 0).then(|| cut(&rest, width)));
    }
    lines
}

/// A rule with a title in a style on the top line of an area of a width, after a mark.
pub(super) fn titled(
    mark: Option<&'static str>,
    title: &str,
    style: Style,
    width: u16,
    theme: &Theme,
) -> Block<'static> {
    let title = format!(" {} ", cut(title, usize::from(width).saturating_sub(4)));
    let mark = mark.map_or(Span::styled("─", theme.rule), |mark| Span::styled(mark, theme.title));
    let title = Words::from_iter([mark, Span::styled(title, style)]);
    Block::new().borders(Borders::TOP).border_style(theme.rule).title(title)
}

/// Draws a rule on the top line of an area and returns the area below it.
pub(super) fn framed(rule: &Block<'_>, area: Rect, buffer: &mut Buffer) -> Rect {
    // A block gives every cell of its area a style.
    rule.render(Rect { height: area.height.min(1), ..area }, buffer);
    rule.inner(area)
}

/// Draws lines below each other, as many as fit.
pub(super) fn draw_lines<'a, L: Into<Words<'a>>>(
    lines: impl IntoIterator<Item = L>,
    area: Rect,
    buffer: &mut Buffer,
) {
    for (line, mut rest) in lines.into_iter().zip(area.rows()) {
        let line = line.into();
        paint(rest, line.style, buffer);
        for span in &line.spans {
            let used = put(&span.content, rest, span.style, buffer).min(rest.width);
            rest = Rect { x: rest.x + used, width: rest.width - used, ..rest };
        }
    }
}

/// Gives the cells of an area a style.
pub(super) fn paint(area: Rect, style: Style, buffer: &mut Buffer) {
    if style != Style::new() {
        buffer.set_style(area, style);
    }
}

/// Draws a text on a line, as far as it fits. Returns the width of the whole text.
pub(super) fn put(text: &str, line: Rect, style: Style, buffer: &mut Buffer) -> u16 {
    let line = line.intersection(buffer.area);
    // Without this search for combined characters a frame takes a fifth less time.
    if !line.is_empty() && text.chars().all(is_plain) {
        let first = buffer.index_of(line.x, line.y);
        let cells = &mut buffer.content[first..first + usize::from(line.width)];
        for (cell, letter) in cells.iter_mut().zip(text.chars()) {
            cell.set_char(letter).set_style(style);
        }
    } else {
        Span::styled(text, style).render(line, buffer);
    }
    width(text) as u16
}

/// The top rows of an area, and the rest.
pub(super) fn split(area: Rect, rows: u16) -> [Rect; 2] {
    area.layout(&Layout::vertical([Constraint::Length(rows), Constraint::Fill(1)]))
}

/// Draws an edited line of text, scrolled so that the cursor is visible. Returns the position of
/// the cursor.
pub(super) fn edited(
    input: &Line,
    area: Rect,
    style: Style,
    buffer: &mut Buffer,
) -> Option<Position> {
    let width = usize::from(area.width);
    if area.is_empty() {
        return None;
    }
    let shown = printable(input.value());
    let before: usize = shown.chars().take(input.cursor()).map(width_of).sum();
    let hidden = (before + 1).saturating_sub(width);
    buffer.set_style(area, style);
    let seen = if hidden > 0 && width > 1 {
        format!("…{}", skip(&shown, hidden + 1))
    } else {
        skip(&shown, hidden).to_owned()
    };
    Span::styled(seen, style).render(area, buffer);
    if let Some(part) = input.selected() {
        let width_to = |at| shown.chars().take(at).map(width_of).sum::<usize>();
        let cell = |at| width_to(at).saturating_sub(hidden).min(width) as u16;
        let (x, width) = (area.x + cell(part.start), cell(part.end) - cell(part.start));
        buffer.set_style(Rect { x, width, height: 1, ..area }, Modifier::REVERSED);
    }
    Some(Position::new(area.x + u16::try_from(before - hidden).unwrap_or(0), area.y))
}

/// Draws the completion of an edited line after its text.
pub(super) fn ending(
    ending: Option<&str>,
    typed: usize,
    area: Rect,
    theme: &Theme,
    buffer: &mut Buffer,
) {
    let after = Rect { x: area.x.saturating_add(typed as u16), ..area }.intersection(area);
    let style = theme.faint.remove_modifier(Modifier::BOLD | Modifier::UNDERLINED);
    Span::styled(ending.unwrap_or_default(), style).render(after, buffer);
}

fn take(text: &str, width: usize) -> &str {
    let mut used = 0;
    let end = text.char_indices().find(|&(_, letter)| {
        used += width_of(letter);
        used > width
    });
    &text[..end.map_or(text.len(), |(at, _)| at)]
}

fn skip(text: &str, width: usize) -> &str {
    let mut left = 0;
    let start = text.char_indices().find(|&(_, letter)| {
        let done = left >= width;
        left += width_of(letter);
        done
    });
    &text[start.map_or(text.len(), |(at, _)| at)..]
}

fn width_of(letter: char) -> usize {
    if is_plain(letter) { 1 } else { letter.width().unwrap_or(0) }
}

/// Whether a character has a cell of its own beside any other: ASCII, Greek letters and frequent signs.
fn is_plain(letter: char) -> bool {
    matches!(letter, ' '..='~' | 'Α'..='ω' | '–' | '…' | '─' | '▸' | '²' | '·' | '∫' | '√')
}

/// Draws a scroll bar for the visible part of the lines.
pub(super) fn scroll_bar(top: usize, lines: usize, area: Rect, buffer: &mut Buffer) {
    let hidden = lines.saturating_sub(usize::from(area.height));
    let mut state =
        ScrollbarState::new(hidden + 1).position(top).viewport_content_length(area.height.into());
    let bar = Scrollbar::new(ScrollbarOrientation::VerticalRight);
    let bar = bar.begin_symbol(None).end_symbol(None).track_symbol(Some("│"));
    let bar = bar.thumb_symbol(if hidden > 0 { "█" } else { "│" });
    bar.render(area, buffer, &mut state);
}

/// Draws a scroll bar in the column right of an area, if not all lines fit.
pub(super) fn scroll_bar_beside(top: usize, lines: usize, area: Rect, buffer: &mut Buffer) {
    if lines > usize::from(area.height) {
        let bar = Rect { x: area.right(), width: 1, ..area };
        scroll_bar(top, lines, bar, buffer);
    }
}

/// Draws wrapped text into an area, cut at its end, with a margin of one column on both sides.
pub(super) fn draw_words(words: &str, area: Rect, buffer: &mut Buffer) {
    let area = area.inner(Margin::new(1, 0));
    draw_lines(fitted(words, area.width.into(), area.height.into()), area, buffer);
}

/// The extension of a case file.
pub(super) const CASE_ENDING: &str = ".toml";

/// A line of text with a cursor and a selection.
#[derive(Debug, Clone, Default)]
pub struct Line {
    input: Input,
    /// In characters; never an empty range.
    selected: Option<Range<usize>>,
    /// Whether it is a path: typing also replaces the extension, and a path from the root or from home
    /// the folder.
    is_path: bool,
}

impl Line {
    /// A text that typing replaces.
    pub(crate) fn whole(text: impl Into<String>) -> Line {
        let mut line = Line::from(text.into());
        line.select_all();
        line
    }

    /// A text whose first characters are typed and whose rest is selected.
    pub(crate) fn begun(text: &str, typed: usize) -> Line {
        let mut line = Line::whole(text);
        line.selected = line.selected.map(|all| typed..all.end).filter(|rest| !rest.is_empty());
        line
    }

    /// A path in which the file stem is selected: typing replaces the name of the file and keeps the
    /// folder.
    pub(crate) fn named(path: impl Into<String>) -> Line {
        let path = path.into();
        let name = path.rfind('/').map_or(0, |slash| slash + 1);
        let end = path.rfind('.').filter(|&dot| dot > name).unwrap_or(path.len());
        let place = |at: usize| path[..at].chars().count();
        let selected = place(name)..place(end);
        Line {
            is_path: true,
            input: Input::new(path).with_cursor(selected.end),
            selected: Some(selected).filter(|part| !part.is_empty()),
        }
    }

    /// The selection, in characters.
    pub(crate) fn selected(&self) -> Option<Range<usize>> {
        self.selected.clone()
    }

    /// Number of bytes that typing keeps.
    pub(crate) fn kept(&self) -> usize {
        let is_selected = |at: &usize| self.selected.as_ref().is_some_and(|part| part.contains(at));
        let letters = self.input.value().chars().enumerate();
        letters.filter(|(at, _)| !is_selected(at)).map(|(_, letter)| letter.len_utf8()).sum()
    }

    /// Selects the text and moves the cursor to its end.
    pub(crate) fn select_all(&mut self) {
        let length = self.input.value().chars().count();
        self.input.handle(InputRequest::GoToEnd);
        self.selected = (length > 0).then_some(0..length);
    }

    /// Moves the cursor or deletes text. Both clear the selection.
    pub(crate) fn handle(&mut self, request: InputRequest) -> Option<StateChanged> {
        use InputRequest::{DeleteNextChar, DeletePrevChar, GoToNextChar, GoToPrevChar};
        let Some(part) = self.selected.take() else {
            return self.input.handle(request);
        };
        match request {
            DeletePrevChar | DeleteNextChar => {
                self.put(part, "");
                Some(StateChanged { value: true, cursor: true })
            }
            GoToPrevChar => self.input.handle(InputRequest::SetCursor(part.start)),
            GoToNextChar => self.input.handle(InputRequest::SetCursor(part.end)),
            other => self.input.handle(other),
        }
    }

    /// Inserts text that is typed or pasted.
    pub(crate) fn insert(&mut self, typed: &str) {
        let here = self.input.cursor();
        let mut part = self.selected.take().unwrap_or(here..here);
        if self.is_path && !part.is_empty() {
            part.end = self.input.value().chars().count();
            if typed.starts_with(['/', '~']) {
                part.start = 0;
            }
        }
        self.put(part, typed);
    }

    // One insertion, because inserting each character would cost the square of the length of a
    // paste.
    fn put(&mut self, part: Range<usize>, typed: &str) {
        let value = self.input.value();
        let place =
            |at: usize| value.char_indices().nth(at).map_or(value.len(), |(place, _)| place);
        let text = [&value[..place(part.start)], typed, &value[place(part.end)..]].concat();
        self.input = Input::new(text).with_cursor(part.start + typed.chars().count());
    }
}

impl Deref for Line {
    type Target = Input;

    fn deref(&self) -> &Input {
        &self.input
    }
}

impl From<String> for Line {
    fn from(text: String) -> Line {
        Line { input: Input::new(text), ..Line::default() }
    }
}

impl From<&str> for Line {
    fn from(text: &str) -> Line {
        Line::from(text.to_owned())
    }
}

/// Replaces a character that must not reach a terminal.
const VEILED: char = '\u{FFFD}';

/// Greatest number of combining marks per cell.
const MOST_MARKS: usize = 8;

/// ASCII replacements of single cells.
const ONE_CELL: [(&str, char); 35] = [
    ("─━╌┄", '-'),
    ("═", '='),
    ("│┃║▏▕┊", '|'),
    ("┌┐└┘├┤┬┴┼╭╮╰╯╔╗╚╝", '+'),
    ("•●⠿", '*'),
    ("◆", 'X'),
    ("◇", 'O'),
    ("·∙", '.'),
    ("∘", 'o'),
    ("◦", 'd'),
    ("█▐▌▀▄", '#'),
    ("▓", '%'),
    ("▒", '='),
    ("░", ':'),
    ("▸▶→›", '>'),
    ("◂◀←‹", '<'),
    ("▴▲↑", '^'),
    ("▾▼↓", 'v'),
    ("–—−", '-'),
    ("…", '~'),
    ("µμ", 'u'),
    ("Δδ", 'd'),
    ("α", 'a'),
    ("β", 'b'),
    ("γ", 'g'),
    ("ζ", 'z'),
    ("Σ", 'S'),
    ("ε", 'e'),
    ("κ", 'k'),
    ("ν", 'n'),
    ("ρ", 'r'),
    ("τθ", 't'),
    ("π", 'p'),
    ("√×", 'x'),
    ("°", 'd'),
];

/// Whether a character is safe to print on a terminal.
pub fn is_safe(character: char) -> bool {
    !is_hidden(character)
}

/// The text with one visible mark for each control or invisible character.
pub(crate) fn printable(text: &str) -> Cow<'_, str> {
    if text.chars().all(|letter| is_plain(letter) || is_safe(letter)) {
        return Cow::Borrowed(text);
    }
    Cow::Owned(
        text.chars().map(|character| if is_safe(character) { character } else { VEILED }).collect(),
    )
}

/// A symbol in the characters of the terminal.
pub(crate) fn symbol(text: &str, ascii: bool) -> Cow<'_, str> {
    if !ascii || text.is_ascii() {
        return Cow::Borrowed(text);
    }
    Cow::Owned(spelled(text))
}

/// A line of a page in ASCII. Its columns keep their positions if the gaps before them have room.
pub fn written_out(line: &str) -> Cow<'_, str> {
    if line.is_ascii() {
        return Cow::Borrowed(line);
    }
    let (mut written, mut over) = (String::with_capacity(line.len() + 16), 0);
    for part in line.split_inclusive(' ') {
        if part == " " && over > 0 && written.ends_with(' ') {
            over -= 1;
            continue;
        }
        let plain = symbol(part, true);
        over += plain.len().saturating_sub(part.chars().count());
        written.push_str(&plain);
    }
    Cow::Owned(written)
}

/// The last pass over a finished frame.
pub fn finish(buffer: &mut Buffer, ascii: bool) {
    let is_plain = |cell: &Cell| matches!(cell.symbol().as_bytes(), [b' '..=b'~']);
    for cell in buffer.content.iter_mut().filter(|cell| !is_plain(cell)) {
        if let Some((end, _)) = cell.symbol().char_indices().nth(1 + MOST_MARKS) {
            let symbol = cell.symbol()[..end].to_owned();
            cell.set_symbol(&symbol);
        }
        let symbol = cell.symbol();
        if !symbol.chars().all(is_safe) {
            cell.set_char(VEILED);
        }
        if ascii && !cell.symbol().is_ascii() {
            let plain = to_ascii(cell.symbol());
            cell.set_char(plain);
        }
    }
}

fn to_ascii(symbol: &str) -> char {
    let Some(first) = symbol.chars().next() else {
        return ' ';
    };
    if ('\u{2801}'..='\u{28FF}').contains(&first) {
        return '*';
    }
    ONE_CELL.iter().find(|(from, _)| from.contains(first)).map_or('?', |&(_, to)| to)
}

#[cfg(test)]
mod tests {
    use super::*;
    use InputRequest::{
        DeleteNextChar, DeletePrevChar, DeletePrevWord, GoToEnd, GoToNextChar, GoToPrevChar,
        GoToStart,
    };
    use ratatui::buffer::Cell;

    #[test]
    fn wrapped_lines_keep_every_word_and_fit() {
        let text = "cause: the value is out of its range -5000..5000 um: fix: \
                averyverylongwordwithoutanybreak 歯車";
        for width in 1..60 {
            let lines = wrap(text, width);
            assert!(lines.iter().all(|line| line.width() <= width.max(2)), "{width}: {lines:?}");
            let letters =
                |text: &str| text.chars().filter(|letter| *letter != ' ').collect::<String>();
            assert_eq!(letters(&lines.concat()), letters(text), "{width}");
        }
    }

    #[test]
    fn the_last_line_of_a_long_text_is_cut() {
        let text = "at E: one 1 mm and some; two 2 mm, three 3 mm, four 4 mm.";
        assert_eq!(fitted(text, 20, 2), ["at E: one 1 mm and", "some; two 2 mm, thr…"]);
        assert!(fitted(text, 20, 0).is_empty());
    }

    #[test]
    fn a_cut_text_has_a_mark() {
        assert_eq!(cut("combined deflection", 10), "combined …");
        assert_eq!(cut("module", 6), "module");
        assert_eq!(cut("module", 0), "");
        assert_eq!(cut_front("/home/me/case.toml", 10), "…case.toml");
        assert_eq!((cut_front("case", 4).as_str(), cut_front("case", 0).as_str()), ("case", ""));
    }

    #[test]
    fn the_cursor_of_a_long_text_is_in_sight() {
        let area = Rect::new(3, 0, 8, 1);
        let mut buffer = Buffer::empty(Rect::new(0, 0, 11, 1));
        let input = Line::from("0123456789");
        assert_eq!(edited(&input, area, Style::new(), &mut buffer), Some(Position::new(10, 0)));
        assert_eq!(buffer, Buffer::with_lines(["   …456789 "]));
    }

    fn typed(mut line: Line, requests: &[InputRequest]) -> String {
        for request in requests {
            line.handle(*request);
        }
        line.insert("x");
        line.value().to_owned()
    }

    #[test]
    fn typing_replaces_the_selection_and_a_move_keeps_the_text() {
        for (requests, text) in [
            (&[][..], "μ/x"),
            (&[DeletePrevChar], "μ/x.toml"),
            (&[DeleteNextChar], "μ/x.toml"),
            (&[DeletePrevChar, DeletePrevChar], "μx.toml"),
            (&[GoToPrevChar], "μ/xcase.toml"),
            (&[GoToNextChar], "μ/casex.toml"),
            (&[GoToStart], "xμ/case.toml"),
            (&[GoToEnd], "μ/case.tomlx"),
        ] {
            assert_eq!(typed(Line::named("μ/case.toml"), requests), text, "{requests:?}");
        }
        assert_eq!(typed(Line::whole("5 mm"), &[]), "x");
        assert_eq!(typed(Line::whole("5 mm"), &[DeletePrevWord]), "5 x");
        assert_eq!(typed(Line::from("5 mm"), &[]), "5 mmx");
    }

    #[test]
    fn typing_replaces_the_name_of_a_file_and_a_whole_path_the_folder() {
        for (path, typed, text) in [
            ("a/case.toml", "pair.svg", "a/pair.svg"),
            ("a/case.toml", "/b/pair", "/b/pair"),
            ("a/case.toml", "~/pair", "~/pair"),
            ("a/case.toml", "b/pair", "a/b/pair"),
        ] {
            let mut line = Line::named(path);
            line.insert(typed);
            assert_eq!(line.value(), text, "{path}");
        }
        for (path, selected) in
            [("case.toml", Some(0..4)), ("μ/pair.v2.toml", Some(2..9)), ("a/", None)]
        {
            assert_eq!(Line::named(path).selected(), selected, "{path}");
        }
        assert_eq!((Line::from("μ").kept(), Line::whole("μ").kept()), (2, 0));
        assert_eq!(Line::whole("").selected(), None);
    }

    #[test]
    fn control_and_invisible_characters_are_shown_as_marks() {
        for hostile in [
            "\u{1b}[2J",
            "\u{9b}2J",
            "a\u{202e}b",
            "a\u{200b}b",
            "\u{7f}",
            "a\nb",
            "\u{feff}",
            "e\u{34f}",
            "\u{ffa0}",
        ] {
            let cleaned = printable(hostile);
            assert!(cleaned.contains(VEILED), "{hostile:?}");
            assert!(cleaned.chars().all(is_safe), "{hostile:?}");
        }
        assert_eq!(printable("16 µm, ΔV_n, 歯車"), "16 µm, ΔV_n, 歯車");
    }

    #[test]
    fn a_cell_shows_at_most_eight_combining_marks() {
        let marks = "\u{301}".repeat(400_000);
        let mut buffer = Buffer::with_lines([format!("e{marks}xe\u{301}")]);
        finish(&mut buffer, false);
        let symbols: Vec<_> = buffer.content.iter().map(Cell::symbol).collect();
        assert_eq!(symbols[0], format!("e{}", &marks[..2 * MOST_MARKS]));
        assert_eq!(symbols[1..], ["x", "e\u{301}"]);
    }

    #[test]
    fn a_bare_terminal_gets_ascii_alone() {
        let mut buffer = Buffer::with_lines(["┌─┐ΔV_n 16 µm 歯 ⣿•…"]);
        buffer.content[0].set_symbol("\u{202e}");
        finish(&mut buffer, true);
        assert!(buffer.content.iter().all(|cell| cell.symbol().is_ascii()));
        assert_eq!(buffer.area, Rect::new(0, 0, 20, 1));
        assert_eq!(symbol("ΔV_τ", true), "dV_tau");
        assert_eq!(symbol("α_w", true), "alpha_w");
        assert_eq!(written_out("  α     pair.pressure_angle"), "  alpha pair.pressure_angle");
        assert_eq!(written_out("  = √(r² - b²)"), "  = sqrt(r^2 - b^2)");
    }
}
