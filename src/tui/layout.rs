//! The visible panes and their areas.

mod plan;

use ratatui::layout::Size;

use super::pane::Pane;
use plan::{Panes, Plan, plan};
pub(crate) use plan::{SMALLEST, is_too_small};

/// The visible panes, and the areas that follow from them and the size of the terminal. The areas
/// are computed once per change.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Layout {
    size: Size,
    panes: Panes,
    plan: Plan,
}

impl Layout {
    /// The default panes on a terminal of a size.
    pub(crate) fn new(size: Size) -> Layout {
        let panes = Panes::default();
        Layout { size, panes, plan: plan(size, panes) }
    }

    /// The size of the terminal.
    #[must_use]
    pub fn size(&self) -> Size {
        self.size
    }

    /// The areas of the screen.
    #[must_use]
    pub fn plan(&self) -> Plan {
        self.plan
    }

    /// The areas on a terminal whose new size has not been reported yet.
    pub(crate) fn plan_on(&self, size: Size) -> Plan {
        if size == self.size { self.plan } else { plan(size, self.panes) }
    }

    /// The pane with the focus.
    #[must_use]
    pub fn focus(&self) -> Pane {
        self.panes.focus
    }

    /// The pane of the lower area.
    pub(crate) fn lower(&self) -> Pane {
        self.panes.lower
    }

    /// Whether the focused pane fills the screen.
    pub(crate) fn is_zoomed(&self) -> bool {
        self.panes.is_zoomed
    }

    /// Adapts to a new size of the terminal.
    pub fn resize(&mut self, size: Size) {
        self.size = size;
        self.update();
    }

    /// Moves the focus to a pane.
    pub(crate) fn focus_on(&mut self, pane: Pane) {
        self.panes.focus = pane;
        self.update();
    }

    /// Shows a pane in the lower area.
    pub(crate) fn show_below(&mut self, pane: Pane) {
        self.panes.lower = pane;
        self.update();
    }

    /// Makes the focused pane fill the screen, or restores the layout.
    pub(crate) fn zoom(&mut self, is_zoomed: bool) {
        self.panes.is_zoomed = is_zoomed;
        self.update();
    }

    fn update(&mut self) {
        self.plan = plan(self.size, self.panes);
    }
}
