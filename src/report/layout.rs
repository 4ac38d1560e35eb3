//! Line layout of text reports.

use std::fmt;

/// Greatest width of a line of a text report.
pub(super) const WIDTH: usize = 80;

/// Wraps words into lines of at most `width` characters; a longer word is cut.
pub(super) fn flow<'a>(words: impl IntoIterator<Item = &'a str>, width: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for piece in words.into_iter().flat_map(|word| pieces(word, width)) {
        match lines.last_mut() {
            Some(line) if count(line) + 1 + count(piece) <= width => {
                line.push(' ');
                line.push_str(piece);
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
pub(super) fn item(mark: &str, sentence: &str) -> Vec<String> {
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

fn pieces(word: &str, width: usize) -> impl Iterator<Item = &str> {
    let mut rest = word;
    std::iter::from_fn(move || {
        let cut = rest.char_indices().nth(width.max(1)).map_or(rest.len(), |(at, _)| at);
        let (piece, after) = rest.split_at(cut);
        rest = after;
        (!piece.is_empty()).then_some(piece)
    })
}

#[cfg(test)]
mod tests {
    use super::*;

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
