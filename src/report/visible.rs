//! Text from files and names, made safe for a terminal.

use std::borrow::Cow;

/// Characters beside the controls that change or hide what a terminal shows: zero width, direction, line breaks, fillers, tags.
const HIDDEN: [(char, char); 17] = [
    ('\u{ad}', '\u{ad}'),
    ('\u{34f}', '\u{34f}'),
    ('\u{61c}', '\u{61c}'),
    ('\u{115f}', '\u{1160}'),
    ('\u{17b4}', '\u{17b5}'),
    ('\u{180b}', '\u{180f}'),
    ('\u{200b}', '\u{200f}'),
    ('\u{2028}', '\u{202e}'),
    ('\u{2060}', '\u{206f}'),
    ('\u{3164}', '\u{3164}'),
    ('\u{fe00}', '\u{fe0f}'),
    ('\u{feff}', '\u{feff}'),
    ('\u{ffa0}', '\u{ffa0}'),
    ('\u{fff0}', '\u{fffb}'),
    ('\u{1bca0}', '\u{1bca3}'),
    ('\u{1d173}', '\u{1d17a}'),
    ('\u{e0000}', '\u{e0fff}'),
];

/// The text with every control, bidirectional and zero-width character written out as `\u{..}`.
#[must_use]
pub fn visible(text: &str) -> Cow<'_, str> {
    escaped(text, is_hidden)
}

/// The same for a text of several lines, whose line ends stay.
#[must_use]
pub fn visible_lines(text: &str) -> Cow<'_, str> {
    escaped(text, |character| character != '\n' && is_hidden(character))
}

/// Whether a terminal would obey the character, or show nothing for it, instead of showing it.
#[must_use]
pub fn is_hidden(character: char) -> bool {
    character.is_control() || HIDDEN.iter().any(|&(first, last)| (first..=last).contains(&character))
}

fn escaped(text: &str, hidden: impl Fn(char) -> bool) -> Cow<'_, str> {
    if !text.contains(&hidden) {
        return Cow::Borrowed(text);
    }
    let mut safe = String::with_capacity(text.len() + 16);
    for character in text.chars() {
        if hidden(character) {
            safe.extend(character.escape_unicode());
        } else {
            safe.push(character);
        }
    }
    Cow::Owned(safe)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn controls_and_hidden_characters_are_written_out() {
        assert_eq!(visible("a\u{1b}[2Jb\u{9b}c\u{7f}\n"), r"a\u{1b}[2Jb\u{9b}c\u{7f}\u{a}");
        assert_eq!(visible("\u{202e}evil\u{2069}\u{200b}\u{feff}"), r"\u{202e}evil\u{2069}\u{200b}\u{feff}");
        assert_eq!(visible_lines("a\nb\r\n"), "a\nb\\u{d}\n");
    }

    #[test]
    fn letters_and_signs_stay() {
        for text in ["Zhou & Chen 2014", "Δ 47 µm, α_w", "歯車", "e\u{301}"] {
            assert_eq!(visible(text), text);
        }
    }
}
