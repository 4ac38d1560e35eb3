//! A long session of random actions on a real terminal: no fault, constant memory, and every file
//! valid at every moment. `fuzz::form` compares form and file after a save.

use crate::tty::{Launch, TABLE_1, Tty, journals};

use std::fs;
use std::path::{Path, PathBuf};
use std::time::{Duration, Instant};

use tipstrike::case::Document;
use tipstrike::tui::testing::Journal;

/// Default number of actions; `TIPSTRIKE_SOAK` sets another one.
const FEW: usize = 1000;
/// Accepted growth: caches and histories fill once.
const MOST_GROWTH: u64 = 6 << 10;
const QUIET: Duration = Duration::from_millis(60);
/// Number of actions between two checks of the files.
const LOOK: usize = 100;
/// File extensions for `:export`.
const EXPORTS: [&str; 5] = [".html", ".md", ".csv", ".json", ".svg"];

/// The actions of a session. None leaves the folder, and the session refuses each question to quit.
#[rustfmt::skip]
const ACTIONS: [&[u8]; 77] = [
    // Edits.
    b"\x151.25 in", b"\x155 mm", b"\x1522", b"\x150.1", b"\x15no number", b"7", b"\x7f", b"\x1b[3~", b"\x17", b" ", b"+", b"-",
    b"\x1b[1;2A", b"\x1b[1;2B", b"\x1b[200~ 5 mm\x1b[201~", b"\x15\x1b[200~a\x07b\r\nc\x1b[201~", b"\x0b", b"\x01",
    // Navigation in form and results.
    b"\t", b"\x1b[Z", b"\x1b[A", b"\x1b[B", b"\x1b[C", b"\x1b[D", b"\x1b[5~", b"\x1b[6~", b"\x1b[1;5H", b"\x1b[1;5F", b"j", b"k",
    b"/", b"\r", b"\x1bOS",
    // Undo, redo, save, save elsewhere, methods.
    b"\x1a", b"\x1a\x1a", b"\x19", b"\x12", b"\x13", b"\x13", b"\x1bOQ\r", b"\x14",
    // Cases and tabs.
    b"\x0f", b"\x0fother\r", b"\x0fcase\r", b"\x0fcase\r", b"other\r", b"\x0e", b"\x1bw", b"\x1b1", b"\x1b2", b"\x1b[5;5~",
    b"\x1b[6;5~", b"\x1br", b"\x1bwd", b"\x1bwd",
    // Panes, cursor, teeth.
    b"1", b"2", b"3", b"4", b"\x1b[15~", b"\x1b[20~", b"b", b"y", b"v", b"x",
    // Help, palette, settings, redrawing.
    b"\x1bOP", b"\x10", b"\x10units\r", b"\x10ascii\r", b"\x10theme\r", b"\x10mouse\r", b"\x1bm", b"\x0c",
    // Back.
    b"\x1b", b"\x1b", b"\x1b\x1b", b"\x1b[<0;20;8M",
];

struct Soak {
    tty: Tty,
    random: u64,
    looks: usize,
    suspensions: usize,
}

impl Soak {
    /// A separate random generator, so that every session is the same.
    fn next(&mut self, below: usize) -> usize {
        self.random ^= self.random << 13;
        self.random ^= self.random >> 7;
        self.random ^= self.random << 17;
        usize::try_from(self.random >> 33).unwrap_or(0) % below
    }

    fn step(&mut self) {
        match self.next(120) {
            0..3 => {
                let (rows, columns) = (self.next(60), self.next(200));
                self.tty.resize(rows as u16, columns as u16);
            }
            3 => self.tty.resize(24, 80),
            4 => self.cancel(),
            5 if self.next(2) == 0 => self.suspend(),
            _ => {
                let keys = ACTIONS[self.next(ACTIONS.len())];
                self.tty.type_in(keys);
            }
        }
        self.tty.take_output(Duration::from_millis(1));
        // The palette also lists the command that suspends.
        self.tty.wake();
    }

    /// Ctrl-C or Ctrl-\, and no to the question.
    fn cancel(&mut self) {
        let key: &[u8] = if self.next(2) == 0 { b"\x03" } else { b"\x1c" };
        // In a suspended workbench such a key would end the process.
        self.be_there();
        for key in [key, b"\x1b"] {
            self.tty.type_in(key);
            self.tty.settle(QUIET);
        }
    }

    fn be_there(&mut self) {
        self.tty.settle(QUIET);
        let is_back = |tty: &mut Tty| {
            tty.wake();
            tty.screen().alternate_screen()
        };
        self.tty.wait_until("the workbench to resume", is_back);
    }

    fn suspend(&mut self) {
        self.tty.send_signal("TSTP");
        self.tty.wait_until("it to stop", |tty| tty.state() == Some('T'));
        // Every edit must be in a journal, because the suspension may last long.
        for path in journals(self.tty.folder.path()) {
            let text = fs::read_to_string(&path).expect("it is there");
            assert!(Journal::from_text(&text).is_some(), "{text}");
        }
        self.tty.send_signal("CONT");
        self.be_there();
        self.suspensions += 1;
    }

    fn look(&mut self, step: usize) -> u64 {
        self.tty.settle(QUIET);
        assert!(!self.tty.has_ended(), "it ended at {step}:\n{}", self.tty.screen().contents());
        for path in files(self.tty.folder.path()) {
            let text = fs::read_to_string(&path).expect("it is there");
            let is_case = Document::parse_draft("case", &text).is_ok();
            assert!(is_case, "{} at {step}: {text}", path.display());
            self.looks += 1;
        }
        self.tty.resident()
    }
}

/// The case files in the folder, with any names; exported pages are not included.
fn files(folder: &Path) -> Vec<PathBuf> {
    let entries = fs::read_dir(folder).expect("a folder").flatten();
    let is_case = |path: &PathBuf| {
        let name = path.file_name().unwrap_or_default().to_string_lossy();
        let is_export = EXPORTS.iter().any(|ending| name.ends_with(ending));
        path.is_file() && !name.starts_with('.') && !is_export
    };
    entries.map(|entry| entry.path()).filter(is_case).collect()
}

#[test]
fn a_long_session_loses_nothing_and_does_not_grow() {
    let asked = std::env::var("TIPSTRIKE_SOAK").ok().and_then(|count| count.parse().ok());
    let count = asked.unwrap_or(FEW);
    // Memory that a thread frees remains in its glibc arena: with one arena the test measures what
    // the program itself keeps.
    let launch = Launch::on_table_1().variable("MALLOC_ARENA_MAX", "1");
    fs::write(launch.folder.path().join("other.toml"), TABLE_1).expect("room on the disk");
    let tty = launch.shown("quit");
    let mut soak = Soak { tty, random: 0x9e37_79b9_7f4a_7c15, looks: 0, suspensions: 0 };
    let begun = Instant::now();
    let (mut early, mut most) = (0, 0);
    for step in 1..=count {
        soak.step();
        if step % LOOK == 0 {
            most = most.max(soak.look(step));
            if step <= count / 4 {
                early = most;
            }
        }
    }
    let (took, looks, stops) = (begun.elapsed(), soak.looks, soak.suspensions);
    println!("{count} actions in {took:.0?}, {looks} files, {stops} stops, {early} to {most} KiB");
    assert!(soak.looks >= count / LOOK && soak.suspensions > 0, "{} looks", soak.looks);
    assert!(most <= early + MOST_GROWTH && most <= 30 << 10, "{early} KiB, then {most} KiB");
}
