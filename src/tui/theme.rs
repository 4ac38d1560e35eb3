//! The colours of the workbench, and the capabilities of the terminal.

use std::ffi::OsString;

use ratatui::style::{Color, Modifier, Style};

/// The style of each kind of text. No meaning depends on colour alone.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Theme {
    /// The name in the settings.
    pub(crate) name: &'static str,
    /// Titles of panes and groups.
    pub(crate) title: Style,
    /// Rules and axes.
    pub(crate) rule: Style,
    /// The focused line.
    pub(crate) focus: Style,
    /// Defaults of empty fields, and outdated results.
    pub(crate) faint: Style,
    /// Errors.
    pub(crate) problem: Style,
    /// Notes.
    pub(crate) note: Style,
    /// The method of the case, and its curve.
    pub(crate) active: Style,
    /// Another method, and its curve.
    pub(crate) other: Style,
    /// The name of a key, and the title of the focused pane.
    pub(crate) key: Style,
    /// The pinned results, and their curve.
    pub(crate) baseline: Style,
    /// The driver's outline.
    pub(crate) driver: Style,
    /// The driven gear's outline.
    pub(crate) driven: Style,
    /// The path of contact.
    pub(crate) path: Style,
}

/// Every theme.
pub(crate) static THEMES: [&Theme; 3] = [&QUIET, &CONTRAST, &MONO];

impl Theme {
    /// The theme with a name in the settings.
    pub(crate) fn find(name: &str) -> Option<&'static Theme> {
        THEMES.into_iter().find(|theme| theme.name == name)
    }

    /// The next theme, wrapping around.
    pub(crate) fn next(&self) -> &'static Theme {
        let at = THEMES.iter().position(|theme| *theme == self).unwrap_or(0);
        THEMES[(at + 1) % THEMES.len()]
    }
}

/// The capabilities of the terminal.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Look {
    /// Colours and attributes.
    pub theme: &'static Theme,
    /// Whether the screen uses only ASCII.
    pub ascii: bool,
}

/// Attributes and a few of the terminal's own colours.
pub(crate) static QUIET: Theme = Theme {
    name: "quiet",
    title: Style::new().fg(Color::Cyan).add_modifier(Modifier::BOLD),
    rule: Style::new(),
    focus: Style::new().add_modifier(Modifier::BOLD),
    faint: Style::new().add_modifier(Modifier::DIM),
    problem: Style::new().fg(Color::Red).add_modifier(Modifier::BOLD),
    note: Style::new().fg(Color::Yellow),
    active: Style::new().fg(Color::Green).add_modifier(Modifier::BOLD),
    other: Style::new().fg(Color::Magenta),
    key: Style::new().add_modifier(Modifier::REVERSED),
    // Plain blue is hard to read on black.
    baseline: Style::new().fg(Color::LightBlue),
    driver: Style::new().fg(Color::Cyan),
    driven: Style::new().fg(Color::Yellow),
    path: Style::new().fg(Color::Magenta),
};

/// Bright colours and bold letters, for terminals on which the quiet ones are hard to read.
pub static CONTRAST: Theme = Theme {
    name: "contrast",
    title: Style::new().fg(Color::LightCyan).add_modifier(Modifier::BOLD),
    focus: Style::new().add_modifier(Modifier::BOLD).add_modifier(Modifier::UNDERLINED),
    faint: Style::new(),
    problem: Style::new().fg(Color::LightRed).add_modifier(Modifier::BOLD),
    note: Style::new().fg(Color::LightYellow).add_modifier(Modifier::BOLD),
    active: Style::new().fg(Color::LightGreen).add_modifier(Modifier::BOLD),
    other: Style::new().fg(Color::LightMagenta).add_modifier(Modifier::BOLD),
    baseline: Style::new().fg(Color::LightBlue).add_modifier(Modifier::BOLD),
    driver: Style::new().fg(Color::LightCyan),
    driven: Style::new().fg(Color::LightYellow),
    path: Style::new().fg(Color::LightMagenta),
    ..QUIET
};

/// Attributes only.
pub static MONO: Theme = Theme {
    name: "mono",
    title: Style::new().add_modifier(Modifier::BOLD),
    problem: Style::new().add_modifier(Modifier::BOLD),
    note: Style::new(),
    active: Style::new().add_modifier(Modifier::BOLD),
    other: Style::new(),
    baseline: Style::new(),
    driver: Style::new(),
    driven: Style::new(),
    path: Style::new(),
    ..QUIET
};

impl Look {
    /// Colours and full Unicode.
    pub const FULL: Look = Look { theme: &QUIET, ascii: false };

    /// The capabilities according to the environment: `NO_COLOR`, `TERM`, and the locale by
    /// `LC_ALL`, `LC_CTYPE`, `LANG`.
    pub(crate) fn of(variable: impl Fn(&str) -> Option<OsString>) -> Look {
        let set = |name| variable(name).filter(|value| !value.is_empty());
        let locale = ["LC_ALL", "LC_CTYPE", "LANG"].into_iter().find_map(set).unwrap_or_default();
        let locale = locale.to_string_lossy().to_ascii_lowercase();
        let utf8 = locale.contains("utf-8") || locale.contains("utf8");
        let term = set("TERM").unwrap_or_default();
        let bare = term == "linux" || term.to_string_lossy().starts_with("vt");
        Look { theme: if set("NO_COLOR").is_some() { &MONO } else { &QUIET }, ascii: bare || !utf8 }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn look(variables: &[(&str, &str)]) -> Look {
        Look::of(|name| {
            variables.iter().find(|(key, _)| *key == name).map(|(_, value)| (*value).into())
        })
    }

    #[test]
    fn unicode_needs_a_utf8_locale_and_a_terminal_with_the_fonts() {
        assert!(!look(&[("TERM", "xterm"), ("LANG", "en_GB.UTF-8")]).ascii);
        assert!(!look(&[("TERM", "xterm"), ("LC_ALL", "C.utf8"), ("LANG", "C")]).ascii);
        for variables in [
            &[("TERM", "xterm"), ("LANG", "C")][..],
            &[("TERM", "xterm")],
            &[("TERM", "linux"), ("LANG", "C.UTF-8")],
            &[("TERM", "vt100"), ("LANG", "C.UTF-8")],
            &[("TERM", "xterm"), ("LC_ALL", "POSIX"), ("LANG", "C.UTF-8")],
        ] {
            assert!(look(variables).ascii, "{variables:?}");
        }
    }

    #[test]
    fn no_color_leaves_no_colour() {
        let theme = look(&[("NO_COLOR", "1")]).theme;
        for style in [
            theme.title,
            theme.problem,
            theme.note,
            theme.active,
            theme.other,
            theme.key,
            theme.baseline,
            theme.driver,
            theme.driven,
            theme.path,
        ] {
            assert_eq!(style.fg.or(style.bg), None);
        }
        assert_eq!(look(&[("NO_COLOR", "")]).theme, &QUIET);
    }
}
