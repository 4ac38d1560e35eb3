//! A long session of random actions on a real terminal: memory stays flat, and the file is a case at every moment.
#![allow(clippy::expect_used, clippy::panic, clippy::unwrap_used, reason = "a test that cannot go on says why")]
#![allow(clippy::print_stdout, reason = "figures are told")]
#![cfg(all(feature = "cli", feature = "tui"))]

mod tty;

use std::fs;
use std::time::Duration;

use tipstrike::case::Document;
use tty::{Launch, TABLE_1, Tty};

/// `TIPSTRIKE_SOAK` says how many; the suite has no time for more.
const FEW: usize = 2000;
/// Growth that is still flat: caches and histories fill once.
const MOST_GROWTH: u64 = 6 << 10;
const QUIET: Duration = Duration::from_millis(60);

/// What a session is made of. None leaves the folder or the program.
const ACTIONS: [&[u8]; 30] = [
    b"\x151.25 in",
    b"\x155 mm",
    b"\x1522",
    b"\x150.1",
    b"\x15no number",
    b"7",
    b"\x7f",
    b"\t",
    b"\x1b[Z",
    b"\x1b[A",
    b"\x1b[B",
    b"\x1b[5~",
    b"\x1b[6~",
    b"\x1a",
    b"\x19",
    b"\x13",
    b"\x14",
    b"\x0c",
    b"\x1bOP",
    b"\x10",
    b"\x1b[C",
    b"\x1b[D",
    b"\x1b[1;5H",
    b"\x0f",
    b"other\r",
    b"\x0fcase\r",
    b"\x1b",
    b"\x0e",
    b"\x1b[200~ 5 mm\x1b[201~",
    b"\x1b\x1b",
];

/// A generator of its own, so that a session is the same every time.
fn next(state: &mut u64) -> usize {
    *state ^= *state << 13;
    *state ^= *state >> 7;
    *state ^= *state << 17;
    usize::try_from(*state >> 33).unwrap_or(0)
}

fn resident(tty: &Tty) -> u64 {
    let text = fs::read_to_string(format!("/proc/{}/status", tty.id())).expect("it runs");
    let rest = text.split_once("VmRSS:").map_or("", |(_, rest)| rest);
    rest.split_whitespace().next().and_then(|number| number.parse().ok()).unwrap_or(0)
}

#[test]
fn a_long_session_loses_nothing_and_does_not_grow() {
    let count = std::env::var("TIPSTRIKE_SOAK").ok().and_then(|count| count.parse().ok()).unwrap_or(FEW);
    let launch = Launch::on_table_1();
    fs::write(launch.folder.path().join("other.toml"), TABLE_1).expect("room on the disk");
    let mut tty = launch.start();
    tty.wait_for("quit");
    let (mut state, mut early, mut most) = (0x9e37_79b9_7f4a_7c15_u64, 0, 0);
    for step in 0..count {
        match next(&mut state) % 40 {
            0 => tty.resize((next(&mut state) % 60) as u16, (next(&mut state) % 200) as u16),
            1 => tty.resize(24, 80),
            action => tty.type_in(ACTIONS[action % ACTIONS.len()]),
        }
        tty.take_output(Duration::from_millis(1));
        if step % 100 == 99 {
            tty.settle(QUIET);
            assert!(!tty.has_ended(), "it ended at {step}:\n{}", tty.screen().contents());
            for name in ["case.toml", "other.toml"] {
                let text = fs::read_to_string(tty.folder.path().join(name)).expect("it is there");
                assert!(Document::parse(name, &text).is_ok(), "{name} at {step}: {text}");
            }
            most = most.max(resident(&tty));
            if step <= count / 4 {
                early = most;
            }
        }
    }
    println!("{count} actions: {early} KiB in the first quarter, {most} KiB at most");
    assert!(most <= early + MOST_GROWTH && most <= 30 << 10, "{early} KiB, then {most} KiB");
}
