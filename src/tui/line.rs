//! A line of text with a cursor and a selection, which typing replaces.

use std::ops::{Deref, Range};

use tui_input::{Input, InputRequest, StateChanged};

/// The extension of a case file.
pub(super) const CASE_ENDING: &str = ".toml";

/// The extensions of an export, of which a typed one replaces the suggested one.
const EXPORT_ENDINGS: [&str; 5] = [".html", ".md", ".csv", ".json", ".svg"];

/// A line of text with a cursor and a selection.
#[derive(Debug, Clone, Default)]
pub struct Line {
    input: Input,
    /// In characters; never an empty range.
    selected: Option<Range<usize>>,
    /// The extension that typing keeps; `None` for a line that is not a path.
    ending: Option<String>,
}

impl Line {
    /// A text that typing replaces.
    pub(crate) fn whole(text: impl Into<String>) -> Line {
        let mut line = Line::from(text.into());
        line.select_all();
        line
    }

    /// A path in which typing replaces the file stem and keeps folder and extension. A typed path
    /// from the root or from home also replaces the folder, and a typed extension replaces the old
    /// one.
    pub(crate) fn named(path: impl Into<String>) -> Line {
        let path = path.into();
        let name = path.rfind('/').map_or(0, |slash| slash + 1);
        let end = path.rfind('.').filter(|&dot| dot > name).unwrap_or(path.len());
        let place = |at: usize| path[..at].chars().count();
        let selected = place(name)..place(end);
        Line {
            ending: Some(path[end..].to_owned()),
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
        if self.ending.is_some() && !part.is_empty() && typed.starts_with(['/', '~']) {
            part.start = 0;
        }
        self.put(part, typed);
        self.drop_repeated_ending();
    }

    // Drops the kept extension if the typed name has an extension.
    fn drop_repeated_ending(&mut self) {
        let Some(ending) = self.ending.as_deref().filter(|ending| !ending.is_empty()) else {
            return;
        };
        let cursor = self.input.cursor();
        let typed: String = self.input.value().chars().take(cursor).collect();
        let is_rest = self.input.value().strip_prefix(&typed) == Some(ending);
        let exports = EXPORT_ENDINGS.iter().filter(|_| EXPORT_ENDINGS.contains(&ending));
        let mut known = exports.copied().chain([ending, CASE_ENDING]);
        if is_rest && known.any(|known| typed.ends_with(known)) {
            self.input = Input::new(typed).with_cursor(cursor);
        }
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
        Line { input: Input::new(text), selected: None, ending: None }
    }
}

impl From<&str> for Line {
    fn from(text: &str) -> Line {
        Line::from(text.to_owned())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use InputRequest::{
        DeleteNextChar, DeletePrevChar, DeletePrevWord, GoToEnd, GoToNextChar, GoToPrevChar,
        GoToStart,
    };

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
            (&[][..], "μ/x.toml"),
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
    fn a_typed_extension_replaces_the_kept_one() {
        for (path, typed, text) in [
            ("case.toml", "pair.toml", "pair.toml"),
            ("a/case.toml", "pair.v2.toml", "a/pair.v2.toml"),
            ("a/case.toml", "pair.v2", "a/pair.v2.toml"),
            ("a/case.txt", "pair.toml", "a/pair.toml"),
            ("a/case.txt", "pair.txt", "a/pair.txt"),
            ("a/case", "pair.toml", "a/pair.toml"),
            ("a/case.html", "pair.svg", "a/pair.svg"),
            ("a/case.toml", "pair.svg", "a/pair.svg.toml"),
            ("a/case.toml", "/b/pair.toml", "/b/pair.toml"),
            ("a/case.toml", "~/pair", "~/pair.toml"),
            ("a/case.toml", "b/pair", "a/b/pair.toml"),
        ] {
            let mut pasted = Line::named(path);
            pasted.insert(typed);
            let mut letters = Line::named(path);
            for letter in typed.chars() {
                letters.insert(letter.encode_utf8(&mut [0; 4]));
            }
            assert_eq!((pasted.value(), letters.value()), (text, text), "{path}");
        }
    }

    #[test]
    fn a_name_is_selected_without_folder_and_ending() {
        for (path, selected) in
            [("case.toml", 0..4), ("a.b/pair.v2.toml", 4..11), ("/a/pair", 3..7), (".toml", 0..5)]
        {
            assert_eq!(Line::named(path).selected(), Some(selected), "{path}");
        }
        assert_eq!(
            (Line::named("μ/pair.toml").kept(), Line::from("μ").kept(), Line::whole("μ").kept()),
            (8, 2, 0)
        );
        assert_eq!((Line::named("a/").selected(), Line::whole("").selected()), (None, None));
    }
}
