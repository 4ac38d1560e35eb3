//! The walk of the README: its keys bring its sentences onto the screen, in the order in which they
//! stand there.
#![allow(
    clippy::expect_used,
    clippy::panic,
    clippy::unwrap_used,
    reason = "a test that cannot go on says why"
)]
#![cfg(feature = "tui")]

mod harness;

use harness::{Desk, LARGE, TABLE_1};

const README: &str = include_str!("../README.md");
const TITLE: &str = "### A question answered";

/// What stands in backquotes in a cell.
fn quoted(cell: &str) -> Vec<&str> {
    cell.split('`').skip(1).step_by(2).collect()
}

/// The keys of each step, and what the screen says after them.
fn steps() -> Vec<(Vec<&'static str>, Vec<&'static str>)> {
    let section = README
        .split_once(TITLE)
        .expect("the README has the walk")
        .1
        .split("\n#")
        .next()
        .unwrap_or_default();
    let rows = section.lines().filter(|line| line.starts_with('|')).skip(2);
    let step = |row: &'static str| {
        let cells: Vec<&str> = row.trim_matches('|').split(" | ").collect();
        (quoted(cells[0]), quoted(cells[1]))
    };
    rows.map(step).collect()
}

#[test]
fn each_step_brings_what_it_says() {
    let steps = steps();
    assert!(steps.len() >= 6, "{steps:?}");
    let mut desk = Desk::on(LARGE, "pair.toml", TABLE_1);
    for (keys, says) in &steps {
        desk.keys(keys);
        assert!(!says.is_empty(), "{keys:?}");
        for says in says {
            assert!(
                desk.screen().replace("DIR/", "").contains(says),
                "{keys:?} is to bring {says:?}:\n{}",
                desk.screen()
            );
        }
    }
    assert!(
        desk.read("pair.toml").contains("tip_relief = \"48 um\""),
        "the case is saved as the walk leaves it"
    );
}
