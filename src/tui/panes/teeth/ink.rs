//! The kinds of strokes in the picture of the teeth, and their styles.

use ratatui::style::{Color, Modifier, Style};

use crate::tui::theme::Theme;

/// The kind of a stroke.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
#[repr(u8)]
pub(crate) enum Ink {
    /// Base circles and line of action.
    Construction,
    /// The path of contact, and the path of the tip before it.
    Path,
    /// The driven gear.
    Driven,
    /// The incoming tooth.
    StruckDriven,
    Driver,
    /// The struck tooth.
    StruckDriver,
    /// A point with a name.
    Mark,
    /// A contact of two flanks.
    Contact,
}

impl Ink {
    const ALL: [Ink; 8] = [
        Ink::Construction,
        Ink::Path,
        Ink::Driven,
        Ink::StruckDriven,
        Ink::Driver,
        Ink::StruckDriver,
        Ink::Mark,
        Ink::Contact,
    ];

    #[must_use]
    pub(crate) fn style(self, theme: &Theme) -> Style {
        match self {
            Ink::Construction => theme.faint,
            Ink::Path => theme.path,
            Ink::Driven => theme.driven,
            Ink::StruckDriven => theme.driven.add_modifier(Modifier::BOLD),
            Ink::Driver => theme.driver,
            Ink::StruckDriver => theme.driver.add_modifier(Modifier::BOLD),
            Ink::Mark => theme.focus,
            Ink::Contact => theme.active,
        }
    }

    /// The canvas stores only colours: a colour number encodes the ink until the cells get their
    /// style.
    #[must_use]
    pub(crate) fn number(self) -> Color {
        Color::Indexed(self as u8)
    }

    /// The ink of a colour number.
    #[must_use]
    pub(crate) fn of(number: Color) -> Option<Ink> {
        Ink::ALL.into_iter().find(|ink| ink.number() == number)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_ink_has_its_own_number() {
        for ink in Ink::ALL {
            assert_eq!(Ink::of(ink.number()), Some(ink));
        }
        assert_eq!(Ink::of(Color::Reset), None);
    }
}
