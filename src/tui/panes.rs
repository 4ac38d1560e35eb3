//! The panes that are components: each has its state, commands, update and drawing, and knows
//! nothing of the other panes or of the workbench.

pub mod chart;
pub mod form;
pub mod results;
pub mod study;
pub mod teeth;
pub mod title;
pub mod trade;
