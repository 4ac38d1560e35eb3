//! The panes as components. Each has its state, commands, update and drawing, and does not depend
//! on the other panes or on the workbench.

pub(crate) mod chart;
pub(crate) mod form;
pub(crate) mod plot;
pub(crate) mod results;
pub(crate) mod study;
pub(crate) mod teeth;
pub(crate) mod title;
pub(crate) mod trade;
