//! The panes that are components: each has its state, commands, update and drawing, and knows
//! nothing of the other panes or of the workbench.

pub mod chart;
pub mod teeth;
