//! README and guide agree with the program: the commands of the README print its output, and the
//! keys of the guide bring its sentences onto the screen.
//!
//! `TIPSTRIKE_REGENERATE=1 cargo test --test workbench readme_session::` writes the output of the
//! commands again.
use crate::harness::{Desk, LARGE, TABLE_1};

use std::fmt::Write as _;
use std::process::Command;

const FOLDER: &str = env!("CARGO_MANIFEST_DIR");
const GUIDE: &str = include_str!("../../docs/guide.md");
const TITLE: &str = "## A question answered";
const CONSOLE: &str = "```console\n";

/// The texts in backquotes in a cell.
fn quoted(cell: &str) -> Vec<&str> {
    cell.split('`').skip(1).step_by(2).collect()
}

/// The keys of each step, and the sentences on the screen after them.
fn steps() -> Vec<(Vec<&'static str>, Vec<&'static str>)> {
    let (_, section) = GUIDE.split_once(TITLE).expect("the guide has the walk");
    let section = section.split("\n#").next().unwrap_or_default();
    let rows = section.lines().filter(|line| line.starts_with('|')).skip(2);
    let step = |row: &'static str| {
        let cells: Vec<&str> = row.trim_matches('|').split(" | ").collect();
        (quoted(cells[0]), quoted(cells[1]))
    };
    rows.map(step).collect()
}

#[test]
fn each_step_of_the_walk_shows_its_sentences() {
    let steps = steps();
    assert!(steps.len() >= 6, "{steps:?}");
    let mut desk = Desk::on(LARGE, "pair.toml", TABLE_1);
    for (keys, says) in &steps {
        desk.keys(keys);
        assert!(!says.is_empty(), "{keys:?}");
        for says in says {
            desk.assert_at((keys, says), desk.screen().replace("DIR/", "").contains(says));
        }
    }
    let saved = desk.read("pair.toml");
    assert!(saved.contains("tip_relief = \"48 um\""), "saved as the walk leaves it");
}

/// The block with the present output of its commands.
fn rerun(block: &str) -> String {
    let mut text = String::new();
    for command in block.lines().filter_map(|line| line.strip_prefix("$ ")) {
        let words: Vec<&str> = command.split_whitespace().collect();
        assert_eq!(words[0], "tipstrike", "{command}");
        let mut program = Command::new(env!("CARGO_BIN_EXE_tipstrike"));
        let output = program.args(&words[1..]).current_dir(FOLDER).output().expect("it runs");
        assert!(output.status.success(), "{command}: {output:?}");
        let printed = String::from_utf8(output.stdout).expect("the output is text");
        write!(text, "$ {command}\n{printed}").expect("a string");
    }
    text
}

#[test]
fn the_commands_of_the_readme_print_what_it_shows() {
    let path = format!("{FOLDER}/README.md");
    let readme = std::fs::read_to_string(&path).expect("the README");
    let (before, rest) = readme.split_once(CONSOLE).expect("a block of commands");
    let (block, after) = rest.split_once("```").expect("the end of the block");
    let output = rerun(block);
    if std::env::var_os("TIPSTRIKE_REGENERATE").is_some() {
        let text = format!("{before}{CONSOLE}{output}```{after}");
        std::fs::write(&path, text).expect("the README is written");
    } else {
        assert_eq!(block, output);
    }
}
