//! Lines of a page of text.

/// Greatest width of a line of a text report.
pub(super) const WIDTH: usize = 80;

/// The words set into lines of at most `width` characters; a longer word is cut.
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

/// The sentence set into lines, those after the first moved in as far as the mark before it.
pub(super) fn item(mark: &str, sentence: &str) -> Vec<String> {
    let indent = count(mark);
    let lines = flow(sentence.split_whitespace(), WIDTH.saturating_sub(indent));
    let lead = |index| if index == 0 { mark.to_owned() } else { " ".repeat(indent) };
    lines.iter().enumerate().map(|(index, line)| lead(index) + line).collect()
}

/// The greatest number of characters among the texts.
pub(super) fn widest<'a>(texts: impl IntoIterator<Item = &'a str>) -> usize {
    texts.into_iter().map(count).max().unwrap_or(0)
}

/// Characters of a text, each of which takes one column in all that the tables hold.
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
    fn an_item_hangs_behind_its_mark() {
        let lines = item("  - ", &"word ".repeat(20));
        assert!(lines[0].starts_with("  - word") && lines[1].starts_with("    word"));
        assert!(lines.iter().all(|line| count(line) <= WIDTH));
    }
}
