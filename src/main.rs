//! The program: a workbench in the terminal, and the same from scripts.

fn main() {}
