//! The part of a text to parse. Limits the number of lines with content.

/// Limit of the lines with keys, values or tables. All fields, limits and distributions together
/// need fewer lines, even with each brace on its own line.
const MOST_LINES: usize = 4000;

#[derive(Clone, Copy, PartialEq, Eq)]
enum State {
    Plain,
    Comment,
    /// In a single-line string with this quote.
    String(u8),
    /// In a multi-line string with this quote.
    Block(u8),
}

/// The text up to the limit, and the number of following lines with keys, values or tables.
pub(super) fn excerpt(text: &str) -> (&str, usize) {
    let bytes = text.as_bytes();
    let (mut state, mut at) = (State::Plain, 0);
    let (mut line, mut is_counted) = (0, false);
    let (mut count, mut end) = (0_usize, text.len());
    while let Some(&byte) = bytes.get(at) {
        let is_content = !byte.is_ascii_whitespace() && byte != b'#';
        if state == State::Plain && is_content && !is_counted {
            is_counted = true;
            count += 1;
            if count == MOST_LINES + 1 {
                end = line;
            }
        }
        let step;
        (state, step) = next(state, &bytes[at..]);
        at += step;
        if byte == b'\n' {
            (line, is_counted) = (at, false);
        }
    }
    (&text[..end], count.saturating_sub(MOST_LINES))
}

/// The state after the next step, and the length of the step in bytes. A line end is always its own
/// step.
fn next(state: State, rest: &[u8]) -> (State, usize) {
    let byte = rest.first().copied().unwrap_or_default();
    let is_triple = rest.starts_with(&[byte; 3]);
    match state {
        State::Plain => match byte {
            b'#' => (State::Comment, 1),
            b'"' | b'\'' if is_triple => (State::Block(byte), 3),
            b'"' | b'\'' => (State::String(byte), 1),
            _ => (State::Plain, 1),
        },
        _ if byte == b'\n' && !matches!(state, State::Block(_)) => (State::Plain, 1),
        State::String(quote) if byte == quote => (State::Plain, 1),
        State::Block(quote) if byte == quote && is_triple => (State::Plain, 3),
        State::String(b'"') | State::Block(b'"')
            if byte == b'\\' && rest.get(1).is_some_and(|next| *next != b'\n') =>
        {
            (state, 2)
        }
        _ => (state, 1),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn only_lines_with_content_are_counted() {
        let filler = "\n  # a = 1\n\t\r\n".repeat(MOST_LINES);
        for quotes in ["\"\"\"", "'''"] {
            let notes =
                format!("notes = {quotes}{}{quotes}\n", "a = 1 \\\\\"'\n".repeat(2 * MOST_LINES));
            let text = format!("{filler}{notes}b = \"\\\"#\"\n{filler}");
            assert_eq!(excerpt(&text), (text.as_str(), 0));
        }
    }

    #[test]
    fn a_text_is_cut_at_a_line_and_the_rest_is_counted() {
        let text = "# flood\n".to_owned() + &"a = 1\n".repeat(MOST_LINES + 7);
        let (part, more) = excerpt(&text);
        assert_eq!((part.lines().count(), more), (MOST_LINES + 1, 7));
        assert!(part.ends_with("a = 1\n"));
        let longest = "a = 1\n".repeat(MOST_LINES);
        assert_eq!(excerpt(&longest), (longest.as_str(), 0));
    }
}
