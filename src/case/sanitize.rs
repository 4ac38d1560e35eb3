//! Foreign text: made safe to show, and the known name nearest to a mistyped one.

/// Greatest number of characters of a foreign text in a message.
const MOST: usize = 60;

/// The text with control, direction and zero-width characters escaped, such as `\u{1b}`.
pub fn sanitize(text: &str) -> String {
    let mut shown = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '\n' | '\r' | '\t' => shown.extend(c.escape_default()),
            _ if is_hidden(c) => shown.extend(c.escape_unicode()),
            _ => shown.push(c),
        }
    }
    shown
}

/// The sanitized text on one line: a space replaces each line break and the spaces around it.
pub fn one_line(text: &str) -> String {
    let lines = text.lines().map(str::trim).filter(|line| !line.is_empty());
    sanitize(&lines.collect::<Vec<_>>().join(" "))
}

/// The sanitized text for a message, cut if it is long.
pub fn cut(text: &str) -> String {
    let mut shown: String = text.chars().take(MOST).collect();
    if shown.len() < text.len() {
        shown.push('…');
    }
    sanitize(&shown)
}

/// The text from [`cut`] in backquotes.
pub fn quoted(text: &str) -> String {
    format!("`{}`", cut(text))
}

/// Whether a character controls the screen or is invisible.
pub fn is_hidden(c: char) -> bool {
    c.is_control() || HIDDEN.iter().any(|&(from, to)| (from..=to).contains(&c))
}

const HIDDEN: [(char, char); 18] = [
    ('\u{ad}', '\u{ad}'),       // soft hyphen
    ('\u{34f}', '\u{34f}'),     // combining grapheme joiner
    ('\u{61c}', '\u{61c}'),     // Arabic letter mark
    ('\u{115f}', '\u{1160}'),   // Hangul fillers
    ('\u{17b4}', '\u{17b5}'),   // Khmer inherent vowels
    ('\u{180b}', '\u{180f}'),   // Mongolian selectors
    ('\u{200b}', '\u{200f}'),   // zero width, direction marks
    ('\u{2028}', '\u{202e}'),   // line separators, direction overrides
    ('\u{2060}', '\u{206f}'),   // invisible operators, isolates
    ('\u{3164}', '\u{3164}'),   // Hangul filler
    ('\u{e000}', '\u{f8ff}'),   // private use
    ('\u{fe00}', '\u{fe0f}'),   // variation selectors
    ('\u{feff}', '\u{feff}'),   // byte order mark
    ('\u{ffa0}', '\u{ffa0}'),   // half-width Hangul filler
    ('\u{fff0}', '\u{fffb}'),   // interlinear annotation
    ('\u{1bca0}', '\u{1bca3}'), // shorthand format
    ('\u{1d173}', '\u{1d17a}'), // musical format
    ('\u{e0000}', '\u{e0fff}'), // tags and selectors
];

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

/// A symbol in ASCII.
pub fn spelled(text: &str) -> String {
    WRITTEN_OUT.iter().fold(text.to_owned(), |text, (from, to)| text.replace(from, to))
}

/// Length limit of a mistyped name, because a comparison of long texts is slow.
const LONGEST: usize = 64;

/// The nearest known name if it is near enough.
pub(crate) fn nearest<'n>(typed: &str, known: impl Iterator<Item = &'n str>) -> Option<&'n str> {
    if typed.len() > LONGEST {
        return None;
    }
    let short = typed.chars().count() <= 2;
    let limit = if short { 0.4 } else { 0.65 };
    let likeness = |name: &str| {
        let same_letters = typed.eq_ignore_ascii_case(name);
        if same_letters {
            1.0
        } else {
            strsim::normalized_damerau_levenshtein(&typed.to_lowercase(), &name.to_lowercase())
        }
    };
    let letters = sorted(typed);
    // With equal distances, prefers the name with the same letters: "mu" is a transposed "um", not
    // "m".
    let known = known.map(|name| (likeness(name), sorted(name) == letters, name));
    let near = known.filter(|&(likeness, ..)| likeness >= limit);
    near.min_by(|a, b| b.0.total_cmp(&a.0).then(b.1.cmp(&a.1))).map(|(.., name)| name)
}

fn sorted(name: &str) -> Vec<char> {
    let mut letters: Vec<char> = name.to_lowercase().chars().collect();
    letters.sort_unstable();
    letters
}

/// "did you mean X?" if a name is near enough, otherwise the fallback.
pub(crate) fn suggestion<'n>(
    typed: &str,
    known: impl Iterator<Item = &'n str>,
    fallback: impl FnOnce() -> String,
) -> String {
    nearest(typed, known).map_or_else(fallback, |name| format!("did you mean {name}?"))
}

#[cfg(test)]
mod tests {
    use super::{nearest, quoted, sanitize};

    #[test]
    fn no_control_character_passes() {
        assert_eq!(sanitize("a\u{1b}[2Jb\u{9b}c\n"), r"a\u{1b}[2Jb\u{9b}c\n");
        assert_eq!(sanitize("\u{202e}abc\u{200b}\u{feff}"), r"\u{202e}abc\u{200b}\u{feff}");
    }

    #[test]
    fn ordinary_text_stays_unchanged() {
        assert_eq!(sanitize("Zähne, 歯車, α = 20°"), "Zähne, 歯車, α = 20°");
    }

    #[test]
    fn a_long_text_is_cut() {
        assert_eq!(quoted(&"x".repeat(1000)).chars().count(), 63);
    }

    #[test]
    fn a_misspelling_finds_its_name_and_another_word_finds_none() {
        let known = ["module", "pressure_angle", "centre_distance"];
        assert_eq!(nearest("modul", known.into_iter()), Some("module"));
        assert_eq!(nearest("center_distance", known.into_iter()), Some("centre_distance"));
        assert_eq!(nearest("colour", known.into_iter()), None);
        assert_eq!(nearest("mu", ["mm", "um", "m"].into_iter()), Some("um"));
    }
}
