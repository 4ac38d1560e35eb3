//! The panes of the workbench, and the stages of the model that each needs.

use super::keys::Place;
use crate::model::{Stage, Stages};

/// A part of the screen with its own title and keys.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Pane {
    /// Every field of the case.
    Form,
    /// Every quantity of the model.
    Results,
    /// Curves over the driver's roll angle.
    Chart,
    /// The teeth as they touch.
    Teeth,
    /// Accuracy of every method against its run time.
    Trade,
    /// A result over the range of a field, a map of two fields, or the tolerance.
    Study,
}

impl Pane {
    /// Every pane, in the order of its number.
    pub const ALL: [Pane; 6] =
        [Pane::Form, Pane::Results, Pane::Chart, Pane::Teeth, Pane::Trade, Pane::Study];
    /// The panes that share the lower area.
    pub(crate) const LOWER: [Pane; 4] = [Pane::Chart, Pane::Teeth, Pane::Trade, Pane::Study];

    /// The name of the pane.
    #[must_use]
    pub(crate) const fn name(self) -> &'static str {
        match self {
            Pane::Form => "Form",
            Pane::Results => "Results",
            Pane::Chart => "Chart",
            Pane::Teeth => "Teeth",
            Pane::Trade => "Trade",
            Pane::Study => "Study",
        }
    }

    /// The digit that selects the pane, from 1.
    #[must_use]
    pub const fn number(self) -> usize {
        self as usize + 1
    }

    /// The pane of a digit.
    pub(crate) fn of_digit(digit: char) -> Option<Pane> {
        let number = digit.to_digit(10)?;
        Pane::ALL.into_iter().find(|pane| pane.number() == number as usize)
    }

    /// Whether it shares the lower area.
    pub(crate) const fn is_lower(self) -> bool {
        matches!(self, Pane::Chart | Pane::Teeth | Pane::Trade | Pane::Study)
    }

    /// The stages of a solve that the pane shows, if the method has them.
    #[must_use]
    pub(crate) const fn needs(self) -> Stages {
        match self {
            Pane::Form | Pane::Trade | Pane::Study => Stages::NONE,
            Pane::Results => Stages::CLOSED_FORM
                .with(Stage::Band)
                .and(Stages::of(Stage::Resonance))
                .and(Stages::of(Stage::SteadyMotion))
                .and(Stages::of(Stage::SpeedRun))
                .and(Stages::of(Stage::Clearing)),
            Pane::Chart => Stages::STATIONS,
            Pane::Teeth => {
                Stages::of(Stage::Impact).and(Stages::of(Stage::Static)).with(Stage::Dynamic)
            }
        }
    }

    /// The place of keys while the pane has the focus and no field is edited.
    #[must_use]
    pub(crate) const fn place(self) -> Place {
        match self {
            Pane::Form => Place::FIELD,
            Pane::Results => Place::RESULTS,
            Pane::Chart => Place::CHART,
            Pane::Teeth => Place::TEETH,
            Pane::Trade => Place::TRADE,
            Pane::Study => Place::STUDY,
        }
    }

    /// The pane `by` places further, wrapping around.
    #[must_use]
    pub(crate) fn beside(self, by: isize) -> Pane {
        let count = Pane::ALL.len();
        Pane::ALL[(self as usize + count).saturating_add_signed(by) % count]
    }
}
