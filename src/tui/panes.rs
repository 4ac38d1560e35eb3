//! The panes that are components: each has its state, commands, update and drawing, and knows
//! nothing of the other panes or of the workbench.

pub(crate) mod chart;
pub(crate) mod form;
pub(crate) mod plot;
pub(crate) mod results;
pub(crate) mod study;
pub(crate) mod teeth;
pub(crate) mod title;
pub(crate) mod trade;
