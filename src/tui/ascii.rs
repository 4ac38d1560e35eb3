//! The last pass over a screen: removes control characters, limits combining marks and writes plain
//! ASCII if the terminal needs it.

use std::borrow::Cow;

use ratatui::buffer::Buffer;

use crate::case::sanitize::is_hidden;

/// Replaces a character that must not reach a terminal.
const VEILED: char = '\u{FFFD}';

/// Greatest number of combining marks per cell.
const MOST_MARKS: usize = 8;

/// Symbols and their spelling in ASCII.
const WRITTEN_OUT: [(&str, &str); 34] = [
    ("ΔV_", "dV_"),
    ("Δf", "Df"),
    ("Δ", "Delta"),
    ("δ", "delta"),
    ("α", "alpha"),
    ("θ", "theta"),
    ("ρ", "rho"),
    ("τ", "tau"),
    ("ε", "eps"),
    ("ν", "nu"),
    ("κ", "kappa"),
    ("μ", "mu"),
    ("µ", "mu"),
    ("π", "pi"),
    ("ω", "omega"),
    ("Σ", "Sum"),
    ("η", "eta"),
    ("ζ", "zeta"),
    ("χ", "chi"),
    ("γ", "gamma"),
    ("ψ", "psi"),
    ("β", "beta"),
    ("√", "sqrt"),
    ("∫", "integral"),
    ("²", "^2"),
    ("³", "^3"),
    ("⁴", "^4"),
    ("·", "*"),
    ("×", "x"),
    ("−", "-"),
    ("Ö", "Oe"),
    ("ü", "ue"),
    ("ä", "ae"),
    ("ö", "oe"),
];

/// ASCII replacements of single cells.
const ONE_CELL: [(&str, char); 31] = [
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
    if text.chars().all(is_safe) {
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
    Cow::Owned(WRITTEN_OUT.iter().fold(text.to_owned(), |text, (from, to)| text.replace(from, to)))
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
    for cell in &mut buffer.content {
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
    use ratatui::buffer::Cell;
    use ratatui::layout::Rect;

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
