//! Parts of the workbench for the tests of the screens, which are separate programs.

pub use crate::tui::app::App;
pub use crate::tui::app::actions::{Action, Effect, Slot, Work};
pub use crate::tui::app::dialogs::Prompt;
pub use crate::tui::app::dialogs::page::Explanation;
pub use crate::tui::app::dialogs::picker::Item;
pub use crate::tui::app::panes::chart::ChartRequest;
pub use crate::tui::app::panes::chart::curves::CurveSource;
pub use crate::tui::app::panes::study::End;
pub use crate::tui::app::panes::teeth::{Centre, Picture, TeethView};
pub use crate::tui::app::tab::{Origin, Tab};
pub use crate::tui::input::{Event, take_action};
pub use crate::tui::layout::Pane;
pub use crate::tui::session::journal::{Journal, JournalWriter};
pub use crate::tui::session::{Access, Autosave, Claim, Found, Next, Offer, SaveFault};
pub use crate::tui::settings::Settings;
pub use crate::tui::settings::{CONTRAST, Look, MONO};
pub use crate::tui::solver::{Answer, Request, Wanted};
pub use crate::tui::store::State;
pub use crate::tui::update::commands::{BINDINGS, of_key};
pub use crate::tui::update::{opened, update};
pub use crate::tui::workbench::Workers;

pub mod ascii {
    pub use crate::tui::text::{finish, is_safe, written_out};
}

pub mod commands {
    pub use crate::tui::update::commands::named;
}

pub mod effects {
    pub use crate::tui::workbench::{claimed, perform};
}

pub mod help {
    pub use crate::tui::update::commands::help as lines;
}

pub mod chart {
    pub use crate::tui::app::panes::chart::{first_contact, readout};
    pub mod curves {
        pub use crate::tui::app::panes::chart::curves::{curves, is_field};
    }
}

pub mod teeth {
    pub use crate::tui::app::panes::teeth::{draw, readings};
}

pub mod rows {
    pub use crate::tui::rows::{count, field, names, text};
}

pub mod solver {
    pub use crate::tui::solver::answer;
}

pub mod store {
    pub use crate::tui::store::built_in;
    pub mod case_search {
        pub use crate::tui::store::folder::find;
    }
    pub mod folder {
        pub use crate::tui::store::folder::{beneath, list};
    }
    pub mod recents {
        pub use crate::tui::store::looked_at;
    }
}

pub mod view {
    pub use crate::tui::view::draw;
}
