//! A line of text that is edited, of which a part may be selected: what is typed then stands in its
//! place.

use std::ops::{Deref, Range};

use tui_input::{Input, InputRequest, StateChanged};

/// A line of text, the cursor in it and what is selected.
#[derive(Debug, Clone, Default)]
pub struct Line {
    input: Input,
    /// In characters, and never empty.
    selected: Option<Range<usize>>,
}

impl Line {
    /// A text that what is typed replaces.
    #[must_use]
    pub fn whole(text: impl Into<String>) -> Line {
        let mut line = Line::from(text.into());
        line.select_all();
        line
    }

    /// A path of which what is typed replaces the name, but for its ending.
    #[must_use]
    pub fn named(path: impl Into<String>) -> Line {
        let path = path.into();
        let name = path.rfind('/').map_or(0, |slash| slash + 1);
        let end = path
            .rfind('.')
            .filter(|&dot| dot > name)
            .unwrap_or(path.len());
        let place = |at: usize| path[..at].chars().count();
        let selected = place(name)..place(end);
        Line {
            input: Input::new(path).with_cursor(selected.end),
            selected: Some(selected).filter(|part| !part.is_empty()),
        }
    }

    /// What is selected, in characters.
    #[must_use]
    pub fn selected(&self) -> Option<Range<usize>> {
        self.selected.clone()
    }

    /// How many bytes stay when something is typed.
    #[must_use]
    pub fn kept(&self) -> usize {
        let is_selected = |at: &usize| self.selected.as_ref().is_some_and(|part| part.contains(at));
        let letters = self.input.value().chars().enumerate();
        letters
            .filter(|(at, _)| !is_selected(at))
            .map(|(_, letter)| letter.len_utf8())
            .sum()
    }

    /// Select the text, the cursor at its end.
    pub fn select_all(&mut self) {
        let length = self.input.value().chars().count();
        self.input.handle(InputRequest::GoToEnd);
        self.selected = (length > 0).then_some(0..length);
    }

    /// A key that moves in the line or deletes from it: the selected part goes as one, and a move
    /// lets go of it.
    pub fn handle(&mut self, request: InputRequest) -> Option<StateChanged> {
        use InputRequest::{DeleteNextChar, DeletePrevChar, GoToNextChar, GoToPrevChar};
        let Some(part) = self.selected.take() else {
            return self.input.handle(request);
        };
        match request {
            DeletePrevChar | DeleteNextChar => {
                self.put(part, "");
                Some(StateChanged {
                    value: true,
                    cursor: true,
                })
            }
            GoToPrevChar => self.input.handle(InputRequest::SetCursor(part.start)),
            GoToNextChar => self.input.handle(InputRequest::SetCursor(part.end)),
            other => self.input.handle(other),
        }
    }

    /// Text that is typed or pasted.
    pub fn insert(&mut self, typed: &str) {
        let here = self.input.cursor();
        let part = self.selected.take().unwrap_or(here..here);
        self.put(part, typed);
    }

    // One splice, where a character at a time would cost the square of a long paste.
    fn put(&mut self, part: Range<usize>, typed: &str) {
        let value = self.input.value();
        let place = |at: usize| {
            value
                .char_indices()
                .nth(at)
                .map_or(value.len(), |(place, _)| place)
        };
        let text = [
            &value[..place(part.start)],
            typed,
            &value[place(part.end)..],
        ]
        .concat();
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
        Line {
            input: Input::new(text),
            selected: None,
        }
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
    fn what_is_typed_replaces_what_is_selected_and_a_move_keeps_it() {
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
            assert_eq!(
                typed(Line::named("μ/case.toml"), requests),
                text,
                "{requests:?}"
            );
        }
        assert_eq!(typed(Line::whole("5 mm"), &[]), "x");
        assert_eq!(typed(Line::whole("5 mm"), &[DeletePrevWord]), "5 x");
        assert_eq!(typed(Line::from("5 mm"), &[]), "5 mmx");
    }

    #[test]
    fn a_name_is_selected_without_folder_and_ending() {
        for (path, selected) in [
            ("case.toml", 0..4),
            ("a.b/pair.v2.toml", 4..11),
            ("/a/pair", 3..7),
            (".toml", 0..5),
        ] {
            assert_eq!(Line::named(path).selected(), Some(selected), "{path}");
        }
        assert_eq!(
            (
                Line::named("μ/pair.toml").kept(),
                Line::from("μ").kept(),
                Line::whole("μ").kept()
            ),
            (8, 2, 0)
        );
        assert_eq!(
            (Line::named("a/").selected(), Line::whole("").selected()),
            (None, None)
        );
    }
}
