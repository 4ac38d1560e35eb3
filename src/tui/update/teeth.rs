//! The teeth pane within the workbench: its commands.

use crate::tui::app::App;
use crate::tui::panes::teeth::TeethCommand;

/// Runs a command of the pane.
pub(super) fn run(app: &mut App, command: TeethCommand) {
    let mut view = app.teeth;
    let solved = app.picture().map(|picture| (picture.inputs, picture.solution));
    let result = view.run(command, solved);
    app.teeth = view;
    match result {
        Ok(Some(message)) => app.say(message),
        Ok(None) => (),
        Err(reason) => app.complain(reason),
    }
}
