//! Parts of the workbench for the tests of the screens, which are separate programs.

pub mod actions {
    pub use crate::tui::app::actions::{Action, Effect, Work};
    pub use crate::tui::update::commands::of_key;
}

pub mod app {
    pub use crate::tui::app::App;
}

pub mod ascii {
    pub use crate::tui::text::{finish, is_safe, written_out};
}

pub mod commands {
    pub use crate::tui::update::commands::{BINDINGS, named};
}

pub mod dialogs {
    pub use crate::tui::app::dialogs::Prompt;
    pub use crate::tui::app::dialogs::page::Explanation;
    pub use crate::tui::app::dialogs::picker::Item;
}

pub mod effects {
    pub use crate::tui::workbench::{claimed, perform};
}

pub mod events {
    pub use crate::tui::input::{Event, take_action};
}

pub mod help {
    pub use crate::tui::update::commands::help as lines;
}

pub mod jobs {
    pub use crate::tui::app::actions::Slot;
}

pub mod pane {
    pub use crate::tui::layout::Pane;
}

pub mod chart {
    pub use crate::tui::panes::chart::{first_contact, readout};

    pub mod curves {
        pub use crate::tui::panes::chart::curves::{CurveSource, curves, is_field};
    }
}

pub mod teeth {
    pub use crate::tui::panes::teeth::{Centre, Picture, TeethView, draw, readings};
}

pub mod rows {
    pub use crate::tui::rows::{count, field, names, text};
}

pub mod session {
    pub use crate::tui::session::Autosave;
    pub use crate::tui::session::journal::Journal;
    pub use crate::tui::session::journal::JournalWriter;
    pub use crate::tui::session::{Access, Claim, Found, Next, Offer, SaveFault};
}

pub mod settings {
    pub use crate::tui::settings::Settings;
}

pub mod solver {
    pub use crate::tui::solver::{Answer, Request, answer};
}

pub mod store {
    pub use crate::tui::store::State;
    pub use crate::tui::store::built_in;

    pub mod case_search {
        pub use crate::tui::store::folder::{SearchResult, find};
    }

    pub mod folder {
        pub use crate::tui::store::folder::{beneath, list};
    }

    pub mod recents {
        pub use crate::tui::store::looked_at;
    }
}

pub mod study {
    pub use crate::tui::panes::study::{End, StudyParameters};
}

pub mod tab {
    pub use crate::tui::tab::{Origin, Tab};
}

pub mod theme {
    pub use crate::tui::theme::{CONTRAST, Look, MONO};
}

pub mod update {
    pub use crate::tui::update::{opened, update};
}

pub mod view {
    pub use crate::tui::view::draw;
}

pub mod worker_chart {
    pub use crate::tui::panes::chart::ChartRequest;
}

pub mod worker {
    pub use crate::tui::workbench::Workers;
}
